//! A hopper that is a ball in flight: where its centre stands, and whether it has room there.
//!
//! ```text
//!           . - .
//!          (  c  )   radius r          What the facets may block is taken too large by up to 0.474 r
//!           ' - '                      ([`BALL_BOUND`](crate::ballistics::limits::BALL_BOUND)), so the centre begins and ends
//!             | 1.5 r                  somewhat farther away from the surface than a ball that lies on it.
//!     ________|________ surface
//! ```

use nalgebra::{Point3, Vector3};

use super::{MeshContactFacet, MeshGround, NoMeshContact};
use crate::ballistics::limits::BALL_BOUND;

/// How far off the contact the centre of a ball stands, in radii: more than [`BALL_BOUND`], so that the facet under it does not block all.
pub const BALL_STAND_OFF: f64 = 1.5;
const _: () = assert!(BALL_STAND_OFF > BALL_BOUND);

impl MeshGround {
    /// The radius of the ball that the hopper is, m; 0 for a point.
    #[inline]
    pub fn radius_m(&self) -> f64 {
        self.envelope.hopper().limits().radius_m.unwrap_or(0.0)
    }

    /// The centre of the hopper at a contact: the point itself, or that of a ball that has room there.
    ///
    /// # Errors
    /// [`NoMeshContact::NoRoom`] with a facet that the ball touches, or that lies between it and the contact.
    pub(super) fn centre(
        &self,
        point_m: Point3<f64>,
        mean: Vector3<f64>,
        facets: &[MeshContactFacet],
    ) -> Result<Point3<f64>, NoMeshContact> {
        let radius_m = self.radius_m();
        if radius_m == 0.0 {
            return Ok(point_m);
        }
        let no_room = |facet, distance_m| NoMeshContact::NoRoom { point_m, radius_m, facet, distance_m };
        let Some(outwards) = mean.try_normalize(1.0e-6) else {
            // Facets back to back leave no side to stand on.
            return Err(no_room(facets.first().map_or(crate::quantity::FacetId(0), |facet| facet.id), 0.0));
        };
        let centre_m = point_m + outwards * (BALL_STAND_OFF * radius_m);
        let nearest = self.tree.nearest(centre_m);
        if nearest.distance_m < radius_m {
            return Err(no_room(nearest.facet, nearest.distance_m));
        }
        match self.tree.crossed(point_m, centre_m) {
            Some(facet) => Err(no_room(facet, 0.0)),
            None => Ok(centre_m),
        }
    }
}
