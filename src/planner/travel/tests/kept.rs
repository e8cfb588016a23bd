//! Searches that hold tables, drive legs and pairs against the same searches without any, and the bounds on what is left against what was found.

use super::{
    super::{super::*, least::LeastLeft, *},
    World, objective, world,
};
use crate::{ballistics::TakeoffChoice, draw::Draw};

/// Next to the end of a cone tables have lofts that differ by some 1e-8 of themselves.
fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * (1.0 + a.abs().max(b.abs()))
}

/// What is to be least.
const AMOUNTS: [&[Amount]; 3] =
    [&[Amount::MissionTime, Amount::Energy], &[Amount::Energy], &[Amount::Distance, Amount::MissionTime]];

#[test]
fn missions_are_the_same_whatever_a_search_holds() {
    let draw = &mut Draw::seeded(1921);
    let (mut found, mut none) = (0, 0);
    for case in 0..60 {
        let turn_s_per_deg = if case % 3 == 0 { 0.3 } else { 0.0 };
        let Some(world) = world(draw, turn_s_per_deg) else { continue };
        for means in [Travel::Both, Travel::Hop, Travel::Drive] {
            for amounts in AMOUNTS {
                let objective = objective(amounts);
                let [held, plain] = [MissionQuestion::KEPT_BYTES, 0].map(|kept_bytes_max| {
                    let question = MissionQuestion { kept_bytes_max, ..world.question(&objective, &Budgets::NONE, means) };
                    travel(&world.ground, &world.nodes, &World::goal(world.ends), &question, &()).unwrap()
                });
                assert_eq!(held.path.is_some(), plain.path.is_some(), "case {case}, {means}, {objective}");
                assert_eq!(plain.stopped.is_some(), held.stopped.is_some());
                if let (Some(held), Some(plain)) = (held.path, plain.path) {
                    let [a, b] = [held.totals.of(amounts[0]), plain.totals.of(amounts[0])];
                    assert!(near(a, b), "case {case}, {means}, {objective}: {a}, plainly {b}");
                    found += 1;
                } else {
                    none += 1;
                }
            }
        }
    }
    assert!(found > 200 && none > 20, "{found} missions, {none} without");
}

#[test]
fn fields_are_the_same_whatever_a_search_holds() {
    let draw = &mut Draw::seeded(1922);
    let (mut reached, mut cut_off) = (0, 0);
    for case in 0..30 {
        let Some(world) = world(draw, if case % 4 == 0 { 0.2 } else { 0.0 }) else { continue };
        let start = world.nodes.place(world.ends[0]).unwrap();
        for (means, toward) in
            [Travel::Both, Travel::Hop].into_iter().flat_map(|means| [(means, Toward::Nodes), (means, Toward::Start)])
        {
            let objective = objective(AMOUNTS[case % 3]);
            let [held, plain] = [MissionQuestion::KEPT_BYTES, 0].map(|kept_bytes_max| {
                let question = MissionQuestion { kept_bytes_max, ..world.question(&objective, &Budgets::NONE, means) };
                let asked = (&question, TakeoffChoice::LeastTime, toward);
                travel_field((&world.ground, &world.nodes), &[start], asked, &()).unwrap()
            });
            for node in (0..world.nodes.count()).map(SurfaceNode::of_index) {
                let [a, b] = [&held, &plain].map(|field| field.total(node, objective.first()));
                assert_eq!(a.is_some(), b.is_some(), "case {case}, {means}, {toward:?}, node {node:?}");
                if let (Some(a), Some(b)) = (a, b) {
                    assert!(near(a, b), "case {case}, {means}, {toward:?}: {a}, plainly {b}");
                    reached += 1;
                } else {
                    cut_off += 1;
                }
            }
        }
    }
    assert!(reached > 2000 && cut_off > 100, "{reached} reached, {cut_off} cut off");
}

/// With budgets and on fronts a search comes to a node with many labels, and finds the pairs that it keeps.
#[test]
fn fronts_are_the_same_whatever_a_search_holds() {
    let draw = &mut Draw::seeded(1923);
    let mut points = 0;
    for case in 0..25 {
        let Some(world) = world(draw, if case % 2 == 0 { 0.2 } else { 0.0 }) else { continue };
        let objective = objective(&[Amount::MissionTime]);
        let budgets = Budgets::NONE.with(Amount::Hops, 6.0).unwrap();
        // Room for everything, for some pairs, and for nothing.
        let fronts = [MissionQuestion::KEPT_BYTES, 20_000, 0].map(|kept_bytes_max| {
            let question = MissionQuestion { kept_bytes_max, ..world.question(&objective, &budgets, Travel::Both) };
            let asked = (Amount::MissionTime, &question);
            front_of_missions(&world.ground, &world.nodes, &World::goal(world.ends), asked, &()).unwrap()
        });
        let [held, some, plain] = fronts.map(|front| front.paths);
        assert_eq!((held.len(), some.len()), (plain.len(), plain.len()), "case {case}");
        for ((held, some), plain) in held.iter().zip(&some).zip(&plain) {
            for amount in [Amount::Hops, Amount::MissionTime] {
                let b = plain.totals.of(amount);
                assert!(near(held.totals.of(amount), b) && near(some.totals.of(amount), b), "case {case}, {amount}");
            }
            points += 1;
        }
    }
    assert!(points > 15, "{points} points");
}

/// What is left from every node to the goal is no less than its bound, whatever is least.
#[test]
fn no_mission_takes_less_than_its_bounds() {
    let draw = &mut Draw::seeded(1924);
    let (mut rests, mut tight) = (0, 0);
    for case in 0..60 {
        let Some(world) = world(draw, 0.0) else { continue };
        let goal = world.nodes.place(world.ends[1]).unwrap();
        let at = world.nodes.position(&world.ground, goal).unwrap();
        let hops = LeastAmounts::over_dem(&world.ground);
        for (means, amount) in Travel::ALL
            .into_iter()
            .flat_map(|means| [Amount::MissionTime, Amount::Energy, Amount::Distance].map(|amount| (means, amount)))
        {
            let least = LeastLeft::of(&world.ground, means.drives().then_some(&world.rover), means.hops().then_some(&hops));
            let objective = objective(&[amount]);
            let question = world.question(&objective, &Budgets::NONE, means);
            let asked = (&question, TakeoffChoice::LeastTime, Toward::Start);
            let field = travel_field((&world.ground, &world.nodes), &[goal], asked, &()).unwrap();
            for node in (0..world.nodes.count()).map(SurfaceNode::of_index) {
                let (Some(total), Some(from)) = (field.total(node, amount), world.nodes.position(&world.ground, node)) else {
                    continue;
                };
                let bound = least.between(&from, &at).of(amount);
                assert!(bound <= total, "case {case}, {means}: {amount} {total}, bound {bound}");
                rests += 1;
                tight += u32::from(bound > 0.5 * total);
            }
        }
    }
    assert!(rests > 5000 && tight > 1000, "{rests} bounds, {tight} more than half of what they bound");
}
