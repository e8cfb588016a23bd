//! One take-off tested against all landings in one direction.
//!
//! This is faster than testing pair by pair for three reasons: all limits except the terrain are evaluated for blocks of
//! landings at once; a bound makes the terrain test unnecessary for most landings; and the terrain test is one tangent to a
//! hull instead of a loop over all vertices flown over.

mod hull;
mod lanes;
mod near;
mod table;
mod terrain;

use std::{
    ops::{ControlFlow, Range},
    sync::Arc,
};

use lanes::{Departure, Lanes};
pub use table::LandingTable;
use terrain::{Near, Overflight};

use crate::{
    ballistics::LineOfSight,
    chain::Station,
    quantity::SlopeInterval,
    world::{Contact, Direction, Limit, tolerant_speed_m_s},
};

/// Tests one take-off against many landings under all limits, with the results of [`HopTest::lofts`](crate::hop::HopTest::lofts)
/// at a fraction of its cost.
///
/// Holds working memory that is reused from one sweep to the next: make one per thread.
///
/// # Examples
/// ```
/// use chta::{chain::*, ground::{LandingTable, Sweep}, hop::*, quantity::*, world::*};
/// let points = (0..=20).map(|i| ChainPoint::new(f64::from(i), 0.0)).collect();
/// let hopper = Hopper::with_speeds(4.0, 4.0).unwrap();
/// let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.0).unwrap())), rest: RestSlope::AsFrictionHolds };
/// let chain = ConstrainedChain::new(PolygonalChain::bare(points).unwrap(), &hopper, Gravity::new(1.6).unwrap(), &surface).unwrap();
/// let test = HopTest::new(chain);
/// let chain = test.chain();
/// let stations: Vec<_> = (0..=20).map(|i| chain.geometry().vertex_station(VertexId(i))).collect();
/// let table = LandingTable::new(&test, stations.as_slice());
/// let mut farthest = 0;
/// Sweep::new(table).landings(&stations[0], 0..21, Direction::Forward, |i, verdict| {
///     assert_eq!(verdict, test.lofts(&stations[0], &stations[i]));
///     if verdict.is_ok() {
///         farthest = i;
///     }
/// });
/// // v^2 / g = 10 m, at 45 degrees.
/// assert_eq!(farthest, 10);
/// ```
#[derive(Clone, Debug)]
pub struct Sweep {
    table: Arc<LandingTable>,
    lanes: Lanes,
    overflight: Overflight,
}

/// Two lofts closer than this fraction of their size are compared by [`HopTest::lofts`](crate::hop::HopTest::lofts): far more than
/// rounding, far less than matters.
const TOUCHING: f64 = 1e-11;

impl Sweep {
    /// For sweeps over a table of landings.
    pub fn new(table: impl Into<Arc<LandingTable>>) -> Self {
        let table = table.into();
        let overflight = Overflight::new(table.test());
        Self { table, lanes: Lanes::new(), overflight }
    }

    /// Evaluates every landing of a range of the table's stations that lies in a direction from the take-off, nearest first.
    ///
    /// `visit` gets the index of each landing and the result of [`HopTest::lofts`](crate::hop::HopTest::lofts) for the pair.
    /// Feasibility and the refusing limit are always the same, since that function itself decides where two limits touch
    /// within rounding. The lofts are equal to the last bit, or to some 1e-15 where vertices are more than thirty times
    /// closer together than their neighbours.
    ///
    /// # Complexity
    /// With W landings and S vertices flown over: O(W + S) where the bound decides without the terrain, O(W log S + S) at
    /// worst. The exception is ground that follows one parabola through the take-off to the last digit.
    pub fn landings(
        &mut self,
        takeoff: &Station,
        among: Range<usize>,
        direction: Direction,
        mut visit: impl FnMut(usize, Result<SlopeInterval, Limit>),
    ) {
        let _: ControlFlow<()> = self.landings_while(takeoff, among, direction, |i, verdict| {
            visit(i, verdict);
            ControlFlow::Continue(())
        });
    }

