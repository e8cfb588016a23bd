//! The time from a chain's vertices in memory to the path of fewest hops, without process and files: one line of JSON.
//!
//! `cargo run --release --example peers_solve -- CHAIN SCENARIO POINTS_PER_SEGMENT REPEATS`
//!
//! From the left end of the chain to its right end. The same steps are timed as in `benches/peers/all_pairs.py`: constraints of all
//! segments, nodes, hops, search. `solve_s` is the least of the repeats; the first round is left out if there are more.

#![expect(clippy::print_stdout, reason = "a program that prints")]

use std::{error::Error, fs, hint::black_box, time::Instant};

use chta::{
    chain::{ConstrainedChain, csv::read_chain_csv_file},
    graph::{PointSpacing, SearchOptions, search},
    hop::HopTest,
    scenario::{Entries, Scenario},
};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [chain, scenario, points, repeats] = arguments.as_slice() else {
        return Err("expected CHAIN SCENARIO POINTS_PER_SEGMENT REPEATS".into());
    };
    let spacing = Some(PointSpacing::PerSegment(points.parse()?));
    let scenario = Scenario::new(Entries::from_toml(&fs::read_to_string(scenario)?))
        .map_err(|problems| problems.iter().map(|problem| problem.message.clone()).collect::<Vec<_>>().join("; "))?;
    let geometry = read_chain_csv_file(chain)?.chain;
    let options = SearchOptions { spacing, ..scenario.search.clone() };
    let mut least_s = f64::INFINITY;
    let mut hops = None;
    let repeats: usize = repeats.parse()?;
    for round in 0..=repeats {
        let geometry = geometry.clone();
        let began = Instant::now();
        let chain = ConstrainedChain::new(geometry, &scenario.hopper, scenario.body.gravity, &scenario.surface)?;
        let test = HopTest::new(chain.clone());
        let (first_m, last_m) = chain.geometry().extent_m();
        let (start, goal) = (chain.geometry().station(first_m)?, chain.geometry().station(last_m)?);
        hops = black_box(search(&test, start, goal, &options, &())?).hops();
        if round > 0 || repeats == 0 {
            least_s = least_s.min(began.elapsed().as_secs_f64());
        }
    }
    println!("{}", serde_json::json!({ "hops": hops, "solve_s": least_s }));
    Ok(())
}
