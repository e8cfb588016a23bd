//! A finished picture with its caption, and the two formats to write it in.

use std::path::Path;

use super::{
    FigureError, bitmap,
    palette::{PAGE_WIDTH_MM, RIGHT_MM, TEXT_MM, TITLE_MM},
    sheet::{Anchor, Hang, Label, Sheet, wrapped},
};

/// Left edge of texts.
pub(super) const MARGIN_MM: f64 = 4.0;
/// Line spacing as a multiple of the letter size.
const LEADING: f64 = 1.4;
/// Lines of bold letters, which are wider than estimated, are wrapped at this fraction of the width.
const BOLD: f64 = 0.88;

/// The caption above a picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Caption {
    /// The title in bold, such as the scenario's name; empty for none.
    pub title: String,
    /// Paragraphs below it: the question, the limits and the result.
    pub lines: Vec<String>,
}

impl Caption {
    /// A title and one line below it.
    pub fn new(title: impl Into<String>, line: impl Into<String>) -> Self {
        Self { title: title.into(), lines: vec![line.into()] }
    }

    /// Draws the caption at the top of a sheet; returns where it ends.
    pub(super) fn draw(&self, sheet: &mut Sheet) -> f64 {
        let mut y = 3.0;
        if !self.title.is_empty() {
            y = paragraph(sheet, &self.title, TITLE_MM, true, y);
        }
        for line in &self.lines {
            y = paragraph(sheet, line, TEXT_MM, false, y);
        }
        y + 1.5
    }
}

/// Draws a text, wrapped into lines; returns where it ends.
pub(super) fn paragraph(sheet: &mut Sheet, text: &str, size_mm: f64, bold: bool, top_mm: f64) -> f64 {
    let mut y = top_mm;
    let width = (RIGHT_MM - MARGIN_MM) * if bold { BOLD } else { 1.0 };
    for line in wrapped(text, size_mm, width) {
        let label = Label::new(line, (MARGIN_MM, y + 0.5 * LEADING * size_mm), size_mm).hung(Anchor::Start, Hang::Through);
        sheet.label(Label { bold, ..label });
        y += LEADING * size_mm;
    }
    y
}

/// A format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Vector graphics.
    Svg,
    /// Raster graphics.
    Png,
}

impl PictureFormat {
    /// The format of a file's extension: `.svg` or `.png`, in lower or upper case.
    ///
    /// # Errors
    /// [`FigureError::UnknownFormat`] for any other extension.
    pub fn of(file: &Path) -> Result<Self, FigureError> {
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(FigureError::UnknownFormat { file: file.display().to_string() }),
        }
    }
}

/// A picture that is drawn but not yet written.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub(super) sheet: Sheet,
    pub(super) width_mm: f64,
    pub(super) height_mm: f64,
}

impl Picture {
    /// A picture as wide as a page.
    pub(super) const fn page(sheet: Sheet, height_mm: f64) -> Self {
        Self { sheet, width_mm: PAGE_WIDTH_MM, height_mm }
    }

    /// The picture as SVG, 170 mm wide, or wider for sheets of many panels. The same picture gives the same bytes.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] with the error of plotters.
    pub fn to_svg(&self) -> Result<String, FigureError> {
        self.sheet.to_svg(self.width_mm, self.height_mm)
    }

    /// The picture as PNG at 300 dots an inch: a page of 170 mm is 2008 pixels wide. The same picture gives the same bytes on every
    /// machine, since the font is built in.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] if the picture is too large for the format.
    pub fn to_png(&self) -> Result<Vec<u8>, FigureError> {
        bitmap::render(&self.sheet, self.width_mm, self.height_mm)
    }

    /// The picture in the format of a file's extension: `.svg` or `.png`, in lower or upper case.
    ///
    /// # Errors
    /// As [`PictureFormat::of`], [`Picture::to_svg`] and [`Picture::to_png`].
    pub fn encoded_for(&self, file: &Path) -> Result<Vec<u8>, FigureError> {
        self.encoded(PictureFormat::of(file)?)
    }

    /// The picture in a format.
    ///
    /// # Errors
    /// As [`Picture::to_svg`] and [`Picture::to_png`].
    pub fn encoded(&self, format: PictureFormat) -> Result<Vec<u8>, FigureError> {
        match format {
            PictureFormat::Svg => Ok(self.to_svg()?.into_bytes()),
            PictureFormat::Png => self.to_png(),
        }
    }
}
