//! Free routes over the meshes of the paper on ballistic planning, with its frictions and speeds: each is found, and each hop of it is one.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test that cannot prepare its scenario stops, and one without its meshes says so"
)]

use std::path::Path;

use chta::{
    planner::Amount,
    scenario::{Entries, Scenario},
    study::{MeshRouteQuestion, MeshRouted, mesh_route},
};

/// A scene: its file, its bounds, its ends, its frictions with their speeds, and contacts enough for the harder of them.
struct Scene {
    file: &'static str,
    bounds: &'static str,
    start: &'static str,
    goal: &'static str,
    rows: &'static [(f64, f64, usize)],
}

const SCENES: [Scene; 3] = [
    Scene {
        file: "scene_jump10.stl",
        bounds: "[[-6, -2.5, 0], [6.8, 3.2, 8]]",
        start: "[6.2, 0.5, 0.5]",
        goal: "[-4.4, -1.5, 6.5]",
        rows: &[(1.2, 7.0, 256), (1.2, 6.5, 512)],
    },
    Scene {
        file: "cave_mono_short_1.stl",
        bounds: "[[-2.6, -3, -2.5], [2.6, 4.2, 4]]",
        start: "[-0.3, 3.65, -0.25]",
        goal: "[-0.18, -2.2, -0.4]",
        rows: &[(1.2, 4.5, 200), (0.5, 4.5, 512)],
    },
    Scene {
        file: "envir3d_1.stl",
        bounds: "[[-5, -5, -1], [5, 5, 7]]",
        start: "[-3.8, 2.4, 1.2]",
        goal: "[3.5, -3.3, 0.4]",
        rows: &[(1.2, 6.8, 128), (0.5, 5.3, 400)],
    },
];

fn planned(scene: &Scene, (friction, speed_m_s, contacts): (f64, f64, usize)) -> MeshRouted {
    let text = format!(
        "[body]\ngravity_m_s2 = 9.81\n[hopper]\ntakeoff_speed_max_m_s = {speed_m_s}\nlanding_speed_max_m_s = {speed_m_s}\n[surface]\n\
         friction_coefficient = {friction}\nrest_slope_max_deg = inf\n[terrain]\nmesh = \"{}\"\nroute = \"free\"\nstart_m = {}\ngoal_m = {}\n\
         [search]\nobjective = [\"hops\", \"arc-length\"]\ncontacts_max = {contacts}\nbounds_m = {}\n",
        scene.file, scene.start, scene.goal, scene.bounds
    );
    let scenario = Scenario::new(Entries::from_toml(&text)).unwrap();
    let question = MeshRouteQuestion { scenario: &scenario, base: Path::new("../shared/mesh"), front: None, roadmap: None };
    mesh_route(&question, &()).unwrap()
}

#[test]
fn the_scenes_of_the_paper_are_planned() {
    for scene in &SCENES {
        if !Path::new("../shared/mesh").join(scene.file).exists() {
            eprintln!("skipped: ../shared/mesh/{} is absent", scene.file);
            continue;
        }
        for row in scene.rows {
            let routed = planned(scene, *row);
            let path = routed.path.as_ref().unwrap_or_else(|| panic!("{} {row:?}: {:?}", scene.file, routed.answer.gap));
            let (answer, ground) = (&routed.answer, &routed.ground);
            assert!(answer.is_traversable() && answer.hops_lower_bound.unwrap() <= answer.hops.unwrap());
            let amounts = path.amounts();
            let totals = routed.grown.route.path.as_ref().unwrap().totals;
            for amount in [Amount::Hops, Amount::ArcLength, Amount::Energy, Amount::FlightTime, Amount::Distance] {
                let (flown, searched) = (amounts.of(amount), totals.of(amount));
                assert!((flown - searched).abs() <= 1e-9 * searched, "{amount}: {flown} flown, {searched} searched");
            }
            assert!(amounts.of(Amount::ArcLength) >= answer.straight_line_m);
            for (at, hop) in path.hops.iter().enumerate() {
                let contacts = [hop.takeoff, hop.landing].map(|end| ground.contact(end.point_m).unwrap());
                let set = ground.takeoff_set(&contacts[0], &contacts[1]).unwrap();
                let angle = hop.takeoff_angle.degrees();
                let inside = set
                    .windows()
                    .iter()
                    .filter_map(|window| set.angles_of(window.lofts))
                    .any(|angles| angles.min.degrees() - 1e-6 <= angle && angle <= angles.max.degrees() + 1e-6);
                assert!(inside, "{} {row:?}, hop {}: {angle} deg", scene.file, at + 1);
                for (row, margin) in hop.margins.rows() {
                    assert!(margin.is_none_or(|margin| margin > -1e-6), "hop {}: {} {margin:?}", at + 1, row.key);
                }
            }
            let ends = [path.hops[0].takeoff.point_m, path.hops[path.hops.len() - 1].landing.point_m];
            let expected = [&answer.start, &answer.goal].map(|end| nalgebra::Point3::from(end.point_m));
            assert_eq!(ends, expected);
        }
    }
}
