//! The standard normal distribution.

/// Two independent standard normals from two uniforms in [0, 1).
///
/// ```text
///     R = sqrt(-2 ln(1 - u)),   (R cos 2 pi w, R sin 2 pi w)
/// ```
///
/// Source: Box and Muller 1958. Through `libm`, so that every platform gives the same bits.
///
/// # Returns
/// Finite numbers; none is larger than 8.6 in size, since 1 - u is at least 2^-53.
///
/// # Examples
/// ```
/// use chta::quantity::standard_normals;
/// assert_eq!(standard_normals([0.0, 0.3]), [0.0, 0.0]);
/// // u = 1 - exp(-1/2): R = 1.
/// let [x, y] = standard_normals([1.0 - (-0.5f64).exp(), 0.25]);
/// assert!(x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15);
/// ```
pub fn standard_normals([radius, turn]: [f64; 2]) -> [f64; 2] {
    let radius = (-2.0 * libm::log(1.0 - radius)).sqrt();
    let (sine, cosine) = libm::sincos(std::f64::consts::TAU * turn);
    [radius * cosine, radius * sine]
}

/// The standard normal distribution function, `Phi(x) = erfc(-x / sqrt 2) / 2`.
///
/// # Examples
/// ```
/// use chta::quantity::normal_cdf;
/// assert_eq!(normal_cdf(0.0), 0.5);
/// assert!((normal_cdf(1.0) - 0.841_344_746_068_543).abs() < 1e-14);
/// ```
pub fn normal_cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

/// The inverse of [`normal_cdf`]: the standard normal that a share of all draws does not exceed.
///
/// Bisection until the interval holds no other double, so exact to the rounding of the distribution function; through `libm`, so that
/// every platform gives the same bits. A table of draws needs it once, not an inner loop.
///
/// # Returns
/// -8.3 to 8.3; beyond, where a double no longer tells the share from 0 or 1, the ends.
///
/// # Examples
/// ```
/// use chta::quantity::normal_quantile;
/// assert_eq!(normal_quantile(0.5), 0.0);
/// assert!((normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-12);
/// ```
pub fn normal_quantile(share: f64) -> f64 {
    const FARTHEST: f64 = 8.3;
    // The distribution function keeps its digits in the lower tail.
    if share > 0.5 {
        return -normal_quantile(1.0 - share);
    }
    if share == 0.5 {
        return 0.0;
    }
    let (mut low, mut high) = (-FARTHEST, 0.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if normal_cdf(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
}
