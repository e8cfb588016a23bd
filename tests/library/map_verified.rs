//! Paths of hop maps, flown again over the triangles of the DEM by the independent checker: every path holds, and spoiled ones are
//! refused under the name of the violated limit.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use std::path::Path;

use crate::{
    execute::with_arc,
    map_world::{World, friction, random_dem, random_hopper, random_surface},
    support::Draw,
};
use chta::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    ground::{DemGround, MapPosition, Surface, Windows},
    path::{Hop, HopPath, StatedValue, ViolatedLimit, Violation, execute},
    quantity::{Angle, AngleInterval, MapPoint, SlopeInterval},
    reach::map::{HopMap, NodeLattice, Post, PostHops, Search, joined, path_hops, search, verify},
    terrain::{Dem, GeoReference, OverlaidDem, Overlays, read_dem, read_friction_raster, read_keep_out},
    world::{Gravity, Grip, Hopper, HopperLimits, Limit, RestSlope, SurfaceProperties},
};

const CHOICES: [TakeoffChoice; 4] = TakeoffChoice::ALL;

fn map_from(hops: &PostHops, start: Post) -> HopMap {
    search(hops, &[start.into()], Search::default(), &()).unwrap()
}

fn path_to(hops: &PostHops, map: &HopMap, goal: Post, choice: TakeoffChoice) -> Option<HopPath> {
    let nodes = map.path(hops, goal)?;
    let flown = path_hops(hops, &nodes, choice).unwrap();
    assert_eq!(flown.len(), nodes.len() - 1, "every step of a map is a hop");
    Some(joined(hops, &flown))
}

/// Flies the paths to every `step`-th post again; returns the number of hops.
fn all_hold(ground: DemGround, start: Post, stride: usize, step: usize, what: &str) -> usize {
    hold_over(&PostHops::new(ground, stride).unwrap(), start, step, what)
}

/// The same over nodes that are posts or not.
fn hold_over(hops: &PostHops, start: Post, step: usize, what: &str) -> usize {
    let start = hops.nearest_usable(start).unwrap_or(start);
    let map = map_from(hops, start);
    let mut flown = 0;
    for (number, index) in (0..hops.lattice().count()).step_by(step).enumerate() {
        let goal = hops.lattice().node(index);
        let Some(path) = path_to(hops, &map, goal, CHOICES[number % 3]) else { continue };
        let execution = verify(hops, &path, start, goal);
        let said: Vec<String> = execution.violations.iter().map(ToString::to_string).collect();
        assert!(execution.passes(), "{what}, {start:?} to {goal:?}: {said:#?}\n{:#?}", path.hops.first());
        for hop in &path.hops {
            no_margin_is_negative(hop, what);
        }
        flown += path.hops.len();
    }
    flown
}

/// Beyond the tolerance of a speed, and the rounding of an angle; `margins.rs` compares the margins themselves, on chains.
fn no_margin_is_negative(hop: &Hop, what: &str) {
    let size_m = hop.run_m() + (hop.apex_z_m - hop.takeoff.point_m.z);
    for (row, value) in hop.margins.rows() {
        let allowed = match row.key {
            key if key.ends_with("_deg") => 1e-7,
            key if key.ends_with("_m_s") => 1.1e-9 * hop.takeoff_speed_m_s.max(hop.landing_speed_m_s),
            key if key.ends_with("_m") => 1e-9 * size_m,
            _ => 1e-9 * hop.flight_time_s,
        };
        assert!(value.is_none_or(|value| value >= -allowed), "{what}: {} {value:?}, allowed {allowed:e}; {hop:#?}", row.key);
    }
}

