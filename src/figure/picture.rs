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
        self.draw_from(sheet, 0.0)
    }

    /// Draws the caption at the top of a page; returns where it ends.
    pub(super) fn draw_from(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        let mut y = top_mm + 3.0;
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

/// The least width of a picture, mm.
pub const WIDTH_MIN_MM: f64 = 40.0;
/// The greatest width of a picture, mm: a sheet of A0 on its long side.
pub const WIDTH_MAX_MM: f64 = 1189.0;
/// The greatest height of a page: that of A4 less margins of 20 mm, mm.
pub(super) const PAGE_HEIGHT_MM: f64 = 257.0;

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
    /// Where every page but the first begins, in ascending order.
    pub(super) breaks: Vec<PageBreak>,
}

/// Where a page begins on the sheet of all pages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PageBreak {
    /// Its upper edge, mm.
    pub(super) top_mm: f64,
    /// Its first mark and its first raster.
    first: (usize, usize),
}

impl PageBreak {
    /// A page that begins at a height with what is drawn from now on.
    pub(super) const fn at(sheet: &Sheet, top_mm: f64) -> Self {
        Self { top_mm, first: (sheet.marks.len(), sheet.images.len()) }
    }
}

impl Picture {
    /// A picture as wide as a page.
    pub(super) const fn page(sheet: Sheet, height_mm: f64) -> Self {
        Self { sheet, width_mm: PAGE_WIDTH_MM, height_mm, breaks: Vec::new() }
    }

    /// Its pages, each at most as high as the text of an A4 page, as pictures of their own; one for most pictures.
    ///
    /// Written without this, all pages are in one picture, one below the other.
    pub fn pages(&self) -> Vec<Self> {
        let start = PageBreak { top_mm: 0.0, first: (0, 0) };
        let end = PageBreak { top_mm: self.height_mm, first: (self.sheet.marks.len(), self.sheet.images.len()) };
        let all: Vec<PageBreak> = std::iter::once(start).chain(self.breaks.iter().copied()).chain([end]).collect();
        let page = |pair: &[PageBreak]| {
            let [from, to] = [pair[0], pair[1]];
            let part = Sheet {
                marks: self.sheet.marks[from.first.0..to.first.0].to_vec(),
                images: self.sheet.images[from.first.1..to.first.1].to_vec(),
            };
            Self { sheet: part.moved(-from.top_mm, 1.0), height_mm: to.top_mm - from.top_mm, breaks: Vec::new(), ..*self }
        };
        all.windows(2).map(page).collect()
    }

    /// The same picture in another width, mm: lines and letters as well become larger or smaller.
    ///
    /// # Errors
    /// [`FigureError::Width`] if it is not from [`WIDTH_MIN_MM`] to [`WIDTH_MAX_MM`].
    pub fn with_width_mm(&self, width_mm: f64) -> Result<Self, FigureError> {
        if !(WIDTH_MIN_MM..=WIDTH_MAX_MM).contains(&width_mm) {
            return Err(FigureError::Width { width_mm });
        }
        let by = width_mm / self.width_mm;
        let breaks = self.breaks.iter().map(|page| PageBreak { top_mm: by * page.top_mm, ..*page }).collect();
        Ok(Self { sheet: self.sheet.clone().moved(0.0, by), width_mm, height_mm: by * self.height_mm, breaks })
    }

    /// The picture as SVG, 170 mm wide unless [`Picture::with_width_mm`] gave another width. The same picture gives the same bytes.
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
