//! Keep-out zones and friction rasters, which are read from files, with seeded mutations: no panic, no endless run.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and prints its counts")]

use crate::mutations::{copy, mutated, replace_digit, rounds, truncate_or_redraw};
use crate::tiff::int16_tiff;
use chta::quantity::MapPoint;
use chta::terrain::{MapBounds, TerrainError, read_friction_raster, read_keep_out};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use std::path::Path;

pub(crate) const ZONES: &str = r#"{"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32633"}},
    "features": [{"type": "Feature", "properties": {"name": "pit"}, "geometry": {"type": "Polygon", "coordinates":
    [[[0, 0], [10, 0], [10, 5.5], [0, 0]], [[2, 0.5], [3, 0.5], [3, 1], [2, 0.5]]]}}, {"type": "Feature", "properties": null, "geometry":
    {"type": "MultiPolygon", "coordinates": [[[[20, 20], [30, 20], [25, 3e1], [20, 20]]]]}}]}"#;

pub(crate) const BOUNDS: MapBounds = MapBounds { min: MapPoint::new(0.0, 0.0), max: MapPoint::new(100.0, 100.0) };

/// Files are a thousand times slower than memory.
fn fewer() -> usize {
    rounds().div_ceil(4)
}

fn check(name: &str, whole: &[u8], read: impl Fn(&Path) -> Result<(), TerrainError>) {
    const TELLING: &[u8] = b"[]{}\"'=.,:#\\\n\r\t 0123456789-+eE_inaft\0\x01\x02\xff\xc3";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("overlay");
    let mut random = ChaCha8Rng::seed_from_u64(20_261_128);
    let rounds = fewer();
    let mut read_well = 0;
    for number in 0..rounds {
        let bytes = mutated(&mut random, whole, |rng, bytes, range| {
            let at = range.start;
            match rng.random_range(0..7) {
                0 => bytes[at] ^= 1 << rng.random_range(0..8),
                1 => bytes[at] = TELLING[rng.random_range(0..TELLING.len())],
                2 => drop(bytes.drain(range)),
                3 => copy(rng, bytes, range),
                4 | 5 => replace_digit(rng, bytes),
                _ => truncate_or_redraw(rng, bytes, at),
            }
        });
        std::fs::write(&path, bytes).unwrap();
        match read(&path) {
            Ok(()) => read_well += 1,
            Err(error) => {
                let message = error.to_string();
                assert!(!message.is_empty() && message.len() < 20_000, "mutation {number}: {message}");
            }
        }
    }
    assert!(read_well > 0 && read_well < rounds, "{name}: {read_well} of {rounds}");
    eprintln!("{name}: {read_well} of {rounds} mutations still read");
}

#[test]
fn mutated_zones_never_panic() {
    check("GeoJSON", ZONES.as_bytes(), |path| read_keep_out(path, None, BOUNDS).map(|_| ()));
}

#[test]
fn mutated_friction_rasters_never_panic() {
    check("friction GeoTIFF", &int16_tiff(&[]), |path| read_friction_raster(path, None).map(|_| ()));
    let text = b"ncols 3\nnrows 2\nxllcorner 10\nyllcorner -20\ncellsize 2\nNODATA_value -1\n0.5 0.6 0.7\n0.8 -1 1e0\n";
    check("friction ASCII grid", text, |path| read_friction_raster(path, None).map(|_| ()));
}
