//! The take-off speeds of a machine with fixed settings.

use super::SPEED_TOLERANCE;

/// The only take-off speeds that a machine has, ascending: fixed settings of a spring or a thruster. Stored inline, so that a hopper
/// can be copied.
#[derive(Clone, Copy, PartialEq)]
pub struct SpeedLevels {
    m_s: [f64; Self::MOST],
    count: usize,
}

/// Why a list of speeds is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidLevels {
    /// No level.
    #[error("an empty list, expected at least one speed")]
    Empty,
    /// More levels than are kept.
    #[error("a list of {0} speeds, expected at most {most}", most = SpeedLevels::MOST)]
    TooMany(usize),
    /// A speed that no machine has.
    #[error("a list with {0}, expected finite speeds above 0")]
    NoSpeed(f64),
    /// Two neighbours that are equal, or in descending order.
    #[error("a list with {1} after {0}, expected ascending speeds without repetition")]
    NotAscending(f64, f64),
}

impl SpeedLevels {
    /// The most levels of one machine.
    pub const MOST: usize = 16;

    /// From a list of speeds, m/s.
    ///
    /// # Errors
    /// The first [`InvalidLevels`]. Two levels closer than the tolerance of speeds count as a repetition.
    ///
    /// # Examples
    /// ```
    /// use chta::world::SpeedLevels;
    /// assert_eq!(SpeedLevels::new(&[2.0, 4.0]).unwrap().as_slice(), [2.0, 4.0]);
    /// let said = SpeedLevels::new(&[4.0, 2.0]).unwrap_err().to_string();
    /// assert_eq!(said, "a list with 2 after 4, expected ascending speeds without repetition");
    /// ```
    pub fn new(m_s: &[f64]) -> Result<Self, InvalidLevels> {
        if m_s.is_empty() {
            return Err(InvalidLevels::Empty);
        }
        if m_s.len() > Self::MOST {
            return Err(InvalidLevels::TooMany(m_s.len()));
        }
        if let Some(&wrong) = m_s.iter().find(|speed| !(speed.is_finite() && **speed > 0.0)) {
            return Err(InvalidLevels::NoSpeed(wrong));
        }
        let apart = |pair: &[f64]| pair[1] > pair[0] * (1.0 + 4.0 * SPEED_TOLERANCE);
        if let Some(pair) = m_s.windows(2).find(|pair| !apart(pair)) {
            return Err(InvalidLevels::NotAscending(pair[0], pair[1]));
        }
        let mut levels = Self { m_s: [0.0; Self::MOST], count: m_s.len() };
        levels.m_s[..m_s.len()].copy_from_slice(m_s);
        Ok(levels)
    }

    /// The speeds, m/s, ascending; at least one.
    #[inline]
    pub fn as_slice(&self) -> &[f64] {
        &self.m_s[..self.count]
    }

    /// The lowest, m/s.
    pub const fn lowest_m_s(&self) -> f64 {
        self.m_s[0]
    }

    /// The highest, m/s.
    pub const fn highest_m_s(&self) -> f64 {
        self.m_s[self.count - 1]
    }

    /// All speeds times a positive factor.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.m_s.iter_mut().for_each(|speed| *speed *= factor);
        self
    }
}

impl std::fmt::Debug for SpeedLevels {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.as_slice()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_lists_are_refused_with_their_reason() {
        let table: [(&[f64], InvalidLevels); 8] = [
            (&[], InvalidLevels::Empty),
            (&[1.0; 17], InvalidLevels::TooMany(17)),
            (&[0.0, 1.0], InvalidLevels::NoSpeed(0.0)),
            (&[1.0, -2.0], InvalidLevels::NoSpeed(-2.0)),
            (&[1.0, f64::INFINITY], InvalidLevels::NoSpeed(f64::INFINITY)),
            (&[2.0, 1.0], InvalidLevels::NotAscending(2.0, 1.0)),
            (&[1.0, 2.0, 2.0], InvalidLevels::NotAscending(2.0, 2.0)),
            (&[2.0, 2.000_000_001], InvalidLevels::NotAscending(2.0, 2.000_000_001)),
        ];
        for (list, reason) in table {
            assert_eq!(SpeedLevels::new(list), Err(reason), "{list:?}");
        }
        assert!(SpeedLevels::new(&[f64::NAN]).is_err());
        assert_eq!(SpeedLevels::new(&[1e-9, 1e5]).map(|levels| levels.highest_m_s()), Ok(1e5));
    }
}
