//! The planners of arenas against each other and against plain searches, on random arenas.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use chta::{
    arena::{
        Arena, ArenaKeys, ArenaPath, Move, PathFault, RandomBoxes, Reading, Refusal, RrtStarOptions, any_angle_path, check_path,
        grid_path, grow_rrt_star, lower_bound, random_arena,
    },
    scenario::{arena_toml, read_arena},
    study::{ArenaPlanner, plan_in_arena},
};

use crate::{
    arena_paper::{sumo, with},
    support::Draw,
};

/// A random arena: few or many boxes, other limits, turning and start.
fn random(seed: u64) -> Arena {
    let mut draw = Draw::seeded(seed);
    let boxes = RandomBoxes {
        count: draw.below(31),
        sizes_m: [vec![1.0, 3.0, 6.0], vec![0.8, 1.4], vec![5.0, 7.0]][draw.below(3)].clone(),
        height_step_m: [0.2, 0.3][draw.below(2)],
        height_steps_max: 8,
    };
    let mut keys: ArenaKeys = sumo(1).keys().clone();
    keys.arena.start_heading_deg = draw.chance(0.5).then(|| draw.uniform(-180.0, 180.0));
    keys.jumper.turn_s_per_rad = Some([0.0, 0.026, 0.3][draw.below(3)]);
    keys.jumper.rise_max_m = draw.uniform(0.0, 1.2);
    keys.jumper.jump_time_s = [0.0, 0.1, 0.4, 2.0][draw.below(4)];
    Arena::new(random_arena(&keys, &boxes, seed)).unwrap()
}

