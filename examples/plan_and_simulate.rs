//! Plans a path for a scenario of the repository and flies it under errors in two halves, by the functions of `study` alone.
//!
//! `cargo run --release --example plan_and_simulate -- data/scenarios/rolling_surely.toml`
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints")]

use std::{error::Error, fs, path::Path, sync::Arc};

use chta::{
    report::{FurtherMeans, simulate_text},
    scenario::{Entries, Scenario, ScenarioProblems},
    study::{Case, Commands, PlanOptions, SimulateOptions, Trials, plan},
};

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "data/scenarios/rolling_surely.toml".to_owned());
    let source = fs::read_to_string(&name).map_err(|error| format!("{name}: cannot be read ({error}), expected a scenario"))?;
    let scenario = Scenario::new(Entries::from_toml(&source))
        .map_err(|problems| ScenarioProblems { name: name.clone(), source, problems }.to_string())?;
    let trials = scenario.uncertainty.clone().unwrap_or_default().trials;

    // The paths of a scenario start from its folder.
    let case = Case::new(scenario, Path::new(&name).parent().unwrap_or(Path::new("")), Commands::OfTheMachine)?;
    let planned = Arc::new(plan(&case, PlanOptions { verify: true, ..PlanOptions::default() }, &())?);
    let flights = Trials::new(&planned, &SimulateOptions::default());
    for warning in case.warnings_with(planned.warnings.iter().chain(flights.warnings()).cloned()) {
        eprintln!("warning: {warning}");
    }

    // Two halves, as two processes would fly them; together they are the whole to the byte.
    let halves = [flights.tally(0..trials / 2, &())?, flights.tally(trials / 2..trials, &())?];
    let [Some(mut tally), Some(rest)] = halves else { return Err("there is no path to fly".into()) };
    tally.merge(&rest)?;
    print!("{}", simulate_text(&flights.answer_of(&tally), FurtherMeans::default()));
    Ok(())
}
