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
    /// Start, m; null for a case without an answer, and over a mesh.
    pub start_x_m: Option<f64>,
    /// Goal, m; null for a case without an answer, and over a mesh.
    pub goal_x_m: Option<f64>,
    /// Start on the surface of a mesh, [x, y, z], m; absent over other terrain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_m: Option<[f64; 3]>,
    /// Goal on the surface of a mesh, [x, y, z], m; absent over other terrain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub goal_m: Option<[f64; 3]>,
    /// `traversable`, `no-path-found` (also where the propellant does not last), or `untraversable` if that is proved; null for a case
    /// without an answer.
    pub verdict: Option<ProofVerdict>,
    /// The fewest hops found.
    pub hops: Option<u64>,
    /// With a proof, and over a mesh by the greatest speeds: no path has fewer hops; null if there is no path at all.
    #[serde(default, deserialize_with = "stated", skip_serializing_if = "Option::is_none")]
    pub lower_bound: Option<Option<u64>>,
    /// The totals of the hops.
    pub totals: Option<TotalsRecord>,
    /// The least margins to the limits.
    pub margins: Option<MarginsRecord>,
    /// Why there is no answer; absent if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
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

/// The columns with the totals of a path.
pub(super) const TOTALS_COLUMNS: [&str; 9] = [
    "flight_time_s",
    "energy_j_kg",
    "peak_takeoff_speed_m_s",
    "ground_distance_m",
    "energy_j",
    "mission_time_s",
    "delta_v_m_s",
    "propellant_kg",
    "mass_end_kg",
];

/// The columns with its margins.
pub(super) const MARGIN_COLUMNS: [&str; 3] = ["speed_margin_least_m_s", "angle_margin_least_deg", "angle_span_least_deg"];

/// The column with what it lacks.
const SHORT: &str = "propellant_short_kg";

/// The numbers of [`TOTALS_COLUMNS`].
pub(super) fn totals_numbers(totals: Option<&TotalsRecord>) -> [Option<f64>; TOTALS_COLUMNS.len()] {
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
    ]
}

/// The numbers of [`MARGIN_COLUMNS`].
pub(super) fn margin_numbers(margins: Option<&MarginsRecord>) -> [Option<f64>; MARGIN_COLUMNS.len()] {
    [margins.map(|m| m.speed_margin_least_m_s), margins.map(|m| m.angle_margin_least_deg), margins.map(|m| m.angle_span_least_deg)]
}

/// The column of delta-v.
const DELTA_V: &str = "delta_v_m_s";

impl CompareRow {
    /// The row of a case without an answer.
    pub const fn failed(file: String, name: String, error: String) -> Self {
        Self {
            file,
            name,
            start_x_m: None,
            goal_x_m: None,
            start_m: None,
            goal_m: None,
            verdict: None,
            hops: None,
            lower_bound: None,
            totals: None,
            margins: None,
            error: Some(error),
        }
    }

    /// Whether there is a path that the machine can fly.
    pub fn is_traversable(&self) -> bool {
        self.verdict == Some(ProofVerdict::Traversable)
    }

    /// The propellant that the path lacks.
    pub fn propellant_short_kg(&self) -> Option<f64> {
        self.totals.and_then(|totals| totals.propellant_short_kg)
    }

    /// The numbers of [`TOTALS_COLUMNS`], [`MARGIN_COLUMNS`] and [`SHORT`].
    fn numbers(&self) -> impl Iterator<Item = Option<f64>> {
        let (totals, margins) = (totals_numbers(self.totals.as_ref()), margin_numbers(self.margins.as_ref()));
        totals.into_iter().chain(margins).chain([self.propellant_short_kg()])
    }

    /// The verdict, with the reason where the propellant does not last.
    pub fn format_verdict(&self) -> String {
        let short = if self.propellant_short_kg().is_some() { " (too little propellant)" } else { "" };
        self.verdict.map_or("failed".to_owned(), |verdict| format!("{verdict}{short}"))
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
            vec![numbers, self.line("verdict", CompareRow::format_verdict), self.line("hops", CompareRow::format_hops)];
        for (i, column) in TOTALS_COLUMNS.into_iter().chain(MARGIN_COLUMNS).chain([SHORT]).enumerate() {
            // The delta-v of machines without propulsion is the sum of their take-off speeds: no line of its own.
            let number = |row: &CompareRow| row.numbers().nth(i).flatten();
            let is_stated = |row: &CompareRow| {
                number(row).is_some() && (column != DELTA_V || row.totals.is_some_and(|totals| totals.propulsive))
            };
            if self.compared.iter().any(is_stated) {
                lines.push(self.line(column, |row| number(row).map_or("-".to_owned(), |number| format!("{number:.3}"))));
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
        let errors = self.compared.iter().enumerate().filter_map(|(i, row)| Some((i + 1, row.error.as_ref()?)));
        for (i, (number, error)) in errors.enumerate() {
            let _ = writeln!(text, "{}({number}) failed: {error}", if i == 0 { "\n" } else { "" });
        }
        text
    }

    /// Whether every case has a path that the machine can fly.
    pub fn is_traversable(&self) -> bool {
        self.compared.iter().all(CompareRow::is_traversable)
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
        writer.write_record([&first[..], bound, &TOTALS_COLUMNS, &MARGIN_COLUMNS, &[SHORT, "error"]].concat())?;
        let count = |hops: Option<u64>| hops.map(|hops| hops.to_string()).unwrap_or_default();
        let field = |number: Option<f64>| number.map(|n| n.to_string()).unwrap_or_default();
        for row in &self.compared {
            let mut fields = vec![row.file.clone(), row.name.clone(), field(row.start_x_m), field(row.goal_x_m)];
            fields.extend([row.verdict.map(|verdict| verdict.to_string()).unwrap_or_default(), count(row.hops)]);
            fields.extend(proved.then(|| count(row.lower_bound.flatten())));
            fields.extend(row.numbers().map(field));
            fields.push(row.error.clone().unwrap_or_default());
            writer.write_record(fields)?;
        }
        writer.flush()
    }
}
