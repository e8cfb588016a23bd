//! Reads an XYZ grid.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::axis::{Axis, OFF_PLACE};
use super::rows::{Row, begins_with_post, read_rows};
use crate::quantity::MapPoint;
use crate::terrain::ascii_grid::Problems;
use crate::terrain::dem::Posts;
use crate::terrain::format::ReadContext;
use crate::terrain::stored::{Scaling, StoredRaster, StoredStep};
use crate::terrain::{Dem, DemReader, GeoReference, TerrainError};

/// The greatest number of lattice posts per line, beyond [`FREE_POSTS`]: the lattice of a strip rotated by 45 degrees is
/// mostly empty, and an even emptier one comes from scattered points.
const POSTS_PER_LINE: usize = 64;
const FREE_POSTS: usize = 1 << 16;

/// The reader of the XYZ format.
pub(in crate::terrain) struct XyzReader;

impl DemReader for XyzReader {
    fn name(&self) -> &'static str {
        "XYZ grid"
    }

    fn recognises(&self, beginning: &[u8]) -> bool {
        begins_with_post(beginning)
    }

    fn read_bytes(&self, bytes: Vec<u8>, context: &ReadContext) -> Result<Dem, TerrainError> {
        read_text(&bytes[..], context)
    }

    fn read_path(&self, path: &Path, context: &ReadContext) -> Result<Dem, TerrainError> {
        read_text(BufReader::new(File::open(path).map_err(TerrainError::reading)?), context)
    }
}

/// Reads an XYZ grid from memory.
///
/// One post per line, in any order: x, y and z in m, separated by commas, semicolons or white space. A header is optional;
/// with a header, the columns may be in any order, and other columns are ignored. Lines that begin with `#` are comments.
/// Posts without a line, or with a z of `nan`, are gaps. Spacings are derived from the coordinates, which may deviate from
/// the lattice by a fiftieth of a spacing.
///
/// # Errors
/// [`TerrainError::AsciiGrid`] with every problem found, each with its line; [`TerrainError::InvalidDem`] if the numbers do
/// not form a raster; [`TerrainError::Unsuitable`] if the coordinates look like degrees.
///
/// # Examples
/// ```
/// let dem = chta::terrain::read_xyz_bytes(b"x,y,z\n0,10,1\n5,10,2\n5,0,4\n")?;
/// assert_eq!((dem.rows(), dem.cols(), dem.georeference().dx_m()), (2, 2, 5.0));
/// assert_eq!((dem.elevation(0, 1), dem.elevation(1, 0)), (Some(2.0), None));
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn read_xyz_bytes(bytes: &[u8]) -> Result<Dem, TerrainError> {
    read_text(bytes, &ReadContext::default())
}

fn read_text(source: impl BufRead, context: &ReadContext) -> Result<Dem, TerrainError> {
    let no_data = context.sidecars.no_data(context.no_data, None)?;
    let scaling = context.sidecars.scaling(None)?;
    let mut problems = Problems::default();
    let (mut rows, decimals) = read_rows(source, &mut problems).map_err(TerrainError::reading)?;
    for row in &mut rows {
        row.z = if no_data.is_some_and(|mark| mark.is_double(row.z)) {
            f64::NAN
        } else if scaling == Scaling::NONE {
            row.z
        } else {
            scaling.apply(row.z)
        };
    }
    if problems.count() > 0 {
        return Err(problems.into_error());
    }
    let axes = (Axis::of(rows.iter().map(|row| row.x).collect()), Axis::of(rows.iter().map(|row| row.y).collect()));
    let (Some(x), Some(y)) = axes else {
        return Err(TerrainError::InvalidDem(format!(
            "the text has {} posts that all share their x or their y, expected at least two of each",
            rows.len()
        )));
    };
    let posts = gather(&rows, x, y, &mut problems);
    if problems.count() > 0 {
        return Err(problems.into_error());
    }
    #[expect(clippy::cast_precision_loss, reason = "rows stay far below 2^53: posts are bounded by the lines")]
    let north = y.first + (y.count - 1) as f64 * y.step;
    StoredRaster {
        rows: y.count,
        cols: x.count,
        posts: Posts::Double(posts),
        georeference: GeoReference::local(MapPoint::new(x.first, north), x.step, y.step)?,
        states_metres: false,
        south_up: false,
        scaling,
        step: StoredStep::of_decimals(decimals, scaling),
    }
    .finish(context)
}

