//! `chta map`: fewest hops from one post of a DEM to every other.

use std::path::Path;

use chta::{
    figure::{Caption, GoalMark, HopMapFigure, MapPosts, draw_hop_map},
    graph::Effort,
    ground::DemGround,
    path::{Execution, HopPath},
    progress::{Detail, Step},
    quantity::MapPoint,
    reach::map::{
        HopMap, Journey, MapError, MapHop, Mobility, NO_GROUND, NodeLattice, Post, PostHops, Search, joined, mobility, path_hops,
        search, verify,
    },
    report::{
        Document, DocumentKind, GoalRecord, HopRecord, InputFile, MapAnswer, MapKnowledge, MapSummary, PropellantShortage,
        SimulationRecord, TotalsRecord, paths_geojson, write_paths_csv,
    },
    scenario::{Scenario, UncertaintyKeys},
    study::{Extremes, Overlays, TrialGround, coarse_dem_warning, constant_gravity_warnings, dem_on_body},
    terrain::{Band, Dem, KeepOut, MapPlace, MapProjection, NoProjection, ResultBands, check_map_scale, result_geotiff_bytes},
    uncertainty::{Mission, Policy, Simulation, SimulationError},
    world::FrictionCone,
};

use super::{captions::conditions, map_profiles, plan::passed, search::use_threads, slice::place};
use crate::cli::{
    Answer, Failure,
    args::{Format, MapArgs, SearchArgs},
    effects::Purpose,
    inputs,
    load::{Bare, load_bare, raster_files},
    output::{self, Pending},
    progress::Progress,
    wrong_thing::Role,
};

/// The terrain of a map, its projection and the scenario.
struct PreparedMap {
    ground: DemGround,
    projection: Result<MapProjection, NoProjection>,
    scenario: Scenario,
    lattice: NodeLattice,
    document: serde_json::Value,
    input_files: Vec<InputFile>,
    warnings: Vec<String>,
}

impl PreparedMap {
    fn dem(&self) -> &Dem {
        self.ground.terrain().dem()
    }
}

/// A requested position and the post nearest to it.
#[derive(Clone, Copy)]
struct Spot {
    asked: MapPoint,
    post: Post,
    at: MapPoint,
}

/// All requested maps.
struct Maps {
    out: HopMap,
    back: Option<HopMap>,
    mobility: Option<Mobility>,
    /// The path to each goal; `None` if unreachable.
    goal_hops: Vec<Option<Vec<MapHop>>>,
    paths: Vec<Option<HopPath>>,
    /// The trials for each goal; `None` if unreachable or not requested.
    trials: Vec<Option<SimulationRecord>>,
    /// Warnings about the start and the goals.
    warnings: Vec<String>,
}

/// Computes and writes the map.
pub(crate) fn run(args: &MapArgs) -> Result<Answer, Failure> {
    let MapArgs { dem, common, .. } = args;
    inputs::look_at(common.input_max_gib, &[(Some(dem), Role::Dem), (common.scenario.as_deref(), Role::ScenarioOption)])?;
    use_threads(args.answer.threads)?;
    let (inputs, start, goals) = prepared(args)?;
    check_extensions(args)?;
    let opened_files = outputs(args).map(Pending::begin).collect::<Result<_, _>>()?;
    let keys = args.simulate.then(|| trial_keys(&inputs.scenario)).transpose()?;
    let mut maps = mapped(args, &inputs, start, &goals)?;
    if let Some(keys) = &keys {
        maps.trials = simulated(args, &inputs, &maps, keys)?;
        let unreached = maps.paths.iter().zip(&goals).filter(|(path, _)| path.is_none());
        maps.warnings.extend(unreached.map(|(_, goal)| {
            format!(
                "no trials were flown to the goal ({:.3}, {:.3}) m: it is not reachable over these posts, so there is no path to fly",
                goal.at.x, goal.at.y
            )
        }));
    }
    let effort = args.effort.is_some().then_some(inputs.scenario.search.effort);
    let mut answer = MapAnswer::new(&MapSummary {
        dem: inputs.dem(),
        lattice: inputs.lattice,
        start: (start.asked, start.post),
        out: &maps.out,
        back: maps.back.as_ref(),
        mobility: maps.mobility.as_ref(),
        effort,
    });
    answer.goals = goals.iter().enumerate().map(|(index, goal)| goal_record(&inputs, &maps, goal, index)).collect();
    let mut warnings = inputs.warnings.clone();
    if keys.is_some() {
        warnings.extend(inputs.scenario.trial_warnings(&[Policy::OpenLoop], &trial_ground(&inputs, &maps)));
    }
    warnings.extend(maps.warnings.iter().cloned());
    let hops: Vec<_> = maps.paths.iter().flatten().flat_map(|path| path.hops.iter().copied()).collect();
    warnings.extend(constant_gravity_warnings(&inputs.scenario.body, Extremes::of(&hops)));
    for warning in &warnings {
        output::warn(args.common.quiet, warning);
    }
    write_files(opened_files, args, &inputs, &maps, &answer, (start, &goals))?;
    let text = match args.answer.format {
        Format::Text => answer.text(),
        Format::Json => {
            let document =
                Document::new(DocumentKind::Map, inputs.document.clone(), inputs.input_files.clone(), warnings, answer.clone());
            document.on_map(inputs.projection.as_ref().ok()).to_json()?
        }
    };
    output::to_stdout(text.as_bytes())?;
    Ok(if answer.reaches_all_goals() { Answer::Yes } else { Answer::No })
}

