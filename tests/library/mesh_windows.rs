//! Windows of hops over meshes against the windows of a DEM, against arcs that are flown facet by facet, and against closed forms.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test that cannot build its mesh should stop, and says what it compared"
)]

use chta::{
    ballistics::Arc,
    ground::{DemGround, MeshBuffers, MeshConflict, MeshContact, MeshGround, MeshTakeoffSet, NoMeshContact, Windows},
    quantity::{AngleInterval, MapPoint},
    terrain::{Dem, GeoReference, Mesh, MeshTree, OverlaidDem, Overlays},
    world::{ClearanceRule, Contact, FrictionCone, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties},
};
use nalgebra::{Point3, Rotation3, Vector3};

use crate::support::Draw;

/// Corners and triangles under construction.
#[derive(Clone, Default)]
pub(crate) struct Shape {
    pub(crate) corners: Vec<Point3<f64>>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Shape {
    pub(crate) fn polygon(&mut self, corners: &[[f64; 3]]) {
        let first = u32::try_from(self.corners.len()).unwrap();
        self.corners.extend(corners.iter().map(|corner| Point3::from(*corner)));
        let count = u32::try_from(corners.len()).unwrap();
        self.triangles.extend((1..count - 1).map(|i| [first, first + i, first + i + 1]));
    }

    /// A closed box, turned about its middle, its outer sides outwards; walls thinner than nothing are turned inside out.
    pub(crate) fn cuboid(&mut self, middle: Point3<f64>, half: Vector3<f64>, turn: Rotation3<f64>) {
        let first = u32::try_from(self.corners.len()).unwrap();
        for i in 0..8 {
            let sign = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
            self.corners.push(middle + turn * Vector3::new(sign(1) * half.x, sign(2) * half.y, sign(4) * half.z));
        }
        for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            self.triangles.extend([[first + a, first + b, first + c], [first + a, first + c, first + d]]);
        }
    }

    /// Rough ground or, turned over, a rough ceiling: a grid of heights from -size to size.
    pub(crate) fn sheet(&mut self, draw: &mut Draw, cells: u32, size_m: f64, heights: [f64; 2], faces_up: bool) {
        let first = u32::try_from(self.corners.len()).unwrap();
        let at = |i: u32| size_m * (2.0 * f64::from(i) / f64::from(cells) - 1.0);
        for row in 0..=cells {
            for col in 0..=cells {
                self.corners.push(Point3::new(at(col), at(row), draw.uniform(heights[0], heights[1])));
            }
        }
        for row in 0..cells {
            for col in 0..cells {
                let corner = first + row * (cells + 1) + col;
                let [a, b, c, d] = [corner, corner + 1, corner + cells + 2, corner + cells + 1];
                let halves = if draw.chance(0.5) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                self.triangles.extend(halves.map(|[a, b, c]| if faces_up { [a, b, c] } else { [a, c, b] }));
            }
        }
    }

    pub(crate) fn mesh(self) -> Mesh {
        Mesh::new(self.corners, self.triangles).unwrap()
    }
}

/// A random scene: rough ground, boxes that overlap, plates, sometimes a ceiling over all.
pub(crate) fn scene(draw: &mut Draw) -> Shape {
    let mut shape = Shape::default();
    let (cells, rough_m) = (2 + u32::try_from(draw.below(9)).unwrap(), draw.log_uniform(0.01, 3.0));
    shape.sheet(draw, cells, 10.0, [-rough_m, rough_m], true);
    let turn = |draw: &mut Draw| match draw.below(3) {
        0 => Rotation3::identity(),
        1 => Rotation3::from_euler_angles(0.0, 0.0, draw.uniform(-3.0, 3.0)),
        _ => Rotation3::from_euler_angles(draw.uniform(-3.0, 3.0), draw.uniform(-3.0, 3.0), draw.uniform(-3.0, 3.0)),
    };
    for _ in 0..draw.below(12) {
        let middle = Point3::new(draw.uniform(-8.0, 8.0), draw.uniform(-8.0, 8.0), draw.uniform(-1.0, 6.0));
        let half = Vector3::new(draw.log_uniform(0.01, 3.0), draw.log_uniform(0.1, 4.0), draw.log_uniform(0.01, 2.0));
        let turn = turn(draw);
        shape.cuboid(middle, half, turn);
    }
    for _ in 0..draw.below(5) {
        let mut corner = || [draw.uniform(-9.0, 9.0), draw.uniform(-9.0, 9.0), draw.uniform(-1.0, 8.0)];
        let corners = [corner(), corner(), corner()];
        shape.polygon(&corners);
    }
    if draw.chance(0.4) {
        shape.sheet(draw, 6, 10.0, [3.0, 8.0], false);
    }
    shape
}

