//! `chta slice`: terrain along a vertical plane as a chain.

use chta::{
    chain::csv::write_chain_csv,
    report::slice_geojson,
    study::{DemReading, Overlays, friction, slice},
    terrain::MapPlace,
};

use crate::cli::{
    Answer, Failure,
    args::{SliceArgs, place},
    claims, inputs,
    load::scenario_alone,
    output,
    wrong_thing::Role,
};

/// Slices a DEM or a mesh.
pub(crate) fn run(args: &SliceArgs) -> Result<Answer, Failure> {
    let SliceArgs { terrain, scenario, output: file, geojson, input_max_gib, quiet, .. } = args;
    inputs::look_at(*input_max_gib, &[(Some(terrain), Role::Terrain), (scenario.as_deref(), Role::ScenarioOption)])?;
    let terrain = inputs::open(terrain, Role::Terrain)?.file;
    let given = scenario.as_deref().map(scenario_alone).transpose()?;
    if let (Some(path), Some((scenario, _))) = (scenario, &given)
        && friction(scenario).is_none()
        && Overlays::files(scenario).next().is_none()
    {
        let name = path.display();
        let reason = "has no friction_coefficient, so the chain gets no friction: give the scenario again when the chain is used";
        output::warn(*quiet, &format!("--scenario {name} {reason}"));
    }
    let mut reading = given.as_ref().map_or_else(DemReading::default, |(scenario, _)| DemReading::of(scenario));
    reading.accept_map_scale |= args.accept_map_scale;
    if let Some(no_data) = args.no_data {
        reading.options = reading.options.no_data(no_data);
    }
    let (metres, degrees) = (args.via.iter().copied(), args.via_lonlat.iter().copied());
    let question = slice::SliceQuestion {
        terrain: &terrain,
        from: place("from", args.from, args.from_lonlat)?,
        to: place("to", args.to, args.to_lonlat)?,
        via: metres.map(MapPlace::Metres).chain(degrees.map(MapPlace::LonLat)).collect(),
        mesh_scale: args.mesh_scale,
        reading,
        scenario: given.as_ref().map(|(scenario, base)| (scenario, base.as_path())),
    };
    let study = slice::slice(&question).map_err(|error| Failure::about(&terrain, &error))?;
    claims::reads(&terrain);
    output::warned(*quiet, &[&study.warnings]);
    let mut csv = Vec::new();
    write_chain_csv(&study.chain, &mut csv, &study.comments).map_err(|e| Failure::about(&terrain, &e))?;
    if let Some(file) = geojson {
        let name = terrain.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let line = slice_geojson(&study.legs, &name, study.projection.as_ref());
        output::to_geojson_file(file, &line, study.projection.as_ref())?;
    }
    output::to_file_or_stdout(file.as_deref(), &csv)?;
    Ok(Answer::Yes)
}
