//! The best mission from a start to a goal: drive legs and hops over the same nodes.

use super::super::{
    Amount, Amounts, FoundPath, LegGraph, PathStep, RouteError, RouteGoal, RouteQuestion, SurfaceNode, SurfaceNodes, UnmetBudget,
    front,
    labels::Tracked,
    search::{Run, without_budgets},
    surface_hops::{Side, SurfaceHops},
    surface_legs::{LegOffers, Settling},
};
use super::{Travel, drive_legs::DriveLegs, kept::Kept, legs::TravelLegs};
use crate::{
    ballistics::TakeoffChoice,
    drive::{DriveGround, DriveRefusalCounts},
    ground::{DemGround, MapPosition},
    progress::{Meter, Progress, Stage},
    quantity::MapPoint,
    world::Rover,
};

/// What a mission is searched for.
#[derive(Clone, Copy, Debug)]
pub struct MissionQuestion<'a> {
    /// Objective, budgets, commands and errors, as of free routes.
    pub route: RouteQuestion<'a>,
    /// The wheels.
    pub rover: &'a Rover,
    /// Whether it drives, hops or does both.
    pub travel: Travel,
    /// How many bytes a search may hold beside its states and labels to be faster: tables of hops and of drive legs, and what it computed of
    /// pairs of nodes. With fewer it has the same answers, up to rounding, and takes longer.
    pub kept_bytes_max: u64,
}

impl MissionQuestion<'_> {
    /// The usual bytes that a search may hold to be faster: half a gibibyte.
    pub const KEPT_BYTES: u64 = 1 << 29;

    /// Whether a search of a graph may come to a node with more than one label.
    pub(super) fn comes_again(&self) -> bool {
        !self.route.budgets.are_none() || (self.travel.drives() && self.rover.limits().turn_s_per_deg > 0.0)
    }
}

/// One move of a mission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MissionMove {
    /// A straight drive leg.
    Drive,
    /// A hop with this choice of take-off angle.
    Hop(TakeoffChoice),
}

/// A path of moves.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionPath {
    /// The places from start to goal, one move from each to the next.
    pub places: Vec<MapPosition>,
    /// The moves.
    pub moves: Vec<MissionMove>,
    /// What it takes: of hops preparation, flight and settling, but no settling after a landing at the goal.
    pub totals: Amounts,
}

/// The work of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MissionWork {
    /// Pairs of nodes whose hop was computed.
    pub hops_tested: u64,
    /// Pairs of nodes whose drive leg was computed.
    pub drives_tested: u64,
    /// Nodes that the search reached, the start included; without a path all that the start reaches.
    pub reached: usize,
    /// States whose moves were visited.
    pub settled: usize,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Mission {
    /// The best path within the budgets, or the best without budgets, if no path keeps them; `None` if the goal was not reached over these nodes.
    pub path: Option<MissionPath>,
    /// Whether it keeps the budgets.
    pub within: bool,
    /// If not: those that it exceeds, each with the least of any path.
    pub unmet: Vec<UnmetBudget>,
    /// Whether labels were left out.
    pub capped: bool,
    /// Without a path: the reached place nearest to the goal, horizontally, and why drive legs out of the reached nodes are refused.
    pub stopped: Option<(MapPosition, DriveRefusalCounts)>,
    /// The work.
    pub work: MissionWork,
}

impl Mission {
    /// The bytes that the states of a search take, before its labels: with turning a node has as many as neighbours, and two more; and the steps
    /// within reach of a hop.
    pub fn bytes(ground: &DemGround, nodes: &SurfaceNodes, rover: &Rover, travel: Travel) -> u64 {
        let turns = travel.drives() && rover.limits().turn_s_per_deg > 0.0;
        4 * TravelLegs::layers(turns, rover.limits().neighbours.count()) as u64 * nodes.count() as u64
            + SurfaceHops::bytes(ground, nodes)
    }

    /// The bytes of all that a search may hold to be faster ([`MissionQuestion::kept_bytes_max`]).
    pub fn kept_bytes(ground: &DemGround, nodes: &SurfaceNodes, rover: &Rover, travel: Travel) -> u64 {
        Kept::most_bytes((ground, nodes), rover, travel)
    }
}

