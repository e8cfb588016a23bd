//! The cone of a stance: prepared, and cut by the plane of a heading; beside a plain version that sums pyramids by brute force. The bounds of
//! spin and force, and the trunk along an arc. And whole stances of four limbs on a mesh of 47 733 triangles, which is read from a folder beside the
//! repository, beside a plain version that looks at every facet.
//!
//! `cargo bench --bench stance`. Compare lines of one run with each other: absolute times depend on the machine and its load. Arguments are
//! numbers of contacts. Half of the stances are on rough ground, half against a wall as well. The plain version forms all sums of two edges of
//! eight-edge pyramids that the plane parts, sorts them by angle, and takes the largest gap for the outside: its answer is narrower.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stderr, reason = "it says what it skips")]

use std::f64::consts::TAU;

use std::path::Path;

use chta::{
    ballistics::{
        BoxFlight,
        stance::{ConeKind, ConeSum, ContactCone, Foothold, Limb, PyramidEdges, greatest_force_n, least_spin_m2_s},
    },
    ground::{MeshContact, MeshGround, Pose, StanceGround, StandsUp},
    planner::roadmap::ContactSampler,
    quantity::SlopeInterval,
    scenario::read_robot,
    terrain::{MeshTree, read_mesh},
    world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};
use divan::{Bencher, black_box, counter::ItemsCount};
use nalgebra::{Point3, Rotation3, Vector2, Vector3};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

const STANCES: usize = 1_000;
const CONTACTS: [usize; 5] = [1, 2, 3, 4, 6];

fn main() {
    divan::main();
}

fn direction(random: &mut ChaCha8Rng) -> Vector3<f64> {
    let z: f64 = random.random_range(-1.0..1.0);
    let turn: f64 = random.random_range(0.0..TAU);
    let (sine, cosine) = libm::sincos(turn);
    Vector3::new(cosine, sine, 0.0) * (1.0 - z * z).sqrt() + Vector3::z() * z
}

/// Stances of so many contacts, each with a heading.
fn stances(contacts: usize) -> Vec<(Vec<ContactCone>, Vector2<f64>)> {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut stance = |wall: bool| {
        let cones = (0..contacts).map(|at| {
            let axis = if wall && at % 2 == 1 { Vector3::x() } else { Vector3::z() };
            let friction = FrictionCone::new(random.random_range(0.3..0.8)).expect("a friction");
            ContactCone::new((axis + direction(&mut random) * 0.4).normalize(), friction).expect("a contact")
        });
        let cones = cones.collect();
        let (sine, cosine) = libm::sincos(random.random_range(0.0..TAU));
        (cones, Vector2::new(cosine, sine))
    };
    (0..STANCES).map(|at| stance(at % 2 == 1)).collect()
}

/// Preparing the exact cone.
#[divan::bench(args = CONTACTS)]
fn prepare(bencher: Bencher<'_, '_>, contacts: usize) {
    let stances = stances(contacts);
    bencher
        .counter(ItemsCount::new(STANCES))
        .bench_local(|| stances.iter().filter(|(cones, _)| ConeSum::new(black_box(cones)).is_everything()).count());
}

/// Take-off slopes of a prepared cone.
fn cut_of(bencher: Bencher<'_, '_>, contacts: usize, kind: ConeKind) {
    let prepared: Vec<_> = stances(contacts).into_iter().map(|(cones, heading)| (kind.cone(&cones), heading)).collect();
    bencher
        .counter(ItemsCount::new(STANCES))
        .bench_local(|| prepared.iter().filter(|(cone, heading)| !black_box(cone).takeoff_slopes(*heading).is_empty()).count());
}

/// The cut of the exact sum.
#[divan::bench(args = CONTACTS)]
fn cut_exact(bencher: Bencher<'_, '_>, contacts: usize) {
    cut_of(bencher, contacts, ConeKind::Exact);
}

/// The cut of the one cone about the mean normal.
#[divan::bench(args = CONTACTS)]
fn cut_kc(bencher: Bencher<'_, '_>, contacts: usize) {
    cut_of(bencher, contacts, ConeKind::Kc);
}

/// The cut of the sum of eight-edge pyramids.
#[divan::bench(args = CONTACTS)]
fn cut_pyramid(bencher: Bencher<'_, '_>, contacts: usize) {
    cut_of(bencher, contacts, ConeKind::Pyramid(PyramidEdges::Eight));
}

