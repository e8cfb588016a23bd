//! Elevation rasters and meshes, and vertical slices of them.
//!
//! A [`Dem`] is a raster of elevations on a map in metres: read from a file whose format is recognised by content
//! ([`read_dem`]), generated from a seed ([`synthesise`]), or built in memory. [`slice`](slice()) intersects it with a
//! vertical plane and returns a [`Profile`], from which a polygonal chain is made. A new file format is one more
//! [`DemReader`], listed in [`FORMATS`]. A [`Mesh`] consists of triangles that may overhang, and [`slice_mesh`] slices it the
//! same way.
//!
//! ```
//! use chta::quantity::MapPoint;
//! use chta::terrain::{SyntheticTerrain, slice, synthesise};
//!
//! let dem = synthesise(&SyntheticTerrain { rows: 40, cols: 60, ..SyntheticTerrain::default() })?;
//! let profile = slice(&dem, MapPoint::new(2.0, 10.0), MapPoint::new(50.0, 30.0))?;
//! assert!((profile.length_m() - 52.0).abs() < 1e-9); // a 20-48-52 triangle
//! # Ok::<(), chta::terrain::TerrainError>(())
//! ```

mod ascii_grid;
mod dem;
mod error;
mod finer;
mod footprint;
mod foreign;
mod format;
#[cfg(feature = "gdal")]
mod gdal;
mod georeference;
mod geotiff;
mod lattice;
mod mesh;
mod no_data;
mod overlaid;
mod parts;
mod pds3;
mod profile;
mod projection;
mod shell_word;
mod sidecar;
mod slice;
mod stored;
mod surroundings;
mod synth;
mod text_lines;
mod void;
mod walk;
mod window;
mod xyz;
mod zones;

pub use ascii_grid::{read_ascii_grid_bytes, write_ascii_grid};
pub use dem::{Dem, ELEVATION_LIMIT_M, Samples};
pub use error::{AsciiProblem, GapCause, TerrainError};
pub(crate) use finer::points;
pub use footprint::{FootprintFit, FootprintGap};
pub(crate) use foreign::{Foreign, Group as ForeignGroup, name as foreign_kind};
pub(crate) use format::format_name as raster_format;
pub use format::{DemOptions, DemReader, FORMATS, open_dem, read_dem};
pub use georeference::{CoordinateSystem, DegreesMend, GeoReference, MapBounds, TransformTags};
pub use geotiff::{Band, ResultBands, geotiff_bytes, read_geotiff_bytes, result_geotiff_bytes, write_geotiff};
pub use lattice::PostLattice;
pub use mesh::{
    FaceKind, FaceKinds, Layers, MESH_FORMATS, Mesh, MeshBounds, MeshFile, MeshFlaws, MeshFormatWritten, MeshSlice, MeshTree,
    NearestOnMesh, SlabPolygon, VerticalPlane, WALL_RUN_M, Wall, looks_like_mesh, mesh_bytes, mesh_of_dem, read_mesh,
    read_mesh_bytes, read_mesh_with, slice_mesh,
};
pub(crate) use mesh::{binary_stl_length, format_name as mesh_format};
pub use no_data::{InvalidNoData, NoData, NoDataRule};
pub use overlaid::{OverlaidDem, OverlayEffect, Overlays};
pub use pds3::read_pds3_bytes;
pub use profile::{Profile, ProfileFacet, ProfilePoint};
pub use projection::{
    CrsError, Definition, Ellipsoid, LonLat, MapPlace, MapProjection, Method, NoProjection, ScaleExtreme, ScaleMend, TransectScale,
    check_map_scale, check_scale,
};
pub use shell_word::shell_word;
pub use sidecar::sidecar_files;
pub use slice::{slice, slice_file, slice_legs};
pub use surroundings::Surroundings;
pub use synth::{Boulders, Craters, DepthLaw, FractalGround, Rille, SyntheticMesh, SyntheticTerrain, synthesise, synthesise_mesh};
pub(crate) use text_lines::without_mark;
pub(crate) use void::find_void_of_chain;
pub use void::{VoidPlace, VoidTaken};
pub use walk::{FacetSpan, FacetWalk, Triangles};
pub use window::{DemFile, Window};
pub use xyz::read_xyz_bytes;
pub(crate) use zones::Touch;
pub use zones::{
    FrictionRaster, KeepOut, Layer, LayerCondition, LayerCost, LayerRule, MapLayers, OutageLimit, VectorFormat,
    read_friction_raster, read_keep_in, read_keep_out, read_layer,
};
