//! Hops over meshes: surfaces of groups of faces, balls, and meshes that are damaged or doubtful.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use serde_json::Value;

use crate::desk::{Desk, Ran};

/// A closed box from (0, 0, 0) to (10, 4, 1), its top of two groups.
const BOX: &str = "v 0 0 0\nv 10 0 0\nv 10 4 0\nv 0 4 0\nv 0 0 1\nv 10 0 1\nv 10 4 1\nv 0 4 1\nv 5 0 1\nv 5 4 1\nv 5 0 0\nv 5 4 0\n\
    o slab\ng sides\nf 1 4 12 11\nf 11 12 3 2\nf 1 11 9 5\nf 11 2 6 9\nf 4 8 10 12\nf 12 10 7 3\nf 1 5 8 4\nf 2 3 7 6\n\
    g west\nusemtl rock\nf 5 9 10 8\ng east\nusemtl sand\nf 9 6 7 10\n";

const MACHINE: [&str; 8] = [
    "--set",
    "body.gravity_m_s2=9.81",
    "--set",
    "hopper.takeoff_speed_max_m_s=9",
    "--set",
    "hopper.landing_speed_max_m_s=9",
    "--set",
    "surface.friction_coefficient=1",
];

/// The hop from the west to the east of the box, with more settings.
fn hop(desk: &Desk, mesh: &str, more: &[&str]) -> Ran {
    desk.run(&[&["hop", mesh, "--from", "2,2,1", "--to", "8,2,1"], &MACHINE[..], more].concat())
}

fn least_deg(ran: &Ran) -> f64 {
    let document: Value = serde_json::from_str(&ran.stdout).unwrap_or_else(|_| panic!("{ran:?}"));
    document["limits"].as_array().unwrap().iter().find(|limit| limit["name"] == "takeoff-cone").unwrap()["min_deg"]
        .as_f64()
        .unwrap()
}

