//! The sweep against the hop test pair by pair: the same verdict and lofts everywhere, on random, adversarial and real ground.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::sync::Arc;

use crate::support::{Draw, explicit, line, uniform};
use chta::{
    chain::{ConstrainedChain, LineConstraints, PolygonalChain, Station},
    ground::{LandingTable, Sweep},
    hop::HopTest,
    quantity::{Angle, ChainPoint, MapPoint, VertexId},
    terrain::slice,
    world::{ClearanceRule, Direction, FrictionCone, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties},
};

/// The counts of a comparison of many pairs.
#[derive(Debug, Default)]
struct Compared {
    pairs: u64,
    feasible: u64,
    /// Feasible pairs whose lower end is set by the terrain.
    over_ground: u64,
    /// Feasible pairs whose lofts are not bit-identical.
    unlike: u64,
    by_limit: [u64; Limit::ALL.len()],
}

impl Compared {
    fn refused_by(&self, limit: Limit) -> u64 {
        self.by_limit[limit.index()]
    }
}

/// Every vertex, points inside every segment, and some just beside vertices.
fn stations(chain: &ConstrainedChain, inside: u32) -> Vec<Station> {
    let geometry = chain.geometry();
    let mut found = Vec::new();
    for (i, pair) in geometry.vertices().windows(2).enumerate() {
        found.push(geometry.vertex_station(VertexId(i)));
        let run_m = pair[1].x_m - pair[0].x_m;
        found.extend((1..=inside).map(|j| geometry.station(pair[0].x_m + run_m * f64::from(j) / f64::from(inside + 1)).unwrap()));
    }
    found.push(geometry.vertex_station(VertexId(geometry.segment_count())));
    found.sort_by(|a, b| a.point.x_m.total_cmp(&b.point.x_m));
    found.dedup_by(|a, b| a.point.x_m == b.point.x_m);
    found
}

/// Sweeps from every station (or some of many) in both directions and runs the hop test for each pair as well.
fn compare(test: &HopTest, stations: &[Station], most_takeoffs: usize, compared: &mut Compared) {
    let table = Arc::new(LandingTable::new(test, stations));
    let mut sweep = Sweep::new(Arc::clone(&table));
    let stride = stations.len().div_ceil(most_takeoffs);
    for (from, takeoff) in stations.iter().enumerate().step_by(stride) {
        for direction in Direction::BOTH {
            let mut visited = Vec::new();
            sweep.landings(takeoff, 0..stations.len(), direction, |i, verdict| {
                visited.push(i);
                compare_pair(test, takeoff, &stations[i], verdict, compared);
            });
            let expected: Vec<usize> = match direction {
                Direction::Forward => (from + 1..stations.len()).collect(),
                Direction::Reverse => (0..from).rev().collect(),
            };
            assert_eq!(visited, expected, "every landing must be visited once, nearest first");
        }
    }
}

fn compare_pair(
    test: &HopTest,
    takeoff: &Station,
    landing: &Station,
    swept: Result<chta::quantity::SlopeInterval, Limit>,
    compared: &mut Compared,
) {
    let plain = test.lofts(takeoff, landing);
    compared.pairs += 1;
    match (swept, plain) {
        (Err(swept), Err(plain)) => {
            assert_eq!(swept, plain, "{takeoff:?} to {landing:?}");
            compared.by_limit[plain.index()] += 1;
        }
        (Ok(swept), Ok(plain)) => {
            compared.feasible += 1;
            compared.unlike += u64::from(swept != plain);
            let b = test.line_of_sight(takeoff, landing).unwrap().slope();
            let apart = |a: f64, c: f64| (Angle::from_slope(b + a).radians() - Angle::from_slope(b + c).radians()).abs();
            let sight = test.line_of_sight(takeoff, landing).unwrap();
            let windows = |lofts| test.windows(sight, lofts).map(|window| (window.lower, window.upper)).collect::<Vec<_>>();
            assert_eq!(windows(swept), windows(plain), "{takeoff:?} to {landing:?}");
            assert!(apart(swept.lower, plain.lower) <= 1e-9 && apart(swept.upper, plain.upper) <= 1e-9, "{swept:?}, {plain:?}");
            let vertex = test.takeoff_set(takeoff, landing).unwrap().binding().unwrap().lower.limit;
            compared.over_ground += u64::from(vertex == Limit::Terrain);
        }
        _ => panic!("{takeoff:?} to {landing:?}: {swept:?} by sweep, {plain:?} pair by pair"),
    }
}

