//! The errors of execution: standard deviations, or rows of measurements.

use super::{Distribution, ErrorKey, MeasuredErrors};
use crate::quantity::Angle;

/// Standard deviations of all errors of a hop's execution; zero means no error.
///
/// Errors are independent of one another and of those of other hops, except three kinds. Friction, terrain height and the biases are drawn
/// once per trial: a bias is added to the own error of every hop of it. Measured errors are resampled row by row: what one row has stays
/// together, and rows of different hops are independent. Errors of command, position and drift, and biases, have the given
/// [`Distribution`]; friction and height are Gaussian.
///
/// ```
/// use chta::uncertainty::Uncertainty;
/// let scatter = Uncertainty { takeoff_speed_sigma_fraction: 0.02, ..Uncertainty::NONE };
/// assert!(scatter.check(false).is_ok());
/// assert!(Uncertainty { drift_along_sigma_m: -1.0, ..scatter }.check(false).is_err());
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Uncertainty {
    /// Take-off speed, m/s. If the drawn speed is below zero, the hopper stays where it is.
    pub takeoff_speed_sigma_m_s: f64,
    /// Take-off speed as a fraction of the commanded one; a second draw, added to the absolute error.
    pub takeoff_speed_sigma_fraction: f64,
    /// Elevation of the take-off velocity.
    pub takeoff_angle_sigma: Angle,
    /// Heading of the take-off velocity; on a map only.
    pub heading_sigma: Angle,
    /// Error of the position estimate, m: on a chain along it, on a map both east and north. It only matters to a policy that uses
    /// the position estimate.
    pub position_sigma_m: f64,
    /// Standard deviation of the bounce-and-roll displacement after a landing, along the direction of flight, m.
    pub drift_along_sigma_m: f64,
    /// The same to the side, m. A chain's ground is taken to extend unchanged to both sides; there the displacement moves the robot
    /// out of the plane of travel and counts as distance.
    pub drift_across_sigma_m: f64,
    /// Friction coefficient of the whole ground, one draw per trial; a coefficient below zero is set to zero. It has no effect
    /// where limits are stated as angles.
    pub friction_sigma: f64,
    /// Height of the terrain, m: a random field, one realization per trial.
    pub height_sigma_m: f64,
    /// Correlation length d0 of the height error, m: its correlation is `exp(-d^2 / (2 d0^2))`, so the error of the terrain's slope
    /// has the deviation `height_sigma_m / height_correlation_m`.
    pub height_correlation_m: f64,
    /// Take-off speed as a fraction of the commanded one, one draw per trial, added to the error of every hop.
    pub takeoff_speed_bias_sigma_fraction: f64,
    /// Elevation of the take-off velocity, one draw per trial, added to the error of every hop.
    pub takeoff_angle_bias_sigma: Angle,
    /// Heading of the take-off velocity, one draw per trial, added to the error of every hop; on a map only.
    pub heading_bias_sigma: Angle,
    /// How the errors of command, position and drift, and the biases, are distributed.
    pub distribution: Distribution,
    /// Errors of single hops as measured, in place of the deviations of the same errors.
    pub measured: Option<MeasuredErrors>,
}

