//! The key postures of the hops of a robot with legs, hop by hop in rows.

use nalgebra::Vector3;

use super::{
    Caption, FigureError, Picture,
    axes::Panel,
    keys::{self, Swatch},
    palette::{BLUE, LEFT_MM, RIGHT_MM, SMALL_MM, TEXT_MM, WHITE},
    robot_view::{LIMB_PEN, RobotMark, TRUNK, View},
    sheet::{Anchor, Hang, Label, Place, Sheet, text_width_mm},
    ticks::Ticks,
};

/// Between two panels.
const GAP_MM: f64 = 2.0;
/// Over a row, for the names of the postures.
const OVER_MM: f64 = 9.5;
/// Under a row, for its numbers.
const UNDER_MM: f64 = 6.0;
/// Rows of one picture, so that it fits a page of A4.
pub const POSTURE_ROWS_MAX: usize = 5;

/// A posture.
#[derive(Clone, Debug, PartialEq)]
pub struct PostureMark {
    /// Its name, and when it is.
    pub name: String,
    /// The robot, with the cut of the ground along the hop.
    pub robot: RobotMark,
}

/// The postures of a hop.
#[derive(Clone, Debug, PartialEq)]
pub struct PostureRow {
    /// Which hop, in words.
    pub title: String,
    /// The heading of the hop, degrees clockwise from +y: the direction to the right.
    pub heading_deg: f64,
    /// Its postures in their order.
    pub postures: Vec<PostureMark>,
}

/// What is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct PosturesFigure {
    /// The caption.
    pub caption: Caption,
    /// The hops.
    pub rows: Vec<PostureRow>,
}

/// Draws the key postures of hops, seen from the side of each hop, all at one scale.
///
/// # Errors
/// None for poses of finite numbers.
pub fn draw_postures(figure: &PosturesFigure) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let mut top_mm = keys::draw(&mut sheet, &entries(), head_mm + 2.0) + 3.0;
    let marks = figure.rows.iter().flat_map(|row| &row.postures);
    let size_m = marks.map(|posture| posture.robot.size_m()).fold(1e-9, f64::max);
    for (number, row) in (1..).zip(&figure.rows) {
        top_mm = draw_row(&mut sheet, row, size_m, (top_mm, number == figure.rows.len()));
    }
    Ok(Picture::page(sheet, top_mm + 4.0))
}

/// Draws a row, the last of them with the name of its axis; where it ends.
fn draw_row(sheet: &mut Sheet, row: &PostureRow, size_m: f64, (top_mm, is_last): (f64, bool)) -> f64 {
    let label =
        Label { bold: true, ..Label::new(row.title.as_str(), (LEFT_MM, top_mm + 2.0), TEXT_MM).hung(Anchor::Start, Hang::Below) };
    sheet.label(label);
    #[expect(clippy::cast_precision_loss, reason = "a handful of postures")]
    let count = row.postures.len().max(1) as f64;
    let width_mm = (RIGHT_MM - LEFT_MM - GAP_MM * (count - 1.0)) / count;
    let (sine, cosine) = libm::sincos(row.heading_deg.to_radians());
    let side = |at: Vector3<f64>| [at.x * sine + at.y * cosine, at.z];
    let top = top_mm + OVER_MM;
    let mut left = LEFT_MM;
    for (number, posture) in row.postures.iter().enumerate() {
        let panel = Panel { left, top, right: left + width_mm, bottom: top + width_mm };
        left += width_mm + GAP_MM;
        let view = View { panel, mm_per_m: 0.5 * width_mm / (1.05 * size_m), middle: [0.0; 2], flat: &side };
        let at = (f64::midpoint(panel.left, panel.right), panel.top - 0.8);
        sheet.label(Label::new(posture.name.as_str(), at, SMALL_MM).hung(Anchor::Middle, Hang::Above));
        view.ground(sheet, &posture.robot.cut);
        view.robot(sheet, &posture.robot, size_m);
        let is_named = is_last && number == row.postures.len() / 2;
        numbers(sheet, &view, number == 0, if is_named { "ahead of the root (m)" } else { "" });
        panel.outline(sheet);
    }
    top + width_mm + UNDER_MM
}

/// The numbers of the axes: those up at the first panel of a row alone, since all have one scale; those along within their panel, clear of its
/// neighbours.
fn numbers(sheet: &mut Sheet, view: &View<'_>, is_first: bool, name: &str) {
    let half_m = 0.5 * view.panel.width() / view.mm_per_m;
    let ticks = Ticks::round(-half_m, half_m, 5.0);
    let Panel { left, right, .. } = view.panel;
    let is_within = |(x, text): &(f64, String)| {
        let beside_mm = 0.5 * text_width_mm(text, SMALL_MM);
        x - beside_mm >= left && x + beside_mm <= right
    };
    let along: Vec<_> = ticks.values.iter().map(|value| (view.at([*value, 0.0]).0, ticks.text(*value))).filter(is_within).collect();
    view.panel.x_axis(sheet, &along, name, false);
    if is_first {
        let up: Vec<_> = ticks.values.iter().map(|value| (view.at([0.0, *value]).1, ticks.text(*value))).collect();
        view.panel.y_axis(sheet, &up, "over the root (m)", false);
    }
}

/// The legend.
fn entries() -> Vec<(Swatch, String)> {
    let stands = |sheet: &mut Sheet, at: Place| sheet.dot(at, 0.9, BLUE);
    let lifted = |sheet: &mut Sheet, at: Place| {
        sheet.dot(at, 0.8, BLUE);
        sheet.dot(at, 0.5, WHITE);
    };
    vec![
        (Swatch::Fill(TRUNK), "trunk".to_owned()),
        (Swatch::Line(LIMB_PEN), "limb".to_owned()),
        (Swatch::Symbol(stands), "foot on its foothold".to_owned()),
        (Swatch::Symbol(lifted), "foot off the ground, its limb drawn in".to_owned()),
    ]
}
