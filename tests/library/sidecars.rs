//! Files beside a raster: what they state is read, and what contradicts the raster or is not understood is refused by name.
#![allow(clippy::unwrap_used, clippy::format_collect, reason = "test helpers: a file that cannot be made fails its test")]

use std::path::{Path, PathBuf};

use chta::quantity::MapPoint;
use chta::terrain::{Dem, DemOptions, MapProjection, NoDataRule, read_dem, sidecar_files, slice_file};

use crate::tiff::{Samples, Tag, placed, plain_tiff};

const HEIGHTS: [f64; 12] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0];

/// A projected map in WKT of ESRI: UTM zone 33 north.
const UTM_33: &str = "PROJCS[\"WGS_1984_UTM_Zone_33N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,\
                      298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],\
                      PARAMETER[\"False_Easting\",500000.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",15.0],\
                      PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],UNIT[\"Meter\",1.0]]";

/// Writes `dem.EXTENSION`, 3 x 4 posts 10 m apart, north-west post at (500005, 4500025), and files beside it.
fn write(folder: &Path, extension: &str, further: Vec<Tag>, beside: &[(&str, Vec<u8>)]) -> PathBuf {
    let path = folder.join(format!("dem.{extension}"));
    let content = match extension {
        "tif" => {
            plain_tiff((3, 4), &Samples::of("float32", &HEIGHTS), placed(500_000.0, 4_500_030.0, 10.0).into_iter().chain(further))
        }
        "asc" | "stated.asc" => {
            let head = "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 4500000\ncellsize 10\n";
            let stated = if extension == "asc" { "" } else { "NODATA_value -1\n" };
            [head, stated, "1 2 3 4\n5 6 7 8\n9 10 11 12\n"].concat().into_bytes()
        }
        "xyz" => (0..12_usize)
            .map(|post| format!("{} {} {}\n", 500_005 + 10 * (post % 4), 4_500_025 - 10 * (post / 4), post + 1))
            .collect::<String>()
            .into_bytes(),
        other => panic!("no writer of {other}"),
    };
    std::fs::write(&path, content).unwrap();
    let stem = path.with_extension("");
    for (ending, content) in beside {
        let name = match ending.strip_prefix('.') {
            // Appended to the whole name, as `.aux.xml` and `.msk` are.
            Some(_) => format!("{}{ending}", path.display()),
            None => format!("{}.{ending}", stem.display()),
        };
        std::fs::write(name, content).unwrap();
    }
    path
}

/// Reads a file with these files beside it, alone in a folder.
fn read(extension: &str, further: Vec<Tag>, beside: &[(&str, Vec<u8>)]) -> Result<Dem, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), extension, further, beside);
    read_dem(&path).map_err(|error| error.to_string().replace(&folder.path().display().to_string(), ""))
}

fn aux(inside: &str) -> Vec<u8> {
    format!("<PAMDataset>{inside}</PAMDataset>").into_bytes()
}

fn band(inside: &str) -> Vec<u8> {
    aux(&format!("<PAMRasterBand band=\"1\">{inside}</PAMRasterBand>"))
}

const FORMATS: [&str; 3] = ["tif", "asc", "xyz"];

#[test]
fn no_data_scale_and_offset_of_aux_xml_are_read_for_every_format() {
    for extension in FORMATS {
        let dem =
            read(extension, vec![], &[(".aux.xml", band("<NoDataValue>7</NoDataValue><Scale>0.1</Scale><Offset>100</Offset>"))]);
        let found: Vec<Option<f64>> = dem.unwrap_or_else(|error| panic!("{extension}: {error}")).elevations().collect();
        let expected = HEIGHTS.map(|z| (z != 7.0).then_some(z * 0.1 + 100.0));
        assert_eq!(found, expected, "{extension}");
    }
}

