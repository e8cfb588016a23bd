//! Bounces against closed sums, against arcs reflected in the frame of a plane, and chain against DEM.
#![allow(clippy::cast_precision_loss, reason = "small counts")]

use nalgebra::{Point2, Vector2, Vector3};

use super::BOUNCES_MAX;
use crate::{
    ballistics::{Arc, level_bounces},
    chain::{ConstrainedChain, PolygonalChain},
    draw::Draw,
    flight::{
        Command, Distribution, Errors, FlownHop, HopErrors, HopTrials, JudgedHop, REPORTED_DRAWS, TrialDraws, Uncertainty,
        resting_at,
    },
    ground::{ChainGround, ChainPosition, ContactFailure, DemGround, FirstContact, LiftoffVelocity, MapPosition, Windows},
    hop::HopTest,
    quantity::{Angle, ChainPoint, MapPoint},
    terrain::{Dem, GeoReference, OverlaidDem, Overlays},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, Restitution, SurfaceProperties},
};

fn hopper(restitution: Option<Restitution>, landing_speed_max_m_s: f64) -> Hopper {
    Hopper::new(HopperLimits { restitution, ..HopperLimits::with_speeds(1e9, landing_speed_max_m_s) }).unwrap()
}

fn surface(friction: f64) -> SurfaceProperties {
    let cone = FrictionCone::new(friction).unwrap();
    SurfaceProperties { grip: Some(Grip::Friction(cone)), rest: RestSlope::AsFrictionHolds }
}

fn chain(points: &[(f64, f64)], hopper: &Hopper, gravity_m_s2: f64, friction: f64) -> ChainGround {
    let vertices = points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect();
    let (geometry, gravity) = (PolygonalChain::bare(vertices).unwrap(), Gravity::new(gravity_m_s2).unwrap());
    ChainGround::new(HopTest::new(ConstrainedChain::new(geometry, hopper, gravity, &surface(friction)).unwrap()))
}

/// A DEM of square posts about the origin, with the height of a position.
fn dem(posts: usize, spacing_m: f64, hopper: &Hopper, gravity_m_s2: f64, height: impl Fn(f64, f64) -> f64) -> DemGround {
    let half_m = 0.5 * (posts - 1) as f64 * spacing_m;
    let at = |i: usize| i as f64 * spacing_m - half_m;
    let heights = (0..posts * posts).map(|i| height(at(i % posts), -at(i / posts))).collect();
    let reference = GeoReference::local(MapPoint::new(-half_m, half_m), spacing_m, spacing_m).unwrap();
    let terrain = OverlaidDem::new(Dem::new(posts, posts, heights, reference).unwrap(), Overlays::default());
    DemGround::new(terrain, hopper, Gravity::new(gravity_m_s2).unwrap(), &surface(1e6))
}

fn station(ground: &ChainGround, x_m: f64) -> ChainPosition {
    ChainPosition::on_chain(ground.test().chain().geometry().station(x_m).unwrap())
}

/// A hop without errors.
fn flown<G: FirstContact>(ground: &G, from: &G::Contact, velocity: Vector3<f64>) -> FlownHop<G::Contact> {
    let horizontal_m_s = velocity.xy().norm();
    let liftoff = LiftoffVelocity { heading: velocity.xy() / horizontal_m_s, horizontal_m_s, vertical_m_s: velocity.z };
    HopErrors::default().fly(ground, from, &liftoff, from)
}

fn random_restitution(draw: &mut Draw, speed_m_s: f64) -> Restitution {
    Restitution::new(draw.uniform(0.05, 0.8), draw.uniform(0.0, 0.8), Some(speed_m_s * draw.log_uniform(1e-3, 0.3))).unwrap()
}

