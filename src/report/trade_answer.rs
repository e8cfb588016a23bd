//! The answer of a trade of capabilities, as plain data, text, CSV and picture.

use std::{
    collections::BTreeMap,
    fmt::Write as _,
    io::{self, Write},
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    EffortRecord, MarginsRecord, ObjectiveRecord, QuestionRouteRecord, SuccessBudgetRecord, TotalsRecord,
    compare_answer::{MARGIN_COLUMNS, TOTALS_COLUMNS, margin_numbers, totals_numbers},
    stated::stated,
};
use crate::graph::proof::ProofVerdict;

/// The answer of `chta trade`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TradeAnswer {
    /// The varied keys: one or two.
    pub vary: Vec<SweptKeyRecord>,
    /// Of free routes: the nodes of all cells; absent along a transect, and where their spacing is varied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub route: Option<QuestionRouteRecord>,
    /// One row for each cell; the last key changes fastest.
    pub rows: Vec<TradeRow>,
}

/// A varied key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SweptKeyRecord {
    /// The scenario's key, `table.name`.
    pub key: String,
    /// Its values, in ascending order.
    pub values: Vec<f64>,
}

/// One cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TradeRow {
    /// The value of each key.
    #[serde(flatten)]
    pub values: BTreeMap<String, f64>,
    /// `traversable`, `no-path-found`, or `untraversable` if that is proved; null for a cell without an answer.
    pub verdict: Option<ProofVerdict>,
    /// The fewest hops found.
    pub hops: Option<u64>,
    /// With a proof: no path has fewer hops; null if there is no path at all.
    #[serde(default, deserialize_with = "stated", skip_serializing_if = "Option::is_none")]
    pub lower_bound: Option<Option<u64>>,
    /// Whether a speed limit of this cell reaches the escape speed, so that the answer is that of a limit just below it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub above_escape: bool,
    /// Whether some hop is longer than a hundredth of the body's radius, so that constant gravity is a bad model.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub far_on_body: bool,
    /// The totals of the path, for exact commands; null without one, or if it has too many hops to list.
    pub totals: Option<TotalsRecord>,
    /// The least margins of its hops to the limits; null where the totals are, and without a hop.
    pub margins: Option<MarginsRecord>,
    /// The effort of the path, in the unit of the chosen effort; null without one.
    pub effort: Option<EffortRecord>,
    /// Of a scenario with a budget of success: whether the path has it; if not, the cell has no path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub success_budget: Option<SuccessBudgetRecord>,
    /// Of a plan by objective or within budgets of totals: what it takes of them; if it is too much, the cell has no path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_objective: Option<ObjectiveRecord>,
    /// Why there is no answer; absent if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

impl TradeRow {
    /// The row of a cell without an answer.
    pub fn failed(values: BTreeMap<String, f64>, error: String) -> Self {
        let (verdict, hops, lower_bound, totals, margins, effort) = (None, None, None, None, None, None);
        let (above_escape, far_on_body, success_budget, by_objective, error) = (false, false, None, None, Some(error));
        Self {
            values,
            verdict,
            hops,
            lower_bound,
            above_escape,
            far_on_body,
            totals,
            margins,
            effort,
            success_budget,
            by_objective,
            error,
        }
    }

    /// Whether a path was found.
    pub fn is_traversable(&self) -> bool {
        self.verdict == Some(ProofVerdict::Traversable)
    }

    /// The text of a table cell: the hops, `x` if it is proved that there is no path, `-` if no path was found.
    fn sign(&self) -> String {
        match self.hops {
            Some(hops) => hops.to_string(),
            None if self.error.is_some() => "!".to_owned(),
            None if self.is_closed() => "x".to_owned(),
            None => "-".to_owned(),
        }
    }

    /// Whether it is proved that there is no path.
    pub fn is_closed(&self) -> bool {
        self.verdict == Some(ProofVerdict::Untraversable)
    }
}

