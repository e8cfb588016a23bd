//! Nodes by square buckets of the floor.

use crate::quantity::MapPoint;

/// The nodes by bucket, with their places, so that a search among them reads one piece of memory after the other.
pub(super) struct Buckets {
    side_m: f64,
    columns: i64,
    rows: i64,
    nodes: Vec<Vec<(u32, MapPoint)>>,
}

/// A node near a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub(super) node: u32,
    /// The square of its distance, m2.
    pub(super) distance_m2: f64,
}

/// The most buckets along a side: beyond it they grow.
const MOST: f64 = 512.0;

impl Buckets {
    /// Empty buckets of about this side over a floor.
    pub(super) fn new(size_m: [f64; 2], side_m: f64) -> Self {
        let side_m = side_m.max(size_m[0] / MOST).max(size_m[1] / MOST);
        #[expect(clippy::cast_possible_truncation, reason = "at most 512")]
        let [columns, rows] = size_m.map(|size_m| (size_m / side_m).floor() as i64 + 1);
        let count = usize::try_from(columns * rows).unwrap_or(1);
        Self { side_m, columns, rows, nodes: vec![Vec::new(); count] }
    }

    #[expect(clippy::cast_possible_truncation, reason = "at most 512")]
    fn cell(&self, at_m: f64, count: i64) -> i64 {
        ((at_m / self.side_m).floor() as i64).clamp(0, count - 1)
    }

    fn bucket(&self, column: i64, row: i64) -> &[(u32, MapPoint)] {
        usize::try_from(row * self.columns + column).ok().and_then(|cell| self.nodes.get(cell)).map_or(&[], Vec::as_slice)
    }

    /// Adds a node.
    pub(super) fn add(&mut self, node: u32, point: MapPoint) {
        let cell = self.cell(point.y, self.rows) * self.columns + self.cell(point.x, self.columns);
        if let Some(bucket) = usize::try_from(cell).ok().and_then(|cell| self.nodes.get_mut(cell)) {
            bucket.push((node, point));
        }
    }

    /// The node nearest to a point; the first node if there is no other.
    pub(super) fn nearest(&self, point: MapPoint) -> u32 {
        let (column, row) = (self.cell(point.x, self.columns), self.cell(point.y, self.rows));
        let (mut best, mut best_m2) = (0, f64::INFINITY);
        for ring in 0..=self.columns.max(self.rows) {
            #[expect(clippy::cast_precision_loss, reason = "at most 512")]
            let inner_m = (ring - 1).max(0) as f64 * self.side_m;
            if best_m2 <= inner_m * inner_m {
                break;
            }
            for j in (row - ring).max(0)..=(row + ring).min(self.rows - 1) {
                let is_end = (j - row).abs() == ring;
                let step = if is_end { 1 } else { (2 * ring).max(1) };
                let mut i = column - ring;
                while i <= column + ring {
                    if (0..self.columns).contains(&i) {
                        for (node, place) in self.bucket(i, j) {
                            let distance_m2 = (place - point).norm_squared();
                            if distance_m2 < best_m2 {
                                (best, best_m2) = (*node, distance_m2);
                            }
                        }
                    }
                    i += step;
                }
            }
        }
        best
    }

    /// The nodes within a distance of a point with the squares of their distances, in the order of the buckets.
    pub(super) fn within(&self, point: MapPoint, radius_m: f64, found: &mut Vec<Near>) {
        found.clear();
        let columns = self.cell(point.x - radius_m, self.columns)..=self.cell(point.x + radius_m, self.columns);
        for row in self.cell(point.y - radius_m, self.rows)..=self.cell(point.y + radius_m, self.rows) {
            for column in columns.clone() {
                let near = |(node, place): &(u32, MapPoint)| Near { node: *node, distance_m2: (place - point).norm_squared() };
                let is_within = |near: &Near| near.distance_m2 <= radius_m * radius_m;
                found.extend(self.bucket(column, row).iter().map(near).filter(is_within));
            }
        }
    }
}
