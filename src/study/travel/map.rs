//! Where a machine that drives and hops gets from some starts, and back.

use super::super::{
    CaseError,
    free_route::left_out,
    map::{MapStudyError, PreparedMap},
};
use super::{plan::of_wheels, size::TravelMemory};
use crate::{
    ground::NodeLattice,
    planner::{
        Amount, LabelCap, MissionQuestion, NodesPerPost, Objective, RouteQuestion, SurfaceLattice, SurfaceNode, SurfaceNodes,
        Toward, Travel, TravelField, travel_field,
    },
    progress::Progress,
    reach::map::Post,
    report::{DeratingRecord, SizeAnswer, TravelGoalRecord, TravelMapAnswer, TravelReachRecord, TravelSumsRecord},
    scenario::{DriveKeys, Scenario},
    terrain::Dem,
};

/// A map of missions, with everything that its views need.
#[derive(Clone, Debug)]
pub struct TravelMap {
    nodes: SurfaceNodes,
    lattice: NodeLattice,
    /// The fields by each means, that of the machine first.
    fields: Vec<(Travel, TravelField)>,
    /// Missions back to a start, if asked for.
    back: Option<TravelField>,
    /// The answer as plain data.
    pub answer: TravelMapAnswer,
    /// Warnings about the search.
    pub warnings: Vec<String>,
}

/// Which means of travel alone reach a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReachedBy {
    /// By driving alone, and by hops alone.
    Either,
    /// By driving alone.
    Drive,
    /// By hops alone.
    Hop,
    /// By driving and hopping together.
    Together,
}

/// What is asked of a map of missions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TravelMapOptions {
    /// Also from where the machine gets back to a start.
    pub returns: bool,
    /// The most memory that all maps and their searches may take, bytes; `None`: as much as they need.
    pub memory_max_bytes: Option<u64>,
}

/// The means by which a map is made, that of the machine first.
const fn means(keys: &DriveKeys) -> &[Travel] {
    match keys.travel {
        Travel::Both => &[Travel::Both, Travel::Drive, Travel::Hop],
        Travel::Drive => &[Travel::Drive],
        Travel::Hop => &[Travel::Hop],
    }
}

fn nodes_of(prepared: &PreparedMap) -> Result<SurfaceNodes, MapStudyError> {
    let lattice = SurfaceLattice::new(prepared.planning.terrain().dem(), NodesPerPost::of(prepared.lattice.per_post));
    Ok(SurfaceNodes::new(&prepared.planning, lattice, [])?)
}

/// What the maps take at most, the labels that each search may keep, and the bytes that it may hold to be faster.
fn memory(
    prepared: &PreparedMap,
    nodes: &SurfaceNodes,
    scenario: &Scenario,
    options: TravelMapOptions,
) -> Result<(TravelMemory, LabelCap, u64), MapStudyError> {
    let keys = scenario.drives().ok_or(CaseError::DriveOnly)?;
    let fields = means(keys).len() + usize::from(options.returns);
    let asked = (&scenario.full_objective(), &scenario.total_budgets());
    let memory = TravelMemory::of_maps((&prepared.planning, nodes), keys, asked, fields);
    let (cap, kept_bytes) = memory.within(options.memory_max_bytes).map_err(|needed_bytes| {
        let allowed_bytes = options.memory_max_bytes.unwrap_or(u64::MAX);
        MapStudyError::MissionsTooLarge { needed_bytes, allowed_bytes, nodes: memory.nodes }
    })?;
    Ok((memory, cap, kept_bytes))
}

/// What the maps of a scenario with `[drive]` take at most, without the searches.
///
/// # Errors
/// [`MapStudyError`], as of [`travel_map`].
pub fn travel_map_size(
    prepared: &PreparedMap,
    scenario: &Scenario,
    options: TravelMapOptions,
) -> Result<SizeAnswer, MapStudyError> {
    let (memory, cap, kept_bytes) = memory(prepared, &nodes_of(prepared)?, scenario, options)?;
    Ok(memory.answer(cap, kept_bytes))
}