    /// The same, until `visit` breaks.
    #[inline]
    pub(crate) fn landings_while<B>(
        &mut self,
        takeoff: &Station,
        among: Range<usize>,
        direction: Direction,
        mut visit: impl FnMut(usize, Result<SlopeInterval, Limit>) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let Self { table, lanes, overflight } = self;
        let table = &**table;
        let (test, stations, refusals) = (table.test(), table.stations(), &table.rules(direction).refusal);
        let among = table.part_ahead(takeoff, among, direction);
        let rule = match test.allowed(takeoff, Contact::Takeoff, direction) {
            Ok(rule) => rule,
            Err(limit) => return outwards(among, direction).try_for_each(|i| visit(i, Err(limit))),
        };
        let speed = tolerant_speed_m_s(rule.speed_max_m_s());
        let point = takeoff.point;
        let from = Departure { x_m: point.x_m, z_m: point.z_m, speed_squared: speed * speed, cone: rule.slopes() };
        let (in_plane, beyond_bend) = table.split_at_bend(takeoff, among, direction);
        let (in_plane, beyond_layer) = table.split_at_layer(takeoff, in_plane, direction);
        let (on_segment, mut left) = table.split_at_segment(takeoff, in_plane, direction);
        outwards(on_segment, direction).try_for_each(|i| visit(i, test.lofts(takeoff, &stations[i])))?;
        overflight.begin(takeoff, direction);
        while !left.is_empty() {
            let block = next_block(&mut left, direction);
            if let Some(limit) = table.out_of_reach(&from, &block, direction) {
                outwards(block, direction).try_for_each(|i| visit(i, Err(refusals[i].unwrap_or(limit))))?;
                continue;
            }
            let positions = (table.x_m.as_slice(), table.z_m.as_slice());
            lanes.evaluate(test, &from, positions, table.rules(direction), block.clone(), overflight.seen_at_ramp());
            let tapered = test.clearance().has_kinks();
            for i in outwards(block.clone(), direction) {
                let (landing, lane) = (Landing { table, lanes, overflight }, i - block.start);
                let verdict = match refusals[i] {
                    Some(limit) => Err(limit),
                    None if tapered => landing.verdict::<true>(&from, takeoff, direction, i, lane),
                    None => landing.verdict::<false>(&from, takeoff, direction, i, lane),
                };
                visit(i, verdict)?;
            }
        }
        outwards(beyond_layer, direction).try_for_each(|i| visit(i, Err(table.refused_beyond_layer(takeoff, i, direction))))?;
        outwards(beyond_bend, direction).try_for_each(|i| visit(i, Err(refusals[i].unwrap_or(Limit::Bend))))
    }
}

/// The inputs of the verdict on one landing.
struct Landing<'s> {
    table: &'s LandingTable,
    lanes: &'s Lanes,
    overflight: &'s mut Overflight,
}

impl Landing<'_> {
    /// The result for a landing that its ground allows and whose lane of the block is evaluated.
    #[inline]
    fn verdict<const TAPERED: bool>(
        self,
        from: &Departure,
        takeoff: &Station,
        direction: Direction,
        i: usize,
        lane: usize,
    ) -> Result<SlopeInterval, Limit> {
        let (test, landing) = (self.table.test(), &self.table.stations()[i]);
        let Some(in_envelope) = self.lanes.lofts(lane) else {
            let rules = self.table.rules(direction);
            let cone = SlopeInterval { lower: rules.cone_lower[i], upper: rules.cone_upper[i] };
            let run_m = (landing.point.x_m - from.x_m).abs();
            return Err(self.lanes.refusing(test, from, lane, run_m, cone));
        };
        let mut least = in_envelope.lower;
        let mut near = Near::Skipped;
        let rules = self.table.rules(direction);
        if TAPERED && self.lanes.near_ground_may_bind(lane) {
            let (run_m, slope) = ((self.table.x_m[i] - from.x_m).abs(), self.lanes.slope(lane));
            if run_m < self.overflight.two_ramps_m() {
                near = Near::Scanned;
                least = least.max(self.overflight.middle_loft(landing, run_m, slope));
            } else {
                near = Near::Front(&rules.near[i]);
                least = least.max(self.overflight.kinks_loft(rules.seen_back[i], run_m, slope));
            }
            if least > in_envelope.upper {
                return Err(Limit::Terrain);
            }
        }
        let lower = self.overflight.lower_end::<TAPERED>(landing, rules.approach[i], self.lanes.slope(lane), least, near);
        if (lower - in_envelope.upper).abs() <= TOUCHING * (lower.abs() + in_envelope.upper.abs()) && lower > in_envelope.lower {
            return test.lofts(takeoff, landing);
        }
        let lofts = SlopeInterval { lower, upper: in_envelope.upper };
        if lower > in_envelope.upper {
            return Err(Limit::Terrain);
        }
        if test.takeoff_speeds().are_any() {
            return Ok(lofts);
        }
        let sight = LineOfSight::along((landing.point.x_m - from.x_m).abs(), self.lanes.slope(lane));
        let refused = test.refused_command(sight, lofts);
        let hair = if lower > in_envelope.lower { TOUCHING * lower } else { 0.0 };
        let near = [-hair, hair].map(|by| test.refused_command(sight, SlopeInterval { lower: lower + by, ..lofts }));
        if near != [refused; 2] {
            return test.lofts(takeoff, landing);
        }
        refused.map_or(Ok(lofts), Err)
    }
}

/// The indices of a range, ordered by distance from the take-off.
#[inline]
fn outwards(range: Range<usize>, direction: Direction) -> impl Iterator<Item = usize> {
    let (start, end) = (range.start, range.end);
    range.map(move |i| if direction == Direction::Forward { i } else { end - 1 - (i - start) })
}

/// Removes the nearest block from the remaining range: landings of one block of the table's indices.
fn next_block(left: &mut Range<usize>, direction: Direction) -> Range<usize> {
    match direction {
        Direction::Forward => {
            let start = left.start;
            left.start = ((start / LandingTable::BLOCK + 1) * LandingTable::BLOCK).min(left.end);
            start..left.start
        }
        Direction::Reverse => {
            let end = left.end;
            left.end = ((end - 1) / LandingTable::BLOCK * LandingTable::BLOCK).max(left.start);
            left.end..end
        }
    }
}
