//! Stances of a robot with legs as the nodes of a roadmap.

use nalgebra::{Point3, Vector2};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use rayon::prelude::*;

use super::roadmap::{ContactSampler, DrawnContacts, RoadmapGround, RoadmapSampler};
use crate::{
    ballistics::{FlightEnvelope, LineOfSight, PathBounds},
    ground::{MeshContact, MeshGround, NoStance, Stance, StanceBuffers, StanceGround},
    quantity::SlopeInterval,
    world::Limit,
};

impl RoadmapGround for StanceGround {
    type Node = Stance;
    type Buffers = StanceBuffers;

    fn point_m(&self, stance: &Stance) -> Point3<f64> {
        stance.pose().root_m
    }

    fn envelope(&self) -> &FlightEnvelope {
        self.mesh().envelope()
    }

    fn speed_bounds(&self) -> PathBounds {
        MeshGround::speed_bounds(self.mesh())
    }

    fn relief_m(&self) -> f64 {
        self.mesh().relief_m() + self.robot().reach_m()
    }

    fn are_one_place(&self, [a, b]: [&Stance; 2]) -> bool {
        (b.pose().root_m - a.pose().root_m).norm() <= self.mesh().tree().resolution_m()
    }

    fn sight(&self, takeoff: &Stance, landing: &Stance) -> Option<LineOfSight> {
        Some(self.course(takeoff, landing)?.sight)
    }

    fn windows<'b>(
        &self,
        takeoff: &Stance,
        landing: &Stance,
        buffers: &'b mut StanceBuffers,
    ) -> Option<(LineOfSight, &'b [SlopeInterval])> {
        self.windows(takeoff, landing, buffers)
    }

    fn refused_by(&self, takeoff: &Stance, landing: &Stance) -> Option<Limit> {
        Some(self.takeoff_set(takeoff, landing)?.conflict()?.counted_under())
    }
}

/// How often a height and a heading are drawn for one contact of the surface before another one is drawn.
const POSES_PER_CONTACT: usize = 10;

/// How many contacts are drawn for each stance that is wanted, at most: few places of rough ground may carry a large robot.
const CONTACTS_PER_STANCE: usize = 40;

/// Draws stances on a mesh, the same for the same seed: over a [drawn contact](ContactSampler), at a random height and heading.
#[derive(Debug)]
pub struct StanceSampler<'g> {
    ground: &'g StanceGround,
    contacts: ContactSampler<'g>,
    /// Apart from that of the contacts, so that a robot that is a point stands on the contacts of a hopper without legs.
    source: ChaCha8Rng,
    refused: RefusedStances,
}

/// How many poses gave no stance, by the reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefusedStances {
    /// The trunk met the ground, or its root was inside it.
    pub trunk: usize,
    /// Too few feet stood.
    pub contacts: usize,
    /// The feet held no direction, or slipped under the weight of the robot.
    pub cone: usize,
}

impl<'g> StanceSampler<'g> {
    /// A sampler of stances over the contacts of another one, which are of the mesh of the ground.
    pub fn new(ground: &'g StanceGround, contacts: ContactSampler<'g>, seed: u64) -> Self {
        Self { ground, contacts, source: ChaCha8Rng::seed_from_u64(seed ^ 0x5354_414e_4345), refused: RefusedStances::default() }
    }

    /// The contacts.
    pub const fn contacts(&self) -> &ContactSampler<'g> {
        &self.contacts
    }

    /// How many poses gave no stance.
    pub const fn refused(&self) -> RefusedStances {
        self.refused
    }

    /// Stances over contacts that are drawn until there are so many, or none are found.
    fn stances(&mut self, count: usize, mut draw: impl FnMut(&mut ContactSampler<'g>, usize) -> Vec<MeshContact>) -> Vec<Stance> {
        let mut found = Vec::with_capacity(count);
        let mut drawn = 0;
        while found.len() < count && drawn < CONTACTS_PER_STANCE * count {
            let contacts = draw(&mut self.contacts, count - found.len());
            if contacts.is_empty() {
                break;
            }
            drawn += contacts.len();
            let [low_m, high_m] = self.ground.heights_m();
            let mut poses = |contact: MeshContact| {
                let poses: Vec<(f64, Vector2<f64>)> = (0..POSES_PER_CONTACT)
                    .map(|_| {
                        let height_m = low_m + (high_m - low_m) * self.source.random::<f64>();
                        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * self.source.random::<f64>());
                        (height_m, Vector2::new(cosine, sine))
                    })
                    .collect();
                (contact, poses)
            };
            let drawn: Vec<_> = contacts.into_iter().map(&mut poses).collect();
            let tried: Vec<_> = drawn.par_iter().map(|(contact, poses)| self.first(contact, poses)).collect();
            for (stance, refused) in tried {
                found.extend(stance);
                self.refused.add(refused);
            }
        }
        found.truncate(count);
        found
    }

    /// The stance of the first of some poses over a contact that gives one, and why those before it did not.
    fn first(&self, contact: &MeshContact, poses: &[(f64, Vector2<f64>)]) -> (Option<Stance>, RefusedStances) {
        let mut refused = RefusedStances::default();
        let normal = contact.facets().iter().map(|facet| facet.normal).sum();
        let up = self.ground.up_over(normal);
        for (height_m, heading) in poses {
            match self.ground.try_to_stand_over(contact, up, *heading, *height_m) {
                Ok(stance) => return (Some(stance), refused),
                Err(NoStance::InsideRock | NoStance::Trunk(_) | NoStance::NoContact(_)) => refused.trunk += 1,
                Err(NoStance::TooFewContacts { .. }) => refused.contacts += 1,
                Err(NoStance::NoDirection | NoStance::Slips) => refused.cone += 1,
            }
        }
        (None, refused)
    }
}

impl RefusedStances {
    fn add(&mut self, other: Self) {
        self.trunk += other.trunk;
        self.contacts += other.contacts;
        self.cone += other.cone;
    }
}

impl RoadmapSampler<Stance> for StanceSampler<'_> {
    fn all_over(&mut self, count: usize, is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync)) -> Vec<Stance> {
        self.stances(count, |contacts, count| contacts.all_over(count, is_useful))
    }

    fn about(
        &mut self,
        points: &[Point3<f64>],
        radius_m: f64,
        count: usize,
        is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync),
    ) -> Vec<Stance> {
        self.stances(count, |contacts, count| contacts.about(points, radius_m, count, is_useful))
    }

    fn drawn(&self) -> DrawnContacts {
        self.contacts.drawn()
    }
}
