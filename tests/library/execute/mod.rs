//! The checker of planned paths: paths of the planner pass, and spoiled ones are refused under the right name.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "a test may fail, and says how much it has tried")]

mod spoiled;
pub(crate) mod world;

use self::world::World;
pub(crate) use self::world::{Dice, World as RandomWorld};
use chta::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    chain::{ConstrainedChain, PolygonalChain},
    ground::Surface,
    hop::HopTest,
    path::{Flight, Hop, HopPath, StatedValue, Totals, ViolatedLimit, Violation, execute},
    quantity::{Angle, AngleInterval, ChainPoint, VertexId},
    world::{Direction, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties},
};

/// The hop with the angles, speeds, time and apex of another arc.
pub(crate) fn with_arc(hop: &Hop, arc: &Arc) -> Hop {
    Hop {
        takeoff_angle: arc.takeoff_angle(),
        takeoff_speed_m_s: arc.takeoff_speed_m_s(),
        landing_angle: arc.landing_angle(),
        landing_speed_m_s: arc.landing_speed_m_s(),
        flight_time_s: arc.flight_time_s(),
        apex_z_m: hop.takeoff.point_m.z + arc.apex_height_m(),
        // Without brakes.
        delta_v_m_s: hop.delta_v_m_s + (arc.takeoff_speed_m_s() - hop.takeoff_speed_m_s),
        ..*hop
    }
}

/// The independence on which the check rests, verified in the source.
#[test]
fn the_checker_imports_nothing_of_the_closed_forms_or_the_graph() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/path/execute");
    let mut files = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let source = std::fs::read_to_string(&path).unwrap();
        for (number, line) in source.lines().enumerate() {
            let code = line.split("//").next().unwrap();
            for forbidden in ["ballistics", "graph", "LineOfSight", "TakeoffSet", "MonicQuadratic"] {
                assert!(!code.contains(forbidden), "{}:{}: the checker uses {forbidden}: {line}", path.display(), number + 1);
            }
        }
        files += 1;
    }
    assert!(files >= 4, "only {files} files in {}", folder.display());
}

#[test]
fn thousands_of_random_paths_pass_unspoiled() {
    let mut dice = Dice::new(20_240_917);
    let (mut paths, mut hops, mut several, mut steps) = (0, 0, 0, 0);
    let mut runs_m = (f64::INFINITY, 0.0f64);
    for world_number in 0..20_000 {
        let world = World::random(&mut dice);
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain.clone());
        let Some(path) = world.plan(&test) else { continue };
        let execution = execute(&chain, &path, Some(world.ends(&chain)));
        let said: Vec<String> = execution.violations.iter().map(ToString::to_string).collect();
        let ends: Vec<_> = path.hops.iter().map(|h| (h.lower_limit, h.upper_limit)).collect();
        assert!(execution.passes(), "world {world_number}: {said:#?}\n{ends:?}\n{world:?}");
        if !path.hops.is_empty() {
            paths += 1;
        }
        several += usize::from(path.hops.len() > 1);
        hops += path.hops.len();
        for (hop, flight) in path.hops.iter().zip(&execution.flights) {
            let run_m = hop.run_m();
            runs_m = (runs_m.0.min(run_m), runs_m.1.max(run_m));
            steps += flight.as_ref().unwrap().steps;
        }
    }
    println!("{paths} paths ({several} of several hops), {hops} hops of {:e} to {:e} m, {steps} steps", runs_m.0, runs_m.1);
    assert!(paths >= 8000 && several >= 3000 && hops >= 25_000, "{paths} paths, {several} of several hops, {hops} hops");
    assert!(runs_m.0 < 1e-3 && runs_m.1 > 5e4, "hops of {} to {} m only", runs_m.0, runs_m.1);
}

type Change = fn(&mut Hop);

