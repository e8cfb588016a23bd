//! Stances of planted robots, each kind of refusal, hops of a trunk against flights in small steps, and a robot that is a point.

use nalgebra::{Point3, Vector2, Vector3};

use super::{flown_by_stances, path_over_stances};
use crate::{
    ballistics::{Arc, stance::ConeKind},
    draw::Draw,
    ground::{LimbOutcome, MeshBuffers, MeshGround, NoStance, Pose, Stance, StanceBuffers, StanceGround, StandsUp},
    planner::roadmap::tests::{boxes, ground, mesh_of},
    quantity::Angle,
    world::{Contact, FrictionCone, Limb, Limit, RestSlope, Robot, RobotDescription, Shell, TrunkBox, Workspace},
};

/// A floor of 8 m, seen from above.
fn floor() -> MeshGround {
    ground(mesh_of(&[[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 8.0, 0.0], [0.0, 8.0, 0.0]]]), 3.0, 0.8, 1.62)
}

fn limb(name: &str, hip: [f64; 3], radii_m: [f64; 2]) -> Limb {
    let shell = Shell::new(radii_m[0], radii_m[1], -Vector3::z_axis(), Angle::from_degrees(50.0));
    Limb::new(name, Point3::from(hip), Workspace::Shell(shell))
}

/// Four legs of 0.2 m to 0.4 m at the corners of a trunk of 0.6 m by 0.3 m by 0.2 m.
fn four_legs() -> RobotDescription {
    let hips = [
        ("front left", [0.3, 0.15, 0.0]),
        ("front right", [0.3, -0.15, 0.0]),
        ("hind left", [-0.3, 0.15, 0.0]),
        ("hind right", [-0.3, -0.15, 0.0]),
    ];
    let limbs = hips.iter().map(|(name, hip)| limb(name, *hip, [0.2, 0.4])).collect();
    let trunk = vec![TrunkBox::upright(Point3::origin(), Vector3::new(0.3, 0.15, 0.1))];
    RobotDescription { trunk, contacts_min: 4, ..RobotDescription::new("four legs", limbs) }
}

fn standing(mesh: MeshGround, robot: RobotDescription) -> StanceGround {
    StanceGround::new(mesh, Robot::new(robot).unwrap(), ConeKind::Exact, StandsUp::Normal).unwrap()
}

fn upright(x: f64, y: f64, z: f64) -> Pose {
    Pose::facing(Point3::new(x, y, z), Vector3::z(), Vector2::x())
}

#[test]
fn on_a_floor_the_cone_is_that_of_the_floor_and_the_feet_are_under_the_hips() {
    let ground = standing(floor(), four_legs());
    let stance = ground.stand(upright(4.0, 4.0, 0.3)).unwrap();
    assert_eq!(stance.outcomes(), [LimbOutcome::Stands; 4]);
    for foot in stance.footholds() {
        let hip = stance.pose().to_ground(&ground.robot().limbs()[foot.limb].hip_m);
        // The reach of a sector about the vertical is a disc about the hip.
        assert!(foot.point_m.z.abs() < 1e-12 && (foot.point_m - hip).xy().norm() < 0.05, "{foot:?}");
        assert!((foot.normal - Vector3::z()).norm() < 1e-12 && foot.spread.degrees() < 1e-6);
        // pi (0.3 tan 50)^2, cut off where the sector ends at 0.4 m from the hip: a radius of 0.265 m.
        assert!((foot.area_m2 - 0.22).abs() < 0.02, "{}", foot.area_m2);
    }
    let slopes = ground.allowed(&stance, Vector2::y(), Contact::Takeoff).slopes;
    assert!((slopes.lower - 1.25).abs() < 1e-9 && slopes.upper == f64::INFINITY);
    assert!(ground.rests_upright(&stance));
}

