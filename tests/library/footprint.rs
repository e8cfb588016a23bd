//! The plane fitted over a hopper's footprint: closed form against quadrature, planted planes and bumps, division of the ground, maps
//! against slices, and what hops, maps, trials and the checker make of it.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use std::{f64::consts::TAU, path::Path};

use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, FootprintRefusal, GroundForm, GroundRefusal, PolygonalChain, SegmentGround},
    graph::{Outcome, PointSpacing, SearchOptions, endpoint_refusal, proof, search},
    ground::{DemGround, PostRefusal, Surface},
    hop::{HopTest, Split},
    path::{Hop, HopPath, ViolatedLimit, execute, generate},
    quantity::{Angle, ChainPoint, MapPoint, VertexId},
    reach::map::{Post, PostHops},
    terrain::{Dem, FootprintFit, FootprintGap, GeoReference, OverlaidDem, Overlays, Surroundings, Triangles, read_dem},
    world::{Contact, Direction, FrictionCone, Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties},
};

use crate::support::Draw;

const MOON_M_S2: f64 = 1.6242;

fn surface(rest_deg: f64) -> SurfaceProperties {
    SurfaceProperties {
        grip: Some(Grip::Friction(FrictionCone::new(2.0).unwrap())),
        rest: RestSlope::AtMost(Angle::from_degrees(rest_deg)),
    }
}

fn hopper(speed_m_s: f64, footprint_m: f64, roughness_max_m: Option<f64>) -> Hopper {
    let limits =
        HopperLimits { footprint_m: Some(footprint_m), roughness_max_m, ..HopperLimits::with_speeds(speed_m_s, speed_m_s) };
    Hopper::new(limits).unwrap()
}

fn dem(rows: usize, cols: usize, (dx_m, dy_m): (f64, f64), mut height: impl FnMut(f64, f64) -> f64) -> Dem {
    let map = GeoReference::local(MapPoint::new(0.0, 0.0), dx_m, dy_m).unwrap();
    let posts = (0..rows).flat_map(|row| (0..cols).map(move |col| (row, col)));
    let heights = posts.map(|(row, col)| map.post(row, col)).map(|at| height(at.x, at.y)).collect();
    Dem::new(rows, cols, heights, map.clone()).unwrap()
}

fn fit(dem: &Dem, at: MapPoint, footprint_m: f64) -> Result<FootprintFit, FootprintGap> {
    Surroundings::whole(dem.clone().into()).fit(at, 0.0, footprint_m)
}

/// The same by sampling the polygon, without its closed form: the tangent of the plane and the greatest residual met.
fn sampled(dem: &Dem, at: MapPoint, footprint_m: f64) -> FootprintFit {
    const STEPS: u32 = 400;
    let (half_m, ground) = (0.5 * footprint_m, Triangles::of(dem));
    let sides: Vec<(f64, f64)> = (0..16).map(|side| f64::from(side) * TAU / 16.0).map(|a| (a.cos(), a.sin())).collect();
    let mut samples = Vec::new();
    for i in 0..STEPS {
        for j in 0..STEPS {
            let along = |k: u32| 1.02 * half_m * (2.0 * (f64::from(k) + 0.5) / f64::from(STEPS) - 1.0);
            let (x, y) = (along(i), along(j));
            if sides.iter().all(|(east, north)| x * east + y * north <= half_m) {
                let z = ground.at(MapPoint::new(at.x + x, at.y + y), ground.nominal()).unwrap().0;
                samples.push((nalgebra::Vector3::new(1.0, x, y), z));
            }
        }
    }
    let (mut normal, mut right) = (nalgebra::Matrix3::zeros(), nalgebra::Vector3::zeros());
    for (v, z) in &samples {
        normal += v * v.transpose();
        right += v * *z;
    }
    let plane = normal.try_inverse().unwrap() * right;
    let residual_m = samples.iter().map(|(v, z)| (z - plane.dot(v)).abs()).fold(0.0, f64::max);
    FootprintFit { tilt_slope: plane.y.hypot(plane.z), residual_m }
}

