//! The lattice of nodes on a DEM, finer than its posts. On which facet, edge or post a node lies is decided in integers.

use crate::{
    ground::MapPosition,
    quantity::MapPoint,
    terrain::{Dem, GeoReference, points},
};

/// The most nodes a post spacing that are chosen automatically: nodes grow with its square, pairs of nodes with its fourth power.
pub const NODES_PER_POST_MOST: u32 = 16;

/// Nodes that one hop spans at least where the lattice is chosen automatically. Fewer cost hops, since a hop ends on a node: up to a
/// node's distance of each is lost. More cost time with the fourth power.
const NODES_PER_HOP: f64 = 8.0;

/// How many nodes of the lattice there are for each post spacing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodesPerPost(u32);

impl NodesPerPost {
    /// So many that neighbouring nodes are at most this far apart: `n = ceil(post spacing / node spacing)`. At least 1; a spacing that is no
    /// positive number gives the most that 32 bits hold.
    ///
    /// ```
    /// use chta::planner::NodesPerPost;
    /// assert_eq!([5.0, 2.5, 1.3, 9.0].map(|spacing_m| NodesPerPost::at_most_m(spacing_m, 5.0).get()), [1, 2, 4, 1]);
    /// ```
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates")]
    pub fn at_most_m(node_spacing_m: f64, post_spacing_m: f64) -> Self {
        // A spacing that divides that of the posts does so up to rounding.
        Self(((post_spacing_m / node_spacing_m * (1.0 - 1e-12)).ceil() as u32).max(1))
    }

    /// So many that one hop over level ground, `v^2 / g` long, spans some 8 to 12 nodes; from 1 to [`NODES_PER_POST_MOST`].
    ///
    /// ```
    /// use chta::planner::NodesPerPost;
    /// // A hop of 22.2 m on posts 5 m apart: 4.4 posts, so that two nodes a post give 8.9 nodes.
    /// assert_eq!(NodesPerPost::auto(22.2, 5.0).get(), 2);
    /// assert_eq!([100.0, 40.0, 39.0, 0.1].map(|hop_m| NodesPerPost::auto(hop_m, 5.0).get()), [1, 1, 2, 16]);
    /// ```
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates")]
    pub fn auto(hop_m: f64, post_spacing_m: f64) -> Self {
        Self(((NODES_PER_HOP * post_spacing_m / hop_m).ceil() as u32).clamp(1, NODES_PER_POST_MOST))
    }

    /// This number; 0 counts as 1.
    pub fn of(per_post: usize) -> Self {
        Self(u32::try_from(per_post).unwrap_or(u32::MAX).max(1))
    }

    /// The number.
    pub const fn get(self) -> u32 {
        self.0
    }
}

/// The points `(i / n, j / n)` of the lattice of posts: `i` east and `j` south of the north-west post.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceLattice {
    map: GeoReference,
    n: usize,
    rows: usize,
    cols: usize,
}

impl SurfaceLattice {
    /// The lattice over a DEM.
    pub fn new(dem: &Dem, n: NodesPerPost) -> Self {
        let n = n.get() as usize;
        Self { map: dem.georeference().clone(), n, rows: points(dem.rows(), n), cols: points(dem.cols(), n) }
    }

    /// How many nodes it has.
    pub const fn count(&self) -> usize {
        self.rows.saturating_mul(self.cols)
    }

    /// Nodes a post spacing.
    pub const fn nodes_per_post(&self) -> usize {
        self.n
    }

    /// The greater distance of neighbouring nodes in a row or a column, m.
    pub fn spacing_m(&self) -> f64 {
        let (aside_m, down_m) = self.spacings_m();
        aside_m.max(down_m)
    }

    /// The distances of neighbouring nodes in a row and in a column, m.
    #[expect(clippy::cast_precision_loss, reason = "counts of nodes stay far below 2^53")]
    pub(super) fn spacings_m(&self) -> (f64, f64) {
        (self.map.dx_m() / self.n as f64, self.map.dy_m() / self.n as f64)
    }

    /// Its rows and columns.
    pub(super) const fn size(&self) -> (usize, usize) {
        (self.rows, self.cols)
    }

