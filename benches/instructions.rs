//! Instructions of one sweep, of the hop test pair by pair, and of the plain version, counted by valgrind and so independent of
//! other load on the machine.
//!
//! `cargo bench --bench instructions`. Needs valgrind and `cargo install gungraun-runner --version 0.20.0`; without them it prints
//! the reason and stops. Divide by the pairs in the name: a window of 200 is 400 pairs.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "it says why it does not run")]
#![allow(
    missing_docs,
    missing_debug_implementations,
    unused_qualifications,
    unreachable_pub,
    elided_lifetimes_in_paths,
    reason = "what gungraun's macros write"
)]
#![allow(clippy::pedantic, clippy::use_self, clippy::exit, reason = "what gungraun's macros write")]

mod support;

use std::{hint::black_box, process::Command, sync::Arc};

use chta::{
    chain::Station,
    ground::{LandingTable, Sweep},
    hop::HopTest,
    quantity::VertexId,
    world::{Direction, Hopper, HopperLimits},
};
use gungraun::{library_benchmark, library_benchmark_group};

/// All that one take-off against a window needs, created before counting begins.
struct Scene {
    test: HopTest,
    stations: Arc<[Station]>,
    sweep: Sweep,
    window: usize,
}

/// Rough Martian ground at four times the speed that its window needs, after one sweep that allocated the working memory.
fn scene(window: usize, friction: f64) -> Scene {
    let (chain, _) = support::fractal_chain(2 * window);
    #[expect(clippy::cast_precision_loss, reason = "a few thousand metres")]
    let speed = (support::MARS_M_S2 * 4.0 * window as f64).sqrt();
    let hopper =
        Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(speed, speed) }).expect("a valid hopper");
    let test = HopTest::new(support::constrained_by(chain.geometry().clone(), &hopper, friction));
    let chain = test.chain();
    let stations: Vec<Station> = (0..=2 * window).map(|i| chain.geometry().vertex_station(VertexId(i))).collect();
    let stations: Arc<[Station]> = stations.into();
    let sweep = Sweep::new(LandingTable::new(&test, Arc::clone(&stations)));
    let mut scene = Scene { test, stations, sweep, window };
    scene.swept();
    scene
}

impl Scene {
    fn swept(&mut self) -> usize {
        let mut feasible = 0;
        for direction in Direction::BOTH {
            let takeoff = black_box(&self.stations[self.window]);
            self.sweep.landings(takeoff, 0..self.stations.len(), direction, |_, verdict| feasible += usize::from(verdict.is_ok()));
        }
        feasible
    }
}

#[library_benchmark]
#[bench::window_30(scene(30, 0.6))]
#[bench::window_200(scene(200, 0.6))]
#[bench::window_2000(scene(2000, 0.6))]
#[bench::window_200_ground_decides(scene(200, 5.0))]
fn sweep(mut scene: Scene) -> usize {
    scene.swept()
}

#[library_benchmark]
#[bench::window_30(scene(30, 0.6))]
#[bench::window_200(scene(200, 0.6))]
fn plain(scene: Scene) -> usize {
    let takeoff = black_box(&scene.stations[scene.window]);
    scene.stations.iter().filter(|landing| support::plain::lofts(&scene.test, takeoff, landing).is_some()).count()
}

library_benchmark_group!(name = hop; benchmarks = sweep, plain);

fn main() {
    let runner = std::env::var("GUNGRAUN_RUNNER").unwrap_or_else(|_| "gungraun-runner".to_owned());
    for (program, mend) in [("valgrind", "install valgrind"), (&runner, "cargo install gungraun-runner --version 0.20.0")] {
        // The exit status does not matter, only whether the program exists.
        if Command::new(program).arg("--version").output().is_err() {
            println!("skipped: no {program} to count instructions with; {mend}");
            return;
        }
    }
    counted::run();
}

mod counted {
    use super::hop;

    gungraun::main!(library_benchmark_groups = hop);

    pub(super) fn run() {
        main();
    }
}
