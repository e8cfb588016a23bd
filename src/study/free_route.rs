//! A route over a DEM in any direction: the search, and the route unrolled to a chain along which it is flown, drawn and listed.

use std::path::Path;

use super::{
    Case, CaseError, Commands, Defect, DriveDefect, JourneyError, Prepared, SimulateError,
    dem_ground::dem_ground,
    free_size::RouteSize,
    free_trials::commanded,
    gap_keys::gap_keys,
    nodes::{coarse_nodes, level_hop_m, nodes_per_post},
    objective,
    overlays::planned_over,
};
use crate::{
    ballistics::{PathBounds, TakeoffChoice},
    chain::Station,
    graph::{self, Edge, Leg, NodeSet, Outcome, PointSpacing, RefusalCounts, ReliabilityUse, SearchError},
    ground::{ContactPoint, DemGround, MapPosition, Surface},
    hop::HopTest,
    path::{Execution, Hop, HopPath, execute, longest_outage},
    planner::{
        Amount, Budgets, FreeRoute, LabelCap, Objective, RouteError, RouteGap, RouteGoal, RoutePath, RouteQuestion,
        SearchedCommands, SurfaceLattice, SurfaceNodes, free_route_by,
    },
    progress::Progress,
    quantity::{MapPoint, VertexId},
    report::{CheckAnswer, DeratingRecord, ObjectiveRecord, OutageRecord, RouteGapRecord, RouteKind, RouteRecord},
    scenario::{Route, Scenario, TerrainSource},
    terrain::{Layer, MapPlace, TerrainError},
    world::LayerName,
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
    /// More memory than allowed.
    #[error(
        "the search for a free route needs at least {} MiB ({nodes} nodes), expected at most {} MiB: take a larger spacing of nodes or a part \
         of the DEM (gdal_translate -projwin), or allow more", needed_bytes.div_ceil(1 << 20), allowed_bytes >> 20
    )]
    TooMuchMemory {
        /// The bytes needed at least.
        needed_bytes: u64,
        /// The bytes allowed.
        allowed_bytes: u64,
        /// The nodes.
        nodes: u64,
    },
    /// A hop of the route that its slice on the unrolled chain does not have.
    #[error(
        "hop {hop} of the route is not feasible along its unrolled chain; this is a defect of chta, please report it with the scenario"
    )]
    Lost {
        /// Which hop, from 1.
        hop: usize,
    },
    /// Two stops of a mission at one place.
    #[error(
        "{second} is at the same place as {first}, expected different places: a mission begins at its start and visits a target once"
    )]
    SameStop {
        /// The first of them.
        first: String,
        /// The second.
        second: String,
    },
    /// A target whose place on the map is not known.
    #[error(transparent)]
    Target(Box<TerrainError>),
    /// A route that does not pass the independent checker.
    #[error(transparent)]
    Defect(#[from] Defect),
    /// A drive leg that does not.
    #[error(transparent)]
    Drive(DriveDefect),
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

/// Refuses what only a free route has.
///
/// # Errors
/// [`CaseError::FreeOnly`] for a transect.
pub(super) fn free_alone(scenario: &Scenario, question: &'static str) -> Result<(), CaseError> {
    match scenario.route {
        Route::Free => Ok(()),
        Route::Transect => Err(CaseError::FreeOnly { question }),
    }
}

/// Refuses a scenario that drives.
///
/// # Errors
/// [`CaseError::HopsOnly`].
pub(super) fn hops_alone(scenario: &Scenario, question: &'static str) -> Result<(), CaseError> {
    if scenario.drives().is_some() { Err(CaseError::HopsOnly { question }) } else { Ok(()) }
}

/// Refuses a scenario with layers that count along whole paths, by outages or costs.
///
/// # Errors
/// [`CaseError::Outage`] and [`CaseError::LayerCost`].
pub(super) fn without_layers_of_paths(scenario: &Scenario, question: &'static str) -> Result<(), CaseError> {
    without_outages(scenario, question)?;
    let found = scenario.layers.iter().find(|layer| layer.rule.cost.is_some());
    found.map_or(Ok(()), |layer| Err(CaseError::LayerCost { layer: layer.rule.name, question }))
}

/// Refuses a scenario with layers that may be left for a while.
///
/// # Errors
/// [`CaseError::Outage`].
pub(super) fn without_outages(scenario: &Scenario, question: &'static str) -> Result<(), CaseError> {
    let found = scenario.layers.iter().find(|layer| layer.rule.outage.is_some());
    found.map_or(Ok(()), |layer| Err(CaseError::Outage { layer: layer.rule.name, question }))
}

/// What is to be known where hops are judged each by itself: layers that may be left for a while do not refuse them, and costs do not count.
pub(super) fn outages_not_counted(scenario: &Scenario) -> impl Iterator<Item = String> + '_ {
    scenario.layers.iter().flat_map(|layer| {
        let name = layer.rule.name;
        let outage = layer
            .rule
            .outage
            .map(|_| format!("layer.{name} may be left for a while, which counts along whole paths: it refuses no hop by itself"));
        outage.into_iter().chain(layer.rule.cost.map(|_| cost_not_counted(name)))
    })
}

