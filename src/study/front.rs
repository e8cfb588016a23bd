//! The front of hops against success: every path estimated by fixed trials, and the one to fly.

use std::{borrow::Cow, sync::Arc};

use super::{
    Case, JourneyError, SimulateError,
    dem_ground::dem_ground,
    journey::Searched,
    overlays::planned_over,
    to_go::{Replanning, ToGo},
};
use crate::{
    ballistics::TakeoffChoice,
    chain::Station,
    graph::{
        self, Beside, Corridor, CostToGo, NodeSet, Outcome, ReliabilityOptions, ReliabilityUse, ReliablePath, RiskModel,
        TakeoffScatter, most_reliable_paths, path_within_budget, preferred_path,
    },
    ground::{DemGround, MapPosition, Surface},
    hop::HopTest,
    path::{HopPath, PathError, generate},
    planner::{Amount, Amounts, ChainPath, ChainQuestion, LabelCap, Objective, SearchedCommands, front_on_chain},
    progress::Progress,
    report::{FrontRecord, FrontSearchRecord, FrontSuccess, SuccessBudgetRecord, TotalsRecord, estimate_ci95},
    scenario::Scenario,
    uncertainty::{ESTIMATE_TRIALS, Mission, Policy, Simulation, TrialOptions, Uncertainty},
    world::LayerName,
};

/// A front of hops against another amount, of which each path improves on one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Front {
    amount: Amount,
}

impl Front {
    /// Hops against the estimated success.
    pub const HOPS_RISK: Self = Self { amount: Amount::Risk };

    /// Hops against an amount; `None` against hops themselves.
    pub fn of_hops_against(amount: Amount) -> Option<Self> {
        (amount != Amount::Hops).then_some(Self { amount })
    }

    /// That of a name, such as `hops,energy` or `hops,layer:hazard`; `None` for any other text.
    pub fn named(name: &str) -> Option<Self> {
        let amount = name.strip_prefix(Amount::Hops.name())?.strip_prefix(',')?;
        Amount::named(amount).and_then(Self::of_hops_against)
    }

    /// All of them but those against layers, which have any names.
    pub fn all() -> impl Iterator<Item = Self> {
        Amount::ALL.into_iter().filter_map(Self::of_hops_against)
    }

    /// The amount against which hops are traded.
    pub const fn amount(self) -> Amount {
        self.amount
    }

    /// The amounts, with commas.
    pub fn name(self) -> String {
        format!("{},{}", Amount::Hops, self.amount)
    }
}

/// The front of hops against an amount over the nodes of a search, with hops up to those of the budget, or else ten, or half the fewest,
/// more than the fewest; and the number of its paths that no commands of the machine fly, which it leaves out.
pub(super) fn amount_front(
    case: &Case,
    (test, ends): (&HopTest, (Station, Station)),
    (searched, amount): (&Searched, Amount),
    progress: &dyn Progress,
) -> Result<(Vec<FrontRecord>, FrontSearchRecord, usize), JourneyError> {
    let (scenario, found) = (&case.scenario, &searched.found);
    let mut of = FrontSearchRecord { front_amount: amount, front_hops_max: 0, front_labels_capped: false };
    let Outcome::Path { legs: planned, .. } = &found.outcome else { return Ok((Vec::new(), of, 0)) };
    let over_same = graph::SearchOptions { spacing: Some(found.spacing), ..scenario.search.clone() };
    let fewest = graph::search(test, ends.0, ends.1, &over_same, progress)?.hops().unwrap_or(0);
    let budgets = scenario.total_budgets();
    of.front_hops_max = front_hops_max(scenario, fewest);
    #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
    let budgets = budgets.with(Amount::Hops, of.front_hops_max as f64).unwrap_or(budgets);
    let (commands, takeoff) = front_commands(scenario);
    let options = graph::SearchOptions { takeoff, ..over_same };
    let objective = Objective::of(amount);
    let question =
        ChainQuestion { objective: &objective, budgets: &budgets, commands, reliability: None, cap: LabelCap::default() };
    let (paths, capped) = front_on_chain(test, ends, (&options, found.spacing), (amount, &question), progress)?;
    of.front_labels_capped = capped;
    let count = paths.len();
    let row = |path: &ChainPath| {
        let hops = generate(test, &path.legs, options.takeoff, options.split).ok()?;
        let same = |(a, b): (&graph::Leg, &graph::Leg)| (a.takeoff, a.landing) == (b.takeoff, b.landing);
        let is_planned = path.legs.len() == planned.len()
            && path.legs.iter().zip(planned).all(same)
            && is_flown_alike(case, test, planned, &hops.amounts());
        Some(amount_row(amount, (path.cost.hops(), &hops), is_planned))
    };
    let rows: Vec<_> = paths.iter().filter_map(row).collect();
    let left_out = count - rows.len();
    Ok((rows, of, left_out))
}

