//! The CHTA paper's own figures (model section 7) compared with ours, and a numeric case for each of its errata.
#![allow(clippy::unwrap_used, reason = "helpers of tests: shipped data that cannot be read fails them")]

use chta::{
    ballistics::{Arc, LineOfSight, TakeoffChoice, least_takeoff_speed_m_s},
    chain::{ConstrainedChain, ContactRule, GroundForm, GroundRefusal, LineConstraints, PolygonalChain, SegmentGround},
    graph::{Answer, Effort, HopGraph, NodeSet, Outcome, PointSpacing, SearchOptions, search},
    hop::{HopTest, Split},
    path::generate,
    quantity::{Angle, AngleInterval, ChainPoint, SegmentId, VertexId},
    world::{Contact, Direction, Gravity, Grip, Hopper, Limit, RestSlope, SurfaceProperties},
};

const NO_REST: RestSlope = RestSlope::Unlimited;

/// Section V-B's angles from the slope, with the given ones for the landing.
fn from_slope(landing_deg: (f64, f64)) -> Grip {
    Grip::FromSlope {
        takeoff: AngleInterval::from_degrees(60.0, 90.0),
        landing: AngleInterval::from_degrees(landing_deg.0, landing_deg.1),
    }
}

/// Section V-B as one straight segment: 76 m along, from 54.61 to 59.24 m, angles stated from the slope, 10 m/s, g = 3.711.
fn the_76_m_case(landing_from_slope_deg: (f64, f64)) -> ConstrainedChain {
    let chain = PolygonalChain::bare(vec![ChainPoint::new(0.0, 54.61), ChainPoint::new(76.0, 59.24)]).unwrap();
    let grip = from_slope(landing_from_slope_deg);
    ConstrainedChain::new(
        chain,
        &Hopper::with_speeds(10.0, 10.0).unwrap(),
        Gravity::new(3.711).unwrap(),
        &SurfaceProperties { grip: Some(grip), rest: NO_REST },
    )
    .unwrap()
}

fn with_points(points_per_segment: u32) -> SearchOptions {
    SearchOptions { spacing: Some(PointSpacing::PerSegment(points_per_segment)), ..SearchOptions::default() }
}

/// A search between two vertices, numbered from 0.
fn between(test: &HopTest, from: usize, to: usize, options: &SearchOptions) -> Answer {
    let at = |i| test.chain().geometry().vertex_station(VertexId(i));
    search(test, at(from), at(to), options, &()).unwrap()
}

#[test]
fn the_76_m_case_has_the_papers_reach_and_four_hops() {
    let chain = the_76_m_case((-90.0, -60.0));
    let test = HopTest::new(chain.with_hopper(&Hopper::with_speeds(10.0, 10.0).unwrap(), Gravity::new(3.711).unwrap()).unwrap());
    let reach = test.segment_reach(SegmentId(0), Direction::Forward).unwrap();
    // R_t = 20.913 m along the line of sight, 20.874 m horizontally, 60 degrees over the slope (model section 7).
    assert!((reach.reach_line_of_sight_m() - 20.913).abs() < 5e-4, "{}", reach.reach_line_of_sight_m());
    assert!((reach.reach_m() - 20.874).abs() < 5e-4, "{}", reach.reach_m());
    assert_eq!(reach.limit(), Limit::TakeoffSpeed);
    let over_slope = Angle::from_slope(reach.takeoff_slope()).degrees() - Angle::from_slope(reach.sight_slope()).degrees();
    assert!((over_slope - 60.0).abs() < 1e-9, "{over_slope}");

    let answer = between(&test, 0, 1, &with_points(0));
    assert_eq!(answer.hops(), Some(4));
    let Outcome::Path { legs, .. } = answer.outcome else { panic!("no path") };
    for split in Split::ALL {
        let path = generate(&test, &legs, TakeoffChoice::LeastSpeed, split).unwrap();
        assert_eq!(path.hops.len(), 4);
        assert!((path.totals.ground_distance_m - 76.0).abs() < 1e-9);
    }
}

