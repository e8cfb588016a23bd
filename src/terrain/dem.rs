//! The elevation raster in memory.

use super::stored::StoredStep;
use super::{GeoReference, MapBounds, PostLattice, TerrainError, lattice::check_sides};

/// The largest absolute elevation, m: larger numbers are undeclared no-data values (no body has such elevations; the usual
/// marks -2147483648 and 3.4e38 exceed 1e9).
pub const ELEVATION_LIMIT_M: f64 = 1.0e9;

/// A raster of elevations: at least 2 x 2 posts, row-major from the north, with explicit gaps.
///
/// Stored as 32-bit floats if that represents every elevation exactly, else as 64-bit floats, so no elevation is rounded.
#[derive(Clone, Debug)]
pub struct Dem {
    lattice: PostLattice,
    posts: Posts,
    /// The step of the numbers in the file.
    step: StoredStep,
}

/// The stored elevations of a raster, row after row from the north; NaN is a gap.
#[derive(Clone, Copy, Debug)]
pub enum Samples<'a> {
    /// 32-bit floats.
    Single(&'a [f32]),
    /// 64-bit floats.
    Double(&'a [f64]),
}

/// NaN is a gap.
#[derive(Clone, Debug)]
pub(super) enum Posts {
    Single(Vec<f32>),
    Double(Vec<f64>),
}

impl Posts {
    fn len(&self) -> usize {
        match self {
            Self::Single(values) => values.len(),
            Self::Double(values) => values.len(),
        }
    }

    /// Sets the posts that a mask does not show to gaps.
    pub(super) fn blank(&mut self, shown: &[bool]) {
        match self {
            Self::Single(values) => values.iter_mut().zip(shown).filter(|(_, shown)| !**shown).for_each(|(z, _)| *z = f32::NAN),
            Self::Double(values) => values.iter_mut().zip(shown).filter(|(_, shown)| !**shown).for_each(|(z, _)| *z = f64::NAN),
        }
    }

    fn at(&self, index: usize) -> Option<f64> {
        let value = match self {
            Self::Single(values) => values.get(index).map(|&value| f64::from(value)),
            Self::Double(values) => values.get(index).copied(),
        };
        value.filter(|value| !value.is_nan())
    }

    /// Converts to single precision if no elevation changes.
    #[expect(clippy::cast_possible_truncation, reason = "taken only where the way back gives the same number")]
    pub(super) fn narrowed(self) -> Self {
        match self {
            Self::Double(values) if values.iter().all(|&z| z.is_nan() || f64::from(z as f32) == z) => {
                Self::Single(values.into_iter().map(|z| z as f32).collect())
            }
            other => other,
        }
    }
}

impl Dem {
    /// A raster from its elevations, row after row from the north, each row from the west; NaN means no elevation.
    ///
    /// # Errors
    /// [`TerrainError::InvalidDem`] if there are fewer than 2 rows or columns, the number of elevations is not `rows * cols`,
    /// an elevation is beyond [`ELEVATION_LIMIT_M`] (also if infinite), no post has an elevation, or neighbouring posts have
    /// equal map coordinates in floating point.
    ///
    /// # Examples
    /// ```
    /// use chta::quantity::MapPoint;
    /// use chta::terrain::{Dem, GeoReference};
    /// let map = GeoReference::local(MapPoint::new(0.0, 10.0), 10.0, 10.0)?;
    /// let dem = Dem::new(2, 2, vec![1.0, 2.5, f64::NAN, 4.0], map)?;
    /// assert_eq!(dem.elevation(0, 1), Some(2.5));
    /// assert_eq!(dem.elevation(1, 0), None);
    /// # Ok::<(), chta::terrain::TerrainError>(())
    /// ```
    pub fn new(rows: usize, cols: usize, elevations_m: Vec<f64>, georeference: GeoReference) -> Result<Self, TerrainError> {
        Self::from_posts(rows, cols, Posts::Double(elevations_m).narrowed(), georeference)
    }

    /// The same from 32-bit elevations, which are stored as they are.
    ///
    /// # Errors
    /// As [`Dem::new`].
    pub fn from_single(rows: usize, cols: usize, elevations_m: Vec<f32>, georeference: GeoReference) -> Result<Self, TerrainError> {
        Self::from_posts(rows, cols, Posts::Single(elevations_m), georeference)
    }

    fn from_posts(rows: usize, cols: usize, posts: Posts, georeference: GeoReference) -> Result<Self, TerrainError> {
        check_sides(rows, cols)?;
        if rows.checked_mul(cols) != Some(posts.len()) {
            return Err(TerrainError::InvalidDem(format!(
                "the raster has {} elevations, expected {rows} rows times {cols} columns",
                posts.len()
            )));
        }
        Self::from_lattice(PostLattice::new(rows, cols, georeference)?, posts)
    }

    /// The same on a lattice of as many posts.
    pub(super) fn from_lattice(lattice: PostLattice, posts: Posts) -> Result<Self, TerrainError> {
        let dem = Self { lattice, posts, step: StoredStep::Fine };
        dem.check_elevations()?;
        Ok(dem)
    }

    /// The same with the step of its file's numbers.
    pub(super) fn with_step(self, step: StoredStep) -> Self {
        Self { step, ..self }
    }

    /// What an analyst should know of the file: a step of the stored numbers that makes slopes.
    pub fn warnings(&self) -> Vec<String> {
        super::DemFile::warnings(self, self.elevation_range_m())
    }

    pub(super) fn step(&self) -> StoredStep {
        self.step
    }

    fn check_elevations(&self) -> Result<(), TerrainError> {
        let any = match &self.posts {
            Posts::Single(values) => any_elevation(values, self.cols())?,
            Posts::Double(values) => any_elevation(values, self.cols())?,
        };
        if any {
            return Ok(());
        }
        Err(TerrainError::InvalidDem(format!(
            "all {} posts are no-data, expected elevations; check the declared no-data value with gdalinfo, and if it is wrong remove it \
             with: gdal_translate -a_nodata none in.tif out.tif",
            self.posts.len()
        )))
    }

    /// The lattice of the posts.
    pub fn lattice(&self) -> &PostLattice {
        &self.lattice
    }

    /// Number of rows, north to south.
    pub fn rows(&self) -> usize {
        self.lattice.rows()
    }

    /// Number of columns, west to east.
    pub fn cols(&self) -> usize {
        self.lattice.cols()
    }

    /// The position of the posts on the map.
    pub fn georeference(&self) -> &GeoReference {
        self.lattice.georeference()
    }

    /// The rectangle of the outermost posts.
    pub fn bounds(&self) -> MapBounds {
        self.lattice.bounds()
    }

    /// Elevation of a post, m; `None` if it has none, and outside the raster.
    pub fn elevation(&self, row: usize, col: usize) -> Option<f64> {
        self.posts.at(self.lattice.index(row, col)?)
    }

    /// All elevations, row after row from the north, `None` for gaps.
    pub fn elevations(&self) -> impl Iterator<Item = Option<f64>> + '_ {
        (0..self.posts.len()).map(|index| self.posts.at(index))
    }

    /// Whether the elevations are stored as 32-bit floats (without loss).
    pub fn is_single_precision(&self) -> bool {
        matches!(self.posts, Posts::Single(_))
    }

    /// The bytes that the stored elevations take.
    pub fn elevations_bytes(&self) -> u64 {
        let of_post = match self.samples() {
            Samples::Single(_) => size_of::<f32>(),
            Samples::Double(_) => size_of::<f64>(),
        };
        (self.rows() * self.cols() * of_post) as u64
    }

    /// The stored elevations, for loops over millions of them.
    pub fn samples(&self) -> Samples<'_> {
        match &self.posts {
            Posts::Single(values) => Samples::Single(values),
            Posts::Double(values) => Samples::Double(values),
        }
    }

    /// Lowest and highest elevation, m.
    pub fn elevation_range_m(&self) -> (f64, f64) {
        // `min` and `max` of a number and NaN return the number.
        match &self.posts {
            Posts::Single(values) => {
                let (low, high) =
                    values.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), z| (low.min(*z), high.max(*z)));
                (low.into(), high.into())
            }
            Posts::Double(values) => {
                values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(*z), high.max(*z)))
            }
        }
    }

    pub(super) fn posts(&self) -> &Posts {
        &self.posts
    }
}

