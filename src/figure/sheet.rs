//! The sheet: a list of marks in millimetres, and its rendering through plotters.
//!
//! plotters rounds every coordinate of an SVG to a whole unit, so the sheet counts in hundredths of a millimetre and the root
//! element gets its size in millimetres afterwards: curves then move in steps of 0.01 mm.

use base64::{Engine as _, engine::general_purpose::STANDARD};
use plotters::{
    drawing::DrawingAreaErrorKind,
    prelude::{
        Circle, FontStyle, FontTransform, IntoDrawingArea, PathElement, Polygon, RGBColor, SVGBackend, ShapeStyle, Text, WHITE,
    },
    style::{
        Color, IntoFont, TextStyle,
        text_anchor::{HPos, Pos, VPos},
    },
};

use super::{FigureError, bitmap::Pixels};

/// A position on the sheet, mm from the left and from the top.
pub(super) type Place = (f64, f64);

/// Units of the SVG per mm.
const UNITS_PER_MM: f64 = 100.0;

/// One mark on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    /// A line.
    Line { points: Vec<Place>, pen: Pen },
    /// A filled outline.
    Area { points: Vec<Place>, colour: RGBColor, opacity: f64 },
    /// A circle, filled or open.
    Dot { centre: Place, radius_mm: f64, pen: Pen, filled: bool },
    /// A text.
    Label(Label),
}

/// Colour and width of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pen {
    pub(super) colour: RGBColor,
    pub(super) width_mm: f64,
}

/// Horizontal anchor of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Vertical anchor of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hang {
    Below,
    Through,
    Above,
}

/// A text on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Label {
    pub(super) text: String,
    pub(super) at: Place,
    pub(super) size_mm: f64,
    pub(super) anchor: Anchor,
    pub(super) hang: Hang,
    pub(super) bold: bool,
    /// Reads upwards.
    pub(super) turned: bool,
    pub(super) colour: RGBColor,
}

impl Label {
    /// A black text that begins at a position.
    pub(super) fn new(text: impl Into<String>, at: Place, size_mm: f64) -> Self {
        Self {
            text: text.into(),
            at,
            size_mm,
            anchor: Anchor::Start,
            hang: Hang::Through,
            bold: false,
            turned: false,
            colour: super::palette::BLACK,
        }
    }

    /// The same text with other anchors.
    pub(super) fn hung(self, anchor: Anchor, hang: Hang) -> Self {
        Self { anchor, hang, ..self }
    }

    /// The same text, reading upwards.
    pub(super) fn turned(self) -> Self {
        Self { turned: true, ..self }
    }

    /// Left, top, right and bottom of the text, estimated, mm.
    pub(super) fn bounds_mm(&self) -> (f64, f64, f64, f64) {
        let width = text_width_mm(&self.text, self.size_mm);
        let (from, to) = match self.anchor {
            Anchor::Start => (0.0, width),
            Anchor::Middle => (-0.5 * width, 0.5 * width),
            Anchor::End => (-width, 0.0),
        };
        let (top, bottom) = match self.hang {
            Hang::Below => (0.0, self.size_mm),
            Hang::Through => (-0.5 * self.size_mm, 0.5 * self.size_mm),
            Hang::Above => (-self.size_mm, 0.0),
        };
        let (x, y) = self.at;
        if self.turned { (x + top, y - to, x + bottom, y - from) } else { (x + from, y + top, x + to, y + bottom) }
    }
}

/// The width of a text, estimated for a wide sans-serif font (`DejaVu Sans`), mm.
pub(super) fn text_width_mm(text: &str, size_mm: f64) -> f64 {
    let ems = text.chars().map(|letter| match letter {
        'i' | 'j' | 'l' | '.' | ',' | ';' | ':' | ' ' | '-' | '\'' | '(' | ')' => 0.34,
        'm' | 'w' | 'M' | 'W' | '≤' | '≥' | '=' => 0.92,
        '0'..='9' | 'A'..='Z' => 0.65,
        _ => 0.58,
    });
    ems.sum::<f64>() * size_mm
}

/// Units, which stay on the line of their number.
const UNITS: [&str; 9] = ["m", "s", "deg", "%", "m/s", "m/s²", "kg", "J/kg", "m/m"];

