//! Chains along a polyline: every bend is a vertex, and no hop spans one.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its stage should stop")]

mod support;

use std::{fs, path::Path, process::Output};

use assert_cmd::Command;
use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, PolygonalChain, csv::read_chain_csv},
    graph::{Outcome, PointSpacing, SearchOptions, search},
    hop::{HopTest, Split},
    path::{ViolatedLimit, execute, generate},
    quantity::{ChainPoint, MapPoint, VertexId},
    terrain::{Dem, GeoReference, slice_legs, write_ascii_grid},
    world::{FrictionCone, Gravity, Grip, Hopper, Limit, RestSlope, SurfaceProperties},
};
use serde_json::Value;
use support::Draw;

fn hopper() -> Hopper {
    Hopper::with_speeds(6.0, 6.0).unwrap()
}

fn surface() -> SurfaceProperties {
    SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.8).unwrap())), rest: RestSlope::AsFrictionHolds }
}

/// A plain of 5 m posts over 60 m by 60 m with a tower of 50 m in its middle.
fn tower() -> Dem {
    let map = GeoReference::local(MapPoint::new(0.0, 60.0), 5.0, 5.0).unwrap();
    let height = |i: usize| if (5..8).contains(&(i / 13)) && (5..8).contains(&(i % 13)) { 50.0 } else { 0.0 };
    Dem::new(13, 13, (0..169).map(height).collect(), map).unwrap()
}

fn chta(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("chta").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)))
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
    assert_eq!(bends, [(50.0, at(55.0, 5.0)), (100.0, at(55.0, 55.0))], "(30, 5) is passed straight on; turning back is a bend");
    assert_eq!(chain.extent_m(), (0.0, 125.0));
    let mut csv = Vec::new();
    chta::chain::csv::write_chain_csv(&chain, &mut csv, &[]).unwrap();
    assert_eq!(read_chain_csv(&csv).unwrap().chain, chain);
    assert!(chain.clone().with_bends(vec![VertexId(0)]).is_err());
    assert!(read_chain_csv(b"x_m,z_m,bend\n0,0,1\n1,0,0\n").is_err());
    let same = slice_legs(&tower(), at(5.0, 5.0), &[at(5.0, 5.0)], at(9.0, 5.0)).unwrap_err().to_string();
    assert!(same.contains("same point"), "{same}");
}

#[test]
fn around_the_tower_by_the_corners_and_the_run_repeats() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write_ascii_grid(&tower(), fs::File::create(at.join("tower.asc")).unwrap()).unwrap();
    let scenario = |via: &str| {
        format!(
            "[body]\ngravity_m_s2 = 2.0\n[hopper]\ntakeoff_speed_max_m_s = 6.0\nlanding_speed_max_m_s = 6.0\n[surface]\n\
             friction_coefficient = 0.8\n[terrain]\ndem = \"tower.asc\"\nstart_m = [5, 30]\ngoal_m = [55, 30]\n{via}\n[search]\n\
             points_per_segment = 1\n"
        )
    };
    fs::write(at.join("through.toml"), scenario("")).unwrap();
    fs::write(at.join("around.toml"), scenario("via_m = [[5, 5], [55, 5]]")).unwrap();
    assert_eq!(chta(at, &["check", "through.toml"]).status.code(), Some(1), "the tower is too high");
    let document = json(&chta(at, &["plan", "around.toml", "--verify", "--format", "json"]));
    assert_eq!(document["verified"], true, "{document}");
    assert!(document["refusals"]["bend"].as_u64().unwrap() > 0);
    let corners = [25.0, 75.0];
    let mut headings = Vec::new();
    for hop in document["path"].as_array().unwrap() {
        let number = |key: &str| hop[key].as_f64().unwrap();
        assert!(!corners.iter().any(|&x| number("takeoff_x_m") < x && x < number("landing_x_m")), "{hop}");
        headings.push(number("heading_deg"));
        let flown = libm::hypot(
            number("landing_map_x_m") - number("takeoff_map_x_m"),
            number("landing_map_y_m") - number("takeoff_map_y_m"),
        );
        assert!((flown - (number("landing_x_m") - number("takeoff_x_m"))).abs() < 1e-9);
    }
    headings.dedup();
    assert_eq!(headings, [180.0, 90.0, 0.0], "south, east, north");
    let hop = json(&chta(at, &["hop", "around.toml", "--from", "20", "--to", "30", "--format", "json"]));
    assert_eq!((&hop["feasible"], &hop["binding"]["conflict"][0]), (&Value::Bool(false), &Value::from("bend")), "{hop}");
    assert_eq!(chta(at, &["run", "around.toml", "-o", "out"]).status.code(), Some(0));
    assert_eq!(chta(at, &["run", "out/result.json", "-o", "again"]).status.code(), Some(0));
    let read = |name: &str| fs::read_to_string(at.join(name)).unwrap();
    assert_eq!(read("out/result.json"), read("again/result.json"));
    assert_eq!(read("out/path.csv"), read("again/path.csv"));
    // Both ways of giving the bends make the same chain, and the chain alone remembers them.
    let sliced = chta(
        at,
        &["slice", "tower.asc", "--from", "5,30", "--to", "55,30", "--via", "5,5", "--via", "55,5", "--scenario", "around.toml"],
    );
    let rows = |text: &str| text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(rows(&String::from_utf8_lossy(&sliced.stdout)), rows(&read("out/chain.csv")));
    fs::write(at.join("bare.toml"), scenario("").replace("dem = \"tower.asc\"\nstart_m = [5, 30]\ngoal_m = [55, 30]\n", ""))
        .unwrap();
    let by_chain = json(&chta(
        at,
        &["check", "out/chain.csv", "--scenario", "bare.toml", "--start", "0", "--goal", "100", "--format", "json"],
    ));
    assert_eq!(by_chain["hops"], document["hops"]);
}
