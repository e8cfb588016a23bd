//! Hops over a whole terrain.

use std::path::PathBuf;

use super::{
    super::{AskError, Draft, OpenFacets, OpenMap, Purpose, Reply, ScenarioEnds, map::inputs},
    OVER_FACETS, refuse,
};
use crate::{
    planner::Amount,
    progress::Progress,
    quantity::MapPoint,
    report::{Document, DocumentKind},
    study::{
        LegsMapQuestion, MeshReachQuestion, PreparedLegsMap, TravelMapOptions,
        map::{MapQuestion, MapStudy, NamedPlace, PreparedMap},
        mesh_reach, travel_map,
    },
    terrain::MapPlace,
};

/// What is asked of a map.
#[derive(Clone, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is one more map or answer that is asked for")]
pub struct MapAsked {
    /// Another DEM than the scenario's.
    pub dem: Option<PathBuf>,
    /// The starts, m; none: the scenario's.
    pub starts_m: Vec<MapPoint>,
    /// The goals, m; none: the scenario's targets or its goal, where its start counts.
    pub goals_m: Vec<MapPoint>,
    /// Every so many posts are nodes; 0 counts as 1.
    pub stride: usize,
    /// One hop over level ground spans 8 nodes or more, in place of `search.node_spacing_max_m`.
    pub auto_nodes: bool,
    /// Also the least effort among paths of fewest hops, as `search.effort` names it.
    pub effort: bool,
    /// Also the hops back to the nearest start.
    pub returns: bool,
    /// Also the single hops from every node.
    pub mobility: bool,
    /// Also the node that the last hop to each comes from.
    pub predecessors: bool,
    /// Also trials along the path to every goal.
    pub trials: bool,
    /// Nodes that need more hops are not searched.
    pub hops_max: Option<i16>,
    /// Also the totals of these amounts along the path to every node.
    pub amounts: Vec<Amount>,
    /// The most memory, bytes, that the map may need.
    pub memory_max_bytes: Option<u64>,
}

/// A map: its document, and for hops over a DEM its rasters.
#[derive(Clone, Debug)]
pub struct MapReply {
    /// The document.
    pub reply: Reply,
    /// The nodes and what was found at them, of a hopper over a DEM.
    pub rasters: Option<(PreparedMap, MapStudy)>,
}

/// Positions under one name.
pub(super) fn named(name: &str, at_m: &[MapPoint]) -> Vec<NamedPlace> {
    at_m.iter().map(|at| NamedPlace { name: name.to_owned(), place: MapPlace::Metres(*at) }).collect()
}

/// The targets of a scenario's mission, or its goal.
pub(super) fn goals_of(open: &OpenMap) -> Vec<NamedPlace> {
    let named = |name: &str, place: MapPlace| NamedPlace { name: name.to_owned(), place };
    match (&open.scenario.mission, &open.ends) {
        (_, None) => Vec::new(),
        (Some(mission), Some(_)) => mission.targets.iter().map(|place| named("mission.targets_m", *place)).collect(),
        (None, Some([_, goal])) => vec![named("terrain.goal_m", *goal)],
    }
}

