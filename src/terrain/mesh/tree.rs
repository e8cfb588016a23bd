//! A mesh with a tree of boxes over its triangles: cut by a vertical plane, nearest point, and crossings of a vertical ray.

use std::{ops::ControlFlow, sync::Arc};

use nalgebra::{Point3, Unit, Vector2, Vector3};

use super::{Mesh, SlabPolygon, bodies::Bodies, model::normal_of};
use crate::quantity::{ChainPoint, FacetId, MapPoint};

/// The most triangles of a leaf.
const LEAF: usize = 4;

/// The depth of the stack of a traversal. The halves of every split are equal to one triangle: 2^31 triangles have a depth of 31.
const DEPTH: usize = 64;

/// Points of a mesh closer than this share of its size are one point: far above the rounding errors of its coordinates, and a
/// hundredth of a millimetre on ten kilometres.
const RESOLUTION: f64 = 1.0e-9;

/// An axis-parallel box.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cuboid {
    min: Point3<f64>,
    max: Point3<f64>,
}

impl Cuboid {
    const EMPTY: Self = Self {
        min: Point3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        max: Point3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    fn include(&mut self, point: Point3<f64>) {
        self.min = self.min.inf(&point);
        self.max = self.max.sup(&point);
    }

    /// Whether the two have a point in common.
    fn meets(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis])
    }

    /// The square of the distance to a point.
    fn squared_distance_m2(&self, point: Point3<f64>) -> f64 {
        let outside = (self.min - point).sup(&(point - self.max)).sup(&Vector3::zeros());
        outside.norm_squared()
    }
}

/// A node: its box, and either its two children, or the triangles of a leaf.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Cuboid,
    /// Of a leaf the first triangle; else the second child. The first child is the next node.
    at: u32,
    /// Of a leaf the number of its triangles; else 0.
    count: u32,
}

/// A mesh with a tree of boxes over its triangles. It shares its mesh.
#[derive(Clone, Debug)]
pub struct MeshTree {
    mesh: Arc<Mesh>,
    nodes: Vec<Node>,
    /// The triangles in the order of the leaves.
    order: Vec<u32>,
    /// Their corners, in the same order.
    corners: Vec<[Point3<f64>; 3]>,
    resolution_m: f64,
    bodies: Bodies,
}

/// The vertical plane through a point, towards a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerticalPlane {
    /// The point at which distances and heights in the plane are 0.
    pub origin: Point3<f64>,
    /// The horizontal direction, of length 1.
    pub heading: Vector2<f64>,
}

impl VerticalPlane {
    /// A point in the plane: the horizontal distance from the origin along the heading, and the height over it.
    #[inline]
    pub fn along(&self, point: Point3<f64>) -> ChainPoint {
        let away = point - self.origin;
        ChainPoint::new(away.x * self.heading.x + away.y * self.heading.y, away.z)
    }

    /// How far a point lies to the left of the plane, m.
    #[inline]
    pub(super) fn left_m(&self, point: Point3<f64>) -> f64 {
        let away = point - self.origin;
        self.heading.x * away.y - self.heading.y * away.x
    }

    /// A point in the frame of the plane: ahead along the heading, to the left, and up, m from the origin.
    #[inline]
    pub fn framed(&self, point: Point3<f64>) -> Vector3<f64> {
        self.turned(point - self.origin)
    }

    /// A direction in the frame of the plane: ahead, to the left, and up.
    #[inline]
    pub fn turned(&self, direction: Vector3<f64>) -> Vector3<f64> {
        let (east, north) = (self.heading.x, self.heading.y);
        Vector3::new(east * direction.x + north * direction.y, east * direction.y - north * direction.x, direction.z)
    }

