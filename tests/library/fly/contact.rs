//! First contact against dense sampling of the ground, the checker of `path::execute`, an analytic distribution, and chain against
//! map.

use chta::{
    chain::ConstrainedChain,
    ground::{DemGround, Surface},
    path::{HopPath, Totals, execute},
    quantity::{Angle, MapPoint},
    terrain::{Dem, FractalGround, OverlaidDem, Overlays, SyntheticTerrain, synthesise},
    uncertainty::{FlightEnd, LiftoffVelocity, Mission, Policy, Simulation, TrialOptions, Uncertainty},
    world::Hopper,
};
use nalgebra::{Point2, Vector2};

use super::{
    plans::Listener,
    scene::{Scene, friction},
};
use crate::support::Draw;

/// The number of ground samples with which a flight is checked.
const LOOKS: u32 = 1000;

/// The computed end must lie on the ground and on the arc, with no earlier sample below the ground.
fn is_first_contact(
    what: &str,
    (from, z_m): (Point2<f64>, f64),
    liftoff: LiftoffVelocity,
    gravity_m_s2: f64,
    end: FlightEnd,
    ground: impl Fn(Point2<f64>) -> Option<f64>,
) {
    let at = |time_s: f64| {
        let place = from + liftoff.heading * (liftoff.horizontal_m_s * time_s);
        (place, z_m + time_s * (liftoff.vertical_m_s - 0.5 * gravity_m_s2 * time_s))
    };
    let size_m = liftoff.horizontal_m_s * end.time_s + liftoff.vertical_m_s.abs() * end.time_s;
    let slack_m = 1e-9 * (1.0 + size_m);
    let (place, height_m) = at(end.time_s);
    let steep = 1.0 + ((liftoff.vertical_m_s - gravity_m_s2 * end.time_s) / liftoff.horizontal_m_s).abs();
    assert!((place - end.at_m.xy()).norm() < slack_m, "{what}: {place} differs from {end:?}");
    if end.landed {
        assert!((height_m - end.at_m.z).abs() < slack_m * steep, "{what}: the arc is at {height_m} m, {end:?}");
        let ground_m = ground(end.at_m.xy()).unwrap();
        assert!((ground_m - end.at_m.z).abs() < slack_m * steep, "{what}: the ground is at {ground_m} m, {end:?}");
    }
    for look in 1..LOOKS {
        let (place, height_m) = at(end.time_s * f64::from(look) / f64::from(LOOKS));
        // Next to the end, rounding may put a sample just behind it.
        if let Some(ground_m) = ground(place) {
            assert!(height_m > ground_m - slack_m * steep, "{what}: {height_m} m is below the ground at {place}, before {end:?}");
        }
    }
}

fn liftoff(draw: &mut Draw, heading: Vector2<f64>, speed_m_s: f64) -> LiftoffVelocity {
    let (angle, speed_m_s) = (draw.uniform(-1.0, 1.55), speed_m_s * draw.log_uniform(0.02, 2.0));
    LiftoffVelocity { heading, horizontal_m_s: speed_m_s * angle.cos(), vertical_m_s: speed_m_s * angle.sin() }
}

fn no_path() -> HopPath {
    HopPath { hops: Vec::new(), totals: Totals::default() }
}

/// Height of the chain, interpolated independently.
fn height_on(chain: &ConstrainedChain, x_m: f64) -> Option<f64> {
    let vertices = chain.geometry().vertices();
    let pair = vertices.windows(2).find(|pair| pair[0].x_m <= x_m && x_m <= pair[1].x_m)?;
    Some(pair[0].z_m + (pair[1].z_m - pair[0].z_m) * ((x_m - pair[0].x_m) / (pair[1].x_m - pair[0].x_m)))
}

