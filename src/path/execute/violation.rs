//! What the checker finds wrong with a hop.

use std::fmt;

use crate::{quantity::VertexId, world::Limit};

/// A number written in a [`Hop`](crate::path::Hop) that the checker finds by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StatedValue {
    /// The direction of travel.
    Direction,
    /// The take-off station: its site and height on the chain.
    TakeoffStation,
    /// The landing station: its site and height on the chain.
    LandingStation,
    /// Take-off angle.
    TakeoffAngle,
    /// Take-off speed.
    TakeoffSpeed,
    /// Landing angle.
    LandingAngle,
    /// Landing speed.
    LandingSpeed,
    /// Flight time.
    FlightTime,
    /// Height of the highest point.
    Apex,
    /// The smaller margin of the two speeds.
    SpeedMargin,
    /// The two ends on the map.
    MapEnds,
    /// The heading on the map.
    Heading,
    /// The distance along the path.
    Distance,
}

impl StatedValue {
    /// The name in messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Direction => "direction",
            Self::TakeoffStation => "takeoff station",
            Self::LandingStation => "landing station",
            Self::TakeoffAngle => "takeoff angle",
            Self::TakeoffSpeed => "takeoff speed",
            Self::LandingAngle => "landing angle",
            Self::LandingSpeed => "landing speed",
            Self::FlightTime => "flight time",
            Self::Apex => "apex",
            Self::SpeedMargin => "speed margin",
            Self::MapEnds => "map ends",
            Self::Heading => "heading",
            Self::Distance => "distance",
        }
    }
}

/// What a hop offends against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ViolatedLimit {
    /// A limit of ground or machine.
    Limit(Limit),
    /// The hop comes down elsewhere than planned.
    LandingPoint,
    /// The hop flies over ground that is not known.
    UnknownGround,
    /// The hop does not begin where the one before (or the journey) says, or the last does not end at the goal.
    Continuity,
    /// A number of the plan is not the one flown, or is none at all.
    StatedValue(StatedValue),
}

impl fmt::Display for ViolatedLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Limit(limit) => write!(f, "{limit}"),
            Self::LandingPoint => f.write_str("landing-point"),
            Self::UnknownGround => f.write_str("unknown-ground"),
            Self::Continuity => f.write_str("continuity"),
            Self::StatedValue(value) => write!(f, "stated {}", value.name()),
        }
    }
}

/// What was found beside what was allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// What the flight gave; of a stated value, what the plan says.
    pub found: f64,
    /// What the limit allows; of a stated value, what the flight gave.
    pub allowed: f64,
    /// Unit of both.
    pub unit: &'static str,
}

/// One thing that is wrong with a planned hop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    /// Which hop, from 1; 0 where the path has none.
    pub hop: usize,
    /// What it offends against.
    pub limit: ViolatedLimit,
    /// By how much, where the offence is one of numbers.
    pub measure: Option<Measure>,
    /// Where, m along the chain.
    pub at_x_m: f64,
    /// The vertex flown past too low, for the terrain.
    pub vertex: Option<VertexId>,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { hop, limit, at_x_m, .. } = self;
        write!(f, "hop {hop}: {limit} is violated at x = {at_x_m} m")?;
        if let Some(vertex) = self.vertex {
            write!(f, " over vertex {}", vertex.index() + 1)?;
        }
        let Some(Measure { found, allowed, unit }) = self.measure else { return Ok(()) };
        match limit {
            ViolatedLimit::StatedValue(_) => write!(f, ": the plan says {found} {unit}, the flight gives {allowed} {unit}"),
            ViolatedLimit::LandingPoint => {
                write!(f, ": it misses its landing by {found} {unit}, expected at most {allowed} {unit}")
            }
            ViolatedLimit::UnknownGround => write!(f, ": the ground is known for {found} {unit}, expected {allowed} {unit}"),
            ViolatedLimit::Continuity => write!(f, ": a gap of {found} {unit}, expected {allowed} {unit}"),
            ViolatedLimit::Limit(_) => {
                let bound = if found < allowed { "least" } else { "most" };
                write!(f, ": {found} {unit}, expected at {bound} {allowed} {unit}")
            }
        }
    }
}