    /// The rectangle of the plane, from the least to the greatest distance and height, in which a box meets it; `None` if they do not
    /// meet. The rectangle of the whole box, not only of the part that meets the plane.
    #[inline]
    fn across(&self, bounds: &Cuboid, margin_m: f64) -> Option<[ChainPoint; 2]> {
        let middle = nalgebra::center(&bounds.min, &bounds.max) - self.origin;
        let half = 0.5 * (bounds.max - bounds.min);
        let (east, north) = (self.heading.x.abs(), self.heading.y.abs());
        let left_m = self.heading.x * middle.y - self.heading.y * middle.x;
        if left_m.abs() > half.x * north + half.y * east + margin_m {
            return None;
        }
        let along_m = self.heading.x * middle.x + self.heading.y * middle.y;
        let reach_m = half.x * east + half.y * north + margin_m;
        Some([
            ChainPoint::new(along_m - reach_m, middle.z - half.z - margin_m),
            ChainPoint::new(along_m + reach_m, middle.z + half.z + margin_m),
        ])
    }
}

/// The point of a mesh that is nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestOnMesh {
    /// The point.
    pub point: Point3<f64>,
    /// A triangle that it lies on.
    pub facet: FacetId,
    /// How far away it is, m.
    pub distance_m: f64,
}

