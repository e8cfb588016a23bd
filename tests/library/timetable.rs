//! A path in time: its instants, its energy, and its agreement with the checker that flies the path again.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its input should stop")]

use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, PolygonalChain},
    graph::{Outcome, PointSpacing, SearchOptions, search},
    hop::{HopTest, Split},
    path::{HopPath, Phase, TimedState, Timetable, TimetableError, execute, generate},
    quantity::{ChainPoint, MapPoint},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

use crate::{
    execute::world::{Dice, World},
    support::Draw,
};

/// Instants nearer than this share of a step are one.
const SAME: f64 = 1e-9;

/// Checks the states of a path against its hops, the energy of every flight, and the checker's own flights.
fn check(path: &HopPath, hopper: &HopperLimits, gravity_m_s2: f64, step_s: Option<f64>) -> usize {
    let table = Timetable::new(path, hopper, gravity_m_s2, step_s).unwrap();
    let states: Vec<TimedState> = table.states().collect();
    let (step_s, end_s) = (table.step_s(), table.duration_s());
    let mission_s = path.totals.mission_time_s.unwrap_or(path.totals.flight_time_s);
    assert!((end_s - mission_s).abs() <= 1e-12 * mission_s, "{end_s}, the totals say {mission_s}");
    assert!(states.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s));
    // Every multiple of the step is there, once, or is a take-off or a landing.
    let mut next = 0;
    for i in 0_u32.. {
        let time_s = f64::from(i) * step_s;
        if time_s > end_s {
            break;
        }
        while next < states.len() && states[next].time_s < time_s - SAME * step_s {
            next += 1;
        }
        assert!(next < states.len() && states[next].time_s <= time_s + SAME * step_s, "{time_s} s is missing");
    }
    let mut begin_s = 0.0;
    for (i, hop) in path.hops.iter().enumerate() {
        let own: Vec<_> = states.iter().filter(|state| state.hop == i + 1).collect();
        let flight: Vec<_> = own.iter().filter(|state| state.phase == Phase::Flight).collect();
        let (first, last) = (flight[0], flight[flight.len() - 1]);
        // Both ends are exact: where, how fast, and when.
        assert_eq!((first.x_m, first.z_m, first.map), (hop.takeoff.along_m, hop.takeoff.point_m.z, hop.takeoff.map()));
        assert_eq!((last.x_m, last.z_m, last.map), (hop.landing.along_m, hop.landing.point_m.z, hop.landing.map()));
        let near = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-9 * size;
        assert!(near(first.time_s, begin_s, end_s) && near(last.time_s, begin_s + hop.flight_time_s, end_s), "{hop:?}");
        let size_m = hop.run_m() + (hop.apex_z_m - hop.takeoff.point_m.z);
        let digits = (hop.takeoff.along_m.abs() + hop.takeoff.point_m.z.abs()) * f64::EPSILON / hop.run_m();
        if digits < 1e-10 && hop.takeoff_angle.slope().abs() < 1e3 {
            let speed = |state: &TimedState| state.vx_m_s.hypot(state.vz_m_s);
            let fast = hop.takeoff_speed_m_s.max(hop.landing_speed_m_s);
            assert!(near(speed(first), hop.takeoff_speed_m_s, 1e3 * fast), "{first:?} {hop:?}");
            assert!(near(speed(last), hop.landing_speed_m_s, 1e3 * fast), "{last:?} {hop:?}");
            let energy = |state: &TimedState| 0.5 * speed(state).powi(2) + gravity_m_s2 * (state.z_m - hop.takeoff.point_m.z);
            for state in &flight {
                assert!(near(energy(state), energy(first), 1e3 * fast * fast), "{state:?} {hop:?}");
                let share = (state.time_s - first.time_s) / hop.flight_time_s;
                let along_m = hop.takeoff.along_m + (hop.landing.along_m - hop.takeoff.along_m) * share;
                assert!(near(state.x_m, along_m, 1e3 * size_m), "equal times, equal distances: {state:?} {hop:?}");
                assert!(state.z_m <= hop.apex_z_m + 1e-6 * size_m, "{state:?} {hop:?}");
                if let Some(velocity) = state.map_velocity_m_s {
                    let heading = hop.heading_deg.to_radians();
                    let off = velocity - nalgebra::Vector2::new(heading.sin(), heading.cos()) * state.vx_m_s.abs();
                    assert!(off.norm() <= 1e-6 * fast, "{state:?} {hop:?}");
                }
            }
        }
        for state in own.iter().filter(|state| state.phase == Phase::Rest) {
            assert_eq!((state.x_m, state.vx_m_s, state.vz_m_s), (hop.landing.along_m, 0.0, 0.0));
            assert!(state.time_s > last.time_s, "{state:?}");
        }
        let rest_s = hopper.rest_time_s.filter(|_| i + 1 < path.hops.len()).unwrap_or(0.0);
        begin_s += hop.flight_time_s + rest_s;
    }
    states.len()
}

