//! `--trajectory`: the path in time as a file, of every command that has a path, and what is refused.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::path::Path;

use serde_json::Value;

use crate::desk::Desk;

/// A table: its header and its rows.
fn table(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect());
    (lines.next().unwrap(), lines.collect())
}

/// Compares a trajectory with the path of a document: all take-offs and landings are there, and the apex is not passed.
fn agrees(text: &str, path: &Value, gravity_m_s2: f64) {
    let (header, rows) = table(text);
    let column = |name: &str| header.iter().position(|other| other == name).unwrap();
    let number = |row: &[String], name: &str| row[column(name)].parse::<f64>().unwrap();
    let hops = path.as_array().unwrap();
    for hop in hops {
        let of = |key: &str| hop[key].as_f64().unwrap();
        let own = hop["hop"].to_string();
        let flight: Vec<_> = rows.iter().filter(|row| row[column("hop")] == own && row[column("phase")] == "flight").collect();
        let (first, last) = (flight[0], flight[flight.len() - 1]);
        for (row, name, key) in [
            (first, "x_m", "takeoff_x_m"),
            (first, "z_m", "takeoff_z_m"),
            (last, "x_m", "landing_x_m"),
            (last, "z_m", "landing_z_m"),
        ] {
            assert_eq!(number(row, name), of(key), "{name} {key}");
        }
        assert!((number(last, "time_s") - number(first, "time_s") - of("flight_time_s")).abs() < 1e-9);
        let speed = |row: &[String]| number(row, "vx_m_s").hypot(number(row, "vz_m_s"));
        assert!((speed(first) - of("takeoff_speed_m_s")).abs() < 1e-9 && (speed(last) - of("landing_speed_m_s")).abs() < 1e-9);
        let highest = flight.iter().map(|row| number(row, "z_m")).fold(f64::NEG_INFINITY, f64::max);
        let apart_s = of("flight_time_s") / 20.0;
        assert!(highest <= of("apex_z_m") + 1e-9 && of("apex_z_m") - highest < gravity_m_s2 * apart_s * apart_s, "{highest}");
        if header.iter().any(|name| name == "map_x_m") {
            assert_eq!(number(last, "map_x_m"), of("landing_map_x_m"));
            let heading = of("heading_deg").to_radians();
            let across = number(first, "vx_m_s").abs();
            assert!((number(first, "v_map_x_m_s") - across * heading.sin()).abs() < 1e-9);
        }
        if header.iter().any(|name| name == "lon_deg") {
            assert_eq!((number(first, "lon_deg"), number(last, "lat_deg")), (of("takeoff_lon_deg"), of("landing_lat_deg")));
            let heading = of("heading_true_deg").to_radians();
            let across = number(first, "vx_m_s").abs();
            assert!((number(first, "v_north_m_s") - across * heading.cos()).abs() < 1e-7);
            assert!((number(first, "v_east_m_s") - across * heading.sin()).abs() < 1e-7);
        }
    }
    assert!(rows.iter().all(|row| row.len() == header.len()));
    let times: Vec<f64> = rows.iter().map(|row| number(row, "time_s")).collect();
    assert!(times.is_sorted());
}

#[test]
fn every_command_with_a_path_writes_it_in_time() {
    let desk = Desk::with_dem();
    for scenario in ["scenario.toml", "map.toml"] {
        let rests = ["--set", "hopper.rest_time_s=2.5"];
        let plan = desk.json(&[&["plan", scenario, "--trajectory", "plan.csv"][..], &rests].concat());
        agrees(&desk.read("plan.csv"), &plan["path"], 3.711);
        let (header, rows) = table(&desk.read("plan.csv"));
        let on_map = &["map_x_m", "map_y_m", "v_map_x_m_s", "v_map_y_m_s"][..];
        let columns =
            [&["time_s", "hop", "phase", "x_m", "z_m", "vx_m_s", "vz_m_s"][..], if scenario == "map.toml" { on_map } else { &[] }];
        assert_eq!(header, columns.concat());
        let last_s: f64 = rows.last().unwrap()[0].parse().unwrap();
        assert!((last_s - plan["totals"]["mission_time_s"].as_f64().unwrap()).abs() < 1e-9);
        assert!(plan["hops"] == 1 || rows.iter().any(|row| row[2] == "rest" && row[5] == "0"));
        for words in [&["run", scenario, "-o", "out"][..], &["simulate", scenario, "--trials", "20"]] {
            let ran = desk.run(&[words, &["--trajectory", "other.csv"], &rests].concat());
            assert_eq!(ran.status, 0, "{ran:?}");
            assert_eq!(desk.read("other.csv"), desk.read("plan.csv"), "{words:?}");
        }
    }
    let hop = desk.json(&["hop", "scenario.toml", "--from", "0", "--to", "10", "--trajectory", "hop.csv", "--step-s", "0.125"]);
    let (_, rows) = table(&desk.read("hop.csv"));
    let best = &hop["best"];
    assert!((rows.last().unwrap()[0].parse::<f64>().unwrap() - best["flight_time_s"].as_f64().unwrap()).abs() < 1e-9);
    for (i, row) in rows.iter().take(rows.len() - 1).enumerate() {
        assert_eq!(row[0].parse::<f64>().unwrap(), 0.125 * f64::from(u32::try_from(i).unwrap()));
    }
}

