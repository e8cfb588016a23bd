//! Compares the slice with planes and solids of known upper envelope, and with a search through all triangles.

use nalgebra::Point3;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::*;
use crate::terrain::ProfileFacet;

fn at(x: f64, y: f64) -> MapPoint {
    MapPoint::new(x, y)
}

/// A mesh from polygons of corners.
fn mesh(polygons: &[&[[f64; 3]]]) -> Mesh {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for polygon in polygons {
        let first = u32::try_from(vertices.len()).unwrap();
        vertices.extend(polygon.iter().map(|&[x, y, z]| Point3::new(x, y, z)));
        triangles.extend((1..u32::try_from(polygon.len()).unwrap() - 1).map(|corner| [first, first + corner, first + corner + 1]));
    }
    Mesh::new(vertices, triangles).unwrap()
}

/// A level rectangle.
fn level(x: [f64; 2], y: [f64; 2], z: f64) -> [[f64; 3]; 4] {
    [[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]]
}

/// An upright rectangle over a line on the map.
fn upright(from: [f64; 2], to: [f64; 2], z: [f64; 2]) -> [[f64; 3]; 4] {
    [[from[0], from[1], z[0]], [to[0], to[1], z[0]], [to[0], to[1], z[1]], [from[0], from[1], z[1]]]
}

fn floor() -> [[f64; 3]; 4] {
    level([0.0, 10.0], [0.0, 10.0], 0.0)
}

/// The vertices where the slope changes, as x and z.
fn bends(slice: &MeshSlice) -> Vec<(f64, f64)> {
    let points: Vec<(f64, f64)> = slice.profile.points.iter().map(|point| (point.x_m, point.z_m)).collect();
    let bends = |i: usize| {
        let slope = |(x0, z0): (f64, f64), (x1, z1): (f64, f64)| (z1 - z0) / (x1 - x0);
        i == 0 || i + 1 == points.len() || (slope(points[i - 1], points[i]) - slope(points[i], points[i + 1])).abs() > 1e-9
    };
    (0..points.len()).filter(|&i| bends(i)).map(|i| points[i]).collect()
}

fn close(found: &[(f64, f64)], expected: &[(f64, f64)]) {
    assert_eq!(found.len(), expected.len(), "{found:?} instead of {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9, "{found:?} instead of {expected:?}");
    }
}

/// Checks the properties of every slice, and the reversed transect.
fn check(mesh: &Mesh, from: MapPoint, to: MapPoint) -> MeshSlice {
    let slice = slice_mesh(mesh, from, to).unwrap();
    let profile = &slice.profile;
    assert_eq!((profile.points[0].map, profile.points.last().unwrap().map), (from, to));
    assert_eq!((profile.points[0].x_m, profile.length_m()), (0.0, libm::hypot((to - from).x, (to - from).y)));
    assert!(profile.points.windows(2).all(|pair| pair[0].x_m < pair[1].x_m));
    assert_eq!(profile.facets.len() + 1, profile.points.len());
    for facet in &profile.facets {
        assert!((facet.normal.norm() - 1.0).abs() < 1e-12 && facet.normal.z >= 0.0);
    }
    for point in &profile.points {
        assert!((point.map - (from + profile.heading * point.x_m)).norm() < 1e-8, "{point:?}");
    }
    let back = slice_mesh(mesh, to, from).unwrap();
    assert_eq!(back.layers, slice.layers);
    assert!(profile.facets.iter().eq(back.profile.facets.iter().rev()));
    assert_eq!(back.profile.points.len(), profile.points.len());
    for (there, back) in profile.points.iter().zip(back.profile.points.iter().rev()) {
        assert_eq!((there.map, there.z_m), (back.map, back.z_m));
        assert!((there.x_m + back.x_m - profile.length_m()).abs() < 1e-9);
    }
    for (there, back) in slice.walls.iter().zip(back.walls.iter().rev()) {
        assert_eq!((there.map, there.foot_m, there.top_m, there.closed), (back.map, back.foot_m, back.top_m, back.closed));
    }
    assert_eq!(slice.walls.len(), back.walls.len());
    slice
}

