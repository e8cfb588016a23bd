//! Balls over meshes: no accepted arc comes nearer than the radius, arcs farther away than the stated bound are never refused, and a ball
//! without size is a point.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test that cannot build its mesh should stop, and says what it compared"
)]

use std::path::Path;

use chta::{
    ballistics::{
        LineOfSight,
        limits::{BALL_BOUND, ClearanceProfile, blocked_lofts_of_ball},
    },
    ground::{BALL_STAND_OFF, MeshBuffers, MeshContact, MeshGround, NoMeshContact},
    quantity::ChainPoint,
    terrain::{MeshTree, read_mesh},
    world::{Gravity, Hopper, HopperLimits},
};
use nalgebra::{Point3, Rotation3, Vector3};

use super::mesh_windows::{Shape, contact, ground, limits_but_terrain, on_a_floor, scene, surface};
use crate::support::Draw;

fn ball(radius_m: f64, speed_m_s: f64) -> HopperLimits {
    HopperLimits { radius_m: Some(radius_m), ..HopperLimits::with_speeds(speed_m_s, speed_m_s) }
}

/// The least distance of the centre to the mesh along an arc, in steps of at most a length.
fn least_distance_m(
    ground: &MeshGround,
    from: &MeshContact,
    sight: LineOfSight,
    heading: nalgebra::Vector2<f64>,
    loft: f64,
    step_m: f64,
) -> f64 {
    let start = from.point_m();
    let (run_m, mut least, mut d_m) = (sight.run_m(), f64::INFINITY, 0.0);
    while d_m <= run_m {
        let z_m = d_m * (sight.slope() + loft * (1.0 - d_m / run_m));
        let at = start + Vector3::new(heading.x * d_m, heading.y * d_m, z_m);
        least = ground.tree().nearest(at).distance_m.min(least);
        let slope = sight.slope() + loft * (1.0 - 2.0 * d_m / run_m);
        d_m += step_m / (1.0 + slope * slope).sqrt();
    }
    least
}

/// In the plane: every arc nearer to an obstacle than the radius is blocked, and none farther away than the octagon's corners.
#[test]
fn a_ball_is_blocked_within_its_radius_and_not_beyond_the_octagon() {
    let draw = &mut Draw::seeded(1810);
    let (mut near, mut far, mut between) = (0, 0, 0);
    for _ in 0..3_000 {
        let sight = LineOfSight::new(draw.uniform(1.0, 10.0), draw.uniform(-5.0, 5.0));
        let radius_m = draw.log_uniform(0.01, 1.0);
        let count = 1 + draw.below(3);
        let corners: Vec<ChainPoint> =
            (0..count).map(|_| ChainPoint::new(draw.uniform(-0.2, 1.2) * sight.run_m(), draw.uniform(-4.0, 6.0))).collect();
        let blocked = blocked_lofts_of_ball(sight, &corners, radius_m, ClearanceProfile::NONE);
        let loft = draw.log_uniform(0.01, 20.0);
        let steps = 2_000;
        let mut least_m = f64::INFINITY;
        for i in 1..steps {
            let d_m = sight.run_m() * f64::from(i) / f64::from(steps);
            let z_m = d_m * (sight.slope() + loft * (1.0 - d_m / sight.run_m()));
            for i in 0..count {
                let (a, b) = (corners[i], corners[(i + 1) % count]);
                let (along, away) = ((b.x_m - a.x_m, b.z_m - a.z_m), (d_m - a.x_m, z_m - a.z_m));
                let length = along.0 * along.0 + along.1 * along.1;
                let share = if length > 0.0 { ((away.0 * along.0 + away.1 * along.1) / length).clamp(0.0, 1.0) } else { 0.0 };
                let apart = (away.0 - share * along.0, away.1 - share * along.1);
                least_m = least_m.min((apart.0 * apart.0 + apart.1 * apart.1).sqrt());
            }
        }
        let inside = blocked.lower < loft && loft < blocked.upper;
        // The border of a triangle is met by whatever is inside it; between two points of the arc it may come a little nearer.
        let step_m = sight.run_m() / f64::from(steps) * (1.0 + (sight.slope().abs() + loft).powi(2)).sqrt();
        if least_m < radius_m {
            near += 1;
            assert!(inside, "{sight:?} {corners:?} {radius_m} {loft} {blocked:?} {least_m}");
        } else if least_m > 1.0824 * radius_m + step_m && count < 3 {
            far += 1;
            assert!(!inside, "{sight:?} {corners:?} {radius_m} {loft} {blocked:?} {least_m}");
        } else {
            between += 1;
        }
    }
    eprintln!("{near} nearer, {far} farther away, {between} between");
    assert!(near > 300 && far > 300);
}

