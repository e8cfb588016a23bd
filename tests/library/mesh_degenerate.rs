//! Hops over meshes where something touches, coincides or vanishes, and what does not change the windows of any hop.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its mesh should stop")]

use chta::{
    ground::{MeshContact, MeshGround, MeshTakeoffSet},
    quantity::SlopeInterval,
    world::{Contact, FrictionCone, HopperLimits, Limit, PreparedCone},
};
use nalgebra::{Point3, Rotation3, Vector2, Vector3};

use super::mesh_windows::{Shape, across, contact, ends, ground, on_a_floor, scene, surface};
use crate::support::Draw;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9 * (1.0 + b.abs())
}

/// A plate over the middle of the way, from one distance and height to another.
fn plate(shape: &mut Shape, [from, to]: [[f64; 2]; 2]) {
    shape.polygon(&[[from[0], -5.0, from[1]], [to[0], -5.0, to[1]], [to[0], 5.0, to[1]], [from[0], 5.0, from[1]]]);
}

/// The set from a point to another with friction 1 and speeds that leave nearly everything.
fn between(ground: &MeshGround, from: [f64; 3], to: [f64; 3]) -> Option<MeshTakeoffSet> {
    let [from, to] = [from, to].map(|at| ground.contact(Point3::from(at)).unwrap());
    ground.takeoff_set(&from, &to)
}

/// A plane that touches the cone holds one ray at most; the vertical in the cone, and a cone straight down, have their infinite ends.
#[test]
fn cones_that_touch_hold_the_vertical_or_point_down() {
    let cone = PreparedCone::new(FrictionCone::new(1.0).unwrap());
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let touched = cone.slopes(Vector3::new(0.5, half, 0.5), Vector2::x());
    assert!(touched.is_empty() || touched.upper - touched.lower < 1e-6, "{touched:?}");
    let floor = on_a_floor(|shape| {
        shape.polygon(&[[-5.0, -5.0, 3.0], [-5.0, 5.0, 3.0], [15.0, 5.0, 3.0], [15.0, -5.0, 3.0]]);
    });
    let ground = ground(floor.mesh(), HopperLimits::with_speeds(1e3, 1e3), 9.81, &surface(1.0));
    let [low, high] = [0.0, 3.0].map(|z| ground.contact(Point3::new(0.0, 0.3, z)).unwrap());
    let slopes = |contact: &MeshContact, kind| ground.allowed(contact, Vector2::x(), kind).unwrap().slopes;
    let near = |found: SlopeInterval, lower: f64, upper: f64| {
        assert!(
            (found.lower == lower || close(found.lower, lower)) && (found.upper == upper || close(found.upper, upper)),
            "{found:?}"
        );
    };
    near(slopes(&low, Contact::Takeoff), 1.0, f64::INFINITY);
    near(slopes(&low, Contact::Landing), f64::NEG_INFINITY, -1.0);
    near(slopes(&high, Contact::Takeoff), f64::NEG_INFINITY, -1.0);
    near(slopes(&high, Contact::Landing), 1.0, f64::INFINITY);
    // From the ceiling down to the floor, and straight up, which has no plane.
    assert!(!between(&ground, [0.0, 0.3, 3.0], [1.0, 0.3, 0.0]).unwrap().windows().is_empty());
    assert!(between(&ground, [2.0, 0.3, 0.0], [2.0, 0.3, 3.0]).is_none());
}

/// Closed forms at their borders, over 10 m: an arc of loft n is n d e / 10 high.
#[test]
fn obstacles_at_the_borders_of_the_closed_form() {
    // A line through the take-off, A = 0 and B = 5, from d = 2 to 8: n = B / e from 5 / 8 to 5 / 2. And its mirror image, B = 0.
    for line in [[[2.0, 1.0], [8.0, 4.0]], [[2.0, 4.0], [8.0, 1.0]]] {
        let found = ends(&across(on_a_floor(|shape| plate(shape, line)), 0.0));
        assert!(found.len() == 2 && close(found[0][1], 0.625) && close(found[1][0], 2.5), "{found:?}");
    }
    // The least loft of a roof from A = 1 to B = 4 lies at d = 10 / 3, here its very end: (1 + 2)^2 / 10.
    for line in [[[10.0 / 3.0, 2.0], [10.0, 4.0]], [[0.0, 1.0], [10.0 / 3.0, 2.0]]] {
        let found = ends(&across(on_a_floor(|shape| plate(shape, line)), 0.0));
        assert!(close(found[0][1], 0.9), "{found:?}");
    }
    // A ceiling that the arc of loft 1 touches in its middle.
    let found = ends(&across(on_a_floor(|shape| plate(shape, [[-5.0, 2.5], [15.0, 2.5]])), 0.0));
    assert!(found.len() == 1 && close(found[0][1], 1.0), "{found:?}");
    // A second floor in the same place: a segment through both ends.
    let bare = ends(&across(on_a_floor(|_| ()), 0.0));
    assert_eq!(ends(&across(on_a_floor(|shape| plate(shape, [[-5.0, 0.0], [15.0, 0.0]])), 0.0)), bare);
    // A plate with a free border all around: over and under it.
    let found = ends(&across(on_a_floor(|shape| plate(shape, [[4.0, 1.0], [6.0, 1.0]])), 0.0));
    assert!(found.len() == 2 && close(found[0][1], 0.4) && close(found[1][0], 10.0 / 24.0), "{found:?}");
}

