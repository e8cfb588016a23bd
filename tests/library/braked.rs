//! Braked landings, delta-v and propellant: closed forms against flown arcs, planted and spoiled hops, every search against the hop test.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]
#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::{path::Path, sync::Arc as Shared};

use chta::{
    ballistics::{Arc, TakeoffChoice, propellant_kg},
    chain::{ConstrainedChain, GroundForm, PolygonalChain, SegmentGround, Station},
    graph::{
        Edge, Leg, Outcome, SearchOptions,
        proof::{BoundsOptions, ProofVerdict, bounds},
        search,
    },
    ground::{DemGround, LandingTable, Sweep},
    hop::{HopTest, Split},
    path::{HopPath, Propellant, StatedValue, ViolatedLimit, execute, generate},
    quantity::{Angle, AngleInterval, ChainPoint, VertexId},
    reach::map::{PostHops, Search, joined, path_hops, search as search_map, verify},
    terrain::{OverlaidDem, Overlays, read_dem},
    uncertainty::{Mission, Simulation, TrialOptions, TrialOutcome, Uncertainty},
    world::{Direction, FrictionCone, Gravity, Grip, Hopper, HopperLimits, LandingMode, Limit, RestSlope, SurfaceProperties},
};

use crate::{
    execute::{Dice, RandomWorld, with_arc},
    map_world::{World, friction, random_dem, random_hopper, random_surface},
    support::{Draw, line},
};

/// Standard gravity by its definition.
const G0: f64 = 9.806_65;

/// The same hopper with brakes, a mass and an engine; its landing speed limit is a tenth, so that hardly an arc could land without brakes.
fn braked(hopper: &Hopper, dice: &mut Dice) -> Hopper {
    let limits = hopper.limits();
    let landing_speed_max_m_s = 0.1 * limits.landing_speed_max_m_s;
    let touchdown_speed_m_s = landing_speed_max_m_s * dice.one_of(&[0.0, 0.3, 1.0]);
    Hopper::new(HopperLimits {
        landing_speed_max_m_s,
        landing: LandingMode::Braked { touchdown_speed_m_s },
        mass_kg: Some(50.0),
        isp_s: Some(limits.takeoff_speed_max_m_s * dice.between(0.05, 5.0)),
        hop_delta_v_overhead_m_s: dice.chance(0.5).then_some(0.1 * limits.takeoff_speed_max_m_s),
        ..*limits
    })
    .unwrap()
}

/// A random world whose hopper brakes, and whose chain may state faster landings than it has.
fn braked_world(dice: &mut Dice) -> RandomWorld {
    let mut world = RandomWorld::random(dice);
    world.hopper = braked(&world.hopper, dice);
    world
}

/// The same hopper without a least speed and without levels.
fn with_any_speed(hopper: &Hopper) -> Hopper {
    Hopper::new(HopperLimits { takeoff_speed_min_m_s: None, takeoff_speed_levels: None, ..*hopper.limits() }).unwrap()
}

fn names(violations: &[chta::path::Violation], limit: ViolatedLimit) -> bool {
    violations.iter().any(|violation| violation.limit == limit)
}