impl Draft {
    /// Finds the fewest hops to all of a DEM, or to contacts all over a mesh.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn map_hops(&self, asked: &MapAsked, progress: &dyn Progress) -> Result<MapReply, AskError> {
        let open = if asked.dem.is_none() { self.facets(Purpose::MapMesh)? } else { None };
        if let Some(open) = open {
            return Ok(MapReply { reply: over_mesh(&open, asked, progress)?, rasters: None });
        }
        let has_start = !asked.starts_m.is_empty();
        let ends = match (asked.dem.is_some(), has_start) {
            (_, false) => ScenarioEnds::Needed,
            (false, true) => ScenarioEnds::Offered,
            (true, true) => ScenarioEnds::Ignored,
        };
        let goals = !asked.goals_m.is_empty() || ends != ScenarioEnds::Ignored;
        let purpose = Purpose::Map { goals, effort: asked.effort, amounts: !asked.amounts.is_empty(), trials: asked.trials, ends };
        let open = self.clone().map(asked.dem.clone(), purpose)?;
        let starts = match &open.ends {
            Some([start, _]) if !has_start => vec![NamedPlace { name: "terrain.start_m".to_owned(), place: *start }],
            _ => named("start", &asked.starts_m),
        };
        let goals = if asked.goals_m.is_empty() { goals_of(&open) } else { named("goal", &asked.goals_m) };
        if open.scenario.legs.file.is_some() {
            return self.map_of_legs(asked, &open, [starts, goals], progress);
        }
        self.map_over_dem(asked, &open, [starts, goals], progress)
    }

    fn map_over_dem(
        &self,
        asked: &MapAsked,
        open: &OpenMap,
        [starts, goals]: [Vec<NamedPlace>; 2],
        progress: &dyn Progress,
    ) -> Result<MapReply, AskError> {
        let drives = open.scenario.drives().is_some();
        let question = MapQuestion {
            scenario: &open.scenario,
            base: &open.base,
            dem: &open.dem,
            starts,
            goals,
            stride: asked.stride.max(1),
            auto_nodes: asked.auto_nodes,
            effort: asked.effort,
            returns: asked.returns,
            mobility: asked.mobility,
            ranks_sites: false,
            predecessors: asked.predecessors,
            refusals: false,
            trials: asked.trials,
            hops_max: asked.hops_max,
            amounts: asked.amounts.clone(),
            // The memory of a map of missions is another.
            memory_max_bytes: asked.memory_max_bytes.filter(|_| !drives),
        };
        let prepared = PreparedMap::new(&question)?;
        let files = inputs(&open.files(), self)?;
        let head = (open.document.clone(), files);
        if drives {
            let unwanted = [
                (asked.effort, "an effort"),
                (asked.mobility, "a mobility"),
                (asked.trials, "trials"),
                (asked.predecessors, "predecessors"),
            ];
            refuse(&unwanted, "a map of missions that drive has none")?;
            let options = TravelMapOptions { returns: asked.returns, memory_max_bytes: asked.memory_max_bytes };
            let found = travel_map(&prepared, &open.scenario, options, progress)?;
            let warnings = [&open.warnings[..], &prepared.warnings, &found.warnings].concat();
            let document = Document::new(DocumentKind::MapTravel, head.0, head.1, warnings, &found.answer);
            let json = document.on_map(prepared.projection.as_ref().ok()).to_json()?;
            let reply = Reply::new(DocumentKind::MapTravel, json, found.answer.reaches_all_goals());
            return Ok(MapReply { reply, rasters: None });
        }
        let study = prepared.answered(&question, progress)?;
        let warnings = [&open.warnings[..], &study.warnings].concat();
        let document = Document::new(DocumentKind::Map, head.0, head.1, warnings, &study.answer);
        let json = document.on_map(prepared.projection.as_ref().ok()).to_json()?;
        let reply = Reply::new(DocumentKind::Map, json, study.answer.reaches_all_goals());
        Ok(MapReply { reply, rasters: Some((prepared, study)) })
    }

    fn map_of_legs(
        &self,
        asked: &MapAsked,
        open: &OpenMap,
        [starts, goals]: [Vec<NamedPlace>; 2],
        progress: &dyn Progress,
    ) -> Result<MapReply, AskError> {
        let unwanted = [
            (asked.effort, "an effort"),
            (asked.returns, "ways back"),
            (asked.mobility, "a mobility"),
            (asked.trials, "trials"),
            (asked.predecessors, "predecessors"),
            (!asked.amounts.is_empty(), "totals of amounts"),
        ];
        refuse(&unwanted, "a map of stances has none")?;
        let question = LegsMapQuestion {
            scenario: &open.scenario,
            base: &open.base,
            dem: &open.dem,
            starts,
            goals,
            stride: asked.stride.max(1),
            hops_max: asked.hops_max,
            memory_max_bytes: asked.memory_max_bytes,
        };
        let prepared = PreparedLegsMap::new(&question)?;
        let found = prepared.answered(&question, progress)?;
        let warnings = [&open.warnings[..], &prepared.warnings, &found.warnings].concat();
        let files = inputs(&open.files_with_robot(), self)?;
        let mut document = Document::new(DocumentKind::MapLegs, open.document.clone(), files, warnings, &found.answer);
        document.crs.clone_from(&prepared.crs);
        let reply = Reply::new(DocumentKind::MapLegs, document.to_json()?, found.answer.reaches_all_goals());
        Ok(MapReply { reply, rasters: None })
    }
}

/// Finds what is reached over a mesh.
fn over_mesh(open: &OpenFacets, asked: &MapAsked, progress: &dyn Progress) -> Result<Reply, AskError> {
    let unwanted = [
        (!asked.starts_m.is_empty(), "starts"),
        (!asked.goals_m.is_empty(), "goals"),
        (asked.stride > 1, "a stride"),
        (asked.auto_nodes, "a spacing of nodes"),
        (asked.effort, "an effort"),
        (asked.mobility, "a mobility"),
        (asked.trials, "trials"),
        (asked.predecessors, "predecessors"),
        (!asked.amounts.is_empty(), "totals of amounts"),
        (asked.memory_max_bytes.is_some(), "a limit of memory"),
    ];
    refuse(&unwanted, OVER_FACETS)?;
    let hops_max = asked.hops_max.map(|most| u32::from(most.unsigned_abs()));
    let question = MeshReachQuestion { scenario: &open.scenario, base: &open.base, hops_max, returns: asked.returns };
    let reached = mesh_reach(&question, progress)?;
    let json = open.document(DocumentKind::MapMesh, &reached.warnings, &reached.answer)?;
    let reply = Reply::new(DocumentKind::MapMesh, json, reached.answer.reaches_the_goal());
    #[cfg(feature = "plot")]
    let reply = reply.drawn({
        let scenario = open.scenario.clone();
        move || Some(reached.picture(&scenario, crate::figure::SeenFrom::default()))
    });
    Ok(reply)
}
