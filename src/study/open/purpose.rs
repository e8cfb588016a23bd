//! What a scenario is opened for. Keys that this does not use and that were set beside the file get a warning.

use super::{CHAIN_TERRAIN, SLICED_TERRAIN, Wording};
use crate::{
    graph::ReliabilityUse,
    planner::Amount,
    scenario::{Entries, Key, Place, Scenario},
    study::Commands,
};

/// Whether a scenario's own start and goal count for a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScenarioEnds {
    /// They are ignored, with the rest of its terrain.
    Ignored,
    /// Its goal counts where it has one.
    Offered,
    /// There is no other start.
    Needed,
}

/// The question that a scenario is opened for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Purpose {
    /// One pair, limit by limit.
    Hop,
    /// Whether a path exists.
    Check,
    /// A path.
    Plan,
    /// A path, and its trials.
    Run,
    /// Trials of a path.
    Simulate,
    /// The least capability.
    Require,
    /// A verdict for each value.
    Trade,
    /// Paths side by side.
    Compare,
    /// Slices from one point.
    Fan,
    /// Hops over a DEM.
    Map {
        /// With paths to goals.
        goals: bool,
        /// With least effort.
        effort: bool,
        /// With totals of amounts along the paths.
        amounts: bool,
        /// With trials along these paths.
        trials: bool,
        /// Whether the scenario's own start and goal count.
        ends: ScenarioEnds,
    },
    /// Hops over a mesh.
    MapMesh,
    /// Landing sites over a DEM.
    Sites {
        /// With trials along the paths to the targets.
        trials: bool,
        /// Whether the scenario's own goal, or its targets, count.
        ends: ScenarioEnds,
    },
}

/// The name of this program, which precedes that of a question in the warnings of documents.
const PROGRAM: &str = "chta";

/// Whether a key of `[terrain]` gives way to a DEM that is given beside the scenario.
fn gives_way_to_a_dem(name: &str) -> bool {
    SLICED_TERRAIN.contains(&name) || CHAIN_TERRAIN.contains(&name)
}

/// What a scenario weighs in the choice of a path.
#[derive(Clone, Copy, Debug, Default)]
struct Weighs {
    /// Risk.
    risk: bool,
    /// A budget of success.
    success: bool,
    /// Errors, which a plan estimates.
    errors: bool,
    /// Amounts of an objective, or budgets of totals.
    amounts: Amounts,
}

/// The amounts that a plan by objective weighs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Amounts {
    /// There is no objective.
    #[default]
    None,
    /// Totals.
    Totals,
    /// Totals and risk.
    WithRisk,
}

impl Weighs {
    fn of(scenario: &Scenario) -> Self {
        Self {
            risk: scenario.risk != ReliabilityUse::Ignored,
            success: scenario.budget.estimated_success_min.is_some(),
            errors: scenario.uncertainty.as_ref().is_some_and(|keys| !keys.errors.is_none()),
            amounts: match scenario.full_objective().amounts().contains(&Amount::Risk) {
                _ if !scenario.plans_by_objective() => Amounts::None,
                true => Amounts::WithRisk,
                false => Amounts::Totals,
            },
        }
    }
}

impl Purpose {
    /// Every purpose, with all that it can compute.
    pub const ALL: [Self; 12] = [
        Self::Hop,
        Self::Check,
        Self::Plan,
        Self::Run,
        Self::Simulate,
        Self::Require,
        Self::Trade,
        Self::Compare,
        Self::Fan,
        Self::Map { goals: true, effort: true, amounts: true, trials: true, ends: ScenarioEnds::Ignored },
        Self::MapMesh,
        Self::Sites { trials: true, ends: ScenarioEnds::Offered },
    ];

