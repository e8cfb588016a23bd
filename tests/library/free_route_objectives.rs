//! Routes in any direction by an objective, within budgets, and their fronts, against every pair of nodes by slice and hop test; and what a
//! no says, against the same pairs.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its terrain should stop")]
#![allow(clippy::print_stderr, reason = "skipped tests say why")]

use std::{collections::HashSet, path::Path};

use chta::{
    ballistics::TakeoffChoice,
    graph::Effort,
    ground::{DemGround, MapPosition, Surface},
    hop::HopTest,
    planner::{
        Amount, Amounts, Budgets, FreeRoute, LabelCap, Objective, RouteGoal, RouteQuestion, SearchedCommands, SurfaceNodes,
        free_route_by, front_of_routes,
    },
    quantity::{Angle, MapPoint, VertexId},
    reach::map::Post,
    terrain::read_dem,
    uncertainty::Uncertainty,
    world::{Hopper, HopperLimits, Limit},
};

use crate::{
    free_route::{nodes, positions, random_ends, random_world},
    map_equality::cut_out,
    map_world::{World, friction},
    planner::amounts_of,
    support::Draw,
};

/// The choices of a hop.
const CHOICES: [TakeoffChoice; 3] = [TakeoffChoice::LeastSpeed, TakeoffChoice::MidRange, TakeoffChoice::LeastTime];

/// All amounts of a path without errors.
const ALL: [Amount; 9] = [
    Amount::Hops,
    Amount::TakeoffSpeed,
    Amount::DeltaV,
    Amount::Energy,
    Amount::FlightTime,
    Amount::MissionTime,
    Amount::Distance,
    Amount::ArcLength,
    Amount::PeakSpeed,
];

/// Those that add up.
const SUMS: [Amount; 8] = *ALL.first_chunk().unwrap();

/// Every pair of nodes by its slice and the hop test.
struct Every {
    places: Vec<MapPosition>,
    /// Of every node: the others that one hop leads to, and what it takes by each choice.
    legs: Vec<Vec<(usize, Vec<Amounts>)>>,
    start: usize,
    goal: usize,
}

/// The hop between two places by its slice: what it takes by each choice, or the limit that refuses it; `None` without ground.
fn by_slice(ground: &DemGround, [from, to]: [&MapPosition; 2], first: bool) -> Option<Result<Vec<Amounts>, Limit>> {
    let test = HopTest::new(ground.chain(from.at, to.at).ok()?);
    let geometry = test.chain().geometry();
    let ends = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
    if let Err(limit) = test.lofts(&ends.0, &ends.1) {
        return Some(Err(limit));
    }
    let set = test.takeoff_set(&ends.0, &ends.1).unwrap();
    let of = |choice| {
        let arc = set.arc(choice, test.gravity_m_s2()).unwrap();
        amounts_of(ground.hopper().limits(), &[(arc, 1.0)], first)
    };
    Some(Ok(CHOICES.map(of).to_vec()))
}

/// Whether the greatest speeds exclude no hop between two places.
fn is_near(ground: &DemGround, [from, to]: [&MapPosition; 2]) -> bool {
    let limits = ground.hopper().limits();
    let (run_m, climb_m) = ((to.at - from.at).norm(), to.z_m - from.z_m);
    let reaches = |v: f64, climb_m: f64| ground.gravity_m_s2() * (run_m.hypot(climb_m) + climb_m) <= v * v * 1.001;
    run_m > 0.0 && reaches(limits.takeoff_speed_max_m_s, climb_m) && reaches(limits.landing_speed_max_m_s, -climb_m)
}

impl Every {
    fn of(ground: &DemGround, n: u32, ends: [MapPoint; 2]) -> Self {
        let places = positions(ground, n, &ends);
        let [start, goal] = ends.map(|at| places.iter().position(|place| place.at == at).unwrap());
        let legs_of = |from: usize| {
            let leg = |to: usize| {
                let pair = [&places[from], &places[to]];
                let amounts = is_near(ground, pair).then(|| by_slice(ground, pair, from == start)).flatten()?.ok()?;
                Some((to, amounts))
            };
            (0..places.len()).filter_map(leg).collect()
        };
        let legs = (0..places.len()).map(legs_of).collect();
        Self { places, legs, start, goal }
    }

