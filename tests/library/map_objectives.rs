//! Least totals over the nodes of a map, against Dijkstra's algorithm over all pairs by slice and hop test.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use std::{cmp::Ordering, path::Path};

use chta::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    planner::{Amount, Amounts, Objective, SearchedCommands},
    reach::map::{
        HopMap, MapObjective, NO_GROUND, NOT_SEARCHED, NodeLattice, Post, PostHops, UNREACHED, least_totals, totals_along,
    },
    terrain::read_dem,
    world::{Hopper, HopperLimits},
};

use crate::{
    map_equality::cut_out,
    map_nodes::{by_slice, nodes},
    map_world::{World, friction, random_dem, random_hopper, random_surface},
    support::Draw,
};

/// The hops out of every node: where each leads, and what its commands take: first of the mission, and later.
type Edges = Vec<Vec<(usize, Vec<[Amounts; 2]>)>>;

fn edges(world: &World, lattice: NodeLattice, choices: &[TakeoffChoice]) -> Edges {
    let ground = world.ground();
    let (envelope, limits) = (*ground.envelope(), *world.hopper.limits());
    let place = |node: Post| lattice.position(&world.dem, node);
    let of_node = |from: Post| {
        let mut out = Vec::new();
        for to in nodes(lattice).into_iter().filter(|to| *to != from) {
            let (Some(begin), Some(end)) = (place(from), place(to)) else { continue };
            let Some(lofts) = by_slice(world, begin.at, end.at) else { continue };
            let sight = LineOfSight::new((end.at - begin.at).norm(), end.z_m - begin.z_m);
            let takes = |choice: &TakeoffChoice| {
                let arc = Arc::new(sight, envelope.loft(*choice, sight, lofts), world.gravity_m_s2);
                [true, false].map(|is_first| Amounts::of_arc(&arc, &limits, is_first))
            };
            out.push((lattice.index(to), choices.iter().map(takes).collect()));
        }
        out
    };
    nodes(lattice).into_iter().map(of_node).collect()
}

/// The least totals from a node, by the plainest form of Dijkstra's algorithm.
fn plainly(edges: &Edges, start: usize, amounts: &[Amount]) -> Vec<Vec<f64>> {
    let order = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal);
    let mut totals = vec![vec![f64::INFINITY; amounts.len()]; edges.len()];
    totals[start] = vec![0.0; amounts.len()];
    let mut open: Vec<usize> = (0..edges.len()).collect();
    while let Some(place) = (0..open.len()).min_by(|&a, &b| order(&totals[open[a]], &totals[open[b]])) {
        let node = open.swap_remove(place);
        if totals[node][0].is_infinite() {
            break;
        }
        for (to, commands) in &edges[node] {
            for command in commands {
                let takes = command[usize::from(node != start)];
                let sum: Vec<f64> =
                    amounts.iter().zip(&totals[node]).map(|(amount, own)| amount.join(*own, takes.of(*amount))).collect();
                if order(&sum, &totals[*to]) == Ordering::Less {
                    totals[*to] = sum;
                }
            }
        }
    }
    totals
}

fn near(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-7 * (1.0 + a.abs().max(b.abs()))
}

/// The totals of a path node by node, from its own hops.
fn resummed(hops: &PostHops, map: &HopMap, node: Post) -> usize {
    map.path(hops, node).unwrap().len() - 1
}

