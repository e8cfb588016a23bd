//! Missions over targets on tilted, cratered and real terrain: the best order against every order of single free routes.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use std::path::Path;

use chta::{
    ballistics::TakeoffChoice,
    graph::Effort,
    ground::DemGround,
    planner::{
        Amount, Budgets, LabelCap, NodesPerPost, Objective, RouteGoal, RouteQuestion, SearchedCommands, SurfaceLattice,
        SurfaceNodes, Tour, TourQuestion, VisitOrder, free_route, tour,
    },
    quantity::MapPoint,
    terrain::{Dem, GeoReference, OverlaidDem, Overlays, read_dem},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

use crate::support::Draw;

/// Hops, then the sum of take-off speeds.
type Price = (u64, f64);

fn ground_of(dem: Dem, speed_m_s: f64, gravity_m_s2: f64) -> DemGround {
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(speed_m_s, speed_m_s) }).unwrap();
    let grip = Some(Grip::Friction(FrictionCone::new(0.7).unwrap()));
    let surface = SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds };
    DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(gravity_m_s2).unwrap(), &surface)
}

/// The best of all orders over single free routes, by trying each; `None` where no order visits all.
fn enumerated(legs: &[Vec<Option<Price>>], order: VisitOrder, returns: bool) -> Option<Price> {
    fn from(
        legs: &[Vec<Option<Price>>],
        at: usize,
        left: &[usize],
        so_far: Price,
        asked: (VisitOrder, bool),
        best: &mut Option<Price>,
    ) {
        let sum = |leg: Price| (so_far.0 + leg.0, so_far.1 + leg.1);
        if left.is_empty() {
            let whole = if asked.1 { legs[at][0].map(sum) } else { Some(so_far) };
            let Some(whole) = whole else { return };
            let is_less = |known: &Price| whole.0.cmp(&known.0).then(whole.1.total_cmp(&known.1)).is_lt();
            if best.as_ref().is_none_or(is_less) {
                *best = Some(whole);
            }
            return;
        }
        for (number, to) in left.iter().enumerate() {
            if asked.0 == VisitOrder::Given && number > 0 {
                break;
            }
            if let Some(leg) = legs[at][*to] {
                let rest: Vec<usize> = left.iter().copied().filter(|other| other != to).collect();
                from(legs, *to, &rest, sum(leg), asked, best);
            }
        }
    }
    let all: Vec<usize> = (1..legs.len()).collect();
    let mut best = None;
    from(legs, 0, &all, (0, 0.0), (order, returns), &mut best);
    best
}

/// A tour over these stops in this order, with or without return.
fn toured(ground: &DemGround, nodes: &SurfaceNodes, stops: &[MapPoint], (order, returns): (VisitOrder, bool)) -> Tour {
    let objective = Objective::hops_then(Effort::TakeoffSpeed);
    let route = RouteQuestion {
        objective: &objective,
        budgets: &Budgets::NONE,
        commands: SearchedCommands::Chosen,
        errors: None,
        cap: LabelCap::default(),
    };
    let question = TourQuestion { route, effort: Effort::TakeoffSpeed, takeoff: TakeoffChoice::LeastSpeed, order, returns };
    tour(ground, nodes, stops, &question, &()).unwrap()
}

/// Compares tours over some places of a ground with all orders of single routes.
///
/// # Returns
/// How many tours were whole, and of how many the order is not the one listed.
fn compare(ground: &DemGround, per_post: usize, stops: &[MapPoint], what: &str) -> (u32, u32) {
    let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(per_post));
    let nodes = SurfaceNodes::new(ground, lattice, stops.iter().copied()).unwrap();
    let (effort, takeoff) = (Effort::TakeoffSpeed, TakeoffChoice::LeastSpeed);
    let leg = |start: MapPoint, goal: MapPoint| {
        let route = free_route(ground, &nodes, &RouteGoal { start, goal, effort, takeoff }, &()).unwrap();
        route.path.map(|path| (path.cost.hops(), path.totals.of(Amount::TakeoffSpeed)))
    };
    let legs: Vec<Vec<Option<Price>>> = stops
        .iter()
        .map(|start| stops.iter().map(|goal| if start == goal { Some((0, 0.0)) } else { leg(*start, *goal) }).collect())
        .collect();
    let (mut whole, mut reordered) = (0, 0);
    for asked in [(VisitOrder::Best, false), (VisitOrder::Best, true), (VisitOrder::Given, false), (VisitOrder::Given, true)] {
        let found = toured(ground, &nodes, stops, asked);
        let expected = enumerated(&legs, asked.0, asked.1);
        assert_eq!(found.left_out.is_empty(), expected.is_some(), "{what}: {asked:?}");
        let Some((hops, speeds_m_s)) = expected else { continue };
        let total = |amount| found.totals.of(amount);
        #[expect(clippy::cast_precision_loss, reason = "some hops")]
        let expected_hops = hops as f64;
        assert_eq!(total(Amount::Hops), expected_hops, "{what}: {asked:?}");
        let found_m_s = total(Amount::TakeoffSpeed);
        assert!((found_m_s - speeds_m_s).abs() < 1e-9 * speeds_m_s, "{what}: {asked:?}: {found_m_s}, {speeds_m_s}");
        whole += 1;
        reordered += u32::from(found.legs.windows(2).any(|pair| pair[1].to != pair[0].to + 1 && pair[1].to != 0));
    }
    (whole, reordered)
}

