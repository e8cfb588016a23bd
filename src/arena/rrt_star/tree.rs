//! The tree: nodes with their parents and times.

use std::collections::BinaryHeap;

use super::{
    super::{
        Arena, ArenaPath, Move, PathPoint, Tariff,
        labels::Waiting,
        path::{flown, turn_rad},
    },
    buckets::Near,
    space::Space,
};
use crate::quantity::MapPoint;

/// How a node came to its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joined {
    /// The nearest node, as in RRT.
    Nearest,
    /// Another node by which it is reached sooner.
    Sooner,
    /// A later node, over which it was rewired.
    Rewired,
}

/// A node of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeNode {
    /// Where it is.
    pub point: MapPoint,
    /// The height under it, m.
    pub z_m: f64,
    /// The number of its parent; its own for the start.
    pub parent: u32,
    /// How it is reached from there.
    pub kind: Move,
    /// How it came to that parent.
    pub joined: Joined,
    /// The time to it, s.
    pub time_s: f64,
    /// The jumps to it.
    pub jumps: u32,
    /// The energy to it, J.
    pub energy_j: f64,
    /// The direction in which it is reached.
    direction: [f64; 2],
}

/// How a node would be reached.
struct Reached {
    kind: Move,
    time_s: f64,
    jumps: u32,
    energy_j: f64,
    direction: [f64; 2],
}

pub(super) struct Tree<'a> {
    arena: &'a Arena,
    space: &'a Space<'a>,
    tariff: Tariff,
    nodes: Vec<TreeNode>,
    children: Vec<Vec<u32>>,
    /// What a metre takes at least, s: below the true time, so that rounding does not let the bound pass it.
    least_s_per_m: f64,
    /// Space for the parents that wait to be looked at.
    waiting: Vec<Waiting>,
    goal: Option<u32>,
    /// The time of the best path so far, s, and its points.
    best: Option<(f64, Vec<PathPoint>)>,
}

/// A gain below this is rounding, s.
const SAME_S: f64 = 1e-12;

