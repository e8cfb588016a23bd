//! The header of an ASCII grid.

use std::collections::BTreeMap;
use std::io::{self, BufRead};

use super::read::Problems;
use super::tokens::{Token, Tokens, begins_comment};
use crate::quantity::number_help;
use crate::terrain::text_lines::lines_of;
use crate::terrain::{NoData, without_mark};

/// The no-data value if the header gives none (from the definition of the format).
pub(super) const DEFAULT_NO_DATA: f64 = -9999.0;

/// Some editors write a byte order mark before the first key.
const BYTE_ORDER_MARK: char = '\u{feff}';

const KEYS: [&str; 10] =
    ["ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "dx", "dy", "nodata_value"];

/// Other spellings of keys.
const ALIASES: [(&str, &str); 5] = [
    ("xllcentre", "xllcenter"),
    ("yllcentre", "yllcenter"),
    ("nodata", "nodata_value"),
    ("no_data", "nodata_value"),
    ("no_data_value", "nodata_value"),
];

/// The key that a word spells, in any case.
fn key_of(word: &str) -> Option<&'static str> {
    let lower = word.to_ascii_lowercase();
    let alias = ALIASES.iter().find(|(spelling, _)| *spelling == lower).map(|(_, key)| *key);
    alias.or_else(|| KEYS.into_iter().find(|known| *known == lower))
}

/// A validated header.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header {
    pub(super) rows: usize,
    pub(super) cols: usize,
    /// Centre of the south-west post, m.
    pub(super) south_west: [f64; 2],
    pub(super) dx_m: f64,
    pub(super) dy_m: f64,
    /// `NODATA_value`, if given.
    pub(super) no_data: Option<NoData>,
}

type Fields = BTreeMap<&'static str, Token>;

/// Reads pairs of key and value up to the first number in place of a key, then validates them together. `None` means that
/// `problems` has the reasons.
pub(super) fn read_header<R: BufRead>(tokens: &mut Tokens<R>, problems: &mut Problems) -> io::Result<Option<Header>> {
    let mut fields = Fields::new();
    while let Some(token) = tokens.peek()? {
        if looks_like_number(&token.text) {
            break;
        }
        let Some(key) = tokens.next()? else { break };
        let word = key.text.trim_start_matches(BYTE_ORDER_MARK);
        let Some(known) = key_of(word) else {
            let joined = word.split_once(['=', ':', ',', ';']).filter(|(before, _)| key_of(before).is_some());
            let expected = match joined {
                Some((before, _)) => format!("{before} and its number with blanks between them, and no other sign"),
                None => format!("one of {}", KEYS.join(", ")),
            };
            problems.add(&key, &format!("the header key {}", quoted(&key.text)), &expected);
            // A text of unknown words is not a grid; it stops after the first twenty.
            if problems.are_many() {
                return Ok(None);
            }
            if tokens.peek()?.is_some_and(|value| looks_like_number(&value.text)) {
                tokens.next()?;
            }
            continue;
        };
        let Some(value) = tokens.next()? else {
            problems.add(&key, &format!("{known} without a value"), "a number after it");
            break;
        };
        if let Some(first) = fields.insert(known, value) {
            problems.add(&key, &format!("{known} a second time"), &format!("it once (first on line {})", first.line));
        }
    }
    let place = tokens.place();
    Ok(check_header(&fields, place, problems))
}

fn check_header(fields: &Fields, place: (usize, usize), problems: &mut Problems) -> Option<Header> {
    let before = problems.count();
    let cols = count(fields, "ncols", place, problems);
    let rows = count(fields, "nrows", place, problems);
    let (dx_m, dy_m) = spacings(fields, place, problems);
    let x = corner_or_centre(fields, "xllcorner", "xllcenter", dx_m, place, problems);
    let y = corner_or_centre(fields, "yllcorner", "yllcenter", dy_m, place, problems);
    let no_data = match fields.get("nodata_value") {
        None => None,
        Some(token) => {
            let value = token.text.parse::<NoData>().ok();
            if value.is_none() {
                problems.add(token, &format!("nodata_value {}", quoted(&token.text)), &number_hint(&token.text));
            }
            value
        }
    };
    if problems.count() > before {
        return None;
    }
    Some(Header { rows: rows?, cols: cols?, south_west: [x?, y?], dx_m: dx_m?, dy_m: dy_m?, no_data })
}

