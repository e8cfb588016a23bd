//! The take-off speeds that a machine can be commanded: a least speed, and levels, against arcs found by scanning angles.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use crate::support::{Draw, line, uniform};
use chta::{
    ballistics::{Arc, LineOfSight, TakeoffChoice, TakeoffSpeeds},
    chain::Station,
    graph::{Edge, Leg, PointSpacing, SearchOptions, search},
    hop::{HopTest, Split},
    path::{execute, generate},
    quantity::{ChainPoint, SlopeInterval, VertexId},
    world::{Direction, Gravity, Hopper, HopperLimits, Limit, SPEED_TOLERANCE, SpeedLevels},
};

/// The speed of the flight at an angle that passes through (run, rise), from the equation of motion.
fn speed_m_s(run_m: f64, rise_m: f64, theta: f64, g: f64) -> f64 {
    run_m / theta.cos() * (g / (2.0 * (run_m * theta.tan() - rise_m))).sqrt()
}

/// The angles between two others at which a flight through a point has a speed, by scanning and bisection.
fn scanned(run_m: f64, rise_m: f64, (from, to): (f64, f64), speed: f64, g: f64) -> Vec<f64> {
    const STEPS: u32 = 4000;
    let over = |theta: f64| speed_m_s(run_m, rise_m, theta, g) - speed;
    let at = |i: u32| from + (to - from) * f64::from(i) / f64::from(STEPS);
    let mut found = Vec::new();
    for (a, b) in (0..STEPS).map(|i| (at(i), at(i + 1))) {
        if (over(a) > 0.0) == (over(b) > 0.0) {
            continue;
        }
        let (mut a, mut b) = (a, b);
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if (over(middle) > 0.0) == (over(a) > 0.0) { a = middle } else { b = middle }
        }
        found.push(0.5 * (a + b));
    }
    found
}

#[test]
fn the_windows_of_levels_are_the_scanned_arcs_of_their_speeds() {
    let draw = &mut Draw::seeded(1401);
    let (mut compared, mut by_count) = (0, [0; 9]);
    for _ in 0..3000 {
        let (g, run) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
        let rise = run * draw.uniform(-2.0, 2.0);
        let sight = LineOfSight::new(run, rise);
        let least = (g * run * sight.min_speed_ratio()).sqrt();
        let mut levels: Vec<f64> = (0..=draw.below(3)).map(|_| least * draw.uniform(0.8, 2.0)).collect();
        levels.sort_by(f64::total_cmp);
        let Ok(speeds) = SpeedLevels::new(&levels) else { continue };
        // An interval that the other limits leave.
        let (low, high) = (sight.angle().radians() + 1e-3, std::f64::consts::FRAC_PI_2 - 1e-3);
        let (a, b) = (draw.uniform(low, high), draw.uniform(low, high));
        let (from, to) = (a.min(b), a.max(b));
        let lofts = SlopeInterval { lower: from.tan() - sight.slope(), upper: to.tan() - sight.slope() };
        let close = |theta: f64| (theta - from).abs() < 1e-6 || (theta - to).abs() < 1e-6;
        let mut expected: Vec<f64> = levels.iter().flat_map(|level| scanned(run, rise, (low, high), *level, g)).collect();
        if expected.iter().any(|theta| close(*theta)) || levels.iter().any(|level| (level / least - 1.0).abs() < 1e-4) {
            continue;
        }
        expected.retain(|theta| from <= *theta && *theta <= to);
        expected.sort_by(f64::total_cmp);
        let found: Vec<_> = TakeoffSpeeds::Levels(speeds).windows(sight, lofts, g).collect();
        assert_eq!(found.len(), expected.len(), "{found:?}, scanned {expected:?}");
        for (window, theta) in found.iter().zip(&expected) {
            assert_eq!(window.lofts.lower, window.lofts.upper);
            let angle = (sight.slope() + window.lofts.lower).atan();
            assert!((angle - theta).abs() < 1e-7, "{angle} scanned at {theta}");
        }
        by_count[found.len()] += 1;
        compared += 1;
    }
    assert!(compared > 1500 && by_count[0] > 50 && by_count[1] > 200 && by_count[4] > 20, "{compared}, {by_count:?}");
}

