//! The margins of every planned hop of random worlds: none is negative, and a finely flown arc has the same ones.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its input should stop")]

use std::collections::BTreeMap;

use chta::{
    chain::{ConstrainedChain, GroundForm, PolygonalChain},
    ground::Surface,
    hop::{HopTest, MARGINS},
    path::Hop,
    quantity::{Angle, AngleInterval, ChainPoint},
    world::{ClearanceRule, Contact, Gravity, Grip, Hopper, HopperLimits, RestSlope, SPEED_TOLERANCE, SurfaceProperties},
};

use crate::execute::world::{Dice, World};

/// A hop flown by Newton's equations in many steps, from its command alone.
struct Flown {
    /// Distance from the take-off and height above it.
    points: Vec<(f64, f64)>,
    time_s: f64,
    landing_speed_m_s: f64,
    landing_angle_deg: f64,
}

const STEPS: u32 = 4000;

fn flown(hop: &Hop, gravity_m_s2: f64) -> Flown {
    let run_m = hop.run_m();
    let (sin, cos) = hop.takeoff_angle.radians().sin_cos();
    let (across, up) = (hop.takeoff_speed_m_s * cos, hop.takeoff_speed_m_s * sin);
    let time_s = run_m / across;
    let point = |i: u32| {
        let t = time_s * f64::from(i) / f64::from(STEPS);
        (across * t, t * (up - 0.5 * gravity_m_s2 * t))
    };
    let down = up - gravity_m_s2 * time_s;
    Flown {
        points: (0..=STEPS).map(point).collect(),
        time_s,
        landing_speed_m_s: across.hypot(down),
        landing_angle_deg: down.atan2(across).to_degrees(),
    }
}

/// The ground under a distance from the take-off, above it.
fn ground_m(chain: &ConstrainedChain, hop: &Hop, distance_m: f64) -> f64 {
    let x_m = hop.takeoff.along_m + hop.direction.sign() * distance_m;
    let vertices = chain.geometry().vertices();
    let after = vertices.partition_point(|v| v.x_m < x_m).clamp(1, vertices.len() - 1);
    let (a, b) = (vertices[after - 1], vertices[after]);
    (a.z_m - hop.takeoff.point_m.z) + (b.z_m - a.z_m) * ((x_m - a.x_m) / (b.x_m - a.x_m))
}

/// The least height over the ground and its clearance, between the first and the last point at which it counts.
fn least_height_m(chain: &ConstrainedChain, hop: &Hop, points: &[(f64, f64)], from_m: f64, to_m: f64) -> f64 {
    let limits = chain.hopper().limits();
    let kept = |d: f64| {
        let e = hop.run_m() - d;
        match limits.clearance_rule {
            ClearanceRule::Tapered(k) => limits.clearance_m.min(k * d).min(k * e),
            ClearanceRule::Vertex => limits.clearance_m,
        }
    };
    let over = |&(d, z): &(f64, f64)| z - ground_m(chain, hop, d) - kept(d);
    points.iter().filter(|(d, _)| (from_m..=to_m).contains(d)).map(over).fold(f64::INFINITY, f64::min)
}

/// The margins by name.
fn margins(hop: &Hop) -> BTreeMap<&'static str, f64> {
    hop.margins.rows().filter_map(|(row, value)| Some((row.key, value?))).collect()
}

/// The cone of a contact as stated, within the vertical.
fn cone(chain: &ConstrainedChain, hop: &Hop, contact: Contact) -> AngleInterval {
    let station = if contact == Contact::Takeoff { hop.takeoff.station } else { hop.landing.station }.unwrap();
    let stated = chain.ruling(&station, contact, hop.direction).unwrap().stated(hop.direction).unwrap();
    let angles = stated.contact(contact).angles();
    let right = Angle::from_degrees(90.0);
    let clipped = |angle: Angle| {
        if angle > right {
            right
        } else if angle < -right {
            -right
        } else {
            angle
        }
    };
    AngleInterval { min: clipped(angles.min), max: clipped(angles.max) }
}