/// What is to be known of a layer with a cost where hops are judged each by itself.
fn cost_not_counted(layer: LayerName) -> String {
    format!("layer.{layer} has a cost, which counts along whole paths: it is not stated of a hop by itself")
}

/// Of a stop that refuses every contact: which layer does not hold there.
pub(super) fn refused_stop(ground: &DemGround, name: &str, at: MapPoint) -> Option<String> {
    let layer = ground.layers().refusing_contact(at)?;
    Some(format!("layer {layer} does not hold at {name}, so that no hop begins or ends there"))
}

/// Refuses a scenario that visits several targets.
///
/// # Errors
/// [`CaseError::OneGoal`].
pub(super) fn one_goal(scenario: &Scenario, question: &'static str) -> Result<(), CaseError> {
    if scenario.mission.is_some() { Err(CaseError::OneGoal { question }) } else { Ok(()) }
}

/// What a search for free routes is asked of.
pub(super) struct FreeSearch {
    /// The case, for exact commands.
    pub(super) case: Case,
    /// The whole ground under the limits that planning may use.
    pub(super) ground: DemGround,
    pub(super) nodes: SurfaceNodes,
    pub(super) goal: RouteGoal,
    ends: (Station, Station),
    /// What is to be least, and the greatest totals.
    pub(super) objective: Objective,
    pub(super) budgets: Budgets,
    /// How many labels it may keep.
    pub(super) cap: LabelCap,
    /// Where layers that exempt targets count as met.
    pub(super) exempt: Vec<MapPoint>,
}

/// Chooses nodes for a case over its ground, with start and goal.
pub(super) type NodesOf<'n> = dyn Fn(&Case, &DemGround, [MapPoint; 2]) -> Result<SurfaceNodes, JourneyError> + 'n;

impl FreeSearch {
    /// Over the nodes of a journey from start to goal.
    ///
    /// # Errors
    /// [`JourneyError`].
    pub(super) fn of(case: &Case) -> Result<Self, JourneyError> {
        Self::over(case, &nodes)
    }

    /// Over nodes of a case and its ground, with the start and the goal.
    ///
    /// # Errors
    /// [`JourneyError`].
    pub(super) fn over(case: &Case, nodes: &NodesOf<'_>) -> Result<Self, JourneyError> {
        let case = case.with_commands(Commands::Exact)?;
        let ends = case.ends()?;
        let geometry = case.planning().chain.geometry();
        let at = |station: &Station| geometry.map_point(station).ok_or(FreeRouteError::NoDem);
        let (start, goal) = (at(&ends.0)?, at(&ends.1)?);
        let ground = planning_ground(&case)?;
        let nodes = nodes(&case, &ground, [start, goal])?;
        let search = &case.scenario.search;
        let goal = RouteGoal { start, goal, effort: search.effort, takeoff: search.takeoff };
        let (objective, budgets) = (case.scenario.full_objective(), case.scenario.total_budgets());
        let cap = RouteSize::of(&ground, &nodes, &objective, &budgets).cap(case.memory_max_bytes)?;
        let exempt = vec![goal.goal];
        Ok(Self { case, ground, nodes, goal, ends, objective, budgets, cap, exempt })
    }

