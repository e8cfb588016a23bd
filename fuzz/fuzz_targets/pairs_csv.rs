//! Any bytes as a CSV of pairs: no panic, and accepted numbers are finite.
#![no_main]

use chta::chain::csv::read_pairs_csv;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match read_pairs_csv(bytes) {
        Ok(file) => assert!(file.pairs.iter().all(|pair| pair.start_x_m.is_finite() && pair.goal_x_m.is_finite())),
        Err(problems) => assert!(problems.problems.iter().all(|problem| problem.text.get(problem.span.clone()).is_some())),
    }
});
