//! Maps of several sources against maps of one, and labels against a direct search over all pairs.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]
#![allow(clippy::cast_precision_loss, reason = "rows and columns of small grids")]

use chta::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    graph::Effort,
    quantity::MapPoint,
    reach::map::{HopMap, Journey, MapError, NO_GROUND, NOT_SEARCHED, Post, PostHops, Search, Source, UNREACHED, search},
    terrain::{Dem, GeoReference},
    world::{Hopper, HopperLimits},
};

use crate::{
    map_world::{World, friction, random_dem},
    support::Draw,
};

const GRAVITY_M_S2: f64 = 1.62;

/// Rough ground with gaps, and some of its posts that have an elevation.
fn world(draw: &mut Draw, side: usize, sources: usize) -> (World, Vec<Post>) {
    let dem = random_dem(draw, side);
    let speed_m_s = draw.uniform(1.8, 2.6);
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.05, ..HopperLimits::with_speeds(speed_m_s, speed_m_s) }).unwrap();
    let world = World::new(dem, hopper, friction(0.8), GRAVITY_M_S2);
    let mut posts = Vec::new();
    while posts.len() < sources {
        let post = Post { row: draw.below(side), col: draw.below(side) };
        if world.dem.elevation(post.row, post.col).is_some() && !posts.contains(&post) {
            posts.push(post);
        }
    }
    (world, posts)
}

/// Each node has a chain of predecessors, each one feasible hop away, of as many hops as its count says, to its source.
fn check_predecessors(hops: &PostHops, map: &HopMap, sources: &[Post], journey: Journey) -> usize {
    const ABSENT: i32 = i32::MIN;
    let lattice = hops.lattice();
    let previous = map.predecessors(hops, ABSENT);
    let mut steps = 0;
    for index in 0..lattice.count() {
        let node = lattice.node(index);
        if map.hops[index] < 0 {
            assert_eq!((previous[index], map.source(lattice, node)), (ABSENT, None));
            continue;
        }
        let source = sources[map.source(lattice, node).unwrap()];
        let (mut at, mut count) = (index, 0);
        while previous[at] != -1 {
            let before = usize::try_from(previous[at]).unwrap();
            let (from, to) = match journey {
                Journey::Outbound => (before, at),
                Journey::Return => (at, before),
            };
            let (from, to) = (lattice.node(from), lattice.node(to));
            let is_hop = (0..hops.offset_count())
                .any(|offset| hops.landing(from, offset) == Some(to) && hops.lofts(from, offset).unwrap().is_some());
            assert!(is_hop, "no hop leads from {from:?} to {to:?}");
            (at, count) = (before, count + 1);
        }
        assert_eq!((lattice.node(at), count), (source, map.hops[index]), "the chain of {node:?}");
        steps += usize::try_from(count).unwrap();
    }
    steps
}

#[test]
fn a_map_from_three_starts_is_the_least_of_three_maps_and_its_nearest_start_the_first_of_the_least() {
    let mut draw = Draw::seeded(1501);
    let (mut nearest, mut steps) = ([0; 3], 0);
    let efforts = Effort::ALL.map(|effort| Some((effort, TakeoffChoice::LeastSpeed)));
    for effort in std::iter::once(None).chain(efforts) {
        for journey in [Journey::Outbound, Journey::Return] {
            let (world, starts) = world(&mut draw, 22, 3);
            let hops = PostHops::new(world.ground(), 1).unwrap();
            let asked = Search { journey, effort, hops_max: None };
            let map_of = |starts: &[Post]| {
                let sources: Vec<Source> = starts.iter().map(|&start| start.into()).collect();
                search(&hops, &sources, asked, &()).unwrap()
            };
            let together = map_of(&starts);
            let alone: Vec<HopMap> = starts.iter().map(|&start| map_of(&[start])).collect();
            for index in 0..together.hops.len() {
                let label = |map: &HopMap| (map.hops[index], map.effort.get(index).copied().unwrap_or(0.0));
                let reached = || alone.iter().map(label).filter(|label| label.0 >= 0);
                let Some(least) = reached().reduce(|a, b| if (b.0, b.1) < (a.0, a.1) { b } else { a }) else {
                    assert_eq!(together.hops[index], alone[0].hops[index], "unreached and no-data posts keep their marks");
                    continue;
                };
                assert_eq!(label(&together), least, "post {index}, {effort:?}, {journey:?}");
                let number = together.source(hops.lattice(), hops.lattice().node(index)).unwrap();
                assert_eq!(label(&alone[number]), least, "post {index}: its start is one of the least");
                // Of a peak speed, paths of different starts are equal from their fastest hop on, wherever they met before.
                if effort.is_none_or(|(effort, _)| effort != Effort::PeakSpeed) {
                    assert_eq!(alone.iter().position(|map| label(map) == least), Some(number), "post {index}, {effort:?}");
                }
                nearest[number] += 1;
            }
            steps += check_predecessors(&hops, &together, &starts, journey);
            let threads = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
            let threaded = threads.install(|| map_of(&starts));
            let numbers = |map: &HopMap| (map.hops.clone(), map.predecessors(&hops, i32::MIN));
            assert_eq!(numbers(&threaded), numbers(&together), "the answer depends on the threads");
        }
    }
    assert!(nearest.iter().all(|&posts| posts > 300) && steps > 5_000, "{nearest:?} posts, {steps} steps");
}

