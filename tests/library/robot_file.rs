//! Robot files: the shipped ones, the table of their keys, their schema, and what is refused or said.

#![allow(clippy::print_stderr, reason = "a skipped test says why")]
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use chta::{
    scenario::{ROBOT_KEYS, RobotFile, read_robot, robot_of_toml, robot_schema},
    terrain::{Mesh, MeshFormatWritten, mesh_bytes},
    world::{Limb, Workspace},
};
use nalgebra::{Point3, Vector3};

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/robots");
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    files
}

#[test]
fn every_shipped_robot_is_read_without_a_warning() {
    let read = |file: &PathBuf| {
        let RobotFile { robot, warnings, .. } = read_robot(file).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(warnings, [""; 0], "{}", file.display());
        // Every foot reaches below the trunk, and stands away from it.
        let bottom = robot.trunk().iter().flat_map(chta::world::TrunkBox::corners_m).map(|corner| corner.z).fold(0.0, f64::min);
        for limb in robot.limbs() {
            assert!(limb.bounds()[0].z < bottom, "{}: {}", robot.name(), limb.name);
        }
        assert!(robot.mass_kg().is_some() && robot.takeoff_speed_max_m_s().is_some(), "{}", robot.name());
        (robot.name().to_owned(), robot.limbs().len())
    };
    let robots: Vec<_> = shipped().iter().map(read).collect();
    let expected = [("four legs", 4), ("one leg", 1), ("six legs", 6), ("three legs", 3)];
    assert_eq!(robots, expected.map(|(name, limbs)| (name.to_owned(), limbs)));
}

const LIMB: &str = "[[limb]]\nname = \"leg\"\nhip_m = [0, 0, 0]\nshell = { radius_max_m = 0.3, half_angle_deg = 45 }\n";

fn of(text: &str) -> Result<RobotFile, String> {
    robot_of_toml("r.toml", text, "".as_ref(), "r").map_err(|problems| problems.to_string())
}

#[test]
fn what_a_file_states_is_what_the_robot_has() {
    let text = "[robot]\nname = \"all\"\ncontacts_min = 2\nmass_kg = 3\ninertia_kg_m2 = [1, 2, 2.5]\ncentre_of_mass_m = [0.1, 0, 0]\nstroke_m = 0.2\n\
        takeoff_speed_max_m_s = 4\nlanding_speed_max_m_s = 5\nspin_max_rad_s = 0.5\n[[trunk]]\nsize_m = [0.4, 0.2, 0.1]\ncentre_m = [0, 0, 1]\n\
        roll_deg = 10\npitch_deg = 20\nyaw_deg = 90\n[[limb]]\nname = \"a\"\nhip_m = [1, 2, 3]\nfriction_coefficient = 0.7\nforce_max_n = 9\n\
        [limb.shell]\nradius_min_m = 0.1\nradius_max_m = 0.3\naxis = [0, 3, -4]\nhalf_angle_deg = 60\n[[limb]]\nname = \"b\"\nhip_m = [0, 0, 0]\n\
        shell.radius_max_m = 0\n";
    let robot = of(text).unwrap().robot;
    let stated = robot.description();
    assert_eq!((robot.name(), robot.contacts_min(), stated.mass_kg), ("all", 2, Some(3.0)));
    assert_eq!((stated.inertia_kg_m2, stated.stroke_m, stated.spin_max_rad_s), (Some([1.0, 2.0, 2.5]), Some(0.2), Some(0.5)));
    assert_eq!((stated.takeoff_speed_max_m_s, stated.landing_speed_max_m_s), (Some(4.0), Some(5.0)));
    assert_eq!(stated.centre_of_mass_m, Point3::new(0.1, 0.0, 0.0));
    let part = stated.trunk[0];
    assert_eq!((part.centre_m, part.half_m), (Point3::new(0.0, 0.0, 1.0), Vector3::new(0.2, 0.1, 0.05)));
    // Yaw by 90 degrees comes last: the x axis, pitched down by 20 degrees, points along y.
    let ahead = part.axes * Vector3::x();
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    assert!((ahead - Vector3::new(0.0, cos, -sin)).norm() < 1e-15, "{ahead}");
    let Limb { name, hip_m, workspace: Workspace::Shell(shell), friction, force_max_n } = &stated.limbs[0] else {
        panic!("no shell")
    };
    assert_eq!((name.as_str(), *hip_m, *force_max_n), ("a", Point3::new(1.0, 2.0, 3.0), Some(9.0)));
    assert_eq!(friction.map(chta::world::FrictionCone::coefficient), Some(0.7));
    assert_eq!((shell.radius_min_m(), shell.radius_max_m()), (0.1, 0.3));
    assert!(
        (shell.axis().into_inner() - Vector3::new(0.0, 0.6, -0.8)).norm() < 1e-15
            && (shell.half_angle().degrees() - 60.0).abs() < 1e-12
    );
    assert!(stated.limbs[1].reaches(&Point3::origin()) && !stated.limbs[1].reaches(&Point3::new(0.0, 0.0, -1e-9)));
}