/// Reads terrain and scenario and finds the posts of start and goals.
fn prepared(args: &MapArgs) -> Result<(PreparedMap, Spot, Vec<Spot>), Failure> {
    let MapArgs { dem: file, start, start_lonlat, goal, goal_lonlat, stride, effort, common, .. } = args;
    if *stride == 0 {
        return Err(Failure::message("--stride: found 0, expected a whole number of at least 1"));
    }
    let searched = SearchArgs { points_per_segment: None, node_spacing_max_m: None, effort: effort.clone().flatten() };
    let has_goals = !(goal.is_empty() && goal_lonlat.is_empty());
    let purpose = Purpose::Map { goals: has_goals, effort: effort.is_some(), trials: args.simulate };
    let Bare { dem: file, scenario, base, document, mut warnings } = load_bare(file, common, &searched, purpose)?;
    let file = file.as_path();
    let failed = |error: &(dyn std::error::Error + 'static)| Failure::about(file, error);
    let (dem, of_dem) = dem_on_body(&scenario, file).map_err(|e| failed(&e))?;
    warnings.extend(of_dem);
    let overlays =
        Overlays::read(&scenario, &base, Some(&dem.georeference().coordinate_system), dem.bounds()).map_err(|e| failed(&e))?;
    let projection = dem.georeference().projection();
    let lattice = NodeLattice::new(&dem, *stride as usize);
    let nodes = dem.georeference().every(*stride as usize);
    let spot = |which: &'static str, place: MapPlace| -> Result<Spot, Failure> {
        let asked = place.on_map(which, projection.as_ref(), dem.bounds()).map_err(|e| failed(&e))?;
        if !dem.bounds().contains(asked) {
            let message = format!("--{which} ({:.3}, {:.3}) m lies off the map, which covers {}", asked.x, asked.y, dem.bounds());
            return Err(failed(&std::io::Error::other(message)));
        }
        let post = lattice.nearest(dem.georeference(), asked);
        Ok(Spot { asked, post, at: nodes.post(post.row, post.col) })
    };
    let start = spot("start", place("start", *start, *start_lonlat)?)?;
    let places = goal.iter().copied().map(MapPlace::Metres).chain(goal_lonlat.iter().copied().map(MapPlace::LonLat));
    let goals = places.map(|place| spot("goal", place)).collect::<Result<Vec<_>, _>>()?;
    for (which, spot) in named(start, &goals) {
        let Post { row, col } = lattice.post(spot.post);
        if dem.elevation(row, col).is_none() {
            let message = format!(
                "--{which}: the nearest post, ({:.3}, {:.3}) m, has no elevation; choose a {which} where the DEM has data",
                spot.at.x, spot.at.y
            );
            return Err(failed(&std::io::Error::other(message)));
        }
    }
    check_distinct_nodes(&dem, *stride, &named(start, &goals).map(|(_, spot)| spot).collect::<Vec<_>>())
        .map_err(|message| failed(&std::io::Error::other(message)))?;
    let accepted = common.accept_map_scale || scenario.accept_map_scale;
    warnings.extend(overlays.without_effect_on_dem(dem.bounds()));
    warnings.extend(coarse_dem_warning(&scenario.hopper, dem.georeference()));
    let scale = check_map_scale(&dem, projection.as_ref(), start.at, accepted, file).map_err(|e| failed(&e))?;
    warnings.extend(scale.warning());
    let ground = overlays.ground(dem, &scenario);
    let mut input_files = raster_files(file)?;
    for overlay in Overlays::files(&scenario) {
        input_files.extend(raster_files(&base.join(overlay))?);
    }
    Ok((PreparedMap { ground, projection, scenario, lattice, document, input_files, warnings }, start, goals))
}

