//! The take-off speeds that a machine can be commanded, as a user meets them: windows of a hop, refusals, bad input.
#![allow(clippy::unwrap_used, reason = "a command that writes no JSON should stop its test")]

use serde_json::Value;

use crate::desk::Desk;

/// Flat ground and a wall, at 10 m/s^2: 8 m need 8.94 m/s, and 10 m/s carry them at the slopes 0.5 and 2.
const FLAT: &str = "[body]\ngravity_m_s2 = 10\n[hopper]\ntakeoff_speed_max_m_s = 12\nlanding_speed_max_m_s = 12\n[surface]\n\
    takeoff_from_slope_deg = [0, 90]\nlanding_from_slope_deg = [-90, 0]\n[terrain]\nchain = \"flat.csv\"\nstart_x_m = 0\ngoal_x_m = 8\n";

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write("flat.csv", "x_m,z_m\n0,0\n4,0\n8,0\n100,0\n");
    desk.write("flat.toml", FLAT);
    desk
}

fn hop(desk: &Desk, keys: &[&str]) -> Value {
    let set: Vec<&str> = keys.iter().flat_map(|key| ["--set", key]).collect();
    let ran = desk.run(&[&["hop", "flat.toml", "--format", "json"], &set[..]].concat());
    serde_json::from_str(&ran.stdout).unwrap_or_else(|_| panic!("{keys:?}: {ran:?}"))
}

/// Windows: from, to, and the limits at the lower and the upper end.
type Windows<'a> = Vec<(f64, f64, &'a str, &'a str)>;

/// Degrees of a slope.
fn deg(slope: f64) -> f64 {
    slope.atan().to_degrees()
}

#[test]
fn the_windows_of_a_hop_are_listed_with_the_limits_of_their_ends() {
    let desk = desk();
    let (q, level) = (1.8, 121.0 / 80.0f64);
    // The flattest and the steepest arc of 12 m/s, and those of 11 m/s.
    let [fast, of_11] = [q, level].map(|q: f64| [q - (q * q - 1.0).sqrt(), q + (q * q - 1.0).sqrt()].map(deg));
    let (max, min, levels) = ("takeoff-speed", "takeoff-speed-min", "takeoff-speed-levels");
    // Keys, windows (from, to, limit at the lower end, at the upper end), and the index of the one that is flown.
    let table: Vec<(Vec<&str>, Windows<'_>, usize)> = vec![
        (vec![], vec![(fast[0], fast[1], max, max)], 0),
        (vec!["hopper.takeoff_speed_min_m_s=10"], vec![(fast[0], deg(0.5), max, min), (deg(2.0), fast[1], min, max)], 0),
        // Every arc is fast enough.
        (vec!["hopper.takeoff_speed_min_m_s=8"], vec![(fast[0], fast[1], max, max)], 0),
        (vec!["hopper.takeoff_speed_min_m_s=10", "hopper.takeoff_angle_min_deg=50"], vec![(deg(2.0), fast[1], min, max)], 0),
        (
            vec!["hopper.takeoff_speed_levels_m_s=[5, 10, 11]"],
            vec![
                (of_11[0], of_11[0], levels, levels),
                (deg(0.5), deg(0.5), levels, levels),
                (deg(2.0), deg(2.0), levels, levels),
                (of_11[1], of_11[1], levels, levels),
            ],
            1,
        ),
    ];
    for (keys, windows, flown) in table {
        let answer = hop(&desk, &keys);
        let found = answer["windows"].as_array().unwrap();
        assert_eq!(found.len(), windows.len(), "{keys:?}: {answer}");
        for (found, (from, to, lower, upper)) in found.iter().zip(&windows) {
            let number = |name: &str| found[name].as_f64().unwrap();
            let [least, greatest] = [number("takeoff_angle_min_deg"), number("takeoff_angle_max_deg")];
            assert!((least - from).abs() < 1e-6 && (greatest - to).abs() < 1e-6, "{keys:?}: {found}, expected {from} to {to}");
            assert_eq!([&found["lower"]["limit"], &found["upper"]["limit"]], [lower, upper], "{keys:?}");
            assert_eq!(found["lower"]["vertex"], Value::Null);
        }
        for end in ["takeoff_angle_min_deg", "takeoff_angle_max_deg"] {
            assert_eq!(answer[end], found[flown][end], "{keys:?}");
        }
        assert_eq!(answer["binding"]["upper"], found[flown]["upper"]["limit"], "{keys:?}");
        let best = answer["best"]["takeoff_angle_deg"].as_f64().unwrap();
        assert!(windows[flown].0 - 1e-6 <= best && best <= windows[flown].1 + 1e-6, "{keys:?}: {best}");
    }
}