/// The most hops of a front: those of the budget, or else ten, or half the fewest, more than the fewest.
pub(super) fn front_hops_max(scenario: &Scenario, fewest: u64) -> u64 {
    scenario.budget.hops_max.map_or_else(|| fewest + (fewest / 2).max(10), u64::from)
}

/// The commands of the hops of a front, and the one that is flown of those that take the same.
pub(super) fn front_commands(scenario: &Scenario) -> (SearchedCommands, TakeoffChoice) {
    // A choice that is no default was made.
    let is_chosen = matches!(scenario.search.takeoff, TakeoffChoice::MidRange | TakeoffChoice::LeastTime);
    if is_chosen || (scenario.plans_by_objective() && scenario.commands == SearchedCommands::Chosen) {
        (SearchedCommands::Chosen, scenario.search.takeoff)
    } else {
        (SearchedCommands::Distinct, TakeoffChoice::LeastSpeed)
    }
}

/// A row of a front of hops against an amount.
pub(super) fn amount_row(amount: Amount, (count, hops): (u64, &HopPath), planned: bool) -> FrontRecord {
    let amounts = hops.amounts();
    let only = |wanted: Amount| (amount == wanted).then(|| amounts.of(wanted));
    FrontRecord {
        hops: count,
        success: None,
        planned,
        takeoff_speed_sum_m_s: only(Amount::TakeoffSpeed),
        arc_length_m: only(Amount::ArcLength),
        layer_total: amount.layer().map(|_| amounts.of(amount)),
        totals: TotalsRecord::from(&hops.totals),
    }
}

/// Whether two paths take the same.
pub(super) fn are_alike(first: &Amounts, second: &Amounts) -> bool {
    let alike = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs());
    let of_layers = first.layers().iter().map(|(layer, _)| Amount::Layer(layer));
    Amount::ALL.into_iter().chain(of_layers).all(|amount| alike(first.of(amount), second.of(amount)))
}

/// Whether the path of a plan takes these amounts.
fn is_flown_alike(case: &Case, test: &HopTest, planned: &[graph::Leg], amounts: &Amounts) -> bool {
    let options = &case.scenario.search;
    generate(test, planned, options.takeoff, options.split).is_ok_and(|path| are_alike(&path.amounts(), amounts))
}

/// Why a scenario has no front.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrontProblem {
    /// A front of hops against risk for a scenario without errors to fly.
    #[error(
        "found no [uncertainty], expected the errors that a front of hops against risk estimates: add deviations above 0, such as \
         uncertainty.takeoff_speed_sigma_fraction = 0.02 and uncertainty.takeoff_angle_sigma_deg = 1, and uncertainty.goal_tolerance_m"
    )]
    NoErrors,
    /// A front of hops against the mission time for a hopper that bounces.
    #[error(
        "found [contact] for a front of hops against mission-time, expected a hopper that stays where it lands: the search does not count \
         the time of bounces; take flight-time, or remove [contact]"
    )]
    Bounces,
    /// A front of hops against the cost of a layer that has none.
    #[error(
        "found no layer {layer} with a cost for a front of hops against {}{layer}, expected layer.{layer} with a cost_per_contact or a cost_per_m",
        LayerName::PREFIX
    )]
    NoCost {
        /// The layer.
        layer: LayerName,
    },
}