/// A text wrapped between words into lines of at most a given width; a number and its unit are one word.
pub(super) fn wrapped(text: &str, size_mm: f64, width_mm: f64) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let is_unit = UNITS.contains(&word.trim_end_matches([',', ';', '.', ':', ')']));
        match words.last_mut() {
            Some(number) if is_unit && number.ends_with(|last: char| last.is_ascii_digit()) => {
                number.push(' ');
                number.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
    }
    let mut lines: Vec<String> = Vec::new();
    for word in &words {
        match lines.last_mut() {
            Some(line) if text_width_mm(line, size_mm) + text_width_mm(word, size_mm) + size_mm <= width_mm => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.clone()),
        }
    }
    lines
}

/// A raster on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SheetImage {
    pub(super) left_mm: f64,
    pub(super) top_mm: f64,
    pub(super) width_mm: f64,
    pub(super) height_mm: f64,
    pub(super) pixels: Pixels,
}

/// The sheet of one figure, with marks from back to front.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Sheet {
    /// Rasters; they lie under all marks.
    pub(super) images: Vec<SheetImage>,
    pub(super) marks: Vec<Mark>,
}

impl Sheet {
    /// The same sheet moved down and then enlarged, with its lines and letters.
    pub(super) fn moved(mut self, down_mm: f64, by: f64) -> Self {
        let place = |(x, y): Place| (by * x, by * (y + down_mm));
        for image in &mut self.images {
            (image.left_mm, image.top_mm) = place((image.left_mm, image.top_mm));
            (image.width_mm, image.height_mm) = (by * image.width_mm, by * image.height_mm);
        }
        for mark in &mut self.marks {
            match mark {
                Mark::Line { points, pen } => {
                    pen.width_mm *= by;
                    for point in points.iter_mut() {
                        *point = place(*point);
                    }
                }
                Mark::Area { points, .. } => points.iter_mut().for_each(|point| *point = place(*point)),
                Mark::Dot { centre, radius_mm, pen, .. } => {
                    (*centre, *radius_mm) = (place(*centre), by * *radius_mm);
                    pen.width_mm *= by;
                }
                Mark::Label(label) => (label.at, label.size_mm) = (place(label.at), by * label.size_mm),
            }
        }
        self
    }

    /// Adds a line.
    pub(super) fn line(&mut self, points: Vec<Place>, pen: Pen) {
        self.marks.push(Mark::Line { points, pen });
    }

    /// Adds a dashed line.
    pub(super) fn dashed(&mut self, points: &[Place], dash_mm: f64, gap_mm: f64, pen: Pen) {
        for points in dashes(points, dash_mm, gap_mm) {
            self.line(points, pen);
        }
    }

    /// Adds a filled outline.
    pub(super) fn area(&mut self, points: Vec<Place>, colour: RGBColor, opacity: f64) {
        self.marks.push(Mark::Area { points, colour, opacity });
    }

    /// Adds a filled circle.
    pub(super) fn dot(&mut self, centre: Place, radius_mm: f64, colour: RGBColor) {
        self.marks.push(Mark::Dot { centre, radius_mm, pen: Pen { colour, width_mm: 0.1 }, filled: true });
    }

    /// Adds an open circle.
    pub(super) fn ring(&mut self, centre: Place, radius_mm: f64, pen: Pen) {
        self.marks.push(Mark::Dot { centre, radius_mm, pen, filled: false });
    }

    /// Adds a text.
    pub(super) fn label(&mut self, label: Label) {
        self.marks.push(Mark::Label(label));
    }

    /// Whether a text overlaps one already on the sheet.
    pub(super) fn is_taken(&self, label: &Label) -> bool {
        let (left, top, right, bottom) = label.bounds_mm();
        self.marks.iter().any(|mark| match mark {
            Mark::Label(other) => {
                let (l, t, r, b) = other.bounds_mm();
                left < r && l < right && top < b && t < bottom
            }
            _ => false,
        })
    }

