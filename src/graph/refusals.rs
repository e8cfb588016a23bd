//! Counts of refused pairs, by the limit that refused.

use std::ops::AddAssign;

use crate::world::Limit;

/// The number of pairs that each limit refused. A pair counts once, under the first limit that leaves no arc, in the order of
/// testing: ground, speeds, cones, machine, terrain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct RefusalCounts {
    counts: [u64; Limit::ALL.len()],
}

impl RefusalCounts {
    /// Counts one refusal.
    #[inline]
    pub fn count(&mut self, limit: Limit) {
        self.counts[limit.index()] += 1;
    }

    /// The number of pairs that a limit refused.
    pub const fn of(&self, limit: Limit) -> u64 {
        self.counts[limit.index()]
    }

    /// All limits with refusals and their counts, in descending order.
    pub fn ranked(&self) -> Vec<(Limit, u64)> {
        let mut ranked: Vec<_> = Limit::ALL.into_iter().map(|limit| (limit, self.of(limit))).filter(|(_, n)| *n > 0).collect();
        ranked.sort_by_key(|(limit, n)| (std::cmp::Reverse(*n), *limit));
        ranked
    }

    /// The sum of all counts.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }
}

impl AddAssign for RefusalCounts {
    fn add_assign(&mut self, other: Self) {
        for (mine, theirs) in self.counts.iter_mut().zip(other.counts) {
            *mine += theirs;
        }
    }
}
