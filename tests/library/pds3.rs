//! PDS3 images from a small writer of the test, read by us and by GDAL.
#![allow(clippy::format_push_string, reason = "a test's text need not be written fast")]
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and says why it skips")]

use std::path::Path;
use std::process::Command;

use chta::quantity::MapPoint;
use chta::terrain::{Dem, NoProjection, geotiff_bytes, read_dem, read_pds3_bytes, slice, slice_file};

const ROWS: usize = 17;
const COLS: usize = 23;
const RECORD: usize = 512;

/// Stored numbers without a pattern that fit every sample type.
fn stored(row: usize, col: usize) -> u8 {
    u8::try_from((row * 7919 + col * 104_729) % 113).unwrap()
}

/// A sample's bytes in each type.
fn encode(value: f64, sample_type: &str, bits: usize) -> Vec<u8> {
    let little = ["LSB", "PC_", "VAX"].iter().any(|start| sample_type.starts_with(start));
    #[expect(clippy::cast_possible_truncation, reason = "small whole numbers")]
    let mut bytes = match (sample_type.ends_with("INTEGER"), bits) {
        (true, _) => (value as i64).to_be_bytes()[8 - bits / 8..].to_vec(),
        (false, 32) => (value as f32).to_be_bytes().to_vec(),
        (false, _) => value.to_be_bytes().to_vec(),
    };
    if little {
        bytes.reverse();
    }
    bytes
}

struct Fixture<'a> {
    sample_type: &'a str,
    bits: usize,
    /// Further lines of the IMAGE object.
    image: &'a str,
    projection: &'a str,
    prefix: usize,
    suffix: usize,
}

const POLAR: &str = "MAP_PROJECTION_TYPE = \"POLAR STEREOGRAPHIC\"\nA_AXIS_RADIUS = 1737.4 <KM>\nB_AXIS_RADIUS = 1737.4 <KM>\nC_AXIS_RADIUS = 1737.4 <KM>\n\
                     POSITIVE_LONGITUDE_DIRECTION = \"EAST\"\nCENTER_LATITUDE = -90.0 <DEG>\nCENTER_LONGITUDE = 0.0 <DEG>\nMAP_SCALE = 0.02 <KM/PIXEL>\n\
                     MAP_PROJECTION_ROTATION = 0.0\nLINE_PROJECTION_OFFSET = 40.5\nSAMPLE_PROJECTION_OFFSET = -12.25\n";

impl Default for Fixture<'_> {
    fn default() -> Self {
        Self { sample_type: "LSB_INTEGER", bits: 16, image: "", projection: POLAR, prefix: 0, suffix: 0 }
    }
}

impl Fixture<'_> {
    fn pixels(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        for row in 0..ROWS {
            bytes.extend(vec![0xee; self.prefix]);
            for col in 0..COLS {
                bytes.extend(encode(f64::from(stored(row, col)), self.sample_type, self.bits));
            }
            bytes.extend(vec![0xdd; self.suffix]);
        }
        bytes
    }

    fn label(&self, pointer: &str) -> String {
        let Self { sample_type, bits, image, projection, prefix, suffix } = self;
        let mut text = format!(
            "PDS_VERSION_ID = PDS3\r\n/* made by a test */\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = {RECORD}\r\nFILE_RECORDS = 9\r\n\
             ^IMAGE = {pointer}\r\nTARGET_NAME = \"MOON\"\r\nOBJECT = IMAGE\r\n  LINES = {ROWS}\r\n  LINE_SAMPLES = {COLS}\r\n  BANDS = 1\r\n  \
             SAMPLE_TYPE = {sample_type}\r\n  SAMPLE_BITS = {bits}\r\n  LINE_PREFIX_BYTES = {prefix}\r\n  LINE_SUFFIX_BYTES = {suffix}\r\n{image}\
             END_OBJECT = IMAGE\r\n"
        );
        if !projection.is_empty() {
            text += &format!("OBJECT = IMAGE_MAP_PROJECTION\r\n{projection}END_OBJECT = IMAGE_MAP_PROJECTION\r\n");
        }
        text + "END\r\n"
    }

    /// The label in whole records, then the image.
    fn attached(&self) -> Vec<u8> {
        let records = self.label("00").len().div_ceil(RECORD);
        let mut bytes = self.label(&format!("{:02}", records + 1)).into_bytes();
        bytes.resize(records * RECORD, b' ');
        bytes.extend(self.pixels());
        bytes
    }

    fn read(&self) -> Dem {
        read_pds3_bytes(self.attached()).unwrap()
    }

    fn refusal(&self) -> String {
        read_pds3_bytes(self.attached()).unwrap_err().to_string()
    }
}

