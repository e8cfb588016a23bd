//! The byte readers with seeded mutations: no panic, no endless run, no huge memory.
#![allow(clippy::format_push_string, reason = "a test's text need not be written fast")]
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and prints its counts")]

use crate::mutations::rounds;
use crate::tiff::int16_tiff;
use chta::quantity::MapPoint;
use chta::terrain::{
    Dem, SyntheticTerrain, TerrainError, geotiff_bytes, read_ascii_grid_bytes, read_geotiff_bytes, read_pds3_bytes, read_xyz_bytes,
    synthesise, write_ascii_grid,
};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

fn small() -> Dem {
    let terrain = SyntheticTerrain { rows: 9, cols: 13, south_west: MapPoint::new(-40.0, 1000.0), ..SyntheticTerrain::default() };
    synthesise(&terrain).unwrap()
}

/// One to eight changes: bits, bytes, special numbers, cuts, copies.
fn mutate(whole: &[u8], random: &mut ChaCha8Rng, alphabet: &[u8]) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..random.random_range(1..=8) {
        let at = random.random_range(0..bytes.len());
        match random.random_range(0..7) {
            0 => bytes[at] ^= 1 << random.random_range(0..8),
            1 => bytes[at] = random.random(),
            2 => bytes[at] = alphabet[random.random_range(0..alphabet.len())],
            3 => {
                let value: u32 = [0, 1, 2, 0xffff, 0x7fff_ffff, 0xffff_ffff][random.random_range(0..6)];
                let end = (at + 4).min(bytes.len());
                bytes[at..end].copy_from_slice(&value.to_le_bytes()[..end - at]);
            }
            4 if random.random_range(0..4) == 0 => bytes.truncate(at.max(1)),
            5 => {
                let length = random.random_range(0..=(bytes.len() - at).min(40));
                let copy = bytes[at..at + length].to_vec();
                let to = random.random_range(0..bytes.len());
                bytes.splice(to..to, copy);
            }
            _ => {
                let length = random.random_range(0..=(bytes.len() - at).min(12));
                bytes.drain(at..at + length);
            }
        }
        if bytes.is_empty() {
            bytes.push(0);
        }
    }
    bytes
}

fn check(whole: &[u8], alphabet: &[u8], read: impl Fn(Vec<u8>) -> Result<Dem, TerrainError>) {
    assert!(read(whole.to_vec()).is_ok());
    let mut random = ChaCha8Rng::seed_from_u64(20_261_122);
    let rounds = rounds();
    let mut read_well = 0;
    for number in 0..rounds {
        let bytes = mutate(whole, &mut random, alphabet);
        match read(bytes) {
            Ok(dem) => {
                read_well += 1;
                assert!(dem.rows() >= 2 && dem.cols() >= 2);
                let (low_m, high_m) = dem.elevation_range_m();
                assert!(low_m <= high_m && low_m.abs() < 1e9 && high_m.abs() < 1e9);
            }
            Err(error) => {
                let message = error.to_string();
                assert!(!message.is_empty() && message.len() < 20_000, "mutation {number}: {message}");
            }
        }
    }
    // Some mutations change elevations only; most must be detected.
    assert!(read_well > 0 && read_well < rounds, "{read_well}");
    eprintln!("{read_well} of {rounds} mutations still read");
}

#[test]
fn mutated_geotiffs_never_panic() {
    check(&geotiff_bytes(&small()).unwrap(), b"\x00\x01\x02\x03\x04\x08\x10\xff", read_geotiff_bytes);
}

#[test]
fn mutated_plain_geotiffs_never_panic() {
    // Without compression, so that deflate's checksum does not detect the mutation.
    check(&int16_tiff(&[]), b"\x00\x01\x02\x03\x04\x08\x10\xff", read_geotiff_bytes);
}

#[test]
fn mutated_ascii_grids_never_panic() {
    let mut text = Vec::new();
    write_ascii_grid(&small(), &mut text).unwrap();
    check(&text, b"0123456789.,-+eE nNaA\n\r\t", |bytes| read_ascii_grid_bytes(&bytes));
}

#[test]
fn mutated_xyz_grids_never_panic() {
    let mut text = "x_m,y_m,z_m\n".to_owned();
    let dem = small();
    for row in 0..dem.rows() {
        for col in 0..dem.cols() {
            let at = dem.georeference().post(row, col);
            text += &format!("{},{},{}\n", at.x, at.y, dem.elevation(row, col).unwrap());
        }
    }
    check(text.as_bytes(), b"0123456789.,;-+eE naN\n\r\t", |bytes| read_xyz_bytes(&bytes));
}

#[test]
fn mutated_xyz_grids_in_other_notations_never_panic() {
    let mut text = "// X [m];Y [m];Z [m];class\r".to_owned();
    for post in 0..40_u32 {
        text += &format!("{},50;{},0;{},25;a b\r", post % 8, post / 8, post * 7 % 11);
    }
    check(text.as_bytes(), b"0123456789.,;'-+eE naN\n\r\t#/[]m", |bytes| read_xyz_bytes(&bytes));
}

#[test]
fn mutated_pds3_images_never_panic() {
    let mut label = "PDS_VERSION_ID = PDS3\nRECORD_BYTES = 1\n^IMAGE = 701 <BYTES>\nOBJECT = IMAGE\nLINES = 3\nLINE_SAMPLES = 4\n\
                     SAMPLE_TYPE = LSB_INTEGER\nSAMPLE_BITS = 16\nMISSING_CONSTANT = (-1, 16#8000#)\nVALID_MINIMUM = 0\nSCALING_FACTOR = 0.5 /* half */\nEND_OBJECT\n\
                     OBJECT = IMAGE_MAP_PROJECTION\nMAP_PROJECTION_TYPE = \"SINUSOIDAL\"\nA_AXIS_RADIUS = 1737.4 <KM>\nC_AXIS_RADIUS = 1737.4\n\
                     CENTER_LONGITUDE = 5\nMAP_SCALE = 10 <M/PIXEL>\nLINE_PROJECTION_OFFSET = 5.5\nSAMPLE_PROJECTION_OFFSET = -7\nEND_OBJECT\nEND\n"
        .to_owned()
        .into_bytes();
    assert!(label.len() <= 700);
    label.resize(700, b' ');
    label.extend([1_i16, 2, -1, 4, 5, 6, 7, 8, 9, 10, 11, 12].iter().flat_map(|sample| sample.to_le_bytes()));
    check(&label, b"0123456789.,=<>(){}#\"/*-\n ", read_pds3_bytes);
}

#[test]
fn the_plain_geotiff_of_these_tests_has_its_elevations() {
    let dem = read_geotiff_bytes(int16_tiff(&[])).unwrap();
    assert_eq!((dem.rows(), dem.cols(), dem.elevation(0, 0), dem.elevation(2, 3)), (3, 4, Some(0.5), None));
    assert_eq!(dem.georeference().north_west(), MapPoint::new(1001.0, 1999.0));
}