/// Plans of random worlds pass the checker, which steps Newton's equations; the delta-v is that of the flown velocities, and the
/// propellant that of an engine that burns it in a million small steps.
#[test]
fn braked_plans_pass_unspoiled_and_their_propellant_is_that_of_small_burns() {
    let mut dice = Dice::new(514);
    let (mut hops, mut too_fast, mut outside, mut several) = (0, 0, 0, 0);
    for world_number in 0..4000 {
        let world = braked_world(&mut dice);
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain.clone());
        let Some(path) = world.plan(&test).filter(|path| !path.hops.is_empty()) else { continue };
        let execution = execute(&chain, &path, Some(world.ends(&chain)));
        let said: Vec<String> = execution.violations.iter().map(ToString::to_string).collect();
        assert!(execution.passes(), "world {world_number}: {said:#?}\n{world:?}");
        let limits = world.hopper.limits();
        let touchdown = limits.landing.touchdown_speed_m_s().unwrap();
        let mut mass_kg = 50.0;
        for hop in &path.hops {
            // From the stated landing alone: the third side of a triangle of velocities.
            let (sine, cosine) = hop.landing_angle.radians().sin_cos();
            let change = (hop.landing_speed_m_s * cosine).hypot(hop.landing_speed_m_s * sine + touchdown);
            let delta_v = hop.takeoff_speed_m_s + change + limits.hop_delta_v_overhead_m_s.unwrap_or(0.0);
            assert!((hop.delta_v_m_s - delta_v).abs() <= 1e-9 * delta_v, "{} for {delta_v}", hop.delta_v_m_s);
            let Propellant { used_kg, mass_end_kg } = hop.propellant.unwrap();
            assert!((mass_kg - used_kg - mass_end_kg).abs() <= 1e-9 * mass_kg, "the mass falls from hop to hop");
            mass_kg = mass_end_kg;
            let rule = chain.segments().iter().find_map(|segment| segment.stated(hop.direction)).map(|line| line.landing);
            too_fast += usize::from(hop.landing_speed_m_s > limits.landing_speed_max_m_s * 1.01);
            outside += usize::from(rule.is_some_and(|rule| hop.landing_angle.radians() > rule.angles().max.radians() + 0.01));
            hops += 1;
        }
        several += usize::from(path.hops.len() > 1);
        let totals = path.totals;
        let sum: f64 = path.hops.iter().map(|hop| hop.propellant.unwrap().used_kg).sum();
        let all = totals.propellant.unwrap();
        assert!(
            (sum - all.used_kg).abs() <= 1e-9 * 50.0 && (all.mass_end_kg - mass_kg).abs() <= 1e-9 * 50.0,
            "the sum is that of the total"
        );
        if world_number % 500 == 0 {
            let (exhaust, steps) = (limits.isp_s.unwrap() * G0, 1_000_000);
            let burn = totals.delta_v_m_s / f64::from(steps);
            // Each burn changes the velocity by the exhaust velocity times the share of the mass that leaves.
            let left = (0..steps).fold(50.0, |mass: f64, _| mass - mass * burn / exhaust);
            assert!((50.0 - left - all.used_kg).abs() <= 1e-5 * 50.0, "{left} for {}", all.mass_end_kg);
        }
    }
    assert!(
        hops > 4000 && too_fast > hops / 2 && outside > 200 && several > 500,
        "{hops} hops, {too_fast} fast, {outside} flat, {several}"
    );
}

/// What each spoiled record states, and what must be named.
#[test]
fn a_spoiled_record_of_a_braked_hop_is_named() {
    type Change = fn(&mut chta::path::Hop);
    let rows: [(StatedValue, Change); 5] = [
        (StatedValue::DeltaV, |hop| hop.delta_v_m_s *= 1.000_1),
        (StatedValue::DeltaV, |hop| hop.delta_v_m_s = hop.takeoff_speed_m_s),
        (StatedValue::Propellant, |hop| hop.propellant.as_mut().unwrap().used_kg *= 1.01),
        (StatedValue::MassEnd, |hop| hop.propellant.as_mut().unwrap().mass_end_kg += 0.01),
        (StatedValue::Propellant, |hop| hop.propellant = None),
    ];
    let (mut dice, mut spoiled) = (Dice::new(77), 0);
    while spoiled < 300 {
        let world = braked_world(&mut dice);
        let Some(chain) = world.chain() else { continue };
        let Some(path) = world.plan(&HopTest::new(chain.clone())) else { continue };
        let Some(last) = path.hops.len().checked_sub(1) else { continue };
        for (value, change) in rows {
            let mut other = path.clone();
            change(&mut other.hops[last]);
            // Where next to no propellant is used, 1 % of it is less than any scale shows.
            if value == StatedValue::Propellant && other.hops[last].propellant.is_some_and(|p| p.used_kg < 1e-4) {
                continue;
            }
            let violations = execute(&chain, &other, None).violations;
            assert!(names(&violations, ViolatedLimit::StatedValue(value)), "{}: {violations:?}", value.name());
            spoiled += 1;
        }
    }
}

fn points(points: &[(f64, f64)]) -> Vec<ChainPoint> {
    points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect()
}

