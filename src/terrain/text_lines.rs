//! Lines of text files: they end with a line feed, a carriage return, or both.

use std::io::{self, BufRead};

/// A text without its byte order mark.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// How a line ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineEnd {
    /// With a line end.
    Closed,
    /// With the end of the file.
    Open,
    /// Not before the longest length.
    TooLong,
    /// There was no further line.
    None,
}

/// Reads one line of up to `longest` bytes into `line`, without its end.
pub(super) fn read_line(source: &mut impl BufRead, longest: usize, line: &mut Vec<u8>) -> io::Result<LineEnd> {
    line.clear();
    let mut any = false;
    loop {
        let buffer = source.fill_buf()?;
        if buffer.is_empty() {
            return Ok(if any { LineEnd::Open } else { LineEnd::None });
        }
        any = true;
        let end = buffer.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let part = &buffer[..end.unwrap_or(buffer.len())];
        if line.len() + part.len() > longest {
            return Ok(LineEnd::TooLong);
        }
        line.extend_from_slice(part);
        let Some(end) = end else {
            let used = buffer.len();
            source.consume(used);
            continue;
        };
        let carriage_return = buffer[end] == b'\r';
        source.consume(end + 1);
        // The two bytes of one line end may stand in two buffers.
        if carriage_return && source.fill_buf()?.first() == Some(&b'\n') {
            source.consume(1);
        }
        return Ok(LineEnd::Closed);
    }
}

/// Lines of a text in memory, without their ends.
pub(super) fn lines_of(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = Some(bytes);
    std::iter::from_fn(move || {
        let text = rest?;
        let Some(end) = text.iter().position(|byte| matches!(byte, b'\n' | b'\r')) else {
            rest = None;
            return Some(text);
        };
        let both = text[end] == b'\r' && text.get(end + 1) == Some(&b'\n');
        rest = text.get(end + if both { 2 } else { 1 }..);
        text.get(..end)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_in_three_ways() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["one", "", "three", "4"].join(end);
            let whole: Vec<&[u8]> = lines_of(text.as_bytes()).collect();
            assert_eq!(whole, [&b"one"[..], b"", b"three", b"4"], "{end:?}");
            // Buffers of every size, so that a line end is cut in two.
            for size in 1..9 {
                let mut source = io::BufReader::with_capacity(size, text.as_bytes());
                let mut found = Vec::new();
                let mut line = Vec::new();
                loop {
                    match read_line(&mut source, 100, &mut line).unwrap() {
                        LineEnd::None => break,
                        ended => found.push((String::from_utf8(line.clone()).unwrap(), ended)),
                    }
                }
                let expected = [("one", LineEnd::Closed), ("", LineEnd::Closed), ("three", LineEnd::Closed), ("4", LineEnd::Open)];
                assert_eq!(found, expected.map(|(text, ended)| (text.to_owned(), ended)), "{end:?} {size}");
            }
        }
        let mut line = Vec::new();
        assert_eq!(read_line(&mut &b"123456\n"[..], 5, &mut line).unwrap(), LineEnd::TooLong);
        assert_eq!(read_line(&mut &b""[..], 5, &mut line).unwrap(), LineEnd::None);
    }
}