#[test]
fn a_block_on_a_floor_has_walls_on_its_lower_sides() {
    let (low, high) = ([3.0, 4.0], [7.0, 6.0]);
    let block = mesh(&[
        &floor(),
        &level([3.0, 7.0], [4.0, 6.0], 2.0),
        &upright(low, [7.0, 4.0], [0.0, 2.0]),
        &upright([7.0, 4.0], high, [0.0, 2.0]),
        &upright(high, [3.0, 6.0], [0.0, 2.0]),
        &upright([3.0, 6.0], low, [0.0, 2.0]),
    ]);
    let slice = check(&block, at(0.0, 5.25), at(10.0, 5.25));
    close(&bends(&slice), &[(0.0, 0.0), (2.999, 0.0), (3.0, 2.0), (7.0, 2.0), (7.001, 0.0), (10.0, 0.0)]);
    assert_eq!(slice.layers, Layers { places: 1, length_m: 4.0 });
    assert_eq!(slice.walls.len(), 2);
    for (wall, x_m) in slice.walls.iter().zip([3.0, 7.0]) {
        assert_eq!(*wall, Wall { x_m, map: at(x_m, 5.25), foot_m: 0.0, top_m: 2.0, run_m: WALL_RUN_M, closed: true });
    }
    // At a right angle to the plane, a wall has no cross-slope.
    assert!(slice.profile.facets.iter().all(|facet| facet.cross_slope.degrees() < 1e-12));
    let warnings = slice.warnings();
    assert!(warnings[0].contains("in 1 places, over 4.000 of 10.000 m (40.0 %): the uppermost counts there"), "{warnings:?}");
    assert!(
        warnings[1].contains("jumps in 2 places")
            && warnings[1].contains("wall of 2.000 m at x = 3.000 m, map (3.000, 5.250), from z = 0.000 m")
    );
    // At 45 degrees to the plane, it has 45 degrees.
    let aslant = check(&block, at(0.5, 2.5), at(8.0, 10.0));
    let walls: Vec<f64> =
        aslant.profile.facets.iter().map(|facet| facet.cross_slope.degrees()).filter(|degrees| *degrees > 1.0).collect();
    assert!(walls.len() == 2 && walls.iter().all(|degrees| (degrees - 45.0).abs() < 1e-9), "{walls:?}");
    // Along the upper edge of a wall, the wall's facet is used: 90 degrees.
    let edge = check(&block, at(3.0, 5.0), at(3.0, 5.5));
    assert!(edge.profile.points.iter().all(|point| point.z_m == 2.0));
    assert!(edge.profile.facets.iter().all(|facet| facet.cross_slope.degrees() == 90.0));
}

#[test]
fn a_plate_in_the_air_ends_in_steps_that_nothing_stands_on() {
    let table = mesh(&[&floor(), &level([3.0, 7.0], [2.0, 8.0], 1.0), &upright([3.0, 2.0], [3.0, 8.0], [0.9, 1.0])]);
    let slice = check(&table, at(1.0, 5.0), at(9.0, 5.0));
    close(&bends(&slice), &[(0.0, 0.0), (1.999, 0.0), (2.0, 1.0), (6.0, 1.0), (6.001, 0.0), (8.0, 0.0)]);
    assert!(slice.walls.iter().all(|wall| !wall.closed));
    let steps: Vec<f64> =
        slice.profile.facets.iter().map(|facet| facet.cross_slope.degrees()).filter(|degrees| *degrees > 0.0).collect();
    assert_eq!(steps, [90.0, 90.0]);
    assert!(slice.warnings()[1].contains("overhang of 1.000 m at x = 2.000 m"));
    // Beside it there are no warnings.
    let beside = check(&table, at(1.0, 1.0), at(9.0, 1.0));
    assert!(beside.warnings().is_empty() && beside.layers == Layers { places: 0, length_m: 0.0 });
}

