//! What must hold of drive maps: closed forms on flat ground, symmetry, and limits that help or hinder.

use super::{any_limits, flat, ugly_ground};
use crate::{
    draw::Draw,
    drive::{DriveAmount, DriveEdges, DriveGround, DriveMap, DriveSense},
    ground::{DemGround, NodeLattice},
    quantity::Angle,
    world::{Neighbours, Rover, RoverLimits},
};

fn costs(ground: &DemGround, rover: &Rover, amount: DriveAmount, sense: DriveSense, end: usize) -> Vec<f64> {
    let drive = DriveGround::new(ground, rover);
    let edges = DriveEdges::new(&drive, NodeLattice::new(ground.terrain().dem(), 1), amount, &()).unwrap();
    DriveMap::new(&edges, &[end], sense, &()).unwrap().costs().to_vec()
}

fn rover(limits: RoverLimits) -> Rover {
    Rover::new(limits, Some(3.0)).unwrap()
}

/// On flat ground 8 neighbours give the octile distance, and no neighbourhood lengthens the straight line by more than its bound, which some
/// node comes close to.
#[test]
fn flat_ground_has_closed_forms() {
    const SIDE: usize = 61;
    let ground = flat(SIDE, (0.5, 0.5));
    for neighbours in Neighbours::ALL {
        let rover = rover(RoverLimits { neighbours, ..RoverLimits::new(0.2, Angle::from_degrees(1.0)) });
        let found = costs(&ground, &rover, DriveAmount::Time, DriveSense::From, 0);
        let mut greatest: f64 = 0.0;
        for (node, time_s) in found.iter().enumerate().skip(1) {
            #[expect(clippy::cast_precision_loss, reason = "a few nodes")]
            let (row, col) = ((node / SIDE) as f64, (node % SIDE) as f64);
            let straight_s = row.hypot(col) * 0.5 / 0.2;
            greatest = greatest.max(time_s / straight_s - 1.0);
            if neighbours == Neighbours::Eight {
                let octile = row.max(col) + (2.0f64.sqrt() - 1.0) * row.min(col);
                assert!((time_s - octile * 0.5 / 0.2).abs() < 1e-9 * time_s);
            }
        }
        let bound = neighbours.elongation();
        assert!(greatest <= bound + 1e-12 && greatest > 0.98 * bound, "{neighbours:?} {greatest} {bound}");
    }
}

/// Where up and down have the same limit, and speed does not depend on the slope, there and back are alike.
#[test]
fn symmetric_limits_make_there_and_back_alike() {
    let draw = &mut Draw::seeded(2217);
    let mut reached = 0;
    for _ in 0..20 {
        let ground = ugly_ground(draw, 8, 8);
        let limits = RoverLimits {
            cross_slope_max: Some(Angle::from_degrees(draw.uniform(20.0, 60.0))),
            turn_s_per_deg: if draw.chance(0.5) { 0.1 } else { 0.0 },
            ..RoverLimits::new(0.1, Angle::from_degrees(draw.uniform(10.0, 60.0)))
        };
        let rover = rover(limits);
        let each: Vec<_> = (0..64).map(|end| costs(&ground, &rover, DriveAmount::Time, DriveSense::From, end)).collect();
        for (a, from_a) in each.iter().enumerate() {
            let into = costs(&ground, &rover, DriveAmount::Time, DriveSense::To, a);
            for b in 0..64 {
                let (there, back) = (from_a[b], each[b][a]);
                assert!(there == back || (there - back).abs() < 1e-9 * there, "{there} {back}");
                assert!(into[b] == back || (into[b] - back).abs() < 1e-9 * back);
                reached += u32::from(there.is_finite());
            }
        }
    }
    assert!(reached > 20_000, "{reached}");
}

/// Climbs and descents with different limits: the map to a node is the transpose of the maps from all.
#[test]
fn a_map_to_a_node_is_the_transpose_of_maps_from_all() {
    let draw = &mut Draw::seeded(2218);
    let mut one_way = 0;
    for _ in 0..15 {
        let ground = ugly_ground(draw, 7, 7);
        let limits = RoverLimits { step_max_m: None, roughness_max_m: None, ..any_limits(draw, Neighbours::Sixteen, 1.0) };
        let rover = rover(RoverLimits { slope_down_max: Some(Angle::from_degrees(70.0)), ..limits });
        for amount in DriveAmount::ALL {
            let each: Vec<_> = (0..49).map(|end| costs(&ground, &rover, amount, DriveSense::From, end)).collect();
            for (b, from_b) in each.iter().enumerate() {
                let into = costs(&ground, &rover, amount, DriveSense::To, b);
                for a in 0..49 {
                    let (there, back) = (each[a][b], from_b[a]);
                    assert!(into[a] == there || (into[a] - there).abs() < 1e-9 * there + 1e-12, "{amount:?} {} {there}", into[a]);
                    one_way += u32::from(there.is_finite() != back.is_finite());
                }
            }
        }
    }
    assert!(one_way > 500, "{one_way}");
}

/// Whatever is allowed more, no cost grows: objective time or length, turns without a price.
#[test]
fn looser_limits_and_more_neighbours_are_never_worse() {
    let draw = &mut Draw::seeded(2219);
    let mut better = 0;
    for _ in 0..40 {
        let ground = ugly_ground(draw, 12, 12);
        let strict = RoverLimits { turn_s_per_deg: 0.0, ..any_limits(draw, Neighbours::Eight, 1.0) };
        let more = |angle: Angle| Angle::from_degrees((1.3 * angle.degrees()).min(90.0));
        let mut looser = vec![
            RoverLimits { neighbours: Neighbours::Sixteen, ..strict.clone() },
            RoverLimits { neighbours: Neighbours::ThirtyTwo, ..strict.clone() },
            RoverLimits { step_max_m: None, ..strict.clone() },
            RoverLimits { roughness_max_m: strict.roughness_max_m.map(|max_m| 2.0 * max_m), ..strict.clone() },
        ];
        if let (Some(down), Some(across)) = (strict.slope_down_max, strict.cross_slope_max) {
            looser.push(RoverLimits { slope_up_max: more(strict.slope_up_max), ..strict.clone() });
            looser.push(RoverLimits { slope_down_max: Some(more(down)), ..strict.clone() });
            looser.push(RoverLimits { cross_slope_max: Some(more(across)), ..strict.clone() });
        }
        let start = draw.below(144);
        for amount in [DriveAmount::Time, DriveAmount::Length] {
            let before = costs(&ground, &rover(strict.clone()), amount, DriveSense::From, start);
            for limits in &looser {
                let after = costs(&ground, &rover(limits.clone()), amount, DriveSense::From, start);
                for (before, after) in before.iter().zip(after) {
                    assert!(after <= before * (1.0 + 1e-12), "{before} {after} {strict:?} {limits:?}");
                    better += u32::from(after < *before);
                }
            }
        }
    }
    assert!(better > 5000, "{better}");
}

/// The sources of the fast form name no trigonometric function and allocate nothing for a leg.
#[test]
fn prices_and_slopes_use_no_trigonometry() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/drive");
    for file in ["price.rs", "slopes.rs", "search.rs", "queue.rs"] {
        let source = std::fs::read_to_string(folder.join(file)).unwrap();
        let code: String = source.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        for function in [".sin(", ".cos(", ".tan(", "atan", "libm::sin", "libm::cos", "Angle"] {
            assert!(!code.contains(function), "{file} calls {function}");
        }
    }
}