#[test]
fn paths_over_random_grids_hold_when_flown_again() {
    let mut draw = Draw::seeded(303);
    let mut flown = 0;
    for number in 0..150 {
        let dem = random_dem(&mut draw, 14);
        let (hopper, gravity) = random_hopper(&mut draw);
        // Weak and strong gravity: the same geometry with all speeds scaled.
        let scale: f64 = [1.0, 1e-4, 25.0][number % 3];
        let limits = hopper.limits();
        let limits = HopperLimits {
            takeoff_speed_max_m_s: limits.takeoff_speed_max_m_s * scale.sqrt(),
            landing_speed_max_m_s: limits.landing_speed_max_m_s * scale.sqrt(),
            flight_time_max_s: limits.flight_time_max_s.map(|time_s| time_s / scale.sqrt()),
            takeoff_speed_min_m_s: limits.takeoff_speed_min_m_s.map(|speed_m_s| speed_m_s * scale.sqrt()),
            takeoff_speed_levels: limits.takeoff_speed_levels.map(|levels| levels.scaled(scale.sqrt())),
            ..*limits
        };
        let world = World::new(dem, Hopper::new(limits).unwrap(), random_surface(&mut draw), gravity * scale);
        let start = Post { row: draw.below(14), col: draw.below(14) };
        if world.dem.elevation(start.row, start.col).is_some() {
            flown += all_hold(world.ground(), start, 1, 1, &format!("grid {number}"));
        }
    }
    assert!(flown > 10_000, "only {flown} hops");
}

/// Posts of millimetres and of kilometres, near the origin and far from it.
#[test]
fn paths_over_fine_and_coarse_posts_hold_when_flown_again() {
    let mut draw = Draw::seeded(88);
    let mut flown = 0;
    for (spacing_m, origin_m) in [(1e-2, 0.0), (0.25, 3e4), (5.0, 7.5e4), (1600.0, 6e5)] {
        for _ in 0..12 {
            let heights = (0..196).map(|_| draw.unit() * 0.6 * spacing_m).collect();
            let map =
                GeoReference::local(MapPoint::new(origin_m, -origin_m), spacing_m, spacing_m * draw.uniform(0.6, 1.5)).unwrap();
            let speed_m_s = (1.6 * 4.0 * spacing_m).sqrt();
            let limits = HopperLimits {
                clearance_m: 0.02 * spacing_m,
                apex_height_max_m: Some(3.0 * spacing_m),
                ..HopperLimits::with_speeds(speed_m_s, speed_m_s)
            };
            let ground = ground(Dem::new(14, 14, heights, map).unwrap(), limits, &friction(0.9), 1.6);
            flown += all_hold(ground, Post { row: 7, col: 7 }, 1, 1, &format!("posts {spacing_m} m apart"));
        }
    }
    assert!(flown > 5000, "only {flown} hops");
}

/// Nodes between posts, whose heights have rounding of their own: high above the datum, and far from the origin.
#[test]
fn paths_over_finer_nodes_hold_when_flown_again() {
    let mut draw = Draw::seeded(89);
    let mut flown = 0;
    for (spacing_m, origin_m, base_m) in [(0.3, 0.0, 0.0), (5.0, 75_362.5, 500.0), (7.3, 6e5, -2_000.0)] {
        for number in 0..9 {
            let heights = (0..64).map(|_| base_m + draw.unit() * 0.5 * spacing_m).collect();
            let map =
                GeoReference::local(MapPoint::new(origin_m, -origin_m), spacing_m, spacing_m * draw.uniform(0.6, 1.5)).unwrap();
            let speed_m_s = (1.6 * 2.5 * spacing_m).sqrt();
            let limits = HopperLimits::with_speeds(speed_m_s, speed_m_s);
            let dem = Dem::new(8, 8, heights, map).unwrap();
            let lattice = NodeLattice::finer(&dem, 2 + number % 3);
            let hops = PostHops::over(ground(dem, limits, &friction(0.9), 1.6), lattice).unwrap();
            let start = Post { row: lattice.rows / 2, col: lattice.cols / 2 };
            flown += hold_over(&hops, start, 3, &format!("nodes of posts {spacing_m} m apart"));
        }
    }
    assert!(flown > 2_000, "only {flown} hops");
}

