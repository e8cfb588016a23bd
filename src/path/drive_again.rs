//! The independent checker of a drive leg: it walks the ground element by element and measures the slope across by walking aside.
//!
//! The limits of a leg are implemented twice in this crate: over the exact slice in `drive`, and here. The checker uses [`Profiles`]
//! alone: no slice, no gradient of a facet, no normal.

use std::{fmt, ops::ControlFlow};

use nalgebra::Vector2;

use super::execute::fitted_ground;
use crate::{
    chain::GroundRefusal,
    ground::{ContactPoint, Element, Profiles, Side},
    quantity::{Angle, MapPoint},
    world::Rover,
};

/// A limit that a driven leg breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveViolation {
    /// The key of the limit in a scenario's table `drive`, or what the ground lacks.
    pub limit: &'static str,
    /// What was found, in degrees or in m; where ground lacks or is kept out, the distance along the leg, m.
    pub found: f64,
    /// The greatest allowed.
    pub most: f64,
}

impl fmt::Display for DriveViolation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, expected at most {}", self.limit, self.found, self.most)
    }
}

/// What a leg takes, as walked.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct DrivenAgain {
    /// The length in three dimensions, m.
    pub length_m: f64,
    /// The time to drive it, without turns, s.
    pub time_s: f64,
    /// The energy from the store per unit mass, without turns, J/kg.
    pub energy_j_kg: f64,
    /// All violations; empty if the leg holds.
    pub violations: Vec<DriveViolation>,
}

/// A slope may exceed its limit by so much, rad, and a height by this share of the wheelbase, m: what two ways to compute it differ by.
const TOLERANCE: f64 = 1e-7;

/// Drives a straight leg again over a ground, and reports all its violations.
///
/// # Examples
/// ```
/// use chta::{ground::DemGround, path::drive_again, quantity::{Angle, MapPoint}, terrain::{Dem, GeoReference, OverlaidDem, Overlays}, world::{Gravity, Hopper, RestSlope, Rover, RoverLimits, SurfaceProperties}};
/// // A plane that rises by 3 in 4 to the east: 4 m of way are 5 m long, and 36.9 degrees steep.
/// let posts = (0..36).map(|post| 0.75 * f64::from(post % 6)).collect();
/// let dem = Dem::new(6, 6, posts, GeoReference::local(MapPoint::new(0.0, 5.0), 1.0, 1.0)?)?;
/// let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
/// let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &Hopper::with_speeds(1.0, 1.0)?, Gravity::new(1.62)?, &surface);
/// let [west, east] = [0.5, 4.5].map(|x_m| ground.position(MapPoint::new(x_m, 2.5)).unwrap());
/// let driven = |steepest| drive_again(&ground, &Rover::new(RoverLimits::new(0.1, Angle::from_degrees(steepest)), None).unwrap(), &west, &east);
/// assert!((driven(40.0).time_s - 50.0).abs() < 1e-6 && driven(40.0).violations.is_empty());
/// assert_eq!(driven(30.0).violations[0].limit, "slope_up_max_deg");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn drive_again<G: Profiles>(ground: &G, rover: &Rover, from: &G::Contact, to: &G::Contact) -> DrivenAgain {
    let mut driven = DrivenAgain::default();
    let Some((run_m, heading)) = ground.course(from, to) else { return driven };
    let elements = walked(ground, from, heading, run_m);
    let reached_m = elements.last().map_or(0.0, |element| element.to_m);
    if reached_m < run_m - ground.resolution_m() {
        driven.violate("ground", reached_m, run_m);
        return driven;
    }
    let start = ground.contact_point(from);
    let place = |along_m: f64| {
        let at = MapPoint::from(start.point_m.xy().coords + heading * along_m);
        ground.contact_at(&ContactPoint::on_map(along_m, at, 0.0))
    };
    let [up, down, across] = rover.slopes().map(|slope| Angle::from_slope(slope).radians());
    let mut steepest = [0.0_f64; 3];
    for element in &elements {
        let width_m = element.to_m - element.from_m;
        if width_m <= ground.resolution_m() {
            continue;
        }
        let slope = (element.to_z_m - element.from_z_m) / width_m;
        let length_m = libm::hypot(width_m, element.to_z_m - element.from_z_m);
        driven.length_m += length_m;
        driven.time_s += length_m / rover.speed_m_s(slope);
        driven.energy_j_kg += length_m * rover.energy_j_kg_m(slope, ground.gravity_m_s2());
        let along = libm::atan(slope);
        steepest[0] = steepest[0].max(along);
        steepest[1] = steepest[1].max(-along);
        driven.layers(ground, &place, (element.from_m, element.to_m));
        let middle_m = element.from_m + 0.5 * width_m;
        let Some(middle) = place(middle_m) else {
            driven.violate("ground", middle_m, run_m);
            continue;
        };
        if ground.facets(&middle, heading, Side::Ahead).iter().any(|facet| matches!(facet.refusal, Some(GroundRefusal::KeepOut))) {
            driven.violate("keep-out", middle_m, 0.0);
        }
        for aside in [Vector2::new(-heading.y, heading.x), Vector2::new(heading.y, -heading.x)] {
            steepest[2] = steepest[2].max(slope_of_first(ground, &middle, aside).map_or(0.0, |slope| libm::atan(slope.abs())));
        }
    }
    let slack = TOLERANCE + ground.slope_rounding();
    let keys = ["slope_up_max_deg", "slope_down_max_deg", "cross_slope_max_deg"];
    for ((key, found), most) in keys.into_iter().zip(steepest).zip([up, down, across]) {
        if found > most + slack {
            driven.violate(key, found.to_degrees(), most.to_degrees());
        }
    }
    driven.under_wheels(ground, rover, [from, to], (heading, run_m), &place);
    driven
}

