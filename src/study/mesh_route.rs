//! A free route over a mesh: through caves, under overhangs, up and down walls.

use std::{fs::File, io::BufReader, path::Path};

use nalgebra::Point3;

use super::{
    Defect, Front, FrontProblem, MeshHopError,
    free_front::are_the_same,
    front::{amount_row, front_commands, front_hops_max},
    mesh_ends::{MeshEnds, mesh_ends},
    mesh_flown::flown_again,
    objective::roadmap_question,
};
use crate::{
    graph::proof::ProofVerdict,
    ground::{MeshContact, MeshGround},
    path::{HopPath, path_over_mesh},
    planner::{
        Amount, LabelCap, Objective,
        roadmap::{
            ContactSampler, GrownRoadmap, JoinTest, NothingWithin, OneByOne, Roadmap, RoadmapEnd, RoadmapFileError, RoadmapGap,
            RoadmapLimits, RoadmapPath, RoadmapPlanner, RoadmapQuestion, SpaceBounds, grow_one_by_one, grow_roadmap, over_roadmap,
        },
    },
    progress::{Cancelled, Progress},
    report::{
        DeratingRecord, FrontRecord, FrontSearchRecord, HopRecord, MeshContactRecord, MeshPlanAnswer, ObjectiveRecord,
        PropellantShortage, RoadmapRecord, TotalsRecord, hops_of,
    },
    scenario::Scenario,
};

/// What is asked.
#[derive(Clone, Debug)]
pub struct MeshRouteQuestion<'a> {
    /// The scenario, with [`TerrainSource::MeshInSpace`](crate::scenario::TerrainSource::MeshInSpace).
    pub scenario: &'a Scenario,
    /// The folder that its paths start from.
    pub base: &'a Path,
    /// A front over the contacts of the roadmap.
    pub front: Option<Front>,
    /// A roadmap (JSON) whose contacts are searched, with start and goal, in place of new ones.
    pub roadmap: Option<&'a Path>,
}