#[test]
fn paths_under_zones_and_friction_hold_when_flown_again() {
    let folder = tempfile::tempdir().unwrap();
    let mut draw = Draw::seeded(12);
    let mut flown = 0;
    for number in 0..24 {
        let heights = (0..144).map(|_| draw.unit() * 0.8).collect();
        let dem = Dem::new(12, 12, heights, GeoReference::local(MapPoint::new(0.0, 11.0), 1.0, 1.0).unwrap()).unwrap();
        let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(4.0, 4.0) }).unwrap();
        let mut world = World::new(dem, hopper, friction(0.8), 2.0);
        let corner = [2.0, 2.5, 3.3][number % 3];
        let polygon = format!(
            r#"{{"type": "Polygon", "coordinates": [[[{corner}, 1], [7, 1], [7, {corner}], [{corner}, 6], [{corner}, 1]]]}}"#
        );
        let zones = folder.path().join(format!("zones_{number}.geojson"));
        std::fs::write(&zones, polygon).unwrap();
        world.keep_out = Some(read_keep_out(&zones, None, world.dem.bounds()).unwrap());
        if number % 2 == 0 {
            let values: Vec<String> = (0..36).map(|_| [0.7, 0.7, 1.1, -9.0][draw.below(4)].to_string()).collect();
            let rows: Vec<String> = values.chunks(6).map(|row| row.join(" ")).collect();
            let header = "ncols 6\nnrows 6\nxllcorner -0.5\nyllcorner -0.5\ncellsize 2\nNODATA_value -9\n";
            let raster = folder.path().join(format!("friction_{number}.asc"));
            std::fs::write(&raster, format!("{header}{}\n", rows.join("\n"))).unwrap();
            world.friction = Some(read_friction_raster(&raster, None).unwrap());
        }
        let start = Post { row: 5, col: 0 };
        flown += all_hold(world.ground(), start, 1 + number % 2, 1, &format!("overlays {number}"));
    }
    assert!(flown > 1000, "only {flown} hops");
}

/// A real DEM; `None` with a printed reason if it is absent.
fn real(file: &str) -> Option<Dem> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
    if !path.is_file() {
        eprintln!("skipped: {} is absent", path.display());
        return None;
    }
    Some(read_dem(&path).unwrap())
}

fn ground(dem: Dem, limits: HopperLimits, surface: &SurfaceProperties, gravity_m_s2: f64) -> DemGround {
    let terrain = OverlaidDem::new(dem, Overlays::default());
    DemGround::new(terrain, &Hopper::new(limits).unwrap(), Gravity::new(gravity_m_s2).unwrap(), surface)
}

#[test]
fn paths_over_mars_hold_when_flown_again() {
    let Some(dem) = real("hirise_DTEEC_010228_1490_crop_120x70.tif") else { return };
    let limits = HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(6.0, 6.0) };
    let flown = all_hold(ground(dem, limits, &friction(0.6), 3.711), Post { row: 60, col: 35 }, 1, 7, "Mars");
    assert!(flown > 5000, "only {flown} hops");
}

#[test]
fn paths_over_the_moon_hold_when_flown_again() {
    let Some(dem) = real("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif") else { return };
    let limits = HopperLimits { clearance_m: 0.5, ..HopperLimits::with_speeds(8.0, 8.0) };
    let flown = all_hold(ground(dem, limits, &friction(0.6), 1.624), Post { row: 128, col: 128 }, 1, 131, "Moon");
    assert!(flown > 4000, "only {flown} hops");
}

fn names(violations: &[Violation], limit: ViolatedLimit) -> bool {
    violations.iter().any(|violation| violation.limit == limit)
}

