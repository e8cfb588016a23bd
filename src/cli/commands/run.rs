//! `chta run`: everything a scenario asks for.

use std::{fs, path::Path};

use chta::{
    chain::csv::write_chain_csv,
    report::{CrsRecord, DocumentKind},
};

use super::{plan::Planned, search::use_threads, simulate, trajectory};
use crate::cli::{
    Answer, Failure,
    args::{AnswerArgs, CommonArgs, Format, RunArgs},
    claims,
    effects::Purpose,
    inputs,
    load::load_scenario,
    output::{self, Pending},
    wrong_thing::Role,
};

/// The kind of the answer, which `run` accepts as input to repeat it.
const RESULT: &str = "result.json";

/// The picture of the plan.
const PICTURE: &str = "path.svg";

/// Runs a scenario and writes its results into a folder.
pub(crate) fn run(args: &RunArgs) -> Result<Answer, Failure> {
    let RunArgs {
        scenario,
        output: folder,
        trajectory: in_time,
        answer: AnswerArgs { threads, format },
        set,
        accept_map_scale,
        input_max_gib,
        quiet,
    } = args;
    inputs::look_at(*input_max_gib, &[(Some(scenario), Role::Scenario)])?;
    use_threads(*threads)?;
    let common = CommonArgs {
        scenario: None,
        set: set.clone(),
        body: None,
        gravity_m_s2: None,
        clearance_m: None,
        accept_map_scale: *accept_map_scale,
        no_data: None,
        input_max_gib: *input_max_gib,
        quiet: *quiet,
    };
    let loaded = load_scenario(scenario, &common, Purpose::Run)?;
    let ends = loaded.ends()?;
    output::check_folder(folder)?;
    let trajectory_file = trajectory::begin(in_time)?;
    let test = loaded.hop_test();
    let planned = Planned::new(&loaded, &test, None, true, *quiet)?;
    let trajectory_csv = trajectory::filled(trajectory_file, in_time, planned.path.as_ref(), &loaded)?;
    let mut chain_csv = Vec::new();
    let projection = loaded.prepared.projection.as_ref();
    let mut comments =
        vec![format!("chta {} run of {}", env!("CARGO_PKG_VERSION"), loaded.scenario.title.as_deref().unwrap_or("a scenario"))];
    comments.extend(projection.map(|projection| CrsRecord::from(projection).comments()).unwrap_or_default());
    write_chain_csv(loaded.prepared.chain.geometry(), &mut chain_csv, &comments).map_err(|e| Failure::of(&e))?;
    let mut files = vec![
        ("chain.csv", chain_csv),
        ("path.csv", planned.csv(&loaded)?),
        (RESULT, planned.document(DocumentKind::Run, &loaded)?.into_bytes()),
        (PICTURE, planned.picture(&loaded, &test, ends, Path::new(PICTURE))?),
    ];
    if let Some(geojson) = planned.geojson(&loaded) {
        files.push(("path.geojson", geojson.into_bytes()));
        files.extend(output::prj(projection).map(|text| ("path.prj", text)));
    }
    let simulate::RunTrials { text: trials_text, files: of_trials } = simulate::of_run(&loaded, &test, &planned, *quiet)?;
    files.extend(of_trials);
    fs::create_dir_all(folder).map_err(|error| {
        Failure::message(format!("{}: cannot be made ({error}): choose a folder that may be written to", folder.display()))
    })?;
    claims::repeats(&folder.join(RESULT));
    let names: Vec<_> = files.iter().map(|(name, _)| *name).collect();
    let paths: Vec<_> = names.iter().map(|name| folder.join(name)).collect();
    let pending: Result<Vec<_>, Failure> =
        paths.iter().zip(files).map(|(path, (_, bytes))| Ok((Pending::begin(path)?, bytes))).collect();
    let mut pending = pending?;
    pending.extend(trajectory_csv);
    output::finish(pending)?;
    // Files left by an earlier run that had a path, trials or another map would contradict this one.
    for stale in ["path.geojson", "path.prj"].into_iter().chain(simulate::RUN_FILES) {
        if !names.contains(&stale) {
            let _ = fs::remove_file(folder.join(stale));
        }
    }
    let text = match format {
        Format::Text => {
            format!("{}{trials_text}\nwritten to {}: {}\n", planned.text(), folder.display(), names.join(", "))
        }
        Format::Json => planned.document(DocumentKind::Run, &loaded)?,
    };
    output::to_stdout(text.as_bytes())?;
    Ok(planned.verdict())
}
