//! The names of all limits, and the program's only tolerance.

use std::{borrow::Cow, fmt};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use super::LayerName;

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
    /// Of a robot with legs: the force of a straight push over its stroke must lie in the cone of its feet, at a landing backwards.
    Stroke,
    /// Of a robot with legs: no foot bears more than its greatest force.
    Force,
    /// Of a robot with legs: the push leaves no more angular momentum than its greatest rate of rotation.
    Spin,
    /// A layer of the scenario does not hold at a contact or under the flight.
    Layer(LayerName),
}

impl Limit {
    /// All limits but layers, which follow them, in the order in which results list them.
    pub const ALL: [Self; 24] = [
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
        Self::Stroke,
        Self::Force,
        Self::Spin,
    ];

    /// The name used in JSON, CSV and messages; that of a layer begins with `layer:`.
    pub const fn name(self) -> &'static str {
        self.row().1
    }

    /// The index in [`Limit::ALL`], for arrays of counts; that of every layer is the length of the list.
    pub const fn index(self) -> usize {
        self.row().0
    }

    /// Index and name.
    const fn row(self) -> (usize, &'static str) {
        match self {
            Self::Direction => (0, "direction"),
            Self::KeepOut => (1, "keep-out"),
            Self::RestSlope => (2, "rest-slope"),
            Self::FootprintSlope => (3, "footprint-slope"),
            Self::Roughness => (4, "roughness"),
            Self::Bend => (5, "bend"),
            Self::TakeoffCone => (6, "takeoff-cone"),
            Self::LandingCone => (7, "landing-cone"),
            Self::TakeoffSpeed => (8, "takeoff-speed"),
            Self::LandingSpeed => (9, "landing-speed"),
            Self::Touchdown => (10, "touchdown"),
            Self::LineOfSight => (11, "line-of-sight"),
            Self::Terrain => (12, "terrain"),
            Self::MechanicalAngle => (13, "mechanical-angle"),
            Self::ApexHeight => (14, "apex-height"),
            Self::FlightTime => (15, "flight-time"),
            Self::TakeoffSpeedMin => (16, "takeoff-speed-min"),
            Self::TakeoffSpeedLevels => (17, "takeoff-speed-levels"),
            Self::TakeoffAngleStep => (18, "takeoff-angle-step"),
            Self::TakeoffSpeedStep => (19, "takeoff-speed-step"),
            Self::HeadingStep => (20, "heading-step"),
            Self::Stroke => (21, "stroke"),
            Self::Force => (22, "force"),
            Self::Spin => (23, "spin"),
            Self::Layer(layer) => (Self::ALL.len(), layer.as_limit()),
        }
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl Serialize for Limit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Limit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = Cow::<str>::deserialize(deserializer)?;
        let known = Self::ALL.into_iter().find(|limit| limit.name() == text);
        let found = known.or_else(|| text.strip_prefix(LayerName::PREFIX).and_then(LayerName::new).map(Self::Layer));
        found.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            D::Error::custom(format!("found \"{text}\", expected one of {names}, or {}NAME", LayerName::PREFIX))
        })
    }
}

impl JsonSchema for Limit {
    fn schema_name() -> Cow<'static, str> {
        "Limit".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "anyOf": [{ "enum": Self::ALL.map(Self::name) }, { "pattern": LayerName::LIMIT_PATTERN }] })
    }
}

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

    #[test]
    fn a_limit_reads_back_by_its_name() {
        let sun = Limit::Layer(LayerName::new("sun").unwrap());
        for limit in Limit::ALL.into_iter().chain([sun]) {
            let text = serde_json::to_string(&limit).unwrap();
            assert_eq!(serde_json::from_str::<Limit>(&text).unwrap(), limit, "{text}");
        }
        assert_eq!(sun.to_string(), "layer:sun");
        for wrong in ["\"layer:\"", "\"layer:a b\"", "\"sun\""] {
            let message = serde_json::from_str::<Limit>(wrong).unwrap_err().to_string();
            assert!(message.contains("keep-out") && message.contains("layer:NAME"), "{message}");
        }
    }
}
