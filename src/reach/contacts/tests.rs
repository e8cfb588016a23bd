//! What is reached against all pairs of contacts by their windows, and against the roadmap of the same contacts.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its meshes should stop")]

use std::{ops::ControlFlow, time::Duration};

use nalgebra::Point3;

use super::{ContactHops, SpreadQuestion, Way, contact_hops, spread};
use crate::{
    ballistics::TakeoffChoice,
    draw::Draw,
    ground::{MeshContact, MeshGround},
    planner::{
        Amount, Budgets, LabelCap, Objective, SearchedCommands,
        roadmap::{
            ContactSampler, Roadmap, RoadmapEnd, RoadmapLimits, RoadmapQuestion,
            tests::{boxes, contacts, ground, mesh_of},
        },
    },
    progress::{Progress, Step},
    world::Hopper,
};

/// A scene of boxes, with contacts on it.
fn scene(draw: &mut Draw, number: u64, count: usize) -> (MeshGround, Vec<MeshContact>) {
    let gravity = draw.log_uniform(1e-5, 25.0);
    let (speed, friction) = ((gravity * draw.uniform(1.0, 5.0)).sqrt(), draw.uniform(0.3, 1.5));
    let alike = ground(boxes(draw, 7), speed, friction, gravity);
    // With two speeds, ways back are not those out.
    let hopper = Hopper::with_speeds(speed, speed * draw.uniform(0.5, 1.5)).unwrap();
    let ground = alike.under(&hopper, alike.envelope().gravity(), alike.surface()).unwrap();
    let contacts = contacts(&ground, count, number);
    (ground, contacts)
}

/// The fewest hops by relaxing all pairs until nothing changes, each pair tested by the windows of its slice.
fn brute_force(ground: &MeshGround, contacts: &[MeshContact], way: Way) -> Vec<Option<u32>> {
    let count = contacts.len();
    let feasible = |from: usize, to: usize| {
        let (from, to) = if way == Way::Out { (from, to) } else { (to, from) };
        ground.takeoff_set(&contacts[from], &contacts[to]).is_some_and(|set| !set.windows().is_empty())
    };
    let edges: Vec<Vec<bool>> = (0..count).map(|from| (0..count).map(|to| from != to && feasible(from, to)).collect()).collect();
    let mut hops = vec![None; count];
    hops[0] = Some(0);
    loop {
        let mut changed = false;
        for (from, to) in (0..count).flat_map(|from| (0..count).map(move |to| (from, to))) {
            if let Some(next) = hops[from].filter(|_| edges[from][to]).map(|hops: u32| hops + 1)
                && hops[to].is_none_or(|known| next < known)
            {
                (hops[to], changed) = (Some(next), true);
            }
        }
        if !changed {
            return hops;
        }
    }
}

#[test]
fn the_hops_are_those_of_all_pairs_by_their_windows() {
    let draw = &mut Draw::seeded(2111);
    let (mut reached, mut unreached, mut one_way, mut far) = (0, 0, 0, 0);
    for number in 0..10 {
        let (ground, contacts) = scene(draw, number, 44);
        let both = [Way::Out, Way::Back].map(|way| {
            let found = contact_hops(&ground, &contacts, (0, way), None, &()).unwrap();
            assert_eq!(found.hops, brute_force(&ground, &contacts, way), "scene {number}, {way:?}");
            assert!(found.is_complete && found.pairs_tested < (contacts.len() * contacts.len()) as u64);
            // Each contact is one hop from the one next to it, which is nearer by one.
            for (contact, next_to) in found.next_to.iter().enumerate() {
                let Some(near) = *next_to else { continue };
                assert_eq!(found.hops[contact], found.hops[near].map(|hops| hops + 1));
                let (from, to) = if way == Way::Out { (near, contact) } else { (contact, near) };
                assert!(!ground.takeoff_set(&contacts[from], &contacts[to]).unwrap().windows().is_empty());
            }
            let with_next = found.next_to.iter().flatten().count();
            assert_eq!(with_next + 1, found.count());
            // In at most two hops: the same contacts, and the others are left open.
            let near = contact_hops(&ground, &contacts, (0, way), Some(2), &()).unwrap();
            let expected: Vec<_> = found.hops.iter().map(|hops| hops.filter(|hops| *hops <= 2)).collect();
            assert_eq!(near.hops, expected);
            assert!(near.is_complete || near.count() < contacts.len());
            assert!(near.is_complete <= (found.farthest() <= 2), "complete, with farther contacts");
            found
        });
        reached += both[0].count();
        unreached += contacts.len() - both[0].count();
        far += usize::from(both[0].farthest() > 2);
        one_way += both[0].hops.iter().zip(&both[1].hops).filter(|(out, back)| out.is_some() != back.is_some()).count();
    }
    assert!(reached > 60 && unreached > 60 && far > 2, "{reached} reached, {unreached} not, {far} scenes with more than two hops");
    assert!(one_way > 0, "some ways lead one way only");
}

