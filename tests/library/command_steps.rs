//! Commands in steps: every command is a multiple of its step, every hop keeps all limits where it really lands, and the misses are
//! those of a simulated flight.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, PolygonalChain, Station},
    graph::{Outcome, PointSpacing, SearchOptions, search},
    hop::{HopTest, Split},
    path::{Hop, HopPath, NoCommand, PathError, ViolatedLimit, execute, generate},
    quantity::{Angle, ChainPoint},
    world::{
        CommandSteps, FrictionCone, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties, is_multiple,
        tolerant_speed_m_s,
    },
};

use crate::support::Draw;

fn steps(angle_deg: Option<f64>, speed_m_s: Option<f64>) -> CommandSteps {
    CommandSteps { takeoff_angle: angle_deg.map(Angle::from_degrees), takeoff_speed_m_s: speed_m_s, heading: None }
}

/// A hop test over points, friction 1.2, with a machine of these speeds and steps.
fn over(points: Vec<ChainPoint>, g: f64, speed_m_s: f64, clearance_m: f64, steps: CommandSteps) -> HopTest {
    let limits = HopperLimits { clearance_m, steps, ..HopperLimits::with_speeds(speed_m_s, 1.1 * speed_m_s) };
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.2).unwrap())), rest: RestSlope::AsFrictionHolds };
    let chain = PolygonalChain::bare(points).unwrap();
    HopTest::new(ConstrainedChain::new(chain, &Hopper::new(limits).unwrap(), Gravity::new(g).unwrap(), &surface).unwrap())
}

fn planned(test: &HopTest, ends: (Station, Station), choice: TakeoffChoice, split: Split) -> Option<Result<HopPath, PathError>> {
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(2)), takeoff: choice, split, ..SearchOptions::default() };
    match search(test, ends.0, ends.1, &options, &()).unwrap().outcome {
        Outcome::Path { legs, .. } => Some(generate(test, &legs, choice, split)),
        Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) => None,
    }
}

fn ends(test: &HopTest) -> (Station, Station) {
    let geometry = test.chain().geometry();
    let (first_m, last_m) = geometry.extent_m();
    (geometry.station(first_m).unwrap(), geometry.station(last_m).unwrap())
}

#[test]
fn random_paths_have_commands_in_steps_that_the_checker_accepts() {
    let draw = &mut Draw::seeded(1402);
    let (mut flown, mut refused, mut missed) = (0, 0, 0);
    for _ in 0..300 {
        let (g, size_m) = (draw.gravity(), draw.log_uniform(1.0, 100.0));
        let segments = 2 + draw.below(12);
        let points: Vec<ChainPoint> = (0..=segments)
            .map(|i| ChainPoint::new(f64::from(u32::try_from(i).unwrap()) * size_m, draw.uniform(-0.15, 0.15) * size_m))
            .collect();
        let speed = (g * size_m * draw.log_uniform(0.7, 6.0)).sqrt();
        let angle = draw.chance(0.6).then(|| draw.log_uniform(0.05, 5.0));
        let step = draw.chance(0.6).then(|| speed * draw.log_uniform(1e-3, 0.05));
        let clearance_m = if draw.chance(0.5) { 0.0 } else { 0.02 * size_m };
        let test = over(points, g, speed, clearance_m, steps(angle, step));
        let choice = TakeoffChoice::ALL[draw.below(3)];
        let split = if draw.chance(0.5) { Split::Equal } else { Split::FullReach };
        let Some(path) = planned(&test, ends(&test), choice, split) else { continue };
        let path = match path {
            Ok(path) => path,
            Err(PathError::NoCommand(_)) => {
                refused += 1;
                continue;
            }
            Err(error) => panic!("{error}"),
        };
        flown += 1;
        let execution = execute(test.chain(), &path, None);
        assert!(execution.passes(), "{:?}", execution.violations);
        for (i, hop) in path.hops.iter().enumerate() {
            assert!(angle.is_none_or(|step| is_multiple(hop.takeoff_angle.degrees(), step)), "{hop:?}");
            assert!(step.is_none_or(|step| is_multiple(hop.takeoff_speed_m_s, step)), "{hop:?}");
            assert!(hop.takeoff_speed_m_s <= tolerant_speed_m_s(speed));
            assert!(i == 0 || path.hops[i - 1].landing == hop.takeoff, "a hop starts where the one before landed");
            // The flight, by its own equation: the landing it states lies on it.
            let (vx, vz) = (
                hop.takeoff_speed_m_s * hop.takeoff_angle.radians().cos(),
                hop.takeoff_speed_m_s * hop.takeoff_angle.radians().sin(),
            );
            let t = hop.run_m() / vx;
            let z_m = hop.takeoff.point_m.z + vz * t - 0.5 * g * t * t;
            assert!((z_m - hop.landing.point_m.z).abs() < 1e-8 * size_m, "{z_m} and {:?}", hop.landing);
            match hop.aim {
                Some(aim) => {
                    let found = hop.direction.sign() * (hop.landing.along_m - aim.point.along_m);
                    assert_eq!(aim.miss_m, found);
                    missed += usize::from(aim.miss_m.abs() > 1e-6 * size_m);
                }
                None => assert!(angle.is_none() && step.is_none(), "a command in steps states its aim"),
            }
        }
    }
    assert!(flown > 100 && missed > 50 && refused < flown / 2, "{flown} flown, {missed} missed, {refused} refused");
}