    /// How many rows and columns of nodes are farther apart than a distance, m; at most all.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "not negative; the cast saturates"
    )]
    pub(super) fn cells_within(&self, distance_m: f64) -> (usize, usize) {
        let cells = |step_m: f64| (distance_m / step_m * self.n as f64) as usize;
        (cells(self.map.dy_m()).saturating_add(1).min(self.rows), cells(self.map.dx_m()).saturating_add(1).min(self.cols))
    }

    /// The row and column of a node of the lattice near a position.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "clamped to the lattice first"
    )]
    pub(super) fn cell_near(&self, at: MapPoint) -> (usize, usize) {
        let away = at - self.map.north_west();
        let cell = |along_m: f64, step_m: f64, count: usize| {
            (along_m / step_m * self.n as f64).round().clamp(0.0, (count - 1) as f64) as usize
        };
        (cell(-away.y, self.map.dy_m(), self.rows), cell(away.x, self.map.dx_m(), self.cols))
    }

    /// The number of a node, row after row from the north-west.
    pub const fn index(&self, i: usize, j: usize) -> usize {
        j * self.cols + i
    }

    /// The node of a number, as `(i, j)`.
    pub const fn node(&self, index: usize) -> (usize, usize) {
        (index % self.cols, index / self.cols)
    }

    /// Where a node lies on the map: exactly on the post where it is one.
    pub fn at(&self, node: (usize, usize)) -> MapPoint {
        self.map.between_posts(self.n, node)
    }

    /// A node on the ground ([`Dem::height_between_posts`]); `None` where its facet, or every facet that meets there, has no elevation.
    pub fn position(&self, dem: &Dem, node: (usize, usize)) -> Option<MapPosition> {
        dem.height_between_posts(self.n, node).map(|z_m| MapPosition { at: self.at(node), z_m })
    }

    /// Whether a straight line between two nodes runs along edges of the triangulated DEM.
    pub const fn runs_along_edges(&self, (i, j): (usize, usize), (k, l): (usize, usize)) -> bool {
        let column = i == k && i.is_multiple_of(self.n);
        let row = j == l && j.is_multiple_of(self.n);
        // South-east and back: both differences are equal, and the line meets a post.
        let diagonal = k.wrapping_sub(i) == l.wrapping_sub(j) && i.abs_diff(j).is_multiple_of(self.n);
        column || row || diagonal
    }

    /// The nodes of a rectangle about a position, in rows and columns.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "clamped to the lattice first"
    )]
    pub fn about(&self, at: MapPoint, distance_m: f64) -> impl Iterator<Item = (usize, usize)> + use<> {
        let away = at - self.map.north_west();
        let range = |middle_m: f64, step_m: f64, count: usize| {
            let last = (count - 1) as f64;
            let [from, to] = [middle_m - distance_m, middle_m + distance_m].map(|end_m| end_m / step_m * self.n as f64);
            from.ceil().clamp(0.0, last) as usize..=to.floor().clamp(0.0, last) as usize
        };
        let (cols, rows) = (range(away.x, self.map.dx_m(), self.cols), range(-away.y, self.map.dy_m(), self.rows));
        rows.flat_map(move |j| cols.clone().map(move |i| (i, j)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        draw::Draw,
        ground::DemGround,
        terrain::{OverlaidDem, Overlays},
        world::{Gravity, Hopper, RestSlope, SurfaceProperties},
    };

    fn dem(draw: &mut Draw) -> Dem {
        let heights = (0..5 * 6).map(|_| if draw.chance(0.08) { f64::NAN } else { draw.uniform(-3.0, 3.0) }).collect();
        Dem::new(5, 6, heights, GeoReference::local(MapPoint::new(3.1, 40.7), 1.1, 1.3).unwrap()).unwrap()
    }

    /// The integer rules and the ground's own lookup, in floating point, agree on every node.
    #[test]
    fn a_node_lies_on_the_ground_that_a_slice_finds() {
        let draw = &mut Draw::seeded(1711);
        let mut nodes = 0;
        for n in [1, 2, 3, 7] {
            let dem = dem(draw);
            let lattice = SurfaceLattice::new(&dem, NodesPerPost(n));
            let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
            let hopper = Hopper::with_speeds(1.0, 1.0).unwrap();
            let ground =
                DemGround::new(OverlaidDem::new(dem.clone(), Overlays::default()), &hopper, Gravity::new(1.0).unwrap(), &surface);
            for index in 0..lattice.count() {
                let node = lattice.node(index);
                assert_eq!(lattice.index(node.0, node.1), index);
                let found = ground.position(lattice.at(node));
                match (lattice.position(&dem, node), found) {
                    (Some(node), Some(found)) => assert!((node.z_m - found.z_m).abs() < 1e-9, "{node:?} {found:?}"),
                    // Two posts make an edge; whether a facet beside it is there is left to the hops from it.
                    (Some(_), None) => assert!(
                        node.0.is_multiple_of(n as usize)
                            || node.1.is_multiple_of(n as usize)
                            || node.0 % n as usize == node.1 % n as usize
                    ),
                    (None, found) => assert_eq!(found, None, "{node:?} of {n}"),
                }
                nodes += 1;
            }
        }
        assert!(nodes > 900, "{nodes}");
    }

    /// The sets for n and 2 n nest, bit by bit.
    #[test]
    fn a_finer_lattice_has_the_nodes_of_a_coarser_one() {
        let dem = dem(&mut Draw::seeded(1712));
        for n in 1..9 {
            let [coarse, fine] = [n, 2 * n].map(|n| SurfaceLattice::new(&dem, NodesPerPost(n)));
            for (i, j) in (0..coarse.count()).map(|index| coarse.node(index)) {
                assert_eq!(coarse.at((i, j)), fine.at((2 * i, 2 * j)));
            }
        }
    }

    #[test]
    fn lines_along_edges_are_known_by_their_nodes() {
        let dem = dem(&mut Draw::seeded(1713));
        let lattice = SurfaceLattice::new(&dem, NodesPerPost(3));
        for (from, to, along) in [
            ((3, 1), (3, 8), true),
            ((4, 1), (4, 8), false),
            ((1, 6), (9, 6), true),
            ((1, 5), (9, 5), false),
            ((4, 1), (7, 4), true),
            ((7, 4), (4, 1), true),
            ((1, 4), (3, 6), true),
            ((4, 2), (6, 4), false),
            ((6, 0), (3, 3), false),
            ((0, 0), (5, 4), false),
        ] {
            assert_eq!(lattice.runs_along_edges(from, to), along, "{from:?} to {to:?}");
        }
    }
}
