//! Where trials come to rest, in numbers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::uncertainty::{RestDensity, Wilson};

/// Where the trials end on the map; the whole is in the raster.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DensityRecord {
    /// The share of trials that end on the ground: the sum of the raster's first band. The others leave the known ground in flight.
    pub on_ground_share: f64,
    /// How many hops have a band each in the raster, after the band of the ends.
    pub hops_counted: usize,
    /// The greatest share that ends in one cell.
    pub greatest_share: f64,
    /// The post of that cell, [x, y], m; absent if no trial ends on the ground.
    pub greatest_m: Option<[f64; 2]>,
    /// The share that ends in the area that was asked for; absent without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inside_share: Option<f64>,
    /// Its 95 % interval (Wilson).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inside_share_ci95: Option<[f64; 2]>,
}

impl DensityRecord {
    /// The numbers of a density.
    pub fn new(density: &RestDensity) -> Self {
        let inside = density.ended_in_area().map(|count| Wilson::of(count, density.trials()));
        let densest = density.densest();
        Self {
            on_ground_share: Wilson::of(density.ended_on_ground(), density.trials()).rate,
            hops_counted: density.hops(),
            greatest_share: densest.map_or(0.0, |cell| cell.share),
            greatest_m: densest.map(|cell| [cell.at.x, cell.at.y]),
            inside_share: inside.map(|inside| inside.rate),
            inside_share_ci95: inside.map(|inside| [inside.low, inside.high]),
        }
    }

    /// The same as sentences.
    pub fn lines(&self) -> Vec<String> {
        let densest = self
            .greatest_m
            .map_or(String::new(), |[x, y]| format!(", at most {:.4} in one cell, at ({x:.3}, {y:.3}) m", self.greatest_share));
        let inside = self
            .inside_share
            .zip(self.inside_share_ci95)
            .map(|(share, [low, high])| format!("inside the area: {share:.4} (95 % interval {low:.4} to {high:.4})"));
        [format!("rests: {:.4} of the trials end on the ground{densest}", self.on_ground_share)].into_iter().chain(inside).collect()
    }

    /// The same as text.
    pub(super) fn text(&self) -> String {
        format!("\n{}\n", self.lines().join("\n"))
    }
}