#[test]
fn contact_with_random_chains_is_the_first_that_dense_sampling_finds() {
    let mut draw = Draw::seeded(2026);
    let (mut landed, mut lost, mut stayed) = (0, 0, 0);
    for _ in 0..60 {
        let points: Vec<(f64, f64)> = draw.profile(25, 4.0).iter().map(|p| (p.x_m, p.z_m)).collect();
        let scene = Scene::of_chain(&points, 10.0, friction(5.0));
        let chain = &scene.chain;
        let test = chta::hop::HopTest::new(chain.clone());
        let start = chain.geometry().station(scene.ends_m.0).unwrap();
        let path = no_path();
        let simulation = Simulation::new(&Mission::along_chain(test, path, start, start), Uncertainty::NONE).unwrap();
        for i in 0..20 {
            // Some start at vertices, some inside segments.
            let x_m = if i % 4 == 0 { points[draw.below(points.len())].0 } else { draw.uniform(scene.ends_m.0, scene.ends_m.1) };
            let liftoff = liftoff(&mut draw, Vector2::new(if i % 2 == 0 { 1.0 } else { -1.0 }, 0.0), 9.0);
            let end = simulation.fly(Point2::new(x_m, 0.0), liftoff).unwrap();
            let z_m = chain.geometry().station(x_m).unwrap().point.z_m;
            is_first_contact("chain", (Point2::new(x_m, 0.0), z_m), liftoff, scene.gravity_m_s2, end, |p| height_on(chain, p.x));
            match (end.landed, end.time_s > 0.0) {
                (true, true) => landed += 1,
                (true, false) => stayed += 1,
                (false, _) => lost += 1,
            }
        }
    }
    assert!(landed > 300 && lost > 60 && stayed > 60, "{landed} landed, {lost} lost, {stayed} never left the ground");
}

/// Height of the triangulated posts, implemented from the definition in `interface.md` alone.
fn height_of(dem: &Dem, at: Point2<f64>) -> Option<f64> {
    let map = dem.georeference();
    let (u, v) = ((at.x - map.north_west().x) / map.dx_m(), (map.north_west().y - at.y) / map.dy_m());
    let inside = |value: f64, count: usize| value >= 0.0 && value <= (count - 1) as f64;
    if !inside(u, dem.cols()) || !inside(v, dem.rows()) {
        return None;
    }
    let (col, row) = ((u as usize).min(dem.cols() - 2), (v as usize).min(dem.rows() - 2));
    let (u, v) = (u - col as f64, v - row as f64);
    let z = |down: usize, right: usize| dem.elevation(row + down, col + right);
    // Weights of the corners of the half-square that contains the position.
    let third = if u >= v { z(0, 1)? } else { z(1, 0)? };
    Some((1.0 - u.max(v)) * z(0, 0)? + (u - v).abs() * third + u.min(v) * z(1, 1)?)
}

fn rough_map() -> Dem {
    let ground = Some(FractalGround { hurst_exponent: 0.6, rms_deviation_m: 0.5, baseline_m: 1.0 });
    synthesise(&SyntheticTerrain { rows: 40, cols: 50, seed: 3, ground, craters: None, ..SyntheticTerrain::default() }).unwrap()
}

#[test]
fn contact_with_a_map_is_the_first_that_dense_sampling_finds() {
    let mut draw = Draw::seeded(7);
    let scene =
        Scene::of_dem(rough_map(), [(2.0, 20.0), (47.0, 21.0)], Hopper::with_speeds(10.0, 10.0).unwrap(), friction(5.0), 1.6);
    let dem = scene.dem.as_ref().unwrap();
    let start = scene.chain.geometry().station(0.0).unwrap();
    let path = no_path();
    let terrain = OverlaidDem::new(dem.clone(), Overlays::default());
    let ground = DemGround::new(terrain, &scene.hopper, scene.chain.gravity(), &scene.surface);
    let start = scene.chain.contact_point(&start);
    let simulation = Simulation::new(&Mission::over_dem(ground, path, start, start), Uncertainty::NONE).unwrap();
    let (mut landed, mut lost, mut stayed) = (0, 0, 0);
    for i in 0..1000 {
        let mut from = MapPoint::new(draw.uniform(0.0, 49.0), draw.uniform(0.0, 39.0));
        // Some start at posts, some on rows.
        if i % 3 == 0 {
            from.y = from.y.round();
            from.x = if i % 2 == 0 { from.x.round() } else { from.x };
        }
        let turn = if i % 5 == 0 { f64::from(i % 8) * std::f64::consts::FRAC_PI_4 } else { draw.uniform(0.0, 6.3) };
        let liftoff = liftoff(&mut draw, Vector2::new(turn.cos(), turn.sin()), 6.0);
        let end = simulation.fly(from, liftoff).unwrap();
        let z_m = height_of(dem, from).unwrap();
        is_first_contact("map", (from, z_m), liftoff, scene.gravity_m_s2, end, |p| height_of(dem, p));
        match (end.landed, end.time_s > 0.0) {
            (true, true) => landed += 1,
            (true, false) => stayed += 1,
            (false, _) => lost += 1,
        }
    }
    assert!(landed > 300 && lost > 60 && stayed > 60, "{landed} landed, {lost} lost, {stayed} never left the ground");
}

