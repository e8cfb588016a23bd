//! Questions (pairs of start and goal) and their answers, in rounds of denser nodes.

use std::{collections::HashMap, sync::Arc};

use super::{
    Answer, Cost, EndpointRefusal, Frontier, HopGraph, Leg, NodeSet, Outcome, PointSpacing, SearchError, SearchOptions,
    batched_search::{Aim, BatchedSearch, Label, Tally},
    endpoint_refusal,
    goals::Goals,
    local_reach::LocalReach,
};
use crate::{
    chain::Station,
    ground::LandingTable,
    hop::HopTest,
    progress::Meter,
    quantity::NodeId,
    world::{Contact, Direction},
};

/// The smallest node set whose batches may be worth sharing among threads.
const SHARED_FROM_NODES: usize = 4096;

/// The settings of one round of searches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round<'a> {
    pub(super) test: &'a HopTest,
    pub(super) reach: &'a LocalReach,
    /// The nodes that all questions share.
    pub(super) nodes: &'a NodeSet,
    pub(super) spacing: PointSpacing,
    pub(super) options: &'a SearchOptions,
    /// Whether no denser nodes will be tried after this round.
    pub(super) is_last: bool,
}

impl Round<'_> {
    /// The graph over some nodes.
    fn graph(&self, nodes: &NodeSet) -> HopGraph {
        let SearchOptions { effort, takeoff, split, .. } = *self.options;
        HopGraph::new(self.test, nodes, effort, takeoff, split)
    }

    /// An answer with counts that include the nodes added for start and goal.
    fn answer(&self, (start, goal): &(Station, Station), outcome: Outcome, tally: Tally) -> Answer {
        let adds = |station: &Station| usize::from(self.nodes.find(station).is_none());
        let goal_adds = if goal.point.x_m == start.point.x_m { 0 } else { adds(goal) };
        Answer {
            outcome,
            spacing: self.spacing,
            points_per_segment: self.nodes.most_per_segment(),
            nodes: self.nodes.stations().len() + adds(start) + goal_adds,
            pairs_tested: tally.pairs,
            refusals: tally.refusals,
        }
    }
}

/// One question.
#[derive(Clone, Debug)]
struct Question {
    ends: (Station, Station),
    /// The work done for it so far.
    tally: Tally,
    answer: Option<Answer>,
}

/// Questions, with the answers found so far.
#[derive(Clone, Debug)]
pub(super) struct Questions {
    questions: Vec<Question>,
    /// The indices of the questions of each start.
    by_start: Vec<Vec<usize>>,
}

impl Questions {
    /// Questions without answers.
    pub(super) fn new(pairs: &[(Station, Station)]) -> Self {
        let mut places = HashMap::new();
        let mut by_start: Vec<Vec<usize>> = Vec::new();
        for (i, (start, _)) in pairs.iter().enumerate() {
            // Equal doubles are the same position, and -0 equals 0.
            let place = *places.entry((start.point.x_m + 0.0).to_bits()).or_insert(by_start.len());
            match by_start.get_mut(place) {
                Some(questions) => questions.push(i),
                None => by_start.push(vec![i]),
            }
        }
        let questions = pairs.iter().map(|&ends| Question { ends, tally: Tally::default(), answer: None }).collect();
        Self { questions, by_start }
    }

    /// Whether all questions are answered.
    pub(super) fn are_answered(&self) -> bool {
        self.questions.iter().all(|question| question.answer.is_some())
    }

    /// The answers, in the order of the questions.
    pub(super) fn into_answers(self) -> Vec<Answer> {
        self.questions.into_iter().filter_map(|question| question.answer).collect()
    }

    /// Answers the questions with an end that refuses every hop.
    pub(super) fn refuse_ends(&mut self, round: &Round<'_>) {
        for question in &mut self.questions {
            let refusing = refusing_endpoints(round.test, &question.ends);
            if !refusing.is_empty() {
                question.answer = Some(round.answer(&question.ends, Outcome::EndpointsRefuse(refusing), question.tally.clone()));
            }
        }
    }