    /// What it takes at most.
    pub(super) fn size(&self) -> RouteSize {
        RouteSize::of(&self.ground, &self.nodes, &self.objective, &self.budgets)
    }

    /// The best route by the objective, within the budgets.
    ///
    /// # Errors
    /// [`JourneyError`].
    pub(super) fn route(&self, progress: &dyn Progress) -> Result<FreeRoute, JourneyError> {
        let scenario = &self.case.scenario;
        let by_risk = self.objective.amounts().contains(&Amount::Risk);
        let whole = dem_ground(&self.case).map_err(Box::new)?;
        let errors = scenario.uncertainty.as_ref().filter(|_| by_risk).map(|keys| &keys.errors);
        let question = RouteQuestion {
            objective: &self.objective,
            budgets: &self.budgets,
            commands: scenario.commands,
            errors: errors.zip(whole.as_ref()),
            cap: self.cap,
        };
        Ok(free_route_by(&self.ground, &self.nodes, &self.goal, &question, progress)?)
    }

    /// A path on its unrolled chain, with the commands that the search chose.
    pub(super) fn laid(&self, path: &RoutePath, commands: SearchedCommands) -> Result<Laid, JourneyError> {
        let choices = (commands == SearchedCommands::Distinct).then_some(path.choices.as_slice());
        self.laid_over(&path.places, choices)
    }

    /// The same over places, with the commands of these choices, or of the one of all hops.
    pub(super) fn laid_over(&self, places: &[MapPosition], choices: Option<&[TakeoffChoice]>) -> Result<Laid, JourneyError> {
        let case = unrolled(&self.case, places)?;
        let test = case.hop_test();
        let legs = legs(&test, places, choices)?;
        Ok(Laid { case, test, legs })
    }

    /// A path flown again over its unrolled chain and over the DEM.
    pub(super) fn flown(&self, Laid { case, test, legs }: Laid) -> Result<Unrolled, JourneyError> {
        let ends = match (legs.first(), legs.last()) {
            (Some(first), Some(last)) => (first.takeoff, last.landing),
            _ => case.ends()?,
        };
        // Exact commands of single hops: neither too many to list, nor without a command.
        let flown = case.planning().path(&test, &legs, &self.case.scenario.search).ok();
        if let Some(path) = &flown {
            verify(case.planning(), &self.ground, path, ends)?;
        }
        Ok(Unrolled { case, test, legs, ends, path: flown })
    }

    /// The longest outages of a path, of every layer that may be left for a while.
    pub(super) fn outages(&self, path: &HopPath) -> Vec<OutageRecord> {
        let hopper = self.case.scenario.hopper.limits();
        let record = |layer: &Layer| {
            let limit = layer.rule().outage?;
            Some(OutageRecord::new(&longest_outage(path, hopper, layer, &self.exempt), &limit))
        };
        self.ground.layers().iter().filter_map(record).collect()
    }

    /// What the answer says of the objective, for a scenario that plans by one.
    fn objective_record(&self, route: &FreeRoute) -> Option<ObjectiveRecord> {
        let scenario = &self.case.scenario;
        let said = (route.path.as_ref().map(|path| path.totals), route.unmet.as_slice(), route.capped);
        let budgets = scenario.limited_totals();
        scenario.plans_by_objective().then(|| ObjectiveRecord::new(&self.objective, &budgets, said))
    }