/// The label of every post by a direct search: relaxes all pairs of posts until no label changes.
fn plain_labels(world: &World, sources: &[Source], (effort, choice): (Effort, TakeoffChoice)) -> Vec<Option<(i16, f64)>> {
    let posts = world.posts(1);
    let index = |post: Post| posts.iter().position(|&other| other == post).unwrap();
    let height = |post: Post| world.dem.elevation(post.row, post.col).unwrap();
    let mut edges = Vec::new();
    for (from, &a) in posts.iter().enumerate() {
        for (to, &b) in posts.iter().enumerate() {
            let Some(lofts) = (a != b).then(|| world.lofts(a, b)).flatten() else { continue };
            let run_m = (a.row as f64 - b.row as f64).hypot(a.col as f64 - b.col as f64);
            let sight = LineOfSight::new(run_m, height(b) - height(a));
            let arc = Arc::new(sight, choice.loft(sight, lofts), GRAVITY_M_S2);
            edges.push((
                from,
                to,
                match effort {
                    Effort::Time => arc.flight_time_s(),
                    _ => arc.takeoff_speed_m_s(),
                },
            ));
        }
    }
    let mut labels: Vec<Option<(i16, f64)>> = vec![None; posts.len()];
    let improves = |new: (i16, f64), old: Option<(i16, f64)>| old.is_none_or(|old| new < old);
    for source in sources {
        let new = (source.hops, source.effort);
        if improves(new, labels[index(source.node)]) {
            labels[index(source.node)] = Some(new);
        }
    }
    let mut changed = true;
    while changed {
        changed = false;
        for &(from, to, cost) in &edges {
            let Some((hops, spent)) = labels[from] else { continue };
            let new = (hops + 1, if effort == Effort::PeakSpeed { spent.max(cost) } else { spent + cost });
            if improves(new, labels[to]) {
                (labels[to], changed) = (Some(new), true);
            }
        }
    }
    labels
}

#[test]
fn initial_labels_give_the_labels_of_a_direct_search() {
    let mut draw = Draw::seeded(1502);
    let (mut late, mut compared) = (0, 0);
    for effort in [Effort::Time, Effort::PeakSpeed, Effort::TakeoffSpeed, Effort::Time] {
        let (world, posts) = world(&mut draw, 9, 4);
        let sources: Vec<Source> = posts
            .iter()
            .map(|&node| Source { node, hops: i16::try_from(draw.below(4)).unwrap(), effort: draw.uniform(0.0, 5.0) })
            .collect();
        let asked = (effort, TakeoffChoice::LeastSpeed);
        let hops = PostHops::new(world.ground(), 1).unwrap();
        let map = search(&hops, &sources, Search { effort: Some(asked), ..Search::default() }, &()).unwrap();
        for (index, expected) in plain_labels(&world, &sources, asked).into_iter().enumerate() {
            let found = (map.hops[index] >= 0).then(|| (map.hops[index], map.effort[index]));
            assert_eq!(found.map(|label| label.0), expected.map(|label| label.0), "post {index}, {effort:?}");
            let (Some((hops, found)), Some((_, expected))) = (found, expected) else { continue };
            assert!((found - expected).abs() <= 1e-9 * (1.0 + expected), "post {index} after {hops} hops: {found} for {expected}");
            compared += 1;
        }
        late +=
            sources.iter().filter(|source| map.hops[hops.lattice().index(source.node)] == source.hops && source.hops > 0).count();
    }
    assert!(compared > 150 && late > 3, "{compared} labels, {late} sources with hops spent that count");
}