#[test]
fn a_step_of_the_speed_alone_misses_nothing() {
    // Flat, 20 m, g = 1.6: the angle makes up for the speed.
    let points = vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(20.0, 0.0)];
    let test = over(points, 1.6, 7.0, 0.0, steps(None, Some(0.5)));
    let path = planned(&test, ends(&test), TakeoffChoice::LeastSpeed, Split::FullReach).unwrap().unwrap();
    assert_eq!(path.hops.len(), 1);
    // sqrt(32) = 5.657 m/s at 45 degrees; the nearest command that reaches it is 6 m/s, at 31.4 or 58.6 degrees.
    let hop = &path.hops[0];
    assert_eq!(hop.takeoff_speed_m_s, 6.0);
    let sine = (2.0 * hop.takeoff_angle.radians()).sin();
    assert!((sine - 32.0 / 36.0).abs() < 1e-12 && hop.aim.unwrap().miss_m.abs() < 1e-9, "{hop:?}");
}

#[test]
fn a_step_of_both_misses_by_what_the_range_equation_gives() {
    let points = vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(40.0, 0.0)];
    let test = over(points, 1.6, 7.0, 0.0, steps(Some(10.0), Some(0.5)));
    let geometry = test.chain().geometry();
    let pair = (geometry.station(0.0).unwrap(), geometry.station(20.0).unwrap());
    let path = planned(&test, pair, TakeoffChoice::LeastSpeed, Split::FullReach).unwrap().unwrap();
    let hop = &path.hops[0];
    // 45 degrees lies between 40 and 50, both need 5.700 m/s, nearest 5.5: R = v^2 sin(2 theta) / g.
    let range_m = 5.5 * 5.5 * 80f64.to_radians().sin() / 1.6;
    assert_eq!(hop.takeoff_speed_m_s, 5.5);
    assert!((hop.landing.along_m - range_m).abs() < 1e-9 && (hop.aim.unwrap().miss_m - (range_m - 20.0)).abs() < 1e-9, "{hop:?}");
}

#[test]
fn spoiled_commands_are_named() {
    let points = vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(40.0, 0.0)];
    let test = over(points, 1.6, 7.0, 0.0, steps(Some(10.0), Some(0.5)));
    let path = planned(&test, ends(&test), TakeoffChoice::LeastSpeed, Split::Equal).unwrap().unwrap();
    assert!(execute(test.chain(), &path, None).passes());
    for (limit, spoil) in [
        (
            Limit::TakeoffAngleStep,
            (|hop: &mut Hop| hop.takeoff_angle = Angle::from_degrees(hop.takeoff_angle.degrees() + 1e-6)) as fn(&mut Hop),
        ),
        (Limit::TakeoffSpeedStep, |hop: &mut Hop| hop.takeoff_speed_m_s *= 1.0 + 1e-7),
    ] {
        let mut spoiled = path.clone();
        let hop = &mut spoiled.hops[0];
        spoil(hop);
        let violations = execute(test.chain(), &spoiled, None).violations;
        assert!(violations.iter().any(|violation| violation.limit == ViolatedLimit::Limit(limit)), "{limit}: {violations:?}");
    }
}

#[test]
fn too_coarse_a_step_is_refused_with_the_hop_and_the_limit() {
    let points = vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(60.0, 0.0)];
    // 7 m/s reaches 30.6 m at 45 degrees; at 90 or 0 degrees nothing.
    let test = over(points, 1.6, 7.0, 0.0, steps(Some(90.0), None));
    let error = planned(&test, ends(&test), TakeoffChoice::LeastSpeed, Split::Equal).unwrap().unwrap_err();
    assert!(matches!(error, PathError::NoCommand(NoCommand::Refused { hop: 1, .. })), "{error}");
}

#[test]
fn the_greatest_speed_is_the_greatest_command() {
    let points = vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(28.0, 0.0)];
    // 7 m/s would reach 30.6 m in one hop; the greatest command, 6 m/s, reaches 22.5 m.
    let exact = over(points.clone(), 1.6, 7.0, 0.0, CommandSteps::CONTINUOUS);
    let stepped = over(points, 1.6, 7.0, 0.0, steps(None, Some(3.0)));
    let hops =
        |test: &HopTest| planned(test, ends(test), TakeoffChoice::LeastSpeed, Split::Equal).unwrap().map(|path| path.hops.len());
    assert_eq!((hops(&exact), hops(&stepped)), (Ok(1), Ok(2)));
}
