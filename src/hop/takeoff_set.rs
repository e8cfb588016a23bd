//! The feasible take-off set of one pair of stations, with each limit evaluated separately.

use super::{Conflict, HopTest, Shortfall, TerrainPoint, terrain_limit};
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice, least_landing_speed_m_s, least_takeoff_speed_m_s, limits},
    chain::{ContactRule, Station},
    quantity::{Angle, AngleInterval, SlopeInterval, VertexId},
    world::{Contact, Direction, Limit},
};

/// One limit of a hop, evaluated by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitInterval {
    /// Which limit.
    pub limit: Limit,
    /// The lofts that it allows; empty if it refuses every arc.
    pub lofts: SlopeInterval,
    /// For the terrain: the vertex that sets the limit, unless a kink of the clearance between vertices does.
    pub vertex: Option<VertexId>,
    /// For the terrain: the x of the kink of the clearance that sets the limit, m along the chain.
    pub kink_x_m: Option<f64>,
    /// By how much it refuses every arc, if it does.
    pub shortfall: Option<Shortfall>,
}

/// The limits that set the two ends of a feasible set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Binding {
    /// The limit that sets the least take-off angle.
    pub lower: LimitInterval,
    /// The limit that sets the greatest take-off angle.
    pub upper: LimitInterval,
}

/// The feasible take-off set Theta of one pair (P eq. 21), limit by limit.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeoffSet {
    direction: Direction,
    sight: LineOfSight,
    limits: Vec<LimitInterval>,
    verdict: Verdict,
}

/// The combined result of all limits.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Feasible(SlopeInterval, Binding),
    Refused(Conflict),
}

impl TakeoffSet {
    /// Evaluates each limit of a pair; `None` if both stations have the same x.
    pub(super) fn of(test: &HopTest, takeoff: &Station, landing: &Station) -> Option<Self> {
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
        let sight = test.line_of_sight(takeoff, landing)?;
        let limits = all_limits(test, takeoff, landing, direction, sight);
        let verdict = evaluate(sight, &limits);
        Some(Self { direction, sight, limits, verdict })
    }

    /// The direction of travel.
    pub const fn direction(&self) -> Direction {
        self.direction
    }

    /// The line of sight from take-off to landing.
    pub const fn line_of_sight(&self) -> LineOfSight {
        self.sight
    }

    /// Every limit that applies to the pair, by itself.
    pub fn limits(&self) -> &[LimitInterval] {
        &self.limits
    }

    /// The feasible lofts; `None` if the hop is infeasible.
    pub fn lofts(&self) -> Option<SlopeInterval> {
        match self.verdict {
            Verdict::Feasible(lofts, _) => Some(lofts),
            Verdict::Refused(_) => None,
        }
    }

    /// The limits that set the ends of the feasible set; `None` if it is empty.
    pub fn binding(&self) -> Option<Binding> {
        match self.verdict {
            Verdict::Feasible(_, binding) => Some(binding),
            Verdict::Refused(_) => None,
        }
    }

    /// Why the set is empty; `None` if it is not.
    pub fn conflict(&self) -> Option<Conflict> {
        match self.verdict {
            Verdict::Feasible(..) => None,
            Verdict::Refused(conflict) => Some(conflict),
        }
    }

    /// The feasible take-off angles; `None` if the hop is infeasible.
    pub fn angles(&self) -> Option<AngleInterval> {
        self.angles_of(self.lofts()?)
    }

    /// Lofts as take-off angles; `None` for an empty interval.
    pub fn angles_of(&self, lofts: SlopeInterval) -> Option<AngleInterval> {
        lofts.shifted(self.sight.slope()).angles()
    }

    /// The arc selected by `choice`; `None` if the hop is infeasible.
    pub fn arc(&self, choice: TakeoffChoice, gravity_m_s2: f64) -> Option<Arc> {
        Some(Arc::new(self.sight, choice.loft(self.sight, self.lofts()?), gravity_m_s2))
    }
}

/// The line of sight as a limit: open at its lower end, since an arc always has a positive loft.
const ABOVE_SIGHT: LimitInterval = LimitInterval {
    limit: Limit::LineOfSight,
    lofts: SlopeInterval { lower: 0.0, upper: f64::INFINITY },
    vertex: None,
    kink_x_m: None,
    shortfall: None,
};

