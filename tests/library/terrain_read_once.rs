//! Of a scenario whose keys are varied the raster and its overlays are read once: the answers need their files no more.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]

use std::{fs, path::Path};

use chta::{
    scenario::{Entries, Scenario},
    study::{Requirement, SweptKey, Trade, Variation, require, trade},
    terrain::{SyntheticTerrain, synthesise, write_ascii_grid},
};

/// Hops over synthetic ground with a friction raster, whose success is estimated by trials over the DEM.
const SCENARIO: &str = "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 6\nlanding_speed_max_m_s = 6\n[surface]\n\
    friction_coefficient = 0.8\nfriction_raster = \"friction.asc\"\n[terrain]\ndem = \"ground.asc\"\nstart_m = [2, 8]\ngoal_m = [14, 9]\n\
    [search]\nnode_spacing_max_m = 2\n[uncertainty]\ntakeoff_speed_sigma_fraction = 0.02\ngoal_tolerance_m = 2\n[budget]\n\
    estimated_success_min = 0.5\n";

fn write_terrain(folder: &Path) {
    let dem = synthesise(&SyntheticTerrain { rows: 18, cols: 18, ..SyntheticTerrain::default() }).unwrap();
    write_ascii_grid(&dem, fs::File::create(folder.join("ground.asc")).unwrap()).unwrap();
    fs::write(folder.join("friction.asc"), "ncols 2\nnrows 2\nxllcorner -20\nyllcorner -20\ncellsize 40\n0.9 0.9\n0.9 0.9\n")
        .unwrap();
}

fn varied_from(entries: Entries, first: Entries, folder: &Path) -> Variation {
    Variation::new(entries, Scenario::new(first).unwrap(), folder).unwrap()
}

#[test]
fn every_value_of_a_varied_key_is_answered_from_one_reading() {
    for (key, range) in [
        ("hopper.landing_speed_max_m_s", "4:6:3"),
        ("uncertainty.takeoff_speed_sigma_fraction", "0.01:0.05:3"),
        ("derating.friction", "0.8:1:3"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let (folder, entries) = (folder.path(), Entries::from_toml(SCENARIO));
        write_terrain(folder);
        let swept = [SweptKey::parse(&format!("{key}={range}")).unwrap()];
        let first = Trade::first_cell(&entries, &swept, "test").unwrap();
        let traded_over = varied_from(entries.clone(), first, folder);
        let [from, to] = [swept[0].values()[0], swept[0].values()[2]];
        let requirement = Requirement::new(key, [Some(from), Some(to)], 0.2, 100, "test").unwrap();
        let required_over = varied_from(entries.clone(), requirement.strongest(&entries), folder);
        let answers = || {
            let traded = trade(&traded_over, &swept, None, &()).unwrap();
            assert!(traded.failed.is_empty(), "{key}: {:?}", traded.failed);
            let estimated = traded.answer.rows.iter().filter(|row| row.success_budget.is_some()).count();
            assert!(estimated > 1, "{key}: only {estimated} cells flew trials");
            (format!("{:?}", traded.answer), require(&required_over, &requirement, &()).unwrap().answer)
        };
        let read = answers();
        fs::remove_file(folder.join("ground.asc")).unwrap();
        fs::remove_file(folder.join("friction.asc")).unwrap();
        assert!(Variation::new(entries, traded_over.first.scenario.clone(), folder).is_err(), "the files are gone");
        assert!(answers() == read, "{key}");
    }
}
