//! Numbers that mark missing data without a statement, in every format: refused as ground unless the user says what they are.
#![allow(
    clippy::unwrap_used,
    clippy::format_collect,
    clippy::cast_precision_loss,
    reason = "test helpers: a file that cannot be made fails its test"
)]

use std::path::Path;

use chta::chain::csv::read_chain_csv_with;
use chta::quantity::MapPoint;
use chta::terrain::{
    DemOptions, MapBounds, NoDataRule, TerrainError, read_friction_raster, read_keep_out, read_mesh_with, slice_file,
};
use proptest::prelude::*;

use crate::tiff::{Samples, Tag, placed, plain_tiff};

/// A 5 x 6 raster with these elevations at rows 1..3 and columns 2..4.
fn heights(block: f64) -> Vec<f64> {
    let ground = |row: usize, col: usize| 100.0 + (row * 7 + col * 3) as f64 % 6.0;
    (0..30)
        .map(|post| (post / 6, post % 6))
        .map(|(row, col)| if (1..3).contains(&row) && (2..4).contains(&col) { block } else { ground(row, col) })
        .collect()
}

fn write(name: &str, folder: &Path, heights: &[f64]) -> std::path::PathBuf {
    let path = folder.join(name);
    let rows = || heights.chunks(6);
    let line = |row: &[f64]| row.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let at = |post: usize| (1000 + post % 6, 2004 - post / 6, heights[post]);
    let content = match name {
        "float32.tif" | "float64.tif" | "int32.tif" => {
            let samples = Samples::of(name.trim_end_matches(".tif"), heights);
            plain_tiff((5, 6), &samples, placed(999.5, 2004.5, 1.0))
        }
        "grid.asc" => {
            let head = "ncols 6\nnrows 5\nxllcenter 1000\nyllcenter 2000\ncellsize 1\nNODATA_value -1\n";
            [head.to_owned(), rows().map(|row| line(row) + "\n").collect()].concat().into_bytes()
        }
        "grid.xyz" => (0..30).map(at).map(|(x, y, z)| format!("{x} {y} {z}\n")).collect::<String>().into_bytes(),
        "image.img" => {
            let label = "PDS_VERSION_ID = PDS3\r\nRECORD_BYTES = 1024\r\n^IMAGE = 2\r\nOBJECT = IMAGE\r\n LINES = 5\r\n LINE_SAMPLES = 6\r\n \
                         SAMPLE_TYPE = PC_REAL\r\n SAMPLE_BITS = 64\r\nEND_OBJECT = IMAGE\r\nOBJECT = IMAGE_MAP_PROJECTION\r\n MAP_SCALE = 1.0 \
                         <M/PIXEL>\r\n LINE_PROJECTION_OFFSET = 2004.0\r\n SAMPLE_PROJECTION_OFFSET = -1000.0\r\nEND_OBJECT = \
                         IMAGE_MAP_PROJECTION\r\nEND\r\n";
            let mut bytes = label.as_bytes().to_vec();
            bytes.resize(1024, b' ');
            bytes.extend(heights.iter().flat_map(|z| z.to_le_bytes()));
            bytes
        }
        "mesh.obj" => {
            let vertices: String = (0..30).map(at).map(|(x, y, z)| format!("v {x} {y} {z}\n")).collect();
            let faces: String = (0..30)
                .filter(|post| post % 6 < 5 && post / 6 < 4)
                .map(|post| format!("f {0} {1} {2}\nf {0} {2} {3}\n", post + 1, post + 7, post + 8, post + 2))
                .collect();
            (vertices + &faces).into_bytes()
        }
        "chain.csv" => {
            let vertices = heights[6..12].iter().enumerate().map(|(x, z)| format!("{x},{z}\n"));
            ["x_m,z_m\n".to_owned()].into_iter().chain(vertices).collect::<String>().into_bytes()
        }
        other => panic!("no writer of {other}"),
    };
    std::fs::write(&path, content).unwrap();
    path
}

