//! `chta synth`: synthetic terrain from a seed.

use chta::{
    quantity::Angle,
    terrain::{Boulders, Craters, DepthLaw, FractalGround, Rille, SyntheticTerrain, geotiff_bytes, synthesise, write_ascii_grid},
};

use crate::cli::{
    Answer, Failure,
    args::{DepthLawArg, SynthArgs},
    output,
};

/// Generates terrain and writes it.
pub(crate) fn run(args: &SynthArgs) -> Result<Answer, Failure> {
    let ascii = match args.output.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase()).as_deref() {
        Some("tif" | "tiff") => false,
        Some("asc") => true,
        _ => {
            let path = args.output.display();
            return Err(Failure::message(format!(
                "-o {path}: found no known extension, expected .tif (GeoTIFF) or .asc (ESRI ASCII grid)"
            )));
        }
    };
    let usual = Boulders::default();
    if args.boulders
        && args.boulder_diameter_min_m.or(args.boulder_diameter_max_m).is_none()
        && args.spacing_m > usual.diameter_max_m
    {
        return Err(Failure::message(format!(
            "--boulders: found a post spacing of {} m, expected at most {} m, the size of the largest boulder unless another is said: give \
             --spacing-m, or --boulder-diameter-min-m and --boulder-diameter-max-m",
            args.spacing_m, usual.diameter_max_m
        )));
    }
    let failed = |error: chta::terrain::TerrainError| Failure::of(&error);
    let dem = synthesise(&options(args)).map_err(failed)?;
    let bytes = if ascii {
        let mut text = Vec::new();
        write_ascii_grid(&dem, &mut text).map_err(failed)?;
        text
    } else {
        geotiff_bytes(&dem).map_err(failed)?
    };
    output::to_file(&args.output, &bytes)?;
    Ok(Answer::Yes)
}

/// The options as typed, all of them.
fn options(args: &SynthArgs) -> SyntheticTerrain {
    let SynthArgs {
        output: _,
        seed,
        rows,
        cols,
        spacing_m,
        south_west_m,
        mean_elevation_m,
        tilt_deg,
        tilt_towards_deg,
        no_ground,
        ground_hurst,
        ground_rms_m,
        ground_baseline_m,
        craters,
        crater_diameter_min_m: _,
        crater_diameter_max_m: _,
        crater_density_per_km2: _,
        crater_power_law_exponent,
        crater_depth_law,
        crater_degradation_max,
        rille,
        rille_width_m,
        rille_depth_m,
        rille_wall_slope_deg,
        rille_meander_amplitude_m,
        rille_meander_length_m,
        boulders,
        rock_abundance,
        boulder_diameter_min_m,
        boulder_diameter_max_m,
        boulder_burial,
    } = args;
    let crater_defaults = typed_craters(args);
    let boulder_diameters_m = typed_boulder_diameters_m(*spacing_m, *boulder_diameter_min_m, *boulder_diameter_max_m);
    SyntheticTerrain {
        rows: *rows,
        cols: *cols,
        spacing_m: *spacing_m,
        south_west: *south_west_m,
        mean_elevation_m: *mean_elevation_m,
        tilt: Angle::from_degrees(*tilt_deg),
        tilt_towards: Angle::from_degrees(*tilt_towards_deg),
        seed: *seed,
        ground: (!no_ground).then_some(FractalGround {
            hurst_exponent: *ground_hurst,
            rms_deviation_m: *ground_rms_m,
            baseline_m: *ground_baseline_m,
        }),
        craters: craters.then_some(Craters {
            diameter_min_m: crater_defaults.diameter_min_m,
            diameter_max_m: crater_defaults.diameter_max_m,
            density_per_km2: crater_defaults.density_per_km2,
            power_law_exponent: *crater_power_law_exponent,
            depth_law: match crater_depth_law {
                DepthLawArg::Moon => DepthLaw::Moon,
                DepthLawArg::Mars => DepthLaw::Mars,
            },
            degradation_max: *crater_degradation_max,
        }),
        rille: rille.then_some(Rille {
            width_m: rille_width_m.unwrap_or_else(|| Rille::default().width_m.max(*spacing_m)),
            depth_m: *rille_depth_m,
            wall_slope: Angle::from_degrees(*rille_wall_slope_deg),
            meander_amplitude_m: *rille_meander_amplitude_m,
            meander_length_m: *rille_meander_length_m,
        }),
        boulders: boulders.then_some(Boulders {
            rock_abundance: *rock_abundance,
            diameter_min_m: boulder_diameters_m[0],
            diameter_max_m: boulder_diameters_m[1],
            burial: *boulder_burial,
        }),
    }
}

/// Diameters and density of the craters: those typed, and defaults that fit them, the post spacing and the map, so that no default is
/// refused. A greater smallest diameter is that of the same population, by its power law.
fn typed_craters(args: &SynthArgs) -> Craters {
    let usual = Craters::default();
    let longest_side = args.rows.max(args.cols).saturating_sub(1);
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    let side_m = longest_side as f64 * args.spacing_m;
    let most_m = args.crater_diameter_max_m.unwrap_or(f64::INFINITY);
    let least_m = usual.diameter_min_m.max(args.spacing_m);
    let diameter_min_m = args.crater_diameter_min_m.unwrap_or_else(|| usual.diameter_min_m.min(most_m).max(args.spacing_m));
    let diameter_max_m = args.crater_diameter_max_m.unwrap_or_else(|| {
        let usual_span = usual.diameter_max_m / usual.diameter_min_m;
        usual.diameter_max_m.max(usual_span * diameter_min_m).min(10.0 * side_m).max(diameter_min_m)
    });
    let density_per_km2 = args.crater_density_per_km2.unwrap_or_else(|| {
        let raised = args.crater_diameter_min_m.is_none() && least_m > usual.diameter_min_m;
        let share = if raised { libm::pow(usual.diameter_min_m / least_m, args.crater_power_law_exponent) } else { 1.0 };
        usual.density_per_km2 * share
    });
    Craters { diameter_min_m, diameter_max_m, density_per_km2, ..usual }
}

/// Smallest and largest boulder, m: those typed, and defaults that fit them and the post spacing.
fn typed_boulder_diameters_m(spacing_m: f64, least_m: Option<f64>, most_m: Option<f64>) -> [f64; 2] {
    let usual = Boulders::default();
    let min_m = least_m.unwrap_or_else(|| usual.diameter_min_m.min(most_m.unwrap_or(f64::INFINITY)).max(spacing_m));
    [min_m, most_m.unwrap_or_else(|| usual.diameter_max_m.max(min_m))]
}
