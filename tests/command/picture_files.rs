//! Every option that names a picture writes what the file's name says, and refuses a name that says neither SVG nor PNG.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::fs;

use crate::desk::{ACROSS, Desk, FOUR_LEGS};

/// Every option of every command that names a picture, with a command line that ends in it.
const PICTURES: [&[&str]; 17] = [
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
    &["sites", "ground.tif", "--every", "9", "--scenario", "map.toml", "--plot"],
    &["stance", "ground.tif", "--robot", "legs.toml", "--at", "9,9", "--scenario", "map.toml", "--plot"],
    &["arena", "arena.toml", "--quiet", "--plot"],
];

/// The files of these commands.
fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("arena.toml", ACROSS);
    // One hop of its legs apart, without the limit that takes most of the time.
    let light: Vec<&str> = FOUR_LEGS.lines().filter(|line| !line.starts_with("spin_max")).collect();
    desk.write_legs("legs.toml", &light.join("\n"));
    let near = desk.read("map.toml").replace("goal_m = [15, 12]", "goal_m = [4, 5]\nroute = \"free\"");
    let near = near.replace("node_spacing_max_m = 1.0", "contacts_max = 10");
    desk.write("legs_map.toml", format!("[robot]\nfile = \"legs.toml\"\n\n{near}"));
    desk
}

