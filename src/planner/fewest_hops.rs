//! The fewest hops from every node of a DEM to the goal, or from the start to every node: breadth first, level by level.

use rayon::prelude::*;

use super::{
    SurfaceNode,
    beside::{cells_beside, holds},
    surface_hops::{Side, SurfaceHops},
};
use crate::{
    ground::MapPosition,
    progress::{Cancelled, Meter, PairCounter},
    quantity::MapPoint,
};

/// No hops are known.
const UNKNOWN: u32 = u32::MAX;

/// The fewest hops of nodes, from one end.
#[derive(Clone, Debug)]
pub(super) struct FewestHops {
    /// By node; [`UNKNOWN`] without any.
    hops: Vec<u32>,
    /// How many have some, the end included.
    pub(super) known: usize,
    /// Pairs of nodes whose hop was computed.
    pub(super) pairs: u64,
}

/// Which nodes count.
#[derive(Clone, Copy)]
pub(super) struct Within<'w> {
    /// Those that near to a straight line, m.
    pub(super) line: Option<([MapPoint; 2], f64)>,
    /// Those from which no more hops are left than the bound at a position says, of so many in all.
    pub(super) most: u64,
    /// The fewest hops between a position and the other end that anything may take.
    pub(super) rest: &'w (dyn Fn(&MapPosition) -> u64 + Sync),
    /// Whether to end with the level that completes these nodes; of none, never.
    pub(super) until: &'w [SurfaceNode],
}

impl Within<'_> {
    fn holds(&self, at: &MapPosition, hops: u32) -> bool {
        let near = self.line.is_none_or(|(line, most_m)| distance_m(at.at, line) <= most_m);
        near && (self.most == u64::MAX || u64::from(hops).saturating_add((self.rest)(at)) <= self.most)
    }
}

/// The distance of a point from a line between two others, m.
fn distance_m(at: MapPoint, [from, to]: [MapPoint; 2]) -> f64 {
    let (along, away) = (to - from, at - from);
    let share = (away.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (away - along * share).norm()
}

impl FewestHops {
    /// Searches from one end.
    ///
    /// The numbers do not depend on the order in which a level is evaluated. With a bound they are those of all paths that may keep it: the
    /// bound never falls by more than one along a hop.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Complexity
    /// 4 bytes for each node. Every level looks at the nodes within reach of the one before, and computes hops to each, the shortest first,
    /// until one is feasible.
    pub(super) fn from(
        surface: &SurfaceHops<'_>,
        (side, end): (Side, SurfaceNode),
        within: &Within<'_>,
        meter: &Meter<'_>,
    ) -> Result<Self, Cancelled> {
        let mut found = Self { hops: vec![UNKNOWN; surface.nodes.count()], known: 1, pairs: 0 };
        found.hops[end.index()] = 0;
        let mut level = vec![end];
        for hops in 1..UNKNOWN {
            let is_known = |node: &SurfaceNode| found.hops[node.index()] != UNKNOWN;
            let is_done = !within.until.is_empty() && within.until.iter().all(is_known);
            if level.is_empty() || is_done || u64::from(hops) > within.most {
                break;
            }
            meter.check()?;
            let asked = nodes_beside(surface, side, &level, |node| found.hops[node.index()] == UNKNOWN);
            let evaluate = |counter: &mut PairCounter<'_>, node: &SurfaceNode| {
                found.is_reached(surface, side, (within, *node, hops - 1), counter)
            };
            let begin = || meter.counter();
            let reached: Vec<(bool, u64)> =
                asked.par_iter().with_min_len(16).map_init(begin, evaluate).collect::<Result<_, _>>()?;
            level.clear();
            for (node, (is_reached, pairs)) in asked.into_iter().zip(reached) {
                found.pairs += pairs;
                if is_reached {
                    found.hops[node.index()] = hops;
                    level.push(node);
                }
            }
            found.known += level.len();
        }
        Ok(found)
    }

    /// The fewest hops of a node; `None` if none are known.
    pub(super) fn of(&self, node: SurfaceNode) -> Option<u32> {
        self.hops.get(node.index()).copied().filter(|hops| *hops != UNKNOWN)
    }

    /// The node with hops that is nearest to a position, horizontally.
    pub(super) fn nearest(&self, surface: &SurfaceHops<'_>, to: &MapPosition) -> Option<MapPosition> {
        let away = |at: &MapPosition| (at.at - to.at).norm_squared();
        self.all().filter_map(|node| surface.position(node)).min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// All nodes with hops.
    pub(super) fn all(&self) -> impl Iterator<Item = SurfaceNode> + '_ {
        let known = |(node, hops): (usize, &u32)| (*hops != UNKNOWN).then_some(SurfaceNode::of_index(node));
        self.hops.iter().enumerate().filter_map(known)
    }

    /// Whether a feasible hop joins a node to one with so many hops, and how many were computed.
    fn is_reached(
        &self,
        surface: &SurfaceHops<'_>,
        side: Side,
        (within, node, hops): (&Within<'_>, SurfaceNode, u32),
        counter: &mut PairCounter<'_>,
    ) -> Result<(bool, u64), Cancelled> {
        let Some(at) = surface.position(node).filter(|at| within.holds(at, hops + 1)) else { return Ok((false, 0)) };
        let mut pairs = 0;
        // The shortest hop is the most likely one.
        for known in surface.nearest_first(node, &at, side.other()).filter(|known| self.hops[known.index()] == hops) {
            let Some(there) = surface.position(known) else { continue };
            let (nodes, ends) = side.in_order((known, &there), (node, &at));
            let Some(sight) = surface.sight(ends[0], ends[1]) else { continue };
            pairs += 1;
            counter.pair()?;
            if surface.between(nodes, ends, sight).is_some() {
                return Ok((true, pairs));
            }
        }
        Ok((false, pairs))
    }
}

/// The nodes of some kind that may be within reach of a level, each once: those to which hops from it may lead, or from the goal's side those
/// from which hops to it may.
pub(super) fn nodes_beside(
    surface: &SurfaceHops<'_>,
    side: Side,
    level: &[SurfaceNode],
    wanted: impl Fn(SurfaceNode) -> bool,
) -> Vec<SurfaceNode> {
    let (nodes, lattice) = (surface.nodes, surface.nodes.lattice());
    let reaches_m = level.iter().filter_map(|node| surface.position(*node)).map(|at| surface.reach_m(&at, side));
    let (down, aside) = lattice.cells_within(reaches_m.fold(0.0, f64::max));
    let mut cells: Vec<_> = level.iter().map(|node| nodes.cell(*node)).collect();
    cells.sort_unstable();
    let near = cells_beside(&cells, lattice.size(), (down + 1, aside + 1));
    let of_lattice = near.iter().flat_map(|(row, ranges)| {
        ranges.iter().flat_map(move |cols| cols.clone().map(move |col| SurfaceNode::of_lattice(lattice, (col, *row))))
    });
    let beside = nodes.single_places().filter(|(_, at)| holds(&near, lattice.cell_near(*at))).map(|(node, _)| node);
    of_lattice.chain(beside).filter(|node| wanted(*node)).collect()
}
