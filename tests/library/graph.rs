//! The search against an edge list of all pairs, the frontier against closures, and the effect of additional limits.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod own_search;
use std::{ops::ControlFlow, sync::Mutex};

use crate::support::{Draw, explicit, line};
use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, GroundForm, LineConstraints, PolygonalChain, SegmentGround, Station},
    graph::{
        AUTO_POINTS_PER_SEGMENT, Answer, Effort, Frontier, NodeSet, NodesError, Outcome, PointSpacing, SearchOptions, is_usable,
        search,
    },
    hop::{Conflict, HopTest, Split},
    progress::{Detail, Progress, Step},
    quantity::{ChainPoint, VertexId},
    world::{Contact, Direction, Gravity, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// Hops and effort, compared in this order.
type Price = (u64, f64);

/// A chain with some possible and some impossible journeys.
struct World {
    points: Vec<ChainPoint>,
    lines: Vec<(LineConstraints, LineConstraints)>,
    hopper: Hopper,
    g: f64,
}

impl World {
    fn draw(draw: &mut Draw, segments: usize) -> Self {
        let (g, size) = (draw.gravity(), draw.log_uniform(1e-1, 1e2));
        let points = draw.profile(segments, size);
        let speed = (g * size).sqrt() * draw.log_uniform(0.5, 1.5);
        let cone = |draw: &mut Draw| {
            let takeoff = if draw.chance(0.5) { (-90.0, 90.0) } else { (draw.uniform(-20.0, 60.0), draw.uniform(60.0, 90.0)) };
            let landing = if draw.chance(0.5) { (-90.0, 90.0) } else { (-90.0, draw.uniform(-60.0, 20.0)) };
            let fast = if draw.chance(0.1) { 0.0 } else { draw.uniform(0.6, 1.4) };
            line(takeoff, speed * fast, landing, speed * draw.uniform(0.7, 1.6))
        };
        let lines = (0..segments).map(|_| (cone(draw), cone(draw))).collect();
        let mut limits = HopperLimits {
            clearance_m: if draw.chance(0.5) { 0.0 } else { size * draw.log_uniform(1e-3, 1e-1) },
            clearance_rule: draw.clearance_rule(),
            ..HopperLimits::UNLIMITED
        };
        draw.commands(&mut limits, speed);
        Self { points, lines, hopper: Hopper::new(limits).unwrap(), g }
    }

    fn chain(&self) -> ConstrainedChain {
        explicit(&self.points, &self.lines, RestSlope::Unlimited)
    }

    /// The same chain with every speed limit multiplied.
    fn slower(&self, factor: f64) -> Self {
        let slow = |l: &LineConstraints| l.capped(l.takeoff.speed_max_m_s() * factor, l.landing.speed_max_m_s() * factor);
        let lines = self.lines.iter().map(|(f, r)| (slow(f), slow(r))).collect();
        Self { points: self.points.clone(), lines, hopper: self.hopper, g: self.g }
    }
}

/// A position on a chain, often a vertex.
fn place(draw: &mut Draw, chain: &ConstrainedChain) -> Station {
    let geometry = chain.geometry();
    let (first, last) = geometry.extent_m();
    if draw.chance(0.5) {
        geometry.vertex_station(VertexId(draw.below(geometry.segment_count() + 1)))
    } else {
        geometry.station(draw.uniform(first, last)).unwrap()
    }
}

/// The cost of the edge between two stations; every pair is tested, near or far.
fn price(test: &HopTest, a: &Station, b: &Station, options: &SearchOptions) -> Option<Price> {
    let each = |speed: f64, time: f64| match options.effort {
        Effort::TakeoffSpeed | Effort::PeakSpeed => speed,
        Effort::Energy => 0.5 * speed * speed,
        Effort::Time => time,
    };
    if let Some(arc) = test.takeoff_set(a, b).and_then(|set| set.arc(options.takeoff, test.gravity_m_s2())) {
        return Some((1, each(arc.takeoff_speed_m_s(), arc.flight_time_s())));
    }
    let along = test.segment_hops(a, b)?;
    let (others_m, last_m) = along.lengths_m(options.split);
    let of = |length_m| {
        let arc = along.arc(test, length_m, options.takeoff);
        each(arc.takeoff_speed_m_s(), arc.flight_time_s())
    };
    let mut sum = of(last_m);
    for _ in 1..along.hops() {
        sum = if options.effort == Effort::PeakSpeed { sum.max(of(others_m)) } else { sum + of(others_m) };
    }
    Some((along.hops(), sum))
}

fn joined(a: Price, b: Price, effort: Effort) -> Price {
    (a.0 + b.0, if effort == Effort::PeakSpeed { a.1.max(b.1) } else { a.1 + b.1 })
}

/// The matrix of all costs.
fn prices(test: &HopTest, nodes: &NodeSet, options: &SearchOptions) -> Vec<Vec<Option<Price>>> {
    let stations = nodes.stations();
    stations.iter().map(|a| stations.iter().map(|b| price(test, a, b, options)).collect()).collect()
}

/// Bellman-Ford: relax every edge until nothing changes.
fn bellman_ford(prices: &[Vec<Option<Price>>], start: usize, effort: Effort) -> Vec<Option<Price>> {
    let mut best: Vec<Option<Price>> = vec![None; prices.len()];
    best[start] = Some((0, 0.0));
    loop {
        let mut changed = false;
        for (i, row) in prices.iter().enumerate() {
            let Some(here) = best[i] else { continue };
            for (j, edge) in row.iter().enumerate() {
                let Some(edge) = edge else { continue };
                let there = joined(here, *edge, effort);
                if best[j].is_none_or(|known| there < known) {
                    best[j] = Some(there);
                    changed = true;
                }
            }
        }
        if !changed {
            return best;
        }
    }
}

/// The cheapest of all paths that visit no node twice.
fn enumerated(prices: &[Vec<Option<Price>>], here: usize, goal: usize, seen: &mut Vec<usize>, effort: Effort) -> Option<Price> {
    if here == goal {
        return Some((0, 0.0));
    }
    let mut best: Option<Price> = None;
    for next in 0..prices.len() {
        let Some(edge) = prices[here][next] else { continue };
        if seen.contains(&next) {
            continue;
        }
        seen.push(next);
        if let Some(rest) = enumerated(prices, next, goal, seen, effort) {
            let total = joined(edge, rest, effort);
            if best.is_none_or(|known| total < known) {
                best = Some(total);
            }
        }
        seen.pop();
    }
    best
}

fn options(draw: &mut Draw, k: u32) -> SearchOptions {
    SearchOptions {
        spacing: Some(PointSpacing::PerSegment(k)),
        effort: Effort::ALL[draw.below(4)],
        takeoff: TakeoffChoice::ALL[draw.below(3)],
        split: Split::ALL[draw.below(2)],
    }
}

fn asked(test: &HopTest, start: Station, goal: Station, options: &SearchOptions) -> Answer {
    search(test, start, goal, options, &()).unwrap()
}

fn node_set(chain: &ConstrainedChain, start: Station, goal: Station, options: &SearchOptions) -> NodeSet {
    NodeSet::new(chain, start, goal, options.spacing.unwrap()).unwrap()
}

fn assert_same(found: &Answer, expected: Option<Price>) {
    match (&found.outcome, expected) {
        (Outcome::Path { cost, .. }, Some((hops, effort))) => {
            assert_eq!(cost.hops(), hops);
            assert!((cost.effort() - effort).abs() <= 1e-9 * effort, "effort {} against {effort}", cost.effort());
        }
        (Outcome::NoPath(_) | Outcome::EndpointsRefuse(_), None) => {}
        (outcome, expected) => panic!("{outcome:?} against {expected:?}"),
    }
}

#[test]
fn the_search_finds_what_bellman_and_ford_find_over_all_pairs() {
    let draw = &mut Draw::seeded(31);
    let (mut paths, mut none) = (0, 0);
    for _ in 0..500 {
        let segments = 2 + draw.below(5);
        let world = World::draw(draw, segments);
        let chain = world.chain();
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        let points = u32::try_from(draw.below(4)).unwrap();
        let options = options(draw, points);
        let nodes = node_set(&chain, start, goal, &options);
        let expected = bellman_ford(&prices(&test, &nodes, &options), nodes.start().index(), options.effort)[nodes.goal().index()];
        let found = asked(&test, start, goal, &options);
        assert_same(&found, expected);
        if let Outcome::Path { legs, .. } = &found.outcome {
            assert!(legs.windows(2).all(|pair| pair[0].landing == pair[1].takeoff), "legs do not join");
            let priced = legs.iter().map(|leg| price(&test, &leg.takeoff, &leg.landing, &options).unwrap());
            let total = priced.fold((0, 0.0), |sum, leg| joined(sum, leg, options.effort));
            assert_same(&found, Some(total));
        }
        if expected.is_some() { paths += 1 } else { none += 1 }
    }
    assert!(paths > 150 && none > 50, "{paths} paths, {none} without");
}

#[test]
fn on_tiny_chains_the_search_finds_the_best_of_all_paths() {
    let draw = &mut Draw::seeded(32);
    let mut long = 0;
    for _ in 0..800 {
        let world = World::draw(draw, 4);
        let chain = world.chain();
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        let options = options(draw, 0);
        let nodes = node_set(&chain, start, goal, &options);
        let (from, to) = (nodes.start().index(), nodes.goal().index());
        let expected = enumerated(&prices(&test, &nodes, &options), from, to, &mut vec![from], options.effort);
        let found = asked(&test, start, goal, &options);
        assert_same(&found, expected);
        long += u32::from(matches!(&found.outcome, Outcome::Path { legs, .. } if legs.len() >= 2));
    }
    assert!(long > 50, "only {long} paths of several legs");
}

#[test]
fn some_journeys_must_begin_backwards() {
    let draw = &mut Draw::seeded(33);
    let mut needed = 0;
    for _ in 0..4000 {
        let world = World::draw(draw, 4);
        let chain = world.chain();
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(1)), ..SearchOptions::default() };
        let Outcome::Path { legs, .. } = asked(&test, start, goal, &options).outcome else { continue };
        let towards = Direction::between(start.point.x_m, goal.point.x_m);
        let backwards = |leg: &chta::graph::Leg| Direction::between(leg.takeoff.point.x_m, leg.landing.point.x_m) != towards;
        if !legs.iter().any(backwards) {
            continue;
        }
        // The same chain with the direction of the journey only: longer, or impossible.
        let one_way = |(forward, reverse): &(LineConstraints, LineConstraints)| GroundForm::Explicit {
            forward: (towards == Some(Direction::Forward)).then_some(*forward),
            reverse: (towards == Some(Direction::Reverse)).then_some(*reverse),
        };
        let grounds = world.lines.iter().map(|both| SegmentGround { form: one_way(both), keep_out: false }).collect();
        let geometry = PolygonalChain::new(world.points.clone(), grounds, None).unwrap();
        let chain = ConstrainedChain::new(
            geometry,
            &Hopper::UNLIMITED,
            Gravity::new(1.0).unwrap(),
            &SurfaceProperties { grip: None, rest: RestSlope::Unlimited },
        )
        .unwrap();
        let other =
            asked(&HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap()), start, goal, &options);
        assert!(other.hops().is_none_or(|hops| hops >= legs.len() as u64));
        needed += u32::from(other.hops().is_none());
    }
    assert!(needed > 5, "only {needed} journeys needed to go back");
}

