//! The map of a continuous value.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError, Picture,
        bands::{MOST_CLASSES, ramp},
        keys::{self, Swatch},
        palette::TEXT_MM,
        picture::paragraph,
        sheet::Sheet,
        ticks::short,
    },
    check_size,
    data::{MapPosts, ValueMapFigure},
    hops::{no_data_symbol, notes},
    panel::{MapPanel, end_keys},
    raster::{self, Pattern, Window, tone},
    unreached::{self, NO_HOP, NOT_REACHED},
};

/// The range of values is at least this many steps: with the parts of steps at its ends there are at most [`MOST_CLASSES`].
#[expect(clippy::cast_precision_loss, reason = "a handful of classes")]
const STEPS: f64 = (MOST_CLASSES - 1) as f64;

/// Draws a map of a continuous value, such as the least effort or the mobility, over a hillshade.
///
/// The values are drawn in at most seven classes between round numbers, light for low and dark for high; the least and the greatest value are
/// stated. Posts without a value are pale under a pattern, those that refuse every contact under that of their reason. The map is cut to the
/// posts with a value, the starts, the goals and the paths, if that leaves out much of it.
///
/// # Errors
/// [`FigureError::RasterSize`] if a raster does not have one value for every post.
pub fn draw_value_map(figure: &ValueMapFigure<'_>) -> Result<Picture, FigureError> {
    check_size("map of values", &figure.posts, figure.values.len())?;
    for refused in &figure.refused {
        check_size("map of refused posts", &figure.posts, refused.posts.len())?;
    }
    let posts = figure.posts;
    let steps = Steps::of(figure.values.iter().copied());
    let mut tones = steps.tones();
    let none = tones.len();
    let looks = unreached::looks(&figure.refused);
    tones.push(NOT_REACHED);
    tones.extend(looks.iter().map(|(tint, _)| *tint));
    let with_value = (0..figure.values.len()).filter(|at| figure.values[*at].is_finite());
    let window = posts.window(with_value, figure.starts.iter().copied(), &figure.goals, &figure.paths);
    let pixels = raster::draw(posts.dem, &window, &tones, |row, col| {
        let at = posts.index(row, col);
        let without = || match unreached::reason_of(&figure.refused, at) {
            Some(reason) => (none + 1 + reason, looks[reason].1),
            None => (none, NO_HOP),
        };
        (!posts.is_gap(at)).then(|| steps.class(figure.values[at]).map_or_else(without, |class| (class, Pattern::Plain)))
    });
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    let map = MapPanel::new(posts.dem, &window, top_mm);
    let end_mm = map.draw(&mut sheet, pixels);
    map.paths(&mut sheet, &figure.paths);
    map.ends(&mut sheet, &figure.starts, &figure.goals, &figure.paths);
    let colours = steps.described(&figure.value_name);
    let end_mm = paragraph(&mut sheet, &colours, TEXT_MM, false, end_mm + 0.5);
    let mut entries = steps.keys(&tones);
    entries.extend(figure.keys_without(&window));
    if window.has_gaps(posts.dem) {
        entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
    }
    entries.extend(end_keys(&figure.starts, &figure.goals, &figure.paths));
    let end_mm = keys::draw(&mut sheet, &entries, end_mm + 2.5);
    let height_mm = notes(&mut sheet, &posts, &window, end_mm + 0.8) + 2.0;
    Ok(Picture::page(sheet, height_mm))
}

