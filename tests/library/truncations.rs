//! Files of every format, cut at every byte: refused where the format states its size or the cut falls inside a record; where a
//! cut leaves a shorter file of the same format, the number of rows read says so, or a warning that the last line is open.

use crate::mutations_chain_csv::{EXPLICIT, PAIRS, SURFACE};
use crate::mutations_mesh::{ascii_stl, binary_stl, obj, ply};
use crate::mutations_overlays::{BOUNDS, ZONES};
use crate::mutations_scenario::TOML;
use crate::tiff::int16_tiff;
use chta::chain::csv::{read_chain_csv, read_pairs_csv};
use chta::quantity::MapPoint;
use chta::scenario::{Entries, Scenario};
use chta::terrain::{
    SyntheticTerrain, geotiff_bytes, read_ascii_grid_bytes, read_geotiff_bytes, read_keep_out, read_mesh_bytes, read_pds3_bytes,
    read_xyz_bytes, synthesise,
};

/// What a reader made of a file: how many rows it read, and its warnings.
type Read = Result<(usize, Vec<String>), String>;

type Reader<'a> = &'a dyn Fn(&[u8]) -> Read;

/// What may become of a file that was cut.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Allowed {
    /// A refusal only, up to so many bytes before the end (a line end, or the digits of the last number).
    Refused { but_last: usize },
    /// Fewer rows at a line end; within a line a refusal or a warning that names the number of rows read.
    FewerRows,
}

fn posts(dem: Result<chta::terrain::Dem, chta::terrain::TerrainError>) -> Read {
    dem.map(|dem| (dem.elevations().flatten().count(), Vec::new())).map_err(|error| error.to_string())
}

fn mesh(bytes: &[u8]) -> Read {
    let file = read_mesh_bytes(bytes, 1.0).map_err(|error| error.to_string())?;
    Ok((file.mesh.triangle_count(), file.warnings))
}

fn xyz() -> Vec<u8> {
    let line = |post: u32| format!("{},{},{}.25\n", post % 5 * 100, post / 5 * 100, post * 7 % 100 + 10);
    (0..25).map(line).collect::<String>().into_bytes()
}

fn pds3() -> Vec<u8> {
    let mut label = b"PDS_VERSION_ID = PDS3\nRECORD_BYTES = 1\n^IMAGE = 401 <BYTES>\nOBJECT = IMAGE\nLINES = 3\nLINE_SAMPLES = 4\n\
        SAMPLE_TYPE = LSB_INTEGER\nSAMPLE_BITS = 16\nEND_OBJECT\nOBJECT = IMAGE_MAP_PROJECTION\nMAP_SCALE = 10 <M/PIXEL>\n\
        LINE_PROJECTION_OFFSET = 5.5\nSAMPLE_PROJECTION_OFFSET = -7\nEND_OBJECT\nEND\n"
        .to_vec();
    label.resize(400, b' ');
    label.extend((1..13_i16).flat_map(i16::to_le_bytes));
    label
}

#[test]
fn cut_files_are_refused_or_say_how_much_was_read() {
    let terrain = SyntheticTerrain { rows: 9, cols: 13, south_west: MapPoint::new(-40.0, 1000.0), ..SyntheticTerrain::default() };
    let compressed = geotiff_bytes(&synthesise(&terrain).unwrap()).unwrap();
    let grid = b"ncols 3\nnrows 2\nxllcorner 10\nyllcorner -20\ncellsize 2\nNODATA_value -1\n1 2 3\n4 5 6.25\n".to_vec();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("zones.geojson");
    let zones = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        read_keep_out(&path, None, BOUNDS).map(|_| (2, Vec::new())).map_err(|error| error.to_string())
    };
    let chain = |bytes: &[u8]| {
        let file = read_chain_csv(bytes).map_err(|problems| problems.to_string())?;
        Ok((file.chain.vertices().len(), file.warnings))
    };
    let pairs = |bytes: &[u8]| {
        let file = read_pairs_csv(bytes).map_err(|problems| problems.to_string())?;
        Ok((file.pairs.len(), file.warnings))
    };
    let plain_chain = b"x_m,z_m\n0,0.5\n2.5,1.25\n10.75,3\n".to_vec();
    let refused = Allowed::Refused { but_last: 0 };
    let table: Vec<(&str, Vec<u8>, Allowed, Reader<'_>)> = vec![
        ("GeoTIFF", compressed, refused, &|bytes| posts(read_geotiff_bytes(bytes.to_vec()))),
        ("GeoTIFF without compression", int16_tiff(&[]), refused, &|bytes| posts(read_geotiff_bytes(bytes.to_vec()))),
        ("PDS3 image", pds3(), refused, &|bytes| posts(read_pds3_bytes(bytes.to_vec()))),
        // "6.25" and its line end: a number that lost digits is a number.
        ("ESRI ASCII grid", grid, Allowed::Refused { but_last: 4 }, &|bytes| posts(read_ascii_grid_bytes(bytes))),
        ("XYZ grid", xyz(), Allowed::FewerRows, &|bytes| posts(read_xyz_bytes(bytes))),
        ("OBJ", obj(), Allowed::FewerRows, &mesh),
        ("binary STL", binary_stl(), refused, &mesh),
        // The title after endsolid.
        ("ASCII STL", ascii_stl(), Allowed::Refused { but_last: 6 }, &mesh),
        ("binary PLY", ply(true), refused, &mesh),
        ("ASCII PLY", ply(false), Allowed::Refused { but_last: 2 }, &mesh),
        ("chain CSV of coordinates", plain_chain, Allowed::FewerRows, &chain),
        ("chain CSV of surfaces", SURFACE.as_bytes().to_vec(), Allowed::FewerRows, &chain),
        ("chain CSV of cones", EXPLICIT.as_bytes().to_vec(), Allowed::FewerRows, &chain),
        ("CSV of pairs", PAIRS.as_bytes().to_vec(), Allowed::FewerRows, &pairs),
        ("GeoJSON", ZONES.as_bytes().to_vec(), refused, &zones),
    ];
    for (name, whole, allowed, read) in table {
        let (rows, _) = read(&whole).unwrap_or_else(|message| panic!("{name}: {message}"));
        for end in 0..whole.len() {
            let Ok((fewer, warnings)) = read(&whole[..end]) else { continue };
            let at_line_end = end > 0 && (whole[end - 1] == b'\n' || (whole[end - 1] == b'\r' && whole[end] != b'\n'));
            let said = warnings.iter().any(|warning| warning.contains("make sure that it is whole"));
            match allowed {
                Allowed::Refused { but_last } => {
                    assert!(end + but_last >= whole.len(), "{name}, cut at {end} of {}, is read", whole.len());
                }
                Allowed::FewerRows if at_line_end => assert!(fewer < rows, "{name}, cut at {end}"),
                // The record is whole, and its line end alone is missing.
                Allowed::FewerRows => {
                    assert!(
                        said || matches!(whole[end], b'\n' | b'\r'),
                        "{name}, cut inside a line at {end} of {}, is read without a word",
                        whole.len()
                    );
                }
            }
        }
    }
}

/// A scenario has no size: a cut one has fewer keys. What is cut inside a table or value is refused.
#[test]
fn cut_scenarios_never_panic() {
    for end in 0..TOML.len() {
        if let Some(text) = TOML.get(..end) {
            let _ = Scenario::new(Entries::from_toml(text));
        }
    }
}
