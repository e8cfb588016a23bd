//! One flight with deviations of speed and angle, and the scatter that remains.

use super::{ContactScatter, HopDeviations, PlannedHop};
use crate::{
    chain::Station,
    hop::{HopTest, flown_past},
    quantity::Angle,
    world::{Contact, Direction},
};

/// The standard normal distribution function, `Phi(x) = erfc(-x / sqrt 2) / 2`.
pub(super) fn normal(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

/// A cell of a normal deviation: its mean, its probability, and the standard deviation inside the cell.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub(super) mean: f64,
    pub(super) probability: f64,
    pub(super) sigma: f64,
}

/// The single cell of a deviation of zero.
const ALL_IN_ONE: [Cell; 1] = [Cell { mean: 0.0, probability: 1.0, sigma: 0.0 }];

/// The standard normal distribution cut at 0, 0.5, 1 and 2 on either side. There is a cut at the mean because commands on the
/// very edge of a cone are the most common: take-off and landing then fail on the same side.
const CELLS: [Cell; 8] = [
    Cell { mean: -2.373_215_533, probability: 0.022_750_132, sigma: 0.338_051_920 },
    Cell { mean: -1.383_169_047, probability: 0.135_905_122, sigma: 0.269_708_891 },
    Cell { mean: -0.734_540_459, probability: 0.149_882_285, sigma: 0.143_241_039 },
    Cell { mean: -0.244_836_264, probability: 0.191_462_461, sigma: 0.143_681_448 },
    Cell { mean: 0.244_836_264, probability: 0.191_462_461, sigma: 0.143_681_448 },
    Cell { mean: 0.734_540_459, probability: 0.149_882_285, sigma: 0.143_241_039 },
    Cell { mean: 1.383_169_047, probability: 0.135_905_122, sigma: 0.269_708_891 },
    Cell { mean: 2.373_215_533, probability: 0.022_750_132, sigma: 0.338_051_920 },
];

/// The cells of a deviation; a single cell if the deviation is zero.
pub(super) fn cells(sigma: f64) -> impl Iterator<Item = Cell> {
    let all: &[Cell] = if sigma > 0.0 { &CELLS } else { &ALL_IN_ONE };
    all.iter().map(move |cell| Cell { mean: cell.mean * sigma, sigma: cell.sigma * sigma, ..*cell })
}

/// What all flights of a hop have in common.
pub(super) struct Ground {
    /// Slope of the ground at the take-off, along the direction of travel.
    takeoff: f64,
    /// Slope of the ground at the landing.
    landing: f64,
}

impl Ground {
    pub(super) fn of(test: &HopTest, hop: &PlannedHop, direction: Direction) -> Self {
        let slopes = test.chain().geometry().slopes();
        let slope = |station: &Station, contact| {
            let segment = station.ruling_segment(contact, direction, slopes.len());
            segment.map_or(0.0, |segment| direction.sign() * slopes[segment.index()])
        };
        Self { takeoff: slope(&hop.takeoff, Contact::Takeoff), landing: slope(&hop.landing, Contact::Landing) }
    }
}

/// One flight with deviations of speed and angle, `z = m d - c d^2`, down to the straight ground around the planned landing.
pub(super) struct Flight {
    angle: f64,
    slope: f64,
    speed_m_s: f64,
    /// `c = g / (2 v_x^2)`.
    bend_per_m: f64,
    /// Horizontal distance covered, m.
    pub(super) run_m: f64,
    landing_slope: f64,
    landing_speed_m_s: f64,
    /// Standard deviation of the landing position, m.
    landing_sigma_m: f64,
    /// Standard deviation of the angle inside its cell, radians.
    angle_sigma: f64,
    /// Standard deviation of the speed inside its cell, m/s.
    speed_sigma_m_s: f64,
}

impl Flight {
    /// The flight with these deviations of speed and angle; `None` if it does not land on that ground.
    ///
    /// ```text
    ///     c d^2 - (m - s) d + (Z - s X) = 0, the larger root
    /// ```
    ///
    /// with the slope `s` of the ground at the planned landing `(X, Z)`. The landing scatters around this root by the
    /// remaining deviations: of position, `dz = (s_t - z'(d)) dx_t`, of height, and of speed and angle inside their cells,
    /// `dz/dv = 2 c d^2 / v` and `dz/dtheta = (1 + m^2) d - 2 m c d^2`, each divided by the closing slope `s - z'(d)`.
    pub(super) fn new(
        deviations: &HopDeviations,
        test: &HopTest,
        hop: &PlannedHop,
        ground: &Ground,
        [speed, angle]: [Cell; 2],
    ) -> Option<Self> {
        let (angle, angle_sigma) = (hop.arc.takeoff_angle().radians() + angle.mean, angle.sigma);
        let (speed_m_s, slope) = (hop.arc.takeoff_speed_m_s() + speed.mean, Angle::from_radians(angle).slope());
        if speed_m_s <= 0.0 || !slope.is_finite() {
            return None;
        }
        let horizontal_m_s = speed_m_s / libm::hypot(1.0, slope);
        let bend_per_m = test.gravity_m_s2() / (2.0 * horizontal_m_s * horizontal_m_s);
        let sight = hop.arc.line_of_sight();
        let half = 0.5 * (slope - ground.landing);
        let root = half * half - bend_per_m * (sight.rise_m() - ground.landing * sight.run_m());
        let run_m = (half + root.max(0.0).sqrt()) / bend_per_m;
        if root < 0.0 || run_m <= 0.0 {
            return None;
        }
        let landing_slope = slope - 2.0 * bend_per_m * run_m;
        let mut flight = Self {
            angle,
            slope,
            speed_m_s,
            bend_per_m,
            run_m,
            landing_slope,
            landing_speed_m_s: horizontal_m_s * libm::hypot(1.0, landing_slope),
            landing_sigma_m: 0.0,
            angle_sigma,
            speed_sigma_m_s: speed.sigma,
        };
        let closing = ground.landing - landing_slope;
        flight.landing_sigma_m = flight.height_sigma_m(deviations, ground, run_m) / closing;
        (closing > 0.0).then_some(flight)
    }