/// Every limit that applies to a pair, in the order of [`Limit::ALL`].
fn all_limits(
    test: &HopTest,
    takeoff: &Station,
    landing: &Station,
    direction: Direction,
    sight: LineOfSight,
) -> Vec<LimitInterval> {
    let mut found = Vec::with_capacity(Limit::ALL.len());
    let mut add = |limit, lofts, vertex, shortfall| found.push(LimitInterval { limit, lofts, vertex, kink_x_m: None, shortfall });
    let mut allowed = |contact, station: &Station| -> Option<ContactRule> {
        match test.chain().check_contact(station, contact, direction) {
            Ok(rule) => Some(rule),
            Err(refusal) => {
                add(refusal.limit(contact), SlopeInterval::EMPTY, None, Some(Shortfall::Ground { contact, refusal }));
                None
            }
        }
    };
    let from = allowed(Contact::Takeoff, takeoff);
    let to = allowed(Contact::Landing, landing);
    if let Some(vertex) = test.chain().geometry().bend_between(takeoff.point.x_m, landing.point.x_m) {
        let x_m = test.chain().geometry().vertices()[vertex.index()].x_m;
        add(Limit::Bend, SlopeInterval::EMPTY, Some(vertex), Some(Shortfall::Bend { x_m }));
    }
    let gravity = test.gravity_m_s2();
    if let Some(rule) = from {
        add(Limit::TakeoffCone, limits::takeoff_cone(sight, rule.slopes()), None, None);
        let lofts = limits::takeoff_speed(sight, rule.speed_max_m_s(), gravity);
        let shortfall = lofts
            .is_empty()
            .then(|| Shortfall::Speed { needed_m_s: least_takeoff_speed_m_s(sight, gravity), limit_m_s: rule.speed_max_m_s() });
        add(Limit::TakeoffSpeed, lofts, None, shortfall);
    }
    if to.is_some() && test.hopper().limits().landing.brakes() {
        add(Limit::Touchdown, SlopeInterval::ALL, None, None);
    } else if let Some(rule) = to {
        add(Limit::LandingCone, limits::landing_cone(sight, rule.slopes()), None, None);
        let lofts = limits::landing_speed(sight, rule.speed_max_m_s(), gravity);
        let shortfall = lofts
            .is_empty()
            .then(|| Shortfall::Speed { needed_m_s: least_landing_speed_m_s(sight, gravity), limit_m_s: rule.speed_max_m_s() });
        add(Limit::LandingSpeed, lofts, None, shortfall);
    }
    add(Limit::LineOfSight, ABOVE_SIGHT.lofts, None, None);
    machine_limits(test, sight, &mut add);
    found.push(terrain(test, takeoff, landing, sight));
    found.sort_by_key(|limit| limit.limit);
    found
}

/// The terrain, with the vertex or the kink of the clearance that sets the limit.
fn terrain(test: &HopTest, takeoff: &Station, landing: &Station, sight: LineOfSight) -> LimitInterval {
    let (lofts, point) = terrain_limit(test.chain().geometry(), takeoff, landing, sight, test.clearance());
    let (vertex, kink_x_m) = match point {
        Some(TerrainPoint::Vertex(vertex)) => (Some(vertex), None),
        Some(TerrainPoint::Kink(x_m)) => (None, Some(x_m)),
        None => (None, None),
    };
    LimitInterval { limit: Limit::Terrain, lofts, vertex, kink_x_m, shortfall: None }
}

/// The limits of the machine that this hopper has.
fn machine_limits(
    test: &HopTest,
    sight: LineOfSight,
    add: &mut impl FnMut(Limit, SlopeInterval, Option<VertexId>, Option<Shortfall>),
) {
    let hopper = test.hopper();
    if hopper.limits().takeoff_angle_min.is_some() || hopper.limits().takeoff_angle_max.is_some() {
        add(Limit::MechanicalAngle, limits::takeoff_cone(sight, test.mechanism_slopes()), None, None);
    }
    if let Some(height_m) = hopper.limits().apex_height_max_m {
        let lofts = limits::apex_height(sight, height_m);
        let shortfall = lofts.is_empty().then(|| Shortfall::Height { needed_m: sight.rise_m(), limit_m: height_m });
        add(Limit::ApexHeight, lofts, None, shortfall);
    }
    if let Some(time_s) = hopper.limits().flight_time_max_s {
        add(Limit::FlightTime, limits::flight_time(sight, time_s, test.gravity_m_s2()), None, None);
    }
}

/// The intersection of all limits with those that set its ends, or the conflict that leaves it empty.
fn evaluate(sight: LineOfSight, limits: &[LimitInterval]) -> Verdict {
    if let Some(alone) = limits.iter().find(|limit| limit.lofts.is_empty()) {
        return Verdict::Refused(Conflict::Alone(*alone));
    }
    let mut binding = Binding { lower: ABOVE_SIGHT, upper: ABOVE_SIGHT };
    for &limit in limits {
        if limit.lofts.lower > binding.lower.lofts.lower {
            binding.lower = limit;
        }
        if limit.lofts.upper < binding.upper.lofts.upper {
            binding.upper = limit;
        }
    }
    let lofts = SlopeInterval { lower: binding.lower.lofts.lower, upper: binding.upper.lofts.upper };
    if lofts.is_empty() || lofts.upper <= 0.0 {
        let angle = |loft: f64| Angle::from_slope(sight.slope() + loft).degrees();
        return Verdict::Refused(Conflict::Pair {
            lower: binding.lower,
            upper: binding.upper,
            gap_deg: angle(lofts.lower) - angle(lofts.upper),
        });
    }
    Verdict::Feasible(lofts, binding)
}
