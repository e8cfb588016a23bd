//! The names of all limits, and the program's only tolerance.

/// A limit that can restrict or refuse a hop. All results use its [`name`](Self::name).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Limit {
    /// The ground allows no contact in this direction of travel (a chain CSV without the six columns for it, or the chain's
    /// end).
    Direction,
    /// The point lies in a keep-out zone.
    KeepOut,
    /// The surface is steeper than the hopper's rest slope.
    RestSlope,
    /// The plane fitted over the hopper's footprint is steeper than the rest slope, or the ground under the footprint is not known.
    FootprintSlope,
    /// The ground under the hopper's footprint deviates from the plane fitted over it by more than the limit.
    Roughness,
    /// A hop is flown in one vertical plane, so it may not span a bend of the chain. It may begin or end at one.
    Bend,
    /// The take-off direction must lie in the take-off cone of the ground.
    TakeoffCone,
    /// The landing direction must lie in the landing cone of the ground.
    LandingCone,
    /// Take-off speed: limit of the actuator.
    TakeoffSpeed,
    /// Landing speed: limit of the structure.
    LandingSpeed,
    /// With brakes: the touchdown straight down must lie in the landing cone of the ground and be no faster than a landing may be.
    Touchdown,
    /// The arc must rise above the line of sight from take-off to landing.
    LineOfSight,
    /// The arc must clear every vertex flown over.
    Terrain,
    /// The least and greatest take-off angle of the mechanism.
    MechanicalAngle,
    /// The hopper's greatest apex height above the take-off point.
    ApexHeight,
    /// The hopper's longest flight time.
    FlightTime,
    /// The least take-off speed that the machine can be commanded.
    TakeoffSpeedMin,
    /// The only take-off speeds that the machine can be commanded.
    TakeoffSpeedLevels,
    /// The take-off angle is a whole number of the machine's steps.
    TakeoffAngleStep,
    /// The take-off speed is a whole number of the machine's steps.
    TakeoffSpeedStep,
    /// The heading is a whole number of the machine's steps.
    HeadingStep,
}

impl Limit {
    /// All limits, in the order in which results list them.
    pub const ALL: [Self; 21] = [
        Self::Direction,
        Self::KeepOut,
        Self::RestSlope,
        Self::FootprintSlope,
        Self::Roughness,
        Self::Bend,
        Self::TakeoffCone,
        Self::LandingCone,
        Self::TakeoffSpeed,
        Self::LandingSpeed,
        Self::Touchdown,
        Self::LineOfSight,
        Self::Terrain,
        Self::MechanicalAngle,
        Self::ApexHeight,
        Self::FlightTime,
        Self::TakeoffSpeedMin,
        Self::TakeoffSpeedLevels,
        Self::TakeoffAngleStep,
        Self::TakeoffSpeedStep,
        Self::HeadingStep,
    ];

    /// The name used in JSON, CSV and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Direction => "direction",
            Self::KeepOut => "keep-out",
            Self::RestSlope => "rest-slope",
            Self::FootprintSlope => "footprint-slope",
            Self::Roughness => "roughness",
            Self::Bend => "bend",
            Self::TakeoffCone => "takeoff-cone",
            Self::LandingCone => "landing-cone",
            Self::TakeoffSpeed => "takeoff-speed",
            Self::LandingSpeed => "landing-speed",
            Self::Touchdown => "touchdown",
            Self::LineOfSight => "line-of-sight",
            Self::Terrain => "terrain",
            Self::MechanicalAngle => "mechanical-angle",
            Self::ApexHeight => "apex-height",
            Self::FlightTime => "flight-time",
            Self::TakeoffSpeedMin => "takeoff-speed-min",
            Self::TakeoffSpeedLevels => "takeoff-speed-levels",
            Self::TakeoffAngleStep => "takeoff-angle-step",
            Self::TakeoffSpeedStep => "takeoff-speed-step",
            Self::HeadingStep => "heading-step",
        }
    }

    /// The index in [`Limit::ALL`], for arrays of counts.
    pub const fn index(self) -> usize {
        self as usize
    }
}

crate::quantity::by_name!(Limit, Limit::ALL);

/// The program's only tolerance: a speed limit `v` is applied as `v (1 + SPEED_TOLERANCE)` (model section 1).
///
/// It is far larger than the rounding errors of the formulas here (some 1e-15) and far smaller than the error of any speed
/// sensor. Without it, a hop over exactly the greatest reach would be feasible by one formula and infeasible by another.
pub const SPEED_TOLERANCE: f64 = 1e-9;

/// The speed limit as applied, `v (1 + 1e-9)`.
///
/// ```
/// assert_eq!(chta::world::tolerant_speed_m_s(2.0), 2.000_000_002);
/// ```
#[inline]
pub fn tolerant_speed_m_s(limit_m_s: f64) -> f64 {
    limit_m_s * (1.0 + SPEED_TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_is_the_position_in_the_list() {
        for (i, limit) in Limit::ALL.iter().enumerate() {
            assert_eq!(limit.index(), i, "{limit} has another index in Limit::ALL");
        }
    }
}
