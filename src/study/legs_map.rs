//! Where a robot with legs stands on a DEM, and how many hops lead there.

use std::path::Path;

use nalgebra::Point3;

use super::{
    Defect, LegsRouteError, LegsRouteQuestion, MeshRouteError,
    legs_ends::{DemGroundOfLegs, dem_ground_of_legs, planned_map},
    legs_route::assumptions,
    map::{MapStudyError, NamedPlace, Spot, spot},
    nodes::{coarse_map_nodes, level_hop_of_m},
    stance::{best_stance, pairs_of, with_robot},
};
use crate::{
    ballistics::Arc,
    ground::{Stance, StanceBuffers, StanceGround, StanceMap},
    path::{HopPath, flown_by_stances, path_over_stances},
    progress::Progress,
    quantity::MapPoint,
    reach::{
        map::NodeLattice,
        stances::{StanceHops, StanceNodes},
    },
    report::{CrsRecord, LegsGoalRecord, LegsMapAnswer, LegsReachRecord, LimbNodesRecord, SizeAnswer, SizeRecord},
    scenario::{Scenario, read_robot},
    terrain::{Dem, OverlaidDem, check_map_scale},
};

/// What is asked.
#[derive(Clone, Debug)]
pub struct LegsMapQuestion<'a> {
    /// The scenario, with a robot file; the terrain in it is ignored.
    pub scenario: &'a Scenario,
    /// The folder that its paths start from.
    pub base: &'a Path,
    /// The DEM's file.
    pub dem: &'a Path,
    /// The starts; none: stances alone.
    pub starts: Vec<NamedPlace>,
    /// The goals.
    pub goals: Vec<NamedPlace>,
    /// Every so many posts are nodes.
    pub stride: usize,
    /// Nodes that need more hops are not searched.
    pub hops_max: Option<i16>,
    /// The most memory, bytes, that the map may need.
    pub memory_max_bytes: Option<u64>,
}

/// Why there is no map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LegsMapError {
    /// The terrain or the robot.
    #[error(transparent)]
    Ground(#[from] LegsRouteError),
    /// A start or a goal.
    #[error(transparent)]
    Map(#[from] MapStudyError),
    /// A point without trunk and legs.
    #[error(
        "the robot is a point without a trunk, expected legs for a map of its stances: remove robot.file, whose map is that of a hopper"
    )]
    Point,
    /// A start at which it cannot stand.
    #[error(
        "{name}: the robot cannot stand at the nearest node, ({}, {}) m, in any of {headings} headings: {refusal}; choose another start, or more \
         headings (robot.headings)", at.x, at.y
    )]
    NoStance {
        /// What the caller calls the start.
        name: String,
        /// The node.
        at: MapPoint,
        /// The headings tried.
        headings: u32,
        /// The refusal that was the nearest to a stance.
        refusal: String,
    },
}

/// A map of stances before they are looked for.
#[derive(Clone, Debug)]
pub struct PreparedLegsMap {
    ground: StanceGround,
    map: OverlaidDem,
    /// The scenario with the limits that the robot states.
    pub scenario: Scenario,
    /// The nodes.
    pub lattice: NodeLattice,
    /// The starts.
    pub starts: Vec<Spot>,
    /// The goals.
    pub goals: Vec<Spot>,
    /// The reference system of the map.
    pub crs: Option<CrsRecord>,
    /// What it takes.
    pub size: SizeAnswer,
    headings: u32,
    answer: LegsMapAnswer,
    /// Warnings about robot and terrain.
    pub warnings: Vec<String>,
}

/// A map of stances, with everything that its views need.
#[derive(Clone, Debug)]
pub struct LegsMap {
    /// What was found at the nodes.
    pub nodes: StanceNodes,
    /// The fewest hops; `None` without a start.
    pub hops: Option<StanceHops>,
    /// The answer as plain data.
    pub answer: LegsMapAnswer,
    /// Warnings about the answer.
    pub warnings: Vec<String>,
}

