//! The sheet as pixels: the same marks as in the SVG, antialiased, including text.
//!
//! Every mark becomes closed outlines, `ab_glyph_rasterizer` computes their coverage of each pixel, and `png` encodes the pixels.
//! Nothing depends on fonts or libraries of the machine, and the rasteriser is built without its detection of vector instructions
//! and with `libm`, so the bytes are the same everywhere. It computes exact areas, in 256 shades; tiny-skia samples each pixel at 16
//! places, and would replace only [`stroke`] and [`disc`]. An SVG renderer (resvg) would add 60 crates for the same result.

mod letters;
mod png;

use ab_glyph_rasterizer::{Rasterizer, point};
use plotters::style::RGBColor;

pub(super) use self::png::{Form, Pixels};
use super::{
    FigureError,
    sheet::{Mark, Pen, Place, Sheet, SheetImage},
};
use letters::Letters;

/// 300 dots an inch.
const PIXELS_PER_MM: f64 = 300.0 / 25.4;
/// The same resolution for the file's header, in pixels per metre.
const PIXELS_PER_M: u32 = 11_811;
/// Lines thinner than this many pixels get no round joints.
const JOINT: f64 = 1.5;

/// Renders a sheet as PNG at 300 dots an inch.
///
/// # Errors
/// [`FigureError::Drawing`].
pub(super) fn render(sheet: &Sheet, width_mm: f64, height_mm: f64) -> Result<Vec<u8>, FigureError> {
    pixels(sheet, width_mm, height_mm)?.to_png(Some(PIXELS_PER_M))
}

/// The pixels of a sheet.
fn pixels(sheet: &Sheet, width_mm: f64, height_mm: f64) -> Result<Pixels, FigureError> {
    let letters = Letters::new()?;
    let mut canvas = Canvas::new(whole(width_mm * PIXELS_PER_MM), whole(height_mm * PIXELS_PER_MM));
    for image in &sheet.images {
        canvas.image(image);
    }
    for mark in &sheet.marks {
        match mark {
            Mark::Line { points, pen } => canvas.fill(&stroke(points, *pen), pen.colour, 1.0),
            Mark::Area { points, colour, opacity } => canvas.fill(std::slice::from_ref(points), *colour, *opacity),
            Mark::Dot { centre, radius_mm, pen, filled: true } => canvas.fill(&[disc(*centre, *radius_mm)], pen.colour, 1.0),
            Mark::Dot { centre, radius_mm, pen, filled: false } => {
                let mut ring = disc(*centre, *radius_mm);
                ring.extend(ring.first().copied());
                canvas.fill(&stroke(&ring, *pen), pen.colour, 1.0);
            }
            Mark::Label(label) => canvas.fill(&letters.outlines(label), label.colour, 1.0),
        }
    }
    Ok(canvas.pixels)
}

/// A whole number of pixels, at least one.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some thousand pixels; the cast saturates beyond")]
fn whole(pixels: f64) -> usize {
    pixels.round().max(1.0) as usize
}

/// A circle as a polygon, fine enough for its size.
fn disc(centre: Place, radius_mm: f64) -> Vec<Place> {
    let corners: u8 = if radius_mm < 0.3 { 12 } else { 32 };
    let corner = |i| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(corners);
        (centre.0 + radius_mm * libm::cos(angle), centre.1 + radius_mm * libm::sin(angle))
    };
    (0..corners).map(corner).collect()
}

/// A polyline as outlines of the same orientation, so that overlaps count once: a rectangle for each piece, and a disc for each
/// joint if the line is wide enough.
fn stroke(points: &[Place], pen: Pen) -> Vec<Vec<Place>> {
    let half = 0.5 * pen.width_mm;
    let mut found = Vec::new();
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = libm::hypot(b.0 - a.0, b.1 - a.1);
        if length > 0.0 {
            let (x, y) = ((b.0 - a.0) / length * half, (b.1 - a.1) / length * half);
            found.push(vec![(a.0 + y, a.1 - x), (b.0 + y, b.1 - x), (b.0 - y, b.1 + x), (a.0 - y, a.1 + x)]);
        }
    }
    if pen.width_mm * PIXELS_PER_MM > JOINT && points.len() > 2 {
        found.extend(points[1..points.len() - 1].iter().map(|&joint| disc(joint, half)));
    }
    found
}

