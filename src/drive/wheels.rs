//! The heights under two axles on a polyline.

use super::Extreme;

/// Every place of two axles on a polyline of given vertices at which the difference of their heights may be greatest.
///
/// ```text
///     max |z(x + w) - z(x)|        x from the first vertex to the last one less the wheelbase w
/// ```
///
/// Both heights are straight in x between vertices, so that the greatest difference stands where an axle stands on one.
#[derive(Clone, Debug)]
pub(super) struct Axles {
    stands: Vec<Stand>,
}

/// Two axles on segments: the first vertex of each, and the share of the segment before the axle.
#[derive(Clone, Copy, Debug)]
struct Stand {
    rear: (usize, f64),
    front: (usize, f64),
    /// The middle between them.
    at_m: f64,
}

impl Axles {
    /// The places on vertices at these x, ascending; `None` if they span less than the wheelbase by more than rounding.
    pub(super) fn new(x_m: &[f64], base_m: f64) -> Option<Self> {
        let (first_m, last_m) = (*x_m.first()?, *x_m.last()?);
        let room_m = last_m - first_m - base_m;
        if x_m.len() < 2 || room_m < -1e-9 * base_m {
            return None;
        }
        let on = |at_m: f64| {
            let after = x_m.partition_point(|x_m| *x_m <= at_m).clamp(1, x_m.len() - 1);
            let (a, b) = (x_m[after - 1], x_m[after]);
            (after - 1, ((at_m - a) / (b - a)).clamp(0.0, 1.0))
        };
        // Vertices without room for the other axle are looked at from the end of that room instead.
        let rears = x_m.iter().flat_map(|x_m| [*x_m, *x_m - base_m]);
        let mut rears: Vec<f64> = rears.map(|rear_m| rear_m.clamp(first_m, first_m + room_m.max(0.0))).collect();
        rears.sort_by(f64::total_cmp);
        rears.dedup();
        let stands =
            rears.iter().map(|rear_m| Stand { rear: on(*rear_m), front: on(rear_m + base_m), at_m: rear_m + 0.5 * base_m });
        Some(Self { stands: stands.collect() })
    }

    /// The greatest difference under these heights of the vertices, and the middle between the axles there.
    pub(super) fn greatest(&self, heights_m: &[f64]) -> Extreme {
        let height_m = |(first, share): (usize, f64)| heights_m[first] + share * (heights_m[first + 1] - heights_m[first]);
        let mut greatest = Extreme { value: 0.0, at_m: self.stands[0].at_m };
        for stand in &self.stands {
            greatest.raise((height_m(stand.front) - height_m(stand.rear)).abs(), stand.at_m);
        }
        greatest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    /// Against a fine sampling, which is never above the exact value and close to it.
    #[test]
    fn the_greatest_step_is_that_of_a_fine_sampling() {
        let draw = &mut Draw::seeded(2207);
        for _ in 0..200 {
            let mut x_m = 0.0;
            let points: Vec<_> = (0..2 + draw.below(9))
                .map(|_| {
                    let point = (x_m, draw.uniform(-1.0, 1.0));
                    x_m += draw.log_uniform(1e-3, 1.0);
                    point
                })
                .collect();
            let length_m = points.last().unwrap().0;
            let base_m = length_m * draw.uniform(0.01, 1.0);
            let (x_m, z_m): (Vec<_>, Vec<_>) = points.iter().copied().unzip();
            let found = Axles::new(&x_m, base_m).unwrap().greatest(&z_m);
            let height_m = |x_m: f64| {
                let pair = points.windows(2).find(|pair| x_m <= pair[1].0 + 1e-12).unwrap();
                pair[0].1 + (pair[1].1 - pair[0].1) * (x_m - pair[0].0) / (pair[1].0 - pair[0].0)
            };
            let samples = 4000;
            let step = |i: i32| {
                let x_m = (length_m - base_m) * f64::from(i) / f64::from(samples);
                (height_m(x_m + base_m) - height_m(x_m)).abs()
            };
            let sampled = (0..=samples).map(step).fold(0.0, f64::max);
            let steepest = points.windows(2).map(|p| ((p[1].1 - p[0].1) / (p[1].0 - p[0].0)).abs()).fold(0.0, f64::max);
            let coarse = 2.0 * steepest * length_m / f64::from(samples);
            assert!(sampled <= found.value + 1e-9 && found.value <= sampled + coarse + 1e-9, "{sampled} {found:?}");
        }
    }

    #[test]
    fn a_profile_shorter_than_the_wheelbase_has_no_step() {
        assert!(Axles::new(&[0.0, 1.0], 1.1).is_none() && Axles::new(&[0.0], 0.1).is_none());
        assert_eq!(Axles::new(&[0.0, 1.0], 1.0).map(|axles| axles.greatest(&[0.0, 2.0]).value), Some(2.0));
    }
}