    /// What is to be known about the answer.
    fn warnings(&self, route: &FreeRoute) -> Vec<String> {
        let path = route.path.as_ref();
        let scenario = &self.case.scenario;
        let mut warnings = left_out(scenario);
        warnings.extend(coarse_nodes(level_hop_m(&self.ground), "the free route", self.nodes.lattice().spacing_m()));
        let ends = [("the start", self.goal.start), ("the goal", self.goal.goal)];
        warnings.extend(ends.iter().filter(|_| path.is_none()).filter_map(|(name, at)| refused_stop(&self.ground, name, *at)));
        if scenario.plans_by_objective() {
            #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
            let spanned =
                |path: &RoutePath| path.totals.of(Amount::Distance) / path.choices.len() as f64 / self.nodes.lattice().spacing_m();
            warnings.extend(objective::warnings(scenario, path.filter(|path| !path.choices.is_empty()).map(spanned)));
        } else if route.capped {
            warnings.push(
                "the search left out labels because there were too many: the path has the fewest hops over these nodes, and perhaps not the least \
                 effort; fewer nodes or more memory leave out fewer"
                    .to_owned(),
            );
        }
        warnings
    }

    /// What was found, with a path of the route on its unrolled chain, which is flown again there and over the DEM.
    ///
    /// # Errors
    /// [`JourneyError`].
    pub(super) fn found(&self, route: &FreeRoute, laid: Option<Laid>) -> Result<FoundRoute, JourneyError> {
        let case = &self.case;
        let mut warnings = self.warnings(route);
        let answer = |outcome| graph::Answer {
            outcome,
            spacing: PointSpacing::AtMostM(self.nodes.lattice().spacing_m()),
            points_per_segment: 0,
            nodes: self.nodes.count(),
            pairs_tested: route.work.pairs_tested,
            refusals: RefusalCounts::default(),
        };
        let lower = lower_bound(&self.ground, [self.goal.start, self.goal.goal]);
        let checked = |test: &HopTest, ends: &(Station, Station), found: &graph::Answer| {
            let check = CheckAnswer::new(test, ends.0.point.x_m, ends.1.point.x_m, found, self.goal.effort);
            let check =
                check.with_objective(self.objective_record(route)).with_derating(DeratingRecord::of(&case.scenario.derating));
            CheckAnswer { hops_lower_bound: lower, route: Some(record(&self.nodes, route, &case.scenario)), ..check }
        };
        let Some(laid) = laid else {
            // No station of a chain stands for where a route in any direction ends; the record has the places.
            let (test, found, ends) = (case.hop_test(), answer(Outcome::EndpointsRefuse(Vec::new())), self.ends);
            let check = checked(&test, &ends, &found);
            return Ok(FoundRoute { test, ends, found, check, path: None, warnings, case: case.clone() });
        };
        let (laid, cost) = commanded(laid)?;
        let Unrolled { case: unrolled, test, legs, ends, path } = self.flown(laid)?;
        warnings.extend(path.iter().flat_map(|path| case.scenario.path_warnings(path)));
        let found = answer(Outcome::Path { legs, cost });
        let outages = path.as_ref().map_or_else(Vec::new, |path| self.outages(path));
        let check = checked(&test, &ends, &found).with_path(path.as_ref()).with_outages(outages);
        Ok(FoundRoute { test, ends, found, check, path, warnings, case: unrolled })
    }
}

/// A route on its unrolled chain.
pub(super) struct Laid {
    pub(super) case: Case,
    pub(super) test: HopTest,
    pub(super) legs: Vec<Leg>,
}

/// The same, flown.
pub(super) struct Unrolled {
    pub(super) case: Case,
    pub(super) test: HopTest,
    pub(super) legs: Vec<Leg>,
    pub(super) ends: (Station, Station),
    pub(super) path: Option<HopPath>,
}

