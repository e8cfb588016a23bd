//! Sign-safe roots of the quadratics that limits lead to.

/// The quadratic `n^2 - 2 h n + w^2`, known by the half-sum `h` of its roots and the root `w >= 0` of their product.
///
/// Every speed and apex limit of a hop has this form, with a product that is a sum of squares, so neither root loses digits: the
/// larger is `h + r` with `r = sqrt((h - w)(h + w))`, the smaller `w^2 / (h + r)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonicQuadratic {
    /// Half the sum of the roots.
    pub half_sum: f64,
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
    /// The two roots where they are real and not negative, else `None` (also for NaN).
    ///
    /// ```
    /// use chta::quantity::MonicQuadratic;
    /// // n^2 - 5 n + 4 = (n - 1)(n - 4)
    /// let roots = MonicQuadratic { half_sum: 2.5, geometric_mean: 2.0 }.roots().unwrap();
    /// assert_eq!((roots.smaller, roots.larger), (1.0, 4.0));
    /// // The school formula loses the small root of n^2 - 2e10 n + 1 altogether.
    /// let roots = MonicQuadratic { half_sum: 1e10, geometric_mean: 1.0 }.roots().unwrap();
    /// assert_eq!(roots.smaller, 5e-11);
    /// ```
    #[inline]
    pub fn roots(self) -> Option<Roots> {
        let Self { half_sum: h, geometric_mean: w } = self;
        if h >= w && h > 0.0 {
            // Two square roots: the product under one root would overflow where h^2 does.
            let larger = h + (h - w).sqrt() * (h + w).sqrt();
            // w / larger first: w^2 may overflow where the root does not.
            Some(Roots { smaller: w * (w / larger), larger })
        } else {
            None
        }
    }
}
