//! Where a robot with legs stands, which ways it may jump, and how many hops lead there: maps one under another.

use super::{
    super::{
        FigureError, Picture,
        keys::{self, Swatch},
        palette::TEXT_MM,
        picture::{Caption, paragraph},
        sheet::Sheet,
    },
    check_size,
    data::{GoalMark, MapPosts},
    hops::{no_data_symbol, notes},
    panel::{MapPanel, end_keys},
    raster::{self, Pattern, Window},
    unreached::{NO_HOP, NOT_REACHED},
    values::Steps,
};
use crate::quantity::MapPoint;

/// The height that all maps share on a page of A4.
const TALL_MM: f64 = 138.0;

/// One map.
#[derive(Clone, Debug)]
pub struct LegsMapLayer {
    /// The name of its values with their unit.
    pub name: String,
    /// The values, row after row; NaN where it does not stand, or no hop leads.
    pub values: Vec<f64>,
    /// The meaning of NaN at a node with an elevation.
    pub none_name: String,
    /// Whether the values are counts, each with a colour of its own where there are few.
    pub counts: bool,
}

/// The picture of a map of a robot with legs.
#[derive(Clone, Debug)]
pub struct LegsMapFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// Terrain and nodes.
    pub posts: MapPosts<'a>,
    /// The maps.
    pub layers: Vec<LegsMapLayer>,
    /// The starts.
    pub starts: Vec<MapPoint>,
    /// The goals.
    pub goals: Vec<GoalMark>,
}

/// Draws the maps of a robot with legs.
///
/// # Errors
/// [`FigureError::RasterSize`] if a raster does not have one value for every node.
pub fn draw_legs_map(figure: &LegsMapFigure<'_>) -> Result<Picture, FigureError> {
    for layer in &figure.layers {
        check_size("map of values", &figure.posts, layer.values.len())?;
    }
    let mut sheet = Sheet::default();
    let mut end_mm = figure.caption.draw(&mut sheet);
    for layer in &figure.layers {
        end_mm = figure.layer(&mut sheet, layer, end_mm + 2.0);
    }
    let height_mm = notes(&mut sheet, &figure.posts, &Window::whole(figure.posts.dem), end_mm + 0.8) + 2.0;
    Ok(Picture::page(sheet, height_mm))
}

impl LegsMapFigure<'_> {
    /// One of the maps; returns where it ends.
    fn layer(&self, sheet: &mut Sheet, layer: &LegsMapLayer, top_mm: f64) -> f64 {
        let (posts, window) = (self.posts, Window::whole(self.posts.dem));
        let values = layer.values.iter().copied();
        let steps = if layer.counts { Steps::of_counts(values) } else { Steps::of(values) };
        let mut tones = steps.tones();
        tones.push(NOT_REACHED);
        let none = tones.len() - 1;
        let pixels = raster::draw(posts.dem, &window, &tones, |row, col| {
            let at = posts.index(row, col);
            (!posts.is_gap(at)).then(|| steps.class(layer.values[at]).map_or((none, NO_HOP), |class| (class, Pattern::Plain)))
        });
        #[expect(clippy::cast_precision_loss, reason = "two or three maps")]
        let map = MapPanel::at_most(posts.dem, &window, top_mm, TALL_MM / self.layers.len().max(1) as f64);
        let end_mm = map.draw(sheet, pixels);
        map.ends(sheet, &self.starts, &self.goals, &[]);
        let end_mm = paragraph(sheet, &steps.described(&layer.name), TEXT_MM, false, end_mm + 0.5);
        let mut entries = steps.keys(&tones);
        let (without, gaps) = (layer.values.iter().filter(|value| !value.is_finite()).count(), posts.gaps());
        if without > gaps {
            entries.push((NO_HOP.swatch(NOT_REACHED), layer.none_name.clone()));
        }
        if gaps > 0 {
            entries.push((Swatch::Symbol(no_data_symbol), "no data".to_owned()));
        }
        entries.extend(end_keys(&self.starts, &self.goals, &[]));
        keys::draw(sheet, &entries, end_mm + 2.5)
    }
}
