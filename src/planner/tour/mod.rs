//! Missions over several targets: the legs between all stops over the same nodes, and the best order of visits.
//!
//! ```text
//!   one field of fewest hops towards every stop      ->  what any path to it takes at least, exactly
//!   one search from stop to stop, led by that field  ->  directed costs of all pairs: A to B is not B to A
//!   the table of Held and Karp over these costs      ->  which targets, in which order, by which legs
//! ```
//!
//! Where another amount than that of the objective has a budget, the best legs alone may keep it. Else a leg has several ways, a Pareto set of
//! those that some mission within the budgets may have, and so has a state of the table.

mod allowance;
mod arrival;
mod legs;
mod order;
mod table;
#[cfg(test)]
mod tests;
mod through;
#[cfg(test)]
mod through_tests;
mod within;

use super::{Amounts, OverBudget, RouteError, RouteGap, RoutePath, RouteQuestion, SurfaceNodes};
use crate::{
    ballistics::TakeoffChoice,
    graph::Effort,
    ground::{DemGround, MapPosition},
    progress::Progress,
    quantity::MapPoint,
};

pub use order::VisitOrder;
pub use table::fewest_hops_of_visits;

/// The most targets: the table has 2^n n states.
pub const TARGETS_MAX: usize = 12;

/// What a mission over targets is searched for.
#[derive(Clone, Copy, Debug)]
pub struct TourQuestion<'a> {
    /// Objective, budgets of the whole mission, commands and errors.
    pub route: RouteQuestion<'a>,
    /// The effort of the cost of a leg.
    pub effort: Effort,
    /// Which of the feasible take-off angles each hop has, where an edge offers no others.
    pub takeoff: TakeoffChoice,
    /// In which order targets are visited.
    pub order: VisitOrder,
    /// Whether the mission ends at its start.
    pub returns: bool,
}

/// A leg of a mission, from one stop to the next: stop 0 is the start, stop k the k-th target.
#[derive(Clone, Debug, PartialEq)]
pub struct TourLeg {
    /// The stop where it begins.
    pub from: usize,
    /// The stop where it ends.
    pub to: usize,
    /// Its hops.
    pub path: RoutePath,
}

/// Why a target is not visited.
#[derive(Clone, Debug, PartialEq)]
pub enum WhyLeftOut {
    /// The start does not reach it over these nodes.
    NotReached {
        /// How many nodes the start reaches, itself included.
        reached: usize,
        /// The reached place nearest to it.
        nearest: MapPosition,
        /// What lies between.
        gap: Box<RouteGap>,
    },
    /// From it the start is not reached, where the mission ends.
    NoWayBack,
    /// No order of legs over these nodes visits it together with those that are visited.
    NotTogether,
    /// Every mission over it and those that are visited is outside the condition of a layer for too long.
    Outages,
    /// The best mission over it and those that are visited takes more than the budgets.
    Budgets(Vec<OverBudget>),
}

/// The work of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TourWork {
    /// Pairs of nodes whose hop was computed.
    pub pairs_tested: u64,
    /// Pairs of stops between which a leg was searched.
    pub legs_searched: usize,
}

/// The best mission over targets.
#[derive(Clone, Debug, PartialEq)]
pub struct Tour {
    /// Its legs in the order of travel; none if no target can be visited.
    pub legs: Vec<TourLeg>,
    /// What it takes.
    pub totals: Amounts,
    /// The targets that it does not visit, by number from 1, ascending.
    pub left_out: Vec<(usize, WhyLeftOut)>,
    /// Whether labels were left out: more targets, or a better mission, may then be possible.
    pub capped: bool,
    /// The work.
    pub work: TourWork,
}

/// Finds the mission from a start that visits the most targets over nodes on a DEM, of those the best by an objective, within budgets.
///
/// # Arguments
/// `stops`: the start, then at most [`TARGETS_MAX`] targets, each another one of the single places of the nodes.
///
/// # Errors
/// [`RouteError`].
///
/// # Complexity
/// For n targets n fields of fewest hops, each 4 bytes a node, one more with a return; and up to n^2 searches led by them, of which as many run
/// at once as there are threads. Where the best legs exceed budgets on other amounts, as many searches for the least of each of these, and
/// searches for Pareto sets for the legs of missions that may keep them.
pub fn tour(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    stops: &[MapPoint],
    question: &TourQuestion<'_>,
    progress: &dyn Progress,
) -> Result<Tour, RouteError> {
    let mut legs = legs::StopLegs::new(ground, nodes, stops, progress)?;
    loop {
        let (tour, hops) = legs.best(question)?;
        // The fast walk equals the slice up to rounding: a hop on the very edge of a limit may be one for the walk alone.
        if !legs.refuse_wrong(hops) {
            return Ok(tour);
        }
    }
}
