//! The ground next to a landing, where a tapered clearance shrinks with the distance from it.
//!
//! Of a hop of length `X` and slope `b`, a vertex at a distance `e` below one ramp `w` from the landing, seen from there at the
//! slope `a`, asks for
//!
//! ```text
//!     n >= (a + b + k) X / (X - e)
//! ```
//!
//! whatever lies between take-off and landing. So the vertex that asks for the most has no other with both a greater `a` and a
//! greater `e`, and none asks for more than `(max a + b + k) X / (X - w)`, the form of a kink.

use crate::{
    chain::Station,
    hop::{HopTest, first_ahead},
    world::Direction,
};

/// The vertices nearer than one ramp to a landing that may ask for the most loft, by one direction of travel.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearGround {
    steepest_back: f64,
    /// From the landing outwards, each less steep than the one before it.
    front: [u32; Self::MOST],
    /// The slopes at which they are seen from the landing, rounded upwards.
    slopes: [f32; Self::MOST],
    count: u8,
    /// Whether `front` holds all of them.
    whole: bool,
}

impl NearGround {
    /// How many vertices are kept. Two or three are usual on fractal ground with ten vertices to a ramp.
    const MOST: usize = 6;
    /// No vertex near.
    pub(super) const NO_VERTEX: Self =
        Self { steepest_back: f64::NEG_INFINITY, front: [0; Self::MOST], slopes: [0.0; Self::MOST], count: 0, whole: true };

    /// The ground near a landing reached in a direction of travel.
    pub(super) fn of(test: &HopTest, landing: &Station, direction: Direction) -> Self {
        /// Includes vertices that rounding puts beyond the end of the ramp.
        const GENEROUSLY: f64 = 1.0 + 1e-9;
        let ramp_m = test.clearance().ramp_m() * GENEROUSLY;
        let vertices = test.chain().geometry().vertices();
        let back = if direction == Direction::Forward { Direction::Reverse } else { Direction::Forward };
        let first = first_ahead(landing, back);
        let mut slopes = [0.0; Self::MOST];
        let mut near = Self::NO_VERTEX;
        for away in 0.. {
            let index = if back == Direction::Forward { Some(first + away) } else { first.checked_sub(away) };
            let Some((i, vertex)) = index.and_then(|i| Some((i, vertices.get(i)?))) else { break };
            let distance_m = (landing.point.x_m - vertex.x_m).abs();
            // At the chain's end the first vertex ahead is the landing itself.
            if distance_m > ramp_m || distance_m == 0.0 {
                break;
            }
            near.push(i, (vertex.z_m - landing.point.z_m) / distance_m, &mut slopes);
        }
        #[expect(clippy::cast_possible_truncation, reason = "rounded upwards")]
        {
            near.slopes = slopes.map(|slope: f64| (slope as f32).next_up());
        }
        near
    }

    /// Adds a vertex beyond the previous ones: it replaces those that are seen less steeply.
    fn push(&mut self, vertex: usize, slope: f64, slopes: &mut [f64; Self::MOST]) {
        let mut count = usize::from(self.count);
        while count > 0 && slopes[count - 1] <= slope {
            count -= 1;
        }
        if slope >= self.steepest_back {
            self.steepest_back = slope;
            self.whole = true;
        }
        match (slopes.get_mut(count), u32::try_from(vertex)) {
            (Some(place), Ok(vertex)) => {
                (*place, self.front[count]) = (slope, vertex);
                count += 1;
            }
            _ => self.whole = false,
        }
        #[expect(clippy::cast_possible_truncation, reason = "at most 6")]
        {
            self.count = count as u8;
        }
    }

    /// The greatest slope at which a vertex is seen from the landing; minus infinity without one.
    pub(super) const fn steepest_back(&self) -> f64 {
        self.steepest_back
    }

    /// Whether all vertices that may ask for the most loft are kept.
    pub(super) const fn is_whole(&self) -> bool {
        self.whole
    }

    /// The greater of `loft` and what the kept vertices ask for by `required`, of a hop of a length `X` and a slope `b` with the taper `k`
    /// and the ramp `w`.
    ///
    /// From the steepest to the least steep: none asks for more than `(a + b + k) X / (X - w)`, which is compared without a division.
    #[inline]
    pub(super) fn greatest(
        &self,
        loft: f64,
        (run_m, slope): (f64, f64),
        (taper, ramp_m): (f64, f64),
        required: impl Fn(usize) -> f64,
    ) -> f64 {
        /// Far more than rounding.
        const NEARLY: f64 = 1.0 - 1e-12;
        let mut greatest = loft;
        for (&vertex, &seen_back) in self.front.iter().zip(&self.slopes).take(usize::from(self.count)) {
            if (f64::from(seen_back) + slope + taper) * run_m < greatest * (run_m - ramp_m) * NEARLY {
                break;
            }
            let asked = required(vertex as usize);
            greatest = if asked > greatest { asked } else { greatest };
        }
        greatest
    }
}
