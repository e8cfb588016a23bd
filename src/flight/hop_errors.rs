//! From drawn errors of deviation 1 to the errors of a hop in their units.

use super::{
    TrialDraws, Uncertainty,
    draws::{HopDraws, Wanted},
    measured::MeasuredRow,
    quasi::FixedDraw,
};
use crate::{
    ground::{HeightField, Realization},
    quantity::Angle,
};

/// The errors of a run, and which draws they use.
#[derive(Clone, Debug)]
pub(crate) struct Errors {
    uncertainty: Uncertainty,
    wanted: Wanted,
    changes: Changes,
    /// Whether every heading is as likely as any other.
    any_heading: bool,
}

/// What the errors change in a command.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "one for each part of a command, all independent")]
struct Changes {
    speed: bool,
    direction: bool,
    heading: bool,
    /// Whether any of it lasts for the whole trial.
    for_the_trial: bool,
}

/// The errors of one hop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HopErrors {
    /// Of the take-off speed, as a fraction of the commanded one.
    pub(crate) speed_fraction: f64,
    /// Of the take-off speed, added to the other, m/s.
    pub(crate) speed_m_s: f64,
    /// Of the elevation of the take-off velocity.
    pub(crate) angle_rad: f64,
    /// Of its heading, clockwise.
    pub(crate) heading_rad: f64,
    /// Bounce and roll after the landing, along the direction of flight and to the side.
    pub(crate) drift_m: [f64; 2],
    /// Of the position estimate: along and across, or east and north.
    pub(crate) position_m: [f64; 2],
}

/// The errors of one hop as drawn, as they are reported.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct DrawnErrors {
    /// Actual minus commanded take-off speed, m/s; a speed below zero is set to zero.
    pub takeoff_speed_m_s: f64,
    /// Actual minus commanded elevation of the take-off velocity.
    pub takeoff_angle: Angle,
    /// Actual minus commanded heading, clockwise; zero along a chain.
    pub heading: Angle,
    /// Bounce-and-roll displacement after the landing, along the heading and to its left, m.
    pub drift_m: [f64; 2],
    /// Believed minus actual position before the hop, m: on a chain along it and to its left, on a map east and north; zero unless the
    /// policy asks for the position.
    pub position_m: [f64; 2],
    /// Added to the friction coefficient of the whole ground, one draw a trial.
    pub friction_coefficient: f64,
}

impl HopErrors {
    /// Those of a hop of this commanded speed, on ground with this error of its friction.
    pub(crate) fn drawn(&self, speed_m_s: f64, friction_coefficient: f64) -> DrawnErrors {
        DrawnErrors {
            takeoff_speed_m_s: speed_m_s * self.speed_fraction + self.speed_m_s,
            takeoff_angle: Angle::from_radians(self.angle_rad),
            heading: Angle::from_radians(self.heading_rad),
            drift_m: self.drift_m,
            position_m: self.position_m,
            friction_coefficient,
        }
    }
}

/// The errors of command that last for a whole trial: every hop has them beside its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Biases {
    speed_fraction: f64,
    angle_rad: f64,
    heading_rad: f64,
}

impl Errors {
    /// The errors of a run. `asks_position`: whether its policy uses the position estimate.
    pub(crate) fn new(uncertainty: Uncertainty, asks_position: bool) -> Self {
        let u = &uncertainty;
        let measures = |column: &dyn Fn(&MeasuredRow) -> bool| u.measured.as_ref().is_some_and(|rows| rows.any(column));
        let [angle, heading] = [u.takeoff_angle_sigma, u.heading_sigma].map(|sigma| sigma.radians() > 0.0);
        let [angle_bias, heading_bias] = [u.takeoff_angle_bias_sigma, u.heading_bias_sigma].map(|sigma| sigma.radians() > 0.0);
        let speed = u.takeoff_speed_sigma_m_s > 0.0 || u.takeoff_speed_sigma_fraction > 0.0;
        let speed_bias = u.takeoff_speed_bias_sigma_fraction > 0.0;
        let wanted = Wanted {
            speed,
            direction: angle || heading,
            drift: u.drift_along_sigma_m > 0.0 || u.drift_across_sigma_m > 0.0,
            position: u.position_sigma_m > 0.0 && asks_position,
            distribution: u.distribution,
        };
        let changes_heading = heading || heading_bias || measures(&|row| row.heading_rad != 0.0);
        let changes = Changes {
            speed: speed || speed_bias || measures(&|row| row.speed_fraction != 0.0 || row.speed_m_s != 0.0),
            direction: angle || angle_bias || changes_heading || measures(&|row| row.angle_rad != 0.0),
            heading: changes_heading,
            for_the_trial: speed_bias || angle_bias || heading_bias,
        };
        Self { uncertainty, wanted, changes, any_heading: false }
    }

