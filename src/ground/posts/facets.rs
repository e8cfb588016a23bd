//! The six facets around a post.
//!
//! Every square of four posts is split from its north-west to its south-east post, so six facets meet at a post, between the
//! directions of six neighbours:
//!
//! ```text
//!   NW---N           0: E to SE     3: W to NW
//!    | \4|5\         1: SE to S     4: NW to N
//!    |3 \|   \       2: S to W      5: N to E
//!    W---A---E
//!     \ 2|\ 0|
//!       \|1 \|
//!        S---SE
//! ```

/// A neighbour of a post: columns to the east, rows to the south.
type Neighbour = (i32, i32);

const HERE: Neighbour = (0, 0);
const EAST: Neighbour = (1, 0);
const SOUTH_EAST: Neighbour = (1, 1);
const SOUTH: Neighbour = (0, 1);
const WEST: Neighbour = (-1, 0);
const NORTH_WEST: Neighbour = (-1, -1);
const NORTH: Neighbour = (0, -1);

/// For each facet, the posts whose heights give its gradient: (east - west) / dx and (north - south) / dy. They include all three
/// posts of the facet.
pub(super) const CORNERS: [[Neighbour; 4]; 6] = [
    [EAST, HERE, EAST, SOUTH_EAST],
    [SOUTH_EAST, SOUTH, HERE, SOUTH],
    [HERE, WEST, HERE, SOUTH],
    [HERE, WEST, NORTH_WEST, WEST],
    [NORTH, NORTH_WEST, NORTH, HERE],
    [EAST, HERE, NORTH, HERE],
];

/// The facet under a heading from a post, or the two facets on both sides of an edge that the heading runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Facets {
    first: u8,
    second: u8,
}

impl Facets {
    /// As bits; facet 0 is the lowest.
    #[inline]
    pub(super) const fn bits(self) -> u8 {
        (1 << self.first) | (1 << self.second)
    }

    /// Whether the heading runs along an edge of facets.
    #[inline]
    pub(super) const fn along_edge(self) -> bool {
        self.first != self.second
    }

    /// The number of the facet, or of the first of two.
    #[inline]
    pub(super) const fn first(self) -> usize {
        self.first as usize
    }

    /// Their numbers.
    #[inline]
    pub(super) fn numbers(self) -> impl Iterator<Item = usize> {
        let second = if self.along_edge() { Some(usize::from(self.second)) } else { None };
        std::iter::once(usize::from(self.first)).chain(second)
    }
}

/// The facets towards an offset of `cols` to the east and `rows` to the south, not both 0.
pub(super) fn facets_towards(cols: i32, rows: i32) -> Facets {
    let [before, after] = match (cols.signum(), rows.signum()) {
        (1, 0) => [5, 0],
        (0, 1) => [1, 2],
        (-1, 0) => [2, 3],
        (0, -1) => [4, 5],
        (1, 1) if cols == rows => [0, 1],
        (-1, -1) if cols == rows => [3, 4],
        (1, 1) if cols > rows => [0, 0],
        (1, 1) => [1, 1],
        (-1, 1) => [2, 2],
        (-1, -1) if cols < rows => [3, 3],
        (-1, -1) => [4, 4],
        _ => [5, 5],
    };
    Facets { first: before, second: after }
}
