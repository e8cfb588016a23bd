//! Every option of every command has an effect or is refused; every help text explains its option, and its example runs.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::print_stderr, reason = "a skipped example says why")]

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

use crate::desk::{ACROSS, CHAIN, Desk, FORWARD_ONLY, FOUR_LEGS, Ran};

const COMMANDS: [&str; 20] = [
    "run",
    "slice",
    "map",
    "sites",
    "hop",
    "check",
    "plan",
    "require",
    "trade",
    "compare",
    "report",
    "simulate",
    "batch",
    "stance",
    "arena",
    "synth",
    "bodies",
    "completions",
    "man",
    "schema",
];

/// Options that need a projected map, tested in `maps_command.rs`, `--target-lonlat` in `sites.rs`.
const ON_A_PROJECTED_MAP: [&str; 7] =
    ["--from-lonlat", "--to-lonlat", "--via-lonlat", "--start-lonlat", "--goal-lonlat", "--target-lonlat", "--accept-map-scale"];

/// Options that change only the run time, tested below and in `trade_compare.rs`.
const ON_THE_TIME_ALONE: [&str; 1] = ["--threads"];

/// The option of every command, tested in `verbose.rs`.
const OF_EVERY_COMMAND: &str = "--verbose";

/// The bounds of inputs and of memory, tested in `pipes.rs`, `map_starts.rs` and `free_route.rs`.
const ON_LARGE_INPUTS: [&str; 2] = ["--input-max-gib", "--memory-max-mib"];

/// The roadmaps of plans over meshes, tested in `mesh_plan.rs`.
const ON_MESHES: [&str; 2] = ["--roadmap", "--roadmap-output"];

/// Of missions that drive, tested in `travel.rs`.
const ON_WHEELS: [&str; 1] = ["--alternatives"];

/// What needs the files of other runs, or a build with Parquet, tested in `trials_parts.rs` and `batch.rs`.
const ON_PARTS: [&str; 2] = ["--merge", "--parts"];

/// The mark of missing data, tested in `missing_data.rs`.
const ON_MISSING_DATA: [&str; 1] = ["--no-data"];

/// An option, a command line without it, and one with it.
type Trial = (&'static str, &'static [&'static str], &'static [&'static str]);

const RUN: [Trial; 9] = [
    ("--width-mm", &["run", "scenario.toml", "-o", "out"], &["run", "scenario.toml", "-o", "out", "--width-mm", "85"]),
    ("--report", &["run", "scenario.toml", "-o", "out"], &["run", "scenario.toml", "-o", "out", "--report", "out/page.html"]),
    ("--pictures", &["run", "scenario.toml", "-o", "out"], &["run", "scenario.toml", "-o", "out", "--pictures", "png"]),
    ("--trajectory", &["run", "scenario.toml", "-o", "out"], &["run", "scenario.toml", "-o", "out", "--trajectory", "t.csv"]),
    (
        "--step-s",
        &["run", "scenario.toml", "-o", "out", "--trajectory", "t.csv"],
        &["run", "scenario.toml", "-o", "out", "--trajectory", "t.csv", "--step-s", "0.5"],
    ),
    ("--output", &["run", "scenario.toml", "-o", "out"], &["run", "scenario.toml", "-o", "elsewhere"]),
    ("--format", &["run", "scenario.toml", "-o", "out"], &["run", "scenario.toml", "-o", "out", "--format", "json"]),
    ("--set", &["run", "scenario.toml", "-o", "out"], &["run", "scenario.toml", "-o", "out", "--set", "body.name=moon"]),
    (
        "--quiet",
        &["run", "scenario.toml", "-o", "out", "--set", "body.name=bennu"],
        &["run", "scenario.toml", "-o", "out", "--set", "body.name=bennu", "--quiet"],
    ),
];

const SLICE: [Trial; 8] = [
    (
        "--geojson",
        &["slice", "ground.tif", "--from", "1,1", "--to", "9,9"],
        &["slice", "ground.tif", "--from", "1,1", "--to", "9,9", "--geojson", "line.geojson"],
    ),
    (
        "--via",
        &["slice", "ground.tif", "--from", "1,1", "--to", "9,9"],
        &["slice", "ground.tif", "--from", "1,1", "--to", "9,9", "--via", "9,1"],
    ),
    ("--from", &["slice", "ground.tif", "--from", "1,1", "--to", "9,9"], &["slice", "ground.tif", "--from", "2,1", "--to", "9,9"]),
    ("--to", &["slice", "ground.tif", "--from", "1,1", "--to", "9,9"], &["slice", "ground.tif", "--from", "1,1", "--to", "9,8"]),
    (
        "--scenario",
        &["slice", "ground.tif", "--from", "1,1", "--to", "9,9"],
        &["slice", "ground.tif", "--from", "1,1", "--to", "9,9", "--scenario", "scenario.toml"],
    ),
    (
        "--mesh-scale",
        &["slice", "plate.obj", "--from", "1,1", "--to", "3,3"],
        &["slice", "plate.obj", "--from", "1,1", "--to", "3,3", "--mesh-scale", "2"],
    ),
    (
        "--quiet",
        &["slice", "plate.obj", "--from", "1,1", "--to", "3,3"],
        &["slice", "plate.obj", "--from", "1,1", "--to", "3,3", "--quiet"],
    ),
    (
        "--output",
        &["slice", "ground.tif", "--from", "1,1", "--to", "9,9"],
        &["slice", "ground.tif", "--from", "1,1", "--to", "9,9", "-o", "slice.csv"],
    ),
];

const SITES: [Trial; 19] = [
    (
        "--trials",
        &["sites", "ground.tif", "--every", "9", "--scenario", "map.toml", "--target", "9,9"],
        &["sites", "ground.tif", "--every", "9", "--scenario", "map.toml", "--target", "9,9", "--trials", "20"],
    ),
    (
        "--width-mm",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--plot", "sites.svg"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--plot", "sites.svg", "--width-mm", "85"],
    ),
    (
        "--every",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "7", "--scenario", "map.toml"],
    ),
    (
        "--candidates",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--candidates", "starts.csv", "--scenario", "map.toml"],
    ),
    (
        "--target",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--target", "9,9"],
    ),
    (
        "--stride",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--stride", "2"],
    ),
    (
        "--node-spacing-max-m",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--node-spacing-max-m", "0.5"],
    ),
    (
        "--objective",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--objective", "energy"],
    ),
    (
        "--require-all",
        &[
            "sites",
            "ground.tif",
            "--every",
            "19",
            "--target",
            "9,9",
            "--scenario",
            "map.toml",
            "--set",
            "hopper.takeoff_speed_max_m_s=0.1",
        ],
        &[
            "sites",
            "ground.tif",
            "--every",
            "19",
            "--target",
            "9,9",
            "--scenario",
            "map.toml",
            "--set",
            "hopper.takeoff_speed_max_m_s=0.1",
            "--require-all",
        ],
    ),
    (
        "--output",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "-o", "sites.csv"],
    ),
    (
        "--plot",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--plot", "sites.svg"],
    ),
    (
        "--dry-run",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--dry-run"],
    ),
    (
        "--format",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--format", "json"],
    ),
    (
        "--scenario",
        &[
            "sites",
            "ground.tif",
            "--every",
            "5",
            "--body",
            "mars",
            "--set",
            "hopper.takeoff_speed_max_m_s=3",
            "--set",
            "hopper.landing_speed_max_m_s=3",
            "--set",
            "surface.friction_coefficient=0.5",
        ],
        &[
            "sites",
            "ground.tif",
            "--every",
            "5",
            "--body",
            "mars",
            "--set",
            "hopper.takeoff_speed_max_m_s=3",
            "--set",
            "hopper.landing_speed_max_m_s=3",
            "--set",
            "surface.friction_coefficient=0.5",
            "--format",
            "json",
            "--scenario",
            "map.toml",
        ],
    ),
    (
        "--set",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--set", "hopper.takeoff_speed_max_m_s=3"],
    ),
    (
        "--body",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--body", "moon"],
    ),
    (
        "--gravity-m-s2",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--gravity-m-s2", "2.5"],
    ),
    (
        "--clearance-m",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml"],
        &[
            "sites",
            "ground.tif",
            "--every",
            "5",
            "--scenario",
            "map.toml",
            "--clearance-m",
            "2.5",
            "--set",
            "hopper.clearance_taper=3",
        ],
    ),
    (
        "--quiet",
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--set", "search.split=equal"],
        &["sites", "ground.tif", "--every", "5", "--scenario", "map.toml", "--set", "search.split=equal", "--quiet"],
    ),
];