#[test]
fn the_hops_are_those_of_the_roadmap_and_of_its_plans() {
    let draw = &mut Draw::seeded(2112);
    let (objective, budgets) = (Objective::of(Amount::Hops), Budgets::NONE);
    let asked = RoadmapQuestion {
        objective: &objective,
        budgets: &budgets,
        commands: SearchedCommands::Distinct,
        takeoff: TakeoffChoice::LeastSpeed,
        cap: LabelCap::default(),
    };
    let (mut planned, mut without) = (0, 0);
    for number in 0..4 {
        let (ground, contacts) = scene(draw, 100 + number, 150);
        let mut roadmap = Roadmap::new();
        roadmap.extend(&ground, contacts.clone(), &()).unwrap();
        let out = contact_hops(&ground, &contacts, (0, Way::Out), None, &()).unwrap();
        let back = contact_hops(&ground, &contacts, (0, Way::Back), None, &()).unwrap();
        assert_eq!((&out.hops, &back.hops), (&roadmap.hops_out_of(0), &roadmap.hops_to(0)), "scene {number}");
        assert!(out.pairs_tested < roadmap.pairs_tested());
        for _ in 0..12 {
            let goal = 1 + draw.below(contacts.len() - 1);
            let path = roadmap.route(&ground, (0, goal), &asked).unwrap().path;
            assert_eq!(
                path.as_ref().map(|path| path.moves.len()),
                out.hops[goal].map(|hops| hops as usize),
                "scene {number}, goal {goal}"
            );
            if path.is_some() { planned += 1 } else { without += 1 }
        }
    }
    assert!(planned > 10 && without > 3, "{planned} paths, {without} without");
}

/// From a shelf one hops down, and not up again.
#[test]
fn a_shelf_is_left_and_not_reached_again() {
    let quad = |x: [f64; 2], z: f64| [[x[0], 0.0, z], [x[1], 0.0, z], [x[1], 2.0, z], [x[0], 2.0, z]];
    let ground = ground(mesh_of(&[quad([0.0, 2.0], 3.0), quad([2.0, 12.0], 0.0)]), 8.0, 1.0, 9.81);
    // A fall over 3 m lands with the speed of a take-off to as high.
    let hopper = Hopper::with_speeds(3.0, 8.5).unwrap();
    let ground = ground.under(&hopper, ground.envelope().gravity(), ground.surface()).unwrap();
    let mut sampler = ContactSampler::new(&ground, None, 0.0, 7).unwrap();
    let start = ground.contact(Point3::new(1.5, 1.0, 3.0)).unwrap();
    let limits = RoadmapLimits { contacts_max: 600, time_max: None };
    let found = spread(&ground, vec![start], &mut sampler, SpreadQuestion { hops_max: None, returns: true }, limits, &()).unwrap();
    let back = found.back.unwrap();
    let on_shelf = |contact: &MeshContact| contact.point_m().z > 1.0;
    assert!(found.contacts.iter().any(on_shelf) && found.contacts.iter().any(|contact| !on_shelf(contact)));
    for (number, contact) in found.contacts.iter().enumerate() {
        assert!(found.out.hops[number].is_some(), "{contact:?}");
        assert_eq!(back.hops[number].is_some(), on_shelf(contact), "{contact:?}");
    }
    assert_eq!((found.end, found.history.len(), found.contacts.len()), (RoadmapEnd::Contacts, 3, 600));
}

#[test]
fn rounds_end_in_time_threads_change_nothing_and_a_search_is_cancelled() {
    let ground = ground(boxes(&mut Draw::seeded(2113), 7), 5.0, 0.9, 5.0);
    let start = ground.contact(Point3::new(0.2, 0.3, 0.0)).unwrap();
    let with = |threads: usize, time_max: Option<Duration>| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut sampler = ContactSampler::new(&ground, None, 0.0, 4).unwrap();
        let limits = RoadmapLimits { contacts_max: 700, time_max };
        pool.install(|| spread(&ground, vec![start.clone()], &mut sampler, SpreadQuestion::default(), limits, &()).unwrap())
    };
    let (one, two) = (with(1, None), with(2, None));
    assert!(one.out == two.out && one.history == two.history && one.back.is_none());
    assert_eq!(one.history.iter().map(|round| round.contacts).collect::<Vec<_>>(), [256, 512, 700]);
    assert!(one.history.iter().all(|round| round.reached <= round.contacts && round.reached > 1), "{:?}", one.history);
    let ended = with(1, Some(Duration::ZERO));
    assert_eq!((ended.end, ended.history.len(), ended.contacts.len()), (RoadmapEnd::Time, 1, 256));
    assert!(contact_hops(&ground, &one.contacts, (0, Way::Out), None, &Never).is_err());
    let none = contact_hops(&ground, &[], (0, Way::Out), None, &()).unwrap();
    assert_eq!(none, ContactHops { hops: Vec::new(), next_to: Vec::new(), pairs_tested: 0, is_complete: true });
}

/// Cancels at once.
struct Never;

impl Progress for Never {
    fn report(&self, _: &Step) -> ControlFlow<()> {
        ControlFlow::Break(())
    }
}
