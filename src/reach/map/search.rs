//! Fewest hops by breadth-first search, layer by layer: a layer is all nodes of one hop count.
//!
//! A map has one or several [`Source`]s, each with what was spent on the way to it; a source joins the layer of its hop count.
//!
//! Each unreached node searches the last layer, nearest nodes first, for one that a feasible hop joins to it (bottom-up
//! breadth-first search). A bitmap of the layer lets the search skip nodes that have no layer node within reach. Pairs that cannot
//! improve the result are never tested, and the result does not depend on which thread tests a node first.

use rayon::prelude::*;

use super::{
    MapError, NodeLattice, Post, PostHops,
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

/// The hop count of a post that may need more hops than [`Search::hops_max`], which no search has looked for.
pub const NOT_SEARCHED: i16 = -2;

/// No offset, and no source: for sources and for unreached posts.
pub(super) const NONE: u32 = u32::MAX;

/// A node that paths start from, and what was spent before: the labels with which the search begins there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// The node.
    pub node: Post,
    /// Hops already spent, at least 0.
    pub hops: i16,
    /// Effort already spent, in the unit of the requested [`Effort`], finite and at least 0; without one it is ignored.
    pub effort: f64,
}

impl From<Post> for Source {
    /// A source at which nothing was spent yet.
    fn from(node: Post) -> Self {
        Self { node, hops: 0, effort: 0.0 }
    }
}

/// The direction of travel between the sources and the other posts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Journey {
    /// From the nearest source to every post.
    #[default]
    Outbound,
    /// From every post to the nearest source.
    Return,
}

/// What to search for.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Search {
    /// Outbound or return.
    pub journey: Journey,
    /// If given, also find the least effort among the paths of fewest hops, for this choice of take-offs.
    pub effort: Option<(Effort, TakeoffChoice)>,
    /// The search ends after the layer of this hop count; `None`: after the last layer.
    pub hops_max: Option<i16>,
}

/// Fewest hops between the sources and every node.
#[derive(Clone, Debug, PartialEq)]
pub struct HopMap {
    /// For each node, row after row: its hop count, [`UNREACHED`], [`NO_GROUND`] or, beyond [`Search::hops_max`], [`NOT_SEARCHED`].
    pub hops: Vec<i16>,
    /// The least effort among the paths of fewest hops, in the unit of the requested [`Effort`]; NaN for unreached nodes. Empty if
    /// no effort was requested.
    pub effort: Vec<f64>,
    /// The offset of the hop between each node and the node before it.
    previous: Vec<u32>,
    /// For each node the number of its source; empty for a map of one source.
    nearest: Vec<u32>,
    journey: Journey,
}

/// Paths that were found otherwise: for each node where its last hop comes from.
pub(super) struct PathLabels {
    /// What a node without a path is marked with.
    pub(super) marks: Vec<i16>,
    /// Whether there is a path.
    pub(super) reached: Vec<bool>,
    /// The offset of its last hop; [`NONE`] at sources.
    pub(super) previous: Vec<u32>,
    /// The number of its source; empty for a map of one.
    pub(super) nearest: Vec<u32>,
}

/// A node reached by the present layer.
#[derive(Clone, Copy, Debug)]
struct Found {
    node: usize,
    offset: u32,
    effort: f64,
    /// The number of the source.
    source: u32,
}

