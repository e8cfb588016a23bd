//! Mutated files of each form: no panic, and accepted files read back equal after writing.

use crate::mutations::{copy, mutated, replace_digit, rounds, truncate_or_redraw};
use chta::chain::csv::{read_chain_csv, read_pairs_csv, write_chain_csv};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

pub(crate) const SURFACE: &str = "# a crater's rim\n\
    x_m,z_m,friction_coefficient,cross_slope_deg,keep_out,map_x_m,map_y_m,note\n\
    0,0.5,0.6,0,0,100.25,-7,\n\
    2.5,1.25,0.55,12.5,1,102.75,-7,\"steep, dark\"\n\
    4,-1e-3,0.6,3.0000000000000000001,0,104.25,-7,\n\
    9,2,,,,109.25,-7,\n";

pub(crate) const EXPLICIT: &str = "x_m,z_m,takeoff_min_deg,takeoff_max_deg,takeoff_speed_max_m_s,landing_min_deg,landing_max_deg,landing_speed_max_m_s,\
    reverse_takeoff_min_deg,reverse_takeoff_max_deg,reverse_takeoff_speed_max_m_s,reverse_landing_min_deg,reverse_landing_max_deg,reverse_landing_speed_max_m_s\r\n\
    0,0,63.5,93.5,10,-93.5,-60,10,56.5,86.5,10,-90,-63.5,10\r\n\
    3,1,60,90,0,-90,-60,8.5,60,90,9,-90,-60,0\r\n\
    4.5,-2,45.000000000000000000001,135,5,-135,-45,5,45,135,5,-135,-45,5\r\n\
    7,0,,,,,,,,,,,,\r\n";

pub(crate) const PAIRS: &str = "start_x_m,goal_x_m\n0,9\n2.5,4\n1e0,\"0.5\"\n";

/// Bytes with a meaning in CSV, which pass the first check more often than random bytes.
const TELLING: &[u8] = b",\n\r\"#;\t 0123456789.-+eE\0\xff\xefx_mnaif";

fn spoiled(rng: &mut ChaCha8Rng, original: &[u8]) -> Vec<u8> {
    mutated(rng, original, |rng, bytes, range| {
        let at = range.start;
        match rng.random_range(0..10) {
            0 => bytes[at] ^= 1 << rng.random_range(0..8),
            1 => bytes[at] = TELLING[rng.random_range(0..TELLING.len())],
            2 => bytes.insert(at, TELLING[rng.random_range(0..TELLING.len())]),
            3 => drop(bytes.remove(at)),
            4 => drop(bytes.drain(range)),
            5 => copy(rng, bytes, range),
            6..9 => replace_digit(rng, bytes),
            _ => truncate_or_redraw(rng, bytes, at),
        }
    })
}

/// If nearly all or nearly none are accepted, the mutations test one outcome only.
fn both_outcomes(accepted: usize) {
    let rounds = rounds();
    assert!((rounds / 20..rounds - rounds / 20).contains(&accepted), "{accepted} of {rounds} were accepted");
}

/// Mutates a chain many times; returns how many were still accepted.
fn accepted(original: &str, seed: u64) -> usize {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut accepted = 0;
    for _ in 0..rounds() {
        let bytes = spoiled(&mut rng, original.as_bytes());
        match read_chain_csv(&bytes) {
            Ok(file) => {
                accepted += 1;
                let mut written = Vec::new();
                let shown = || String::from_utf8_lossy(&bytes);
                write_chain_csv(&file.chain, &mut written, &[]).unwrap_or_else(|error| panic!("{error} on writing {}", shown()));
                let again = read_chain_csv(&written).unwrap_or_else(|problems| panic!("{problems} on reading again {}", shown()));
                assert_eq!(again.chain, file.chain, "{}", shown());
            }
            Err(problems) => {
                assert!(!problems.problems.is_empty());
                for problem in &problems.problems {
                    assert!(problem.text.get(problem.span.clone()).is_some(), "a span outside its text: {problem:?}");
                    assert!(problem.line >= 1 && problem.to_string().starts_with("line "), "{problem:?}");
                }
            }
        }
    }
    accepted
}

#[test]
fn spoiled_surface_files_never_panic_and_read_back() {
    let accepted = accepted(SURFACE, 1);
    both_outcomes(accepted);
}

#[test]
fn spoiled_explicit_files_never_panic_and_read_back() {
    let accepted = accepted(EXPLICIT, 2);
    both_outcomes(accepted);
}

#[test]
fn spoiled_pairs_never_panic() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut accepted = 0;
    for _ in 0..rounds() {
        match read_pairs_csv(&spoiled(&mut rng, PAIRS.as_bytes())) {
            Ok(file) => {
                accepted += 1;
                assert!(file.pairs.iter().all(|pair| pair.start_x_m.is_finite() && pair.goal_x_m.is_finite()));
            }
            Err(problems) => assert!(!problems.problems.is_empty()),
        }
    }
    both_outcomes(accepted);
}
