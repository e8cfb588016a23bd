//! Headings in steps: hops over a DEM beside the line of the search, at the headings that the machine has.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::sync::Arc;

use chta::{
    ballistics::{Arc as Flight, LineOfSight, TakeoffChoice},
    graph::{CostToGo, Leg, NodeSet, Outcome, PointSpacing, SearchOptions, search},
    ground::{DemGround, FirstContact, LiftoffVelocity, MapPosition, Surface, Windows},
    hop::{HopTest, Split},
    path::{Hop, HopPath, NoCommand, PathError, StatedValue, ViolatedLimit, execute, generate, generate_over},
    quantity::{Angle, MapPoint},
    terrain::{Dem, GeoReference, OverlaidDem, Overlays},
    uncertainty::{Mission, Policy, Simulation, TrialOptions, TrialOutcome, Uncertainty},
    world::{
        CommandSteps, FrictionCone, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties, is_multiple,
        tolerant_speed_m_s,
    },
};
use nalgebra::Vector2;

use crate::support::Draw;

/// A journey over a DEM.
struct Journey {
    ground: DemGround,
    test: HopTest,
    ends: [MapPoint; 2],
}

fn steps(angle_deg: Option<f64>, speed_m_s: Option<f64>, heading_deg: Option<f64>) -> CommandSteps {
    let [takeoff_angle, heading] = [angle_deg, heading_deg].map(|step| step.map(Angle::from_degrees));
    CommandSteps { takeoff_angle, takeoff_speed_m_s: speed_m_s, heading }
}

/// Posts every metre from (0, 0) to (40, 40), friction 1.2, under 1.6 m/s^2.
fn journey(height_m: impl FnMut(usize) -> f64, limits: HopperLimits, ends: [MapPoint; 2]) -> Journey {
    let heights = (0..41 * 41).map(height_m).collect();
    let dem = Dem::new(41, 41, heights, GeoReference::local(MapPoint::new(0.0, 40.0), 1.0, 1.0).unwrap()).unwrap();
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.2).unwrap())), rest: RestSlope::AsFrictionHolds };
    let hopper = Hopper::new(limits).unwrap();
    let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(1.6).unwrap(), &surface);
    let test = HopTest::new(ground.chain(ends[0], ends[1]).unwrap());
    Journey { ground, test, ends }
}

/// A point at a distance from (20, 10) along a heading.
fn away(heading_deg: f64, distance_m: f64) -> MapPoint {
    let (east, north) = heading_deg.to_radians().sin_cos();
    MapPoint::new(20.0 + distance_m * east, 10.0 + distance_m * north)
}

impl Journey {
    fn legs(&self) -> Option<Vec<Leg>> {
        let geometry = self.test.chain().geometry();
        let (first_m, last_m) = geometry.extent_m();
        let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(0)), ..SearchOptions::default() };
        let ends = [first_m, last_m].map(|x_m| geometry.station(x_m).unwrap());
        match search(&self.test, ends[0], ends[1], &options, &()).unwrap().outcome {
            Outcome::Path { legs, .. } => Some(legs),
            Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) => None,
        }
    }

    fn flown(&self, legs: &[Leg]) -> Result<HopPath, PathError> {
        generate_over(&self.test, Some(&self.ground), legs, TakeoffChoice::LeastSpeed, Split::Equal)
    }

    /// The violations of a path from the start, flown again over the DEM.
    fn violations(&self, path: &HopPath) -> Vec<ViolatedLimit> {
        let start = self.ground.position(self.ends[0]);
        let end = path.hops.last().unwrap().landing.point_m;
        let end = MapPosition { at: end.xy(), z_m: end.z };
        let execution = execute(&self.ground, path, start.map(|start| (start, end)));
        execution.violations.into_iter().map(|violation| violation.limit).collect()
    }
}

