//! One take-off against all landings of a window: the sweep against the plain hop test, in one run, as a table.
//!
//! `cargo bench --bench sweep_against_plain`. Both count the feasible landings, which must agree. All limits are included; the
//! window is a number of vertices to either side of the take-off, and the speeds are high enough that reach does not limit it.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "it prints a table")]

mod support;

use std::{
    hint::black_box,
    ops::Range,
    time::{Duration, Instant},
};

use std::sync::Arc;

use chta::{
    chain::Station,
    ground::{LandingTable, Sweep},
    hop::HopTest,
    quantity::VertexId,
    world::{Direction, Hopper, HopperLimits, Limit},
};

/// The fastest of this many alternating rounds counts: the least disturbed one.
const ROUNDS: usize = 25;

/// Take-offs per round: enough that branch prediction cannot memorise them, and that the rounds of all windows take about equally
/// long.
const fn takeoffs_of(window: usize) -> usize {
    if window > 200 { 20 } else { 100 }
}

/// One ground for the measurements.
struct Scene {
    name: &'static str,
    friction: f64,
    clearance_m: f64,
    /// v^2 / g over the window's length.
    reach_per_window: f64,
}

const SCENES: [Scene; 4] = [
    Scene { name: "friction 0.6", friction: 0.6, clearance_m: 0.05, reach_per_window: 4.0 },
    Scene { name: "wide cones", friction: 5.0, clearance_m: 0.05, reach_per_window: 4.0 },
    Scene { name: "ground decides", friction: 5.0, clearance_m: 0.19, reach_per_window: 4.0 },
    Scene { name: "steep, slow", friction: 0.6, clearance_m: 0.05, reach_per_window: 1.2 },
];

fn main() {
    println!(
        "ns and millions of pairs a second: the least of {ROUNDS} rounds; shares: of all landings, left after each limit in turn"
    );
    println!(
        "{:<15} {:>6} {:>9} {:>9} {:>7} {:>7} {:>7} {:>9}  left after",
        "ground", "window", "plain ns", "sweep ns", "plain M", "sweep M", "ratio", "feasible"
    );
    for scene in &SCENES {
        for window in [30, 200, 2000] {
            measure(scene, window);
        }
    }
}

fn measure(scene: &Scene, window: usize) {
    let (chain, _) = support::fractal_chain(2 * window + takeoffs_of(window));
    #[expect(clippy::cast_precision_loss, reason = "a few thousand metres")]
    let speed = (support::MARS_M_S2 * scene.reach_per_window * window as f64).sqrt();
    let hopper = Hopper::new(HopperLimits { clearance_m: scene.clearance_m, ..HopperLimits::with_speeds(speed, speed) })
        .expect("a valid hopper");
    let chain = support::constrained_by(chain.geometry().clone(), &hopper, scene.friction);
    let test = HopTest::new(chain.clone());
    let stations: Vec<_> = (0..=chain.geometry().segment_count()).map(|i| chain.geometry().vertex_station(VertexId(i))).collect();
    let table = Arc::new(LandingTable::new(&test, stations.as_slice()));
    let takeoffs = || (window..window + takeoffs_of(window)).map(|i| (&stations[i], i - window..i + window + 1));
    let by_plain = || takeoffs().map(|(takeoff, among)| plain_count(&test, &stations, takeoff, among)).sum::<usize>();
    let mut sweep = Sweep::new(Arc::clone(&table));
    let mut by_sweep = || takeoffs().map(|(takeoff, among)| sweep_count(&mut sweep, takeoff, among)).sum::<usize>();
    let (feasible, swept) = (by_plain(), by_sweep());
    assert_eq!(feasible, swept, "plain test and sweep count different landings");
    let (mut plain_time, mut sweep_time) = (Duration::MAX, Duration::MAX);
    for _ in 0..ROUNDS {
        plain_time = plain_time.min(timed(by_plain));
        sweep_time = sweep_time.min(timed(&mut by_sweep));
    }
    #[expect(clippy::cast_precision_loss, reason = "some hundred thousand pairs")]
    let pairs = (2 * window * takeoffs_of(window)) as f64;
    let (plain_ns, sweep_ns) = (plain_time.as_secs_f64() * 1e9 / pairs, sweep_time.as_secs_f64() * 1e9 / pairs);
    println!(
        "{:<15} {window:>6} {plain_ns:>9.1} {sweep_ns:>9.1} {:>7.1} {:>7.1} {:>7.1} {feasible:>9}  {}",
        scene.name,
        1e3 / plain_ns,
        1e3 / sweep_ns,
        plain_ns / sweep_ns,
        survivors(&test, &stations, takeoffs(), pairs),
    );
}

fn plain_count(test: &HopTest, stations: &[Station], takeoff: &Station, among: Range<usize>) -> usize {
    stations[among].iter().filter(|landing| support::plain::lofts(test, black_box(takeoff), black_box(landing)).is_some()).count()
}

fn sweep_count(sweep: &mut Sweep, takeoff: &Station, among: Range<usize>) -> usize {
    let mut feasible = 0;
    for direction in Direction::BOTH {
        sweep.landings(black_box(takeoff), among.clone(), direction, |_, verdict| {
            feasible += usize::from(black_box(verdict).is_ok());
        });
    }
    feasible
}

fn timed(mut work: impl FnMut() -> usize) -> Duration {
    let begin = Instant::now();
    black_box(work());
    begin.elapsed()
}

/// The fraction of the pairs that each limit leaves, in the order of testing; limits that refuse nothing are omitted.
fn survivors<'a>(
    test: &HopTest,
    stations: &[Station],
    takeoffs: impl Iterator<Item = (&'a Station, Range<usize>)>,
    pairs: f64,
) -> String {
    let mut refused = [0u32; Limit::ALL.len()];
    let mut over_ground = 0u32;
    for (takeoff, among) in takeoffs {
        for landing in stations[among].iter().filter(|landing| landing.point.x_m != takeoff.point.x_m) {
            if let Err(limit) = test.lofts(takeoff, landing) {
                refused[limit.index()] += 1;
            } else {
                let lower = test.takeoff_set(takeoff, landing).and_then(|set| set.binding()).map(|binding| binding.lower.limit);
                over_ground += u32::from(lower == Some(Limit::Terrain));
            }
        }
    }
    let order = [
        (Limit::KeepOut, "ground"),
        (Limit::RestSlope, "ground"),
        (Limit::TakeoffSpeed, "speeds"),
        (Limit::LandingSpeed, "speeds"),
        (Limit::TakeoffCone, "cones"),
        (Limit::LandingCone, "cones"),
        (Limit::Terrain, "terrain"),
    ];
    let mut left = pairs;
    let mut left_after: Vec<(&str, f64)> = Vec::new();
    for (limit, name) in order {
        left -= f64::from(refused[limit.index()]);
        match left_after.last_mut() {
            Some(last) if last.0 == name => last.1 = left,
            _ => left_after.push((name, left)),
        }
    }
    let shares: Vec<_> = left_after.iter().map(|(name, left)| format!("{name} {:.1} %", 100.0 * left / pairs)).collect();
    format!("{}; lower end set by the ground: {:.1} %", shares.join(", "), 100.0 * f64::from(over_ground) / pairs)
}
