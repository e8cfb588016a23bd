//! The straight lines that a machine walks between the nodes of a roadmap.

use std::{collections::BTreeSet, ops::Range};

use petgraph::Direction as Towards;
use rayon::prelude::*;

use super::RoadmapGround;
use crate::{
    drive::{DriveLimit, DriveRefusalCounts},
    planner::Amounts,
};

/// Start and goal, from and to which every node is tried, however far away.
const ENDS: usize = 2;

/// The straight lines between nodes that a machine walks. Each node is joined to so many of its nearest when it is added, and to start and goal: a
/// line is found once and stays.
#[derive(Clone, Debug, Default)]
pub struct RoadmapWalks {
    /// Of each node, where they lead and what they take; empty where the machine does not walk.
    from: Vec<Vec<(usize, Amounts)>>,
    tested: u64,
    refusals: DriveRefusalCounts,
}

impl RoadmapWalks {
    /// The lines out of a node: where they lead, and what they take.
    pub fn of(&self, node: usize) -> &[(usize, Amounts)] {
        self.from.get(node).map_or(&[], Vec::as_slice)
    }

    /// Whether the machine walks at all.
    pub const fn are_looked_for(&self) -> bool {
        !self.from.is_empty()
    }

    /// How many lines were tested.
    pub const fn tested(&self) -> u64 {
        self.tested
    }

    /// The limits that refuse lines that were tested.
    pub const fn refusals(&self) -> &DriveRefusalCounts {
        &self.refusals
    }

    /// Where the lines out of each node lead, or those into each node come from.
    pub(super) fn towards(&self, towards: Towards) -> Vec<Vec<usize>> {
        let mut ends = vec![Vec::new(); self.from.len()];
        for (from, lines) in self.from.iter().enumerate() {
            for (to, _) in lines {
                match towards {
                    Towards::Outgoing => ends[from].push(*to),
                    Towards::Incoming => ends[*to].push(from),
                }
            }
        }
        ends
    }

    /// Tests the lines between new nodes and those nearest to them, both ways.
    ///
    /// # Complexity
    /// A distance for every pair with a new node, and two lines for each new node and each neighbour.
    pub(super) fn extend<'n, G: RoadmapGround<Node: 'n>>(
        &mut self,
        ground: &G,
        node: &(dyn Fn(usize) -> &'n G::Node + Sync),
        new: Range<usize>,
    ) {
        let neighbours = ground.walk_neighbours();
        if neighbours == 0 {
            return;
        }
        let all = new.end;
        self.from.resize_with(all, Vec::new);
        let places: Vec<_> = (0..all).map(|number| ground.point_m(node(number)).xy()).collect();
        let nearest = |of: usize| {
            let mut others: Vec<(f64, usize)> =
                (0..all).filter(|other| *other != of).map(|other| ((places[other] - places[of]).norm_squared(), other)).collect();
            others.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let near = others.into_iter().take(neighbours).map(|(_, other)| other);
            near.chain((0..ENDS.min(all)).filter(|end| *end != of)).map(|other| [of.min(other), of.max(other)]).collect::<Vec<_>>()
        };
        let pairs: BTreeSet<[usize; 2]> = new.into_par_iter().flat_map_iter(nearest).collect();
        let lines: Vec<[usize; 2]> = pairs.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]).collect();
        let walked: Vec<Result<Amounts, DriveLimit>> =
            lines.par_iter().map(|[from, to]| ground.walk(node(*from), node(*to))).collect();
        for ([from, to], found) in lines.into_iter().zip(walked) {
            self.tested += 1;
            match found {
                Ok(amounts) => self.from[from].push((to, amounts)),
                Err(limit) => self.refusals.count(limit),
            }
        }
    }
}
