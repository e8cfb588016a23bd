//! How a body leaves the ground again after a contact.

/// The largest restitution coefficient: above it a body bounces for thousands of contacts, and at 1 for ever.
pub(crate) const RESTITUTION_MAX: f64 = 0.99;

/// The longest bounce, m, that counts as rest where no settling speed is given.
const SETTLED_BOUNCE_M: f64 = 0.01;

/// The restitution coefficients of a hopper on its ground: which shares of its velocity it keeps at a contact.
///
/// ```text
///     v_n' = -e_n v_n,   v_t' = e_t v_t        e_n: along the normal of the facet,  e_t: along the facet
/// ```
///
/// The hopper comes to rest at the first contact after which it would be slower than the settling speed. With `e_n` = 0 it never leaves
/// the ground again, so it rests at its first contact, whatever `e_t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Restitution {
    normal: f64,
    tangential: f64,
    settling_speed_m_s: Option<f64>,
}

/// Restitution that is not valid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidRestitution {
    /// A coefficient that is not a number from 0 to 0.99.
    #[error("a restitution coefficient of {0}, expected a number from 0 to {RESTITUTION_MAX}: at 1 a body would bounce for ever")]
    Coefficient(f64),
    /// A settling speed that is not a finite number above 0.
    #[error("a settling speed of {0} m/s, expected a finite number above 0: a body at 0 m/s is slower than no other")]
    SettlingSpeed(f64),
}

impl Restitution {
    /// From the coefficients along the normal and along the facet, and the settling speed, m/s; `None` for that of
    /// [`settling_speed_m_s`](Self::settling_speed_m_s).
    ///
    /// # Errors
    /// [`InvalidRestitution`].
    ///
    /// ```
    /// use chta::world::Restitution;
    /// assert!(Restitution::new(0.3, 0.5, None).is_ok());
    /// assert!(Restitution::new(1.0, 0.5, None).is_err());
    /// assert!(Restitution::new(0.3, 0.5, Some(0.0)).is_err());
    /// ```
    pub fn new(normal: f64, tangential: f64, settling_speed_m_s: Option<f64>) -> Result<Self, InvalidRestitution> {
        if let Some(wrong) = [normal, tangential].into_iter().find(|share| !(0.0..=RESTITUTION_MAX).contains(share)) {
            return Err(InvalidRestitution::Coefficient(wrong));
        }
        match settling_speed_m_s.filter(|speed_m_s| !(speed_m_s.is_finite() && *speed_m_s > 0.0)) {
            Some(wrong) => Err(InvalidRestitution::SettlingSpeed(wrong)),
            None => Ok(Self { normal, tangential, settling_speed_m_s }),
        }
    }

    /// The share of the speed along the normal that is kept, reversed.
    #[inline]
    pub const fn normal(&self) -> f64 {
        self.normal
    }

    /// The share of the speed along the facet that is kept.
    #[inline]
    pub const fn tangential(&self) -> f64 {
        self.tangential
    }

    /// The settling speed as given, m/s.
    pub const fn stated_settling_speed_m_s(&self) -> Option<f64> {
        self.settling_speed_m_s
    }

    /// The speed below which the hopper is at rest, m/s: the one given, or else the speed whose longest bounce over level ground is one
    /// centimetre, so that it fits every gravity.
    ///
    /// ```text
    ///     v = sqrt(g 1 cm)          since no arc over level ground is longer than v^2 / g
    /// ```
    ///
    /// ```
    /// use chta::world::Restitution;
    /// let bounces = Restitution::new(0.3, 0.5, None).unwrap();
    /// // On the Moon 0.127 m/s.
    /// assert!((bounces.settling_speed_m_s(1.62) - 0.127).abs() < 1e-3);
    /// assert_eq!(Restitution::new(0.3, 0.5, Some(0.02)).unwrap().settling_speed_m_s(1.62), 0.02);
    /// ```
    pub fn settling_speed_m_s(&self, gravity_m_s2: f64) -> f64 {
        self.settling_speed_m_s.unwrap_or_else(|| (gravity_m_s2 * SETTLED_BOUNCE_M).sqrt())
    }

    /// Whether the hopper ever leaves the ground again.
    #[inline]
    pub const fn bounces(&self) -> bool {
        self.normal > 0.0
    }
}
