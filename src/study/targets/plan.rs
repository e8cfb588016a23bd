//! Plans of missions over targets.

use super::super::{
    Case, JourneyError,
    free_route::{FoundRoute, Unrolled, gap_record, left_out, lower_bound, refused_stop},
    free_trials::with_success,
    nodes::{coarse_nodes, level_hop_m},
    to_go::ToGo,
};
use super::search::TargetsSearch;
use crate::{
    graph::{Outcome, proof::ProofVerdict},
    ground::{DemGround, MapPosition},
    path::{Hop, HopPath},
    planner::{Amount, Amounts, FreeRoute, RouteWork, Tour, TourLeg, WhyLeftOut, fewest_hops_of_visits},
    progress::Progress,
    quantity::MapPoint,
    report::{
        AmountRecord, DeratingRecord, HopRecord, LeftOutRecord, ObjectiveRecord, OverBudgetRecord, PropellantShortage,
        TargetHopRecord, TargetRecord, TargetsAnswer, TargetsSearchRecord, TotalsRecord, TripRecord, VisitRecord, WhyRecord,
        path_geojson, write_target_hops_csv,
    },
    scenario::Scenario,
};

/// A planned mission over targets, with everything that its views need.
#[derive(Clone, Debug)]
pub struct TargetsPlanned {
    /// What was asked.
    pub case: Case,
    /// The ground under the limits that planning may use.
    pub ground: DemGround,
    /// The result of the search.
    pub tour: Tour,
    /// The start, then the targets as listed.
    pub stops: Vec<MapPoint>,
    /// The legs as they are flown.
    pub(super) legs: Vec<FlownLeg>,
    /// The whole path on one unrolled chain; `None` if no target can be visited.
    pub(super) whole: Option<(Case, HopPath)>,
    /// The answer as plain data.
    pub answer: TargetsAnswer,
    /// Warnings about the search and the path.
    pub warnings: Vec<String>,
}

/// A leg on its own unrolled chain.
#[derive(Clone, Debug)]
pub(super) struct FlownLeg {
    pub(super) route: std::sync::Arc<FoundRoute>,
    /// What its trials replan by, where the choice of the path found it.
    pub(super) to_go: Option<ToGo>,
}

impl FlownLeg {
    fn hops(&self) -> &[Hop] {
        self.route.path.as_ref().map_or(&[], |path| &path.hops)
    }
}

/// Plans the mission that visits the most targets, of those the best by the objective of a scenario with `[mission]`, within its budgets; flies
/// it again.
///
/// Where the scenario has errors and leaves the choice of paths to its reliability, each leg is the most reliable path about its best one, as a
/// path to one goal is; the order of visits is that of the best legs.
///
/// # Errors
/// [`JourneyError`].
pub fn targets_plan(case: &Case, progress: &dyn Progress) -> Result<TargetsPlanned, JourneyError> {
    let mut search = TargetsSearch::of(case)?;
    let tour = search.best(progress)?;
    let legs = tour.legs.iter().map(|leg| flown_leg(&mut search, leg, progress)).collect::<Result<Vec<_>, _>>()?;
    let whole = (!legs.is_empty()).then(|| joined(&search, &legs)).transpose()?;
    let path = whole.as_ref().and_then(|whole| whole.path.clone());
    let warnings = warnings(&search, &tour, &legs, path.as_ref());
    let answer = answer(&search, &tour, &legs, path.as_ref());
    let whole = whole.and_then(|Unrolled { case, path, .. }| Some((case, path?)));
    let TargetsSearch { free, stops, .. } = search;
    Ok(TargetsPlanned { case: free.case, ground: free.ground, tour, stops, legs, whole, answer, warnings })
}

/// A leg as it is flown: where errors decide, by its most reliable path.
fn flown_leg(search: &mut TargetsSearch, leg: &TourLeg, progress: &dyn Progress) -> Result<FlownLeg, JourneyError> {
    (search.free.goal.start, search.free.goal.goal) = (search.stops[leg.from], search.stops[leg.to]);
    let route = FreeRoute {
        nearest: leg.path.places[leg.path.places.len() - 1],
        path: Some(leg.path.clone()),
        within: true,
        unmet: Vec::new(),
        capped: false,
        gap: None,
        work: RouteWork::default(),
    };
    let (found, searched) = with_success(&search.free, &route, progress)?;
    Ok(FlownLeg { route: std::sync::Arc::new(found), to_go: searched.to_go })
}

/// All legs on one unrolled chain, flown again there and over the DEM.
fn joined(search: &TargetsSearch, legs: &[FlownLeg]) -> Result<Unrolled, JourneyError> {
    let place = |point: &crate::ground::ContactPoint| {
        let at = point.map()?;
        Some(MapPosition { at, z_m: point.point_m.z })
    };
    let first = legs.iter().flat_map(FlownLeg::hops).next().and_then(|hop| place(&hop.takeoff));
    let landings = legs.iter().flat_map(FlownLeg::hops).filter_map(|hop| place(&hop.landing));
    let places: Vec<MapPosition> = first.into_iter().chain(landings).collect();
    let mut laid = search.free.laid_over(&places, None)?;
    let of_legs = legs.iter().flat_map(|leg| match &leg.route.found.outcome {
        Outcome::Path { legs, .. } => legs.as_slice(),
        _ => &[],
    });
    for (leg, own) in laid.legs.iter_mut().zip(of_legs) {
        leg.loft = own.loft;
    }
    search.free.flown(laid)
}

