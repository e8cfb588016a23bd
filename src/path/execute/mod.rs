//! The independent checker of a planned path: it flies every hop again and checks every limit.
//!
//! The limits of a hop are implemented twice in this crate: as closed forms in `ballistics`, and independently here. The checker
//! uses no lofts, lines of sight or quadratics: it takes the command of a hop (position, angle, speed), steps Newton's equations
//! from there and looks at what happens. It imports nothing from the closed forms of `ballistics` or from the graph; a test reads
//! these files and enforces that.

mod checker;
mod flight;
mod footprint;
mod layer_costs;
mod layers;
mod over_mesh;
mod stores;
mod touchdown;
mod violation;

use checker::Checker;
use flight::Course;
pub use flight::{Clearance, Flight};
use footprint::FootprintFit;
pub(super) use layers::holds_near;
use stores::Stores;
pub use violation::{Measure, StatedValue, ViolatedLimit, Violation};

use super::{Hop, HopPath};
use crate::{
    ground::{ContactPoint, ElementVertex, Profiles, Surface, Triangulated},
    world::Direction,
};

/// The greatest distance of the ground within a disc about a contact from the plane fitted over it, m, by rays; `None` where the ground is
/// not known as far.
pub(super) fn fitted_ground<S: Profiles>(ground: &S, at: &S::Contact, diameter_m: f64) -> Option<f64> {
    footprint::fitted(ground, at, diameter_m).map(|fit| fit.residual_m)
}

/// The result of flying a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Execution {
    /// What was flown of each hop; `None` if a hop could not be flown.
    pub flights: Vec<Option<Flight>>,
    /// All violations, hop by hop; empty if the path holds.
    pub violations: Vec<Violation>,
}

impl Execution {
    /// Whether there is no violation.
    pub const fn passes(&self) -> bool {
        self.violations.is_empty()
    }
}

/// Flies a planned path by Newton's equations and reports all its violations.
///
/// ```text
///     x += v_x dt,   z += v_z dt - g dt^2 / 2,   v_z -= g dt            (constant acceleration: exact for any dt)
/// ```
///
/// Checks of each hop: it begins where the one before landed; the ground's refusals (direction, keep-out, rest slope); directions
/// and speeds at both ends; the machine's angles, height and time; the clearance over every vertex flown past, and that
/// the arc stays above the ground between them; the actual landing point; with brakes the touchdown instead of the arc's landing;
/// and the numbers that the plan states, delta-v, propellant and what layers of the map cost among them. Every violation is reported.
///
/// Speed limits have the crate's tolerance, [`tolerant_speed_m_s`](crate::world::tolerant_speed_m_s). The checker's own tolerances
/// are a nanoradian for directions, 1e-12 of a flight's size for positions (plus the rounding of the ground's heights), and the
/// resulting uncertainty of direction, speed and time at the landing.
///
/// # Arguments
/// `ends`: the start and goal that the path should join; `None` if they are not to be checked.
///
/// # Examples
/// ```
/// use chta::{ballistics::TakeoffChoice, chain::*, graph::*, hop::{HopTest, Split}, path::{execute, generate}, quantity::*, world::*};
/// let hopper = Hopper::with_speeds(5.0, 5.0).unwrap();
/// let grip = Some(Grip::Friction(FrictionCone::new(1.0).unwrap()));
/// let chain = PolygonalChain::bare(vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(20.0, 0.0)]).unwrap();
/// let (gravity, surface) = (Gravity::new(1.0).unwrap(), SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds });
/// let chain = ConstrainedChain::new(chain, &hopper, gravity, &surface).unwrap();
/// let test = HopTest::new(chain);
/// let chain = test.chain();
/// let (start, goal) = (chain.geometry().station(0.0).unwrap(), chain.geometry().station(20.0).unwrap());
/// let answer = search(&test, start, goal, &SearchOptions::default(), &()).unwrap();
/// let Outcome::Path { legs, .. } = answer.outcome else { panic!() };
/// let mut path = generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::FullReach).unwrap();
/// // 45 degrees over flat ground: v = sqrt(g X) = 4.472 m/s, and 5 m up.
/// let execution = execute(chain, &path, Some((start, goal)));
/// assert!(execution.passes());
/// assert!((execution.flights[0].as_ref().unwrap().apex_z_m - 5.0).abs() < 1e-12);
/// // 1 % too slow: X = v^2 / g falls short by 2 %.
/// path.hops[0].takeoff_speed_m_s *= 0.99;
/// let execution = execute(chain, &path, None);
/// assert!((execution.flights[0].as_ref().unwrap().contact.unwrap().x_m - 19.602).abs() < 1e-9);
/// ```
pub fn execute<S: Profiles>(surface: &S, path: &HopPath, ends: Option<(S::Contact, S::Contact)>) -> Execution {
    executed(surface, &Way { fly: |course| course.fly(), bends: |course| course.bends(), fitted: footprint::fitted }, path, ends)
}

/// Flies a planned path over triangles that may stand over one another by Newton's equations, and reports all its violations.
///
/// The checks are those of [`execute()`]. Both contacts of a hop have to lie on the surface, and obey all facets that meet there, in three
/// dimensions. Every facet that a small step of the flight comes near is cut by the vertical plane of the flight: the flight has to pass
/// over the cut or under it as a whole, at least the clearance away, and not through an edge that two facets share. A ball, in small steps,
/// comes no nearer to the mesh than its radius.
///
/// The tolerance of a distance from a facet is that of the position and the [resolution](Surface::resolution_m) of the mesh. A footprint
/// is not fitted over a mesh: a hopper that has one violates its limit.
pub fn execute_over_mesh<S: Triangulated>(mesh: &S, path: &HopPath, ends: Option<(S::Contact, S::Contact)>) -> Execution {
    executed(mesh, &Way { fly: over_mesh::fly, bends: |_| Vec::new(), fitted: |_, _, _| None }, path, ends)
}

