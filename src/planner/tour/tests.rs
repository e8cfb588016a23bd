//! The table against all orders, and missions over a DEM against one search over nodes and visited sets together.

use std::cmp::Ordering;

use super::{
    super::{
        Amount, Amounts, Budgets, LabelCap, LegGraph, LegVisitor, Objective, SearchedCommands, Successor, SurfaceNode,
        labels::{Tracked, by_objective},
        search::Run,
        surface_hops::{Side, SurfaceHops},
        surface_legs::{LegOffers, Settling},
    },
    allowance::OtherLegs,
    table::{LegCosts, VisitRules, most_visits},
    *,
};
use crate::{
    draw::Draw,
    planner::{NodesPerPost, SurfaceLattice},
    progress::{Cancelled, Meter, Stage},
    terrain::{Dem, GeoReference, OverlaidDem, Overlays},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// The best of all orders, by trying each: the count, and what it takes.
fn enumerated(
    costs: &LegCosts,
    targets: usize,
    rules: VisitRules,
    objective: &Objective,
    budgets: &Budgets,
) -> (u32, Option<Vec<f64>>) {
    struct All<'a> {
        costs: &'a LegCosts,
        targets: usize,
        rules: VisitRules,
        objective: &'a Objective,
        budgets: &'a Budgets,
        best: (u32, Option<Vec<f64>>),
    }
    impl All<'_> {
        fn ends(&mut self, set: u16, totals: &Amounts) {
            let key: Vec<f64> = self.objective.amounts().iter().map(|amount| totals.of(*amount)).collect();
            let is_better = match (set.count_ones().cmp(&self.best.0), &self.best.1) {
                (Ordering::Greater, _) | (Ordering::Equal, None) => true,
                (Ordering::Equal, Some(known)) => by_objective(&key, known).is_lt(),
                (Ordering::Less, _) => false,
            };
            if is_better && self.budgets.exceeded_by(totals).next().is_none() {
                self.best = (set.count_ones(), Some(key));
            }
        }

        fn from(&mut self, at: usize, set: u16, totals: Amounts) {
            if set != 0 && !self.rules.returns {
                self.ends(set, &totals);
            }
            if set != 0 && self.rules.returns {
                for way in self.costs.between([at, 0]) {
                    self.ends(set, &totals.then(way));
                }
            }
            for to in 1..=self.targets {
                let bit = 1 << (to - 1);
                if set & bit != 0 || (self.rules.order == VisitOrder::Given && to < at) {
                    continue;
                }
                for way in self.costs.between([at, to]) {
                    self.from(to, set | bit, totals.then(way));
                }
            }
        }
    }
    let mut all = All { costs, targets, rules, objective, budgets, best: (0, None) };
    all.from(0, 0, Amounts::NONE);
    all.best
}

/// Whole numbers, so that sums in any order are equal; energy and mission time pull apart.
fn random_costs(draw: &mut Draw, targets: usize, ways_max: usize) -> LegCosts {
    let mut costs = LegCosts::none(targets);
    let pairs = (0..=targets).flat_map(|from| (0..=targets).map(move |to| [from, to])).filter(|[from, to]| from != to);
    for pair in pairs {
        let ways = if draw.chance(0.15) { 0 } else { 1 + draw.below(ways_max) };
        let mut way = || {
            let mut number = || f64::from(u32::try_from(draw.below(30)).unwrap());
            let amounts = Amounts::NONE.with(Amount::Hops, number()).with(Amount::Energy, number());
            amounts.with(Amount::MissionTime, number()).with(Amount::PeakSpeed, number())
        };
        costs.set(pair, (0..ways).map(|_| way()).collect());
    }
    costs
}

