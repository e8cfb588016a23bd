//! The contacts and the windows between them, as a graph.

use petgraph::{
    Direction as Towards,
    graph::{DiGraph, EdgeIndex, NodeIndex},
    visit::EdgeRef,
};
use rayon::prelude::*;

use super::{RoadmapGround, RoadmapWalks};
use crate::{
    ballistics::LineOfSight,
    ground::MeshContact,
    progress::{Cancelled, Detail, Meter, Progress, Stage},
    quantity::SlopeInterval,
};

/// Contacts on a mesh, or stances of a robot with legs, and every window of every hop between two of them; where the robot walks, also the straight
/// lines between near stances.
///
/// Nodes are contacts or stances. An edge is one window of a hop, as lofts over its line of sight: a hop with several windows has as many parallel
/// edges, ascending.
#[derive(Clone, Debug)]
pub struct Roadmap<N = MeshContact> {
    graph: DiGraph<N, SlopeInterval>,
    pairs_tested: u64,
    walks: RoadmapWalks,
}

/// A hop of a roadmap: its landing and its windows.
#[derive(Clone, Copy, Debug)]
pub struct RoadmapHop {
    /// The node it leads to.
    pub landing: usize,
    first: usize,
    count: usize,
}

impl<N> Default for Roadmap<N> {
    fn default() -> Self {
        Self { graph: DiGraph::new(), pairs_tested: 0, walks: RoadmapWalks::default() }
    }
}

impl<N: Clone + Send + Sync> Roadmap<N> {
    /// A roadmap without contacts.
    pub fn new() -> Self {
        Self::default()
    }

    /// A roadmap of contacts and windows that are known: from take-off to landing, by the numbers of the contacts. All windows of one hop
    /// stand together, ascending.
    pub(super) fn of_parts(contacts: Vec<N>, windows: &[(u32, u32, SlopeInterval)], pairs_tested: u64) -> Self {
        let mut graph = DiGraph::with_capacity(contacts.len(), windows.len());
        for contact in contacts {
            graph.add_node(contact);
        }
        for (from, to, lofts) in windows {
            graph.add_edge(NodeIndex::new(*from as usize), NodeIndex::new(*to as usize), *lofts);
        }
        Self { graph, pairs_tested, walks: RoadmapWalks::default() }
    }

    /// The graph, for the algorithms of petgraph.
    pub const fn graph(&self) -> &DiGraph<N, SlopeInterval> {
        &self.graph
    }

    /// The number of contacts.
    pub fn contact_count(&self) -> usize {
        self.graph.node_count()
    }

    /// The number of windows.
    pub fn window_count(&self) -> usize {
        self.graph.edge_count()
    }

    /// Ordered pairs of contacts whose hop was tested.
    pub const fn pairs_tested(&self) -> u64 {
        self.pairs_tested
    }

    /// The straight lines that the machine walks.
    pub const fn walks(&self) -> &RoadmapWalks {
        &self.walks
    }

    /// A contact by its number.
    pub fn contact(&self, node: usize) -> &N {
        &self.graph[NodeIndex::new(node)]
    }

