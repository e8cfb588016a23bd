//! The legs of a DEM: hops between its nodes in any direction, each with its distinct commands.

use std::cell::RefCell;

use nalgebra::Vector2;
use rayon::prelude::*;

use super::{
    Amount, Amounts, FoundPath, LayerTotals, LeastAmounts, LegGraph, LegVisitor, OutagePart, PathStep, RoutePath, SearchedCommands,
    Successor, SurfaceNode,
    fewest_hops::FewestHops,
    outage::Outages,
    pair_memo::PairMemo,
    surface_hops::{Feasible, Side, SurfaceHops},
    table_hops::TableHops,
};
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    flight::Uncertainty,
    graph::{Cost, Effort, MapJudge},
    ground::{DemGround, MapPosition, Post, Surface},
    progress::{Cancelled, Meter, PairCounter},
    quantity::{MapPoint, SlopeInterval},
};

/// So many hops are computed by all threads: less work than some 50 microseconds is not worth waking them.
const SHARED_FROM: usize = 64;

/// Rounding errors are far smaller than this share.
const SHAVED: f64 = 1.0 - 1e-9;

/// What the hops between nodes of a DEM take, for any thread.
pub(super) struct LegOffers<'a> {
    pub(super) surface: &'a SurfaceHops<'a>,
    settling: Settling,
    /// The choices of a hop, each with what judges its risk.
    commands: Vec<(TakeoffChoice, Option<MapJudge>)>,
    pub(super) least: LeastAmounts,
    tables: Option<Tables<'a>>,
}

/// The lofts of pairs of nodes, `None` where no arc is feasible.
pub(super) type LoftMemo = RefCell<PairMemo<Option<SlopeInterval>>>;

/// The hops between nodes of the lattice, with what those of each offset take at least.
struct Tables<'a> {
    hops: &'a TableHops,
    /// With the time to settle, and without.
    least: [Vec<Amounts>; 2],
    /// The node of the lattice for which the machine does not settle.
    spared: Option<SurfaceNode>,
}

/// Which hops the machine settles for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Settling {
    /// Before every hop but those from this node: where there are hops alone, the mission begins there.
    BeforeAllBut(SurfaceNode),
    /// After every hop but those that land here, where the mission ends.
    AfterAllBut(MapPoint),
    /// After every hop.
    AfterAll,
    /// Before every hop: the first one follows a landing that is not of this path.
    BeforeAll,
}

impl Settling {
    /// Whether none belongs to a hop.
    fn is_spared(self, from: SurfaceNode, to: &MapPosition) -> bool {
        match self {
            Self::BeforeAllBut(start) => from == start,
            Self::AfterAllBut(goal) => to.at == goal,
            Self::AfterAll | Self::BeforeAll => false,
        }
    }

    /// The same between nodes of the lattice, of which this one is spared.
    fn is_spared_between(self, [from, to]: [SurfaceNode; 2], spared: SurfaceNode) -> bool {
        match self {
            Self::BeforeAllBut(_) => from == spared,
            Self::AfterAllBut(_) => to == spared,
            Self::AfterAll | Self::BeforeAll => false,
        }
    }
}

/// The graph of a DEM over a set of nodes, from a start to a goal.
pub struct SurfaceLegs<'a> {
    pub(super) offers: LegOffers<'a>,
    start: SurfaceNode,
    goal: (SurfaceNode, MapPosition),
    /// The fewest hops from nodes to the goal.
    hops_left: &'a FewestHops,
    counted: Counted,
    /// The layers that may be left for a while, and whether paths end at the goal, so that no outage goes on from there.
    outages: Option<(&'a Outages, bool)>,
    counter: RefCell<PairCounter<'a>>,
    pairs: RefCell<u64>,
}

