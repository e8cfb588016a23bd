//! Ground that is not reached, by its reason: pale, under a pattern that tells it from the bands and from bare hillshade in a print in grey.

use plotters::style::RGBColor;

use super::{super::keys::Swatch, data::RefusedPosts, raster::Pattern};

/// Posts that are not reached: grey, which is not a colour of any band.
pub(super) const NOT_REACHED: RGBColor = RGBColor(205, 205, 205);
/// The pattern of posts that are not reached though one may rest there.
pub(super) const NO_HOP: Pattern = Pattern::Falling;
const TAN: RGBColor = RGBColor(222, 196, 160);
const SAND: RGBColor = RGBColor(214, 206, 150);
/// The tints and patterns of layers, in turn.
const LAYERS: [(RGBColor, Pattern); 3] = [
    (RGBColor(170, 196, 222), Pattern::Level),
    (RGBColor(214, 176, 204), Pattern::Upright),
    (RGBColor(176, 208, 188), Pattern::Dashed),
];

/// What refuses every contact at a post.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefusedBy {
    /// A keep-out zone, or the lack of a keep-in zone.
    Zone,
    /// The slope of the ground.
    Slope,
    /// The ground under the footprint.
    Footprint,
    /// A layer of the map.
    Layer,
}

/// The tint and the pattern of each reason.
pub(super) fn looks(refused: &[RefusedPosts]) -> Vec<(RGBColor, Pattern)> {
    let mut layers = LAYERS.iter().cycle();
    let of_layer = |layers: &mut dyn Iterator<Item = &'static (RGBColor, Pattern)>| layers.next().copied();
    let look = |by: &RefusedPosts| match by.by {
        RefusedBy::Zone => (NOT_REACHED, Pattern::Crossed),
        RefusedBy::Slope => (TAN, Pattern::Dotted),
        RefusedBy::Footprint => (SAND, Pattern::Grid),
        RefusedBy::Layer => of_layer(&mut layers).unwrap_or((NOT_REACHED, Pattern::Level)),
    };
    refused.iter().map(look).collect()
}

/// The number of the reason by which a post refuses every contact: of several the first.
pub(super) fn reason_of(refused: &[RefusedPosts], at: usize) -> Option<usize> {
    refused.iter().position(|refused| refused.posts[at])
}

/// The name of the posts that are not reached for none of these reasons.
pub(super) const fn rest_name(refused: &[RefusedPosts]) -> &'static str {
    if refused.is_empty() { "not reached" } else { "no hop leads there, not reached" }
}

/// The samples of a legend for each reason, with its name.
pub(super) fn keys(refused: &[RefusedPosts]) -> impl Iterator<Item = (Swatch, String)> + '_ {
    let named = |(refused, (tint, pattern)): (&RefusedPosts, (RGBColor, Pattern))| {
        (pattern.swatch(tint), format!("{}, not reached", refused.reason))
    };
    refused.iter().zip(looks(refused)).map(named)
}