/// The fewest hops between the sources and every node, layer by layer; the result does not depend on the number of threads.
///
/// The label of a node is the least over all sources: the fewest hops, those spent before a source included, then, if requested, the
/// least effort. Of sources with equal labels at a node, the one of the lower number is its nearest. Without sources, no node is reached.
///
/// Reports every complete layer, with the number of posts reached and the number of posts reached or still open.
///
/// # Errors
/// [`MapError`]; if several blocks fail, the error of the block with the lowest index. [`MapError::Request`] if a label is negative or,
/// with an effort, not finite.
///
/// # Examples
/// ```
/// use chta::{ground::DemGround, reach::map::{Post, PostHops, Search, Source, search}, terrain::{OverlaidDem, Overlays, SyntheticTerrain, synthesise}, world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties}};
/// let dem = synthesise(&SyntheticTerrain { rows: 20, cols: 30, ..SyntheticTerrain::default() })?;
/// let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.6)?)), rest: RestSlope::AsFrictionHolds };
/// let hopper = Hopper::new(HopperLimits::with_speeds(2.0, 2.0))?;
/// let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(1.62)?, &surface);
/// let hops = PostHops::new(ground, 1)?;
/// // Two landers; the second begins two hops late.
/// let late = Source { node: Post { row: 15, col: 28 }, hops: 2, effort: 0.0 };
/// let map = search(&hops, &[Post { row: 3, col: 2 }.into(), late], Search::default(), &())?;
/// assert_eq!(map.hops[hops.lattice().index(late.node)], 2);
/// assert_eq!(map.source(hops.lattice(), late.node), Some(1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn search(hops: &PostHops, sources: &[Source], asked: Search, progress: &dyn Progress) -> Result<HopMap, MapError> {
    check_labels(sources, asked)?;
    let stage = match asked.journey {
        Journey::Outbound => Stage::MapLayers,
        Journey::Return => Stage::ReturnLayers,
    };
    let meter = Meter::new(progress, stage);
    meter.report(Detail::None)?;
    let mut state = State::new(hops, sources, asked);
    let first = state.waiting.last().map(|(_, source)| source.hops);
    if first.is_some_and(|first| asked.hops_max.is_some_and(|most| first > most)) {
        state.leave_open(hops);
        return Ok(state.map);
    }
    let Some(mut layer) = state.join_sources(hops, None) else { return Ok(state.map) };
    loop {
        let open: u64 = state.open.iter().copied().map(u64::from).sum();
        meter.set_done(state.reached as u64, state.reached as u64 + open);
        meter.report(Detail::Layer { hops: layer })?;
        let near = blocks_near(hops, &state.layer_blocks, &state.open);
        let is_last = asked.hops_max.is_some_and(|most| layer >= most);
        if is_last && (!near.is_empty() || !state.waiting.is_empty()) {
            state.leave_open(hops);
            return Ok(state.map);
        }
        let pull = Pull { hops, map: &state.map, asked, layer, nodes: &state.layer };
        let found: Vec<Result<Vec<Found>, MapError>> =
            near.par_iter().map_init(|| meter.counter(), |counter, &block| pull.block(block, counter)).collect();
        meter.check()?;
        let found = found.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
        if found.is_empty() && state.waiting.is_empty() {
            return Ok(state.map);
        }
        state.layer_blocks.fill(false);
        state.layer.clear();
        if found.is_empty() {
            // Only sources of greater hop counts are left.
            let Some(next) = state.join_sources(hops, None) else { return Ok(state.map) };
            layer = next;
            continue;
        }
        layer = layer.checked_add(1).ok_or(MapError::TooManyHops { most: i16::MAX })?;
        for node in found {
            state.settle(hops, node, layer);
        }
        state.join_sources(hops, Some(layer));
    }
}

/// Checks the labels of the sources.
fn check_labels(sources: &[Source], asked: Search) -> Result<(), MapError> {
    for source in sources {
        if source.hops < 0 {
            let (found, expected) = (source.hops.to_string(), "a count of at least 0");
            return Err(MapError::Request { what: "the hop count of a source", found, expected });
        }
        let is_effort = source.effort.is_finite() && source.effort >= 0.0;
        if asked.effort.is_some() && !is_effort {
            let (found, expected) = (source.effort.to_string(), "a finite number of at least 0");
            return Err(MapError::Request { what: "the effort of a source", found, expected });
        }
    }
    Ok(())
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
    /// The sources that have not joined yet, with their numbers, those of the fewest hops last.
    waiting: Vec<(u32, Source)>,
}

impl State {
    /// The state before any source has joined.
    fn new(hops: &PostHops, sources: &[Source], asked: Search) -> Self {
        let lattice = hops.lattice();
        let (nodes, (down, across)) = (lattice.count(), lattice.blocks());
        let ground = |index| if hops.has_ground(lattice.node(index)) { UNREACHED } else { NO_GROUND };
        let usable = |block| lattice.nodes_of(block).map(|node| u32::from(hops.usable(node))).sum();
        let map = HopMap {
            hops: (0..nodes).into_par_iter().map(ground).collect(),
            effort: if asked.effort.is_some() { vec![f64::NAN; nodes] } else { Vec::new() },
            previous: vec![NONE; nodes],
            nearest: if sources.len() > 1 { vec![NONE; nodes] } else { Vec::new() },
            journey: asked.journey,
        };
        let open = (0..down * across).into_par_iter().map(usable).collect();
        let mut waiting: Vec<(u32, Source)> = (0..).zip(sources.iter().copied()).collect();
        waiting.sort_by_key(|(number, source)| std::cmp::Reverse((source.hops, *number)));
        Self { map, open, layer: LayerBits::none(lattice), layer_blocks: vec![false; down * across], reached: 0, waiting }
    }

