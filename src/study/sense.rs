//! Settings without effect on the trials that are flown, and deviations beyond sense.

use super::{Extremes, Prepared, constant_gravity_warnings};
use crate::{
    chain::{GroundForm, PolygonalChain, Station},
    graph::ReliabilityUse,
    ground::DemGround,
    path::{Hop, HopPath},
    quantity::format_number,
    scenario::{Scenario, TerrainSource},
    uncertainty::{MeasuredErrors, Policy, Uncertainty},
    world::FrictionCone,
};

/// What the warnings about trials need to know of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialGround {
    /// The greatest friction coefficient of the ground; `None` if no contact depends on friction; infinite if it is not known.
    pub friction_max: Option<f64>,
    /// The extent of the ground, m.
    pub extent_m: f64,
    /// The straight distance from start to goal, m, if there is one goal.
    pub journey_m: Option<f64>,
    /// The hops of the plan; of several plans, the most.
    pub hops: usize,
}

impl TrialGround {
    /// That of a prepared chain and a plan of this many hops.
    pub fn of_chain(scenario: &Scenario, prepared: &Prepared, hops: usize) -> Self {
        let geometry = prepared.chain.geometry();
        let constant = scenario.surface.constant_friction();
        let frictions = geometry.grounds().iter().filter_map(|ground| match ground.form {
            GroundForm::Surface { friction, .. } => friction.or(constant),
            GroundForm::Explicit { .. } => None,
        });
        let (first_m, last_m) = geometry.extent_m();
        Self {
            friction_max: frictions.map(FrictionCone::coefficient).reduce(f64::max),
            extent_m: last_m - first_m,
            journey_m: prepared.start.zip(prepared.goal).map(|(start, goal)| straight_m(geometry, [start, goal])),
            hops,
        }
    }

    /// That of a whole map, with plans of this many hops to several goals, or without any. The coefficients of a friction raster are not
    /// looked through.
    pub(super) fn of_map(ground: &DemGround, hops: usize) -> Self {
        let bounds = ground.terrain().dem().bounds();
        let constant = ground.constant_friction().map(FrictionCone::coefficient);
        let of_raster = ground.terrain().overlays().friction().map(|_| f64::INFINITY);
        Self { friction_max: of_raster.or(constant), extent_m: (bounds.max - bounds.min).norm(), journey_m: None, hops }
    }
}

/// The straight distance of two stations, m: of a chain with bends that of their places on the map.
fn straight_m(geometry: &PolygonalChain, ends: [Station; 2]) -> f64 {
    let [start, goal] = ends.map(|end| geometry.map_point(&end).filter(|_| !geometry.bends().is_empty()));
    start.zip(goal).map_or_else(|| (ends[1].point.x_m - ends[0].point.x_m).abs(), |(start, goal)| (goal - start).norm())
}

/// A warning where the hops of a path, flown exactly, bounce on beyond their planned landings: a plan is a plan of first contacts.
pub(super) fn unplanned_bounces(hops: &[Hop]) -> Option<String> {
    let roll_outs = || hops.iter().filter_map(|hop| Some((hop.roll_out?, hop.run_m())));
    let farthest_m = roll_outs().map(|(roll_out, _)| roll_out.distance_m.abs()).reduce(f64::max)?;
    let share = roll_outs().map(|(roll_out, run_m)| roll_out.distance_m.abs() / run_m).fold(0.0, f64::max);
    let unheld = roll_outs().filter(|(roll_out, _)| !roll_out.rests).count();
    let held = match unheld {
        0 => String::new(),
        1 => "; one of them does not come to rest on ground that holds it".to_owned(),
        more => format!("; {more} of them do not come to rest on ground that holds them"),
    };
    (farthest_m > 0.0 || unheld > 0).then(|| {
        format!(
            "by [contact] planned hops come to rest up to {farthest_m:.3} m, {:.0} % of their length, from their landings{held}: a plan lists \
             first contacts and takes each hop off from the landing before; trials fly the bounces, so that only the policy replan, which \
             aims at the place of rest, follows this plan",
            100.0 * share
        )
    })
}

