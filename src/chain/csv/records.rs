//! Splits the text of a CSV file into records and fields with their positions.

use std::ops::Range;

use csv_core::{ReadFieldResult, Reader};

use super::{CsvProblem, columns::excerpt};

/// The longest line read. A full row takes some 500 bytes; a longer line is not part of a table, and every message would have
/// to search for its ends.
pub(super) const LINE_MAX_BYTES: usize = 1 << 16;

/// The longest excerpt of a line that a problem quotes, and how much of it may precede the field.
const WINDOW_BYTES: usize = 160;
const WINDOW_BEFORE_BYTES: usize = 60;

/// One record: its position and the positions of its fields.
#[derive(Clone, Debug, Default)]
pub(super) struct Record {
    /// Byte offset in the source.
    pub(super) offset: usize,
    /// Line of the file, from 1.
    pub(super) line: u64,
    /// Byte range of each field in the source, including quotes and blanks.
    pub(super) fields: Vec<Range<usize>>,
}

/// The text without its byte order mark, or the problem if it is not UTF-8.
pub(super) fn text_of(bytes: &[u8]) -> Result<&str, Box<CsvProblem>> {
    let refused = |at: usize, found: String, help: &str| {
        let before = bytes.get(..at).unwrap_or_default();
        let line = 1 + line_ends(before);
        let expected = "text in UTF-8".to_owned();
        let help = help.to_owned();
        Box::new(CsvProblem { line, column: None, name: None, text: String::new(), span: 0..0, found, expected, help })
    };
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(refused(0, "text in UTF-16".to_owned(), "save the file as CSV UTF-8"));
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            let at = error.valid_up_to();
            let byte = bytes.get(at).copied().unwrap_or_default();
            return Err(refused(
                at,
                format!("the byte 0x{byte:02x} at offset {at}, which is not UTF-8"),
                "save the file as CSV UTF-8, or check that it is a CSV file at all",
            ));
        }
    };
    if let Some(at) = bytes.iter().position(|&byte| byte == 0) {
        return Err(refused(at, format!("the byte 0x00 at offset {at}"), "check that it is a CSV file at all"));
    }
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// Line ends in some bytes: `\n`, `\r\n`, or `\r` alone.
fn line_ends(bytes: &[u8]) -> u64 {
    let mut before = 0;
    let mut count = 0;
    for &byte in bytes {
        count += u64::from(byte == b'\r' || (byte == b'\n' && before != b'\r'));
        before = byte;
    }
    count
}

fn is_line_end(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}

/// Reads the records of a text one by one; blank lines and lines that begin with `#` are skipped.
#[derive(Debug)]
pub(super) struct Records<'a> {
    source: &'a str,
    position: usize,
    line: u64,
    machine: Reader,
}

impl<'a> Records<'a> {
    pub(super) fn of(source: &'a str) -> Self {
        Self { source, position: 0, line: 1, machine: Reader::new() }
    }

    /// Starts at a record read before, to read it again.
    pub(super) fn again(source: &'a str, offset: usize, line: u64) -> Self {
        Self { source, position: offset, line, machine: Reader::new() }
    }

    /// Reads the next record into `record`; returns whether there was one.
    ///
    /// # Errors
    /// A line longer than [`LINE_MAX_BYTES`], and a quote that is not closed. The rest of the file cannot be read after
    /// either.
    pub(super) fn read(&mut self, record: &mut Record) -> Result<bool, Box<CsvProblem>> {
        self.skip_between();
        record.fields.clear();
        (record.offset, record.line) = (self.position, self.line);
        let rest = self.rest();
        if rest.is_empty() {
            return Ok(false);
        }
        if !rest.iter().take(LINE_MAX_BYTES + 1).any(|&byte| is_line_end(byte)) && rest.len() > LINE_MAX_BYTES {
            let place = self.position..self.position;
            let problem = Place::of(self.source, record, place);
            return Err(Box::new(problem.problem(
                format!("a line of more than {LINE_MAX_BYTES} bytes"),
                "a table with one vertex in each line",
                "check that it is a CSV file, with line ends",
            )));
        }
        loop {
            let (field, last) = self.field();
            let raw = self.source.get(field.clone()).unwrap_or_default();
            if raw.starts_with('"') && field.end == self.source.len() && raw.bytes().filter(|&byte| byte == b'"').count() % 2 == 1 {
                return Err(Box::new(Place::of(self.source, record, field.start..field.start + 1).problem(
                    "a quote that is never closed".to_owned(),
                    "a second quote at the field's end",
                    "close the quote, or remove it: numbers need none",
                )));
            }
            record.fields.push(field);
            if last {
                break;
            }
        }
        self.line += line_ends(self.source.as_bytes().get(record.offset..self.position).unwrap_or_default());
        Ok(true)
    }

