//! Hop maps against the direct method: slice and hop test for every pair of posts.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use std::path::Path;

use crate::{
    map_world::{World, friction, random_dem, random_hopper, random_surface},
    support::Draw,
};
use chta::{
    quantity::MapPoint,
    reach::map::{Journey, Post, PostHops, SECTORS, Search, UNREACHED, mobility, search},
    terrain::{Dem, GeoReference, read_dem, read_friction_raster, read_keep_out},
    world::{Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// Every pair of posts has the same verdict, and the same lofts up to rounding.
fn compare_pairs(world: &World, what: &str) -> (usize, usize) {
    let hops = PostHops::new(world.ground(), 1).unwrap();
    let (mut yes, mut no) = (0, 0);
    for from in world.posts(1) {
        let mut found = std::collections::HashMap::new();
        for offset in 0..hops.offset_count() {
            if let Some(to) = hops.landing(from, offset) {
                found.extend(hops.lofts(from, offset).unwrap().map(|(_, lofts)| (to, lofts)));
            }
        }
        for to in world.posts(1) {
            let expected = if to == from { None } else { world.lofts(from, to) };
            let quick = found.get(&to);
            assert_eq!(quick.is_some(), expected.is_some(), "{what}: {from:?} to {to:?}: {quick:?} against {expected:?}");
            if let (Some(quick), Some(expected)) = (quick, expected) {
                let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-7 * (1.0 + a.abs().max(b.abs()));
                assert!(near(quick.lower, expected.lower) && near(quick.upper, expected.upper), "{what}: {from:?} to {to:?}");
                yes += 1;
            } else {
                no += 1;
            }
        }
    }
    (yes, no)
}

#[test]
fn every_pair_of_random_grids_has_the_result_of_the_hop_test() {
    let mut draw = Draw::seeded(7);
    let (mut yes, mut no) = (0, 0);
    for number in 0..40 {
        let dem = random_dem(&mut draw, 8);
        let (hopper, gravity) = random_hopper(&mut draw);
        let world = World::new(dem, hopper, random_surface(&mut draw), gravity);
        let (joined, apart) = compare_pairs(&world, &format!("grid {number}"));
        yes += joined;
        no += apart;
    }
    assert!(yes > 8_000 && no > 8_000, "{yes} pairs joined, {no} not");
}

/// Compares whole maps in both directions, with one and with several threads; returns the hops of the direct method.
fn compare_maps(world: &World, start: Post, stride: usize, journeys: &[Journey], what: &str) -> Vec<i16> {
    let mut last = Vec::new();
    for &journey in journeys {
        let expected = world.plain_map(start, stride, journey);
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let found = pool.install(|| {
                let hops = PostHops::new(world.ground(), stride).unwrap();
                let start = Post { row: start.row / stride, col: start.col / stride };
                search(&hops, &[start.into()], Search { journey, ..Search::default() }, &()).unwrap()
            });
            assert_eq!(found.hops, expected, "{what}, {journey:?}, {threads} threads");
        }
        last = expected;
    }
    last
}

/// A window of a DEM, with some posts set to no-data.
pub(crate) fn cut_out(dem: &Dem, first: Post, side: usize, holes: usize, draw: &mut Draw) -> Dem {
    let posts = (0..side).flat_map(|row| (0..side).map(move |col| (first.row + row, first.col + col)));
    let mut heights: Vec<f64> = posts.map(|(row, col)| dem.elevation(row, col).unwrap_or(f64::NAN)).collect();
    for _ in 0..holes {
        let (row, col) = (draw.below(side - 2), draw.below(side - 2));
        for (down, right) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            heights[(row + down) * side + col + right] = f64::NAN;
        }
    }
    let map = dem.georeference();
    Dem::new(side, side, heights, GeoReference::local(map.post(first.row, first.col), map.dx_m(), map.dy_m()).unwrap()).unwrap()
}

