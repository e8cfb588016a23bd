//! The least capability that makes a journey possible, between a value that is proved not to and one that does.

use super::ProofVerdict;
use crate::progress::{Cancelled, Detail, Meter, Progress, Stage};

/// What is known of the least capability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// The most capable value at which the journey is proved impossible; `None`: not even at the weakest end of the range.
    pub unreachable_at: Option<f64>,
    /// The least capable value at which a path was found; `None`: not even at the strongest end.
    pub reachable_at: Option<f64>,
}

/// The values to look among.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CapabilityRange {
    /// The least capable value.
    pub weakest: f64,
    /// The most capable value, above the weakest or below it.
    pub strongest: f64,
    /// When to stop: where the two values are this close, as a share of the larger one (of the range, where it holds zero or negative
    /// values).
    pub resolution: f64,
}

impl CapabilityRange {
    /// The value in the middle: the geometric mean of positive values, which may lie far apart, else the mean.
    fn middle(&self, a: f64, b: f64) -> f64 {
        if self.is_positive() { a.sqrt() * b.sqrt() } else { 0.5 * (a + b) }
    }

    fn is_positive(&self) -> bool {
        self.weakest > 0.0 && self.strongest > 0.0
    }

    /// Whether two values are as close as asked for, or as numbers get.
    fn is_close(&self, a: f64, b: f64) -> bool {
        let scale = if self.is_positive() { a.max(b) } else { (self.strongest - self.weakest).abs() };
        let middle = self.middle(a, b);
        (a - b).abs() <= self.resolution * scale || middle <= a.min(b) || middle >= a.max(b)
    }
}

