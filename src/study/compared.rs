//! Several answers side by side, whatever they are about.

use crate::report::{CompareAnswer, CompareRow};

/// One of several scenarios, with its plan.
#[derive(Clone, Debug)]
pub struct Compared<P> {
    /// The plan.
    pub planned: P,
    /// Its row of the table.
    pub row: CompareRow,
}

/// Several scenarios with their plans.
#[derive(Clone, Debug)]
pub struct Comparison<P> {
    /// Those with an answer, in the order given.
    pub compared: Vec<Compared<P>>,
    /// The answer as plain data, with a row for every case.
    pub answer: CompareAnswer,
}

impl<P> Compared<P> {
    /// Warnings, each with the name of the file.
    pub(super) fn of_file(&self, warnings: impl IntoIterator<Item = String>) -> impl Iterator<Item = String> {
        warnings.into_iter().map(|warning| format!("{}: {warning}", self.row.file))
    }
}

impl<P> Comparison<P> {
    /// The answers side by side; a case without one has its row alone ([`CompareRow::failed`]).
    pub fn of(cases: Vec<Result<Compared<P>, CompareRow>>) -> Self {
        let rows = cases.iter().map(|case| case.as_ref().map_or_else(Clone::clone, |one| one.row.clone())).collect();
        Self { compared: cases.into_iter().flatten().collect(), answer: CompareAnswer { compared: rows } }
    }
}