#[test]
fn groups_objects_and_materials_have_their_own_surface() {
    let desk = Desk::new();
    desk.write("box.obj", BOX);
    let bare = hop(&desk, "box.obj", &["--format", "json"]);
    assert_eq!(bare.status, 0, "{bare:?}");
    assert!((least_deg(&bare) - 45.0).abs() < 1e-9);
    let document: Value = serde_json::from_str(&bare.stdout).unwrap();
    assert_eq!(document["takeoff"]["groups"], serde_json::json!(["rock", "slab", "west"]));
    // A group, an object and a material; of several the strictest.
    for (groups, wanted_deg) in [
        ("{ west = { friction_coefficient = 0.5 } }", 2.0_f64.atan().to_degrees()),
        ("{ rock = { friction_coefficient = 2.0 } }", 0.5_f64.atan().to_degrees()),
        ("{ slab = { friction_coefficient = 2.0 }, rock = { friction_coefficient = 0.25 } }", 4.0_f64.atan().to_degrees()),
        ("{ east = { friction_coefficient = 0.5 } }", 45.0),
    ] {
        let set = format!("surface.group={groups}");
        let ran = hop(&desk, "box.obj", &["--format", "json", "--set", &set]);
        assert!((least_deg(&ran) - wanted_deg).abs() < 1e-9, "{groups}: {}", least_deg(&ran));
        let document: Value = serde_json::from_str(&ran.stdout).unwrap();
        assert!(document["scenario"]["surface"]["group"].is_object());
    }
    // Planning may use a share of it.
    let share =
        ["--format", "json", "--set", "surface.group={ west = { friction_coefficient = 1.0 } }", "--set", "derating.friction=0.5"];
    assert!((least_deg(&hop(&desk, "box.obj", &share)) - 2.0_f64.atan().to_degrees()).abs() < 1e-9);
    let ran = hop(&desk, "box.obj", &["--set", "surface.group={ sand = { keep_out = true } }"]);
    assert!(ran.status == 1 && ran.stdout.contains("keep-out") && ran.stdout.contains("(east, sand, slab)"), "{ran:?}");
    // In a file, as tables.
    desk.write(
        "machine.toml",
        "[body]\ngravity_m_s2 = 9.81\n[hopper]\ntakeoff_speed_max_m_s = 9.0\nlanding_speed_max_m_s = 9.0\n[surface]\n\
         friction_coefficient = 1.0\n[surface.group.east]\nrest_slope_max_deg = 0.0\nkeep_out = false\n",
    );
    let words = ["hop", "box.obj", "--from", "2,2,1", "--to", "8,2,1", "--scenario", "machine.toml"];
    assert_eq!(desk.run(&words).status, 0);
    // Names that the mesh does not have, keys that a group does not have, and terrain without faces.
    let refused = |ran: Ran, said: &[&str]| {
        let sentence = ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(ran.status == 2 && said.iter().all(|said| sentence.contains(said)), "{sentence}");
    };
    let wrong = hop(&desk, "box.obj", &["--set", "surface.group={ ice = { keep_out = true } }"]);
    refused(wrong, &["found surface.group.ice", "east, rock, sand, sides, slab, west"]);
    let wrong = hop(&desk, "box.obj", &["--set", "surface.group={ west = { friction = 0.5 } }"]);
    refused(wrong, &["surface.group", "friction_coefficient"]);
    for (set, said) in [
        ("surface.group={ ice = { keep_out = true } }", "found surface.group"),
        ("hopper.radius_m=0.1", "found hopper.radius_m of 0.1 m"),
    ] {
        desk.write("flat.csv", "x_m,z_m\n0,0\n20,0\n40,0\n");
        let chain = ["check", "flat.csv", "--body", "mars", "--set", "hopper.takeoff_speed_max_m_s=9"];
        let more = ["--set", "hopper.landing_speed_max_m_s=9", "--set", "surface.friction_coefficient=1", "--set", set];
        refused(desk.run(&[&chain[..], &more].concat()), &[said, "expected a scenario without it"]);
    }
}

#[test]
fn faces_of_a_ply_have_their_own_surface() {
    let desk = Desk::new();
    let ply = |west: &str, east: &str| {
        let top = [("0 1 4 5", west), ("1 2 3 4", east)].map(|(corners, stated)| format!("4 {corners} {stated}\n")).concat();
        format!(
            "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n\
             property list uchar int vertex_indices\nproperty float friction\nproperty uchar keep_out\nend_header\n\
             0 0 1\n5 0 1\n10 0 1\n10 4 1\n5 4 1\n0 4 1\n{top}"
        )
    };
    desk.write("top.ply", ply("0.5 0", "nan 0"));
    assert!((least_deg(&hop(&desk, "top.ply", &["--format", "json"])) - 2.0_f64.atan().to_degrees()).abs() < 1e-9);
    desk.write("top.ply", ply("0.5 0", "nan 1"));
    let ran = hop(&desk, "top.ply", &[]);
    assert!(ran.status == 1 && ran.stdout.contains("keep-out"), "{ran:?}");
    // A slice leaves them out, and says so.
    let ran = desk.run(&["slice", "top.ply", "--from", "1,1", "--to", "9,1"]);
    assert!(ran.status == 0 && ran.stderr.contains("the mesh states the friction"), "{ran:?}");
    desk.write("top.ply", ply("nan 0", "nan 0"));
    let ran = desk.run(&["slice", "top.ply", "--from", "1,1", "--to", "9,1"]);
    assert!(ran.status == 0 && !ran.stderr.contains("the mesh states"), "{ran:?}");
    desk.write("top.ply", ply("-1 0", "nan 1"));
    let ran = hop(&desk, "top.ply", &[]);
    assert!(ran.status == 2 && ran.stderr.contains("face 1 of the PLY"), "{ran:?}");
}

