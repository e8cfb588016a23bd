//! Plans of missions.

use super::super::{
    Case, JourneyError,
    free_route::left_out,
    front::front_commands,
    nodes::{coarse_nodes, level_hop_m, post_spacing_m},
};
use super::{
    records::{drive_leg, hop_leg, point, sums_record},
    search::TravelSearch,
    walk::{Driven, Stretch, agreed_sums, stretches},
};
use crate::{
    graph::proof::ProofVerdict,
    ground::{DemGround, Surface},
    path::{Hop, HopPath, Totals},
    planner::{Amount, Amounts, Mission, Objective, Travel},
    progress::Progress,
    quantity::Angle,
    report::{
        DeratingRecord, DriveRefusalRecord, HopRecord, ObjectiveRecord, PropellantShortage, TotalsRecord, TravelAlternativeRecord,
        TravelAnswer, TravelFrontRecord, TravelLegRecord, TravelSearchRecord, TravelStopRecord, TravelSumsRecord,
        TravelTotalsRecord, hops_of, mission_geojson,
    },
    scenario::Scenario,
    terrain::Dem,
    world::FrictionCone,
};

/// What is wanted beside the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct TravelOptions {
    /// The same journey by driving alone, by hops alone, by both, and with the fewest hops that make it possible.
    pub alternatives: bool,
    /// A front of hops against this amount.
    pub front: Option<Amount>,
}

/// A planned mission, with everything that its views need.
#[derive(Clone, Debug)]
pub struct TravelPlanned {
    /// What was asked.
    pub case: Case,
    /// The ground under the limits that planning may use.
    pub ground: DemGround,
    /// The result of the search.
    pub mission: Mission,
    pub(super) stretches: Vec<Stretch>,
    /// The answer as plain data.
    pub answer: TravelAnswer,
    /// Warnings about the search and the path.
    pub warnings: Vec<String>,
}

/// Plans the best mission by the objective of a scenario with `[drive]`, within its budgets; drives and flies it again.
///
/// # Errors
/// [`JourneyError`].
pub fn travel_plan(case: &Case, options: TravelOptions, progress: &dyn Progress) -> Result<TravelPlanned, JourneyError> {
    let search = TravelSearch::of(case)?;
    let mission = search.best(progress)?;
    let walked =
        mission.path.as_ref().map(|path| stretches(&search, path, case.scenario.commands)).transpose()?.unwrap_or_default();
    let mut answer = answer(&search, &mission, &walked)?;
    if options.alternatives {
        answer.alternatives = Some(alternatives(&search, &mission, progress)?);
    }
    let hops_max = mission.path.as_ref().map_or(0, |path| hops_of(&path.totals));
    answer.front = options.front.map(|amount| front(&search, (amount, hops_max), progress)).transpose()?;
    let warnings = warnings(&search, &mission);
    Ok(TravelPlanned { case: search.free.case, ground: search.free.ground, mission, stretches: walked, answer, warnings })
}

impl TravelPlanned {
    /// Whether there is a path that the machine can travel.
    pub fn is_traversable(&self) -> bool {
        self.answer.is_traversable()
    }

    /// The mission as GeoJSON over the map; `None` without a path.
    pub fn geojson(&self) -> Option<String> {
        let hops: Vec<Hop> = hops_in(&self.stretches);
        self.mission.path.as_ref()?;
        let gravity_m_s2 = self.case.scenario.body.gravity.m_s2();
        mission_geojson(&self.answer.path, &hops, gravity_m_s2, self.case.prepared.projection.as_ref())
    }

    /// What it takes, as totals of paths are stated; `None` without a path.
    pub(in crate::study) fn totals_record(&self) -> Option<TotalsRecord> {
        let limits = self.ground.hopper().limits();
        self.answer.totals.map(|totals| {
            TotalsRecord::from(&Totals {
                flight_time_s: totals.flight_time_s,
                energy_j_kg: totals.energy_j_kg,
                peak_takeoff_speed_m_s: totals.peak_takeoff_speed_m_s,
                ground_distance_m: totals.distance_m,
                energy_j: totals.energy_j,
                mission_time_s: Some(totals.mission_time_s),
                delta_v_m_s: totals.delta_v_m_s,
                propellant_max_kg: limits.propellant_max_kg,
                ..Totals::default()
            })
        })
    }
}

