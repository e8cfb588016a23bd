//! The map of a continuous value.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError, Picture,
        bands::ramp,
        keys::{self, Swatch},
        palette::TEXT_MM,
        picture::paragraph,
        sheet::Sheet,
        ticks::{Ticks, short},
    },
    check_size,
    data::ValueMapFigure,
    hops::{NOT_REACHED, no_data_symbol, notes},
    panel::{MapPanel, end_keys},
    raster::{self, Pattern, Window, tone},
};

/// The greatest number of classes of a value.
const MOST_CLASSES: f64 = 9.0;

/// Draws a map of a continuous value, such as the least effort or the mobility, over a hillshade.
///
/// The values are drawn in up to ten classes between round numbers, light for low and dark for high.
///
/// # Errors
/// [`FigureError::RasterSize`] if the raster does not have one value for every post.
pub fn draw_value_map(figure: &ValueMapFigure<'_>) -> Result<Picture, FigureError> {
    check_size("map of values", &figure.posts, figure.values.len())?;
    let posts = figure.posts;
    let finite = || figure.values.iter().copied().filter(|value| value.is_finite());
    let steps = Steps::between(finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let mut tones = steps.tones();
    tones.push(NOT_REACHED);
    let window = Window::whole(posts.dem);
    let pixels = raster::draw(posts.dem, &window, &tones, |row, col| {
        let at = posts.index(row, col);
        (!posts.is_gap(at)).then(|| (steps.class(figure.values[at]).unwrap_or(tones.len() - 1), Pattern::Plain))
    });
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    let map = MapPanel::new(posts.dem, &window, top_mm);
    let end_mm = map.draw(&mut sheet, pixels);
    map.paths(&mut sheet, &figure.paths);
    map.ends(&mut sheet, &figure.starts, &figure.goals, &figure.paths);
    let end_mm = paragraph(&mut sheet, &format!("Colours: {}", figure.value_name), TEXT_MM, false, end_mm + 0.5);
    let mut entries: Vec<_> = steps.texts().into_iter().zip(&tones).map(|(text, &tone)| (Swatch::Fill(tone), text)).collect();
    let none = figure.values.iter().filter(|value| !value.is_finite()).count();
    let gaps = posts.gaps();
    if none > gaps {
        entries.push((Swatch::Fill(NOT_REACHED), figure.none_name.clone()));
    }
    if gaps > 0 {
        entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
    }
    entries.extend(end_keys(&figure.starts, &figure.goals, &figure.paths));
    let end_mm = keys::draw(&mut sheet, &entries, end_mm + 2.5);
    let height_mm = notes(&mut sheet, &posts, &window, end_mm + 0.8) + 2.0;
    Ok(Picture::page(sheet, height_mm))
}

/// Classes of a value between round numbers; the first and the last end at the extremes.
pub(super) struct Steps {
    /// The class boundaries, in ascending order; for a single value that value twice, without values empty.
    pub(super) ends: Vec<f64>,
    /// Whether each class is one whole number, that of its upper boundary.
    is_counted: bool,
}

impl Steps {
    pub(super) fn between(low: f64, high: f64) -> Self {
        if low > high {
            return Self { ends: Vec::new(), is_counted: false };
        }
        let inner = Ticks::round(low, high, MOST_CLASSES).values.into_iter().filter(|&value| low < value && value < high);
        Self { ends: std::iter::once(low).chain(inner).chain([high]).collect(), is_counted: false }
    }

    /// Classes of whole numbers: one for each where there are few.
    pub(super) fn of_counts(low: f64, high: f64) -> Self {
        if low > high || high - low >= MOST_CLASSES {
            return Self::between(low, high);
        }
        // A class ends at its number and begins at the one before, below the least.
        let numbers = std::iter::successors(Some(low - 1.0), |number| Some(number + 1.0)).take_while(|number| *number <= high);
        Self { ends: numbers.collect(), is_counted: true }
    }

    fn count(&self) -> usize {
        self.ends.len().saturating_sub(1)
    }

    pub(super) fn class(&self, value: f64) -> Option<usize> {
        let above = self.ends.iter().skip(1).position(|&end| value <= end);
        above.filter(|_| value.is_finite())
    }

    #[expect(clippy::cast_precision_loss, reason = "some ten classes")]
    pub(super) fn tones(&self) -> Vec<RGBColor> {
        let last = self.count().max(2) - 1;
        (0..self.count()).map(|class| tone(ramp(class as f64 / last as f64))).collect()
    }

    pub(super) fn texts(&self) -> Vec<String> {
        let text = |pair: &[f64]| {
            if pair[0] == pair[1] || self.is_counted { short(pair[1]) } else { format!("{} to {}", short(pair[0]), short(pair[1])) }
        };
        self.ends.windows(2).map(text).collect()
    }
}