/// Whether there is any elevation; refuses values beyond the limit.
fn any_elevation<T: Copy + Into<f64>>(posts: &[T], cols: usize) -> Result<bool, TerrainError> {
    let mut any = false;
    for (index, &post) in posts.iter().enumerate() {
        let z_m: f64 = post.into();
        any |= !z_m.is_nan();
        // Compared inline: a function call would slow down a loop over millions of posts.
        if z_m.abs() >= ELEVATION_LIMIT_M {
            check_elevation(z_m, index / cols, index % cols)?;
        }
    }
    Ok(any)
}

/// Refuses a value beyond the limit for elevations; NaN is a gap.
pub(super) fn check_elevation(z_m: f64, row: usize, col: usize) -> Result<(), TerrainError> {
    if z_m.is_nan() || z_m.abs() < ELEVATION_LIMIT_M {
        return Ok(());
    }
    Err(TerrainError::InvalidDem(format!(
        "row {row}, column {col} (from 0, from the north-west) holds {z_m:e} m, expected an elevation within {ELEVATION_LIMIT_M:e} m; \
         if it marks missing data, say so with terrain.no_data = {z_m:e}, or with: gdal_translate -a_nodata {z_m:e} in.tif out.tif"
    )))
}

/// Equal posts at equal positions: gaps equal gaps, and the precision of storage is ignored.
impl PartialEq for Dem {
    fn eq(&self, other: &Self) -> bool {
        self.lattice == other.lattice && self.elevations().eq(other.elevations())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::MapPoint;

    fn map() -> GeoReference {
        GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 2.0).unwrap()
    }

