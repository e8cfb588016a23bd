//! Windows of hops over meshes against the windows of a DEM, against arcs that are flown facet by facet, and against closed forms.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its mesh should stop")]

use chta::{
    ballistics::Arc,
    ground::{DemGround, MeshBuffers, MeshConflict, MeshContact, MeshGround, MeshTakeoffSet, Windows},
    quantity::{Angle, MapPoint},
    terrain::{Dem, GeoReference, Mesh, MeshTree, OverlaidDem, Overlays},
    world::{ClearanceRule, FrictionCone, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties},
};
use nalgebra::{Point3, Rotation3, Vector3};

use crate::support::Draw;

/// Corners and triangles under construction.
#[derive(Clone, Default)]
struct Shape {
    corners: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
}

impl Shape {
    fn polygon(&mut self, corners: &[[f64; 3]]) {
        let first = u32::try_from(self.corners.len()).unwrap();
        self.corners.extend(corners.iter().map(|corner| Point3::from(*corner)));
        let count = u32::try_from(corners.len()).unwrap();
        self.triangles.extend((1..count - 1).map(|i| [first, first + i, first + i + 1]));
    }

    /// A closed box, turned about its middle, its outer sides outwards; walls thinner than nothing are turned inside out.
    fn cuboid(&mut self, middle: Point3<f64>, half: Vector3<f64>, turn: Rotation3<f64>) {
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
    fn sheet(&mut self, draw: &mut Draw, cells: u32, size_m: f64, heights: [f64; 2], faces_up: bool) {
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

    fn mesh(self) -> Mesh {
        Mesh::new(self.corners, self.triangles).unwrap()
    }
}

/// A random scene: rough ground, boxes that overlap, plates, sometimes a ceiling over all.
fn scene(draw: &mut Draw) -> Shape {
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

fn surface(friction: f64) -> SurfaceProperties {
    SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(friction).unwrap())), rest: RestSlope::Unlimited }
}

fn ground(mesh: Mesh, limits: HopperLimits, gravity_m_s2: f64, surface: &SurfaceProperties) -> MeshGround {
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
fn contact(ground: &MeshGround, draw: &mut Draw) -> Option<MeshContact> {
    let at = Point3::new(draw.uniform(-8.0, 8.0), draw.uniform(-8.0, 8.0), draw.uniform(-2.0, 7.0));
    ground.contact(at).ok()
}

/// Every arc inside a window flies free, and every arc that other limits allow outside of them hits a facet.
#[test]
fn windows_are_the_arcs_that_fly_free() {
    let draw = &mut Draw::seeded(1801);
    let (mut free, mut hits, mut several, mut doubtful) = (0, 0, 0, 0);
    for _ in 0..200 {
        let gravity_m_s2 = draw.log_uniform(1e-5, 25.0);
        let speed_m_s = draw.uniform(0.8, 3.0) * f64::sqrt(10.0 * gravity_m_s2);
        let friction = draw.log_uniform(0.3, 3.0);
        let mesh = scene(draw).mesh();
        let ground = ground(mesh, HopperLimits::with_speeds(speed_m_s, 2.0 * speed_m_s), gravity_m_s2, &surface(friction));
        let mut buffers = MeshBuffers::default();
        for _ in 0..30 {
            let (Some(from), Some(to)) = (contact(&ground, draw), contact(&ground, draw)) else { continue };
            let Some(set) = ground.takeoff_set(&from, &to) else { continue };
            let (sight, quick) = ground.windows(&from, &to, &mut buffers).unwrap();
            let slow: Vec<_> = set.windows().iter().map(|window| window.lofts).collect();
            assert_eq!((sight, quick), (set.course().sight, slow.as_slice()));
            several += u32::from(slow.len() > 1);
            let Ok((all, _)) = limits_but_terrain(&set) else { continue };
            for _ in 0..40 {
                let share = draw.uniform(0.01, 0.99);
                let upper = all[1].min(all[0] + 50.0);
                let loft = all[0] + share * (upper - all[0]);
                let margin = 1e-6 * (1.0 + loft);
                let near_end = set.windows().iter().any(|window| {
                    (window.lofts.lower - loft).abs() < margin || (window.lofts.upper - loft).abs() < margin
                });
                let inside = set.windows().iter().any(|window| window.lofts.contains(loft));
                let arc = Arc::new(sight, loft, gravity_m_s2);
                match flown(&ground, &from, &to, &arc, gravity_m_s2) {
                    _ if near_end => {}
                    Flown::Doubtful => doubtful += 1,
                    Flown::Free => {
                        free += 1;
                        assert!(inside, "{loft} {set:?} {from:?} {to:?}");
                    }
                    Flown::Hits(facet) => {
                        hits += 1;
                        assert!(!inside, "{loft} hits {facet} {set:?} {from:?} {to:?}");
                    }
                }
            }
        }
    }
    eprintln!("{free} free, {hits} hits, {several} pairs with several windows, {doubtful} doubtful");
    assert!(free > 1000 && hits > 1000 && several > 20 && doubtful < (free + hits) / 10);
}

/// The interval of lofts that all limits but the terrain leave.
fn limits_but_terrain(set: &MeshTakeoffSet) -> Result<([f64; 2], usize), ()> {
    let mut all = [0.0_f64, f64::INFINITY];
    for limit in set.limits() {
        all = [all[0].max(limit.lofts.lower), all[1].min(limit.lofts.upper)];
    }
    if all[0] < all[1] { Ok((all, set.limits().len())) } else { Err(()) }
}
