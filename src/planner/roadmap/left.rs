//! What is left to the goal from every node of a roadmap.

use std::ops::Add;

use petgraph::{algo::dijkstra, graph::DiGraph, graph::NodeIndex};

use super::{Roadmap, RoadmapGround, RoadmapLegs, RoadmapQuestion};
use crate::{
    planner::{Amount, Amounts, LegGraph, LegVisitor, Successor},
    progress::Cancelled,
};

/// What moves take of an amount and, where that is equal, of mission time: walking takes no hop, but always time.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Left {
    /// The amount.
    pub amount: f64,
    /// The mission time, s.
    pub time_s: f64,
}

impl Left {
    /// What a move takes, of one of its amounts.
    pub fn of(amount: Amount, amounts: &Amounts) -> Self {
        Self { amount: amounts.of(amount), time_s: amounts.of(Amount::MissionTime) }
    }
}

impl Add for Left {
    type Output = Self;

    fn add(self, next: Self) -> Self {
        Self { amount: self.amount + next.amount, time_s: self.time_s + next.time_s }
    }
}

/// All legs out of a node.
#[derive(Default)]
struct All(Vec<Successor>);

impl LegVisitor for All {
    fn visit(&mut self, leg: &Successor) {
        self.0.push(*leg);
    }
}

impl<N: Clone + Send + Sync> Roadmap<N> {
    /// What the best path from every node to the goal takes, of the first amount of the objective; `None` from where no path leads there. Budgets
    /// do not count.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Complexity
    /// Dijkstra's algorithm over all hops and walks, against their direction.
    pub fn left(
        &self,
        ground: &impl RoadmapGround<Node = N>,
        ends: (usize, usize),
        question: &RoadmapQuestion<'_>,
    ) -> Result<Vec<Option<Left>>, Cancelled> {
        let amount = question.objective.amounts()[0];
        let legs = RoadmapLegs::new(self, ground, ends, (question.commands, question.takeoff));
        let mut backwards = DiGraph::<(), Left>::new();
        for _ in 0..self.contact_count() {
            backwards.add_node(());
        }
        for node in 0..self.contact_count() {
            let mut all = All::default();
            legs.successors(node, &mut all)?;
            for leg in all.0 {
                backwards.add_edge(NodeIndex::new(leg.node), NodeIndex::new(node), Left::of(amount, &leg.amounts));
            }
        }
        let found = dijkstra(&backwards, NodeIndex::new(ends.1), None, |edge| *edge.weight());
        Ok((0..self.contact_count()).map(|node| found.get(&NodeIndex::new(node)).copied()).collect())
    }
}