/// The stations reachable from a set over all pairs, forwards or (transposed) backwards.
fn closure(prices: &[Vec<Option<Price>>], from: usize, transposed: bool) -> Vec<usize> {
    let mut reached = vec![from];
    let mut next = 0;
    while next < reached.len() {
        let here = reached[next];
        for (there, row) in prices.iter().enumerate() {
            let edge = if transposed { row[here] } else { prices[here][there] };
            if edge.is_some() && !reached.contains(&there) {
                reached.push(there);
            }
        }
        next += 1;
    }
    reached.sort_unstable();
    reached
}

#[test]
fn the_frontier_is_the_closure_from_either_end() {
    let draw = &mut Draw::seeded(34);
    let (mut seen, mut misses) = (0, 0);
    for _ in 0..3000 {
        let world = World::draw(draw, 4).slower(0.7);
        let chain = world.chain();
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        let options = options(draw, 1);
        let Outcome::NoPath(frontier) = asked(&test, start, goal, &options).outcome else { continue };
        let nodes = node_set(&chain, start, goal, &options);
        let prices = prices(&test, &nodes, &options);
        let stations = |ids: &[usize]| -> Vec<Station> { ids.iter().map(|&i| nodes.stations()[i]).collect() };
        let reached = closure(&prices, nodes.start().index(), false);
        let leads = closure(&prices, nodes.goal().index(), true);
        assert_eq!(frontier.reached, stations(&reached));
        assert_eq!(frontier.leads_to_goal, stations(&leads));
        let gap = |a: &Station, b: &Station| (a.point.x_m - b.point.x_m).abs();
        assert!(frontier.reached.iter().all(|s| gap(s, &goal) >= gap(&frontier.nearest_to_goal, &goal)));
        assert!(frontier.leads_to_goal.iter().all(|s| gap(s, &start) >= gap(&frontier.nearest_to_start, &start)));
        misses += u32::from(smallest_gap_agrees(&test, &nodes, &reached, &frontier));
        seen += 1;
    }
    assert!(seen > 300 && misses > 30, "{seen} frontiers, {misses} near misses");
}