fn holds_the_stored_numbers(dem: &Dem) {
    for row in 0..ROWS {
        for col in 0..COLS {
            assert_eq!(dem.elevation(row, col), Some(f64::from(stored(row, col))), "{row} {col}");
        }
    }
}

const TYPES: [(&str, usize); 20] = [
    ("MSB_INTEGER", 16),
    ("MSB_INTEGER", 32),
    ("INTEGER", 8),
    ("MAC_INTEGER", 16),
    ("SUN_INTEGER", 32),
    ("LSB_INTEGER", 16),
    ("PC_INTEGER", 32),
    ("VAX_INTEGER", 16),
    ("MSB_UNSIGNED_INTEGER", 16),
    ("UNSIGNED_INTEGER", 8),
    ("SUN_UNSIGNED_INTEGER", 32),
    ("LSB_UNSIGNED_INTEGER", 16),
    ("PC_UNSIGNED_INTEGER", 8),
    ("VAX_UNSIGNED_INTEGER", 32),
    ("IEEE_REAL", 32),
    ("IEEE_REAL", 64),
    ("FLOAT", 32),
    ("SUN_REAL", 64),
    ("PC_REAL", 32),
    ("PC_REAL", 64),
];

#[test]
fn every_sample_type_reads_as_the_numbers_written() {
    for (sample_type, bits) in TYPES {
        holds_the_stored_numbers(&Fixture { sample_type, bits, ..Fixture::default() }.read());
    }
    holds_the_stored_numbers(&Fixture { prefix: 6, suffix: 3, ..Fixture::default() }.read());
}

#[test]
fn the_first_post_lies_at_the_offsets_times_the_scale() {
    let map = Fixture::default().read().georeference().clone();
    assert_eq!((map.north_west(), map.dx_m(), map.dy_m()), (MapPoint::new(12.25 * 20.0, 40.5 * 20.0), 20.0, 20.0));
    let metres = POLAR.replace("0.02 <KM/PIXEL>", "20 <M/PIXEL>");
    assert_eq!(Fixture { projection: &metres, ..Fixture::default() }.read().georeference().north_west(), map.north_west());
    let silent = POLAR.replace("0.02 <KM/PIXEL>", "0.02");
    assert_eq!(Fixture { projection: &silent, ..Fixture::default() }.read().georeference().dx_m(), 20.0);
}

#[test]
fn scale_offset_unit_and_missing_constants_are_applied() {
    let mark = stored(3, 5);
    let image = format!("SCALING_FACTOR = 0.5\r\nOFFSET = -3\r\nMISSING_CONSTANT = {mark}\r\n");
    let dem = Fixture { image: &image, ..Fixture::default() }.read();
    assert_eq!(dem.elevation(3, 5), None);
    assert_eq!(dem.elevation(0, 1), Some(f64::from(stored(0, 1)) * 0.5 - 3.0));
    let kilometres = Fixture { image: "UNIT = KILOMETER\r\n", sample_type: "PC_REAL", bits: 32, ..Fixture::default() }.read();
    assert_eq!(kilometres.elevation(0, 1), Some(f64::from(stored(0, 1)) * 1000.0));
    let bits = format!("MISSING_CONSTANT = 16#{:08X}#\r\n", f32::from(mark).to_bits());
    let dem = Fixture { image: &bits, sample_type: "PC_REAL", bits: 32, ..Fixture::default() }.read();
    assert_eq!((dem.elevation(3, 5), dem.elevation(0, 1)), (None, Some(f64::from(stored(0, 1)))));
}