/// Finds where the machine of a scenario with `[drive]` gets from the starts of a map, by driving, by hops and by both.
///
/// # Arguments
/// `prepared`: the terrain, its nodes, and starts and goals.
///
/// # Errors
/// [`MapStudyError`].
pub fn travel_map(
    prepared: &PreparedMap,
    scenario: &Scenario,
    options: TravelMapOptions,
    progress: &dyn Progress,
) -> Result<TravelMap, MapStudyError> {
    let keys = scenario.drives().ok_or(CaseError::DriveOnly)?;
    let ground = &prepared.planning;
    let nodes = nodes_of(prepared)?;
    let (_, cap, kept_bytes_max) = memory(prepared, &nodes, scenario, options)?;
    let node = |post: Post| nodes.lattice_node((post.col, post.row));
    let starts: Vec<SurfaceNode> = prepared.starts.iter().map(|start| node(start.post)).collect();
    let objective = scenario.full_objective();
    let budgets = scenario.total_budgets();
    let field = |means: Travel, toward: Toward| {
        let route = RouteQuestion { objective: &objective, budgets: &budgets, commands: scenario.commands, errors: None, cap };
        let question = MissionQuestion { route, rover: &keys.rover, travel: means, kept_bytes_max };
        travel_field((ground, &nodes), &starts, (&question, scenario.search.takeoff, toward), progress)
    };
    let fields =
        means(keys).iter().map(|means| Ok((*means, field(*means, Toward::Nodes)?))).collect::<Result<Vec<_>, MapStudyError>>()?;
    let back = options.returns.then(|| field(keys.travel, Toward::Start)).transpose()?;
    let mut map = TravelMap {
        answer: answer(prepared, (scenario, keys), &objective),
        warnings: warnings(scenario, prepared.dem(), &objective),
        lattice: prepared.lattice,
        nodes,
        fields,
        back,
    };
    map.count(prepared);
    Ok(map)
}

/// What is to be known about the answer.
fn warnings(scenario: &Scenario, dem: &Dem, objective: &Objective) -> Vec<String> {
    let mut warnings = left_out(scenario);
    warnings.extend(of_wheels(scenario, dem));
    if objective.amounts().contains(&Amount::Risk) {
        warnings.push("risk counts for drive legs alone on a map of missions: hops are judged by plan and simulate".to_owned());
    }
    warnings
}

/// The answer before the nodes are counted.
fn answer(prepared: &PreparedMap, (scenario, keys): (&Scenario, &DriveKeys), objective: &Objective) -> TravelMapAnswer {
    let neighbours = keys.rover.limits().neighbours;
    let nodes = prepared.nodes();
    TravelMapAnswer {
        travel: keys.travel,
        starts_m: prepared.starts.iter().map(|start| [start.at.x, start.at.y]).collect(),
        nodes_per_post: prepared.lattice.per_post,
        node_spacing_m: nodes.dx_m().max(nodes.dy_m()),
        nodes: 0,
        no_data_nodes: 0,
        neighbours: neighbours.count(),
        elongation_max: neighbours.elongation(),
        objective: objective.amounts().to_vec(),
        labels_capped: false,
        reached: Vec::new(),
        only_together_nodes: None,
        return_nodes: None,
        there_and_back_nodes: None,
        derating: DeratingRecord::of(&scenario.derating),
        goals: Vec::new(),
    }
}

impl TravelMap {
    /// Nodes with an elevation, as their numbers in rasters.
    fn with_ground<'p>(&'p self, prepared: &'p PreparedMap) -> impl Iterator<Item = usize> + 'p {
        let has_ground = |index: &usize| self.lattice.position(prepared.dem(), self.lattice.node(*index)).is_some();
        (0..self.lattice.count()).filter(has_ground)
    }

    fn node(&self, index: usize) -> SurfaceNode {
        let Post { row, col } = self.lattice.node(index);
        self.nodes.lattice_node((col, row))
    }

