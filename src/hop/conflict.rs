//! Why no hop joins a pair of stations.

use std::fmt;

use super::LimitInterval;
use crate::{
    chain::GroundRefusal,
    world::{Contact, Limit},
};

/// By how much a single limit refuses every arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shortfall {
    /// The ground at one end refuses the contact for every hop.
    Ground {
        /// Which end of the hop.
        contact: Contact,
        /// Why the ground refuses it.
        refusal: GroundRefusal,
    },
    /// The arc of least speed is too fast.
    Speed {
        /// The least speed of any arc, m/s.
        needed_m_s: f64,
        /// The greatest speed allowed, m/s.
        limit_m_s: f64,
    },
    /// The plane of travel turns between take-off and landing.
    Bend {
        /// x of the bend, m along the chain.
        x_m: f64,
    },
    /// The landing itself is too high.
    Height {
        /// Its height above the take-off, m.
        needed_m: f64,
        /// The greatest height allowed, m.
        limit_m: f64,
    },
}

/// Why no arc joins a pair of stations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conflict {
    /// A single limit refuses every arc.
    Alone(LimitInterval),
    /// Two limits have no arc in common: the lower bound from one lies above the upper bound from the other.
    Pair {
        /// The limit with the lower bound.
        lower: LimitInterval,
        /// The limit with the upper bound.
        upper: LimitInterval,
        /// By how much the lower bound exceeds the upper bound, degrees.
        gap_deg: f64,
    },
}

impl Conflict {
    /// The limit under which this conflict is counted: the one that refuses alone, or the one of a pair with the lower bound,
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
                match (lower.vertex, lower.kink_x_m) {
                    (Some(vertex), _) => write!(f, ", over vertex {}", vertex.index() + 1),
                    (None, Some(x_m)) => write!(f, ", for the clearance over the ground at x = {x_m} m"),
                    (None, None) => Ok(()),
                }
            }
        }
    }
}