fn some_hopper(draw: &mut Draw, size_m: f64, g: f64) -> Hopper {
    let reach_s = (size_m / g).sqrt();
    let mut limits = HopperLimits {
        clearance_m: if draw.chance(0.5) { 0.0 } else { size_m * draw.log_uniform(1e-4, 1.0) },
        clearance_rule: draw.clearance_rule(),
        takeoff_angle_min: draw.chance(0.2).then(|| Angle::from_degrees(draw.uniform(-20.0, 50.0))),
        takeoff_angle_max: draw.chance(0.2).then(|| Angle::from_degrees(draw.uniform(50.0, 89.0))),
        apex_height_max_m: draw.chance(0.2).then(|| size_m * draw.log_uniform(0.1, 10.0)),
        flight_time_max_s: draw.chance(0.2).then(|| reach_s * draw.log_uniform(0.3, 10.0)),
        ..HopperLimits::UNLIMITED
    };
    draw.commands(&mut limits, (size_m * g).sqrt());
    Hopper::new(limits).unwrap()
}

#[test]
fn random_chains_with_bends_have_the_verdicts_of_the_hop_test() {
    let draw = &mut Draw::seeded(401);
    let stands = &mut Draw::seeded(402);
    let mut compared = Compared::default();
    for _ in 0..200 {
        let (g, size_m) = (draw.gravity(), draw.log_uniform(1e-1, 1e2));
        let segments = 2 + draw.below(40);
        let points = draw.profile(segments, size_m);
        let speed = (g * size_m * draw.log_uniform(0.5, 60.0)).sqrt();
        let lines: Vec<_> = (0..segments).map(|_| (draw.line(speed), draw.line(speed))).collect();
        let straight = explicit(&points, &lines, RestSlope::Unlimited);
        let bends = (1..segments).filter(|_| draw.chance(0.01)).map(VertexId).collect();
        let bent = straight.geometry().clone().with_bends(bends).unwrap();
        let chain = ConstrainedChain::new(bent, &Hopper::UNLIMITED, Gravity::new(g).unwrap(), &crate::support::NO_SURFACE).unwrap();
        let mut limits = *some_hopper(draw, size_m, g).limits();
        if stands.chance(0.25) {
            let (first_m, last_m) = chain.geometry().extent_m();
            let footprint_m = (last_m - first_m) * stands.log_uniform(1e-4, 0.05);
            limits.footprint_m = Some(footprint_m);
            limits.roughness_max_m = Some(footprint_m * stands.log_uniform(1e-2, 1.0));
        }
        let hopper = Hopper::new(limits).unwrap();
        let test = HopTest::new(chain.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap());
        let inside = u32::try_from(draw.below(4)).unwrap();
        compare(&test, &stations(&chain, inside), 12, &mut compared);
    }
    assert_eq!(compared.unlike, 0, "{compared:?}");
    assert!(compared.over_ground > 500 && compared.feasible > 2500, "{compared:?}");
    let spoken = Limit::ALL.into_iter().filter(|limit| compared.refused_by(*limit) > 10).count();
    assert!(spoken >= 9, "{compared:?}");
}