/// The raster of all posts, row after row from the north.
fn gather(rows: &[Row], x: Axis, y: Axis, problems: &mut Problems) -> Vec<f64> {
    for row in rows {
        for (name, coordinate, axis) in [("x", row.x, x), ("y", row.y, y)] {
            let (_, away) = axis.place(coordinate);
            if away > OFF_PLACE {
                problems.add_at(
                    (row.line, 1),
                    &format!("{name} {coordinate}, {away:.3} spacings off the lattice"),
                    &format!(
                        "{name} at {} plus whole multiples of {} m (within {OFF_PLACE}); grid scattered points with gdal_grid",
                        axis.first, axis.step
                    ),
                );
            }
        }
    }
    let allowed = rows.len().saturating_mul(POSTS_PER_LINE).max(FREE_POSTS);
    let Some(count) = x.count.checked_mul(y.count).filter(|count| *count <= allowed) else {
        let found = format!("{} posts on a lattice of {} by {}", rows.len(), y.count, x.count);
        problems.add_at(
            (rows.last().map_or(1, |row| row.line), 1),
            &found,
            "a lattice that is mostly filled; grid scattered points with gdal_grid",
        );
        return Vec::new();
    };
    if problems.count() > 0 {
        return Vec::new();
    }
    let mut posts = vec![f64::NAN; count];
    let mut lines = vec![0; count];
    for row in rows {
        let index = (y.count - 1 - y.place(row.y).0.min(y.count - 1)) * x.count + x.place(row.x).0.min(x.count - 1);
        if lines[index] > 0 {
            let found = format!("the post ({}, {}) a second time", row.x, row.y);
            problems.add_at((row.line, 1), &found, &format!("each once (first on line {})", lines[index]));
        }
        (posts[index], lines[index]) = (row.z, row.line);
    }
    posts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        read_xyz_bytes(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn separators_headers_and_orders_give_the_same_dem() {
        let whole = read_xyz_bytes(b"0 10 1\n5 10 2\n0 0 3\n5 0 4\n").unwrap();
        for text in [
            "x,y,z\n5,0,4\n0,0,3\n5,10,2\n0,10,1",
            "# made up\r\n0;10;1\r\n5;10;2\r\n\r\n0;0;3\r\n5;0;4\r\n",
            "\u{feff}id, Z_m, Easting, Northing\n7, 1, 0, 10\n7, 2, 5, 10\n7, 3, 0, 0\n7, 4, 5, 0\n",
            "  0.0\t1e1 1\n 5 10 2\n 0 0 3\n 5 0 4",
        ] {
            assert!(begins_with_post(text.as_bytes()), "{text}");
            assert_eq!(read_xyz_bytes(text.as_bytes()).unwrap(), whole, "{text}");
        }
    }

    #[test]
    fn missing_posts_and_nan_are_gaps() {
        let dem = read_xyz_bytes(b"0 0 1\n1 0 nan\n2 1 5\n").unwrap();
        let posts: Vec<Option<f64>> = dem.elevations().collect();
        assert_eq!(posts, [None, None, Some(5.0), Some(1.0), None, None]);
    }

    #[test]
    fn all_problems_are_listed_with_their_lines() {
        let text = message("x,y,z\n0,0,1\n1,0,high\n2,0\n0,1,5\ninf,1,2\n");
        for expected in ["line 3", "z 'high'", "line 4", "2 fields", "line 6", "x 'inf'"] {
            assert!(text.contains(expected), "{expected}: {text}");
        }
        assert!(message("0;0;1,5\n1;0;2,5\n0;1;1\n").contains("decimal"), "decimal commas");
    }

    #[test]
    fn irregular_double_and_scattered_posts_are_refused_by_line() {
        let irregular = message("0 0 1\n1 0 1\n2 0 1\n3.3 0 1\n0 1 1\n1 1 1\n2 1 1\n");
        assert!(irregular.contains("line ") && irregular.contains("off the lattice"), "{irregular}");
        let double = message("0 0 1\n1 0 1\n0 1 1\n1 1 1\n1.0 0 2\n");
        assert!(double.contains("line 5") && double.contains("first on line 2"), "{double}");
        let scattered: String = (0..300).map(|k| format!("{} {} 1\n", k * k, k * k * k)).collect::<Vec<_>>().concat();
        assert!(message(&scattered).contains("gdal_grid"));
        assert!(message("0 0 1\n0 5 1\n").contains("share"));
        assert!(message("10.0 45.0 100\n10.1 45.0 200\n10.0 45.1 900\n10.1 45.1 100\n").contains("degrees"));
    }

    #[test]
    fn chain_tables_are_not_taken_for_grids() {
        assert!(!begins_with_post(b"x_m,z_m\n0,1\n"));
        assert!(!begins_with_post(b"x_m,z_m,friction_coefficient\n0,1,0.6\n"));
        assert!(!begins_with_post(b""));
    }
}
