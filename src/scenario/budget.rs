//! `[budget]`: what a path may take at most, and what it has to give at least.

use super::{Entries, ProblemKind, Scenario, UncertaintyKeys};
use crate::{
    ballistics::{TakeoffChoice, delta_v_of_propellant_m_s},
    graph::ReliabilityUse,
    planner::{Amount, Budgets, Objective, SearchedCommands, TotalBudget},
    uncertainty::Policy,
    world::Hopper,
};

/// The keys of `[budget]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// The least success that the fixed trials of a path estimate, 0 to 1; `None`: any.
    pub estimated_success_min: Option<f64>,
    /// The greatest number of hops.
    pub hops_max: Option<u32>,
    /// The greatest mission time, s.
    pub mission_time_max_s: Option<f64>,
    /// The greatest flight time, s.
    pub flight_time_total_max_s: Option<f64>,
    /// The greatest energy per unit mass, J/kg.
    pub energy_max_j_kg: Option<f64>,
    /// The greatest energy, J.
    pub energy_max_j: Option<f64>,
    /// The greatest delta-v, m/s.
    pub delta_v_max_m_s: Option<f64>,
}

impl Budget {
    /// Whether a total is limited: any key but that of the success.
    pub fn limits_totals(&self) -> bool {
        Self { estimated_success_min: None, ..*self } != Self::default()
    }

    /// The greatest totals, each with its key: those of this table, and for a hopper with an amount of propellant the delta-v that it
    /// gives.
    pub fn totals(&self, hopper: &Hopper) -> Vec<TotalBudget> {
        let limits = hopper.limits();
        let of_mass = self.energy_max_j.zip(limits.mass_kg).map(|(energy_j, mass_kg)| energy_j / mass_kg);
        let stores = (limits.mass_kg, limits.isp_s, limits.propellant_max_kg);
        let of_propellant = match stores {
            (Some(mass_kg), Some(isp_s), Some(propellant_kg)) => Some(delta_v_of_propellant_m_s(mass_kg, propellant_kg, isp_s)),
            _ => None,
        };
        [
            (Amount::Hops, "budget.hops_max", self.hops_max.map(f64::from)),
            (Amount::MissionTime, "budget.mission_time_max_s", self.mission_time_max_s),
            (Amount::FlightTime, "budget.flight_time_total_max_s", self.flight_time_total_max_s),
            (Amount::Energy, "budget.energy_max_j_kg", self.energy_max_j_kg),
            (Amount::Energy, "budget.energy_max_j", of_mass),
            (Amount::DeltaV, "budget.delta_v_max_m_s", self.delta_v_max_m_s),
            (Amount::DeltaV, "hopper.propellant_max_kg", of_propellant),
        ]
        .into_iter()
        .filter_map(|(amount, key, most)| Some(TotalBudget { amount, key, most: most? }))
        .collect()
    }
}

impl Scenario {
    /// Whether paths are planned by an objective, within budgets of totals; otherwise by fewest hops, then effort or reliability.
    pub fn plans_by_objective(&self) -> bool {
        self.objective.is_some() || self.budget.limits_totals() || self.layers.iter().any(|layer| layer.total_budget().is_some())
    }

    /// The objective: that of the scenario, or else hops, then effort.
    pub fn full_objective(&self) -> Objective {
        self.objective.clone().unwrap_or_else(|| Objective::hops_then(self.search.effort))
    }

    /// The greatest totals of a path, without their keys.
    pub fn total_budgets(&self) -> Budgets {
        // The catalogue's ranges are those of a budget.
        let with = |budgets: Budgets, total: &TotalBudget| budgets.with(total.amount, total.most).unwrap_or(budgets);
        self.limited_totals().iter().fold(Budgets::NONE, with)
    }
}

/// The keys as given.
pub(super) fn budget(entries: &Entries) -> Budget {
    let number = |name| entries.number("budget", name);
    Budget {
        estimated_success_min: number("estimated_success_min"),
        hops_max: entries.count("budget", "hops_max").and_then(|hops| u32::try_from(hops).ok()),
        mission_time_max_s: number("mission_time_max_s"),
        flight_time_total_max_s: number("flight_time_total_max_s"),
        energy_max_j_kg: number("energy_max_j_kg"),
        energy_max_j: number("energy_max_j"),
        delta_v_max_m_s: number("delta_v_max_m_s"),
    }
}

