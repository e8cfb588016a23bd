//! The steps in which a machine takes its commands.

use super::{
    HopperLimits, HopperProblem,
    hopper::{POSITIVE, Problems, positive},
};
use crate::quantity::Angle;

/// The steps of a machine's commands: every command is a whole multiple of its step. A command without a step takes any value.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct CommandSteps {
    /// Of the take-off angle above the horizontal.
    pub takeoff_angle: Option<Angle>,
    /// Of the take-off speed, m/s.
    pub takeoff_speed_m_s: Option<f64>,
    /// Of the heading, clockwise from grid north.
    pub heading: Option<Angle>,
}

/// A multiple of a step within this fraction of the step is that multiple: far more than rounding.
const ROUNDING: f64 = 1e-9;

impl CommandSteps {
    /// A machine that takes any command.
    pub const CONTINUOUS: Self = Self { takeoff_angle: None, takeoff_speed_m_s: None, heading: None };

    /// Whether the machine takes any command.
    pub fn is_continuous(&self) -> bool {
        *self == Self::CONTINUOUS
    }

    /// Whether the machine has a heading, clockwise from grid north: a multiple of the step within one turn, but for rounding.
    pub fn has_heading(&self, heading_deg: f64) -> bool {
        let Some(step_deg) = self.heading.map(Angle::degrees) else { return true };
        let nearest_deg = headings_near(heading_deg, step_deg).first().copied().unwrap_or(0.0);
        let off_deg = (heading_deg - nearest_deg + 180.0).rem_euclid(360.0) - 180.0;
        is_multiple(off_deg, step_deg)
    }

    /// The greatest speed command that is not above a limit, m/s; the limit itself without a step, and 0 below the first step.
    ///
    /// ```
    /// use chta::world::CommandSteps;
    /// let steps = CommandSteps { takeoff_speed_m_s: Some(0.5), ..CommandSteps::CONTINUOUS };
    /// assert_eq!([4.9, 5.0, 0.4, f64::INFINITY].map(|limit| steps.speed_not_above_m_s(limit)), [4.5, 5.0, 0.0, f64::INFINITY]);
    /// ```
    pub fn speed_not_above_m_s(&self, limit_m_s: f64) -> f64 {
        match self.takeoff_speed_m_s {
            Some(step) if limit_m_s.is_finite() => (step * (limit_m_s / step + ROUNDING).floor()).min(limit_m_s),
            _ => limit_m_s,
        }
    }
}

/// What is wrong with the steps of a hopper.
pub(super) fn problems(limits: &HopperLimits) -> Vec<HopperProblem> {
    let CommandSteps { takeoff_angle, takeoff_speed_m_s, heading } = limits.steps;
    let mut problems = Problems::default();
    let mut ask = |key, value, holds: &dyn Fn(f64) -> bool, expected| problems.ask(key, value, holds, expected);
    ask("takeoff_angle_step_deg", takeoff_angle.map(Angle::degrees), &positive, POSITIVE);
    ask("takeoff_speed_step_m_s", takeoff_speed_m_s, &positive, POSITIVE);
    let sound_m_s = takeoff_speed_m_s.filter(|&step| positive(step));
    ask("takeoff_speed_step_m_s", sound_m_s, &|step| step <= limits.takeoff_speed_max_m_s, "no more than takeoff_speed_max_m_s");
    ask(
        "takeoff_speed_step_m_s",
        sound_m_s,
        &|_| limits.takeoff_speed_levels.is_none(),
        "not to stand beside takeoff_speed_levels_m_s, which are all speeds that the machine has",
    );
    ask("heading_step_deg", heading.map(Angle::degrees), &positive, POSITIVE);
    problems.0
}

/// The multiple of a step that is nearest to a value.
///
/// ```
/// assert_eq!(chta::world::nearest_multiple(44.0, 2.5), 45.0);
/// ```
pub fn nearest_multiple(value: f64, step: f64) -> f64 {
    step * libm::rint(value / step)
}

/// Whether a value is a multiple of a step, but for rounding.
pub fn is_multiple(value: f64, step: f64) -> bool {
    (value - nearest_multiple(value, step)).abs() <= ROUNDING * step
}

/// How many multiples of a step are tried around a value, the nearest first, to either side.
const NEAREST: i32 = 24;

/// The multiples of a step around a value, the nearest first.
pub(crate) fn multiples(value: f64, step: f64) -> impl Iterator<Item = f64> {
    let nearest = libm::rint(value / step);
    // The second nearest lies on the other side of the value.
    let side = if value >= nearest * step { 1.0 } else { -1.0 };
    (0..2 * NEAREST).map(move |i| {
        let away = f64::from((i + 1) / 2) * if i % 2 == 1 { side } else { -side };
        (nearest + away) * step
    })
}

/// The headings of a machine near a heading, the nearest first: the multiples of the step from 0 to below 360 degrees.
///
/// Where the step divides no full turn, the last of them lies less than a step before north.
pub(crate) fn headings_near(heading_deg: f64, step_deg: f64) -> Vec<f64> {
    let heading_deg = heading_deg.rem_euclid(360.0);
    let apart = |degrees: &f64| ((degrees - heading_deg + 540.0).rem_euclid(360.0) - 180.0).abs();
    let around = [heading_deg, heading_deg - 360.0, heading_deg + 360.0].into_iter().flat_map(|near| multiples(near, step_deg));
    let mut found: Vec<f64> = around.filter(|degrees| (0.0..360.0).contains(degrees)).collect();
    found.sort_by(f64::total_cmp);
    found.dedup();
    found.sort_by(|a, b| apart(a).total_cmp(&apart(b)));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_are_known_despite_rounding() {
        for (step, times) in [(0.1, 3.0), (0.7, 1e6), (1e-3, 12_345.0), (2.5, -36.0)] {
            assert!(is_multiple(step * times, step), "{step} x {times}");
            assert!(!is_multiple(step * (times + 1e-6), step), "{step} x {times}");
        }
        // 0.3 / 0.1 is 2.999...: the third step is not lost.
        let steps = CommandSteps { takeoff_speed_m_s: Some(0.1), ..CommandSteps::CONTINUOUS };
        assert_eq!(steps.speed_not_above_m_s(0.3), 0.3);
    }

    #[test]
    fn multiples_come_in_the_order_of_distance() {
        for (value, step) in [(7.3, 2.0), (-3.1, 0.5), (0.0, 1.0), (44.99, 5.0)] {
            let found: Vec<f64> = multiples(value, step).collect();
            let away = |multiple: &f64| (multiple - value).abs();
            assert!(found.windows(2).all(|pair| away(&pair[0]) <= away(&pair[1]) + 1e-12), "{value}: {found:?}");
            assert!(found.iter().all(|multiple| is_multiple(*multiple, step)));
        }
        assert_eq!(multiples(7.3, 2.0).take(4).collect::<Vec<_>>(), [8.0, 6.0, 10.0, 4.0]);
    }

    #[test]
    fn headings_are_multiples_of_one_turn() {
        for (heading, step, expected) in [
            (6.8, 5.0, [5.0, 10.0]),
            (359.0, 5.0, [0.0, 355.0]),
            (1.0, 5.0, [0.0, 5.0]),
            // Seven degrees divide no full turn: the last one is 357.
            (359.0, 7.0, [0.0, 357.0]),
            (358.0, 7.0, [357.0, 0.0]),
            (-2.5, 7.0, [357.0, 0.0]),
            (10.0, 200.0, [0.0, 200.0]),
        ] {
            assert_eq!(headings_near(heading, step)[..2], expected, "{heading} by {step}");
        }
    }
}
