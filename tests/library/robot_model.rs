//! URDFs of real robots: read as urdf-rs reads them, forward kinematics by a second road, inverse kinematics against points that forward kinematics gave.

#![allow(clippy::print_stderr, reason = "a skipped test says why")]
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use chta::{
    robot_model::{JointKind, LimbChain, RobotModel},
    scenario::{RobotFile, robot_of_toml},
};
use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};

use crate::support::Draw;

/// The URDFs of other projects, and a link of each that is a foot.
const FEET: [(&str, &str); 5] = [
    ("robots/solo12/solo12.urdf", "FL_FOOT"),
    ("robots/anymal_b/anymal.urdf", "RH_FOOT"),
    ("robots/anymal_c/anymal.urdf", "LF_FOOT"),
    ("robots/hyq/hyq_no_sensors.urdf", "rf_foot"),
    ("characters/frog/frog.urdf", ""),
];

fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/limbs");
    if !folder.exists() {
        eprintln!("skipped: {} is absent", folder.display());
        return None;
    }
    Some(folder)
}

fn urdfs(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            urdfs(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "urdf") {
            found.push(path);
        }
    }
}

/// The chains of the feet above; where none is named, that of the link with the most joints before it.
fn chains() -> Vec<(&'static str, LimbChain)> {
    let Some(folder) = shared() else { return Vec::new() };
    let chain = |(file, foot): (&'static str, &str)| {
        let model = RobotModel::from_urdf(&fs::read_to_string(folder.join(file)).unwrap())
            .unwrap_or_else(|error| panic!("{file}: {error}"));
        let foot_m = Point3::new(0.01, -0.02, -0.03);
        let of_link = |link: &str| model.limb(link, foot_m).ok();
        let longest = || model.links().iter().filter_map(|link| of_link(&link.name)).max_by_key(|chain| chain.joints().len());
        (file, if foot.is_empty() { longest() } else { of_link(foot) }.unwrap_or_else(|| panic!("{file}: no {foot}")))
    };
    FEET.map(chain).into()
}

#[test]
fn urdfs_are_read_as_urdf_rs_reads_them() {
    let Some(folder) = shared() else { return };
    let mut files = Vec::new();
    urdfs(&folder, &mut files);
    files.sort();
    let mut compared = 0;
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        let name = file.display();
        let (ours, theirs) = match (RobotModel::from_urdf(&text), urdf_rs::read_from_string(&text)) {
            (Ok(ours), Ok(theirs)) => (ours, theirs),
            (ours, theirs) => panic!("{name}: {:?}, urdf-rs {:?}", ours.err(), theirs.err()),
        };
        assert_eq!(
            (ours.name(), ours.links().len(), ours.joints().len()),
            (theirs.name.as_str(), theirs.links.len(), theirs.joints.len()),
            "{name}"
        );
        for (own, other) in ours.joints().iter().zip(&theirs.joints) {
            assert_eq!(
                (&own.name, &ours.links()[own.parent].name, &ours.links()[own.child].name),
                (&other.name, &other.parent.link, &other.child.link)
            );
            let kind = match other.joint_type {
                _ if other.mimic.is_some() => JointKind::Other,
                urdf_rs::JointType::Fixed => JointKind::Fixed,
                urdf_rs::JointType::Revolute => JointKind::Revolute,
                urdf_rs::JointType::Continuous => JointKind::Continuous,
                urdf_rs::JointType::Prismatic => JointKind::Prismatic,
                _ => JointKind::Other,
            };
            assert_eq!(own.kind, kind, "{name}: {}", own.name);
            assert_eq!(
                [own.lower, own.upper, own.effort, own.velocity],
                [other.limit.lower, other.limit.upper, other.limit.effort, other.limit.velocity]
            );
            assert_eq!(own.frame.origin_m, Vector3::from(other.origin.xyz.0), "{name}: {}", own.name);
            let [roll, pitch, yaw] = other.origin.rpy.0;
            let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw).to_rotation_matrix();
            assert!((own.frame.axes.matrix() - turn.matrix()).amax() < 1e-14, "{name}: {}", own.name);
            let axis = Vector3::from(other.axis.xyz.0);
            assert!((own.axis.into_inner() - axis.normalize()).norm() < 1e-15, "{name}: {}", own.name);
            compared += 1;
        }
        let mass: f64 = theirs.links.iter().map(|link| link.inertial.mass.value).sum();
        assert!((ours.mass_kg().unwrap_or(0.0) - mass).abs() <= 1e-12 * mass, "{name}");
        let boxes: usize = theirs
            .links
            .iter()
            .flat_map(|link| &link.collision)
            .filter(|part| !matches!(part.geometry, urdf_rs::Geometry::Mesh { .. }))
            .count();
        assert_eq!(ours.links().iter().map(|link| link.boxes.len()).sum::<usize>(), boxes, "{name}");
    }
    assert!(compared > 300, "{compared} joints");
}

