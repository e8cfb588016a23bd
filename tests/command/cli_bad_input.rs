//! Bad input at the command line: status 2, one sentence with the position, nothing on standard output, no file changed.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{
    fs::{self, File, OpenOptions},
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use crate::desk::{Desk, SCENARIO};

const EXPLICIT_HEADER: &str =
    "takeoff_min_deg,takeoff_max_deg,takeoff_speed_max_m_s,landing_min_deg,landing_max_deg,landing_speed_max_m_s";

/// A chain CSV, and words of its refusal.
fn bad_chains() -> Vec<(String, Vec<&'static str>)> {
    let surface = |rows: &str| format!("x_m,z_m,friction_coefficient\n{rows}");
    let explicit = |rows: &str| format!("x_m,z_m,{EXPLICIT_HEADER}\n{rows}");
    let plain = |rows: &str| format!("x_m,z_m\n{rows}");
    vec![
        (String::new(), vec!["line 1: found an empty file", "begin with the line x_m,z_m"]),
        (plain(""), vec!["line 1: found no row below the header, expected at least 2 vertices"]),
        (plain("0,0\n"), vec!["line 2: found 1 row below the header, expected at least 2 vertices"]),
        (
            plain("0,0\n5,1\n3,2\n"),
            vec!["line 4, column 1 (x_m): found `3`, expected more than 5, the x_m of line 3", "order of x"],
        ),
        (plain("0,0\n5,1\n5,2\n"), vec!["line 4, column 1 (x_m): found `5`, expected more than 5, the x_m of line 3"]),
        (plain("0,NaN\n5,1\n"), vec!["line 2, column 3 (z_m): found `NaN`, expected a finite number"]),
        (plain("0,0\ninf,1\n"), vec!["line 3, column 1 (x_m): found `inf`, expected a finite number"]),
        (plain("0,0,1\n2\n"), vec!["line 2, column 5: found 3 fields, expected 2", "line 3: found 1 field, expected 2"]),
        (plain("0,steep\n5,1\n"), vec!["line 2, column 3 (z_m): found `steep`, expected a finite number; write a plain number"]),
        (
            "x_m,z_m,takeoff_min_deg\n0,0,60\n5,1,\n".to_owned(),
            vec!["line 1, column 9", "takeoff_max_deg", "expected all six columns"],
        ),
        (
            format!("x_m,z_m,friction_coefficient,{EXPLICIT_HEADER}\n0,0,0.6,60,90,10,-90,-60,10\n10,0,,,,,,,\n"),
            vec!["line 2, column 9", "found both friction_coefficient and takeoff_min_deg in one row"],
        ),
        (explicit("0,0,90,60,10,-90,-60,10\n10,0,,,,,,\n"), vec!["line 2, column 5 (takeoff_min_deg): found `90`", "swap the two"]),
        (
            explicit("0,0,60,90,-1,-90,-60,10\n10,0,,,,,,\n"),
            vec!["column 11 (takeoff_speed_max_m_s): found `-1`", "at least 0 m/s"],
        ),
        (surface("0,0,-0.6\n10,0,\n"), vec!["line 2, column 5 (friction_coefficient): found `-0.6`", "at least 0"]),
        ("x_m,z_m,x_m\n0,0,0\n10,0,10\n".to_owned(), vec!["line 1, column 9 (x_m): found `x_m` twice", "remove one of the two"]),
    ]
}

#[test]
fn every_bad_chain_is_refused_with_its_place_and_no_file_is_touched() {
    let desk = Desk::new();
    for (chain, parts) in bad_chains() {
        desk.write("bad.csv", &chain);
        desk.write("path.csv", "an old path\n");
        let named: Vec<_> = parts.iter().copied().chain(["bad.csv: line "]).collect();
        let ends = ["--scenario", "scenario.toml", "--start", "0", "--goal", "10"];
        desk.refused(&[&["plan", "bad.csv", "-o", "path.csv", "--plot", "path.svg"], &ends[..]].concat(), &named);
        desk.refused(&[&["check", "bad.csv"], &ends[..]].concat(), &named);
        desk.refused(&["hop", "bad.csv", "--scenario", "scenario.toml", "--from", "0", "--to", "10"], &named);
        desk.write("over_it.toml", SCENARIO.replace("chain.csv", "bad.csv"));
        desk.refused(&["run", "over_it.toml", "-o", "out"], &named);
    }
}

