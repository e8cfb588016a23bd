//! A path of a wheeled jumper among boxes, as plain data and text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::text::{Sheet, place};
use crate::arena::Move;

/// The answer of a planner in an arena.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[expect(clippy::struct_excessive_bools, reason = "each answers a question of its own")]
pub struct ArenaAnswer {
    /// `grid`, `any-angle` or `rrt-star`.
    pub planner: String,
    /// How the grid prices jumps and drops, `R1` or `R0`; null for other planners.
    pub reading: Option<String>,
    /// Whether jumps were allowed.
    pub jumps_allowed: bool,
    /// The seed of RRT*; null for other planners.
    pub seed: Option<u64>,
    /// The nodes of RRT*, as grown; null for other planners.
    pub nodes: Option<u64>,
    /// Whether a path was found.
    pub found: bool,
    /// Whether it is proved that no path exists, whatever the planner.
    pub proved_unreachable: bool,
    /// The keys of which each one alone, if it were lifted, gives a path; empty if a path was found.
    pub stopped_by: Vec<String>,
    /// The time of the path, s; null without one.
    pub path_time_s: Option<f64>,
    /// A time that no path beats under this planner's prices, s; null where it is proved that there is no path.
    pub lower_bound_s: Option<f64>,
    /// Whether the lower bound is the exact optimum over the boxes as drawn; else it is below what can be reached.
    pub lower_bound_is_exact: bool,
    /// How far the time of the path is above the bound, as a share of the bound; null without a path.
    pub gap_share: Option<f64>,
    /// The jumps of the path; null without one.
    pub jumps: Option<u64>,
    /// Its length along the floor, m; null without a path.
    pub length_m: Option<f64>,
    /// All its changes of heading, degrees; null without a path.
    pub turning_deg: Option<f64>,
    /// Its energy, J; null without a path, and where no key gives energy a price.
    pub energy_j: Option<f64>,
    /// The time of the same planner's path without jumps, s; null without such a path, or if jumps were not allowed anyway.
    pub without_jumps_s: Option<f64>,
    /// The flight of every jump; null where jumps are rules.
    pub flight: Option<ArenaFlightRecord>,
    /// All planners over the same boxes; absent if that was not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compared: Option<Vec<ArenaComparedRecord>>,
    /// The path from the start to the goal; empty without one.
    pub path: Vec<ArenaPointRecord>,
    /// The time of the path of RRT* as its nodes grow; empty for other planners.
    pub history: Vec<ArenaHistoryRecord>,
}

/// What one of all planners finds over the same boxes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ArenaComparedRecord {
    /// `grid`, `any-angle` or `rrt-star`.
    pub planner: String,
    /// How the grid prices jumps and drops, `R1` or `R0`; null for other planners.
    pub reading: Option<String>,
    /// Why this planner does not plan in this arena; null if it does.
    pub refused: Option<String>,
    /// The time of its path, s; null without one.
    pub path_time_s: Option<f64>,
    /// The jumps of its path; null without one.
    pub jumps: Option<u64>,
    /// Its length along the floor, m; null without a path.
    pub length_m: Option<f64>,
    /// The time of its path without jumps, s; null without such a path, or if jumps were not allowed anyway.
    pub without_jumps_s: Option<f64>,
    /// What jumping saves, s; null where one of both paths is missing.
    pub saved_s: Option<f64>,
    /// A time that no path beats under this planner's prices, s; null where it is proved that there is no path.
    pub lower_bound_s: Option<f64>,
    /// Whether the lower bound is the exact optimum over the boxes as drawn; else it is below what can be reached.
    pub lower_bound_is_exact: bool,
    /// How far the time of the path is above the bound, as a share of the bound; null without a path.
    pub gap_share: Option<f64>,
}

/// What the flight of a jump reaches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ArenaFlightRecord {
    /// Its apex over the take-off, m.
    pub apex_m: f64,
    /// Its range over level ground, m.
    pub range_m: f64,
    /// What the landing keeps from the edge, m.
    pub landing_past_edge_m: f64,
    /// The highest box, over the take-off, on which it lands so far past the edge, m; below 0 if it lands on no box.
    pub highest_box_m: f64,
    /// The boxes, counted from 1, that are higher than this over the floor.
    pub boxes_too_high: Vec<u64>,
}

/// A point of a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ArenaPointRecord {
    /// Along the floor, m.
    pub x_m: f64,
    /// Along the floor, m.
    pub y_m: f64,
    /// The height under it, m.
    pub z_m: f64,
    /// How it is reached from the point before: `drive`, `jump` or `drop`; null for the start.
    #[serde(rename = "move")]
    pub reached_by: Option<String>,
}

/// The time of the path after some nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ArenaHistoryRecord {
    /// The nodes.
    pub nodes: u64,
    /// The time of the path, s; null before there is one.
    pub path_time_s: Option<f64>,
}