#[test]
fn over_level_ground_bounces_are_the_closed_sum() {
    let mut draw = Draw::seeded(16);
    for _ in 0..300 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.log_uniform(0.05, 30.0);
        let restitution = random_restitution(&mut draw, speed_m_s);
        let reach_m = speed_m_s * speed_m_s / gravity_m_s2;
        let ground = chain(&[(-9.0 * reach_m, 3.0), (9.0 * reach_m, 3.0)], &hopper(Some(restitution), 1e9), gravity_m_s2, 1e6);
        let angle = draw.uniform(0.1, 1.5);
        let velocity = Vector3::new(draw.sign() * speed_m_s * angle.cos(), 0.0, speed_m_s * angle.sin());
        let hop = flown(&ground, &station(&ground, 0.0), velocity);
        let sum = level_bounces(velocity.x.abs(), velocity.z, &restitution, gravity_m_s2);
        let beyond_m = (hop.rest.station.point.x_m - hop.end.station.point.x_m) * velocity.x.signum();
        assert!(hop.failure.is_none() && hop.bounces.count == sum.count, "{hop:?} {sum:?}");
        assert!((beyond_m - sum.distance_m).abs() <= 1e-9 * reach_m, "{beyond_m} for {sum:?}");
        assert!((hop.bounces.time_s - sum.time_s).abs() <= 1e-9 * (reach_m / speed_m_s), "{hop:?} {sum:?}");
    }
}

/// In the frame of a plane gravity has a constant part into it and a constant part along it, and every contact is at height 0.
#[test]
fn over_a_plane_at_any_tilt_bounces_are_those_of_its_own_frame() {
    let mut draw = Draw::seeded(17);
    let mut counted = 0;
    for number in 0..400 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = (gravity_m_s2 * draw.log_uniform(0.1, 1e4)).sqrt();
        let restitution = random_restitution(&mut draw, speed_m_s);
        let tilt = draw.uniform(0.0, 1.3);
        let downhill = draw.uniform(0.0, std::f64::consts::TAU);
        let gradient = -Vector2::new(downhill.cos(), downhill.sin()) * tilt.tan();
        let normal = Vector3::new(-gradient.x, -gradient.y, 1.0).normalize();
        let gravity = Vector3::new(0.0, 0.0, -gravity_m_s2);
        let along = gravity - normal * normal.dot(&gravity);
        let heading = draw.uniform(0.0, std::f64::consts::TAU);
        let mut away = Vector3::new(heading.cos(), heading.sin(), 0.0);
        away -= normal * normal.dot(&away);
        let velocity = (away.normalize() * draw.unit() + normal * draw.uniform(0.3, 1.0)) * speed_m_s;
        // Contacts one by one in that frame.
        let (mut at, mut flies, mut time_s, mut count, mut first) = (Vector3::zeros(), velocity, 0.0, 0, None);
        let mut least_share: f64 = 1.0;
        let end = loop {
            let lasts_s = 2.0 * flies.dot(&normal) / (gravity_m_s2 * tilt.cos());
            at += (flies - normal * normal.dot(&flies)) * lasts_s + along * (0.5 * lasts_s * lasts_s);
            if first.is_some() {
                (time_s, count) = (time_s + lasts_s, count + 1);
            }
            first = first.or(Some(at));
            let tangential = flies - normal * normal.dot(&flies) + along * lasts_s;
            flies = tangential * restitution.tangential() + normal * (normal.dot(&flies) * restitution.normal());
            if flies.norm() < restitution.settling_speed_m_s(gravity_m_s2) {
                break at;
            }
            least_share = least_share.min(flies.dot(&normal) / flies.norm());
        };
        let scale_m = end.norm().max(speed_m_s * speed_m_s / gravity_m_s2);
        let spacing_m = scale_m * draw.log_uniform(0.06, 2.0);
        let (hopper, posts) = (hopper(Some(restitution), 1e9), 81);
        let ground = dem(posts, spacing_m, &hopper, gravity_m_s2, |x, y| gradient.x * x + gradient.y * y);
        let hop = flown(&ground, &ground.position(MapPoint::origin()).unwrap(), velocity);
        let rest = ground.point(&hop.rest).coords;
        assert!(hop.failure.is_none(), "{number}: {hop:?}");
        // A hopper that hardly leaves the facet rests a few bounces of no length earlier, when rounding hides its impact.
        assert!(hop.bounces.count == count || hop.bounces.count < count && least_share < 1e-9, "{number}: {hop:?} for {count}");
        assert!((rest - end).norm() <= 1e-8 * scale_m, "{number}: {rest} for {end}");
        assert!((hop.bounces.time_s - time_s).abs() <= 1e-8 * (hop.time_s + time_s), "{number}: {hop:?} for {time_s}");
        counted += count;
    }
    assert!(counted > 2000, "{counted}");
}

