//! The raw facts of a ground of any kind.

use std::{fmt, ops::ControlFlow};

use nalgebra::{Point3, Vector2, Vector3};

use crate::{
    ballistics::{LineOfSight, TakeoffSpeeds},
    chain::{ContactRule, GroundRefusal, LineConstraints, Station},
    quantity::{ChainPoint, FacetId, MapPoint, SlopeInterval, VertexId},
    terrain::MapLayers,
    world::{Contact, FrictionCone, Gravity, Hopper},
};

/// The coordinates that a [`ContactPoint`] is given in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Frame {
    /// The plane of a chain without a map: x along the chain, y = 0, z up.
    Chain,
    /// A map: easting, northing, z up.
    Map,
}

/// Where a hop takes off or lands: a point in three dimensions, its distance along the journey, and its station if there is a
/// chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Distance along the journey's profile, m: the chain's x, or the distance from the start along the unrolled path.
    pub along_m: f64,
    /// The point, m.
    pub point_m: Point3<f64>,
    /// The coordinates of `point_m`.
    pub frame: Frame,
    /// The station of a chain.
    pub station: Option<Station>,
}

impl ContactPoint {
    /// A point of a map, at a distance along the journey.
    pub fn on_map(along_m: f64, at: MapPoint, z_m: f64) -> Self {
        Self { along_m, point_m: Point3::new(at.x, at.y, z_m), frame: Frame::Map, station: None }
    }

    /// The point in the journey's profile: distance along it, and height.
    pub fn in_profile(&self) -> ChainPoint {
        ChainPoint::new(self.along_m, self.point_m.z)
    }

    /// The point on the map; `None` for a chain without a map.
    pub fn map(&self) -> Option<MapPoint> {
        match self.frame {
            Frame::Map => Some(self.point_m.xy()),
            Frame::Chain => None,
        }
    }
}

/// Which part of the ground next to a contact: ahead of it or behind it, in the direction of travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The ground just beyond it.
    Ahead,
    /// The ground just before it.
    Behind,
}

/// What keeps the hopper from sliding on a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// Coulomb friction on a facet of this upward normal of length 1: a force within the cone about the normal does not slide.
    Friction {
        /// The normal.
        normal: Vector3<f64>,
        /// The cone.
        cone: FrictionCone,
    },
    /// Take-off and landing angles given explicitly for this direction of travel, instead of friction.
    Stated {
        /// The line constraints as stated; `None` if none are stated for this direction.
        line: Option<LineConstraints>,
        /// The rule of a take-off, or why the ground refuses every take-off.
        takeoff: Result<ContactRule, GroundRefusal>,
        /// The same for a landing.
        landing: Result<ContactRule, GroundRefusal>,
    },
}

impl Hold {
    /// What is stated for a take-off or a landing; `None` under friction.
    pub(crate) fn stated(&self, contact: Contact) -> Option<Result<ContactRule, GroundRefusal>> {
        match (self, contact) {
            (Self::Friction { .. }, _) => None,
            (Self::Stated { takeoff, .. }, Contact::Takeoff) => Some(*takeoff),
            (Self::Stated { landing, .. }, Contact::Landing) => Some(*landing),
        }
    }
}

/// One facet under a line of travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Why every take-off and landing is refused here: a keep-out zone, or too steep to rest on.
    pub refusal: Option<GroundRefusal>,
    /// What keeps the hopper from sliding.
    pub hold: Hold,
    /// The tangent of the steepest slope to rest on here; `None` if every slope holds.
    pub rest_slope: Option<f64>,
}

/// In which directions the ground around a contact is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Around {
    /// Along a profile alone, which slopes across by at most this tangent.
    Profile {
        /// The tangent of the greatest cross-slope of the ground touched.
        cross_slope: f64,
    },
    /// In every direction of a map.
    Map,
}

/// Straight ground under a part of a line of travel.
///
/// ```text
///   z                 to
///   |            . - '            from_m, to_m: horizontal distances from the take-off, along the line
///   |   from . '
///   +------------------> distance
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Where it begins, m from the take-off.
    pub from_m: f64,
    /// Where it ends, m from the take-off.
    pub to_m: f64,
    /// Height of the ground where it begins, m.
    pub from_z_m: f64,
    /// Height of the ground where it ends, m.
    pub to_z_m: f64,
    /// The chain's vertex at its end.
    pub vertex: Option<ElementVertex>,
    /// Whether the vertical plane of travel turns at its end.
    pub bends: bool,
}

/// A vertex of a chain at the end of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementVertex {
    /// Its id.
    pub id: VertexId,
    /// Its x, m.
    pub x_m: f64,
}

/// A ground: its contacts, and the facets that rule there.
///
/// These are facts without any equation of motion, so that the independent checker ([`crate::path::execute()`]) may use them.
/// [`ConstrainedChain`](crate::chain::ConstrainedChain) and [`DemGround`](super::DemGround) implement it, with a [profile](Profiles)
/// under every line of travel, and [`MeshGround`](super::MeshGround), with [facets](Triangulated) that may stand over one another.
pub trait Surface {
    /// A contact with this ground: a station of a chain, a point of a map or of a mesh.
    type Contact: Copy + PartialEq + fmt::Debug + Send + Sync;

