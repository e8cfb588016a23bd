//! Slices of meshes against slices of DEMs, against meshes from other sources, and against the paper's simple scenario.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and says why it skips")]
#![expect(clippy::unreadable_literal, reason = "as another program printed them")]

use std::path::{Path, PathBuf};

use chta::chain::csv::read_chain_csv_file;
use chta::quantity::MapPoint;
use chta::terrain::{Dem, GeoReference, Mesh, MeshSlice, ProfilePoint, SyntheticTerrain, read_mesh, slice, slice_mesh, synthesise};
use nalgebra::Point3;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// A DEM as the triangles that its slice cuts, in shuffled order and with both orientations.
fn triangulated(dem: &Dem, random: &mut ChaCha8Rng) -> Mesh {
    let cols = u32::try_from(dem.cols()).unwrap();
    let posts = (0..dem.rows()).flat_map(|row| (0..dem.cols()).map(move |col| (row, col)));
    let vertex = |(row, col)| {
        let map = dem.georeference().post(row, col);
        Point3::new(map.x, map.y, dem.elevation(row, col).unwrap())
    };
    let mut triangles = Vec::new();
    for row in 0..u32::try_from(dem.rows()).unwrap() - 1 {
        for col in 0..cols - 1 {
            let [north_west, south_west] = [row * cols + col, (row + 1) * cols + col];
            triangles.push([north_west, south_west, south_west + 1]);
            triangles.push([north_west, north_west + 1, south_west + 1]);
        }
    }
    for i in (1..triangles.len()).rev() {
        triangles.swap(i, random.random_range(0..=i));
        triangles[i].rotate_left(random.random_range(0..3));
    }
    Mesh::new(posts.map(vertex).collect(), triangles).unwrap()
}

fn synthetic(seed: u64, south_west: MapPoint, spacing_m: f64) -> Dem {
    let terrain =
        SyntheticTerrain { rows: 14, cols: 19, seed, south_west, spacing_m, craters: None, ..SyntheticTerrain::default() };
    synthesise(&terrain).unwrap()
}

#[test]
fn a_mesh_that_triangulates_a_dem_has_the_slices_of_the_dem() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let maps = [(MapPoint::new(0.0, 0.0), 1.0), (MapPoint::new(-75_360.5, 9_600.25), 5.0), (MapPoint::new(3.0, -7.0), 0.3)];
    for (number, (south_west, spacing_m)) in maps.into_iter().enumerate() {
        let dem = synthetic(number as u64, south_west, spacing_m);
        let mesh = triangulated(&dem, &mut random);
        let bounds = dem.bounds();
        for case in 0..400 {
            let mut end = || match case % 4 {
                // Random points; posts, so that planes run along rows, columns and diagonals; halves of the spacing.
                0 => {
                    bounds.min + (bounds.max - bounds.min).component_mul(&nalgebra::Vector2::new(random.random(), random.random()))
                }
                1 | 2 => dem.georeference().post(random.random_range(0..dem.rows()), random.random_range(0..dem.cols())),
                _ => nalgebra::center(
                    &dem.georeference().post(random.random_range(0..dem.rows()), random.random_range(0..dem.cols())),
                    &dem.georeference().post(random.random_range(0..dem.rows()), random.random_range(0..dem.cols())),
                ),
            };
            let (from, to) = (end(), end());
            if from == to {
                continue;
            }
            let expected = slice(&dem, from, to).unwrap();
            let MeshSlice { profile, layers, walls } = slice_mesh(&mesh, from, to).unwrap();
            assert_eq!(profile.points.len(), expected.points.len(), "map {number}: {from} to {to}");
            assert_eq!((profile.heading, layers.places, walls.len()), (expected.heading, 0, 0));
            for (a, b) in profile.points.iter().zip(&expected.points) {
                let near = (a.x_m - b.x_m).abs() < 1e-9 && (a.z_m - b.z_m).abs() < 1e-9 && (a.map - b.map).norm() < 1e-9;
                assert!(near, "map {number}: {a:?} instead of {b:?}");
            }
            for (a, b) in profile.facets.iter().zip(&expected.facets) {
                assert!((a.cross_slope.radians() - b.cross_slope.radians()).abs() < 1e-9, "{a:?} instead of {b:?}, {from} to {to}");
            }
        }
    }
}

