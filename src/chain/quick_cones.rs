//! The cones of a contact without trigonometry, for maps that need millions of them.

use crate::{
    quantity::{AngleInterval, SlopeInterval},
    world::FrictionCone,
};

/// The directions that the ground allows a contact, by fast arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuickCone {
    /// No direction.
    Closed,
    /// These slopes, with a relative error of some 1e-8.
    Open(SlopeInterval),
    /// Too close to a closed cone, or to the vertical, to decide: use [`LineConstraints`](super::LineConstraints).
    Doubtful,
}

/// The grip of the ground, prepared for [`takeoff`](Self::takeoff) and [`landing`](Self::landing).
///
/// Gives the results of [`LineConstraints::from_cone`](super::LineConstraints::from_cone) and
/// [`from_offsets`](super::LineConstraints::from_offsets), computed from slopes alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuickGrip {
    /// Coulomb friction, given by the square of its coefficient.
    Friction {
        /// `mu^2`.
        squared: f64,
    },
    /// Angles relative to the segment's own slope, each given by its cosine and sine.
    FromSlope {
        /// Least and greatest take-off angle.
        takeoff: [Turn; 2],
        /// Least and greatest landing angle.
        landing: [Turn; 2],
    },
}

/// A rotation by at most 180 degrees in either sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    cos: f64,
    sin: f64,
    upward: bool,
}

/// Squared tangents below this, and differences of tangents below its square root, are doubtful: there the square root and
/// the quotient of the small remainder lose more than half of a double's digits. A larger value would only call the exact
/// code more often.
const FADING: f64 = 1.0e-6;

/// The square root of [`FADING`]: near the vertical a difference of tangents is an angle, here a twentieth of a degree.
const NEAR: f64 = 1.0e-3;

impl QuickGrip {
    /// The grip of Coulomb friction.
    pub fn friction(cone: FrictionCone) -> Self {
        Self::Friction { squared: cone.coefficient() * cone.coefficient() }
    }

    /// The grip given by angles relative to the slope.
    pub fn from_slope(takeoff: AngleInterval, landing: AngleInterval) -> Self {
        let turns = |angles: AngleInterval| [angles.min, angles.max].map(|angle| Turn::by(angle.radians()));
        Self::FromSlope { takeoff: turns(takeoff), landing: turns(landing) }
    }

    /// The take-off directions on a facet.
    ///
    /// ```text
    ///     T^2 = tan^2 delta = (mu^2 - G + (1 + mu^2) a^2) / (1 + G)        (model section 1, with cos^2 chi = (1 + a^2) / (1 + G))
    ///     m >= tan(alpha + pi/2 - delta) = (1 + a T) / (T - a)               closed where T <= a
    ///     m <= tan(alpha + pi/2 + delta) = (a T - 1) / (a + T)               no bound where a + T >= 0
    /// ```
    ///
    /// # Arguments
    /// `slope`: `a`, the facet's slope along the direction of travel; `steepness_squared`: `G`, the square of the facet's
    /// gradient.
    ///
    /// # Examples
    /// ```
    /// use chta::{chain::{QuickCone, QuickGrip}, world::FrictionCone};
    /// // Flat ground, mu = 0.5: take-off at atan 2 or steeper.
    /// let QuickCone::Open(slopes) = QuickGrip::friction(FrictionCone::new(0.5)?).takeoff(0.0, 0.0) else { panic!() };
    /// assert_eq!((slopes.lower, slopes.upper), (2.0, f64::INFINITY));
    /// # Ok::<(), chta::world::InvalidFriction>(())
    /// ```
    #[inline]
    pub fn takeoff(&self, slope: f64, steepness_squared: f64) -> QuickCone {
        match self {
            Self::Friction { squared } => cone_ahead(*squared, slope, steepness_squared),
            Self::FromSlope { takeoff, .. } => turned(takeoff, slope),
        }
    }