/// Twenty cut-outs of a real DEM; from each start some post is reachable and at least a fifth of the posts is not.
fn compare_cut_outs(file: &str, hopper: Hopper, surface: SurfaceProperties, gravity_m_s2: f64, seed: u64) {
    const SIDE: usize = 24;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
    if !path.exists() {
        eprintln!("skipped: {} is absent", path.display());
        return;
    }
    let dem = read_dem(&path).unwrap();
    let mut draw = Draw::seeded(seed);
    let mut compared = 0;
    for _ in 0..400 {
        let first = Post { row: draw.below(dem.rows() - SIDE), col: draw.below(dem.cols() - SIDE) };
        let holes = if compared % 3 == 1 { 4 } else { 0 };
        let world = World::new(cut_out(&dem, first, SIDE, holes, &mut draw), hopper, surface, gravity_m_s2);
        let start = Post { row: draw.below(SIDE), col: draw.below(SIDE) };
        if world.dem.elevation(start.row, start.col).is_none() {
            continue;
        }
        let hops = PostHops::new(world.ground(), 1).unwrap();
        let map = search(&hops, &[start.into()], Search::default(), &()).unwrap();
        let reached = map.hops.iter().filter(|&&hops| hops > 0).count();
        if !(SIDE * SIDE / 4..=SIDE * SIDE * 4 / 5).contains(&reached) {
            continue;
        }
        let what = format!("{file} from row {}, column {}", first.row, first.col);
        compare_maps(&world, start, 1, &[Journey::Outbound], &what);
        compared += 1;
        if compared == 20 {
            return;
        }
    }
    panic!("only {compared} cut-outs of {file} have posts in reach and out of it");
}

#[test]
fn cut_outs_of_mars_have_the_hops_of_every_pair() {
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(4.5, 4.5) }).unwrap();
    compare_cut_outs("hirise_DTEEC_010228_1490_crop_120x70.tif", hopper, friction(0.6), 3.711, 11);
}

#[test]
fn cut_outs_of_the_moon_have_the_hops_of_every_pair() {
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(5.0, 5.0) }).unwrap();
    compare_cut_outs("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", hopper, friction(0.25), 1.62, 12);
}

/// Zones as polygons and as a mask, friction from a raster with holes: every pair has the verdict of the slice and the hop test.
#[test]
fn every_pair_under_zones_and_friction_has_the_result_of_the_hop_test() {
    let folder = tempfile::tempdir().unwrap();
    let mut draw = Draw::seeded(21);
    let (mut yes, mut no) = (0, 0);
    for number in 0..12 {
        let side = 8;
        let heights = (0..side * side).map(|_| draw.unit() * 0.8).collect();
        let dem = Dem::new(side, side, heights, GeoReference::local(MapPoint::new(0.0, 7.0), 1.0, 1.0).unwrap()).unwrap();
        let hopper = Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(4.0, 4.0) }).unwrap();
        let mut world = World::new(dem, hopper, friction(0.8), 2.0);
        let file = folder.path().join(format!("cover_{number}"));
        // On lattice lines, beside them, and a narrow triangle inside one square.
        let corner = [2.0, 2.5, 3.3][number % 3];
        let polygon = format!(
            r#"{{"type": "MultiPolygon", "coordinates": [[[[{corner}, 1], [5, 1], [5, {corner}], [{corner}, 4], [{corner}, 1]]],
                [[[6.2, 6.2], [6.4, 6.2], [6.3, 6.5], [6.2, 6.2]]]]}}"#
        );
        let raster = |values: &[f64], name: &str| {
            let rows: Vec<String> =
                values.chunks(4).map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")).collect();
            let header = "ncols 4\nnrows 4\nxllcorner -0.5\nyllcorner -0.5\ncellsize 2\nNODATA_value -9\n";
            let path = folder.path().join(format!("{name}_{number}.asc"));
            std::fs::write(&path, format!("{header}{}\n", rows.join("\n"))).unwrap();
            path
        };
        if number % 2 == 0 {
            std::fs::write(&file, polygon).unwrap();
            world.keep_out = Some(read_keep_out(&file, None, world.dem.bounds()).unwrap());
        } else if number % 4 == 1 {
            let mask = raster(&std::array::from_fn::<f64, 16, _>(|i| f64::from(u8::from(i == 5 || i == 11))), "mask");
            world.keep_out = Some(read_keep_out(&mask, None, world.dem.bounds()).unwrap());
        }
        if number >= 6 {
            let values: Vec<f64> = (0..16).map(|_| [0.5, 0.5, 1.1, -9.0][draw.below(4)]).collect();
            world.friction = Some(read_friction_raster(&raster(&values, "friction"), None).unwrap());
        }
        let (joined, apart) = compare_pairs(&world, &format!("cover {number}"));
        yes += joined;
        no += apart;
    }
    assert!(yes > 3_000 && no > 3_000, "{yes} pairs joined, {no} not");
}

