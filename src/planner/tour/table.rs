//! The table of Held and Karp (1962): the best way to have visited a set of targets, the last of them at a given one.

use super::super::{
    Amount, Amounts, Budgets, FoundPath, LabelCap, LegGraph, LegVisitor, Objective, OutagePart, Stretch, Successor,
};
use super::{
    super::{
        labels::{Tracked, by_objective},
        search::Run,
    },
    TARGETS_MAX, VisitOrder,
};
use crate::progress::Cancelled;

/// What the legs between stops take, each with its commands: stop 0 is the start, stop k the k-th target.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LegCosts {
    targets: usize,
    /// By stop of departure, then of arrival; none where no leg leads.
    of: Vec<Vec<Amounts>>,
    /// How each way is outside the conditions of layers that may be left for a while.
    parts: Vec<Vec<Vec<OutagePart>>>,
    /// The longest stretches outside them.
    outages: Vec<Stretch>,
}

impl LegCosts {
    /// No legs between the start and so many targets.
    pub(super) fn none(targets: usize) -> Self {
        let pairs = (targets + 1) * (targets + 1);
        Self { targets, of: vec![Vec::new(); pairs], parts: vec![Vec::new(); pairs], outages: Vec::new() }
    }

    /// The same for missions with stretches no longer than these outside the conditions of layers.
    pub(super) fn under(self, outages: Vec<Stretch>) -> Self {
        Self { outages, ..self }
    }

    /// The same where every leg is by itself, whatever lies outside before and after it: no mission takes less.
    pub(super) fn apart(mut self) -> Self {
        self.outages.clear();
        self
    }

    /// How the ways of a leg are outside them, each with a part for every layer.
    pub(super) fn set_outages(&mut self, [from, to]: [usize; 2], parts: Vec<Vec<OutagePart>>) {
        self.parts[from * (self.targets + 1) + to] = parts;
    }

    /// The ways of a leg.
    pub(super) fn between(&self, [from, to]: [usize; 2]) -> &[Amounts] {
        &self.of[from * (self.targets + 1) + to]
    }

    pub(super) fn set(&mut self, [from, to]: [usize; 2], ways: Vec<Amounts>) {
        self.of[from * (self.targets + 1) + to] = ways;
    }
}

/// How stops are visited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct VisitRules {
    pub(super) order: VisitOrder,
    /// Whether the mission ends at its start.
    pub(super) returns: bool,
    /// The targets that may be visited, as a bit each: bit 0 is stop 1.
    pub(super) allowed: u16,
}

/// A mission found in the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Visits {
    /// The stops from the start on, and the number of the way that leads to each but the first.
    pub(super) stops: Vec<usize>,
    pub(super) ways: Vec<usize>,
    pub(super) totals: Amounts,
}

impl Visits {
    /// The targets visited, as a bit each.
    pub(super) fn set(&self) -> u16 {
        self.stops.iter().filter(|stop| **stop > 0).fold(0, |set, stop| set | (1 << (stop - 1)))
    }
}

/// The table as a graph: its states are the start, every pair of a set of targets and the last one visited, and every set after which the
/// machine has returned. The search over it keeps one label a state, or where budgets count a Pareto set.
struct Table<'c> {
    costs: &'c LegCosts,
    rules: VisitRules,
}

/// A state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Start,
    /// A set, and the last stop, from 1.
    At(usize, usize),
    /// Back at the start.
    Home(usize),
}

impl Table<'_> {
    const fn sets(&self) -> usize {
        1 << self.costs.targets
    }

    const fn index(&self, state: State) -> usize {
        match state {
            State::Start => 0,
            State::At(set, stop) => 1 + set * self.costs.targets + stop - 1,
            State::Home(set) => 1 + self.sets() * self.costs.targets + set,
        }
    }

    const fn state(&self, index: usize) -> State {
        let targets = self.costs.targets;
        match index.checked_sub(1) {
            None => State::Start,
            Some(rest) if rest < self.sets() * targets => State::At(rest / targets, rest % targets + 1),
            Some(rest) => State::Home(rest - self.sets() * targets),
        }
    }

    /// The set of a state in which a mission may end; `None` of others.
    const fn ends_with(&self, state: State) -> Option<usize> {
        match (state, self.rules.returns) {
            (State::At(set, _), false) | (State::Home(set), true) => Some(set),
            _ => None,
        }
    }

    fn visit(&self, [from, to]: [usize; 2], state: State, visitor: &mut dyn LegVisitor) {
        for (command, amounts) in (0..).zip(self.costs.between([from, to])) {
            visitor.visit(&Successor { node: self.index(state), command, amounts: *amounts });
        }
    }
}