    /// The best totals to every node in the order of a list of amounts, of which only the last may not add up, by rounds until nothing changes.
    fn best(&self, amounts: &[Amount]) -> Option<Vec<f64>> {
        let mut best: Vec<Option<Vec<f64>>> = vec![None; self.places.len()];
        best[self.start] = Some(vec![0.0; amounts.len()]);
        let mut changed = vec![self.start];
        while !changed.is_empty() {
            let mut next = HashSet::new();
            for from in std::mem::take(&mut changed) {
                let here = best[from].clone().unwrap();
                for (to, choices) in &self.legs[from] {
                    for leg in choices {
                        let joined = |(amount, sum): (&Amount, &f64)| amount.join(*sum, leg.of(*amount));
                        let there: Vec<f64> = amounts.iter().zip(&here).map(joined).collect();
                        // Rounding alone changes nothing.
                        let is_less = best[*to].as_ref().is_none_or(|known| {
                            let differs = known.iter().zip(&there).find(|(a, b)| (*a - *b).abs() > 1e-9 * (1.0 + a.abs()));
                            differs.is_some_and(|(a, b)| b < a)
                        });
                        if is_less {
                            best[*to] = Some(there);
                            next.insert(*to);
                        }
                    }
                }
            }
            changed = next.into_iter().collect();
            changed.sort_unstable();
        }
        best[self.goal].clone()
    }

    /// The least of one amount over all paths within a greatest total of another, by sets of pairs none of which has less of both.
    fn within(&self, first: Amount, (second, most): (Amount, f64)) -> Option<f64> {
        let mut sets: Vec<Vec<[f64; 2]>> = vec![Vec::new(); self.places.len()];
        let mut waiting = vec![(self.start, [0.0; 2])];
        sets[self.start].push([0.0; 2]);
        while let Some((from, here)) = waiting.pop() {
            if !sets[from].contains(&here) {
                continue;
            }
            for (to, choices) in &self.legs[from] {
                for leg in choices {
                    let there = [first.join(here[0], leg.of(first)), here[1] + leg.of(second)];
                    let is_worse = |known: &[f64; 2]| known[0] <= there[0] * (1.0 + 1e-12) && known[1] <= there[1] * (1.0 + 1e-12);
                    if there[1] > most * (1.0 + 1e-9) || sets[*to].iter().any(is_worse) {
                        continue;
                    }
                    sets[*to].retain(|known| known[0] < there[0] || known[1] < there[1]);
                    sets[*to].push(there);
                    waiting.push((*to, there));
                }
            }
        }
        sets[self.goal].iter().map(|pair| pair[0]).reduce(f64::min)
    }

    /// The least of an amount with exactly so many hops, for every number up to the last, by layers.
    fn layers(&self, amount: Amount, last: usize) -> Vec<f64> {
        let mut layer = vec![f64::INFINITY; self.places.len()];
        layer[self.start] = 0.0;
        let mut at_goal = vec![layer[self.goal]];
        for _ in 0..last {
            let mut next = vec![f64::INFINITY; self.places.len()];
            for (from, legs) in self.legs.iter().enumerate().filter(|(from, _)| layer[*from].is_finite()) {
                for (to, choices) in legs {
                    let least = choices.iter().map(|leg| leg.of(amount)).fold(f64::INFINITY, f64::min);
                    next[*to] = next[*to].min(layer[from] + least);
                }
            }
            layer = next;
            at_goal.push(layer[self.goal]);
        }
        at_goal
    }

    /// The nodes that an end reaches, or that lead to it.
    fn connected(&self, end: usize, backwards: bool) -> Vec<bool> {
        let mut known = vec![false; self.places.len()];
        known[end] = true;
        loop {
            let before = known.iter().filter(|known| **known).count();
            for (from, legs) in self.legs.iter().enumerate() {
                for (to, _) in legs {
                    let (here, there) = if backwards { (*to, from) } else { (from, *to) };
                    known[there] |= known[here];
                }
            }
            if known.iter().filter(|known| **known).count() == before {
                return known;
            }
        }
    }
}