#[test]
fn a_picture_is_what_its_name_says() {
    let desk = desk();
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
    let commands = [
        "run", "slice", "fan", "map", "sites", "hop", "check", "plan", "simulate", "require", "trade", "compare", "stance", "arena",
    ];
    for command in commands.into_iter().chain(["batch", "report", "synth"]) {
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

/// `--width-mm` scales a picture of every command, and is refused where nothing is drawn.
#[test]
fn a_picture_has_the_width_asked_for() {
    let desk = desk();
    let size = |svg: &str| -> (f64, f64) {
        let of = |name: &str| svg.split(&format!(" {name}=\"")).nth(1).unwrap().split("mm").next().unwrap().parse().unwrap();
        (of("width"), of("height"))
    };
    for line in PICTURES {
        desk.run(&[line, &["plain.svg"]].concat());
        let ran = desk.run(&[line, &["half.svg", "--width-mm", "85"]].concat());
        assert!(ran.status < 2, "{line:?}: {}", ran.stderr);
        let [(_, plain), (width, half)] = ["plain.svg", "half.svg"].map(|name| size(&desk.read(name)));
        assert_eq!(width, 85.0, "{line:?}");
        assert!((half - 0.5 * plain).abs() <= 1.5, "{line:?}: {half} mm of {plain} mm");
    }
    desk.run(&["plan", "scenario.toml", "--width-mm", "85", "--plot", "half.png"]);
    let png = fs::read(desk.path().join("half.png")).unwrap();
    assert_eq!(u32::from_be_bytes(png[16..20].try_into().unwrap()), 1004, "300 dots an inch");
    desk.run(&["run", "scenario.toml", "-o", "out", "--width-mm", "85"]);
    assert!(size(&desk.read("out/path.svg")).0 == 85.0);
    desk.refused(&["plan", "scenario.toml", "--width-mm", "85"], &["--width-mm: found no picture", "give --plot FILE.svg"]);
    for width in ["0", "-5", "39", "1200", "wide", "NaN"] {
        let ran = desk.run(&["plan", "scenario.toml", "--plot", "a.svg", "--width-mm", width]);
        assert!(ran.status == 2 && ran.stderr.contains("expected a width from 40 to 1189 mm"), "{width}: {}", ran.stderr);
    }
    assert_eq!(desk.run(&["bodies", "--width-mm", "85"]).status, 2);
}

/// The pictures of a run are what they are asked to be; those of an earlier run in the other format do not stay.
#[test]
fn the_pictures_of_a_run_have_one_format() {
    let desk = desk();
    let errors = ["--set", "uncertainty.trials=20", "--set", "uncertainty.takeoff_speed_sigma_fraction=0.01"];
    let run = |format: &str| desk.run(&[&["run", "map.toml", "-o", "out", "--pictures", format][..], &errors].concat());
    let all = || -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(desk.path().join("out"))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .filter(|name| matches!(name.rsplit_once('.'), Some((_, "svg" | "png"))))
            .collect();
        names.sort();
        names
    };
    let stems = ["landings", "path", "trials-2", "trials-3", "trials"];
    for (format, beginning) in [("svg", &b"<svg"[..]), ("png", b"\x89PNG\r\n\x1a\n"), ("svg", b"<svg")] {
        let ran = run(format);
        assert!(ran.status < 2, "{}", ran.stderr);
        let names = stems.map(|stem| format!("{stem}.{format}"));
        assert_eq!(all(), names);
        for name in &names {
            assert!(ran.stdout.contains(name), "{name}: {}", ran.stdout);
            assert!(fs::read(desk.path().join("out").join(name)).unwrap().starts_with(beginning), "{name}");
        }
    }
    assert_eq!(desk.run(&["run", "map.toml", "-o", "out", "--pictures", "jpg"]).status, 2);
}

/// Eight hops of each path from a chosen one on, in place of all.
#[test]
fn profiles_begin_at_a_chosen_hop() {
    let desk = desk();
    let map = ["map", "ground.tif", "--start", "1,1", "--goal", "18,18", "--scenario", "map.toml", "--profiles", "p.svg"];
    desk.run(&map);
    let whole = desk.read("p.svg");
    let hops = whole.matches("goal 1, hop ").count();
    assert!(whole.contains("goal 1, hop 1 of") && hops >= 2, "{hops} hops");
    desk.run(&[&map[..], &["--profiles-from", "2"]].concat());
    let chosen = desk.read("p.svg");
    assert!(!chosen.contains("goal 1, hop 1 of") && chosen.contains(&format!("goal 1, hop 2 of {hops}")), "{chosen}");
    assert_eq!(chosen.matches("goal 1, hop ").count(), (hops - 1).min(8));
    let late = (hops + 1).to_string();
    let expected = format!("expected a hop of a path, 1 to {hops}");
    desk.refused(&[&map[..], &["--profiles-from", &late]].concat(), &["--profiles-from: found", &expected]);
    assert_eq!(desk.run(&[&map[..], &["--profiles-from", "0"]].concat()).status, 2);
}

/// A picture of several pages is a file for each page, and the answer names them.
#[test]
fn every_page_has_a_file_that_the_answer_names() {
    let desk = desk();
    let ran = desk.run(&["simulate", "map.toml", "--trials", "20", "--plot", "trials.svg"]);
    assert!(ran.stdout.ends_with("pages of the picture: trials.svg, trials-2.svg, trials-3.svg\n"), "{}", ran.stdout);
    let headings = ["Trajectories and landings", "Distance error, landing by landing", "How the trials ended"];
    for (file, heading) in ["trials.svg", "trials-2.svg", "trials-3.svg"].into_iter().zip(headings) {
        let svg = desk.read(file);
        assert!(svg.starts_with("<svg") && headings.iter().all(|one| svg.contains(one) == (*one == heading)), "{file}");
    }
    // A page is no answer of another option's file, nor of an input.
    desk.write("taken-2.svg", "mine");
    desk.refused(
        &["simulate", "map.toml", "--trials", "20", "--quiet", "--plot", "taken.svg", "--plot-map", "taken-2.svg"],
        &["taken-2.svg: two answers would be written to this file"],
    );
    assert_eq!(desk.read("taken-2.svg"), "mine");
    let ran = desk.run(&[
        "run",
        "map.toml",
        "-o",
        "out",
        "--set",
        "uncertainty.trials=20",
        "--set",
        "uncertainty.takeoff_speed_sigma_fraction=0.01",
    ]);
    assert!(ran.stdout.contains("trials.svg") && ran.stdout.contains("trials-3.svg"), "{}", ran.stdout);
    desk.run(&["run", "map.toml", "-o", "out"]);
    assert!(!desk.path().join("out/trials-2.svg").exists() && !desk.path().join("out/trials-3.svg").exists(), "of an earlier run");
}