/// Over ground that has the profile of a chain and does not change to the side.
#[test]
fn chain_and_dem_agree_over_ridges() {
    let mut draw = Draw::seeded(18);
    let (mut several, mut lost) = (0, 0);
    for number in 0..300 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = (gravity_m_s2 * draw.uniform(1.0, 12.0)).sqrt();
        let restitution = random_restitution(&mut draw, speed_m_s);
        let rough_m = draw.uniform(0.0, 0.8);
        let heights: Vec<f64> = (0..41).map(|_| draw.uniform(-rough_m, rough_m)).collect();
        let hopper = hopper(Some(restitution), 1e9);
        let points: Vec<(f64, f64)> = heights.iter().enumerate().map(|(i, &z)| (i as f64 - 20.0, z)).collect();
        let on_chain = chain(&points, &hopper, gravity_m_s2, 1e6);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "columns 0 to 40")]
        let on_map = dem(41, 1.0, &hopper, gravity_m_s2, |x, _| heights[(x + 20.0).round() as usize]);
        let x_m = draw.uniform(-8.0, 8.0);
        let angle = draw.uniform(0.7, 1.5);
        let velocity = Vector3::new(draw.sign() * angle.cos(), 0.0, angle.sin()) * speed_m_s;
        let a = flown(&on_chain, &station(&on_chain, x_m), velocity);
        let b = flown(&on_map, &on_map.position(MapPoint::new(x_m, 0.3)).unwrap(), velocity);
        assert_eq!((a.failure, a.bounces.count), (b.failure, b.bounces.count), "{number}: {a:?} {b:?}");
        let (a_m, b_m) = (on_chain.point(&a.rest), on_map.point(&b.rest));
        assert!((a_m.x - b_m.x).abs() < 1e-6 && (a_m.z - b_m.z).abs() < 1e-6, "{number}: {a_m} {b_m}");
        assert!((b_m.y - 0.3).abs() < 1e-9, "it stays in its plane");
        assert!((a.bounces.time_s - b.bounces.time_s).abs() <= 1e-6 * (a.time_s + a.bounces.time_s));
        several += u32::from(a.bounces.count > 3);
        lost += u32::from(a.failure == Some(ContactFailure::OffLimits));
    }
    assert!(several > 100 && lost > 0, "{several} with bounces, {lost} lost");
}