/// Joints within their ranges, and within a turn.
fn drawn(draw: &mut Draw, chain: &LimbChain) -> Vec<f64> {
    chain.joints().iter().map(|joint| draw.uniform(joint.range[0].max(-3.1), joint.range[1].min(3.1))).collect()
}

#[test]
fn forward_kinematics_agrees_with_quaternions_along_the_tree_of_urdf_rs() {
    let Some(folder) = shared() else { return };
    let mut draw = Draw::seeded(31);
    for (file, chain) in chains() {
        let theirs = urdf_rs::read_file(folder.join(file)).unwrap();
        let foot = FEET.iter().find(|(known, _)| *known == file).unwrap().1;
        if foot.is_empty() {
            continue;
        }
        let foot_m = Point3::new(0.01, -0.02, -0.03);
        for _ in 0..50 {
            let positions = drawn(&mut draw, &chain);
            // From the foot up to the root.
            let (mut link, mut pose) = (foot.to_owned(), Isometry3::identity());
            while let Some(joint) = theirs.joints.iter().find(|joint| joint.child.link == link) {
                let position =
                    chain.joints().iter().position(|known| known.name == joint.name).map_or(0.0, |index| positions[index]);
                let axis = Unit::new_normalize(Vector3::from(joint.axis.xyz.0));
                let [roll, pitch, yaw] = joint.origin.rpy.0;
                let origin = Isometry3::from_parts(
                    Translation3::from(Vector3::from(joint.origin.xyz.0)),
                    UnitQuaternion::from_euler_angles(roll, pitch, yaw),
                );
                pose = origin * UnitQuaternion::from_axis_angle(&axis, position) * pose;
                link.clone_from(&joint.parent.link);
            }
            let gap = (chain.foot(&positions) - pose * foot_m).norm();
            assert!(gap < 1e-13, "{file}: {gap}");
        }
    }
}

#[test]
fn jacobians_torques_and_rates_agree_with_differences() {
    let mut draw = Draw::seeded(32);
    for (file, chain) in chains() {
        for _ in 0..50 {
            let positions = drawn(&mut draw, &chain);
            let (foot, columns) = chain.jacobian(&positions);
            assert!((foot - chain.foot(&positions)).norm() < 1e-14);
            let force = Vector3::new(draw.uniform(-9.0, 9.0), draw.uniform(-9.0, 9.0), draw.uniform(-9.0, 9.0));
            let efforts = chain.efforts(&positions, &force);
            for (index, column) in columns.iter().enumerate() {
                const STEP: f64 = 1e-6;
                let moved = |step: f64| {
                    let mut positions = positions.clone();
                    positions[index] += step;
                    chain.foot(&positions)
                };
                let difference = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
                assert!((column - difference).norm() < 1e-8, "{file}: {column} {difference}");
                // Virtual work: the joint gives what the ground's force takes.
                assert!((efforts[index] + difference.dot(&force)).abs() < 1e-6, "{file}");
            }
            let share = efforts
                .iter()
                .zip(chain.joints())
                .map(|(effort, joint)| effort.abs() / joint.effort_max.unwrap_or(f64::INFINITY))
                .fold(0.0, f64::max);
            assert_eq!(chain.effort_share(&positions, &force), share);
            // Rates of least squares move the foot as asked, unless the leg is stretched or folded.
            let least = columns
                .iter()
                .map(|column| column * column.transpose())
                .sum::<nalgebra::Matrix3<f64>>()
                .symmetric_eigenvalues()
                .min();
            let velocity = Vector3::new(0.3, -0.2, 0.5);
            let rates = chain.rates(&positions, &velocity);
            let moves: Vector3<f64> = columns.iter().zip(&rates).map(|(column, rate)| column * *rate).sum();
            assert!(least < 1e-4 || (moves - velocity).norm() < 1e-6, "{file}: {moves}");
            assert!(chain.rate_share(&positions, &velocity) >= 0.0);
        }
    }
}

#[test]
fn inverse_kinematics_reaches_every_point_that_forward_kinematics_made() {
    let mut draw = Draw::seeded(33);
    for (file, chain) in chains() {
        let mut missed = 0;
        for _ in 0..300 {
            let target = chain.foot(&drawn(&mut draw, &chain));
            let verdict = chain.reach(&target);
            // What it claims is so.
            let foot = chain.foot(&verdict.positions);
            assert!(((foot - target).norm() - verdict.error_m).abs() < 1e-12);
            assert_eq!(verdict.reached, verdict.error_m <= 1e-3 * chain.length_m());
            for (joint, at) in chain.joints().iter().zip(&verdict.positions) {
                assert!(joint.range[0] <= *at && *at <= joint.range[1], "{file}: {} at {at}", joint.name);
            }
            assert!((0.0..=1.0 + 1e-12).contains(&verdict.travel_share));
            missed += usize::from(!verdict.reached);
        }
        assert_eq!(missed, 0, "{file}: {missed} of 300 planted points were not found");
    }
}

