//! Plans a path for a scenario of the repository and flies it under errors, by the functions of `study` alone.
//!
//! `cargo run --release --example plan_and_simulate -- data/scenarios/rolling_surely.toml`
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints")]

use std::{error::Error, fs, path::Path, sync::Arc};

use chta::{
    report::{FurtherMeans, simulate_text},
    scenario::{Entries, Scenario, ScenarioProblems},
    study::{Case, Commands, PlanOptions, SimulateOptions, plan, simulate},
};

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "data/scenarios/rolling_surely.toml".to_owned());
    let source = fs::read_to_string(&name).map_err(|error| format!("{name}: cannot be read ({error}), expected a scenario"))?;
    let scenario = Scenario::new(Entries::from_toml(&source))
        .map_err(|problems| ScenarioProblems { name: name.clone(), source, problems }.to_string())?;

    // The paths of a scenario start from its folder.
    let base = Path::new(&name).parent().unwrap_or(Path::new(""));
    let case = Case::new(scenario, base, Commands::OfTheMachine)?;
    let planned = Arc::new(plan(&case, PlanOptions { verify: true, ..PlanOptions::default() }, &())?);
    let simulated = simulate(&planned, &SimulateOptions::default(), &mut (), &())?;

    for warning in case.warnings_with(planned.warnings.iter().chain(&simulated.warnings).cloned()) {
        eprintln!("warning: {warning}");
    }
    print!("{}", simulate_text(&simulated.answer, FurtherMeans::default()));
    // One document that says what was asked and what came of it.
    let document = case.record(&|path| path.display().to_string())?.document("simulate", &simulated.warnings, &simulated.answer);
    println!("{} bytes of JSON", document.to_json()?.len());
    Ok(())
}
