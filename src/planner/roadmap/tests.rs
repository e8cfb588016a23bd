//! Roadmaps against all pairs tested one by one, for any number of threads, and through a slot that sampled angles miss.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its meshes should stop")]

use std::{ops::ControlFlow, sync::atomic::Ordering::Relaxed};

use nalgebra::Point3;

use super::{
    ContactSampler, GrownRoadmap, Roadmap, RoadmapEnd, RoadmapFileError, RoadmapLimits, RoadmapQuestion, SpaceBounds, grow_roadmap,
};
use crate::{
    ballistics::TakeoffChoice,
    draw::Draw,
    ground::{MeshContact, MeshGround, MeshTakeoffSet},
    planner::{Amount, Amounts, Budgets, LabelCap, Objective, SearchedCommands},
    progress::{Progress, Step},
    terrain::{Mesh, MeshTree},
    world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
};

/// A mesh of quadrilaterals, each by its corners, counter-clockwise seen from outside.
pub(crate) fn mesh_of(quads: &[[[f64; 3]; 4]]) -> Mesh {
    let vertices = quads.iter().flatten().map(|corner| Point3::from(*corner)).collect();
    let triangles = (0..u32::try_from(quads.len()).unwrap()).flat_map(|quad| {
        let at = 4 * quad;
        [[at, at + 1, at + 2], [at, at + 2, at + 3]]
    });
    Mesh::new(vertices, triangles.collect()).unwrap()
}

/// The six sides of a box.
pub(crate) fn cuboid([x0, y0, z0]: [f64; 3], [x1, y1, z1]: [f64; 3]) -> [[[f64; 3]; 4]; 6] {
    [
        [[x0, y0, z1], [x1, y0, z1], [x1, y1, z1], [x0, y1, z1]],
        [[x0, y0, z0], [x0, y1, z0], [x1, y1, z0], [x1, y0, z0]],
        [[x0, y0, z0], [x1, y0, z0], [x1, y0, z1], [x0, y0, z1]],
        [[x0, y1, z0], [x0, y1, z1], [x1, y1, z1], [x1, y1, z0]],
        [[x0, y0, z0], [x0, y0, z1], [x0, y1, z1], [x0, y1, z0]],
        [[x1, y0, z0], [x1, y1, z0], [x1, y1, z1], [x1, y0, z1]],
    ]
}

/// A floor with boxes on it, some under others.
pub(crate) fn boxes(draw: &mut Draw, count: usize) -> Mesh {
    let mut quads = vec![[[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 8.0, 0.0], [0.0, 8.0, 0.0]]];
    for _ in 0..count {
        let low = [draw.uniform(0.5, 6.0), draw.uniform(0.5, 6.0), draw.uniform(-0.5, 1.5)];
        let high = [low[0] + draw.uniform(0.3, 2.0), low[1] + draw.uniform(0.3, 2.0), low[2] + draw.uniform(0.2, 1.5)];
        quads.extend(cuboid(low, high));
    }
    mesh_of(&quads)
}

pub(crate) fn ground(mesh: Mesh, speed_m_s: f64, friction: f64, gravity_m_s2: f64) -> MeshGround {
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(friction).unwrap())), rest: RestSlope::Unlimited };
    let hopper = Hopper::with_speeds(speed_m_s, speed_m_s).unwrap();
    MeshGround::new(MeshTree::new(mesh), &hopper, Gravity::new(gravity_m_s2).unwrap(), &surface).unwrap()
}

fn question<'a>(objective: &'a Objective, budgets: &'a Budgets) -> RoadmapQuestion<'a> {
    let commands = SearchedCommands::Distinct;
    RoadmapQuestion { objective, budgets, commands, takeoff: TakeoffChoice::LeastSpeed, cap: LabelCap::default() }
}

/// Start, goal and so many contacts more.
pub(crate) fn contacts(ground: &MeshGround, count: usize, seed: u64) -> Vec<MeshContact> {
    let ends = [[0.2, 0.3, 0.0], [7.7, 7.6, 0.0]].map(|at| ground.contact(Point3::from(at)).unwrap());
    let mut sampler = ContactSampler::new(ground, None, 0.0, seed).unwrap();
    ends.into_iter().chain(sampler.all_over(count, &|_| true)).collect()
}

