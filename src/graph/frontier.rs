//! Why a search finds no path: the nodes reached from either end, and the limits that refuse the hops between them.

use std::collections::VecDeque;

use super::{HopGraph, RefusalCounts, local_reach::LocalReach, nodes::around};
use crate::{
    chain::Station,
    hop::Conflict,
    progress::{Cancelled, Meter},
    quantity::NodeId,
};

/// The nodes reached from the start and those that lead to the goal, over one graph, and the refusals between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Frontier {
    /// Every node that the start reaches, the start included, from left to right.
    pub reached: Vec<Station>,
    /// Every node from which the goal can be reached, the goal included, from left to right.
    pub leads_to_goal: Vec<Station>,
    /// The reached node nearest to the goal.
    pub nearest_to_goal: Station,
    /// The node nearest to the start from which the goal can be reached.
    pub nearest_to_start: Station,
    /// The refusals of all hops out of the reached set.
    pub refusals: RefusalCounts,
    /// Of the refusals by two conflicting limits, the one with the smallest gap in degrees.
    pub nearest_miss: Option<NearestMiss>,
}

/// The refused hop with the smallest gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestMiss {
    /// The take-off station.
    pub takeoff: Station,
    /// The landing station.
    pub landing: Station,
    /// Why the hop is refused.
    pub conflict: Conflict,
}

impl Frontier {
    /// The most refused hops out of the reached set that are analysed for the nearest miss; the counts include all of them.
    ///
    /// Analysing a refusal costs some microseconds, so this limits the work to about a second.
    const EXPLAINED: usize = 200_000;

    /// The frontier of a graph without a path, given the nodes that were reached.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn of(graph: &HopGraph, reach: &LocalReach, reached: &[bool], meter: &Meter<'_>) -> Result<Self, Cancelled> {
        let nodes = graph.nodes();
        let leads = leading_to_goal(graph, reach, meter)?;
        let of = |flags: &[bool]| -> Vec<Station> {
            nodes.stations().iter().zip(flags).filter(|(_, flag)| **flag).map(|(station, _)| *station).collect()
        };
        let (reached_stations, leads_stations) = (of(reached), of(&leads));
        let nearest = |stations: &[Station], to: &Station| {
            let away = |s: &&Station| (s.point.x_m - to.point.x_m).abs();
            stations.iter().min_by(|a, b| away(a).total_cmp(&away(b))).copied()
        };
        let (start, goal) = (*nodes.station(nodes.start()), *nodes.station(nodes.goal()));
        let (refusals, nearest_miss) = refusals_out_of(graph, reached, meter)?;
        Ok(Self {
            nearest_to_goal: nearest(&reached_stations, &goal).unwrap_or(start),
            nearest_to_start: nearest(&leads_stations, &start).unwrap_or(goal),
            reached: reached_stations,
            leads_to_goal: leads_stations,
            refusals,
            nearest_miss,
        })
    }
}

/// The nodes that lead to the goal: breadth-first search against the direction of the hops.
fn leading_to_goal(graph: &HopGraph, reach: &LocalReach, meter: &Meter<'_>) -> Result<Vec<bool>, Cancelled> {
    let mut counter = meter.counter();
    let nodes = graph.nodes();
    let mut leads = vec![false; nodes.stations().len()];
    let mut queue = VecDeque::from([nodes.goal()]);
    leads[nodes.goal().index()] = true;
    while let Some(landing) = queue.pop_front() {
        let landing = nodes.station(landing);
        for takeoff in around(nodes.stations(), landing, reach.at_m(landing)) {
            if leads[takeoff] {
                continue;
            }
            counter.pair()?;
            if graph.edge(&nodes.stations()[takeoff], landing).is_ok() {
                leads[takeoff] = true;
                queue.push_back(NodeId(takeoff));
            }
        }
    }
    Ok(leads)
}

/// The refusals of the hops that leave a set of nodes, and the smallest gap among them.
fn refusals_out_of(
    graph: &HopGraph,
    reached: &[bool],
    meter: &Meter<'_>,
) -> Result<(RefusalCounts, Option<NearestMiss>), Cancelled> {
    let mut counter = meter.counter();
    let stations = graph.nodes().stations();
    let mut counts = RefusalCounts::default();
    let mut explained = 0;
    let mut best: Option<(f64, NearestMiss)> = None;
    for (takeoff, _) in stations.iter().zip(reached).filter(|(_, reached)| **reached) {
        for j in graph.landings(takeoff).filter(|&j| !reached[j]) {
            counter.pair()?;
            let landing = stations[j];
            let Err(limit) = graph.edge(takeoff, &landing) else { continue };
            counts.count(limit);
            if explained == Frontier::EXPLAINED {
                continue;
            }
            explained += 1;
            let conflict = graph.test().takeoff_set(takeoff, &landing).and_then(|set| set.conflict());
            if let Some(conflict @ Conflict::Pair { gap_deg, .. }) = conflict
                && best.is_none_or(|(smallest, _)| gap_deg < smallest)
            {
                best = Some((gap_deg, NearestMiss { takeoff: *takeoff, landing, conflict }));
            }
        }
    }
    Ok((counts, best.map(|(_, miss)| miss)))
}
