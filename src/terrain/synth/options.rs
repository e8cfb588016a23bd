//! Checks of option values.

use crate::terrain::TerrainError;

fn refuse(option: &'static str, value: f64, expected: String) -> TerrainError {
    TerrainError::InvalidOption { option, found: value.to_string(), expected }
}

/// A finite number of at least `lowest`.
pub(super) fn at_least(option: &'static str, value: f64, lowest: f64, unit: &str) -> Result<(), TerrainError> {
    if value.is_finite() && value >= lowest {
        Ok(())
    } else {
        Err(refuse(option, value, format!("at least {lowest} {unit}").trim_end().to_owned()))
    }
}

/// A number from `lowest` to `highest`.
pub(super) fn within(option: &'static str, value: f64, lowest: f64, highest: f64, unit: &str) -> Result<(), TerrainError> {
    if value >= lowest && value <= highest {
        Ok(())
    } else {
        Err(refuse(option, value, format!("{lowest} to {highest} {unit}").trim_end().to_owned()))
    }
}

/// The greatest number of craters or boulders, which a computer draws within a minute.
const MOST_THINGS: f64 = 1.0e7;

/// Refuses densities that give more craters or boulders.
pub(super) fn check_count(option: &'static str, count: f64) -> Result<(), TerrainError> {
    if count <= MOST_THINGS {
        return Ok(());
    }
    Err(TerrainError::InvalidOption {
        option,
        found: format!("so large that the map would hold {count:.3e} of them"),
        expected: format!("at most {MOST_THINGS:e}; lower it, or raise the smallest diameter"),
    })
}
