//! Plans by an objective on chains, against a second computation over all pairs of nodes, and against the path that is flown.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its chain should stop")]

use chta::{
    ballistics::{Arc, TakeoffChoice},
    chain::{ConstrainedChain, PolygonalChain, Station},
    graph::{Edge, HopGraph, NodeSet, Outcome, PointSpacing, SearchOptions, search},
    hop::{HopTest, Split},
    path::{execute, generate},
    planner::{
        Amount, Amounts, Budgets, ChainQuestion, ChainSearched, LabelCap, LeastAmounts, Objective, SearchedCommands,
        front_on_chain, search_on_chain,
    },
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, LandingMode, RestSlope, SurfaceProperties},
};

use crate::support::Draw;

/// The amounts that a path has without errors.
const AMOUNTS: [Amount; 9] = [
    Amount::Hops,
    Amount::TakeoffSpeed,
    Amount::DeltaV,
    Amount::Energy,
    Amount::FlightTime,
    Amount::MissionTime,
    Amount::Distance,
    Amount::ArcLength,
    Amount::PeakSpeed,
];

/// A random chain with a machine that has every key that totals count.
struct Journey {
    test: HopTest,
    ends: (Station, Station),
    options: SearchOptions,
}

impl Journey {
    fn drawn(draw: &mut Draw) -> Self {
        let (g, size_m) = (draw.log_uniform(0.1, 10.0), draw.log_uniform(1.0, 20.0));
        let speed_m_s = (g * size_m * draw.uniform(0.3, 3.0)).sqrt();
        let sometimes = |draw: &mut Draw, most: f64| if draw.chance(0.5) { Some(draw.uniform(0.0, most)) } else { None };
        let braked = LandingMode::Braked { touchdown_speed_m_s: 0.1 * speed_m_s };
        let limits = HopperLimits {
            clearance_m: if draw.chance(0.5) { 0.02 * size_m } else { 0.0 },
            landing: if draw.chance(0.3) { braked } else { LandingMode::Ballistic },
            mass_kg: Some(draw.uniform(1.0, 50.0)),
            hop_delta_v_overhead_m_s: sometimes(draw, speed_m_s),
            preparation_time_s: sometimes(draw, 60.0),
            settling_time_s: sometimes(draw, 60.0),
            preparation_energy_j: sometimes(draw, 100.0),
            efficiency: draw.chance(0.5).then(|| draw.uniform(0.1, 1.0)),
            ..HopperLimits::with_speeds(speed_m_s, speed_m_s * draw.uniform(0.8, 1.3))
        };
        let grip = Some(Grip::Friction(FrictionCone::new(draw.uniform(0.4, 1.5)).unwrap()));
        let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
        let segments = 4 + draw.below(8);
        let geometry = PolygonalChain::bare(draw.profile(segments, size_m)).unwrap();
        let hopper = Hopper::new(limits).unwrap();
        let chain = ConstrainedChain::new(geometry, &hopper, Gravity::new(g).unwrap(), &surface).unwrap();
        let (first_m, last_m) = chain.geometry().extent_m();
        let mut ends = [first_m, last_m].map(|x_m| chain.geometry().station(x_m).unwrap());
        if draw.chance(0.3) {
            ends.reverse();
        }
        let split = Split::ALL[draw.below(2)];
        let spacing = Some(PointSpacing::PerSegment(u32::try_from(draw.below(3)).unwrap()));
        Self {
            test: HopTest::new(chain),
            ends: (ends[0], ends[1]),
            options: SearchOptions { spacing, split, ..SearchOptions::default() },
        }
    }

    fn nodes(&self) -> NodeSet {
        NodeSet::new(self.test.chain(), self.ends.0, self.ends.1, self.options.spacing.unwrap()).unwrap()
    }

    fn asked(&self, objective: &Objective, budgets: &Budgets, commands: SearchedCommands) -> ChainSearched {
        let question = ChainQuestion { objective, budgets, commands, reliability: None, cap: LabelCap::default() };
        search_on_chain(&self.test, self.ends, &self.options, &question, &()).unwrap()
    }

