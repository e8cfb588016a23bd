//! The search against petgraph's on the same graph and against itself with other numbers of threads; many questions against single
//! ones.

use chta::{
    graph::{Edge, HopGraph, reachable, search_pairs},
    quantity::NodeId,
};
use petgraph::{algo, visit::EdgeRef};

use super::*;

/// A chain with some bends, with hops in both directions.
fn bent(draw: &mut Draw, world: &World) -> ConstrainedChain {
    let geometry = world.chain().geometry().clone();
    let bends = (1..geometry.segment_count()).filter(|_| draw.chance(0.15)).map(VertexId).collect();
    let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    ConstrainedChain::new(geometry.with_bends(bends).unwrap(), &Hopper::UNLIMITED, Gravity::new(1.0).unwrap(), &surface).unwrap()
}

fn graph(test: &HopTest, nodes: &NodeSet, options: &SearchOptions) -> HopGraph {
    HopGraph::new(test, nodes, options.effort, options.takeoff, options.split)
}

#[test]
fn petgraph_finds_the_same_costs() {
    let draw = &mut Draw::seeded(40);
    let (mut paths, mut along, mut none) = (0, 0, 0);
    for _ in 0..2500 {
        let segments = 2 + draw.below(9);
        let world = World::draw(draw, segments);
        let chain = bent(draw, &world);
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let (start, goal) = (place(draw, &chain), place(draw, &chain));
        let points = u32::try_from(draw.below(5)).unwrap();
        let options = options(draw, points);
        let nodes = node_set(&chain, start, goal, &options);
        let graph = graph(&test, &nodes, &options);
        let theirs = algo::astar(
            &graph,
            nodes.start(),
            |node| node == nodes.goal(),
            |edge| *edge.weight(),
            |_| chta::graph::Cost::default(),
        );
        let found = asked(&test, start, goal, &options);
        assert_eq!(found.nodes, nodes.stations().len());
        let (Outcome::Path { legs, cost }, Some((expected, _))) = (&found.outcome, &theirs) else {
            assert!(found.hops().is_none() && theirs.is_none(), "{:?} against {theirs:?}", found.outcome);
            none += 1;
            continue;
        };
        assert_eq!(cost.hops(), expected.hops());
        assert!((cost.effort() - expected.effort()).abs() <= 1e-12 * expected.effort(), "{cost:?} against {expected:?}");
        let ends = legs.first().zip(legs.last()).map_or((start, start), |(first, last)| (first.takeoff, last.landing));
        assert_eq!((ends.0.point, ends.1.point), (start.point, goal.point), "a path from start to goal");
        assert!(legs.windows(2).all(|pair| pair[0].landing == pair[1].takeoff), "legs do not join");
        let mut sum = chta::graph::Cost::default();
        for leg in legs {
            assert_eq!(graph.edge(&leg.takeoff, &leg.landing), Ok(leg.edge));
            sum = sum + graph.cost(&leg.takeoff, &leg.landing, leg.edge);
            along += u32::from(matches!(leg.edge, Edge::Along(_)));
        }
        assert_eq!(sum, *cost, "the cost is the sum over the legs, from the start");
        paths += 1;
    }
    assert!(paths > 700 && none > 300 && along > 30, "{paths} paths with {along} stretches, {none} without");
}

#[test]
fn petgraph_reaches_the_same_nodes_with_the_same_hop_counts() {
    let draw = &mut Draw::seeded(41);
    let mut reached = 0;
    for _ in 0..600 {
        let segments = 2 + draw.below(9);
        let world = World::draw(draw, segments);
        let chain = bent(draw, &world);
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let start = place(draw, &chain);
        let points = u32::try_from(draw.below(4)).unwrap();
        let options = options(draw, points);
        let nodes = node_set(&chain, start, start, &options);
        let graph = graph(&test, &nodes, &options);
        let theirs = algo::dijkstra(&graph, nodes.start(), None, |edge| edge.weight().hops());
        let found = reachable(&test, start, options.spacing.unwrap(), &()).unwrap();
        assert_eq!(found.nodes.len(), nodes.stations().len());
        for (i, (station, hops)) in found.nodes.iter().enumerate() {
            assert_eq!(*station, nodes.stations()[i]);
            assert_eq!(*hops, theirs.get(&NodeId(i)).copied(), "node {i}");
        }
        reached += theirs.len() - 1;
    }
    assert!(reached > 1000, "only {reached} nodes reached");
}

