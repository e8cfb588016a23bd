//! The lines of an XYZ text.

use std::io::{self, BufRead, Read};

use crate::terrain::ascii_grid::Problems;
use crate::terrain::stored::Decimals;

/// The longest line accepted.
const LONGEST_LINE: u64 = 4096;

const X_NAMES: [&str; 6] = ["x", "x_m", "east", "easting", "easting_m", "x_coord"];
const Y_NAMES: [&str; 6] = ["y", "y_m", "north", "northing", "northing_m", "y_coord"];
const Z_NAMES: [&str; 9] = ["z", "z_m", "elevation", "elevation_m", "height", "height_m", "altitude", "elev", "topography"];

/// One post of the text; z is NaN for a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) line: usize,
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) z: f64,
}

/// The columns of the three numbers, and the number of columns.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Columns {
    x: usize,
    y: usize,
    z: usize,
    count: usize,
}

const PLAIN: Columns = Columns { x: 0, y: 1, z: 2, count: 3 };

/// Fields of a line: separated by semicolons if there are any, else by commas, else by white space.
fn fields(line: &str) -> Vec<&str> {
    let separator = [';', ','].into_iter().find(|separator| line.contains(*separator));
    match separator {
        Some(separator) => line.split(separator).map(|field| field.trim().trim_matches('"')).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// Whether a line is empty or a comment.
fn is_blank(line: &str) -> bool {
    line.trim().is_empty() || line.trim_start().starts_with('#')
}

/// The columns named by a header, or the default columns of a line of three numbers, and whether the line is a header.
fn columns(line: &str) -> Option<(Columns, bool)> {
    let fields = fields(line.trim_start_matches('\u{feff}'));
    let find = |names: &[&str]| fields.iter().position(|field| names.iter().any(|name| field.eq_ignore_ascii_case(name)));
    if let (Some(x), Some(y), Some(z)) = (find(&X_NAMES), find(&Y_NAMES), find(&Z_NAMES)) {
        return Some((Columns { x, y, z, count: fields.len() }, true));
    }
    let numbers = fields.len() == 3 && fields.iter().all(|field| field.parse::<f64>().is_ok());
    numbers.then_some((PLAIN, false))
}

/// Whether a text begins with a header of x, y and z or with a line of three numbers.
pub(super) fn begins_with_post(beginning: &[u8]) -> bool {
    let text = String::from_utf8_lossy(beginning);
    text.lines().find(|line| !is_blank(line)).is_some_and(|line| columns(line).is_some())
}

/// Reads all posts; problems are added to `problems`.
pub(super) fn read_rows(mut source: impl BufRead, problems: &mut Problems) -> io::Result<(Vec<Row>, Decimals)> {
    let (mut rows, mut decimals) = (Vec::new(), Decimals::default());
    let mut layout: Option<Columns> = None;
    let mut bytes = Vec::new();
    let mut line = 0;
    loop {
        bytes.clear();
        line += 1;
        if source.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes)? == 0 {
            return Ok((rows, decimals));
        }
        if !bytes.ends_with(b"\n") && bytes.len() as u64 == LONGEST_LINE {
            problems.add_at((line, 1), "a line of over 4096 bytes", "x, y and z of one post");
            return Ok((rows, decimals));
        }
        let text = String::from_utf8_lossy(&bytes);
        if is_blank(&text) {
            continue;
        }
        let (columns, header) = layout.map_or_else(|| columns(&text).unwrap_or((PLAIN, false)), |known| (known, false));
        layout = Some(columns);
        if header {
            continue;
        }
        rows.extend(row(&text, line, columns, problems, &mut decimals));
        // If the first lines have many problems, the text is not an XYZ grid.
        if rows.is_empty() && problems.are_many() {
            return Ok((rows, decimals));
        }
    }
}

fn row(text: &str, line: usize, columns: Columns, problems: &mut Problems, decimals: &mut Decimals) -> Option<Row> {
    let fields = fields(text);
    if fields.len() != columns.count {
        let mend = if text.contains(';') && text.contains(',') { " (replace decimal commas by points)" } else { "" };
        problems.add_at((line, 1), &format!("{} fields", fields.len()), &format!("{}{mend}", columns.count));
        return None;
    }
    let before = problems.count();
    let mut number = |name: &str, index: usize| {
        let field = fields[index];
        let value = field.parse::<f64>().ok().filter(|value| value.is_finite() || (name == "z" && value.is_nan()));
        if value.is_none() {
            let shown: String = field.chars().take(40).flat_map(char::escape_debug).collect();
            let expected = match (name, field.contains(',')) {
                (_, true) => "a finite number with a decimal point (replace decimal commas by points)",
                ("z", _) => "a finite number, or nan where there is no elevation",
                _ => "a finite number",
            };
            problems.add_at((line, 1), &format!("{name} '{shown}'"), expected);
        }
        value
    };
    let (x, y, z) = (number("x", columns.x), number("y", columns.y), number("z", columns.z));
    let z = z.unwrap_or(f64::NAN);
    decimals.see(fields[columns.z]);
    if problems.count() > before { None } else { Some(Row { line, x: x?, y: y?, z }) }
}