pub(crate) fn surface(friction: f64) -> SurfaceProperties {
    SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(friction).unwrap())), rest: RestSlope::Unlimited }
}

pub(crate) fn ground(mesh: Mesh, limits: HopperLimits, gravity_m_s2: f64, surface: &SurfaceProperties) -> MeshGround {
    let hopper = Hopper::new(limits).unwrap();
    MeshGround::new(MeshTree::new(mesh), &hopper, Gravity::new(gravity_m_s2).unwrap(), surface).unwrap()
}

/// What an arc does with the facets of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Flown {
    Free,
    Hits(usize),
    /// It comes too near to an edge or to tangency to say.
    Doubtful,
}

/// Flies an arc against every triangle in three dimensions: the roots of the parabola in the plane of each, and whether they lie inside.
fn flown(ground: &MeshGround, from: &MeshContact, to: &MeshContact, arc: &Arc, gravity_m_s2: f64) -> Flown {
    let away = to.point_m() - from.point_m();
    let time_s = arc.flight_time_s();
    let velocity = away / time_s + Vector3::new(0.0, 0.0, 0.5 * gravity_m_s2 * time_s);
    let at = |t: f64| from.point_m() + velocity * t - Vector3::new(0.0, 0.0, 0.5 * gravity_m_s2 * t * t);
    let mut doubtful = false;
    for (facet, corners) in ground.tree().mesh().triangles().enumerate() {
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
        // a t^2 + b t + c = 0
        let (a, b) = (-0.5 * gravity_m_s2 * normal.z, velocity.dot(&normal));
        let c = (from.point_m() - corners[0]).dot(&normal);
        let roots = {
            let discriminant = b * b - 4.0 * a * c;
            let flat = (a * time_s * time_s).abs() < 1e-13;
            if flat {
                [(-c / b), f64::NAN]
            } else if discriminant < 0.0 {
                [f64::NAN; 2]
            } else {
                let q = -0.5 * (b + discriminant.sqrt().copysign(b));
                [q / a, c / q]
            }
        };
        for t in roots.into_iter().filter(|t| t.is_finite()) {
            let share = t / time_s;
            if !(-1e-6..=1.0 + 1e-6).contains(&share) {
                continue;
            }
            let end = share.min(1.0 - share);
            let point = at(t);
            // The least of the three heights over the sides of the triangle.
            let inside = (0..3)
                .map(|i| {
                    let side = corners[(i + 1) % 3] - corners[i];
                    normal.cross(&side).normalize().dot(&(point - corners[i]))
                })
                .fold(f64::INFINITY, f64::min);
            let speed = (velocity - Vector3::new(0.0, 0.0, gravity_m_s2 * t)).dot(&normal).abs() * time_s;
            match (inside, end) {
                (inside, _) if inside < -1e-6 => {}
                // The contacts themselves lie on their facets.
                (_, end) if end < 1e-6 => {}
                (inside, end) if inside < 1e-6 || end < 1e-4 || speed < 1e-3 => doubtful = true,
                _ => return Flown::Hits(facet),
            }
        }
    }
    if doubtful { Flown::Doubtful } else { Flown::Free }
}

/// The contact of a random point, if it has one.
pub(crate) fn contact(ground: &MeshGround, draw: &mut Draw) -> Option<MeshContact> {
    let at = Point3::new(draw.uniform(-8.0, 8.0), draw.uniform(-8.0, 8.0), draw.uniform(-2.0, 7.0));
    ground.contact(at).ok()
}

/// How arcs compared with the windows.
#[derive(Default)]
struct Compared {
    free: u32,
    hits: u32,
    several: u32,
    doubtful: u32,
}

