//! Why no hop joins a pair of stations.

use std::fmt;

use super::{Binding, LimitInterval};
use crate::{
    ballistics::{Arc, FlightEnvelope, LineOfSight, TakeoffChoice, TakeoffSpeeds, least_takeoff_speed_m_s},
    chain::GroundRefusal,
    quantity::SlopeInterval,
    world::{Contact, LayerName, Limit},
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
    /// A layer of the map does not hold under the flight.
    Flight {
        /// The layer.
        layer: LayerName,
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
    /// The machine has none of the take-off speeds of the arcs that all other limits leave.
    Commands {
        /// The limit on the machine's take-off speeds.
        limit: Limit,
        /// The other limit that leaves too little: of the two that set the ends of what the others leave, the one beyond which the
        /// nearest speed lies that the machine has.
        other: LimitInterval,
        /// The least and the greatest take-off speed that the others leave, m/s.
        left_m_s: [f64; 2],
        /// The nearest speed that the machine and some arc have, m/s.
        nearest_m_s: f64,
    },
}

impl Conflict {
    /// The conflict of the machine's take-off speeds with an interval of lofts that all other limits leave.
    pub(crate) fn of_commands(
        envelope: &FlightEnvelope,
        sight: LineOfSight,
        lofts: SlopeInterval,
        binding: Binding,
        command: LimitInterval,
    ) -> Self {
        let speed_m_s = |loft: f64| match loft {
            loft if loft <= 0.0 || loft.is_infinite() => f64::INFINITY,
            loft => Arc::new(sight, loft, envelope.gravity_m_s2()).takeoff_speed_m_s(),
        };
        let ends_m_s = [speed_m_s(lofts.lower), speed_m_s(lofts.upper)];
        let left_m_s = [speed_m_s(TakeoffChoice::LeastSpeed.loft(sight, lofts)), ends_m_s[0].max(ends_m_s[1])];
        let away_m_s = |speed_m_s: f64| (left_m_s[0] - speed_m_s).max(speed_m_s - left_m_s[1]);
        let nearest_m_s = match envelope.takeoff_speeds() {
            TakeoffSpeeds::Any => left_m_s[0],
            TakeoffSpeeds::AtLeast(least_m_s) => *least_m_s,
            TakeoffSpeeds::Levels(levels) => {
                // A speed below that of the slowest arc of all is no remedy.
                let slowest_m_s = least_takeoff_speed_m_s(sight, envelope.gravity_m_s2());
                let possible = levels.as_slice().iter().filter(|level| **level >= slowest_m_s);
                let nearest = possible.min_by(|a, b| away_m_s(**a).total_cmp(&away_m_s(**b)));
                nearest.copied().unwrap_or(levels.highest_m_s())
            }
        };
        // Faster arcs lie beyond either end, and beyond the faster one is the nearest; slower ones beyond the slower end.
        let beyond_lower = (ends_m_s[0] > ends_m_s[1]) == (nearest_m_s > left_m_s[0]);
        let other = if beyond_lower { binding.lower } else { binding.upper };
        Self::Commands { limit: command.limit, other, left_m_s, nearest_m_s }
    }

    /// The limit under which this conflict is counted: the one that refuses alone, or the one of a pair with the lower bound,
    /// unless that is only the line of sight.
    pub const fn counted_under(&self) -> Limit {
        match self {
            Self::Alone(limit) => limit.limit,
            Self::Pair { lower, upper, .. } => match lower.limit {
                Limit::LineOfSight => upper.limit,
                limit => limit,
            },
            Self::Commands { limit, .. } => *limit,
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
            Self::Flight { layer } => write!(f, "the layer {layer} does not hold all along the ground flown over"),
            Self::Height { needed_m, limit_m } => {
                write!(f, "the landing lies {needed_m:.6} m above the take-off, the limit is {limit_m} m")
            }
        }
    }
}

impl Conflict {
    /// The conflict in one sentence, with limits as `named` names them.
    pub fn said(&self, named: impl Fn(Limit) -> String) -> String {
        match self {
            Self::Alone(limit) => match limit.shortfall {
                Some(shortfall) => format!("{} refuses every arc: {shortfall}", named(limit.limit)),
                None => format!("{} refuses every arc", named(limit.limit)),
            },
            Self::Pair { lower, upper, gap_deg } => {
                let [low, high] = [lower, upper].map(|limit| named(limit.limit));
                let place = match (lower.vertex, lower.kink_x_m) {
                    (Some(vertex), _) => format!(", over vertex {}", vertex.index() + 1),
                    (None, Some(x_m)) => format!(", for the clearance over the ground at x = {x_m} m"),
                    (None, None) => String::new(),
                };
                format!("{low} asks for a take-off at least {gap_deg:.6} deg steeper than {high} allows{place}")
            }
            Self::Commands { limit, left_m_s: [least, greatest], nearest_m_s, .. } => {
                let has = match limit {
                    Limit::TakeoffSpeedMin => format!("the least one of the machine is {nearest_m_s} m/s"),
                    _ => format!("the nearest one that the machine has is {nearest_m_s} m/s"),
                };
                let left = format!("the other limits leave take-off speeds from {least:.6} to {greatest:.6} m/s");
                format!("{} leaves no arc: {left}, {has}", named(*limit))
            }
        }
    }
}

impl fmt::Display for Conflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.said(|limit| limit.to_string()))
    }
}