/// What a free route leaves out of a scenario.
pub(super) fn left_out(scenario: &Scenario) -> Vec<String> {
    let mut warnings = Vec::new();
    if scenario.uncertainty.is_none() && scenario.risk != ReliabilityUse::Ignored {
        warnings.push(format!(
            "search.risk = \"{}\" is without effect on a free route, which has no [uncertainty]: its reliability is that of trials under errors",
            scenario.risk.name()
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

/// The lattice as fine as the scenario says.
pub(super) fn lattice(case: &Case, ground: &DemGround) -> Result<SurfaceLattice, JourneyError> {
    let dem = ground.terrain().dem();
    let lattice = SurfaceLattice::new(dem, nodes_per_post(case.scenario.search.spacing, dem, level_hop_m(ground)));
    // Before a slice is filled with as many.
    SurfaceNodes::check(&lattice, 0).map_err(RouteError::from)?;
    Ok(lattice)
}

/// The lattice, start and goal, and the nodes of the straight slice between them.
fn nodes(case: &Case, ground: &DemGround, ends: [MapPoint; 2]) -> Result<SurfaceNodes, JourneyError> {
    let (lattice, chain) = (lattice(case, ground)?, &case.planning().chain);
    let of_slice = NodeSet::of_chain(chain, PointSpacing::AtMostM(lattice.spacing_m())).map_err(SearchError::from)?;
    let places = of_slice.stations().iter().filter_map(|station| chain.geometry().map_point(station));
    SurfaceNodes::new(ground, lattice, ends.into_iter().chain(places)).map_err(|error| RouteError::from(error).into())
}

/// What no path between two places takes fewer hops than; `None` without ground, or where nothing hops.
pub(super) fn lower_bound(ground: &DemGround, ends: [MapPoint; 2]) -> Option<u64> {
    let limits = ground.hopper().limits();
    let bounds = PathBounds::new(limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s(), ground.gravity_m_s2());
    let [from, to] = ends.map(|at| ground.position(at));
    let (from, to) = (from?, to?);
    bounds.hops(libm::hypot(to.at.x - from.at.x, to.at.y - from.at.y), to.z_m - from.z_m)
}

fn record(nodes: &SurfaceNodes, route: &FreeRoute, scenario: &Scenario) -> RouteRecord {
    let place = |at: &MapPosition| [at.at.x, at.at.y, at.z_m];
    RouteRecord {
        kind: RouteKind::Free,
        nodes_per_post: nodes.lattice().nodes_per_post(),
        node_spacing_m: nodes.lattice().spacing_m(),
        search_bytes: FreeRoute::bytes(nodes),
        reached_nodes: route.work.reached,
        nearest_m: place(&route.nearest),
        gap: route.gap.as_ref().map(|gap| gap_record(gap, route.work.reached, scenario)),
    }
}

/// What lies between so many places reached and those that lead to the goal.
pub(super) fn gap_record(gap: &RouteGap, reached: usize, scenario: &Scenario) -> RouteGapRecord {
    let leads_from = &gap.leads_from;
    RouteGapRecord {
        leads_to_goal_from_m: [leads_from.at.x, leads_from.at.y, leads_from.z_m],
        leads_to_goal_nodes: gap.leading,
        width_m: gap.width_m,
        pairs: gap.pairs,
        judged_pairs: gap.judged,
        refusals: (&gap.refusals).into(),
        without_ground: gap.without_ground,
        keys: gap_keys(gap, reached, scenario),
    }
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
    Ok(Case::new(scenario, Path::new(&case.base), Commands::Exact)?.asked_by(case))
}

/// One leg from each place to the next, along the unrolled chain, with the commands of these choices, or of the one of all hops.
fn legs(test: &HopTest, places: &[MapPosition], choices: Option<&[TakeoffChoice]>) -> Result<Vec<Leg>, FreeRouteError> {
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
        let choice = choices.and_then(|choices| choices.get(hop));
        let loft = choice.zip(test.line_of_sight(&takeoff, &landing)).map(|(choice, sight)| test.loft(*choice, sight, lofts));
        Ok(Leg { takeoff, landing, edge: Edge::Hop(lofts), loft })
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
    execute(ground, &HopPath { hops: hops.collect(), totals: path.totals }, None)
}
