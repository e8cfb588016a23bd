//! `chta map` of a robot with legs.

use chta::{
    report::{Document, DocumentKind},
    study::PreparedLegsMap,
};

use crate::cli::{
    Answer, Failure,
    args::{Format, MapArgs},
    load::files_with_robot_of,
    map_input::MapInput,
    map_outputs::LegsMapOutputs,
    not_on_mesh, output,
    progress::Progress,
};

/// The map of a machine that stands on legs or drives; `None` for one that hops alone.
pub(super) fn of_legs_or_wheels(args: &MapArgs, input: &MapInput) -> Option<Result<Answer, Failure>> {
    if input.bare.scenario.legs.file.is_some() {
        return Some(run(args, input));
    }
    input.bare.scenario.drives().is_some().then(|| super::map_travel::run(args, input))
}

/// Computes and writes the map.
fn run(args: &MapArgs, input: &MapInput) -> Result<Answer, Failure> {
    not_on_mesh::refuse_of_legs_map(args)?;
    let quiet = args.common.quiet;
    let question = input.legs_question(args);
    let about = |error| Failure::about(&input.bare.dem, &error);
    let prepared = PreparedLegsMap::new(&question).map_err(about)?;
    let files = files_with_robot_of(&input.bare)?;
    let document = input.bare.document.clone();
    if args.size.dry_run {
        let warnings = input.warned(&prepared.warnings, quiet);
        return output::sized(&Document::new(DocumentKind::Size, document, files, warnings, prepared.size), args.answer.format);
    }
    let outputs = LegsMapOutputs::begin(args)?;
    let found = prepared.answered(&question, &Progress::new(quiet)).map_err(about)?;
    let warnings = input.warned(&[&prepared.warnings[..], &found.warnings].concat(), quiet);
    outputs.write(args, input, &prepared, &found)?;
    let text = match args.answer.format {
        Format::Text => found.answer.text(),
        Format::Json => {
            let mut document = Document::new(DocumentKind::MapLegs, document, files, warnings, found.answer.clone());
            document.crs.clone_from(&prepared.crs);
            document.to_json()?
        }
    };
    output::to_stdout(text.as_bytes())?;
    Ok(Answer::of(found.answer.reaches_all_goals()))
}