#[test]
fn the_76_m_case_lands_slower_than_it_starts_so_the_landing_reaches_farther() {
    // R_l = 23.093 m (P eq. 30): the same angle with the take-off unlimited.
    let takeoff = AngleInterval::from_degrees(60.0, 90.0);
    let landing = AngleInterval::from_degrees(-90.0, -60.0);
    let slope = (59.24 - 54.61) / 76.0;
    let line = LineConstraints::from_offsets(slope, takeoff, landing, 1e3, 10.0);
    let chain = explicit(&[(0.0, 54.61), (76.0, 59.24)], &[line]);
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(3.711).unwrap()).unwrap());
    let reach = test.segment_reach(SegmentId(0), Direction::Forward).unwrap();
    assert!((reach.reach_line_of_sight_m() - 23.093).abs() < 5e-4, "{}", reach.reach_line_of_sight_m());
    assert_eq!(reach.limit(), Limit::LandingSpeed);
}

// ---- The simple scenario, section V-A, on our own chain.

/// A shipped chain CSV of the explicit form.
fn shipped(csv: &str) -> ConstrainedChain {
    let mut rows = csv.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = rows.next().unwrap().split(',').collect();
    let rows: Vec<Vec<&str>> = rows.map(|row| row.split(',').collect()).collect();
    let number = |row: &[&str], name: &str| -> f64 { row[header.iter().position(|h| *h == name).unwrap()].parse().unwrap() };
    let line = |row: &[&str], prefix: &str| {
        let rule = |contact: &str| {
            let of = |what: &str| number(row, &format!("{prefix}{contact}_{what}"));
            ContactRule::new(AngleInterval::from_degrees(of("min_deg"), of("max_deg")), of("speed_max_m_s"))
        };
        LineConstraints { takeoff: rule("takeoff"), landing: rule("landing") }
    };
    let points = rows.iter().map(|row| ChainPoint::new(number(row, "x_m"), number(row, "z_m"))).collect();
    let grounds = rows[..rows.len() - 1]
        .iter()
        .map(|row| GroundForm::Explicit { forward: Some(line(row, "")), reverse: Some(line(row, "reverse_")) })
        .map(|form| SegmentGround { form, keep_out: false })
        .collect();
    let chain = PolygonalChain::new(points, grounds, None).unwrap();
    ConstrainedChain::new(chain, &Hopper::UNLIMITED, Gravity::new(9.81).unwrap(), &SurfaceProperties { grip: None, rest: NO_REST })
        .unwrap()
}

fn simple() -> ConstrainedChain {
    shipped(include_str!("../../data/chains/simple.csv"))
}

fn simple_reduced() -> ConstrainedChain {
    shipped(include_str!("../../data/chains/simple_reduced.csv"))
}

/// Nodes 2 and 5 in the paper's numbering.
const START: usize = 1;
const GOAL: usize = 4;

#[test]
fn in_the_simple_scenario_one_hop_joins_nodes_2_and_5() {
    let chain = simple();
    assert!(chain.geometry().vertices().len() >= 5);
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(9.81).unwrap()).unwrap());
    for k in 0..=4 {
        assert_eq!(between(&test, START, GOAL, &with_points(k)).hops(), Some(1), "k = {k}");
    }
}

#[test]
fn the_reduced_scenario_is_the_simple_one_with_slower_segments_2_and_4() {
    let (full, reduced) = (simple(), simple_reduced());
    assert_eq!(full.geometry().vertices(), reduced.geometry().vertices());
    for (i, (a, b)) in full.segments().iter().zip(reduced.segments()).enumerate() {
        for direction in Direction::BOTH {
            let (a, b) = (a.stated(direction).unwrap(), b.stated(direction).unwrap());
            assert_eq!((a.takeoff.angles(), a.landing.angles()), (b.takeoff.angles(), b.landing.angles()));
            let speeds = (b.takeoff.speed_max_m_s(), b.landing.speed_max_m_s());
            let expected = if i == 1 || i == 3 { (6.0, 5.0) } else { (a.takeoff.speed_max_m_s(), a.landing.speed_max_m_s()) };
            assert_eq!(speeds, expected, "segment {}", i + 1);
        }
    }
}