#[test]
fn the_closed_form_agrees_with_quadrature_on_random_dems() {
    let draw = &mut Draw::seeded(1404);
    for round in 0..40 {
        let spacing = (draw.uniform(0.5, 2.0), draw.uniform(0.5, 2.0));
        let rough = dem(12, 12, spacing, |_, _| draw.uniform(0.0, 1.0));
        let footprint_m = draw.log_uniform(0.2, 4.0);
        let bounds = rough.bounds();
        let inside = |draw: &mut Draw, low: f64, high: f64| draw.uniform(low + 0.52 * footprint_m, high - 0.52 * footprint_m);
        let at = MapPoint::new(inside(draw, bounds.min.x, bounds.max.x), inside(draw, bounds.min.y, bounds.max.y));
        let (exact, sampled) = (fit(&rough, at, footprint_m).unwrap(), sampled(&rough, at, footprint_m));
        // A sample stands for a square of 1/200 of the footprint, whose border is ragged; the residual is met next to its place.
        let size = exact.residual_m / footprint_m + 0.1 * exact.tilt_slope;
        assert!((exact.tilt_slope - sampled.tilt_slope).abs() < 0.02 * size + 1e-9, "{round}: {exact:?} {sampled:?}");
        assert!(sampled.residual_m < exact.residual_m * 1.01 + 1e-9, "{round}: {exact:?} {sampled:?}");
        assert!(sampled.residual_m > exact.residual_m * 0.95 - 0.004 * footprint_m, "{round}: {exact:?} {sampled:?}");
    }
}

/// Each row: what is planted, and the right values with how they are known.
#[test]
fn planted_ground_has_the_slope_and_the_residual_known_by_hand() {
    let area = |footprint_m: f64| 16.0 * (TAU / 32.0).tan() * footprint_m * footprint_m / 4.0;
    let far = MapPoint::new(3.1, -4.3);
    let tilted = |a: f64, b: f64| dem(12, 9, (1.0, 1.3), move |x, y| 700.0 + a * x + b * y);
    let bump = |height: f64| dem(11, 11, (1.0, 1.0), move |x, y| if (x, y) == (5.0, -5.0) { height } else { 0.0 });
    let middle = MapPoint::new(5.0, -5.0);
    // A hat over one post: six facets of 1/2 m^2 around it, each a third of its height high in the mean, so 1 m^3 per metre.
    let hat = |footprint_m: f64| 1.0 - 1.0 / area(footprint_m);
    let table: Vec<(&str, Dem, MapPoint, f64, f64, f64)> = vec![
        ("a level plane", tilted(0.0, 0.0), far, 3.0, 0.0, 0.0),
        ("a plane towards the east", tilted(0.3, 0.0), far, 3.0, 0.3, 0.0),
        ("a plane to both sides: 3-4-5", tilted(0.3, -0.4), far, 4.0, 0.5, 0.0),
        ("the same under a footprint within one facet", tilted(0.3, -0.4), far, 0.01, 0.5, 0.0),
        ("a bump of 1 m in the middle", bump(1.0), middle, 4.0, 0.0, hat(4.0)),
        ("the same under a larger footprint", bump(1.0), middle, 7.5, 0.0, hat(7.5)),
        ("a pit is a bump upside down", bump(-1.0), middle, 4.0, 0.0, hat(4.0)),
        ("a bump beyond the footprint", bump(9.0), MapPoint::new(2.0, -2.0), 3.0, 0.0, 0.0),
    ];
    for (what, ground, at, footprint_m, slope, residual_m) in table {
        let found = fit(&ground, at, footprint_m).unwrap();
        assert!((found.tilt_slope - slope).abs() < 1e-9, "{what}: {found:?}, expected a slope of {slope}");
        assert!((found.residual_m - residual_m).abs() < 1e-9, "{what}: {found:?}, expected a residual of {residual_m}");
    }
}

/// The same surface with posts at half the spacing: midpoints of edges, and of the diagonal.
fn refined(coarse: &Dem) -> Dem {
    let (rows, cols, map) = (coarse.rows(), coarse.cols(), coarse.georeference());
    let z = |row: usize, col: usize| coarse.elevation(row, col).unwrap();
    let height = |row: usize, col: usize| {
        let (top, left, low, right) = (row / 2, col / 2, row.div_ceil(2), col.div_ceil(2));
        0.5 * (z(top, left) + z(low, right))
    };
    let finer = (0..2 * rows - 1).flat_map(|row| (0..2 * cols - 1).map(move |col| (row, col)));
    let heights = finer.map(|(row, col)| height(row, col)).collect();
    let map = GeoReference::local(map.north_west(), 0.5 * map.dx_m(), 0.5 * map.dy_m()).unwrap();
    Dem::new(2 * rows - 1, 2 * cols - 1, heights, map).unwrap()
}

