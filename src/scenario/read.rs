//! Converts raw TOML keys to a validated scenario in SI units.

use std::path::{Path, PathBuf};

use super::{
    Budget, Entries, Place, ProblemKind, Route, ScenarioProblem, UncertaintyKeys,
    propulsion::{self, landing},
};
use crate::{
    ballistics::TakeoffChoice,
    graph::{Effort, PointSpacing, ReliabilityUse, SearchOptions},
    hop::Split,
    planner::{Objective, SearchedCommands},
    quantity::{Angle, AngleInterval, MapPoint},
    terrain::{LonLat, MapPlace, NoDataRule},
    world::{
        Body, ClearanceRule, CommandSteps, Derating, FrictionCone, Gravity, Grip, Hopper, HopperLimits, InvalidHopper,
        KNOWN_BODIES, RestSlope, SurfaceProperties,
    },
};

/// Gravity, and its body if known.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyChoice {
    /// The known body's name.
    pub name: Option<String>,
    /// Gravity, with the body's mean radius where known.
    pub gravity: Gravity,
}

impl BodyChoice {
    /// Mean radius, m, where known.
    pub const fn radius_m(&self) -> Option<f64> {
        self.gravity.body_radius_m()
    }

    /// Its name, for a sentence.
    pub fn spoken(&self) -> String {
        self.name.clone().unwrap_or_else(|| "the body".to_owned())
    }
}

/// Where the ground comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum TerrainSource {
    /// A slice of an elevation raster between two map points.
    Dem {
        /// The file's path, relative to the scenario's folder.
        path: PathBuf,
        /// Where the slice begins.
        start: MapPlace,
        /// Where it ends.
        goal: MapPlace,
    },
    /// A slice of a triangulated surface between two map points.
    Mesh {
        /// The file's path, relative to the scenario's folder.
        path: PathBuf,
        /// Metres per unit of the file.
        scale: f64,
        /// Where the slice begins.
        start: MapPoint,
        /// Where it ends.
        goal: MapPoint,
    },
    /// A chain CSV.
    Chain {
        /// The file's path, relative to the scenario's folder.
        path: PathBuf,
    },
}

impl TerrainSource {
    /// The file's path, relative to the scenario's folder.
    pub fn path(&self) -> &Path {
        match self {
            Self::Dem { path, .. } | Self::Mesh { path, .. } | Self::Chain { path } => path,
        }
    }

    /// The ends of the slice on the map; `None` for a chain.
    pub fn map_ends(&self) -> Option<[MapPlace; 2]> {
        match self {
            Self::Dem { start, goal, .. } => Some([*start, *goal]),
            Self::Mesh { start, goal, .. } => Some([*start, *goal].map(MapPlace::Metres)),
            Self::Chain { .. } => None,
        }
    }
}

/// A validated scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Gravity.
    pub body: BodyChoice,
    /// The robot.
    pub hopper: Hopper,
    /// The ground's grip.
    pub surface: SurfaceProperties,
    /// Path of the raster of friction coefficients, relative to the scenario's folder.
    pub friction_raster: Option<PathBuf>,
    /// Path of the keep-out zones, relative to the scenario's folder.
    pub keep_out: Option<PathBuf>,
    /// The terrain, if the scenario names one.
    pub terrain: Option<TerrainSource>,
    /// Whether a map whose scale along the transect is off by over 1 % is accepted.
    pub accept_map_scale: bool,
    /// What marks missing elevations in the terrain's file.
    pub no_data: NoDataRule,
    /// Intermediate points on the map, where a slice bends.
    pub via: Vec<MapPlace>,
    /// Whether the journey keeps to the plane from start to goal.
    pub route: Route,
    /// Start along the chain, m, if the scenario gives it.
    pub start_x_m: Option<f64>,
    /// Goal along the chain, m, if the scenario gives it.
    pub goal_x_m: Option<f64>,
    /// How to search.
    pub search: SearchOptions,
    /// How path choice weighs reliability.
    pub risk: ReliabilityUse,
    /// Hops beyond the fewest that a more reliable path may take, if hops are traded for reliability.
    pub risk_extra_hops_max: Option<u32>,
    /// What a path has to give at least, and may take at most.
    pub budget: Budget,
    /// What is to be least, where the scenario says it by more than an effort.
    pub objective: Option<Objective>,
    /// Which commands a plan by objective chooses from.
    pub commands: SearchedCommands,
    /// Shares of the limits that planning may use.
    pub derating: Derating,
    /// The errors of the trials, if the scenario has `[uncertainty]`.
    pub uncertainty: Option<UncertaintyKeys>,
    /// Title of the picture.
    pub title: Option<String>,
}