#[test]
fn the_gap_of_a_least_speed_is_where_scanned_arcs_are_slower() {
    let draw = &mut Draw::seeded(1402);
    let mut by_count = [0; 3];
    for _ in 0..2000 {
        let (g, run) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
        let rise = run * draw.uniform(-2.0, 2.0);
        let sight = LineOfSight::new(run, rise);
        let speed = (g * run * sight.min_speed_ratio()).sqrt() * draw.uniform(0.9, 1.6);
        let (low, high) = (sight.angle().radians() + 1e-3, std::f64::consts::FRAC_PI_2 - 1e-3);
        let (a, b) = (draw.uniform(low, high), draw.uniform(low, high));
        let lofts = SlopeInterval { lower: a.min(b).tan() - sight.slope(), upper: a.max(b).tan() - sight.slope() };
        let windows: Vec<_> = TakeoffSpeeds::AtLeast(speed).windows(sight, lofts, g).collect();
        for i in 0..200 {
            let theta = a.min(b) + (a - b).abs() * (f64::from(i) + 0.5) / 200.0;
            let ratio = speed_m_s(run, rise, theta, g) / speed;
            let inside = windows.iter().any(|window| window.lofts.contains(theta.tan() - sight.slope()));
            assert!((ratio - 1.0).abs() < 1e-7 || inside == (ratio > 1.0), "{theta} with {ratio} of the least speed: {windows:?}");
        }
        by_count[windows.len()] += 1;
    }
    assert!(by_count.iter().all(|count| *count > 100), "{by_count:?}");
}

/// Planted values: on flat ground, 8 m at 10 m/s^2, the arcs of 10 m/s have the slopes 0.5 and 2.
#[test]
fn the_choices_of_an_arc_have_planted_values() {
    use TakeoffChoice::{LeastSpeed, LeastTime, MidRange};
    let (sight, g) = (LineOfSight::new(8.0, 0.0), 10.0);
    let levels = |list: &[f64]| TakeoffSpeeds::Levels(SpeedLevels::new(list).unwrap());
    let at_11 = {
        let (q, b) = (121.0 / 80.0f64, 0.0);
        let root = ((q - b) * (q - b) - 1.0).sqrt();
        [q - root, q + root]
    };
    let (whole, steep) = ((0.25, 4.0), (0.7, 4.0));
    let low_middle = (0.5 * (0.25f64.atan() + 0.5f64.atan())).tan();
    let high_middle = (0.5 * (2f64.atan() + 5f64.atan())).tan();
    let table = [
        // (speeds, interval, choice, slope)
        (TakeoffSpeeds::Any, whole, LeastSpeed, Some(1.0)),
        (TakeoffSpeeds::AtLeast(10.0), whole, LeastSpeed, Some(0.5)),
        (TakeoffSpeeds::AtLeast(10.0), steep, LeastSpeed, Some(2.0)),
        (TakeoffSpeeds::AtLeast(10.0), whole, LeastTime, Some(0.25)),
        // Both windows are equally wide as angles, since 0.25 and 4, 0.5 and 2 are complementary: the flatter one.
        (TakeoffSpeeds::AtLeast(10.0), whole, MidRange, Some(low_middle)),
        (TakeoffSpeeds::AtLeast(10.0), (0.25, 5.0), MidRange, Some(high_middle)),
        (TakeoffSpeeds::AtLeast(10.0), (0.6, 1.9), LeastSpeed, None),
        (levels(&[10.0, 11.0]), whole, LeastSpeed, Some(0.5)),
        (levels(&[10.0, 11.0]), (0.6, 4.0), LeastSpeed, Some(2.0)),
        (levels(&[10.0, 11.0]), (0.51, 1.99), LeastSpeed, None),
        (levels(&[10.0, 11.0]), whole, LeastTime, Some(at_11[0])),
        (levels(&[10.0, 11.0]), (1.0, 4.0), MidRange, Some(2.0)),
        (levels(&[10.0, 11.0]), (2.0, 4.0), MidRange, Some(at_11[1])),
        // The least speed that carries 8 m, exactly.
        (levels(&[80f64.sqrt()]), whole, LeastSpeed, Some(1.0)),
    ];
    for (speeds, (lower, upper), choice, expected) in table {
        let found = speeds.loft(choice, sight, SlopeInterval { lower, upper }, g);
        let agrees = match (found, expected) {
            (Some(found), Some(expected)) => (found - expected).abs() < 1e-7,
            (found, expected) => found == expected,
        };
        assert!(agrees, "{speeds:?} of {lower} to {upper}, {choice:?}: {found:?}, expected {expected:?}");
    }
}

/// A segment of this run and slope with these limits, and its two ends.
fn segment(
    run_m: f64,
    slope: f64,
    takeoff_deg: (f64, f64),
    speed: f64,
    limits: HopperLimits,
    g: f64,
) -> (HopTest, Station, Station) {
    let points = [ChainPoint::new(0.0, 0.0), ChainPoint::new(run_m, run_m * slope)];
    let chain = uniform(&points, line(takeoff_deg, speed, (-90.0, 90.0), speed));
    let test = HopTest::new(chain.with_hopper(&Hopper::new(limits).unwrap(), Gravity::new(g).unwrap()).unwrap());
    let geometry = test.chain().geometry();
    let ends = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(1)));
    (test, ends.0, ends.1)
}

