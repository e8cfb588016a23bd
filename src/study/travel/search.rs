//! The search for a mission of a case.

use super::super::{Case, CaseError, JourneyError, dem_ground::dem_ground, free_route::FreeSearch, front::front_commands};
use super::size::TravelMemory;
use crate::{
    ground::DemGround,
    planner::{
        Amount, Budgets, Mission, MissionFront, MissionQuestion, Objective, RouteGoal, RouteQuestion, Toward, Travel,
        front_of_missions, travel, travel_field,
    },
    progress::Progress,
    report::SizeAnswer,
    scenario::{DriveKeys, Scenario},
    uncertainty::TravelToGo,
};

/// The nodes and the wheels of a case.
pub(super) struct TravelSearch {
    pub(super) free: FreeSearch,
    pub(super) keys: DriveKeys,
    /// The whole ground, over which errors are flown.
    whole: Option<DemGround>,
    memory: TravelMemory,
    /// How many bytes a search may hold to be faster.
    kept_bytes_max: u64,
}

impl TravelSearch {
    /// # Errors
    /// [`JourneyError`], also for a scenario that does not drive.
    pub(super) fn of(case: &Case) -> Result<Self, JourneyError> {
        let keys = case.scenario.drive.clone().ok_or(CaseError::DriveOnly)?;
        let mut free = FreeSearch::of(case)?;
        let memory = TravelMemory::of(&free, &keys);
        let (cap, kept_bytes_max) = memory.within(case.memory_max_bytes)?;
        free.cap = cap;
        let whole = dem_ground(&free.case).map_err(Box::new)?;
        Ok(Self { free, keys, whole, memory, kept_bytes_max })
    }

    /// What it takes at most.
    pub(super) fn size(&self) -> SizeAnswer {
        self.memory.answer(self.free.cap, self.kept_bytes_max)
    }

    pub(super) const fn scenario(&self) -> &Scenario {
        &self.free.case.scenario
    }

    /// What is asked, by these means and for this objective.
    fn question<'q>(&'q self, travel: Travel, objective: &'q Objective) -> MissionQuestion<'q> {
        let scenario = self.scenario();
        let by_risk = objective.amounts().contains(&Amount::Risk);
        let errors = scenario.uncertainty.as_ref().filter(|_| by_risk).map(|keys| &keys.errors);
        let route = RouteQuestion {
            objective,
            budgets: &self.free.budgets,
            commands: scenario.commands,
            errors: errors.zip(self.whole.as_ref()),
            cap: self.free.cap,
        };
        MissionQuestion { route, rover: &self.keys.rover, travel, kept_bytes_max: self.kept_bytes_max }
    }

    /// The best mission by the objective of the scenario.
    pub(super) fn best(&self, progress: &dyn Progress) -> Result<Mission, JourneyError> {
        self.by(self.keys.travel, &self.free.objective, progress)
    }

    /// The best mission by these means and for this objective.
    pub(super) fn by(&self, means: Travel, objective: &Objective, progress: &dyn Progress) -> Result<Mission, JourneyError> {
        let question = self.question(means, objective);
        Ok(travel(&self.free.ground, &self.free.nodes, &self.free.goal, &question, progress)?)
    }

    /// What the best missions take from all nodes to the goal, without budgets: by it a robot replans.
    pub(super) fn into_to_go(self, progress: &dyn Progress) -> Result<TravelToGo, JourneyError> {
        let mut question = self.question(self.keys.travel, &self.free.objective);
        question.route.budgets = &Budgets::NONE;
        let goal = self.free.nodes.place(self.free.goal.goal);
        let asked = (&question, self.free.goal.takeoff, Toward::Start);
        let field = travel_field((&self.free.ground, &self.free.nodes), goal.as_slice(), asked, progress)?;
        Ok(TravelToGo::new(&self.free.ground, self.free.nodes, field, self.keys.travel))
    }

    /// The front of up to so many hops against an amount.
    pub(super) fn front(&self, (amount, hops_max): (Amount, u64), progress: &dyn Progress) -> Result<MissionFront, JourneyError> {
        let objective = Objective::of(amount);
        let mut question = self.question(self.keys.travel, &objective);
        let (commands, takeoff) = front_commands(self.scenario());
        question.route.commands = commands;
        let goal = RouteGoal { takeoff, ..self.free.goal };
        #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
        let budgets = self.free.budgets.with(Amount::Hops, hops_max as f64).unwrap_or(self.free.budgets);
        question.route.budgets = &budgets;
        Ok(front_of_missions(&self.free.ground, &self.free.nodes, &goal, (amount, &question), progress)?)
    }
}
