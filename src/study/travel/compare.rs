//! Several missions side by side.

use super::plan::TravelPlanned;
use crate::report::{CompareAnswer, CompareRow};

/// One of several scenarios that drive, with its plan.
#[derive(Clone, Debug)]
pub struct TravelCompared {
    /// The plan.
    pub planned: TravelPlanned,
    /// Its row of the table.
    pub row: CompareRow,
}

impl TravelCompared {
    /// A plan and the file of its scenario; `untitled` is the name of a scenario without a title.
    pub fn of(planned: TravelPlanned, file: String, untitled: &str) -> Self {
        let answer = &planned.answer;
        let row = CompareRow {
            file,
            name: planned.case.scenario.title.clone().unwrap_or_else(|| untitled.to_owned()),
            start_x_m: None,
            goal_x_m: None,
            start_m: Some(answer.start_m),
            goal_m: Some(answer.goal_m),
            verdict: Some(answer.verdict),
            hops: answer.hops,
            lower_bound: Some(Some(answer.hops_lower_bound)),
            totals: planned.totals_record(),
            margins: None,
            error: None,
        };
        Self { planned, row }
    }

    /// The warnings about the input and the plan, each with the name of the file.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        let all = self.planned.case.warnings_with(self.planned.warnings.iter().cloned());
        all.into_iter().map(|warning| format!("{}: {warning}", self.row.file))
    }
}

/// Several scenarios that drive, with their plans.
#[derive(Clone, Debug)]
pub struct TravelComparison {
    /// Those with an answer, in the order given.
    pub compared: Vec<TravelCompared>,
    /// The answer as plain data, with a row for every scenario.
    pub answer: CompareAnswer,
}

impl TravelComparison {
    /// The answers side by side; a scenario without one has its row alone ([`CompareRow::failed`]).
    pub fn of(cases: Vec<Result<TravelCompared, CompareRow>>) -> Self {
        let rows = cases.iter().map(|case| case.as_ref().map_or_else(Clone::clone, |one| one.row.clone())).collect();
        Self { compared: cases.into_iter().flatten().collect(), answer: CompareAnswer { compared: rows } }
    }
}
