//! Why no hop begins or ends at nodes of a map.

use rayon::prelude::*;

use crate::{
    chain::FootprintRefusal,
    reach::map::{PostHops, PostRefusal},
    world::LayerName,
};

/// What refuses every contact at a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeRefusal {
    /// A keep-out zone, or the lack of a keep-in zone.
    Zone,
    /// A slope, of the ground or of the plane under the footprint.
    TooSteep,
    /// The ground under the footprint: too rough, or in part not known.
    Footprint,
    /// A layer of the map.
    Layer(LayerName),
}

impl NodeRefusal {
    /// That of a post; `None` where there is no ground.
    const fn of(refusal: &PostRefusal) -> Option<Self> {
        Some(match refusal {
            PostRefusal::NoGround => return None,
            PostRefusal::KeptOut => Self::Zone,
            PostRefusal::Layer(layer) => Self::Layer(*layer),
            PostRefusal::TooSteep { .. } | PostRefusal::Footprint(FootprintRefusal::TooSteep { .. }) => Self::TooSteep,
            PostRefusal::Footprint(FootprintRefusal::TooRough { .. } | FootprintRefusal::Unknown { .. }) => Self::Footprint,
        })
    }

    /// The reason in a legend.
    pub fn words(&self) -> String {
        match self {
            Self::Zone => "keep-out".to_owned(),
            Self::TooSteep => "too steep to rest on".to_owned(),
            Self::Footprint => "too rough or not known under the footprint".to_owned(),
            Self::Layer(layer) => format!("layer {layer} does not hold"),
        }
    }
}

/// The nodes at which no hop begins or ends in any direction, for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RefusedNodes {
    /// The reason.
    pub by: NodeRefusal,
    /// Whether it is that of each node, row by row from the north-west.
    pub nodes: Vec<bool>,
}

/// The nodes that refuse every contact, by reason; each node has the first of its reasons, in the order of [`PostHops::refusal`].
pub(super) fn refused_nodes(hops: &PostHops) -> Vec<RefusedNodes> {
    let lattice = hops.lattice();
    let refusal = |node| hops.refusal(lattice.node(node)).as_ref().and_then(NodeRefusal::of);
    let refusals: Vec<Option<NodeRefusal>> = (0..lattice.count()).into_par_iter().map(refusal).collect();
    let mut found: Vec<RefusedNodes> = Vec::new();
    for (node, by) in refusals.iter().enumerate().filter_map(|(node, by)| Some((node, (*by)?))) {
        let place = found.iter().position(|refused| refused.by == by).unwrap_or_else(|| {
            found.push(RefusedNodes { by, nodes: vec![false; lattice.count()] });
            found.len() - 1
        });
        found[place].nodes[node] = true;
    }
    found.sort_by_key(|refused| match refused.by {
        NodeRefusal::TooSteep => (0, String::new()),
        NodeRefusal::Footprint => (1, String::new()),
        NodeRefusal::Zone => (2, String::new()),
        NodeRefusal::Layer(layer) => (3, layer.to_string()),
    });
    found
}
