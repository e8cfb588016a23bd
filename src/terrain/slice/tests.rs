//! Compares the slice with slower methods: exact rational arithmetic, and barycentric coordinates by brute force.
#![expect(clippy::cast_precision_loss, reason = "small rasters")]

use num_rational::BigRational;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::*;
use crate::terrain::GeoReference;

fn dem(rows: usize, cols: usize, map: GeoReference, z: impl Fn(usize, usize) -> f64) -> Dem {
    let elevations = (0..rows * cols).map(|index| z(index / cols, index % cols)).collect();
    Dem::new(rows, cols, elevations, map).unwrap()
}

fn local(dx_m: f64, dy_m: f64) -> GeoReference {
    GeoReference::local(MapPoint::new(0.0, 0.0), dx_m, dy_m).unwrap()
}

/// Irregular bumps.
fn bumps(row: usize, col: usize) -> f64 {
    ((row * 7919 + col * 104_729) % 1009) as f64 / 64.0
}

/// Checks the properties of every slice: x strictly increasing from 0 to the length, one facet fewer than points, unit
/// normals.
fn check_shape(profile: &Profile, from: MapPoint, to: MapPoint) {
    assert_eq!(profile.points[0].x_m, 0.0);
    assert_eq!(profile.length_m(), libm::hypot((to - from).x, (to - from).y));
    assert_eq!((profile.points[0].map, profile.points.last().unwrap().map), (from, to));
    assert!(profile.points.windows(2).all(|pair| pair[0].x_m < pair[1].x_m));
    assert_eq!(profile.facets.len() + 1, profile.points.len());
    assert!(profile.facets.iter().all(|facet| (facet.normal.norm() - 1.0).abs() < 1e-12 && facet.normal.z > 0.0));
}

/// Elevation by barycentric coordinates in the triangle that contains the point, found by trying all triangles of its square.
fn brute_elevation(dem: &Dem, at: MapPoint) -> f64 {
    let map = dem.georeference();
    let mut best = (f64::NEG_INFINITY, f64::NAN);
    for row in 0..dem.rows() - 1 {
        for col in 0..dem.cols() - 1 {
            let [north_west, north_east, south_west, south_east] =
                [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(r, c)| (row + r, col + c));
            if at.x < map.post(row, col).x - map.dx_m() || at.x > map.post(row, col).x + 2.0 * map.dx_m() {
                continue;
            }
            for corners in [[north_west, north_east, south_east], [north_west, south_west, south_east]] {
                let [a, b, c] = corners.map(|(r, c)| map.post(r, c));
                let cross = |p: Vector2<f64>, q: Vector2<f64>| p.x * q.y - p.y * q.x;
                let area = cross(b - a, c - a);
                let weights = [cross(b - at, c - at) / area, cross(c - at, a - at) / area, cross(a - at, b - at) / area];
                let inside = weights.iter().copied().fold(f64::INFINITY, f64::min);
                let z = corners.iter().zip(weights).map(|(&(r, c), weight)| weight * dem.elevation(r, c).unwrap()).sum();
                if inside > best.0 {
                    best = (inside, z);
                }
            }
        }
    }
    assert!(best.0 > -1e-6, "no triangle contains ({}, {})", at.x, at.y);
    best.1
}