#[test]
fn images_that_are_not_elevation_maps_are_refused_by_key() {
    let of = |image: &'static str, projection: &str| Fixture { image, projection, ..Fixture::default() }.refusal();
    assert!(of("", "").contains("no MAP_SCALE"));
    assert!(of("SCALING_FACTOR = 0\r\n", POLAR).contains("SCALING_FACTOR 0"));
    assert!(of("UNIT = FEET\r\n", POLAR).contains("'FEET'"));
    assert!(of("ENCODING_TYPE = HUFFMAN\r\n", POLAR).contains("'HUFFMAN'"));
    assert!(of("BANDS = 3\r\n", POLAR).contains("BANDS more than once"));
    assert!(of("", &POLAR.replace("ROTATION = 0.0", "ROTATION = 30")).contains("ROTATION 30"));
    assert!(of("", &POLAR.replace("<KM/PIXEL>", "<PIXEL/DEG>")).contains("PIXEL/DEG"));
    assert!(of("", &POLAR.replace("LINE_PROJECTION_OFFSET", "LINE_OFF")).contains("no LINE_PROJECTION_OFFSET"));
    assert!(Fixture { sample_type: "COMPLEX", bits: 64, ..Fixture::default() }.refusal().contains("COMPLEX"));
    let mut cut = Fixture::default().attached();
    cut.truncate(cut.len() - 1);
    assert!(read_pds3_bytes(cut).unwrap_err().to_string().contains("cannot hold"));
    let mut gap = Fixture::default().attached();
    let end = gap.len();
    gap[end - 2..].copy_from_slice(&(-32768_i16).to_le_bytes());
    assert!(read_pds3_bytes(gap).unwrap_err().to_string().contains("terrain.no_data = -32768"));
    let other = Fixture::default().label("\"A.IMG\"");
    assert!(read_pds3_bytes(other.into_bytes()).unwrap_err().to_string().contains("side by side"));
}

/// Special values: which samples are gaps, and which keys are refused. Known from the data dictionary, the labels of SELENE
/// products (the first keys of the list), of Mars Express (`DTM_MISSING_DN`) and of ISIS exports (`NULL`, `VALID_MINIMUM`).
#[test]
fn special_values_are_gaps_and_unknown_keys_are_refused() {
    let at = (3, 5);
    let other = (0, 1);
    let mark = stored(at.0, at.1);
    assert!(mark != stored(other.0, other.1));
    for key in [
        "MISSING_CONSTANT",
        "INVALID_VALUE",
        "OUT_OF_IMAGE_BOUNDS_VALUE",
        "NULL",
        "LRO:NULL",
        "DUMMY_DATA",
        "NO_DATA_VALUE",
        "DTM_MISSING_DN",
        "HIGH_INSTR_SATURATION",
        "invalid_value",
    ] {
        for value in [format!("{mark}"), format!("(-20000, {mark}, -23000)"), format!("16#{mark:04X}#")] {
            let dem = Fixture { image: &format!("{key} = {value}\r\n"), ..Fixture::default() }.read();
            assert_eq!(dem.elevation(at.0, at.1), None, "{key} = {value}");
            assert_eq!(dem.elevation(other.0, other.1), Some(f64::from(stored(other.0, other.1))), "{key} = {value}");
        }
    }
    let range = Fixture { image: "VALID_MINIMUM = 20\r\nVALID_MAXIMUM = 90\r\n", ..Fixture::default() }.read();
    for row in 0..ROWS {
        for col in 0..COLS {
            let inside = (20..=90).contains(&stored(row, col));
            assert_eq!(range.elevation(row, col).is_some(), inside, "{}", stored(row, col));
        }
    }
    for harmless in [
        "INVALID_TYPE = (SATURATION, MINUS)",
        "MINIMUM = 0",
        "DERIVED_MAXIMUM = 112",
        "SCENE_MAXIMUM_DN = 5",
        "MISSING_LINES = 3",
        "SAMPLE_BIT_MASK = 2#1111111111111111#",
        "MISSING_CONSTANT = N/A",
        "RADIANCE_OFFSET = 0.0",
        "LINE_DISPLAY_DIRECTION = DOWN",
        "STRETCHED_FLAG = FALSE",
    ] {
        holds_the_stored_numbers(&Fixture { image: &format!("{harmless}\r\n"), ..Fixture::default() }.read());
    }
    for unknown in [
        "SHADOW_VALUE = -7",
        "OCCLUDED_CONSTANT = 3",
        "BAD_DN = 0",
        "MYSTERY_SATURATION = 5",
        "HEIGHT_SCALING_FACTOR = 0.1",
        "DEM_OFFSET = 1737400",
        "SAMPLE_BIT_MASK = 2#0000111111111111#",
        "LINE_DISPLAY_DIRECTION = UP",
        "INVALID_VALUE = UNKNOWN_TEXT",
        "OFFSET = 1737.4 <KM>",
        "UNIT = METER\r\nSCALING_FACTOR = 0.001 <KM/DN>",
        "UNIT = RADIAN",
    ] {
        let refusal = Fixture { image: &format!("{unknown}\r\n"), ..Fixture::default() }.refusal();
        let key = unknown.lines().last().unwrap().split(' ').next().unwrap();
        assert!(refusal.contains(key) && !refusal.contains("damaged"), "{unknown}: {refusal}");
    }
    // In a group of a mission outside the IMAGE object.
    for (group, expected) in [
        ("DTM_MISSING_DN = {}", None),
        ("MY_MISSING_VALUE = {}", Some("MY_MISSING_VALUE")),
        ("DTM_SCALING_FACTOR = 2.0", Some("DTM_SCALING_FACTOR")),
    ] {
        let text = format!(
            "{POLAR}END_OBJECT\r\nGROUP = DTM\r\n{}\r\nEND_GROUP\r\nOBJECT = EXTRA\r\n",
            group.replace("{}", &mark.to_string())
        );
        let fixture = Fixture { projection: &text, ..Fixture::default() };
        match expected {
            None => assert_eq!(fixture.read().elevation(at.0, at.1), None),
            Some(key) => assert!(fixture.refusal().contains(key), "{group}"),
        }
    }
}

