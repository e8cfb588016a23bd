//! Errata of Campana and Laumond 2016, *Ballistic motion planning*, each as a case in which the printed rule fails and ours does not; and
//! what its planner does beside exact windows.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its mesh should stop")]

use std::f64::consts::{FRAC_PI_2, PI};

use chta::{
    ballistics::{Arc, LineOfSight, TakeoffChoice, limits},
    ground::{MeshBuffers, MeshContact, MeshGround},
    planner::{
        Amount, Budgets, LabelCap, Objective, SearchedCommands,
        roadmap::{
            ContactSampler, GrownRoadmap, JoinCounts, JoinTest, OneByOne, PROBE_RADIUS_M, PROBE_STAND_OFF_M, RoadmapEnd,
            RoadmapQuestion, SpaceBounds, grow_one_by_one,
        },
    },
    quantity::SlopeInterval,
    world::{FrictionCone, HopperLimits, PreparedCone},
};
use nalgebra::{Point3, Vector2, Vector3};

use super::mesh_windows::{Shape, contact, ground, on_a_floor, scene, surface};
use crate::support::Draw;

/// The landing slopes that keep the reversed landing velocity inside the cone of a normal, at 2001 angles.
fn landings_by_vectors(normal: Vector3<f64>, friction: f64) -> Vec<f64> {
    let cosine = 1.0 / friction.hypot(1.0);
    let slopes = (1..2000).map(|i| (PI * (f64::from(i) / 2000.0 - 0.5)).tan());
    slopes.filter(|slope| -Vector3::new(1.0, 0.0, *slope).normalize().dot(&normal) >= cosine).collect()
}

/// Half the angle of the cut of a cone by the plane of travel along x, and the angle of its middle; `None` where the plane misses it.
fn cut(normal: Vector3<f64>, friction: f64) -> Option<[f64; 2]> {
    let rho = normal.x.hypot(normal.z);
    let cosine = 1.0 / friction.hypot(1.0);
    (rho > cosine).then(|| [(cosine / rho).acos(), normal.z.atan2(normal.x)])
}

/// Erratum: Algorithm 1 finds no solution on a cone that points down where `alpha_g+` exceeds a right angle, and must where `alpha_g-` does.
///
/// As printed a cone that holds the vertical has no landing.
#[test]
fn erratum_algorithm_1_refuses_downward_cones_by_the_wrong_end() {
    let draw = &mut Draw::seeded(1820);
    let (mut landable, mut refused_as_printed) = (0, 0);
    while landable < 400 {
        let friction = draw.log_uniform(0.2, 2.0);
        let normal = Vector3::from_fn(|_, _| draw.uniform(-1.0, 1.0)).normalize();
        let Some([delta, gamma]) = cut(normal, friction).filter(|[_, gamma]| *gamma <= 0.0) else { continue };
        let by_vectors = landings_by_vectors(normal, friction);
        let slopes = PreparedCone::new(FrictionCone::new(friction).unwrap()).slopes(-normal, Vector2::x());
        for slope in &by_vectors {
            assert!(slopes.contains(*slope), "{slope} in {slopes:?}");
        }
        let [from, to] = [gamma + PI - delta, gamma + PI + delta];
        if (from - FRAC_PI_2).abs() < 2e-3 {
            continue;
        }
        assert_eq!(by_vectors.is_empty(), from >= FRAC_PI_2, "{normal:?} {friction}");
        if !by_vectors.is_empty() {
            landable += 1;
            refused_as_printed += usize::from(to > FRAC_PI_2);
        }
    }
    assert!(refused_as_printed > 100, "{refused_as_printed} of {landable} cones");
}

