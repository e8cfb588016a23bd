//! A scenario over its terrain: what the questions along a chain are asked of.

use std::{
    path::{Path, PathBuf},
    sync::{Arc, OnceLock},
};

use super::{
    CaseRecord, JourneyEnd, Overlays, PipelineError, Prepared, Survey, footprint::SlicedDem, free_route::free_alone,
    overlays::planned_over, scenario_files, with_measured_errors,
};
use crate::{
    chain::{PolygonalChain, Station},
    ground::DemGround,
    hop::HopTest,
    report::{CrsRecord, InputFile, MapKnowledge},
    scenario::{Scenario, TerrainSource, scenario_document},
    world::Hopper,
};

/// Which commands an answer assumes that the machine flies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Commands {
    /// Those of the machine, in steps if it takes its commands in steps.
    #[default]
    OfTheMachine,
    /// Any command up to the machine's greatest.
    Exact,
}

impl Commands {
    /// The hopper that flies them.
    fn hopper(self, hopper: &Hopper) -> Hopper {
        match self {
            Self::OfTheMachine => *hopper,
            Self::Exact => hopper.with_any_command(),
        }
    }
}

/// A scenario over its terrain.
#[derive(Clone, Debug)]
pub struct Case {
    /// The scenario as used, with its measured errors if it names any.
    pub scenario: Scenario,
    /// The folder that its paths start from.
    pub base: PathBuf,
    /// The chain, with start and goal where they are known, and all warnings about the input.
    pub prepared: Prepared,
    /// The same chain under the limits that planning may use, where they are shares of those of the machine.
    derated: Option<Box<Prepared>>,
    /// The commands that the chain is prepared for.
    commands: Commands,
    /// The DEM that the chain was sliced from, whose posts are shared by all cases over this terrain, and its overlays.
    pub(super) sliced: Option<(SlicedDem, Overlays)>,
    /// The most memory that a search for a free route may take, bytes; `None` for as much as it needs.
    pub(super) memory_max_bytes: Option<u64>,
    /// The whole ground of this case, once trials have flown over it.
    pub(super) ground: Arc<OnceLock<DemGround>>,
}

/// The scenario under the limits that planning may use, for these commands.
fn derated_for(scenario: &Scenario, commands: Commands) -> Option<Scenario> {
    let derated = scenario.derated()?;
    Some(Scenario { hopper: commands.hopper(&derated.hopper), ..derated })
}

/// Refuses a robot that cannot follow a path.
pub(super) fn controlled(scenario: &Scenario) -> Result<(), CaseError> {
    let drifts = scenario.uncertainty.as_ref().is_some_and(|keys| keys.drift.is_some());
    if drifts { Err(CaseError::Uncontrolled) } else { Ok(()) }
}

/// Why a scenario gives no case, or a case no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError {
    /// A scenario without terrain.
    #[error("found no terrain, expected [terrain] with dem, mesh or chain")]
    NoTerrain,
    /// A terrain without a usable chain.
    #[error(transparent)]
    Prepare(#[from] PipelineError),
    /// A question about a free route that only a transect answers.
    #[error("{question} only along a transect, and terrain.route is \"free\": set terrain.route = \"transect\" for it")]
    TransectOnly {
        /// What is wanted, with its verb.
        question: &'static str,
    },
    /// A question about a transect that only a free route answers.
    #[error("{question} only for a free route, and the route is a transect: set terrain.route = \"free\" over a dem for it")]
    FreeOnly {
        /// What is wanted, with its verb.
        question: &'static str,
    },
    /// A question that is answered for hops alone.
    #[error("{question} for hops alone, and this scenario drives: set drive.travel = \"hop\", or remove [drive]")]
    HopsOnly {
        /// What is wanted, with its verb.
        question: &'static str,
    },
    /// A question that is answered for one goal alone.
    #[error("{question} for one goal alone, and this scenario visits targets: remove [mission] and give terrain.goal_m")]
    OneGoal {
        /// What is wanted, with its verb.
        question: &'static str,
    },
    /// A question that does not count how long layers are left.
    #[error(
        "{question}, which does not count how long the condition of a layer is unmet, and layer.{layer} may be left for a while: remove \
         its outage_max_s, outage_hops_max and exempt_targets"
    )]
    Outage {
        /// The layer.
        layer: crate::world::LayerName,
        /// What is wanted, with its verb.
        question: &'static str,
    },
    /// A layer with a cost, where paths are not what is asked for.
    #[error(
        "{question}, which does not count what a layer costs along a path, and layer.{layer} has a cost: remove its cost_per_contact, \
         cost_per_m and total_max"
    )]
    LayerCost {
        /// The layer.
        layer: crate::world::LayerName,
        /// What is wanted, with its verb.
        question: &'static str,
    },
    /// A robot whose heading is not controlled, where a path is asked for.
    #[error(
        "found uncertainty.heading = \"uncontrolled\", with which no path can be followed, expected it for trials alone: remove heading, \
         takeoff_speed_m_s and takeoff_angle_deg, and give terrain.goal_m"
    )]
    Uncontrolled,
    /// A question about targets without any.
    #[error("found no [mission], expected mission.targets_m")]
    NoTargets,
    /// A question about driving without wheels.
    #[error("found no [drive], expected drive.speed_m_s and drive.slope_up_max_deg for a mission that drives")]
    DriveOnly,
    /// A start or goal that is given nowhere.
    #[error("found no {name}, expected terrain.{name}_x_m, or for a dem or mesh terrain.{name}_m", name = which.name())]
    MissingEnd {
        /// Start or goal.
        which: JourneyEnd,
    },
}

