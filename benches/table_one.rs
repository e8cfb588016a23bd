//! Table I of Campana and Laumond 2016, their other two scenes, and how often both tests of a hop join start and goal.
//!
//! `cargo bench --bench table_one --profile release [-- SEEDS]`. It prints the tables of `docs/validation.md`. The meshes are read from a folder
//! beside the repository (`tests/library` names it); without it the slot alone is measured. One thread; times are wall-clock times of the
//! growth and the search, with contacts drawn, without reading the mesh.

#![allow(clippy::expect_used, reason = "a table that cannot set its scene should stop")]
#![allow(clippy::print_stdout, reason = "it prints tables")]
#![allow(clippy::cast_precision_loss, reason = "counts far below 2^53")]

use std::{path::Path, time::Instant};

use chta::{
    ballistics::TakeoffChoice,
    ground::{MeshContact, MeshGround},
    planner::{
        Amount, Budgets, LabelCap, Objective, SearchedCommands,
        roadmap::{ContactSampler, JoinTest, OneByOne, PROBE_STAND_OFF_M, RoadmapQuestion, SpaceBounds, grow_one_by_one},
    },
    terrain::{Mesh, MeshTree, read_mesh},
    world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};
use nalgebra::Point3;

/// Seeds of every problem: as many runs as the paper's.
const SEEDS: u64 = 40;

/// A problem stops with so many contacts.
const CONTACTS_MAX: usize = 40_000;

/// A scene: its file, its bounds, its ends.
struct Scene {
    file: &'static str,
    bounds: [[f64; 3]; 2],
    /// The greatest height of a flight, m.
    height_max_m: Option<f64>,
    ends: [[f64; 3]; 2],
}

const JUMP: Scene = Scene {
    file: "scene_jump10.stl",
    bounds: [[-6.0, -2.5, 0.0], [6.8, 3.2, 8.0]],
    height_max_m: Some(8.0),
    ends: [[6.2, 0.5, 0.5], [-4.4, -1.5, 6.5]],
};
const CAVE: Scene = Scene {
    file: "cave_mono_short_1.stl",
    bounds: [[-2.6, -3.0, -2.5], [2.6, 4.2, 4.0]],
    height_max_m: Some(4.0),
    ends: [[-0.3, 3.65, -0.25], [-0.18, -2.2, -0.4]],
};
const WINDOWS: Scene = Scene {
    file: "envir3d_1.stl",
    bounds: [[-5.0, -5.0, -1.0], [5.0, 5.0, 7.0]],
    height_max_m: Some(7.0),
    ends: [[-3.8, 2.4, 1.2], [3.5, -3.3, 0.4]],
};

/// A problem: its scene, friction, greatest speed, and what Table I states of it, or the authors' script of one run.
struct Problem {
    scene: &'static Scene,
    friction: f64,
    speed_m_s: f64,
    paper: &'static str,
}

const PROBLEMS: [Problem; 8] = [
    Problem { scene: &JUMP, friction: 0.5, speed_m_s: 6.5, paper: "9890 | 1995 | | 3270 | | | | 39.9" },
    Problem { scene: &JUMP, friction: 0.5, speed_m_s: 7.0, paper: "9990 | 1835 | | 4002 | | | | 37.4" },
    Problem { scene: &JUMP, friction: 1.2, speed_m_s: 6.5, paper: "1040 | 282 | | 601 | | | | 28.1" },
    Problem { scene: &JUMP, friction: 1.2, speed_m_s: 7.0, paper: "909 | 237 | | 540 | | | | 27.0" },
    Problem { scene: &CAVE, friction: 1.2, speed_m_s: 4.5, paper: "312 | 388 | | | | | |" },
    Problem { scene: &CAVE, friction: 0.5, speed_m_s: 4.5, paper: "969 | | | | | | |" },
    Problem { scene: &WINDOWS, friction: 1.2, speed_m_s: 6.8, paper: "85 | | | | | | |" },
    Problem { scene: &WINDOWS, friction: 0.5, speed_m_s: 5.3, paper: "738 | 340 | | | | | |" },
];

