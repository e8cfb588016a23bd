//! First contacts of arcs with meshes, and trials over them.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test that cannot build its mesh should stop, and says what it compared"
)]

use chta::{
    ballistics::TakeoffChoice,
    ground::{
        ContactFailure, DemGround, FirstContact, LiftoffVelocity, MeshContact, MeshGround, MeshPosition, Surface, TouchdownState,
    },
    path::{Hop, HopPath, execute_over_mesh},
    quantity::{Angle, MapPoint},
    terrain::{Dem, GeoReference, MeshTree, OverlaidDem, Overlays},
    uncertainty::{MeshAims, Mission, Policy, Simulation, SimulationError, TrialOptions, TrialOutcome, Uncertainty},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};
use nalgebra::{Point3, Vector2, Vector3};

use super::{
    mesh_verified::hop,
    mesh_windows::{Shape, contact, ground, scene, surface, triangulated},
};
use crate::support::Draw;

fn position(contact: &MeshContact) -> MeshPosition {
    MeshPosition::from(contact)
}

/// A velocity of a speed in a random direction that leaves all facets at a contact.
fn away(draw: &mut Draw, from: &MeshContact, speed_m_s: f64) -> Option<LiftoffVelocity> {
    for _ in 0..20 {
        let direction = Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0));
        let direction = direction.try_normalize(0.1)?;
        if from.facets().iter().all(|facet| facet.normal.dot(&direction) > 0.05) {
            let across = direction.xy().norm();
            return Some(LiftoffVelocity {
                heading: direction.xy() / across,
                horizontal_m_s: across * speed_m_s,
                vertical_m_s: direction.z * speed_m_s,
            });
        }
    }
    None
}

/// What a search over all triangles says of an arc: the time of the first contact and the facet, or that an edge or a grazing contact is too
/// near to say.
enum Searched {
    Meets(f64, usize),
    Free,
    Doubtful,
}

/// The first contact by bisection of the distance from the plane of every triangle, in both parts between which the arc is parallel to it.
fn searched(ground: &MeshGround, from: &MeshContact, velocity: Vector3<f64>, most_s: f64) -> Searched {
    let g = ground.gravity_m_s2();
    let at = |t: f64| from.point_m() + velocity * t - Vector3::new(0.0, 0.0, 0.5 * g * t * t);
    let mut found: Option<(f64, usize)> = None;
    let mut doubts: Vec<f64> = Vec::new();
    for (facet, corners) in ground.tree().mesh().triangles().enumerate() {
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
        let over = |t: f64| normal.dot(&(at(t) - corners[0]));
        let stands_on = from.facets().iter().any(|own| own.id.index() == facet);
        let parallel_s = velocity.dot(&normal) / (g * normal.z);
        let parts = if parallel_s > 0.0 && parallel_s < most_s {
            vec![(0.0, parallel_s), (parallel_s, most_s)]
        } else {
            vec![(0.0, most_s)]
        };
        for (begin, end) in parts {
            let begin_m = if stands_on && begin == 0.0 { 0.0 } else { over(begin) };
            if begin_m * over(end) > 0.0 || begin_m == 0.0 {
                continue;
            }
            let (mut near, mut far) = (begin, end);
            for _ in 0..80 {
                let middle = 0.5 * (near + far);
                if over(middle) * begin_m > 0.0 { near = middle } else { far = middle }
            }
            let point = at(far);
            let inside = (0..3).map(|i| {
                let side = corners[(i + 1) % 3] - corners[i];
                normal.cross(&side).normalize().dot(&(point - corners[i]))
            });
            let inside = inside.fold(f64::INFINITY, f64::min);
            let through = (velocity - Vector3::new(0.0, 0.0, g * far)).dot(&normal).abs() / velocity.norm();
            if inside > -1e-6 && (inside < 1e-6 || through < 1e-4) {
                doubts.push(far);
            } else if inside > 0.0 && found.is_none_or(|(first, _)| far < first) {
                found = Some((far, facet));
            }
        }
    }
    match found {
        _ if doubts.iter().any(|doubt| found.is_none_or(|(first, _)| *doubt <= first)) => Searched::Doubtful,
        Some((first, facet)) => Searched::Meets(first, facet),
        None => Searched::Free,
    }
}