#[test]
fn return_paths_and_strides_have_the_hops_of_every_pair() {
    let mut draw = Draw::seeded(33);
    let mut unlike = 0;
    for number in 0..6 {
        let side = 12;
        let dem = random_dem(&mut draw, side);
        let start = Post { row: 4, col: 6 };
        if dem.elevation(start.row, start.col).is_none() {
            continue;
        }
        // With a high landing speed and a low take-off speed, falling is easier than climbing.
        let hopper = Hopper::new(HopperLimits { clearance_m: 0.02, ..HopperLimits::with_speeds(2.2, 3.5) }).unwrap();
        let world = World::new(dem, hopper, friction(0.9), 1.62);
        let out = compare_maps(&world, start, 1, &[Journey::Outbound], &format!("grid {number}"));
        let back = compare_maps(&world, start, 1, &[Journey::Return], &format!("grid {number}"));
        unlike += out.iter().zip(&back).filter(|(out, back)| out != back).count();
        compare_maps(&world, start, 2, &[Journey::Outbound, Journey::Return], &format!("grid {number}, every second post"));
    }
    assert!(unlike > 50, "outbound and return hops differ only at {unlike} posts");
}

/// The least effort among paths of fewest hops, against a direct search over all pairs of neighbouring layers; and the paths
/// themselves.
#[test]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
fn efforts_are_the_least_of_all_paths_of_fewest_hops() {
    use chta::{
        ballistics::{Arc, LineOfSight, TakeoffChoice},
        graph::Effort,
        path::execute,
        reach::map::{joined, path_hops},
    };
    let mut draw = Draw::seeded(55);
    let mut compared = 0;
    for (effort, choice) in Effort::ALL.into_iter().zip([
        TakeoffChoice::LeastSpeed,
        TakeoffChoice::LeastSpeed,
        TakeoffChoice::LeastTime,
        TakeoffChoice::MidRange,
    ]) {
        let dem =
            Dem::new(9, 9, (0..81).map(|_| draw.unit()).collect(), GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 1.0).unwrap());
        let world = World::new(
            dem.unwrap(),
            Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(2.6, 2.8) }).unwrap(),
            friction(1.2),
            1.62,
        );
        let start = Post { row: 2, col: 1 };
        let posts = world.posts(1);
        let hops = world.plain_map(start, 1, Journey::Outbound);
        let mut expected = vec![f64::NAN; posts.len()];
        expected[start.row * 9 + start.col] = 0.0;
        for layer in 1..=hops.iter().copied().max().unwrap() {
            for to in (0..posts.len()).filter(|&to| hops[to] == layer) {
                let mut least = f64::INFINITY;
                for from in (0..posts.len()).filter(|&from| hops[from] == layer - 1) {
                    let Some(lofts) = world.lofts(posts[from], posts[to]) else { continue };
                    let run_m =
                        (posts[to].row as f64 - posts[from].row as f64).hypot(posts[to].col as f64 - posts[from].col as f64);
                    let height = |post: Post| world.dem.elevation(post.row, post.col).unwrap();
                    let sight = LineOfSight::new(run_m, height(posts[to]) - height(posts[from]));
                    let arc = Arc::new(sight, choice.loft(sight, lofts), 1.62);
                    let v = arc.takeoff_speed_m_s();
                    least = least.min(match effort {
                        Effort::TakeoffSpeed => expected[from] + v,
                        Effort::Energy => expected[from] + 0.5 * v * v,
                        Effort::Time => expected[from] + arc.flight_time_s(),
                        Effort::PeakSpeed => expected[from].max(v),
                    });
                }
                expected[to] = least;
            }
        }
        let post_hops = PostHops::new(world.ground(), 1).unwrap();
        let map = search(&post_hops, &[start.into()], Search { effort: Some((effort, choice)), ..Search::default() }, &()).unwrap();
        assert_eq!(map.hops, hops);
        for (index, (&found, &expected)) in map.effort.iter().zip(&expected).enumerate() {
            assert_eq!(found.is_nan(), expected.is_nan());
            assert!(found.is_nan() || (found - expected).abs() <= 1e-9 * expected, "{}: {found} against {expected}", effort.name());
            let Some(path) = map.path(&post_hops, posts[index]) else { continue };
            let flown = path_hops(&post_hops, &path, choice).unwrap();
            assert_eq!(flown.len(), usize::try_from(hops[index]).unwrap());
            for hop in &flown {
                let geometry = hop.test.chain().geometry();
                let (first, last) = geometry.extent_m();
                let ends = (geometry.station(first).unwrap(), geometry.station(last).unwrap());
                assert!(execute(hop.test.chain(), &hop.path, Some(ends)).passes());
            }
            let path = joined(&post_hops, &flown);
            let total = match effort {
                Effort::TakeoffSpeed => path.hops.iter().map(|hop| hop.takeoff_speed_m_s).sum(),
                Effort::Energy => path.totals.energy_j_kg,
                Effort::Time => path.totals.flight_time_s,
                Effort::PeakSpeed => path.totals.peak_takeoff_speed_m_s,
            };
            assert!((total - expected).abs() <= 1e-9 * (1.0 + expected), "{}: {total} against {expected}", effort.name());
            compared += 1;
        }
    }
    assert!(compared > 100, "{compared} posts compared");
}