impl DrivenAgain {
    fn violate(&mut self, limit: &'static str, found: f64, most: f64) {
        self.violations.push(DriveViolation { limit, found, most });
    }

    /// Layers on contacts, cell by cell at places along a part of the leg; one on a border may lie on either side of it.
    fn layers<G: Profiles>(&mut self, ground: &G, place: &dyn Fn(f64) -> Option<G::Contact>, (from_m, to_m): (f64, f64)) {
        /// Places on each part, which crosses no more than one line of posts.
        const PLACES: u32 = 8;
        let Some(layers) = ground.layers().filter(|layers| !layers.is_empty()) else { return };
        for number in 0..=PLACES {
            let at_m = from_m + (to_m - from_m) * f64::from(number) / f64::from(PLACES);
            let Some(at) = place(at_m).and_then(|at| ground.contact_point(&at).map()) else { continue };
            if layers.iter().any(|layer| layer.rule().on_contact && !super::execute::holds_near(layer, at)) {
                return self.violate("layer", at_m, 0.0);
            }
        }
    }

    /// The step over the wheelbase, and the roughness at both ends.
    fn under_wheels<G: Profiles>(
        &mut self,
        ground: &G,
        rover: &Rover,
        ends: [&G::Contact; 2],
        (heading, run_m): (Vector2<f64>, f64),
        place: &dyn Fn(f64) -> Option<G::Contact>,
    ) {
        let limits = rover.limits();
        let Some(wheelbase_m) = limits.wheelbase_m else { return };
        let slack_m = TOLERANCE * wheelbase_m + ground.height_rounding_m();
        if let Some(step_max_m) = limits.step_max_m {
            let first_m = -0.5 * wheelbase_m;
            let whole_m = run_m + wheelbase_m;
            let elements = place(first_m).map(|at| walked(ground, &at, heading, whole_m)).unwrap_or_default();
            if elements.last().is_none_or(|last| last.to_m < whole_m - ground.resolution_m()) {
                self.violate("ground", whole_m, run_m);
            } else {
                let height = |at_m: f64| height_m(&elements, at_m);
                let bends = elements.iter().flat_map(|element| [element.from_m, element.to_m]);
                let rear = bends.flat_map(|bend_m| [bend_m, bend_m - wheelbase_m]).chain([0.0, run_m]);
                let steps = rear
                    .filter(|rear_m| (0.0..=run_m).contains(rear_m))
                    .map(|rear_m| height(rear_m + wheelbase_m) - height(rear_m));
                let step_m = steps.map(f64::abs).fold(0.0, f64::max);
                if step_m > step_max_m + slack_m {
                    self.violate("step_max_m", step_m, step_max_m);
                }
            }
        }
        if let Some(roughness_max_m) = limits.roughness_max_m {
            for end in ends {
                match fitted_ground(ground, end, wheelbase_m) {
                    None => self.violate("ground", 0.0, run_m),
                    Some(residual_m) if residual_m > roughness_max_m + slack_m => {
                        self.violate("roughness_max_m", residual_m, roughness_max_m);
                    }
                    Some(_) => {}
                }
            }
        }
    }
}

