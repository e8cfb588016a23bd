//! The landings of a set of stations, stored for sweeps.

use std::{ops::Range, sync::Arc};

use rayon::prelude::*;

use super::{lanes::Departure, near::NearGround, terrain::Approach};
use crate::{
    ballistics::LineOfSight,
    chain::{ChainLayers, Station},
    hop::{HopTest, ground_slope},
    world::{Contact, Direction, Limit, tolerant_speed_m_s},
};

/// A set of stations from left to right, prepared as landings: built once, shared by all sweeps and threads.
///
/// Stored column by column, since a sweep reads few numbers of many stations.
///
/// # Memory
/// 98 bytes per station; 234 with a tapered clearance.
#[derive(Clone, Debug)]
pub struct LandingTable {
    test: HopTest,
    stations: Arc<[Station]>,
    pub(super) x_m: Vec<f64>,
    pub(super) z_m: Vec<f64>,
    /// By direction of travel.
    rules: [LandingRules; 2],
    blocks: Vec<Block>,
}

/// The extremes of height and speed over one block of stations.
#[derive(Clone, Copy, Debug)]
struct Block {
    lowest_m: f64,
    highest_m: f64,
    /// The greatest squared landing speed by direction, m^2/s^2.
    speed_squared: [f64; 2],
}

/// The limits of the ground on landings in one direction of travel, column by column.
#[derive(Clone, Debug, Default)]
pub(super) struct LandingRules {
    /// The greatest landing speed with its tolerance, squared, m^2/s^2; 0 where the ground refuses.
    pub(super) speed_squared: Vec<f64>,
    /// The steepest descent allowed: the lower end of the landing cone.
    pub(super) cone_lower: Vec<f64>,
    /// The upper end of the landing cone.
    pub(super) cone_upper: Vec<f64>,
    /// The limit by which the ground refuses the landing, if it does.
    pub(super) refusal: Vec<Option<Limit>>,
    /// The ground from the last vertex flown over.
    pub(super) approach: Vec<Approach>,
    /// The slope back from the landing to the ground one ramp of a tapered clearance before it; empty without a taper.
    pub(super) seen_back: Vec<f64>,
    /// The steepest slope back from the landing to that ground and to the vertices nearer; empty without a taper.
    pub(super) steepest_back: Vec<f64>,
    /// The vertices nearer than one ramp; empty without a taper.
    pub(super) near: Vec<NearGround>,
}

impl LandingTable {
    /// The landings on stations in ascending order of x, no two at the same x.
    pub fn new(test: &HopTest, stations: impl Into<Arc<[Station]>>) -> Self {
        let stations = stations.into();
        let z_m: Vec<f64> = stations.iter().map(|station| station.point.z_m).collect();
        let rules = Direction::BOTH.map(|direction| LandingRules::new(test, &stations, direction));
        let greatest = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let blocks = (0..stations.len())
            .step_by(Self::BLOCK)
            .map(|start| start..(start + Self::BLOCK).min(stations.len()))
            .map(|block| Block {
                lowest_m: z_m[block.clone()].iter().copied().fold(f64::INFINITY, f64::min),
                highest_m: greatest(&z_m[block.clone()]),
                speed_squared: [0, 1].map(|direction: usize| greatest(&rules[direction].speed_squared[block.clone()])),
            })
            .collect();
        let x_m = stations.iter().map(|station| station.point.x_m).collect();
        Self { test: test.clone(), stations, x_m, z_m, rules, blocks }
    }

    /// Number of stations that a sweep evaluates at once: those of one block of indices, so that the bounds of the block
    /// apply.
    pub(super) const BLOCK: usize = 64;