#[test]
fn a_higher_speed_limit_never_makes_a_post_unreachable_or_farther() {
    let mut draw = Draw::seeded(77);
    for _ in 0..4 {
        let dem = random_dem(&mut draw, 20);
        let start = Post { row: 10, col: 10 };
        if dem.elevation(10, 10).is_none() {
            continue;
        }
        let mut before: Option<Vec<i16>> = None;
        for speed in [1.8, 2.2, 2.7, 3.5] {
            let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(speed, speed) }).unwrap();
            let world = World::new(dem.clone(), hopper, friction(0.9), 1.62);
            let hops = PostHops::new(world.ground(), 1).unwrap();
            let map = search(&hops, &[start.into()], Search::default(), &()).unwrap();
            for (&faster, &slower) in map.hops.iter().zip(before.iter().flatten()) {
                assert!(slower < 0 || (0..=slower).contains(&faster), "{slower} hops became {faster} at {speed} m/s");
            }
            before = Some(map.hops);
        }
    }
}

/// A level plane: one hop reaches `v^2 sin(2 theta) / g` at the steeper of 45 degrees and its cone's lower end, so the number of
/// hops depends on the distance only. A tilted plane: the parabola of safety, hop by hop, up and down its line of fall.
#[test]
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
fn planes_have_the_analytic_shape() {
    let plane = |slope: f64| {
        let side = 41;
        let heights = (0..side * side).map(|i| slope * f64::from(u32::try_from(i % side).unwrap())).collect();
        Dem::new(side, side, heights, GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 1.0).unwrap()).unwrap()
    };
    let (speed, gravity, mu) = (3.3, 1.62, 0.6f64);
    let map = |slope: f64| {
        let surface = SurfaceProperties { rest: RestSlope::Unlimited, ..friction(mu) };
        let world = World::new(plane(slope), Hopper::with_speeds(speed, speed).unwrap(), surface, gravity);
        let hops = PostHops::new(world.ground(), 1).unwrap();
        search(&hops, &[Post { row: 20, col: 20 }.into()], Search::default(), &()).unwrap().hops
    };
    // The cone allows hops at atan(1 / mu) or steeper.
    let least = libm::atan(1.0 / mu);
    let reach = speed * speed * libm::sin(2.0 * least) / gravity;
    let level = map(0.0);
    for row in 0..41i32 {
        for col in 0..41i32 {
            let distance = f64::from((row - 20).pow(2) + (col - 20).pow(2)).sqrt();
            let hops = level[usize::try_from(row * 41 + col).unwrap()];
            assert!(f64::from(hops) >= (distance / reach - 1e-9).ceil(), "({row}, {col}) in {hops} hops");
            assert_eq!(hops == 1, distance > 0.0 && distance <= reach, "({row}, {col}) in {hops} hops");
        }
    }
    let (disc, within) = (
        (1 - 20..21).flat_map(|row| (1 - 20..21).map(move |col: i32| f64::from(row * row + col * col).sqrt())),
        speed * speed / gravity,
    );
    let counted = |most: f64| disc.clone().filter(|&distance| distance > 0.0 && distance <= most).count() as f64;
    let world = World::new(plane(0.0), Hopper::with_speeds(speed, speed).unwrap(), friction(mu), gravity);
    let mobile = mobility(&PostHops::new(world.ground(), 1).unwrap(), &()).unwrap();
    assert!((mobile.disc_radius_m - within).abs() < 1e-6);
    assert!((f64::from(mobile.share[20 * 41 + 20]) - counted(reach) / counted(within)).abs() < 1e-6);
    assert_eq!(mobile.directions[20 * 41 + 20], f32::from(SECTORS));
    // Along a slope b the reach is 2 v^2 n / (g (1 + m^2)) for m = b + n, within take-off cone and both speeds.
    let slope = 0.2f64;
    let tilted = map(slope);
    for (sign, b) in [(1i32, slope), (-1, -slope)] {
        let tangent = |angle: f64| if angle >= std::f64::consts::FRAC_PI_2 { f64::INFINITY } else { libm::tan(angle) };
        let (alpha, phi) = (libm::atan(b), libm::atan(mu));
        let steepest = tangent(alpha + std::f64::consts::FRAC_PI_2 + phi);
        let flattest = tangent(alpha + std::f64::consts::FRAC_PI_2 - phi);
        // The landing cone about the same normal: b - n between its ends.
        let landing = -1.0 / libm::tan(alpha + phi);
        let mut farthest = 0.0f64;
        for step in 0..400_000 {
            let m = (flattest.max(2.0 * b - landing) + f64::from(step) * 1e-5).min(steepest);
            let n = m - b;
            let range = |slope_at: f64| 2.0 * speed * speed * n / (gravity * (1.0 + slope_at * slope_at));
            farthest = farthest.max(range(m).min(range(b - n)));
        }
        for distance in 1..=20i32 {
            let hops = tilted[usize::try_from(20 * 41 + 20 + sign * distance).unwrap()];
            assert_eq!(hops == 1, f64::from(distance) <= farthest, "{distance} m along slope {b}: {hops} hops, reach {farthest}");
        }
    }
}