impl Front {
    /// Refuses a scenario that has no such front.
    pub(super) fn check(self, scenario: &Scenario) -> Result<(), FrontProblem> {
        match self.amount {
            Amount::Risk if scenario.uncertainty.is_none() => Err(FrontProblem::NoErrors),
            Amount::MissionTime if scenario.hopper.limits().restitution.is_some() => Err(FrontProblem::Bounces),
            Amount::Layer(layer) if !scenario.layers.iter().any(|known| known.rule.name == layer && known.rule.cost.is_some()) => {
                Err(FrontProblem::NoCost { layer })
            }
            _ => Ok(()),
        }
    }
}

/// The front of hops against reliability over the nodes of a search, from the paths that it estimated or from new ones.
pub(super) fn front(
    case: &Case,
    (test, ends): (&HopTest, (Station, Station)),
    searched: &Searched,
    progress: &dyn Progress,
) -> Result<Vec<FrontRecord>, JourneyError> {
    // A front trades hops for reliability, however the plan weighs it; so does a robot that replans along its paths.
    let scenario = &Scenario { risk: ReliabilityUse::Traded, ..case.scenario.clone() };
    let found = &searched.found;
    let Some(keys) = scenario.uncertainty.as_ref().filter(|_| matches!(found.outcome, Outcome::Path { .. })) else {
        return Ok(Vec::new());
    };
    let ground = dem_ground(case).map_err(Box::new)?;
    let journey = FlownJourney { scenario, test, whole: case.whole_test(), ends, ground: ground.as_ref() };
    let mut paths = searched.reliable_paths.clone();
    if case.scenario.risk != ReliabilityUse::Traded {
        let nodes = NodeSet::new(test.chain(), ends.0, ends.1, found.spacing).map_err(graph::SearchError::from)?;
        let reliability = scenario.reliability_with(scenario.risk_extra_hops_max, ground.as_ref());
        let reliability = reliability.flown_under(journey.whole.as_ref());
        paths = most_reliable_paths(test, &nodes, &scenario.search, &reliability, progress)?;
    }
    journey.fly_front(found, &mut paths, usize::MAX, progress).map_err(Box::new)?;
    let row = |path: &ReliablePath| {
        let success_estimated = path.success?;
        let hops = journey.generated(path).ok()?;
        Some(FrontRecord {
            hops: path.cost.hops(),
            success: Some(FrontSuccess {
                success_estimated,
                success_estimated_ci95: estimate_ci95(success_estimated),
                trials: ESTIMATE_TRIALS,
                policy: keys.policy,
            }),
            takeoff_speed_sum_m_s: None,
            arc_length_m: None,
            layer_total: None,
            planned: matches!(&found.outcome, Outcome::Path { legs, .. } if *legs == path.legs),
            totals: TotalsRecord::from(&hops.totals),
        })
    };
    Ok(FrontRecord::improving(paths.iter().filter_map(row)))
}

/// What the estimates of a front say.
#[derive(Debug, Default)]
pub(super) struct Estimated {
    /// What the budget says of the path to fly; `None` without a budget or without a path.
    pub(super) budget: Option<SuccessBudgetRecord>,
    /// What the trials of the path to fly replan by; `None` open loop.
    pub(super) to_go: Option<ToGo>,
}

/// A journey whose paths are flown in trials.
#[derive(Clone, Debug)]
pub(super) struct FlownJourney<'a> {
    /// The scenario, with its errors.
    pub(super) scenario: &'a Scenario,
    /// The hop test over its chain, under the limits that planning may use.
    pub(super) test: &'a HopTest,
    /// The same under the whole limits, where they are others.
    pub(super) whole: Option<HopTest>,
    /// Start and goal.
    pub(super) ends: (Station, Station),
    /// The whole DEM, if the chain was sliced from one.
    pub(super) ground: Option<&'a DemGround>,
}