/// Whether there is a near miss; asserts that it has the smallest gap of all pairs that leave the reached set.
fn smallest_gap_agrees(test: &HopTest, nodes: &NodeSet, reached: &[usize], frontier: &Frontier) -> bool {
    let stations = nodes.stations();
    let mut smallest = f64::INFINITY;
    let outside = |j: &usize| !reached.contains(j);
    for (&i, j) in reached.iter().flat_map(|i| (0..stations.len()).filter(outside).map(move |j| (i, j))) {
        if let Some(Conflict::Pair { gap_deg, .. }) = test.takeoff_set(&stations[i], &stations[j]).and_then(|set| set.conflict()) {
            smallest = smallest.min(gap_deg);
        }
    }
    match frontier.nearest_miss {
        None => assert_eq!(smallest, f64::INFINITY),
        Some(miss) => {
            let Conflict::Pair { gap_deg, .. } = miss.conflict else { panic!("a near miss with a single limit") };
            assert_eq!(gap_deg, smallest);
            assert!(frontier.reached.contains(&miss.takeoff) && !frontier.reached.contains(&miss.landing));
            assert!(frontier.refusals.total() >= 1);
        }
    }
    frontier.nearest_miss.is_some()
}

#[test]
fn a_goal_at_the_start_takes_no_hop_even_if_no_contact_is_allowed() {
    let still = line((-90.0, 90.0), 0.0, (-90.0, 90.0), 0.0);
    let chain = crate::support::uniform(&[ChainPoint::new(0.0, 0.0), ChainPoint::new(10.0, 1.0)], still);
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(1.62).unwrap()).unwrap());
    let here = chain.geometry().station(4.0).unwrap();
    let answer = asked(&test, here, here, &SearchOptions::default());
    let Outcome::Path { legs, cost } = answer.outcome else { panic!("no path from a station to itself") };
    assert!(legs.is_empty() && cost.hops() == 0 && cost.effort() == 0.0);
}

