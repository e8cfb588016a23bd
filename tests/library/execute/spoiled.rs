//! Every planned hop, spoiled by 1 % beyond its binding limit: the checker must refuse it and name that limit.

use chta::{
    ballistics::{Arc, LineOfSight, limits::ClearanceProfile},
    chain::{ConstrainedChain, GroundForm, SegmentGround, Station},
    ground::Surface,
    hop::HopTest,
    path::{Execution, Hop, HopPath, ViolatedLimit, execute},
    quantity::{Angle, VertexId},
    world::{Contact, Direction, Limit, RestSlope},
};

use super::{
    with_arc,
    world::{Dice, World},
};

/// The number of spoiled hops, by the limit that must be named.
#[derive(Default)]
struct Tally {
    by_limit: [usize; Limit::ALL.len()],
    landing_points: usize,
    speeds: usize,
    reaches: usize,
    /// Spoiled hops whose 1 % is smaller than rounding or the limit's own tolerance.
    too_fine: usize,
}

/// A world, its plan, and one hop.
struct Case<'a> {
    world: &'a World,
    chain: &'a ConstrainedChain,
    test: &'a HopTest,
    path: &'a HopPath,
    hop: &'a Hop,
}

impl Case<'_> {
    /// Flies one hop alone over a chain.
    fn flown_over(&self, chain: &ConstrainedChain, hop: Hop) -> Execution {
        let path = HopPath { hops: vec![hop], totals: self.path.totals };
        execute(chain, &path, None)
    }

    fn flown(&self, hop: Hop) -> Execution {
        self.flown_over(self.chain, hop)
    }

    /// The stations of both ends.
    fn stations(&self) -> (Station, Station) {
        (self.hop.takeoff.station.unwrap(), self.hop.landing.station.unwrap())
    }

    fn sight(&self) -> LineOfSight {
        let (takeoff, landing) = self.stations();
        self.test.line_of_sight(&takeoff, &landing).unwrap()
    }

    fn run_m(&self) -> f64 {
        self.sight().run_m()
    }

    /// The hop between the same stations with another take-off angle and the speed that still hits the landing.
    fn at_angle(&self, radians: f64) -> Hop {
        let sight = self.sight();
        with_arc(self.hop, &Arc::new(sight, radians.tan() - sight.slope(), self.world.gravity_m_s2))
    }
}

fn names(execution: &Execution, limit: Limit) -> bool {
    execution.violations.iter().any(|v| v.limit == ViolatedLimit::Limit(limit))
}

fn names_vertex(execution: &Execution, vertex: VertexId) -> bool {
    execution.violations.iter().any(|v| v.limit == ViolatedLimit::Limit(Limit::Terrain) && v.vertex == Some(vertex))
}

fn misses(execution: &Execution) -> bool {
    execution.violations.iter().any(|v| v.limit == ViolatedLimit::LandingPoint)
}

/// 1 % beyond an end of the feasible angles: of the angle itself, or, if that is very small or would leave the possible directions,
/// of the distance to the line of sight below or to the vertical above.
fn beyond(end: f64, room: f64) -> f64 {
    let of_angle = 0.01 * end.abs();
    if end.abs() < 0.01 || of_angle >= room { 0.01 * room } else { of_angle }
}

/// Whether an arc flatter than the least angle is lower by less than the rounding of heights where the ground sets that angle: at a
/// vertex, or at a kink of the clearance, next to a contact.
fn is_too_low_to_see(case: &Case<'_>, min: f64, radians: f64) -> bool {
    let run = case.sight().run_m();
    let from = case.hop.takeoff.in_profile();
    let clearance = ClearanceProfile::of(case.world.hopper.limits());
    let d =
        case.hop.lower_vertex.map_or(clearance.kink_m(run), |vertex| (case.world.vertices[vertex.index()].x_m - from.x_m).abs());
    let lower_m = (min.tan() - radians.tan()) * d * (run - d) / run;
    let rounding_m = f64::EPSILON * case.world.vertices.iter().flat_map(|v| [v.x_m.abs(), v.z_m.abs()]).fold(run, f64::max);
    lower_m < 32.0 * rounding_m * (1.0 + min.tan().abs())
}