/// The edges of the pyramids inscribed in the cones, for the plain version.
fn edges(cones: &[ContactCone]) -> Vec<Vector3<f64>> {
    let of_one = |cone: &ContactCone| {
        let (normal, mu) = (cone.normal(), cone.friction().coefficient());
        let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
        let second = normal.cross(&first);
        (0..8).map(move |edge| {
            let (sine, cosine) = libm::sincos(TAU * f64::from(edge) / 8.0);
            normal + (first * cosine + second * sine) * mu
        })
    };
    cones.iter().flat_map(of_one).collect()
}

/// The slopes ahead of the angles from the one side of the largest gap to the other.
fn plain_slopes(edges: &[Vector3<f64>], heading: Vector2<f64>, angles: &mut Vec<f64>) -> SlopeInterval {
    angles.clear();
    let across = |v: &Vector3<f64>| v.y * heading.x - v.x * heading.y;
    for (at, one) in edges.iter().enumerate() {
        for other in &edges[at + 1..] {
            let (left, right) = (across(one), across(other));
            if left * right < 0.0 {
                let ray = one * right.abs() + other * left.abs();
                angles.push(libm::atan2(ray.z, ray.x * heading.x + ray.y * heading.y));
            }
        }
    }
    angles.sort_unstable_by(f64::total_cmp);
    let (Some(first), Some(last)) = (angles.first(), angles.last()) else { return SlopeInterval::EMPTY };
    let (mut gap, mut low, mut high) = (first + TAU - last, *first, *last);
    for pair in angles.windows(2) {
        if pair[1] - pair[0] > gap {
            (gap, low, high) = (pair[1] - pair[0], pair[1] - TAU, pair[0]);
        }
    }
    let right = std::f64::consts::FRAC_PI_2;
    if gap < 2.0 * right {
        return SlopeInterval::ALL;
    }
    let slope = |angle: f64| if angle.abs() >= right { f64::INFINITY.copysign(angle) } else { libm::tan(angle) };
    SlopeInterval { lower: slope(low), upper: slope(high) }
}

/// The plain version, its edges prepared.
#[divan::bench(args = CONTACTS)]
fn cut_plain(bencher: Bencher<'_, '_>, contacts: usize) {
    let prepared: Vec<_> = stances(contacts).into_iter().map(|(cones, heading)| (edges(&cones), heading)).collect();
    let mut angles = Vec::new();
    bencher.counter(ItemsCount::new(STANCES)).bench_local(|| {
        prepared.iter().filter(|(edges, heading)| !plain_slopes(black_box(edges), *heading, &mut angles).is_empty()).count()
    });
}

/// The least spin of a take-off straight up.
#[divan::bench(args = CONTACTS, sample_count = 20, sample_size = 1)]
fn least_spin(bencher: Bencher<'_, '_>, contacts: usize) {
    let mut random = ChaCha8Rng::seed_from_u64(12);
    let mut foothold = |cone: &ContactCone| Foothold { cone: *cone, arm_m: direction(&mut random) - cone.normal() };
    let stances: Vec<Vec<Foothold>> =
        stances(contacts).iter().map(|(cones, _)| cones.iter().map(&mut foothold).collect()).collect();
    bencher.counter(ItemsCount::new(STANCES)).bench_local(|| {
        stances.iter().filter(|feet| least_spin_m2_s(black_box(feet), Vector3::z()).is_some_and(|spin| spin.lower > 0.0)).count()
    });
}

/// The largest force straight up of limbs of equal strength.
#[divan::bench(args = CONTACTS, sample_count = 20, sample_size = 1)]
fn greatest_force(bencher: Bencher<'_, '_>, contacts: usize) {
    let limb = |cone: &ContactCone| Limb::new(*cone, 50.0).expect("a force");
    let stances: Vec<Vec<Limb>> = stances(contacts).iter().map(|(cones, _)| cones.iter().map(limb).collect()).collect();
    bencher
        .counter(ItemsCount::new(STANCES))
        .bench_local(|| stances.iter().filter(|limbs| greatest_force_n(black_box(limbs), Vector3::z()).upper > 0.0).count());
}

