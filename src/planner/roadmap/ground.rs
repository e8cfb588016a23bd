//! What a roadmap asks of its ground: nodes, and every window of the hop between two of them.

use std::fmt;

use nalgebra::Point3;

use super::DrawnContacts;
use crate::{
    ballistics::{FlightEnvelope, LineOfSight, PathBounds},
    drive::DriveLimit,
    ground::{MeshBuffers, MeshContact, MeshGround},
    planner::{Amounts, LeastAmounts},
    quantity::SlopeInterval,
    world::Limit,
};

/// A ground over whose nodes a roadmap is built: the contacts of a mesh, or the stances of a robot with legs.
pub trait RoadmapGround: Sync {
    /// A place where hops begin and end.
    type Node: Clone + fmt::Debug + Send + Sync;
    /// Buffers of the windows of one hop after another.
    type Buffers: Default + Send;

    /// Where the hopper is at a node, m: the point that flies the arcs.
    fn point_m(&self, node: &Self::Node) -> Point3<f64>;

    /// The limits of a flight.
    fn envelope(&self) -> &FlightEnvelope;

    /// Lower bounds on paths from the greatest speeds alone.
    fn speed_bounds(&self) -> PathBounds;

    /// From the lowest to the highest place of the ground, m.
    fn relief_m(&self) -> f64;

    /// Whether no hop is needed from one node to another.
    fn are_one_place(&self, nodes: [&Self::Node; 2]) -> bool;

    /// The line of sight of a hop; `None` if it is vertical.
    fn sight(&self, takeoff: &Self::Node, landing: &Self::Node) -> Option<LineOfSight>;

    /// The feasible windows of a hop as lofts over its line of sight, ascending and disjoint; none if no arc is feasible, and `None` for a
    /// vertical hop.
    fn windows<'b>(
        &self,
        takeoff: &Self::Node,
        landing: &Self::Node,
        buffers: &'b mut Self::Buffers,
    ) -> Option<(LineOfSight, &'b [SlopeInterval])>;

    /// Why no arc is feasible; `None` if one is, or if the hop is vertical.
    fn refused_by(&self, takeoff: &Self::Node, landing: &Self::Node) -> Option<Limit>;

    /// To how many of its nearest nodes the machine may walk from a node; 0: it hops alone.
    fn walk_neighbours(&self) -> usize {
        0
    }

    /// What walking straight from one node to another takes, where the machine walks.
    ///
    /// # Errors
    /// The limit that refuses it.
    fn walk(&self, _from: &Self::Node, _to: &Self::Node) -> Result<Amounts, DriveLimit> {
        Err(DriveLimit::Ground)
    }

    /// Lower bounds on what a hop takes.
    fn least_amounts(&self) -> LeastAmounts {
        let envelope = self.envelope();
        let limits = envelope.hopper().limits();
        let speeds_m_s = (limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s());
        LeastAmounts::new(limits, envelope.gravity_m_s2(), speeds_m_s, self.relief_m())
    }
}

/// Draws the nodes of a roadmap, the same for the same seed.
pub trait RoadmapSampler<N> {
    /// So many nodes all over the ground, of those that are useful; fewer where few are found.
    fn all_over(&mut self, count: usize, is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync)) -> Vec<N>;

    /// So many nodes about some points, of those that are useful; fewer where few are found.
    fn about(
        &mut self,
        points: &[Point3<f64>],
        radius_m: f64,
        count: usize,
        is_useful: &(dyn Fn(&Point3<f64>) -> bool + Sync),
    ) -> Vec<N>;

    /// How many were drawn, and left out, so far.
    fn drawn(&self) -> DrawnContacts;
}

impl RoadmapGround for MeshGround {
    type Node = MeshContact;
    type Buffers = MeshBuffers;

    fn point_m(&self, contact: &MeshContact) -> Point3<f64> {
        contact.point_m()
    }

    fn envelope(&self) -> &FlightEnvelope {
        self.envelope()
    }

    fn speed_bounds(&self) -> PathBounds {
        self.speed_bounds()
    }

    fn relief_m(&self) -> f64 {
        let bounds = self.tree().mesh().bounds();
        bounds.high_m - bounds.low_m
    }

    fn are_one_place(&self, contacts: [&MeshContact; 2]) -> bool {
        self.are_one_place(contacts)
    }

    fn sight(&self, takeoff: &MeshContact, landing: &MeshContact) -> Option<LineOfSight> {
        Some(self.course(takeoff, landing)?.sight)
    }

    fn windows<'b>(
        &self,
        takeoff: &MeshContact,
        landing: &MeshContact,
        buffers: &'b mut MeshBuffers,
    ) -> Option<(LineOfSight, &'b [SlopeInterval])> {
        self.windows(takeoff, landing, buffers)
    }

    fn refused_by(&self, takeoff: &MeshContact, landing: &MeshContact) -> Option<Limit> {
        Some(self.takeoff_set(takeoff, landing)?.conflict()?.counted_under())
    }
}
