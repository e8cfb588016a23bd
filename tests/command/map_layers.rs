//! Layers and keep-in zones of a scenario, through the commands.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use serde_json::{Value, json};

use crate::desk::Desk;

/// A level map of 41 by 21 posts, 1 m apart, and hops of at most 4 m over it from west to east.
fn level() -> Desk {
    let desk = Desk::new();
    desk.write("level.asc", grid(41, 21, |_, _| "0"));
    let scenario = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 2.5\nlanding_speed_max_m_s = 2.5\n[surface]\n\
                    friction_coefficient = 1.0\n[terrain]\ndem = \"level.asc\"\nstart_m = [2, 10]\ngoal_m = [38, 10]\nroute = \"free\"\n\
                    [search]\nnode_spacing_max_m = 1.0\n";
    desk.write("free.toml", scenario);
    desk.write("straight.toml", scenario.replace("route = \"free\"\n", ""));
    desk
}

fn grid(cols: usize, rows: usize, value: impl Fn(usize, usize) -> &'static str) -> String {
    let row = |row: usize| (0..cols).map(|col| value(row, col)).collect::<Vec<_>>().join(" ");
    let rows_text: Vec<String> = (0..rows).map(row).collect();
    format!("ncols {cols}\nnrows {rows}\nxllcenter 0\nyllcenter 0\ncellsize 1\nNODATA_value -9999\n{}\n", rows_text.join("\n"))
}

/// A band of shade across the map, 2 m wide, with a gap in the north; and one too wide to hop over, without a gap.
fn shade(desk: &Desk) {
    desk.write("band.asc", grid(41, 21, |row, col| if (20..22).contains(&col) && row > 2 { "0.1" } else { "0.9" }));
    desk.write("wide.asc", grid(41, 21, |_, col| if (20..26).contains(&col) { "0.1" } else { "0.9" }));
}

fn landings(document: &Value) -> Vec<[f64; 2]> {
    let of = |hop: &Value, key: &str| hop[key].as_f64().unwrap();
    document["path"].as_array().unwrap().iter().map(|hop| [of(hop, "landing_map_x_m"), of(hop, "landing_map_y_m")]).collect()
}

#[test]
fn hops_cross_a_band_that_is_refused_to_contacts_and_go_round_one_that_is_refused_to_flights() {
    let desk = level();
    shade(&desk);
    let set = |more: &str| format!("layer.sun={{ raster = \"band.asc\", min = 0.3{more} }}");
    let bare = desk.json(&["plan", "free.toml"]);
    let over = desk.json(&["plan", "free.toml", "--set", &set("")]);
    assert_eq!(over["verified"], true);
    let in_shade = |at: &[f64; 2]| (19.5..=21.5).contains(&at[0]) && at[1] <= 17.5;
    assert!(landings(&bare).iter().any(in_shade) || bare["hops"] == over["hops"], "{bare}");
    assert!(!landings(&over).iter().any(in_shade), "{over}");
    let round = desk.json(&["plan", "free.toml", "--set", &set(", applies_to = \"flight\"")]);
    assert_eq!(round["verified"], true);
    assert!(landings(&round).iter().any(|at| at[1] > 17.5), "through the gap in the north: {round}");
    assert!(round["hops"].as_u64() >= over["hops"].as_u64());
    // The straight transect has no way round.
    let straight = ["check", "straight.toml", "--set"];
    assert_eq!(desk.run(&[&straight[..], &[&set("")]].concat()).status, 0);
    let ran = desk.run(&[&straight[..], &[&set(", applies_to = \"flight\"")]].concat());
    assert_eq!(ran.status, 1);
    assert!(ran.stdout.contains("layer:sun"), "{}", ran.stdout);
    // A result is repeated with its layers.
    let written = desk.run(&["run", "free.toml", "-o", "out", "--set", &set("")]);
    assert_eq!(written.status, 0, "{}", written.stderr);
    let again = desk.run(&["run", "out/result.json", "-o", "again"]);
    assert_eq!(again.status, 0, "{}", again.stderr);
    assert_eq!(desk.read("out/path.csv"), desk.read("again/path.csv"));
    assert!(desk.read("out/result.json").contains("\"sun\""));
}

