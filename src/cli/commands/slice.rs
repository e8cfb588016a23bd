//! `chta slice`: terrain along a vertical plane as a chain.

use chta::{
    chain::{PolygonalChain, csv::write_chain_csv},
    scenario::{friction, sha256_of},
    terrain::slice_file,
};

use crate::cli::{Answer, Failure, args::SliceArgs, load::scenario_alone, output};

/// Slices a DEM.
pub(crate) fn run(args: &SliceArgs) -> Result<Answer, Failure> {
    let SliceArgs { dem, from, to, scenario, output: file } = args;
    let friction = scenario.as_deref().map(scenario_alone).transpose()?.as_ref().and_then(friction);
    let failed = |error: &dyn std::error::Error| Failure::message(error.to_string());
    let profile = slice_file(dem, *from, *to).map_err(|e| failed(&e))?;
    let chain = PolygonalChain::from_profile(&profile, friction).map_err(|e| failed(&e))?;
    let name = dem.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let comments = [
        format!("chta {} slice of {name}, sha256 {}", env!("CARGO_PKG_VERSION"), sha256_of(dem)?),
        format!("from ({}, {}) m to ({}, {}) m on the map", from.x, from.y, to.x, to.y),
    ];
    let mut csv = Vec::new();
    write_chain_csv(&chain, &mut csv, &comments).map_err(|e| failed(&e))?;
    output::to_file_or_stdout(file.as_deref(), &csv)?;
    Ok(Answer::Yes)
}
