//! Classes of posts over a hillshade, as a palette raster.

use std::ops::Range;

use plotters::style::RGBColor;

use super::{
    super::{
        bands::mixed,
        bitmap::{Form, Pixels},
        keys::Swatch,
        palette::WHITE,
    },
    hillshade::{LEVEL, brightness},
};
use crate::{quantity::MapPoint, terrain::Dem};

/// The greatest number of pixels per side; larger rasters are drawn with every n-th post, which the map says.
pub(super) const MOST_PIXELS: usize = 2000;
/// Small rasters get several pixels for each post, up to this many per side, so that stripes are fine and viewers do not blur
/// posts.
const ENOUGH_PIXELS: usize = 1000;
/// The greatest number of shades of each class: enough for a smooth appearance.
const SHADES: usize = 24;
/// Brightness of the darkest ground relative to level ground.
const DARKEST: f64 = 0.45;
/// Blend towards white of the brightest ground; with more, bright classes lose their hue.
const BRIGHTEST: f64 = 0.3;
/// Blend towards white of a class's colour in the legend and on level ground.
const LIGHTER: f64 = 0.1;
/// Period of stripes and dots on a raster of [`ENOUGH_PIXELS`] per side, pixels; in proportion on larger ones, so that it is the same on the
/// page.
const PERIOD: usize = 9;

/// A map is cut to what matters on it if that is at most this share of it: with more, the cut saves little and costs the overview.
const WORTH_A_CUT: f64 = 0.7;

/// A window of a DEM: ranges of rows and columns, each with an exclusive end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Window {
    pub(super) rows: Range<usize>,
    pub(super) cols: Range<usize>,
}

impl Window {
    /// All posts.
    pub(super) fn whole(dem: &Dem) -> Self {
        Self { rows: 0..dem.rows(), cols: 0..dem.cols() }
    }

    /// The posts around some points, with a margin of a tenth of their extent and at least four posts; all posts without a point.
    pub(super) fn around(dem: &Dem, places: impl Iterator<Item = MapPoint>) -> Self {
        let map = dem.georeference();
        let first = map.north_west();
        // Rows and columns as real numbers, increasing to the south and to the east.
        let posts = places.map(|at| ((first.y - at.y) / map.dy_m(), (at.x - first.x) / map.dx_m()));
        let (mut low, mut high) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        for (row, col) in posts.filter(|(row, col)| row.is_finite() && col.is_finite()) {
            (low, high) = ((low.0.min(row), low.1.min(col)), (high.0.max(row), high.1.max(col)));
        }
        if low.0 > high.0 {
            return Self::whole(dem);
        }
        let margin = (0.1 * (high.0 - low.0).max(high.1 - low.1)).max(4.0);
        Self { rows: span(low.0 - margin, high.0 + margin, dem.rows()), cols: span(low.1 - margin, high.1 + margin, dem.cols()) }
    }

    /// The posts around some points, of a map of which every `stride`-th post has an answer; all posts if that leaves out little, or if
    /// there are no points.
    pub(super) fn around_most(dem: &Dem, stride: usize, places: impl Iterator<Item = MapPoint>) -> Self {
        let (whole, part) = (Self::whole(dem), Self::around(dem, places));
        let wider = |range: &Range<usize>, count: usize| range.start.saturating_sub(stride)..(range.end + stride).min(count);
        let part = Self { rows: wider(&part.rows, dem.rows()), cols: wider(&part.cols, dem.cols()) };
        let posts = |window: &Self| window.rows.len().saturating_mul(window.cols.len());
        #[expect(clippy::cast_precision_loss, reason = "a share of posts")]
        let share = posts(&part) as f64 / posts(&whole).max(1) as f64;
        if share > WORTH_A_CUT { whole } else { part }
    }

    /// Whether one of the posts has no elevation.
    pub(super) fn has_gaps(&self, dem: &Dem) -> bool {
        self.rows.clone().any(|row| self.cols.clone().any(|col| dem.elevation(row, col).is_none()))
    }

    /// Every n-th post is drawn; this is n.
    pub(super) fn every(&self) -> usize {
        self.rows.len().max(self.cols.len()).div_ceil(MOST_PIXELS).max(1)
    }
}

