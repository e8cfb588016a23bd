//! Searches against the enumeration of all paths on tiny graphs, biased to ties, zeros, parallel commands and budgets that touch.

use std::cmp::Ordering;

use super::{search::without_budgets, *};
use crate::{draw::Draw, progress::Cancelled};

const NODES: usize = 6;
/// What the legs of the tests take; the rest is zero.
const USED: [Amount; 4] = [Amount::Hops, Amount::Energy, Amount::MissionTime, Amount::PeakSpeed];

/// A graph with stored edges, with or without bounds.
#[derive(Clone, Debug)]
struct Stored {
    edges: Vec<Vec<Successor>>,
    least: Vec<Amounts>,
}

impl LegGraph for Stored {
    fn nodes(&self) -> usize {
        self.edges.len()
    }

    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        for leg in &self.edges[node] {
            // Any bound does: that of the leg itself, of some legs.
            let wanted = leg.command != 0 || visitor.may_improve(leg.node, &leg.amounts) && visitor.wants(leg.node, &leg.amounts);
            if wanted {
                visitor.visit(leg);
            }
        }
        Ok(())
    }

    fn least_to_goal(&self, node: usize) -> Amounts {
        self.least[node]
    }
}

impl Stored {
    /// Small whole numbers, whose sums are exact; some edges twice or thrice, some nodes without any.
    fn drawn(draw: &mut Draw) -> Self {
        let mut edges = vec![Vec::new(); NODES];
        for (node, out) in edges.iter_mut().enumerate() {
            for target in (0..NODES).filter(|target| *target != node) {
                if !draw.chance(0.45) {
                    continue;
                }
                let hops = if draw.chance(0.8) { 1.0 } else { 3.0 };
                for command in 0..[1, 1, 2, 3][draw.below(4)] {
                    let mut small = || [0.0, 0.0, 1.0, 2.0, 3.0][draw.below(5)];
                    let amounts = Amounts::NONE
                        .with(Amount::Hops, hops)
                        .with(Amount::Energy, small())
                        .with(Amount::MissionTime, small())
                        .with(Amount::PeakSpeed, small());
                    out.push(Successor { node: target, command, amounts });
                }
            }
        }
        Self { edges, least: vec![Amounts::NONE; NODES] }
    }

    /// The same with the greatest bounds there are: the least of each amount that any path to the goal takes.
    fn with_bounds(&self, goal: usize) -> Self {
        let mut least = vec![Amounts::NONE; NODES];
        for amount in USED.into_iter().filter(|amount| amount.adds_up()) {
            let mut to_goal = [f64::INFINITY; NODES];
            to_goal[goal] = 0.0;
            for _ in 0..NODES {
                for (node, out) in self.edges.iter().enumerate() {
                    let through = out.iter().map(|leg| leg.amounts.of(amount) + to_goal[leg.node]).fold(f64::INFINITY, f64::min);
                    to_goal[node] = to_goal[node].min(through);
                }
            }
            // A node from which no path leads on may have any bound; an infinite one tells it.
            for (least, to_goal) in least.iter_mut().zip(to_goal) {
                *least = least.with(amount, to_goal);
            }
        }
        Self { least, ..self.clone() }
    }

    /// The totals of all paths without a node twice.
    fn all_paths(&self, start: usize, goal: usize) -> Vec<Amounts> {
        let mut found = Vec::new();
        self.extend(start, goal, Amounts::NONE, &mut vec![start], &mut found);
        found
    }

    fn extend(&self, node: usize, goal: usize, so_far: Amounts, visited: &mut Vec<usize>, found: &mut Vec<Amounts>) {
        if node == goal {
            found.push(so_far);
            return;
        }
        for leg in &self.edges[node] {
            if !visited.contains(&leg.node) {
                visited.push(leg.node);
                self.extend(leg.node, goal, so_far.then(&leg.amounts), visited, found);
                visited.pop();
            }
        }
    }
}

fn by(objective: &Objective, a: &Amounts, b: &Amounts) -> Ordering {
    let orders = objective.amounts().iter().map(|amount| a.of(*amount).total_cmp(&b.of(*amount)));
    orders.fold(Ordering::Equal, Ordering::then)
}

