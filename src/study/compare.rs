//! Several scenarios side by side.

use super::{Case, Compared, Comparison, PlanError, PlanOptions, Planned, Proof, plan};
#[cfg(feature = "plot")]
use crate::figure::{Caption, CompareFigure, ComparedScenario, FigureError, Flight, Picture, draw_compare};
use crate::{
    progress::Progress,
    report::{CompareRow, MarginsRecord, TotalsRecord},
};

impl Compared<Planned> {
    /// A plan and the file of its scenario; `untitled` is the name of a scenario without a title.
    pub fn of(planned: Planned, file: String, untitled: &str) -> Self {
        let (check, path) = (&planned.answer.check, planned.path.as_ref());
        let row = CompareRow {
            file,
            name: planned.case.scenario.title.clone().unwrap_or_else(|| untitled.to_owned()),
            start_x_m: Some(check.start_x_m),
            goal_x_m: Some(check.goal_x_m),
            start_m: None,
            goal_m: None,
            verdict: Some(check.verdict),
            hops: check.hops,
            lower_bound: check.proof.as_ref().map(|proof| proof.lower_bound),
            totals: path.map(|path| TotalsRecord::from(&path.totals)),
            margins: path.and_then(MarginsRecord::of),
            error: None,
        };
        Self { planned, row }
    }

    /// The warnings about the input and the path, each with the name of the file.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.of_file(self.planned.case.warnings_with(self.planned.warnings.iter().cloned()))
    }
}

/// Plans for every case, named by its file, and shows the answers side by side. A case that fails has a row with its error.
///
/// # Errors
/// [`PlanError`] if it was cancelled.
pub fn compare(cases: &[(&str, &Case)], proof: Option<Proof>, progress: &dyn Progress) -> Result<Comparison<Planned>, PlanError> {
    let options = PlanOptions { proof, ..PlanOptions::default() };
    let compared = |&(file, case): &(&str, &Case)| match plan(case, options, progress) {
        Ok(planned) => Ok(Ok(Compared::<Planned>::of(planned, file.to_owned(), file))),
        Err(error) if error.is_cancelled() => Err(error),
        Err(error) => {
            let name = case.scenario.title.clone().unwrap_or_else(|| file.to_owned());
            Ok(Err(CompareRow::failed(file.to_owned(), name, error.to_string())))
        }
    };
    Ok(Comparison::of(cases.iter().map(compared).collect::<Result<_, PlanError>>()?))
}

#[cfg(feature = "plot")]
impl Comparison<Planned> {
    /// The picture with all paths overlaid.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn picture(&self) -> Result<Picture, FigureError> {
        let words = |one: &Compared<Planned>| {
            let hops = one.row.hops.map(|hops| format!(", {hops} hop{}", if hops == 1 { "" } else { "s" })).unwrap_or_default();
            let beside = one.planned.path.iter().flat_map(|path| &path.hops).any(crate::path::Hop::is_beside_line);
            let drawn = if beside { " beside the line, drawn projected on it" } else { "" };
            format!("{}: {}{hops}{drawn}", one.row.name, one.row.format_verdict())
        };
        let failed = self.answer.compared.iter().filter(|row| row.error.is_some());
        let failed = failed.map(|row| format!("{}: {}", row.name, row.format_verdict()));
        let line = self.compared.iter().map(words).chain(failed).collect::<Vec<_>>().join("; ");
        let names: Vec<_> = self.compared.iter().map(|one| one.row.name.as_str()).collect();
        let scenarios = self.compared.iter().map(Compared::<Planned>::drawn).collect();
        draw_compare(&CompareFigure { caption: Caption::new(names.join(" and "), line), scenarios })
    }
}

#[cfg(feature = "plot")]
impl Compared<Planned> {
    /// The scenario as the picture shows it.
    fn drawn(&self) -> ComparedScenario {
        let (start, goal) = self.planned.ends;
        ComparedScenario {
            name: self.row.name.clone(),
            verdict: self.row.format_verdict(),
            hops: self.row.hops,
            ground: self.planned.case.prepared.chain.geometry().vertices().to_vec(),
            start: start.point,
            goal: goal.point,
            flights: self.planned.path.iter().flat_map(|path| &path.hops).map(Flight::from).collect(),
        }
    }
}
