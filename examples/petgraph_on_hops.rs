//! petgraph's algorithms on the hop graph of a chain, next to the search of this crate: `cargo run --example petgraph_on_hops`.
//!
//! The chain is a plateau 18 m above a plain. The hopper lands at up to 14 m/s, so it can hop down the cliff; it takes off at up to
//! 10 m/s, so it cannot hop up again.
#![expect(clippy::print_stdout, reason = "a program that prints")]

use std::error::Error;

use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, csv::read_chain_csv_file},
    graph::{Cost, Effort, HopGraph, NodeSet, PointSpacing, SearchOptions, reachable, search},
    hop::{HopTest, Split},
    world::{Body, FrictionCone, Grip, Hopper, RestSlope, SurfaceProperties},
};
use petgraph::{
    algo::{astar, dijkstra, has_path_connecting, tarjan_scc},
    visit::EdgeRef,
};

fn main() -> Result<(), Box<dyn Error>> {
    let ground = read_chain_csv_file(concat!(env!("CARGO_MANIFEST_DIR"), "/data/chains/cliff.csv"))?.chain;
    let mars = Body::named("mars").ok_or("expected mars among the bodies")?;
    let grip = Some(Grip::Friction(FrictionCone::new(0.8)?));
    let surface = SurfaceProperties { grip, rest: RestSlope::AsFrictionHolds };
    let test = HopTest::new(ConstrainedChain::new(ground, &Hopper::with_speeds(10.0, 14.0)?, mars.gravity, &surface)?);
    let (start, goal) = (test.chain().geometry().station(2.0)?, test.chain().geometry().station(42.0)?);

    // The graph: nodes at most 1 m apart, an edge where one hop joins two of them, or several along one segment. An edge is evaluated
    // when an algorithm visits its first node.
    let spacing = PointSpacing::AtMostM(1.0);
    let nodes = NodeSet::new(test.chain(), start, goal, spacing)?;
    let graph = HopGraph::new(&test, &nodes, Effort::TakeoffSpeed, TakeoffChoice::LeastSpeed, Split::FullReach);

    // A*: fewest hops, then least effort. The same answer as this crate's own search.
    let found = astar(&graph, nodes.start(), |node| node == nodes.goal(), |edge| *edge.weight(), |_| Cost::default());
    let (cost, path) = found.ok_or("expected a path down the cliff")?;
    let at_m: Vec<String> = path.iter().map(|&node| format!("{:.1}", nodes.station(node).point.x_m)).collect();
    println!("A*: {} hops at x = {} m, sum of take-off speeds {:.3} m/s", cost.hops(), at_m.join(", "), cost.effort());
    let options = SearchOptions { spacing: Some(spacing), effort: Effort::TakeoffSpeed, ..SearchOptions::default() };
    let own = search(&test, start, goal, &options, &())?;
    assert_eq!(own.hops(), Some(cost.hops()), "search and A* count different hops");
    println!("chta::graph::search: {} hops", cost.hops());

    // Dijkstra's algorithm: hops from the start to every node. The same numbers as `reachable`.
    let hops = dijkstra(&graph, nodes.start(), None, |edge| edge.weight().hops());
    let most = hops.values().max().copied().unwrap_or(0);
    println!("Dijkstra: {} of {} nodes are reached, each in {most} hops or fewer", hops.len(), nodes.stations().len());
    let own = reachable(&test, start, spacing, &())?;
    for (station, own_hops) in own.nodes {
        let node = nodes.find(&station);
        let theirs = node.and_then(|node| hops.get(&node).copied());
        assert!(node.is_none() || theirs == own_hops, "{own_hops:?} and {theirs:?} hops to x = {} m", station.point.x_m);
    }

    // Strongly connected components: the stretches within which the hopper can get from every node to every other.
    let mut stretches = tarjan_scc(&graph);
    stretches.retain(|stretch| stretch.len() > 1);
    stretches.sort();
    for stretch in &stretches {
        let x_m = || stretch.iter().map(|&node| nodes.station(node).point.x_m);
        let (first_m, last_m) = (x_m().fold(f64::INFINITY, f64::min), x_m().fold(f64::NEG_INFINITY, f64::max));
        println!("from any of the {} nodes at x = {first_m:.1} to {last_m:.1} m to any other and back", stretch.len());
    }
    let back = has_path_connecting(&graph, nodes.goal(), nodes.start(), None);
    assert!(!back, "18 m up need a take-off at 11.6 m/s");
    println!("from the goal back to the start: no path");
    Ok(())
}