#[test]
fn landings_on_level_ground_are_those_of_the_range_equation() {
    // Heading, step, and the heading flown.
    for (heading_deg, step_deg, flown_deg) in
        [(7.0, 5.0, 5.0), (8.0, 5.0, 10.0), (359.0, 7.0, 0.0), (358.0, 7.0, 357.0), (180.8, 2.0, 180.0), (93.0, 10.0, 90.0)]
    {
        let limits = HopperLimits { steps: steps(None, None, Some(step_deg)), ..HopperLimits::with_speeds(5.0, 5.0) };
        let length_m = if (90.0..270.0).contains(&heading_deg) { 9.0 } else { 12.0 };
        let journey = journey(|_| 3.0, limits, [away(0.0, 0.0), away(heading_deg, length_m)]);
        let path = journey.flown(&journey.legs().unwrap()).unwrap();
        let [hop] = path.hops[..] else { panic!("{heading_deg}: {} hops", path.hops.len()) };
        let off = (flown_deg - heading_deg).to_radians();
        // The nearest point of the heading; 45 degrees over level ground, so v = sqrt(g R).
        let run_m = length_m * off.cos();
        let landing = away(flown_deg, run_m);
        assert_eq!(hop.heading_deg, flown_deg);
        assert!((hop.landing.point_m.xy() - landing).norm() < 1e-9, "{hop:?}");
        assert!((hop.takeoff_speed_m_s - (1.6 * run_m).sqrt()).abs() < 1e-9, "{hop:?}");
        assert!((hop.run_m() - run_m).abs() < 1e-9 && (path.totals.ground_distance_m - run_m).abs() < 1e-9);
        // On the line: short of the goal by R (1 - cos^2), and to the left of it where the heading flown is the smaller one.
        let aim = hop.aim.unwrap();
        let (short_m, left_m) = (run_m * off.cos() - length_m, -run_m * off.sin());
        assert!((aim.miss_m - short_m).abs() < 1e-9 && (aim.across_m.unwrap() - left_m).abs() < 1e-9, "{aim:?} {short_m} {left_m}");
        assert!((hop.landing.along_m - run_m * off.cos()).abs() < 1e-9 && hop.is_beside_line());
        assert!((aim.distance_m() - length_m * off.sin().abs()).abs() < 1e-9);
        assert_eq!(journey.violations(&path), []);
    }
}

#[test]
fn machines_with_the_heading_keep_their_hops() {
    let draw = &mut Draw::seeded(1501);
    for (heading_deg, step) in [(45.0, Some(15.0)), (0.0, Some(7.0)), (33.3, None)] {
        for (angle, speed) in [(None, None), (Some(2.0), Some(0.1))] {
            let limits = HopperLimits { steps: steps(angle, speed, step), ..HopperLimits::with_speeds(5.0, 5.5) };
            let journey = journey(|_| draw.uniform(0.0, 0.3), limits, [away(0.0, 0.0), away(heading_deg, 20.0)]);
            let Some(legs) = journey.legs() else { continue };
            let along = generate(&journey.test, &legs, TakeoffChoice::LeastSpeed, Split::Equal);
            assert_eq!(journey.flown(&legs), along);
            assert!(along.unwrap().hops.iter().all(|hop| !hop.is_beside_line()));
        }
    }
}

#[test]
fn without_the_dem_the_line_alone_is_known() {
    let limits = HopperLimits { steps: steps(None, None, Some(5.0)), ..HopperLimits::with_speeds(5.0, 5.0) };
    let journey = journey(|_| 0.0, limits, [away(0.0, 0.0), away(7.0, 12.0)]);
    let error = generate(&journey.test, &journey.legs().unwrap(), TakeoffChoice::LeastSpeed, Split::Equal).unwrap_err();
    assert!(
        matches!(&error, PathError::NoCommand(NoCommand::Heading { hop: 1, nearest_deg, .. }) if nearest_deg == "5"),
        "{error}"
    );
}