/// Whether the spoiled arc is over a limit of speed by next to nothing, as where the speed hardly depends on the angle.
fn is_hardly_faster(case: &Case<'_>, limit: Limit, radians: f64) -> bool {
    let contact = match limit {
        Limit::TakeoffSpeed => Contact::Takeoff,
        Limit::LandingSpeed => Contact::Landing,
        _ => return false,
    };
    let hop = case.at_angle(radians);
    let (takeoff, landing) = case.stations();
    let (station, speed_m_s) = match contact {
        Contact::Takeoff => (takeoff, hop.takeoff_speed_m_s),
        Contact::Landing => (landing, hop.landing_speed_m_s),
    };
    let rule = case.chain.check_contact(&station, contact, case.hop.direction).unwrap();
    (1.0..1.0 + 1e-8).contains(&(speed_m_s / rule.speed_max_m_s()))
}

/// Whether the spoiled arc has nearly a speed that the machine has, as where the speed hardly depends on the angle, or by accident.
fn is_nearly_commanded(case: &Case<'_>, limit: Limit, radians: f64) -> bool {
    let (speed_m_s, limits) = (case.at_angle(radians).takeoff_speed_m_s, case.world.hopper.limits());
    let near = |level: f64| (speed_m_s / level - 1.0).abs() < 1e-8;
    match limit {
        Limit::TakeoffSpeedMin => limits.takeoff_speed_min_m_s.is_some_and(near),
        Limit::TakeoffSpeedLevels => limits.takeoff_speed_levels.is_some_and(|levels| levels.as_slice().iter().any(|v| near(*v))),
        _ => false,
    }
}

/// Both ends of the feasible take-off angles.
fn spoil_angles(case: &Case<'_>, tally: &mut Tally) {
    let (min, max) = (case.hop.takeoff_angles.min.radians(), case.hop.takeoff_angles.max.radians());
    let lower_room = min - case.sight().angle().radians();
    let upper_room = std::f64::consts::FRAC_PI_2 - max;
    let ends = [
        (min - beyond(min, lower_room), lower_room, case.hop.lower_limit),
        (max + beyond(max, upper_room), upper_room, case.hop.upper_limit),
    ];
    // Full reach leaves one angle and names one limit for it, which lies on at least one side.
    let one_point = min == max;
    let named_by_any = ends.iter().any(|&(radians, _, limit)| names(&case.flown(case.at_angle(radians)), limit));
    for (i, (radians, room, limit)) in ends.into_iter().enumerate() {
        // Next to the line of sight and the vertical, 1 % of the distance is less than the tolerance of directions, a nanoradian. A
        // speed near its minimum depends on the square of the angle, so its change is less than the tolerance of speeds.
        // A change of angle alone does not violate an apex limit that the landing itself just meets.
        let landing_is_top = one_point && limit == Limit::ApexHeight && case.hop.landing_angle.radians() >= 0.0;
        if room < 1e-5
            || landing_is_top
            || (limit == Limit::Terrain && is_too_low_to_see(case, min, radians))
            || is_hardly_faster(case, limit, radians)
            || is_nearly_commanded(case, limit, radians)
        {
            tally.too_fine += 1;
            continue;
        }
        let execution = case.flown(case.at_angle(radians));
        let named = names(&execution, limit) && (i == 1 || case.hop.lower_vertex.is_none_or(|v| names_vertex(&execution, v)));
        let refused = execution.violations.iter().any(|v| matches!(v.limit, ViolatedLimit::Limit(_)));
        let named = named || (one_point && named_by_any && refused);
        assert!(named, "end {i}: {limit} not named by {:#?}\n{radians} of {:?}\n{:?}", execution.violations, case.hop, case.world);
        assert!(!misses(&execution) || names(&execution, Limit::Terrain), "{:?}", execution.violations);
        tally.by_limit[limit.index()] += usize::from(names(&execution, limit));
    }
}

