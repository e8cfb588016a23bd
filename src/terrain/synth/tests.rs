//! Whole synthetic terrains.

use super::*;

fn everything() -> SyntheticTerrain {
    SyntheticTerrain {
        rows: 96,
        cols: 128,
        spacing_m: 1.0,
        tilt: Angle::from_degrees(5.0),
        tilt_towards: Angle::from_degrees(90.0),
        rille: Some(Rille { width_m: 20.0, depth_m: 3.0, ..Rille::default() }),
        boulders: Some(Boulders { diameter_min_m: 1.0, ..Boulders::default() }),
        ..SyntheticTerrain::default()
    }
}

/// FNV-1a hash of the elevations' bits.
fn fingerprint(dem: &Dem) -> u64 {
    dem.elevations()
        .flatten()
        .flat_map(|z_m| z_m.to_bits().to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_others() {
    let first = synthesise(&everything()).unwrap();
    assert_eq!(first, synthesise(&everything()).unwrap());
    let other = synthesise(&SyntheticTerrain { seed: 2, ..everything() }).unwrap();
    assert_ne!(first, other);
    assert!(first.is_single_precision());
    // Frozen: the shipped data were generated with this code, so a change must be intended.
    assert_eq!(fingerprint(&first), FROZEN, "{:#x}", fingerprint(&first));
}

const FROZEN: u64 = 0x52a2_c242_fbca_621e;

#[test]
fn a_bare_plane_rises_in_the_given_direction() {
    let plane =
        SyntheticTerrain { ground: None, craters: None, rille: None, boulders: None, mean_elevation_m: 100.0, ..everything() };
    let dem = synthesise(&plane).unwrap();
    let rise = dem.elevation(0, 127).unwrap() - dem.elevation(0, 0).unwrap();
    assert!((rise - 127.0 * 5.0_f64.to_radians().tan()).abs() < 1e-4, "{rise}");
    assert_eq!(dem.elevation(0, 64), dem.elevation(95, 64));
    assert_eq!(dem.georeference().north_west(), MapPoint::new(0.0, 95.0));
    let northward = synthesise(&SyntheticTerrain { tilt_towards: Angle::from_degrees(0.0), ..plane }).unwrap();
    assert!(northward.elevation(0, 5) > northward.elevation(95, 5));
}

#[test]
fn layers_do_not_disturb_each_other() {
    let bare = SyntheticTerrain { craters: None, boulders: None, rille: None, ..everything() };
    let with_rille = SyntheticTerrain { rille: everything().rille, ..bare.clone() };
    let (bare, cut) = (synthesise(&bare).unwrap(), synthesise(&with_rille).unwrap());
    let differences: Vec<f64> = bare.elevations().flatten().zip(cut.elevations().flatten()).map(|(a, b)| a - b).collect();
    assert!(differences.iter().all(|difference| *difference > -1e-5 && *difference < 3.0 + 1e-5));
    assert!(
        differences.iter().any(|difference| *difference > 2.99) && differences.iter().any(|difference| difference.abs() < 1e-6)
    );
}

#[test]
fn options_out_of_range_are_refused_by_name_and_value() {
    let base = SyntheticTerrain::default();
    let ground = |hurst_exponent| Some(FractalGround { hurst_exponent, ..FractalGround::default() });
    let craters = |change: fn(&mut Craters)| {
        let mut craters = Craters::default();
        change(&mut craters);
        Some(craters)
    };
    let cases = [
        (SyntheticTerrain { rows: 1, ..base.clone() }, "rows is 1"),
        (SyntheticTerrain { cols: usize::MAX, ..base.clone() }, "expected 2 to 6553"),
        (SyntheticTerrain { spacing_m: 0.0, ..base.clone() }, "spacing_m is 0"),
        (SyntheticTerrain { spacing_m: f64::NAN, ..base.clone() }, "spacing_m is NaN"),
        (SyntheticTerrain { tilt: Angle::from_degrees(89.0), ..base.clone() }, "tilt is 89"),
        (SyntheticTerrain { ground: ground(1.5), ..base.clone() }, "hurst_exponent is 1.5"),
        (SyntheticTerrain { craters: craters(|craters| craters.diameter_min_m = 0.1), ..base.clone() }, "diameter_min_m is 0.1"),
        (SyntheticTerrain { craters: craters(|craters| craters.diameter_max_m = 1.0), ..base.clone() }, "diameter_max_m is 1"),
        (SyntheticTerrain { craters: craters(|craters| craters.density_per_km2 = 1e13), ..base.clone() }, "density_per_km2"),
        (SyntheticTerrain { boulders: Some(Boulders { burial: -1.0, ..Boulders::default() }), ..base.clone() }, "burial is -1"),
        (SyntheticTerrain { rille: Some(Rille { width_m: f64::INFINITY, ..Rille::default() }), ..base }, "width_m is inf"),
    ];
    for (terrain, expected) in cases {
        let message = synthesise(&terrain).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}
