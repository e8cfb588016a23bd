//! Converts the bytes of an image to elevations.

use super::label::{Value, shown, unsuitable};
use crate::terrain::TerrainError;

/// The encoding of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SampleType {
    kind: Kind,
    bytes: usize,
    little_endian: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Unsigned,
    Signed,
    Real,
    VaxReal,
}

/// A stored value that means a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mark {
    /// The bits of a sample, written as `16#FF7FFFFB#`.
    Bits(u64),
    /// A number.
    Number(f64),
    /// Every number below this.
    Below(f64),
    /// Every number above this.
    Above(f64),
}

impl SampleType {
    /// From `SAMPLE_TYPE` and `SAMPLE_BITS`.
    ///
    /// # Errors
    /// [`TerrainError::Unsuitable`] for types that cannot be elevations or are not known.
    pub(super) fn of(name: &str, bits: usize) -> Result<Self, TerrainError> {
        let upper = name.to_ascii_uppercase();
        let (kind, little_endian) = match upper.as_str() {
            "MSB_INTEGER" | "INTEGER" | "MAC_INTEGER" | "SUN_INTEGER" => (Kind::Signed, false),
            "LSB_INTEGER" | "PC_INTEGER" | "VAX_INTEGER" => (Kind::Signed, true),
            "MSB_UNSIGNED_INTEGER" | "UNSIGNED_INTEGER" | "MAC_UNSIGNED_INTEGER" | "SUN_UNSIGNED_INTEGER" => {
                (Kind::Unsigned, false)
            }
            "LSB_UNSIGNED_INTEGER" | "PC_UNSIGNED_INTEGER" | "VAX_UNSIGNED_INTEGER" => (Kind::Unsigned, true),
            "IEEE_REAL" | "FLOAT" | "REAL" | "MAC_REAL" | "SUN_REAL" => (Kind::Real, false),
            "PC_REAL" => (Kind::Real, true),
            "VAX_REAL" => (Kind::VaxReal, true),
            _ => return Err(unsuitable(format!("SAMPLE_TYPE {}", shown(name)), "an integer or real type of the PDS3 standard")),
        };
        let fits = match kind {
            Kind::Unsigned | Kind::Signed => matches!(bits, 8 | 16 | 32),
            Kind::Real => matches!(bits, 32 | 64),
            Kind::VaxReal => bits == 32,
        };
        if !fits {
            return Err(unsuitable(
                format!("SAMPLE_BITS {bits} for SAMPLE_TYPE {}", shown(name)),
                "8, 16 or 32 bits for integers, 32 or 64 for reals, 32 for VAX_REAL",
            ));
        }
        Ok(Self { kind, bytes: bits / 8, little_endian })
    }

    pub(super) fn bytes(self) -> usize {
        self.bytes
    }

    /// The number of bits of a real; `None` for integers.
    pub(super) fn float_bits(self) -> Option<usize> {
        matches!(self.kind, Kind::Real | Kind::VaxReal).then_some(8 * self.bytes)
    }

    /// The sample's bits, in the low bits.
    fn bits(self, sample: &[u8]) -> u64 {
        let append = |bits: u64, byte: &u8| (bits << 8) | u64::from(*byte);
        if self.little_endian { sample.iter().rev().fold(0, append) } else { sample.iter().fold(0, append) }
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "the bits of narrower numbers, in the low end")]
    fn number(self, bits: u64) -> f64 {
        match (self.kind, self.bytes) {
            (Kind::Unsigned, _) => f64::from(bits as u32),
            (Kind::Signed, 1) => f64::from(bits as u8 as i8),
            (Kind::Signed, 2) => f64::from(bits as u16 as i16),
            (Kind::Signed, _) => f64::from(bits as u32 as i32),
            (Kind::Real, 8) => f64::from_bits(bits),
            (Kind::Real, _) => f64::from(f32::from_bits(bits as u32)),
            (Kind::VaxReal, _) => vax_real(bits as u32),
        }
    }

    /// The number that a mark stands for.
    pub(super) fn number_of(self, mark: Mark) -> f64 {
        match mark {
            Mark::Bits(bits) => self.number(bits),
            Mark::Number(number) | Mark::Below(number) | Mark::Above(number) => number,
        }
    }

    /// The stored number; NaN if it is a gap.
    #[expect(clippy::cast_possible_truncation, reason = "a mark is cast to the samples' type, as the writer did")]
    pub(super) fn decode(self, sample: &[u8], marks: &[Mark]) -> f64 {
        let bits = self.bits(sample);
        let number = self.number(bits);
        let narrow = matches!(self.kind, Kind::Real | Kind::VaxReal) && self.bytes == 4;
        let is_mark = |mark: &Mark| match *mark {
            Mark::Bits(pattern) => pattern == bits,
            Mark::Number(value) => number == value || (narrow && number == f64::from(value as f32)),
            Mark::Below(least) => number < if narrow { f64::from(least as f32) } else { least },
            Mark::Above(greatest) => number > if narrow { f64::from(greatest as f32) } else { greatest },
        };
        if marks.iter().any(is_mark) { f64::NAN } else { number }
    }
}

