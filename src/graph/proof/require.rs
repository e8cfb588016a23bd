//! The least capability that makes a journey possible, bracketed by a value proved insufficient and one proved sufficient.

use super::ProofVerdict;
use crate::progress::{Cancelled, Detail, Meter, Progress, Stage};

/// Bounds on the least capability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// The most capable value at which the journey is proved impossible; `None`: not proved even at the weakest end of the
    /// range.
    pub unreachable_at: Option<f64>,
    /// The least capable value at which a path was found; `None`: not found even at the strongest end.
    pub reachable_at: Option<f64>,
}

/// The range of values to search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CapabilityRange {
    /// The least capable value.
    pub weakest: f64,
    /// The most capable value, numerically above or below the weakest.
    pub strongest: f64,
    /// The search stops when the two values differ by this fraction of the larger one (of the whole range, if it contains
    /// zero or negative values).
    pub resolution: f64,
}

impl CapabilityRange {
    /// The middle value: the geometric mean of positive values, which may differ by orders of magnitude, else the arithmetic
    /// mean.
    pub(crate) fn middle(&self, a: f64, b: f64) -> f64 {
        if self.is_positive() { a.sqrt() * b.sqrt() } else { 0.5 * (a + b) }
    }

    /// The value at a share of the way from the weakest to the strongest, with equal ratios where both are positive.
    pub(crate) fn at_share(&self, share: f64) -> f64 {
        let Self { weakest, strongest, .. } = *self;
        if share <= 0.0 {
            weakest
        } else if share >= 1.0 {
            strongest
        } else if self.is_positive() {
            weakest * libm::pow(strongest / weakest, share)
        } else {
            weakest + share * (strongest - weakest)
        }
    }

    /// How many times the values double from the weakest to the strongest, or halve, rounded up; 1 of a range with zero or negative values.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to some thousands")]
    pub(crate) fn octaves(&self) -> u32 {
        if self.is_positive() { (libm::log2(self.strongest / self.weakest).abs().ceil() as u32).max(1) } else { 1 }
    }

    fn is_positive(&self) -> bool {
        self.weakest > 0.0 && self.strongest > 0.0
    }

    /// Whether two values are within the resolution, or no double lies between them.
    pub(crate) fn is_close(&self, a: f64, b: f64) -> bool {
        let scale = if self.is_positive() { a.max(b) } else { (self.strongest - self.weakest).abs() };
        let middle = self.middle(a, b);
        (a - b).abs() <= self.resolution * scale || middle <= a.min(b) || middle >= a.max(b)
    }

    /// Whether a threshold is as narrow as the resolution asks: its two values are close, or the whole range is decided.
    pub fn is_met(&self, threshold: &Threshold) -> bool {
        match (threshold.unreachable_at, threshold.reachable_at) {
            (Some(unreachable), Some(reachable)) => self.is_close(unreachable, reachable),
            (Some(unreachable), None) => unreachable == self.strongest,
            (None, Some(reachable)) => reachable == self.weakest,
            (None, None) => false,
        }
    }
}