/// The range of post indices between two real numbers, within `0..count`; the nearest post if none lies between.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and the ends are clipped to the posts"
)]
fn span(from: f64, to: f64, count: usize) -> Range<usize> {
    let last = count.saturating_sub(1);
    let (from, to) = ((from.floor() as usize).min(last), (to.ceil() as usize).min(last));
    from..to + 1
}

/// The pattern over a class's colour: it survives a print in grey.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pattern {
    Plain,
    /// Bold stripes that rise to the right, with white edges, so that they are seen on the darkest band too.
    Striped,
    /// Thin stripes that fall to the right.
    Falling,
    /// Bold stripes of both directions.
    Crossed,
    Dotted,
    /// Thin level lines.
    Level,
    /// Thin upright lines.
    Upright,
    /// Thin lines of both kinds.
    Grid,
    /// Thin level lines with gaps.
    Dashed,
}

/// What a pattern puts over a pixel of its class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ink {
    Black,
    White,
}

impl Pattern {
    /// The ink over a pixel, of a pattern with a period of so many pixels.
    fn ink(self, column: usize, row: usize, period: usize) -> Option<Ink> {
        let thin = (period / PERIOD).max(1);
        let (c, r) = (column % period, row % period);
        // A step back by one row, modulo the period, as a step of one less than the period forward, since rows are unsigned.
        let (rising, falling) = ((column + row) % period, (column + (period - 1) * row) % period);
        let is_black = match self {
            Self::Plain => false,
            Self::Striped if rising >= 2 * thin && (rising < 3 * thin || rising >= period - thin) => return Some(Ink::White),
            Self::Striped => rising < 2 * thin,
            Self::Falling => falling < thin,
            Self::Crossed => rising < 2 * thin || falling < 2 * thin,
            Self::Dotted => c < 3 * thin && r < 3 * thin && (column / period + row / period).is_multiple_of(2),
            Self::Level => r < thin,
            Self::Upright => c < thin,
            Self::Grid => r < thin || c < thin,
            Self::Dashed => r < thin && (column / period + row / period).is_multiple_of(2),
        };
        is_black.then_some(Ink::Black)
    }

    /// The sample of a legend for this pattern over a colour.
    pub(super) const fn swatch(self, colour: RGBColor) -> Swatch {
        match self {
            Self::Plain => Swatch::Fill(colour),
            Self::Striped => Swatch::Striped(colour),
            Self::Falling => Swatch::Falling(colour),
            Self::Crossed => Swatch::Crossed(colour),
            Self::Dotted => Swatch::Dotted(colour),
            Self::Level => Swatch::Level(colour),
            Self::Upright => Swatch::Upright(colour),
            Self::Grid => Swatch::Grid(colour),
            Self::Dashed => Swatch::DashedOver(colour),
        }
    }
}

/// Colour of a class in a legend: slightly lighter than the pure colour, so that stripes over it are visible.
pub(super) fn tone(colour: RGBColor) -> RGBColor {
    mixed(colour, WHITE, LIGHTER)
}

/// Draws a class for each post over the hillshade, white without an elevation or class.
///
/// `class` returns, for a row and a column of the DEM, the index of its colour in `tones` and its pattern.
pub(super) fn draw(
    dem: &Dem,
    window: &Window,
    tones: &[RGBColor],
    class: impl Fn(usize, usize) -> Option<(usize, Pattern)>,
) -> Pixels {
    let every = window.every();
    let side = window.rows.len().max(window.cols.len());
    let up = if every > 1 { 1 } else { (ENOUGH_PIXELS / side.max(1)).max(1) };
    let (rows, cols) = (window.rows.len().div_ceil(every), window.cols.len().div_ceil(every));
    let period = (PERIOD * rows.max(cols) * up / ENOUGH_PIXELS).max(PERIOD);
    // White for no-data and black for patterns come first.
    let shades = ((256 - 2) / tones.len().max(1)).clamp(1, SHADES);
    let mut colours = vec![[255; 3], [0; 3]];
    for &tone in tones {
        colours.extend((0..shades).map(|shade| shaded(tone, shade, shades)));
    }
    let mut bytes = Vec::with_capacity(rows * cols * up * up);
    for row in 0..rows {
        let line: Vec<_> = (0..cols)
            .map(|col| {
                let at = (window.rows.start + row * every, window.cols.start + col * every);
                let light = mean_brightness(dem, at, every);
                let Some(((tone, pattern), light)) = class(at.0, at.1).zip(light) else { return (0, Pattern::Plain) };
                (u8::try_from(2 + tone * shades + shade_of(light, shades)).unwrap_or(0), pattern)
            })
            .collect();
        for down in 0..up {
            for (col, &(index, pattern)) in line.iter().enumerate() {
                let ink = |along| pattern.ink(col * up + along, row * up + down, period).filter(|_| index != 0);
                bytes.extend((0..up).map(|along| match ink(along) {
                    Some(Ink::White) => 0,
                    Some(Ink::Black) => 1,
                    None => index,
                }));
            }
        }
    }
    Pixels { width: cols * up, height: rows * up, form: Form::Palette(colours), bytes }
}