/// Every number that a hop states is compared with the flight.
#[test]
fn a_changed_number_is_named() {
    let mut dice = Dice::new(7);
    let mut changed = [0; 9];
    for _ in 0..400 {
        let world = World::random(&mut dice);
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain.clone());
        let Some(path) = world.plan(&test) else { continue };
        let Some(last) = path.hops.len().checked_sub(1) else { continue };
        let changes: [(StatedValue, Change); 9] = [
            (StatedValue::LandingSpeed, |h| h.landing_speed_m_s *= 1.01),
            (StatedValue::LandingAngle, |h| {
                h.landing_angle = Angle::from_radians(h.landing_angle.radians() + 0.01);
            }),
            (StatedValue::FlightTime, |h| h.flight_time_s *= 0.99),
            (StatedValue::Apex, |h| h.apex_z_m += 0.01 * h.run_m()),
            (StatedValue::SpeedMargin, |h| h.speed_margin_m_s += 0.01 * h.takeoff_speed_m_s),
            (StatedValue::TakeoffSpeed, |h| h.takeoff_speed_m_s = f64::NAN),
            (StatedValue::LandingStation, |h| h.landing.point_m.z += 0.01 * h.run_m()),
            (StatedValue::DeltaV, |h| h.delta_v_m_s *= 1.01),
            (StatedValue::Heading, |h| h.heading_deg = (h.heading_deg + 1.0) % 360.0),
        ];
        for (i, (value, change)) in changes.into_iter().enumerate() {
            let mut other = path.clone();
            change(&mut other.hops[last]);
            if value == StatedValue::Heading && path.hops[last].map_ends().is_none() {
                continue;
            }
            let execution = execute(&chain, &other, None);
            let named = execution.violations.iter().any(|v| v.hop == last + 1 && v.limit == ViolatedLimit::StatedValue(value));
            assert!(named, "{} changed, but found {:?}", value.name(), execution.violations);
            changed[i] += 1;
        }
    }
    assert!(changed.iter().all(|&n| n >= 20), "{changed:?}");
}

#[test]
fn a_path_must_join_its_ends_without_a_gap() {
    let mut dice = Dice::new(99);
    let mut checked = 0;
    while checked < 20 {
        let world = World::random(&mut dice);
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain.clone());
        let Some(path) = world.plan(&test).filter(|path| path.hops.len() > 2) else { continue };
        let (start, goal) = world.ends(&chain);
        let gaps = |path: &_, ends| {
            let execution = execute(&chain, path, ends);
            execution.violations.iter().filter(|v| v.limit == ViolatedLimit::Continuity).map(|v| v.hop).collect::<Vec<_>>()
        };
        assert!(gaps(&path, Some((start, goal))).is_empty());
        assert_eq!(gaps(&path, Some((goal, start))), [1, path.hops.len()]);
        let mut holed = path.clone();
        holed.hops.remove(1);
        assert_eq!(gaps(&holed, Some((start, goal))), [2]);
        holed.hops.clear();
        assert_eq!(gaps(&holed, Some((start, goal))), [0], "an empty path between two positions");
        assert!(gaps(&holed, Some((start, start))).is_empty());
        checked += 1;
    }
}

/// A needle of 1 m at (2, 0), on flat ground from 0 to 6 m.
fn over_a_needle(clearance_m: f64) -> ConstrainedChain {
    let points = [(0.0, 0.0), (1.9, 0.0), (2.0, 1.0), (2.1, 0.0), (6.0, 0.0)];
    let grip =
        Grip::FromSlope { takeoff: AngleInterval::from_degrees(10.0, 80.0), landing: AngleInterval::from_degrees(-80.0, -10.0) };
    let hopper = Hopper::new(HopperLimits { clearance_m, ..HopperLimits::with_speeds(20.0, 20.0) }).unwrap();
    let chain = PolygonalChain::bare(points.map(|(x, z)| ChainPoint::new(x, z)).to_vec()).unwrap();
    ConstrainedChain::new(
        chain,
        &hopper,
        Gravity::new(10.0).unwrap(),
        &SurfaceProperties { grip: Some(grip), rest: RestSlope::Unlimited },
    )
    .unwrap()
}

