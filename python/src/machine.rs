//! A machine, its surface and its body without a terrain: the tables of a scenario, validated as those are.

use chta::{scenario::Scenario, study::open::Draft};
use pyo3::prelude::*;

use crate::errors;

/// The scenario of these tables (JSON), with all that hops over terrain without columns need.
pub(crate) fn scenario_of(py: Python<'_>, tables: &str) -> PyResult<Scenario> {
    let tables = serde_json::from_str(tables).map_err(|error| errors::input(py, "tables", error, "JSON"))?;
    let draft = Draft::of_tables(&tables, "".as_ref());
    draft.validated(false).map_err(|found| errors::problems(py, &found))
}

/// Refuses a scenario that lacks keys for hops.
pub(crate) fn complete(py: Python<'_>, scenario: &Scenario) -> PyResult<()> {
    match scenario.lacks_on_a_dem().first() {
        Some(lacking) => Err(errors::input(py, lacking.key, "absent", "a value, since the terrain states none")),
        None => Ok(()),
    }
}
