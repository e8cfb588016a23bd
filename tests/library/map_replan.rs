//! Replanning over the posts of a map: costs-to-go against searches in the direction of the hops, and the flights by them.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]

use std::sync::Arc;

use chta::{
    ballistics::TakeoffChoice,
    graph::Effort,
    ground::{DemGround, Surface, Windows},
    path::HopPath,
    quantity::{Angle, MapPoint},
    reach::map::{Post, PostHops, Search, costs_to_go, joined, path_hops, risks_flown_over, risks_to_go, search},
    terrain::{Dem, GeoReference, read_keep_out},
    uncertainty::{HopRecord, Mission, Observer, Policy, Simulation, Summary, TrialOptions, TrialOutcome, Uncertainty},
    world::{Derating, Hopper, HopperLimits},
};

use crate::{
    map_world::{World, friction, random_dem, random_hopper, random_surface},
    support::Draw,
};

const ERRORS: Uncertainty = Uncertainty {
    takeoff_speed_sigma_fraction: 0.02,
    takeoff_angle_sigma: Angle::from_radians(0.017),
    heading_sigma: Angle::from_radians(0.017),
    ..Uncertainty::NONE
};

const REPLAN: TrialOptions = TrialOptions {
    first_trial: 0,
    trials: 40,
    seed: 3,
    policy: Policy::Replan,
    hop_limit: None,
    goal_tolerance_m: 1.0,
    until_half_width: None,
    trajectories: 0,
};

/// Keeps every hop.
#[derive(Default)]
struct Hops(Vec<HopRecord>);

impl Observer for Hops {
    fn wants_records(&self) -> bool {
        true
    }

    fn hop(&mut self, hop: &HopRecord) {
        self.0.push(*hop);
    }
}

fn random_world(draw: &mut Draw) -> World {
    let (hopper, gravity_m_s2) = random_hopper(draw);
    World::new(random_dem(draw, 8), hopper, random_surface(draw), gravity_m_s2)
}

/// The path of fewest hops from a post to another.
fn path(hops: &PostHops, start: Post, goal: Post, choice: TakeoffChoice) -> Option<HopPath> {
    let map = search(hops, &[start.into()], Search::default(), &()).unwrap();
    let nodes = map.path(hops, goal)?;
    let path = joined(hops, &path_hops(hops, &nodes, choice).unwrap());
    (!path.hops.is_empty()).then_some(path)
}

fn mission(hops: &PostHops, path: &HopPath) -> Mission {
    let (first, last) = (path.hops.first().unwrap(), path.hops.last().unwrap());
    Mission::over_dem(hops.ground().clone(), path.clone(), first.takeoff, last.landing)
}

fn fly(mission: &Mission, errors: Uncertainty, options: TrialOptions) -> (Summary, Vec<HopRecord>) {
    let mut flown = Hops::default();
    let summary = Simulation::new(mission, errors).unwrap().run(&options, &mut flown, &()).unwrap();
    (summary, flown.0)
}

/// Searched from every post towards the goal, one by one.
#[test]
fn the_cost_to_go_of_every_post_is_that_of_a_search_from_it() {
    let draw = &mut Draw::seeded(1609);
    let (mut reached, mut cut_off) = (0, 0);
    for number in 0..24 {
        let world = random_world(draw);
        let Ok(hops) = PostHops::new(world.ground(), 1 + number % 2) else { continue };
        let lattice = hops.lattice();
        let Some(goal) = hops.nearest_usable(Post { row: lattice.rows / 2, col: lattice.cols / 3 }) else { continue };
        let criterion = (Effort::ALL[number % 4], TakeoffChoice::ALL[number / 4 % 4]);
        let to_go = costs_to_go(&hops, goal, criterion, &()).unwrap();
        let risks = risks_to_go(&hops, goal, (&ERRORS, criterion.1), &()).unwrap();
        for post in (0..lattice.count()).map(|index| lattice.node(index)) {
            let asked = Search { effort: Some(criterion), ..Search::default() };
            let out = search(&hops, &[post.into()], asked, &()).unwrap();
            let at_goal = lattice.index(goal);
            let expected = u64::try_from(out.hops[at_goal]).ok();
            let found = to_go.of_post(post);
            assert_eq!(found.map(chta::graph::Cost::hops), expected, "{number}: {post:?} to {goal:?}");
            let risk = risks.of_post(post);
            assert_eq!(risk.is_finite(), found.is_some(), "{number}: {post:?} to {goal:?}");
            let Some(cost) = found else {
                cut_off += 1;
                continue;
            };
            // Of a path of fewest hops the least effort is one number, summed here from the other end.
            let (found, expected) = (cost.effort(), out.effort[at_goal]);
            assert!((found - expected).abs() <= 1e-9 * (1.0 + expected), "{number}: {post:?}: {found}, expected {expected}");
            #[expect(clippy::cast_precision_loss, reason = "a few hops")]
            let least = 0.02 * cost.hops() as f64;
            assert!(risk >= least - 1e-12, "{number}: {post:?}: {risk} for {} hops", cost.hops());
            reached += u32::from(post != goal);
        }
    }
    assert!(reached > 200 && cut_off > 50, "{reached} reached, {cut_off} cut off");
}

