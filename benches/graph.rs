//! The whole analysis: nodes, hops, search. How time grows with vertices, points per segment and reach.
//!
//! `cargo bench --bench graph`. Compare lines of one run with each other: absolute times depend on the machine and its load.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]

mod support;

use chta::{
    graph::{PointSpacing, SearchOptions, search},
    hop::HopTest,
    world::{Hopper, HopperLimits},
};
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

/// End to end over a fractal chain of one-metre segments.
fn across(bencher: Bencher<'_, '_>, segments: usize, points: u32, speed_m_s: f64) {
    let (chain, _) = support::fractal_chain(segments);
    let hopper =
        Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(speed_m_s, speed_m_s) }).expect("a valid hopper");
    let chain = support::constrained(chain.geometry().clone(), &hopper);
    let test = HopTest::new(chain.clone());
    let (first_m, last_m) = chain.geometry().extent_m();
    let station = |x_m| chain.geometry().station(x_m).expect("an end of the chain");
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(points)), ..SearchOptions::default() };
    bencher.bench_local(|| search(black_box(&test), station(first_m), station(last_m), &options, &()));
}

/// Time against the number of segments, at 10 m/s and no points inside.
#[divan::bench(args = [100, 300, 1000, 3000])]
fn by_segments(bencher: Bencher<'_, '_>, segments: usize) {
    across(bencher, segments, 0, 10.0);
}

/// Time against points per segment, 300 segments at 10 m/s.
#[divan::bench(args = [0, 1, 3, 7])]
fn by_points_per_segment(bencher: Bencher<'_, '_>, points: u32) {
    across(bencher, 300, points, 10.0);
}

/// Time against reach, which is proportional to the square of the speed: 1000 segments, no points inside.
#[divan::bench(args = [5, 7, 10, 14, 20])]
fn by_speed(bencher: Bencher<'_, '_>, speed_m_s: u32) {
    across(bencher, 1000, 0, f64::from(speed_m_s));
}
