//! A free route of a robot with legs over a mesh or a DEM, from stance to stance.

use std::path::{Path, PathBuf};

#[cfg(feature = "plot")]
use nalgebra::Point3;

use super::{
    FreeRouteError, MeshRouteError, PipelineError,
    legs_ends::{LegsEnds, POSTS_MAX, legs_ends, planned_map},
    legs_walk::Walking,
    mesh_route::{answer, left_out},
    objective::roadmap_question,
    stance::{best_stance, with_robot},
};
#[cfg(feature = "plot")]
use super::{captions::title, conditions};
#[cfg(feature = "plot")]
use crate::figure::{Caption, FigureError, MeshRouteFigure, MeshRouteLine, Picture, SeenFrom, draw_mesh_route};
use crate::{
    ground::{NoFriction, Stance, StanceGround, StanceMap},
    path::{HopPath, StanceViolation, flown_by_stances, path_over_stances},
    planner::{
        StanceSampler,
        roadmap::{
            ContactSampler, GrownRoadmap, RoadmapGround, RoadmapLimits, RoadmapPath, RoadmapPlanner, RoadmapQuestion, grow_roadmap,
            grow_until_joined,
        },
    },
    progress::{Cancelled, Progress},
    quantity::{MapPoint, format_number},
    report::{CrsRecord, FootRecord, LegsPlanAnswer, StanceRecord, mission_geojson, path_geojson},
    scenario::{RobotFileError, Scenario, TerrainSource, read_robot},
    terrain::{MapBounds, MapProjection, OverlaidDem, TerrainError},
};
#[cfg(feature = "plot")]
use crate::{report::TravelLegRecord, terrain::slice};

/// What is asked.
#[derive(Clone, Copy, Debug)]
pub struct LegsRouteQuestion<'a> {
    /// The scenario, with a robot file and a free route over a mesh or a DEM.
    pub scenario: &'a Scenario,
    /// The folder that its paths start from.
    pub base: &'a Path,
}

impl LegsRouteQuestion<'_> {
    /// The same question, of a robot that hops alone.
    ///
    /// # Errors
    /// [`LegsRouteError::Walks`]: it walks, and this is not answered then; `what`: in the plural, such as `trials`.
    pub fn of_hops_alone(self, what: &'static str) -> Result<Self, LegsRouteError> {
        if self.scenario.drives().is_some() { Err(LegsRouteError::Walks { what }) } else { Ok(self) }
    }
}