#[test]
fn random_slices_agree_with_brute_force_at_points_and_middles() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for case in 0..400 {
        let offsets = [0.0, -75_360.0, 609_600.0, 4.3e6, -1.0e3];
        let offset = MapPoint::new(offsets[case % 5], offsets[(case / 5) % 5]);
        let (dx_m, dy_m) = (random.random_range(0.3..8.0), random.random_range(0.3..8.0));
        let (rows, cols) = (random.random_range(2..12), random.random_range(2..12));
        let ground = dem(rows, cols, GeoReference::local(offset, dx_m, dy_m).unwrap(), bumps);
        let bounds = ground.bounds();
        let mut inside =
            || MapPoint::new(random.random_range(bounds.min.x..bounds.max.x), random.random_range(bounds.min.y..bounds.max.y));
        let (from, mut to) = (inside(), inside());
        if case % 7 == 0 {
            to = from + (to - from) * 1e-4;
        }
        let profile = slice(&ground, from, to).unwrap();
        check_shape(&profile, from, to);
        for (pair, facet) in profile.points.windows(2).zip(&profile.facets) {
            let middle = nalgebra::center(&pair[0].map, &pair[1].map);
            // Map coordinates of millions resolve 1e-9 m, and slopes reach 50.
            let tolerance = 1e-7;
            assert!((brute_elevation(&ground, pair[0].map) - pair[0].z_m).abs() < tolerance);
            assert!((brute_elevation(&ground, middle) - 0.5 * (pair[0].z_m + pair[1].z_m)).abs() < tolerance);
            // The facet's gradient along the heading is the slope of the segment.
            let run = pair[1].x_m - pair[0].x_m;
            let along = -(facet.normal.x * profile.heading.x + facet.normal.y * profile.heading.y) / facet.normal.z;
            assert!((along * run - (pair[1].z_m - pair[0].z_m)).abs() < tolerance);
        }
        let back = slice(&ground, to, from).unwrap();
        assert_eq!(back.points.len(), profile.points.len());
        for (there, back) in profile.points.iter().zip(back.points.iter().rev()) {
            assert_eq!((there.map, there.z_m), (back.map, back.z_m));
            assert!((there.x_m + back.x_m - profile.length_m()).abs() < 1e-9);
        }
        assert!(profile.facets.iter().eq(back.facets.iter().rev()));
    }
}

/// Crossings of a transect between lattice points given as fractions, in exact arithmetic: (fraction of the transect,
/// elevation).
fn exact_profile(ground: &Dem, from: &[BigRational; 2], to: &[BigRational; 2]) -> Vec<(BigRational, BigRational)> {
    use num_traits::{One, Zero};
    let zero = BigRational::zero();
    let step = [&to[0] - &from[0], &to[1] - &from[1]];
    let mut shares = vec![zero.clone(), BigRational::one()];
    for normal in [[1, 0], [0, 1], [1, -1]] {
        let dot = |p: &[BigRational; 2]| {
            &p[0] * BigRational::from_integer(normal[0].into()) + &p[1] * BigRational::from_integer(normal[1].into())
        };
        let (begin, change) = (dot(from), dot(&step));
        if change.is_zero() {
            continue;
        }
        for line in -40..40 {
            let share = (BigRational::from_integer(line.into()) - &begin) / &change;
            if share > zero && share < BigRational::one() {
                shares.push(share);
            }
        }
    }
    shares.sort();
    shares.dedup();
    let height = |row: usize, col: usize| BigRational::from_float(ground.elevation(row, col).unwrap()).unwrap();
    let elevation = |share: &BigRational| {
        let [u, v] = [&from[0] + share * &step[0], &from[1] + share * &step[1]];
        let index = |value: &BigRational, count: usize| -> usize {
            let floor: i64 = value.floor().to_integer().try_into().unwrap();
            usize::try_from(floor).unwrap().min(count - 2)
        };
        let (row, col) = (index(&v, ground.rows()), index(&u, ground.cols()));
        let (u, v) = (u - BigRational::from_integer(col.into()), v - BigRational::from_integer(row.into()));
        let (nw, ne, sw, se) = (height(row, col), height(row, col + 1), height(row + 1, col), height(row + 1, col + 1));
        if u >= v { &nw + &u * (&ne - &nw) + &v * (&se - &ne) } else { &nw + &v * (&sw - &nw) + &u * (&se - &sw) }
    };
    shares.into_iter().map(|share| (share.clone(), elevation(&share))).collect()
}

#[test]
fn slices_between_lattice_fractions_have_the_exact_vertices() {
    use num_traits::ToPrimitive;
    // Spacings and offsets are powers of two, so that map coordinates are exact and only the slice can round.
    let ground = dem(17, 17, GeoReference::local(MapPoint::new(-512.0, 1024.0), 0.5, 2.0).unwrap(), bumps);
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for case in 0..600 {
        // Posts, halves, quarters: many coincidences.
        let divisor = [1_i64, 1, 2, 4][case % 4];
        let mut fraction = || BigRational::new(random.random_range(0..=16 * divisor).into(), divisor.into());
        let (from, to) = ([fraction(), fraction()], [fraction(), fraction()]);
        if from == to {
            continue;
        }
        let place =
            |p: &[BigRational; 2]| MapPoint::new(-512.0 + 0.5 * p[0].to_f64().unwrap(), 1024.0 - 2.0 * p[1].to_f64().unwrap());
        let profile = slice(&ground, place(&from), place(&to)).unwrap();
        let exact = exact_profile(&ground, &from, &to);
        assert_eq!(profile.points.len(), exact.len(), "from {from:?} to {to:?}");
        for (point, (share, z)) in profile.points.iter().zip(&exact) {
            assert!((point.x_m - share.to_f64().unwrap() * profile.length_m()).abs() < 1e-12);
            assert!((point.z_m - z.to_f64().unwrap()).abs() < 1e-12);
            let (u, v) = ((point.map.x + 512.0) / 0.5, (1024.0 - point.map.y) / 2.0);
            if u.fract() == 0.0 && v.fract() == 0.0 {
                assert_eq!(point.z_m, z.to_f64().unwrap(), "a post's own elevation");
            }
        }
    }
}

