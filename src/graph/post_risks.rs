//! The risks-to-go of the posts of a map, by which a robot replans over it.

use super::MapJudge;
use crate::ground::{NodeLattice, Post};

/// The weight of the most reliable path from every post of a map to one goal: for every hop `-ln` of the estimated probability that it
/// succeeds, and a weight of its own.
///
/// [`reach::map::risks_to_go`](crate::reach::map::risks_to_go) finds them.
///
/// # Complexity
/// 8 bytes for each post.
#[derive(Clone, Debug)]
pub struct PostRisks {
    lattice: NodeLattice,
    /// For each post its weight; infinite where the goal cannot be reached from it.
    weights: Vec<f64>,
    judge: MapJudge,
}

impl PostRisks {
    /// Of these weights of the posts, row after row.
    pub(crate) fn new(lattice: NodeLattice, weights: Vec<f64>, judge: MapJudge) -> Self {
        Self { lattice, weights, judge }
    }

    /// The posts.
    pub const fn lattice(&self) -> NodeLattice {
        self.lattice
    }

    /// The judge of hops.
    pub(crate) const fn judge(&self) -> &MapJudge {
        &self.judge
    }

    /// The weight of the most reliable path from a post to the goal: zero at the goal, infinite if it cannot be reached.
    ///
    /// # Panics
    /// Panics if there is no such post.
    #[inline]
    pub fn of_post(&self, post: Post) -> f64 {
        self.weights[self.lattice.index(post)]
    }
}
