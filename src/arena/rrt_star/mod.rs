//! RRT* by the rules of the paper on the Jumping Sumo.
//!
//! ```text
//!     : - - - - - - :       ring   no node is within ring_m of a face, on either side
//!     : # # # # # # :       jump   up over one face, at most jump_edge_max_m long; it takes its length at the driving
//!     : #  . _ .  # :              speed and the time of a jump
//!     : # /     \ # :       drop   down over faces, as long at most
//!     :.#/_ _ _ # # :       goal   every seventh sample or so, until it is reached
//! ```
//!
//! Beyond the paper: samples beside faces, without which the thin places where jumps begin and end are seldom found; after the first path samples
//! from the ellipse that a better path must lie in (informed RRT*); a radius of neighbours that shrinks with the nodes; and turning, if the
//! robot has a price for it. The paper has none: a robot with `turn_s_per_rad` 0 is planned by its rules.

mod buckets;
mod sample;
mod space;
mod tree;

use rand::{SeedableRng, rngs::ChaCha8Rng};

pub use self::tree::{Joined, TreeNode};
use self::{buckets::Buckets, sample::Sampler, space::Space, tree::Tree};
use super::{Arena, ArenaPath, Reading, Refusal, Tariff};

/// How RRT* grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RrtStarOptions {
    /// The nodes that it ends with.
    pub nodes: usize,
    /// The seed of its samples.
    pub seed: u64,
    /// How far a new node is from the tree at most, m.
    pub step_m: f64,
    /// How far its neighbours are at most, m.
    pub radius_m: f64,
    /// The share of samples that are the goal until it is reached.
    pub goal_share: f64,
    /// The share of samples beside faces that can be jumped.
    pub face_share: f64,
}

impl Default for RrtStarOptions {
    /// The nodes and the share of the paper, which states neither step nor radius; these two gave the shortest paths.
    fn default() -> Self {
        Self { nodes: 3_000, seed: 1, step_m: 1.0, radius_m: 2.0, goal_share: 0.15, face_share: 0.2 }
    }
}

/// After how many nodes each the time of the path is recorded, as in the paper.
pub const HISTORY_NODES: usize = 50;

/// Samples for each node at most: where most are refused the tree ends with fewer nodes.
const SAMPLES_PER_NODE: usize = 40;

/// A grown tree.
#[derive(Clone, Debug, PartialEq)]
pub struct GrownTree {
    /// The best path; `None`: the goal was not reached with these nodes.
    pub path: Option<ArenaPath>,
    /// The nodes, the start first.
    pub nodes: Vec<TreeNode>,
    /// The time of the path after every [`HISTORY_NODES`] nodes, s; `None`: none yet.
    pub history: Vec<(usize, Option<f64>)>,
}

/// Grows a tree from the start, and improves the path to the goal until it has so many nodes. The same seed gives the same tree.
///
/// # Errors
/// A start or goal within the ring of a face.
pub fn grow_rrt_star(arena: &Arena, options: &RrtStarOptions, may_jump: bool) -> Result<GrownTree, Refusal> {
    arena.refuse_flight_that_weakens()?;
    let space = Space::new(arena, may_jump);
    for (key, end) in [("start_m", arena.start()), ("goal_m", arena.goal())] {
        if space.height_m(end).is_none() {
            return Err(Refusal::WithinRing { key, ring_m: arena.jumper().ring_m });
        }
    }
    let tariff = Tariff::of(arena.jumper(), Reading::R0);
    let mut sampler = Sampler::new(arena, &space, options, ChaCha8Rng::seed_from_u64(options.seed));
    let mut tree = Tree::new(arena, tariff, &space);
    let mut buckets = Buckets::new(arena.size_m(), options.step_m);
    buckets.add(0, arena.start());
    let mut history = Vec::new();
    let mut near = Vec::new();
    for _ in 0..options.nodes.saturating_mul(SAMPLES_PER_NODE) {
        if tree.len() >= options.nodes {
            break;
        }
        let Some(sample) = sampler.next(tree.best_s()) else { continue };
        let nearest = buckets.nearest(sample);
        let from = tree.point(nearest);
        let distance_m = (sample - from).norm();
        if distance_m <= 1e-9 {
            continue;
        }
        let point = from + (sample - from) * (options.step_m / distance_m).min(1.0);
        let Some(z_m) = space.height_m(point) else { continue };
        let radius_m = sampler.radius_m(tree.len(), tree.best_s());
        buckets.within(point, radius_m.max((point - from).norm() + 1e-9), &mut near);
        let Some(node) = tree.add((point, z_m), nearest, &near) else { continue };
        buckets.add(node, point);
        tree.rewire(node, &near);
        if let Some(goal) = tree.try_goal(node, options.radius_m) {
            buckets.add(goal, arena.goal());
        }
        tree.record();
        if tree.len().is_multiple_of(HISTORY_NODES) {
            history.push((tree.len(), tree.best_s()));
        }
    }
    Ok(GrownTree { path: tree.best_path(), nodes: tree.into_nodes(), history })
}