/// The hop with another take-off slope and the speed that still meets the landing.
fn with_slope(hop: &Hop, slope: f64, gravity_m_s2: f64) -> Hop {
    let sight = LineOfSight::new(hop.run_m(), hop.landing.point_m.z - hop.takeoff.point_m.z);
    with_arc(hop, &Arc::new(sight, slope - sight.slope(), gravity_m_s2))
}

/// Hops of random maps, each with its ground.
fn some_hops(seed: u64, mut of: impl FnMut(&PostHops, &World, &Hop)) {
    let mut draw = Draw::seeded(seed);
    for _ in 0..150 {
        let dem = random_dem(&mut draw, 12);
        let (hopper, gravity) = random_hopper(&mut draw);
        let world = World::new(dem, hopper, random_surface(&mut draw), gravity);
        let start = Post { row: 6, col: 6 };
        if world.dem.elevation(6, 6).is_none() {
            continue;
        }
        let hops = PostHops::new(world.ground(), 1).unwrap();
        let map = map_from(&hops, start);
        for index in (0..hops.lattice().count()).step_by(5) {
            let path = path_to(&hops, &map, hops.lattice().node(index), TakeoffChoice::LeastSpeed);
            if let Some(hop) = path.as_ref().and_then(|path| path.hops.last()) {
                of(&hops, &world, hop);
            }
        }
    }
}

fn alone(hops: &PostHops, hop: Hop) -> Vec<Violation> {
    execute(hops.ground(), &HopPath::of_hops(vec![hop], hops.ground().hopper()), None).violations
}

#[test]
fn a_hop_spoiled_by_one_percent_is_refused_under_its_limits_name() {
    let mut by_limit = [0usize; Limit::ALL.len()];
    let (mut missed, mut turned) = (0, 0);
    some_hops(77, |hops, world, hop| {
        for factor in [0.99, 1.01] {
            let violations = alone(hops, Hop { takeoff_speed_m_s: hop.takeoff_speed_m_s * factor, ..*hop });
            assert!(names(&violations, ViolatedLimit::LandingPoint), "{factor} of the speed: {violations:?}");
            missed += 1;
        }
        let violations = alone(hops, Hop { heading_deg: (hop.heading_deg + 3.6) % 360.0, ..*hop });
        assert!(names(&violations, ViolatedLimit::StatedValue(StatedValue::Heading)), "{violations:?}");
        turned += 1;
        let (min, max) = (hop.takeoff_angles.min.radians(), hop.takeoff_angles.max.radians());
        let sight_rad = ((hop.landing.point_m.z - hop.takeoff.point_m.z) / hop.run_m()).atan();
        // 1 % of the angle, or of the distance to the line of sight and to the vertical if that is less.
        let lower = (0.01 * min.abs()).max(1e-3).min(0.5 * (min - sight_rad));
        let upper = (0.01 * max.abs()).max(1e-3).min(0.5 * (std::f64::consts::FRAC_PI_2 - max));
        for (radians, room, limit) in [(min - lower, lower, hop.lower_limit), (max + upper, upper, hop.upper_limit)] {
            if room < 1e-4 || limit == Limit::LineOfSight {
                continue;
            }
            let violations = alone(hops, with_slope(hop, radians.tan(), world.gravity_m_s2));
            assert!(names(&violations, ViolatedLimit::Limit(limit)), "{limit} at {radians}: {violations:#?}\n{hop:#?}");
            by_limit[limit.index()] += 1;
        }
    });
    assert!(missed > 1000 && turned > 500, "{missed} and {turned} hops");
    for limit in [
        Limit::TakeoffCone,
        Limit::LandingCone,
        Limit::TakeoffSpeed,
        Limit::LandingSpeed,
        Limit::Terrain,
        Limit::MechanicalAngle,
        Limit::ApexHeight,
        Limit::FlightTime,
        Limit::TakeoffSpeedMin,
        Limit::TakeoffSpeedLevels,
    ] {
        assert!(by_limit[limit.index()] >= 8, "{limit} was tested only {} times", by_limit[limit.index()]);
    }
}

