//! A workspace that is a convex polyhedron.

use std::collections::HashMap;

use nalgebra::{Point3, Unit, Vector3};

use super::{TrunkBounds, hull::hull_triangles};

/// The faces of a hull whose corners are within this share of its size of one plane count as one face. Meshes store single
/// precision, which moves corners by 6e-8 of their coordinates; a larger value would blunt workspaces that are curved.
const FLAT_SHARE: f64 = 1.0e-6;

/// The points `p` with `normal . p <= offset_m`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// The direction out of it.
    pub normal: Unit<Vector3<f64>>,
    /// The distance of its plane from the root along the normal, m.
    pub offset_m: f64,
}

impl HalfSpace {
    /// How far a point is outside, m; below 0 inside.
    #[inline]
    pub fn outside_m(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&point.coords) - self.offset_m
    }
}

/// A convex polyhedron in the trunk frame.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexWorkspace {
    half_spaces: Vec<HalfSpace>,
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[usize; 3]>,
    bounds: TrunkBounds,
    volume_m3: f64,
    mesh_share: f64,
    open_edges: usize,
}

/// Points whose hull has no volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidHull {
    /// All lie in one plane, to a millionth of their extent.
    #[error("its {points} points enclose no volume, expected points that do not all lie in one plane")]
    Flat {
        /// How many points there are.
        points: usize,
    },
    /// A coordinate is not a number.
    #[error("its point {point} has a coordinate that is not finite, expected finite coordinates")]
    NotFinite {
        /// Which point, counted from 0.
        point: usize,
    },
    /// A triangle names a point that does not exist.
    #[error("its triangle {triangle} has a corner beyond the last point, expected indices of points from 0")]
    NoCorner {
        /// Which triangle, counted from 0.
        triangle: usize,
    },
}

impl ConvexWorkspace {
    /// The convex hull of points in the trunk frame, m.
    ///
    /// # Errors
    /// [`InvalidHull`] if the points enclose no volume or one is not finite.
    ///
    /// # Examples
    /// ```
    /// use chta::world::ConvexWorkspace;
    /// use nalgebra::Point3;
    /// let corners: Vec<_> = (0..8).map(|i| Point3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
    /// let cube = ConvexWorkspace::hull_of(&corners)?;
    /// assert_eq!((cube.half_spaces().len(), cube.vertices().len(), cube.volume_m3()), (6, 8, 1.0));
    /// assert!(cube.contains(&Point3::new(1.0, 0.5, 0.5)) && !cube.contains(&Point3::new(1.01, 0.5, 0.5)));
    /// assert!(ConvexWorkspace::hull_of(&corners[..4]).is_err());
    /// # Ok::<(), chta::world::InvalidHull>(())
    /// ```
    pub fn hull_of(points: &[Point3<f64>]) -> Result<Self, InvalidHull> {
        if let Some(point) = points.iter().position(|point| !point.iter().all(|number| number.is_finite())) {
            return Err(InvalidHull::NotFinite { point });
        }
        let flat = InvalidHull::Flat { points: points.len() };
        let triangles = hull_triangles(points).ok_or(flat)?;
        let (vertices, triangles) = used(points, &triangles);
        let bounds = bounds_of(&vertices);
        let size = (bounds[1] - bounds[0]).amax();
        let half_spaces = faces(&vertices, &triangles, FLAT_SHARE * size);
        let thickness = |half_space: &HalfSpace| -vertices.iter().map(|v| half_space.outside_m(v)).fold(f64::INFINITY, f64::min);
        if half_spaces.iter().map(thickness).fold(f64::INFINITY, f64::min) <= FLAT_SHARE * size {
            return Err(flat);
        }
        let volume_m3 = volume(&vertices, &triangles, &vertices[0]);
        Ok(Self { half_spaces, vertices, triangles, bounds, volume_m3, mesh_share: 1.0, open_edges: 0 })
    }

