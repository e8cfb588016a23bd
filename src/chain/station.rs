//! A position on the chain, and the segment that rules there.

use crate::{
    quantity::{ChainPoint, SegmentId, VertexId},
    world::{Contact, Direction},
};

/// Whether a station is at a vertex or inside a segment. It is at a vertex if its x is the same double; nearby positions are
/// not snapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Site {
    /// At a vertex.
    Vertex(VertexId),
    /// Strictly inside a segment.
    Inside(SegmentId),
}

impl Site {
    /// The indices of the vertices strictly between two sites, the left one first.
    #[inline]
    pub(crate) fn vertices_between(left: Self, right: Self) -> std::ops::Range<usize> {
        let first = match left {
            Self::Vertex(v) => v.index() + 1,
            Self::Inside(s) => s.index() + 1,
        };
        let end = match right {
            Self::Vertex(v) => v.index(),
            Self::Inside(s) => s.index() + 1,
        };
        first..end.max(first)
    }
}

/// A position on the chain, by its x: a station, as in surveying, where it is a position by chainage along a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The point.
    pub point: ChainPoint,
    /// The vertex or segment.
    pub site: Site,
}

/// An x outside the chain.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("x = {x_m} m is off the chain, which reaches from {first_x_m} to {last_x_m} m: choose a point between")]
pub struct OffChain {
    /// The x requested.
    pub x_m: f64,
    /// The x where the chain begins.
    pub first_x_m: f64,
    /// The x where the chain ends.
    pub last_x_m: f64,
}

impl Station {
    /// The segment whose constraints rule a contact here for a direction of travel, on a chain of `segment_count` segments.
    ///
    /// Inside a segment, that segment; at a vertex, the ground ahead for a take-off and the ground just flown over for a
    /// landing (CHTA paper, Definition 2). `None` at the chain's ends where that ground does not exist.
    #[inline]
    pub fn ruling_segment(&self, contact: Contact, direction: Direction, segment_count: usize) -> Option<SegmentId> {
        match self.site {
            Site::Inside(segment) => Some(segment),
            Site::Vertex(vertex) => {
                let after =
                    matches!((contact, direction), (Contact::Takeoff, Direction::Forward) | (Contact::Landing, Direction::Reverse));
                if after {
                    (vertex.index() < segment_count).then_some(SegmentId(vertex.index()))
                } else {
                    vertex.index().checked_sub(1).map(SegmentId)
                }
            }
        }
    }

    /// The segment that both stations lie on, ends included; `None` if they lie on different segments.
    #[inline]
    pub fn shared_segment(&self, other: &Self) -> Option<SegmentId> {
        let range = |site: Site| match site {
            // The segments adjacent to a vertex: the one before and the one after.
            Site::Vertex(v) => (v.index().wrapping_sub(1), v.index()),
            Site::Inside(s) => (s.index(), s.index()),
        };
        let (a, b) = (range(self.site), range(other.site));
        if self.point.x_m == other.point.x_m {
            return None;
        }
        [a.0, a.1].into_iter().find(|&s| s != usize::MAX && (s == b.0 || s == b.1)).map(SegmentId)
    }
}
