//! The data of a proof's picture, from the bounds and the chain.

use super::{
    super::{Caption, limits},
    Flight, ProofClass, ProofFigure, ProofGap, ProofStretch,
};
use crate::{
    chain::{PolygonalChain, Station},
    graph::proof::{Bounds, Gap, Stretch, StretchClass},
    path::{Hop, HopPath},
};

impl From<&Hop> for Flight {
    fn from(hop: &Hop) -> Self {
        let (from, to) = (hop.takeoff.in_profile(), hop.landing.in_profile());
        // A hop beside its line is drawn projected on its plane: as high, and shorter.
        let stretch = if hop.is_beside_line() { hop.run_m() / (to.x_m - from.x_m).abs() } else { 1.0 };
        Self { from, to, takeoff_slope: hop.takeoff_angle.slope() * stretch }
    }
}

impl From<StretchClass> for ProofClass {
    fn from(class: StretchClass) -> Self {
        match class {
            StretchClass::Reachable => Self::Reachable,
            StretchClass::Unreachable => Self::Unreachable,
            StretchClass::Open => Self::Open,
        }
    }
}

impl From<&Gap> for ProofGap {
    fn from(gap: &Gap) -> Self {
        let refusals = gap.refusals.ranked().into_iter().map(|(limit, count)| (limits::words(limit), count)).collect();
        Self { reached_x_m: gap.reached_x_m, leads_to_goal_x_m: gap.leads_to_goal_x_m, refusals }
    }
}

impl ProofFigure {
    /// The figure of explained bounds, with the best known path if it is to be drawn.
    pub fn of(
        caption: Caption,
        chain: &PolygonalChain,
        (start, goal): (Station, Station),
        bounds: &Bounds,
        path: Option<&HopPath>,
    ) -> Self {
        let stretch = |s: &Stretch| ProofStretch { from_x_m: s.from_x_m, to_x_m: s.to_x_m, class: s.class.into() };
        Self {
            caption,
            ground: chain.vertices().to_vec(),
            stretches: bounds.stretches.iter().map(stretch).collect(),
            cell_boundaries_x_m: bounds.stretches.iter().skip(1).map(|s| s.from_x_m).collect(),
            start: start.point,
            goal: goal.point,
            path: path.iter().flat_map(|path| &path.hops).map(Flight::from).collect(),
            lower_bound: bounds.lower,
            upper_bound: bounds.upper(),
            cells: u64::try_from(bounds.summary.cells).unwrap_or(u64::MAX),
            gap: bounds.gap.as_ref().map(ProofGap::from),
        }
    }
}
