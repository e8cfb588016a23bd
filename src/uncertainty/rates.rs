//! The success rate after some numbers of trials, in a form that merges.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{RatePoint, Wilson};

/// The most points at the ends of batches; beyond it every second point is left out.
const MOST_POINTS: u64 = 1000;

/// Trials from one point to the next, after the early ones.
const BATCH: u64 = 1000;

/// Numbers of trials before the end of the first batch at which the rate is noted, so that short runs have a curve too.
const EARLY: [u64; 6] = [10, 20, 50, 100, 200, 500];

/// The trials of a run, and how many of them reached the goal, between the numbers of trials at which the rate is noted.
///
/// What a trial counts for depends on its own number alone, so that the parts of a run add up to the whole. Memory: at most some thousand
/// entries of 24 bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Rates {
    /// Batches from one point to the next: 2 to this power.
    doublings: u32,
    /// By the number of trials at the point.
    shares: BTreeMap<u64, Share>,
}

/// Some trials.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Share {
    trials: u64,
    reached: u64,
}

impl Rates {
    /// Counts a trial by its number, from 0.
    pub(super) fn add(&mut self, trial: u64, reached: bool) {
        self.count(trial, Share { trials: 1, reached: u64::from(reached) });
        self.thin();
    }

    /// Adds the trials of another part of the run.
    pub(super) fn merge(&mut self, other: &Self) {
        self.coarsen(other.doublings);
        for (&point, &share) in &other.shares {
            self.count(point.saturating_sub(1), share);
        }
        self.thin();
    }

    fn count(&mut self, trial: u64, share: Share) {
        let sum = self.shares.entry(point_after(trial, self.doublings)).or_default();
        sum.trials = sum.trials.saturating_add(share.trials);
        sum.reached = sum.reached.saturating_add(share.reached);
    }

    /// Leaves points out while there are more than the whole run can have: a part never has fewer than the whole.
    fn thin(&mut self) {
        while self.shares.len() as u64 > MOST_POINTS + EARLY.len() as u64 + 2 {
            self.coarsen(self.doublings + 1);
        }
    }

    fn coarsen(&mut self, doublings: u32) {
        if doublings > self.doublings {
            self.doublings = doublings;
            for (point, share) in std::mem::take(&mut self.shares) {
                self.count(point.saturating_sub(1), share);
            }
        }
    }

    /// The rates of the run whose trials end at this number: after the early numbers of trials, at the ends of batches, and at the end.
    pub(super) fn points(&self, end: u64) -> Vec<RatePoint> {
        let batches = end.div_ceil(BATCH);
        let doublings = (0..64).find(|doublings| batches >> doublings <= MOST_POINTS).unwrap_or_default();
        let mut rates = self.clone();
        rates.coarsen(doublings);
        let (mut trials, mut reached) = (0, 0);
        let point = |share: &Share| {
            trials += share.trials;
            reached += share.reached;
            RatePoint { trials, success: Wilson::of(reached, trials) }
        };
        rates.shares.values().map(point).collect()
    }
}

/// The first number of trials after this trial at which the rate is noted.
fn point_after(trial: u64, doublings: u32) -> u64 {
    let every = BATCH << doublings.min(40);
    EARLY.into_iter().find(|early| trial < *early).unwrap_or_else(|| (trial / every).saturating_add(1).saturating_mul(every))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rates(trials: std::ops::Range<u64>, reached: impl Fn(u64) -> bool) -> Rates {
        let mut rates = Rates::default();
        trials.for_each(|trial| rates.add(trial, reached(trial)));
        rates
    }

    #[test]
    fn short_runs_have_a_record_of_their_rate_too() {
        let points = rates(0..200, |trial| trial >= 15).points(200);
        assert_eq!(points.iter().map(|point| point.trials).collect::<Vec<_>>(), [10, 20, 50, 100, 200]);
        let rates: Vec<f64> = points.iter().map(|point| point.success.rate).collect();
        assert_eq!(rates, [0.0, 5.0 / 20.0, 35.0 / 50.0, 85.0 / 100.0, 185.0 / 200.0]);
    }

    #[test]
    fn the_record_of_the_rate_is_thinned_keeps_its_end_and_merges() {
        for (end, doublings) in [(999_500, 0), (1_000_500, 1), (2_001_001, 2)] {
            let reached = |trial: u64| !trial.is_multiple_of(3);
            let whole = rates(0..end, reached);
            let points = whole.points(end);
            assert!(points.len() as u64 <= MOST_POINTS + EARLY.len() as u64 + 1);
            let step = 1000_u64 << doublings;
            let late: Vec<u64> = points.iter().map(|point| point.trials).filter(|trials| *trials > 500).collect();
            assert!(late[0] == step && late.windows(2).all(|pair| pair[1] - pair[0] == step || pair[1] == end), "{end}: {late:?}");
            assert_eq!(points.last().map(|point| point.trials), Some(end));
            for cut in [700, end / 2 + 13] {
                let (first, mut last) = (rates(0..cut, reached), rates(cut..end, reached));
                last.merge(&first);
                assert_eq!(last.points(end), points, "{end} cut at {cut}");
            }
        }
    }
}
