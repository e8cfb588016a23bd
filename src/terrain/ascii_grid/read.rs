//! Reads an ASCII grid.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::header::{DEFAULT_NO_DATA, Header, begins_with_key, number_hint, quoted, read_header};
use super::tokens::{Token, Tokens};
use crate::quantity::MapPoint;
use crate::terrain::dem::Posts;
use crate::terrain::format::ReadContext;
use crate::terrain::stored::{LastDigits, Scaling, StoredRaster, StoredStep};
use crate::terrain::{AsciiProblem, Dem, DemReader, GeoReference, NoData, NoDataRule, TerrainError};

/// At most this many problems are listed; the others are counted.
const LISTED_PROBLEMS: usize = 20;

/// Number of posts to reserve memory for before reading: a header that promises more must be followed by the data first.
const FIRST_RESERVE: usize = 1 << 20;

/// The reader of the ESRI ASCII grid format.
pub(in crate::terrain) struct AsciiGridReader;

impl DemReader for AsciiGridReader {
    fn name(&self) -> &'static str {
        "ESRI ASCII grid"
    }

    fn recognises(&self, beginning: &[u8]) -> bool {
        begins_with_key(beginning)
    }

    fn read_bytes(&self, bytes: Vec<u8>, context: &ReadContext) -> Result<Dem, TerrainError> {
        read_text(&bytes[..], bytes.len() as u64, context)
    }

    fn read_path(&self, path: &Path, context: &ReadContext) -> Result<Dem, TerrainError> {
        let file = File::open(path).map_err(TerrainError::reading)?;
        let length = file.metadata().map_err(TerrainError::reading)?.len();
        read_text(BufReader::new(file), length, context)
    }
}

/// Reads an ESRI ASCII grid from memory.
///
/// Accepts keys in any case and order, corner or centre coordinates, `cellsize` or `dx` and `dy`, and any distribution of the
/// values over lines. Without `NODATA_value` the no-data value is -9999, as the format defines.
///
/// # Errors
/// [`TerrainError::AsciiGrid`] with every problem found, each with its line and column; [`TerrainError::InvalidDem`] if the
/// numbers do not form a raster; [`TerrainError::Unsuitable`] if the coordinates look like degrees.
///
/// # Examples
/// ```
/// let text = b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2\n3 -9999\n";
/// let dem = chta::terrain::read_ascii_grid_bytes(text)?;
/// assert_eq!(dem.georeference().north_west(), chta::quantity::MapPoint::new(5.0, 15.0));
/// assert_eq!((dem.elevation(0, 1), dem.elevation(1, 1)), (Some(2.0), None));
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn read_ascii_grid_bytes(bytes: &[u8]) -> Result<Dem, TerrainError> {
    read_text(bytes, bytes.len() as u64, &ReadContext::default())
}

fn read_text(source: impl BufRead, length: u64, context: &ReadContext) -> Result<Dem, TerrainError> {
    let mut problems = Problems::default();
    let mut tokens = Tokens::new(source);
    let header = read_header(&mut tokens, &mut problems).map_err(TerrainError::reading)?;
    let Some(header) = header else { return Err(problems.into_error()) };
    let posts = check_size(&header, length, &tokens, &mut problems);
    let Some(posts) = posts else { return Err(problems.into_error()) };
    let no_data = context.sidecars.no_data(context.no_data, header.no_data)?;
    // The format defines -9999 where nothing states another value, and the user does not either.
    let no_data = match context.no_data {
        NoDataRule::AsStated => no_data.or(Some(DEFAULT_NO_DATA.into())),
        NoDataRule::Nothing | NoDataRule::Value(_) => no_data,
    };
    let scaling = context.sidecars.scaling(None)?;
    let elevations = Elevations { header: &header, posts, no_data, scaling };
    let (posts, decimals) = elevations.read(&mut tokens, &mut problems).map_err(TerrainError::reading)?;
    if problems.count() > 0 {
        return Err(problems.into_error());
    }
    // The file gives the southernmost row, a `Dem` the northernmost one.
    #[expect(clippy::cast_precision_loss, reason = "rows stay far below 2^53: each takes two bytes of the file")]
    let north = header.south_west[1] + (header.rows - 1) as f64 * header.dy_m;
    let georeference = GeoReference::local(MapPoint::new(header.south_west[0], north), header.dx_m, header.dy_m)?;
    StoredRaster {
        rows: header.rows,
        cols: header.cols,
        posts: Posts::Double(posts),
        georeference,
        states_metres: false,
        south_up: false,
        scaling,
        step: StoredStep::of_text(decimals, scaling),
    }
    .finish(context)
}

