//! Stances of a robot with legs that also walks, over a DEM.

use nalgebra::Point3;

use super::{Amounts, Travel, roadmap::RoadmapGround, travel::drive_amounts};
use crate::{
    ballistics::{FlightEnvelope, LineOfSight, PathBounds},
    drive::{DriveGround, DriveLimit},
    ground::{MapPosition, Stance, StanceBuffers, StanceGround},
    quantity::{MapPoint, SlopeInterval},
    world::Limit,
};

/// The stances of a robot with legs on a DEM, with the straight lines that it walks between them.
///
/// ```text
///     root o- - - - - - -o       hops: arcs of the root, as without walking
///         /|\           /|\
///     ---*-*-*---------*-*-*---  walks: the straight line on the ground under the roots, judged and priced as a drive leg
/// ```
///
/// Between two stances neither feet nor trunk are looked at: the limits of the rover stand for them.
#[derive(Clone, Debug)]
pub struct WalkingStances<'a> {
    stances: &'a StanceGround,
    drive: DriveGround<'a>,
    travel: Travel,
}

impl<'a> WalkingStances<'a> {
    /// Stances, the ground that is walked over, and whether the robot walks, hops or does both.
    pub const fn new(stances: &'a StanceGround, drive: DriveGround<'a>, travel: Travel) -> Self {
        Self { stances, drive, travel }
    }

    /// The place on the ground under the root of a stance; `None` off the map and without elevation.
    pub fn place(&self, stance: &Stance) -> Option<MapPosition> {
        let root_m = stance.pose().root_m;
        self.drive.ground().position(MapPoint::new(root_m.x, root_m.y))
    }
}

impl RoadmapGround for WalkingStances<'_> {
    type Node = Stance;
    type Buffers = StanceBuffers;

    fn point_m(&self, stance: &Stance) -> Point3<f64> {
        self.stances.point_m(stance)
    }

    fn envelope(&self) -> &FlightEnvelope {
        self.stances.envelope()
    }

    fn speed_bounds(&self) -> PathBounds {
        if self.travel.hops() {
            return self.stances.speed_bounds();
        }
        PathBounds::new(0.0, 0.0, self.envelope().gravity_m_s2())
    }

    fn relief_m(&self) -> f64 {
        self.stances.relief_m()
    }

    fn are_one_place(&self, stances: [&Stance; 2]) -> bool {
        self.stances.are_one_place(stances)
    }

    fn sight(&self, takeoff: &Stance, landing: &Stance) -> Option<LineOfSight> {
        self.stances.sight(takeoff, landing)
    }

    fn windows<'b>(
        &self,
        takeoff: &Stance,
        landing: &Stance,
        buffers: &'b mut StanceBuffers,
    ) -> Option<(LineOfSight, &'b [SlopeInterval])> {
        if self.travel.hops() {
            return self.stances.windows(takeoff, landing, buffers);
        }
        Some((self.sight(takeoff, landing)?, &[]))
    }

    fn refused_by(&self, takeoff: &Stance, landing: &Stance) -> Option<Limit> {
        self.stances.refused_by(takeoff, landing)
    }

    fn walk_neighbours(&self) -> usize {
        if self.travel.drives() { self.drive.rover().limits().neighbours.count() } else { 0 }
    }

    fn walk(&self, from: &Stance, to: &Stance) -> Result<Amounts, DriveLimit> {
        let [Some(from), Some(to)] = [from, to].map(|stance| self.place(stance)) else { return Err(DriveLimit::Ground) };
        let leg = self.drive.leg(&from, &to).map_err(|refusal| refusal.limit())?;
        Ok(drive_amounts(self.drive.rover(), &leg, 0.0))
    }
}