impl LegGraph for Table<'_> {
    fn nodes(&self) -> usize {
        // One more, which nothing reaches: the search goes on to all states.
        self.index(State::Home(self.sets()))
    }

    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        let (set, from) = match self.state(node) {
            State::Start => (0, 0),
            State::At(set, stop) => (set, stop),
            State::Home(_) => return Ok(()),
        };
        let allowed = usize::from(self.rules.allowed);
        for to in 1..=self.costs.targets {
            let bit = 1 << (to - 1);
            let is_in_order = self.rules.order == VisitOrder::Best || to > from;
            if set & bit == 0 && allowed & bit != 0 && is_in_order {
                self.visit([from, to], State::At(set | bit, to), visitor);
            }
        }
        if self.rules.returns && from > 0 {
            self.visit([from, 0], State::Home(set), visitor);
        }
        Ok(())
    }

    fn least_to_goal(&self, _: usize) -> Amounts {
        Amounts::NONE
    }

    fn outage(&self, from: usize, leg: &Successor, layer: usize) -> OutagePart {
        let [from, to] = [from, leg.node].map(|state| match self.state(state) {
            State::Start | State::Home(_) => 0,
            State::At(_, stop) => stop,
        });
        let ways = &self.costs.parts[from * (self.costs.targets + 1) + to];
        ways.get(leg.command as usize).and_then(|parts| parts.get(layer)).copied().unwrap_or(OutagePart::HELD)
    }
}

/// The mission that visits the most targets, of those the best by the objective, within budgets; without any target where none can be
/// visited. Of equal missions the one of the lower numbers.
///
/// # Returns
/// The mission, and whether labels were left out.
///
/// # Complexity
/// 2^n n states for n targets, and n legs out of each: some 600 000 for twelve.
pub(super) fn most_visits(
    costs: &LegCosts,
    rules: VisitRules,
    (objective, budgets, cap): (&Objective, &Budgets, LabelCap),
) -> Result<(Visits, bool), Cancelled> {
    debug_assert!(costs.targets <= TARGETS_MAX, "{} targets", costs.targets);
    let table = Table { costs, rules };
    let mut run = Run::new(
        &table,
        (0, table.nodes() - 1),
        Tracked::new(objective, budgets).under(costs.outages.clone(), OutagePart::HELD),
        cap,
    );
    run.until(false)?;
    let compared = objective.amounts().len();
    let mut best: Option<(u32, &[f64], u32)> = None;
    for node in 0..table.nodes() {
        let Some(set) = table.ends_with(table.state(node)) else { continue };
        for label in run.labels.of_node(node) {
            let (count, totals) = (set.count_ones(), &run.labels.totals(label)[..compared]);
            let is_better =
                best.is_none_or(|(most, least, _)| count > most || (count == most && by_objective(totals, least).is_lt()));
            if is_better {
                best = Some((count, totals, label));
            }
        }
    }
    let path = best.map(|(_, _, label)| run.path(label)).transpose()?;
    let visits =
        path.map_or_else(|| Visits { stops: vec![0], ways: Vec::new(), totals: Amounts::NONE }, |path| table.visits(&path));
    Ok((visits, run.labels.capped))
}

impl Table<'_> {
    fn visits(&self, path: &FoundPath) -> Visits {
        let stop = |step: &super::super::PathStep| match self.state(step.to) {
            State::At(_, stop) => stop,
            State::Start | State::Home(_) => 0,
        };
        Visits {
            stops: std::iter::once(0).chain(path.steps.iter().map(stop)).collect(),
            ways: path.steps.iter().map(|step| step.command as usize).collect(),
            totals: path.totals,
        }
    }
}

/// The fewest hops with which all targets can be visited, if no leg takes fewer than these; `None` if that is not known of every leg.
pub fn fewest_hops_of_visits(
    hops: &dyn Fn([usize; 2]) -> Option<u64>,
    targets: usize,
    order: VisitOrder,
    returns: bool,
) -> Option<u64> {
    let mut costs = LegCosts::none(targets);
    for (from, to) in (0..=targets).flat_map(|from| (0..=targets).map(move |to| (from, to))).filter(|(from, to)| from != to) {
        #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
        let least = hops([from, to])? as f64;
        costs.set([from, to], vec![Amounts::NONE.with(Amount::Hops, least)]);
    }
    let rules = VisitRules { order, returns, allowed: u16::MAX };
    let (visits, _) = most_visits(&costs, rules, (&Objective::of(Amount::Hops), &Budgets::NONE, LabelCap::NONE)).ok()?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a sum of whole numbers")]
    Some(visits.totals.of(Amount::Hops) as u64)
}