#[test]
fn a_bounded_search_equals_the_whole_one_up_to_its_bound_and_says_what_it_left_open() {
    let mut draw = Draw::seeded(1503);
    let mut left = 0;
    for _ in 0..4 {
        let (world, posts) = world(&mut draw, 20, 2);
        let hops = PostHops::new(world.ground(), 1).unwrap();
        let sources = [posts[0].into(), Source { node: posts[1], hops: 2, effort: 0.0 }];
        let map = |hops_max| search(&hops, &sources, Search { hops_max, ..Search::default() }, &()).unwrap();
        let whole = map(None);
        let farthest = whole.hops.iter().copied().max().unwrap();
        for most in 0..=farthest + 1 {
            let bounded = map(Some(most));
            for (index, (&found, &known)) in bounded.hops.iter().zip(&whole.hops).enumerate() {
                match known {
                    NO_GROUND => assert_eq!(found, NO_GROUND),
                    UNREACHED => assert!([UNREACHED, NOT_SEARCHED].contains(&found), "post {index} is not reached"),
                    known if known <= most => assert_eq!(found, known, "post {index}, at most {most} hops"),
                    _ => assert_eq!(found, NOT_SEARCHED, "post {index} may be reached beyond {most} hops"),
                }
                assert_eq!(bounded.searched(index), found != NOT_SEARCHED);
            }
            left += bounded.hops.iter().filter(|&&hops| hops == NOT_SEARCHED).count();
            if most > farthest {
                assert_eq!(bounded.hops, whole.hops, "a bound beyond the farthest post changes nothing");
            }
        }
    }
    assert!(left > 500, "{left} posts left open");
}

#[test]
fn labels_that_are_no_counts_or_efforts_are_refused() {
    let map = GeoReference::local(MapPoint::new(0.0, 0.0), 1.0, 1.0).unwrap();
    let dem = Dem::new(8, 8, vec![0.0; 64], map).unwrap();
    let world = World::new(dem, Hopper::with_speeds(2.0, 2.0).unwrap(), friction(0.8), GRAVITY_M_S2);
    let hops = PostHops::new(world.ground(), 1).unwrap();
    let node = Post { row: 1, col: 1 };
    let asked = Search { effort: Some((Effort::Time, TakeoffChoice::LeastSpeed)), ..Search::default() };
    for (source, named) in [
        (Source { hops: -1, ..node.into() }, "hop count"),
        (Source { effort: f64::NAN, ..node.into() }, "effort"),
        (Source { effort: f64::INFINITY, ..node.into() }, "effort"),
        (Source { effort: -0.5, ..node.into() }, "effort"),
    ] {
        let error = search(&hops, &[node.into(), source], asked, &()).unwrap_err();
        assert!(matches!(&error, MapError::Request { what, .. } if what.contains(named)), "{source:?}: {error}");
    }
    assert!(search(&hops, &[Source { effort: f64::NAN, ..node.into() }], Search::default(), &()).is_ok());
    let none = search(&hops, &[], asked, &()).unwrap();
    assert!(none.hops.iter().all(|&hops| hops == UNREACHED));
    // Of two sources on one post, the one that has spent less counts, then the first.
    let label = |hops| Source { hops, ..node.into() };
    for (sources, nearest) in [([label(1), label(0)], 1), ([label(0), label(0)], 0), ([label(0), label(1)], 0)] {
        assert_eq!(search(&hops, &sources, asked, &()).unwrap().source(hops.lattice(), node), Some(nearest));
    }
}