impl Compared {
    /// Every arc inside a window flies free, and every arc that other limits allow outside of them hits a facet: of so many pairs of contacts.
    fn on(&mut self, ground: &MeshGround, draw: &mut Draw, pairs: u32, contact: impl Fn(&mut Draw) -> Option<MeshContact>) {
        let gravity_m_s2 = ground.envelope().gravity_m_s2();
        let mut buffers = MeshBuffers::default();
        for _ in 0..pairs {
            let (Some(from), Some(to)) = (contact(draw), contact(draw)) else { continue };
            let Some(set) = ground.takeoff_set(&from, &to) else { continue };
            let (sight, quick) = ground.windows(&from, &to, &mut buffers).unwrap();
            let slow: Vec<_> = set.windows().iter().map(|window| window.lofts).collect();
            assert_eq!(quick, slow.as_slice());
            assert!(slow.is_empty() || sight == set.course().sight);
            self.several += u32::from(slow.len() > 1);
            let Ok((all, _)) = limits_but_terrain(&set) else { continue };
            for _ in 0..40 {
                let share = draw.uniform(0.01, 0.99);
                let upper = all[1].min(all[0] + 50.0);
                let loft = all[0] + share * (upper - all[0]);
                let margin = 1e-6 * (1.0 + loft);
                let near_end = set
                    .windows()
                    .iter()
                    .any(|window| (window.lofts.lower - loft).abs() < margin || (window.lofts.upper - loft).abs() < margin);
                let inside = set.windows().iter().any(|window| window.lofts.contains(loft));
                let arc = Arc::new(set.course().sight, loft, gravity_m_s2);
                match flown(ground, &from, &to, &arc, gravity_m_s2) {
                    _ if near_end => {}
                    Flown::Doubtful => self.doubtful += 1,
                    Flown::Free => {
                        self.free += 1;
                        assert!(inside, "{loft} {set:?} {from:?} {to:?}");
                    }
                    Flown::Hits(facet) => {
                        self.hits += 1;
                        assert!(!inside, "{loft} hits {facet} {set:?} {from:?} {to:?}");
                    }
                }
            }
        }
    }

    /// Says how many, and checks that there were enough.
    fn finish(&self, least: u32) {
        let Self { free, hits, several, doubtful } = self;
        eprintln!("{free} free, {hits} hits, {several} pairs with several windows, {doubtful} doubtful");
        assert!(*free > least && *hits > least && *doubtful < (free + hits) / 10);
    }
}

fn compare_with_flown_arcs(seed: u64, scenes: u32) {
    let draw = &mut Draw::seeded(seed);
    let mut compared = Compared::default();
    for _ in 0..scenes {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.uniform(0.8, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
        let friction = draw.log_uniform(0.3, 3.0);
        let mesh = scene(draw).mesh();
        let ground = ground(mesh, HopperLimits::with_speeds(speed_m_s, 2.0 * speed_m_s), gravity_m_s2, &surface(friction));
        compared.on(&ground, draw, 30, |draw| contact(&ground, draw));
    }
    compared.finish(5 * scenes);
    assert!(compared.several > scenes / 10, "{} with several windows", compared.several);
}

/// The published meshes, whose small facets meet at all angles: contacts in the middles of facets that are near to one another.
#[test]
fn windows_over_published_meshes_are_the_arcs_that_fly_free() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/mesh");
    for (file, speed_m_s, pairs) in
        [("scene_jump10.stl", 7.0, 4000), ("cave_mono_short_1.stl", 4.5, 1500), ("envir3d_1.stl", 6.8, 300)]
    {
        let path = folder.join(file);
        if !path.exists() {
            eprintln!("skipped: {} is absent", path.display());
            continue;
        }
        let mesh = chta::terrain::read_mesh(&path, 1.0).unwrap().mesh;
        let middles: Vec<Point3<f64>> = mesh
            .triangles()
            .map(|corners| Point3::from((corners[0].coords + corners[1].coords + corners[2].coords) / 3.0))
            .collect();
        let ground = ground(mesh, HopperLimits::with_speeds(speed_m_s, speed_m_s), 9.81, &surface(1.2));
        let mut compared = Compared::default();
        compared.on(&ground, &mut Draw::seeded(1808), pairs, |draw| ground.contact(middles[draw.below(middles.len())]).ok());
        compared.finish(20);
    }
}

#[test]
fn windows_are_the_arcs_that_fly_free() {
    compare_with_flown_arcs(1801, 280);
}

/// `cargo test --release --test library -- --ignored ten_million`, some minutes.
#[test]
#[ignore = "ten million arcs take minutes"]
fn windows_are_the_arcs_of_ten_million_that_fly_free() {
    compare_with_flown_arcs(1807, 27_000);
}

