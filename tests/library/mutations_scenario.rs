//! Mutated scenarios of each form: no panic, every problem has a position inside the text and a remedy, and accepted
//! scenarios read back equal after writing.

#![allow(clippy::unwrap_used, reason = "a test that cannot read its own JSON should stop")]

use crate::mutations::{copy, mutated, replace_digit, rounds, truncate_or_redraw};
use chta::scenario::{Entries, Place, Scenario, ScenarioProblems, scenario_document};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

pub(crate) const TOML: &str = "# a crater\n[body]\nname = \"mars\"\nradius_m = 3389500\n\n[hopper]\ntakeoff_speed_max_m_s = 10.0\n\
    landing_speed_max_m_s = 1e1\nclearance_m = 0.1\ntakeoff_angle_min_deg = -5\ntakeoff_angle_max_deg = 89.5\nmass_kg = 0x10\n\n[surface]\n\
    takeoff_from_slope_deg = [60, 90.0]\nlanding_from_slope_deg = [-90, -60]\nrest_slope_max_deg = inf\n\n\
    [terrain]\ndem = 'crater.tif' # of 2020\nstart_m = [10.0, 60.0]\ngoal_m = [60.0, 60.0]\nstart_x_m = 3\n\n[search]\n\
    points_per_segment = \"auto\"\neffort = \"energy\"\ntakeoff_angle = \"mid-range\"\nsplit = \"equal\"\n\n[report]\ntitle = \"Ein Krater, fünf Hügel\"\n";

const JSON: &str = r#"{"schema": "chta/run/1", "chta_version": "0.1.0", "scenario": {"body": {"gravity_m_s2": 3.711, "name": "mars",
    "radius_m": 3389500.0}, "hopper": {"clearance_m": 0.1, "landing_speed_max_m_s": 10.0, "takeoff_speed_max_m_s": 10.0, "rest_time_s": 60},
    "report": {"title": "f\u00fcnf"}, "search": {"effort": "time", "node_spacing_max_m": 2.5, "split": "full-reach", "takeoff_angle":
    "least-time"}, "surface": {"friction_coefficient": 0.6, "rest_slope_max_deg": "inf"}, "terrain": {"chain": "chain.csv", "goal_x_m": 40.0,
    "start_x_m": -0.5}}, "inputs": [], "warnings": []}"#;

/// Bytes with a meaning in TOML or JSON, and numbers at the limits of their types.
const TELLING: &[u8] = b"[]{}\"'=.,:#\\\n\r\t 0123456789-+eE_inaftx\0\xff\xc3";
const TELLING_WORDS: [&str; 12] =
    ["nan", "inf", "-inf", "1e400", "9223372036854775808", "-0.0", "null", "{}", "[[1]]", "true", "\"auto\"", "1979-05-27"];

fn spoiled(rng: &mut ChaCha8Rng, original: &[u8]) -> Vec<u8> {
    mutated(rng, original, |rng, bytes, range| {
        let at = range.start;
        match rng.random_range(0..10) {
            0 => bytes[at] = TELLING[rng.random_range(0..TELLING.len())],
            1 => bytes.insert(at, TELLING[rng.random_range(0..TELLING.len())]),
            2 => drop(bytes.remove(at)),
            3 => drop(bytes.drain(range)),
            4 => copy(rng, bytes, range),
            5 | 6 => replace_digit(rng, bytes),
            7 | 8 => {
                let values: Vec<usize> = (1..bytes.len()).filter(|&i| matches!(bytes[i - 1], b'=' | b':')).collect();
                if !values.is_empty() {
                    let from = values[rng.random_range(0..values.len())];
                    let to = (from..bytes.len()).find(|&i| matches!(bytes[i], b'\n' | b',' | b'}')).unwrap_or(bytes.len());
                    bytes.splice(from..to, TELLING_WORDS[rng.random_range(0..TELLING_WORDS.len())].bytes());
                }
            }
            _ => truncate_or_redraw(rng, bytes, at),
        }
    })
}

/// Validates the keys; returns `true` if they are accepted.
fn is_accepted(entries: Entries, source: &str) -> bool {
    match Scenario::new(entries) {
        Ok(scenario) => {
            let document = scenario_document(&scenario, &|path| path.to_str().unwrap().to_owned());
            let text = serde_json::to_string(&document).unwrap();
            let again = Scenario::new(Entries::from_json(&serde_json::from_str(&text).unwrap()));
            assert_eq!(again.as_ref(), Ok(&scenario), "{source}");
            true
        }
        Err(problems) => {
            assert!(!problems.is_empty(), "{source}");
            for problem in &problems {
                assert!(!problem.message.is_empty() && !problem.help.is_empty(), "{problem:?}");
                if let Place::File(span) = &problem.place {
                    assert!(source.get(span.clone()).is_some(), "a span outside its text: {problem:?} in {source}");
                }
            }
            let text = ScenarioProblems { name: "s.toml".to_owned(), source: source.to_owned(), problems };
            assert!(text.to_string().len() < 100_000, "{text}");
            false
        }
    }
}

/// Both outcomes must occur; otherwise the mutations test one branch only.
fn assert_both_kinds(accepted: usize, tried: usize) {
    assert!(accepted > tried / 20 && accepted < tried * 19 / 20, "{accepted} of {tried} accepted");
}

#[test]
fn spoiled_scenarios_never_panic() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    assert!(is_accepted(Entries::from_toml(TOML), TOML));
    let accepted = (0..rounds()).filter(|_| {
        let bytes = spoiled(&mut rng, TOML.as_bytes());
        let source = String::from_utf8_lossy(&bytes);
        is_accepted(Entries::from_toml(&source), &source)
    });
    assert_both_kinds(accepted.count(), rounds());
}

#[test]
fn spoiled_results_never_panic() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let (mut tried, mut accepted) = (0, 0);
    for _ in 0..rounds() {
        let bytes = spoiled(&mut rng, JSON.as_bytes());
        let Ok(result) = serde_json::from_slice::<serde_json::Value>(&bytes) else { continue };
        tried += 1;
        let scenario = result.get("scenario").unwrap_or(&serde_json::Value::Null);
        accepted += usize::from(is_accepted(Entries::from_json(scenario), ""));
    }
    assert!(tried > rounds() / 5, "only {tried} were JSON at all");
    assert_both_kinds(accepted, tried);
}

#[test]
fn spoiled_assignments_never_panic() {
    let assignments =
        ["hopper.mass_kg=3.5", "terrain.start_m=[1, -2e1]", "search.points_per_segment=\"auto\"", "report.title=two words"];
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut accepted = 0;
    for i in 0..rounds() {
        let bytes = spoiled(&mut rng, assignments[i % assignments.len()].as_bytes());
        let assignment = String::from_utf8_lossy(&bytes);
        let mut entries = Entries::from_toml(TOML);
        entries.set("test", &assignment);
        accepted += usize::from(is_accepted(entries, TOML));
    }
    assert_both_kinds(accepted, rounds());
}
