//! The header: the elements of the body, their order and encoding.

use super::super::text::{in_line, shown};
use super::{NAME, damaged};
use crate::terrain::TerrainError;

/// The encoding of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// The types of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// One value, or one list of values, of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    /// The type of the count, if this is a list.
    pub(super) list: Option<Kind>,
    pub(super) kind: Kind,
}

impl Property {
    /// The least number of bytes it takes: a digit and a blank as text, the count for a list.
    pub(super) fn least_bytes(&self, encoding: Encoding) -> u64 {
        match encoding {
            Encoding::Text => 2,
            Encoding::LittleEndian | Encoding::BigEndian => self.list.unwrap_or(self.kind).bytes() as u64,
        }
    }
}

/// Rows of the same properties.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// The whole header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

impl Header {
    /// Reads the header and returns the body after it. Its lines end as its first line does: in a binary body, a line feed
    /// after a carriage return may be a number.
    pub(super) fn read(bytes: &[u8]) -> Result<(Self, &[u8]), TerrainError> {
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let first = bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(bytes.len());
        let returns_alone = bytes.get(first) == Some(&b'\r') && bytes.get(first + 1) != Some(&b'\n');
        let line_end = if returns_alone { b'\r' } else { b'\n' };
        let mut rest = bytes;
        let mut number = 0;
        loop {
            let end = rest.iter().position(|&byte| byte == line_end).ok_or_else(|| damaged("the header has no end_header"))?;
            let line = String::from_utf8_lossy(rest[..end].trim_ascii()).into_owned();
            rest = &rest[end + 1..];
            number += 1;
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words.as_slice() {
                ["ply"] if number == 1 => {}
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, "1.0"] => {
                    encoding = Some(encoding_named(name).map_err(|problem| in_line(NAME, number, &problem))?);
                }
                ["element", name, count] => {
                    let found = || format!("found the count '{}', expected a whole number", shown(count));
                    let count = count.parse().map_err(|_| in_line(NAME, number, &found()))?;
                    elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
                }
                ["property", words @ ..] => {
                    let property = property(words).map_err(|problem| in_line(NAME, number, &problem))?;
                    let element =
                        elements.last_mut().ok_or_else(|| in_line(NAME, number, "found a property before any element"))?;
                    element.properties.push(property);
                }
                ["end_header"] => {
                    let encoding = encoding.ok_or_else(|| {
                        in_line(
                            NAME,
                            number,
                            "found the end of a header without a line 'format', expected one such as 'format ascii 1.0'",
                        )
                    })?;
                    return Ok((Self { encoding, elements }, rest));
                }
                _ => return Err(in_line(NAME, number, &format!("found '{}', expected a line of a header", shown(&line)))),
            }
        }
    }
}

fn encoding_named(name: &str) -> Result<Encoding, String> {
    match name {
        "ascii" => Ok(Encoding::Text),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(format!("found the format '{}', expected ascii, binary_little_endian or binary_big_endian", shown(name))),
    }
}

fn property(words: &[&str]) -> Result<Property, String> {
    let kind = |name: &str| {
        Kind::named(name).ok_or_else(|| format!("found the type '{}', expected float or another one of PLY", shown(name)))
    };
    match words {
        ["list", count, of, name] => {
            let count = kind(count)?;
            if matches!(count, Kind::F32 | Kind::F64) {
                return Err("found a list whose count is a fraction, expected a whole number".to_owned());
            }
            Ok(Property { name: (*name).to_owned(), list: Some(count), kind: kind(of)? })
        }
        [of, name] => Ok(Property { name: (*name).to_owned(), list: None, kind: kind(of)? }),
        _ => Err("found a property of another form, expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'".to_owned()),
    }
}
