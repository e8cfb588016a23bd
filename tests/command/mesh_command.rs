//! The command on meshes: slice, scenario, refusals.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

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
