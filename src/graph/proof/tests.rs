//! Proofs with planted faults, each of which the comparison with the search must detect.

use super::{bounds::bounds_with, *};
use crate::{
    chain::{ConstrainedChain, ContactRule, GroundForm, LineConstraints, PolygonalChain, SegmentGround},
    draw::Draw,
    graph::{PointSpacing, SearchOptions, search},
    hop::HopTest,
    progress::{Meter, Stage},
    quantity::{AngleInterval, ChainPoint, Inwards, VertexId},
    world::{ClearanceRule, Gravity, Hopper, HopperLimits, RestSlope, SpeedLevels, SurfaceProperties},
};

/// Ends are rounded inwards, without the tolerance, which would hide the fault.
impl Faults for Inwards {
    type Rounding = Self;
    const SLACK: f64 = 0.0;
}

/// Limits are applied without tolerance.
#[derive(Clone, Copy, Debug)]
struct ForgetsTolerance;

impl Faults for ForgetsTolerance {
    type Rounding = Outwards;
    const SLACK: f64 = 0.0;
}

/// Vertices have no cells of their own: a landing at a vertex obeys the ground behind it and a take-off the ground ahead,
/// which no single stretch does.
#[derive(Clone, Copy, Debug)]
struct DropsVertices;

impl Faults for DropsVertices {
    type Rounding = Outwards;
    const DROPS_VERTICES: bool = true;
}

/// Hops towards -x are ignored.
#[derive(Clone, Copy, Debug)]
struct ForgetsReverse;

impl Faults for ForgetsReverse {
    type Rounding = Outwards;
    const FORGETS_REVERSE: bool = true;
}

/// A random chain of several segments with separate constraints for both directions, its hopper and its gravity.
pub(super) fn drawn_chain(draw: &mut Draw) -> ConstrainedChain {
    let g = draw.uniform(0.5, 10.0);
    let mut points = vec![ChainPoint::new(draw.uniform(-5.0, 5.0), draw.uniform(-5.0, 5.0))];
    let segments = 3 + draw.below(4);
    for i in 0..segments {
        let run = if draw.below(8) == 0 { 1e-3 } else { draw.uniform(0.5, 6.0) };
        points.push(ChainPoint::new(points[i].x_m + run, points[i].z_m + draw.uniform(-0.8, 0.8) * run));
    }
    let speed = (g * 5.0).sqrt();
    let mut rule = |sign: f64| {
        let angles = match draw.below(3) {
            0 => [-90.0, 90.0],
            1 => [draw.uniform(-10.0, 60.0), 90.0],
            _ => [draw.uniform(20.0, 60.0), draw.uniform(60.0, 89.0)],
        };
        let [a, b] = angles.map(|angle| sign * angle);
        let fast = if draw.below(8) == 0 { 0.0 } else { draw.uniform(0.5, 1.3) };
        ContactRule::new(AngleInterval::from_degrees(a.min(b), a.max(b)), speed * fast)
    };
    let mut line = || LineConstraints { takeoff: rule(1.0), landing: rule(-1.0) };
    let grounds = (0..segments)
        .map(|_| SegmentGround { form: GroundForm::Explicit { forward: Some(line()), reverse: Some(line()) }, keep_out: false })
        .collect();
    let hopper = Hopper::new(HopperLimits {
        clearance_m: if draw.below(2) == 0 { 0.0 } else { 10f64.powf(draw.uniform(-2.0, 0.3)) },
        clearance_rule: match draw.below(4) {
            0 => ClearanceRule::Vertex,
            1 => ClearanceRule::TAPERED,
            _ => ClearanceRule::Tapered(10f64.powf(draw.uniform(-1.3, 1.0))),
        },
        flight_time_max_s: (draw.below(4) == 0).then(|| draw.uniform(0.5, 3.0)),
        apex_height_max_m: (draw.below(4) == 0).then(|| draw.uniform(0.5, 3.0)),
        takeoff_speed_min_m_s: (draw.below(4) == 0).then(|| speed * draw.uniform(0.3, 1.0)),
        takeoff_speed_levels: match draw.below(8) {
            0 => SpeedLevels::new(&[speed * draw.uniform(1.0, 1.2)]).ok(),
            1 => SpeedLevels::new(&[0.6, 0.8, 1.0].map(|share| speed * (share + draw.uniform(0.4, 0.5)))).ok(),
            _ => None,
        },
        ..HopperLimits::UNLIMITED
    })
    .unwrap();
    let geometry = PolygonalChain::new(points, grounds, None).unwrap();
    let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    ConstrainedChain::new(geometry, &hopper, Gravity::new(g).unwrap(), &surface).unwrap()
}

