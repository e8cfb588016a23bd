//! Missions that drive and hop beside hops alone, under the same objective: a map of all nodes, a plan, and a front.
//!
//! `cargo bench --bench missions [-- DEM START_X START_Y GOAL_X GOAL_Y]`: over `data/drive/mars_rover.toml`, or its machine on another DEM. Compare
//! lines of one run with each other. All on one thread; least of five times.

#![allow(clippy::expect_used, reason = "a bench that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "its result")]

use std::{path::Path, time::Instant};

use chta::{
    ground::PostHops,
    planner::{
        Amount, Budgets, LabelCap, MissionQuestion, NodesPerPost, Objective, RouteGoal, RouteQuestion, SearchedCommands,
        SurfaceLattice, SurfaceNodes, Toward, Travel, free_route_by, front_of_missions, travel, travel_field,
    },
    quantity::MapPoint,
    reach::map::{MapObjective, least_totals},
    scenario::{Entries, Scenario},
    study::map::{MapQuestion, NamedPlace, PreparedMap},
    terrain::MapPlace,
};

/// The least of five times, s, and the last result.
fn timed<T>(mut work: impl FnMut() -> T) -> (f64, T) {
    let mut least_s = f64::INFINITY;
    let mut once = || {
        let began = Instant::now();
        let result = work();
        least_s = least_s.min(began.elapsed().as_secs_f64());
        result
    };
    let mut result = once();
    for _ in 0..4 {
        result = once();
    }
    (least_s, result)
}

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let source = std::fs::read_to_string(root.join("data/drive/mars_rover.toml")).expect("a shipped scenario");
    let scenario = Scenario::new(Entries::from_toml(&source)).expect("a sound scenario");
    let given: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let number = |place: usize, usual: f64| given.get(place).map_or(usual, |word| word.parse().expect("a number"));
    let dem = given.first().map_or_else(|| root.join("data/terrain/mars_crater_field.tif"), |file| file.into());
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
        trials: false,
        hops_max: None,
        amounts: Vec::new(),
        memory_max_bytes: None,
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
    println!("{} nodes, by {objective}; one thread, least of five times\n", prepared.lattice.count());
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

    // A front over many labels of each node, towards a nearer goal.
    let near = start + (goal - start) * 0.25;
    let nodes = SurfaceNodes::new(ground, lattice(), [start, near]).expect("not too many");
    let ends = RouteGoal { goal: near, ..ends };
    let by_time = Objective::of(Amount::MissionTime);
    let hops_max = Budgets::NONE.with(Amount::Hops, 8.0).expect("a budget");
    let mut question = asked(Travel::Both, &hops_max, SearchedCommands::Distinct);
    question.route.objective = &by_time;
    let front = || front_of_missions(ground, &nodes, &ends, (Amount::MissionTime, &question), &()).expect("not cancelled");
    let (time_s, front) = timed(front);
    let times: Vec<f64> = front.paths.iter().map(|path| path.totals.of(Amount::MissionTime)).collect();
    println!("| front of up to 8 hops, a quarter of the way | {time_s:.3} | {times:?} s |");
}
