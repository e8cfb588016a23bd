//! `chta slice`: terrain along a vertical plane as a chain.

use chta::{
    chain::{PolygonalChain, csv::write_chain_csv},
    quantity::MapPoint,
    report::{CrsRecord, slice_geojson},
    scenario::{Cut, cut, friction, sha256_of},
    terrain::{LonLat, MapPlace, Profile, read_dem},
};

use crate::cli::{Answer, Failure, args::SliceArgs, load::scenario_alone, output};

/// Slices a DEM.
pub(crate) fn run(args: &SliceArgs) -> Result<Answer, Failure> {
    let scenario = args.scenario.as_deref().map(scenario_alone).transpose()?;
    let accepted = args.accept_map_scale || scenario.as_ref().is_some_and(|scenario| scenario.accept_map_scale);
    let from = place("from", args.from, args.from_lonlat)?;
    let to = place("to", args.to, args.to_lonlat)?;
    let failed = |error: &dyn std::error::Error| Failure::message(error.to_string());
    let dem = read_dem(&args.dem).map_err(|e| failed(&e))?;
    let cut = cut(&dem, [&from, &to], accepted, &args.dem).map_err(|e| failed(&e))?;
    for warning in &cut.warnings {
        output::warn(false, warning);
    }
    let chain = PolygonalChain::from_profile(&cut.profile, scenario.as_ref().and_then(friction)).map_err(|e| failed(&e))?;
    let name = args.dem.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut comments = vec![format!("chta {} slice of {name}, sha256 {}", env!("CARGO_PKG_VERSION"), sha256_of(&args.dem)?)];
    comments.extend(ends(&cut.profile));
    comments.extend(map_comments(&cut));
    let mut csv = Vec::new();
    write_chain_csv(&chain, &mut csv, &comments).map_err(|e| failed(&e))?;
    if let Some(file) = &args.geojson {
        let projection = cut.projection.as_ref();
        output::to_geojson_file(file, &slice_geojson(&cut.profile, &name, projection), projection)?;
    }
    output::to_file_or_stdout(args.output.as_deref(), &csv)?;
    Ok(Answer::Yes)
}

/// One of the two ways to say a place; the command line asks for one.
fn place(which: &str, point: Option<MapPoint>, place: Option<LonLat>) -> Result<MapPlace, Failure> {
    let missing = || Failure::message(format!("found no --{which}, expected --{which} X,Y or --{which}-lonlat LON,LAT"));
    point.map(MapPlace::Metres).or(place.map(MapPlace::LonLat)).ok_or_else(missing)
}

/// Where a slice begins and ends, for its comments.
fn ends(profile: &Profile) -> Option<String> {
    let (from, to) = (profile.points.first()?.map, profile.points.last()?.map);
    Some(format!("from ({}, {}) m to ({}, {}) m on the map", from.x, from.y, to.x, to.y))
}

/// The reference system of a slice's map and the doubts about it, for its comments.
fn map_comments(cut: &Cut) -> Vec<String> {
    let crs = cut.projection.as_ref().map(|projection| CrsRecord::from(projection).comments()).unwrap_or_default();
    crs.into_iter().chain(cut.warnings.iter().map(|warning| format!("warning: {warning}"))).collect()
}