/// The checker flies spoiled commands by Newton's equations and bisection.
#[test]
fn contact_agrees_with_the_checker() {
    let scene = Scene::rolling();
    let planned = scene.planned();
    let simulation = planned.simulation(Uncertainty::NONE);
    let mut compared = 0;
    for (i, hop) in planned.path.hops.iter().enumerate() {
        for (speed, turn_deg) in [(1.0, 0.0), (0.9, 0.0), (0.97, 3.0), (1.04, -2.0), (1.2, 1.0), (0.6, 0.0), (1.0, 8.0)] {
            let mut spoiled = planned.path.clone();
            spoiled.hops[i].takeoff_speed_m_s *= speed;
            spoiled.hops[i].takeoff_angle = Angle::from_degrees(hop.takeoff_angle.degrees() + turn_deg);
            let angle = spoiled.hops[i].takeoff_angle.radians();
            let liftoff = LiftoffVelocity {
                heading: Vector2::new(hop.direction.sign(), 0.0),
                horizontal_m_s: spoiled.hops[i].takeoff_speed_m_s * angle.cos(),
                vertical_m_s: spoiled.hops[i].takeoff_speed_m_s * angle.sin(),
            };
            let end = simulation.fly(Point2::new(hop.takeoff.along_m, 0.0), liftoff).unwrap();
            let execution = execute(&scene.chain, &spoiled, None);
            match execution.flights[i].as_ref().unwrap().contact {
                Some(contact) => {
                    let miss_m = (contact.x_m - end.at_m.x).abs();
                    assert!(end.landed && miss_m < 1e-8, "hop {i} at {speed} and {turn_deg}: {contact:?} for {end:?}");
                    compared += 1;
                }
                None => assert!(!end.landed),
            }
        }
    }
    assert!(compared > 30, "only {compared} flights");
}

/// Range over flat ground is `k v^2`, so its distribution for a Gaussian speed is known: Kolmogorov-Smirnov test at the level 0.01.
#[test]
fn landings_on_flat_ground_follow_their_analytic_distribution() {
    let scene = Scene::flat();
    let planned = scene.planned();
    let [hop] = planned.path.hops[..] else { panic!("the plan has more than one hop") };
    for (absolute, fraction) in [(0.4, 0.0), (0.0, 0.03)] {
        let uncertainty =
            Uncertainty { takeoff_speed_sigma_m_s: absolute, takeoff_speed_sigma_fraction: fraction, ..Uncertainty::NONE };
        let mut listener = Listener::default();
        let options = TrialOptions { trials: 10_000, seed: 4, ..TrialOptions::default() };
        let summary = planned.simulation(uncertainty).run(&options, &mut listener, &()).unwrap();
        let planned_m = hop.run_m();
        let sigma_m_s = absolute + fraction * hop.takeoff_speed_m_s;
        let below = |range_m: f64| {
            let speed_m_s = hop.takeoff_speed_m_s * (range_m / planned_m).sqrt();
            0.5 * libm::erfc((hop.takeoff_speed_m_s - speed_m_s) / sigma_m_s / std::f64::consts::SQRT_2)
        };
        let mut ranges: Vec<f64> = listener.hops.iter().map(|hop| hop.contact_m.x - hop.takeoff_m.x).collect();
        assert_eq!(ranges.len(), 10_000);
        ranges.sort_by(f64::total_cmp);
        let n = ranges.len() as f64;
        let largest = ranges.iter().enumerate().fold(0.0f64, |largest, (i, &range_m)| {
            let share = below(range_m);
            largest.max((share - i as f64 / n).abs()).max((share - (i as f64 + 1.0) / n).abs())
        });
        assert!(largest * n.sqrt() < 1.628, "sqrt(n) D = {}, more than the 1.628 of level 0.01", largest * n.sqrt());
        // The quantiles of the summary against the same landings, sorted.
        let mut errors: Vec<f64> = listener.hops.iter().map(|hop| hop.error_m).collect();
        errors.sort_by(f64::total_cmp);
        let found = summary.landings[0].error;
        for (quantile, share) in
            [(found.q05_m, 0.05), (found.q25_m, 0.25), (found.q50_m, 0.5), (found.q75_m, 0.75), (found.q95_m, 0.95)]
        {
            let exact = errors[(9999.0 * share) as usize];
            assert!((quantile / exact - 1.0).abs() <= 1.0 / 512.0, "{share}: {quantile} for {exact}");
        }
        assert_eq!(found.max_m, errors[9999]);
    }
}