#[test]
fn refusing_ends_are_named_with_a_usable_point_where_there_is_one() {
    let draw = &mut Draw::seeded(35);
    let (mut starts, mut goals, mut nowhere) = (0, 0, 0);
    for _ in 0..2000 {
        let mut world = World::draw(draw, 4);
        for (forward, reverse) in &mut world.lines {
            if draw.chance(0.6) {
                (*forward, *reverse) = (forward.capped(0.0, 0.0), reverse.capped(0.0, 0.0));
            }
        }
        let chain = world.chain();
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        if start.point.x_m == goal.point.x_m {
            continue;
        }
        let allowed = |station: &Station, contact| {
            Direction::BOTH
                .into_iter()
                .any(|d| chain.check_contact(station, contact, d).is_ok_and(|rule| rule.speed_max_m_s() > 0.0))
        };
        let expected: Vec<Contact> = [(start, Contact::Takeoff), (goal, Contact::Landing)]
            .into_iter()
            .filter(|(station, contact)| !allowed(station, *contact))
            .map(|(_, contact)| contact)
            .collect();
        let Outcome::EndpointsRefuse(refusals) = asked(&test, start, goal, &SearchOptions::default()).outcome else {
            assert!(expected.is_empty(), "{expected:?} is not reported");
            continue;
        };
        assert_eq!(refusals.iter().map(|r| r.contact).collect::<Vec<_>>(), expected);
        let (first, last) = chain.geometry().extent_m();
        for refusal in refusals {
            if let Some(nearest) = refusal.nearest {
                assert!(is_usable(&chain, &nearest, refusal.contact));
            } else {
                let x = |i: i32| (first + (last - first) * f64::from(i) / 400.0).min(last);
                let anywhere = (0..=400).map(|i| chain.geometry().station(x(i)).unwrap());
                assert!(!anywhere.clone().any(|s| allowed(&s, refusal.contact)), "usable points exist");
                nowhere += 1;
            }
            if refusal.contact == Contact::Takeoff { starts += 1 } else { goals += 1 }
        }
    }
    assert!(starts > 100 && goals > 100 && nowhere > 10, "{starts} starts, {goals} goals, {nowhere} nowhere");
}