#[test]
fn binary_junk_is_refused_wherever_a_file_is_read() {
    let desk = Desk::with_dem();
    let junk: Vec<u8> = (0..5000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13).to_le_bytes()[0] | 0x80).collect();
    for name in ["junk.csv", "junk.toml", "junk.json", "junk.tif"] {
        desk.write(name, &junk);
    }
    let ends = ["--body", "mars", "--start", "0", "--goal", "10"];
    desk.refused(&[&["plan", "junk.csv"], &ends[..]].concat(), &["junk.csv: line 1: found the byte 0x", "not UTF-8"]);
    desk.refused(&["run", "junk.toml", "-o", "out"], &["junk.toml: cannot be read", "write it as TOML in UTF-8"]);
    desk.refused(&["run", "junk.json", "-o", "out"], &["junk.json: cannot be read"]);
    desk.refused(&["slice", "junk.tif", "--from", "1,1", "--to", "5,5"], &["junk.tif", "GeoTIFF, ESRI ASCII grid"]);
    desk.refused(&["check", "scenario.toml", "--pairs", "junk.csv"], &["junk.csv: line 1"]);
}

#[test]
fn a_line_of_200_megabytes_is_refused_within_seconds() {
    let desk = Desk::new();
    for (name, beginning) in
        [("long.csv", "x_m,z_m\n0,0\n1"), ("long.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 ")]
    {
        desk.write(name, beginning);
        // A sparse file: the rest reads as zero bytes.
        OpenOptions::new().write(true).open(desk.path().join(name)).unwrap().set_len(200_000_000).unwrap();
    }
    let began = Instant::now();
    desk.refused(&["plan", "long.csv", "--body", "mars", "--start", "0", "--goal", "1"], &["long.csv: line 3"]);
    desk.refused(&["slice", "long.asc", "--from", "0,0", "--to", "1,1"], &["long.asc"]);
    fs::rename(desk.path().join("long.csv"), desk.path().join("long.toml")).unwrap();
    desk.refused(&["run", "long.toml", "-o", "out"], &["long.toml: cannot be read (200000000 bytes)", "some kilobytes"]);
    // A large margin for a busy machine: parsing it as numbers would take minutes.
    assert!(began.elapsed() < Duration::from_secs(20), "took {:?}", began.elapsed());
}

#[test]
fn a_truncated_tiff_is_refused_wherever_it_is_cut() {
    let desk = Desk::with_dem();
    let whole = fs::read(desk.path().join("ground.tif")).unwrap();
    for eighths in 0..8 {
        desk.write("cut.tif", &whole[..whole.len() * eighths / 8]);
        desk.refused(&["slice", "cut.tif", "--from", "1,1", "--to", "5,5", "-o", "slice.csv"], &["cut.tif"]);
    }
}