/// Ten thousand arcs over random scenes meet first what a search over all triangles finds, ceilings and walls included.
#[test]
fn the_first_contact_is_that_of_a_search_over_all_triangles() {
    let draw = &mut Draw::seeded(1821);
    let (mut met, mut free, mut ceilings, mut doubtful) = (0, 0, 0, 0);
    for _ in 0..120 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let ground = ground(scene(draw).mesh(), HopperLimits::with_speeds(1.0, 1.0), gravity_m_s2, &surface(1.0));
        for _ in 0..100 {
            let Some(from) = contact(&ground, draw) else { continue };
            let speed_m_s = draw.uniform(0.3, 4.0) * f64::sqrt(5.0 * gravity_m_s2);
            let Some(liftoff) = away(draw, &from, speed_m_s) else { continue };
            let across = liftoff.heading * liftoff.horizontal_m_s;
            let velocity = Vector3::new(across.x, across.y, liftoff.vertical_m_s);
            let here = position(&from);
            let flight = ground.first_contact(&here, &liftoff, &here);
            match searched(&ground, &from, velocity, 40.0 * speed_m_s / gravity_m_s2) {
                Searched::Doubtful => doubtful += 1,
                Searched::Free => {
                    free += 1;
                    assert_eq!(flight.support_facet, None, "{from:?} {liftoff:?}");
                    // It left the box around the mesh.
                    let [x, y, z] = flight.end.point_m.into();
                    let bounds = ground.tree().mesh().bounds();
                    let (low, high) = (bounds.map.min, bounds.map.max);
                    let inside =
                        x > low.x + 1e-6 && x < high.x - 1e-6 && y > low.y + 1e-6 && y < high.y - 1e-6 && z > bounds.low_m + 1e-6;
                    assert!(!inside, "{flight:?}");
                }
                Searched::Meets(time_s, facet) => {
                    met += 1;
                    let found = flight.support_facet.unwrap_or_else(|| panic!("{facet} after {time_s} s: {from:?} {liftoff:?}"));
                    assert!((flight.time_s / time_s - 1.0).abs() < 1e-9, "{found:?} at {} s, {facet} at {time_s} s", flight.time_s);
                    let normal = ground.tree().normal(found);
                    ceilings += u32::from(normal.z < 0.0);
                    assert!(ground.tree().nearest(flight.end.point_m).distance_m < 1e-9);
                }
            }
        }
    }
    eprintln!("{met} met a facet, {ceilings} of them one that faces down, {free} left the mesh, {doubtful} doubtful");
    assert!(met + free > 8000 && ceilings > 300 && free > 500 && doubtful < 300);
}

