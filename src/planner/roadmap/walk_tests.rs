//! Walking beside hops against all pairs tried one by one, with a machine that walks where the ground rises little.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its meshes should stop")]

use nalgebra::Point3;

use super::{
    Roadmap, RoadmapGround, RoadmapMove, RoadmapQuestion,
    tests::{boxes, contacts, ground},
};
use crate::{
    ballistics::{FlightEnvelope, LineOfSight, PathBounds, TakeoffChoice},
    draw::Draw,
    drive::DriveLimit,
    ground::{MeshBuffers, MeshContact, MeshGround},
    planner::{Amount, Amounts, Budgets, LabelCap, Objective, SearchedCommands},
    quantity::SlopeInterval,
    world::Limit,
};

/// A hopper that also walks straight from contact to contact, where the straight line is not steep and not long.
struct Walker {
    ground: MeshGround,
    neighbours: usize,
    speed_m_s: f64,
    longest_m: f64,
}

impl Walker {
    fn line(&self, from: &MeshContact, to: &MeshContact) -> Result<f64, DriveLimit> {
        let away = to.point_m() - from.point_m();
        if away.z > 0.2 * away.norm() {
            Err(DriveLimit::SlopeUp)
        } else if away.norm() > self.longest_m {
            Err(DriveLimit::Ground)
        } else {
            Ok(away.norm())
        }
    }
}

impl RoadmapGround for Walker {
    type Node = MeshContact;
    type Buffers = MeshBuffers;

    fn point_m(&self, contact: &MeshContact) -> Point3<f64> {
        contact.point_m()
    }

    fn envelope(&self) -> &FlightEnvelope {
        self.ground.envelope()
    }

    fn speed_bounds(&self) -> PathBounds {
        self.ground.speed_bounds()
    }

    fn relief_m(&self) -> f64 {
        RoadmapGround::relief_m(&self.ground)
    }

    fn are_one_place(&self, contacts: [&MeshContact; 2]) -> bool {
        self.ground.are_one_place(contacts)
    }

    fn sight(&self, takeoff: &MeshContact, landing: &MeshContact) -> Option<LineOfSight> {
        self.ground.sight(takeoff, landing)
    }

    fn windows<'b>(
        &self,
        takeoff: &MeshContact,
        landing: &MeshContact,
        buffers: &'b mut MeshBuffers,
    ) -> Option<(LineOfSight, &'b [SlopeInterval])> {
        self.ground.windows(takeoff, landing, buffers)
    }

    fn refused_by(&self, takeoff: &MeshContact, landing: &MeshContact) -> Option<Limit> {
        self.ground.refused_by(takeoff, landing)
    }

    fn walk_neighbours(&self) -> usize {
        self.neighbours
    }

    fn walk(&self, from: &MeshContact, to: &MeshContact) -> Result<Amounts, DriveLimit> {
        let length_m = self.line(from, to)?;
        Ok(Amounts::NONE.with(Amount::MissionTime, length_m / self.speed_m_s).with(Amount::Distance, length_m))
    }
}

/// The least total of an amount over all pairs by Dijkstra's algorithm in its plainest form; `walks`: whether a pair may be walked.
fn brute_force(walker: &Walker, contacts: &[MeshContact], amount: Amount, walks: impl Fn(usize, usize) -> bool) -> Option<f64> {
    let (ground, limits) = (&walker.ground, walker.ground.envelope().hopper().limits());
    let edge = |from: usize, to: usize| {
        let hop = ground.takeoff_set(&contacts[from], &contacts[to]).and_then(|set| {
            let choices = [TakeoffChoice::LeastSpeed, TakeoffChoice::LeastTime, TakeoffChoice::MidRange];
            let arcs = choices.into_iter().filter_map(|choice| Some(set.arc(choice, ground.envelope().gravity_m_s2())?.1));
            // It settles after every landing but the last: contact 1 is the goal.
            arcs.map(|arc| Amounts::of_arc(&arc, limits, to == 1).of(amount)).min_by(f64::total_cmp)
        });
        let walk =
            walks(from, to).then(|| walker.walk(&contacts[from], &contacts[to]).ok()).flatten().map(|taken| taken.of(amount));
        hop.into_iter().chain(walk).min_by(f64::total_cmp)
    };
    let count = contacts.len();
    let (mut known, mut done) = (vec![f64::INFINITY; count], vec![false; count]);
    known[0] = 0.0;
    loop {
        let open = (0..count).filter(|node| !done[*node] && known[*node].is_finite());
        let at = open.min_by(|a, b| known[*a].total_cmp(&known[*b]))?;
        if at == 1 {
            return Some(known[1]);
        }
        done[at] = true;
        for to in (0..count).filter(|to| *to != at && !done[*to]) {
            if let Some(weight) = edge(at, to) {
                known[to] = known[to].min(known[at] + weight);
            }
        }
    }
}