/// Finds the best mission from a start to a goal over nodes on a DEM by an objective, within budgets.
///
/// Drive legs lead from each node to its neighbours; where turning takes time, they begin with a turn from the direction of the drive leg
/// before. Hops are those of free routes.
///
/// # Errors
/// [`RouteError`].
///
/// # Complexity
/// 4 bytes for each state, and some 60 for each label; with turning a node has as many states as neighbours, and two more.
pub fn travel(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    goal: &RouteGoal,
    question: &MissionQuestion<'_>,
    progress: &dyn Progress,
) -> Result<Mission, RouteError> {
    let mut asked = Asked::new((ground, nodes), goal, (question, question.comes_again()), progress)?;
    loop {
        let (mission, hops) = asked.best(question)?;
        // The fast walk equals the slice up to rounding: a hop on the very edge of a limit may be one for the walk alone.
        if !asked.surface.refuse_wrong(hops) {
            return Ok(mission);
        }
    }
}

/// A front of missions.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionFront {
    /// The paths in ascending order of hops; none if the goal was not reached.
    pub paths: Vec<MissionPath>,
    /// Whether labels were left out.
    pub capped: bool,
}

/// The Pareto front of hops against another amount over nodes on a DEM, within budgets.
///
/// # Errors
/// [`RouteError`].
pub fn front_of_missions(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    goal: &RouteGoal,
    (amount, question): (Amount, &MissionQuestion<'_>),
    progress: &dyn Progress,
) -> Result<MissionFront, RouteError> {
    let mut asked = Asked::new((ground, nodes), goal, (question, true), progress)?;
    loop {
        let (found, hops) = asked.with_legs(question, |asked, legs| {
            let of = (Amount::Hops, amount);
            let (found, capped) = front(legs, legs.ends(), of, question.route.budgets, question.route.cap)?;
            let hops: Vec<_> = found.iter().flat_map(|path| hops_of(legs, path)).collect();
            Ok((MissionFront { paths: found.iter().map(|path| asked.path(legs, path)).collect(), capped }, hops))
        })?;
        if !asked.surface.refuse_wrong(hops) {
            return Ok(found);
        }
    }
}

/// The nodes of the hops of a path.
fn hops_of<'l>(legs: &'l TravelLegs<'_>, path: &'l FoundPath) -> impl Iterator<Item = [SurfaceNode; 2]> + 'l {
    let is_hop = |step: &&PathStep| legs.hop_of(step).is_some();
    path.steps.iter().filter(is_hop).map(|step| [legs.node_of(step.from), legs.node_of(step.to)])
}

/// The nodes, and the ends of a question.
struct Asked<'a> {
    ground: &'a DemGround,
    nodes: &'a SurfaceNodes,
    surface: SurfaceHops<'a>,
    ends: [(SurfaceNode, MapPosition); 2],
    how: &'a RouteGoal,
    kept: Kept,
    progress: &'a dyn Progress,
    meter: Meter<'a>,
}

