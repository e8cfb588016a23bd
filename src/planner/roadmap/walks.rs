//! The straight lines that a machine walks between the nodes of a roadmap.

use std::{collections::BTreeSet, ops::Range};

use petgraph::Direction as Towards;
use rayon::prelude::*;

use super::RoadmapGround;
use crate::{
    drive::{DriveLimit, DriveRefusalCounts},
    planner::Amounts,
    progress::{Cancelled, Meter},
};

/// Start and goal, from and to which every node is tried, however far away.
const ENDS: usize = 2;

/// A line from one node to another, and what it takes or which limit refuses it.
type Line = ([usize; 2], Result<Amounts, DriveLimit>);

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

    /// The lines between new nodes and those nearest to them, both ways; `None` where the machine hops alone.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Complexity
    /// A distance for every pair with a new node, and two lines for each new node and each neighbour.
    pub(super) fn found<'n, G: RoadmapGround<Node: 'n>>(
        ground: &G,
        node: &(dyn Fn(usize) -> &'n G::Node + Sync),
        new: Range<usize>,
        meter: &Meter<'_>,
    ) -> Result<Option<Vec<Line>>, Cancelled> {
        let neighbours = ground.walk_neighbours();
        if neighbours == 0 {
            return Ok(None);
        }
        let all = new.end;
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
        let walked = |ends: &[usize; 2]| {
            meter.check()?;
            Ok((*ends, ground.walk(node(ends[0]), node(ends[1]))))
        };
        lines.par_iter().map(walked).collect::<Result<_, Cancelled>>().map(Some)
    }

    /// Adds lines that were found among so many nodes.
    pub(super) fn add(&mut self, nodes: usize, lines: Option<Vec<Line>>) {
        let Some(lines) = lines else { return };
        self.from.resize_with(nodes, Vec::new);
        self.tested += lines.len() as u64;
        for ([from, to], found) in lines {
            match found {
                Ok(amounts) => self.from[from].push((to, amounts)),
                Err(limit) => self.refusals.count(limit),
            }
        }
    }
}
