//! The feasible take-off set of one hop over a mesh, limit by limit.

use std::fmt;

use super::{BlockedSpan, MeshContact, MeshCourse, MeshGround, blocked::BlockedLofts};
use crate::{
    ballistics::{Arc, TakeoffChoice},
    chain::GroundRefusal,
    hop::{Binding, Conflict, LimitInterval, SetWindow, commanded_windows, envelope_limits, joint},
    quantity::{Angle, AngleInterval, FacetId, SlopeInterval},
    world::{Contact, Limit},
};

/// The limit that sets an end of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshWindowEnd {
    /// Which.
    pub limit: Limit,
    /// For the terrain: the facet that the arc of this end grazes.
    pub facet: Option<FacetId>,
}

/// One window of feasible arcs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshWindow {
    /// Its lofts.
    pub lofts: SlopeInterval,
    /// What sets its lower end.
    pub lower: MeshWindowEnd,
    /// What sets its upper end.
    pub upper: MeshWindowEnd,
}

/// Why no arc joins two contacts of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "one value per explained pair, which is not kept in lists")]
pub enum MeshConflict {
    /// Limits other than the terrain between the contacts.
    Limits(Conflict),
    /// The terrain blocks what the others leave.
    Terrain {
        /// The take-off angles that the other limits leave.
        left: AngleInterval,
        /// What blocks them.
        blocked: BlockedSpan,
        /// By how many degrees the nearest free angle is away from what the others leave; `None` where no angle is free.
        gap_deg: Option<f64>,
    },
}

impl MeshConflict {
    /// The limit under which the pair of contacts is counted as refused.
    pub const fn counted_under(&self) -> Limit {
        match self {
            Self::Limits(conflict) => conflict.counted_under(),
            Self::Terrain { .. } => Limit::Terrain,
        }
    }
}

/// The feasible take-off set of one pair of contacts of a mesh, limit by limit.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshTakeoffSet {
    course: MeshCourse,
    limits: Vec<LimitInterval>,
    blocked: Vec<BlockedSpan>,
    windows: Vec<MeshWindow>,
    conflict: Option<MeshConflict>,
    refused_by: [Option<FacetId>; 2],
}

impl MeshGround {
    /// The feasible take-off set of a hop with each limit by itself; `None` for a vertical hop.
    pub fn takeoff_set(&self, takeoff: &MeshContact, landing: &MeshContact) -> Option<MeshTakeoffSet> {
        let course = self.course(takeoff, landing)?;
        let (heading, sight) = (course.plane.heading, course.sight);
        let rules = [self.allowed(takeoff, heading, Contact::Takeoff), self.allowed(landing, heading, Contact::Landing)];
        let refused_by = rules.map(|rule| rule.err().map(|(_, facet)| facet));
        let [from, to] = rules.map(|rule| rule.map_err(|(refusal, _): (GroundRefusal, _)| refusal));
        let limits = envelope_limits(self.envelope(), sight, from, to);
        let mut blocked = BlockedLofts::default();
        // Without an end of what is looked for, the cut goes on to the last facet.
        let all = SlopeInterval { lower: 0.0, upper: f64::INFINITY };
        self.block(&course, [takeoff, landing], all, &mut blocked);
        Some(MeshTakeoffSet { refused_by, ..self.set_of(course, limits, &blocked) })
    }

    /// The set of a hop by its limits and what the ground blocks.
    pub(in crate::ground) fn set_of(
        &self,
        course: MeshCourse,
        limits: Vec<LimitInterval>,
        blocked: &BlockedLofts,
    ) -> MeshTakeoffSet {
        let (windows, conflict) = self.evaluate(&course, &limits, blocked);
        MeshTakeoffSet { course, limits, blocked: blocked.spans().to_vec(), windows, conflict, refused_by: [None; 2] }
    }

    /// The windows that all limits leave, or the conflict that leaves none.
    fn evaluate(
        &self,
        course: &MeshCourse,
        limits: &[LimitInterval],
        blocked: &BlockedLofts,
    ) -> (Vec<MeshWindow>, Option<MeshConflict>) {
        let sight = course.sight;
        let (lofts, binding) = match joint(sight, limits) {
            Ok(joint) => joint,
            Err(conflict) => return (Vec::new(), Some(MeshConflict::Limits(conflict))),
        };
        let within = SlopeInterval { lower: lofts.lower.max(0.0), upper: lofts.upper };
        let parts: Vec<_> = blocked.free_in(within).collect();
        let windows: Vec<MeshWindow> = parts
            .iter()
            .flat_map(|part| {
                let found = commanded_windows(self.envelope(), sight, part.lofts, binding, limits);
                found.map(|window| MeshWindow::new(&window, [part.lower, part.upper], part.lofts))
            })
            .collect();
        let command = limits.iter().find(|limit| Some(limit.limit) == self.envelope().takeoff_speeds().limit());
        let conflict = match (windows.is_empty(), parts.first(), command) {
            (false, ..) => None,
            (true, Some(part), Some(command)) => {
                Some(MeshConflict::Limits(Conflict::of_commands(self.envelope(), sight, part.lofts, binding, *command)))
            }
            (true, ..) => {
                blocked.spans().iter().find(|span| span.lofts.lower <= within.lower && within.upper <= span.lofts.upper).map(
                    |span| {
                        let angle = |loft: f64| Angle::from_slope(sight.slope() + loft).degrees();
                        let below = (span.lofts.lower > 0.0).then(|| angle(within.lower) - angle(span.lofts.lower));
                        let above = span.lofts.upper.is_finite().then(|| angle(span.lofts.upper) - angle(within.upper));
                        let gap_deg = below.into_iter().chain(above).min_by(f64::total_cmp);
                        let [min, max] = [within.lower, within.upper].map(|loft| Angle::from_slope(sight.slope() + loft));
                        MeshConflict::Terrain { left: AngleInterval { min, max }, blocked: *span, gap_deg }
                    },
                )
            }
        };
        (windows, conflict)
    }
}

