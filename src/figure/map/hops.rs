//! The hop map.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError, Picture,
        bands::HopClasses,
        keys::{self, Swatch},
        palette::SMALL_MM,
        picture::paragraph,
        sheet::Sheet,
    },
    check_size,
    data::{HOPS_NO_DATA, HOPS_NOT_SEARCHED, HOPS_UNREACHABLE, HopMapFigure, MapPosts},
    panel::{MapPanel, end_keys, start_symbol},
    raster::{self, Pattern, Window, tone},
    unreached::{self, NO_HOP, NOT_REACHED},
};

const NO_WAY_BACK: &str = "reached, no path back to the start";
const NO_WAY_BACK_TO_ANY: &str = "reached, no path back to a start";
/// Posts beyond the hops that were searched, those reached without a path back, and those with a path to the start alone.
const NOT_SEARCHED: Pattern = Pattern::Striped;
const ONE_WAY: Pattern = Pattern::Striped;
const BACK_ONLY: Pattern = Pattern::Dashed;

/// The legend symbol of no-data: white in a thin frame.
pub(super) fn no_data_symbol(sheet: &mut Sheet, (x, y): (f64, f64)) {
    let corners = keys::rectangle((x - 3.0, y - 1.5), (x + 3.0, y + 1.5));
    let pen = super::super::sheet::Pen { colour: NOT_REACHED, width_mm: 0.15 };
    sheet.line(corners.iter().copied().chain([corners[0]]).collect(), pen);
}

/// Draws a hop map: the fewest hops to every post, over a hillshade with the sun in the north-west.
///
/// Bands of one count each, or of a round number of counts if there are more than seven; white: no data. Posts that are not reached are pale
/// under a pattern, which tells them from the bands in a print in grey too: those that refuse every contact in the tint and the pattern of
/// their reason ([`HopMapFigure::refused`]). With [`HopMapFigure::can_return`], bold stripes: reached, but the start cannot be reached from
/// there; dashes: not reached, but the start can be reached from there.
///
/// The map is cut to the posts that are reached, the starts, the goals and the paths, if that leaves out much of it; the legend counts all
/// posts. A window of more than 2 000 rows or columns is drawn with every n-th post. Both are said below it.
///
/// # Errors
/// [`FigureError::RasterSize`] if a raster does not have one value for every post.
pub fn draw_hop_map(figure: &HopMapFigure<'_>) -> Result<Picture, FigureError> {
    check_size("hop map", &figure.posts, figure.hops.len())?;
    if let Some(can_return) = figure.can_return {
        check_size("map of posts from which the start can be reached", &figure.posts, can_return.len())?;
    }
    for refused in &figure.refused {
        check_size("map of refused posts", &figure.posts, refused.posts.len())?;
    }
    let counts = Counts::of(figure);
    let mut tones: Vec<_> = (0..counts.bands.len()).map(|class| tone(counts.classes.colour(class))).collect();
    let not_reached = tones.len();
    tones.push(NOT_REACHED);
    let looks = unreached::looks(&figure.refused);
    tones.extend(looks.iter().map(|(tint, _)| *tint));
    let posts = figure.posts;
    let is_shown = |at: &usize| figure.hops[*at] >= 0 || figure.can_return.is_some_and(|can_return| can_return[*at]);
    let shown = (0..figure.hops.len()).filter(is_shown);
    let window = posts.window(shown, figure.starts.iter().copied(), &figure.goals, &figure.paths);
    let pixels = raster::draw(posts.dem, &window, &tones, |row, col| {
        let at = posts.index(row, col);
        let hops = figure.hops[at];
        let refused = || reason_of(figure, at).map_or(not_reached, |reason| not_reached + 1 + reason);
        let class = class_of(&counts.classes, hops).unwrap_or_else(refused);
        (hops != HOPS_NO_DATA).then(|| (class, pattern_of(figure, &looks, at)))
    });
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    let map = MapPanel::new(posts.dem, &window, top_mm);
    let end_mm = map.draw(&mut sheet, pixels);
    map.paths(&mut sheet, &figure.paths);
    map.ends(&mut sheet, &figure.starts, &figure.goals, &figure.paths);
    let mut entries = counts.keys(figure, &tones);
    let uncounted_starts = if counts.start == 0 { &figure.starts[..] } else { &[] };
    entries.extend(end_keys(uncounted_starts, &figure.goals, &figure.paths));
    let end_mm = keys::draw(&mut sheet, &entries, end_mm + 3.0);
    let height_mm = notes_on_counts(&mut sheet, &posts, &window, end_mm + 0.8) + 2.0;
    Ok(Picture::page(sheet, height_mm))
}

