//! Fewest hops by breadth-first search, layer by layer: a layer is all nodes of one hop count.
//!
//! Each unreached node searches the last layer, nearest nodes first, for one that a feasible hop joins to it (bottom-up
//! breadth-first search). A bitmap of the layer lets the search skip nodes that have no layer node within reach. Pairs that cannot
//! improve the result are never tested, and the result does not depend on which thread tests a node first.

use rayon::prelude::*;

use super::{
    MapError, Post, PostHops,
    layer_bits::{Disc, LayerBits},
};
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    graph::Effort,
    progress::{Detail, Meter, PairCounter, Progress, Stage},
    quantity::SlopeInterval,
};

/// The hop count of a post that cannot be reached.
pub const UNREACHED: i16 = -1;

/// The hop count of a post without elevation.
pub const NO_GROUND: i16 = i16::MIN;

/// No offset: for the start and for unreached posts.
const NONE: u32 = u32::MAX;

/// The direction of travel between the start and the other posts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Journey {
    /// From the start to every post.
    #[default]
    Outbound,
    /// From every post to the start.
    Return,
}

/// What to search for.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Search {
    /// Outbound or return.
    pub journey: Journey,
    /// If given, also find the least effort among the paths of fewest hops, for this choice of take-offs.
    pub effort: Option<(Effort, TakeoffChoice)>,
}

/// Fewest hops between the start and every node.
#[derive(Clone, Debug, PartialEq)]
pub struct HopMap {
    /// For each node, row after row: its hop count, [`UNREACHED`] or [`NO_GROUND`].
    pub hops: Vec<i16>,
    /// The least effort among the paths of fewest hops, in the unit of the requested [`Effort`]; NaN for unreached nodes. Empty if
    /// no effort was requested.
    pub effort: Vec<f64>,
    /// The offset of the hop between each node and the node before it.
    previous: Vec<u32>,
    journey: Journey,
}

/// A node reached by the present layer.
#[derive(Clone, Copy, Debug)]
struct Found {
    node: usize,
    offset: u32,
    effort: f64,
}

/// The fewest hops between a start and every node, layer by layer; the result does not depend on the number of threads.
///
/// Reports every complete layer, with the number of posts reached and the number of posts reached or still open.
///
/// # Errors
/// [`MapError`]; if several blocks fail, the error of the block with the lowest index.
pub fn search(hops: &PostHops, start: Post, asked: Search, progress: &dyn Progress) -> Result<HopMap, MapError> {
    let meter = Meter::new(progress, Stage::MapLayers);
    meter.report(Detail::None)?;
    let mut state = State::new(hops, start, asked);
    let mut layer: i16 = 0;
    loop {
        let open: u64 = state.open.iter().copied().map(u64::from).sum();
        meter.set_done(state.reached as u64, state.reached as u64 + open);
        meter.report(Detail::Layer { hops: layer })?;
        let pull = Pull { hops, map: &state.map, asked, layer, nodes: &state.layer };
        let near = blocks_near(hops, &state.layer_blocks, &state.open);
        let found: Vec<Result<Vec<Found>, MapError>> =
            near.par_iter().map_init(|| meter.counter(), |counter, &block| pull.block(block, counter)).collect();
        meter.check()?;
        let found = found.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
        if found.is_empty() {
            return Ok(state.map);
        }
        layer = layer.checked_add(1).ok_or(MapError::TooManyHops { most: i16::MAX })?;
        state.layer_blocks.fill(false);
        state.layer.clear();
        for node in found {
            state.settle(hops, node, layer);
        }
    }
}

/// The state between two layers.
struct State {
    map: HopMap,
    /// For each block, the number of nodes that may still be reached.
    open: Vec<u32>,
    /// The nodes of the last layer.
    layer: LayerBits,
    /// Blocks with nodes of the last layer.
    layer_blocks: Vec<bool>,
    /// Number of nodes reached.
    reached: usize,
}