/// 1 % faster and slower at the same angle.
fn spoil_speed(case: &Case<'_>, tally: &mut Tally) {
    for factor in [1.01, 0.99] {
        let execution = case.flown(Hop { takeoff_speed_m_s: case.hop.takeoff_speed_m_s * factor, ..*case.hop });
        assert!(misses(&execution), "{factor} of the speed hits: {:?}\n{:?}\n{:?}", execution, case.hop, case.world);
        tally.speeds += 1;
        // If the take-off speed is at its limit, that is named too.
        let rule = case.chain.check_contact(&case.stations().0, Contact::Takeoff, case.hop.direction).unwrap();
        if case.hop.takeoff_speed_m_s * factor > rule.speed_max_m_s() * 1.000_001 {
            assert!(names(&execution, Limit::TakeoffSpeed), "{:?}", execution.violations);
        }
    }
}

/// A landing point stated 1 % of the run too far and too near.
fn spoil_landing(case: &Case<'_>, tally: &mut Tally) {
    for share in [0.99, 1.01] {
        let (from_m, to_m) = (case.hop.takeoff.along_m, case.hop.landing.along_m);
        let x_m = from_m + share * (to_m - from_m);
        let Ok(landing) = case.chain.geometry().station(x_m) else { continue };
        let execution = case.flown(Hop { landing: case.chain.contact_point(&landing), ..*case.hop });
        assert!(misses(&execution), "{share} of the run hits: {:?}\n{:?}\n{:?}", execution, case.hop, case.world);
        tally.landing_points += 1;
    }
}

/// A hop 1 % longer than the reach along its segment.
fn spoil_reach(case: &Case<'_>, tally: &mut Tally) {
    let (takeoff, planned) = case.stations();
    let Some(segment) = takeoff.shared_segment(&planned) else { return };
    let Some(reach) = case.test.segment_reach(segment, case.hop.direction) else { return };
    let x_m = takeoff.point.x_m + case.hop.direction.sign() * 1.01 * reach.reach_m();
    let Ok(landing) = case.chain.geometry().station(x_m) else { return };
    if takeoff.shared_segment(&landing) != Some(segment) {
        return;
    }
    if reach.limit() == Limit::TakeoffSpeedMin {
        // The other limits end it: where they leave only slow arcs.
        return;
    }
    let sight = case.test.line_of_sight(&takeoff, &landing).unwrap();
    let arc = Arc::new(sight, reach.loft(), case.world.gravity_m_s2);
    let execution = case.flown(Hop { landing: case.chain.contact_point(&landing), ..with_arc(case.hop, &arc) });
    assert!(names(&execution, reach.limit()), "{} of the reach: {:?}\n{:?}", reach.limit(), execution.violations, case.world);
    tally.by_limit[reach.limit().index()] += 1;
    tally.reaches += 1;
}

/// The same hop if the ground under an end is a keep-out zone, closed for the direction, or 1 % too steep.
fn spoil_ground(case: &Case<'_>, contact: Contact, tally: &mut Tally) {
    let (takeoff, landing) = case.stations();
    let station = if contact == Contact::Takeoff { takeoff } else { landing };
    let segment = station.ruling_segment(contact, case.hop.direction, case.world.grounds.len()).unwrap().index();
    let mut kept_out = case.world.clone();
    kept_out.grounds[segment].keep_out = true;
    let mut closed = case.world.clone();
    let line = case.chain.segments()[segment].stated(case.hop.direction);
    let form = match case.hop.direction {
        Direction::Forward => GroundForm::Explicit { forward: None, reverse: line },
        Direction::Reverse => GroundForm::Explicit { forward: line, reverse: None },
    };
    closed.grounds[segment] = SegmentGround { form, keep_out: false };
    let mut steep = case.world.clone();
    let tilt_rad = tilt_rad(case, segment);
    steep.surface.rest = RestSlope::AtMost(Angle::from_radians(0.99 * tilt_rad));
    for (world, limit) in [(kept_out, Limit::KeepOut), (closed, Limit::Direction), (steep, Limit::RestSlope)] {
        if limit == Limit::RestSlope && tilt_rad < 1e-6 {
            continue;
        }
        let execution = case.flown_over(&world.chain().unwrap(), *case.hop);
        let here = |v: &chta::path::Violation| v.limit == ViolatedLimit::Limit(limit) && v.at_x_m == station.point.x_m;
        assert!(execution.violations.iter().any(here), "{limit}: {:?}", execution.violations);
        tally.by_limit[limit.index()] += 1;
    }
}