impl TargetsPlanned {
    /// Whether all targets are visited, within all limits.
    pub fn is_traversable(&self) -> bool {
        self.answer.is_traversable()
    }

    /// The whole path; `None` if no target is visited.
    pub fn path(&self) -> Option<&HopPath> {
        self.whole.as_ref().map(|(_, path)| path)
    }

    /// The case whose chain is unrolled along the whole path; the case itself without one.
    pub fn flown_case(&self) -> &Case {
        self.whole.as_ref().map_or(&self.case, |(case, _)| case)
    }

    /// Writes the hops as CSV: the columns of a path, and the target that each leads to.
    ///
    /// # Errors
    /// [`std::io::Error`] from `out`.
    pub fn write_csv(&self, out: &mut dyn std::io::Write) -> std::io::Result<()> {
        write_target_hops_csv(&self.answer.path, self.case.map_knowledge(), out)
    }

    /// The path as GeoJSON; `None` if no target is visited.
    pub fn geojson(&self) -> Option<String> {
        path_geojson(self.path()?, self.case.scenario.body.gravity.m_s2(), self.case.prepared.projection.as_ref())
    }

    /// What the mission takes; `None` if no target is visited.
    pub(in crate::study) const fn totals_record(&self) -> Option<TotalsRecord> {
        self.answer.totals
    }
}

/// What is to be known about the answer.
fn warnings(search: &TargetsSearch, tour: &Tour, legs: &[FlownLeg], path: Option<&HopPath>) -> Vec<String> {
    let scenario = search.scenario();
    let mut warnings = left_out(scenario);
    let spacing_m = search.free.nodes.lattice().spacing_m();
    warnings.extend(coarse_nodes(level_hop_m(&search.free.ground), "the mission", spacing_m));
    let is_left_out = |stop: usize| stop == 0 && legs.is_empty() || tour.left_out.iter().any(|(target, _)| *target == stop);
    let stops = search.stops.iter().enumerate().filter(|(stop, _)| is_left_out(*stop));
    warnings.extend(stops.filter_map(|(stop, at)| refused_stop(&search.free.ground, &stop_name(stop), *at)));
    if tour.capped {
        warnings.push(
            "the search left out labels because there were too many: the mission is not proved to be the best, and more targets may be possible"
                .to_owned(),
        );
    }
    for (leg, flown) in tour.legs.iter().zip(legs) {
        for warning in flown.route.warnings.iter().filter(|warning| !warnings.contains(*warning)).cloned().collect::<Vec<_>>() {
            warnings.push(format!("{}: {warning}", leg_name(leg)));
        }
    }
    warnings.extend(path.iter().flat_map(|path| scenario.path_warnings(path)));
    let mut seen = Vec::new();
    warnings.retain(|warning| {
        let is_new = !seen.contains(warning);
        seen.push(warning.clone());
        is_new
    });
    warnings
}

/// A leg in words.
fn leg_name(leg: &TourLeg) -> String {
    format!("from {} to {}", stop_name(leg.from), stop_name(leg.to))
}

/// A stop in words.
fn stop_name(stop: usize) -> String {
    if stop == 0 { "the start".to_owned() } else { format!("target {stop}") }
}

/// What a leg takes as it is flown. One that does not begin the mission begins with the time to settle.
fn amounts_of(number: usize, flown: &FlownLeg, scenario: &Scenario) -> Amounts {
    let Some(path) = &flown.route.path else { return Amounts::NONE };
    let amounts = path.amounts();
    let settling_s = if number == 0 || path.hops.is_empty() { 0.0 } else { scenario.hopper.limits().settling_s().unwrap_or(0.0) };
    amounts.with(Amount::MissionTime, amounts.of(Amount::MissionTime) + settling_s)
}

