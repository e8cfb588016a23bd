//! The nodes of one BFS layer as a bitmap, so that nodes far from the layer are skipped after reading a few words.

use super::{NodeLattice, Post};
use crate::ground::Offset;

/// Bits in a word.
const WORD: usize = u64::BITS as usize;

/// A bitmap of the nodes of a lattice that belong to one BFS layer.
#[derive(Clone, Debug)]
pub(super) struct LayerBits {
    rows: usize,
    words_in_row: usize,
    words: Vec<u64>,
    /// Whether each row has any node.
    occupied: Vec<bool>,
}

impl LayerBits {
    /// An empty layer.
    pub(super) fn none(lattice: NodeLattice) -> Self {
        let words_in_row = lattice.cols.div_ceil(WORD);
        Self { rows: lattice.rows, words_in_row, words: vec![0; words_in_row * lattice.rows], occupied: vec![false; lattice.rows] }
    }

    /// Removes all nodes.
    pub(super) fn clear(&mut self) {
        for (row, occupied) in self.occupied.iter_mut().enumerate().filter(|(_, occupied)| **occupied) {
            self.words[row * self.words_in_row..][..self.words_in_row].fill(0);
            *occupied = false;
        }
    }

    /// Adds a node.
    pub(super) fn insert(&mut self, node: Post) {
        self.words[node.row * self.words_in_row + node.col / WORD] |= 1 << (node.col % WORD);
        self.occupied[node.row] = true;
    }

    /// Whether any node of the layer lies in a disc around a node.
    #[inline]
    pub(super) fn any_in(&self, disc: &Disc, node: Post) -> bool {
        disc.half_widths.iter().enumerate().any(|(away, &half_width)| {
            let below = node.row + away;
            self.any_in_row(below, node.col, half_width)
                || node.row.checked_sub(away).is_some_and(|row| self.any_in_row(row, node.col, half_width))
        })
    }

    /// Whether any node of a row of the layer lies within `half_width` columns.
    #[inline]
    fn any_in_row(&self, row: usize, col: usize, half_width: usize) -> bool {
        if row >= self.rows || !self.occupied[row] {
            return false;
        }
        let words = &self.words[row * self.words_in_row..][..self.words_in_row];
        let (first, last) = (col.saturating_sub(half_width), col + half_width);
        let (from, to) = (first / WORD, (last / WORD).min(self.words_in_row - 1));
        let ahead = u64::MAX << (first % WORD);
        let behind = if last / WORD == to { u64::MAX >> (WORD - 1 - last % WORD) } else { u64::MAX };
        if from == to {
            return words[from] & ahead & behind != 0;
        }
        words[from] & ahead != 0 || words[to] & behind != 0 || words[from + 1..to].iter().any(|&word| word != 0)
    }
}

/// The extent of a disc of offsets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Disc {
    /// For each row from the middle one, the number of columns to either side.
    half_widths: Vec<usize>,
    /// The greatest half-width.
    widest: usize,
}

impl Disc {
    /// The disc of the nearest offsets, which are symmetric about the node.
    pub(super) fn of(offsets: &[Offset]) -> Self {
        let mut half_widths = Vec::new();
        for offset in offsets {
            let (rows, cols) = (offset.rows.unsigned_abs() as usize, offset.cols.unsigned_abs() as usize);
            if half_widths.len() <= rows {
                half_widths.resize(rows + 1, 0);
            }
            half_widths[rows] = half_widths[rows].max(cols);
        }
        let widest = half_widths.iter().copied().max().unwrap_or(0);
        Self { half_widths, widest }
    }

    /// Whether all nodes of a disc around a node lie on the lattice.
    pub(super) fn is_inside(&self, lattice: NodeLattice, node: Post) -> bool {
        let down = self.half_widths.len().saturating_sub(1);
        let inside = |at: usize, reach: usize, count: usize| at >= reach && at + reach < count;
        inside(node.row, down, lattice.rows) && inside(node.col, self.widest, lattice.cols)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ballistics::limits::ClearanceProfile,
        ground::{OffsetTable, Spacing},
        quantity::MapPoint,
        terrain::{Dem, GeoReference},
    };

    fn lattice(rows: usize, cols: usize) -> NodeLattice {
        let map = GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 1.0).unwrap();
        NodeLattice::new(&Dem::new(rows, cols, vec![0.0; rows * cols], map).unwrap(), 1)
    }

    fn offsets(lattice: NodeLattice, dx_m: f64, range_m: f64) -> Vec<Offset> {
        let spacing = Spacing { dx_m, dy_m: 1.0, stride: 1, node_cols: lattice.cols, post_cols: lattice.cols };
        OffsetTable::new(spacing, range_m, (lattice.rows, lattice.cols), ClearanceProfile::NONE, |_| (-1.0, 1.0)).offsets
    }

    /// The same offset by offset: whether the disc contains the node, and whether it lies on the lattice completely.
    fn plainly(lattice: NodeLattice, offsets: &[Offset], about: Post, node: Post) -> (bool, bool) {
        let at = |offset: &Offset| {
            let row = about.row.checked_add_signed(offset.rows as isize).filter(|&row| row < lattice.rows)?;
            let col = about.col.checked_add_signed(offset.cols as isize).filter(|&col| col < lattice.cols)?;
            Some(Post { row, col })
        };
        let meets = offsets.iter().any(|offset| at(offset) == Some(node)) || about == node;
        (meets, offsets.iter().all(|offset| at(offset).is_some()))
    }

    /// All pairs of positions on lattices with less than one word, one word and several words per row; some discs are wider than a
    /// word.
    #[test]
    fn discs_meet_the_nodes_that_their_offsets_lead_to() {
        let (mut met, mut missed, mut within) = (0, 0, 0);
        for (rows, cols, dx_m, range_m) in
            [(7, 9, 1.0, 2.5), (4, 64, 0.5, 3.2), (3, 200, 0.25, 20.0), (11, 131, 1.0, 4.0), (2, 65, 3.0, 1.0)]
        {
            let lattice = lattice(rows, cols);
            let offsets = offsets(lattice, dx_m, range_m);
            let disc = Disc::of(&offsets);
            let mut layer = LayerBits::none(lattice);
            for node in (0..lattice.count()).step_by(3).map(|index| lattice.node(index)) {
                layer.clear();
                layer.insert(node);
                for about in (0..lattice.count()).map(|index| lattice.node(index)) {
                    let (meets, inside) = plainly(lattice, &offsets, about, node);
                    assert_eq!(layer.any_in(&disc, about), meets, "{rows} x {cols}: {node:?} from {about:?}");
                    assert_eq!(disc.is_inside(lattice, about), inside, "{rows} x {cols}: {about:?}");
                    (met, missed, within) = (met + usize::from(meets), missed + usize::from(!meets), within + usize::from(inside));
                }
            }
        }
        assert!(met > 1_000 && missed > 1_000 && within > 1_000, "{met} met, {missed} missed, {within} within");
    }
}