#[test]
fn a_trajectory_in_the_folder_of_a_run_makes_the_folder() {
    let desk = Desk::with_dem();
    for (folder, file) in [("new", "new/t.csv"), ("one/two", "one/two/t.csv")] {
        let ran = desk.run(&["run", "scenario.toml", "-o", folder, "--trajectory", file]);
        assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{ran:?}");
        assert!(desk.read(file).lines().count() > 10 && desk.path().join(folder).join("path.csv").exists());
    }
}

#[test]
fn without_a_path_the_table_is_its_header() {
    let desk = Desk::with_dem();
    for words in [
        &["plan", "scenario.toml", "--set", "surface.rest_slope_max_deg=1"][..],
        &["hop", "scenario.toml", "--set", "surface.rest_slope_max_deg=1"],
        &["simulate", "scenario.toml", "--set", "surface.rest_slope_max_deg=1"],
        &["run", "scenario.toml", "-o", "out", "--set", "surface.rest_slope_max_deg=1"],
    ] {
        let ran = desk.run(&[words, &["--trajectory", "none.csv"]].concat());
        assert_eq!(ran.status, 1, "{ran:?}");
        assert_eq!(desk.read("none.csv"), "time_s,hop,phase,x_m,z_m,vx_m_s,vz_m_s\n", "{words:?}");
    }
}

#[test]
fn what_is_no_trajectory_is_refused_and_leaves_files_as_they_were() {
    let desk = Desk::with_dem();
    desk.write("old.csv", "of yesterday\n");
    for command in [&["plan", "scenario.toml"][..], &["run", "scenario.toml", "-o", "out"], &["hop", "scenario.toml", "--to", "10"]]
    {
        #[rustfmt::skip]
        let cases: [(&[&str], &[&str]); 7] = [
            (&["--trajectory", "old.txt"], &["--trajectory old.txt", "ends in .csv"]),
            (&["--trajectory", "chain.csv"], &["chain.csv", "this command reads the file"]),
            (&["--trajectory", "no/where.csv"], &["no/where.csv", "cannot be written"]),
            (&["--step-s", "0.1"], &["--trajectory"]),
            (&["--trajectory", "old.csv", "--step-s", "0"], &["--step-s: found 0, expected a number of seconds above 0"]),
            (&["--trajectory", "old.csv", "--step-s", "-2"], &["--step-s: found -2"]),
            (&["--trajectory", "old.csv", "--step-s", "1e-12"], &["--step-s", "GB", "expected at most 1000000", "a step of at least"]),
        ];
        for (options, parts) in cases {
            desk.refused(&[command, options].concat(), parts);
            assert_eq!(desk.read("old.csv"), "of yesterday\n", "{options:?}");
        }
    }
    desk.refused(&["plan", "scenario.toml", "--trajectory", "one.csv", "-o", "one.csv"], &["one.csv", "two answers"]);
    desk.refused(
        &["simulate", "scenario.toml", "--experiment", "worst-drift", "--trajectory", "old.csv"],
        &["--trajectory", "--experiment"],
    );
}

