//! Jumps as flights: by hand, against small steps (the checker), and against the rules.

use chta::arena::{
    Arena, FlightKeys, Move, RandomBoxes, Reading, Refusal, RrtStarOptions, any_angle_path, check_path, grid_path, grow_rrt_star,
    lower_bound, random_arena,
};

use crate::arena_paper::{sumo, with};

/// The flight with this apex and this range over level ground.
fn flight(apex_m: f64, range_m: f64) -> FlightKeys {
    let up = (2.0 * 9.81 * apex_m).sqrt();
    let along = range_m * 9.81 / (2.0 * up);
    FlightKeys { takeoff_speed_m_s: up.hypot(along), takeoff_angle_deg: up.atan2(along).to_degrees(), gravity_m_s2: 9.81 }
}

fn flying(arena: &Arena, apex_m: f64, range_m: f64) -> Arena {
    with(arena, |keys| keys.flight = Some(flight(apex_m, range_m)))
}

/// Erratum 11 of the paper: the Sumo as advertised does not land on the box of the second scenario.
#[test]
fn the_sumo_as_advertised_is_too_weak_for_the_second_scenario() {
    let keys = flight(0.8, 0.8);
    assert!((keys.takeoff_speed_m_s * keys.takeoff_angle_deg.to_radians().sin() - 3.962).abs() < 1e-3);
    let arena = flying(&sumo(2), 0.8, 0.8);
    let own = arena.jumper().flight.unwrap();
    assert!((own.apex_m() - 0.8).abs() < 1e-12 && (own.range_m() - 0.8).abs() < 1e-12 && (own.along_m_s() - 0.990).abs() < 1e-3);
    assert!((own.highest_box_m(0.2) - 0.75).abs() < 1e-4, "{}", own.highest_box_m(0.2));
    assert!((own.arc(0.0).unwrap().flight_time_s() - 2.0 * 0.404).abs() < 1e-3);
    assert!(own.arc(0.81).is_none());
    let path = grid_path(&arena, Reading::R1, true).unwrap().unwrap();
    assert_eq!(path.jumps(), 0);
    assert!((path.time_s - grid_path(&sumo(2), Reading::R1, false).unwrap().unwrap().time_s).abs() < 1e-12);
    // A twentieth of a metre more, and it jumps.
    let stronger = flying(&sumo(2), 0.8505, 0.825);
    let path = grid_path(&stronger, Reading::R1, true).unwrap().unwrap();
    assert_eq!(path.jumps(), 1);
    check_path(&stronger, &path).unwrap();
    assert!(matches!(any_angle_path(&stronger, true), Err(Refusal::Flies)));
    let tired = with(&stronger, |keys| keys.jumper.speed_factor_per_jump = 0.9);
    assert!(matches!(grid_path(&tired, Reading::R0, true), Err(Refusal::FliesAndWeakens { .. })));
}

/// Every flight over random boxes is flown again in small steps, keeps its distance from the edge, and no path beats the bound.
#[test]
fn flights_over_random_boxes_are_what_they_say() {
    let mut flown = 0;
    for seed in 0..40_u64 {
        let boxes = RandomBoxes { count: 18, ..RandomBoxes::default() };
        #[expect(clippy::cast_precision_loss, reason = "small")]
        let (apex_m, range_m) = (0.4 + 0.05 * (seed % 20) as f64, 0.5 + 0.1 * (seed % 7) as f64);
        let arena = flying(&Arena::new(random_arena(sumo(1).keys(), &boxes, seed)).unwrap(), apex_m, range_m);
        let arena = with(&arena, |keys| keys.jumper.jump_time_s = [0.0, 0.4][usize::try_from(seed % 2).unwrap()]);
        let bound_s = lower_bound(&arena, Reading::R0, true).time_s;
        let tree = grow_rrt_star(&arena, &RrtStarOptions { nodes: 500, seed, ..RrtStarOptions::default() }, true);
        let grid = grid_path(&arena, Reading::R0, true).unwrap();
        for path in [tree.ok().and_then(|tree| tree.path), grid].into_iter().flatten() {
            let checked = check_path(&arena, &path).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
            assert!(checked.time_s >= bound_s - 1e-9, "seed {seed}: {} {bound_s}", checked.time_s);
            for pair in path.points.windows(2).filter(|pair| pair[1].reached_by == Some(Move::Jump)) {
                let rise_m = pair[1].z_m - pair[0].z_m;
                let run_m = (pair[1].point - pair[0].point).norm();
                assert!((arena.jumper().flight.unwrap().arc(rise_m).unwrap().line_of_sight().run_m() - run_m).abs() < 1e-9);
                assert!(rise_m <= arena.jumper().flight.unwrap().highest_box_m(0.2) + 1e-9, "seed {seed}: {rise_m}");
                flown += 1;
            }
        }
    }
    assert!(flown > 10, "only {flown} flights");
}