/// Checks that positions at different posts map to different nodes: a stride that merges them would give one answer for both.
fn check_distinct_nodes(dem: &Dem, stride: u32, spots: &[Spot]) -> Result<(), String> {
    let every_post = NodeLattice::new(dem, 1);
    for (i, spot) in spots.iter().enumerate() {
        let post = |spot: &Spot| every_post.nearest(dem.georeference(), spot.asked);
        if let Some(other) = spots[..i].iter().find(|other| other.post == spot.post && post(other) != post(spot)) {
            return Err(format!(
                "with --stride {stride}, ({:.3}, {:.3}) m and ({:.3}, {:.3}) m have the same nearest post, ({:.3}, {:.3}) m: \
                 give a smaller --stride",
                other.asked.x, other.asked.y, spot.asked.x, spot.asked.y, spot.at.x, spot.at.y
            ));
        }
    }
    Ok(())
}

/// Start and goals, each with the name of its option.
fn named(start: Spot, goals: &[Spot]) -> impl Iterator<Item = (&'static str, Spot)> {
    std::iter::once(("start", start)).chain(goals.iter().map(|goal| ("goal", *goal)))
}

/// Warnings for start and goals at which no hop can take off or land.
fn refusals(hops: &PostHops, start: Spot, goals: &[Spot]) -> Vec<String> {
    named(start, goals)
        .filter_map(|(which, spot)| {
            let refusal = hops.refusal(spot.post)?;
            let nearest = hops.nearest_usable(spot.post).map_or_else(
                || "no post of the DEM is usable".to_owned(),
                |node| {
                    let post = hops.lattice().post(node);
                    let at = hops.ground().terrain().dem().georeference().post(post.row, post.col);
                    format!("the nearest usable one is ({:.3}, {:.3}) m", at.x, at.y)
                },
            );
            Some(format!(
                "the {which}'s post ({:.3}, {:.3}) m {refusal}: no hop begins or ends there; {nearest}",
                spot.at.x, spot.at.y
            ))
        })
        .collect()
}

/// Searches, with progress on the terminal.
fn mapped(args: &MapArgs, inputs: &PreparedMap, start: Spot, goals: &[Spot]) -> Result<Maps, Failure> {
    let PreparedMap { scenario, lattice, .. } = inputs;
    let failed = |error: &MapError| Failure::about(&args.dem, error);
    let progress = Progress::new(args.common.quiet);
    let search_started = std::time::Instant::now();
    // Run inside the rayon pool: work started by a pool thread is picked up faster than work submitted from outside.
    let maps = rayon::scope(|_| -> Result<(Maps, Vec<Option<Execution>>), MapError> {
        let hops = PostHops::new(inputs.ground.clone(), lattice.stride)?;
        let layers =
            |what: &'static str| progress.with_lines(move |step| format_layer(what, step, search_started.elapsed().as_secs_f64()));
        let effort = args.effort.as_ref().map(|_| (scenario.search.effort, scenario.search.takeoff));
        let out = search(&hops, start.post, Search { journey: Journey::Outbound, effort }, &layers("outbound"))?;
        let back =
            args.back.then(|| search(&hops, start.post, Search { journey: Journey::Return, effort: None }, &layers("return")));
        let mobility_started = std::time::Instant::now();
        let mobile = args.mobility.as_ref().map(|_| {
            mobility(&hops, &progress.with_lines(|step| format_share("mobility", step, mobility_started.elapsed().as_secs_f64())))
        });
        let hops_to = |goal: &Spot| {
            let nodes = out.path(&hops, goal.post);
            nodes.map(|nodes| path_hops(&hops, &nodes, scenario.search.takeoff)).transpose()
        };
        let goal_hops = goals.iter().map(hops_to).collect::<Result<Vec<_>, _>>()?;
        let paths: Vec<_> = goal_hops.iter().map(|found| found.as_ref().map(|found| joined(&hops, found))).collect();
        let checks = paths.iter().zip(goals).map(|(path, goal)| Some(verify(&hops, path.as_ref()?, start.post, goal.post)));
        let checks = checks.collect::<Vec<_>>();
        let warnings = refusals(&hops, start, goals);
        let trials = vec![None; goals.len()];
        let maps = Maps { out, back: back.transpose()?, mobility: mobile.transpose()?, goal_hops, paths, trials, warnings };
        Ok((maps, checks))
    });
    let (maps, checks) = maps.map_err(|error| failed(&error))?;
    for check in checks.iter().flatten() {
        passed(check)?;
    }
    Ok(maps)
}

