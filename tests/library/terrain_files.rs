//! Reading and writing DEM files: real ones, those of other programs, and layouts created with GDAL.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and says why it skips")]

use std::path::{Path, PathBuf};
use std::process::Command;

use chta::quantity::MapPoint;
use chta::terrain::{
    Dem, GeoReference, SyntheticTerrain, geotiff_bytes, read_ascii_grid_bytes, read_dem, read_geotiff_bytes, slice, synthesise,
    write_ascii_grid,
};

use crate::installed::has_gdal;

/// A file of the shared folder; `None` with a printed reason if it is absent.
fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} is absent", path.display());
    None
}

fn run(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap();
    assert!(output.status.success(), "{program} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn rounded(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

#[test]
fn real_dems_have_the_extremes_that_their_readme_says() {
    for (name, rows, cols, low, high, spacing_m) in [
        ("hirise_DTEEC_010228_1490_crop_120x70.tif", 120, 70, 753.25, 792.32, 1.01),
        ("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", 256, 256, 467.69, 593.42, 5.0),
        ("lola_dem_north.tif", 762, 762, -4977.0, 3319.0, 1600.0),
    ] {
        let Some(path) = shared(name) else { continue };
        let dem = read_dem(&path).unwrap();
        let (least, most) = dem.elevation_range_m();
        assert_eq!((dem.rows(), dem.cols(), rounded(least), rounded(most)), (rows, cols, low, high), "{name}");
        assert!((dem.georeference().dx_m() - spacing_m).abs() < 0.01 * spacing_m, "{name}");
        assert!(dem.is_single_precision());
    }
}

#[test]
fn the_text_and_the_tiff_of_one_real_dem_agree_to_the_texts_millimetres() {
    let (Some(tiff), Some(text)) =
        (shared("hirise_DTEEC_010228_1490_crop_120x70.tif"), shared("hirise_DTEEC_010228_1490_crop_120x70.asc"))
    else {
        return;
    };
    let (tiff, text) = (read_dem(&tiff).unwrap(), read_dem(&text).unwrap());
    assert!((tiff.georeference().north_west() - text.georeference().north_west()).norm() < 1e-9);
    for (a, b) in tiff.elevations().zip(text.elevations()) {
        assert!((a.unwrap() - b.unwrap()).abs() < 0.000_51);
    }
}

#[test]
fn real_dems_are_sliced_and_every_vertex_lies_between_their_extremes() {
    for name in ["hirise_DTEEC_010228_1490_crop_120x70.tif", "lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif"] {
        let Some(path) = shared(name) else { continue };
        let dem = read_dem(&path).unwrap();
        let bounds = dem.bounds();
        let along = bounds.max - bounds.min;
        let at = |u: f64, v: f64| MapPoint::new(bounds.min.x + u * along.x, bounds.min.y + v * along.y);
        for (from, to) in [(at(0.0, 0.0), at(1.0, 1.0)), (at(0.1, 0.9), at(0.83, 0.17)), (at(0.5, 1.0), at(0.5, 0.0))] {
            let profile = slice(&dem, from, to).unwrap();
            let (low, high) = dem.elevation_range_m();
            assert!(profile.points.len() > 100);
            assert!(profile.points.iter().all(|point| point.z_m >= low && point.z_m <= high));
        }
    }
}

#[test]
fn every_interoperability_file_is_read_or_refused_with_a_remedy() {
    let expected = [
        ("asynctiff_BigTIFF.tif", "RGB picture of 3 bands"),
        ("asynctiff_gradient-1c-64b-float.tiff", "no position on a map"),
        ("asynctiff_predictor-3-gray-f32.tif", "no position on a map"),
        ("geotiffcrate_austrian_capitals_model_tie_point_and_pixel_scale_pixel_is_point.tif", "WhiteIsZero"),
        ("geotiffcrate_austrian_capitals_model_transformation_pixel_is_area.tif", "WhiteIsZero"),
        ("gz_dem_squared.tif", "in degrees"),
        ("rasterio_all-nodata.tif", "4 bands"),
        ("rasterio_corrupt.tif", "colour picture of 3 bands"),
    ];
    for (name, reason) in expected {
        let Some(path) = shared(&format!("interop/{name}")) else { continue };
        let message = read_dem(&path).unwrap_err().to_string();
        assert!(message.contains(reason) && message.contains(name) && message.contains("gdal"), "{message}");
    }
    let Some(path) = shared("interop/rasterio_float_raster_with_nodata.tif") else { return };
    let dem = read_dem(&path).unwrap();
    assert!(dem.elevations().any(|z_m| z_m.is_none()) && dem.elevation_range_m().1 < 1.0e4, "{:?}", dem.elevation_range_m());
}

#[test]
fn the_commands_that_refusals_name_repair_the_file() {
    if !has_gdal() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out.tif");
    let out_text = out.to_str().unwrap();
    let converted = |name: &str, program: &str, options: &[&str]| -> Option<Dem> {
        let path = shared(name)?;
        let _ = std::fs::remove_file(&out);
        let files = [path.to_str().unwrap(), out_text];
        run(program, &[&["-q"], options, &files].concat());
        Some(read_dem(&out).unwrap())
    };
    let point = "interop/geotiffcrate_austrian_capitals_model_tie_point_and_pixel_scale_pixel_is_point.tif";
    if let Some(dem) = converted(point, "gdal_translate", &["-co", "PHOTOMETRIC=MINISBLACK"]) {
        // GDAL's origin is the pixel's corner; the post is half a pixel inside.
        assert_eq!(dem.georeference().north_west(), MapPoint::new(4_302_000.0, 2_811_000.0));
        assert!(dem.georeference().coordinate_system.description.as_deref().unwrap_or_default().contains("ETRS89"));
    }
    let area = "interop/geotiffcrate_austrian_capitals_model_transformation_pixel_is_area.tif";
    if let Some(dem) = converted(area, "gdal_translate", &["-co", "PHOTOMETRIC=MINISBLACK"]) {
        assert_eq!(dem.georeference().north_west(), MapPoint::new(4_302_500.0, 2_810_500.0));
    }
    if let Some(dem) =
        converted("interop/asynctiff_predictor-3-gray-f32.tif", "gdal_translate", &["-a_ullr", "0", "200", "200", "0"])
    {
        assert_eq!((dem.rows(), dem.georeference().north_west()), (200, MapPoint::new(0.5, 199.5)));
    }
    if let Some(dem) = converted(
        "interop/gz_dem_squared.tif",
        "gdalwarp",
        &["-r", "bilinear", "-t_srs", "+proj=eqc +lat_ts=38 +R=6371000 +units=m"],
    ) {
        assert!(dem.georeference().dx_m() > 10.0 && dem.elevation_range_m().1 > 300.0);
    }
}

fn bumpy(rows: usize, cols: usize) -> Dem {
    let terrain = SyntheticTerrain {
        rows,
        cols,
        south_west: MapPoint::new(-75_360.5, 609_600.25),
        mean_elevation_m: 1200.0,
        ..SyntheticTerrain::default()
    };
    synthesise(&terrain).unwrap()
}

#[test]
fn gdal_layouts_of_one_dem_read_as_the_same_elevations() {
    if !has_gdal() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let dem = bumpy(150, 210);
    std::fs::write(path("in.tif"), geotiff_bytes(&dem).unwrap()).unwrap();
    let layouts: [(&str, &[&str], f64); 13] = [
        ("strips", &[], 0.0),
        ("tiles", &["-co", "TILED=YES", "-co", "BLOCKXSIZE=64", "-co", "BLOCKYSIZE=32"], 0.0),
        ("lzw", &["-co", "COMPRESS=LZW", "-co", "PREDICTOR=3"], 0.0),
        ("deflate", &["-co", "COMPRESS=DEFLATE", "-co", "PREDICTOR=2", "-co", "TILED=YES"], 0.0),
        ("zstd", &["-co", "COMPRESS=ZSTD", "-co", "PREDICTOR=3"], 0.0),
        ("packbits", &["-co", "COMPRESS=PACKBITS"], 0.0),
        ("bigtiff", &["-co", "BIGTIFF=YES"], 0.0),
        ("big-endian", &["-co", "ENDIANNESS=BIG"], 0.0),
        ("double", &["-ot", "Float64", "-co", "COMPRESS=DEFLATE"], 0.0),
        ("int16", &["-ot", "Int16", "-co", "COMPRESS=LZW", "-co", "PREDICTOR=2"], 0.5),
        ("uint16", &["-ot", "UInt16"], 0.5),
        ("int32", &["-ot", "Int32"], 0.5),
        ("cog", &["-of", "COG"], 0.0),
    ];
    for (name, options, tolerance) in layouts {
        let out = path(name);
        run("gdal_translate", &[&["-q"], options, &[path("in.tif").as_str(), out.as_str()]].concat());
        let read = read_dem(Path::new(&out)).unwrap();
        assert_eq!((read.rows(), read.cols()), (150, 210), "{name}");
        assert!((read.georeference().north_west() - dem.georeference().north_west()).norm() < 1e-9, "{name}");
        for (a, b) in read.elevations().flatten().zip(dem.elevations().flatten()) {
            assert!((a - b).abs() <= tolerance, "{name}: {a} {b}");
        }
    }
}

#[test]
fn gdal_scales_gaps_masks_and_transforms_are_understood_or_refused() {
    if !has_gdal() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let text = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ndx 10\ndy 20\nNODATA_value -32768\n1 2 -32768\n4 5 6\n";
    std::fs::write(path("in.asc"), text).unwrap();
    let make = |name: &str, options: &[&str]| {
        run("gdal_translate", &[&["-q"], options, &[path("in.asc").as_str(), path(name).as_str()]].concat());
        read_dem(Path::new(&path(name)))
    };
    let plain = make("plain.tif", &["-ot", "Int16"]).unwrap();
    let posts: Vec<Option<f64>> = plain.elevations().collect();
    assert_eq!(posts, [Some(1.0), Some(2.0), None, Some(4.0), Some(5.0), Some(6.0)]);
    assert_eq!(plain.georeference().north_west(), MapPoint::new(105.0, 230.0));
    assert_eq!((plain.georeference().dx_m(), plain.georeference().dy_m()), (10.0, 20.0));
    let scaled = make("scaled.tif", &["-ot", "Int16", "-a_scale", "0.5", "-a_offset", "-100"]).unwrap();
    assert_eq!((scaled.elevation(0, 1), scaled.elevation(0, 2), scaled.elevation(1, 2)), (Some(-99.0), None, Some(-97.0)));
    let south_up = make("south_up.tif", &["-ot", "Float32", "-a_ullr", "100", "200", "130", "240"]).unwrap();
    assert_eq!((south_up.elevation(0, 0), south_up.elevation(1, 0)), (Some(4.0), Some(1.0)));
    assert_eq!(south_up.georeference().north_west(), MapPoint::new(105.0, 230.0));
    let again = read_geotiff_bytes(geotiff_bytes(&south_up).unwrap()).unwrap();
    assert_eq!((again.elevation(0, 0), again.georeference().north_west()), (Some(4.0), MapPoint::new(105.0, 230.0)));
    let masked =
        make("masked.tif", &["-ot", "Float32", "-mask", "1", "-a_nodata", "none", "--config", "GDAL_TIFF_INTERNAL_MASK", "YES"])
            .unwrap();
    assert_eq!((masked.elevation(0, 2), masked.elevation(0, 1)), (None, Some(2.0)));
    let gaps = make("gaps.tif", &["-a_nodata", "nan", "-ot", "Float32"]).unwrap_err().to_string();
    assert!(gaps.contains("-32768") && gaps.contains("terrain.no_data"), "-a_nodata relabels, it does not change samples: {gaps}");
    let feet = make("feet.tif", &["-a_srs", "EPSG:2278"]).unwrap_err().to_string();
    assert!(feet.contains("US survey feet") && feet.contains("gdalwarp"), "{feet}");
    let degrees = make("degrees.tif", &["-a_srs", "EPSG:4326"]).unwrap_err().to_string();
    assert!(degrees.contains("in degrees"), "{degrees}");
    let moon = make("moon.tif", &["-a_srs", "+proj=stere +lat_0=-90 +R=1737400 +units=m"]).unwrap();
    assert!(moon.georeference().coordinate_system.key_directory.len() > 8);
}

#[test]
fn sparse_tiles_are_gaps_where_a_no_data_value_stands() {
    if !has_gdal() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).to_str().unwrap().to_owned();
    let mut text = "ncols 300\nnrows 40\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n".to_owned();
    for _ in 0..40 {
        text += &["3.5 ".repeat(16), "-9999 ".repeat(284), "\n".to_owned()].concat();
    }
    std::fs::write(path("in.asc"), text).unwrap();
    let options = ["-q", "-co", "SPARSE_OK=TRUE", "-co", "TILED=YES", "-co", "BLOCKXSIZE=16", "-co", "BLOCKYSIZE=16"];
    run("gdal_translate", &[&options[..], &[path("in.asc").as_str(), path("out.tif").as_str()]].concat());
    let dem = read_dem(Path::new(&path("out.tif"))).unwrap();
    assert_eq!((dem.elevation(39, 15), dem.elevation(0, 16), dem.elevation(39, 299)), (Some(3.5), None, None));
    assert_eq!(dem.elevations().flatten().count(), 16 * 40);
}

#[test]
fn what_is_written_reads_back_equal_in_both_formats() {
    let mut elevations = vec![0.1, 1.0e-300, -7.25, f64::NAN, 123_456.789, -9999.0];
    let map = GeoReference::local(MapPoint::new(-75_360.3, 4.3e6 + 0.7), 0.3, 1.01).unwrap();
    for dem in [bumpy(300, 270), Dem::new(2, 3, elevations.clone(), map.clone()).unwrap(), {
        elevations[0] = 0.5;
        Dem::new(3, 2, elevations, map).unwrap()
    }] {
        let tiff = read_geotiff_bytes(geotiff_bytes(&dem).unwrap()).unwrap();
        assert!(tiff.elevations().eq(dem.elevations()));
        assert_eq!(tiff.georeference().north_west(), dem.georeference().north_west());
        assert_eq!(tiff.georeference().dy_m(), dem.georeference().dy_m());
        assert_eq!(tiff.is_single_precision(), dem.is_single_precision());
        assert_eq!(
            read_geotiff_bytes(geotiff_bytes(&tiff).unwrap()).unwrap().georeference().north_west(),
            tiff.georeference().north_west()
        );
        let mut text = Vec::new();
        write_ascii_grid(&dem, &mut text).unwrap();
        let text = read_ascii_grid_bytes(&text).unwrap();
        assert!(text.elevations().eq(dem.elevations()));
        assert_eq!(text.georeference().north_west(), dem.georeference().north_west());
    }
}

#[test]
fn a_real_projection_survives_writing_tag_for_tag_and_gdal_agrees() {
    for name in
        ["lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", "lola_dem_north.tif", "interop/rasterio_float_raster_with_nodata.tif"]
    {
        let Some(path) = shared(name) else { continue };
        let dem = read_dem(&path).unwrap();
        let directory = tempfile::tempdir().unwrap();
        let out = directory.path().join("out.tif");
        std::fs::write(&out, geotiff_bytes(&dem).unwrap()).unwrap();
        let again = read_dem(&out).unwrap();
        assert!(again.elevations().eq(dem.elevations()));
        assert_eq!(again.georeference().coordinate_system, dem.georeference().coordinate_system);
        assert_eq!(again.georeference().transform_tags.pixel_scale, dem.georeference().transform_tags.pixel_scale);
        assert_eq!(again.georeference().north_west(), dem.georeference().north_west());
        if has_gdal() {
            let place = |file: &Path| {
                let text = run("gdalinfo", &[file.to_str().unwrap()]);
                let part = |from: &str, to: &str| {
                    text.split_once(from).and_then(|(_, rest)| rest.split_once(to)).map(|(inside, _)| inside.to_owned())
                };
                (part("Coordinate System is:", "Metadata:"), part("Upper Left", "Band 1"))
            };
            assert_eq!(place(&path), place(&out), "{name}");
        }
    }
}

#[test]
fn files_with_only_a_valid_beginning_are_refused_quickly_and_without_memory() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("terrain");
    let refuse = |content: &[u8], expected: &str| {
        std::fs::write(&path, content).unwrap();
        let message = read_dem(&path).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    };
    let whole = geotiff_bytes(&bumpy(60, 60)).unwrap();
    for length in [5, 8, 16, 200, whole.len() / 2, whole.len() - 3] {
        refuse(&whole[..length], "damaged");
    }
    refuse(
        b"ncols 4000000000\nnrows 4000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n",
        "nrows 4000000000 times ncols 4000000000",
    );
    refuse(
        b"ncols 3\nnrows 1000000000000000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n",
        "nrows '1000000000000000000000'",
    );
    // A huge width in a valid file: the tag of the image's width, patched.
    let mut absurd = whole.clone();
    let width_tag = absurd.windows(8).position(|window| window == [0, 1, 4, 0, 1, 0, 0, 0]).unwrap();
    absurd[width_tag + 8..width_tag + 12].copy_from_slice(&u32::MAX.to_le_bytes());
    refuse(&absurd, "damaged");
    // And tiles of sixteen billion posts each.
    let mut absurd = whole.clone();
    for tag in [322_u16, 323] {
        let start = [&tag.to_le_bytes()[..], &[4, 0, 1, 0, 0, 0]].concat();
        let at = absurd.windows(8).position(|window| window == start).unwrap();
        absurd[at + 8..at + 12].copy_from_slice(&131_072_u32.to_le_bytes());
    }
    refuse(&absurd, "damaged");
}

#[test]
fn two_hundred_megabytes_of_one_line_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("line.asc");
    let mut content = b"ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n".to_vec();
    content.resize(200_000_000, b'7');
    std::fs::write(&path, &content).unwrap();
    let message = read_dem(&path).unwrap_err().to_string();
    assert!(message.contains("line 6, column 1"), "{message}");
    let junk = directory.path().join("junk.tif");
    content.fill(b'J');
    std::fs::write(&junk, &content).unwrap();
    assert!(read_dem(&junk).unwrap_err().to_string().contains("not a known elevation format"));
}
