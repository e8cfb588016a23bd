//! Progress and cancellation of every stage: reports come often enough, a break at any of them ends the stage with an error and
//! next to no more work, and answers do not depend on whether anything is reported.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use std::{fmt::Debug, ops::ControlFlow, path::Path, sync::Mutex};

use chta::{
    chain::{ConstrainedChain, PolygonalChain, Station},
    graph::{
        CostToGo, NodeSet, PointSpacing, ReliabilityOptions, RiskModel, SearchError, SearchOptions, most_reliable_paths,
        proof::{BoundsOptions, CapabilityRange, ProofVerdict, bounds, least_capability},
        reachable, search, search_most_reliable, search_pairs,
    },
    ground::DemGround,
    hop::{HopTest, Split},
    path::generate,
    progress::{Cancelled, PAIRS_PER_REPORT, Progress, Stage, Step},
    quantity::{ChainPoint, MapPoint},
    reach::{
        FanError, FanRequest, fan,
        map::{Journey, MapError, Post, PostHops, Search, mobility, search as search_map},
    },
    scenario::{Entries, Scenario},
    study::{Survey, SweptKey, Trade, TradeError},
    terrain::{OverlaidDem, Overlays, SyntheticTerrain, synthesise},
    uncertainty::{Mission, Simulation, SimulationError, TrialOptions, Uncertainty},
    world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};

/// Keeps every report, and cancels at one of them.
struct Recorder {
    /// Counted from 1.
    cancel_at: Option<usize>,
    steps: Mutex<Vec<Step>>,
}

impl Recorder {
    const fn new(cancel_at: Option<usize>) -> Self {
        Self { cancel_at, steps: Mutex::new(Vec::new()) }
    }

    fn steps(self) -> Vec<Step> {
        self.steps.into_inner().unwrap()
    }
}

impl Progress for Recorder {
    fn report(&self, step: &Step) -> ControlFlow<()> {
        let mut steps = self.steps.lock().unwrap();
        steps.push(*step);
        if Some(steps.len()) == self.cancel_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// What kept a stage from its answer; anything but a cancellation fails the test.
trait Stopped: Debug {
    fn cancelled(&self) -> Option<Cancelled>;
}

impl Stopped for Cancelled {
    fn cancelled(&self) -> Option<Cancelled> {
        Some(*self)
    }
}

macro_rules! stopped {
    ($($error:ident),*) => {
        $(impl Stopped for $error {
            fn cancelled(&self) -> Option<Cancelled> {
                if let Self::Cancelled(cancelled) = self { Some(*cancelled) } else { None }
            }
        })*
    };
}

stopped!(SearchError, MapError, FanError, SimulationError, TradeError);

/// Runs a stage without progress, with it, and cancelled at several of its reports, on one thread and on several.
fn holds<T: Debug + Send, E: Stopped + Send>(
    stages: &[Stage],
    least_reports: usize,
    run: impl Fn(&dyn Progress) -> Result<T, E> + Sync,
) {
    let expected = format!("{:?}", run(&()).unwrap());
    for threads in [1, 4] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let recorder = Recorder::new(None);
        let answer = pool.install(|| run(&recorder)).unwrap();
        assert!(format!("{answer:?}") == expected, "{stages:?}: another answer on {threads} threads with reports");
        let steps = recorder.steps();
        let count = steps.len();
        assert!(count >= least_reports, "{stages:?}: {count} reports");
        for stage in stages {
            assert!(steps.iter().any(|step| step.stage == *stage), "no report of {stage}");
        }
        assert_often_enough(&steps);
        for cancel_at in [1, 2, 3, count / 3, count / 2, count - 1] {
            let recorder = Recorder::new(Some(cancel_at));
            let error = pool.install(|| run(&recorder)).err().unwrap_or_else(|| {
                panic!("{stages:?} answers although cancelled at report {cancel_at} of {count}");
            });
            let cancelled = error.cancelled().unwrap_or_else(|| panic!("{stages:?}: {error:?}"));
            let steps = recorder.steps();
            let last = steps[cancel_at - 1];
            assert_eq!(cancelled.stage, last.stage, "report {cancel_at} of {count}");
            // Only reports that other threads had begun.
            assert!(steps.len() - cancel_at < threads, "{last:?}: {} reports more on {threads} threads", steps.len() - cancel_at);
            let work_after = cancelled.pairs - last.pairs;
            assert!(work_after <= PAIRS_PER_REPORT, "{last:?}: {work_after} pairs more on {threads} threads");
            if last.of.is_some() {
                let done_after = cancelled.done.saturating_sub(last.done);
                assert!(done_after <= threads as u64, "{last:?}: {done_after} more on {threads} threads");
            }
        }
    }
}

/// Whether reports of a stage are never more than so many pairs apart.
fn assert_often_enough(steps: &[Step]) {
    let mut most: Option<Step> = None;
    for &step in steps {
        // Another run of the stage counts anew.
        if let Some(before) = most.filter(|before| before.stage == step.stage && before.pairs <= step.pairs) {
            assert!(step.pairs - before.pairs <= PAIRS_PER_REPORT, "{before:?} and then {step:?}");
        }
        most = Some(step);
    }
}

fn surface() -> SurfaceProperties {
    SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.0).unwrap())), rest: RestSlope::AsFrictionHolds }
}

