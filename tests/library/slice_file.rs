//! Slices that read only windows of a file against slices of the whole file, for every layout that GDAL writes.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::path::Path;
use std::process::Command;

use chta::quantity::MapPoint;
use chta::terrain::{SyntheticTerrain, Window, geotiff_bytes, open_dem, read_dem, slice, slice_file, synthesise, write_ascii_grid};

use crate::installed::has_gdal;

/// Lines along rows, columns, diagonals, borders and others give the same profile to the bit, or the same refusal.
fn check(path: &Path) {
    let dem = read_dem(path).unwrap();
    let (low, high) = (dem.bounds().min, dem.bounds().max);
    let at = |u: f64, v: f64| MapPoint::new(low.x + u * (high.x - low.x), low.y + v * (high.y - low.y));
    let post = |row, col| dem.georeference().post(row, col);
    let ways = [
        (at(0.0, 0.0), at(1.0, 1.0)),
        (at(0.013, 0.91), at(0.87, 0.17)),
        (at(0.5, 1.0), at(0.5, 0.0)),
        (at(1.0, 0.0), at(0.0, 0.0)),
        (post(3, 2), post(3, dem.cols() - 4)),
        (post(dem.rows() - 2, 7), post(1, 7)),
        (post(5, 5), post(105, 105)),
        (at(0.31, 0.42), at(0.311, 0.42)),
        (at(0.2, 0.2), at(1.2, 0.2)),
    ];
    for (from, to) in ways {
        for (from, to) in [(from, to), (to, from)] {
            match (slice_file(path, from, to), slice(&dem, from, to)) {
                (Ok(parts), Ok(whole)) => assert_eq!(parts, whole, "{}", path.display()),
                (Err(parts), Err(whole)) => assert!(parts.to_string().ends_with(&whole.to_string()), "{parts}\n{whole}"),
                (parts, whole) => panic!("{}: {:?} {:?}", path.display(), parts.is_ok(), whole.is_ok()),
            }
        }
    }
}

fn made() -> SyntheticTerrain {
    SyntheticTerrain { rows: 310, cols: 270, south_west: MapPoint::new(-75_360.5, 609_600.25), ..SyntheticTerrain::default() }
}

#[test]
fn windows_of_our_own_files_slice_as_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let dem = synthesise(&made()).unwrap();
    let (tiff, text) = (folder.path().join("a.tif"), folder.path().join("a.asc"));
    std::fs::write(&tiff, geotiff_bytes(&dem).unwrap()).unwrap();
    write_ascii_grid(&dem, std::fs::File::create(&text).unwrap()).unwrap();
    check(&tiff);
    check(&text);
}

#[test]
fn windows_of_every_gdal_layout_slice_as_the_whole() {
    if !has_gdal() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(path("in.tif"), geotiff_bytes(&synthesise(&made()).unwrap()).unwrap()).unwrap();
    let layouts: [(&str, &[&str]); 14] = [
        ("strips", &[]),
        ("one strip", &["-co", "BLOCKYSIZE=310"]),
        ("tiles", &["-co", "TILED=YES", "-co", "BLOCKXSIZE=64", "-co", "BLOCKYSIZE=32"]),
        ("lzw", &["-co", "COMPRESS=LZW", "-co", "PREDICTOR=3"]),
        ("deflate", &["-co", "COMPRESS=DEFLATE", "-co", "PREDICTOR=2", "-co", "TILED=YES"]),
        ("deflate p3", &["-co", "COMPRESS=DEFLATE", "-co", "PREDICTOR=3", "-co", "TILED=YES"]),
        ("zstd", &["-co", "COMPRESS=ZSTD", "-co", "PREDICTOR=3"]),
        ("packbits", &["-co", "COMPRESS=PACKBITS"]),
        ("big-endian", &["-co", "ENDIANNESS=BIG", "-co", "BIGTIFF=YES"]),
        ("double", &["-ot", "Float64", "-co", "COMPRESS=DEFLATE"]),
        ("int16", &["-ot", "Int16", "-co", "COMPRESS=LZW", "-co", "PREDICTOR=2"]),
        ("scaled", &["-ot", "Int16", "-a_scale", "0.5", "-a_offset", "-100"]),
        ("cog", &["-of", "COG", "-co", "BLOCKSIZE=128"]),
        ("south up", &["-a_ullr", "-75000", "600000", "-74000", "601000", "-co", "TILED=YES"]),
    ];
    for (name, options) in layouts {
        let out = path(&format!("{name}.tif"));
        let status = Command::new("gdal_translate").arg("-q").args(options).arg(path("in.tif")).arg(&out).status().unwrap();
        assert!(status.success(), "{name}");
        check(Path::new(&out));
    }
}

#[test]
fn gaps_of_sparse_tiles_and_masks_are_gaps_in_windows() {
    if !has_gdal() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let mut text = "ncols 300\nnrows 140\nxllcorner 5000\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n".to_owned();
    for row in 0..140 {
        text += &["3.5 ".repeat(100 + row), "-9999 ".repeat(200 - row), "\n".to_owned()].concat();
    }
    std::fs::write(path("in.asc"), text).unwrap();
    let tiles = ["-q", "-co", "TILED=YES", "-co", "BLOCKXSIZE=16", "-co", "BLOCKYSIZE=16"];
    for (name, options) in [
        ("sparse.tif", &["-co", "SPARSE_OK=TRUE"][..]),
        ("masked.tif", &["-mask", "1", "-a_nodata", "none", "--config", "GDAL_TIFF_INTERNAL_MASK", "YES"]),
    ] {
        let status = Command::new("gdal_translate").args(tiles).args(options).args([path("in.asc"), path(name)]).status().unwrap();
        assert!(status.success(), "{name}");
        check(Path::new(&path(name)));
        let (dem, open) = (read_dem(Path::new(&path(name))).unwrap(), open_dem(Path::new(&path(name))).unwrap());
        let window = Window { first_row: 21, first_col: 90, rows: 77, cols: 131 };
        let posts = open.window(window).unwrap();
        for (index, post) in posts.iter().enumerate() {
            let whole = dem.elevation(21 + index / 131, 90 + index % 131);
            assert_eq!((!post.is_nan()).then_some(*post), whole, "{name} {index}");
        }
        assert!(posts.iter().any(|z| z.is_nan()) && posts.contains(&3.5));
    }
}
