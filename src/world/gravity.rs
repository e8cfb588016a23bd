//! Gravity, as a number that every formula may divide by.

/// A constant gravity, above 0 and finite.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Gravity {
    m_s2: f64,
}

/// A gravity that is not a finite number above 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("gravity_m_s2 is {0}, expected a finite number above 0")]
pub struct InvalidGravity(pub f64);

impl Gravity {
    /// From a number in m/s^2.
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
        if m_s2.is_finite() && m_s2 > 0.0 { Ok(Self { m_s2 }) } else { Err(InvalidGravity(m_s2)) }
    }

    /// Of a known body, whose number is in the source.
    pub(super) const fn known(m_s2: f64) -> Self {
        Self { m_s2 }
    }

    /// In m/s^2.
    #[inline]
    pub const fn m_s2(self) -> f64 {
        self.m_s2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_finite_numbers_above_zero_are_gravities() {
        for m_s2 in [0.0, -0.0, -9.81, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(Gravity::new(m_s2).is_err(), "{m_s2} was accepted");
        }
        assert_eq!(Gravity::new(1e-9).map(Gravity::m_s2), Ok(1e-9));
    }
}
