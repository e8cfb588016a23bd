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
    chain::{ConstrainedChain, Station},
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
pub fn execute(chain: &ConstrainedChain, path: &HopPath, ends: Option<(Station, Station)>) -> Execution {
    let height_rounding_m = flight::height_rounding_m(chain);
    let mut violations = Vec::new();
    let mut flights = Vec::with_capacity(path.hops.len());
    let mut place = ends.map(|(start, _)| start);
    for (i, hop) in path.hops.iter().enumerate() {
        if let Some(place) = place {
            continuous(i + 1, &place, &hop.takeoff, &mut violations);
        }
        place = Some(hop.landing);
        let Some(direction) = flyable(i + 1, hop, &mut violations) else {
            flights.push(None);
            continue;
        };
        let flown = Course::new(chain, hop, direction, height_rounding_m).fly();
        let mut checker = Checker { number: i + 1, chain, hop, direction, height_rounding_m, violations: &mut violations };
        match &flown {
            Some(flight) => checker.flight(flight),
            None => checker.no_flight(),
        }
        flights.push(flown);
    }
    if let (Some(place), Some((_, goal))) = (place, ends) {
        continuous(path.hops.len(), &place, &goal, &mut violations);
    }
    Execution { flights, violations }
}

/// One place must be the other, to the last digit: both are the same number of the plan.
fn continuous(hop: usize, is: &Station, should_be: &Station, violations: &mut Vec<Violation>) {
    if is != should_be {
        let (a, b) = (is.point, should_be.point);
        let found = libm::hypot(a.x_m - b.x_m, a.z_m - b.z_m);
        let measure = Some(Measure { found, allowed: 0.0, unit: "m" });
        violations.push(Violation { hop, limit: ViolatedLimit::Continuity, measure, at_x_m: b.x_m, vertex: None });
    }
}

/// The direction of a hop that can be flown: its numbers are numbers, its ends are two places, and it goes where it says.
fn flyable(number: usize, hop: &Hop, violations: &mut Vec<Violation>) -> Option<Direction> {
    let before = violations.len();
    let mut note = |value| {
        let limit = ViolatedLimit::StatedValue(value);
        violations.push(Violation { hop: number, limit, measure: None, at_x_m: hop.takeoff.point.x_m, vertex: None });
    };
    let numbers = [
        (StatedValue::TakeoffStation, hop.takeoff.point.x_m + hop.takeoff.point.z_m),
        (StatedValue::LandingStation, hop.landing.point.x_m + hop.landing.point.z_m),
        (StatedValue::TakeoffAngle, hop.takeoff_angle.radians()),
        (StatedValue::TakeoffSpeed, hop.takeoff_speed_m_s),
    ];
    for (value, number) in numbers {
        if !number.is_finite() {
            note(value);
        }
    }
    let direction = Direction::between(hop.takeoff.point.x_m, hop.landing.point.x_m);
    if direction != Some(hop.direction) {
        note(StatedValue::Direction);
    }
    // A wrong word for the direction keeps no hop from being flown; numbers that are none do.
    let flown = violations[before..].iter().all(|v| v.limit == ViolatedLimit::StatedValue(StatedValue::Direction));
    direction.filter(|_| flown)
}
