//! Bounds on the fewest hops that hold for every choice of points: a path, and a proof that no path is shorter, or that there
//! is no path.
//!
//! A discretisation can only miss paths, so the hops of a path found are an upper bound, while a failure proves nothing. A
//! lower bound must hold for all points (model section 5). The chain is divided into cells, with every vertex a cell of its
//! own, and two cells are joined by a may-hop unless interval arithmetic excludes every hop between any of their points. This
//! graph contains every real hop, so a breadth-first search over it bounds the fewest hops from below. If the search does not
//! reach the goal, no path exists.
//!
//! ```text
//!      vertex   stretch     vertex  stretch  vertex             may-hop: not ruled out by intervals
//!        o----[=========]-----o----[======]----o                 every real hop is one, not every one is real
//!        |         \__________________/                          split the cells on shortest may-paths,
//!      start         may-hop                  goal               until both bounds meet
//! ```
//!
//! Cells on shortest may-paths are split until the bounds meet, the goal is proved unreachable, or the budget of cells ends.
//! The proof covers hops of any length down to zero, across a vertex and within one cell (a hop within a cell never shortens
//! a may-path). All limits are relaxed by more than the program's tolerance and all rounding is outwards, so no hop accepted
//! by the search or the checker is refused here.

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

/// Faults that tests can plant in a proof, to see that the checks detect them. They are fixed at compile time, and only tests
/// can choose anything but [`Sound`].
trait Faults: std::fmt::Debug + Send + Sync + 'static {
    /// How ends are rounded.
    type Rounding: Rounding;
    /// Whether vertices have no cells of their own.
    const DROPS_VERTICES: bool = false;
    /// Whether hops towards -x are ignored.
    const FORGETS_REVERSE: bool = false;
    /// The fraction of every tolerance by which limits are relaxed.
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