#[test]
fn along_rows_columns_and_diagonals_only_posts_are_vertices_and_exact() {
    let ground = dem(9, 9, GeoReference::local(MapPoint::new(75_360.0, -609_600.0), 5.0, 5.0).unwrap(), bumps);
    let post = |row, col| ground.georeference().post(row, col);
    for (begin, step, posts) in [
        ((4, 0), (0, 1), 9),
        ((0, 3), (1, 0), 9),
        ((1, 0), (1, 1), 8),
        ((0, 0), (0, 1), 9),
        ((8, 0), (0, 1), 9),
        ((0, 8), (1, 0), 9),
    ] {
        let at = |k: usize| (begin.0 + step.0 * k, begin.1 + step.1 * k);
        let (first, last) = (at(0), at(posts - 1));
        let profile = slice(&ground, post(first.0, first.1), post(last.0, last.1)).unwrap();
        assert_eq!(profile.points.len(), posts);
        for (k, point) in profile.points.iter().enumerate() {
            let (row, col) = at(k);
            assert_eq!((point.z_m, point.map), (bumps(row, col), post(row, col)));
            if step.0 + step.1 == 1 {
                assert_eq!(point.x_m, 5.0 * k as f64);
            }
        }
    }
    // The other diagonal crosses the dividing line of every square in its middle.
    let profile = slice(&ground, post(8, 0), post(0, 8)).unwrap();
    assert_eq!(profile.points.len(), 17);
    assert_eq!(profile.points[1].z_m, bumps(7, 0) + 0.5 * (bumps(8, 1) - bumps(7, 0)));
}

#[test]
fn on_an_edge_the_larger_cross_slope_of_its_two_facets_is_used() {
    // Flat to the north of the middle row, a slope of 45 degrees to the south of it.
    let roof = dem(3, 3, local(1.0, 1.0), |row, _| if row == 2 { -1.0 } else { 0.0 });
    let walk = |y_m: f64| slice(&roof, MapPoint::new(0.0, y_m), MapPoint::new(2.0, y_m)).unwrap();
    let on_edge = walk(-1.0);
    assert!(on_edge.facets.iter().all(|facet| (facet.cross_slope.degrees() - 45.0).abs() < 1e-12));
    assert!(walk(-1.0 + 5e-10).facets.iter().all(|facet| (facet.cross_slope.degrees() - 45.0).abs() < 1e-12));
    assert!(walk(-1.0 + 2e-9).facets.iter().all(|facet| facet.cross_slope.degrees() == 0.0));
    // On the border there is only one facet.
    assert!(walk(0.0).facets.iter().all(|facet| facet.cross_slope.degrees() == 0.0));
    assert!(walk(-2.0).facets.iter().all(|facet| (facet.cross_slope.degrees() - 45.0).abs() < 1e-12));
    // On the diagonal: flat in the south-west half, rising to the north-east post.
    let corner = dem(2, 2, local(1.0, 1.0), |row, col| if (row, col) == (0, 1) { 1.0 } else { 0.0 });
    let diagonal = slice(&corner, MapPoint::new(0.0, 0.0), MapPoint::new(1.0, -1.0)).unwrap();
    assert_eq!(diagonal.points.len(), 2);
    assert!((diagonal.facets[0].cross_slope.slope() - 2.0_f64.sqrt()).abs() < 1e-12);
    // A column with a steeper facet to its west than to its east.
    let column = dem(3, 3, local(1.0, 1.0), |_, col| [-2.0, 0.0, 1.0][col]);
    let north = slice(&column, MapPoint::new(1.0, -2.0), MapPoint::new(1.0, 0.0)).unwrap();
    assert!(
        north
            .facets
            .iter()
            .all(|facet| (facet.cross_slope.slope() - 2.0).abs() < 1e-12 && (facet.tilt().slope() - 2.0).abs() < 1e-12)
    );
}