/// Bounds the least capability by bisection, given the verdict at each value.
///
/// A more capable value never makes a journey impossible, so a verdict at one value holds for all values on its side. If a
/// value in between stays open, both bounds are refined separately.
///
/// Reports before the first value and after every value.
///
/// # Errors
/// The error of `verdict_at` at a value, or [`Cancelled`].
///
/// # Examples
/// ```
/// use chta::{graph::proof::{CapabilityRange, ProofVerdict, least_capability}, progress::Cancelled};
/// // Possible from 3 on; the verdict between 2.9 and 3.1 is open.
/// let mut verdict_at = |value: f64| Ok::<_, Cancelled>(match value {
///     v if v < 2.9 => ProofVerdict::Untraversable,
///     v if v > 3.1 => ProofVerdict::Traversable,
///     _ => ProofVerdict::Open,
/// });
/// let range = CapabilityRange { weakest: 0.1, strongest: 100.0, resolution: 1e-3 };
/// let found = least_capability(range, &mut verdict_at, &()).unwrap();
/// assert!((found.unreachable_at.unwrap() - 2.9).abs() < 0.01 && (found.reachable_at.unwrap() - 3.1).abs() < 0.01);
/// ```
pub fn least_capability<E: From<Cancelled>>(
    range: CapabilityRange,
    verdict_at: &mut dyn FnMut(f64) -> Result<ProofVerdict, E>,
    progress: &dyn Progress,
) -> Result<Threshold, E> {
    let meter = Meter::new(progress, Stage::Requirement);
    meter.report(Detail::None)?;
    let mut verdict_at = |value: f64| {
        let verdict = verdict_at(value)?;
        meter.complete_one()?;
        Ok::<_, E>(verdict)
    };
    let strongest = verdict_at(range.strongest)?;
    if strongest == ProofVerdict::Untraversable {
        return Ok(Threshold { unreachable_at: Some(range.strongest), reachable_at: None });
    }
    let weakest = verdict_at(range.weakest)?;
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
        match verdict_at(value)? {
            ProofVerdict::Untraversable => (low, known.unreachable_at) = (value, Some(value)),
            ProofVerdict::Traversable => (high, known.reachable_at) = (value, Some(value)),
            ProofVerdict::Open => open = Some(value),
        }
    }
    let Some(open) = open else { return Ok(known) };
    let mut above_proved = open;
    while !range.is_close(low, above_proved) {
        let value = range.middle(low, above_proved);
        match verdict_at(value)? {
            ProofVerdict::Untraversable => (low, known.unreachable_at) = (value, Some(value)),
            ProofVerdict::Traversable => (above_proved, high, known.reachable_at) = (value, value, Some(value)),
            ProofVerdict::Open => above_proved = value,
        }
    }
    // A path found below the open value decides the other side as well.
    let mut below_found = if range.weakest < range.strongest { open.min(high) } else { open.max(high) };
    while !range.is_close(below_found, high) {
        let value = range.middle(below_found, high);
        match verdict_at(value)? {
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

    /// A model problem: values up to `proved_to` are proved impossible, values from `found_from` are possible, and those
    /// between are open.
    fn threshold(range: CapabilityRange, proved_to: f64, found_from: f64) -> (Threshold, u32) {
        let mut asked = 0;
        let rising = range.weakest < range.strongest;
        let mut verdict_at = |value: f64| {
            asked += 1;
            Ok::<_, Cancelled>(match value {
                v if (v <= proved_to) == rising && v != proved_to || v == proved_to => ProofVerdict::Untraversable,
                v if (v >= found_from) == rising && v != found_from || v == found_from => ProofVerdict::Traversable,
                _ => ProofVerdict::Open,
            })
        };
        (least_capability(range, &mut verdict_at, &()).unwrap(), asked)
    }

    #[test]
    fn both_bounds_converge_for_either_direction_of_capability() {
        for (weakest, strongest) in [(0.1, 100.0), (100.0, 0.1), (-50.0, 50.0), (50.0, -50.0), (0.0, 7.0), (7.0, 0.0)] {
            let range = CapabilityRange { weakest, strongest, resolution: 1e-4 };
            let at = |share: f64| weakest + (strongest - weakest) * share;
            for (low, high) in [(0.3, 0.3), (0.3, 0.4), (0.05, 0.95), (0.5, 0.5001)] {
                let (found, asked) = threshold(range, at(low), at(high));
                let (proved, reached) = (found.unreachable_at.unwrap(), found.reachable_at.unwrap());
                let scale = (strongest - weakest).abs();
                assert!((proved - at(low)).abs() < 2e-4 * scale, "{range:?} {low} {high}: {found:?}");
                assert!((reached - at(high)).abs() < 2e-4 * scale, "{range:?} {low} {high}: {found:?}");
                assert!(asked < 60, "{asked} values evaluated");
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