    /// Adds the waiting sources of a hop count, `None`: of the fewest hops, to the present layer.
    ///
    /// A source on a node that was reached in fewer hops, or in as many with less effort, changes nothing.
    ///
    /// # Returns
    /// That hop count; `None` if no source waits.
    fn join_sources(&mut self, hops: &PostHops, count: Option<i16>) -> Option<i16> {
        let count = count.or_else(|| self.waiting.last().map(|(_, source)| source.hops))?;
        while let Some((number, source)) = self.waiting.pop_if(|(_, source)| source.hops == count) {
            let node = hops.lattice().index(source.node);
            let found = Found { node, offset: NONE, effort: source.effort, source: number };
            match self.map.hops[node] {
                known if known < 0 => self.settle(hops, found, count),
                known if known == count && self.map.is_nearer(&found) => self.label(found, count),
                _ => {}
            }
        }
        Some(count)
    }

    /// Marks the nodes that a further layer could reach, and sources that have not joined, as not searched.
    fn leave_open(&mut self, hops: &PostHops) {
        let lattice = hops.lattice();
        let is_open = |node: usize| hops.usable(lattice.node(node));
        let unreached = self.map.hops.par_iter_mut().enumerate().filter(|(_, count)| **count == UNREACHED);
        unreached.filter(|(node, _)| is_open(*node)).for_each(|(_, count)| *count = NOT_SEARCHED);
        for (_, source) in &self.waiting {
            let count = &mut self.map.hops[lattice.index(source.node)];
            if *count == UNREACHED {
                *count = NOT_SEARCHED;
            }
        }
    }

    /// Labels a node.
    fn label(&mut self, Found { node, offset, effort, source }: Found, count: i16) {
        self.map.hops[node] = count;
        self.map.previous[node] = offset;
        if let Some(known) = self.map.effort.get_mut(node) {
            *known = effort;
        }
        if let Some(known) = self.map.nearest.get_mut(node) {
            *known = source;
        }
    }

