//! A path of a wheeled jumper among boxes, from above.

use plotters::style::RGBColor;

use super::{
    Caption, FigureError, Picture, arena_tree,
    axes::{BELOW_MM, Panel, left_room_mm},
    keys::{self, Swatch, rectangle},
    map::{goal_symbol, missed_symbol, start_symbol},
    palette::{BLUE, LEFT_MM, PURPLE, RIGHT_MM, SMALL_MM, TEXT_MM, VERMILION, WHITE},
    sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm},
    ticks::{Ticks, short},
};
use crate::{
    arena::{Arena, ArenaBox, ArenaPath, GrownTree, Move},
    quantity::MapPoint,
};

/// Driving: solid.
const DRIVE_PEN: Pen = Pen { colour: BLUE, width_mm: 0.6 };
/// Jumping: dashed.
const JUMP_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.8 };
const JUMP_DASH_MM: (f64, f64) = (1.0, 0.6);
/// Dropping: dotted.
const DROP_PEN: Pen = Pen { colour: PURPLE, width_mm: 0.8 };
const DROP_DASH_MM: (f64, f64) = (0.3, 0.5);
/// Around every line, so that it stands out from boxes.
const HALO_MM: f64 = 1.3;
const EDGE_PEN: Pen = Pen { colour: RGBColor(70, 70, 70), width_mm: 0.15 };
/// Between two panels.
const GAP_MM: f64 = 15.0;
/// The highest panel, and the widest one that stands alone.
const HIGHEST_MM: f64 = 130.0;
const ALONE_MM: f64 = 105.0;

/// One view of the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct ArenaPanel<'a> {
    /// What it shows, above it.
    pub name: String,
    /// The path; `None`: none was found.
    pub path: Option<&'a ArenaPath>,
    /// The tree of RRT* under it.
    pub tree: Option<&'a GrownTree>,
}

/// One or two views of an arena.
#[derive(Clone, Debug, PartialEq)]
pub struct ArenaFigure<'a> {
    /// The caption.
    pub caption: Caption,
    /// The arena.
    pub arena: &'a Arena,
    /// The views, side by side.
    pub panels: Vec<ArenaPanel<'a>>,
    /// A time that no path beats, s, drawn where the time of RRT* is.
    pub lower_bound_s: Option<f64>,
}

/// Draws the floor from above: boxes darker the higher they are, driving solid, jumps dashed with a triangle where they land, drops dotted with a ring; of
/// RRT* the tree by kind of edge, and below the time of its path as the nodes grow.
///
/// # Errors
/// None for a valid arena.
pub fn draw_arena(figure: &ArenaFigure<'_>) -> Result<Picture, FigureError> {
    let mut sheet = Sheet::default();
    let head_mm = figure.caption.draw(&mut sheet);
    let mut top_mm = keys::draw(&mut sheet, &entries(figure), head_mm + 2.0) + 1.5;
    top_mm += TEXT_MM + 1.5;
    let count = figure.panels.len().max(1);
    #[expect(clippy::cast_precision_loss, reason = "one or two panels")]
    let width_mm = if count == 1 { ALONE_MM } else { (RIGHT_MM - LEFT_MM - GAP_MM * (count - 1) as f64) / count as f64 };
    let [size_x_m, size_y_m] = figure.arena.size_m();
    let mm_per_m = (width_mm / size_x_m).min(HIGHEST_MM / size_y_m);
    let mut bottom_mm = top_mm;
    let mut left_mm = LEFT_MM;
    for view in &figure.panels {
        let panel =
            Panel { left: left_mm, top: top_mm, right: left_mm + mm_per_m * size_x_m, bottom: top_mm + mm_per_m * size_y_m };
        View { panel, mm_per_m }.draw(&mut sheet, figure.arena, view);
        bottom_mm = panel.bottom + BELOW_MM;
        left_mm += width_mm + GAP_MM;
    }
    let tree = figure.panels.iter().find_map(|view| view.tree);
    if let Some(tree) = tree.filter(|tree| tree.history.iter().any(|(_, time_s)| time_s.is_some())) {
        bottom_mm = arena_tree::draw_history(&mut sheet, tree, figure.lower_bound_s, bottom_mm + 2.0);
    }
    Ok(Picture::page(sheet, bottom_mm + 1.0))
}

