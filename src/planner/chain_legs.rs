//! The legs of a chain: hops between its nodes, or many hops along one segment, each with its distinct commands.

use std::cell::RefCell;

use super::{
    Amount, Amounts, Budgets, FoundPath, LabelCap, LeastAmounts, LegGraph, LegVisitor, Objective, Successor, UnmetBudget, front,
    search::{WithoutBudgets, search, without_budgets},
};
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    chain::Station,
    graph::{
        self, AUTO_POINTS_PER_SEGMENT, Answer, Cost, Edge, HopGraph, Judge, Leg, NodeSet, Outcome, PointSpacing,
        ReliabilityOptions, SearchError, SearchOptions,
    },
    hop::HopTest,
    progress::{Cancelled, Detail, Meter, PairCounter, Progress, Stage},
    quantity::{NodeId, SlopeInterval},
};

/// Which of its feasible arcs an edge offers to the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchedCommands {
    /// That of the chosen take-off angle.
    Chosen,
    /// Least speed, least time and the middle, where risk counts the most reliable one as well: those that differ. Many hops along one
    /// segment have the chosen take-off angle all the same.
    Distinct,
}

impl SearchedCommands {
    /// The choices of a single hop.
    pub(super) fn choices(self, chosen: TakeoffChoice, by_risk: bool) -> Vec<TakeoffChoice> {
        match self {
            Self::Chosen => vec![chosen],
            Self::Distinct => {
                let others = TakeoffChoice::ALL.into_iter().filter(|choice| by_risk || *choice != TakeoffChoice::MostReliable);
                // Of commands that take the same the chosen one is flown.
                std::iter::once(chosen).chain(others.filter(|choice| *choice != chosen)).collect()
            }
        }
    }
}

/// The graph of a chain over a set of nodes, from its start to its goal.
pub struct ChainLegs<'a> {
    graph: HopGraph,
    options: &'a SearchOptions,
    /// The choices of a single hop, each with what judges its risk.
    commands: Vec<(TakeoffChoice, Option<Judge>)>,
    least: LeastAmounts,
    counter: RefCell<PairCounter<'a>>,
}

impl std::fmt::Debug for ChainLegs<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ChainLegs").field("graph", &self.graph).field("options", &self.options).finish_non_exhaustive()
    }
}