/// A hop from 0 to 4 m with a take-off slope `m`, flown at g = 10: `z = m d (1 - d / 4)`.
fn flown_over_the_needle(m: f64, clearance_m: f64, change: Change) -> (Option<Flight>, Vec<Violation>) {
    let chain = over_a_needle(clearance_m);
    let arc = Arc::new(LineOfSight::new(4.0, 0.0), m, 10.0);
    let mut hop = Hop {
        direction: Direction::Forward,
        takeoff: chain.contact_point(&chain.geometry().station(0.0).unwrap()),
        landing: chain.contact_point(&chain.geometry().station(4.0).unwrap()),
        heading_deg: 90.0,
        takeoff_angle: arc.takeoff_angle(),
        takeoff_speed_m_s: arc.takeoff_speed_m_s(),
        landing_angle: arc.landing_angle(),
        landing_speed_m_s: arc.landing_speed_m_s(),
        flight_time_s: arc.flight_time_s(),
        apex_z_m: arc.apex_height_m(),
        delta_v_m_s: arc.takeoff_speed_m_s(),
        propellant: None,
        takeoff_angles: AngleInterval::from_degrees(45.0, 80.0),
        speed_margin_m_s: 20.0 - arc.takeoff_speed_m_s(),
        lower_limit: Limit::Terrain,
        lower_vertex: Some(VertexId(2)),
        upper_limit: Limit::TakeoffCone,
        aim: None,
        margins: chta::hop::HopMargins::UNLIMITED,
        roll_out: None,
    };
    change(&mut hop);
    let execution = execute(&chain, &HopPath { hops: vec![hop], totals: Totals::default() }, None);
    (execution.flights[0].clone(), execution.violations)
}

fn limits(violations: &[Violation]) -> Vec<ViolatedLimit> {
    violations.iter().map(|v| v.limit).collect()
}

#[test]
fn a_flight_over_a_needle_is_measured() {
    // Slope 1.5 passes (2, 1) at 1.5 m, and v = sqrt(10 * 4 * 3.25 / 3) at both ends.
    let (flight, violations) = flown_over_the_needle(1.5, 0.5, |_| ());
    assert!(violations.is_empty(), "{violations:?}");
    let flight = flight.unwrap();
    let least = flight.least_clearance.unwrap();
    assert_eq!(least.vertex, Some(VertexId(2)));
    assert!((least.height_m - 0.5).abs() < 1e-12, "{least:?}");
    assert!((flight.apex_z_m - 1.5).abs() < 1e-12 && (flight.landing_speed_m_s - (130f64 / 3.0).sqrt()).abs() < 1e-12);
    assert!((flight.landing_angle.radians() + 1.5f64.atan()).abs() < 1e-12 && (flight.flight_time_s - 1.2f64.sqrt()).abs() < 1e-12);
    assert!(flight.steps >= 64, "{} steps", flight.steps);
}

#[test]
fn a_needle_passed_too_low_is_named_and_one_that_is_hit_stops_the_flight() {
    let (_, violations) = flown_over_the_needle(1.499, 0.5, |_| ());
    assert_eq!(limits(&violations), [ViolatedLimit::Limit(Limit::Terrain)]);
    let said = violations[0].to_string();
    assert!(said.starts_with("hop 1: terrain is violated at x = 2 m over vertex 3: 0.49"), "{said}");
    // Slope 0.8: at 1.98 m the arc is 0.8 m high, and so is the needle's face 10 (x - 1.9).
    let (flight, violations) = flown_over_the_needle(0.8, 0.0, |_| ());
    assert_eq!(limits(&violations), [ViolatedLimit::Limit(Limit::Terrain), ViolatedLimit::LandingPoint]);
    let contact = flight.unwrap().contact.unwrap();
    assert!((contact.z_m - 0.8 * contact.x_m * (1.0 - contact.x_m / 4.0)).abs() < 1e-12, "on the arc: {contact:?}");
    assert!((contact.z_m - 10.0 * (contact.x_m - 1.9)).abs() < 1e-12, "on the needle: {contact:?}");
}

