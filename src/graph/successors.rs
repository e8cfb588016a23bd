//! The successors of every node within a budget of hops, the most reliable first.

use std::{
    fmt,
    sync::{Arc, OnceLock},
};

use crate::quantity::NodeId;

/// The number of successors kept for each node. A robot near the node takes the first that is feasible from its actual
/// position; if none of these is feasible, the remaining ones are unlikely to be more reliable than any feasible hop.
const KEPT: usize = 32;

/// An edge on some path within the hop budget: its target, its hops, its weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Successor {
    pub(super) target: usize,
    pub(super) hops: u64,
    /// `-ln` of its estimated probability to succeed, and what is added to rank hops without risk.
    pub(super) weight: f64,
}

/// For every node, its successors in order of the reliability of the rest of the path within the hop budget, the most reliable
/// first. A clone shares the edges and their weights.
///
/// Let `W_k(u)` be the least weight from `u` with at most `k` hops:
///
/// ```text
///     W_k(u) = min over edges (u, v) of n hops of  w(u, v) + W_(k - n)(v),   W_k(goal) = 0
/// ```
///
/// for ascending `k` (Bellman 1958), from a node's fewest hops to these and the extra ones.
#[derive(Clone)]
pub(super) struct Successors {
    of_all: Arc<Weighted>,
    /// How many hops more than its fewest a path may take from every node.
    extra: u64,
    /// For every node at most [`KEPT`], sorted when the node is first asked about: a robot comes to few of them.
    ranked: Arc<[OnceLock<Vec<NodeId>>]>,
}

/// The edges of all nodes and the least weights by number of hops.
struct Weighted {
    edges: Vec<Vec<Successor>>,
    /// The fewest hops from every node to the goal; `None` where it cannot be reached. The goal itself has 0.
    fewest: Vec<Option<u64>>,
    extra: u64,
    /// For every node, the weight with its fewest hops, with one more, and so on.
    weights: Vec<f64>,
}

impl fmt::Debug for Successors {
    /// All that its answers depend on, and not which of them were given.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Weighted { edges, fewest, weights, .. } = self.of_all.as_ref();
        let edges: usize = edges.iter().map(Vec::len).sum();
        let debug = &mut formatter.debug_struct("Successors");
        debug
            .field("extra", &self.extra)
            .field("edges", &edges)
            .field("fewest", fewest)
            .field("weights", weights)
            .finish_non_exhaustive()
    }
}

impl Successors {
    /// Of these edges of all nodes, each on some path to the goal within the hop budget.
    ///
    /// # Complexity
    /// With E edges: `E (1 + extra)` additions, and 8 bytes for each node and number of hops.
    pub(super) fn new(edges: Vec<Vec<Successor>>, fewest: Vec<Option<u64>>, extra: u64) -> Self {
        let ranked = unranked(fewest.len());
        Self { of_all: Arc::new(Weighted::new(edges, fewest, extra)), extra, ranked }
    }

    /// The same with fewer hops allowed beyond the fewest; with more, unchanged.
    pub(super) fn with_fewer_extra_hops(&self, extra: u64) -> Self {
        if extra >= self.extra {
            return self.clone();
        }
        // The weights with fewer hops are among those with more.
        Self { of_all: Arc::clone(&self.of_all), extra, ranked: unranked(self.ranked.len()) }
    }

    /// The fewest hops from a node to the goal; `None` if it cannot be reached.
    pub(super) fn fewest(&self, node: usize) -> Option<u64> {
        self.of_all.fewest[node]
    }

    /// The successors of a node, the most reliable first; empty at the goal and if the goal cannot be reached from the node.
    pub(super) fn of(&self, node: NodeId) -> &[NodeId] {
        self.ranked[node.index()].get_or_init(|| self.rank(node.index()))
    }

    /// How many hops more than its fewest a path may take from every node.
    pub(super) const fn extra(&self) -> u64 {
        self.extra
    }

    /// The weight of the most reliable path from a node to the goal within the hop budget; infinite without such a path.
    pub(super) fn weight(&self, node: NodeId) -> f64 {
        let own = self.fewest(node.index());
        own.map_or(f64::INFINITY, |own| self.of_all.at(node.index(), own + self.extra))
    }

    /// The weight of the most reliable path from a node to the goal with at most this many hops, as far as the hop budget of the node
    /// allows them; infinite without such a path.
    pub(super) fn weight_with_hops(&self, node: usize, hops: u64) -> f64 {
        self.fewest(node).map_or(f64::INFINITY, |own| self.of_all.at(node, hops.min(own + self.extra)))
    }