fn asked(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    [start, goal]: [MapPoint; 2],
    (objective, budgets): (&Objective, &Budgets),
    commands: SearchedCommands,
) -> FreeRoute {
    let goal = RouteGoal { start, goal, effort: Effort::TakeoffSpeed, takeoff: TakeoffChoice::LeastSpeed };
    let question = RouteQuestion { objective, budgets, commands, errors: None, cap: LabelCap::default() };
    free_route_by(ground, nodes, &goal, &question, &()).unwrap()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * (1.0 + a.abs().max(b.abs()))
}

/// The totals of a path are those of its legs, each by its own slice and the choice that it states.
fn check_legs(ground: &DemGround, route: &FreeRoute, what: &str) {
    let path = route.path.as_ref().unwrap();
    let mut sum = Amounts::NONE;
    for (number, (pair, choice)) in path.places.windows(2).zip(&path.choices).enumerate() {
        let choices = by_slice(ground, [&pair[0], &pair[1]], number == 0).unwrap().unwrap();
        sum = sum.then(&choices[CHOICES.iter().position(|other| other == choice).unwrap()]);
    }
    for amount in SUMS.into_iter().chain([Amount::PeakSpeed]) {
        assert!(close(sum.of(amount), path.totals.of(amount)), "{what}, {amount}: {sum:?} against {:?}", path.totals);
    }
}

