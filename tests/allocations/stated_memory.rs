//! The bytes that a map or a fan states before it is computed bound what it holds at any report of its progress.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its scene should stop")]

use std::{
    ops::ControlFlow,
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
};

use chta::{
    progress::{Progress, Step},
    quantity::MapPoint,
    scenario::{Entries, Scenario},
    study::{
        fan::{FanQuestion, PreparedFan},
        map::{MapQuestion, NamedPlace, PreparedMap},
    },
    terrain::MapPlace,
};
use stats_alloc::Region;

use crate::{ALLOCATOR, alone};

/// The most bytes held since a region began, as seen at its reports.
struct Peak<'a> {
    region: Region<'a, std::alloc::System>,
    most: AtomicU64,
    reports: AtomicU64,
}

impl Peak<'_> {
    fn begin() -> Self {
        Self { region: Region::new(ALLOCATOR), most: AtomicU64::new(0), reports: AtomicU64::new(0) }
    }

    fn look(&self) {
        let change = self.region.change();
        self.most.fetch_max(change.bytes_allocated.saturating_sub(change.bytes_deallocated) as u64, Ordering::Relaxed);
        self.reports.fetch_add(1, Ordering::Relaxed);
    }

    /// What was seen: bytes, of which some are those of the run-time itself.
    fn most(&self) -> u64 {
        self.most.load(Ordering::Relaxed)
    }
}

impl Progress for Peak<'_> {
    fn report(&self, _: &Step) -> ControlFlow<()> {
        self.look();
        ControlFlow::Continue(())
    }
}

/// Bytes of thread pools, names and messages, which no model counts.
const RUN_TIME: u64 = 256 << 10;

const KEYS: &str = "[body]\nname = \"mars\"\n[surface]\nfriction_coefficient = 0.6\n[hopper]\n";

fn scenario(hopper: &str) -> Scenario {
    Scenario::new(Entries::from_toml(&format!("{KEYS}{hopper}"))).unwrap()
}

fn start(x_m: f64, y_m: f64) -> NamedPlace {
    NamedPlace { name: "start".to_owned(), place: MapPlace::Metres(MapPoint::new(x_m, y_m)) }
}

#[test]
fn a_map_holds_at_most_the_bytes_that_it_states() {
    let _guard = alone();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/terrain/mars_crater_field.tif");
    // Speeds, footprint, stride, and the maps beside the hops.
    for (speed_m_s, footprint, stride, [effort, returns, mobility, predecessors], starts) in [
        (4.0, "", 1, [false; 4], 1),
        (4.0, "", 1, [true; 4], 3),
        (6.0, "clearance_m = 0.2\n", 1, [true, false, false, true], 1),
        (4.0, "footprint_m = 3.0\n", 1, [false, true, false, false], 2),
        (9.0, "", 3, [true; 4], 3),
        // Nodes finer than posts, and least totals.
        (4.0, "[search]\nnode_spacing_max_m = 0.5\n", 1, [false, true, false, true], 1),
        (4.0, "[search]\nobjective = [\"energy\", \"hops\"]\n", 1, [false; 4], 3),
        // Replanned trials, by costs and by risks.
        (4.0, "[uncertainty]\ntrials = 20\n", 1, [false; 4], 1),
        (4.0, "[uncertainty]\ntrials = 20\ntakeoff_speed_sigma_fraction = 0.02\n", 1, [true, false, false, false], 1),
    ] {
        let scenario = scenario(&format!("takeoff_speed_max_m_s = {speed_m_s}\nlanding_speed_max_m_s = {speed_m_s}\n{footprint}"));
        let question = MapQuestion {
            scenario: &scenario,
            base: Path::new(""),
            dem: &data,
            starts: [start(96.0, 84.0), start(20.0, 20.0), start(170.0, 150.0)][..starts].to_vec(),
            goals: if footprint.contains("trials") { vec![start(112.0, 84.0)] } else { Vec::new() },
            stride,
            auto_nodes: false,
            effort,
            returns,
            mobility,
            ranks_sites: false,
            predecessors,
            refusals: false,
            trials: footprint.contains("trials"),
            hops_max: None,
            amounts: Vec::new(),
            memory_max_bytes: None,
        };
        let peak = Peak::begin();
        let prepared = PreparedMap::new(&question).unwrap();
        let study = prepared.answered(&question, &peak).unwrap();
        peak.look();
        let (stated, held) = (prepared.memory.bytes(), peak.most());
        let what = format!("{speed_m_s} m/s, stride {stride}, {starts} starts: {held} bytes held, {stated} stated");
        assert!(study.answer.reachable_posts > 100 && peak.reports.load(Ordering::Relaxed) > 10, "{what}");
        assert!(held <= stated + RUN_TIME, "{what}");
        // Of a round of least totals the bound counts all hops, of which few improve on what is known.
        let within = if footprint.contains("objective") { 16 } else { 8 };
        assert!(within * held > stated, "the bound is far off: {what}");
        // The bound is kept, and what is below it is refused.
        let limited = |bytes| PreparedMap::new(&MapQuestion { memory_max_bytes: Some(bytes), ..question.clone() });
        assert!(limited(stated).is_ok() && limited(stated - 1).is_err() && limited(1 << 10).is_err(), "{what}");
    }
}

#[test]
fn a_fan_holds_at_most_the_bytes_that_it_states() {
    let _guard = alone();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/terrain/mars_crater_field.tif");
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for (hopper, spacing) in [
        ("takeoff_speed_max_m_s = 4.0\nlanding_speed_max_m_s = 4.0\n", "points_per_segment = 1"),
        ("takeoff_speed_max_m_s = 4.0\nlanding_speed_max_m_s = 4.0\nclearance_m = 0.2\n", "points_per_segment = 7"),
        ("takeoff_speed_max_m_s = 4.0\nlanding_speed_max_m_s = 4.0\n", "node_spacing_max_m = 0.05"),
    ] {
        let scenario = scenario(&format!("{hopper}[search]\n{spacing}\n"));
        let question = FanQuestion {
            scenario: &scenario,
            base: Path::new(""),
            dem: &data,
            from: MapPlace::Metres(MapPoint::new(96.0, 84.0)),
            headings: 8,
            length_m: 90.0,
            memory_max_bytes: None,
        };
        let peak = Peak::begin();
        one.install(|| {
            let prepared = PreparedFan::new(&question).unwrap();
            let size = prepared.size(&question, &()).unwrap();
            let study = prepared.answered(&question, &peak).unwrap();
            let (stated, held) = (size.bytes_max, peak.most());
            let what = format!("{spacing}: {held} bytes held, {stated} stated for {} nodes", size.nodes);
            assert!(study.answer.rays.len() == 8 && peak.reports.load(Ordering::Relaxed) > 8, "{what}");
            assert!(held <= stated + RUN_TIME && 16 * held > stated, "{what}");
            assert!(size.pairs_max >= size.nodes, "{what}");
            let limited = |bytes| prepared.answered(&FanQuestion { memory_max_bytes: Some(bytes), ..question }, &());
            assert!(limited(stated).is_ok() && limited(stated - 1).is_err(), "{what}");
        });
    }
}
