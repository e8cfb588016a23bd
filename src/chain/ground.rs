//! What a chain states of its segments, before hopper and scenario are known.

use super::LineConstraints;
use crate::{
    quantity::Angle,
    world::{FrictionCone, SurfaceProperties},
};

/// What the chain states of one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentGround {
    /// How the constraints are stated.
    pub form: GroundForm,
    /// Whether take-off and landing are forbidden; flying over is allowed.
    pub keep_out: bool,
}

/// The forms in which a segment's constraints can be stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GroundForm {
    /// By its surface: friction (the scenario's if the chain gives none) and cross-slope.
    Surface {
        /// Friction of this segment.
        friction: Option<FrictionCone>,
        /// Angle between the surface normal and the plane of travel.
        cross_slope: Angle,
    },
    /// By explicit limits; no hop is possible in a direction without limits.
    Explicit {
        /// For travel towards +x.
        forward: Option<LineConstraints>,
        /// For travel towards -x, with angles seen along that direction.
        reverse: Option<LineConstraints>,
    },
}

impl SegmentGround {
    /// Level across, everything else from the scenario: the ground of a chain with only `x_m,z_m`.
    pub const BARE: Self =
        Self { form: GroundForm::Surface { friction: None, cross_slope: Angle::from_radians(0.0) }, keep_out: false };

    /// The angle between its normal and the plane of travel; 0 where angles are stated.
    pub(crate) fn cross_slope(&self) -> Angle {
        match self.form {
            GroundForm::Explicit { .. } => Angle::default(),
            GroundForm::Surface { cross_slope, .. } => cross_slope,
        }
    }

    /// The friction that decides a contact, of the segment or of the surface; `None` where angles are stated.
    pub(crate) fn friction_under(&self, surface: &SurfaceProperties) -> Option<FrictionCone> {
        match self.form {
            GroundForm::Explicit { .. } => None,
            GroundForm::Surface { friction, .. } => friction.or(surface.constant_friction()),
        }
    }

    /// A stated limit that is not a number, or a cross-slope beyond the vertical: what it is, and its value.
    pub(super) fn not_a_limit(&self) -> Option<(&'static str, f64)> {
        match self.form {
            GroundForm::Surface { cross_slope, .. } => {
                let within = cross_slope.radians().abs() <= std::f64::consts::FRAC_PI_2;
                (!within).then(|| ("cross-slope in degrees", cross_slope.degrees()))
            }
            GroundForm::Explicit { forward, reverse } => {
                let rules = [forward, reverse].into_iter().flatten().flat_map(|line| [line.takeoff, line.landing]);
                let mut stated = rules.flat_map(|rule| {
                    let (min, max) = (rule.angles().min, rule.angles().max);
                    [
                        ("least angle in degrees", min.degrees()),
                        ("greatest angle in degrees", max.degrees()),
                        ("greatest speed in m/s", rule.speed_max_m_s()),
                    ]
                });
                stated.find(|(_, number)| number.is_nan())
            }
        }
    }
}
