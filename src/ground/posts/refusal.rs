//! Why no hop begins or ends at a post, in any direction.

use std::fmt;

use super::{Post, PostHops, overlays::OverlayTable};
use crate::{
    chain::FootprintRefusal,
    ground::DemGround,
    quantity::Angle,
    world::{FrictionCone, LayerName, RestSlope},
};

/// Why no hop begins or ends at a post.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PostRefusal {
    /// The post or everything around it has no elevation.
    NoGround,
    /// Inside a keep-out zone.
    KeptOut,
    /// A layer of the map does not hold there.
    Layer(LayerName),
    /// All its facets are too steep to rest on.
    TooSteep {
        /// The slope of the least steep facet.
        slope: Angle,
        /// The steepest slope to rest on there.
        rest_slope: Angle,
    },
    /// The ground under the hopper's footprint is too steep, too rough or not known.
    Footprint(FootprintRefusal),
}

impl fmt::Display for PostRefusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoGround => write!(formatter, "has no elevation around it"),
            Self::KeptOut => write!(formatter, "lies in a keep-out zone"),
            Self::Layer(layer) => write!(formatter, "is refused by the layer {layer}"),
            Self::Footprint(refusal) => write!(formatter, "is refused: {refusal}"),
            Self::TooSteep { slope, rest_slope } => {
                let (slope_deg, rest_deg) = (slope.degrees(), rest_slope.degrees());
                write!(
                    formatter,
                    "slopes {slope_deg:.1} deg or more to all sides, too steep to rest on, which ends at {rest_deg:.1} deg"
                )
            }
        }
    }
}

/// The tangent of the steepest slope to rest on at a post; `None` if every slope holds.
pub(super) fn rest_tangent(ground: &DemGround, overlays: Option<&OverlayTable>, post: usize) -> Option<f64> {
    match ground.surface().rest {
        RestSlope::AsFrictionHolds => {
            overlays.and_then(|overlays| overlays.friction(post)).or(ground.constant_friction().map(FrictionCone::coefficient))
        }
        RestSlope::AtMost(angle) => Some(angle.slope()),
        RestSlope::Unlimited => None,
    }
}

impl PostHops {
    /// Why no hop begins or ends at a node in any direction; `None` if ground and zones allow some.
    pub fn refusal(&self, node: Post) -> Option<PostRefusal> {
        let place = self.lattice.at(self.ground.terrain().dem().georeference(), node);
        if self.ground.terrain().overlays().keeps_out(place) {
            return Some(PostRefusal::KeptOut);
        }
        if let Some(layer) = self.ground.terrain().overlays().layers().refusing_contact(place) {
            return Some(PostRefusal::Layer(layer));
        }
        if self.usable(node) {
            return None;
        }
        let index = self.lattice.raster_index(node);
        let rest = rest_tangent(&self.ground, self.overlays.as_ref(), index);
        if self.never_stands(node)
            && let Some(refusal) = self.position(node).and_then(|position| self.ground.footprint_against(&position, rest))
        {
            return Some(PostRefusal::Footprint(refusal));
        }
        let heights = self.heights();
        let mildest = (0..6)
            .filter(|&facet| self.facets.has(index, facet))
            .map(|facet| heights.gradient(index, facet))
            .map(|(east, north)| libm::hypot(east, north))
            .fold(f64::INFINITY, f64::min);
        Some(match rest.filter(|_| mildest.is_finite()) {
            Some(rest) => PostRefusal::TooSteep { slope: Angle::from_slope(mildest), rest_slope: Angle::from_slope(rest) },
            None => PostRefusal::NoGround,
        })
    }

    /// The nearest node with neither refusal; ties go to the north and west. `None` if all refuse.
    pub fn nearest_usable(&self, node: Post) -> Option<Post> {
        let place = |node: Post| self.lattice.at(self.ground.terrain().dem().georeference(), node);
        let away2 = |other: &Post| (place(*other) - place(node)).norm_squared();
        let usable = (0..self.lattice.count()).map(|index| self.lattice.node(index)).filter(|&other| self.usable(other));
        let mut candidates: Vec<(f64, Post)> = usable.map(|other| (away2(&other), other)).collect();
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        candidates.into_iter().map(|(_, other)| other).find(|&other| self.refusal(other).is_none())
    }
}
