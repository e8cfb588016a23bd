//! Where the feet of a robot stand: an estimate from the space that each foot reaches.
//!
//! The parts of facets within reach are put together by their normals. The largest group that its hip faces, with nothing between, is where
//! the foot stands: on the part nearest to the middle of the group, with the mean normal by area.
//!
//! Source: Campana and others 2016, section 4, which flips normals to face the trunk and so finds contacts through slabs.

use nalgebra::{Point3, Vector3};

use super::{
    Pose, StanceGround,
    clip::{Clipper, Piece},
};
use crate::{
    quantity::{Angle, FacetId},
    world::{FrictionCone, Limb, RestSlope},
};

/// Facets within this angle of the mean normal of a group belong to it: the cosine of 20 degrees.
const ALIKE_COSINE: f64 = 0.939_692_620_785_908_4;

/// Two feet nearer to one another than this share of the longest leg stand in one place.
const ONE_PLACE: f64 = 0.02;

/// Where a foot stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foothold {
    /// The limb, by its number.
    pub limb: usize,
    /// Where, m.
    pub point_m: Point3<f64>,
    /// The normal of the ground, of length 1: the mean of the facets within reach that are alike.
    pub normal: Vector3<f64>,
    /// The facet.
    pub facet: FacetId,
    /// The friction: the lesser of those of the ground and of the foot.
    pub friction: FrictionCone,
    /// The greatest angle between that normal and one of the facets it stands for.
    pub spread: Angle,
    /// The normal of that facet, of length 1: the worst that the foot may meet.
    pub worst_normal: Vector3<f64>,
    /// Their area within reach, m^2.
    pub area_m2: f64,
}

/// What became of a limb.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimbOutcome {
    /// Its foot stands.
    Stands,
    /// No facet is within its reach.
    NoGround,
    /// All facets within its reach face away from its hip: it would stand on the inside of the ground.
    FacesAway,
    /// Other facets lie between its hip and those within its reach.
    Hidden,
    /// All facets within its reach are kept out, or steeper than the rest slope that the scenario states.
    KeptOut,
    /// Another foot stands there already.
    SamePlace,
    /// The ground within its reach has no friction.
    NoFriction,
}

impl LimbOutcome {
    /// All outcomes.
    pub const ALL: [Self; 7] =
        [Self::Stands, Self::NoGround, Self::FacesAway, Self::Hidden, Self::KeptOut, Self::SamePlace, Self::NoFriction];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stands => "stands",
            Self::NoGround => "no_ground",
            Self::FacesAway => "ground_faces_away",
            Self::Hidden => "ground_hidden",
            Self::KeptOut => "kept_out",
            Self::SamePlace => "same_place",
            Self::NoFriction => "no_friction",
        }
    }

    /// The end of a sentence about the limb.
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::Stands => "stands",
            Self::NoGround => "reaches no ground",
            Self::FacesAway => "reaches only ground that faces away from its hip",
            Self::Hidden => "reaches only ground behind other ground",
            Self::KeptOut => "reaches only ground that is kept out or steeper than the rest slope",
            Self::SamePlace => "reaches only ground where another foot stands",
            Self::NoFriction => "reaches only ground without friction",
        }
    }
}

crate::quantity::by_name!(LimbOutcome, LimbOutcome::ALL);

/// A part of a facet within reach.
#[derive(Clone, Copy, Debug)]
struct Part {
    facet: FacetId,
    piece: Piece,
    normal: Vector3<f64>,
}

/// Parts that are alike.
#[derive(Clone, Debug)]
struct Group {
    area_m2: f64,
    /// Sums weighted by area.
    moment: Vector3<f64>,
    normal: Vector3<f64>,
    parts: Vec<Part>,
}

impl StanceGround {
    /// Where the feet of a robot in a pose stand, and what became of every limb.
    pub fn footholds(&self, pose: &Pose) -> (Vec<Foothold>, Vec<LimbOutcome>) {
        self.footholds_of(pose, 0)
    }

    /// The same, until so many feet cannot stand any more: limbs after that are not looked at.
    pub(super) fn footholds_of(&self, pose: &Pose, least: usize) -> (Vec<Foothold>, Vec<LimbOutcome>) {
        let mut clipper = Clipper::default();
        let (mut found, mut outcomes) = (Vec::new(), Vec::new());
        let limbs = self.robot().limbs();
        for (number, limb) in limbs.iter().enumerate() {
            if found.len() + limbs.len() - number < least {
                break;
            }
            outcomes.push(match self.foothold(pose, (number, limb), &found, &mut clipper) {
                Ok(foothold) => {
                    found.push(foothold);
                    LimbOutcome::Stands
                }
                Err(outcome) => outcome,
            });
        }
        (found, outcomes)
    }