/// The exact planner is never later than the grid with the same price of a jump, nor the bound later than the grid of any reading.
fn compare_exact(seeds: std::ops::Range<u64>) {
    let mut compared = 0;
    for seed in seeds {
        let arena = random(seed);
        let exact = any_angle_path(&arena, true).unwrap();
        if let Some(exact) = &exact {
            check_path(&arena, exact).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
        }
        let fine = with(&arena, |keys| keys.grid.spacing_m = 0.1);
        for (arena, reading) in [(&arena, Reading::R0), (&arena, Reading::R1), (&fine, Reading::R0)] {
            if std::ptr::eq(arena, &raw const fine) && seed % 8 > 0 {
                continue;
            }
            let Some(grid) = grid_path(arena, reading, true).unwrap() else { continue };
            check_path(arena, &grid).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
            let bound_s = lower_bound(arena, reading, true).time_s;
            assert!(bound_s <= grid.time_s + 1e-9, "seed {seed} {reading:?}: bound {bound_s}, grid {}", grid.time_s);
            if reading == Reading::R0 {
                let exact_s = exact.as_ref().unwrap().time_s;
                assert!(
                    (exact_s - bound_s).abs() < 1e-12 && exact_s <= grid.time_s + 1e-9,
                    "seed {seed}: {exact_s} {}",
                    grid.time_s
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 0, "no arena has a path");
}

#[test]
fn the_exact_planner_is_never_later_than_a_grid() {
    compare_exact(0..150);
}

#[test]
#[ignore = "a thousand arenas, a minute"]
fn the_exact_planner_is_never_later_than_a_grid_on_a_thousand_arenas() {
    compare_exact(150..1_150);
}

#[test]
fn the_exact_planner_is_never_later_than_rrt_star() {
    for seed in 0..25 {
        let arena = random(seed);
        let grown = match grow_rrt_star(&arena, &RrtStarOptions { nodes: 600, seed, ..RrtStarOptions::default() }, true) {
            Ok(grown) => grown,
            Err(refusal) => {
                assert!(matches!(refusal, Refusal::WithinRing { .. }), "{refusal}");
                continue;
            }
        };
        let Some(path) = grown.path else { continue };
        check_path(&arena, &path).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
        assert!(any_angle_path(&arena, true).unwrap().unwrap().time_s <= path.time_s + 1e-9, "seed {seed}");
    }
}

/// A* with its bound against Dijkstra: the bound is 0 where a move costs nothing, so a free jump makes A* search without one.
#[test]
fn a_star_finds_what_a_search_over_all_pairs_of_moves_finds() {
    for seed in 0..40 {
        let arena = with(&random(seed), |keys| {
            keys.grid.spacing_m = 0.4;
            keys.grid.jump_length_m = 0.8;
            keys.boxes.retain(|one| one.size_m[0] >= 0.8);
        });
        for reading in [Reading::R0, Reading::R1] {
            let found = grid_path(&arena, reading, true).unwrap().map(|path| path.time_s);
            let plain = plain_search(&arena, reading);
            assert_eq!(found.is_some(), plain.is_finite(), "seed {seed}");
            assert!(found.is_none_or(|found| (found - plain).abs() < 1e-9), "seed {seed} {reading:?}: {found:?} {plain}");
        }
    }
}

/// The same rules written down a second time, from the boxes, relaxed until nothing changes.
#[expect(clippy::too_many_lines, reason = "the rules in one place, in their order")]
fn plain_search(arena: &Arena, reading: Reading) -> f64 {
    let step = arena.keys().grid.spacing_m;
    let n = 51_i32;
    let quadrant_m = |x: f64, y: f64| {
        let inside = |one: &&chta::arena::ArenaBox| one.min.x < x && x < one.max.x && one.min.y < y && y < one.max.y;
        if !(0.0..=20.0).contains(&x) || !(0.0..=20.0).contains(&y) {
            return f64::INFINITY;
        }
        arena.boxes().iter().filter(inside).map(|one| one.height_m).fold(0.0, f64::max)
    };
    let tiny = 1e-4;
    let around = [(tiny, tiny), (-tiny, tiny), (tiny, -tiny), (-tiny, -tiny)];
    let height = |x: f64, y: f64| around.iter().map(|(dx, dy)| quadrant_m(x + dx, y + dy)).fold(f64::INFINITY, f64::min);
    let place = |i: i32| f64::from(i) * step;
    let z: Vec<f64> = (0..n * n).map(|node| height(place(node % n), place(node / n))).collect();
    let at = |i: i32, j: i32| ((0..n).contains(&i) && (0..n).contains(&j)).then(|| z[usize::try_from(j * n + i).unwrap()]);
    let steps: [(i32, i32); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];
    let ring = |i: i32, j: i32| {
        let own = at(i, j).unwrap();
        own > 0.0 && steps.iter().any(|(di, dj)| at(i + di, j + dj).is_some_and(|other| other < own))
    };
    let level =
        |i: i32, j: i32| steps.iter().step_by(2).all(|(di, dj)| at(i + di, j + dj).is_none_or(|other| Some(other) == at(i, j)));
    // The heights along a line, sampled away from its corners.
    let along = |from: (i32, i32), to: (i32, i32)| -> Vec<f64> {
        let mut heights: Vec<f64> = (0..400)
            .map(|k| {
                let t = (f64::from(k) + 0.5) / 400.0;
                height(place(from.0) + t * (place(to.0) - place(from.0)), place(from.1) + t * (place(to.1) - place(from.1)))
            })
            .collect();
        heights.dedup();
        heights
    };
    let jumper = arena.jumper();
    let (jump, drop) = (2, if reading == Reading::R1 { 2 } else { 1 });
    let mut edges = Vec::new();
    for node in 0..n * n {
        let (i, j) = (node % n, node / n);
        let own = at(i, j).unwrap();
        for (heading, (di, dj)) in steps.iter().enumerate() {
            let unit = step * libm::hypot(f64::from(*di), f64::from(*dj));
            let mut edge = |count: i32, time_s: f64| edges.push((node, (j + count * dj) * n + i + count * di, heading, time_s));
            if ring(i, j) {
                let over = at(i + di, j + dj).is_some_and(|next| next < own);
                let end = at(i + drop * di, j + drop * dj);
                if let Some(end_m) = end.filter(|_| heading % 2 == 0 && over && !ring(i + drop * di, j + drop * dj)) {
                    let mut heights = vec![own];
                    heights.extend(along((i, j), (i + drop * di, j + drop * dj)));
                    if heights.windows(2).all(|pair| pair[1] <= pair[0]) {
                        let length = f64::from(drop) * unit;
                        let fall = if reading == Reading::R1 { own - end_m } else { 0.0 };
                        edge(drop, libm::hypot(length, fall) / jumper.speed_m_s);
                    }
                }
                continue;
            }
            // Between two boxes that touch there is no way.
            let is_open = |t: f64| height(place(i) + t * step * f64::from(*di), place(j) + t * step * f64::from(*dj)) == own;
            let next_is_level = at(i + di, j + dj) == Some(own) && is_open(0.25) && is_open(0.75);
            if next_is_level && (heading % 2 == 0 || level(i, j) && level(i + di, j + dj)) {
                edge(1, unit / jumper.speed_m_s);
            }
            if let Some(top) = at(i + jump * di, j + jump * dj) {
                let rises = top > own && top - own <= jumper.rise_max_m + 1e-9 && jumper.rise_max_m > 0.0;
                if rises && !ring(i + jump * di, j + jump * dj) {
                    let mut heights = vec![own];
                    heights.extend(along((i, j), (i + jump * di, j + jump * dj)));
                    heights.push(top);
                    heights.dedup();
                    if heights == [own, top] {
                        let length_s = if reading == Reading::R1 { 0.0 } else { f64::from(jump) * unit / jumper.speed_m_s };
                        edge(jump, length_s + jumper.jump_time_s);
                    }
                }
            }
        }
    }
    let index = |node: i32, heading: usize| usize::try_from(node).unwrap() * 8 + heading;
    let turn = |a: f64, b: f64| {
        let apart = (a - b).abs() % std::f64::consts::TAU;
        apart.min(std::f64::consts::TAU - apart) * jumper.turn_s_per_rad
    };
    let angle = |heading: usize| f64::from(u8::try_from(heading).unwrap()) * std::f64::consts::FRAC_PI_4;
    let [hx, hy] = arena.heading();
    let node_of = |x: f64, y: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "a node")]
        let (i, j) = ((x / step).round() as i32, (y / step).round() as i32);
        j * n + i
    };
    let start = node_of(arena.start().x, arena.start().y);
    let mut best = vec![f64::INFINITY; usize::try_from(n * n).unwrap() * 8];
    for (from, to, heading, time_s) in &edges {
        if *from == start {
            best[index(*to, *heading)] = time_s + turn(libm::atan2(hy, hx), angle(*heading));
        }
    }
    loop {
        let mut changed = false;
        for (from, to, heading, time_s) in &edges {
            for before in 0..8 {
                let time_s = best[index(*from, before)] + turn(angle(before), angle(*heading)) + time_s;
                if time_s < best[index(*to, *heading)] - 1e-13 {
                    best[index(*to, *heading)] = time_s;
                    changed = true;
                }
            }
        }
        if !changed {
            break;
        }
    }
    let goal = node_of(arena.goal().x, arena.goal().y);
    (0..8).map(|heading| best[index(goal, heading)]).fold(f64::INFINITY, f64::min)
}

