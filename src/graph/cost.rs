//! What the search minimises: hops first, then the chosen effort.

use std::{cmp::Ordering, ops::Add};

use crate::ballistics::Arc;

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
    /// The largest take-off speed, m/s. Valid as a second criterion because hops go first.
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
    pub const fn unit(self) -> &'static str {
        match self {
            Self::TakeoffSpeed | Self::PeakSpeed => "m/s",
            Self::Energy => "J/kg",
            Self::Time => "s",
        }
    }

    /// What the effort of a path is, in words: no speed of any one hop is meant where it is a sum over the hops.
    pub const fn total(self) -> &'static str {
        match self {
            Self::TakeoffSpeed => "sum of take-off speeds",
            Self::Energy => "sum of energies per unit mass",
            Self::Time => "flight time in all",
            Self::PeakSpeed => "largest take-off speed",
        }
    }

    /// The cost of `hops` flights of the same arc.
    ///
    /// # Panics
    /// Never; a flight that is no number (which the hop test does not yield) costs infinitely much.
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

/// Hops, then effort: totally ordered, never negative, never NaN.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Cost {
    hops: u64,
    /// Efforts that add up.
    sum: f64,
    /// Efforts of which the largest counts.
    peak: f64,
}

impl Cost {
    /// More than any path costs.
    pub(super) const UNREACHED: Self = Self { hops: u64::MAX, sum: f64::INFINITY, peak: f64::INFINITY };

    /// So many hops without any effort: no journey of as many hops costs less.
    pub const fn of_hops(hops: u64) -> Self {
        Self { hops, sum: 0.0, peak: 0.0 }
    }

    /// The number of hops.
    pub const fn hops(self) -> u64 {
        self.hops
    }

    /// The effort, in the unit of the [`Effort`] it was counted in.
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
    use crate::ballistics::LineOfSight;

    #[test]
    fn hops_go_before_any_effort() {
        let costly = Effort::Energy.cost(&Arc::new(LineOfSight::new(1e5, 0.0), 1.0, 25.0), 1);
        let cheap = Effort::Energy.cost(&Arc::new(LineOfSight::new(1e-3, 0.0), 1.0, 1e-5), 2);
        assert!(costly < cheap, "one costly hop goes before two cheap ones");
    }

    #[test]
    fn peak_speed_takes_the_larger_and_others_add_up() {
        let (slow, fast) = (Arc::new(LineOfSight::new(1.0, 0.0), 1.0, 1.0), Arc::new(LineOfSight::new(4.0, 0.0), 1.0, 1.0));
        let total = |effort: Effort| (effort.cost(&slow, 1) + effort.cost(&fast, 2)).effort();
        assert!((total(Effort::PeakSpeed) - 2.0).abs() < 1e-12, "the fastest of 1, 2 and 2 m/s");
        assert!((total(Effort::TakeoffSpeed) - 5.0).abs() < 1e-12, "1 + 2 + 2 m/s");
        assert!((total(Effort::Energy) - 4.5).abs() < 1e-12, "0.5 + 2 + 2 J/kg");
    }
}
