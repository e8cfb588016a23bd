//! What these pictures show, as plain data.

use super::super::Caption;
use crate::quantity::ChainPoint;

/// A flight in the plane of a chain: the parabola from one point to another with a slope of take-off.
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
    /// Tangent of the take-off angle as the traveller sees it (rise over distance gone, whichever direction that is).
    pub takeoff_slope: f64,
}

/// What is proved of a stretch of chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ProofClass {
    /// A path to it exists.
    Reachable,
    /// No path to it exists, at any resolution.
    Unreachable,
    /// Neither is known yet.
    Open,
}

/// A stretch of chain of one class; of zero length it is a single point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProofStretch {
    /// Where it begins, m.
    pub from_x_m: f64,
    /// Where it ends, m.
    pub to_x_m: f64,
    /// What is proved.
    pub class: ProofClass,
}

/// The gap that stops a journey.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProofGap {
    /// The farthest that one gets from the start, m.
    pub reached_x_m: f64,
    /// The nearest from where the goal could be reached, m.
    pub leads_to_goal_x_m: f64,
    /// Which limits refuse in between, counted, most first.
    pub refusals: Vec<(String, u64)>,
}

/// A proof along a chain.
#[derive(Clone, Debug, PartialEq)]
pub struct ProofFigure {
    /// The words above.
    pub caption: Caption,
    /// The ground, from left to right.
    pub ground: Vec<ChainPoint>,
    /// What is proved of it; what no stretch covers is drawn as bare ground.
    pub stretches: Vec<ProofStretch>,
    /// Boundaries of the cells, m; drawn where they are few enough to be told apart.
    pub cell_boundaries_x_m: Vec<f64>,
    /// Where the journey begins.
    pub start: ChainPoint,
    /// Where it should end.
    pub goal: ChainPoint,
    /// The path behind the upper bound, where there is one.
    pub path: Vec<Flight>,
    /// No path has fewer hops; `None` where it is proved that there is none at all.
    pub lower_bound: Option<u64>,
    /// Hops of the best path known.
    pub upper_bound: Option<u64>,
    /// Cells at the end.
    pub cells: u64,
    /// What stops the journey, where something does.
    pub gap: Option<ProofGap>,
}

/// One capability of a trade.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TradeAxis {
    /// What is varied, with its unit, such as `hopper.takeoff_speed_max_m_s (m/s)`.
    pub name: String,
    /// The values, rising.
    pub values: Vec<f64>,
}

/// One cell of a trade.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TradeCell {
    /// A path with so many hops.
    Hops(u64),
    /// Proved: no path.
    Untraversable,
    /// No path found, and none excluded.
    Open,
}

/// Hops over one or two capabilities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TradeFigure {
    /// The words above.
    pub caption: Caption,
    /// Varied along the horizontal axis.
    pub x: TradeAxis,
    /// Varied along the vertical axis; `None`: a single row.
    pub y: Option<TradeAxis>,
    /// The fields: for the first value of `y` every value of `x`, then for the second, and so on.
    pub cells: Vec<TradeCell>,
}

/// One of several scenarios.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedScenario {
    /// Its name.
    pub name: String,
    /// What came of it, such as `traversable`.
    pub verdict: String,
    /// Its hops, where there is a path.
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

/// Several scenarios, their paths overlaid. On one common ground they are drawn where they are; on several, each from its own start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CompareFigure {
    /// The words above.
    pub caption: Caption,
    /// The scenarios.
    pub scenarios: Vec<ComparedScenario>,
}
