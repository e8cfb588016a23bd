//! The joints of the shipped robot with four legs: forward kinematics, virtual work, and how long feet reach their footholds.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its robot should stop")]

use std::path::Path;

use chta::{
    ballistics::stance::ConeKind,
    ground::{MeshGround, Pose, Stance, StanceGround, StandsUp},
    path::{PostureKind, StanceFlight, path_over_stances},
    robot_model::LimbChain,
    scenario::read_robot,
    terrain::{Mesh, MeshTree},
    world::{Contact, FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};
use nalgebra::{Point3, Vector2, Vector3};

use crate::support::Draw;

const G: f64 = 3.711;

/// A floor with a step across, in six triangles.
fn floor() -> Mesh {
    let rows = [(-20.0, 0.0), (2.0, 0.0), (2.4, 0.3), (20.0, 0.3)];
    let vertices = rows.iter().flat_map(|(x, z)| [Point3::new(*x, -20.0, *z), Point3::new(*x, 20.0, *z)]).collect();
    let triangles = (0..3).flat_map(|row| [[2 * row, 2 * row + 2, 2 * row + 3], [2 * row, 2 * row + 3, 2 * row + 1]]).collect();
    Mesh::new(vertices, triangles).unwrap()
}

fn ground() -> StanceGround {
    let file = read_robot(&Path::new(env!("CARGO_MANIFEST_DIR")).join("data/robots/four_legs.toml")).unwrap();
    assert!(file.chains.iter().all(Option::is_some) && file.warnings.is_empty(), "{:?}", file.warnings);
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.8).unwrap())), rest: RestSlope::AsFrictionHolds };
    let hopper = Hopper::with_speeds(5.2, 5.2).unwrap();
    let mesh = MeshGround::new(MeshTree::new(floor()), &hopper, Gravity::new(G).unwrap(), &surface).unwrap();
    StanceGround::new(mesh, file.robot, ConeKind::Exact, StandsUp::Vertical).unwrap().with_chains(file.chains)
}

fn stance(ground: &StanceGround, at: [f64; 3], heading: f64) -> Stance {
    let (sine, cosine) = heading.sin_cos();
    ground.stand(Pose::facing(Point3::from(at), Vector3::z(), Vector2::new(cosine, sine))).unwrap()
}

#[test]
fn joints_put_the_feet_on_their_footholds() {
    let ground = ground();
    let draw = &mut Draw::seeded(41);
    let mut feet = 0;
    for _ in 0..60 {
        let stance =
            stance(&ground, [draw.uniform(-10.0, 0.0), draw.uniform(-5.0, 5.0), draw.uniform(0.18, 0.26)], draw.uniform(0.0, 6.2));
        let reach = ground.joint_reach([&stance]);
        assert_eq!((reach.stances, reach.feet), (1, stance.footholds().len()));
        let mut refuted = 0;
        for foot in stance.footholds() {
            let verdict = ground.joints_at(stance.pose(), foot.limb, &foot.point_m).unwrap();
            let chain = ground.chain(foot.limb).unwrap();
            let points = chain.points(&verdict.positions);
            assert_eq!((points.len(), points[0]), (4, ground.robot().limbs()[foot.limb].hip_m));
            // Upper and lower leg have their length in every posture.
            assert!(points.windows(2).skip(1).all(|pair| ((pair[1] - pair[0]).norm() - 0.16).abs() < 1e-12));
            assert_eq!(*points.last().unwrap(), chain.foot(&verdict.positions));
            let away_m = (stance.pose().to_ground(points.last().unwrap()) - foot.point_m).norm();
            assert!((away_m - verdict.error_m).abs() < 1e-9, "{away_m} {verdict:?}");
            assert_eq!(verdict.reached, away_m <= 1e-3 * chain.length_m());
            assert!(
                chain.joints().iter().zip(&verdict.positions).all(|(joint, at)| (joint.range[0]..=joint.range[1]).contains(at))
            );
            refuted += usize::from(!verdict.reached);
            feet += 1;
        }
        assert_eq!(reach.feet_refuted, refuted);
    }
    assert!(feet > 200, "{feet}");
}

/// The work of the torques over a small motion of the joints is the opposite of that of the ground's force on the foot.
fn works(chain: &LimbChain, positions: &[f64], force: Vector3<f64>, efforts: &[f64]) {
    for joint in 0..positions.len() {
        let step = 1e-6;
        let mut moved = positions.to_vec();
        moved[joint] += step;
        let mut back = positions.to_vec();
        back[joint] -= step;
        let work = force.dot(&(chain.foot(&moved) - chain.foot(&back))) / (2.0 * step);
        assert!((work + efforts[joint]).abs() < 1e-6 * (1.0 + force.norm()), "joint {joint}: {work} {efforts:?}");
    }
}

