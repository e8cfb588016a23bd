//! Keep-out zones, friction rasters and fans from the command line.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![expect(clippy::print_stderr, reason = "a test that is skipped says why")]

use std::{fs, path::Path, process::Output};

use assert_cmd::Command;
use chta::terrain::{Dem, GeoReference, write_ascii_grid};
use serde_json::Value;

const HOPPER: &str = "[body]\ngravity_m_s2 = 2.0\n[hopper]\ntakeoff_speed_max_m_s = 6.0\nlanding_speed_max_m_s = 6.0\n";

fn chta(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("chta").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", text(&output.stderr)))
}

/// A folder with a flat raster of 5 m posts over 60 m by 60 m, and files.
fn stage(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let map = GeoReference::local(chta::quantity::MapPoint::new(0.0, 60.0), 5.0, 5.0).unwrap();
    let dem = Dem::new(13, 13, vec![1.0; 169], map).unwrap();
    write_ascii_grid(&dem, fs::File::create(folder.path().join("plain.asc")).unwrap()).unwrap();
    for (name, content) in files {
        fs::write(folder.path().join(name), content).unwrap();
    }
    folder
}

fn zone(west: f64, east: f64) -> String {
    format!(r#"{{"type":"Polygon","coordinates":[[[{west},0],[{east},0],[{east},60],[{west},60],[{west},0]]]}}"#)
}

fn scenario(surface: &str) -> String {
    format!(
        "{HOPPER}[surface]\nfriction_coefficient = 0.8\n{surface}\n[terrain]\ndem = \"plain.asc\"\nstart_m = [2, 30]\ngoal_m = [58, 30]\n\
         [search]\npoints_per_segment = 1\n"
    )
}

#[test]
fn a_zone_is_flown_over_but_not_landed_on_and_a_run_repeats_it() {
    let folder = stage(&[
        ("zones.geojson", &zone(21.5, 33.25)),
        ("wide.geojson", &zone(10.0, 40.0)),
        ("open.toml", &scenario("")),
        ("kept.toml", &scenario("keep_out = \"zones.geojson\"")),
        ("wide.toml", &scenario("keep_out = \"wide.geojson\"")),
    ]);
    let at = folder.path();
    let kept = chta(at, &["plan", "kept.toml", "--verify", "--format", "json"]);
    let document = json(&kept);
    assert_eq!((kept.status.code(), &document["verified"]), (Some(0), &Value::Bool(true)), "{document}");
    let hops = document["path"].as_array().unwrap();
    // At most 17.6 m per hop: the zone of 11.75 m can be flown over. Map x is chain x + 2 m.
    for hop in hops {
        let landing = hop["landing_map_x_m"].as_f64().unwrap();
        assert!(!(21.5 + 1e-6..=33.25 - 1e-6).contains(&landing), "lands at {landing} m");
    }
    assert!(hops.iter().any(|hop| hop["takeoff_map_x_m"].as_f64() < Some(21.6) && hop["landing_map_x_m"].as_f64() > Some(33.2)));
    assert!(document["refusals"]["keep-out"].as_u64().unwrap() > 0, "counted under its own name");
    assert_eq!(document["inputs"][1]["name"], "zones.geojson");
    let run = chta(at, &["run", "kept.toml", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let chain = fs::read_to_string(at.join("out/chain.csv")).unwrap();
    assert!(chain.contains("keep_out") && chain.contains("19.5,") && chain.contains("31.25,"), "{chain}");
    let again = chta(at, &["run", "out/result.json", "-o", "again"]);
    assert_eq!(again.status.code(), Some(0), "{}", text(&again.stderr));
    for name in ["chain.csv", "path.csv", "result.json"] {
        let read = |folder: &str| fs::read_to_string(at.join(folder).join(name)).unwrap();
        let without_comments = |text: String| text.lines().filter(|line| !line.starts_with('#')).collect::<Vec<_>>().join("\n");
        assert_eq!(without_comments(read("out")), without_comments(read("again")), "{name}");
    }
    // The chain carries its zones itself; the scenario's file is then not read, and a warning says so.
    let from_chain =
        chta(at, &["check", "out/chain.csv", "--scenario", "kept.toml", "--start", "0", "--goal", "56", "--format", "json"]);
    assert_eq!(json(&from_chain)["hops"], document["hops"]);
    assert!(text(&from_chain.stderr).contains("surface.keep_out"));
    // One hop cannot cross 30 m.
    assert_eq!(chta(at, &["check", "open.toml"]).status.code(), Some(0));
    assert_eq!(chta(at, &["check", "wide.toml"]).status.code(), Some(1));
}

#[test]
fn a_start_or_goal_in_a_zone_or_on_a_steep_slope_is_reported() {
    let folder = stage(&[("zones.geojson", &zone(0.0, 20.0)), ("kept.toml", &scenario("keep_out = \"zones.geojson\""))]);
    let output = chta(folder.path(), &["check", "kept.toml", "--format", "json"]);
    let answer = json(&output);
    assert_eq!(output.status.code(), Some(1));
    let refusal = &answer["endpoint_refusals"][0];
    assert_eq!((&refusal["endpoint"], &refusal["limit"]), (&Value::from("start"), &Value::from("keep-out")), "{answer}");
    assert!((refusal["nearest_usable_x_m"].as_f64().unwrap() - 18.0).abs() < 1.0, "{answer}");
    // A rest slope is reported under its own name: the same start on a wall.
    let chain = "x_m,z_m\n0,0\n10,0\n11,30\n21,30\n";
    fs::write(folder.path().join("wall.csv"), chain).unwrap();
    fs::write(folder.path().join("bare.toml"), format!("{HOPPER}[surface]\nfriction_coefficient = 0.8\n")).unwrap();
    let wall = chta(
        folder.path(),
        &[
            "check",
            "wall.csv",
            "--scenario",
            "bare.toml",
            "--start",
            "0",
            "--goal",
            "21",
            "--points-per-segment",
            "3",
            "--format",
            "json",
        ],
    );
    assert!(json(&wall)["refusals"]["rest-slope"].as_u64().unwrap() > 0);
}

#[test]
fn friction_rasters_reach_the_chain_and_fill_their_gaps_with_the_constant() {
    let grid = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 30\nNODATA_value -1\n0.5 -1 0.9\n0.5 -1 0.9\n";
    let folder = stage(&[("mu.asc", grid), ("mu.toml", &scenario("friction_raster = \"mu.asc\""))]);
    let at = folder.path();
    let sliced = chta(at, &["slice", "plain.asc", "--from", "2,40", "--to", "58,40", "--scenario", "mu.toml"]);
    let rows: Vec<String> = text(&sliced.stdout).lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect();
    let column = rows[0].split(',').position(|name| name == "friction_coefficient").unwrap();
    let coefficients: Vec<(f64, f64)> = rows[1..rows.len() - 1]
        .iter()
        .map(|row| row.split(',').collect::<Vec<_>>())
        .map(|fields| (fields[0].parse().unwrap(), fields[column].parse().unwrap()))
        .collect();
    assert!(coefficients.iter().all(|&(x_m, mu)| mu == if x_m < 28.0 { 0.5 } else { 0.8 }), "{coefficients:?}");
    let without = format!("{HOPPER}[surface]\nfriction_raster = \"mu.asc\"\n");
    fs::write(at.join("without.toml"), without).unwrap();
    let refused = chta(at, &["slice", "plain.asc", "--from", "2,40", "--to", "58,40", "--scenario", "without.toml"]);
    assert_eq!(refused.status.code(), Some(2));
    let said = text(&refused.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("no data at map point"), "{said}");
    let chain = format!("{HOPPER}[surface]\nkeep_out = \"z.geojson\"\n[terrain]\nchain = \"c.csv\"\n");
    fs::write(at.join("chain.toml"), chain).unwrap();
    let refused = chta(at, &["check", "chain.toml"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("surface.keep_out"));
}

#[test]
fn a_fan_over_a_plain_reaches_every_end_with_the_fewest_hops() {
    let folder = stage(&[
        ("zones.geojson", &zone(40.0, 58.0)),
        ("open.toml", &scenario("")),
        ("kept.toml", &scenario("keep_out = \"zones.geojson\"")),
    ]);
    let at = folder.path();
    let fan = |more: &[&str]| {
        let mut arguments = vec!["fan", "plain.asc", "--from", "30,30", "--headings", "8", "--length", "31", "--format", "json"];
        arguments.extend(more);
        chta(at, &arguments)
    };
    let open = fan(&["--scenario", "open.toml", "--plot", "rose.svg"]);
    let document = json(&open);
    assert_eq!((open.status.code(), &document["schema"]), (Some(0), &Value::from("chta/fan/1")));
    let rays = document["rays"].as_array().unwrap();
    assert_eq!(rays.len(), 8);
    for (k, ray) in (0_u32..).zip(rays) {
        // Along the axes the border cuts at 30 m; the corners are farther than 31 m.
        let (length_m, cut) = if k % 2 == 0 { (30.0, Value::from("border")) } else { (31.0, Value::Null) };
        assert!((ray["length_m"].as_f64().unwrap() - length_m).abs() < 1e-9 && ray["cut"] == cut, "{ray}");
        assert_eq!(ray["heading_deg"].as_f64().unwrap(), 45.0 * f64::from(k));
        // 18 m sin(2 (90 deg - atan 0.8)) = 17.56 m per hop, and a node between 13.44 and 17.56 m: two hops.
        assert_eq!(
            (&ray["hops_to_end"], &ray["hops_to_farthest"], &ray["first_refusing_limit"]),
            (&Value::from(2), &Value::from(2), &Value::Null)
        );
        assert_eq!(ray["farthest_m"], ray["length_m"]);
        let bands = ray["bands"].as_array().unwrap();
        assert_eq!(
            (&bands[0]["hops"], bands[0]["from_m"].as_f64(), &bands.last().unwrap()["to_m"]),
            (&Value::from(0), Some(0.0), &ray["length_m"])
        );
    }
    let svg = fs::read_to_string(at.join("rose.svg")).unwrap();
    assert!(
        svg.starts_with("<svg") && svg.contains("2 hops") && svg.contains("N (grid)") && !svg.contains("not reached"),
        "{}",
        &svg[..400]
    );
    // The same for any number of threads.
    for threads in ["1", "3"] {
        let other = fan(&["--scenario", "open.toml", "--threads", threads]);
        assert_eq!(text(&other.stdout), text(&open.stdout));
    }
    // A zone 18 m wide to the east: the fan ends at its near border in that direction.
    let kept = json(&fan(&["--scenario", "kept.toml", "-o", "fan.csv", "--plot", "kept.svg"]));
    assert!(fs::read_to_string(at.join("kept.svg")).unwrap().contains("not reached"));
    let east = &kept["rays"][2];
    assert!((east["farthest_m"].as_f64().unwrap() - 10.0).abs() < 1e-9 && east["hops_to_end"].is_null(), "{east}");
    assert_eq!(east["first_refusing_limit"], "keep-out");
    let table = fs::read_to_string(at.join("fan.csv")).unwrap();
    assert_eq!(
        table.lines().next().unwrap(),
        "heading_deg,length_m,cut,farthest_m,hops_to_farthest,hops_to_end,first_refusing_limit"
    );
    assert!(table.lines().nth(3).unwrap().starts_with("90,30,border,10,1,,keep-out"), "{table}");
    for (from, length, expected) in [("70,30", "10", "off the map"), ("30,30", "0", "length is 0 m")] {
        let refused = chta(at, &["fan", "plain.asc", "--from", from, "--length", length, "--scenario", "open.toml"]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(text(&refused.stderr).contains(expected), "{}", text(&refused.stderr));
    }
}

#[test]
fn no_data_cuts_a_fan_where_it_begins() {
    let folder = stage(&[("open.toml", &scenario(""))]);
    let map = GeoReference::local(chta::quantity::MapPoint::new(0.0, 60.0), 5.0, 5.0).unwrap();
    let mut posts = vec![1.0; 169];
    for row in 0..13 {
        posts[row * 13 + 10] = f64::NAN;
    }
    let dem = Dem::new(13, 13, posts, map).unwrap();
    write_ascii_grid(&dem, fs::File::create(folder.path().join("gap.asc")).unwrap()).unwrap();
    let fan = chta(
        folder.path(),
        &["fan", "gap.asc", "--from", "30,30", "--headings", "4", "--length", "28", "--scenario", "open.toml", "--format", "json"],
    );
    let document = json(&fan);
    // The column at x = 50 m is missing, so that ground ends at 45 m.
    let east = &document["rays"][1];
    assert!((east["length_m"].as_f64().unwrap() - 15.0).abs() < 1e-4 && east["cut"] == "no-data", "{east}");
    assert!(document["rays"][3]["cut"].is_null());
    let inside =
        chta(folder.path(), &["fan", "gap.asc", "--from", "50,30", "--headings", "4", "--length", "28", "--scenario", "open.toml"]);
    assert_eq!(inside.status.code(), Some(2));
    assert!(text(&inside.stderr).contains("no-data"));
}

#[test]
fn fans_of_real_terrain_end_where_their_slices_do() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem");
    let folder = stage(&[("open.toml", &scenario(""))]);
    for name in ["hirise_DTEEC_010228_1490_crop_120x70.tif", "lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif"] {
        let file = shared.join(name);
        if !file.exists() {
            eprintln!("skipped: {} is not there", file.display());
            continue;
        }
        let dem = chta::terrain::read_dem(&file).unwrap();
        let middle = dem.georeference().post(dem.rows() / 2, dem.cols() / 2);
        let from = format!("{},{}", middle.x, middle.y);
        let output = chta(
            folder.path(),
            &[
                "fan",
                file.to_str().unwrap(),
                "--from",
                &from,
                "--headings",
                "12",
                "--length",
                "60",
                "--scenario",
                "open.toml",
                "--format",
                "json",
            ],
        );
        let document = json(&output);
        for ray in document["rays"].as_array().unwrap() {
            let number = |key: &str| ray[key].as_f64().unwrap();
            assert!(number("farthest_m") <= number("length_m") && number("length_m") <= 60.0 + 1e-9, "{ray}");
            assert_eq!(ray["hops_to_end"].is_null(), number("farthest_m") < number("length_m"), "{ray}");
            assert_eq!(ray["first_refusing_limit"].is_null(), !ray["hops_to_end"].is_null(), "{ray}");
        }
    }
}
