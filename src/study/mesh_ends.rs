//! What every question over a mesh with a start and a goal begins with: the ground, and the contacts of both.

use std::path::Path;

use nalgebra::Point3;

use super::{
    MeshRouteError,
    mesh_hop::{check_keys, mesh_ground, on_mesh},
};
use crate::{
    ground::{MeshContact, MeshGround},
    planner::roadmap::SpaceBounds,
    scenario::{Scenario, TerrainSource},
};

/// The ground of a mesh, with start and goal.
#[derive(Clone, Debug)]
pub(super) struct MeshEnds {
    /// The ground under the limits that planning may use.
    pub(super) ground: MeshGround,
    /// Metres per unit of the file.
    pub(super) scale: f64,
    /// Start and goal as given, m.
    pub(super) given_m: [Point3<f64>; 2],
    /// Start and goal on the surface.
    pub(super) surface: [MeshContact; 2],
    /// The same where they stand off it.
    pub(super) stood: [MeshContact; 2],
    /// How far contacts stand off the surface, m.
    pub(super) stand_off_m: f64,
    /// Warnings about the mesh and its ends.
    pub(super) warnings: Vec<String>,
}

/// Reads the mesh of a scenario and moves start and goal to it, so far off its surface.
///
/// # Errors
/// [`MeshRouteError`], of the mesh, its keys, or an end that gives no contact.
pub(super) fn mesh_ends(scenario: &Scenario, base: &Path, stand_off_m: f64) -> Result<MeshEnds, MeshRouteError> {
    let Some(TerrainSource::MeshInSpace { path: file, scale, start_m, goal_m }) = &scenario.terrain else {
        return Err(MeshRouteError::NoMesh);
    };
    check_keys(scenario)?;
    let (ground, mut warnings) = mesh_ground(scenario, &base.join(file), *scale)?;
    let search = &scenario.mesh_search;
    let surface = [(*start_m, "start"), (*goal_m, "goal")].map(|(at, end)| {
        let contact = on_mesh(&ground, at, end, &mut warnings)?;
        within(search.bounds, end, contact)
    });
    let [start, goal] = surface;
    let surface = [start?, goal?];
    let stood = |contact: &MeshContact, end| {
        let point_m = contact.point_m();
        ground.stood_off(contact, stand_off_m).ok_or(MeshRouteError::NoStandOff { end, point_m, stand_off_m })
    };
    let ends = [stood(&surface[0], "start")?, stood(&surface[1], "goal")?];
    Ok(MeshEnds { scale: *scale, given_m: [*start_m, *goal_m], surface, stood: ends, stand_off_m, warnings, ground })
}

/// A contact, if it lies within the bounds.
pub(super) fn within(bounds: Option<SpaceBounds>, end: &'static str, contact: MeshContact) -> Result<MeshContact, MeshRouteError> {
    match bounds {
        Some(bounds) if !bounds.contain(&contact.point_m()) => {
            Err(MeshRouteError::OutsideBounds { end, point_m: contact.point_m(), bounds })
        }
        _ => Ok(contact),
    }
}