/// Headings of the trunk at every node where the scenario gives no number.
const HEADINGS: u32 = 8;

/// The facets and their tree, bytes for each post, at most.
const FACET_BYTES_PER_POST: u64 = 320;

impl PreparedLegsMap {
    /// Reads the robot and the terrain, and finds the nodes of starts and goals.
    ///
    /// # Errors
    /// [`LegsMapError`], also if the map needs more memory than the question allows.
    pub fn new(question: &LegsMapQuestion<'_>) -> Result<Self, LegsMapError> {
        let LegsMapQuestion { scenario, base, dem: file, stride, .. } = question;
        LegsRouteQuestion { scenario, base }.of_hops_alone("maps")?;
        let robot_file = base.join(scenario.legs.file.as_deref().unwrap_or_else(|| Path::new("")));
        let read = read_robot(&robot_file).map_err(LegsRouteError::from)?;
        let mut scenario = Scenario { hopper: with_robot(&scenario.hopper, &read.robot), ..(*scenario).clone() };
        // A map is of the whole DEM.
        scenario.mesh_search.bounds = None;
        let DemGroundOfLegs { ground, map, record, mut warnings } = dem_ground_of_legs(&scenario, base, (file, &read.robot))?;
        warnings.extend(read.warnings);
        let ground = StanceGround::new(ground, read.robot, scenario.legs.cone, scenario.legs.up).map_err(LegsRouteError::from)?;
        if ground.is_point() {
            return Err(LegsMapError::Point);
        }
        let ground = ground.with_map(StanceMap::new(planned_map(&map, &scenario)));
        let dem = map.dem();
        let lattice = NodeLattice::new(dem, *stride);
        let projection = dem.georeference().projection();
        let spots = |end, places: &[NamedPlace]| -> Result<Vec<Spot>, MapStudyError> {
            places.iter().map(|place| spot(end, place, dem, &projection, lattice)).collect()
        };
        let starts = spots(super::JourneyEnd::Start, &question.starts)?;
        let goals = spots(super::JourneyEnd::Goal, &question.goals)?;
        for start in &starts {
            let scale = check_map_scale(dem, projection.as_ref(), start.at, scenario.accept_map_scale, file)
                .map_err(MapStudyError::from)?;
            warnings.extend(scale.warning().filter(|warning| !warnings.contains(warning)));
        }
        warnings.extend(assumptions(&ground));
        let spacing = lattice.map(dem.georeference());
        let envelope = ground.mesh().envelope();
        let hop_m = level_hop_of_m(envelope.hopper(), envelope.gravity_m_s2());
        let finer = if question.stride > 1 { "stride" } else { "distance of posts" };
        warnings.extend(coarse_map_nodes(hop_m, finer, spacing.dx_m().max(spacing.dy_m())).filter(|_| !starts.is_empty()));
        let headings = scenario.legs.headings.unwrap_or(HEADINGS);
        let size = size(&ground, (dem, lattice), headings, !starts.is_empty());
        if let Some(allowed_bytes) = question.memory_max_bytes.filter(|allowed_bytes| size.bytes_max > *allowed_bytes) {
            let (posts, nodes) = (dem.rows() * dem.cols(), lattice.count());
            return Err(MapStudyError::TooMuchMemory { needed_bytes: size.bytes_max, allowed_bytes, posts, nodes }.into());
        }
        let nodes = lattice.map(dem.georeference());
        let answer = LegsMapAnswer {
            robot: ground.robot().name().to_owned(),
            cone: ground.cone_kind().name().to_owned(),
            up: ground.stands_up().name().to_owned(),
            ground: record,
            limbs: ground.robot().limbs().len(),
            contacts_min: ground.robot().contacts_min(),
            headings,
            stride: lattice.stride,
            node_spacing_m: nodes.dx_m().max(nodes.dy_m()),
            nodes: 0,
            no_data_nodes: 0,
            standing_nodes: 0,
            nodes_by_legs: Vec::new(),
            nodes_by_limb: Vec::new(),
            beam_median_deg: None,
            beam_max_deg: None,
            starts_m: starts.iter().map(|start| [start.at.x, start.at.y]).collect(),
            reach: None,
            derating: crate::report::DeratingRecord::of(&scenario.derating),
            goals: Vec::new(),
        };
        let crs = projection.as_ref().ok().map(CrsRecord::from);
        Ok(Self { ground, map, scenario, lattice, starts, goals, crs, size, headings, answer, warnings })
    }

