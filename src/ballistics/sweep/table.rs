//! The landings of a set of stations, laid out for sweeps.

use crate::{ballistics::HopTest, chain::Station};

/// A set of stations from left to right, prepared as landings: built once, shared by every sweep over it, in any thread.
#[derive(Clone, Debug)]
pub struct LandingTable<'a> {
    test: &'a HopTest<'a>,
    stations: &'a [Station],
}

impl<'a> LandingTable<'a> {
    /// The landings on stations that rise in x, no two at the same x.
    pub const fn new(test: &'a HopTest<'a>, stations: &'a [Station]) -> Self {
        Self { test, stations }
    }

    /// The hop test behind the verdicts.
    pub const fn test(&self) -> &'a HopTest<'a> {
        self.test
    }

    /// The stations.
    pub const fn stations(&self) -> &'a [Station] {
        self.stations
    }
}