/// The errors and trials for `--simulate`.
fn trial_keys(scenario: &Scenario) -> Result<UncertaintyKeys, Failure> {
    let keys = scenario.uncertainty.unwrap_or_default();
    if keys.policy == Policy::Replan {
        let message = "--simulate: uncertainty.policy is \"replan\", expected \"open-loop\": replanning needs the nodes of a \
                       transect search; set uncertainty.policy = \"open-loop\", or use `chta simulate` on a transect";
        return Err(Failure::message(message));
    }
    Ok(keys)
}

/// The ground as the warnings about trials see it.
fn trial_ground(inputs: &PreparedMap, maps: &Maps) -> TrialGround {
    let bounds = inputs.dem().bounds();
    let hops = maps.paths.iter().flatten().map(|path| path.hops.len()).max().unwrap_or(0);
    let constant = inputs.ground.constant_friction().map(FrictionCone::coefficient);
    // The coefficients of a raster are not looked through.
    let of_raster = inputs.ground.terrain().overlays().friction().map(|_| f64::INFINITY);
    TrialGround { friction_max: of_raster.or(constant), extent_m: (bounds.max - bounds.min).norm(), journey_m: None, hops }
}

/// Flies the path to every reachable goal many times.
fn simulated(
    args: &MapArgs,
    inputs: &PreparedMap,
    maps: &Maps,
    keys: &UncertaintyKeys,
) -> Result<Vec<Option<SimulationRecord>>, Failure> {
    let failed = |error: SimulationError| Failure::about(&args.dem, &error);
    let options = keys.options();
    let progress = Progress::new(args.common.quiet);
    let fly = |path: &HopPath| {
        let (Some(first), Some(last)) = (path.hops.first(), path.hops.last()) else { return Ok(None) };
        let mission = Mission::over_dem(inputs.ground.clone(), path.clone(), first.takeoff, last.landing);
        let summary = Simulation::new(&mission, keys.errors).map_err(failed)?.run(&options, &mut (), &progress).map_err(failed)?;
        Ok(Some(SimulationRecord::new(&summary, path.hops.len())))
    };
    maps.paths.iter().map(|path| path.as_ref().map_or(Ok(None), fly)).collect()
}

/// A progress line: the stage, the share done and the time left.
fn format_layer(what: &str, step: &Step, elapsed_s: f64) -> Option<String> {
    let Detail::Layer { hops } = step.detail else { return None };
    Some(format!("{what} hops, layer {hops}: {}", format_share("posts", step, elapsed_s)?))
}

#[expect(clippy::cast_precision_loss, reason = "a share for reading")]
fn format_share(what: &str, step: &Step, elapsed_s: f64) -> Option<String> {
    let share = step.done as f64 / step.of?.max(1) as f64;
    let left_s = elapsed_s * (1.0 - share) / share.max(1.0e-3);
    Some(format!("{what} {:.0} % done, about {left_s:.0} s left", 100.0 * share))
}