/// Of a cone whose flank is steeper than friction holds, only the level surroundings can be reached.
#[test]
fn a_cone_too_steep_to_rest_on_is_an_island() {
    let (side, middle) = (31, 15.0f64);
    let heights = (0..side * side)
        .map(|i| {
            let (row, col) = (f64::from(u32::try_from(i / side).unwrap()), f64::from(u32::try_from(i % side).unwrap()));
            (0.9 * (9.0 - (row - middle).hypot(col - middle))).max(0.0)
        })
        .collect();
    let dem = Dem::new(side, side, heights, GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 1.0).unwrap()).unwrap();
    let world = World::new(dem, Hopper::with_speeds(3.0, 3.0).unwrap(), friction(0.6), 1.62);
    let hops = PostHops::new(world.ground(), 1).unwrap();
    let map = search(&hops, &[Post { row: 1, col: 1 }.into()], Search::default(), &()).unwrap();
    for (index, &hops) in map.hops.iter().enumerate() {
        let (row, col) = (f64::from(u32::try_from(index / side).unwrap()), f64::from(u32::try_from(index % side).unwrap()));
        let distance = (row - middle).hypot(col - middle);
        if distance < 7.5 {
            assert_eq!(hops, UNREACHED, "({row}, {col}) on the flank");
        } else if distance > 10.5 {
            assert!(hops >= 0, "({row}, {col}) on level ground");
        }
    }
    // The path around the cone is longer than the straight one: 26 m of chord and more of arc, at most v^2 / g = 5.6 m per hop.
    assert!(map.hops[29 * side + 29] > 7);
}
