//! Roots, without loss of digits, of the quadratics that the speed and apex limits lead to.

/// The quadratic `n^2 - 2 (w + e) n + w^2`, given by the geometric mean `w >= 0` of its roots and the excess `e` of their
/// arithmetic mean over it.
///
/// Every speed and apex limit of a hop has this form, with a product of roots that is a sum of squares. The roots are real if
/// `e >= 0`, and their distance depends on `e` alone. That is why `e` is an input: computed here as the difference of two
/// large numbers it would lose its digits (at the foot of a wall, or near the greatest reach). Both roots then keep full
/// precision: the larger is `w + e + sqrt(e (2 w + e))`, the smaller is `w^2` over the larger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonicQuadratic {
    /// The arithmetic mean of the roots minus their geometric mean.
    pub excess: f64,
    /// The geometric mean of the roots, not negative.
    pub geometric_mean: f64,
}

/// Two positive roots, `smaller <= larger`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roots {
    /// The smaller root.
    pub smaller: f64,
    /// The larger root.
    pub larger: f64,
}

impl MonicQuadratic {
    /// The two roots if they are real and the larger one is positive, else `None` (also for NaN).
    ///
    /// ```
    /// use chta::quantity::MonicQuadratic;
    /// // n^2 - 5 n + 4 = (n - 1)(n - 4)
    /// let roots = MonicQuadratic { excess: 0.5, geometric_mean: 2.0 }.roots().unwrap();
    /// assert_eq!((roots.smaller, roots.larger), (1.0, 4.0));
    /// // The school formula loses the small root of n^2 - 2e10 n + 1 altogether.
    /// let roots = MonicQuadratic { excess: 1e10 - 1.0, geometric_mean: 1.0 }.roots().unwrap();
    /// assert_eq!(roots.smaller, 5e-11);
    /// // Half the sum 1000 (1 + 1e-18) is 1000 in floating point; the roots still stand apart.
    /// let roots = MonicQuadratic { excess: 1e-15, geometric_mean: 1000.0 }.roots().unwrap();
    /// assert!((roots.larger - roots.smaller - 2.0 * 2e-12f64.sqrt()).abs() < 1e-12);
    /// ```
    #[inline]
    pub fn roots(self) -> Option<Roots> {
        let Self { excess: e, geometric_mean: w } = self;
        let half_sum = w + e;
        if e >= 0.0 && half_sum > 0.0 {
            // Two square roots: the product under one root would overflow where h^2 does.
            let larger = half_sum + e.sqrt() * (half_sum + w).sqrt();
            // w / larger first: w^2 may overflow where the root does not.
            Some(Roots { smaller: w * (w / larger), larger })
        } else {
            None
        }
    }
}