/// The least of the vertical distances of an arc to the surface, less the clearance there, over many points of the arc.
fn least_room_m(ground: &MeshGround, set: &MeshTakeoffSet, from: &MeshContact, loft: f64) -> f64 {
    let (course, profile) = (set.course(), ground.envelope().clearance());
    let run_m = course.sight.run_m();
    let triangles: Vec<_> = ground.tree().mesh().triangles().collect();
    let mut least = f64::INFINITY;
    for i in 1..600 {
        let d_m = run_m * f64::from(i) / 600.0;
        let at = from.point_m().xy() + course.plane.heading * d_m;
        let z_m = from.point_m().z + d_m * (course.sight.slope() + loft * (1.0 - d_m / run_m));
        for [a, b, c] in &triangles {
            let (ab, ac, ap) = (b.xy() - a.xy(), c.xy() - a.xy(), at - a.xy());
            let area = ab.perp(&ac);
            let (v, w) = (ap.perp(&ac) / area, ab.perp(&ap) / area);
            if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
                let surface_m = a.z + v * (b.z - a.z) + w * (c.z - a.z);
                least = least.min((z_m - surface_m).abs() - profile.at_m(d_m, run_m - d_m));
            }
        }
    }
    least
}

/// Over and under whatever there is, arcs inside the windows keep the tapered clearance, and arcs outside come nearer.
#[test]
fn windows_keep_the_clearance_over_and_under_all_facets() {
    let draw = &mut Draw::seeded(1805);
    let (mut kept, mut near, mut missed) = (0, 0, 0);
    for _ in 0..60 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.uniform(1.0, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
        let limits = HopperLimits {
            clearance_m: draw.log_uniform(0.02, 2.0),
            clearance_rule: if draw.chance(0.5) {
                ClearanceRule::TAPERED
            } else {
                ClearanceRule::Tapered(draw.log_uniform(0.1, 4.0))
            },
            ..HopperLimits::with_speeds(speed_m_s, 2.0 * speed_m_s)
        };
        let ground = ground(scene(draw).mesh(), limits, gravity_m_s2, &surface(draw.uniform(0.8, 3.0)));
        for _ in 0..12 {
            let (Some(from), Some(to)) = (contact(&ground, draw), contact(&ground, draw)) else { continue };
            let Some(set) = ground.takeoff_set(&from, &to) else { continue };
            let Ok((all, _)) = limits_but_terrain(&set) else { continue };
            for _ in 0..6 {
                let loft = draw.uniform(all[0], all[1].min(all[0] + 20.0));
                let margin = 1e-3 * (1.0 + loft);
                if set.windows().iter().any(|w| (w.lofts.lower - loft).abs() < margin || (w.lofts.upper - loft).abs() < margin) {
                    continue;
                }
                let room_m = least_room_m(&ground, &set, &from, loft);
                if set.windows().iter().any(|window| window.lofts.contains(loft)) {
                    kept += 1;
                    assert!(room_m > -1e-9, "{loft} {room_m} {set:?} {limits:?}");
                } else {
                    near += 1;
                    // Points of the arc beside a thin wall, and arcs that pass through the surface between two points.
                    missed += u32::from(room_m > 0.0);
                }
            }
        }
    }
    eprintln!("{kept} kept the clearance, {near} did not, {missed} of them between the points");
    assert!(kept > 200 && near > 500 && missed < near / 20);
}

/// The interval of lofts that all limits but the terrain leave.
pub(crate) fn limits_but_terrain(set: &MeshTakeoffSet) -> Result<([f64; 2], usize), ()> {
    let mut all = [0.0_f64, f64::INFINITY];
    for limit in set.limits() {
        all = [all[0].max(limit.lofts.lower), all[1].min(limit.lofts.upper)];
    }
    if all[0] < all[1] { Ok((all, set.limits().len())) } else { Err(()) }
}

/// A DEM as the triangles that its slices cut, faces up.
pub(crate) fn triangulated(dem: &Dem) -> Mesh {
    let mut shape = Shape::default();
    for row in 0..dem.rows() {
        for col in 0..dem.cols() {
            let at = dem.georeference().post(row, col);
            shape.corners.push(Point3::new(at.x, at.y, dem.elevation(row, col).unwrap()));
        }
    }
    for row in 0..dem.rows() - 1 {
        for col in 0..dem.cols() - 1 {
            let corner = |row: usize, col: usize| u32::try_from(row * dem.cols() + col).unwrap();
            let [north_west, south_east] = [corner(row, col), corner(row + 1, col + 1)];
            shape.triangles.push([north_west, corner(row + 1, col), south_east]);
            shape.triangles.push([north_west, south_east, corner(row, col + 1)]);
        }
    }
    shape.mesh()
}

