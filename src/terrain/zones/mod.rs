//! Overlays that change what the terrain allows: keep-out zones, a friction raster and layers.
//!
//! Layers are judged at the points and along the lines of the map that they are asked about. Zones and friction are converted to stretches of the straight line of a slice. `line` holds the slice's line on the map and adds
//! vertices where a stretch ends, so that every segment is wholly inside or outside; `polygons` and `cells` compute the
//! stretches.
//!
//! ```text
//!   map:      ...../####\.....         profile before:   o---------o------------o
//!   line:   --o---/######\---o-->      profile after:    o----x====o====x-------o      ==== keep-out
//!                 \######/
//! ```

mod cells;
mod friction;
mod geojson;
mod keep_out;
mod layer;
mod line;
mod polygons;
mod same_map;
mod vector;

pub use friction::{FrictionRaster, read_friction_raster};
pub use keep_out::{KeepOut, read_keep_in, read_keep_out};
pub(crate) use layer::Touch;
pub use layer::{Layer, LayerCondition, LayerCost, LayerRule, MapLayers, OutageLimit, read_layer};
pub use vector::VectorFormat;

#[cfg(test)]
mod tests;
