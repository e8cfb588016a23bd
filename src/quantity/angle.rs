//! One angle type, radians inside, degrees at the edge.

use std::f64::consts::FRAC_PI_2;

use super::SlopeInterval;

/// An elevation above the direction of travel, in radians inside.
///
/// Trigonometry goes through [`libm`], so that results are byte-identical on every platform.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Default)]
pub struct Angle {
    radians: f64,
}

impl Angle {
    /// An angle from radians.
    pub const fn from_radians(radians: f64) -> Self {
        Self { radians }
    }

    /// An angle from degrees.
    ///
    /// ```
    /// use chta::quantity::Angle;
    /// assert_eq!(Angle::from_degrees(90.0).radians(), std::f64::consts::FRAC_PI_2);
    /// ```
    pub fn from_degrees(degrees: f64) -> Self {
        Self { radians: degrees.to_radians() }
    }

    /// The angle whose tangent is `slope`; infinite slopes give plus or minus a right angle.
    ///
    /// ```
    /// use chta::quantity::Angle;
    /// assert!((Angle::from_slope(1.0).degrees() - 45.0).abs() < 1e-12);
    /// assert_eq!(Angle::from_slope(f64::INFINITY).degrees(), 90.0);
    /// ```
    pub fn from_slope(slope: f64) -> Self {
        Self { radians: libm::atan(slope) }
    }

    /// In radians.
    pub const fn radians(self) -> f64 {
        self.radians
    }

    /// In degrees.
    pub fn degrees(self) -> f64 {
        self.radians.to_degrees()
    }

    /// The angle in degrees with the fewest digits that read back as exactly this angle.
    ///
    /// `None` for a non-finite angle, and for the one radian double in eleven that no double of degrees converts to (pi / 180
    /// stretches the significand).
    ///
    /// ```
    /// use chta::quantity::Angle;
    /// let angle = Angle::from_degrees(60.0);
    /// assert_eq!(angle.degrees(), 59.99999999999999);
    /// assert_eq!(angle.shortest_degrees(), Some(60.0));
    /// ```
    pub fn shortest_degrees(self) -> Option<f64> {
        let near = self.degrees();
        let neighbours = [near, near.next_up(), near.next_down(), near.next_up().next_up(), near.next_down().next_down()];
        neighbours
            .into_iter()
            .filter(|&degrees| degrees.is_finite() && Self::from_degrees(degrees).radians.to_bits() == self.radians.to_bits())
            .min_by_key(|degrees| degrees.to_string().len())
    }

    /// The angle in degrees as it is written: a number that reads back as the same angle, for every angle that was given in degrees.
    pub fn written_degrees(self) -> f64 {
        self.shortest_degrees().unwrap_or_else(|| self.degrees())
    }

    /// The tangent; plus or minus infinity at and beyond a right angle, so that an angle outside (-90, 90) degrees never has the
    /// finite slope of another direction. NaN gives NaN.
    ///
    /// ```
    /// use chta::quantity::Angle;
    /// assert_eq!(Angle::from_degrees(93.5).slope(), f64::INFINITY);
    /// assert_eq!(Angle::from_degrees(-90.0).slope(), f64::NEG_INFINITY);
    /// ```
    pub fn slope(self) -> f64 {
        if self.radians >= FRAC_PI_2 {
            f64::INFINITY
        } else if self.radians <= -FRAC_PI_2 {
            f64::NEG_INFINITY
        } else {
            libm::tan(self.radians)
        }
    }
}

impl std::ops::Neg for Angle {
    type Output = Self;

    fn neg(self) -> Self {
        Self { radians: -self.radians }
    }
}

/// A closed interval of angles as given by the user or a cone, not yet restricted to (-90, 90) degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleInterval {
    /// The lower end.
    pub min: Angle,
    /// The upper end.
    pub max: Angle,
}

impl AngleInterval {
    /// From its two ends in degrees.
    pub fn from_degrees(min_deg: f64, max_deg: f64) -> Self {
        Self { min: Angle::from_degrees(min_deg), max: Angle::from_degrees(max_deg) }
    }

    /// From the centre and the half-width, both in radians.
    pub fn about(centre: Angle, half_width: Angle) -> Self {
        let (c, h) = (centre.radians(), half_width.radians());
        Self { min: Angle::from_radians(c - h), max: Angle::from_radians(c + h) }
    }

    /// The slopes of the directions inside (-90, 90) degrees.
    ///
    /// A lower end at or below -90 degrees, or an upper end at or above +90, sets no bound. A lower end at or above +90, or
    /// an upper end at or below -90, leaves the empty interval (model section 1).
    ///
    /// ```
    /// use chta::quantity::AngleInterval;
    /// let paper = AngleInterval::from_degrees(63.5, 93.5).slopes();
    /// assert_eq!(paper.upper, f64::INFINITY);
    /// assert!(AngleInterval::from_degrees(90.0, 120.0).slopes().is_empty());
    /// ```
    pub fn slopes(self) -> SlopeInterval {
        let (lower, upper) = (self.min.slope(), self.max.slope());
        if lower == f64::INFINITY || upper == f64::NEG_INFINITY || lower.is_nan() || upper.is_nan() || lower > upper {
            SlopeInterval::EMPTY
        } else {
            SlopeInterval { lower, upper }
        }
    }
}
