//! By how much a hop over a mesh keeps away from its facets, and from the slope on which it could not rest.

use std::ops::ControlFlow;

use super::{MeshContact, MeshContactFacet, MeshCourse, MeshGround};
use crate::{
    ballistics::{Arc, LineOfSight, limits::ClearanceProfile},
    quantity::{Angle, ChainPoint},
    world::{FrictionCone, RestSlope},
};

impl MeshGround {
    /// How much farther from the facets over and under it an arc flies, vertically, than the clearance asks for, at the point where that is
    /// least: the distance, m, and the horizontal distance of the point from the take-off, m. `None` where no facet is over or under it but
    /// at the contacts themselves.
    ///
    /// Between the kinks of the clearance, the height over a part of a facet less the clearance is concave, and least at an end; under it
    /// convex, and least at an end or where the arc has the slope of what is kept.
    pub fn least_room(&self, course: &MeshCourse, arc: &Arc) -> Option<(f64, f64)> {
        let mut room = LeastRoom::new(arc, self.envelope().clearance(), self.tree().resolution_m());
        let _ = self.tree().cut(
            &course.plane,
            |[low, high]| high.x_m >= 0.0 && low.x_m <= course.sight.run_m(),
            |_, [from, to]| {
                room.beside(from, to);
                ControlFlow::Continue(())
            },
        );
        room.found()
    }

    /// By how much the facets at a contact are less steep than the rest slope, degrees; infinite where every slope holds.
    pub fn rest_margin_deg(&self, contact: &MeshContact) -> f64 {
        let margin = |facet: &MeshContactFacet| {
            let face = self.face_surface(facet.id);
            let most = match face.surface.rest {
                RestSlope::AsFrictionHolds => self.friction_of(facet.id).map(FrictionCone::coefficient).map(Angle::from_slope),
                RestSlope::AtMost(angle) => Some(angle),
                RestSlope::Unlimited => None,
            };
            let tilt = libm::atan2(libm::hypot(facet.normal.x, facet.normal.y), facet.normal.z);
            most.map_or(f64::INFINITY, |most| most.degrees() - tilt.to_degrees())
        };
        contact.facets().iter().map(margin).fold(f64::INFINITY, f64::min)
    }
}

/// The least room of an arc over and under straight parts of the ground in its plane, less the clearance.
#[derive(Clone, Debug)]
pub(in crate::ground) struct LeastRoom<'a> {
    arc: &'a Arc,
    clearance: ClearanceProfile,
    /// Nearer to a contact than this no room is asked for, m.
    near_m: f64,
    /// The least room, and where it is.
    least: Option<(f64, f64)>,
}

impl<'a> LeastRoom<'a> {
    pub(in crate::ground) const fn new(arc: &'a Arc, clearance: ClearanceProfile, near_m: f64) -> Self {
        Self { arc, clearance, near_m, least: None }
    }

    /// The least room, m, and where it is, m from the take-off; `None` where nothing is over or under the arc.
    pub(in crate::ground) const fn found(&self) -> Option<(f64, f64)> {
        self.least
    }

    fn add(&mut self, x_m: f64, z_m: f64) {
        let run_m = self.arc.line_of_sight().run_m();
        if x_m <= self.near_m || x_m >= run_m - self.near_m {
            return;
        }
        let away_m = (self.arc.height_at_m(x_m) - z_m).abs() - self.clearance.at_m(x_m, run_m - x_m);
        if self.least.is_none_or(|(least_m, _)| away_m < least_m) {
            self.least = Some((away_m, x_m));
        }
    }

    /// Looks at a part of the ground: its ends, by their distances from the take-off and their heights over it, m.
    pub(in crate::ground) fn beside(&mut self, mut from: ChainPoint, mut to: ChainPoint) {
        let sight = self.arc.line_of_sight();
        let run_m = sight.run_m();
        if from.x_m > to.x_m {
            std::mem::swap(&mut from, &mut to);
        }
        if to.x_m < 0.0 || from.x_m > run_m {
            return;
        }
        let slope = (to.z_m - from.z_m) / (to.x_m - from.x_m);
        let at = |x_m: f64| if to.x_m > from.x_m { from.z_m + slope * (x_m - from.x_m) } else { from.z_m };
        // A vertical part is nearest at one of its ends.
        if to.x_m - from.x_m <= self.near_m {
            self.add(from.x_m, from.z_m);
            self.add(to.x_m, to.z_m);
            return;
        }
        let kink_m = self.clearance.kink_m(run_m);
        let mut ends = [from.x_m.max(0.0), kink_m, run_m - kink_m, to.x_m.min(run_m)];
        let (first, last) = (ends[0], ends[3]);
        for end in &mut ends {
            *end = end.clamp(first.min(last), last.max(first));
        }
        for x_m in ends {
            self.add(x_m, at(x_m));
        }
        for piece in ends.windows(2).filter(|piece| piece[1] > piece[0]) {
            let [left_m, right_m] = [piece[0], piece[1]];
            let [left, right] = [left_m, right_m].map(|x_m| self.clearance.at_m(x_m, run_m - x_m));
            // Under a facet the arc comes nearest where it is parallel to the facet less its clearance.
            let kept = slope - (right - left) / (right_m - left_m);
            let x_m = parallel_m(self.arc, sight, kept);
            if (left_m..right_m).contains(&x_m) && self.arc.height_at_m(x_m) < at(x_m) {
                self.add(x_m, at(x_m));
            }
        }
    }
}

/// Where an arc has a slope, m from the take-off: `z' = b + n (1 - 2 x / X)`.
fn parallel_m(arc: &Arc, sight: LineOfSight, slope: f64) -> f64 {
    0.5 * sight.run_m() * (1.0 + (sight.slope() - slope) / arc.loft())
}