/// Why there is no answer. That there is no path is one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LegsRouteError {
    /// The mesh, its keys, or an end that gives no contact.
    #[error(transparent)]
    Mesh(#[from] MeshRouteError),
    /// A DEM, or what the scenario says of its body.
    #[error(transparent)]
    Pipeline(#[from] Box<PipelineError>),
    /// A DEM, its map or its overlays.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// An end off the map.
    #[error("the {end} at ({}, {}) m is off the map, which spans {bounds}", format_number(at.x), format_number(at.y))]
    OffTheMap {
        /// Start or goal.
        end: &'static str,
        /// Where, m.
        at: MapPoint,
        /// The map.
        bounds: MapBounds,
    },
    /// An end without an elevation.
    #[error(
        "the {end} at ({}, {}) m has no elevation, expected a place whose ground is known: no-data is no ground; choose another place, or a DEM without the gap",
        format_number(at.x), format_number(at.y)
    )]
    NoElevation {
        /// Start or goal.
        end: &'static str,
        /// Where, m.
        at: MapPoint,
    },
    /// More posts than are taken as a mesh.
    #[error(
        "found {posts} posts, expected at most {POSTS_MAX} for a robot with legs, which stands on the facets between them: give search.bounds_m = [[x, y, z], [x, y, z]] about start and goal, or a part of the DEM (gdal_translate -projwin)"
    )]
    TooManyPosts {
        /// The posts.
        posts: usize,
    },
    /// A point without trunk and legs on a DEM with overlays.
    #[error(
        "the robot is a point without a trunk, and the scenario lays zones, layers or friction over its map, expected legs: remove robot.file, for a hopper that obeys them"
    )]
    PointOnOverlays,
    /// A point without trunk and legs.
    #[error("the robot is a point without a trunk, expected legs whose stances are compared: remove robot.file")]
    Point,
    /// The robot file.
    #[error(transparent)]
    Robot(#[from] RobotFileError),
    /// The surface states no friction.
    #[error(transparent)]
    NoFriction(#[from] NoFriction),
    /// A line that was walked again, or the sums of the moves.
    #[error(transparent)]
    Walk(#[from] Box<FreeRouteError>),
    /// What is not answered for a robot that walks.
    #[error(
        "the robot walks, by [drive], and {what} of robots that walk are not made, expected one that hops alone: set drive.travel = \"hop\", or remove \
         [drive]"
    )]
    Walks {
        /// What, such as `trials`.
        what: &'static str,
    },
    /// An end at which the robot cannot stand.
    #[error(
        "the robot cannot stand at the {end}, over ({}, {}, {}) m of the surface, in any of {tried} poses: {refusal}; choose another place, or \
         a robot that fits there",
        format_number(at_m[0]), format_number(at_m[1]), format_number(at_m[2])
    )]
    NoStance {
        /// Start or goal.
        end: &'static str,
        /// Where it is on the surface, m.
        at_m: [f64; 3],
        /// How many poses were tried.
        tried: u64,
        /// The refusal of the pose that was the nearest to a stance.
        refusal: String,
    },
    /// A path that breaks a limit when it is flown again.
    #[error(
        "the planned path does not pass its own check ({} violations): {}; this is a defect of chta, please report it with the scenario",
        violations.len(), violations.iter().take(10).map(ToString::to_string).collect::<Vec<_>>().join("; ")
    )]
    Defect {
        /// All violations.
        violations: Vec<StanceViolation>,
    },
}

impl From<PipelineError> for LegsRouteError {
    fn from(error: PipelineError) -> Self {
        Self::Pipeline(Box::new(error))
    }
}

impl From<Cancelled> for LegsRouteError {
    fn from(cancelled: Cancelled) -> Self {
        Self::Mesh(cancelled.into())
    }
}

/// A plan of a robot with legs, with everything that its views need.
#[derive(Clone, Debug)]
pub struct LegsRouted {
    /// The ground under the limits that planning may use, with the robot.
    pub ground: StanceGround,
    /// The DEM with its overlays, of which the whole friction counts; `None` over a mesh.
    pub(super) map: Option<OverlaidDem>,
    /// How it walks; `None` of a robot that hops alone.
    pub(super) walking: Option<Walking>,
    /// The reference system of the map, if it is known.
    pub projection: Option<MapProjection>,
    /// The roadmap and its best path.
    pub grown: GrownRoadmap<Stance>,
    /// The path of the root with all its numbers.
    pub path: Option<HopPath>,
    /// The answer as plain data.
    pub answer: LegsPlanAnswer,
    /// Warnings about the mesh, the robot, the search and the path.
    pub warnings: Vec<String>,
    /// The files that the robot file names, and itself.
    pub robot_files: Vec<PathBuf>,
}