/// Ground that rises 20 degrees from x = 30 m on: level, then a slope on which the vertical lies 20 degrees off the normal.
fn with_slope(ground: impl Fn(usize) -> SegmentGround, limits: HopperLimits, surface: &SurfaceProperties) -> ConstrainedChain {
    let rise = 30.0 * Angle::from_degrees(20.0).slope();
    let vertices = points(&[(0.0, 0.0), (30.0, 0.0), (60.0, rise)]);
    let chain = PolygonalChain::new(vertices, (0..2).map(ground).collect(), None).unwrap();
    ConstrainedChain::new(chain, &Hopper::new(limits).unwrap(), Gravity::new(1.6).unwrap(), surface).unwrap()
}

/// A hop from level ground onto a slope of 20 degrees, by what the slope states: whether it may end there is known by hand.
#[test]
fn a_touchdown_on_ground_that_does_not_hold_it_is_refused_and_named_by_the_checker() {
    let limits = |touchdown_speed_m_s| HopperLimits {
        landing: LandingMode::Braked { touchdown_speed_m_s },
        ..HopperLimits::with_speeds(12.0, 2.0)
    };
    let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(2.0).unwrap())), rest: RestSlope::Unlimited };
    let of_friction = |angle_deg: f64, cross_deg: f64| {
        move |i: usize| {
            let (angle, cross) = if i == 1 { (angle_deg, cross_deg) } else { (63.0, 0.0) };
            let friction = FrictionCone::new(Angle::from_degrees(angle).slope()).ok();
            SegmentGround { form: GroundForm::Surface { friction, cross_slope: Angle::from_degrees(cross) }, keep_out: false }
        }
    };
    let stated = |landing: (f64, f64), speed| {
        move |i: usize| {
            let landing = if i == 1 { landing } else { (-100.0, -10.0) };
            let one = line((0.0, 90.0), 12.0, landing, if i == 1 { speed } else { 12.0 });
            SegmentGround { form: GroundForm::Explicit { forward: Some(one), reverse: Some(one) }, keep_out: false }
        }
    };
    let friction_rows =
        [(20.1, 0.0, None), (19.9, 0.0, Some(Limit::Touchdown)), (20.1, 5.0, Some(Limit::Touchdown)), (21.0, 5.0, None)];
    let stated_rows = [
        ((-100.0, -10.0), 2.0, 1.0, None),
        ((-90.0, -10.0), 2.0, 1.0, None),
        ((-89.0, -10.0), 2.0, 1.0, Some(Limit::Touchdown)),
        ((-120.0, -91.0), 2.0, 1.0, Some(Limit::Touchdown)),
        ((-100.0, -10.0), 0.9, 1.0, Some(Limit::Touchdown)),
        ((-100.0, -10.0), 0.0, 1.0, Some(Limit::LandingSpeed)),
        ((-100.0, -10.0), 2.0, 2.0, None),
    ];
    // The hop that the generous ground allows.
    let generous = HopTest::new(with_slope(stated((-100.0, -10.0), 2.0), limits(1.0), &surface));
    let station = |chain: &ConstrainedChain, x_m| chain.geometry().station(x_m).unwrap();
    let mut checked = 0;
    let mut check = |what: String, chain: ConstrainedChain, expected: Option<Limit>| {
        let test = HopTest::new(chain);
        let (from, to) = (station(test.chain(), 10.0), station(test.chain(), 45.0));
        assert_eq!(test.lofts(&from, &to).err(), expected, "{what}");
        let set = test.takeoff_set(&from, &to).unwrap();
        let refused = set.limits().iter().find(|limit| limit.lofts.is_empty()).map(|limit| limit.limit);
        assert_eq!(refused, expected, "{what}: the set, limit by limit");
        let lofts = generous.lofts(&from, &to).unwrap();
        let leg = Leg { takeoff: from, landing: to, edge: Edge::Hop(lofts), loft: None };
        let path = generate(&generous, &[leg], TakeoffChoice::MidRange, Split::FullReach).unwrap();
        let found: Vec<ViolatedLimit> = execute(test.chain(), &path, None)
            .violations
            .iter()
            .map(|violation| violation.limit)
            .filter(|limit| matches!(limit, ViolatedLimit::Limit(_)))
            .collect();
        assert_eq!(found, Vec::from_iter(expected.map(ViolatedLimit::Limit)), "{what}: the checker");
        checked += 1;
    };
    for (angle, cross, expected) in friction_rows {
        check(
            format!("friction of {angle} deg, across {cross}"),
            with_slope(of_friction(angle, cross), limits(1.0), &surface),
            expected,
        );
    }
    for (landing, speed, touchdown, expected) in stated_rows {
        let chain = with_slope(stated(landing, speed), limits(touchdown), &surface);
        check(format!("landing {landing:?} at {speed} m/s, touchdown {touchdown}"), chain, expected);
    }
    assert_eq!(checked, friction_rows.len() + stated_rows.len());
}