#[test]
fn where_slopes_pierce_each_other_the_upper_envelope_bends() {
    let rising = [[0.0, 0.0, 0.0], [10.0, 0.0, 5.0], [10.0, 10.0, 5.0], [0.0, 10.0, 0.0]];
    let falling = [[0.0, 0.0, 4.0], [10.0, 0.0, -1.0], [10.0, 10.0, -1.0], [0.0, 10.0, 4.0]];
    let slice = check(&mesh(&[&rising, &falling]), at(0.0, 3.0), at(10.0, 3.0));
    close(&bends(&slice), &[(0.0, 4.0), (4.0, 2.0), (10.0, 5.0)]);
    assert_eq!(slice.layers, Layers { places: 1, length_m: 10.0 });
    assert!(slice.walls.is_empty());
}

#[test]
fn a_thin_wall_is_a_spike_and_a_narrow_slot_keeps_its_floor() {
    let fence = mesh(&[&floor(), &upright([5.0, 0.0], [5.0, 10.0], [0.0, 1.5])]);
    let slice = check(&fence, at(1.0, 4.0), at(9.0, 4.0));
    close(&bends(&slice), &[(0.0, 0.0), (3.999, 0.0), (4.0, 1.5), (4.001, 0.0), (8.0, 0.0)]);
    assert!(slice.walls.len() == 2 && slice.walls.iter().all(|wall| wall.closed));
    // A slot of 1 mm between two blocks: each foot takes a quarter of it.
    let slot = mesh(&[&floor(), &level([0.0, 5.0], [0.0, 10.0], 1.0), &level([5.001, 10.0], [0.0, 10.0], 1.0)]);
    let slice = check(&slot, at(1.0, 4.0), at(9.0, 4.0));
    close(&bends(&slice), &[(0.0, 1.0), (4.0, 1.0), (4.00025, 0.0), (4.00075, 0.0), (4.001, 1.0), (8.0, 1.0)]);
    assert!(slice.layers.places == 2 && (slice.layers.length_m - 7.999).abs() < 1e-9, "{:?}", slice.layers);
}

#[test]
fn the_gap_is_named_from_either_side() {
    let strips =
        mesh(&[&level([0.0, 3.0], [0.0, 4.0], 0.0), &level([5.0, 7.0], [0.0, 4.0], 0.0), &level([8.0, 9.0], [0.0, 4.0], 1.0)]);
    let gap = |from: MapPoint, to: MapPoint| match slice_mesh(&strips, from, to).unwrap_err() {
        TerrainError::MeshGap { begin_m, end_m, begin, end, further, .. } => (begin_m, end_m, begin, end, further),
        other => panic!("{other}"),
    };
    assert_eq!(gap(at(1.0, 2.0), at(9.0, 2.0)), (2.0, 4.0, at(3.0, 2.0), at(5.0, 2.0), 1));
    assert_eq!(gap(at(9.0, 2.0), at(1.0, 2.0)), (1.0, 2.0, at(8.0, 2.0), at(7.0, 2.0), 1));
    assert_eq!(gap(at(-1.0, 2.0), at(2.0, 2.0)), (0.0, 1.0, at(-1.0, 2.0), at(0.0, 2.0), 0));
    assert_eq!(gap(at(0.0, 9.0), at(9.0, 9.0)), (0.0, 9.0, at(0.0, 9.0), at(9.0, 9.0), 0));
    let message = slice_mesh(&strips, at(1.0, 2.0), at(9.0, 2.0)).unwrap_err().to_string();
    assert!(message.contains("from x = 2 m to 4 m along the transect, map (3.000000, 2.000000) m to (5.000000, 2.000000) m (and 1 more such stretches)"), "{message}");
    assert!(check(&strips, at(5.0, 2.0), at(7.0, 2.0)).profile.points.len() >= 2);
    assert!(matches!(slice_mesh(&strips, at(1.0, 1.0), at(1.0, 1.0)), Err(TerrainError::SamePoint { .. })));
    assert!(matches!(slice_mesh(&strips, at(f64::NAN, 1.0), at(1.0, 1.0)), Err(TerrainError::OffTheMap { .. })));
}