/// Draws the description of the raster; returns where it ends.
pub(super) fn notes(sheet: &mut Sheet, posts: &MapPosts<'_>, window: &Window, top_mm: f64) -> f64 {
    noted(sheet, posts, window, "", top_mm)
}

/// The same below a legend that counts posts or states shares of them: those of the DEM, also if less of it is drawn.
pub(super) fn notes_on_counts(sheet: &mut Sheet, posts: &MapPosts<'_>, window: &Window, top_mm: f64) -> f64 {
    noted(sheet, posts, window, "; the legend counts all of them", top_mm)
}

fn noted(sheet: &mut Sheet, posts: &MapPosts<'_>, window: &Window, counted: &str, top_mm: f64) -> f64 {
    let mut text = about_raster(posts, window);
    if *window != Window::whole(posts.dem) {
        let of_posts = |nodes: usize| nodes.div_ceil(posts.per_post.max(1));
        let (rows, cols) = (of_posts(posts.dem.rows()), of_posts(posts.dem.cols()));
        text = format!("{text} The DEM has {rows} x {cols} posts{counted}.");
    }
    paragraph(sheet, &text, SMALL_MM, false, top_mm)
}

/// The description of the raster: its posts, which of them have answers, and which are drawn.
pub(super) fn about_raster(posts: &MapPosts<'_>, window: &Window) -> String {
    let map = posts.dem.georeference();
    let spacing = |stride: usize| {
        let (x, y) = (map.dx_m(), map.dy_m());
        #[expect(clippy::cast_precision_loss, reason = "a stride")]
        let stride = stride as f64;
        let short = super::super::ticks::short;
        if x == y { format!("{} m", short(x * stride)) } else { format!("{} m by {} m", short(x * stride), short(y * stride)) }
    };
    // A window may be part of a raster, of which the posts between are counted.
    let of_posts = |nodes: usize| nodes.div_ceil(posts.per_post.max(1));
    let (rows, cols) = (of_posts(window.rows.len()), of_posts(window.cols.len()));
    let part = if *window == Window::whole(posts.dem) { "" } else { "part of the DEM, " };
    let mut text =
        format!("Terrain: {part}{rows} x {cols} posts, {} apart, lit from the north-west.", spacing(posts.per_post.max(1)));
    if posts.per_post > 1 {
        text = format!("{text} Answers for {} nodes a post spacing, {} apart.", posts.per_post, spacing(1));
    }
    if posts.stride > 1 {
        text = format!("{text} Answers for one post in {} each way, {} apart.", posts.stride, spacing(posts.stride));
    }
    if window.every() > 1 {
        text = format!("{text} Drawn: one {} in {} each way.", posts.node(), window.every());
    }
    text
}

/// The class of a post's hop count; `None` without one. The start, with no hop, has the colour of the first class.
fn class_of(classes: &HopClasses, hops: i16) -> Option<usize> {
    u64::try_from(hops).ok().map(|hops| classes.of(hops))
}

/// The number of the reason by which a post that is not reached refuses every contact.
fn reason_of(figure: &HopMapFigure<'_>, at: usize) -> Option<usize> {
    (figure.hops[at] == HOPS_UNREACHABLE).then(|| unreached::reason_of(&figure.refused, at)).flatten()
}

/// The pattern over a post's colour.
fn pattern_of(figure: &HopMapFigure<'_>, looks: &[(RGBColor, Pattern)], at: usize) -> Pattern {
    let hops = figure.hops[at];
    if let Some((_, pattern)) = reason_of(figure, at).and_then(|reason| looks.get(reason)) {
        return *pattern;
    }
    match figure.can_return.map(|can_return| can_return[at]) {
        _ if hops == HOPS_NOT_SEARCHED => NOT_SEARCHED,
        Some(false) if hops >= 0 => ONE_WAY,
        Some(true) if hops == HOPS_UNREACHABLE => BACK_ONLY,
        _ if hops == HOPS_UNREACHABLE => NO_HOP,
        _ => Pattern::Plain,
    }
}