/// VAX F: 16-bit words with the high one first; sign, exponent with an offset of 128, mantissa 0.1ffff.
///
/// `bits` is read from little-endian bytes. An exponent of zero means zero, or a reserved value (NaN) if the sign is set.
fn vax_real(bits: u32) -> f64 {
    let word = bits.rotate_left(16);
    let exponent = (word >> 23) & 0xff;
    let fraction = 0.5 + f64::from(word & 0x7f_ffff) / 16_777_216.0;
    match (exponent, word >> 31) {
        (0, 0) => 0.0,
        (0, _) => f64::NAN,
        (_, sign) => {
            let size = fraction * libm::exp2(f64::from(exponent) - 128.0);
            if sign == 0 { size } else { -size }
        }
    }
}

/// A gap value from the label: a number, or bits such as `16#FF7FFFFB#`.
///
/// # Errors
/// [`TerrainError::Unsuitable`] if it is neither.
pub(super) fn mark(key: &str, value: &Value) -> Result<Mark, TerrainError> {
    let text = value.text.as_str();
    let number = || text.parse::<f64>().ok().map(Mark::Number);
    let pattern = || {
        let (base, digits) = text.strip_suffix('#')?.split_once('#')?;
        let base = base.parse().ok().filter(|base| (2..=36).contains(base))?;
        u64::from_str_radix(digits, base).ok().map(Mark::Bits)
    };
    number().or_else(pattern).ok_or_else(|| unsuitable(format!("{key} {}", shown(text)), "a number, or bits such as 16#FF7FFFFB#"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(name: &str, bits: usize, sample: &[u8]) -> f64 {
        SampleType::of(name, bits).unwrap().decode(sample, &[])
    }

    #[test]
    fn every_sample_type_decodes_its_bytes() {
        assert_eq!(decoded("MSB_INTEGER", 16, &[0xff, 0xfe]), -2.0);
        assert_eq!(decoded("lsb_integer", 16, &[0xfe, 0xff]), -2.0);
        assert_eq!(decoded("VAX_INTEGER", 32, &[0xfe, 0xff, 0xff, 0xff]), -2.0);
        assert_eq!(decoded("SUN_INTEGER", 8, &[0x80]), -128.0);
        assert_eq!(decoded("UNSIGNED_INTEGER", 8, &[0x80]), 128.0);
        assert_eq!(decoded("PC_UNSIGNED_INTEGER", 16, &[1, 2]), 513.0);
        assert_eq!(decoded("MSB_UNSIGNED_INTEGER", 32, &[0xff; 4]), 4_294_967_295.0);
        assert_eq!(decoded("IEEE_REAL", 32, &(-1.5_f32).to_be_bytes()), -1.5);
        assert_eq!(decoded("PC_REAL", 32, &(-1.5_f32).to_le_bytes()), -1.5);
        assert_eq!(decoded("PC_REAL", 64, &0.1_f64.to_le_bytes()), 0.1);
        // The VAX manual's 1.0 is 0x4080, its -6.25 is 0xC1C8; the second word of both is zero.
        assert_eq!(decoded("VAX_REAL", 32, &[0x80, 0x40, 0, 0]), 1.0);
        assert_eq!(decoded("VAX_REAL", 32, &[0xc8, 0xc1, 0, 0]), -6.25);
        assert_eq!(decoded("VAX_REAL", 32, &[0; 4]), 0.0);
        assert!(decoded("VAX_REAL", 32, &[0, 0x80, 0, 0]).is_nan());
    }

    #[test]
    fn unsupported_types_and_widths_are_refused() {
        for (name, bits) in [("COMPLEX", 64), ("BIT_STRING", 8), ("IEEE_REAL", 16), ("LSB_INTEGER", 64), ("VAX_REAL", 64), ("", 8)]
        {
            assert!(SampleType::of(name, bits).unwrap_err().to_string().contains("PDS3 label"), "{name}");
        }
    }

    #[test]
    fn marks_are_numbers_or_bits() {
        let of = |text: &str| mark("MISSING_CONSTANT", &Value { text: text.to_owned(), unit: None });
        assert_eq!(of("-32768").unwrap(), Mark::Number(-32768.0));
        assert_eq!(of("16#FF7FFFFB#").unwrap(), Mark::Bits(0xff7f_fffb));
        for bad in ["N/A", "16#XY#", "99#1#", "16#1"] {
            assert!(of(bad).is_err(), "{bad}");
        }
        let real = SampleType::of("PC_REAL", 32).unwrap();
        assert!(real.decode(&0xff7f_fffb_u32.to_le_bytes(), &[Mark::Bits(0xff7f_fffb)]).is_nan());
        assert!(real.decode(&0.1_f32.to_le_bytes(), &[Mark::Number(0.1)]).is_nan());
        assert!(!real.decode(&0.2_f32.to_le_bytes(), &[Mark::Number(0.1)]).is_nan());
    }
}
