//! `chta synth`: synthetic terrain from a seed.

use chta::terrain::{
    Boulders, MeshFormatWritten, SyntheticTerrain, geotiff_bytes, mesh_bytes, synthesise, synthesise_mesh, write_ascii_grid,
};

use crate::cli::{
    Answer, Failure,
    args::{MeshArg, SynthArgs},
    output,
};

/// Generates terrain and writes it.
pub(crate) fn run(args: &SynthArgs) -> Result<Answer, Failure> {
    if let Some(mesh) = args.mesh {
        return write_mesh(args, mesh);
    }
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
    let dem = synthesise(&SyntheticTerrain::from(args)).map_err(failed)?;
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

/// Generates a mesh and writes it.
fn write_mesh(args: &SynthArgs, mesh: MeshArg) -> Result<Answer, Failure> {
    let expected = || format!("-o {}: found no known extension, expected .obj, .stl or .ply for a mesh", args.output.display());
    let format = MeshFormatWritten::of_path(&args.output).ok_or_else(|| Failure::message(expected()))?;
    let mesh = synthesise_mesh(mesh.scene(), args.seed).map_err(|error| Failure::of(&error))?;
    output::to_file(&args.output, &mesh_bytes(&mesh, format))?;
    Ok(Answer::Yes)
}
