//! Reads an XYZ grid.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::axis::{Axis, OFF_PLACE};
use super::header::begins_with_post;
use super::rows::{Row, Rows, read_rows};
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
/// One post per line, in any order: x, y and z in m, separated by commas, semicolons or white space, with decimal points or, if
/// no number can be meant otherwise, decimal commas. Further columns are ignored. A header, also in a comment, is optional and
/// puts the columns in any order; units in it must be metres. Lines that begin with `#`, `//`, `;`, `%` or `!` are comments.
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
    let mut read = read_rows(source, &mut problems)?;
    for row in &mut read.posts {
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
    let rows = &read.posts;
    let axes = (Axis::of(rows.iter().map(|row| row.x).collect()), Axis::of(rows.iter().map(|row| row.y).collect()));
    let (Some(x), Some(y)) = axes else {
        return Err(TerrainError::InvalidDem(format!(
            "the text has {} posts that all share their x or their y, expected at least two of each",
            rows.len()
        )));
    };
    check_columns(&read, x, y, &mut problems);
    if problems.count() > 0 {
        return Err(problems.into_error());
    }
    let posts = gather(rows, x, y, &mut problems);
    check_end(&read, posts.len(), &mut problems);
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
        step: StoredStep::of_text(read.decimals, scaling),
    }
    .finish(context)
}

/// Refuses a text whose first two columns count rows and columns, or lines, and whose coordinates come after them: read as x,
/// y and z it would be a smooth plane. A header settles which columns are meant.
fn check_columns(read: &Rows, x: Axis, y: Axis, problems: &mut Problems) {
    let rows = &read.posts;
    let Some(line) = rows.first().map(|row| row.line) else { return };
    let expected = "x, y and z in the first three columns, or a header with the names of the columns, such as x y z";
    if read.further && rows.len() > 2 && rows.windows(2).all(|pair| pair[1].x - pair[0].x == 1.0) {
        problems.add_at((line, 1), "a first column that counts the lines", expected);
    }
    if read.fourth.len() == rows.len() && x.count <= rows.len() && y.count <= rows.len() {
        let place = |axis: Axis, coordinate: f64| axis.place(coordinate).0.min(axis.count - 1);
        let varies_with = |axis: Axis, coordinate: &dyn Fn(&Row) -> f64, values: &mut dyn Iterator<Item = f64>| {
            let mut seen: Vec<Option<f64>> = vec![None; axis.count];
            let alone = rows.iter().zip(values).all(|(row, value)| {
                let known = seen[place(axis, coordinate(row))].get_or_insert(value);
                known.to_bits() == value.to_bits()
            });
            let mut different = seen.iter().flatten();
            let first = different.next().copied();
            alone && different.any(|value| Some(*value) != first)
        };
        let third = |axis, coordinate: &dyn Fn(&Row) -> f64| varies_with(axis, coordinate, &mut rows.iter().map(|row| row.z));
        let fourth = |axis, coordinate: &dyn Fn(&Row) -> f64| varies_with(axis, coordinate, &mut read.fourth.iter().copied());
        let of_x = |row: &Row| row.x;
        let of_y = |row: &Row| row.y;
        if (third(x, &of_x) && fourth(y, &of_y)) || (third(y, &of_y) && fourth(x, &of_x)) {
            problems.add_at((line, 1), "a third and a fourth column that are the coordinates of a grid as well", expected);
        }
    }
}