/// A path spoiled in one number, and what the checker has to name.
type Spoiled = (&'static str, fn(&mut Hop), fn(&ViolatedLimit) -> bool);

const SPOILED: [Spoiled; 5] = [
    ("heading", |hop| hop.heading_deg += 0.01, |limit| *limit == ViolatedLimit::Limit(Limit::HeadingStep)),
    (
        "speed",
        |hop| hop.takeoff_speed_m_s *= 1.01,
        |limit| matches!(limit, ViolatedLimit::LandingPoint | ViolatedLimit::Limit(Limit::TakeoffSpeedStep | Limit::TakeoffSpeed)),
    ),
    (
        "landing",
        |hop| hop.landing.point_m.x += 0.01,
        |limit| {
            matches!(
                limit,
                ViolatedLimit::StatedValue(StatedValue::Heading | StatedValue::LandingStation) | ViolatedLimit::LandingPoint
            )
        },
    ),
    ("take-off", |hop| hop.takeoff.point_m.y += 0.01, |limit| *limit == ViolatedLimit::Continuity),
    (
        "next heading",
        |hop| hop.heading_deg = (hop.heading_deg + 30.0) % 360.0,
        |limit| *limit == ViolatedLimit::StatedValue(StatedValue::Heading),
    ),
];

#[test]
fn random_paths_beside_the_line_pass_the_checker_and_spoiled_ones_do_not() {
    let draw = &mut Draw::seeded(1502);
    let (mut flown, mut refused, mut missed_m) = (0, 0, 0.0_f64);
    for _ in 0..160 {
        let step = draw.log_uniform(1.0, 30.0);
        let angle = draw.chance(0.5).then(|| draw.log_uniform(0.5, 5.0));
        let speed = draw.chance(0.5).then(|| draw.log_uniform(0.02, 0.3));
        let max_m_s = draw.uniform(3.0, 6.0);
        let limits = HopperLimits {
            steps: steps(angle, speed, Some(step)),
            clearance_m: if draw.chance(0.5) { 0.1 } else { 0.0 },
            footprint_m: draw.chance(0.3).then_some(0.5),
            ..HopperLimits::with_speeds(max_m_s, 1.2 * max_m_s)
        };
        let rough_m = draw.uniform(0.0, 0.5);
        let ends = [away(draw.uniform(0.0, 360.0), 3.0), away(draw.uniform(0.0, 360.0), 9.0)];
        let journey = journey(|_| draw.uniform(0.0, rough_m), limits, ends);
        let Some(legs) = journey.legs() else { continue };
        let path = match journey.flown(&legs) {
            Ok(path) => path,
            Err(PathError::NoCommand(NoCommand::Refused { .. })) => {
                refused += 1;
                continue;
            }
            Err(error) => panic!("{error}"),
        };
        if !path.hops[0].is_beside_line() {
            continue;
        }
        flown += 1;
        assert_eq!(journey.violations(&path), [], "{:?}", journey.ends);
        for (i, hop) in path.hops.iter().enumerate() {
            assert!((0.0..360.0).contains(&hop.heading_deg) && is_multiple(hop.heading_deg, step), "{hop:?}");
            assert!(angle.is_none_or(|step| is_multiple(hop.takeoff_angle.degrees(), step)), "{hop:?}");
            assert!(speed.is_none_or(|step| is_multiple(hop.takeoff_speed_m_s, step)), "{hop:?}");
            assert!(i == 0 || path.hops[i - 1].landing == hop.takeoff, "a hop starts where the one before landed");
            missed_m = missed_m.max(hop.aim.unwrap().across_m.unwrap().abs());
        }
        for (name, spoil, names) in SPOILED {
            let mut spoiled = path.clone();
            spoil(spoiled.hops.last_mut().unwrap());
            let found = journey.violations(&spoiled);
            assert!(found.iter().any(names), "{name}: {found:?}");
        }
    }
    assert!(flown > 40 && refused < flown && missed_m > 0.5, "{flown} flown, {refused} refused, {missed_m} m aside");
}

/// Whether any command in steps flies from a start to within a quarter of the journey of its goal, by the windows of the slice under
/// every single flight.
fn any_command(journey: &Journey, angle_deg: f64, speed_m_s: f64, heading_deg: f64) -> bool {
    let [start, goal] = journey.ends.map(|at| journey.ground.position(at).unwrap());
    let (run_m, _) = journey.ground.course(&start, &goal).unwrap();
    let max_m_s = journey.ground.hopper().limits().takeoff_speed_max_m_s;
    let count = |most: f64, step: f64| (0..).map(f64::from).map(move |i| i * step).take_while(move |value| *value < most);
    let commands = count(360.0, heading_deg).flat_map(|heading| {
        count(90.0, angle_deg)
            .flat_map(move |angle| count(max_m_s + speed_m_s, speed_m_s).map(move |speed| (heading, angle, speed)))
    });
    commands.into_iter().filter(|(_, _, speed)| *speed > 0.0 && *speed <= tolerant_speed_m_s(max_m_s)).any(
        |(heading, angle, speed)| {
            let (east, north) = heading.to_radians().sin_cos();
            let (up, across) = angle.to_radians().sin_cos();
            let liftoff =
                LiftoffVelocity { heading: Vector2::new(east, north), horizontal_m_s: speed * across, vertical_m_s: speed * up };
            let flight = journey.ground.first_contact(&start, &liftoff, &goal);
            let Some(landing) = flight.support_facet.and_then(|_| journey.ground.position(flight.end.at)) else { return false };
            if (landing.at - goal.at).norm() > 0.25 * run_m {
                return false;
            }
            let Some(windows) = journey.ground.windows(&start, &landing) else { return false };
            let loft = angle.to_radians().tan() - windows.sight.slope();
            // The arc of this angle through the landing has the speed of the command, since it lands there.
            windows.lofts.iter().any(|lofts| lofts.lower <= loft && loft <= lofts.upper)
        },
    )
}

#[test]
fn a_single_hop_is_refused_only_where_no_command_flies_it() {
    let draw = &mut Draw::seeded(1503);
    let (mut refused, mut flown) = (0, 0);
    for _ in 0..400 {
        let (angle, speed, heading) = (draw.uniform(8.0, 20.0), draw.uniform(0.4, 1.2), draw.uniform(20.0, 60.0));
        let limits = HopperLimits {
            steps: steps(Some(angle), Some(speed), Some(heading)),
            clearance_m: 0.1,
            ..HopperLimits::with_speeds(5.0, 5.5)
        };
        let rough_m = draw.uniform(0.0, 1.2);
        let ends = [away(0.0, 0.0), away(draw.uniform(0.0, 360.0), draw.uniform(3.0, 9.0))];
        let journey = journey(|_| draw.uniform(0.0, rough_m), limits, ends);
        let Some(legs) = journey.legs().filter(|legs| legs.len() == 1) else { continue };
        match journey.flown(&legs) {
            Ok(_) => {
                flown += 1;
                assert!(any_command(&journey, angle, speed, heading), "a hop of the machine: {:?}", journey.ends);
            }
            Err(PathError::NoCommand(NoCommand::Refused { hops: 1, .. })) => {
                refused += 1;
                assert!(!any_command(&journey, angle, speed, heading), "{:?}, steps {angle} {speed} {heading}", journey.ends);
            }
            Err(_) => {}
        }
    }
    assert!(refused > 20 && flown > 20, "{refused} refused, {flown} flown");
}

#[test]
fn trials_without_errors_fly_the_commands_of_the_plan() {
    let limits = HopperLimits { steps: steps(Some(2.0), Some(0.1), Some(15.0)), ..HopperLimits::with_speeds(4.5, 5.0) };
    let draw = &mut Draw::seeded(1504);
    let journey = journey(|_| draw.uniform(0.0, 0.2), limits, [away(7.0, 0.0), away(7.0, 25.0)]);
    let path = journey.flown(&journey.legs().unwrap()).unwrap();
    let chain = journey.test.chain();
    let (first_m, last_m) = chain.geometry().extent_m();
    let [start, goal] = [first_m, last_m].map(|x_m| chain.geometry().station(x_m).unwrap());
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(0)), ..SearchOptions::default() };
    let nodes = NodeSet::new(chain, start, goal, PointSpacing::PerSegment(0)).unwrap();
    let to_go = Arc::new(CostToGo::of(&journey.test, nodes, &options, &()).unwrap());
    let last = path.hops.last().unwrap();
    let miss_m = last.aim.unwrap().distance_m();
    let mission = Mission::over_dem(journey.ground.clone(), path.clone(), chain.contact_point(&start), chain.contact_point(&goal))
        .with_replanning(journey.test.clone(), to_go);
    let simulation = Simulation::new(&mission, Uncertainty::NONE).unwrap();
    for (policy, tolerance_m, expected) in
        [(Policy::OpenLoop, miss_m + 1e-9, 5), (Policy::OpenLoop, miss_m - 1e-6, 0), (Policy::Replan, 1.5, 5)]
    {
        let options = TrialOptions { trials: 5, goal_tolerance_m: tolerance_m, policy, trajectories: 1, ..TrialOptions::default() };
        let summary = simulation.run(&options, &mut (), &()).unwrap();
        assert_eq!(summary.outcomes.of(TrialOutcome::Reached), expected, "{policy:?} {tolerance_m}: {:?}", summary.outcomes);
        for hop in &summary.trajectories[0].hops {
            let heading_deg = hop.heading.x.atan2(hop.heading.y).to_degrees();
            assert!(is_multiple(heading_deg, 15.0) || (heading_deg / 15.0).fract().abs() < 1e-9, "{policy:?}: {heading_deg}");
            assert!(
                is_multiple(hop.takeoff_angle().degrees(), 2.0) && is_multiple(hop.takeoff_speed_m_s(), 0.1),
                "{policy:?}: {hop:?}"
            );
        }
    }
}

#[test]
fn arcs_beside_the_line_end_where_they_land() {
    let limits = HopperLimits { steps: steps(None, None, Some(25.0)), ..HopperLimits::with_speeds(5.0, 5.0) };
    let journey = journey(|_| 0.0, limits, [away(0.0, 0.0), away(12.0, 12.0)]);
    let path = journey.flown(&journey.legs().unwrap()).unwrap();
    for hop in &path.hops {
        let points = hop.flight_points(1.6, 5);
        let (first, last) = (points[0].1, points[4].1);
        assert!((first.x_m - hop.takeoff.along_m).abs() < 1e-12 && (last.x_m - hop.landing.along_m).abs() < 1e-9, "{points:?}");
        // As high as the arc is in its own plane.
        let arc = Flight::new(LineOfSight::new(hop.run_m(), 0.0), hop.takeoff_angle.slope(), 1.6);
        assert!((points[2].1.z_m - arc.apex_height_m()).abs() < 1e-9, "{points:?}");
    }
}