#[test]
fn divided_facets_change_nothing() {
    let draw = &mut Draw::seeded(77);
    for _ in 0..200 {
        let coarse = dem(8, 8, (1.0, 1.25), |_, _| draw.uniform(0.0, 2.0));
        let fine = refined(&coarse);
        let at = MapPoint::new(draw.uniform(2.0, 5.0), -draw.uniform(2.5, 6.0));
        let footprint_m = draw.log_uniform(0.05, 3.9);
        let (a, b) = (fit(&coarse, at, footprint_m).unwrap(), fit(&fine, at, footprint_m).unwrap());
        assert!((a.tilt_slope - b.tilt_slope).abs() < 1e-9 && (a.residual_m - b.residual_m).abs() < 1e-9, "{a:?} {b:?}");
    }
}

/// Each row: where the footprint lies, and whether its ground is known.
#[test]
fn a_footprint_over_a_border_or_a_gap_is_refused_with_its_reason() {
    let flat = dem(9, 9, (1.0, 1.0), |x, y| if (x, y) == (6.0, -2.0) { f64::NAN } else { 0.0 });
    let table = [
        ("in the middle", (4.0, -5.0), 3.0, None),
        ("to the border exactly", (1.5, -4.0), 3.0, None),
        ("over the border by a millimetre", (1.499, -4.0), 3.0, Some(FootprintGap::Border)),
        ("to a corner exactly", (1.5, -6.5), 3.0, None),
        ("over the southern border", (4.0, -7.0), 3.0, Some(FootprintGap::Border)),
        ("not a position", (f64::NAN, -4.0), 3.0, Some(FootprintGap::Border)),
        // The gap takes the facets around it, from x = 5 to 7 and y = -1 to -3.
        ("beside the gap's facets", (4.0, -2.0), 2.0, None),
        ("over a facet of the gap", (4.1, -2.0), 2.0, Some(FootprintGap::NoData)),
        ("over the gap itself", (6.0, -2.0), 2.0, Some(FootprintGap::NoData)),
    ];
    for (what, (x, y), footprint_m, expected) in table {
        assert_eq!(fit(&flat, MapPoint::new(x, y), footprint_m).err(), expected, "{what}");
    }
}

/// Tiles of a file hold what the whole DEM holds, wherever a slice runs.
#[test]
fn the_posts_along_a_slice_give_the_fits_of_the_whole_dem() {
    let draw = &mut Draw::seeded(5150);
    let whole = dem(150, 190, (2.0, 2.0), |_, _| draw.uniform(0.0, 3.0));
    let leg = chta::terrain::slice(&whole, MapPoint::new(20.0, -20.0), MapPoint::new(350.0, -270.0)).unwrap();
    let tiles = Surroundings::along(&whole, std::slice::from_ref(&leg), 6.0).unwrap();
    let all = Surroundings::whole(whole.into());
    for point in &leg.points {
        assert_eq!(tiles.fit(point.map, point.z_m, 12.0), all.fit(point.map, point.z_m, 12.0), "at {:?}", point.map);
    }
}

fn chain(points: &[(f64, f64)], hopper: &Hopper, rest_deg: f64) -> ConstrainedChain {
    let vertices = points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect();
    ConstrainedChain::new(PolygonalChain::bare(vertices).unwrap(), hopper, Gravity::new(MOON_M_S2).unwrap(), &surface(rest_deg))
        .unwrap()
}

fn refusal(chain: &ConstrainedChain, x_m: f64) -> Option<GroundRefusal> {
    let station = chain.geometry().station(x_m).unwrap();
    chain.check_contact(&station, Contact::Landing, Direction::Forward).err()
}

/// A name, a profile, a contact, its slope and its residual.
type Row<'a> = (&'a str, &'a [(f64, f64)], f64, f64, f64);

/// Each row: the profile, the contact, and the slope and residual known by hand (a least-squares line over 2 m).
#[test]
fn profiles_are_fitted_as_known_by_hand() {
    let corner = [(0.0, 0.0), (10.0, 0.0), (20.0, 10.0)];
    let roof = [(0.0, 0.0), (10.0, 10.0), (20.0, 0.0)];
    let table: [Row<'_>; 4] = [
        ("inside a straight segment", &corner, 15.0, 1.0, 0.0),
        // z = max(0, x): a = 1/4, slope = (3/2) / 3 = 1/2; residuals at -1, 0 and 1: 1/4, -1/4, 1/4.
        ("at a corner", &corner, 10.0, 0.5, 0.25),
        // z = -|x|: a = -1/2, slope 0; residuals -1/2, 1/2, -1/2.
        ("on a ridge", &roof, 10.0, 0.0, 0.5),
        // Its mirror image has the same slope in size.
        ("on a slope", &roof, 15.0, 1.0, 0.0),
    ];
    for (what, points, x_m, slope, residual_m) in table {
        let (steep, rough) = (chain(points, &hopper(5.0, 2.0, None), 0.0), chain(points, &hopper(5.0, 2.0, Some(0.0)), 89.0));
        match refusal(&steep, x_m) {
            Some(GroundRefusal::Footprint(FootprintRefusal::TooSteep { fitted, residual_m: found_m, .. })) => {
                assert!(
                    (fitted.slope() - slope).abs() < 1e-9 && (found_m - residual_m).abs() < 1e-9,
                    "{what}: {fitted:?} {found_m}"
                );
            }
            other => assert!(slope == 0.0, "{what}: {other:?}"),
        }
        match refusal(&rough, x_m) {
            Some(GroundRefusal::Footprint(FootprintRefusal::TooRough { residual_m: found_m, .. })) => {
                assert!((found_m - residual_m).abs() < 1e-9, "{what}: {found_m}");
            }
            other => assert!(residual_m == 0.0, "{what}: {other:?}"),
        }
    }
}

