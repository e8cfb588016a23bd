//! `chta slice`: terrain along a vertical plane as a chain.

use std::path::Path;

use chta::{
    chain::{PolygonalChain, csv::write_chain_csv},
    scenario::{friction, sha256_of},
    terrain::{Profile, TerrainError, looks_like_mesh, read_mesh, slice_file, slice_mesh},
};

use crate::cli::{Answer, Failure, args::SliceArgs, load::scenario_alone, output};

/// Slices a DEM or a mesh.
pub(crate) fn run(args: &SliceArgs) -> Result<Answer, Failure> {
    let SliceArgs { terrain, from, to, mesh_scale: _, scenario, output: file, quiet } = args;
    let given = scenario.as_deref().map(scenario_alone).transpose()?;
    let friction = given.as_ref().and_then(friction);
    if let (Some(path), None) = (scenario, friction) {
        let name = path.display();
        let reason = "has no friction_coefficient, so none goes into the chain: give the scenario again where the chain is used";
        output::warn(*quiet, &format!("--scenario {name} {reason}"));
    }
    let failed = |error: &dyn std::error::Error| Failure::about(terrain, &error.to_string());
    let (profile, warnings) = sliced(args)?;
    for warning in &warnings {
        output::warn(*quiet, warning);
    }
    let chain = PolygonalChain::from_profile(&profile, friction).map_err(|e| failed(&e))?;
    let name = terrain.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut comments = vec![
        format!("chta {} slice of {name}, sha256 {}", env!("CARGO_PKG_VERSION"), sha256_of(terrain)?),
        format!("from ({}, {}) m to ({}, {}) m on the map", from.x, from.y, to.x, to.y),
    ];
    comments.extend(warnings);
    let mut csv = Vec::new();
    write_chain_csv(&chain, &mut csv, &comments).map_err(|e| failed(&e))?;
    output::to_file_or_stdout(file.as_deref(), &csv)?;
    Ok(Answer::Yes)
}

/// The profile, and what its user should know.
fn sliced(args: &SliceArgs) -> Result<(Profile, Vec<String>), Failure> {
    let SliceArgs { terrain, from, to, mesh_scale, .. } = args;
    let failed = |error: TerrainError| Failure::about(terrain, &error.to_string());
    if looks_like_mesh(terrain) {
        return sliced_mesh(args).map_err(failed);
    }
    let profile = match slice_file(terrain, *from, *to) {
        // A damaged mesh is told by the readers of meshes, who know why.
        Err(_) if named_as_mesh(terrain) => return sliced_mesh(args).map_err(failed),
        sliced => sliced.map_err(failed)?,
    };
    if let Some(scale) = mesh_scale {
        let name = terrain.display();
        return Err(Failure::message(format!(
            "--mesh-scale {scale}: {name} is an elevation raster, expected a mesh; leave the option away"
        )));
    }
    Ok((profile, Vec::new()))
}

fn sliced_mesh(args: &SliceArgs) -> Result<(Profile, Vec<String>), TerrainError> {
    let file = read_mesh(&args.terrain, args.mesh_scale.unwrap_or(1.0))?;
    let slice = slice_mesh(&file.mesh, args.from, args.to)?;
    let warnings = [file.warnings, slice.warnings()].concat();
    Ok((slice.profile, warnings))
}

/// Whether a file's extension is that of a mesh.
fn named_as_mesh(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["obj", "stl", "ply"].iter().any(|mesh| extension.eq_ignore_ascii_case(mesh))
}
