//! Single legs: the plain form against sampling, the fast form against the plain one.

use super::{any_rover, flat, ground, ugly_ground};
use crate::{
    draw::Draw,
    drive::{DriveAmount, DriveEdges, DriveGround, DriveLeg, DriveLimit, DriveRefusal, DriveRefusalCounts},
    ground::{DemGround, MapPosition, NodeLattice},
    quantity::{Angle, MapPoint},
    terrain::{Dem, GeoReference, Overlays},
    world::{Neighbours, Rover, RoverLimits},
};

fn at(ground: &DemGround, x_m: f64, y_m: f64) -> MapPosition {
    ground.position(MapPoint::new(x_m, y_m)).unwrap()
}

/// A DEM of posts 1 m apart, with the south-west post at the origin.
fn dem(rows: &[&[f64]]) -> DemGround {
    #[expect(clippy::cast_precision_loss, reason = "a few rows")]
    let north_m = (rows.len() - 1) as f64;
    let map = GeoReference::local(MapPoint::new(0.0, north_m), 1.0, 1.0).unwrap();
    ground(Dem::new(rows.len(), rows[0].len(), rows.concat(), map).unwrap(), Overlays::default(), 2.0)
}

/// Lengths, climbs and extremes of legs between any two places are those of a fine sampling of the ground beside them.
#[test]
fn a_leg_is_what_a_sampling_of_its_ground_says() {
    let draw = &mut Draw::seeded(2210);
    let mut legs = 0;
    for _ in 0..60 {
        let ground = ugly_ground(draw, 8, 9);
        let rover = Rover::new(RoverLimits::new(0.3, Angle::from_degrees(90.0)), None).unwrap();
        let drive = DriveGround::new(&ground, &rover);
        let bounds = ground.terrain().dem().bounds();
        for _ in 0..20 {
            let mut place = || MapPoint::new(draw.uniform(bounds.min.x, bounds.max.x), draw.uniform(bounds.min.y, bounds.max.y));
            let (Some(from), Some(to)) = (ground.position(place()), ground.position(place())) else { continue };
            let Ok(leg) = drive.leg(&from, &to) else { continue };
            legs += 1;
            let (samples, away) = (4000, to.at - from.at);
            let heading = away / away.norm();
            let (mut length_m, mut climb_m, mut up, mut down, mut across) = (0.0, 0.0, 0.0f64, 0.0f64, 0.0f64);
            for i in 0..samples {
                let middle = from.at + away * ((f64::from(i) + 0.5) / f64::from(samples));
                let (_, gradient) = ground.triangles().at(middle, ground.triangles().nominal()).unwrap();
                let (slope, run_m) = (gradient.dot(&heading), away.norm() / f64::from(samples));
                length_m += run_m.hypot(slope * run_m);
                climb_m += run_m * slope.max(0.0);
                (up, down, across) = (up.max(slope), down.max(-slope), across.max(gradient.perp(&heading).abs()));
            }
            let coarse = 1e-9 + 20.0 * away.norm() * (1.0 + up.max(down)) / f64::from(samples);
            assert!(
                (leg.length_m - length_m).abs() < coarse && (leg.climb_m - climb_m).abs() < coarse,
                "{leg:?} {length_m} {climb_m}"
            );
            assert!((leg.climb_m - leg.descent_m - (to.z_m - from.z_m)).abs() < 1e-9 * (1.0 + leg.climb_m));
            assert!((leg.time_s - leg.length_m / 0.3).abs() < 1e-9 * leg.time_s);
            // A sampling may miss a short piece, but finds nothing steeper.
            let found = [leg.steepest_up.value, leg.steepest_down.value, leg.steepest_across.value];
            assert!(found.iter().zip([up, down, across]).all(|(found, sampled)| *found >= sampled - 1e-9), "{leg:?}");
            let back = drive.leg(&to, &from).unwrap();
            assert!((back.length_m - leg.length_m).abs() < 1e-9 * leg.length_m);
            assert!((back.steepest_up.value - leg.steepest_down.value).abs() < 1e-9 * (1.0 + back.steepest_up.value));
        }
    }
    assert!(legs > 300, "{legs}");
}

