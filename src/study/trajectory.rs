//! A path in time.

use std::io::{self, Write};

use super::Case;
use crate::{
    path::{HopPath, Timetable, TimetableError, Totals},
    report::write_trajectory_csv,
};

/// Why a path in time is not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrajectoryError {
    /// A step that does not fit.
    #[error(transparent)]
    Timetable(#[from] TimetableError),
    /// The writer.
    #[error("cannot be written ({0})")]
    Write(#[from] io::Error),
}

impl Case {
    /// Writes a path over this case in time, as CSV; only the header without a path.
    ///
    /// `step_s`: s; `None`: as [`Timetable::new`] chooses it.
    ///
    /// # Errors
    /// [`TrajectoryError`].
    pub fn write_trajectory(&self, path: Option<&HopPath>, step_s: Option<f64>, out: impl Write) -> Result<(), TrajectoryError> {
        let none = HopPath { hops: Vec::new(), totals: Totals::default() };
        let hopper = self.prepared.chain.hopper().limits();
        let table = Timetable::new(path.unwrap_or(&none), hopper, self.scenario.body.gravity.m_s2(), step_s)?;
        Ok(write_trajectory_csv(&table, self.map_knowledge(), self.prepared.projection.as_ref(), out)?)
    }
}