const FORMATS: [&str; 8] =
    ["float32.tif", "float64.tif", "int32.tif", "grid.asc", "grid.xyz", "image.img", "mesh.obj", "chain.csv"];

/// Reads a file of any format: Ok with whether anything was taken as missing, or the sentence.
fn read(path: &Path, rule: NoDataRule) -> Result<bool, String> {
    match path.extension().unwrap().to_str().unwrap() {
        "obj" => match read_mesh_with(path, 1.0, rule) {
            Ok(file) => Ok(file.mesh.triangle_count() < 40),
            Err(error) => Err(error.to_string()),
        },
        "csv" => match read_chain_csv_with(&std::fs::read(path).unwrap(), rule) {
            Ok(_) => Ok(false),
            Err(problems) => Err(problems.problems.iter().map(ToString::to_string).collect()),
        },
        _ => match DemOptions::default().no_data(rule).read(path) {
            Ok(dem) => Ok(dem.elevations().any(|z| z.is_none())),
            Err(error) => Err(error.to_string()),
        },
    }
}

/// Marks as programs write them: none is ground in a plain at 100 to 105 m, in any format, until the user says that it is.
#[test]
fn usual_marks_are_refused_in_every_format_until_the_user_states_them() {
    let folder = tempfile::tempdir().unwrap();
    let marks: [f64; 13] = [
        -32768.0,
        -32767.0,
        -9999.0,
        -99999.0,
        -10000.0,
        -999.0,
        -9999.9,
        32767.0,
        65535.0,
        99999.0,
        -3.402_823e38,
        1e38,
        -2_147_483_648.0,
    ];
    for name in FORMATS {
        for mark in marks {
            if name == "int32.tif" && (mark.fract() != 0.0 || !(-3e9..=1e9).contains(&mark)) {
                continue;
            }
            let path = write(name, folder.path(), &heights(mark));
            let refused = read(&path, NoDataRule::AsStated).unwrap_err();
            let word = if f64::abs(mark) < 1e9 { "usual mark of missing data" } else { "within 1e9" };
            assert!(refused.contains(word) && (refused.contains("no_data") || f64::abs(mark) > 1e9), "{name} {mark}: {refused}");
            let stated = read(&path, NoDataRule::Value(mark.into()));
            match name {
                "chain.csv" => assert!(stated.unwrap_err().contains("a chain has no gaps"), "{name} {mark}"),
                _ => assert_eq!(stated, Ok(true), "{name} {mark}"),
            }
            if f64::abs(mark) < 1e9 {
                assert_eq!(read(&path, NoDataRule::Nothing), Ok(false), "{name} {mark}");
            }
        }
    }
}

/// Ground at the height of a mark: a trench at -9 999 m, a block within the range of its border, and a plain at the mark's height.
#[test]
fn ground_at_the_height_of_a_mark_passes_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    for name in FORMATS {
        for lift in [-10101.0, -10102.0, -10099.0] {
            let trench: Vec<f64> = heights(103.0).iter().map(|z| z + lift).collect();
            assert!(trench.contains(&-9999.0) || lift != -10102.0);
            assert_eq!(read(&write(name, folder.path(), &trench), NoDataRule::AsStated), Ok(false), "{name} {lift}");
        }
        let mut cliff = heights(-9999.0);
        cliff[6..12].copy_from_slice(&[-9000.0, -9500.0, -9999.0, -9999.0, -12000.0, -9000.0]);
        cliff[13] = -12000.0;
        assert_eq!(
            read(&write(name, folder.path(), &cliff), NoDataRule::AsStated),
            Ok(false),
            "{name}: within the range of the border"
        );
    }
}

