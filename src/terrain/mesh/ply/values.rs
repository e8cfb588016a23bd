//! The body, number by number.

use super::super::text::shown;
use super::header::{Encoding, Kind};

/// The rest of the body.
#[derive(Debug)]
pub(super) struct Values<'a> {
    rest: &'a [u8],
    encoding: Encoding,
}

impl<'a> Values<'a> {
    pub(super) fn new(body: &'a [u8], encoding: Encoding) -> Self {
        Self { rest: body, encoding }
    }

    pub(super) fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    /// The next number.
    pub(super) fn next(&mut self, kind: Kind) -> Result<f64, String> {
        match self.encoding {
            Encoding::Text => self.next_word(),
            Encoding::LittleEndian | Encoding::BigEndian => self.next_binary(kind),
        }
    }

    /// The next number, as the count of a list.
    pub(super) fn next_count(&mut self, kind: Kind) -> Result<u64, String> {
        let value = self.next(kind)?;
        // A list cannot be longer than the file.
        let most = self.rest.len();
        #[expect(clippy::cast_precision_loss, reason = "a file's length stays below 2^53")]
        let holds = value.fract() == 0.0 && (0.0..=most as f64).contains(&value);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and within the file's length")]
        if holds { Ok(value as u64) } else { Err(format!("found a list of {value} values, but {most} bytes are left")) }
    }

    fn next_word(&mut self) -> Result<f64, String> {
        let begun = self.rest.trim_ascii_start();
        let end = begun.iter().position(u8::is_ascii_whitespace).unwrap_or(begun.len());
        let (word, rest) = begun.split_at(end);
        self.rest = rest;
        if word.is_empty() {
            return Err("the file ends".to_owned());
        }
        let text = String::from_utf8_lossy(word);
        text.parse().map_err(|_| format!("found '{}', expected a number", shown(&text)))
    }

    fn next_binary(&mut self, kind: Kind) -> Result<f64, String> {
        let Some((bytes, rest)) = self.rest.split_at_checked(kind.bytes()) else { return Err("the file ends".to_owned()) };
        self.rest = rest;
        // Little-endian, in the low bytes of eight.
        let mut eight = [0; 8];
        for (place, byte) in bytes.iter().enumerate() {
            let at = if self.encoding == Encoding::LittleEndian { place } else { bytes.len() - 1 - place };
            eight[at] = *byte;
        }
        let [one, two, three, four, ..] = eight;
        Ok(match kind {
            Kind::I8 => f64::from(i8::from_le_bytes([one])),
            Kind::U8 => f64::from(one),
            Kind::I16 => f64::from(i16::from_le_bytes([one, two])),
            Kind::U16 => f64::from(u16::from_le_bytes([one, two])),
            Kind::I32 => f64::from(i32::from_le_bytes([one, two, three, four])),
            Kind::U32 => f64::from(u32::from_le_bytes([one, two, three, four])),
            Kind::F32 => f64::from(f32::from_le_bytes([one, two, three, four])),
            Kind::F64 => f64::from_le_bytes(eight),
        })
    }
}
