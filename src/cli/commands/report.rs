//! `chta report`: a page of an answer.

use std::{fs, path::Path};

use chta::study::PageDocuments;

use crate::cli::{
    Answer, Failure,
    args::{CommonArgs, ReportArgs},
    effects::Purpose,
    inputs,
    load::{EndOptions, load_mesh_scenario, load_scenario},
    output,
    page::{PageFile, PageInput},
    wrong_thing::Role,
};

/// Makes a page of results, with the ground of the files that they name.
pub(crate) fn run(args: &ReportArgs) -> Result<Answer, Failure> {
    inputs::look_at_results(args.input_max_gib, &args.results)?;
    let to_stdout = args.output == Path::new("-");
    let file = if to_stdout { None } else { Some(PageFile::begin("-o", &args.output)?) };
    let texts = args.results.iter().map(|path| text_of(path)).collect::<Result<_, _>>()?;
    let documents = PageDocuments::read(texts).map_err(|error| match error.document() {
        Some(number) => Failure::about(&args.results[number], &error),
        None => Failure::of(&error),
    })?;
    let main = args.results[documents.main()].as_path();
    // The warnings about the input stand in the documents, and so on the page.
    let common = CommonArgs::of_scenarios(&[], false, args.input_max_gib, true);
    let page = match load_mesh_scenario((main, Role::Result), &common, (None, EndOptions::NONE), Purpose::Plan, &[])? {
        Some(input) => PageInput::Facets(&input).page(&documents)?,
        None => PageInput::Case(&load_scenario(main, &common, Purpose::Run)?).page(&documents)?,
    };
    let Some(file) = file else {
        output::to_stdout(&page)?;
        return Ok(Answer::Yes);
    };
    let bytes = page.len();
    output::finish(vec![file.filled(page)])?;
    if !args.quiet {
        output::to_stdout(format!("written to {}: a page of {bytes} bytes\n", args.output.display()).as_bytes())?;
    }
    Ok(Answer::Yes)
}

/// The text of a result.
fn text_of(path: &Path) -> Result<String, Failure> {
    let input = inputs::open(path, Role::Result)?;
    crate::cli::claims::reads(&input.file);
    fs::read_to_string(&input.file).map_err(|error| Failure::about(path, &error))
}
