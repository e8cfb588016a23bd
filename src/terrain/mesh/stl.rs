//! STL, binary and text. The normals in the file are ignored: they follow from the corners.

use super::build::MeshBuilder;
use super::text::{in_line, lines, shown, three};
use crate::terrain::TerrainError;

pub(super) const BINARY: &str = "binary STL";
pub(super) const ASCII: &str = "ASCII STL";

/// The title, then the number of triangles.
pub(super) const HEADER_BYTES: usize = 84;
/// A normal and three corners in 32-bit floats, and two unused bytes.
pub(super) const TRIANGLE_BYTES: u64 = 50;

/// The length of a binary STL with this header, bytes; `None` if the header is cut short.
pub(super) fn binary_length(header: &[u8]) -> Option<u64> {
    let count = header.get(80..HEADER_BYTES)?.try_into().ok().map(u32::from_le_bytes)?;
    Some(HEADER_BYTES as u64 + TRIANGLE_BYTES * u64::from(count))
}

/// Whether a file with this beginning and length is a binary STL: its number of triangles and its length agree, or bytes follow
/// the last triangle and what comes before them looks like triangles. (In a text, bytes 80 to 83 would count over a hundred
/// million triangles.)
pub(super) fn recognises_binary(beginning: &[u8], length: u64) -> bool {
    match binary_length(beginning) {
        Some(stated) if stated == length => true,
        Some(stated) => HEADER_BYTES as u64 + TRIANGLE_BYTES <= stated && stated < length && holds_triangles(beginning),
        None => false,
    }
}

/// Whether the numbers after the header can be coordinates, and some triangle has an area.
fn holds_triangles(beginning: &[u8]) -> bool {
    let count = binary_length(beginning).map_or(0, |length| (length - HEADER_BYTES as u64) / TRIANGLE_BYTES);
    let triangles = beginning.get(HEADER_BYTES..).unwrap_or_default().chunks_exact(50);
    let mut with_area = false;
    for triangle in triangles.take(usize::try_from(count).unwrap_or(usize::MAX)) {
        let numbers: Vec<f32> =
            triangle.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]])).collect();
        if !numbers.iter().all(|number| *number == 0.0 || (1.0e-12..1.0e12).contains(&number.abs())) {
            return false;
        }
        let corner = |at: usize| (numbers[at], numbers[at + 1], numbers[at + 2]);
        with_area |= corner(3) != corner(6) && corner(6) != corner(9) && corner(9) != corner(3);
    }
    with_area
}

/// Whether a file is a binary STL that calls itself `solid`, as texts do.
pub(super) fn is_titled_like_text(beginning: &[u8]) -> bool {
    beginning.get(..5).is_some_and(|title| title.eq_ignore_ascii_case(b"solid")) && beginning.contains(&0)
}

/// Whether a text begins like an STL.
pub(super) fn recognises_ascii(beginning: &[u8]) -> bool {
    if beginning.contains(&0) {
        return false;
    }
    let mut lines = lines(beginning).filter(|(_, line)| !line.is_empty());
    let title = lines.next().is_some_and(|(_, line)| is_word(&line, "solid"));
    title && lines.next().is_none_or(|(_, line)| is_word(&line, "facet") || is_word(&line, "endsolid"))
}

/// Whether the first word of a line is this one, in either case.
fn is_word(line: &str, word: &str) -> bool {
    line.split_ascii_whitespace().next().is_some_and(|first| first.eq_ignore_ascii_case(word))
}

/// Reads a binary STL whose length was checked. Bytes after its last triangle are left out, with a warning.
pub(super) fn read_binary(bytes: &[u8], builder: &mut MeshBuilder) -> Result<(), TerrainError> {
    let length = usize::try_from(binary_length(bytes).unwrap_or_default()).unwrap_or(usize::MAX).min(bytes.len());
    if length < bytes.len() {
        let count = match bytes.len() - length {
            1 => "1 byte".to_owned(),
            count => format!("{count} bytes"),
        };
        builder.warn(format!("the file goes on after the last triangle of the {BINARY}: {count} left out"));
    }
    let triangles = bytes.get(HEADER_BYTES..length).unwrap_or_default().chunks_exact(50);
    for (index, triangle) in triangles.enumerate() {
        let damaged = |problem| {
            TerrainError::InvalidMesh(format!("triangle {} of the {BINARY}: {problem}; export the mesh again", index + 1))
        };
        let mut numbers = triangle.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]])).skip(3);
        let mut corners = [0; 3];
        for corner in &mut corners {
            let mut number = || numbers.next().map_or(f64::NAN, f64::from);
            *corner = builder.vertex(number(), number(), number()).map_err(damaged)?;
        }
        builder.polygon(&corners).map_err(damaged)?;
    }
    Ok(())
}

/// The current level of nesting in an ASCII STL.
#[derive(Clone, Copy, PartialEq)]
enum Inside {
    File,
    Solid,
    Facet,
    Loop,
}

