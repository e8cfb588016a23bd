//! Glyph outlines from `DejaVu` Sans, reduced to Latin, Greek, Cyrillic and signs (`data/fonts`), so that a PNG is the same on
//! every machine, independent of installed fonts. Other characters are drawn as the font's box for missing glyphs.

use ttf_parser::{Face, OutlineBuilder};

use super::super::{
    FigureError,
    sheet::{Anchor, Hang, Label, Place},
};

const PLAIN: &[u8] = include_bytes!("../../../data/fonts/DejaVuSans-subset.ttf");
const BOLD: &[u8] = include_bytes!("../../../data/fonts/DejaVuSans-Bold-subset.ttf");
/// Line segments for each curve of a glyph: at 300 dots an inch the error is below a tenth of a pixel.
const PIECES: u8 = 5;

/// The two font faces, plain and bold.
pub(super) struct Letters {
    plain: Face<'static>,
    bold: Face<'static>,
}

impl Letters {
    /// # Errors
    /// [`FigureError::Drawing`] if a font is damaged.
    pub(super) fn new() -> Result<Self, FigureError> {
        let face = |bytes| Face::parse(bytes, 0).map_err(|error| FigureError::Drawing(format!("the built-in font: {error}")));
        Ok(Self { plain: face(PLAIN)?, bold: face(BOLD)? })
    }

    /// The outlines of a text on the sheet, mm; anchored as in an SVG of plotters.
    pub(super) fn outlines(&self, label: &Label) -> Vec<Vec<Place>> {
        let face = if label.bold { &self.bold } else { &self.plain };
        let mm_per_unit = label.size_mm / f64::from(face.units_per_em());
        let glyphs: Vec<_> = label.text.chars().map(|letter| face.glyph_index(letter).unwrap_or_default()).collect();
        let advance = |glyph| f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) * mm_per_unit;
        let width_mm: f64 = glyphs.iter().map(|&glyph| advance(glyph)).sum();
        let mut along_mm = match label.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width_mm,
            Anchor::End => -width_mm,
        };
        let half_x_mm = 0.5 * f64::from(face.x_height().unwrap_or(1120)) * mm_per_unit;
        let down_mm = match label.hang {
            Hang::Below => 0.76 * label.size_mm,
            Hang::Through => half_x_mm,
            Hang::Above => -half_x_mm,
        };
        let mut found = Vec::new();
        for glyph in glyphs {
            let mut outline = Outline::default();
            // A glyph without an outline, such as a space, only advances.
            face.outline_glyph(glyph, &mut outline);
            let place = |(x, y): Place| {
                let (right, down) = (along_mm + x * mm_per_unit, down_mm - y * mm_per_unit);
                if label.turned { (label.at.0 + down, label.at.1 - right) } else { (label.at.0 + right, label.at.1 + down) }
            };
            found.extend(outline.contours.into_iter().map(|contour| contour.into_iter().map(place).collect::<Vec<_>>()));
            along_mm += advance(glyph);
        }
        found
    }
}

/// Contours in font units.
#[derive(Default)]
struct Outline {
    contours: Vec<Vec<Place>>,
}

impl Outline {
    fn last(&self) -> Place {
        self.contours.last().and_then(|contour| contour.last()).copied().unwrap_or_default()
    }

    fn push(&mut self, place: Place) {
        if let Some(contour) = self.contours.last_mut() {
            contour.push(place);
        }
    }

    /// Line segments of a Bezier curve, by de Casteljau's algorithm.
    fn curve(&mut self, points: &[Place]) {
        for piece in 1..=PIECES {
            let share = f64::from(piece) / f64::from(PIECES);
            let mut level = points.to_vec();
            while level.len() > 1 {
                level = level.windows(2).map(|p| super::super::sheet::between(p[0], p[1], share)).collect();
            }
            self.push(level[0]);
        }
    }
}

fn at(x: f32, y: f32) -> Place {
    (f64::from(x), f64::from(y))
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.contours.push(vec![at(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.push(at(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.curve(&[self.last(), at(x1, y1), at(x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.curve(&[self.last(), at(x1, y1), at(x2, y2), at(x, y)]);
    }

    fn close(&mut self) {}
}
