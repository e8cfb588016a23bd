//! Every option that names a picture writes what the file's name says, and refuses a name that says neither SVG nor PNG.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::fs;

use crate::desk::{Desk, FOUR_LEGS};

/// Every option of every command that names a picture, with a command line that ends in it.
const PICTURES: [&[&str]; 14] = [
    &["hop", "plate.obj", "--from", "1,1,0", "--to", "3,3,0", "--scenario", "map.toml", "--plot"],
    &["plan", "scenario.toml", "--plot"],
    &["plan", "scenario.toml", "--set", "hopper.takeoff_speed_max_m_s=1", "--plot"],
    &["check", "scenario.toml", "--prove", "--plot"],
    &["fan", "ground.tif", "--from", "5,5", "--length", "4", "--headings", "4", "--scenario", "map.toml", "--plot"],
    &["map", "ground.tif", "--start", "5,5", "--goal", "12,12", "--scenario", "map.toml", "--plot"],
    &["map", "ground.tif", "--start", "5,5", "--goal", "12,12", "--scenario", "map.toml", "--profiles"],
    &["plan", "scenario.toml", "--set", "uncertainty.takeoff_speed_sigma_fraction=0.01", "--front", "hops,risk", "--plot-front"],
    &["plan", "legs_map.toml", "--plot-postures"],
    &["simulate", "map.toml", "--trials", "20", "--plot"],
    &["simulate", "map.toml", "--trials", "20", "--plot-map"],
    &["simulate", "map.toml", "--trials", "20", "--plot-density"],
    &["trade", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s=4:10:3", "--plot"],
    &["compare", "scenario.toml", "map.toml", "--plot"],
];

#[test]
fn a_picture_is_what_its_name_says() {
    let desk = Desk::with_dem();
    // One hop of its legs apart, without the limit that takes most of the time.
    let light: Vec<&str> = FOUR_LEGS.lines().filter(|line| !line.starts_with("spin_max")).collect();
    desk.write_legs("legs.toml", &light.join("\n"));
    let near = desk.read("map.toml").replace("goal_m = [15, 12]", "goal_m = [4, 5]\nroute = \"free\"");
    let near = near.replace("node_spacing_max_m = 1.0", "contacts_max = 10");
    desk.write("legs_map.toml", format!("[robot]\nfile = \"legs.toml\"\n\n{near}"));
    for line in PICTURES {
        for (name, beginning) in
            [("a.svg", &b"<svg"[..]), ("a.SVG", b"<svg"), ("a.png", b"\x89PNG\r\n\x1a\n"), ("b.Png", b"\x89PNG\r\n\x1a\n")]
        {
            let ran = desk.run(&[line, &[name]].concat());
            assert!(ran.status < 2, "{line:?} {name}: {}", ran.stderr);
            let bytes = fs::read(desk.path().join(name)).unwrap();
            assert!(bytes.starts_with(beginning), "{line:?} {name} begins with {:?}", &bytes[..8]);
            fs::remove_file(desk.path().join(name)).unwrap();
        }
        for name in ["a.jpg", "a.pdf", "a", "a.svgz", ".png", "a.png.tmp"] {
            let refused = format!("{}: '{name}' does not end in .svg or .png", line.last().unwrap());
            desk.refused(&[line, &[name]].concat(), &[&refused, "give it one of these endings"]);
        }
    }
}

/// The options that the help calls a picture are those of the table.
#[test]
fn no_option_for_a_picture_is_forgotten() {
    let desk = Desk::new();
    for command in ["run", "slice", "fan", "map", "hop", "check", "plan", "simulate", "require", "trade", "compare", "synth"] {
        let help = desk.run(&[command, "--help"]).stdout;
        for (at, _) in help.match_indices("SVG or PNG") {
            let before = &help[..at];
            let option = before.rsplit("--").next().unwrap().split([' ', '\n']).next().unwrap();
            let known = PICTURES.iter().any(|line| line[0] == command && line.last().unwrap().trim_start_matches("--") == option);
            assert!(known, "{command} --{option}");
        }
        assert!(!help.contains("(SVG)") && !help.contains(".svg or .png"), "{command}");
    }
}
