//! A route over a DEM in any direction: the search, and the route unrolled to a chain along which it is flown, drawn and listed.

use std::path::Path;

use super::{
    Case, CaseError, Commands, Defect, JourneyError, Prepared, SimulateError, dem_ground::dem_ground, free_trials::commanded,
    pipeline::planned_over,
};
use crate::{
    ballistics::{PathBounds, TakeoffChoice},
    chain::Station,
    graph::{self, Edge, Leg, NodeSet, Outcome, PointSpacing, RefusalCounts, ReliabilityUse, SearchError},
    ground::{ContactPoint, DemGround, MapPosition, Surface},
    hop::HopTest,
    path::{Execution, Hop, HopPath, execute},
    planner::{FreeRoute, NodesPerPost, RouteError, RouteGoal, SurfaceLattice, SurfaceNodes, free_route},
    progress::Progress,
    quantity::{MapPoint, VertexId},
    report::{CheckAnswer, DeratingRecord, RouteKind, RouteRecord},
    scenario::{Route, Scenario, TerrainSource},
    terrain::{Dem, MapPlace},
    world::Hopper,
};

/// Why a free route has no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FreeRouteError {
    /// A terrain without a map.
    #[error("terrain.route is \"free\", but the terrain is no dem, expected one, over which every direction is known")]
    NoDem,
    /// The nodes, or their search.
    #[error(transparent)]
    Route(RouteError),
    /// The raster.
    #[error(transparent)]
    Dem(Box<SimulateError>),
    /// A hop of the route that its slice on the unrolled chain does not have.
    #[error(
        "hop {hop} of the route is not feasible along its unrolled chain; this is a defect of chta, please report it with the scenario"
    )]
    Lost {
        /// Which hop, from 1.
        hop: usize,
    },
    /// A route that does not pass the independent checker.
    #[error(transparent)]
    Defect(#[from] Defect),
}

impl From<RouteError> for JourneyError {
    fn from(error: RouteError) -> Self {
        match error {
            RouteError::Cancelled(cancelled) => Self::Search(SearchError::Cancelled(cancelled)),
            other => FreeRouteError::Route(other).into(),
        }
    }
}

/// What was found.
#[derive(Debug)]
pub(super) struct FoundRoute {
    /// The case, its chain unrolled along the route; that of the straight line without one.
    pub(super) case: Case,
    pub(super) test: HopTest,
    pub(super) ends: (Station, Station),
    pub(super) found: graph::Answer,
    pub(super) check: CheckAnswer,
    pub(super) path: Option<HopPath>,
    pub(super) warnings: Vec<String>,
}

/// Refuses what only a transect can.
///
/// # Errors
/// [`CaseError::TransectOnly`] for a free route.
pub(super) fn along_transect(scenario: &Scenario, question: &'static str) -> Result<(), CaseError> {
    match scenario.route {
        Route::Transect => Ok(()),
        Route::Free => Err(CaseError::TransectOnly { question }),
    }
}

/// Searches for the route from the start of a case to its goal, and flies it again over its unrolled chain and over the DEM.
///
/// # Errors
/// [`JourneyError`].
pub(super) fn found_route(case: &Case, progress: &dyn Progress) -> Result<FoundRoute, JourneyError> {
    if case.scenario.plans_by_objective() {
        along_transect(&case.scenario, "a path by an objective or within budgets is found")?;
    }
    let mut warnings = warnings(&case.scenario);
    let case = case.with_commands(Commands::Exact)?;
    let ends = case.ends()?;
    let geometry = case.planning().chain.geometry();
    let at = |station: &Station| geometry.map_point(station).ok_or(FreeRouteError::NoDem);
    let (start, goal) = (at(&ends.0)?, at(&ends.1)?);
    let ground = planning_ground(&case)?;
    let nodes = nodes(&case, &ground, [start, goal])?;
    let search = &case.scenario.search;
    let question = RouteGoal { start, goal, effort: search.effort, takeoff: search.takeoff };
    let route = free_route(&ground, &nodes, &question, progress)?;
    let record = record(&nodes, &route);
    warnings.extend(coarse_nodes(&ground, record.node_spacing_m));
    let answer = |outcome| graph::Answer {
        outcome,
        spacing: PointSpacing::AtMostM(nodes.lattice().spacing_m()),
        points_per_segment: 0,
        nodes: nodes.count(),
        pairs_tested: route.pairs_tested,
        refusals: RefusalCounts::default(),
    };
    let lower = lower_bound(&ground, [start, goal]);
    let checked = |test: &HopTest, ends: &(Station, Station), found: &graph::Answer| {
        let check = CheckAnswer::new(test, ends.0.point.x_m, ends.1.point.x_m, found, search.effort);
        let check = check.with_derating(DeratingRecord::of(&case.scenario.derating));
        CheckAnswer { hops_lower_bound: lower, route: Some(record), ..check }
    };
    let Some(places) = &route.places else {
        // No station of a chain stands for where a route in any direction ends; the record has the nearest place.
        let (test, found) = (case.hop_test(), answer(Outcome::EndpointsRefuse(Vec::new())));
        let check = checked(&test, &ends, &found);
        return Ok(FoundRoute { test, ends, found, check, path: None, warnings, case });
    };
    let unrolled = unrolled(&case, places)?.asked_by(&case);
    let test = unrolled.hop_test();
    let (legs, cost) = commanded(&unrolled, &test, (legs(&test, places)?, route.cost))?;
    let ends = match (legs.first(), legs.last()) {
        (Some(first), Some(last)) => (first.takeoff, last.landing),
        _ => unrolled.ends()?,
    };
    // Exact commands of single hops: neither too many to list, nor without a command.
    let path = unrolled.planning().path(&test, &legs, search).ok();
    if let Some(path) = &path {
        verify(unrolled.planning(), &ground, path, ends)?;
        warnings.extend(case.scenario.path_warnings(path));
    }
    let found = answer(Outcome::Path { legs, cost });
    let check = checked(&test, &ends, &found).with_path(path.as_ref());
    Ok(FoundRoute { test, ends, found, check, path, warnings, case: unrolled })
}