#[test]
fn each_kind_of_refusal_occurs() {
    let on_floor = standing(floor(), four_legs());
    let refusal = |x, y, z| on_floor.stand(upright(x, y, z)).unwrap_err();
    assert!(matches!(refusal(4.0, 4.0, 0.05), NoStance::Trunk(hit) if hit.part == 0));
    let NoStance::TooFewContacts { found, needed, limbs } = refusal(4.0, 4.0, 0.7) else { panic!() };
    assert!((found, needed) == (0, 4) && limbs.iter().all(|(_, outcome)| *outcome == LimbOutcome::NoGround));
    // Half over the edge: the front feet find no ground, and are named.
    let edge = refusal(8.0, 4.0, 0.3);
    assert!(edge.to_string().contains("2 of 4 feet stand, expected at least 4: front left reaches no ground"), "{edge}");
    // Under the floor every facet faces away.
    let below = on_floor.stand(Pose::facing(Point3::new(4.0, 4.0, -0.3), -Vector3::z(), Vector2::x())).unwrap_err();
    assert!(
        matches!(&below, NoStance::TooFewContacts { limbs, .. } if limbs.iter().all(|(_, o)| *o == LimbOutcome::FacesAway)),
        "{below}"
    );
    // All legs at one place.
    let same = RobotDescription { limbs: ["a", "b"].map(|name| limb(name, [0.0; 3], [0.2, 0.4])).to_vec(), ..four_legs() };
    let same = standing(floor(), RobotDescription { contacts_min: 2, ..same }).stand(upright(4.0, 4.0, 0.3)).unwrap_err();
    assert!(same.to_string().contains("b reaches only ground where another foot stands"), "{same}");
    // A shelf between hip and floor hides the floor, and its own upper side is out of reach: too near to the hip.
    let shelf = [[0.0, 0.0, 0.15], [8.0, 0.0, 0.15], [8.0, 8.0, 0.15], [0.0, 8.0, 0.15]];
    let quads = [[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 8.0, 0.0], [0.0, 8.0, 0.0]], shelf];
    let two_floors = ground(mesh_of(&quads), 3.0, 0.8, 1.62);
    let bare = RobotDescription { trunk: Vec::new(), ..four_legs() };
    let hidden = standing(two_floors, bare).stand(upright(4.0, 4.0, 0.3)).unwrap_err();
    assert!(
        matches!(&hidden, NoStance::TooFewContacts { limbs, .. } if limbs.iter().all(|(_, o)| *o == LimbOutcome::Hidden)),
        "{hidden}"
    );
    // Inside a closed body, and on a slope that is steeper than friction bears.
    let buried = ground_in_a_block().stand(upright(4.0, 4.0, 1.0)).unwrap_err();
    assert_eq!(buried, NoStance::InsideRock);
    let steep = Vector3::new(-0.8, 0.0, 0.6);
    let slope = mesh_of(&[[[0.0, 0.0, 0.0], [6.0, 0.0, 8.0], [6.0, 8.0, 8.0], [0.0, 8.0, 0.0]]]);
    let surface = crate::world::SurfaceProperties {
        grip: Some(crate::world::Grip::Friction(FrictionCone::new(0.8).unwrap())),
        rest: RestSlope::AsFrictionHolds,
    };
    let slope = floor_of(slope, &surface);
    let pose = Pose::facing(Point3::new(3.0, 4.0, 4.0) + steep * 0.3, steep, Vector2::y());
    assert_eq!(standing(slope, four_legs()).stand(pose).unwrap_err(), NoStance::Slips);
}

fn floor_of(mesh: crate::terrain::Mesh, surface: &crate::world::SurfaceProperties) -> MeshGround {
    let hopper = crate::world::Hopper::with_speeds(3.0, 3.0).unwrap();
    let gravity = crate::world::Gravity::new(1.62).unwrap();
    MeshGround::new(crate::terrain::MeshTree::new(mesh), &hopper, gravity, surface).unwrap()
}

fn ground_in_a_block() -> StanceGround {
    let quads = crate::planner::roadmap::tests::cuboid([2.0, 2.0, 0.0], [6.0, 6.0, 3.0]);
    standing(ground(mesh_of(&quads), 3.0, 0.8, 1.62), four_legs())
}

/// Random stances among boxes: the planned windows against the trunk flown in small steps, by arcs inside the windows and beside them.
#[test]
fn windows_of_the_trunk_are_free_and_none_is_missed_between_equal_poses() {
    let draw = &mut Draw::seeded(2020);
    let (mut flown, mut open, mut shut) = (0, 0, 0);
    let mut buffers = StanceBuffers::default();
    for _ in 0..6 {
        let ground = standing(ground(boxes(draw, 6), 4.0, 1.5, 1.62), RobotDescription { contacts_min: 2, ..four_legs() });
        let stances = some_stances(&ground, draw, 14);
        for from in &stances {
            for to in &stances {
                let Some((sight, lofts)) = ground.windows(from, to, &mut buffers) else { continue };
                let lofts = lofts.to_vec();
                let set = ground.takeoff_set(from, to).unwrap();
                assert_eq!(set.windows().iter().map(|window| window.lofts).collect::<Vec<_>>(), lofts);
                if lofts.is_empty() {
                    shut += 1;
                } else {
                    open += 1;
                }
                for window in lofts.iter().take(2) {
                    let loft = window.lower + (window.upper - window.lower) * draw.uniform(0.0, 1.0);
                    let arc = Arc::new(sight, loft, 1.62);
                    let path = path_over_stances(&ground, &[[from, to]], &[arc]).unwrap();
                    let faults = flown_by_stances(&ground, &[[from, to]], &path);
                    assert!(faults.is_empty(), "{faults:?}");
                    flown += 1;
                }
            }
        }
    }
    assert!(flown > 100 && open > 100 && shut > 100, "{flown} flown, {open} open, {shut} shut");
}

