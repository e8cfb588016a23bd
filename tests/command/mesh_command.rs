//! The command on meshes: slice, scenario, refusals.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::fmt::Write as _;

use assert_cmd::Command;
use serde_json::Value;

fn chta(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("chta").unwrap().current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn the_papers_simple_scenario_runs_from_a_mesh_and_its_result_repeats_itself() {
    let directory = tempfile::tempdir().unwrap();
    let folder = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let (status, _, talk) = chta(&["run", "data/scenarios/simple_mesh.toml", "-o", &folder("one")]);
    assert_eq!((status, talk.as_str()), (0, ""));
    let result = std::fs::read(directory.path().join("one/result.json")).unwrap();
    let document: Value = serde_json::from_slice(&result).unwrap();
    assert_eq!(
        (&document["hops"], &document["path"][0]["takeoff_x_m"], &document["path"][0]["landing_x_m"]),
        (&1.into(), &2.0.into(), &10.0.into())
    );
    let terrain = &document["scenario"]["terrain"];
    assert_eq!((&terrain["mesh"], &terrain["mesh_scale"]), (&"data/mesh/simple.obj".into(), &1.0.into()));
    assert_eq!(document["inputs"][0]["name"], "data/mesh/simple.obj");
    assert_eq!(document["path"][0]["takeoff_map_x_m"], 2.0);
    let (status, ..) = chta(&["run", &folder("one/result.json"), "-o", &folder("two")]);
    assert_eq!(status, 0);
    for file in ["result.json", "chain.csv", "path.csv", "path.svg"] {
        let read = |run: &str| std::fs::read(directory.path().join(run).join(file)).unwrap();
        assert!(read("one") == read("two"), "{file} differs");
    }
    for command in ["hop", "check", "plan"] {
        assert_eq!(chta(&[command, "data/scenarios/simple_mesh.toml"]).0, 0, "{command}");
    }
}

#[test]
fn slices_of_meshes_are_chains_with_their_scale_and_warnings() {
    let (status, chain, talk) = chta(&["slice", "data/mesh/simple.obj", "--from", "0,0", "--to", "12,0"]);
    assert_eq!((status, talk.as_str()), (0, ""));
    assert_eq!(chain.lines().filter(|line| !line.starts_with('#')).count(), 7);
    let (status, chain, _) = chta(&["slice", "data/mesh/simple.obj", "--from", "0,0", "--to", "12000,0", "--mesh-scale", "1000"]);
    assert!(status == 0 && chain.contains("12000.0,3000.0") || chain.contains("12000,3000"), "{chain}");
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("table.obj");
    let table = "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\nv 3 3 1\nv 6 3 1\nv 6 6 1\nv 3 6 1\nf -4 -3 -2 -1\n";
    std::fs::write(&path, table).unwrap();
    let options = ["slice", path.to_str().unwrap(), "--from", "1,4", "--to", "8,4"];
    let (status, chain, talk) = chta(&options);
    assert!(
        status == 0 && talk.contains("2 faces of the mesh") && talk.contains("uppermost") && talk.contains("overhang of 1.000 m"),
        "{talk}"
    );
    assert!(chain.contains("# warning: the upper surface jumps in 2 places"), "{chain}");
    assert_eq!(chta(&[&options[..], &["--quiet"]].concat()).2, "");
}

#[test]
fn a_faulty_mesh_gives_one_sentence_and_status_two() {
    let directory = tempfile::tempdir().unwrap();
    let cut = directory.path().join("cut.stl");
    let mut bytes = vec![0; 84];
    bytes[80] = 200;
    std::fs::write(&cut, bytes).unwrap();
    let from_to = ["--from", "0,0", "--to", "1,0"];
    for (arguments, expected) in [
        (["slice", "data/mesh/simple.obj", "--mesh-scale", "0"], "mesh_scale is 0, expected metres per unit"),
        (["slice", "data/terrain/lunar_rille.tif", "--mesh-scale", "2"], "is an elevation raster, expected a mesh"),
        (["slice", cut.to_str().unwrap(), "--mesh-scale", "1"], "200 triangles in 10084 bytes, but the file has 84 bytes"),
        (["slice", "data/mesh/absent.obj", "--mesh-scale", "1"], "absent.obj"),
    ] {
        let (status, _, talk) = chta(&[&arguments[..], &from_to].concat());
        assert!(status == 2 && talk.contains(expected), "{arguments:?}: {talk}");
    }
    let (status, _, talk) = chta(&["slice", "data/mesh/simple.obj", "--from", "0,0", "--to", "20,0"]);
    assert!(status == 2 && talk.contains("meets no triangle of the mesh from x = 12 m to 20 m"), "{talk}");
    for (set, expected) in [
        ("terrain.dem=a.tif", "terrain has both dem and mesh, expected one of the two"),
        ("terrain.chain=a.csv", "terrain has both mesh and chain"),
        ("terrain.mesh_scale=-1", "terrain.mesh_scale is -1"),
        ("terrain.meshscale=1", "nearest known key is terrain.mesh_scale"),
    ] {
        let (status, _, talk) = chta(&["check", "data/scenarios/simple_mesh.toml", "--set", set]);
        assert!(status == 2 && talk.contains(expected), "{set}: {talk}");
    }
    let (status, _, talk) = chta(&["check", "data/scenarios/simple.toml", "--set", "terrain.mesh_scale=2"]);
    assert!(status == 2 && talk.contains("terrain.mesh_scale without a mesh"), "{talk}");
}

/// A floor with a wall half-way, which has a slot from 1 to 2 m.
const SLOT: &str = "v -5 -5 0\nv 15 -5 0\nv 15 5 0\nv -5 5 0\nf 1 2 3 4\n\
                    v 5 -5 0\nv 5 5 0\nv 5 5 1\nv 5 -5 1\nf 5 6 7 8\nv 5 -5 2\nv 5 5 2\nv 5 5 4\nv 5 -5 4\nf 9 10 11 12\n";

const MACHINE: [&str; 10] = [
    "--set",
    "body.gravity_m_s2=9.81",
    "--set",
    "hopper.takeoff_speed_max_m_s=12",
    "--set",
    "hopper.landing_speed_max_m_s=12",
    "--set",
    "surface.friction_coefficient=4",
    "--set",
    "surface.rest_slope_max_deg=inf",
];

/// Through the slot and over the wall: n = h 10 / 25 in the middle of 10 m, from 0.4 to 0.8, and above 1.6.
#[test]
fn a_hop_over_a_mesh_has_every_window_with_the_facet_that_bounds_it() {
    let directory = tempfile::tempdir().unwrap();
    let file = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(file("slot.obj"), SLOT).unwrap();
    let hop = |more: &[&str]| {
        let (mesh, ends) = (file("slot.obj"), ["--from", "0,0.25,0.5", "--to", "10,0.25,0"]);
        chta(&[&["hop", mesh.as_str()], &ends[..], &MACHINE, more].concat())
    };
    let (status, text, talk) = hop(&["--format", "json"]);
    assert_eq!(status, 0, "{talk}");
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["schema"], "chta/hop-mesh/1");
    assert_eq!((&document["takeoff"]["moved_m"], &document["landing"]["moved_m"]), (&0.5.into(), &0.0.into()));
    let angle = |loft: f64| loft.atan().to_degrees();
    let windows = document["windows"].as_array().unwrap();
    let found: Vec<[f64; 2]> = windows
        .iter()
        .map(|window| ["takeoff_angle_min_deg", "takeoff_angle_max_deg"].map(|key| window[key].as_f64().unwrap()))
        .collect();
    assert_eq!(found.len(), 2, "{text}");
    for (found, wanted) in [(found[0][0], angle(0.4)), (found[0][1], angle(0.8)), (found[1][0], angle(1.6))] {
        assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
    }
    // The lower part of the wall is triangles 3 and 4, the upper one 5 and 6.
    let bound = |window: usize, end: &str| windows[window][end]["facet"]["number"].as_u64();
    assert!(matches!(bound(0, "lower"), Some(3 | 4)) && matches!(bound(0, "upper"), Some(5 | 6)), "{text}");
    assert!(matches!(bound(1, "lower"), Some(5 | 6)) && bound(1, "upper").is_none(), "{text}");
    assert_eq!(windows[1]["upper"]["limit"], "takeoff-speed");
    assert_eq!(document["blocked"].as_array().map(Vec::len), Some(2));
    // As text, and as a picture.
    let (status, text, _) = hop(&["--plot", &file("hop.svg")]);
    assert!(status == 0 && text.contains("in 2 windows") && text.contains("terrain (facet "), "{text}");
    let picture = std::fs::read_to_string(file("hop.svg")).unwrap();
    assert!(picture.contains("facets that bound the windows") && picture.contains("feasible in 2 windows"));
    // With more clearance than half of the slot, and too slow for the way over the wall: no, and why.
    let (status, text, _) = hop(&["--set", "hopper.clearance_m=0.6", "--set", "hopper.takeoff_speed_max_m_s=10"]);
    assert!(status == 1 && text.contains("why: the terrain blocks all take-off angles that the other limits leave"), "{text}");
}

