//! Where along a chain the hopper's footprint stands, for contacts whose position scatters.

use rayon::prelude::*;

use super::flight::normal;
use crate::{chain::ConstrainedChain, quantity::SegmentId};

/// Parts of a footprint from one sample to the next: the estimate takes each sample for the ground around it.
const PARTS: f64 = 8.0;

/// Most samples of a chain: longer chains are sampled more coarsely.
const MOST: f64 = 65_536.0;

/// Samples of the ground under the footprint along a chain.
#[derive(Debug)]
pub(in crate::hop) struct FootingSamples {
    first_m: f64,
    step_m: f64,
    stands: Vec<bool>,
}

impl FootingSamples {
    /// The samples of a chain; `None` if its hopper has no footprint.
    pub(in crate::hop) fn of(chain: &ConstrainedChain) -> Option<Self> {
        let footprint = chain.footprint()?;
        let (first_m, last_m) = chain.geometry().extent_m();
        let count = (PARTS * (last_m - first_m) / footprint.diameter_m).ceil().clamp(1.0, MOST);
        let step_m = (last_m - first_m) / count;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to 65536")]
        let count = count as u32;
        let stands = |i: u32| {
            let x_m = first_m + (f64::from(i) + 0.5) * step_m;
            chain.geometry().station(x_m).is_ok_and(|station| {
                let segment = chain.geometry().vertices().partition_point(|vertex| vertex.x_m <= x_m).saturating_sub(1);
                chain.footprint_refusal(&station, SegmentId(segment)).is_none()
            })
        };
        Some(Self { first_m, step_m, stands: (0..count).into_par_iter().map(stands).collect() })
    }

    /// The probability that a normal position lies between two others, given in deviations from its mean, and where the footprint
    /// stands.
    pub(super) fn probability(&self, (from, to): (f64, f64), mean_m: f64, sigma_m: f64) -> f64 {
        let at = |deviations: f64| (mean_m + deviations * sigma_m - self.first_m) / self.step_m;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the samples")]
        let cell = |deviations: f64| at(deviations).floor().clamp(0.0, MOST) as usize;
        let mut probability = 0.0;
        let last = self.stands.len() - 1;
        for index in cell(from).min(last)..=cell(to).min(last) {
            #[expect(clippy::cast_precision_loss, reason = "at most 65536")]
            let edge = |index: usize| (self.first_m + index as f64 * self.step_m - mean_m) / sigma_m;
            let low = if index == 0 { from } else { edge(index).max(from) };
            let high = if index == last { to } else { edge(index + 1).min(to) };
            if self.stands[index] && high > low {
                probability += normal(high) - normal(low);
            }
        }
        probability
    }
}