impl State {
    /// The state with only the start reached.
    fn new(hops: &PostHops, start: Post, asked: Search) -> Self {
        let lattice = hops.lattice();
        let (nodes, (down, across)) = (lattice.count(), lattice.blocks());
        let ground = |index| if hops.has_ground(lattice.node(index)) { UNREACHED } else { NO_GROUND };
        let usable = |block| lattice.nodes_of(block).map(|node| u32::from(hops.usable(node))).sum();
        let map = HopMap {
            hops: (0..nodes).into_par_iter().map(ground).collect(),
            effort: if asked.effort.is_some() { vec![f64::NAN; nodes] } else { Vec::new() },
            previous: vec![NONE; nodes],
            journey: asked.journey,
        };
        let open = (0..down * across).into_par_iter().map(usable).collect();
        let mut state = Self { map, open, layer: LayerBits::none(lattice), layer_blocks: vec![false; down * across], reached: 0 };
        state.settle(hops, Found { node: lattice.index(start), offset: NONE, effort: 0.0 }, 0);
        state
    }

    /// Marks a node as reached.
    fn settle(&mut self, hops: &PostHops, Found { node, offset, effort }: Found, count: i16) {
        let lattice = hops.lattice();
        self.map.hops[node] = count;
        self.map.previous[node] = offset;
        if let Some(known) = self.map.effort.get_mut(node) {
            *known = effort;
        }
        let post = lattice.node(node);
        let block = lattice.block_of(post);
        self.layer_blocks[block] = true;
        self.layer.insert(post);
        // The start may be a node at which no hop can begin or end.
        self.open[block] -= u32::from(hops.usable(post)).min(self.open[block]);
        self.reached += 1;
    }
}

/// The blocks with open nodes that are within reach of the layer.
fn blocks_near(hops: &PostHops, layer: &[bool], open: &[u32]) -> Vec<usize> {
    let (down, across) = hops.lattice().blocks();
    (0..down * across)
        .into_par_iter()
        .filter(|&block| {
            let within = hops.within_reach(block);
            if open[block] == 0 || within == 0 {
                return false;
            }
            let (rows, cols) = hops.blocks_within(hops.offsets()[within - 1].run_m);
            let (row, col) = (block / across, block % across);
            (row.saturating_sub(rows)..=(row + rows).min(down - 1)).any(|row| {
                layer[row * across + col.saturating_sub(cols)..=row * across + (col + cols).min(across - 1)].contains(&true)
            })
        })
        .collect()
}

/// One round of the search: all unreached nodes against the last layer.
struct Pull<'a> {
    hops: &'a PostHops,
    map: &'a HopMap,
    asked: Search,
    layer: i16,
    nodes: &'a LayerBits,
}