/// The same path over a map with one post altered: under the arc, at the landing, or missing.
#[test]
fn a_map_with_one_altered_post_fails() {
    let limits = HopperLimits { clearance_m: 0.2, ..HopperLimits::with_speeds(6.0, 6.0) };
    let level = |change: Option<(usize, f64)>| {
        let mut heights = vec![3.0; 21 * 21];
        if let Some((index, z_m)) = change {
            heights[index] = z_m;
        }
        let dem = Dem::new(21, 21, heights, GeoReference::local(MapPoint::new(500.0, 900.0), 1.0, 1.0).unwrap()).unwrap();
        ground(dem, limits, &friction(1.2), 3.0)
    };
    let hops = PostHops::new(level(None), 1).unwrap();
    let (start, goal) = (Post { row: 10, col: 2 }, Post { row: 10, col: 10 });
    let map = map_from(&hops, start);
    let path = path_to(&hops, &map, goal, TakeoffChoice::LeastSpeed).unwrap();
    assert_eq!(path.hops.len(), 1);
    assert!(verify(&hops, &path, start, goal).passes());
    let [hop] = path.hops[..] else { unreachable!() };
    let flown_over = |change| {
        let altered = level(Some(change));
        let ends = [&hop.takeoff, &hop.landing].map(|point| altered.contact_at(point));
        execute(&altered, &path, ends[0].zip(ends[1])).violations
    };
    let index = |row: usize, col: usize| row * 21 + col;
    // A needle up to 0.1 m below the arc, less than the clearance. 45 degrees over 8 m: 2 m at the middle.
    assert!(names(&flown_over((index(10, 6), 3.0 + 1.9)), ViolatedLimit::Limit(Limit::Terrain)));
    assert!(!names(&flown_over((index(10, 6), 3.0 + 1.7)), ViolatedLimit::Limit(Limit::Terrain)), "it clears that by 0.3 m");
    let blocked = flown_over((index(10, 6), 3.0 + 2.5));
    assert!(names(&blocked, ViolatedLimit::Limit(Limit::Terrain)) && names(&blocked, ViolatedLimit::LandingPoint), "{blocked:?}");
    let raised = flown_over((index(10, 10), 3.01));
    assert!(names(&raised, ViolatedLimit::StatedValue(StatedValue::LandingStation)), "{raised:?}");
    let gap = flown_over((index(10, 6), f64::NAN));
    assert!(names(&gap, ViolatedLimit::UnknownGround), "{gap:?}");
    // A neighbour that makes the landing's own facet too steep to rest on.
    let steep = flown_over((index(10, 9), 3.0 - 1.5));
    assert!(names(&steep, ViolatedLimit::Limit(Limit::RestSlope)), "{steep:?}");
    // A change beside the path has no effect.
    assert_eq!(flown_over((index(3, 3), 90.0)), []);
}

#[test]
fn a_path_of_a_map_must_join_its_ends() {
    let world = World::new(
        Dem::new(9, 30, vec![0.0; 270], GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 1.0).unwrap()).unwrap(),
        Hopper::with_speeds(4.0, 4.0).unwrap(),
        SurfaceProperties { rest: RestSlope::Unlimited, ..friction(1.5) },
        2.0,
    );
    let hops = PostHops::new(world.ground(), 1).unwrap();
    let (start, goal) = (Post { row: 4, col: 0 }, Post { row: 4, col: 29 });
    let map = map_from(&hops, start);
    let mut path = path_to(&hops, &map, goal, TakeoffChoice::MidRange).unwrap();
    assert!(path.hops.len() > 2 && verify(&hops, &path, start, goal).passes());
    let gaps = |path: &HopPath, goal| {
        let violations = verify(&hops, path, start, goal).violations;
        violations.iter().filter(|v| v.limit == ViolatedLimit::Continuity).map(|v| v.hop).collect::<Vec<_>>()
    };
    assert_eq!(gaps(&path, Post { row: 4, col: 28 }), [path.hops.len()]);
    path.hops.remove(1);
    assert_eq!(gaps(&path, goal), [2]);
}