/// `cellsize`, or `dx` and `dy`.
fn spacings(fields: &Fields, place: (usize, usize), problems: &mut Problems) -> (Option<f64>, Option<f64>) {
    let pair = fields.contains_key("dx") || fields.contains_key("dy");
    if let (true, Some(cellsize)) = (pair, fields.get("cellsize")) {
        problems.add(cellsize, "cellsize beside dx or dy", "either cellsize, or dx and dy");
        return (None, None);
    }
    if pair {
        (spacing(fields, "dx", place, problems), spacing(fields, "dy", place, problems))
    } else {
        let size = spacing(fields, "cellsize", place, problems);
        (size, size)
    }
}

fn spacing(fields: &Fields, key: &'static str, place: (usize, usize), problems: &mut Problems) -> Option<f64> {
    let value = number(fields, key, place, problems)?;
    if value > 0.0 {
        return Some(value);
    }
    problems.add(fields.get(key)?, &format!("{key} {value}"), "a post spacing above 0 m");
    None
}

/// The coordinate of the south-west post's centre: a corner lies half a spacing outside it.
fn corner_or_centre(
    fields: &Fields,
    corner: &'static str,
    centre: &'static str,
    spacing_m: Option<f64>,
    place: (usize, usize),
    problems: &mut Problems,
) -> Option<f64> {
    match (fields.get(corner), fields.get(centre)) {
        (Some(_), None) => Some(number(fields, corner, place, problems)? + 0.5 * spacing_m?),
        (None, Some(_)) => number(fields, centre, place, problems),
        (Some(_), Some(both)) => {
            problems.add(both, &format!("{corner} and {centre}"), "one of the two");
            None
        }
        (None, None) => {
            problems.add_at(place, &format!("no {corner} and no {centre} in the header"), "one of the two, in m");
            None
        }
    }
}

fn count(fields: &Fields, key: &'static str, place: (usize, usize), problems: &mut Problems) -> Option<usize> {
    let Some(token) = fields.get(key) else {
        problems.add_at(place, &format!("no {key} in the header"), "a whole number of at least 2");
        return None;
    };
    let value = token.text.parse::<usize>().ok().filter(|count| *count >= 2);
    if value.is_none() {
        problems.add(token, &format!("{key} {}", quoted(&token.text)), "a whole number of at least 2");
    }
    value
}

fn number(fields: &Fields, key: &'static str, place: (usize, usize), problems: &mut Problems) -> Option<f64> {
    let Some(token) = fields.get(key) else {
        problems.add_at(place, &format!("no {key} in the header"), "it with a number, in m");
        return None;
    };
    let value = token.text.parse::<f64>().ok().filter(|value| value.is_finite());
    if value.is_none() {
        problems.add(token, &format!("{key} {}", quoted(&token.text)), &number_hint(&token.text));
    }
    value
}

/// The expectation to print for a word that is not a number.
pub(super) fn number_hint(text: &str) -> String {
    if text.parse::<f64>().is_ok() || !text.contains(|c: char| c.is_ascii_digit()) {
        return "a finite number".to_owned();
    }
    format!("a finite number ({})", number_help(text))
}

/// Words that begin like a number end the header, so that `1,5` is reported as a malformed number.
fn looks_like_number(text: &str) -> bool {
    let lower = text.to_ascii_lowercase();
    text.starts_with(|first: char| first.is_ascii_digit() || matches!(first, '-' | '+' | '.'))
        || lower.starts_with("nan")
        || lower.starts_with("inf")
}

/// The beginning of a word, in printable characters and quotes.
pub(super) fn quoted(text: &str) -> String {
    format!("'{}'", crate::quantity::excerpt(text, 40))
}

/// Whether a text begins with a key of the header, after comments; any sign may follow the key, so that the reader can name a
/// wrong one.
pub(super) fn begins_with_key(beginning: &[u8]) -> bool {
    let beginning = without_mark(beginning);
    let mut lines = lines_of(beginning).map(<[u8]>::trim_ascii_start).filter(|line| !line.is_empty());
    lines.find(|line| !begins_comment(line)).is_some_and(|line| {
        let end = line.iter().position(|byte| !byte.is_ascii_alphanumeric() && *byte != b'_').unwrap_or(line.len());
        std::str::from_utf8(&line[..end]).is_ok_and(|word| key_of(word).is_some())
    })
}
