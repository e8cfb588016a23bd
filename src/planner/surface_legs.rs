//! The legs of a DEM: hops between its nodes in any direction, each with its distinct commands.

use std::cell::RefCell;

use nalgebra::Vector2;
use rayon::prelude::*;

use super::{
    Amount, Amounts, FoundPath, LeastAmounts, LegGraph, LegVisitor, PathStep, SearchedCommands, Successor, SurfaceNode,
    fewest_hops::FewestHops,
    surface_hops::{Feasible, Side, SurfaceHops},
};
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    flight::Uncertainty,
    graph::MapJudge,
    ground::{DemGround, MapPosition, Surface},
    progress::{Cancelled, Meter, PairCounter},
};

/// So many hops are computed by all threads: less work than some 50 microseconds is not worth waking them.
const SHARED_FROM: usize = 64;

/// What the hops between nodes of a DEM take, for any thread.
pub(super) struct LegOffers<'a> {
    pub(super) surface: &'a SurfaceHops<'a>,
    pub(super) start: SurfaceNode,
    /// The choices of a hop, each with what judges its risk.
    commands: Vec<(TakeoffChoice, Option<MapJudge>)>,
    pub(super) least: LeastAmounts,
}

/// The graph of a DEM over a set of nodes, from a start to a goal.
pub struct SurfaceLegs<'a> {
    pub(super) offers: LegOffers<'a>,
    goal: (SurfaceNode, MapPosition),
    /// The fewest hops from nodes to the goal.
    hops_left: &'a FewestHops,
    counted: Counted,
    counter: RefCell<PairCounter<'a>>,
    pairs: RefCell<u64>,
}

impl std::fmt::Debug for SurfaceLegs<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SurfaceLegs").field("start", &self.offers.start).field("goal", &self.goal).finish_non_exhaustive()
    }
}

/// Which nodes a search looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counted {
    /// Those with known hops to the goal.
    Known,
    /// All, some of which may lead to the goal in more hops than are known.
    All,
}

/// A leg that may be of use.
struct Candidate {
    node: SurfaceNode,
    at: MapPosition,
    sight: (LineOfSight, Vector2<f64>),
}

impl<'a> LegOffers<'a> {
    fn new(
        surface: &'a SurfaceHops<'a>,
        start: SurfaceNode,
        (offered, takeoff): (SearchedCommands, TakeoffChoice),
        errors: Option<(&Uncertainty, &DemGround)>,
    ) -> Self {
        let ground = surface.ground;
        let limits = ground.hopper().limits();
        let judge =
            |choice| errors.map(|(errors, flown_over)| MapJudge::new(flown_over, errors, choice).planned_within(ground.envelope()));
        // Flown draws of every pair would take minutes: the most reliable command of a hop is not searched for.
        let commands = offered.choices(takeoff, false).into_iter().map(|choice| (choice, judge(choice))).collect();
        let (low_m, high_m) = ground.terrain().dem().elevation_range_m();
        let landing_m_s = if limits.landing.brakes() { f64::INFINITY } else { limits.landing_speed_max_m_s };
        let speeds_m_s = (limits.takeoff_speed_max_m_s, landing_m_s);
        let least = LeastAmounts::new(limits, ground.gravity_m_s2(), speeds_m_s, high_m - low_m);
        Self { surface, start, commands, least }
    }

    /// Gives a hop once for each of its distinct commands: the command's number, and what the hop takes with it.
    pub(super) fn each(&self, from: SurfaceNode, to: &MapPosition, hop: &Feasible, mut give: impl FnMut(u32, Amounts)) {
        let envelope = self.surface.ground.envelope();
        let limits = self.surface.ground.hopper().limits();
        let mut known = [f64::NAN; TakeoffChoice::ALL.len()];
        for ((command, (choice, judge)), number) in self.commands.iter().enumerate().zip(0..) {
            let loft = envelope.loft(*choice, hop.sight, hop.lofts);
            if !known[..command].contains(&loft) {
                let arc = Arc::new(hop.sight, loft, envelope.gravity_m_s2());
                let risk = judge.as_ref().map_or(0.0, |judge| judge.estimate(to, hop.heading, (hop.sight, hop.lofts)));
                give(number, Amounts::of_arc(&arc, limits, from == self.start).with(Amount::Risk, risk));
            }
            known[command] = loft;
        }
    }

    /// The choice of a command.
    pub(super) fn choice(&self, command: u32) -> TakeoffChoice {
        self.commands.get(command as usize).map_or(TakeoffChoice::LeastSpeed, |(choice, _)| *choice)
    }
}

