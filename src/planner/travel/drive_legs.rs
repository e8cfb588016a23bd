//! Straight drive legs between the nodes of a DEM.

use nalgebra::Vector2;

use super::super::{Amount, Amounts, SurfaceNode, SurfaceNodes};
use crate::{
    drive::{DriveEdges, DriveGround, DriveLeg, DriveRefusal},
    ground::MapPosition,
    quantity::MapPoint,
    world::Rover,
};

/// A node off the lattice is joined to those of the lattice within this many spacings.
const JOINED_SPACINGS: f64 = 2.0;

/// The straight legs that a rover may drive between nodes.
#[derive(Debug)]
pub(super) struct DriveLegs<'a> {
    drive: &'a DriveGround<'a>,
    nodes: &'a SurfaceNodes,
    /// The legs between all posts, judged beforehand, where the nodes of the lattice are the posts.
    edges: Option<&'a DriveEdges<'a>>,
    /// The neighbours of a node, in columns and rows.
    offsets: Vec<(isize, isize)>,
    /// Their directions, unit vectors to the east and the north.
    headings: Vec<Vector2<f64>>,
    /// Their horizontal lengths, m.
    runs_m: Vec<f64>,
    join_m: f64,
}

/// The direction in which a leg arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arrival {
    /// That of a neighbour, by its number.
    Neighbour(usize),
    /// To or from a place beside the lattice.
    Joined,
}

impl<'a> DriveLegs<'a> {
    pub(super) fn new(drive: &'a DriveGround<'a>, nodes: &'a SurfaceNodes, edges: Option<&'a DriveEdges<'a>>) -> Self {
        let (aside_m, down_m) = nodes.lattice().spacings_m();
        let offsets = drive.rover().limits().neighbours.offsets();
        let along = |&(east, north): &(i32, i32)| Vector2::new(f64::from(east) * aside_m, f64::from(north) * down_m);
        Self {
            drive,
            nodes,
            edges,
            headings: offsets.iter().map(|offset| along(offset).normalize()).collect(),
            runs_m: offsets.iter().map(|offset| along(offset).norm()).collect(),
            // Rows count southwards.
            offsets: offsets.into_iter().map(|(east, north)| (east as isize, -north as isize)).collect(),
            join_m: JOINED_SPACINGS * nodes.lattice().spacing_m(),
        }
    }

    pub(super) const fn rover(&self) -> &'a Rover {
        self.drive.rover()
    }

    /// How many neighbours a node has.
    pub(super) const fn directions(&self) -> usize {
        self.headings.len()
    }

    /// The direction of a neighbour, a unit vector.
    pub(super) fn heading(&self, direction: usize) -> Vector2<f64> {
        self.headings[direction]
    }

    pub(super) fn position(&self, node: SurfaceNode) -> Option<MapPosition> {
        self.nodes.position(self.drive.ground(), node)
    }

    /// The nodes that a straight leg may lead to; the same ones from which it may lead here.
    pub(super) fn about(&self, node: SurfaceNode, at: MapPoint) -> impl Iterator<Item = (SurfaceNode, Arrival)> + '_ {
        let neighbours = self.neighbours(node).map(|(direction, other)| (other, Arrival::Neighbour(direction)));
        neighbours.chain(self.joined(node, at).map(|other| (other, Arrival::Joined)))
    }

    /// The legs between all posts, and the number of a node among them; `None` for a place beside the lattice, and where they are not judged
    /// beforehand.
    pub(super) fn edges_of(&self, node: SurfaceNode) -> Option<(&'a DriveEdges<'a>, usize)> {
        self.edges.filter(|_| self.nodes.of_lattice(node).is_some()).map(|edges| (edges, node.index()))
    }

    /// The neighbours of a node of the lattice, by direction.
    pub(super) fn neighbours(&self, node: SurfaceNode) -> impl Iterator<Item = (usize, SurfaceNode)> + '_ {
        let lattice = self.nodes.lattice();
        let (rows, cols) = lattice.size();
        self.nodes.of_lattice(node).into_iter().flat_map(move |(i, j)| {
            self.offsets.iter().enumerate().filter_map(move |(direction, &(aside, down))| {
                let (i, j) = (i.checked_add_signed(aside)?, j.checked_add_signed(down)?);
                (i < cols && j < rows).then(|| (direction, SurfaceNode::of_lattice(lattice, (i, j))))
            })
        })
    }

    /// The places to which a straight leg may lead from a node of the lattice beside its neighbours, or all nodes about a place beside it.
    pub(super) fn joined(&self, node: SurfaceNode, at: MapPoint) -> impl Iterator<Item = SurfaceNode> + '_ {
        let lattice = self.nodes.lattice();
        let near = self.nodes.of_lattice(node).is_none().then(|| lattice.about(at, self.join_m));
        let of_lattice = near.into_iter().flatten().map(|cell| SurfaceNode::of_lattice(lattice, cell));
        of_lattice.chain(self.nodes.places_about(at, self.join_m)).filter(move |other| *other != node)
    }

    /// The horizontal length of a leg to a neighbour, m.
    pub(super) fn run_m(&self, direction: usize) -> f64 {
        self.runs_m[direction]
    }

    /// A leg between two places.
    pub(super) fn leg(&self, from: &MapPosition, to: &MapPosition) -> Result<DriveLeg, DriveRefusal> {
        self.drive.leg(from, to)
    }

    /// What no leg of this horizontal length takes less of, with a turn of so many seconds before it.
    pub(super) fn least(&self, run_m: f64, turn_s: f64) -> Amounts {
        /// Rounding errors are far smaller than this share.
        const SHAVED: f64 = 1.0 - 1e-9;
        let time_s = run_m / self.rover().limits().speed_m_s + turn_s;
        Amounts::NONE.with(Amount::Distance, run_m * SHAVED).with(Amount::MissionTime, time_s * SHAVED)
    }

    /// The time to turn from one direction to another, both unit vectors, s.
    pub(super) fn turn_s(&self, from: &Vector2<f64>, to: &Vector2<f64>) -> f64 {
        let angle = libm::atan2(from.perp(to).abs(), from.dot(to));
        self.rover().limits().turn_s_per_deg * angle.to_degrees()
    }
}

/// What a drive leg takes, with a turn of so many seconds before it.
///
/// ```text
///     mission time = time of the leg + turn,   energy = that of the leg + idle power per unit mass * turn,
///     risk = failures per metre * length in three dimensions, the negative logarithm of the probability to arrive
/// ```
pub(crate) fn drive_amounts(rover: &Rover, leg: &DriveLeg, turn_s: f64) -> Amounts {
    Amounts::NONE
        .with(Amount::MissionTime, leg.time_s + turn_s)
        .with(Amount::Energy, leg.energy_j_kg + rover.idle_j_kg_s() * turn_s)
        .with(Amount::Distance, leg.run_m)
        .with(Amount::Risk, rover.limits().failure_per_m * leg.length_m)
}