/// At the shipped polar site the two norths are 62.8 degrees apart; GDAL's longitudes say so too (`map_projection.rs`).
#[test]
fn a_path_at_the_south_pole_of_the_moon_has_both_headings_everywhere() {
    let dem = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem/lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif");
    if !dem.exists() {
        eprintln!("skipped: {} is absent", dem.display());
        return;
    }
    let desk = Desk::new();
    let hopper = "[hopper]\ntakeoff_speed_max_m_s = 8\nlanding_speed_max_m_s = 8\n[surface]\nfriction_coefficient = 0.6\n";
    let terrain = format!("[terrain]\ndem = \"{}\"\nstart_m = [75500, 38500]\ngoal_m = [75560, 38560]\n", dem.display());
    let errors = "[uncertainty]\nheading_sigma_deg = 1\ntrials = 20\n";
    desk.write("s.toml", format!("[body]\nname = \"moon\"\n{hopper}{terrain}{errors}[search]\nnode_spacing_max_m = 5\n"));
    let plan = desk.json(&["plan", "s.toml", "--trajectory", "t.csv", "-o", "path.csv", "--geojson", "path.geojson"]);
    agrees(&desk.read("t.csv"), &plan["path"], 1.624);
    for hop in plan["path"].as_array().unwrap() {
        let of = |key: &str| hop[key].as_f64().unwrap();
        // On a south polar map with the meridian of 0 upwards north lies at the longitude, clockwise.
        let apart = (of("heading_deg") - of("heading_true_deg")).rem_euclid(360.0);
        assert!((apart - of("takeoff_lon_deg")).abs() < 1e-6 && (apart - 62.9).abs() < 0.2, "{apart}");
    }
    let (header, rows) = table(&desk.read("path.csv"));
    let column = header.iter().position(|name| name == "heading_true_deg").unwrap();
    assert_eq!(rows[0][column].parse::<f64>().unwrap(), plan["path"][0]["heading_true_deg"].as_f64().unwrap());
    let geojson: Value = serde_json::from_str(&desk.read("path.geojson")).unwrap();
    let properties = &geojson["features"][0]["properties"];
    assert_eq!(properties["heading_true_deg"], plan["path"][0]["heading_true_deg"]);
    assert_eq!(properties["margin_terrain_m"], plan["path"][0]["margins"]["terrain_m"]);
    assert!(properties.get("margins").is_none(), "{properties}");
    let text = desk.run(&["plan", "s.toml"]).stdout;
    assert!(text.contains(" grid (deg) true (deg)") && text.contains("  45.000    342.0"), "{text}");
    desk.run(&["simulate", "s.toml", "-o", "landings.csv"]);
    let (header, rows) = table(&desk.read("landings.csv"));
    let number = |row: &[String], name: &str| row[header.iter().position(|other| other == name).unwrap()].parse::<f64>().unwrap();
    for row in &rows {
        let apart = (number(row, "heading_deg") - number(row, "heading_true_deg")).rem_euclid(360.0);
        assert!((apart - 62.9).abs() < 0.2, "{row:?}");
    }
    assert!(!rows.is_empty());
    let fan = ["fan", dem.to_str().unwrap(), "--from", "75500,38500", "--headings", "3", "--length", "30", "--scenario", "s.toml"];
    let fan = desk.json(&[&fan[..], &["--plot", "fan.svg"]].concat());
    let ray = &fan["rays"][1];
    assert!((ray["heading_deg"].as_f64().unwrap() - ray["heading_true_deg"].as_f64().unwrap() - 62.98).abs() < 0.01, "{ray}");
    assert!(desk.read("fan.svg").contains("true north, 63.0 deg clockwise from grid north"));
    let start = ["map", dem.to_str().unwrap(), "--start", "75500,38500", "--goal", "75540,38540", "--scenario", "s.toml"];
    let map =
        desk.run(&[&start[..], &["--stride", "4", "--plot", "map.svg", "--profiles", "hops.svg", "--paths", "p.csv"]].concat());
    assert_eq!(map.status, 0, "{map:?}");
    assert!(desk.read("map.svg").contains("N (true, at the middle)") && desk.read("map.svg").contains("N (grid)"));
    assert!(desk.read("hops.svg").contains("° grid, ") && desk.read("hops.svg").contains("° true"));
    assert!(desk.read("p.csv").lines().next().unwrap().contains(",landing_lat_deg,heading_true_deg,"));
}