    /// Searches once from each start that has open questions.
    ///
    /// # Errors
    /// [`NodesError`](super::NodesError) if adding the ends of a question without a path exceeds the limit.
    pub(super) fn ask(&mut self, round: &Round<'_>, meter: &Meter<'_>) -> Result<(), SearchError> {
        let graph = round.graph(round.nodes);
        let table = Arc::new(LandingTable::new(round.test, round.nodes.shared_stations()));
        let mut batched = BatchedSearch::new(&graph, &table, round.reach, Aim::HopsThenEffort);
        for of_start in &self.by_start {
            let open: Vec<usize> = of_start.iter().copied().filter(|&i| self.questions[i].answer.is_none()).collect();
            let Some(&first) = open.first() else { continue };
            let start = self.questions[first].ends.0;
            let goals: Vec<Station> = open.iter().map(|&i| self.questions[i].ends.1).collect();
            let mut goals = Goals::new(&goals);
            if round.nodes.stations().len() >= SHARED_FROM_NODES {
                // Run inside the pool: its threads notice work from one another sooner than from a thread outside.
                rayon::scope(|_| batched.run(&start, &mut goals, meter))?;
            } else {
                batched.run(&start, &mut goals, meter)?;
            }
            for (&i, label) in open.iter().zip(goals.labels()) {
                let Question { ends, tally, answer } = &mut self.questions[i];
                *tally += batched.tally();
                let outcome = match label {
                    Some(label) => Some(path(&graph, &batched, ends, &label)),
                    None if round.is_last => Some(Outcome::NoPath(Box::new(frontier(round, &batched, *ends, meter)?))),
                    None => None,
                };
                *answer = outcome.map(|outcome| round.answer(ends, outcome, tally.clone()));
            }
        }
        Ok(())
    }
}

/// The refusals of start and goal for every hop. A journey without hops needs neither.
fn refusing_endpoints(test: &HopTest, (start, goal): &(Station, Station)) -> Vec<EndpointRefusal> {
    let Some(towards) = Direction::between(start.point.x_m, goal.point.x_m) else { return Vec::new() };
    [(start, Contact::Takeoff), (goal, Contact::Landing)]
        .into_iter()
        .filter_map(|(station, contact)| endpoint_refusal(test.chain(), station, contact, towards))
        .collect()
}

/// The path that ends with a goal's label.
fn path(graph: &HopGraph, batched: &BatchedSearch<'_>, (start, goal): &(Station, Station), goal_label: &Label) -> Outcome {
    let mut stations = batched.stations_before(start, goal_label);
    if goal_label.cost > Cost::default() {
        stations.push(*goal);
    }
    let legs = stations
        .windows(2)
        .filter_map(|pair| {
            let (takeoff, landing) = (pair[0], pair[1]);
            graph.edge(&takeoff, &landing).ok().map(|edge| Leg { takeoff, landing, edge, loft: None })
        })
        .collect();
    Outcome::Path { legs, cost: goal_label.cost }
}

/// Why a search finds no path, over the shared nodes and the two ends.
fn frontier(
    round: &Round<'_>,
    batched: &BatchedSearch<'_>,
    (start, goal): (Station, Station),
    meter: &Meter<'_>,
) -> Result<Frontier, SearchError> {
    let nodes = NodeSet::new(round.test.chain(), start, goal, round.spacing)?;
    let mut shared = round.nodes.stations().iter().enumerate().peekable();
    let reached: Vec<bool> = nodes
        .stations()
        .iter()
        .map(|station| match shared.next_if(|(_, shared)| shared.point.x_m == station.point.x_m) {
            Some((i, _)) => batched.hops(NodeId(i)).is_some(),
            None => station.point.x_m == start.point.x_m,
        })
        .collect();
    Ok(Frontier::of(&round.graph(&nodes), round.reach, &reached, meter)?)
}