#[test]
fn a_hop_without_windows_names_the_speeds_that_the_other_limits_leave() {
    let desk = desk();
    // 40 to 50 degrees: 8.94 to 9.01 m/s.
    let steep = ["hopper.takeoff_angle_min_deg=40", "hopper.takeoff_angle_max_deg=50"];
    let table = [
        ("hopper.takeoff_speed_min_m_s=10", "takeoff-speed-min", "the least one of the machine is 10 m/s"),
        ("hopper.takeoff_speed_levels_m_s=[9.5, 11]", "takeoff-speed-levels", "the nearest one that the machine has is 9.5 m/s"),
        // 8 m/s carry nothing over 8 m.
        ("hopper.takeoff_speed_levels_m_s=[8.9, 11]", "takeoff-speed-levels", "the nearest one that the machine has is 11 m/s"),
    ];
    for (key, limit, said) in table {
        let answer = hop(&desk, &[&[key], &steep[..]].concat());
        assert_eq!((&answer["feasible"], &answer["windows"]), (&Value::Bool(false), &Value::Array(vec![])), "{key}");
        assert_eq!(answer["binding"]["conflict"][0], limit, "{key}: {answer}");
        let sentence = answer["binding"]["sentence"].as_str().unwrap();
        assert!(sentence.contains(said) && sentence.contains("from 8.944272 to 9.0"), "{key}: {sentence}");
    }
    // All levels are too slow for any arc.
    let answer = hop(&desk, &["hopper.takeoff_speed_levels_m_s=[3, 5]"]);
    let sentence = answer["binding"]["sentence"].as_str().unwrap();
    assert_eq!(sentence, "takeoff-speed-levels refuses every arc: every arc needs at least 8.944272 m/s, the limit is 5 m/s");
    let text = desk.run(&["hop", "flat.toml", "--set", "hopper.takeoff_speed_min_m_s=10"]).stdout;
    assert!(text.contains("feasible: take-off angles in 2 windows"), "{text}");
    assert!(text.contains("to 26.565051 deg, from takeoff-speed to takeoff-speed-min"), "{text}");
    assert!(text.contains("but not between 26.565051 and 63.434949 deg"), "{text}");
}

#[test]
fn plans_trials_and_pictures_use_the_speeds_that_the_machine_has() {
    let desk = desk();
    let levels = ["--set", "hopper.takeoff_speed_levels_m_s=[6, 10]"];
    let far = ["--goal", "77"];
    let ran =
        desk.run(&[&["plan", "flat.toml", "--verify", "--format", "json", "--plot", "path.svg"], &levels[..], &far[..]].concat());
    assert_eq!(ran.status, 0, "{ran:?}");
    let answer: Value = serde_json::from_str(&ran.stdout).unwrap();
    let hops = answer["path"].as_array().unwrap();
    assert!(hops.len() >= 8, "{answer}");
    for hop in hops {
        let speed = hop["takeoff_speed_m_s"].as_f64().unwrap();
        assert!([6.0, 10.0].iter().any(|level| (speed / level - 1.0).abs() < 2e-9), "{speed}");
        assert_eq!(hop["takeoff_angle_min_deg"], hop["takeoff_angle_max_deg"]);
        assert_eq!(hop["binding"], "takeoff-speed-levels/takeoff-speed-levels");
    }
    let picture = desk.read("path.svg");
    assert!(picture.contains("take-off speeds 6, 10 m/s") && picture.contains("it has none between them"), "names");
    let ran = desk.run(&["plan", "flat.toml", "--plot", "two.svg", "--set", "hopper.takeoff_speed_min_m_s=10"]);
    assert_eq!(ran.status, 0, "{ran:?}");
    let picture = desk.read("two.svg");
    assert!(
        picture.contains("take-off speed ≥ 10 m/s") && picture.contains("the least take-off speed refuses the angles"),
        "names"
    );
}