#[test]
fn no_margin_of_a_planned_hop_is_negative_and_a_flown_arc_has_the_same() {
    let mut dice = Dice::new(60_013);
    let (mut hops, mut tried) = (0, [0_usize; MARGINS.len()]);
    let mut bound = 0;
    for _ in 0..10_000 {
        let mut world = World::random(&mut dice);
        if dice.chance(0.3) {
            let size_m = world.vertices.last().unwrap().x_m - world.vertices[0].x_m;
            let footprint_m = Some(size_m * dice.decades(-3.0, -1.0));
            let limits = HopperLimits { footprint_m, roughness_max_m: footprint_m, ..*world.hopper.limits() };
            world.hopper = Hopper::new(limits).unwrap();
        }
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain.clone());
        let Some(path) = world.plan(&test) else { continue };
        for hop in path.hops.iter().take(6) {
            let speeds = [Contact::Takeoff, Contact::Landing].map(|contact| {
                let station = if contact == Contact::Takeoff { hop.takeoff.station } else { hop.landing.station }.unwrap();
                chain.check_contact(&station, contact, hop.direction).unwrap().speed_max_m_s()
            });
            let apex_m = hop.apex_z_m - hop.takeoff.point_m.z;
            let limits = *world.hopper.limits();
            for (row, value) in hop.margins.rows() {
                let Some(value) = value else { continue };
                // The crate's tolerance of a speed, taken by all that the speed sets; angles to their rounding.
                let allowed = match row.key {
                    "takeoff_speed_m_s" | "landing_speed_m_s" => 1.01 * SPEED_TOLERANCE * speeds[0].max(speeds[1]),
                    "apex_height_m" => 1e-9 * limits.apex_height_max_m.unwrap(),
                    "flight_time_s" => 1e-9 * limits.flight_time_max_s.unwrap(),
                    "terrain_m" => 1e-9 * (hop.run_m() + apex_m),
                    _ => 1e-7,
                };
                assert!(value >= -allowed, "{}: {value:e}, allowed {allowed:e}; {hop:#?}\n{world:#?}", row.key);
                bound += usize::from(value <= allowed);
            }
            // A flight of which the last digits of the coordinates are no small part cannot be compared.
            let Flown { points, time_s, landing_speed_m_s, landing_angle_deg } = flown(hop, world.gravity_m_s2);
            let size_m = hop.run_m() + apex_m + (hop.landing.point_m.z - hop.takeoff.point_m.z).abs();
            let digits = (hop.takeoff.along_m.abs() + hop.takeoff.point_m.z.abs() + hop.landing.point_m.z.abs()) * f64::EPSILON;
            if digits > 1e-9 * hop.run_m() || hop.takeoff_angle.slope().abs() > 1e3 {
                continue;
            }
            hops += 1;
            let takeoff_deg = hop.takeoff_angle.degrees();
            let highest_m = points.iter().map(|(_, z)| *z).fold(f64::NEG_INFINITY, f64::max);
            let (takeoff_cone, landing_cone) = (cone(&chain, hop, Contact::Takeoff), cone(&chain, hop, Contact::Landing));
            let sight_deg = (hop.landing.point_m.z - hop.takeoff.point_m.z).atan2(hop.run_m()).to_degrees();
            for (row, value) in hop.margins.rows() {
                let expected = match row.key {
                    "takeoff_speed_m_s" => speeds[0] - hop.takeoff_speed_m_s,
                    "landing_speed_m_s" => speeds[1] - landing_speed_m_s,
                    "takeoff_cone_min_deg" => takeoff_deg - takeoff_cone.min.degrees(),
                    "takeoff_cone_max_deg" => takeoff_cone.max.degrees() - takeoff_deg,
                    "landing_cone_min_deg" => landing_angle_deg - landing_cone.min.degrees(),
                    "landing_cone_max_deg" => landing_cone.max.degrees() - landing_angle_deg,
                    "line_of_sight_deg" => takeoff_deg - sight_deg,
                    "mechanical_angle_min_deg" => limits.takeoff_angle_min.map_or(f64::NAN, |min| takeoff_deg - min.degrees()),
                    "mechanical_angle_max_deg" => limits.takeoff_angle_max.map_or(f64::NAN, |max| max.degrees() - takeoff_deg),
                    "apex_height_m" => limits.apex_height_max_m.map_or(f64::NAN, |max| max - highest_m),
                    "flight_time_s" => limits.flight_time_max_s.map_or(f64::NAN, |max| max - time_s),
                    // The fitted plane has a road of its own in footprint.rs.
                    "takeoff_rest_slope_deg" | "landing_rest_slope_deg" if limits.footprint_m.is_some() => continue,
                    "takeoff_rest_slope_deg" => rest_deg(&world, &chain, hop, Contact::Takeoff),
                    "landing_rest_slope_deg" => rest_deg(&world, &chain, hop, Contact::Landing),
                    "takeoff_roughness_m" => roughness_m(&chain, hop.takeoff.station.unwrap().point, &limits),
                    "landing_roughness_m" => roughness_m(&chain, hop.landing.station.unwrap().point, &limits),
                    "terrain_m" => continue,
                    other => panic!("the margin {other} has no second road here"),
                };
                let tolerance = match row.key {
                    key if key.ends_with("_deg") => 1e-4,
                    key if key.ends_with("_m_s") => 1e-6 * speeds[0].max(speeds[1]),
                    // The highest of 4000 points is lower than the apex by at most g (T / 8000)^2 / 2.
                    "apex_height_m" => 1e-6 * size_m + 0.5 * world.gravity_m_s2 * (time_s / 8000.0).powi(2),
                    "takeoff_roughness_m" | "landing_roughness_m" => {
                        let steepest = chain.geometry().slopes().iter().fold(0.0, |most: f64, slope| most.max(slope.abs()));
                        2e-3 * limits.footprint_m.unwrap_or(0.0) * (1.0 + steepest)
                    }
                    _ => 1e-6 * time_s,
                };
                match value {
                    Some(value) => {
                        assert!((value - expected).abs() <= tolerance, "{}: {value}, flown {expected}; {hop:#?}", row.key);
                        tried[MARGINS.iter().position(|other| other.key == row.key).unwrap()] += 1;
                    }
                    None => assert!(expected.is_nan(), "{} is missing: {expected}", row.key),
                }
            }
            tried[7] += terrain(&chain, hop, &points, size_m);
        }
    }
    let names: Vec<_> = MARGINS.iter().map(|row| row.key).zip(tried).collect();
    assert_eq!(MARGINS[7].key, "terrain_m");
    assert!(hops > 5000 && bound > 1000 && tried.iter().all(|count| *count > 300), "{hops} hops, {bound} at a limit, {names:?}");
}

