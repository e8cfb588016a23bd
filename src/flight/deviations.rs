//! The errors of execution, as standard deviations.

use super::ErrorKey;
use crate::quantity::Angle;

/// Standard deviations of all errors of a hop's execution; zero means no error.
///
/// Every error is Gaussian, and independent of all others and of those of other hops, except friction and terrain height, which are
/// drawn once per trial.
///
/// ```
/// use chta::uncertainty::Uncertainty;
/// let scatter = Uncertainty { takeoff_speed_sigma_fraction: 0.02, ..Uncertainty::NONE };
/// assert!(scatter.check(false).is_ok());
/// assert!(Uncertainty { drift_along_sigma_m: -1.0, ..scatter }.check(false).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default)]
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
        /// The deviation, degrees.
        found_deg: f64,
    },
}

impl UncertaintyProblem {
    /// The key concerned, in the table `uncertainty`.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Negative { what, .. } => what,
            Self::CorrelationWithoutHeight { .. } => "height_correlation_m",
            Self::HeightWithoutCorrelation { .. } => "height_sigma_m",
            Self::HeadingOnChain { .. } => "heading_sigma_deg",
        }
    }

    /// What was found, in a sentence that begins with the key.
    pub fn found(&self) -> String {
        let key = self.key();
        match self {
            Self::Negative { found, unit, .. } => format!("{key} is {found} {unit}, expected a finite number of at least 0"),
            Self::CorrelationWithoutHeight { found } => format!("{key} is {found} m but height_sigma_m is 0"),
            Self::HeightWithoutCorrelation { sigma_m } => format!("{key} is {sigma_m} m but height_correlation_m is 0"),
            Self::HeadingOnChain { found_deg } => format!("{key} is {found_deg} deg on a chain, which has one plane of travel"),
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
    };

    /// Every deviation by its scenario key, in the unit of that key.
    pub fn by_key(&self) -> [(&'static str, f64, &'static str); 10] {
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
        ]
    }

    /// Whether there is such an error.
    pub fn has(&self, key: ErrorKey) -> bool {
        self.without(key) != *self
    }

    /// The same without one error. The correlation length goes with the error of heights.
    #[must_use]
    pub fn without(&self, key: ErrorKey) -> Self {
        let mut rest = *self;
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
        }
        rest
    }

    /// All deviations multiplied by a factor; the correlation length of heights is no deviation and stays.
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
        } = *self;
        Self {
            takeoff_speed_sigma_m_s: factor * takeoff_speed_sigma_m_s,
            takeoff_speed_sigma_fraction: factor * takeoff_speed_sigma_fraction,
            takeoff_angle_sigma: Angle::from_radians(factor * takeoff_angle_sigma.radians()),
            heading_sigma: Angle::from_radians(factor * heading_sigma.radians()),
            position_sigma_m: factor * position_sigma_m,
            drift_along_sigma_m: factor * drift_along_sigma_m,
            drift_across_sigma_m: factor * drift_across_sigma_m,
            friction_sigma: factor * friction_sigma,
            height_sigma_m: factor * height_sigma_m,
            height_correlation_m,
        }
    }

    /// Checks the deviations, for a map or a chain without one.
    ///
    /// # Errors
    /// The first [`UncertaintyProblem`].
    pub fn check(&self, on_a_map: bool) -> Result<(), UncertaintyProblem> {
        for (what, found, unit) in self.by_key() {
            if !(found.is_finite() && found >= 0.0) {
                return Err(UncertaintyProblem::Negative { what, found, unit });
            }
        }
        if self.height_correlation_m > 0.0 && self.height_sigma_m == 0.0 {
            return Err(UncertaintyProblem::CorrelationWithoutHeight { found: self.height_correlation_m });
        }
        if self.height_sigma_m > 0.0 && self.height_correlation_m == 0.0 {
            return Err(UncertaintyProblem::HeightWithoutCorrelation { sigma_m: self.height_sigma_m });
        }
        if self.heading_sigma.radians() > 0.0 && !on_a_map {
            return Err(UncertaintyProblem::HeadingOnChain { found_deg: self.heading_sigma.degrees() });
        }
        Ok(())
    }
}