/// What the wheels of a scenario do not see of a DEM, or of its friction.
pub(super) fn of_wheels(scenario: &Scenario, dem: &Dem) -> Vec<String> {
    let Some(keys) = scenario.drives() else { return Vec::new() };
    let (limits, post_m) = (keys.rover.limits(), post_spacing_m(dem));
    let mut warnings = Vec::new();
    if let Some(wheelbase_m) = limits.wheelbase_m.filter(|wheelbase_m| post_m > *wheelbase_m) {
        warnings.push(format!(
            "the posts of the dem are {post_m} m apart, more than drive.wheelbase_m of {wheelbase_m} m: steps and rocks between posts are unknown, \
             and no limit of [drive] sees them"
        ));
    }
    let steepest = keys.rover.slopes().into_iter().fold(0.0, f64::max);
    let friction = scenario.surface.constant_friction().map(FrictionCone::coefficient);
    if let Some(friction) = friction.filter(|friction| steepest > *friction) {
        warnings.push(format!(
            "wheels may drive slopes of up to {:.1} deg by the limits of [drive], and friction of {friction} holds up to {:.1} deg: they are judged \
             by these limits and drive.slip, not by friction",
            Angle::from_slope(steepest).degrees(),
            Angle::from_slope(friction).degrees()
        ));
    }
    warnings
}

/// What is to be known about the answer.
fn warnings(search: &TravelSearch, mission: &Mission) -> Vec<String> {
    let scenario = search.scenario();
    let mut warnings = left_out(scenario);
    let spacing_m = search.free.nodes.lattice().spacing_m();
    if search.keys.travel.hops() {
        warnings.extend(coarse_nodes(level_hop_m(&search.free.ground), "the mission", spacing_m));
    }
    warnings.extend(of_wheels(scenario, search.free.ground.terrain().dem()));
    if scenario.uncertainty.is_some() && search.keys.travel.hops() && !search.free.objective.amounts().contains(&Amount::Risk) {
        warnings.push(format!(
            "the mission is planned by the objective {}, not by reliability: hops of least amounts stand on the edge of their limits; simulate \
             shows how reliably it is flown",
            search.free.objective
        ));
    }
    if mission.capped {
        warnings.push(
            "the search left out labels because there were too many: the path may not be the best, and another one may keep the budgets"
                .to_owned(),
        );
    }
    warnings
}

/// The same journey by other means over the same nodes.
fn alternatives(
    search: &TravelSearch,
    planned: &Mission,
    progress: &dyn Progress,
) -> Result<Vec<TravelAlternativeRecord>, JourneyError> {
    let objective = &search.free.objective;
    let fewest = Objective::new([Amount::Hops, Amount::MissionTime].to_vec()).unwrap_or_else(|_| Objective::of(Amount::Hops));
    let asked = [(Travel::Drive, objective), (Travel::Hop, objective), (Travel::Both, objective), (Travel::Both, &fewest)];
    let mut rows = Vec::with_capacity(asked.len());
    for (means, wanted) in asked {
        let known = (means == search.keys.travel && wanted == objective).then(|| planned.clone());
        let mission = known.map_or_else(|| search.by(means, wanted, progress), Ok)?;
        let verdict = if mission.path.is_some() && mission.within { ProofVerdict::Traversable } else { ProofVerdict::Open };
        let totals = mission.path.as_ref().map(|path| TravelSumsRecord::new(&path.totals));
        rows.push(TravelAlternativeRecord { travel: means, objective: wanted.amounts().to_vec(), verdict, totals });
    }
    Ok(rows)
}

fn front(
    search: &TravelSearch,
    (amount, hops_max): (Amount, u64),
    progress: &dyn Progress,
) -> Result<TravelFrontRecord, JourneyError> {
    let front = search.front((amount, hops_max), progress)?;
    for path in &front.paths {
        agreed_sums(search, &stretches(search, path, front_commands(search.scenario()).0)?, &path.totals)?;
    }
    let paths = front.paths.iter().map(|path| TravelSumsRecord::new(&path.totals)).collect();
    Ok(TravelFrontRecord { amount, hops_max, labels_capped: front.capped, paths })
}