#[test]
fn masks_blank_their_posts_in_whole_files_and_in_parts() {
    let mask = |samples: &Samples, size| plain_tiff(size, samples, []);
    let shown = Samples::of("byte", &[255.0, 255.0, 255.0, 255.0, 255.0, 0.0, 255.0, 255.0, 255.0, 255.0, 255.0, 255.0]);
    for extension in FORMATS {
        let dem = read(extension, vec![], &[(".msk", mask(&shown, (3, 4)))]).unwrap();
        let gaps: Vec<bool> = dem.elevations().map(|z| z.is_none()).collect();
        assert_eq!(gaps.iter().position(|gap| *gap), Some(5), "{extension}");
        assert_eq!(gaps.iter().filter(|gap| **gap).count(), 1, "{extension}");
        let small = Samples::of("byte", &[255.0; 6]);
        let refused = read(extension, vec![], &[(".msk", mask(&small, (2, 3)))]).unwrap_err();
        assert!(refused.contains("dem.") && refused.contains(".msk") && refused.contains("2 rows and 3 columns"), "{refused}");
        let wide = Samples::of("float32", &[1.0; 12]);
        assert!(read(extension, vec![], &[(".msk", mask(&wide, (3, 4)))]).unwrap_err().contains("more than 8 bits"), "{extension}");
        let junk = read(extension, vec![], &[(".msk", b"no mask".to_vec())]).unwrap_err();
        assert!(junk.contains("cannot be read as a mask"), "{extension}: {junk}");
        // A slice reads only a window, and meets the same gap.
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), extension, vec![], &[(".msk", mask(&shown, (3, 4)))]);
        let (from, to) = (MapPoint::new(500_005.0, 4_500_015.0), MapPoint::new(500_035.0, 4_500_015.0));
        assert!(slice_file(&path, from, to).unwrap_err().to_string().contains("no-data"), "{extension}");
    }
}

/// A map stated beside the raster alone is its map; the same map twice is one; another map is refused with both names.
#[test]
fn reference_systems_beside_a_raster_are_read_and_compared() {
    let prj = |text: &str| vec![("prj", text.as_bytes().to_vec())];
    let feet = UTM_33.replace("UNIT[\"Meter\",1.0]", "UNIT[\"Foot_US\",0.3048006096012192]");
    let degrees = "GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],PRIMEM[\"Greenwich\",0.0],\
                   UNIT[\"Degree\",0.0174532925199433]]";
    let heights_in_feet = format!("{UTM_33},VERTCS[\"NAVD88_ftUS\",VDATUM[\"NAVD\"],UNIT[\"Foot_US\",0.3048006096012192]]");
    let heights_in_metres = format!("{UTM_33},VERTCS[\"NAVD88\",VDATUM[\"NAVD\"],UNIT[\"Meter\",1.0]]");
    for extension in FORMATS {
        for beside in [
            prj(UTM_33),
            vec![(".aux.xml", aux(&format!("<SRS>{}</SRS>", UTM_33.replace('"', "&quot;"))))],
            prj(&heights_in_metres),
        ] {
            let dem = read(extension, vec![], &beside).unwrap();
            let projection = dem.georeference().projection().unwrap();
            let place = projection.lon_lat(MapPoint::new(500_000.0, 4_500_000.0)).unwrap();
            assert!((place.lon_deg - 15.0).abs() < 1e-12, "{extension}");
        }
        for (text, word) in [
            (&*feet, "Foot_US"),
            (degrees, "degrees"),
            (&heights_in_feet, "elevations in 'Foot_US'"),
            ("PROJECTION UTM\nZONE 33\nUNITS METERS\n", "old form of ArcInfo"),
            ("PROJCS[\"x\"", "prj"),
        ] {
            let refused = read(extension, vec![], &prj(text)).unwrap_err();
            assert!(refused.contains(word) && refused.contains("dem.prj"), "{extension} {word}: {refused}");
        }
        assert!(
            read(extension, vec![], &prj("")).is_ok()
                && read(extension, vec![], &prj("LOCAL_CS[\"site\",UNIT[\"metre\",1]]")).is_ok()
        );
    }
    let utm_in_file = || Tag::Shorts(34735, vec![1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32633]);
    assert!(read("tif", vec![utm_in_file()], &prj(UTM_33)).is_ok());
    let other = UTM_33.replace("15.0", "21.0");
    let refused = read("tif", vec![utm_in_file()], &prj(&other)).unwrap_err();
    assert!(refused.contains("where the raster itself states") && refused.contains("dem.prj"), "{refused}");
    assert!("EPSG:32633".parse::<MapProjection>().is_ok(), "the code of the test is known");
}