fn random_stops(draw: &mut Draw, ground: &DemGround, count: usize, about: MapPoint, within_m: f64) -> Vec<MapPoint> {
    let bounds = ground.terrain().dem().bounds();
    let inside = |value: f64, low: f64, high: f64| value.clamp(low, high);
    let mut stops = Vec::new();
    while stops.len() < count {
        let at = MapPoint::new(
            inside(about.x + draw.uniform(-within_m, within_m), bounds.min.x, bounds.max.x),
            inside(about.y + draw.uniform(-within_m, within_m), bounds.min.y, bounds.max.y),
        );
        if ground.position(at).is_some() && !stops.contains(&at) {
            stops.push(at);
        }
    }
    stops
}

#[test]
fn the_best_order_is_that_of_all_orders_on_tilted_and_cratered_ground() {
    let draw = &mut Draw::seeded(2111);
    let (mut whole, mut reordered) = (0, 0);
    for case in 0..8 {
        let (tilt, depth_m) = (draw.uniform(-0.25, 0.25), if case % 2 == 0 { 0.0 } else { draw.uniform(1.0, 4.0) });
        let height = |row: usize, col: usize| {
            let [x, y] = [col, row].map(|count| f64::from(u32::try_from(count).unwrap()));
            let away_m = (x - 9.0).hypot(y - 8.0);
            tilt * x + depth_m * ((away_m / 5.0).powi(2) - 1.0).min(0.0)
        };
        let heights = (0..18 * 20).map(|i| height(i / 20, i % 20)).collect();
        let dem = Dem::new(18, 20, heights, GeoReference::local(MapPoint::new(0.0, 17.0), 1.0, 1.0).unwrap()).unwrap();
        let ground = ground_of(dem, 3.0, 1.62);
        let count = if case == 0 { 8 } else { 4 + draw.below(3) };
        let stops = random_stops(draw, &ground, count, MapPoint::new(9.5, 8.5), 9.0);
        let (all, other) = compare(&ground, 1 + case % 2, &stops, &format!("case {case}"));
        whole += all;
        reordered += other;
    }
    assert!(whole > 12 && reordered > 5, "{whole} whole, {reordered} in another order than listed");
}

/// Whether hops lead from one place to another, and back.
fn are_joined(ground: &DemGround, ends: [MapPoint; 2]) -> bool {
    let lattice = SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(1));
    let nodes = SurfaceNodes::new(ground, lattice, ends).unwrap();
    let leads = |start, goal| {
        let goal = RouteGoal { start, goal, effort: Effort::TakeoffSpeed, takeoff: TakeoffChoice::LeastSpeed };
        free_route(ground, &nodes, &goal, &()).unwrap().path.is_some()
    };
    leads(ends[0], ends[1]) && leads(ends[1], ends[0])
}

/// Targets of real terrain about a place, as far as it is there.
fn compare_real(file: &str, (speed_m_s, gravity_m_s2): (f64, f64), (about, within_m): (MapPoint, f64), seed: u64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
    if !path.exists() {
        eprintln!("skipped: {} is not here", path.display());
        return;
    }
    let ground = ground_of(read_dem(&path).unwrap(), speed_m_s, gravity_m_s2);
    let draw = &mut Draw::seeded(seed);
    let mut stops = vec![about];
    while stops.len() < 6 {
        let others = random_stops(draw, &ground, 1, about, within_m);
        stops.extend(others.into_iter().filter(|at| are_joined(&ground, [about, *at])));
    }
    let (whole, reordered) = compare(&ground, 1, &stops, file);
    assert!(whole == 4 && reordered >= 1, "{whole} whole, {reordered} in another order than listed");
}

#[test]
fn the_best_order_is_that_of_all_orders_on_mars() {
    compare_real("hirise_DTEEC_010228_1490_crop_120x70.tif", (4.5, 3.711), (MapPoint::new(45.955, 90.395), 15.0), 2112);
}

#[test]
fn the_best_order_is_that_of_all_orders_on_the_moon() {
    compare_real("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", (6.0, 1.62), (MapPoint::new(76_002.5, 39_002.5), 150.0), 2113);
}
