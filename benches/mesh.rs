//! Pairs of contacts per second over the meshes of Campana and Laumond 2016, on one thread.
//!
//! `cargo bench --bench mesh`. The meshes are read from a folder beside the repository (`tests/library` names it); without it nothing
//! is measured. Items are ordered pairs, so the throughput is pairs a second on one thread. Compare lines of one run with each other, and
//! commits by `BENCHES=mesh benches/against_commit.sh REV`.
//!
//! - `all_pairs`: every 20th of 2 000 contacts, drawn by area, against all: most pairs are refused by limits that need no cut.
//! - `windows`: the pairs with at least one window alone, which are cut to the end.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "it says what was measured, or why nothing was")]

use std::path::Path;

use chta::{
    ground::{MeshBuffers, MeshContact, MeshGround},
    terrain::{MeshTree, read_mesh},
    world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};
use divan::{Bencher, black_box, counter::ItemsCount};
use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

/// Scene, friction, greatest speed, and the box that holds the contacts: as the authors of the scenes run them.
#[derive(Clone, Copy, Debug)]
struct Case {
    mesh: &'static str,
    friction: f64,
    speed_m_s: f64,
    low: [f64; 3],
    high: [f64; 3],
}

const JUMP: Case = Case { mesh: "scene_jump10.stl", friction: 0.5, speed_m_s: 6.5, low: [-6.0, -2.5, 0.0], high: [6.8, 3.2, 8.0] };
const CAVE: Case =
    Case { mesh: "cave_mono_short_1.stl", friction: 1.2, speed_m_s: 4.5, low: [-2.6, -3.0, -2.5], high: [2.6, 4.2, 4.0] };
const WINDOWS: Case = Case { mesh: "envir3d_1.stl", friction: 1.2, speed_m_s: 6.8, low: [-5.0, -5.0, -1.0], high: [5.0, 5.0, 7.0] };
const CASES: [Case; 5] =
    [JUMP, Case { friction: 1.2, speed_m_s: 7.0, ..JUMP }, CAVE, WINDOWS, Case { friction: 0.5, speed_m_s: 5.3, ..WINDOWS }];
const NAMES: [&str; 5] = ["jump 0.5/6.5", "jump 1.2/7", "cave 1.2/4.5", "windows 1.2/6.8", "windows 0.5/5.3"];

const CONTACTS: usize = 2_000;

/// Every so many-th contact takes off.
const STRIDE: usize = 20;

fn main() {
    if folder().is_dir() {
        divan::main();
    } else {
        println!("skipped: no meshes at {}", folder().display());
    }
}

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/mesh"))
}

/// The ground of a case, and contacts drawn by area inside its box.
fn scene(name: &str) -> (MeshGround, Vec<MeshContact>) {
    let case = CASES[NAMES.iter().position(|known| *known == name).expect("a case")];
    let mesh = read_mesh(&folder().join(case.mesh), 1.0).expect("a mesh").mesh;
    let hopper = Hopper::with_speeds(case.speed_m_s, case.speed_m_s).expect("a hopper");
    let grip = Some(Grip::Friction(FrictionCone::new(case.friction).expect("a friction")));
    let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
    let ground = MeshGround::new(MeshTree::new(mesh), &hopper, Gravity::new(9.81).expect("a gravity"), &surface).expect("a ground");
    let mut areas = Vec::new();
    let mut sum = 0.0;
    for [a, b, c] in ground.tree().mesh().triangles() {
        sum += 0.5 * (b - a).cross(&(c - a)).norm();
        areas.push(sum);
    }
    let triangles: Vec<_> = ground.tree().mesh().triangles().collect();
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut contacts = Vec::with_capacity(CONTACTS);
    while contacts.len() < CONTACTS {
        let (at, mut u, mut v): (f64, f64, f64) = (sum * random.random::<f64>(), random.random(), random.random());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let [a, b, c] = triangles[areas.partition_point(|area| *area < at).min(triangles.len() - 1)];
        let point: Point3<f64> = a + (b - a) * u + (c - a) * v;
        let inside = |low: Vector3<f64>, high: Vector3<f64>| point.coords.sup(&low) == point.coords.inf(&high);
        if inside(case.low.into(), case.high.into())
            && let Ok(contact) = ground.contact(point)
        {
            contacts.push(contact);
        }
    }
    (ground, contacts)
}

fn has_windows(ground: &MeshGround, pair: [&MeshContact; 2], buffers: &mut MeshBuffers) -> bool {
    ground.windows(pair[0], pair[1], buffers).is_some_and(|(_, windows)| !windows.is_empty())
}

/// Every 20th contact against all.
#[divan::bench(args = NAMES, sample_count = 20, sample_size = 1)]
fn all_pairs(bencher: Bencher<'_, '_>, name: &str) {
    let (ground, contacts) = scene(name);
    let mut buffers = MeshBuffers::default();
    let takeoffs = contacts.len().div_ceil(STRIDE);
    bencher.counter(ItemsCount::new(takeoffs * contacts.len())).bench_local(|| {
        let pairs = contacts.iter().step_by(STRIDE).flat_map(|takeoff| contacts.iter().map(move |landing| [takeoff, landing]));
        pairs.filter(|pair| has_windows(&ground, black_box(*pair), &mut buffers)).count()
    });
}

/// Pairs with windows alone.
#[divan::bench(args = NAMES, sample_count = 20, sample_size = 1)]
fn windows(bencher: Bencher<'_, '_>, name: &str) {
    let (ground, contacts) = scene(name);
    let mut buffers = MeshBuffers::default();
    let pairs = contacts.iter().step_by(STRIDE).flat_map(|takeoff| contacts.iter().map(move |landing| [takeoff, landing]));
    let pairs: Vec<_> = pairs.filter(|pair| has_windows(&ground, *pair, &mut buffers)).collect();
    let whole = contacts.len().div_ceil(STRIDE) * contacts.len();
    println!("{name}: {} of {whole} pairs have windows", pairs.len());
    bencher
        .counter(ItemsCount::new(pairs.len()))
        .bench_local(|| pairs.iter().filter(|pair| has_windows(&ground, black_box(**pair), &mut buffers)).count());
}
