//! A stance, or why a robot cannot stand.

use std::fmt;

use nalgebra::{Point3, Vector2, Vector3};

use super::{Foothold, LimbOutcome, Pose, StanceGround};
use crate::{
    ballistics::{
        ContactLimits,
        stance::{ConeSum, ContactCone},
    },
    ground::{MeshContact, NoMeshContact},
    quantity::FacetId,
    world::{Contact, RestSlope},
};

/// A pose in which a robot stands.
#[derive(Clone, Debug)]
pub struct Stance {
    pose: Pose,
    footholds: Vec<Foothold>,
    outcomes: Vec<LimbOutcome>,
    hold: Holds,
}

/// What holds a take-off and a landing.
#[derive(Clone, Debug)]
enum Holds {
    /// The sum of the cones of the feet.
    Cones(ConeSum),
    /// The facets under a robot that is a point: the strictest of all that meet there.
    Point(MeshContact),
}

/// What the trunk meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrunkHit {
    /// Which box of the trunk, from 0.
    pub part: usize,
    /// Which facet.
    pub facet: FacetId,
    /// The middle of the box, m.
    pub middle_m: Point3<f64>,
}

/// Why a robot cannot stand in a pose.
#[derive(Clone, Debug, PartialEq)]
pub enum NoStance {
    /// Its root lies inside a closed body of the mesh.
    InsideRock,
    /// Its trunk meets the ground.
    Trunk(TrunkHit),
    /// Too few of its feet stand.
    TooFewContacts {
        /// How many stand.
        found: usize,
        /// How many have to.
        needed: usize,
        /// What became of each limb, with its name.
        limbs: Vec<(String, LimbOutcome)>,
    },
    /// The cones of its feet leave no direction: the cone that stands for their sum is empty.
    NoDirection,
    /// Its feet would slip under its weight.
    Slips,
    /// A robot that is a point has no contact there.
    NoContact(NoMeshContact),
}

impl StanceGround {
    /// The stance in a pose.
    ///
    /// # Errors
    /// [`NoStance`]: the first reason in the order of its variants.
    pub fn stand(&self, pose: Pose) -> Result<Stance, NoStance> {
        self.stand_on(pose, 0)
    }

    /// The stance in a pose, with limbs looked at until so many feet cannot stand any more.
    fn stand_on(&self, pose: Pose, least: usize) -> Result<Stance, NoStance> {
        if self.is_point() {
            let contact = self.mesh().contact(pose.root_m).map_err(NoStance::NoContact)?;
            return Ok(self.on_point(contact, pose));
        }
        if self.mesh().tree().is_buried(pose.root_m) {
            return Err(NoStance::InsideRock);
        }
        if let Some(hit) = self.trunk_hit(&pose) {
            return Err(NoStance::Trunk(hit));
        }
        let (footholds, outcomes) = self.footholds_of(&pose, least);
        let needed = self.robot().contacts_min();
        if footholds.len() < needed {
            let names = self.robot().limbs().iter().map(|limb| limb.name.clone());
            return Err(NoStance::TooFewContacts { found: footholds.len(), needed, limbs: names.zip(outcomes).collect() });
        }
        let cones: Vec<ContactCone> = footholds.iter().filter_map(Foothold::cone).collect();
        let cone = self.cone_kind().cone(&cones);
        if cone.is_nothing() {
            return Err(NoStance::NoDirection);
        }
        if self.mesh().surface().rest == RestSlope::AsFrictionHolds && !cone.holds_weight() {
            return Err(NoStance::Slips);
        }
        Ok(Stance { pose, footholds, outcomes, hold: Holds::Cones(cone) })
    }

    /// The stance of a robot that is a point at a contact.
    pub fn on_point(&self, contact: MeshContact, pose: Pose) -> Stance {
        let pose = Pose { root_m: contact.point_m(), ..pose };
        Stance { pose, footholds: Vec::new(), outcomes: vec![LimbOutcome::Stands], hold: Holds::Point(contact) }
    }

    /// The stance over a point of the surface: `up` and `heading` as in [`Pose::facing`], the root `height_m` over the point.
    ///
    /// # Errors
    /// As [`stand`](Self::stand).
    pub fn stand_over(&self, at: &MeshContact, up: Vector3<f64>, heading: Vector2<f64>, height_m: f64) -> Result<Stance, NoStance> {
        self.stand_over_on((at, up), (heading, height_m), 0)
    }