/// The margin of the roughness at a point, from a line fitted to many samples of the profile; NaN without a limit.
fn roughness_m(chain: &ConstrainedChain, at: ChainPoint, limits: &HopperLimits) -> f64 {
    const SAMPLES: u32 = 2000;
    let Some((footprint_m, max_m)) = limits.footprint_m.zip(limits.roughness_max_m) else { return f64::NAN };
    let (first_m, last_m) = chain.geometry().extent_m();
    let samples = (0..SAMPLES).map(|i| footprint_m * ((f64::from(i) + 0.5) / f64::from(SAMPLES) - 0.5));
    let height_m = |x: f64| chain.geometry().station((at.x_m + x).clamp(first_m, last_m)).unwrap().point.z_m - at.z_m;
    let points: Vec<(f64, f64)> = samples.map(|x| (x, height_m(x))).collect();
    let mean_m = points.iter().map(|(_, z)| z).sum::<f64>() / f64::from(SAMPLES);
    let slope = points.iter().map(|(x, z)| x * z).sum::<f64>() / points.iter().map(|(x, _)| x * x).sum::<f64>();
    max_m - points.iter().map(|(x, z)| (z - mean_m - slope * x).abs()).fold(0.0, f64::max)
}

/// Compares the margin of the terrain; returns how many were.
fn terrain(chain: &ConstrainedChain, hop: &Hop, points: &[(f64, f64)], size_m: f64) -> usize {
    let limits = *chain.hopper().limits();
    let (left, right) = (hop.takeoff.along_m.min(hop.landing.along_m), hop.takeoff.along_m.max(hop.landing.along_m));
    let run_m = hop.run_m();
    let mut places: Vec<f64> =
        chain.geometry().vertices().iter().filter(|v| v.x_m > left && v.x_m < right).map(|v| v.x_m).collect();
    for x_m in &mut places {
        *x_m = (*x_m - hop.takeoff.along_m).abs();
    }
    if let (ClearanceRule::Tapered(k), true) = (limits.clearance_rule, limits.clearance_m > 0.0) {
        let kink_m = (limits.clearance_m / k).min(0.5 * run_m);
        places.extend([kink_m, run_m - kink_m]);
    }
    let found = margins(hop).get("terrain_m").copied();
    let Some((first, last)) = places.iter().copied().fold(None, |ends: Option<(f64, f64)>, place| {
        Some(ends.map_or((place, place), |(low, high)| (low.min(place), high.max(place))))
    }) else {
        assert_eq!(found, None, "{hop:#?}");
        return 0;
    };
    let (found, at_m) = (found.unwrap(), hop.margins.terrain_from_takeoff_m().unwrap());
    let tolerance = 1e-6 * size_m;
    let height = |d: f64| {
        let (sin, cos) = hop.takeoff_angle.radians().sin_cos();
        let t = d / (hop.takeoff_speed_m_s * cos);
        t * (hop.takeoff_speed_m_s * sin - 0.5 * chain.gravity().m_s2() * t)
    };
    let at_places: Vec<(f64, f64)> = places.iter().map(|&d| (d, height(d))).collect();
    let expected = least_height_m(chain, hop, &at_places, 0.0, run_m);
    assert!((found - expected).abs() <= tolerance, "{found}, flown {expected}; {hop:#?}");
    let there = least_height_m(chain, hop, &[(at_m, height(at_m))], 0.0, run_m);
    assert!((found - there).abs() <= tolerance, "{found} at {at_m} m, flown {there}; {hop:#?}");
    if limits.clearance_rule != ClearanceRule::Vertex {
        let between = least_height_m(chain, hop, points, first, last);
        assert!(between >= found - tolerance, "{found}, between the points {between}; {hop:#?}");
    }
    1
}