    /// The hopper.
    fn hopper(&self) -> &Hopper;

    /// Gravity, with the radius of its body where that is known.
    fn gravity(&self) -> Gravity;

    /// Gravity, m/s^2.
    fn gravity_m_s2(&self) -> f64 {
        self.gravity().m_s2()
    }

    /// The position of a contact.
    fn contact_point(&self, contact: &Self::Contact) -> ContactPoint;

    /// This ground's contact at the horizontal position of a stated point, over a mesh at the point of its surface nearest to it; `None`
    /// where there is no ground.
    fn contact_at(&self, stated: &ContactPoint) -> Option<Self::Contact>;

    /// Horizontal distance from one contact to another, m, and the unit direction of travel (east and north on a map; (1, 0) or
    /// (-1, 0) along a chain); `None` if both have the same horizontal position.
    fn course(&self, from: &Self::Contact, to: &Self::Contact) -> Option<(f64, Vector2<f64>)>;

    /// The facets that rule a contact for a line of travel: the facet under the line on that side of the contact, or both facets if it
    /// runs along their common edge; of a mesh all that meet at the contact.
    fn facets(&self, at: &Self::Contact, heading: Vector2<f64>, side: Side) -> Vec<Facet>;

    /// The layers of the map that contacts and flights obey; `None` without a map.
    fn layers(&self) -> Option<&MapLayers> {
        None
    }

    /// Rounding error of the heights of this ground, m.
    fn height_rounding_m(&self) -> f64;

    /// Rounding error of the horizontal positions, m.
    fn position_rounding_m(&self) -> f64;

    /// Positions closer than this are one position, m: shorter elements carry no information.
    fn resolution_m(&self) -> f64;

    /// Rounding error of the slope of a facet, and of the direction of a line of travel, rad.
    fn slope_rounding(&self) -> f64;
}

/// A ground with one height at every place: what lies under a straight line of travel from a contact.
pub trait Profiles: Surface {
    /// Visits the ground under a line of travel from a contact, element by element, until the visitor breaks or the known ground
    /// ends.
    ///
    /// The elements touch; the first begins at the contact.
    fn walk(&self, from: &Self::Contact, heading: Vector2<f64>, visit: &mut dyn FnMut(&Element) -> ControlFlow<()>);

    /// In which directions the ground within a distance of a contact is known, m.
    fn around(&self, at: &Self::Contact, distance_m: f64) -> Around;

    /// Visits the ground around a contact along rays in the directions given, each up to at least a distance or the end of the known
    /// ground, m: the number of the ray, and its elements as in [`walk`](Self::walk).
    fn rays(
        &self,
        at: &Self::Contact,
        _distance_m: f64,
        headings: &[Vector2<f64>],
        visit: &mut dyn FnMut(usize, &Element) -> ControlFlow<()>,
    ) {
        for (ray, heading) in headings.iter().enumerate() {
            self.walk(at, *heading, &mut |element| visit(ray, element));
        }
    }
}

/// A ground of triangles that may stand over one another: caves, overhangs, ceilings.
pub trait Triangulated: Surface {
    /// Opposite corners of the box around all triangles, the lower one first.
    fn bounds(&self) -> [Point3<f64>; 2];

    /// Visits every triangle that meets a box, given by its lower and its upper corner, and perhaps some beside it; in any order.
    fn visit_triangles(&self, within: [Point3<f64>; 2], visit: &mut dyn FnMut(FacetId, &[Point3<f64>; 3]));

    /// The triangle nearest to a point, and how far away it is, m.
    fn nearest_m(&self, to: &Point3<f64>) -> (FacetId, f64);

    /// The triangles that meet at a contact.
    fn touching(&self, at: &Self::Contact) -> Vec<FacetId>;

    /// The normal of a triangle on its outer side, of length 1.
    fn outer_normal(&self, facet: FacetId) -> Vector3<f64>;
}

/// The feasible take-off windows between two contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeoffWindows {
    /// The line of sight that the lofts refer to.
    pub sight: LineOfSight,
    /// Intervals of the loft, the take-off slope minus the slope of `sight`, ascending and disjoint; empty if no arc is feasible.
    /// Over ground without overhangs there is at most one, unless the machine cannot be commanded every take-off speed.
    pub lofts: Vec<SlopeInterval>,
}

impl TakeoffWindows {
    /// Those that the machine's take-off speeds leave of the lofts that all other limits allow.
    pub(super) fn of(speeds: &TakeoffSpeeds, sight: LineOfSight, lofts: Option<SlopeInterval>, gravity_m_s2: f64) -> Self {
        let windows = lofts.into_iter().flat_map(|lofts| speeds.windows(sight, lofts, gravity_m_s2));
        Self { sight, lofts: windows.map(|window| window.lofts).collect() }
    }
}

/// A ground that gives the feasible arcs between two contacts in closed form.
pub trait Windows: Surface {
    /// The feasible take-off windows of one hop; `None` if no arc can join the two contacts: both have the same horizontal
    /// position, or ground between them is missing.
    fn windows(&self, takeoff: &Self::Contact, landing: &Self::Contact) -> Option<TakeoffWindows>;
}