fn time_s(path: Option<ArenaPath>) -> f64 {
    path.map_or(f64::INFINITY, |path| path.time_s)
}

#[test]
fn looser_limits_are_never_worse() {
    for seed in 0..40 {
        let arena = random(seed);
        let rise_m = arena.jumper().rise_max_m;
        let looser = with(&arena, |keys| keys.jumper.rise_max_m = rise_m + 0.3);
        let quicker = with(&arena, |keys| keys.jumper.jump_time_s *= 0.5);
        for (planner, name) in [
            (&(|arena: &Arena| time_s(any_angle_path(arena, true).unwrap())) as &dyn Fn(&Arena) -> f64, "exact"),
            (&|arena: &Arena| time_s(grid_path(arena, Reading::R1, true).unwrap()), "grid"),
        ] {
            let own_s = planner(&arena);
            assert!(planner(&looser) <= own_s + 1e-9 && planner(&quicker) <= own_s + 1e-9, "seed {seed}, {name}");
        }
        let without_s = time_s(any_angle_path(&arena, false).unwrap());
        assert!(time_s(any_angle_path(&arena, true).unwrap()) <= without_s + 1e-9, "seed {seed}");
    }
}

/// Forwards and backwards the floor is the same without jumps and turning.
#[test]
fn without_jumps_the_way_back_is_as_long() {
    for seed in 0..30 {
        let arena = with(&random(seed), |keys| keys.jumper.turn_s_per_rad = Some(0.0));
        let back = with(&arena, |keys| std::mem::swap(&mut keys.arena.start_m, &mut keys.arena.goal_m));
        let (there_s, back_s) = (time_s(any_angle_path(&arena, false).unwrap()), time_s(any_angle_path(&back, false).unwrap()));
        assert!(there_s == back_s || (there_s - back_s).abs() < 1e-9, "seed {seed}: {there_s} {back_s}");
    }
}

