//! What lies over the terrain and changes what it allows: keep-out zones and a raster of friction.
//!
//! Both are known along the straight line of a slice as stretches: `line` holds the slice's line on the map and puts vertices where a
//! stretch ends, so that every segment is wholly inside or outside; `polygons` and `cells` find the stretches.
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
mod line;
mod polygons;

pub use friction::{FrictionRaster, read_friction_raster};
pub use keep_out::{KeepOut, read_keep_out};

#[cfg(test)]
mod tests;