    #[test]
    fn numbers_that_fit_single_precision_are_kept_in_it_and_others_are_not_rounded() {
        assert!(Dem::new(2, 2, vec![0.5, 1.0, 2.0, f64::NAN], map()).unwrap().is_single_precision());
        let fine = Dem::new(2, 2, vec![0.1, 1.0, 2.0, 3.0], map()).unwrap();
        assert!(!fine.is_single_precision());
        assert_eq!(fine.elevation(0, 0), Some(0.1));
    }

    #[test]
    fn rasters_that_make_no_sense_are_refused_with_their_numbers() {
        let cases: [(usize, usize, Vec<f64>, &str); 5] = [
            (1, 4, vec![0.0; 4], "1 rows and 4 columns"),
            (2, 2, vec![0.0; 5], "5 elevations"),
            (2, 2, vec![f64::NAN; 4], "all 4 posts are no-data"),
            (2, 2, vec![0.0, f64::INFINITY, 0.0, 0.0], "row 0, column 1"),
            (usize::MAX, 3, vec![0.0; 4], "4 elevations"),
        ];
        for (rows, cols, elevations, expected) in cases {
            let message = Dem::new(rows, cols, elevations, map()).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn posts_that_share_a_coordinate_are_refused() {
        let map = GeoReference::local(MapPoint::new(1.0e15, 0.0), 0.01, 1.0).unwrap();
        assert!(Dem::new(2, 2, vec![0.0; 4], map).unwrap_err().to_string().contains("apart"));
        assert!(GeoReference::local(MapPoint::new(0.0, 0.0), 0.0, 1.0).is_err());
        assert!(GeoReference::local(MapPoint::new(f64::NAN, 0.0), 1.0, 1.0).is_err());
    }

    #[test]
    fn outside_the_raster_there_is_no_elevation() {
        let dem = Dem::new(2, 3, vec![0.0; 6], map()).unwrap();
        assert_eq!(dem.elevation(0, 3), None);
        assert_eq!(dem.elevation(2, 0), None);
        assert_eq!(dem.bounds(), MapBounds { min: MapPoint::new(0.0, -2.0), max: MapPoint::new(2.0, 0.0) });
    }
}
