//! The costs-to-go of the posts of a map, by which a robot replans over it.

use super::{Cost, Effort};
use crate::{
    ballistics::TakeoffChoice,
    ground::{MapError, NodeLattice, Post},
};

/// The mark of a post from which the goal cannot be reached.
const UNREACHED: u16 = u16::MAX;

/// The cost of the cheapest path from every post of a map to one goal: the fewest hops, then the least effort.
///
/// [`reach::map::costs_to_go`](crate::reach::map::costs_to_go) finds them, by a search against the direction of the hops.
///
/// # Complexity
/// 10 bytes for each post.
#[derive(Clone, Debug)]
pub struct PostCosts {
    lattice: NodeLattice,
    /// For each post its hops, [`u16::MAX`] where the goal cannot be reached from it.
    hops: Vec<u16>,
    /// For each post the least effort among its paths of fewest hops; NaN where the goal cannot be reached from it.
    efforts: Vec<f64>,
    effort: Effort,
    takeoff: TakeoffChoice,
}

impl PostCosts {
    /// Costs in these labels of the posts of a ground, row after row.
    ///
    /// # Errors
    /// [`MapError::Request`] if there is not one label of each kind for every post.
    pub(crate) fn new(
        lattice: NodeLattice,
        (hops, efforts): (Vec<i16>, Vec<f64>),
        (effort, takeoff): (Effort, TakeoffChoice),
    ) -> Result<Self, MapError> {
        if [hops.len(), efforts.len()] != [lattice.count(); 2] {
            return Err(MapError::Request {
                what: "the costs-to-go",
                found: format!("{} counts of hops and {} efforts", hops.len(), efforts.len()),
                expected: "one of each for every post of the map",
            });
        }
        let hops = hops.into_iter().map(|hops| u16::try_from(hops).unwrap_or(UNREACHED)).collect();
        Ok(Self { lattice, hops, efforts, effort, takeoff })
    }

    /// The posts.
    pub const fn lattice(&self) -> NodeLattice {
        self.lattice
    }

    /// The effort of the costs.
    pub const fn effort(&self) -> Effort {
        self.effort
    }

    /// The choice of take-offs.
    pub const fn takeoff(&self) -> TakeoffChoice {
        self.takeoff
    }

    /// The fewest hops from a post to the goal; `None` if it cannot be reached.
    ///
    /// # Panics
    /// Panics if there is no such post.
    #[inline]
    pub fn hops_from(&self, post: Post) -> Option<u16> {
        let hops = self.hops[self.lattice.index(post)];
        (hops != UNREACHED).then_some(hops)
    }

    /// The cost-to-go of a post: zero at the goal, `None` if the goal cannot be reached from it.
    ///
    /// # Panics
    /// Panics if there is no such post.
    pub fn of_post(&self, post: Post) -> Option<Cost> {
        let hops = self.hops_from(post)?;
        Some(self.effort.cost_of_path(hops.into(), self.efforts[self.lattice.index(post)]))
    }
}
