//! The upper (or lower) envelope of segments by divide and conquer: O(n log n) apart from the crossings.

use super::cut::Segment;

/// Upper or lower envelope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Upper,
    Lower,
}

/// A stretch on which one segment is the outermost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) x_m: [f64; 2],
    /// Index of the segment.
    pub(super) segment: usize,
}

/// The outermost segment of each stretch, from left to right; stretches without a segment are left out.
///
/// Of coincident segments (within the tolerance at both ends of a stretch) the one with the larger cross-slope is used.
pub(super) fn envelope(segments: &[Segment], side: Side, tolerance_m: f64) -> Vec<Piece> {
    let all: Vec<usize> = (0..segments.len()).collect();
    Envelope { segments, side, tolerance_m }.of(&all)
}

struct Envelope<'a> {
    segments: &'a [Segment],
    side: Side,
    tolerance_m: f64,
}

impl Envelope<'_> {
    fn of(&self, numbers: &[usize]) -> Vec<Piece> {
        match numbers {
            [] => Vec::new(),
            [segment] => vec![Piece { x_m: self.segments[*segment].x_m, segment: *segment }],
            _ => {
                let (left, right) = numbers.split_at(numbers.len() / 2);
                self.merged(&self.of(left), &self.of(right))
            }
        }
    }

    fn merged(&self, one: &[Piece], other: &[Piece]) -> Vec<Piece> {
        let mut breaks: Vec<f64> = one.iter().chain(other).flat_map(|piece| piece.x_m).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let mut merged = Vec::with_capacity(one.len() + other.len());
        let (mut one, mut other) = (one.iter().peekable(), other.iter().peekable());
        for pair in breaks.windows(2) {
            let &[from, to] = pair else { continue };
            while one.next_if(|piece| piece.x_m[1] <= from).is_some() {}
            while other.next_if(|piece| piece.x_m[1] <= from).is_some() {}
            let over = |piece: Option<&&Piece>| piece.filter(|piece| piece.x_m[0] <= from).map(|piece| piece.segment);
            match (over(one.peek()), over(other.peek())) {
                (None, None) => {}
                (Some(segment), None) | (None, Some(segment)) => push(&mut merged, Piece { x_m: [from, to], segment }),
                (Some(a), Some(b)) => self.push_outer(&mut merged, [from, to], a, b),
            }
        }
        merged
    }

    /// Adds the outer of two segments over a stretch, or one after the other if they cross.
    fn push_outer(&self, merged: &mut Vec<Piece>, [from, to]: [f64; 2], a: usize, b: usize) {
        let outward = if self.side == Side::Upper { 1.0 } else { -1.0 };
        let ahead = |x_m: f64| outward * (self.segments[a].z_at(x_m) - self.segments[b].z_at(x_m));
        let (begin, end) = (ahead(from), ahead(to));
        if begin.abs() <= self.tolerance_m && end.abs() <= self.tolerance_m {
            let cross_slope = |number: usize| self.segments[number].facet.cross_slope;
            let segment = if cross_slope(b) > cross_slope(a) { b } else { a };
            return push(merged, Piece { x_m: [from, to], segment });
        }
        let crossing = from + (to - from) * (begin / (begin - end));
        let apart = crossing - from > self.tolerance_m && to - crossing > self.tolerance_m;
        if begin * end < 0.0 && apart {
            let (before, after) = if begin > 0.0 { (a, b) } else { (b, a) };
            push(merged, Piece { x_m: [from, crossing], segment: before });
            push(merged, Piece { x_m: [crossing, to], segment: after });
        } else {
            let segment = if begin + end >= 0.0 { a } else { b };
            push(merged, Piece { x_m: [from, to], segment });
        }
    }
}

/// Adds a piece, or extends the last one if it belongs to the same segment.
fn push(pieces: &mut Vec<Piece>, piece: Piece) {
    match pieces.last_mut() {
        Some(last) if last.segment == piece.segment && last.x_m[1] == piece.x_m[0] => last.x_m[1] = piece.x_m[1],
        _ => pieces.push(piece),
    }
}
