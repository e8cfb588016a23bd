//! `chta slice`: terrain along a vertical plane as a chain.

use std::path::{Path, PathBuf};

use chta::{
    chain::{PolygonalChain, csv::write_chain_csv},
    quantity::MapPoint,
    report::{CrsRecord, slice_geojson},
    scenario::{BodyChoice, Scenario},
    study::{DemReading, Overlays, Transect, friction, on_body, sha256_of},
    terrain::{LonLat, MapPlace, Profile, TerrainError, looks_like_mesh},
};

use crate::cli::{
    Answer, Failure,
    args::SliceArgs,
    claims,
    inputs::{self, Input},
    load::scenario_alone,
    output,
    wrong_thing::Role,
};

/// Slices a DEM or a mesh.
pub(crate) fn run(args: &SliceArgs) -> Result<Answer, Failure> {
    let SliceArgs { terrain, via, via_lonlat, scenario, output: file, geojson, input_max_gib, quiet, .. } = args;
    inputs::look_at(*input_max_gib, &[(Some(terrain), Role::Terrain), (scenario.as_deref(), Role::ScenarioOption)])?;
    let terrain = &inputs::open(terrain, Role::Terrain)?;
    let given = scenario.as_deref().map(scenario_alone).transpose()?;
    if let (Some(path), Some((scenario, _))) = (scenario, &given)
        && lays_nothing(scenario)
    {
        let name = path.display();
        let reason = "has no friction_coefficient, so the chain gets no friction: give the scenario again when the chain is used";
        output::warn(*quiet, &format!("--scenario {name} {reason}"));
    }
    let failed = |error: &(dyn std::error::Error + 'static)| Failure::about(&terrain.file, error);
    let mut reading = given.as_ref().map_or_else(DemReading::default, |(scenario, _)| DemReading::of(scenario));
    reading.accept_map_scale |= args.accept_map_scale;
    if let Some(no_data) = args.no_data {
        reading.options = reading.options.no_data(no_data);
    }
    let body = given.as_ref().map(|(scenario, _)| &scenario.body);
    let (transect, of_extent) = read_transect(args, terrain, reading, body)?;
    let terrain = terrain.file.as_path();
    claims::reads(terrain);
    for warning in transect.warnings.iter().chain(&of_extent) {
        output::warn(*quiet, warning);
    }
    let name = name_of(terrain);
    let mut comments = vec![format!("chta {} slice of {name}, sha256 {}", env!("CARGO_PKG_VERSION"), sha256_of(terrain)?)];
    comments.push(format!("of {}", transect.size));
    comments.extend(ends(&transect.legs));
    comments.extend(via.iter().map(|point| format!("via ({}, {}) m", point.x, point.y)));
    comments.extend(via_lonlat.iter().map(|place| format!("via longitude {}, latitude {} deg", place.lon_deg, place.lat_deg)));
    comments.extend(map_comments(&transect));
    let line = geojson.as_deref().map(|file| (file, slice_geojson(&transect.legs, &name, transect.projection.as_ref())));
    let chain = match &given {
        Some((scenario, base)) => {
            for file in Overlays::files(scenario).map(|file| base.join(file)).collect::<Vec<PathBuf>>() {
                comments.push(format!("under {}, sha256 {}", name_of(&file), sha256_of(&file)?));
            }
            let overlays =
                Overlays::read(scenario, base, transect.coordinates.as_ref(), transect.extent.bounds).map_err(|e| failed(&e))?;
            let (chain, without_effect) = overlays.chain_with_warnings(transect.legs).map_err(|e| failed(&e))?;
            for warning in &without_effect {
                output::warn(*quiet, warning);
            }
            comments.extend(without_effect.iter().map(|warning| format!("warning: {warning}")));
            chain
        }
        None => PolygonalChain::from_legs(&transect.legs, None).map_err(|e| failed(&e))?,
    };
    let mut csv = Vec::new();
    write_chain_csv(&chain, &mut csv, &comments).map_err(|e| failed(&e))?;
    if let Some((file, line)) = line {
        output::to_geojson_file(file, &line, transect.projection.as_ref())?;
    }
    output::to_file_or_stdout(file.as_deref(), &csv)?;
    Ok(Answer::Yes)
}

/// Whether a scenario has nothing to add to a chain.
fn lays_nothing(scenario: &Scenario) -> bool {
    friction(scenario).is_none() && Overlays::files(scenario).next().is_none()
}

/// A file's own name, for a comment.
fn name_of(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The ground along the slice, with the warnings about it, and one about its extent on the body.
fn read_transect(
    args: &SliceArgs,
    input: &Input,
    reading: DemReading,
    body: Option<&BodyChoice>,
) -> Result<(Transect, Option<String>), Failure> {
    let SliceArgs { via, via_lonlat, mesh_scale, .. } = args;
    let terrain = input.file.as_path();
    let from = place("from", args.from, args.from_lonlat)?;
    let to = place("to", args.to, args.to_lonlat)?;
    let checked = |read: Result<Transect, TerrainError>| match body {
        Some(body) => on_body(body, read).map_err(|error| Failure::about(terrain, &error)),
        None => read.map(|transect| (transect, None)).map_err(|error| Failure::about(terrain, &error)),
    };
    let of_mesh = || match (&from, &to) {
        (MapPlace::Metres(from), MapPlace::Metres(to)) if via_lonlat.is_empty() => {
            let units = (mesh_scale.unwrap_or(1.0), reading.options.no_data_rule());
            checked(Transect::of_mesh(terrain, units, [*from, *to], via))
        }
        _ => Err(Failure::message(
            "--from-lonlat, --to-lonlat, --via-lonlat: a mesh has no projection; give --from X,Y, --to X,Y and --via X,Y",
        )),
    };
    if looks_like_mesh(terrain) {
        return of_mesh();
    }
    let between: Vec<MapPlace> =
        via.iter().copied().map(MapPlace::Metres).chain(via_lonlat.iter().copied().map(MapPlace::LonLat)).collect();
    let transect = match Transect::of_dem(terrain, [&from, &to], &between, reading) {
        // A damaged mesh is reported by the mesh readers, which know the reason.
        Err(_) if named_as_mesh(terrain) => return of_mesh(),
        transect => checked(transect)?,
    };
    if let Some(scale) = mesh_scale {
        let name = terrain.display();
        return Err(Failure::message(format!(
            "--mesh-scale {scale}: {name} is an elevation raster, expected a mesh; omit the option"
        )));
    }
    Ok(transect)
}

/// Whether a file's extension is that of a mesh.
fn named_as_mesh(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["obj", "stl", "ply"].iter().any(|mesh| extension.eq_ignore_ascii_case(mesh))
}

/// A position given in one of the two forms; the command line requires one.
pub(super) fn place(which: &str, point: Option<MapPoint>, place: Option<LonLat>) -> Result<MapPlace, Failure> {
    let missing = || Failure::message(format!("found no --{which}, expected --{which} X,Y or --{which}-lonlat LON,LAT"));
    point.map(MapPlace::Metres).or(place.map(MapPlace::LonLat)).ok_or_else(missing)
}

/// The ends of a slice, for its comments.
fn ends(legs: &[Profile]) -> Option<String> {
    let (from, to) = (legs.first()?.points.first()?.map, legs.last()?.points.last()?.map);
    Some(format!("from ({}, {}) m to ({}, {}) m on the map", from.x, from.y, to.x, to.y))
}

/// The reference system of a slice's map and the warnings about it, for its comments.
fn map_comments(transect: &Transect) -> Vec<String> {
    let crs = transect.projection.as_ref().map(|projection| CrsRecord::from(projection).comments()).unwrap_or_default();
    crs.into_iter().chain(transect.warnings.iter().map(|warning| format!("warning: {warning}"))).collect()
}