/// The rest slope minus the inclination of the surface from the components of its normal; NaN without a rest slope.
fn rest_deg(world: &World, chain: &ConstrainedChain, hop: &Hop, contact: Contact) -> f64 {
    let station = if contact == Contact::Takeoff { hop.takeoff.station } else { hop.landing.station }.unwrap();
    let segment = station.ruling_segment(contact, hop.direction, chain.segments().len()).unwrap().index();
    let along = chain.geometry().slopes()[segment].atan();
    let (friction, across) = match world.grounds[segment].form {
        GroundForm::Surface { friction, cross_slope } => (
            friction.or(match world.surface.grip {
                Some(Grip::Friction(cone)) => Some(cone),
                _ => None,
            }),
            cross_slope.radians(),
        ),
        GroundForm::Explicit { .. } => (None, 0.0),
    };
    let (x, y) = (along.sin() * across.cos(), across.sin());
    let tilt_deg = x.hypot(y).atan2(across.cos() * along.cos()).to_degrees();
    match world.surface.rest {
        RestSlope::Unlimited => f64::NAN,
        RestSlope::AtMost(angle) => angle.degrees() - tilt_deg,
        RestSlope::AsFrictionHolds => friction.map_or(f64::NAN, |cone| cone.coefficient().atan().to_degrees() - tilt_deg),
    }
}

/// By hand: 45 degrees over 10 m of flat ground at 10 m/s^2 is 10 m/s, sqrt(2) s and 2.5 m; a wall of 1 m at 2 m is passed at 1.6 m.
#[test]
fn margins_of_a_hop_known_by_hand() {
    let vertices = [(0.0, 0.0), (2.0, 1.0), (4.0, 0.0), (10.0, 0.0)].map(|(x_m, z_m)| ChainPoint::new(x_m, z_m)).to_vec();
    let hopper = Hopper::new(HopperLimits {
        clearance_m: 0.5,
        clearance_rule: ClearanceRule::Tapered(0.5),
        takeoff_angle_min: Some(Angle::from_degrees(40.0)),
        apex_height_max_m: Some(3.0),
        flight_time_max_s: Some(2.0),
        ..HopperLimits::with_speeds(10.5, 12.0)
    })
    .unwrap();
    let grip =
        Grip::FromSlope { takeoff: AngleInterval::from_degrees(-40.0, 80.0), landing: AngleInterval::from_degrees(-60.0, -30.0) };
    let surface = SurfaceProperties { grip: Some(grip), rest: RestSlope::AtMost(Angle::from_degrees(30.0)) };
    let chain =
        ConstrainedChain::new(PolygonalChain::bare(vertices).unwrap(), &hopper, Gravity::new(10.0).unwrap(), &surface).unwrap();
    let test = HopTest::new(chain);
    let [from, to] = [0.0, 10.0].map(|x_m| test.chain().geometry().station(x_m).unwrap());
    let arc = chta::ballistics::Arc::new(test.line_of_sight(&from, &to).unwrap(), 1.0, 10.0);
    // The surface under the take-off is atan(1/2) steep: within 30 degrees.
    let steep_deg = 0.5_f64.atan().to_degrees();
    let found = chta::hop::HopMargins::of(&test, &from, &to, &arc).unwrap();
    #[rustfmt::skip]
    let expected = [
        ("takeoff_speed_m_s", Some(0.5)), ("landing_speed_m_s", Some(2.0)),
        ("takeoff_cone_min_deg", Some(45.0 - (steep_deg - 40.0))), ("takeoff_cone_max_deg", Some(90.0 - 45.0)),
        ("landing_cone_min_deg", Some(15.0)), ("landing_cone_max_deg", Some(15.0)),
        ("line_of_sight_deg", Some(45.0)),
        // At the vertex 1.6 - 1 - 0.5; at the first kink, 1 m away, 0.9 - 0.5 - 0.5; the other, at 9 m, 0.9 - 0.5.
        ("terrain_m", Some(-0.1)),
        ("mechanical_angle_min_deg", Some(5.0)), ("mechanical_angle_max_deg", None),
        ("apex_height_m", Some(0.5)), ("flight_time_s", Some(2.0 - 2f64.sqrt())),
        ("takeoff_rest_slope_deg", Some(30.0 - steep_deg)), ("landing_rest_slope_deg", Some(30.0)),
    ];
    for ((row, value), (key, hand)) in found.rows().zip(expected) {
        assert_eq!(row.key, key);
        match (value, hand) {
            (Some(value), Some(hand)) => assert!((value - hand).abs() < 1e-12, "{key}: {value}, by hand {hand}"),
            (value, hand) => assert_eq!(value, hand, "{key}"),
        }
    }
    assert_eq!(found.terrain_from_takeoff_m(), Some(1.0));
    assert!(test.chain().contact_point(&from).map().is_none());
}