/// A panel at a scale.
struct View {
    panel: Panel,
    mm_per_m: f64,
}

impl View {
    fn place(&self, point: MapPoint) -> Place {
        (self.panel.left + self.mm_per_m * point.x, self.panel.bottom - self.mm_per_m * point.y)
    }

    fn draw(&self, sheet: &mut Sheet, arena: &Arena, view: &ArenaPanel<'_>) {
        let [size_x_m, size_y_m] = arena.size_m();
        let at = (f64::midpoint(self.panel.left, self.panel.right), self.panel.top - 1.2);
        sheet.label(Label { bold: true, ..Label::new(view.name.as_str(), at, TEXT_MM).hung(Anchor::Middle, Hang::Above) });
        let ticks = |size_m: f64, most: f64| Ticks::round(0.0, size_m, most);
        let (x, y) = (ticks(size_x_m, 5.0), ticks(size_y_m, 5.0));
        let named = |ticks: &Ticks, place: &dyn Fn(f64) -> f64| -> Vec<(f64, String)> {
            ticks.values.iter().map(|value| (place(*value), ticks.text(*value))).collect()
        };
        let xs = named(&x, &|at| self.panel.left + self.mm_per_m * at);
        let ys = named(&y, &|at| self.panel.bottom - self.mm_per_m * at);
        self.panel.x_axis(sheet, &xs, "x (m)", true);
        let name = if left_room_mm(&y) < self.panel.left { "y (m)" } else { "" };
        self.panel.y_axis(sheet, &ys, name, true);
        self.boxes(sheet, arena);
        if let Some(tree) = view.tree {
            arena_tree::draw_edges(sheet, tree, &|point| self.place(point));
        }
        if let Some(path) = view.path {
            self.path(sheet, path);
        }
        start_symbol(sheet, self.place(arena.start()));
        let goal = if view.path.is_some() { goal_symbol } else { missed_symbol };
        goal(sheet, self.place(arena.goal()));
        self.panel.outline(sheet);
    }

    /// The boxes, the higher ones over the lower ones, with their heights.
    fn boxes(&self, sheet: &mut Sheet, arena: &Arena) {
        let highest_m = arena.boxes().iter().map(|one| one.height_m).fold(0.0, f64::max);
        let mut boxes: Vec<&ArenaBox> = arena.boxes().iter().collect();
        boxes.sort_by(|a, b| a.height_m.total_cmp(&b.height_m));
        let [size_x_m, size_y_m] = arena.size_m();
        let on_floor = |point: MapPoint| self.place(MapPoint::new(point.x.clamp(0.0, size_x_m), point.y.clamp(0.0, size_y_m)));
        for one in boxes {
            let (low, high) = (on_floor(one.min), on_floor(one.max));
            let corners = rectangle((low.0, high.1), (high.0, low.1));
            let grey = shade(one.height_m / highest_m);
            sheet.area(corners.clone(), RGBColor(grey, grey, grey), 1.0);
            sheet.line(corners.iter().copied().chain([corners[0]]).collect(), EDGE_PEN);
            let text = short(one.height_m);
            let room_mm = (high.0 - low.0).min(2.0 * (low.1 - high.1));
            if text_width_mm(&text, SMALL_MM) + 1.2 < room_mm {
                // Where the upper left corner is on the floor, off most paths.
                let corner = (low.0 + 0.7, high.1 + 0.7);
                sheet.label(Label::new(text, corner, SMALL_MM).hung(Anchor::Start, Hang::Below));
            }
        }
    }

