//! The convex hull of points in space.
//!
//! Quickhull (Barber, Dobkin and Huhdanpaa 1996) on a lattice of whole numbers, where it is decided exactly on which side of a
//! plane a point lies: there is no tolerance by which faces could contradict each other. A step of the lattice is 2^-30 of the longest edge of the
//! bounding box, finer than the single precision in which meshes are stored.

use std::collections::HashMap;

use nalgebra::Point3;

/// Steps of the lattice along the longest edge of the bounding box. Differences then have 30 bits, normals 62 and sides 94, so that 64 and 128 bits
/// hold them.
const STEPS: f64 = 1_073_741_824.0;

/// A point on the lattice.
type Node = [i64; 3];

/// A triangle of the hull, counterclockwise seen from outside.
struct Face {
    corners: [usize; 3],
    /// The faces across the edges from each corner to the next.
    across: [usize; 3],
    normal: Node,
    /// Points above this face that are not yet part of the hull.
    above: Vec<usize>,
    removed: bool,
}

/// The triangles of the convex hull, each three indices of points, counterclockwise seen from outside. `None` if all points lie in one plane or
/// a coordinate is not finite.
pub(super) fn hull_triangles(points: &[Point3<f64>]) -> Option<Vec<[usize; 3]>> {
    let nodes = on_lattice(points)?;
    let mut hull = Hull::simplex(&nodes)?;
    let mut next = 0;
    while next < hull.faces.len() {
        // A face that is made later has a higher index.
        if hull.faces[next].removed || hull.faces[next].above.is_empty() {
            next += 1;
        } else {
            hull.add_farthest(next);
        }
    }
    Some(hull.faces.iter().filter(|face| !face.removed).map(|face| face.corners).collect())
}

/// The points on a lattice as fine as [`STEPS`]; `None` if one is not finite or all are the same.
fn on_lattice(points: &[Point3<f64>]) -> Option<Vec<Node>> {
    if !points.iter().all(|point| point.iter().all(|number| number.is_finite())) {
        return None;
    }
    let first = points.first()?;
    let (low, high) = points.iter().fold((*first, *first), |(low, high), point| (low.inf(point), high.sup(point)));
    let size = (high - low).amax();
    if !(size.is_finite() && size > 0.0) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "between 0 and STEPS")]
    let steps = |from: f64, to: f64| ((to - from) / size * STEPS).round() as i64;
    Some(points.iter().map(|point| [0, 1, 2].map(|axis| steps(low[axis], point[axis]))).collect())
}

fn minus(a: Node, b: Node) -> Node {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Node, b: Node) -> Node {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Node, b: Node) -> i128 {
    (0..3).map(|axis| i128::from(a[axis]) * i128::from(b[axis])).sum()
}

/// A hull that grows by a point at a time.
struct Hull<'a> {
    nodes: &'a [Node],
    faces: Vec<Face>,
}

impl<'a> Hull<'a> {
    /// The tetrahedron of four points that are far from each other, with all others given to the faces below which they are not. `None` if there is
    /// none.
    fn simplex(nodes: &'a [Node]) -> Option<Self> {
        let farthest = |size: &dyn Fn(Node) -> i128| {
            let best = (0..nodes.len()).max_by_key(|&node| size(nodes[node]))?;
            (size(nodes[best]) > 0).then_some(best)
        };
        let a = (0..nodes.len()).min_by_key(|&node| nodes[node])?;
        let from = nodes[a];
        let b = farthest(&|node| dot(minus(node, from), minus(node, from)))?;
        let along = minus(nodes[b], from);
        let area = |node| cross(along, minus(node, from));
        let c = farthest(&|node| dot(area(node), area(node)))?;
        let normal = area(nodes[c]);
        let d = farthest(&|node| dot(normal, minus(node, from)).abs())?;
        // Turned so that the fourth lies below the first face.
        let (b, c) = if dot(normal, minus(nodes[d], from)) > 0 { (c, b) } else { (b, c) };
        let mut hull = Self { nodes, faces: Vec::new() };
        // Each face with those across its edges.
        for (corners, across) in [([a, b, c], [1, 2, 3]), ([b, a, d], [0, 3, 2]), ([c, b, d], [0, 1, 3]), ([a, c, d], [0, 2, 1])] {
            hull.push(corners, across);
        }
        hull.share_out((0..nodes.len()).collect(), 0);
        Some(hull)
    }

    fn push(&mut self, corners: [usize; 3], across: [usize; 3]) {
        let [a, b, c] = corners.map(|corner| self.nodes[corner]);
        let normal = cross(minus(b, a), minus(c, a));
        self.faces.push(Face { corners, across, normal, above: Vec::new(), removed: false });
    }

    /// Six times the volume of the tetrahedron on a face up to a point: above 0 outside.
    fn height(&self, face: usize, point: usize) -> i128 {
        let Face { corners, normal, .. } = &self.faces[face];
        dot(*normal, minus(self.nodes[point], self.nodes[corners[0]]))
    }

    /// Gives each point to the first face from an index on that it is above; the others lie inside.
    fn share_out(&mut self, points: Vec<usize>, from: usize) {
        for point in points {
            if let Some(face) = (from..self.faces.len()).find(|&face| self.height(face, point) > 0) {
                self.faces[face].above.push(point);
            }
        }
    }

    /// Adds the point farthest above a face: removes all faces that it is above and joins it to the edges around them.
    ///
    /// A point above a removed face and above no new one is inside: from the point to any place of the removed face, the segment is outside the old hull, so it
    /// enters the new one by a new face.
    fn add_farthest(&mut self, seen: usize) {
        let Some(apex) = self.faces[seen].above.iter().copied().max_by_key(|&point| self.height(seen, point)) else { return };
        let mut removed = vec![seen];
        self.faces[seen].removed = true;
        // Edges to faces that stay, by their first corner: the second and the face.
        let mut rim: Vec<(usize, usize, usize)> = Vec::new();
        let mut at = 0;
        while at < removed.len() {
            let Face { corners, across, .. } = self.faces[removed[at]];
            for (edge, &beyond) in across.iter().enumerate() {
                if self.faces[beyond].removed {
                    continue;
                }
                if self.height(beyond, apex) > 0 {
                    self.faces[beyond].removed = true;
                    removed.push(beyond);
                } else {
                    rim.push((corners[edge], corners[(edge + 1) % 3], beyond));
                }
            }
            at += 1;
        }
        let made = self.faces.len();
        let starts: HashMap<usize, usize> = rim.iter().enumerate().map(|(index, &(from, ..))| (from, made + index)).collect();
        let ends: HashMap<usize, usize> = rim.iter().enumerate().map(|(index, &(_, to, _))| (to, made + index)).collect();
        for (index, &(from, to, beyond)) in rim.iter().enumerate() {
            self.push([from, to, apex], [beyond, starts[&to], ends[&from]]);
            let neighbour = &mut self.faces[beyond];
            // There the edge has the opposite direction.
            let edge = (0..3).find(|&edge| neighbour.corners[edge] == to && neighbour.corners[(edge + 1) % 3] == from);
            if let Some(edge) = edge {
                neighbour.across[edge] = made + index;
            }
        }
        let points: Vec<usize> = removed.iter().flat_map(|&face| std::mem::take(&mut self.faces[face].above)).collect();
        self.share_out(points, made);
    }
}