/// A battery: the path within it is no quicker, and takes no more energy than there is; of every path that a smaller battery allows a larger one
/// knows one that is as quick.
#[test]
fn a_battery_bounds_the_energy() {
    for seed in 0..8 {
        let base = with(&random(seed), |keys| {
            keys.jumper.drive_j_per_m = 1.0;
            keys.jumper.jump_j = 2.5;
            keys.jumper.power_w = 0.1;
        });
        for exact in [true, false] {
            let plan =
                |arena: &Arena| if exact { any_angle_path(arena, true) } else { grid_path(arena, Reading::R1, true) }.unwrap();
            let Some(free) = plan(&base) else { continue };
            let free_j = check_path(&base, &free).unwrap().energy_j;
            let mut last_s = f64::INFINITY;
            for share in [0.85, 0.95, 0.99, 1.0] {
                let bounded = with(&base, |keys| keys.jumper.battery_j = Some(free_j * share * (1.0 + 1e-12)));
                let Some(path) = plan(&bounded) else { continue };
                let checked = check_path(&bounded, &path).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
                assert!(checked.energy_j <= free_j * share * (1.0 + 1e-9));
                assert!(path.time_s >= free.time_s - 1e-9 && path.time_s <= last_s + 1e-9, "seed {seed}");
                last_s = path.time_s;
            }
            assert!((last_s - free.time_s).abs() < 1e-9, "seed {seed}: with all its energy {last_s}, free {}", free.time_s);
        }
    }
}

/// A jumper that slows after each jump takes longer, and jumps less.
#[test]
fn jumps_that_weaken_the_robot_are_paid_for() {
    let tired = |factor| with(&sumo(2), |keys| keys.jumper.speed_factor_per_jump = factor);
    let plan = |factor| grid_path(&tired(factor), Reading::R1, true).unwrap().unwrap();
    let (fresh, slower, much_slower) = (plan(1.0), plan(0.95), plan(0.5));
    assert!(fresh.time_s < slower.time_s && slower.jumps() == 1);
    assert_eq!(much_slower.jumps(), 0, "half the speed after a jump is worse than the way round");
    assert!((much_slower.time_s - grid_path(&sumo(2), Reading::R1, false).unwrap().unwrap().time_s).abs() < 1e-9);
    check_path(&tired(0.95), &slower).unwrap();
    let grown = grow_rrt_star(&tired(0.95), &RrtStarOptions::default(), true).unwrap().path.unwrap();
    check_path(&tired(0.95), &grown).unwrap();
    assert!(
        lower_bound(&tired(0.95), Reading::R0, true).time_s <= grown.time_s
            && !lower_bound(&tired(0.95), Reading::R0, true).is_exact
    );
    let refusal = any_angle_path(&tired(0.95), true).unwrap_err();
    assert!(refusal.to_string().contains("jumper.speed_factor_per_jump is 0.95"), "{refusal}");
}