/// A long chain whose batches are worth distributing, from a position inside it.
fn long(draw: &mut Draw, segments: u16) -> (ConstrainedChain, Hopper) {
    let mut z_m = 0.0;
    let point = |i: u16| {
        z_m += draw.uniform(-0.2, 0.2);
        ChainPoint::new(f64::from(i), z_m)
    };
    let points: Vec<ChainPoint> = (0..=segments).map(point).collect();
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::UNLIMITED }).unwrap();
    (crate::support::uniform(&points, line((30.0, 90.0), 12.0, (-90.0, -20.0), 12.0)), hopper)
}

#[test]
fn any_number_of_threads_gives_the_same_answer() {
    let draw = &mut Draw::seeded(42);
    for (k, effort) in [(0, Effort::Energy), (3, Effort::TakeoffSpeed), (4, Effort::PeakSpeed)] {
        let (chain, hopper) = long(draw, 400);
        let test = HopTest::new(chain.with_hopper(&hopper, Gravity::new(3.711).unwrap()).unwrap());
        let station = |x_m: f64| chain.geometry().station(x_m).unwrap();
        let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(k)), effort, ..SearchOptions::default() };
        let pairs = [(station(150.0), station(399.5)), (station(150.0), station(0.25)), (station(3.0), station(380.0))];
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let alone = search(&test, pairs[0].0, pairs[0].1, &options, &()).unwrap();
                (alone, search_pairs(&test, &pairs, &options, &()).unwrap())
            })
        };
        let one = with(1);
        assert!(one.0.hops().is_some_and(|hops| hops >= 5), "{:?}", one.0.hops());
        for threads in [2, 7] {
            assert!(with(threads) == one, "{threads} threads");
        }
    }
}

#[test]
fn many_questions_at_once_have_the_answers_of_single_ones() {
    let draw = &mut Draw::seeded(43);
    let (mut shared, mut paths, mut later) = (0, 0, 0);
    for _ in 0..250 {
        let segments = 2 + draw.below(5);
        let world = World::draw(draw, segments);
        let chain = bent(draw, &world);
        let test = HopTest::new(chain.with_hopper(&world.hopper, Gravity::new(world.g).unwrap()).unwrap());
        let places: Vec<Station> = (0..4).map(|_| place(draw, &chain)).collect();
        let pairs: Vec<(Station, Station)> = (0..7).map(|_| (places[draw.below(3)], places[draw.below(4)])).collect();
        let points = u32::try_from(draw.below(4)).unwrap();
        let mut options = options(draw, points);
        if draw.chance(0.2) {
            options.spacing = None;
        }
        let together = search_pairs(&test, &pairs, &options, &()).unwrap();
        assert_eq!(together.len(), pairs.len());
        for ((start, goal), found) in pairs.iter().zip(&together) {
            let alone = asked(&test, *start, *goal, &options);
            let same_start = pairs.iter().filter(|pair| pair.0.point.x_m == start.point.x_m).count();
            if same_start == 1 {
                assert_eq!(*found, alone);
            } else {
                let counts = |answer: &Answer| (answer.spacing, answer.points_per_segment, answer.nodes);
                assert_eq!((&found.outcome, counts(found)), (&alone.outcome, counts(&alone)));
                shared += 1;
            }
            paths += u32::from(found.hops().is_some_and(|hops| hops > 0));
            later += u32::from(found.hops().is_some() && found.points_per_segment > 0 && options.spacing.is_none());
        }
    }
    assert!(shared > 500 && paths > 300 && later > 3, "{shared} shared starts, {paths} paths, {later} of them later");
}

#[test]
fn questions_of_one_start_share_their_work() {
    let (chain, hopper) = long(&mut Draw::seeded(44), 300);
    let test = HopTest::new(chain.with_hopper(&hopper, Gravity::new(3.711).unwrap()).unwrap());
    let station = |x_m: f64| chain.geometry().station(x_m).unwrap();
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(1)), ..SearchOptions::default() };
    let goals = [290.0, 270.5, 250.0, 280.0];
    let pairs = goals.map(|x_m| (station(1.0), station(x_m)));
    let together = search_pairs(&test, &pairs, &options, &()).unwrap();
    let alone = asked(&test, pairs[0].0, pairs[0].1, &options);
    assert!(together.iter().all(|answer| answer.hops().is_some()));
    assert!(together[0].pairs_tested < alone.pairs_tested * 3 / 2, "{} against {}", together[0].pairs_tested, alone.pairs_tested);
}