#[test]
fn a_ball_says_its_bound_and_refuses_places_without_room() {
    let desk = Desk::new();
    desk.write("box.obj", BOX);
    let ran = hop(&desk, "box.obj", &["--format", "json", "--set", "hopper.radius_m=0.2"]);
    let document: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!((ran.status, &document["ball"]["radius_m"]), (0, &0.2.into()));
    let number = |value: &Value| value.as_f64().unwrap();
    assert!((number(&document["ball"]["takeoff_centre_m"][2]) - 1.3).abs() < 1e-12);
    assert!((number(&document["ball"]["refused_within_m"]) - 0.2 * 1.473_625_8).abs() < 1e-6);
    let text = hop(&desk, "box.obj", &["--set", "hopper.radius_m=0.2"]).stdout;
    assert!(text.contains("a ball of radius 0.2 m whose centre begins and ends 0.3 m off the surface"), "{text}");
    // A plate close over the take-off.
    desk.write("low.obj", format!("{BOX}v 1 1 1.1\nv 3 1 1.1\nv 3 3 1.1\nv 1 3 1.1\nf -4 -3 -2 -1\n"));
    let ran = desk
        .run(&[&["hop", "low.obj", "--from", "2,2,1.01", "--to", "8,2,1", "--set", "hopper.radius_m=0.2"], &MACHINE[..]].concat());
    let sentence = ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(ran.status == 2 && sentence.contains("a ball of radius 0.2 m") && sentence.contains("touches facet"), "{sentence}");
}

/// A sentence and status 2, or an answer with a warning that counts.
#[test]
fn damaged_meshes_are_refused_and_doubtful_ones_are_counted() {
    let desk = Desk::new();
    let corner = "v 0 0 1\n";
    for (name, text, said) in [
        ("empty.obj", String::new(), "empty"),
        ("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned(), "no faces"),
        ("nan.obj", BOX.replacen(corner, "v 0 0 nan\n", 1), "line 5"),
        ("inf.obj", BOX.replacen(corner, "v 0 0 inf\n", 1), "line 5"),
        ("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n".to_owned(), "no area"),
        ("far.obj", BOX.replacen(corner, "v 0 0 1e300\n", 1), "expected finite numbers"),
    ] {
        desk.write(name, text);
        let ran = hop(&desk, name, &[]);
        let sentence = ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            ran.status == 2 && ran.stdout.is_empty() && sentence.contains(said) && sentence.contains(name),
            "{name}: {sentence}"
        );
    }
    let faces: String = BOX.lines().filter(|line| line.starts_with("f ")).fold(String::new(), |all, line| all + line + "\n");
    let inside_out = BOX.lines().fold(String::new(), |all, line| {
        let Some(corners) = line.strip_prefix("f ") else { return all + line + "\n" };
        all + "f " + &corners.split(' ').rev().collect::<Vec<_>>().join(" ") + "\n"
    });
    for (name, text, said, status) in [
        ("whole.obj", BOX.to_owned(), "", 0),
        ("open.obj", BOX.replacen("f 1 4 12 11\n", "", 1), "1 of the 1 bodies of the mesh are open, with 4 border edges", 0),
        ("inverted.obj", inside_out, "1 of 1 closed bodies of the mesh are inside out", 1),
        (
            "turned.obj",
            BOX.replacen("f 1 4 12 11", "f 11 12 4 1", 1),
            "4 edges of the mesh join triangles that turn opposite ways",
            0,
        ),
        ("twice.obj", format!("{BOX}{faces}"), "20 triangles of the mesh repeat an earlier one", 0),
        ("thin.obj", format!("{BOX}f 5 9 9\n"), "1 of 21 triangles of the mesh have no area and were dropped", 0),
        (
            "crossed.obj",
            format!("{BOX}v 2 3 -1\nv 2 3 2\nf 3 7 13\nf 7 14 13\n"),
            "of the mesh are crossed by another part of the same body",
            0,
        ),
    ] {
        desk.write(name, text);
        let ran = hop(&desk, name, &["--set", "surface.rest_slope_max_deg=inf"]);
        let sentence = ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(ran.status == status && sentence.contains(said), "{name}: {ran:?}");
        let doubts = ["are open", "inside out", "opposite ways", "repeat an earlier", "are crossed"];
        assert!(!said.is_empty() || !doubts.iter().any(|doubt| sentence.contains(doubt)), "{name}: {sentence}");
    }
    // No friction on level ground: the cone is the normal, straight up, and leads nowhere.
    desk.write("box.obj", BOX);
    let ran = hop(&desk, "box.obj", &["--set", "surface.friction_coefficient=0"]);
    assert!(ran.status == 1 && ran.stdout.contains("contains no direction of travel"), "{ran:?}");
}

