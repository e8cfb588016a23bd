//! What a straight slice reaches from the start of a map, the map reaches as well: nodes at a quarter of the post spacing, on both real DEMs.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why, and the shares are of interest")]

use std::path::Path;

use chta::{
    ballistics::TakeoffChoice,
    graph::{Effort, NodeSet, PointSpacing, SearchOptions, search as search_along},
    hop::HopTest,
    planner::{NodesPerPost, RouteGoal, SurfaceLattice, SurfaceNodes, free_route},
    quantity::VertexId,
    reach::map::{NodeLattice, Post, PostHops, Search, search},
    terrain::read_dem,
    world::{Hopper, HopperLimits},
};

use crate::{
    map_equality::cut_out,
    map_world::{World, friction},
    support::Draw,
};

/// Nodes a post spacing.
const PER_POST: usize = 4;

/// Compares a map of a cut-out with the slices from its start to every third post each way; returns how many a slice reaches, and how many of
/// these the map does not.
fn compare(world: &World, start: Post) -> [usize; 2] {
    let (ground, map) = (world.ground(), world.dem.georeference());
    let lattice = NodeLattice::finer(&world.dem, PER_POST);
    let hops = PostHops::over(ground.clone(), lattice).unwrap();
    let node = |post: Post| Post { row: post.row * PER_POST, col: post.col * PER_POST };
    let found = search(&hops, &[node(start).into()], Search::default(), &()).unwrap();
    let spacing = PointSpacing::AtMostM(map.dx_m() / 4.0);
    let options = SearchOptions { spacing: Some(spacing), ..SearchOptions::default() };
    let mut counts = [0; 2];
    for post in (0..world.dem.rows()).step_by(3).flat_map(|row| (0..world.dem.cols()).step_by(3).map(move |col| Post { row, col }))
    {
        let ends = [map.post(start.row, start.col), map.post(post.row, post.col)];
        let Ok(chain) = ground.chain(ends[0], ends[1]) else { continue };
        let geometry = chain.geometry();
        let (from, to) = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
        if search_along(&HopTest::new(chain.clone()), from, to, &options, &()).unwrap().hops().is_none() {
            continue;
        }
        counts[0] += 1;
        if found.hops[lattice.index(node(post))] >= 0 {
            continue;
        }
        counts[1] += 1;
        // With the nodes of the slice the post is reached.
        let of_slice = NodeSet::of_chain(&chain, spacing).unwrap();
        let places = of_slice.stations().iter().filter_map(|station| geometry.map_point(station));
        let finer = SurfaceLattice::new(&world.dem, NodesPerPost::at_most_m(1.0, 4.0));
        let nodes = SurfaceNodes::new(&ground, finer, ends.into_iter().chain(places)).unwrap();
        let goal = RouteGoal { start: ends[0], goal: ends[1], effort: Effort::TakeoffSpeed, takeoff: TakeoffChoice::LeastSpeed };
        let route = free_route(&ground, &nodes, &goal, &()).unwrap();
        assert!(route.places.is_some(), "{post:?} is reached along its slice and by no route over its nodes");
    }
    counts
}

/// At least 99 % of the posts that a slice reaches, over cut-outs of rough and of gentle ground.
#[test]
fn a_map_over_quarters_of_posts_reaches_what_slices_reach() {
    let mut all = [0; 2];
    for (file, side, speed_m_s, mu, gravity) in [
        ("hirise_DTEEC_010228_1490_crop_120x70.tif", 28, 3.5, 0.7, 3.711),
        ("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", 28, 6.0, 0.35, 1.62),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
        if !path.exists() {
            eprintln!("skipped: {} is absent", path.display());
            return;
        }
        let dem = read_dem(&path).unwrap();
        let mut draw = Draw::seeded(1741);
        let mut of_file = [0; 2];
        for _ in 0..4 {
            let first = Post { row: draw.below(dem.rows() - side), col: draw.below(dem.cols() - side) };
            let limits = HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(speed_m_s, speed_m_s) };
            let cut = cut_out(&dem, first, side, 0, &mut draw);
            let world = World::new(cut, Hopper::new(limits).unwrap(), friction(mu), gravity);
            let Some(start) = PostHops::new(world.ground(), 1).unwrap().nearest_usable(Post { row: side / 2, col: side / 2 })
            else {
                continue;
            };
            let [by_slice, missed] = compare(&world, start);
            of_file = [of_file[0] + by_slice, of_file[1] + missed];
        }
        eprintln!("{file}: {} posts reached by slices, {} of them not by the map", of_file[0], of_file[1]);
        all = [all[0] + of_file[0], all[1] + of_file[1]];
        assert!(100 * of_file[1] <= of_file[0], "{file}: {of_file:?}");
    }
    assert!(all[0] > 200, "{all:?}");
}
