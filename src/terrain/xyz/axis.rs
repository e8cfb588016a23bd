//! The lattice along one coordinate.

/// Coordinates may deviate from the lattice by this fraction of the spacing, from rounding to a few digits.
pub(super) const OFF_PLACE: f64 = 0.02;

/// Gaps smaller than the next larger ones by this factor come from rounding, not from the spacing.
const JITTER: f64 = 0.05;

/// Equidistant positions: `first + index * step`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) first: f64,
    pub(super) step: f64,
    pub(super) count: usize,
}

impl Axis {
    /// The lattice suggested by finite coordinates; `None` if they are all equal. Whether each coordinate is on it is tested
    /// by [`Axis::place`].
    pub(super) fn of(mut coordinates: Vec<f64>) -> Option<Self> {
        coordinates.sort_unstable_by(f64::total_cmp);
        coordinates.dedup();
        let (first, last) = (*coordinates.first()?, *coordinates.last()?);
        let least = least_spacing(&coordinates)?;
        // Summed from gap to gap, so that the rounding error of the least gap does not accumulate.
        let steps: f64 = coordinates.windows(2).map(|pair| ((pair[1] - pair[0]) / least).round()).sum();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive; beyond usize it saturates")]
        let count = (steps as usize).saturating_add(1);
        Some(Self { first, step: short_step(first, last, steps), count })
    }

    /// The index of the nearest lattice position, and the distance to it as a fraction of the spacing.
    pub(super) fn place(&self, coordinate: f64) -> (usize, f64) {
        let at = (coordinate - self.first) / self.step;
        let whole = at.round().max(0.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; beyond usize it saturates")]
        (whole as usize, (at - whole).abs())
    }
}

/// The smallest gap that does not come from rounding.
fn least_spacing(sorted: &[f64]) -> Option<f64> {
    let mut gaps: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).collect();
    gaps.sort_unstable_by(f64::total_cmp);
    // The mean gap: a scale that separates spacing from rounding.
    #[expect(clippy::cast_precision_loss, reason = "a scale")]
    let even = (sorted.last()? - sorted.first()?) / gaps.len() as f64;
    let jump = gaps.windows(2).rposition(|pair| pair[0] < JITTER * pair[1] && pair[0] < JITTER * even);
    gaps.get(jump.map_or(0, |at| at + 1)).copied()
}

/// The step for a number of steps from first to last, with twelve digits if these reach the last coordinate: 0.1 instead of
/// 0.09999999999999999.
fn short_step(first: f64, last: f64, steps: f64) -> f64 {
    let exact = (last - first) / steps;
    let short: f64 = format!("{exact:.11e}").parse().unwrap_or(exact);
    let resolution = 4.0 * f64::EPSILON * first.abs().max(last.abs());
    if (first + steps * short - last).abs() <= resolution { short } else { exact }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spacing_is_found_through_gaps_rounding_and_any_order() {
        let axis = Axis::of(vec![5.0, 1.0, 9.0, 3.0, 9.0]).unwrap();
        assert_eq!(axis, Axis { first: 1.0, step: 2.0, count: 5 });
        let tenths: Vec<f64> = (0..60).map(|k| f64::from(k) * 0.1).collect();
        assert_eq!(Axis::of(tenths).unwrap(), Axis { first: 0.0, step: 0.1, count: 60 });
        let thirds: Vec<f64> = (0..900).map(|k| (f64::from(k) / 3.0 * 1000.0).round() / 1000.0).collect();
        let axis = Axis::of(thirds.clone()).unwrap();
        assert!(axis.count == 900 && thirds.iter().all(|x| axis.place(*x).1 < OFF_PLACE), "{axis:?}");
        let jittered: Vec<f64> = (0..40).map(|k| 4.3e6 + f64::from(k / 2) * 5.0 + f64::from(k % 2) * 1.0e-6).collect();
        let axis = Axis::of(jittered).unwrap();
        assert_eq!((axis.count, (axis.step - 5.0).abs() < 1e-6), (20, true));
        assert_eq!(Axis::of(vec![2.0, 2.0]), None);
        assert_eq!(Axis::of(vec![]), None);
    }

    #[test]
    fn points_off_the_lattice_are_recognised_by_their_distance() {
        let axis = Axis { first: 10.0, step: 2.0, count: 4 };
        assert_eq!(axis.place(14.0), (2, 0.0));
        assert_eq!(axis.place(14.5), (2, 0.25));
    }
}
