//! Bounds on the fewest hops that hold for every choice of points: a path that exists, and a proof that none is shorter, or that there
//! is none at all.
//!
//! Discretising can only miss paths, so the hops of a path found bound the fewest from above, and a failure proves nothing. A lower
//! bound needs no points (model section 5): the chain is cut into cells, every vertex by itself, and a cell sees another unless interval
//! arithmetic rules out every hop between any of their points. A breadth-first search over this over-estimating graph bounds the fewest
//! hops from below; where it does not come to the goal, no path exists.
//!
//! ```text
//!      vertex   stretch     vertex  stretch  vertex             may-hop: not ruled out by intervals
//!        o----[=========]-----o----[======]----o                 every real hop is one, not every one is real
//!        |         \__________________/                          split the cells on shortest may-paths,
//!      start         may-hop                  goal               until both bounds meet
//! ```
//!
//! Cells on shortest may-paths are split until the bounds meet, the goal is cut off, or the budget of cells ends. Hops of any length are
//! covered, down to zero, across a vertex and within one cell (which never shortens a may-path). All limits are relaxed by more than the
//! program's tolerance and all rounding goes outwards, so nothing that the search or the checker calls a hop is refused here.

mod arcs;
mod bounds;
mod cell;
mod depths;
mod gap;
mod may;
mod points;
mod refine;
mod require;

pub(crate) use bounds::bounds_of;
pub use bounds::{Bounds, BoundsOptions, DEFAULT_BUDGET_CELLS, ProofSummary, ProofVerdict, Until, bounds};
pub use gap::{Gap, Stretch, StretchClass};
use may::Prover;
pub use require::{CapabilityRange, Threshold, least_capability};

use crate::quantity::{Outwards, Rounding};

/// What a proof may be made to do wrong, to see that the tests notice: all of it is fixed at compile time, and only tests can choose
/// anything but [`Sound`].
trait Faults: std::fmt::Debug + Send + Sync + 'static {
    /// How ends are rounded.
    type Rounding: Rounding;
    /// Whether vertices have no cells of their own.
    const DROPS_VERTICES: bool = false;
    /// Whether hops towards -x are forgotten.
    const FORGETS_REVERSE: bool = false;
    /// The share of every tolerance that is given away: all of it.
    const SLACK: f64 = 1.0;
}

/// No faults.
#[derive(Clone, Copy, Debug)]
struct Sound;

impl Faults for Sound {
    type Rounding = Outwards;
}

#[cfg(test)]
mod tests;
