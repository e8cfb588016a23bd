//! Hops over meshes, flown again by the checker: those of the windows hold, and each one that is spoiled fails under the right name.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test that cannot build its mesh should stop, and says what it checked"
)]

use std::path::Path;

use chta::{
    ballistics::{Arc, TakeoffChoice, delta_v_m_s},
    ground::{ContactPoint, MeshContact, MeshGround, MeshPosition, MeshTakeoffSet, MeshWindow, Surface},
    hop::HopMargins,
    path::{Execution, Hop, HopPath, StatedValue, ViolatedLimit, execute_over_mesh, heading_deg},
    quantity::{Angle, AngleInterval},
    terrain::{MeshTree, read_mesh},
    world::{ClearanceRule, Direction, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties},
};
use nalgebra::Point3;

use super::mesh_windows::{Shape, contact, ground, scene, surface};
use crate::support::Draw;

/// The hop of an arc between two contacts, from a distance along the journey on.
pub(crate) fn hop(ground: &MeshGround, ends: [&MeshContact; 2], window: &MeshWindow, arc: &Arc, along_m: f64) -> Hop {
    let sight = arc.line_of_sight();
    let limits = ground.hopper().limits();
    let [takeoff, landing] = [ends[0].at_m(along_m), ends[1].at_m(along_m + sight.run_m())];
    let angle = |loft: f64| Angle::from_slope(sight.slope() + loft);
    let margins =
        [limits.takeoff_speed_max_m_s - arc.takeoff_speed_m_s(), limits.arc_landing_speed_max_m_s() - arc.landing_speed_m_s()];
    Hop {
        direction: Direction::Forward,
        takeoff,
        landing,
        heading_deg: heading_deg(takeoff.point_m.xy(), landing.point_m.xy()),
        takeoff_angle: arc.takeoff_angle(),
        takeoff_speed_m_s: arc.takeoff_speed_m_s(),
        landing_angle: arc.landing_angle(),
        landing_speed_m_s: arc.landing_speed_m_s(),
        flight_time_s: arc.flight_time_s(),
        apex_z_m: takeoff.point_m.z + arc.apex_height_m(),
        delta_v_m_s: delta_v_m_s(arc, limits),
        propellant: None,
        takeoff_angles: AngleInterval { min: angle(window.lofts.lower), max: angle(window.lofts.upper) },
        speed_margin_m_s: margins[0].min(margins[1]),
        lower_limit: window.lower.limit,
        lower_vertex: None,
        upper_limit: window.upper.limit,
        margins: HopMargins::UNLIMITED,
        aim: None,
        roll_out: None,
    }
}

/// Flies hops between given ends.
fn flown(ground: &MeshGround, hops: Vec<Hop>, ends: Option<(MeshPosition, MeshPosition)>) -> Execution {
    execute_over_mesh(ground, &HopPath::of_hops(hops, ground.hopper()), ends)
}

fn flown_alone(ground: &MeshGround, hop: Hop) -> Execution {
    flown(ground, vec![hop], None)
}

/// One hop that the windows allow.
struct Case<'a> {
    ground: &'a MeshGround,
    ends: [&'a MeshContact; 2],
    set: &'a MeshTakeoffSet,
    window: &'a MeshWindow,
}

impl Case<'_> {
    fn arc(&self, loft: f64) -> Arc {
        Arc::new(self.set.course().sight, loft, self.ground.envelope().gravity_m_s2())
    }

    fn at(&self, loft: f64) -> Hop {
        hop(self.ground, self.ends, self.window, &self.arc(loft), 3.0)
    }

    fn fly(&self, loft: f64) -> Execution {
        flown_alone(self.ground, self.at(loft))
    }
}

fn names(execution: &Execution, limit: Limit) -> bool {
    execution.violations.iter().any(|v| v.limit == ViolatedLimit::Limit(limit))
}

