//! Rasters of which parts are decoded on demand, with the checks that the whole raster would get.

use std::cell::Cell;

use super::dem::Posts;
use super::format::ReadContext;
use super::stored::{Scaling, StoredStep, judge};
use super::void::Marks;
use super::{Dem, DemFile, NoDataRule, PostLattice, TerrainError, Window};

/// An open file of one format.
pub(super) trait StoredParts {
    /// The lattice of all posts.
    fn lattice(&self) -> &PostLattice;

    /// Whether the file stores the southernmost row first.
    fn south_up(&self) -> bool;

    /// From stored numbers to elevations.
    fn scaling(&self) -> Scaling;

    /// The step of the stored numbers.
    fn step(&self) -> StoredStep;

    /// The elevations of a window, row after row from the north, NaN for gaps.
    fn window(&self, window: Window) -> Result<Vec<f64>, TerrainError>;
}

/// An open file whose windows pass the mask beside it, and the judge of void values.
pub(super) struct CheckedParts<T> {
    parts: T,
    context: ReadContext,
    marks: Marks,
    /// Whether the whole raster was read and its marks found to be ground.
    cleared: Cell<bool>,
}

impl<T: StoredParts> CheckedParts<T> {
    pub(super) fn new(parts: T, context: ReadContext) -> Self {
        let marks = Marks::of_raster((f64::NEG_INFINITY, f64::INFINITY), parts.scaling());
        Self { parts, context, marks, cleared: Cell::new(false) }
    }

    /// A window with the gaps of the mask.
    fn masked(&self, window: Window) -> Result<Vec<f64>, TerrainError> {
        let mut posts = self.parts.window(window)?;
        if let Some(shown) = self.context.sidecars.shown(self.parts.lattice(), window, self.parts.south_up())? {
            posts.iter_mut().zip(shown).filter(|(_, shown)| !shown).for_each(|(z_m, _)| *z_m = f64::NAN);
        }
        Ok(posts)
    }

    /// Judges the whole raster: a block of marks may extend beyond a window.
    fn judge_whole(&self) -> Result<(), TerrainError> {
        let lattice = self.parts.lattice();
        let all = Window { first_row: 0, first_col: 0, rows: lattice.rows(), cols: lattice.cols() };
        let dem = Dem::from_lattice(lattice.clone(), Posts::Double(self.masked(all)?).narrowed())?;
        judge(&dem, self.context.no_data, self.parts.scaling())?;
        self.cleared.set(true);
        Ok(())
    }
}

impl<T: StoredParts> DemFile for CheckedParts<T> {
    fn lattice(&self) -> &PostLattice {
        self.parts.lattice()
    }

    fn window(&self, window: Window) -> Result<Vec<f64>, TerrainError> {
        let posts = self.masked(window)?;
        let doubted = self.context.no_data == NoDataRule::AsStated && !self.cleared.get();
        if doubted && self.marks.are_in(&posts) {
            self.judge_whole()?;
        }
        Ok(posts)
    }

    fn warnings(&self, range_m: (f64, f64)) -> Vec<String> {
        let step = self.parts.step().warning(range_m, self.lattice().georeference().step_m());
        self.context.sidecars.warnings().iter().cloned().chain(step).collect()
    }
}