fn answer(search: &TravelSearch, mission: &Mission, walked: &[Stretch]) -> Result<TravelAnswer, JourneyError> {
    let (free, scenario) = (&search.free, search.scenario());
    let budgets = scenario.budget.totals(&scenario.hopper);
    let found = mission.path.as_ref().map(|path| path.totals);
    let objective = ObjectiveRecord::new(&free.objective, &budgets, (found, &mission.unmet, mission.capped));
    let hops = hops_in(walked);
    let flown = HopPath::of_hops(hops, free.ground.hopper());
    let propellant_shortage = PropellantShortage::of(&flown.totals);
    let is_traversable = mission.path.is_some() && propellant_shortage.is_none() && objective.is_met();
    let ends =
        [free.goal.start, free.goal.goal].map(|at| free.ground.position(at).map_or([at.x, at.y, f64::NAN], |place| point(&place)));
    let totals = found.as_ref().map(|planned| totals(search, walked, (&flown, planned))).transpose()?;
    let lattice = free.nodes.lattice();
    let neighbours = search.keys.rover.limits().neighbours;
    Ok(TravelAnswer {
        travel: search.keys.travel,
        start_m: ends[0],
        goal_m: ends[1],
        straight_line_m: (free.goal.goal - free.goal.start).norm(),
        verdict: if is_traversable { ProofVerdict::Traversable } else { ProofVerdict::Open },
        hops: found.as_ref().map(hops_of),
        hops_lower_bound: 0,
        objective,
        derating: DeratingRecord::of(&scenario.derating),
        propellant_shortage,
        search: TravelSearchRecord {
            nodes_per_post: lattice.nodes_per_post(),
            node_spacing_m: lattice.spacing_m(),
            nodes: free.nodes.count(),
            neighbours: neighbours.count(),
            elongation_max: neighbours.elongation(),
            reached_nodes: mission.work.reached,
            hops_tested: mission.work.hops_tested,
            drives_tested: mission.work.drives_tested,
        },
        stopped: mission.stopped.as_ref().map(|(nearest, refusals)| TravelStopRecord {
            nearest_m: point(nearest),
            drive_refusals: DriveRefusalRecord::rows(refusals),
        }),
        verified: mission.path.as_ref().map(|_| true),
        path: legs(search, walked, &flown),
        totals,
        alternatives: None,
        front: None,
    })
}

/// All hops of a mission.
fn hops_in(walked: &[Stretch]) -> Vec<Hop> {
    let hops = walked.iter().flat_map(|stretch| match stretch {
        Stretch::Hops(path) => path.hops.as_slice(),
        Stretch::Drive(_) => &[],
    });
    hops.copied().collect()
}

/// The sums over the legs, which are those of the search.
fn totals(
    search: &TravelSearch,
    walked: &[Stretch],
    (flown, planned): (&HopPath, &Amounts),
) -> Result<TravelTotalsRecord, JourneyError> {
    let (free, rover) = (&search.free, &search.keys.rover);
    let sums = agreed_sums(search, walked, planned)?;
    let driven: Vec<&Driven> = walked
        .iter()
        .filter_map(|stretch| match stretch {
            Stretch::Drive(driven) => Some(driven),
            Stretch::Hops(_) => None,
        })
        .collect();
    let (limits, stretches) = (free.ground.hopper().limits(), driven.len() as u64);
    Ok(sums_record((limits, rover), (&driven, stretches), flown, sums))
}

/// The legs as rows.
fn legs(search: &TravelSearch, walked: &[Stretch], flown: &HopPath) -> Vec<TravelLegRecord> {
    let projection = search.free.case.prepared.projection.as_ref();
    let mut rows = HopRecord::rows(flown, projection).into_iter().zip(&flown.hops);
    let (mut legs, mut travelled_m) = (Vec::new(), 0.0);
    for stretch in walked {
        match stretch {
            Stretch::Drive(driven) => {
                legs.push(TravelLegRecord::Drive(Box::new(drive_leg(&search.keys.rover, driven, legs.len() + 1))));
                travelled_m += driven.legs.iter().map(|leg| leg.run_m).sum::<f64>();
            }
            Stretch::Hops(path) => {
                for (mut row, hop) in rows.by_ref().take(path.hops.len()) {
                    row.takeoff_x_m = travelled_m;
                    travelled_m += hop.run_m();
                    row.landing_x_m = travelled_m;
                    let ends_mission = hop.landing.map() == Some(search.free.goal.goal);
                    let limits = search.free.ground.hopper().limits();
                    legs.push(TravelLegRecord::Hop(Box::new(hop_leg((limits, ends_mission), (row, hop), legs.len() + 1))));
                }
            }
        }
    }
    legs
}