/// Objectives of one to three amounts with each of some as the first, budgets on another amount, and a front, over one ground.
fn compare(draw: &mut Draw, ground: &DemGround, (n, firsts): (u32, &[Amount]), ends: [MapPoint; 2], what: &str) -> Option<u64> {
    let (every, nodes) = (Every::of(ground, n, ends), nodes(ground, n, ends, None));
    let distinct = SearchedCommands::Distinct;
    let fewest = every.best(&[Amount::Hops]);
    for first in firsts.iter().copied() {
        let mut amounts = vec![first];
        let others = [SUMS[draw.below(8)], ALL[draw.below(9)]].into_iter().filter(|other| *other != first);
        amounts.extend(others.filter(|_| first.adds_up()));
        amounts.dedup();
        let objective = Objective::new(amounts.clone()).unwrap();
        let route = asked(ground, &nodes, ends, (&objective, &Budgets::NONE), distinct);
        let best = every.best(&amounts);
        assert_eq!(route.path.is_some(), best.is_some(), "{what}: {objective}");
        let (Some(path), Some(best)) = (&route.path, best) else { continue };
        assert!(route.within && !route.capped, "{what}");
        check_legs(ground, &route, what);
        // Ties of sums are those of doubles: only the first amount of a sum of speeds or times is sure.
        let compared = if first == Amount::Hops { 2.min(amounts.len()) } else { 1 };
        for (amount, expected) in amounts.iter().zip(best).take(compared) {
            let total = path.totals.of(*amount);
            assert!(close(total, expected), "{what}: {amount} of {objective}: {total}, expected {expected}");
        }
        // A budget on another amount, between its least and what the best path takes.
        let second = SUMS[draw.below(8)];
        let (least, taken) = (every.best(&[second]).unwrap()[0], path.totals.of(second));
        if second == first {
            continue;
        }
        let most = least + draw.uniform(0.0, 1.0) * (taken - least);
        let budgets = Budgets::NONE.with(second, most).unwrap();
        let single = Objective::of(first);
        let route = asked(ground, &nodes, ends, (&single, &budgets), distinct);
        let expected = every.within(first, (second, most));
        let said = format!("{what}: {first} with {second} of at most {most}, least {least}, taken {taken}");
        assert_eq!(route.within, expected.is_some(), "{said}: {:?}", route.path);
        if let (true, Some(expected)) = (route.within, expected) {
            let totals = route.path.as_ref().unwrap().totals;
            assert!(close(totals.of(first), expected), "{said}: {}, expected {expected}", totals.of(first));
            assert!(totals.of(second) <= most * (1.0 + 1e-9), "{said}");
            check_legs(ground, &route, what);
            // A looser budget is never worse.
            let loose = Budgets::NONE.with(second, most * 1.2).unwrap();
            let looser = asked(ground, &nodes, ends, (&single, &loose), distinct).path.unwrap().totals.of(first);
            assert!(looser <= expected * (1.0 + 1e-9) + 1e-12, "{said}: {looser} with a looser budget");
        }
        // A budget that nothing keeps.
        if second != Amount::Hops {
            let none = Budgets::NONE.with(second, 0.9 * least).unwrap();
            let route = asked(ground, &nodes, ends, (&single, &none), distinct);
            assert!(!route.within && route.path.is_some(), "{said}");
            assert!(close(route.unmet[0].least, least), "{said}: {:?}", route.unmet);
        }
    }
    let fewest = fewest?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few hops")]
    let fewest = fewest[0] as u64;
    for amount in [Amount::Energy, Amount::MissionTime] {
        let goal = RouteGoal { start: ends[0], goal: ends[1], effort: Effort::TakeoffSpeed, takeoff: TakeoffChoice::LeastSpeed };
        let (objective, budgets, cap) = (Objective::of(amount), Budgets::NONE, LabelCap::default());
        let question = RouteQuestion { objective: &objective, budgets: &budgets, commands: distinct, errors: None, cap };
        let front = front_of_routes(ground, &nodes, &goal, (amount, &question, &|fewest| fewest + 3), &()).unwrap();
        let mut expected: Vec<(usize, f64)> = Vec::new();
        for (hops, least) in every.layers(amount, usize::try_from(fewest).unwrap() + 3).into_iter().enumerate() {
            if least.is_finite() && expected.last().is_none_or(|(_, last)| least < last - 1e-9 * last) {
                expected.push((hops, least));
            }
        }
        let found: Vec<f64> = front.paths.iter().map(|path| path.totals.of(amount)).collect();
        assert_eq!((front.hops_max, front.capped), (fewest + 3, false));
        for (hops, least) in &expected {
            let of_hops = front.paths.iter().find(|path| path.cost.hops() == *hops as u64);
            assert!(of_hops.is_some_and(|path| close(path.totals.of(amount), *least)), "{what}: {expected:?}, found {found:?}");
        }
    }
    Some(fewest)
}

#[test]
fn random_grounds_have_the_best_routes_of_every_pair_of_nodes() {
    let draw = &mut Draw::seeded(1741);
    let (mut several, mut not) = (0, 0);
    for number in 0..60 {
        let ground = random_world(draw, 5).ground();
        let Some(ends) = random_ends(draw, &ground) else { continue };
        match compare(draw, &ground, (1 + number % 2, &ALL), ends, &format!("ground {number}")) {
            Some(hops) => several += u32::from(hops > 1),
            None => not += 1,
        }
    }
    assert!(several > 6 && not > 3, "{several} reached in several hops, {not} not reached");
}

/// Cut-outs of a real DEM with these sides and nodes a post, and a machine of so many posts of reach.
fn compare_cut_outs(file: &str, (gravity_m_s2, cuts): (f64, [(usize, u32, f64); 3]), seed: u64) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(file);
    if !path.exists() {
        eprintln!("skipped: {} is absent", path.display());
        return;
    }
    let dem = read_dem(&path).unwrap();
    let (draw, mut reached) = (&mut Draw::seeded(seed), 0);
    // Each amount is the first of an objective over one of the cut-outs.
    for ((side, n, posts), firsts) in cuts.into_iter().zip(ALL.chunks(3)) {
        let first = Post { row: draw.below(dem.rows() - side), col: draw.below(dem.cols() - side) };
        let speed_m_s = (gravity_m_s2 * posts * dem.georeference().dx_m()).sqrt();
        let limits = HopperLimits {
            clearance_m: 0.05,
            mass_kg: Some(10.0),
            preparation_energy_j: Some(20.0),
            preparation_time_s: Some(5.0),
            settling_time_s: Some(7.0),
            ..HopperLimits::with_speeds(speed_m_s, speed_m_s)
        };
        let world = World::new(cut_out(&dem, first, side, 0, draw), Hopper::new(limits).unwrap(), friction(0.8), gravity_m_s2);
        let ground = world.ground();
        let Some(ends) = random_ends(draw, &ground) else { continue };
        let what = format!("{file} from row {}, column {}, n = {n}", first.row, first.col);
        reached += u32::from(compare(draw, &ground, (n, firsts), ends, &what).is_some_and(|hops| hops > 1));
    }
    assert!(reached > 0, "no goal of {file} in several hops");
}

