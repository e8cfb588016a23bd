//! The tapered clearance: it does not depend on how the ground is divided, and it is the one that densely simulated arcs keep.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use crate::support::{Draw, line, uniform};
use chta::{
    ballistics::{TakeoffChoice, limits::ClearanceProfile},
    chain::{ConstrainedChain, PolygonalChain, Station},
    graph::{Edge, HopGraph, Leg, NodeSet},
    hop::{HopTest, Split},
    path::{HopPath, ViolatedLimit, execute, generate},
    quantity::{Angle, ChainPoint, MapPoint, SlopeInterval},
    terrain::{read_dem, slice},
    world::{ClearanceRule, Direction, FrictionCone, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties},
};

/// The tolerance of a window's end when the ground is divided, degrees.
const SAME_DEG: f64 = 1e-9;

/// The same line with more vertices: on it, at random, next to others, at the kinks of the clearance, and at given x.
///
/// A height rounds: a segment much shorter than `least_m` would have another slope, and its cones another angle.
fn divided(draw: &mut Draw, points: &[ChainPoint], wanted_m: &[f64], least_m: f64) -> Vec<ChainPoint> {
    let mut found = vec![points[0]];
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let run = b.x_m - a.x_m;
        let mut places: Vec<f64> = (0..draw.below(4)).map(|_| a.x_m + run * draw.unit()).collect();
        if draw.chance(0.3) {
            places.push(a.x_m + run * draw.log_uniform(1e-6, 1e-2));
        }
        places.extend(wanted_m);
        places.retain(|x| a.x_m < *x && *x < b.x_m);
        places.sort_by(f64::total_cmp);
        places.dedup();
        let slope = (b.z_m - a.z_m) / run;
        // From the nearer end, as a station's height.
        let height = |x: f64| if x - a.x_m <= b.x_m - x { a.z_m + slope * (x - a.x_m) } else { b.z_m - slope * (b.x_m - x) };
        let mut last_m = a.x_m;
        for x in places {
            if x - last_m > least_m && b.x_m - x > least_m {
                found.push(ChainPoint::new(x, height(x)));
                last_m = x;
            }
        }
        found.push(b);
    }
    found
}

/// Rough ground with walls and short segments, near the origin so that its digits suffice for the tolerance.
fn ground(draw: &mut Draw) -> Vec<ChainPoint> {
    let mut points = vec![ChainPoint::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0))];
    for i in 0..2 + draw.below(7) {
        let (run, rise) = match draw.below(8) {
            // A wall, up or down; a very short segment; level ground.
            0 => (0.02, draw.sign() * draw.uniform(0.1, 1.0)),
            1 => (draw.log_uniform(1e-3, 1e-1), 0.0),
            2 => (draw.uniform(0.5, 30.0), 0.0),
            _ => {
                let run = draw.uniform(0.5, 30.0);
                (run, run * draw.uniform(-0.6, 0.6))
            }
        };
        points.push(ChainPoint::new(points[i].x_m + run, points[i].z_m + rise));
    }
    points
}

/// A clearance from none to 50 m, with a taper from 0.05 to 20.
fn clearance(draw: &mut Draw) -> HopperLimits {
    let clearance_m = match draw.below(4) {
        0 => draw.log_uniform(0.01, 1.0),
        1 => 5.0,
        _ => draw.log_uniform(0.1, 50.0),
    };
    let taper = if draw.chance(0.3) { 0.5 } else { draw.log_uniform(0.05, 20.0) };
    HopperLimits { clearance_m, clearance_rule: ClearanceRule::Tapered(taper), ..HopperLimits::UNLIMITED }
}

fn test_of(points: &[ChainPoint], limits: HopperLimits, speed: f64) -> HopTest {
    let chain = uniform(points, line((-80.0, 89.9), speed, (-89.9, 80.0), speed));
    HopTest::new(chain.with_hopper(&Hopper::new(limits).unwrap(), Gravity::new(1.6).unwrap()).unwrap())
}