/// Reads a text STL: one or more solids.
pub(super) fn read_ascii(bytes: &[u8], builder: &mut MeshBuilder) -> Result<(), TerrainError> {
    let mut inside = Inside::File;
    let mut corners = Vec::new();
    for (number, line) in lines(bytes) {
        let mut words = line.split_ascii_whitespace();
        let Some(word) = words.next() else { continue };
        let word = word.to_ascii_lowercase();
        let at_line = |problem: String| in_line(ASCII, number, &problem);
        inside = match (inside, word.as_str()) {
            (Inside::File, "solid") | (Inside::Facet, "endfacet") => Inside::Solid,
            (Inside::Solid, "facet") => Inside::Facet,
            (Inside::Solid, "endsolid") => Inside::File,
            (Inside::Facet, "outer") => {
                corners.clear();
                Inside::Loop
            }
            (Inside::Loop, "vertex") => {
                let [x, y, z] = three(&mut words).map_err(at_line)?;
                corners.push(builder.vertex(x, y, z).map_err(at_line)?);
                Inside::Loop
            }
            (Inside::Loop, "endloop") => {
                builder.polygon(&corners).map_err(at_line)?;
                Inside::Facet
            }
            (inside, _) => return Err(at_line(format!("found '{}', expected {}", shown(&word), inside.expected()))),
        };
    }
    if inside == Inside::File {
        return Ok(());
    }
    Err(TerrainError::Damaged { format: ASCII, reason: format!("the text ends where {} was expected", inside.expected()) })
}

impl Inside {
    fn expected(self) -> &'static str {
        match self {
            Self::File => "solid",
            Self::Solid => "facet or endsolid",
            Self::Facet => "outer loop or endfacet",
            Self::Loop => "vertex or endloop",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid rock\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid rock\n";

    fn ascii(text: &str) -> Result<usize, String> {
        let mut builder = MeshBuilder::new(1.0);
        read_ascii(text.as_bytes(), &mut builder).map_err(|error| error.to_string())?;
        builder.finish().map(|(mesh, _)| mesh.triangle_count()).map_err(|error| error.to_string())
    }

    #[test]
    fn texts_of_one_or_several_solids_in_any_letters_are_read() {
        assert!(recognises_ascii(TEXT.as_bytes()));
        assert_eq!(ascii(TEXT), Ok(1));
        assert_eq!(ascii(&format!("{TEXT}\r\n{}", TEXT.to_uppercase())), Ok(2));
    }

    #[test]
    fn faults_of_texts_are_named_with_their_line() {
        let cut = TEXT.find("endloop").unwrap();
        assert!(ascii(&TEXT[..cut]).unwrap_err().contains("the text ends where vertex or endloop was expected"));
        assert!(ascii(&TEXT.replace("vertex 1 0 0\n", "")).unwrap_err().contains("line 6: found a face of 2 corners"));
        assert!(ascii(&TEXT.replace("1 0 0", "1 0 nan")).unwrap_err().contains("line 5"));
        assert!(ascii(&TEXT.replace("outer loop", "inner loop")).unwrap_err().contains("found 'inner', expected outer loop"));
        assert!(ascii("solid a\nendsolid\n").unwrap_err().contains("no faces"));
    }

    #[test]
    fn a_binary_file_is_known_by_its_length_alone_even_where_its_title_says_solid() {
        let mut bytes = vec![b' '; 80];
        bytes[..5].copy_from_slice(b"solid");
        bytes.extend(1_u32.to_le_bytes());
        for number in [0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5] {
            bytes.extend(number.to_le_bytes());
        }
        bytes.extend([0, 0]);
        assert!(recognises_binary(&bytes, bytes.len() as u64) && !recognises_binary(&bytes, 133));
        assert!(!recognises_ascii(&bytes));
        for tail in [&b"\n"[..], b"\r\n", &[0; 378], b"some words of the exporter"] {
            let longer = [&bytes, tail].concat();
            assert!(recognises_binary(&longer, longer.len() as u64));
            let mut builder = MeshBuilder::new(1.0);
            read_binary(&longer, &mut builder).unwrap();
            let (mesh, warnings) = builder.finish().unwrap();
            assert_eq!(mesh.triangle_count(), 1);
            assert_eq!(
                warnings,
                [format!(
                    "the file goes on after the last triangle of the binary STL: {} left out",
                    if tail.len() == 1 { "1 byte".to_owned() } else { format!("{} bytes", tail.len()) }
                )]
            );
        }
        // No triangles, and numbers that are no coordinates.
        assert!(
            !recognises_binary(&[0; 200], 200) && !recognises_binary(&[&[0; 80][..], &[1, 0, 0, 0], &[0x7f; 60]].concat(), 144)
        );
        let mut builder = MeshBuilder::new(10.0);
        read_binary(&bytes, &mut builder).unwrap();
        let (mesh, _) = builder.finish().unwrap();
        assert_eq!(mesh.vertices()[2], nalgebra::Point3::new(0.0, 10.0, 5.0));
        bytes[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(read_binary(&bytes, &mut MeshBuilder::new(1.0)).unwrap_err().to_string().contains("triangle 1"));
    }
}
