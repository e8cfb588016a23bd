//! Sweeps of a hundred take-offs over rough Martian ground under either rule of the clearance, for counting instructions.
//!
//! `benches/sweep_rules.sh` runs it under valgrind and prints instructions per pair. By hand:
//! `cargo bench --bench sweep_rules -- WINDOW FRICTION CLEARANCE vertex|tapered ROUNDS`.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "it prints what it counted")]

mod support;

use std::{hint::black_box, str::FromStr, sync::Arc};

use chta::{
    chain::Station,
    ground::{LandingTable, Sweep},
    hop::HopTest,
    quantity::VertexId,
    world::{ClearanceRule, Direction, Hopper, HopperLimits},
};

/// Take-offs per round, next to each other.
const TAKEOFFS: usize = 100;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|arg| arg != "--bench").collect();
    let [window, friction, clearance_m, rule, rounds] = args.as_slice() else {
        println!("skipped: it takes WINDOW FRICTION CLEARANCE vertex|tapered ROUNDS; see benches/sweep_rules.sh");
        return;
    };
    let clearance_rule = if rule == "vertex" { ClearanceRule::Vertex } else { ClearanceRule::TAPERED };
    let feasible = swept(parsed(window), parsed(friction), (parsed(clearance_m), clearance_rule), parsed(rounds));
    println!("{feasible} feasible pairs");
}

fn parsed<T: FromStr>(text: &str) -> T {
    text.parse().ok().expect("a number")
}

fn swept(window: usize, friction: f64, (clearance_m, clearance_rule): (f64, ClearanceRule), rounds: usize) -> usize {
    let (chain, _) = support::fractal_chain(2 * window + TAKEOFFS);
    #[expect(clippy::cast_precision_loss, reason = "a few thousand metres")]
    let speed = (support::MARS_M_S2 * 4.0 * window as f64).sqrt();
    let limits = HopperLimits { clearance_m, clearance_rule, ..HopperLimits::with_speeds(speed, speed) };
    let hopper = Hopper::new(limits).expect("a valid hopper");
    let test = HopTest::new(support::constrained_by(chain.geometry().clone(), &hopper, friction));
    let geometry = test.chain().geometry();
    let stations: Arc<[Station]> = (0..=geometry.segment_count()).map(|i| geometry.vertex_station(VertexId(i))).collect();
    let mut sweep = Sweep::new(LandingTable::new(&test, Arc::clone(&stations)));
    let mut feasible = 0;
    for takeoff in (0..rounds).flat_map(|_| window..window + TAKEOFFS) {
        let among = takeoff - window..takeoff + window + 1;
        for direction in Direction::BOTH {
            sweep.landings(black_box(&stations[takeoff]), among.clone(), direction, |_, verdict| {
                feasible += usize::from(verdict.is_ok());
            });
        }
    }
    feasible
}