    /// The convex hull of a mesh, which remembers how much of it the mesh encloses.
    ///
    /// # Arguments
    /// `triangles`: three indices of points each, in either orientation as long as it is one.
    ///
    /// # Errors
    /// As [`hull_of`](Self::hull_of), and for indices beyond the points.
    pub fn of_mesh(points: &[Point3<f64>], triangles: &[[u32; 3]]) -> Result<Self, InvalidHull> {
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| corner as usize);
        if let Some(triangle) = triangles.iter().position(|t| corners(t).iter().any(|&corner| corner >= points.len())) {
            return Err(InvalidHull::NoCorner { triangle });
        }
        let mut hull = Self::hull_of(points)?;
        let triangles: Vec<_> = triangles.iter().map(corners).collect();
        hull.mesh_share = volume(points, &triangles, &middle(&hull.vertices)).abs() / hull.volume_m3;
        hull.open_edges = open_edges(points, &triangles);
        Ok(hull)
    }

    /// Its faces as half-spaces: the workspace is their intersection.
    #[inline]
    pub fn half_spaces(&self) -> &[HalfSpace] {
        &self.half_spaces
    }

    /// Its corners.
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.vertices
    }

    /// Its surface as triangles of [`vertices`](Self::vertices), counterclockwise seen from outside.
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// Its volume, m^3.
    pub const fn volume_m3(&self) -> f64 {
        self.volume_m3
    }

    /// The share of its volume that the mesh encloses of which it is the hull: 1 of a convex mesh, less of one with dents.
    ///
    /// Of a mesh with holes, it is the share that its triangles cover seen from the middle of the hull's corners.
    pub const fn mesh_share(&self) -> f64 {
        self.mesh_share
    }

    /// How many edges of that mesh have no triangle on their other side, or one of the opposite orientation: 0 if it is closed.
    pub const fn open_edges(&self) -> usize {
        self.open_edges
    }

    /// Whether a point of the trunk frame lies in it, its surface included.
    #[inline]
    pub fn contains(&self, point: &Point3<f64>) -> bool {
        self.half_spaces.iter().all(|half_space| half_space.outside_m(point) <= 0.0)
    }

    /// The smallest axis-parallel box around it.
    #[inline]
    pub const fn bounds(&self) -> TrunkBounds {
        self.bounds
    }

    /// The distance of its farthest point from a point, m.
    pub fn farthest_m(&self, from: &Point3<f64>) -> f64 {
        self.vertices.iter().map(|vertex| (vertex - from).norm()).fold(0.0, f64::max)
    }
}

/// The points that triangles use, and the triangles over them.
fn used(points: &[Point3<f64>], triangles: &[[usize; 3]]) -> (Vec<Point3<f64>>, Vec<[usize; 3]>) {
    let mut places = HashMap::new();
    let mut vertices = Vec::new();
    let mut place = |corner: usize| {
        *places.entry(corner).or_insert_with(|| {
            vertices.push(points[corner]);
            vertices.len() - 1
        })
    };
    let triangles = triangles.iter().map(|triangle| triangle.map(&mut place)).collect();
    (vertices, triangles)
}

/// The mean of points.
#[expect(clippy::cast_precision_loss, reason = "counts of points")]
fn middle(points: &[Point3<f64>]) -> Point3<f64> {
    Point3::from(points.iter().map(|point| point.coords).sum::<Vector3<f64>>() / points.len() as f64)
}

fn bounds_of(vertices: &[Point3<f64>]) -> TrunkBounds {
    let first = vertices.first().copied().unwrap_or_default();
    vertices.iter().fold([first, first], |[low, high], vertex| [low.inf(vertex), high.sup(vertex)])
}

/// The half-spaces of the triangles of a hull, larger triangles first, without those whose corners lie within a distance of a plane that is
/// already there. Each is moved out until it holds every vertex.
fn faces(vertices: &[Point3<f64>], triangles: &[[usize; 3]], flat_m: f64) -> Vec<HalfSpace> {
    let normal = |triangle: &[usize; 3]| {
        let [a, b, c] = triangle.map(|corner| vertices[corner]);
        (b - a).cross(&(c - a))
    };
    let mut by_area: Vec<_> = triangles.iter().map(|triangle| (normal(triangle), triangle)).collect();
    by_area.sort_by(|(a, _), (b, _)| b.norm_squared().total_cmp(&a.norm_squared()));
    let mut found: Vec<HalfSpace> = Vec::new();
    for (normal, triangle) in by_area {
        let known = |half_space: &HalfSpace| triangle.iter().all(|&corner| half_space.outside_m(&vertices[corner]) >= -flat_m);
        if normal.norm_squared() > 0.0 && !found.iter().any(known) {
            let normal = Unit::new_normalize(normal);
            let offset_m = vertices.iter().map(|vertex| normal.dot(&vertex.coords)).fold(f64::NEG_INFINITY, f64::max);
            found.push(HalfSpace { normal, offset_m });
        }
    }
    found
}