/// A mark that the file scales is stored as the mark: -32768 of 16 bits, in steps of half a metre above a radius.
#[test]
fn a_mark_under_a_scale_is_refused_by_its_stored_number() {
    let folder = tempfile::tempdir().unwrap();
    let (path, metadata) = (folder.path().join("scaled.tif"), |role: &str, value: &str| {
        format!("<Item name=\"{role}\" sample=\"0\" role=\"{role}\">{value}</Item>")
    });
    let xml = ["<GDALMetadata>".to_owned(), metadata("scale", "0.5"), metadata("offset", "1737400"), "</GDALMetadata>".to_owned()]
        .concat();
    let samples = Samples::of("int16", &heights(-32768.0));
    std::fs::write(&path, plain_tiff((5, 6), &samples, placed(1000.0, 2000.0, 1.0).into_iter().chain([Tag::Text(42112, xml)])))
        .unwrap();
    let refused = read(&path, NoDataRule::AsStated).unwrap_err();
    assert!(refused.contains("stored as -32768") && refused.contains("terrain.no_data = -32768"), "{refused}");
    assert_eq!(read(&path, NoDataRule::Value((-32768.0).into())), Ok(true));
    assert_eq!(read(&path, NoDataRule::Nothing), Ok(false));
}

/// A block beside the transect's window is judged with its whole border: the windowed reader and the whole one agree.
#[test]
fn a_slice_judges_as_the_whole_raster_does() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (MapPoint::new(1000.0, 2002.5), MapPoint::new(1005.0, 2002.5));
    for name in ["float32.tif", "float64.tif", "grid.asc", "grid.xyz", "image.img"] {
        let path = write(name, folder.path(), &heights(-9999.0));
        let Err(TerrainError::InFile { problem, .. }) = slice_file(&path, from, to) else { panic!("{name} was sliced") };
        let TerrainError::Void(void) = *problem else { panic!("{name}: {problem}") };
        assert_eq!((void.count, void.z_m, void.border_m), (4, -9999.0, Some((100.0, 105.0))), "{name}");
        let trench: Vec<f64> = heights(103.0).iter().map(|z| z - 10102.0).collect();
        assert!(slice_file(&write(name, folder.path(), &trench), from, to).is_ok(), "{name}");
    }
}

proptest! {
    /// The rule by another road: for a random block over random ground, refused exactly if it lies off its border by more than the
    /// border's range and a metre.
    #[test]
    fn the_rule_is_that_of_the_border(seed in proptest::collection::vec(0.0..1.0_f64, 30), range in prop_oneof![0.0..2.0_f64, 0.0..2e4], off in 0.0..4.0_f64) {
        let mut posts: Vec<f64> = seed.iter().map(|part| -9999.0 + range * (off + part)).collect();
        for post in [8, 9, 14, 15] {
            posts[post] = -9999.0;
        }
        let border = [1, 2, 3, 4, 7, 10, 13, 16, 19, 20, 21, 22].map(|post| posts[post]);
        let (low, high) = border.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(*z), high.max(*z)));
        let off_border = (low - -9999.0).max(-9999.0 - high);
        // A post of the ground can have the height of a mark itself.
        prop_assume!(posts.iter().filter(|z| (**z - -9999.0).abs() < 1.0 || (**z - -10000.0).abs() < 1.0).count() == 4);
        let folder = tempfile::tempdir().unwrap();
        let verdict = read(&write("float64.tif", folder.path(), &posts), NoDataRule::AsStated);
        let off = off_border > (high - low).max(1.0);
        // Within a hundredth of the mark, more than the border counts.
        prop_assert!(verdict.is_err() == off || (off && off_border < 100.0), "{:?} {} {}", verdict, low, high);
    }
}