#[test]
fn a_smaller_least_speed_is_more_capable() {
    let desk = desk();
    // No room to go back and forth.
    desk.write("flat.csv", "x_m,z_m\n0,0\n4,0\n8,0\n");
    let keys =
        ["--set", "hopper.takeoff_angle_min_deg=40", "--set", "hopper.takeoff_angle_max_deg=50", "--points-per-segment", "0"];
    let vary = ["require", "flat.toml", "--format", "json", "--vary", "hopper.takeoff_speed_min_m_s", "--resolution", "1e-6"];
    let ran = desk.run(&[&vary[..], &keys[..]].concat());
    assert_eq!(ran.status, 0, "{ran:?}");
    let answer: Value = serde_json::from_str(&ran.stdout).unwrap();
    let [out, within] = ["unreachable_at", "reachable_at"].map(|name| answer[name].as_f64().unwrap());
    // 8 m in one hop of 40 or 50 degrees, v^2 = g X / sin 2 theta; two hops of 4 m are slower.
    let threshold = (80.0 / 80f64.to_radians().sin()).sqrt();
    assert!(within <= threshold && threshold <= out && out - within < 1e-4, "{within} to {out}, expected {threshold}");
    let trade = ["trade", "flat.toml", "--vary", "hopper.takeoff_speed_min_m_s=8:11:4", "--format", "json"];
    let ran = desk.run(&[&trade[..], &keys[..]].concat());
    let answer: Value = serde_json::from_str(&ran.stdout).unwrap();
    let hops: Vec<_> = answer["rows"].as_array().unwrap().iter().map(|row| row["hops"].as_u64()).collect();
    assert_eq!(hops, [Some(1), Some(1), None, None], "{answer}");
    // The least speed bounds the range of the greatest one, and neither has a threshold of gravity.
    let min = ["--set", "hopper.takeoff_speed_min_m_s=8"];
    let ran = desk.run(&[&["require", "flat.toml", "--vary", "hopper.takeoff_speed_max_m_s"], &min[..]].concat());
    assert_eq!(ran.status, 0, "{ran:?}");
    desk.refused(&[&["require", "flat.toml", "--vary", "body.gravity_m_s2"], &min[..]].concat(), &["forbid the short ones"]);
    desk.refused(&["require", "flat.toml", "--vary", "hopper.takeoff_speed_levels_m_s"], &["expected one of"]);
    desk.refused(&["trade", "flat.toml", "--vary", "hopper.takeoff_speed_levels_m_s=1:2:2"], &["takeoff_speed_levels_m_s"]);
}

#[test]
fn take_off_speeds_that_no_machine_has_are_refused_in_one_sentence() {
    let desk = desk();
    let list = "expected a list of 1 to 16 speeds in m/s, ascending without repetition, each from 1e-9 to 1e5";
    let table: [(&[&str], &[&str]); 12] = [
        (
            &["takeoff_speed_min_m_s=13"],
            &["hopper.takeoff_speed_min_m_s is 13, expected no more than the takeoff_speed_max_m_s of 12", "lower it, or raise"],
        ),
        (&["takeoff_speed_min_m_s=0"], &["hopper.takeoff_speed_min_m_s is 0, expected a number from 1e-9 to 1e5"]),
        (&["takeoff_speed_min_m_s=-1"], &["hopper.takeoff_speed_min_m_s is -1, expected a number from 1e-9 to 1e5"]),
        (&["takeoff_speed_levels_m_s=[]"], &["hopper.takeoff_speed_levels_m_s is [], ", list]),
        (&["takeoff_speed_levels_m_s=[4, 2]"], &["hopper.takeoff_speed_levels_m_s is [4, 2], ", list]),
        (&["takeoff_speed_levels_m_s=[2, 2]"], &["is [2, 2], ", list]),
        (&["takeoff_speed_levels_m_s=[0, 2]"], &["is [0, 2], ", list]),
        (&["takeoff_speed_levels_m_s=[-2.5, 2]"], &["is [-2.5, 2], ", list]),
        (&["takeoff_speed_levels_m_s=5"], &["is 5, ", list]),
        (&["takeoff_speed_levels_m_s=[1,2,3,4,5,6,7,8,9,9.1,9.2,9.3,9.4,9.5,9.6,9.7,9.8]"], &[list]),
        (
            &["takeoff_speed_levels_m_s=[2, 12.5]"],
            &[
                "hopper.takeoff_speed_levels_m_s has 12.5, expected no level above the takeoff_speed_max_m_s of 12",
                "leave out that level",
            ],
        ),
        (
            &["takeoff_speed_levels_m_s=[2, 12]", "takeoff_speed_min_m_s=3"],
            &[
                "hopper.takeoff_speed_levels_m_s has 2, expected no level below the takeoff_speed_min_m_s of 3",
                "leave out that level",
            ],
        ),
    ];
    for (keys, said) in table {
        let set: Vec<String> = keys.iter().flat_map(|key| ["--set".to_owned(), format!("hopper.{key}")]).collect();
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        for command in [&["plan", "flat.toml"][..], &["hop", "flat.toml"], &["check", "flat.toml", "--prove"]] {
            desk.refused(&[command, &set[..]].concat(), said);
        }
    }
    desk.write("wrong.toml", FLAT.replace("[hopper]\n", "[hopper]\ntakeoff_speed_levels_m_s = [4, 2]\n"));
    desk.refused(&["plan", "wrong.toml"], &["wrong.toml", "4:28", list]);
}

#[test]
fn speeds_above_escape_are_warned_of() {
    let desk = desk();
    desk.write("small.toml", FLAT.replace("gravity_m_s2 = 10", "gravity_m_s2 = 0.001\nradius_m = 1000"));
    for key in ["takeoff_speed_min_m_s=2", "takeoff_speed_levels_m_s=[2]"] {
        let ran = desk.run(&["plan", "small.toml", "--set", &format!("hopper.{key}")]);
        assert_eq!(ran.status, 1, "{ran:?}");
        assert!(ran.stderr.contains("no hop has that speed, since one so fast never lands"), "{}", ran.stderr);
    }
}