/// Compares a map with the plain totals, without and with budgets; returns how many nodes were reached and not reached.
fn compare(world: &World, per_post: usize, start: Post, draw: &mut Draw, what: &str) -> [usize; 2] {
    use Amount::{ArcLength, DeltaV, Distance, Energy, FlightTime, Hops, MissionTime, PeakSpeed, TakeoffSpeed};
    let lattice = NodeLattice::finer(&world.dem, per_post);
    let hops = PostHops::over(world.ground(), lattice).unwrap();
    let start = Post { row: start.row * per_post, col: start.col * per_post };
    let distinct = [TakeoffChoice::LeastSpeed, TakeoffChoice::MidRange, TakeoffChoice::LeastTime];
    let chosen = distinct[draw.below(3)];
    let (by_all, by_one) = (edges(world, lattice, &distinct), edges(world, lattice, &[chosen]));
    let mut counts = [0; 2];
    for amounts in [
        &[Energy][..],
        &[Energy, Hops],
        &[DeltaV],
        &[FlightTime],
        &[MissionTime, Energy],
        &[Distance, TakeoffSpeed],
        &[ArcLength],
        &[TakeoffSpeed, Hops],
        &[Hops],
        &[Hops, Energy],
        &[Hops, FlightTime, Energy],
        &[Hops, PeakSpeed],
    ] {
        let objective = Objective::new(amounts.to_vec()).unwrap();
        for commands in [SearchedCommands::Distinct, SearchedCommands::Chosen] {
            // Without an amount that depends on the command, the chosen one is flown.
            let offers_all = commands == SearchedCommands::Distinct && amounts.iter().any(|amount| !amount.is_of_places());
            let expected = plainly(if offers_all { &by_all } else { &by_one }, lattice.index(start), amounts);
            let asked = MapObjective::new(&hops, &objective, commands, chosen);
            let whole = least_totals(&hops, &[start], &asked, f64::INFINITY, &()).unwrap();
            let found = whole.of(0);
            for (node, expected) in expected.iter().enumerate() {
                let is_reached = expected[0].is_finite();
                let post = lattice.node(node);
                let about = || format!("{what}, {objective}, {commands:?}, {post:?}: {} against {expected:?}", found[node]);
                assert_eq!(is_reached, whole.paths.hops[node] >= 0, "{}", about());
                counts[usize::from(!is_reached)] += 1;
                if !is_reached {
                    assert!(found[node].is_nan() && [UNREACHED, NO_GROUND].contains(&whole.paths.hops[node]));
                    continue;
                }
                assert!(near(found[node], expected[0]), "{}", about());
                // Of sums that round, equal first totals are rare; hops are counted exactly.
                if amounts[0] == Hops {
                    for (place, expected) in expected.iter().enumerate() {
                        assert!(near(whole.of(place)[node], *expected), "{}", about());
                    }
                }
                assert_eq!(usize::try_from(whole.paths.hops[node]).unwrap(), resummed(&hops, &whole.paths, post));
            }
            // Each amount of the objective is that along the path found.
            for (place, amount) in amounts.iter().enumerate() {
                let along = totals_along(&hops, &whole.paths, *amount, &asked).unwrap();
                assert!(
                    along.iter().zip(whole.of(place)).all(|(a, b)| near(*a, b) || (a.is_nan() && b.is_nan())),
                    "{what}: {amount}"
                );
            }
            // Within a budget: exactly the nodes whose least total it allows, and never fewer with a looser one.
            let mut known: Vec<f64> = found.iter().copied().filter(|total| total.is_finite()).collect();
            known.sort_by(f64::total_cmp);
            let mut before = 0;
            for share in [0.0, 0.3, 0.7, 1.0] {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    clippy::cast_precision_loss,
                    reason = "an index"
                )]
                let most = known[((known.len() - 1) as f64 * share) as usize] * (1.0 + 1e-9);
                let within = least_totals(&hops, &[start], &asked, most, &()).unwrap();
                for (node, &total) in found.iter().enumerate() {
                    let expected = total <= most;
                    assert_eq!(within.paths.hops[node] >= 0, expected, "{what}, {objective} within {most}: {total}");
                    if expected {
                        assert_eq!(within.of(0)[node].to_bits(), total.to_bits());
                    } else if total.is_finite() {
                        assert_eq!(within.paths.hops[node], NOT_SEARCHED, "{what}, {objective}");
                    }
                }
                let reached = within.paths.hops.iter().filter(|hops| **hops >= 0).count();
                assert!(reached >= before, "{what}, {objective}");
                before = reached;
            }
        }
    }
    counts
}