/// The slope across joins the slope along: `n_z = cos chi cos alpha`. The greatest of the segments touched counts.
#[test]
fn the_greatest_cross_slope_under_a_footprint_counts() {
    let across = |deg: f64| SegmentGround {
        form: GroundForm::Surface { friction: None, cross_slope: Angle::from_degrees(deg) },
        keep_out: false,
    };
    let vertices = [0.0, 10.0, 20.0].map(|x| ChainPoint::new(x, 0.0)).to_vec();
    let geometry = PolygonalChain::new(vertices, vec![across(5.0), across(-20.0)], None).unwrap();
    let chain = ConstrainedChain::new(geometry, &hopper(5.0, 2.0, None), Gravity::new(MOON_M_S2).unwrap(), &surface(10.0)).unwrap();
    for (x_m, expected_deg) in [(8.9, None), (9.1, Some(20.0)), (10.0, Some(20.0)), (15.0, Some(20.0))] {
        let found = refusal(&chain, x_m).and_then(|refusal| match refusal {
            GroundRefusal::Footprint(FootprintRefusal::TooSteep { fitted, .. }) => Some(fitted.degrees()),
            _ => None,
        });
        assert_eq!(found.map(|deg| (deg * 1e9).round() / 1e9), expected_deg, "at {x_m}");
    }
}

#[test]
fn collinear_vertices_change_no_window_and_no_refusal() {
    let draw = &mut Draw::seeded(2718);
    let (mut hops, mut refused) = (0, 0);
    for _ in 0..120 {
        let mut points = vec![(0.0, 0.0)];
        for i in 0..8 {
            let (x, z): (f64, f64) = points[i];
            points.push((x + draw.uniform(1.0, 8.0), z + draw.uniform(-1.5, 1.5)));
        }
        let mut divided = Vec::new();
        for pair in points.windows(2) {
            divided.push(pair[0]);
            let share = draw.uniform(0.1, 0.9);
            divided.push((pair[0].0 + share * (pair[1].0 - pair[0].0), pair[0].1 + share * (pair[1].1 - pair[0].1)));
        }
        divided.push(points[8]);
        let machine = hopper(4.0, draw.uniform(0.3, 4.0), Some(draw.uniform(0.05, 0.5)));
        let rest_deg = draw.uniform(3.0, 30.0);
        let tests = [&points[..], &divided].map(|points| HopTest::new(chain(points, &machine, rest_deg)));
        let end_m = points[8].0;
        for _ in 0..40 {
            let (from_m, to_m) = (draw.uniform(0.0, end_m), draw.uniform(0.0, end_m));
            let windows = tests.each_ref().map(|test| {
                let at = |x_m| test.chain().geometry().station(x_m).unwrap();
                test.lofts(&at(from_m), &at(to_m))
            });
            match &windows {
                [Ok(a), Ok(b)] => {
                    hops += 1;
                    assert!((a.lower - b.lower).abs() < 1e-9 * (1.0 + a.lower.abs()), "{windows:?}");
                    assert!((a.upper - b.upper).abs() < 1e-9 * (1.0 + a.upper.abs()), "{windows:?}");
                }
                [a, b] => {
                    refused += usize::from(matches!(a, Err(Limit::FootprintSlope | Limit::Roughness)));
                    assert_eq!(a, b);
                }
            }
        }
    }
    assert!(hops > 200 && refused > 500, "{hops} hops, {refused} refused by the footprint");
}

/// The paths of a chain, and the checker's verdict of them.
fn best(test: &HopTest, (from_m, to_m): (f64, f64), points: u32, split: Split) -> Option<HopPath> {
    let at = |x_m| test.chain().geometry().station(x_m).unwrap();
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(points)), split, ..SearchOptions::default() };
    let Outcome::Path { legs, .. } = search(test, at(from_m), at(to_m), &options, &()).unwrap().outcome else { return None };
    let path = generate(test, &legs, TakeoffChoice::LeastSpeed, split).unwrap();
    let flown = execute(test.chain(), &path, Some((at(from_m), at(to_m))));
    assert!(flown.passes(), "{:?}", flown.violations);
    Some(path)
}

