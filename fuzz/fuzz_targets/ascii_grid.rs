//! Any bytes as an ESRI ASCII grid: no panic, and an accepted file reads back equal after writing.
#![no_main]

use chta::terrain::{read_ascii_grid_bytes, write_ascii_grid};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match read_ascii_grid_bytes(bytes) {
        Ok(dem) => {
            let mut written = Vec::new();
            write_ascii_grid(&dem, &mut written).expect("a DEM that was read can be written");
            let again = read_ascii_grid_bytes(&written).expect("a DEM that was written can be read");
            assert_eq!((again.rows(), again.cols()), (dem.rows(), dem.cols()));
            assert!(again.elevations().eq(dem.elevations()));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
