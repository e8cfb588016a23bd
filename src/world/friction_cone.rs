//! The friction cone and its intersection with the vertical plane of travel.

use crate::quantity::Angle;

/// A Coulomb friction cone: forces within `atan mu` of the surface normal do not slide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionCone {
    coefficient: f64,
}

/// A friction coefficient that is NaN, infinite or negative.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("friction coefficient {0} is not a finite number of at least 0 (dry rock and regolith: 0.3 to 1.2)")]
pub struct InvalidFriction(pub f64);

impl FrictionCone {
    /// The cone of a friction coefficient `mu`.
    ///
    /// # Errors
    /// [`InvalidFriction`] if `mu` is negative or not finite.
    pub fn new(coefficient: f64) -> Result<Self, InvalidFriction> {
        if coefficient.is_finite() && coefficient >= 0.0 { Ok(Self { coefficient }) } else { Err(InvalidFriction(coefficient)) }
    }

    /// The friction coefficient `mu`.
    pub const fn coefficient(self) -> f64 {
        self.coefficient
    }

    /// The cone's half-angle `phi = atan mu`.
    pub fn half_angle(self) -> Angle {
        Angle::from_slope(self.coefficient)
    }

    /// The half-angle of the planar cone in which a vertical plane of travel intersects this cone.
    ///
    /// ```text
    ///     delta = acos(cos phi / cos chi),   tan delta = sqrt((mu - t)(mu + t) / (1 + t^2)),   t = tan chi
    /// ```
    ///
    /// where `chi` is the angle between the surface normal and the plane. The second form, used here, keeps its digits near
    /// `chi = phi`, where the planar cone closes, and for small `mu`.
    ///
    /// Source: model section 1; the intersection with the plane is that of Campana and Laumond 2016, section IV-A.
    ///
    /// # Units
    /// `cross_slope`: the angle chi, 0 to 90 degrees.
    ///
    /// # Returns
    /// The half-angle delta; `None` if the plane misses the cone (`chi > phi`). `chi = phi` gives zero.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::Angle, world::FrictionCone};
    /// let cone = FrictionCone::new(1.0).unwrap();          // 45 degrees
    /// let flat = cone.cut(Angle::from_degrees(0.0)).unwrap();
    /// assert!((flat.degrees() - 45.0).abs() < 1e-12);
    /// // cos 45 / cos 30 = 0.8165: 35.26 degrees
    /// let side = cone.cut(Angle::from_degrees(30.0)).unwrap();
    /// assert!((side.degrees() - 35.264_389_682_754_654).abs() < 1e-12);
    /// assert!(cone.cut(Angle::from_degrees(45.1)).is_none());
    /// ```
    pub fn cut(self, cross_slope: Angle) -> Option<Angle> {
        let mu = self.coefficient;
        let t = cross_slope.slope().abs();
        (t <= mu).then(|| Angle::from_slope(((mu - t) * (mu + t) / (1.0 + t * t)).sqrt()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Independent check: rotates a vector inside the plane until it leaves the cone.
    #[test]
    fn cut_agrees_with_a_search_in_the_plane() {
        for mu in [0.05, 0.6, 1.2, 5.0] {
            for chi_deg in [0.0, 1.0, 2.5, 20.0, 30.0] {
                let cone = FrictionCone::new(mu).unwrap();
                let chi = chi_deg * std::f64::consts::PI / 180.0;
                // Normal (0, sin chi, cos chi), plane of travel y = 0; direction (sin a, 0, cos a).
                let inside = |a: f64| {
                    let cos = a.cos() * chi.cos();
                    cos >= 1.0 / (1.0 + mu * mu).sqrt()
                };
                match cone.cut(Angle::from_radians(chi)) {
                    None => assert!(!inside(0.0), "mu {mu} chi {chi_deg}: no cut, but the plane's own axis is inside the cone"),
                    Some(delta) => {
                        let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
                        for _ in 0..80 {
                            let middle = 0.5 * (low + high);
                            if inside(middle) { low = middle } else { high = middle }
                        }
                        assert!((delta.radians() - low).abs() < 1e-7, "mu {mu} chi {chi_deg}: {} against {low}", delta.radians());
                    }
                }
            }
        }
    }

    #[test]
    fn impossible_coefficients_are_refused() {
        for mu in [-0.1, f64::NAN, f64::INFINITY] {
            assert!(FrictionCone::new(mu).is_err(), "{mu} was accepted");
        }
    }
}
