//! The points of the chain between which hops are tested.

use std::{ops::Range, sync::Arc};

use crate::{
    chain::{ConstrainedChain, Station},
    quantity::{ChainPoint, NodeId, SegmentId, VertexId},
};

/// How densely the segments are filled with points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointSpacing {
    /// This many equidistant points inside each segment: k in the CHTA paper.
    PerSegment(u32),
    /// On each segment, as many equidistant points as keep neighbours at most this far apart along the ground, m.
    AtMostM(f64),
}

/// Why a spacing gives no nodes.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NodesError {
    /// More nodes than the program's memory limit allows.
    #[error("{nodes} nodes, expected at most {}: choose fewer points per segment or a wider node spacing", NodeSet::MAX_NODES)]
    TooMany {
        /// The number of nodes requested.
        nodes: u64,
    },
    /// A spacing that is no distance.
    #[error(
        "the node spacing is {found_m} m, expected a number above 0: give node_spacing_max_m the greatest distance of neighbours"
    )]
    Spacing {
        /// What was given, m.
        found_m: f64,
    },
}

/// The nodes of a hop graph, from left to right, no two at the same x. Clones share the stations.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeSet {
    stations: Arc<[Station]>,
    start: NodeId,
    goal: NodeId,
    most_per_segment: u32,
}

impl NodeSet {
    /// The largest set: with some 150 bytes per node for nodes, landings and search it takes 3 GB.
    pub const MAX_NODES: u64 = 20_000_000;

    /// All vertices, equidistant points inside each segment, start and goal (P section IV-B).
    ///
    /// # Errors
    /// [`NodesError`]: more than [`NodeSet::MAX_NODES`], or a spacing that is no distance.
    pub fn new(chain: &ConstrainedChain, start: Station, goal: Station, spacing: PointSpacing) -> Result<Self, NodesError> {
        let (mut stations, most_per_segment) = stations_of(chain, spacing)?;
        insert(&mut stations, start);
        insert(&mut stations, goal);
        let (start, goal) = (first_from(&stations, &start), first_from(&stations, &goal));
        Ok(Self { stations: stations.into(), start: NodeId(start), goal: NodeId(goal), most_per_segment })
    }

    /// All vertices and equidistant points inside each segment: the nodes that all searches over a chain share. Its start is
    /// the first vertex and its goal the last.
    ///
    /// # Errors
    /// [`NodesError`]: more than [`NodeSet::MAX_NODES`], or a spacing that is no distance, including a separate start and goal.
    pub fn of_chain(chain: &ConstrainedChain, spacing: PointSpacing) -> Result<Self, NodesError> {
        let (stations, most_per_segment) = stations_of(chain, spacing)?;
        let goal = NodeId(stations.len() - 1);
        Ok(Self { stations: stations.into(), start: NodeId(0), goal, most_per_segment })
    }

    /// The node at a station's x; `None` if no node lies there.
    pub fn find(&self, station: &Station) -> Option<NodeId> {
        let at = first_from(&self.stations, station);
        self.stations.get(at).is_some_and(|s| s.point.x_m == station.point.x_m).then_some(NodeId(at))
    }

    /// The stations of all nodes, from left to right.
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// The stations of all nodes, as a shared pointer.
    pub fn shared_stations(&self) -> Arc<[Station]> {
        Arc::clone(&self.stations)
    }

    /// The station of one node.
    ///
    /// # Panics
    /// Panics if there is no such node.
    #[inline]
    pub fn station(&self, node: NodeId) -> &Station {
        &self.stations[node.index()]
    }

    /// The start.
    pub const fn start(&self) -> NodeId {
        self.start
    }

    /// The goal.
    pub const fn goal(&self) -> NodeId {
        self.goal
    }

    /// The greatest number of points inside one segment.
    pub const fn most_per_segment(&self) -> u32 {
        self.most_per_segment
    }

    /// The nodes whose x lies within `distance_m` of a station.
    pub fn within(&self, station: &Station, distance_m: f64) -> Range<usize> {
        within(&self.stations, station, distance_m)
    }
}