/// Flat ground at 10 m/s^2: a take-off at slope m covers 2 v^2 m / (g (1 + m^2)).
#[test]
fn many_hops_along_a_segment_have_lengths_that_the_machine_has() {
    let at_least = |v: f64| HopperLimits { takeoff_speed_min_m_s: Some(v), ..HopperLimits::UNLIMITED };
    let levels = |list: &[f64]| HopperLimits { takeoff_speed_levels: SpeedLevels::new(list).ok(), ..HopperLimits::UNLIMITED };
    let near_45 = (40.0, 50.0);
    let exactly_45 = (45.0, 45.0);
    // Over 40 to 50 degrees 10 m/s carry 10 m at the most and 9.848 m at the least.
    let table = [
        (45.0, near_45, 10.0, HopperLimits::UNLIMITED, Some(5)),
        // Hops of 9 m or more, of at least 9.5 m/s (8.888 m at the least): 45 m are five of 9 m.
        (45.0, near_45, 10.0, at_least(9.5), Some(5)),
        // Two hops carry at most 20 m and at least 2 x 8.888 = 17.776 m, one at most 10 m.
        (17.7, near_45, 10.0, at_least(9.5), None),
        (17.8, near_45, 10.0, at_least(9.5), Some(2)),
        // Levels: 4.924 m to 5 m at sqrt 50 m/s, and 9.848 m to 10 m at 10 m/s; all hops of one run have one level here.
        (20.0, near_45, 10.0, levels(&[50f64.sqrt(), 10.0]), Some(2)),
        (14.9, near_45, 10.0, levels(&[50f64.sqrt(), 10.0]), Some(3)),
        (16.0, near_45, 10.0, levels(&[50f64.sqrt(), 10.0]), None),
        // One angle: exact multiples only.
        (30.0, exactly_45, 10.0, levels(&[10.0]), Some(3)),
        (15.0, exactly_45, 10.0, levels(&[50f64.sqrt(), 10.0]), Some(3)),
        (31.0, exactly_45, 10.0, levels(&[10.0]), None),
        // Up to the vertical every length is possible at every speed.
        (45.0, (10.0, 90.0), 10.0, levels(&[3.0, 10.0]), Some(5)),
        (0.3, (10.0, 90.0), 10.0, levels(&[10.0]), Some(1)),
    ];
    for (run_m, cone, speed, limits, expected) in table {
        let (test, from, to) = segment(run_m, 0.0, cone, speed, limits, 10.0);
        for (from, to) in [(from, to), (to, from)] {
            let found =
                test.lofts(&from, &to).map_or_else(|_| test.segment_hops(&from, &to).map(|along| along.hops()), |_| Some(1));
            assert_eq!(found, expected, "{run_m} m, {cone:?}, {limits:?}");
        }
    }
}

#[test]
fn every_hop_of_a_split_passes_the_hop_test_and_the_checker() {
    let draw = &mut Draw::seeded(1403);
    let (mut flown, mut several) = (0, 0);
    for _ in 0..4000 {
        let (g, run) = (draw.gravity(), draw.log_uniform(1e-1, 1e4));
        let speed = (g * run / draw.log_uniform(1.0, 30.0)).sqrt();
        let mut limits = HopperLimits {
            apex_height_max_m: draw.chance(0.3).then(|| speed * speed / g * draw.log_uniform(0.05, 1.0)),
            clearance_m: if draw.chance(0.3) { run * draw.log_uniform(1e-4, 1e-1) } else { 0.0 },
            ..HopperLimits::UNLIMITED
        };
        draw.commands(&mut limits, speed);
        if limits == HopperLimits::UNLIMITED {
            continue;
        }
        let cone = (draw.uniform(-30.0, 60.0), draw.uniform(60.0, 90.0));
        let slope = draw.uniform(-0.8, 0.8);
        let (test, a, b) = segment(run, slope, cone, speed, limits, g);
        let (takeoff, landing) = if draw.chance(0.5) { (a, b) } else { (b, a) };
        let Some(along) = test.segment_hops(&takeoff, &landing) else { continue };
        if along.hops() > 200 {
            continue;
        }
        several += u32::from(test.segment_reaches(takeoff.shared_segment(&landing).unwrap(), Direction::Forward).len() > 1);
        for split in Split::ALL {
            for choice in TakeoffChoice::ALL {
                let leg = Leg { takeoff, landing, edge: Edge::Along(along), loft: None };
                let path = generate(&test, &[leg], choice, split).unwrap();
                for hop in &path.hops {
                    let ends = [hop.takeoff, hop.landing].map(|at| at.station.unwrap());
                    assert!(test.lofts(&ends[0], &ends[1]).is_ok(), "{:?}, {hop:?}, {limits:?}", test.lofts(&ends[0], &ends[1]));
                    flown += 1;
                }
                let ground = chta::ground::ChainGround::new(test.clone());
                let ends = [takeoff, landing].map(chta::ground::ChainPosition::on_chain);
                let execution = execute(&ground, &path, Some((ends[0], ends[1])));
                assert!(execution.violations.is_empty(), "{:?}\n{limits:?}", execution.violations);
            }
        }
    }
    assert!(flown > 20_000 && several > 5, "{flown}, {several}");
}

