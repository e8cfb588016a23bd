//! One take-off against all landings, one direction at a time.

mod table;

use std::ops::Range;

pub use table::LandingTable;

use crate::{
    chain::{Direction, Station},
    quantity::SlopeInterval,
    world::Limit,
};

/// One take-off against many landings: all limits, as [`HopTest::loft`](super::HopTest::loft) judges them, at a fraction of its cost.
///
/// Holds the working memory, which one sweep hands to the next: make one per thread.
#[derive(Clone, Debug)]
pub struct Sweep<'a> {
    table: &'a LandingTable<'a>,
}

impl<'a> Sweep<'a> {
    /// For sweeps over a table of landings.
    pub const fn new(table: &'a LandingTable<'a>) -> Self {
        Self { table }
    }

    /// Judges every landing of a range of the table's stations that lies in a direction from the take-off, nearest first.
    ///
    /// `visit` is given each one's index and what [`HopTest::loft`](super::HopTest::loft) says of the pair: the same verdict.
    pub fn landings(
        &mut self,
        takeoff: &Station,
        among: Range<usize>,
        direction: Direction,
        mut visit: impl FnMut(usize, Result<SlopeInterval, Limit>),
    ) {
        let stations = self.table.stations();
        let mut judge = |i: usize| visit(i, self.table.test().loft(takeoff, &stations[i]));
        match direction {
            Direction::Forward => {
                let first = among.start + stations[among.clone()].partition_point(|s| s.point.x_m <= takeoff.point.x_m);
                (first..among.end).for_each(&mut judge);
            }
            Direction::Reverse => {
                let end = among.start + stations[among.clone()].partition_point(|s| s.point.x_m < takeoff.point.x_m);
                (among.start..end).rev().for_each(&mut judge);
            }
        }
    }
}
