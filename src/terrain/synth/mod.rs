//! Synthetic terrain from a seed: fractal ground, craters, a rille, boulders.
//!
//! The layers are added in that order, each with its own random stream of the seed, so that removing one does not change the
//! others. All draws are serial and all functions come from `libm`: the same seed gives the same bytes on every platform.

mod boulders;
mod craters;
mod fractal;
mod options;
mod random;
mod rille;
mod solids;

pub use boulders::Boulders;
pub use craters::{Craters, DepthLaw};
pub use fractal::FractalGround;
pub use rille::Rille;
pub use solids::{SyntheticMesh, synthesise_mesh};

use self::options::{at_least, within};
use super::{Dem, GeoReference, TerrainError};
use crate::quantity::{Angle, MapPoint};

/// The greatest number of rows and columns: the fractal's square then has 8192 posts per side and takes 1 GB of memory.
const LONGEST_SIDE: usize = 6553;

/// The layers and their parameters. Layers that are `None` are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntheticTerrain {
    /// Number of rows, 2 to 6553.
    pub rows: usize,
    /// Number of columns, 2 to 6553.
    pub cols: usize,
    /// Spacing of posts in both directions, m.
    pub spacing_m: f64,
    /// Map coordinates of the south-west post, m.
    pub south_west: MapPoint,
    /// Elevation of the base plane at the middle of the map, m.
    pub mean_elevation_m: f64,
    /// Slope of the base plane.
    pub tilt: Angle,
    /// The direction in which it rises, clockwise from grid north.
    pub tilt_towards: Angle,
    /// The random seed: the same seed gives the same terrain.
    pub seed: u64,
    /// Rough ground.
    pub ground: Option<FractalGround>,
    /// Impact craters.
    pub craters: Option<Craters>,
    /// One sinuous channel across the map.
    pub rille: Option<Rille>,
    /// Rocks.
    pub boulders: Option<Boulders>,
}

impl Default for SyntheticTerrain {
    /// A square of 256 m of rough level ground, with small craters, and without rille and boulders.
    fn default() -> Self {
        Self {
            rows: 257,
            cols: 257,
            spacing_m: 1.0,
            south_west: MapPoint::new(0.0, 0.0),
            mean_elevation_m: 0.0,
            tilt: Angle::from_radians(0.0),
            tilt_towards: Angle::from_radians(0.0),
            seed: 1,
            ground: Some(FractalGround::default()),
            craters: Some(Craters::default()),
            rille: None,
            boulders: None,
        }
    }
}

/// The raster on which the layers are drawn: rows from the south, in m from the south-west post.
#[derive(Clone, Copy, Debug)]
struct Canvas {
    rows: usize,
    cols: usize,
    spacing_m: f64,
}

impl Canvas {
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    fn place(self, row: usize, col: usize) -> [f64; 2] {
        [col as f64 * self.spacing_m, row as f64 * self.spacing_m]
    }

    /// Width and height between the outermost posts, m.
    fn extent_m(self) -> [f64; 2] {
        self.place(self.rows - 1, self.cols - 1)
    }

    /// Calls `draw` with the index and position of every post within `reach_m` of a centre, in a square.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the raster first")]
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    fn each_within(self, centre: [f64; 2], reach_m: f64, mut draw: impl FnMut(usize, [f64; 2])) {
        let span = |middle: f64, count: usize| {
            let first = ((middle - reach_m) / self.spacing_m).ceil().clamp(0.0, count as f64) as usize;
            let end = (((middle + reach_m) / self.spacing_m).floor() + 1.0).clamp(0.0, count as f64) as usize;
            first..end
        };
        for row in span(centre[1], self.rows) {
            for col in span(centre[0], self.cols) {
                draw(row * self.cols + col, self.place(row, col));
            }
        }
    }
}

/// Generates a terrain.
///
/// Elevations are rounded to 32-bit floats, so that files hold them exactly.
///
/// # Errors
/// [`TerrainError::InvalidOption`] with the option, its value and the allowed values.
///
/// # Examples
/// ```
/// use chta::terrain::{SyntheticTerrain, synthesise};
/// let flat = SyntheticTerrain { ground: None, craters: None, mean_elevation_m: 7.0, ..SyntheticTerrain::default() };
/// assert_eq!(synthesise(&flat)?.elevation_range_m(), (7.0, 7.0));
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn synthesise(terrain: &SyntheticTerrain) -> Result<Dem, TerrainError> {
    check(terrain)?;
    let canvas = Canvas { rows: terrain.rows, cols: terrain.cols, spacing_m: terrain.spacing_m };
    let mut heights_m = plane(terrain, canvas);
    if let Some(ground) = &terrain.ground {
        ground.add(&mut heights_m, canvas, terrain.seed)?;
    }
    if let Some(craters) = &terrain.craters {
        craters.add(&mut heights_m, canvas, terrain.seed)?;
    }
    if let Some(rille) = &terrain.rille {
        rille.add(&mut heights_m, canvas, terrain.seed)?;
    }
    if let Some(boulders) = &terrain.boulders {
        boulders.add(&mut heights_m, canvas, terrain.seed)?;
    }
    let height_m = canvas.extent_m()[1];
    let north_west = MapPoint::new(terrain.south_west.x, terrain.south_west.y + height_m);
    let georeference = GeoReference::local(north_west, terrain.spacing_m, terrain.spacing_m)?;
    Dem::from_single(terrain.rows, terrain.cols, northern_row_first(&heights_m, terrain.cols), georeference)
}

#[expect(clippy::cast_possible_truncation, reason = "elevations are rounded to what the files hold")]
fn northern_row_first(heights_m: &[f64], cols: usize) -> Vec<f32> {
    heights_m.chunks_exact(cols).rev().flatten().map(|&height_m| height_m as f32).collect()
}

fn plane(terrain: &SyntheticTerrain, canvas: Canvas) -> Vec<f64> {
    let slope = terrain.tilt.slope();
    let azimuth = terrain.tilt_towards.radians();
    let (east, north) = (slope * libm::sin(azimuth), slope * libm::cos(azimuth));
    let [width_m, height_m] = canvas.extent_m();
    let mut heights_m = Vec::with_capacity(canvas.rows * canvas.cols);
    for row in 0..canvas.rows {
        for col in 0..canvas.cols {
            let [x_m, y_m] = canvas.place(row, col);
            heights_m.push(terrain.mean_elevation_m + east * (x_m - 0.5 * width_m) + north * (y_m - 0.5 * height_m));
        }
    }
    heights_m
}

fn check(terrain: &SyntheticTerrain) -> Result<(), TerrainError> {
    for (option, count) in [("rows", terrain.rows), ("cols", terrain.cols)] {
        if !(2..=LONGEST_SIDE).contains(&count) {
            let expected = format!("2 to {LONGEST_SIDE}");
            return Err(TerrainError::InvalidOption { option, found: count.to_string(), expected });
        }
    }
    at_least("spacing_m", terrain.spacing_m, 1.0e-6, "m")?;
    within("south_west x", terrain.south_west.x, -1.0e9, 1.0e9, "m")?;
    within("south_west y", terrain.south_west.y, -1.0e9, 1.0e9, "m")?;
    within("mean_elevation_m", terrain.mean_elevation_m, -1.0e8, 1.0e8, "m")?;
    within("tilt", terrain.tilt.degrees(), 0.0, 80.0, "degrees")?;
    within("tilt_towards", terrain.tilt_towards.degrees(), -360.0, 360.0, "degrees")
}

#[cfg(test)]
mod tests;