#[test]
fn maps_that_are_stated_in_terms_not_known_or_contradictory_are_refused_by_key() {
    for (from, to, expected) in [
        ("\"EAST\"", "\"UP\"", "POSITIVE_LONGITUDE_DIRECTION 'UP'"),
        ("A_AXIS_RADIUS = 1737.4 <KM>", "A_AXIS_RADIUS = 1737400 <KM>", "A_AXIS_RADIUS of 1737400000 m"),
        ("A_AXIS_RADIUS = 1737.4 <KM>", "A_AXIS_RADIUS = 1737.4 <M>", "for 'MOON', whose radius is 1737400 m"),
        ("A_AXIS_RADIUS = 1737.4 <KM>", "A_AXIS_RADIUS = 1737.4 <MILES>", "A_AXIS_RADIUS in 'MILES'"),
        ("B_AXIS_RADIUS = 1737.4", "B_AXIS_RADIUS = 1700", "B_AXIS_RADIUS of 1700000 m"),
        ("0.02 <KM/PIXEL>", "0.02 <KM/DEGREE>", "MAP_SCALE in 'KM/DEGREE'"),
        ("0.02 <KM/PIXEL>", "20 <KM/PIXEL>\r\nMAP_RESOLUTION = 1516.17 <PIXEL/DEGREE>", "MAP_RESOLUTION 1516.17 per degree"),
        (
            "C_AXIS_RADIUS = 1737.4 <KM>\r\n",
            "C_AXIS_RADIUS = 1700 <KM>\r\nCOORDINATE_SYSTEM_NAME = \"ODD\"\r\n",
            "COORDINATE_SYSTEM_NAME 'ODD'",
        ),
    ] {
        let text =
            POLAR.replace("\nA_AXIS", "\r\nA_AXIS").replace("<KM>\n", "<KM>\r\n").replace("LATITUDE = -90.0", "LATITUDE = -70.0");
        let projection = text.replace(from, to);
        assert_ne!(projection, text, "{from}");
        let refusal = Fixture { projection: &projection, ..Fixture::default() }.refusal();
        assert!(refusal.contains(expected), "{to}: {refusal}");
    }
    // The standard's own values, with blanks or underscores, in any letters.
    for (from, to) in [
        ("\"POLAR STEREOGRAPHIC\"", "simple cylindrical"),
        ("0.02 <KM/PIXEL>", "20 <METERS/PIXEL>\nMAP_RESOLUTION = 1516.17 <PIXEL/DEGREE>"),
        ("\"EAST\"", "east"),
        ("MAP_PROJECTION_TYPE", "COORDINATE_SYSTEM_NAME = \"MEAN EARTH/POLAR AXIS OF DE421\"\nMAP_PROJECTION_TYPE"),
    ] {
        let to = to.replace("simple cylindrical", "\"simple cylindrical\"");
        holds_the_stored_numbers(&Fixture { projection: &POLAR.replace(from, &to), ..Fixture::default() }.read());
    }
}