    /// Where the foot of one limb stands, beside those that stand already.
    fn foothold(
        &self,
        pose: &Pose,
        (number, limb): (usize, &Limb),
        others: &[Foothold],
        clipper: &mut Clipper,
    ) -> Result<Foothold, LimbOutcome> {
        let (mut groups, refused) = self.groups(pose, limb, clipper);
        groups.sort_by(|a, b| b.area_m2.total_cmp(&a.area_m2));
        let mut outcome = refused;
        let hip_m = pose.to_ground(&limb.hip_m);
        for group in &groups {
            let Some(normal) = group.normal.try_normalize(1e-9) else { continue };
            let middle = Point3::from(group.moment / group.area_m2);
            let away = |part: &Part| (part.piece.middle - middle).norm_squared();
            let Some(part) = group.parts.iter().min_by(|a, b| away(a).total_cmp(&away(b))) else { continue };
            let point_m = pose.to_ground(&part.piece.middle);
            // From the foot, since the facets that it stands on are left out there.
            if self.mesh().tree().crossed(point_m, hip_m).is_some() {
                outcome = LimbOutcome::Hidden;
                continue;
            }
            let near_m = ONE_PLACE * self.robot().leg_length_m();
            if others.iter().any(|other| (other.point_m - point_m).norm() < near_m) {
                outcome = LimbOutcome::SamePlace;
                continue;
            }
            let away = |part: &&Part| part.normal.dot(&normal);
            let worst = group.parts.iter().min_by(|a, b| away(a).total_cmp(&away(b))).map_or(normal, |part| part.normal);
            let cosine = worst.dot(&normal);
            let of_map = self.map().and_then(|map| map.friction_at(point_m.xy()));
            let Some(ground) = of_map.or_else(|| self.mesh().friction_of(part.facet)) else { continue };
            if ground.coefficient() == 0.0 {
                outcome = LimbOutcome::NoFriction;
                continue;
            }
            let friction = limb.friction.filter(|foot| foot.coefficient() < ground.coefficient()).unwrap_or(ground);
            return Ok(Foothold {
                limb: number,
                point_m,
                normal: pose.turn * normal,
                facet: part.facet,
                friction,
                spread: Angle::from_radians(libm::acos(cosine.min(1.0))),
                worst_normal: pose.turn * worst,
                area_m2: group.area_m2,
            });
        }
        Err(outcome)
    }

    /// The parts of facets that a foot reaches, put together by their normals in the trunk frame, and the reason if the list is empty.
    fn groups(&self, pose: &Pose, limb: &Limb, clipper: &mut Clipper) -> (Vec<Group>, LimbOutcome) {
        let bounds = limb.bounds();
        let [low, high] = around(pose, bounds);
        let mut groups: Vec<Group> = Vec::new();
        let mut outcome = LimbOutcome::NoGround;
        self.mesh().tree().visit(
            |min, max| (0..3).all(|axis| min[axis] <= high[axis] && low[axis] <= max[axis]),
            |facet, corners| {
                let inside = corners.map(|corner| pose.to_trunk(&corner));
                let Some(normal) = (inside[1] - inside[0]).cross(&(inside[2] - inside[0])).try_normalize(0.0) else { return };
                clipper.pieces((limb, bounds), &inside, |piece| {
                    if normal.dot(&(limb.hip_m - piece.middle)) <= 0.0 {
                        outcome = worse(outcome, LimbOutcome::FacesAway);
                    } else if self.keeps_feet_off(facet) || self.map_keeps_off(pose, &piece) {
                        outcome = worse(outcome, LimbOutcome::KeptOut);
                    } else {
                        let part = Part { facet, piece, normal };
                        match groups.iter_mut().find(|group| group.holds(&part)) {
                            Some(group) => group.add(part),
                            None => groups.push(Group::of(part)),
                        }
                    }
                });
            },
        );
        (groups, outcome)
    }

    /// Whether no foot may stand on a facet: it is kept out, or steeper than a rest slope that is stated.
    fn keeps_feet_off(&self, facet: FacetId) -> bool {
        let face = self.mesh().face_surface(facet);
        let is_too_steep = match face.surface.rest {
            RestSlope::AtMost(most) => {
                let normal = self.mesh().tree().normal(facet);
                libm::atan2(libm::hypot(normal.x, normal.y), normal.z) > most.radians()
            }
            RestSlope::AsFrictionHolds | RestSlope::Unlimited => false,
        };
        face.ground.keep_out || is_too_steep
    }

    /// Whether a part of a facet lies where the map lets no foot stand.
    fn map_keeps_off(&self, pose: &Pose, piece: &Piece) -> bool {
        self.map().is_some_and(|map| map.keeps_feet_off(pose.to_ground(&piece.middle).xy()))
    }
}

impl Group {
    fn of(part: Part) -> Self {
        let mut group = Self { area_m2: 0.0, moment: Vector3::zeros(), normal: Vector3::zeros(), parts: Vec::new() };
        group.add(part);
        group
    }

    fn add(&mut self, part: Part) {
        self.area_m2 += part.piece.area_m2;
        self.moment += part.piece.middle.coords * part.piece.area_m2;
        self.normal += part.normal * part.piece.area_m2;
        self.parts.push(part);
    }

    fn holds(&self, part: &Part) -> bool {
        self.normal.dot(&part.normal) >= ALIKE_COSINE * self.normal.norm()
    }
}

/// Of two reasons the one that says more: kept-out ground is nearer to a foothold than ground that faces away.
fn worse(known: LimbOutcome, found: LimbOutcome) -> LimbOutcome {
    if known == LimbOutcome::KeptOut { known } else { found }
}

/// The box of the ground around a box of the trunk frame.
pub(super) fn around(pose: &Pose, [low, high]: [Point3<f64>; 2]) -> [Point3<f64>; 2] {
    let corners = (0..8).map(|corner| {
        let of = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
        pose.to_ground(&Point3::new(of(0), of(1), of(2)))
    });
    corners.fold([Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3])], |[min, max], corner| {
        [min.inf(&corner), max.sup(&corner)]
    })
}