/// No simulated sequence of hops along a segment is possible with fewer hops: lengths that arcs of the machine have, by scanning.
#[test]
fn lengths_that_scanned_arcs_have_lie_in_a_range_of_the_reach() {
    let draw = &mut Draw::seeded(1404);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..400 {
        let (g, run) = (draw.gravity(), draw.log_uniform(1e-1, 1e3));
        let speed = (g * run).sqrt();
        let mut limits = HopperLimits::UNLIMITED;
        draw.commands(&mut limits, speed);
        limits.apex_height_max_m = draw.chance(0.3).then(|| speed * speed / g * draw.log_uniform(0.05, 1.0));
        if TakeoffSpeeds::of(&limits).are_any() {
            continue;
        }
        let cone = (draw.uniform(-10.0, 60.0), draw.uniform(60.0, 89.0));
        let slope = draw.uniform(-0.8, 0.8);
        let (test, a, b) = segment(run, slope, cone, speed, limits, g);
        let ranges = test.segment_reaches(a.shared_segment(&b).unwrap(), Direction::Forward);
        for _ in 0..100 {
            let length = draw.log_uniform(1e-3, 1.0) * run;
            let theta = draw.uniform(cone.0.max(slope.atan().to_degrees() + 1e-3), cone.1).to_radians();
            let v = speed_m_s(length, slope * length, theta, g);
            // An arc of a level with this angle has another length.
            let level = limits.takeoff_speed_levels.map(|levels| levels.as_slice()[draw.below(levels.as_slice().len())]);
            let length = length * level.map_or(1.0, |level| (level / v).powi(2));
            let v = speed_m_s(length, slope * length, theta, g);
            let landing = (v * v - 2.0 * g * slope * length).sqrt();
            let (up, end) = (v * theta.sin() / g, length / (v * theta.cos()));
            let top = v * theta.sin() * up.clamp(0.0, end) - 0.5 * g * up.clamp(0.0, end).powi(2);
            let others = v <= speed && landing <= speed && limits.apex_height_max_m.is_none_or(|most| top <= most);
            if !others || limits.takeoff_speed_min_m_s.is_some_and(|least| v < least) {
                outside += 1;
                continue;
            }
            let hair = 1e-7 * length;
            let known = ranges.iter().any(|reach| reach.shortest_m() - hair <= length && length <= reach.reach_m() + hair);
            assert!(known, "{length} m at {theta} rad and {v} m/s: {ranges:?}\n{limits:?}");
            inside += 1;
        }
    }
    assert!(inside > 3000 && outside > 1000, "{inside}, {outside}");
}

#[test]
fn a_machine_with_more_speeds_never_needs_more_hops() {
    let draw = &mut Draw::seeded(1405);
    let mut compared = 0;
    for _ in 0..300 {
        let (g, size) = (draw.gravity(), draw.log_uniform(1e-1, 1e2));
        let points = draw.profile(4, size);
        let speed = (g * size).sqrt() * draw.log_uniform(0.7, 2.0);
        let chain = uniform(&points, line((20.0, 90.0), speed, (-90.0, -20.0), speed));
        let hops = |limits: HopperLimits| {
            let test = HopTest::new(chain.with_hopper(&Hopper::new(limits).unwrap(), Gravity::new(g).unwrap()).unwrap());
            let (start, goal) = (chain.geometry().vertex_station(VertexId(0)), chain.geometry().vertex_station(VertexId(4)));
            let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(2)), ..SearchOptions::default() };
            search(&test, start, goal, &options, &()).unwrap().hops().unwrap_or(u64::MAX)
        };
        let least = speed * draw.uniform(0.3, 0.95);
        let at_least = |v: f64| HopperLimits { takeoff_speed_min_m_s: Some(v), ..HopperLimits::UNLIMITED };
        let levels = |list: &[f64]| HopperLimits { takeoff_speed_levels: SpeedLevels::new(list).ok(), ..HopperLimits::UNLIMITED };
        let [any, slow, fast] = [HopperLimits::UNLIMITED, at_least(0.7 * least), at_least(least)].map(hops);
        assert!(any <= slow && slow <= fast, "{any}, {slow}, {fast}");
        let [two, one] = [levels(&[least, speed]), levels(&[least])].map(hops);
        assert!(fast <= two && two <= one, "{fast}, {two}, {one}");
        compared += u32::from(fast < u64::MAX && any > 0);
    }
    assert!(compared > 50, "{compared}");
}