impl TradeAnswer {
    /// The cells row by row: for each value of the second key, those of all values of the first.
    pub fn by_lines(&self) -> impl Iterator<Item = impl Iterator<Item = &TradeRow>> {
        let down = self.vary.get(1).map_or(1, |second| second.values.len());
        (0..down).map(move |line| self.rows.iter().skip(line).step_by(down))
    }

    /// Whether a proof was requested.
    pub fn is_with_proof(&self) -> bool {
        self.rows.iter().any(|row| row.lower_bound.is_some())
    }

    /// A summary: the number of cells with a path.
    pub fn summary(&self) -> String {
        let paths = self.rows.iter().filter(|row| row.hops.is_some()).count();
        let closed = self.rows.iter().filter(|row| row.is_closed()).count();
        let proved = if self.is_with_proof() { format!(", in {closed} it is proved that there is none") } else { String::new() };
        let failures = self.rows.iter().filter(|row| row.error.is_some()).count();
        let failed = if failures > 0 { format!(", {failures} failed") } else { String::new() };
        format!("{paths} of {} cells have a path{proved}{failed}", self.rows.len())
    }

    /// Whether every cell has a path.
    pub fn is_traversable(&self) -> bool {
        self.rows.iter().all(TradeRow::is_traversable)
    }

    /// The warnings about cells whose answer depends on the body's size.
    pub fn warnings(&self) -> Vec<String> {
        let far: Vec<&TradeRow> = self.rows.iter().filter(|row| row.far_on_body).collect();
        let of_model = far.first().map(|first| {
            let at: Vec<_> = first.values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
            format!(
                "{} of {} cells, the first with {}, have a hop whose range is over 1 % of the body's radius: constant gravity is a bad model there",
                far.len(),
                self.rows.len(),
                at.join(" and ")
            )
        });
        self.escape_warning().into_iter().chain(of_model).collect()
    }

    /// A warning about the cells whose speed limit reaches the escape speed, with the first of them; `None` if no cell's limit does.
    pub fn escape_warning(&self) -> Option<String> {
        let first = self.rows.iter().find(|row| row.above_escape)?;
        let count = self.rows.iter().filter(|row| row.above_escape).count();
        let at: Vec<_> = first.values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        Some(format!(
            "{count} of {} cells, the first with {}, have a speed limit at or above the escape speed: a hop that fast never lands, so they \
             have the answer of a limit just below it",
            self.rows.len(),
            at.join(" and ")
        ))
    }

