//! What legs between posts cost, from the heights of the posts that they cross.

use super::{
    leg::{DriveGround, DriveLeg},
    template::Template,
};
use crate::{
    terrain::{Dem, Samples},
    world::Rover,
};

/// What a drive map adds up along its ways, and keeps least.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DriveAmount {
    /// Time, turns included, s.
    Time,
    /// Energy from the store per unit mass, idle power during turns included, J/kg.
    Energy,
    /// The length in three dimensions, m. With a constant rate of failures per metre this is the risk too.
    Length,
}

impl DriveAmount {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Time, Self::Energy, Self::Length];

    /// The name in results, with its unit.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Time => "time_s",
            Self::Energy => "energy_j_kg",
            Self::Length => "length_m",
        }
    }

    /// What a piece of this horizontal length and slope along it takes.
    #[inline]
    pub(super) fn of_piece(self, rover: &Rover, gravity_m_s2: f64, run_m: f64, slope: f64) -> f64 {
        let length_m = run_m * (1.0 + slope * slope).sqrt();
        match self {
            Self::Time => length_m / rover.speed_m_s(slope),
            Self::Energy => length_m * rover.energy_j_kg_m(slope, gravity_m_s2),
            Self::Length => length_m,
        }
    }

    /// The least that a metre of horizontal way takes, whatever the ground.
    pub(super) fn least_per_m(self, rover: &Rover) -> f64 {
        /// Below what sums of pieces round to.
        const SAFE: f64 = 1.0 - 1e-12;
        SAFE * match self {
            Self::Time => 1.0 / rover.limits().speed_m_s,
            Self::Energy => rover.idle_j_kg_s() / rover.limits().speed_m_s,
            Self::Length => 1.0,
        }
    }

    /// What turning by a degree takes.
    pub(super) fn per_turned_deg(self, rover: &Rover) -> f64 {
        let turn_s_per_deg = rover.limits().turn_s_per_deg;
        match self {
            Self::Time => turn_s_per_deg,
            Self::Energy => turn_s_per_deg * rover.idle_j_kg_s(),
            Self::Length => 0.0,
        }
    }
}

/// A vertex of a leg: its height is that of one post and a share of the way to another.
#[derive(Clone, Copy, Debug)]
struct Step {
    first: isize,
    second: isize,
    share: f64,
    /// The length of the piece before it, m, and one over that.
    run_m: f64,
    per_run: f64,
}

/// Prices the legs between posts.
#[derive(Clone, Debug)]
pub(super) struct PostPrices<'a> {
    dem: &'a Dem,
    rover: &'a Rover,
    gravity_m_s2: f64,
    amount: DriveAmount,
    /// The vertices of each offset's legs, and where those of an offset begin.
    steps: Vec<Step>,
    begins: Vec<usize>,
}

impl<'a> PostPrices<'a> {
    /// Of legs of these offsets.
    pub(super) fn new(drive: &DriveGround<'a>, amount: DriveAmount, offsets: &[(i32, i32)]) -> Self {
        let dem = drive.ground().terrain().dem();
        let width = dem.cols().cast_signed();
        let (mut steps, mut begins) = (Vec::new(), vec![0]);
        for offset in offsets {
            let template = Template::new(dem.georeference(), *offset, 0.0);
            steps.extend(template.vertices[1..].iter().zip(&template.pieces).map(|(vertex, piece)| {
                let mut terms =
                    vertex.height.terms().map(|((east, south), weight)| (south as isize * width + east as isize, weight));
                let (first, _) = terms.next().unwrap_or_default();
                let (second, share) = terms.next().unwrap_or((first, 0.0));
                Step { first, second, share, run_m: piece.run_m, per_run: 1.0 / piece.run_m }
            }));
            begins.push(steps.len());
        }
        Self { dem, rover: drive.rover(), gravity_m_s2: drive.gravity_m_s2(), amount, steps, begins }
    }

    /// What the leg of an offset from a post takes; it must be allowed.
    #[inline]
    pub(super) fn cost(&self, post: usize, offset: usize) -> f64 {
        match self.dem.samples() {
            Samples::Single(values) => self.sum(values, post, offset),
            Samples::Double(values) => self.sum(values, post, offset),
        }
    }

    #[inline]
    fn sum<T: Copy + Into<f64>>(&self, heights: &[T], post: usize, offset: usize) -> f64 {
        let mut cost = 0.0;
        self.pieces(heights, post, offset, |run_m, slope| {
            cost += self.amount.of_piece(self.rover, self.gravity_m_s2, run_m, slope);
        });
        cost
    }

    /// All that the leg takes, without its extremes.
    pub(super) fn leg(&self, post: usize, offset: usize) -> DriveLeg {
        let mut leg = DriveLeg::default();
        let add = |run_m: f64, slope: f64| {
            let [time_s, energy_j_kg, length_m] =
                DriveAmount::ALL.map(|amount| amount.of_piece(self.rover, self.gravity_m_s2, run_m, slope));
            leg.run_m += run_m;
            leg.length_m += length_m;
            leg.climb_m += run_m * slope.max(0.0);
            leg.descent_m += run_m * (-slope).max(0.0);
            leg.time_s += time_s;
            leg.energy_j_kg += energy_j_kg;
        };
        match self.dem.samples() {
            Samples::Single(values) => self.pieces(values, post, offset, add),
            Samples::Double(values) => self.pieces(values, post, offset, add),
        }
        leg
    }

    /// Visits the pieces of a leg: their horizontal length, m, and slope.
    #[inline]
    fn pieces<T: Copy + Into<f64>>(&self, heights: &[T], post: usize, offset: usize, mut visit: impl FnMut(f64, f64)) {
        let at = |step: isize| -> f64 { heights[post.wrapping_add_signed(step)].into() };
        let mut before_m = at(0);
        for step in &self.steps[self.begins[offset]..self.begins[offset + 1]] {
            let first_m = at(step.first);
            let height_m = first_m + step.share * (at(step.second) - first_m);
            visit(step.run_m, (height_m - before_m) * step.per_run);
            before_m = height_m;
        }
    }
}