/// Over a mesh that is a triangulated DEM, arcs come down where they do over the DEM, and the contacts hold or fail alike.
#[test]
fn over_a_triangulated_dem_landings_are_those_of_the_dem() {
    let draw = &mut Draw::seeded(1822);
    let (mut landed, mut held, mut failed) = (0, 0, 0);
    for round in 0..30 {
        // Every third one is a tilted plane.
        let (east, north) = (draw.uniform(-0.8, 0.8), draw.uniform(-0.8, 0.8));
        let relief_m = if round % 3 == 0 { 0.0 } else { draw.log_uniform(0.05, 3.0) };
        let map = GeoReference::local(MapPoint::new(draw.uniform(-1e3, 1e3), draw.uniform(-1e3, 1e3)), 1.0, 1.0).unwrap();
        let heights = (0..14 * 12).map(|i| {
            let (row, col) = (f64::from(i / 12), f64::from(i % 12));
            east * col - north * row + draw.uniform(0.0, relief_m)
        });
        let dem = Dem::new(14, 12, heights.collect(), map).unwrap();
        let gravity = Gravity::new(draw.log_uniform(1e-5, 25.0)).unwrap();
        let most_m_s = f64::sqrt(6.0 * gravity.m_s2());
        let hopper = Hopper::with_speeds(most_m_s, most_m_s).unwrap();
        let surface = SurfaceProperties {
            grip: Some(Grip::Friction(FrictionCone::new(draw.uniform(0.4, 1.5)).unwrap())),
            rest: if draw.chance(0.5) { RestSlope::AsFrictionHolds } else { RestSlope::Unlimited },
        };
        let mesh = MeshGround::new(MeshTree::new(triangulated(&dem)), &hopper, gravity, &surface).unwrap();
        let bounds = dem.bounds();
        let dem = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, gravity, &surface);
        for _ in 0..60 {
            let share = Vector2::new(draw.uniform(0.02, 0.98), draw.uniform(0.02, 0.98));
            let from = dem.position(bounds.min + (bounds.max - bounds.min).component_mul(&share)).unwrap();
            let on_mesh = MeshPosition { point_m: Point3::new(from.at.x, from.at.y, from.z_m) };
            let (sine, cosine) = libm::sincos(draw.uniform(0.0, std::f64::consts::TAU));
            let (up, level) = libm::sincos(draw.uniform(0.3, 1.5));
            let speed_m_s = draw.uniform(0.2, 1.3) * most_m_s;
            let liftoff = LiftoffVelocity {
                heading: Vector2::new(cosine, sine),
                horizontal_m_s: level * speed_m_s,
                vertical_m_s: up * speed_m_s,
            };
            assert_eq!(dem.holds_takeoff(&from, &liftoff), mesh.holds_takeoff(&on_mesh, &liftoff));
            let (one, other) = (dem.first_contact(&from, &liftoff, &from), mesh.first_contact(&on_mesh, &liftoff, &on_mesh));
            assert_eq!(one.support_facet.is_some(), other.support_facet.is_some());
            let (Some(of_dem), Some(of_mesh)) = (one.support_facet, other.support_facet) else { continue };
            landed += 1;
            let miss_m = (Point3::new(one.end.at.x, one.end.at.y, one.end.z_m) - other.end.point_m).norm();
            assert!(miss_m < 1e-8, "{one:?} {other:?}");
            let touchdown = TouchdownState::after(&liftoff, one.time_s, gravity.m_s2());
            let rules = [dem.check_landing(&one.end, &of_dem, &touchdown), mesh.check_landing(&other.end, &of_mesh, &touchdown)];
            assert_eq!(rules[0], rules[1], "{touchdown:?}");
            held += u32::from(rules[0].is_ok());
            failed += u32::from(rules[0] == Err(ContactFailure::Slides)) + u32::from(rules[0] == Err(ContactFailure::TooFast));
        }
    }
    eprintln!("{landed} landed, {held} held, {failed} failed");
    assert!(landed > 800 && held > 100 && failed > 100);
}

/// A cave: a floor, a shelf over a part of it, and a ceiling over all.
fn cave(friction: f64) -> MeshGround {
    let mut shape = Shape::default();
    shape.polygon(&[[-5.0, -5.0, 0.0], [15.0, -5.0, 0.0], [15.0, 5.0, 0.0], [-5.0, 5.0, 0.0]]);
    shape.cuboid(Point3::new(12.0, 0.0, 1.5), Vector3::new(2.0, 4.0, 0.2), nalgebra::Rotation3::identity());
    shape.polygon(&[[-5.0, -5.0, 4.0], [-5.0, 5.0, 4.0], [15.0, 5.0, 4.0], [15.0, -5.0, 4.0]]);
    ground(shape.mesh(), HopperLimits::with_speeds(12.0, 12.0), 9.81, &surface(friction))
}

