//! A sinuous channel across the map.

use super::Canvas;
use super::options::{at_least, within};
use super::random::{Draws, Layer};
use crate::quantity::Angle;
use crate::terrain::TerrainError;

/// A channel from the map's west edge to its east edge, meandering around the middle as a sine, with straight walls and a
/// flat floor (V-shaped if the walls meet above it).
///
/// ```text
/// depth at distance r from the centre line = min(depth, (width / 2 - r) tan(wall slope)), not below 0
/// ```
///
/// The distance is the difference in northing times the cosine of the centre line's direction there, which is correct to
/// first order. Hadley Rille at Apollo 15 is some 1200 m wide and 370 m deep, with walls of 25 to 30 degrees (Howard, Head
/// and Swann, Proc. Lunar Sci. Conf. 3 (1972) 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rille {
    /// Width between the upper edges, m.
    pub width_m: f64,
    /// Depth of the floor below the surroundings, m.
    pub depth_m: f64,
    /// Slope of both walls, above 0 and below 80 degrees.
    pub wall_slope: Angle,
    /// Amplitude of the centre line to either side, m.
    pub meander_amplitude_m: f64,
    /// Wavelength of the meanders, m.
    pub meander_length_m: f64,
}

impl Default for Rille {
    /// A small lunar rille: 80 m wide, 15 m deep, walls of 28 degrees.
    fn default() -> Self {
        Self {
            width_m: 80.0,
            depth_m: 15.0,
            wall_slope: Angle::from_degrees(28.0),
            meander_amplitude_m: 30.0,
            meander_length_m: 300.0,
        }
    }
}

impl Rille {
    pub(super) fn add(&self, heights_m: &mut [f64], canvas: Canvas, seed: u64) -> Result<(), TerrainError> {
        at_least("rille width_m", self.width_m, canvas.spacing_m, "m, the post spacing")?;
        within("rille depth_m", self.depth_m, 0.0, 1.0e5, "m")?;
        within("rille wall_slope", self.wall_slope.degrees(), 0.1, 80.0, "degrees")?;
        within("rille meander_amplitude_m", self.meander_amplitude_m, 0.0, 1.0e7, "m")?;
        at_least("rille meander_length_m", self.meander_length_m, canvas.spacing_m, "m, the post spacing")?;
        let phase = Draws::of(seed, Layer::Rille).between(0.0, std::f64::consts::TAU);
        let middle_m = 0.5 * canvas.extent_m()[1];
        for row in 0..canvas.rows {
            for col in 0..canvas.cols {
                let [x_m, y_m] = canvas.place(row, col);
                heights_m[row * canvas.cols + col] -= self.depth_at(x_m, y_m - middle_m, phase);
            }
        }
        Ok(())
    }

    fn depth_at(&self, x_m: f64, y_m: f64, phase: f64) -> f64 {
        let wave_number = std::f64::consts::TAU / self.meander_length_m;
        let (sine, cosine) = libm::sincos(wave_number * x_m + phase);
        let direction = self.meander_amplitude_m * wave_number * cosine;
        let distance_m = (y_m - self.meander_amplitude_m * sine).abs() / libm::sqrt(1.0 + direction * direction);
        ((0.5 * self.width_m - distance_m) * self.wall_slope.slope()).clamp(0.0, self.depth_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_rille_has_its_width_depth_and_wall_slope() {
        let rille = Rille { meander_amplitude_m: 0.0, wall_slope: Angle::from_degrees(45.0), ..Rille::default() };
        assert_eq!(rille.depth_at(12.0, 0.0, 1.0), 15.0);
        assert_eq!(rille.depth_at(12.0, 40.0, 1.0), 0.0);
        assert!((rille.depth_at(12.0, -30.0, 1.0) - 10.0).abs() < 1e-12);
    }

    #[test]
    fn a_bend_follows_its_sine() {
        let rille = Rille::default();
        assert_eq!(rille.depth_at(75.0, 30.0, 0.0), 15.0);
        assert_eq!(rille.depth_at(225.0, 30.0, 0.0), 0.0);
    }
}