#[test]
fn positions_off_the_chain_and_the_map_are_refused_with_the_valid_range() {
    let desk = Desk::with_dem();
    let reach = "which reaches from 0 to 40 m: choose a point between";
    desk.refused(&["plan", "scenario.toml", "--start", "-5"], &["--start: x = -5 m is off the chain", reach]);
    desk.refused(&["check", "scenario.toml", "--goal", "41"], &["--goal: x = 41 m is off the chain", reach]);
    desk.refused(&["hop", "scenario.toml", "--from", "-5"], &["--from: x = -5 m is off the chain", reach]);
    desk.refused(&["hop", "scenario.toml", "--from=-5"], &["--from: x = -5 m is off the chain", reach]);
    desk.refused(&["hop", "scenario.toml", "--from", "nan"], &["--from: terrain.start_x_m is nan", "a number from -1e12 to 1e12"]);
    let set = ["run", "scenario.toml", "-o", "out", "--set", "terrain.goal_x_m=99"];
    desk.refused(&set, &["terrain.goal_x_m: x = 99 m is off the chain", reach]);
    desk.write("pairs.csv", "start_x_m,goal_x_m\n0,40\n0,400\n");
    let off_pair = "pairs.csv: pair 2 (goal_x_m): x = 400 m is off the chain";
    desk.refused(&["check", "scenario.toml", "--pairs", "pairs.csv"], &[off_pair, reach]);
    desk.refused(
        &["slice", "ground.tif", "--from", "-1,-1", "--to", "5,5"],
        &["ground.tif", "(-1 m, -1 m) is off the map", "0 to 19 m"],
    );
    desk.refused(&["slice", "ground.tif", "--from=-1,-1", "--to=5,5"], &["(-1 m, -1 m) is off the map"]);
    desk.refused(&["slice", "ground.tif", "--from", "1,1", "--to", "-5,5"], &["(-5 m, 5 m) is off the map"]);
    desk.refused(&["slice", "ground.tif", "--from", "1,1", "--to", "1,1"], &["starts and ends at the same point (1 m, 1 m)"]);
    desk.refused(
        &["hop", "scenario.toml", "--from", "5", "--to", "5"],
        &["--from and --to are both x = 5 m", "two different points"],
    );
}

#[test]
fn missing_start_and_goal_are_refused_by_every_command() {
    let desk = Desk::new();
    let common = ["chain.csv", "--body", "mars", "--set", "surface.friction_coefficient=0.6"];
    let speeds = ["--set", "hopper.takeoff_speed_max_m_s=9", "--set", "hopper.landing_speed_max_m_s=9"];
    let all = [&common[..], &speeds[..]].concat();
    desk.refused(&[&["plan"], &all[..], &["--goal", "5"]].concat(), &["found no start: give --start X along the chain"]);
    desk.refused(&[&["check"], &all[..], &["--start", "5"]].concat(), &["found no goal: give --goal X along the chain"]);
    desk.refused(&[&["hop"], &all[..], &["--from", "5"]].concat(), &["found no goal: give --to X along the chain"]);
    desk.write("no_goal.toml", SCENARIO.replace("goal_x_m = 40\n", ""));
    desk.refused(&["run", "no_goal.toml", "-o", "out"], &["found no goal: add goal_x_m = X", "[terrain]"]);
    desk.write("no_terrain.toml", SCENARIO.split("[terrain]").next().unwrap());
    desk.refused(
        &["run", "no_terrain.toml", "-o", "out"],
        &["no_terrain.toml: found no terrain; add [terrain] with dem, mesh or chain"],
    );
}

