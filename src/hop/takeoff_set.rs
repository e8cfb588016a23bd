//! The feasible take-off set of one pair of stations, with each limit evaluated separately.

use super::{Conflict, HopTest, Shortfall, TerrainPoint, terrain_limit};
use crate::{
    ballistics::{
        Arc, ContactLimits, FlightEnvelope, LineOfSight, TakeoffChoice, TakeoffSpeeds, least_landing_speed_m_s,
        least_takeoff_speed_m_s, limits,
    },
    chain::{ContactRule, GroundRefusal, Station},
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

impl LimitInterval {
    /// A limit without a place on the terrain.
    pub(crate) const fn new(limit: Limit, lofts: SlopeInterval, shortfall: Option<Shortfall>) -> Self {
        Self { limit, lofts, vertex: None, kink_x_m: None, gap: None, shortfall }
    }
}

/// The line of sight as a limit: open at its lower end, since an arc always has a positive loft.
const ABOVE_SIGHT: LimitInterval = LimitInterval::new(Limit::LineOfSight, SlopeInterval { lower: 0.0, upper: f64::INFINITY }, None);

/// Every limit that applies to a pair, in the order of [`Limit::ALL`].
fn all_limits(
    test: &HopTest,
    takeoff: &Station,
    landing: &Station,
    direction: Direction,
    sight: LineOfSight,
) -> Vec<LimitInterval> {
    let rule =
        |station, contact| test.chain().check_contact(station, contact, direction).map(|rule: ContactRule| rule.contact_limits());
    let mut found = envelope_limits(test.envelope(), sight, rule(takeoff, Contact::Takeoff), rule(landing, Contact::Landing));
    if let Some(vertex) = test.chain().geometry().bend_between(takeoff.point.x_m, landing.point.x_m) {
        let x_m = test.chain().geometry().vertices()[vertex.index()].x_m;
        let bend = LimitInterval::new(Limit::Bend, SlopeInterval::EMPTY, Some(Shortfall::Bend { x_m }));
        found.push(LimitInterval { vertex: Some(vertex), ..bend });
    }
    if let Some(layer) = test.chain().geometry().layer_refusing_flight(takeoff.point.x_m, landing.point.x_m) {
        found.push(LimitInterval::new(Limit::Layer(layer), SlopeInterval::EMPTY, Some(Shortfall::Flight { layer })));
    }
    found.push(terrain(test, takeoff, landing, sight));
    found.sort_by_key(|limit| limit.limit);
    found
}

/// Every limit of a hop but those of the terrain between its contacts, in the order of [`Limit::ALL`].
///
/// `from`, `to`: what the ground allows at take-off and landing, or why it refuses them.
pub(crate) fn envelope_limits(
    envelope: &FlightEnvelope,
    sight: LineOfSight,
    from: Result<ContactLimits, GroundRefusal>,
    to: Result<ContactLimits, GroundRefusal>,
) -> Vec<LimitInterval> {
    let mut found = Vec::with_capacity(Limit::ALL.len());
    let mut add = |limit, lofts, shortfall| found.push(LimitInterval::new(limit, lofts, shortfall));
    for (contact, allowed) in [(Contact::Takeoff, from), (Contact::Landing, to)] {
        if let Err(refusal) = allowed {
            add(refusal.limit(contact), SlopeInterval::EMPTY, Some(Shortfall::Ground { contact, refusal }));
        }
    }
    let gravity = envelope.gravity_m_s2();
    if let Ok(rule) = from {
        add(Limit::TakeoffCone, limits::takeoff_cone(sight, rule.slopes), None);
        let lofts = limits::takeoff_speed(sight, rule.speed_max_m_s, gravity);
        let shortfall = lofts
            .is_empty()
            .then(|| Shortfall::Speed { needed_m_s: least_takeoff_speed_m_s(sight, gravity), limit_m_s: rule.speed_max_m_s });
        add(Limit::TakeoffSpeed, lofts, shortfall);
    }
    if to.is_ok() && envelope.hopper().limits().landing.brakes() {
        add(Limit::Touchdown, SlopeInterval::ALL, None);
    } else if let Ok(rule) = to {
        add(Limit::LandingCone, limits::landing_cone(sight, rule.slopes), None);
        let lofts = limits::landing_speed(sight, rule.speed_max_m_s, gravity);
        let shortfall = lofts
            .is_empty()
            .then(|| Shortfall::Speed { needed_m_s: least_landing_speed_m_s(sight, gravity), limit_m_s: rule.speed_max_m_s });
        add(Limit::LandingSpeed, lofts, shortfall);
    }
    add(Limit::LineOfSight, ABOVE_SIGHT.lofts, None);
    machine_limits(envelope, sight, &mut add);
    found.extend(commands(envelope, sight));
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
    LimitInterval { vertex, kink_x_m, ..LimitInterval::new(Limit::Terrain, lofts, None) }
}

/// The limits of the machine that this hopper has.
fn machine_limits(envelope: &FlightEnvelope, sight: LineOfSight, add: &mut impl FnMut(Limit, SlopeInterval, Option<Shortfall>)) {
    let hopper = envelope.hopper();
    if hopper.limits().takeoff_angle_min.is_some() || hopper.limits().takeoff_angle_max.is_some() {
        add(Limit::MechanicalAngle, limits::takeoff_cone(sight, envelope.mechanism_slopes()), None);
    }
    if let Some(height_m) = hopper.limits().apex_height_max_m {
        let lofts = limits::apex_height(sight, height_m);
        let shortfall = lofts.is_empty().then(|| Shortfall::Height { needed_m: sight.rise_m(), limit_m: height_m });
        add(Limit::ApexHeight, lofts, shortfall);
    }
    if let Some(time_s) = hopper.limits().flight_time_max_s {
        add(Limit::FlightTime, limits::flight_time(sight, time_s, envelope.gravity_m_s2()), None);
    }
}

/// The take-off speeds that the machine can be commanded, if they are a limit.
fn commands(envelope: &FlightEnvelope, sight: LineOfSight) -> Option<LimitInterval> {
    let (g, speeds) = (envelope.gravity_m_s2(), envelope.takeoff_speeds());
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
    Some(LimitInterval { gap, ..LimitInterval::new(limit, lofts, shortfall) })
}

/// The intersection of all limits but the machine's take-off speeds, and those that set its ends.
///
/// # Errors
/// The conflict that leaves it empty.
#[expect(clippy::result_large_err, reason = "one value per explained pair, which is not kept in lists")]
pub(crate) fn joint(sight: LineOfSight, limits: &[LimitInterval]) -> Result<(SlopeInterval, Binding), Conflict> {
    if let Some(alone) = limits.iter().find(|limit| limit.lofts.is_empty()) {
        return Err(Conflict::Alone(*alone));
    }
    let mut binding = Binding { lower: ABOVE_SIGHT, upper: ABOVE_SIGHT };
    let is_command = |limit| matches!(limit, Limit::TakeoffSpeedMin | Limit::TakeoffSpeedLevels);
    for &limit in limits.iter().filter(|limit| !is_command(limit.limit)) {
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
        let (lower, upper) = (binding.lower, binding.upper);
        return Err(Conflict::Pair { lower, upper, gap_deg: angle(lofts.lower) - angle(lofts.upper) });
    }
    Ok((lofts, binding))
}

/// The windows that the machine's take-off speeds leave of an interval with the limits that set its ends, ascending.
pub(crate) fn commanded_windows<'a>(
    envelope: &'a FlightEnvelope,
    sight: LineOfSight,
    lofts: SlopeInterval,
    binding: Binding,
    limits: &'a [LimitInterval],
) -> impl Iterator<Item = SetWindow> + 'a {
    let speeds = envelope.takeoff_speeds();
    let command = speeds.limit().and_then(|limit| limits.iter().find(|known| known.limit == limit).copied());
    let end = move |by: Option<Limit>, otherwise| command.filter(|command| by == Some(command.limit)).unwrap_or(otherwise);
    speeds.windows(sight, lofts, envelope.gravity_m_s2()).map(move |window| SetWindow {
        lofts: window.lofts,
        binding: Binding { lower: end(window.lower, binding.lower), upper: end(window.upper, binding.upper) },
    })
}

/// The windows of all limits, or the conflict that leaves none.
fn evaluate(test: &HopTest, sight: LineOfSight, limits: &[LimitInterval]) -> Verdict {
    let (lofts, binding) = match joint(sight, limits) {
        Ok(joint) => joint,
        Err(conflict) => return Verdict::Refused(conflict),
    };
    // The machine's take-off speeds are the last of the limits: they cut the interval of the others.
    let windows: Vec<_> = commanded_windows(test.envelope(), sight, lofts, binding, limits).collect();
    match limits.iter().find(|limit| Some(limit.limit) == test.takeoff_speeds().limit()) {
        Some(command) if windows.is_empty() => {
            Verdict::Refused(Conflict::of_commands(test.envelope(), sight, lofts, binding, *command))
        }
        _ => Verdict::Feasible(lofts, windows),
    }
}