/// Inclination of a segment's surface from the normal's components: `n_z = cos(cross-slope) cos(slope)`.
fn tilt_rad(case: &Case<'_>, segment: usize) -> f64 {
    let along = case.chain.geometry().slopes()[segment].atan();
    let across = match case.world.grounds[segment].form {
        GroundForm::Surface { cross_slope, .. } => cross_slope.radians(),
        GroundForm::Explicit { .. } => 0.0,
    };
    // atan2 of the horizontal part keeps digits that acos of n_z loses.
    let (x, y) = (along.sin() * across.cos(), across.sin());
    x.hypot(y).atan2(across.cos() * along.cos())
}

#[test]
fn every_spoiled_hop_is_refused_under_its_limits_name() {
    let mut dice = Dice::new(5_309);
    let mut tally = Tally::default();
    for _ in 0..20_000 {
        let world = World::random(&mut dice);
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain.clone());
        let Some(path) = world.plan(&test) else { continue };
        for hop in path.hops.iter().take(8) {
            let case = Case { world: &world, chain: &chain, test: &test, path: &path, hop };
            // 1 % cannot be resolved on an arc along its line of sight, or on a hop as short as the last digits of its coordinates.
            let loft = hop.takeoff_angle.slope() - case.sight().slope();
            let digits =
                [hop.takeoff, hop.landing].iter().map(|p| p.along_m.abs() + p.point_m.z.abs()).fold(0.0, f64::max) * f64::EPSILON;
            if loft < 1e-6 || digits > 1e-7 * loft.min(1.0) * case.run_m() {
                tally.too_fine += 1;
                continue;
            }
            spoil_angles(&case, &mut tally);
            spoil_speed(&case, &mut tally);
            spoil_landing(&case, &mut tally);
            spoil_reach(&case, &mut tally);
            for contact in [Contact::Takeoff, Contact::Landing] {
                spoil_ground(&case, contact, &mut tally);
            }
        }
    }
    for limit in Limit::ALL {
        println!("{limit:18}{}", tally.by_limit[limit.index()]);
    }
    let Tally { landing_points, speeds, reaches, too_fine, .. } = tally;
    println!("landing points {landing_points}, speeds {speeds}, reaches {reaches}, too fine to tell {too_fine}");
    for limit in Limit::ALL {
        // No finite speed lets an arc come down to its line of sight, so that limit never sets an end. These chains have no bends;
        // for those see tests/library/bends.rs. Nor do these hoppers brake, have a footprint, or take their commands in steps: see
        // braked.rs, footprint.rs and command_steps.rs there.
        let elsewhere = [
            Limit::LineOfSight,
            Limit::Bend,
            Limit::Touchdown,
            Limit::FootprintSlope,
            Limit::Roughness,
            Limit::TakeoffAngleStep,
            Limit::TakeoffSpeedStep,
            Limit::HeadingStep,
            // Of robots with legs: src/path/stances_tests.rs.
            Limit::Stroke,
            Limit::Force,
            Limit::Spin,
        ];
        let least = if elsewhere.contains(&limit) { 0 } else { 300 };
        assert!(tally.by_limit[limit.index()] >= least, "{limit} was tested only {} times", tally.by_limit[limit.index()]);
    }
    assert!(landing_points >= 20_000 && speeds >= 20_000 && reaches >= 5000, "{landing_points}, {speeds}, {reaches}");
    assert!(too_fine * 10 < speeds, "{too_fine} hops were too small to spoil");
}