/// Refuses a budget of success that nothing estimates.
pub(super) fn check(
    entries: &mut Entries,
    (budget, limits_totals): (Budget, bool),
    risk: ReliabilityUse,
    uncertainty: Option<&UncertaintyKeys>,
) {
    let Some(least) = budget.estimated_success_min else { return };
    let key = ("budget", "estimated_success_min");
    if uncertainty.is_none() {
        let message = format!("budget.estimated_success_min is {least}, but without [uncertainty] no success is estimated");
        let help = "add [uncertainty] with deviations above 0, such as takeoff_speed_sigma_fraction = 0.02, and goal_tolerance_m; or remove \
                    estimated_success_min";
        entries.problem(key, ProblemKind::Missing, message, help);
    } else if limits_totals || entries.objective("search", "objective").is_some() {
        let message = format!(
            "budget.estimated_success_min is {least} beside search.objective or another budget, expected one of the two: a path of \
             enough success is chosen from the front of hops against risk, not by an objective"
        );
        let help = "remove estimated_success_min, or the objective and the other budgets; simulate shows the success of a plan by objective";
        entries.problem(key, ProblemKind::Conflict, message, help);
    } else if risk == ReliabilityUse::Ignored {
        let message =
            format!("budget.estimated_success_min is {least}, but search.risk = \"ignored\" plans without regard to success");
        let help = "set risk = \"traded\" or \"fewest-hops\", or remove risk or estimated_success_min";
        entries.problem(key, ProblemKind::Conflict, message, help);
    }
}

/// What is to be least where a machine drives, unless the scenario says otherwise: a count of hops alone would let it drive any detour.
fn objective_of_travel() -> Option<Objective> {
    Objective::new(vec![Amount::MissionTime, Amount::Hops, Amount::Energy]).ok()
}

/// The objective as given, and the commands that an edge offers to a search by objective, with the choice of take-off angle where none is
/// given. Refuses what excludes it.
///
/// # Arguments
/// `drives`: whether the machine drives, so that it plans by the time of the mission unless the scenario says otherwise.
///
/// # Returns
/// The objective; the commands, and the choice of take-off angle that the first amount wants, for a plan by objective.
pub(super) fn objective(
    entries: &mut Entries,
    (budget, limits_totals): (Budget, bool),
    hopper: &Hopper,
    uncertainty: Option<&UncertaintyKeys>,
    drives: bool,
) -> (Option<Objective>, SearchedCommands, Option<TakeoffChoice>) {
    let of_travel = || (drives && entries.text("search", "effort").is_none()).then(objective_of_travel).flatten();
    let objective = entries.objective("search", "objective").or_else(of_travel);
    if objective.is_none() && !limits_totals {
        return (None, SearchedCommands::Chosen, None);
    }
    let mut conflict = |key: (&str, &str), message: String, help: &str| entries.problem(key, ProblemKind::Conflict, message, help);
    if budget.energy_max_j.is_some() && hopper.limits().mass_kg.is_none() {
        let message = "budget.energy_max_j without hopper.mass_kg, expected the mass by which energies are counted".to_owned();
        conflict(("budget", "energy_max_j"), message, "give hopper.mass_kg, or energy_max_j_kg instead");
    }
    let amounts = objective.iter().flat_map(Objective::amounts);
    let counts = |wanted| amounts.clone().any(|amount| *amount == wanted);
    if hopper.limits().restitution.is_some() && (counts(Amount::MissionTime) || budget.mission_time_max_s.is_some()) {
        let key = if budget.mission_time_max_s.is_some() { ("budget", "mission_time_max_s") } else { ("search", "objective") };
        let message = format!(
            "{}.{} counts the mission time beside [contact], expected one of the two: the search does not count the time of bounces",
            key.0, key.1
        );
        conflict(key, message, "use flight-time or flight_time_total_max_s, or remove [contact]");
    }
    let key = ("search", "objective");
    if counts(Amount::Risk) {
        match uncertainty {
            None => {
                let message =
                    "search.objective has risk without [uncertainty], expected the errors by which risk is estimated".to_owned();
                conflict(key, message, "add [uncertainty] with deviations above 0, or remove risk from the objective");
            }
            Some(keys) if keys.policy == Policy::OpenLoop => {
                let message =
                    "search.objective has risk beside uncertainty.policy = \"open-loop\", expected policy = \"replan\": open loop \
                               the risk of a hop depends on the hops before it, and is no sum"
                        .to_owned();
                conflict(key, message, "set policy = \"replan\", or use search.risk in place of the objective");
            }
            Some(_) => {}
        }
    }
    if entries.objective("search", "objective").is_some() && entries.text("search", "effort").is_some() {
        let message =
            "search has both objective and effort, expected one of the two: effort = \"x\" means objective = [\"hops\", \"x\"]";
        entries.problem(key, ProblemKind::Conflict, message.to_owned(), "remove effort");
    }
    let first_of_command = || match objective.as_ref().and_then(|objective| objective.amounts().iter().find(|a| !a.is_of_places()))
    {
        Some(Amount::FlightTime | Amount::MissionTime) => TakeoffChoice::LeastTime,
        Some(Amount::Risk) => TakeoffChoice::MostReliable,
        _ => TakeoffChoice::LeastSpeed,
    };
    let choice = first_of_command();
    let is_given = entries.text("search", "takeoff_angle").is_some();
    (objective, if is_given { SearchedCommands::Chosen } else { SearchedCommands::Distinct }, Some(choice))
}