#[test]
fn least_totals_of_random_grids_are_those_over_all_pairs() {
    let mut draw = Draw::seeded(1731);
    let mut counts = [0; 2];
    for number in 0..18 {
        let per_post = 1 + number % 3;
        let dem = random_dem(&mut draw, [9, 5, 5][per_post - 1]);
        let (hopper, gravity) = random_hopper(&mut draw);
        let limits = HopperLimits {
            mass_kg: Some(2.0),
            preparation_energy_j: draw.chance(0.3).then(|| draw.uniform(0.0, 3.0)),
            preparation_time_s: draw.chance(0.5).then(|| draw.uniform(0.0, 9.0)),
            settling_time_s: draw.chance(0.5).then(|| draw.uniform(0.0, 9.0)),
            hop_delta_v_overhead_m_s: draw.chance(0.5).then(|| draw.uniform(0.0, 0.5)),
            ..*hopper.limits()
        };
        let world = World::new(dem, Hopper::new(limits).unwrap(), random_surface(&mut draw), gravity);
        let start = Post { row: draw.below(5), col: draw.below(5) };
        if world.dem.elevation(start.row, start.col).is_none() {
            continue;
        }
        let found = compare(&world, per_post, start, &mut draw, &format!("grid {number}, {per_post} nodes a post"));
        counts = [counts[0] + found[0], counts[1] + found[1]];
    }
    assert!(counts[0] > 3_000 && counts[1] > 3_000, "{counts:?} nodes reached and not");
}

/// Cut-outs of both real DEMs, with one to three nodes a post.
#[test]
fn least_totals_of_real_ground_are_those_over_all_pairs() {
    let mut counts = [0; 2];
    for (file, speed_m_s, mu, gravity) in [
        ("hirise_DTEEC_010228_1490_crop_120x70.tif", 3.0, 0.7, 3.711),
        ("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", 4.5, 0.4, 1.62),
    ] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
        if !path.exists() {
            eprintln!("skipped: {} is absent", path.display());
            return;
        }
        let dem = read_dem(&path).unwrap();
        let mut draw = Draw::seeded(1732);
        for (per_post, side) in [(1, 16), (2, 8), (3, 6)] {
            let first = Post { row: draw.below(dem.rows() - side), col: draw.below(dem.cols() - side) };
            let limits = HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(speed_m_s, 1.1 * speed_m_s) };
            let cut = cut_out(&dem, first, side, 1, &mut draw);
            let world = World::new(cut, Hopper::new(limits).unwrap(), friction(mu), gravity);
            let ground = PostHops::new(world.ground(), 1).unwrap();
            let Some(start) = ground.nearest_usable(Post { row: side / 2, col: side / 2 }) else { continue };
            let found = compare(&world, per_post, start, &mut draw, &format!("{file}, {per_post} nodes a post"));
            counts = [counts[0] + found[0], counts[1] + found[1]];
        }
    }
    assert!(counts[0] > 2_000 && counts[1] > 500, "{counts:?} nodes reached and not");
}

/// Several sources: each node has the least over them, and the lower number of equals.
#[test]
fn several_sources_share_the_map_by_least_totals() {
    let mut draw = Draw::seeded(1733);
    let (mut shared, mut seconds) = (0, 0);
    for _ in 0..12 {
        let dem = random_dem(&mut draw, 12);
        let (hopper, gravity) = random_hopper(&mut draw);
        let world = World::new(dem, hopper, random_surface(&mut draw), gravity);
        let hops = PostHops::new(world.ground(), 1).unwrap();
        let sources = [Post { row: 2, col: 2 }, Post { row: 9, col: 8 }];
        if sources.iter().any(|post| world.dem.elevation(post.row, post.col).is_none()) {
            continue;
        }
        let asked = MapObjective::new(&hops, &Objective::of(Amount::Energy), SearchedCommands::Distinct, TakeoffChoice::LeastSpeed);
        let map = |sources: &[Post]| least_totals(&hops, sources, &asked, f64::INFINITY, &()).unwrap();
        let (both, each) = (map(&sources), sources.map(|source| map(&[source])));
        for index in 0..hops.lattice().count() {
            let [first, second] = [each[0].of(0)[index], each[1].of(0)[index]];
            let expected = first.min(second);
            assert!(both.of(0)[index] == expected || (expected.is_nan() && both.of(0)[index].is_nan()));
            if expected.is_nan() {
                continue;
            }
            let source = both.paths.source(hops.lattice(), hops.lattice().node(index));
            assert_eq!(source, Some(usize::from(first.is_nan() || second < first)), "{first} {second}");
            shared += 1;
            seconds += u32::from(source == Some(1));
        }
    }
    assert!(shared > 200 && seconds > 60, "{shared} nodes, {seconds} from the second source");
}
