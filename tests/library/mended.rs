//! Commands of messages about rasters, run, with the mended file compared with the truth.
#![allow(clippy::unwrap_used, reason = "test helpers: a file that cannot be made fails its test")]

use std::path::Path;
use std::process::Command;

use chta::quantity::MapPoint;
use chta::terrain::{Dem, read_dem};

use crate::installed::has_gdal;
use crate::tiff::{Samples, Tag, placed, plain_tiff};

/// Reads a file that is refused, runs the command of the message (its part before a bracket), and reads the result.
fn mended(folder: &Path, found: &str) -> Dem {
    let message = read_dem(&folder.join("in.tif")).unwrap_err().to_string();
    assert!(message.contains(found), "{message}");
    let (_, command) = message.split_once("mend it with: ").unwrap();
    let command = command.split(" (").next().unwrap();
    let ran = Command::new("sh").current_dir(folder).args(["-c", command]).output().unwrap();
    assert!(ran.status.success(), "{command}: {}", String::from_utf8_lossy(&ran.stderr));
    read_dem(&folder.join("out.tif")).unwrap_or_else(|error| panic!("{command}: {error}"))
}

/// A raster stored from east to west: new borders would mirror it, so the posts are turned round.
#[test]
fn a_raster_stored_from_east_to_west_is_not_mirrored() {
    if !has_gdal() {
        return;
    }
    let heights: Vec<f64> = (1..=12).map(f64::from).collect();
    let by_scale = vec![Tag::Doubles(33550, vec![-10.0, 10.0, 0.0]), Tag::Doubles(33922, vec![0.0, 0.0, 0.0, 5040.0, 7030.0, 0.0])];
    let mut matrix = vec![0.0; 16];
    (matrix[0], matrix[3], matrix[5], matrix[7], matrix[15]) = (-10.0, 5040.0, -10.0, 7030.0, 1.0);
    for (tags, found) in [(by_scale, "pixel scale of (-10, 10)"), (vec![Tag::Doubles(34264, matrix)], "columns that run by -10 m")]
    {
        let folder = tempfile::tempdir().unwrap();
        let metres = Tag::Shorts(34735, vec![1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32633]);
        let file = plain_tiff((3, 4), &Samples::of("float32", &heights), tags.into_iter().chain([metres]));
        std::fs::write(folder.path().join("in.tif"), file).unwrap();
        let dem = mended(folder.path(), found);
        // The first stored column is the easternmost.
        assert_eq!(dem.georeference().north_west(), MapPoint::new(5005.0, 7025.0), "{found}");
        let row: Vec<Option<f64>> = (0..4).map(|col| dem.elevation(0, col)).collect();
        assert_eq!(row, [Some(4.0), Some(3.0), Some(2.0), Some(1.0)], "{found}");
    }
}

/// A second band that marks the valid posts: to drop it would take missing posts for ground.
#[test]
fn a_band_of_marks_is_kept_as_a_mask() {
    if !has_gdal() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // Two bands pixel by pixel: elevation, and 0 where there is none.
    let samples: Vec<f64> = (1..=12).flat_map(|z| [f64::from(z), if z == 6 { 0.0 } else { 255.0 }]).collect();
    let bands =
        [Tag::Shorts(277, vec![2]), Tag::Shorts(258, vec![32, 32]), Tag::Shorts(339, vec![3, 3]), Tag::Shorts(338, vec![2])];
    let file = plain_tiff((3, 4), &Samples::of("float32", &samples), placed(5000.0, 7030.0, 10.0).into_iter().chain(bands));
    std::fs::write(folder.path().join("in.tif"), file).unwrap();
    let dem = mended(folder.path(), "marks the valid posts (alpha)");
    let gaps: Vec<usize> = dem.elevations().enumerate().filter(|(_, z)| z.is_none()).map(|(post, _)| post).collect();
    assert_eq!((gaps, dem.elevation(0, 0)), (vec![5], Some(1.0)));
}