    /// The landing directions on a facet: the take-off directions on the same ground for reversed travel, with the sign of
    /// the slopes changed.
    ///
    /// ```
    /// use chta::{chain::{QuickCone, QuickGrip}, world::FrictionCone};
    /// let QuickCone::Open(slopes) = QuickGrip::friction(FrictionCone::new(0.5)?).landing(0.0, 0.0) else { panic!() };
    /// assert_eq!((slopes.lower, slopes.upper), (f64::NEG_INFINITY, -2.0));
    /// # Ok::<(), chta::world::InvalidFriction>(())
    /// ```
    #[inline]
    pub fn landing(&self, slope: f64, steepness_squared: f64) -> QuickCone {
        match self {
            Self::Friction { squared } => match cone_ahead(*squared, -slope, steepness_squared) {
                QuickCone::Open(ahead) => QuickCone::Open(SlopeInterval { lower: -ahead.upper, upper: -ahead.lower }),
                other => other,
            },
            Self::FromSlope { landing, .. } => turned(landing, slope),
        }
    }

    /// The directions in which arcs may end on a facet if the hopper brakes to a touchdown straight down: all, or none.
    ///
    /// ```text
    ///     G <= mu^2        (the vertical in the friction cone: the inclination is at most the friction angle)
    /// ```
    ///
    /// ```
    /// use chta::{chain::{QuickCone, QuickGrip}, quantity::SlopeInterval, world::FrictionCone};
    /// let grip = QuickGrip::friction(FrictionCone::new(0.5)?);
    /// assert_eq!(grip.touchdown(0.0, 0.0), QuickCone::Open(SlopeInterval::ALL));
    /// assert_eq!(grip.touchdown(0.0, 0.26), QuickCone::Closed);
    /// # Ok::<(), chta::world::InvalidFriction>(())
    /// ```
    #[inline]
    pub fn touchdown(&self, slope: f64, steepness_squared: f64) -> QuickCone {
        let held = match self {
            Self::Friction { squared } if steepness_squared < squared * (1.0 - FADING) => true,
            Self::Friction { squared } if steepness_squared > squared * (1.0 + FADING) => false,
            Self::Friction { .. } => return QuickCone::Doubtful,
            Self::FromSlope { landing, .. } => match turned(landing, slope) {
                QuickCone::Doubtful => return QuickCone::Doubtful,
                QuickCone::Closed => false,
                QuickCone::Open(slopes) => slopes.lower == f64::NEG_INFINITY,
            },
        };
        if held { QuickCone::Open(SlopeInterval::ALL) } else { QuickCone::Closed }
    }
}

/// The directions towards +x inside the friction cone on a facet.
#[inline]
fn cone_ahead(mu_squared: f64, slope: f64, steepness_squared: f64) -> QuickCone {
    let tangent_squared = (mu_squared - steepness_squared + (1.0 + mu_squared) * (slope * slope)) / (1.0 + steepness_squared);
    if tangent_squared < -FADING {
        return QuickCone::Closed;
    }
    let tangent = tangent_squared.max(0.0).sqrt();
    let (ahead, behind) = (tangent - slope, tangent + slope);
    if ahead < -NEAR && tangent_squared > FADING {
        return QuickCone::Closed;
    }
    // False as well if a number is NaN.
    let sure = tangent_squared > FADING && ahead > NEAR && behind.abs() > NEAR;
    if !sure {
        return QuickCone::Doubtful;
    }
    let turned = slope * tangent;
    let upper = if behind > 0.0 { f64::INFINITY } else { (turned - 1.0) / behind };
    QuickCone::Open(SlopeInterval { lower: (1.0 + turned) / ahead, upper })
}

/// The slopes between two rotations of a given slope.
#[inline]
fn turned([least, greatest]: &[Turn; 2], slope: f64) -> QuickCone {
    let (Some(lower), Some(upper)) = (least.from(slope), greatest.from(slope)) else { return QuickCone::Doubtful };
    if lower == f64::INFINITY || upper == f64::NEG_INFINITY {
        return QuickCone::Closed;
    }
    QuickCone::Open(SlopeInterval { lower, upper })
}