#[test]
fn every_problem_of_a_file_is_reported_with_its_place() {
    let text = "[robot]\nmass_kg = -3\ncontacts_min = 4\nlegs = 2\n[[trunk]]\nsize_m = [0.4, 0.2, -0.1]\n[[trunk]]\ncentre_m = [0, 0, 0]\n\
        [[limb]]\nname = \"a\"\nhip_m = [0, 0]\nshell = { radius_min_m = 0.4, radius_max_m = 0.3, half_angle_deg = 200 }\n\
        [[limb]]\nname = \"a\"\nhip_m = [0, 0, 0]\nfriction_coefficient = 0\n[[limb]]\nname = \"c\"\nhip_m = [0, 0, 0]\nworkspace_stl = \"nowhere.stl\"\n[tail]\nx = 1\n";
    let error = of(text).unwrap_err();
    let lines: Vec<&str> = error.lines().collect();
    let expected = [
        ("r.toml:2:11: robot.mass_kg is -3, expected a finite number above 0", "it means: mass"),
        ("r.toml:3:16: robot: contacts_min is 4, expected a whole number from 1 to the number of limbs", "at most as many"),
        ("r.toml:4:1: unknown key robot.legs", "the keys of robot are name, contacts_min"),
        ("r.toml:6:10: trunk box 1: size_m is [0.4, 0.2, -0.1], expected three finite numbers above 0", ""),
        ("r.toml:7:", "trunk box 2: size_m is missing; add size_m"),
        ("r.toml:11:9: limb 1: hip_m is [0, 0], expected three finite numbers", ""),
        ("r.toml:12:26: limb 1 'a': shell.radius_min_m is 0.4, expected less than shell.radius_max_m", ""),
        ("r.toml:12:68: limb 1 'a': shell.half_angle_deg is 200, expected an angle above 0 and at most 180 degrees", ""),
        ("r.toml:13:", "limb 2: shell is missing; add shell"),
        ("r.toml:14:8: limb 2 'a': name is the name of an earlier limb", "a name of its own"),
        ("r.toml:16:24: limb 2: friction_coefficient is 0, expected a finite number above 0", ""),
        ("r.toml:20:17: limb 3: workspace_stl: ", "nowhere.stl"),
        ("r.toml:21:", "unknown table tail; the tables are [robot], [[trunk]] and [[limb]]"),
    ];
    for (line, (begins, has)) in lines.iter().zip(expected) {
        assert!(line.starts_with(begins) && line.contains(has), "{line}\n  expected {begins} ... {has}");
    }
    assert_eq!(lines.len(), expected.len(), "{error}");
}

