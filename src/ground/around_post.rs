//! The facets around a post, as a landing there meets them.

use nalgebra::{Vector2, Vector3};

use super::{DemGround, Post, dem::rest_slope};
use crate::world::FrictionCone;

impl DemGround {
    /// The share of the six facets around a post of the DEM that refuse an arrival with this heading and slope of descent: without
    /// elevation, too steep to rest on, or with a friction cone that does not hold the direction. Where friction differs from place to
    /// place, cones are not looked at.
    ///
    /// A hop aimed at a post comes down on any of them.
    pub(crate) fn refusing_share(&self, post: Post, heading: Vector2<f64>, arrival_slope: f64) -> f64 {
        let friction = self.constant_friction().filter(|_| self.terrain().overlays().friction().is_none());
        let rest = rest_slope(self.surface().rest, friction.map(FrictionCone::coefficient));
        let back = Vector3::new(-heading.x, -heading.y, -arrival_slope);
        let refuses = |gradient: Option<Vector2<f64>>| {
            let Some(gradient) = gradient else { return true };
            let is_steep = rest.is_some_and(|rest| gradient.norm_squared() > rest * rest);
            // Within the cone: the part along the facet is at most the coefficient times the part along its normal.
            let slides = friction.is_some_and(|cone| {
                let normal = Vector3::new(-gradient.x, -gradient.y, 1.0);
                let (across, squared) = (back.dot(&normal), normal.norm_squared());
                let along = back.norm_squared() - across * across / squared;
                across <= 0.0 || along > cone.coefficient() * cone.coefficient() * across * across / squared
            });
            is_steep || slides
        };
        let refused = self.gradients_around(post).into_iter().filter(|gradient| refuses(*gradient)).count();
        #[expect(clippy::cast_precision_loss, reason = "at most six")]
        let share = refused as f64 / 6.0;
        share
    }

    /// The gradients of the six facets around a post, to the east and north; `None` for those without elevations.
    fn gradients_around(&self, post: Post) -> [Option<Vector2<f64>>; 6] {
        let (dem, map) = (self.terrain().dem(), self.terrain().dem().georeference());
        let z_m =
            |down: isize, right: isize| dem.elevation(post.row.checked_add_signed(down)?, post.col.checked_add_signed(right)?);
        let gradient = |east: [(isize, isize); 2], north: [(isize, isize); 2]| {
            let rise_m = |[from, to]: [(isize, isize); 2]| Some(z_m(to.0, to.1)? - z_m(from.0, from.1)?);
            Some(Vector2::new(rise_m(east)? / map.dx_m(), rise_m(north)? / map.dy_m()))
        };
        // Squares are split from north-west to south-east.
        let ([n, w, s, e], [nw, se], here) = ([(-1, 0), (0, -1), (1, 0), (0, 1)], [(-1, -1), (1, 1)], (0, 0));
        [
            gradient([nw, n], [here, n]),
            gradient([w, here], [w, nw]),
            gradient([here, e], [se, e]),
            gradient([s, se], [s, here]),
            gradient([here, e], [here, n]),
            gradient([w, here], [s, here]),
        ]
    }
}
