//! The shortest stretch outside the condition of a layer with which a path may arrive at a stop that is outside.
//!
//! ```text
//!   held  - flight ->  outside  - rest, flight ->  outside  - rest, flight ->  stop
//!         |<------------------- the shortest of all ------------------->|
//! ```
//!
//! A search backwards from the stop, over places outside alone: it ends at the first place where the condition holds, or at the start of the
//! leg, before which nothing is known. A path that arrives with it, and has the shortest stretch at its beginning too, leaves nothing to better.

use std::cell::RefCell;

use super::super::{
    Amount, Amounts, Budgets, LabelCap, LegGraph, LegVisitor, Objective, Stretch, Successor, SurfaceNode, labels::Tracked,
    outage::Outages, search::Run, surface_hops::Side, surface_legs::LegOffers,
};
use crate::{
    ground::MapPosition,
    progress::{Cancelled, Meter, PairCounter},
};

/// Sums in the other order differ by far less, and what keeps a limit by far more.
const ROUNDED_UP: f64 = 1.0 + 1e-12;

/// The hops towards a stop, of one layer: the nodes of the ground, and one where every search ends.
struct Backwards<'l> {
    offers: &'l LegOffers<'l>,
    outages: (&'l Outages, usize),
    start: SurfaceNode,
    counter: RefCell<PairCounter<'l>>,
    pairs: RefCell<u64>,
}

/// Turns the hops that end at a node into the legs of the search.
struct Turned<'v, 'l> {
    to: MapPosition,
    of: &'v Backwards<'l>,
    visitor: &'v mut dyn LegVisitor,
}

impl LegVisitor for Turned<'_, '_> {
    fn visit(&mut self, leg: &Successor) {
        let (outages, layer) = self.of.outages;
        let Some(from) = self.of.offers.surface.position(SurfaceNode::of_index(leg.node)) else { return };
        let flight_s = leg.amounts.of(Amount::FlightTime);
        let rest_s = (leg.amounts.of(Amount::MissionTime) - flight_s).max(0.0);
        let part = outages.of_hop(layer, [from.at, self.to.at], (rest_s, flight_s), true);
        let node = if part.is_open { leg.node } else { self.of.end() };
        self.visitor.visit(&Successor { node, command: leg.command, amounts: amounts_of(part.after) });
    }
}

fn amounts_of(stretch: Stretch) -> Amounts {
    Amounts::NONE.with(Amount::MissionTime, stretch.time_s).with(Amount::Hops, stretch.hops)
}

impl Backwards<'_> {
    fn end(&self) -> usize {
        self.offers.surface.nodes.count()
    }
}

impl LegGraph for Backwards<'_> {
    fn nodes(&self) -> usize {
        self.end() + 1
    }

    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        let node = SurfaceNode::of_index(node);
        if node == self.start {
            visitor.visit(&Successor { node: self.end(), command: 0, amounts: Amounts::NONE });
        }
        let Some(to) = self.offers.surface.position(node) else { return Ok(()) };
        let turned = &mut Turned { to, of: self, visitor };
        *self.pairs.borrow_mut() +=
            self.offers.visit((node, Side::Goal), &|_| true, turned, None, &mut self.counter.borrow_mut())?;
        Ok(())
    }

    fn least_to_goal(&self, _: usize) -> Amounts {
        Amounts::NONE
    }
}

/// The shortest stretches, of each layer, with which paths from a start arrive at a stop, time and hops each by itself; and the pairs of nodes
/// whose hop was computed.
pub(super) fn shortest_arrivals(
    offers: &LegOffers<'_>,
    (start, stop): (SurfaceNode, SurfaceNode),
    outages: &Outages,
    meter: &Meter<'_>,
) -> Result<(Vec<Stretch>, u64), Cancelled> {
    let mut pairs = 0;
    let mut shortest = Vec::new();
    for (layer, most) in outages.most().into_iter().enumerate() {
        let mut least = |amount: Amount, most: f64| {
            if !most.is_finite() {
                return Ok(0.0);
            }
            let (counter, counted) = (RefCell::new(meter.counter()), RefCell::new(0));
            let graph = Backwards { offers, outages: (outages, layer), start, counter, pairs: counted };
            let tracked = Tracked::new(&Objective::of(amount), &Budgets::NONE);
            let mut run = Run::new(&graph, (stop.index(), graph.end()), tracked, LabelCap::NONE);
            let found = run.until(true)?;
            pairs += *graph.pairs.borrow();
            Ok::<_, Cancelled>(found.map_or(0.0, |label| run.labels.totals(label)[0] * ROUNDED_UP))
        };
        let time_s = least(Amount::MissionTime, most.time_s)?;
        let hops = least(Amount::Hops, most.hops)?.floor();
        shortest.push(Stretch { time_s, hops });
    }
    Ok((shortest, pairs))
}