    /// The amounts of all legs between two nodes, from the equations of an arc alone.
    fn legs(&self, graph: &HopGraph, from: usize, to: usize) -> Vec<Amounts> {
        let (nodes, test) = (graph.nodes(), graph.test());
        let (takeoff, landing) = (&nodes.stations()[from], &nodes.stations()[to]);
        let Ok(edge) = graph.edge(takeoff, landing) else { return Vec::new() };
        let first = from == nodes.start().index();
        match edge {
            Edge::Hop(lofts) => {
                let sight = test.line_of_sight(takeoff, landing).unwrap();
                let choices = [TakeoffChoice::LeastSpeed, TakeoffChoice::MidRange, TakeoffChoice::LeastTime];
                let arcs = choices.map(|choice| Arc::new(sight, test.loft(choice, sight, lofts), test.gravity_m_s2()));
                arcs.map(|arc| self.of_hops(&[(arc, 1.0)], first)).to_vec()
            }
            Edge::Along(along) => {
                let (each_m, last_m) = along.lengths_m(self.options.split);
                let [each, last] = [each_m, last_m].map(|length_m| along.arc(test, length_m, self.options.takeoff));
                #[expect(clippy::cast_precision_loss, reason = "few hops")]
                let others = (along.hops() - 1) as f64;
                vec![self.of_hops(&[(each, others), (last, 1.0)], first)]
            }
        }
    }

    fn of_hops(&self, hops: &[(Arc, f64)], first: bool) -> Amounts {
        amounts_of(self.test.hopper().limits(), hops, first)
    }

    /// The least total of an amount over all paths (Bellman and Ford over all pairs), or the least peak.
    fn least(&self, amount: Amount) -> f64 {
        let nodes = self.nodes();
        let options = &self.options;
        let graph = HopGraph::new(&self.test, &nodes, options.effort, options.takeoff, options.split);
        let count = nodes.stations().len();
        let all = (0..count).flat_map(|from| (0..count).filter(move |to| *to != from).map(move |to| (from, to)));
        let mut edges: Vec<(usize, usize, f64)> = Vec::new();
        for (from, to) in all {
            edges.extend(self.legs(&graph, from, to).iter().map(|leg| (from, to, leg.of(amount))));
        }
        let mut least = vec![f64::INFINITY; count];
        least[nodes.start().index()] = 0.0;
        for _ in 0..count {
            for &(from, to, leg) in &edges {
                let through = if amount == Amount::PeakSpeed { least[from].max(leg) } else { least[from] + leg };
                least[to] = least[to].min(through);
            }
        }
        least[nodes.goal().index()]
    }
}

/// What so many hops along each of these arcs take, from the equations of an arc alone.
pub(crate) fn amounts_of(limits: &HopperLimits, hops: &[(Arc, f64)], first: bool) -> Amounts {
    let waits = limits.preparation_time_s.unwrap_or(0.0) + limits.settling_time_s.unwrap_or(0.0);
    let mut sum = Amounts::NONE;
    for (arc, count) in hops.iter().filter(|(_, count)| *count > 0.0) {
        let v = arc.takeoff_speed_m_s();
        let (across, down) = (arc.horizontal_speed_m_s(), arc.horizontal_speed_m_s() * arc.landing_slope());
        let braking = limits.landing.touchdown_speed_m_s().map_or(0.0, |touchdown| across.hypot(down + touchdown));
        let mut add = |amount, each: f64| sum = sum.with(amount, sum.of(amount) + each * count);
        add(Amount::Hops, 1.0);
        add(Amount::TakeoffSpeed, v);
        add(Amount::DeltaV, v + braking + limits.hop_delta_v_overhead_m_s.unwrap_or(0.0));
        let prepared = limits.preparation_energy_j.unwrap_or(0.0) / limits.mass_kg.unwrap_or(1.0);
        add(Amount::Energy, 0.5 * v * v / limits.efficiency.unwrap_or(1.0) + prepared);
        add(Amount::FlightTime, arc.flight_time_s());
        add(Amount::MissionTime, arc.flight_time_s() + waits);
        add(Amount::Distance, arc.line_of_sight().run_m());
        add(Amount::ArcLength, arc.length_m());
        sum = sum.with(Amount::PeakSpeed, sum.of(Amount::PeakSpeed).max(v));
    }
    let settled = if first { limits.settling_time_s.unwrap_or(0.0) } else { 0.0 };
    sum.with(Amount::MissionTime, sum.of(Amount::MissionTime) - settled)
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (1.0 + a.abs().max(b.abs()))
}