#[test]
fn statements_that_differ_are_refused_and_the_user_decides() {
    let tagged = || vec![Tag::Text(42113, "7".to_owned())];
    let beside = || vec![(".aux.xml", band("<NoDataValue>8</NoDataValue>"))];
    let refused = read("tif", tagged(), &beside()).unwrap_err();
    assert!(refused.contains("8, where the raster itself states 7") && refused.contains("terrain.no_data"), "{refused}");
    assert!(read("stated.asc", vec![], &beside()).unwrap_err().contains("states -1"));
    assert!(read("tif", tagged(), &[(".aux.xml", band("<NoDataValue>7.0</NoDataValue>"))]).is_ok());
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), "tif", tagged(), &beside());
    for (rule, gap) in
        [(NoDataRule::Value(8.0.into()), Some(7)), (NoDataRule::Value(7.0.into()), Some(6)), (NoDataRule::Nothing, None)]
    {
        let dem = DemOptions::default().no_data(rule).read(&path).unwrap();
        assert_eq!(dem.elevations().position(|z| z.is_none()), gap, "{rule:?}");
    }
    let scaled =
        vec![Tag::Text(42112, "<GDALMetadata><Item name=\"S\" sample=\"0\" role=\"scale\">2</Item></GDALMetadata>".to_owned())];
    assert!(read("tif", scaled, &[(".aux.xml", band("<Scale>3</Scale>"))]).unwrap_err().contains("3 times"));
}

/// A raster without a place takes it from a world file; one with a place must agree with it.
#[test]
fn world_files_place_a_raster_or_agree_with_it() {
    let right = || b"10\n0\n0\n-10\n500005\n4500025\n".to_vec();
    for ending in ["tfw", "tifw", "wld", "TFW"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("dem.tif");
        std::fs::write(&path, plain_tiff((3, 4), &Samples::of("float32", &HEIGHTS), [])).unwrap();
        assert!(read_dem(&path).unwrap_err().to_string().contains("no position on a map"));
        std::fs::write(folder.path().join(format!("dem.{ending}")), right()).unwrap();
        let dem = read_dem(&path).unwrap();
        assert_eq!(
            (dem.georeference().north_west(), dem.georeference().dx_m()),
            (MapPoint::new(500_005.0, 4_500_025.0), 10.0),
            "{ending}"
        );
        assert_eq!(sidecar_files(&path).len(), 1, "{ending}");
    }
    for extension in FORMATS {
        assert!(read(extension, vec![], &[("wld", right())]).is_ok(), "{extension}");
        let half_a_pixel_off = b"10\n0\n0\n-10\n500000\n4500030\n".to_vec();
        let refused = read(extension, vec![], &[("wld", half_a_pixel_off)]).unwrap_err();
        assert!(refused.contains("dem.wld") && refused.contains("where the raster itself states"), "{extension}: {refused}");
        assert!(read(extension, vec![], &[("wld", b"1 2 3".to_vec())]).unwrap_err().contains("3 numbers"), "{extension}");
    }
}

/// Formats that could change the meaning and are not read are refused by name, and files that say nothing are left alone.
#[test]
fn other_sidecar_files_are_refused_by_name() {
    for (ending, content, word) in [
        ("tab", &b"!table"[..], "MapInfo"),
        ("rpc", b"x", "coefficients"),
        ("aux", b"EHFA_HEADER_TAG\0", "ERDAS"),
        (".aux.xml", b"<PAMDataset><Thing/></PAMDataset>", "<Thing>"),
        (".aux.xml", b"<PAMDataset><GCPList/></PAMDataset>", "control points"),
        (".aux.xml", b"<PAMDataset><PAMRasterBand><UnitType>ft</UnitType></PAMRasterBand></PAMDataset>", "'ft'"),
        (".aux.xml", b"not xml", "not XML"),
    ] {
        for extension in FORMATS {
            let refused = read(extension, vec![], &[(ending, content.to_vec())]).unwrap_err();
            assert!(refused.contains(word) && refused.contains("expected"), "{extension} {ending}: {refused}");
        }
    }
    let statistics = band("<Metadata><MDI key=\"STATISTICS_MAXIMUM\">12</MDI></Metadata><Histograms><HistItem/></Histograms>");
    for harmless in [
        vec![("ovr", b"x".to_vec())],
        vec![("aux", b"latex".to_vec())],
        vec![(".aux.xml", statistics)],
        vec![("xml", b"<metadata/>".to_vec())],
    ] {
        for extension in FORMATS {
            assert!(read(extension, vec![], &harmless).is_ok(), "{extension} {harmless:?}");
        }
    }
}

