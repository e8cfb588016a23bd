//! The graph of hops and drive legs over the nodes of a DEM.

use std::cell::{Cell, RefCell};

use super::{
    super::{
        Amounts, LegGraph, LegVisitor, PathStep, Successor, SurfaceNode, SurfaceNodes,
        pair_memo::PairMemo,
        surface_hops::Side,
        surface_legs::{LegOffers, LoftMemo},
    },
    drive_legs::{Arrival, DriveLegs, drive_amounts},
    least::LeastLeft,
};
use crate::{
    ballistics::TakeoffChoice,
    drive::{DriveEdges, DriveLeg},
    ground::{DemGround, MapPosition},
    progress::{Cancelled, Meter, PairCounter},
};

/// The command of a drive leg.
const DRIVEN: u32 = u32::MAX;

/// Hops and drive legs. A state of the search is a node, and where turning takes time a node with the direction of the last drive leg:
///
/// ```text
///     layer 0          any direction: the start, the goal, and wherever a hop landed; the next drive leg needs no turn
///     layer 1 to n     the direction of one of the n neighbours
///     layer n + 1      the direction from the start, for the first leg from a start beside the lattice
/// ```
///
/// Searched from the goal's side, legs lead to the nodes that are visited, and directions are those in which the search goes: two legs of a
/// path make the same angle either way.
///
/// A hop needs no turn: its preparation and its settling have their own times.
pub(super) struct TravelLegs<'a> {
    pub(super) hops: Option<&'a LegOffers<'a>>,
    pub(super) drive: Option<&'a DriveLegs<'a>>,
    ground: &'a DemGround,
    nodes: &'a SurfaceNodes,
    side: Side,
    /// Where the search begins.
    start: (SurfaceNode, MapPosition),
    /// Where it ends; `None`: it visits all states.
    goal: Option<(SurfaceNode, MapPosition)>,
    turns: Option<Turns>,
    /// What no mission takes less of on the way to the goal.
    least: LeastLeft,
    /// What is kept of pairs that no table has.
    hop_memo: Option<LoftMemo>,
    drive_memo: Option<RefCell<PairMemo<Option<Sums>>>>,
    counter: RefCell<PairCounter<'a>>,
    hops_tested: Cell<u64>,
    drives_tested: Cell<u64>,
}

/// Of a drive leg that which counts: its horizontal length, its length, time and energy.
type Sums = [f64; 4];

/// The times of turns between the directions of neighbours, s.
struct Turns {
    directions: usize,
    times_s: Vec<f64>,
}

impl Turns {
    fn of(drive: &DriveLegs<'_>) -> Option<Self> {
        let directions = drive.directions();
        let time_s = |from, to| drive.turn_s(&drive.heading(from), &drive.heading(to));
        let times_s = (0..directions).flat_map(|from| (0..directions).map(move |to| (from, to))).map(|(from, to)| time_s(from, to));
        (drive.rover().limits().turn_s_per_deg > 0.0).then(|| Self { directions, times_s: times_s.collect() })
    }
}

impl<'a> TravelLegs<'a> {
    pub(super) fn new(
        (ground, nodes): (&'a DemGround, &'a SurfaceNodes),
        (hops, drive): (Option<&'a LegOffers<'a>>, Option<&'a DriveLegs<'a>>),
        (side, start, goal): (Side, (SurfaceNode, MapPosition), Option<(SurfaceNode, MapPosition)>),
        pairs_bytes: u64,
        meter: &'a Meter<'_>,
    ) -> Self {
        let keeps = pairs_bytes > 0;
        Self {
            least: LeastLeft::of(ground, drive.map(DriveLegs::rover), hops.map(|hops| &hops.least)),
            hop_memo: keeps.then(|| RefCell::new(PairMemo::within(pairs_bytes))),
            drive_memo: keeps.then(|| RefCell::new(PairMemo::within(pairs_bytes))),
            hops,
            drive,
            ground,
            nodes,
            side,
            start,
            goal,
            turns: drive.and_then(Turns::of),
            counter: RefCell::new(meter.counter()),
            hops_tested: Cell::new(0),
            drives_tested: Cell::new(0),
        }
    }

