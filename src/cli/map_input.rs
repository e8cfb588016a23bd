//! From the command line of `map` to its question: the scenario, the DEM, and the starts and goals of options, file or scenario.

use std::path::Path;

use chta::{
    chain::csv::read_positions_csv_file,
    quantity::MapPoint,
    study::{
        LegsMapQuestion,
        map::{MapQuestion, MapStudyError, NamedPlace},
        open::ScenarioEnds,
    },
    terrain::{LonLat, MapPlace},
};

use super::{
    Failure,
    args::{MapArgs, NodeSpacing, SearchArgs},
    claims,
    effects::Purpose,
    inputs,
    load::{Bare, load_map},
    output,
    wrong_thing::Role,
};

/// What `map` answers for.
#[derive(Debug)]
pub(crate) struct MapInput {
    /// The DEM and the scenario.
    pub(crate) bare: Bare,
    starts: Vec<NamedPlace>,
    goals: Vec<NamedPlace>,
    /// Warnings about the file of starts.
    warnings: Vec<String>,
}

impl MapInput {
    /// Reads the scenario and the starts.
    pub(crate) fn of(args: &MapArgs) -> Result<Self, Failure> {
        let MapArgs { dem, stride, effort, common, .. } = args;
        if *stride == 0 {
            return Err(Failure::message("--stride: found 0, expected a whole number of at least 1"));
        }
        let node_spacing_max_m = args.node_spacing_max_m.and_then(NodeSpacing::metres);
        let searched = SearchArgs { points_per_segment: None, node_spacing_max_m, effort: effort.clone().flatten() };
        let has_start = args.starts.is_some() || !(args.start.is_empty() && args.start_lonlat.is_empty());
        let has_goal = !(args.goal.is_empty() && args.goal_lonlat.is_empty());
        let purpose = |ends| Purpose::Map {
            goals: has_goal || ends != ScenarioEnds::Ignored,
            effort: effort.is_some(),
            amounts: !args.amount_output.is_empty(),
            trials: args.simulate,
            ends,
        };
        let bare = load_map(dem, common, (&searched, &args.objective, &[]), purpose, has_start)?;
        let mut warnings = Vec::new();
        let starts = match (&args.starts, &bare.ends) {
            (Some(file), _) => of_file(file, &mut warnings)?,
            (None, Some([start, _])) if !has_start => vec![of_key("start", *start)],
            _ => of_options("--start", &args.start, &args.start_lonlat),
        };
        if starts.is_empty() && !args.asks_for_single_hops() {
            return Err(Failure::message(format!(
                "{}: found no start, expected one for a map: give --start X,Y, --start-lonlat LON,LAT or --starts FILE, or a scenario whose \
                 [terrain] has a dem with start_m and goal_m",
                dem.display()
            )));
        }
        let goals = if has_goal { of_options("--goal", &args.goal, &args.goal_lonlat) } else { goals_of(&bare) };
        if goals.is_empty() {
            without_goal(args)?;
        }
        Ok(Self { bare, starts, goals, warnings })
    }

    /// The question.
    pub(crate) fn question<'a>(&'a self, args: &MapArgs) -> MapQuestion<'a> {
        MapQuestion {
            scenario: &self.bare.scenario,
            base: &self.bare.base,
            dem: &self.bare.dem,
            starts: self.starts.clone(),
            goals: self.goals.clone(),
            stride: args.stride as usize,
            auto_nodes: args.node_spacing_max_m == Some(NodeSpacing::Auto),
            effort: args.effort.is_some(),
            returns: args.back,
            mobility: args.mobility.is_some(),
            ranks_sites: false,
            predecessors: args.predecessor_output.is_some(),
            refusals: args.plot.is_some(),
            trials: args.simulate,
            hops_max: args.hops_max,
            amounts: args.amount_output.iter().map(|output| output.amount).collect(),
            memory_max_bytes: args.size.memory_max_bytes(),
        }
    }

    /// The failure for an error of the study.
    pub(crate) fn failure(&self, error: &MapStudyError) -> Failure {
        Failure::about(&self.bare.dem, error)
    }

    /// The question of a robot with legs.
    pub(crate) fn legs_question<'a>(&'a self, args: &MapArgs) -> LegsMapQuestion<'a> {
        LegsMapQuestion {
            scenario: &self.bare.scenario,
            base: &self.bare.base,
            dem: &self.bare.dem,
            starts: self.starts.clone(),
            goals: self.goals.clone(),
            stride: args.stride as usize,
            hops_max: args.hops_max,
            memory_max_bytes: args.size.memory_max_bytes(),
        }
    }

    /// All warnings, those of the study last, printed on standard error.
    pub(crate) fn warned(&self, of_study: &[String], quiet: bool) -> Vec<String> {
        output::warned(quiet, &[&self.bare.warnings, &self.warnings, of_study])
    }

    /// The name of the map in titles: that of the scenario's report, else of the DEM.
    pub(crate) fn title(&self) -> String {
        self.bare.title_of_map()
    }
}

/// The positions of an option in metres, or of its other form in degrees.
pub(crate) fn of_options(option: &str, metres: &[MapPoint], degrees: &[LonLat]) -> Vec<NamedPlace> {
    let places = metres.iter().copied().map(MapPlace::Metres).chain(degrees.iter().copied().map(MapPlace::LonLat));
    places.map(|place| NamedPlace { name: option.to_owned(), place }).collect()
}

/// The position of a key of the scenario.
fn of_key(end: &str, place: MapPlace) -> NamedPlace {
    let unit = if place.metres().is_some() { "m" } else { "lonlat_deg" };
    NamedPlace { name: format!("terrain.{end}_{unit}"), place }
}

/// The targets of a scenario's mission, or its goal.
pub(crate) fn goals_of(bare: &Bare) -> Vec<NamedPlace> {
    match (&bare.scenario.mission, &bare.ends) {
        (_, None) => Vec::new(),
        (Some(mission), Some(_)) => {
            mission.targets.iter().map(|place| NamedPlace { name: "mission.targets_m".to_owned(), place: *place }).collect()
        }
        (None, Some([_, goal])) => vec![of_key("goal", *goal)],
    }
}

/// The positions of a file.
pub(crate) fn of_file(file: &Path, warnings: &mut Vec<String>) -> Result<Vec<NamedPlace>, Failure> {
    let input = inputs::open(file, Role::Starts)?;
    claims::reads(&input.file);
    let read = read_positions_csv_file(&input.file)?;
    let name = file.display();
    warnings.extend(read.warnings.iter().map(|warning| format!("{name}: {warning}")));
    let named = |(line, at): (u64, _)| NamedPlace { name: format!("{name}, line {line}:"), place: MapPlace::Metres(at) };
    Ok(read.positions.into_iter().map(named).collect())
}

/// Refuses what needs a goal.
fn without_goal(args: &MapArgs) -> Result<(), Failure> {
    let given = [
        ("--simulate", args.simulate),
        ("--paths", args.paths.is_some()),
        ("--geojson", args.geojson.is_some()),
        ("--profiles", args.profiles.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::message(format!(
            "{option}: found no goal, expected at least one to plan a path to: give --goal X,Y or --goal-lonlat LON,LAT, or a scenario whose \
             [terrain] has a dem with start_m and goal_m, without --start"
        ))),
        None => Ok(()),
    }
}
