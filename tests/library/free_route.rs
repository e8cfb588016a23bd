//! The search towards a goal over nodes finer than posts, against every pair of nodes by slice and hop test and an own search.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use std::{cmp::Ordering, ops::ControlFlow, path::Path, sync::Mutex};

use chta::{
    ballistics::{Arc, PathBounds, TakeoffChoice},
    graph::{Edge, Effort, NodeSet, Outcome, PointSpacing, SearchOptions, search},
    ground::{DemGround, MapPosition, Surface},
    hop::HopTest,
    planner::{FreeRoute, NodesPerPost, RouteError, RouteGoal, SurfaceLattice, SurfaceNodes, free_route},
    progress::{Progress, Stage, Step},
    quantity::{MapPoint, VertexId},
    reach::map::Post,
    terrain::{Dem, read_dem},
    world::{Hopper, HopperLimits},
};

use crate::{
    map_equality::cut_out,
    map_world::{World, friction, random_dem, random_hopper, random_surface},
    support::Draw,
};

const EFFORTS: [Effort; 4] = [Effort::TakeoffSpeed, Effort::Energy, Effort::Time, Effort::PeakSpeed];

/// The lattice of n nodes a post spacing, start and goal, and the nodes of the straight slice between them at this spacing.
pub(crate) fn nodes(ground: &DemGround, n: u32, [start, goal]: [MapPoint; 2], slice_spacing_m: Option<f64>) -> SurfaceNodes {
    let dem = ground.terrain().dem();
    let lattice = SurfaceLattice::new(dem, NodesPerPost::at_most_m(1.0 / f64::from(n), 1.0));
    let chain = slice_spacing_m.and_then(|spacing_m| Some((ground.chain(start, goal).ok()?, spacing_m)));
    let of_slice = chain.map(|(chain, spacing_m)| {
        let stations = NodeSet::of_chain(&chain, PointSpacing::AtMostM(spacing_m)).unwrap();
        stations.stations().iter().filter_map(|station| chain.geometry().map_point(station)).collect::<Vec<_>>()
    });
    SurfaceNodes::new(ground, lattice, [start, goal].into_iter().chain(of_slice.into_iter().flatten())).unwrap()
}

/// The positions of all nodes, each once.
pub(crate) fn positions(ground: &DemGround, n: u32, places: &[MapPoint]) -> Vec<MapPosition> {
    let dem = ground.terrain().dem();
    let lattice = SurfaceLattice::new(dem, NodesPerPost::at_most_m(1.0 / f64::from(n), 1.0));
    let mut all: Vec<MapPosition> =
        (0..lattice.count()).filter_map(|index| ground.position(lattice.at(lattice.node(index)))).collect();
    for place in places {
        if all.iter().all(|other| other.at != *place) {
            all.extend(ground.position(*place));
        }
    }
    all
}

/// Hops, then effort.
type Price = (u64, f64);

fn less(a: Price, b: Price) -> Ordering {
    a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
}

/// The cost of the hop between two places: their slice, its chain, the hop test from end to end. Beyond the speeds' reach it is not asked.
fn price(ground: &DemGround, from: &MapPosition, to: &MapPosition, effort: Effort, takeoff: TakeoffChoice) -> Option<f64> {
    let (run_m, climb_m) = ((to.at - from.at).norm(), to.z_m - from.z_m);
    let limits = ground.hopper().limits();
    let reaches =
        |speed_m_s: f64, climb_m: f64| ground.gravity_m_s2() * (run_m.hypot(climb_m) + climb_m) <= speed_m_s * speed_m_s * 1.001;
    if run_m == 0.0 || !reaches(limits.takeoff_speed_max_m_s, climb_m) || !reaches(limits.landing_speed_max_m_s, -climb_m) {
        return None;
    }
    let test = HopTest::new(ground.chain(from.at, to.at).ok()?);
    let geometry = test.chain().geometry();
    let ends = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
    let arc: Arc = test.takeoff_set(&ends.0, &ends.1)?.arc(takeoff, test.gravity_m_s2())?;
    let v = arc.takeoff_speed_m_s();
    Some(match effort {
        Effort::TakeoffSpeed | Effort::PeakSpeed => v,
        Effort::Energy => 0.5 * v * v,
        Effort::Time => arc.flight_time_s(),
    })
}

/// Dijkstra over every pair of places.
fn own_search(
    ground: &DemGround,
    places: &[MapPosition],
    ends: [MapPoint; 2],
    effort: Effort,
    takeoff: TakeoffChoice,
) -> Option<Price> {
    let index = |at: MapPoint| places.iter().position(|place| place.at == at).unwrap();
    let [start, goal] = ends.map(index);
    let mut best: Vec<Option<Price>> = vec![None; places.len()];
    let mut taken = vec![false; places.len()];
    best[start] = Some((0, 0.0));
    loop {
        let next = (0..places.len()).filter(|i| !taken[*i]).filter_map(|i| Some((i, best[i]?))).min_by(|a, b| less(a.1, b.1));
        let (here, cost) = next?;
        if here == goal {
            return Some(cost);
        }
        taken[here] = true;
        for there in 0..places.len() {
            // A goal beyond a hop more than is known needs no test.
            if taken[there] || best[there].is_some_and(|known| known.0 < cost.0 + 1) {
                continue;
            }
            let Some(each) = price(ground, &places[here], &places[there], effort, takeoff) else { continue };
            let total = (cost.0 + 1, if effort == Effort::PeakSpeed { cost.1.max(each) } else { cost.1 + each });
            if best[there].is_none_or(|known| less(total, known) == Ordering::Less) {
                best[there] = Some(total);
            }
        }
    }
}

