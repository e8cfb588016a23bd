//! Maps and ways against a plain Dijkstra over plain legs.

use super::{any_rover, ugly_ground};
use crate::{
    draw::Draw,
    drive::{DriveAmount, DriveEdges, DriveError, DriveGround, DriveLeg, DriveMap, DriveSense, drive_path},
    ground::NodeLattice,
    progress::{Progress, Step},
    world::Neighbours,
};
use std::ops::ControlFlow;

fn amount_of(amount: DriveAmount, leg: &DriveLeg) -> f64 {
    match amount {
        DriveAmount::Time => leg.time_s,
        DriveAmount::Energy => leg.energy_j_kg,
        DriveAmount::Length => leg.length_m,
    }
}

/// Headings of the lattice's offsets, by another road than the map's.
fn heading_deg(edges: &DriveEdges<'_>, direction: usize) -> f64 {
    let (east, north) = edges.offsets()[direction];
    let map = edges.drive().ground().terrain().dem().georeference();
    libm::atan2(f64::from(north) * map.dy_m(), f64::from(east) * map.dx_m()).to_degrees()
}

fn turn_cost(edges: &DriveEdges<'_>, before: usize, after: usize) -> f64 {
    let apart = (heading_deg(edges, before) - heading_deg(edges, after)).abs();
    let rover = edges.drive().rover();
    let time_s = rover.limits().turn_s_per_deg * apart.min(360.0 - apart);
    match edges.amount() {
        DriveAmount::Time => time_s,
        DriveAmount::Energy => time_s * rover.idle_j_kg_s(),
        DriveAmount::Length => 0.0,
    }
}

/// The least costs from one node to all, from the plain legs: states of node and heading, of which the least is taken again and again.
fn brute(edges: &DriveEdges<'_>, start: usize) -> Vec<f64> {
    let (nodes, directions) = (edges.lattice().count(), edges.offsets().len());
    let mut arcs = vec![Vec::new(); nodes];
    for (node, arcs) in arcs.iter_mut().enumerate() {
        for direction in 0..directions {
            if let Some(Ok(leg)) = edges.leg(node, direction) {
                arcs.push((direction, edges.neighbour(node, direction), amount_of(edges.amount(), &leg)));
            }
        }
    }
    let mut labels = vec![f64::INFINITY; nodes * directions];
    labels[start * directions..(start + 1) * directions].fill(0.0);
    let mut done = vec![false; labels.len()];
    loop {
        let next = (0..labels.len()).filter(|state| !done[*state]).min_by(|a, b| labels[*a].total_cmp(&labels[*b]));
        let Some(state) = next.filter(|state| labels[*state].is_finite()) else { break };
        done[state] = true;
        let (node, heading) = (state / directions, state % directions);
        for (direction, to, cost) in &arcs[node] {
            let label = labels[state] + turn_cost(edges, heading, *direction) + cost;
            let to = to * directions + direction;
            labels[to] = labels[to].min(label);
        }
    }
    labels.chunks(directions).map(|states| states.iter().copied().fold(f64::INFINITY, f64::min)).collect()
}

/// What a way takes, from its plain legs and turns.
fn cost_of(edges: &DriveEdges<'_>, way: &[usize]) -> f64 {
    let mut before = None;
    let mut cost = 0.0;
    for pair in way.windows(2) {
        let is_it = |direction: &usize| edges.neighbour(pair[0], *direction) == pair[1] && edges.leg(pair[0], *direction).is_some();
        let direction = (0..edges.offsets().len()).find(is_it).unwrap();
        let leg = edges.leg(pair[0], direction).unwrap().unwrap();
        cost += amount_of(edges.amount(), &leg) + before.map_or(0.0, |before| turn_cost(edges, before, direction));
        before = Some(direction);
    }
    cost
}

fn close(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-9 * (a.abs() + b.abs()) + 1e-12
}