/// One to three different amounts, the peak last.
fn drawn_objective(draw: &mut Draw) -> Objective {
    let mut amounts = Vec::new();
    for _ in 0..=draw.below(3) {
        let amount = USED[draw.below(3)];
        if !amounts.contains(&amount) {
            amounts.push(amount);
        }
    }
    if draw.chance(0.3) {
        amounts.push(Amount::PeakSpeed);
    }
    Objective::new(amounts).unwrap()
}

/// Budgets of up to three amounts; many touch a total of some path exactly.
fn drawn_budgets(draw: &mut Draw, paths: &[Amounts]) -> Budgets {
    let mut budgets = Budgets::NONE;
    for amount in USED {
        if draw.chance(0.4) {
            let most = if paths.is_empty() || draw.chance(0.2) { 3.0 } else { paths[draw.below(paths.len())].of(amount) };
            budgets = budgets.with(amount, most).unwrap();
        }
    }
    budgets
}

#[test]
fn the_best_path_is_that_of_all_paths_with_and_without_bounds_and_budgets() {
    let mut draw = Draw::seeded(17);
    let (mut found, mut unreachable, mut over, mut touched, mut tied) = (0, 0, 0, 0, 0);
    for case in 0..6000 {
        let graph = Stored::drawn(&mut draw);
        let (start, goal) = (draw.below(NODES), draw.below(NODES));
        let paths = graph.all_paths(start, goal);
        let (objective, budgets) = (drawn_objective(&mut draw), drawn_budgets(&mut draw, &paths));
        let allowed: Vec<&Amounts> = paths.iter().filter(|totals| budgets.exceeded_by(totals).next().is_none()).collect();
        let best = allowed.iter().copied().min_by(|a, b| by(&objective, a, b));
        for with_bounds in [false, true] {
            let graph = if with_bounds { graph.with_bounds(goal) } else { graph.clone() };
            let result = search(&graph, (start, goal), &objective, &budgets, LabelCap::default()).unwrap();
            let what =
                format!("case {case}, bounds {with_bounds}: {objective} within {budgets:?} from {start} to {goal} of {graph:?}");
            assert!(!result.capped, "{what}");
            assert_eq!(result.path.is_some(), best.is_some(), "{what}");
            let (Some(path), Some(best)) = (result.path, best) else { continue };
            assert_eq!(by(&objective, &path.totals, best), Ordering::Equal, "{:?} and {best:?}, {what}", path.totals);
            assert_eq!(budgets.exceeded_by(&path.totals).count(), 0, "{what}");
            let (mut at, mut sum) = (start, Amounts::NONE);
            for step in &path.steps {
                assert_eq!(step.from, at, "{what}");
                let leg = graph.edges[at].iter().find(|leg| leg.node == step.to && leg.command == step.command).expect(&what);
                (at, sum) = (leg.node, sum.then(&leg.amounts));
            }
            assert_eq!((at, sum), (goal, path.totals), "{what}");
        }
        found += usize::from(best.is_some());
        unreachable += usize::from(paths.is_empty());
        over += usize::from(best.is_none() && !paths.is_empty());
        touched += usize::from(best.is_some_and(|best| budgets.all().any(|(amount, most)| best.of(amount) == most)));
        tied +=
            usize::from(best.is_some_and(|best| allowed.iter().filter(|other| by(&objective, other, best).is_eq()).count() > 1));
    }
    assert!(
        found > 3000 && unreachable > 50 && over > 100 && touched > 500 && tied > 500,
        "{found} found, {unreachable} unreachable, {over} over budget, {touched} touched, {tied} tied"
    );
}

#[test]
fn a_looser_budget_is_never_worse() {
    let mut draw = Draw::seeded(18);
    let mut better = 0;
    for case in 0..2000 {
        let graph = Stored::drawn(&mut draw);
        let ends = (0, NODES - 1);
        let objective = drawn_objective(&mut draw);
        let tight = drawn_budgets(&mut draw, &graph.all_paths(ends.0, ends.1));
        let mut loose = Budgets::NONE;
        for (amount, most) in tight.all() {
            loose = loose.with(amount, most + [0.0, 1.0, 2.0][draw.below(3)]).unwrap();
        }
        let [tight, loose] =
            [tight, loose].map(|budgets| search(&graph, ends, &objective, &budgets, LabelCap::default()).unwrap().path);
        match (tight, loose) {
            (Some(tight), Some(loose)) => {
                let order = by(&objective, &loose.totals, &tight.totals);
                assert!(order.is_le(), "case {case}");
                better += usize::from(order.is_lt());
            }
            (tight, loose) => assert!(tight.is_none() || loose.is_some(), "case {case}"),
        }
    }
    assert!(better > 50, "{better} better");
}