/// Over a mesh that is a triangulated DEM, the windows are those of the DEM, under every rule of the clearance and every machine.
#[test]
fn a_mesh_that_is_a_triangulated_dem_has_the_windows_of_the_dem() {
    let draw = &mut Draw::seeded(1802);
    let (mut feasible, mut by_ground, mut refused, mut several) = (0, 0, 0, 0);
    for round in 0..120 {
        let relief_m = draw.log_uniform(0.05, 4.0);
        let heights = (0..14 * 12).map(|_| draw.uniform(0.0, relief_m)).collect();
        let north_west = MapPoint::new(draw.uniform(-1e4, 1e4), draw.uniform(-1e4, 1e4));
        let map = GeoReference::local(north_west, 1.0, draw.uniform(0.7, 1.5)).unwrap();
        let dem = Dem::new(14, 12, heights, map).unwrap();
        let gravity = Gravity::new(draw.log_uniform(1e-5, 25.0)).unwrap();
        let speed_m_s = draw.uniform(0.7, 2.5) * (8.0 * gravity.m_s2()).sqrt();
        let limits = HopperLimits {
            clearance_m: if draw.chance(0.3) { 0.0 } else { draw.log_uniform(0.01, 4.0) },
            clearance_rule: match draw.below(3) {
                0 => ClearanceRule::Vertex,
                1 => ClearanceRule::TAPERED,
                _ => ClearanceRule::Tapered(draw.log_uniform(0.1, 10.0)),
            },
            apex_height_max_m: draw.chance(0.2).then(|| draw.uniform(0.5, 4.0)),
            takeoff_speed_min_m_s: draw.chance(0.3).then_some(0.8 * speed_m_s),
            ..HopperLimits::with_speeds(speed_m_s, draw.uniform(0.8, 1.5) * speed_m_s)
        };
        let hopper = Hopper::new(limits).unwrap();
        let rest = if round % 2 == 0 { RestSlope::Unlimited } else { RestSlope::AsFrictionHolds };
        let angles = |min, max| AngleInterval::from_degrees(min, max);
        let grip = match draw.below(3) {
            0 => Grip::FromSlope { takeoff: angles(20.0, 110.0), landing: angles(-130.0, -15.0) },
            _ => Grip::Friction(FrictionCone::new(draw.log_uniform(0.4, 4.0)).unwrap()),
        };
        let surface = SurfaceProperties { grip: Some(grip), rest };
        let mesh = MeshGround::new(MeshTree::new(triangulated(&dem)), &hopper, gravity, &surface).unwrap();
        let bounds = dem.bounds();
        let dem = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, gravity, &surface);
        let mut buffers = MeshBuffers::default();
        for _ in 0..40 {
            let mut end = || {
                let share = nalgebra::Vector2::new(draw.uniform(0.01, 0.99), draw.uniform(0.01, 0.99));
                let position = dem.position(bounds.min + (bounds.max - bounds.min).component_mul(&share)).unwrap();
                let contact = mesh.contact(Point3::new(position.at.x, position.at.y, position.z_m)).unwrap();
                (position, contact)
            };
            let ((from, takeoff), (to, landing)) = (end(), end());
            let Some(of_dem) = dem.windows(&from, &to) else { continue };
            let (sight, of_mesh) = mesh.windows(&takeoff, &landing, &mut buffers).unwrap();
            assert!((sight.slope() - of_dem.sight.slope()).abs() < 1e-6 * (1.0 + sight.slope().abs()));
            assert_eq!(of_dem.lofts.len(), of_mesh.len(), "{of_dem:?} {of_mesh:?} {limits:?} {takeoff:?} {landing:?}");
            for (one, other) in of_dem.lofts.iter().zip(of_mesh) {
                let apart = (one.lower.max(0.0) - other.lower).abs().max((one.upper - other.upper).abs());
                assert!(apart < 1e-5 * (1.0 + one.upper.abs()), "{one:?} {other:?} {limits:?}");
            }
            feasible += usize::from(!of_mesh.is_empty());
            refused += usize::from(of_mesh.is_empty());
            several += usize::from(of_mesh.len() > 1);
            let set = mesh.takeoff_set(&takeoff, &landing).unwrap();
            by_ground += usize::from(set.windows().first().is_some_and(|window| window.lower.limit == Limit::Terrain));
        }
    }
    eprintln!("{feasible} feasible, {by_ground} by ground, {refused} refused, {several} in several windows");
    assert!(feasible > 500 && by_ground > 200 && refused > 500 && several > 20);
}

/// A flat floor and whatever stands on it.
pub(crate) fn on_a_floor(build: impl FnOnce(&mut Shape)) -> Shape {
    let mut shape = Shape::default();
    shape.polygon(&[[-5.0, -5.0, 0.0], [15.0, -5.0, 0.0], [15.0, 5.0, 0.0], [-5.0, 5.0, 0.0]]);
    build(&mut shape);
    shape
}

