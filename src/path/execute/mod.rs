//! The independent checker of a planned path: it flies every hop again and holds it against every limit.
//!
//! This is the one allowed second statement of the physics. It knows nothing of lofts, lines of sight or quadratics: it takes the
//! command of a hop (place, angle, speed), steps Newton's equations from there and looks at what happens. It imports nothing from the
//! closed forms of `ballistics` nor from the graph, and a test reads these files to see that it stays so.

mod checker;
mod flight;
mod violation;

use checker::Checker;
use flight::Course;
pub use flight::{Clearance, Flight};
pub use violation::{Measure, StatedValue, ViolatedLimit, Violation};

use super::{Hop, HopPath};
use crate::{
    ground::{ContactPoint, Surface},
    world::Direction,
};

/// What came of flying a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Execution {
    /// What was flown of each hop; `None` where a hop could not be flown at all.
    pub flights: Vec<Option<Flight>>,
    /// Everything that is wrong, hop by hop; empty where the path holds.
    pub violations: Vec<Violation>,
}

impl Execution {
    /// Whether nothing is wrong.
    pub const fn passes(&self) -> bool {
        self.violations.is_empty()
    }
}

/// Flies a planned path by Newton's equations and reports everything that is wrong with it.
///
/// ```text
///     x += v_x dt,   z += v_z dt - g dt^2 / 2,   v_z -= g dt            (constant acceleration: exact for any dt)
/// ```
///
/// Checks of each hop: that it begins where the one before landed; the ground's refusals (direction, keep-out, rest slope),
/// directions and speeds at both ends; the machine's angles, height and time; the clearance over every vertex flown past and the
/// ground between them; where it really comes down; and the numbers that the plan states. Every violation is reported.
///
/// Speeds hold as everywhere with [`tolerant_speed_m_s`](crate::world::tolerant_speed_m_s). The checker's own tolerances are a
/// nanoradian for directions, 1e-12 of a flight's size for places (with the rounding of the chain's heights), and what such an
/// uncertain place does to direction, speed and time at the landing.
///
/// # Arguments
/// `gravity_m_s2`: above 0; `ends`: the start and goal that the path should join, where they are to be checked.
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
/// let answer = search(&test, start, goal, &SearchOptions::default(), &mut |_| {}).unwrap();
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
pub fn execute<S: Surface>(surface: &S, path: &HopPath, ends: Option<(S::Contact, S::Contact)>) -> Execution {
    let mut violations = Vec::new();
    let mut flights = Vec::with_capacity(path.hops.len());
    let ends = ends.map(|(start, goal)| (surface.contact_point(&start), surface.contact_point(&goal)));
    let mut before: Option<ContactPoint> = None;
    for (i, hop) in path.hops.iter().enumerate() {
        match (before, ends) {
            (Some(before), _) => continuous(i + 1, (&before, &hop.takeoff), before == hop.takeoff, &mut violations),
            (None, Some((start, _))) => joins(i + 1, (&start, &hop.takeoff), &mut violations),
            (None, None) => {}
        }
        before = Some(hop.landing);
        let Some(direction) = flyable(i + 1, hop, &mut violations) else {
            flights.push(None);
            continue;
        };
        flights.push(checked(surface, i + 1, hop, direction, &mut violations));
    }
    match (before, ends) {
        (Some(before), Some((_, goal))) => joins(path.hops.len(), (&before, &goal), &mut violations),
        (None, Some((start, goal))) => joins(0, (&start, &goal), &mut violations),
        (_, None) => {}
    }
    Execution { flights, violations }
}

/// Flies one hop over the surface and holds it against every limit.
fn checked<S: Surface>(
    surface: &S,
    number: usize,
    hop: &Hop,
    direction: Direction,
    violations: &mut Vec<Violation>,
) -> Option<Flight> {
    let contacts = [&hop.takeoff, &hop.landing].map(|stated| surface.contact_at(stated));
    let course = match contacts {
        [Some(from), Some(to)] => surface.course(&from, &to).map(|(run_m, heading)| Course { surface, hop, from, run_m, heading }),
        _ => None,
    };
    let heading = course.as_ref().map(|course| course.heading);
    let flown = course.as_ref().and_then(Course::fly);
    let run_m = course.map(|course| course.run_m);
    let mut checker = Checker { number, surface, contacts, hop, direction, heading, run_m, violations };
    match &flown {
        Some(flight) => checker.flight(flight),
        None => checker.no_flight(),
    }
    flown
}

/// A path must begin at its start and end at its goal: the same points to the last digit, at any distance along the path.
fn joins(hop: usize, ends: (&ContactPoint, &ContactPoint), violations: &mut Vec<Violation>) {
    let (a, b) = ends;
    continuous(hop, ends, (a.point_m, a.frame, a.station) == (b.point_m, b.frame, b.station), violations);
}

/// A hop must begin where the one before landed, to the last digit: both are the same numbers of the plan.
fn continuous(hop: usize, (is, should_be): (&ContactPoint, &ContactPoint), same: bool, violations: &mut Vec<Violation>) {
    if !same {
        let found = (is.point_m - should_be.point_m).norm();
        let measure = Some(Measure { found, allowed: 0.0, unit: "m" });
        violations.push(Violation { hop, limit: ViolatedLimit::Continuity, measure, at_x_m: should_be.along_m, vertex: None });
    }
}

/// The direction of a hop that can be flown: its numbers are numbers, its ends are two places, and it goes where it says.
fn flyable(number: usize, hop: &Hop, violations: &mut Vec<Violation>) -> Option<Direction> {
    let before = violations.len();
    let mut note = |value| {
        let limit = ViolatedLimit::StatedValue(value);
        violations.push(Violation { hop: number, limit, measure: None, at_x_m: hop.takeoff.along_m, vertex: None });
    };
    // Finite only where every coordinate is.
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
    // A wrong word for the direction keeps no hop from being flown; numbers that are none do.
    let flown = violations[before..].iter().all(|v| v.limit == ViolatedLimit::StatedValue(StatedValue::Direction));
    direction.filter(|_| flown)
}
