//! `chta map`: fewest hops from one or several posts of a DEM to every other.

use chta::{
    report::{Document, DocumentKind},
    study::map::PreparedMap,
};

use super::{map_legs, map_over_mesh};
use crate::cli::{
    Answer, Failure,
    args::{Format, MapArgs},
    effects::Purpose,
    inputs,
    load::{EndOptions, load_mesh_scenario, raster_files_of},
    map_input::MapInput,
    map_outputs::MapOutputs,
    output, pictures,
    progress::Progress,
    threads,
    wrong_thing::Role,
};

/// Computes and writes the map.
pub(crate) fn run(args: &MapArgs) -> Result<Answer, Failure> {
    let (common, format) = (&args.common, args.answer.format);
    let scenario = (common.scenario.as_deref(), Role::ScenarioOption);
    let starts = (args.starts.as_deref(), Role::Starts);
    inputs::look_at(common.input_max_gib, &[(Some(&args.dem), Role::MapTarget), scenario, starts])?;
    threads::start(args.answer.threads)?;
    let target = (args.dem.as_path(), Role::MapTarget);
    if let Some(input) = load_mesh_scenario(target, common, (None, EndOptions::NONE), Purpose::MapMesh, &[])? {
        return map_over_mesh::run(args, &input);
    }
    args.view.without_mesh()?;
    let input = MapInput::of(args)?;
    if let Some(answer) = map_legs::of_legs_or_wheels(args, &input) {
        return answer;
    }
    let question = input.question(args);
    let prepared = PreparedMap::new(&question).map_err(|error| input.failure(&error))?;
    let (document, files) = (input.bare.document.clone(), raster_files_of(&input.bare)?);
    if args.size.dry_run {
        let warnings = input.warned(&prepared.warnings, common.quiet);
        return output::sized(&Document::new(DocumentKind::Size, document, files, warnings, prepared.memory.answer()), format);
    }
    let outputs = MapOutputs::begin(args)?;
    let study = prepared.answered(&question, &Progress::new(common.quiet)).map_err(|error| input.failure(&error))?;
    let warnings = input.warned(&study.warnings, common.quiet);
    outputs.write(args, &input, &prepared, &study)?;
    let text = match format {
        Format::Text => study.answer.text() + &pictures::pages_text(),
        Format::Json => {
            let document = Document::new(DocumentKind::Map, document, files, warnings, study.answer.clone());
            document.on_map(prepared.projection.as_ref().ok()).to_json()?
        }
    };
    output::to_stdout(text.as_bytes())?;
    Ok(if study.answer.reaches_all_goals() { Answer::Yes } else { Answer::No })
}