/// A hopper and a surface with some limits or with all.
fn limits(draw: &mut Draw, gravity_m_s2: f64) -> (HopperLimits, SurfaceProperties) {
    let speed_m_s = draw.uniform(0.8, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
    let clear = draw.chance(0.5);
    let limits = HopperLimits {
        clearance_m: if clear { draw.log_uniform(0.01, 1.0) } else { 0.0 },
        clearance_rule: if draw.chance(0.5) { ClearanceRule::TAPERED } else { ClearanceRule::Tapered(draw.log_uniform(0.1, 4.0)) },
        apex_height_max_m: draw.chance(0.3).then(|| draw.uniform(1.0, 6.0)),
        flight_time_max_s: draw.chance(0.2).then(|| draw.uniform(0.5, 3.0) * speed_m_s / gravity_m_s2),
        takeoff_angle_min: draw.chance(0.2).then(|| Angle::from_degrees(draw.uniform(-20.0, 40.0))),
        takeoff_angle_max: draw.chance(0.2).then(|| Angle::from_degrees(draw.uniform(45.0, 80.0))),
        takeoff_speed_min_m_s: draw.chance(0.1).then(|| draw.uniform(0.2, 0.7) * speed_m_s),
        ..HopperLimits::with_speeds(speed_m_s, draw.uniform(0.8, 2.0) * speed_m_s)
    };
    let angles = |min, max| AngleInterval::from_degrees(min, max);
    let of_slope = Grip::FromSlope { takeoff: angles(20.0, 110.0), landing: angles(-130.0, -15.0) };
    let surface = if draw.chance(0.2) {
        SurfaceProperties { grip: Some(of_slope), rest: RestSlope::Unlimited }
    } else {
        surface(draw.log_uniform(0.3, 3.0))
    };
    (limits, surface)
}

/// Of random scenes and limits: every arc of a window holds, from one end of it to the other, and 1 % beyond an end the limit of that end
/// is named.
#[test]
fn hops_of_the_windows_hold_and_spoiled_ones_are_named() {
    let draw = &mut Draw::seeded(1811);
    let (mut held, mut spoiled) = (0, [0; Limit::ALL.len()]);
    for _ in 0..180 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let (limits, surface) = limits(draw, gravity_m_s2);
        let Ok(hopper) = Hopper::new(limits) else { continue };
        let tree = MeshTree::new(scene(draw).mesh());
        let Ok(ground) = MeshGround::new(tree, &hopper, Gravity::new(gravity_m_s2).unwrap(), &surface) else { continue };
        for _ in 0..40 {
            let (Some(from), Some(to)) = (contact(&ground, draw), contact(&ground, draw)) else { continue };
            let Some(set) = ground.takeoff_set(&from, &to) else { continue };
            for window in set.windows() {
                let case = Case { ground: &ground, ends: [&from, &to], set: &set, window };
                let (lower, upper) = (window.lofts.lower, window.lofts.upper.min(window.lofts.lower + 40.0));
                // A window much narrower than rounding holds nothing to fly between its ends.
                if lower <= 0.0 || upper - lower < 1e-9 * (1.0 + upper) {
                    continue;
                }
                for share in [0.0, 1.0, 0.5, draw.unit(), draw.unit(), draw.unit()] {
                    let loft = lower + share * (upper - lower);
                    let execution = case.fly(loft);
                    held += 1;
                    let stated = [from.at_m(3.0).point_m, to.at_m(3.0).point_m];
                    assert!(execution.passes(), "{loft} of {window:?}\n{stated:?} {limits:?}\n{:#?}", execution.violations);
                }
                for (end, limit, away) in [(lower, window.lower, -1.0), (window.lofts.upper, window.upper, 1.0)] {
                    if !end.is_finite() || limit.limit == Limit::LineOfSight {
                        continue;
                    }
                    let loft = end * (1.0 + 0.01 * away);
                    // Beyond a thin wall lies the next window.
                    let is_allowed = set.windows().iter().any(|window| window.lofts.contains(loft));
                    if is_allowed || loft < 1e-6 {
                        continue;
                    }
                    let execution = case.fly(loft);
                    assert!(names(&execution, limit.limit), "{loft} beyond {window:?}\n{:#?}", execution.violations);
                    let other = execution.violations.iter().find(|v| matches!(v.limit, ViolatedLimit::StatedValue(_)));
                    assert!(other.is_none(), "{other:?}");
                    spoiled[limit.limit.index()] += 1;
                }
            }
        }
    }
    let by_limit: Vec<_> =
        Limit::ALL.iter().filter(|limit| spoiled[limit.index()] > 0).map(|l| (l.to_string(), spoiled[l.index()])).collect();
    eprintln!("{held} hops held; {by_limit:?} spoiled");
    assert!(held > 10_000, "{held}");
    for limit in [
        Limit::TakeoffCone,
        Limit::LandingCone,
        Limit::TakeoffSpeed,
        Limit::LandingSpeed,
        Limit::Terrain,
        Limit::ApexHeight,
        Limit::FlightTime,
        Limit::MechanicalAngle,
    ] {
        assert!(spoiled[limit.index()] > 10, "{limit}: {}", spoiled[limit.index()]);
    }
}