fn some_stances(ground: &StanceGround, draw: &mut Draw, count: usize) -> Vec<Stance> {
    let mut stances = Vec::new();
    while stances.len() < count {
        let at = Point3::new(draw.uniform(0.5, 7.5), draw.uniform(0.5, 7.5), draw.uniform(0.2, 3.0));
        let (sine, cosine) = libm::sincos(draw.uniform(-3.0, 3.0));
        stances.extend(ground.stand(Pose::facing(at, Vector3::z(), Vector2::new(cosine, sine))));
    }
    stances
}

/// One limb without a trunk, its foot at its root: contacts, windows and the set are those of a hopper without legs, to the last bit.
#[test]
fn a_robot_that_is_a_point_is_a_hopper_without_legs() {
    let draw = &mut Draw::seeded(8);
    let mesh = ground(boxes(draw, 8), 3.0, 0.9, 1.62);
    let legs = StanceGround::new(mesh.clone(), Robot::point("point"), ConeKind::Exact, StandsUp::Normal).unwrap();
    let (mut buffers, mut own) = (StanceBuffers::default(), MeshBuffers::default());
    let places: Vec<Point3<f64>> =
        (0..40).map(|_| Point3::new(draw.uniform(0.0, 8.0), draw.uniform(0.0, 8.0), draw.uniform(-0.5, 3.0))).collect();
    let contacts: Vec<_> = places.iter().filter_map(|at| mesh.contact(*at).ok()).collect();
    let mut open = 0;
    for from in &contacts {
        let stance = |contact: &crate::ground::MeshContact| legs.stand_over(contact, Vector3::z(), Vector2::x(), 0.0).unwrap();
        for to in &contacts {
            let (ours, theirs) = (stance(from), stance(to));
            let windows = legs.windows(&ours, &theirs, &mut buffers).map(|(sight, lofts)| (sight, lofts.to_vec()));
            let plain = mesh.windows(from, to, &mut own).map(|(sight, lofts)| (sight, lofts.to_vec()));
            assert_eq!(windows, plain);
            open += usize::from(plain.is_some_and(|(_, lofts)| !lofts.is_empty()));
            assert_eq!(legs.takeoff_set(&ours, &theirs), mesh.takeoff_set(from, to));
        }
    }
    assert!(open > 50, "{open} open");
}

/// The limits of a push narrow windows by name: what they leave they allow, and beyond a moved end they refuse.
#[test]
fn strokes_forces_and_spin_narrow_windows_by_name() {
    let strong = |force_max_n| {
        let limbs = four_legs().limbs.into_iter().map(|limb| Limb { force_max_n: Some(force_max_n), ..limb }).collect();
        RobotDescription { limbs, mass_kg: Some(5.0), inertia_kg_m2: Some([0.05; 3]), stroke_m: Some(0.1), ..four_legs() }
    };
    let cases = [
        (strong(400.0), None),
        (strong(14.0), Some(Limit::Force)),
        (
            RobotDescription { spin_max_rad_s: Some(0.0), centre_of_mass_m: Point3::new(0.5, 0.0, 0.0), ..strong(400.0) },
            Some(Limit::Spin),
        ),
    ];
    for (robot, limit) in cases {
        let ground = standing(floor(), robot);
        let [from, to] = [1.5, 4.2].map(|x| ground.stand(upright(x, 4.0, 0.3)).unwrap());
        let plain = standing(floor(), four_legs());
        let whole = plain.takeoff_set(&from, &to).unwrap();
        let set = ground.takeoff_set(&from, &to).unwrap();
        let Some(window) = set.windows().first() else {
            assert!(limit.is_some(), "the plain limits leave a window");
            assert!(
                matches!(set.conflict(), Some(crate::ground::MeshConflict::Limits(conflict)) if Some(conflict.counted_under()) == limit)
            );
            continue;
        };
        let heading = set.course().plane.heading;
        let refused = |loft: f64| ground.refuses_arc([&from, &to], heading, &Arc::new(set.course().sight, loft, 1.62));
        for share in [0.0, 0.3, 0.7, 1.0] {
            let loft = window.lofts.lower + (window.lofts.upper - window.lofts.lower) * share;
            assert_eq!(refused(loft), None, "{limit:?}");
        }
        let outer = whole.windows()[0].lofts;
        let moved = [window.lofts.lower > outer.lower, window.lofts.upper < outer.upper];
        for (moved, end) in moved.into_iter().zip([window.lower, window.upper]) {
            assert!(!moved || matches!(end.limit, Limit::Stroke | Limit::Force | Limit::Spin), "{end:?}");
        }
        assert!(limit.is_none() || moved.contains(&true), "{limit:?} leaves the whole window");
    }
}
