//! The least capability with which the goal can be reached.

use super::{
    Case, CaseError, Commands, JourneyError, Variation, ask_the_same, free_nodes::QuestionNodes, journey_path::JourneyPath,
    require_free::require_free, require_success::SuccessSearch, value_scan::ValueScan,
};
use crate::{
    chain::Station,
    graph::{
        Outcome, SearchError,
        proof::{Bounds, BoundsOptions, CapabilityRange, ProofVerdict, Until, bounds, least_capability},
    },
    path::generate,
    progress::{Cancelled, Progress},
    quantity::Angle,
    report::{
        BudgetsTry, DeratingRecord, GapRecord, HopRecord, ObjectiveRecord, QuestionRouteRecord, RequireAnswer,
        RequireBudgetsRecord, RequireTry, TotalsRecord,
    },
    scenario::{Entries, Key, Kind, Route, Scenario, ScenarioProblem},
};

/// The key of the height to keep over the ground.
const CLEARANCE: &str = "hopper.clearance_m";

/// A scenario key that makes a hopper more or less capable, with its default range of values.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Capability {
    path: &'static str,
    /// Whether the greater value is the more capable one.
    more_is_more: bool,
    from: f64,
    to: f64,
}

const fn capability(path: &'static str, more_is_more: bool, from: f64, to: f64) -> Capability {
    Capability { path, more_is_more, from, to }
}

/// All keys for which a more capable value never removes a feasible hop or drive leg.
const CAPABILITIES: [Capability; 18] = [
    capability("hopper.takeoff_speed_max_m_s", true, 0.01, 100.0),
    capability("hopper.landing_speed_max_m_s", true, 0.01, 100.0),
    capability(CLEARANCE, false, 0.0, 100.0),
    capability("hopper.takeoff_angle_min_deg", false, -90.0, 90.0),
    capability("hopper.takeoff_angle_max_deg", true, -90.0, 90.0),
    capability("hopper.apex_height_max_m", true, 0.001, 1000.0),
    capability("hopper.flight_time_max_s", true, 0.001, 1000.0),
    capability("hopper.roughness_max_m", true, 0.0, 100.0),
    capability("hopper.takeoff_speed_min_m_s", false, 0.001, 100.0),
    capability("surface.friction_coefficient", true, 0.01, 10.0),
    capability("surface.rest_slope_max_deg", true, 0.0, 90.0),
    capability("body.gravity_m_s2", false, 0.001, 30.0),
    capability("drive.speed_m_s", true, 0.001, 10.0),
    capability("drive.slope_up_max_deg", true, 0.0, 90.0),
    capability("drive.slope_down_max_deg", true, 0.0, 90.0),
    capability("drive.cross_slope_max_deg", true, 0.0, 90.0),
    capability("drive.step_max_m", true, 0.0, 10.0),
    capability("drive.roughness_max_m", true, 0.0, 10.0),
];

/// All keys that change no path that exists, but how reliably it is flown: with a wanted success, the least capable value that has it.
const OF_SUCCESS: [Capability; 13] = [
    capability("uncertainty.takeoff_speed_sigma_m_s", false, 0.0, 10.0),
    capability("uncertainty.takeoff_speed_sigma_fraction", false, 0.0, 1.0),
    capability("uncertainty.takeoff_angle_sigma_deg", false, 0.0, 30.0),
    capability("uncertainty.heading_sigma_deg", false, 0.0, 30.0),
    capability("uncertainty.position_sigma_m", false, 0.0, 100.0),
    capability("uncertainty.drift_along_sigma_m", false, 0.0, 100.0),
    capability("uncertainty.drift_across_sigma_m", false, 0.0, 100.0),
    capability("uncertainty.friction_sigma", false, 0.0, 1.0),
    capability("uncertainty.height_sigma_m", false, 0.0, 10.0),
    capability("uncertainty.goal_tolerance_m", true, 0.0, 100.0),
    capability("derating.takeoff_speed", false, 0.1, 1.0),
    capability("derating.landing_speed", false, 0.1, 1.0),
    capability("derating.friction", false, 0.1, 1.0),
];