/// How flights over a kind of ground are flown again, and what else lies under them.
struct Way<S: Surface> {
    /// Flies a hop; `None` if it does not leave the ground forwards.
    fly: fn(&Course<'_, S>) -> Option<Flight>,
    /// The bends of the ground strictly below a flight.
    bends: fn(&Course<'_, S>) -> Vec<ElementVertex>,
    /// Fits the ground under a footprint.
    fitted: FootprintFit<S>,
}

fn executed<S: Surface>(surface: &S, way: &Way<S>, path: &HopPath, ends: Option<(S::Contact, S::Contact)>) -> Execution {
    let mut violations = Vec::new();
    let mut flights = Vec::with_capacity(path.hops.len());
    let ends = ends.map(|(start, goal)| (surface.contact_point(&start), surface.contact_point(&goal)));
    let mut before: Option<ContactPoint> = None;
    let mut stores = Stores::full(surface.hopper().limits(), surface.gravity_m_s2());
    for (i, hop) in path.hops.iter().enumerate() {
        match (before, ends) {
            (Some(before), _) => continuous(i + 1, (&before, &hop.takeoff), before == hop.takeoff, &mut violations),
            (None, Some((start, _))) => joins(i + 1, (&start, &hop.takeoff), &mut violations),
            (None, None) => {}
        }
        before = Some(hop.landing);
        if !is_flyable(i + 1, hop, &mut violations) {
            stores.check(i + 1, hop, None, &mut violations);
            flights.push(None);
            continue;
        }
        let flown = checked((surface, way), i + 1, hop, &mut violations);
        stores.check(i + 1, hop, flown.as_ref(), &mut violations);
        flights.push(flown);
    }
    match (before, ends) {
        (Some(before), Some((_, goal))) => joins(path.hops.len(), (&before, &goal), &mut violations),
        (None, Some((start, goal))) => joins(0, (&start, &goal), &mut violations),
        (_, None) => {}
    }
    if let Some(layers) = surface.layers() {
        layer_costs::check(layers, path, &mut violations);
    }
    Execution { flights, violations }
}

/// Flies one hop over the surface and checks every limit.
fn checked<S: Surface>((surface, way): (&S, &Way<S>), number: usize, hop: &Hop, violations: &mut Vec<Violation>) -> Option<Flight> {
    let contacts = [&hop.takeoff, &hop.landing].map(|stated| surface.contact_at(stated));
    let course = match contacts {
        [Some(from), Some(to)] => surface.course(&from, &to).map(|(run_m, heading)| Course { surface, hop, from, run_m, heading }),
        _ => None,
    };
    let heading = course.as_ref().map(|course| course.heading);
    let flown = course.as_ref().and_then(way.fly);
    let bends = course.as_ref().map(way.bends).unwrap_or_default();
    let run_m = course.map(|course| course.run_m);
    let mut checker = Checker { number, surface, contacts, hop, heading, run_m, bends, fitted: way.fitted, violations };
    match &flown {
        Some(flight) => checker.flight(flight),
        None => checker.no_flight(),
    }
    flown
}

/// Checks an end of the path against the requested start or goal: point, frame and station must be identical; the distance along
/// the path (`along_m`) is not compared.
fn joins(hop: usize, ends: (&ContactPoint, &ContactPoint), violations: &mut Vec<Violation>) {
    let (arrived, departs) = ends;
    let same = (arrived.point_m, arrived.frame, arrived.station) == (departs.point_m, departs.frame, departs.station);
    continuous(hop, ends, same, violations);
}

/// Reports a gap between two points that must be identical: the landing of one hop and the take-off of the next, or an end of the
/// path and the requested start or goal. The comparison is exact, since the plan copies the numbers.
fn continuous(hop: usize, (arrived, departs): (&ContactPoint, &ContactPoint), same: bool, violations: &mut Vec<Violation>) {
    if !same {
        let found = (arrived.point_m - departs.point_m).norm();
        let measure = Some(Measure { found, allowed: 0.0, unit: "m" });
        violations.push(Violation { measure, ..Violation::at(hop, ViolatedLimit::Continuity, departs.along_m) });
    }
}

/// Checks that a hop's numbers are finite and that its ends differ in distance along the path: otherwise it cannot be flown. A wrong stated
/// direction is reported but does not prevent the flight.
fn is_flyable(number: usize, hop: &Hop, violations: &mut Vec<Violation>) -> bool {
    let before = violations.len();
    let mut note = |value| {
        let limit = ViolatedLimit::StatedValue(value);
        violations.push(Violation::at(number, limit, hop.takeoff.along_m));
    };
    // Finite only if every coordinate is.
    let size = |point: &ContactPoint| point.along_m.abs() + point.point_m.coords.abs().sum();
    let numbers = [
        (StatedValue::TakeoffStation, size(&hop.takeoff)),
        (StatedValue::LandingStation, size(&hop.landing)),
        (StatedValue::TakeoffAngle, hop.takeoff_angle.radians()),
        (StatedValue::TakeoffSpeed, hop.takeoff_speed_m_s),
    ];
    for (value, number) in numbers {
        if !number.is_finite() {
            note(value);
        }
    }
    let direction = Direction::between(hop.takeoff.along_m, hop.landing.along_m);
    if direction != Some(hop.direction) {
        note(StatedValue::Direction);
    }
    direction.is_some() && violations[before..].iter().all(|v| v.limit == ViolatedLimit::StatedValue(StatedValue::Direction))
}
