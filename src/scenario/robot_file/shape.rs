//! The shapes that a robot file names: meshes of workspaces and of trunk boxes.

use std::path::Path;

use nalgebra::{Point3, Vector3};

use crate::{
    terrain::{Mesh, read_mesh},
    world::{ConvexWorkspace, TrunkBox},
};

/// A mesh whose volume is this share of its hull's, or closer to it, counts as convex. Of 36 workspaces published for legged robots, 31 have at least this share, and five
/// 0.92 to 0.98.
const CONVEX_SHARE: f64 = 0.99;

/// Why a file gives no shape: what was found, and how to mend it.
pub(super) struct Refused {
    pub(super) message: String,
    pub(super) help: String,
}

/// The mesh of a file, with what its reader says.
fn mesh(path: &Path, unit_m: f64) -> Result<(Mesh, Vec<String>), Refused> {
    let file = read_mesh(path, unit_m).map_err(|error| Refused {
        message: error.to_string(),
        help: "give a closed mesh, STL, OBJ or PLY, by its path from this file's folder".to_owned(),
    })?;
    Ok((file.mesh, file.warnings))
}

/// The workspace of a mesh: its convex hull.
pub(super) fn workspace(path: &Path, unit_m: f64, of: &str, warnings: &mut Vec<String>) -> Result<ConvexWorkspace, Refused> {
    let (mesh, notes) = mesh(path, unit_m)?;
    let name = path.display();
    warnings.extend(notes.into_iter().map(|note| format!("{of}: {name}: {note}")));
    let hull = ConvexWorkspace::of_mesh(mesh.vertices(), mesh.indices()).map_err(|error| Refused {
        message: format!("{name}: {error}"),
        help: "a workspace is a body: give a closed mesh with a volume, or a shell".to_owned(),
    })?;
    let (share, edges) = (hull.mesh_share(), hull.open_edges());
    let percent = 100.0 * share;
    if edges > 0 {
        warnings.push(format!(
            "{of}: {name} is not closed ({edges} edges without a neighbour of the same orientation): its convex hull is the workspace; seen from the hull's middle, the mesh covers {percent:.1} % of \
             the hull's volume"
        ));
    } else if !(CONVEX_SHARE..=1.0 / CONVEX_SHARE).contains(&share) {
        warnings.push(format!(
            "{of}: {name} is not convex: its convex hull is the workspace, of whose volume the mesh encloses {percent:.1} %; elsewhere in the hull the foot may be \
             out of reach"
        ));
    }
    Ok(hull)
}

/// The box around a mesh, along the axes of the trunk frame.
pub(super) fn trunk_box(path: &Path, unit_m: f64, of: &str, warnings: &mut Vec<String>) -> Result<TrunkBox, Refused> {
    let (mesh, notes) = mesh(path, unit_m)?;
    let name = path.display();
    warnings.extend(notes.into_iter().map(|note| format!("{of}: {name}: {note}")));
    let bounds = mesh.bounds();
    let low = Point3::new(bounds.map.min.x, bounds.map.min.y, bounds.low_m);
    let high = Point3::new(bounds.map.max.x, bounds.map.max.y, bounds.high_m);
    let half: Vector3<f64> = 0.5 * (high - low);
    if half.iter().any(|half| *half <= 0.0) {
        return Err(Refused {
            message: format!("{name} is flat: the box around it is {} m by {} m by {} m", 2.0 * half.x, 2.0 * half.y, 2.0 * half.z),
            help: "give a mesh with a volume, or size_m".to_owned(),
        });
    }
    Ok(TrunkBox::upright(nalgebra::center(&low, &high), half))
}