    /// The sheet as SVG, its height rounded up to whole millimetres.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] with the error of plotters.
    pub(super) fn to_svg(&self, width_mm: f64, height_mm: f64) -> Result<String, FigureError> {
        // Whole millimetres, written without decimals.
        let height_mm = height_mm.ceil();
        let (width, height) = (units(width_mm).unsigned_abs(), units(height_mm).unsigned_abs());
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
            area.fill(&WHITE).map_err(|error| failed(&error))?;
            for mark in &self.marks {
                match mark {
                    Mark::Line { points, pen } => area.draw(&PathElement::new(in_units(points), stroke(*pen))),
                    Mark::Area { points, colour, opacity } => {
                        area.draw(&Polygon::new(in_units(points), colour.mix(*opacity).filled()))
                    }
                    Mark::Dot { centre, radius_mm, pen, filled } => {
                        area.draw(&Circle::new(place(*centre), units(*radius_mm), ShapeStyle { filled: *filled, ..stroke(*pen) }))
                    }
                    Mark::Label(label) => area.draw(&Text::new(label.text.as_str(), place(label.at), text_style(label))),
                }
                .map_err(|error| failed(&error))?;
            }
            area.present().map_err(|error| failed(&error))?;
        }
        let plain = format!("width=\"{width}\" height=\"{height}\" viewBox");
        let physical = format!("width=\"{width_mm}mm\" height=\"{height_mm:.0}mm\" viewBox");
        let svg = with_short_font_sizes(&svg.replacen(&plain, &physical, 1));
        self.with_images(svg)
    }

    /// An SVG with the rasters inserted after its first element, the white page: plotters itself would draw them as rectangles.
    fn with_images(&self, svg: String) -> Result<String, FigureError> {
        let Some(page_end) = svg.find("<rect").and_then(|at| svg[at..].find("/>").map(|end| at + end + 2)) else { return Ok(svg) };
        let mut out = svg[..page_end].to_owned();
        for image in &self.images {
            let sides = [("x", image.left_mm), ("y", image.top_mm), ("width", image.width_mm), ("height", image.height_mm)];
            out.push_str("\n<image xmlns:xlink=\"http://www.w3.org/1999/xlink\"");
            for (name, mm) in sides {
                out.extend([" ", name, "=\"", &units(mm).to_string(), "\""]);
            }
            out.push_str(" preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\"");
            out.extend([" xlink:href=\"data:image/png;base64,", &STANDARD.encode(image.pixels.to_png(None)?), "\"/>"]);
        }
        out.push_str(&svg[page_end..]);
        Ok(out)
    }
}

/// The error of plotters as a figure error.
fn failed(error: &DrawingAreaErrorKind<std::io::Error>) -> FigureError {
    FigureError::Drawing(error.to_string())
}

/// Millimetres in units of the SVG.
#[expect(clippy::cast_possible_truncation, reason = "a sheet is some thousand units wide; the cast saturates beyond")]
fn units(length_mm: f64) -> i32 {
    (length_mm * UNITS_PER_MM).round() as i32
}

fn place(at: Place) -> (i32, i32) {
    (units(at.0), units(at.1))
}

fn in_units(points: &[Place]) -> Vec<(i32, i32)> {
    let mut rounded: Vec<_> = points.iter().copied().map(place).collect();
    rounded.dedup();
    rounded
}

fn stroke(pen: Pen) -> ShapeStyle {
    ShapeStyle { color: pen.colour.to_rgba(), filled: false, stroke_width: units(pen.width_mm).unsigned_abs() }
}

fn text_style(label: &Label) -> TextStyle<'_> {
    let horizontal = match label.anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    let vertical = match label.hang {
        Hang::Below => VPos::Top,
        Hang::Through => VPos::Center,
        Hang::Above => VPos::Bottom,
    };
    // plotters divides font sizes by 1.24.
    let font = ("sans-serif", label.size_mm * UNITS_PER_MM * 1.24).into_font();
    let font = if label.bold { font.style(FontStyle::Bold) } else { font };
    let font = if label.turned { font.transform(FontTransform::Rotate270) } else { font };
    TextStyle::from(font).color(&label.colour).pos(Pos::new(horizontal, vertical))
}

/// Rounds font sizes to whole units, since the division by 1.24 leaves sixteen digits. Quotes in texts are escaped, so the
/// attribute's name with its quote occurs only in attributes.
fn with_short_font_sizes(svg: &str) -> String {
    const NAME: &str = "font-size=\"";
    let mut out = String::with_capacity(svg.len());
    for (i, part) in svg.split(NAME).enumerate() {
        if i == 0 {
            out.push_str(part);
            continue;
        }
        out.push_str(NAME);
        match part.split_once('"').and_then(|(size, rest)| Some((size.parse::<f64>().ok()?, rest))) {
            Some((size, rest)) => out.extend([&format!("{size:.0}"), "\"", rest]),
            None => out.push_str(part),
        }
    }
    out
}