/// The spacings that a search reports.
#[derive(Default)]
struct Spacings(Mutex<Vec<PointSpacing>>);

impl Progress for Spacings {
    fn report(&self, step: &Step) -> ControlFlow<()> {
        if let Detail::PointsPerSegment(points) = step.detail {
            self.0.lock().unwrap().push(PointSpacing::PerSegment(points));
        }
        ControlFlow::Continue(())
    }
}

#[test]
fn automatic_spacing_answers_with_the_first_that_finds_a_path() {
    let draw = &mut Draw::seeded(36);
    let mut later = 0;
    for _ in 0..400 {
        let world = World::draw(draw, 3);
        let chain = world.chain();
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        let tried = Spacings::default();
        let answer = search(&test, start, goal, &SearchOptions::default(), &tried).unwrap();
        let reported = tried.0.into_inner().unwrap();
        let single = |k: u32| {
            asked(&test, start, goal, &SearchOptions { spacing: Some(PointSpacing::PerSegment(k)), ..SearchOptions::default() })
        };
        if matches!(answer.outcome, Outcome::EndpointsRefuse(_)) {
            assert!(reported.is_empty() && answer.pairs_tested == 0);
            continue;
        }
        let tried: Vec<Answer> = AUTO_POINTS_PER_SEGMENT.into_iter().map(single).collect();
        let first = tried.iter().position(|a| a.hops().is_some()).unwrap_or(tried.len() - 1);
        assert_eq!(answer.spacing, PointSpacing::PerSegment(AUTO_POINTS_PER_SEGMENT[first]));
        assert_eq!(answer.points_per_segment, AUTO_POINTS_PER_SEGMENT[first]);
        assert_eq!((&answer.outcome, answer.nodes), (&tried[first].outcome, tried[first].nodes));
        assert_eq!(answer.pairs_tested, tried[..=first].iter().map(|a| a.pairs_tested).sum::<u64>());
        assert_eq!(reported, AUTO_POINTS_PER_SEGMENT[..=first].iter().map(|&k| PointSpacing::PerSegment(k)).collect::<Vec<_>>());
        later += u32::from(first > 0 && answer.hops().is_some());
    }
    assert!(later > 3, "only {later} journeys needed points inside segments");
}