#[test]
fn invalid_values_of_options_are_refused_by_name() {
    let desk = Desk::new();
    let cases: [(&[&str], &[&str]); 17] = [
        (&["--gravity-m-s2", "0"], &["--gravity-m-s2: body.gravity_m_s2 is 0.0, expected a number from 1e-9 to 1000"]),
        (&["--gravity-m-s2", "-3.7"], &["--gravity-m-s2: body.gravity_m_s2 is -3.7"]),
        (&["--gravity-m-s2", "inf"], &["--gravity-m-s2: body.gravity_m_s2 is inf"]),
        (&["--clearance-m", "-1"], &["--clearance-m: hopper.clearance_m is -1.0, expected a number from 0 to 1e9"]),
        (&["--body", "marz"], &["--body: body.name is \"marz\", expected one of moon, mars,", "the nearest known name is mars"]),
        (&["--set", "foo"], &["--set foo: found no table.key=value; write it as hopper.takeoff_speed_max_m_s=8"]),
        (&["--set", "="], &["--set =: found no table.key=value"]),
        (
            &["--set", "hopper.takeof_speed_max_m_s=3"],
            &["unknown key hopper.takeof_speed_max_m_s", "is hopper.takeoff_speed_max_m_s"],
        ),
        (&["--set", "hoper.mass_kg=3"], &["unknown key hoper.mass_kg; the nearest known key is hopper.mass_kg"]),
        (&["--set", "hopper.mass_kg="], &["hopper.mass_kg is \"\", expected a number"]),
        (&["--set", "hopper.mass_kg=3\nrest_time_s=4"], &["hopper.mass_kg is \"\"\"", "expected a number"]),
        (&["--set", "search.effort=fun"], &["search.effort is \"fun\", expected one of takeoff-speed, energy, time, peak-speed"]),
        (&["--effort", "fun"], &["--effort: search.effort is \"fun\""]),
        (&["--points-per-segment", "-1"], &["--points-per-segment: search.points_per_segment is -1", "or \"auto\""]),
        (&["--points-per-segment", "many"], &["search.points_per_segment is \"many\""]),
        (&["--node-spacing-max-m", "0"], &["--node-spacing-max-m: search.node_spacing_max_m is 0.0"]),
        (
            &["--scenario", "scenario.toml"],
            &["found two scenarios, scenario.toml and --scenario scenario.toml", "chain CSV as CHAIN"],
        ),
    ];
    for (options, parts) in cases {
        desk.refused(&[&["plan", "scenario.toml", "-o", "path.csv"], options].concat(), parts);
        desk.refused(&[&["check", "scenario.toml"], options].concat(), parts);
    }
    desk.refused(&["check", "scenario.toml", "--points-per-segment", "2", "--node-spacing-max-m", "3"], &["cannot be used with"]);
    desk.refused(&["check", "scenario.toml", "--pairs", "p.csv", "--start", "3"], &["cannot be used with"]);
    let no_dem = ["check", "chain.csv", "--scenario", "scenario.toml", "--set", "terrain.dem=x.tif"];
    desk.refused(&no_dem, &["terrain has both dem and chain"]);
    let no_map = ["check", "chain.csv", "--scenario", "scenario.toml", "--set", "terrain.start_m=[1,2]"];
    desk.refused(
        &no_map,
        &["terrain.start_m is a map position, but terrain is a chain, whose positions are distances along it", "start_x_m"],
    );
    desk.refused(&["plan", "scenario.toml", "--geojson", "path.geojson"], &["--geojson: the chain lies on no map", "map_x_m"]);
}

#[test]
fn synth_and_slice_refuse_invalid_terrain() {
    let desk = Desk::with_dem();
    desk.refused(&["synth", "-o", "ground.png"], &["-o ground.png: found no known extension, expected .tif (GeoTIFF) or .asc"]);
    for (option, value, part) in [
        ("--rows", "0", "rows is 0, expected 2 to"),
        ("--rows", "100000000", "rows is 100000000, expected 2 to"),
        ("--spacing-m", "-1", "spacing"),
        ("--spacing-m", "nan", "spacing"),
        ("--tilt-deg", "95", "tilt is 95, expected 0 to 80 degrees"),
        ("--ground-hurst", "-1", "hurst"),
        ("--mean-elevation-m", "inf", "mean"),
    ] {
        desk.refused(&["synth", "-o", "new.tif", option, value], &[part]);
    }
    let craters = ["synth", "-o", "new.tif", "--craters", "--crater-diameter-min-m", "50", "--crater-diameter-max-m", "5"];
    desk.refused(&craters, &["diameter_max_m is 5"]);
    desk.refused(&["synth", "-o", "new.tif", "--crater-diameter-min-m", "5"], &["--craters"]);
    desk.refused(&["synth", "-o", "new.tif", "--south-west-m", "1;2"], &["found `1;2`, expected two finite numbers in metres"]);
    desk.refused(
        &["slice", "ground.tif", "--from", "1", "--to", "2,2"],
        &["--from", "found `1` (1 number), expected two finite numbers in metres, X,Y"],
    );
    desk.refused(&["slice", "ground.tif", "--from", "1,nan", "--to", "2,2"], &["found `1,nan`"]);
    desk.refused(
        &["slice", "chain.csv", "--from", "1,1", "--to", "2,2"],
        &["chain.csv: this is a chain CSV; expected an elevation raster", "give it to `chta plan chain.csv"],
    );
}

