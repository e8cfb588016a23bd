//! `chta run`: everything a scenario asks for.

use std::fs;

use chta::chain::csv::write_chain_csv;

use super::plan::Planned;
use crate::cli::{
    Answer, Failure,
    args::{CommonArgs, Format, RunArgs},
    load::{EndOptions, load},
    output,
};

/// Runs a scenario and writes its results into a folder.
pub(crate) fn run(args: &RunArgs) -> Result<Answer, Failure> {
    let RunArgs { scenario, output: folder, format, set, quiet } = args;
    let common = CommonArgs { scenario: None, set: set.clone(), body: None, gravity_m_s2: None, clearance_m: None, quiet: *quiet };
    let loaded = load(scenario, &common, None, EndOptions::NONE)?;
    let ends = loaded.ends()?;
    let test = loaded.hop_test();
    let planned = Planned::new(&loaded, &test, true, *quiet)?;
    let mut chain_csv = Vec::new();
    let comments =
        [format!("chta {} run of {}", env!("CARGO_PKG_VERSION"), loaded.scenario.title.as_deref().unwrap_or("a scenario"))];
    write_chain_csv(loaded.prepared.chain.geometry(), &mut chain_csv, &comments).map_err(|e| Failure::message(e.to_string()))?;
    let mut files = vec![
        ("chain.csv", chain_csv),
        ("path.csv", planned.csv(&loaded)?),
        ("result.json", planned.document("run", &loaded)?.into_bytes()),
        ("path.svg", planned.picture(&loaded, &test, ends)?.into_bytes()),
    ];
    files.extend(planned.geojson(&loaded).map(|geojson| ("path.geojson", geojson.into_bytes())));
    fs::create_dir_all(folder).map_err(|error| {
        Failure::message(format!("{}: cannot be made ({error}): choose a folder that may be written to", folder.display()))
    })?;
    for (name, bytes) in &files {
        output::to_file(&folder.join(name), bytes)?;
    }
    // Of an earlier run that had a path: it would speak of another one.
    if !files.iter().any(|(name, _)| *name == "path.geojson") {
        let _ = fs::remove_file(folder.join("path.geojson"));
    }
    let text = match format {
        Format::Text => {
            let names: Vec<_> = files.iter().map(|(name, _)| *name).collect();
            format!("{}\nwritten to {}: {}\n", planned.text(), folder.display(), names.join(", "))
        }
        Format::Json => planned.document("run", &loaded)?,
    };
    output::to_stdout(text.as_bytes())?;
    Ok(planned.verdict())
}
