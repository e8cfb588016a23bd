//! The path of a result over a mesh, flown again: as plain data, and as text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{MeshContactRecord, mesh_plan_answer::point, text::Sheet};
use crate::path::{Measure, Violation};

/// The answer of `chta check` for a result over a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshCheckAnswer {
    /// Metres per unit of the mesh's file.
    pub mesh_scale: f64,
    /// Where the path has to begin, on the surface.
    pub start: MeshContactRecord,
    /// Where it has to end, on the surface.
    pub goal: MeshContactRecord,
    /// Its hops.
    pub hops: usize,
    /// Whether it was flown again by direct simulation without breaking a limit.
    pub holds: bool,
    /// What it breaks, hop by hop; empty where it holds.
    pub violations: Vec<ViolationRecord>,
}

/// A limit that a hop breaks when it is flown again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ViolationRecord {
    /// The hop, from 1; 0 if the path has none.
    pub hop: usize,
    /// The limit, or what else does not hold: `landing-point`, `continuity`, or a `stated` number.
    pub limit: String,
    /// What was flown, or for a stated number what the path states; null without a number.
    pub found: Option<f64>,
    /// What is allowed, or for a stated number what was flown; null without a number.
    pub allowed: Option<f64>,
    /// The unit of both; null without numbers.
    pub unit: Option<String>,
    /// The facet that is passed through or too near, by its number from 1; null for other limits.
    pub facet: Option<usize>,
    /// The same as a sentence.
    pub sentence: String,
}

impl From<&Violation> for ViolationRecord {
    fn from(violation: &Violation) -> Self {
        let Violation { hop, limit, measure, facet, .. } = violation;
        let of = |number: fn(&Measure) -> f64| measure.as_ref().map(number).filter(|number| number.is_finite());
        Self {
            hop: *hop,
            limit: limit.to_string(),
            found: of(|measure| measure.found),
            allowed: of(|measure| measure.allowed),
            unit: measure.map(|measure| measure.unit.to_owned()),
            facet: facet.map(|facet| facet.index() + 1),
            sentence: violation.to_string(),
        }
    }
}

/// The text of `chta check` for a result over a mesh.
pub fn mesh_check_text(answer: &MeshCheckAnswer) -> String {
    let mut sheet = Sheet::default();
    let hops = format!("{} hop{}", answer.hops, if answer.hops == 1 { "" } else { "s" });
    let ends = format!("from {} to {}", point(answer.start.point_m), point(answer.goal.point_m));
    if answer.holds {
        sheet.line(format_args!("the path holds: {hops} {ends} flown again by direct simulation, and no limit is broken"));
    } else {
        let count = answer.violations.len();
        let s = if count == 1 { "" } else { "s" };
        sheet.line(format_args!("the path does not hold: {hops} {ends} flown again by direct simulation, {count} violation{s}"));
    }
    for violation in &answer.violations {
        sheet.line(format_args!("  {}", violation.sentence));
    }
    sheet.into_text()
}