/// Labels in small letters, with comments before the version, and with every line end.
/// Keys of the IMAGE object that convert samples or name special ones, and are not applied, are refused with their key; values that
/// change nothing pass, and marks are read.
#[test]
fn keys_of_the_image_that_would_change_its_samples_are_not_passed_over() {
    let read = |image: &str| read_pds3_bytes(Fixture { image, ..Fixture::default() }.attached());
    for key in [
        "DN_SCALE",
        "Z_SCALE",
        "HEIGHT_SCALE",
        "VERTICAL_SCALE",
        "DN_TO_METERS",
        "CORE_MULTIPLIER",
        "SCALE_FACTOR",
        "SCALE",
        "DN_GAIN",
    ] {
        let message = read(&format!("  {key} = 0.5\r\n")).unwrap_err().to_string();
        assert!(message.contains(key) && message.contains("0.5"), "{key}: {message}");
        assert!(read(&format!("  {key} = 1.0\r\n")).is_ok(), "{key}");
    }
    for key in ["BASE", "CORE_BASE", "SAMPLE_BASE", "DN_OFFSET", "HEIGHT_BIAS"] {
        let message = read(&format!("  {key} = 0.5\r\n")).unwrap_err().to_string();
        assert!(message.contains(key) && message.contains("0.5"), "{key}: {message}");
        assert!(read(&format!("  {key} = 0\r\n")).is_ok(), "{key}");
    }
    for (lines, sound) in [
        ("CORE_UNIT = \"KILOMETER\"", false),
        ("UNITS = KM", false),
        ("DN_UNIT = FEET", false),
        ("CORE_UNIT = \"METER\"", true),
        ("CORE_UNIT = \"N/A\"", true),
        ("UNIT = KM\r\n  CORE_UNIT = KM", true),
        ("UNIT = KM\r\n  CORE_UNIT = M", false),
    ] {
        let found = read(&format!("  {lines}\r\n")).map(drop).map_err(|error| error.to_string());
        assert!(found.is_ok() == sound && found.as_ref().err().is_none_or(|error| error.contains("UNIT")), "{lines}: {found:?}");
    }
    for key in ["INVALID", "FILL", "BLANK"] {
        let dem = read(&format!("  {key} = {}\r\n", stored(3, 4))).unwrap();
        assert_eq!(dem.elevation(3, 4), None, "{key}");
    }
    for key in ["GAP", "EMPTY_DATA", "VOID", "FILL_NUMBER"] {
        let message = read(&format!("  {key} = 37\r\n")).unwrap_err().to_string();
        assert!(message.contains(key), "{key}: {message}");
    }
}

#[test]
fn labels_are_recognised_as_they_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let fixture = Fixture::default();
    let label = fixture.label("\"MADE.IMG\"");
    std::fs::write(folder.path().join("MADE.IMG"), fixture.pixels()).unwrap();
    for (name, text) in [
        ("small.lbl", label.to_lowercase()),
        ("comment.lbl", format!("/* made */\r\n/* by hand */\r\n{label}")),
        ("envelope.lbl", format!("ccsd3zf0000100000001njpl3if0pdsx00000001\r\n{}", label.to_lowercase())),
        ("returns.lbl", label.replace("\r\n", "\r")),
        ("feeds.lbl", label.replace("\r\n", "\n")),
        ("mark.lbl", format!("\u{feff}{label}")),
        ("older.lbl", label.replace("PDS_VERSION_ID = PDS3", "ODL_VERSION_ID = ODL3")),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        holds_the_stored_numbers(&read_dem(&path).unwrap_or_else(|error| panic!("{name}: {error}")));
    }
    // A file that is no label gets no hint to give it in its own place.
    let path = folder.path().join("none.lbl");
    std::fs::write(&path, "no label at all").unwrap();
    assert!(!read_dem(&path).unwrap_err().to_string().contains("give none.lbl instead"));
}