/// Without errors: by the costs as many hops as planned; by the risks more or fewer, but never in a circle.
#[test]
fn exact_flights_by_costs_and_by_risks_arrive() {
    let draw = &mut Draw::seeded(1610);
    let mut flown = 0;
    for number in 0..40 {
        let world = random_world(draw);
        let Ok(hops) = PostHops::new(world.ground(), 1) else { continue };
        let lattice = hops.lattice();
        let choice = TakeoffChoice::ALL[number % 4];
        let post = |draw: &mut Draw| lattice.node(draw.below(lattice.count()));
        let (Some(start), Some(goal)) = (hops.nearest_usable(post(draw)), hops.nearest_usable(post(draw))) else { continue };
        let Some(path) = path(&hops, start, goal, choice) else { continue };
        let mission = mission(&hops, &path);
        let by_cost = Arc::new(costs_to_go(&hops, goal, (Effort::default(), choice), &()).unwrap());
        let by_risk = Arc::new(risks_to_go(&hops, goal, (&ERRORS, choice), &()).unwrap());
        let options = TrialOptions { trials: 1, goal_tolerance_m: 0.01, hop_limit: Some(500), ..REPLAN };
        for (name, mission, is_planned) in [
            ("costs", mission.clone().with_replanning_over_posts(by_cost), true),
            ("risks", mission.with_reliable_replanning_over_posts(by_risk), false),
        ] {
            let (summary, records) = fly(&mission, Uncertainty::NONE, options);
            // A hop that only just keeps a limit may be refused from where it really begins, a rounding away.
            let is_close = summary.outcomes.of(TrialOutcome::Reached) == 0;
            assert_eq!(summary.outcomes.of(TrialOutcome::HopLimit), 0, "{number}, {name}: in a circle");
            assert!(!is_planned || is_close || records.len() == path.hops.len(), "{number}, {name}: {} hops", records.len());
            flown += u32::from(!is_close);
        }
    }
    assert!(flown > 30, "only {flown} flights arrived");
}