fn found(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    [start, goal]: [MapPoint; 2],
    effort: Effort,
    takeoff: TakeoffChoice,
) -> FreeRoute {
    free_route(ground, nodes, &RouteGoal { start, goal, effort, takeoff }, &()).unwrap()
}

/// Compares both searches; returns the hops.
fn compare(ground: &DemGround, n: u32, ends: [MapPoint; 2], (effort, takeoff): (Effort, TakeoffChoice), what: &str) -> Option<u64> {
    let nodes = nodes(ground, n, ends, None);
    let route = found(ground, &nodes, ends, effort, takeoff);
    let expected = own_search(ground, &positions(ground, n, &ends), ends, effort, takeoff);
    let path = route.path.as_ref();
    let hops = path.map(|path| path.cost.hops());
    assert_eq!(hops, expected.map(|cost| cost.0), "{what}, n = {n}, {effort:?}");
    if let (Some(path), Some(expected)) = (path, expected) {
        let places = &path.places;
        let apart = (path.cost.effort() - expected.1).abs();
        assert!(apart <= 1e-6 * (1.0 + expected.1), "{what}, n = {n}, {effort:?}: {} against {}", path.cost.effort(), expected.1);
        assert_eq!(([places[0].at, places[places.len() - 1].at], places.len() as u64 - 1), (ends, expected.0), "{what}");
        // The amount of the path is that of its legs, each by its own slice.
        let legs = places.windows(2).map(|pair| price(ground, &pair[0], &pair[1], effort, takeoff).unwrap());
        let total = if effort == Effort::PeakSpeed { legs.fold(0.0, f64::max) } else { legs.sum() };
        assert!((total - expected.1).abs() <= 1e-6 * (1.0 + total), "{what}: {total} against {}", expected.1);
        let limits = ground.hopper().limits();
        let bounds = PathBounds::new(limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s(), ground.gravity_m_s2());
        let (first, last) = (places[0], places[places.len() - 1]);
        let lower = bounds.hops((last.at - first.at).norm(), last.z_m - first.z_m).unwrap();
        assert!(lower <= expected.0, "{what}: {lower} hops at least, {} found", expected.0);
    }
    hops
}

/// A place on a raster, now and then a post.
fn place(draw: &mut Draw, dem: &Dem) -> MapPoint {
    if draw.chance(0.3) {
        return dem.georeference().post(draw.below(dem.rows()), draw.below(dem.cols()));
    }
    let bounds = dem.bounds();
    MapPoint::new(draw.uniform(bounds.min.x, bounds.max.x), draw.uniform(bounds.min.y, bounds.max.y))
}

pub(crate) fn random_world(draw: &mut Draw, side: usize) -> World {
    let (hopper, gravity_m_s2) = random_hopper(draw);
    World::new(random_dem(draw, side), hopper, random_surface(draw), gravity_m_s2)
}

/// Two different places with ground.
pub(crate) fn random_ends(draw: &mut Draw, ground: &DemGround) -> Option<[MapPoint; 2]> {
    let ends = [0, 1].map(|_| place(draw, ground.terrain().dem()));
    (ends[0] != ends[1] && ends.iter().all(|at| ground.position(*at).is_some())).then_some(ends)
}

#[test]
fn random_grounds_have_the_hops_and_the_effort_of_every_pair_of_nodes() {
    let draw = &mut Draw::seeded(1721);
    let (mut reached, mut not) = ([0; 4], 0);
    for number in 0..320 {
        let ground = random_world(draw, 7).ground();
        let Some(ends) = random_ends(draw, &ground) else { continue };
        let takeoff = [TakeoffChoice::LeastSpeed, TakeoffChoice::MidRange, TakeoffChoice::LeastTime][draw.below(3)];
        let kind = number / 2 % 4;
        match compare(&ground, 1 + u32::from(number % 2 == 1), ends, (EFFORTS[kind], takeoff), &format!("ground {number}")) {
            Some(hops) => reached[kind] += u32::from(hops > 1),
            None => not += 1,
        }
    }
    assert!(reached.iter().all(|count| *count > 3) && not > 10, "{reached:?} reached in several hops, {not} not reached");
}