#[test]
fn maps_ways_and_a_star_are_those_of_brute_force() {
    let draw = &mut Draw::seeded(2212);
    let (mut reached, mut cut_off, mut turning) = (0, 0, 0);
    for round in 0..48 {
        let ground = ugly_ground(draw, 7, 8);
        let neighbours = Neighbours::ALL[round % 3];
        let rover = any_rover(draw, neighbours, &ground);
        let drive = DriveGround::new(&ground, &rover);
        let dem = ground.terrain().dem();
        let lattice = match round / 3 % 4 {
            0 => NodeLattice::finer(dem, 2),
            1 => NodeLattice::new(dem, 2),
            _ => NodeLattice::new(dem, 1),
        };
        for amount in DriveAmount::ALL {
            let edges = DriveEdges::new(&drive, lattice, amount, &()).unwrap();
            let start = draw.below(lattice.count());
            let plain = brute(&edges, start);
            let map = DriveMap::new(&edges, &[start], DriveSense::From, &()).unwrap();
            turning += u32::from(amount == DriveAmount::Time && rover.limits().turn_s_per_deg > 0.0);
            for (node, plain) in plain.iter().enumerate() {
                assert!(close(map.costs()[node], *plain), "{} {plain} {amount:?} {:?}", map.costs()[node], rover.limits());
                let Some(way) = map.way(node) else {
                    cut_off += 1;
                    continue;
                };
                reached += 1;
                assert!(way[0] == start && way.last() == Some(&node));
                assert!(close(cost_of(&edges, &way), *plain), "{way:?}");
            }
            assert_eq!(map.reached(), plain.iter().filter(|cost| cost.is_finite()).count());
            // A* to a few nodes, and the map against the legs.
            for _ in 0..4 {
                let goal = draw.below(lattice.count());
                let way = drive_path(&edges, start, goal, &()).unwrap();
                assert_eq!(way.as_ref().map(|way| way.cost), map.cost(goal), "A* sets the same label");
                assert!(way.is_none_or(|way| close(cost_of(&edges, &way.nodes), way.cost)));
                let back = DriveMap::new(&edges, &[goal], DriveSense::To, &()).unwrap();
                assert!(close(back.costs()[start], map.costs()[goal]), "{amount:?} {:?}", rover.limits());
                if let Some(way) = back.way(start) {
                    assert!(way[0] == start && way.last() == Some(&goal));
                    assert!(close(cost_of(&edges, &way), back.costs()[start]));
                }
            }
        }
    }
    assert!(reached > 2000 && cut_off > 500 && turning > 10, "{reached} reached, {cut_off} cut off, {turning} with turns");
}

/// The least over several starts is the least of their maps.
#[test]
fn several_ends_are_the_nearest_of_them() {
    let draw = &mut Draw::seeded(2213);
    for _ in 0..12 {
        let ground = ugly_ground(draw, 9, 9);
        let rover = any_rover(draw, Neighbours::Sixteen, &ground);
        let drive = DriveGround::new(&ground, &rover);
        let edges = DriveEdges::new(&drive, NodeLattice::new(ground.terrain().dem(), 1), DriveAmount::Time, &()).unwrap();
        let ends = [0, 1, 2].map(|_| draw.below(81));
        for sense in [DriveSense::From, DriveSense::To] {
            let all = DriveMap::new(&edges, &ends, sense, &()).unwrap();
            let each = ends.map(|end| DriveMap::new(&edges, &[end], sense, &()).unwrap());
            for node in 0..81 {
                let least = each.iter().map(|map| map.costs()[node]).fold(f64::INFINITY, f64::min);
                assert!(close(all.costs()[node], least));
            }
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_map() {
    let draw = &mut Draw::seeded(2214);
    for turn_s_per_deg in [0.0, 0.1] {
        let ground = ugly_ground(draw, 80, 70);
        let limits = crate::world::RoverLimits {
            turn_s_per_deg,
            ..crate::world::RoverLimits::new(0.1, crate::quantity::Angle::from_degrees(40.0))
        };
        let rover = crate::world::Rover::new(limits, None).unwrap();
        let drive = DriveGround::new(&ground, &rover);
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let lattice = NodeLattice::new(ground.terrain().dem(), 1);
                let edges = DriveEdges::new(&drive, lattice, DriveAmount::Time, &()).unwrap();
                let maps = [DriveSense::From, DriveSense::To].map(|sense| DriveMap::new(&edges, &[2000], sense, &()).unwrap());
                (edges.masks().to_vec(), edges.refusals(), maps)
            })
        };
        let one = with(1);
        assert!([3, 8, 1, 3].iter().all(|threads| with(*threads) == one));
    }
}

#[test]
fn a_map_can_be_cancelled() {
    struct Never;
    impl Progress for Never {
        fn report(&self, _: &Step) -> ControlFlow<()> {
            ControlFlow::Break(())
        }
    }
    let ground = ugly_ground(&mut Draw::seeded(2215), 20, 20);
    let rover = any_rover(&mut Draw::seeded(2216), Neighbours::Eight, &ground);
    let drive = DriveGround::new(&ground, &rover);
    let dem = ground.terrain().dem();
    for lattice in [NodeLattice::new(dem, 1), NodeLattice::new(dem, 2)] {
        assert!(matches!(DriveEdges::new(&drive, lattice, DriveAmount::Time, &Never), Err(DriveError::Cancelled(_))));
    }
}