#[test]
fn the_advice_about_a_gap_is_what_is_likely() {
    let strips =
        mesh(&[&level([0.0, 3.0], [0.0, 4.0], 0.0), &level([5.0, 7.0], [0.0, 4.0], 0.0), &level([7.01, 9.0], [0.0, 4.0], 1.0)]);
    for (from, to, expected, absent) in [
        ((6.0, 2.0), (8.0, 2.0), "weld", "mesh_scale"),
        ((1.0, 2.0), (6.0, 2.0), "close the hole", "weld"),
        ((1.0, 2.0), (20.0, 2.0), "choose another transect, or close the hole", "weld"),
        ((4.5, 2.0), (6.0, 2.0), "choose ends on it", "weld"),
        ((8.0, 2.0), (20.0, 2.0), "x from 0 to 9 m and y from 0 to 4 m: choose ends on it", "weld"),
        ((8.0, 2.0), (9000.0, 2.0), "if its unit is not the metre, give mesh_scale, its metres per unit (1000 for km)", "weld"),
        ((4000.0, 2000.0), (4001.0, 2000.0), "if its unit is not the metre", "weld"),
    ] {
        let message = slice_mesh(&strips, at(from.0, from.1), at(to.0, to.1)).unwrap_err().to_string();
        assert!(message.contains(expected) && !message.contains(absent), "{from:?} {to:?}: {message}");
    }
}

/// A rectangle [0, 12] x [0, 9] in jittered triangles under a height.
fn jittered(random: &mut ChaCha8Rng, height: impl Fn(f64, f64) -> f64) -> Mesh {
    let (cols, rows) = (24_u32, 18_u32);
    let mut vertices = Vec::new();
    for row in 0..=rows {
        for col in 0..=cols {
            let mut inner = |index: u32, last: u32| if index == 0 || index == last { 0.0 } else { random.random_range(-0.3..0.3) };
            let (x, y) = (0.5 * (f64::from(col) + inner(col, cols)), 0.5 * (f64::from(row) + inner(row, rows)));
            vertices.push(Point3::new(x, y, height(x, y)));
        }
    }
    let mut triangles = Vec::new();
    for row in 0..rows {
        for col in 0..cols {
            let [a, b] = [row * (cols + 1) + col, (row + 1) * (cols + 1) + col];
            // Random orientation and random diagonal.
            triangles.extend(if random.random_bool(0.5) {
                [[a, a + 1, b + 1], [a, b, b + 1]]
            } else {
                [[a, a + 1, b], [b, b + 1, a + 1]]
            });
        }
    }
    Mesh::new(vertices, triangles).unwrap()
}

#[test]
fn planes_cones_and_paraboloids_give_their_own_profiles() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let (p, q) = (0.25, -0.4);
    let radius = |x: f64, y: f64| libm::hypot(x - 6.0, y - 4.5);
    for _ in 0..60 {
        let mut end = || at(random.random_range(0.0..12.0), random.random_range(0.0..9.0));
        let (from, to) = (end(), end());
        let plane = jittered(&mut random, |x, y| p * x + q * y + 2.0);
        let slice = check(&plane, from, to);
        let heading = slice.profile.heading;
        let expected = ProfileFacet::from_gradient(Vector2::new(p, q), heading);
        for point in &slice.profile.points {
            assert!((point.z_m - (p * point.map.x + q * point.map.y + 2.0)).abs() < 1e-9);
        }
        for facet in &slice.profile.facets {
            assert!((facet.normal - expected.normal).norm() < 1e-9);
            assert!((facet.cross_slope.radians() - expected.cross_slope.radians()).abs() < 1e-9);
        }
        // On an edge of length h a paraboloid z = r^2 / 8 has an error of at most h^2 / 32, a cone of slope 1/2 of h / 4;
        // edges are under 1.2 m.
        for (height, error_m) in [((|r| r * r / 8.0) as fn(f64) -> f64, 1.2 * 1.2 / 32.0), (|r| -0.5 * r, 0.3)] {
            let slice = check(&jittered(&mut random, |x, y| height(radius(x, y))), from, to);
            for point in &slice.profile.points {
                let exact = height(radius(point.map.x, point.map.y));
                assert!((point.z_m - exact).abs() <= error_m, "{} instead of {exact}", point.z_m);
            }
            assert!(slice.warnings().is_empty(), "{:?}", slice.warnings());
        }
    }
}