/// Sidecar files as GDAL itself writes them, with GDAL's own reading as the second road.
#[test]
fn sidecar_files_of_gdal_are_read_as_gdal_reads_them() {
    if !has_gdal() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let run = |program: &str, args: &[&str]| {
        let ran = Command::new(program).current_dir(folder.path()).args(args).output().unwrap();
        assert!(ran.status.success(), "{program} {args:?}: {}", String::from_utf8_lossy(&ran.stderr));
    };
    let heights: Vec<f64> = (1..=12).map(f64::from).collect();
    std::fs::write(path("in.tif"), plain_tiff((3, 4), &Samples::of("int16", &heights), placed(5000.0, 7030.0, 10.0))).unwrap();
    let stated = ["-q", "-a_nodata", "7", "-a_scale", "0.5", "-a_offset", "100", "-a_srs", "EPSG:32633"];
    // AAIGrid keeps neither scale nor system in itself: GDAL writes .aux.xml and .prj. -mask makes an external mask without the option.
    for (name, options) in [
        ("grid.asc", vec!["-of", "AAIGrid"]),
        ("plain.tif", vec!["-co", "PROFILE=BASELINE", "-co", "TFW=YES"]),
        ("masked.tif", vec!["-mask", "1", "--config", "GDAL_TIFF_INTERNAL_MASK", "NO"]),
    ] {
        run("gdal_translate", &[&stated[..], &options, &["in.tif", name]].concat());
        let dem = read_dem(&path(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        run("gdal_translate", &["-q", "-unscale", "-ot", "Float64", "-of", "XYZ", name, "truth.xyz"]);
        let truth = std::fs::read_to_string(path("truth.xyz")).unwrap();
        for (index, line) in truth.lines().enumerate() {
            let [x, y, z] = [0, 1, 2].map(|field| line.split(' ').nth(field).unwrap().parse::<f64>().unwrap());
            let (row, col) = (index / 4, index % 4);
            assert_eq!(dem.georeference().post(row, col), MapPoint::new(x, y), "{name}");
            match dem.elevation(row, col) {
                Some(found) => assert_eq!(found, z, "{name} {index}"),
                None => assert_eq!(index, 6, "{name}: the post of the no-data value alone is missing"),
            }
        }
        assert_eq!(dem.elevation(1, 2), None, "{name}");
        let on_meridian = dem.georeference().projection().unwrap().lon_lat(MapPoint::new(500_000.0, 7000.0)).unwrap();
        assert!((on_meridian.lon_deg - 15.0).abs() < 1e-9, "{name}");
    }
}

/// Heights in feet or counted downwards, as GDAL writes them, with a scale, a no-data value and a mask: the command converts all of it.
#[test]
fn heights_in_other_units_are_converted_with_their_scale_and_their_gaps() {
    if !has_gdal() {
        return;
    }
    let (us, foot) = (1200.0 / 3937.0, 0.3048);
    for (heights, size_m) in [("6360", us), ("8228", foot), ("5702", us), ("5715", -1.0), ("5614", -foot), ("6358", -us)] {
        for scaled in [false, true] {
            let folder = tempfile::tempdir().unwrap();
            let run = |args: &[&str]| {
                let ran = Command::new("gdal_translate").current_dir(folder.path()).arg("-q").args(args).output().unwrap();
                assert!(ran.status.success(), "{args:?}: {}", String::from_utf8_lossy(&ran.stderr));
            };
            let stored: Vec<f64> = (1..=12).map(|z| 100.0 + f64::from(z)).collect();
            let file = plain_tiff((3, 4), &Samples::of("float32", &stored), placed(499_980.0, 4_000_030.0, 10.0));
            std::fs::write(folder.path().join("plain.tif"), file).unwrap();
            let srs = format!("EPSG:32614+{heights}");
            let scaling: &[&str] = if scaled { &["-a_scale", "0.5", "-a_offset", "10"] } else { &[] };
            run(&[&["-a_srs", &srs, "-a_nodata", "103"], scaling, &["plain.tif", "in.tif"]].concat());
            let dem = mended(folder.path(), if size_m < 0.0 { "downwards" } else { "feet" });
            for (index, found) in dem.elevations().enumerate() {
                let height = if scaled { stored[index] * 0.5 + 10.0 } else { stored[index] };
                match found {
                    Some(found) => {
                        assert!((found - height * size_m).abs() < 1e-9 * height, "{heights} {scaled}: {found} for {height}");
                    }
                    None => assert_eq!(index, 2, "{heights} {scaled}"),
                }
            }
        }
    }
}

/// A scale that GDAL keeps in the transform, as it does where the map has heights: two copies of one DEM must read the same.
#[test]
fn a_scale_in_the_transform_is_read_as_gdal_reads_it() {
    if !has_gdal() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let stored: Vec<f64> = (1..=12).map(f64::from).collect();
    let file = plain_tiff((3, 4), &Samples::of("int16", &stored), placed(499_980.0, 4_000_030.0, 10.0));
    std::fs::write(folder.path().join("plain.tif"), file).unwrap();
    for srs in ["EPSG:32614+5703", "EPSG:32614+3855", "EPSG:25832+7837"] {
        let args = ["-q", "-a_srs", srs, "-a_scale", "0.005", "-a_offset", "700", "plain.tif", "in.tif"];
        assert!(Command::new("gdal_translate").current_dir(folder.path()).args(args).status().unwrap().success());
        let dem = read_dem(&folder.path().join("in.tif")).unwrap();
        let found: Vec<f64> = dem.elevations().flatten().collect();
        assert_eq!(found, stored.iter().map(|z| z * 0.005 + 700.0).collect::<Vec<f64>>(), "{srs}");
    }
    let without_heights =
        [Tag::Doubles(33550, vec![10.0, 10.0, 0.5]), Tag::Doubles(33922, vec![0.0, 0.0, 0.0, 5000.0, 7030.0, 7.0])];
    let file = plain_tiff((3, 4), &Samples::of("int16", &stored), without_heights);
    std::fs::write(folder.path().join("in.tif"), file).unwrap();
    assert!(
        read_dem(&folder.path().join("in.tif")).unwrap_err().to_string().contains("a scale of 0.5 for heights in its transform")
    );
}