#[test]
fn paths_of_random_worlds_in_time_conserve_energy_and_end_where_they_should() {
    let mut dice = Dice::new(4_171);
    let (mut paths, mut rows) = (0, 0);
    for number in 0..3000 {
        let world = World::random(&mut dice);
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain);
        let Some(path) = world.plan(&test).filter(|path| !path.hops.is_empty()) else { continue };
        let shortest_s = path.hops.iter().map(|hop| hop.flight_time_s).fold(f64::INFINITY, f64::min);
        let longest_s = path.hops.iter().map(|hop| hop.flight_time_s).fold(0.0, f64::max);
        let rest_time_s = [None, Some(0.0), Some(0.3 * longest_s), Some(3.0 * longest_s)][number % 4];
        let hopper = HopperLimits { rest_time_s, ..*test.hopper().limits() };
        let path = HopPath::of_hops(path.hops, &Hopper::new(hopper).unwrap());
        let step_s = [None, Some(longest_s / 7.0), Some(shortest_s), Some(1e3 * longest_s)][number / 4 % 4];
        if step_s.is_some_and(|step_s| path.totals.mission_time_s.unwrap_or(path.totals.flight_time_s) / step_s > 1e5) {
            continue;
        }
        rows += check(&path, &hopper, world.gravity_m_s2, step_s);
        paths += 1;
    }
    assert!(paths > 500 && rows > 20_000, "{paths} paths, {rows} rows");
}

/// A path over 40 m of flat ground under 1 m/s^2: 45 degrees and at most 5 m/s, so 25 m a hop.
fn flat(rest_time_s: Option<f64>) -> (HopPath, HopTest) {
    let vertices = vec![ChainPoint::new(0.0, 7.0), ChainPoint::new(40.0, 7.0)];
    let hopper = Hopper::new(HopperLimits { rest_time_s, ..HopperLimits::with_speeds(5.0, 5.0) }).unwrap();
    let map = vec![MapPoint::new(100.0, 200.0), MapPoint::new(100.0, 240.0)];
    let geometry = PolygonalChain::new(vertices, vec![chta::chain::SegmentGround::BARE], Some(map)).unwrap();
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.0).unwrap())), rest: RestSlope::AsFrictionHolds };
    let test = HopTest::new(ConstrainedChain::new(geometry, &hopper, Gravity::new(1.0).unwrap(), &surface).unwrap());
    let [start, goal] = [0.0, 40.0].map(|x_m| test.chain().geometry().station(x_m).unwrap());
    let options = SearchOptions { spacing: Some(PointSpacing::AtMostM(20.0)), ..SearchOptions::default() };
    let Outcome::Path { legs, .. } = search(&test, start, goal, &options, &()).unwrap().outcome else { panic!("no path") };
    (generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::Equal).unwrap(), test)
}

