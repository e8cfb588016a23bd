//! Both real DEMs from `chta run` to path and picture, for several transects with and without a path.
//!
//! The files are read from ../shared/dem; a test without its file prints why it is skipped. The same kinds of files and slopes are
//! tested with synthetic terrain in `shipped_scenarios.rs` and `terrain_files.rs`.

#![allow(clippy::unwrap_used, reason = "a test that cannot run the program should stop")]

use std::{fs, path::PathBuf};

use assert_cmd::Command;
use serde_json::Value;

/// One transect and its expected result.
struct Transect {
    from: [f64; 2],
    to: [f64; 2],
    /// Exit status: 0 a path, 1 none found.
    status: i32,
}

const fn transect(from: [f64; 2], to: [f64; 2], status: i32) -> Transect {
    Transect { from, to, status }
}

/// The path of a real DEM of `../shared/dem`; says so where it is absent.
pub(crate) fn real(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(name);
    if path.exists() {
        Some(path.canonicalize().unwrap())
    } else {
        #[expect(clippy::print_stderr, reason = "a skipped test says why")]
        {
            eprintln!("skipped: {} is absent", path.display());
        }
        None
    }
}

fn run_all(dem: &str, body: &str, spacing_m: f64, transects: &[Transect]) {
    let Some(dem) = real(dem) else { return };
    for (i, Transect { from, to, status }) in transects.iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let scenario = folder.path().join("scenario.toml");
        fs::write(
            &scenario,
            format!(
                "[body]\nname = \"{body}\"\n[hopper]\ntakeoff_speed_max_m_s = 10.0\nlanding_speed_max_m_s = 10.0\nclearance_m = 0.1\n\
                 [surface]\nfriction_coefficient = 0.6\n[terrain]\ndem = '{}'\nstart_m = {from:?}\ngoal_m = {to:?}\n\
                 [search]\nnode_spacing_max_m = {spacing_m:?}\n",
                dem.display()
            ),
        )
        .unwrap();
        let out = folder.path().join("out");
        let output = Command::cargo_bin("chta").unwrap().arg("run").arg(&scenario).arg("-o").arg(&out).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(*status), "transect {i} of {}: {message}", dem.display());

        let result: Value = serde_json::from_str(&fs::read_to_string(out.join("result.json")).unwrap()).unwrap();
        let svg = fs::read_to_string(out.join("path.svg")).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "transect {i}: an incomplete picture");
        let chain = fs::read_to_string(out.join("chain.csv")).unwrap();
        assert!(chain.lines().filter(|line| !line.starts_with('#')).count() > 20, "transect {i}: a short chain");
        let length_m = (to[0] - from[0]).hypot(to[1] - from[1]);
        if *status == 0 {
            let hops = result["path"].as_array().unwrap();
            assert_eq!(result["verified"], true, "transect {i}: not flown again");
            // At 10 m/s the range of a hop is v^2 / g, plus some on falling ground.
            assert!(
                f64::from(u32::try_from(hops.len()).unwrap()) >= (length_m / 75.0).ceil(),
                "transect {i}: only {} hops over {length_m} m",
                hops.len()
            );
            let last = hops.last().unwrap();
            let goal = ["landing_map_x_m", "landing_map_y_m"].map(|key| last[key].as_f64().unwrap());
            assert!((goal[0] - to[0]).abs() < 1e-6 && (goal[1] - to[1]).abs() < 1e-6, "transect {i}: lands at {goal:?}");
            let heading = last["heading_deg"].as_f64().unwrap();
            let expected = (to[0] - from[0]).atan2(to[1] - from[1]).to_degrees().rem_euclid(360.0);
            let forward = last["direction"] == "forward";
            let expected = if forward { expected } else { (expected + 180.0).rem_euclid(360.0) };
            assert!((heading - expected).abs() < 1e-6, "transect {i}: heads {heading} instead of {expected}");
        } else {
            let refused = !result["endpoint_refusals"].as_array().unwrap().is_empty();
            let stopped = result["frontier"].is_object();
            assert!(refused != stopped, "transect {i}: not exactly one reason: {result}");
        }
    }
}

#[test]
fn the_mars_hirise_dem_goes_from_file_to_picture() {
    run_all(
        "hirise_DTEEC_010228_1490_crop_120x70.tif",
        "mars",
        0.5,
        &[
            transect([5.0, 20.0], [60.0, 100.0], 0),
            transect([10.0, 10.0], [10.0, 110.0], 1),
            // Starts on slopes of 44 and 46 degrees.
            transect([60.0, 10.0], [60.0, 110.0], 1),
            transect([35.0, 60.0], [60.0, 60.0], 1),
        ],
    );
}