/// The pixel buffer.
struct Canvas {
    pixels: Pixels,
    ink: Rasterizer,
}

impl Canvas {
    /// All white.
    fn new(width: usize, height: usize) -> Self {
        let pixels = Pixels { width, height, form: Form::Rgb, bytes: vec![255; width * height * 3] };
        Self { pixels, ink: Rasterizer::new(0, 0) }
    }

    /// Copies an image; each page pixel gets the image pixel at its centre.
    #[expect(clippy::cast_precision_loss, reason = "pixels of a page")]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates, and the places are clipped")]
    fn image(&mut self, image: &SheetImage) {
        let across = |mm: f64, most: usize| ((mm * PIXELS_PER_MM).round().max(0.0) as usize).min(most);
        let columns = across(image.left_mm, self.pixels.width)..across(image.left_mm + image.width_mm, self.pixels.width);
        let rows = across(image.top_mm, self.pixels.height)..across(image.top_mm + image.height_mm, self.pixels.height);
        for row in rows {
            let down = ((row as f64 + 0.5) / PIXELS_PER_MM - image.top_mm) / image.height_mm;
            let from_row = ((down * image.pixels.height as f64) as usize).min(image.pixels.height.saturating_sub(1));
            for column in columns.clone() {
                let along = ((column as f64 + 0.5) / PIXELS_PER_MM - image.left_mm) / image.width_mm;
                let from_column = ((along * image.pixels.width as f64) as usize).min(image.pixels.width.saturating_sub(1));
                let at = (row * self.pixels.width + column) * 3;
                self.pixels.bytes[at..at + 3].copy_from_slice(&image.pixels.colour(from_column, from_row));
            }
        }
    }

    /// Fills closed outlines, given in mm.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "pixels of a page, clipped to a page on all sides"
    )]
    fn fill(&mut self, outlines: &[Vec<Place>], colour: RGBColor, opacity: f64) {
        let (wide, high) = (self.pixels.width as f64, self.pixels.height as f64);
        // A margin of one page on each side is kept, so that outlines beyond the edge are clipped and not deformed.
        let pixel = |&(x, y): &Place| ((x * PIXELS_PER_MM).clamp(-wide, 2.0 * wide), (y * PIXELS_PER_MM).clamp(-high, 2.0 * high));
        let (mut low, mut top) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        for (x, y) in outlines.iter().flatten().map(pixel) {
            (low, top) = ((low.0.min(x), low.1.min(y)), (top.0.max(x), top.1.max(y)));
        }
        if !(low.0 <= top.0 && low.1 <= top.1) {
            return;
        }
        let origin = (low.0.floor() - 1.0, low.1.floor() - 1.0);
        self.ink.reset((top.0 - origin.0).ceil() as usize + 2, (top.1 - origin.1).ceil() as usize + 2);
        for outline in outlines {
            let ends = outline.iter().zip(outline.iter().cycle().skip(1));
            for (from, to) in ends {
                let (from, to) = (pixel(from), pixel(to));
                let place = |(x, y): (f64, f64)| point((x - origin.0) as f32, (y - origin.1) as f32);
                self.ink.draw_line(place(from), place(to));
            }
        }
        let pixels = &mut self.pixels;
        let ink = [colour.0, colour.1, colour.2].map(f32::from);
        self.ink.for_each_pixel_2d(|x, y, cover| {
            let (column, row) = (f64::from(x) + origin.0, f64::from(y) + origin.1);
            let cover = cover.min(1.0) * opacity as f32;
            if cover < 1.0 / 512.0 || column < 0.0 || row < 0.0 || column >= wide || row >= high {
                return;
            }
            let at = (row as usize * pixels.width + column as usize) * 3;
            for (byte, ink) in pixels.bytes[at..at + 3].iter_mut().zip(ink) {
                *byte = (f32::from(*byte) + (ink - f32::from(*byte)) * cover).round() as u8;
            }
        });
    }
}

#[cfg(test)]
mod tests;