/// A sidecar file that is wrong is wrong beside a raster with a map of its own as well, and one that cannot be compared is not believed.
#[test]
fn wrong_sidecar_files_are_refused_beside_a_raster_with_its_own_map() {
    let keys = |entries: &[u16]| {
        let count = u16::try_from(entries.len() / 4).unwrap();
        vec![Tag::Shorts(34735, [&[1, 1, 0, count], entries].concat())]
    };
    let utm = || keys(&[1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32633]);
    let unsupported = || keys(&[1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32767, 3075, 0, 1, 25, 3076, 0, 1, 9001]);
    let raster_type_alone = || keys(&[1025, 0, 1, 2]);
    let feet = UTM_33.replace("UNIT[\"Meter\",1.0]", "UNIT[\"Foot_US\",0.3048006096012192]");
    let depths = format!(
        "{UTM_33},VERTCS[\"MSL\",VDATUM[\"MSL\"],PARAMETER[\"Vertical_Shift\",0.0],PARAMETER[\"Direction\",-1.0],UNIT[\"Meter\",1.0]]"
    );
    let shifted = depths.replace("Shift\",0.0", "Shift\",100.0").replace("-1.0", "1.0");
    let mollweide = UTM_33.replace("Transverse_Mercator", "Mollweide");
    for (tags, text, word) in [
        (utm(), &*feet, "Foot_US"),
        (utm(), "rubbish", "dem.prj"),
        (utm(), &depths, "DIRECTION -1"),
        (utm(), &shifted, "VERTICAL_SHIFT 100"),
        (utm(), &mollweide, "of a projection that is not supported"),
        (unsupported(), UTM_33, "another one ("),
        (raster_type_alone(), &feet, "Foot_US"),
        (vec![], &depths, "DIRECTION -1"),
    ] {
        let refused = read("tif", tags, &[("prj", text.as_bytes().to_vec())]).unwrap_err();
        assert!(refused.contains(word) && refused.contains("expected"), "{word}: {refused}");
    }
    // Neither is understood: the scale is refused where it counts, as it is without the sidecar file.
    let both = read("tif", unsupported(), &[("prj", mollweide.as_bytes().to_vec())]).unwrap();
    assert!(both.georeference().projection().is_err());
    let alone = read("asc", vec![], &[("prj", mollweide.as_bytes().to_vec())]).unwrap();
    assert!(alone.georeference().projection().unwrap_err().to_string().contains("not supported"));
    // Two sidecar files that differ.
    let other = UTM_33.replace("15.0", "21.0");
    let srs = aux(&format!("<SRS>{}</SRS>", UTM_33.replace('"', "&quot;")));
    assert!(
        read("asc", vec![], &[(".aux.xml", srs), ("prj", other.into_bytes())]).unwrap_err().contains("another reference system")
    );
}

/// The same statement in other digits, numbers of bands and letters of names.
#[test]
fn statements_are_the_same_whatever_their_digits_and_letters() {
    let tag = |text: &str| vec![Tag::Text(42113, text.to_owned())];
    for (own, beside) in [
        ("-3.4028234663852886e+38", "-3.40282346638529E+38"),
        ("-9999.9", "-9999.900390625"),
        ("-3.4028235e+38", "-3.40282e+38"),
        ("nan", "NaN"),
    ] {
        let read = read("tif", tag(own), &[(".aux.xml", band(&format!("<NoDataValue>{beside}</NoDataValue>")))]);
        assert!(read.is_ok(), "{own} {beside}: {read:?}");
    }
    for element in ["NoDataValueAsInt64", "NoDataValueAsUInt64"] {
        let dem = read("tif", vec![], &[(".aux.xml", band(&format!("<{element}>7</{element}>")))]).unwrap();
        assert_eq!(dem.elevations().position(|z| z.is_none()), Some(6), "{element}");
    }
    for number in ["01", " 1", "1"] {
        let text = aux(&format!("<PAMRasterBand band=\"{number}\"><Scale>2</Scale></PAMRasterBand>"));
        assert_eq!(read("tif", vec![], &[(".aux.xml", text)]).unwrap().elevation(0, 0), Some(2.0), "{number}");
    }
    for name in ["dem.TFW", "DEM.tfw", "Dem.Wld"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("dem.tif");
        std::fs::write(&path, plain_tiff((3, 4), &Samples::of("float32", &HEIGHTS), [])).unwrap();
        std::fs::write(folder.path().join(name), "10\n0\n0\n-10\n500005\n4500025\n").unwrap();
        assert!(read_dem(&path).is_ok(), "{name}");
    }
}