/// Why deviations are not valid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{}: {}", self.found(), self.help())]
#[non_exhaustive]
pub enum UncertaintyProblem {
    /// A deviation below zero, infinite or NaN.
    Negative {
        /// Its scenario key.
        what: &'static str,
        /// What was given.
        found: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A correlation length without a height error.
    CorrelationWithoutHeight {
        /// The correlation length, m.
        found: f64,
    },
    /// A height error without a correlation length.
    HeightWithoutCorrelation {
        /// The deviation, m.
        sigma_m: f64,
    },
    /// A heading error on a chain without a map.
    HeadingOnChain {
        /// [`ErrorKey::Heading`] or [`ErrorKey::HeadingBias`].
        key: ErrorKey,
        /// The deviation, degrees.
        found_deg: f64,
    },
    /// Measured errors of the heading on a chain without a map.
    MeasuredHeadingOnChain,
    /// Measured errors that are not read from their file yet.
    Unread,
    /// A deviation of an error that was measured.
    Replaced {
        /// The error.
        key: ErrorKey,
        /// Its deviation.
        found: f64,
        /// The unit of the deviation.
        unit: &'static str,
        /// The column of the measured errors that replaces it.
        column: &'static str,
    },
}

impl UncertaintyProblem {
    /// The key concerned, in the table `uncertainty`.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Negative { what, .. } => what,
            Self::CorrelationWithoutHeight { .. } => "height_correlation_m",
            Self::HeightWithoutCorrelation { .. } => "height_sigma_m",
            Self::HeadingOnChain { key, .. } | Self::Replaced { key, .. } => key.name(),
            Self::MeasuredHeadingOnChain | Self::Unread => ErrorKey::Measured.name(),
        }
    }

    /// What was found, in a sentence that begins with the key.
    pub fn found(&self) -> String {
        let key = self.key();
        match self {
            Self::Negative { found, unit, .. } => format!("{key} is {found} {unit}, expected a finite number of at least 0"),
            Self::CorrelationWithoutHeight { found } => format!("{key} is {found} m but height_sigma_m is 0"),
            Self::HeightWithoutCorrelation { sigma_m } => format!("{key} is {sigma_m} m but height_correlation_m is 0"),
            Self::HeadingOnChain { found_deg, .. } => format!("{key} is {found_deg} deg on a chain, which has one plane of travel"),
            Self::MeasuredHeadingOnChain => {
                format!("{key} names measured errors of the heading, but a chain has one plane of travel")
            }
            Self::Unread => format!("{key} names measured errors that were not read from their file"),
            Self::Replaced { found, unit, column, .. } => {
                format!("{key} is {found} {unit} beside measured errors with the column {column}, which replaces it")
            }
        }
    }

    /// How to correct it.
    pub const fn help(&self) -> &'static str {
        match self {
            Self::Negative { .. } => "leave it out if there is no such error",
            Self::CorrelationWithoutHeight { .. } => {
                "set height_sigma_m to the standard deviation of the terrain's heights, or leave both out"
            }
            Self::HeightWithoutCorrelation { .. } => "set height_correlation_m to the correlation length of the height error, m",
            Self::HeadingOnChain { .. } => "simulate on a DEM, or leave it out",
            Self::MeasuredHeadingOnChain => "simulate on a DEM, or take the errors without their heading",
            Self::Unread => "read them first",
            Self::Replaced { .. } => "remove the key, or the column from the file that errors names",
        }
    }
}

impl Uncertainty {
    /// No errors: everything is executed as planned.
    pub const NONE: Self = Self {
        takeoff_speed_sigma_m_s: 0.0,
        takeoff_speed_sigma_fraction: 0.0,
        takeoff_angle_sigma: Angle::from_radians(0.0),
        heading_sigma: Angle::from_radians(0.0),
        position_sigma_m: 0.0,
        drift_along_sigma_m: 0.0,
        drift_across_sigma_m: 0.0,
        friction_sigma: 0.0,
        height_sigma_m: 0.0,
        height_correlation_m: 0.0,
        takeoff_speed_bias_sigma_fraction: 0.0,
        takeoff_angle_bias_sigma: Angle::from_radians(0.0),
        heading_bias_sigma: Angle::from_radians(0.0),
        distribution: Distribution::Normal,
        measured: None,
    };

