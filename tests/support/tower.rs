//! A raster with an obstacle too high to hop over.
#![allow(clippy::unwrap_used, reason = "a test that cannot set its stage should stop")]

use chta::{
    quantity::MapPoint,
    terrain::{Dem, GeoReference},
};

/// A plain of 5 m posts over 60 m by 60 m with a tower of 50 m in its middle.
pub(crate) fn tower() -> Dem {
    let map = GeoReference::local(MapPoint::new(0.0, 60.0), 5.0, 5.0).unwrap();
    let height = |i: usize| if (5..8).contains(&(i / 13)) && (5..8).contains(&(i % 13)) { 50.0 } else { 0.0 };
    Dem::new(13, 13, (0..169).map(height).collect(), map).unwrap()
}
