//! A roadmap that grows until its best path stops gaining.

use std::time::{Duration, Instant};

use nalgebra::Point3;

use super::{DrawnContacts, Roadmap, RoadmapGround, RoadmapQuestion, RoadmapRoute, RoadmapSampler};
use crate::{
    ground::MeshContact,
    planner::{Amounts, LeastAmounts},
    progress::{Cancelled, Progress},
};

/// When a roadmap stops growing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoadmapLimits {
    /// The most contacts, start and goal included.
    pub contacts_max: usize,
    /// The longest time for it, judged before every round but the first; `None`: as long as it takes, and then the same roadmap whatever
    /// the machine.
    pub time_max: Option<Duration>,
}

/// Why a roadmap stopped growing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoadmapEnd {
    /// It has the most contacts.
    Contacts,
    /// Another round would take too long.
    Time,
    /// The best path is within the budgets and gained less than [`GAIN_MIN`] in the last two rounds about it.
    Gain,
    /// No more contacts were found that could be of use.
    Exhausted,
    /// It was read: only start and goal were added.
    Given,
    /// Its start leads to its goal, which is all that one that grows contact by contact waits for.
    Joined,
}

impl RoadmapEnd {
    /// All reasons.
    pub const ALL: [Self; 6] = [Self::Contacts, Self::Time, Self::Gain, Self::Exhausted, Self::Joined, Self::Given];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Contacts => "contacts",
            Self::Time => "time",
            Self::Gain => "gain",
            Self::Exhausted => "exhausted",
            Self::Given => "given",
            Self::Joined => "joined",
        }
    }
}

crate::quantity::by_name!(RoadmapEnd, RoadmapEnd::ALL);

/// The share of the objective that two rounds about the best path gain at least, if another one is to follow.
pub const GAIN_MIN: f64 = 0.01;

/// The contacts of the first round: some problems need no more, and they take milliseconds.
const FIRST: usize = 256;

/// The fewest contacts that a round adds, unless the most of all are fewer.
const ROUND_LEAST: usize = 16;

/// One round of a roadmap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoadmapRound {
    /// Contacts so far.
    pub contacts: usize,
    /// Windows so far.
    pub windows: usize,
    /// What the best path takes so far; `None` before a path is found.
    pub totals: Option<Amounts>,
}

/// A roadmap that stopped growing, and its best path.
#[derive(Clone, Debug)]
pub struct GrownRoadmap<N = MeshContact> {
    /// The roadmap. Contact 0 is the start, contact 1 the goal.
    pub roadmap: Roadmap<N>,
    /// The numbers of start and goal: both 0 where they are one point.
    pub ends: (usize, usize),
    /// The best path.
    pub route: RoadmapRoute,
    /// Its rounds.
    pub history: Vec<RoadmapRound>,
    /// Why it stopped.
    pub end: RoadmapEnd,
    /// The contacts that were drawn and left out.
    pub drawn: DrawnContacts,
}

