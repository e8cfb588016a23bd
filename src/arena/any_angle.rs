//! The exact optimum over the boxes as drawn.
//!
//! The robot drives at one speed on the floor and on every box, so a shortest path crosses a face straight, and bends only at corners:
//!
//! ```text
//!     start -._        +-------+           bends    at corners of the heights, around a face that costs a jump
//!              `-._    |       |           jumps    each crossing of a face upwards; down is free
//!                  `-._|       |           turning  the label of a corner has the direction in which it is reached
//!                      o-------+
//!                        `-._              exact: for one sequence of faces the taut string is the shortest path and the one
//!                             ` goal       that turns least, and it bends only at corners
//! ```
//!
//! The taut string turns least because its inflections lie on common tangents of two corners: every other path of the sequence has a direction
//! at least as far to the left at one of them, and to the right at the next. So one search over the tangents between corners, with length, jumps
//! and turning added up, is exact. The same holds within an energy that grows with each of these.

use std::collections::BinaryHeap;

use super::{
    Arena, ArenaPath, Move, PathPoint, Reading, Refusal, Tariff,
    corner::Corner,
    floor::SAME_M,
    labels::Waiting,
    levels::{Crossed, jumps_between},
    path::turn_rad,
};
use crate::quantity::MapPoint;

/// Rounding of times, s: a path that is better by less is not better.
const SAME_S: f64 = 1e-12;

/// The fastest path over the boxes as drawn; `None`: no path exists.
///
/// # Errors
/// A jumper that weakens.
pub fn any_angle_path(arena: &Arena, may_jump: bool) -> Result<Option<ArenaPath>, Refusal> {
    let factor = arena.jumper().speed_factor_per_jump;
    if factor != 1.0 {
        return Err(Refusal::Weakens { factor });
    }
    if arena.jumper().flight.is_some() {
        return Err(Refusal::Flies);
    }
    let tariff = Tariff::of(arena.jumper(), Reading::R0);
    Ok(AnyAngle::new(arena, tariff, may_jump).search().map(|points| points.path(tariff)))
}

/// The least time of any path under these prices, which need not be the jumper's; infinite if there is no path.
pub(super) fn least_time_s(arena: &Arena, tariff: Tariff, may_jump: bool) -> f64 {
    AnyAngle::new(arena, tariff, may_jump).search().map_or(f64::INFINITY, |found| found.time_s)
}

/// Whether a place is seen from another.
#[derive(Clone, Copy, Debug)]
enum Sighted {
    Unknown,
    No,
    Yes(Crossed),
}

/// The straight line from one place to another.
#[derive(Clone, Copy, Debug)]
struct Line {
    direction: [f64; 2],
    length_m: f64,
    /// The height just beyond its beginning, m.
    first_m: f64,
    sighted: Sighted,
}

/// How a corner is reached.
#[derive(Clone, Copy, Debug)]
struct Label {
    corner: u32,
    parent: u32,
    time_s: f64,
    energy_j: f64,
    direction: [f64; 2],
    /// The height on arrival, m; of a line that is not looked at yet the jumps at its beginning.
    level_m: Result<f64, u32>,
}

struct AnyAngle<'a> {
    arena: &'a Arena,
    tariff: Tariff,
    rise_max_m: f64,
    /// Start, goal, then the corners.
    corners: Vec<Corner>,
    /// The lines from each place to all; `None` until one is asked for.
    lines: Vec<Option<Vec<Line>>>,
}

/// A path as its corners.
struct Found {
    time_s: f64,
    points: Vec<PathPoint>,
}

impl Found {
    fn path(self, tariff: Tariff) -> ArenaPath {
        ArenaPath { points: ArenaPath::simplify(self.points), time_s: self.time_s, tariff }
    }
}

const START: usize = 0;
const GOAL: usize = 1;

impl<'a> AnyAngle<'a> {
    fn new(arena: &'a Arena, tariff: Tariff, may_jump: bool) -> Self {
        let levels = arena.levels();
        let (xs, ys) = levels.lines();
        let at = |point: MapPoint| Corner { point, quadrants: levels.quadrants(point) };
        let mut corners = vec![at(arena.start()), at(arena.goal())];
        // No path bends at the border of the floor.
        for y in &ys[1..ys.len() - 1] {
            let row = xs[1..xs.len() - 1].iter().map(|x| at(MapPoint::new(*x, *y)));
            corners.extend(row.filter(Corner::has_bend));
        }
        let rise_max_m = if may_jump { arena.jumper().rise_max_m } else { 0.0 };
        let lines = vec![None; corners.len()];
        Self { arena, tariff, rise_max_m, corners, lines }
    }

