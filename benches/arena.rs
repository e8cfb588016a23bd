//! The planners of arenas: the four plans of Table I of the paper on the Jumping Sumo, thirty boxes, and RRT* with 3000 nodes.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]

use std::path::Path;

use chta::{
    arena::{Arena, RandomBoxes, Reading, RrtStarOptions, any_angle_path, grid_path, grow_rrt_star, random_arena},
    scenario::read_arena,
};
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

fn sumo(number: usize) -> Arena {
    let name = format!("data/arenas/sumo_{number}.toml");
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(&name)).expect("a shipped arena");
    read_arena(&name, &text, &[]).expect("a valid arena")
}

/// All four scenarios, one after the other: the paper states 400 s.
#[divan::bench(args = ["R1", "R0"])]
fn table_one(bencher: Bencher<'_, '_>, reading: &str) {
    let arenas = [1, 2, 3, 4].map(sumo);
    let reading = if reading == "R1" { Reading::R1 } else { Reading::R0 };
    bencher.bench(|| arenas.iter().filter_map(|arena| grid_path(black_box(arena), reading, true).expect("plans")).count());
}

/// The exact planner over the same four, and over thirty random boxes, the mean of twenty maps.
#[divan::bench]
fn any_angle_four_scenarios(bencher: Bencher<'_, '_>) {
    let arenas = [1, 2, 3, 4].map(sumo);
    bencher.bench(|| arenas.iter().filter_map(|arena| any_angle_path(black_box(arena), true).expect("plans")).count());
}

#[divan::bench]
fn any_angle_thirty_boxes_twenty_maps(bencher: Bencher<'_, '_>) {
    let boxes = RandomBoxes { count: 30, ..RandomBoxes::default() };
    let arenas: Vec<Arena> =
        (0..20).map(|seed| Arena::new(random_arena(sumo(1).keys(), &boxes, seed)).expect("a valid arena")).collect();
    bencher.bench(|| arenas.iter().filter_map(|arena| any_angle_path(black_box(arena), true).expect("plans")).count());
}

#[divan::bench(args = [1, 2, 3, 4])]
fn rrt_star_3000_nodes(bencher: Bencher<'_, '_>, number: usize) {
    let mut arena = sumo(number).keys().clone();
    arena.jumper.turn_s_per_rad = Some(0.0);
    let arena = Arena::new(arena).expect("a valid arena");
    bencher.bench(|| grow_rrt_star(black_box(&arena), &RrtStarOptions::default(), true).expect("grows").nodes.len());
}