impl<'a> SurfaceLegs<'a> {
    /// The graph.
    ///
    /// # Arguments
    /// `errors`: those by which risk is judged, in closed form as on maps; `None` if it does not count, which is faster.
    /// `hops_left`: the fewest hops to the goal, which decide what nodes are `counted`.
    pub(super) fn new(
        surface: &'a SurfaceHops<'a>,
        (start, goal): (SurfaceNode, (SurfaceNode, MapPosition)),
        (offered, takeoff): (SearchedCommands, TakeoffChoice),
        errors: Option<(&Uncertainty, &DemGround)>,
        (hops_left, counted): (&'a FewestHops, Counted),
        meter: &'a Meter<'_>,
    ) -> Self {
        let offers = LegOffers::new(surface, start, (offered, takeoff), errors);
        Self { offers, goal, hops_left, counted, counter: RefCell::new(meter.counter()), pairs: RefCell::new(0) }
    }

    /// Start and goal.
    pub(super) const fn ends(&self) -> (usize, usize) {
        (self.offers.start.index(), self.goal.0.index())
    }

    /// Pairs of nodes whose hop was computed.
    pub(super) fn pairs(&self) -> u64 {
        *self.pairs.borrow()
    }

    /// Counts pairs of nodes whose hop was computed elsewhere.
    pub(super) fn count(&self, pairs: u64) {
        *self.pairs.borrow_mut() += pairs;
    }

    /// The arc of a leg.
    pub(super) fn arc(&self, step: &PathStep) -> Option<Arc> {
        let nodes = [step.from, step.to].map(SurfaceNode::of_index);
        let [from, to] = nodes.map(|node| self.offers.surface.position(node));
        let (from, to) = (from?, to?);
        let hop = self.offers.surface.between(nodes, [&from, &to], self.offers.surface.sight(&from, &to)?)?;
        let envelope = self.offers.surface.ground.envelope();
        Some(Arc::new(hop.sight, envelope.loft(self.offers.choice(step.command), hop.sight, hop.lofts), envelope.gravity_m_s2()))
    }

    /// The hops of a path.
    pub(super) fn hops_of(path: &FoundPath) -> impl Iterator<Item = [SurfaceNode; 2]> + '_ {
        path.steps.iter().map(|step| [step.from, step.to].map(SurfaceNode::of_index))
    }

    /// The nodes to which a visitor may want a leg.
    fn candidates(&self, node: SurfaceNode, from: &MapPosition, visitor: &mut dyn LegVisitor) -> Vec<Candidate> {
        const ONE_HOP: Amounts = Amounts::NONE.with(Amount::Hops, 1.0);
        let leads_on = |next: &SurfaceNode| *next != node && (self.counted == Counted::All || self.hops_left.of(*next).is_some());
        let mut candidates = Vec::new();
        for next in self.offers.surface.about(from, Side::Start).filter(leads_on) {
            // By the hops alone, which needs no ground.
            if !visitor.may_improve(next.index(), &ONE_HOP) {
                continue;
            }
            let Some(at) = self.offers.surface.position(next) else { continue };
            let Some(sight) = self.offers.surface.sight(from, &at) else { continue };
            if visitor.wants(next.index(), &self.offers.least.of_hop(sight.0)) {
                candidates.push(Candidate { node: next, at, sight });
            }
        }
        candidates
    }
}

impl LegGraph for SurfaceLegs<'_> {
    fn nodes(&self) -> usize {
        self.offers.surface.nodes.count()
    }

    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        let node = SurfaceNode::of_index(node);
        self.counter.borrow().check()?;
        let Some(from) = self.offers.surface.position(node) else { return Ok(()) };
        let candidates = self.candidates(node, &from, visitor);
        for _ in &candidates {
            self.counter.borrow_mut().pair()?;
        }
        self.count(candidates.len() as u64);
        let surface = self.offers.surface;
        let hop = |to: &Candidate| surface.between([node, to.node], [&from, &to.at], to.sight);
        let hops: Vec<Option<Feasible>> = if candidates.len() < SHARED_FROM {
            candidates.iter().map(hop).collect()
        } else {
            candidates.par_iter().map(hop).collect()
        };
        for (candidate, hop) in candidates.iter().zip(&hops) {
            if let Some(hop) = hop {
                self.offers.each(node, &candidate.at, hop, |command, amounts| {
                    visitor.visit(&Successor { node: candidate.node.index(), command, amounts });
                });
            }
        }
        Ok(())
    }

    fn least_to_goal(&self, node: usize) -> Amounts {
        let node = SurfaceNode::of_index(node);
        let Some(at) = self.offers.surface.position(node) else { return Amounts::NONE };
        let goal = &self.goal.1;
        let run_m = libm::hypot(goal.at.x - at.at.x, goal.at.y - at.at.y);
        self.offers.least.over_in(run_m, goal.z_m - at.z_m, self.hops_left.of(node).map_or(0, u64::from))
    }
}
