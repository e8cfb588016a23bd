//! The clearance that a hop keeps, as a band over the ground.

use super::{
    palette::GREEN,
    sheet::{Pen, Place, Sheet},
};
use crate::{ballistics::limits::ClearanceProfile, quantity::ChainPoint};

/// The upper edge of the band.
pub(super) const EDGE_PEN: Pen = Pen { colour: GREEN, width_mm: 0.2 };
const OPACITY: f64 = 0.22;

/// The ground between the ends of a hop, raised by the clearance, with the kinks of a taper. The ground runs from end to end, from
/// left to right.
pub(super) fn raised(ground: &[ChainPoint], clearance: ClearanceProfile) -> Vec<ChainPoint> {
    let (Some(first), Some(last)) = (ground.first(), ground.last()) else { return Vec::new() };
    let kink_m = clearance.kink_m(last.x_m - first.x_m);
    let kinks = if clearance.has_kinks() { [first.x_m + kink_m, last.x_m - kink_m].to_vec() } else { Vec::new() };
    let mut points: Vec<ChainPoint> = ground.to_vec();
    for x_m in kinks {
        let after = points.partition_point(|point| point.x_m < x_m);
        if let (Some(a), Some(b)) = (after.checked_sub(1).and_then(|before| points.get(before)), points.get(after)) {
            let z_m = a.z_m + (b.z_m - a.z_m) * (x_m - a.x_m) / (b.x_m - a.x_m);
            points.insert(after, ChainPoint::new(x_m, z_m));
        }
    }
    let kept = |point: &ChainPoint| clearance.at_m(point.x_m - first.x_m, last.x_m - point.x_m);
    points.iter().map(|point| ChainPoint::new(point.x_m, point.z_m + kept(point))).collect()
}

/// The band between two lines on the sheet, both from left to right.
pub(super) fn band(sheet: &mut Sheet, raised: &[Place], surface: &[Place]) {
    sheet.area(raised.iter().chain(surface.iter().rev()).copied().collect(), GREEN, OPACITY);
    sheet.line(raised.to_vec(), EDGE_PEN);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::ClearanceRule;

    #[test]
    fn the_band_begins_on_the_ground_and_turns_at_the_kinks() {
        let ground = [(0.0, 0.0), (10.0, 5.0), (20.0, 5.0)].map(|(x, z)| ChainPoint::new(x, z));
        let points =
            |height_m, rule| raised(&ground, ClearanceProfile::new(height_m, rule)).iter().map(|p| (p.x_m, p.z_m)).collect();
        let found: Vec<(f64, f64)> = points(2.0, ClearanceRule::TAPERED);
        assert_eq!(found, [(0.0, 0.0), (4.0, 4.0), (10.0, 7.0), (16.0, 7.0), (20.0, 5.0)]);
        // A hop shorter than two ramps: one kink in the middle.
        let found: Vec<(f64, f64)> = points(50.0, ClearanceRule::TAPERED);
        assert_eq!(found.iter().map(|p| p.1).fold(0.0, f64::max), 10.0);
        let found: Vec<(f64, f64)> = points(2.0, ClearanceRule::Vertex);
        assert_eq!(found, [(0.0, 2.0), (10.0, 7.0), (20.0, 7.0)]);
    }
}
