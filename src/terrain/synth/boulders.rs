//! Boulders: part-buried hemispheres with a measured size distribution.

use super::Canvas;
use super::options::{at_least, check_count, within};
use super::random::{Draws, Layer};
use crate::terrain::TerrainError;

/// Steps of the table of counts by diameter, evenly spaced in log D: with 512 steps the interpolation error is 1e-4.
const TABLE_STEPS: usize = 512;

/// Rocks as at the Viking and Pathfinder sites. The fraction of the ground covered by rocks of diameter D (m) or more is
///
/// ```text
/// F(D) = k exp(-q D),   q = 1.79 + 0.152 / k
/// ```
///
/// Source: Golombek and Rapp, Size-frequency distributions of rocks on Mars and Earth analog sites, J. Geophys. Res. 102
/// (1997) 4117, eqs. 1 and 6; heights of half the diameter as in Golombek et al., J. Geophys. Res. 108 (2003) 8086. A rock is
/// a hemisphere on the ground, sunk by `burial` times its radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boulders {
    /// k, the fraction of the ground covered by rocks of any size: 0.05 sparse, 0.2 rough.
    pub rock_abundance: f64,
    /// Smallest diameter drawn, m; at least one post spacing.
    pub diameter_min_m: f64,
    /// Largest diameter drawn, m.
    pub diameter_max_m: f64,
    /// Fraction of the radius below ground, 0 to 1.
    pub burial: f64,
}

impl Default for Boulders {
    /// A rock abundance of 10 %, rocks of 1 to 4 m, one fifth of the radius below ground.
    fn default() -> Self {
        Self { rock_abundance: 0.1, diameter_min_m: 1.0, diameter_max_m: 4.0, burial: 0.2 }
    }
}

impl Boulders {
    pub(super) fn add(&self, heights_m: &mut [f64], canvas: Canvas, seed: u64) -> Result<(), TerrainError> {
        within("rock_abundance", self.rock_abundance, 1.0e-4, 0.5, "")?;
        at_least("boulder diameter_min_m", self.diameter_min_m, canvas.spacing_m, "m, the post spacing")?;
        within("boulder diameter_max_m", self.diameter_max_m, self.diameter_min_m, 1000.0, "m")?;
        within("burial", self.burial, 0.0, 1.0, "")?;
        let table = self.counts_per_m2();
        let per_m2 = table.last().map_or(0.0, |entry| entry[1]);
        let margin_m = 0.5 * self.diameter_max_m;
        let [width_m, height_m] = canvas.extent_m();
        let expected = per_m2 * (width_m + 2.0 * margin_m) * (height_m + 2.0 * margin_m);
        check_count("rock_abundance", expected)?;
        let mut draws = Draws::of(seed, Layer::Boulders);
        // Where rocks overlap, the higher one is the surface.
        let mut over_ground_m = vec![0.0_f64; heights_m.len()];
        for _ in 0..draws.count(expected) {
            let centre = [draws.between(-margin_m, width_m + margin_m), draws.between(-margin_m, height_m + margin_m)];
            let radius_m = 0.5 * diameter_at(&table, draws.uniform() * per_m2);
            canvas.each_within(centre, radius_m, |index, [x_m, y_m]| {
                let (dx_m, dy_m) = (x_m - centre[0], y_m - centre[1]);
                let square = radius_m * radius_m - dx_m * dx_m - dy_m * dy_m;
                if square > 0.0 {
                    over_ground_m[index] = over_ground_m[index].max(libm::sqrt(square) - self.burial * radius_m);
                }
            });
        }
        for (height_m, rock_m) in heights_m.iter_mut().zip(over_ground_m) {
            *height_m += rock_m;
        }
        Ok(())
    }

    /// A table of diameters with the number of rocks per square metre from the smallest diameter up to each: the integral of
    /// 4 k q exp(-q D) / (pi D^2), by the midpoint rule in log D.
    fn counts_per_m2(&self) -> Vec<[f64; 2]> {
        let k = self.rock_abundance;
        let q = 1.79 + 0.152 / k;
        let ratio = self.diameter_max_m / self.diameter_min_m;
        #[expect(clippy::cast_precision_loss, reason = "a few hundred steps")]
        let diameter = |step: f64| self.diameter_min_m * libm::pow(ratio, step / TABLE_STEPS as f64);
        let mut table = vec![[self.diameter_min_m, 0.0]];
        let mut sum = 0.0;
        for step in 0..TABLE_STEPS {
            #[expect(clippy::cast_precision_loss, reason = "a few hundred steps")]
            let step = step as f64;
            let (low, middle, high) = (diameter(step), diameter(step + 0.5), diameter(step + 1.0));
            sum += 4.0 * k * q * libm::exp(-q * middle) / (std::f64::consts::PI * middle * middle) * (high - low);
            table.push([high, sum]);
        }
        table
    }
}

/// The diameter below which there are `count` rocks per square metre.
fn diameter_at(table: &[[f64; 2]], count: f64) -> f64 {
    let after = table.partition_point(|entry| entry[1] <= count).clamp(1, table.len() - 1);
    let ([low, before], [high, until]) = (table[after - 1], table[after]);
    let share = if until > before { ((count - before) / (until - before)).clamp(0.0, 1.0) } else { 0.0 };
    low + share * (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rocks_drawn_cover_the_fraction_of_ground_given_by_the_law() {
        let boulders = Boulders { rock_abundance: 0.2, diameter_min_m: 0.5, diameter_max_m: 5.0, burial: 0.0 };
        let table = boulders.counts_per_m2();
        let total = table.last().unwrap()[1];
        let mut draws = Draws::of(1, Layer::Boulders);
        let covered: f64 =
            (0..200_000).map(|_| diameter_at(&table, draws.uniform() * total)).map(|d| 0.25 * std::f64::consts::PI * d * d).sum();
        let q = 1.79 + 0.152 / 0.2;
        let law = 0.2 * ((-q * 0.5_f64).exp() - (-q * 5.0_f64).exp());
        let drawn = covered / 200_000.0 * total;
        assert!((drawn / law - 1.0).abs() < 0.02, "{drawn} {law}");
    }

    #[test]
    fn a_single_rock_rises_to_its_radius_minus_the_buried_part() {
        let canvas = Canvas { rows: 200, cols: 200, spacing_m: 0.05 };
        let boulders = Boulders { rock_abundance: 0.1, diameter_min_m: 1.0, diameter_max_m: 1.0, burial: 0.4 };
        let mut heights = vec![0.0; 200 * 200];
        // A single size contains no rocks: the law counts ranges of sizes.
        boulders.add(&mut heights, canvas, 1).unwrap();
        assert!(heights.iter().all(|height| *height == 0.0));
        let ranged = Boulders { diameter_max_m: 1.2, ..boulders };
        let mut highest: f64 = 0.0;
        for seed in 0..40 {
            ranged.add(&mut heights, canvas, seed).unwrap();
            highest = heights.iter().copied().fold(highest, f64::max);
            heights.fill(0.0);
        }
        assert!(highest > 0.29 && highest < 0.36 + 1e-9, "{highest}");
    }
}