    /// The line from one place to another.
    fn line(&mut self, from: usize, to: usize) -> &mut Line {
        let Self { corners, lines, .. } = self;
        let origin = &corners[from];
        let line = |end: &Corner| {
            let way = end.point - origin.point;
            let length_m = way.norm();
            let direction = if length_m > SAME_M { [way.x / length_m, way.y / length_m] } else { [0.0; 2] };
            Line { direction, length_m, first_m: origin.level_towards(direction), sighted: Sighted::Unknown }
        };
        &mut lines[from].get_or_insert_with(|| corners.iter().map(line).collect())[to]
    }

    /// What the line between two places crosses, where a taut path may take it; looked at once.
    fn sight(&mut self, from: usize, to: usize) -> Option<Crossed> {
        let Line { direction, sighted, .. } = *self.line(from, to);
        match sighted {
            Sighted::Yes(crossed) => Some(crossed),
            Sighted::No => None,
            Sighted::Unknown => {
                let (origin, end) = (&self.corners[from], &self.corners[to]);
                let crossed = self.arena.levels().crossed(origin.point, end.point, self.rise_max_m);
                // Where it goes on straight, the line to the next place is a line of its own.
                let is_useful = |crossed: &Crossed| to == GOAL || end.may_bend(direction, crossed.end_m, self.rise_max_m);
                let useful = crossed.filter(is_useful);
                self.line(from, to).sighted = useful.map_or(Sighted::No, Sighted::Yes);
                useful
            }
        }
    }

    fn search(&mut self) -> Option<Found> {
        let jumper = *self.arena.jumper();
        let goal = self.corners[GOAL].point;
        let goal_level_m = self.arena.levels().at(goal);
        let start_level_m = self.arena.levels().at(self.corners[START].point);
        let power = jumper.power_w;
        let bounded = jumper.battery_j.is_finite();
        let first =
            Label { corner: 0, parent: 0, time_s: 0.0, energy_j: 0.0, direction: self.arena.heading(), level_m: Ok(start_level_m) };
        let rests_s: Vec<f64> =
            self.corners.iter().map(|corner| (goal - corner.point).norm() / self.tariff.speed_m_s * (1.0 - SAME_S)).collect();
        let mut labels = vec![first];
        // The settled labels of each corner, with their heights.
        let mut settled: Vec<Vec<(u32, f64)>> = vec![Vec::new(); self.corners.len()];
        let mut waiting = BinaryHeap::from([Waiting { bound_s: 0.0, label: 0 }]);
        while let Some(Waiting { label: number, .. }) = waiting.pop() {
            let label = labels[number as usize];
            let own = label.corner as usize;
            let level_m = match label.level_m {
                Ok(level_m) => level_m,
                Err(up) => {
                    // A line is looked at when its turn comes as if it crossed nothing: most never do.
                    let Some((seen, crossed)) = self.seen(&labels, label, up) else { continue };
                    labels[number as usize] = seen;
                    if crossed.jumps > 0 {
                        waiting.push(Waiting { bound_s: seen.time_s + rests_s[own], label: number });
                        continue;
                    }
                    crossed.end_m
                }
            };
            let label = labels[number as usize];
            if own == GOAL {
                return Some(self.found(&labels, number, goal_level_m));
            }
            // A label that came earlier is at least as good if even turning into this one's direction makes it no later.
            let is_dominated =
                settled[own].iter().map(|(other, other_m)| (&labels[*other as usize], *other_m)).any(|(other, other_m)| {
                    let turn_s = self.tariff.turn_s_per_rad * turn_rad(other.direction, label.direction);
                    other.time_s + turn_s <= label.time_s + SAME_S
                        && other_m >= level_m
                        && (!bounded || other.energy_j + power * turn_s <= label.energy_j + SAME_S)
                });
            if is_dominated {
                continue;
            }
            settled[own].push((number, level_m));
            for (to, rest_s) in rests_s.iter().enumerate().skip(GOAL).filter(|(to, _)| *to != own) {
                let Line { direction, length_m, first_m, sighted } = *self.line(own, to);
                if length_m <= SAME_M || matches!(sighted, Sighted::No) {
                    continue;
                }
                let corner = &self.corners[own];
                let Some(up) = jumps_between(level_m, first_m, &corner.quadrants, self.rise_max_m) else { continue };
                if own != START && !corner.bends_around((label.direction, direction), (level_m, first_m), up, self.rise_max_m) {
                    continue;
                }
                let turn_s = self.tariff.turn_s_per_rad * turn_rad(label.direction, direction);
                let time_s = label.time_s + (turn_s + length_m / self.tariff.speed_m_s + f64::from(up) * self.tariff.jump_time_s);
                let next = u32::try_from(labels.len()).unwrap_or(u32::MAX);
                let corner = u32::try_from(to).unwrap_or(u32::MAX);
                labels.push(Label { corner, parent: number, time_s, energy_j: label.energy_j, direction, level_m: Err(up) });
                waiting.push(Waiting { bound_s: time_s + rest_s, label: next });
            }
        }
        None
    }