/// Why no least capability is found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RequireError {
    /// A key for which more is not more.
    #[error(
        "{key}: found no key that makes a hopper more capable, expected one of {}; or, with a success wanted \
         (budget.estimated_success_min), one of {}",
        CAPABILITIES.map(|known| known.path).join(", "),
        OF_SUCCESS.map(|known| known.path).join(", ")
    )]
    UnknownKey {
        /// The key, as typed.
        key: String,
    },
    /// A key of reliability without a wanted success.
    #[error(
        "{key}: it changes how reliably paths are flown, not which exist, and found no success that is wanted: give \
         budget.estimated_success_min, such as 0.9"
    )]
    NoSuccessWanted {
        /// The key.
        key: &'static str,
    },
    /// An empty range, or one beyond the values of the key.
    #[error("from and to: {0}")]
    Range(RangeProblem),
    /// A resolution that is no share.
    #[error("resolution: found {found}, expected a share above 0 and below 1, such as 0.001")]
    Resolution {
        /// What was given.
        found: f64,
    },
    /// Less gravity under a limit on the time of flight.
    #[error(
        "{GRAVITY}: less gravity makes hops longer, but hopper.flight_time_max_s then forbids more of them: leave that limit away"
    )]
    GravityWithFlightTime,
    /// Less gravity under a least speed.
    #[error(
        "{GRAVITY}: less gravity makes hops longer, but hopper.takeoff_speed_min_m_s and hopper.takeoff_speed_levels_m_s then forbid the \
         short ones: leave those away"
    )]
    GravityWithLeastSpeed,
    /// A key without effect over the whole range.
    #[error(
        "{key}: no value from {from} to {to} changes anything here: the chain's own limits, its friction or the escape speed decide, or the \
         range lies beyond them"
    )]
    NoEffect {
        /// The key.
        key: &'static str,
        /// The least value.
        from: f64,
        /// The greatest value.
        to: f64,
    },
    /// A value that the scenario does not take.
    #[error("{}", problems.iter().map(|problem| format!("{}; {}", problem.message, problem.help)).collect::<Vec<_>>().join("; "))]
    Scenario {
        /// Every problem.
        problems: Vec<ScenarioProblem>,
    },
    /// A case without a chain, start or goal.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A proof.
    #[error(transparent)]
    Search(#[from] SearchError),
    /// The estimate of a success.
    #[error(transparent)]
    Journey(#[from] JourneyError),
}

impl From<Cancelled> for RequireError {
    fn from(cancelled: Cancelled) -> Self {
        Self::Search(cancelled.into())
    }
}

/// A range of values that the key does not take.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("found {from} and {to}, expected the first below the second, both from {least} to {greatest} as {key} takes them")]
pub struct RangeProblem {
    key: &'static str,
    from: f64,
    to: f64,
    least: f64,
    greatest: f64,
}

/// The key of gravity.
const GRAVITY: &str = "body.gravity_m_s2";

/// What is sought: the least capable value of a key, within a range.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    capability: Capability,
    range: [f64; 2],
    /// Whether the caller gave both ends of the range.
    is_given: bool,
    resolution: f64,
    budget_cells: usize,
    given_by: String,
}