/// Valleys, peaks, posts, edges and ends, met exactly: every hop comes to an end, and one that rests does so on the ground.
#[test]
fn bounces_on_vertices_and_edges_end() {
    let near_lasting = Restitution::new(0.99, 0.99, Some(1e-6)).unwrap();
    for restitution in [near_lasting, Restitution::new(0.5, 0.7, None).unwrap(), Restitution::new(0.8, 0.0, Some(1e-3)).unwrap()] {
        for slope in [-2.0, -0.5, 0.0, 0.5, 2.0] {
            // A valley (slope above 0) or a peak of the profile at 0, and an end at 6.
            let hopper = hopper(Some(restitution), 1e9);
            let profile = |x: f64| slope * x.abs();
            let on_chain = chain(&[(-6.0, profile(6.0)), (0.0, 0.0), (6.0, profile(6.0))], &hopper, 1.62, 1e6);
            let on_map = dem(13, 1.0, &hopper, 1.62, |x, y| slope * x.abs().max(y.abs()));
            for x_m in [-6.0, -2.0, -1.0, 0.0, 1.0] {
                for velocity in [Vector3::new(1e-300, 0.0, 2.0), Vector3::new(1.0, 0.0, 1.62), Vector3::new(-1.0, 0.0, 1.62)] {
                    let hop = flown(&on_chain, &station(&on_chain, x_m), velocity);
                    let rest = on_chain.point(&hop.rest);
                    assert!(hop.bounces.count < BOUNCES_MAX && hop.bounces.time_s.is_finite(), "{hop:?}");
                    assert!((rest.z - profile(rest.x)).abs() < 1e-9, "{hop:?}");
                    for turn in [0.0, 0.25, 0.5, 1.0] {
                        let (sine, cosine) = (turn * std::f64::consts::PI).sin_cos();
                        let turned = Vector3::new(velocity.x * cosine, velocity.x * sine, velocity.z);
                        let hop = flown(&on_map, &on_map.position(MapPoint::new(x_m, 0.0)).unwrap(), turned);
                        let ground_m = on_map.position(hop.rest.at).unwrap().z_m;
                        assert!(hop.bounces.count < BOUNCES_MAX && hop.bounces.time_s.is_finite(), "{hop:?}");
                        assert!((hop.rest.z_m - ground_m).abs() < 1e-9, "{hop:?}");
                    }
                }
            }
        }
    }
}

/// Name, profile, restitution, landing speed limit, how the hop ends, and whether it bounces.
type Row<'a> = (&'a str, &'a [(f64, f64)], Option<Restitution>, f64, Option<ContactFailure>, bool);

#[test]
fn later_contacts_and_the_place_of_rest_are_judged() {
    let bouncy = Restitution::new(0.5, 0.9, Some(0.05)).unwrap();
    let stays = Restitution::new(0.0, 0.9, None).unwrap();
    // Level ground, then a cliff 10 m deep, then level ground: a hop from -4 m lands at -1 m and bounces over the edge.
    let cliff = [(-9.0, 0.0), (0.0, 0.0), (0.01, -10.0), (90.0, -10.0)];
    let level = [(-9.0, 0.0), (90.0, 0.0)];
    let ends = [(-9.0, 0.0), (-0.5, 0.0)];
    // Ground too steep to rest on for a friction of 0.7 lies just beyond the first contact.
    let steep = [(-9.0, 0.0), (-0.9, 0.0), (0.1, -1.2), (90.0, -110.0)];
    let rows: [Row<'_>; 7] = [
        ("level", &level, Some(bouncy), 4.0, None, true),
        ("cliff, slow limit", &cliff, Some(bouncy), 4.0, Some(ContactFailure::TooFast), true),
        ("cliff, fast limit", &cliff, Some(bouncy), 40.0, None, true),
        ("the chain ends", &ends, Some(bouncy), 4.0, Some(ContactFailure::OffLimits), true),
        ("too steep to rest", &steep, Some(bouncy), 400.0, Some(ContactFailure::Slides), true),
        ("no bounces", &cliff, None, 4.0, None, false),
        ("restitution 0", &cliff, Some(stays), 4.0, None, false),
    ];
    let speed_m_s = (1.62 * 3.0f64).sqrt();
    let velocity = Vector3::new(speed_m_s, 0.0, speed_m_s) * std::f64::consts::FRAC_1_SQRT_2;
    for (name, points, restitution, landing_max_m_s, failure, bounces) in rows {
        let ground = chain(points, &hopper(restitution, landing_max_m_s), 1.62, 1.2);
        let hop = flown(&ground, &station(&ground, -4.0), velocity);
        assert!((hop.end.station.point.x_m + 1.0).abs() < 1e-9, "{name}: {hop:?}");
        assert_eq!((hop.failure, hop.bounces.count > 0), (failure, bounces), "{name}: {hop:?}");
        assert!(bounces || hop.rest == hop.end, "{name}");
    }
    // A slope of 40 degrees holds the first contact of an upright landing under 45 degrees of rest slope, and no rest under 30.
    for (rest_deg, failure) in [(45.0, None), (38.0, Some(ContactFailure::Slides))] {
        let vertices = [(-90.0, 0.0), (0.0, 0.0), (9.0, -9.0 * 0.8391), (900.0, -756.0)];
        let surface = SurfaceProperties { rest: RestSlope::AtMost(Angle::from_degrees(rest_deg)), ..surface(5.0) };
        let geometry = PolygonalChain::bare(vertices.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect()).unwrap();
        let lossy = Restitution::new(0.3, 0.2, Some(0.3)).unwrap();
        let chain = ConstrainedChain::new(geometry, &hopper(Some(lossy), 1e3), Gravity::new(1.62).unwrap(), &surface).unwrap();
        let ground = ChainGround::new(HopTest::new(chain));
        let hop = flown(&ground, &station(&ground, -3.02), velocity);
        assert!(hop.end.station.point.x_m < 0.0 && hop.rest.station.point.x_m > 0.0, "{hop:?}");
        assert_eq!(hop.failure, failure, "{hop:?}");
    }
}

