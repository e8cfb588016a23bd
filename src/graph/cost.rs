//! The objective of the search: hops first, then the chosen effort.

use std::{cmp::Ordering, ops::Add};

use crate::ballistics::{Arc, LineOfSight};

/// The second criterion, after the number of hops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Effort {
    /// The sum of take-off speeds, m/s.
    #[default]
    TakeoffSpeed,
    /// The sum of `v_t^2 / 2`, energy per unit mass, J/kg.
    Energy,
    /// The sum of flight times, s.
    Time,
    /// The largest take-off speed, m/s. Valid as a second criterion because hops are compared first.
    PeakSpeed,
}

impl Effort {
    /// All efforts.
    pub const ALL: [Self; 4] = [Self::TakeoffSpeed, Self::Energy, Self::Time, Self::PeakSpeed];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::TakeoffSpeed => "takeoff-speed",
            Self::Energy => "energy",
            Self::Time => "time",
            Self::PeakSpeed => "peak-speed",
        }
    }

    /// The unit of the effort.
    pub const fn unit(self) -> EffortUnit {
        match self {
            Self::TakeoffSpeed | Self::PeakSpeed => EffortUnit::MetresPerSecond,
            Self::Energy => EffortUnit::JoulesPerKilogram,
            Self::Time => EffortUnit::Seconds,
        }
    }

    /// The effort of a whole path in words, which says whether it is a sum over the hops or the speed of one hop.
    pub const fn total(self) -> &'static str {
        match self {
            Self::TakeoffSpeed => "sum of take-off speeds",
            Self::Energy => "sum of energies per unit mass",
            Self::Time => "flight time in all",
            Self::PeakSpeed => "largest take-off speed",
        }
    }

    /// The cost of `hops` flights along the same arc.
    ///
    /// # Panics
    /// Never; a NaN effort (which the hop test does not yield) becomes an infinite cost.
    #[expect(clippy::cast_precision_loss, reason = "hop counts stay below 2^53")]
    pub fn cost(self, arc: &Arc, hops: u64) -> Cost {
        let v = arc.takeoff_speed_m_s();
        let each = match self {
            Self::TakeoffSpeed | Self::PeakSpeed => v,
            Self::Energy => 0.5 * v * v,
            Self::Time => arc.flight_time_s(),
        };
        let each = if each.is_nan() { f64::INFINITY } else { each };
        if hops == 0 {
            Cost::default()
        } else if self == Self::PeakSpeed {
            Cost { hops, sum: 0.0, peak: each }
        } else {
            Cost { hops, sum: each * hops as f64, peak: 0.0 }
        }
    }
}

crate::quantity::by_name!(Effort, Effort::ALL);

impl Effort {
    /// A lower bound on the cost of a hop over a line of sight.
    #[inline]
    pub fn least_cost(self, sight: LineOfSight, gravity_m_s2: f64) -> Cost {
        match self {
            Self::TakeoffSpeed | Self::Energy | Self::PeakSpeed => self.cost(&Arc::new(sight, sight.secant(), gravity_m_s2), 1),
            // A flat and fast arc takes so little time that a bound on it is not worth computing.
            Self::Time => Cost::of_hops(1),
        }
    }

    /// The cost of a path of some hops with this effort altogether.
    pub(crate) const fn cost_of_path(self, hops: u64, effort: f64) -> Cost {
        match self {
            Self::PeakSpeed => Cost { hops, sum: 0.0, peak: effort },
            Self::TakeoffSpeed | Self::Energy | Self::Time => Cost { hops, sum: effort, peak: 0.0 },
        }
    }
}

/// The unit of an effort.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffortUnit {
    /// m/s.
    MetresPerSecond,
    /// J/kg.
    JoulesPerKilogram,
    /// s.
    Seconds,
}

impl EffortUnit {
    /// All units.
    pub const ALL: [Self; 3] = [Self::MetresPerSecond, Self::JoulesPerKilogram, Self::Seconds];

    /// The symbol.
    pub const fn name(self) -> &'static str {
        match self {
            Self::MetresPerSecond => "m/s",
            Self::JoulesPerKilogram => "J/kg",
            Self::Seconds => "s",
        }
    }
}

crate::quantity::by_name!(EffortUnit, EffortUnit::ALL);

/// Number of hops, then effort: totally ordered, never negative, never NaN.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Cost {
    hops: u64,
    /// Efforts that are summed.
    sum: f64,
    /// Efforts whose maximum counts.
    peak: f64,
}

impl Cost {
    /// More than the cost of any path.
    pub(crate) const UNREACHED: Self = Self { hops: u64::MAX, sum: f64::INFINITY, peak: f64::INFINITY };

    /// A number of hops without effort: a lower bound on the cost of every path with this many hops.
    pub const fn of_hops(hops: u64) -> Self {
        Self { hops, sum: 0.0, peak: 0.0 }
    }

    /// The number of hops.
    pub const fn hops(self) -> u64 {
        self.hops
    }

    /// The effort, in the unit of the [`Effort`] used.
    pub fn effort(self) -> f64 {
        self.sum.max(self.peak)
    }
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { hops: self.hops + other.hops, sum: self.sum + other.sum, peak: self.peak.max(other.peak) }
    }
}

impl PartialOrd for Cost {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Eq for Cost {}

impl Ord for Cost {
    fn cmp(&self, other: &Self) -> Ordering {
        self.hops.cmp(&other.hops).then_with(|| self.sum.total_cmp(&other.sum)).then_with(|| self.peak.total_cmp(&other.peak))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hops_are_compared_before_effort() {
        let costly = Effort::Energy.cost(&Arc::new(LineOfSight::new(1e5, 0.0), 1.0, 25.0), 1);
        let cheap = Effort::Energy.cost(&Arc::new(LineOfSight::new(1e-3, 0.0), 1.0, 1e-5), 2);
        assert!(costly < cheap, "one costly hop is less than two cheap ones");
    }

    #[test]
    fn peak_speed_is_a_maximum_and_the_others_are_sums() {
        let (slow, fast) = (Arc::new(LineOfSight::new(1.0, 0.0), 1.0, 1.0), Arc::new(LineOfSight::new(4.0, 0.0), 1.0, 1.0));
        let total = |effort: Effort| (effort.cost(&slow, 1) + effort.cost(&fast, 2)).effort();
        assert!((total(Effort::PeakSpeed) - 2.0).abs() < 1e-12, "the fastest of 1, 2 and 2 m/s");
        assert!((total(Effort::TakeoffSpeed) - 5.0).abs() < 1e-12, "1 + 2 + 2 m/s");
        assert!((total(Effort::Energy) - 4.5).abs() < 1e-12, "0.5 + 2 + 2 J/kg");
    }
}
