//! The names of all limits, and the program's one tolerance.

use std::fmt;

/// A limit that can shape or refuse a hop. Its [`name`](Self::name) is the one that every result uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Limit {
    /// The ground allows nothing in this direction of travel (a chain CSV without the six columns for it, or the chain's end).
    Direction,
    /// The point lies in a keep-out zone.
    KeepOut,
    /// The surface is steeper than the hopper can rest on.
    RestSlope,
    /// A hop is flown in one vertical plane: it spans no bend of the chain. It may begin or end at one.
    Bend,
    /// The take-off direction must lie in the take-off cone of the ground.
    TakeoffCone,
    /// The landing direction must lie in the landing cone of the ground.
    LandingCone,
    /// The actuator: a greatest take-off speed.
    TakeoffSpeed,
    /// Damage: a greatest landing speed.
    LandingSpeed,
    /// The arc must rise above the line of sight from take-off to landing.
    LineOfSight,
    /// The arc must clear every vertex flown past.
    Terrain,
    /// The machine's own least and greatest take-off angle.
    MechanicalAngle,
    /// The machine's greatest apex above the take-off point.
    ApexHeight,
    /// The machine's longest flight.
    FlightTime,
}

impl Limit {
    /// All limits, in the order in which results list them.
    pub const ALL: [Self; 13] = [
        Self::Direction,
        Self::KeepOut,
        Self::RestSlope,
        Self::Bend,
        Self::TakeoffCone,
        Self::LandingCone,
        Self::TakeoffSpeed,
        Self::LandingSpeed,
        Self::LineOfSight,
        Self::Terrain,
        Self::MechanicalAngle,
        Self::ApexHeight,
        Self::FlightTime,
    ];

    /// The name in JSON, CSV and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Direction => "direction",
            Self::KeepOut => "keep-out",
            Self::RestSlope => "rest-slope",
            Self::Bend => "bend",
            Self::TakeoffCone => "takeoff-cone",
            Self::LandingCone => "landing-cone",
            Self::TakeoffSpeed => "takeoff-speed",
            Self::LandingSpeed => "landing-speed",
            Self::LineOfSight => "line-of-sight",
            Self::Terrain => "terrain",
            Self::MechanicalAngle => "mechanical-angle",
            Self::ApexHeight => "apex-height",
            Self::FlightTime => "flight-time",
        }
    }

    /// The place in [`Limit::ALL`], to count by.
    pub const fn index(self) -> usize {
        self as usize
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The program's one tolerance: a speed limit `v` holds as `v (1 + SPEED_TOLERANCE)` (model section 1).
///
/// Larger than the rounding of any formula here (some 1e-15) by far, smaller than any speed sensor by far. Without it a distance of
/// exactly one reach is a hop for one formula and none for another.
pub const SPEED_TOLERANCE: f64 = 1e-9;

/// The speed that a limit really allows: `v (1 + 1e-9)`.
#[inline]
pub fn tolerant_speed_m_s(limit_m_s: f64) -> f64 {
    limit_m_s * (1.0 + SPEED_TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_is_the_place_in_the_list() {
        for (i, limit) in Limit::ALL.iter().enumerate() {
            assert_eq!(limit.index(), i, "{limit} stands elsewhere in Limit::ALL");
        }
    }
}