impl<'a> Tree<'a> {
    pub(super) fn new(arena: &'a Arena, tariff: Tariff, space: &'a Space<'a>) -> Self {
        let start = TreeNode {
            point: arena.start(),
            z_m: space.height_m(arena.start()).unwrap_or(0.0),
            parent: 0,
            kind: Move::Drive,
            joined: Joined::Nearest,
            time_s: 0.0,
            jumps: 0,
            energy_j: 0.0,
            direction: arena.heading(),
        };
        let fastest_m_s = tariff.flight.map_or(0.0, |flight| flight.along_m_s()).max(tariff.speed_m_s);
        let least_s_per_m = (1.0 - 1e-12) / fastest_m_s;
        let children = vec![Vec::new()];
        Self { arena, space, tariff, nodes: vec![start], children, least_s_per_m, waiting: Vec::new(), goal: None, best: None }
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn point(&self, node: u32) -> MapPoint {
        self.nodes[node as usize].point
    }

    pub(super) fn into_nodes(self) -> Vec<TreeNode> {
        self.nodes
    }

    /// The time of the best path so far, s.
    pub(super) fn best_s(&self) -> Option<f64> {
        self.best.as_ref().map(|(time_s, ..)| *time_s)
    }

    /// What reaching a place from a node takes, if the line between them is of this kind.
    fn priced(&self, from: u32, (point, z_m): (MapPoint, f64), kind: Move) -> Reached {
        let from = &self.nodes[from as usize];
        let way = point - from.point;
        let length_m = way.norm();
        let direction = if length_m > 0.0 { [way.x / length_m, way.y / length_m] } else { from.direction };
        let turn_s =
            if self.tariff.turn_s_per_rad > 0.0 { self.tariff.turn_s_per_rad * turn_rad(from.direction, direction) } else { 0.0 };
        let part_s = self.tariff.move_s(kind, length_m, z_m - from.z_m, from.jumps) + turn_s;
        let jump = u32::from(kind == Move::Jump);
        let energy_j =
            from.energy_j + self.arena.jumper().energy_j(self.tariff.driven_m(kind, length_m, z_m - from.z_m), jump, part_s);
        Reached { kind, time_s: from.time_s + part_s, jumps: from.jumps + jump, energy_j, direction }
    }

    /// The kind of line by the heights of its ends.
    fn kind(from_m: f64, to_m: f64) -> Move {
        if to_m == from_m {
            Move::Drive
        } else if to_m > from_m {
            Move::Jump
        } else {
            Move::Drop
        }
    }

    /// The best of these parents of a place, the nearest node among them.
    fn best_parent(&mut self, place: (MapPoint, f64), near: &[Near]) -> Option<(u32, Reached)> {
        let mut waiting = std::mem::take(&mut self.waiting);
        waiting.clear();
        // By what each takes at least: the first that is joined is seldom followed by a better one, and few are looked at.
        waiting.extend(near.iter().filter(|near| self.goal != Some(near.node)).map(|near| Waiting {
            bound_s: self.nodes[near.node as usize].time_s + near.distance_m2.sqrt() * self.least_s_per_m,
            label: near.node,
        }));
        let mut waiting = BinaryHeap::from(waiting);
        let mut best: Option<(u32, Reached)> = None;
        while let Some(Waiting { bound_s, label: node }) = waiting.pop() {
            if best.as_ref().is_some_and(|(_, best)| best.time_s <= bound_s) {
                break;
            }
            let from = &self.nodes[node as usize];
            let reached = self.priced(node, place, Self::kind(from.z_m, place.1));
            let is_better = reached.energy_j <= self.arena.jumper().battery_j
                && best.as_ref().is_none_or(|(other, best)| (reached.time_s, node) < (best.time_s, *other));
            if is_better && self.space.joined((from.point, from.z_m), place).is_some() {
                best = Some((node, reached));
            }
        }
        self.waiting = waiting.into_vec();
        best
    }

    fn push(&mut self, (point, z_m): (MapPoint, f64), parent: u32, joined: Joined, reached: &Reached) -> u32 {
        let Reached { kind, time_s, jumps, energy_j, direction } = *reached;
        let number = u32::try_from(self.nodes.len()).unwrap_or(u32::MAX);
        self.nodes.push(TreeNode { point, z_m, parent, kind, joined, time_s, jumps, energy_j, direction });
        self.children.push(Vec::new());
        self.children[parent as usize].push(number);
        number
    }

    /// Adds a place over the best of its neighbours; `None` if none is joined to it.
    pub(super) fn add(&mut self, place: (MapPoint, f64), nearest: u32, near: &[Near]) -> Option<u32> {
        let (parent, reached) = self.best_parent(place, near)?;
        let joined = if parent == nearest { Joined::Nearest } else { Joined::Sooner };
        Some(self.push(place, parent, joined, &reached))
    }

    /// Rewires neighbours over a new node, where that makes them sooner and takes no more jumps and energy, so that what follows them is not
    /// worse but for its turning.
    pub(super) fn rewire(&mut self, node: u32, near: &[Near]) {
        let own = self.nodes[node as usize];
        for Near { node: other, distance_m2 } in near.iter().copied().filter(|other| other.node != own.parent && other.node != 0) {
            // Those that are sooner anyhow are most.
            let least_s = own.time_s + distance_m2.sqrt() * self.least_s_per_m;
            if least_s >= self.nodes[other as usize].time_s {
                continue;
            }
            let target = self.nodes[other as usize];
            let place = (target.point, target.z_m);
            let reached = self.priced(node, place, Self::kind(own.z_m, target.z_m));
            let is_plain = self.arena.jumper().is_plain();
            let is_better = reached.time_s < target.time_s - SAME_S
                && (is_plain || reached.jumps <= target.jumps && reached.energy_j <= target.energy_j);
            if !is_better || self.space.joined((own.point, own.z_m), place).is_none() {
                continue;
            }
            self.children[target.parent as usize].retain(|child| *child != other);
            self.children[node as usize].push(other);
            let Reached { kind, time_s, jumps, energy_j, direction } = reached;
            self.nodes[other as usize] =
                TreeNode { parent: node, kind, joined: Joined::Rewired, time_s, jumps, energy_j, direction, ..target };
            self.update_below(other);
        }
    }

    /// Adds up the times below a node again.
    fn update_below(&mut self, node: u32) {
        let mut open = vec![node];
        while let Some(parent) = open.pop() {
            for i in 0..self.children[parent as usize].len() {
                let child = self.children[parent as usize][i];
                let known = self.nodes[child as usize];
                let Reached { kind, time_s, jumps, energy_j, direction } =
                    self.priced(parent, (known.point, known.z_m), known.kind);
                self.nodes[child as usize] = TreeNode { kind, time_s, jumps, energy_j, direction, ..known };
                open.push(child);
            }
        }
    }

    /// Joins the goal to a node nearby: as a node of its own at first, then over a better parent. Returns its number if it is new.
    pub(super) fn try_goal(&mut self, node: u32, radius_m: f64) -> Option<u32> {
        let goal = (self.arena.goal(), self.space.height_m(self.arena.goal())?);
        let distance_m2 = (self.point(node) - goal.0).norm_squared();
        if distance_m2.sqrt() > radius_m {
            return None;
        }
        if let Some(known) = self.goal {
            self.rewire(node, &[Near { node: known, distance_m2 }]);
            return None;
        }
        let (parent, reached) = self.best_parent(goal, &[Near { node, distance_m2 }])?;
        let number = self.push(goal, parent, Joined::Nearest, &reached);
        self.goal = Some(number);
        Some(number)
    }

    /// Keeps the path to the goal if it is the best so far: turning may make a rewired path later again.
    pub(super) fn record(&mut self) {
        let Some(goal) = self.goal else { return };
        let found = &self.nodes[goal as usize];
        if self.best_s().is_some_and(|best_s| found.time_s >= best_s - SAME_S) || found.energy_j > self.arena.jumper().battery_j {
            return;
        }
        let mut numbers = vec![goal];
        let mut node = goal;
        while node != 0 {
            node = self.nodes[node as usize].parent;
            numbers.push(node);
        }
        numbers.reverse();
        let points = numbers.iter().map(|number| {
            let node = &self.nodes[*number as usize];
            PathPoint { point: node.point, z_m: node.z_m, reached_by: (*number != 0).then_some(node.kind) }
        });
        let mut flying: Vec<PathPoint> = Vec::new();
        for point in points {
            let place = |point: &PathPoint| (point.point, point.z_m);
            let split =
                flying.last().filter(|last| point.z_m > last.z_m).and_then(|last| self.space.split(place(last), place(&point)));
            match (split, flying.last()) {
                (Some(split), Some(last)) => flying.extend(flown(last, point, split)),
                _ => flying.push(point),
            }
        }
        let points = flying;
        self.best = Some((self.nodes[goal as usize].time_s, points));
    }

    /// The best path so far.
    pub(super) fn best_path(&self) -> Option<ArenaPath> {
        let (time_s, points) = self.best.as_ref()?;
        Some(ArenaPath { points: ArenaPath::simplify(points.clone()), time_s: *time_s, tariff: self.tariff })
    }
}