/// What fixed trials of a path say.
pub(super) struct Flown {
    /// The share of them that reach the goal.
    pub(super) success: f64,
    /// What they replan by; `None` open loop.
    pub(super) to_go: Option<ToGo>,
    /// All that they could replan by.
    pub(super) replanning: Option<Replanning>,
}

impl FlownJourney<'_> {
    /// The trials along a path; replanned by these costs, if there are any.
    pub(super) fn simulation(&self, path: &HopPath, to_go: Option<&ToGo>) -> Result<Simulation, SimulateError> {
        self.simulation_under(path, to_go, self.scenario.uncertainty.clone().unwrap_or_default().errors)
    }

    /// The same under other errors than those of the scenario.
    pub(super) fn simulation_under(
        &self,
        path: &HopPath,
        to_go: Option<&ToGo>,
        errors: Uncertainty,
    ) -> Result<Simulation, SimulateError> {
        let (start, goal) = self.ends;
        let mission = match self.ground {
            None => Mission::along_chain(self.whole.as_ref().unwrap_or(self.test).clone(), path.clone(), start, goal),
            Some(ground) => {
                let chain = self.test.chain();
                Mission::over_dem(ground.clone(), path.clone(), chain.contact_point(&start), chain.contact_point(&goal))
            }
        };
        let mission = match (to_go, self.ground) {
            (None, _) => mission,
            (Some(ToGo::Corridor(corridor)), _) => mission.with_replanning_beside_the_line(Arc::clone(corridor)),
            (Some(ToGo::Line(costs)), ground) => {
                let mission = mission.with_replanning(self.test.clone(), Arc::clone(costs));
                let derated = ground.filter(|_| self.whole.is_some());
                derated.map(|ground| planned_over(ground, self.scenario)).map_or(mission.clone(), |over| mission.planned_over(over))
            }
        };
        Ok(Simulation::new(&mission, errors)?)
    }

    /// What trials replan by over the nodes of an answer.
    pub(super) fn replanning(&self, found: &graph::Answer, progress: &dyn Progress) -> Result<Replanning, SimulateError> {
        let (nodes, options) = (self.nodes(found)?, &self.scenario.search);
        Ok(Replanning::new(match self.replanned_reliability() {
            None => CostToGo::of(self.test, nodes, options, progress)?,
            Some(reliability) => CostToGo::with_reliability(self.test, nodes, options, &reliability, progress)?,
        }))
    }

    fn nodes(&self, found: &graph::Answer) -> Result<NodeSet, SimulateError> {
        Ok(NodeSet::new(self.test.chain(), self.ends.0, self.ends.1, found.spacing)?)
    }

    /// How a robot that replans weighs reliability; `None` if it does not.
    fn replanned_reliability(&self) -> Option<ReliabilityOptions> {
        let mut reliability = self.scenario.reliability(self.ground)?.flown_under(self.whole.as_ref());
        if let RiskModel::Flown { takeoffs, .. } = &mut reliability.model {
            *takeoffs = TakeoffScatter::OfPosition;
        }
        Some(reliability)
    }

    /// What trials replan by over one kind of places beside the line, for a path of this many hops; `None` where the robot stays on the line.
    fn beside_the_line(
        &self,
        found: &graph::Answer,
        (replanning, beside): (&Replanning, Beside),
        hops: Option<u64>,
        progress: &dyn Progress,
    ) -> Result<Option<ToGo>, SimulateError> {
        let slot = &replanning.beside[beside as usize];
        let corridor = if let Some(known) = slot.get() {
            known
        } else {
            let corridor = self.corridor(found, beside, progress)?;
            slot.get_or_init(|| corridor)
        };
        let corridor = corridor.as_ref();
        Ok(corridor
            .map(|corridor| ToGo::Corridor(Arc::new(hops.map_or_else(|| corridor.clone(), |hops| corridor.with_hops(hops))))))
    }

    /// The places beside the line of an answer; `None` where the robot stays on the line.
    fn corridor(&self, found: &graph::Answer, beside: Beside, progress: &dyn Progress) -> Result<Option<Corridor>, SimulateError> {
        let Some((ground, reliability)) = self.ground.zip(self.replanned_reliability()) else { return Ok(None) };
        let over = if self.whole.is_some() { Cow::Owned(planned_over(ground, self.scenario)) } else { Cow::Borrowed(ground) };
        let (nodes, options) = (self.nodes(found)?, &self.scenario.search);
        Ok(Corridor::new(self.test, &nodes, options, (&reliability, &over, beside), progress)?)
    }

    /// The most reliable paths over the nodes of an answer and places beside its line, by a closed form of the risk of each hop: one for each
    /// kind of places, as the places that it visits.
    ///
    /// `replanning`: what trials of the same answer replan by, which may have found them.
    pub(super) fn reliable_places(
        &self,
        found: &graph::Answer,
        replanning: Option<&Replanning>,
        progress: &dyn Progress,
    ) -> Result<Vec<Vec<MapPosition>>, SimulateError> {
        let mut places = Vec::new();
        for beside in Beside::ALL {
            let known = replanning.and_then(|replanning| replanning.beside[beside as usize].get());
            let corridor = known.map_or_else(|| self.corridor(found, beside, progress), |known| Ok(known.clone()))?;
            places.extend(corridor.map(|corridor| corridor.path()));
        }
        Ok(places)
    }

    /// The share of fixed trials of one path that reach the goal, and what they replan by; open loop without `replanning`.
    ///
    /// A robot over a DEM stays on the line where that is reliable. Where it reaches the goal in less than 0.98 of the trials, robots are flown
    /// that may leave the line over posts, then over flat facets, and the best of them counts. `hops`: those that the path has, where it is known.
    fn flown(
        &self,
        (found, replanning): (&graph::Answer, Option<&Replanning>),
        (path, hops): (&HopPath, Option<u64>),
        options: &TrialOptions,
        progress: &dyn Progress,
    ) -> Result<(f64, Option<ToGo>), SimulateError> {
        let success = |to_go: Option<&ToGo>| -> Result<f64, SimulateError> {
            Ok(self.simulation(path, to_go)?.estimated_success(options, progress)?)
        };
        let Some(replanning) = replanning else { return Ok((success(None)?, None)) };
        let line = replanning.along_line(hops);
        let mut best = (success(Some(&line))?, Some(line));
        for beside in Beside::ALL {
            if best.0 >= RELIABLE {
                break;
            }
            let Some(to_go) = self.beside_the_line(found, (replanning, beside), hops, progress)? else { break };
            let aside = success(Some(&to_go))?;
            if aside > best.0 {
                best = (aside, Some(to_go));
            }
        }
        Ok(best)
    }

    /// The share of fixed trials of the path of an answer that reach the goal, and what trials of it replan by; `None` open loop.
    pub(super) fn success_of(
        &self,
        found: &graph::Answer,
        path: &HopPath,
        options: &TrialOptions,
        progress: &dyn Progress,
    ) -> Result<Flown, SimulateError> {
        let replans = options.policy == Policy::Replan;
        let replanning = replans.then(|| self.replanning(found, progress)).transpose()?;
        let (success, to_go) = self.flown((found, replanning.as_ref()), (path, found.hops()), options, progress)?;
        Ok(Flown { success, to_go, replanning })
    }

    /// What trials of the path of an answer replan by.
    pub(super) fn to_go_of(
        &self,
        found: &graph::Answer,
        path: &HopPath,
        options: &TrialOptions,
        progress: &dyn Progress,
    ) -> Result<Option<ToGo>, SimulateError> {
        let has_choice = self.ground.is_some() && self.replanned_reliability().is_some();
        if !has_choice {
            return Ok(Some(self.replanning(found, progress)?.along_line(found.hops())));
        }
        Ok(self.success_of(found, path, &TrialOptions { policy: Policy::Replan, ..*options }, progress)?.to_go)
    }

    /// Estimates the success of the paths of a front, and takes the one to fly: [`preferred_path`], or under a budget of success
    /// [`path_within_budget`].
    ///
    pub(super) fn estimate(
        &self,
        found: &mut graph::Answer,
        front: &mut [ReliablePath],
        progress: &dyn Progress,
    ) -> Result<Estimated, SimulateError> {
        let Outcome::Path { legs, .. } = &found.outcome else { return Ok(Estimated::default()) };
        // Who is at the goal already is there for certain.
        let stays = legs.is_empty();
        let least = self.scenario.budget.estimated_success_min;
        // A budget is not refused for a path that was not flown.
        let mut to_go = self.fly_front(found, front, if least.is_some() { usize::MAX } else { FLOWN_MAX }, progress)?;
        let within = least.and_then(|least| path_within_budget(front, least));
        let number = within.map(|(path, _)| path).or_else(|| preferred_path(front));
        let to_go = number.and_then(|number| to_go.get_mut(number)?.take());
        let preferred = number.and_then(|number| front.get(number));
        if let Some(path) = preferred {
            found.follow(path);
        }
        let success = preferred.and_then(|path| Some((path.cost.hops(), path.success?)));
        let met = stays || within.is_some_and(|(_, met)| met);
        let budget = least.map(|least| SuccessBudgetRecord::new(least, met, if stays { Some((0, 1.0)) } else { success }));
        Ok(Estimated { budget, to_go })
    }

    /// Estimates the success of at most so many paths of a front, as far as it is not known.
    ///
    /// A robot that replans and may take more hops is another robot: every path is estimated with the hops that it has.
    ///
    /// # Returns
    /// What the trials of each path replan by; `None` open loop, and if the path is not flown.
    pub(super) fn fly_front(
        &self,
        found: &graph::Answer,
        front: &mut [ReliablePath],
        most: usize,
        progress: &dyn Progress,
    ) -> Result<Vec<Option<ToGo>>, SimulateError> {
        let unknown: Vec<usize> = flown_of(front.len(), most).filter(|&number| front[number].success.is_none()).collect();
        let Some(keys) = self.scenario.uncertainty.as_ref().filter(|_| !unknown.is_empty()) else { return Ok(Vec::new()) };
        let replans = keys.policy == Policy::Replan;
        let replanning = replans.then(|| self.replanning(found, progress)).transpose()?;
        let mut to_go = vec![None; front.len()];
        for number in unknown {
            let path = &mut front[number];
            // A path of too many hops to list, or without commands of the machine, is not flown.
            let Ok(hops) = self.generated(path) else { continue };
            let of_path = (&hops, Some(path.cost.hops()));
            let (success, by) = self.flown((found, replanning.as_ref()), of_path, &keys.options(), progress)?;
            (path.success, to_go[number]) = (Some(success), by);
        }
        Ok(to_go)
    }

    fn generated(&self, path: &ReliablePath) -> Result<HopPath, PathError> {
        generate(self.test, &path.legs, self.scenario.search.takeoff, self.scenario.search.split)
    }
}

/// The share of trials that arrive from which a path is reliable enough: no robot or route is looked for that arrives more often.
pub(super) const RELIABLE: f64 = 0.98;

/// The most paths of a front that are flown in trials without a budget: a long journey has dozens, and each of them costs 512 trials.
const FLOWN_MAX: usize = 9;

/// Which of the paths of a front are flown: all of a short one, else evenly spaced ones with the first and the last.
fn flown_of(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let flown = count.min(most);
    (0..flown).map(move |i| if flown < 2 { i } else { i * (count - 1) / (flown - 1) })
}