impl Scenario {
    /// The scenario of a document that [`scenario_document`](super::scenario_document) made: equal to the one that it was made from, with
    /// the paths that the document names.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_document(document: &serde_json::Value) -> Result<Self, Vec<ScenarioProblem>> {
        Self::new(Entries::from_json(document))
    }

    /// Validates raw keys.
    ///
    /// # Errors
    /// Every problem found: those in the file in file order, then those of command-line options or without a position.
    pub fn new(mut entries: Entries) -> Result<Self, Vec<ScenarioProblem>> {
        if entries.is_unreadable() {
            return Err(entries.problems().to_vec());
        }
        let body = body(&mut entries);
        let hopper = hopper(&mut entries);
        let surface = surface(&mut entries);
        let terrain = terrain(&mut entries);
        let via = via(&mut entries, terrain.as_ref());
        let route = super::route::route(&mut entries, terrain.as_ref());
        let [friction_raster, keep_out] = overlays(&mut entries, &surface, terrain.as_ref());
        let derating = super::derating::derating(&mut entries, &hopper, &surface);
        let uncertainty = super::trials::trials(&mut entries, terrain.as_ref());
        let budget = super::budget::budget(&entries);
        let (objective, commands, wanted_angle) = super::budget::objective(&mut entries, budget, &hopper, uncertainty.as_ref());
        let (risk, risk_extra_hops_max) = super::trials::risk(&mut entries, uncertainty.as_ref(), budget);
        super::budget::check(&mut entries, budget, risk, uncertainty.as_ref());
        let takeoff = wanted_angle.unwrap_or_else(|| super::trials::takeoff_choice(risk, uncertainty.as_ref()));
        let search = search(&mut entries, takeoff);
        let mut problems = entries.problems().to_vec();
        let Some(body) = body.filter(|_| problems.is_empty()) else {
            let first = |problem: &ScenarioProblem| match &problem.place {
                Place::File(span) => span.start,
                Place::Option(_) | Place::Nowhere => usize::MAX,
            };
            problems.sort_by_key(first);
            return Err(problems);
        };
        Ok(Self {
            body,
            hopper,
            surface,
            friction_raster,
            keep_out,
            terrain,
            accept_map_scale: entries.flag("terrain", "accept_map_scale"),
            no_data: entries.no_data("terrain", "no_data"),
            via,
            route,
            start_x_m: entries.number("terrain", "start_x_m"),
            goal_x_m: entries.number("terrain", "goal_x_m"),
            search,
            risk,
            risk_extra_hops_max,
            budget,
            objective,
            commands,
            derating,
            uncertainty,
            title: entries.text("report", "title").map(str::to_owned),
        })
    }
}

impl Scenario {
    /// Keys that hops over a DEM need and the scenario lacks (a chain file could supply them in its columns).
    pub fn lacks_on_a_dem(&self) -> Vec<LackingKey> {
        let no_grip = self.surface.grip.is_none() && self.friction_raster.is_none();
        let from_slope: &[_] = &["surface.takeoff_from_slope_deg", "surface.landing_from_slope_deg"];
        let keys = [
            (self.hopper.limits().takeoff_speed_max_m_s.is_infinite(), "hopper.takeoff_speed_max_m_s", 8.0, &[][..]),
            (self.hopper.limits().landing_speed_max_m_s.is_infinite(), "hopper.landing_speed_max_m_s", 8.0, &[]),
            (no_grip, "surface.friction_coefficient", 0.6, from_slope),
        ];
        let missing = keys.into_iter().filter(|(missing, ..)| *missing);
        missing.map(|(_, key, example, instead)| LackingKey { key, instead, example }).collect()
    }
}

/// A key that is absent and needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LackingKey {
    /// The key, `table.name`.
    pub key: &'static str,
    /// Keys that together can replace it.
    pub instead: &'static [&'static str],
    /// An example value.
    pub example: f64,
}

