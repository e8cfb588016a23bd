//! What the trials of a journey replan by.

use std::sync::{Arc, OnceLock};

use crate::graph::{Corridor, CostToGo};

/// The weights or costs of the rest of a path, by which its trials replan.
#[derive(Clone, Debug)]
pub(super) enum ToGo {
    /// Of the nodes of a chain.
    Line(Arc<CostToGo>),
    /// Of the nodes of a transect and the places on its DEM beside it.
    Corridor(Arc<Corridor>),
}

/// What trials of the paths of a journey may replan by, with as many hops as the scenario allows. A clone shares it.
#[derive(Clone, Debug)]
pub(super) struct Replanning {
    /// Over the nodes of the chain.
    pub(super) line: Arc<CostToGo>,
    /// Over places beside the line too, one corridor for each kind of [`Beside::ALL`](crate::graph::Beside::ALL), computed when it is first
    /// needed; `None` where the robot does not leave the line.
    pub(super) beside: Arc<[OnceLock<Option<Corridor>>; 2]>,
}

impl Replanning {
    pub(super) fn new(line: CostToGo) -> Self {
        Self { line: Arc::new(line), beside: Arc::default() }
    }

    /// Over the nodes of the chain, for a path of this many hops.
    pub(super) fn along_line(&self, hops: Option<u64>) -> ToGo {
        ToGo::Line(hops.map_or_else(|| Arc::clone(&self.line), |hops| Arc::new(self.line.with_hops(hops))))
    }
}