    /// The elevations.
    pub fn dem(&self) -> &Dem {
        self.map.dem()
    }

    /// Looks for stances at every node, and for hops from the starts.
    ///
    /// # Errors
    /// [`LegsMapError`].
    pub fn answered(&self, question: &LegsMapQuestion<'_>, progress: &dyn Progress) -> Result<LegsMap, LegsMapError> {
        let (dem, lattice) = (self.map.dem(), self.lattice);
        let cancelled = LegsRouteError::from;
        let keeps = !self.starts.is_empty();
        let nodes = StanceNodes::of(&self.ground, (dem, lattice), self.headings, keeps, progress).map_err(cancelled)?;
        for start in &self.starts {
            if nodes.found(lattice.index(start.post)).is_none_or(|found| found.headings == 0.0) {
                let (name, at, headings) = (start.name.clone(), start.at, self.headings);
                return Err(LegsMapError::NoStance { name, at, headings, refusal: self.refusal(start) });
            }
        }
        let posts: Vec<_> = self.starts.iter().map(|start| start.post).collect();
        let hops = keeps.then(|| nodes.hops(&self.ground, &posts, question.hops_max, progress)).transpose().map_err(cancelled)?;
        let mut answer = self.counted(&nodes);
        let mut warnings: Vec<String> = Vec::new();
        warnings.extend(answer.nodes_by_limb.iter().filter(|row| row.nodes == 0).map(|row| {
            format!(
                "{} finds ground at none of {} nodes, in any heading and at any height: check its workspace, or the distance of the posts",
                row.limb, answer.nodes
            )
        }));
        if let Some(hops) = &hops {
            answer.reach = Some(reach(hops, &nodes, question.hops_max));
            for goal in &self.goals {
                let path = hops.path(lattice.index(goal.post)).filter(|path| path.len() > 1);
                let flown = path.as_ref().map(|path| self.flown(question.scenario, &nodes, path)).transpose()?;
                let at = hops.hops[lattice.index(goal.post)];
                answer.goals.push(LegsGoalRecord {
                    x_m: goal.at.x,
                    y_m: goal.at.y,
                    hops: u64::try_from(at).ok(),
                    flight_time_s: flown.as_ref().map(|path| path.totals.flight_time_s),
                    verified: flown.is_some().then_some(true),
                });
            }
        } else if !self.goals.is_empty() {
            warnings.push("goals have no effect without a start: hops lead from one to the other".to_owned());
        }
        Ok(LegsMap { nodes, hops, answer, warnings })
    }

    /// Why it cannot stand at a start: the refusal that was the nearest to a stance.
    fn refusal(&self, start: &Spot) -> String {
        let position = self.lattice.position(self.dem(), start.post);
        let at = position.map(|position| Point3::new(position.at.x, position.at.y, position.z_m));
        let contact = at.and_then(|at| self.ground.mesh().contact(at).ok());
        let refusal = contact.and_then(|contact| best_stance(&self.ground, &contact, (None, None)).refusal);
        refusal.map(|refusal| refusal.to_string()).unwrap_or_default()
    }