#[test]
fn missing_files_and_folders_in_their_place_are_refused() {
    let desk = Desk::with_dem();
    fs::create_dir(desk.path().join("folder.csv")).unwrap();
    fs::create_dir(desk.path().join("folder.toml")).unwrap();
    let ends = ["--body", "mars", "--start", "0", "--goal", "1"];
    desk.refused(&[&["plan", "none.csv"], &ends[..]].concat(), &["none.csv: cannot be read (No such file", "check the path"]);
    desk.refused(&[&["plan", "folder.csv"], &ends[..]].concat(), &["folder.csv: cannot be read (Is a directory", "check the path"]);
    desk.refused(&["run", "none.toml", "-o", "out"], &["none.toml: cannot be read (No such file", "expected a scenario"]);
    desk.refused(&["run", "folder.toml", "-o", "out"], &["folder.toml: cannot be read (Is a directory"]);
    desk.refused(&["check", "scenario.toml", "--pairs", "none.csv"], &["none.csv: cannot be read"]);
    desk.refused(&["slice", "none.tif", "--from", "1,1", "--to", "2,2"], &["none.tif", "No such file"]);
    desk.refused(&["slice", ".", "--from", "1,1", "--to", "2,2"], &["directory"]);
    desk.refused(
        &["slice", "ground.tif", "--from", "1,1", "--to", "2,2", "--scenario", "none.toml"],
        &["none.toml: cannot be read"],
    );
}

#[test]
fn outputs_that_cannot_be_written_are_refused_and_leave_nothing() {
    let desk = Desk::with_dem();
    fs::create_dir(desk.path().join("folder")).unwrap();
    desk.write("file", "old");
    let slice = ["slice", "ground.tif", "--from", "1,1", "--to", "9,9", "-o"];
    for output in ["none/such.csv", "folder", "file/below.csv"] {
        let said = format!("{output}: cannot be written");
        desk.refused(
            &[&slice[..], &[output]].concat(),
            &[&said, "choose a folder that exists, may be written to and has space left"],
        );
        desk.refused(&["plan", "scenario.toml", "-o", output], &[&said]);
        let picture = format!("{}.svg", output.trim_end_matches(".csv"));
        // A folder is no picture whatever its name.
        if output != "folder" {
            desk.refused(&["plan", "scenario.toml", "--plot", &picture], &[&format!("{picture}: cannot be written")]);
        }
        desk.refused(&["plan", "map.toml", "--geojson", output], &[&said]);
    }
    desk.refused(&["synth", "-o", "none/such.tif"], &["none/such.tif: cannot be written (No such file or directory (os error 2))"]);
    desk.refused(&["run", "scenario.toml", "-o", "file"], &["file: cannot be made", "choose a folder"]);
    desk.refused(&["run", "scenario.toml", "-o", "file/below"], &["file/below: cannot be made"]);
}