#[test]
fn cut_outs_of_mars_have_the_best_routes_of_every_pair_of_nodes() {
    compare_cut_outs("hirise_DTEEC_010228_1490_crop_120x70.tif", (3.711, [(24, 1, 4.0), (24, 2, 2.0), (12, 3, 2.0)]), 1742);
}

#[test]
fn cut_outs_of_the_moon_have_the_best_routes_of_every_pair_of_nodes() {
    compare_cut_outs("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", (1.624, [(24, 1, 4.0), (24, 2, 2.0), (12, 3, 2.0)]), 1743);
}

/// A looser limit of speed, over the same nodes.
#[test]
fn a_looser_limit_is_never_worse() {
    let draw = &mut Draw::seeded(1744);
    let mut better = 0;
    for _ in 0..60 {
        let mut world = random_world(draw, 6);
        let Some(ends) = random_ends(draw, &world.ground()) else { continue };
        let totals = [1.0, 1.3].map(|more| {
            let limits = *world.hopper.limits();
            // Continuous commands: levels and steps of speed are no looser for being greater.
            let speeds = HopperLimits::with_speeds(limits.takeoff_speed_max_m_s * more, limits.landing_speed_max_m_s * more);
            let with = HopperLimits { clearance_m: limits.clearance_m, clearance_rule: limits.clearance_rule, ..speeds };
            world.hopper = Hopper::new(with).unwrap();
            let ground = world.ground();
            let nodes = nodes(&ground, 2, ends, None);
            [Amount::Hops, Amount::TakeoffSpeed, Amount::Energy, Amount::FlightTime].map(|amount| {
                let route = asked(&ground, &nodes, ends, (&Objective::of(amount), &Budgets::NONE), SearchedCommands::Distinct);
                route.path.map(|path| path.totals.of(amount))
            })
        });
        for (tight, loose) in totals[0].iter().zip(&totals[1]) {
            let Some(tight) = tight else { continue };
            let loose = loose.expect("a path of the tighter limit");
            assert!(loose <= tight * (1.0 + 1e-9), "{totals:?}");
            better += u32::from(loose < tight * 0.999);
        }
    }
    assert!(better > 10, "{better} better");
}

