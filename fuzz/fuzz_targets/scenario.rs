//! Any bytes as a scenario (TOML), and as a result (JSON): no panic, positions inside the text, and an accepted one reads back equal after
//! writing.
#![no_main]

use chta::scenario::{Entries, Place, Scenario, scenario_document};
use libfuzzer_sys::fuzz_target;

/// Validates keys that came from a text.
fn validate(entries: Entries, source: &str) {
    match Scenario::new(entries) {
        Ok(scenario) => {
            let written = scenario_document(&scenario, &|path| path.to_str().expect("it came from UTF-8").to_owned());
            let text = serde_json::to_string(&written).expect("plain data can be written");
            let again = Scenario::new(Entries::from_json(&serde_json::from_str(&text).expect("what was written is JSON")));
            assert_eq!(again, Ok(scenario));
        }
        Err(problems) => {
            assert!(!problems.is_empty());
            for problem in problems {
                if let Place::File(span) = problem.place {
                    assert!(source.get(span).is_some());
                }
            }
        }
    }
}

fuzz_target!(|source: &str| {
    validate(Entries::from_toml(source), source);
    let mut entries = Entries::from_toml("body.gravity_m_s2 = 1");
    entries.set("fuzz", source);
    validate(entries, "body.gravity_m_s2 = 1");
    if let Ok(scenario) = serde_json::from_str(source) {
        validate(Entries::from_json(&scenario), "");
    }
});