/// The least total of an amount over all pairs of contacts, tested one by one, by Dijkstra's algorithm in its plainest form.
fn brute_force(ground: &MeshGround, contacts: &[MeshContact], amount: Amount) -> Option<f64> {
    let limits = ground.envelope().hopper().limits();
    let edge = |from: usize, to: usize| {
        let set = ground.takeoff_set(&contacts[from], &contacts[to])?;
        let choices = [TakeoffChoice::LeastSpeed, TakeoffChoice::LeastTime, TakeoffChoice::MidRange];
        let arcs = choices.into_iter().filter_map(|choice| Some(set.arc(choice, ground.envelope().gravity_m_s2())?.1));
        arcs.map(|arc| Amounts::of_arc(&arc, limits, false).of(amount)).min_by(f64::total_cmp)
    };
    let count = contacts.len();
    let (mut known, mut done) = (vec![f64::INFINITY; count], vec![false; count]);
    known[0] = 0.0;
    loop {
        let at =
            (0..count).filter(|node| !done[*node] && known[*node].is_finite()).min_by(|a, b| known[*a].total_cmp(&known[*b]))?;
        if at == 1 {
            return Some(known[1]);
        }
        done[at] = true;
        for to in (0..count).filter(|to| !done[*to]) {
            if let Some(weight) = edge(at, to) {
                known[to] = known[to].min(known[at] + weight);
            }
        }
    }
}

#[test]
fn the_best_path_is_that_of_all_pairs_tested_one_by_one() {
    let draw = &mut Draw::seeded(1801);
    let (mut found, mut lost) = (0, 0);
    for scene in 0..8 {
        let gravity = draw.log_uniform(1e-5, 25.0);
        let (speed, friction) = ((gravity * draw.uniform(1.5, 7.0)).sqrt(), draw.uniform(0.3, 1.5));
        let ground = ground(boxes(draw, 6), speed, friction, gravity);
        let contacts = contacts(&ground, 26, scene);
        let mut roadmap = Roadmap::new();
        // In two steps: what is added later counts the same.
        let (first, second) = contacts.split_at(11);
        roadmap.extend(&ground, first.to_vec(), &()).unwrap();
        roadmap.extend(&ground, second.to_vec(), &()).unwrap();
        assert_eq!(roadmap.pairs_tested(), (contacts.len() * (contacts.len() - 1)) as u64);
        for amount in [Amount::Hops, Amount::ArcLength, Amount::Energy, Amount::FlightTime] {
            let objective = Objective::of(amount);
            let route = roadmap.route(&ground, (0, 1), &question(&objective, &Budgets::NONE)).unwrap();
            let expected = brute_force(&ground, &contacts, amount);
            assert_eq!(route.path.is_some(), expected.is_some(), "scene {scene}, {amount}");
            if let (Some(path), Some(expected)) = (&route.path, expected) {
                found += 1;
                let total = path.totals.of(amount);
                assert!((total - expected).abs() <= 1e-9 * expected, "scene {scene}: {amount} {total}, expected {expected}");
                assert_eq!(path.moves.len() + 1, path.contacts.len());
                let sum: f64 = path.arcs().iter().map(|arc| amount.of_arc(arc, ground.envelope().hopper().limits(), false)).sum();
                assert!((sum - total).abs() <= 1e-9 * total, "the arcs take {sum}, the totals say {total}");
            } else {
                lost += 1;
                let gap = roadmap.gap(&ground, (0, 1), &()).unwrap();
                assert!(gap.reached + gap.leading <= contacts.len() && gap.judged <= gap.pairs);
                assert_eq!(gap.refusals.total() + gap.vertical, gap.judged, "every hop across the gap is refused");
            }
        }
    }
    assert!(found >= 8 && lost >= 4, "{found} paths, {lost} without");
}

#[test]
fn every_window_of_every_pair_is_an_edge() {
    let draw = &mut Draw::seeded(1802);
    let ground = ground(boxes(draw, 8), 6.0, 1.0, 5.0);
    let contacts = contacts(&ground, 40, 3);
    let mut roadmap = Roadmap::new();
    roadmap.extend(&ground, contacts.clone(), &()).unwrap();
    let mut windows = 0;
    for (from, takeoff) in contacts.iter().enumerate() {
        for (to, landing) in contacts.iter().enumerate().filter(|(to, _)| *to != from) {
            let set = ground.takeoff_set(takeoff, landing);
            let expected: Vec<_> = set.iter().flat_map(MeshTakeoffSet::windows).map(|window| window.lofts).collect();
            let found = roadmap.windows_between(from, to);
            assert_eq!(found.len(), expected.len(), "{from} to {to}");
            for (found, expected) in found.iter().zip(&expected) {
                let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (1.0 + b.abs());
                assert!(near(found.lower, expected.lower) && near(found.upper, expected.upper), "{found:?} {expected:?}");
            }
            windows += found.len();
        }
    }
    assert_eq!(roadmap.window_count(), windows);
    assert!(windows > 200, "{windows} windows");
}