/// Every command that writes to standard output.
const WRITING: [&[&str]; 8] = [
    &["bodies"],
    &["schema", "plan"],
    &["hop", "scenario.toml", "--to", "10"],
    &["check", "scenario.toml"],
    &["plan", "scenario.toml"],
    &["plan", "scenario.toml", "-o", "-"],
    &["run", "scenario.toml", "-o", "out"],
    &["slice", "ground.tif", "--from", "1,1", "--to", "9,9"],
];

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported_for_standard_output_and_for_files() {
    let desk = Desk::with_dem();
    for args in WRITING {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_chta"));
        let output = command.current_dir(desk.path()).args(args).stdout(full).stderr(Stdio::piped()).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}: {message}");
        assert!(message.starts_with("error: standard output: cannot be written (No space left on device"), "{args:?}: {message}");
    }
    let message = "/dev/full: cannot be written (No space left on device";
    desk.refused(&["plan", "scenario.toml", "-o", "/dev/full"], &[message]);
    desk.refused(&["slice", "ground.tif", "--from", "1,1", "--to", "9,9", "-o", "/dev/full"], &[message]);
}

#[test]
fn a_closed_pipe_is_no_error_and_keeps_the_answer() {
    let desk = Desk::with_dem();
    let no: &[&str] = &["hop", "scenario.toml", "--to", "10", "--set", "hopper.takeoff_speed_max_m_s=1"];
    // More than fits into one buffer, so that the pipe is found closed while trials are flown.
    let many: &[&str] = &["simulate", "scenario.toml", "--trials", "3000", "-o", "-", "--quiet"];
    for (args, status) in WRITING.into_iter().map(|args| (args, 0)).chain([(no, 1), (many, 0)]) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_chta"));
        command.current_dir(desk.path()).args(args).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(status), "{args:?}");
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "", "{args:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_pipe_can_be_read_where_a_file_is_expected() {
    let desk = Desk::new();
    let mut command = Command::new(env!("CARGO_BIN_EXE_chta"));
    command.current_dir(desk.path()).args(["check", "/dev/stdin", "--scenario", "scenario.toml"]);
    let chain = File::open(desk.path().join("chain.csv")).unwrap();
    assert_eq!(command.stdin(chain).stdout(Stdio::null()).status().unwrap().code(), Some(0));
}

#[test]
fn all_problems_of_a_scenario_are_reported_at_once_with_line_and_column() {
    let desk = Desk::new();
    let bad = "body = 3\n[hoper]\nmass_kg = 1\n[surface]\nfriction_coefficient = -1\ntakeoff_from_slope_deg = [3]\n\
               [terrain]\ndem = \"a.tif\"\nchain = \"b.csv\"\n[nothing]\n[search]\neffort = \"fun\"\npoints_per_segment = 1.5\n\
               [hopper]\ntakeoff_speed_max_m_s = \"fast\"\nclearance_m = true\nmass_kg = 1979-05-27\n";
    desk.write("bad.toml", bad);
    let parts = [
        "bad.toml:1:1: body is a value, expected a table; write [body] on a line of its own",
        "bad.toml:3:1: unknown key hoper.mass_kg; the nearest known key is hopper.mass_kg",
        "bad.toml:5:24: surface.friction_coefficient is -1, expected a number from 0 to 1e6",
        "bad.toml:6:26: surface.takeoff_from_slope_deg is [3], expected two angles in degrees",
        "bad.toml:9:9: terrain has both dem and chain, expected one of the two; remove one of them",
        "bad.toml:10:2: unknown table [nothing]; the tables are body, hopper, robot, surface, layer, contact, terrain, search, drive, budget, derating, uncertainty, mission, report",
        "bad.toml:12:10: search.effort is \"fun\", expected one of takeoff-speed, energy, time, peak-speed",
        "bad.toml:13:22: search.points_per_segment is 1.5, expected a whole number from 0 to 100000, or \"auto\"",
        "bad.toml:15:25: hopper.takeoff_speed_max_m_s is \"fast\", expected a number from 1e-9 to 1e5",
        "bad.toml:16:15: hopper.clearance_m is true, expected a number from 0 to 1e9",
        "bad.toml:17:1: ",
        "bad.toml: found no gravity; add [body] with name = \"mars\" or gravity_m_s2 = 3.711",
    ];
    for command in [&["run", "bad.toml", "-o", "out"][..], &["plan", "bad.toml"], &["hop", "bad.toml"], &["check", "bad.toml"]] {
        desk.refused(command, &parts);
        let message = desk.run(command).stderr;
        assert_eq!(message.matches("error: ").count(), parts.len(), "another number of problems:\n{message}");
        let places: Vec<_> = parts.iter().map(|part| message.find(part).unwrap()).collect();
        assert!(places.is_sorted(), "not in the order of the file:\n{message}");
    }
}