/// What a free route leaves out of a scenario.
fn warnings(scenario: &Scenario) -> Vec<String> {
    let mut warnings = Vec::new();
    if scenario.uncertainty.is_some() && scenario.risk != ReliabilityUse::Ignored {
        let commands = if scenario.search.takeoff == TakeoffChoice::MostReliable {
            "choose the command of each of its hops, and "
        } else {
            ""
        };
        warnings.push(format!(
            "a free route is searched by hops and effort: the errors of [uncertainty] {commands}count where a robot replans, but do not \
             choose the places that the route hops to"
        ));
    }
    if !scenario.hopper.limits().steps.is_continuous() {
        warnings.push(
            "a free route and its trials have exact commands, and this machine takes its commands in steps, which may miss a landing or \
             break a limit"
                .to_owned(),
        );
    }
    warnings
}

/// The whole ground under the limits that planning may use, for exact commands.
fn planning_ground(case: &Case) -> Result<DemGround, FreeRouteError> {
    let ground = dem_ground(case).map_err(|error| FreeRouteError::Dem(Box::new(error)))?.ok_or(FreeRouteError::NoDem)?;
    let scenario = Scenario { hopper: case.scenario.hopper.with_any_command(), ..case.scenario.clone() };
    let exact = if case.scenario.hopper == scenario.hopper {
        ground
    } else {
        DemGround::new(ground.terrain().clone(), &scenario.hopper, scenario.body.gravity, &scenario.surface)
    };
    Ok(planned_over(&exact, &scenario))
}

/// The lattice as fine as the scenario says, start and goal, and the nodes of the straight slice between them.
fn nodes(case: &Case, ground: &DemGround, ends: [MapPoint; 2]) -> Result<SurfaceNodes, JourneyError> {
    let (dem, chain) = (ground.terrain().dem(), &case.planning().chain);
    let lattice = SurfaceLattice::new(dem, nodes_per_post(case.scenario.search.spacing, dem, level_hop_m(ground)));
    // Before the slice is filled with as many.
    SurfaceNodes::check(&lattice, 0).map_err(RouteError::from)?;
    let of_slice = NodeSet::of_chain(chain, PointSpacing::AtMostM(lattice.spacing_m())).map_err(SearchError::from)?;
    let places = of_slice.stations().iter().filter_map(|station| chain.geometry().map_point(station));
    SurfaceNodes::new(ground, lattice, ends.into_iter().chain(places)).map_err(|error| RouteError::from(error).into())
}

/// As many nodes a post spacing as the scenario says; by itself, as a hop of this length over level ground needs.
pub(super) fn nodes_per_post(spacing: Option<PointSpacing>, dem: &Dem, level_hop_m: f64) -> NodesPerPost {
    let post_spacing_m = dem.georeference().dx_m().max(dem.georeference().dy_m());
    match spacing {
        Some(PointSpacing::AtMostM(spacing_m)) => NodesPerPost::at_most_m(spacing_m, post_spacing_m),
        Some(PointSpacing::PerSegment(_)) | None => NodesPerPost::auto(level_hop_m, post_spacing_m),
    }
}

/// How far one hop over this ground goes over a level at most, by the speeds, m.
fn level_hop_m(ground: &DemGround) -> f64 {
    level_hop_of_m(ground.hopper(), ground.gravity_m_s2())
}

