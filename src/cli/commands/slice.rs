//! `chta slice`: terrain along a vertical plane as a chain.

use std::path::PathBuf;

use chta::{
    chain::{PolygonalChain, csv::write_chain_csv},
    scenario::{Covers, sha256_of},
    terrain::{read_dem, slice_legs},
};

use crate::cli::{Answer, Failure, args::SliceArgs, load::scenario_alone, output};

/// Slices a DEM.
pub(crate) fn run(args: &SliceArgs) -> Result<Answer, Failure> {
    let SliceArgs { dem, from, to, via, scenario, output: file } = args;
    let failed = |error: &dyn std::error::Error| Failure::message(error.to_string());
    let terrain = read_dem(dem).map_err(|e| failed(&e))?;
    let legs = slice_legs(&terrain, *from, via, *to).map_err(|e| failed(&e))?;
    let (chain, covers) = match scenario.as_deref().map(scenario_alone).transpose()? {
        Some((scenario, base)) => {
            let read = Covers::read(&scenario, &base, Some(&terrain.georeference().coordinate_system), terrain.bounds());
            let files: Vec<PathBuf> = Covers::files(&scenario).map(|file| base.join(file)).collect();
            (read.map_err(|e| failed(&e))?.chain(legs)?, files)
        }
        None => (PolygonalChain::from_legs(&legs, None).map_err(|e| failed(&e))?, Vec::new()),
    };
    let name = dem.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut comments = vec![
        format!("chta {} slice of {name}, sha256 {}", env!("CARGO_PKG_VERSION"), sha256_of(dem)?),
        format!("from ({}, {}) m to ({}, {}) m on the map", from.x, from.y, to.x, to.y),
    ];
    for point in via {
        comments.push(format!("via ({}, {}) m", point.x, point.y));
    }
    for file in covers {
        let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        comments.push(format!("under {name}, sha256 {}", sha256_of(&file)?));
    }
    let mut csv = Vec::new();
    write_chain_csv(&chain, &mut csv, &comments).map_err(|e| failed(&e))?;
    output::to_file_or_stdout(file.as_deref(), &csv)?;
    Ok(Answer::Yes)
}