    /// The errors of a robot whose heading is not controlled: that of every hop is anywhere on the circle, as likely as anywhere else,
    /// whatever was commanded. Errors of the heading have no effect.
    pub(crate) fn with_any_heading(uncertainty: Uncertainty) -> Self {
        let of_command = Self::new(uncertainty, false);
        Self { changes: Changes { direction: true, heading: true, ..of_command.changes }, any_heading: true, ..of_command }
    }

    /// Moves to the first hop of a trial; returns the errors that last for all of it.
    pub(crate) fn begin(&self, draws: &mut TrialDraws, trial: u64) -> Biases {
        let biases = if self.changes.for_the_trial {
            self.biases(draws.biases(trial, self.uncertainty.distribution))
        } else {
            Biases::default()
        };
        draws.begin(trial);
        if self.uncertainty.measured.is_some() {
            draws.begin_rows(trial);
        }
        if self.any_heading {
            draws.begin_headings(trial);
        }
        biases
    }

    /// The errors of the next hop.
    pub(crate) fn draw(&self, draws: &mut TrialDraws, biases: &Biases) -> HopErrors {
        let row = self.uncertainty.measured.as_ref().map(|measured| measured.row(draws.row()));
        let mut errors = self.of_hop(&draws.hop(self.wanted), biases, row);
        if self.any_heading {
            errors.heading_rad = std::f64::consts::TAU * draws.heading();
        }
        errors
    }

    /// The errors of a fixed draw.
    pub(crate) fn fixed(&self, draw: &FixedDraw) -> HopErrors {
        let row = self.uncertainty.measured.as_ref().map(|measured| measured.row(draw.row));
        self.of_hop(&draw.hop, &self.biases(draw.biases), row)
    }

    fn biases(&self, [speed, angle, heading]: [f64; 3]) -> Biases {
        let u = &self.uncertainty;
        Biases {
            speed_fraction: u.takeoff_speed_bias_sigma_fraction * speed,
            angle_rad: u.takeoff_angle_bias_sigma.radians() * angle,
            heading_rad: u.heading_bias_sigma.radians() * heading,
        }
    }

    fn of_hop(&self, draws: &HopDraws, biases: &Biases, row: Option<MeasuredRow>) -> HopErrors {
        let u = &self.uncertainty;
        let mut errors = HopErrors {
            speed_fraction: u.takeoff_speed_sigma_fraction * draws.speed[1] + biases.speed_fraction,
            speed_m_s: u.takeoff_speed_sigma_m_s * draws.speed[0],
            angle_rad: u.takeoff_angle_sigma.radians() * draws.direction[0] + biases.angle_rad,
            heading_rad: u.heading_sigma.radians() * draws.direction[1] + biases.heading_rad,
            drift_m: [u.drift_along_sigma_m * draws.drift[0], u.drift_across_sigma_m * draws.drift[1]],
            position_m: draws.position.map(|error| u.position_sigma_m * error),
        };
        // A column replaces its deviations, which are 0 then.
        if let Some(row) = row {
            errors.speed_fraction += row.speed_fraction;
            errors.speed_m_s += row.speed_m_s;
            errors.angle_rad += row.angle_rad;
            errors.heading_rad += row.heading_rad;
            errors.drift_m = [errors.drift_m[0] + row.drift_m[0], errors.drift_m[1] + row.drift_m[1]];
        }
        errors
    }

    /// Whether the flown speed may differ from the commanded one.
    pub(crate) const fn changes_speed(&self) -> bool {
        self.changes.speed
    }

    /// Whether the flown direction may differ from the commanded one.
    pub(crate) const fn changes_direction(&self) -> bool {
        self.changes.direction
    }

    /// Whether the flown heading may differ from the commanded one.
    pub(crate) const fn changes_heading(&self) -> bool {
        self.changes.heading
    }

    /// The realization of a trial's ground; `None` if all trials have the nominal ground.
    pub(crate) fn realization(&self, draws: &mut TrialDraws, trial: u64) -> Option<Realization> {
        let u = &self.uncertainty;
        let friction = if u.friction_sigma > 0.0 { u.friction_sigma * draws.friction(trial) } else { 0.0 };
        let heights = (u.height_sigma_m > 0.0)
            .then(|| Box::new(HeightField::drawn(draws.height_field(trial), u.height_sigma_m, u.height_correlation_m)));
        (u.friction_sigma > 0.0 || heights.is_some()).then_some(Realization { friction, heights })
    }
}