    fn path(&self, sheet: &mut Sheet, path: &ArenaPath) {
        let halo = Pen { colour: WHITE, width_mm: HALO_MM };
        sheet.line(path.points.iter().map(|point| self.place(point.point)).collect(), halo);
        let pairs =
            || path.points.windows(2).map(|pair| ([self.place(pair[0].point), self.place(pair[1].point)], pair[1].reached_by));
        for (ends, kind) in pairs() {
            match kind {
                Some(Move::Jump) => sheet.dashed(&ends, JUMP_DASH_MM.0, JUMP_DASH_MM.1, JUMP_PEN),
                Some(Move::Drop) => sheet.dashed(&ends, DROP_DASH_MM.0, DROP_DASH_MM.1, DROP_PEN),
                Some(Move::Drive) | None => sheet.line(ends.to_vec(), DRIVE_PEN),
            }
        }
        // The marks lie over all lines.
        for (ends, kind) in pairs() {
            match kind {
                Some(Move::Jump) => triangle(sheet, ends[1]),
                Some(Move::Drop) => ring(sheet, ends[1]),
                Some(Move::Drive) | None => {}
            }
        }
    }
}

/// Light for low boxes, dark for the highest one.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 150 to 232")]
fn shade(share: f64) -> u8 {
    (232.0 - 82.0 * share.clamp(0.0, 1.0)) as u8
}

/// Where a jump lands.
fn triangle(sheet: &mut Sheet, (x, y): Place) {
    for (r, colour) in [(1.5, WHITE), (1.1, VERMILION)] {
        sheet.area(vec![(x - r, y + 0.8 * r), (x, y - r), (x + r, y + 0.8 * r)], colour, 1.0);
    }
}

/// Where a drop ends.
fn ring(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 1.0, WHITE);
    sheet.ring(at, 0.8, Pen { colour: PURPLE, width_mm: 0.4 });
}

fn jump_sample(sheet: &mut Sheet, (x, y): Place) {
    sheet.dashed(&[(x - 3.0, y), (x + 2.0, y)], JUMP_DASH_MM.0, JUMP_DASH_MM.1, JUMP_PEN);
    triangle(sheet, (x + 2.0, y));
}

fn drop_sample(sheet: &mut Sheet, (x, y): Place) {
    sheet.dashed(&[(x - 3.0, y), (x + 2.0, y)], DROP_DASH_MM.0, DROP_DASH_MM.1, DROP_PEN);
    ring(sheet, (x + 2.0, y));
}

/// The legend: only what is drawn.
fn entries(figure: &ArenaFigure<'_>) -> Vec<(Swatch, String)> {
    let moves = |kind: Move| {
        let paths = figure.panels.iter().filter_map(|view| view.path);
        paths.flat_map(|path| &path.points).any(|point| point.reached_by == Some(kind))
    };
    let is_missed = figure.panels.iter().any(|view| view.path.is_none());
    let mut found = vec![
        (Swatch::Symbol(start_symbol as fn(&mut Sheet, Place)), "start".to_owned()),
        (Swatch::Symbol(goal_symbol), "goal".to_owned()),
    ];
    if is_missed {
        found.push((Swatch::Symbol(missed_symbol), "goal, no path".to_owned()));
    }
    if moves(Move::Drive) {
        found.push((Swatch::Line(DRIVE_PEN), "drive".to_owned()));
    }
    if moves(Move::Jump) {
        found.push((Swatch::Symbol(jump_sample), "jump, to where it lands".to_owned()));
    }
    if moves(Move::Drop) {
        found.push((Swatch::Symbol(drop_sample), "drop".to_owned()));
    }
    if !figure.arena.boxes().is_empty() {
        let middle = shade(0.5);
        found.push((Swatch::Fill(RGBColor(middle, middle, middle)), "box with its height (m), darker the higher".to_owned()));
    }
    if let Some(tree) = figure.panels.iter().find_map(|view| view.tree) {
        found.extend(arena_tree::entries(tree));
    }
    found
}
