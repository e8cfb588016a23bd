//! Landing sites ranked.

use super::{
    super::{AskError, Draft, Purpose, Reply, ScenarioEnds, map::inputs},
    map::{goals_of, named},
    refuse,
};
use crate::{
    progress::Progress,
    quantity::MapPoint,
    report::{Document, DocumentKind},
    study::{
        Candidates, SitesQuestion,
        map::{MapQuestion, PreparedMap},
        sites,
    },
};

/// What is asked of landing sites.
#[derive(Clone, Debug, Default)]
pub struct SitesAsked {
    /// Another DEM than the scenario's.
    pub dem: Option<std::path::PathBuf>,
    /// The candidates, m; none: every `every`-th node.
    pub candidates_m: Vec<MapPoint>,
    /// Every so many nodes in rows and columns; 0 counts as 1.
    pub every: usize,
    /// The targets, m; none: the scenario's targets, or its goal.
    pub targets_m: Vec<MapPoint>,
    /// Every so many posts are nodes; 0 counts as 1.
    pub stride: usize,
    /// One hop over level ground spans 8 nodes or more, in place of `search.node_spacing_max_m`.
    pub auto_nodes: bool,
    /// Also trials of the paths to the targets, as many as `uncertainty.trials` says.
    pub trials: bool,
    /// The most memory, bytes, that a map may need.
    pub memory_max_bytes: Option<u64>,
}

impl Draft {
    /// Ranks landing sites.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn sites(&self, asked: &SitesAsked, progress: &dyn Progress) -> Result<Reply, AskError> {
        let ends = if asked.dem.is_some() { ScenarioEnds::Ignored } else { ScenarioEnds::Offered };
        let open = self.clone().map(asked.dem.clone(), Purpose::Sites { trials: asked.trials, ends })?;
        let drives = open.scenario.drives().is_some();
        refuse(&[(drives, "a scenario that drives")], "landing sites are ranked by hops; set drive.travel = \"hop\"")?;
        let map = MapQuestion {
            scenario: &open.scenario,
            base: &open.base,
            dem: &open.dem,
            starts: Vec::new(),
            goals: if asked.targets_m.is_empty() { goals_of(&open) } else { named("target", &asked.targets_m) },
            stride: asked.stride.max(1),
            auto_nodes: asked.auto_nodes,
            effort: false,
            returns: true,
            mobility: false,
            ranks_sites: true,
            predecessors: false,
            refusals: false,
            trials: asked.trials,
            hops_max: None,
            amounts: Vec::new(),
            memory_max_bytes: asked.memory_max_bytes,
        };
        let candidates = match &asked.candidates_m[..] {
            [] => Candidates::Every(asked.every.max(1)),
            places => Candidates::Places(named("candidate", places)),
        };
        let question = SitesQuestion { map, candidates };
        let prepared = PreparedMap::new(&question.map)?;
        let study = sites(&prepared, &question, progress)?;
        let warnings = [&open.warnings[..], &study.warnings].concat();
        let files = inputs(&open.files(), self)?;
        let document = Document::new(DocumentKind::Sites, open.document.clone(), files, warnings, &study.answer);
        let json = document.on_map(prepared.projection.as_ref().ok()).to_json()?;
        Ok(Reply::new(DocumentKind::Sites, json, study.answer.has_site()))
    }
}