#[test]
fn a_stricter_machine_never_takes_fewer_hops_and_every_path_stands() {
    let draw = &mut Draw::seeded(31);
    let (mut paths, mut lost) = (0, 0);
    for _ in 0..40 {
        let mut points = vec![(0.0, 0.0)];
        for i in 0..12 {
            let (x, z): (f64, f64) = points[i];
            points.push((x + draw.uniform(1.0, 6.0), z + draw.uniform(-0.8, 0.8)));
        }
        let (footprint_m, end_m) = (draw.uniform(0.3, 1.5), points[12].0);
        let mut before: Option<u64> = Some(0);
        for roughness_m in [1.0, 0.2, 0.1, 0.05, 0.0] {
            let test = HopTest::new(chain(&points, &hopper(3.0, footprint_m, Some(roughness_m)), 25.0));
            let split = if draw.chance(0.5) { Split::Equal } else { Split::FullReach };
            let hops = best(&test, (1.0, end_m - 1.0), 3, split).map(|path| path.hops.len() as u64);
            match (before, hops) {
                (None, Some(more)) => panic!("{more} hops with less roughness, none with more"),
                (Some(fewer), Some(more)) => assert!(more >= fewer, "{more} hops with less roughness, {fewer} with more"),
                (_, None) => lost += 1,
            }
            paths += usize::from(hops.is_some());
            before = hops;
        }
    }
    assert!(paths > 60 && lost > 20, "{paths} paths, {lost} without");
}

/// Hops along one segment of 100 m whose ends are kinks: contacts within a footprint of the kinks are refused, others stand.
#[test]
fn the_contacts_of_many_hops_on_a_segment_stand() {
    let points = [(-20.0, 5.0), (0.0, 0.0), (100.0, 0.0), (120.0, 5.0)];
    // At 2 m/s a hop goes 2.46 m on level ground.
    let test = HopTest::new(chain(&points, &hopper(2.0, 2.0, Some(0.001)), 30.0));
    let at = |x_m| test.chain().geometry().station(x_m).unwrap();
    for (from_m, to_m, stands) in
        [(2.0, 98.0, true), (98.0, 2.0, true), (0.0, 98.0, false), (0.5, 50.0, false), (50.0, 99.6, false)]
    {
        assert_eq!(test.segment_hops(&at(from_m), &at(to_m)).is_some(), stands, "from {from_m} to {to_m}");
    }
    for split in Split::ALL {
        let path = best(&test, (2.0, 98.0), 0, split).unwrap();
        assert!(path.hops.len() >= 39, "{} hops", path.hops.len());
    }
    // Where a split of one kind would stand on a bump, the other one is taken: contacts of full reach at 2.46, those of equal
    // hops at 2.1 m.
    let narrow = [(0.0, 0.0), (5.0, 0.0), (10.0, 0.0)];
    let level = HopTest::new(chain(&narrow, &hopper(2.0, 0.5, Some(0.001)), 30.0));
    let at = |x_m| level.chain().geometry().station(x_m).unwrap();
    assert_eq!(level.segment_hops(&at(0.4), &at(4.6)).unwrap().hops(), 2);
}

#[test]
fn a_start_on_a_kink_names_its_fit_and_the_nearest_point_that_stands() {
    let chain = chain(&[(0.0, 0.0), (50.0, 0.0), (60.0, 8.0), (100.0, 8.0)], &hopper(5.0, 4.0, Some(0.1)), 30.0);
    let start = chain.geometry().station(50.0).unwrap();
    let refused = endpoint_refusal(&chain, &start, Contact::Takeoff, Direction::Forward).unwrap();
    let reason = refused.refusal.to_string();
    // A corner of slope 0.8 under 4 m: the line slopes 0.4 and lies 0.4 m off.
    assert_eq!(
        reason,
        "the ground under its footprint of 4 m lies up to 0.400 m off the fitted plane, more than the roughness of 0.1 m (the plane slopes \
         21.801 deg)"
    );
    assert_eq!(refused.refusal.limit(Contact::Takeoff), Limit::Roughness);
    let nearest = refused.nearest.unwrap();
    assert!((48.0..50.0).contains(&nearest.point.x_m) && (nearest.point.x_m - 48.0).abs() < 1.1, "{nearest:?}");
    // At the chain's end half the footprint has no ground.
    let edge = chain.geometry().station(1.0).unwrap();
    let goal = endpoint_refusal(&chain, &edge, Contact::Landing, Direction::Reverse).unwrap();
    assert_eq!(goal.refusal.to_string(), "its footprint of 4 m reaches over the end of the known ground");
    assert_eq!(goal.refusal.limit(Contact::Landing), Limit::FootprintSlope);
}

