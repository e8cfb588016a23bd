//! PNG encoder (W3C, third edition), and base64 (RFC 4648) to embed a PNG in an SVG.

use std::io::Write as _;

use flate2::{Compression, Crc, write::ZlibEncoder};

use super::super::FigureError;

/// Pixels, row by row from the top, each row from the left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in super::super) struct Pixels {
    /// Columns.
    pub(in super::super) width: usize,
    /// Rows.
    pub(in super::super) height: usize,
    /// The pixel format.
    pub(in super::super) form: Form,
    /// One or three bytes for each pixel.
    pub(in super::super) bytes: Vec<u8>,
}

/// The format of the pixel bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in super::super) enum Form {
    /// Red, green, blue.
    Rgb,
    /// An index into a table of at most 256 colours: a third of the bytes, and better compression.
    Palette(Vec<[u8; 3]>),
}

impl Form {
    fn bytes_per_pixel(&self) -> usize {
        match self {
            Self::Rgb => 3,
            Self::Palette(_) => 1,
        }
    }

    /// The colour type for the header.
    fn code(&self) -> u8 {
        match self {
            Self::Rgb => 2,
            Self::Palette(_) => 3,
        }
    }
}

impl Pixels {
    /// The colour of a pixel; white outside.
    pub(super) fn colour(&self, column: usize, row: usize) -> [u8; 3] {
        const WHITE: [u8; 3] = [255; 3];
        if column >= self.width {
            return WHITE;
        }
        let at = (row * self.width + column) * self.form.bytes_per_pixel();
        match (&self.form, self.bytes.get(at..at + self.form.bytes_per_pixel())) {
            (Form::Rgb, Some(&[r, g, b])) => [r, g, b],
            (Form::Palette(colours), Some(&[index])) => colours.get(usize::from(index)).copied().unwrap_or(WHITE),
            _ => WHITE,
        }
    }

    /// The pixels as a PNG file; the same pixels give the same bytes.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] if the sides do not fit 32 bits or the compressor fails.
    pub(in super::super) fn to_png(&self, pixels_per_m: Option<u32>) -> Result<Vec<u8>, FigureError> {
        let side = |length: usize| u32::try_from(length).map_err(|_| failed(format!("{length} pixels are too many for a PNG")));
        let mut header = Vec::with_capacity(13);
        header.extend(side(self.width)?.to_be_bytes());
        header.extend(side(self.height)?.to_be_bytes());
        // 8 bits, the colour type, the only defined compression and filter methods, no interlacing.
        header.extend([8, self.form.code(), 0, 0, 0]);
        let mut out = b"\x89PNG\r\n\x1a\n".to_vec();
        chunk(&mut out, *b"IHDR", &header)?;
        if let Some(density) = pixels_per_m {
            let both: Vec<u8> = [density.to_be_bytes(), density.to_be_bytes()].concat();
            chunk(&mut out, *b"pHYs", &[both.as_slice(), &[1]].concat())?;
        }
        if let Form::Palette(colours) = &self.form {
            chunk(&mut out, *b"PLTE", &colours.concat())?;
        }
        chunk(&mut out, *b"IDAT", &self.compressed().map_err(|error| failed(error.to_string()))?)?;
        chunk(&mut out, *b"IEND", &[])?;
        Ok(out)
    }

    /// The rows, each with the filter that leaves the smallest numbers (no filter for palette indices, whose differences are
    /// meaningless).
    fn compressed(&self) -> std::io::Result<Vec<u8>> {
        let step = self.form.bytes_per_pixel();
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(6));
        let mut above = vec![0; self.width * step];
        for row in self.bytes.chunks_exact((self.width * step).max(1)) {
            let filters: &[u8] = if self.form == Form::Rgb { &[0, 1, 2] } else { &[0] };
            let filtered = filters.iter().map(|&filter| filtered(filter, row, &above, step));
            if let Some(best) = filtered.min_by_key(|row| row[1..].iter().map(|&b| u64::from(b.min(b.wrapping_neg()))).sum::<u64>())
            {
                encoder.write_all(&best)?;
            }
            above.copy_from_slice(row);
        }
        encoder.finish()
    }
}