    /// The table as text.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n\n", self.summary());
        let columns: Vec<String> = self.vary.first().map(|v| v.values.iter().map(f64::to_string).collect()).unwrap_or_default();
        let names: Vec<&str> = self.vary.iter().map(|v| v.key.as_str()).collect();
        // Writing to a String cannot fail.
        let _ = match names.as_slice() {
            [across, down] => writeln!(text, "hops by {across} (across) and {down} (down):\n"),
            _ => writeln!(text, "hops by {}:\n", names.concat()),
        };
        let lines: Vec<Vec<String>> = self.by_lines().map(|line| line.map(TradeRow::sign).collect()).collect();
        let wide = columns.iter().chain(lines.iter().flatten()).map(String::len).max().unwrap_or(0) + 2;
        let heads: Vec<String> = match self.vary.get(1) {
            Some(down) => down.values.iter().map(f64::to_string).collect(),
            None => vec!["hops".to_owned()],
        };
        let head = heads.iter().map(String::len).max().unwrap_or(0);
        let row =
            |name: &str, cells: &[String]| cells.iter().fold(format!("{name:>head$}"), |row, cell| row + &format!("{cell:>wide$}"));
        let _ = writeln!(text, "{}", row("", &columns));
        for (name, line) in heads.iter().zip(&lines) {
            let _ = writeln!(text, "{}", row(name, line));
        }
        let without_path =
            |closed| self.rows.iter().any(|row| row.hops.is_none() && row.error.is_none() && row.is_closed() == closed);
        let exceeds = self.rows.iter().any(|row| row.by_objective.as_ref().is_some_and(|record| !record.is_met()));
        let what = if exceeds { "no path within the budgets" } else { "no path" };
        if without_path(false) {
            let _ = writeln!(text, "\n-: {what} found");
        }
        let unmet = self.rows.iter().filter_map(|row| row.success_budget.filter(|budget| !budget.met));
        if let Some((least, most)) = unmet.map(|budget| (budget.estimated_success_min, budget.success_estimated)).reduce(better) {
            let best = most.map_or_else(|| "none was flown".to_owned(), |most| format!("the best of these is {most:.4}"));
            let _ =
                writeln!(text, "   (or none with an estimated success of at least {least}, budget.estimated_success_min; {best})");
        }
        if without_path(true) {
            text.push_str("\nx: proved, there is no path\n");
        }
        if let Some(route) = &self.route {
            let _ = writeln!(text, "\n{}; -: {what} found over these nodes, which is no proof", route.sentence());
        }
        // Of many cells with the same reason, the first.
        let mut reasons: Vec<&str> = Vec::new();
        for row in &self.rows {
            let Some(error) = row.error.as_deref().filter(|error| !reasons.contains(error)) else { continue };
            let at: Vec<_> = row.values.iter().map(|(key, value)| format!("{key} = {value}")).collect();
            let _ = writeln!(text, "\n!: failed, first with {}: {error}", at.join(" and "));
            reasons.push(error);
        }
        text
    }

    /// The rows as CSV; absent values are blank.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: impl Write) -> io::Result<()> {
        let keys: Vec<&str> = self.vary.iter().map(|v| v.key.as_str()).collect();
        let mut writer = csv::Writer::from_writer(out);
        let proved = self.is_with_proof();
        let bound: &[&str] = if proved { &["lower_bound"] } else { &[] };
        let estimates = self.rows.iter().any(|row| row.success_budget.is_some());
        let success: &[&str] = if estimates { &["success_estimated"] } else { &[] };
        let first = [&keys[..], &["verdict", "hops"], bound].concat();
        writer.write_record([&first[..], &TOTALS_COLUMNS, &MARGIN_COLUMNS, &["effort"], success, &["error"]].concat())?;
        let count = |hops: Option<u64>| hops.map(|hops| hops.to_string()).unwrap_or_default();
        for row in &self.rows {
            let values = keys.iter().map(|key| row.values.get(*key).map(f64::to_string).unwrap_or_default());
            let bound = proved.then(|| count(row.lower_bound.flatten()));
            let verdict = row.verdict.map(|verdict| verdict.to_string()).unwrap_or_default();
            let (totals, margins) = (totals_numbers(row.totals.as_ref()), margin_numbers(row.margins.as_ref()));
            let success = estimates.then(|| row.success_budget.and_then(|budget| budget.success_estimated));
            let numbers = totals.into_iter().chain(margins).chain([row.effort.map(|effort| effort.value)]).chain(success);
            let numbers = numbers.map(|number| number.map(|number| number.to_string()).unwrap_or_default());
            let answer = [verdict, count(row.hops)].into_iter().chain(bound).chain(numbers);
            writer.write_record(values.chain(answer).chain([row.error.clone().unwrap_or_default()]))?;
        }
        writer.flush()
    }
}

/// The greater of two successes beside their budgets.
fn better(a: (f64, Option<f64>), b: (f64, Option<f64>)) -> (f64, Option<f64>) {
    if b.1 > a.1 { b } else { a }
}

/// The axis label of a key, with the unit from the end of its name.
pub fn with_unit(key: &str) -> String {
    let units = [("_m_s2", "m/s²"), ("_m_s", "m/s"), ("_deg", "deg"), ("_kg", "kg"), ("_m", "m"), ("_s", "s")];
    match units.into_iter().find(|(ending, _)| key.ends_with(ending)) {
        Some((_, unit)) => format!("{key} ({unit})"),
        None => key.to_owned(),
    }
}