/// A window in degrees; both ends are one angle apart at most from those of another.
fn degrees(test: &HopTest, from: &Station, to: &Station) -> Result<[f64; 2], Limit> {
    let b = test.line_of_sight(from, to).unwrap().slope();
    test.lofts(from, to).map(|lofts| [lofts.lower, lofts.upper].map(|loft| Angle::from_slope(b + loft).degrees()))
}

fn by_terrain(test: &HopTest, from: &Station, to: &Station) -> SlopeInterval {
    let set = test.takeoff_set(from, to).unwrap();
    set.limits().iter().find(|limit| limit.limit == Limit::Terrain).unwrap().lofts
}

#[test]
fn dividing_the_ground_changes_no_window() {
    let draw = &mut Draw::seeded(1401);
    let (mut pairs, mut windows, mut by_ground, mut at_kinks, mut short, mut worst) = (0, 0, 0, 0, 0, 0.0f64);
    for _ in 0..4000 {
        let points = ground(draw);
        let limits = clearance(draw);
        let (first_m, last_m) = (points[0].x_m, points[points.len() - 1].x_m);
        let profile = ClearanceProfile::of(&limits);
        let (a, b) = (draw.uniform(first_m, last_m), draw.uniform(first_m, last_m));
        let (from_m, to_m) = if draw.chance(0.5) { (points[draw.below(points.len())].x_m, b) } else { (a, b) };
        let run = (to_m - from_m).abs();
        if run < 0.1 {
            continue;
        }
        let speed = (1.6 * run * draw.log_uniform(1.0, 30.0)).sqrt();
        let whole = test_of(&points, limits, speed);
        let kink = profile.kink_m(run) * (to_m - from_m).signum();
        let wanted = if draw.chance(0.5) { vec![from_m + kink, to_m - kink, from_m, to_m] } else { Vec::new() };
        let cut = test_of(&divided(draw, &points, &wanted, 1e-3), limits, speed);
        let at = |test: &HopTest| [from_m, to_m].map(|x| test.chain().geometry().station(x).unwrap());
        let ([from, to], [cut_from, cut_to]) = (at(&whole), at(&cut));
        pairs += 1;
        short += u32::from(run < 2.0 * profile.ramp_m());
        // The terrain by itself, whether or not other limits leave an arc.
        let slope = whole.line_of_sight(&from, &to).unwrap().slope();
        let [one, other] = [by_terrain(&whole, &from, &to), by_terrain(&cut, &cut_from, &cut_to)]
            // Below the line of sight there is no arc, and nothing to compare.
            .map(|lofts| Angle::from_slope(slope + lofts.lower.max(0.0)).degrees());
        let apart = (one - other).abs();
        worst = worst.max(apart);
        assert!(apart <= SAME_DEG, "{apart} deg apart: {one} and {other}, {limits:?}, from {from_m} to {to_m} over {points:?}");
        let (found, again) = (degrees(&whole, &from, &to), degrees(&cut, &cut_from, &cut_to));
        match (found, again) {
            (Ok(found), Ok(again)) => {
                let apart = found.iter().zip(again).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(apart <= SAME_DEG, "{apart} deg apart: {found:?} and {again:?}, {limits:?}");
                windows += 1;
                let binding = whole.takeoff_set(&from, &to).unwrap().binding().unwrap().lower;
                by_ground += u32::from(binding.limit == Limit::Terrain);
                at_kinks += u32::from(binding.kink_x_m.is_some());
            }
            (Err(found), Err(again)) => assert_eq!(found, again),
            _ => panic!("{found:?} and {again:?}: {limits:?}, from {from_m} to {to_m}"),
        }
    }
    assert!(
        pairs > 3000 && windows > 900 && by_ground > 400 && at_kinks > 200 && short > 1000,
        "{pairs} pairs, {windows} windows, {by_ground} by the ground, {at_kinks} at kinks, {short} short; {worst} deg"
    );
}