    /// How many states a node has, for a rover with so many neighbours.
    pub(super) const fn layers(turns: bool, neighbours: usize) -> usize {
        if turns { neighbours + 2 } else { 1 }
    }

    /// Start and goal, as states; without a goal one that nothing reaches.
    pub(super) fn ends(&self) -> (usize, usize) {
        (self.start.0.index(), self.goal.map_or_else(|| self.states(), |goal| goal.0.index()))
    }

    /// All states of nodes.
    fn states(&self) -> usize {
        let layers = self.turns.as_ref().map_or(1, |turns| Self::layers(true, turns.directions));
        layers * self.nodes.count()
    }

    /// The node of a state.
    pub(super) fn node_of(&self, state: usize) -> SurfaceNode {
        SurfaceNode::of_index(state % self.nodes.count())
    }

    /// How many pairs of nodes were tested for hops and for drive legs.
    pub(super) fn tested(&self) -> [u64; 2] {
        [self.hops_tested.get(), self.drives_tested.get()]
    }

    /// The choice of take-off angle of a hop; `None` for a drive leg.
    pub(super) fn hop_of(&self, step: &PathStep) -> Option<TakeoffChoice> {
        self.hops.filter(|_| step.command != DRIVEN).map(|hops| hops.choice(step.command))
    }

    fn position(&self, node: SurfaceNode) -> Option<MapPosition> {
        self.nodes.position(self.ground, node)
    }

    /// The state in which a leg arrives at a node, and the time to turn for it, s.
    fn turned(
        &self,
        drive: &DriveLegs<'_>,
        layer: usize,
        (from, to): ((SurfaceNode, &MapPosition), (SurfaceNode, Option<&MapPosition>)),
        arrival: Arrival,
    ) -> (usize, f64) {
        let Some(turns) = &self.turns else { return (to.0.index(), 0.0) };
        let along = || match arrival {
            Arrival::Neighbour(direction) => Some(drive.heading(direction)),
            Arrival::Joined => (to.1?.at - from.1.at).try_normalize(0.0),
        };
        let before = match layer {
            0 => None,
            layer if layer <= turns.directions => Some(drive.heading(layer - 1)),
            _ => (from.1.at - self.start.1.at).try_normalize(0.0),
        };
        let turn_s = match (layer, arrival) {
            (0, _) => 0.0,
            (layer, Arrival::Neighbour(direction)) if layer <= turns.directions => {
                turns.times_s[(layer - 1) * turns.directions + direction]
            }
            // Between a place and a node at the same position nothing turns.
            _ => before.zip(along()).map_or(0.0, |(before, along)| drive.turn_s(&before, &along)),
        };
        let arrives = match arrival {
            // One state of the goal is enough: nothing follows.
            _ if self.goal.is_some_and(|goal| to.0 == goal.0) => 0,
            Arrival::Neighbour(direction) => direction + 1,
            Arrival::Joined => turns.directions + 1,
        };
        (arrives * self.nodes.count() + to.0.index(), turn_s)
    }

    /// Whether the search keeps the direction of a leg between a node and a place beside the lattice: where turning takes time only from the
    /// start and to the goal, of which each has a state.
    fn is_joined(&self, [from, to]: [SurfaceNode; 2]) -> bool {
        self.turns.is_none() || from == self.start.0 || self.goal.is_some_and(|goal| to == goal.0)
    }

    fn drive_from(
        &self,
        (node, at): (SurfaceNode, &MapPosition),
        layer: usize,
        visitor: &mut dyn LegVisitor,
    ) -> Result<(), Cancelled> {
        let Some(drive) = self.drive else { return Ok(()) };
        let Some((edges, _)) = drive.edges_of(node) else {
            return drive.about(node, at.at).try_for_each(|to| self.drive_to(drive, (node, at), to, layer, visitor));
        };
        self.drive_by_edges((drive, edges), (node, at), layer, visitor)?;
        drive.joined(node, at.at).try_for_each(|other| self.drive_to(drive, (node, at), (other, Arrival::Joined), layer, visitor))
    }