/// Erratum: the bounds after (6) and (7) are tangents of angles, and are printed as the angles.
#[test]
fn erratum_bounds_of_the_speeds_are_tangents() {
    let draw = &mut Draw::seeded(1821);
    let (mut solvable, mut too_fast) = (0, 0);
    for _ in 0..2000 {
        let (gravity, run_m, rise_m) = (draw.log_uniform(1e-5, 25.0), draw.log_uniform(0.1, 100.0), draw.uniform(-5.0, 5.0));
        let sight = LineOfSight::new(run_m, rise_m);
        let square = gravity * run_m * draw.uniform(0.5, 4.0);
        let discriminant = square * square - 2.0 * gravity * rise_m * square - (gravity * run_m).powi(2);
        let lofts = limits::takeoff_speed(sight, square.sqrt(), gravity);
        if discriminant < 0.0 {
            continue;
        }
        solvable += 1;
        let printed = [-1.0, 1.0].map(|sign: f64| (square + sign * discriminant.sqrt()) / (gravity * run_m));
        for (bound, ours) in printed.into_iter().zip([lofts.lower, lofts.upper]) {
            assert!((sight.slope() + ours - bound).abs() <= 1e-6 * (1.0 + bound.abs()), "{bound} {ours} {sight:?}");
            // As an angle it does not take the greatest speed.
            let loft = bound.tan() - sight.slope();
            let is_fast = loft <= 0.0 || Arc::new(sight, loft, gravity).takeoff_speed_m_s() > 1.001 * square.sqrt();
            too_fast += usize::from(is_fast || bound >= FRAC_PI_2);
        }
    }
    assert!(solvable > 500 && too_fast > solvable, "{too_fast} of {} bounds", 2 * solvable);
}

/// Erratum: one version of Algorithm 1 asks whether `alpha_2-` exceeds minus a right angle, which every arctangent does, instead of
/// `alpha_g-`: on level ground, whose cone holds the vertical, an upper bound is then computed that leaves nothing.
#[test]
fn erratum_algorithm_1_asks_alpha_2_for_alpha_g() {
    for friction in [0.1_f64, 0.5, 1.2, 3.0] {
        let (delta, gamma) = (friction.atan(), FRAC_PI_2);
        let [low, high] = [gamma - PI - delta, gamma - PI + delta];
        assert!(high > -FRAC_PI_2 && low < -FRAC_PI_2);
        let bound = |angle: f64| -angle.tan();
        let [lower, upper_as_printed] = [bound(high), bound(low)];
        assert!(lower.atan() > -FRAC_PI_2 && upper_as_printed < lower, "the printed test computes an upper bound below the lower");
        let slopes = PreparedCone::new(FrictionCone::new(friction).unwrap()).slopes(-Vector3::z(), Vector2::x());
        let lofts = limits::landing_cone(LineOfSight::new(1.0, 0.0), slopes);
        assert!((lofts.lower - lower).abs() < 1e-9 * lower && lofts.upper == f64::INFINITY, "{lofts:?}");
    }
}

/// Erratum: "both velocity vectors belong to the cone": that of a landing belongs to the opposite nappe. As printed no hop lands on level
/// ground. And an arc has to be over the line of sight (5), which the conditions of existence leave out.
#[test]
fn erratum_landing_velocities_belong_to_the_opposite_nappe() {
    let ground = ground(on_a_floor(|_| {}).mesh(), HopperLimits::with_speeds(6.0, 6.0), 9.81, &surface(0.8));
    let [from, to] = [0.0, 2.0].map(|x| ground.contact(Point3::new(x, 0.3, 0.0)).unwrap());
    let set = ground.takeoff_set(&from, &to).unwrap();
    let cosine = 1.0 / 0.8_f64.hypot(1.0);
    for window in set.windows() {
        for loft in [window.lofts.lower, window.lofts.upper] {
            let landing = Vector3::new(1.0, 0.0, -loft).normalize();
            assert!(landing.z < 0.0 && -landing.z >= cosine - 1e-9, "{landing:?}");
        }
    }
    assert!(!set.windows().is_empty());
    // Two walls that face each other, friction enough for either to hold straight lines down through the solid below the chord.
    let walls = on_a_floor(|shape| {
        shape.polygon(&[[0.0, -4.0, 1.0], [0.0, 4.0, 1.0], [0.0, 4.0, 6.0], [0.0, -4.0, 6.0]]);
        shape.polygon(&[[4.0, -4.0, 1.0], [4.0, -4.0, 6.0], [4.0, 4.0, 6.0], [4.0, 4.0, 1.0]]);
    });
    let ground = super::mesh_windows::ground(walls.mesh(), HopperLimits::with_speeds(1e3, 1e3), 9.81, &surface(0.5));
    let [from, to] = [0.0, 4.0].map(|x| ground.contact(Point3::new(x, 0.3, 3.0)).unwrap());
    let set = ground.takeoff_set(&from, &to).unwrap();
    let cones = set.limits().iter().filter(|limit| limit.lofts.lower < 0.0).count();
    assert!(cones > 0 && set.windows().iter().all(|window| window.lofts.lower >= 0.0), "{set:?}");
}