/// The window of a braked hop against arcs flown by the checker at many angles: each lies in the window exactly if the checker finds
/// nothing wrong.
#[test]
fn braked_windows_are_those_of_flown_arcs() {
    let mut dice = Dice::new(90);
    let (mut inside, mut beyond, mut refused) = (0, 0, 0);
    for _ in 0..1500 {
        let mut world = braked_world(&mut dice);
        // Arcs of any speed are flown.
        world.hopper = with_any_speed(&world.hopper);
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain.clone());
        let ends = world.ends(&chain);
        let Some(sight) = test.line_of_sight(&ends.0, &ends.1) else { continue };
        let lofts = test.lofts(&ends.0, &ends.1);
        for step in 1..12 {
            let low = sight.angle().radians();
            let radians = low + (std::f64::consts::FRAC_PI_2 - low) * f64::from(step) / 12.0;
            let loft = radians.tan() - sight.slope();
            let arc = Arc::new(sight, loft, world.gravity_m_s2);
            let one = chta::quantity::SlopeInterval { lower: loft, upper: loft };
            let leg = Leg { takeoff: ends.0, landing: ends.1, edge: Edge::Hop(one), loft: None };
            let path = generate(&test, &[leg], TakeoffChoice::MidRange, Split::FullReach).unwrap();
            let hop = with_arc(&path.hops[0], &arc);
            let path = HopPath::of_hops(
                vec![chta::path::Hop { delta_v_m_s: chta::ballistics::delta_v_m_s(&arc, world.hopper.limits()), ..hop }],
                &world.hopper,
            );
            let violations = execute(&chain, &path, None).violations;
            let breaks = violations.iter().any(|v| matches!(v.limit, ViolatedLimit::Limit(_)));
            match lofts {
                Err(_) => {
                    assert!(breaks, "no arc is feasible, but one of {} deg passes\n{world:?}", radians.to_degrees());
                    refused += 1;
                }
                Ok(window) => {
                    let angle = |loft: f64| Angle::from_slope(sight.slope() + loft).radians();
                    let (min, max) = (angle(window.lower), angle(window.upper));
                    if (radians - min).abs() < 1e-6 || (radians - max).abs() < 1e-6 {
                        continue;
                    }
                    let holds = min < radians && radians < max;
                    // A terrain violation of less than the rounding of heights is not seen: only clearly outside.
                    if holds || radians < min - 1e-3 || radians > max + 1e-3 {
                        assert_eq!(
                            !breaks,
                            holds,
                            "{} deg of {} to {}: {violations:?}\n{world:?}",
                            radians.to_degrees(),
                            min.to_degrees(),
                            max.to_degrees()
                        );
                    }
                    if holds { inside += 1 } else { beyond += 1 }
                }
            }
        }
    }
    assert!(inside > 1000 && beyond > 400 && refused > 500, "{inside} inside, {beyond} beyond, {refused} refused");
}