/// Refuses a text that ends in the middle of a line where a second sign says that it was cut short.
fn check_end(read: &Rows, posts: usize, problems: &mut Problems) {
    let (Some(last), true) = (read.posts.last(), read.open) else { return };
    let missing = posts.saturating_sub(read.posts.len());
    let sign = if read.short_last {
        "fewer digits in the last number than in all others".to_owned()
    } else if missing > 0 {
        format!("{} posts read on a lattice of {posts}", read.posts.len())
    } else {
        return;
    };
    problems.add_at(
        (last.line, 1),
        &format!("the end of the file within a line, and {sign}"),
        "a whole file; if it was cut short, copy it again, and if it is whole, end its last line",
    );
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
            "// a\r% b\r! c\r0 10 1\r5 10 2\r0 0 3\r5 0 4\r",
            "//X Y Z R G B\n0 10 1 9 9 9\n5 10 2 9 9 9\n0 0 3 9 9 9\n5 0 4 9 9 9\n",
            "; y x z\n10 0 1\n10 5 2\n0 0 3\n0 5 4\n",
            "0,0 10,00 1\n5 10 2\n0 0 3\n5 0 4\n",
            "0,0;10;1,00;a\n5;10;2;b\n0;0;3;c\n5;0;4;d\n",
            "\"0,0\",\"10,0\",\"1,0\"\n5,10,2\n0,0,3\n5,0,4,\n",
            "X[m],Y (m),Elevation [metres]\n0,10,1\n5,10,2\n0,0,3\n5,0,4\n",
            "0\t10\t1\tsand and rock\n5\t10\t2\trock\n0\t0\t3\tx\n5\t0\t4\tx\n",
            "\u{feff}id, Z_m, Easting, Northing\n7, 1, 0, 10\n7, 2, 5, 10\n7, 3, 0, 0\n7, 4, 5, 0\n",
            "  0.0\t1e1 1\n 5 10 2\n 0 0 3\n 5 0 4",
            "//X Y Z\n4\n0 10 1\n5 10 2\n0 0 3\n5 0 4\n",
            "x y z\n4\n0 10 1\n5 10 2\n0 0 3\n5 0 4\n",
            "4\n0 10 1 9 9 9\n5 10 2 9 9 9\n0 0 3 9 9 9\n5 0 4 9 9 9\n",
            "x\u{a0}y\u{a0}z\n0\u{a0}10\u{a0}1\n5\u{a0}10\u{a0}2\n0\u{a0}0\u{a0}3\n5\u{a0}0\u{a0}4\n",
            "0\u{202f}10\u{202f}1\n5\u{202f}10\u{202f}2\n0\u{202f}0\u{202f}3\n5\u{202f}0\u{202f}4\n",
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

    /// What is recognised is read, or refused for a reason that can be mended.
    #[test]
    fn notations_with_two_meanings_are_refused_by_name() {
        for (text, expected) in [
            ("0 0 1,000\n1 0 2,000\n0 1 1,500\n1 1 2,500\n", "thousands (then write 1000) or decimals (then write 1.000)"),
            ("0;0;1.234,5\n1;0;1.234,5\n0;1;1.234,5\n1;1;1.234,5\n", "without separators of thousands"),
            ("0;0;1'234\n1;0;1'234\n0;1;1'234\n1;1;1'234\n", "without separators of thousands"),
            ("0 0 1\u{a0}234\n1 0 1\u{a0}234\n0 1 1\n1 1 2\n", "without separators of thousands"),
            ("0;0;1,5\n1;0;2.5\n0;1;1\n1;1;1\n", "one decimal sign"),
            ("0,0,1,5\n1,0,2,5\n0,1,1\n1,1,1,0\n", "separate the columns by semicolons"),
            ("X[ft],Y[ft],Z[ft]\n0,0,10\n1,0,11\n0,1,10\n", "by 0.3048"),
            ("x,y,z_km\n0,0,10\n1,0,11\n0,1,10\n", "by 1000"),
            ("x,y,depth\n0,0,10\n1,0,11\n0,1,10\n", "counts downwards"),
            ("easting;northing;depth_m\n0;0;10\n1;0;11\n0;1;10\n", "change the sign"),
            ("x,y,height,elevation\n0,0,10,9\n1,0,11,9\n0,1,10,9\n", "2 columns for z (height, elevation)"),
            ("x,y,easting,z\n0,0,10,9\n1,0,11,9\n0,1,10,9\n", "2 columns for x"),
            ("//X Y Z\n5\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n", "a count of 5 posts, and 4 posts after it"),
            ("3\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n", "a count of 3 posts, and 4 posts after it"),
            ("# x y z[ft]\n0 0 10\n1 0 11\n0 1 10\n", "by 0.3048"),
            ("lon,lat,elevation\n10,45,100\n10.1,45,100\n10,45.1,100\n", "longitude and latitude"),
            ("1 0 0 5\n2 0 1 5\n3 1 0 5\n4 1 1 5\n", "counts the lines"),
            ("0 0 100 250 7\n0 1 102 250 8\n1 0 100 252 9\n1 1 102 252 7\n", "a third and a fourth column"),
            ("0 0 1\n1 0 1\n2 0 1\n0 1 1\n1 1", "found 2 fields"),
            ("0 0 1\n1 0 1\n2 0 1\n0 1 1\n1 1 1", "5 posts read on a lattice of 6"),
            (
                "0 0 1.25\n1 0 1.25\n2 0 1.25\n0 1 1.25\n1 1 1.25\n2 1 1.25\n0 2 1.25\n1 2 1.25\n2 2 1.",
                "fewer digits in the last number",
            ),
        ] {
            assert!(begins_with_post(text.as_bytes()), "{text}");
            let found = message(text);
            assert!(found.contains(expected) && !found.contains("damaged"), "{text}: {found}");
        }
    }
}
