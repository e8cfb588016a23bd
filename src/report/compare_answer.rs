//! Several scenarios side by side, as plain data, text and CSV.

use std::{
    fmt::Write as _,
    io::{self, Write},
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{TotalsRecord, stated::stated};
use crate::{graph::proof::ProofVerdict, path::HopPath};

/// The answer of `chta compare`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CompareAnswer {
    /// One row for each scenario, in the order given.
    pub compared: Vec<CompareRow>,
}

/// One scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CompareRow {
    /// The file.
    pub file: String,
    /// Its title.
    pub name: String,
    /// Start, m.
    pub start_x_m: f64,
    /// Goal, m.
    pub goal_x_m: f64,
    /// `traversable`, `no-path-found`, or `untraversable` if that is proved.
    pub verdict: ProofVerdict,
    /// The fewest hops found.
    pub hops: Option<u64>,
    /// With a proof: no path has fewer hops; null if there is no path at all.
    #[serde(default, deserialize_with = "stated", skip_serializing_if = "Option::is_none")]
    pub lower_bound: Option<Option<u64>>,
    /// The totals of the hops.
    pub totals: Option<TotalsRecord>,
    /// The least margins to the limits.
    pub margins: Option<MarginsRecord>,
}

/// The least margins of a path's hops to their limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MarginsRecord {
    /// The least margin to a speed limit, at take-off or landing.
    pub speed_margin_least_m_s: f64,
    /// The least margin from the take-off angle to either end of its feasible interval; 0 if a hop is flown at an end.
    pub angle_margin_least_deg: f64,
    /// The width of the narrowest interval of feasible take-off angles.
    pub angle_span_least_deg: f64,
}

impl MarginsRecord {
    /// The margins of a path; `None` if it has no hop.
    pub fn of(path: &HopPath) -> Option<Self> {
        let least = |of: &dyn Fn(&crate::path::Hop) -> f64| path.hops.iter().map(of).reduce(f64::min);
        Some(Self {
            speed_margin_least_m_s: least(&|hop| hop.speed_margin_m_s)?,
            angle_margin_least_deg: least(&|hop| {
                let angle = hop.takeoff_angle.degrees();
                (angle - hop.takeoff_angles.min.degrees()).min(hop.takeoff_angles.max.degrees() - angle).max(0.0)
            })?,
            angle_span_least_deg: least(&|hop| hop.takeoff_angles.max.degrees() - hop.takeoff_angles.min.degrees())?,
        })
    }
}

/// The columns with numbers of a path.
const COLUMNS: [&str; 12] = [
    "flight_time_s",
    "energy_j_kg",
    "peak_takeoff_speed_m_s",
    "ground_distance_m",
    "energy_j",
    "mission_time_s",
    "delta_v_m_s",
    "propellant_kg",
    "mass_end_kg",
    "speed_margin_least_m_s",
    "angle_margin_least_deg",
    "angle_span_least_deg",
];

/// The column of delta-v.
const DELTA_V: &str = "delta_v_m_s";

impl CompareRow {
    /// The numbers of [`COLUMNS`].
    fn numbers(&self) -> [Option<f64>; COLUMNS.len()] {
        let (totals, margins) = (self.totals.as_ref(), self.margins.as_ref());
        [
            totals.map(|t| t.flight_time_s),
            totals.map(|t| t.energy_j_kg),
            totals.map(|t| t.peak_takeoff_speed_m_s),
            totals.map(|t| t.ground_distance_m),
            totals.and_then(|t| t.energy_j),
            totals.and_then(|t| t.mission_time_s),
            totals.map(|t| t.delta_v_m_s),
            totals.and_then(|t| t.propellant_kg),
            totals.and_then(|t| t.mass_end_kg),
            margins.map(|m| m.speed_margin_least_m_s),
            margins.map(|m| m.angle_margin_least_deg),
            margins.map(|m| m.angle_span_least_deg),
        ]
    }

    /// The number of hops, with its lower bound if that is smaller.
    fn format_hops(&self) -> String {
        let hops = self.hops.map_or("-".to_owned(), |hops| hops.to_string());
        match self.lower_bound {
            Some(Some(bound)) if self.hops != Some(bound) => format!("{hops} (at least {bound})"),
            _ => hops,
        }
    }
}

impl CompareAnswer {
    /// The table as text: a line for each quantity, a column for each scenario.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut numbers = vec![String::new()];
        for (i, row) in self.compared.iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "({}) {}: {}", i + 1, row.file, row.name);
            numbers.push(format!("({})", i + 1));
        }
        text.push('\n');
        let mut lines: Vec<Vec<String>> =
            vec![numbers, self.line("verdict", |row| row.verdict.to_string()), self.line("hops", CompareRow::format_hops)];
        for (i, column) in COLUMNS.into_iter().enumerate() {
            // The delta-v of machines without propulsion is the sum of their take-off speeds: no line of its own.
            let is_stated = |row: &CompareRow| {
                row.numbers()[i].is_some() && (column != DELTA_V || row.totals.is_some_and(|totals| totals.propulsive))
            };
            if self.compared.iter().any(is_stated) {
                lines.push(self.line(column, |row| row.numbers()[i].map_or("-".to_owned(), |number| format!("{number:.3}"))));
            }
        }
        let columns = self.compared.len() + 1;
        let widths: Vec<usize> =
            (0..columns).map(|i| lines.iter().map(|line| line[i].chars().count()).max().unwrap_or(0)).collect();
        for line in lines {
            let _ = write!(text, "{:<width$}", line[0], width = widths[0]);
            for (field, width) in line.iter().zip(&widths).skip(1) {
                let _ = write!(text, "  {field:>width$}");
            }
            text.push('\n');
        }
        text
    }

    /// One line of the table.
    fn line(&self, name: &str, of: impl Fn(&CompareRow) -> String) -> Vec<String> {
        std::iter::once(name.to_owned()).chain(self.compared.iter().map(of)).collect()
    }

    /// A row for each scenario as CSV; absent values are blank.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: impl Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(out);
        let proved = self.compared.iter().any(|row| row.lower_bound.is_some());
        let bound: &[&str] = if proved { &["lower_bound"] } else { &[] };
        let first = ["file", "name", "start_x_m", "goal_x_m", "verdict", "hops"];
        writer.write_record([&first[..], bound, &COLUMNS].concat())?;
        let count = |hops: Option<u64>| hops.map(|hops| hops.to_string()).unwrap_or_default();
        for row in &self.compared {
            let mut fields = vec![row.file.clone(), row.name.clone(), row.start_x_m.to_string(), row.goal_x_m.to_string()];
            fields.extend([row.verdict.to_string(), count(row.hops)]);
            fields.extend(row.lower_bound.map(count));
            fields.extend(row.numbers().map(|number| number.map(|n| n.to_string()).unwrap_or_default()));
            writer.write_record(fields)?;
        }
        writer.flush()
    }
}