/// Where no route is found: the places reached and those that lead to the goal, and what refuses the hops between them.
#[test]
fn a_no_names_both_sides_of_the_gap_and_the_limits_across_it() {
    let draw = &mut Draw::seeded(1745);
    let (mut noes, mut across, mut wide, mut touching) = (0, 0, 0, 0);
    for number in 0..220 {
        let ground = random_world(draw, 6).ground();
        let Some(ends) = random_ends(draw, &ground) else { continue };
        let nodes = nodes(&ground, 1, ends, None);
        let objective = Objective::hops_then(Effort::Energy);
        let route = asked(&ground, &nodes, ends, (&objective, &Budgets::NONE), SearchedCommands::Chosen);
        let Some(gap) = &route.gap else { continue };
        noes += 1;
        let every = Every::of(&ground, 1, ends);
        let (reached, leading) = (every.connected(every.start, false), every.connected(every.goal, true));
        let what = format!("ground {number}: {gap:?}");
        let count = |set: &[bool]| set.iter().filter(|is_in| **is_in).count();
        if (route.work.reached, gap.leading) != (count(&reached), count(&leading)) {
            // The sets are those of the fast walk. Where a line touches missing ground at a post, it may differ from the slice.
            touching += 1;
            continue;
        }
        let nearest_m = |set: &[bool], to: usize| {
            let away = every.places.iter().zip(set).filter(|(_, is_in)| **is_in).map(|(place, _)| place.at - every.places[to].at);
            away.map(|away| away.norm()).fold(f64::INFINITY, f64::min)
        };
        let away_m = |place: MapPosition, to: usize| (place.at - every.places[to].at).norm();
        assert!(close(away_m(route.nearest, every.goal), nearest_m(&reached, every.goal)), "{what}");
        assert!(close(away_m(gap.leads_from, every.start), nearest_m(&leading, every.start)), "{what}");
        let sides =
            |set: &[bool]| every.places.iter().zip(set).filter(|(_, is_in)| **is_in).map(|(place, _)| *place).collect::<Vec<_>>();
        let (mut refusals, mut without_ground) = (0, 0);
        for (from, to) in sides(&reached).iter().flat_map(|from| sides(&leading).into_iter().map(move |to| (*from, to))) {
            match is_near(&ground, [&from, &to]).then(|| by_slice(&ground, [&from, &to], false)) {
                Some(Some(Err(_))) => refusals += 1,
                Some(None) => without_ground += 1,
                _ => {}
            }
        }
        // Those that the speeds alone refuse come on top.
        assert!(gap.judged == gap.pairs && gap.pairs == gap.refusals.total() + gap.without_ground, "{what}");
        assert!(gap.refusals.total() >= refusals && gap.without_ground >= without_ground, "{what}: {refusals}, {without_ground}");
        across += u32::from(gap.pairs > 0);
        wide += u32::from(gap.width_m.is_none());
    }
    assert!(noes > 20 && across > 10 && wide > 0, "{noes} noes, {across} with hops across, {wide} wider than a hop");
    assert!(8 * touching < noes, "{touching} of {noes} differ");
}

/// Risk is judged in closed form: less of it takes other hops, and what it takes adds up.
#[test]
fn the_least_risk_is_no_more_than_that_of_the_fewest_hops() {
    let draw = &mut Draw::seeded(1746);
    let (mut routes, mut safer) = (0, 0);
    let errors =
        Uncertainty { takeoff_speed_sigma_fraction: 0.02, takeoff_angle_sigma: Angle::from_degrees(1.0), ..Uncertainty::NONE };
    for _ in 0..40 {
        let ground = random_world(draw, 6).ground();
        let Some([start, goal]) = random_ends(draw, &ground) else { continue };
        let nodes = nodes(&ground, 1, [start, goal], None);
        let goal = RouteGoal { start, goal, effort: Effort::TakeoffSpeed, takeoff: TakeoffChoice::LeastSpeed };
        let risk_of = |amounts: Vec<Amount>| {
            let objective = Objective::new(amounts).unwrap();
            let question = RouteQuestion {
                objective: &objective,
                budgets: &Budgets::NONE,
                commands: SearchedCommands::Distinct,
                errors: Some((&errors, &ground)),
                cap: LabelCap::default(),
            };
            free_route_by(&ground, &nodes, &goal, &question, &())
                .unwrap()
                .path
                .map(|path| (path.totals.of(Amount::Risk), path.cost.hops()))
        };
        let (Some(by_hops), Some(by_risk)) = (risk_of(vec![Amount::Hops, Amount::Risk]), risk_of(vec![Amount::Risk])) else {
            continue;
        };
        assert!(by_risk.0 <= by_hops.0 && by_risk.1 >= by_hops.1 && by_risk.0 > 0.0, "{by_risk:?} against {by_hops:?}");
        routes += 1;
        safer += u32::from(by_risk.0 < 0.99 * by_hops.0);
    }
    assert!(routes > 5 && safer > 0, "{routes} routes, {safer} safer");
}