impl Turn {
    /// Larger angles are clamped to 180 degrees, which rotates every slope beyond the vertical.
    fn by(angle_rad: f64) -> Self {
        let angle_rad = angle_rad.clamp(-std::f64::consts::PI, std::f64::consts::PI);
        Self { cos: libm::cos(angle_rad), sin: libm::sin(angle_rad), upward: angle_rad > 0.0 }
    }

    /// The slope after this rotation of another: infinite at and beyond the vertical, `None` too close to it.
    #[inline]
    fn from(self, slope: f64) -> Option<f64> {
        let (run, rise) = (self.cos - slope * self.sin, self.sin + slope * self.cos);
        let length = run.abs() + rise.abs();
        if run > FADING * length {
            Some(rise / run)
        } else if run < -FADING * length {
            Some(if self.upward { f64::INFINITY } else { f64::NEG_INFINITY })
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{chain::LineConstraints, quantity::Angle};

    /// The exact computation: angles of the facet, then tangents.
    fn exact(mu: f64, along: f64, across: f64) -> Option<LineConstraints> {
        let cross_slope = Angle::from_slope(across / libm::hypot(1.0, along));
        let delta = FrictionCone::new(mu).unwrap().cut(cross_slope)?;
        Some(LineConstraints::from_cone(along, delta, 1.0, 1.0))
    }

    fn same(quick: SlopeInterval, exact: SlopeInterval) -> bool {
        let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-7 * (1.0 + a.abs().max(b.abs()));
        near(quick.lower, exact.lower) && near(quick.upper, exact.upper)
    }

    #[test]
    fn friction_cones_agree_with_the_angles_wherever_they_are_sure() {
        let (mut open, mut closed, mut doubtful) = (0, 0, 0);
        for mu in [0.0, 0.01, 0.3, 0.6, 1.2, 5.0] {
            let grip = QuickGrip::friction(FrictionCone::new(mu).unwrap());
            for i in -60..=60 {
                for j in -40..=40 {
                    let (along, across) = (f64::from(i) * 0.037, f64::from(j) * 0.053);
                    let steepness = along * along + across * across;
                    let constraints = exact(mu, along, across);
                    for (quick, slopes) in [
                        (grip.takeoff(along, steepness), constraints.map(|c| c.takeoff.slopes())),
                        (grip.landing(along, steepness), constraints.map(|c| c.landing.slopes())),
                    ] {
                        match quick {
                            QuickCone::Closed => {
                                assert!(slopes.is_none_or(SlopeInterval::is_empty), "mu {mu} along {along} across {across}");
                                closed += 1;
                            }
                            QuickCone::Open(found) => {
                                assert!(
                                    same(found, slopes.unwrap()),
                                    "mu {mu} along {along} across {across}: {found:?} {slopes:?}"
                                );
                                open += 1;
                            }
                            QuickCone::Doubtful => doubtful += 1,
                        }
                    }
                }
            }
        }
        assert!(open > 10_000 && closed > 10_000, "{open} open, {closed} closed");
        assert!(doubtful < (open + closed) / 20, "{doubtful} doubtful of {open} and {closed}");
    }

    #[test]
    fn angles_from_the_slope_agree_with_their_tangents() {
        for ends in [(60.0, 90.0), (-100.0, 45.0), (170.0, 190.0), (-400.0, 400.0), (20.0, 70.0), (-90.0, -60.0)] {
            let angles = AngleInterval::from_degrees(ends.0, ends.1);
            let grip = QuickGrip::from_slope(angles, angles);
            for i in -50..=50 {
                let slope = f64::from(i) * 0.0713;
                let slopes = LineConstraints::from_offsets(slope, angles, angles, 1.0, 1.0).takeoff.slopes();
                match grip.takeoff(slope, slope * slope) {
                    QuickCone::Closed => assert!(slopes.is_empty(), "{ends:?} from {slope}: {slopes:?}"),
                    QuickCone::Open(found) => assert!(same(found, slopes), "{ends:?} from {slope}: {found:?} {slopes:?}"),
                    QuickCone::Doubtful => {}
                }
            }
        }
    }
}