/// The number of journeys for which the search finds a path with fewer hops than the lower bound, or a path where none should
/// exist.
fn contradictions<F: Faults>(journeys: usize) -> usize {
    let draw = &mut Draw::seeded(81);
    let options = BoundsOptions { budget_cells: 60, ..BoundsOptions::default() };
    let mut contradicted = 0;
    for _ in 0..journeys {
        let chain = drawn_chain(draw);
        let test = HopTest::new(chain.clone());
        let mut end = || chain.geometry().vertex_station(VertexId(draw.below(chain.segments().len() + 1)));
        let (start, goal) = (end(), end());
        let lower = bounds_with::<F>(&test, (start, goal), &options, &Meter::new(&(), Stage::Proof)).unwrap().lower;
        let fewest = [0, 2, 7].into_iter().filter_map(|points| {
            let spacing = Some(PointSpacing::PerSegment(points));
            search(&test, start, goal, &SearchOptions { spacing, ..SearchOptions::default() }, &()).unwrap().hops()
        });
        contradicted += usize::from(fewest.min().is_some_and(|hops| lower.is_none_or(|lower| lower > hops)));
    }
    contradicted
}

#[test]
fn the_search_never_contradicts_a_sound_proof() {
    assert_eq!(contradictions::<Sound>(300), 0);
}

#[test]
fn a_dropped_vertex_cell_is_caught() {
    let caught = contradictions::<DropsVertices>(200);
    assert!(caught > 0, "the test above would not detect it");
}

#[test]
fn a_forgotten_direction_is_caught() {
    let caught = contradictions::<ForgetsReverse>(100);
    assert!(caught > 20, "{caught} caught: the test above would not detect it");
}

/// The lower bound over flat ground with cones of 60 degrees about the vertical, at 5 m/s and 1 m/s^2: one reach is v^2 / g =
/// 25 m.
fn bound_over_flat_ground<F: Faults>(run_m: f64) -> Option<u64> {
    let line = LineConstraints::from_cone(0.0, crate::quantity::Angle::from_degrees(60.0), 5.0, 5.0);
    let form = GroundForm::Explicit { forward: Some(line), reverse: Some(line) };
    let points = vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(run_m, 0.0)];
    let geometry = PolygonalChain::new(points, vec![SegmentGround { form, keep_out: false }], None).unwrap();
    let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    let chain = ConstrainedChain::new(geometry, &Hopper::UNLIMITED, Gravity::new(1.0).unwrap(), &surface).unwrap();
    let test = HopTest::new(chain.clone());
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    bounds_with::<F>(&test, (at(0), at(1)), &BoundsOptions::default(), &Meter::new(&(), Stage::Proof)).unwrap().lower
}

#[test]
fn rounding_inwards_is_detected() {
    // A run of exactly one reach has exactly one arc, so the last digit decides.
    assert_eq!(bound_over_flat_ground::<Sound>(25.0), Some(1));
    assert_eq!(bound_over_flat_ground::<ForgetsTolerance>(25.0), Some(1), "outwards, the exact limit is still allowed");
    assert_ne!(bound_over_flat_ground::<Inwards>(25.0), Some(1), "inward rounding must change the bound");
}

#[test]
fn a_missing_tolerance_is_detected() {
    // The search accepts a hop that needs 1e-9 more speed than the limit, so 2e-9 more run.
    let run_m = 25.0 * (1.0 + 1.9e-9);
    assert_eq!(bound_over_flat_ground::<Sound>(run_m), Some(1));
    assert_eq!(bound_over_flat_ground::<ForgetsTolerance>(run_m), Some(2), "a missing tolerance must change the bound");
    assert_eq!(bound_over_flat_ground::<Sound>(25.0 * (1.0 + 2.1e-9)), Some(2), "the proof relaxes limits by more than it states");
}
