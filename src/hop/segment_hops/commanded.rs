//! The lengths of hops along one segment that a machine's take-off speeds leave.

use super::{SegmentReach, last_allowed};
use crate::{
    ballistics::{LineOfSight, TakeoffChoice, TakeoffSpeeds, limits},
    hop::HopTest,
    quantity::SlopeInterval,
    world::SPEED_TOLERANCE,
};

/// The ranges of length that a machine's take-off speeds leave of those that all other limits allow, the longest first. Each of them is
/// a reach of its own; the hops of one run along a segment all have lengths of one range.
///
/// At a speed `v` a loft `n` covers `X = 2 v^2 n / (g (1 + (b + n)^2))`. So the lengths change between possible and impossible at those
/// of the ends of the cones and of the farthest loft, for each speed, or where a limit of the machine or the clearance ends. The first
/// are tested exactly; between them, lengths are tried and the changes found by bisection. A range that is not found only leaves
/// hops out.
pub(super) fn ranges(reach: SegmentReach, test: &HopTest) -> Vec<SegmentReach> {
    let allows = |length_m: f64| reach.has_commanded_arc(test, length_m);
    let mut found = Vec::new();
    let others = [(0.0, reach.near_m), (reach.shortest_m, reach.stride_m)];
    for (shortest_m, longest_m) in others.into_iter().filter(|(_, longest_m)| *longest_m > 0.0) {
        let tried = tried_lengths_m(&reach, test, shortest_m.max(longest_m * SPEED_TOLERANCE), longest_m);
        let mut before: Option<(f64, bool)> = None;
        let mut from_m = None;
        for length_m in tried {
            let allowed = allows(length_m);
            match before {
                _ if allowed && from_m.is_none() => {
                    from_m = Some(match before {
                        Some((refused_m, _)) => last_allowed(length_m, refused_m, allows),
                        None => shortest_m,
                    });
                }
                Some((last_m, true)) if !allowed => {
                    let to_m = last_allowed(last_m, length_m, allows);
                    found.extend(from_m.take().map(|from_m| reach.range(test, from_m, to_m)));
                }
                _ => {}
            }
            before = Some((length_m, allowed));
        }
        if let Some(from_m) = from_m {
            // The end is that of the other limits.
            found.push(if longest_m == reach.stride_m {
                SegmentReach { shortest_m: from_m, near_m: 0.0, ..reach }
            } else {
                reach.range(test, from_m, longest_m)
            });
        }
    }
    found.reverse();
    found
}

/// The lengths to try, ascending, from the shortest to the longest.
fn tried_lengths_m(reach: &SegmentReach, test: &HopTest, shortest_m: f64, longest_m: f64) -> Vec<f64> {
    /// Lengths tried between two neighbours.
    const BETWEEN: i32 = 8;
    let sight = LineOfSight::along(1.0, reach.sight_slope);
    let cones = limits::takeoff_cone(sight, reach.from.slopes().intersect(test.mechanism_slopes()))
        .intersect(limits::landing_cone(sight, reach.to.slopes()));
    let flattest = cones.lower.max(f64::MIN_POSITIVE);
    let farthest = sight.secant().min(cones.upper).max(flattest);
    let speeds = match test.takeoff_speeds() {
        TakeoffSpeeds::Any => &[][..],
        TakeoffSpeeds::AtLeast(least_m_s) => std::slice::from_ref(least_m_s),
        TakeoffSpeeds::Levels(levels) => levels.as_slice(),
    };
    let covered_m = |speed: f64, n: f64| {
        let m = reach.sight_slope + n;
        2.0 * speed * speed / test.gravity_m_s2() * (n / (1.0 + m * m))
    };
    let exact = speeds.iter().flat_map(|speed| [flattest, farthest, cones.upper].map(|loft| covered_m(*speed, loft)));
    let mut ends: Vec<f64> = exact.filter(|length_m| shortest_m < *length_m && *length_m < longest_m).collect();
    ends.extend([shortest_m, longest_m]);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let between = |pair: &[f64]| {
        let (from_m, ratio) = (pair[0], libm::pow(pair[1] / pair[0], 1.0 / f64::from(BETWEEN)));
        (0..BETWEEN).map(move |i| from_m * libm::pow(ratio, f64::from(i))).collect::<Vec<_>>()
    };
    let mut tried: Vec<f64> = ends.windows(2).flat_map(between).filter(|length_m| *length_m < longest_m).collect();
    tried.push(longest_m);
    tried
}

impl SegmentReach {
    /// The lofts that all limits but the machine's take-off speeds allow a hop of this length; `None` if they allow none.
    pub(super) fn lofts_of(&self, test: &HopTest, length_m: f64) -> Option<SlopeInterval> {
        let sight = LineOfSight::along(length_m, self.sight_slope);
        let clearance = test.clearance();
        let clearing = if clearance.has_kinks() { clearance.kink_loft(0.0, length_m) } else { f64::NEG_INFINITY };
        let cleared = |lofts: SlopeInterval| SlopeInterval { lower: lofts.lower.max(clearing), ..lofts };
        test.lofts_in_envelope(sight, &self.from, &self.to).map(cleared).ok().filter(|lofts| !lofts.is_empty())
    }

    /// Whether the machine has an arc of this length.
    pub(super) fn has_commanded_arc(&self, test: &HopTest, length_m: f64) -> bool {
        let sight = LineOfSight::along(length_m, self.sight_slope);
        self.lofts_of(test, length_m).is_some_and(|lofts| test.refused_command(sight, lofts).is_none())
    }

    /// The range of lengths whose ends are the first and the last that the machine's take-off speeds allow.
    fn range(&self, test: &HopTest, from_m: f64, to_m: f64) -> Self {
        // Both ends are on a limit. A hop on it keeps away from it by the tolerance, so that rounding cannot refuse it, unless the
        // range is as narrow as that: a single arc for a level.
        let inside = [from_m * (1.0 + SPEED_TOLERANCE), to_m * (1.0 - 2.0 * SPEED_TOLERANCE)];
        let [shortest_m, stride_m] = if inside[0] < inside[1] { inside } else { [from_m, 0.5 * (from_m + to_m)] };
        let sight = LineOfSight::along(stride_m, self.sight_slope);
        let loft = self.lofts_of(test, stride_m).map_or(self.loft, |lofts| test.loft(TakeoffChoice::LeastSpeed, sight, lofts));
        let limit = test.takeoff_speeds().limit().unwrap_or(self.limit);
        Self { loft, reach_m: stride_m, tolerant_reach_m: to_m, stride_m, limit, shortest_m, near_m: 0.0, ..*self }
    }
}
