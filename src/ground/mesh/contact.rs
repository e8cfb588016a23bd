//! A contact on a mesh: a point of its surface with the facets that meet there.

use nalgebra::{Point3, Vector3};

use super::{MeshGround, hold::Hold};
use crate::quantity::FacetId;

/// A facet at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshContactFacet {
    /// Which.
    pub id: FacetId,
    /// Its normal, of length 1.
    pub normal: Vector3<f64>,
    /// What holds a take-off and a landing on it.
    pub(super) holds: [Hold; 2],
}

/// A point of the surface of a mesh where a hop takes off or lands.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshContact {
    point_m: Point3<f64>,
    /// Of a ball, the place of its centre; else the point.
    centre_m: Point3<f64>,
    moved_m: f64,
    /// All facets that meet at the point.
    facets: Vec<MeshContactFacet>,
}

/// Why a point gives no contact.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoMeshContact {
    /// It lies inside a closed body.
    #[error(
        "({}, {}, {}) m lies inside a closed body of the mesh, expected a point on its surface or in the open; the nearest point of the \
         surface is ({}, {}, {}) m, {distance_m} m away",
        point_m.x, point_m.y, point_m.z, nearest_m.x, nearest_m.y, nearest_m.z
    )]
    InsideRock {
        /// The point.
        point_m: Point3<f64>,
        /// The nearest point of the surface.
        nearest_m: Point3<f64>,
        /// How far away that is, m.
        distance_m: f64,
    },
    /// The nearest surface lies inside a closed body.
    #[error(
        "the surface nearest to ({}, {}, {}) m, at ({}, {}, {}) m, lies inside another closed body of the mesh, expected open surface",
        point_m.x, point_m.y, point_m.z, nearest_m.x, nearest_m.y, nearest_m.z
    )]
    Covered {
        /// The point.
        point_m: Point3<f64>,
        /// The nearest point of the surface.
        nearest_m: Point3<f64>,
    },
    /// The ball of the hopper has no room there.
    #[error(
        "a ball of radius {radius_m} m on the surface at ({}, {}, {}) m touches facet {}, {distance_m:.6} m from its centre, expected room \
         for it: choose a place farther away from walls and edges, or a smaller hopper.radius_m",
        point_m.x, point_m.y, point_m.z, facet.index() + 1
    )]
    NoRoom {
        /// The point of the surface.
        point_m: Point3<f64>,
        /// The radius of the ball, m.
        radius_m: f64,
        /// What it touches.
        facet: FacetId,
        /// How far that is from the centre of the ball, m.
        distance_m: f64,
    },
    /// Not three finite numbers.
    #[error("({}, {}, {}) is no point, expected three finite numbers", point_m.x, point_m.y, point_m.z)]
    NoPoint {
        /// What was given.
        point_m: Point3<f64>,
    },
}

/// A point this share of the size of the mesh below the surface was meant to lie on it: coordinates are typed with few digits.
const TYPED: f64 = 1.0e-4;

impl MeshContact {
    /// The point, m.
    pub const fn point_m(&self) -> Point3<f64> {
        self.point_m
    }

    /// Where the centre of the hopper is, m: [`BALL_STAND_OFF`](super::BALL_STAND_OFF) radii off a ball's point, along the mean of the normals there.
    pub const fn centre_m(&self) -> Point3<f64> {
        self.centre_m
    }

    /// How far the point was moved to the surface, m.
    pub const fn moved_m(&self) -> f64 {
        self.moved_m
    }

    /// The facets that meet at the point.
    pub fn facets(&self) -> &[MeshContactFacet] {
        &self.facets
    }

    /// One of the facets that meet at the point.
    #[inline]
    pub(super) fn facet(&self, id: FacetId) -> Option<&MeshContactFacet> {
        self.facets.iter().find(|facet| facet.id == id)
    }

    /// Whether a facet meets the point.
    pub fn touches(&self, id: FacetId) -> bool {
        self.facet(id).is_some()
    }
}

impl MeshGround {
    /// The contact at the point of the surface that is nearest to a given one.
    ///
    /// # Errors
    /// [`NoMeshContact`] for a point inside rock, for surface that is, and where a ball has no room.
    pub fn contact(&self, at: Point3<f64>) -> Result<MeshContact, NoMeshContact> {
        if !at.coords.iter().all(|coordinate| coordinate.is_finite()) {
            return Err(NoMeshContact::NoPoint { point_m: at });
        }
        let tree = self.tree();
        let nearest = tree.nearest(at);
        let bounds = tree.mesh().bounds();
        let size_m = (bounds.map.max - bounds.map.min).amax().max(bounds.high_m - bounds.low_m);
        if nearest.distance_m > TYPED * size_m && tree.is_buried(at) {
            let (nearest_m, distance_m) = (nearest.point, nearest.distance_m);
            return Err(NoMeshContact::InsideRock { point_m: at, nearest_m, distance_m });
        }
        let facets: Vec<MeshContactFacet> = tree
            .touching(nearest.point)
            .into_iter()
            .map(|id| {
                let normal = tree.normal(id).into_inner();
                MeshContactFacet { id, normal, holds: self.holds(id, normal) }
            })
            .collect();
        let mean: Vector3<f64> = facets.iter().map(|facet| facet.normal).sum();
        if let Some(outwards) = mean.try_normalize(1.0e-6)
            && tree.is_buried(nearest.point + outwards * (16.0 * tree.resolution_m()))
        {
            return Err(NoMeshContact::Covered { point_m: at, nearest_m: nearest.point });
        }
        let centre_m = self.centre(nearest.point, mean, &facets)?;
        Ok(MeshContact { point_m: nearest.point, centre_m, moved_m: nearest.distance_m, facets })
    }
}