/// The adversarial grounds of issue and model, with their names.
fn adversaries(draw: &mut Draw) -> Vec<(&'static str, Vec<ChainPoint>)> {
    let along = |n: usize, height: &mut dyn FnMut(f64) -> f64| -> Vec<ChainPoint> {
        (0..=n).map(|i| f64::from(u32::try_from(i).unwrap())).map(|x| ChainPoint::new(x, height(x))).collect()
    };
    let mut beside = along(120, &mut |_| 0.0);
    beside[60].x_m = beside[59].x_m + 1e-9;
    beside[60].z_m = draw.uniform(-1e-9, 1e-9);
    let mut cliff_ahead = along(120, &mut |_| draw.uniform(-0.05, 0.05));
    cliff_ahead[60].x_m = cliff_ahead[59].x_m + 1e-9;
    cliff_ahead[60].z_m = 3.0;
    let phase = draw.unit();
    vec![
        ("sawtooth", along(200, &mut |x| if x % 2.0 == 0.0 { 0.0 } else { 0.8 })),
        ("growing sawtooth", along(200, &mut |x| if x % 2.0 == 0.0 { 0.0 } else { 0.01 * x })),
        ("bowl", along(200, &mut |x| 0.002 * (x - 100.0 + phase) * (x - 100.0 + phase))),
        ("hill", along(200, &mut |x| -0.002 * (x - 100.0 + phase) * (x - 100.0 + phase))),
        ("steep hill", along(200, &mut |x| -0.05 * (x - 100.0 + phase) * (x - 100.0 + phase))),
        ("needle", along(200, &mut |x| if x == 100.0 { 30.0 } else { 0.0 })),
        ("plateau", along(200, &mut |x| if (50.0..150.0).contains(&x) { 7.0 } else { 0.0 })),
        ("equal slopes", along(200, &mut |x| 0.3 * x)),
        ("equal slopes and a step", along(200, &mut |x| 0.3 * x + if x > 120.0 { 2.0 } else { 0.0 })),
        ("two planes", along(200, &mut |x| -0.7 * (x - 90.0).max(0.0))),
        ("canyon", along(200, &mut |x| if (80.0..130.0).contains(&x) { -60.0 } else { 0.0 })),
        ("stairs", along(200, &mut |x| (x / 10.0).floor() * 4.0)),
        ("noise", along(300, &mut |_| draw.uniform(-1.0, 1.0))),
        ("noise on a hill", along(300, &mut |x| 20.0 * (x / 40.0).sin() + draw.uniform(-0.3, 0.3))),
        ("a vertex 1e-9 m ahead", beside),
        ("a wall 1e-9 m ahead", cliff_ahead),
    ]
}

#[test]
fn adversarial_ground_has_the_verdicts_of_the_hop_test() {
    let draw = &mut Draw::seeded(402);
    let open = |speed| line((-90.0, 90.0), speed, (-90.0, 90.0), speed);
    let steep = |speed| line((55.0, 90.0), speed, (-90.0, -40.0), speed);
    for g in [1e-5, 3.711, 25.0_f64] {
        for (name, points) in adversaries(draw) {
            let mut compared = Compared::default();
            for (clearance_m, clearance_rule, reach_m) in [
                (0.0, ClearanceRule::TAPERED, 60.0),
                (0.05, ClearanceRule::Vertex, 400.0),
                (0.05, ClearanceRule::TAPERED, 400.0),
                (5.0, ClearanceRule::TAPERED, 400.0),
                (0.0, ClearanceRule::TAPERED, 4000.0),
            ] {
                let speed = (g * reach_m).sqrt();
                let kinds: [LineConstraints; 2] = [open(speed), steep(speed)];
                for kind in kinds {
                    let chain = uniform(&points, kind);
                    let hopper = Hopper::new(HopperLimits { clearance_m, clearance_rule, ..HopperLimits::UNLIMITED }).unwrap();
                    let test = HopTest::new(chain.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap());
                    compare(&test, &stations(&chain, 0), 6, &mut compared);
                    compare(&test, &stations(&chain, 3), 2, &mut compared);
                }
            }
            assert_eq!(compared.unlike, 0, "{name}, g = {g}: {compared:?}");
            assert!(compared.feasible > 250, "{name}, g = {g}: {compared:?}");
        }
    }
}

/// Where the terrain's loft equals the greatest allowed one to the last digits, rounding decides; the sweep must agree with the hop
/// test.
#[test]
fn touching_limits_have_the_verdicts_of_the_hop_test() {
    let draw = &mut Draw::seeded(403);
    let (mut touching, mut compared) = (0, Compared::default());
    for _ in 0..150 {
        let (g, size_m) = (draw.gravity(), draw.log_uniform(1e-1, 1e2));
        let points = draw.profile(20, size_m);
        let fast = uniform(&points, line((-90.0, 90.0), (1e4 * g * size_m).sqrt(), (-90.0, 90.0), (1e6 * g * size_m).sqrt()));
        let hopper = Hopper::new(HopperLimits {
            clearance_m: 1e-3 * size_m,
            clearance_rule: draw.clearance_rule(),
            ..HopperLimits::UNLIMITED
        })
        .unwrap();
        let at = |chain: &ConstrainedChain, i| chain.geometry().vertex_station(VertexId(i));
        let (from, to) = (draw.below(5), 10 + draw.below(11));
        let roomy = HopTest::new(fast.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap());
        let Ok(lofts) = roomy.lofts(&at(&fast, from), &at(&fast, to)) else { continue };
        let slope = roomy.line_of_sight(&at(&fast, from), &at(&fast, to)).unwrap().slope() + lofts.lower;
        for nudge in -2..=2 {
            // A machine whose greatest angle just clears the ground, up to rounding.
            let steepest = Angle::from_radians(Angle::from_slope(slope).radians() * (1.0 + f64::from(nudge) * 2.0 * f64::EPSILON));
            let exact = Hopper::new(HopperLimits { takeoff_angle_max: Some(steepest), ..*hopper.limits() }).unwrap();
            let test = HopTest::new(fast.with_hopper(&exact, Gravity::new(g).unwrap()).unwrap());
            compare(&test, &stations(&fast, 0), 21, &mut compared);
            touching += u32::from(test.lofts(&at(&fast, from), &at(&fast, to)).is_ok());
        }
    }
    assert_eq!(compared.unlike, 0, "{compared:?}");
    assert!((100..600).contains(&touching), "{touching} of 750 touch from inside");
}