const MAP: [Trial; 33] = [
    (
        "--width-mm",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--plot", "map.svg"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--plot", "map.svg", "--width-mm", "85"],
    ),
    (
        "--seen-from",
        &["map", "space.toml", "--plot", "map.svg"],
        &["map", "space.toml", "--plot", "map.svg", "--seen-from", "100,50"],
    ),
    (
        "--objective",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--objective", "energy,hops"],
    ),
    (
        "--amount-output",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--amount-output", "flight-time=t.tif"],
    ),
    (
        "--node-spacing-max-m",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--node-spacing-max-m", "0.5"],
    ),
    (
        "--nearest-output",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--nearest-output", "n.tif"],
    ),
    (
        "--predecessor-output",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--predecessor-output", "p.tif"],
    ),
    (
        "--qml",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "-o", "hops.tif"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "-o", "hops.tif", "--qml"],
    ),
    (
        "--hops-max",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--hops-max", "1"],
    ),
    (
        "--dry-run",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--dry-run"],
    ),
    ("--starts", &["map", "map.toml"], &["map", "map.toml", "--starts", "starts.csv"]),
    (
        "--simulate",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9", "--simulate"],
    ),
    (
        "--start",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "6,5", "--scenario", "map.toml"],
    ),
    (
        "--goal",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9"],
    ),
    (
        "--stride",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--stride", "2"],
    ),
    (
        "--effort",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--effort", "time"],
    ),
    (
        "--return",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--return"],
    ),
    (
        "--output",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "-o", "hops.tif"],
    ),
    (
        "--effort-output",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--effort"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--effort", "--effort-output", "e.tif"],
    ),
    (
        "--return-output",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--return"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--return", "--return-output", "b.tif"],
    ),
    (
        "--mobility",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--mobility", "m.tif"],
    ),
    (
        "--paths",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9", "--paths", "p.csv"],
    ),
    (
        "--geojson",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9", "--geojson", "p.geojson"],
    ),
    (
        "--profiles",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--goal", "9,9", "--profiles", "p.svg"],
    ),
    (
        "--profiles-from",
        &["map", "ground.tif", "--start", "1,1", "--scenario", "map.toml", "--goal", "18,18", "--profiles", "p.svg"],
        &[
            "map",
            "ground.tif",
            "--start",
            "1,1",
            "--scenario",
            "map.toml",
            "--goal",
            "18,18",
            "--profiles",
            "p.svg",
            "--profiles-from",
            "2",
        ],
    ),
    (
        "--plot",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--plot", "map.svg"],
    ),
    (
        "--format",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--format", "json"],
    ),
    (
        "--scenario",
        &[
            "map",
            "ground.tif",
            "--start",
            "5,5",
            "--body",
            "mars",
            "--set",
            "hopper.takeoff_speed_max_m_s=3",
            "--set",
            "hopper.landing_speed_max_m_s=3",
            "--set",
            "surface.friction_coefficient=0.5",
        ],
        &[
            "map",
            "ground.tif",
            "--start",
            "5,5",
            "--body",
            "mars",
            "--set",
            "hopper.takeoff_speed_max_m_s=3",
            "--set",
            "hopper.landing_speed_max_m_s=3",
            "--set",
            "surface.friction_coefficient=0.5",
            "--format",
            "json",
            "--scenario",
            "map.toml",
        ],
    ),
    (
        "--set",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--set", "hopper.takeoff_speed_max_m_s=3"],
    ),
    (
        "--body",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--body", "moon"],
    ),
    (
        "--gravity-m-s2",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml", "--gravity-m-s2", "2.5"],
    ),
    (
        "--clearance-m",
        &["map", "ground.tif", "--start", "5,5", "--scenario", "map.toml"],
        &[
            "map",
            "ground.tif",
            "--start",
            "5,5",
            "--scenario",
            "map.toml",
            "--clearance-m",
            "2.5",
            "--set",
            "hopper.clearance_taper=3",
        ],
    ),
    (
        "--quiet",
        &[
            "map",
            "ground.tif",
            "--start",
            "5,5",
            "--goal",
            "9,9",
            "--scenario",
            "map.toml",
            "--body",
            "bennu",
            "--set",
            "hopper.takeoff_speed_max_m_s=0.02",
            "--set",
            "hopper.landing_speed_max_m_s=0.02",
        ],
        &[
            "map",
            "ground.tif",
            "--start",
            "5,5",
            "--goal",
            "9,9",
            "--scenario",
            "map.toml",
            "--body",
            "bennu",
            "--set",
            "hopper.takeoff_speed_max_m_s=0.02",
            "--set",
            "hopper.landing_speed_max_m_s=0.02",
            "--quiet",
        ],
    ),
];

const HOP: [Trial; 13] = [
    (
        "--width-mm",
        &["hop", "plate.obj", "--from", "1,1,0", "--to", "3,3,0", "--scenario", "map.toml", "--plot", "hop.svg"],
        &[
            "hop",
            "plate.obj",
            "--from",
            "1,1,0",
            "--to",
            "3,3,0",
            "--scenario",
            "map.toml",
            "--plot",
            "hop.svg",
            "--width-mm",
            "85",
        ],
    ),
    (
        "--plot",
        &["hop", "plate.obj", "--from", "1,1,0", "--to", "3,3,0", "--scenario", "map.toml"],
        &["hop", "plate.obj", "--from", "1,1,0", "--to", "3,3,0", "--scenario", "map.toml", "--plot", "hop.svg"],
    ),
    ("--trajectory", &["hop", "scenario.toml", "--to", "10"], &["hop", "scenario.toml", "--to", "10", "--trajectory", "t.csv"]),
    (
        "--step-s",
        &["hop", "scenario.toml", "--to", "10", "--trajectory", "t.csv"],
        &["hop", "scenario.toml", "--to", "10", "--trajectory", "t.csv", "--step-s", "0.5"],
    ),
    ("--from", &["hop", "scenario.toml", "--to", "30"], &["hop", "scenario.toml", "--to", "30", "--from", "10"]),
    ("--to", &["hop", "scenario.toml"], &["hop", "scenario.toml", "--to", "10"]),
    ("--format", &["hop", "scenario.toml"], &["hop", "scenario.toml", "--format", "json"]),
    ("--scenario", &["hop", "chain.csv", "--body", "mars"], &["hop", "chain.csv", "--body", "mars", "--scenario", "scenario.toml"]),
    ("--set", &["hop", "scenario.toml"], &["hop", "scenario.toml", "--set", "hopper.apex_height_max_m=1"]),
    ("--body", &["hop", "scenario.toml"], &["hop", "scenario.toml", "--body", "moon"]),
    ("--gravity-m-s2", &["hop", "scenario.toml"], &["hop", "scenario.toml", "--gravity-m-s2", "1.5"]),
    ("--clearance-m", &["hop", "scenario.toml"], &["hop", "scenario.toml", "--clearance-m", "0.5"]),
    ("--quiet", &["hop", "scenario.toml", "--body", "bennu"], &["hop", "scenario.toml", "--body", "bennu", "--quiet"]),
];