fn answer(search: &TargetsSearch, tour: &Tour, legs: &[FlownLeg], path: Option<&HopPath>) -> TargetsAnswer {
    let (free, scenario, stops) = (&search.free, search.scenario(), &search.stops);
    let budgets = scenario.limited_totals();
    let objective = ObjectiveRecord::new(&free.objective, &budgets, (path.map(|_| tour.totals), &[], tour.capped));
    let objective = path.map_or_else(|| objective.clone(), |path| objective.clone().flown(&path.amounts()));
    let propellant_shortage = path.and_then(|path| PropellantShortage::of(&path.totals));
    let is_whole = tour.left_out.is_empty();
    let outages = path.map_or_else(Vec::new, |path| free.outages(path));
    let keeps_outages = outages.iter().all(|outage| outage.met);
    let is_traversable = is_whole && propellant_shortage.is_none() && objective.is_met() && keeps_outages;
    let place = |at: MapPoint| free.ground.position(at).map_or([at.x, at.y, f64::NAN], |place| point(&place));
    let bound = |[from, to]: [usize; 2]| lower_bound(&free.ground, [stops[from], stops[to]]);
    let visits = visits(search, tour, legs);
    let visit_of = |target: usize| visits.iter().find(|visit| visit.target == Some(target)).map(|visit| visit.visit);
    let why_of = |target: usize| tour.left_out.iter().find(|(left_out, _)| *left_out == target);
    let target = |target: usize| TargetRecord {
        target,
        at_m: place(stops[target]),
        visit: visit_of(target),
        left_out: why_of(target).map(|(_, why)| why_record(why, scenario)),
    };
    TargetsAnswer {
        start_m: place(stops[0]),
        order: search.keys.order,
        return_to_start: search.keys.return_to_start,
        verdict: if is_traversable { ProofVerdict::Traversable } else { ProofVerdict::Open },
        targets: (1..stops.len()).map(target).collect(),
        targets_visited: stops.len() - 1 - tour.left_out.len(),
        best_over_nodes: !tour.capped,
        hops: path.map(|path| path.hops.len() as u64),
        hops_lower_bound: fewest_hops_of_visits(&bound, stops.len() - 1, search.keys.order, search.keys.return_to_start),
        objective,
        outages,
        layer_costs: path.map_or_else(Vec::new, |path| AmountRecord::of_layers(&path.totals.layers)),
        derating: DeratingRecord::of(&scenario.derating),
        propellant_shortage,
        search: TargetsSearchRecord {
            nodes_per_post: free.nodes.lattice().nodes_per_post(),
            node_spacing_m: free.nodes.lattice().spacing_m(),
            nodes: free.nodes.count(),
            legs: tour.work.legs_searched,
            pairs_tested: tour.work.pairs_tested,
        },
        verified: path.map(|_| true),
        path: hops(search, tour, legs, path),
        visits,
        totals: path.map(|path| TotalsRecord::from(&path.totals)),
    }
}

/// The visits, with what the mission takes to each of them.
fn visits(search: &TargetsSearch, tour: &Tour, legs: &[FlownLeg]) -> Vec<VisitRecord> {
    let (free, stops, scenario) = (&search.free, &search.stops, search.scenario());
    let mut sums = Amounts::NONE;
    let visit = |(number, (leg, flown)): (usize, (&TourLeg, &FlownLeg))| {
        let amounts = amounts_of(number, flown, scenario);
        sums = sums.then(&amounts);
        let [from, to] = [stops[leg.from], stops[leg.to]];
        VisitRecord {
            visit: number + 1,
            from_target: (leg.from > 0).then_some(leg.from),
            target: (leg.to > 0).then_some(leg.to),
            at_m: leg.path.places.last().map_or([to.x, to.y, f64::NAN], point),
            straight_line_m: (to - from).norm(),
            hops_lower_bound: lower_bound(&free.ground, [from, to]),
            leg: TripRecord::new(&amounts),
            arrival: TripRecord::new(&sums),
        }
    };
    tour.legs.iter().zip(legs).enumerate().map(visit).collect()
}

/// The hops as rows, each with the target that it leads to.
fn hops(search: &TargetsSearch, tour: &Tour, legs: &[FlownLeg], path: Option<&HopPath>) -> Vec<TargetHopRecord> {
    let Some(path) = path else { return Vec::new() };
    let rows = HopRecord::rows(path, search.free.case.prepared.projection.as_ref());
    let of_legs = tour.legs.iter().zip(legs).enumerate();
    let stops = of_legs
        .flat_map(|(number, (leg, flown))| std::iter::repeat_n((number + 1, (leg.to > 0).then_some(leg.to)), flown.hops().len()));
    rows.into_iter().zip(stops).map(|(hop, (visit, target))| TargetHopRecord { visit, target, hop }).collect()
}

fn why_record(why: &WhyLeftOut, scenario: &Scenario) -> LeftOutRecord {
    let of = |why| LeftOutRecord { why, nearest_m: None, gap: None, over: Vec::new() };
    match why {
        WhyLeftOut::NotReached { reached, nearest, gap } => LeftOutRecord {
            nearest_m: Some(point(nearest)),
            gap: Some(gap_record(gap, *reached, scenario)),
            ..of(WhyRecord::NotReached)
        },
        WhyLeftOut::NoWayBack => of(WhyRecord::NoWayBack),
        WhyLeftOut::NotTogether => of(WhyRecord::NotTogether),
        WhyLeftOut::Outages => of(WhyRecord::Outages),
        WhyLeftOut::Budgets(over) => {
            let row =
                |over: &crate::planner::OverBudget| OverBudgetRecord { amount: over.amount, total: over.total, max: over.most };
            LeftOutRecord { over: over.iter().map(row).collect(), ..of(WhyRecord::Budgets) }
        }
    }
}

fn point(place: &MapPosition) -> [f64; 3] {
    [place.at.x, place.at.y, place.z_m]
}
