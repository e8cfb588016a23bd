//! The nodes of a hop map: every N-th post of a DEM, or N points for every post, and the blocks of nodes that are the units of parallel work.

use crate::{
    ground::MapPosition,
    quantity::MapPoint,
    terrain::{Dem, GeoReference, points},
};

/// Side of a block, nodes. Smaller blocks bound their relief, and so their reach, more tightly; larger ones cost less memory and
/// scheduling. Not tuned: a block of 256 nodes is some milliseconds of work.
pub(super) const BLOCK: usize = 16;

/// A node by row and column from the north-west: a post, or a point between posts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Post {
    /// Row, from the north.
    pub row: usize,
    /// Column, from the west.
    pub col: usize,
}

/// Every `stride`-th post of a DEM, or the lattice of `per_post` nodes a post spacing, starting at the north-west post.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeLattice {
    /// Rows of nodes.
    pub rows: usize,
    /// Columns of nodes.
    pub cols: usize,
    /// Posts from one node to the next; 1 if there are several nodes a post.
    pub stride: usize,
    /// Nodes a post spacing: 1 unless the lattice is finer than the posts.
    pub per_post: usize,
    /// Columns of the raster of heights: of posts, or of nodes where these are finer.
    raster_cols: usize,
}

impl NodeLattice {
    /// The nodes of a DEM; `stride` at least 1.
    pub fn new(dem: &Dem, stride: usize) -> Self {
        let stride = stride.max(1);
        let (rows, cols) = ((dem.rows() - 1) / stride + 1, (dem.cols() - 1) / stride + 1);
        Self { rows, cols, stride, per_post: 1, raster_cols: dem.cols() }
    }

    /// The lattice of `per_post` nodes a post spacing; 0 counts as 1.
    pub fn finer(dem: &Dem, per_post: usize) -> Self {
        let per_post = per_post.max(1);
        let [rows, cols] = [dem.rows(), dem.cols()].map(|posts| points(posts, per_post));
        Self { rows, cols, stride: 1, per_post, raster_cols: cols }
    }

    /// The position of the nodes as a raster, on the map of the posts.
    #[must_use]
    pub fn map(&self, posts: &GeoReference) -> GeoReference {
        if self.per_post > 1 { posts.finer(self.per_post) } else { posts.every(self.stride) }
    }

    /// Where a node lies on the map of the posts: exactly on the post where it is one.
    pub fn at(&self, posts: &GeoReference, node: Post) -> MapPoint {
        let Post { row, col } = self.in_raster(node);
        if self.per_post == 1 { posts.post(row, col) } else { posts.between_posts(self.per_post, (col, row)) }
    }

    /// A node on the triangulated DEM; `None` without elevation.
    pub fn position(&self, dem: &Dem, node: Post) -> Option<MapPosition> {
        let Post { row, col } = self.in_raster(node);
        let z_m = if self.per_post == 1 { dem.elevation(row, col) } else { dem.height_between_posts(self.per_post, (col, row)) }?;
        Some(MapPosition { at: self.at(dem.georeference(), node), z_m })
    }

    /// How many nodes there are.
    pub fn count(&self) -> usize {
        self.rows.saturating_mul(self.cols)
    }

    /// The node's number, row after row.
    pub fn index(&self, node: Post) -> usize {
        node.row * self.cols + node.col
    }

    /// The node with a number.
    pub fn node(&self, index: usize) -> Post {
        Post { row: index / self.cols, col: index % self.cols }
    }

    /// The post of the DEM at a node; of several nodes a post, the one to its north-west.
    pub fn post(&self, node: Post) -> Post {
        Post { row: node.row * self.stride / self.per_post, col: node.col * self.stride / self.per_post }
    }

    /// The row and column of a node in the raster of heights.
    pub(super) fn in_raster(&self, node: Post) -> Post {
        Post { row: node.row * self.stride, col: node.col * self.stride }
    }

    /// The index of a node in the raster of heights.
    pub(super) fn raster_index(&self, node: Post) -> usize {
        (node.row * self.raster_cols + node.col) * self.stride
    }

    /// The node nearest to a position on the map; ties go north and west.
    ///
    /// A position outside the DEM's bounds gives the nearest node of the border.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the lattice first")]
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    pub fn nearest(&self, map: &GeoReference, at: MapPoint) -> Post {
        let away = at - map.north_west();
        let (stride, per_post) = (self.stride as f64, self.per_post as f64);
        let nearest = |steps: f64, count: usize| (steps / stride * per_post - 0.5).ceil().clamp(0.0, (count - 1) as f64) as usize;
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