/// The elements under a line of travel, the last one cut at its end.
fn walked<G: Profiles>(ground: &G, from: &G::Contact, heading: Vector2<f64>, run_m: f64) -> Vec<Element> {
    let mut elements = Vec::new();
    ground.walk(from, heading, &mut |element| {
        if element.from_m >= run_m {
            return ControlFlow::Break(());
        }
        let to_m = element.to_m.min(run_m);
        let share = if element.to_m > element.from_m { (to_m - element.from_m) / (element.to_m - element.from_m) } else { 1.0 };
        let to_z_m = element.from_z_m + share * (element.to_z_m - element.from_z_m);
        elements.push(Element { to_m, to_z_m, ..*element });
        ControlFlow::Continue(())
    });
    elements
}

/// The slope of the first element in a direction that is longer than a rounding error.
fn slope_of_first<G: Profiles>(ground: &G, from: &G::Contact, heading: Vector2<f64>) -> Option<f64> {
    let mut slope = None;
    ground.walk(from, heading, &mut |element| {
        let width_m = element.to_m - element.from_m;
        if width_m <= ground.resolution_m() {
            return ControlFlow::Continue(());
        }
        slope = Some((element.to_z_m - element.from_z_m) / width_m);
        ControlFlow::Break(())
    });
    slope
}