    /// The hops out of a contact, in the same order for any number of threads.
    pub fn hops_from(&self, node: usize) -> impl Iterator<Item = RoadmapHop> + '_ {
        let mut edges = self.graph.edges(NodeIndex::new(node)).peekable();
        std::iter::from_fn(move || {
            // Edges come last first, and those of one hop were added one after another.
            let last = edges.next()?;
            let mut hop = RoadmapHop { landing: last.target().index(), first: last.id().index(), count: 1 };
            while let Some(next) = edges.next_if(|edge| edge.target() == last.target()) {
                (hop.first, hop.count) = (next.id().index(), hop.count + 1);
            }
            Some(hop)
        })
    }

    /// The windows of a hop, ascending.
    pub fn windows(&self, hop: RoadmapHop) -> impl Iterator<Item = SlopeInterval> + '_ {
        self.graph.raw_edges()[hop.first..hop.first + hop.count].iter().map(|edge| edge.weight)
    }

    /// The windows between two contacts, ascending; none if no hop is feasible.
    pub fn windows_between(&self, from: usize, to: usize) -> Vec<SlopeInterval> {
        self.hops_from(from).find(|hop| hop.landing == to).map(|hop| self.windows(hop).collect()).unwrap_or_default()
    }

    /// Adds contacts, and tests every hop between two contacts of which at least one is new; where the machine walks, also the straight lines
    /// between each new contact and those nearest to it. The result is the same for any number of threads.
    ///
    /// # Errors
    /// [`Cancelled`]; the roadmap is then as it was.
    ///
    /// # Complexity
    /// A square root for every pair; the windows of those that the greatest speeds may span.
    pub fn extend<G: RoadmapGround<Node = N>>(
        &mut self,
        ground: &G,
        contacts: Vec<N>,
        progress: &dyn Progress,
    ) -> Result<(), Cancelled> {
        let meter = Meter::new(progress, Stage::Search).after(self.pairs_tested);
        meter.report(Detail::None)?;
        let known = self.contact_count();
        let all = known + contacts.len();
        let of = |node: usize| if node < known { self.contact(node) } else { &contacts[node - known] };
        let row = |buffers: &mut G::Buffers, from: usize| {
            let mut counter = meter.counter();
            let mut found = Vec::new();
            let landings = if from < known { known..all } else { 0..all };
            for to in landings.filter(|to| *to != from) {
                counter.pair()?;
                if let Some((_, windows)) = ground.windows(of(from), of(to), buffers) {
                    found.extend(windows.iter().map(|lofts| (to, *lofts)));
                }
            }
            Ok(found)
        };
        let rows = (0..all).into_par_iter().map_init(G::Buffers::default, row);
        let rows: Vec<Vec<(usize, SlopeInterval)>> = rows.collect::<Result<_, Cancelled>>()?;
        let walked = RoadmapWalks::found(ground, &of, known..all, &meter)?;
        meter.check()?;
        let pairs = |count: usize| count as u64 * (count as u64).saturating_sub(1);
        self.pairs_tested += pairs(all) - pairs(known);
        for contact in contacts {
            self.graph.add_node(contact);
        }
        self.graph.reserve_edges(rows.iter().map(Vec::len).sum());
        for (from, row) in rows.into_iter().enumerate() {
            for (to, lofts) in row {
                self.graph.add_edge(NodeIndex::new(from), NodeIndex::new(to), lofts);
            }
        }
        self.walks.add(all, walked);
        Ok(())
    }

    /// Adds one contact and windows of hops to it and from it, by their take-offs and landings, those of one hop together and ascending;
    /// `pairs`: how many ordered pairs were tested for them.
    pub(super) fn join(&mut self, contact: N, windows: &[(usize, usize, SlopeInterval)], pairs: u64) {
        self.graph.add_node(contact);
        for (from, to, lofts) in windows {
            self.graph.add_edge(NodeIndex::new(*from), NodeIndex::new(*to), *lofts);
        }
        self.pairs_tested += pairs;
    }

    /// Removes the hops for which a condition on take-off and landing holds. The windows of each hop that stays remain together.
    pub(super) fn remove_hops(&mut self, is_removed: impl Fn(usize, usize) -> bool) {
        let kept: Vec<_> = self.all_windows().filter(|(from, to, _)| !is_removed(*from, *to)).collect();
        self.graph.clear_edges();
        for (from, to, lofts) in kept {
            self.graph.add_edge(NodeIndex::new(from), NodeIndex::new(to), lofts);
        }
    }

    /// The line of sight of a hop.
    pub fn sight(&self, ground: &impl RoadmapGround<Node = N>, from: usize, to: usize) -> Option<LineOfSight> {
        ground.sight(self.contact(from), self.contact(to))
    }

    /// The fewest hops from every contact to one; `None` from where it is not reached.
    pub fn hops_to(&self, goal: usize) -> Vec<Option<u32>> {
        self.levels(goal, Towards::Incoming)
    }

    /// The fewest hops from one contact to every other; `None` to where it does not lead.
    pub fn hops_out_of(&self, start: usize) -> Vec<Option<u32>> {
        self.levels(start, Towards::Outgoing)
    }

    /// Breadth-first search, along the edges or against them; walking takes no hop.
    fn levels(&self, first: usize, towards: Towards) -> Vec<Option<u32>> {
        let mut levels = vec![None; self.contact_count()];
        levels[first] = Some(0);
        let mut layer = vec![NodeIndex::new(first)];
        let walks = self.walks.towards(towards);
        let mut hops = 0;
        while !layer.is_empty() {
            let mut walked = 0;
            while let Some(node) = layer.get(walked) {
                for &neighbour in walks.get(node.index()).into_iter().flatten() {
                    if levels[neighbour].is_none() {
                        levels[neighbour] = Some(hops);
                        layer.push(NodeIndex::new(neighbour));
                    }
                }
                walked += 1;
            }
            hops += 1;
            let mut next = Vec::new();
            for node in layer {
                for neighbour in self.graph.neighbors_directed(node, towards) {
                    let level = &mut levels[neighbour.index()];
                    if level.is_none() {
                        *level = Some(hops);
                        next.push(neighbour);
                    }
                }
            }
            layer = next;
        }
        levels
    }

    /// All windows, in the order in which they were added: take-off, landing, lofts.
    pub(super) fn all_windows(&self) -> impl Iterator<Item = (usize, usize, SlopeInterval)> + '_ {
        let ends = |edge: EdgeIndex| self.graph.edge_endpoints(edge);
        self.graph.edge_indices().filter_map(move |edge| {
            let (from, to) = ends(edge)?;
            Some((from.index(), to.index(), self.graph[edge]))
        })
    }
}
