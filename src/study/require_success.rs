//! The search for the least capable value with enough success: a scan, then bisections.

use super::value_scan::ValueScan;
use crate::{
    graph::proof::CapabilityRange,
    progress::{Cancelled, Progress},
    report::{RequireSuccessRecord, SuccessBudgetRecord, SuccessTry},
};

/// How many times as far apart the ends of the interval of values may be known: they tell how uncertain the value is, and need fewer tries.
const COARSER: f64 = 8.0;

/// What is known of the success by value.
#[derive(Clone, Debug)]
pub(super) struct SuccessSearch {
    wanted: f64,
    scan: ValueScan<SuccessTry>,
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
        Self { wanted, scan: ValueScan::new(range) }
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
        let wanted = self.wanted;
        let by = |enough: Enough| move |tried: &SuccessTry| is_enough(tried, wanted, enough);
        let [by_estimate, by_high, by_low] = [Enough::Estimate, Enough::High, Enough::Low].map(by);
        let mut attempt = |value: f64| Ok(SuccessTry::new(value, estimate(value)?.as_ref()));
        self.scan.run(&mut attempt, &[(&by_estimate, 1.0), (&by_high, COARSER), (&by_low, COARSER)], progress)
    }

    /// The place of the least capable value that is enough.
    fn first(&self, enough: Enough) -> Option<usize> {
        self.scan.first(&|tried| is_enough(tried, self.wanted, enough))
    }

    /// The least capable value that is enough.
    pub(super) fn least(&self) -> Option<&SuccessTry> {
        self.scan.tries.get(self.first(Enough::Estimate)?).map(|(_, tried)| tried)
    }

    /// Whether that value and the one before are within the resolution, or the whole range is decided.
    pub(super) fn is_met(&self) -> bool {
        self.scan.is_met(&|tried| is_enough(tried, self.wanted, Enough::Estimate))
    }

    /// All as plain data.
    pub(super) fn record(&self) -> RequireSuccessRecord {
        // Below the first value whose upper end is enough lies one that is not.
        let tries: Vec<SuccessTry> = self.scan.tries.iter().map(|(_, tried)| *tried).collect();
        let from = self.first(Enough::High).map(|first| tries[first.saturating_sub(1)].value);
        let to = self.first(Enough::Low).map(|first| tries[first].value);
        let enough = |tried: &SuccessTry| is_enough(tried, self.wanted, Enough::Estimate);
        RequireSuccessRecord {
            success_min: self.wanted,
            at: self.least().copied(),
            uncertain_from: from,
            uncertain_to: to,
            monotone: tries.is_sorted_by(|a, b| enough(a) <= enough(b) && a.success_estimated <= b.success_estimated),
            enough_from_there_on: tries.is_sorted_by(|a, b| enough(a) <= enough(b)),
            tries,
        }
    }
}

/// Whether a try is enough.
fn is_enough(tried: &SuccessTry, wanted: f64, enough: Enough) -> bool {
    let [low, high] = tried.success_estimated_ci95;
    let success = match enough {
        Enough::High => high,
        Enough::Estimate => tried.success_estimated,
        Enough::Low => low,
    };
    tried.hops.is_some() && success >= wanted
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