/// Why there is no answer. That there is no path is one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshRouteError {
    /// The mesh, its keys, or an end that gives no contact.
    #[error(transparent)]
    Mesh(#[from] MeshHopError),
    /// A front that the scenario does not have.
    #[error(transparent)]
    Front(#[from] FrontProblem),
    /// A front of hops against risk.
    #[error("a front of hops against risk is estimated along a profile, expected another amount for a free route over a mesh")]
    RiskFront,
    /// A front over a roadmap that grows until its first path.
    #[error(
        "search.planner = \"prm\" stops at the first path and finds the shortest arcs, expected planner = \"exact\" for a front of hops \
         against an amount"
    )]
    PrmFront,
    /// A terrain that is no mesh as it stands.
    #[error("terrain is no mesh with route = \"free\", expected one for a free route over it")]
    NoMesh,
    /// An end outside the bounds of the contacts.
    #[error(
        "the {end} is moved to ({}, {}, {}) m on the surface, expected it within search.bounds_m, {bounds}: widen them, or move the {end}",
        point_m.x, point_m.y, point_m.z
    )]
    OutsideBounds {
        /// Start or goal.
        end: &'static str,
        /// Where it is on the surface.
        point_m: Point3<f64>,
        /// The bounds.
        bounds: SpaceBounds,
    },
    /// An end that has no room for its stand-off.
    #[error(
        "the {end} at ({}, {}, {}) m of the surface cannot stand off it by search.stand_off_m, {stand_off_m} m: another part of the mesh is \
         nearer; give less, or move the {end}",
        point_m.x, point_m.y, point_m.z
    )]
    NoStandOff {
        /// Start or goal.
        end: &'static str,
        /// Where it is on the surface.
        point_m: Point3<f64>,
        /// The stand-off, m.
        stand_off_m: f64,
    },
    /// A roadmap that cannot be opened.
    #[error("cannot open the roadmap ({0}), expected a readable JSON file of a plan over this mesh")]
    NoRoadmap(#[source] std::io::Error),
    /// A roadmap that is not one of this ground.
    #[error(transparent)]
    Roadmap(#[from] RoadmapFileError),
    /// Bounds without a facet.
    #[error("search.bounds_m: {0}")]
    NothingWithin(#[from] NothingWithin),
    /// A path that the mesh does not have.
    #[error(
        "a hop of the planned path is not feasible over the mesh; this is a defect of chta, please report it with the scenario"
    )]
    Lost,
    /// A path that breaks a limit when it is flown again.
    #[error(transparent)]
    Defect(#[from] Defect),
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A plan over a mesh, with everything that its views need.
#[derive(Clone, Debug)]
pub struct MeshRouted {
    /// The ground under the limits that planning may use.
    pub ground: MeshGround,
    /// The roadmap and its best path.
    pub grown: GrownRoadmap,
    /// The path with all its numbers.
    pub path: Option<HopPath>,
    /// The answer as plain data.
    pub answer: MeshPlanAnswer,
    /// Warnings about the mesh, the search and the path.
    pub warnings: Vec<String>,
}

/// Plans the best path over a mesh by the objective of a scenario, within its budgets, for exact commands.
///
/// # Errors
/// [`MeshRouteError`].
pub fn mesh_route(question: &MeshRouteQuestion<'_>, progress: &dyn Progress) -> Result<MeshRouted, MeshRouteError> {
    let scenario = question.scenario;
    if let Some(front) = question.front {
        front.check(scenario)?;
        if front == Front::HOPS_RISK {
            return Err(MeshRouteError::RiskFront);
        }
        if scenario.mesh_search.planner == RoadmapPlanner::Prm {
            return Err(MeshRouteError::PrmFront);
        }
    }
    let MeshEnds { ground, scale, given_m, surface, stood: ends, stand_off_m, mut warnings } =
        mesh_ends(scenario, question.base, scenario.mesh_search.contacts_stand_off_m())?;
    let search = &scenario.mesh_search;
    let mut sampler = ContactSampler::new(&ground, search.bounds, stand_off_m, search.seed.unwrap_or(0))?;
    let (objective, budgets) = (scenario.full_objective(), scenario.total_budgets());
    let asked = roadmap_question(scenario, &objective, &budgets);
    let limits = search.limits();
    let (grown, joined) = match (question.roadmap, search.planner) {
        (Some(file), _) => {
            let read = File::open(file).map_err(MeshRouteError::NoRoadmap)?;
            let roadmap = Roadmap::read_json(&ground, BufReader::new(read))?;
            (over_roadmap(&ground, roadmap, ends, &asked, progress)?, None)
        }
        (None, RoadmapPlanner::Exact) => (grow_roadmap(&ground, ends, &mut sampler, &asked, limits, progress)?, None),
        (None, RoadmapPlanner::Prm) => {
            let height_max_m = search.bounds.map(|bounds| bounds.max.z);
            let RoadmapLimits { contacts_max, time_max } = limits;
            let scheme = OneByOne { test: JoinTest::SampledAngles, height_max_m, contacts_max, time_max };
            let (grown, joined) = grow_one_by_one(&ground, ends, &mut sampler, &asked, scheme, progress)?;
            (grown, Some(joined))
        }
    };
    let facets = [sampler.facet_count(), sampler.turned()];
    // Windows that were read may not be those of the mesh.
    let of_file = |error: MeshRouteError| match error {
        MeshRouteError::Lost | MeshRouteError::Defect(_) if question.roadmap.is_some() => RoadmapFileError::Hop.into(),
        other => other,
    };
    let path = grown.route.path.as_ref().map(|found| hops_of_path(&ground, &grown, found)).transpose().map_err(of_file)?;
    path.as_ref()
        .map(|path| flown_again(&ground, &grown, stand_off_m, path))
        .transpose()
        .map_err(|defect| of_file(defect.into()))?;
    warnings.extend(path.iter().flat_map(|path| scenario.path_warnings(path)));
    warnings.extend(left_out(scenario, grown.end, facets));
    let gap = grown.route.path.is_none().then(|| grown.roadmap.gap(&ground, grown.ends, progress)).transpose()?;
    let front = question.front.map(|front| front_of(scenario, &ground, &grown, (front.amount(), path.as_ref())));
    let front = front.transpose().map_err(of_file)?;
    let ends_m = [grown.ends.0, grown.ends.1].map(|node| grown.roadmap.contact(node).point_m());
    let mut answer =
        answer((scenario, &ground), (given_m, &surface, scale), (&grown, facets, ends_m), (path.as_ref(), gap.as_ref()));
    if let Some(joined) = &joined {
        answer.roadmap.planner = RoadmapPlanner::Prm;
        answer.roadmap.sampled_hops = Some(joined.into());
    }
    (answer.front, answer.front_search) = front.unzip();
    Ok(MeshRouted { ground, grown, path, answer, warnings })
}

/// The hops of a path of the roadmap.
fn hops_of_path(ground: &MeshGround, grown: &GrownRoadmap, found: &RoadmapPath) -> Result<HopPath, MeshRouteError> {
    let contacts: Vec<&MeshContact> = found.contacts.iter().map(|node| grown.roadmap.contact(*node)).collect();
    path_over_mesh(ground, &contacts, &found.arcs()).ok_or(MeshRouteError::Lost)
}

/// The front of hops against an amount over the contacts of the roadmap. `planned`: the path of the plan.
fn front_of(
    scenario: &Scenario,
    ground: &MeshGround,
    grown: &GrownRoadmap,
    (amount, planned): (Amount, Option<&HopPath>),
) -> Result<(Vec<FrontRecord>, FrontSearchRecord), MeshRouteError> {
    let mut of = FrontSearchRecord { front_amount: amount, front_hops_max: 0, front_labels_capped: false };
    let Some(fewest) = grown.roadmap.hops_to(grown.ends.1)[grown.ends.0] else { return Ok((Vec::new(), of)) };
    of.front_hops_max = front_hops_max(scenario, u64::from(fewest));
    let (commands, takeoff) = front_commands(scenario);
    #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
    let budgets = scenario.total_budgets().with(Amount::Hops, of.front_hops_max as f64).unwrap_or(scenario.total_budgets());
    let objective = Objective::of(amount);
    let asked = RoadmapQuestion { objective: &objective, budgets: &budgets, commands, takeoff, cap: LabelCap::default() };
    let (paths, capped) = grown.roadmap.front(ground, grown.ends, (amount, &asked))?;
    of.front_labels_capped = capped;
    let mut rows = Vec::with_capacity(paths.len());
    for path in &paths {
        let hops = hops_of_path(ground, grown, path)?;
        let is_planned = planned.is_some_and(|planned| are_the_same(planned, &hops));
        rows.push(amount_row(amount, (hops_of(&path.totals), &hops), is_planned));
    }
    Ok((rows, of))
}

/// The answer of a plan over the nodes of a roadmap; `ends_m`: where the hopper is at start and goal.
pub(super) fn answer<N: Clone + Send + Sync>(
    (scenario, ground): (&Scenario, &MeshGround),
    (given_m, surface, mesh_scale): ([Point3<f64>; 2], &[MeshContact; 2], f64),
    (grown, facets, ends_m): (&GrownRoadmap<N>, [usize; 2], [Point3<f64>; 2]),
    (path, gap): (Option<&HopPath>, Option<&RoadmapGap>),
) -> MeshPlanAnswer {
    let (objective, budgets) = (scenario.full_objective(), scenario.budget.totals(&scenario.hopper));
    let route = &grown.route;
    let totals = route.path.as_ref().map(|path| path.totals);
    let objective_record = ObjectiveRecord::new(&objective, &budgets, (totals, &route.unmet, route.capped));
    let propellant_shortage = path.and_then(|path| PropellantShortage::of(&path.totals));
    let is_traversable = path.is_some() && propellant_shortage.is_none() && objective_record.is_met();
    let away = surface[1].point_m() - surface[0].point_m();
    let bounds = ground.speed_bounds();
    let [start, goal] = [0, 1].map(|i| MeshContactRecord::new(ground, &surface[i], given_m[i].coords.into()));
    // Contacts that stand off the surface are as far apart as their points.
    let [first, last] = ends_m;
    let between = if grown.ends.0 == grown.ends.1 { nalgebra::Vector3::zeros() } else { last - first };
    MeshPlanAnswer {
        mesh_scale,
        start,
        goal,
        verdict: if is_traversable { ProofVerdict::Traversable } else { ProofVerdict::Open },
        hops: totals.as_ref().map(hops_of),
        hops_lower_bound: bounds.hops(libm::hypot(between.x, between.y), between.z),
        straight_line_m: away.norm().min(between.norm()),
        objective: objective_record,
        derating: DeratingRecord::of(&scenario.derating),
        propellant_shortage,
        roadmap: RoadmapRecord::new(grown, &objective, facets),
        gap: gap.map(Into::into),
        verified: path.map(|_| true),
        path: path.map(|path| HopRecord::rows(path, None)).unwrap_or_default(),
        totals: path.map(|path| TotalsRecord::from(&path.totals)),
        front: None,
        front_search: None,
    }
}

/// What the plan leaves out of a scenario, and what its contacts leave out of the mesh.
pub(super) fn left_out(scenario: &Scenario, end: RoadmapEnd, [facets, turned]: [usize; 2]) -> Vec<String> {
    let mut warnings = Vec::new();
    if end == RoadmapEnd::Given {
        let search = &scenario.mesh_search;
        let drawing = [
            ("search.planner", search.planner == RoadmapPlanner::Prm),
            ("search.contacts_max", search.contacts_max.is_some()),
            ("search.time_max_s", search.time_max_s.is_some()),
            ("search.seed", search.seed.is_some()),
        ];
        let unused: Vec<&str> = drawing.iter().filter(|(_, is_given)| *is_given).map(|(key, _)| *key).collect();
        if !unused.is_empty() {
            warnings
                .push(format!("{}: without effect, since the contacts of the roadmap read stand as they are", unused.join(", ")));
        }
        warnings.push(
            "a result of this plan does not hold the roadmap that was read: planned again without it, its scenario draws other contacts".to_owned(),
        );
    }
    if scenario.uncertainty.is_some() {
        warnings.push(
            "this route is planned for exact commands: the errors of [uncertainty] choose none of its contacts and commands"
                .to_owned(),
        );
    }
    if !scenario.hopper.limits().steps.is_continuous() {
        warnings.push(
            "this route has exact commands, and this machine takes its commands in steps, which may miss a landing or break a \
             limit"
                .to_owned(),
        );
    }
    let ended_early = matches!(end, RoadmapEnd::Contacts | RoadmapEnd::Time);
    if scenario.mesh_search.planner == RoadmapPlanner::Prm {
        warnings.push(
            "search.planner = \"prm\" is the method of Campana and Laumond: it tries seven angles of a hop, so that it may miss one through a \
             narrow gap, however many contacts it has, and it stops at the first path; planner = \"exact\" misses no hop between its contacts \
             and goes on to better paths"
                .to_owned(),
        );
    } else if turned < facets && ended_early {
        warnings.push(format!(
            "{turned} of {facets} facets of the ground within the bounds had a contact in their middle, and the others only by chance: a path \
             over small facets may have been missed; more contacts (search.contacts_max) or narrower search.bounds_m reach more of them"
        ));
    }
    warnings
}
