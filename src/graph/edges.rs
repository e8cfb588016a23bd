//! The hop graph: edges are evaluated on demand, through petgraph's traits.

use std::{collections::HashSet, ops::Range};

use petgraph::visit::{
    Data, EdgeRef, GraphBase, IntoEdgeReferences, IntoEdges, IntoNeighbors, IntoNodeIdentifiers, NodeCompactIndexable, NodeCount,
    NodeIndexable, Visitable,
};

use super::{Cost, Effort, NodeSet, nodes::around};
use crate::{
    ballistics::{Arc, TakeoffChoice},
    chain::Station,
    hop::{HopTest, SegmentHops, Split},
    quantity::{NodeId, SlopeInterval},
    world::Limit,
};

/// An edge between two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge {
    /// One hop, with the lofts of [`HopTest::lofts`].
    Hop(SlopeInterval),
    /// Several hops along one segment.
    Along(SegmentHops),
}

impl Edge {
    /// The number of hops.
    pub const fn hops(&self) -> u64 {
        match self {
            Self::Hop(_) => 1,
            Self::Along(along) => along.hops(),
        }
    }
}

/// The hop graph over a node set. Edges are computed when visited and never stored.
///
/// petgraph's algorithms run on it without changes: `examples/petgraph_on_hops.rs`. [`search`](super::search()) uses a faster
/// algorithm, which the tests compare with petgraph's.
///
/// It shares the hop test and the nodes: to make or to clone one costs next to nothing, and it may be kept and sent to other threads.
#[derive(Clone, Debug)]
pub struct HopGraph {
    test: HopTest,
    nodes: NodeSet,
    effort: Effort,
    choice: TakeoffChoice,
    split: Split,
}

impl HopGraph {
    /// A graph over nodes; effort, choice of take-off angle and split define its costs.
    pub fn new(test: &HopTest, nodes: &NodeSet, effort: Effort, choice: TakeoffChoice, split: Split) -> Self {
        Self { test: test.clone(), nodes: nodes.clone(), effort, choice, split }
    }

    /// The nodes.
    pub const fn nodes(&self) -> &NodeSet {
        &self.nodes
    }

    /// The hop test that evaluates the edges.
    pub const fn test(&self) -> &HopTest {
        &self.test
    }

    /// The edge between two stations: one hop if feasible, else hops along their common segment (P Algorithm 2, as its text
    /// describes it).
    ///
    /// # Errors
    /// The limit that refuses the single hop, if hops along a segment are not possible either.
    #[inline]
    pub fn edge(&self, takeoff: &Station, landing: &Station) -> Result<Edge, Limit> {
        self.edge_of(takeoff, landing, self.test.lofts(takeoff, landing))
    }

    /// As [`edge`](Self::edge), with the result of the hop test for the single hop already known.
    #[inline]
    pub(super) fn edge_of(
        &self,
        takeoff: &Station,
        landing: &Station,
        single: Result<SlopeInterval, Limit>,
    ) -> Result<Edge, Limit> {
        match single {
            Ok(lofts) => Ok(Edge::Hop(lofts)),
            Err(limit) => self.test.segment_hops(takeoff, landing).map(Edge::Along).ok_or(limit),
        }
    }

    /// The cost of an edge between two stations.
    pub fn cost(&self, takeoff: &Station, landing: &Station, edge: Edge) -> Cost {
        let Some(sight) = self.test.line_of_sight(takeoff, landing) else { return Cost::default() };
        let g = self.test.gravity_m_s2();
        match edge {
            Edge::Hop(lofts) => self.effort.cost(&Arc::new(sight, self.test.loft(self.choice, sight, lofts), g), 1),
            Edge::Along(along) => {
                let (each_m, last_m) = along.lengths_m(self.split);
                let arc = |length_m| along.arc(&self.test, length_m, self.choice);
                self.effort.cost(&arc(each_m), along.hops() - 1) + self.effort.cost(&arc(last_m), 1)
            }
        }
    }

    /// The candidate landings of a station: those that the chain's speeds and heights do not exclude for one hop, and those
    /// on the station's own segments, which several hops along the segment may reach.
    pub(crate) fn landings(&self, takeoff: &Station) -> Range<usize> {
        around(self.nodes.stations(), takeoff, self.test.counted_reach_m(takeoff))
    }
}

/// One edge in petgraph's interface.
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

/// The edges that leave one node, each evaluated when the iterator yields it.
#[derive(Clone, Debug)]
pub struct Edges<'g> {
    graph: &'g HopGraph,
    source: NodeId,
    candidates: Range<usize>,
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
            if let Ok(edge) = self.graph.edge(takeoff, landing) {
                let weight = self.graph.cost(takeoff, landing, edge);
                return Some(EdgeReference { source: self.source, target, weight });
            }
        }
        None
    }
}

impl GraphBase for HopGraph {
    type NodeId = NodeId;
    type EdgeId = (NodeId, NodeId);
}

impl Data for HopGraph {
    type NodeWeight = Station;
    type EdgeWeight = Cost;
}

impl NodeCount for HopGraph {
    fn node_count(&self) -> usize {
        self.nodes.stations().len()
    }
}

impl NodeIndexable for HopGraph {
    fn node_bound(&self) -> usize {
        self.node_count()
    }

    fn to_index(&self, node: NodeId) -> usize {
        node.index()
    }

    fn from_index(&self, index: usize) -> NodeId {
        NodeId(index)
    }
}

impl NodeCompactIndexable for HopGraph {}

impl IntoNodeIdentifiers for &HopGraph {
    type NodeIdentifiers = std::iter::Map<Range<usize>, fn(usize) -> NodeId>;

    fn node_identifiers(self) -> Self::NodeIdentifiers {
        (0..self.node_count()).map(NodeId)
    }
}

impl Visitable for HopGraph {
    type Map = HashSet<NodeId>;

    fn visit_map(&self) -> Self::Map {
        HashSet::with_capacity(self.nodes.stations().len())
    }

    fn reset_map(&self, map: &mut Self::Map) {
        map.clear();
    }
}

impl<'g> IntoEdgeReferences for &'g HopGraph {
    type EdgeRef = EdgeReference;
    type EdgeReferences = AllEdges<'g>;

    fn edge_references(self) -> AllEdges<'g> {
        AllEdges { graph: self, next: 0, current: None }
    }
}

/// All edges of the graph, node by node.
#[derive(Clone, Debug)]
pub struct AllEdges<'g> {
    graph: &'g HopGraph,
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

impl<'g> IntoNeighbors for &'g HopGraph {
    type Neighbors = std::iter::Map<Edges<'g>, fn(EdgeReference) -> NodeId>;

    fn neighbors(self, node: NodeId) -> Self::Neighbors {
        self.edges(node).map(|edge| edge.target)
    }
}

impl<'g> IntoEdges for &'g HopGraph {
    type Edges = Edges<'g>;

    fn edges(self, node: NodeId) -> Edges<'g> {
        Edges { graph: self, source: node, candidates: self.landings(self.nodes.station(node)) }
    }
}