impl Scenario {
    /// Warnings about a path that was found: constant gravity, a landing beside the goal, a clearance that no hop keeps.
    pub fn path_warnings(&self, path: &HopPath) -> Vec<String> {
        let gravity = constant_gravity_warnings(&self.body, Extremes::of(&path.hops));
        gravity
            .into_iter()
            .chain(self.missed_goal(path))
            .chain(self.unkept_clearance(path))
            .chain(unplanned_bounces(&path.hops))
            .collect()
    }

    /// A warning where commands in steps land farther from the goal than trials may.
    fn missed_goal(&self, path: &HopPath) -> Option<String> {
        let tolerance_m = self.uncertainty.as_ref()?.goal_tolerance_m;
        let miss_m = path.hops.last()?.aim?.distance_m();
        (miss_m > tolerance_m).then(|| {
            format!(
                "the last landing of commands in steps lies {} m from the goal, farther than uncertainty.goal_tolerance_m of {} m: a \
                 trial that flies this plan exactly counts as missed; raise the tolerance, or take smaller steps",
                format_number(miss_m),
                format_number(tolerance_m)
            )
        })
    }

    /// Whether every hop of a path is too short to keep the whole of a tapered clearance: whatever the clearance, above this one the path
    /// has to keep no more.
    pub fn keeps_no_clearance_in_full(&self, path: &HopPath) -> bool {
        self.most_clearance_m(path).is_some_and(|(_, _, most_m)| most_m < self.hopper.limits().clearance_m)
    }

    /// The taper, the longest hop of a path, m, and the most of a tapered clearance that it can be asked to keep, m; `None` without a taper
    /// or without hops.
    fn most_clearance_m(&self, path: &HopPath) -> Option<(f64, f64, f64)> {
        let taper = self.hopper.limits().clearance_rule.taper()?;
        let longest_m = path.hops.iter().map(Hop::run_m).reduce(f64::max)?;
        Some((taper, longest_m, 0.5 * taper * longest_m))
    }

    /// A warning where every hop of a path is too short to keep the whole of a tapered clearance.
    fn unkept_clearance(&self, path: &HopPath) -> Option<String> {
        let limits = self.hopper.limits();
        let (taper, longest_m, most_m) = self.most_clearance_m(path)?;
        (most_m < limits.clearance_m).then(|| {
            format!(
                "no hop keeps hopper.clearance_m of {} m in full: at a clearance_taper of {} the longest, of {} m, keeps {} m at its middle; \
                 raise the taper, or lower the clearance",
                format_number(limits.clearance_m),
                format_number(taper),
                format_number(longest_m),
                format_number(most_m)
            )
        })
    }

    /// Warnings about trials without a plan: settings that they do not feel, deviations beyond sense.
    pub(super) fn drift_warnings(&self, ground: &TrialGround) -> Vec<String> {
        self.unfelt_friction(ground).into_iter().chain(self.beyond_sense(ground)).collect()
    }

    /// A warning where an error of the friction changes nothing.
    fn unfelt_friction(&self, ground: &TrialGround) -> Option<String> {
        let sigma = self.uncertainty.as_ref().map_or(0.0, |keys| keys.errors.friction_sigma);
        (sigma > 0.0 && ground.friction_max.is_none()).then(|| {
            format!(
                "uncertainty.friction_sigma = {} has no effect: the limits of this ground are stated as angles, and no friction coefficient \
                 decides a contact; leave it out, or give the ground a friction coefficient",
                format_number(sigma)
            )
        })
    }