#[test]
fn the_ascii_grid_of_the_same_ground_gives_the_same_answers() {
    run_all(
        "hirise_DTEEC_010228_1490_crop_120x70.asc",
        "mars",
        0.5,
        &[transect([5.0, 20.0], [60.0, 100.0], 0), transect([10.0, 10.0], [10.0, 110.0], 1)],
    );
}

#[test]
fn the_lunar_lola_dem_goes_from_file_to_picture() {
    run_all(
        "lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif",
        "moon",
        5.0,
        &[
            transect([75_500.0, 38_600.0], [76_500.0, 39_500.0], 0),
            transect([75_700.0, 39_000.0], [76_000.0, 39_100.0], 0),
            transect([76_600.0, 38_400.0], [75_400.0, 39_600.0], 0),
        ],
    );
}

/// Slanted transects of both DEMs flown in headings the machine has, beside the line and around bends: every path that is found passes the
/// checker (`run` flies it again), and its picture says how it is drawn.
#[test]
fn headings_in_steps_over_real_terrain() {
    let mars = ("hirise_DTEEC_010228_1490_crop_120x70.tif", "mars", 6.0, "clearance_m = 0.2", [[12.0, 20.0], [50.0, 105.0]]);
    let braked = "clearance_m = 2\nlanding = \"braked\"\ntouchdown_speed_m_s = 1\ntakeoff_speed_step_m_s = 0.25\nmass_kg = 60\nisp_s = 220\n\
                  propellant_max_kg = 6";
    let moon = ("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", "moon", 20.0, braked, [[75_600.0, 38_600.0], [76_300.0, 39_000.0]]);
    for (dem, body, speed_m_s, keys, [start, goal]) in [mars, moon] {
        let Some(dem) = real(dem) else { continue };
        let mut flown = 0;
        for (step_deg, via) in [(10.0, false), (15.0, true), (7.0, false), (2.0, true)] {
            let folder = tempfile::tempdir().unwrap();
            let scenario = folder.path().join("scenario.toml");
            let middle = [0.5 * (start[0] + goal[0]) - 0.1 * (goal[1] - start[1]), 0.5 * (start[1] + goal[1])];
            let via = if via { format!("via_m = [{middle:?}]\n") } else { String::new() };
            fs::write(
                &scenario,
                format!(
                    "[body]\nname = \"{body}\"\n[hopper]\ntakeoff_speed_max_m_s = {speed_m_s:?}\nlanding_speed_max_m_s = {:?}\n{keys}\n\
                     heading_step_deg = {step_deg:?}\n[surface]\nfriction_coefficient = 1.0\n[terrain]\ndem = '{}'\nstart_m = {start:?}\n\
                     goal_m = {goal:?}\n{via}[search]\ntakeoff_angle = \"mid-range\"\n[uncertainty]\ntakeoff_speed_sigma_fraction = 0.001\n\
                     goal_tolerance_m = 30\ntrials = 20\n",
                    1.2 * speed_m_s,
                    dem.display()
                ),
            )
            .unwrap();
            let out = folder.path().join("out");
            let output = Command::cargo_bin("chta").unwrap().arg("run").arg(&scenario).arg("-o").arg(&out).output().unwrap();
            let message = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
            assert!(matches!(output.status.code(), Some(0 | 1)), "{body} {step_deg}: {message}");
            let result: Value = serde_json::from_str(&fs::read_to_string(out.join("result.json")).unwrap()).unwrap();
            if output.status.code() == Some(1) {
                assert!(result["commands_refusal"].is_string() || result["hops"].is_null(), "{body} {step_deg}: {message}");
                continue;
            }
            flown += 1;
            assert_eq!(result["verified"], true, "{body} {step_deg}: {message}");
            for hop in result["path"].as_array().unwrap() {
                let turns = hop["heading_deg"].as_f64().unwrap() / step_deg;
                assert!((turns - turns.round()).abs() < 1e-9 && hop["landing_miss_across_m"].is_f64(), "{hop}");
            }
            assert!(fs::read_to_string(out.join("path.svg")).unwrap().contains("drawn projected"), "{body} {step_deg}");
        }
        assert!(flown >= 2, "{body}: {flown} paths of 4");
    }
}