impl std::fmt::Debug for SurfaceLegs<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SurfaceLegs").field("start", &self.start).field("goal", &self.goal).finish_non_exhaustive()
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
    /// The commands of hops. `errors`: those by which risk is judged, in closed form as on maps; `None` if it does not count, which is faster.
    pub(super) fn new(
        surface: &'a SurfaceHops<'a>,
        settling: Settling,
        (offered, takeoff): (SearchedCommands, TakeoffChoice),
        errors: Option<(&Uncertainty, &DemGround)>,
    ) -> Self {
        let ground = surface.ground;
        let judge =
            |choice| errors.map(|(errors, flown_over)| MapJudge::new(flown_over, errors, choice).planned_within(ground.envelope()));
        // Flown draws of every pair would take minutes: the most reliable command of a hop is not searched for.
        let commands = offered.choices(takeoff, false).into_iter().map(|choice| (choice, judge(choice))).collect();
        Self { surface, settling, commands, least: LeastAmounts::over_dem(ground), tables: None }
    }

    /// The same with tables for the hops between nodes of the lattice.
    pub(super) fn by_tables(self, tables: Option<&'a TableHops>) -> Self {
        let of_hops = |hops: &'a TableHops| {
            let spared = match self.settling {
                Settling::BeforeAllBut(start) => Some(start),
                Settling::AfterAllBut(goal) => hops.node_at(goal),
                Settling::AfterAll | Settling::BeforeAll => None,
            };
            let least = |is_spared| hops.runs_m().map(|run_m| self.settled(&self.least.of_any_hop(run_m), is_spared)).collect();
            Tables { hops, least: [least(false), least(true)], spared }
        };
        Self { tables: tables.map(of_hops), ..self }
    }

    /// What a hop takes at least, with the time to settle.
    fn settled(&self, least: &Amounts, is_spared: bool) -> Amounts {
        let settling_s = self.surface.ground.hopper().limits().settling_s().filter(|_| !is_spared).unwrap_or(0.0);
        least.with(Amount::MissionTime, least.of(Amount::MissionTime) + settling_s * SHAVED)
    }

    /// Gives a hop once for each of its distinct commands: the command's number, and what the hop takes with it.
    pub(super) fn each(&self, from: SurfaceNode, to: &MapPosition, hop: &Feasible, mut give: impl FnMut(u32, Amounts)) {
        let envelope = self.surface.ground.envelope();
        let limits = self.surface.ground.hopper().limits();
        let layers = self.layers_between(from, to);
        let mut known = [f64::NAN; TakeoffChoice::ALL.len()];
        for ((command, (choice, judge)), number) in self.commands.iter().enumerate().zip(0..) {
            let loft = envelope.loft(*choice, hop.sight, hop.lofts);
            if !known[..command].contains(&loft) {
                let arc = Arc::new(hop.sight, loft, envelope.gravity_m_s2());
                let risk = judge.as_ref().map_or(0.0, |judge| judge.estimate(to, hop.heading, (hop.sight, hop.lofts)));
                let of_arc = Amounts::of_arc(&arc, limits, self.settling.is_spared(from, to));
                give(number, of_arc.with(Amount::Risk, risk).with_layers(layers));
            }
            known[command] = loft;
        }
    }

    /// What the layers of the map cost on a hop, whatever its command.
    fn layers_between(&self, from: SurfaceNode, to: &MapPosition) -> LayerTotals {
        let layers = self.surface.ground.layers();
        if !layers.have_costs() {
            return LayerTotals::NONE;
        }
        let Some(from) = self.surface.position(from) else { return LayerTotals::NONE };
        layers.costs_of_hop(from.at, to.at).fold(LayerTotals::NONE, |totals, (layer, cost)| totals.with(layer, cost))
    }

    /// Visits every hop that begins at a node, or ends there, whose other end leads on, once for each of its distinct commands.
    ///
    /// # Arguments
    /// `memo`: what is known of pairs that no table has, and is kept of them.
    ///
    /// # Returns
    /// How many pairs of nodes were tested.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn visit(
        &self,
        (node, side): (SurfaceNode, Side),
        leads_on: &dyn Fn(SurfaceNode) -> bool,
        visitor: &mut dyn LegVisitor,
        memo: Option<&LoftMemo>,
        counter: &mut PairCounter<'_>,
    ) -> Result<u64, Cancelled> {
        let Some(at) = self.surface.position(node) else { return Ok(0) };
        let from = (node, &at, side);
        let cell = self.surface.nodes.of_lattice(node);
        let (mut tested, candidates) = match self.tables.as_ref().zip(cell) {
            Some((tables, cell)) => {
                let tested = self.visit_by_tables((node, cell, side), (tables, leads_on), visitor, counter)?;
                let beside = self.surface.nodes.places_about(at.at, self.surface.reach_m(&at, side));
                (tested, self.candidates(from, beside, leads_on, visitor))
            }
            None => (0, self.candidates(from, self.surface.about(&at, side), leads_on, visitor)),
        };
        for (candidate, hop) in candidates.iter().zip(self.hops_of(from, &candidates, memo, (&mut tested, counter))?) {
            if let Some(hop) = hop {
                let ([from, _], [_, to]) = side.in_order((node, &at), (candidate.node, &candidate.at));
                self.each(from, to, &hop, |command, amounts| {
                    visitor.visit(&Successor { node: candidate.node.index(), command, amounts });
                });
            }
        }
        Ok(tested)
    }

    /// The hops to or from candidates.
    fn hops_of(
        &self,
        (node, at, side): (SurfaceNode, &MapPosition, Side),
        candidates: &[Candidate],
        memo: Option<&LoftMemo>,
        (tested, counter): (&mut u64, &mut PairCounter<'_>),
    ) -> Result<Vec<Option<Feasible>>, Cancelled> {
        let in_order = |other: &'_ Candidate| side.in_order((node, at), (other.node, &other.at)).0;
        let known = |other: &Candidate| memo.and_then(|memo| memo.borrow().of(in_order(other)));
        let known: Vec<Option<Option<SlopeInterval>>> = candidates.iter().map(known).collect();
        let unknown = known.iter().filter(|known| known.is_none()).count();
        for _ in 0..unknown {
            counter.pair()?;
        }
        *tested += unknown as u64;
        let hop = |(other, known): (&Candidate, &Option<Option<SlopeInterval>>)| {
            let (sight, heading) = other.sight;
            if let Some(lofts) = known {
                return lofts.map(|lofts| Feasible { sight, heading, lofts });
            }
            let (nodes, ends) = side.in_order((node, at), (other.node, &other.at));
            self.surface.between(nodes, ends, other.sight)
        };
        let hops: Vec<Option<Feasible>> = if unknown < SHARED_FROM {
            candidates.iter().zip(&known).map(hop).collect()
        } else {
            candidates.par_iter().zip(&known).map(hop).collect()
        };
        if let Some(memo) = memo {
            let mut memo = memo.borrow_mut();
            for ((other, hop), _) in candidates.iter().zip(&hops).zip(&known).filter(|(_, known)| known.is_none()) {
                memo.keep(in_order(other), hop.map(|hop| hop.lofts));
            }
        }
        Ok(hops)
    }

    /// Visits the hops between a node of the lattice and the others of it.
    ///
    /// # Returns
    /// How many pairs of nodes were tested.
    fn visit_by_tables(
        &self,
        (node, cell, side): (SurfaceNode, (usize, usize), Side),
        (tables, leads_on): (&Tables<'_>, &dyn Fn(SurfaceNode) -> bool),
        visitor: &mut dyn LegVisitor,
        counter: &mut PairCounter<'_>,
    ) -> Result<u64, Cancelled> {
        let post = Post { row: cell.1, col: cell.0 };
        let mut tested = 0;
        for (offset, there) in tables.hops.about(cell, side) {
            let other = tables.hops.number(there);
            let (nodes, from) = match side {
                Side::Start => ([node, other], post),
                Side::Goal => ([other, node], there),
            };
            let is_spared = tables.spared.is_some_and(|spared| self.settling.is_spared_between(nodes, spared));
            if !leads_on(other) || !visitor.wants(other.index(), &tables.least[usize::from(is_spared)][offset]) {
                continue;
            }
            tested += 1;
            counter.pair()?;
            if let Some(hop) = tables.hops.hop(from, offset).filter(|_| !self.surface.is_refused(nodes))
                && let Some(to) = self.surface.position(nodes[1])
            {
                self.each(nodes[0], &to, &hop, |command, amounts| {
                    visitor.visit(&Successor { node: other.index(), command, amounts });
                });
            }
        }
        Ok(tested)
    }

    /// The nodes to or from which a visitor may want a leg, of some.
    fn candidates(
        &self,
        (node, at, side): (SurfaceNode, &MapPosition, Side),
        others: impl Iterator<Item = SurfaceNode>,
        leads_on: &dyn Fn(SurfaceNode) -> bool,
        visitor: &mut dyn LegVisitor,
    ) -> Vec<Candidate> {
        let mut candidates = Vec::new();
        for other in others.filter(|other| *other != node && leads_on(*other)) {
            // By the hops alone, which needs no ground.
            if !visitor.may_improve(other.index(), &Amounts::ONE_HOP) {
                continue;
            }
            let Some(there) = self.surface.position(other) else { continue };
            let ([first, _], [from, to]) = side.in_order((node, at), (other, &there));
            let Some(sight) = self.surface.sight(from, to) else { continue };
            let least = self.settled(&self.least.of_hop(sight.0), self.settling.is_spared(first, to));
            if visitor.wants(other.index(), &least) {
                candidates.push(Candidate { node: other, at: there, sight });
            }
        }
        candidates
    }

    /// The choice of a command.
    pub(super) fn choice(&self, command: u32) -> TakeoffChoice {
        self.commands.get(command as usize).map_or(TakeoffChoice::LeastSpeed, |(choice, _)| *choice)
    }
}

impl<'a> SurfaceLegs<'a> {
    /// The graph over these hops. `hops_left`: the fewest hops to the goal, which decide what nodes are `counted`.
    pub(super) fn new(
        offers: LegOffers<'a>,
        (start, goal): (SurfaceNode, (SurfaceNode, MapPosition)),
        (hops_left, counted): (&'a FewestHops, Counted),
        meter: &'a Meter<'_>,
    ) -> Self {
        Self {
            offers,
            start,
            goal,
            hops_left,
            counted,
            outages: None,
            counter: RefCell::new(meter.counter()),
            pairs: RefCell::new(0),
        }
    }

    /// The same under layers that may be left for a while. `ends`: whether paths end at the goal.
    pub(super) fn under(self, outages: &'a Outages, ends: bool) -> Self {
        Self { outages: Some((outages, ends)), ..self }
    }

    /// Start and goal.
    pub(super) const fn ends(&self) -> (usize, usize) {
        (self.start.index(), self.goal.0.index())
    }

    /// What paths from the start take at least that have more hops than the fewest. `is_first`: whether the first hop begins the mission.
    pub(super) fn least_in_more_hops(&self, is_first: bool) -> Amounts {
        let offers = &self.offers;
        let (Some(at), Some(fewest)) = (offers.surface.position(self.start), self.hops_left.of(self.start)) else {
            return Amounts::NONE;
        };
        let run_m = libm::hypot(self.goal.1.at.x - at.at.x, self.goal.1.at.y - at.at.y);
        offers.settled(&offers.least.over_in(run_m, self.goal.1.z_m - at.z_m, u64::from(fewest) + 1), is_first)
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

    /// The places, commands and totals of a path.
    pub(super) fn route_path(&self, path: &FoundPath, effort: Effort) -> RoutePath {
        let ends = Self::hops_of(path).map(|[_, to]| to);
        let places = std::iter::once(self.start).chain(ends).filter_map(|node| self.offers.surface.position(node)).collect();
        let arcs = path.steps.iter().filter_map(|step| self.arc(step));
        RoutePath {
            places,
            choices: path.steps.iter().map(|step| self.offers.choice(step.command)).collect(),
            cost: arcs.fold(Cost::default(), |cost, arc| cost + effort.cost(&arc, 1)),
            totals: path.totals,
        }
    }

    /// The hops of a path.
    pub(super) fn hops_of(path: &FoundPath) -> impl Iterator<Item = [SurfaceNode; 2]> + '_ {
        path.steps.iter().map(|step| [step.from, step.to].map(SurfaceNode::of_index))
    }
}

impl LegGraph for SurfaceLegs<'_> {
    fn nodes(&self) -> usize {
        self.offers.surface.nodes.count()
    }

    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        self.counter.borrow().check()?;
        let leads_on = |next: SurfaceNode| self.counted == Counted::All || self.hops_left.of(next).is_some();
        let of_node = (SurfaceNode::of_index(node), Side::Start);
        self.count(self.offers.visit(of_node, &leads_on, visitor, None, &mut self.counter.borrow_mut())?);
        Ok(())
    }

    fn least_to_goal(&self, node: usize) -> Amounts {
        let node = SurfaceNode::of_index(node);
        let Some(at) = self.offers.surface.position(node) else { return Amounts::NONE };
        let goal = &self.goal.1;
        let run_m = libm::hypot(goal.at.x - at.at.x, goal.at.y - at.at.y);
        self.offers.least.over_in(run_m, goal.z_m - at.z_m, self.hops_left.of(node).map_or(0, u64::from))
    }

    fn outage(&self, from: usize, leg: &Successor, layer: usize) -> OutagePart {
        let [from, to] = [from, leg.node].map(|node| self.offers.surface.position(SurfaceNode::of_index(node)));
        let (Some((outages, ends)), Some(from), Some(to)) = (self.outages, from, to) else { return OutagePart::HELD };
        let flight_s = leg.amounts.of(Amount::FlightTime);
        let rest_s = (leg.amounts.of(Amount::MissionTime) - flight_s).max(0.0);
        outages.of_hop(layer, [from.at, to.at], (rest_s, flight_s), !(ends && leg.node == self.goal.0.index()))
    }
}