    /// Warnings about trials under these policies: settings that they do not feel, deviations beyond sense, no errors at all.
    pub fn trial_warnings(&self, policies: &[Policy], ground: &TrialGround) -> Vec<String> {
        let keys = self.uncertainty.clone().unwrap_or_default();
        let Uncertainty { position_sigma_m, friction_sigma, .. } = keys.errors;
        let mut warnings: Vec<String> = Vec::new();
        let felt = Uncertainty {
            position_sigma_m: if policies.contains(&Policy::Replan) { position_sigma_m } else { 0.0 },
            friction_sigma: if ground.friction_max.is_some() { friction_sigma } else { 0.0 },
            ..keys.errors.clone()
        };
        if felt.position_sigma_m != position_sigma_m {
            warnings.push(format!(
                "uncertainty.position_sigma_m = {} has no effect on trials under the policy open-loop, which flies its commands wherever the \
                 robot is: set uncertainty.policy = \"replan\", or leave it out",
                format_number(position_sigma_m)
            ));
        }
        warnings.extend(self.unfelt_friction(ground));
        if felt.is_none() && !keys.errors.is_none() {
            warnings.push(
                "no error that is given has an effect on these trials, so that every trial flies the plan exactly and the rate has no meaning"
                    .to_owned(),
            );
        }
        let limit = keys.hop_limit.filter(|limit| usize::try_from(*limit).is_ok_and(|limit| limit < ground.hops));
        warnings.extend(limit.map(|limit| {
            let hops = ground.hops;
            format!(
                "uncertainty.hop_limit is {limit}, below the {hops} hops of the plan, so that no trial can fly all of it: raise it"
            )
        }));
        warnings.extend(keys.warning().map(str::to_owned));
        warnings.extend(self.layers.iter().filter(|layer| layer.rule.outage.is_some()).map(|layer| {
            format!(
                "trials do not count how long the condition of layer.{} is unmet: the plan keeps its outage, and a trial that goes other ways or \
                 bounces may not",
                layer.rule.name
            )
        }));
        warnings.extend(self.beyond_sense(ground));
        warnings
    }

    /// Warnings about deviations that no working machine and no useful map has: most often a mistake of units.
    fn beyond_sense(&self, ground: &TrialGround) -> Vec<String> {
        /// A tenth is much for a hopper; half is a percentage taken for a share, or no control at all.
        const FRACTION_MAX: f64 = 0.5;
        /// Two thirds of the draws lie within the deviation: at 45 degrees a third of the hops go anywhere.
        const ANGLE_MAX_DEG: f64 = 45.0;
        /// The deviation of the slope error, height over correlation length: beyond 1 the map says nothing about slopes.
        const SLOPE_MAX: f64 = 1.0;
        let keys = self.uncertainty.clone().unwrap_or_default();
        let errors = &keys.errors;
        let TrialGround { friction_max, extent_m, journey_m, .. } = *ground;
        let speed_max_m_s = self.hopper.limits().takeoff_speed_max_m_s;
        let over = |key: &str, found: f64, most: f64, unit: &str, what: &str| {
            (found > most).then(|| {
                format!(
                    "uncertainty.{key} is {}, over {}{unit}, {what}: check its unit; so large an error leaves nothing of the plan",
                    format_number(found),
                    format_number(most)
                )
            })
        };
        let extent = "the whole extent of the terrain";
        let of_angle = "beyond which a hop may go anywhere";
        let goal_tolerance = journey_m.filter(|journey_m| *journey_m > 0.0 && keys.goal_tolerance_m >= *journey_m).map(|journey_m| {
            format!(
                "uncertainty.goal_tolerance_m is {} m, no less than the {} m from start to goal: the start itself counts as reached",
                format_number(keys.goal_tolerance_m),
                format_number(journey_m)
            )
        });
        let measured = errors.measured.iter().flat_map(MeasuredErrors::greatest).filter_map(|(column, found)| {
            let (most, what) = match column {
                "takeoff_speed_error_fraction" => (1.0, "the whole commanded speed (0.02 is 2 %)"),
                "takeoff_speed_error_m_s" => (speed_max_m_s, "the greatest take-off speed of the hopper"),
                "takeoff_angle_error_deg" | "heading_error_deg" => (2.0 * ANGLE_MAX_DEG, "a flight across or back"),
                _ => (extent_m, extent),
            };
            (found > most).then(|| {
                format!(
                    "uncertainty.errors has a {column} of {} in size, over {}, {what}: check its unit",
                    format_number(found),
                    format_number(most)
                )
            })
        });
        let slope = if errors.height_correlation_m > 0.0 { errors.height_sigma_m / errors.height_correlation_m } else { 0.0 };
        let steep = (slope > SLOPE_MAX).then(|| {
            format!(
                "uncertainty.height_sigma_m of {} m over height_correlation_m of {} m means slope errors with a deviation of {:.0} deg, over \
                 45 deg: check both units; the map then says nothing about slopes",
                format_number(errors.height_sigma_m),
                format_number(errors.height_correlation_m),
                libm::atan(slope).to_degrees()
            )
        });
        [
            over(
                "takeoff_speed_sigma_m_s",
                errors.takeoff_speed_sigma_m_s,
                speed_max_m_s,
                " m/s",
                "the greatest take-off speed of the hopper",
            ),
            over(
                "takeoff_speed_sigma_fraction",
                errors.takeoff_speed_sigma_fraction,
                FRACTION_MAX,
                "",
                "half the commanded speed (0.02 is 2 %)",
            ),
            over("takeoff_angle_sigma_deg", errors.takeoff_angle_sigma.degrees(), ANGLE_MAX_DEG, " deg", of_angle),
            over("heading_sigma_deg", errors.heading_sigma.degrees(), ANGLE_MAX_DEG, " deg", of_angle),
            over(
                "takeoff_speed_bias_sigma_fraction",
                errors.takeoff_speed_bias_sigma_fraction,
                FRACTION_MAX,
                "",
                "half the commanded speed (0.02 is 2 %)",
            ),
            over("takeoff_angle_bias_sigma_deg", errors.takeoff_angle_bias_sigma.degrees(), ANGLE_MAX_DEG, " deg", of_angle),
            over("heading_bias_sigma_deg", errors.heading_bias_sigma.degrees(), ANGLE_MAX_DEG, " deg", of_angle),
            over("position_sigma_m", errors.position_sigma_m, extent_m, " m", extent),
            over("drift_along_sigma_m", errors.drift_along_sigma_m, extent_m, " m", extent),
            over("drift_across_sigma_m", errors.drift_across_sigma_m, extent_m, " m", extent),
            over(
                "friction_sigma",
                errors.friction_sigma,
                friction_max.unwrap_or(f64::INFINITY),
                "",
                "the greatest friction coefficient of the ground",
            ),
            over("height_sigma_m", errors.height_sigma_m, extent_m, " m", extent),
            steep,
            goal_tolerance,
        ]
        .into_iter()
        .flatten()
        .chain(measured)
        .collect()
    }