/// Narrows the least capability down by bisection, given what the bounds say at a value.
///
/// A more capable value never makes a journey impossible, so what is proved or found at one value holds on its side of it. Where a value
/// in between is left open, either side is narrowed by itself.
///
/// Reports before the first value and after every value.
///
/// # Errors
/// What the answer at a value gives, or [`Cancelled`].
///
/// # Examples
/// ```
/// use chta::{graph::proof::{CapabilityRange, ProofVerdict, least_capability}, progress::Cancelled};
/// // Possible from 3 on; between 2.9 and 3.1 nothing is told.
/// let mut told = |value: f64| Ok::<_, Cancelled>(match value {
///     v if v < 2.9 => ProofVerdict::Untraversable,
///     v if v > 3.1 => ProofVerdict::Traversable,
///     _ => ProofVerdict::Open,
/// });
/// let range = CapabilityRange { weakest: 0.1, strongest: 100.0, resolution: 1e-3 };
/// let found = least_capability(range, &mut told, &()).unwrap();
/// assert!((found.unreachable_at.unwrap() - 2.9).abs() < 0.01 && (found.reachable_at.unwrap() - 3.1).abs() < 0.01);
/// ```
pub fn least_capability<E: From<Cancelled>>(
    range: CapabilityRange,
    told: &mut dyn FnMut(f64) -> Result<ProofVerdict, E>,
    progress: &dyn Progress,
) -> Result<Threshold, E> {
    let meter = Meter::new(progress, Stage::Requirement);
    meter.report(Detail::None)?;
    let mut told = |value: f64| {
        let verdict = told(value)?;
        meter.complete_one()?;
        Ok::<_, E>(verdict)
    };
    let strongest = told(range.strongest)?;
    if strongest == ProofVerdict::Untraversable {
        return Ok(Threshold { unreachable_at: Some(range.strongest), reachable_at: None });
    }
    let weakest = told(range.weakest)?;
    if weakest == ProofVerdict::Traversable {
        return Ok(Threshold { unreachable_at: None, reachable_at: Some(range.weakest) });
    }
    let mut known = Threshold {
        unreachable_at: (weakest == ProofVerdict::Untraversable).then_some(range.weakest),
        reachable_at: (strongest == ProofVerdict::Traversable).then_some(range.strongest),
    };
    let (mut low, mut high) = (range.weakest, range.strongest);
    let mut open = None;
    while open.is_none() && !range.is_close(low, high) {
        let value = range.middle(low, high);
        match told(value)? {
            ProofVerdict::Untraversable => (low, known.unreachable_at) = (value, Some(value)),
            ProofVerdict::Traversable => (high, known.reachable_at) = (value, Some(value)),
            ProofVerdict::Open => open = Some(value),
        }
    }
    let Some(open) = open else { return Ok(known) };
    let mut above_proved = open;
    while !range.is_close(low, above_proved) {
        let value = range.middle(low, above_proved);
        match told(value)? {
            ProofVerdict::Untraversable => (low, known.unreachable_at) = (value, Some(value)),
            ProofVerdict::Traversable => (above_proved, high, known.reachable_at) = (value, value, Some(value)),
            ProofVerdict::Open => above_proved = value,
        }
    }
    // A path found below the open value decides the other side as well.
    let mut below_found = if range.weakest < range.strongest { open.min(high) } else { open.max(high) };
    while !range.is_close(below_found, high) {
        let value = range.middle(below_found, high);
        match told(value)? {
            ProofVerdict::Traversable => (high, known.reachable_at) = (value, Some(value)),
            ProofVerdict::Untraversable => (below_found, known.unreachable_at) = (value, Some(value)),
            ProofVerdict::Open => below_found = value,
        }
    }
    Ok(known)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a world where `proved_to` is proved impossible, `found_from` is possible, and between nothing is told.
    fn threshold(range: CapabilityRange, proved_to: f64, found_from: f64) -> (Threshold, u32) {
        let mut asked = 0;
        let rising = range.weakest < range.strongest;
        let mut told = |value: f64| {
            asked += 1;
            Ok::<_, Cancelled>(match value {
                v if (v <= proved_to) == rising && v != proved_to || v == proved_to => ProofVerdict::Untraversable,
                v if (v >= found_from) == rising && v != found_from || v == found_from => ProofVerdict::Traversable,
                _ => ProofVerdict::Open,
            })
        };
        (least_capability(range, &mut told, &()).unwrap(), asked)
    }

    #[test]
    fn both_sides_close_in_whichever_way_is_up() {
        for (weakest, strongest) in [(0.1, 100.0), (100.0, 0.1), (-50.0, 50.0), (50.0, -50.0), (0.0, 7.0), (7.0, 0.0)] {
            let range = CapabilityRange { weakest, strongest, resolution: 1e-4 };
            let at = |share: f64| weakest + (strongest - weakest) * share;
            for (low, high) in [(0.3, 0.3), (0.3, 0.4), (0.05, 0.95), (0.5, 0.5001)] {
                let (found, asked) = threshold(range, at(low), at(high));
                let (proved, reached) = (found.unreachable_at.unwrap(), found.reachable_at.unwrap());
                let scale = (strongest - weakest).abs();
                assert!((proved - at(low)).abs() < 2e-4 * scale, "{range:?} {low} {high}: {found:?}");
                assert!((reached - at(high)).abs() < 2e-4 * scale, "{range:?} {low} {high}: {found:?}");
                assert!(asked < 60, "{asked} values asked for");
            }
        }
    }

    #[test]
    fn an_end_value_that_decides_the_answer_ends_the_search() {
        let range = CapabilityRange { weakest: 1.0, strongest: 2.0, resolution: 1e-3 };
        assert_eq!(threshold(range, 5.0, 6.0).0, Threshold { unreachable_at: Some(2.0), reachable_at: None });
        assert_eq!(threshold(range, 0.1, 0.5).0, Threshold { unreachable_at: None, reachable_at: Some(1.0) });
        let (nothing, _) = threshold(range, 0.1, 5.0);
        assert_eq!(nothing, Threshold { unreachable_at: None, reachable_at: None });
    }
}
