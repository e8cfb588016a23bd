//! How many standard deviations a hop keeps from the limits that its flight is judged by.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::text::Sheet;
use crate::{hop::HopMargins, uncertainty::HopScatter};

/// Margins of a hop divided by the standard deviation of the quantity that is limited, under the errors of the scenario. The limit is that of
/// the ground at the planned take-off and landing. A margin is absent where there is no such limit, or nothing scatters the quantity.
///
/// They inform, and do not choose: a flight may meet other ground than planned, which the estimate of success counts.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct SigmaMarginsRecord {
    /// Take-off angle over the lower end of the take-off cone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub takeoff_cone_min_sigma: Option<f64>,
    /// Take-off angle under the upper end of the take-off cone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub takeoff_cone_max_sigma: Option<f64>,
    /// Landing angle over the lower end of the landing cone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub landing_cone_min_sigma: Option<f64>,
    /// Landing angle under the upper end of the landing cone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub landing_cone_max_sigma: Option<f64>,
    /// Landing speed under its limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub landing_speed_sigma: Option<f64>,
}

impl SigmaMarginsRecord {
    /// Of a hop with these margins whose quantities scatter so. `friction_deg`: the standard deviation of the ends of the cones from the
    /// friction of the ground, degrees.
    pub fn new(margins: &HopMargins, scatter: &HopScatter, friction_deg: f64) -> Self {
        let margin = |key: &str| margins.rows().find(|(row, _)| row.key == key).and_then(|(_, value)| value);
        let cone = |key: &str, scatter_deg: f64| over(margin(key), libm::hypot(scatter_deg, friction_deg));
        let (takeoff_deg, landing_deg) = (scatter.takeoff_angle.degrees(), scatter.landing_angle.degrees());
        Self {
            takeoff_cone_min_sigma: cone("takeoff_cone_min_deg", takeoff_deg),
            takeoff_cone_max_sigma: cone("takeoff_cone_max_deg", takeoff_deg),
            landing_cone_min_sigma: cone("landing_cone_min_deg", landing_deg),
            landing_cone_max_sigma: cone("landing_cone_max_deg", landing_deg),
            landing_speed_sigma: over(margin("landing_speed_m_s"), scatter.landing_speed_m_s),
        }
    }

    /// The least of them, with what the hop does and the limit in words.
    pub fn least(&self) -> Option<(f64, &'static str, &'static str)> {
        let all = [
            (self.takeoff_cone_min_sigma, "takes off", "its take-off cone"),
            (self.takeoff_cone_max_sigma, "takes off", "its take-off cone"),
            (self.landing_cone_min_sigma, "lands", "its landing cone"),
            (self.landing_cone_max_sigma, "lands", "its landing cone"),
            (self.landing_speed_sigma, "lands", "its greatest landing speed"),
        ];
        let known = all.into_iter().filter_map(|(sigmas, does, limit)| Some((sigmas?, does, limit)));
        known.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// Margins below this are no number of standard deviations that a reader can use.
const LEAST_SCATTER: f64 = 1e-9;

fn over(margin: Option<f64>, deviation: f64) -> Option<f64> {
    // A plan on its limit keeps it but for rounding.
    margin.filter(|_| deviation > LEAST_SCATTER).map(|margin| margin.max(0.0) / deviation)
}

/// What stands on the edge, as sentences: hops with less than one standard deviation to a limit, the nearest first, at most `MOST`.
pub(super) fn edge_text<'a>(hops: impl Iterator<Item = (usize, Option<&'a SigmaMarginsRecord>)>) -> String {
    const MOST: usize = 5;
    let least = hops.filter_map(|(hop, margins)| Some((hop, margins?.least()?)));
    let mut edges: Vec<_> = least.filter(|(_, (sigmas, ..))| *sigmas < 1.0).collect();
    edges.sort_by(|a, b| a.1.0.total_cmp(&b.1.0).then(a.0.cmp(&b.0)));
    let mut sheet = Sheet::default();
    for (hop, (sigmas, does, limit)) in edges.iter().take(MOST) {
        sheet.line(format_args!("hop {hop} {does} {sigmas:.1} sigma from {limit}"));
    }
    if edges.len() > MOST {
        let more = edges.len() - MOST;
        let hops = if more == 1 { "hop is" } else { "hops are" };
        sheet.line(format_args!("{more} more {hops} less than 1 sigma from a limit"));
    }
    sheet.into_text()
}