/// The set between the points at x = 0 and 10 m of the floor, with a friction and speeds that leave nearly everything.
pub(crate) fn across(shape: Shape, clearance_m: f64) -> MeshTakeoffSet {
    let limits = HopperLimits { clearance_m, ..HopperLimits::with_speeds(1e3, 1e3) };
    let ground = ground(shape.mesh(), limits, 9.81, &surface(100.0));
    let [from, to] = [0.0, 10.0].map(|x| ground.contact(Point3::new(x, 0.3, 0.0)).unwrap());
    ground.takeoff_set(&from, &to).unwrap()
}

pub(crate) fn ends(set: &MeshTakeoffSet) -> Vec<[f64; 2]> {
    set.windows().iter().map(|window| [window.lofts.lower, window.lofts.upper]).collect()
}

/// Closed forms by hand, over 10 m: an arc of loft n is n d e / 10 high.
#[test]
fn planted_obstacles_have_the_windows_that_are_worked_out_by_hand() {
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * (1.0 + b.abs());
    // A ceiling 3 m high over all: n < 3 * 4 / 10 in its middle.
    let ceiling = on_a_floor(|shape| {
        shape.polygon(&[[-5.0, -5.0, 3.0], [-5.0, 5.0, 3.0], [15.0, 5.0, 3.0], [15.0, -5.0, 3.0]]);
    });
    let set = across(ceiling.clone(), 0.0);
    assert!(set.windows().len() == 1 && close(ends(&set)[0][1], 1.2), "{:?}", ends(&set));
    assert_eq!(set.windows()[0].upper.limit, Limit::Terrain);
    assert!(set.windows()[0].upper.facet.is_some_and(|facet| facet.index() >= 2));
    // With 0.5 m kept under it, and over the floor at least the slope k = 0.5 at the kink, 1 m from either end: 0.5 * 10 / 9.
    let set = across(ceiling, 0.5);
    assert!(close(ends(&set)[0][0], 0.5 / 0.9) && close(ends(&set)[0][1], 1.0), "{:?}", ends(&set));
    // A wall across the middle with a slot from 1 to 2 m: n from 0.4 to 0.8, and over its top of 4 m, n > 1.6.
    let slot = on_a_floor(|shape| {
        shape.polygon(&[[5.0, -5.0, 0.0], [5.0, 5.0, 0.0], [5.0, 5.0, 1.0], [5.0, -5.0, 1.0]]);
        shape.polygon(&[[5.0, -5.0, 2.0], [5.0, 5.0, 2.0], [5.0, 5.0, 4.0], [5.0, -5.0, 4.0]]);
    });
    let set = across(slot, 0.0);
    let found = ends(&set);
    assert!(found.len() == 2 && close(found[0][0], 0.4) && close(found[0][1], 0.8) && close(found[1][0], 1.6), "{found:?}");
    // A closed beam 2 m wide, from 2 to 3 m high, from 4 to 6 m: under its near edge at 2 m, n < 2 * 10 / 25 in its middle; over its
    // edges at 3 m, n > 3 * 10 / 24.
    let beam = on_a_floor(|shape| {
        shape.cuboid(Point3::new(5.0, 0.0, 2.5), Vector3::new(1.0, 9.0, 0.5), Rotation3::identity());
    });
    let found = ends(&across(beam, 0.0));
    assert!(found.len() == 2 && close(found[0][1], 0.8) && close(found[1][0], 1.25), "{found:?}");
    // A slanted roof, from height 1 over the take-off to 4 over the landing: n < (sqrt 1 + sqrt 4)^2 / 10.
    let roof = on_a_floor(|shape| shape.polygon(&[[0.0, -5.0, 1.0], [0.0, 5.0, 1.0], [10.0, 5.0, 4.0], [10.0, -5.0, 4.0]]));
    let found = ends(&across(roof, 0.0));
    assert!(found.len() == 1 && close(found[0][1], 0.9), "{found:?}");
    // A room closed on all sides: a wall from the floor to the ceiling leaves nothing, and the conflict says what blocks.
    let closed = on_a_floor(|shape| {
        shape.polygon(&[[-5.0, -5.0, 3.0], [-5.0, 5.0, 3.0], [15.0, 5.0, 3.0], [15.0, -5.0, 3.0]]);
        shape.polygon(&[[7.0, -5.0, 0.0], [7.0, 5.0, 0.0], [7.0, 5.0, 3.0], [7.0, -5.0, 3.0]]);
    });
    let set = across(closed, 0.0);
    assert!(set.windows().is_empty());
    assert!(matches!(set.conflict(), Some(MeshConflict::Terrain { gap_deg: None, .. })), "{:?}", set.conflict());
}

