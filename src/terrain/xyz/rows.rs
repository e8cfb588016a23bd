//! The lines of an XYZ text.

use std::io::BufRead;

use super::header::{Columns, Header, Separator, comment, fields, header, separator_of, stated_count};
use crate::quantity::{decimal_comma, excerpt, number_help};
use crate::terrain::ascii_grid::Problems;
use crate::terrain::stored::LastDigits;
use crate::terrain::text_lines::{LineEnd, read_line};
use crate::terrain::{CoordinateSystem, TerrainError, georeference::mend_degrees};

/// The longest line accepted.
const LONGEST_LINE: usize = 4096;

/// One post of the text; z is NaN for a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) line: usize,
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) z: f64,
}

/// The posts of a text.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) posts: Vec<Row>,
    /// Whether there are columns beyond the three that no header names.
    pub(super) further: bool,
    /// The numbers of a fourth column, if there are five or more and no header names them: with it, a text that begins with
    /// the indices of row and column is recognised.
    pub(super) fourth: Vec<f64>,
    /// Whether the file ends in the middle of a line, as one does that was cut short.
    pub(super) open: bool,
    /// Whether the last post has fewer digits after the point than all others, which have equally many.
    pub(super) short_last: bool,
    /// The most decimals of the elevations.
    pub(super) decimals: LastDigits,
}

/// The decimal signs of a text, each with the first line that has it.
#[derive(Debug, Default)]
struct DecimalSigns {
    point: Option<usize>,
    comma: Option<(usize, String)>,
    /// Whether some comma cannot separate thousands.
    certain: bool,
}

/// Reads all posts; problems of lines are added to `problems`.
///
/// # Errors
/// The source cannot be read, or its header names longitude and latitude.
pub(super) fn read_rows(mut source: impl BufRead, problems: &mut Problems) -> Result<Rows, TerrainError> {
    let mut rows = Rows::default();
    let mut signs = DecimalSigns::default();
    let mut named: Option<Columns> = None;
    let mut layout: Option<(Columns, Separator)> = None;
    let mut digits = Digits::default();
    let mut stated: Option<(usize, usize)> = None;
    let mut bytes = Vec::new();
    let mut line = 0;
    loop {
        line += 1;
        match read_line(&mut source, LONGEST_LINE, &mut bytes).map_err(TerrainError::reading)? {
            LineEnd::Closed => rows.open = false,
            LineEnd::Open => rows.open = true,
            LineEnd::TooLong => {
                problems.add_at((line, 1), "a line of over 4096 bytes", "x, y and z of one post");
                return Ok(rows);
            }
            LineEnd::None => break,
        }
        let text = String::from_utf8_lossy(&bytes);
        let text = if line == 1 { text.trim_start_matches('\u{feff}') } else { &text };
        let comment = comment(text);
        if text.trim().is_empty() || (comment.is_some() && layout.is_some()) {
            continue;
        }
        if layout.is_none() {
            match header(comment.unwrap_or(text)) {
                Some(Header::Columns(columns)) => named = Some(columns),
                Some(Header::Degrees(found)) => {
                    return Err(TerrainError::NotProjected {
                        found: format!("{found} of longitude and latitude, in line {line}"),
                        mend: mend_degrees(&CoordinateSystem::default()),
                    });
                }
                Some(Header::OtherUnit(found, expected)) => {
                    problems.add_at((line, 1), &found, &expected);
                    return Ok(rows);
                }
                None if comment.is_some() => {}
                None => {
                    let separator = separator_of(text);
                    let fields = fields(text, separator);
                    if let (None, Some(count)) = (stated, stated_count(&fields)) {
                        stated = Some((line, count));
                        continue;
                    }
                    let count = fields.len();
                    let columns = named.clone().unwrap_or(Columns { x: 0, y: 1, z: 2, count: count.max(3), named: false });
                    rows.further = !columns.named && columns.count > 3;
                    layout = Some((columns, separator));
                }
            }
        }
        let Some((columns, separator)) = &layout else { continue };
        let before = rows.posts.len();
        row(text, line, columns, *separator, &mut rows, &mut signs, &mut digits, problems);
        // If the first lines have many problems, the text is not an XYZ grid.
        if before == 0 && rows.posts.is_empty() && problems.are_many() {
            return Ok(rows);
        }
    }
    signs.check(problems);
    if let Some((line, count)) = stated.filter(|(_, count)| problems.count() == 0 && *count != rows.posts.len()) {
        let found = format!("a count of {count} posts, and {} posts after it", rows.posts.len());
        problems.add_at((line, 1), &found, "equally many; if the file was cut short, copy it again, else correct the count");
    }
    rows.short_last = rows.open && digits.last_is_short();
    Ok(rows)
}