fn ground_of(dem: Dem, hopper: &Hopper, rest_deg: f64) -> DemGround {
    DemGround::new(OverlaidDem::new(dem, Overlays::default()), hopper, Gravity::new(MOON_M_S2).unwrap(), &surface(rest_deg))
}

/// Every hop between posts: the table of a map against the hop test on the slice, and both against the fit of its two ends.
#[test]
fn maps_slices_and_fits_agree_on_every_contact() {
    let draw = &mut Draw::seeded(99);
    let (mut hops, mut steep, mut rough) = (0, 0, 0);
    for _ in 0..12 {
        let bumpy = dem(12, 12, (1.0, 1.2), |_, _| draw.uniform(0.0, 0.6));
        let footprint_m = draw.uniform(0.8, 3.5);
        let (rest_deg, roughness_m) = (draw.uniform(5.0, 20.0), draw.uniform(0.15, 0.4));
        let ground = ground_of(bumpy.clone(), &hopper(2.5, footprint_m, Some(roughness_m)), rest_deg);
        let bare = ground_of(bumpy.clone(), &Hopper::with_speeds(2.5, 2.5).unwrap(), 89.0);
        let (table, bare) = (PostHops::new(ground.clone(), 1).unwrap(), PostHops::new(bare, 1).unwrap());
        for index in 0..table.lattice().count() {
            let from = table.lattice().node(index);
            let stands = |post: Post| {
                let fit = fit(&bumpy, bumpy.georeference().post(post.row, post.col), footprint_m);
                fit.map_err(|_| None).and_then(|fit| {
                    if fit.tilt_slope > rest_deg.to_radians().tan() {
                        Err(Some(Limit::FootprintSlope))
                    } else if fit.residual_m > roughness_m {
                        Err(Some(Limit::Roughness))
                    } else {
                        Ok(())
                    }
                })
            };
            match (stands(from), table.refusal(from)) {
                (Ok(()), None) => {}
                (Err(limit), Some(PostRefusal::Footprint(refusal))) => {
                    assert_eq!(limit.unwrap_or(Limit::FootprintSlope), refusal.limit());
                    steep += usize::from(limit == Some(Limit::FootprintSlope));
                    rough += usize::from(limit == Some(Limit::Roughness));
                }
                other => panic!("{from:?}: {other:?}"),
            }
            for offset in 0..table.offset_count() {
                let Some(to) = table.landing(from, offset) else { continue };
                let found = table.lofts(from, offset).unwrap();
                let by_slice = table.chain(from, to).unwrap().and_then(|chain| {
                    let test = HopTest::new(chain);
                    let geometry = test.chain().geometry();
                    let ends = [0, geometry.segment_count()].map(|i| geometry.vertex_station(VertexId(i)));
                    test.lofts(&ends[0], &ends[1]).ok()
                });
                assert_eq!(found.is_some(), by_slice.is_some(), "{from:?} to {to:?}");
                let bare_offset = (0..bare.offset_count()).find(|other| bare.landing(from, *other) == Some(to));
                let without = bare_offset.and_then(|offset| bare.lofts(from, offset).unwrap());
                let expected = without.filter(|_| stands(from).is_ok() && stands(to).is_ok());
                assert_eq!(found.is_some(), expected.is_some(), "{from:?} to {to:?}");
                hops += usize::from(found.is_some());
            }
        }
    }
    assert!(hops > 1000 && steep > 100 && rough > 100, "{hops} hops, {steep} steep, {rough} rough");
}

/// The hop between two contacts over a slice, flown with the middle of its window.
fn one_hop(ground: &DemGround, from: MapPoint, to: MapPoint) -> Option<Hop> {
    let test = HopTest::new(ground.chain(from, to).ok()?);
    let geometry = test.chain().geometry();
    let ends = [0, geometry.segment_count()].map(|i| geometry.vertex_station(VertexId(i)));
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(0)), ..SearchOptions::default() };
    let Outcome::Path { legs, .. } = search(&test, ends[0], ends[1], &options, &()).unwrap().outcome else { return None };
    let path = generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::FullReach).unwrap();
    if path.hops.len() == 1 { path.hops.first().copied() } else { None }
}