#[test]
fn in_the_reduced_scenario_speed_forbids_the_one_hop_and_segment_3_joins_no_points_forward() {
    let chain = simple_reduced();
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(9.81).unwrap()).unwrap());
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    let refused = test.lofts(&at(START), &at(GOAL)).unwrap_err();
    assert!(matches!(refused, Limit::TakeoffSpeed | Limit::LandingSpeed), "{refused}");
    // Segment 3, forward: its cones leave no angle for any hop (P eq. 23 is empty).
    assert_eq!(test.segment_reach(SegmentId(2), Direction::Forward), None);
    assert!(test.lofts(&at(2), &at(3)).is_err() && test.segment_hops(&at(2), &at(3)).is_none());
    // So nodes 3 and 4 are not joined, while 2 and 3, and 4 and 5, are.
    for i in [1, 3] {
        assert!(
            test.lofts(&at(i), &at(i + 1)).is_ok() || test.segment_hops(&at(i), &at(i + 1)).is_some(),
            "nodes {} and {}",
            i + 1,
            i + 2
        );
    }
}

#[test]
fn in_the_reduced_scenario_raising_k_finds_a_path_and_then_shorter_ones() {
    let chain = simple_reduced();
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(9.81).unwrap()).unwrap());
    let hops: Vec<Option<u64>> = (0..=30).map(|k| between(&test, START, GOAL, &with_points(k)).hops()).collect();
    let mut expected = vec![None, None, Some(5), Some(4), Some(4), Some(4)];
    expected.resize(31, Some(3));
    assert_eq!(hops, expected);
    // The automatic choice of k ends at the first k with a path.
    let answer = between(&test, START, GOAL, &SearchOptions::default());
    assert_eq!((answer.points_per_segment, answer.hops()), (2, Some(5)));
}

// ---- Errata.

/// A chain of points with explicit forward constraints.
fn explicit(points: &[(f64, f64)], lines: &[LineConstraints]) -> ConstrainedChain {
    let points = points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect();
    let form = |line: &LineConstraints| GroundForm::Explicit { forward: Some(*line), reverse: None };
    let grounds = lines.iter().map(|line| SegmentGround { form: form(line), keep_out: false }).collect();
    let chain = PolygonalChain::new(points, grounds, None).unwrap();
    ConstrainedChain::new(chain, &Hopper::UNLIMITED, Gravity::new(9.81).unwrap(), &SurfaceProperties { grip: None, rest: NO_REST })
        .unwrap()
}

/// Line constraints from degrees and m/s.
fn line(takeoff_deg: (f64, f64), takeoff_m_s: f64, landing_deg: (f64, f64), landing_m_s: f64) -> LineConstraints {
    let rule = |deg: (f64, f64), speed| ContactRule::new(AngleInterval::from_degrees(deg.0, deg.1), speed);
    LineConstraints { takeoff: rule(takeoff_deg, takeoff_m_s), landing: rule(landing_deg, landing_m_s) }
}

/// Erratum: the summary of Theta after eq. 21 has the take-off limit in the lower landing-speed term; eq. 17 has the landing limit.
///
/// Case: 10 m of flat ground, g = 9.81, 20 m/s at take-off, 10.5 m/s at landing. As printed, the set begins at 7.1 degrees; the arc
/// there lands with 20 m/s. By eq. 17 it begins at 31.4 degrees, where the arc lands with 10.5 m/s.
#[test]
fn erratum_summary_of_theta_prints_the_takeoff_limit_for_the_landing_speed() {
    let (g, run, v_t, v_l) = (9.81, 10.0, 20.0, 10.5);
    let chain = explicit(&[(0.0, 0.0), (run, 0.0)], &[line((-90.0, 90.0), v_t, (-90.0, 90.0), v_l)]);
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(g).unwrap()).unwrap());
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    let set = test.takeoff_set(&at(0), &at(1)).unwrap();
    let lower_term = |v: f64| 0.5 * (run * g / (v * v)).asin();
    let (as_printed, by_eq_17) = (lower_term(v_t), lower_term(v_l));
    assert!((as_printed.to_degrees() - 7.1).abs() < 0.05 && (by_eq_17.to_degrees() - 31.4).abs() < 0.05);
    assert!((set.angles().unwrap().min.radians() - by_eq_17).abs() < 1e-7);
    assert_eq!(set.binding().unwrap().lower.limit, Limit::LandingSpeed);
    let landing_speed = |theta: f64| Arc::new(LineOfSight::new(run, 0.0), theta.tan(), g).landing_speed_m_s();
    assert!((landing_speed(as_printed) - v_t).abs() < 1e-9, "the printed set lands with 20 m/s where 10.5 are allowed");
    assert!((landing_speed(by_eq_17) - v_l).abs() < 1e-9);
}