const CHECK: [Trial; 17] = [
    (
        "--width-mm",
        &["check", "scenario.toml", "--prove", "--plot", "proof.svg"],
        &["check", "scenario.toml", "--prove", "--plot", "proof.svg", "--width-mm", "85"],
    ),
    ("--start", &["check", "scenario.toml"], &["check", "scenario.toml", "--start", "10"]),
    ("--goal", &["check", "scenario.toml"], &["check", "scenario.toml", "--goal", "30"]),
    ("--pairs", &["check", "scenario.toml"], &["check", "scenario.toml", "--pairs", "pairs.csv"]),
    ("--prove", &["check", "scenario.toml"], &["check", "scenario.toml", "--prove"]),
    ("--prove-cells-max", &["check", "scenario.toml", "--prove"], &["check", "scenario.toml", "--prove", "--budget", "1"]),
    ("--plot", &["check", "scenario.toml", "--prove"], &["check", "scenario.toml", "--prove", "--plot", "proof.svg"]),
    ("--format", &["check", "scenario.toml"], &["check", "scenario.toml", "--format", "json"]),
    ("--points-per-segment", &["check", "scenario.toml"], &["check", "scenario.toml", "--points-per-segment", "2"]),
    ("--node-spacing-max-m", &["check", "scenario.toml"], &["check", "scenario.toml", "--node-spacing-max-m", "2"]),
    ("--effort", &["check", "scenario.toml"], &["check", "scenario.toml", "--effort", "time"]),
    (
        "--scenario",
        &["check", "chain.csv", "--body", "mars"],
        &["check", "chain.csv", "--body", "mars", "--scenario", "scenario.toml"],
    ),
    ("--set", &["check", "scenario.toml"], &["check", "scenario.toml", "--set", "hopper.flight_time_max_s=1"]),
    ("--body", &["check", "scenario.toml"], &["check", "scenario.toml", "--body", "moon"]),
    ("--gravity-m-s2", &["check", "scenario.toml"], &["check", "scenario.toml", "--gravity-m-s2", "1.5"]),
    (
        "--clearance-m",
        &["check", "scenario.toml"],
        &["check", "scenario.toml", "--clearance-m", "50", "--set", "hopper.clearance_taper=9"],
    ),
    ("--quiet", &["check", "scenario.toml", "--body", "bennu"], &["check", "scenario.toml", "--body", "bennu", "--quiet"]),
];

