//! The goals of one search: they are sinks. A hop may end at one but never start from one, so goals do not block each other.

use super::{
    Cost, HopGraph,
    batched_search::{Label, Takeoff, Tally},
    nodes::around,
};
use crate::{
    chain::Station,
    progress::{Cancelled, Meter},
};

/// The goals and the best known path to each.
#[derive(Clone, Debug)]
pub(super) struct Goals {
    /// The goals, from left to right.
    stations: Vec<Station>,
    labels: Vec<Label>,
    /// For each goal from left to right, its index in the list given.
    given: Vec<usize>,
    most_hops: u64,
}

impl Goals {
    /// Goals without a known path.
    pub(super) fn new(goals: &[Station]) -> Self {
        let mut given: Vec<usize> = (0..goals.len()).collect();
        given.sort_by(|&a, &b| goals[a].point.x_m.total_cmp(&goals[b].point.x_m));
        let stations = given.iter().map(|&i| goals[i]).collect();
        Self { stations, labels: vec![Label::UNKNOWN; goals.len()], given, most_hops: Cost::UNREACHED.hops() }
    }

    /// The stations, from left to right.
    pub(super) fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// The best known path to each goal, in the order in which the goals were given; `None` for a goal without a path.
    pub(super) fn labels(&self) -> Vec<Option<Label>> {
        let mut labels = vec![None; self.labels.len()];
        for (label, &given) in self.labels.iter().zip(&self.given) {
            labels[given] = label.is_known().then_some(*label);
        }
        labels
    }

    /// The most hops of the known paths; unbounded if some goal has no path yet, or if there are no goals.
    pub(super) const fn most_hops(&self) -> u64 {
        self.most_hops
    }

    /// Goals at the start are reached with zero hops.
    pub(super) fn arrive_at(&mut self, start: &Station) {
        for (station, label) in self.stations.iter().zip(&mut self.labels) {
            if station.point.x_m == start.point.x_m {
                *label = Label::at_start();
            }
        }
        self.count();
    }

    /// Evaluates the hops from a set of take-offs to the goals.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn land_from(&mut self, graph: &HopGraph, takeoffs: &[Takeoff], meter: &Meter<'_>) -> Result<Tally, Cancelled> {
        let mut counter = meter.counter();
        let mut tally = Tally::default();
        for takeoff in takeoffs {
            let in_reach = around(&self.stations, &takeoff.station, takeoff.reach_m);
            for (goal, label) in self.stations[in_reach.clone()].iter().zip(&mut self.labels[in_reach]) {
                if label.cost.hops() <= takeoff.cost.hops() {
                    continue;
                }
                tally.pairs += 1;
                counter.pair()?;
                match graph.edge(&takeoff.station, goal) {
                    Ok(edge) => label.offer(takeoff.cost + graph.cost(&takeoff.station, goal, edge), takeoff.origin),
                    Err(limit) => tally.refusals.count(limit),
                }
            }
        }
        if tally.pairs > 0 {
            self.count();
        }
        Ok(tally)
    }

    fn count(&mut self) {
        self.most_hops = self.labels.iter().map(|label| label.cost.hops()).max().unwrap_or(Cost::UNREACHED.hops());
    }
}