/// Two hops of 20 m: v = sqrt(20) m/s at 45 degrees, so sqrt(40) s of flight, 5 m up, and sqrt(10) m/s across.
#[test]
fn a_path_known_by_hand_has_its_instants_its_apex_and_its_speeds() {
    let flight_s = 40f64.sqrt();
    for (rest_time_s, pause_s) in [(None, 0.0), (Some(0.0), 0.0), (Some(2.0), 2.0)] {
        let (path, test) = flat(rest_time_s);
        assert_eq!(path.hops.len(), 2);
        let table = Timetable::new(&path, test.hopper().limits(), 1.0, Some(flight_s / 4.0)).unwrap();
        let states: Vec<_> = table.states().collect();
        let flying = |hop: usize| states.iter().filter(move |s| s.hop == hop && s.phase == Phase::Flight).collect::<Vec<_>>();
        // With a step of a quarter of the flight the apex of the first hop is an instant.
        let first = flying(1);
        let times: Vec<f64> = first.iter().map(|state| state.time_s / flight_s).collect();
        assert_eq!(times.len(), 5, "no instant twice: {times:?}");
        let apex = first[2];
        for (what, found, hand) in [
            ("apex", apex.z_m, 12.0),
            ("its x", apex.x_m, 10.0),
            ("its map y", apex.map.unwrap().y, 210.0),
            ("its climb", apex.vz_m_s, 0.0),
            ("across", apex.vx_m_s, 10f64.sqrt()),
            ("north", apex.map_velocity_m_s.unwrap().y, 10f64.sqrt()),
            ("climb at take-off", first[0].vz_m_s, 10f64.sqrt()),
            ("climb at landing", first[4].vz_m_s, -(10f64.sqrt())),
            ("take-off of the second hop", flying(2)[0].time_s, flight_s + pause_s),
            ("landing", states.last().unwrap().time_s, 2.0 * flight_s + pause_s),
        ] {
            assert!((found - hand).abs() < 1e-12, "{what}: {found}, by hand {hand}");
        }
        let rests = states.iter().filter(|state| state.phase == Phase::Rest).count();
        assert_eq!(rests, usize::from(pause_s > flight_s / 4.0), "one multiple of the step within 2 s");
        // The checker flies the same apex, landing and speed from the command alone.
        let execution = execute(test.chain(), &path, None);
        for (number, flown) in execution.flights.iter().enumerate() {
            let flown = flown.as_ref().unwrap();
            let last = *flying(number + 1).last().unwrap();
            assert!((flown.apex_z_m - 12.0).abs() < 1e-9 && (flown.contact.unwrap().x_m - last.x_m).abs() < 1e-9);
            assert!((flown.landing_speed_m_s - last.vx_m_s.hypot(last.vz_m_s)).abs() < 1e-9);
            assert!((flown.flight_time_s - (last.time_s - flying(number + 1)[0].time_s)).abs() < 1e-9);
        }
        check(&path, test.hopper().limits(), 1.0, Some(flight_s / 4.0));
    }
}

#[test]
fn steps_that_are_none_and_steps_with_too_many_rows_are_refused() {
    let (path, test) = flat(Some(3600.0));
    let table = |step_s: f64| Timetable::new(&path, test.hopper().limits(), 1.0, Some(step_s));
    for step_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(table(step_s), Err(TimetableError::Step { .. })), "{step_s}");
    }
    let refused = table(1e-9).unwrap_err();
    let TimetableError::TooMany { least_step_s, .. } = refused else { panic!("{refused}") };
    assert!(table(0.99 * least_step_s).is_err());
    assert!(table(least_step_s).unwrap().states().count() <= 1_000_005);
    let said = refused.to_string();
    assert!(said.contains("expected at most 1000000") && said.contains("e12 rows") && said.contains("GB"), "{said}");
    // Without a step a long rest does not make the table long.
    assert!(Timetable::new(&path, test.hopper().limits(), 1.0, None).unwrap().states().count() < 100_010);
    let none = HopPath::of_hops(Vec::new(), test.hopper());
    assert_eq!(Timetable::new(&none, test.hopper().limits(), 1.0, None).unwrap().states().count(), 0);
    assert_eq!(Timetable::new(&none, test.hopper().limits(), 1.0, Some(0.1)).unwrap().states().count(), 0);
}

/// Steps that divide the flight almost, exactly and not at all never give an instant twice.
#[test]
fn no_step_gives_an_instant_twice() {
    let (path, test) = flat(Some(1.0));
    let mut draw = Draw::seeded(8);
    for number in 0..400 {
        let parts = f64::from(u32::try_from(1 + draw.below(40)).unwrap());
        let nudge = [0.0, f64::EPSILON, -f64::EPSILON, 1e-12, -1e-12, 1e-7, -1e-7, draw.unit()][number % 8];
        let step_s = path.hops[0].flight_time_s / parts * (1.0 + nudge);
        let table = Timetable::new(&path, test.hopper().limits(), 1.0, Some(step_s)).unwrap();
        let times: Vec<f64> = table.states().map(|state| state.time_s).collect();
        assert!(times.windows(2).all(|pair| pair[1] - pair[0] > 1e-10 * step_s), "{step_s}: {times:?}");
        check(&path, test.hopper().limits(), 1.0, Some(step_s));
    }
}
