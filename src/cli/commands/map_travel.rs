//! `chta map` for a scenario with `[drive]`.

use chta::{
    report::{Document, DocumentKind},
    study::{
        TravelMapOptions,
        map::{MapQuestion, PreparedMap},
        travel_map, travel_map_size,
    },
};

use crate::cli::{
    Answer, Failure,
    args::{Format, MapArgs},
    load::raster_files_of,
    map_input::MapInput,
    map_outputs::TravelMapOutputs,
    not_for_travel, output,
    progress::Progress,
};

/// Computes and writes the map.
pub(super) fn run(args: &MapArgs, input: &MapInput) -> Result<Answer, Failure> {
    not_for_travel::refuse_of_map(args)?;
    let quiet = args.common.quiet;
    let options = TravelMapOptions { returns: args.back, memory_max_bytes: args.size.memory_max_bytes() };
    // The memory of a map of hops is another.
    let question = MapQuestion { memory_max_bytes: None, ..input.question(args) };
    let prepared = PreparedMap::new(&question).map_err(|error| input.failure(&error))?;
    if args.size.dry_run {
        let size = travel_map_size(&prepared, &input.bare.scenario, options).map_err(|error| input.failure(&error))?;
        let (files, warnings) = (raster_files_of(&input.bare)?, input.warned(&prepared.warnings, quiet));
        let document = Document::new(DocumentKind::Size, input.bare.document.clone(), files, warnings, size);
        return output::sized(&document, args.answer.format);
    }
    let outputs = TravelMapOutputs::begin(args)?;
    let scenario = &input.bare.scenario;
    let found = travel_map(&prepared, scenario, options, &Progress::new(quiet)).map_err(|error| input.failure(&error))?;
    let warnings = input.warned(&[&prepared.warnings[..], &found.warnings].concat(), quiet);
    outputs.write(args, input, &prepared, &found)?;
    let text = match args.answer.format {
        Format::Text => found.answer.text(),
        Format::Json => {
            let files = raster_files_of(&input.bare)?;
            let document =
                Document::new(DocumentKind::MapTravel, input.bare.document.clone(), files, warnings, found.answer.clone());
            document.on_map(prepared.projection.as_ref().ok()).to_json()?
        }
    };
    output::to_stdout(text.as_bytes())?;
    Ok(Answer::of(found.answer.reaches_all_goals()))
}