#[test]
fn the_same_holds_with_posts_of_a_pattern_and_gradients_that_change_everywhere() {
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let elevations = (0..12 * 9).map(|i| f64::from((i * 7919) % 101) / 16.0).collect();
    let dem = Dem::new(9, 12, elevations, GeoReference::local(MapPoint::new(-512.0, 1024.0), 0.5, 2.0).unwrap()).unwrap();
    let mesh = triangulated(&dem, &mut random);
    let post = |row, col| dem.georeference().post(row, col);
    for (from, to) in [(post(4, 0), post(4, 11)), (post(0, 5), post(8, 5)), (post(0, 2), post(8, 10)), (post(8, 0), post(0, 8))] {
        let (expected, found) = (slice(&dem, from, to).unwrap(), slice_mesh(&mesh, from, to).unwrap().profile);
        // On posts and on edges there is no rounding.
        let places = |points: &[ProfilePoint]| points.iter().map(|point| (point.map, point.z_m)).collect::<Vec<_>>();
        assert_eq!(places(&found.points), places(&expected.points));
        for (a, b) in found.facets.iter().zip(&expected.facets) {
            assert!((a.normal - b.normal).norm() < 1e-12, "{a:?} instead of {b:?}");
        }
    }
}

/// A file of the shared folder; `None` with a printed reason if it is absent.
fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared").join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} is absent", path.display());
    None
}

/// Elevation of a slice at a fraction of its length.
fn elevation(slice: &MeshSlice, share: f64) -> f64 {
    let points = &slice.profile.points;
    let x_m = share * slice.profile.length_m();
    let right = points.partition_point(|point| point.x_m < x_m).clamp(1, points.len() - 1);
    let (a, b) = (points[right - 1], points[right]);
    a.z_m + (x_m - a.x_m) / (b.x_m - a.x_m) * (b.z_m - a.z_m)
}

/// Elevation of the highest triangle over a point of the map.
fn highest(mesh: &Mesh, place: MapPoint) -> f64 {
    let over = |[a, b, c]: [Point3<f64>; 3]| {
        let cross = |p: Point3<f64>, q: Point3<f64>| (p.xy() - place).perp(&(q.xy() - place));
        let weights = [cross(b, c), cross(c, a), cross(a, b)];
        let area: f64 = weights.iter().sum();
        let inside = area.abs() > 1e-15 && weights.iter().all(|weight| weight / area >= 0.0);
        inside.then(|| (weights[0] * a.z + weights[1] * b.z + weights[2] * c.z) / area)
    };
    mesh.triangles().filter_map(over).fold(f64::NEG_INFINITY, f64::max)
}

/// Slices a foreign mesh and compares fifty positions along it with a search through all triangles; returns how many of them have
/// several surfaces.
fn check_transect(mesh: &Mesh, from: MapPoint, to: MapPoint) -> usize {
    let slice = slice_mesh(mesh, from, to).unwrap();
    for share in (1..50).map(|i| f64::from(i) / 50.0) {
        let place = from + (to - from) * share;
        if slice.walls.iter().all(|wall| (wall.map - place).norm() > 0.01) {
            let (found, expected) = (elevation(&slice, share), highest(mesh, place));
            assert!((found - expected).abs() < 1e-6 * mesh.median_edge_m().max(1.0), "{found} instead of {expected} at {place}");
        }
    }
    let warnings = slice.warnings();
    assert_eq!(warnings.len(), usize::from(slice.layers.places > 0) + usize::from(!slice.walls.is_empty()));
    assert!(slice.layers.places == 0 || warnings[0].contains("uppermost"));
    eprintln!("{from} to {to}: {} vertices, {} walls, {:?}", slice.profile.points.len(), slice.walls.len(), slice.layers);
    slice.layers.places
}

fn read_shared(name: &str, scale: f64, triangles: usize) -> Option<Mesh> {
    let file = read_mesh(&shared(name)?, scale).unwrap();
    assert_eq!(file.mesh.triangle_count() + file.mesh.dropped_triangles(), triangles, "{name}");
    assert_eq!(file.warnings.len(), usize::from(file.mesh.dropped_triangles() > 0), "{name}: {:?}", file.warnings);
    Some(file.mesh)
}

