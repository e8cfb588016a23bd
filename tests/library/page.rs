//! The page of an answer: what is embedded is the committed bundle, and the arcs of its script are those of the library.

#![allow(clippy::unwrap_used, reason = "a test that cannot read its files should stop")]

use std::{
    fmt::Write as _,
    fs,
    io::Write as _,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use chta::{
    ballistics::{Arc, LineOfSight},
    report::page_template,
};
use serde_json::Value;

use crate::{installed::installed, support::Draw};

fn report(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("report").join(name)
}

fn json(name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(report(name)).unwrap()).unwrap()
}

#[test]
fn the_committed_bundle_is_what_is_embedded() {
    assert!(page_template().unwrap() == fs::read_to_string(report("dist/page.html")).unwrap(), "build the program again");
}

#[test]
fn the_lock_file_names_the_versions_and_the_page_holds_the_licence_of_three() {
    let (package, lock) = (json("package.json"), json("package-lock.json"));
    let page = page_template().unwrap();
    for name in ["three", "esbuild"] {
        let wanted = package["devDependencies"][name].as_str().unwrap();
        let locked = &lock["packages"][format!("node_modules/{name}")];
        assert_eq!(locked["version"], wanted, "{name}");
        assert!(locked["integrity"].as_str().is_some_and(|hash| hash.starts_with("sha512-")), "{name} has no checksum");
    }
    let version = package["devDependencies"]["three"].as_str().unwrap();
    assert!(page.contains(&format!("three.js {version}:")), "the page was bundled with another version than {version}");
    let licence = fs::read_to_string(report("dist/three.LICENSE")).unwrap();
    assert!(licence.starts_with("The MIT License") && page.contains(licence.trim()));
}

/// What `report/test/arcs.mjs` prints of a hop, in this order.
fn values(arc: &Arc) -> [f64; 9] {
    let run_m = arc.line_of_sight().run_m();
    [
        arc.takeoff_speed_m_s(),
        arc.landing_speed_m_s(),
        arc.horizontal_speed_m_s(),
        arc.landing_angle().degrees(),
        arc.flight_time_s(),
        arc.apex_height_m(),
        arc.height_at_m(0.1 * run_m),
        arc.height_at_m(0.5 * run_m),
        arc.height_at_m(0.93 * run_m),
    ]
}

/// 10 000 hops from a millimetre to kilometres, over steep rises and falls, from flat to lobbed, under every gravity, each given to the page's
/// equations as an answer states it: by its take-off angle in degrees.
#[test]
fn the_arcs_of_the_page_are_those_of_the_library() {
    if !installed("node") {
        return;
    }
    let mut draw = Draw::seeded(23);
    let (mut input, mut arcs) = (String::new(), Vec::new());
    for _ in 0..10_000 {
        let run_m = draw.log_uniform(1e-3, 1e4);
        let slope = if draw.chance(0.1) { 0.0 } else { draw.sign() * draw.log_uniform(1e-3, 5.0) };
        let sight = LineOfSight::new(run_m, slope * run_m);
        let gravity_m_s2 = draw.gravity();
        let arc = Arc::new(sight, draw.log_uniform(1e-3, 1e2), gravity_m_s2);
        writeln!(input, "{run_m:?} {:?} {:?} {gravity_m_s2:?}", sight.rise_m(), arc.takeoff_angle().degrees()).unwrap();
        arcs.push(arc);
    }
    let mut node = Command::new("node").arg(report("test/arcs.mjs")).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut stdin = node.stdin.take().unwrap();
    let writer = std::thread::spawn(move || stdin.write_all(input.as_bytes()).unwrap());
    let output = node.wait_with_output().unwrap();
    writer.join().unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let mut worst = 0.0f64;
    assert_eq!(text.lines().count(), arcs.len());
    for (line, arc) in text.lines().zip(&arcs) {
        let found: Vec<f64> = line.split(' ').map(|number| number.parse().unwrap()).collect();
        let expected = values(arc);
        assert_eq!(found.len(), expected.len(), "{line}");
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            // Heights are compared with the size of the hop: they may be 0.
            let size = if i >= 5 { arc.line_of_sight().length_m().max(arc.apex_height_m()) } else { expected.abs() };
            let error = (found - expected).abs() / size;
            worst = worst.max(error);
            assert!(error <= 1e-9, "value {i}: {found} in the page, {expected} in the library, of {arc:?}");
        }
    }
    assert!(worst > 0.0, "the page's arithmetic is its own");
}
