//! The feasible take-off set of one pair of stations, with each limit evaluated separately.

use super::{Conflict, HopTest, Shortfall, TerrainPoint, terrain_limit};
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice, TakeoffSpeeds, least_landing_speed_m_s, least_takeoff_speed_m_s, limits},
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
    /// The lofts between the ends of `lofts` that it refuses, if it does: those of arcs slower than a least take-off speed.
    pub gap: Option<SlopeInterval>,
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
    speeds: TakeoffSpeeds,
    verdict: Verdict,
}

/// One window of a feasible set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetWindow {
    /// Its lofts.
    pub lofts: SlopeInterval,
    /// The limits that set its ends.
    pub binding: Binding,
}

/// The combined result of all limits.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "one value per explained pair, which is not kept in lists")]
enum Verdict {
    /// The interval that all limits but the machine's take-off speeds leave, and the windows of it.
    Feasible(SlopeInterval, Vec<SetWindow>),
    Refused(Conflict),
}

impl TakeoffSet {
    /// Evaluates each limit of a pair; `None` if both stations have the same x.
    pub(super) fn of(test: &HopTest, takeoff: &Station, landing: &Station) -> Option<Self> {
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
        let sight = test.line_of_sight(takeoff, landing)?;
        let limits = all_limits(test, takeoff, landing, direction, sight);
        let verdict = evaluate(test, sight, &limits);
        Some(Self { direction, sight, limits, speeds: *test.takeoff_speeds(), verdict })
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

    /// As [`HopTest::lofts`]: the lofts that all limits but the machine's take-off speeds allow; `None` if the hop is infeasible.
    pub fn lofts(&self) -> Option<SlopeInterval> {
        match self.verdict {
            Verdict::Feasible(lofts, _) => Some(lofts),
            Verdict::Refused(_) => None,
        }
    }

    /// The windows of the feasible set, ascending; empty if the hop is infeasible.
    pub fn windows(&self) -> &[SetWindow] {
        match &self.verdict {
            Verdict::Feasible(_, windows) => windows,
            Verdict::Refused(_) => &[],
        }
    }

    /// The limits that set the least and the greatest angle of the feasible set; `None` if it is empty.
    pub fn binding(&self) -> Option<Binding> {
        let (first, last) = (self.windows().first()?, self.windows().last()?);
        Some(Binding { lower: first.binding.lower, upper: last.binding.upper })
    }

    /// From the least to the greatest feasible take-off angle, whatever lies between them; `None` if the hop is infeasible.
    pub fn angles(&self) -> Option<AngleInterval> {
        let (first, last) = (self.windows().first()?, self.windows().last()?);
        self.angles_of(SlopeInterval { lower: first.lofts.lower, upper: last.lofts.upper })
    }

    /// The window with a loft, or else the one nearest to it; `None` if the hop is infeasible.
    pub fn window_of(&self, loft: f64) -> Option<SetWindow> {
        let outside = |window: &SetWindow| (window.lofts.lower - loft).max(loft - window.lofts.upper).max(0.0);
        self.windows().iter().min_by(|a, b| outside(a).total_cmp(&outside(b))).copied()
    }

    /// Why the set is empty; `None` if it is not.
    pub fn conflict(&self) -> Option<Conflict> {
        match self.verdict {
            Verdict::Feasible(..) => None,
            Verdict::Refused(conflict) => Some(conflict),
        }
    }

    /// Lofts as take-off angles; `None` for an empty interval.
    pub fn angles_of(&self, lofts: SlopeInterval) -> Option<AngleInterval> {
        lofts.shifted(self.sight.slope()).angles()
    }

    /// The arc selected by `choice`; `None` if the hop is infeasible.
    pub fn arc(&self, choice: TakeoffChoice, gravity_m_s2: f64) -> Option<Arc> {
        let loft = self.speeds.loft(choice, self.sight, self.lofts()?, gravity_m_s2)?;
        Some(Arc::new(self.sight, loft, gravity_m_s2))
    }
}

/// The line of sight as a limit: open at its lower end, since an arc always has a positive loft.
const ABOVE_SIGHT: LimitInterval = LimitInterval {
    limit: Limit::LineOfSight,
    lofts: SlopeInterval { lower: 0.0, upper: f64::INFINITY },
    vertex: None,
    kink_x_m: None,
    gap: None,
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
    let mut add =
        |limit, lofts, vertex, shortfall| found.push(LimitInterval { limit, lofts, vertex, kink_x_m: None, gap: None, shortfall });
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
    found.extend(commands(test, sight));
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
    LimitInterval { limit: Limit::Terrain, lofts, vertex, kink_x_m, gap: None, shortfall: None }
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

/// The take-off speeds that the machine can be commanded, if they are a limit.
fn commands(test: &HopTest, sight: LineOfSight) -> Option<LimitInterval> {
    let (g, speeds) = (test.gravity_m_s2(), test.takeoff_speeds());
    let limit = speeds.limit()?;
    let (mut lofts, mut gap, mut shortfall) = (SlopeInterval::ALL, None, None);
    match speeds {
        TakeoffSpeeds::Any => return None,
        TakeoffSpeeds::AtLeast(least_m_s) => gap = limits::takeoff_speed_min(sight, *least_m_s, g),
        TakeoffSpeeds::Levels(levels) => {
            // From the flattest to the steepest arc of all levels.
            let hull = |all: SlopeInterval, one: SlopeInterval| SlopeInterval {
                lower: all.lower.min(one.lower),
                upper: all.upper.max(one.upper),
            };
            lofts = speeds.windows(sight, SlopeInterval::ALL, g).map(|window| window.lofts).fold(SlopeInterval::EMPTY, hull);
            let needed_m_s = least_takeoff_speed_m_s(sight, g);
            shortfall = lofts.is_empty().then(|| Shortfall::Speed { needed_m_s, limit_m_s: levels.highest_m_s() });
        }
    }
    Some(LimitInterval { limit, lofts, vertex: None, kink_x_m: None, gap, shortfall })
}

/// The intersection of all limits with those that set its ends, or the conflict that leaves it empty.
fn evaluate(test: &HopTest, sight: LineOfSight, limits: &[LimitInterval]) -> Verdict {
    if let Some(alone) = limits.iter().find(|limit| limit.lofts.is_empty()) {
        return Verdict::Refused(Conflict::Alone(*alone));
    }
    let mut binding = Binding { lower: ABOVE_SIGHT, upper: ABOVE_SIGHT };
    let commanded = test.takeoff_speeds().limit();
    for &limit in limits.iter().filter(|limit| Some(limit.limit) != commanded) {
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
    // The machine's take-off speeds are the last of the limits: they cut the interval of the others.
    let command = limits.iter().find(|limit| Some(limit.limit) == commanded).copied();
    let end = |by: Option<Limit>, otherwise| command.filter(|command| by == Some(command.limit)).unwrap_or(otherwise);
    let windows: Vec<_> = test
        .windows(sight, lofts)
        .map(|window| SetWindow {
            lofts: window.lofts,
            binding: Binding { lower: end(window.lower, binding.lower), upper: end(window.upper, binding.upper) },
        })
        .collect();
    match command {
        Some(command) if windows.is_empty() => Verdict::Refused(Conflict::of_commands(test, sight, lofts, binding, command)),
        _ => Verdict::Feasible(lofts, windows),
    }
}