/// Plans the best path of a robot with legs over a mesh or a DEM by the objective of a scenario, within its budgets, for exact commands.
///
/// # Errors
/// [`LegsRouteError`].
pub fn legs_route(question: LegsRouteQuestion<'_>, progress: &dyn Progress) -> Result<LegsRouted, LegsRouteError> {
    let LegsRouteQuestion { scenario, base } = question;
    let file = base.join(scenario.legs.file.as_deref().unwrap_or_else(|| Path::new("")));
    let read = read_robot(&file)?;
    let with_limits = Scenario { hopper: with_robot(&scenario.hopper, &read.robot), ..scenario.clone() };
    let scenario = &with_limits;
    let LegsEnds { ground, map, projection, scale, given_m, surface, record, mut warnings } =
        legs_ends(scenario, base, &read.robot)?;
    warnings.extend(read.warnings);
    let ground = StanceGround::new(ground, read.robot, scenario.legs.cone, scenario.legs.up)?.with_chains(read.chains);
    let ground = match &map {
        Some(map) if ground.is_point() && !map.overlays().are_none() => return Err(LegsRouteError::PointOnOverlays),
        Some(map) => ground.with_map(StanceMap::new(planned_map(map, scenario))),
        None => ground,
    };
    let stance = |at: usize, end| {
        let found = best_stance(&ground, &surface[at], (None, None));
        found.best.map(|(stance, _)| stance).ok_or_else(|| LegsRouteError::NoStance {
            end,
            at_m: surface[at].point_m().coords.into(),
            tried: found.tried.tried,
            refusal: found.refusal.map(|refusal| refusal.to_string()).unwrap_or_default(),
        })
    };
    let ends = [stance(0, "start")?, stance(1, "goal")?];
    let search = &scenario.mesh_search;
    let seed = search.seed.unwrap_or(0);
    let contacts = ContactSampler::new(ground.mesh(), search.bounds, 0.0, seed).map_err(MeshRouteError::from)?;
    let mut sampler = StanceSampler::new(&ground, contacts, seed);
    let (objective, budgets) = (scenario.full_objective(), scenario.total_budgets());
    let asked = roadmap_question(scenario, &objective, &budgets);
    let limits = search.limits();
    let walking = Walking::of(scenario, map.as_ref().map(|map| planned_map(map, scenario)));
    let grown = match &walking {
        Some(walking) => grown(&walking.over(&ground), (ends, search.planner), &mut sampler, (&asked, limits), progress)?,
        None => grown(&ground, (ends, search.planner), &mut sampler, (&asked, limits), progress)?,
    };
    let facets = [sampler.contacts().facet_count(), sampler.contacts().turned()];
    let refused = sampler.refused();
    let stances: Vec<&Stance> = grown.route.path.as_ref().map_or_else(
        || vec![grown.roadmap.contact(grown.ends.0), grown.roadmap.contact(grown.ends.1)],
        |found| found.contacts.iter().map(|node| grown.roadmap.contact(*node)).collect(),
    );
    let takeoffs = grown.route.path.as_ref().map(RoadmapPath::takeoffs).unwrap_or_default();
    let pairs: Vec<[&Stance; 2]> = takeoffs.iter().map(|at| [stances[*at], stances[at + 1]]).collect();
    let path = match &grown.route.path {
        None => None,
        Some(found) => Some(path_over_stances(&ground, &pairs, &found.arcs()).ok_or(MeshRouteError::Lost)?),
    };
    if let Some(path) = &path {
        let violations = flown_by_stances(&ground, &pairs, path);
        if !violations.is_empty() {
            return Err(LegsRouteError::Defect { violations });
        }
        warnings.extend(scenario.path_warnings(path));
    }
    warnings.extend(left_out(scenario, grown.end, facets));
    warnings.extend(assumptions(&ground));
    warnings.extend(walking.as_ref().map(|_| Walking::assumption()));
    warnings.extend(without_effect(question.scenario));
    let gap = match &walking {
        _ if grown.route.path.is_some() => None,
        Some(walking) => Some(grown.roadmap.gap(&walking.over(&ground), grown.ends, progress)?),
        None => Some(grown.roadmap.gap(&ground, grown.ends, progress)?),
    };
    let ends_m = [grown.ends.0, grown.ends.1].map(|node| grown.roadmap.contact(node).pose().root_m);
    let mut plan =
        answer((scenario, ground.mesh()), (given_m, &surface, scale), (&grown, facets, ends_m), (path.as_ref(), gap.as_ref()));
    plan.roadmap.planner = search.planner;
    let mut walk = None;
    if let Some(walking) = &walking {
        // No bound on hops holds where walking joins them.
        plan.hops_lower_bound = Some(0);
        let mut record = walking.record(&grown);
        if let (Some(found), Some(path)) = (&grown.route.path, &path) {
            let (legs, totals) = walking.moves(&ground, (found, &stances, path), projection.as_ref())?;
            (record.legs, record.totals) = (legs, Some(totals));
        }
        walk = Some(record);
    }
    let answer = LegsPlanAnswer {
        robot: ground.robot().name().to_owned(),
        cone: ground.cone_kind().name().to_owned(),
        up: ground.stands_up().name().to_owned(),
        ground: record,
        refused_poses: refused.into(),
        joint_reach: ground.has_joints().then(|| {
            let all = (0..grown.roadmap.contact_count()).map(|node| grown.roadmap.contact(node));
            ground.joint_reach(all).into()
        }),
        plan,
        stances: StanceRecord::all_of(&ground, &stances, path.as_ref().map(|path| (&takeoffs[..], path))),
        walk,
    };
    warnings.extend(beyond_joints(&answer.stances));
    let robot_files = std::iter::once(file).chain(read.files).collect();
    Ok(LegsRouted { ground, map, walking, projection, grown, path, answer, warnings, robot_files })
}