fn grown(ground: &MeshGround, contacts_max: usize, seed: u64) -> GrownRoadmap {
    grown_within(ground, &Budgets::NONE, contacts_max, seed)
}

fn grown_within(ground: &MeshGround, budgets: &Budgets, contacts_max: usize, seed: u64) -> GrownRoadmap {
    let objective = Objective::new(vec![Amount::Hops, Amount::ArcLength]).unwrap();
    let ends = [[0.2, 0.3, 0.0], [7.7, 7.6, 0.0]].map(|at| ground.contact(Point3::from(at)).unwrap());
    let mut sampler = ContactSampler::new(ground, None, 0.0, seed).unwrap();
    let limits = RoadmapLimits { contacts_max, time_max: None };
    grow_roadmap(ground, ends, &mut sampler, &question(&objective, budgets), limits, &()).unwrap()
}

/// While the best path exceeds a budget, gaining little about it is no reason to stop.
#[test]
fn a_roadmap_grows_on_while_a_budget_is_not_kept() {
    let ground = ground(boxes(&mut Draw::seeded(1804), 7), 4.0, 0.9, 5.0);
    let free = grown(&ground, 2000, 1);
    assert_eq!(free.end, RoadmapEnd::Gain, "{:?}", free.history);
    let taken = free.route.path.unwrap().totals.of(Amount::ArcLength);
    let kept = grown_within(&ground, &Budgets::NONE.with(Amount::ArcLength, taken).unwrap(), 2000, 1);
    let unmet = grown_within(&ground, &Budgets::NONE.with(Amount::ArcLength, 0.1 * taken).unwrap(), 2000, 1);
    assert!(kept.route.within && !unmet.route.within);
    assert_eq!((unmet.end, unmet.roadmap.contact_count()), (RoadmapEnd::Contacts, 2000));
}

#[test]
fn one_thread_and_two_give_the_same_bytes_and_json_reads_back() {
    let ground = ground(boxes(&mut Draw::seeded(1803), 7), 5.0, 0.9, 5.0);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let grown = pool.install(|| grown(&ground, 120, 5));
        let mut text = Vec::new();
        grown.roadmap.write_json(&ground, &mut text).unwrap();
        (grown, text)
    };
    let ((one, text), (two, other)) = (with(1), with(2));
    assert!(text == other && one.history == two.history && one.route == two.route);
    let again = Roadmap::read_json(&ground, text.as_slice()).unwrap();
    let mut written = Vec::new();
    again.write_json(&ground, &mut written).unwrap();
    assert!(written == text, "written again it is the same");
    let objective = Objective::of(Amount::ArcLength);
    let asked = question(&objective, &Budgets::NONE);
    assert_eq!(again.route(&ground, (0, 1), &asked), one.roadmap.route(&ground, (0, 1), &asked));

    let read = |text: &str| Roadmap::read_json(&ground, text.as_bytes());
    let text = String::from_utf8(text).unwrap();
    let unknown = text.replacen("\"contacts\"", "\"more\":1,\"contacts\"", 1);
    assert!(matches!(read(&unknown), Err(RoadmapFileError::Json(_))));
    assert!(matches!(read(&text.replacen("roadmap/1", "roadmap/7", 1)), Err(RoadmapFileError::Schema { .. })));
    let off = text.replacen("\"point_m\":[", "\"point_m\":[-9", 1);
    assert!(matches!(read(&off), Err(RoadmapFileError::Contact { number: 0 })));
    let (head, windows) = text.split_once("\"windows\":[[").unwrap();
    let far = format!("{head}\"windows\":[[999999,0,1.0,2.0],[{windows}");
    assert!(matches!(read(&far), Err(RoadmapFileError::Window { number: 0 })));
    let slower = super::tests::ground(boxes(&mut Draw::seeded(1803), 7), 4.0, 0.9, 5.0);
    assert!(matches!(Roadmap::read_json(&slower, text.as_bytes()), Err(RoadmapFileError::OtherGround)));
}

#[test]
fn more_contacts_never_make_the_best_path_worse_and_its_end_is_said() {
    let ground = ground(boxes(&mut Draw::seeded(1804), 7), 4.0, 0.9, 5.0);
    let grown = grown(&ground, 200, 1);
    let totals: Vec<Amounts> = grown.history.iter().filter_map(|round| round.totals).collect();
    assert!(totals.len() > 1, "{:?}", grown.history);
    for pair in totals.windows(2) {
        let [before, after] = [&pair[0], &pair[1]].map(|totals| [totals.of(Amount::Hops), totals.of(Amount::ArcLength)]);
        assert!(after[0] < before[0] || (after[0] == before[0] && after[1] <= before[1]), "{before:?} {after:?}");
    }
    assert!(grown.history.last().unwrap().contacts <= 200);
    assert!(matches!(grown.end, RoadmapEnd::Contacts | RoadmapEnd::Gain), "{:?}", grown.end);
    assert!(grown.drawn.buried > 0 && grown.drawn.on_facets > 0 && grown.drawn.by_area > 0);
}