/// Erratum: the topological property holds strictly inside every limit and every facet alone. Beside an edge the normal jumps, and the
/// nearest contact beyond it has no hop.
#[test]
fn erratum_the_topological_property_fails_at_an_edge() {
    let roof = |shape: &mut Shape| {
        shape.polygon(&[[0.0, -5.0, 0.0], [4.0, -5.0, 0.0], [4.0, 5.0, 0.0], [0.0, 5.0, 0.0]]);
        shape.polygon(&[[4.0, -5.0, 0.0], [4.2, -5.0, -3.0], [4.2, 5.0, -3.0], [4.0, 5.0, 0.0]]);
    };
    let mut shape = Shape::default();
    roof(&mut shape);
    let ground = ground(shape.mesh(), HopperLimits::with_speeds(5.0, 5.0), 9.81, &surface(0.6));
    let at = |x: f64, z: f64| ground.contact(Point3::new(x, 0.2, z)).unwrap();
    let windows = |to: &MeshContact| ground.takeoff_set(&at(3.0, 0.0), to).unwrap().windows().len();
    let near_m = 1e-6;
    let [on, beyond] = [at(4.0 - near_m, 0.0), at(4.0 + near_m, -15.0 * near_m)];
    assert!((on.point_m() - beyond.point_m()).norm() < 20.0 * near_m);
    assert!(on.facets()[0].id != beyond.facets()[0].id && windows(&on) == 1 && windows(&beyond) == 0);
}

fn grown(
    ground: &MeshGround,
    ends: [MeshContact; 2],
    bounds: Option<SpaceBounds>,
    (scheme, seed): (OneByOne, u64),
) -> (GrownRoadmap, JoinCounts) {
    let objective = Objective::of(Amount::ArcLength);
    let question = RoadmapQuestion {
        objective: &objective,
        budgets: &Budgets::NONE,
        commands: SearchedCommands::Chosen,
        takeoff: TakeoffChoice::LeastTime,
        cap: LabelCap::default(),
    };
    let mut sampler = ContactSampler::new(ground, bounds, PROBE_STAND_OFF_M, seed).unwrap();
    grow_one_by_one(ground, ends, &mut sampler, &question, scheme, &()).unwrap()
}

fn standing(ground: &MeshGround, at: [f64; 3]) -> MeshContact {
    ground.stood_off(&ground.contact(Point3::from(at)).unwrap(), PROBE_STAND_OFF_M).unwrap()
}

fn scheme(test: JoinTest, contacts_max: usize) -> OneByOne {
    OneByOne { test, height_max_m: None, contacts_max, time_max: None }
}