/// The number of posts of each kind.
struct Counts {
    classes: HopClasses,
    start: u64,
    bands: Vec<u64>,
    not_reached: u64,
    no_data: u64,
    one_way: u64,
    back_only: u64,
    /// By reason.
    refused: Vec<u64>,
    not_searched: u64,
    asks_return: bool,
    several_starts: bool,
    /// What is counted.
    node: &'static str,
}

impl Counts {
    fn of(figure: &HopMapFigure<'_>) -> Self {
        let most = figure.hops.iter().filter_map(|&hops| u64::try_from(hops).ok()).max();
        // A start without any reachable post still has a band.
        let classes = HopClasses::up_to(most.map_or(0, |most| most.max(1)));
        let bands = vec![0; classes.0.len()];
        let asks_return = figure.can_return.is_some();
        let mut counts = Self {
            classes,
            start: 0,
            bands,
            not_reached: 0,
            no_data: 0,
            one_way: 0,
            back_only: 0,
            refused: vec![0; figure.refused.len()],
            not_searched: 0,
            asks_return,
            several_starts: figure.starts.len() > 1,
            node: figure.posts.node(),
        };
        for (at, &hops) in figure.hops.iter().enumerate() {
            let can_return = figure.can_return.map(|can_return| can_return[at]);
            if let Some(reason) = reason_of(figure, at) {
                counts.refused[reason] += 1;
                continue;
            }
            match class_of(&counts.classes, hops) {
                Some(_) if hops == 0 => counts.start += 1,
                Some(class) => counts.bands[class] += 1,
                None if hops == HOPS_NO_DATA => counts.no_data += 1,
                None if hops == HOPS_NOT_SEARCHED => counts.not_searched += 1,
                None => counts.not_reached += 1,
            }
            counts.one_way += u64::from(can_return == Some(false) && hops >= 0);
            counts.back_only += u64::from(can_return == Some(true) && hops == HOPS_UNREACHABLE);
        }
        counts
    }

    fn keys(&self, figure: &HopMapFigure<'_>, tones: &[RGBColor]) -> Vec<(Swatch, String)> {
        let texts = self.classes.texts();
        let (no_way_back, back_only) = if self.several_starts {
            (NO_WAY_BACK_TO_ANY, "not reached, but with a path to a start")
        } else {
            (NO_WAY_BACK, "not reached, but with a path to the start")
        };
        let bands =
            texts.iter().zip(&self.bands).zip(tones).map(|((text, count), &tone)| (Swatch::Fill(tone), text.as_str(), *count));
        let rest = [
            (NO_HOP.swatch(NOT_REACHED), unreached::rest_name(&figure.refused), self.not_reached),
            (NOT_SEARCHED.swatch(NOT_REACHED), "farther or not reachable, not searched", self.not_searched),
            (Swatch::Symbol(no_data_symbol), "no data", self.no_data),
            (ONE_WAY.swatch(tones[0]), no_way_back, self.one_way),
            (BACK_ONLY.swatch(NOT_REACHED), back_only, self.back_only),
        ];
        let start = (Swatch::Symbol(start_symbol), "start", self.start);
        let reasons: Vec<(Swatch, String)> = unreached::keys(&figure.refused).collect();
        let refused = reasons.iter().zip(&self.refused).map(|((swatch, reason), count)| (*swatch, reason.as_str(), *count));
        // A count of 0 posts without a return path is shown too, if return paths were requested.
        let is_told = |&(_, text, count): &(Swatch, &str, u64)| count > 0 || (self.asks_return && text == no_way_back);
        let all = std::iter::once(start).chain(bands).chain(rest).chain(refused).filter(is_told);
        all.map(|(swatch, text, count)| (swatch, format!("{text}: {count} {}{}", self.node, if count == 1 { "" } else { "s" })))
            .collect()
    }
}