/// All vertices and equidistant points inside each segment, and the greatest number of points inside one segment.
fn stations_of(chain: &ConstrainedChain, spacing: PointSpacing) -> Result<(Vec<Station>, u32), NodesError> {
    if let PointSpacing::AtMostM(found_m) = spacing
        && (found_m.is_nan() || found_m <= 0.0)
    {
        return Err(NodesError::Spacing { found_m });
    }
    let geometry = chain.geometry();
    let inside = |pair: &[ChainPoint]| match spacing {
        PointSpacing::PerSegment(k) => u64::from(k),
        PointSpacing::AtMostM(spacing_m) => {
            points_needed(libm::hypot(pair[1].x_m - pair[0].x_m, pair[1].z_m - pair[0].z_m), spacing_m)
        }
    };
    let segments = || geometry.vertices().windows(2);
    let nodes = segments().map(inside).fold(geometry.vertices().len() as u64 + 2, u64::saturating_add);
    if nodes > NodeSet::MAX_NODES {
        return Err(NodesError::TooMany { nodes });
    }
    let mut stations: Vec<Station> = Vec::with_capacity(usize::try_from(nodes).unwrap_or(0));
    let mut most = 0;
    for (i, pair) in segments().enumerate() {
        let k = inside(pair);
        most = most.max(k);
        stations.push(geometry.vertex_station(VertexId(i)));
        for j in 1..=k {
            #[expect(clippy::cast_precision_loss, reason = "fewer points than 2^53")]
            let fraction = j as f64 / (k + 1) as f64;
            let x_m = pair[0].x_m + (pair[1].x_m - pair[0].x_m) * fraction;
            // On very short segments several points may round to the same x.
            if stations.last().is_some_and(|last| last.point.x_m < x_m) && x_m < pair[1].x_m {
                stations.push(geometry.station_inside(SegmentId(i), x_m));
            }
        }
    }
    stations.push(geometry.vertex_station(VertexId(geometry.segment_count())));
    Ok((stations, u32::try_from(most).unwrap_or(u32::MAX)))
}

/// Inserts a station unless there is one at its x: equal x means the same position.
fn insert(stations: &mut Vec<Station>, station: Station) {
    let at = first_from(stations, &station);
    if stations.get(at).is_none_or(|s| s.point.x_m != station.point.x_m) {
        stations.insert(at, station);
    }
}

/// The first of `stations` (sorted by x) at a station's x or beyond.
fn first_from(stations: &[Station], station: &Station) -> usize {
    stations.partition_point(|s| s.point.x_m < station.point.x_m)
}

/// The sub-range of `stations` (sorted by x) whose x lies within `distance_m` of `station`.
fn within(stations: &[Station], station: &Station, distance_m: f64) -> Range<usize> {
    let (low, high) = (station.point.x_m - distance_m, station.point.x_m + distance_m);
    let first = stations.partition_point(|s| s.point.x_m < low);
    let end = stations.partition_point(|s| s.point.x_m <= high);
    first..end.max(first)
}

/// The sub-range of `stations` (sorted by x) within `distance_m` of `station` or on one of its segments. With the reach of
/// one hop as distance, it contains all stations that a hop, or hops along a segment, can join to it.
pub(super) fn around(stations: &[Station], station: &Station, distance_m: f64) -> Range<usize> {
    let mut range = within(stations, station, distance_m);
    while range.start > 0 && stations[range.start - 1].shared_segment(station).is_some() {
        range.start -= 1;
    }
    while range.end < stations.len() && stations[range.end].shared_segment(station).is_some() {
        range.end += 1;
    }
    range
}

/// The number of points inside a stretch that keeps neighbours at most the spacing apart.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is refused above MAX_NODES")]
fn points_needed(length_m: f64, spacing_m: f64) -> u64 {
    ((length_m / spacing_m).ceil() - 1.0).max(0.0) as u64
}