/// Two pads with a wall between them that has a slot, which none of the seven angles of Campana and Laumond crosses.
#[test]
fn a_slot_that_sampled_angles_miss_is_passed() {
    let pad = |x: f64| [[x - 0.05, -0.05, 0.0], [x + 0.05, -0.05, 0.0], [x + 0.05, 0.05, 0.0], [x - 0.05, 0.05, 0.0]];
    let wall = |low: f64, high: f64| [[1.0, -9.0, low], [1.0, 9.0, low], [1.0, 9.0, high], [1.0, -9.0, high]];
    let ground = ground(mesh_of(&[pad(0.0), pad(2.0), wall(-9.0, 1.21), wall(1.48, 9.0)]), 6.5, 1.2, 9.81);
    let ends = [0.0, 2.0].map(|x| ground.contact(Point3::new(x, 0.01, 0.0)).unwrap());
    let pads = SpaceBounds { min: Point3::new(-0.1, -0.1, -0.1), max: Point3::new(2.1, 0.1, 0.1) };
    let mut sampler = ContactSampler::new(&ground, Some(pads), 0.0, 0).unwrap();
    let mut roadmap = Roadmap::new();
    roadmap.extend(&ground, ends.into(), &()).unwrap();
    roadmap.extend(&ground, sampler.all_over(30, &|_| true), &()).unwrap();
    let on = |node: usize, x: f64| (roadmap.contact(node).point_m() - Point3::new(x, 0.0, 0.0)).amax() < 0.06;
    let node_count = roadmap.contact_count();
    let on_pad = |x: f64| (0..node_count).filter(move |node| on(*node, x)).collect::<Vec<_>>();
    for from in on_pad(0.0) {
        for to in on_pad(2.0) {
            assert!(!roadmap.windows_between(from, to).is_empty(), "{from} to {to}");
        }
    }
    let objective = Objective::of(Amount::Hops);
    let path = roadmap.route(&ground, (0, 1), &question(&objective, &Budgets::NONE)).unwrap().path.unwrap();
    assert_eq!(path.contacts, [0, 1]);
    let height_m = path.arcs()[0].height_at_m(1.0);
    assert!((1.21..=1.48).contains(&height_m), "{height_m} m in the slot");
}

/// Cancels after so many reports.
struct After(std::sync::atomic::AtomicU64);

impl Progress for After {
    fn report(&self, _: &Step) -> ControlFlow<()> {
        let left = self.0.fetch_update(Relaxed, Relaxed, |left| left.checked_sub(1));
        if left.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

#[test]
fn a_cancelled_roadmap_is_as_it_was() {
    let ground = ground(boxes(&mut Draw::seeded(1806), 5), 5.0, 0.9, 5.0);
    let (first, second) = (contacts(&ground, 20, 0), contacts(&ground, 400, 1));
    let mut roadmap = Roadmap::new();
    roadmap.extend(&ground, first, &()).unwrap();
    let before = (roadmap.contact_count(), roadmap.window_count(), roadmap.pairs_tested());
    for reports in [0, 1] {
        let cancelled = roadmap.extend(&ground, second.clone(), &After(reports.into()));
        assert!(cancelled.is_err(), "after {reports} reports");
        assert_eq!((roadmap.contact_count(), roadmap.window_count(), roadmap.pairs_tested()), before);
    }
    assert!(roadmap.gap(&ground, (0, 1), &After(0.into())).is_err());
}

#[test]
fn bounds_that_hold_nothing_are_refused_and_a_stand_off_is_kept() {
    let ground = ground(boxes(&mut Draw::seeded(1805), 5), 5.0, 0.9, 5.0);
    let far = SpaceBounds { min: Point3::new(50.0, 0.0, 0.0), max: Point3::new(60.0, 9.0, 9.0) };
    let refused = ContactSampler::new(&ground, Some(far), 0.0, 0).unwrap_err().to_string();
    assert!(refused.contains("hold no facet") && refused.contains("(50, 0, 0)"), "{refused}");
    let mut sampler = ContactSampler::new(&ground, None, 0.05, 0).unwrap();
    let contacts = sampler.all_over(60, &|_| true);
    assert!(contacts.len() == 60 && sampler.drawn().buried > 0);
    for contact in &contacts {
        let away_m = ground.tree().nearest(contact.point_m()).distance_m;
        assert!((away_m - 0.05).abs() < 1e-6, "{away_m} m");
    }
}