/// The rule of the paper does depend on it: the property above would notice.
#[test]
fn dividing_the_ground_changes_windows_under_the_rule_of_vertices() {
    let limits = HopperLimits { clearance_m: 1.0, clearance_rule: ClearanceRule::Vertex, ..HopperLimits::UNLIMITED };
    let level = |count: u32| (0..=count).map(|i| ChainPoint::new(20.0 * f64::from(i) / f64::from(count), 0.0)).collect::<Vec<_>>();
    let least = |count| {
        let test = test_of(&level(count), limits, 9.0);
        let [from, to] = [0.0, 20.0].map(|x| test.chain().geometry().station(x).unwrap());
        degrees(&test, &from, &to).unwrap()[0]
    };
    assert!(least(20) > least(1) + 10.0, "{} and {}", least(1), least(20));
}

/// Fewest hops over the same nodes with single hops alone, by breadth-first search.
fn fewest(test: &HopTest, nodes_m: &[f64]) -> Vec<Option<u32>> {
    let stations: Vec<_> = nodes_m.iter().map(|x| test.chain().geometry().station(*x).unwrap()).collect();
    let mut hops = vec![None; stations.len()];
    hops[0] = Some(0);
    let mut layer = vec![0];
    let mut count = 0;
    while !layer.is_empty() {
        count += 1;
        let mut next = Vec::new();
        for (i, to) in stations.iter().enumerate() {
            if hops[i].is_none() && layer.iter().any(|from: &usize| *from != i && test.lofts(&stations[*from], to).is_ok()) {
                next.push(i);
            }
        }
        for i in &next {
            hops[*i] = Some(count);
        }
        layer = next;
    }
    hops
}

#[test]
fn dividing_the_ground_changes_no_number_of_single_hops() {
    let draw = &mut Draw::seeded(1402);
    let (mut reached, mut far) = (0, 0);
    for _ in 0..150 {
        let points = ground(draw);
        let limits = clearance(draw);
        let (first_m, last_m) = (points[0].x_m, points[points.len() - 1].x_m);
        let mut nodes: Vec<f64> = (0..14).map(|_| draw.uniform(first_m, last_m)).chain(points.iter().map(|p| p.x_m)).collect();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup_by(|a, b| *a - *b < 1e-3);
        let speed = (1.6 * (last_m - first_m) * draw.log_uniform(0.2, 2.0)).sqrt();
        let (whole, cut) = (test_of(&points, limits, speed), test_of(&divided(draw, &points, &[], 1e-3), limits, speed));
        let (found, again) = (fewest(&whole, &nodes), fewest(&cut, &nodes));
        assert_eq!(found, again, "{limits:?} over {points:?}");
        reached += found.iter().flatten().count();
        far += found.iter().flatten().filter(|hops| **hops > 1).count();
    }
    assert!(reached > 600 && far > 100, "{reached} reached, {far} by several hops");
}