/// Factor from which on a radius is a mistake of units, beside the name of a known body. A kilometre is a thousand metres; no two
/// measurements of one body differ by this much.
const OTHER_UNIT: f64 = 5.0;

/// A gravity with the radius of its body; the catalogue's range of a radius is within that of a gravity's.
fn of_radius(gravity: Gravity, radius_m: f64) -> Gravity {
    gravity.with_radius_m(radius_m).unwrap_or(gravity)
}

/// Gravity and radius: from a known body, from numbers, or from both.
fn body(entries: &mut Entries) -> Option<BodyChoice> {
    // The catalogue's range is within that of `Gravity`.
    let gravity = entries.number("body", "gravity_m_s2").and_then(|m_s2| Gravity::new(m_s2).ok());
    let radius = entries.number("body", "radius_m");
    let name = entries.text("body", "name").map(str::to_owned);
    match (&name, gravity) {
        (Some(name), _) => {
            let Some(known) = Body::named(name) else {
                unknown_body(entries, name);
                return None;
            };
            let radius_m = radius.unwrap_or(known.radius_m);
            let times = radius_m / known.radius_m;
            if !(1.0 / OTHER_UNIT..=OTHER_UNIT).contains(&times) {
                let message =
                    format!("body.radius_m is {radius_m} m, but {} has a mean radius of {} m", known.name, known.radius_m);
                let help = "give it in metres, or remove it: the name gives the radius";
                entries.problem(("body", "radius_m"), ProblemKind::Conflict, message, help);
            }
            Some(BodyChoice { name: Some(known.name.to_owned()), gravity: of_radius(gravity.unwrap_or(known.gravity), radius_m) })
        }
        (None, Some(gravity)) => {
            Some(BodyChoice { name: None, gravity: radius.map_or(gravity, |radius_m| of_radius(gravity, radius_m)) })
        }
        (None, None) => {
            // A gravity or body with an invalid value or a misspelt key is already reported.
            if !entries.has_unknown("body") && !entries.has_refused("body", &["name", "gravity_m_s2"]) {
                let help = "add [body] with name = \"mars\" or gravity_m_s2 = 3.711";
                entries.problem(("body", "gravity_m_s2"), ProblemKind::Missing, "found no gravity".to_owned(), help);
            }
            None
        }
    }
}

/// Reports that no known body has this name, with the nearest name.
fn unknown_body(entries: &mut Entries, name: &str) {
    let names: Vec<_> = KNOWN_BODIES.iter().map(|body| body.name).collect();
    let message = format!("body.name is \"{name}\", expected one of {}", names.join(", "));
    let lower_case = name.to_lowercase();
    let near = names.iter().min_by_key(|known| strsim::damerau_levenshtein(&lower_case, known)).copied().unwrap_or_default();
    let help = format!("the nearest known name is {near}; for any other body give gravity_m_s2 instead of a name");
    entries.problem(("body", "name"), ProblemKind::Value, message, help);
}