    /// Every deviation by its scenario key, in the unit of that key.
    pub fn by_key(&self) -> [(&'static str, f64, &'static str); 13] {
        [
            ("takeoff_speed_sigma_m_s", self.takeoff_speed_sigma_m_s, "m/s"),
            ("takeoff_speed_sigma_fraction", self.takeoff_speed_sigma_fraction, "of the speed"),
            ("takeoff_angle_sigma_deg", self.takeoff_angle_sigma.degrees(), "deg"),
            ("heading_sigma_deg", self.heading_sigma.degrees(), "deg"),
            ("position_sigma_m", self.position_sigma_m, "m"),
            ("drift_along_sigma_m", self.drift_along_sigma_m, "m"),
            ("drift_across_sigma_m", self.drift_across_sigma_m, "m"),
            ("friction_sigma", self.friction_sigma, "of friction coefficient"),
            ("height_sigma_m", self.height_sigma_m, "m"),
            ("height_correlation_m", self.height_correlation_m, "m"),
            ("takeoff_speed_bias_sigma_fraction", self.takeoff_speed_bias_sigma_fraction, "of the speed"),
            ("takeoff_angle_bias_sigma_deg", self.takeoff_angle_bias_sigma.degrees(), "deg"),
            ("heading_bias_sigma_deg", self.heading_bias_sigma.degrees(), "deg"),
        ]
    }

    /// Whether there is such an error.
    pub fn has(&self, key: ErrorKey) -> bool {
        self.without(key) != *self
    }

    /// Whether there is no error at all; a distribution alone makes none.
    pub fn is_none(&self) -> bool {
        *self == Self { distribution: self.distribution, ..Self::NONE }
    }

    /// The same in one plane of travel: without errors of the heading.
    #[must_use]
    pub fn in_one_plane(&self) -> Self {
        let measured = self.measured.as_ref().map(MeasuredErrors::without_heading);
        Self { measured, ..self.without(ErrorKey::Heading).without(ErrorKey::HeadingBias) }
    }

    /// The same without one error. The correlation length goes with the error of heights.
    #[must_use]
    pub fn without(&self, key: ErrorKey) -> Self {
        let mut rest = self.clone();
        match key {
            ErrorKey::TakeoffSpeed => rest.takeoff_speed_sigma_m_s = 0.0,
            ErrorKey::TakeoffSpeedFraction => rest.takeoff_speed_sigma_fraction = 0.0,
            ErrorKey::TakeoffAngle => rest.takeoff_angle_sigma = Angle::from_radians(0.0),
            ErrorKey::Heading => rest.heading_sigma = Angle::from_radians(0.0),
            ErrorKey::Position => rest.position_sigma_m = 0.0,
            ErrorKey::DriftAlong => rest.drift_along_sigma_m = 0.0,
            ErrorKey::DriftAcross => rest.drift_across_sigma_m = 0.0,
            ErrorKey::Friction => rest.friction_sigma = 0.0,
            ErrorKey::Height => (rest.height_sigma_m, rest.height_correlation_m) = (0.0, 0.0),
            ErrorKey::TakeoffSpeedBias => rest.takeoff_speed_bias_sigma_fraction = 0.0,
            ErrorKey::TakeoffAngleBias => rest.takeoff_angle_bias_sigma = Angle::from_radians(0.0),
            ErrorKey::HeadingBias => rest.heading_bias_sigma = Angle::from_radians(0.0),
            ErrorKey::Measured => rest.measured = None,
        }
        rest
    }

