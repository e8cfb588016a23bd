//! Several missions side by side.

use super::{super::Compared, plan::TravelPlanned};
use crate::report::CompareRow;

impl Compared<TravelPlanned> {
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
        self.of_file(self.planned.case.warnings_with(self.planned.warnings.iter().cloned()))
    }
}
