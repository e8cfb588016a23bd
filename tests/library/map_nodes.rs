//! Maps over nodes finer than the posts, against the direct method: slice and hop test between the places of the nodes.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]

use chta::{
    hop::HopTest,
    quantity::{MapPoint, SlopeInterval, VertexId},
    reach::map::{NO_GROUND, NodeLattice, Post, PostHops, Search, UNREACHED, search},
    terrain::slice,
};

use crate::{
    map_world::{World, random_dem, random_hopper, random_surface},
    support::Draw,
};

/// The lofts of the hop between two places by slice, chain and hop test.
pub(crate) fn by_slice(world: &World, from: MapPoint, to: MapPoint) -> Option<SlopeInterval> {
    let chain = world.chain(slice(&world.dem, from, to).ok()?).unwrap();
    let test = HopTest::new(chain.clone());
    let geometry = chain.geometry();
    test.lofts(&geometry.vertex_station(VertexId(0)), &geometry.vertex_station(VertexId(geometry.segment_count()))).ok()
}

/// All nodes of a lattice.
pub(crate) fn nodes(lattice: NodeLattice) -> Vec<Post> {
    (0..lattice.count()).map(|index| lattice.node(index)).collect()
}

/// Every pair of nodes has the verdict of the slice between their places, and the same lofts up to rounding.
fn compare_pairs(world: &World, per_post: usize, what: &str) -> [usize; 2] {
    let lattice = NodeLattice::finer(&world.dem, per_post);
    let hops = PostHops::over(world.ground(), lattice).unwrap();
    let map = world.dem.georeference();
    let mut counts = [0; 2];
    for from in nodes(lattice) {
        let mut found = vec![None; lattice.count()];
        for offset in 0..hops.offset_count() {
            if let Some(to) = hops.landing(from, offset) {
                found[lattice.index(to)] = hops.lofts(from, offset).unwrap().map(|(_, lofts)| lofts);
            }
        }
        for to in nodes(lattice).into_iter().filter(|to| *to != from) {
            let (quick, expected) = (found[lattice.index(to)], by_slice(world, lattice.at(map, from), lattice.at(map, to)));
            assert_eq!(quick.is_some(), expected.is_some(), "{what}: {from:?} to {to:?}: {quick:?} against {expected:?}");
            if let (Some(quick), Some(expected)) = (quick, expected) {
                let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-7 * (1.0 + a.abs().max(b.abs()));
                assert!(near(quick.lower, expected.lower) && near(quick.upper, expected.upper), "{what}: {from:?} to {to:?}");
            }
            counts[usize::from(expected.is_some())] += 1;
        }
    }
    counts
}

#[test]
fn every_pair_of_finer_nodes_has_the_result_of_the_slice_between_them() {
    let mut draw = Draw::seeded(1721);
    let mut counts = [0; 2];
    for number in 0..16 {
        let per_post = 1 + number % 4;
        let dem = random_dem(&mut draw, [8, 5, 5, 5][per_post - 1]);
        let (hopper, gravity) = random_hopper(&mut draw);
        let world = World::new(dem, hopper, random_surface(&mut draw), gravity);
        let found = compare_pairs(&world, per_post, &format!("grid {number}, {per_post} nodes a post"));
        counts = [counts[0] + found[0], counts[1] + found[1]];
    }
    assert!(counts[0] > 10_000 && counts[1] > 10_000, "{counts:?} pairs apart and joined");
}

/// Nodes at twice as many places a post never cost a hop, and posts have those of a map of posts or fewer.
#[test]
fn finer_nodes_never_cost_a_hop() {
    let mut draw = Draw::seeded(1722);
    let (mut fewer, mut newly_reached) = (0, 0);
    for number in 0..30 {
        let dem = random_dem(&mut draw, 9);
        let (hopper, gravity) = random_hopper(&mut draw);
        let world = World::new(dem, hopper, random_surface(&mut draw), gravity);
        let start = Post { row: draw.below(9), col: draw.below(9) };
        if world.dem.elevation(start.row, start.col).is_none() {
            continue;
        }
        let map = |per_post: usize| {
            let lattice = NodeLattice::finer(&world.dem, per_post);
            let hops = PostHops::over(world.ground(), lattice).unwrap();
            let start = Post { row: start.row * per_post, col: start.col * per_post };
            let found = search(&hops, &[start.into()], Search::default(), &()).unwrap();
            nodes(NodeLattice::new(&world.dem, 1))
                .into_iter()
                .map(|post| found.hops[lattice.index(Post { row: post.row * per_post, col: post.col * per_post })])
                .collect::<Vec<_>>()
        };
        let (posts, halves, quarters) = (map(1), map(2), map(4));
        for (coarse, fine) in [(&posts, &halves), (&halves, &quarters)] {
            for (post, (&coarse, &fine)) in coarse.iter().zip(fine).enumerate() {
                assert!(
                    coarse == fine || (coarse == UNREACHED && fine > 0) || (coarse > fine && fine > 0),
                    "grid {number}, post {post}: {coarse} hops, {fine} over finer nodes"
                );
                assert_eq!(coarse == NO_GROUND, fine == NO_GROUND);
                newly_reached += u32::from(coarse == UNREACHED && fine > 0);
                fewer += u32::from(coarse > fine);
            }
        }
    }
    assert!(fewer > 50 && newly_reached > 50, "{fewer} posts with fewer hops, {newly_reached} newly reached");
}
