//! The longest outages of a path, as plain data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{path::LongestOutage, quantity::format_number, terrain::OutageLimit};

/// The longest stretch of a path outside the condition of a layer that may be left for a while.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OutageRecord {
    /// The name of the layer.
    pub layer: String,
    /// The longest time of a stretch: flights, settling and preparation. The end of the path ends a stretch.
    pub longest_s: f64,
    /// The longest time that is allowed; null for any.
    pub max_s: Option<f64>,
    /// The most hops of a stretch, those into it and out of it included.
    pub most_hops: u64,
    /// The most hops that are allowed; null for any number.
    pub hops_max: Option<u64>,
    /// Whether the path keeps both.
    pub met: bool,
}

impl OutageRecord {
    /// Of the longest outage of a path, under the limit of its layer.
    pub fn new(longest: &LongestOutage, limit: &OutageLimit) -> Self {
        /// As a total keeps a budget.
        const TOLERANCE: f64 = 1e-9;
        #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
        let met = longest.time_s <= limit.most_s() * (1.0 + TOLERANCE) && longest.hops as f64 <= limit.most_hops();
        Self {
            layer: longest.layer.name().to_owned(),
            longest_s: longest.time_s,
            max_s: limit.max_s,
            most_hops: longest.hops,
            hops_max: limit.hops_allowed(),
            met,
        }
    }

    /// What text says of it.
    pub fn sentence(&self) -> String {
        let Self { layer, longest_s, max_s, most_hops, hops_max, met } = self;
        let most_s = max_s.map_or(String::new(), |max_s| format!(", at most {} s", format_number(max_s)));
        let most = hops_max.map_or(String::new(), |hops_max| format!(", at most {hops_max}"));
        let plural = if *most_hops == 1 { "" } else { "s" };
        let is = format!("longest outage of layer {layer} {longest_s:.1} s{most_s}, {most_hops} hop{plural}{most}");
        if *met { is } else { format!("not within an outage: {is}; no path was found over these nodes that keeps it") }
    }
}
