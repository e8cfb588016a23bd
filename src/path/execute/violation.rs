//! The violations that the checker reports.

use std::fmt;

use crate::{
    quantity::{FacetId, VertexId},
    world::Limit,
};

/// A number stated in a [`Hop`](crate::path::Hop) that the checker computes by itself.
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
    /// The delta-v.
    DeltaV,
    /// The propellant.
    Propellant,
    /// The mass after the hop.
    MassEnd,
    /// What a layer of the map costs the whole path.
    LayerCost,
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
            Self::DeltaV => "delta-v",
            Self::Propellant => "propellant",
            Self::MassEnd => "mass at the end",
            Self::LayerCost => "cost of a layer",
        }
    }
}

/// The limit that a hop violates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ViolatedLimit {
    /// A limit of the ground or the machine.
    Limit(Limit),
    /// The hop comes down elsewhere than planned.
    LandingPoint,
    /// The hop flies over unknown ground.
    UnknownGround,
    /// The hop does not begin where the one before ends or at the start, or the last hop does not end at the goal.
    Continuity,
    /// A number of the plan differs from the one flown, or is not finite.
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

/// The value found and the value allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// The flown value; of a stated value, the one in the plan.
    pub found: f64,
    /// The value that the limit allows; of a stated value, the flown one.
    pub allowed: f64,
    /// Unit of both.
    pub unit: &'static str,
}

/// One violation of a planned hop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    /// Which hop, from 1; 0 if the path has none.
    pub hop: usize,
    /// What is violated.
    pub limit: ViolatedLimit,
    /// The numbers, if the violation has some.
    pub measure: Option<Measure>,
    /// Position along the chain, m.
    pub at_x_m: f64,
    /// The vertex passed too low, for the terrain.
    pub vertex: Option<VertexId>,
    /// The facet of a mesh that is passed through or too near, for the terrain.
    pub facet: Option<FacetId>,
}

impl Violation {
    /// A violation without numbers.
    pub(super) const fn at(hop: usize, limit: ViolatedLimit, at_x_m: f64) -> Self {
        Self { hop, limit, measure: None, at_x_m, vertex: None, facet: None }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { hop, limit, at_x_m, .. } = self;
        write!(f, "hop {hop}: {limit} is violated at x = {at_x_m} m")?;
        if let Some(vertex) = self.vertex {
            write!(f, " over vertex {}", vertex.index() + 1)?;
        }
        if let Some(facet) = self.facet {
            write!(f, " at facet {}", facet.index() + 1)?;
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
