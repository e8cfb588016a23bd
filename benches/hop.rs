//! The hop test: one pair, and one take-off against every landing in reach.
//!
//! `cargo bench --bench hop`. Compare lines of one run with each other: absolute times depend on the machine and its load.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]

mod support;

use std::sync::Arc;

use chta::{
    chain::PolygonalChain,
    ground::{LandingTable, Sweep},
    hop::HopTest,
    quantity::VertexId,
    world::{Direction, Hopper, HopperLimits},
};
use divan::{Bencher, black_box, counter::ItemsCount};

fn main() {
    divan::main();
}

/// One pair 15 vertices apart, by the kernel: all limits, no explanation.
#[divan::bench]
fn one_pair_kernel(bencher: Bencher<'_, '_>) {
    let (chain, _) = support::fractal_chain(200);
    let test = HopTest::new(chain.clone());
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    bencher.bench_local(|| test.lofts(black_box(&at(100)), black_box(&at(115))));
}

/// The same pair explained: every limit separately, and the binding limits.
#[divan::bench]
fn one_pair_explained(bencher: Bencher<'_, '_>) {
    let (chain, _) = support::fractal_chain(200);
    let test = HopTest::new(chain.clone());
    let at = |i| chain.geometry().vertex_station(VertexId(i));
    bencher.bench_local(|| test.takeoff_set(black_box(&at(100)), black_box(&at(115))));
}

/// One take-off in the middle against all landings within a window of vertices on either side.
#[divan::bench(args = [30, 200, 2000])]
fn one_takeoff_all_landings(bencher: Bencher<'_, '_>, window: usize) {
    let (chain, _) = support::fractal_chain(2 * window + 1);
    let test = HopTest::new(chain.clone());
    let stations: Vec<_> = (0..=2 * window).map(|i| chain.geometry().vertex_station(VertexId(i))).collect();
    let takeoff = stations[window];
    bencher
        .counter(ItemsCount::new(2 * window))
        .bench_local(|| stations.iter().filter(|landing| test.lofts(black_box(&takeoff), black_box(landing)).is_ok()).count());
}

/// The same by a sweep: speeds exclude the far landings, as they do in a search (in `sweep_against_plain` they do not).
#[divan::bench(args = [30, 200, 2000])]
fn one_takeoff_swept(bencher: Bencher<'_, '_>, window: usize) {
    let (chain, _) = support::fractal_chain(2 * window + 1);
    let test = HopTest::new(chain.clone());
    let stations: Vec<_> = (0..=2 * window).map(|i| chain.geometry().vertex_station(VertexId(i))).collect();
    let takeoff = stations[window];
    let table = Arc::new(LandingTable::new(&test, stations.as_slice()));
    let mut sweep = Sweep::new(Arc::clone(&table));
    bencher.counter(ItemsCount::new(2 * window)).bench_local(|| {
        let mut feasible = 0;
        for direction in Direction::BOTH {
            let all = 0..stations.len();
            sweep.landings(black_box(&takeoff), all, direction, |_, verdict| feasible += usize::from(verdict.is_ok()));
        }
        feasible
    });
}

/// The bound on reach that a search computes at every take-off, on a chain of 100 000 segments.
#[divan::bench]
fn reach_of_one_takeoff(bencher: Bencher<'_, '_>) {
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(10.0, 10.0) }).expect("a valid hopper");
    let geometry = PolygonalChain::bare(support::long_chain(100_000, 1)).expect("a chain");
    let chain = support::constrained(geometry, &hopper);
    let test = HopTest::new(chain.clone());
    let takeoff = chain.geometry().vertex_station(VertexId(50_000));
    bencher.bench_local(|| test.reach_bound_m(black_box(&takeoff)));
}