/// A path over contacts of a mesh.
fn path(ground: &MeshGround, contacts: &[MeshContact], choice: TakeoffChoice) -> HopPath {
    let mut hops: Vec<Hop> = Vec::new();
    for pair in contacts.windows(2) {
        let along_m = hops.last().map_or(0.0, |hop: &Hop| hop.landing.along_m);
        let set = ground.takeoff_set(&pair[0], &pair[1]).unwrap();
        let (window, arc) = set.arc(choice, ground.gravity_m_s2()).unwrap();
        hops.push(hop(ground, [&pair[0], &pair[1]], &window, &arc, along_m));
    }
    HopPath::of_hops(hops, ground.hopper())
}

fn at(ground: &MeshGround, x: f64, y: f64, z: f64) -> MeshContact {
    ground.contact(Point3::new(x, y, z)).unwrap()
}

/// A mission across the cave and onto its shelf.
fn mission(ground: &MeshGround, choice: TakeoffChoice) -> Mission {
    let contacts = [at(ground, 0.0, 0.0, 0.0), at(ground, 4.0, 1.0, 0.0), at(ground, 8.0, 0.0, 0.0), at(ground, 11.0, 0.5, 1.7)];
    let path = path(ground, &contacts, choice);
    let ends = (position(&contacts[0]), position(&contacts[3]));
    let execution = execute_over_mesh(ground, &path, Some(ends));
    assert!(execution.passes(), "{:#?}", execution.violations);
    let aims = contacts.iter().zip([3, 2, 1, 0]).map(|(contact, hops)| (contact.clone(), hops)).collect();
    let (start, goal) = (contacts[0].at_m(0.0), contacts[3].at_m(path.hops[2].landing.along_m));
    Mission::over_mesh(ground.clone(), path, start, goal).with_replanning_to_contacts(MeshAims {
        contacts: aims,
        choice,
        ground: ground.clone(),
    })
}

/// Without errors every trial reaches the goal, by the plan and replanned, whichever arc of a window is flown: grazing ones too.
#[test]
fn without_errors_every_trial_arrives() {
    let ground = cave(3.0);
    for choice in [TakeoffChoice::LeastSpeed, TakeoffChoice::LeastTime, TakeoffChoice::MidRange] {
        let simulation = Simulation::new(&mission(&ground, choice), Uncertainty::NONE).unwrap();
        for policy in Policy::ALL {
            let options = TrialOptions { trials: 20, policy, goal_tolerance_m: 1e-9, ..TrialOptions::default() };
            let summary = simulation.run(&options, &mut (), &()).unwrap();
            assert_eq!(summary.outcomes.of(TrialOutcome::Reached), 20, "{choice:?} {policy:?} {:?}", summary.outcomes);
        }
    }
    // And on random scenes, hop by hop.
    let draw = &mut Draw::seeded(1823);
    let mut arrived = 0;
    for _ in 0..60 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.uniform(0.8, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
        let ground =
            self::ground(scene(draw).mesh(), HopperLimits::with_speeds(speed_m_s, 2.0 * speed_m_s), gravity_m_s2, &surface(1.5));
        for _ in 0..30 {
            let (Some(from), Some(to)) = (contact(&ground, draw), contact(&ground, draw)) else { continue };
            let Some(set) = ground.takeoff_set(&from, &to) else { continue };
            for window in set.windows() {
                for loft in [window.lofts.lower, window.lofts.upper.min(window.lofts.lower + 20.0)] {
                    if window.lofts.upper - window.lofts.lower < 1e-9 * (1.0 + loft) || loft <= 0.0 {
                        continue;
                    }
                    let arc = chta::ballistics::Arc::new(set.course().sight, loft, gravity_m_s2);
                    let across = arc.horizontal_speed_m_s();
                    let liftoff = LiftoffVelocity {
                        heading: set.course().plane.heading,
                        horizontal_m_s: across,
                        vertical_m_s: across * arc.takeoff_slope(),
                    };
                    let (here, there) = (position(&from), position(&to));
                    assert!(ground.holds_takeoff(&here, &liftoff));
                    let flight = ground.first_contact(&here, &liftoff, &there);
                    assert_eq!(flight.end, there, "{loft} of {window:?}");
                    let touchdown = TouchdownState::after(&liftoff, flight.time_s, gravity_m_s2);
                    assert_eq!(ground.check_landing(&flight.end, &flight.support_facet.unwrap(), &touchdown), Ok(()));
                    arrived += 1;
                }
            }
        }
    }
    assert!(arrived > 500, "{arrived}");
}

