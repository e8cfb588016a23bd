//! `chta sites`: landing sites ranked.

use chta::{
    report::{Document, DocumentKind},
    study::{map::PreparedMap, sites},
};

use crate::cli::{
    Answer, Failure,
    args::SitesArgs,
    inputs,
    load::raster_files_of,
    output,
    progress::Progress,
    sites_input::{SitesInput, SitesOutput},
    threads,
    views::{Files, Views},
    wrong_thing::Role,
};

/// Ranks the candidates.
pub(crate) fn run(args: &SitesArgs) -> Result<Answer, Failure> {
    let (common, format) = (&args.common, args.answer.format);
    let scenario = (common.scenario.as_deref(), Role::ScenarioOption);
    let candidates = (args.candidates.as_deref(), Role::Starts);
    inputs::look_at(common.input_max_gib, &[(Some(&args.dem), Role::MapTarget), scenario, candidates])?;
    threads::start(args.answer.threads)?;
    let input = SitesInput::of(args)?;
    let question = input.question(args);
    let prepared = PreparedMap::new(&question.map).map_err(|error| input.failure(&error))?;
    let (document, files) = (input.bare.document.clone(), raster_files_of(&input.bare)?);
    if args.size.dry_run {
        let warnings = input.warned(&prepared.warnings, common.quiet);
        return output::sized(&Document::new(DocumentKind::Size, document, files, warnings, question.size(&prepared)), format);
    }
    // Opened before the searches, which may take long.
    let mut output = SitesOutput::begin(args.output.as_deref())?;
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let study = sites(&prepared, &question, &Progress::new(common.quiet)).map_err(|error| input.failure(&error))?;
    let warnings = input.warned(&study.warnings, common.quiet);
    let answer = &study.answer;
    let json = || {
        let document = Document::new(DocumentKind::Sites, document.clone(), files.clone(), warnings.clone(), answer.clone());
        Ok(document.on_map(prepared.projection.as_ref().ok()).to_json()?)
    };
    let views = Views { text: &|| answer.text(), json: &json, csv: &|out| answer.write_csv(out) };
    let mut written = Files::default();
    written.picture(plot, || Some(input.picture(&prepared, answer)))?;
    output.write(&mut written, &views, (&prepared, answer, args.every))?;
    written.finish()?;
    views.show(format, output.table.to_stdout)?;
    Ok(Answer::of(!args.require_all || answer.has_site()))
}