impl Pull<'_> {
    /// The nodes of a block that a hop joins to the layer.
    fn block(&self, block: usize, counter: &mut PairCounter<'_>) -> Result<Vec<Found>, MapError> {
        counter.check()?;
        let lattice = self.hops.lattice();
        let steps = &self.hops.node_steps()[..self.hops.within_reach(block)];
        let disc = Disc::of(&self.hops.offsets()[..steps.len()]);
        let mut found = Vec::new();
        for node in lattice.nodes_of(block) {
            let open = self.map.hops[lattice.index(node)] == UNREACHED && self.hops.usable(node);
            if open && self.nodes.any_in(&disc, node) {
                found.extend(self.pulled(node, steps, disc.is_inside(lattice, node), counter)?);
            }
        }
        Ok(found)
    }

    /// The node at the other end of an offset, if it is in the layer. `inside` says that all offsets from this node stay on the
    /// map; then membership is checked first through the array step, without computing row and column.
    #[inline]
    fn on_layer(&self, node: Post, index: usize, (number, step): (usize, isize), inside: bool) -> Option<Post> {
        let step = if self.asked.journey == Journey::Outbound { -step } else { step };
        let is_on_layer = |at: usize| self.map.hops[at] == self.layer;
        if inside && !is_on_layer(index.wrapping_add_signed(step)) {
            return None;
        }
        let other = match self.asked.journey {
            Journey::Outbound => self.hops.takeoff(node, number),
            Journey::Return => self.hops.landing(node, number),
        }?;
        (inside || is_on_layer(self.hops.lattice().index(other))).then_some(other)
    }

    /// The hop that joins a node to the layer: the shortest, or the one with the least total effort.
    fn pulled(&self, node: Post, steps: &[isize], inside: bool, counter: &mut PairCounter<'_>) -> Result<Option<Found>, MapError> {
        let lattice = self.hops.lattice();
        let index = lattice.index(node);
        let mut best: Option<Found> = None;
        for (number, &step) in steps.iter().enumerate() {
            let Some(other) = self.on_layer(node, index, (number, step), inside) else { continue };
            counter.pair()?;
            let offset = &self.hops.offsets()[number];
            let from = if self.asked.journey == Journey::Outbound { other } else { node };
            #[expect(clippy::cast_possible_truncation, reason = "the table of offsets is far smaller")]
            let offset_number = number as u32;
            let Some((effort, choice)) = self.asked.effort else {
                if self.hops.lofts_where(from, offset, |_, _| true)?.is_some() {
                    return Ok(Some(Found { node: index, offset: offset_number, effort: f64::NAN }));
                }
                continue;
            };
            let so_far = self.map.effort[lattice.index(other)];
            let least = best.map_or(f64::INFINITY, |best| best.effort);
            let gravity = self.hops.envelope().gravity_m_s2();
            let any_speed = self.hops.envelope().takeoff_speeds().are_any();
            let worth = |sight: LineOfSight, lofts: SlopeInterval| {
                // Where the machine lacks the slowest arc, the flatter one flown instead may be shorter.
                let is_bound = choice == TakeoffChoice::LeastSpeed && (any_speed || effort != Effort::Time);
                !is_bound || joined(effort, so_far, at_least(effort, sight, lofts, gravity)) < least
            };
            if let Some((sight, lofts)) = self.hops.lofts_where(from, offset, worth)? {
                let arc = Arc::new(sight, self.hops.envelope().loft(choice, sight, lofts), gravity);
                let effort = joined(effort, so_far, effort.cost(&arc, 1).effort());
                if effort < least {
                    best = Some(Found { node: index, offset: offset_number, effort });
                }
            }
        }
        Ok(best)
    }
}

/// Effort of a path extended by one hop.
fn joined(effort: Effort, path: f64, hop: f64) -> f64 {
    if effort == Effort::PeakSpeed { path.max(hop) } else { path + hop }
}

/// A lower bound on the effort of a hop whose lofts satisfy all limits but the terrain, for the choice `LeastSpeed`. Terrain can
/// only raise the lower end of the interval, which never lowers the least speed or the flight time. The bound is reduced by a
/// relative 1e-9 to allow for rounding.
fn at_least(effort: Effort, sight: LineOfSight, lofts: SlopeInterval, gravity_m_s2: f64) -> f64 {
    let loft = TakeoffChoice::LeastSpeed.loft(sight, lofts);
    let slope = sight.slope() + loft;
    let doubled_energy = gravity_m_s2 * sight.run_m() * (1.0 + slope * slope) / (2.0 * loft);
    let least = match effort {
        Effort::TakeoffSpeed | Effort::PeakSpeed => doubled_energy.sqrt(),
        Effort::Energy => 0.5 * doubled_energy,
        Effort::Time => (2.0 * sight.run_m() * loft / gravity_m_s2).sqrt(),
    };
    least * (1.0 - 1.0e-9)
}

impl HopMap {
    /// The node before this one on its path from the start (after it, on a return path); `None` for the start and for unreached
    /// nodes.
    pub fn previous(&self, hops: &PostHops, node: Post) -> Option<Post> {
        let offset = self.previous[hops.lattice().index(node)];
        if offset == NONE {
            return None;
        }
        match self.journey {
            Journey::Outbound => hops.takeoff(node, offset as usize),
            Journey::Return => hops.landing(node, offset as usize),
        }
    }

    /// The nodes of a path of fewest hops between the start and a node, in the order of flight; `None` if no path was found.
    pub fn path(&self, hops: &PostHops, node: Post) -> Option<Vec<Post>> {
        if self.hops[hops.lattice().index(node)] < 0 {
            return None;
        }
        let mut nodes = vec![node];
        nodes.extend(std::iter::successors(self.previous(hops, node), |&node| self.previous(hops, node)));
        if self.journey == Journey::Outbound {
            nodes.reverse();
        }
        Some(nodes)
    }
}