/// Level ground with a ceiling 3 m over it.
fn hall() -> MeshGround {
    let mut shape = Shape::default();
    shape.polygon(&[[-5.0, -5.0, 0.0], [15.0, -5.0, 0.0], [15.0, 5.0, 0.0], [-5.0, 5.0, 0.0]]);
    shape.polygon(&[[-5.0, -5.0, 3.0], [-5.0, 5.0, 3.0], [15.0, 5.0, 3.0], [15.0, -5.0, 3.0]]);
    ground(shape.mesh(), HopperLimits::with_speeds(20.0, 20.0), 9.81, &surface(3.0))
}

/// The planned hop across a hall, with its least speed.
fn across(ground: &MeshGround, x_m: [f64; 2], along_m: f64) -> Hop {
    let [from, to] = x_m.map(|x| ground.contact(Point3::new(x, 0.3, 0.1)).unwrap());
    let set = ground.takeoff_set(&from, &to).unwrap();
    let (window, arc) = set.arc(TakeoffChoice::LeastSpeed, 9.81).unwrap();
    hop(ground, [&from, &to], &window, &arc, along_m)
}

/// Speeds 1 % off, a landing point elsewhere, and every stated number that is wrong are found under their names.
#[test]
fn other_speeds_landings_and_numbers_are_found() {
    let ground = hall();
    let good = across(&ground, [0.0, 6.0], 0.0);
    assert!(flown_alone(&ground, good).passes());
    let limits_of = |hop: Hop| -> Vec<ViolatedLimit> { flown_alone(&ground, hop).violations.iter().map(|v| v.limit).collect() };
    for factor in [0.99, 1.01] {
        let execution = flown_alone(&ground, Hop { takeoff_speed_m_s: factor * good.takeoff_speed_m_s, ..good });
        let contact = execution.flights[0].as_ref().unwrap().contact.unwrap();
        // Over level ground the range is as the square of the speed.
        assert!((contact.x_m - 6.0 * factor * factor).abs() < 1e-6 && contact.z_m.abs() < 1e-6, "{contact:?}");
        assert!(execution.violations.iter().any(|v| v.limit == ViolatedLimit::LandingPoint));
    }
    let off =
        |point: ContactPoint, z_m: f64| ContactPoint { point_m: point.point_m + nalgebra::Vector3::new(0.0, 0.0, z_m), ..point };
    assert!(
        limits_of(Hop { takeoff: off(good.takeoff, 0.06), ..good })
            .contains(&ViolatedLimit::StatedValue(StatedValue::TakeoffStation))
    );
    assert!(
        limits_of(Hop { landing: off(good.landing, 0.06), ..good })
            .contains(&ViolatedLimit::StatedValue(StatedValue::LandingStation))
    );
    let spoiled = [
        (Hop { apex_z_m: 1.01 * good.apex_z_m, ..good }, StatedValue::Apex),
        (Hop { flight_time_s: 1.01 * good.flight_time_s, ..good }, StatedValue::FlightTime),
        (Hop { landing_speed_m_s: 1.01 * good.landing_speed_m_s, ..good }, StatedValue::LandingSpeed),
        (Hop { landing_angle: Angle::from_degrees(1.01 * good.landing_angle.degrees()), ..good }, StatedValue::LandingAngle),
        (Hop { heading_deg: 1.01 * good.heading_deg, ..good }, StatedValue::Heading),
        (Hop { delta_v_m_s: 1.01 * good.delta_v_m_s, ..good }, StatedValue::DeltaV),
        (Hop { speed_margin_m_s: 1.01 * good.speed_margin_m_s, ..good }, StatedValue::SpeedMargin),
        (Hop { direction: Direction::Reverse, ..good }, StatedValue::Direction),
    ];
    for (hop, value) in spoiled {
        assert_eq!(limits_of(hop), [ViolatedLimit::StatedValue(value)]);
    }
    let longer = ContactPoint { along_m: 6.06, ..good.landing };
    assert_eq!(limits_of(Hop { landing: longer, ..good }), [ViolatedLimit::StatedValue(StatedValue::Distance)]);
}