impl Requirement {
    /// A requirement on a key, such as `hopper.takeoff_speed_max_m_s`, within a range; an absent end is that of the key. Each value is
    /// proved with so many cells at most.
    ///
    /// `resolution`: how close the two values are brought, as a fraction of them. `given_by`: the caller's name for the source of the
    /// values, with which problems begin.
    ///
    /// # Errors
    /// [`RequireError::UnknownKey`], [`RequireError::Range`] and [`RequireError::Resolution`].
    pub fn new(
        key: &str,
        [from, to]: [Option<f64>; 2],
        resolution: f64,
        budget_cells: usize,
        given_by: &str,
    ) -> Result<Self, RequireError> {
        let capability = CAPABILITIES.into_iter().chain(OF_SUCCESS).find(|capability| capability.path == key);
        let capability = capability.ok_or_else(|| RequireError::UnknownKey { key: key.to_owned() })?;
        let is_given = from.is_some() && to.is_some();
        let (from, to) = (from.unwrap_or(capability.from), to.unwrap_or(capability.to));
        let (least, greatest) = match capability.key().map(|key| key.kind) {
            Some(Kind::Number { min, max }) => (min, max),
            _ => (0.0, 90.0),
        };
        let in_range = least <= from && from < to && to <= greatest;
        if !in_range {
            return Err(RequireError::Range(RangeProblem { key: capability.path, from, to, least, greatest }));
        }
        if !(resolution > 0.0 && resolution < 1.0) {
            return Err(RequireError::Resolution { found: resolution });
        }
        Ok(Self { capability, range: [from, to], is_given, resolution, budget_cells, given_by: given_by.to_owned() })
    }

    /// The keys as typed with the most capable value, for reading the terrain.
    pub fn strongest(&self, entries: &Entries) -> Entries {
        self.with_value(entries, self.ends().1)
    }

    /// The weakest and the strongest value of the range.
    const fn ends(&self) -> (f64, f64) {
        let [from, to] = self.range;
        if self.capability.more_is_more { (from, to) } else { (to, from) }
    }

    /// The keys as typed with a value of the varied one.
    fn with_value(&self, entries: &Entries, value: f64) -> Entries {
        let mut entries = entries.clone();
        if let Some(key) = self.capability.key() {
            let given_by = format!("{} {}={value:?}", self.given_by, self.capability.path);
            entries.set_by_option(&given_by, key.table, key.name, toml::Value::Float(value));
        }
        entries
    }

    /// The scenario at a value.
    fn scenario(&self, variation: &Variation, value: f64) -> Result<Scenario, RequireError> {
        let scenario = Scenario::new(self.with_value(&variation.entries, value));
        scenario.map_err(|problems| RequireError::Scenario { problems })
    }
}

/// A requirement on a scenario over its terrain.
pub(super) struct Question<'q> {
    pub(super) variation: &'q Variation,
    requirement: &'q Requirement,
    /// The nodes of free routes.
    nodes: Option<QuestionNodes>,
}

impl Question<'_> {
    /// The case at a value.
    pub(super) fn at(&self, value: f64) -> Result<Case, RequireError> {
        let scenario = self.requirement.scenario(self.variation, value)?;
        let scenario = match &self.nodes {
            Some(nodes) => nodes.of(scenario),
            None => scenario,
        };
        Ok(Case::over(&self.variation.survey, scenario, self.variation.base(), Commands::Exact)?)
    }

    /// The key.
    pub(super) const fn key(&self) -> &'static str {
        self.requirement.capability.path
    }

    /// The nodes of free routes as plain data.
    pub(super) fn route_record(&self) -> Option<QuestionRouteRecord> {
        self.nodes.map(|nodes| nodes.record)
    }

    /// An answer that shows the case of a value.
    pub(super) fn required(&self, shown: Case, value: f64, answer: RequireAnswer) -> Required {
        let Self { variation, requirement, .. } = self;
        let shown_entries = requirement.with_value(&variation.entries, value);
        let mut warnings = variation.first.prepared.warnings.clone();
        warnings.extend(self.nodes.iter().flat_map(|nodes| nodes.warnings(&shown.scenario)));
        Required { shown, shown_entries, answer, warnings }
    }
}

