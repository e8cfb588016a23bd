//! The compiled part of the Python package `chta`. `python/chta` wraps it: numbers, bytes and JSON cross the border, and what Python sees
//! is made there.

mod chain;
mod dem;
mod draft;
mod errors;
mod machine;
mod watch;

use pyo3::prelude::*;

/// The compiled part of `chta`.
#[pymodule(name = "_chta")]
fn chta_module(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add("LIMITS", chta::world::Limit::ALL.map(chta::world::Limit::name).to_vec())?;
    m.add("VERSION", env!("CARGO_PKG_VERSION"))?;
    m.add_class::<chain::Chain>()?;
    m.add_class::<dem::Dem>()?;
    m.add_class::<draft::Draft>()?;
    m.add_class::<draft::Reply>()?;
    m.add_class::<draft::Rasters>()?;
    m.add_function(wrap_pyfunction!(draft::arena, m)?)?;
    m.add_function(wrap_pyfunction!(draft::stance_of_contacts, m)?)?;
    Ok(())
}