impl<'a> ChainLegs<'a> {
    /// The graph.
    ///
    /// # Arguments
    /// `reliability`: what risk is judged by; `None` if it does not count, which is faster. Risk that depends on the hops before an edge
    /// (the scatter of landings) is judged as without them.
    pub(crate) fn new(
        test: &HopTest,
        nodes: &NodeSet,
        options: &'a SearchOptions,
        offered: SearchedCommands,
        reliability: Option<&ReliabilityOptions>,
        meter: &'a Meter<'_>,
    ) -> Self {
        let judge = |takeoff| {
            let options = SearchOptions { takeoff, ..options.clone() };
            reliability.map(|weighed| Judge::new(test, &options, &weighed.model, weighed.goal_tolerance_m))
        };
        let by_risk = reliability.is_some();
        let commands = offered.choices(options.takeoff, by_risk).into_iter().map(|choice| (choice, judge(choice))).collect();
        let heights = || test.chain().geometry().vertices().iter().map(|vertex| vertex.z_m);
        let relief_m = heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min);
        let (takeoff_m_s, landing_m_s) = test.chain().speed_bounds_m_s();
        let limits = test.hopper().limits();
        let landing_m_s = if limits.landing.brakes() { f64::INFINITY } else { landing_m_s };
        Self {
            graph: HopGraph::new(test, nodes, options.effort, options.takeoff, options.split),
            options,
            commands,
            least: LeastAmounts::new(limits, test.gravity_m_s2(), (takeoff_m_s, landing_m_s), relief_m),
            counter: RefCell::new(meter.counter()),
        }
    }

    /// Start and goal.
    fn ends(&self) -> (usize, usize) {
        (self.graph.nodes().start().index(), self.graph.nodes().goal().index())
    }

    fn station(&self, node: usize) -> &Station {
        self.graph.nodes().station(NodeId(node))
    }

    /// The arcs of a single hop with their lofts, one for each distinct command, by the number of the command.
    fn arcs(&self, (from, to): (usize, usize), (sight, lofts): (LineOfSight, SlopeInterval), mut visit: impl FnMut(u32, f64, f64)) {
        let mut known: [f64; TakeoffChoice::ALL.len()] = [f64::NAN; TakeoffChoice::ALL.len()];
        for ((command, (choice, judge)), number) in self.commands.iter().enumerate().zip(0..) {
            let judged = judge.as_ref().map(|judge| self.judged(judge, (from, to)));
            let chosen = judged.and_then(|judged| judged.loft);
            let loft = chosen.unwrap_or_else(|| self.graph.test().loft(*choice, sight, lofts));
            if !known[..command].contains(&loft) {
                visit(number, loft, judged.map_or(0.0, |judged| judged.weight));
            }
            known[command] = loft;
        }
    }

    fn judged(&self, judge: &Judge, (from, to): (usize, usize)) -> graph::Judged {
        // The first hop takes off where the robot is for certain.
        let takeoff_m2 = if from == self.ends().0 { [0.0; 2] } else { judge.takeoff_m2([0.0; 2]) };
        judge.edge(&self.graph, (from, to), takeoff_m2, f64::INFINITY)
    }

    /// What many hops along one segment take.
    fn along(&self, along: &crate::hop::SegmentHops, ends: (usize, usize)) -> Amounts {
        let (test, limits) = (self.graph.test(), self.graph.test().hopper().limits());
        let is_first = ends.0 == self.ends().0;
        let (each_m, last_m) = along.lengths_m(self.options.split);
        let of = |length_m, is_first| Amounts::of_arc(&along.arc(test, length_m, self.options.takeoff), limits, is_first);
        let all = match along.hops() {
            0 | 1 => of(last_m, is_first),
            hops => of(each_m, is_first).then(&of(each_m, false).times(hops - 2)).then(&of(last_m, false)),
        };
        let judge = self.commands.first().and_then(|(_, judge)| judge.as_ref());
        all.with(Amount::Risk, judge.map_or(0.0, |judge| self.judged(judge, ends).weight))
    }

    /// The legs of a path, with the lofts of their commands.
    fn legs(&self, path: &FoundPath) -> Vec<Leg> {
        let leg = |step: &super::PathStep| {
            let (takeoff, landing) = (*self.station(step.from), *self.station(step.to));
            let edge = self.graph.edge(&takeoff, &landing).ok()?;
            let mut loft = None;
            if let (Edge::Hop(lofts), Some(sight)) = (edge, self.graph.test().line_of_sight(&takeoff, &landing)) {
                self.arcs((step.from, step.to), (sight, lofts), |command, of_command, _| {
                    if command == step.command {
                        loft = Some(of_command);
                    }
                });
            }
            Some(Leg { takeoff, landing, edge, loft })
        };
        path.steps.iter().filter_map(leg).collect()
    }

    /// The hops and the effort of legs.
    fn cost(&self, legs: &[Leg]) -> Cost {
        let (test, g) = (self.graph.test(), self.graph.test().gravity_m_s2());
        legs.iter().fold(Cost::default(), |cost, leg| {
            let of_leg = match (leg.loft, test.line_of_sight(&leg.takeoff, &leg.landing)) {
                (Some(loft), Some(sight)) => self.options.effort.cost(&Arc::new(sight, loft, g), 1),
                _ => self.graph.cost(&leg.takeoff, &leg.landing, leg.edge),
            };
            cost + of_leg
        })
    }

    fn on_chain(&self, path: &FoundPath) -> ChainPath {
        let legs = self.legs(path);
        ChainPath { cost: self.cost(&legs), legs, totals: path.totals }
    }
}

impl LegGraph for ChainLegs<'_> {
    fn nodes(&self) -> usize {
        self.graph.nodes().stations().len()
    }

    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        let (test, limits) = (self.graph.test(), self.graph.test().hopper().limits());
        let takeoff = self.station(node);
        let is_first = node == self.ends().0;
        for target in self.graph.landings(takeoff).filter(|target| *target != node) {
            let landing = self.station(target);
            let (from, to) = (takeoff.point, landing.point);
            if !visitor.wants(target, &self.least.over((to.x_m - from.x_m).abs(), to.z_m - from.z_m)) {
                continue;
            }
            self.counter.borrow_mut().pair()?;
            match self.graph.edge(takeoff, landing) {
                Err(_) => {}
                Ok(Edge::Along(along)) => {
                    visitor.visit(&Successor { node: target, command: 0, amounts: self.along(&along, (node, target)) });
                }
                Ok(Edge::Hop(lofts)) => {
                    let Some(sight) = test.line_of_sight(takeoff, landing) else { continue };
                    self.arcs((node, target), (sight, lofts), |command, loft, risk| {
                        let arc = Arc::new(sight, loft, test.gravity_m_s2());
                        let amounts = Amounts::of_arc(&arc, limits, is_first).with(Amount::Risk, risk);
                        visitor.visit(&Successor { node: target, command, amounts });
                    });
                }
            }
        }
        Ok(())
    }

    fn least_to_goal(&self, node: usize) -> Amounts {
        let (here, goal) = (self.station(node).point, self.station(self.ends().1).point);
        self.least.over((goal.x_m - here.x_m).abs(), goal.z_m - here.z_m)
    }
}

/// What a path on a chain is searched for.
#[derive(Clone, Copy, Debug)]
pub struct ChainQuestion<'a> {
    /// What is to be least.
    pub objective: &'a Objective,
    /// The greatest totals.
    pub budgets: &'a Budgets,
    /// The commands of an edge.
    pub commands: SearchedCommands,
    /// What risk is judged by; needed where the objective or a budget is about it.
    pub reliability: Option<&'a ReliabilityOptions>,
    /// How many labels are kept.
    pub cap: LabelCap,
}

