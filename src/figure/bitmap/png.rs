//! Pixels, and their PNG by the crate `png`.
//!
//! The bytes are the same on every processor: filters and compression are integer arithmetic, and the compressor's vector
//! instructions only find and compare the same bytes faster.

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

    /// The PNG of these pixels, with their density in pixels per metre where it is known.
    ///
    /// # Errors
    /// [`FigureError::Drawing`]: no pixels, or more than a PNG holds.
    pub(in super::super) fn to_png(&self, pixels_per_m: Option<u32>) -> Result<Vec<u8>, FigureError> {
        let side = |length: usize| u32::try_from(length).map_err(|_| failed(format!("{length} pixels are too many for a PNG")));
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, side(self.width)?, side(self.height)?);
        encoder.set_depth(png::BitDepth::Eight);
        match &self.form {
            Form::Rgb => {
                encoder.set_color(png::ColorType::Rgb);
                encoder.set_filter(png::Filter::Adaptive);
            }
            Form::Palette(colours) => {
                encoder.set_color(png::ColorType::Indexed);
                encoder.set_palette(colours.concat());
                // The differences of indices mean nothing.
                encoder.set_filter(png::Filter::NoFilter);
            }
        }
        encoder.set_deflate_compression(png::DeflateCompression::Level(LEVEL));
        if let Some(density) = pixels_per_m {
            encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: density, yppu: density, unit: png::Unit::Meter }));
        }
        let mut writer = encoder.write_header().map_err(|error| failed(error.to_string()))?;
        writer.write_image_data(&self.bytes).map_err(|error| failed(error.to_string()))?;
        writer.finish().map_err(|error| failed(error.to_string()))?;
        Ok(out)
    }
}

/// zlib's own default: level 9 takes several times as long for one or two per cent.
const LEVEL: u8 = 6;

fn failed(why: String) -> FigureError {
    FigureError::Drawing(why)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The size and pixels of a PNG.
    fn read(png: &[u8]) -> (usize, usize, Vec<u8>) {
        let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        (info.width as usize, info.height as usize, bytes)
    }

    #[test]
    fn a_png_decodes_to_its_pixels() {
        let rgb: Vec<u8> = (0..7 * 5 * 3u32).map(|i| (i * i % 251) as u8).collect();
        let pixels = Pixels { width: 7, height: 5, form: Form::Rgb, bytes: rgb.clone() };
        assert_eq!(read(&pixels.to_png(Some(11_811)).unwrap()), (7, 5, rgb));
        assert_eq!(pixels.colour(2, 1), [pixels.bytes[27], pixels.bytes[28], pixels.bytes[29]]);
        let colours = vec![[1, 2, 3], [250, 240, 230]];
        let table = Pixels { width: 3, height: 2, form: Form::Palette(colours.clone()), bytes: vec![0, 1, 0, 1, 1, 0] };
        assert_eq!(read(&table.to_png(None).unwrap()), (3, 2, table.bytes.clone()));
        assert_eq!((table.colour(1, 0), table.colour(3, 0), table.colour(0, 9)), ([250, 240, 230], [255; 3], [255; 3]));
        let info = png::Decoder::new(std::io::Cursor::new(table.to_png(Some(11_811)).unwrap())).read_info().unwrap();
        assert_eq!(info.info().palette.as_deref(), Some(colours.concat().as_slice()));
        assert_eq!(info.info().pixel_dims.map(|dims| (dims.xppu, dims.yppu, dims.unit)), Some((11_811, 11_811, png::Unit::Meter)));
    }

    #[test]
    fn pixels_that_no_png_holds_are_an_error() {
        for (what, width, height, bytes) in [("no columns", 0, 3, 0), ("no rows", 3, 0, 0), ("too few bytes", 3, 2, 5)] {
            let pixels = Pixels { width, height, form: Form::Rgb, bytes: vec![0; bytes] };
            assert!(matches!(pixels.to_png(None), Err(FigureError::Drawing(_))), "{what}");
        }
    }
}
