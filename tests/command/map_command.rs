//! `chta map` as a user sees it: document, rasters, paths, pictures, exit status, bad input.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use std::{fs, path::Path, process::Command};

use crate::desk::{self, Desk};
use chta::terrain::Dem;
use serde_json::Value;

use crate::installed::installed;

/// Level ground of 30 x 20 posts of 1 m with a wall of steep posts across it, a gap in the wall in the north, and a hole in the
/// south-east.
fn walled() -> Desk {
    let desk = Desk::new();
    let mut grid = "ncols 30\nnrows 20\nxllcorner 99.5\nyllcorner 199.5\ncellsize 1\nNODATA_value -9999\n".to_owned();
    for row in 0..20 {
        let post = |col: usize| match (row, col) {
            (17.., 25..) => "-9999",
            (3.., 14) => "30",
            _ => "0",
        };
        grid.push_str(&(0..30).map(post).collect::<Vec<_>>().join(" "));
        grid.push('\n');
    }
    desk.write("walled.asc", grid);
    desk.write(
        "hopper.toml",
        "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 2.5\n[surface]\nfriction_coefficient = 0.6\n",
    );
    desk
}

const MAP: [&str; 6] = ["map", "walled.asc", "--start", "102,205", "--scenario", "hopper.toml"];

fn hops_at(dem: &Dem, x: f64, y: f64) -> Option<f64> {
    let map = dem.georeference();
    let (col, row) = ((x - map.north_west().x) / map.dx_m(), (map.north_west().y - y) / map.dy_m());
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]
    dem.elevation(row.round() as usize, col.round() as usize)
}

