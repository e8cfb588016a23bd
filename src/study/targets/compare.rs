//! Several missions over targets side by side.

use super::{super::Compared, plan::TargetsPlanned};
use crate::report::{CompareRow, MarginsRecord};

impl Compared<TargetsPlanned> {
    /// A plan and the file of its scenario; `untitled` is the name of a scenario without a title. The goal is where the mission ends.
    pub fn of(planned: TargetsPlanned, file: String, untitled: &str) -> Self {
        let answer = &planned.answer;
        let row = CompareRow {
            file,
            name: planned.case.scenario.title.clone().unwrap_or_else(|| untitled.to_owned()),
            start_x_m: None,
            goal_x_m: None,
            start_m: Some(answer.start_m),
            goal_m: answer.visits.last().map(|visit| visit.at_m),
            verdict: Some(answer.verdict),
            hops: answer.hops,
            lower_bound: answer.hops_lower_bound.map(Some),
            totals: planned.totals_record(),
            margins: planned.path().and_then(MarginsRecord::of),
            error: None,
        };
        Self { planned, row }
    }

    /// The warnings about the input and the plan, each with the name of the file.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.of_file(self.planned.case.warnings_with(self.planned.warnings.iter().cloned()))
    }
}