    /// Drives to the neighbours of a node by legs that were judged beforehand.
    fn drive_by_edges(
        &self,
        (drive, edges): (&DriveLegs<'_>, &DriveEdges<'_>),
        (node, at): (SurfaceNode, &MapPosition),
        layer: usize,
        visitor: &mut dyn LegVisitor,
    ) -> Result<(), Cancelled> {
        let count = drive.directions();
        for (direction, other) in drive.neighbours(node) {
            // Directions are in the order of their angles: half of them further on is the opposite one.
            let (begin, along) = match self.side {
                Side::Start => (node.index(), direction),
                Side::Goal => (other.index(), (direction + count / 2) % count),
            };
            if edges.directions(begin) >> along & 1 == 0 {
                continue;
            }
            let (state, turn_s) = self.turned(drive, layer, ((node, at), (other, None)), Arrival::Neighbour(direction));
            if !visitor.wants(state, &drive.least(drive.run_m(direction), turn_s)) {
                continue;
            }
            self.drives_tested.set(self.drives_tested.get() + 1);
            self.counter.borrow_mut().pair()?;
            if let Some(leg) = edges.sums(begin, along) {
                visitor.visit(&Successor { node: state, command: DRIVEN, amounts: drive_amounts(drive.rover(), &leg, turn_s) });
            }
        }
        Ok(())
    }

    /// Drives to one node.
    fn drive_to(
        &self,
        drive: &DriveLegs<'_>,
        (node, at): (SurfaceNode, &MapPosition),
        (other, arrival): (SurfaceNode, Arrival),
        layer: usize,
        visitor: &mut dyn LegVisitor,
    ) -> Result<(), Cancelled> {
        if arrival == Arrival::Joined && !self.is_joined([node, other]) {
            return Ok(());
        }
        let Some(to) = self.position(other) else { return Ok(()) };
        let (state, turn_s) = self.turned(drive, layer, ((node, at), (other, Some(&to))), arrival);
        let run_m = libm::hypot(to.at.x - at.at.x, to.at.y - at.at.y);
        if visitor.wants(state, &drive.least(run_m, turn_s))
            && let Some([run_m, length_m, time_s, energy_j_kg]) = self.sums(drive, (node, at), (other, &to))?
        {
            let leg = DriveLeg { run_m, length_m, time_s, energy_j_kg, ..DriveLeg::default() };
            visitor.visit(&Successor { node: state, command: DRIVEN, amounts: drive_amounts(drive.rover(), &leg, turn_s) });
        }
        Ok(())
    }

    /// What a drive leg takes; `None` where it is refused.
    fn sums(
        &self,
        drive: &DriveLegs<'_>,
        here: (SurfaceNode, &MapPosition),
        there: (SurfaceNode, &MapPosition),
    ) -> Result<Option<Sums>, Cancelled> {
        let (pair, [first, last]) = self.side.in_order(here, there);
        if let Some(known) = self.drive_memo.as_ref().and_then(|memo| memo.borrow().of(pair)) {
            return Ok(known);
        }
        self.drives_tested.set(self.drives_tested.get() + 1);
        self.counter.borrow_mut().pair()?;
        let sums = drive.leg(first, last).ok().map(|leg| [leg.run_m, leg.length_m, leg.time_s, leg.energy_j_kg]);
        if let Some(memo) = &self.drive_memo {
            memo.borrow_mut().keep(pair, sums);
        }
        Ok(sums)
    }
}

impl LegGraph for TravelLegs<'_> {
    fn nodes(&self) -> usize {
        self.states() + usize::from(self.goal.is_none())
    }

    fn successors(&self, state: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        self.counter.borrow().check()?;
        let (layer, node) = (state / self.nodes.count(), self.node_of(state));
        let Some(at) = self.position(node) else { return Ok(()) };
        // Driving first: what it reaches sooner is not tested for a hop.
        self.drive_from((node, &at), layer, visitor)?;
        if let Some(hops) = self.hops {
            let tested =
                hops.visit((node, self.side), &|_| true, visitor, self.hop_memo.as_ref(), &mut self.counter.borrow_mut())?;
            self.hops_tested.set(self.hops_tested.get() + tested);
        }
        Ok(())
    }

    fn least_to_goal(&self, state: usize) -> Amounts {
        let Some((_, goal)) = &self.goal else { return Amounts::NONE };
        self.position(self.node_of(state)).map_or(Amounts::NONE, |at| self.least.between(&at, goal))
    }
}
