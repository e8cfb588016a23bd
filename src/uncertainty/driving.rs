//! A straight drive, or walk, with errors.

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

use crate::{
    drive::{DriveGround, DriveLeg},
    flight::Distribution,
    quantity::MapPoint,
};

/// The stream of a trial's drives is its number with this bit: no trial has such a number.
const DRIVES: u64 = 1 << 63;

/// The draws of the drives of one trial after another, apart from those of its hops.
#[derive(Debug)]
pub(super) struct DriveDraws(ChaCha8Rng);

/// How a drive with errors ended.
#[derive(Clone, Copy, Debug)]
pub(super) enum Driven {
    /// At a place.
    To {
        /// Where.
        at: MapPoint,
        /// The leg that was driven.
        leg: DriveLeg,
        /// Its direction; `None` of one without length.
        heading: Option<Vector2<f64>>,
    },
    /// A limit, or the end of the known ground, refuses the line: it stays.
    Refused,
    /// A failure ended it.
    Failed,
}

impl DriveDraws {
    pub(super) fn seeded(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Begins the draws of a trial.
    pub(super) fn begin(&mut self, trial: u64) {
        self.0.set_stream(trial | DRIVES);
        self.0.set_word_pos(0);
    }

    /// Drives so far from a place, with errors of heading and length as the rover states them.
    pub(super) fn drive(
        &mut self,
        drive: &DriveGround<'_>,
        distribution: Distribution,
        from: MapPoint,
        along: Vector2<f64>,
    ) -> Driven {
        let limits = drive.rover().limits();
        let uniforms = [0; 3].map(|_| self.0.random::<f64>());
        let [heading, length] = distribution.standard_pair([uniforms[0], uniforms[1]]);
        let (sine, cosine) = libm::sincos(limits.heading_sigma.radians() * heading);
        let turned = Vector2::new(along.x * cosine + along.y * sine, along.y * cosine - along.x * sine);
        let at = from + turned * (1.0 + limits.length_sigma_fraction * length).max(0.0);
        let [Some(begin), Some(end)] = [from, at].map(|place| drive.ground().position(place)) else { return Driven::Refused };
        let Ok(leg) = drive.leg(&begin, &end) else { return Driven::Refused };
        if uniforms[2] < 1.0 - libm::exp(-limits.failure_per_m * leg.length_m) {
            return Driven::Failed;
        }
        Driven::To { at, leg, heading: turned.try_normalize(0.0) }
    }
}