    /// Whether no landing of a block of indices (or part of one) can be reached, and by which speed limit: its nearest,
    /// lowest position lies outside the parabola of safety of the take-off, or all positions inside that parabola lie outside
    /// the parabola of the landing.
    ///
    /// A margin larger than rounding is required: positions close to a parabola are left to the formulas of the hop test.
    pub(super) fn out_of_reach(&self, from: &Departure, block: &Range<usize>, direction: Direction) -> Option<Limit> {
        /// Much larger than rounding.
        const CLEARLY: f64 = 1.0 + 1e-9;
        let ends = &self.blocks[block.start / Self::BLOCK];
        let landing_squared = ends.speed_squared[direction as usize];
        let gravity = self.test.gravity_m_s2();
        let (left_m, right_m) = ((self.x_m[block.start] - from.x_m).abs(), (self.x_m[block.end - 1] - from.x_m).abs());
        let (near_m, far_m) = (left_m.min(right_m), left_m.max(right_m));
        let (low_m, high_m) = (ends.lowest_m - from.z_m, ends.highest_m - from.z_m);
        let squared = |run_m: f64, speed_ratio: f64| gravity * run_m * speed_ratio;
        if squared(near_m, LineOfSight::new(near_m, low_m).min_speed_ratio()) > from.speed_squared * CLEARLY {
            return Some(Limit::TakeoffSpeed);
        }
        let all_inside = squared(far_m, LineOfSight::new(far_m, high_m).min_speed_ratio()) * CLEARLY < from.speed_squared;
        let landing = squared(near_m, LineOfSight::new(near_m, high_m).min_speed_ratio_reversed());
        (all_inside && landing > landing_squared * CLEARLY).then_some(Limit::LandingSpeed)
    }

    /// The hop test that gives the results.
    #[inline]
    pub const fn test(&self) -> &HopTest {
        &self.test
    }

    /// The stations.
    #[inline]
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// The limits of the ground in one direction.
    pub(super) const fn rules(&self, direction: Direction) -> &LandingRules {
        &self.rules[direction as usize]
    }

    /// The stations that lie in a direction from a take-off, and no farther than a horizontal distance, m.
    ///
    pub fn within(&self, takeoff: &Station, direction: Direction, distance_m: f64) -> Range<usize> {
        let x_m = takeoff.point.x_m;
        match direction {
            Direction::Forward => {
                let first = self.x_m.partition_point(|&x| x <= x_m);
                first..first + self.x_m[first..].partition_point(|&x| x - x_m <= distance_m)
            }
            Direction::Reverse => {
                let end = self.x_m.partition_point(|&x| x < x_m);
                self.x_m[..end].partition_point(|&x| x_m - x > distance_m)..end
            }
        }
    }

    /// The stations that one hop from a take-off may reach in a direction: none beyond
    /// [`landing_reach_m`](HopTest::landing_reach_m).
    pub fn in_reach(&self, takeoff: &Station, direction: Direction) -> Range<usize> {
        self.within(takeoff, direction, self.test.landing_reach_m(takeoff, direction))
    }

    /// The part of a range of stations that lies in a direction from a take-off.
    pub(super) fn part_ahead(&self, takeoff: &Station, among: Range<usize>, direction: Direction) -> Range<usize> {
        let x_m = takeoff.point.x_m;
        let among = among.start.min(self.x_m.len())..among.end.min(self.x_m.len());
        match direction {
            Direction::Forward => self.first_where(among.clone(), |x| x > x_m)..among.end,
            Direction::Reverse => among.start..self.first_where(among, |x| x >= x_m),
        }
    }

    /// Divides a range of stations ahead of a take-off into those in its plane of travel and those beyond a bend.
    pub(super) fn split_at_bend(
        &self,
        takeoff: &Station,
        ahead: Range<usize>,
        direction: Direction,
    ) -> (Range<usize>, Range<usize>) {
        let Some(bend_m) = self.test.chain().geometry().next_bend_m(takeoff.point.x_m, direction) else {
            return match direction {
                Direction::Forward => (ahead.clone(), ahead.end..ahead.end),
                Direction::Reverse => (ahead.clone(), ahead.start..ahead.start),
            };
        };
        match direction {
            Direction::Forward => {
                let cut = self.first_where(ahead.clone(), |x| x > bend_m);
                (ahead.start..cut, cut..ahead.end)
            }
            Direction::Reverse => {
                let cut = self.first_where(ahead.clone(), |x| x >= bend_m);
                (cut..ahead.end, ahead.start..cut)
            }
        }
    }