const PLAN: [Trial; 27] = [
    (
        "--width-mm",
        &["plan", "scenario.toml", "--plot", "path.svg"],
        &["plan", "scenario.toml", "--plot", "path.svg", "--width-mm", "85"],
    ),
    (
        "--seen-from",
        &["plan", "space.toml", "--plot", "path.svg"],
        &["plan", "space.toml", "--plot", "path.svg", "--seen-from", "100,50"],
    ),
    (
        "--dry-run",
        &["plan", "map.toml", "--set", "terrain.route=free"],
        &["plan", "map.toml", "--set", "terrain.route=free", "--dry-run"],
    ),
    ("--front", &["plan", "errors.toml"], &["plan", "errors.toml", "--front", "hops,risk"]),
    (
        "--plot-front",
        &["plan", "errors.toml", "--front", "hops,risk"],
        &["plan", "errors.toml", "--front", "hops,risk", "--plot-front", "front.svg"],
    ),
    ("--plot-postures", &["plan", "legs.toml"], &["plan", "legs.toml", "--plot-postures", "postures.svg"]),
    (
        "--postures-from",
        &["plan", "legs.toml", "--plot-postures", "postures.svg"],
        &["plan", "legs.toml", "--plot-postures", "postures.svg", "--postures-from", "2"],
    ),
    ("--trajectory", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--trajectory", "t.csv"]),
    (
        "--step-s",
        &["plan", "scenario.toml", "--trajectory", "t.csv"],
        &["plan", "scenario.toml", "--trajectory", "t.csv", "--step-s", "0.5"],
    ),
    ("--start", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--start", "10"]),
    ("--goal", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--goal", "30"]),
    ("--output", &["plan", "scenario.toml"], &["plan", "scenario.toml", "-o", "path.csv"]),
    ("--geojson", &["plan", "map.toml"], &["plan", "map.toml", "--geojson", "path.geojson"]),
    ("--plot", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--plot", "path.svg"]),
    ("--prove", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--prove"]),
    ("--prove-cells-max", &["plan", "scenario.toml", "--prove"], &["plan", "scenario.toml", "--prove", "--budget", "1"]),
    ("--verify", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--verify"]),
    ("--format", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--format", "json"]),
    ("--points-per-segment", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--points-per-segment", "2"]),
    ("--node-spacing-max-m", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--node-spacing-max-m", "2"]),
    ("--effort", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--effort", "peak-speed"]),
    (
        "--scenario",
        &["plan", "chain.csv", "--body", "mars"],
        &["plan", "chain.csv", "--body", "mars", "--scenario", "scenario.toml"],
    ),
    ("--set", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--set", "search.takeoff_angle=mid-range"]),
    ("--body", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--body", "moon"]),
    ("--gravity-m-s2", &["plan", "scenario.toml"], &["plan", "scenario.toml", "--gravity-m-s2", "1.5"]),
    (
        "--clearance-m",
        &["plan", "scenario.toml"],
        &["plan", "scenario.toml", "--clearance-m", "50", "--set", "hopper.clearance_taper=9"],
    ),
    ("--quiet", &["plan", "scenario.toml", "--body", "bennu"], &["plan", "scenario.toml", "--body", "bennu", "--quiet"]),
];

const REPORT: [Trial; 2] = [
    ("--output", &["report", "other_path.json", "-o", "page.html"], &["report", "other_path.json", "-o", "elsewhere.html"]),
    ("--quiet", &["report", "other_path.json", "-o", "page.html"], &["report", "other_path.json", "-o", "page.html", "--quiet"]),
];

const MAN: [Trial; 1] = [("--output", &["man", "-o", "pages"], &["man", "-o", "elsewhere"])];

/// A base case for several options.
const REQUIRED: [&str; 10] =
    ["require", "scenario.toml", "--vary", "surface.friction_coefficient", "--from", "0.03", "--to", "2", "--resolution", "0.05"];

const REQUIRE: [Trial; 22] = [
    (
        "--hops-max",
        &["require", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--from", "3", "--to", "12", "--resolution", "0.2"],
        &[
            "require",
            "scenario.toml",
            "--vary",
            "hopper.takeoff_speed_max_m_s",
            "--from",
            "3",
            "--to",
            "12",
            "--resolution",
            "0.2",
            "--hops-max",
            "4",
        ],
    ),
    (
        "--mission-time-max-s",
        &["require", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--from", "3", "--to", "12", "--resolution", "0.2"],
        &[
            "require",
            "scenario.toml",
            "--vary",
            "hopper.takeoff_speed_max_m_s",
            "--from",
            "3",
            "--to",
            "12",
            "--resolution",
            "0.2",
            "--mission-time-max-s",
            "900",
        ],
    ),
    (
        "--energy-max-j-kg",
        &["require", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--from", "3", "--to", "12", "--resolution", "0.2"],
        &[
            "require",
            "scenario.toml",
            "--vary",
            "hopper.takeoff_speed_max_m_s",
            "--from",
            "3",
            "--to",
            "12",
            "--resolution",
            "0.2",
            "--energy-max-j-kg",
            "500",
        ],
    ),
    (
        "--delta-v-max-m-s",
        &["require", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--from", "3", "--to", "12", "--resolution", "0.2"],
        &[
            "require",
            "scenario.toml",
            "--vary",
            "hopper.takeoff_speed_max_m_s",
            "--from",
            "3",
            "--to",
            "12",
            "--resolution",
            "0.2",
            "--delta-v-max-m-s",
            "200",
        ],
    ),
    (
        "--success-min",
        &["require", "errors.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--from", "3", "--to", "12"],
        &["require", "errors.toml", "--vary", "hopper.takeoff_speed_max_m_s", "--from", "3", "--to", "12", "--success-min", "0.2"],
    ),
    (
        "--start",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--start",
            "10",
        ],
    ),
    (
        "--goal",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--goal",
            "30",
        ],
    ),
    ("--vary", &REQUIRED, &["require", "scenario.toml", "--vary", "surface.rest_slope_max_deg", "--resolution", "0.05"]),
    (
        "--from",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.04",
            "--to",
            "2",
            "--resolution",
            "0.05",
        ],
    ),
    (
        "--to",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "1",
            "--resolution",
            "0.05",
        ],
    ),
    (
        "--resolution",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.2",
        ],
    ),
    (
        "--prove-cells-max",
        &[
            "require",
            "pit.csv",
            "--scenario",
            "scenario.toml",
            "--vary",
            "hopper.takeoff_speed_max_m_s",
            "--resolution",
            "0.05",
            "--from",
            "1",
        ],
        &[
            "require",
            "pit.csv",
            "--scenario",
            "scenario.toml",
            "--vary",
            "hopper.takeoff_speed_max_m_s",
            "--resolution",
            "0.05",
            "--from",
            "1",
            "--prove-cells-max",
            "1",
        ],
    ),
    (
        "--format",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--format",
            "json",
        ],
    ),
    (
        "--points-per-segment",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--points-per-segment",
            "7",
            "--format",
            "json",
        ],
    ),
    (
        "--node-spacing-max-m",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--node-spacing-max-m",
            "3",
            "--format",
            "json",
        ],
    ),
    (
        "--effort",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--effort",
            "time",
            "--format",
            "json",
        ],
    ),
    (
        "--scenario",
        &["require", "chain.csv", "--body", "mars", "--vary", "hopper.clearance_m"],
        &[
            "require",
            "chain.csv",
            "--body",
            "mars",
            "--vary",
            "hopper.clearance_m",
            "--resolution",
            "0.05",
            "--scenario",
            "scenario.toml",
        ],
    ),
    (
        "--set",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--set",
            "hopper.flight_time_max_s=2",
            "--format",
            "json",
        ],
    ),
    (
        "--body",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--body",
            "moon",
            "--format",
            "json",
        ],
    ),
    (
        "--gravity-m-s2",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--gravity-m-s2",
            "1.5",
            "--format",
            "json",
        ],
    ),
    (
        "--clearance-m",
        &REQUIRED,
        &[
            "require",
            "scenario.toml",
            "--vary",
            "surface.friction_coefficient",
            "--from",
            "0.03",
            "--to",
            "2",
            "--resolution",
            "0.05",
            "--clearance-m",
            "2",
            "--format",
            "json",
        ],
    ),
    (
        "--quiet",
        &["require", "forward.csv", "--body", "mars", "--start", "0", "--goal", "10", "--vary", "hopper.takeoff_speed_max_m_s"],
        &[
            "require",
            "forward.csv",
            "--body",
            "mars",
            "--start",
            "0",
            "--goal",
            "10",
            "--vary",
            "hopper.takeoff_speed_max_m_s",
            "--quiet",
        ],
    ),
];

const VARY: &str = "hopper.takeoff_speed_max_m_s=6:9:2";

const TRADE: [Trial; 19] = [
    (
        "--width-mm",
        &["trade", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s=4:10:3", "--plot", "trade.svg"],
        &["trade", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s=4:10:3", "--plot", "trade.svg", "--width-mm", "85"],
    ),
    (
        "--require-all",
        &["trade", "scenario.toml", "--vary", "surface.friction_coefficient=0.05:0.6:2"],
        &["trade", "scenario.toml", "--vary", "surface.friction_coefficient=0.05:0.6:2", "--require-all"],
    ),
    ("--start", &["trade", "scenario.toml", "--vary", VARY], &["trade", "scenario.toml", "--vary", VARY, "--start", "30"]),
    ("--goal", &["trade", "scenario.toml", "--vary", VARY], &["trade", "scenario.toml", "--vary", VARY, "--goal", "10"]),
    (
        "--vary",
        &["trade", "scenario.toml", "--vary", VARY],
        &["trade", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s=6:9:3"],
    ),
    ("--output", &["trade", "scenario.toml", "--vary", VARY], &["trade", "scenario.toml", "--vary", VARY, "-o", "trade.csv"]),
    ("--plot", &["trade", "scenario.toml", "--vary", VARY], &["trade", "scenario.toml", "--vary", VARY, "--plot", "trade.svg"]),
    ("--format", &["trade", "scenario.toml", "--vary", VARY], &["trade", "scenario.toml", "--vary", VARY, "--format", "json"]),
    ("--prove", &["trade", "scenario.toml", "--vary", VARY], &["trade", "scenario.toml", "--vary", VARY, "--prove"]),
    (
        "--prove-cells-max",
        &["trade", "scenario.toml", "--vary", VARY, "--format", "json", "--prove"],
        &["trade", "scenario.toml", "--vary", VARY, "--format", "json", "--prove", "--prove-cells-max", "1"],
    ),
    (
        "--points-per-segment",
        &["trade", "scenario.toml", "--vary", VARY, "--format", "json"],
        &["trade", "scenario.toml", "--vary", VARY, "--format", "json", "--points-per-segment", "2"],
    ),
    (
        "--node-spacing-max-m",
        &["trade", "scenario.toml", "--vary", VARY, "--format", "json"],
        &["trade", "scenario.toml", "--vary", VARY, "--format", "json", "--node-spacing-max-m", "2"],
    ),
    (
        "--effort",
        &["trade", "scenario.toml", "--vary", VARY, "--format", "json"],
        &["trade", "scenario.toml", "--vary", VARY, "--format", "json", "--effort", "time"],
    ),
    (
        "--scenario",
        &["trade", "chain.csv", "--body", "mars", "--vary", VARY],
        &["trade", "chain.csv", "--body", "mars", "--vary", VARY, "--scenario", "scenario.toml"],
    ),
    (
        "--set",
        &["trade", "scenario.toml", "--vary", VARY],
        &["trade", "scenario.toml", "--vary", VARY, "--set", "hopper.flight_time_max_s=1"],
    ),
    ("--body", &["trade", "scenario.toml", "--vary", VARY], &["trade", "scenario.toml", "--vary", VARY, "--body", "moon"]),
    (
        "--gravity-m-s2",
        &["trade", "scenario.toml", "--vary", VARY],
        &["trade", "scenario.toml", "--vary", VARY, "--gravity-m-s2", "1.5"],
    ),
    (
        "--clearance-m",
        &["trade", "scenario.toml", "--vary", VARY],
        &["trade", "scenario.toml", "--vary", VARY, "--clearance-m", "50", "--set", "hopper.clearance_taper=9"],
    ),
    (
        "--quiet",
        &["trade", "odd.csv", "--scenario", "scenario.toml", "--vary", VARY],
        &["trade", "odd.csv", "--scenario", "scenario.toml", "--vary", VARY, "--quiet"],
    ),
];

const COMPARE: [Trial; 10] = [
    (
        "--width-mm",
        &["compare", "scenario.toml", "map.toml", "--plot", "compare.svg"],
        &["compare", "scenario.toml", "map.toml", "--plot", "compare.svg", "--width-mm", "85"],
    ),
    (
        "--seen-from",
        &["compare", "space.toml", "space.toml", "--plot", "both.svg"],
        &["compare", "space.toml", "space.toml", "--plot", "both.svg", "--seen-from", "100,50"],
    ),
    (
        "--require-all",
        &["compare", "scenario.toml", "map.toml", "--set", "surface.friction_coefficient=0.05"],
        &["compare", "scenario.toml", "map.toml", "--set", "surface.friction_coefficient=0.05", "--require-all"],
    ),
    ("--output", &["compare", "scenario.toml", "map.toml"], &["compare", "scenario.toml", "map.toml", "-o", "compare.csv"]),
    ("--plot", &["compare", "scenario.toml", "map.toml"], &["compare", "scenario.toml", "map.toml", "--plot", "compare.svg"]),
    ("--format", &["compare", "scenario.toml", "map.toml"], &["compare", "scenario.toml", "map.toml", "--format", "json"]),
    (
        "--prove",
        &["compare", "scenario.toml", "map.toml", "--format", "json"],
        &["compare", "scenario.toml", "map.toml", "--format", "json", "--prove"],
    ),
    (
        "--prove-cells-max",
        &["compare", "scenario.toml", "map.toml", "--format", "json", "--prove"],
        &["compare", "scenario.toml", "map.toml", "--format", "json", "--prove", "--prove-cells-max", "1"],
    ),
    ("--set", &["compare", "scenario.toml", "map.toml"], &["compare", "scenario.toml", "map.toml", "--set", "body.name=moon"]),
    (
        "--quiet",
        &["compare", "scenario.toml", "map.toml", "--set", "body.name=bennu"],
        &["compare", "scenario.toml", "map.toml", "--set", "body.name=bennu", "--quiet"],
    ),
];

/// Ground with all overlays, small enough for a test.
const SIMULATE: [Trial; 33] = [
    (
        "--width-mm",
        &["simulate", "errors.toml", "--plot", "trials.svg"],
        &["simulate", "errors.toml", "--plot", "trials.svg", "--width-mm", "85"],
    ),
    ("--trajectory", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--trajectory", "t.csv"]),
    (
        "--step-s",
        &["simulate", "errors.toml", "--trajectory", "t.csv"],
        &["simulate", "errors.toml", "--trajectory", "t.csv", "--step-s", "0.5"],
    ),
    ("--start", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--start", "10"]),
    ("--goal", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--goal", "30"]),
    ("--plan-anew", &["simulate", "other_path.json"], &["simulate", "other_path.json", "--plan-anew"]),
    ("--first-trial", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--first-trial", "50"]),
    ("--success-min", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--success-min", "0.5"]),
    ("--tally", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--tally", "tally.json"]),
    ("--draws", &["simulate", "errors.toml", "-o", "landings.csv"], &["simulate", "errors.toml", "-o", "landings.csv", "--draws"]),
    ("--trials", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--trials", "50"]),
    ("--seed", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--seed", "9"]),
    ("--policy", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--policy", "open-loop"]),
    ("--compare", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--compare"]),
    (
        "--until-half-width",
        &["simulate", "errors.toml", "--trials", "2000"],
        &["simulate", "errors.toml", "--trials", "2000", "--until-half-width", "0.3"],
    ),
    ("--experiment", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--experiment", "worst-drift"]),
    (
        "--reading",
        &["simulate", "errors.toml", "--experiment", "worst-drift"],
        &["simulate", "errors.toml", "--experiment", "worst-drift", "--reading", "noise-in-flight"],
    ),
    ("--output", &["simulate", "errors.toml"], &["simulate", "errors.toml", "-o", "landings.csv"]),
    ("--plot", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--plot", "trials.svg"]),
    (
        "--plot-map",
        &["simulate", "map.toml", "--trials", "20"],
        &["simulate", "map.toml", "--trials", "20", "--plot-map", "landings.svg"],
    ),
    (
        "--density",
        &["simulate", "map.toml", "--trials", "20"],
        &["simulate", "map.toml", "--trials", "20", "--density", "rests.tif"],
    ),
    (
        "--plot-density",
        &["simulate", "map.toml", "--trials", "20"],
        &["simulate", "map.toml", "--trials", "20", "--plot-density", "rests.svg"],
    ),
    (
        "--within",
        &["simulate", "map.toml", "--trials", "20", "--density", "rests.tif"],
        &["simulate", "map.toml", "--trials", "20", "--density", "rests.tif", "--within", "area.geojson"],
    ),
    ("--format", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--format", "json"]),
    ("--points-per-segment", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--points-per-segment", "2"]),
    ("--node-spacing-max-m", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--node-spacing-max-m", "2"]),
    ("--effort", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--effort", "time"]),
    (
        "--scenario",
        &["simulate", "chain.csv", "--start", "0", "--goal", "40", "--body", "mars"],
        &["simulate", "chain.csv", "--start", "0", "--goal", "40", "--body", "mars", "--scenario", "errors.toml"],
    ),
    ("--set", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--set", "uncertainty.drift_along_sigma_m=0"]),
    ("--body", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--body", "moon"]),
    ("--gravity-m-s2", &["simulate", "errors.toml"], &["simulate", "errors.toml", "--gravity-m-s2", "1.5"]),
    (
        "--clearance-m",
        &["simulate", "errors.toml"],
        &["simulate", "errors.toml", "--clearance-m", "50", "--set", "hopper.clearance_taper=9"],
    ),
    (
        "--quiet",
        &["simulate", "errors.toml", "--body", "bennu", "--trials", "10"],
        &["simulate", "errors.toml", "--body", "bennu", "--trials", "10", "--quiet"],
    ),
];

/// A stance on a raster.
const STOOD: [&str; 10] = [
    "stance",
    "ground.tif",
    "--robot",
    "four_legs.toml",
    "--at",
    "9,9",
    "--body",
    "mars",
    "--set",
    "surface.friction_coefficient=0.6",
];

/// The same with more words.
macro_rules! stood {
    ($($word:literal),*) => {
        &[
            "stance", "ground.tif", "--robot", "four_legs.toml", "--at", "9,9", "--body", "mars", "--set", "surface.friction_coefficient=0.6",
            $($word),*
        ]
    };
}

const STANCE: [Trial; 15] = [
    (
        "--width-mm",
        &["stance", "ground.tif", "--robot", "four_legs.toml", "--at", "9,9", "--scenario", "map.toml", "--plot", "stance.svg"],
        &[
            "stance",
            "ground.tif",
            "--robot",
            "four_legs.toml",
            "--at",
            "9,9",
            "--scenario",
            "map.toml",
            "--plot",
            "stance.svg",
            "--width-mm",
            "85",
        ],
    ),
    (
        "--scenario",
        &["stance", "ground.tif", "--robot", "four_legs.toml", "--at", "9,9", "--scenario", "map.toml"],
        &["stance", "ground.tif", "--robot", "four_legs.toml", "--at", "9,9", "--scenario", "other_map.toml"],
    ),
    (
        "--robot",
        &STOOD,
        &[
            "stance",
            "ground.tif",
            "--robot",
            "one_leg.toml",
            "--at",
            "9,9",
            "--body",
            "mars",
            "--set",
            "surface.friction_coefficient=0.6",
        ],
    ),
    (
        "--at",
        &STOOD,
        &[
            "stance",
            "ground.tif",
            "--robot",
            "four_legs.toml",
            "--at",
            "10,4",
            "--body",
            "mars",
            "--set",
            "surface.friction_coefficient=0.6",
        ],
    ),
    ("--heading-deg", &STOOD, stood!["--heading-deg", "33"]),
    ("--height-m", &STOOD, stood!["--height-m", "0.2"]),
    ("--up", &STOOD, stood!["--up", "vertical"]),
    ("--contacts", &STOOD, &["stance", "--contacts", "contacts.csv"]),
    ("--headings", &STOOD, stood!["--headings", "36"]),
    ("--plot", &STOOD, stood!["--plot", "stance.svg"]),
    ("--format", &STOOD, stood!["--format", "json"]),
    ("--set", &STOOD, stood!["--set", "surface.friction_coefficient=0.9"]),
    (
        "--body",
        &STOOD,
        &[
            "stance",
            "ground.tif",
            "--robot",
            "four_legs.toml",
            "--at",
            "9,9",
            "--body",
            "moon",
            "--set",
            "surface.friction_coefficient=0.6",
        ],
    ),
    ("--gravity-m-s2", &STOOD, stood!["--gravity-m-s2", "9"]),
    ("--quiet", stood!["--set", "search.points_per_segment=3"], stood!["--set", "search.points_per_segment=3", "--quiet"]),
];

/// Errors of execution for trials.
/// Without the run time on standard error, which is another one each time.
const ARENA: [Trial; 14] = [
    (
        "--width-mm",
        &["arena", "arena.toml", "--quiet", "--plot", "arena.svg"],
        &["arena", "arena.toml", "--quiet", "--plot", "arena.svg", "--width-mm", "85"],
    ),
    ("--compare", &["arena", "arena.toml", "--quiet"], &["arena", "arena.toml", "--quiet", "--compare"]),
    ("--planner", &["arena", "arena.toml", "--quiet"], &["arena", "arena.toml", "--quiet", "--planner", "grid"]),
    (
        "--reading",
        &["arena", "arena.toml", "--quiet", "--planner", "grid"],
        &["arena", "arena.toml", "--quiet", "--planner", "grid", "--reading", "R0"],
    ),
    ("--no-jump", &["arena", "arena.toml", "--quiet"], &["arena", "arena.toml", "--quiet", "--no-jump"]),
    (
        "--seed",
        &["arena", "arena.toml", "--quiet", "--planner", "rrt-star", "--nodes", "300"],
        &["arena", "arena.toml", "--quiet", "--planner", "rrt-star", "--nodes", "300", "--seed", "7"],
    ),
    (
        "--nodes",
        &["arena", "arena.toml", "--quiet", "--planner", "rrt-star", "--nodes", "300"],
        &["arena", "arena.toml", "--quiet", "--planner", "rrt-star", "--nodes", "400"],
    ),
    ("--random", &["arena", "arena.toml", "--quiet"], &["arena", "arena.toml", "--quiet", "--random", "5"]),
    (
        "--random-sizes-m",
        &["arena", "arena.toml", "--quiet", "--random", "9", "-o", "as_used.toml"],
        &["arena", "arena.toml", "--quiet", "--random", "9", "-o", "as_used.toml", "--random-sizes-m", "0.6,0.8"],
    ),
    ("--set", &["arena", "arena.toml", "--quiet"], &["arena", "arena.toml", "--quiet", "--set", "jumper.speed_m_s=2"]),
    ("--output", &["arena", "arena.toml", "--quiet"], &["arena", "arena.toml", "--quiet", "-o", "as_used.toml"]),
    ("--plot", &["arena", "arena.toml", "--quiet"], &["arena", "arena.toml", "--quiet", "--plot", "arena.svg"]),
    ("--format", &["arena", "arena.toml", "--quiet"], &["arena", "arena.toml", "--quiet", "--format", "json"]),
    ("--quiet", &["arena", "arena.toml"], &["arena", "arena.toml", "--quiet"]),
];

const ERRORS: &str =
    "\n[uncertainty]\ntakeoff_speed_sigma_fraction = 0.01\ndrift_along_sigma_m = 0.1\ngoal_tolerance_m = 2.0\ntrials = 200\n";

const SYNTH: [&str; 30] = [
    "synth",
    "-o",
    "new.asc",
    "--rows",
    "40",
    "--cols",
    "40",
    "--rock-abundance",
    "0.4",
    "--tilt-deg",
    "3",
    "--craters",
    "--crater-density-per-km2",
    "5000",
    "--crater-diameter-max-m",
    "30",
    "--rille",
    "--rille-width-m",
    "30",
    "--rille-depth-m",
    "4",
    "--rille-meander-amplitude-m",
    "10",
    "--rille-meander-length-m",
    "60",
    "--boulders",
    "--boulder-diameter-min-m",
    "1.5",
    "--boulder-diameter-max-m",
    "6",
];

/// Values for the options of `synth`, all different from those in [`SYNTH`] and from the defaults.
const SYNTH_OPTIONS: [(&str, &str); 26] = [
    ("--output", "other.asc"),
    ("--seed", "2"),
    ("--rows", "30"),
    ("--cols", "30"),
    ("--spacing-m", "1.2"),
    ("--south-west-m", "-10,20"),
    ("--mean-elevation-m", "-3000"),
    ("--tilt-deg", "5"),
    ("--tilt-towards-deg", "-30"),
    ("--ground-hurst", "0.6"),
    ("--ground-rms-m", "0.2"),
    ("--ground-baseline-m", "2"),
    ("--crater-diameter-min-m", "5"),
    ("--crater-diameter-max-m", "25"),
    ("--crater-density-per-km2", "9000"),
    ("--crater-power-law-exponent", "2"),
    ("--crater-depth-law", "mars"),
    ("--crater-degradation-max", "0.2"),
    ("--rille-width-m", "20"),
    ("--rille-depth-m", "3"),
    ("--rille-wall-slope-deg", "20"),
    ("--rille-meander-amplitude-m", "5"),
    ("--rille-meander-length-m", "50"),
    ("--rock-abundance", "0.2"),
    ("--boulder-diameter-min-m", "2"),
    ("--boulder-diameter-max-m", "3"),
];

fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("arena.toml", ACROSS);
    desk.write_legs("four_legs.toml", FOUR_LEGS);
    // Two hops of its legs apart, without the limits that take most of the time.
    let light: String = FOUR_LEGS
        .lines()
        .filter(|line| !line.starts_with("spin_max") && !line.starts_with("force_max"))
        .collect::<Vec<_>>()
        .join("\n");
    desk.write("light_legs.toml", light);
    let walk = desk.read("map.toml").replace("goal_m = [15, 12]", "goal_m = [7, 7]\nroute = \"free\"");
    desk.write(
        "legs.toml",
        format!("[robot]\nfile = \"light_legs.toml\"\n\n{}", walk.replace("node_spacing_max_m = 1.0", "contacts_max = 60")),
    );
    desk.write("one_leg.toml", include_str!("../../data/robots/one_leg.toml"));
    desk.write("area.geojson", r#"{ "type": "Polygon", "coordinates": [[[0, 0], [12, 0], [12, 12], [0, 12], [0, 0]]] }"#);
    desk.write("other_map.toml", desk.read("map.toml").replace("= 0.8", "= 0.5"));
    desk.write("contacts.csv", "normal_x,normal_y,normal_z,friction_coefficient\n0,0,1,0.6\n1,0,0.2,0.4\n");
    desk.write("starts.csv", "x_m,y_m\n3,4\n15,16\n");
    desk.write("pairs.csv", "start_x_m,goal_x_m\n10,40\n40,0\n");
    let over_mesh = "mesh = \"plate.obj\"\nroute = \"free\"\nstart_m = [1, 1, 1]\ngoal_m = [7, 7, 2]";
    let space = desk.read("map.toml").replace("dem = \"ground.tif\"\nstart_m = [1, 2]\ngoal_m = [15, 12]", over_mesh);
    desk.write("space.toml", space.replace("node_spacing_max_m = 1.0", "contacts_max = 30"));
    desk.write("forward.csv", FORWARD_ONLY);
    desk.write("cases.csv", "hopper.takeoff_speed_max_m_s\n6\n9\n");
    std::fs::create_dir(desk.path().join("begun")).unwrap();
    desk.write(
        "begun/part-00000000-.csv",
        "case,key,hopper.takeoff_speed_max_m_s,verdict,hops,hops_lower_bound,flight_time_s,mission_time_s,energy_j_kg,delta_v_m_s,\
         peak_takeoff_speed_m_s,ground_distance_m,error\n0,,6,,,,,,,,,,refused\n",
    );
    desk.write("errors.toml", desk.read("scenario.toml") + ERRORS);
    // A path that the scenario in it would not be planned with.
    let planned = desk.json(&["plan", "errors.toml", "--set", "search.points_per_segment=3", "--set", "search.risk=ignored"]);
    let (points, none) = ("\"points_per_segment\":3", "\"points_per_segment\":0");
    let result = planned.to_string();
    assert!(result.contains(points), "{result}");
    desk.write("other_path.json", result.replace(points, none));
    // Walls too steep to rest on around a pit: the least capability to cross it is found by splitting cells.
    desk.write("pit.csv", "x_m,z_m\n0,0\n10,0\n11,-3\n20,-3\n21,0\n40,0\n");

    desk.write(
        "odd.csv",
        CHAIN.replace("z_m", "z_m,colour").replace(",2\n", ",2,red\n").replace(",0\n", ",0,\n").replace(",1\n", ",1,\n"),
    );
    desk
}

/// The options of a batch. What an earlier batch left is refused without its option.
const BATCH: [Trial; 5] = [
    (
        "--scenario",
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts"],
        &["batch", "cases.csv", "--scenario", "errors.toml", "-o", "parts"],
    ),
    (
        "--output",
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts"],
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "others"],
    ),
    (
        "--resume",
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "begun"],
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "begun", "--resume"],
    ),
    (
        "--collect",
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts"],
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts", "--collect", "all.csv"],
    ),
    (
        "--set",
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts"],
        &["batch", "cases.csv", "--scenario", "scenario.toml", "-o", "parts", "--set", "body.name=moon"],
    ),
];

/// The visible results of a run: status, both streams, every file.
fn seen(args: &[&str]) -> (Ran, BTreeMap<String, (u64, Vec<u8>)>) {
    let desk = desk();
    (desk.run(args), desk.files())
}

/// The long options in a command's help.
fn options(command: &str) -> BTreeSet<String> {
    let help = desk().run(&[command, "--help"]).stdout;
    let long = |line: &str| {
        let option = line.trim_start().trim_start_matches("-o, ").trim_start_matches("-v, ").split([' ', ',']).next()?.to_owned();
        (line.starts_with(' ') && option.starts_with("--") && option != OF_EVERY_COMMAND).then_some(option)
    };
    help.lines().filter_map(long).collect()
}

#[test]
fn every_option_changes_the_output() {
    let all = [
        ("run", &RUN[..]),
        ("slice", &SLICE),
        ("map", &MAP),
        ("sites", &SITES),
        ("hop", &HOP),
        ("check", &CHECK),
        ("plan", &PLAN),
        ("require", &REQUIRE),
        ("trade", &TRADE),
        ("compare", &COMPARE),
        ("report", &REPORT),
        ("simulate", &SIMULATE),
        ("batch", &BATCH),
        ("stance", &STANCE),
        ("arena", &ARENA),
        ("completions", &[]),
        ("man", &MAN),
    ];
    for (command, trials) in all {
        let tried: BTreeSet<_> = trials.iter().map(|trial| trial.0.to_owned()).collect();
        let elsewhere = |option: &str| {
            [&ON_A_PROJECTED_MAP[..], &ON_THE_TIME_ALONE, &ON_LARGE_INPUTS, &ON_MESHES, &ON_WHEELS, &ON_PARTS, &ON_MISSING_DATA]
                .concat()
                .contains(&option)
        };
        let here: BTreeSet<_> = options(command).into_iter().filter(|option| !elsewhere(option)).collect();
        assert_eq!(tried, here, "{command}: an option without a trial, or the reverse");
        for (option, without, with) in trials {
            let (before, after) = (seen(without), seen(with));
            assert_ne!(before.0.status, 101, "{without:?}");
            assert!(after.0.status < 2, "{with:?}: {:?}", after.0);
            assert!(before != after, "{command} {option} changes nothing: {:?}", after.0);
        }
    }
    assert!(options("bodies").is_empty() && options("schema").is_empty());
}

#[test]
fn threads_change_nothing() {
    for words in [
        &["check", "scenario.toml"][..],
        &["check", "scenario.toml", "--pairs", "pairs.csv", "--format", "json"],
        &["plan", "scenario.toml", "--verify", "--plot", "path.svg"],
        &["run", "scenario.toml", "-o", "out"],
        &["simulate", "errors.toml", "--compare", "--plot", "trials.svg"],
    ] {
        let expected = seen(words);
        assert_eq!(expected.0.status, 0, "{words:?}: {:?}", expected.0);
        for threads in ["0", "1", "2", "7"] {
            let (ran, files) = seen(&[words, &["--threads", threads]].concat());
            assert_eq!(ran, expected.0, "{words:?} with {threads} threads");
            assert!(files.keys().eq(expected.1.keys()), "{words:?} with {threads} threads");
            assert!(files.values().map(|file| &file.1).eq(expected.1.values().map(|file| &file.1)), "{words:?}: {threads} threads");
        }
        assert_eq!(desk().run(&[words, &["--threads", "many"]].concat()).status, 2);
    }
}

#[test]
fn every_option_of_synth_changes_the_ground() {
    let base = &SYNTH[..];
    let switches = ["--craters", "--rille", "--boulders", "--no-ground", "--boulder-burial", "--mesh"];
    let tried = SYNTH_OPTIONS.iter().map(|option| option.0).chain(switches);
    assert_eq!(tried.map(str::to_owned).collect::<BTreeSet<_>>(), options("synth"));
    let desk = desk();
    let ground = |args: &[&str]| {
        let ran = desk.run(args);
        assert_eq!(ran, Ran { status: 0, stdout: String::new(), stderr: String::new() }, "{args:?}");
        let name = if args.contains(&"other.asc") { "other.asc" } else { "new.asc" };
        let bytes = desk.read(name);
        std::fs::remove_file(desk.path().join(name)).unwrap();
        (name.to_owned(), bytes)
    };
    let before = ground(base);
    assert!(before == ground(base), "the same options give the same bytes");
    for (option, value) in SYNTH_OPTIONS.into_iter().chain([("--boulder-burial", "0.6")]) {
        let mut with = base.to_vec();
        // In place of the present value, or appended.
        let short = if option == "--output" { "-o" } else { option };
        match with.iter().position(|known| *known == short) {
            Some(at) => with[at + 1] = value,
            None => with.extend([option, value]),
        }
        assert!(before != ground(&with), "{option} changes nothing");
    }
    assert!(before != ground(&[base, &["--no-ground"]].concat()), "--no-ground changes nothing");
    let bare = ["synth", "-o", "new.asc", "--rows", "40", "--cols", "40"];
    for switch in ["--craters", "--rille", "--boulders"] {
        assert!(ground(&bare) != ground(&[&bare[..], &[switch]].concat()), "{switch} changes nothing");
    }
    assert_eq!(desk.run(&["synth", "-o", "new.asc", "--quiet"]).status, 2);
    let mesh = |scene: &str, seed: &str| {
        assert_eq!(desk.run(&["synth", "--mesh", scene, "--seed", seed, "-o", "new.obj"]).status, 0, "{scene}");
        desk.read("new.obj")
    };
    let meshes = [("cave", "1"), ("cave", "2"), ("overhang", "1"), ("rubble", "1")].map(|(scene, seed)| mesh(scene, seed));
    assert!(meshes[0] == mesh("cave", "1"), "the same options give the same bytes");
    assert!((1..4).all(|i| !meshes[..i].contains(&meshes[i])), "--mesh or --seed changes nothing");
    let ran = desk.run(&["synth", "--mesh", "cave", "-o", "new.tif"]);
    assert!(ran.status == 2 && ran.stderr.contains("expected .obj, .stl or .ply"), "{}", ran.stderr);
    assert_eq!(desk.run(&["synth", "--mesh", "cave", "--rows", "9", "-o", "new.obj"]).status, 2);
}

#[test]
fn every_help_text_shows_units_defaults_and_an_example() {
    let desk = desk();
    for command in COMMANDS {
        let ran = desk.run(&[command, "--help"]);
        assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
        assert!(ran.stdout.contains("Example:\n  chta "), "{command}: no example");
        // One block per option: its own line and its description below.
        let mut blocks: Vec<String> = Vec::new();
        for paragraph in ran.stdout.split("\n\n").skip_while(|paragraph| !paragraph.starts_with("Options:")) {
            let paragraph = paragraph.trim_start_matches("Options:\n");
            match blocks.last_mut() {
                Some(last) if !paragraph.trim_start().starts_with('-') => last.push_str(paragraph),
                _ => blocks.push(paragraph.to_owned()),
            }
        }
        let is_small = ["bodies", "completions", "man", "schema"].contains(&command);
        assert!(is_small || blocks.len() > 3, "{command}: {blocks:?}");
        for block in blocks {
            let one_line = block.split_whitespace().collect::<Vec<_>>().join(" ");
            let name = one_line.trim_start_matches("-o, ").split([' ', ',']).next().unwrap().to_owned();
            let units = [("-m-s2", "m/s^2"), ("-km2", "square kilometre"), ("-deg", "degrees"), ("-m", " m ")];
            if let Some((_, unit)) = units.into_iter().find(|(suffix, _)| name.ends_with(suffix)) {
                assert!(format!("{one_line} ").contains(unit), "{command} {name} does not name its unit: {one_line}");
            }
            let required = ["--from", "--to", "--vary", "--output", "--from-lonlat", "--to-lonlat"].contains(&name.as_str());
            let takes_value =
                one_line.contains('<') && !["--scenario", "--set", "--body", "--gravity-m-s2"].contains(&name.as_str());
            let writes = [
                "--geojson",
                "--plot",
                "--plot-front",
                "--plot-postures",
                "--plot-map",
                "--density",
                "--plot-density",
                "--pairs",
                "--starts",
                "--amount-output",
                "--nearest-output",
                "--predecessor-output",
                "--effort-output",
                "--return-output",
                "--mobility",
                "--paths",
                "--profiles",
                "--report",
                "--trajectory",
            ]
            .contains(&name.as_str());
            assert!(
                !takes_value || required || writes || one_line.contains("[default: "),
                "{command} {name} states no default: {one_line}"
            );
        }
    }
}

#[test]
fn the_help_of_every_question_names_where_spacing_and_angles_change_the_answer() {
    let desk = desk();
    for command in COMMANDS.into_iter().filter(|command| !["bodies", "synth", "completions", "man", "schema"].contains(command)) {
        let help = desk.run(&[command, "--help"]).stdout;
        let said = help.split("Where spacing and the choice of angles change the answer:\n").nth(1).unwrap_or_default();
        let said = said.split("\n\n").next().unwrap_or_default();
        assert!(
            command == "slice" || command == "report" || (said.contains("Spacing") && said.contains("ngles")),
            "{command}: {help}"
        );
        assert!(!said.is_empty() && said.lines().all(|line| line.starts_with("  ") && line.len() <= 100), "{command}: {said}");
        // What it names by name is an option or a key.
        for name in said.split(|c: char| c.is_whitespace() || "(),;:".contains(c)).filter(|word| word.starts_with("--")) {
            assert!(help.contains(&format!(" {name}")), "{command} has no {name}");
        }
    }
}

/// The example in a command's help, split into words.
fn example(command: &str) -> Vec<String> {
    let help = desk().run(&[command, "--help"]).stdout;
    let line = help.split("Example:\n  chta ").nth(1).unwrap().lines().next().unwrap().to_owned();
    line.split_whitespace().map(str::to_owned).collect()
}

#[cfg(unix)]
#[test]
fn every_example_runs() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    for command in COMMANDS {
        let words = example(command);
        assert_eq!(words[0], command);
        let missing = words.iter().find(|word| word.starts_with("data/") && !data.join(&word["data/".len()..]).exists());
        if let Some(missing) = missing {
            eprintln!("skipped: the example of chta {command} needs {missing}, which is not there");
            continue;
        }
        let desk = desk();
        if data.exists() {
            std::os::unix::fs::symlink(&data, desk.path().join("data")).unwrap();
        }
        if command == "report" {
            assert_eq!(desk.run(&["run", "scenario.toml", "-o", "out"]).status, 0);
        }
        let ran = desk.run(&words.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(ran.status < 2 && !ran.stderr.contains("error"), "chta {}: {ran:?}", words.join(" "));
    }
}

/// Options keep working under the names that they once had.
#[test]
fn a_former_name_of_an_option_means_the_same() {
    const FORMER: [(&str, &str, &[&str]); 5] = [
        ("--budget", "--prove-cells-max", &["check", "scenario.toml", "--prove"]),
        ("--budget", "--prove-cells-max", &["plan", "scenario.toml", "--prove"]),
        ("--budget", "--prove-cells-max", &["trade", "scenario.toml", "--vary", VARY, "--prove"]),
        ("--budget", "--prove-cells-max", &["compare", "scenario.toml", "map.toml", "--prove"]),
        ("--budget", "--prove-cells-max", &["require", "scenario.toml", "--vary", "surface.friction_coefficient"]),
    ];
    let desk = Desk::with_dem();
    for (former, name, words) in FORMER {
        let run = |option: &str| desk.run(&[words, &[option, "9", "--format", "json"]].concat());
        let (ran, before) = (run(name), run(former));
        assert!(ran.status < 2, "{words:?}: {ran:?}");
        assert_eq!((ran.status, ran.stdout), (before.status, before.stdout), "{words:?} {former}");
    }
}

/// A position of another terrain is refused with what each terrain takes.
#[test]
fn a_position_with_too_many_numbers_is_refused_with_what_each_terrain_takes() {
    let vary = ["--vary", VARY];
    let commands: [(&str, &[&str], &[&str]); 6] = [
        ("check", &["--start", "--goal"], &[]),
        ("plan", &["--start", "--goal"], &[]),
        ("simulate", &["--start", "--goal"], &[]),
        ("require", &["--start", "--goal"], &["--vary", "hopper.takeoff_speed_max_m_s"]),
        ("trade", &["--start", "--goal"], &vary),
        ("hop", &["--from", "--to"], &[]),
    ];
    let desk = Desk::new();
    for (command, options, more) in commands {
        for (option, (text, count)) in options.iter().flat_map(|option| [("1,2", 2), ("-1,2,3", 3)].map(|of| (option, of))) {
            let ran = desk.run(&[&[command, "scenario.toml", option, text], more].concat());
            let sentence = ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
            let expected = format!(
                "found `{text}` ({count} numbers), expected one number in metres, X, such as 12.5: a position is X along a chain, X,Y on a \
                 map and X,Y,Z on a mesh"
            );
            assert!(ran.status == 2 && sentence.contains(&expected) && sentence.contains(option), "{command} {option}: {ran:?}");
        }
    }
}