    /// The same for one of many poses: where too few feet stand, the limbs after those that decided it are not looked at, and the reason does
    /// not name them.
    ///
    /// # Errors
    /// As [`stand`](Self::stand).
    pub fn try_to_stand_over(
        &self,
        at: &MeshContact,
        up: Vector3<f64>,
        heading: Vector2<f64>,
        height_m: f64,
    ) -> Result<Stance, NoStance> {
        self.stand_over_on((at, up), (heading, height_m), self.robot().contacts_min())
    }

    fn stand_over_on(
        &self,
        (at, up): (&MeshContact, Vector3<f64>),
        (heading, height_m): (Vector2<f64>, f64),
        least: usize,
    ) -> Result<Stance, NoStance> {
        let pose = Pose::facing(at.point_m() + up * height_m, up, heading);
        if self.is_point() { Ok(self.on_point(at.clone(), pose)) } else { self.stand_on(pose, least) }
    }

    /// What a stance allows a take-off or a landing along a heading; empty slopes where it allows none.
    pub fn allowed(&self, stance: &Stance, heading: Vector2<f64>, kind: Contact) -> ContactLimits {
        let limits = self.mesh().envelope().hopper().limits();
        match (&stance.hold, kind) {
            (Holds::Cones(cone), Contact::Takeoff) => {
                ContactLimits { slopes: cone.takeoff_slopes(heading), speed_max_m_s: limits.takeoff_speed_max_m_s }
            }
            (Holds::Cones(cone), Contact::Landing) => {
                ContactLimits { slopes: cone.landing_slopes(heading), speed_max_m_s: limits.arc_landing_speed_max_m_s() }
            }
            (Holds::Point(contact), _) => self
                .mesh()
                .allowed(contact, heading, kind)
                .unwrap_or(ContactLimits { slopes: crate::quantity::SlopeInterval::EMPTY, speed_max_m_s: 0.0 }),
        }
    }
}

impl Foothold {
    /// Its friction cone; `None` for a friction of 0, which robots and surfaces with legs do not have.
    pub fn cone(&self) -> Option<ContactCone> {
        ContactCone::new(self.normal, self.friction).ok()
    }
}

impl Stance {
    /// Where the trunk is.
    pub const fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Where the feet stand.
    pub fn footholds(&self) -> &[Foothold] {
        &self.footholds
    }

    /// What became of every limb, in the order of the robot.
    pub fn outcomes(&self) -> &[LimbOutcome] {
        &self.outcomes
    }

    /// The cone of the directions in which the feet push; `None` of a robot that is a point.
    pub const fn cone(&self) -> Option<&ConeSum> {
        match &self.hold {
            Holds::Cones(cone) => Some(cone),
            Holds::Point(_) => None,
        }
    }

    /// The contact of a robot that is a point.
    pub const fn point(&self) -> Option<&MeshContact> {
        match &self.hold {
            Holds::Point(contact) => Some(contact),
            Holds::Cones(_) => None,
        }
    }
}

impl fmt::Display for NoStance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InsideRock => f.write_str("the root of the robot lies inside a closed body of the mesh"),
            Self::Trunk(TrunkHit { part, facet, middle_m }) => {
                let [x, y, z] = [middle_m.x, middle_m.y, middle_m.z];
                write!(f, "box {} of the trunk, about ({x:.3}, {y:.3}, {z:.3}) m, meets facet {}", part + 1, facet.index() + 1)
            }
            Self::TooFewContacts { found, needed, limbs } => {
                write!(f, "{found} of {} feet stand, expected at least {needed}:", limbs.len())?;
                let missing = limbs.iter().filter(|(_, outcome)| *outcome != LimbOutcome::Stands);
                for (number, (name, outcome)) in missing.enumerate() {
                    write!(f, "{} {name} {}", if number == 0 { "" } else { "," }, outcome.sentence())?;
                }
                Ok(())
            }
            Self::NoDirection => f.write_str("the cone of its feet holds no direction"),
            Self::Slips => f.write_str("its feet slip under its weight: the vertical lies outside the cone of its feet"),
            Self::NoContact(problem) => problem.fmt(f),
        }
    }
}