/// The chosen arc has a speed that the machine has, whatever the pair, and the least speed is the least of all its windows.
#[test]
fn the_chosen_arc_is_one_that_the_machine_has() {
    let draw = &mut Draw::seeded(1406);
    let mut chosen = 0;
    for _ in 0..3000 {
        let (g, run) = (draw.gravity(), draw.log_uniform(1e-2, 1e3));
        let speed = (g * run).sqrt() * draw.uniform(1.0, 2.0);
        let mut limits = HopperLimits::UNLIMITED;
        draw.commands(&mut limits, speed);
        let speeds = TakeoffSpeeds::of(&limits);
        let (Some(limit), sight) = (speeds.limit(), LineOfSight::new(run, run * draw.uniform(-1.0, 1.0))) else { continue };
        let lofts = SlopeInterval { lower: draw.uniform(0.0, 2.0), upper: draw.uniform(2.0, 9.0) };
        let windows: Vec<_> = speeds.windows(sight, lofts, g).collect();
        for choice in TakeoffChoice::ALL {
            let Some(loft) = speeds.loft(choice, sight, lofts, g) else {
                assert!(windows.is_empty(), "{windows:?}");
                continue;
            };
            assert!(windows.iter().any(|window| window.lofts.contains(loft)), "{choice:?}: {loft} of {windows:?}");
            let v = Arc::new(sight, loft, g).takeoff_speed_m_s();
            if limit == Limit::TakeoffSpeedMin {
                assert!(v >= limits.takeoff_speed_min_m_s.unwrap() * (1.0 - SPEED_TOLERANCE) * (1.0 - 1e-14), "{v}");
            } else {
                let levels = limits.takeoff_speed_levels.unwrap();
                let near = |level: &f64| (v / level - 1.0).abs() <= SPEED_TOLERANCE + 1e-14;
                assert!(levels.as_slice().iter().any(near), "{v}, {levels:?}");
            }
            chosen += 1;
        }
    }
    assert!(chosen > 1000, "{chosen}");
}

/// `data/validation/takeoff_speeds.py` and the table it wrote.
const TABLE: &str = include_str!("../../data/validation/takeoff_speeds.csv");

#[test]
fn gaps_and_levels_agree_with_60_digits_to_a_nanoradian() {
    let (mut real, mut none) = (0, 0);
    for row in TABLE.lines().filter(|row| !row.starts_with('#')).skip(1) {
        let numbers: Vec<Option<f64>> = row.split(',').map(|text| (!text.is_empty()).then(|| text.parse().unwrap())).collect();
        let [g, run, rise, speed] = [0, 1, 2, 3].map(|i| numbers[i].unwrap());
        let sight = LineOfSight::new(run, rise);
        let gap = chta::ballistics::limits::takeoff_speed_min(sight, speed, g);
        let level = chta::ballistics::limits::takeoff_speed_level(sight, speed, g, SlopeInterval::ALL);
        for (found, expected) in [(gap.map(|gap| gap.lower), numbers[4]), (gap.map(|gap| gap.upper), numbers[5])] {
            let angle = found.map(|loft| (sight.slope() + loft).atan());
            assert!(angle.zip(expected).map_or(found.is_none() && expected.is_none(), |(a, b)| (a - b).abs() < 1e-9), "gap: {row}");
        }
        // A level within its tolerance of the least speed has one arc, which the exact speed lacks.
        for (found, expected) in level.iter().zip(&numbers[6..]) {
            let angle = found.map(|loft| (sight.slope() + loft).atan());
            assert!(
                angle.zip(*expected).map_or(found.is_none() && expected.is_none(), |(a, b)| (a - b).abs() < 1e-9),
                "level: {row}"
            );
        }
        real += u32::from(numbers[4].is_some());
        none += u32::from(numbers[6].is_none());
    }
    assert!(real > 200 && none > 100, "{real}, {none}");
}