#[test]
fn a_no_names_the_layer() {
    let desk = level();
    shade(&desk);
    let wide = ["--set", "layer.sun={ raster = \"wide.asc\", min = 0.3 }"];
    let ran = desk.run(&[&["check", "free.toml"][..], &wide].concat());
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    // A narrow band that may not be flown over: its two sides are within one hop, which the layer refuses.
    desk.write("narrow.asc", grid(41, 21, |_, col| if col == 20 { "0.1" } else { "0.9" }));
    let narrow = ["check", "free.toml", "--set", "layer.sun={ raster = \"narrow.asc\", min = 0.3, applies_to = \"flight\" }"];
    let document = desk.json(&narrow);
    assert!(document["route"]["gap"]["refusals"]["layer:sun"].as_u64().unwrap() > 0, "{}", document["route"]["gap"]);
    assert!(desk.run(&narrow).stdout.contains("layer:sun"));
    // Another value lets it through.
    let lower = [&["check", "free.toml"][..], &wide, &["--set", "layer.sun.min=0.05"]].concat();
    let ran = desk.run(&lower);
    assert_eq!(ran.status, 0);
    assert!(!ran.stderr.contains("is replaced"), "{}", ran.stderr);
    // One hop into the shade, limit by limit.
    let hop = ["hop", "level.asc", "--from", "18,10", "--to", "20,10", "--scenario", "free.toml"];
    let document = desk.json(&[&hop[..], &wide].concat());
    assert_eq!((&document["feasible"], &document["binding"]["conflict"]), (&json!(false), &json!(["layer:sun"])), "{document}");
    let flight = desk.json(&[&hop[..], &wide, &["--set", "layer.sun.applies_to=flight"]].concat());
    assert_eq!(flight["binding"]["conflict"], json!(["layer:sun"]), "{flight}");
    // A start in the shade.
    let ran = desk.run(&[&["check", "free.toml", "--start", "22,10"][..], &wide].concat());
    assert_eq!(ran.status, 1);
    assert!(ran.stdout.contains("no hop leads away from the start"), "{}", ran.stdout);
}

#[test]
fn a_map_is_that_of_the_same_cells_kept_out_and_draws_them_by_their_reason() {
    let desk = level();
    shade(&desk);
    desk.write("mask.asc", grid(41, 21, |row, col| if (20..22).contains(&col) && row > 2 { "1" } else { "0" }));
    let map = ["map", "level.asc", "--start", "2,10", "--scenario", "free.toml", "--set"];
    let layer = "layer.sun={ raster = \"band.asc\", min = 0.3 }";
    let by_layer = desk.json(&[&map[..], &[layer, "--plot", "map.svg"]].concat());
    let by_mask = desk.json(&[&map[..], &["surface.keep_out=mask.asc"]].concat());
    assert_eq!(by_layer["reachable_posts"], by_mask["reachable_posts"]);
    assert_eq!(by_layer["hops_histogram"], by_mask["hops_histogram"]);
    assert_eq!(by_layer["reachable_posts"], 41 * 21 - 2 * 18);
    let picture = desk.read("map.svg");
    assert!(picture.contains("layer sun does not hold, not reached: 36 posts"), "{picture}");
}

#[test]
fn trials_lose_what_lands_in_the_shade() {
    let desk = level();
    shade(&desk);
    let errors = ["uncertainty.takeoff_speed_sigma_fraction=0.05", "uncertainty.goal_tolerance_m=3", "uncertainty.trials=200"];
    let mut args = vec!["simulate", "free.toml", "--policy", "open-loop"];
    args.extend(errors.iter().flat_map(|error| ["--set", error]));
    let lost = |document: &Value| document["outcomes"]["lost"].as_u64().unwrap_or(0);
    let bare = desk.json(&args);
    for applies_to in ["contact", "flight"] {
        let layer = format!("layer.sun={{ raster = \"band.asc\", min = 0.3, applies_to = \"{applies_to}\" }}");
        let under = desk.json(&[&args[..], &["--set", &layer]].concat());
        assert!(lost(&under) > lost(&bare) + 5, "{applies_to}: {} {}", under["outcomes"], bare["outcomes"]);
    }
}

#[test]
fn wheels_obey_layers() {
    let desk = level();
    shade(&desk);
    let drives = "\n[drive]\nspeed_m_s = 0.1\nslope_up_max_deg = 20\ntravel = \"drive\"\n";
    desk.write("drive.toml", desk.read("free.toml") + drives);
    let set = ["--set", "layer.sun={ raster = \"band.asc\", min = 0.3 }"];
    let bare = desk.json(&["plan", "drive.toml"]);
    let round = desk.json(&[&["plan", "drive.toml"][..], &set].concat());
    let length = |document: &Value| {
        let legs = document["path"].as_array().unwrap();
        legs.iter().map(|leg| leg["length_m"].as_f64().unwrap()).sum::<f64>()
    };
    assert!(length(&round) > length(&bare) + 3.0, "{} {}", length(&round), length(&bare));
    let ran = desk.run(&["plan", "drive.toml", "--set", "layer.sun={ raster = \"wide.asc\", min = 0.3 }"]);
    assert_eq!(ran.status, 1, "{}", ran.stderr);
}

