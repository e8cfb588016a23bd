//! Why a pair cannot be hopped: a refusal is an answer.

use std::fmt;

use super::LimitInterval;
use crate::{
    chain::GroundRefusal,
    world::{Contact, Limit},
};

/// By how much a limit refuses every arc by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shortfall {
    /// The ground at one end refuses whatever the hop.
    Ground {
        /// Which end.
        contact: Contact,
        /// Why.
        refusal: GroundRefusal,
    },
    /// Even the arc of least speed is too fast.
    Speed {
        /// The least speed there is, m/s.
        needed_m_s: f64,
        /// The greatest allowed, m/s.
        limit_m_s: f64,
    },
    /// The plane of travel turns on the way.
    Bend {
        /// Where, m along the chain.
        x_m: f64,
    },
    /// The landing itself is too high.
    Height {
        /// Its height above the take-off, m.
        needed_m: f64,
        /// The greatest allowed, m.
        limit_m: f64,
    },
}

/// Why no arc joins a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conflict {
    /// One limit refuses every arc by itself.
    Alone(LimitInterval),
    /// Two limits leave nothing between them: the lower end that one sets lies above the upper end that the other sets.
    Pair {
        /// Sets the lower end.
        lower: LimitInterval,
        /// Sets the upper end.
        upper: LimitInterval,
        /// How far apart the two ends are, degrees.
        gap_deg: f64,
    },
}

impl Conflict {
    /// The limit that a count of refusals puts this under: the one that refuses alone, or of a pair the one that sets the lower end,
    /// unless that is only the line of sight.
    pub const fn counted_under(&self) -> Limit {
        match self {
            Self::Alone(limit) => limit.limit,
            Self::Pair { lower, upper, .. } => match lower.limit {
                Limit::LineOfSight => upper.limit,
                limit => limit,
            },
        }
    }
}

impl fmt::Display for Shortfall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ground { contact: Contact::Takeoff, refusal } => write!(f, "the take-off point refuses: {refusal}"),
            Self::Ground { contact: Contact::Landing, refusal } => write!(f, "the landing point refuses: {refusal}"),
            Self::Speed { needed_m_s, limit_m_s } => {
                write!(f, "every arc needs at least {needed_m_s:.6} m/s, the limit is {limit_m_s} m/s")
            }
            Self::Bend { x_m } => write!(f, "the chain bends at x = {x_m} m, and a hop is flown in one plane: land on the bend"),
            Self::Height { needed_m, limit_m } => {
                write!(f, "the landing lies {needed_m:.6} m above the take-off, the limit is {limit_m} m")
            }
        }
    }
}

impl fmt::Display for Conflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Alone(limit) => match limit.shortfall {
                Some(shortfall) => write!(f, "{} refuses every arc: {shortfall}", limit.limit),
                None => write!(f, "{} refuses every arc", limit.limit),
            },
            Self::Pair { lower, upper, gap_deg } => {
                write!(f, "{} asks for a take-off at least {gap_deg:.6} deg steeper than {} allows", lower.limit, upper.limit)?;
                match lower.vertex {
                    Some(vertex) => write!(f, ", over vertex {}", vertex.index() + 1),
                    None => Ok(()),
                }
            }
        }
    }
}