/// A path joins its ends and its hops; one that does not names the gap.
#[test]
fn hops_join_one_another_and_the_ends() {
    let ground = hall();
    let first = across(&ground, [0.0, 6.0], 0.0);
    let hops = vec![first, across(&ground, [6.0, 9.0], first.landing.along_m)];
    let place = |x_m: f64| MeshPosition::from(&ground.contact(Point3::new(x_m, 0.3, 0.0)).unwrap());
    assert!(flown(&ground, hops.clone(), Some((place(0.0), place(9.0)))).passes());
    for ends in [(0.1, 9.0), (0.0, 9.1)] {
        let execution = flown(&ground, hops.clone(), Some((place(ends.0), place(ends.1))));
        assert!(execution.violations.iter().any(|v| v.limit == ViolatedLimit::Continuity), "{ends:?}");
    }
    let gap = vec![hops[0], across(&ground, [6.5, 9.0], 6.0)];
    assert!(flown(&ground, gap, None).violations.iter().any(|v| v.limit == ViolatedLimit::Continuity));
    // Over the floor under the ceiling: from one to the other there is no hop at all.
    let execution = flown(&ground, Vec::new(), Some((place(0.0), MeshPosition { point_m: Point3::new(0.0, 0.3, 3.0) })));
    assert_eq!(execution.violations.len(), 1);
}