/// A row after its filter type: 0 unchanged, 1 minus the pixel to the left, 2 minus the pixel above.
fn filtered(filter: u8, row: &[u8], above: &[u8], step: usize) -> Vec<u8> {
    let less = |i: usize| match filter {
        1 if i >= step => row[i - step],
        2 => above[i],
        _ => 0,
    };
    std::iter::once(filter).chain(row.iter().enumerate().map(|(i, byte)| byte.wrapping_sub(less(i)))).collect()
}

/// Appends a chunk: length, name, content, checksum.
fn chunk(out: &mut Vec<u8>, name: [u8; 4], content: &[u8]) -> Result<(), FigureError> {
    let length = u32::try_from(content.len()).map_err(|_| failed("more than 4 GB in one PNG".to_owned()))?;
    let mut sum = Crc::new();
    sum.update(&name);
    sum.update(content);
    out.extend(length.to_be_bytes());
    out.extend(name);
    out.extend(content);
    out.extend(sum.sum().to_be_bytes());
    Ok(())
}

fn failed(why: String) -> FigureError {
    FigureError::Drawing(why)
}

/// Bytes in the 64 letters of RFC 4648, section 4.
pub(in super::super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = three.iter().fold(0u32, |word, &byte| word << 8 | u32::from(byte)) << (8 * (3 - three.len()));
        for place in 0..4 {
            let sextet = (word >> (18 - 6 * place)) & 63;
            out.push(if place <= three.len() { char::from(LETTERS[sextet as usize]) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use super::*;

    #[test]
    fn base64_is_that_of_the_rfc() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
        assert_eq!(base64(&[0xfb, 0xff, 0xfe]), "+//+");
    }

    /// Decodes a PNG with filters 0 to 2 and checks its checksums.
    pub(super) fn read(png: &[u8]) -> (usize, usize, Vec<u8>) {
        assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
        let (mut rest, mut size, mut packed, mut step) = (&png[8..], (0, 0), Vec::new(), 0);
        while !rest.is_empty() {
            let length = u32::from_be_bytes(rest[..4].try_into().unwrap()) as usize;
            let (name, content) = (&rest[4..8], &rest[8..8 + length]);
            let mut sum = Crc::new();
            sum.update(&rest[4..8 + length]);
            assert_eq!(sum.sum().to_be_bytes(), rest[8 + length..12 + length], "checksum");
            match name {
                b"IHDR" => {
                    let side = |at: usize| u32::from_be_bytes(content[at..at + 4].try_into().unwrap()) as usize;
                    (size, step) = ((side(0), side(4)), if content[9] == 2 { 3 } else { 1 });
                }
                b"IDAT" => packed.extend(content),
                _ => {}
            }
            rest = &rest[12 + length..];
        }
        let mut plain = Vec::new();
        flate2::read::ZlibDecoder::new(&packed[..]).read_to_end(&mut plain).unwrap();
        let wide = size.0 * step;
        let mut bytes: Vec<u8> = Vec::new();
        for row in plain.chunks(wide + 1) {
            for i in 0..wide {
                let less = match row[0] {
                    1 if i >= step => bytes[bytes.len() - step],
                    2 if bytes.len() >= wide => bytes[bytes.len() - wide],
                    _ => 0,
                };
                bytes.push(row[i + 1].wrapping_add(less));
            }
        }
        (size.0, size.1, bytes)
    }

    #[test]
    fn a_png_decodes_to_its_pixels() {
        let rgb: Vec<u8> = (0..7 * 5 * 3u32).map(|i| (i * i % 251) as u8).collect();
        let pixels = Pixels { width: 7, height: 5, form: Form::Rgb, bytes: rgb.clone() };
        assert_eq!(read(&pixels.to_png(Some(11_811)).unwrap()), (7, 5, rgb));
        assert_eq!(pixels.colour(2, 1), [pixels.bytes[27], pixels.bytes[28], pixels.bytes[29]]);
        let colours = vec![[1, 2, 3], [250, 240, 230]];
        let table = Pixels { width: 3, height: 2, form: Form::Palette(colours), bytes: vec![0, 1, 0, 1, 1, 0] };
        assert_eq!(read(&table.to_png(None).unwrap()), (3, 2, table.bytes.clone()));
        assert_eq!((table.colour(1, 0), table.colour(3, 0), table.colour(0, 9)), ([250, 240, 230], [255; 3], [255; 3]));
    }
}
