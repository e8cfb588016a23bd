//! What is doubtful about the triangles of a mesh, counted.

use nalgebra::Point3;

use super::MeshTree;

/// The most triangles of which crossings are counted: beyond, that takes longer than many answers.
const MOST_FOR_CROSSINGS: usize = 200_000;

/// Counts of what is doubtful about a mesh. None of it stops an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshFlaws {
    /// Bodies with a border, which bury nothing.
    pub open_bodies: usize,
    /// Edges of only one triangle.
    pub border_edges: usize,
    /// Edges whose triangles turn the same way round: one of them faces inwards.
    pub unlike_edges: usize,
    /// Triangles with the same three corners as an earlier one.
    pub duplicates: usize,
    /// Closed bodies whose triangles turn their outer sides inwards.
    pub inverted_bodies: usize,
    /// Triangles that an edge of another triangle of the same body passes through; `None` for meshes of over 200 000 triangles.
    pub crossed: Option<usize>,
}

impl MeshTree {
    /// Counts what is doubtful about the mesh.
    pub fn flaws(&self) -> MeshFlaws {
        let [bodies, closed, inverted_bodies] = self.body_counts();
        let [border_edges, unlike_edges] = self.bodies().odd_edges();
        MeshFlaws {
            open_bodies: bodies - closed,
            border_edges,
            unlike_edges,
            duplicates: self.bodies().duplicates(),
            inverted_bodies,
            crossed: (self.mesh().triangle_count() <= MOST_FOR_CROSSINGS).then(|| self.crossed_facets()),
        }
    }

    /// Triangles that an edge of another triangle of their body, with no corner in common, passes through.
    fn crossed_facets(&self) -> usize {
        let mut crossed = vec![false; self.mesh().triangle_count()];
        for (facet, corners) in self.mesh().triangles().enumerate() {
            self.near_triangle(&corners, |other, others| {
                let apart = other.index() != facet
                    && self.bodies().are_one(facet, other.index())
                    && corners.iter().all(|corner| !others.contains(corner));
                if apart && !crossed[other.index()] {
                    crossed[other.index()] = (0..3).any(|i| passes_through([corners[i], corners[(i + 1) % 3]], others));
                }
            });
        }
        crossed.into_iter().filter(|crossed| *crossed).count()
    }
}

/// Whether a straight line between two points passes through the inside of a triangle.
fn passes_through([from, to]: [Point3<f64>; 2], [a, b, c]: &[Point3<f64>; 3]) -> bool {
    // Far above the rounding of coordinates: what touches does not pass through.
    const INSIDE: std::ops::Range<f64> = 1e-9..1.0 - 1e-9;
    let (ab, ac, way) = (b - a, c - a, to - from);
    let across = way.cross(&ac);
    let volume = ab.dot(&across);
    let away = from - a;
    let (u, beside) = (away.dot(&across) / volume, away.cross(&ab));
    let (v, share) = (way.dot(&beside) / volume, ac.dot(&beside) / volume);
    INSIDE.contains(&u) && INSIDE.contains(&v) && INSIDE.contains(&(u + v)) && INSIDE.contains(&share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::read_mesh_bytes;

    fn flaws(text: &str) -> MeshFlaws {
        MeshTree::new(read_mesh_bytes(text.as_bytes(), 1.0).unwrap().mesh).flaws()
    }

    const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

    #[test]
    fn every_flaw_is_counted_by_itself() {
        let whole = MeshFlaws { crossed: Some(0), ..MeshFlaws::default() };
        assert_eq!(flaws(TETRAHEDRON), whole);
        let open = flaws(&TETRAHEDRON.replace("f 2 3 4\n", ""));
        assert_eq!(open, MeshFlaws { open_bodies: 1, border_edges: 3, ..whole });
        let turned = flaws(&TETRAHEDRON.replace("f 2 3 4", "f 2 4 3"));
        assert_eq!(turned, MeshFlaws { open_bodies: 1, unlike_edges: 3, ..whole });
        let twice = flaws(&format!("{TETRAHEDRON}{}", "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
        assert_eq!(twice, MeshFlaws { duplicates: 4, ..whole });
        let inverted = flaws(
            &TETRAHEDRON
                .replace("f 1 3 2", "f 1 2 3")
                .replace("f 1 2 4", "f 2 1 4")
                .replace("f 1 4 3", "f 1 3 4")
                .replace("f 2 3 4", "f 3 2 4"),
        );
        assert_eq!(inverted, MeshFlaws { inverted_bodies: 1, ..whole });
        // A strip that turns back through its own beginning: two edges of its last triangle pass through the first two, and the edge between
        // these through the last.
        let strip =
            "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 2 2 0\nv 2 2 1\nv 0.4 0.4 1\nv 0.4 0.4 -1\nf 1 2 3\nf 2 4 3\nf 3 4 5\nf 3 5 6\nf 5 7 6\n";
        assert_eq!(flaws(strip).crossed, Some(3));
    }
}