/// The shipped meshes are those of the generator, and hop by hop a path leads from the start of each scenario to its goal; in the cave the
/// ceiling bounds every hop above.
#[test]
fn the_shipped_meshes_have_planted_paths() {
    let desk = Desk::new();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    let cave: &[[f64; 3]] = &[
        [1.5, 0.49, -0.4],
        [4.0, 1.24, -0.1],
        [6.5, 1.77, -0.05],
        [9.0, 1.99, -0.16],
        [11.5, 1.88, -0.21],
        [14.0, 1.45, -0.03],
        [16.5, 0.76, 0.35],
        [19.0, -0.05, 0.76],
        [21.5, -0.86, 0.99],
    ];
    let overhang: &[[f64; 3]] = &[[-7.0, 0.0, 0.1], [-4.8, 0.0, 0.1], [-0.5, 0.0, 0.1], [2.5, 0.0, 0.1]];
    let rubble: Vec<[f64; 3]> = [-7.5, -5.0, -2.5, 0.0, 2.5, 5.0, 7.5].map(|x| [x, 0.0, 0.1]).to_vec();
    for (scene, path) in [("cave", cave), ("overhang", overhang), ("rubble", &rubble)] {
        let shipped = root.join(format!("mesh/{scene}.obj"));
        assert_eq!(desk.run(&["synth", "--mesh", scene, "--seed", "1", "-o", "new.obj"]).status, 0);
        assert!(std::fs::read(&shipped).unwrap() == desk.read("new.obj").into_bytes(), "{scene} is not that of the generator");
        assert!(shipped.metadata().unwrap().len() < 300_000);
        let text = std::fs::read_to_string(root.join(format!("mesh_scenarios/{scene}.toml"))).unwrap();
        let scenario: toml::Table = text.parse().unwrap();
        let end = |key: &str| -> Vec<f64> {
            scenario["terrain"][key].as_array().unwrap().iter().map(|number| number.as_float().unwrap()).collect()
        };
        assert_eq!((end("start_m"), end("goal_m")), (path[0].to_vec(), path[path.len() - 1].to_vec()), "{scene}");
        let mut settings = Vec::new();
        for table in ["body", "hopper", "surface"] {
            for (key, value) in scenario[table].as_table().unwrap() {
                settings.extend(["--set".to_owned(), format!("{table}.{key}={value}")]);
            }
        }
        for pair in path.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|[x, y, z]| format!("{x},{y},{z}"));
            let (from, to) = (format!("--from={from}"), format!("--to={to}"));
            let mut words = vec!["hop", shipped.to_str().unwrap(), &from, &to, "--format", "json"];
            words.extend(settings.iter().map(String::as_str));
            let ran = desk.run(&words);
            assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{scene} {words:?}");
            let document: Value = serde_json::from_str(&ran.stdout).unwrap();
            let by_ceiling = document["windows"][0]["upper"]["limit"] == "terrain";
            assert_eq!(by_ceiling, scene == "cave", "{scene} {from}: {}", document["windows"]);
        }
    }
}
