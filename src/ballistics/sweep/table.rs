//! The landings of a set of stations, laid out for sweeps.

use std::ops::Range;

use crate::{
    ballistics::HopTest,
    chain::{Contact, Direction, Station},
    world::{Limit, tolerant_speed_m_s},
};

/// A set of stations from left to right, prepared as landings: built once, shared by every sweep over it, in any thread.
///
/// Column by column, since a sweep reads a few numbers of many stations and not all that is known of one.
///
/// # Memory
/// 66 bytes a station.
#[derive(Clone, Debug)]
pub struct LandingTable<'a> {
    test: &'a HopTest<'a>,
    stations: &'a [Station],
    pub(super) x_m: Vec<f64>,
    pub(super) z_m: Vec<f64>,
    /// By direction of travel.
    rules: [LandingRules; 2],
}

/// What the ground grants to landings in one direction of travel, column by column.
#[derive(Clone, Debug, Default)]
pub(super) struct LandingRules {
    /// The greatest landing speed with its tolerance, squared, m^2/s^2; 0 where the ground refuses.
    pub(super) speed_squared: Vec<f64>,
    /// The steepest descent allowed: the lower end of the landing cone.
    pub(super) cone_lower: Vec<f64>,
    /// The upper end of the landing cone.
    pub(super) cone_upper: Vec<f64>,
    /// Why the ground refuses, where it does.
    pub(super) refusal: Vec<Option<Limit>>,
}

impl<'a> LandingTable<'a> {
    /// The landings on stations that rise in x, no two at the same x.
    pub fn new(test: &'a HopTest<'a>, stations: &'a [Station]) -> Self {
        Self {
            test,
            stations,
            x_m: stations.iter().map(|station| station.point.x_m).collect(),
            z_m: stations.iter().map(|station| station.point.z_m).collect(),
            rules: Direction::BOTH.map(|direction| LandingRules::new(test, stations, direction)),
        }
    }

    /// The hop test behind the verdicts.
    pub const fn test(&self) -> &'a HopTest<'a> {
        self.test
    }

    /// The stations.
    pub const fn stations(&self) -> &'a [Station] {
        self.stations
    }

    /// What the ground grants in one direction.
    pub(super) const fn rules(&self, direction: Direction) -> &LandingRules {
        &self.rules[direction as usize]
    }

    /// The stations that lie in a direction from a take-off, and no farther than a horizontal distance, m.
    ///
    /// With [`HopTest::landing_reach_m`] as the distance: all that one hop may reach.
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

    /// Of a range of stations, those that lie in a direction from a take-off.
    pub(super) fn part_ahead(&self, takeoff: &Station, among: Range<usize>, direction: Direction) -> Range<usize> {
        let x_m = takeoff.point.x_m;
        let among = among.start.min(self.x_m.len())..among.end.min(self.x_m.len());
        match direction {
            Direction::Forward => self.first_where(among.clone(), |x| x > x_m)..among.end,
            Direction::Reverse => among.start..self.first_where(among, |x| x >= x_m),
        }
    }

    /// A range of stations ahead of a take-off, cut into those in its plane of travel and those beyond a bend.
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

    /// A range of stations ahead of a take-off, cut into those that share a segment with it and those beyond.
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

    /// The first station of a range at an x where something holds, which then holds for all to its right.
    fn first_where(&self, range: Range<usize>, holds: impl Fn(f64) -> bool) -> usize {
        range.start + self.x_m[range].partition_point(|&x| !holds(x))
    }
}

impl LandingRules {
    fn new(test: &HopTest<'_>, stations: &[Station], direction: Direction) -> Self {
        let mut rules = Self::default();
        rules.speed_squared.reserve_exact(stations.len());
        rules.cone_lower.reserve_exact(stations.len());
        rules.cone_upper.reserve_exact(stations.len());
        rules.refusal.reserve_exact(stations.len());
        for station in stations {
            let granted = test.granted(station, Contact::Landing, direction);
            let speed = granted.map_or(0.0, |rule| tolerant_speed_m_s(rule.speed_max_m_s()));
            rules.speed_squared.push(speed * speed);
            rules.cone_lower.push(granted.map_or(0.0, |rule| rule.slopes().lower));
            rules.cone_upper.push(granted.map_or(0.0, |rule| rule.slopes().upper));
            rules.refusal.push(granted.err());
        }
        rules
    }
}