/// Checks that each output has an extension that its readers recognise.
fn check_extensions(args: &MapArgs) -> Result<(), Failure> {
    let MapArgs { output, effort_output, return_output, mobility, paths, geojson, profiles, plot, .. } = args;
    let rasters =
        [("-o", output), ("--effort-output", effort_output), ("--return-output", return_output), ("--mobility", mobility)];
    let rasters = rasters.map(|(option, file)| (option, file, &["tif", "tiff"][..]));
    let others = [("--paths", paths, &["csv"][..]), ("--geojson", geojson, &["geojson", "json"][..])];
    for (option, file, endings) in rasters.into_iter().chain(others) {
        let Some(file) = file else { continue };
        let ending = file.extension().unwrap_or_default();
        let special = file.exists() && !file.is_file();
        if !special && !endings.iter().any(|one| ending.eq_ignore_ascii_case(one)) {
            let message = format!("{option} {}: expected a file that ends in .{}", file.display(), endings.join(" or ."));
            return Err(Failure::message(message));
        }
    }
    for (option, file) in [("--profiles", profiles), ("--plot", plot)] {
        file.as_deref().map_or(Ok(()), |file| output::check_picture(option, file))?;
    }
    Ok(())
}

/// All output files named by the options.
fn outputs(args: &MapArgs) -> impl Iterator<Item = &Path> {
    let MapArgs { output, effort_output, return_output, mobility, paths, geojson, profiles, plot, .. } = args;
    [output, effort_output, return_output, mobility, paths, geojson, profiles, plot].into_iter().filter_map(Option::as_deref)
}

/// The record of a goal.
fn goal_record(inputs: &PreparedMap, maps: &Maps, goal: &Spot, index: usize) -> GoalRecord {
    let node = inputs.lattice.index(goal.post);
    let reached = |map: &HopMap| Some(map.hops[node]).filter(|&hops| hops >= 0);
    let path = maps.paths[index].as_ref();
    GoalRecord {
        x_m: goal.at.x,
        y_m: goal.at.y,
        offset_m: (goal.at - goal.asked).norm(),
        hops: reached(&maps.out),
        return_hops: maps.back.as_ref().map(reached),
        path: path.map(|path| HopRecord::rows(path, inputs.projection.as_ref().ok())).unwrap_or_default(),
        totals: path.map(|path| TotalsRecord::from(&path.totals)),
        propellant_shortage: path.and_then(|path| PropellantShortage::of(&path.totals)),
        // A path that fails the check has already ended the command with an error.
        verified: path.map(|_| true),
        simulation: maps.trials[index].clone(),
    }
}

/// Writes the requested outputs, all or none, into the files opened for them.
fn write_files<'a>(
    mut opened_files: Vec<Pending<'a>>,
    args: &'a MapArgs,
    inputs: &PreparedMap,
    maps: &Maps,
    answer: &MapAnswer,
    ends: (Spot, &[Spot]),
) -> Result<(), Failure> {
    let PreparedMap { lattice, scenario, projection, .. } = inputs;
    let map = inputs.dem().georeference().every(lattice.stride).citing_the_code();
    let raster =
        |bands: &ResultBands<'_>| result_geotiff_bytes(lattice.rows, lattice.cols, &map, bands).map_err(|e| Failure::of(&e));
    let integer_raster = |name, hops| raster(&ResultBands::Int16(vec![Band { name, samples: hops }], NO_GROUND));
    let mut files: Vec<(&Path, Vec<u8>)> = Vec::new();
    if let Some(file) = &args.output {
        files.push((file, integer_raster("fewest hops from the start; -1 unreachable", &maps.out.hops)?));
    }
    if let (Some(file), Some(back)) = (&args.return_output, &maps.back) {
        files.push((file, integer_raster("fewest hops back to the start; -1 no way", &back.hops)?));
    }
    if let Some(file) = &args.effort_output {
        #[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
        let samples: Vec<f32> = maps.out.effort.iter().map(|&effort| effort as f32).collect();
        let name = effort_name(scenario.search.effort);
        files.push((file, raster(&ResultBands::Float32(vec![Band { name: &name, samples: &samples }]))?));
    }
    if let (Some(file), Some(mobility)) = (&args.mobility, &maps.mobility) {
        let share = Band { name: "share of the reach disc that one hop reaches", samples: &mobility.share };
        let directions = Band { name: "directions of 16 with a hop", samples: &mobility.directions };
        files.push((file, raster(&ResultBands::Float32(vec![share, directions]))?));
    }
    if let Some(file) = &args.paths {
        let known = if projection.is_ok() { MapKnowledge::Projection } else { MapKnowledge::Metres };
        let mut csv = Vec::new();
        write_paths_csv(answer.goals.iter().map(|goal| &goal.path[..]), known, &mut csv).map_err(|e| Failure::of(&e))?;
        files.push((file, csv));
    }
    let none = HopPath { hops: Vec::new(), totals: chta::path::Totals::default() };
    let paths: Vec<&HopPath> = maps.paths.iter().map(|path| path.as_ref().unwrap_or(&none)).collect();
    let prj_path = args.geojson.as_ref().map(|path| path.with_extension("prj"));
    if let Some(file) = &args.geojson {
        let geojson = paths_geojson(&paths, scenario.body.gravity.m_s2(), projection.as_ref().ok()).unwrap_or_default();
        files.push((file, geojson.into_bytes()));
        files.extend(prj_path.as_deref().zip(output::prj(projection.as_ref().ok())));
    }
    if let Some(file) = &args.profiles {
        files.push((file, map_profiles::sheet(&name_of(args), scenario, &maps.goal_hops, projection.as_ref().ok(), file)?));
    }
    if let Some(file) = &args.plot {
        files.push((file, picture(args, inputs, maps, answer, ends, file)?));
    }
    let mut pending = Vec::new();
    for (file, bytes) in files {
        let place = opened_files.iter().position(|one| one.path() == file);
        pending.push((place.map_or_else(|| Pending::begin(file), |place| Ok(opened_files.swap_remove(place)))?, bytes));
    }
    output::finish(pending)
}

