//! What goes wrong, as standard deviations.

use crate::quantity::Angle;

/// Standard deviations of everything that goes otherwise than planned; zero: nothing does.
///
/// Every error is Gaussian, independent of every other and of every other hop, but for friction and terrain height, which are drawn
/// once per trial.
///
/// ```
/// use chta::uncertainty::Uncertainty;
/// let scatter = Uncertainty { takeoff_speed_sigma_fraction: 0.02, ..Uncertainty::NONE };
/// assert!(scatter.check(false).is_ok());
/// assert!(Uncertainty { drift_along_sigma_m: -1.0, ..scatter }.check(false).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Uncertainty {
    /// Take-off speed, m/s. A draw below zero speed is a hop that stays where it is.
    pub takeoff_speed_sigma_m_s: f64,
    /// Take-off speed as a share of the commanded one; adds to the absolute one as a second draw.
    pub takeoff_speed_sigma_fraction: f64,
    /// Elevation of the take-off.
    pub takeoff_angle_sigma: Angle,
    /// Heading of the take-off; on a map only.
    pub heading_sigma: Angle,
    /// What the robot believes its position to be, m: on a chain along it, on a map both east and north. Only a policy that asks
    /// where the robot is can feel it.
    pub position_sigma_m: f64,
    /// Standard deviation of the bounce-and-roll displacement after a landing, along the direction of flight, m.
    pub drift_along_sigma_m: f64,
    /// The same to the side, m. On a chain, whose ground is taken to go on as it is to both sides, it moves the robot out of the
    /// plane of travel and counts as distance.
    pub drift_across_sigma_m: f64,
    /// Friction coefficient of the whole ground, one draw per trial; a coefficient below zero is zero. Without effect where limits are
    /// stated as angles.
    pub friction_sigma: f64,
    /// Height of the terrain, m: a random field, one realisation per trial.
    pub height_sigma_m: f64,
    /// Over what distance d0 the height error stays alike, m: its correlation is `exp(-d^2 / (2 d0^2))`, so that the error of the
    /// terrain's slope has the deviation `height_sigma_m / height_correlation_m`.
    pub height_correlation_m: f64,
}

/// Why deviations make no sense.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{}: {}", self.found(), self.help())]
#[non_exhaustive]
pub enum UncertaintyProblem {
    /// A deviation below zero, infinite or no number.
    Negative {
        /// Which one, by its scenario key.
        what: &'static str,
        /// What was given.
        found: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A correlation of nothing.
    CorrelationWithoutHeight {
        /// The correlation length, m.
        found: f64,
    },
    /// Height errors that change from point to point without any likeness.
    HeightWithoutCorrelation {
        /// The deviation, m.
        sigma_m: f64,
    },
    /// A heading error where there is no heading.
    HeadingOnChain {
        /// The deviation, degrees.
        found_deg: f64,
    },
}

impl UncertaintyProblem {
    /// The key that it is about, in the table `uncertainty`.
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

    /// How to mend it.
    pub const fn help(&self) -> &'static str {
        match self {
            Self::Negative { .. } => "leave it out where there is no such error",
            Self::CorrelationWithoutHeight { .. } => {
                "give height_sigma_m the deviation of the terrain's heights, or leave both out"
            }
            Self::HeightWithoutCorrelation { .. } => "give height_correlation_m the distance in m over which the error stays alike",
            Self::HeadingOnChain { .. } => "simulate on a DEM, or leave it out",
        }
    }
}

impl Uncertainty {
    /// Everything goes as planned.
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

    /// Whether the deviations make sense, on a map or on a bare chain.
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
