//! `--verbose` says what is done on standard error and changes nothing else; `CHTA_THREADS` is the default of `--threads`.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use crate::desk::{Desk, Ran};

fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("trials.toml", desk.read("scenario.toml") + "\n[uncertainty]\ntakeoff_angle_sigma_deg = 0.5\ntrials = 20\n");
    desk.write("pairs.csv", "start_x_m,goal_x_m\n10,40\n40,0\n");
    desk
}

/// The commands, each with what its lines have to say.
const CASES: [(&[&str], &[&str]); 13] = [
    (
        &["run", "scenario.toml", "-o", "out"],
        &[
            "read scenario.toml, sha256 ",
            "read chain.csv, sha256 ",
            "nodes: the first of [0, 1, 2",
            "wrote out/path.csv",
            "search took ",
        ],
    ),
    (&["slice", "ground.tif", "--from", "1,1", "--to", "9,9"], &["read ground.tif, sha256 "]),
    (
        &["fan", "ground.tif", "--from", "9,9", "--headings", "4", "--length", "5", "--scenario", "map.toml"],
        &["read map.toml, sha256 ", "nodes: at most 1 m apart", "fan took "],
    ),
    (
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "-o", "hops.tif"],
        &["threads: ", "\"takeoff_speed_max_m_s\":6.0", "hop map took ", "wrote hops.tif"],
    ),
    (&["hop", "scenario.toml", "--to", "10"], &["the chain has 4 segments, x from 0 to 40 m"]),
    (
        &["check", "scenario.toml", "--points-per-segment", "3", "--threads", "2"],
        &["threads: 2, of --threads", "nodes: 3 points inside each segment", "searching with 3 points inside each segment"],
    ),
    (&["check", "scenario.toml", "--pairs", "pairs.csv"], &["read pairs.csv, sha256 "]),
    (&["plan", "scenario.toml", "--prove"], &["proving with ", "proof took "]),
    (&["simulate", "trials.toml"], &["simulation took "]),
    (&["require", "scenario.toml", "--vary", "surface.friction_coefficient"], &["read chain.csv, sha256 "]),
    (&["trade", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s=6:9:2"], &["read chain.csv, sha256 "]),
    (&["compare", "scenario.toml", "trials.toml"], &["read trials.toml, sha256 "]),
    (&["synth", "--rows", "9", "--cols", "9", "-o", "new.tif"], &["wrote new.tif"]),
];

#[test]
fn verbose_lines_are_on_standard_error_alone_and_say_what_is_done() {
    for (words, said) in CASES {
        let (plain_desk, desk) = (desk(), desk());
        let plain = plain_desk.run(words);
        assert!(plain.status < 2, "{words:?}: {plain:?}");
        assert!(!plain.stderr.contains("info: "), "{words:?}: {plain:?}");
        let told = desk.run(&[words, &["--verbose"]].concat());
        assert_eq!((told.status, &told.stdout), (plain.status, &plain.stdout), "{words:?}");
        assert!(desk.files() == plain_desk.files(), "{words:?}: other files");
        let (info, rest): (Vec<&str>, Vec<&str>) = told.stderr.lines().partition(|line| line.starts_with("info: "));
        assert_eq!(rest, plain.stderr.lines().collect::<Vec<_>>(), "{words:?}");
        for expected in said.iter().chain(&["all done"]) {
            assert!(info.iter().any(|line| line.contains(expected)), "{words:?} does not say `{expected}`: {info:#?}");
        }
    }
}

#[test]
fn verbose_stands_before_or_after_the_command_and_not_with_quiet() {
    let desk = desk();
    for words in
        [&["-v", "check", "scenario.toml"][..], &["check", "-v", "scenario.toml"], &["check", "scenario.toml", "--verbose"]]
    {
        let ran = desk.run(words);
        assert!(ran.status == 0 && ran.stderr.contains("info: "), "{words:?}: {ran:?}");
        let ran = desk.run(&[words, &["--quiet"]].concat());
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{words:?} --quiet");
        assert!(ran.stderr.contains("found both --verbose and --quiet"), "{words:?} --quiet: {ran:?}");
    }
}

/// A run with a value of the variable.
fn with_threads(desk: &Desk, value: &str, args: &[&str]) -> Ran {
    let output = assert_cmd::Command::new(env!("CARGO_BIN_EXE_chta"))
        .current_dir(desk.path())
        .env("CHTA_THREADS", value)
        .args(args)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ran { status: output.status.code().unwrap_or(-1), stdout: text(output.stdout), stderr: text(output.stderr) }
}

#[test]
fn the_environment_gives_the_default_number_of_threads() {
    let desk = desk();
    let plain = desk.run(&["check", "scenario.toml"]);
    for (value, options, said) in [
        ("3", &[][..], Ok("threads: 3, of CHTA_THREADS")),
        ("3", &["--threads", "2"], Ok("threads: 2, of --threads")),
        ("3", &["--threads", "0"], Ok(", one for each core")),
        ("0", &[], Ok(", one for each core")),
        ("", &[], Ok(", one for each core")),
        ("many", &["--threads", "1"], Ok("threads: 1, of --threads")),
        ("many", &[], Err("CHTA_THREADS: found `many`, expected a whole number from 0")),
        ("-1", &[], Err("CHTA_THREADS: found `-1`")),
        ("1.5", &[], Err("CHTA_THREADS: found `1.5`")),
        ("513", &[], Err("CHTA_THREADS: found `513`")),
    ] {
        let ran = with_threads(&desk, value, &[&["check", "scenario.toml", "-v"], options].concat());
        let (status, stdout, expected) = match said {
            Ok(said) => (plain.status, plain.stdout.as_str(), said),
            Err(said) => (2, "", said),
        };
        assert_eq!((ran.status, ran.stdout.as_str()), (status, stdout), "CHTA_THREADS={value} {options:?}");
        assert!(ran.stderr.contains(expected), "CHTA_THREADS={value} {options:?}: {ran:?}");
    }
    // Commands without the option do not read it; one that refuses the option takes the variable.
    assert_eq!(with_threads(&desk, "many", &["bodies"]).status, 0);
    assert_eq!(with_threads(&desk, "many", &["hop", "scenario.toml"]), desk.run(&["hop", "scenario.toml"]));
}