/// With errors of speed and direction some trials fail, in ways that have names; replanned ones fail less often.
#[test]
fn errors_make_trials_fail_and_replanning_mends_some() {
    let ground = cave(0.9);
    let errors = Uncertainty {
        takeoff_speed_sigma_fraction: 0.02,
        takeoff_angle_sigma: Angle::from_degrees(1.0),
        heading_sigma: Angle::from_degrees(1.0),
        ..Uncertainty::NONE
    };
    let simulation = Simulation::new(&mission(&ground, TakeoffChoice::MidRange), errors).unwrap();
    let options = TrialOptions { trials: 1000, goal_tolerance_m: 0.4, trajectories: 3, ..TrialOptions::default() };
    let [open_loop, replan] = simulation.compare(&options, &mut (), &()).unwrap();
    eprintln!("open loop {:?}, replanned {:?}", open_loop.outcomes, replan.outcomes);
    assert!(open_loop.success.rate > 0.05 && open_loop.success.rate < 0.9 && replan.success.rate > open_loop.success.rate);
    assert!(open_loop.outcomes.of(TrialOutcome::Missed) > 0);
    assert!(simulation.hop_successes(Policy::OpenLoop).iter().all(|share| (0.1..=1.0).contains(share)));
    // The same trials give the same summary.
    let again = simulation.compare(&options, &mut (), &()).unwrap();
    assert_eq!(again[0].success, open_loop.success);
}

/// The goal on the shelf is not reached from the floor below it.
#[test]
fn a_goal_right_above_is_not_reached() {
    let ground = cave(3.0);
    let contacts = [at(&ground, 4.0, 0.0, 0.0), at(&ground, 12.0, 0.0, 0.0)];
    let flat = path(&ground, &contacts, TakeoffChoice::LeastSpeed);
    let shelf = at(&ground, 12.0, 0.0, 1.7).at_m(8.0);
    let mission = Mission::over_mesh(ground.clone(), flat, contacts[0].at_m(0.0), shelf);
    let options = TrialOptions { trials: 5, goal_tolerance_m: 1.0, ..TrialOptions::default() };
    let summary = Simulation::new(&mission, Uncertainty::NONE).unwrap().run(&options, &mut (), &()).unwrap();
    assert_eq!(summary.outcomes.of(TrialOutcome::Missed), 5);
}

/// What has no meaning over a mesh is refused.
#[test]
fn errors_of_heights_and_points_off_the_mesh_are_refused() {
    let ground = cave(3.0);
    let heights = Uncertainty { height_sigma_m: 0.1, height_correlation_m: 1.0, ..Uncertainty::NONE };
    let mission = mission(&ground, TakeoffChoice::LeastSpeed);
    assert!(matches!(Simulation::new(&mission, heights), Err(SimulationError::HeightsOfMesh { .. })));
    let contacts = [at(&ground, 0.0, 0.0, 0.0), at(&ground, 4.0, 0.0, 0.0)];
    let mut path = path(&ground, &contacts, TakeoffChoice::LeastSpeed);
    path.hops[0].landing.point_m.z = 0.5;
    let mission = Mission::over_mesh(ground.clone(), path, contacts[0].at_m(0.0), contacts[1].at_m(4.0));
    assert!(matches!(Simulation::new(&mission, Uncertainty::NONE), Err(SimulationError::NotOnMesh { .. })));
}
