//! Whether a key's value affects the answer.

use std::path::PathBuf;

use super::Prepared;
use crate::{
    scenario::{LayerKeys, Route, Scenario},
    world::{Hopper, HopperLimits, SurfaceProperties},
};

/// Whether two scenarios put the same limits on every hop between the same ends over the same points: ground, hopper and gravity.
///
/// Speed limits are compared after the segments' own limits are applied, so one beyond the chain's limits makes no difference. What
/// only counts in totals (mass, propellant, times, energies) or after a landing (bounces) is ignored; errors count where a budget of success
/// estimates them, and totals where a plan by objective or a budget of totals counts them.
pub fn ask_the_same((a, on_a): (&Scenario, &Prepared), (b, on_b): (&Scenario, &Prepared)) -> bool {
    let machine = |hopper: &Hopper| HopperLimits {
        takeoff_speed_max_m_s: 0.0,
        landing_speed_max_m_s: 0.0,
        mass_kg: None,
        rest_time_s: None,
        hop_delta_v_overhead_m_s: None,
        isp_s: None,
        propellant_max_kg: None,
        preparation_time_s: None,
        settling_time_s: None,
        preparation_energy_j: None,
        efficiency: None,
        restitution: None,
        ..*hopper.limits()
    };
    let estimated = |scenario: &Scenario| {
        let least = scenario.budget.estimated_success_min?;
        Some((least, scenario.uncertainty.clone(), scenario.risk, scenario.risk_extra_hops_max, scenario.search.takeoff))
    };
    let by_objective = |scenario: &Scenario| {
        let Scenario { objective, budget, commands, search, hopper, .. } = scenario;
        scenario.plans_by_objective().then(|| (objective.clone(), *budget, *commands, search.clone(), *hopper.limits()))
    };
    machine(&a.hopper) == machine(&b.hopper)
        && by_objective(a) == by_objective(b)
        && a.derating == b.derating
        && a.drives() == b.drives()
        && estimated(a) == estimated(b)
        && a.body.gravity.m_s2() == b.body.gravity.m_s2()
        && a.search.spacing == b.search.spacing
        && (on_a.start, on_a.goal) == (on_b.start, on_b.goal)
        && on_a.chain.segments() == on_b.chain.segments()
        && on_a.chain.geometry().vertices() == on_b.chain.geometry().vertices()
        && on_a.chain.geometry().layers() == on_b.chain.geometry().layers()
        && (a.route == Route::Transect || over_dem(a) == over_dem(b))
}

/// What limits hops beside the line of a slice too: the speeds, what friction rasters leave open, and what is laid over the map.
fn over_dem(scenario: &Scenario) -> (SurfaceProperties, [f64; 2], [&Option<PathBuf>; 2], &[LayerKeys]) {
    let (limits, cap_m_s) = (scenario.hopper.limits(), scenario.body.gravity.speed_cap_m_s());
    let speeds_m_s = [limits.takeoff_speed_max_m_s, limits.landing_speed_max_m_s].map(|speed_m_s| speed_m_s.min(cap_m_s));
    (scenario.surface, speeds_m_s, [&scenario.keep_out, &scenario.keep_in], &scenario.layers)
}
