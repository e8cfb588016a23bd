//! The data of these pictures.

use super::super::Caption;
use crate::quantity::ChainPoint;

/// A flight in the plane of a chain: the parabola from one point to another with a given take-off slope.
///
/// ```text
///            . - .
///         /         \          z(s) = Z s + t X s (1 - s), x(s) = X s,  0 <= s <= 1,
///   from o            o to     X = |to.x - from.x|, Z = to.z - from.z, t = takeoff_slope - Z / X
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Take-off.
    pub from: ChainPoint,
    /// First contact with the ground, or landing.
    pub to: ChainPoint,
    /// Tangent of the take-off angle in the direction of travel (rise over horizontal distance travelled).
    pub takeoff_slope: f64,
}

/// The proved class of a stretch of chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ProofClass {
    /// A path to it exists.
    Reachable,
    /// No path to it exists, at any resolution.
    Unreachable,
    /// Neither is known.
    Open,
}

/// A stretch of chain of one class; with zero length it is a single point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProofStretch {
    /// Its left end, m.
    pub from_x_m: f64,
    /// Its right end, m.
    pub to_x_m: f64,
    /// Its class.
    pub class: ProofClass,
}

/// The gap that stops a journey.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProofGap {
    /// The farthest point that may be reached from the start, m.
    pub reached_x_m: f64,
    /// The point nearest to the start from which the goal may be reached, m.
    pub leads_to_goal_x_m: f64,
    /// The limits that refuse in between with their counts, in descending order.
    pub refusals: Vec<(String, u64)>,
}

/// A proof along a chain.
#[derive(Clone, Debug, PartialEq)]
pub struct ProofFigure {
    /// The caption.
    pub caption: Caption,
    /// The ground, from left to right.
    pub ground: Vec<ChainPoint>,
    /// Its proved stretches; ground outside any stretch is drawn bare.
    pub stretches: Vec<ProofStretch>,
    /// Boundaries of the cells, m; drawn if they are few enough to be distinguished.
    pub cell_boundaries_x_m: Vec<f64>,
    /// Where the journey begins.
    pub start: ChainPoint,
    /// Where it should end.
    pub goal: ChainPoint,
    /// The path behind the upper bound, if any.
    pub path: Vec<Flight>,
    /// No path has fewer hops; `None` if it is proved that there is no path.
    pub lower_bound: Option<u64>,
    /// Hops of the best known path.
    pub upper_bound: Option<u64>,
    /// The final number of cells.
    pub cells: u64,
    /// The gap that stops the journey, if any.
    pub gap: Option<ProofGap>,
}

/// One capability of a trade.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TradeAxis {
    /// What is varied, in words and with its unit, such as `greatest take-off speed (m/s)`.
    pub name: String,
    /// The values, in ascending order.
    pub values: Vec<f64>,
}

/// One cell of a trade.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TradeCell {
    /// A path with this number of hops.
    Hops(u64),
    /// No path, proved.
    Untraversable,
    /// No path found, but not excluded either.
    Open,
    /// No answer.
    Failed,
}

/// Hops over one or two capabilities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TradeFigure {
    /// The caption.
    pub caption: Caption,
    /// Varied along the horizontal axis.
    pub x: TradeAxis,
    /// Varied along the vertical axis; `None`: a single row.
    pub y: Option<TradeAxis>,
    /// The cells: for the first value of `y` every value of `x`, then for the second, and so on.
    pub cells: Vec<TradeCell>,
}

/// One of several scenarios.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedScenario {
    /// Its name.
    pub name: String,
    /// Its verdict, such as `traversable`.
    pub verdict: String,
    /// Its number of hops, if there is a path.
    pub hops: Option<u64>,
    /// Its ground, from left to right.
    pub ground: Vec<ChainPoint>,
    /// Where it begins.
    pub start: ChainPoint,
    /// Where it should end.
    pub goal: ChainPoint,
    /// Its path.
    pub flights: Vec<Flight>,
}

/// Several scenarios: with their paths overlaid on a common ground, otherwise each in a panel of its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CompareFigure {
    /// The caption.
    pub caption: Caption,
    /// The scenarios.
    pub scenarios: Vec<ComparedScenario>,
}