/// The pads and the slot of `docs/validation.md`: none of the sampled angles of any pair passes.
const SLOT: Scene = Scene {
    file: "",
    bounds: [[-0.1, -0.1, -0.1], [2.1, 0.1, 0.1]],
    height_max_m: None,
    ends: [[0.0, 0.01, 0.0], [2.0, 0.01, 0.0]],
};

/// A run over the pads stops with so many contacts: every arc of every pair is tried in vain.
const SLOT_CONTACTS: usize = 100;

/// The numbers of contacts within which both tests are compared.
const WITHIN: [usize; 8] = [50, 100, 200, 400, 800, 1600, 3200, 6400];

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/mesh"))
}

/// The ground of a mesh with one friction and one greatest speed.
fn ground(mesh: Mesh, friction: f64, speed_m_s: f64) -> MeshGround {
    let hopper = Hopper::with_speeds(speed_m_s, speed_m_s).expect("a hopper");
    let grip = Some(Grip::Friction(FrictionCone::new(friction).expect("a friction")));
    let surface = SurfaceProperties { grip, rest: RestSlope::Unlimited };
    MeshGround::new(MeshTree::new(mesh), &hopper, Gravity::new(9.81).expect("a gravity"), &surface).expect("a ground")
}

/// Two pads, and between them a wall with a slot.
fn slot() -> MeshGround {
    let pad = |x: f64| [[x - 0.05, -0.05, 0.0], [x + 0.05, -0.05, 0.0], [x + 0.05, 0.05, 0.0], [x - 0.05, 0.05, 0.0]];
    let wall = |low: f64, high: f64| [[1.0, -9.0, low], [1.0, 9.0, low], [1.0, 9.0, high], [1.0, -9.0, high]];
    let quads = [pad(0.0), pad(2.0), wall(-9.0, 1.21), wall(1.48, 9.0)];
    let vertices = quads.iter().flatten().map(|corner| Point3::from(*corner)).collect();
    let triangles = (0..4).flat_map(|quad| [[4 * quad, 4 * quad + 1, 4 * quad + 2], [4 * quad, 4 * quad + 2, 4 * quad + 3]]);
    ground(Mesh::new(vertices, triangles.collect()).expect("a mesh"), 1.2, 6.5)
}

/// The mean of a number over runs, and its standard error.
#[derive(Default)]
struct Mean {
    count: f64,
    sum: f64,
    sum_of_squares: f64,
}

impl Mean {
    fn add(&mut self, number: f64) {
        self.count += 1.0;
        self.sum += number;
        self.sum_of_squares += number * number;
    }

    fn error(&self) -> f64 {
        let mean = self.sum / self.count;
        ((self.sum_of_squares / self.count - mean * mean).max(0.0) / (self.count - 1.0).max(1.0)).sqrt()
    }
}

impl std::fmt::Display for Mean {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(0);
        write!(f, "{:.digits$} ± {:.digits$}", self.sum / self.count, self.error())
    }
}

/// Means over all runs of a problem, and how many contacts each took.
#[derive(Default)]
struct Means {
    ms: Mean,
    nodes: Mean,
    hops: Mean,
    first_arcs_refused: Mean,
    /// Hops refused as a whole, those over the bounds included.
    left_none: Mean,
    narrow: Mean,
    grazes: Mean,
    length_m: Mean,
    /// Contacts of the runs that joined start and goal.
    contacts: Vec<usize>,
}

impl Means {
    /// How many of the runs joined start and goal within a number of contacts.
    fn joined_within(&self, contacts: usize) -> usize {
        self.contacts.iter().filter(|taken| **taken <= contacts).count()
    }
}