/// The volume that triangles enclose, by the divergence theorem, m^3: `sum (a - o) . ((b - o) x (c - o)) / 6`. That of a closed surface does not
/// depend on `o`. Below 0 if the surface is inside out.
fn volume(points: &[Point3<f64>], triangles: &[[usize; 3]], from: &Point3<f64>) -> f64 {
    let tetrahedron = |triangle: &[usize; 3]| {
        let [a, b, c] = triangle.map(|corner| points[corner] - from);
        a.dot(&b.cross(&c))
    };
    triangles.iter().map(tetrahedron).sum::<f64>() / 6.0
}

/// How many directed edges are not met by as many of the opposite direction. Points at the same place count as one.
fn open_edges(points: &[Point3<f64>], triangles: &[[usize; 3]]) -> usize {
    // Adding 0 makes -0 the same as 0.
    let place = |corner: usize| [0, 1, 2].map(|axis| (points[corner][axis] + 0.0).to_bits());
    let mut balance: HashMap<_, isize> = HashMap::new();
    for [a, b, c] in triangles.iter().map(|triangle| triangle.map(place)) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (key, sign) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
            *balance.entry(key).or_default() += if from == to { 0 } else { sign };
        }
    }
    balance.values().map(|count| count.unsigned_abs()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    fn cloud(draw: &mut Draw, count: usize, scale: f64) -> Vec<Point3<f64>> {
        (0..count).map(|_| Point3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)) * scale).collect()
    }

    /// Whether each edge of the surface has one triangle on either side.
    fn closed(hull: &ConvexWorkspace) -> bool {
        let edges = hull.triangles.len() * 3 / 2;
        open_edges(&hull.vertices, &hull.triangles) == 0 && hull.vertices.len() + hull.triangles.len() == edges + 2
    }

    /// Planes through three points with all points on one side, by trying all triples.
    fn brute_force(points: &[Point3<f64>]) -> Vec<HalfSpace> {
        let mut found: Vec<HalfSpace> = Vec::new();
        for i in 0..points.len() {
            for j in 0..i {
                for k in 0..j {
                    let normal = (points[j] - points[i]).cross(&(points[k] - points[i]));
                    for normal in [normal, -normal] {
                        let normal = Unit::new_normalize(normal);
                        let offset_m = normal.dot(&points[i].coords);
                        if points.iter().all(|p| normal.dot(&p.coords) <= offset_m + 1e-12) {
                            found.push(HalfSpace { normal, offset_m });
                        }
                    }
                }
            }
        }
        found
    }

    #[test]
    fn the_hull_of_random_points_has_the_planes_of_brute_force() {
        let mut draw = Draw::seeded(11);
        for case in 0..60 {
            let points = cloud(&mut draw, 4 + case % 14, 1.0);
            let hull = ConvexWorkspace::hull_of(&points).unwrap();
            let expected = brute_force(&points);
            assert!(closed(&hull));
            assert_eq!(hull.half_spaces.len(), expected.len(), "case {case}");
            for plane in &hull.half_spaces {
                let same = |other: &HalfSpace| {
                    (plane.normal.dot(&other.normal) - 1.0).abs() < 1e-9 && (plane.offset_m - other.offset_m).abs() < 1e-9
                };
                assert!(expected.iter().any(same), "case {case}: {plane:?}");
            }
        }
    }

    /// Points on a lattice give many in one plane and on one line; the volume of the hull is that of brute force over cells.
    #[test]
    fn many_points_in_one_plane_give_one_face() {
        let grid = |n: u32| {
            let at = move |i: u32| f64::from(i) / f64::from(n - 1);
            (0..n * n * n).map(move |i| Point3::new(at(i % n), 2.0 * at(i / n % n), 3.0 * at(i / n / n)))
        };
        for n in [2, 3, 7] {
            let points: Vec<_> = grid(n).collect();
            let hull = ConvexWorkspace::hull_of(&points).unwrap();
            assert_eq!((hull.half_spaces.len(), hull.volume_m3), (6, 6.0), "{n}");
            assert!(closed(&hull));
            // Turned and rounded to single precision, it still has six faces.
            let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1);
            #[expect(clippy::cast_possible_truncation, reason = "as STL files store it")]
            let rounded: Vec<_> = points.iter().map(|point| (turn * point).map(|x| f64::from(x as f32))).collect();
            let hull = ConvexWorkspace::hull_of(&rounded).unwrap();
            assert_eq!(hull.half_spaces.len(), 6, "{n}");
            assert!((hull.volume_m3 - 6.0).abs() < 1e-5 && closed(&hull));
        }
    }

    #[test]
    fn a_hull_contains_its_points_and_no_point_beyond() {
        let mut draw = Draw::seeded(12);
        for case in 0..40 {
            let scale = [1e-3, 1.0, 1e4][case % 3];
            let points = cloud(&mut draw, 200, scale);
            let hull = ConvexWorkspace::hull_of(&points).unwrap();
            let size = 2.0 * scale;
            let outside =
                |point: &Point3<f64>| hull.half_spaces.iter().map(|h| h.outside_m(point)).fold(f64::NEG_INFINITY, f64::max);
            assert!(hull.vertices.iter().all(|vertex| hull.contains(vertex)));
            assert!(points.iter().all(|point| outside(point) <= 1e-8 * size));
            // The mean of random points is inside, a vertex moved away from it is not.
            let middle = middle(&hull.vertices);
            assert!(hull.contains(&middle));
            assert!(hull.vertices.iter().all(|vertex| !hull.contains(&(vertex + (vertex - middle) * 1e-3))));
        }
    }

    /// The volume against the share of random points in the box that are inside.
    #[test]
    fn the_volume_agrees_with_random_points() {
        let mut draw = Draw::seeded(13);
        let points = cloud(&mut draw, 30, 1.0);
        let hull = ConvexWorkspace::hull_of(&points).unwrap();
        let inside = cloud(&mut draw, 40_000, 1.0).iter().filter(|point| hull.contains(point)).map(|_| 1.0).sum::<f64>();
        let estimate = 8.0 * inside / 40_000.0;
        assert!((estimate - hull.volume_m3).abs() < 0.08, "{estimate} against {}", hull.volume_m3);
    }

    #[test]
    fn points_without_volume_are_refused() {
        let mut draw = Draw::seeded(14);
        let turn = nalgebra::Rotation3::from_euler_angles(0.2, 0.5, -1.3);
        let plane: Vec<_> = cloud(&mut draw, 50, 1.0).iter().map(|p| turn * Point3::new(p.x, p.y, 0.0)).collect();
        let line: Vec<_> = plane.iter().map(|p| Point3::from(Vector3::new(1.0, 2.0, 3.0) * p.x)).collect();
        let nearly: Vec<_> = cloud(&mut draw, 50, 1.0).iter().map(|p| turn * Point3::new(p.x, p.y, 1e-8 * p.z)).collect();
        for points in [&plane[..], &line, &nearly, &plane[..1], &[], &[plane[0]; 9]] {
            let refused = ConvexWorkspace::hull_of(points);
            assert_eq!(refused.unwrap_err(), InvalidHull::Flat { points: points.len() });
        }
        let mut points = plane;
        points[7].y = f64::NAN;
        assert_eq!(ConvexWorkspace::hull_of(&points), Err(InvalidHull::NotFinite { point: 7 }));
    }

    #[test]
    fn a_mesh_states_its_share_of_the_hull_and_its_open_edges() {
        let cube: Vec<_> = (0..8).map(|i| Point3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
        let hull = ConvexWorkspace::hull_of(&cube).unwrap();
        let surface: Vec<[u32; 3]> = hull.triangles.iter().map(|t| t.map(|corner| u32::try_from(corner).unwrap())).collect();
        let whole = ConvexWorkspace::of_mesh(&hull.vertices, &surface).unwrap();
        assert!((whole.mesh_share() - 1.0).abs() < 1e-12 && whole.open_edges() == 0);
        // Inside out, it is the same workspace.
        let inside_out: Vec<_> = surface.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let turned = ConvexWorkspace::of_mesh(&hull.vertices, &inside_out).unwrap();
        assert!((turned.mesh_share() - 1.0).abs() < 1e-12 && turned.open_edges() == 0);
        // Without one of its twelve triangles, it is open by three edges.
        let open = ConvexWorkspace::of_mesh(&hull.vertices, &surface[1..]).unwrap();
        assert!((open.mesh_share() - 11.0 / 12.0).abs() < 1e-12 && open.open_edges() == 3);
        // A dent down to the middle of the face of one triangle: a tetrahedron of 1/12 less.
        let mut dented = hull.vertices.clone();
        dented.push(Point3::new(0.5, 0.5, 0.5));
        let [a, b, c] = surface[0];
        let dent = surface[1..].iter().copied().chain([[a, b, 8], [b, c, 8], [c, a, 8]]).collect::<Vec<_>>();
        let dented = ConvexWorkspace::of_mesh(&dented, &dent).unwrap();
        assert!((dented.mesh_share() - 11.0 / 12.0).abs() < 1e-12 && dented.open_edges() == 0 && dented.vertices.len() == 8);
        assert_eq!(ConvexWorkspace::of_mesh(&hull.vertices, &[[0, 1, 8]]), Err(InvalidHull::NoCorner { triangle: 0 }));
    }
}