/// Where the arc of a loft is lowest over the ground with its clearance: at many points, without a closed form.
fn lowest_over(test: &HopTest, from: &Station, to: &Station, loft: f64, steps: u32) -> f64 {
    let geometry = test.chain().geometry();
    let limits = test.hopper().limits();
    let taper = limits.clearance_rule.taper().unwrap();
    let run = to.point.x_m - from.point.x_m;
    let slope = (to.point.z_m - from.point.z_m) / run.abs() + loft;
    (1..steps)
        .map(|i| {
            let d = run.abs() * f64::from(i) / f64::from(steps);
            let e = run.abs() - d;
            let ground = geometry.station(from.point.x_m + d * run.signum()).unwrap().point.z_m;
            // Newton: z = m d - (loft / X) d^2.
            let arc = from.point.z_m + slope * d - loft / run.abs() * d * d;
            (arc - ground - limits.clearance_m.min(taper * d).min(taper * e)) / (d * e / run.abs())
        })
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn the_least_loft_is_the_one_that_dense_samples_of_the_arc_ask_for() {
    let draw = &mut Draw::seeded(1403);
    let mut compared = 0;
    for _ in 0..600 {
        let points = ground(draw);
        let limits = clearance(draw);
        let test = test_of(&points, limits, 100.0);
        let (first_m, last_m) = (points[0].x_m, points[points.len() - 1].x_m);
        let [from, to] = [0, 1].map(|_| test.chain().geometry().station(draw.uniform(first_m, last_m)).unwrap());
        let run = (to.point.x_m - from.point.x_m).abs();
        if run < 1.0 {
            continue;
        }
        let loft = by_terrain(&test, &from, &to).lower;
        if loft <= 0.0 {
            continue;
        }
        // The arc keeps the clearance at every sample; by the excess over it divided by d e / X, the loft by which it is too high.
        let lowest = lowest_over(&test, &from, &to, loft, 4000);
        assert!(lowest >= -1e-9 * (1.0 + loft), "{lowest} below the clearance");
        // Samples next to the point where it touches: within a step, slopes change the height by their difference.
        let steep = points.windows(2).map(|p| ((p[1].z_m - p[0].z_m) / (p[1].x_m - p[0].x_m)).abs()).fold(1.0, f64::max);
        if steep < 2.0 && ClearanceProfile::of(&limits).kink_m(run) > 0.005 * run {
            assert!(lowest <= 0.1 * (1.0 + loft), "{lowest} above the clearance everywhere");
            compared += 1;
        }
    }
    assert!(compared > 100, "{compared}");
}

/// Two kinks on flat ground by hand: eps = 2 m, k = 0.5, so 4 m ramps.
#[test]
fn flat_ground_asks_for_what_a_hand_calculation_gives() {
    let limits = HopperLimits { clearance_m: 2.0, ..HopperLimits::UNLIMITED };
    let test = test_of(&[ChainPoint::new(0.0, 0.0), ChainPoint::new(100.0, 0.0)], limits, 50.0);
    let at = |x| test.chain().geometry().station(x).unwrap();
    for (from, to, loft, kink) in [
        // 2 k up to 8 m; k / (1 - 4 / X) beyond: 16 m give 2/3, and at 4 m the arc is (2/3) 4 12 / 16 = 2 m high.
        (0.0, 1.0, 1.0, 0.5),
        (0.0, 8.0, 1.0, 4.0),
        (0.0, 16.0, 0.5 / 0.75, 4.0),
        (90.0, 10.0, 0.5 / 0.95, 86.0),
    ] {
        let set = test.takeoff_set(&at(from), &at(to)).unwrap();
        let limit = *set.limits().iter().find(|limit| limit.limit == Limit::Terrain).unwrap();
        assert!((limit.lofts.lower - loft).abs() < 1e-15, "{from} to {to}: {limit:?}");
        assert!(limit.vertex.is_none() && (limit.kink_x_m.unwrap() - kink).abs() < 1e-12, "{limit:?}");
        assert_eq!(test.lofts(&at(from), &at(to)).unwrap().lower, limit.lofts.lower);
    }
}

/// Slices of two real DEMs: the same windows between the same points before and after more vertices, and the answers of issue 14:
/// three more vertices a segment doubled the hops under the rule of vertices.
#[test]
fn windows_over_real_ground_do_not_depend_on_its_vertices() {
    let draw = &mut Draw::seeded(1404);
    for (name, g, clearance_m) in
        [("hirise_DTEEC_010228_1490_crop_120x70.tif", 3.711, 1.0), ("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", 1.62, 5.0)]
    {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(name);
        if !path.exists() {
            eprintln!("skipped: {} is absent", path.display());
            continue;
        }
        let dem = read_dem(&path).unwrap();
        let (nw, se) = (dem.georeference().post(0, 0), dem.georeference().post(dem.rows() - 1, dem.cols() - 1));
        let at = |u: f64, v: f64| MapPoint::new(nw.x + u * (se.x - nw.x), nw.y + v * (se.y - nw.y));
        let profile = slice(&dem, at(0.1, 0.2), at(0.5, 0.6)).unwrap();
        let points: Vec<ChainPoint> = profile.points.iter().map(|p| ChainPoint::new(p.x_m, p.z_m)).take(150).collect();
        let hopper = Hopper::new(HopperLimits { clearance_m, ..HopperLimits::with_speeds(13.0, 13.0) }).unwrap();
        let grip = Some(Grip::Friction(FrictionCone::new(0.9).unwrap()));
        let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
        let test = |points: Vec<ChainPoint>| {
            let chain = PolygonalChain::bare(points).unwrap();
            HopTest::new(ConstrainedChain::new(chain, &hopper, Gravity::new(g).unwrap(), &surface).unwrap())
        };
        let (whole, cut) = (test(points.clone()), test(divided(draw, &points, &[], 0.05)));
        let mut compared = 0;
        for (i, from) in points.iter().enumerate().step_by(3) {
            for to in points.iter().skip(i % 2).step_by(4).filter(|to| to.x_m != from.x_m) {
                let ends = |test: &HopTest| [from.x_m, to.x_m].map(|x| test.chain().geometry().station(x).unwrap());
                let ([a, b], [c, d]) = (ends(&whole), ends(&cut));
                match (degrees(&whole, &a, &b), degrees(&cut, &c, &d)) {
                    (Ok(found), Ok(again)) => {
                        let apart = found.iter().zip(again).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                        assert!(apart <= SAME_DEG, "{name}: {apart} deg apart, {found:?} and {again:?}");
                        compared += 1;
                    }
                    (found, again) => assert_eq!(found.is_ok(), again.is_ok(), "{name}: {from:?} to {to:?}"),
                }
            }
        }
        assert!(compared > 200, "{name}: {compared} windows");
    }
}

/// Every hop of a split passes the hop test and the checker, and a flatter one is caught by it.
#[test]
fn hops_along_a_segment_keep_the_clearance_and_flatter_ones_are_caught() {
    let draw = &mut Draw::seeded(1405);
    let (mut splits, mut caught, mut with_shortest, mut refused) = (0, 0, 0, 0);
    for _ in 0..3000 {
        let (run, slope) = (draw.uniform(20.0, 300.0), draw.uniform(-0.7, 0.7));
        let mut limits = HopperLimits { takeoff_angle_max: Some(Angle::from_degrees(draw.uniform(25.0, 89.0))), ..clearance(draw) };
        if draw.chance(0.3) {
            limits.apex_height_max_m = Some(draw.uniform(0.1, 0.5) * run);
        }
        let speed = (1.6 * run * draw.log_uniform(0.05, 0.7)).sqrt();
        let points = [ChainPoint::new(0.0, 0.0), ChainPoint::new(run, slope * run)];
        let test = test_of(&points, limits, speed);
        let (mut from, mut to) =
            (test.chain().geometry().station(0.0).unwrap(), test.chain().geometry().station(run * draw.uniform(0.3, 1.0)).unwrap());
        if draw.chance(0.5) {
            std::mem::swap(&mut from, &mut to);
        }
        let direction = Direction::between(from.point.x_m, to.point.x_m).unwrap();
        let distance = (to.point.x_m - from.point.x_m).abs();
        let Some(along) = test.segment_hops(&from, &to) else {
            refused += 1;
            // No number of equal hops does it either.
            for hops in 1..60 {
                let length = distance / f64::from(hops);
                let landing = test.chain().geometry().station(from.point.x_m + direction.sign() * length).unwrap();
                if landing.point.x_m != from.point.x_m {
                    assert!(test.lofts(&from, &landing).is_err(), "{hops} hops of {length} m are possible: {limits:?}");
                }
            }
            continue;
        };
        with_shortest += u32::from(along.reach().shortest_m() > 0.0);
        if along.hops() > 60 {
            continue;
        }
        // Fewer equal hops are not possible.
        for hops in 1..along.hops() {
            let length = distance / f64::from(u32::try_from(hops).unwrap());
            let landing = test.chain().geometry().station(from.point.x_m + direction.sign() * length).unwrap();
            assert!(test.lofts(&from, &landing).is_err(), "{hops} hops are enough, {} given: {limits:?}", along.hops());
        }
        for split in Split::ALL {
            let leg = Leg { takeoff: from, landing: to, edge: Edge::Along(along), loft: None };
            let path = generate(&test, &[leg], TakeoffChoice::LeastSpeed, split).unwrap();
            for hop in &path.hops {
                let [a, b] = [hop.takeoff, hop.landing].map(|contact| contact.station.unwrap());
                assert!(test.lofts(&a, &b).is_ok(), "a hop of {} m is refused: {limits:?} {:?}", hop.run_m(), along);
            }
            let flown = execute(test.chain(), &path, Some((from, to)));
            assert!(flown.passes(), "{:?}", flown.violations);
            splits += 1;
            // The same hops at an angle at which they are too low.
            let hop = path.hops[0];
            let [a, b] = [hop.takeoff, hop.landing].map(|contact| contact.station.unwrap());
            let sight = test.line_of_sight(&a, &b).unwrap();
            let low = chta::ballistics::Arc::new(sight, 0.99 * by_terrain(&test, &a, &b).lower, 1.6);
            let spoiled = chta::path::Hop {
                takeoff_angle: low.takeoff_angle(),
                takeoff_speed_m_s: low.takeoff_speed_m_s(),
                landing_angle: low.landing_angle(),
                landing_speed_m_s: low.landing_speed_m_s(),
                flight_time_s: low.flight_time_s(),
                ..hop
            };
            let path = HopPath::of_hops(vec![spoiled], test.hopper());
            let flown = execute(test.chain(), &path, Some((a, b)));
            assert!(flown.violations.iter().any(|v| v.limit == ViolatedLimit::Limit(Limit::Terrain)), "{:?}", flown.violations);
            caught += 1;
        }
    }
    assert!(
        splits > 1000 && caught > 1000 && with_shortest > 50 && refused > 100,
        "{splits} splits, {caught} caught, {with_shortest} with a shortest hop, {refused} refused"
    );
}

/// A graph's edges along a segment are those hops.
#[test]
fn an_edge_along_a_segment_respects_the_shortest_hop() {
    // Flat, at most 40 degrees: tan 40 = 0.839 < 2 k = 1, so hops are at least w n / (n - k) long, w = 4 m.
    let limits = HopperLimits { clearance_m: 2.0, takeoff_angle_max: Some(Angle::from_degrees(40.0)), ..HopperLimits::UNLIMITED };
    let test = test_of(&[ChainPoint::new(0.0, 0.0), ChainPoint::new(100.0, 0.0)], limits, f64::sqrt(1.6 * 20.0));
    let n = f64::tan(f64::to_radians(40.0));
    let shortest = 4.0 * n / (n - 0.5);
    let reach = test.segment_reach(chta::quantity::SegmentId(0), Direction::Forward).unwrap();
    assert!((reach.shortest_m() / shortest - 1.0).abs() < 1e-8, "{} m, expected {shortest} m", reach.shortest_m());
    // sin 80 deg of v^2 / g.
    let longest = 20.0 * f64::sin(f64::to_radians(80.0));
    assert!((reach.reach_m() / longest - 1.0).abs() < 1e-8, "{} m", reach.reach_m());
    // One hop from 9.9 to 19.7 m, two from 19.8 to 39.4; nothing below 9.9 m.
    let hops = |run: f64| reach.hops_over(run).map(|along| along.hops());
    for (run, expected) in [(9.0, None), (12.0, Some(1)), (19.5, Some(1)), (19.75, None), (21.0, Some(2)), (50.0, Some(3))] {
        assert_eq!(hops(run), expected, "{run} m");
    }
    let at = |x| test.chain().geometry().station(x).unwrap();
    let nodes = NodeSet::of_chain(test.chain(), chta::graph::PointSpacing::PerSegment(0)).unwrap();
    let graph = HopGraph::new(&test, &nodes, chta::graph::Effort::Energy, TakeoffChoice::LeastSpeed, Split::FullReach);
    assert_eq!(graph.edge(&at(0.0), &at(50.0)).map(|edge| edge.hops()), Ok(3));
    assert_eq!(graph.edge(&at(0.0), &at(9.0)), Err(Limit::Terrain));
}
