//! Standard normals from uniforms.

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
