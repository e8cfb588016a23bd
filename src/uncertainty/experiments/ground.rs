//! Where an arc comes down on a chain that is extended to both sides of the plane of travel and beyond both its ends.

use crate::chain::PolygonalChain;

/// An arc in the plane of travel, seen along +x: `z = z0 + m d - c d^2` with `d` along the direction of travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FreeArc {
    /// Its beginning, along the chain, m.
    pub(super) x_m: f64,
    /// The height of its beginning, m; it may differ from that of the ground.
    pub(super) z_m: f64,
    /// +1 towards +x, -1 towards -x.
    pub(super) sign: f64,
    /// Slope at its beginning.
    pub(super) slope: f64,
    /// `c = g / (2 v_x^2)`.
    pub(super) bend_per_m: f64,
}

/// Where an arc first crosses the ground from above: x and z in m.
///
/// Beyond its ends the chain continues as its first and last segments do; otherwise every flight that goes too far would be lost
/// for a goal at the last vertex. `None` for an arc that begins too deep below the ground to rise above it.
///
/// An arc that begins below the ground (a take-off scattered downwards) must rise above it first. So for each segment, the crossing
/// is computed at which the arc's height over it falls through zero: with ground of slope `s` at height `h` below the arc's
/// beginning,
///
/// ```text
///     c d^2 - (m - s) d + h = 0, the larger root
/// ```
///
/// and the arc lands on the first segment that contains its own crossing.
pub(super) fn comes_down(chain: &PolygonalChain, arc: &FreeArc) -> Option<(f64, f64)> {
    let vertices = chain.vertices();
    let first = vertices.partition_point(|vertex| vertex.x_m <= arc.x_m).saturating_sub(1).min(chain.segment_count() - 1);
    let along = |segment: usize| -> Option<(f64, f64)> {
        let ends = vertices.get(segment..segment + 2)?;
        let slope = arc.sign * chain.slopes()[segment];
        // The ground of this segment below the arc's beginning.
        let ground_m = ends[0].z_m + chain.slopes()[segment] * (arc.x_m - ends[0].x_m);
        let half = 0.5 * (arc.slope - slope);
        let root = half * half - arc.bend_per_m * (ground_m - arc.z_m);
        let d_m = (half + root.max(0.0).sqrt()) / arc.bend_per_m;
        let x_m = arc.x_m + arc.sign * d_m;
        let begins = segment == 0 || ends[0].x_m <= x_m;
        let holds = root >= 0.0 && d_m > 0.0 && begins && (segment + 1 == chain.segment_count() || x_m <= ends[1].x_m);
        holds.then(|| (x_m, ends[0].z_m + chain.slopes()[segment] * (x_m - ends[0].x_m)))
    };
    if arc.sign > 0.0 { (first..chain.segment_count()).find_map(along) } else { (0..=first).rev().find_map(along) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::ChainPoint;

    /// The same by fine steps, from the sign of the height alone.
    fn stepped(chain: &PolygonalChain, arc: &FreeArc) -> Option<f64> {
        let mut above = false;
        for i in 1..400_000 {
            let d_m = f64::from(i) * 1e-4;
            let x_m = arc.x_m + arc.sign * d_m;
            let (low_m, high_m) = chain.extent_m();
            // Beyond the ends the end segment continues.
            let near_m = x_m.clamp(low_m, high_m);
            let end_slope = if x_m < low_m { chain.slopes()[0] } else { *chain.slopes().last()? };
            let ground = chain.station(near_m).ok()?.point.z_m + end_slope * (x_m - near_m);
            let over_m = arc.z_m + arc.slope * d_m - arc.bend_per_m * d_m * d_m - ground;
            if above && over_m <= 0.0 {
                return Some(x_m);
            }
            above = over_m > 0.0;
        }
        None
    }

    #[test]
    fn the_first_contact_is_found_from_above_and_from_below() {
        let points = [(0.0, 0.0), (4.0, 1.0), (6.0, 0.2), (9.0, 2.5), (10.0, 2.4), (15.0, 0.0), (20.0, 0.5)];
        let chain = PolygonalChain::bare(points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect()).unwrap();
        let (mut compared, mut beyond) = (0, 0);
        for start in [0.5, 3.0, 5.1, 8.9, 12.0, 19.0] {
            for lift_m in [-0.3, 0.0, 0.4] {
                for (sign, slope, bend_per_m) in [(1.0, 1.7, 0.2), (1.0, 4.0, 0.9), (-1.0, 1.2, 0.15), (-1.0, 3.0, 0.4)] {
                    let z_m = chain.station(start).unwrap().point.z_m + lift_m;
                    let arc = FreeArc { x_m: start, z_m, sign, slope, bend_per_m };
                    let (exact, stepped) = (comes_down(&chain, &arc), stepped(&chain, &arc));
                    assert_eq!(exact.is_some(), stepped.is_some(), "{arc:?}: {exact:?} {stepped:?}");
                    if let (Some((x_m, z_m)), Some(near_m)) = (exact, stepped) {
                        assert!((x_m - near_m).abs() < 1e-3, "{arc:?}: {x_m} {near_m}");
                        if let Ok(station) = chain.station(x_m) {
                            assert!((z_m - station.point.z_m).abs() < 1e-9);
                        } else {
                            beyond += 1;
                        }
                        compared += 1;
                    }
                }
            }
        }
        assert!(compared > 60 && beyond > 5, "only {compared} compared, {beyond} of them beyond the ends");
    }
}
