//! One hop, limit by limit.

use nalgebra::Point3;

use super::super::{AskError, Draft, OpenError, Purpose, Reply, map::inputs};
use crate::{
    report::DocumentKind,
    scenario::scenario_document,
    study::{CaseRecord, MeshHopQuestion, hop, mesh_hop},
};

/// Where a hop takes off and lands: `[x]` along a chain, `[x, y]` on a map, `[x, y, z]` over a mesh, m.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct HopAsked {
    /// Where it takes off; absent: at the scenario's start.
    pub from_m: Option<Vec<f64>>,
    /// Where it lands; absent: at the scenario's goal.
    pub to_m: Option<Vec<f64>>,
}

impl Draft {
    /// Tests one hop.
    ///
    /// # Errors
    /// [`AskError`]. That it is not feasible is an answer.
    pub fn hop(&self, asked: &HopAsked) -> Result<Reply, AskError> {
        if let (Some(&[x, y, z]), Some(&[u, v, w])) = (asked.from_m.as_deref(), asked.to_m.as_deref()) {
            return self.clone().hop_over_mesh([Point3::new(x, y, z), Point3::new(u, v, w)]);
        }
        let mut draft = self.clone();
        for (end, at) in [("start", &asked.from_m), ("goal", &asked.to_m)] {
            draft.place_end(end, at.as_deref())?;
        }
        let open = draft.case(Purpose::Hop)?;
        open.case.ends()?;
        let hopped = hop(&open.case)?;
        let json = open.document(DocumentKind::Hop, &hopped.warnings, &hopped.answer)?;
        Ok(Reply::new(DocumentKind::Hop, json, hopped.answer.feasible))
    }

    /// Sets the keys of an end. A hop between positions on a map goes straight: it has the bends of no scenario.
    fn place_end(&mut self, end: &'static str, at: Option<&[f64]>) -> Result<(), AskError> {
        match at {
            None => {}
            Some(&[x_m]) => self.entries.set_by_option(end, "terrain", &format!("{end}_x_m"), x_m.into()),
            Some(&[x_m, y_m]) => {
                for key in ["via_m", "via_lonlat_deg", &format!("{end}_lonlat_deg"), &format!("{end}_x_m")] {
                    self.entries.forget("terrain", key);
                }
                self.entries.set_by_option(end, "terrain", &format!("{end}_m"), vec![x_m, y_m].into());
            }
            Some(other) => {
                let found = format!("{} numbers", other.len());
                let expected = "X along a chain, X and Y on a map, or for both ends X, Y and Z on a mesh";
                return Err(AskError::Value { what: end, found, expected });
            }
        }
        Ok(())
    }

    /// Tests a hop over the mesh that the scenario names.
    fn hop_over_mesh(mut self, ends_m: [Point3<f64>; 2]) -> Result<Reply, AskError> {
        let (given, scale) = (self.entries.clone(), self.entries.mesh_scale());
        let no_mesh = AskError::NotHere { what: "positions of three numbers", why: "this scenario names no terrain.mesh" };
        let mesh = self.file_of("terrain.mesh").ok_or(no_mesh)?;
        self.forget_terrain();
        let scenario = self.validated(false)?;
        let keys = scenario.lacks_on_a_dem();
        if !keys.is_empty() {
            return Err(OpenError::Lacking { name: self.name, keys, terrain: "a mesh" }.into());
        }
        let unused = Purpose::Hop.unused(&given, &scenario, &self.wording);
        let warnings = unused.into_iter().chain(Purpose::replaced(&given)).collect();
        let name = self.wording.file_name;
        let document = scenario_document(&scenario, &|path| name(&self.base.join(path)));
        let inputs = inputs(std::slice::from_ref(&mesh), &self)?;
        let record = CaseRecord { scenario: document, inputs, warnings, crs: None };
        let hopped = mesh_hop(&MeshHopQuestion { scenario: &scenario, mesh: &mesh, scale, ends_m })?;
        let json = record.document(DocumentKind::HopMesh, &hopped.warnings, &hopped.answer).to_json()?;
        let reply = Reply::new(DocumentKind::HopMesh, json, hopped.answer.feasible);
        #[cfg(feature = "plot")]
        let reply = reply.drawn(move || Some(hopped.picture(&scenario)));
        Ok(reply)
    }
}