impl Case {
    /// Reads the terrain of a scenario, whose paths start from the folder `base`, and prepares its chain.
    ///
    /// # Errors
    /// [`CaseError::NoTerrain`] and [`CaseError::Prepare`].
    pub fn new(scenario: Scenario, base: &Path, commands: Commands) -> Result<Self, CaseError> {
        let terrain = scenario.terrain.as_ref().ok_or(CaseError::NoTerrain)?;
        let survey = Self::survey(&scenario, terrain, base, commands)?;
        Self::surveyed(&survey, scenario, base, commands)
    }

    /// The terrain of such a case, read.
    pub(super) fn survey(
        scenario: &Scenario,
        terrain: &TerrainSource,
        base: &Path,
        commands: Commands,
    ) -> Result<Survey, CaseError> {
        controlled(scenario)?;
        let hopper = commands.hopper(&scenario.hopper);
        Ok(Survey::of(&Scenario { hopper, ..scenario.clone() }, terrain, base)?)
    }

    /// The case over its terrain, which may have been read for another one, with the ground beside the line where hops leave it.
    pub(super) fn surveyed(survey: &Survey, scenario: Scenario, base: &Path, commands: Commands) -> Result<Self, CaseError> {
        controlled(&scenario)?;
        let survey = survey.under(&scenario)?;
        let hopper = commands.hopper(&scenario.hopper);
        let whole = Scenario { hopper, ..scenario.clone() };
        if scenario.derating.is_none() {
            let mut prepared = survey.prepare_with_ground(&whole)?;
            let (scenario, of_errors) = with_measured_errors(scenario, base)?;
            prepared.warnings.extend(of_errors);
            let (sliced, ground) = (survey.sliced(), Arc::default());
            return Ok(Self {
                scenario,
                base: base.to_path_buf(),
                prepared,
                derated: None,
                commands,
                sliced,
                memory_max_bytes: None,
                ground,
            });
        }
        let mut case = Self::over(&survey, scenario, base, commands)?;
        case.prepared.beside_line = survey.beside_line(&whole)?;
        let beside_line = case.prepared.beside_line.as_deref().map(|ground| Arc::new(planned_over(ground, &whole)));
        if let Some(prepared) = &mut case.derated {
            prepared.beside_line = beside_line;
        }
        Ok(case)
    }

    /// A case along a chain that is no file, of a scenario without terrain. Without ends of its own it goes from one end of the chain to
    /// the other. Its [record](Self::record) cannot be made, since its terrain has no name.
    ///
    /// # Errors
    /// [`CaseError::Prepare`].
    pub fn along(chain: PolygonalChain, scenario: Scenario, base: &Path) -> Result<Self, CaseError> {
        let (first_m, last_m) = chain.extent_m();
        let scenario = Scenario {
            terrain: Some(TerrainSource::Chain { path: PathBuf::new() }),
            start_x_m: scenario.start_x_m.or(Some(first_m)),
            goal_x_m: scenario.goal_x_m.or(Some(last_m)),
            ..scenario
        };
        Self::over(&Survey::along(chain), scenario, base, Commands::OfTheMachine)
    }