/// The robot; an absent key sets no limit.
fn hopper(entries: &mut Entries) -> Hopper {
    let number = |name| entries.number("hopper", name);
    let taper = number("clearance_taper");
    let clearance_rule = match entries.text("hopper", "clearance_rule") {
        Some(rule) if rule == ClearanceRule::Vertex.name() => ClearanceRule::Vertex,
        _ => taper.map_or(ClearanceRule::TAPERED, ClearanceRule::Tapered),
    };
    let landing = landing(entries);
    let restitution = super::contact::restitution(entries);
    let number = |name| entries.number("hopper", name);
    let limits = HopperLimits {
        takeoff_speed_max_m_s: number("takeoff_speed_max_m_s").unwrap_or(f64::INFINITY),
        landing_speed_max_m_s: number("landing_speed_max_m_s").unwrap_or(f64::INFINITY),
        clearance_m: number("clearance_m").unwrap_or(0.0),
        clearance_rule,
        takeoff_angle_min: number("takeoff_angle_min_deg").map(Angle::from_degrees),
        takeoff_angle_max: number("takeoff_angle_max_deg").map(Angle::from_degrees),
        apex_height_max_m: number("apex_height_max_m"),
        flight_time_max_s: number("flight_time_max_s"),
        takeoff_speed_min_m_s: number("takeoff_speed_min_m_s"),
        takeoff_speed_levels: entries.speeds("hopper", "takeoff_speed_levels_m_s"),
        steps: CommandSteps {
            takeoff_angle: number("takeoff_angle_step_deg").map(Angle::from_degrees),
            takeoff_speed_m_s: number("takeoff_speed_step_m_s"),
            heading: number("heading_step_deg").map(Angle::from_degrees),
        },
        footprint_m: number("footprint_m"),
        roughness_max_m: number("roughness_max_m"),
        mass_kg: number("mass_kg"),
        rest_time_s: number("rest_time_s"),
        landing,
        hop_delta_v_overhead_m_s: number("hop_delta_v_overhead_m_s"),
        isp_s: number("isp_s"),
        propellant_max_kg: number("propellant_max_kg"),
        preparation_time_s: number("preparation_time_s"),
        settling_time_s: number("settling_time_s"),
        preparation_energy_j: number("preparation_energy_j"),
        efficiency: number("efficiency"),
        restitution,
    };
    if let (Some(min), Some(max)) = (limits.takeoff_angle_min, limits.takeoff_angle_max)
        && min > max
    {
        let message = format!(
            "hopper.takeoff_angle_min_deg is {}, expected no more than the takeoff_angle_max_deg of {}",
            min.degrees(),
            max.degrees()
        );
        let help = "swap the two or widen the range";
        entries.problem(("hopper", "takeoff_angle_min_deg"), ProblemKind::Conflict, message, help);
        return Hopper::UNLIMITED;
    }
    if let Some((key, message, help)) = commands_conflict(&limits) {
        entries.problem(("hopper", key), ProblemKind::Conflict, message, help);
        return Hopper::UNLIMITED;
    }
    if clearance_rule == ClearanceRule::Vertex && taper.is_some() {
        let message =
            "hopper.clearance_taper has no effect beside clearance_rule = \"vertex\", which keeps the whole clearance over \
                       every vertex"
                .to_owned();
        let help = "remove clearance_taper, or say clearance_rule = \"tapered\"";
        entries.problem(("hopper", "clearance_taper"), ProblemKind::Conflict, message, help);
    }
    if limits.roughness_max_m.is_some() && !limits.footprint_m.is_some_and(|footprint_m| footprint_m > 0.0) {
        let message = format!(
            "hopper.roughness_max_m is {}, expected a footprint_m above 0 beside it, over which the roughness is measured",
            limits.roughness_max_m.unwrap_or(0.0)
        );
        let help = "give hopper.footprint_m, the diameter of the ground that the hopper stands on, or remove roughness_max_m";
        entries.problem(("hopper", "roughness_max_m"), ProblemKind::Conflict, message, help);
        return Hopper::UNLIMITED;
    }
    // The catalogue's ranges lie within those of a hopper; what two keys mean together, the hopper itself checks.
    Hopper::new(limits).unwrap_or_else(|InvalidHopper(problems)| {
        for problem in problems {
            let help = propulsion::help(problem.key).unwrap_or("give a value in that range");
            entries.problem(("hopper", problem.key), ProblemKind::Value, problem.to_string(), help);
        }
        Hopper::UNLIMITED
    })
}

/// The key, the sentence and the remedy of take-off speeds that the machine cannot have together.
fn commands_conflict(limits: &HopperLimits) -> Option<(&'static str, String, &'static str)> {
    let (greatest, least) = (limits.takeoff_speed_max_m_s, limits.takeoff_speed_min_m_s);
    if let Some(least) = least.filter(|least| *least > greatest) {
        let message =
            format!("hopper.takeoff_speed_min_m_s is {least}, expected no more than the takeoff_speed_max_m_s of {greatest}");
        return Some(("takeoff_speed_min_m_s", message, "lower it, or raise takeoff_speed_max_m_s"));
    }
    let levels = limits.takeoff_speed_levels?;
    let key = "takeoff_speed_levels_m_s";
    if levels.highest_m_s() > greatest {
        let highest = levels.highest_m_s();
        let message = format!("hopper.{key} has {highest}, expected no level above the takeoff_speed_max_m_s of {greatest}");
        return Some((key, message, "leave out that level, or raise takeoff_speed_max_m_s"));
    }
    let least = least.filter(|least| levels.lowest_m_s() < *least)?;
    let message = format!("hopper.{key} has {}, expected no level below the takeoff_speed_min_m_s of {least}", levels.lowest_m_s());
    Some((key, message, "leave out that level, or takeoff_speed_min_m_s"))
}