impl Capability {
    /// The key of the scenario.
    fn key(&self) -> Option<&'static Key> {
        self.path.split_once('.').and_then(|(table, name)| Key::find(table, name))
    }

    /// Whether it changes only how reliably paths are flown.
    fn is_of_success(&self) -> bool {
        OF_SUCCESS.contains(self)
    }

    /// The opposite limit of the machine, which the varied one may not cross.
    fn opposite_limit(&self, case: &Case) -> Option<f64> {
        let limits = case.scenario.hopper.limits();
        match self.path {
            "hopper.takeoff_angle_min_deg" => limits.takeoff_angle_max.map(Angle::written_degrees),
            "hopper.takeoff_angle_max_deg" => limits.takeoff_angle_min.map(Angle::written_degrees),
            "hopper.takeoff_speed_min_m_s" => Some(limits.takeoff_speed_max_m_s).filter(|greatest| greatest.is_finite()),
            "hopper.takeoff_speed_max_m_s" => {
                let highest = limits.takeoff_speed_levels.map(|levels| levels.highest_m_s());
                let least = [limits.takeoff_speed_min_m_s, limits.steps.takeoff_speed_m_s];
                highest.or(least.into_iter().flatten().reduce(f64::max))
            }
            "hopper.landing_speed_max_m_s" => limits.landing.touchdown_speed_m_s().filter(|speed_m_s| *speed_m_s > 0.0),
            _ => None,
        }
    }

    /// Refuses a hopper whose other limits make less gravity no help.
    fn check(&self, case: &Case) -> Result<(), RequireError> {
        let limits = case.scenario.hopper.limits();
        if self.path != GRAVITY {
            return Ok(());
        }
        if limits.flight_time_max_s.is_some() {
            return Err(RequireError::GravityWithFlightTime);
        }
        if limits.takeoff_speed_min_m_s.is_some() || limits.takeoff_speed_levels.is_some() {
            return Err(RequireError::GravityWithLeastSpeed);
        }
        Ok(())
    }
}

/// The least capability, with everything that its views need.
#[derive(Clone, Debug)]
pub struct Required {
    /// The case with the value that the path needs; without a path, with the most capable value.
    pub shown: Case,
    /// Its keys as typed.
    pub shown_entries: Entries,
    /// The answer as plain data.
    pub answer: RequireAnswer,
    /// The warnings about the most capable value, since a speed limit beyond escape is only among these, and about the free route of the
    /// value that is shown.
    pub warnings: Vec<String>,
}

/// Finds the least capable value with which the goal can be reached, between a value proved insufficient and a value with a path. The
/// first case of the variation is that of [`Requirement::strongest`].
///
/// Of a scenario with a budget of success: the least capable value found whose estimated success is enough. Nothing is proved then, since
/// success need not grow with a capability; so of a scenario with an objective or budgets of totals. Nine values are scanned, then the first that is enough and the one before are brought together,
/// on the same draws at every value.
///
/// # Errors
/// [`RequireError`].
pub fn require(variation: &Variation, requirement: &Requirement, progress: &dyn Progress) -> Result<Required, RequireError> {
    let Requirement { capability, is_given, resolution, .. } = requirement;
    let (first, (mut weakest, strongest)) = (&variation.first, requirement.ends());
    if let Some(other) = capability.opposite_limit(first).filter(|_| !is_given) {
        weakest = other;
    }
    let (from, to) = (weakest.min(strongest), weakest.max(strongest));
    let range = CapabilityRange { weakest, strongest, resolution: *resolution };
    let ends = first.ends()?;
    let wanted = first.scenario.budget.estimated_success_min;
    if wanted.is_none() && capability.is_of_success() {
        return Err(RequireError::NoSuccessWanted { key: capability.path });
    }
    capability.check(first)?;
    let scenarios = [weakest, strongest].map(|value| requirement.scenario(variation, value));
    let scenarios = scenarios.into_iter().collect::<Result<Vec<_>, _>>()?;
    let question = &Question { variation, requirement, nodes: QuestionNodes::resolved(first, scenarios)? };
    let last = question.at(weakest)?;
    if ask_the_same((&first.scenario, &first.prepared), (&last.scenario, &last.prepared)) {
        return Err(RequireError::NoEffect { key: capability.path, from, to });
    }
    if let Some(wanted) = wanted {
        return require_success(question, (range, wanted), progress);
    }
    if first.scenario.plans_by_objective() {
        return require_budgets(question, range, progress);
    }
    if first.scenario.route == Route::Free {
        return require_free(question, range, progress);
    }
    let mut tries: Vec<Tried> = Vec::new();
    let mut verdict_at = |value| {
        let tried = Tried::new(question.at(value)?, value, requirement, ends, progress)?;
        let verdict = tried.bounds.verdict();
        tries.push(tried);
        Ok::<ProofVerdict, RequireError>(verdict)
    };
    let threshold = least_capability(range, &mut verdict_at, progress)?;
    let at = |value: Option<f64>| tries.iter().find(|tried| Some(tried.value) == value);
    let mut answer = RequireAnswer {
        start_x_m: ends.0.point.x_m,
        goal_x_m: ends.1.point.x_m,
        vary: capability.path.to_owned(),
        unreachable_at: threshold.unreachable_at,
        reachable_at: threshold.reachable_at,
        not_reached_at: None,
        route: None,
        from,
        to,
        resolution: *resolution,
        resolution_met: range.is_met(&threshold),
        never_binds: false,
        tries: tries.iter().map(Tried::record).collect(),
        hops: None,
        path: Vec::new(),
        totals: None,
        success: None,
        within_budgets: None,
        derating: DeratingRecord::of(&first.scenario.derating),
        gap: at(threshold.unreachable_at).map(|tried| tried.gap(requirement, progress)).transpose()?.flatten(),
    };
    let reached = at(threshold.reachable_at);
    if let Some(tried) = reached {
        tried.add_path(&mut answer);
    }
    // The scenario gets the value that the path needs, so that a plan for it flies that path.
    let shown_value = reached.map_or(strongest, |tried| tried.value);
    Ok(question.required(reached.map_or(first, |tried| &tried.case).clone(), shown_value, answer))
}