/// A flat floor with a wall across it that has one gap: of no-data, or of a keep-out zone.
fn walled(is_void: bool) -> DemGround {
    let (rows, cols) = (24, 24);
    let is_wall = |row: usize, col: usize| (10..=13).contains(&row) && !(16..=20).contains(&col);
    let height = |index: usize| if is_void && is_wall(index / cols, index % cols) { f64::NAN } else { 0.0 };
    let heights = (0..rows * cols).map(height).collect();
    let dem = Dem::new(rows, cols, heights, GeoReference::local(MapPoint::new(0.0, 23.0), 1.0, 1.0).unwrap()).unwrap();
    let hopper = Hopper::new(HopperLimits::with_speeds(1.6, 1.6)).unwrap();
    let mut world = World::new(dem, hopper, friction(0.8), 0.5);
    if !is_void {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("zone.geojson");
        let ring = |west: f64, east: f64| format!("[[[{west},9.5],[{east},9.5],[{east},13.5],[{west},13.5],[{west},9.5]]]");
        let polygons = format!("[{},{}]", ring(-1.0, 15.5), ring(20.5, 24.0));
        std::fs::write(&file, format!(r#"{{"type":"MultiPolygon","coordinates":{polygons}}}"#)).unwrap();
        world.keep_out = Some(read_keep_out(&file, None, world.dem.bounds()).unwrap());
    }
    world.ground()
}

/// A robot goes round voids and zones, by hops that the hop test allows.
#[test]
fn replanned_hops_keep_to_the_ground_and_out_of_zones() {
    let (start, goal) = (Post { row: 3, col: 4 }, Post { row: 20, col: 3 });
    for is_void in [true, false] {
        let hops = PostHops::new(walled(is_void), 1).unwrap();
        let ground = hops.ground();
        let path = path(&hops, start, goal, TakeoffChoice::MostReliable).unwrap();
        let mission = mission(&hops, &path);
        let by_cost = costs_to_go(&hops, goal, (Effort::default(), TakeoffChoice::MostReliable), &()).unwrap();
        let by_risk = risks_to_go(&hops, goal, (&ERRORS, TakeoffChoice::MostReliable), &()).unwrap();
        for (name, mission, at_least) in [
            ("costs", mission.clone().with_replanning_over_posts(Arc::new(by_cost)), 0),
            ("risks", mission.with_reliable_replanning_over_posts(Arc::new(by_risk)), 38),
        ] {
            let (summary, records) = fly(&mission, ERRORS, REPLAN);
            for hop in &records {
                let [from, to] = [hop.takeoff_m, hop.planned_m].map(|at| ground.position(at.xy()).unwrap());
                let windows = ground.windows(&from, &to).unwrap().lofts;
                let (run_m, _) = ground.course(&from, &to).unwrap();
                assert!(!windows.is_empty(), "void {is_void}, {name}: no hop from {from:?} over {run_m} m to {to:?}");
                assert!(!ground.terrain().overlays().keeps_out(hop.planned_m.xy()), "{name}: into a zone at {to:?}");
            }
            let reached = summary.outcomes.of(TrialOutcome::Reached);
            assert!(reached >= at_least, "void {is_void}, {name}: {:?}", summary.outcomes);
            assert!(records.len() > path.hops.len());
        }
    }
}

/// Under shares of the limits every hop is one that the hop test of these shares allows, whatever the trials fly.
#[test]
fn replanned_hops_keep_the_shares_of_the_limits() {
    let (start, goal) = (Post { row: 3, col: 4 }, Post { row: 20, col: 3 });
    let whole = walled(true);
    let derating = Derating { takeoff_speed: 0.85, friction: 0.9, ..Derating::NONE };
    let hopper = derating.hopper(whole.hopper()).unwrap();
    let planning = DemGround::new(whole.terrain().clone(), &hopper, whole.gravity(), &derating.surface(whole.surface()));
    let choice = TakeoffChoice::MostReliable;
    for by_risk in [false, true] {
        let breaking = |planned_under: &DemGround, over: Option<&DemGround>| {
            let hops = PostHops::new(planned_under.clone(), 1).unwrap();
            let path = path(&hops, start, goal, choice).unwrap();
            let (first, last) = (path.hops.first().unwrap(), path.hops.last().unwrap());
            let mission = Mission::over_dem(whole.clone(), path.clone(), first.takeoff, last.landing);
            let mission = if by_risk {
                let risks = risks_flown_over(&hops, &whole, goal, (&ERRORS, choice), &()).unwrap();
                mission.with_reliable_replanning_over_posts(Arc::new(risks))
            } else {
                mission.with_replanning_over_posts(Arc::new(costs_to_go(&hops, goal, (Effort::default(), choice), &()).unwrap()))
            };
            let mission = if let Some(over) = over { mission.planned_over(over.clone()) } else { mission };
            let (summary, records) = fly(&mission, ERRORS, REPLAN);
            assert!(!by_risk || summary.outcomes.of(TrialOutcome::Reached) > 35, "{:?}", summary.outcomes);
            let breaks = |hop: &&HopRecord| {
                let [from, to] = [hop.takeoff_m, hop.planned_m].map(|at| planning.position(at.xy()).unwrap());
                planning.windows(&from, &to).unwrap().lofts.is_empty()
            };
            records.iter().filter(breaks).count()
        };
        assert_eq!(breaking(&planning, Some(&planning)), 0, "by risk {by_risk}");
        assert!(breaking(&whole, None) > 20, "by risk {by_risk}: the shares change nothing here");
    }
}

/// Where no post in reach leads to the goal, the robot is stuck.
#[test]
fn a_robot_out_of_reach_of_every_post_that_leads_on_is_stuck() {
    let hops = PostHops::new(walled(true), 1).unwrap();
    let lattice = hops.lattice();
    let path = path(&hops, Post { row: 3, col: 4 }, Post { row: 20, col: 3 }, TakeoffChoice::MidRange).unwrap();
    // To a goal in the void no post leads.
    let void = Post { row: 12, col: 2 };
    let by_cost = costs_to_go(&hops, void, (Effort::default(), TakeoffChoice::MidRange), &()).unwrap();
    let by_risk = risks_to_go(&hops, void, (&ERRORS, TakeoffChoice::MidRange), &()).unwrap();
    assert!((0..lattice.count()).all(|index| lattice.node(index) == void || by_cost.of_post(lattice.node(index)).is_none()));
    for (mission, hops) in [
        // The first hop is the planned one.
        (mission(&hops, &path).with_replanning_over_posts(Arc::new(by_cost)), 1),
        (mission(&hops, &path).with_reliable_replanning_over_posts(Arc::new(by_risk)), 0),
    ] {
        let (summary, records) = fly(&mission, Uncertainty { takeoff_speed_sigma_fraction: 1e-4, ..Uncertainty::NONE }, REPLAN);
        assert_eq!(summary.outcomes.of(TrialOutcome::Stuck), REPLAN.trials, "{:?}", summary.outcomes);
        assert_eq!(records.len() as u64, hops * REPLAN.trials);
    }
}