impl MeshTree {
    /// The tree of a mesh.
    pub fn new(mesh: impl Into<Arc<Mesh>>) -> Self {
        let mesh = mesh.into();
        let all: Vec<[Point3<f64>; 3]> = mesh.triangles().collect();
        let middles: Vec<Point3<f64>> = all.iter().map(|[a, b, c]| Point3::from((a.coords + b.coords + c.coords) / 3.0)).collect();
        // A mesh has fewer than 2^32 vertices in its file, and its readers fewer triangles.
        let mut order: Vec<u32> = (0..=u32::MAX).take(all.len()).collect();
        let mut nodes = Vec::with_capacity(2 * all.len() / LEAF + 1);
        split(&all, &middles, &mut order, 0, &mut nodes);
        let corners = order.iter().map(|facet| all[*facet as usize]).collect();
        let whole = nodes[0].bounds;
        let farthest_m = whole.min.coords.amax().max(whole.max.coords.amax());
        let resolution_m = (RESOLUTION * (whole.max - whole.min).amax()).max(32.0 * f64::EPSILON * farthest_m);
        let bodies = Bodies::of(&mesh);
        Self { mesh, nodes, order, corners, resolution_m, bodies }
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Points of the mesh closer than this are one point, m.
    pub const fn resolution_m(&self) -> f64 {
        self.resolution_m
    }

    /// The corners of a triangle.
    pub fn corners(&self, facet: FacetId) -> [Point3<f64>; 3] {
        self.mesh.indices()[facet.index()].map(|corner| self.mesh.vertices()[corner as usize])
    }

    /// The normal of a triangle, of length 1, from the order of its corners: counter-clockwise seen from its tip.
    pub fn normal(&self, facet: FacetId) -> Unit<Vector3<f64>> {
        Unit::new_normalize(normal_of(self.corners(facet)))
    }

    /// Cuts the mesh by a vertical plane: visits the segments in which triangles meet it, in no particular order, until the visitor
    /// breaks.
    ///
    /// `enters` is asked for the rectangle of the plane that a part of the mesh lies in, by its lowest and highest corner; a part that it
    /// refuses is left out. A triangle gives one segment; a point, twice, where a corner alone lies in the plane; its three edges where
    /// it lies in the plane as a whole.
    ///
    /// Two triangles that share an edge meet the plane in the same point of it, to the last bit: the cut of a closed surface has no gap.
    pub fn cut(
        &self,
        plane: &VerticalPlane,
        mut enters: impl FnMut([ChainPoint; 2]) -> bool,
        mut visit: impl FnMut(FacetId, [ChainPoint; 2]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.walk(
            |bounds| plane.across(bounds, self.resolution_m).is_some_and(&mut enters),
            |facet, corners| cut_triangle(plane, corners, self.resolution_m, |segment| visit(facet, segment)),
        )
    }

    /// Visits the parts of triangles within a distance beside a vertical plane, seen along its normal, until the visitor breaks.
    ///
    /// `enters` as in [`cut`](Self::cut), for rectangles that are wider and higher by that distance on all sides.
    pub fn slab(
        &self,
        plane: &VerticalPlane,
        within_m: f64,
        mut enters: impl FnMut([ChainPoint; 2]) -> bool,
        mut visit: impl FnMut(FacetId, &SlabPolygon) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.walk(
            |bounds| plane.across(bounds, within_m + self.resolution_m).is_some_and(&mut enters),
            |facet, corners| match SlabPolygon::of(plane, corners, within_m) {
                Some(part) => visit(facet, &part),
                None => ControlFlow::Continue(()),
            },
        )
    }

    /// Visits the triangles of the leaves whose boxes come within a distance of a vertical plane, until the visitor breaks.
    ///
    /// `enters` as in [`slab`](Self::slab).
    pub fn beside(
        &self,
        plane: &VerticalPlane,
        within_m: f64,
        mut enters: impl FnMut([ChainPoint; 2]) -> bool,
        visit: impl FnMut(FacetId, &[Point3<f64>; 3]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.walk(|bounds| plane.across(bounds, within_m + self.resolution_m).is_some_and(&mut enters), visit)
    }

    /// The bodies of the mesh.
    pub(super) const fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// Visits the triangles of the leaves whose boxes meet that of a triangle.
    pub(super) fn near_triangle(&self, triangle: &[Point3<f64>; 3], visit: impl FnMut(FacetId, &[Point3<f64>; 3])) {
        let mut around = Cuboid::EMPTY;
        for corner in triangle {
            around.include(*corner);
        }
        self.all_in(|bounds| bounds.meets(&around), visit);
    }

    /// The first triangle of the mesh, in its order, that a straight line from one point to another passes through and that does not touch
    /// the first point.
    pub fn crossed(&self, from: Point3<f64>, to: Point3<f64>) -> Option<FacetId> {
        let mut line = Cuboid::EMPTY;
        line.include(from);
        line.include(to);
        let way = to - from;
        let mut first: Option<FacetId> = None;
        self.all_in(
            |bounds| bounds.meets(&line),
            |facet, corners| {
                let [a, b, c] = corners;
                let (ab, ac) = (b - a, c - a);
                let across = way.cross(&ac);
                let volume = ab.dot(&across);
                let away = from - a;
                let (u, beside) = (away.dot(&across) / volume, away.cross(&ab));
                let (v, share) = (way.dot(&beside) / volume, ac.dot(&beside) / volume);
                // False where the line is parallel to the triangle: NaN, or infinite.
                let meets = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&share);
                let touches = || (nearest_of_triangle(corners, from) - from).norm() <= self.resolution_m;
                if meets && first.is_none_or(|known| facet < known) && !touches() {
                    first = Some(facet);
                }
            },
        );
        first
    }

    /// Visits the triangles of the leaves in boxes that satisfy a condition, until the visitor breaks.
    fn walk(
        &self,
        mut enters: impl FnMut(&Cuboid) -> bool,
        mut visit: impl FnMut(FacetId, &[Point3<f64>; 3]) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut stack = [0_u32; DEPTH];
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let at = stack[waiting];
            let node = &self.nodes[at as usize];
            if !enters(&node.bounds) {
                continue;
            }
            if node.count == 0 {
                stack[waiting] = node.at;
                stack[waiting + 1] = at + 1;
                waiting += 2;
                continue;
            }
            let leaf = node.at as usize..(node.at + node.count) as usize;
            for (facet, corners) in self.order[leaf.clone()].iter().zip(&self.corners[leaf]) {
                visit(FacetId(*facet as usize), corners)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Visits all triangles of the leaves in boxes that satisfy a condition.
    fn all_in(&self, enters: impl FnMut(&Cuboid) -> bool, mut visit: impl FnMut(FacetId, &[Point3<f64>; 3])) {
        let _ = self.walk(enters, |facet, corners| {
            visit(facet, corners);
            ControlFlow::Continue(())
        });
    }

    /// Visits all triangles of the parts of the mesh that a condition on their boxes admits, given by their lower and upper corners.
    pub fn visit(&self, mut enters: impl FnMut(Point3<f64>, Point3<f64>) -> bool, visit: impl FnMut(FacetId, &[Point3<f64>; 3])) {
        self.all_in(|bounds| enters(bounds.min, bounds.max), visit);
    }

    /// The point of the mesh that is nearest to a given one; of several equally near ones, that of the triangle that comes first in the
    /// mesh.
    pub fn nearest(&self, to: Point3<f64>) -> NearestOnMesh {
        let mut best = (f64::INFINITY, FacetId(usize::MAX), to);
        let best_cell = std::cell::Cell::new(f64::INFINITY);
        self.all_in(
            |bounds| bounds.squared_distance_m2(to) <= best_cell.get(),
            |facet, corners| {
                let point = nearest_of_triangle(corners, to);
                let squared_m2 = (point - to).norm_squared();
                if squared_m2 < best.0 || (squared_m2 == best.0 && facet < best.1) {
                    best = (squared_m2, facet, point);
                    best_cell.set(squared_m2);
                }
            },
        );
        NearestOnMesh { point: best.2, facet: best.1, distance_m: best.0.sqrt() }
    }

    /// Whether a triangle of the mesh comes nearer to a point than a distance.
    pub fn meets_ball(&self, centre: Point3<f64>, radius_m: f64) -> bool {
        let radius_m2 = radius_m * radius_m;
        self.walk(
            |bounds| bounds.squared_distance_m2(centre) < radius_m2,
            |_, corners| {
                let is_nearer = (nearest_of_triangle(corners, centre) - centre).norm_squared() < radius_m2;
                if is_nearer { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            },
        )
        .is_break()
    }

    /// The triangles that touch a point of the mesh, within its [resolution](Self::resolution_m), in ascending order.
    pub fn touching(&self, point: Point3<f64>) -> Vec<FacetId> {
        let within_m2 = self.resolution_m * self.resolution_m;
        let mut found = Vec::new();
        self.all_in(
            |bounds| bounds.squared_distance_m2(point) <= within_m2,
            |facet, corners| {
                if (nearest_of_triangle(corners, point) - point).norm_squared() <= within_m2 {
                    found.push(facet);
                }
            },
        );
        found.sort_unstable();
        found
    }

    /// Number of bodies (parts that hang together by edges), of closed ones among them, and of closed ones that are inside out.
    pub fn body_counts(&self) -> [usize; 3] {
        self.bodies.counts()
    }

    /// Whether a point off the surface lies inside a closed body of the mesh. Open sheets have no inside.
    ///
    /// ```text
    ///     crossings of the ray straight up: +1 where it leaves a body, -1 where it enters one; inside where their sum is above 0
    /// ```
    ///
    /// A ray through an edge or a corner crosses exactly one of the triangles of a surface that meet there.
    pub fn is_buried(&self, from: Point3<f64>) -> bool {
        let mut sum = 0;
        let over = |bounds: &Cuboid| {
            bounds.min.x <= from.x
                && from.x <= bounds.max.x
                && bounds.min.y <= from.y
                && from.y <= bounds.max.y
                && bounds.max.z >= from.z
        };
        self.all_in(over, |facet, corners| {
            let sign = turns_around(corners, from.xy());
            if sign != 0 && self.bodies.is_closed(facet.index()) {
                let normal = normal_of(*corners);
                let z_m = corners[0].z - ((from.xy() - corners[0].xy()).dot(&normal.xy())) / normal.z;
                if z_m > from.z {
                    sum += sign;
                }
            }
        });
        sum > 0
    }
}

/// Builds the tree over a part of the triangles, which it sorts: halves at the median of the longest side.
fn split(all: &[[Point3<f64>; 3]], middles: &[Point3<f64>], order: &mut [u32], first: usize, nodes: &mut Vec<Node>) {
    let (mut bounds, mut of_middles) = (Cuboid::EMPTY, Cuboid::EMPTY);
    for facet in order.iter() {
        all[*facet as usize].iter().for_each(|corner| bounds.include(*corner));
        of_middles.include(middles[*facet as usize]);
    }
    let at = nodes.len();
    let index = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    nodes.push(Node { bounds, at: index(first), count: index(order.len()) });
    if order.len() <= LEAF {
        return;
    }
    let axis = (of_middles.max - of_middles.min).imax();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |a, b| {
        middles[*a as usize][axis].total_cmp(&middles[*b as usize][axis]).then_with(|| a.cmp(b))
    });
    let (left, right) = order.split_at_mut(half);
    split(all, middles, left, first, nodes);
    let second = index(nodes.len());
    split(all, middles, right, first + half, nodes);
    nodes[at].at = second;
    nodes[at].count = 0;
}

/// The segments in which a triangle meets a vertical plane. A corner this near to the plane lies in it, so that a plane along an edge
/// meets the whole edge.
#[inline]
fn cut_triangle(
    plane: &VerticalPlane,
    corners: &[Point3<f64>; 3],
    near_m: f64,
    mut visit: impl FnMut([ChainPoint; 2]) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let snapped = |left_m: f64| if left_m.abs() <= near_m { 0.0 } else { left_m };
    let left = corners.map(|corner| snapped(plane.left_m(corner)));
    if (left[0] > 0.0 && left[1] > 0.0 && left[2] > 0.0) || (left[0] < 0.0 && left[1] < 0.0 && left[2] < 0.0) {
        return ControlFlow::Continue(());
    }
    let along = corners.map(|corner| plane.along(corner));
    if left == [0.0; 3] {
        for i in 0..3 {
            visit([along[i], along[(i + 1) % 3]])?;
        }
        return ControlFlow::Continue(());
    }
    let mut ends = [ChainPoint::new(0.0, 0.0); 2];
    let mut count = 0;
    for i in 0..3 {
        let j = (i + 1) % 3;
        if left[i] == 0.0 {
            ends[count] = along[i];
            count += 1;
        }
        if (left[i] < 0.0 && left[j] > 0.0) || (left[i] > 0.0 && left[j] < 0.0) {
            // From the corner on the right to that on the left, so that both triangles of an edge compute the same.
            let (right, to) = if left[i] < 0.0 { (i, j) } else { (j, i) };
            let share = left[right] / (left[right] - left[to]);
            ends[count] = ChainPoint::new(
                along[right].x_m + (along[to].x_m - along[right].x_m) * share,
                along[right].z_m + (along[to].z_m - along[right].z_m) * share,
            );
            count += 1;
        }
    }
    visit(if count == 1 { [ends[0]; 2] } else { ends })
}

/// The point of a triangle that is nearest to a given one.
///
/// Source: C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
fn nearest_of_triangle(&[a, b, c]: &[Point3<f64>; 3], to: Point3<f64>) -> Point3<f64> {
    let (ab, ac, ap) = (b - a, c - a, to - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = to - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = to - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let whole = va + vb + vc;
    a + ab * (vb / whole) + ac * (vc / whole)
}

/// How often the border of a triangle, seen from above, turns counter-clockwise around a point: 1, 0 or -1.
///
/// An edge counts where it crosses the line through the point towards +x, its upper end excluded; edges are computed from their lower
/// end, so that the two triangles of an edge agree.
fn turns_around(corners: &[Point3<f64>; 3], at: MapPoint) -> i32 {
    let mut turns = 0;
    for i in 0..3 {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        if (from.y <= at.y) == (to.y <= at.y) {
            continue;
        }
        let (low, high, sign) = if from.y <= at.y { (from, to, 1) } else { (to, from, -1) };
        let x = low.x + (high.x - low.x) * ((at.y - low.y) / (high.y - low.y));
        if at.x < x {
            turns += sign;
        }
    }
    turns
}