#[test]
fn the_document_and_the_raster_agree() {
    let desk = walled();
    let goals = ["--goal", "127.2,205.4", "--goal", "114,205", "-o", "hops.tif", "--return", "--return-output", "back.tif"];
    let document = desk.json(&[&MAP[..], &goals].concat());
    assert_eq!(document["schema"], "chta/map/1");
    assert_eq!((document["posts"].as_u64(), document["no_data_posts"].as_u64()), (Some(600), Some(15)));
    assert_eq!(document["start_m"], serde_json::json!([102.0, 205.0]));
    assert_eq!(document["start_offset_m"], 0.0);
    let raster = desk::raster(&desk.path().join("hops.tif"));
    let counted: Vec<Option<f64>> = raster.elevations().collect();
    let count = |which: &dyn Fn(f64) -> bool| counted.iter().flatten().filter(|&&hops| which(hops)).count() as u64;
    assert_eq!(counted.iter().filter(|hops| hops.is_none()).count(), 15);
    assert_eq!(document["reachable_posts"].as_u64(), Some(count(&|hops| hops >= 0.0)));
    assert_eq!(document["reachable_area_m2"].as_f64(), document["reachable_posts"].as_f64());
    let histogram: Vec<u64> = document["hops_histogram"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    for (hops, posts) in histogram.iter().enumerate() {
        let hops = f64::from(u32::try_from(hops).unwrap());
        assert_eq!(*posts, count(&|found| found == hops), "{hops} hops");
    }
    assert_eq!(document["farthest_hops"].as_u64(), Some(histogram.len() as u64 - 1));
    // The path to the other side of the wall leads through the gap; the wall itself is too steep.
    let [behind, wall] = [&document["goals"][0], &document["goals"][1]];
    assert_eq!((behind["x_m"].as_f64(), behind["y_m"].as_f64()), (Some(127.0), Some(205.0)));
    assert!((behind["offset_m"].as_f64().unwrap() - 0.2f64.hypot(0.4)).abs() < 1e-9);
    assert_eq!(behind["hops"].as_f64(), hops_at(&raster, 127.0, 205.0));
    assert!(behind["hops"].as_u64() > Some(7), "{behind}");
    assert_eq!(behind["hops"], behind["return_hops"], "level ground is the same both ways");
    assert_eq!((&wall["hops"], &wall["path"]), (&Value::Null, &serde_json::json!([])));
    assert_eq!(hops_at(&raster, 114.0, 205.0), Some(-1.0));
    let back = desk::raster(&desk.path().join("back.tif"));
    assert!(back.elevations().eq(raster.elevations()));
    assert_eq!(document["return"]["round_trip_posts"], document["reachable_posts"]);
    // 20 x 30 posts: the reachable posts of the border are those outside wall and hole.
    let on_border = |row: usize, col: usize| row == 0 || col == 0 || row == 19 || col == 29;
    let at_border = (0..600).filter(|i| on_border(i / 30, i % 30) && counted[*i].is_some_and(|hops| hops >= 0.0)).count();
    assert_eq!(document["reachable_posts_at_border"].as_u64(), Some(at_border as u64));
    assert!(document["reachable_posts_at_no_data"].as_u64() > Some(5));
}

/// Every edge of a path gives the hop of the map when it is recomputed with `chta slice` and `chta hop`.
#[test]
fn every_hop_of_a_path_is_confirmed_by_slice_and_hop() {
    let desk = walled();
    let document =
        desk.json(&[&MAP[..], &["--goal", "127,205", "--effort", "--paths", "paths.csv", "--geojson", "paths.geojson"]].concat());
    let path = document["goals"][0]["path"].as_array().unwrap();
    assert_eq!(Some(path.len() as u64), document["goals"][0]["hops"].as_u64());
    let mut along = 0.0;
    for hop in path {
        let place = |end: &str| format!("{},{}", hop[format!("{end}_map_x_m")], hop[format!("{end}_map_y_m")]);
        let sliced = desk.run(&["slice", "walled.asc", "--from", &place("takeoff"), "--to", &place("landing"), "-o", "edge.csv"]);
        assert_eq!(sliced.status, 0, "{}", sliced.stderr);
        let length = hop["landing_x_m"].as_f64().unwrap() - hop["takeoff_x_m"].as_f64().unwrap();
        assert!((hop["takeoff_x_m"].as_f64().unwrap() - along).abs() < 1e-9);
        along += length;
        let end_m = desk.read("edge.csv").lines().last().unwrap().split(',').next().unwrap().to_owned();
        let found = desk.json(&["hop", "edge.csv", "--from", "0", "--to", &end_m, "--scenario", "hopper.toml"]);
        assert_eq!(found["feasible"], true);
        for (ours, theirs) in [
            (&hop["takeoff_angle_min_deg"], &found["takeoff_angle_min_deg"]),
            (&hop["takeoff_angle_max_deg"], &found["takeoff_angle_max_deg"]),
            (&hop["takeoff_speed_m_s"], &found["best"]["takeoff_speed_m_s"]),
        ] {
            assert!((ours.as_f64().unwrap() - theirs.as_f64().unwrap()).abs() < 1e-9, "{ours} against {theirs}");
        }
    }
    let speeds: f64 = path.iter().map(|hop| hop["takeoff_speed_m_s"].as_f64().unwrap()).sum();
    assert!(speeds <= document["effort"]["greatest"].as_f64().unwrap() + 1e-9);
    let csv = desk.read("paths.csv");
    assert!(csv.starts_with("goal,hop,direction,takeoff_x_m,"), "{csv}");
    assert_eq!(csv.lines().count(), 1 + path.len());
    let features: Value = serde_json::from_str(&desk.read("paths.geojson")).unwrap();
    let lines = features["features"].as_array().unwrap().iter().filter(|f| f["geometry"]["type"] == "LineString");
    assert_eq!(lines.clone().count(), path.len());
    assert!(lines.clone().all(|line| line["properties"]["goal"] == 1));
}

#[test]
fn the_text_names_the_effort_of_a_map_as_a_sum() {
    let desk = walled();
    for (effort, words) in [("takeoff-speed", "sum of take-off speeds"), ("peak-speed", "largest take-off speed")] {
        let words = format!("\n{words}: at most ");
        let ran = desk.run(&[&MAP[..], &["--effort", effort]].concat());
        assert!(ran.stdout.contains(&words) && !ran.stdout.contains(effort), "{}", ran.stdout);
    }
    let document = desk.json(&[&MAP[..], &["--effort", "time"]].concat());
    assert_eq!((&document["effort"]["kind"], &document["effort"]["unit"]), (&"time".into(), &"s".into()));
    assert_eq!(document["effort"].as_object().unwrap().len(), 3);
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let desk = walled();
    let with = |threads: &str| {
        let files = [
            "-o",
            "h.tif",
            "--effort",
            "--effort-output",
            "e.tif",
            "--mobility",
            "m.tif",
            "--goal",
            "127,205",
            "--threads",
            threads,
        ];
        let document = desk.json(&[&MAP[..], &files].concat());
        (document, ["h.tif", "e.tif", "m.tif"].map(|name| fs::read(desk.path().join(name)).unwrap()))
    };
    assert!(with("1") == with("4"));
}

#[test]
fn exit_status_is_1_where_a_goal_is_out_of_reach_and_2_with_a_sentence_for_bad_input() {
    let desk = walled();
    assert_eq!(desk.run(&[&MAP[..], &["--goal", "127,205"]].concat()).status, 0);
    let ran = desk.run(&[&MAP[..], &["--goal", "127,205", "--goal", "114,205"]].concat());
    assert_eq!(ran.status, 1, "{ran:?}");
    assert!(ran.stdout.contains("not reached over these nodes"), "{}", ran.stdout);
    let start = |place: &'static str| ["map", "walled.asc", "--start", place, "--scenario", "hopper.toml"];
    desk.refused(&start("300,205"), &["walled.asc", "--start", "off the map", "x from 100"]);
    desk.refused(&start("127,200"), &["--start", "no elevation", "choose a start where"]);
    desk.refused(&[&MAP[..], &["--goal", "127,200"]].concat(), &["--goal", "no elevation", "choose a goal where"]);
    desk.refused(&[&MAP[..], &["--stride", "0"]].concat(), &["--stride", "at least 1"]);
    desk.refused(&[&MAP[..], &["--plot", "map.jpg"]].concat(), &["map.jpg"]);
    desk.refused(&[&MAP[..], &["-o", "missing/hops.tif"]].concat(), &["missing/hops.tif", "cannot be written"]);
    desk.refused(&["map", "walled.asc", "--start", "102,205", "--body", "moon"], &["friction_coefficient"]);
    let made = desk.run(&["synth", "--rows", "300", "--cols", "300", "--no-ground", "-o", "wide.asc"]);
    assert_eq!(made.status, 0, "{}", made.stderr);
    let far = ["--set", "hopper.takeoff_speed_max_m_s=40", "--set", "hopper.landing_speed_max_m_s=40", "--scenario", "hopper.toml"];
    desk.refused(&[&["map", "wide.asc", "--start", "9,9"], &far[..]].concat(), &["wide.asc", "one hop reaches", "give --stride 4"]);
    let fits = desk.run(&[&["map", "wide.asc", "--start", "9,9", "--stride", "4"], &far[..]].concat());
    assert_eq!(fits.status, 0, "the stride that the sentence names: {}", fits.stderr);
    desk.refused(&[&MAP[..], &["-o", "hops.png"]].concat(), &["-o hops.png", ".tif"]);
    desk.refused(&[&MAP[..], &["--goal", "127,205", "--paths", "-"]].concat(), &["--paths -", ".csv"]);
    desk.refused(&[&MAP[..], &["--threads", "100000"]].concat(), &["--threads", "512"]);
    let merged = [&MAP[..], &["--goal", "114,205", "--stride", "40"]].concat();
    desk.refused(&merged, &["--stride 40", "(102.000, 205.000) m and (114.000, 205.000) m have the same nearest post"]);
    desk.refused(&[&MAP[..], &["--effort", "cheer"]].concat(), &["--effort", "takeoff-speed"]);
}

/// A DEM has no columns, so missing limits are named by their keys, all at once, with the options that set them.
#[test]
fn missing_keys_of_a_map_are_named() {
    let desk = walled();
    let bare = ["walled.asc", "--body", "moon"];
    let speeds = "no hopper.takeoff_speed_max_m_s, no hopper.landing_speed_max_m_s";
    let options =
        "--set hopper.takeoff_speed_max_m_s=8 --set hopper.landing_speed_max_m_s=8 --set surface.friction_coefficient=0.6";
    for command in [&["map", "--start", "102,205"][..], &["fan", "--from", "102,205", "--length", "5"]] {
        let words = [command, &bare[..]].concat();
        desk.refused(&words, &[speeds, "surface.friction_coefficient (or surface.takeoff_from_slope_deg", options]);
        assert!(!desk.run(&words).stderr.contains("segment"), "{words:?}");
        // The options in the message solve the problem.
        let sets: Vec<&str> = options.split(' ').collect();
        assert_eq!(desk.run(&[&words[..], &sets].concat()).status, 0);
    }
    desk.write("grip.toml", "[body]\nname = \"moon\"\n[surface]\nfriction_coefficient = 0.6\n");
    desk.refused(
        &["map", "walled.asc", "--start", "102,205", "--scenario", "grip.toml"],
        &["grip.toml: found ", speeds, "--set hopper"],
    );
    let given = desk.run(&["map", "walled.asc", "--start", "102,205", "--scenario", "grip.toml"]).stderr;
    assert!(!given.contains("surface"), "{given}");
    // A scenario in place of the DEM, with any content.
    desk.refused(
        &["map", "grip.toml", "--start", "1,1"],
        &["grip.toml: found no terrain.dem, expected one for a map", "with --scenario grip.toml"],
    );
    desk.refused(&["fan", "grip.toml", "--from", "1,1", "--length", "3"], &["grip.toml: this is a scenario (TOML)"]);
}

#[test]
fn one_hop_is_written_in_the_singular() {
    let desk = walled();
    let near = desk.run(&[&MAP[..], &["--goal", "103,205", "--return"]].concat());
    assert!(near.stdout.contains("given place: 1 hop, 1 hop back\n"), "{}", near.stdout);
}

/// Friction and zones without effect on the DEM or the transect give a warning.
#[test]
fn overlays_without_effect_give_warnings() {
    let desk = walled();
    let raster = |west: f64, values: &str| format!("ncols 2\nnrows 2\nxllcorner {west}\nyllcorner 189\ncellsize 20\n{values}\n");
    desk.write("far.asc", raster(900.0, "0.3 0.3\n0.3 0.3"));
    desk.write("here.asc", raster(90.0, "0.5 0.5\n0.5 0.5"));
    desk.write("free.asc", raster(90.0, "0 0\n0 0"));
    desk.write("kept.asc", raster(90.0, "0 1\n0 0"));
    let zone = |x: f64| format!(r#"{{"type":"Polygon","coordinates":[[[{x},217],[{x},218],[{0},218],[{x},217]]]}}"#, x + 1.0);
    desk.write("north.geojson", zone(104.0));
    let on = "[terrain]\ndem = \"walled.asc\"\nstart_m = [101, 205]\ngoal_m = [112, 205]\n[search]\nnode_spacing_max_m = 1\n";
    desk.write("journey.toml", desk.read("hopper.toml") + on);
    let no_data = "friction raster 'far.asc' has no data on";
    let cases = [
        ("friction_raster", "far.asc", Some((no_data, "the DEM")), Some((no_data, "the transect"))),
        ("friction_raster", "here.asc", None, None),
        (
            "keep_out",
            "free.asc",
            Some(("'free.asc': no zone meets", "the DEM")),
            Some(("'free.asc': no zone meets", "the transect")),
        ),
        ("keep_out", "kept.asc", None, Some(("'kept.asc': no zone meets", "the transect"))),
        ("keep_out", "north.geojson", None, Some(("'north.geojson': no zone meets", "the transect"))),
    ];
    for (key, file, over_dem, along) in cases {
        let set = format!("surface.{key}=\"{file}\"");
        let fan = ["fan", "walled.asc", "--from", "102,205", "--length", "3", "--headings", "4", "--scenario", "hopper.toml"];
        let commands =
            [(&MAP[..], over_dem), (&fan, over_dem), (&["plan", "journey.toml"], along), (&["simulate", "journey.toml"], along)];
        for (command, expected) in commands {
            let words = [command, &["--set", &set]].concat();
            let output = desk.run(&words).stderr;
            let warnings = desk.json(&words)["warnings"].to_string();
            match expected {
                Some((what, place)) => {
                    let said = format!("{what} {place}");
                    assert!(
                        output.matches(&said).count() == 1 && warnings.matches(&said).count() == 1,
                        "{words:?}: {output}{warnings}"
                    );
                }
                None => assert!(!output.contains(file) && !warnings.contains(file), "{words:?}: {output}{warnings}"),
            }
        }
    }
    let slice = ["slice", "walled.asc", "--from", "101,205", "--to", "112,205", "--scenario", "journey.toml", "-o", "c.csv"];
    let ran = desk.run(&slice);
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
    desk.write("journey.toml", desk.read("journey.toml").replace("[surface]", "[surface]\nfriction_raster = \"far.asc\""));
    assert!(desk.run(&slice).stderr.contains(no_data) && desk.read("c.csv").contains("# warning: friction raster 'far.asc'"));
}

#[test]
fn a_result_repeats_with_its_terrain_and_says_so_without() {
    let desk = walled();
    let first = desk.json(&MAP);
    desk.write("map.json", first.to_string());
    let again = desk.json(&["map", "walled.asc", "--start", "102,205", "--scenario", "map.json"]);
    assert_eq!(again, first);
    desk.refused(&["run", "map.json", "-o", "again"], &["map.json", "no terrain", "chta map", "--scenario map.json"]);
}

#[test]
fn the_refusal_of_a_start_or_goal_is_reported() {
    let desk = walled();
    // On the flank of the wall, which rises by 30 m over 1 m.
    let document = desk.json(&["map", "walled.asc", "--start", "114,205", "--goal", "102,205", "--scenario", "hopper.toml"]);
    let warnings = document["warnings"].as_array().unwrap();
    // Whole metres on posts 1 m apart have steps of 45 degrees.
    assert!(warnings.len() == 3 && warnings[0].as_str().unwrap().contains("45.0 degrees"), "{warnings:?}");
    assert!(warnings[1].as_str().unwrap().contains("nodes of the map, 1 m apart, fewer than 8"), "{warnings:?}");
    let said = warnings[2].as_str().unwrap();
    for part in ["the start's post (114.000, 205.000) m slopes 88.1 deg", "ends at 31.0 deg", "usable one is (113.000, 205.000) m"]
    {
        assert!(said.contains(part), "{said}");
    }
    let zone = r#"{"type":"Polygon","coordinates":[[[101,204],[103,204],[103,206],[101,206],[101,204]]]}"#;
    desk.write("zone.geojson", zone);
    let ran = desk.run(&[&MAP[..], &["--goal", "120,205", "--set", "surface.keep_out=\"zone.geojson\""]].concat());
    assert_eq!(ran.status, 1, "{ran:?}");
    assert!(ran.stderr.contains("the start's post (102.000, 205.000) m lies in a keep-out zone"), "{}", ran.stderr);
}

/// No command overwrites a file that it reads, under any name, or writes two results to one file.
#[test]
fn no_file_is_written_over_another() {
    let desk = walled();
    let before = desk.read("walled.asc");
    fs::hard_link(desk.path().join("walled.asc"), desk.path().join("other.tif")).unwrap();
    for file in ["other.tif", "./other.tif"] {
        desk.refused(&[&MAP[..], &["-o", file]].concat(), &[file, "this command reads the file", "another file"]);
    }
    desk.refused(&[&MAP[..], &["-o", "x.tif", "--return", "--return-output", "./x.tif"]].concat(), &["./x.tif", "two answers"]);
    desk.refused(
        &["slice", "walled.asc", "--from", "101,205", "--to", "110,205", "-o", "walled.asc"],
        &["walled.asc", "reads the file"],
    );
    desk.refused(&["plan", "scenario.toml", "--plot", "a.svg", "-o", "a.svg"], &["a.svg", "two answers"]);
    desk.refused(&["plan", "scenario.toml", "-o", "chain.csv"], &["chain.csv", "reads the file"]);
    // A run writes its own chain.csv; a result may be repeated into its own folder.
    desk.refused(&["run", "scenario.toml", "-o", "."], &["chain.csv", "reads the file"]);
    assert_eq!(desk.run(&["run", "scenario.toml", "-o", "out"]).status, 0);
    let result = desk.read("out/result.json");
    assert_eq!(desk.run(&["run", "out/result.json", "-o", "out"]).status, 0);
    assert_eq!(desk.read("out/result.json"), result);
    assert_eq!(desk.read("walled.asc"), before);
    assert!(!desk.path().join("x.tif").exists() && !desk.path().join("a.svg").exists());
}

#[test]
fn a_stride_lands_on_fewer_posts_over_the_same_terrain() {
    let desk = walled();
    let document = desk.json(&[&MAP[..], &["--stride", "3", "-o", "hops.tif", "--mobility", "m.tif"]].concat());
    assert_eq!((document["posts"].as_u64(), document["stride"].as_u64()), (Some(70), Some(3)));
    // The nodes are at rows 0, 3, .. from the north: the nearest to (102, 205) is (103, 204) or nearer.
    let raster = desk::raster(&desk.path().join("hops.tif"));
    assert_eq!((raster.rows(), raster.cols()), (7, 10));
    let map = raster.georeference();
    assert_eq!((map.dx_m(), map.dy_m(), map.north_west().x, map.north_west().y), (3.0, 3.0, 100.0, 219.0));
    let start = &document["start_m"];
    assert_eq!(hops_at(&raster, start[0].as_f64().unwrap(), start[1].as_f64().unwrap()), Some(0.0));
    assert_eq!(document["reachable_area_m2"].as_f64(), document["reachable_posts"].as_f64().map(|posts| posts * 9.0));
}

#[test]
fn mobility_counts_the_disc_and_its_directions() {
    let desk = walled();
    let document = desk.json(&[&MAP[..], &["--mobility", "m.tif"]].concat());
    let mobility = &document["mobility"];
    assert!((mobility["disc_radius_m"].as_f64().unwrap() - 2.5 * 2.5 / 1.624).abs() < 0.01, "{mobility}");
    // Posts at the border have only a part of their disc, so the best post is one of them.
    assert!(mobility["best_directions"].as_f64() >= Some(5.0), "{mobility}");
    assert!(mobility["best_share"].as_f64() <= Some(1.0), "{mobility}");
    assert!(mobility["mean_share"].as_f64() < mobility["best_share"].as_f64());
}

#[test]
fn pictures_are_complete_and_of_the_format_of_their_extension() {
    let desk = walled();
    let ran = desk.run(&[&MAP[..], &["--goal", "127,205", "--plot", "map.svg", "--profiles", "hops.svg", "--quiet"]].concat());
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    assert!(desk.read("map.svg").contains("</svg>"));
    let profiles = desk.read("hops.svg");
    assert!(profiles.trim_end().ends_with("</svg>") && profiles.contains("goal 1, hop 1 of"));
    assert_eq!((profiles.matches("<svg ").count(), profiles.matches("</svg>").count()), (1, 1), "one page");
    desk.run(&[&MAP[..], &["--plot", "map.png"]].concat());
    assert!(fs::read(desk.path().join("map.png")).unwrap().starts_with(b"\x89PNG\r\n"));
}

/// The output of gdalinfo; `None` with a printed reason if it is not installed.
fn gdal_says(file: &Path) -> Option<Value> {
    if !installed("gdalinfo") {
        return None;
    }
    let output = Command::new("gdalinfo").args(["-json"]).arg(file).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

#[test]
fn gdal_reads_position_reference_system_and_no_data_of_the_input() {
    let input = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem/lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif");
    if !input.exists() {
        eprintln!("skipped: {} is absent", input.display());
        return;
    }
    let desk = walled();
    let file = input.to_str().unwrap();
    let outputs = ["-o", "hops.tif", "--effort", "--effort-output", "effort.tif", "--mobility", "mobility.tif"];
    // At 2 m/s no hop spans a post, so only the start is reachable and the files are created quickly.
    let speeds = ["--set", "hopper.takeoff_speed_max_m_s=3", "--set", "hopper.landing_speed_max_m_s=3"];
    let ran = desk.run(&[&["map", file, "--start", "76000,39000", "--scenario", "hopper.toml"][..], &outputs, &speeds].concat());
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let Some(original) = gdal_says(&input) else { return };
    for (name, kind, no_data, bands) in
        [("hops.tif", "Int16", "-32768.0", 1), ("effort.tif", "Float32", "\"NaN\"", 1), ("mobility.tif", "Float32", "\"NaN\"", 2)]
    {
        let found = gdal_says(&desk.path().join(name)).unwrap();
        for key in ["size", "geoTransform", "coordinateSystem", "cornerCoordinates"] {
            // The map is named by its code, which the input leaves unsaid.
            let named = original[key].to_string().replace(r#"PROJCRS[\"unknown"#, r#"PROJCRS[\"IAU_2015:30135"#);
            assert_eq!(found[key].to_string(), named, "{name}: {key}");
        }
        let found = found["bands"].as_array().unwrap().clone();
        assert_eq!(found.len(), bands);
        for band in found {
            assert_eq!(band["type"], kind);
            assert_eq!(band["noDataValue"].to_string(), no_data, "{name}");
            assert_eq!(band["block"], serde_json::json!([256, 256]));
            assert!(!band["description"].as_str().unwrap().is_empty());
        }
    }
}

/// Every path is flown again before it is printed, and `--simulate` flies it with the trial code of transects.
#[test]
fn paths_are_verified_and_simulated_the_same_for_any_number_of_threads() {
    let desk = walled();
    let scenario = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 2.5\n[surface]\n\
                    friction_coefficient = 1.2\n[search]\ntakeoff_angle = \"mid-range\"\n[uncertainty]\n\
                    takeoff_speed_sigma_fraction = 0.02\nheading_sigma_deg = 0.5\ngoal_tolerance_m = 0.6\ntrials = 400\nseed = 5\n";
    desk.write("errors.toml", scenario);
    let asked = ["map", "walled.asc", "--start", "102,205", "--goal", "108,206", "--goal", "114,205", "--simulate", "--scenario"];
    let document = |more: &[&str]| desk.json(&[&asked[..], more].concat());
    let open_loop = ["errors.toml", "--set", "uncertainty.policy=open-loop"];
    let found = document(&[&open_loop[..], &["--threads", "1"]].concat());
    assert_eq!(found["goals"], document(&[&open_loop[..], &["--threads", "3"]].concat())["goals"]);
    let [reached, walled_in] = [&found["goals"][0], &found["goals"][1]];
    assert_eq!(reached["verified"], true);
    let simulation = &reached["simulation"];
    assert_eq!((simulation["trials"].as_u64(), simulation["policy"].as_str()), (Some(400), Some("open-loop")));
    let rate = simulation["success_rate"].as_f64().unwrap();
    assert!(rate > 0.1 && rate < 1.0, "some trials land beyond the tolerance: {rate}");
    assert_eq!(simulation["landings"].as_array().unwrap().len() as u64, reached["hops"].as_u64().unwrap());
    assert_eq!((&walled_in["hops"], &walled_in["verified"], walled_in.get("simulation")), (&Value::Null, &Value::Null, None));
    // Without errors every trial is the plan.
    let exact = document(&["hopper.toml", "--set", "uncertainty.trials=50"]);
    assert_eq!(exact["goals"][0]["simulation"]["success_rate"], 1.0);
    assert!(exact["warnings"].to_string().contains("no errors are given"), "{}", exact["warnings"]);
    // Where errors are given, a robot replans unless the scenario says otherwise: over the posts, by their risks or by their costs.
    let mut rates = vec![rate];
    for risk in ["ignored", "traded"] {
        let replanned = |threads| document(&["errors.toml", "--set", &format!("search.risk={risk}"), "--threads", threads]);
        let found = replanned("1");
        assert_eq!(found["goals"], replanned("3")["goals"], "{risk}");
        assert!(!found["warnings"].to_string().contains("search.risk"), "{}", found["warnings"]);
        let simulation = &found["goals"][0]["simulation"];
        assert_eq!((simulation["trials"].as_u64(), simulation["policy"].as_str()), (Some(400), Some("replan")));
        rates.push(simulation["success_rate"].as_f64().unwrap());
    }
    assert!(rates[2] >= rates[0] && rates[2] >= rates[1] && rates[2] > 0.95, "open loop, by costs, by risks: {rates:?}");
}

/// The success of a path is estimated by trials of their own, whatever the seed and number of the trials that are flown beside it.
#[test]
fn the_success_of_paths_over_a_map_is_estimated_beside_their_trials() {
    let desk = walled();
    let errors =
        "[uncertainty]\ntakeoff_speed_sigma_fraction = 0.02\nheading_sigma_deg = 0.5\ngoal_tolerance_m = 0.6\ntrials = 2000\n";
    desk.write("errors.toml", desk.read("hopper.toml").replace("= 0.6", "= 1.2") + errors);
    let map = ["map", "walled.asc", "--start", "102,205", "--goal", "108,206", "--goal", "114,205", "--scenario", "errors.toml"];
    for (policy, risk) in [("open-loop", "ignored"), ("replan", "ignored"), ("replan", "traded")] {
        let [of_policy, of_risk] = [format!("uncertainty.policy={policy}"), format!("search.risk={risk}")];
        let flown = [&map[..], &["--simulate", "--set", &of_policy, "--set", &of_risk]].concat();
        let [found, other] = [&[][..], &["--set", "uncertainty.seed=77", "--set", "uncertainty.trials=40"]].map(|more| {
            let document = desk.json(&[&flown[..], more].concat());
            assert_eq!(document["goals"][1]["totals"], Value::Null);
            document["goals"][0].clone()
        });
        assert_eq!((&found["totals"]["success_policy"], &found["totals"]), (&policy.into(), &other["totals"]), "{policy}, {risk}");
        let [estimated, rate] =
            [&found["totals"]["success_estimated"], &found["simulation"]["success_rate"]].map(|share| share.as_f64().unwrap());
        assert_eq!((512.0 * estimated).fract(), 0.0, "{estimated} of 512 trials");
        // Four standard deviations of the difference of a rate of 512 trials and one of 2 000, at most.
        assert!((estimated - rate).abs() < 4.0 * (0.25 * (1.0 / 512.0 + 1.0 / 2000.0_f64)).sqrt(), "{estimated}, {rate}");
        let text = desk.run(&flown).stdout;
        let line =
            format!("goal (108.000, 206.000) m\nestimated success: {estimated:.4} under {policy}, by 512 fixed trials\n{policy}: ");
        assert!(text.contains(&line), "{text}");
    }
    // Neither without trials nor without errors.
    let exact = [&map[..6], &["--scenario", "hopper.toml", "--simulate"]].concat();
    for words in [&map[..], &exact] {
        let totals = desk.json(words)["goals"][0]["totals"].clone();
        assert_eq!(totals.get("success_estimated"), None, "{words:?}");
    }
}