#[test]
fn the_least_total_is_that_of_all_pairs_and_the_path_flown_has_it() {
    let mut draw = Draw::seeded(170);
    let (mut paths, mut along, mut other_commands) = (0, 0, 0);
    for case in 0..160 {
        let journey = Journey::drawn(&mut draw);
        if search(&journey.test, journey.ends.0, journey.ends.1, &journey.options, &()).unwrap().hops().is_none() {
            continue;
        }
        paths += 1;
        for amount in AMOUNTS {
            let objective = Objective::of(amount);
            let found = journey.asked(&objective, &Budgets::NONE, SearchedCommands::Distinct);
            let (totals, least) = (found.totals.unwrap(), journey.least(amount));
            assert!(
                found.within && !found.capped && close(totals.of(amount), least),
                "case {case}: {amount} {totals:?}, least {least}"
            );
            let Outcome::Path { legs, cost } = &found.answer.outcome else { panic!("case {case}") };
            along += legs.iter().filter(|leg| matches!(leg.edge, Edge::Along(_))).count();
            let path = generate(&journey.test, legs, journey.options.takeoff, journey.options.split).unwrap();
            let flown = path.amounts();
            for amount in AMOUNTS {
                assert!(close(flown.of(amount), totals.of(amount)), "case {case}: {amount}: {flown:?}, planned {totals:?}");
            }
            assert!(close(cost.effort(), flown.of(Amount::TakeoffSpeed)) && flown.of(Amount::Hops) == totals.of(Amount::Hops));
            let execution = execute(journey.test.chain(), &path, Some(journey.ends));
            assert!(execution.passes(), "case {case}: {amount}: {:?}", execution.violations);
            // A budget that is just that, one below it, and a least total that says so.
            let budgets = |most: f64| Budgets::NONE.with(amount, most).unwrap();
            let touching = journey.asked(&objective, &budgets(totals.of(amount)), SearchedCommands::Distinct);
            assert!(touching.within && close(touching.totals.unwrap().of(amount), least), "case {case}: {amount}");
            let below = journey.asked(&objective, &budgets(0.999 * totals.of(amount)), SearchedCommands::Distinct);
            assert!(!below.within && close(below.unmet[0].least, least), "case {case}: {amount}: {:?}", below.unmet);
        }
        let by_effort = Objective::new(vec![Amount::Hops, Amount::TakeoffSpeed]).unwrap();
        let chosen = journey.asked(&by_effort, &Budgets::NONE, SearchedCommands::Chosen).answer;
        let today = search(&journey.test, journey.ends.0, journey.ends.1, &journey.options, &()).unwrap();
        let effort = |answer: &chta::graph::Answer| match &answer.outcome {
            Outcome::Path { cost, .. } => cost.effort(),
            _ => f64::NAN,
        };
        assert_eq!(chosen.hops(), today.hops(), "case {case}");
        assert!(close(effort(&chosen), effort(&today)), "case {case}");
        let fastest = journey.asked(&Objective::of(Amount::FlightTime), &Budgets::NONE, SearchedCommands::Distinct);
        let least_speed = journey.asked(&Objective::of(Amount::FlightTime), &Budgets::NONE, SearchedCommands::Chosen);
        other_commands +=
            usize::from(fastest.totals.unwrap().of(Amount::FlightTime) < least_speed.totals.unwrap().of(Amount::FlightTime));
    }
    assert!(
        paths > 50 && along > 20 && other_commands > 20,
        "{paths} paths, {along} legs along a segment, {other_commands} other commands"
    );
}

