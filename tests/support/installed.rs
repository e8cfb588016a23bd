//! Which programs this machine has: tests that need another one say so and skip.
#![allow(clippy::print_stderr, dead_code, reason = "a test says why it skips; every test crate uses a part of it")]

use std::process::Command;

/// Whether a program is installed; says so if not.
pub(crate) fn installed(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok();
    if !found {
        eprintln!("skipped: {program} is not installed");
    }
    found
}

/// Whether the programs of GDAL that tests use are installed; says so if not.
pub(crate) fn has_gdal() -> bool {
    ["gdal_translate", "gdalwarp", "gdalinfo", "gdaltransform", "ogrinfo", "ogr2ogr"].into_iter().all(installed)
}