#[test]
fn what_is_no_robot_file_is_refused_in_one_sentence() {
    for (text, part) in [
        (String::new(), "robot: limb is absent, expected at least one limb"),
        ("[robot]\nname = \"x\"\n".to_owned(), "robot: limb is absent"),
        ("[robot\n".to_owned(), "this is not TOML"),
        (format!("[[robot]]\n{LIMB}"), "robot is given in another form than [robot]"),
        ("[limb]\nname = \"x\"\n".to_owned(), "limb is given in another form than [[limb]]"),
        (format!("[robots]\n{LIMB}"), "unknown table robots; the nearest known table is robot"),
        (format!("mass_kg = 3\n{LIMB}"), "unknown key outside all tables, mass_kg"),
        (LIMB.replace("radius_max_m", "radius_max"), "the nearest known key is shell.radius_max_m"),
        (LIMB.replace("{ radius_max_m = 0.3, half_angle_deg = 45 }", "0.3"), "limb 1: shell is no table"),
        (LIMB.replace(", half_angle_deg = 45", ""), "limb 1: shell.half_angle_deg is missing"),
        (LIMB.replace("radius_max_m = 0.3, ", ""), "limb 1: shell.radius_max_m is missing"),
        (LIMB.replace(" }", ", axis = [0, 0, 0] }"), "limb 1 'leg': shell.axis is [0, 0, 0]"),
        (format!("{LIMB}workspace_stl = \"a.stl\"\n"), "is given beside shell"),
        (
            LIMB.replace("shell = { radius_max_m = 0.3, half_angle_deg = 45 }", "workspace_stl = \"legs\\new.stl\""),
            "workspace_stl is a path with a line break in it",
        ),
        (
            LIMB.replace("shell = { radius_max_m = 0.3, half_angle_deg = 45 }", "workspace_stl = \"C:\\Users\\x.stl\""),
            "write / instead",
        ),
        (format!("[robot]\nspin_max_rad_s = 1\n{LIMB}"), "inertia_kg_m2 is absent"),
        (format!("[robot]\ninertia_kg_m2 = [1, 1, 3]\n{LIMB}"), "each no larger than the other two together"),
        (format!("[robot]\nmass_kg = nan\n{LIMB}"), "robot.mass_kg is nan"),
        (format!("[robot]\nmass_kg = \"3\"\n{LIMB}"), "robot.mass_kg is \"3\""),
        (format!("[robot]\ncontacts_min = 1.5\n{LIMB}"), "robot.contacts_min is 1.5, expected a whole number"),
        (format!("[robot]\nname = 2026-01-01\n{LIMB}"), "robot.name is a date"),
        (format!("{LIMB}[[trunk]]\nstl = \"a.stl\"\nyaw_deg = 3\n"), "is given beside stl"),
    ] {
        let error = of(&text).unwrap_err();
        assert!(error.contains(part), "{text}\n{error}\n  expected {part}");
    }
    assert!(read_robot("nowhere.toml".as_ref()).unwrap_err().to_string().contains("expected a robot file"));
}

/// A folder with the mesh of a cube of 2 m whose bottom is at -1 m, without some of its triangles, or with a corner moved.
fn with_mesh(name: &str, skip: usize, corner: Option<Point3<f64>>) -> tempfile::TempDir {
    let mut corners: Vec<_> = (0..8)
        .map(|i| Point3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - Vector3::repeat(1.0))
        .collect();
    if let Some(corner) = corner {
        corners[7] = corner;
    }
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).skip(skip).collect();
    let folder = tempfile::tempdir().unwrap();
    let mesh = Mesh::new(corners, triangles).unwrap();
    fs::write(folder.path().join(name), mesh_bytes(&mesh, MeshFormatWritten::Stl)).unwrap();
    folder
}

fn with_stl(folder: &tempfile::TempDir, text: &str) -> Result<RobotFile, String> {
    robot_of_toml("r.toml", text, folder.path(), "r").map_err(|problems| problems.to_string())
}

const STL: &str = "[robot]\nstl_unit_m = 0.1\n[[limb]]\nname = \"leg\"\nhip_m = [0, 0, 0]\nworkspace_stl = \"w.stl\"\n";

#[test]
fn workspaces_of_meshes_are_hulls_and_say_what_they_hide() {
    let workspace = |file: &RobotFile| match &file.robot.limbs()[0].workspace {
        Workspace::Convex(hull) => hull.clone(),
        Workspace::Shell(_) => panic!("no hull"),
    };
    let convex = with_stl(&with_mesh("w.stl", 0, None), STL).unwrap();
    assert_eq!((convex.warnings.len(), workspace(&convex).half_spaces().len(), convex.files.len()), (0, 6, 1));
    // A cube of 2 units of 0.1 m.
    assert!((workspace(&convex).volume_m3() - 0.008).abs() < 1e-9);
    // Without a side it is open, seen from the middle by a sixth.
    let open = with_stl(&with_mesh("w.stl", 2, None), STL).unwrap();
    assert!(
        open.warnings.len() == 1
            && open.warnings[0].contains("is not closed (4 edges")
            && open.warnings[0].contains("covers 83.3 %"),
        "{:?}",
        open.warnings
    );
    // With a corner pushed in to the middle, the mesh has 1 - (1/12 of three sides, moved from 2/3 of the height...) less than its hull.
    let dented = with_stl(&with_mesh("w.stl", 0, Some(Point3::new(-0.5, -0.5, -0.5))), STL).unwrap();
    assert!(dented.warnings.len() == 1 && dented.warnings[0].contains("is not convex"), "{:?}", dented.warnings);
    assert!(workspace(&dented).mesh_share() < 0.99);
    // Flat and empty meshes are refused.
    let flat = with_stl(&with_mesh("w.stl", 10, None), STL).unwrap_err();
    assert!(flat.contains("r.toml:6:17: limb 1: workspace_stl: ") && flat.contains("enclose no volume"), "{flat}");
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("w.stl"), "solid nothing\nendsolid nothing\n").unwrap();
    assert!(with_stl(&folder, STL).unwrap_err().contains("w.stl"));
}