/// Friction or angles from the slope, and the rest slope.
fn surface(entries: &mut Entries) -> SurfaceProperties {
    let friction = entries.number("surface", "friction_coefficient");
    let offsets = |entries: &Entries, name| entries.pair("surface", name).map(|[min, max]| AngleInterval::from_degrees(min, max));
    let takeoff = offsets(entries, "takeoff_from_slope_deg");
    let landing = offsets(entries, "landing_from_slope_deg");
    let grip = match (friction, takeoff, landing) {
        (Some(mu), None, None) => FrictionCone::new(mu).ok().map(Grip::Friction),
        (None, Some(takeoff), Some(landing)) => Some(Grip::FromSlope { takeoff, landing }),
        (None, None, None) => None,
        (Some(_), _, _) => {
            let message = "surface has both friction_coefficient and angles from the slope, expected one of the two".to_owned();
            let help = "remove friction_coefficient, or takeoff_from_slope_deg and landing_from_slope_deg";
            entries.problem(("surface", "friction_coefficient"), ProblemKind::Conflict, message, help);
            None
        }
        (None, _, _) => {
            let (given, missing) = if takeoff.is_some() { ("takeoff", "landing") } else { ("landing", "takeoff") };
            let (given, missing) = (format!("{given}_from_slope_deg"), format!("{missing}_from_slope_deg"));
            let place = entries.place("surface", &given).unwrap_or(Place::Nowhere);
            let message = format!("surface has {given} without {missing}");
            let help = format!("add {missing} = [min, max]");
            entries.problem_at(place, ("surface", &missing), ProblemKind::Missing, message, help);
            None
        }
    };
    let rest = match entries.value("surface", "rest_slope_max_deg") {
        None => RestSlope::AsFrictionHolds,
        Some(value) => match value.as_float().or(value.as_integer().and_then(|i| i32::try_from(i).ok()).map(f64::from)) {
            Some(degrees) if degrees.is_finite() => RestSlope::AtMost(Angle::from_degrees(degrees)),
            _ => RestSlope::Unlimited,
        },
    };
    SurfaceProperties { grip, rest }
}

/// The files of the overlays on the terrain: friction raster and keep-out zones.
fn overlays(entries: &mut Entries, surface: &SurfaceProperties, terrain: Option<&TerrainSource>) -> [Option<PathBuf>; 2] {
    let own_columns = [("friction_raster", "friction_coefficient"), ("keep_out", "keep_out")];
    if matches!(terrain, Some(TerrainSource::Chain { .. })) {
        for (name, column) in own_columns {
            if entries.value("surface", name).is_some() {
                let help = format!("give the chain a column {column} instead");
                let message = format!("surface.{name} is laid over a dem, but terrain has a chain");
                entries.problem(("surface", name), ProblemKind::Misplaced, message, help);
            }
        }
    }
    if let (Some(Grip::FromSlope { .. }), Some(_)) = (surface.grip, entries.value("surface", "friction_raster")) {
        let message = "surface has both friction_raster and angles from the slope, expected one of the two".to_owned();
        let help = "remove friction_raster, or takeoff_from_slope_deg and landing_from_slope_deg";
        entries.problem(("surface", "friction_raster"), ProblemKind::Conflict, message, help);
    }
    own_columns.map(|(name, _)| entries.text("surface", name).map(PathBuf::from))
}