/// The sweep and the proof of random worlds against the hop test and the search.
#[test]
fn sweep_and_proof_agree_with_hop_test_and_search_under_brakes() {
    let mut dice = Dice::new(41);
    let (mut pairs, mut feasible, mut touchdown) = (0, 0, 0);
    let (mut met, mut paths, mut closed) = (0, 0, 0);
    for number in 0..1500 {
        let world = braked_world(&mut dice);
        let Some(chain) = world.chain() else { continue };
        let test = HopTest::new(chain.clone());
        let stations: Vec<Station> =
            (0..=chain.geometry().segment_count()).map(|i| chain.geometry().vertex_station(VertexId(i))).collect();
        let mut sweep = Sweep::new(Shared::new(LandingTable::new(&test, stations.as_slice())));
        for takeoff in &stations {
            for direction in Direction::BOTH {
                sweep.landings(takeoff, 0..stations.len(), direction, |i, swept| {
                    let plain = test.lofts(takeoff, &stations[i]);
                    assert_eq!(swept.as_ref().err(), plain.as_ref().err(), "{world:?}");
                    pairs += 1;
                    feasible += usize::from(plain.is_ok());
                    touchdown += usize::from(plain == Err(Limit::Touchdown));
                });
            }
        }
        if number % 3 != 0 {
            continue;
        }
        let (start, goal) = world.ends(&chain);
        let options = BoundsOptions { budget_cells: 120, search: world.options.clone(), ..BoundsOptions::default() };
        let found = bounds(&test, start, goal, &options, &()).unwrap();
        if let Outcome::Path { cost, .. } = search(&test, start, goal, &world.options, &()).unwrap().outcome {
            assert_ne!(found.verdict(), ProofVerdict::Untraversable, "{world:?}");
            assert!(found.lower.is_some_and(|lower| lower <= cost.hops()), "{:?} for {} hops", found.lower, cost.hops());
            met += usize::from(found.is_proved());
            paths += 1;
        } else {
            closed += usize::from(found.verdict() == ProofVerdict::Untraversable);
        }
    }
    assert!(
        pairs > 20_000 && feasible > 5000 && touchdown > 500,
        "{pairs} pairs, {feasible} feasible, {touchdown} touchdowns refused"
    );
    assert!(paths > 100 && met > paths / 3 && closed > 20, "{paths} paths, {met} proved, {closed} closed");
}

/// The hopper of a random DEM with brakes.
fn braked_over_dem(hopper: &Hopper) -> Hopper {
    let limits = hopper.limits();
    Hopper::new(HopperLimits {
        landing_speed_max_m_s: 0.2 * limits.landing_speed_max_m_s,
        landing: LandingMode::Braked { touchdown_speed_m_s: 0.1 * limits.landing_speed_max_m_s },
        mass_kg: Some(20.0),
        isp_s: Some(limits.takeoff_speed_max_m_s),
        ..*limits
    })
    .unwrap()
}

/// Maps by fast arithmetic against slice and hop test, pair by pair, and their paths flown again over the triangles.
#[test]
fn braked_maps_agree_with_slices_and_their_paths_hold() {
    let mut draw = Draw::seeded(616);
    let (mut pairs, mut feasible, mut flown, mut gained) = (0, 0, 0, 0);
    for _ in 0..40 {
        let dem = random_dem(&mut draw, 9);
        let (hopper, gravity) = random_hopper(&mut draw);
        let surface = random_surface(&mut draw);
        let ballistic = World::new(dem.clone(), hopper, surface, gravity);
        let world = World::new(dem, braked_over_dem(&hopper), surface, gravity);
        let hops = PostHops::new(world.ground(), 1).unwrap();
        for from in world.posts(1).into_iter().step_by(3) {
            for offset in 0..hops.offset_count() {
                let Some(to) = hops.landing(from, offset) else { continue };
                let fast = hops.lofts(from, offset).unwrap();
                let plain = world.lofts(from, to);
                assert_eq!(fast.is_some(), plain.is_some(), "{from:?} to {to:?}: {fast:?}, {plain:?}");
                if let (Some((sight, fast)), Some(plain)) = (fast, plain) {
                    let angle = |loft: f64| Angle::from_slope(sight.slope() + loft).radians();
                    let apart = |a: f64, b: f64| (angle(a) - angle(b)).abs();
                    assert!(apart(fast.lower, plain.lower) < 1e-6 && apart(fast.upper, plain.upper) < 1e-6, "{fast:?} {plain:?}");
                    feasible += 1;
                    gained += usize::from(ballistic.lofts(from, to).is_none());
                }
                pairs += 1;
            }
        }
        flown += fly_paths(world.ground(), 1, 4, TakeoffChoice::LeastSpeed);
    }
    assert!(
        pairs > 20_000 && feasible > 2000 && gained > 200 && flown > 300,
        "{pairs} pairs, {feasible} feasible, {gained}, {flown} flown"
    );
}