/// The plane of the hop (y = 0.3) along an edge, through a corner, and along a wall.
#[test]
fn obstacles_that_touch_the_plane_of_the_hop_block() {
    let expected = |found: Vec<[f64; 2]>, under: f64, over: f64| {
        assert!(found.len() == 2 && close(found[0][1], under) && close(found[1][0], over), "{found:?}");
    };
    // A box from 2 to 3 m high, d from 4 to 6, that ends in the plane, on either side of it.
    for side in [1.0, -1.0] {
        let shape = on_a_floor(|shape| {
            shape.cuboid(Point3::new(5.0, 0.3 + side, 2.5), Vector3::new(1.0, 1.0, 0.5), Rotation3::identity());
        });
        expected(ends(&across(shape, 0.0)), 0.8, 1.25);
    }
    // A triangle with one edge in the plane, one with one corner in it, and a whole one in it.
    let edge = on_a_floor(|shape| shape.polygon(&[[4.0, 0.3, 1.0], [6.0, 0.3, 1.0], [5.0, 3.0, 1.0]]));
    expected(ends(&across(edge, 0.0)), 0.4, 10.0 / 24.0);
    let corner = on_a_floor(|shape| shape.polygon(&[[5.0, 0.3, 1.0], [6.0, 3.0, 1.0], [4.0, 3.0, 1.0]]));
    expected(ends(&across(corner, 0.0)), 0.4, 0.4);
    let wall = on_a_floor(|shape| shape.polygon(&[[4.0, 0.3, 1.0], [6.0, 0.3, 1.0], [5.0, 0.3, 2.0]]));
    expected(ends(&across(wall, 0.0)), 0.4, 0.8);
}

/// Off a wall, with friction that holds it.
#[test]
fn a_hop_begins_on_a_wall_and_ends_on_one() {
    let room = on_a_floor(|shape| {
        shape.polygon(&[[0.0, -5.0, 0.0], [0.0, 5.0, 0.0], [0.0, 5.0, 4.0], [0.0, -5.0, 4.0]]);
        shape.polygon(&[[9.0, 5.0, 0.0], [9.0, -5.0, 0.0], [9.0, -5.0, 4.0], [9.0, 5.0, 4.0]]);
    });
    let ground = ground(room.mesh(), HopperLimits::with_speeds(50.0, 50.0), 9.81, &surface(1.0));
    let wall = ground.contact(Point3::new(0.0, 0.3, 2.0)).unwrap();
    let slopes = ground.allowed(&wall, Vector2::x(), Contact::Takeoff).unwrap().slopes;
    assert!(close(slopes.lower, -1.0) && close(slopes.upper, 1.0), "{slopes:?}");
    assert!(ground.allowed(&wall, -Vector2::x(), Contact::Takeoff).is_err(), "not into the wall");
    assert!(!between(&ground, [0.0, 0.3, 2.0], [9.0, 0.3, 2.0]).unwrap().windows().is_empty());
    assert!(!between(&ground, [0.0, 0.3, 2.0], [5.0, 0.3, 0.0]).unwrap().windows().is_empty());
}

/// A greatest apex below the landing refuses every arc, under its name.
#[test]
fn an_apex_limit_below_the_landing_is_named() {
    let shape = on_a_floor(|shape| plate(shape, [[8.0, 2.0], [12.0, 2.0]]));
    let limits = HopperLimits { apex_height_max_m: Some(1.5), ..HopperLimits::with_speeds(50.0, 50.0) };
    let ground = ground(shape.mesh(), limits, 9.81, &surface(3.0));
    let set = between(&ground, [0.0, 0.3, 0.0], [10.0, 0.3, 2.0]).unwrap();
    assert!(set.windows().is_empty());
    let apex = set.limits().iter().find(|limit| limit.limit == Limit::ApexHeight).unwrap();
    assert!(apex.lofts.is_empty(), "{apex:?}");
}

/// Every facet twice, and lengths times 4 with speeds times 2: the same windows, to the last bit.
#[test]
fn duplicate_facets_and_powers_of_two_change_nothing() {
    let draw = &mut Draw::seeded(1814);
    let mut compared = 0;
    for _ in 0..60 {
        let shape = scene(draw);
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.uniform(1.0, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
        let clearance_m = if draw.chance(0.5) { 0.0 } else { 0.05 };
        let grip = surface(draw.uniform(0.5, 3.0));
        let limits = |scale: f64| HopperLimits {
            clearance_m: clearance_m * scale * scale,
            ..HopperLimits::with_speeds(speed_m_s * scale, speed_m_s * scale)
        };
        let mut twice = shape.clone();
        twice.triangles.extend(shape.triangles.clone());
        let mut large = shape.clone();
        large.corners.iter_mut().for_each(|corner| *corner *= 4.0);
        let grounds = [(shape, 1.0), (twice, 1.0), (large, 2.0)]
            .map(|(shape, scale)| ground(shape.mesh(), limits(scale), gravity_m_s2, &grip));
        for _ in 0..20 {
            let (Some(from), Some(to)) = (contact(&grounds[0], draw), contact(&grounds[0], draw)) else { continue };
            // Moved to the surface as those of the other meshes are: a second time.
            let points = [from, to].map(|contact| contact.point_m());
            let [Ok(from), Ok(to)] = points.map(|point| grounds[0].contact(point)) else { continue };
            let Some(set) = grounds[0].takeoff_set(&from, &to) else { continue };
            for (ground, scale) in [(&grounds[1], 1.0), (&grounds[2], 4.0)] {
                let [from, to] = points.map(|point| ground.contact(point * scale));
                // (Closed bodies that are there twice bury no more than once.)
                let (from, to) = (from.unwrap(), to.unwrap());
                let other = ground.takeoff_set(&from, &to).unwrap();
                assert_eq!(ends(&set), ends(&other), "{from:?} {to:?}");
            }
            compared += usize::from(!set.windows().is_empty());
        }
    }
    assert!(compared > 60, "{compared}");
}