/// The source of the ground: at most one file.
fn terrain(entries: &mut Entries) -> Option<TerrainSource> {
    let kinds = ["dem", "mesh", "chain"];
    let given: Vec<(&str, PathBuf)> =
        kinds.iter().filter_map(|&kind| Some((kind, PathBuf::from(entries.text("terrain", kind)?)))).collect();
    let scale = entries.number("terrain", "mesh_scale");
    if scale.is_some() && !given.iter().any(|(kind, _)| *kind == "mesh") {
        let (message, help) = ("terrain.mesh_scale without a mesh".to_owned(), "add mesh = \"file.obj\", or remove it");
        entries.problem(("terrain", "mesh_scale"), ProblemKind::Misplaced, message, help);
    }
    match given.as_slice() {
        [] => {
            // A file with an invalid value, or an unknown key that may be a misspelling of it, is already reported.
            if entries.has_unknown("terrain") || entries.has_refused("terrain", &kinds) {
                return None;
            }
            let on_map = ["start_m", "goal_m", "start_lonlat_deg", "goal_lonlat_deg"]
                .into_iter()
                .find_map(|name| Some((name, entries.place("terrain", name)?)));
            let along = ["start_x_m", "goal_x_m"].into_iter().find_map(|name| Some((name, entries.place("terrain", name)?)));
            if let Some((name, place)) = on_map {
                let (message, help) = (format!("terrain.{name} without a dem"), "add dem = \"file.tif\", or mesh = \"file.obj\"");
                entries.problem_at(place, ("terrain", "dem"), ProblemKind::Missing, message, help);
            } else if let Some((name, place @ Place::File(_))) = along {
                let (message, help) = (format!("terrain.{name} without a chain"), "add chain = \"file.csv\"");
                entries.problem_at(place, ("terrain", "chain"), ProblemKind::Missing, message, help);
            }
            None
        }
        [("chain", path)] => {
            refuse_map_points(entries);
            Some(TerrainSource::Chain { path: path.clone() })
        }
        [(kind, path)] => {
            let [start, goal] = map_ends(entries, kind)?;
            let path = path.clone();
            Some(match *kind {
                "mesh" => {
                    let [start, goal] = on_mesh(entries, [start, goal])?;
                    TerrainSource::Mesh { path, scale: scale.unwrap_or(1.0), start, goal }
                }
                _ => TerrainSource::Dem { path, start, goal },
            })
        }
        [(first, _), .., (last, _)] => {
            let (message, help) = if given.len() == 2 {
                (format!("terrain has both {first} and {last}, expected one of the two"), "remove one of them")
            } else {
                ("terrain has all of dem, mesh and chain, expected one of the three".to_owned(), "remove two of them")
            };
            entries.problem(("terrain", last), ProblemKind::Conflict, message, help);
            None
        }
    }
}

/// Start and goal on the map, which a slice needs.
fn map_ends(entries: &mut Entries, kind: &str) -> Option<[MapPlace; 2]> {
    // If both are missing, one sentence is enough.
    let start = map_place(entries, "start", kind)?;
    Some([start, map_place(entries, "goal", kind)?])
}

/// The intermediate points, given in one of two forms.
fn via(entries: &mut Entries, terrain: Option<&TerrainSource>) -> Vec<MapPlace> {
    let metres = entries.points("terrain", "via_m").into_iter().map(|[x, y]| MapPlace::Metres(MapPoint::new(x, y)));
    let degrees = entries.points("terrain", "via_lonlat_deg");
    let degrees = degrees.into_iter().map(|[lon_deg, lat_deg]| MapPlace::LonLat(LonLat { lon_deg, lat_deg }));
    let (metres, degrees): (Vec<_>, Vec<_>) = (metres.collect(), degrees.collect());
    let key = ("terrain", "via_lonlat_deg");
    if !metres.is_empty() && !degrees.is_empty() {
        let message = "terrain has both via_m and via_lonlat_deg, expected one of the two".to_owned();
        entries.problem(key, ProblemKind::Conflict, message, "remove one of them");
    } else if !degrees.is_empty() && matches!(terrain, Some(TerrainSource::Mesh { .. })) {
        let message = "terrain gives longitude and latitude for a mesh, which has no projection".to_owned();
        entries.problem(key, ProblemKind::Conflict, message, "give via_m = [[x, y], ...], in the mesh's own metres");
    }
    if metres.is_empty() { degrees } else { metres }
}

/// The ends of a slice of a mesh, which has no projection.
fn on_mesh(entries: &mut Entries, ends: [MapPlace; 2]) -> Option<[MapPoint; 2]> {
    if let [MapPlace::Metres(start), MapPlace::Metres(goal)] = ends {
        return Some([start, goal]);
    }
    let given = ["start_lonlat_deg", "goal_lonlat_deg"].into_iter().find(|name| entries.value("terrain", name).is_some());
    let message = "terrain gives longitude and latitude for a mesh, which has no projection".to_owned();
    let help = "give start_m and goal_m = [x, y], in the mesh's own metres";
    entries.problem(("terrain", given.unwrap_or_default()), ProblemKind::Conflict, message, help);
    None
}