    /// Divides a range of stations ahead of a take-off into those that a flight reaches without meeting a layer that refuses it and
    /// those beyond.
    pub(super) fn split_at_layer(
        &self,
        takeoff: &Station,
        ahead: Range<usize>,
        direction: Direction,
    ) -> (Range<usize>, Range<usize>) {
        let geometry = self.test.chain().geometry();
        let restricted = geometry.layers().is_some_and(ChainLayers::restrict_flights);
        let meets = |x_m: f64| restricted && geometry.layer_refusing_flight(takeoff.point.x_m, x_m).is_some();
        match direction {
            Direction::Forward => {
                let cut = if restricted { self.first_where(ahead.clone(), meets) } else { ahead.end };
                (ahead.start..cut, cut..ahead.end)
            }
            Direction::Reverse => {
                let cut = if restricted { self.first_where(ahead.clone(), |x_m| !meets(x_m)) } else { ahead.start };
                (cut..ahead.end, ahead.start..cut)
            }
        }
    }

    /// The limit that refuses a landing beyond a layer that refuses the flight.
    #[cold]
    pub(super) fn refused_beyond_layer(&self, takeoff: &Station, landing: usize, direction: Direction) -> Limit {
        let flight = || self.test.chain().geometry().layer_refusing_flight(takeoff.point.x_m, self.x_m[landing]).map(Limit::Layer);
        self.rules(direction).refusal[landing].or_else(flight).unwrap_or(Limit::Direction)
    }

    /// Divides a range of stations ahead of a take-off into those that share a segment with it and those beyond.
    pub(super) fn split_at_segment(
        &self,
        takeoff: &Station,
        ahead: Range<usize>,
        direction: Direction,
    ) -> (Range<usize>, Range<usize>) {
        let shares = |i: &usize| self.stations[*i].shared_segment(takeoff).is_some();
        match direction {
            Direction::Forward => {
                let cut = ahead.start + ahead.clone().take_while(shares).count();
                (ahead.start..cut, cut..ahead.end)
            }
            Direction::Reverse => {
                let cut = ahead.end - ahead.clone().rev().take_while(shares).count();
                (cut..ahead.end, ahead.start..cut)
            }
        }
    }

    /// The first station of a range whose x satisfies a condition that all stations to its right also satisfy.
    fn first_where(&self, range: Range<usize>, holds: impl Fn(f64) -> bool) -> usize {
        range.start + self.x_m[range].partition_point(|&x| !holds(x))
    }
}

impl LandingRules {
    fn new(test: &HopTest, stations: &[Station], direction: Direction) -> Self {
        let mut rules = Self::default();
        rules.speed_squared.reserve_exact(stations.len());
        rules.cone_lower.reserve_exact(stations.len());
        rules.cone_upper.reserve_exact(stations.len());
        rules.refusal.reserve_exact(stations.len());
        rules.approach = stations.iter().map(|station| Approach::to(test, station, direction)).collect();
        let ramp_m = test.clearance().ramp_m();
        if test.clearance().has_kinks() {
            let geometry = test.chain().geometry();
            let back = if direction == Direction::Forward { Direction::Reverse } else { Direction::Forward };
            rules.seen_back = stations.iter().map(|station| ground_slope(geometry, station, back, ramp_m)).collect();
            // Where no hop is as long as two ramps, no sweep uses it.
            let asked = 2.0 * ramp_m <= test.greatest_reach_m();
            let near = |station| if asked { NearGround::of(test, station, direction) } else { NearGround::NO_VERTEX };
            rules.near = stations.iter().map(near).collect();
            let steepest = rules.seen_back.iter().zip(&rules.near).map(|(kink, near)| kink.max(near.steepest_back()));
            rules.steepest_back = steepest.collect();
        }
        let allowed = |station| test.allowed(station, Contact::Landing, direction);
        // Fitting the ground under a footprint takes microseconds, reading the rule of a segment nanoseconds.
        let fitted: Option<Vec<_>> = test.chain().footprint().map(|_| stations.par_iter().map(allowed).collect());
        for (index, station) in stations.iter().enumerate() {
            let allowed = fitted.as_ref().map_or_else(|| allowed(station), |fitted| fitted[index]);
            let speed = allowed.map_or(0.0, |rule| tolerant_speed_m_s(rule.speed_max_m_s()));
            rules.speed_squared.push(speed * speed);
            rules.cone_lower.push(allowed.map_or(0.0, |rule| rule.slopes().lower));
            rules.cone_upper.push(allowed.map_or(0.0, |rule| rule.slopes().upper));
            rules.refusal.push(allowed.err());
        }
        rules
    }
}
