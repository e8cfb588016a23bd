//! Triangles of a polygon that is not convex, by cutting off its ears.

use nalgebra::{Point2, Point3, Vector3};

/// The most corners of such a polygon. Each ear costs up to the square of their number, so a file of large faces would take
/// minutes; modelling programs make few faces of more than a dozen corners.
const MOST_CORNERS: usize = 64;

/// Relative deviation of the summed areas of the triangles from that of the polygon that rounding explains.
const AREA_TOLERANCE: f64 = 1.0e-9;

/// The triangles of a polygon, as indices of its corners.
///
/// The corners are projected onto the plane of the polygon (Newell's normal). An ear is a corner that turns inwards and whose
/// triangle contains no other corner; every simple polygon has two (Meisters 1975).
///
/// # Errors
/// The border crosses or touches itself, or has too many corners.
pub(super) fn cut(corners: &[Point3<f64>]) -> Result<Vec<[usize; 3]>, String> {
    let count = corners.len();
    if count > MOST_CORNERS {
        return Err(format!(
            "found a face of {count} corners that is not convex, expected at most {MOST_CORNERS} in such a face; triangulate the mesh \
             before the export"
        ));
    }
    let crossing = || {
        format!(
            "found a face of {count} corners whose border crosses itself, expected one inside; triangulate the mesh before the export"
        )
    };
    let flat = flattened(corners).ok_or_else(crossing)?;
    let mut left: Vec<usize> = (0..count).collect();
    let mut triangles = Vec::with_capacity(count - 2);
    while left.len() > 3 {
        let ear =
            (0..left.len()).find(|&at| is_ear(&flat, &left, at)).or_else(|| (0..left.len()).find(|&at| is_flat(&flat, &left, at)));
        let ear = ear.ok_or_else(crossing)?;
        triangles.push(around(&left, ear));
        left.remove(ear);
    }
    triangles.push(around(&left, 1));
    let whole: f64 = (0..count).map(|at| 0.5 * cross(flat[0], flat[at], flat[(at + 1) % count])).sum();
    let parts: f64 = triangles.iter().map(|[a, b, c]| 0.5 * cross(flat[*a], flat[*b], flat[*c]).abs()).sum();
    if (whole - parts).abs() <= AREA_TOLERANCE * whole { Ok(triangles) } else { Err(crossing()) }
}

/// The corner `at` of what is left, between its neighbours.
fn around(left: &[usize], at: usize) -> [usize; 3] {
    let count = left.len();
    [left[(at + count - 1) % count], left[at], left[(at + 1) % count]]
}

/// The corners in the plane of the polygon, counterclockwise; `None` if it has no area.
fn flattened(corners: &[Point3<f64>]) -> Option<Vec<Point2<f64>>> {
    let first = corners.first()?;
    let normal: Vector3<f64> =
        corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| (a - first).cross(&(b - first))).sum();
    let normal = normal.try_normalize(0.0)?;
    let aside = if normal.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let right = normal.cross(&aside).try_normalize(0.0)?;
    let up = normal.cross(&right);
    Some(corners.iter().map(|corner| Point2::new((corner - first).dot(&right), (corner - first).dot(&up))).collect())
}

/// Twice the area of a triangle, positive if it is counterclockwise.
fn cross(a: Point2<f64>, b: Point2<f64>, c: Point2<f64>) -> f64 {
    (b - a).perp(&(c - a))
}

fn is_ear(flat: &[Point2<f64>], left: &[usize], at: usize) -> bool {
    let [a, b, c] = around(left, at).map(|corner| flat[corner]);
    if cross(a, b, c) <= 0.0 {
        return false;
    }
    let others = left.iter().map(|corner| flat[*corner]).filter(|point| ![a, b, c].contains(point));
    others.into_iter().all(|point| cross(a, b, point) < 0.0 || cross(b, c, point) < 0.0 || cross(c, a, point) < 0.0)
}

/// Whether a corner lies on the line between its neighbours: its triangle has no area, and is dropped later.
fn is_flat(flat: &[Point2<f64>], left: &[usize], at: usize) -> bool {
    let [a, b, c] = around(left, at).map(|corner| flat[corner]);
    cross(a, b, c).abs() <= 1.0e-12 * (b - a).norm() * (c - b).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<Point3<f64>> {
        // Tilted, so that the projection matters.
        points.iter().map(|(x, y)| Point3::new(*x, *y, 0.5 * x - 2.0 * y)).collect()
    }

    /// Areas by the shoelace formula, by hand.
    #[test]
    fn the_triangles_fill_the_polygon_and_no_more() {
        for (name, points, area) in [
            ("dart", &[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)][..], 4.0),
            ("L", &[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)], 3.0),
            ("U", &[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (2.0, 3.0), (2.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)], 7.0),
            ("with a corner on a line", &[(0.0, 0.0), (2.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 1.0)], 4.0),
        ] {
            for reverse in [false, true] {
                for turn in 0..points.len() {
                    let mut corners = polygon(points);
                    corners.rotate_left(turn);
                    if reverse {
                        corners.reverse();
                    }
                    let triangles = cut(&corners).unwrap();
                    let normals = triangles.iter().map(|corners_of| {
                        let [a, b, c] = corners_of.map(|at| corners[at].xy());
                        0.5 * cross(a, b, c)
                    });
                    let sum: f64 = normals.clone().sum();
                    assert!((sum.abs() - area).abs() < 1e-12, "{name} {turn}: {sum}");
                    assert!(normals.into_iter().all(|part| part * sum >= 0.0), "{name} {turn}: a triangle is turned over");
                }
            }
        }
    }

    #[test]
    fn borders_that_cross_themselves_and_very_large_faces_are_refused() {
        assert!(cut(&polygon(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])).unwrap_err().contains("crosses itself"));
        assert!(
            cut(&polygon(&[(0.0, 0.0), (3.0, 0.0), (1.0, 2.0), (1.0, -1.0), (2.0, 2.0)])).unwrap_err().contains("crosses itself")
        );
        let star: Vec<(f64, f64)> = (0..80_u32)
            .map(|k| {
                let (angle, radius) = (f64::from(k) * std::f64::consts::TAU / 80.0, if k % 2 == 0 { 2.0 } else { 1.0 });
                (radius * angle.cos(), radius * angle.sin())
            })
            .collect();
        assert!(cut(&polygon(&star)).unwrap_err().contains("at most 64"));
        assert_eq!(cut(&polygon(&star[..64])).map(|triangles| triangles.len()), Ok(62));
    }
}