/// Slices of real DEMs (skipped if absent), at speeds with a long range: friction cones, rough ground, flats and walls.
#[test]
fn real_ground_has_the_verdicts_of_the_hop_test() {
    let mut compared = Compared::default();
    for (name, g, reach_m) in
        [("hirise_DTEEC_010228_1490_crop_120x70.tif", 3.711, 60.0), ("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", 1.62, 900.0)]
    {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(name);
        if !path.exists() {
            #[expect(clippy::print_stderr, reason = "a skipped test says why")]
            {
                eprintln!("skipped: {} is absent", path.display());
            }
            continue;
        }
        let dem = chta::terrain::read_dem(&path).unwrap();
        let (north_west, south_east) = (dem.georeference().post(0, 0), dem.georeference().post(dem.rows() - 1, dem.cols() - 1));
        let at = |u: f64, v: f64| {
            MapPoint::new(north_west.x + u * (south_east.x - north_west.x), north_west.y + v * (south_east.y - north_west.y))
        };
        for (from, to) in [(at(0.1, 0.2), at(0.9, 0.7)), (at(0.2, 0.9), at(0.7, 0.1))] {
            let profile = slice(&dem, from, to).unwrap();
            let chain = PolygonalChain::from_profile(&profile, None).unwrap();
            for (friction, clearance_m, clearance_rule) in [
                (0.6, 0.1, ClearanceRule::TAPERED),
                (0.6, 5.0, ClearanceRule::TAPERED),
                (20.0, 0.0, ClearanceRule::TAPERED),
                (20.0, 0.3, ClearanceRule::TAPERED),
                (20.0, 5.0, ClearanceRule::Tapered(20.0)),
                (20.0, 0.3, ClearanceRule::Vertex),
            ] {
                let speed = f64::sqrt(g * reach_m);
                let hopper =
                    Hopper::new(HopperLimits { clearance_m, clearance_rule, ..HopperLimits::with_speeds(speed, 1.5 * speed) })
                        .unwrap();
                let surface = SurfaceProperties {
                    grip: Some(Grip::Friction(FrictionCone::new(friction).unwrap())),
                    rest: RestSlope::AsFrictionHolds,
                };
                let chain = ConstrainedChain::new(chain.clone(), &hopper, Gravity::new(g).unwrap(), &surface).unwrap();
                compare(
                    &HopTest::new(chain.with_hopper(&hopper, Gravity::new(g).unwrap()).unwrap()),
                    &stations(&chain, 1),
                    12,
                    &mut compared,
                );
            }
        }
    }
    assert_eq!(compared.unlike, 0, "{compared:?}");
    assert!(compared.pairs == 0 || (compared.over_ground > 400 && compared.refused_by(Limit::Terrain) > 400), "{compared:?}");
}