impl ValueMapFigure<'_> {
    /// The legend of posts with an elevation but no value: those of a window.
    fn keys_without(&self, window: &Window) -> Vec<(Swatch, String)> {
        let (stride, cols) = (self.posts.stride.max(1), self.posts.size().1.max(1));
        let is_drawn = |at: usize| window.rows.contains(&(at / cols * stride)) && window.cols.contains(&(at % cols * stride));
        let without = |at: &usize| !self.values[*at].is_finite() && !self.posts.is_gap(*at) && is_drawn(*at);
        let mut found = vec![false; self.refused.len()];
        let mut rest = false;
        for at in (0..self.values.len()).filter(without) {
            match unreached::reason_of(&self.refused, at) {
                Some(reason) => found[reason] = true,
                None => rest = true,
            }
        }
        let rest = rest.then(|| (NO_HOP.swatch(NOT_REACHED), self.none_name.clone()));
        let reasons = unreached::keys(&self.refused).zip(found).filter_map(|(key, is_found)| is_found.then_some(key));
        rest.into_iter().chain(reasons).collect()
    }
}

/// Classes of a value between round numbers.
pub(super) struct Steps {
    /// The class boundaries, in ascending order; for a single value that value twice, without values empty.
    pub(super) ends: Vec<f64>,
    /// Whether each class is one whole number, that of its upper boundary.
    is_counted: bool,
    /// The least and the greatest value.
    range: Option<(f64, f64)>,
}

impl Steps {
    /// The classes of some values, of which only the finite ones count.
    pub(super) fn of(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = extremes(values);
        Self::between(low, high)
    }

    /// The least and the greatest value at two multiples of a step.
    fn between(low: f64, high: f64) -> Self {
        if low > high {
            return Self { ends: Vec::new(), is_counted: false, range: None };
        }
        let step = round_step((high - low) / STEPS);
        let (first, last) = (libm::floor(low / step + 1e-9), libm::ceil(high / step - 1e-9));
        let count = last - first;
        // Values far from zero and close to each other have no round numbers between them that doubles tell apart.
        let is_round = low < high && (1.0..=STEPS + 1.0).contains(&count) && (first + 1.0) * step > first * step;
        let ends = if is_round {
            std::iter::successors(Some(0.0), |i| Some(i + 1.0))
                .take_while(|i| *i <= count)
                .map(|i| (first + i) * step + 0.0)
                .collect()
        } else {
            vec![low, high]
        };
        Self { ends, is_counted: false, range: Some((low, high)) }
    }

    /// Classes of whole numbers: one for each where there are few.
    pub(super) fn of_counts(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = extremes(values);
        if low > high || high - low > STEPS {
            return Self::between(low, high);
        }
        // A class ends at its number and begins at the one before, below the least.
        let numbers = std::iter::successors(Some(low - 1.0), |number| Some(number + 1.0)).take_while(|number| *number <= high);
        Self { ends: numbers.collect(), is_counted: true, range: Some((low, high)) }
    }

    /// What the colours are, with the least and the greatest value where the classes do not say it.
    pub(super) fn described(&self, name: &str) -> String {
        match self.range.filter(|(low, high)| !self.is_counted && low < high) {
            Some((low, high)) => format!("Colours: {name}; from {} to {}", short(low), short(high)),
            None => format!("Colours: {name}"),
        }
    }

    /// The legend of the classes.
    pub(super) fn keys(&self, tones: &[RGBColor]) -> Vec<(Swatch, String)> {
        self.texts().into_iter().zip(tones).map(|(text, &tone)| (Swatch::Fill(tone), text)).collect()
    }

    fn count(&self) -> usize {
        self.ends.len().saturating_sub(1)
    }

    pub(super) fn class(&self, value: f64) -> Option<usize> {
        let above = || self.ends.iter().skip(1).position(|&end| value <= end);
        // A boundary is rounded: what lies above the last one by that much is in the last class.
        (value.is_finite() && self.count() > 0).then(|| above().unwrap_or(self.count() - 1))
    }

