//! What is asked of a map.

use std::path::Path;

use crate::{planner::Amount, scenario::Scenario, terrain::MapPlace};

/// A position, and what the caller calls it in messages: a key, an option, or a line of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPlace {
    /// Its name, such as `terrain.start_m`.
    pub name: String,
    /// The position.
    pub place: MapPlace,
}

/// A question about the hops from some starts to all posts of a DEM.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is one more map or answer that is asked for")]
pub struct MapQuestion<'a> {
    /// The hopper, its body, its ground and the search; the terrain in it is ignored.
    pub scenario: &'a Scenario,
    /// The folder that the scenario's paths start from.
    pub base: &'a Path,
    /// The DEM's file.
    pub dem: &'a Path,
    /// The starts, at least one unless sites are ranked or single hops are asked for. A post is reached from the nearest of them.
    pub starts: Vec<NamedPlace>,
    /// The goals, whose paths are planned and flown again.
    pub goals: Vec<NamedPlace>,
    /// Every `stride`-th post is a node of the map; 0 counts as 1. With a stride, `search.node_spacing_max_m` has no effect.
    pub stride: usize,
    /// One hop over level ground spans 8 nodes or more, in place of `search.node_spacing_max_m`.
    pub auto_nodes: bool,
    /// Also the least effort, as the scenario names it, among paths of fewest hops.
    pub effort: bool,
    /// Also the fewest hops back to the nearest start.
    pub returns: bool,
    /// Also the single hops from every post.
    pub mobility: bool,
    /// Whether the question is about landing sites, each of which is a start by itself.
    pub ranks_sites: bool,
    /// Also the post that the last hop to each post comes from.
    pub predecessors: bool,
    /// Also the nodes that refuse every contact, by reason.
    pub refusals: bool,
    /// Also trials along the path to every goal.
    pub trials: bool,
    /// Posts that need more hops are not searched; as a budget of hops.
    pub hops_max: Option<i16>,
    /// Also the totals of these amounts along the path to every node.
    pub amounts: Vec<Amount>,
    /// The most memory, bytes, that the map may need.
    pub memory_max_bytes: Option<u64>,
}
