//! `chta compare`: several scenarios side by side.

use std::path::{Path, PathBuf};

use chta::{
    figure::{Caption, CompareFigure, ComparedScenario, Flight, draw_compare},
    path::{Hop, HopPath},
    report::{CompareAnswer, CompareRow, Document, MarginsRecord, TotalsRecord},
};

use super::search::{Searched, use_threads};
use crate::cli::{
    Answer, Failure,
    args::{CommonArgs, CompareArgs, Format},
    effects::Purpose,
    inputs,
    load::{Loaded, load_scenario, relative_name},
    output::{self, Pending, TableFormat},
    wrong_thing::Role,
};

/// One scenario with its path.
struct Compared {
    loaded: Loaded,
    row: CompareRow,
    path: Option<HopPath>,
    warnings: Vec<String>,
}

/// Answers each scenario separately and shows the answers side by side.
pub(crate) fn run(args: &CompareArgs) -> Result<Answer, Failure> {
    let files: Vec<_> = args.scenarios.iter().map(|file| (Some(file.as_path()), Role::Scenario)).collect();
    check_pipes(&args.scenarios)?;
    inputs::look_at(args.input_max_gib, &files)?;
    let table = args.output.as_deref().map(TableFormat::of).transpose()?;
    let csv_to_stdout = args.output.as_deref() == Some(Path::new("-"));
    // Outputs are opened before the computation, which may take long.
    let rows = args.output.as_deref().filter(|_| !csv_to_stdout).map(Pending::begin).transpose()?;
    let plot = args.plot.as_deref().map(|path| output::begin_picture("--plot", path)).transpose()?;
    use_threads(args.answer.threads)?;
    let compared: Vec<_> = args.scenarios.iter().map(|file| Compared::new(file, args)).collect::<Result<_, _>>()?;
    let answer = CompareAnswer { compared: compared.iter().map(|one| one.row.clone()).collect() };
    let mut files = Vec::new();
    if let Some(file) = rows {
        let json = table == Some(TableFormat::Json);
        files.push((file, if json { document(&compared, &answer)?.into_bytes() } else { csv(&answer)? }));
    }
    if let Some(file) = plot {
        let encoded = output::encoded(draw_compare(&figure(&compared)), file.path())?;
        files.push((file, encoded));
    }
    output::finish(files)?;
    let text = match args.answer.format {
        _ if csv_to_stdout => csv(&answer)?,
        Format::Text => answer.text().into_bytes(),
        Format::Json => document(&compared, &answer)?.into_bytes(),
    };
    output::to_stdout(&text)?;
    Ok(Answer::Yes)
}

/// Refuses a pipe that is given twice: the second reading would find nothing.
fn check_pipes(scenarios: &[PathBuf]) -> Result<(), Failure> {
    for (i, file) in scenarios.iter().enumerate() {
        if inputs::is_stream(file) && scenarios[..i].iter().any(|other| inputs::same_stream(other, file)) {
            return Err(Failure::message(format!(
                "{}: found twice as SCENARIO, but what comes through a pipe is read only once: give one of the two as a file",
                file.display()
            )));
        }
    }
    Ok(())
}

impl Compared {
    fn new(file: &Path, args: &CompareArgs) -> Result<Self, Failure> {
        let common = CommonArgs {
            scenario: None,
            set: args.set.clone(),
            body: None,
            gravity_m_s2: None,
            clearance_m: None,
            accept_map_scale: args.accept_map_scale,
            no_data: None,
            input_max_gib: args.input_max_gib,
            quiet: args.quiet,
        };
        let loaded = load_scenario(file, &common, Purpose::Compare)?;
        let ends = loaded.ends()?;
        let test = loaded.hop_test();
        let options = &loaded.scenario.search;
        let searched = Searched::new(&test, ends, &loaded.scenario, Some(args.prove), args.quiet)?;
        let (check, path) = searched.answer_with_path(&test, ends, (&loaded.prepared, options));
        let path = path.map_err(|error| Failure::of(&error))?;
        let warnings = path.as_ref().map(|path| loaded.scenario.path_warnings(path)).unwrap_or_default();
        for warning in &warnings {
            output::warn(args.quiet, warning);
        }
        let warnings = loaded.warnings_with(warnings);
        let name = loaded.scenario.title.clone().unwrap_or_else(|| file.display().to_string());
        let row = CompareRow {
            file: relative_name(file),
            name,
            start_x_m: check.start_x_m,
            goal_x_m: check.goal_x_m,
            verdict: check.verdict,
            hops: check.hops,
            lower_bound: check.proof.as_ref().map(|proof| proof.lower_bound),
            totals: path.as_ref().map(|path| TotalsRecord::from(&path.totals)),
            margins: path.as_ref().and_then(MarginsRecord::of),
        };
        Ok(Self { loaded, row, path, warnings })
    }

    /// The scenario as the picture shows it.
    fn drawn(&self) -> ComparedScenario {
        let Loaded { prepared, .. } = &self.loaded;
        let geometry = prepared.chain.geometry();
        let point = |x_m: f64| geometry.station(x_m).map(|station| station.point).ok();
        ComparedScenario {
            name: self.row.name.clone(),
            verdict: self.row.verdict.to_owned(),
            hops: self.row.hops,
            ground: geometry.vertices().to_vec(),
            start: point(self.row.start_x_m).unwrap_or(geometry.vertices()[0]),
            goal: point(self.row.goal_x_m).unwrap_or(geometry.vertices()[0]),
            flights: self.path.iter().flat_map(|path| &path.hops).map(Flight::from).collect(),
        }
    }
}

/// The picture with all paths overlaid.
fn figure(compared: &[Compared]) -> CompareFigure {
    let words = |one: &Compared| {
        let hops = one.row.hops.map(|hops| format!(", {hops} hop{}", if hops == 1 { "" } else { "s" })).unwrap_or_default();
        let beside = one.path.iter().flat_map(|path| &path.hops).any(Hop::is_beside_line);
        let drawn = if beside { " beside the line, drawn projected on it" } else { "" };
        format!("{}: {}{hops}{drawn}", one.row.name, one.row.verdict)
    };
    let line = compared.iter().map(words).collect::<Vec<_>>().join("; ");
    let names: Vec<_> = compared.iter().map(|one| one.row.name.as_str()).collect();
    CompareFigure { caption: Caption::new(names.join(" and "), line), scenarios: compared.iter().map(Compared::drawn).collect() }
}

/// The table as CSV.
fn csv(answer: &CompareAnswer) -> Result<Vec<u8>, Failure> {
    let mut csv = Vec::new();
    answer.write_csv(&mut csv).map_err(|error| Failure::message(format!("compare.csv: {error}")))?;
    Ok(csv)
}

/// The answer as one JSON document, with all scenarios as used.
fn document(compared: &[Compared], answer: &CompareAnswer) -> Result<String, Failure> {
    let scenarios = compared.iter().map(|one| one.loaded.document.clone()).collect();
    let mut inputs = Vec::new();
    let mut warnings = Vec::new();
    for one in compared {
        for input in &one.loaded.inputs {
            if !inputs.contains(input) {
                inputs.push(input.clone());
            }
        }
        warnings.extend(one.warnings.iter().map(|warning| format!("{}: {warning}", one.row.file)));
    }
    Ok(Document::new("compare", serde_json::Value::Array(scenarios), inputs, warnings, answer.clone()).to_json()?)
}