/// The roadmap of stances, over which the robot hops alone or also walks.
fn grown<G: RoadmapGround<Node = Stance>>(
    ground: &G,
    (ends, planner): ([Stance; 2], RoadmapPlanner),
    sampler: &mut StanceSampler<'_>,
    (asked, limits): (&RoadmapQuestion<'_>, RoadmapLimits),
    progress: &dyn Progress,
) -> Result<GrownRoadmap<Stance>, Cancelled> {
    match planner {
        RoadmapPlanner::Exact => grow_roadmap(ground, ends, sampler, asked, limits, progress),
        RoadmapPlanner::Prm => grow_until_joined(ground, ends, sampler, asked, limits, progress),
    }
}

impl LegsRouted {
    /// The reference system of the map, if it is known.
    pub fn crs(&self) -> Option<CrsRecord> {
        self.projection.as_ref().map(CrsRecord::from)
    }

    /// The path of its root over a DEM as `GeoJSON`, as [`path_geojson`]; `None` without a path, and over a mesh.
    pub fn geojson(&self) -> Option<String> {
        self.map.as_ref()?;
        if let Some(walk) = &self.answer.walk {
            let hops = &self.path.as_ref()?.hops;
            return mission_geojson(&walk.legs, hops, self.ground.mesh().envelope().gravity_m_s2(), self.projection.as_ref());
        }
        path_geojson(self.path.as_ref()?, self.ground.mesh().envelope().gravity_m_s2(), self.projection.as_ref())
    }

    /// Whether it stands on the facets of a DEM.
    pub const fn is_over_dem(&self) -> bool {
        self.map.is_some()
    }
}

#[cfg(feature = "plot")]
impl LegsRouted {
    /// The lines that are walked, along the ground under the root.
    fn walked(&self) -> Vec<Vec<Point3<f64>>> {
        let legs = self.answer.walk.iter().flat_map(|walk| &walk.legs);
        let lines = legs.filter_map(|leg| {
            let TravelLegRecord::Drive(leg) = leg else { return None };
            let [from, to] = [leg.takeoff_m, leg.landing_m].map(|[x, y, _]| MapPoint::new(x, y));
            let line = slice(self.map.as_ref()?.dem(), from, to).ok()?;
            Some(
                line.points
                    .iter()
                    .map(|point| {
                        let at = from + line.heading * point.x_m;
                        Point3::new(at.x, at.y, point.z_m)
                    })
                    .collect(),
            )
        });
        lines.collect()
    }

    /// The picture of the path of its root: an oblique view, a plan view and the table of its hops.
    ///
    /// # Errors
    /// As [`draw_mesh_route`].
    pub fn picture(&self, scenario: &Scenario, seen_from: SeenFrom) -> Result<Picture, FigureError> {
        let [start, goal] = [self.grown.ends.0, self.grown.ends.1].map(|node| self.grown.roadmap.contact(node).pose().root_m);
        let stances = self.answer.plan.roadmap.contacts;
        let robot = self.ground.robot().name();
        let result = self.path.as_ref().map_or_else(
            || format!("{robot}: no path over these {stances} stances"),
            |path| {
                let (hops, time_s) = (path.hops.len(), path.totals.flight_time_s);
                let walked = self.answer.walk.as_ref().and_then(|walk| walk.totals);
                let walked = walked.map(|walk| format!(", {:.2} m walked", walk.drive_length_m));
                format!(
                    "{robot}: at most {hops} hops over these {stances} stances, {time_s:.2} s in flight{}",
                    walked.unwrap_or_default()
                )
            },
        );
        let scenario = Scenario { hopper: *self.ground.mesh().envelope().hopper(), ..scenario.clone() };
        draw_mesh_route(&MeshRouteFigure {
            caption: Caption { title: title("Route of a robot with legs", &scenario), lines: vec![conditions(&scenario), result] },
            mesh: self.ground.mesh().tree().mesh(),
            seen_from,
            cut_z_m: None,
            start,
            goal,
            routes: self
                .path
                .iter()
                .map(|path| MeshRouteLine { name: "", path, gravity_m_s2: self.ground.mesh().envelope().gravity_m_s2() })
                .collect(),
            walks: self.walked(),
            nearest: self.answer.plan.gap.as_ref().map(|gap| gap.nearest_m.into()),
        })
    }
}

/// The keys of a scenario that a robot with legs does not obey.
fn without_effect(scenario: &Scenario) -> Option<String> {
    let limits = scenario.hopper.limits();
    let keys = [
        ("search.stand_off_m", scenario.mesh_search.stand_off_m.is_some()),
        ("hopper.radius_m", limits.radius_m.is_some_and(|radius_m| radius_m > 0.0)),
        ("hopper.landing", limits.landing.brakes()),
        (
            "search.node_spacing_max_m",
            scenario.search.spacing.is_some() && matches!(scenario.terrain, Some(TerrainSource::Dem { .. })),
        ),
    ];
    let given: Vec<&str> = keys.iter().filter(|(_, is_given)| *is_given).map(|(key, _)| *key).collect();
    (!given.is_empty()).then(|| format!("{}: without effect on the trunk and the feet of a robot with legs", given.join(", ")))
}

/// Where the joints do not do what the stances of a path ask for: one sentence for each stance.
fn beyond_joints(stances: &[StanceRecord]) -> Vec<String> {
    let mut found = Vec::new();
    for (number, stance) in stances.iter().enumerate() {
        let short = |foot: &FootRecord| Some((foot.limb.clone()?, foot.joints.as_ref().filter(|joints| !joints.reached)?.error_m));
        found.extend(stance.contacts.iter().filter_map(short).map(|(limb, error_m)| {
            format!(
                "stance {number}: no joints were found that put the foot of {limb} where its workspace says, the nearest stop {error_m:.3} m \
                 short: make the workspace smaller"
            )
        }));
        for (what, push) in [("landing at", &stance.landing), ("take-off from", &stance.takeoff)] {
            let Some(push) = push else { continue };
            let shares = [("torque or force", push.greatest_effort()), ("rate", push.greatest_rate())];
            found.extend(shares.into_iter().filter_map(|(kind, share)| Some((kind, share.filter(|(_, share)| *share > 1.0)?))).map(
                |(kind, (limb, share))| {
                    format!(
                        "{what} stance {number}: a joint of {limb} needs {share:.2} times its greatest {kind}, by forces that leave the least \
                         spin; other forces may need less, a lower speed does"
                    )
                },
            ));
        }
    }
    found
}

/// What a plan of a robot with legs assumes.
pub(super) fn assumptions(ground: &StanceGround) -> Vec<String> {
    if ground.is_point() {
        return Vec::new();
    }
    let joints = if ground.has_joints() { "the joints are looked at afterwards" } else { "the joints are not known" };
    let mut found = vec![format!(
        "the feet are estimated from the space that they reach, and keep off the ground in flight: legs are drawn in, and {joints}"
    )];
    if ground.robot().stroke_m().is_none() {
        found.push("take-off and landing are impulses: gravity does nothing while the feet push".to_owned());
    }
    found
}