/// The answer as text.
pub fn arena_text(answer: &ArenaAnswer) -> String {
    let mut sheet = Sheet::default();
    let by = match (answer.planner.as_str(), &answer.reading, answer.nodes) {
        ("grid", Some(reading), _) => format!("over this grid, reading {reading}"),
        ("rrt-star", _, Some(nodes)) => format!("by RRT* with {nodes} nodes"),
        _ => "over the boxes as drawn".to_owned(),
    };
    let (Some(time_s), Some(jumps)) = (answer.path_time_s, answer.jumps) else {
        no_path(&mut sheet, answer, &by);
        return sheet.into_text();
    };
    let counted = match jumps {
        0 => "no jump".to_owned(),
        1 => "1 jump".to_owned(),
        more => format!("{more} jumps"),
    };
    let best = if answer.planner == "any-angle" { "optimal" } else { "found" };
    sheet.line(format_args!("{best} {by}: {time_s:.4} s with {counted}"));
    if let (Some(bound_s), Some(gap)) = (answer.lower_bound_s, answer.gap_share)
        && answer.planner != "any-angle"
    {
        let what = if answer.lower_bound_is_exact { "the optimum at these prices" } else { "no path takes less than" };
        sheet.line(format_args!("{what}: {bound_s:.4} s; this path takes {:.2} % more", 100.0 * gap));
    }
    match answer.without_jumps_s {
        Some(without_s) if answer.jumps_allowed => {
            let saved_s = without_s - time_s;
            if saved_s >= 5e-5 {
                sheet.line(format_args!("without jumps: {without_s:.4} s; jumping saves {saved_s:.4} s"));
            } else {
                sheet.line(format_args!("without jumps: {without_s:.4} s; jumping saves nothing"));
            }
        }
        None if answer.jumps_allowed => sheet.line(format_args!("without jumps: no path {by}")),
        _ => {}
    }
    if let (Some(length_m), Some(turning_deg)) = (answer.length_m, answer.turning_deg) {
        let energy = answer.energy_j.map(|energy_j| format!(", {energy_j:.2} J")).unwrap_or_default();
        sheet.line(format_args!("length {length_m:.3} m, turning {turning_deg:.1} deg{energy}"));
    }
    flight(&mut sheet, answer);
    compared(&mut sheet, answer);
    for point in &answer.path {
        let (x, y, z) = (place(point.x_m), place(point.y_m), place(point.z_m));
        sheet.line(format_args!("  {:<6} {x}, {y}, {z} m", point.reached_by.as_deref().unwrap_or("start")));
    }
    sheet.into_text()
}

/// What the flight of a jump reaches, and which boxes are too high for it.
fn flight(sheet: &mut Sheet, answer: &ArenaAnswer) {
    let Some(flight) = &answer.flight else { return };
    let ArenaFlightRecord { apex_m, range_m, landing_past_edge_m, highest_box_m, boxes_too_high } = flight;
    sheet.line(format_args!(
        "flight: apex {apex_m:.4} m, range {range_m:.4} m; to land {landing_past_edge_m} m past its edge a box may be {:.4} m high",
        highest_box_m.max(0.0)
    ));
    if !boxes_too_high.is_empty() {
        let numbers: Vec<String> = boxes_too_high.iter().map(ToString::to_string).collect();
        sheet.line(format_args!("too high from the floor: box {}", numbers.join(", ")));
    }
}

/// All planners side by side.
fn compared(sheet: &mut Sheet, answer: &ArenaAnswer) {
    let Some(rows) = &answer.compared else { return };
    sheet.line(format_args!(
        "  {:<12}{:>12}{:>7}{:>14}{:>10}{:>12}",
        "planner", "time, s", "jumps", "no jumps, s", "saves, s", "above, %"
    ));
    let seconds = |time_s: Option<f64>| time_s.map_or_else(|| "-".to_owned(), |time_s| format!("{time_s:.4}"));
    for row in rows {
        let name = row.reading.as_ref().map_or_else(|| row.planner.clone(), |reading| format!("{} {reading}", row.planner));
        if let Some(refused) = &row.refused {
            sheet.line(format_args!("  {name:<12}  refused: {refused}"));
            continue;
        }
        let (time, without, saved) = (seconds(row.path_time_s), seconds(row.without_jumps_s), seconds(row.saved_s));
        let jumps = row.jumps.map_or_else(|| "-".to_owned(), |jumps| jumps.to_string());
        let above = row.gap_share.map_or_else(|| "-".to_owned(), |gap| format!("{:.2}", 100.0 * gap));
        let exact = if row.gap_share.is_some() && !row.lower_bound_is_exact { " a bound" } else { "" };
        sheet.line(format_args!("  {name:<12}{time:>12}{jumps:>7}{without:>14}{saved:>10}{above:>12}{exact}"));
    }
}

fn no_path(sheet: &mut Sheet, answer: &ArenaAnswer, by: &str) {
    let with = if answer.jumps_allowed { "" } else { " without jumps" };
    if answer.proved_unreachable {
        sheet.line(format_args!("no path{with}, proved over the boxes as drawn"));
    } else {
        sheet.line(format_args!("no path{with} {by}; this does not prove that no path exists"));
        if let Some(bound_s) = answer.lower_bound_s {
            let what = if answer.lower_bound_is_exact { "a path over the boxes as drawn takes" } else { "no path takes less than" };
            sheet.line(format_args!("{what} {bound_s:.4} s"));
        }
    }
    flight(sheet, answer);
    compared(sheet, answer);
    for key in &answer.stopped_by {
        sheet.line(format_args!("stopped by {key}: without this limit there is a path"));
    }
}

impl ArenaPointRecord {
    /// The name of a move.
    pub fn name(kind: Option<Move>) -> Option<String> {
        kind.map(|kind| kind.name().to_owned())
    }
}
