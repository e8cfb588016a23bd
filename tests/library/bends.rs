//! Chains along a polyline: every bend is a vertex, and no hop spans one.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its stage should stop")]

use crate::{support::Draw, tower::tower};
use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, PolygonalChain, csv::read_chain_csv},
    graph::{Outcome, PointSpacing, SearchOptions, search},
    hop::{HopTest, Split},
    path::{ViolatedLimit, execute, generate},
    quantity::{ChainPoint, MapPoint, VertexId},
    terrain::slice_legs,
    world::{FrictionCone, Gravity, Grip, Hopper, Limit, RestSlope, SurfaceProperties},
};

fn hopper() -> Hopper {
    Hopper::with_speeds(6.0, 6.0).unwrap()
}

fn surface() -> SurfaceProperties {
    SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.8).unwrap())), rest: RestSlope::AsFrictionHolds }
}

#[test]
fn a_pair_is_refused_for_a_bend_exactly_where_one_lies_strictly_between() {
    let mut draw = Draw::seeded(41);
    let (mut spanning, mut free) = (0, 0);
    for _ in 0..40 {
        let points: Vec<ChainPoint> = draw.profile(8, 3.0);
        let straight = PolygonalChain::bare(points.clone()).unwrap();
        let bends: Vec<VertexId> = (1..8).filter(|_| draw.chance(0.3)).map(VertexId).collect();
        let bent = straight.clone().with_bends(bends.clone()).unwrap();
        let lenient = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(3.0).unwrap())), rest: RestSlope::Unlimited };
        let [straight, bent] =
            [straight, bent].map(|chain| ConstrainedChain::new(chain, &hopper(), Gravity::new(2.0).unwrap(), &lenient).unwrap());
        let (of_straight, of_bent) = (HopTest::new(straight.clone()), HopTest::new(bent.clone()));
        let places: Vec<f64> =
            points.iter().map(|p| p.x_m).chain(points.windows(2).map(|pair| 0.5 * (pair[0].x_m + pair[1].x_m))).collect();
        for &a in &places {
            for &b in places.iter().filter(|&&b| b != a) {
                let spans = bends.iter().any(|v| points[v.index()].x_m > a.min(b) && points[v.index()].x_m < a.max(b));
                let ends = [a, b].map(|x_m| bent.geometry().station(x_m).unwrap());
                let (expected, found) = (of_straight.lofts(&ends[0], &ends[1]), of_bent.lofts(&ends[0], &ends[1]));
                let explained = of_bent.takeoff_set(&ends[0], &ends[1]).unwrap();
                if spans {
                    assert!(found.is_err() && explained.lofts().is_none());
                    assert!(found == Err(Limit::Bend) || expected == found, "{found:?} {expected:?}");
                    let limit = explained.limits().iter().find(|limit| limit.limit == Limit::Bend).unwrap();
                    assert!(limit.lofts.is_empty() && bends.contains(&limit.vertex.unwrap()));
                    spanning += usize::from(expected.is_ok());
                } else {
                    assert_eq!(found, expected);
                    assert_eq!(explained.lofts().is_some(), expected.is_ok());
                    free += usize::from(expected.is_ok());
                }
            }
        }
    }
    assert!(spanning > 100 && free > 100, "{spanning} {free}");
}

#[test]
fn the_checker_refuses_a_hop_that_spans_a_bend() {
    let plain = PolygonalChain::bare([0.0, 7.0, 20.0].map(|x_m| ChainPoint::new(x_m, 0.0)).to_vec()).unwrap();
    let chain = |geometry| ConstrainedChain::new(geometry, &hopper(), Gravity::new(2.0).unwrap(), &surface()).unwrap();
    let (straight, bent) = (chain(plain.clone()), chain(plain.with_bends(vec![VertexId(1)]).unwrap()));
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(1)), ..SearchOptions::default() };
    let planned = |chain: &ConstrainedChain| {
        let test = HopTest::new(chain.clone());
        let ends = [2.0, 14.0].map(|x_m| chain.geometry().station(x_m).unwrap());
        let Outcome::Path { legs, .. } = search(&test, ends[0], ends[1], &options, &()).unwrap().outcome else { panic!("no path") };
        generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::FullReach).unwrap()
    };
    let (over, around) = (planned(&straight), planned(&bent));
    assert_eq!((over.hops.len(), around.hops.len()), (1, 2));
    assert_eq!(around.hops[0].landing.along_m, 7.0, "it lands on the bend");
    assert!(execute(&bent, &around, None).passes());
    assert!(execute(&straight, &over, None).passes());
    let violations = execute(&bent, &over, None).violations;
    assert!(
        violations.iter().any(|v| v.limit == ViolatedLimit::Limit(Limit::Bend) && v.vertex == Some(VertexId(1)) && v.at_x_m == 7.0),
        "{violations:?}"
    );
}

#[test]
fn legs_meet_in_one_vertex_and_a_straight_via_is_no_bend() {
    let at = MapPoint::new;
    let legs = slice_legs(&tower(), at(5.0, 5.0), &[at(30.0, 5.0), at(55.0, 5.0), at(55.0, 55.0)], at(55.0, 30.0)).unwrap();
    let chain = PolygonalChain::from_legs(&legs, None).unwrap();
    let place = |v: &VertexId| (chain.vertices()[v.index()].x_m, chain.map_points().unwrap()[v.index()]);
    let bends: Vec<_> = chain.bends().iter().map(place).collect();
    assert_eq!(bends, [(50.0, at(55.0, 5.0)), (100.0, at(55.0, 55.0))], "(30, 5) lies on a straight line; turning back is a bend");
    assert_eq!(chain.extent_m(), (0.0, 125.0));
    let mut csv = Vec::new();
    chta::chain::csv::write_chain_csv(&chain, &mut csv, &[]).unwrap();
    assert_eq!(read_chain_csv(&csv).unwrap().chain, chain);
    assert!(chain.clone().with_bends(vec![VertexId(0)]).is_err());
    assert!(read_chain_csv(b"x_m,z_m,bend\n0,0,1\n1,0,0\n").is_err());
    let same = slice_legs(&tower(), at(5.0, 5.0), &[at(5.0, 5.0)], at(9.0, 5.0)).unwrap_err().to_string();
    assert!(same.contains("same point"), "{same}");
}
