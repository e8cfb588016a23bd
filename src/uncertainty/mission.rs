//! A planned journey and the ground under it.

use std::sync::Arc;

use crate::{
    chain::Station,
    graph::CostToGo,
    ground::{ChainGround, ContactPoint, DemGround, Surface},
    hop::HopTest,
    path::HopPath,
};

/// A planned journey and the ground under it. It owns or shares all its data.
///
/// It does not depend on how the path was found: any planner whose result is a [`HopPath`] can be simulated.
#[derive(Clone, Debug)]
pub struct Mission {
    pub(super) ground: MissionGround,
    pub(super) path: HopPath,
    pub(super) start: ContactPoint,
    pub(super) goal: ContactPoint,
    pub(super) replanning: Option<Replanning>,
}

/// The ground of the trials.
#[derive(Clone, Debug)]
pub(super) enum MissionGround {
    Chain(ChainGround),
    Map(DemGround),
}

/// The data for replanning: the chain of the nodes, and the cost-to-go of each node.
#[derive(Clone, Debug)]
pub(super) struct Replanning {
    pub(super) test: HopTest,
    pub(super) to_go: Arc<CostToGo>,
}

impl Mission {
    /// A path along a chain: flights stay in its vertical plane.
    pub fn along_chain(test: HopTest, path: HopPath, start: Station, goal: Station) -> Self {
        let [start, goal] = [start, goal].map(|station| test.chain().contact_point(&station));
        Self { ground: MissionGround::Chain(ChainGround::new(test)), path, start, goal, replanning: None }
    }

    /// A path over a DEM, in any direction: flights follow their heading.
    pub const fn over_dem(ground: DemGround, path: HopPath, start: ContactPoint, goal: ContactPoint) -> Self {
        Self { ground: MissionGround::Map(ground), path, start, goal, replanning: None }
    }

    /// The same mission, whose trials may also be replanned over nodes of this chain.
    #[must_use]
    pub fn with_replanning(self, test: HopTest, to_go: Arc<CostToGo>) -> Self {
        Self { replanning: Some(Replanning { test, to_go }), ..self }
    }
}