/// Overlays are rasters as well: a mark in a friction raster is no friction, and the way out is the file's, not the terrain's key.
#[test]
fn marks_in_a_friction_raster_are_refused_with_the_command_that_states_them() {
    let folder = tempfile::tempdir().unwrap();
    for mark in [-9999.0, 9999.0, 32767.0] {
        let friction: Vec<f64> = heights(1.0).iter().map(|z| if *z == 1.0 { mark } else { 0.5 + z / 1000.0 }).collect();
        let path = write("float32.tif", folder.path(), &friction);
        let sentence = read_friction_raster(&path, None).unwrap_err().to_string();
        let command = format!("gdal_translate -a_nodata {mark} in.tif out.tif");
        assert!(sentence.contains(&command) && !sentence.contains("terrain.no_data"), "{sentence}");
    }
}

/// A pixel of a keep-out mask that is missing, or a mark of missing data, keeps out; a no-data value of 0 is free ground.
#[test]
fn missing_pixels_of_a_keep_out_mask_keep_out_unless_they_are_zero() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mask.tif");
    for (value, stated, kept) in
        [(1.0, "", true), (255.0, "255", true), (f64::NAN, "nan", true), (-9999.0, "", true), (0.0, "0", false), (0.0, "", false)]
    {
        let mask: Vec<f64> = heights(100_000.0).iter().map(|z| if *z == 100_000.0 { value } else { 0.0 }).collect();
        let tags = (!stated.is_empty()).then(|| Tag::Text(42113, stated.to_owned()));
        let file = plain_tiff((5, 6), &Samples::of("float32", &mask), placed(999.5, 2004.5, 1.0).into_iter().chain(tags));
        std::fs::write(&path, file).unwrap();
        let zones = read_keep_out(&path, None, everywhere()).unwrap();
        assert_eq!(zones.keeps_out(MapPoint::new(1002.0, 2003.0)), kept, "{value} {stated}");
        assert!(!zones.keeps_out(MapPoint::new(1000.0, 2000.0)), "{value} {stated}");
    }
}

fn everywhere() -> MapBounds {
    MapBounds { min: MapPoint::new(0.0, 0.0), max: MapPoint::new(9999.0, 9999.0) }
}

/// A void that a program resampled has a rim of blends, which is no ground; zeros far below all ground are what warping fills with.
#[test]
fn voids_that_were_resampled_and_zeros_far_away_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dem.tif");
    let write = |ground_m: f64, hole: &dyn Fn(usize, usize) -> Option<f64>| {
        let post = |index: usize| (index / 30, index % 30);
        let heights = (0..900).map(post).map(|(row, col)| hole(row, col).unwrap_or(ground_m + ((row * 7 + col * 13) % 11) as f64));
        let samples = Samples::of("float32", &heights.collect::<Vec<f64>>());
        std::fs::write(&path, plain_tiff((30, 30), &samples, placed(1000.0, 2030.0, 1.0))).unwrap();
        read(&path, NoDataRule::AsStated)
    };
    for mark in [-9999.0, -32768.0, -32767.0, -99999.0, 32767.0] {
        for reach in [1.0, 2.0, 3.0] {
            // A disc of the mark, and blends around it.
            let smeared = |row: usize, col: usize| {
                let far = (row as f64 - 15.0).hypot(col as f64 - 14.0) - 4.0;
                let share = (1.0 - far / reach).clamp(0.0, 1.0);
                (share > 0.0).then_some(if share == 1.0 { mark } else { share * mark + (1.0 - share) * 105.0 })
            };
            let verdict = write(100.0, &smeared);
            assert!(verdict.as_ref().is_err_and(|text| text.contains("usual mark")), "{mark} {reach}: {verdict:?}");
        }
    }
    for ground_m in [-2500.0, 1_737_400.0] {
        let verdict = write(ground_m, &|row, col| (row < 9 || col < 5).then_some(0.0));
        assert!(verdict.as_ref().is_err_and(|text| text.contains("usual mark")), "{ground_m}: {verdict:?}");
    }
    assert_eq!(write(100.0, &|row, _| (row < 9).then_some(0.0)), Ok(false), "a lake at 0 m");
}