/// The three forms of the hop test: slice and hop test, the table of offsets, and the walk over the triangles that replanning uses.
#[test]
fn a_pair_has_the_same_windows_in_all_three_forms() {
    let mut compared = 0;
    some_hops(5, |hops, _, hop| {
        let ground = hops.ground();
        let [from, to]: [MapPosition; 2] = [&hop.takeoff, &hop.landing].map(|point| ground.contact_at(point).unwrap());
        let windows = ground.windows(&from, &to).unwrap();
        let slope = |angle: Angle| angle.slope() - windows.sight.slope();
        let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-6 * (1.0 + a.abs().max(b.abs()));
        let flown = slope(hop.takeoff_angle);
        let holds = |lofts: &&SlopeInterval| near(flown.clamp(lofts.lower, lofts.upper), flown);
        let Some(lofts) = windows.lofts.iter().find(holds) else { panic!("no window for a hop: {hop:?}") };
        let (min, max) = (slope(hop.takeoff_angles.min), slope(hop.takeoff_angles.max));
        let vertical = hop.takeoff_angles.max.degrees() > 89.999;
        assert!(near(lofts.lower, min) && (vertical || near(lofts.upper, max)), "{lofts:?} against {min} to {max}");
        compared += 1;
    });
    assert!(compared > 500, "only {compared} pairs");
}

/// On a chain that is a slice and on the DEM itself the checker gives the same result for the same hop.
#[test]
fn the_checker_agrees_on_the_slice_and_on_the_dem() {
    let mut compared = 0;
    some_hops(9, |hops, world, hop| {
        let ends = hop.map_ends().unwrap();
        let chain = hops.ground().chain(ends.0, ends.1).unwrap();
        let geometry = chain.geometry();
        let (first, last) = geometry.extent_m();
        let [from, to] = [first, last].map(|x_m| chain.contact_point(&geometry.station(x_m).unwrap()));
        for factor in [1.0, 1.01] {
            let speed = hop.takeoff_speed_m_s * factor;
            let along = Hop { takeoff: from, landing: to, takeoff_speed_m_s: speed, ..*hop };
            let over = Hop { takeoff_speed_m_s: speed, ..*hop };
            let path = |hop| HopPath::of_hops(vec![hop], &world.hopper);
            let [a, b] = [execute(&chain, &path(along), None), execute(hops.ground(), &path(over), None)];
            assert_eq!(a.passes(), b.passes(), "{:?} against {:?}", a.violations, b.violations);
            let [a, b] = [&a.flights[0], &b.flights[0]].map(|flight| flight.as_ref().unwrap());
            assert!((a.flight_time_s - b.flight_time_s).abs() <= 1e-9 * a.flight_time_s);
            assert!((a.landing_speed_m_s - b.landing_speed_m_s).abs() <= 1e-9 * a.landing_speed_m_s);
        }
        compared += 1;
    });
    assert!(compared > 500, "only {compared} hops");
}

