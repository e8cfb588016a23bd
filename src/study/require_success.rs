//! The search for the least capable value with enough success: a scan, then bisections.

use crate::{
    graph::proof::CapabilityRange,
    progress::{Cancelled, Detail, Meter, Progress, Stage},
    report::{RequireSuccessRecord, SuccessBudgetRecord, SuccessTry},
};

/// The values of the scan. More of them miss fewer islands of success.
const SCANNED: u32 = 9;

/// How many times as far apart the ends of the interval of values may be known: they tell how uncertain the value is, and need fewer tries.
const COARSER: f64 = 8.0;

/// What is known of the success by value.
#[derive(Clone, Debug)]
pub(super) struct SuccessSearch {
    range: CapabilityRange,
    wanted: f64,
    /// From the least capable value to the most capable one.
    tries: Vec<SuccessTry>,
}

/// What is asked of an estimate.
#[derive(Clone, Copy)]
enum Enough {
    /// Its upper end: below, the success is too small but for one case in forty.
    High,
    /// The estimate itself.
    Estimate,
    /// Its lower end: from there on, the success is enough but for one case in forty.
    Low,
}

impl SuccessSearch {
    pub(super) const fn new(range: CapabilityRange, wanted: f64) -> Self {
        Self { range, wanted, tries: Vec::new() }
    }

    /// Scans, then brings together the first value that is enough and the one before it; and so for both ends of the estimate's interval.
    ///
    /// # Errors
    /// That of an estimate, or [`Cancelled`].
    pub(super) fn run<E: From<Cancelled>>(
        &mut self,
        estimate: &mut dyn FnMut(f64) -> Result<Option<SuccessBudgetRecord>, E>,
        progress: &dyn Progress,
    ) -> Result<(), E> {
        let meter = Meter::new(progress, Stage::Requirement);
        meter.report(Detail::None)?;
        let mut attempt = |search: &mut Self, value: f64| {
            let found = SuccessTry::new(value, estimate(value)?.as_ref());
            let at = search.tries.partition_point(|tried| search.is_weaker(tried.value, value));
            search.tries.insert(at, found);
            meter.complete_one()?;
            Ok::<(), E>(())
        };
        for i in 0..SCANNED {
            attempt(self, self.range.at_share(f64::from(i) / f64::from(SCANNED - 1)))?;
        }
        for (enough, coarser) in [(Enough::Estimate, 1.0), (Enough::High, COARSER), (Enough::Low, COARSER)] {
            let range = CapabilityRange { resolution: self.range.resolution * coarser, ..self.range };
            while let Some((low, high)) = self.bracket(enough).filter(|&(low, high)| !range.is_close(low, high)) {
                attempt(self, range.middle(low, high))?;
            }
        }
        Ok(())
    }

    fn is_weaker(&self, a: f64, b: f64) -> bool {
        if self.range.weakest < self.range.strongest { a < b } else { a > b }
    }

    fn is_enough(&self, tried: &SuccessTry, enough: Enough) -> bool {
        let [low, high] = tried.success_estimated_ci95;
        let success = match enough {
            Enough::High => high,
            Enough::Estimate => tried.success_estimated,
            Enough::Low => low,
        };
        tried.hops.is_some() && success >= self.wanted
    }

    /// The place of the least capable value that is enough.
    fn first(&self, enough: Enough) -> Option<usize> {
        self.tries.iter().position(|tried| self.is_enough(tried, enough))
    }

    /// The values just before and at the least capable one that is enough.
    fn bracket(&self, enough: Enough) -> Option<(f64, f64)> {
        let first = self.first(enough)?;
        Some((self.tries.get(first.checked_sub(1)?)?.value, self.tries[first].value))
    }

    /// The least capable value that is enough.
    pub(super) fn least(&self) -> Option<&SuccessTry> {
        self.tries.get(self.first(Enough::Estimate)?)
    }

    /// Whether that value and the one before are within the resolution, or the whole range is decided.
    pub(super) fn is_met(&self) -> bool {
        self.bracket(Enough::Estimate).is_none_or(|(low, high)| self.range.is_close(low, high))
    }

    /// All as plain data.
    pub(super) fn record(&self) -> RequireSuccessRecord {
        // Below the first value whose upper end is enough lies one that is not.
        let from = self.first(Enough::High).map(|first| self.tries[first.saturating_sub(1)].value);
        let to = self.first(Enough::Low).map(|first| self.tries[first].value);
        let enough = |tried: &SuccessTry| self.is_enough(tried, Enough::Estimate);
        RequireSuccessRecord {
            success_min: self.wanted,
            at: self.least().copied(),
            uncertain_from: from,
            uncertain_to: to,
            monotone: self.tries.is_sorted_by(|a, b| enough(a) <= enough(b) && a.success_estimated <= b.success_estimated),
            enough_from_there_on: self.tries.is_sorted_by(|a, b| enough(a) <= enough(b)),
            tries: self.tries.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A success by value, which falls or grows with it, or has an island; the threshold, and whether success stays enough beyond it.
    #[test]
    fn thresholds_are_found_between_scanned_values_and_islands_are_said() {
        type Success = fn(f64) -> f64;
        type Case = ((f64, f64), Success, Option<f64>, bool);
        let rising: Success = |value| (value / 10.0).min(1.0);
        let falling: Success = |value| 1.0 - value / 20.0;
        let island: Success = |value| if (4.0..6.0).contains(&value) { 0.95 } else { value / 10.0 };
        // The ends of the range from weak to strong, the success, the value wanted, and whether all stronger values have it.
        let cases: [Case; 5] = [
            ((0.0, 10.0), rising, Some(9.0), true),
            ((20.0, 0.0), falling, Some(2.0), true),
            ((0.0, 10.0), island, Some(4.0), false),
            ((0.0, 8.0), rising, None, true),
            ((9.5, 12.0), rising, Some(9.5), true),
        ];
        for ((weakest, strongest), success, expected, stays) in cases {
            let mut search = SuccessSearch::new(CapabilityRange { weakest, strongest, resolution: 1e-3 }, 0.9);
            let mut at = |value: f64| Ok::<_, Cancelled>(Some(SuccessBudgetRecord::new(0.9, true, Some((3, success(value))))));
            search.run(&mut at, &()).expect("not cancelled");
            let record = search.record();
            match expected {
                Some(expected) => {
                    let found = search.least().expect("a value").value;
                    assert!((found - expected).abs() <= 0.011, "{found} for {expected}");
                    let from = record.uncertain_from.expect("where the upper end is enough");
                    let is_within = if weakest < strongest { from <= found } else { from >= found };
                    assert!(is_within && search.is_met(), "{record:?}");
                }
                None => assert!(search.least().is_none() && search.is_met()),
            }
            assert_eq!(record.enough_from_there_on, stays, "{record:?}");
        }
    }

    #[test]
    fn a_value_without_a_path_is_never_enough() {
        let mut search = SuccessSearch::new(CapabilityRange { weakest: 1.0, strongest: 2.0, resolution: 1e-2 }, 0.0);
        search.run(&mut |_| Ok::<_, Cancelled>(None), &()).expect("not cancelled");
        assert!(search.least().is_none() && search.record().tries.len() == 9);
    }
}