#[test]
fn keep_in_zones_bound_the_landings() {
    let desk = level();
    let site = r#"{"type": "Polygon", "coordinates": [[[1, 6], [39, 6], [39, 12], [1, 12], [1, 6]]]}"#;
    desk.write("site.geojson", site);
    let set = ["--set", "surface.keep_in=site.geojson"];
    let map = desk.json(&[&["map", "level.asc", "--start", "2,10", "--scenario", "free.toml"][..], &set].concat());
    assert_eq!(map["reachable_posts"], 39 * 7, "posts of the polygon, its border included");
    assert_eq!(desk.json(&[&["plan", "free.toml"][..], &set].concat())["verified"], true);
    let ran = desk.run(&[&["check", "free.toml", "--goal", "38,4"][..], &set].concat());
    assert_eq!(ran.status, 1, "{}", ran.stdout);
    assert!(ran.stdout.contains("keep-out"), "{}", ran.stdout);
    // As a mask: a cell that is not zero is allowed, its border to another one is not.
    desk.write("site.asc", grid(41, 21, |row, col| if (8..15).contains(&row) && (1..40).contains(&col) { "1" } else { "0" }));
    let set = ["--set", "surface.keep_in=site.asc"];
    let masked = desk.json(&[&["map", "level.asc", "--start", "2,10", "--scenario", "free.toml"][..], &set].concat());
    assert_eq!(masked["reachable_posts"], 39 * 7);
    let far = r#"{"type": "Polygon", "coordinates": [[[100, 100], [110, 100], [110, 110], [100, 100]]]}"#;
    desk.write("far.geojson", far);
    let ran = desk.run(&["check", "free.toml", "--set", "surface.keep_in=far.geojson"]);
    assert_eq!(ran.status, 2);
    assert!(ran.stderr.contains("keep-in zones") && ran.stderr.contains("off the terrain"), "{}", ran.stderr);
}

#[test]
fn wrong_layers_are_refused_in_a_sentence() {
    let desk = level();
    shade(&desk);
    for (set, words) in [
        ("layer.sun={ raster = \"none.asc\", min = 1 }", ["none.asc", "layer"]),
        ("layer.sun={ raster = \"band.asc\" }", ["no condition", "min"]),
        ("layer.sun={ raster = \"free.toml\", min = 1 }", ["free.toml", "layer"]),
    ] {
        let ran = desk.run(&["check", "free.toml", "--set", set]);
        assert_eq!(ran.status, 2, "{set}: {}", ran.stdout);
        assert!(words.iter().all(|word| ran.stderr.contains(word)), "{set}: {}", ran.stderr);
    }
    let set = ["--set", "layer.sun={ raster = \"band.asc\", min = 0.3 }"];
    let ran = desk.run(&[&["check", "scenario.toml"][..], &set].concat());
    assert_eq!(ran.status, 2, "a chain has no map");
    assert!(ran.stderr.contains("laid over a map"), "{}", ran.stderr);
    desk.write("layered.toml", desk.read("free.toml") + "[layer.sun]\nraster = \"band.asc\"\nmin = 0.3\n");
    let sliced =
        desk.run(&["slice", "level.asc", "--from", "2,10", "--to", "38,10", "--scenario", "layered.toml", "-o", "cut.csv"]);
    assert!(sliced.status == 0 && sliced.stderr.contains("no columns for layers"), "{}", sliced.stderr);
    let ran = desk.run(&["check", "cut.csv", "--start", "0", "--goal", "36", "--scenario", "layered.toml"]);
    assert!(ran.stderr.contains("layer.sun is laid over a map"), "{}", ran.stderr);
}

/// What `gdal_viewshed` sees, as it comes.
#[test]
fn layers_of_gdal_are_read_as_they_come() {
    let desk = level();
    let made = std::process::Command::new("gdal_viewshed")
        .current_dir(desk.path())
        .args(["-q", "-ox", "2", "-oy", "10", "-oz", "1", "-md", "25", "level.asc", "seen.tif"])
        .output();
    let Ok(made) = made else {
        eprintln!("skipped: gdal_viewshed is not installed");
        return;
    };
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let set = ["--set", "layer.link={ raster = \"seen.tif\", equals = 255 }"];
    let map = ["map", "level.asc", "--start", "2,10", "--scenario", "free.toml"];
    let document = desk.json(&[&map[..], &set].concat());
    let posts = document["reachable_posts"].as_u64().unwrap();
    // A disc of 25 m about the antenna, cut by the map.
    assert!((450..620).contains(&posts), "{posts}");
    assert_eq!(desk.run(&[&["check", "free.toml"][..], &set].concat()).status, 1);
}