/// Rolling ground, 400 m of it, for 4 m/s under 1 m/s^2: 16 m a hop.
fn chain() -> ConstrainedChain {
    let points = (0..=400).map(|i| ChainPoint::new(f64::from(i), 0.3 * f64::from(i * i % 7) - 0.2 * f64::from(i % 3))).collect();
    let hopper = Hopper::with_speeds(4.0, 4.0).unwrap();
    ConstrainedChain::new(PolygonalChain::bare(points).unwrap(), &hopper, Gravity::new(1.0).unwrap(), &surface()).unwrap()
}

fn ends(test: &HopTest) -> (Station, Station) {
    let station = |x_m| test.chain().geometry().station(x_m).unwrap();
    (station(3.0), station(390.0))
}

fn ground(side: usize) -> DemGround {
    let dem = synthesise(&SyntheticTerrain { rows: side, cols: side, ..SyntheticTerrain::default() }).unwrap();
    let hopper = Hopper::with_speeds(3.0, 3.0).unwrap();
    DemGround::new(OverlaidDem::new(dem, Overlays::default()), &hopper, Gravity::new(1.0).unwrap(), &surface())
}

#[test]
fn searches_over_a_chain() {
    let test = HopTest::new(chain());
    let (start, goal) = ends(&test);
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(15)), ..SearchOptions::default() };
    holds(&[Stage::Search], 20, |progress| search(&test, start, goal, &options, progress));
    holds(&[Stage::Search], 20, |progress| search_pairs(&test, &[(start, goal), (goal, start)], &options, progress));
    holds(&[Stage::Reachability], 20, |progress| reachable(&test, start, PointSpacing::PerSegment(15), progress));
}

#[test]
fn a_search_that_finds_no_path() {
    let mut points: Vec<_> = (0..=300).map(|i| ChainPoint::new(f64::from(i), 0.1 * f64::from(i % 5))).collect();
    // A wall of 60 m.
    points.extend((301..=400).map(|i| ChainPoint::new(f64::from(i), 60.0 + 0.1 * f64::from(i % 5))));
    let hopper = Hopper::with_speeds(4.0, 4.0).unwrap();
    let geometry = PolygonalChain::bare(points).unwrap();
    let test = HopTest::new(ConstrainedChain::new(geometry, &hopper, Gravity::new(1.0).unwrap(), &surface()).unwrap());
    let (start, goal) = ends(&test);
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(7)), ..SearchOptions::default() };
    assert_eq!(search(&test, start, goal, &options, &()).unwrap().hops(), None);
    holds(&[Stage::Search], 10, |progress| search(&test, start, goal, &options, progress));
}

#[test]
fn costs_to_go_and_reliability() {
    let test = HopTest::new(chain());
    let (start, goal) = ends(&test);
    let spacing = PointSpacing::PerSegment(3);
    let options = SearchOptions { spacing: Some(spacing), ..SearchOptions::default() };
    let reliability = ReliabilityOptions { model: RiskModel::Slack, extra_hops_max: Some(1), goal_tolerance_m: Some(0.5) };
    let nodes = NodeSet::new(test.chain(), start, goal, spacing).unwrap();
    holds(&[Stage::CostToGo], 5, |progress| CostToGo::of(&test, nodes.clone(), &options, progress));
    holds(&[Stage::CostToGo, Stage::Reliability], 10, |progress| {
        CostToGo::with_reliability(&test, nodes.clone(), &options, &reliability, progress)
    });
    holds(&[Stage::Reliability], 5, |progress| most_reliable_paths(&test, &nodes, &options, &reliability, progress));
    holds(&[Stage::Search, Stage::Reliability], 10, |progress| {
        search_most_reliable(&test, start, goal, &options, &reliability, progress)
    });
}