/// The least capable value whose estimated success is enough.
fn require_success(
    question: &Question<'_>,
    (range, wanted): (CapabilityRange, f64),
    progress: &dyn Progress,
) -> Result<Required, RequireError> {
    let first = &question.variation.first;
    let ends = first.ends()?;
    let mut search = SuccessSearch::new(range, wanted);
    search.run(&mut |value| Ok::<_, RequireError>(JourneyPath::of(&question.at(value)?, progress)?.success()), progress)?;
    let reached = search.least();
    let mut answer = RequireAnswer {
        start_x_m: ends.0.point.x_m,
        goal_x_m: ends.1.point.x_m,
        vary: question.key().to_owned(),
        unreachable_at: None,
        reachable_at: reached.map(|tried| tried.value),
        not_reached_at: None,
        route: question.route_record(),
        from: range.weakest.min(range.strongest),
        to: range.weakest.max(range.strongest),
        resolution: range.resolution,
        resolution_met: search.is_met(),
        never_binds: false,
        tries: Vec::new(),
        hops: reached.and_then(|tried| tried.hops),
        path: Vec::new(),
        totals: None,
        success: Some(search.record()),
        within_budgets: None,
        derating: DeratingRecord::of(&first.scenario.derating),
        gap: None,
    };
    let value = answer.reachable_at.unwrap_or(range.strongest);
    let shown = question.at(value)?;
    if answer.reachable_at.is_some()
        && let Some(path) = JourneyPath::of(&shown, progress)?.path(&shown)
    {
        answer.path = HopRecord::rows(&path, shown.prepared.projection.as_ref());
        answer.totals = Some(TotalsRecord::from(&path.totals));
    }
    Ok(question.required(shown, value, answer))
}