/// Flies the paths of a map to every `step`-th post again; returns the number of hops.
fn fly_paths(ground: DemGround, stride: usize, step: usize, choice: TakeoffChoice) -> usize {
    let hops = PostHops::new(ground, stride).unwrap();
    let lattice = hops.lattice();
    let middle = lattice.node(lattice.count() / 2);
    let Some(start) = hops.nearest_usable(middle) else { return 0 };
    let map = search_map(&hops, &[start.into()], Search::default(), &()).unwrap();
    let mut flown = 0;
    for goal in (0..lattice.count()).step_by(step).map(|index| lattice.node(index)) {
        let Some(nodes) = map.path(&hops, goal) else { continue };
        let path = joined(&hops, &path_hops(&hops, &nodes, choice).unwrap());
        let execution = verify(&hops, &path, start, goal);
        let said: Vec<String> = execution.violations.iter().map(ToString::to_string).collect();
        assert!(execution.passes(), "{start:?} to {goal:?}: {said:#?}");
        flown += path.hops.len();
    }
    flown
}

/// Braked landings on real ground: maps against slices, and paths flown again.
#[test]
fn braked_paths_over_real_ground_hold() {
    let rows = [
        (
            "hirise_DTEEC_010228_1490_crop_120x70.tif",
            3.711,
            HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(6.0, 1.0) },
            11,
        ),
        (
            "lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif",
            1.624,
            HopperLimits { clearance_m: 2.0, ..HopperLimits::with_speeds(8.0, 1.0) },
            197,
        ),
    ];
    for (file, gravity_m_s2, limits, step) in rows {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
        if !path.is_file() {
            eprintln!("skipped: {} is absent", path.display());
            continue;
        }
        let dem = read_dem(&path).unwrap();
        let limits = HopperLimits {
            landing: LandingMode::Braked { touchdown_speed_m_s: 0.8 },
            mass_kg: Some(40.0),
            isp_s: Some(220.0),
            ..limits
        };
        let hopper = Hopper::new(limits).unwrap();
        // Rest on 40 degrees, but friction of 0.6 holds a touchdown only up to 31: the touchdown is a limit of its own.
        let surface = SurfaceProperties { rest: RestSlope::AtMost(Angle::from_degrees(40.0)), ..friction(0.6) };
        let world = World::new(dem.clone(), hopper, surface, gravity_m_s2);
        let hops = PostHops::new(world.ground(), 1).unwrap();
        let mut draw = Draw::seeded(5);
        let (mut feasible, mut pairs) = (0, 0);
        while pairs < 1500 {
            let from = hops.lattice().node(draw.below(hops.lattice().count()));
            let offset = draw.below(hops.offset_count());
            let Some(to) = hops.landing(from, offset) else { continue };
            let (fast, plain) = (hops.lofts(from, offset).unwrap(), world.lofts(from, to));
            assert_eq!(fast.is_some(), plain.is_some(), "{file}: {from:?} to {to:?}");
            feasible += usize::from(plain.is_some());
            pairs += 1;
        }
        assert!(feasible > 100, "{file}: {feasible} of {pairs} feasible");
        let terrain = OverlaidDem::new(dem, Overlays::default());
        let ground = DemGround::new(terrain, &hopper, Gravity::new(gravity_m_s2).unwrap(), &surface);
        let flown = fly_paths(ground, 1, step, TakeoffChoice::MidRange);
        assert!(flown > 500, "{file}: {flown} hops");
    }
}