/// The mean brightness of the posts that a pixel represents; `None` if its own post has no elevation.
#[expect(clippy::cast_precision_loss, reason = "a few hundred posts")]
fn mean_brightness(dem: &Dem, (row, col): (usize, usize), every: usize) -> Option<f64> {
    let own = brightness(dem, row, col)?;
    if every == 1 {
        return Some(own);
    }
    let posts = (row..row + every).flat_map(|row| (col..col + every).map(move |col| (row, col)));
    let (sum, count) = posts
        .filter_map(|(row, col)| brightness(dem, row, col))
        .fold((0.0, 0usize), |(sum, count), light| (sum + light, count + 1));
    Some(sum / count as f64)
}

/// The shade of a brightness, 0 to 1.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "at most 24 shades")]
fn shade_of(light: f64, shades: usize) -> usize {
    ((light * shades as f64) as usize).min(shades - 1)
}

/// A colour in a shade: level ground has the colour itself, ground facing the sun is lighter, ground facing away darker.
#[expect(clippy::cast_precision_loss, reason = "at most 24 shades")]
fn shaded(tone: RGBColor, shade: usize, shades: usize) -> [u8; 3] {
    let light = if shades == 1 { LEVEL } else { (shade as f64 + 0.5) / shades as f64 };
    let RGBColor(r, g, b) = if light <= LEVEL {
        mixed(RGBColor(0, 0, 0), tone, DARKEST + (1.0 - DARKEST) * light / LEVEL)
    } else {
        mixed(tone, WHITE, BRIGHTEST * (light - LEVEL) / (1.0 - LEVEL))
    };
    [r, g, b]
}

#[cfg(test)]
mod tests {
    use super::{super::super::bands::ramp, *};
    use crate::figure::map::unreached::NOT_REACHED;

    /// CIE L*a*b* of an sRGB colour under D65: lightness 0 to 100, and two colour axes whose norm is the chroma.
    fn lab([r, g, b]: [u8; 3]) -> [f64; 3] {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
        };
        let (r, g, b) = (linear(r), linear(g), linear(b));
        let root = |t: f64| if t > 0.008_856 { libm::cbrt(t) } else { 7.787 * t + 16.0 / 116.0 };
        let x = root((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.95047);
        let y = root(0.2126 * r + 0.7152 * g + 0.0722 * b);
        let z = root((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.08883);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    #[test]
    fn no_band_in_any_light_is_mistaken_for_not_reached_in_any_light() {
        let white = lab([255, 255, 255]);
        let grey: Vec<_> = (0..SHADES).map(|shade| lab(shaded(NOT_REACHED, shade, SHADES))).collect();
        assert!(grey.iter().all(|&grey| difference(grey, white) > 8.0), "not reached is not no-data");
        for step in 0..=35 {
            let band = tone(ramp(f64::from(step) / 35.0));
            for shade in 0..SHADES {
                let seen = lab(shaded(band, shade, SHADES));
                let colourful = libm::hypot(seen[1], seen[2]);
                assert!(colourful > 12.0, "band {step} in light {shade} is grey: {seen:?}");
                // A difference of 2 is just visible side by side, one of 10 at a glance.
                let nearest = grey.iter().map(|&grey| difference(seen, grey)).fold(f64::INFINITY, f64::min);
                assert!(nearest > 16.0, "band {step} in light {shade}: {nearest} from not reached");
                assert!(difference(seen, grey[shade]) > 19.0, "band {step} in light {shade}, side by side");
                assert!(difference(seen, white) > 25.0, "band {step} in light {shade} is not no-data");
            }
        }
    }
}