/// A slice of a DEM flown as a chain and over the triangles: the same positions and outcomes, from two implementations of the cone.
#[test]
fn along_a_slice_the_chain_and_the_map_agree() {
    let scene = Scene::craters();
    let planned = scene.planned();
    let on_chain = planned.chain_mission();
    let errors = Uncertainty {
        takeoff_speed_sigma_fraction: 0.01,
        takeoff_angle_sigma: Angle::from_degrees(0.7),
        drift_along_sigma_m: 0.15,
        friction_sigma: 0.05,
        ..Uncertainty::NONE
    };
    let options = TrialOptions { trials: 1500, policy: Policy::OpenLoop, goal_tolerance_m: 4.0, ..TrialOptions::default() };
    let mut listeners = [Listener::default(), Listener::default()];
    for (mission, listener) in [on_chain, planned.mission()].into_iter().zip(&mut listeners) {
        Simulation::new(&mission, errors.clone()).unwrap().run(&options, listener, &()).unwrap();
    }
    let [chain, map] = listeners;
    let start = planned.path.hops[0].takeoff.map().unwrap();
    let (mut compared, mut different) = (0, 0);
    for (a, b) in chain.trials.iter().zip(&map.trials) {
        different += u32::from(a.outcome != b.outcome || a.hops != b.hops);
    }
    // A displaced position on the border between a facet that holds and one that does not may be on either side.
    assert!(different <= 3, "{different} trials of 1500 have different outcomes");
    if different == 0 {
        for (a, b) in chain.hops.iter().zip(&map.hops) {
            let along_m = (b.contact_m.xy() - start).norm();
            assert!((along_m - a.contact_m.x).abs() < 1e-6 && (a.contact_m.z - b.contact_m.z).abs() < 1e-6, "{a:?} {b:?}");
            compared += 1;
        }
        assert!(compared > 1000, "only {compared} hops");
    }
}

/// A robot that is displaced only along the slice stays in its plane, so replanning over the triangles gives the hops of the chain.
#[test]
fn along_a_slice_chain_and_map_replan_the_same_hops() {
    let scene = Scene::craters();
    let planned = scene.planned();
    let errors = Uncertainty { drift_along_sigma_m: 0.4, ..Uncertainty::NONE };
    let options = TrialOptions { trials: 150, policy: Policy::Replan, goal_tolerance_m: 1.0, ..TrialOptions::default() };
    let mut listeners = [Listener::default(), Listener::default()];
    for (mission, listener) in [planned.chain_mission(), planned.mission()].into_iter().zip(&mut listeners) {
        Simulation::new(&mission, errors.clone()).unwrap().run(&options, listener, &()).unwrap();
    }
    let [chain, map] = listeners;
    let start = planned.path.hops[0].takeoff.map().unwrap();
    let (mut same, mut different, mut off_plan) = (0, 0, 0);
    for trial in 0..150 {
        let of = |listener: &Listener| listener.hops.iter().filter(|hop| hop.trial == trial).copied().collect::<Vec<_>>();
        let (on_chain, on_map) = (of(&chain), of(&map));
        let agree = on_chain.len() == on_map.len()
            && on_chain.iter().zip(&on_map).all(|(a, b)| ((b.contact_m.xy() - start).norm() - a.contact_m.x).abs() < 1e-6);
        let counted = if agree { &mut same } else { &mut different };
        *counted += 1;
        off_plan += on_map.len().saturating_sub(1);
    }
    // Nodes whose costs differ only in the last digit may be chosen either way.
    assert!(different <= 3 && off_plan > 300, "{same} trials the same, {different} different, {off_plan} hops replanned");
}