    /// The standard deviation of the arc's height above the ground at a distance `d` from the take-off, m.
    ///
    /// The root of the sum of squares of four independent parts, with the derivatives of [`Self::new`]:
    ///
    /// ```text
    ///     (2 c d^2 / v) sigma_v,   ((1 + m^2) d - 2 m c d^2) sigma_theta,   (s_t - z'(d)) sigma_x,   sigma_z
    /// ```
    fn height_sigma_m(&self, deviations: &HopDeviations, ground: &Ground, d_m: f64) -> f64 {
        let fall_m = self.bend_per_m * d_m * d_m;
        let by_speed = 2.0 * fall_m * self.speed_sigma_m_s / self.speed_m_s;
        let by_angle = ((1.0 + self.slope * self.slope) * d_m - 2.0 * self.slope * fall_m) * self.angle_sigma;
        let by_place = (ground.takeoff - (self.slope - 2.0 * self.bend_per_m * d_m)) * deviations.place_m;
        [by_speed, by_angle, by_place, deviations.height_m].into_iter().fold(0.0, libm::hypot)
    }

    /// The probability of striking the most critical vertex between take-off and landing, `Phi(-min(height / sigma))`; 0 without
    /// such vertices.
    ///
    /// Vertices within four standard deviations of either end belong to the ground of that contact, which is checked there.
    pub(super) fn strike_probability(&self, deviations: &HopDeviations, test: &HopTest, hop: &PlannedHop, ground: &Ground) -> f64 {
        let vertices = test.chain().geometry().vertices();
        let mut least = f64::INFINITY;
        for vertex in &vertices[flown_past(&hop.takeoff, &hop.landing)] {
            let d_m = (vertex.x_m - hop.takeoff.point.x_m).abs();
            if d_m <= 4.0 * deviations.place_m || self.run_m - d_m <= 4.0 * self.landing_sigma_m {
                continue;
            }
            let height_m = hop.takeoff.point.z_m + d_m * (self.slope - self.bend_per_m * d_m) - vertex.z_m;
            let sigma_m = self.height_sigma_m(deviations, ground, d_m).max(f64::MIN_POSITIVE);
            least = least.min(height_m / sigma_m);
        }
        normal(-least)
    }

    /// The scatter of the take-off.
    pub(super) fn takeoff(&self, deviations: &HopDeviations) -> ContactScatter {
        ContactScatter {
            contact: Contact::Takeoff,
            shift_m: 0.0,
            place_m: deviations.place_m,
            angle: self.angle,
            angle_per_m: 0.0,
            angle_sigma: self.angle_sigma,
            // The actual take-off speed cannot exceed what the actuator gives: its limit is a limit for planning only.
            speed_m_s: 0.0,
            speed_sigma_m_s: 0.0,
            tolerance_m: None,
        }
    }

    /// The scatter of the landing.
    ///
    /// ```text
    ///     d(slope)/dx = -2 c,   sigma_landing = sigma_theta (1 + m^2) / (1 + l^2) at a fixed position, since l = 2 b - m
    /// ```
    pub(super) fn landing(&self, hop: &PlannedHop) -> ContactScatter {
        let steepness = 1.0 + self.landing_slope * self.landing_slope;
        ContactScatter {
            contact: Contact::Landing,
            shift_m: self.run_m - hop.arc.line_of_sight().run_m(),
            place_m: self.landing_sigma_m,
            angle: libm::atan(self.landing_slope),
            angle_per_m: -2.0 * self.bend_per_m / steepness,
            angle_sigma: self.angle_sigma * (1.0 + self.slope * self.slope) / steepness,
            speed_m_s: self.landing_speed_m_s,
            speed_sigma_m_s: self.speed_sigma_m_s * self.speed_m_s / self.landing_speed_m_s,
            tolerance_m: hop.tolerance_m,
        }
    }
}
