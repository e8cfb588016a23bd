//! Where a machine gets by driving, by hops, and by both together; and what the missions take.

use plotters::style::RGBColor;

use super::{
    super::{
        FigureError, Picture,
        keys::{self, Swatch},
        palette::{BLUE, ORANGE, PURPLE, SKY, TEXT_MM},
        picture::{Caption, paragraph},
        sheet::Sheet,
    },
    check_size,
    data::{GoalMark, MapPosts},
    hops::{no_data_symbol, notes_on_counts},
    panel::{MapPanel, end_keys},
    raster::{self, Pattern, Window, tone},
    unreached::{NO_HOP, NOT_REACHED},
    values::Steps,
};
use crate::quantity::MapPoint;

/// The greatest height of each of the two maps, which share a page of A4.
const TALL_MM: f64 = 78.0;

/// The classes of reach: colours that differ in lightness too, and patterns, so that they differ in print.
const CLASSES: [(RGBColor, Pattern, &str); 4] = [
    (SKY, Pattern::Plain, "by driving alone, and by hops alone"),
    (BLUE, Pattern::Striped, "by driving alone, not by hops alone"),
    (ORANGE, Pattern::Dotted, "by hops alone, not by driving alone"),
    (PURPLE, Pattern::Crossed, "by both together, by neither alone"),
];

/// The picture of a map of missions.
#[derive(Clone, Debug)]
pub struct TravelMapFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// Terrain and nodes.
    pub posts: MapPosts<'a>,
    /// The class of every node, row after row: 0 by driving alone and by hops alone, 1 by driving alone, 2 by hops alone, 3 by both
    /// together; `None` where none leads.
    pub classes: &'a [Option<usize>],
    /// The name of class 0 where it is the only one, since the machine does not do both.
    pub only: Option<&'static str>,
    /// What the missions take to every node, row after row; NaN where none leads.
    pub values: &'a [f64],
    /// The name of the values with their unit, such as `least mission time (s)`.
    pub value_name: String,
    /// The starts.
    pub starts: Vec<MapPoint>,
    /// The goals.
    pub goals: Vec<GoalMark>,
}

/// Draws a map of missions: which means lead to each node, and what the missions take.
///
/// # Errors
/// [`FigureError::RasterSize`] if a raster does not have one value for every node.
pub fn draw_travel_map(figure: &TravelMapFigure<'_>) -> Result<Picture, FigureError> {
    check_size("map of means of travel", &figure.posts, figure.classes.len())?;
    check_size("map of values", &figure.posts, figure.values.len())?;
    let mut sheet = Sheet::default();
    let top_mm = figure.caption.draw(&mut sheet);
    let end_mm = figure.means(&mut sheet, top_mm);
    let end_mm = figure.taken(&mut sheet, end_mm + 2.0);
    let height_mm = notes_on_counts(&mut sheet, &figure.posts, &figure.window(), end_mm + 0.8) + 2.0;
    Ok(Picture::page(sheet, height_mm))
}

impl TravelMapFigure<'_> {
    /// The part of the map that is drawn: the reached nodes, the starts and the goals.
    fn window(&self) -> Window {
        let reached = (0..self.classes.len()).filter(|at| self.classes[*at].is_some());
        self.posts.window(reached, self.starts.iter().copied(), &self.goals, &[])
    }

    /// One of the maps; returns where it ends.
    fn map(&self, sheet: &mut Sheet, top_mm: f64, tones: &[RGBColor], class: impl Fn(usize) -> (usize, Pattern)) -> f64 {
        let posts = self.posts;
        let window = self.window();
        let pixels = raster::draw(posts.dem, &window, tones, |row, col| {
            let at = posts.index(row, col);
            (!posts.is_gap(at)).then(|| class(at))
        });
        let map = MapPanel::at_most(posts.dem, &window, top_mm, TALL_MM);
        let end_mm = map.draw(sheet, pixels);
        map.ends(sheet, &self.starts, &self.goals, &[]);
        end_mm
    }

    /// The share of all nodes with an elevation that is of a kind, in words.
    #[expect(clippy::cast_precision_loss, reason = "counts of nodes stay far below 2^53")]
    fn share(&self, is_one: impl Fn(&Option<usize>) -> bool) -> Option<String> {
        let known = self.classes.len() - self.posts.gaps();
        let count = self.classes.iter().enumerate().filter(|(at, class)| !self.posts.is_gap(*at) && is_one(class)).count();
        (count > 0).then(|| format!("{:.1} %", 100.0 * count as f64 / known.max(1) as f64))
    }

    fn means(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        let mut tones: Vec<RGBColor> = CLASSES.iter().map(|(colour, ..)| tone(*colour)).collect();
        tones.push(NOT_REACHED);
        let none = CLASSES.len();
        let top_mm = paragraph(sheet, "By which means", TEXT_MM, true, top_mm + 0.5);
        let end_mm = self.map(sheet, top_mm, &tones, |at| match self.classes[at] {
            Some(class) => (class, CLASSES[class].1),
            None => (none, NO_HOP),
        });
        let mut entries = Vec::new();
        for (class, (_, pattern, words)) in CLASSES.iter().enumerate() {
            let words = self.only.filter(|_| class == 0).unwrap_or(words);
            if let Some(share) = self.share(|found| *found == Some(class)) {
                entries.push((pattern.swatch(tones[class]), format!("{words}: {share}")));
            }
        }
        if let Some(share) = self.share(Option::is_none) {
            entries.push((NO_HOP.swatch(NOT_REACHED), format!("not reached over these nodes: {share}")));
        }
        if self.posts.gaps() > 0 {
            entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
        }
        entries.extend(end_keys(&self.starts, &self.goals, &[]));
        keys::draw(sheet, &entries, end_mm + 2.5)
    }

    fn taken(&self, sheet: &mut Sheet, top_mm: f64) -> f64 {
        let steps = Steps::of(self.values.iter().copied());
        let mut tones = steps.tones();
        tones.push(NOT_REACHED);
        let none = tones.len() - 1;
        let top_mm = paragraph(sheet, "What the missions take", TEXT_MM, true, top_mm + 0.5);
        let end_mm = self
            .map(sheet, top_mm, &tones, |at| steps.class(self.values[at]).map_or((none, NO_HOP), |class| (class, Pattern::Plain)));
        let end_mm = paragraph(sheet, &steps.described(&self.value_name), TEXT_MM, false, end_mm + 0.5);
        keys::draw(sheet, &steps.keys(&tones), end_mm + 2.5)
    }
}