/// Hops planned without a footprint, flown by a checker of a hopper that has one: it names the contacts that the closed form refuses,
/// on the map and on the slice, and no others.
#[test]
fn the_checker_names_hops_that_are_spoiled_by_their_footprint() {
    let draw = &mut Draw::seeded(606);
    let (mut clean, mut steep, mut rough, mut unknown, mut close) = (0, 0, 0, 0, 0);
    for _ in 0..60 {
        let bumpy = dem(14, 14, (1.0, 0.9), |_, _| draw.uniform(0.0, 0.5));
        let machine = hopper(2.5, draw.uniform(0.3, 4.0), Some(draw.uniform(0.02, 0.35)));
        let rest_deg = draw.uniform(3.0, 25.0);
        let planner = ground_of(bumpy.clone(), &Hopper::with_speeds(2.5, 2.5).unwrap(), 89.0);
        let judge = ground_of(bumpy.clone(), &machine, rest_deg);
        for _ in 0..6 {
            let place = |draw: &mut Draw| MapPoint::new(draw.uniform(0.1, 12.9), -draw.uniform(0.1, 11.6));
            let (from, to) = (place(draw), place(draw));
            let Some(hop) = one_hop(&planner, from, to) else { continue };
            let limits = machine.limits();
            let footprint_m = limits.footprint_m.unwrap();
            let fits = [from, to].map(|at| fit(&bumpy, at, footprint_m));
            let (max_slope, max_m) = (rest_deg.to_radians().tan(), limits.roughness_max_m.unwrap());
            // Rays come within half a per cent of the residual: closer fits may go either way.
            let near = |found: f64, max: f64, error: f64| (found - max).abs() < error;
            let is_close = fits.iter().flatten().any(|fit| {
                near(fit.residual_m, max_m, 0.02 * fit.residual_m)
                    || near(fit.tilt_slope, max_slope, 0.03 * fit.residual_m / footprint_m + 1e-6)
            });
            if is_close {
                close += 1;
                continue;
            }
            let expected_slope = fits.iter().any(|fit| fit.is_err() || fit.is_ok_and(|fit| fit.tilt_slope > max_slope));
            let expected_rough = fits.iter().flatten().any(|fit| fit.residual_m > max_m);
            let path = HopPath { hops: vec![hop], totals: chta::path::Totals::default() };
            let on_slice = judge.chain(from, to).unwrap();
            let verdicts = [execute(&judge, &path_on(&judge, &path), None), execute(&on_slice, &path, None)];
            for (which, execution) in verdicts.iter().enumerate() {
                let names = |limit| execution.violations.iter().any(|found| found.limit == ViolatedLimit::Limit(limit));
                assert_eq!(names(Limit::FootprintSlope), expected_slope, "{which}: {:?} {fits:?}", execution.violations);
                assert_eq!(names(Limit::Roughness), expected_rough, "{which}: {:?} {fits:?}", execution.violations);
                let others = execution.violations.iter().any(|found| {
                    !matches!(found.limit, ViolatedLimit::Limit(Limit::FootprintSlope | Limit::Roughness))
                        && !matches!(found.limit, ViolatedLimit::StatedValue(_))
                });
                assert!(!others, "{:?}", execution.violations);
            }
            clean += usize::from(!expected_slope && !expected_rough);
            steep += usize::from(fits.iter().flatten().any(|fit| fit.tilt_slope > max_slope));
            rough += usize::from(expected_rough);
            unknown += usize::from(fits.iter().any(Result::is_err));
        }
    }
    let all = [clean, steep, rough, unknown];
    assert!(all.iter().all(|count| *count > 10), "clean, steep, rough, unknown {all:?}; {close} close");
}