/// A path on a chain.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainPath {
    /// The edges from start to goal, with the lofts of their commands.
    pub legs: Vec<Leg>,
    /// The number of hops, and the effort of the options.
    pub cost: Cost,
    /// What it takes.
    pub totals: Amounts,
}

/// The result of a search on a chain by an objective, within budgets.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainSearched {
    /// The answer; its path is the best within the budgets, or the best without budgets, if no path keeps them.
    pub answer: Answer,
    /// What that path takes; `None` without a path.
    pub totals: Option<Amounts>,
    /// Whether a path keeps the budgets.
    pub within: bool,
    /// If not: the budgets that the path of the answer exceeds. If the least of each is within it, no path keeps all of them at once.
    pub unmet: Vec<UnmetBudget>,
    /// Whether labels were left out: the path may then not be the best, and that none keeps the budgets is not certain.
    pub capped: bool,
}

/// Finds the best path between two stations by an objective, within budgets: over the first nodes of the options that have a path, as
/// [`search`](graph::search()) chooses them, and if none of these paths keeps the budgets, over the denser ones that "auto" tries.
///
/// # Errors
/// [`SearchError`].
pub fn search_on_chain(
    test: &HopTest,
    (start, goal): (Station, Station),
    options: &SearchOptions,
    question: &ChainQuestion<'_>,
    progress: &dyn Progress,
) -> Result<ChainSearched, SearchError> {
    if let Some(weighed) = question.reliability {
        weighed.model.check()?;
    }
    let mut answer = graph::search(test, start, goal, options, progress)?;
    if answer.hops().is_none_or(|hops| hops == 0) {
        let totals = answer.hops().map(|_| Amounts::NONE);
        return Ok(ChainSearched { answer, within: totals.is_some(), totals, unmet: Vec::new(), capped: false });
    }
    let meter = Meter::new(progress, Stage::Search);
    let mut capped = false;
    let spacings = spacings_from(&answer, options);
    for (i, &spacing) in spacings.iter().enumerate() {
        meter.report(Detail::None)?;
        let nodes = NodeSet::new(test.chain(), start, goal, spacing)?;
        let legs = ChainLegs::new(test, &nodes, options, question.commands, question.reliability, &meter);
        let found = search(&legs, legs.ends(), question.objective, question.budgets, question.cap)?;
        capped |= found.capped;
        (answer.spacing, answer.points_per_segment, answer.nodes) = (spacing, nodes.most_per_segment(), nodes.stations().len());
        if let Some(path) = found.path {
            let path = legs.on_chain(&path);
            answer.outcome = Outcome::Path { legs: path.legs, cost: path.cost };
            return Ok(ChainSearched { answer, totals: Some(path.totals), within: true, unmet: Vec::new(), capped: found.capped });
        }
        if i + 1 < spacings.len() {
            continue;
        }
        // No path keeps the budgets: what the best one takes, and the least of what it takes too much of.
        let without = without_budgets(&legs, legs.ends(), question.objective, question.budgets, question.cap)?;
        let Some(WithoutBudgets { path, within, unmet, capped: left_out, .. }) = without else { break };
        let path = legs.on_chain(&path);
        answer.outcome = Outcome::Path { legs: path.legs, cost: path.cost };
        return Ok(ChainSearched { answer, totals: Some(path.totals), within, unmet, capped: capped || left_out });
    }
    // A path that the first search found is one over these nodes too.
    Ok(ChainSearched { answer, totals: None, within: false, unmet: Vec::new(), capped })
}

/// The spacings over which an answer may have better paths: its own, and the denser ones of "auto".
fn spacings_from(answer: &Answer, options: &SearchOptions) -> Vec<PointSpacing> {
    let denser =
        AUTO_POINTS_PER_SEGMENT.into_iter().filter(|points| options.spacing.is_none() && *points > answer.points_per_segment);
    std::iter::once(answer.spacing).chain(denser.map(PointSpacing::PerSegment)).collect()
}

/// The Pareto front of hops against another amount between two stations, over the nodes of an answer; within budgets.
///
/// # Returns
/// The paths in ascending order of hops, and whether labels were left out. Empty without a path.
///
/// # Errors
/// [`SearchError`].
pub fn front_on_chain(
    test: &HopTest,
    (start, goal): (Station, Station),
    (options, spacing): (&SearchOptions, PointSpacing),
    (amount, question): (Amount, &ChainQuestion<'_>),
    progress: &dyn Progress,
) -> Result<(Vec<ChainPath>, bool), SearchError> {
    if let Some(weighed) = question.reliability {
        weighed.model.check()?;
    }
    let meter = Meter::new(progress, Stage::Search);
    meter.report(Detail::None)?;
    let nodes = NodeSet::new(test.chain(), start, goal, spacing)?;
    let legs = ChainLegs::new(test, &nodes, options, question.commands, question.reliability, &meter);
    let (paths, capped) = front(&legs, legs.ends(), (Amount::Hops, amount), question.budgets, question.cap)?;
    Ok((paths.iter().map(|path| legs.on_chain(path)).collect(), capped))
}