/// The share of fixed draws that fail is that of many random flights, with bounces in both.
#[test]
fn estimates_count_what_flights_do() {
    let bouncy = Restitution::new(0.5, 0.7, None).unwrap();
    let errors = Uncertainty {
        takeoff_speed_sigma_fraction: 0.03,
        takeoff_angle_sigma: Angle::from_degrees(2.0),
        drift_along_sigma_m: 0.2,
        ..Uncertainty::NONE
    };
    let points: Vec<(f64, f64)> = (0..60).map(|i| (f64::from(i) - 20.0, 0.2 * (f64::from(i) * 0.9).sin())).collect();
    let ground = chain(&points, &hopper(Some(bouncy), 9.0), 1.62, 1.5);
    let (from, aim) = (station(&ground, 0.0), station(&ground, 14.0));
    let mut between = 0;
    for (goal_m, tolerance_m) in [(14.0, 2.0), (21.0, 1.0), (21.5, 0.5), (22.0, 1.0), (20.0, 2.0), (23.0, 1.0), (21.0, 9.0)] {
        let liftoff = LiftoffVelocity { heading: Vector2::x(), horizontal_m_s: 3.4, vertical_m_s: 3.4 };
        let command = Command::new(liftoff, aim);
        let goal = Some((Point2::new(goal_m, 0.0), tolerance_m));
        let judged = JudgedHop { from, command, takeoff_sigma_m: [0.0; 2], goal, aims_at_rest: false };
        let survival =
            HopTrials::new(&ground, &errors, Distribution::Normal, points.len(), REPORTED_DRAWS).survival(&judged, u32::MAX);
        let estimate = 1.0 - f64::from(survival.failed) / f64::from(survival.of);
        let random = Errors::new(errors.clone(), false);
        let mut draws = TrialDraws::seeded(3);
        let mut arrived = 0;
        for trial in 0..20_000 {
            let biases = random.begin(&mut draws, trial);
            let drawn = random.draw(&mut draws, &biases);
            let liftoff = random.liftoff(&command.liftoff, command.speed_m_s, &drawn);
            if !ground.holds_takeoff(&from, &liftoff) {
                continue;
            }
            let hop = drawn.fly(&ground, &from, &liftoff, &aim);
            arrived += u32::from(hop.failure.is_none() && (hop.rest.station.point.x_m - goal_m).abs() <= tolerance_m);
        }
        let counted = f64::from(arrived) / 20_000.0;
        assert!((estimate - counted).abs() < 0.05, "goal {goal_m}: {estimate} estimated, {counted} flown");
        between += u32::from(0.05 < counted && counted < 0.95);
    }
    assert!(between >= 3, "{between}");
}

