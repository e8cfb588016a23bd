//! The bodies of a mesh: parts that hang together by edges, and which of them are closed.

use std::collections::HashMap;

use super::{Mesh, model::normal_of};

/// The bodies of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bodies {
    /// The body of every triangle.
    of: Vec<u32>,
    /// Of every body: whether it is closed.
    closed: Vec<bool>,
    /// Number of closed bodies whose triangles turn their outer sides inwards.
    inverted: usize,
    /// Number of edges of one triangle, and of others with more triangles one way round than the other.
    odd_edges: [usize; 2],
    /// Number of triangles with the same corners as an earlier one.
    duplicates: usize,
}

/// A directed edge, from the lower to the higher of its corners or against that, and its triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    ends: [u32; 2],
    facet: u32,
    backwards: bool,
}

impl Bodies {
    /// The bodies of a mesh. Corners at the same position are one corner, whatever the file says.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let corners = welded(mesh);
        let edges = {
            let mut edges = Vec::with_capacity(3 * corners.len());
            for (facet, corners) in (0_u32..).zip(&corners) {
                for i in 0..3 {
                    let (from, to) = (corners[i], corners[(i + 1) % 3]);
                    edges.push(Edge { ends: [from.min(to), from.max(to)], facet, backwards: from > to });
                }
            }
            edges.sort_unstable();
            edges
        };
        let mut parents: Vec<u32> = (0_u32..).take(corners.len()).collect();
        for pair in edges.windows(2).filter(|pair| pair[0].ends == pair[1].ends) {
            let (a, b) = (root(&mut parents, pair[0].facet), root(&mut parents, pair[1].facet));
            parents[a.max(b) as usize] = a.min(b);
        }
        // Roots are the first triangles of their bodies.
        let mut numbers: HashMap<u32, u32> = HashMap::new();
        let of: Vec<u32> = (0_u32..)
            .take(corners.len())
            .map(|facet| {
                let next = u32::try_from(numbers.len()).unwrap_or(u32::MAX);
                *numbers.entry(root(&mut parents, facet)).or_insert(next)
            })
            .collect();
        let mut closed = vec![true; numbers.len()];
        let mut odd_edges = [0; 2];
        for edge in edges.chunk_by(|a, b| a.ends == b.ends) {
            let backwards = edge.iter().filter(|edge| edge.backwards).count();
            if 2 * backwards != edge.len() {
                closed[of[edge[0].facet as usize] as usize] = false;
                odd_edges[usize::from(edge.len() > 1)] += 1;
            }
        }
        let mut volumes = vec![0.0; closed.len()];
        for (body, triangle) in of.iter().zip(mesh.triangles()) {
            let low = mesh.bounds();
            let height_m = (triangle[0].z + triangle[1].z + triangle[2].z) / 3.0 - low.low_m;
            volumes[*body as usize] += 0.5 * normal_of(triangle).z * height_m;
        }
        let inverted = volumes.iter().zip(&closed).filter(|(volume, closed)| **closed && **volume < 0.0).count();
        Self { of, closed, inverted, odd_edges, duplicates: duplicates(corners) }
    }

    /// Whether a triangle is part of a closed body.
    pub(super) fn is_closed(&self, facet: usize) -> bool {
        self.of.get(facet).is_some_and(|body| self.closed[*body as usize])
    }

    /// Number of triangles with the same corners as an earlier one.
    pub(super) const fn duplicates(&self) -> usize {
        self.duplicates
    }

    /// Whether two triangles belong to one body.
    pub(super) fn are_one(&self, facet: usize, other: usize) -> bool {
        self.of.get(facet) == self.of.get(other)
    }

    /// Number of edges of one triangle, and of others with more triangles one way round than the other.
    pub(super) const fn odd_edges(&self) -> [usize; 2] {
        self.odd_edges
    }

    /// Number of bodies, of those that are closed, and of closed ones that are inside out.
    pub(super) fn counts(&self) -> [usize; 3] {
        [self.closed.len(), self.closed.iter().filter(|closed| **closed).count(), self.inverted]
    }
}

/// Number of triangles with the same corners as an earlier one.
fn duplicates(mut corners: Vec<[u32; 3]>) -> usize {
    for corners in &mut corners {
        corners.sort_unstable();
    }
    corners.sort_unstable();
    corners.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// The root of a triangle in the forest of bodies, with paths halved on the way.
fn root(parents: &mut [u32], mut facet: u32) -> u32 {
    while parents[facet as usize] != facet {
        let above = parents[parents[facet as usize] as usize];
        parents[facet as usize] = above;
        facet = above;
    }
    facet
}

/// The corners of every triangle, numbered by position.
fn welded(mesh: &Mesh) -> Vec<[u32; 3]> {
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::new();
    let by_vertex: Vec<u32> = mesh
        .vertices()
        .iter()
        .map(|vertex| {
            // 0 and -0 are one position.
            let bits = [vertex.x, vertex.y, vertex.z].map(|coordinate| (coordinate + 0.0).to_bits());
            let next = u32::try_from(numbers.len()).unwrap_or(u32::MAX);
            *numbers.entry(bits).or_insert(next)
        })
        .collect();
    mesh.indices().iter().map(|corners| corners.map(|corner| by_vertex[corner as usize])).collect()
}