/// Elevation of the highest triangle at a map point, by barycentric coordinates; `None` if no triangle covers it.
fn highest(mesh: &Mesh, place: MapPoint) -> Option<f64> {
    let over = |[a, b, c]: [Point3<f64>; 3]| {
        let cross = |p: Point3<f64>, q: Point3<f64>| (p.xy() - place).perp(&(q.xy() - place));
        let weights = [cross(b, c), cross(c, a), cross(a, b)];
        let area: f64 = weights.iter().sum();
        (area.abs() > 1e-12 && weights.iter().all(|weight| weight / area >= 0.0))
            .then(|| (weights[0] * a.z + weights[1] * b.z + weights[2] * c.z) / area)
    };
    mesh.triangles().filter_map(over).max_by(f64::total_cmp)
}

#[test]
fn a_heap_of_random_triangles_has_the_upper_envelope_that_a_search_through_all_of_them_finds() {
    let mut random = ChaCha8Rng::seed_from_u64(12);
    let (mut compared, mut walls) = (0, 0);
    for case in 0..160 {
        let count = [1, 3, 12, 60][case % 4];
        // Integer coordinates half of the time: shared corners, upright triangles, edges along the plane.
        let mut coordinate = |whole: bool, low: f64, high: f64| {
            let value: f64 = random.random_range(low..high);
            if whole { value.round() } else { value }
        };
        let mut vertices: Vec<Point3<f64>> = floor().iter().map(|&[x, y, z]| Point3::new(x, y, z)).collect();
        let mut triangles = vec![[0, 1, 2], [0, 2, 3]];
        for _ in 0..count {
            let first = u32::try_from(vertices.len()).unwrap();
            vertices.extend((0..3).map(|_| {
                let whole = case % 2 == 0;
                Point3::new(coordinate(whole, 0.0, 10.0), coordinate(whole, 0.0, 10.0), coordinate(whole, -1.0, 6.0))
            }));
            triangles.push([first, first + 1, first + 2]);
        }
        let heap = Mesh::new(vertices, triangles).unwrap();
        for _ in 0..4 {
            let mut end = || at(coordinate(case % 3 == 0, 0.0, 10.0), coordinate(case % 3 == 0, 0.0, 10.0));
            let (from, to) = (end(), end());
            if (to - from).norm() < 0.1 {
                continue;
            }
            let slice = check(&heap, from, to);
            walls += slice.walls.len();
            let points = &slice.profile.points;
            for pair in points.windows(2) {
                let (middle, z_m) = (nalgebra::center(&pair[0].map, &pair[1].map), 0.5 * (pair[0].z_m + pair[1].z_m));
                let beside = |wall: &Wall| (middle - wall.map).norm() < 2.0 * WALL_RUN_M;
                if slice.walls.iter().any(beside) || pair[1].x_m - pair[0].x_m < 1e-6 {
                    continue;
                }
                let expected = highest(&heap, middle).unwrap();
                assert!((z_m - expected).abs() < 1e-6, "case {case}: {z_m} instead of {expected} at {middle} from {from} to {to}");
                compared += 1;
            }
        }
    }
    assert!(compared > 2000 && walls > 200, "{compared} {walls}");
}