    /// All errors multiplied by a factor; the correlation length of heights is no deviation and stays.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        // No `..`, so that a new deviation is not left as it was.
        let Self {
            takeoff_speed_sigma_m_s,
            takeoff_speed_sigma_fraction,
            takeoff_angle_sigma,
            heading_sigma,
            position_sigma_m,
            drift_along_sigma_m,
            drift_across_sigma_m,
            friction_sigma,
            height_sigma_m,
            height_correlation_m,
            takeoff_speed_bias_sigma_fraction,
            takeoff_angle_bias_sigma,
            heading_bias_sigma,
            distribution,
            ref measured,
        } = *self;
        let angle = |sigma: Angle| Angle::from_radians(factor * sigma.radians());
        Self {
            takeoff_speed_sigma_m_s: factor * takeoff_speed_sigma_m_s,
            takeoff_speed_sigma_fraction: factor * takeoff_speed_sigma_fraction,
            takeoff_angle_sigma: angle(takeoff_angle_sigma),
            heading_sigma: angle(heading_sigma),
            position_sigma_m: factor * position_sigma_m,
            drift_along_sigma_m: factor * drift_along_sigma_m,
            drift_across_sigma_m: factor * drift_across_sigma_m,
            friction_sigma: factor * friction_sigma,
            height_sigma_m: factor * height_sigma_m,
            height_correlation_m,
            takeoff_speed_bias_sigma_fraction: factor * takeoff_speed_bias_sigma_fraction,
            takeoff_angle_bias_sigma: angle(takeoff_angle_bias_sigma),
            heading_bias_sigma: angle(heading_bias_sigma),
            distribution,
            measured: measured.as_ref().map(|rows| rows.scaled(factor)),
        }
    }

    /// Checks the errors, for a map or a chain without one.
    ///
    /// # Errors
    /// The first [`UncertaintyProblem`].
    pub fn check(&self, on_a_map: bool) -> Result<(), UncertaintyProblem> {
        self.problems(on_a_map).first().map_or(Ok(()), |problem| Err(*problem))
    }

    /// Every problem of the errors, for a map or a chain without one.
    pub fn problems(&self, on_a_map: bool) -> Vec<UncertaintyProblem> {
        let mut problems = self.problems_of_deviations(on_a_map);
        problems.extend(self.problems_of_measured(on_a_map));
        problems
    }

    /// Every problem of the deviations by themselves, for a map or a chain without one.
    pub fn problems_of_deviations(&self, on_a_map: bool) -> Vec<UncertaintyProblem> {
        let negative = self.by_key().into_iter().filter(|(_, found, _)| !(found.is_finite() && *found >= 0.0));
        let mut problems: Vec<UncertaintyProblem> =
            negative.map(|(what, found, unit)| UncertaintyProblem::Negative { what, found, unit }).collect();
        if self.height_correlation_m > 0.0 && self.height_sigma_m == 0.0 {
            problems.push(UncertaintyProblem::CorrelationWithoutHeight { found: self.height_correlation_m });
        }
        if self.height_sigma_m > 0.0 && self.height_correlation_m == 0.0 {
            problems.push(UncertaintyProblem::HeightWithoutCorrelation { sigma_m: self.height_sigma_m });
        }
        let of_heading = [(ErrorKey::Heading, self.heading_sigma), (ErrorKey::HeadingBias, self.heading_bias_sigma)];
        let on_chain = of_heading.into_iter().filter(|(_, sigma)| sigma.radians() > 0.0 && !on_a_map);
        problems.extend(on_chain.map(|(key, sigma)| UncertaintyProblem::HeadingOnChain { key, found_deg: sigma.degrees() }));
        problems
    }

    /// Measured errors that are not read, that have a heading on a chain, or beside which there is a deviation of the same error.
    fn problems_of_measured(&self, on_a_map: bool) -> Vec<UncertaintyProblem> {
        let Some(measured) = &self.measured else { return Vec::new() };
        if measured.row_count() == 0 {
            return vec![UncertaintyProblem::Unread];
        }
        let given = self.by_key().into_iter().filter(|(_, found, _)| *found > 0.0);
        let replaced = given.filter_map(|(name, found, unit)| {
            let key = ErrorKey::ALL.into_iter().find(|key| key.name() == name)?;
            Some(UncertaintyProblem::Replaced { key, found, unit, column: measured.replaces(key)? })
        });
        let heading = (measured.has_heading() && !on_a_map).then_some(UncertaintyProblem::MeasuredHeadingOnChain);
        heading.into_iter().chain(replaced).collect()
    }
}