#[test]
fn walks_and_hops_together_are_the_best_of_all_pairs_tried_one_by_one() {
    let draw = &mut Draw::seeded(2020);
    let (mut mixed, mut walked, mut without, mut saved) = (0, 0, 0, 0);
    for scene in 0..14 {
        let gravity = draw.log_uniform(1e-3, 25.0);
        let (speed, friction) = ((gravity * draw.uniform(1.0, 4.0)).sqrt(), draw.uniform(0.3, 1.5));
        let ground = ground(boxes(draw, 6), speed, friction, gravity);
        let contacts = contacts(&ground, 22, scene);
        // Beside a hop of some seconds, walking is now quick and now slow.
        let hop_s = speed / gravity;
        let speed_m_s = draw.log_uniform(0.03, 3.0) / hop_s;
        let all = Walker { ground, neighbours: usize::MAX, speed_m_s, longest_m: draw.uniform(1.0, 6.0) };
        let mut roadmap = Roadmap::new();
        let (first, second) = contacts.split_at(9);
        roadmap.extend(&all, first.to_vec(), &()).unwrap();
        roadmap.extend(&all, second.to_vec(), &()).unwrap();
        let pairs = (contacts.len() * (contacts.len() - 1)) as u64;
        let lines: usize = (0..contacts.len()).map(|node| roadmap.walks().of(node).len()).sum();
        assert_eq!((roadmap.walks().tested(), roadmap.walks().refusals().total() + lines as u64), (pairs, pairs));
        for amount in [Amount::Hops, Amount::MissionTime] {
            let objective = Objective::new(vec![amount, Amount::Distance]).unwrap();
            let asked = RoadmapQuestion {
                objective: &objective,
                budgets: &Budgets::NONE,
                commands: SearchedCommands::Distinct,
                takeoff: TakeoffChoice::LeastSpeed,
                cap: LabelCap::default(),
            };
            let route = roadmap.route(&all, (0, 1), &asked).unwrap();
            let expected = brute_force(&all, &contacts, amount, |_, _| true);
            assert_eq!(route.path.as_ref().is_some(), expected.is_some(), "scene {scene}, {amount}");
            // What is left from every node is what the best route from there takes.
            let left = roadmap.left(&all, (0, 1), &asked).unwrap();
            for (node, left) in left.iter().enumerate() {
                let best = roadmap.route(&all, (node, 1), &asked).unwrap().path.map(|path| path.totals.of(amount));
                let agree = match (best, left) {
                    (Some(best), Some(left)) => (best - left.amount).abs() <= 1e-9 * (1.0 + best),
                    (None, None) => true,
                    _ => false,
                };
                assert!(agree, "scene {scene}, node {node}: {left:?}, expected {best:?} of {amount}");
            }
            let (Some(path), Some(expected)) = (route.path, expected) else {
                without += 1;
                continue;
            };
            let total = path.totals.of(amount);
            assert!((total - expected).abs() <= 1e-9 * expected, "scene {scene}: {amount} {total}, expected {expected}");
            let walks = path.moves.iter().filter(|each| **each == RoadmapMove::Walk).count();
            assert_eq!((path.arcs().len() + walks, path.takeoffs().len()), (path.moves.len(), path.arcs().len()));
            mixed += u32::from(walks > 0 && walks < path.moves.len());
            walked += u32::from(walks > 0);
            let hops_alone = brute_force(&all, &contacts, amount, |_, _| false);
            saved += u32::from(hops_alone.is_none_or(|alone| alone > total * (1.0 + 1e-9)));
            if amount == Amount::Hops {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of hops")]
                let hops = total as u32;
                assert_eq!((roadmap.hops_to(1)[0], roadmap.hops_out_of(0)[1]), (Some(hops), Some(hops)));
            }
        }
        // With few neighbours the lines are some of all.
        let few = Walker { neighbours: 3, ..all };
        let mut roadmap = Roadmap::new();
        roadmap.extend(&few, contacts.clone(), &()).unwrap();
        assert!(roadmap.walks().tested() < pairs);
        for from in 0..contacts.len() {
            for (to, taken) in roadmap.walks().of(from) {
                assert_eq!(few.walk(&contacts[from], &contacts[*to]).unwrap(), *taken);
            }
            // Each is joined to start and goal, both ways, wherever the line is walkable.
            for end in [0, 1].into_iter().filter(|end| *end != from) {
                let leads = roadmap.walks().of(from).iter().any(|(to, _)| *to == end);
                assert_eq!(leads, few.line(&contacts[from], &contacts[end]).is_ok());
            }
        }
    }
    assert!(
        mixed >= 2 && walked >= 6 && saved >= 5 && without >= 1,
        "{mixed} mixed, {walked} walked, {saved} saved, {without} without"
    );
}