#[test]
fn one_fault_of_a_scenario_gives_one_problem() {
    let desk = Desk::with_dem();
    let cases = [
        ("name = \"mars\"", "name = \"marz\"", "bad.toml:2:8: body.name is \"marz\"", "the nearest known name is mars"),
        ("name = \"mars\"", "name = mars", "bad.toml:2:8: this is not TOML", "texts stand in quotes"),
        ("name = \"mars\"", "gravity_m_s2 = 0", "bad.toml:2:16: body.gravity_m_s2 is 0", "expected a number from 1e-9 to 1000"),
        ("name = \"mars\"", "nam = \"mars\"", "bad.toml:2:1: unknown key body.nam", "the nearest known key is body.name"),
        ("chain = ", "chian = ", "bad.toml:12:1: unknown key terrain.chian", "the nearest known key is terrain.chain"),
        (
            "chain = \"chain.csv\"",
            "dem = \"ground.tif\"",
            "bad.toml:12:7: terrain has a dem but no start_m",
            "add start_m = [x, y], in map metres",
        ),
        (
            "chain = ",
            "dem = ",
            "bad.toml:12:7: chain.csv: this is a chain CSV; expected an elevation raster",
            "write chain = \"chain.csv\" in place of dem",
        ),
        ("chain.csv", "none.csv", "bad.toml:12:9: terrain.chain is none.csv, which cannot be read (No such file", "check the path"),
        ("chain = \"chain.csv\"\n", "", "bad.toml:12:13: terrain.start_x_m without a chain", "add chain = \"file.csv\""),
        ("start_x_m = 0", "start_m = [0, 1]", "bad.toml:13:11: terrain.start_m is a map position", "give start_x_m instead"),
        ("start_x_m = 0", "start_x_m = nan", "bad.toml:13:13: terrain.start_x_m is nan", "expected a number"),
        ("friction_coefficient = 0.6", "takeoff_from_slope_deg = [60, 90]", "bad.toml:9:26:", "add landing_from_slope_deg"),
        ("friction_coefficient = 0.6", "rest_slope_max_deg = 91", "bad.toml:9:22:", "from 0 to 90 degrees, or inf"),
        ("[hopper]\n", "[hopper]\nmass_kg = 1\nmass_kg = 2\n", "bad.toml:6:1: this is not TOML", "duplicate key"),
    ];
    for (right, wrong, place, part) in cases {
        assert!(SCENARIO.contains(right), "{right}");
        desk.write("bad.toml", SCENARIO.replacen(right, wrong, 1));
        desk.refused(&["run", "bad.toml", "-o", "out"], &[place, part]);
        let message = desk.run(&["run", "bad.toml", "-o", "out"]).stderr;
        assert_eq!(message.matches("error: ").count(), 1, "{wrong}:\n{message}");
    }
}