    /// Counts nodes and states goals.
    #[expect(clippy::cast_precision_loss, reason = "counts of nodes stay far below 2^53")]
    fn count(&mut self, prepared: &PreparedMap) {
        let known: Vec<usize> = self.with_ground(prepared).collect();
        let reached = |field: &TravelField| known.iter().filter(|index| field.is_reached(self.node(**index))).count();
        let record = |(travel, field): &(Travel, TravelField)| {
            let mut times: Vec<f64> =
                known.iter().filter_map(|index| field.total(self.node(*index), Amount::MissionTime)).collect();
            times.sort_by(f64::total_cmp);
            let count = reached(field);
            TravelReachRecord {
                travel: *travel,
                reached_nodes: count,
                reached_share: count as f64 / known.len().max(1) as f64,
                mission_time_max_s: times.last().copied().unwrap_or(0.0),
                mission_time_median_s: times.get(times.len().saturating_sub(1) / 2).copied().unwrap_or(0.0),
            }
        };
        let records: Vec<TravelReachRecord> = self.fields.iter().map(record).collect();
        let together = (self.fields.len() > 1)
            .then(|| known.iter().filter(|index| self.reached_by(**index) == Some(ReachedBy::Together)).count());
        let first = &self.fields[0].1;
        let back = self.back.as_ref().map(|back| {
            let there_and_back =
                known.iter().filter(|index| first.is_reached(self.node(**index)) && back.is_reached(self.node(**index))).count();
            (reached(back), there_and_back)
        });
        let goal = |spot: &super::super::map::Spot| {
            let node = self.nodes.lattice_node((spot.post.col, spot.post.row));
            let total = |amount| first.total(node, amount).unwrap_or(f64::NAN);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of hops")]
            let sums = || TravelSumsRecord {
                hops: total(Amount::Hops) as u64,
                mission_time_s: total(Amount::MissionTime),
                energy_j_kg: total(Amount::Energy),
                distance_m: total(Amount::Distance),
            };
            let reached = first.is_reached(node);
            TravelGoalRecord { x_m: spot.at.x, y_m: spot.at.y, reached, totals: reached.then(sums) }
        };
        let goals = prepared.goals.iter().map(goal).collect();
        let capped = self.fields.iter().map(|(_, field)| field).chain(&self.back).any(|field| field.capped);
        let answer = &mut self.answer;
        (answer.nodes, answer.no_data_nodes) = (known.len(), self.lattice.count() - known.len());
        (answer.reached, answer.only_together_nodes, answer.labels_capped, answer.goals) = (records, together, capped, goals);
        (answer.return_nodes, answer.there_and_back_nodes) = back.unzip();
    }

    /// By which means alone a node is reached; `None` where it is not.
    pub fn reached_by(&self, index: usize) -> Option<ReachedBy> {
        let node = self.node(index);
        let by =
            |means: Travel| self.fields.iter().find(|(known, _)| *known == means).is_some_and(|(_, field)| field.is_reached(node));
        match (by(Travel::Drive), by(Travel::Hop)) {
            (true, true) => Some(ReachedBy::Either),
            (true, false) => Some(ReachedBy::Drive),
            (false, true) => Some(ReachedBy::Hop),
            (false, false) => by(Travel::Both).then_some(ReachedBy::Together),
        }
    }

    /// The total of an amount along the best mission to every node, row after row; NaN where no mission leads.
    ///
    /// # Returns
    /// `None` for an amount that the field does not know.
    pub fn totals(&self, amount: Amount) -> Option<Vec<f64>> {
        self.of(&self.fields[0].1, amount)
    }

    /// The same along the best mission from every node back to a start; `None` if that was not asked for.
    pub fn totals_back(&self, amount: Amount) -> Option<Vec<f64>> {
        self.of(self.back.as_ref()?, amount)
    }

    fn of(&self, field: &TravelField, amount: Amount) -> Option<Vec<f64>> {
        field
            .amounts()
            .contains(&amount)
            .then(|| (0..self.lattice.count()).map(|index| field.total(self.node(index), amount).unwrap_or(f64::NAN)).collect())
    }

    /// The amounts whose totals are known.
    pub fn amounts(&self) -> &[Amount] {
        self.fields[0].1.amounts()
    }
}
