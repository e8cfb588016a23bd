//! A queue of states by their labels, in buckets of equal width.

/// Buckets that are kept apart; states beyond them wait together until these are empty.
const BUCKETS: usize = 1024;

/// States by label: all states of one bucket come before those of the next, in the order in which they were added.
///
/// Where no arc costs less than a bucket is wide, none of the states of a bucket improves another one, so that each is final when its
/// bucket is taken: labels are then set as in Dijkstra's algorithm, without a comparison. Cheaper arcs may put states back into the bucket
/// that is being taken. A state may be queued several times; who takes it looks whether it is done.
#[derive(Debug)]
pub(super) struct Buckets {
    slots: Vec<Vec<u32>>,
    /// The slot that is taken from.
    head: usize,
    /// The bucket of the first slot.
    first: u64,
    per_width: f64,
    later: Vec<u32>,
}

impl Buckets {
    /// Empty buckets of this width, which must be above 0.
    pub(super) fn new(width: f64) -> Self {
        Self { slots: vec![Vec::new(); BUCKETS], head: 0, first: 0, per_width: 1.0 / width, later: Vec::new() }
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
    fn bucket(&self, key: f64) -> u64 {
        (key * self.per_width) as u64
    }

    /// Adds a state under a finite key, not below 0. A key below the bucket that is being taken joins that one.
    #[inline]
    pub(super) fn push(&mut self, state: u32, key: f64) {
        let slot = self.bucket(key).saturating_sub(self.first);
        match usize::try_from(slot) {
            Ok(slot) if slot < BUCKETS => self.slots[slot.max(self.head)].push(state),
            _ => self.later.push(state),
        }
    }

    /// Takes all states of the next bucket into `taken`, which it empties first, with the least key that the bucket may hold; `None` if
    /// no more are left.
    ///
    /// `key` gives the present key of a state, and `None` for one that is done and need not be queued any more.
    #[expect(clippy::cast_precision_loss, reason = "buckets are counted far below 2^53")]
    pub(super) fn take(&mut self, taken: &mut Vec<u32>, key: impl Fn(u32) -> Option<f64>) -> Option<f64> {
        taken.clear();
        loop {
            while self.head < BUCKETS && self.slots[self.head].is_empty() {
                self.head += 1;
            }
            if self.head < BUCKETS {
                std::mem::swap(taken, &mut self.slots[self.head]);
                return Some((self.first + self.head as u64) as f64 / self.per_width);
            }
            self.later.retain(|state| key(*state).is_some());
            let bucket = |state: &u32| key(*state).map(|key| self.bucket(key));
            self.first = self.later.iter().filter_map(bucket).min()?;
            self.head = 0;
            for state in std::mem::take(&mut self.later) {
                if let Some(key) = key(state) {
                    self.push(state, key);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    /// Bucket after bucket, whatever their number.
    #[test]
    fn states_come_in_the_order_of_their_buckets() {
        let draw = &mut Draw::seeded(2209);
        for width in [1e-3, 1.0, 1e6] {
            let keys: Vec<f64> = (0..4000).map(|_| draw.log_uniform(1e-4, 1e5)).collect();
            let mut buckets = Buckets::new(width);
            for (state, key) in (0..).zip(&keys) {
                buckets.push(state, *key);
            }
            let (mut taken, mut found, mut before) = (Vec::new(), Vec::new(), -1.0);
            while let Some(least) = buckets.take(&mut taken, |state| Some(keys[state as usize])) {
                assert!(least > before);
                let inside = |state: &u32| (least..least + width).contains(&(keys[*state as usize] * (1.0 + 1e-12)));
                assert!(taken.iter().all(inside), "{width}");
                found.extend_from_slice(&taken);
                before = least;
            }
            found.sort_unstable();
            assert!((0..4000).eq(found));
        }
    }
}
