//! What was computed of pairs of nodes, for searches that come to a node with many labels.

use std::collections::HashMap;

use super::SurfaceNode;

/// Results of pairs of nodes, of which the first so many are kept.
#[derive(Debug)]
pub(super) struct PairMemo<T> {
    known: HashMap<[SurfaceNode; 2], T>,
    most: usize,
}

impl<T: Copy> PairMemo<T> {
    /// For results that take at most so many bytes.
    pub(super) fn within(bytes: u64) -> Self {
        let most = bytes / Self::bytes_per_pair();
        Self { known: HashMap::new(), most: usize::try_from(most).unwrap_or(usize::MAX) }
    }

    /// The bytes that a pair takes at most: a table doubles when it is 7/8 full, and has a byte for each of its places; while it doubles, the one
    /// before is still there.
    const fn bytes_per_pair() -> u64 {
        (3 * 8 * (size_of::<([SurfaceNode; 2], T)>() + 1) / 7) as u64
    }

    /// The result of a pair, if it is known.
    pub(super) fn of(&self, pair: [SurfaceNode; 2]) -> Option<T> {
        self.known.get(&pair).copied()
    }

    /// Keeps the result of a pair, where there is room.
    pub(super) fn keep(&mut self, pair: [SurfaceNode; 2], result: T) {
        if self.known.len() < self.most {
            self.known.insert(pair, result);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_pairs_are_kept_as_there_is_room_for() {
        let mut memo = PairMemo::<f64>::within(100 * PairMemo::<f64>::bytes_per_pair());
        let pair = |number: usize| [SurfaceNode::of_index(number), SurfaceNode::of_index(2 * number)];
        for number in 0..150 {
            #[expect(clippy::cast_precision_loss, reason = "a small number")]
            memo.keep(pair(number), number as f64);
        }
        assert_eq!((memo.of(pair(3)), memo.of(pair(99)), memo.of(pair(100))), (Some(3.0), Some(99.0), None));
        assert_eq!(PairMemo::<f64>::within(3).of(pair(0)), None);
        // The table of the standard library holds 7/8 of a power of two: the bytes are those of its places, and of half as many.
        let places = (memo.known.capacity() * 8 / 7).next_power_of_two();
        let bytes = places * (size_of::<([SurfaceNode; 2], f64)>() + 1) * 3 / 2;
        assert!(bytes as u64 <= 100 * PairMemo::<f64>::bytes_per_pair(), "{bytes} bytes");
    }
}