/// A box along an arc against triangles of its own size around the arc: the times of contact.
#[divan::bench]
fn box_in_flight(bencher: Bencher<'_, '_>) {
    let mut random = ChaCha8Rng::seed_from_u64(13);
    let flight = BoxFlight {
        centre_m: Point3::origin(),
        velocity_m_s: Vector3::new(2.0, 1.0, 3.0),
        gravity_m_s2: 1.6,
        axes: Rotation3::from_euler_angles(0.1, 0.2, 0.3).into_inner(),
        half_extents_m: Vector3::new(0.3, 0.2, 0.1),
    };
    let triangles: Vec<[Point3<f64>; 3]> = (0..STANCES)
        .map(|_| {
            let time_s: f64 = random.random_range(0.0..3.75);
            let near = flight.centre_m + flight.velocity_m_s * time_s - Vector3::z() * (0.8 * time_s * time_s);
            let middle = near + direction(&mut random) * random.random_range(0.0..1.5);
            [(); 3].map(|()| middle + direction(&mut random) * 0.3)
        })
        .collect();
    bencher.counter(ItemsCount::new(STANCES)).bench_local(|| {
        triangles.iter().filter(|triangle| flight.contact_times(black_box(triangle), [0.0, 3.75]).first_s().is_some()).count()
    });
}

/// The desert of Campana and others 2016, and poses over it; `None` where it is absent.
fn desert() -> Option<(StanceGround, Vec<Pose>)> {
    let file = Path::new("../shared/limbs/scenes/desert_47733.stl");
    if !file.exists() {
        eprintln!("skipped: {} is absent", file.display());
        return None;
    }
    let mesh = MeshTree::new(read_mesh(file, 1.0).expect("a mesh").mesh);
    let friction = FrictionCone::new(0.8).expect("a friction");
    let surface = SurfaceProperties { grip: Some(Grip::Friction(friction)), rest: RestSlope::Unlimited };
    let hopper = Hopper::with_speeds(5.0, 5.0).expect("a hopper");
    let mesh = MeshGround::new(mesh, &hopper, Gravity::new(3.7).expect("a gravity"), &surface).expect("a ground");
    let robot = read_robot(Path::new("data/robots/four_legs.toml")).expect("the shipped robot").robot;
    let mut sampler = ContactSampler::new(&mesh, None, 0.0, 5).expect("facets");
    let contacts: Vec<MeshContact> = sampler.all_over(200, &|_| true);
    let ground = StanceGround::new(mesh.clone(), robot, ConeKind::Exact, StandsUp::Normal).expect("friction");
    let poses = contacts.iter().map(|contact| {
        let normal: Vector3<f64> = contact.facets().iter().map(|facet| facet.normal).sum();
        let up = ground.up_over(normal);
        Pose::facing(contact.point_m() + up * 0.2, up, Vector2::x())
    });
    let poses = poses.collect();
    Some((ground, poses))
}

/// Feet, cone and trunk of a robot with four limbs in 200 poses; how many of them stand is the same in each run.
#[divan::bench(sample_count = 20, sample_size = 1)]
fn stand_four_limbs(bencher: Bencher<'_, '_>) {
    let Some((ground, poses)) = desert() else { return };
    bencher
        .counter(ItemsCount::new(poses.len()))
        .bench_local(|| poses.iter().filter(|pose| ground.stand(**black_box(pose)).is_ok()).count());
}

/// The least that a search without a tree does: every facet is put into the trunk frame, and those whose middle a limb reaches are counted.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn stand_plain(bencher: Bencher<'_, '_>) {
    let Some((ground, poses)) = desert() else { return };
    let poses = &poses[..20];
    bencher.counter(ItemsCount::new(poses.len())).bench_local(|| {
        let reached = |pose: &Pose| {
            let mut found = 0;
            ground.mesh().tree().visit(
                |_, _| true,
                |_, corners| {
                    let middle =
                        Point3::from(corners.iter().map(|corner| pose.to_trunk(corner).coords).sum::<Vector3<f64>>() / 3.0);
                    found += ground.robot().limbs().iter().filter(|limb| limb.reaches(&middle)).count();
                },
            );
            found
        };
        poses.iter().map(|pose| reached(black_box(pose))).sum::<usize>()
    });
}