#[test]
fn bounding_boxes_of_the_meshes_agree_with_another_reader() {
    // Computed in Python with struct and float.
    for (name, triangles, x, y, z) in [
        (
            "mesh/scene_jump10.stl",
            696,
            [-5.505218029022217, 7.696423053741455],
            [-3.0677671432495117, 3.252018451690674],
            [-0.6753787398338318, 8.039388656616211],
        ),
        (
            "mesh/envir3d_1.stl",
            47_733,
            [-4.347285747528076, 4.0252814292907715],
            [-4.055268287658691, 4.069412708282471],
            [-0.7295351028442383, 2.641193389892578],
        ),
        ("dem/ryugu_test.obj", 5_932, [-0.50584, 0.51273], [-0.51332, 0.50588], [-0.47563, 0.48856]),
    ] {
        let Some(mesh) = read_shared(name, 1.0, triangles) else { continue };
        let bounds = mesh.bounds();
        assert_eq!(
            ([bounds.map.min.x, bounds.map.max.x], [bounds.map.min.y, bounds.map.max.y], [bounds.low_m, bounds.high_m]),
            (x, y, z),
            "{name}"
        );
    }
}

#[test]
fn the_platforms_of_the_planning_paper_are_sliced_and_the_air_between_them_is_a_gap() {
    let Some(mesh) = read_shared("mesh/scene_jump10.stl", 1.0, 696) else { return };
    let at = MapPoint::new;
    for (from, to) in [
        (at(-4.3, 2.7), at(-3.1, 1.7)),
        (at(0.0, 2.7), at(1.2, 1.8)),
        (at(5.8, 0.7), at(7.0, -0.2)),
        (at(-2.5, -1.6), at(-1.3, -2.5)),
        (at(2.0, -2.5), at(3.0, -1.6)),
    ] {
        assert!(check_transect(&mesh, from, to) > 0, "platforms are closed bodies, with several surfaces");
    }
    let message = slice_mesh(&mesh, at(6.2, 0.5), at(-4.4, -1.5)).unwrap_err().to_string();
    assert!(message.contains("meets no triangle of the mesh from x = ") && message.contains("more such stretches"), "{message}");
}

#[test]
fn cave_windows_and_ryugu_are_sliced_along_their_upper_surface() {
    let at = MapPoint::new;
    let transects =
        [[0.4, 0.4, 0.6, 0.6], [0.35, 0.5, 0.65, 0.5], [0.5, 0.3, 0.5, 0.7], [0.4, 0.62, 0.6, 0.41], [0.45, 0.3, 0.55, 0.5]];
    for (name, scale, triangles, closed) in [
        ("mesh/cave_mono_short_1.stl", 1.0, 33_513, true),
        ("mesh/envir3d_1.stl", 1.0, 47_733, false),
        ("dem/ryugu_test.obj", 1000.0, 5_932, true),
    ] {
        let Some(mesh) = read_shared(name, scale, triangles) else { continue };
        let bounds = mesh.bounds().map;
        let place = |u: f64, v: f64| bounds.min + (bounds.max - bounds.min).component_mul(&(at(u, v).coords));
        for [u0, v0, u1, v1] in transects {
            eprint!("{name}, ");
            let several = check_transect(&mesh, place(u0, v0), place(u1, v1));
            assert!(several > 0 || !closed, "{name}");
        }
    }
}

#[test]
fn the_simple_mesh_gives_the_vertices_of_the_simple_chain() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    let chain = read_chain_csv_file(folder.join("chains/simple.csv")).unwrap().chain;
    let mesh = read_mesh(&folder.join("mesh/simple.obj"), 1.0).unwrap().mesh;
    // The corners lie alternately north and south of the plane, and every vertex of the chain half-way between two of them.
    let mut corner = Point3::new(-1.0, 4.0, -0.25);
    let mut corners = vec![corner];
    for vertex in chain.vertices() {
        corner = Point3::new(2.0 * vertex.x_m - corner.x, -corner.y, 2.0 * vertex.z_m - corner.z);
        corners.push(corner);
    }
    assert_eq!(mesh.vertices(), corners);
    let slice = slice_mesh(&mesh, MapPoint::new(0.0, 0.0), MapPoint::new(12.0, 0.0)).unwrap();
    let vertices: Vec<(f64, f64)> = slice.profile.points.iter().map(|point| (point.x_m, point.z_m)).collect();
    assert_eq!(vertices, chain.vertices().iter().map(|vertex| (vertex.x_m, vertex.z_m)).collect::<Vec<_>>());
    assert!(slice.warnings().is_empty());
    // Every polygon is tilted, which the slice alone does not show.
    assert!(slice.profile.facets.iter().all(|facet| facet.cross_slope.degrees() > 3.0));
}