/// No feasible pair exceeds the reach from its take-off or to its landing, for any relief; and the reach is not far too long.
#[test]
fn nothing_feasible_lies_beyond_reach() {
    let draw = &mut Draw::seeded(404);
    let (mut feasible, mut beyond, mut nearly) = (0, 0, 0);
    for _ in 0..100 {
        let (g, size_m) = (draw.gravity(), draw.log_uniform(1e-1, 1e2));
        let segments = 2 + draw.below(60);
        let mut points = draw.profile(segments, size_m);
        if draw.chance(0.5) {
            // A canyon whose floor is within reach from above while nearer, higher ground is not.
            let (from, to) = (draw.below(segments), draw.below(segments));
            points.iter_mut().take(to).skip(from).for_each(|p| p.z_m -= 10.0 * size_m);
        }
        let speed = (g * size_m * draw.log_uniform(0.5, 20.0)).sqrt();
        let lines: Vec<_> = (0..segments).map(|_| (draw.line(speed), draw.line(0.6 * speed))).collect();
        let chain = explicit(&points, &lines, RestSlope::Unlimited);
        let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(g).unwrap()).unwrap());
        let stations = stations(&chain, 1);
        let table = Arc::new(LandingTable::new(&test, stations.as_slice()));
        for takeoff in &stations {
            for direction in Direction::BOTH {
                let reach_m = test.landing_reach_m(takeoff, direction);
                assert!(
                    reach_m <= test.reach_bound_m(takeoff)
                        && test.reach_bound_m(takeoff) <= test.greatest_reach_m() * (1.0 + 1e-12)
                );
                let in_reach = table.in_reach(takeoff, direction);
                let ahead = stations
                    .iter()
                    .enumerate()
                    .filter(|(_, landing)| Direction::between(takeoff.point.x_m, landing.point.x_m) == Some(direction));
                for (i, landing) in ahead {
                    let run_m = (landing.point.x_m - takeoff.point.x_m).abs();
                    assert_eq!(in_reach.contains(&i), run_m <= reach_m);
                    if test.lofts(takeoff, landing).is_ok() {
                        feasible += 1;
                        assert!(run_m <= reach_m, "{run_m} m in one hop, out of a reach of {reach_m} m");
                        assert!(
                            run_m <= test.takeoff_reach_m(landing, direction),
                            "{run_m} m in one hop, beyond the reach computed at its landing"
                        );
                        nearly += u32::from(run_m > 0.5 * reach_m);
                    } else if run_m > reach_m {
                        beyond += 1;
                    }
                }
            }
        }
    }
    assert!(feasible > 6_000 && beyond > 15_000 && nearly > 300, "{feasible} feasible, {beyond} beyond, {nearly} nearly as far");
}

/// Two parabolas of safety meet at `X = v_t v_l / g`: with one speed everywhere, no relief makes the reach longer.
#[test]
fn reach_does_not_grow_with_the_chain() {
    let draw = &mut Draw::seeded(405);
    let points: Vec<ChainPoint> =
        (0..=4000).map(|i| ChainPoint::new(f64::from(i), 300.0 * f64::from(i / 100 % 7) + draw.unit())).collect();
    let chain = uniform(&points, line((-90.0, 90.0), 10.0, (-90.0, 90.0), 8.0));
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(2.0).unwrap()).unwrap());
    assert!((test.greatest_reach_m() - 40.0).abs() < 1e-6, "{} m", test.greatest_reach_m());
    // On flat ground the smaller speed decides: 64 / 2 m plus some for the roughness of 1 m.
    let flat = test.reach_bound_m(&chain.geometry().vertex_station(VertexId(50)));
    assert!((32.0..34.0).contains(&flat), "{flat} m");
}

/// A value that another language may store and pass to its threads.
const fn shareable<T: Clone + Send + Sync + 'static>() {}

const _: () = {
    shareable::<ConstrainedChain>();
    shareable::<HopTest>();
    shareable::<LandingTable>();
    shareable::<Sweep>();
};

#[test]
fn a_clone_gives_the_same_results_after_the_original_is_dropped() {
    let points: Vec<_> = (0..40).map(|i| ChainPoint::new(f64::from(i), f64::from(i % 3))).collect();
    let chain = uniform(&points, line((-90.0, 90.0), 4.0, (-90.0, 90.0), 4.0));
    let first = HopTest::new(chain.clone());
    let second = first.clone();
    assert!(std::ptr::eq(first.chain(), second.chain()), "a clone shares its chain");
    let takeoff = chain.geometry().station(7.5).unwrap();
    let reach_m = first.reach_bound_m(&takeoff);
    drop(first);
    let sweep = std::thread::spawn(move || (second.reach_bound_m(&takeoff), HopTest::new(chain).reach_bound_m(&takeoff)));
    assert_eq!(sweep.join().unwrap(), (reach_m, reach_m));
}