#[test]
fn the_table_equals_all_orders_of_up_to_seven_targets() {
    let draw = &mut Draw::seeded(2101);
    let (mut whole, mut some, mut within) = (0, 0, 0);
    for case in 0..240 {
        let targets = 1 + draw.below(if case % 40 == 0 { 7 } else { 5 });
        let ways = if targets > 4 { 1 } else { 1 + draw.below(3) };
        let costs = random_costs(draw, targets, ways);
        let order = if draw.chance(0.3) { VisitOrder::Given } else { VisitOrder::Best };
        let rules = VisitRules { order, returns: draw.chance(0.4), allowed: u16::MAX };
        let objective = match draw.below(3) {
            0 => Objective::of(Amount::Energy),
            1 => Objective::new(vec![Amount::Hops, Amount::Energy]).unwrap(),
            _ => Objective::new(vec![Amount::Hops, Amount::PeakSpeed]).unwrap(),
        };
        let budgets = match draw.below(3) {
            0 => Budgets::NONE,
            1 => Budgets::NONE.with(Amount::MissionTime, draw.uniform(5.0, 80.0)).unwrap(),
            _ => Budgets::NONE.with(Amount::MissionTime, draw.uniform(5.0, 80.0)).unwrap().with(Amount::Hops, 60.0).unwrap(),
        };
        let (found, capped) = most_visits(&costs, rules, (&objective, &budgets, LabelCap::default())).unwrap();
        let (count, best) = enumerated(&costs, targets, rules, &objective, &budgets);
        let totals: Vec<f64> = objective.amounts().iter().map(|amount| found.totals.of(*amount)).collect();
        assert!(!capped);
        assert_eq!((found.set().count_ones(), best.is_some().then_some(totals)), (count, best), "case {case}");
        whole += u32::from(count as usize == targets);
        some += u32::from(count > 0 && (count as usize) < targets);
        within += u32::from(!budgets.are_none() && count > 1);
    }
    assert!(whole > 60 && some > 30 && within > 60, "{whole} whole, {some} in part, {within} within budgets");
}

/// Every mission from a stop on, with its legs and how many targets it visits.
fn missions(
    (rules, targets): (VisitRules, usize),
    (at, set): (usize, u16),
    legs: &mut Vec<[usize; 2]>,
    each: &mut dyn FnMut(&[[usize; 2]], u32),
) {
    if set != 0 && rules.returns {
        legs.push([at, 0]);
        each(legs, set.count_ones());
        legs.pop();
    } else if set != 0 {
        each(legs, set.count_ones());
    }
    for to in 1..=targets {
        let bit = 1 << (to - 1);
        if set & bit == 0 && rules.allowed & bit != 0 && (rules.order == VisitOrder::Best || to > at) {
            legs.push([at, to]);
            missions((rules, targets), (to, set | bit), legs, each);
            legs.pop();
        }
    }
}

#[test]
fn what_is_left_to_a_leg_equals_all_missions() {
    let draw = &mut Draw::seeded(2103);
    let (mut left, mut without) = (0, 0);
    for case in 0..200 {
        let targets = 1 + draw.below(5);
        let order = if draw.chance(0.3) { VisitOrder::Given } else { VisitOrder::Best };
        let allowed = if draw.chance(0.3) { 0b01_0111 } else { u16::MAX };
        let rules = VisitRules { order, returns: draw.chance(0.5), allowed };
        let stops = targets + 1;
        let number = |draw: &mut Draw| f64::from(u32::try_from(draw.below(30)).unwrap());
        let least: Vec<f64> = (0..stops * stops).map(|_| if draw.chance(0.2) { f64::INFINITY } else { number(draw) }).collect();
        let least = |[from, to]: [usize; 2]| least[from * stops + to];
        let visited_min = 1 + u32::try_from(draw.below(targets)).unwrap();
        let others = OtherLegs::of(&least, targets, rules, visited_min);
        let mut expected = vec![f64::INFINITY; stops * stops];
        missions((rules, targets), (0, 0), &mut Vec::new(), &mut |legs, visited| {
            for (number, [from, to]) in legs.iter().enumerate().filter(|_| visited >= visited_min) {
                let rest: f64 = legs.iter().enumerate().filter(|(other, _)| *other != number).map(|(_, leg)| least(*leg)).sum();
                let known = &mut expected[from * stops + to];
                *known = known.min(rest);
            }
        });
        for (from, to) in (0..stops).flat_map(|from| (0..stops).map(move |to| (from, to))) {
            let total = 60.0;
            let rest = expected[from * stops + to];
            match others.allowance([from, to], total) {
                Some(allowance) => assert!((allowance - (total - rest)).abs() < 1e-5, "case {case}, {from} to {to}: {allowance}"),
                None => assert!(rest.is_infinite() || rest > total, "case {case}, {from} to {to}: {rest}"),
            }
            left += u32::from(rest <= total);
            without += u32::from(rest > total && from != to);
        }
    }
    assert!(left > 500 && without > 500, "{left} legs with something left, {without} without");
}

