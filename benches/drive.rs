//! Drive maps: nodes a second by neighbours, limits and turns.
//!
//! `cargo bench --bench drive`. Compare lines of one run with each other: absolute times depend on the machine and its load. All on one
//! thread. `benches/peers/drive_run.sh` compares with scikit-image and GRASS.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "its result")]

use std::time::Instant;

use chta::{
    drive::{DriveAmount, DriveEdges, DriveGround, DriveMap, DriveSense},
    ground::{DemGround, NodeLattice},
    quantity::Angle,
    terrain::{OverlaidDem, Overlays, SyntheticTerrain, synthesise},
    world::{Gravity, Hopper, Neighbours, RestSlope, Rover, RoverLimits, SlipCurve, SurfaceProperties},
};

const SIDE: usize = 1024;

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
    let terrain = SyntheticTerrain { rows: SIDE, cols: SIDE, seed: 3, ..SyntheticTerrain::default() };
    let dem = synthesise(&terrain).expect("sound options");
    let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    let hopper = Hopper::with_speeds(1.0, 1.0).expect("a valid hopper");
    let terrain = OverlaidDem::new(dem, Overlays::default());
    let ground = DemGround::new(terrain, &hopper, Gravity::new(1.624).expect("a gravity"), &surface);
    println!("{SIDE} x {SIDE} posts, one thread; least of three times\n");
    println!("| neighbours | limits | legs, s | map, s | reached | million nodes a second |");
    println!("|---|---|---|---|---|---|");
    for neighbours in Neighbours::ALL {
        let free = RoverLimits { neighbours, ..RoverLimits::new(0.1, Angle::from_degrees(90.0)) };
        let slopes = RoverLimits { neighbours, ..RoverLimits::new(0.1, Angle::from_degrees(20.0)) };
        let slip = SlipCurve::new(&[[0.0, 0.0], [10.0, 0.1], [20.0, 0.4]]).expect("a curve");
        let slipping = RoverLimits { slip, ..slopes.clone() };
        let wheels = RoverLimits { step_max_m: Some(0.2), roughness_max_m: Some(0.1), wheelbase_m: Some(1.0), ..slopes.clone() };
        let turning = RoverLimits { turn_s_per_deg: 0.02, ..slopes.clone() };
        for (name, limits) in [
            ("none", free),
            ("slopes", slopes),
            ("slopes, slip", slipping),
            ("slopes, step, roughness", wheels),
            ("slopes, turns", turning),
        ] {
            let rover = Rover::new(limits, None).expect("valid limits");
            row(&ground, &rover, name);
        }
    }
}

fn row(ground: &DemGround, rover: &Rover, name: &str) {
    let drive = DriveGround::new(ground, rover);
    let lattice = NodeLattice::new(ground.terrain().dem(), 1);
    let (mut legs_s, mut map_s, mut reached) = (f64::INFINITY, f64::INFINITY, 0);
    for _ in 0..3 {
        let began = Instant::now();
        let edges = DriveEdges::new(&drive, lattice, DriveAmount::Time, &()).expect("not cancelled");
        let judged = Instant::now();
        let map = DriveMap::new(&edges, &[SIDE / 2 * (SIDE + 1)], DriveSense::From, &()).expect("not cancelled");
        legs_s = legs_s.min((judged - began).as_secs_f64());
        map_s = map_s.min(judged.elapsed().as_secs_f64());
        reached = map.reached();
    }
    #[expect(clippy::cast_precision_loss, reason = "a million nodes")]
    let rate = reached as f64 / (legs_s + map_s) / 1e6;
    println!("| {} | {name} | {legs_s:.3} | {map_s:.3} | {reached} | {rate:.2} |", rover.limits().neighbours.count());
}