/// Grows a roadmap between two contacts: all over the mesh until a path is found, on to half of the contacts, and from then on half of each
/// round about the best path. Once there is a path, contacts are left out through which no better one leads, by lower bounds along straight
/// lines.
///
/// # Errors
/// [`Cancelled`].
pub fn grow_roadmap<G: RoadmapGround>(
    ground: &G,
    ends: [G::Node; 2],
    sampler: &mut dyn RoadmapSampler<G::Node>,
    question: &RoadmapQuestion<'_>,
    limits: RoadmapLimits,
    progress: &dyn Progress,
) -> Result<GrownRoadmap<G::Node>, Cancelled> {
    let began = limits.time_max.map(|most| (Instant::now(), most));
    let points = [ground.point_m(&ends[0]), ground.point_m(&ends[1])];
    let mut grown = over_roadmap(ground, Roadmap::new(), ends, question, progress)?;
    let numbers = grown.ends;
    let is_there = numbers.0 == numbers.1;
    let gains = Gains { least: (ground.walk_neighbours() == 0).then(|| ground.least_amounts()), points };
    let (mut weak_rounds, mut rounds) = (0, 0_u32);
    grown.end = loop {
        if is_there {
            break RoadmapEnd::Exhausted;
        }
        let count = grown.roadmap.contact_count();
        let refines = grown.route.path.is_some() && count >= limits.contacts_max / 2;
        let wanted = match (&grown.route.path, refines) {
            (_, true) => count + (count / 4).max(ROUND_LEAST),
            (None, false) => (2 * count).max(FIRST.min(limits.contacts_max / 2)),
            (Some(_), false) => (2 * count).min(limits.contacts_max / 2),
        };
        let wanted = wanted.min(limits.contacts_max);
        if wanted <= count {
            break RoadmapEnd::Contacts;
        }
        let Some(wanted) = in_time(began, (grown.roadmap.contact_count(), grown.roadmap.pairs_tested()), wanted) else {
            break RoadmapEnd::Time;
        };
        let before = grown.route.clone();
        let is_useful = |point: &Point3<f64>| gains.are_possible(point, &before, question);
        let added = wanted - count;
        let mut contacts = Vec::with_capacity(added);
        if let Some(path) = before.path.as_ref().filter(|_| refines) {
            let about: Vec<_> = path.contacts.iter().map(|node| ground.point_m(grown.roadmap.contact(*node))).collect();
            // Wide for another way, narrow for the same one.
            let share = if rounds.is_multiple_of(2) { 0.3 } else { 0.08 };
            contacts = sampler.about(&about, share * mean_length_m(&about), added / 2, &is_useful);
            rounds += 1;
        }
        contacts.extend(sampler.all_over(added - contacts.len(), &is_useful));
        if contacts.is_empty() {
            break RoadmapEnd::Exhausted;
        }
        grown.roadmap.extend(ground, contacts, progress)?;
        let route = grown.roadmap.route(ground, numbers, question)?;
        let gain = gain(&before, &route, question);
        grown.route = route;
        grown.record();
        weak_rounds = if refines && gain < GAIN_MIN { weak_rounds + 1 } else { 0 };
        // A path that exceeds a budget is no end: other contacts may have one within it.
        if weak_rounds == 2 && grown.route.within {
            break RoadmapEnd::Gain;
        }
    };
    grown.drawn = sampler.drawn();
    Ok(grown)
}

/// The nodes that a roadmap grows by between two looks whether its start leads to its goal.
const JOIN_STEP: usize = 4;

/// Grows a roadmap from its start and goal until one leads to the other, by a few nodes at a time, as the planners of Campana and others do;
/// with the exact windows of every hop. The answer is the best path of that roadmap.
///
/// # Errors
/// [`Cancelled`].
pub fn grow_until_joined<G: RoadmapGround>(
    ground: &G,
    ends: [G::Node; 2],
    sampler: &mut dyn RoadmapSampler<G::Node>,
    question: &RoadmapQuestion<'_>,
    limits: RoadmapLimits,
    progress: &dyn Progress,
) -> Result<GrownRoadmap<G::Node>, Cancelled> {
    let began = Instant::now();
    let mut grown = over_roadmap(ground, Roadmap::new(), ends, question, progress)?;
    grown.end = loop {
        if grown.route.path.is_some() {
            break RoadmapEnd::Joined;
        }
        let room = limits.contacts_max.saturating_sub(grown.roadmap.contact_count());
        if room == 0 {
            break RoadmapEnd::Contacts;
        }
        if limits.time_max.is_some_and(|most| began.elapsed() >= most) {
            break RoadmapEnd::Time;
        }
        let nodes = sampler.all_over(JOIN_STEP.min(room), &|_| true);
        if nodes.is_empty() {
            break RoadmapEnd::Exhausted;
        }
        grown.roadmap.extend(ground, nodes, progress)?;
        grown.route = grown.roadmap.route(ground, grown.ends, question)?;
    };
    grown.record();
    grown.drawn = sampler.drawn();
    Ok(grown)
}

