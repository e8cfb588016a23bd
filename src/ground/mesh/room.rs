//! By how much a hop over a mesh keeps away from its facets, and from the slope on which it could not rest.

use std::ops::ControlFlow;

use super::{MeshContact, MeshCourse, MeshGround};
use crate::{
    ballistics::{Arc, LineOfSight},
    quantity::Angle,
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
        let (run_m, near_m) = (course.sight.run_m(), self.tree().resolution_m());
        let mut least: Option<(f64, f64)> = None;
        let _ = self.tree().cut(
            &course.plane,
            |[low, high]| high.x_m >= 0.0 && low.x_m <= run_m,
            |_, [mut from, mut to]| {
                if from.x_m > to.x_m {
                    std::mem::swap(&mut from, &mut to);
                }
                let slope = (to.z_m - from.z_m) / (to.x_m - from.x_m);
                let at = |x_m: f64| if to.x_m > from.x_m { from.z_m + slope * (x_m - from.x_m) } else { from.z_m };
                let mut add = |x_m: f64, z_m: f64| {
                    if x_m <= near_m || x_m >= run_m - near_m {
                        return;
                    }
                    let away_m = (arc.height_at_m(x_m) - z_m).abs() - self.envelope().clearance().at_m(x_m, run_m - x_m);
                    if least.is_none_or(|(least_m, _)| away_m < least_m) {
                        least = Some((away_m, x_m));
                    }
                };
                // A vertical part is nearest at one of its ends.
                if to.x_m - from.x_m <= near_m {
                    add(from.x_m, from.z_m);
                    add(to.x_m, to.z_m);
                    return ControlFlow::Continue(());
                }
                let kink_m = self.envelope().clearance().kink_m(run_m);
                let mut ends = [from.x_m.max(0.0), kink_m, run_m - kink_m, to.x_m.min(run_m)];
                let (first, last) = (ends[0], ends[3]);
                for end in &mut ends {
                    *end = end.clamp(first.min(last), last.max(first));
                }
                for x_m in ends {
                    add(x_m, at(x_m));
                }
                for piece in ends.windows(2).filter(|piece| piece[1] > piece[0]) {
                    let [left_m, right_m] = [piece[0], piece[1]];
                    let clearance = self.envelope().clearance();
                    let [left, right] = [left_m, right_m].map(|x_m| clearance.at_m(x_m, run_m - x_m));
                    // Under a facet the arc comes nearest where it is parallel to the facet less its clearance.
                    let kept = slope - (right - left) / (right_m - left_m);
                    let x_m = parallel_m(arc, course.sight, kept);
                    if (left_m..right_m).contains(&x_m) && arc.height_at_m(x_m) < at(x_m) {
                        add(x_m, at(x_m));
                    }
                }
                ControlFlow::Continue(())
            },
        );
        least
    }

    /// By how much the facets at a contact are less steep than the rest slope, degrees; infinite where every slope holds.
    pub fn rest_margin_deg(&self, contact: &MeshContact) -> f64 {
        let most = match self.surface().rest {
            RestSlope::AsFrictionHolds => self.surface().constant_friction().map(FrictionCone::coefficient).map(Angle::from_slope),
            RestSlope::AtMost(angle) => Some(angle),
            RestSlope::Unlimited => None,
        };
        let Some(most) = most else { return f64::INFINITY };
        let tilts = contact.facets().iter().map(|facet| libm::atan2(libm::hypot(facet.normal.x, facet.normal.y), facet.normal.z));
        most.degrees() - tilts.fold(0.0, f64::max).to_degrees()
    }
}

/// Where an arc has a slope, m from the take-off: `z' = b + n (1 - 2 x / X)`.
fn parallel_m(arc: &Arc, sight: LineOfSight, slope: f64) -> f64 {
    0.5 * sight.run_m() * (1.0 + (sight.slope() - slope) / arc.loft())
}