/// Erratum: the convergence property fails for a fixed number of angles. Of two pads with a wall between them that has a slot every pair of
/// contacts has a window, and none of the sampled angles of any pair passes, however many contacts there are.
#[test]
fn erratum_the_convergence_property_fails_for_a_fixed_number_of_angles() {
    let mut shape = Shape::default();
    for x in [0.0, 2.0] {
        shape.polygon(&[[x - 0.05, -0.05, 0.0], [x + 0.05, -0.05, 0.0], [x + 0.05, 0.05, 0.0], [x - 0.05, 0.05, 0.0]]);
    }
    for [low, high] in [[-9.0, 1.21], [1.48, 9.0]] {
        shape.polygon(&[[1.0, -9.0, low], [1.0, 9.0, low], [1.0, 9.0, high], [1.0, -9.0, high]]);
    }
    let ground = ground(shape.mesh(), HopperLimits::with_speeds(6.5, 6.5), 9.81, &surface(1.2));
    let pads = Some(SpaceBounds { min: Point3::new(-0.1, -0.1, -0.1), max: Point3::new(2.1, 0.1, 0.1) });
    let with = |test, seed| {
        let ends = [0.0, 2.0].map(|x| standing(&ground, [x, 0.01, 0.0]));
        grown(&ground, ends, pads, (scheme(test, 120), seed))
    };
    for seed in 0..3 {
        let (missed, counts) = with(JoinTest::SampledAngles, seed);
        assert!(missed.route.path.is_none() && missed.end == RoadmapEnd::Contacts && counts.refused > 1_000, "{counts:?}");
        // Hops of decimetres join the contacts of each pad, and none leads over.
        let gap = missed.roadmap.gap(&ground, missed.ends, &()).unwrap();
        assert!(gap.free > 0 && gap.free + gap.refusals.total() + gap.vertical == gap.judged, "{gap:?}");
        let (solved, _) = with(JoinTest::ExactWindows, seed);
        let path = solved.route.path.unwrap();
        assert!(solved.end == RoadmapEnd::Joined && path.contacts == [0, 1]);
        let height_m = PROBE_STAND_OFF_M + path.arcs()[0].height_at_m(1.0);
        assert!((1.21..=1.48).contains(&height_m), "{height_m} m in the slot");
    }
}