#[test]
fn what_is_no_hop_over_a_mesh_is_refused_with_what_is_expected() {
    let directory = tempfile::tempdir().unwrap();
    let file = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    // A box of 2 m on the floor.
    let mut corners = String::new();
    for i in 0..8 {
        writeln!(corners, "v {} {} {}", 4 + 2 * (i & 1), (i & 2) - 1, (i & 4) / 2).unwrap();
    }
    let faces = "f 5 7 8 6\nf 9 10 12 11\nf 5 6 10 9\nf 7 11 12 8\nf 5 9 11 7\nf 6 8 12 10\n";
    let floor = SLOT.split("v 5").next().unwrap();
    std::fs::write(file("box.obj"), format!("{floor}{corners}{faces}")).unwrap();
    let mesh = file("box.obj");
    let refused = |from: &str, to: &str, more: &[&str], said: &[&str]| {
        let (status, text, talk) = chta(&[&["hop", mesh.as_str(), "--from", from, "--to", to], &MACHINE[..], more].concat());
        assert_eq!((status, text.as_str()), (2, ""), "{talk}");
        let sentence = talk.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in said {
            assert!(sentence.contains(part), "{sentence}");
        }
    };
    refused("5,0,0.5", "10,0,0", &[], &["the take-off: (5, 0, 0.5) m lies inside a closed body", "nearest point of the surface"]);
    refused("0,0,0", "0,0,1", &[], &["take-off and landing are both at x, y = 0, 0 m"]);
    refused("0,0,0", "3,0", &[], &["--to: found `3,0` (2 numbers), expected three finite numbers", "box.obj is a mesh"]);
    refused("0,0,0", "10,0,0", &["--set", "surface.keep_out=data/mesh/simple.obj"], &["keep_out"]);
    refused("0,0,0", "10,0,0", &["--set", "hopper.footprint_m=0.5"], &["found hopper.footprint_m", "remove it"]);
    refused("0,0,0", "10,0,0", &["--trajectory", &file("t.csv")], &["--trajectory: found this option"]);
    let (status, _, talk) = chta(&["hop", &mesh, "--from", "0,0,0", "--to", "10,0,0", "--body", "mars"]);
    assert!(status == 2 && talk.contains("found no hopper.takeoff_speed_max_m_s"), "{talk}");
    let (status, _, talk) = chta(&["hop", &mesh, "--from", "0,0,0", "--body", "mars"]);
    assert!(status == 2 && talk.contains("found no goal, expected --to X,Y,Z"), "{talk}");
    let chain = ["hop", "data/scenarios/simple.toml", "--plot", "x.svg"];
    assert!(chta(&chain).2.contains("--plot: found this option"));
    // Round it, from a scenario that names the mesh.
    let scenario = "[body]\ngravity_m_s2 = 9.81\n[hopper]\ntakeoff_speed_max_m_s = 20.0\nlanding_speed_max_m_s = 20.0\n[surface]\n\
                    friction_coefficient = 2.0\n[terrain]\nmesh = \"box.obj\"\nstart_m = [0.0, 0.0]\ngoal_m = [10.0, 0.0]\n";
    std::fs::write(file("box.toml"), scenario).unwrap();
    let (status, text, talk) = chta(&["hop", &file("box.toml"), "--from", "0,0,0", "--to", "10,0,0"]);
    assert!(status == 0 && text.contains("takeoff"), "{talk}{text}");
}