#[test]
fn a_misspelt_key_gives_the_nearest_key_or_those_of_its_table() {
    let desk = Desk::new();
    let nearest = [
        ("surface.friktion", "surface.friction_coefficient"),
        ("surface.friction", "surface.friction_coefficient"),
        ("frogs.friction", "derating.friction"),
        ("surface.friction_rastr", "surface.friction_raster"),
        ("hopper.friction_coefficient", "surface.friction_coefficient"),
        ("hopper.takeof_speed", "hopper.takeoff_speed_max_m_s"),
        ("search.points", "search.points_per_segment"),
    ];
    for (key, near) in nearest {
        let said = format!("unknown key {key}; the nearest known key is {near}\n");
        desk.refused(&["check", "scenario.toml", "--set", &format!("{key}=1")], &[&said]);
    }
    for (key, said) in [
        ("hopper.speed", "the keys of [hopper] are takeoff_speed_max_m_s, landing_speed_max_m_s, clearance_m,"),
        ("terrain.x", "the keys of [terrain] are dem, mesh,"),
        ("frogs.legs", "the tables are body, hopper, robot, surface, layer,"),
    ] {
        desk.refused(&["check", "scenario.toml", "--set", &format!("{key}=1")], &["unknown key", said]);
        assert!(!desk.run(&["check", "scenario.toml", "--set", &format!("{key}=1")]).stderr.contains("nearest"), "{key}");
    }
    desk.refused(
        &["trade", "scenario.toml", "--vary", "surface.friktion=0.1:1:3"],
        &["the nearest known key is surface.friction_coefficient"],
    );
}

/// Numbers in sentences have no rows of zeros and no rounding residue; documents keep all digits.
#[test]
fn numbers_in_sentences_are_short() {
    let desk = Desk::with_dem();
    desk.refused(&["check", "scenario.toml", "--set", "hopper.clearance_m=1e300"], &["hopper.clearance_m is 1e300, expected"]);
    desk.refused(&["check", "scenario.toml", "--set", "hopper.mass_kg=1e-300"], &["hopper.mass_kg is 1e-300, expected"]);
    let made =
        desk.run(&["synth", "--rows", "9", "--cols", "9", "--spacing-m", "1.1", "--south-west-m", "0.1,0.2", "-o", "uneven.asc"]);
    assert_eq!(made.status, 0, "{}", made.stderr);
    let off = ["slice", "uneven.asc", "--from", "50.30000000000001,1", "--to", "2,2"];
    desk.refused(&off, &["(50.3 m, 1 m)", "x from 0.1 to 8.9 m and y from 0.2 to 9 m"]);
    let words = ["require", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--from", "1", "--to", "12"];
    let text = desk.run(&words).stdout;
    let line = text.lines().find(|line| line.starts_with("reachable at ")).unwrap();
    let value = line.split_whitespace().nth(2).unwrap();
    assert!(line.contains(&format!("{value} m/s, in ")) && value.len() <= 12, "{line}");
    let exact = desk.json(&words)["reachable_at"].as_f64().unwrap();
    assert!((exact - value.parse::<f64>().unwrap()).abs() <= 1e-9 * exact, "{exact} {line}");
    assert!(text.contains("values tried, from 1 to 12 m/s"), "{text}");
    let bodies = desk.run(&["bodies"]).stdout;
    assert!(bodies.contains(" 1.624 ") && bodies.contains(" 3.711 ") && !bodies.contains("e0"), "{bodies}");
}

/// The ends of a journey off the map have the names of their keys; those of a slice the names of its options.
#[test]
fn an_end_off_the_map_has_its_own_name() {
    let desk = Desk::with_dem();
    #[rustfmt::skip]
    let cases: [(&[&str], &str); 5] = [
        (&["plan", "map.toml", "--set", "terrain.start_m=[-3, 2]"], "the start point (-3 m, 2 m) is off the map"),
        (&["plan", "map.toml", "--set", "terrain.goal_m=[15, 99]"], "the goal point (15 m, 99 m) is off the map"),
        (&["plan", "map.toml", "--set", "terrain.via_m=[[5, 50]]"], "the via point (5 m, 50 m) is off the map"),
        (&["slice", "ground.tif", "--from", "1,1", "--to", "-5,5"], "the to point (-5 m, 5 m) is off the map"),
        (&["slice", "ground.tif", "--from=-5,1", "--to", "5,5"], "the from point (-5 m, 1 m) is off the map"),
    ];
    for (args, sentence) in cases {
        desk.refused(args, &[sentence]);
    }
}
