//! `[derating]`: shares of the limits that planning may use.

use super::{Entries, ProblemKind, Scenario};
use crate::world::{Derating, Grip, Hopper, InvalidHopper, SurfaceProperties};

/// The shares as given, each 1 where absent, once they leave the hopper what its other limits want.
pub(super) fn derating(entries: &mut Entries, hopper: &Hopper, surface: &SurfaceProperties) -> Derating {
    let share = |name| entries.number("derating", name).unwrap_or(1.0);
    let derating =
        Derating { takeoff_speed: share("takeoff_speed"), landing_speed: share("landing_speed"), friction: share("friction") };
    if let (Some(Grip::FromSlope { .. }), true) = (surface.grip, derating.friction != 1.0) {
        let message = format!(
            "derating.friction is {}, but surface gives angles from the slope, which no friction decides",
            derating.friction
        );
        let help = "remove derating.friction, and give narrower angles for planning";
        entries.problem(("derating", "friction"), ProblemKind::Conflict, message, help);
    }
    if let Err(InvalidHopper(problems)) = derating.hopper(hopper) {
        for problem in problems {
            let name = if problem.key.starts_with("takeoff") { "takeoff_speed" } else { "landing_speed" };
            let share = if name == "takeoff_speed" { derating.takeoff_speed } else { derating.landing_speed };
            let message = format!("derating.{name} of {share} leaves too little of the limit for planning: {problem}");
            let help = "raise the share, or the limit that it is a share of, or change that key";
            entries.problem(("derating", name), ProblemKind::Conflict, message, help);
        }
        return Derating::NONE;
    }
    derating
}

impl Scenario {
    /// The scenario whose limits are those that planning may use; `None` where planning may use the whole limits. What a chain states of
    /// its segments is derated by [`PolygonalChain::derated`](crate::chain::PolygonalChain::derated).
    pub fn derated(&self) -> Option<Self> {
        if self.derating.is_none() {
            return None;
        }
        // The reader has refused shares that leave no hopper.
        let hopper = self.derating.hopper(&self.hopper).ok()?;
        Some(Self { hopper, surface: self.derating.surface(&self.surface), ..self.clone() })
    }
}