/// P section V-B by eq. 29 and 30, and eq. 19 by hand at beta = atan(4.63 / 76): the two roads of the greatest reach.
#[test]
fn the_greatest_reach_has_the_figures_of_the_paper_and_of_the_least_speeds() {
    let vertices = vec![ChainPoint::new(0.0, 54.61), ChainPoint::new(76.0, 59.24)];
    let grip =
        Grip::FromSlope { takeoff: AngleInterval::from_degrees(60.0, 90.0), landing: AngleInterval::from_degrees(-90.0, -60.0) };
    let surface = SurfaceProperties { grip: Some(grip), rest: RestSlope::Unlimited };
    let hopper = |takeoff, landing| Hopper::with_speeds(takeoff, landing).unwrap();
    let g = 3.711;
    let reach = |hopper: &Hopper, to_x_m: f64| {
        let chain =
            ConstrainedChain::new(PolygonalChain::bare(vertices.clone()).unwrap(), hopper, Gravity::new(g).unwrap(), &surface);
        let test = HopTest::new(chain.unwrap());
        let [from, to] = [0.0, to_x_m].map(|x_m| test.chain().geometry().station(x_m).unwrap());
        test.reach_along_sight(&from, &to).unwrap()
    };
    let (by_speeds, within) = reach(&hopper(10.0, 10.0), 76.0);
    let within = within.unwrap();
    let beta = (4.63_f64 / 76.0).atan();
    for (what, found, expected, tolerance) in [
        ("R_t of the paper", within.by_takeoff_speed_m(), 20.913, 5e-4),
        ("R_l of the paper", within.by_landing_speed_m(), 23.093, 5e-4),
        ("R_t of the paper, horizontally", within.reach_horizontal_m(), 20.874, 5e-4),
        ("its angle, 60 over the slope", within.takeoff_angle().degrees(), 60.0 + beta.to_degrees(), 1e-9),
        ("eq. 16", by_speeds.by_takeoff_speed_m(), 100.0 / (g * (1.0 + beta.sin())), 1e-9),
        ("eq. 18", by_speeds.by_landing_speed_m(), 100.0 / (g * (1.0 - beta.sin())), 1e-9),
        ("eq. 19", by_speeds.reach_m(), 100.0 / (g * (1.0 + beta.sin())), 1e-9),
        ("eq. 20", by_speeds.takeoff_angle().degrees(), 45.0 + 0.5 * beta.to_degrees(), 1e-9),
    ] {
        assert!((found - expected).abs() < tolerance, "{what}: {found}, expected {expected}");
    }
    assert_eq!((by_speeds.limit().name(), within.limit().name()), ("takeoff-speed", "takeoff-speed"));
    // It depends on the direction alone, not on where along it the landing lies, and another speed can end it.
    let (near, _) = reach(&hopper(10.0, 9.0), 20.0);
    assert_eq!(near.limit().name(), "landing-speed");
    // A landing at that distance needs just that speed, by the least speed of any arc.
    let run_m = near.reach_horizontal_m();
    let sight = chta::ballistics::LineOfSight::new(run_m, run_m * 4.63 / 76.0);
    assert!((chta::ballistics::least_landing_speed_m_s(sight, g) - 9.0).abs() < 1e-12);
}