    fn rest(&self) -> &'a [u8] {
        self.source.as_bytes().get(self.position..).unwrap_or_default()
    }

    /// Skips line ends and comments.
    fn skip_between(&mut self) {
        let start = self.position;
        // The previous record may have ended after the first half of "\r\n", which was counted as its
        // line end.
        let inside_line_end =
            start > 0 && self.source.as_bytes().get(start - 1) == Some(&b'\r') && self.rest().first() == Some(&b'\n');
        loop {
            match self.rest().first() {
                Some(&byte) if is_line_end(byte) => self.position += 1,
                Some(b'#') => {
                    let rest = self.rest();
                    self.position += rest.iter().position(|&byte| is_line_end(byte)).unwrap_or(rest.len());
                }
                _ => break,
            }
        }
        let skipped = self.source.as_bytes().get(start + usize::from(inside_line_end)..self.position).unwrap_or_default();
        self.line += line_ends(skipped);
    }

    /// The byte range of the next field, and whether it is the record's last.
    fn field(&mut self) -> (Range<usize>, bool) {
        let start = self.position;
        // Only the bounds are needed: the decoded text is discarded.
        let mut decoded = [0; 1024];
        loop {
            let rest = self.rest();
            let (result, taken, _) = self.machine.read_field(rest, &mut decoded);
            self.position += taken;
            match result {
                ReadFieldResult::Field { record_end } => {
                    // At the end of the text no delimiter was consumed.
                    let end = if rest.is_empty() { self.position } else { self.position - 1 };
                    return (start..end, record_end);
                }
                ReadFieldResult::End => return (start..self.position, true),
                ReadFieldResult::InputEmpty | ReadFieldResult::OutputFull => {}
            }
        }
    }
}

/// A field's text without surrounding blanks and quotes.
pub(super) fn plain(raw: &str) -> &str {
    let trimmed = raw.trim();
    trimmed.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(trimmed).trim()
}

/// A position in the file, for a message.
#[derive(Clone, Debug)]
pub(super) struct Place {
    line: u64,
    column: Option<u64>,
    name: Option<String>,
    text: String,
    span: Range<usize>,
}

impl Place {
    /// The position of some bytes of the source inside a record.
    pub(super) fn of(source: &str, record: &Record, bytes: Range<usize>) -> Self {
        let before = source.get(record.offset..bytes.start).unwrap_or_default();
        let line_start = record.offset + before.rfind(['\n', '\r']).map_or(0, |at| at + 1);
        let column = source.get(line_start..bytes.start).unwrap_or_default().chars().count() as u64 + 1;
        let (text, span) = window(source, line_start, bytes);
        Self { line: record.line + line_ends(before.as_bytes()), column: Some(column), name: None, text, span }
    }

    /// The position of a field, without surrounding blanks.
    pub(super) fn of_field(source: &str, record: &Record, index: usize) -> Self {
        let Some(field) = record.fields.get(index) else { return Self::of_line(source, record) };
        let raw = source.get(field.clone()).unwrap_or_default();
        let start = field.start + (raw.len() - raw.trim_start().len());
        let bytes = if raw.trim().is_empty() { field.start..field.start } else { start..start + raw.trim().len() };
        Self::of(source, record, bytes)
    }

    /// The whole line where a record begins.
    pub(super) fn of_line(source: &str, record: &Record) -> Self {
        let place = Self::of(source, record, record.offset..record.offset);
        let shown = place.text.len();
        Self { column: None, span: 0..shown, ..place }
    }

    /// The same position, with the name of its column.
    #[must_use]
    pub(super) fn named(self, name: &str) -> Self {
        Self { name: Some(excerpt(name)), ..self }
    }

    /// The problem found at this position.
    pub(super) fn problem(self, found: String, expected: impl Into<String>, help: impl Into<String>) -> CsvProblem {
        let Self { line, column, name, text, span } = self;
        CsvProblem { line, column, name, text, span, found, expected: expected.into(), help: help.into() }
    }
}