/// The checker's rays against the closed form: their slope and residual stand in the violations of a hopper that tolerates nothing.
#[test]
fn the_rays_of_the_checker_come_close_to_the_closed_form() {
    let draw = &mut Draw::seeded(12);
    let (mut worst_slope, mut worst_residual, mut compared) = (0.0f64, 0.0f64, 0);
    for _ in 0..150 {
        let bumpy = dem(14, 14, (1.0, 0.9), |_, _| draw.uniform(0.0, 0.5));
        let footprint_m = draw.log_uniform(0.1, 4.0);
        let planner = ground_of(bumpy.clone(), &Hopper::with_speeds(2.5, 2.5).unwrap(), 89.0);
        let judge = ground_of(bumpy.clone(), &hopper(2.5, footprint_m, Some(0.0)), 0.0);
        let mut place = || MapPoint::new(draw.uniform(2.1, 10.9), -draw.uniform(2.1, 9.6));
        let (from, to) = (place(), place());
        let Some(hop) = one_hop(&planner, from, to) else { continue };
        let path = HopPath { hops: vec![hop], totals: chta::path::Totals::default() };
        let execution = execute(&judge.chain(from, to).unwrap(), &path, None);
        for (at, along_m) in [(from, hop.takeoff.along_m), (to, hop.landing.along_m)] {
            let exact = fit(&bumpy, at, footprint_m).unwrap();
            let found = |limit| {
                let mut violations = execution.violations.iter();
                violations.find(|v| v.limit == ViolatedLimit::Limit(limit) && v.at_x_m == along_m).and_then(|v| v.measure)
            };
            if let Some(measure) = found(Limit::FootprintSlope) {
                let off = (measure.found.to_radians().tan() - exact.tilt_slope).abs();
                worst_slope = worst_slope.max((off - 1e-9) * 0.5 * footprint_m / exact.residual_m.max(1e-9));
            }
            if let Some(measure) = found(Limit::Roughness) {
                compared += 1;
                worst_residual = worst_residual.max((measure.found - exact.residual_m) / exact.residual_m);
                assert!(measure.found > 0.97 * exact.residual_m, "{measure:?} {exact:?}");
            }
        }
    }
    // The tolerance that the checker allows its rays.
    assert!(compared > 40 && worst_slope < 4e-4 && worst_residual < 4e-4, "{worst_slope} {worst_residual} {compared}");
}

/// The same path with the map's own contacts instead of stations.
fn path_on(ground: &DemGround, path: &HopPath) -> HopPath {
    let own = |point: &chta::ground::ContactPoint| {
        let contact = ground.contact_at(point).unwrap();
        chta::ground::ContactPoint { along_m: point.along_m, ..ground.contact_point(&contact) }
    };
    let hops = path.hops.iter().map(|hop| Hop { takeoff: own(&hop.takeoff), landing: own(&hop.landing), ..*hop }).collect();
    HopPath { hops, ..path.clone() }
}

/// A proof leaves the footprint out inside segments: it never contradicts a path, and says so.
#[test]
fn proofs_hold_beside_footprints() {
    let draw = &mut Draw::seeded(8);
    let mut met = 0;
    for _ in 0..30 {
        let mut points = vec![(0.0, 0.0)];
        for i in 0..8 {
            let (x, z): (f64, f64) = points[i];
            points.push((x + draw.uniform(2.0, 6.0), z + draw.uniform(-0.8, 0.8)));
        }
        let test = HopTest::new(chain(&points, &hopper(3.0, 1.0, Some(0.15)), 20.0));
        let at = |x_m| test.chain().geometry().station(x_m).unwrap();
        let ends = (at(1.0), at(points[8].0 - 1.0));
        let options = proof::BoundsOptions { budget_cells: 300, ..proof::BoundsOptions::default() };
        let bounds = proof::bounds(&test, ends.0, ends.1, &options, &()).unwrap();
        assert!(bounds.summary.footprint_at_vertices_alone);
        if let Some(hops) = best(&test, (1.0, points[8].0 - 1.0), 7, Split::Equal).map(|path| path.hops.len() as u64) {
            assert!(bounds.lower.is_some_and(|lower| lower <= hops), "{:?} for {hops} hops", bounds.lower);
            met += 1;
        }
    }
    assert!(met > 5, "{met} paths");
}

#[test]
fn real_ground_is_fitted_as_by_quadrature_and_maps_stand_on_it() {
    for file in ["hirise_DTEEC_010228_1490_crop_120x70.tif", "lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
        if !path.is_file() {
            eprintln!("skipped: {} is absent", path.display());
            continue;
        }
        let real = read_dem(&path).unwrap();
        let step_m = real.georeference().dx_m();
        let draw = &mut Draw::seeded(17);
        let bounds = real.bounds();
        let middle = nalgebra::center(&bounds.min, &bounds.max);
        for _ in 0..10 {
            let at = middle + nalgebra::Vector2::new(draw.uniform(-9.0, 9.0), draw.uniform(-9.0, 9.0)) * step_m;
            let footprint_m = step_m * draw.log_uniform(0.5, 8.0);
            let (exact, sampled) = (fit(&real, at, footprint_m).unwrap(), sampled(&real, at, footprint_m));
            let size = exact.residual_m / footprint_m + 0.1 * exact.tilt_slope;
            assert!((exact.tilt_slope - sampled.tilt_slope).abs() < 0.02 * size, "{file}: {exact:?} {sampled:?}");
            assert!((exact.residual_m / sampled.residual_m - 1.0).abs() < 0.05, "{file}: {exact:?} {sampled:?}");
        }
    }
}