/// Targets around the limb: what is reached is within its length, and beyond the stretched limb nothing is claimed.
#[test]
fn inverse_kinematics_claims_no_point_beyond_the_stretched_limb() {
    let mut draw = Draw::seeded(34);
    for (file, chain) in chains().into_iter().filter(|(_, chain)| chain.joints().len() == 3) {
        let (mut reached, mut beyond) = (0, 0);
        for _ in 0..60 {
            let offset =
                Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)) * (0.9 * chain.length_m());
            let verdict = chain.reach(&(chain.hip_m() + offset));
            assert!(verdict.error_m >= offset.norm() - chain.length_m() - 1e-9, "{file}: nearer than it is long");
            if offset.norm() > chain.length_m() * 1.001 {
                assert!(!verdict.reached, "{file}: beyond its length");
                beyond += 1;
            }
            reached += usize::from(verdict.reached);
        }
        assert!(reached >= 1 && beyond >= 3, "{file}: {reached} reached, {beyond} beyond");
    }
}

#[test]
fn a_robot_file_takes_joints_trunk_and_mass_from_its_urdf() {
    let Some(folder) = shared() else { return };
    let text = |urdf: &str, link: &str, hip: &str| {
        format!(
            "[robot]\nurdf = \"{urdf}\"\n[[limb]]\nname = \"leg\"\nhip_m = {hip}\nshell = {{ radius_max_m = 0.32, half_angle_deg = 60 }}\nurdf_link = \"{link}\"\n"
        )
    };
    let read = |text: &str| robot_of_toml("r.toml", text, &folder, "r").map_err(|problems| problems.to_string());
    let RobotFile { robot, chains, warnings, .. } = read(&text("robots/solo12/solo12.urdf", "FL_FOOT", "[0.19, 0.1, 0]")).unwrap();
    let chain = chains[0].as_ref().unwrap();
    assert_eq!(chain.joints().iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["FL_HAA", "FL_HFE", "FL_KFE"]);
    assert_eq!(chain.hip_m(), Point3::new(0.1946, 0.0875, 0.0));
    // By hand: straight down, upper and lower leg of 0.16 m, aside by the hip's offsets.
    assert!((chain.foot(&[0.0; 3]) - Point3::new(0.1946, 0.0875 + 0.014 + 0.03745 + 0.008, -0.32)).norm() < 1e-15);
    assert!((robot.mass_kg().unwrap() - 2.5).abs() < 0.1, "{:?}", robot.mass_kg());
    // Its trunk is a mesh, which is said.
    assert!(warnings.len() == 1 && warnings[0].contains("are meshes"), "{warnings:?}");
    let anymal = read(&text("robots/anymal_b/anymal.urdf", "LF_FOOT", "[0.28, 0.12, 0]")).unwrap();
    assert!(!anymal.robot.trunk().is_empty());
    let far = read(&text("robots/solo12/solo12.urdf", "FL_FOOT", "[-0.19, -0.1, 0]")).unwrap();
    assert!(far.warnings.iter().any(|warning| warning.contains("are two limbs exchanged?")), "{:?}", far.warnings);
    for (wrong, part) in [
        (text("robots/solo12/solo12.urdf", "FL_FOOD", "[0, 0, 0]"), "r.toml:7:13: limb 1: urdf_link: there is no link 'FL_FOOD'"),
        (text("robots/solo12/solo12.urdf", "base_link", "[0, 0, 0]"), "no joint moves link 'base_link'"),
        (text("robots/solo12/solo_trunk.stl", "x", "[0, 0, 0]"), "r.toml:2:8: robot.urdf: "),
        (text("README.md", "x", "[0, 0, 0]"), "this is not XML"),
        (
            text("robots/solo12/solo12.urdf", "FL_FOOT", "[0, 0, 0]")
                .replace("[robot]\nurdf = \"robots/solo12/solo12.urdf\"\n", ""),
            "is given without robot.urdf",
        ),
        (
            text("robots/solo12/solo12.urdf", "FL_FOOT", "[0, 0, 0]").replace("urdf_link = \"FL_FOOT\"", "urdf_foot_m = [0, 0, 0]"),
            "is given without urdf_link",
        ),
    ] {
        let error = read(&wrong).unwrap_err();
        assert!(error.contains(part), "{error}\n  expected {part}");
    }
}