#[test]
fn node_spacing_uses_the_fewest_points_that_keep_it() {
    let draw = &mut Draw::seeded(37);
    for _ in 0..300 {
        let world = World::draw(draw, 5);
        let chain = world.chain();
        let (start, goal) = (chain.geometry().vertex_station(VertexId(0)), chain.geometry().vertex_station(VertexId(5)));
        let widest = draw.log_uniform(1e-2, 2.0) * (world.points[5].x_m - world.points[0].x_m);
        let nodes = NodeSet::new(&chain, start, goal, PointSpacing::AtMostM(widest)).unwrap();
        let length = |a: ChainPoint, b: ChainPoint| (a.x_m - b.x_m).hypot(a.z_m - b.z_m);
        let mut most = 0;
        for pair in world.points.windows(2) {
            let inside = nodes.stations().iter().filter(|s| pair[0].x_m < s.point.x_m && s.point.x_m < pair[1].x_m).count();
            let whole = length(pair[0], pair[1]);
            let gaps = f64::from(u32::try_from(inside).unwrap() + 1);
            assert!(whole / gaps <= widest * (1.0 + 1e-12), "{inside} points leave gaps wider than {widest} m");
            assert!(inside == 0 || whole / (gaps - 1.0) > widest * (1.0 - 1e-12), "{inside} points are more than needed");
            most = most.max(inside);
        }
        assert_eq!(nodes.most_per_segment() as usize, most);
        for pair in nodes.stations().windows(2) {
            assert!(length(pair[0].point, pair[1].point) <= widest * (1.0 + 1e-6), "neighbours too far apart");
        }
    }
}

#[test]
fn too_many_nodes_are_refused_before_they_are_made() {
    let chain = World::draw(&mut Draw::seeded(38), 3).chain();
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    for spacing in [PointSpacing::PerSegment(u32::MAX), PointSpacing::AtMostM(1e-9)] {
        let error = NodeSet::new(&chain, at(0), at(3), spacing).unwrap_err();
        assert!(matches!(error, NodesError::TooMany { nodes } if nodes > NodeSet::MAX_NODES), "{error:?} for {spacing:?}");
    }
}

#[test]
fn a_spacing_that_is_no_distance_is_said_to_be_that() {
    let chain = World::draw(&mut Draw::seeded(38), 3).chain();
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    for found_m in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY] {
        let error = NodeSet::new(&chain, at(0), at(3), PointSpacing::AtMostM(found_m)).unwrap_err();
        assert!(matches!(error, NodesError::Spacing { .. }), "{error:?} for {found_m}");
        assert!(error.to_string().starts_with(&format!("the node spacing is {found_m} m, expected a number above 0")), "{error}");
    }
}

#[test]
fn lower_speeds_or_more_limits_never_give_fewer_hops() {
    let draw = &mut Draw::seeded(39);
    let mut compared = 0;
    for _ in 0..600 {
        let world = World::draw(draw, 4);
        let slow = world.slower(draw.uniform(0.5, 1.0));
        let (chain, slow_chain) = (world.chain(), slow.chain());
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        let options = options(draw, 1);
        let hops = |chain: &ConstrainedChain, hopper: &Hopper| {
            asked(&HopTest::new(chain.with_hopper(hopper, Gravity::new(world.g).unwrap()).unwrap()), start, goal, &options)
                .hops()
                .unwrap_or(u64::MAX)
        };
        let free = hops(&chain, &world.hopper);
        assert!(hops(&slow_chain, &world.hopper) >= free, "lower speeds give fewer hops");
        let reach = (world.lines[0].0.takeoff.speed_max_m_s().powi(2) / world.g).max(1e-3);
        let limited = Hopper::new(HopperLimits {
            clearance_m: world.hopper.limits().clearance_m * 2.0,
            apex_height_max_m: Some(reach * draw.uniform(0.05, 1.0)),
            flight_time_max_s: Some((reach / world.g).sqrt() * draw.uniform(0.5, 3.0)),
            takeoff_speed_min_m_s: world.hopper.limits().takeoff_speed_min_m_s.or_else(|| {
                let any = world.hopper.limits().takeoff_speed_levels.is_none();
                (any && draw.chance(0.3)).then(|| (reach * world.g).sqrt() * draw.uniform(0.3, 0.9))
            }),
            ..*world.hopper.limits()
        })
        .unwrap();
        assert!(hops(&chain, &limited) >= free, "more limits give fewer hops");
        compared += u32::from(free < u64::MAX && free > 0);
    }
    assert!(compared > 150, "only {compared} journeys possible");
}