    /// Warnings about keys that others of this scenario, or the chain, replace.
    pub fn replaced_keys(&self, prepared: &Prepared) -> Vec<String> {
        let mut warnings = Vec::new();
        let grounds = prepared.chain.geometry().grounds();
        let is_chain = matches!(self.terrain, Some(TerrainSource::Chain { .. }));
        // The chain of a slice has the scenario's own friction in its segments.
        let constant = self.surface.constant_friction();
        let own_grip = grounds.iter().all(|ground| match ground.form {
            GroundForm::Surface { friction, .. } => friction.is_some(),
            GroundForm::Explicit { .. } => true,
        });
        // As in a chain that was sliced under this scenario.
        let same = constant.is_some()
            && grounds.iter().all(|ground| matches!(ground.form, GroundForm::Surface { friction, .. } if friction == constant));
        if is_chain && own_grip && !same && self.surface.grip.is_some() {
            let key = if constant.is_some() {
                "surface.friction_coefficient has"
            } else {
                "surface.takeoff_from_slope_deg and landing_from_slope_deg have"
            };
            warnings.push(format!(
                "{key} no effect: every segment of the chain states its own friction or angles, which count; change those columns of the \
                 chain, or leave the key out"
            ));
        }
        if self.derating.friction != 1.0 && grounds.iter().all(|ground| matches!(ground.form, GroundForm::Explicit { .. })) {
            warnings.push(
                "derating.friction has no effect: every segment of the chain states its own angles, which no friction decides"
                    .to_owned(),
            );
        }
        if self.accept_map_scale && !matches!(self.terrain, Some(TerrainSource::Dem { .. }) | None) {
            warnings.push("terrain.accept_map_scale has no effect: only a dem has a map whose scale can be off".to_owned());
        }
        if self.risk != ReliabilityUse::Ignored && self.reliability_with(Some(0), None).model.distinguishes_no_hops() {
            warnings.push(format!(
                "search.risk = \"{}\" has no effect: [uncertainty] has no error that the estimate of a hop's risk uses; give it one, such as \
                 takeoff_speed_sigma_fraction = 0.01, or leave [uncertainty] out to weigh the slack of angles",
                self.risk.name()
            ));
        }
        warnings
    }
}
