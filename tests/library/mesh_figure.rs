//! Pictures of paths over meshes.

#![allow(clippy::unwrap_used, reason = "a picture that cannot be drawn should stop the test")]

use chta::{
    ballistics::TakeoffChoice,
    figure::{Caption, MeshRouteFigure, MeshRouteLine, SeenFrom, draw_mesh_route},
    path::HopPath,
    world::HopperLimits,
};
use nalgebra::{Point3, Rotation3, Vector3};

use super::{
    mesh_verified::hop,
    mesh_windows::{Shape, ground, surface},
};

/// A block between start and goal, seen from the south and from above: what is behind it is dashed, and every hop has its row.
#[test]
fn a_path_behind_a_block_is_dashed_and_its_hops_are_listed() {
    let mut shape = Shape::default();
    shape.polygon(&[[-5.0, -5.0, 0.0], [15.0, -5.0, 0.0], [15.0, 5.0, 0.0], [-5.0, 5.0, 0.0]]);
    shape.cuboid(Point3::new(5.0, -1.5, 2.0), Vector3::new(1.5, 0.5, 2.0), Rotation3::identity());
    let ground = ground(shape.mesh(), HopperLimits::with_speeds(12.0, 12.0), 9.81, &surface(2.0));
    let contacts = [0.0, 4.0, 10.0].map(|x| ground.contact(Point3::new(x, 0.5, 0.0)).unwrap());
    let mut hops: Vec<chta::path::Hop> = Vec::new();
    for pair in contacts.windows(2) {
        let set = ground.takeoff_set(&pair[0], &pair[1]).unwrap();
        let (window, arc) = set.arc(TakeoffChoice::LeastSpeed, 9.81).unwrap();
        hops.push(hop(&ground, [&pair[0], &pair[1]], &window, &arc, hops.last().map_or(0.0, |hop| hop.landing.along_m)));
    }
    let path = HopPath::of_hops(hops, ground.envelope().hopper());
    let single = HopPath::of_hops(path.hops[..1].to_vec(), ground.envelope().hopper());
    let line = |name| MeshRouteLine { name, path: &path, gravity_m_s2: 9.81 };
    let mut figure = MeshRouteFigure {
        caption: Caption::new("A block", "two hops behind it"),
        mesh: ground.tree().mesh(),
        seen_from: SeenFrom { azimuth_deg: 180.0, elevation_deg: 20.0 },
        cut_z_m: None,
        start: contacts[0].point_m(),
        goal: contacts[2].point_m(),
        routes: vec![line("")],
        walks: Vec::new(),
        nearest: None,
    };
    let lines = |svg: &str| svg.matches("<polyline").count();
    let picture = draw_mesh_route(&figure).unwrap();
    let hidden = picture.to_svg().unwrap();
    for text in [
        "A block",
        "start",
        "goal",
        "behind a facet",
        "contour lines every",
        "seen from azimuth 180 deg",
        "heading",
        "apex z",
        "path, 2 hops",
    ] {
        assert!(hidden.contains(text), "{text}");
    }
    // Two rasters; the landings of both hops as numbers of the table.
    assert_eq!(hidden.matches("<image").count(), 2);
    assert!(hidden.contains("4.00") && hidden.contains("10.00"));
    assert_eq!(picture.to_png().unwrap()[..8], [0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a]);
    // From the north nothing is in the way: no dashes.
    figure.seen_from.azimuth_deg = 0.0;
    let free = draw_mesh_route(&figure).unwrap().to_svg().unwrap();
    assert!(lines(&hidden) > lines(&free) + 3, "{} {}", lines(&hidden), lines(&free));
    assert!(!free.contains("behind a facet"), "what is not drawn has no words");
    figure.routes = vec![MeshRouteLine { path: &single, ..line("") }];
    let one = draw_mesh_route(&figure).unwrap().to_svg().unwrap();
    assert!(one.contains("path, 1 hop") && !one.contains("path, 1 hops"));
    // Two paths have their names; without one the goal is not reached.
    figure.routes = vec![line("strong"), line("weak")];
    let both = draw_mesh_route(&figure).unwrap().to_svg().unwrap();
    assert!(both.contains("strong, 2 hops") && both.contains("Hops of weak"));
    figure.routes.clear();
    figure.nearest = Some(contacts[1].point_m());
    let none = draw_mesh_route(&figure).unwrap().to_svg().unwrap();
    assert!(none.contains("goal, not reached") && none.contains("reached contact nearest to the goal") && !none.contains("apex z"));
    // Start and goal at one place, and far from the mesh.
    figure.goal = figure.start;
    figure.nearest = None;
    assert!(draw_mesh_route(&figure).is_ok());
    [figure.start, figure.goal] = [Point3::new(1e3, 1e3, 0.0), Point3::new(1e3, 1.001e3, 0.0)];
    assert!(draw_mesh_route(&figure).is_err());
}