#[test]
fn on_a_tilted_plane_every_facet_has_the_planes_normal() {
    let (p, q) = (0.3, -0.4);
    let plane = dem(20, 30, GeoReference::local(MapPoint::new(-40.0, 35.0), 2.0, 3.0).unwrap(), |row, col| {
        p * 2.0 * col as f64 - q * 3.0 * row as f64
    });
    let (from, to) = (MapPoint::new(-39.5, -20.25), MapPoint::new(17.0, 30.125));
    let profile = slice(&plane, from, to).unwrap();
    check_shape(&profile, from, to);
    let normal = nalgebra::Vector3::new(-p, -q, 1.0).normalize();
    let e = profile.heading;
    let along = p * e.x + q * e.y;
    for (pair, facet) in profile.points.windows(2).zip(&profile.facets) {
        assert!((facet.normal - normal).norm() < 1e-12);
        assert!((libm::sin(facet.cross_slope.radians()) - (normal.x * e.y - normal.y * e.x).abs()).abs() < 1e-12);
        assert!((pair[1].z_m - pair[0].z_m - along * (pair[1].x_m - pair[0].x_m)).abs() < 1e-11);
        // n_z = cos chi cos alpha (model section 1).
        let product = libm::cos(facet.cross_slope.radians()) * libm::cos(libm::atan(along));
        assert!((product - facet.normal.z).abs() < 1e-12);
    }
}

#[test]
fn a_paraboloid_is_met_within_its_interpolation_error() {
    // A paraboloid's interpolation error on an edge of length h at share s is exactly h^2 s (1 - s) / 2 times its curvature.
    let bowl = dem(21, 21, local(1.0, 1.0), |row, col| ((col as f64 - 10.0).powi(2) + (row as f64 - 10.0).powi(2)) / 8.0);
    let profile = slice(&bowl, MapPoint::new(0.25, -10.0), MapPoint::new(19.75, -10.0)).unwrap();
    assert_eq!(profile.points.len(), 21);
    assert_eq!(profile.points[1].z_m, 81.0 / 8.0);
    let cone = dem(21, 21, local(1.0, 1.0), |row, col| -(((col as f64 - 10.0).powi(2) + (row as f64 - 10.0).powi(2)).sqrt()));
    let through = slice(&cone, MapPoint::new(10.0, 0.0), MapPoint::new(10.0, -20.0)).unwrap();
    let summit = through.points.iter().max_by(|a, b| a.z_m.total_cmp(&b.z_m)).unwrap();
    assert_eq!((summit.z_m, summit.x_m), (0.0, 10.0));
    for (k, point) in through.points.iter().enumerate() {
        assert_eq!(point.z_m, -(k as f64 - 10.0).abs());
    }
}

#[test]
fn inside_one_facet_there_are_two_ends_and_one_segment() {
    let ground = dem(5, 5, GeoReference::local(MapPoint::new(4.3e6, -9.0), 10.0, 10.0).unwrap(), bumps);
    let from = MapPoint::new(4.3e6 + 15.0, -21.0);
    for reach_m in [1.0, 1e-3, 1e-7] {
        let to = MapPoint::new(from.x + reach_m, from.y);
        let profile = slice(&ground, from, to).unwrap();
        check_shape(&profile, from, to);
        assert_eq!(profile.points.len(), 2);
    }
}

