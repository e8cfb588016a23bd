//! `chta fan`: slices in all directions from one point.

use chta::{
    report::{Document, DocumentKind},
    study::fan::{FanQuestion, FanStudyError, PreparedFan},
};

use crate::cli::{
    Answer, Failure,
    args::{FanArgs, Format, place},
    effects::Purpose,
    fan_outputs, inputs,
    load::{load_bare, raster_files_of},
    output,
    progress::Progress,
    threads,
    wrong_thing::Role,
};

/// Analyses all directions.
pub(crate) fn run(args: &FanArgs) -> Result<Answer, Failure> {
    let (common, format) = (&args.common, args.answer.format);
    let scenario = (common.scenario.as_deref(), Role::ScenarioOption);
    inputs::look_at(common.input_max_gib, &[(Some(&args.dem), Role::Dem), scenario])?;
    threads::start(args.answer.threads)?;
    let bare = load_bare(&args.dem, common, &args.search, Purpose::Fan)?;
    let question = FanQuestion {
        scenario: &bare.scenario,
        base: &bare.base,
        dem: &bare.dem,
        from: place("from", args.from, args.from_lonlat)?,
        headings: args.headings,
        length_m: args.length,
        memory_max_bytes: args.size.memory_max_bytes(),
    };
    let failed = |error: FanStudyError| match error {
        FanStudyError::Dem(_) | FanStudyError::Scale(_) => Failure::about(&bare.dem, &error),
        _ => Failure::of(&error),
    };
    let prepared = PreparedFan::new(&question).map_err(failed)?;
    if args.size.dry_run {
        let size = prepared.size(&question, &Progress::new(common.quiet)).map_err(failed)?;
        let warnings = output::warned(common.quiet, &[&bare.warnings, &prepared.warnings]);
        return output::sized(
            &Document::new(DocumentKind::Size, bare.document.clone(), raster_files_of(&bare)?, warnings, size),
            format,
        );
    }
    // Opened before the computation, which may take long.
    let picture = output::begin_picture("--plot", args.plot.as_deref())?;
    let study = prepared.answered(&question, &Progress::new(common.quiet)).map_err(failed)?;
    let warnings = output::warned(common.quiet, &[&bare.warnings, &study.warnings]);
    if fan_outputs::write(args, &bare, &study.answer, picture)? {
        return Ok(Answer::Yes);
    }
    if format == Format::Text {
        output::to_stdout(study.answer.text().as_bytes())?;
        return Ok(Answer::Yes);
    }
    let document = Document::new(DocumentKind::Fan, bare.document.clone(), raster_files_of(&bare)?, warnings, study.answer);
    output::to_stdout(document.on_map(prepared.projection.as_ref().ok()).to_json()?.as_bytes())?;
    Ok(Answer::Yes)
}