fn measured(ground: &MeshGround, scene: &Scene, test: JoinTest, (seeds, contacts_max): (u64, usize)) -> Means {
    let bounds = SpaceBounds { min: scene.bounds[0].into(), max: scene.bounds[1].into() };
    let end = |at: [f64; 3]| -> MeshContact {
        let contact = ground.contact(at.into()).expect("an end on the mesh");
        ground.stood_off(&contact, PROBE_STAND_OFF_M).expect("room to stand off")
    };
    let objective = Objective::of(Amount::ArcLength);
    let question = RoadmapQuestion {
        objective: &objective,
        budgets: &Budgets::NONE,
        commands: SearchedCommands::Chosen,
        takeoff: TakeoffChoice::LeastTime,
        cap: LabelCap::default(),
    };
    let scheme = OneByOne { test, height_max_m: scene.height_max_m, contacts_max, time_max: None };
    let mut means = Means::default();
    for seed in 0..seeds {
        let mut sampler = ContactSampler::new(ground, Some(bounds), PROBE_STAND_OFF_M, seed).expect("facets within the bounds");
        let began = Instant::now();
        let grown = grow_one_by_one(ground, scene.ends.map(end), &mut sampler, &question, scheme, &());
        let (grown, counts) = grown.expect("not cancelled");
        means.ms.add(1e3 * began.elapsed().as_secs_f64());
        means.nodes.add(grown.roadmap.contact_count() as f64);
        means.hops.add(0.5 * grown.roadmap.window_count() as f64);
        means.first_arcs_refused.add(counts.first_arcs_refused as f64);
        // By sampling those that rise too high are among the refused.
        let too_high = if test == JoinTest::ExactWindows { counts.too_high } else { 0 };
        means.left_none.add((counts.refused + too_high) as f64);
        means.narrow.add(counts.narrow as f64);
        means.grazes.add(counts.grazes as f64);
        if let Some(path) = &grown.route.path {
            means.length_m.add(path.totals.of(Amount::ArcLength));
            means.contacts.push(grown.roadmap.contact_count());
        }
    }
    means
}

fn main() {
    let seeds = std::env::args().skip(1).find_map(|text| text.parse().ok()).unwrap_or(SEEDS);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| tables(seeds));
}

fn tables(seeds: u64) {
    println!("mean and standard error of {seeds} runs; hops: undirected, by windows");
    println!("| scene, mu/V | planner | ms | contacts | hops | first arc refused | no arc left | narrow | grazes | length, m |");
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut joined = Vec::new();
    for problem in &PROBLEMS {
        let Problem { scene, friction, speed_m_s, paper } = problem;
        let path = folder().join(scene.file);
        let Ok(file) = read_mesh(&path, 1.0) else {
            println!("skipped: {} is absent", path.display());
            continue;
        };
        let ground = ground(file.mesh, *friction, *speed_m_s);
        let name = format!("{}, {friction}/{speed_m_s}", scene.file.trim_end_matches(".stl"));
        let [sampled, exact] =
            [JoinTest::SampledAngles, JoinTest::ExactWindows].map(|test| measured(&ground, scene, test, (seeds, CONTACTS_MAX)));
        println!("| {name} | paper | {paper} |");
        for (planner, means) in [("prm", &sampled), ("exact", &exact)] {
            let Means { ms, nodes, hops, first_arcs_refused, left_none, narrow, grazes, length_m, .. } = means;
            print!("| | {planner} | {ms:.1} | {nodes} | {hops} | {first_arcs_refused} | {left_none} | {narrow} ");
            println!("| {grazes:.2} | {length_m:.1} |");
        }
        joined.push((name, sampled, exact));
    }
    println!("\nruns of {seeds} that joined start and goal within so many contacts: prm / exact");
    println!("| scene, mu/V | {} |", WITHIN.map(|contacts| contacts.to_string()).join(" | "));
    println!("|---|{}", "---|".repeat(WITHIN.len()));
    for (name, sampled, exact) in &joined {
        let cells = WITHIN.map(|contacts| format!("{} / {}", sampled.joined_within(contacts), exact.joined_within(contacts)));
        println!("| {name} | {} |", cells.join(" | "));
    }
    let ground = slot();
    let [sampled, exact] =
        [JoinTest::SampledAngles, JoinTest::ExactWindows].map(|test| measured(&ground, &SLOT, test, (seeds, SLOT_CONTACTS)));
    println!(
        "\nslot: within {SLOT_CONTACTS} contacts prm joins {} of {seeds} runs ({:.0} hops with no arc left), exact {}",
        sampled.contacts.len(),
        sampled.left_none,
        exact.contacts.len()
    );
}