/// Erratum: section V-B states its landing bounds in the wrong order, lower alpha - pi/3 and upper alpha - pi/2.
///
/// Taken literally, no landing is possible; swapped, the traverse takes the paper's four hops.
#[test]
fn erratum_landing_bounds_of_section_v_b_are_swapped() {
    let right = the_76_m_case((-90.0, -60.0));
    assert_eq!(between(&HopTest::new(right.clone()), 0, 1, &with_points(0)).hops(), Some(4));
    // A surface refuses angles in that order, so the literal bounds are stated as limits of the segment.
    let reversed = SurfaceProperties { grip: Some(from_slope((-60.0, -90.0))), rest: NO_REST };
    let bare = PolygonalChain::bare(right.geometry().vertices().to_vec()).unwrap();
    assert!(ConstrainedChain::new(bare, right.hopper(), right.gravity(), &reversed).is_err());
    let line = |slope| {
        let (takeoff, landing) = (AngleInterval::from_degrees(60.0, 90.0), AngleInterval::from_degrees(-60.0, -90.0));
        Some(LineConstraints::from_offsets(slope, takeoff, landing, 10.0, 10.0))
    };
    let slope = right.geometry().slopes()[0];
    let form = GroundForm::Explicit { forward: line(slope), reverse: line(-slope) };
    let ground = SegmentGround { form, keep_out: false };
    let literal = PolygonalChain::new(right.geometry().vertices().to_vec(), vec![ground], None).unwrap();
    let literal = ConstrainedChain::new(literal, right.hopper(), right.gravity(), right.surface()).unwrap();
    assert_eq!(between(&HopTest::new(literal.clone()), 0, 1, &with_points(0)).hops(), None);
    let refusal = literal.segments()[0].check_contact(Contact::Landing, Direction::Forward).unwrap_err();
    assert!(matches!(refusal, GroundRefusal::NothingAhead { .. }), "{refusal}");
}

/// Erratum: section IV-C takes the reach per hop from eq. 16 and 18, which hold at the angle of least speed; Algorithm 4 correctly
/// takes it from eq. 29 and 30, at the angle flown.
///
/// The 76 m case: eq. 16 gives 25.402 m per hop, which at 60 degrees over the slope needs 11.02 m/s, more than the 10 m/s allowed;
/// eq. 29 gives 20.913 m, which needs exactly 10 m/s.
#[test]
fn erratum_reach_of_section_iv_c_is_that_of_another_angle() {
    let (g, v) = (3.711, 10.0);
    let chain = the_76_m_case((-90.0, -60.0));
    let test = HopTest::new(chain.with_hopper(&Hopper::with_speeds(v, v).unwrap(), Gravity::new(g).unwrap()).unwrap());
    let reach = test.segment_reach(SegmentId(0), Direction::Forward).unwrap();
    let b = reach.sight_slope();
    let beta = b.atan();
    // Eq. 16, along the line of sight, and its horizontal part.
    let by_eq_16 = v * v * (1.0 - beta.sin()) / (g * beta.cos().powi(2));
    assert!((by_eq_16 - 25.402).abs() < 5e-4, "{by_eq_16}");
    assert!((least_takeoff_speed_m_s(LineOfSight::along(by_eq_16 * beta.cos(), b), g) - v).abs() < 1e-9);
    let speed_over = |length: f64| Arc::new(LineOfSight::along(length * beta.cos(), b), reach.loft(), g).takeoff_speed_m_s();
    assert!((speed_over(by_eq_16) - 11.02).abs() < 5e-3, "{}", speed_over(by_eq_16));
    assert!((speed_over(reach.reach_line_of_sight_m()) - v).abs() < 1e-9);
    // Three hops of eq. 16 would cover the whole 76.14 m; the paper and we need four.
    let whole = 76.0 / beta.cos();
    assert_eq!(((whole / by_eq_16).ceil(), (whole / reach.reach_line_of_sight_m()).ceil()), (3.0, 4.0));
}

