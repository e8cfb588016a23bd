//! Gravity, as a number that every formula may divide by, and the escape speed of the body that it belongs to.

/// A constant gravity, above 0 and finite, and the radius of its body where that is known.
///
/// A hop at or above the escape speed never lands, so no hop under this gravity has such a speed: see [`speed_cap_m_s`](Self::speed_cap_m_s).
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Gravity {
    m_s2: f64,
    body_radius_m: Option<f64>,
}

/// A gravity that is not a finite number above 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("gravity_m_s2 is {0}, expected a finite number above 0")]
pub struct InvalidGravity(pub f64);

/// A radius of a body that is not a finite number above 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("radius_m is {0}, expected a finite number above 0")]
pub struct InvalidRadius(pub f64);

/// How far below the escape speed the greatest speed of a hop is, as a share of it. It is far larger than the tolerance of speeds
/// (1e-9), so that no rounding lifts a hop over the escape speed; a larger value would refuse hops that land.
const BELOW_ESCAPE: f64 = 1e-6;

impl Gravity {
    /// From a number in m/s^2, of a body of unknown radius.
    ///
    /// # Errors
    /// [`InvalidGravity`] where it is not finite or not above 0.
    ///
    /// ```
    /// use chta::world::Gravity;
    /// assert_eq!(Gravity::new(3.711).unwrap().m_s2(), 3.711);
    /// assert_eq!(Gravity::new(-1.0).unwrap_err().to_string(), "gravity_m_s2 is -1, expected a finite number above 0");
    /// ```
    pub const fn new(m_s2: f64) -> Result<Self, InvalidGravity> {
        if m_s2.is_finite() && m_s2 > 0.0 { Ok(Self { m_s2, body_radius_m: None }) } else { Err(InvalidGravity(m_s2)) }
    }

    /// The same gravity at the surface of a body of this mean radius, m.
    ///
    /// # Errors
    /// [`InvalidRadius`] where it is not finite or not above 0.
    pub const fn with_radius_m(self, radius_m: f64) -> Result<Self, InvalidRadius> {
        if radius_m.is_finite() && radius_m > 0.0 {
            Ok(Self { body_radius_m: Some(radius_m), ..self })
        } else {
            Err(InvalidRadius(radius_m))
        }
    }

    /// Of a known body, whose numbers are in the source.
    pub(super) const fn known(m_s2: f64, radius_m: f64) -> Self {
        Self { m_s2, body_radius_m: Some(radius_m) }
    }

    /// In m/s^2.
    #[inline]
    pub const fn m_s2(self) -> f64 {
        self.m_s2
    }

    /// The mean radius of its body, m; `None` if unknown.
    pub const fn body_radius_m(self) -> Option<f64> {
        self.body_radius_m
    }

    /// Escape speed at the surface, m/s; `None` if the body's radius is unknown.
    ///
    /// ```text
    ///     v = sqrt(2 g R)
    /// ```
    ///
    /// ```
    /// use chta::world::Gravity;
    /// // Bennu: sqrt(2 x 8.148e-5 x 245.03) = 0.1998 m/s
    /// let bennu = Gravity::new(8.148e-5).unwrap().with_radius_m(245.03).unwrap();
    /// assert!((bennu.escape_speed_m_s().unwrap() - 0.1998).abs() < 1e-4);
    /// assert_eq!(Gravity::new(8.148e-5).unwrap().escape_speed_m_s(), None);
    /// ```
    pub fn escape_speed_m_s(self) -> Option<f64> {
        self.body_radius_m.map(|radius_m| (2.0 * self.m_s2 * radius_m).sqrt())
    }

    /// The greatest speed of a hop that lands, just below the escape speed, m/s; infinite if the body's radius is unknown.
    ///
    /// Chains and DEMs under this gravity cap every limit of speed by it.
    pub fn speed_cap_m_s(self) -> f64 {
        self.escape_speed_m_s().map_or(f64::INFINITY, |escape_m_s| escape_m_s * (1.0 - BELOW_ESCAPE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_finite_numbers_above_zero_are_gravities_and_radii() {
        let one = Gravity::new(1.0).unwrap();
        for bad in [0.0, -0.0, -9.81, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(Gravity::new(bad).is_err(), "{bad} was accepted as a gravity");
            assert!(one.with_radius_m(bad).is_err(), "{bad} was accepted as a radius");
        }
        assert_eq!(Gravity::new(1e-9).map(Gravity::m_s2), Ok(1e-9));
    }
}