/// What the checker must not let pass.
#[test]
fn a_spoiled_path_is_found() {
    let arena = sumo(2);
    let path = grid_path(&arena, Reading::R1, true).unwrap().unwrap();
    let spoiled = |change: &dyn Fn(&mut ArenaPath)| {
        let mut path = path.clone();
        change(&mut path);
        check_path(&arena, &path).unwrap_err()
    };
    assert!(matches!(spoiled(&|path| path.time_s -= 1e-6), PathFault::Time { .. }));
    assert!(matches!(spoiled(&|path| path.points.truncate(2)), PathFault::WrongEnds));
    let jump = path.points.iter().position(|point| point.reached_by == Some(Move::Jump)).unwrap();
    assert!(matches!(spoiled(&|path| path.points[jump].reached_by = Some(Move::Drive)), PathFault::Move { .. }));
    assert!(matches!(spoiled(&|path| path.points[jump].z_m = 0.9), PathFault::Move { .. }));
    assert!(matches!(spoiled(&|path| path.points[jump].point.x = 21.0), PathFault::Move { .. }));
    assert!(matches!(
        spoiled(&|path| path.points.retain(|point| point.reached_by != Some(Move::Jump))),
        PathFault::Move { .. } | PathFault::WrongEnds
    ));
    let low = with(&arena, |keys| keys.jumper.rise_max_m = 0.5);
    assert!(check_path(&low, &path).unwrap_err().to_string().contains("rises by more"));
}

#[test]
fn what_is_written_reads_back_and_the_same_seed_gives_the_same_arena() {
    for seed in 0..20 {
        let arena = random(seed);
        let text = arena_toml(arena.keys()).unwrap();
        assert_eq!(read_arena("again", &text, &[]).unwrap(), arena);
        assert_eq!(random(seed), arena);
        let planner = ArenaPlanner::RrtStar(RrtStarOptions { nodes: 200, seed, ..RrtStarOptions::default() });
        assert_eq!(plan_in_arena(&arena, planner, true), plan_in_arena(&arena, planner, true), "seed {seed}");
    }
}

/// A closed yard: proved, with the limit that closes it.
#[test]
fn a_no_is_proved_by_the_exact_planner_and_names_what_stops_it() {
    let yard = with(&sumo(1), |keys| {
        for (centre_m, size_m) in [([18.0, 15.0], [6.0, 1.0]), ([15.0, 18.0], [1.0, 6.0])] {
            keys.boxes.push(chta::arena::BoxKeys { centre_m, size_m, height_m: 1.0 });
        }
        keys.arena.goal_m = [18.0, 18.0];
    });
    let planned = plan_in_arena(&yard, ArenaPlanner::AnyAngle, true).unwrap().answer;
    assert!(!planned.found && planned.proved_unreachable && planned.stopped_by == ["jumper.rise_max_m"], "{planned:?}");
    assert_eq!(planned.lower_bound_s, None);
    let higher = with(&yard, |keys| keys.jumper.rise_max_m = 1.0);
    assert!(plan_in_arena(&higher, ArenaPlanner::AnyAngle, true).unwrap().answer.found);
    // A gap of half a node: the exact planner passes it, the grid does not, and does not claim a proof.
    let gap = with(&sumo(1), |keys| {
        for (centre_m, size_m) in [([10.0, 5.025], [2.0, 10.05]), ([10.0, 15.075], [2.0, 9.85])] {
            keys.boxes.push(chta::arena::BoxKeys { centre_m, size_m, height_m: 1.0 });
        }
    });
    let over_grid = plan_in_arena(&gap, ArenaPlanner::Grid(Reading::R0), true).unwrap().answer;
    assert!(!over_grid.found && !over_grid.proved_unreachable && over_grid.lower_bound_s.is_some(), "{over_grid:?}");
    // Two boxes that touch leave no gap.
    let closed = with(&gap, |keys| (keys.boxes[1].centre_m[1], keys.boxes[1].size_m[1]) = (15.025, 9.95));
    assert!(plan_in_arena(&closed, ArenaPlanner::AnyAngle, true).unwrap().answer.proved_unreachable);
}