#[test]
fn a_trunk_box_is_that_around_its_mesh() {
    let folder = with_mesh("t.stl", 0, None);
    let file = with_stl(&folder, &format!("[[trunk]]\nstl = \"t.stl\"\n{LIMB}")).unwrap();
    let part = file.robot.trunk()[0];
    assert_eq!((part.centre_m, part.half_m), (Point3::origin(), Vector3::repeat(1.0)));
    let flat = with_stl(&with_mesh("t.stl", 10, None), &format!("[[trunk]]\nstl = \"t.stl\"\n{LIMB}")).unwrap_err();
    assert!(flat.contains("trunk box 1: stl: ") && flat.contains("is flat"), "{flat}");
}

/// The characters and robots of other projects: their workspaces are closed or nearly convex, as their reference says.
#[test]
fn workspaces_of_real_robots_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/limbs");
    if !folder.exists() {
        eprintln!("skipped: {} is absent", folder.display());
        return;
    }
    let (mut read, mut convex) = (0, 0);
    for group in
        ["characters/frog", "characters/armless_skeleton", "characters/skeleton", "robots/solo12", "robots/hyq", "robots/anymal_b"]
    {
        for entry in fs::read_dir(folder.join(group)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().to_lowercase();
            if !name.contains("rom") || Path::new(&name).extension().is_none_or(|end| end != "stl") {
                continue;
            }
            let text = LIMB
                .replace("shell = { radius_max_m = 0.3, half_angle_deg = 45 }", &format!("workspace_stl = '{}'", path.display()));
            let file = of(&text).unwrap_or_else(|error| panic!("{error}"));
            let Workspace::Convex(hull) = &file.robot.limbs()[0].workspace else { panic!("no hull") };
            assert!(hull.open_edges() == 0, "{name}: {:?}", file.warnings);
            assert!((0.9..1.001).contains(&hull.mesh_share()), "{name}: {}", hull.mesh_share());
            read += 1;
            convex += usize::from(file.warnings.is_empty());
        }
    }
    assert!(read >= 20 && convex * 10 >= read * 7, "{convex} of {read} are convex");
}

#[test]
fn the_schema_accepts_what_the_reader_accepts() {
    let validator = jsonschema::validator_for(&robot_schema()).unwrap();
    let json = |text: &str| serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap();
    for file in shipped() {
        let text = fs::read_to_string(&file).unwrap();
        assert!(validator.is_valid(&json(&text)), "{}", file.display());
    }
    for text in [LIMB.to_owned(), STL.to_owned(), format!("[[trunk]]\nstl = \"t.stl\"\n{LIMB}")] {
        assert!(validator.is_valid(&json(&text)), "{text}");
    }
    for text in [
        String::new(),
        LIMB.replace("name", "nam"),
        LIMB.replace("radius_max_m = 0.3, ", ""),
        format!("{LIMB}workspace_stl = \"a.stl\"\n"),
        format!("{LIMB}friction_coefficient = 0\n"),
        format!("[robot]\nmass_kg = -1\n{LIMB}"),
        format!("[[trunk]]\nyaw_deg = 3\n{LIMB}"),
    ] {
        assert!(of(&text).is_err() && !validator.is_valid(&json(&text)), "{text}");
    }
}

#[test]
fn the_table_of_keys_is_current() {
    const BEGIN: &str = "<!-- keys of a robot file: written by `CHTA_UPDATE_DOCS=1 cargo test --test library robot_file` -->\n";
    const END: &str = "<!-- end of keys -->";
    let mut table = "| key | value | meaning |\n|---|---|---|\n".to_owned();
    for key in &ROBOT_KEYS {
        writeln!(table, "| `{}.{}` | {} | {} |", key.table, key.name, key.kind.expected(), key.help).unwrap();
    }
    let documentation = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/legs.md");
    let text = fs::read_to_string(&documentation).unwrap();
    let (before, rest) = text.split_once(BEGIN).unwrap();
    let (old, after) = rest.split_once(END).unwrap();
    if std::env::var_os("CHTA_UPDATE_DOCS").is_some() {
        fs::write(&documentation, format!("{before}{BEGIN}{table}{END}{after}")).unwrap();
    } else {
        assert_eq!(old, table, "docs/legs.md is out of date: run with CHTA_UPDATE_DOCS=1");
    }
}