    /// The path to a goal, flown again by the independent checker.
    fn flown(&self, scenario: &Scenario, nodes: &StanceNodes, path: &[usize]) -> Result<HopPath, LegsMapError> {
        let lost = || LegsRouteError::from(MeshRouteError::Lost);
        let stances: Vec<&Stance> = path.iter().filter_map(|number| nodes.stance(*number)).collect();
        let (mut buffers, g) = (StanceBuffers::default(), self.ground.mesh().envelope().gravity_m_s2());
        let mut arcs = Vec::with_capacity(path.len());
        for pair in stances.windows(2) {
            let (sight, windows) = self.ground.windows(pair[0], pair[1], &mut buffers).ok_or_else(lost)?;
            let (_, loft) = scenario.search.takeoff.among(sight, windows.iter().copied()).ok_or_else(lost)?;
            arcs.push(Arc::new(sight, loft, g));
        }
        let pairs = pairs_of(&stances);
        let path = path_over_stances(&self.ground, &pairs, &arcs).ok_or_else(lost)?;
        let violations = flown_by_stances(&self.ground, &pairs, &path);
        if violations.is_empty() { Ok(path) } else { Err(LegsRouteError::Defect { violations }.into()) }
    }

    /// The answer with its counts of nodes.
    fn counted(&self, nodes: &StanceNodes) -> LegsMapAnswer {
        let found: Vec<_> = (0..self.lattice.count()).filter_map(|node| nodes.found(node)).collect();
        let mut beams: Vec<f64> = found.iter().filter_map(|node| node.beam_deg).collect();
        beams.sort_by(f64::total_cmp);
        let limbs = self.ground.robot().limbs().len();
        let nodes_by_legs = (0..=limbs).map(|legs| found.iter().filter(|node| node.legs == legs).count()).collect();
        let names = self.ground.robot().limbs().iter().take(u64::BITS as usize).enumerate();
        let nodes_by_limb = names.map(|(number, limb)| LimbNodesRecord {
            limb: limb.name.clone(),
            nodes: found.iter().filter(|node| node.limbs >> number & 1 == 1).count(),
        });
        LegsMapAnswer {
            nodes: found.len(),
            no_data_nodes: self.lattice.count() - found.len(),
            standing_nodes: beams.len(),
            nodes_by_legs,
            nodes_by_limb: nodes_by_limb.collect(),
            beam_median_deg: beams.get(beams.len().saturating_sub(1) / 2).copied(),
            beam_max_deg: beams.last().copied(),
            ..self.answer.clone()
        }
    }
}

/// What the hops reach.
fn reach(hops: &StanceHops, nodes: &StanceNodes, hops_max: Option<i16>) -> LegsReachRecord {
    let reached: Vec<usize> = hops.hops.iter().filter_map(|hops| usize::try_from(*hops).ok()).collect();
    let most = reached.iter().copied().max().unwrap_or(0);
    let mut hops_histogram = vec![0; most + 1];
    for hops in &reached {
        hops_histogram[*hops] += 1;
    }
    LegsReachRecord {
        reached_nodes: reached.len(),
        hops_max,
        hops_histogram,
        stances: nodes.stance_count(),
        pairs_tested: hops.pairs_tested,
    }
}

/// What a map takes.
fn size(ground: &StanceGround, (dem, lattice): (&Dem, NodeLattice), headings: u32, keeps: bool) -> SizeAnswer {
    let (posts, nodes) = ((dem.rows() * dem.cols()) as u64, lattice.count() as u64);
    let of_node = StanceNodes::bytes_per_node(ground.robot().limbs().len(), headings as usize, keeps) as u64;
    let part = |part: &str, bytes_max| SizeRecord { part: part.to_owned(), bytes_max };
    // Each raster: its samples, and its file.
    let rasters = nodes * 2 * (size_of::<i16>() + 4 * size_of::<f32>()) as u64;
    let memory = vec![
        part("elevations", dem.elevations_bytes()),
        part("facets and their tree", posts * FACET_BYTES_PER_POST),
        part("stances and hops", nodes.saturating_mul(of_node)),
        part("rasters to write", rasters),
    ];
    let stances = nodes.saturating_mul(headings.into());
    SizeAnswer::new([posts, nodes, if keeps { stances.saturating_mul(stances) } else { 0 }], memory)
}

impl From<Defect> for LegsMapError {
    fn from(defect: Defect) -> Self {
        Self::Map(defect.into())
    }
}