#[test]
fn a_detached_label_finds_its_image_and_the_image_names_its_label() {
    let folder = tempfile::tempdir().unwrap();
    let fixture = Fixture::default();
    for (pointer, lead) in [("\"MADE.IMG\"", 0), ("(\"MADE.IMG\", 3)", 2 * RECORD), ("(\"MADE.IMG\", 101 <BYTES>)", 100)] {
        std::fs::write(folder.path().join("made.lbl"), fixture.label(pointer)).unwrap();
        std::fs::write(folder.path().join("made.img"), [vec![0xaa; lead], fixture.pixels()].concat()).unwrap();
        holds_the_stored_numbers(&read_dem(&folder.path().join("made.lbl")).unwrap());
    }
    let message = read_dem(&folder.path().join("made.img")).unwrap_err().to_string();
    assert!(message.contains("made.lbl"), "{message}");
    std::fs::write(folder.path().join("made.lbl"), fixture.label("\"../MADE.IMG\"")).unwrap();
    assert!(read_dem(&folder.path().join("made.lbl")).unwrap_err().to_string().contains("plain name"));
    std::fs::write(folder.path().join("made.lbl"), fixture.label("\"OTHER.IMG\"")).unwrap();
    assert!(read_dem(&folder.path().join("made.lbl")).unwrap_err().to_string().contains("does not exist"));
}

#[test]
fn slices_of_windows_of_the_file_equal_those_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.img");
    std::fs::write(&path, Fixture { prefix: 5, ..Fixture::default() }.attached()).unwrap();
    let dem = read_dem(&path).unwrap();
    let (low, high) = (dem.bounds().min, dem.bounds().max);
    for (from, to) in [(low, high), (MapPoint::new(low.x, high.y), MapPoint::new(high.x, low.y + 31.0))] {
        assert_eq!(slice_file(&path, from, to).unwrap(), slice(&dem, from, to).unwrap());
    }
}

fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let Ok(output) = Command::new(program).args(arguments).env("GDAL_PAM_ENABLED", "NO").output() else {
        eprintln!("skipped: {program} is not installed");
        return None;
    };
    assert!(output.status.success(), "{program} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn gdal_reads_the_same_images_at_the_same_positions() {
    let folder = tempfile::tempdir().unwrap();
    // GDAL supports fewer type names.
    for (sample_type, bits) in [
        ("LSB_INTEGER", 16),
        ("MSB_INTEGER", 16),
        ("PC_REAL", 32),
        ("IEEE_REAL", 32),
        ("UNSIGNED_INTEGER", 8),
        ("LSB_UNSIGNED_INTEGER", 16),
    ] {
        let path = folder.path().join("a.img");
        std::fs::write(&path, Fixture { sample_type, bits, ..Fixture::default() }.attached()).unwrap();
        let name = path.to_str().unwrap();
        let Some(text) = output("gdalinfo", &["-json", "-mm", name]) else { return };
        let info: serde_json::Value = serde_json::from_str(&text).unwrap();
        let number = |pointer: &str| info.pointer(pointer).and_then(serde_json::Value::as_f64).unwrap();
        let dem = read_dem(&path).unwrap();
        assert_eq!(info["driverShortName"], "PDS");
        assert_eq!((number("/size/0"), number("/size/1")), (23.0, 17.0));
        // GDAL's corner lies half a post outside the centre of the first post.
        let map = dem.georeference();
        assert_eq!((number("/geoTransform/1"), number("/geoTransform/5")), (map.dx_m(), -map.dy_m()));
        let centre = MapPoint::new(
            number("/geoTransform/0") + 0.5 * number("/geoTransform/1"),
            number("/geoTransform/3") + 0.5 * number("/geoTransform/5"),
        );
        assert!((centre - map.north_west()).norm() < 1e-9, "{centre:?} {:?}", map.north_west());
        let raw = folder.path().join("raw.img");
        output("gdal_translate", &["-q", "-of", "ENVI", "-ot", "Float64", name, raw.to_str().unwrap()]);
        let bytes = std::fs::read(&raw).unwrap();
        let theirs = bytes.chunks_exact(8).map(|post| Some(f64::from_le_bytes(post.try_into().unwrap())));
        assert!(dem.elevations().eq(theirs), "{sample_type} {bits}");
    }
}

