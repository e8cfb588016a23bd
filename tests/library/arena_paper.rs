//! The paper on path planning for the Jumping Sumo: its tables, and its errata as numbers.

#![expect(clippy::unwrap_used, reason = "a test may panic")]
#![expect(clippy::print_stdout, reason = "the tables are printed")]

use std::path::Path;

use chta::{
    arena::{
        Arena, ArenaKeys, GridKeys, Move, RandomBoxes, Reading, RrtStarOptions, any_angle_path, check_path, grid_path,
        grow_rrt_star, lower_bound, random_arena,
    },
    scenario::read_arena,
};

/// A shipped scenario of the paper.
pub(crate) fn sumo(number: usize) -> Arena {
    let name = format!("data/arenas/sumo_{number}.toml");
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(&name)).unwrap();
    read_arena(&name, &text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The same with changed keys.
pub(crate) fn with(arena: &Arena, change: impl FnOnce(&mut ArenaKeys)) -> Arena {
    let mut keys = arena.keys().clone();
    change(&mut keys);
    Arena::new(keys).unwrap()
}

fn without_turning(arena: &Arena) -> Arena {
    with(arena, |keys| keys.jumper.turn_s_per_rad = Some(0.0))
}

fn grid_s(arena: &Arena, reading: Reading, may_jump: bool) -> f64 {
    let path = grid_path(arena, reading, may_jump).unwrap().unwrap();
    // Added up again from the path alone.
    let checked = check_path(arena, &path).unwrap();
    assert!((checked.time_s - path.time_s).abs() < 1e-9);
    checked.time_s
}

fn exact_s(arena: &Arena, may_jump: bool) -> f64 {
    let path = any_angle_path(arena, may_jump).unwrap().unwrap();
    check_path(arena, &path).unwrap().time_s
}

#[test]
fn table_one_in_both_readings() {
    let printed = ["11.91", "12.52", "13.20", "9.35"];
    let r1 = [11.909_167, 12.517_909, 13.203_663, 9.354_342];
    let r0 = [11.909_167, 12.514_172, 13.203_663, 9.354_342];
    for (i, text) in printed.into_iter().enumerate() {
        let arena = sumo(i + 1);
        let (one, plain) = (grid_s(&arena, Reading::R1, true), grid_s(&arena, Reading::R0, true));
        assert!((one - r1[i]).abs() < 1e-6 && (plain - r0[i]).abs() < 1e-6, "S{}: {one} {plain}", i + 1);
        assert_eq!(format!("{one:.2}"), text, "S{} as printed", i + 1);
    }
    // The plain reading prints three of the four.
    assert_eq!(format!("{:.2}", grid_s(&sumo(2), Reading::R0, true)), "12.51");
    // 40 nodes up or along, 40 on diagonals, three turns of 45 degrees.
    let by_hand = (80.0 * 0.2 + 40.0 * 0.2 * 2f64.sqrt()) / 1.9 + 3.0 * 0.026 * std::f64::consts::FRAC_PI_4;
    assert!((grid_s(&sumo(2), Reading::R1, false) - by_hand).abs() < 1e-9, "{by_hand}");
}

#[test]
fn the_exact_planner_beats_the_grid_on_two_scenarios() {
    let exact = [11.9092, 12.3092, 12.6482, 9.3543];
    for (i, expected) in exact.into_iter().enumerate() {
        let found = exact_s(&sumo(i + 1), true);
        assert!((found - expected).abs() < 1e-4, "S{}: {found}", i + 1);
    }
    assert!((exact_s(&sumo(2), false) - 13.3510).abs() < 1e-4);
    for (number, plain, inflated, turning) in [(3, 12.6120, 12.7504, 12.7896), (4, 9.2931, 9.5185, 9.5875)] {
        let wide = with(&sumo(number), |keys| keys.arena.inflation_m = 0.2);
        let found = [exact_s(&without_turning(&sumo(number)), true), exact_s(&without_turning(&wide), true), exact_s(&wide, true)];
        for (found, expected) in found.into_iter().zip([plain, inflated, turning]) {
            assert!((found - expected).abs() < 1e-4, "S{number}: {found} {expected}");
        }
    }
}

/// Table II and our own: the mean of seeds is within one per cent of the exact time under the same inflation.
#[test]
fn rrt_star_comes_within_a_per_cent() {
    let paper = [12.5156, 13.0911, 13.8535, 10.3045];
    for (i, paper_s) in paper.into_iter().enumerate() {
        let arena = without_turning(&sumo(i + 1));
        // Where no jump pays the ring is a wall all around.
        let inflated = if i < 2 { arena.clone() } else { with(&arena, |keys| keys.arena.inflation_m = 0.2) };
        let exact_s = exact_s(&inflated, true);
        let seeds = 6;
        let mut sum_s = 0.0;
        for seed in 0..seeds {
            let grown = grow_rrt_star(&arena, &RrtStarOptions { seed, ..RrtStarOptions::default() }, true).unwrap();
            let path = grown.path.unwrap();
            check_path(&arena, &path).unwrap();
            assert!(path.time_s >= lower_bound(&arena, Reading::R0, true).time_s - 1e-9);
            assert!(grown.history.windows(2).all(|pair| pair[0].1.is_none_or(|before| pair[1].1.unwrap() <= before)));
            #[expect(clippy::cast_precision_loss, reason = "a few seeds")]
            let count = seeds as f64;
            sum_s += path.time_s / count;
        }
        assert!(sum_s <= 1.01 * exact_s, "S{}: mean {sum_s}, exact {exact_s}", i + 1);
        assert!(sum_s < paper_s, "S{}: the paper's mean is {paper_s}, ours {sum_s}", i + 1);
    }
}

#[test]
fn errata_of_the_paper() {
    // (1) Turning on the spot at the wheels' speed takes b / (2 v); the paper's number is half of that, cut.
    let by_wheels = with(&sumo(4), |keys| {
        keys.jumper.turn_s_per_rad = None;
        keys.jumper.wheelbase_m = Some(0.2);
    });
    assert!((by_wheels.jumper().turn_s_per_rad - 0.2 / 3.8).abs() < 1e-12);
    let half = with(&sumo(4), |keys| keys.jumper.turn_s_per_rad = Some(0.2 / 7.6));
    assert_eq!(format!("{:.2}", grid_s(&half, Reading::R1, true)), "9.36", "uncut, the paper's number does not print 9.35");
    // (2) The mean of the dense column of Table III, and (4) of the runs of S4 without jumps.
    let mean = |values: &[f64]| values.iter().sum::<f64>() / f64::from(u8::try_from(values.len()).unwrap());
    assert!((mean(&[2.55, 0.0, 0.33, 1.33, 0.52, 0.0, 2.55, 0.0, 0.0, 0.13]) - 0.741).abs() < 1e-9, "0.72 is printed");
    let (driven, jumped) = ([10.1943, 10.0596, 10.3615, 10.3566, 10.0861, 10.4211], [10.4441, 10.2432, 10.3223, 10.5557]);
    assert!((mean(&driven) - 10.2465).abs() < 1e-4, "10.2653 is printed");
    assert!((mean(&jumped) - 10.3913).abs() < 1e-4);
    // (3) The quickest run of S4 is the third.
    assert!(driven.iter().all(|run| *run >= 10.0596));
    // (5) The "optimum" of A* is longer than the exact path.
    let above = |number| grid_s(&sumo(number), Reading::R1, true) / exact_s(&sumo(number), true) - 1.0;
    assert!((above(3) - 0.0439).abs() < 5e-4 && (above(2) - 0.0170).abs() < 5e-4, "{} {}", above(3), above(2));
    // (6) The ideal of S2 is that of the empty floor and a jump.
    assert!((exact_s(&sumo(2), true) - exact_s(&sumo(1), true) - 0.4).abs() < 1e-12);
    // (10) A jump on S3 loses time, and three jumps on S4 do: the best straight line over the boxes.
    let straight_s: f64 = 16.0 / 1.9 + 3.0 * 0.4;
    assert!((straight_s - 9.621).abs() < 1e-3 && exact_s(&without_turning(&sumo(4)), true) < straight_s - 0.3);
}

/// (9) A jump square to the face cannot follow the straight line: at least 0.4 m of it, from ring to ring, are at 45 degrees to it.
#[test]
fn jumps_square_to_the_face_cannot_reach_the_ideal_of_the_second_scenario() {
    let mut least_s = f64::INFINITY;
    for i in 0..=4_000 {
        let x_m = 6.0 + 1e-4 * f64::from(i);
        let (before, after) = (libm::hypot(x_m - 2.0, 5.8 - 2.0), libm::hypot(18.0 - x_m, 18.0 - 6.2));
        least_s = least_s.min((before + 0.4 + after) / 1.9 + 0.4);
    }
    assert!((least_s - 12.372).abs() < 5e-4, "{least_s}");
    assert!(least_s > exact_s(&without_turning(&sumo(2)), true) + 0.05);
}

/// The benefit of jumping on random maps: mean and its standard error, and the share that driving cannot cross.
fn benefit(count: usize, sizes_m: &[f64], maps: u64) -> (f64, f64, f64) {
    let boxes = RandomBoxes { count, sizes_m: sizes_m.to_vec(), ..RandomBoxes::default() };
    let (mut saved, mut blocked) = (Vec::new(), 0);
    for seed in 0..maps {
        let arena = Arena::new(random_arena(sumo(1).keys(), &boxes, seed)).unwrap();
        let [with, without] = [true, false].map(|may_jump| grid_path(&arena, Reading::R1, may_jump).unwrap());
        match (with, without) {
            (Some(with), Some(without)) => saved.push(without.time_s - with.time_s),
            (_, None) => blocked += 1,
            (None, Some(_)) => panic!("seed {seed}: jumps took the path away"),
        }
    }
    let count = f64::from(u32::try_from(saved.len()).unwrap());
    let mean = saved.iter().sum::<f64>() / count;
    let variance = saved.iter().map(|one| (one - mean) * (one - mean)).sum::<f64>() / (count - 1.0);
    #[expect(clippy::cast_precision_loss, reason = "a number of maps")]
    (mean, (variance / count).sqrt(), f64::from(blocked) / maps as f64)
}

/// Tables III and IV: what the paper and the reference state, each with its standard error.
const TABLES: [(&str, usize, &[f64], f64, f64); 6] = [
    ("III, 5 boxes", 5, &[1.0, 3.0, 6.0], 0.18, 0.11),
    ("III, 15 boxes", 15, &[1.0, 3.0, 6.0], 0.74, 0.33),
    ("III, 30 boxes", 30, &[1.0, 3.0, 6.0], 1.83, 0.42),
    ("IV, 1 m", 15, &[1.0], 0.0, 0.02),
    ("IV, 3 m", 15, &[3.0], 0.08, 0.07),
    ("IV, 6 m", 15, &[6.0], 1.97, 0.49),
];

fn compare_with_tables(maps: u64) {
    for (name, count, sizes_m, paper_s, paper_error_s) in TABLES {
        let (mean_s, error_s, blocked) = benefit(count, sizes_m, maps);
        println!(
            "{name}: {mean_s:.3} +- {error_s:.3} s, paper {paper_s} +- {paper_error_s}; driving blocked {:.1} %",
            100.0 * blocked
        );
        let apart = (mean_s - paper_s).abs() / (error_s * error_s + paper_error_s * paper_error_s).sqrt();
        assert!(apart < 3.0, "{name}: {mean_s} +- {error_s}, the paper has {paper_s} +- {paper_error_s}");
    }
}

#[test]
fn jumping_saves_as_much_on_random_maps_as_in_tables_three_and_four() {
    compare_with_tables(20);
}

#[test]
#[ignore = "400 maps for each column, half a minute"]
fn jumping_saves_as_much_on_400_random_maps() {
    compare_with_tables(400);
}

/// A finer grid comes no closer than its headings allow; jumps are as long and as high.
#[test]
fn a_finer_grid_keeps_the_detour_of_eight_headings() {
    let fine = with(&sumo(3), |keys| keys.grid = GridKeys { spacing_m: 0.1, jump_length_m: 0.4 });
    let (coarse_s, fine_s) = (grid_s(&sumo(3), Reading::R0, true), grid_s(&fine, Reading::R0, true));
    assert!(fine_s <= coarse_s + 1e-9 && fine_s > exact_s(&sumo(3), true) + 0.3, "{fine_s} {coarse_s}");
}

#[test]
fn the_jump_of_the_second_scenario_is_over_one_face() {
    let path = grid_path(&sumo(2), Reading::R1, true).unwrap().unwrap();
    let kinds: Vec<Move> = path.points.iter().filter_map(|point| point.reached_by).collect();
    assert_eq!(kinds.iter().filter(|kind| **kind == Move::Jump).count(), 1);
    assert_eq!(kinds.iter().filter(|kind| **kind == Move::Drop).count(), 1);
}
