//! What a path takes from the machine's stores, as plain data and as sentences.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{HopRecord, TotalsRecord};
use crate::{
    path::{Hop, Totals},
    quantity::format_number,
};

/// The delta-v of a hop, its propellant and the mass after it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StoresRecord {
    /// Delta-v: of the take-off, of the brakes and the overhead.
    pub delta_v_m_s: f64,
    /// Propellant, if the specific impulse is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub propellant_kg: Option<f64>,
    /// Mass after it, if the specific impulse is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_end_kg: Option<f64>,
}

/// The columns of [`StoresRecord`] in path.csv: delta-v, and propellant and mass if some hop states them.
pub(super) fn stores_columns<'a>(rows: impl IntoIterator<Item = &'a HopRecord>) -> &'static [&'static str] {
    const ALL: [&str; 3] = ["delta_v_m_s", "propellant_kg", "mass_end_kg"];
    let has_propellant = rows.into_iter().any(|row| row.stores.propellant_kg.is_some());
    if has_propellant { &ALL } else { &ALL[..1] }
}

impl From<&Hop> for StoresRecord {
    fn from(hop: &Hop) -> Self {
        Self {
            delta_v_m_s: hop.delta_v_m_s,
            propellant_kg: hop.propellant.map(|propellant| propellant.used_kg),
            mass_end_kg: hop.propellant.map(|propellant| propellant.mass_end_kg),
        }
    }
}

impl StoresRecord {
    /// The fields of all [`stores_columns`]; an absent number is an empty field.
    pub(super) fn fields(&self) -> [String; 3] {
        [Some(self.delta_v_m_s), self.propellant_kg, self.mass_end_kg]
            .map(|number| number.map(|number| number.to_string()).unwrap_or_default())
    }
}

/// The propellant of a path that takes more than the machine has.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PropellantShortage {
    /// What the path takes, kg.
    pub needed_kg: f64,
    /// What the machine has, kg.
    pub max_kg: f64,
    /// The difference, kg.
    pub short_kg: f64,
}

impl PropellantShortage {
    /// That of a path's totals; `None` if the propellant suffices or no amount is given.
    pub fn of(totals: &Totals) -> Option<Self> {
        let short_kg = totals.propellant_short_kg()?;
        Some(Self { needed_kg: totals.propellant?.used_kg, max_kg: totals.propellant_max_kg?, short_kg })
    }

    /// The shortage as a sentence, without a claim about other paths.
    pub fn sentence(&self) -> String {
        format!(
            "this path takes {:.4} kg of propellant, {:.4} kg more than the {} kg that the machine has (hopper.propellant_max_kg); the \
             search looks for few hops, not for little propellant, so it is not proved that every path takes too much",
            self.needed_kg,
            self.short_kg,
            format_number(self.max_kg)
        )
    }
}

/// The lines about delta-v, propellant and the energy store below the totals of a path; empty for a machine without these keys.
pub(super) fn stores_lines(totals: &TotalsRecord) -> Vec<String> {
    let mut lines = Vec::new();
    if totals.propulsive {
        let propellant = totals
            .propellant_kg
            .zip(totals.mass_end_kg)
            .map_or_else(String::new, |(used_kg, end_kg)| format!(", propellant {used_kg:.4} kg, mass at the end {end_kg:.4} kg"));
        lines.push(format!("delta-v {:.4} m/s{propellant}", totals.delta_v_m_s));
    }
    if totals.energy_basis.is_some() {
        lines.push("energies are those taken from the store: of motion over the efficiency, and of the preparations".to_owned());
    }
    lines
}

/// The heading of the column of delta-v in the table of a path, and its fields; empty for a machine without these keys.
pub(super) fn delta_v_field(row: Option<&HopRecord>, totals: &TotalsRecord) -> String {
    match row {
        _ if !totals.propulsive => String::new(),
        None => format!("{:>10}", "dv m/s"),
        Some(row) => format!("{:>10.4}", row.stores.delta_v_m_s),
    }
}
