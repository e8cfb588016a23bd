//! The nodes of a hop map: every N-th post of a DEM, and the blocks of nodes that are the units of parallel work.

use crate::{
    quantity::MapPoint,
    terrain::{Dem, GeoReference},
};

/// Side of a block, nodes. Smaller blocks bound their relief, and so their reach, more tightly; larger ones cost less memory and
/// scheduling. Not tuned: a block of 256 nodes is some milliseconds of work.
pub(super) const BLOCK: usize = 16;

/// A post by row and column from the north-west.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Post {
    /// Row, from the north.
    pub row: usize,
    /// Column, from the west.
    pub col: usize,
}

/// Every `stride`-th post of a DEM, starting at the north-west post.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeLattice {
    /// Rows of nodes.
    pub rows: usize,
    /// Columns of nodes.
    pub cols: usize,
    /// Posts from one node to the next.
    pub stride: usize,
    /// Columns of posts.
    post_cols: usize,
}

impl NodeLattice {
    /// The nodes of a DEM; `stride` at least 1.
    pub fn new(dem: &Dem, stride: usize) -> Self {
        let stride = stride.max(1);
        Self { rows: (dem.rows() - 1) / stride + 1, cols: (dem.cols() - 1) / stride + 1, stride, post_cols: dem.cols() }
    }

    /// How many nodes there are.
    pub fn count(&self) -> usize {
        self.rows * self.cols
    }

    /// The node's number, row after row.
    pub fn index(&self, node: Post) -> usize {
        node.row * self.cols + node.col
    }

    /// The node with a number.
    pub fn node(&self, index: usize) -> Post {
        Post { row: index / self.cols, col: index % self.cols }
    }

    /// The post of the DEM at a node.
    pub fn post(&self, node: Post) -> Post {
        Post { row: node.row * self.stride, col: node.col * self.stride }
    }

    /// The index of that post among the DEM's elevations.
    pub(super) fn post_index(&self, node: Post) -> usize {
        (node.row * self.post_cols + node.col) * self.stride
    }

    /// The node nearest to a position on the map; ties go north and west.
    ///
    /// A position outside the DEM's bounds gives the nearest node of the border.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the lattice first")]
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    pub fn nearest(&self, map: &GeoReference, at: MapPoint) -> Post {
        let away = at - map.north_west();
        let nearest = |steps: f64, count: usize| (steps / self.stride as f64 - 0.5).ceil().clamp(0.0, (count - 1) as f64) as usize;
        Post { row: nearest(-away.y / map.dy_m(), self.rows), col: nearest(away.x / map.dx_m(), self.cols) }
    }

    /// The number of blocks, down and across.
    pub(crate) fn blocks(&self) -> (usize, usize) {
        (self.rows.div_ceil(BLOCK), self.cols.div_ceil(BLOCK))
    }

    /// The block of a node, row after row.
    pub(crate) fn block_of(&self, node: Post) -> usize {
        (node.row / BLOCK) * self.blocks().1 + node.col / BLOCK
    }

    /// The nodes of a block, row after row.
    pub(crate) fn nodes_of(&self, block: usize) -> impl Iterator<Item = Post> + use<> {
        let across = self.blocks().1;
        let (row, col) = (block / across * BLOCK, block % across * BLOCK);
        let cols = col..(col + BLOCK).min(self.cols);
        (row..(row + BLOCK).min(self.rows)).flat_map(move |row| cols.clone().map(move |col| Post { row, col }))
    }
}