/// A DEM's first contact on its cross-slope: the bounce leaves the plane of travel, downhill.
#[test]
fn a_cross_slope_turns_the_bounce_downhill() {
    let bouncy = Restitution::new(0.6, 0.8, None).unwrap();
    let ground = dem(41, 1.0, &hopper(Some(bouncy), 1e9), 1.62, |_, y| 0.3 * y);
    let from: MapPosition = ground.position(MapPoint::origin()).unwrap();
    let hop = flown(&ground, &from, Vector3::new(2.0, 0.0, 2.0));
    assert!(hop.end.at.y.abs() < 1e-9 && hop.rest.at.y < -0.1, "{hop:?}");
}

/// Commands aimed short rest where they are meant to end: over level and tilted ground within a thousandth of the hop, over rough ground
/// never farther from it than the command that they replace, and on the whole much nearer.
#[test]
fn commands_aimed_short_rest_where_they_are_meant_to_end() {
    let mut draw = Draw::seeded(19);
    let (mut before_m, mut after_m) = (0.0, 0.0);
    for number in 0..200 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let restitution = Restitution::new(draw.uniform(0.1, 0.6), draw.uniform(0.0, 0.8), None).unwrap();
        let hopper = hopper(Some(restitution), 1e9);
        let rough_m = if number % 2 == 0 { 0.0 } else { 0.3 };
        let tilt = Vector2::new(draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3));
        let heights: Vec<f64> = (0..81 * 81).map(|_| draw.uniform(-rough_m, rough_m)).collect();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows and columns 0 to 80")]
        let rough = |x: f64, y: f64| heights[(x + 40.0).round() as usize + 81 * (y + 40.0).round() as usize];
        let ground = dem(81, 1.0, &hopper, gravity_m_s2, |x, y| tilt.x * x + tilt.y * y + rough(x, y));
        let away = draw.uniform(0.0, std::f64::consts::TAU);
        let length_m = draw.uniform(4.0, 12.0);
        let [from, to] = [0.0, length_m].map(|m| ground.position(MapPoint::new(m * away.cos(), m * away.sin())).unwrap());
        let Some(windows) = ground.windows(&from, &to).filter(|windows| !windows.lofts.is_empty()) else { continue };
        let steep = Arc::new(windows.sight, windows.lofts[0].lower.max(draw.uniform(0.9, 1.6)), gravity_m_s2);
        let command = Command::of_arc(&steep, Vector2::new(away.cos(), away.sin()), to);
        let short = resting_at(&ground, &from, command);
        let miss_m = |command: &Command<MapPosition>| {
            let hop = HopErrors::default().fly(&ground, &from, &command.liftoff, &command.aim);
            hop.failure.is_none().then_some((hop.rest.at - to.at).norm())
        };
        assert_eq!(short.rest, to);
        let Some(before) = miss_m(&command) else { continue };
        let after = miss_m(&short).unwrap();
        assert!(after <= before && (rough_m > 0.0 || after <= 1e-3 * length_m), "{number}: {after} of {before} m, {command:?}");
        (before_m, after_m) = (before_m + before, after_m + after);
    }
    assert!(after_m < 0.2 * before_m && before_m > 100.0, "{after_m} of {before_m} m");
    // Without bounces, the command itself.
    let ground = chain(&[(-9.0, 0.0), (90.0, 0.0)], &hopper(None, 9.0), 1.62, 1.0);
    let liftoff = LiftoffVelocity { heading: Vector2::x(), horizontal_m_s: 3.4, vertical_m_s: 3.4 };
    let command = Command::new(liftoff, station(&ground, 14.0));
    let same = resting_at(&ground, &station(&ground, 0.0), command);
    assert!(same.liftoff == command.liftoff && same.aim == command.aim);
}