/// The band description of an effort raster.
fn effort_name(effort: Effort) -> String {
    format!("least {} among fewest hops, {}", effort.total(), effort.unit())
}

/// The terrain's name for titles.
fn name_of(args: &MapArgs) -> String {
    args.dem.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The map as a picture, in the format of the file's extension.
fn picture(
    args: &MapArgs,
    inputs: &PreparedMap,
    maps: &Maps,
    answer: &MapAnswer,
    (start, goals): (Spot, &[Spot]),
    file: &Path,
) -> Result<Vec<u8>, Failure> {
    let name = name_of(args);
    let can_return: Option<Vec<bool>> = maps.back.as_ref().map(|back| back.hops.iter().map(|&hops| hops >= 0).collect());
    let kept_out = inputs.ground.terrain().overlays().keep_out().map(|zones| kept_out(inputs, zones));
    let places = |path: &HopPath| {
        let landings = path.hops.iter().filter_map(|hop| hop.landing.map());
        std::iter::once(start.at).chain(landings).collect()
    };
    let figure = HopMapFigure {
        caption: Caption { title: format!("Where in how few hops: {name}"), lines: subtitle(answer, &inputs.scenario) },
        posts: MapPosts { dem: inputs.dem(), stride: inputs.lattice.stride },
        hops: &maps.out.hops,
        can_return: can_return.as_deref(),
        kept_out: kept_out.as_deref(),
        start: start.at,
        goals: goals
            .iter()
            .zip(&answer.goals)
            .map(|(goal, record)| GoalMark { at: goal.at, hops: record.hops.and_then(|hops| u64::try_from(hops).ok()) })
            .collect(),
        paths: maps.paths.iter().flatten().map(places).collect(),
    };
    output::encoded(draw_hop_map(&figure), file)
}

/// Which posts of the lattice lie in a keep-out zone.
fn kept_out(inputs: &PreparedMap, zones: &KeepOut) -> Vec<bool> {
    let NodeLattice { rows, cols, stride, .. } = inputs.lattice;
    let nodes = inputs.dem().georeference().every(stride);
    (0..rows * cols).map(|index| zones.keeps_out(nodes.post(index / cols, index % cols))).collect()
}

/// The subtitle of the picture: the map's assumptions and a summary of its result.
fn subtitle(answer: &MapAnswer, scenario: &Scenario) -> Vec<String> {
    let stride = if answer.stride > 1 { format!(", every {} posts", answer.stride) } else { String::new() };
    let found = format!(
        "{} of {} posts reachable from ({:.3}, {:.3}) m in at most {} hops{stride}",
        answer.reachable_posts, answer.posts, answer.start_m[0], answer.start_m[1], answer.farthest_hops
    );
    vec![conditions(scenario), found]
}