/// A ceiling that was lowered, a wall that was set in the way, and an edge exactly in the arc are all hit, and named by their facet.
#[test]
fn what_stands_in_the_way_is_named_with_its_facet() {
    let good = across(&hall(), [0.0, 6.0], 0.0);
    let with = |build: &dyn Fn(&mut Shape)| {
        let mut shape = Shape::default();
        shape.polygon(&[[-5.0, -5.0, 0.0], [15.0, -5.0, 0.0], [15.0, 5.0, 0.0], [-5.0, 5.0, 0.0]]);
        build(&mut shape);
        flown_alone(&ground(shape.mesh(), HopperLimits::with_speeds(20.0, 20.0), 9.81, &surface(3.0)), good)
    };
    // The arc of 45 degrees over 6 m is 1.5 m high.
    let apex_m = good.apex_z_m;
    assert!((apex_m - 1.5).abs() < 1e-9);
    let ceiling =
        |z_m: f64| move |s: &mut Shape| s.polygon(&[[-5.0, -5.0, z_m], [-5.0, 5.0, z_m], [15.0, 5.0, z_m], [15.0, -5.0, z_m]]);
    assert!(with(&ceiling(1.5)).passes());
    for z_m in [1.499, 1.2, 0.4] {
        let execution = with(&ceiling(z_m));
        assert!(
            execution
                .violations
                .iter()
                .any(|v| v.limit == ViolatedLimit::Limit(Limit::Terrain) && v.facet.is_some_and(|f| f.index() >= 2))
        );
        // It meets the ceiling where x (1 - x / 6) = z.
        let met = execution.flights[0].as_ref().unwrap().contact.unwrap();
        assert!((met.x_m * (1.0 - met.x_m / 6.0) - z_m).abs() < 1e-9 && met.x_m <= 3.0, "{met:?}");
        assert!(execution.violations.iter().any(|v| v.limit == ViolatedLimit::LandingPoint));
    }
    let wall = |bottom: f64, top: f64| {
        move |s: &mut Shape| s.polygon(&[[3.0, -5.0, bottom], [3.0, 5.0, bottom], [3.0, 5.0, top], [3.0, -5.0, top]])
    };
    assert!(with(&wall(0.0, 1.4999)).passes() && with(&wall(1.5001, 4.0)).passes());
    assert!(!with(&wall(0.0, 1.501)).passes() && !with(&wall(1.499, 4.0)).passes());
    // Two plates that meet in an edge exactly on the arc: each alone is only touched at its end.
    let valley = |s: &mut Shape| {
        s.polygon(&[[2.0, -5.0, 0.5], [3.0, -5.0, 1.5], [3.0, 5.0, 1.5], [2.0, 5.0, 0.5]]);
        s.polygon(&[[3.0, -5.0, 1.5], [4.0, -5.0, 2.5], [4.0, 5.0, 2.5], [3.0, 5.0, 1.5]]);
    };
    let execution = with(&valley);
    assert!(names(&execution, Limit::Terrain), "{execution:#?}");
}

/// The three scenes of the paper, if they are here: hops between contacts on them hold.
#[test]
fn hops_on_the_scenes_of_the_paper_hold() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/mesh");
    for (name, low, high) in [
        ("scene_jump10.stl", [-6.0, -2.5, 0.0], [6.8, 3.2, 8.0]),
        ("cave_mono_short_1.stl", [-2.6, -3.0, -2.5], [2.6, 4.2, 4.0]),
        ("envir3d_1.stl", [-5.0, -5.0, -1.0], [5.0, 5.0, 7.0]),
    ] {
        let file = folder.join(name);
        if !file.exists() {
            eprintln!("skipped: {} is not here", file.display());
            continue;
        }
        let mesh = read_mesh(&file, 1.0).unwrap().mesh;
        let ground = ground(
            mesh,
            HopperLimits { clearance_m: 0.02, clearance_rule: ClearanceRule::TAPERED, ..HopperLimits::with_speeds(6.5, 6.5) },
            9.81,
            &surface(1.2),
        );
        let draw = &mut Draw::seeded(1812);
        let mut place = || {
            let at = Point3::new(draw.uniform(low[0], high[0]), draw.uniform(low[1], high[1]), draw.uniform(low[2], high[2]));
            ground.contact(at).ok()
        };
        let (mut held, mut longest_m) = (0, 0.0f64);
        for _ in 0..4000 {
            let (Some(from), Some(to)) = (place(), place()) else { continue };
            let Some(set) = ground.takeoff_set(&from, &to) else { continue };
            for choice in [TakeoffChoice::LeastSpeed, TakeoffChoice::LeastTime, TakeoffChoice::MidRange] {
                let Some((window, arc)) = set.arc(choice, 9.81) else { continue };
                let execution = flown_alone(&ground, hop(&ground, [&from, &to], &window, &arc, 0.0));
                assert!(execution.passes(), "{name} {:?} {:?}\n{:#?}", from.point_m(), to.point_m(), execution.violations);
                held += 1;
                longest_m = longest_m.max(arc.line_of_sight().run_m());
            }
        }
        eprintln!("{name}: {held} hops held, up to {longest_m:.2} m long");
        assert!(held > 30);
    }
}
