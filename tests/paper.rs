//! The CHTA paper's own figures (model section 7), each beside ours.

use chta::{
    ballistics::{HopTest, Split, TakeoffChoice},
    chain::{ConstrainedChain, Direction, PolygonalChain},
    graph::{Effort, Outcome, PointSpacing, SearchOptions, search},
    path::generate,
    quantity::{AngleInterval, ChainPoint, SegmentId},
    world::{Grip, Hopper, Limit, RestSlope, Surface},
};

/// Section V-B as one straight segment: 76 m along, from 54.61 to 59.24 m, angles stated from the slope, 10 m/s, g = 3.711.
fn the_76_m_case() -> ConstrainedChain {
    let chain = PolygonalChain::bare(vec![ChainPoint::new(0.0, 54.61), ChainPoint::new(76.0, 59.24)]).unwrap();
    let surface = Surface {
        grip: Some(Grip::FromSlope {
            takeoff: AngleInterval::from_degrees(60.0, 90.0),
            landing: AngleInterval::from_degrees(-90.0, -60.0),
        }),
        rest: RestSlope::AsFrictionHolds,
    };
    ConstrainedChain::new(chain, &Hopper::with_speeds(10.0, 10.0), &surface).unwrap()
}

#[test]
fn the_76_m_case_has_the_papers_reach_and_four_hops() {
    let chain = the_76_m_case();
    let test = HopTest::new(&chain, &Hopper::with_speeds(10.0, 10.0), 3.711);
    let reach = test.segment_reach(SegmentId(0), Direction::Forward).unwrap();
    // R_t = 20.913 m along the line of sight, 20.874 m horizontally, 60 degrees over the slope (model section 7).
    assert!((reach.reach_line_of_sight_m() - 20.913).abs() < 5e-4, "{}", reach.reach_line_of_sight_m());
    assert!((reach.reach_m() - 20.874).abs() < 5e-4, "{}", reach.reach_m());
    assert_eq!(reach.limit(), Limit::TakeoffSpeed);
    let over_slope = chta::quantity::Angle::from_slope(reach.takeoff_slope()).degrees()
        - chta::quantity::Angle::from_slope(reach.sight_slope()).degrees();
    assert!((over_slope - 60.0).abs() < 1e-9, "{over_slope}");

    let at = |x| chain.geometry().station(x).unwrap();
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(0)), ..SearchOptions::default() };
    let answer = search(&test, at(0.0), at(76.0), &options, &mut |_| {}).unwrap();
    assert_eq!(answer.hops(), Some(4));
    let Outcome::Path { legs, .. } = answer.outcome else { panic!("no path") };
    for split in Split::ALL {
        let path = generate(&test, &legs, TakeoffChoice::LeastSpeed, split).unwrap();
        assert_eq!(path.hops.len(), 4);
        assert!((path.totals.ground_distance_m - 76.0).abs() < 1e-9);
    }
    let _ = Effort::ALL;
}