/// Three targets in a row: to the nearest first and on to the far ends costs the way between them twice.
#[test]
fn going_to_the_nearest_target_first_loses() {
    // Along a line: the start at 0, targets at 1, -2 and 5.
    let at = [0.0, 1.0, -2.0, 5.0_f64];
    let mut costs = LegCosts::none(3);
    for (from, to) in (0..4).flat_map(|from| (0..4).map(move |to| (from, to))).filter(|(from, to)| from != to) {
        costs.set([from, to], vec![Amounts::NONE.with(Amount::Distance, (at[to] - at[from]).abs())]);
    }
    let rules = VisitRules { order: VisitOrder::Best, returns: false, allowed: u16::MAX };
    let (found, _) = most_visits(&costs, rules, (&Objective::of(Amount::Distance), &Budgets::NONE, LabelCap::default())).unwrap();
    // Nearest first: 1, -2, 5 is 1 + 3 + 7 = 11.
    assert_eq!((found.stops, found.totals.of(Amount::Distance)), (vec![0, 2, 1, 3], 9.0));
}

fn ground(draw: &mut Draw, side: usize) -> DemGround {
    let relief_m = draw.log_uniform(0.1, 1.5);
    let tilt = draw.uniform(-0.3, 0.3);
    let height = |draw: &mut Draw, col: f64| if draw.chance(0.05) { f64::NAN } else { draw.uniform(0.0, relief_m) + tilt * col };
    let heights = (0..side * side).map(|i| height(draw, f64::from(u32::try_from(i % side).unwrap()))).collect();
    let dem = Dem::new(side, side, heights, GeoReference::local(MapPoint::new(3.0, 40.0), 1.0, 1.3).unwrap()).unwrap();
    let grip = Some(Grip::Friction(FrictionCone::new(draw.uniform(0.5, 1.5)).unwrap()));
    let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
    let limits = HopperLimits { settling_time_s: Some(0.7), preparation_time_s: Some(0.2), ..HopperLimits::with_speeds(3.2, 2.9) };
    let hopper = Hopper::new(limits).unwrap();
    DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(2.1).unwrap(), &surface)
}

/// Nodes and visited targets together, with every hop between nodes: the mission as one search, without legs and without a table.
struct Product<'a> {
    first: LegOffers<'a>,
    later: LegOffers<'a>,
    nodes: usize,
    stops: Vec<usize>,
    meter: &'a Meter<'a>,
}

impl Product<'_> {
    fn state(&self, set: usize, node: usize) -> usize {
        let at = self.stops[1..].iter().position(|stop| *stop == node);
        (set | at.map_or(0, |target| 1 << target)) * self.nodes + node
    }
}

struct InSet<'p, 'a> {
    product: &'p Product<'a>,
    set: usize,
    visitor: &'p mut dyn LegVisitor,
}

impl LegVisitor for InSet<'_, '_> {
    fn visit(&mut self, leg: &Successor) {
        self.visitor.visit(&Successor { node: self.product.state(self.set, leg.node), ..*leg });
    }
}

impl LegGraph for Product<'_> {
    fn nodes(&self) -> usize {
        (self.nodes << (self.stops.len() - 1)) + 1
    }

    fn successors(&self, state: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        let (set, node) = (state / self.nodes, state % self.nodes);
        let offers = if set == 0 && node == self.stops[0] { &self.first } else { &self.later };
        let mut inner = InSet { product: self, set, visitor };
        offers.visit((SurfaceNode::of_index(node), Side::Start), &|_| true, &mut inner, None, &mut self.meter.counter())?;
        Ok(())
    }

    fn least_to_goal(&self, _: usize) -> Amounts {
        Amounts::NONE
    }
}

