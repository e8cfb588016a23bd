//! The errors of execution by name.

/// One error of a hop's execution, by its scenario key in the table `uncertainty`.
///
/// ```
/// use chta::uncertainty::{ErrorKey, Uncertainty};
/// let scatter = Uncertainty { takeoff_speed_sigma_fraction: 0.02, drift_along_sigma_m: 0.1, ..Uncertainty::NONE };
/// let given: Vec<&str> = ErrorKey::ALL.into_iter().filter(|key| scatter.has(*key)).map(ErrorKey::name).collect();
/// assert_eq!(given, ["takeoff_speed_sigma_fraction", "drift_along_sigma_m"]);
/// assert_eq!(scatter.without(ErrorKey::DriftAlong).drift_along_sigma_m, 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ErrorKey {
    /// Take-off speed, m/s.
    TakeoffSpeed,
    /// Take-off speed, as a fraction of the commanded one.
    TakeoffSpeedFraction,
    /// Take-off angle.
    TakeoffAngle,
    /// Heading.
    Heading,
    /// Position estimate.
    Position,
    /// Bounce and roll along the direction of flight.
    DriftAlong,
    /// Bounce and roll to the side.
    DriftAcross,
    /// Friction coefficient.
    Friction,
    /// Height of the terrain, together with its correlation length.
    Height,
    /// Bias of the take-off speed.
    TakeoffSpeedBias,
    /// Bias of the take-off angle.
    TakeoffAngleBias,
    /// Bias of the heading.
    HeadingBias,
    /// The errors that a test stand measured, all together.
    Measured,
}

impl ErrorKey {
    /// All variants, in the order of the keys.
    pub const ALL: [Self; 13] = [
        Self::TakeoffSpeed,
        Self::TakeoffSpeedFraction,
        Self::TakeoffAngle,
        Self::Heading,
        Self::Position,
        Self::DriftAlong,
        Self::DriftAcross,
        Self::Friction,
        Self::Height,
        Self::TakeoffSpeedBias,
        Self::TakeoffAngleBias,
        Self::HeadingBias,
        Self::Measured,
    ];

    /// The scenario key in the table `uncertainty`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::TakeoffSpeed => "takeoff_speed_sigma_m_s",
            Self::TakeoffSpeedFraction => "takeoff_speed_sigma_fraction",
            Self::TakeoffAngle => "takeoff_angle_sigma_deg",
            Self::Heading => "heading_sigma_deg",
            Self::Position => "position_sigma_m",
            Self::DriftAlong => "drift_along_sigma_m",
            Self::DriftAcross => "drift_across_sigma_m",
            Self::Friction => "friction_sigma",
            Self::Height => "height_sigma_m",
            Self::TakeoffSpeedBias => "takeoff_speed_bias_sigma_fraction",
            Self::TakeoffAngleBias => "takeoff_angle_bias_sigma_deg",
            Self::HeadingBias => "heading_bias_sigma_deg",
            Self::Measured => "errors",
        }
    }
}

crate::quantity::by_name!(ErrorKey, ErrorKey::ALL);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        chain::csv::read_measured_csv,
        flight::{MeasuredErrors, Uncertainty},
        quantity::Angle,
    };

    #[test]
    fn every_error_is_taken_away_alone() {
        let all = all_errors();
        for key in ErrorKey::ALL {
            assert!(all.has(key) && !Uncertainty::NONE.has(key), "{key}");
            let less = all.without(key);
            for other in ErrorKey::ALL {
                assert_eq!(less.has(other), other != key, "{other} without {key}");
            }
        }
        let none = ErrorKey::ALL.into_iter().fold(all, |errors, key| errors.without(key));
        assert_eq!(none, Uncertainty::NONE);
    }

    fn all_errors() -> Uncertainty {
        let file = read_measured_csv(b"drift_along_m\n0.1\n").expect("a valid file");
        Uncertainty {
            takeoff_speed_sigma_m_s: 0.1,
            takeoff_speed_sigma_fraction: 0.1,
            takeoff_angle_sigma: Angle::from_degrees(1.0),
            heading_sigma: Angle::from_degrees(1.0),
            position_sigma_m: 0.1,
            drift_along_sigma_m: 0.1,
            drift_across_sigma_m: 0.1,
            friction_sigma: 0.1,
            height_sigma_m: 0.1,
            height_correlation_m: 1.0,
            takeoff_speed_bias_sigma_fraction: 0.1,
            takeoff_angle_bias_sigma: Angle::from_degrees(1.0),
            heading_bias_sigma: Angle::from_degrees(1.0),
            measured: Some(MeasuredErrors::of(&file)),
            ..Uncertainty::NONE
        }
    }
}
