//! Does a narrower cone about the vertical reduce the bounce-and-roll displacement? The paper claims it without a test (P section
//! V-B, last sentence).

use super::worst_drift::{DriftExperiment, DriftLanding, drift_with};
use crate::{
    chain::{ConstrainedChain, GroundForm, InvalidChain, LineConstraints, PolygonalChain, SegmentGround},
    path::Hop,
    quantity::{Angle, AngleInterval},
    world::{Contact, Direction},
};

/// The widths tested, as fractions of every cone's own distance from the vertical.
pub const CONE_SHARES: [f64; 5] = [1.0, 0.8, 0.6, 0.4, 0.2];

/// The bounce-and-roll displacement after a landing, called drift in the paper and in keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriftLaw {
    /// As in the paper's experiment: the same distribution after every landing, for any angle.
    Fixed,
    /// As in the paper's argument: proportional to the horizontal speed of the landing, and equal to the paper's distribution at
    /// the first landing with the widest cone.
    WithHorizontalSpeed,
}

impl DriftLaw {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Fixed, Self::WithHorizontalSpeed];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::WithHorizontalSpeed => "with-horizontal-speed",
        }
    }
}

/// Flies the paper's experiment along a path with a law of bounce-and-roll displacement.
///
/// `reference_m_s` is the horizontal speed at which the displacement has the paper's distribution.
pub fn cone_width(
    chain: &ConstrainedChain,
    hops: &[Hop],
    experiment: &DriftExperiment,
    (law, reference_m_s): (DriftLaw, f64),
) -> Vec<DriftLanding> {
    let sigmas_m = experiment.takeoff_variances_m2.map(f64::sqrt);
    let scatter = |hop: &Hop| {
        let share = match law {
            DriftLaw::Fixed => 1.0,
            DriftLaw::WithHorizontalSpeed => hop.horizontal_speed_m_s() / reference_m_s,
        };
        sigmas_m.map(|sigma_m| sigma_m * share)
    };
    drift_with(chain, hops, experiment, &scatter)
}

/// A chain with all its cones narrowed about the vertical: every bound keeps this fraction of its distance from straight up
/// (take-off) or straight down (landing).
///
/// Refusals, speeds and bends are unchanged.
///
/// # Errors
/// [`InvalidChain`], which a valid chain never causes.
pub fn narrowed(chain: &ConstrainedChain, share: f64) -> Result<PolygonalChain, InvalidChain> {
    let geometry = chain.geometry();
    let grounds = chain
        .segments()
        .iter()
        .map(|segment| {
            let [forward, reverse] = Direction::BOTH.map(|direction| {
                let allowed =
                    [Contact::Takeoff, Contact::Landing].iter().all(|&contact| segment.check_contact(contact, direction).is_ok());
                segment.stated(direction).filter(|_| allowed).map(|line| narrowed_line(line, share))
            });
            let keep_out = segment.refusal().is_some() || (forward.is_none() && reverse.is_none());
            SegmentGround { form: GroundForm::Explicit { forward, reverse }, keep_out }
        })
        .collect();
    let map = geometry.map_points().map(<[_]>::to_vec);
    PolygonalChain::new(geometry.vertices().to_vec(), grounds, map)?.with_bends(geometry.bends().to_vec())
}

/// The constraints of one direction with both cones narrowed.
fn narrowed_line(line: LineConstraints, share: f64) -> LineConstraints {
    let about = |rule: crate::chain::ContactRule, vertical: f64| {
        let towards = |angle: Angle| Angle::from_radians(vertical + share * (angle.radians() - vertical));
        let angles = AngleInterval { min: towards(rule.angles().min), max: towards(rule.angles().max) };
        crate::chain::ContactRule::new(angles, rule.speed_max_m_s())
    };
    LineConstraints {
        takeoff: about(line.takeoff, std::f64::consts::FRAC_PI_2),
        landing: about(line.landing, -std::f64::consts::FRAC_PI_2),
    }
}