/// On random scenes: no accepted arc comes nearer than the radius, and none is refused that stays beyond the bound.
#[test]
fn balls_keep_their_radius_and_the_bound_is_kept() {
    let draw = &mut Draw::seeded(1811);
    let (mut accepted, mut refused, mut lost, mut without_room) = (0, 0, 0, 0);
    for _ in 0..60 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.uniform(0.8, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
        let radius_m = draw.log_uniform(0.03, 0.3);
        let ground = ground(scene(draw).mesh(), ball(radius_m, speed_m_s), gravity_m_s2, &surface(draw.uniform(0.5, 3.0)));
        let mut buffers = MeshBuffers::default();
        for _ in 0..16 {
            let (Some(from), Some(to)) = (contact(&ground, draw), contact(&ground, draw)) else {
                without_room += 1;
                continue;
            };
            let Some(set) = ground.takeoff_set(&from, &to) else { continue };
            let (sight, windows) = ground.windows(&from, &to, &mut buffers).unwrap();
            let slow: Vec<_> = set.windows().iter().map(|window| window.lofts).collect();
            assert_eq!(windows, slow.as_slice());
            let Ok((all, _)) = limits_but_terrain(&set) else { continue };
            let ends = slow.iter().flat_map(|lofts| [lofts.lower, lofts.upper.min(lofts.lower + 20.0)]);
            let drawn = (0..3).map(|_| draw.uniform(all[0], all[1].min(all[0] + 20.0)));
            for loft in ends.chain(drawn).collect::<Vec<_>>() {
                let step_m = 0.2 * radius_m;
                let least_m = least_distance_m(&ground, &from, sight, set.course().plane.heading, loft, step_m);
                if slow.iter().any(|lofts| lofts.contains(loft)) {
                    accepted += 1;
                    assert!(least_m > radius_m * (1.0 - 1e-6), "{loft} {least_m} {radius_m} {set:?}");
                } else {
                    refused += 1;
                    lost += u32::from(least_m > radius_m);
                    assert!(least_m < BALL_BOUND * radius_m + step_m, "{loft} {least_m} {radius_m} {set:?}");
                }
            }
        }
    }
    eprintln!("{accepted} accepted, {refused} refused, {lost} of them farther away than the radius; {without_room} without room");
    assert!(accepted > 200 && refused > 200 && lost < accepted / 4);
}

/// On the published scenes, in steps of 2 mm.
#[test]
fn balls_keep_their_radius_on_the_published_scenes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/mesh");
    if !folder.is_dir() {
        eprintln!("skipped: no meshes at {}", folder.display());
        return;
    }
    let draw = &mut Draw::seeded(1812);
    for (file, speed_m_s) in [("scene_jump10.stl", 7.0), ("cave_mono_short_1.stl", 4.5)] {
        let tree = MeshTree::new(read_mesh(&folder.join(file), 1.0).unwrap().mesh);
        let radius_m = 0.02;
        let grounds = [ball(radius_m, speed_m_s), HopperLimits::with_speeds(speed_m_s, speed_m_s)].map(|limits| {
            MeshGround::new(tree.clone(), &Hopper::new(limits).unwrap(), Gravity::new(9.81).unwrap(), &surface(1.2)).unwrap()
        });
        let bounds = tree.mesh().bounds();
        let (mut accepted, mut of_point, mut kept, mut buffers) = (0, 0, 0, MeshBuffers::default());
        for _ in 0..3_000 {
            let mut at = || {
                let share = |low: f64, high: f64, draw: &mut Draw| draw.uniform(low, high);
                Point3::new(
                    share(bounds.map.min.x, bounds.map.max.x, draw),
                    share(bounds.map.min.y, bounds.map.max.y, draw),
                    share(bounds.low_m, bounds.high_m, draw),
                )
            };
            let (from, to) = (at(), at());
            let (Ok(point_from), Ok(point_to)) = (grounds[1].contact(from), grounds[1].contact(to)) else { continue };
            let Some((_, windows)) = grounds[1].windows(&point_from, &point_to, &mut buffers) else { continue };
            if windows.is_empty() {
                continue;
            }
            of_point += 1;
            let (Ok(from), Ok(to)) = (grounds[0].contact(from), grounds[0].contact(to)) else { continue };
            let Some(course) = grounds[0].course(&from, &to) else { continue };
            let Some((sight, windows)) = grounds[0].windows(&from, &to, &mut buffers) else { continue };
            kept += u32::from(!windows.is_empty());
            for lofts in windows.iter().copied() {
                if accepted < 60 {
                    accepted += 1;
                    for loft in [lofts.lower, lofts.upper] {
                        let least_m = least_distance_m(&grounds[0], &from, sight, course.plane.heading, loft, 0.002);
                        assert!(least_m > radius_m * (1.0 - 1e-6), "{file} {loft} {least_m} {from:?} {to:?}");
                    }
                }
            }
        }
        eprintln!("{file}: {accepted} windows flown; of {of_point} pairs with windows of a point {kept} have one of the ball");
        assert!(accepted > 5 && kept > of_point / 4, "{accepted} {of_point} {kept}");
    }
}

