//! The tree of RRT*, and the time of its path as the nodes grow.

use plotters::style::RGBColor;

use super::{
    axes::{BELOW_MM, Panel},
    keys::Swatch,
    palette::{BLACK, GREEN, LEFT_MM, ORANGE, RIGHT_MM, SKY, SMALL_MM, VERMILION},
    sheet::{Anchor, Hang, Label, Pen, Place, Sheet},
    ticks::Ticks,
};
use crate::{
    arena::{GrownTree, Joined, Move, TreeNode},
    quantity::MapPoint,
};

/// The height of the panel of times.
const HIGH_MM: f64 = 34.0;

/// The kinds of edges, as the paper tells them apart.
const KINDS: [(&str, Pen); 5] = [
    ("to the nearest node", Pen { colour: RGBColor(110, 110, 110), width_mm: 0.12 }),
    ("to a node that is sooner", Pen { colour: SKY, width_mm: 0.16 }),
    ("rewired", Pen { colour: GREEN, width_mm: 0.16 }),
    ("jump of the tree", Pen { colour: VERMILION, width_mm: 0.3 }),
    ("drop of the tree", Pen { colour: ORANGE, width_mm: 0.22 }),
];

fn kind(node: &TreeNode) -> usize {
    match (node.kind, node.joined) {
        (Move::Jump, _) => 3,
        (Move::Drop, _) => 4,
        (Move::Drive, Joined::Nearest) => 0,
        (Move::Drive, Joined::Sooner) => 1,
        (Move::Drive, Joined::Rewired) => 2,
    }
}

/// Draws the edges, those that change the height over the others.
pub(super) fn draw_edges(sheet: &mut Sheet, tree: &GrownTree, place: &dyn Fn(MapPoint) -> Place) {
    for (wanted, (_, pen)) in KINDS.iter().enumerate() {
        for node in tree.nodes.iter().skip(1).filter(|node| kind(node) == wanted) {
            if let Some(parent) = tree.nodes.get(node.parent as usize) {
                sheet.line(vec![place(parent.point), place(node.point)], *pen);
            }
        }
    }
}

/// The kinds of edges that the tree has.
pub(super) fn entries(tree: &GrownTree) -> Vec<(Swatch, String)> {
    let count = |wanted: usize| tree.nodes.iter().skip(1).filter(|node| kind(node) == wanted).count();
    let named = KINDS.iter().enumerate().map(|(wanted, (name, pen))| (count(wanted), *name, *pen));
    named
        .filter(|(count, ..)| *count > 0)
        .map(|(count, name, pen)| (Swatch::Line(Pen { width_mm: 0.4, ..pen }), format!("{name}: {count}")))
        .collect()
}

/// Draws the time of the path by the number of nodes, over a line at the time that no path beats; returns where it ends.
pub(super) fn draw_history(sheet: &mut Sheet, tree: &GrownTree, bound_s: Option<f64>, top_mm: f64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
    let points: Vec<(f64, f64)> = tree.history.iter().filter_map(|(nodes, time_s)| Some((*nodes as f64, (*time_s)?))).collect();
    #[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
    let last = tree.nodes.len() as f64;
    let times = || points.iter().map(|point| point.1).chain(bound_s);
    let (low_s, high_s) = (times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max));
    let beside_s = (0.08 * (high_s - low_s)).max(0.01);
    let (low_s, high_s) = (low_s - beside_s, high_s + beside_s);
    let panel = Panel { left: LEFT_MM, top: top_mm, right: RIGHT_MM, bottom: top_mm + HIGH_MM };
    let x = |nodes: f64| panel.left + panel.width() * nodes / last;
    let y = |time_s: f64| panel.bottom - panel.height() * (time_s - low_s) / (high_s - low_s);
    let (x_ticks, y_ticks) = (Ticks::round(0.0, last, 7.0), Ticks::round(low_s, high_s, 5.0));
    let named: Vec<_> = x_ticks.values.iter().map(|value| (x(*value), x_ticks.text(*value))).collect();
    panel.x_axis(sheet, &named, "nodes", true);
    let named: Vec<_> = y_ticks.values.iter().map(|value| (y(*value), y_ticks.text(*value))).collect();
    panel.y_axis(sheet, &named, "time of the path (s)", true);
    if let Some(bound_s) = bound_s {
        let pen = Pen { colour: BLACK, width_mm: 0.25 };
        sheet.dashed(&[(panel.left, y(bound_s)), (panel.right, y(bound_s))], 1.6, 1.0, pen);
        let label = Label::new("no path takes less", (panel.left + 1.0, y(bound_s) - 0.6), SMALL_MM);
        sheet.label(label.hung(Anchor::Start, Hang::Above));
    }
    let line: Vec<Place> = points.iter().map(|(nodes, time_s)| (x(*nodes), y(*time_s))).collect();
    for at in &line {
        sheet.dot(*at, 0.35, BLACK);
    }
    sheet.line(line, Pen { colour: BLACK, width_mm: 0.4 });
    panel.outline(sheet);
    panel.bottom + BELOW_MM
}