#[test]
fn a_mission_equals_one_search_over_nodes_and_visited_sets() {
    let draw = &mut Draw::seeded(2102);
    let (mut whole, mut some, mut over) = (0, 0, 0);
    for case in 0..90 {
        let ground = ground(draw, 5);
        let bounds = ground.terrain().dem().bounds();
        let count = 2 + draw.below(3);
        let mut point = || MapPoint::new(draw.uniform(bounds.min.x, bounds.max.x), draw.uniform(bounds.min.y, bounds.max.y));
        let stops: Vec<MapPoint> = (0..=count).map(|_| point()).collect();
        if stops.iter().any(|at| ground.position(*at).is_none()) {
            continue;
        }
        let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(1));
        let nodes = SurfaceNodes::new(&ground, lattice, stops.iter().copied()).unwrap();
        let objective = match draw.below(3) {
            0 => Objective::hops_then(Effort::TakeoffSpeed),
            1 => Objective::of(Amount::Energy),
            _ => Objective::of(Amount::MissionTime),
        };
        let returns = draw.chance(0.4);
        let commands = SearchedCommands::Distinct;
        let takeoff = TakeoffChoice::LeastSpeed;
        let within = |budgets: &Budgets| {
            let route = RouteQuestion { objective: &objective, budgets, commands, errors: None, cap: LabelCap::default() };
            let question = TourQuestion { route, effort: Effort::TakeoffSpeed, takeoff, order: VisitOrder::Best, returns };
            tour(&ground, &nodes, &stops, &question, &()).unwrap()
        };
        // Some budgets just below what the best mission takes without them.
        let tight = |draw: &mut Draw, amount: Amount| {
            let least = within(&Budgets::NONE).totals.of(amount);
            Budgets::NONE.with(amount, least * draw.uniform(0.8, 1.0)).unwrap()
        };
        let budgets = match draw.below(5) {
            0 => Budgets::NONE,
            1 => Budgets::NONE.with(Amount::MissionTime, draw.uniform(4.0, 20.0)).unwrap(),
            2 => Budgets::NONE.with(Amount::Energy, draw.uniform(8.0, 40.0)).unwrap(),
            3 => tight(draw, Amount::MissionTime),
            _ => tight(draw, Amount::Energy),
        };
        let found = within(&budgets);

        let surface = SurfaceHops::new(&ground, &nodes);
        let meter = Meter::new(&(), Stage::Search);
        let at: Vec<usize> = stops.iter().map(|stop| nodes.place(*stop).unwrap().index()).collect();
        let offers = |settling| LegOffers::new(&surface, settling, (commands, takeoff), None);
        let product = Product {
            first: offers(Settling::BeforeAllBut(SurfaceNode::of_index(at[0]))),
            later: offers(Settling::BeforeAll),
            nodes: nodes.count(),
            stops: at.clone(),
            meter: &meter,
        };
        let mut run = Run::new(&product, (at[0], product.nodes() - 1), Tracked::new(&objective, &budgets), LabelCap::default());
        run.until(false).unwrap();
        let width = objective.amounts().len();
        let ends = |node: usize| !returns || node == at[0];
        let states = (0..1usize << count).flat_map(|set| (0..nodes.count()).map(move |node| (set, node)));
        let labels = states.filter(|(_, node)| ends(*node)).flat_map(|(set, node)| {
            let run = &run;
            run.labels.of_node(set * nodes.count() + node).map(move |label| (set.count_ones(), &run.labels.totals(label)[..width]))
        });
        let best = labels.min_by(|a, b| b.0.cmp(&a.0).then(by_objective(a.1, b.1))).unwrap();
        assert!(!found.capped && !run.labels.capped);
        let visited = count - found.left_out.len();
        assert_eq!(visited, best.0 as usize, "case {case}: {objective}");
        for (amount, expected) in objective.amounts().iter().zip(best.1) {
            let total = found.totals.of(*amount);
            assert!((total - expected).abs() <= 1e-9 * (1.0 + expected), "case {case}: {objective}: {total}, {expected}");
        }
        let legs = found.legs.iter().fold(Amounts::NONE, |totals, leg| totals.then(&leg.path.totals));
        assert_eq!(legs, found.totals, "case {case}");
        assert!(
            found
                .legs
                .windows(2)
                .all(|pair| pair[0].to == pair[1].from && pair[0].path.places.last() == pair[1].path.places.first())
        );
        for (target, why) in &found.left_out {
            if let WhyLeftOut::Budgets(of) = why {
                assert!(!of.is_empty() && of.iter().all(|over| over.total > over.most), "case {case}: target {target}");
                over += 1;
            }
        }
        whole += u32::from(visited == count);
        some += u32::from(visited > 0 && visited < count);
    }
    assert!(whole > 30 && some > 1 && over > 1, "{whole} whole, {some} in part, {over} over budgets");
}

/// What no leg takes fewer of, no mission does.
#[test]
fn the_bound_of_visits_is_that_of_the_best_order() {
    // From 0 over 3 and 1 to 2: hops as distances on a line.
    let at = [0u64, 6, 9, 2];
    let hops = |[from, to]: [usize; 2]| Some(at[from].abs_diff(at[to]));
    assert_eq!(fewest_hops_of_visits(&hops, 3, VisitOrder::Best, false), Some(9));
    assert_eq!(fewest_hops_of_visits(&hops, 3, VisitOrder::Best, true), Some(18));
    assert_eq!(fewest_hops_of_visits(&hops, 3, VisitOrder::Given, false), Some(6 + 3 + 7));
    assert_eq!(fewest_hops_of_visits(&|_| None, 3, VisitOrder::Given, false), None);
}