/// The same position on the body, through GDAL, from the image and from our `GeoTIFF` of it.
#[test]
fn the_projection_goes_into_a_geotiff_as_gdal_understands_the_label() {
    let folder = tempfile::tempdir().unwrap();
    for (projection, latitude) in [
        ("POLAR STEREOGRAPHIC", "-90"),
        ("POLAR_STEREOGRAPHIC", "90"),
        ("SIMPLE_CYLINDRICAL", "0"),
        ("EQUIRECTANGULAR", "12"),
        ("SINUSOIDAL", "0"),
        // For a polar map, GDAL uses a centre other than the pole as the standard parallel.
        ("STEREOGRAPHIC", "90"),
        ("ORTHOGRAPHIC", "-20"),
        ("TRANSVERSE_MERCATOR", "10"),
    ] {
        let text = POLAR
            .replace("\"POLAR STEREOGRAPHIC\"", &format!("\"{projection}\""))
            .replace("LATITUDE = -90.0", &format!("LATITUDE = {latitude}"))
            .replace("LONGITUDE = 0.0", "LONGITUDE = 77.0");
        let image = folder.path().join("a.img");
        let tiff = folder.path().join("a.tif");
        std::fs::write(&image, Fixture { projection: &text, ..Fixture::default() }.attached()).unwrap();
        std::fs::write(&tiff, geotiff_bytes(&read_dem(&image).unwrap()).unwrap()).unwrap();
        let place = |path: &Path| {
            let text = output("gdalinfo", &["-json", path.to_str().unwrap()])?;
            let info: serde_json::Value = serde_json::from_str(&text).unwrap();
            let ring = info.pointer("/wgs84Extent/coordinates/0").or_else(|| info.pointer("/extent/coordinates/0")).cloned();
            let system = output("gdalsrsinfo", &["-o", "proj4", path.to_str().unwrap()])?;
            Some((ring, system.trim().to_owned()))
        };
        let (Some(theirs), Some(ours)) = (place(&image), place(&tiff)) else { return };
        eprintln!("{projection}: {} / {}", theirs.1, ours.1);
        let numbers = |ring: &Option<serde_json::Value>| -> Vec<f64> {
            let ring = ring.as_ref().unwrap_or_else(|| unreachable!("{projection}")).as_array().unwrap();
            ring.iter().flat_map(|corner| corner.as_array().unwrap().iter().map(|value| value.as_f64().unwrap())).collect()
        };
        for (a, b) in numbers(&theirs.0).iter().zip(numbers(&ours.0)) {
            assert!((a - b).abs() < 1e-6, "{projection}: {theirs:?} {ours:?}");
        }
    }
}

/// A projection that a label states and that is not known here, or without radii, is no local map.
#[test]
fn a_projection_that_is_not_known_is_stated_as_such() {
    let of = |projection: &str| Fixture { projection, ..Fixture::default() }.read().georeference().projection();
    assert!(of(POLAR).is_ok());
    let named = |name: &str| POLAR.replace("POLAR STEREOGRAPHIC", name);
    let radii = POLAR.lines().filter(|line| !line.contains("AXIS_RADIUS")).flat_map(|line| [line, "\n"]).collect::<String>();
    for (projection, word) in [
        (named("ROBINSON"), "ROBINSON"),
        (named("OBLIQUE CYLINDRICAL"), "OBLIQUE CYLINDRICAL"),
        (named("MERCATOR"), "MERCATOR"),
        (radii, "radius"),
    ] {
        let reason = of(&projection).unwrap_err();
        assert!(matches!(reason, NoProjection::Unknown(_)) && reason.to_string().contains(word), "{reason}");
    }
    let none = POLAR.lines().filter(|line| !line.contains("PROJECTION_TYPE")).flat_map(|line| [line, "\n"]).collect::<String>();
    assert_eq!(of(&none), Err(NoProjection::Local));
}