/// The best path between two contacts over a roadmap that is known: both join it, and no other contact does.
///
/// # Errors
/// [`Cancelled`].
///
/// # Complexity
/// Every hop between the two and a contact of the roadmap is tested, and none between two of its own.
pub fn over_roadmap<G: RoadmapGround>(
    ground: &G,
    mut roadmap: Roadmap<G::Node>,
    ends: [G::Node; 2],
    question: &RoadmapQuestion<'_>,
    progress: &dyn Progress,
) -> Result<GrownRoadmap<G::Node>, Cancelled> {
    let numbers = numbered(ground, &ends, roadmap.contact_count());
    roadmap.extend(ground, ends.into(), progress)?;
    let route = roadmap.route(ground, numbers, question)?;
    let mut grown = GrownRoadmap {
        roadmap,
        ends: numbers,
        route,
        history: Vec::new(),
        end: RoadmapEnd::Given,
        drawn: DrawnContacts::default(),
    };
    grown.record();
    Ok(grown)
}

/// The numbers of start and goal where they are the next contacts of a roadmap: the same one where they are one place.
pub(super) fn numbered<G: RoadmapGround>(ground: &G, [start, goal]: &[G::Node; 2], first: usize) -> (usize, usize) {
    (first, first + usize::from(!ground.are_one_place([start, goal])))
}

impl<N: Clone + Send + Sync> GrownRoadmap<N> {
    pub(super) fn record(&mut self) {
        self.history.push(RoadmapRound {
            contacts: self.roadmap.contact_count(),
            windows: self.roadmap.window_count(),
            totals: self.route.path.as_ref().map(|path| path.totals),
        });
    }
}

/// How many contacts a round may bring a roadmap to, by the time that its pairs took so far; `None` if the time is over.
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an estimate from counts far below 2^53"
)]
fn in_time(began: Option<(Instant, Duration)>, (count, tested): (usize, u64), wanted: usize) -> Option<usize> {
    let (Some((began, most)), true) = (began, count > 2) else { return Some(wanted) };
    let passed = began.elapsed();
    let left_s = most.checked_sub(passed)?.as_secs_f64();
    let pairs = left_s * tested as f64 / passed.as_secs_f64().max(1e-9);
    let most = (count as f64).mul_add(count as f64, pairs).sqrt() as usize;
    (most >= count + ROUND_LEAST.min(wanted - count)).then(|| most.min(wanted))
}

/// The mean distance from one point to the next, m.
#[expect(clippy::cast_precision_loss, reason = "a path has far fewer points than 2^53")]
fn mean_length_m(points: &[Point3<f64>]) -> f64 {
    let hops = points.len().saturating_sub(1).max(1);
    points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>() / hops as f64
}

/// What a path through a point takes at least.
struct Gains {
    /// `None` where the machine also walks: what hops take at least then bounds no path.
    least: Option<LeastAmounts>,
    points: [Point3<f64>; 2],
}

impl Gains {
    /// Whether a path through a point may be better than the best one.
    fn are_possible(&self, point: &Point3<f64>, best: &RoadmapRoute, question: &RoadmapQuestion<'_>) -> bool {
        let (Some(path), Some(least)) = (best.path.as_ref().filter(|_| best.within), &self.least) else { return true };
        let over = |from: &Point3<f64>, to: &Point3<f64>| {
            let away = to - from;
            least.over(libm::hypot(away.x, away.y), away.z)
        };
        let through = over(&self.points[0], point).then(&over(point, &self.points[1]));
        let amounts = question.objective.amounts().iter();
        amounts
            .map(|amount| (through.of(*amount), path.totals.of(*amount)))
            .find(|(least, known)| least != known)
            .is_some_and(|(least, known)| least < known)
    }
}

/// The share of the first amount of the objective that differs which a path is better by than another.
fn gain(before: &RoadmapRoute, after: &RoadmapRoute, question: &RoadmapQuestion<'_>) -> f64 {
    let (Some(old), Some(new)) = (&before.path, &after.path) else { return if after.path.is_some() { 1.0 } else { 0.0 } };
    if before.within != after.within {
        return 1.0;
    }
    let amounts = question.objective.amounts().iter();
    let mut differing = amounts.map(|amount| (old.totals.of(*amount), new.totals.of(*amount))).filter(|(old, new)| old != new);
    differing.next().map_or(0.0, |(old, new)| (old - new) / old)
}