/// A wall that only a slot of no width divides leaves no window.
#[test]
fn a_slot_of_no_width_is_no_window() {
    let shape = on_a_floor(|shape| {
        shape.polygon(&[[5.0, -5.0, 0.0], [5.0, 5.0, 0.0], [5.0, 5.0, 1.0], [5.0, -5.0, 1.0]]);
        shape.polygon(&[[5.0, -5.0, 1.0], [5.0, 5.0, 1.0], [5.0, 5.0, 2.0], [5.0, -5.0, 2.0]]);
    });
    let found = ends(&across(shape, 0.0));
    assert!(found.len() == 1 && (found[0][0] - 0.8).abs() < 1e-12, "{found:?}");
}

/// The set of arcs does not depend on where the mesh lies, how it is turned about the vertical, in which order its triangles are, or which
/// way those turn that no contact lies on.
#[test]
fn windows_do_not_depend_on_place_order_heading_or_the_winding_of_obstacles() {
    let draw = &mut Draw::seeded(1803);
    let mut compared = 0;
    for _ in 0..60 {
        let shape = scene(draw);
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.uniform(1.0, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
        let limits = HopperLimits {
            clearance_m: if draw.chance(0.5) { 0.0 } else { 0.05 },
            ..HopperLimits::with_speeds(speed_m_s, speed_m_s)
        };
        let friction = surface(draw.uniform(0.5, 3.0));
        let turn = Rotation3::from_euler_angles(0.0, 0.0, draw.uniform(-3.0, 3.0));
        let shift = Vector3::new(draw.uniform(-1e3, 1e3), draw.uniform(-1e3, 1e3), draw.uniform(-1e2, 1e2));
        let moved = |point: Point3<f64>| turn * point + shift;
        let mut other = shape.clone();
        other.corners.iter_mut().for_each(|corner| *corner = moved(*corner));
        for i in (1..other.triangles.len()).rev() {
            other.triangles.swap(i, draw.below(i + 1));
            other.triangles[i].rotate_left(draw.below(3));
        }
        let (first, second) =
            (ground(shape.mesh(), limits, gravity_m_s2, &friction), ground(other.clone().mesh(), limits, gravity_m_s2, &friction));
        for _ in 0..25 {
            let (Some(from), Some(to)) = (contact(&first, draw), contact(&first, draw)) else { continue };
            let [Ok(from_there), Ok(to_there)] = [&from, &to].map(|contact| second.contact(moved(contact.point_m()))) else {
                continue;
            };
            let Some(set) = first.takeoff_set(&from, &to) else { continue };
            let other_set = second.takeoff_set(&from_there, &to_there).unwrap();
            let (here, there) = (ends(&set), ends(&other_set));
            let is_narrow = here.iter().chain(&there).any(|[lower, upper]| upper - lower < 1e-6 * (1.0 + upper));
            if here.len() != there.len() && is_narrow {
                continue;
            }
            assert_eq!(here.len(), there.len(), "{here:?} {there:?}");
            for (one, other) in here.iter().flatten().zip(there.iter().flatten()) {
                assert!((one - other).abs() < 1e-6 * (1.0 + one.abs()), "{here:?} {there:?}");
            }
            compared += usize::from(!here.is_empty());
            // Turned round, facets away from the contacts block the same.
            let mut turned = other.clone();
            let stood_on: Vec<usize> = from_there.facets().iter().chain(to_there.facets()).map(|facet| facet.id.index()).collect();
            for (i, corners) in turned.triangles.iter_mut().enumerate().filter(|(i, _)| !stood_on.contains(i)) {
                if i % 2 == 0 {
                    corners.swap(0, 1);
                }
            }
            if compared % 10 == 1 {
                let turned = ground(turned.mesh(), limits, gravity_m_s2, &friction);
                if let [Ok(from), Ok(to)] = [&from_there, &to_there].map(|contact| turned.contact(contact.point_m())) {
                    let set = turned.takeoff_set(&from, &to).unwrap();
                    assert_eq!(set.windows().len(), other_set.windows().len());
                    for (one, other) in set.windows().iter().zip(other_set.windows()) {
                        assert_eq!((one.lower, one.upper), (other.lower, other.upper));
                        let apart = (one.lofts.lower - other.lofts.lower).abs().max((one.lofts.upper - other.lofts.upper).abs());
                        assert!(apart < 1e-6 * (1.0 + other.lofts.upper), "{one:?} {other:?}");
                    }
                }
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

/// The cones of contacts are those of vectors in three dimensions: walls, ceilings and facets that meet at edges and corners.
#[test]
fn contacts_hold_where_every_facet_holds_the_velocity() {
    let draw = &mut Draw::seeded(1804);
    let (mut held, mut slid, mut overhanging, mut met) = (0, 0, 0, 0);
    for _ in 0..250 {
        let mesh = scene(draw).mesh();
        let friction = draw.log_uniform(0.2, 3.0);
        let ground = ground(mesh, HopperLimits::with_speeds(1e3, 1e3), 9.81, &surface(friction));
        for _ in 0..20 {
            let at_corner = draw.chance(0.3);
            let pick = |draw: &mut Draw| {
                if !at_corner {
                    return contact(&ground, draw);
                }
                let corners = ground.tree().mesh().vertices();
                ground.contact(corners[draw.below(corners.len())]).ok()
            };
            let (Some(from), Some(to)) = (pick(draw), pick(draw)) else { continue };
            let Some(course) = ground.course(&from, &to) else { continue };
            let heading = course.plane.heading;
            let sight = course.sight;
            let loft = draw.log_uniform(1e-2, 1e2);
            let along = |slope: f64| Vector3::new(heading.x, heading.y, slope).normalize();
            let leaves = along(sight.slope() + loft);
            let arrives = -along(sight.slope() - loft);
            for (contact, kind, velocity, slope) in
                [(&from, Contact::Takeoff, leaves, sight.slope() + loft), (&to, Contact::Landing, arrives, sight.slope() - loft)]
            {
                let cosine = 1.0 / (1.0 + friction * friction).sqrt();
                let least = contact.facets().iter().map(|facet| velocity.dot(&facet.normal) - cosine).fold(f64::INFINITY, f64::min);
                if least.abs() < 1e-6 {
                    continue;
                }
                let allowed = ground.allowed(contact, heading, kind).is_ok_and(|limits| limits.slopes.contains(slope));
                assert_eq!(allowed, least > 0.0, "{contact:?} {kind:?} {slope}");
                held += usize::from(allowed);
                slid += usize::from(!allowed);
                overhanging += usize::from(allowed && contact.facets().iter().any(|facet| facet.normal.z <= 0.0));
                met += usize::from(allowed && contact.facets().len() > 1);
            }
        }
    }
    eprintln!("{held} held, {slid} slid, {overhanging} on overhangs, {met} where facets meet");
    assert!(held > 500 && slid > 500 && overhanging > 20 && met > 20);
}

/// Points inside rock, and surface inside other bodies, give no contact; points in the air are moved.
#[test]
fn buried_points_are_refused_and_others_are_moved_to_the_surface() {
    let shape = on_a_floor(|shape| {
        shape.cuboid(Point3::new(5.0, 0.0, 1.0), Vector3::new(1.0, 1.0, 2.0), Rotation3::from_euler_angles(0.0, 0.0, 0.3));
        shape.cuboid(Point3::new(5.5, 0.2, 2.0), Vector3::new(1.0, 1.0, 0.5), Rotation3::identity());
    });
    let ground = ground(shape.mesh(), HopperLimits::with_speeds(5.0, 5.0), 9.81, &surface(1.0));
    assert_eq!(ground.tree().body_counts(), [3, 2, 0]);
    let error = |x, y, z| ground.contact(Point3::new(x, y, z)).unwrap_err();
    assert!(matches!(error(5.0, 0.0, 0.5), NoMeshContact::InsideRock { .. }), "inside the block");
    // The floor under the block.
    assert!(matches!(error(4.9, 0.05, -1e-4), NoMeshContact::Covered { .. }));
    // The top of the second block is open; the part of the first that sticks in it is not.
    assert!((ground.contact(Point3::new(5.5, 0.2, 7.0)).unwrap().point_m().z - 3.0).abs() < 1e-12);
    let moved = ground.contact(Point3::new(1.0, 2.0, 0.25)).unwrap();
    assert_eq!((moved.point_m(), moved.moved_m()), (Point3::new(1.0, 2.0, 0.0), 0.25));
    assert!(matches!(error(f64::NAN, 0.0, 0.0), NoMeshContact::NoPoint { .. }));
    // A body inside out is counted, and open sheets bury nothing.
    let mut inverted = Shape::default();
    inverted.cuboid(Point3::new(0.0, 0.0, 0.0), Vector3::new(-1.0, 1.0, 1.0), Rotation3::identity());
    assert_eq!(MeshTree::new(inverted.mesh()).body_counts(), [1, 1, 1]);
}
