//! The hop graph: edges evaluated when asked for, through petgraph's traits.

use std::{cell::RefCell, collections::HashSet};

use petgraph::visit::{Data, EdgeRef, GraphBase, IntoEdgeReferences, IntoEdges, IntoNeighbors, Visitable};

use super::{Cost, Effort, NodeSet, RefusalCounts};
use crate::{
    ballistics::{Arc, HopTest, SegmentHops, Split, TakeoffChoice},
    chain::Station,
    quantity::{NodeId, SlopeInterval},
    world::Limit,
};

/// What joins two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge {
    /// One hop, with these feasible lofts.
    Hop(SlopeInterval),
    /// Several hops along one segment.
    Along(SegmentHops),
}

impl Edge {
    /// What joins two stations; see [`HopGraph::edge`].
    #[inline]
    pub(super) fn between(test: &HopTest<'_>, takeoff: &Station, landing: &Station) -> Result<Self, Limit> {
        match test.loft(takeoff, landing) {
            Ok(loft) => Ok(Self::Hop(loft)),
            Err(limit) => test.segment_hops(takeoff, landing).map(Self::Along).ok_or(limit),
        }
    }

    /// What it costs between two stations, in an effort at a choice of angle and a split.
    pub(super) fn cost(
        self,
        test: &HopTest<'_>,
        takeoff: &Station,
        landing: &Station,
        (effort, choice, split): (Effort, TakeoffChoice, Split),
    ) -> Cost {
        let Some(sight) = test.line_of_sight(takeoff, landing) else { return Cost::default() };
        match self {
            Self::Hop(loft) => effort.cost(&Arc::new(sight, choice.loft(sight, loft), test.gravity_m_s2()), 1),
            Self::Along(along) => {
                let (each_m, last_m) = along.lengths_m(split);
                let arc = |length_m| along.arc(test, length_m, choice);
                effort.cost(&arc(each_m), along.hops() - 1) + effort.cost(&arc(last_m), 1)
            }
        }
    }
}

/// The hop graph over a node set. Edges are computed when visited and never stored.
#[derive(Debug)]
pub struct HopGraph<'a> {
    test: &'a HopTest<'a>,
    nodes: &'a NodeSet,
    effort: Effort,
    choice: TakeoffChoice,
    split: Split,
    tally: RefCell<Tally>,
    expanded: RefCell<Vec<bool>>,
}

/// What the search has looked at so far.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    pairs: u64,
    refusals: RefusalCounts,
}

impl<'a> HopGraph<'a> {
    /// A graph over nodes, with the effort, choice of take-off angle and split that its costs are counted in.
    pub fn new(test: &'a HopTest<'a>, nodes: &'a NodeSet, effort: Effort, choice: TakeoffChoice, split: Split) -> Self {
        let expanded = RefCell::new(vec![false; nodes.stations().len()]);
        Self { test, nodes, effort, choice, split, tally: RefCell::default(), expanded }
    }

    /// The nodes.
    pub const fn nodes(&self) -> &'a NodeSet {
        self.nodes
    }

    /// The hop test behind the edges.
    pub const fn test(&self) -> &'a HopTest<'a> {
        self.test
    }

    /// What joins two stations: one hop where one will do, else hops along their common segment (P Algorithm 2, by its prose).
    ///
    /// # Errors
    /// The limit that refuses the single hop, where there are no hops along a segment either.
    #[inline]
    pub fn edge(&self, takeoff: &Station, landing: &Station) -> Result<Edge, Limit> {
        Edge::between(self.test, takeoff, landing)
    }

    /// The cost of an edge between two stations.
    pub fn cost(&self, takeoff: &Station, landing: &Station, edge: Edge) -> Cost {
        edge.cost(self.test, takeoff, landing, (self.effort, self.choice, self.split))
    }

    /// How many pairs were tested, and how the refused ones fell.
    pub fn tally(&self) -> (u64, RefusalCounts) {
        let tally = self.tally.borrow();
        (tally.pairs, tally.refusals)
    }

    /// Which nodes the search has left from: after a search without success, all that can be reached.
    pub fn expanded(&self) -> Vec<bool> {
        self.expanded.borrow().clone()
    }

    /// The candidate landings of a node: within reach of one hop, or on a segment that the node lies on, along which many hops reach
    /// farther.
    pub(super) fn landings(&self, node: NodeId) -> std::ops::Range<usize> {
        self.nodes.around(self.nodes.station(node), self.test.reach_bound_m(self.nodes.station(node)))
    }

    /// The candidate take-offs for a landing on a node: as [`landings`](Self::landings), with the reach of the whole chain.
    pub(super) fn takeoffs(&self, node: NodeId) -> std::ops::Range<usize> {
        self.nodes.around(self.nodes.station(node), self.test.greatest_reach_m())
    }
}

