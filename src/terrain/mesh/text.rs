//! Lines and numbers of the text formats.

use crate::quantity::number_help;
use crate::terrain::TerrainError;
use crate::terrain::text_lines::lines_of;

/// A problem in a line of a mesh's text.
pub(super) fn in_line(format: &'static str, line: usize, problem: &str) -> TerrainError {
    TerrainError::MeshText { format, line, problem: problem.to_owned() }
}

/// Lines with their numbers from 1, whatever ends them. Bytes that are not UTF-8, which occur in comments and names, are replaced.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, str>)> {
    lines_of(bytes).enumerate().map(|(index, line)| (index + 1, String::from_utf8_lossy(line.trim_ascii())))
}

/// A word of the file for a message.
pub(super) fn shown(word: &str) -> String {
    word.chars().take(40).flat_map(char::escape_default).collect()
}

/// Three numbers from the words of a line.
pub(super) fn three<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<[f64; 3], String> {
    let mut numbers = [0.0; 3];
    for number in &mut numbers {
        let word = words.next().ok_or_else(|| "the line ends, expected three numbers".to_owned())?;
        *number = word.parse().map_err(|_| format!("found '{}', expected a number; {}", shown(word), number_help(word)))?;
    }
    Ok(numbers)
}