#[test]
fn the_forces_at_rest_bear_the_weight_and_their_torques_do_its_work() {
    let ground = ground();
    let weight_n = 7.9 * G;
    for heading in [0.0, 0.7, 2.0] {
        let stance = stance(&ground, [-3.0, 0.4, 0.22], heading);
        let rest = ground.rest(&stance).unwrap();
        let sum: Vector3<f64> = rest.iter().map(|push| push.force_n).sum();
        assert!((sum - Vector3::z() * weight_n).norm() < 1e-6 * weight_n, "{sum}");
        let back = stance.pose().turn.inverse();
        for push in &rest {
            let foot = stance.footholds().iter().find(|foot| foot.limb == push.limb).unwrap();
            let (chain, found) =
                (ground.chain(push.limb).unwrap(), ground.joints_at(stance.pose(), push.limb, &foot.point_m).unwrap());
            works(chain, &found.positions, back * push.force_n, &push.efforts);
            let share = push.efforts.iter().map(|effort| effort.abs() / 40.0).fold(0.0, f64::max);
            assert!((push.effort_share.unwrap() - share).abs() < 1e-12 && push.rate_share.is_none());
        }
        // A push of twice the speed: the part of the force beside the weight is four times as large.
        let total = |speed: f64| -> Vector3<f64> {
            ground.push(&stance, Vector3::new(0.0, 0.6, 0.8) * speed).unwrap().iter().map(|push| push.force_n).sum()
        };
        let (slow, fast) = (total(1.0) - Vector3::z() * weight_n, total(2.0) - Vector3::z() * weight_n);
        assert!((fast - slow * 4.0).norm() < 1e-5 * fast.norm() && (slow.norm() - 7.9 / (2.0 * 0.2)).abs() < 1e-4, "{slow} {fast}");
    }
}

#[test]
fn feet_reach_their_footholds_for_as_long_as_samples_say() {
    let ground = ground();
    let ends = [stance(&ground, [-1.0, 0.0, 0.2], 0.3), stance(&ground, [3.6, 0.8, 0.52], 0.9)];
    let mut buffers = chta::ground::StanceBuffers::default();
    let (sight, windows) = ground.windows(&ends[0], &ends[1], &mut buffers).unwrap();
    let loft = windows[0].lower.midpoint(windows[0].upper.min(windows[0].lower + 2.0));
    let arc = chta::ballistics::Arc::new(sight, loft, G);
    let path = path_over_stances(&ground, &[[&ends[0], &ends[1]]], &[arc]).unwrap();
    let flight = StanceFlight::new(&ground, [&ends[0], &ends[1]], &path.hops[0]);
    let time_s = path.hops[0].flight_time_s;
    // The ends are the stances, and the velocity between two instants that of the push.
    let [push, stop] = flight.pushes_m_s();
    assert_eq!(flight.pose_at(0.0).root_m, ends[0].pose().root_m);
    assert!((flight.pose_at(time_s - 1e-9).root_m - ends[1].pose().root_m).norm() < 1e-6);
    assert!(((flight.pose_at(1e-6).root_m - ends[0].pose().root_m) / 1e-6 - push).norm() < 1e-4);
    assert!((stop.norm() - path.hops[0].landing_speed_m_s).abs() < 1e-9);
    for (contact, stance) in [(Contact::Takeoff, &ends[0]), (Contact::Landing, &ends[1])] {
        for foot in flight.foot_times(contact) {
            let point = stance.footholds().iter().find(|known| known.limb == foot.limb).unwrap().point_m;
            let reaches = |since_s: f64| {
                let at_s = if contact == Contact::Takeoff { since_s } else { time_s - since_s };
                ground.foot_reaches(&flight.pose_at(at_s), foot.limb, &point)
            };
            let step_s = 2e-4;
            let mut sampled_s = 0.0;
            while reaches(sampled_s + step_s) && sampled_s < time_s {
                sampled_s += step_s;
            }
            assert!((foot.reaches_for_s - sampled_s).abs() < 0.02, "{contact:?} {foot:?} {sampled_s}");
            assert!(foot.way_m <= 0.75 && foot.way_m >= 0.0);
        }
    }
    let postures = flight.postures();
    assert_eq!(postures.clone().map(|posture| posture.kind), PostureKind::ALL);
    assert!(postures.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s), "{postures:?}");
    assert!((postures[2].time_s - push.z / G).abs() < 1e-12 && postures[2].feet.is_empty());
    assert!(!postures[0].feet.is_empty() && !postures[1].feet.is_empty() && !postures[3].feet.is_empty());
}