/// Erratum: Property 2 claims least take-off speed for a search whose cost is the number of hops only.
///
/// Case: 12 m of flat ground, g = 10, 10 m/s (10 m per hop), vertices at 3 and 6 m. Two hops by either vertex; their speeds add up
/// to 14.96 m/s over 3 m and to 15.49 m/s over 6 m. A count of hops does not distinguish them; a cost with effort does, and another
/// effort (least peak speed) correctly gives the other path.
#[test]
fn erratum_property_2_needs_the_effort_in_the_cost() {
    let wide = line((-90.0, 90.0), 10.0, (-90.0, 90.0), 10.0);
    let chain = explicit(&[(0.0, 0.0), (3.0, 0.0), (6.0, 0.0), (12.0, 0.0)], &[wide; 3]);
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(10.0).unwrap()).unwrap());
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    let nodes = NodeSet::new(&chain, at(0), at(3), PointSpacing::PerSegment(0)).unwrap();
    let cost_by = |middle: usize, effort| {
        let graph = HopGraph::new(&test, &nodes, effort, TakeoffChoice::LeastSpeed, Split::FullReach);
        let hop = |a, b| graph.cost(&at(a), &at(b), graph.edge(&at(a), &at(b)).unwrap());
        hop(0, middle) + hop(middle, 3)
    };
    let by = |middle| cost_by(middle, Effort::TakeoffSpeed);
    assert_eq!((by(1).hops(), by(2).hops()), (2, 2), "the paper's cost is the same");
    assert!((by(1).effort() - (30f64.sqrt() + 90f64.sqrt())).abs() < 1e-9 && (by(2).effort() - 2.0 * 60f64.sqrt()).abs() < 1e-9);
    for (effort, middle) in [(Effort::TakeoffSpeed, 1), (Effort::PeakSpeed, 2)] {
        let Outcome::Path { legs, cost } = between(&test, 0, 3, &SearchOptions { effort, ..with_points(0) }).outcome else {
            panic!("no path")
        };
        assert_eq!(legs[0].landing, at(middle), "{}", effort.name());
        assert_eq!(cost, cost_by(middle, effort));
    }
}

/// Erratum: Algorithm 2's pseudo-code uses many hops only where R >= Rmax, its prose wherever two points share a segment.
///
/// Case: 9 m of flat ground, g = 10, 10 m/s (Rmax = 10 m), take-off at 75 degrees or more, with a range of 5 m. One hop is
/// impossible, two are possible; the pseudo-code finds no connection.
#[test]
fn erratum_algorithm_2_loses_pairs_within_reach() {
    let (g, v, run) = (10.0, 10.0, 9.0);
    let chain = explicit(&[(0.0, 0.0), (run, 0.0)], &[line((75.0, 90.0), v, (-90.0, 0.0), v)]);
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(g).unwrap()).unwrap());
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    let single = test.lofts(&at(0), &at(1));
    let many = test.segment_hops(&at(0), &at(1)).unwrap();
    let pseudo_code = {
        let r_max = v * v / g;
        if run < r_max { u64::from(single.is_ok()) } else { many.hops() }
    };
    assert_eq!(pseudo_code, 0, "the pseudo-code finds no connection");
    assert_eq!(many.hops(), 2);
    assert!((many.reach().reach_m() - 5.0).abs() < 1e-9, "v^2 sin(150 deg) / g");
    assert_eq!(between(&test, 0, 1, &with_points(0)).hops(), Some(2));
}