impl MeshWindow {
    /// A window of a free part, whose ends are those of the part unless the machine's speeds set them.
    fn new(window: &SetWindow, facets: [Option<FacetId>; 2], part: SlopeInterval) -> Self {
        let Binding { lower, upper } = window.binding;
        let end = |limit: Limit, facet: Option<FacetId>, is_of_part: bool| match facet.filter(|_| is_of_part) {
            Some(facet) => MeshWindowEnd { limit: Limit::Terrain, facet: Some(facet) },
            None => MeshWindowEnd { limit, facet: None },
        };
        let is_command = |limit| matches!(limit, Limit::TakeoffSpeedMin | Limit::TakeoffSpeedLevels);
        Self {
            lofts: window.lofts,
            lower: end(lower.limit, facets[0], window.lofts.lower == part.lower && !is_command(lower.limit)),
            upper: end(upper.limit, facets[1], window.lofts.upper == part.upper && !is_command(upper.limit)),
        }
    }
}

impl MeshTakeoffSet {
    /// The same with windows that further limits narrow: `pushable` gives what they leave of one, with the limits beyond the ends that moved, or
    /// the limit that leaves nothing.
    pub(in crate::ground) fn narrowed(
        mut self,
        pushable: impl Fn(SlopeInterval) -> Result<(SlopeInterval, [Option<Limit>; 2]), Limit>,
    ) -> Self {
        let (mut kept, mut refused) = (Vec::new(), None);
        for window in &self.windows {
            match pushable(window.lofts) {
                Ok((lofts, by)) => {
                    let end =
                        |known: MeshWindowEnd, by: Option<Limit>| by.map_or(known, |limit| MeshWindowEnd { limit, facet: None });
                    kept.push(MeshWindow { lofts, lower: end(window.lower, by[0]), upper: end(window.upper, by[1]) });
                }
                Err(limit) => refused = refused.or(Some(limit)),
            }
        }
        self.windows = kept;
        if let Some(limit) = refused.filter(|_| self.windows.is_empty()) {
            let nothing = LimitInterval::new(limit, SlopeInterval::EMPTY, None);
            self.conflict = Some(MeshConflict::Limits(Conflict::Alone(nothing)));
        }
        self
    }

    /// The course of the hop.
    pub const fn course(&self) -> &MeshCourse {
        &self.course
    }

    /// Every limit but the terrain between the contacts, by itself.
    pub fn limits(&self) -> &[LimitInterval] {
        &self.limits
    }

    /// The lofts that facets between the contacts block, ascending and disjoint, whatever the other limits allow.
    pub fn blocked(&self) -> &[BlockedSpan] {
        &self.blocked
    }

    /// The windows, ascending; empty if the hop is infeasible.
    pub fn windows(&self) -> &[MeshWindow] {
        &self.windows
    }

    /// Why no window is left; `None` if one is.
    pub const fn conflict(&self) -> Option<MeshConflict> {
        self.conflict
    }

    /// The facets that refuse take-off and landing, where they do.
    pub const fn refused_by(&self) -> [Option<FacetId>; 2] {
        self.refused_by
    }

    /// Lofts as take-off angles; `None` for an empty interval.
    pub fn angles_of(&self, lofts: SlopeInterval) -> Option<AngleInterval> {
        lofts.shifted(self.course.sight.slope()).angles()
    }

    /// The window and the arc to fly by a choice, as [`TakeoffChoice::among`] has it; `None` if the hop is infeasible.
    pub fn arc(&self, choice: TakeoffChoice, gravity_m_s2: f64) -> Option<(MeshWindow, Arc)> {
        let sight = self.course.sight;
        let (at, loft) = choice.among(sight, self.windows.iter().map(|window| window.lofts))?;
        Some((self.windows[at], Arc::new(sight, loft, gravity_m_s2)))
    }

    /// The window with a loft, or else the one nearest to it; `None` if the hop is infeasible.
    pub fn window_of(&self, loft: f64) -> Option<MeshWindow> {
        let outside = |window: &MeshWindow| (window.lofts.lower - loft).max(loft - window.lofts.upper).max(0.0);
        self.windows.iter().min_by(|a, b| outside(a).total_cmp(&outside(b))).copied()
    }
}

impl fmt::Display for MeshConflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Limits(conflict) => conflict.fmt(f),
            Self::Terrain { left, blocked, gap_deg } => {
                let (lower, upper) = (blocked.lower.index() + 1, blocked.upper.index() + 1);
                write!(
                    f,
                    "the terrain blocks all take-off angles that the other limits leave, {:.6} to {:.6} deg: ",
                    left.min.degrees(),
                    left.max.degrees()
                )?;
                match gap_deg {
                    Some(gap_deg) => write!(
                        f,
                        "the nearest free angle is {gap_deg:.6} deg away (facets {lower} and {upper} bound what is blocked)"
                    ),
                    None => write!(f, "no take-off angle is free, from facet {lower} to facet {upper}"),
                }
            }
        }
    }
}