#[test]
fn proofs_and_required_values() {
    let test = HopTest::new(chain());
    let (start, goal) = ends(&test);
    let options = BoundsOptions { budget_cells: 4000, explain: true, ..BoundsOptions::default() };
    holds(&[Stage::Proof], 10, |progress| bounds(&test, start, goal, &options, progress));
    let range = CapabilityRange { weakest: 0.5, strongest: 8.0, resolution: 0.2 };
    holds(&[Stage::Requirement, Stage::Proof], 20, |progress| {
        let mut verdict = |speed_m_s: f64| {
            let hopper = Hopper::with_speeds(speed_m_s, speed_m_s).unwrap();
            let chain = ConstrainedChain::new(test.chain().geometry().clone(), &hopper, Gravity::new(1.0).unwrap(), &surface());
            let test = HopTest::new(chain.unwrap());
            Ok::<ProofVerdict, SearchError>(bounds(&test, start, goal, &options, progress)?.verdict())
        };
        least_capability(range, &mut verdict, progress)
    });
}

#[test]
fn maps() {
    let hops = PostHops::new(ground(80), 1).unwrap();
    let start = Post { row: 40, col: 40 };
    for journey in [Journey::Outbound, Journey::Return] {
        let asked = Search { journey, ..Search::default() };
        let stage = if journey == Journey::Outbound { Stage::MapLayers } else { Stage::ReturnLayers };
        holds(&[stage], 10, |progress| search_map(&hops, &[start.into()], asked, progress));
    }
    holds(&[Stage::Mobility], 25, |progress| {
        // NaN, which is not equal to itself, marks posts without a value.
        mobility(&hops, progress).map(|found| (found.share, found.directions))
    });
}

#[test]
fn fans() {
    let ground = ground(120);
    let from = MapPoint::new(60.0, 60.0);
    let request = FanRequest { ground: &ground, from, headings: 12, length_m: 50.0, spacing: PointSpacing::PerSegment(7) };
    holds(&[Stage::Fan], 13, |progress| fan(&request, progress));
}

#[test]
fn trials() {
    let test = HopTest::new(chain());
    let (start, goal) = ends(&test);
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(1)), ..SearchOptions::default() };
    let answer = search(&test, start, goal, &options, &()).unwrap();
    let chta::graph::Outcome::Path { legs, .. } = answer.outcome else { panic!("no path") };
    let path = generate(&test, &legs, options.takeoff, Split::FullReach).unwrap();
    let errors = Uncertainty { takeoff_speed_sigma_fraction: 0.01, ..Uncertainty::NONE };
    let simulation = Simulation::new(&Mission::along_chain(test, path, start, goal), errors).unwrap();
    let options = TrialOptions { trials: 9500, ..TrialOptions::default() };
    let runs = |progress: &dyn Progress| simulation.run(&options, &mut (), progress);
    holds(&[Stage::Trials], 11, runs);
    // A batch is complete or not flown at all.
    let recorder = Recorder::new(Some(4));
    let error = simulation.run(&options, &mut (), &recorder).unwrap_err();
    assert_eq!(error.cancelled().unwrap().done, 3000);
    assert_eq!(error.to_string(), "the simulation was cancelled after 3000 trials");
}

#[test]
fn trade_grids() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenarios");
    let source = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 4.0\nlanding_speed_max_m_s = 4.0\n[surface]\nfriction_coefficient = 0.8\n\
                  [terrain]\nchain = \"../chains/rolling_100.csv\"\nstart_x_m = 5.0\ngoal_x_m = 90.0\n[search]\npoints_per_segment = 3\n";
    let entries = Entries::from_toml(source);
    let swept = [SweptKey::parse("hopper.takeoff_speed_max_m_s=3:9:7").unwrap()];
    let first = Scenario::new(Trade::first_cell(&entries, &swept, "varied").unwrap()).unwrap();
    let survey = Survey::of(&first, first.terrain.as_ref().unwrap(), &folder).unwrap();
    let trade = Trade::new(&entries, &folder, &survey, &swept).unwrap();
    for budget_cells in [None, Some(500)] {
        holds(&[Stage::Trade], 8, |progress| trade.run(budget_cells, progress).map(|cells| cells.answer.rows));
    }
}