/// Erratum: arcs are flown either way since both speeds share one bound. With two bounds the roadmap is directed.
#[test]
fn erratum_with_two_speeds_the_roadmap_is_directed() {
    let mut shape = Shape::default();
    shape.polygon(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    shape.polygon(&[[2.0, 0.0, 1.0], [3.0, 0.0, 1.0], [3.0, 1.0, 1.0], [2.0, 1.0, 1.0]]);
    // Up takes 6 m/s and lands with 4; down lands with 6.
    let limits = HopperLimits::with_speeds(6.2, 4.5);
    let ground = ground(shape.mesh(), limits, 9.81, &surface(1.0));
    let [low, high] = [standing(&ground, [0.5, 0.5, 0.0]), standing(&ground, [2.5, 0.5, 1.0])];
    for test in [JoinTest::SampledAngles, JoinTest::ExactWindows] {
        let run = |ends| grown(&ground, ends, None, (scheme(test, 2), 0));
        let (up, _) = run([low.clone(), high.clone()]);
        let arc = up.route.path.unwrap().arcs()[0];
        let back = Arc::new(LineOfSight::new(arc.line_of_sight().run_m(), -arc.line_of_sight().rise_m()), arc.loft(), 9.81);
        assert!(back.landing_speed_m_s() > 4.5 && (back.landing_speed_m_s() - arc.takeoff_speed_m_s()).abs() < 1e-9);
        assert_eq!([up.roadmap.windows_between(0, 1).len(), up.roadmap.windows_between(1, 0).len()], [1, 0], "{test:?}");
        let (down, _) = run([high.clone(), low.clone()]);
        assert!(down.route.path.is_none() && down.end == RoadmapEnd::Contacts, "{test:?}");
    }
    // With one bound the hop goes either way.
    let both = super::mesh_windows::ground(ground.tree().mesh().clone(), HopperLimits::with_speeds(6.2, 6.2), 9.81, &surface(1.0));
    let ends = [standing(&both, [0.5, 0.5, 0.0]), standing(&both, [2.5, 0.5, 1.0])];
    let (either, _) = grown(&both, ends, None, (scheme(JoinTest::SampledAngles, 2), 0));
    assert!(either.roadmap.windows_between(0, 1) == either.roadmap.windows_between(1, 0) && either.roadmap.window_count() == 2);
}

/// On random scenes every hop that sampling finds is one of the exact windows of its contacts, or the ball passed by a facet that the arc
/// meets; and each hop of the path is one.
#[test]
fn sampled_hops_are_in_exact_windows_or_graze() {
    let draw = &mut Draw::seeded(1822);
    let (mut hops, mut grazes, mut paths) = (0, 0, 0);
    for seed in 0..40 {
        let gravity = draw.log_uniform(1e-5, 25.0);
        let (speed, friction) = ((gravity * draw.uniform(3.0, 20.0)).sqrt(), draw.uniform(0.3, 1.5));
        let landing = if seed % 3 == 0 { 0.8 * speed } else { speed };
        let ground = ground(scene(draw).mesh(), HopperLimits::with_speeds(speed, landing), gravity, &surface(friction));
        let mut end = || loop {
            let found = contact(&ground, draw).and_then(|found| ground.stood_off(&found, PROBE_STAND_OFF_M));
            if let Some(found) = found {
                break found;
            }
        };
        let ends = [end(), end()];
        let (found, _) = grown(&ground, ends, None, (scheme(JoinTest::SampledAngles, 40), seed));
        let buffers = &mut MeshBuffers::default();
        let mut is_exact = |from: usize, to: usize, lofts: SlopeInterval| {
            let [from, to] = [from, to].map(|node| found.roadmap.contact(node));
            let windows = ground.windows(from, to, buffers).unwrap().1;
            windows.iter().any(|window| window.lower * (1.0 - 1e-9) <= lofts.lower && lofts.upper <= window.upper * (1.0 + 1e-9))
        };
        for from in 0..found.roadmap.contact_count() {
            for hop in found.roadmap.hops_from(from) {
                for lofts in found.roadmap.windows(hop) {
                    hops += 1;
                    if !is_exact(from, hop.landing, lofts) {
                        grazes += 1;
                        let [takeoff, landing] = [from, hop.landing].map(|node| found.roadmap.contact(node));
                        let course = ground.course(takeoff, landing).unwrap();
                        let arc = Arc::new(course.sight, lofts.lower, gravity);
                        assert!(ground.ball_meets(&course, &arc, 1e-3, 5e-4), "{from} to {}: {lofts:?}", hop.landing);
                    }
                }
            }
        }
        if let Some(path) = &found.route.path {
            paths += 1;
            for (pair, arc) in path.contacts.windows(2).zip(path.arcs()) {
                assert!(is_exact(pair[0], pair[1], SlopeInterval { lower: arc.loft(), upper: arc.loft() }));
            }
        }
    }
    assert!(hops > 2_000 && paths > 5 && grazes * 100 < hops, "{grazes} grazes among {hops} hops, {paths} paths");
}

/// A steep arc has its places farther apart than twice the radius of the ball, and may pass a thin plate between two of them. The hop is taken
/// out when its path is checked, and counted.
#[test]
fn a_plate_between_two_places_of_the_ball_is_no_path() {
    let mut passed = 0;
    for number in 0..60 {
        let plate_m = 0.15 + 0.003 * f64::from(number);
        let mut shape = Shape::default();
        for [y, z] in [[0.0, 0.0], [0.5, 7.0]] {
            shape.polygon(&[[-0.1, y - 0.1, z], [0.1, y - 0.1, z], [0.1, y + 0.1, z], [-0.1, y + 0.1, z]]);
        }
        // A plate right over the first pad, open on no side that an arc from it could take.
        shape.polygon(&[[-0.2, -0.2, plate_m], [0.2, -0.2, plate_m], [0.2, 0.2, plate_m], [-0.2, 0.2, plate_m]]);
        let ground = ground(shape.mesh(), HopperLimits::with_speeds(14.0, 14.0), 9.81, &surface(0.05));
        let ends = [standing(&ground, [0.0, 0.0, 0.0]), standing(&ground, [0.0, 0.5, 7.0])];
        let [first, last] = [&ends[0], &ends[1]];
        assert!(ground.takeoff_set(first, last).unwrap().windows().is_empty(), "the plate blocks all");
        let (found, counts) = grown(&ground, ends.clone(), None, (scheme(JoinTest::SampledAngles, 2), 0));
        assert!(found.route.path.is_none() && found.roadmap.window_count() == 0, "{counts:?}");
        assert!(counts.tried == 1 && counts.refused + counts.grazes == 1, "{counts:?}");
        passed += counts.grazes;
    }
    assert!(passed > 0, "no plate of 60 lies between two places of a ball of {PROBE_RADIUS_M} m");
}