/// A post takes at least a digit and a space, so a header that promises more than the file can hold is refused before memory
/// is allocated.
fn check_size<R: BufRead>(header: &Header, length: u64, tokens: &Tokens<R>, problems: &mut Problems) -> Option<usize> {
    let most = usize::try_from(length / 2 + 1).unwrap_or(usize::MAX);
    let posts = header.rows.checked_mul(header.cols).filter(|posts| *posts <= most);
    if posts.is_none() {
        problems.add_at(
            tokens.place(),
            &format!("{length} bytes of file for nrows {} times ncols {}", header.rows, header.cols),
            "two bytes per post at least; the file is cut short or its header wrong",
        );
    }
    posts
}

/// How the words after the header become elevations.
struct Elevations<'a> {
    header: &'a Header,
    posts: usize,
    no_data: Option<NoData>,
    scaling: Scaling,
}

impl Elevations<'_> {
    /// All elevations, and the most decimals that one of them has.
    fn read<R: BufRead>(&self, tokens: &mut Tokens<R>, problems: &mut Problems) -> std::io::Result<(Vec<f64>, LastDigits)> {
        let Self { header, posts, no_data, scaling } = *self;
        let mut decimals = LastDigits::default();
        let mut elevations = Vec::with_capacity(posts.min(FIRST_RESERVE));
        let mut surplus = 0_usize;
        let mut first_surplus = None;
        while let Some(token) = tokens.next()? {
            if elevations.len() == posts {
                surplus += 1;
                first_surplus.get_or_insert(token);
                continue;
            }
            let value = parse_elevation(&token, no_data, scaling);
            if value.is_some_and(|value| !value.is_nan()) {
                decimals.see(&token.text);
            }
            if value.is_none() {
                let (row, col) = (elevations.len() / header.cols + 1, elevations.len() % header.cols + 1);
                let expected =
                    format!("{} for row {row} of {}, column {col} of {}", number_hint(&token.text), header.rows, header.cols);
                problems.add(&token, &quoted(&token.text), &expected);
            }
            elevations.push(value.unwrap_or(f64::NAN));
        }
        if let Some(token) = first_surplus {
            problems.add(
                &token,
                &format!("{surplus} values too many"),
                &format!("{posts} (nrows {} times ncols {}); mend the header or remove them", header.rows, header.cols),
            );
        }
        if elevations.len() < posts {
            problems.add_at(
                tokens.place(),
                &format!("the end of the file after {} values", elevations.len()),
                &format!("{posts} (nrows {} times ncols {}); the file is cut short or its header wrong", header.rows, header.cols),
            );
        }
        Ok((elevations, decimals))
    }
}

/// NaN for no-data, `None` for an invalid elevation.
fn parse_elevation(token: &Token, no_data: Option<NoData>, scaling: Scaling) -> Option<f64> {
    let value = token.text.parse::<f64>().ok()?;
    if value.is_nan() || no_data.is_some_and(|mark| mark.is_double(value)) {
        return Some(f64::NAN);
    }
    value.is_finite().then(|| if scaling == Scaling::NONE { value } else { scaling.apply(value) })
}

/// Problems in the order in which they are found.
#[derive(Debug, Default)]
pub(in crate::terrain) struct Problems {
    listed: Vec<AsciiProblem>,
    further: usize,
}

impl Problems {
    pub(in crate::terrain::ascii_grid) fn add(&mut self, token: &Token, found: &str, expected: &str) {
        self.add_at((token.line, token.column), found, expected);
    }

    pub(in crate::terrain) fn add_at(&mut self, (line, column): (usize, usize), found: &str, expected: &str) {
        if self.are_many() {
            self.further += 1;
        } else {
            self.listed.push(AsciiProblem { line, column, found: found.to_owned(), expected: expected.to_owned() });
        }
    }

    pub(in crate::terrain) fn are_many(&self) -> bool {
        self.listed.len() >= LISTED_PROBLEMS
    }

    pub(in crate::terrain) fn count(&self) -> usize {
        self.listed.len() + self.further
    }

    pub(in crate::terrain) fn into_error(self) -> TerrainError {
        TerrainError::AsciiGrid { problems: self.listed, further: self.further }
    }
}

#[cfg(test)]
mod tests;