/// How far one hop of a machine goes over level ground at most, by the speeds, m.
pub(super) fn level_hop_of_m(hopper: &Hopper, gravity_m_s2: f64) -> f64 {
    let limits = hopper.limits();
    let speed_m_s = limits.takeoff_speed_max_m_s.min(limits.arc_landing_speed_max_m_s());
    speed_m_s / gravity_m_s2 * speed_m_s
}

fn lower_bound(ground: &DemGround, ends: [MapPoint; 2]) -> Option<u64> {
    let limits = ground.hopper().limits();
    let bounds = PathBounds::new(limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s(), ground.gravity_m_s2());
    let [from, to] = ends.map(|at| ground.position(at));
    let (from, to) = (from?, to?);
    bounds.hops(libm::hypot(to.at.x - from.at.x, to.at.y - from.at.y), to.z_m - from.z_m)
}

fn record(nodes: &SurfaceNodes, route: &FreeRoute) -> RouteRecord {
    let nearest = route.nearest;
    RouteRecord {
        kind: RouteKind::Free,
        nodes_per_post: nodes.lattice().nodes_per_post(),
        node_spacing_m: nodes.lattice().spacing_m(),
        search_bytes: FreeRoute::bytes(nodes),
        reached_nodes: route.reached,
        nearest_m: [nearest.at.x, nearest.at.y, nearest.z_m],
    }
}

/// A warning where one hop spans few nodes.
fn coarse_nodes(ground: &DemGround, node_spacing_m: f64) -> Option<String> {
    const FEW: f64 = 8.0;
    let spans = level_hop_m(ground) / node_spacing_m;
    (spans < FEW).then(|| {
        format!(
            "one hop over level ground spans {spans:.1} nodes of the free route, {node_spacing_m} m apart, fewer than 8: a smaller \
             search.node_spacing_max_m may save hops"
        )
    })
}

/// The same case over the chain along the places of a route: one slice from each to the next, unrolled.
pub(super) fn unrolled(case: &Case, places: &[MapPosition]) -> Result<Case, CaseError> {
    let (Some(first), Some(last), Some(TerrainSource::Dem { path, .. })) = (places.first(), places.last(), &case.scenario.terrain)
    else {
        return Err(CaseError::NoTerrain);
    };
    let metres = |place: &MapPosition| MapPlace::Metres(place.at);
    let scenario = Scenario {
        terrain: Some(TerrainSource::Dem { path: path.clone(), start: metres(first), goal: metres(last) }),
        via: places.get(1..places.len() - 1).into_iter().flatten().map(metres).collect(),
        route: Route::Transect,
        start_x_m: None,
        goal_x_m: None,
        ..case.scenario.clone()
    };
    Case::new(scenario, Path::new(&case.base), Commands::Exact)
}

/// One leg from each place to the next, along the unrolled chain.
fn legs(test: &HopTest, places: &[MapPosition]) -> Result<Vec<Leg>, FreeRouteError> {
    let geometry = test.chain().geometry();
    let map = geometry.map_points().unwrap_or_default();
    let mut stations = Vec::with_capacity(places.len());
    let mut next = 0;
    for (hop, place) in places.iter().enumerate() {
        let found = map.iter().skip(next).position(|at| *at == place.at).ok_or(FreeRouteError::Lost { hop })?;
        next += found;
        stations.push(geometry.vertex_station(VertexId(next)));
        next += 1;
    }
    let leg = |(hop, ends): (usize, &[Station])| {
        let (takeoff, landing) = (ends[0], ends[1]);
        let lofts = test.lofts(&takeoff, &landing).map_err(|_| FreeRouteError::Lost { hop: hop + 1 })?;
        Ok(Leg { takeoff, landing, edge: Edge::Hop(lofts), loft: None })
    };
    stations.windows(2).enumerate().map(leg).collect()
}

/// Flies a path again by the independent checker: along its unrolled chain, and over the DEM.
fn verify(prepared: &Prepared, ground: &DemGround, path: &HopPath, ends: (Station, Station)) -> Result<(), FreeRouteError> {
    Defect::unless_passed(&prepared.execute(path, ends))?;
    Ok(Defect::unless_passed(&execute_over_dem(ground, path))?)
}

/// A path flown again by the independent checker over the DEM.
pub(super) fn execute_over_dem(ground: &DemGround, path: &HopPath) -> Execution {
    let on_map = |point: &ContactPoint| ContactPoint { station: None, ..*point };
    let hops = path.hops.iter().map(|hop| Hop { takeoff: on_map(&hop.takeoff), landing: on_map(&hop.landing), ..*hop });
    execute(ground, &HopPath::of_hops(hops.collect(), ground.hopper()), None)
}