/// A ball without size has the windows of a point.
#[test]
fn a_ball_without_size_is_a_point() {
    let draw = &mut Draw::seeded(1813);
    let mut compared = 0;
    for _ in 0..60 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.uniform(0.8, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
        let (mesh, grip) = (scene(draw).mesh(), surface(draw.uniform(0.5, 3.0)));
        let point = ground(mesh.clone(), HopperLimits::with_speeds(speed_m_s, speed_m_s), gravity_m_s2, &grip);
        let small = ground(mesh, ball(1e-8, speed_m_s), gravity_m_s2, &grip);
        for _ in 0..20 {
            let (Some(from), Some(to)) = (contact(&point, draw), contact(&point, draw)) else { continue };
            // Where facets meet at a hollow edge, a ball that is any larger touches what is added to them.
            if from.facets().len() > 1 || to.facets().len() > 1 {
                continue;
            }
            let [Ok(ball_from), Ok(ball_to)] = [&from, &to].map(|contact| small.contact(contact.point_m())) else { continue };
            let (Some(one), Some(other)) = (point.takeoff_set(&from, &to), small.takeoff_set(&ball_from, &ball_to)) else {
                continue;
            };
            let [one, other] = [one, other].map(|set| set.windows().iter().map(|window| window.lofts).collect::<Vec<_>>());
            if one.iter().chain(&other).any(|lofts| lofts.upper - lofts.lower < 1e-3 * (1.0 + lofts.upper)) {
                continue;
            }
            assert_eq!(one.len(), other.len(), "{one:?} {other:?} {from:?} {to:?}");
            for (one, other) in one.iter().zip(&other) {
                let apart = (one.lower - other.lower).abs().max((one.upper - other.upper).abs());
                assert!(apart < 1e-3 * (1.0 + one.upper), "{one:?} {other:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 50, "{compared}");
}

/// By hand: a ceiling, a corner without room, a thin plate between the contact and the centre.
#[test]
fn planted_balls() {
    let limits = ball(0.1, 1e3);
    let floor = on_a_floor(|shape: &mut Shape| {
        shape.polygon(&[[-5.0, -5.0, 3.0], [-5.0, 5.0, 3.0], [15.0, 5.0, 3.0], [15.0, -5.0, 3.0]]);
        shape.cuboid(Point3::new(12.0, 0.0, 1.0), Vector3::new(1.0, 1.0, 1.0), Rotation3::identity());
        shape.polygon(&[[1.0, 3.0, 0.05], [3.0, 3.0, 0.05], [3.0, 4.0, 0.05], [1.0, 4.0, 0.05]]);
    });
    let ground = ground(floor.mesh(), limits, 9.81, &surface(100.0));
    let [from, to] = [0.0, 10.0].map(|x| ground.contact(Point3::new(x, 0.3, 0.0)).unwrap());
    assert!((from.point_m().z - 0.1 * BALL_STAND_OFF).abs() < 1e-12);
    let set = ground.takeoff_set(&from, &to).unwrap();
    // The centre stays 0.1 m under a ceiling 3 m high: 0.15 + n 10 / 4 = 2.9.
    assert!(set.windows().len() == 1 && (set.windows()[0].lofts.upper - 1.1).abs() < 1e-9, "{:?}", set.windows());
    // At the foot of the box, 0.05 m away from its wall.
    let beside = ground.contact(Point3::new(10.95, 0.3, 0.0));
    assert!(matches!(beside, Err(NoMeshContact::NoRoom { facet, .. }) if facet.index() >= 4), "{beside:?}");
    // Under the plate.
    let under = ground.contact(Point3::new(2.0, 3.5, 0.0));
    assert!(matches!(under, Err(NoMeshContact::NoRoom { .. })), "{under:?}");
}