#[expect(clippy::too_many_arguments, reason = "the state of one loop, in a function of its own for its length")]
fn row(
    text: &str,
    line: usize,
    columns: &Columns,
    separator: Separator,
    rows: &mut Rows,
    signs: &mut DecimalSigns,
    digits: &mut Digits,
    problems: &mut Problems,
) {
    let mut fields = fields(text, separator);
    while fields.len() > columns.count && fields.last().is_some_and(|field| field.is_empty()) {
        fields.pop();
    }
    // Blanks may separate the words of a text in a further column.
    let needed = columns.x.max(columns.y).max(columns.z) + 1;
    let fits = if separator == Separator::Blank { fields.len() >= needed } else { fields.len() == columns.count };
    if !fits {
        let mend = if separator == Separator::Comma { " (with decimal commas, separate the columns by semicolons)" } else { "" };
        problems.add_at((line, 1), &format!("{} fields", fields.len()), &format!("{}{mend}", columns.count));
        return;
    }
    let before = problems.count();
    let mut number = |name: &str, index: usize| {
        let field = fields[index];
        let value = signs.number(field, line).filter(|value| value.is_finite() || (name == "z" && value.is_nan()));
        if value.is_none() {
            let expected = match (name, field.parse::<f64>().is_ok() || !field.contains(|c: char| c.is_ascii_digit())) {
                ("z", true) => "a finite number, or nan where there is no elevation".to_owned(),
                (_, true) => "a finite number".to_owned(),
                _ => format!("a finite number; {}", number_help(field)),
            };
            problems.add_at((line, 1), &format!("{name} '{}'", excerpt(field, 40)), &expected);
        }
        value
    };
    let (x, y, z) = (number("x", columns.x), number("y", columns.y), number("z", columns.z));
    let z = z.unwrap_or(f64::NAN);
    if problems.count() > before {
        return;
    }
    if let (Some(x), Some(y)) = (x, y) {
        digits.see(fields[columns.z]);
        rows.decimals.see(fields[columns.z]);
        // A column that has ever been something else than a number stays out of the comparison.
        if !columns.named && columns.count >= 5 && rows.fourth.len() == rows.posts.len() {
            rows.fourth.extend(fields.get(3).and_then(|field| signs.number(field, line)));
        }
        rows.posts.push(Row { line, x, y, z });
    }
}

impl DecimalSigns {
    /// The number of a field, with a point or a comma as the decimal sign.
    fn number(&mut self, field: &str, line: usize) -> Option<f64> {
        if let Ok(value) = field.parse::<f64>() {
            if self.point.is_none() && field.contains('.') {
                self.point = Some(line);
            }
            return Some(value);
        }
        let comma = decimal_comma(field)?;
        self.certain |= comma.certain;
        if self.comma.is_none() {
            self.comma = Some((line, field.to_owned()));
        }
        Some(comma.value)
    }

    /// Decimal commas are read if they cannot mean anything else.
    fn check(&self, problems: &mut Problems) {
        let Some((line, field)) = &self.comma else { return };
        let shown = excerpt(field, 40);
        if let Some(point) = self.point {
            let found = format!("'{shown}' with a comma, where line {point} has a number with a point");
            problems.add_at((*line, 1), &found, "one decimal sign in all numbers, and no separators of thousands");
        } else if !self.certain {
            problems.add_at((*line, 1), &format!("'{shown}'"), &format!("a finite number; {}", number_help(field)));
        }
    }
}

/// How many digits after the decimal sign the elevations have.
#[derive(Debug, Default)]
struct Digits {
    /// That of all elevations but the last, if they agree.
    others: Option<usize>,
    last: Option<usize>,
    differ: bool,
    count: usize,
}

/// From this many elevations on, an equal number of digits is a format and no chance.
const FORMAT_SHOWS: usize = 8;

impl Digits {
    fn see(&mut self, field: &str) {
        if self.differ {
            return;
        }
        let decimals = field.rfind(['.', ',']).map_or(0, |at| field.len() - at - 1);
        if let Some(before) = self.last {
            self.differ = self.others.is_some_and(|others| others != before);
            self.others = Some(before);
        }
        self.last = Some(decimals);
        self.count += 1;
    }

    fn last_is_short(&self) -> bool {
        !self.differ && self.count > FORMAT_SHOWS && self.others > self.last
    }
}