/// The height of walked ground at a distance along it, m.
fn height_m(elements: &[Element], at_m: f64) -> f64 {
    let number = elements.partition_point(|element| element.to_m < at_m).min(elements.len() - 1);
    let element = &elements[number];
    let width_m = element.to_m - element.from_m;
    let share = if width_m > 0.0 { ((at_m - element.from_m) / width_m).clamp(0.0, 1.0) } else { 1.0 };
    element.from_z_m + share * (element.to_z_m - element.from_z_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        draw::Draw,
        drive::{DriveGround, DriveLimit},
        ground::{DemGround, MapPosition},
        terrain::{Dem, GeoReference, OverlaidDem, Overlays},
        world::{Gravity, Hopper, RestSlope, RoverLimits, SlipCurve, SurfaceProperties},
    };

    /// The key that the checker names for a limit of the planner.
    const fn key(limit: DriveLimit) -> &'static str {
        match limit {
            DriveLimit::Ground => "ground",
            DriveLimit::KeepOut => "keep-out",
            DriveLimit::Layer => "layer",
            DriveLimit::SlopeUp => "slope_up_max_deg",
            DriveLimit::SlopeDown => "slope_down_max_deg",
            DriveLimit::CrossSlope => "cross_slope_max_deg",
            DriveLimit::Step => "step_max_m",
            DriveLimit::Roughness => "roughness_max_m",
        }
    }

    fn ground(draw: &mut Draw) -> DemGround {
        let (side, relief_m) = (7, draw.log_uniform(0.01, 2.0));
        let heights = (0..side * side).map(|_| if draw.chance(0.04) { f64::NAN } else { draw.uniform(0.0, relief_m) }).collect();
        let map = GeoReference::local(MapPoint::new(1000.0, 500.0), 1.0, draw.uniform(0.7, 1.4)).unwrap();
        let dem = Dem::new(side, side, heights, map).unwrap();
        let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
        let hopper = Hopper::with_speeds(1.0, 1.0).unwrap();
        let gravity = Gravity::new(draw.log_uniform(1e-5, 25.0)).unwrap();
        DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, gravity, &surface)
    }

    fn rover(draw: &mut Draw) -> Rover {
        let slope = |draw: &mut Draw| Angle::from_degrees(draw.uniform(5.0, 70.0));
        let limits = RoverLimits {
            slope_down_max: Some(slope(draw)),
            cross_slope_max: Some(slope(draw)),
            wheelbase_m: Some(draw.uniform(0.2, 1.5)),
            step_max_m: draw.chance(0.5).then(|| draw.uniform(0.05, 0.8)),
            roughness_max_m: draw.chance(0.5).then(|| draw.uniform(0.005, 0.15)),
            rolling_resistance: 0.15,
            efficiency: 0.5,
            idle_power_w: 4.0,
            slip: SlipCurve::new(&[[0.0, 0.0], [20.0, 0.5]]).unwrap(),
            ..RoverLimits::new(draw.log_uniform(0.01, 1.0), slope(draw))
        };
        Rover::new(limits, Some(3.0)).unwrap()
    }

    /// Random legs, some along posts and edges: the checker passes what the planner drives, with the same sums, and where the planner
    /// refuses it finds that limit broken too.
    #[test]
    fn two_ways_to_judge_a_leg_agree() {
        let draw = &mut Draw::seeded(1907);
        let (mut driven, mut refused) = (0, std::collections::BTreeMap::<&str, u32>::new());
        for case in 0..500 {
            let (ground, rover) = (ground(draw), rover(draw));
            let drive = DriveGround::new(&ground, &rover);
            let bounds = ground.terrain().dem().bounds();
            for leg in 0..12 {
                let on_posts = leg % 2 == 0;
                let place = |draw: &mut Draw| {
                    let map = ground.terrain().dem().georeference();
                    let (row, col) = (draw.below(7), draw.below(7));
                    let at = MapPoint::new(draw.uniform(bounds.min.x, bounds.max.x), draw.uniform(bounds.min.y, bounds.max.y));
                    if on_posts { map.post(row, col) } else { at }
                };
                let [Some(from), Some(to)]: [Option<MapPosition>; 2] = [0, 1].map(|_| ground.position(place(draw))) else {
                    continue;
                };
                if (to.at - from.at).norm() < 1e-6 {
                    continue;
                }
                let again = drive_again(&ground, &rover, &from, &to);
                match drive.leg(&from, &to) {
                    Ok(leg) => {
                        assert!(again.violations.is_empty(), "case {case}: {from:?} to {to:?}: {:?}", again.violations);
                        for (a, b) in
                            [(again.length_m, leg.length_m), (again.time_s, leg.time_s), (again.energy_j_kg, leg.energy_j_kg)]
                        {
                            assert!((a - b).abs() <= 1e-7 * (1e-9 + a.abs().max(b.abs())), "case {case}: {a} walked, {b} sliced");
                        }
                        driven += 1;
                    }
                    Err(refusal) => {
                        let name = key(refusal.limit());
                        let found = again.violations.iter().any(|violation| violation.limit == name);
                        assert!(found, "case {case}: {from:?} to {to:?}: {refusal}, and the checker found {:?}", again.violations);
                        *refused.entry(name).or_default() += 1;
                    }
                }
            }
        }
        assert!(driven > 300 && refused.len() >= 6 && refused.values().all(|count| *count > 10), "{driven} {refused:?}");
    }
}