/// The least capable value with a path within the budgets.
fn require_budgets(question: &Question<'_>, range: CapabilityRange, progress: &dyn Progress) -> Result<Required, RequireError> {
    let first = &question.variation.first;
    let ends = first.ends()?;
    let mut scan: ValueScan<JourneyPath> = ValueScan::new(range);
    let mut attempt = |value: f64| Ok::<_, RequireError>(JourneyPath::of(&question.at(value)?, progress)?);
    let within = |tried: &JourneyPath| tried.hops().is_some() && tried.objective().is_none_or(ObjectiveRecord::is_met);
    scan.run(&mut attempt, &[(&within, 1.0)], progress)?;
    let reached = scan.first(&within).and_then(|at| scan.tries.get(at));
    let value = reached.map_or(range.strongest, |(value, _)| *value);
    let shown = question.at(value)?;
    let flown = reached.and_then(|(_, tried)| tried.path(&shown));
    let record = RequireBudgetsRecord {
        at: reached.and_then(|(_, tried)| tried.objective().cloned()),
        within_from_there_on: scan.tries.is_sorted_by(|(_, a), (_, b)| within(a) <= within(b)),
        tries: scan.tries.iter().map(|(value, tried)| BudgetsTry::new(*value, tried.hops(), tried.objective())).collect(),
    };
    let answer = RequireAnswer {
        start_x_m: ends.0.point.x_m,
        goal_x_m: ends.1.point.x_m,
        vary: question.key().to_owned(),
        unreachable_at: None,
        reachable_at: reached.map(|(value, _)| *value),
        not_reached_at: None,
        route: question.route_record(),
        from: range.weakest.min(range.strongest),
        to: range.weakest.max(range.strongest),
        resolution: range.resolution,
        resolution_met: scan.is_met(&within),
        never_binds: false,
        tries: Vec::new(),
        hops: reached.and_then(|(_, tried)| tried.hops()),
        path: flown.as_ref().map(|path| HopRecord::rows(path, shown.prepared.projection.as_ref())).unwrap_or_default(),
        totals: reached.and_then(|(_, tried)| tried.totals(&shown)),
        success: None,
        within_budgets: Some(record),
        derating: DeratingRecord::of(&first.scenario.derating),
        gap: None,
    };
    Ok(question.required(shown, value, answer))
}

/// The chain at one value, with its bounds.
struct Tried {
    value: f64,
    case: Case,
    bounds: Bounds,
}

impl Tried {
    /// Bounds the fewest hops at a value.
    fn new(
        case: Case,
        value: f64,
        requirement: &Requirement,
        ends: (Station, Station),
        progress: &dyn Progress,
    ) -> Result<Self, RequireError> {
        let bounds = proved(&case, requirement, ends, false, progress)?;
        Ok(Self { value, case, bounds })
    }

    fn record(&self) -> RequireTry {
        RequireTry {
            value: self.value,
            verdict: self.bounds.verdict(),
            lower_bound: self.bounds.lower,
            upper_bound: self.bounds.upper(),
        }
    }

    /// What stops the journey here.
    fn gap(&self, requirement: &Requirement, progress: &dyn Progress) -> Result<Option<GapRecord>, RequireError> {
        let bounds = proved(&self.case, requirement, self.case.ends()?, true, progress)?;
        Ok(bounds.gap.as_ref().map(GapRecord::of))
    }

    /// The path found at this value; only its hop count where it has too many hops to list.
    fn add_path(&self, answer: &mut RequireAnswer) {
        let options = &self.case.scenario.search;
        if let Outcome::Path { legs, .. } = &self.bounds.answer.outcome {
            answer.hops = self.bounds.upper();
            if let Ok(path) = generate(&self.case.hop_test(), legs, options.takeoff, options.split) {
                answer.never_binds = answer.vary == CLEARANCE && self.case.scenario.keeps_no_clearance_in_full(&path);
                answer.path = HopRecord::rows(&path, self.case.prepared.projection.as_ref());
                answer.totals = Some(TotalsRecord::from(&path.totals));
            }
        }
    }
}

/// The bounds on the fewest hops of a case, until they are decided.
fn proved(
    case: &Case,
    requirement: &Requirement,
    (start, goal): (Station, Station),
    explain: bool,
    progress: &dyn Progress,
) -> Result<Bounds, SearchError> {
    let search = case.scenario.search.clone();
    let options = BoundsOptions { budget_cells: requirement.budget_cells, search, until: Until::Decided, explain };
    bounds(&case.hop_test(), start, goal, &options, progress)
}
