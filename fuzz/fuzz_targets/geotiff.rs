//! Any bytes as a GeoTIFF: no panic, and an accepted file reads back equal after writing.
#![no_main]

use chta::terrain::{geotiff_bytes, read_geotiff_bytes};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match read_geotiff_bytes(bytes.to_vec()) {
        Ok(dem) => {
            let written = geotiff_bytes(&dem).expect("a DEM that was read can be written");
            let again = read_geotiff_bytes(written).expect("a DEM that was written can be read");
            assert_eq!((again.rows(), again.cols()), (dem.rows(), dem.cols()));
            assert!(again.elevations().eq(dem.elevations()));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
