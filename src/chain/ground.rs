//! What a chain itself says of its segments, before hopper and scenario are known.

use super::LineConstraints;
use crate::{quantity::Angle, world::FrictionCone};

/// What the chain says of one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentGround {
    /// How the constraints are stated.
    pub form: GroundForm,
    /// No take-off, no landing; flying over is allowed.
    pub keep_out: bool,
}

/// The ways of stating a segment's constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GroundForm {
    /// By its surface: friction (from the scenario where the chain gives none) and cross-slope.
    Surface {
        /// Friction of this segment.
        friction: Option<FrictionCone>,
        /// Angle between the surface normal and the plane of travel.
        cross_slope: Angle,
    },
    /// By explicit limits; a direction without limits admits no hop.
    Explicit {
        /// For travel towards +x.
        forward: Option<LineConstraints>,
        /// For travel towards -x, as seen by the traveller.
        reverse: Option<LineConstraints>,
    },
}

impl SegmentGround {
    /// Flat across, all else from the scenario: what a chain of bare `x_m,z_m` says.
    pub const BARE: Self =
        Self { form: GroundForm::Surface { friction: None, cross_slope: Angle::from_radians(0.0) }, keep_out: false };

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