    /// A label whose line is looked at, and what the line crosses; `None` where no path takes it.
    fn seen(&mut self, labels: &[Label], label: Label, up: u32) -> Option<(Label, Crossed)> {
        let jumper = *self.arena.jumper();
        let before = &labels[label.parent as usize];
        let (from, to) = (before.corner as usize, label.corner as usize);
        let crossed = self.sight(from, to)?;
        let length_m = self.line(from, to).length_m;
        let jumps = up + crossed.jumps;
        let turn_s = self.tariff.turn_s_per_rad * turn_rad(before.direction, label.direction);
        let part_s = turn_s + length_m / self.tariff.speed_m_s + f64::from(jumps) * self.tariff.jump_time_s;
        let energy_j = before.energy_j + jumper.energy_j(length_m, jumps, part_s);
        let label = Label { time_s: before.time_s + part_s, energy_j, level_m: Ok(crossed.end_m), ..label };
        (energy_j <= jumper.battery_j).then_some((label, crossed))
    }

    /// The path that ends with a label.
    fn found(&self, labels: &[Label], mut number: u32, goal_level_m: f64) -> Found {
        let time_s = labels[number as usize].time_s;
        let mut ways = vec![labels[number as usize].corner as usize];
        while number != 0 {
            number = labels[number as usize].parent;
            ways.push(labels[number as usize].corner as usize);
        }
        ways.reverse();
        let mut trace = Trace::at(self.corners[START].point, labels[0].level_m.unwrap_or(0.0), self.rise_max_m);
        for pair in ways.windows(2) {
            let (from, to) = (&self.corners[pair[0]], &self.corners[pair[1]]);
            let mut steps = Vec::new();
            let (start_m, _) = self.arena.levels().walk(from.point, to.point, |step| {
                steps.push(step);
                true
            });
            trace.climb(start_m, &from.quadrants);
            for step in steps {
                trace.drive(from.point + step.at * (to.point - from.point));
                trace.climb(step.to_m, step.corner.as_ref().map_or(&[], |cells| cells));
            }
            trace.drive(to.point);
        }
        trace.climb(goal_level_m, &[]);
        Found { time_s, points: trace.points }
    }
}

/// A path as it is drawn.
struct Trace {
    points: Vec<PathPoint>,
    level_m: f64,
    rise_max_m: f64,
}

impl Trace {
    fn at(point: MapPoint, level_m: f64, rise_max_m: f64) -> Self {
        Self { points: vec![PathPoint { point, z_m: level_m, reached_by: None }], level_m, rise_max_m }
    }

    fn push(&mut self, point: MapPoint, kind: Move) {
        self.points.push(PathPoint { point, z_m: self.level_m, reached_by: Some(kind) });
    }

    fn drive(&mut self, point: MapPoint) {
        self.push(point, Move::Drive);
    }

    /// Up or down to a height at the last point, by way of the heights of other cells if need be.
    fn climb(&mut self, to_m: f64, others: &[f64]) {
        let Some(here) = self.points.last().map(|last| last.point) else { return };
        if to_m < self.level_m {
            self.level_m = to_m;
            return self.push(here, Move::Drop);
        }
        while self.level_m < to_m {
            let is_near = |height: &f64| jumps_between(self.level_m, *height, &[], self.rise_max_m) == Some(1);
            let next_m = if is_near(&to_m) { to_m } else { others.iter().copied().filter(is_near).fold(self.level_m, f64::max) };
            // The search has counted these jumps: there is always a next one.
            if next_m <= self.level_m {
                return;
            }
            self.level_m = next_m;
            self.push(here, Move::Jump);
        }
    }
}
