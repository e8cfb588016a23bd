//! The costs-to-go of all posts, for replanning over a map.

use super::{Journey, MapError, Post, PostHops, Search, search};
use crate::{
    ballistics::TakeoffChoice,
    flight::Uncertainty,
    graph::{Effort, PostCosts},
    ground::{DemGround, Surface},
    progress::Progress,
    quantity::Angle,
    world::{FrictionCone, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// The cost of the cheapest path from every post to a goal: the fewest hops, then the least effort, by the hop tests of the map.
///
/// The goal counts also where the ground under it refuses every contact; then no other post has a cost.
///
/// # Errors
/// [`MapError`].
///
/// # Complexity
/// That of a [`search`] with an effort against the direction of the hops; [`PostCosts`] keeps 10 bytes for each post.
pub fn costs_to_go(
    hops: &PostHops,
    goal: Post,
    (effort, takeoff): (Effort, TakeoffChoice),
    progress: &dyn Progress,
) -> Result<PostCosts, MapError> {
    let asked = Search { journey: Journey::Return, effort: Some((effort, takeoff)), hops_max: None };
    let map = search(hops, &[goal.into()], asked, progress)?;
    PostCosts::new(hops.lattice(), (map.hops, map.effort), (effort, takeoff))
}

/// The standard deviations of the errors of command that a margin leaves room for.
const SIGMAS: f64 = 2.5;

/// The costs by which a robot with these errors replans: where it flies the most reliable command of every hop, the costs of a machine
/// that keeps a margin of some standard deviations to its limits of speed and friction come before those of the machine itself; otherwise
/// those of [`costs_to_go`].
///
/// Paths of fewest hops fly every hop at a limit, which an error of the command passes half the time.
///
/// # Errors
/// [`MapError`].
pub fn reliable_costs_to_go(
    hops: &PostHops,
    goal: Post,
    (effort, takeoff): (Effort, TakeoffChoice),
    errors: &Uncertainty,
    progress: &dyn Progress,
) -> Result<PostCosts, MapError> {
    let exact = costs_to_go(hops, goal, (effort, takeoff), progress)?;
    let is_weighed = takeoff == TakeoffChoice::MostReliable && *errors != Uncertainty::NONE;
    let Some(ground) = with_margin(hops.ground(), errors).filter(|_| is_weighed) else {
        return Ok(exact.with_errors(hops.ground(), errors));
    };
    let with_margin = PostHops::new(ground, hops.lattice().stride)?;
    let costs = costs_to_go(&with_margin, goal, (effort, takeoff), progress)?;
    Ok(costs.then_without_margin(&exact).with_errors(hops.ground(), errors))
}

/// The same ground for a machine that keeps a margin; `None` if it has no hops then.
fn with_margin(ground: &DemGround, errors: &Uncertainty) -> Option<DemGround> {
    let sigmas = std::env::var("CH_S").ok().and_then(|v| v.parse().ok()).unwrap_or(SIGMAS);
    let limits = *ground.hopper().limits();
    let slower = |speed_m_s: f64| {
        let sigma_m_s = libm::hypot(errors.takeoff_speed_sigma_fraction * speed_m_s, errors.takeoff_speed_sigma_m_s);
        if speed_m_s.is_finite() { speed_m_s - sigmas * sigma_m_s } else { speed_m_s }
    };
    let landing_speed_max_m_s =
        if limits.landing.brakes() { limits.landing_speed_max_m_s } else { slower(limits.landing_speed_max_m_s) };
    let takeoff_speed_max_m_s = slower(limits.takeoff_speed_max_m_s);
    let hopper = Hopper::new(HopperLimits { takeoff_speed_max_m_s, landing_speed_max_m_s, ..limits }).ok()?;
    let narrower = |cone: FrictionCone| {
        let angle = cone.half_angle().radians() - sigmas * errors.takeoff_angle_sigma.radians();
        FrictionCone::new(Angle::from_radians(angle).slope() - sigmas * errors.friction_sigma).ok()
    };
    let grip = match ground.surface().grip {
        Some(Grip::Friction(cone)) => Some(Grip::Friction(narrower(cone)?)),
        other => other,
    };
    // The slope to rest on is no matter of an error of the command.
    let rest = match (ground.surface().rest, ground.constant_friction()) {
        (RestSlope::AsFrictionHolds, Some(cone)) => RestSlope::AtMost(cone.half_angle()),
        (rest, _) => rest,
    };
    Some(DemGround::new(ground.terrain().clone(), &hopper, ground.gravity(), &SurfaceProperties { grip, rest }))
}
