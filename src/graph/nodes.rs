//! The points of the chain between which hops are tried.

use crate::{
    chain::{ConstrainedChain, Station},
    quantity::{NodeId, VertexId},
};

/// How densely the segments are filled with points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointSpacing {
    /// This many equidistant points inside each segment: the paper's k.
    PerSegment(u32),
    /// As many on each segment as keep neighbours on it no farther apart than this along the ground, m.
    AtMostM(f64),
}

/// More nodes than fit the memory this program allows itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{nodes} nodes, expected at most {}: choose fewer points per segment or a wider node spacing", NodeSet::MAX_NODES)]
pub struct TooManyNodes {
    /// How many there would be.
    pub nodes: u64,
}

/// The nodes of a hop graph, from left to right, no two at the same x.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeSet {
    stations: Vec<Station>,
    start: NodeId,
    goal: NodeId,
    most_per_segment: u32,
}

impl NodeSet {
    /// The largest set: some 100 bytes a node in nodes and search, so 2 GB.
    pub const MAX_NODES: u64 = 20_000_000;

    /// All vertices, equidistant points inside each segment, start and goal (P section IV-B).
    ///
    /// # Errors
    /// [`TooManyNodes`] above [`NodeSet::MAX_NODES`].
    pub fn new(chain: &ConstrainedChain, start: Station, goal: Station, spacing: PointSpacing) -> Result<Self, TooManyNodes> {
        let geometry = chain.geometry();
        let counts: Vec<u64> = geometry
            .vertices()
            .windows(2)
            .map(|pair| match spacing {
                PointSpacing::PerSegment(k) => u64::from(k),
                PointSpacing::AtMostM(spacing_m) => {
                    points_needed(libm::hypot(pair[1].x_m - pair[0].x_m, pair[1].z_m - pair[0].z_m), spacing_m)
                }
            })
            .collect();
        let nodes = counts.iter().fold(geometry.vertices().len() as u64 + 2, |sum, &k| sum.saturating_add(k));
        if nodes > Self::MAX_NODES {
            return Err(TooManyNodes { nodes });
        }
        let mut stations = Vec::with_capacity(usize::try_from(nodes).unwrap_or(0));
        for (i, (pair, &k)) in geometry.vertices().windows(2).zip(&counts).enumerate() {
            stations.push(geometry.vertex_station(VertexId(i)));
            for j in 1..=k {
                #[expect(clippy::cast_precision_loss, reason = "fewer points than 2^53")]
                let fraction = j as f64 / (k + 1) as f64;
                let x_m = pair[0].x_m + (pair[1].x_m - pair[0].x_m) * fraction;
                stations.extend(geometry.station(x_m));
            }
        }
        stations.push(geometry.vertex_station(VertexId(geometry.segment_count())));
        stations.extend([start, goal]);
        stations.sort_by(|a, b| a.point.x_m.total_cmp(&b.point.x_m));
        // The same x is the same place; segments too short for their points fold them together.
        stations.dedup_by(|a, b| a.point.x_m == b.point.x_m);
        let at = |station: &Station| NodeId(stations.partition_point(|s| s.point.x_m < station.point.x_m));
        let (start, goal) = (at(&start), at(&goal));
        let most = counts.iter().copied().max().unwrap_or(0);
        Ok(Self { stations, start, goal, most_per_segment: u32::try_from(most).unwrap_or(u32::MAX) })
    }

    /// The stations of all nodes, from left to right.
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// The station of one node.
    ///
    /// # Panics
    /// Where there is no such node.
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

    /// The nodes whose x lies within `distance_m` of a station's.
    pub fn within(&self, station: &Station, distance_m: f64) -> std::ops::Range<usize> {
        let (low, high) = (station.point.x_m - distance_m, station.point.x_m + distance_m);
        let first = self.stations.partition_point(|s| s.point.x_m < low);
        let end = self.stations.partition_point(|s| s.point.x_m <= high);
        first..end.max(first)
    }

    /// The nodes within a distance of a station, or on a segment that it lies on.
    pub fn around(&self, station: &Station, distance_m: f64) -> std::ops::Range<usize> {
        let mut range = self.within(station, distance_m);
        let shares = |other: &Station| other.shared_segment(station).is_some();
        while range.start > 0 && shares(&self.stations[range.start - 1]) {
            range.start -= 1;
        }
        while range.end < self.stations.len() && shares(&self.stations[range.end]) {
            range.end += 1;
        }
        range
    }
}

/// Points inside a stretch so that neighbours are no farther apart than the spacing.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, and is refused above MAX_NODES")]
fn points_needed(length_m: f64, spacing_m: f64) -> u64 {
    ((length_m / spacing_m).ceil() - 1.0).max(0.0) as u64
}
