//! The union of the lofts that facets block.

use crate::quantity::{FacetId, SlopeInterval};

/// A connected set of blocked lofts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockedSpan {
    /// The lofts.
    pub lofts: SlopeInterval,
    /// The facet that the flattest of its arcs grazes.
    pub lower: FacetId,
    /// The facet that the steepest of its arcs grazes.
    pub upper: FacetId,
}

/// A union of blocked lofts, ascending and disjoint.
#[derive(Clone, Debug, Default)]
pub(in crate::ground) struct BlockedLofts {
    spans: Vec<BlockedSpan>,
}

/// A free interval of lofts, and the facets that bound it where facets do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::ground) struct FreeSpan {
    pub(in crate::ground) lofts: SlopeInterval,
    pub(in crate::ground) lower: Option<FacetId>,
    pub(in crate::ground) upper: Option<FacetId>,
}

impl BlockedLofts {
    pub(in crate::ground) fn clear(&mut self) {
        self.spans.clear();
    }

    pub(in crate::ground) fn spans(&self) -> &[BlockedSpan] {
        &self.spans
    }

    /// Adds the lofts that a facet blocks; intervals that touch become one.
    pub(in crate::ground) fn insert(&mut self, lofts: SlopeInterval, facet: FacetId) {
        if lofts.is_empty() {
            return;
        }
        let mut span = BlockedSpan { lofts, lower: facet, upper: facet };
        let first = self.spans.partition_point(|known| known.lofts.upper < lofts.lower);
        let last = first + self.spans[first..].partition_point(|known| known.lofts.lower <= lofts.upper);
        for known in &self.spans[first..last] {
            // Of two facets that share an end, the first of the mesh: the order of the cut does not show.
            if (known.lofts.lower, known.lower) < (span.lofts.lower, span.lower) {
                (span.lofts.lower, span.lower) = (known.lofts.lower, known.lower);
            }
            if known.lofts.upper > span.lofts.upper || (known.lofts.upper == span.lofts.upper && known.upper < span.upper) {
                (span.lofts.upper, span.upper) = (known.lofts.upper, known.upper);
            }
        }
        if first == last {
            self.spans.insert(first, span);
        } else {
            self.spans[first] = span;
            self.spans.drain(first + 1..last);
        }
    }

    /// Whether one span blocks a whole interval.
    pub(in crate::ground) fn covers(&self, lofts: SlopeInterval) -> bool {
        let at = self.spans.partition_point(|known| known.lofts.upper < lofts.upper);
        self.spans.get(at).is_some_and(|span| span.lofts.lower <= lofts.lower)
    }

    /// The parts of an interval that are not blocked, ascending.
    ///
    /// A span is open, since arcs of its ends graze: an end of the interval that is also one of a span is free.
    pub(in crate::ground) fn free_in(&self, within: SlopeInterval) -> impl Iterator<Item = FreeSpan> + '_ {
        let ends = self.spans.iter().map(Some).chain([None]);
        let mut from = (within.lower, None);
        let mut done = false;
        ends.filter_map(move |span| {
            if done {
                return None;
            }
            let (upper, facet) = span.map_or((f64::INFINITY, None), |span| (span.lofts.lower, Some(span.lower)));
            let (lower, by) = from;
            if let Some(span) = span
                && span.lofts.upper > lower
            {
                from = (span.lofts.upper, Some(span.upper));
            }
            done = from.0 > within.upper;
            let lofts = SlopeInterval { lower, upper: upper.min(within.upper) };
            let facet = facet.filter(|_| upper < within.upper);
            // Between two spans, and below the first, an arc needs room.
            let has_room = if facet.is_some() { lofts.lower < lofts.upper } else { !lofts.is_empty() };
            has_room.then_some(FreeSpan { lofts, lower: by, upper: facet })
        })
    }
}