    /// Marks a node as reached.
    fn settle(&mut self, hops: &PostHops, found: Found, count: i16) {
        let (lattice, node) = (hops.lattice(), found.node);
        self.label(found, count);
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

    /// The hop that joins a node to the layer: the one with the least total effort, if requested, then from the source of the lowest
    /// number, then the shortest.
    fn pulled(&self, node: Post, steps: &[isize], inside: bool, counter: &mut PairCounter<'_>) -> Result<Option<Found>, MapError> {
        let lattice = self.hops.lattice();
        let index = lattice.index(node);
        let mut best: Option<Found> = None;
        for (number, &step) in steps.iter().enumerate() {
            let Some(other) = self.on_layer(node, index, (number, step), inside) else { continue };
            let source = self.map.nearest.get(lattice.index(other)).copied().unwrap_or(0);
            // Of equal labels that of the lower source counts; without an effort all labels of a layer are equal.
            let is_lower = best.is_some_and(|best| source < best.source);
            if self.asked.effort.is_none() && best.is_some() && !is_lower {
                continue;
            }
            counter.pair()?;
            let offset = &self.hops.offsets()[number];
            let from = if self.asked.journey == Journey::Outbound { other } else { node };
            #[expect(clippy::cast_possible_truncation, reason = "the table of offsets is far smaller")]
            let offset_number = number as u32;
            let Some((effort, choice)) = self.asked.effort else {
                if self.hops.lofts_where(from, offset, |_, _| true)?.is_some() {
                    best = Some(Found { node: index, offset: offset_number, effort: f64::NAN, source });
                    // No other source can be lower.
                    if source == 0 {
                        return Ok(best);
                    }
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
                let bound = joined(effort, so_far, at_least(effort, sight, lofts, gravity));
                !is_bound || bound < least || (is_lower && bound <= least)
            };
            if let Some((sight, lofts)) = self.hops.lofts_where(from, offset, worth)? {
                let arc = Arc::new(sight, self.hops.envelope().loft(choice, sight, lofts), gravity);
                let effort = joined(effort, so_far, effort.cost(&arc, 1).effort());
                if effort < least || (is_lower && effort <= least) {
                    best = Some(Found { node: index, offset: offset_number, effort, source });
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
    /// Whether a label is less than that of the same node, which has as many hops.
    fn is_nearer(&self, found: &Found) -> bool {
        let is_lower = self.nearest.get(found.node).is_some_and(|&nearest| found.source < nearest);
        match self.effort.get(found.node) {
            Some(&known) => found.effort < known || (found.effort <= known && is_lower),
            None => is_lower,
        }
    }

    /// The map of paths from their sources, with the hops of each.
    ///
    /// # Errors
    /// [`MapError::TooManyHops`].
    pub(super) fn of_paths(hops: &PostHops, labels: PathLabels) -> Result<Self, MapError> {
        let PathLabels { marks, reached, previous, nearest } = labels;
        let mut map = Self { hops: marks, effort: Vec::new(), previous, nearest, journey: Journey::Outbound };
        let each = vec![1.0; map.hops.len()];
        // Sources have no hop before them.
        map.hops.iter_mut().zip(&reached).filter(|(_, reached)| **reached).for_each(|(hops, _)| *hops = 0);
        let counts = map.summed(hops, &each, |total, hop| total + hop);
        for (hops, count) in map.hops.iter_mut().zip(counts).filter(|(hops, _)| **hops >= 0) {
            if count > f64::from(i16::MAX) {
                return Err(MapError::TooManyHops { most: i16::MAX });
            }
            #[expect(clippy::cast_possible_truncation, reason = "a count within the range")]
            let count = count as i16;
            *hops = count;
        }
        Ok(map)
    }

    /// For each node, row after row, what the hops of its path from the source take together, where `each` has what the last hop to each node
    /// takes; NaN without a path.
    pub(super) fn summed(&self, hops: &PostHops, each: &[f64], join: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let lattice = hops.lattice();
        let mut totals = vec![f64::NAN; each.len()];
        let mut ahead = Vec::new();
        for node in (0..each.len()).filter(|&node| self.hops[node] >= 0) {
            let mut at = node;
            while totals[at].is_nan() {
                ahead.push(at);
                match self.previous(hops, lattice.node(at)) {
                    Some(previous) => at = lattice.index(previous),
                    None => break,
                }
            }
            while let Some(next) = ahead.pop() {
                let before = self.previous(hops, lattice.node(next)).map(|previous| totals[lattice.index(previous)]);
                totals[next] = before.map_or(0.0, |before| join(before, each[next]));
            }
        }
        totals
    }

    /// Where the last hop to a node comes from, with its offset; `None` for sources and for unreached nodes.
    pub(super) fn last_hop(&self, hops: &PostHops, node: Post) -> Option<(Post, usize)> {
        Some((self.previous(hops, node)?, self.previous[hops.lattice().index(node)] as usize))
    }

    /// The bytes of a map for each node, with an effort or without, of one source or of several.
    pub(crate) const fn bytes_per_node(effort: bool, several: bool) -> usize {
        let labels = size_of::<i16>() + size_of::<u32>();
        labels + if effort { size_of::<f64>() } else { 0 } + if several { size_of::<u32>() } else { 0 }
    }

    /// The bytes that a search holds beside its map for each node, at most: those of a layer of all nodes, which is first found block by
    /// block, where short lists grow to twice their length, then joined; the bitmap of a layer; and the counts of the blocks.
    pub(crate) const fn search_bytes_per_node() -> usize {
        3 * size_of::<Found>() + 4
    }

    /// For each node, row after row, the node that the last hop of its path comes from (on a return map: that its first hop leads to), as
    /// its index in the same order; -1 at sources, and `absent` at nodes that were not reached.
    pub fn predecessors(&self, hops: &PostHops, absent: i32) -> Vec<i32> {
        let lattice = hops.lattice();
        let index_of = |node: usize| {
            if self.hops[node] < 0 {
                return absent;
            }
            let previous = self.previous(hops, lattice.node(node)).map(|previous| lattice.index(previous));
            previous.map_or(-1, |previous| i32::try_from(previous).unwrap_or(absent))
        };
        (0..lattice.count()).into_par_iter().map(index_of).collect()
    }

    /// The number of the source that a node is reached from by the fewest hops, then, if requested, the least effort, as its path leads
    /// there; where paths with equal labels meet, the lower number. `None` for unreached nodes.
    pub fn source(&self, lattice: NodeLattice, node: Post) -> Option<usize> {
        let index = lattice.index(node);
        let number = self.nearest.get(index).copied().unwrap_or(0);
        (self.hops[index] >= 0).then_some(number as usize)
    }

    /// Whether it is known if a node, by its index, can be reached: `false` where the search ended at [`Search::hops_max`] before.
    pub fn searched(&self, index: usize) -> bool {
        self.hops[index] != NOT_SEARCHED
    }

    /// The node before this one on its path from its source (after it, on a return path); `None` for sources and for unreached
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

    /// The nodes of a path of fewest hops between the nearest source and a node, in the order of flight; `None` if no path was found.
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