/// The dashes of a line.
pub(super) fn dashes(points: &[Place], dash_mm: f64, gap_mm: f64) -> Vec<Vec<Place>> {
    let mut found = Vec::new();
    let (mut current, mut left_mm, mut drawing) = (Vec::new(), dash_mm, true);
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = libm::hypot(b.0 - a.0, b.1 - a.1);
        let mut at = 0.0;
        while at < length {
            let step = left_mm.min(length - at);
            if drawing {
                if current.is_empty() {
                    current.push(between(a, b, at / length));
                }
                current.push(between(a, b, (at + step) / length));
            }
            at += step;
            left_mm -= step;
            if left_mm <= 0.0 {
                if drawing {
                    found.push(std::mem::take(&mut current));
                }
                drawing = !drawing;
                left_mm = if drawing { dash_mm } else { gap_mm };
            }
        }
    }
    if current.len() > 1 {
        found.push(current);
    }
    found
}

/// Positions along a line at a given step in mm, the first after half a step, each with the line's direction; at least one.
pub(super) fn steps_along(points: &[Place], step_mm: f64) -> Vec<(Place, Place)> {
    let lengths: Vec<f64> = points.windows(2).map(|p| libm::hypot(p[1].0 - p[0].0, p[1].1 - p[0].1)).collect();
    let total: f64 = lengths.iter().sum();
    let mut next = 0.5 * step_mm.min(total);
    let mut behind = 0.0;
    let mut found = Vec::new();
    for (pair, &length) in points.windows(2).zip(&lengths) {
        while length > 0.0 && next <= behind + length {
            let ahead = ((pair[1].0 - pair[0].0) / length, (pair[1].1 - pair[0].1) / length);
            found.push((between(pair[0], pair[1], (next - behind) / length), ahead));
            next += step_mm;
        }
        behind += length;
    }
    found
}

/// The position at a fraction of the distance from one to another.
pub(super) fn between(a: Place, b: Place, fraction: f64) -> Place {
    (a.0 + (b.0 - a.0) * fraction, a.1 + (b.1 - a.1) * fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_cover_their_share_of_the_line() {
        let line = [(0.0, 0.0), (3.0, 4.0), (3.0, 9.0)];
        let found = dashes(&line, 1.0, 0.5);
        let length: f64 = found.iter().flat_map(|d| d.windows(2)).map(|p| (p[1].0 - p[0].0).hypot(p[1].1 - p[0].1)).sum();
        // 10 mm: six whole dashes of 1 mm up to 9 mm, then one of 1 mm.
        assert!((length - 7.0).abs() < 1e-9, "{length}");
    }

    #[test]
    fn steps_along_a_line_have_equal_spacing_and_short_lines_get_one() {
        let steps = steps_along(&[(0.0, 0.0), (10.0, 0.0)], 2.0);
        assert_eq!(steps.iter().map(|(p, _)| p.0).collect::<Vec<_>>(), [1.0, 3.0, 5.0, 7.0, 9.0]);
        assert_eq!(steps_along(&[(0.0, 0.0), (0.1, 0.0)], 2.0).len(), 1);
    }

    #[test]
    fn long_texts_break_between_words_only() {
        let lines = wrapped("one two three four", 2.0, 12.0);
        assert_eq!(lines.join(" "), "one two three four");
        assert!(lines.len() > 1 && lines.iter().all(|l| text_width_mm(l, 2.0) <= 12.0), "{lines:?}");
    }

    #[test]
    fn a_number_and_its_unit_stay_on_one_line() {
        let text = "take-off speed 6 m/s, drift 0.05 m; goal tolerance 3 m; 95 % of 20 hops";
        for width_mm in 10..60 {
            let lines = wrapped(text, 2.0, f64::from(width_mm));
            assert_eq!(lines.join(" "), text);
            for unit in ["m/s,", "m;", "%"] {
                assert!(lines.iter().all(|line| !line.starts_with(unit)), "{lines:?}");
            }
        }
    }
}