    /// The same over terrain that was read before.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn over(survey: &Survey, scenario: Scenario, base: &Path, commands: Commands) -> Result<Self, CaseError> {
        controlled(&scenario)?;
        let survey = survey.under(&scenario)?;
        let (scenario, of_errors) = with_measured_errors(scenario, base)?;
        if scenario.terrain.is_none() {
            return Err(CaseError::NoTerrain);
        }
        let hopper = commands.hopper(&scenario.hopper);
        let whole = Scenario { hopper, ..scenario.clone() };
        let derated = derated_for(&scenario, commands);
        let derated = derated.map(|derated| survey.prepare_derated(&whole, &derated)).transpose()?.map(Box::new);
        let mut prepared = survey.prepare(&whole)?;
        prepared.warnings.extend(of_errors);
        let (sliced, ground) = (survey.sliced(), Arc::default());
        Ok(Self { prepared, scenario, base: base.to_path_buf(), derated, commands, sliced, memory_max_bytes: None, ground })
    }

    /// The same case, whose search for a free route may take no more memory than this.
    ///
    /// # Errors
    /// [`CaseError::FreeOnly`] for a limit along a transect.
    pub fn within_memory(self, memory_max_bytes: Option<u64>) -> Result<Self, CaseError> {
        if memory_max_bytes.is_some() {
            free_alone(&self.scenario, "the memory of a search is limited")?;
        }
        Ok(Self { memory_max_bytes, ..self })
    }

    /// The same chain for the question of another case, whose scenario and warnings about the input it then states.
    pub(super) fn asked_by(self, other: &Self) -> Self {
        let prepared = Prepared { warnings: other.prepared.warnings.clone(), ..self.prepared };
        Self { scenario: other.scenario.clone(), prepared, sliced: other.sliced.clone(), ground: Arc::clone(&other.ground), ..self }
    }

    /// The same case between these stations of its chain.
    pub(super) fn between(&self, (start, goal): (Station, Station)) -> Self {
        let scenario = Scenario { start_x_m: Some(start.point.x_m), goal_x_m: Some(goal.point.x_m), ..self.scenario.clone() };
        let prepared = Prepared { start: Some(start), goal: Some(goal), ..self.prepared.clone() };
        Self { scenario, prepared, ..self.clone() }
    }

    /// The same case for these commands: its chain is prepared again if they make a difference.
    ///
    /// # Errors
    /// As [`Case::new`].
    pub fn with_commands(&self, commands: Commands) -> Result<Self, CaseError> {
        if commands == self.commands || self.scenario.hopper.limits().steps.is_continuous() {
            return Ok(self.clone());
        }
        let mut case = Self::new(self.scenario.clone(), &self.base, commands)?;
        case.prepared.warnings = self.warnings_with(case.prepared.warnings);
        case.memory_max_bytes = self.memory_max_bytes;
        Ok(case)
    }

    /// The chain under the limits that planning may use.
    pub fn planning(&self) -> &Prepared {
        self.derated.as_deref().unwrap_or(&self.prepared)
    }

    /// The hop test over the chain, under the limits that planning may use.
    pub fn hop_test(&self) -> HopTest {
        HopTest::new(Arc::clone(&self.planning().chain))
    }

    /// The hop test under the whole limits, where planning may use only shares of them.
    pub fn whole_test(&self) -> Option<HopTest> {
        self.derated.as_ref().map(|_| HopTest::new(Arc::clone(&self.prepared.chain)))
    }

    /// Start and goal.
    ///
    /// # Errors
    /// [`CaseError::MissingEnd`], for the first that is given nowhere.
    pub fn ends(&self) -> Result<(Station, Station), CaseError> {
        let end = |which, station: Option<Station>| station.ok_or(CaseError::MissingEnd { which });
        Ok((end(JourneyEnd::Start, self.prepared.start)?, end(JourneyEnd::Goal, self.prepared.goal)?))
    }

    /// The warnings about the input and an answer, without repetition.
    pub fn warnings_with(&self, more: impl IntoIterator<Item = String>) -> Vec<String> {
        let mut warnings = self.prepared.warnings.clone();
        for warning in more {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        warnings
    }

    /// How the chain is located on a map, which determines the columns of its paths.
    pub fn map_knowledge(&self) -> MapKnowledge {
        match (self.prepared.chain.geometry().map_points(), &self.prepared.projection) {
            (None, _) => MapKnowledge::Nothing,
            (Some(_), None) => MapKnowledge::Metres,
            (Some(_), Some(_)) => MapKnowledge::Projection,
        }
    }

    /// Whether the terrain is a raster, so that trials fly in three dimensions.
    pub const fn is_on_dem(&self) -> bool {
        matches!(self.scenario.terrain, Some(TerrainSource::Dem { .. }))
    }

    /// What a result says of this case. Files are `name`d by the caller, such as relative to its working folder.
    ///
    /// # Errors
    /// [`PipelineError::Read`].
    pub fn record(&self, name: &dyn Fn(&Path) -> String) -> Result<CaseRecord, PipelineError> {
        Ok(self.recorded(super::checksums(&scenario_files(&self.scenario, &self.base), name)?, name))
    }

    /// The same with the checksums of its files.
    pub(super) fn recorded(&self, inputs: Vec<InputFile>, name: &dyn Fn(&Path) -> String) -> CaseRecord {
        CaseRecord {
            scenario: scenario_document(&self.scenario, &|path| name(&self.base.join(path))),
            inputs,
            warnings: self.prepared.warnings.clone(),
            crs: self.prepared.projection.as_ref().map(CrsRecord::from),
        }
    }
}