/// Situations in which a checker that looks beside a contact may look at the wrong ground: each path holds.
#[test]
fn contacts_next_to_edges_borders_and_limits_hold_when_flown_again() {
    let one_hop = |world: &World, from: Post, to: Post, what: &str| {
        let hops = PostHops::new(world.ground(), 1).unwrap();
        let map = map_from(&hops, from);
        let path = path_to(&hops, &map, to, TakeoffChoice::LeastSpeed).unwrap_or_else(|| panic!("{what}: no path"));
        let violations = verify(&hops, &path, from, to).violations;
        assert!(violations.is_empty(), "{what}: {violations:?}");
    };
    let dem = |rows: &[&[f64]], origin: (f64, f64), (dx_m, dy_m): (f64, f64)| {
        let north_west = MapPoint::new(origin.0, origin.1 + dy_m * f64::from(u32::try_from(rows.len() - 1).unwrap()));
        let map = GeoReference::local(north_west, dx_m, dy_m).unwrap();
        Dem::new(rows.len(), rows[0].len(), rows.concat(), map).unwrap()
    };
    let speeds = |v: f64| Hopper::with_speeds(v, v).unwrap();
    let row = |number: usize, col: usize| Post { row: number, col };
    // Post spacings that differ by a factor of five, along an edge beside a gap.
    let gap = [0.0, 0.0, f64::NAN];
    let world = World::new(dem(&[&gap, &gap, &gap], (0.0, 0.0), (5.0, 1.0)), speeds(2.0), friction(1.0), 1.0);
    one_hop(&world, row(2, 1), row(0, 1), "beside a gap");
    // Borders of a zone just ahead of a take-off and just behind a landing.
    let folder = tempfile::tempdir().unwrap();
    let flat = [0.0; 4];
    for (number, (west, east)) in [(1e-7, 2.5), (1e-9, 2.5), (0.5, 2.999_999_5), (-1.0, 0.0), (3.0, 4.0)].into_iter().enumerate() {
        let mut world = World::new(dem(&[&flat, &flat, &flat], (0.0, 0.0), (1.0, 1.0)), speeds(1.8), friction(1.0), 1.0);
        let file = folder.path().join(format!("zone_{number}.geojson"));
        let ring = format!("[[{west},0.5],[{east},0.5],[{east},1.5],[{west},1.5],[{west},0.5]]");
        std::fs::write(&file, format!(r#"{{"type": "Polygon", "coordinates": [{ring}]}}"#)).unwrap();
        world.keep_out = Some(read_keep_out(&file, None, world.dem.bounds()).unwrap());
        one_hop(&world, row(1, 0), row(1, 3), &format!("zone from {west} to {east}"));
    }
    // Friction cells of a kilometre whose borders run through posts.
    let mut world = World::new(
        dem(&[&flat, &flat, &flat], (0.0, 0.0), (1000.0, 1000.0)),
        speeds(2400f64.sqrt()),
        SurfaceProperties { rest: RestSlope::Unlimited, ..friction(1.0) },
        1.0,
    );
    let raster = folder.path().join("friction.asc");
    let header = "ncols 3\nnrows 2\nxllcenter 500\nyllcenter 500\ncellsize 1000\n";
    std::fs::write(&raster, format!("{header}.3 .9 .3\n.3 .9 .3\n")).unwrap();
    world.friction = Some(read_friction_raster(&raster, None).unwrap());
    one_hop(&world, row(2, 1), row(2, 2), "friction cells of a kilometre");
    // Angles stated from the slope, on a facet exactly at the rest slope.
    let rising = [100.0, 100.2, 100.4];
    let surface = SurfaceProperties {
        grip: Some(Grip::FromSlope {
            takeoff: AngleInterval::from_degrees(0.0, 90.0),
            landing: AngleInterval::from_degrees(-90.0, 0.0),
        }),
        rest: RestSlope::AtMost(Angle::from_degrees(11.309_932_474_020_215)),
    };
    let world = World::new(dem(&[&rising, &rising, &rising], (0.0, 0.0), (1.0, 1.0)), speeds(2.0), surface, 1.0);
    one_hop(&world, row(2, 0), row(2, 1), "exactly at the rest slope");
    // Coordinates that are coarse beside the posts.
    let world =
        World::new(dem(&[&[0.03, 0.03, 0.0], &[0.03, 0.05, 0.05]], (5e6, 5e6), (0.1, 0.1)), speeds(0.4743), friction(1.0), 1.0);
    one_hop(&world, row(1, 2), row(1, 0), "coarse coordinates");
}
