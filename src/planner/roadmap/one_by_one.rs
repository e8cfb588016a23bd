//! A roadmap that grows contact by contact until its start and goal are joined: the planner of Campana and Laumond.
//!
//! ```text
//!     until the start leads to the goal:
//!         draw a contact; test the hops between it and every contact before it; add the contact and the hops that are free
//!     the shortest path, by the sum of the lengths of its arcs
//! ```
//!
//! Source: Campana and Laumond 2016, Algorithms 2 to 4, with what their program does where the paper is silent or differs.

use std::time::{Duration, Instant};

use super::{
    ContactSampler, GrownRoadmap, JoinCounts, JoinTest, Roadmap, RoadmapEnd, RoadmapPath, RoadmapQuestion, RoadmapRoute,
    anytime::numbered, join::Joiner,
};
use crate::{
    ballistics::PathBounds,
    ground::{MeshBuffers, MeshContact, MeshGround},
    progress::{Cancelled, Detail, Meter, Progress, Stage},
};

/// How a roadmap grows contact by contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneByOne {
    /// How hops are tested.
    pub test: JoinTest,
    /// The greatest height of a flight, m: the upper bound of the contacts.
    pub height_max_m: Option<f64>,
    /// The most contacts, start and goal included.
    pub contacts_max: usize,
    /// The longest time for it, judged before every contact; `None`: as long as it takes.
    pub time_max: Option<Duration>,
}

/// Grows a roadmap contact by contact until its start leads to its goal. The answer is the best path of that roadmap, every hop of which the
/// exact windows have: a hop that they do not have is taken out and counted, and the roadmap grows on where it was the last.
///
/// # Errors
/// [`Cancelled`].
pub fn grow_one_by_one(
    ground: &MeshGround,
    ends: [MeshContact; 2],
    sampler: &mut ContactSampler<'_>,
    question: &RoadmapQuestion<'_>,
    scheme: OneByOne,
    progress: &dyn Progress,
) -> Result<(GrownRoadmap, JoinCounts), Cancelled> {
    let began = Instant::now();
    let numbers = numbered(ground, &ends, 0);
    let OneByOne { test, height_max_m, .. } = scheme;
    let joiner = Joiner { ground, test, height_max_m, counts: JoinCounts::default(), buffers: MeshBuffers::default() };
    let mut growth = Growth {
        joiner,
        bounds: ground.speed_bounds(),
        roadmap: Roadmap::new(),
        reached: Vec::new(),
        found: Vec::new(),
        layer: Vec::new(),
    };
    let meter = Meter::new(progress, Stage::Search);
    meter.report(Detail::None)?;
    for contact in ends {
        growth.add(contact, &meter)?;
    }
    let (route, end) = loop {
        if growth.reached[numbers.1] {
            let route = growth.roadmap.route(ground, numbers, question)?;
            let Some(path) = &route.path else { break (route, RoadmapEnd::Exhausted) };
            if !growth.remove_grazes(path) {
                break (route, RoadmapEnd::Joined);
            }
            continue;
        }
        let no_route = RoadmapRoute { path: None, within: false, unmet: Vec::new(), capped: false };
        if growth.roadmap.contact_count() >= scheme.contacts_max {
            break (no_route, RoadmapEnd::Contacts);
        }
        if scheme.time_max.is_some_and(|most| began.elapsed() >= most) {
            break (no_route, RoadmapEnd::Time);
        }
        let Some(contact) = sampler.one() else { break (no_route, RoadmapEnd::Exhausted) };
        growth.add(contact, &meter)?;
    };
    let Growth { joiner, roadmap, .. } = growth;
    let mut grown = GrownRoadmap { roadmap, ends: numbers, route, history: Vec::new(), end, drawn: sampler.drawn() };
    grown.record();
    Ok((grown, joiner.counts))
}

/// A roadmap that grows.
struct Growth<'g> {
    joiner: Joiner<'g>,
    bounds: PathBounds,
    roadmap: Roadmap,
    /// Whether the start leads to each contact.
    reached: Vec<bool>,
    /// Buffers of the windows to and from one contact, and of contacts that were just reached.
    found: Vec<super::join::Joined>,
    layer: Vec<usize>,
}

impl Growth<'_> {
    /// Adds a contact, and the hops between it and every contact before it.
    fn add(&mut self, contact: MeshContact, meter: &Meter<'_>) -> Result<(), Cancelled> {
        let mut counter = meter.counter();
        let new = self.roadmap.contact_count();
        self.found.clear();
        for old in 0..new {
            counter.pair()?;
            let known = self.roadmap.contact(old);
            let away = contact.point_m() - known.point_m();
            let length_m = away.norm();
            if self.bounds.span(length_m, away.z) || self.bounds.span(length_m, -away.z) {
                self.joiner.join((old, known), (new, &contact), &mut self.found);
            }
        }
        self.roadmap.join(contact, &self.found, 2 * new as u64);
        self.reached.push(new == 0);
        // The contact may be reached from those that were, and then lead to others that were not.
        if self.found.iter().any(|(from, to, _)| *to == new && self.reached[*from]) {
            self.reached[new] = true;
            self.layer.push(new);
            self.spread();
        }
        Ok(())
    }

    /// Marks what the contacts of the layer lead to.
    fn spread(&mut self) {
        while let Some(node) = self.layer.pop() {
            for hop in self.roadmap.hops_from(node) {
                if !self.reached[hop.landing] {
                    self.reached[hop.landing] = true;
                    self.layer.push(hop.landing);
                }
            }
        }
    }

    /// Removes the hops of a path that the exact windows of their contacts do not have, both ways; whether there were any.
    fn remove_grazes(&mut self, path: &RoadmapPath) -> bool {
        if self.joiner.test == JoinTest::ExactWindows {
            return false;
        }
        let mut grazes = Vec::new();
        for (pair, arc) in path.contacts.windows(2).zip(path.arcs()) {
            let contacts = [pair[0], pair[1]].map(|node| self.roadmap.contact(node));
            if !self.joiner.is_in_a_window(contacts, arc.loft()) {
                grazes.push([pair[0], pair[1]]);
            }
        }
        if grazes.is_empty() {
            return false;
        }
        self.joiner.counts.grazes += grazes.len() as u64;
        self.roadmap.remove_hops(|from, to| grazes.contains(&[from, to]) || grazes.contains(&[to, from]));
        self.reached.fill(false);
        self.reached[0] = true;
        self.layer.push(0);
        self.spread();
        true
    }
}
