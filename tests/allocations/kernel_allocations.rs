//! The hop kernel allocates nothing, pair by pair or by sweep; nor does the cut of the cone of a stance.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its scene should stop")]

use std::sync::Arc;

use chta::{
    ballistics::stance::{ConeKind, ContactCone, PyramidEdges},
    chain::{ConstrainedChain, PolygonalChain},
    ground::{LandingTable, Sweep},
    hop::HopTest,
    quantity::{ChainPoint, VertexId},
    world::{Direction, FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SpeedLevels, SurfaceProperties},
};
use nalgebra::{Vector2, Vector3};
use stats_alloc::Region;

use crate::{ALLOCATOR, alone};

#[test]
fn ten_thousand_pairs_are_evaluated_without_an_allocation_either_way() {
    let _guard = alone();
    let vertices = (0..=100).map(|i| ChainPoint::new(f64::from(i), 0.3 * f64::from(i * i % 7))).collect();
    let hopper = Hopper::new(HopperLimits {
        clearance_m: 0.05,
        apex_height_max_m: Some(20.0),
        flight_time_max_s: Some(10.0),
        takeoff_speed_levels: SpeedLevels::new(&[3.0, 6.0, 9.0]).ok(),
        ..HopperLimits::with_speeds(9.0, 9.0)
    })
    .unwrap();
    let grip = Some(Grip::Friction(FrictionCone::new(0.9).unwrap()));
    let surface = SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds };
    let chain =
        ConstrainedChain::new(PolygonalChain::bare(vertices).unwrap(), &hopper, Gravity::new(3.711).unwrap(), &surface).unwrap();
    let test = HopTest::new(chain.clone());
    let evaluate_all = || {
        let (mut feasible, mut refused) = (0, 0);
        for i in 0..=100 {
            let takeoff = chain.geometry().vertex_station(VertexId(i));
            for j in 0..=100 {
                match test.lofts(&takeoff, &chain.geometry().vertex_station(VertexId(j))) {
                    Ok(_) => feasible += 1,
                    Err(_) => refused += 1,
                }
            }
        }
        (feasible, refused)
    };
    let stations: Vec<_> = (0..=100).map(|i| chain.geometry().vertex_station(VertexId(i))).collect();
    let table = Arc::new(LandingTable::new(&test, stations.as_slice()));
    let mut sweep = Sweep::new(Arc::clone(&table));
    let mut sweep_all =
        || {
            let (mut feasible, mut refused) = (0, stations.len());
            for takeoff in &stations {
                for direction in Direction::BOTH {
                    sweep.landings(takeoff, 0..stations.len(), direction, |_, verdict| {
                        if verdict.is_ok() { feasible += 1 } else { refused += 1 }
                    });
                }
            }
            (feasible, refused)
        };
    let (allocations, (feasible, refused)) = quietest(evaluate_all);
    assert_eq!(allocations, 0);
    assert!(feasible > 300 && refused > 3000, "the pairs are all alike: {feasible} feasible, {refused} refused");
    // The first round creates the working memory, which the other two reuse.
    assert_eq!(quietest(&mut sweep_all), (0, (feasible, refused)));
}

#[test]
fn cones_of_stances_are_cut_without_an_allocation() {
    let _guard = alone();
    let friction = FrictionCone::new(0.6).unwrap();
    let normals = [Vector3::new(0.6, 0.0, 0.8), Vector3::new(-0.6, 0.0, 0.8), Vector3::y(), Vector3::new(0.0, -0.8, 0.6)];
    let contacts = normals.map(|normal| ContactCone::new(normal, friction).unwrap());
    for kind in [ConeKind::Exact, ConeKind::Kc, ConeKind::KcPlus, ConeKind::Pyramid(PyramidEdges::Eight)] {
        let cone = kind.cone(&contacts[..3]);
        let cut_all = || {
            let headings = (0..64).map(|turn| Vector2::new(f64::from(turn - 32), 7.0).normalize());
            let is_open =
                |heading: &Vector2<f64>| !cone.takeoff_slopes(*heading).is_empty() || !cone.landing_slopes(*heading).is_empty();
            headings.filter(is_open).count()
        };
        let (allocations, open) = quietest(cut_all);
        assert_eq!(allocations, 0, "{kind:?}");
        assert!(open > 0, "{kind:?}: no heading is open");
    }
}

/// The fewest allocations of three rounds, and the result of that round: the test harness has its own thread, whose allocations
/// count too.
fn quietest<T: Ord + Copy>(mut round: impl FnMut() -> T) -> (usize, T) {
    let rounds = [(); 3].map(|()| {
        let region = Region::new(ALLOCATOR);
        let outcome = round();
        let change = region.change();
        (change.allocations + change.reallocations, outcome)
    });
    rounds.into_iter().min().unwrap()
}
