//! Where trials come to rest: the probability of each cell of a map.

use std::collections::BTreeMap;

use nalgebra::Point3;

use super::{HopRecord, Observer, TrialRecord};
use crate::{
    ground::{DemGround, NodeLattice},
    quantity::MapPoint,
    terrain::{Dem, KeepOut},
};

/// How many trials rest in each cell that has some, by its number.
type Counts = BTreeMap<usize, u32>;

/// Counts of trials by the cell of the map where they rest: where they end, and after each hop.
///
/// A cell reaches half a spacing in every direction from its post. Each share is one of all trials, so that those of one hop add up to
/// the share of trials that flew the hop and met the ground, and those of the ends to the share that ended on the ground, damaged or whole:
/// the rest left the known ground in flight. Memory grows with the cells met, not with the map.
#[derive(Clone, Debug)]
pub struct RestDensity {
    lattice: NodeLattice,
    dem: Dem,
    trials: u64,
    /// Where trials end.
    ends: Counts,
    /// Where they rest after each hop, from the first.
    hops: Vec<Counts>,
    /// The area whose share is asked for, and how many trials end in it.
    area: Option<(KeepOut, u64)>,
    /// Whether the last hop reported met the ground; before any, the start does.
    stands: bool,
}

/// The cell with the most trials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DensestCell {
    /// Its post.
    pub at: MapPoint,
    /// The share of all trials that end in it.
    pub share: f64,
}

impl RestDensity {
    /// The most hops that are counted each by itself: each is a band of a raster.
    pub const HOPS_MAX: usize = 64;

    /// The most numbers of all bands together; over a large map fewer hops are counted each by itself.
    pub const NUMBERS_MAX: usize = 1 << 26;

    /// No trials, over the posts of a ground; `area`: zones of which the share is asked for, `hops`: how many are counted each by itself, as
    /// far as [`HOPS_MAX`](Self::HOPS_MAX) and [`NUMBERS_MAX`](Self::NUMBERS_MAX) allow.
    pub fn over(ground: &DemGround, hops: usize, area: Option<KeepOut>) -> Self {
        let dem = ground.terrain().dem().clone();
        let lattice = NodeLattice::new(&dem, 1);
        let most = (Self::NUMBERS_MAX / lattice.count().max(1)).saturating_sub(1).min(Self::HOPS_MAX);
        Self {
            hops: vec![Counts::new(); hops.min(most)],
            ends: Counts::new(),
            area: area.map(|area| (area, 0)),
            lattice,
            dem,
            trials: 0,
            stands: true,
        }
    }

    /// How many trials were counted.
    pub const fn trials(&self) -> u64 {
        self.trials
    }

    /// The share of all trials that end in each cell, row by row from the north-west.
    pub fn ends(&self) -> Vec<f64> {
        self.shares(&self.ends)
    }

    /// The share of all trials that rest in each cell after a hop, from 1; `None` for one that is not counted by itself.
    pub fn after_hop(&self, hop: usize) -> Option<Vec<f64>> {
        self.hops.get(hop.checked_sub(1)?).map(|cells| self.shares(cells))
    }

    /// How many hops are counted each by itself.
    pub const fn hops(&self) -> usize {
        self.hops.len()
    }

    /// How many trials ended on the ground.
    pub fn ended_on_ground(&self) -> u64 {
        self.ends.values().map(|count| u64::from(*count)).sum()
    }

    /// How many trials ended in the area, if one was given.
    pub fn ended_in_area(&self) -> Option<u64> {
        self.area.as_ref().map(|(_, count)| *count)
    }

    /// The outlines of the area, for drawing; empty without one.
    pub fn area_outlines(&self) -> Vec<Vec<MapPoint>> {
        self.area.as_ref().map(|(area, _)| area.outlines()).unwrap_or_default()
    }

    /// The cell where most trials end; the first of equals. `None` before any trial.
    pub fn densest(&self) -> Option<DensestCell> {
        let (index, count) = self.ends.iter().rev().max_by_key(|(_, count)| **count)?;
        let at = self.lattice.at(self.dem.georeference(), self.lattice.node(*index));
        Some(DensestCell { at, share: self.share(*count) })
    }

    /// The DEM of whose posts the cells are.
    pub const fn dem(&self) -> &Dem {
        &self.dem
    }

    fn shares(&self, counts: &Counts) -> Vec<f64> {
        let mut shares = vec![0.0; self.lattice.count()];
        for (cell, count) in counts {
            shares[*cell] = self.share(*count);
        }
        shares
    }

    #[expect(clippy::cast_precision_loss, reason = "fewer trials than 2^53")]
    fn share(&self, count: u32) -> f64 {
        if self.trials == 0 { 0.0 } else { f64::from(count) / self.trials as f64 }
    }

    /// The cell of a place.
    fn cell(&self, place: &Point3<f64>) -> usize {
        self.lattice.index(self.lattice.nearest(self.dem.georeference(), place.xy()))
    }
}

impl Observer for RestDensity {
    fn wants_records(&self) -> bool {
        true
    }

    fn hop(&mut self, hop: &HopRecord) {
        self.stands = hop.landed;
        let number = usize::try_from(hop.hop).unwrap_or(usize::MAX);
        if hop.landed && (1..=self.hops.len()).contains(&number) {
            let cell = self.cell(&hop.rest_m);
            *self.hops[number - 1].entry(cell).or_default() += 1;
        }
    }

    fn trial(&mut self, trial: &TrialRecord) {
        self.trials += 1;
        if std::mem::replace(&mut self.stands, true) {
            let cell = self.cell(&trial.end_m);
            *self.ends.entry(cell).or_default() += 1;
            if let Some((area, count)) = &mut self.area {
                *count += u64::from(area.keeps_out(trial.end_m.xy()));
            }
        }
    }
}
