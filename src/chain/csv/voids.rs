//! Heights of a chain that are no ground: stated marks of missing data, usual marks, and numbers that no body has.

use super::{
    CsvProblems,
    columns::{X, Z},
    table::Table,
};
use crate::{
    quantity::format_number,
    terrain::{ELEVATION_LIMIT_M, NoDataRule, find_void_of_chain},
};

/// How to correct a height that marks missing data.
const HELP: &str = "a chain has no gaps: end it before the missing data, or fill them";

/// Adds a problem for every height that is no ground.
pub(super) fn check(table: &Table<'_>, no_data: NoDataRule, problems: &mut CsvProblems) {
    let heights: Vec<(usize, f64)> = (0..table.row_count()).filter_map(|row| Some((row, table.value(row, Z)?))).collect();
    let found = |row: usize| format!("`{}`", table.excerpt(row, Z));
    for &(row, z_m) in &heights {
        let stated = match no_data {
            NoDataRule::Value(mark) => mark.is_double(z_m),
            NoDataRule::AsStated | NoDataRule::Nothing => false,
        };
        if stated {
            problems.push(|| {
                let marked = format!("{}, which terrain.no_data states as missing", found(row));
                table.place(row, Z).problem(marked, "an elevation", HELP)
            });
        } else if z_m.abs() >= ELEVATION_LIMIT_M {
            problems.push(|| {
                let expected = format!("an elevation within {ELEVATION_LIMIT_M:e} m");
                table.place(row, Z).problem(found(row), expected, HELP)
            });
        }
    }
    let z_m: Vec<f64> = heights.iter().map(|(_, z_m)| *z_m).collect();
    if no_data == NoDataRule::AsStated
        && let Some(void) = find_void_of_chain(&z_m, typical_spacing_m(table))
    {
        problems.push(|| {
            let row = heights[void.first].0;
            let (low, high) = void.border_m.map_or_else(Default::default, |(low, high)| (format_number(low), format_number(high)));
            let around = if void.border_m.is_some() { format!(" between heights of {low} to {high} m") } else { String::new() };
            let rows = if void.count == 1 { "1 row".to_owned() } else { format!("{} rows", void.count) };
            let what = format!("{}{around} in {rows}, a usual mark of missing data", found(row));
            let help = format!("{HELP}; where it is an elevation, state terrain.no_data = \"none\"");
            table.place(row, Z).problem(what, "an elevation", help)
        });
    }
}

/// The median distance of neighbouring vertices, m.
fn typical_spacing_m(table: &Table<'_>) -> f64 {
    let x_m: Vec<f64> = (0..table.row_count()).filter_map(|row| table.value(row, X)).collect();
    let mut distances: Vec<f64> = x_m.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied().unwrap_or(0.0)
}