/// Every leg between posts: the same answer, the same limit in all, and the same cost up to rounding.
#[test]
fn legs_between_posts_are_the_plain_ones() {
    let draw = &mut Draw::seeded(2211);
    let mut kinds = DriveRefusalCounts::default();
    let (mut allowed, mut touching) = (0, 0);
    for round in 0..150 {
        let (rows, cols) = (6 + draw.below(5), 6 + draw.below(5));
        let ground = ugly_ground(draw, rows, cols);
        let neighbours = Neighbours::ALL[round % 3];
        let rover = any_rover(draw, neighbours, &ground);
        let drive = DriveGround::new(&ground, &rover);
        let lattice = NodeLattice::new(ground.terrain().dem(), 1);
        let all = DriveAmount::ALL.map(|amount| DriveEdges::new(&drive, lattice, amount, &()).unwrap());
        let mut counts = DriveRefusalCounts::default();
        for node in 0..lattice.count() {
            for direction in 0..neighbours.count() {
                let is_allowed = all[0].directions(node) >> direction & 1 == 1;
                match all[0].leg(node, direction) {
                    None => assert!(!is_allowed),
                    Some(Err(refusal)) => {
                        assert!(!is_allowed, "{refusal:?} {:?}", rover.limits());
                        counts.count(refusal.limit());
                    }
                    Some(Ok(leg)) => {
                        assert!(is_allowed, "{leg:?} {:?}", rover.limits());
                        allowed += 1;
                        touching += u32::from((leg.steepest_up.value - rover.slopes()[0]).abs() < 1e-9);
                        let costs = all.each_ref().map(|edges| edges.cost(node, direction));
                        for (cost, plain) in costs.iter().zip([leg.time_s, leg.energy_j_kg, leg.length_m]) {
                            assert!((cost - plain).abs() <= 1e-11 * plain + 1e-13, "{cost} {plain}");
                        }
                        // Walls of 50 m beside the way round what it climbs.
                        let sums = all[0].sums(node, direction).unwrap();
                        let of =
                            |leg: &DriveLeg| [leg.run_m, leg.climb_m, leg.descent_m, leg.time_s, leg.energy_j_kg, leg.length_m];
                        assert!(of(&sums).iter().zip(of(&leg)).all(|(sum, plain)| (sum - plain).abs() <= 1e-11 * (plain + 1.0)));
                        let least = DriveAmount::ALL.map(|amount| amount.least_per_m(&rover) * leg.run_m);
                        assert!(costs.iter().zip(least).all(|(cost, least)| *cost >= least));
                    }
                }
            }
        }
        assert_eq!(all[0].refusals(), counts, "{:?}", rover.limits());
        kinds += counts;
    }
    assert!(DriveLimit::ALL.iter().all(|limit| kinds.of(*limit) > 300), "{kinds:?}");
    assert!(allowed > 20_000 && touching > 50, "{allowed} allowed, {touching} of them touch");
}

#[test]
fn a_leg_along_an_edge_obeys_both_facets() {
    // Level along the middle row; beside it level ground to the north, and a wall down to the south.
    let ground = dem(&[&[0.0; 4], &[0.0; 4], &[-2.0; 4]]);
    let rover = Rover::new(RoverLimits::new(0.1, Angle::from_degrees(30.0)), None).unwrap();
    let drive = DriveGround::new(&ground, &rover);
    let refusal = drive.leg(&at(&ground, 0.0, 1.0), &at(&ground, 3.0, 1.0)).unwrap_err();
    assert!(matches!(refusal, DriveRefusal::CrossSlope { slope, .. } if (slope - 2.0).abs() < 1e-12), "{refusal}");
    assert!(drive.leg(&at(&ground, 0.0, 1.1), &at(&ground, 3.0, 1.1)).is_ok());
}

#[test]
fn refusals_are_named_in_their_order_with_value_limit_and_place() {
    // A bump of 0.4 m in the middle of a plain.
    let ground = dem(&[&[0.0; 5], &[0.0; 5], &[0.0, 0.0, 0.4, 0.0, 0.0], &[0.0; 5], &[0.0; 5]]);
    let leg = |limits: RoverLimits| {
        let rover = Rover::new(limits, None).unwrap();
        DriveGround::new(&ground, &rover).leg(&at(&ground, 1.0, 2.0), &at(&ground, 3.0, 2.0))
    };
    let free = RoverLimits::new(0.1, Angle::from_degrees(45.0));
    let sentence = |limits: RoverLimits| leg(limits).unwrap_err().to_string();
    assert!(leg(free.clone()).is_ok());
    let up = Angle::from_degrees(20.0);
    assert_eq!(
        sentence(RoverLimits { slope_up_max: up, ..free.clone() }),
        "the leg climbs 21.801 deg 0.500 m along, more than 20.000 deg"
    );
    assert_eq!(
        sentence(RoverLimits { slope_down_max: Some(up), ..free.clone() }),
        "the leg descends 21.801 deg 1.500 m along, more than 20.000 deg"
    );
    let wheels = RoverLimits { wheelbase_m: Some(0.5), ..free.clone() };
    assert_eq!(
        sentence(RoverLimits { step_max_m: Some(0.1), ..wheels.clone() }),
        "the heights under the axles differ by 0.200 m 0.250 m along the leg, more than 0.1 m"
    );
    assert!(
        leg(RoverLimits { step_max_m: Some(0.2), ..wheels.clone() }).unwrap().step.is_some_and(|step| step.value <= 0.2 + 1e-12)
    );
    let refusal = leg(RoverLimits { roughness_max_m: Some(0.001), ..wheels.clone() }).unwrap_err();
    assert!(matches!(refusal, DriveRefusal::Roughness { residual_m, .. } if residual_m > 0.01), "{refusal}");
    // A wheelbase that the map has no room for beyond the ends.
    let refusal = leg(RoverLimits { step_max_m: Some(9.0), wheelbase_m: Some(2.2), ..free }).unwrap_err();
    assert!(matches!(refusal, DriveRefusal::NoGround { at_m } if (at_m + 1.1).abs() < 1e-9), "{refusal}");
}

#[test]
fn a_leg_without_length_takes_nothing() {
    let ground = flat(4, (1.0, 1.0));
    let rover = Rover::new(RoverLimits::new(0.1, Angle::from_degrees(5.0)), None).unwrap();
    let drive = DriveGround::new(&ground, &rover);
    let place = at(&ground, 4.0, 49.0);
    assert_eq!(drive.leg(&place, &place).map(|leg| (leg.run_m, leg.time_s)), Ok((0.0, 0.0)));
}
