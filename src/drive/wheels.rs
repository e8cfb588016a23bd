//! The heights under two axles on a polyline.

use super::Extreme;
use crate::terrain::ProfilePoint;

/// The greatest difference of the heights under two axles, `base_m` apart, anywhere on a profile; at the middle between them. `None` if
/// the profile is shorter than that by more than rounding.
///
/// ```text
///     max |z(x + w) - z(x)|        x from the first point to the last one less w
/// ```
///
/// Both heights are straight in x between vertices, so that the greatest difference stands where an axle stands on one.
pub(super) fn greatest_step(points: &[ProfilePoint], base_m: f64) -> Option<Extreme> {
    let (first, last) = (points.first()?, points.last()?);
    let room_m = last.x_m - first.x_m - base_m;
    if room_m < -1e-9 * base_m {
        return None;
    }
    let height_m = |x_m: f64| {
        let after = points.partition_point(|point| point.x_m <= x_m).clamp(1, points.len() - 1);
        let (a, b) = (&points[after - 1], &points[after]);
        a.z_m + (b.z_m - a.z_m) * ((x_m - a.x_m) / (b.x_m - a.x_m)).clamp(0.0, 1.0)
    };
    let mut greatest = Extreme { value: 0.0, at_m: first.x_m + 0.5 * base_m };
    let mut look = |rear_m: f64| {
        let rear_m = rear_m.clamp(first.x_m, first.x_m + room_m.max(0.0));
        greatest.raise((height_m(rear_m + base_m) - height_m(rear_m)).abs(), rear_m + 0.5 * base_m);
    };
    for point in points {
        // Vertices without room for the other axle are looked at from the end of that room instead.
        look(point.x_m);
        look(point.x_m - base_m);
    }
    Some(greatest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{draw::Draw, quantity::MapPoint};

    /// Against a fine sampling, which is never above the exact value and close to it.
    #[test]
    fn the_greatest_step_is_that_of_a_fine_sampling() {
        let draw = &mut Draw::seeded(2207);
        for _ in 0..200 {
            let mut x_m = 0.0;
            let points: Vec<_> = (0..2 + draw.below(9))
                .map(|_| {
                    let point = ProfilePoint { x_m, z_m: draw.uniform(-1.0, 1.0), map: MapPoint::new(x_m, 0.0) };
                    x_m += draw.log_uniform(1e-3, 1.0);
                    point
                })
                .collect();
            let length_m = points.last().unwrap().x_m;
            let base_m = length_m * draw.uniform(0.01, 1.0);
            let found = greatest_step(&points, base_m).unwrap();
            let height_m = |x_m: f64| {
                let pair = points.windows(2).find(|pair| x_m <= pair[1].x_m + 1e-12).unwrap();
                pair[0].z_m + (pair[1].z_m - pair[0].z_m) * (x_m - pair[0].x_m) / (pair[1].x_m - pair[0].x_m)
            };
            let samples = 4000;
            let step = |i: i32| {
                let x_m = (length_m - base_m) * f64::from(i) / f64::from(samples);
                (height_m(x_m + base_m) - height_m(x_m)).abs()
            };
            let sampled = (0..=samples).map(step).fold(0.0, f64::max);
            let steepest = points.windows(2).map(|p| ((p[1].z_m - p[0].z_m) / (p[1].x_m - p[0].x_m)).abs()).fold(0.0, f64::max);
            let coarse = 2.0 * steepest * length_m / f64::from(samples);
            assert!(sampled <= found.value + 1e-9 && found.value <= sampled + coarse + 1e-9, "{sampled} {found:?}");
        }
    }

    #[test]
    fn a_profile_shorter_than_the_wheelbase_has_no_step() {
        let point = |x_m: f64, z_m: f64| ProfilePoint { x_m, z_m, map: MapPoint::new(x_m, 0.0) };
        assert_eq!(greatest_step(&[point(0.0, 0.0), point(1.0, 2.0)], 1.1), None);
        assert_eq!(greatest_step(&[point(0.0, 0.0), point(1.0, 2.0)], 1.0).map(|step| step.value), Some(2.0));
    }
}