/// Trials of a braked hop onto a slope of 20 degrees under an uncertain friction: the share that slides is the probability that the
/// drawn coefficient is below tan 20 deg, and no arc is too fast.
#[test]
fn trials_judge_the_touchdown_where_it_lands() {
    let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.5).unwrap())), rest: RestSlope::Unlimited };
    let bare = |_| SegmentGround::BARE;
    let limits = HopperLimits {
        landing: LandingMode::Braked { touchdown_speed_m_s: 1.0 },
        // Within 8 degrees of the vertical, so that friction of 0.14 holds the take-off.
        takeoff_angle_min: Some(Angle::from_degrees(82.0)),
        ..HopperLimits::with_speeds(30.0, 1.5)
    };
    let test = HopTest::new(with_slope(bare, limits, &surface));
    let (start, goal) = (test.chain().geometry().station(20.0).unwrap(), test.chain().geometry().station(45.0).unwrap());
    let found = search(&test, start, goal, &SearchOptions::default(), &()).unwrap();
    let Outcome::Path { legs, .. } = found.outcome else { panic!("no path: {found:?}") };
    let path = generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::FullReach).unwrap();
    assert!(path.hops.iter().all(|hop| hop.landing_speed_m_s > 3.0), "arcs are faster than a landing may be");
    let landings_on_slope = path.hops.iter().any(|hop| hop.landing.along_m > 30.0);
    assert!(landings_on_slope, "{path:?}");
    let mission = Mission::along_chain(test, path, start, goal);
    let options = TrialOptions { trials: 20_000, goal_tolerance_m: 1.0, ..TrialOptions::default() };
    let share = |friction_sigma: f64, outcome| {
        let uncertainty = Uncertainty { friction_sigma, ..Uncertainty::NONE };
        let summary = Simulation::new(&mission, uncertainty).unwrap().run(&options, &mut (), &()).unwrap();
        f64::from(u32::try_from(summary.outcomes.of(outcome)).unwrap()) / 20_000.0
    };
    assert_eq!(share(0.0, TrialOutcome::Reached), 1.0);
    // P(0.5 + 0.1 N < tan 20 deg = 0.36397) = P(N < -1.3603) = 0.08687.
    let slid = share(0.1, TrialOutcome::SlidAtLanding);
    assert!((slid - 0.08687).abs() < 0.008, "{slid}");
    assert_eq!(share(0.1, TrialOutcome::Damaged), 0.0);
}

/// With brakes and a body of known radius, no landing is too fast; without, both speeds stay below escape.
#[test]
fn the_escape_speed_caps_no_touchdown() {
    let bennu = chta::world::Body::named("bennu").unwrap().gravity;
    let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(5.0).unwrap())), rest: RestSlope::Unlimited };
    let chain = |landing| {
        let vertices = points(&[(0.0, 400.0), (299.0, 0.0), (300.0, 0.0)]);
        let hopper = Hopper::new(HopperLimits { landing, ..HopperLimits::with_speeds(1.0, 1.0) }).unwrap();
        ConstrainedChain::new(PolygonalChain::bare(vertices).unwrap(), &hopper, bennu, &surface).unwrap()
    };
    for (landing, lands) in [(LandingMode::Ballistic, false), (LandingMode::Braked { touchdown_speed_m_s: 0.5 }, true)] {
        let test = HopTest::new(chain(landing));
        let ends = [0, 2].map(|vertex| test.chain().geometry().vertex_station(VertexId(vertex)));
        assert_eq!(test.lofts(&ends[0], &ends[1]).is_ok(), lands, "{landing:?}");
    }
}

/// Braked landings and the stated angles of the ground relative to its slope: straight down must be among them.
#[test]
fn angles_from_the_slope_hold_a_touchdown_where_they_contain_straight_down() {
    // Uphill (forward) 20 degrees are added to the stated angles, downhill they are taken away: -90 to -60 is -70 to -40 uphill.
    let rows = [
        ((-90.0, -60.0), Direction::Forward, false),
        ((-90.0, -60.0), Direction::Reverse, true),
        ((-135.0, -60.0), Direction::Forward, true),
        ((-135.0, -60.0), Direction::Reverse, true),
        ((-69.0, -20.0), Direction::Reverse, false),
    ];
    for (landing, direction, holds) in rows {
        let grip = Grip::FromSlope {
            takeoff: AngleInterval::from_degrees(0.0, 90.0),
            landing: AngleInterval::from_degrees(landing.0, landing.1),
        };
        let surface = SurfaceProperties { grip: Some(grip), rest: RestSlope::Unlimited };
        let limits =
            HopperLimits { landing: LandingMode::Braked { touchdown_speed_m_s: 1.0 }, ..HopperLimits::with_speeds(9.0, 1.0) };
        let chain = with_slope(|_| SegmentGround::BARE, limits, &surface);
        let found = chain.segments()[1].check_contact(chta::world::Contact::Landing, direction);
        assert_eq!(found.is_ok(), holds, "{landing:?} {direction:?}: {found:?}");
        assert!(holds || found.unwrap_err().limit(chta::world::Contact::Landing) == Limit::Touchdown);
    }
    assert!((propellant_kg(80.0, 0.0, 200.0)).abs() < 1e-300);
}