    /// The nodes of the most reliable path from a node to the goal within the hop budget, both included; empty if the goal cannot be reached.
    pub(super) fn path(&self, from: usize) -> Vec<usize> {
        let (all, mut path) = (self.of_all.as_ref(), Vec::new());
        let Some(own) = self.fewest(from) else { return path };
        let (mut node, mut allowed) = (from, own + self.extra);
        path.push(node);
        while self.fewest(node) != Some(0) {
            let onward = all.edges[node].iter().map(|edge| (all.onward(edge, allowed), edge));
            let Some((_, edge)) = onward.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
            (node, allowed) = (edge.target, allowed.saturating_sub(edge.hops));
            path.push(node);
        }
        path
    }

    fn rank(&self, node: usize) -> Vec<NodeId> {
        let all = self.of_all.as_ref();
        let Some(own) = self.fewest(node) else { return Vec::new() };
        let allowed = own + self.extra;
        let mut onward: Vec<(f64, u64, usize)> = all.edges[node]
            .iter()
            .map(|edge| (all.onward(edge, allowed), edge, allowed.saturating_sub(edge.hops)))
            .filter(|&(weight, ..)| weight < f64::INFINITY)
            .map(|(weight, edge, rest)| (weight, edge.hops + all.hops_of_use(edge.target, rest), edge.target))
            .collect();
        // Of equally reliable paths the one with the fewest hops comes first, so that hops without risk lead to the goal
        // as well.
        onward.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        onward.into_iter().take(KEPT).map(|(.., target)| NodeId(target)).collect()
    }
}

fn unranked(nodes: usize) -> Arc<[OnceLock<Vec<NodeId>>]> {
    std::iter::repeat_with(OnceLock::new).take(nodes).collect()
}

impl Weighted {
    fn new(edges: Vec<Vec<Successor>>, fewest: Vec<Option<u64>>, extra: u64) -> Self {
        let mut all = Self { weights: vec![f64::INFINITY; fewest.len() * weights_each(extra)], edges, fewest, extra };
        // Only the goal itself reaches the goal without a hop.
        for (own, fewest) in all.weights.chunks_exact_mut(weights_each(extra)).zip(&all.fewest) {
            if *fewest == Some(0) {
                own.fill(0.0);
            }
        }
        let mut by_fewest: Vec<(u64, usize)> =
            all.fewest.iter().enumerate().filter_map(|(node, hops)| Some(((*hops)?, node))).filter(|(hops, _)| *hops > 0).collect();
        by_fewest.sort_unstable();
        let most = by_fewest.last().map_or(0, |(hops, _)| hops + extra);
        for allowed in 1..=most {
            let first = by_fewest.partition_point(|(own, _)| own + extra < allowed);
            let end = by_fewest.partition_point(|(own, _)| *own <= allowed);
            for &(_, node) in &by_fewest[first..end] {
                let Some(place) = all.place(node, allowed) else { continue };
                all.weights[place] = all.edges[node].iter().map(|edge| all.onward(edge, allowed)).fold(f64::INFINITY, f64::min);
            }
        }
        all
    }

    /// The index of the weight of a node for a number of hops allowed; `None` if no path is that short, or if more hops are
    /// allowed than needed.
    fn place(&self, node: usize, allowed: u64) -> Option<usize> {
        let more = allowed.checked_sub(self.fewest[node]?).filter(|&more| more <= self.extra)?;
        #[expect(clippy::cast_possible_truncation, reason = "a few hops more")]
        Some(node * weights_each(self.extra) + more as usize)
    }

    /// The least weight of a node for a number of hops allowed.
    fn at(&self, node: usize, allowed: u64) -> f64 {
        self.place(node, allowed).map_or(f64::INFINITY, |place| self.weights[place])
    }

    /// The fewest hops of the most reliable path from a node for a number of hops allowed.
    fn hops_of_use(&self, node: usize, allowed: u64) -> u64 {
        let weight = self.at(node, allowed);
        let fewer = (0..=allowed).rev().take_while(|&hops| self.place(node, hops).is_some() && self.at(node, hops) == weight);
        fewer.last().unwrap_or(allowed)
    }

    /// The least weight of a path that continues with an edge, for a total number of hops allowed.
    fn onward(&self, edge: &Successor, allowed: u64) -> f64 {
        allowed.checked_sub(edge.hops).map_or(f64::INFINITY, |rest| edge.weight + self.at(edge.target, rest))
    }
}

/// Number of weights kept for each node.
#[expect(clippy::cast_possible_truncation, reason = "a few hops more")]
const fn weights_each(extra: u64) -> usize {
    extra as usize + 1
}
