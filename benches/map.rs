//! Hop maps: against the plain method, pulling against pushing, and time against the number of posts.
//!
//! `cargo bench --bench map`. Compare lines of one run with each other: absolute times depend on the machine and its load. All on
//! one thread except the table of sizes.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "its result")]

#[path = "support/plain_map.rs"]
mod plain_map;

use std::time::Instant;

use chta::{
    ballistics::TakeoffChoice,
    graph::Effort,
    ground::DemGround,
    reach::map::{Journey, Post, PostHops, Search, UNREACHED, mobility, search},
    terrain::{Dem, OverlaidDem, Overlays, SyntheticTerrain, synthesise},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// Gravity of the Moon, m/s^2.
const MOON_M_S2: f64 = 1.624;

/// 12 posts of 1 m over level ground.
const SPEED_M_S: f64 = 4.414;

struct Scene {
    dem: Dem,
    hopper: Hopper,
    surface: SurfaceProperties,
}

impl Scene {
    /// Rough ground with craters.
    fn new(side: usize) -> Self {
        let dem = synthesise(&SyntheticTerrain { rows: side, cols: side, seed: 3, ..SyntheticTerrain::default() })
            .expect("sound options");
        let friction = FrictionCone::new(0.6).expect("a friction coefficient");
        let surface = SurfaceProperties { grip: Some(Grip::Friction(friction)), rest: RestSlope::AsFrictionHolds };
        Self {
            dem,
            hopper: Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(SPEED_M_S, SPEED_M_S) })
                .expect("a valid hopper"),
            surface,
        }
    }

    fn ground(&self) -> DemGround {
        let terrain = OverlaidDem::new(self.dem.clone(), Overlays::default());
        DemGround::new(terrain, &self.hopper, Gravity::new(MOON_M_S2).expect("a gravity"), &self.surface)
    }
}

/// The time of some work, s, and its result.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let began = Instant::now();
    let made = work();
    (began.elapsed().as_secs_f64(), made)
}

/// Fewest hops by pushing: each post of the layer tests all unreached posts within reach.
fn pushed(hops: &PostHops, start: Post) -> (Vec<i16>, u64) {
    let lattice = hops.lattice();
    let mut found = vec![UNREACHED; lattice.count()];
    let mut tested = 0;
    let mut layer = vec![start];
    found[lattice.index(start)] = 0;
    for next in 1.. {
        let mut reached = Vec::new();
        for &from in &layer {
            for offset in 0..hops.offset_count() {
                let Some(to) = hops.landing(from, offset) else { continue };
                let index = lattice.index(to);
                if found[index] != UNREACHED {
                    continue;
                }
                tested += 1;
                if hops.lofts(from, offset).expect("a sound request").is_some() {
                    found[index] = next;
                    reached.push(to);
                }
            }
        }
        if reached.is_empty() {
            return (found, tested);
        }
        layer = reached;
    }
    (found, tested)
}

fn against_plain() {
    let scene = Scene::new(72);
    let start = Post { row: 36, col: 36 };
    let (plain_s, plain) =
        timed(|| plain_map::plain_map(&scene.dem, (start.row, start.col), &scene.hopper, &scene.surface, MOON_M_S2));
    let (quick_s, quick) = timed(|| {
        let hops = PostHops::new(scene.ground(), 1).expect("a sound request");
        search(&hops, &[start.into()], Search::default(), &()).expect("a sound request")
    });
    assert_eq!(plain, quick.hops, "both ways find the same hops");
    println!("72 x 72 posts, one thread: plain {plain_s:.3} s, ours {quick_s:.4} s, ratio {:.0}", plain_s / quick_s);
}

fn pull_against_push() {
    let scene = Scene::new(512);
    let start = Post { row: 256, col: 256 };
    let hops = PostHops::new(scene.ground(), 1).expect("a sound request");
    let (pull_s, pulled) = timed(|| search(&hops, &[start.into()], Search::default(), &()).expect("a sound request"));
    let (push_s, (pushed, tested)) = timed(|| pushed(&hops, start));
    assert_eq!(pulled.hops, pushed, "both ways find the same hops");
    println!(
        "512 x 512 posts, one thread: pull {pull_s:.3} s, push {push_s:.3} s ({tested} pairs), push / pull {:.2}",
        push_s / pull_s
    );
}

fn sizes() {
    println!(
        "{:>6} {:>12} {:>12} {:>12} {:>12} {:>14}",
        "side", "prepare, s", "hops, s", "effort, s", "mobility, s", "hops, ns/post"
    );
    for side in [256usize, 512, 1024, 2048] {
        let scene = Scene::new(side);
        let start = Post { row: side / 2, col: side / 2 };
        let (prepare_s, hops) = timed(|| PostHops::new(scene.ground(), 1).expect("a sound request"));
        let asked = |effort| Search { journey: Journey::Outbound, effort, hops_max: None };
        let (hops_s, _) = timed(|| search(&hops, &[start.into()], asked(None), &()).expect("a sound request"));
        let least = Some((Effort::TakeoffSpeed, TakeoffChoice::LeastSpeed));
        let (effort_s, _) = timed(|| search(&hops, &[start.into()], asked(least), &()).expect("a sound request"));
        let (mobility_s, _) = timed(|| mobility(&hops, &()).expect("a sound request"));
        #[expect(clippy::cast_precision_loss, reason = "a few million posts")]
        let each_ns = 1e9 * hops_s / (side * side) as f64;
        println!("{side:>6} {prepare_s:>12.2} {hops_s:>12.2} {effort_s:>12.2} {mobility_s:>12.2} {each_ns:>14.0}");
    }
}

fn main() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    one.install(against_plain);
    one.install(pull_against_push);
    if std::env::args().any(|argument| argument == "sizes") {
        sizes();
    }
}