/// Cut-outs of a real DEM.
fn compare_cut_outs(file: &str, hopper: &Hopper, gravity_m_s2: f64, seed: u64) {
    const SIDE: usize = 12;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
    if !path.exists() {
        eprintln!("skipped: {} is absent", path.display());
        return;
    }
    let dem = read_dem(&path).unwrap();
    let (draw, mut reached) = (&mut Draw::seeded(seed), 0);
    for number in 0..6 {
        let first = Post { row: draw.below(dem.rows() - SIDE), col: draw.below(dem.cols() - SIDE) };
        let world = World::new(cut_out(&dem, first, SIDE, 0, draw), *hopper, friction(0.6), gravity_m_s2);
        let ground = world.ground();
        let Some(ends) = random_ends(draw, &ground) else { continue };
        let effort = EFFORTS[draw.below(4)];
        let what = format!("{file} from row {}, column {}", first.row, first.col);
        let hops = compare(&ground, 1 + number % 2, ends, (effort, TakeoffChoice::LeastSpeed), &what);
        reached += u32::from(hops.is_some_and(|hops| hops > 1));
    }
    assert!(reached > 1, "{reached} goals of {file} in several hops");
}

#[test]
fn cut_outs_of_mars_have_the_hops_and_the_effort_of_every_pair_of_nodes() {
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(3.5, 3.5) }).unwrap();
    compare_cut_outs("hirise_DTEEC_010228_1490_crop_120x70.tif", &hopper, 3.711, 1722);
}

#[test]
fn cut_outs_of_the_moon_have_the_hops_and_the_effort_of_every_pair_of_nodes() {
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.2, ..HopperLimits::with_speeds(5.5, 5.5) }).unwrap();
    compare_cut_outs("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", &hopper, 1.624, 1723);
}

/// Twice as many nodes, the old ones and those of the slice among them, never cost a hop; nor does the freedom to leave the slice.
#[test]
fn more_nodes_and_more_directions_never_cost_a_hop() {
    let draw = &mut Draw::seeded(1724);
    let (mut nested, mut fewer, mut straight, mut shorter) = (0, 0, 0, 0);
    for _ in 0..300 {
        let ground = random_world(draw, 7).ground();
        let Some(ends) = random_ends(draw, &ground) else { continue };
        let spacing_m = draw.uniform(0.3, 1.0);
        let hops = [1, 2, 4].map(|n| {
            let route =
                found(&ground, &nodes(&ground, n, ends, Some(spacing_m)), ends, Effort::TakeoffSpeed, TakeoffChoice::LeastSpeed);
            route.path.map(|path| path.cost.hops())
        });
        for pair in hops.windows(2) {
            if let Some(coarse) = pair[0] {
                assert!(pair[1].is_some_and(|fine| fine <= coarse), "{hops:?}");
                nested += 1;
                fewer += u32::from(pair[1] < pair[0]);
            }
        }
        let Ok(chain) = ground.chain(ends[0], ends[1]) else { continue };
        let (geometry, test) = (chain.geometry().clone(), HopTest::new(chain));
        let stations = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
        let options = SearchOptions { spacing: Some(PointSpacing::AtMostM(spacing_m)), ..SearchOptions::default() };
        let Outcome::Path { legs, cost } = search(&test, stations.0, stations.1, &options, &()).unwrap().outcome else { continue };
        // Many hops along one segment land between the nodes.
        if legs.iter().all(|leg| matches!(leg.edge, Edge::Hop(_))) {
            assert!(hops[0].is_some_and(|free| free <= cost.hops()), "{hops:?} against {}", cost.hops());
            straight += 1;
            shorter += u32::from(hops[2] < Some(cost.hops()));
        }
    }
    assert!(
        nested > 60 && fewer > 3 && straight > 20 && shorter > 2,
        "{nested} nested, {fewer} fewer; {straight} straight, {shorter} fewer"
    );
}

/// Ends the search after some steps.
struct Impatient(Mutex<u32>);

impl Progress for Impatient {
    fn report(&self, step: &Step) -> ControlFlow<()> {
        assert_eq!(step.stage, Stage::Search);
        let mut left = self.0.lock().unwrap();
        *left = left.saturating_sub(1);
        if *left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

#[test]
fn a_search_is_cancelled_and_refuses_what_it_cannot_search() {
    let draw = &mut Draw::seeded(1725);
    let dem = random_dem(draw, 60);
    let hopper = Hopper::with_speeds(4.0, 4.0).unwrap();
    let ground = World::new(dem, hopper, friction(0.9), 1.6).ground();
    let map = ground.terrain().dem().georeference();
    let ends = [(1, 1), (58, 58)].map(|(row, col)| map.post(row, col));
    let nodes = nodes(&ground, 4, ends, None);
    let question = RouteGoal { start: ends[0], goal: ends[1], effort: Effort::Time, takeoff: TakeoffChoice::LeastSpeed };
    let cancelled = free_route(&ground, &nodes, &question, &Impatient(Mutex::new(1)));
    assert!(matches!(cancelled, Err(RouteError::Cancelled(_))), "{cancelled:?}");
    let off = RouteGoal { goal: MapPoint::new(-1e6, 0.0), ..question };
    assert_eq!(free_route(&ground, &nodes, &off, &()), Err(RouteError::NoGround(MapPoint::new(-1e6, 0.0))));
    let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::at_most_m(1e-9, 1.0));
    let problem = SurfaceNodes::new(&ground, lattice, ends).unwrap_err();
    assert!(problem.to_string().contains("make the spacing of nodes larger"), "{problem}");
}
