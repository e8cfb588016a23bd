//! Converts raw TOML keys to a validated scenario in SI units.

use std::path::PathBuf;

use super::{
    Budget, DriveKeys, Entries, LayerKeys, LegsKeys, MeshSearch, MissionKeys, Place, ProblemKind, Route, ScenarioProblem,
    TerrainSource, UncertaintyKeys,
    propulsion::{self, landing},
    terrain_source::{terrain, via},
};
use crate::{
    ballistics::TakeoffChoice,
    graph::{Effort, PointSpacing, ReliabilityUse, SearchOptions},
    hop::Split,
    planner::{Objective, SearchedCommands, roadmap::RoadmapPlanner},
    quantity::{Angle, AngleInterval},
    terrain::{MapPlace, NoDataRule},
    world::{
        Body, ClearanceRule, CommandSteps, Derating, FaceGroups, FrictionCone, Gravity, Grip, Hopper, HopperLimits, InvalidHopper,
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

/// A validated scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Gravity.
    pub body: BodyChoice,
    /// The robot.
    pub hopper: Hopper,
    /// A robot with legs.
    pub legs: LegsKeys,
    /// The ground's grip.
    pub surface: SurfaceProperties,
    /// What groups of faces of a mesh have of their own.
    pub groups: FaceGroups,
    /// Path of the raster of friction coefficients, relative to the scenario's folder.
    pub friction_raster: Option<PathBuf>,
    /// Path of the keep-out zones, relative to the scenario's folder.
    pub keep_out: Option<PathBuf>,
    /// Path of the keep-in zones, relative to the scenario's folder.
    pub keep_in: Option<PathBuf>,
    /// The layers, in the order of their names.
    pub layers: Vec<LayerKeys>,
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
    /// How to search for a free route over a mesh.
    pub mesh_search: MeshSearch,
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
    /// How it drives, if the scenario has `[drive]`.
    pub drive: Option<DriveKeys>,
    /// The targets that it visits, if the scenario has `[mission]`.
    pub mission: Option<MissionKeys>,
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
        let legs = super::legs::legs(&mut entries);
        let mesh_search = super::mesh_search::mesh_search(&mut entries, terrain.as_ref());
        let [friction_raster, keep_out, keep_in] = overlays(&mut entries, &surface, terrain.as_ref());
        let layers = super::layers::layers(&mut entries, terrain.as_ref());
        let derating = super::derating::derating(&mut entries, &hopper, &surface);
        let drive = super::drive::drive(&mut entries, terrain.as_ref(), route, hopper.limits());
        let drives = drive.as_ref().is_some_and(|keys| keys.travel.drives());
        super::layers::check_of_paths(&mut entries, &layers, route, drives);
        let mission = super::mission::mission(&mut entries, terrain.as_ref(), route, drives);
        super::legs::check(&mut entries, &legs, (drives, mission.is_some()), &layers);
        let uncertainty = super::trials::trials(&mut entries, terrain.as_ref());
        let budget = super::budget::budget(&entries);
        let limits_totals = budget.limits_totals() || layers.iter().any(|layer| layer.total_budget().is_some());
        let (objective, commands, wanted_angle) =
            super::budget::objective(&mut entries, (budget, limits_totals), &hopper, uncertainty.as_ref(), drives);
        let (objective, commands) = match mesh_search.planner {
            RoadmapPlanner::Exact => (objective, commands),
            RoadmapPlanner::Prm => (Some(super::mesh_planner::objective_of_prm()), SearchedCommands::Distinct),
        };
        let (risk, risk_extra_hops_max) = super::trials::risk(&mut entries, uncertainty.as_ref(), (budget, limits_totals));
        // Nothing estimates the reliability of hops over a mesh.
        let over_mesh = matches!(terrain, Some(TerrainSource::MeshInSpace { .. }));
        // The time of a mission that drives is no count of hops beside which reliability is weighed; its objective may have risk.
        let (risk, risk_extra_hops_max) =
            if over_mesh || drives { (ReliabilityUse::Ignored, None) } else { (risk, risk_extra_hops_max) };
        super::budget::check(&mut entries, (budget, limits_totals), risk, uncertainty.as_ref());
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
            legs,
            surface,
            groups: entries.face_groups("surface", "group"),
            friction_raster,
            keep_out,
            keep_in,
            layers,
            terrain,
            accept_map_scale: entries.flag("terrain", "accept_map_scale"),
            no_data: entries.no_data("terrain", "no_data"),
            via,
            route,
            start_x_m: entries.number("terrain", "start_x_m"),
            goal_x_m: entries.number("terrain", "goal_x_m"),
            search,
            mesh_search,
            risk,
            risk_extra_hops_max,
            budget,
            objective,
            commands,
            derating,
            uncertainty,
            drive,
            mission,
            title: entries.text("report", "title").map(str::to_owned),
        })
    }
}

impl Scenario {
    /// How it drives, where it does.
    pub fn drives(&self) -> Option<&DriveKeys> {
        self.drive.as_ref().filter(|keys| keys.travel.drives())
    }

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
        radius_m: number("radius_m"),
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

/// The files of the overlays on the terrain: friction raster, keep-out and keep-in zones.
fn overlays(entries: &mut Entries, surface: &SurfaceProperties, terrain: Option<&TerrainSource>) -> [Option<PathBuf>; 3] {
    let own_columns = [("friction_raster", "friction_coefficient"), ("keep_out", "keep_out"), ("keep_in", "keep_out")];
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