    /// The name of the question.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hop => "hop",
            Self::Check => "check",
            Self::Plan => "plan",
            Self::Run => "run",
            Self::Simulate => "simulate",
            Self::Require => "require",
            Self::Trade => "trade",
            Self::Compare => "compare",
            Self::Fan => "fan",
            Self::Map { .. } | Self::MapMesh => "map",
            Self::Sites { .. } => "sites",
        }
    }

    /// Whether the scenario's own start and goal count beside, or in place of, those of the caller.
    pub const fn scenario_ends(self) -> ScenarioEnds {
        match self {
            Self::Map { ends, .. } | Self::Sites { ends, .. } => ends,
            _ => ScenarioEnds::Ignored,
        }
    }

    /// Whether its answer can depend on a key, where the choice of a path weighs risk or does not, and estimates a budget of success or does
    /// not.
    fn uses(self, key: &Key, weighs: Weighs) -> bool {
        let Weighs { risk: weighs_risk, success, errors, amounts } = weighs;
        let on_a_dem = matches!(self, Self::Fan | Self::Map { .. } | Self::Sites { .. });
        let flies = matches!(self, Self::Run | Self::Simulate | Self::Map { trials: true, .. } | Self::Sites { trials: true, .. });
        let by_risk = matches!(self, Self::Check | Self::Plan | Self::Run | Self::Simulate | Self::Compare);
        let by_objective = amounts != Amounts::None && self.plans_by_objective();
        let weighs_risk = weighs_risk || (amounts == Amounts::WithRisk && by_objective);
        let by_success = success && matches!(self, Self::Require | Self::Trade);
        let of_map = matches!(self, Self::Map { goals: true, .. } | Self::Map { amounts: true, .. });
        let totals = of_map || matches!(self, Self::Plan | Self::Run | Self::Require | Self::Compare);
        match (key.table, key.name) {
            (
                "hopper",
                "mass_kg"
                | "rest_time_s"
                | "preparation_time_s"
                | "settling_time_s"
                | "preparation_energy_j"
                | "efficiency"
                | "isp_s"
                | "hop_delta_v_overhead_m_s",
            ) => totals || by_objective,
            ("contact", _) => totals || flies || (by_risk && weighs_risk),
            ("hopper", "propellant_max_kg") => self.counts_propellant() || by_objective,
            ("hopper", "takeoff_angle_step_deg" | "heading_step_deg") => self.flies_commands(),
            ("terrain", "dem" | "start_m" | "start_lonlat_deg" | "goal_m" | "goal_lonlat_deg")
            | ("mission", "targets_m" | "targets_lonlat_deg")
                if self.scenario_ends() != ScenarioEnds::Ignored =>
            {
                true
            }
            ("robot", "headings") => matches!(self, Self::Map { .. }),
            ("terrain", "route") => !matches!(self, Self::Hop | Self::Fan | Self::Map { .. } | Self::Sites { .. }),
            ("terrain", name) => !(on_a_dem && gives_way_to_a_dem(name)),
            ("search", "points_per_segment") => !matches!(self, Self::Hop | Self::Map { .. } | Self::Sites { .. }),
            ("search", "node_spacing_max_m") => self != Self::Hop,
            // Of free routes over meshes.
            ("search", "planner") => matches!(self, Self::Plan | Self::Run | Self::Simulate | Self::Compare),
            ("search", "contacts_max" | "stand_off_m" | "bounds_m" | "seed" | "time_max_s") => {
                matches!(self, Self::Plan | Self::Run | Self::Simulate | Self::Compare | Self::MapMesh | Self::Trade)
            }
            ("search", _) if self == Self::MapMesh => false,
            ("search", "effort" | "takeoff_angle" | "split") if by_objective => true,
            ("search", "effort") => !matches!(
                self,
                Self::Hop | Self::Trade | Self::Fan | Self::Sites { trials: false, .. } | Self::Map { effort: false, .. }
            ),
            ("search", "takeoff_angle" | "split" | "risk" | "risk_extra_hops_max") if by_success => true,
            ("search", "takeoff_angle") => {
                by_objective
                    || !matches!(
                        self,
                        Self::Trade
                            | Self::Fan
                            | Self::Sites { trials: false, .. }
                            | Self::Map { goals: false, effort: false, amounts: false, .. }
                    )
            }
            ("search", "split") => !on_a_dem && !matches!(self, Self::Hop | Self::Trade),
            // A robot that replans over a map weighs it.
            ("search", "risk") if matches!(self, Self::Map { trials: true, .. } | Self::Sites { trials: true, .. }) => true,
            ("search", "risk" | "risk_extra_hops_max") => by_risk,
            ("budget", "estimated_success_min") => by_risk || matches!(self, Self::Require | Self::Trade),
            ("budget", _) | ("search", "objective") => self.plans_by_objective(),
            ("mission", _) => {
                matches!(self, Self::Check | Self::Plan | Self::Run | Self::Simulate | Self::Require | Self::Trade | Self::Compare)
            }
            ("drive", _) => {
                matches!(
                    self,
                    Self::Plan | Self::Run | Self::Simulate | Self::Require | Self::Trade | Self::Compare | Self::Map { .. }
                )
            }
            // The trials of an estimate have a number and a seed of their own.
            ("uncertainty", "trials" | "seed") => flies,
            ("uncertainty", _) => flies || by_success || (errors && matches!(self, Self::Plan)) || (by_risk && weighs_risk),
            _ => true,
        }
    }

    /// Whether it answers for a robot with legs.
    pub const fn stands_on_legs(self) -> bool {
        matches!(self, Self::Plan | Self::Simulate | Self::Run | Self::Check | Self::Trade | Self::Map { .. })
    }

    /// Whether its paths are those of an objective within budgets, where the scenario has them.
    const fn plans_by_objective(self) -> bool {
        !matches!(self, Self::Hop | Self::Fan | Self::MapMesh)
    }

    /// The commands that its answer is for.
    pub const fn commands(self) -> Commands {
        if self.flies_commands() { Commands::OfTheMachine } else { Commands::Exact }
    }

    /// Whether its hops have commands in the machine's steps.
    const fn flies_commands(self) -> bool {
        !matches!(self, Self::Hop | Self::Require | Self::Trade | Self::Fan | Self::Map { .. } | Self::MapMesh | Self::Sites { .. })
    }

    /// Whether its answer is no where the path takes more propellant than the machine has.
    const fn counts_propellant(self) -> bool {
        matches!(self, Self::Check | Self::Plan | Self::Run | Self::Simulate | Self::Compare | Self::Map { goals: true, .. })
    }

    /// Whether it answers for the scenario's own clearance alone: it varies no key.
    const fn uses_one_clearance(self) -> bool {
        !matches!(self, Self::Trade | Self::Require)
    }

    /// Warnings about keys that were given and that this question does not use: those set beside the file, and a risk that a scenario
    /// wants weighed. A scenario serves many questions, so other keys of a file are not reported.
    pub fn unused(self, entries: &Entries, scenario: &Scenario, wording: &Wording) -> Vec<String> {
        let weighs = Weighs::of(scenario);
        let mut warnings = Vec::new();
        if !scenario.hopper.limits().steps.is_continuous() && !self.flies_commands() {
            let command = self.name();
            warnings.push(format!(
                "{PROGRAM} {command} answers for exact commands, and this machine takes its commands in steps, which may miss a landing or break a \
                 limit: {PROGRAM} plan finds and checks commands in steps along a transect"
            ));
        }
        for (key, place) in entries.given() {
            if scenario.hopper.limits().clearance_m == 0.0 && self.uses_one_clearance() {
                // A scenario may state the rule of its clearance without one: the paper's do.
                let by_option = matches!(place, Place::Option(_));
                if (key.table, key.name) == ("hopper", "clearance_taper") || by_option && key.name == "clearance_rule" {
                    warnings.push(format!(
                        "{} has no effect: hopper.clearance_m is 0, so that there is no clearance to keep; give one, or leave the key out",
                        key.path()
                    ));
                }
            }
            let of_propellant = scenario.hopper.limits().propellant_max_kg.is_some()
                && self.counts_propellant()
                && key.table == "hopper"
                && matches!(key.name, "mass_kg" | "isp_s" | "hop_delta_v_overhead_m_s");
            if self.uses(key, weighs) || of_propellant {
                continue;
            }
            let wants_risk = weighs.risk && (key.table, key.name) == ("search", "risk") && self != Self::Hop;
            // A limit that the file states and this answer does not keep: silence would be a promise.
            if (key.table, key.name) == ("hopper", "propellant_max_kg") && self != Self::Hop {
                let users = Self::users(key, weighs, self, wording);
                warnings.push(format!(
                    "hopper.propellant_max_kg is not kept by this answer of {PROGRAM} {}, which counts hops and no propellant{users}",
                    self.name()
                ));
                continue;
            }
            // So is a least success that the file wants.
            let is_objective = (key.table, key.name) == ("search", "objective");
            if (key.table == "budget" || is_objective) && self != Self::Hop {
                let users = Self::users(key, weighs, self, wording);
                let what = match (key.table, key.name) {
                    ("budget", "estimated_success_min") => "counts hops and estimates no success",
                    _ => "counts hops and no other totals",
                };
                warnings.push(format!(
                    "{} is not kept by this answer of {PROGRAM} {}, which {what}{users}",
                    key.path(),
                    self.name()
                ));
                continue;
            }
            let said = match place {
                Place::Option(option) => format!("{option}: {}", key.path()),
                Place::File(_) | Place::Nowhere if wants_risk => format!("{} = \"{}\"", key.path(), scenario.risk.name()),
                Place::File(_) | Place::Nowhere => continue,
            };
            let (command, users) = (self.name(), Self::users(key, weighs, self, wording));
            warnings.push(format!("{said} has no effect on this answer of {PROGRAM} {command}{users}"));
        }
        warnings
    }

    /// Warnings about keys that were set twice beside the file: the last one counts.
    pub fn replaced(entries: &Entries) -> Vec<String> {
        let said = |(key, by): (&Key, &(String, String))| format!("{}: {} is replaced by {}", by.0, key.path(), by.1);
        entries.replaced().map(said).collect()
    }

    /// The questions that use a key, for the end of a warning.
    fn users(key: &Key, weighs: Weighs, called: Self, wording: &Wording) -> String {
        let mut users: Vec<&str> = Self::ALL.into_iter().filter(|purpose| purpose.uses(key, weighs)).map(Self::name).collect();
        users.dedup();
        if called == Self::MapMesh {
            users.iter_mut().filter(|user| **user == "map").for_each(|user| *user = "map over a DEM");
        }
        let own = users.contains(&called.name());
        match (own, called) {
            (true, Self::Map { .. }) => format!(": it is used with {}", wording.of_map),
            _ => format!(": it is used by {}", users.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::CATALOGUE;

    #[test]
    fn every_key_is_used_by_a_question() {
        for key in &CATALOGUE {
            let users: Vec<_> = Purpose::ALL.into_iter().filter(|purpose| purpose.uses(key, Weighs::default())).collect();
            assert!(!users.is_empty(), "{} is used by no question", key.path());
        }
    }
}