#[test]
fn a_front_improves_step_by_step_and_ends_are_the_least_of_either_amount() {
    let mut draw = Draw::seeded(171);
    let mut long = 0;
    for case in 0..80 {
        let mut journey = Journey::drawn(&mut draw);
        journey.options.spacing = Some(PointSpacing::PerSegment(3));
        let journey = journey;
        let fewest = search(&journey.test, journey.ends.0, journey.ends.1, &journey.options, &()).unwrap().hops();
        let Some(fewest) = fewest else { continue };
        for amount in [Amount::Energy, Amount::FlightTime, Amount::MissionTime, Amount::DeltaV] {
            let (objective, budgets) = (Objective::of(amount), Budgets::NONE);
            let question = ChainQuestion {
                objective: &objective,
                budgets: &budgets,
                commands: SearchedCommands::Distinct,
                reliability: None,
                cap: LabelCap::default(),
            };
            let of = (&journey.options, journey.options.spacing.unwrap());
            let (front, capped) = front_on_chain(&journey.test, journey.ends, of, (amount, &question), &()).unwrap();
            assert!(!capped);
            let points: Vec<[f64; 2]> =
                front.iter().map(|path| [Amount::Hops, amount].map(|amount| path.totals.of(amount))).collect();
            assert!(points.is_sorted_by(|a, b| a[0] < b[0] && a[1] > b[1]), "case {case}: {points:?}");
            #[expect(clippy::cast_precision_loss, reason = "few hops")]
            let fewest = fewest as f64;
            assert_eq!(points[0][0], fewest, "case {case}");
            assert!(close(points[points.len() - 1][1], journey.least(amount)), "case {case}: {amount}");
            // Each of them is what a plan within so many hops finds.
            for path in &front {
                let budgets = Budgets::NONE.with(Amount::Hops, path.totals.of(Amount::Hops)).unwrap();
                let planned = journey.asked(&objective, &budgets, SearchedCommands::Distinct);
                assert!(close(planned.totals.unwrap().of(amount), path.totals.of(amount)), "case {case}: {amount}");
            }
            long += usize::from(points.len() > 1);
        }
    }
    assert!(long > 10, "{long} fronts of two paths or more");
}

#[test]
fn lower_bounds_are_below_every_leg_and_consistent() {
    let mut draw = Draw::seeded(172);
    let (mut legs, mut tight) = (0, 0);
    for case in 0..120 {
        let journey = Journey::drawn(&mut draw);
        let nodes = journey.nodes();
        let graph = HopGraph::new(&journey.test, &nodes, journey.options.effort, journey.options.takeoff, journey.options.split);
        let limits = journey.test.hopper().limits();
        let heights = || journey.test.chain().geometry().vertices().iter().map(|vertex| vertex.z_m);
        let relief_m = heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min);
        let landing_m_s = if limits.landing.brakes() { f64::INFINITY } else { limits.landing_speed_max_m_s };
        let speeds = (limits.takeoff_speed_max_m_s, landing_m_s);
        let least = LeastAmounts::new(limits, journey.test.gravity_m_s2(), speeds, relief_m);
        let goal = nodes.station(nodes.goal()).point;
        let bound = |node: usize| {
            let here = nodes.stations()[node].point;
            least.over((goal.x_m - here.x_m).abs(), goal.z_m - here.z_m)
        };
        for from in (0..nodes.stations().len()).filter(|from| *from != nodes.start().index()) {
            for to in (0..nodes.stations().len()).filter(|to| *to != from) {
                for leg in journey.legs(&graph, from, to) {
                    legs += 1;
                    for amount in AMOUNTS.into_iter().filter(|amount| amount.adds_up()) {
                        let (here, after) = (bound(from).of(amount), leg.of(amount) + bound(to).of(amount));
                        assert!(here <= after * (1.0 + 1e-12), "case {case}, {amount}: {here} from {from}, {after} by way of {to}");
                        tight += usize::from(to == nodes.goal().index() && here > 0.999 * after);
                    }
                }
            }
        }
    }
    assert!(legs > 10_000 && tight > 500, "{legs} legs, {tight} bounds of a single leg nearly met");
}
