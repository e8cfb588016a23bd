//! Missions that drive and hop beside hops alone, under the same objective: a map of all nodes, and a plan.
//!
//! `cargo bench --bench missions [-- DEM START_X START_Y GOAL_X GOAL_Y]`: over `data/drive/mars_rover.toml`, or its machine on another DEM. Compare
//! lines of one run with each other. All on one thread; processor time, which other work on the machine changes little, the mean of five runs.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "its result")]

use std::{path::Path, time::Instant};

use chta::{
    ground::PostHops,
    planner::{
        Amount, Budgets, LabelCap, MissionQuestion, NodesPerPost, RouteGoal, RouteQuestion, SurfaceLattice, SurfaceNodes, Toward,
        Travel, free_route_by, travel, travel_field,
    },
    quantity::MapPoint,
    reach::map::{MapObjective, least_totals},
    scenario::{Entries, Scenario},
    study::map::{MapQuestion, NamedPlace, PreparedMap},
    terrain::MapPlace,
};

/// The processor time of this process so far, s: of all its threads, in hundredths of a second (Linux); elsewhere the time that has gone by.
fn spent_s(began: Instant) -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name of the program, in brackets, may have spaces.
    let after = stat.rsplit(')').next().unwrap_or_default();
    let ticks: Vec<f64> = after.split_whitespace().skip(11).take(2).filter_map(|ticks| ticks.parse().ok()).collect();
    if ticks.len() == 2 { (ticks[0] + ticks[1]) / 100.0 } else { began.elapsed().as_secs_f64() }
}

/// The mean time of five runs, s, and the last result.
fn timed<T>(work: impl Fn() -> T) -> (f64, T) {
    let began = Instant::now();
    let before_s = spent_s(began);
    (0..4).for_each(|_| drop(work()));
    let result = work();
    ((spent_s(began) - before_s) / 5.0, result)
}

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let source = std::fs::read_to_string(root.join("data/drive/mars_rover.toml")).expect("a shipped scenario");
    let scenario = Scenario::new(Entries::from_toml(&source)).expect("a sound scenario");
    let given: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let number = |place: usize, usual: f64| given.get(place).map_or(usual, |word| word.parse().expect("a number"));
    let dem = given.first().map_or_else(|| root.join("data/terrain/mars_crater_field.tif"), Into::into);
    let start = MapPoint::new(number(1, 30.0), number(2, 30.0));
    let goal = MapPoint::new(number(3, 180.0), number(4, 180.0));
    let question = MapQuestion {
        scenario: &scenario,
        base: root,
        dem: &dem,
        starts: vec![NamedPlace { name: "start".to_owned(), place: MapPlace::Metres(start) }],
        goals: Vec::new(),
        stride: 1,
        auto_nodes: false,
        effort: false,
        returns: false,
        mobility: false,
        predecessors: false,
        refusals: false,
        trials: false,
        hops_max: None,
        amounts: Vec::new(),
        memory_max_bytes: None,
        ranks_sites: false,
    };
    let prepared = PreparedMap::new(&question).expect("a terrain");
    let rover = &scenario.drive.as_ref().expect("wheels").rover;
    let ground = &prepared.planning;
    let lattice = || SurfaceLattice::new(ground.terrain().dem(), NodesPerPost::of(prepared.lattice.per_post));
    let objective = scenario.full_objective();
    let asked = |travel, budgets, commands| MissionQuestion {
        route: RouteQuestion { objective: &objective, budgets, commands, errors: None, cap: LabelCap::default() },
        rover,
        travel,
        kept_bytes_max: MissionQuestion::KEPT_BYTES,
    };
    println!("{} nodes, by {objective}; one thread, processor time, mean of five runs\n", prepared.lattice.count());
    println!("| | s | |\n|---|---|---|");

    let nodes = SurfaceNodes::new(ground, lattice(), []).expect("not too many");
    let begin = prepared.starts[0].post;
    let node = nodes.lattice_node((begin.col, begin.row));
    let takeoff = scenario.search.takeoff;
    for means in Travel::ALL {
        let question = asked(means, &Budgets::NONE, scenario.commands);
        let field = || travel_field((ground, &nodes), &[node], (&question, takeoff, Toward::Nodes), &()).expect("not cancelled");
        let (time_s, field) = timed(field);
        let all = (0..prepared.lattice.count()).map(|index| {
            let post = prepared.lattice.node(index);
            nodes.lattice_node((post.col, post.row))
        });
        let reached = all.filter(|node| field.is_reached(*node)).count();
        println!("| map by {means} | {time_s:.3} | {reached} nodes |");
    }
    let (time_s, map) = timed(|| {
        let hops = PostHops::over(ground.clone(), prepared.lattice).expect("tables");
        let objective = MapObjective::new(&hops, &objective, scenario.commands, takeoff);
        least_totals(&hops, &[begin], &objective, f64::INFINITY, &()).expect("not cancelled")
    });
    let reached = map.paths.hops.iter().filter(|hops| **hops >= 0).count();
    println!("| map of hops alone (chta map) | {time_s:.3} | {reached} nodes |");

    let nodes = SurfaceNodes::new(ground, lattice(), [start, goal]).expect("not too many");
    let ends = RouteGoal { start, goal, effort: scenario.search.effort, takeoff };
    let question = asked(Travel::Both, &Budgets::NONE, scenario.commands);
    let (time_s, mission) = timed(|| travel(ground, &nodes, &ends, &question, &()).expect("not cancelled"));
    let time = |totals: f64| format!("{totals} s");
    let least = mission.path.as_ref().map_or("no path".to_owned(), |path| time(path.totals.of(Amount::MissionTime)));
    let work = mission.work;
    println!(
        "| plan by both | {time_s:.3} | {least}, {} hops and {} drive legs tested, {} settled |",
        work.hops_tested, work.drives_tested, work.settled
    );
    let (time_s, route) = timed(|| free_route_by(ground, &nodes, &ends, &question.route, &()).expect("not cancelled"));
    let least = route.path.as_ref().map_or("no path".to_owned(), |path| time(path.totals.of(Amount::MissionTime)));
    println!("| plan of hops alone (free route) | {time_s:.3} | {least}, {} hops tested |", route.work.pairs_tested);
}