    #[expect(clippy::cast_precision_loss, reason = "some seven classes")]
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

/// The least of 1, 1.5, 2, 2.5, 3, 4, 5 times a power of ten that is at least the given value; 1 where that is no positive number.
fn round_step(least: f64) -> f64 {
    if !(least.is_finite() && least > 0.0) {
        return 1.0;
    }
    let power = libm::pow(10.0, libm::floor(libm::log10(least)));
    let steps = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 10.0].map(|step| step * power);
    steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// The least and the greatest of the finite values; infinite the wrong way round without any.
fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let finite = values.filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

impl MapPosts<'_> {
    /// The window of a map around some of its posts and the points on it, if that leaves out much of it; all posts without any of the posts.
    pub(super) fn window(
        &self,
        posts: impl Iterator<Item = usize>,
        starts: impl Iterator<Item = crate::quantity::MapPoint>,
        goals: &[super::GoalMark],
        paths: &[Vec<crate::quantity::MapPoint>],
    ) -> Window {
        let cols = self.size().1.max(1);
        let (mut low, mut high) = ((usize::MAX, usize::MAX), (0, 0));
        for at in posts {
            let (row, col) = (at / cols, at % cols);
            (low, high) = ((low.0.min(row), low.1.min(col)), (high.0.max(row), high.1.max(col)));
        }
        // A map of nothing but its start says where it is by the whole of it.
        if low.0 > high.0 || low == high {
            return Window::whole(self.dem);
        }
        let map = self.dem.georeference();
        let stride = self.stride.max(1);
        let corner = |(row, col): (usize, usize)| map.post(row * stride, col * stride);
        let marks = starts.chain(goals.iter().map(|goal| goal.at)).chain(paths.iter().flatten().copied());
        let bounds = self.dem.bounds();
        Window::around_most(self.dem, stride, marks.filter(|at| bounds.contains(*at)).chain([corner(low), corner(high)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_at_most_seven_between_round_numbers_and_every_value_has_one() {
        let mut state = 7_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            #[expect(clippy::cast_precision_loss, reason = "33 bits")]
            let found = (state >> 31) as f64 / (1_u64 << 33) as f64;
            found
        };
        for _ in 0..4000 {
            let size = libm::pow(10.0, 24.0 * uniform() - 12.0);
            let offset = if uniform() < 0.5 { 0.0 } else { 1000.0 * size * (uniform() - 0.5) };
            let values: Vec<f64> = (0..20).map(|_| offset + size * (uniform() - 0.3)).collect();
            let steps = Steps::of(values.iter().copied());
            assert!((3..=7).contains(&steps.count()), "{:?}", steps.ends);
            let step = steps.ends[1] - steps.ends[0];
            let power = libm::pow(10.0, libm::floor(libm::log10(step * (1.0 + 1e-6))));
            assert!(
                [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 10.0].iter().any(|round| (step / power - round).abs() < 1e-6),
                "{:?}",
                steps.ends
            );
            for end in &steps.ends {
                assert!((end / step - (end / step).round()).abs() < 1e-6, "no multiple of the step: {:?}", steps.ends);
            }
            for value in values {
                let class = steps.class(value).unwrap();
                let (from, to) = (steps.ends[class] - 1e-6 * step, steps.ends[class + 1] + 1e-6 * step);
                assert!((from..=to).contains(&value), "{value} in {:?}", steps.ends);
            }
        }
    }

    #[test]
    fn equal_values_and_counts_have_classes_of_their_own_and_no_number_none() {
        let of = |values: &[f64]| Steps::of(values.iter().copied());
        assert_eq!((of(&[3.25, 3.25]).texts(), of(&[3.25]).class(3.25)), (vec!["3.25".to_owned()], Some(0)));
        assert!(of(&[f64::NAN]).texts().is_empty() && of(&[]).class(1.0).is_none());
        // 1e16 and the next doubles.
        assert_eq!(of(&[1e16, 1e16 + 2.0]).class(1e16 + 2.0), Some(0));
        assert_eq!(of(&[0.0, 6.0]).class(f64::INFINITY), None);
        assert_eq!(Steps::of_counts([2.0, 4.0].into_iter()).texts(), ["2", "3", "4"]);
        assert_eq!(of(&[0.3, 6.2]).described("energy (J)"), "Colours: energy (J); from 0.3 to 6.2");
    }
}