#[test]
fn invalid_transects_are_refused_with_positions_and_numbers() {
    let mut elevations = vec![1.0; 25];
    elevations[12] = f64::NAN;
    let ground = Dem::new(5, 5, elevations, GeoReference::local(MapPoint::new(-10.0, 10.0), 5.0, 5.0).unwrap()).unwrap();
    let at = MapPoint::new;
    let message = |from, to| slice(&ground, from, to).unwrap_err().to_string();
    assert!(message(at(1.0, 1.0), at(1.0, 1.0)).contains("same point (1 m, 1 m)"));
    let off = message(at(0.0, 0.0), at(11.0, 0.0));
    assert!(off.contains("to point (11 m, 0 m)") && off.contains("x from -10 to 10 m and y from -10 to 10 m"), "{off}");
    assert!(message(at(f64::NAN, 0.0), at(1.0, 0.0)).contains("from point"));
    // The gap is the middle post: along its row, the facet before it already lacks an elevation.
    let gap = message(at(-10.0, 0.0), at(10.0, 0.0));
    assert!(gap.contains("meets no-data 7.500 m from the start, at map point (-2.500 m, 0.000 m)"), "{gap}");
    let back = message(at(10.0, 0.0), at(-10.0, 0.0));
    assert!(back.contains("7.500 m from the start, at map point (2.500 m"), "{back}");
    // Next to it, and along the edge of a facet with a gap, the ground is complete.
    assert!(slice(&ground, at(-10.0, 6.0), at(10.0, 6.0)).is_ok());
    assert!(slice(&ground, at(-10.0, 5.0), at(10.0, 5.0)).is_ok());
    assert!(slice(&ground, at(-9.0, 4.9), at(-8.9, 4.9)).is_ok_and(|profile| profile.points.len() == 2));
}

#[test]
fn a_plane_that_grazes_a_row_keeps_its_vertices_apart() {
    let ground = dem(40, 40, local(1.0, 1.0), bumps);
    for rise_m in [1e-13, 1e-11, 1e-10, 3e-10, 1e-9, 3e-9, 1e-8, 1e-6, 1e-3] {
        for level_m in [-20.0, -20.0 + 0.5 * rise_m, -20.0 - 2.0 * rise_m] {
            let (from, to) = (MapPoint::new(0.0, level_m - rise_m), MapPoint::new(39.0, level_m + rise_m));
            let profile = slice(&ground, from, to).unwrap();
            check_shape(&profile, from, to);
            for point in &profile.points {
                assert!((brute_elevation(&ground, point.map) - point.z_m).abs() < 1e-6);
            }
        }
    }
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// Number of vertices between two posts that are this many columns and rows apart: lines crossed, with each post in between
/// counted once instead of three times.
fn count_vertices(col_step: i64, row_step: i64) -> usize {
    let [columns, rows, diagonals] = [col_step, row_step, col_step - row_step].map(|step| usize::try_from(step.abs()).unwrap());
    let inner = [columns, rows, diagonals].iter().map(|count| count.saturating_sub(1)).sum::<usize>();
    let posts = greatest_common_divisor(columns, rows) - 1;
    let families = [columns, rows, diagonals].iter().filter(|count| **count > 0).count();
    2 + inner - posts * (families - 1)
}

#[test]
fn between_posts_of_maps_whose_coordinates_round_no_vertex_is_lost_or_doubled() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let side = 41_i64;
    for (offset_m, dx_m, dy_m) in
        [(4.3e6, 0.1, 0.1), (-609_600.3, 0.3, 0.7), (75_360.7, 5.1, 3.3), (0.1, 1.01, 1.01), (1.0e8, 0.9, 1.1), (0.0, 1e-3, 1e3)]
    {
        let map = GeoReference::local(MapPoint::new(offset_m, -offset_m), dx_m, dy_m).unwrap();
        let ground = dem(41, 41, map, bumps);
        for _ in 0..300 {
            let [from, to] = std::array::from_fn(|_| [random.random_range(0..side), random.random_range(0..side)]);
            if from == to {
                continue;
            }
            let index = |post: [i64; 2]| post.map(|value| usize::try_from(value).unwrap());
            let ([from_col, from_row], [to_col, to_row]) = (index(from), index(to));
            let post = |row, col| ground.georeference().post(row, col);
            let profile = slice(&ground, post(from_row, from_col), post(to_row, to_col)).unwrap();
            check_shape(&profile, post(from_row, from_col), post(to_row, to_col));
            assert_eq!(profile.points.len(), count_vertices(to[0] - from[0], to[1] - from[1]), "{offset_m} {dx_m} {from:?} {to:?}");
            let posts = greatest_common_divisor(from_col.abs_diff(to_col), from_row.abs_diff(to_row));
            for k in 0..=posts {
                let along = |begin: usize, end: usize| (begin * (posts - k) + end * k) / posts;
                let (row, col) = (along(from_row, to_row), along(from_col, to_col));
                let found = profile.points.iter().find(|point| (point.map - post(row, col)).norm() < 1e-3 * dx_m);
                assert_eq!(found.map(|point| (point.z_m, point.map)), Some((bumps(row, col), post(row, col))));
            }
        }
    }
}
