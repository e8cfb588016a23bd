//! The hillshade of a DEM.

use crate::terrain::Dem;

/// Sun from the north-west, 45 degrees up, as on printed maps: its direction east, north and up.
///
/// (-1/2, 1/2, 1/sqrt 2) is azimuth 315 degrees and elevation 45 degrees.
const SUN: (f64, f64, f64) = (-0.5, 0.5, std::f64::consts::FRAC_1_SQRT_2);

/// The brightness of level ground, which is sin 45 degrees.
pub(super) const LEVEL: f64 = SUN.2;

/// The brightness of the ground at a post, 0 (facing away from the sun) to 1 (facing it); `None` without an elevation.
///
/// ```text
///     a b c     p = ((c + 2 f + i) - (a + 2 d + g)) / (8 dx)    rise towards east
///     d e f     q = ((a + 2 b + c) - (g + 2 h + i)) / (8 dy)    rise towards north
///     g h i     brightness = max(0, (sun . (-p, -q, 1)) / sqrt(1 + p^2 + q^2))
/// ```
///
/// Slopes by Horn, "Hill shading and the reflectance map", Proc. IEEE 69 (1981) 14-47, as in `gdaldem`; brightness by Lambert's
/// cosine law. A missing neighbour (border, no-data) is replaced by linear extrapolation from the opposite one, or at a corner from
/// the two beside it.
pub(super) fn brightness(dem: &Dem, row: usize, col: usize) -> Option<f64> {
    let centre = dem.elevation(row, col)?;
    let at = |down: isize, right: isize| dem.elevation(row.checked_add_signed(down)?, col.checked_add_signed(right)?);
    let or_straight = |down: isize, right: isize| at(down, right).or_else(|| Some(2.0 * centre - at(-down, -right)?));
    let beside = |down: isize, right: isize| or_straight(down, right).unwrap_or(centre);
    let (b, d, f, h) = (beside(-1, 0), beside(0, -1), beside(0, 1), beside(1, 0));
    let corner = |down: isize, right: isize, beside: [f64; 2]| or_straight(down, right).unwrap_or(beside[0] + beside[1] - centre);
    let (a, c, g, i) = (corner(-1, -1, [b, d]), corner(-1, 1, [b, f]), corner(1, -1, [h, d]), corner(1, 1, [h, f]));
    let map = dem.georeference();
    let (east, north) = ((c + 2.0 * f + i) - (a + 2.0 * d + g), (a + 2.0 * b + c) - (g + 2.0 * h + i));
    let (p, q) = (east / (8.0 * map.dx_m()), north / (8.0 * map.dy_m()));
    let facing = (-SUN.0 * p - SUN.1 * q + SUN.2) / (1.0 + p * p + q * q).sqrt();
    Some(facing.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{quantity::MapPoint, terrain::GeoReference};

    fn plane(east: f64, north: f64) -> Dem {
        let map = GeoReference::local(MapPoint::new(0.0, 0.0), 2.0, 5.0).unwrap();
        let z = (0..20).map(|i| f64::from(i % 5) * 2.0 * east - f64::from(i / 5) * 5.0 * north).collect();
        Dem::new(4, 5, z, map).unwrap()
    }

    #[test]
    fn planes_are_as_bright_as_the_cosine_of_their_normal_with_the_sun_border_included() {
        for (east, north) in [(0.0, 0.0), (1.0, -1.0), (-0.7, 0.2), (0.5, 0.5), (3.0, -3.0), (-3.0, 3.0)] {
            let dem = plane(east, north);
            // Independent computation: by angles, as in the manual of gdaldem.
            let slope = f64::hypot(east, north).atan();
            let aspect = (-east).atan2(-north);
            let (zenith, azimuth) = (45.0f64.to_radians(), 315.0f64.to_radians());
            let expected = zenith.cos() * slope.cos() + zenith.sin() * slope.sin() * (azimuth - aspect).cos();
            for i in 0..20 {
                let found = brightness(&dem, i / 5, i % 5).unwrap();
                assert!((found - expected.max(0.0)).abs() < 1e-12, "{east} {north}: {found}, expected {expected}");
            }
        }
        assert_eq!(brightness(&plane(0.0, 0.0), 1, 1), Some(LEVEL));
    }

    #[test]
    fn gaps_have_no_brightness_and_their_neighbours_do() {
        let map = GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 1.0).unwrap();
        let dem = Dem::new(2, 2, vec![1.0, f64::NAN, 3.0, 7.0], map).unwrap();
        assert_eq!(brightness(&dem, 0, 1), None);
        assert!(brightness(&dem, 0, 0).unwrap() > 0.0);
        assert_eq!(brightness(&dem, 5, 0), None);
    }
}