#[test]
fn a_front_is_that_of_all_paths() {
    let mut draw = Draw::seeded(19);
    let mut lengths = [0; 8];
    for case in 0..4000 {
        let graph = Stored::drawn(&mut draw);
        let ends = (draw.below(NODES), draw.below(NODES));
        let paths = graph.all_paths(ends.0, ends.1);
        let budgets = if draw.chance(0.5) { drawn_budgets(&mut draw, &paths) } else { Budgets::NONE };
        let second = [Amount::Energy, Amount::MissionTime][draw.below(2)];
        let mut expected: Vec<[f64; 2]> = Vec::new();
        let allowed = paths.iter().filter(|totals| budgets.exceeded_by(totals).next().is_none());
        let mut all: Vec<[f64; 2]> = allowed.map(|totals| [Amount::Hops, second].map(|amount| totals.of(amount))).collect();
        all.sort_by(|a, b| a.partial_cmp(b).unwrap());
        for point in all {
            if expected.last().is_none_or(|last| point[1] < last[1]) {
                expected.push(point);
            }
        }
        for graph in [graph.clone(), graph.with_bounds(ends.1)] {
            let (found, capped) = front(&graph, ends, (Amount::Hops, second), &budgets, LabelCap::default()).unwrap();
            let found: Vec<[f64; 2]> =
                found.iter().map(|path| [Amount::Hops, second].map(|amount| path.totals.of(amount))).collect();
            assert_eq!((found, capped), (expected.clone(), false), "case {case}");
        }
        lengths[expected.len().min(7)] += 1;
    }
    assert!(lengths[0] > 100 && lengths[2] > 300 && lengths[3] > 30, "{lengths:?} fronts by length");
}

#[test]
fn a_cap_on_labels_is_reported_wherever_it_changes_an_answer() {
    let mut draw = Draw::seeded(20);
    let (mut changed, mut capped) = (0, 0);
    for case in 0..3000 {
        let graph = Stored::drawn(&mut draw);
        let ends = (0, NODES - 1);
        let objective = drawn_objective(&mut draw);
        let budgets = drawn_budgets(&mut draw, &graph.all_paths(ends.0, ends.1));
        let answer = |cap| search(&graph, ends, &objective, &budgets, cap).unwrap();
        let exact = answer(LabelCap::default());
        for cap in [LabelCap { of_node: 1, ..LabelCap::default() }, LabelCap { in_all: 4, ..LabelCap::default() }] {
            let short = answer(cap);
            let differs = match (&exact.path, &short.path) {
                (Some(exact), Some(short)) => by(&objective, &exact.totals, &short.totals).is_ne(),
                (exact, short) => exact.is_some() != short.is_some(),
            };
            assert!(!differs || short.capped, "case {case}: another answer, without a word");
            // Without budgets a path that exists is never denied, whatever labels were left out.
            let whole = search(&graph, ends, &objective, &Budgets::NONE, LabelCap::NONE).unwrap().path;
            let stands = without_budgets(&graph, ends, &objective, &budgets, cap).unwrap();
            assert_eq!(stands.is_some(), whole.is_some(), "case {case}");
            if let (Some(stands), Some(whole)) = (&stands, &whole) {
                let exceeded = budgets.exceeded_by(&stands.path.totals).count();
                assert_eq!((stands.within, stands.unmet.len()), (exceeded == 0, exceeded), "case {case}");
                assert!(stands.capped || by(&objective, &stands.path.totals, &whole.totals).is_eq(), "case {case}");
            }
            changed += usize::from(differs);
            capped += usize::from(short.capped);
        }
    }
    assert!(changed > 50 && capped > changed, "{changed} changed, {capped} capped");
}

#[test]
fn budgets_are_amounts() {
    for (most, holds) in [(0.0, true), (f64::INFINITY, true), (-1.0, false), (f64::NAN, false)] {
        assert_eq!(Budgets::NONE.with(Amount::Energy, most).is_ok(), holds, "{most}");
    }
    let twice = Budgets::NONE.with(Amount::Hops, 5.0).and_then(|budgets| budgets.with(Amount::Hops, 7.0)).unwrap();
    assert_eq!(twice.most(Amount::Hops), 5.0, "the smaller of two holds");
}