/// The line that begins at `line_start`, or an excerpt of it, and the range of `bytes` within it.
fn window(source: &str, line_start: usize, bytes: Range<usize>) -> (String, Range<usize>) {
    let all = source.as_bytes();
    let from = if bytes.start - line_start <= WINDOW_BEFORE_BYTES {
        line_start
    } else {
        char_start(source, bytes.start - WINDOW_BEFORE_BYTES)
    };
    let farthest = char_start(source, (from + WINDOW_BYTES).min(all.len()));
    let shown = all.get(bytes.start..farthest).unwrap_or_default();
    let line_end = shown.iter().position(|&byte| is_line_end(byte)).map(|at| bytes.start + at);
    let to = line_end.unwrap_or(farthest);
    let (cut_before, cut_after) = (from > line_start, line_end.is_none() && to < all.len());
    let before = if cut_before { "..." } else { "" };
    let after = if cut_after { "..." } else { "" };
    let text = format!("{before}{}{after}", source.get(from..to).unwrap_or_default());
    let within = |at: usize| at.clamp(from, to) - from + before.len();
    (text, within(bytes.start)..within(bytes.end))
}

/// The start of the character that contains byte `at`.
fn char_start(source: &str, at: usize) -> usize {
    (0..=at).rev().find(|&at| source.is_char_boundary(at)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(source: &str) -> Vec<(u64, Vec<&str>)> {
        let mut records = Records::of(source);
        let mut record = Record::default();
        let mut found = Vec::new();
        while records.read(&mut record).unwrap() {
            found.push((record.line, record.fields.iter().map(|field| plain(&source[field.clone()])).collect()));
        }
        found
    }

    #[test]
    fn records_have_the_right_lines_for_every_line_end() {
        for end in ["\n", "\r\n", "\r"] {
            let source = ["# note, \"with\" quote", "a,b", "", "1 , \"2\"", "#", "\"3", "\",4", "5,"].join(end);
            let expected = vec![(2, vec!["a", "b"]), (4, vec!["1", "2"]), (6, vec!["3", "4"]), (8, vec!["5", ""])];
            assert_eq!(all(&source), expected, "line end {end:?}");
            assert_eq!(all(&format!("{source}{end}")), expected, "line end {end:?}, closed");
        }
        assert_eq!(all(""), []);
        assert_eq!(all("\r\n#"), []);
    }

    #[test]
    fn the_csv_crate_splits_into_the_same_fields() {
        let source = "a,b,c\n1,\"x\"\"y, z\",\"\"\n\n\"p\nq\",,r";
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(source.as_bytes());
        let expected: Vec<Vec<String>> = reader.records().map(|r| r.unwrap().iter().map(str::to_owned).collect()).collect();
        let found: Vec<Vec<String>> =
            all(source).into_iter().map(|(_, fields)| fields.iter().map(|f| f.replace("\"\"", "\"")).collect()).collect();
        assert_eq!(found, [vec!["a", "b", "c"], vec!["1", "x\"y, z", ""], vec!["p\nq", "", "r"]]);
        assert_eq!(found, expected);
    }

    #[test]
    fn a_record_read_again_has_the_same_fields() {
        let source = "a,b\r\n1,2\r\n3,4";
        let mut records = Records::of(source);
        let mut record = Record::default();
        while records.read(&mut record).unwrap() {
            let mut again = Record::default();
            assert!(Records::again(source, record.offset, record.line).read(&mut again).unwrap());
            assert_eq!((again.line, &again.fields), (record.line, &record.fields));
        }
    }

    #[test]
    fn excerpts_contain_the_field_and_split_no_character() {
        // Each letter takes two bytes: a cut at an arbitrary byte would split one.
        let long = format!("{}FIELD{}", "\u{e4}".repeat(1001), "\u{f6}".repeat(999));
        let source = format!("first\n{long}\nlast");
        let record = Record { offset: 6, line: 2, fields: Vec::new() };
        let start = source.find("FIELD").unwrap();
        let place = Place::of(&source, &record, start..start + 5);
        assert_eq!(&place.text[place.span.clone()], "FIELD");
        assert_eq!((place.line, place.column), (2, Some(1002)));
        assert!(place.text.len() < 200 && place.text.starts_with("...") && place.text.ends_with("..."));
        let place = Place::of(&source, &record, 6..source.len() - 5);
        assert!(place.span.start == 0 && place.span.end <= place.text.len(), "a field longer than the window is cut with it");
    }
}
