//! The search for the least capable value that is enough where being enough need not grow with it: a scan, then bisections.

use crate::{
    graph::proof::CapabilityRange,
    progress::{Cancelled, Detail, Meter, Progress, Stage},
};

/// The values of the scan. More of them miss fewer islands.
const SCANNED: u32 = 9;

/// What is known by value.
#[derive(Clone, Debug)]
pub(super) struct ValueScan<T> {
    pub(super) range: CapabilityRange,
    /// From the least capable value to the most capable one.
    pub(super) tries: Vec<(f64, T)>,
}

/// A way to be enough, and how many times as far apart as the resolution its values may be known.
pub(super) type Enough<'a, T> = (&'a dyn Fn(&T) -> bool, f64);

impl<T> ValueScan<T> {
    pub(super) const fn new(range: CapabilityRange) -> Self {
        Self { range, tries: Vec::new() }
    }

    /// Scans, then for every way to be enough brings together the first value that is and the one before it.
    ///
    /// # Errors
    /// That of an attempt, or [`Cancelled`].
    pub(super) fn run<E: From<Cancelled>>(
        &mut self,
        attempt: &mut dyn FnMut(f64) -> Result<T, E>,
        ways: &[Enough<'_, T>],
        progress: &dyn Progress,
    ) -> Result<(), E> {
        let meter = Meter::new(progress, Stage::Requirement);
        meter.report(Detail::None)?;
        let mut attempt = |scan: &mut Self, value: f64| {
            let found = attempt(value)?;
            let at = scan.tries.partition_point(|tried| scan.is_weaker(tried.0, value));
            scan.tries.insert(at, (value, found));
            meter.complete_one()?;
            Ok::<(), E>(())
        };
        for i in 0..SCANNED {
            attempt(self, self.range.at_share(f64::from(i) / f64::from(SCANNED - 1)))?;
        }
        for (enough, coarser) in ways {
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

    /// The place of the least capable value that is enough.
    pub(super) fn first(&self, enough: &dyn Fn(&T) -> bool) -> Option<usize> {
        self.tries.iter().position(|(_, tried)| enough(tried))
    }

    /// The values just before and at the least capable one that is enough.
    fn bracket(&self, enough: &dyn Fn(&T) -> bool) -> Option<(f64, f64)> {
        let first = self.first(enough)?;
        Some((self.tries.get(first.checked_sub(1)?)?.0, self.tries[first].0))
    }

    /// Whether that value and the one before are within the resolution, or the whole range is decided.
    pub(super) fn is_met(&self, enough: &dyn Fn(&T) -> bool) -> bool {
        self.bracket(enough).is_none_or(|(low, high)| self.range.is_close(low, high))
    }
}
