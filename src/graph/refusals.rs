//! Counts of refused pairs, by the limit that refused.

use std::ops::AddAssign;

use crate::world::{LayerName, Limit};

/// The number of pairs that each limit refused. A pair counts once, under the first limit that leaves no arc, in the order of
/// testing: ground, speeds, cones, machine, terrain.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct RefusalCounts {
    counts: [u64; Limit::ALL.len()],
    /// Of each layer that refused any, in the order of their first refusals.
    layers: Vec<(LayerName, u64)>,
}

impl RefusalCounts {
    /// Counts one refusal.
    #[inline]
    pub fn count(&mut self, limit: Limit) {
        self.add(limit, 1);
    }

    #[inline]
    fn add(&mut self, limit: Limit, pairs: u64) {
        match limit {
            Limit::Layer(layer) => match self.layers.iter_mut().find(|(known, _)| *known == layer) {
                Some((_, count)) => *count += pairs,
                None => self.layers.push((layer, pairs)),
            },
            limit => self.counts[limit.index()] += pairs,
        }
    }

    /// The number of pairs that a limit refused.
    pub fn of(&self, limit: Limit) -> u64 {
        match limit {
            Limit::Layer(layer) => self.layers.iter().find(|(known, _)| *known == layer).map_or(0, |(_, count)| *count),
            limit => self.counts[limit.index()],
        }
    }

    /// All limits with refusals and their counts, in descending order.
    pub fn ranked(&self) -> Vec<(Limit, u64)> {
        let layers = self.layers.iter().map(|(layer, _)| Limit::Layer(*layer));
        let mut ranked: Vec<_> =
            Limit::ALL.into_iter().chain(layers).map(|limit| (limit, self.of(limit))).filter(|(_, n)| *n > 0).collect();
        ranked.sort_by_key(|(limit, n)| (std::cmp::Reverse(*n), *limit));
        ranked
    }

    /// The sum of all counts.
    pub fn total(&self) -> u64 {
        self.counts.iter().chain(self.layers.iter().map(|(_, count)| count)).sum()
    }
}

impl AddAssign for RefusalCounts {
    fn add_assign(&mut self, other: Self) {
        for (mine, theirs) in self.counts.iter_mut().zip(other.counts) {
            *mine += theirs;
        }
        for (layer, pairs) in other.layers {
            self.add(Limit::Layer(layer), pairs);
        }
    }
}
