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
        crater_diameter_min_m,
        crater_diameter_max_m,
        crater_density_per_km2,
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
            diameter_min_m: *crater_diameter_min_m,
            diameter_max_m: *crater_diameter_max_m,
            density_per_km2: *crater_density_per_km2,
            power_law_exponent: *crater_power_law_exponent,
            depth_law: match crater_depth_law {
                DepthLawArg::Moon => DepthLaw::Moon,
                DepthLawArg::Mars => DepthLaw::Mars,
            },
            degradation_max: *crater_degradation_max,
        }),
        rille: rille.then_some(Rille {
            width_m: *rille_width_m,
            depth_m: *rille_depth_m,
            wall_slope: Angle::from_degrees(*rille_wall_slope_deg),
            meander_amplitude_m: *rille_meander_amplitude_m,
            meander_length_m: *rille_meander_length_m,
        }),
        boulders: boulders.then_some(Boulders {
            rock_abundance: *rock_abundance,
            diameter_min_m: *boulder_diameter_min_m,
            diameter_max_m: *boulder_diameter_max_m,
            burial: *boulder_burial,
        }),
    }
}