impl<'a> Asked<'a> {
    fn new(
        (ground, nodes): (&'a DemGround, &'a SurfaceNodes),
        how: &'a RouteGoal,
        (question, again): (&MissionQuestion<'_>, bool),
        progress: &'a dyn Progress,
    ) -> Result<Self, RouteError> {
        let surface = SurfaceHops::new(ground, nodes);
        let node = |at: MapPoint| {
            let node = nodes.place(at).ok_or(RouteError::NoGround(at))?;
            Ok::<_, RouteError>((node, nodes.position(ground, node).ok_or(RouteError::NoGround(at))?))
        };
        let ends = [node(how.start)?, node(how.goal)?];
        let way_m = (how.goal - how.start).norm();
        let kept = Kept::of((ground, nodes), question, (Some(way_m), again));
        Ok(Self { ground, nodes, surface, ends, how, kept, progress, meter: Meter::new(progress, Stage::Search) })
    }

    /// Gives the graph of a question.
    fn with_legs<T>(
        &self,
        question: &MissionQuestion<'_>,
        use_them: impl FnOnce(&Self, &TravelLegs<'_>) -> Result<T, RouteError>,
    ) -> Result<T, RouteError> {
        let MissionQuestion { route, rover, travel, .. } = *question;
        let settling = Settling::AfterAllBut(self.ends[1].1.at);
        let offered = (route.commands, self.how.takeoff);
        let offers = || LegOffers::new(&self.surface, settling, offered, route.errors).by_tables(self.kept.tables.as_ref());
        let hops = travel.hops().then(offers);
        let ground = travel.drives().then(|| DriveGround::new(self.ground, rover));
        let edges = self.kept.edges(ground.as_ref(), self.progress)?;
        let drive = ground.as_ref().map(|ground| DriveLegs::new(ground, self.nodes, edges.as_ref()));
        let ends = (Side::Start, self.ends[0], Some(self.ends[1]));
        let by = (hops.as_ref(), drive.as_ref());
        let legs = TravelLegs::new((self.ground, self.nodes), by, ends, self.kept.pairs_bytes, &self.meter);
        use_them(self, &legs)
    }

    /// The answer, and the hops that it depends on.
    fn best(&self, question: &MissionQuestion<'_>) -> Result<(Mission, Vec<[SurfaceNode; 2]>), RouteError> {
        self.with_legs(question, |asked, legs| {
            let RouteQuestion { objective, budgets, cap, .. } = question.route;
            let mut run = Run::new(legs, legs.ends(), Tracked::new(objective, budgets), cap);
            let best = run.until(true)?.map(|label| run.path(label)).transpose()?;
            let (mut capped, mut within) = (run.labels.capped, best.is_some());
            let reached = Self::reached(legs, &run);
            let mut work = MissionWork { reached: reached.len(), settled: run.settled, ..MissionWork::default() };
            let (mut found, mut unmet) = (best, Vec::new());
            if found.is_none()
                && !budgets.are_none()
                && let Some(without) = without_budgets(legs, legs.ends(), objective, budgets, cap)?
            {
                (within, unmet) = (without.within, without.unmet);
                capped |= without.capped;
                work.settled += without.work.1;
                found = Some(without.path);
            }
            let stopped = found.is_none().then(|| (asked.nearest(&reached), Self::refusals(legs, &reached)));
            let hops = found.iter().flat_map(|path| hops_of(legs, path)).collect();
            let path = found.as_ref().map(|path| asked.path(legs, path));
            [work.hops_tested, work.drives_tested] = legs.tested();
            Ok((Mission { path, within, unmet, capped, stopped, work }, hops))
        })
    }

    /// The nodes that have labels, ascending.
    fn reached(legs: &TravelLegs<'_>, run: &Run<'_, TravelLegs<'_>>) -> Vec<SurfaceNode> {
        let labelled = (0..legs.nodes()).filter(|state| run.labels.of_node(*state).next().is_some());
        let mut nodes: Vec<SurfaceNode> = labelled.map(|state| legs.node_of(state)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    fn nearest(&self, reached: &[SurfaceNode]) -> MapPosition {
        let [start, goal] = [self.ends[0].1, self.ends[1].1];
        let away = |at: &MapPosition| (at.at - goal.at).norm_squared();
        let positions = reached.iter().filter_map(|node| self.nodes.position(self.ground, *node));
        positions.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(start)
    }

    /// Why drive legs from reached nodes to others are refused.
    fn refusals(legs: &TravelLegs<'_>, reached: &[SurfaceNode]) -> DriveRefusalCounts {
        let mut counts = DriveRefusalCounts::default();
        let Some(drive) = legs.drive else { return counts };
        for node in reached {
            let Some(at) = drive.position(*node) else { continue };
            for (other, _) in drive.about(*node, at.at).filter(|(other, _)| reached.binary_search(other).is_err()) {
                let refusal = drive.position(other).map(|to| drive.leg(&at, &to));
                match refusal {
                    None => counts.count(crate::drive::DriveLimit::Ground),
                    Some(Err(refusal)) => counts.count(refusal.limit()),
                    Some(Ok(_)) => {}
                }
            }
        }
        counts
    }

    /// The places, moves and totals of a path.
    fn path(&self, legs: &TravelLegs<'_>, path: &FoundPath) -> MissionPath {
        let ends = path.steps.iter().map(|step| legs.node_of(step.to));
        let places = std::iter::once(self.ends[0].0).chain(ends);
        let mission_move = |step: &PathStep| legs.hop_of(step).map_or(MissionMove::Drive, MissionMove::Hop);
        MissionPath {
            places: places.filter_map(|node| self.nodes.position(self.ground, node)).collect(),
            moves: path.steps.iter().map(mission_move).collect(),
            totals: path.totals,
        }
    }
}
