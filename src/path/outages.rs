//! How long a path is outside the conditions of layers that may be left for a while: by the clock of its hops, from the path alone.

use super::HopPath;
use crate::{ground::Layer, quantity::MapPoint, world::HopperLimits, world::LayerName};

/// The longest stretch of a path outside the condition of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LongestOutage {
    /// The layer.
    pub layer: LayerName,
    /// The longest time of a stretch, s: flights, bounces, settling and preparation.
    pub time_s: f64,
    /// The most hops of a stretch, those into it and out of it included.
    pub hops: u64,
}

/// The longest outage of a layer over a path on a map. A path begins with the preparation of its first hop, and ends with its last landing.
///
/// A rest belongs to the outage where the condition is unmet at its place. So does a flight with such a place at either end, and where the layer
/// is about flights one whose ground track meets a cell in which it does not hold, the whole of it.
///
/// # Arguments
/// `exempt`: places of targets, where a layer that exempts targets counts as met.
pub fn longest_outage(path: &HopPath, hopper: &HopperLimits, layer: &Layer, exempt: &[MapPoint]) -> LongestOutage {
    let mut longest = LongestOutage { layer: layer.rule().name, time_s: 0.0, hops: 0 };
    let (mut time_s, mut hops) = (0.0, 0);
    for (number, hop) in path.hops.iter().enumerate() {
        let Some((from, to)) = hop.map_ends() else { continue };
        let [takeoff, flight, landing] = layer.is_outside(from, to, exempt);
        if takeoff {
            let settling_s = if number == 0 { 0.0 } else { hopper.settling_s().unwrap_or(0.0) };
            time_s += settling_s + hopper.preparation_time_s.unwrap_or(0.0);
        } else {
            (time_s, hops) = (0.0, 0);
        }
        if flight {
            time_s += hop.flight_time_s;
            hops += 1;
        } else {
            (time_s, hops) = (0.0, 0);
        }
        time_s += hop.roll_out.filter(|_| landing).map_or(0.0, |bounces| bounces.time_s);
        longest = LongestOutage { time_s: longest.time_s.max(time_s), hops: longest.hops.max(hops), ..longest };
        if !landing {
            (time_s, hops) = (0.0, 0);
        }
    }
    longest
}