#[test]
fn a_hop_that_leaves_the_chain_or_the_direction_of_travel_is_reported() {
    let (flight, violations) = flown_over_the_needle(1.5, 0.0, |hop| hop.takeoff_speed_m_s *= 1.5);
    assert_eq!(flight.unwrap().contact, None, "it flies past the chain's end at 6 m");
    let miss = violations.iter().find(|v| v.limit == ViolatedLimit::LandingPoint).unwrap();
    assert_eq!((miss.at_x_m, miss.measure.unwrap().found), (6.0, 2.0));
    let (flight, violations) = flown_over_the_needle(1.5, 0.0, |hop| hop.takeoff_angle = Angle::from_degrees(95.0));
    assert!(flight.is_none());
    assert_eq!(limits(&violations), [ViolatedLimit::Limit(Limit::TakeoffCone), ViolatedLimit::LandingPoint]);
    let (_, violations) = flown_over_the_needle(1.5, 0.0, |hop| hop.direction = Direction::Reverse);
    assert_eq!(limits(&violations), [ViolatedLimit::StatedValue(StatedValue::Direction)]);
}

/// A plan made under Bennu's gravity alone hops 500 m in one hop of 0.215 m/s. Flown again under Bennu, whose escape speed is
/// sqrt(2 x 4.892 / 245.03) = 0.1998 m/s, it breaks both speed limits, whatever the hopper's own limits are; down a cliff only the
/// landing is that fast.
#[test]
fn a_hop_at_escape_speed_breaks_the_speed_limits_of_a_body_of_known_radius() {
    use chta::world::{Body, FrictionCone};
    let bennu = Body::named("bennu").unwrap().gravity;
    let alone = Gravity::new(bennu.m_s2()).unwrap();
    let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(5.0).unwrap())), rest: RestSlope::Unlimited };
    let hopper = Hopper::with_speeds(1.0, 1.0).unwrap();
    for (points, broken) in [
        ([(0.0, 0.0), (499.0, 0.0), (500.0, 0.0)], &[Limit::TakeoffSpeed, Limit::LandingSpeed][..]),
        ([(0.0, 400.0), (299.0, 0.0), (300.0, 0.0)], &[Limit::LandingSpeed]),
        ([(0.0, 0.0), (99.0, 0.0), (100.0, 0.0)], &[]),
    ] {
        let points = points.map(|(x_m, z_m)| ChainPoint::new(x_m, z_m)).to_vec();
        let chain =
            |gravity| ConstrainedChain::new(PolygonalChain::bare(points.clone()).unwrap(), &hopper, gravity, &surface).unwrap();
        let test = HopTest::new(chain(alone));
        let ends = [0, 2].map(|vertex| test.chain().geometry().vertex_station(VertexId(vertex)));
        let lofts = test.lofts(&ends[0], &ends[1]).unwrap();
        let leg = chta::graph::Leg { takeoff: ends[0], landing: ends[1], edge: chta::graph::Edge::Hop(lofts), loft: None };
        let path = chta::path::generate(&test, &[leg], TakeoffChoice::default(), chta::hop::Split::FullReach).unwrap();
        assert!(execute(test.chain(), &path, None).passes(), "{points:?}");
        let violations = execute(&chain(bennu), &path, None).violations;
        let named: Vec<ViolatedLimit> =
            limits(&violations).into_iter().filter(|limit| matches!(limit, ViolatedLimit::Limit(_))).collect();
        assert_eq!(named, broken.iter().map(|limit| ViolatedLimit::Limit(*limit)).collect::<Vec<_>>(), "{points:?}");
    }
}
