//! Every file of the shared folder is read or refused as docs/formats.md states; the table there comes from real runs, and GDAL
//! agrees on what was read.
//!
//! `CHTA_UPDATE_DOCS=1 cargo test --test library formats_table` writes the table again.
#![allow(clippy::cast_precision_loss, reason = "rows and columns are small")]
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and says why it skips")]

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use chta::terrain::{Dem, FORMATS, TerrainError, looks_like_mesh, read_dem, read_mesh};

use crate::installed::has_gdal;

const BEGIN: &str = "<!-- table: tests/library/formats_table.rs writes it -->\n";
const END: &str = "<!-- end of table -->\n";

/// All files but the folder's own README, by name.
fn files() -> Option<Vec<(String, PathBuf)>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem");
    if !folder.is_dir() {
        eprintln!("skipped: {} is absent", folder.display());
        return None;
    }
    let mut found = Vec::new();
    for (prefix, folder) in [("", folder.clone()), ("interop/", folder.join("interop"))] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            if path.is_file() && name != "README.md" && !name.ends_with(".aux.xml") {
                found.push((format!("{prefix}{name}"), path));
            }
        }
    }
    found.sort();
    Some(found)
}

/// The sentence without the file's path, which differs from machine to machine.
fn sentence(error: TerrainError) -> String {
    match error {
        TerrainError::InFile { problem, .. } => problem.to_string(),
        other => other.to_string(),
    }
}

fn verdict(path: &Path) -> String {
    if looks_like_mesh(path) {
        return match read_mesh(path, 1.0) {
            Ok(file) => {
                let bounds = file.mesh.bounds();
                format!(
                    "mesh, read by `slice` and `[terrain] mesh`: {}, heights from {} to {}, in the file's own unit",
                    bounds.map, bounds.low_m, bounds.high_m
                )
            }
            Err(error) => format!("refused: {}", sentence(error)),
        };
    }
    match read_dem(path) {
        Ok(dem) => {
            let (low_m, high_m) = dem.elevation_range_m();
            let map = dem.georeference();
            let system = match map.projection() {
                Ok(projection) => {
                    let code = projection.code().map_or_else(String::new, |code| format!(" ({code})"));
                    format!("{}{code}", projection.name())
                }
                Err(_) => map.coordinate_system.description.clone().unwrap_or_else(|| "none stated".to_owned()),
            };
            format!(
                "read: {} rows, {} columns, {low_m} to {high_m} m; north-west post ({}, {}) m, spacing {} by {} m; map: {system}",
                dem.rows(),
                dem.cols(),
                map.north_west().x,
                map.north_west().y,
                map.dx_m(),
                map.dy_m(),
            )
        }
        Err(error) => format!("refused: {}", sentence(error)),
    }
}

#[test]
fn the_table_of_the_documentation_agrees_with_real_runs() {
    let Some(files) = files() else { return };
    let mut table = "| file | verdict |\n|---|---|\n".to_owned();
    for (name, path) in &files {
        writeln!(table, "| {name} | {} |", verdict(path).replace('|', "\\|").replace('\n', " ")).unwrap();
    }
    let documentation = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/formats.md");
    let text = std::fs::read_to_string(&documentation).unwrap();
    let (before, rest) = text.split_once(BEGIN).unwrap();
    let (old, after) = rest.split_once(END).unwrap();
    if std::env::var_os("CHTA_UPDATE_DOCS").is_some() {
        std::fs::write(&documentation, format!("{before}{BEGIN}{table}{END}{after}")).unwrap();
    } else {
        assert_eq!(old, table, "docs/formats.md is out of date: run with CHTA_UPDATE_DOCS=1");
    }
}

#[test]
fn the_documentation_names_every_format() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/formats.md")).unwrap();
    for (name, _) in FORMATS {
        assert!(text.contains(name), "docs/formats.md does not mention {name}");
    }
}

fn run(program: &str, arguments: &[&str]) -> Vec<u8> {
    let output = Command::new(program).args(arguments).env("GDAL_PAM_ENABLED", "NO").output().unwrap();
    assert!(output.status.success(), "{program} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// Rows, columns, extremes and transform from gdalinfo. `-mm` computes the extremes; `-stats` would use those stated in the file.
fn compare_with_gdalinfo(name: &str, path: &Path, dem: &Dem) {
    let info: serde_json::Value = serde_json::from_slice(&run("gdalinfo", &["-json", "-mm", path.to_str().unwrap()])).unwrap();
    let number =
        |pointer: &str| info.pointer(pointer).and_then(serde_json::Value::as_f64).unwrap_or_else(|| panic!("{name}: {pointer}"));
    let map = dem.georeference();
    assert_eq!((number("/size/0"), number("/size/1")), (dem.cols() as f64, dem.rows() as f64), "{name}");
    let (low_m, high_m) = dem.elevation_range_m();
    // gdalinfo rounds to the millimetre.
    for (ours, pointer) in [(low_m, "/bands/0/computedMin"), (high_m, "/bands/0/computedMax")] {
        assert!((ours - number(pointer)).abs() <= 0.000_501, "{name}: {ours}, {pointer} {}", number(pointer));
    }
    let transform: Vec<f64> = (0..6).map(|place| number(&format!("/geoTransform/{place}"))).collect();
    let centre = [transform[0] + 0.5 * transform[1], transform[3] + 0.5 * transform[5]];
    let near = |ours: f64, theirs: f64| (ours - theirs).abs() <= 1e-9 * map.dx_m().max(theirs.abs() * 1e-3);
    assert!(near(map.north_west().x, centre[0]) && near(map.north_west().y, centre[1]), "{name}: {centre:?}");
    assert!(near(map.dx_m(), transform[1]) && near(map.dy_m(), -transform[5]), "{name}: {transform:?}");
    assert_eq!((transform[2], transform[4]), (0.0, 0.0), "{name}");
}

/// Every post as read by GDAL, as raw doubles.
fn compare_every_post(name: &str, path: &Path, dem: &Dem) {
    let folder = tempfile::tempdir().unwrap();
    let raw = folder.path().join("raw.img");
    // GDAL rounds text output to 32 bits by default.
    let exactly: &[&str] = if name.to_ascii_lowercase().ends_with(".asc") { &["-oo", "DATATYPE=Float64"] } else { &[] };
    let files = [path.to_str().unwrap(), raw.to_str().unwrap()];
    run("gdal_translate", &[&["-q", "-of", "ENVI", "-ot", "Float64"], exactly, &files].concat());
    let bytes = std::fs::read(&raw).unwrap();
    assert_eq!(bytes.len(), dem.rows() * dem.cols() * 8, "{name}");
    for (post, theirs) in dem.elevations().zip(bytes.chunks_exact(8)) {
        let theirs = f64::from_le_bytes(theirs.try_into().unwrap());
        assert!(post.is_none_or(|ours| ours == theirs), "{name}: {post:?} {theirs}");
    }
}

#[test]
fn gdal_agrees_on_every_file_that_is_read() {
    let (Some(files), true) = (files(), has_gdal()) else { return };
    let mut read = 0;
    for (name, path) in files {
        let Ok(dem) = read_dem(&path) else { continue };
        // A copy: gdalinfo would write statistics beside the original, and read older ones there.
        let folder = tempfile::tempdir().unwrap();
        let copy = folder.path().join(path.file_name().unwrap());
        std::fs::copy(&path, &copy).unwrap();
        compare_with_gdalinfo(&name, &copy, &dem);
        compare_every_post(&name, &copy, &dem);
        read += 1;
    }
    assert!(read >= 5, "{read}");
}