/// One edge as petgraph sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeReference {
    source: NodeId,
    target: NodeId,
    weight: Cost,
}

impl EdgeRef for EdgeReference {
    type NodeId = NodeId;
    type EdgeId = (NodeId, NodeId);
    type Weight = Cost;

    fn source(&self) -> NodeId {
        self.source
    }

    fn target(&self) -> NodeId {
        self.target
    }

    fn weight(&self) -> &Cost {
        &self.weight
    }

    fn id(&self) -> Self::EdgeId {
        (self.source, self.target)
    }
}

/// The edges that leave one node, each evaluated when drawn.
#[derive(Clone, Debug)]
pub struct Edges<'g> {
    graph: &'g HopGraph<'g>,
    source: NodeId,
    candidates: std::ops::Range<usize>,
}

impl Iterator for Edges<'_> {
    type Item = EdgeReference;

    fn next(&mut self) -> Option<EdgeReference> {
        let takeoff = self.graph.nodes.station(self.source);
        for target in self.candidates.by_ref().map(NodeId) {
            if target == self.source {
                continue;
            }
            let landing = self.graph.nodes.station(target);
            let edge = self.graph.edge(takeoff, landing);
            let mut tally = self.graph.tally.borrow_mut();
            tally.pairs += 1;
            match edge {
                Ok(edge) => {
                    let weight = self.graph.cost(takeoff, landing, edge);
                    return Some(EdgeReference { source: self.source, target, weight });
                }
                Err(limit) => tally.refusals.count(limit),
            }
        }
        None
    }
}

impl GraphBase for HopGraph<'_> {
    type NodeId = NodeId;
    type EdgeId = (NodeId, NodeId);
}

impl Data for HopGraph<'_> {
    type NodeWeight = Station;
    type EdgeWeight = Cost;
}

impl Visitable for HopGraph<'_> {
    type Map = HashSet<NodeId>;

    fn visit_map(&self) -> Self::Map {
        HashSet::with_capacity(self.nodes.stations().len())
    }

    fn reset_map(&self, map: &mut Self::Map) {
        map.clear();
    }
}

impl<'g> IntoEdgeReferences for &'g HopGraph<'g> {
    type EdgeRef = EdgeReference;
    type EdgeReferences = AllEdges<'g>;

    fn edge_references(self) -> AllEdges<'g> {
        AllEdges { graph: self, next: 0, current: None }
    }
}

/// All edges of the graph, node by node.
#[derive(Clone, Debug)]
pub struct AllEdges<'g> {
    graph: &'g HopGraph<'g>,
    next: usize,
    current: Option<Edges<'g>>,
}

impl Iterator for AllEdges<'_> {
    type Item = EdgeReference;

    fn next(&mut self) -> Option<EdgeReference> {
        loop {
            if let Some(edge) = self.current.as_mut().and_then(Iterator::next) {
                return Some(edge);
            }
            if self.next == self.graph.nodes.stations().len() {
                return None;
            }
            self.current = Some(self.graph.edges(NodeId(self.next)));
            self.next += 1;
        }
    }
}

impl<'g> IntoNeighbors for &'g HopGraph<'g> {
    type Neighbors = std::iter::Map<Edges<'g>, fn(EdgeReference) -> NodeId>;

    fn neighbors(self, node: NodeId) -> Self::Neighbors {
        self.edges(node).map(|edge| edge.target)
    }
}

impl<'g> IntoEdges for &'g HopGraph<'g> {
    type Edges = Edges<'g>;

    fn edges(self, node: NodeId) -> Edges<'g> {
        self.expanded.borrow_mut()[node.index()] = true;
        Edges { graph: self, source: node, candidates: self.landings(node) }
    }
}
