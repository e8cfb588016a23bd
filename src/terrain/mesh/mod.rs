//! Triangulated surfaces, including closed and overhanging ones, and their slices.
//!
//! A [`Mesh`] is read from OBJ, STL or PLY, recognised by content ([`read_mesh`]), with z up, or built in memory.
//! [`slice_mesh`] intersects it with a vertical plane and gives the same [`Profile`](super::Profile) as for a DEM. It reports
//! where it had to choose: the upper of several surfaces, and walls.
//!
//! ```
//! use chta::quantity::MapPoint;
//! use chta::terrain::{read_mesh_bytes, slice_mesh};
//!
//! let ramp = b"v 0 -1 0\nv 4 -1 2\nv 4 1 2\nv 0 1 0\nf 1 2 3 4\n";
//! let mesh = read_mesh_bytes(ramp, 1.0)?.mesh;
//! let slice = slice_mesh(&mesh, MapPoint::new(0.0, 0.0), MapPoint::new(4.0, 0.0))?;
//! let heights: Vec<f64> = slice.profile.points.iter().map(|point| point.z_m).collect();
//! assert_eq!(heights, [0.0, 1.0, 2.0]); // the polygon's diagonal is crossed half-way
//! # Ok::<(), chta::terrain::TerrainError>(())
//! ```

mod bodies;
mod build;
mod ears;
mod faces;
mod flaws;
mod format;
mod model;
mod obj;
mod of_dem;
mod ply;
mod slab;
mod slice;
mod stl;
mod text;
mod tree;
mod voids;
mod write;

pub(super) use faces::FaceKindsBuilder;
pub use faces::{FaceKind, FaceKinds};
pub use flaws::MeshFlaws;
pub use format::{MESH_FORMATS, MeshFile, looks_like_mesh, read_mesh, read_mesh_bytes, read_mesh_with};
pub(crate) use format::{binary_stl_length, format_name};
pub use model::{Mesh, MeshBounds};
pub use of_dem::mesh_of_dem;
pub use slab::SlabPolygon;
pub use slice::{Layers, MeshSlice, WALL_RUN_M, Wall, slice_mesh};
pub use tree::{MeshTree, NearestOnMesh, VerticalPlane};
pub use write::{MeshFormatWritten, mesh_bytes};