/// Map points beside a chain.
fn refuse_map_points(entries: &mut Entries) {
    for name in ["start_m", "goal_m", "start_lonlat_deg", "goal_lonlat_deg"] {
        if entries.value("terrain", name).is_some() {
            let help = format!("for a chain give {}_x_m instead", name.split('_').next().unwrap_or(name));
            let message =
                format!("terrain.{name} is a map position, but terrain is a chain, whose positions are distances along it");
            entries.problem(("terrain", name), ProblemKind::Misplaced, message, help);
        }
    }
    for name in ["via_m", "via_lonlat_deg"] {
        if entries.value("terrain", name).is_some() {
            let message = format!("terrain.{name} adds a bend to a DEM or mesh slice, but terrain is a chain");
            entries.problem(("terrain", name), ProblemKind::Misplaced, message, "give the chain a column bend instead");
        }
    }
}

/// The start or goal of a transect: map coordinates, or longitude and latitude.
fn map_place(entries: &mut Entries, end: &str, kind: &str) -> Option<MapPlace> {
    let (metres, degrees) = (format!("{end}_m"), format!("{end}_lonlat_deg"));
    let point = entries.pair("terrain", &metres).map(|[x, y]| MapPoint::new(x, y));
    let place = entries.pair("terrain", &degrees).map(|[lon_deg, lat_deg]| LonLat { lon_deg, lat_deg });
    match (point, place) {
        (Some(point), None) => Some(MapPlace::Metres(point)),
        (None, Some(place)) => Some(MapPlace::LonLat(place)),
        (Some(_), Some(_)) => {
            let message = format!("terrain has both {metres} and {degrees}, expected one of the two");
            entries.problem(("terrain", &degrees), ProblemKind::Conflict, message, "remove one of them");
            None
        }
        (None, None) => {
            if !entries.has_refused("terrain", &[&metres, &degrees]) {
                let at = entries.place("terrain", kind).unwrap_or(Place::Nowhere);
                let instead = if kind == "dem" { format!(", or {degrees} = [longitude, latitude]") } else { String::new() };
                let help = format!("add {metres} = [x, y], in map metres{instead}");
                let message = format!("terrain has a {kind} but no {metres}");
                entries.problem_at(at, ("terrain", &metres), ProblemKind::Missing, message, help);
            }
            None
        }
    }
}

/// How to search, with this choice of take-off angle where none is given.
fn search(entries: &mut Entries, takeoff: TakeoffChoice) -> SearchOptions {
    let points = entries.value("search", "points_per_segment").cloned();
    let spacing_m = entries.number("search", "node_spacing_max_m");
    if let (Some(_), Some(_)) = (&points, spacing_m) {
        let message = "search has both points_per_segment and node_spacing_max_m, expected one of the two".to_owned();
        entries.problem(("search", "node_spacing_max_m"), ProblemKind::Conflict, message, "remove one of them");
    }
    let count = points.as_ref().and_then(toml::Value::as_integer).and_then(|k| u32::try_from(k).ok());
    let word = |name| entries.text("search", name);
    SearchOptions {
        spacing: spacing_m.map(PointSpacing::AtMostM).or(count.map(PointSpacing::PerSegment)),
        effort: named(&Effort::ALL, Effort::name, word("effort")),
        takeoff: find(&TakeoffChoice::ALL, TakeoffChoice::name, word("takeoff_angle")).unwrap_or(takeoff),
        split: named(&Split::ALL, Split::name, word("split")),
    }
}

/// The variant with this name; the default if no name is given.
fn named<T: Copy + Default>(all: &[T], name: fn(T) -> &'static str, word: Option<&str>) -> T {
    find(all, name, word).unwrap_or_default()
}

/// The variant with this name; `None` if no name is given.
pub(super) fn find<T: Copy>(all: &[T], name: fn(T) -> &'static str, word: Option<&str>) -> Option<T> {
    all.iter().copied().find(|variant| Some(name(*variant)) == word)
}
