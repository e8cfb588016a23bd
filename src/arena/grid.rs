//! A* over the nodes of a grid, with the heading in the state: the rules of the paper on the Jumping Sumo.
//!
//! ```text
//!     . . . . . . .      drive   8 neighbours at one height; a diagonal needs level ground in the four
//!     . # # # # # .              directions about both its ends
//!     . # o o o # .      ring #  top nodes with a lower neighbour: no landing there, and only down from there
//!     . # o o o # .      jump    two nodes, over one face, to a node off the ring
//!     . # # # # # .      drop    from the ring in four directions over the face, two nodes (R1) or one (R0)
//!     . . . . . . .      turn    the change of heading, from the start's on
//! ```
//!
//! The paper's words leave some of this open: a face is at the last node outside the drawn box, and the first node of a drop is already lower.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, SQRT_2};

use super::{
    Arena, ArenaPath, Move, PathPoint, Reading, Refusal, Tariff,
    floor::{RISE_TOLERANCE_M, SAME_M},
    labels::{Label, Labels},
    path::{flown, turn_rad},
};
use crate::quantity::MapPoint;

/// The headings of edges: counter-clockwise from +x, the odd ones diagonal.
const HEADINGS: [[i32; 2]; 8] = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];

/// The same as unit vectors.
const DIRECTIONS: [[f64; 2]; 8] = [
    [1.0, 0.0],
    [FRAC_1_SQRT_2, FRAC_1_SQRT_2],
    [0.0, 1.0],
    [-FRAC_1_SQRT_2, FRAC_1_SQRT_2],
    [-1.0, 0.0],
    [-FRAC_1_SQRT_2, -FRAC_1_SQRT_2],
    [0.0, -1.0],
    [FRAC_1_SQRT_2, -FRAC_1_SQRT_2],
];

/// States of a node: one for each heading, and one for the heading of the start.
const STATES: usize = 9;

/// The most nodes: their states and labels take about half a gigabyte.
const MOST_NODES: usize = 1_000_000;

/// The fastest path over the nodes of the grid, by these rules; `None`: no path over this grid.
///
/// # Errors
/// Start or goal between the nodes, boxes that the grid cannot see, too many nodes.
pub fn grid_path(arena: &Arena, reading: Reading, may_jump: bool) -> Result<Option<ArenaPath>, Refusal> {
    let mut grid = Grid::new(arena, reading, may_jump)?;
    Ok(grid.search())
}

/// The moves from a node: a bit for each heading.
#[derive(Clone, Copy, Debug, Default)]
struct Moves {
    known: bool,
    drive: u8,
    /// How many nodes it jumps, by heading; 0: not at all.
    jump: [u8; 8],
    drop: u8,
}

struct Grid<'a> {
    arena: &'a Arena,
    tariff: Tariff,
    columns: i32,
    rows: i32,
    spacing_m: f64,
    jump_nodes: i32,
    /// The most nodes that a flight may need.
    flight_nodes: i32,
    drop_nodes: i32,
    rise_max_m: f64,
    heights: Vec<f64>,
    /// Columns and rows along which a face runs.
    faces: [Vec<bool>; 2],
    moves: Vec<Moves>,
    start: usize,
    goal: usize,
}

impl<'a> Grid<'a> {
    fn new(arena: &'a Arena, reading: Reading, may_jump: bool) -> Result<Self, Refusal> {
        let keys = arena.keys();
        arena.refuse_flight_that_weakens()?;
        let spacing_m = keys.grid.spacing_m;
        let counts = arena.size_m().map(|size_m| (size_m / spacing_m + SAME_M).floor() + 1.0);
        #[expect(clippy::cast_precision_loss, reason = "a million")]
        let most = MOST_NODES as f64;
        if counts[0] * counts[1] > most {
            return Err(Refusal::TooManyNodes { found: counts[0] * counts[1], most: MOST_NODES });
        }
        let jump_nodes = (keys.grid.jump_length_m / spacing_m).round();
        if (jump_nodes * spacing_m - keys.grid.jump_length_m).abs() > SAME_M || !(2.0..=1e6).contains(&jump_nodes) {
            return Err(Refusal::JumpOffNodes { length_m: keys.grid.jump_length_m, spacing_m });
        }
        for (number, one) in arena.boxes().iter().enumerate() {
            let (width_m, least_m) = (one.width_m(), 2.0 * spacing_m);
            if width_m < least_m - SAME_M {
                return Err(Refusal::ThinBox { number: number + 1, width_m, least_m, spacing_m: 0.5 * width_m });
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "bounded above")]
        let [columns, rows] = counts.map(|count| count as i32);
        let at = |count: i32| (0..count).map(|i| f64::from(i) * spacing_m).collect::<Vec<_>>();
        let (xs, ys) = (at(columns), at(rows));
        let heights = arena.levels().at_nodes(&xs, &ys);
        let faces = arena.levels().on_faces(&xs, &ys);
        let node = |key: &'static str, place: MapPoint| {
            let near = [place.x, place.y].map(|at| (at / spacing_m).round());
            let near_m = near.map(|index| index * spacing_m);
            if (near_m[0] - place.x).abs() > SAME_M || (near_m[1] - place.y).abs() > SAME_M {
                let [near_x_m, near_y_m] = near_m.map(|at| (at * 1e9).round() / 1e9);
                return Err(Refusal::BetweenNodes { key, x_m: place.x, y_m: place.y, near_x_m, near_y_m, spacing_m });
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a node of the grid")]
            let index = near[1] as usize * columns as usize + near[0] as usize;
            Ok(index)
        };
        let (start, goal) = (node("start_m", arena.start())?, node("goal_m", arena.goal())?);
        let rise_max_m = if may_jump { arena.jumper().rise_max_m } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, reason = "bounded above")]
        let jump_nodes = jump_nodes as i32;
        // Its range, and as much again to drive before the take-off and after the landing.
        let flight_m = arena.jumper().flight.map_or(0.0, |flight| 2.0 * flight.range_m() + 2.0 * arena.jumper().ring_m);
        #[expect(clippy::cast_possible_truncation, reason = "at most 255")]
        let flight_nodes = (flight_m / spacing_m).ceil().min(255.0) as i32;
        let drop_nodes = if reading == Reading::R1 { jump_nodes } else { 1 };
        let tariff = Tariff::of(arena.jumper(), reading);
        let moves = vec![Moves::default(); heights.len()];
        Ok(Self {
            arena,
            tariff,
            columns,
            rows,
            spacing_m,
            jump_nodes,
            flight_nodes,
            drop_nodes,
            rise_max_m,
            heights,
            faces,
            moves,
            start,
            goal,
        })
    }

    fn place(&self, node: usize) -> (i32, i32) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "at most a million nodes")]
        let node = node as i32;
        (node % self.columns, node / self.columns)
    }

    fn point(&self, node: usize) -> MapPoint {
        let (i, j) = self.place(node);
        MapPoint::new(f64::from(i) * self.spacing_m, f64::from(j) * self.spacing_m)
    }

    /// The node so many steps away; `None` off the floor.
    fn beside(&self, (i, j): (i32, i32), heading: usize, steps: i32) -> Option<usize> {
        let [di, dj] = HEADINGS[heading];
        let (i, j) = (i + steps * di, j + steps * dj);
        let is_on_floor = (0..self.columns).contains(&i) && (0..self.rows).contains(&j);
        is_on_floor.then(|| (j * self.columns + i).unsigned_abs() as usize)
    }

    fn is_ring(&self, node: usize) -> bool {
        let own_m = self.heights[node];
        own_m > 0.0
            && (0..8).any(|heading| self.beside(self.place(node), heading, 1).is_some_and(|other| self.heights[other] < own_m))
    }

    fn is_level_in_four(&self, node: usize) -> bool {
        let own_m = self.heights[node];
        [0, 2, 4, 6]
            .into_iter()
            .all(|heading| self.beside(self.place(node), heading, 1).is_none_or(|other| self.heights[other] == own_m))
    }

    /// The moves from a node, found once.
    fn moves_of(&mut self, node: usize) -> Moves {
        if self.moves[node].known {
            return self.moves[node];
        }
        let (place, own_m) = (self.place(node), self.heights[node]);
        let is_ring = self.is_ring(node);
        let is_level = self.is_level_in_four(node);
        let mut moves = Moves { known: true, ..Moves::default() };
        for heading in 0..8 {
            let (bit, is_diagonal) = (1 << heading, heading % 2 == 1);
            if is_ring {
                if !is_diagonal && self.drops(node, heading) {
                    moves.drop |= bit;
                }
                continue;
            }
            let next = self.beside(place, heading, 1).filter(|next| self.heights[*next] == own_m);
            let is_open = |next: usize| {
                if is_diagonal { is_level && self.is_level_in_four(next) } else { !self.is_between_boxes(node, next, heading) }
            };
            if next.is_some_and(is_open) {
                moves.drive |= bit;
            }
            if self.rise_max_m > 0.0 {
                moves.jump[heading] = self.jump_nodes_from(node, heading);
            }
        }
        self.moves[node] = moves;
        moves
    }

    /// Whether the way to the next node along an axis is closed by two boxes that touch there.
    fn is_between_boxes(&self, node: usize, next: usize, heading: usize) -> bool {
        let (i, j) = self.place(node);
        let is_along_face = if heading.is_multiple_of(4) {
            self.faces[1][j.unsigned_abs() as usize]
        } else {
            self.faces[0][i.unsigned_abs() as usize]
        };
        let own_m = self.heights[node];
        is_along_face && {
            let mut is_level = true;
            let (start_m, _) = self.arena.levels().walk(self.point(node), self.point(next), |_| {
                is_level = false;
                false
            });
            !is_level || start_m != own_m
        }
    }

    /// How many nodes it jumps: those of the grid, or the fewest that have room for the flight; 0: it cannot.
    fn jump_nodes_from(&self, node: usize, heading: usize) -> u8 {
        let all = if self.tariff.flight.is_some() { 2..=self.flight_nodes } else { self.jump_nodes..=self.jump_nodes };
        let nodes = all.into_iter().find(|nodes| self.jumps(node, heading, *nodes));
        nodes.and_then(|nodes| u8::try_from(nodes).ok()).unwrap_or(0)
    }

    /// Whether it can jump so many nodes: up over one face.
    fn jumps(&self, node: usize, heading: usize, nodes: i32) -> bool {
        let Some(landing) = self.beside(self.place(node), heading, nodes) else { return false };
        let (own_m, top_m) = (self.heights[node], self.heights[landing]);
        let rise_m = top_m - own_m;
        if rise_m <= 0.0 || rise_m > self.rise_max_m + RISE_TOLERANCE_M || self.is_ring(landing) {
            return false;
        }
        if let Some(flight) = &self.tariff.flight {
            let ends = (self.point(node), self.point(landing));
            return flight.split(self.arena.levels(), ends, (own_m, top_m), self.arena.jumper().ring_m).is_some();
        }
        let (mut faces, mut is_right) = (0, true);
        let (start_m, _) = self.arena.levels().walk(self.point(node), self.point(landing), |step| {
            faces += 1;
            is_right &= step.from_m == own_m && step.to_m == top_m;
            is_right
        });
        // At once into the box, or over its face on the way.
        is_right && if faces == 0 { start_m == top_m } else { faces == 1 && start_m == own_m }
    }

    /// Whether it can drop: its first node is lower, nothing on the way rises, and it does not end on a ring.
    fn drops(&self, node: usize, heading: usize) -> bool {
        let place = self.place(node);
        let is_over_face = self.beside(place, heading, 1).is_some_and(|next| self.heights[next] < self.heights[node]);
        let landing = self.beside(place, heading, self.drop_nodes).filter(|landing| is_over_face && !self.is_ring(*landing));
        landing.is_some_and(|landing| {
            let mut falls = true;
            self.arena.levels().walk(self.point(node), self.point(landing), |step| {
                falls &= step.to_m < step.from_m;
                falls
            });
            falls
        })
    }

    /// The least time from a node to the goal: the octile distance at the cheapest price of a node.
    fn rest(&self) -> impl Fn((i32, i32)) -> f64 + use<> {
        let node_s = |length_m: f64| {
            let fastest_m_s = self.tariff.flight.map_or(0.0, |flight| flight.along_m_s()).max(self.tariff.speed_m_s);
            let drive_s = length_m / fastest_m_s;
            let jump_s = self.tariff.jump_time_s / f64::from(self.jump_nodes);
            if self.tariff.reading == Reading::R1 && self.tariff.flight.is_none() { drive_s.min(jump_s) } else { drive_s }
        };
        // Just below the true price: rounding must not let the bound pass it.
        let below = 1.0 - 1e-12;
        let (straight_s, diagonal_s) = (node_s(self.spacing_m) * below, node_s(self.spacing_m * SQRT_2) * below);
        let diagonal_s = diagonal_s.min(2.0 * straight_s);
        let goal = self.place(self.goal);
        move |(i, j)| {
            let (dx, dy) = ((i - goal.0).abs(), (j - goal.1).abs());
            let (less, more) = (f64::from(dx.min(dy)), f64::from(dx.max(dy)));
            less * diagonal_s + (more - less) * straight_s
        }
    }

    fn search(&mut self) -> Option<ArenaPath> {
        let jumper = *self.arena.jumper();
        let rest = self.rest();
        let turns_s = self.turns_s();
        let turns_to_s: [[f64; STATES]; 8] = std::array::from_fn(|to| turns_s.map(|from| from[to]));
        let mut labels = Labels::new(self.heights.len() * STATES, jumper.is_plain());
        let state = |node: usize, heading: usize| u32::try_from(node * STATES + heading).unwrap_or(u32::MAX);
        labels.offer(
            Label { state: state(self.start, 8), parent: 0, time_s: 0.0, energy_j: 0.0, jumps: 0 },
            rest(self.place(self.start)),
        );
        while let Some((number, label)) = labels.settle() {
            let (node, heading) = (label.state as usize / STATES, label.state as usize % STATES);
            if node == self.goal {
                return Some(self.path(&labels.states_to(number), label.time_s));
            }
            if heading < 8 && labels.is_later_than_a_turn(&label, heading, &turns_to_s[heading]) {
                continue;
            }
            let place = self.place(node);
            let moves = self.moves_of(node);
            for (next_heading, turn_s) in turns_s[heading].iter().enumerate() {
                let has = |bits: u8| i32::from(bits >> next_heading & 1);
                let jump_nodes = i32::from(moves.jump[next_heading]);
                let all =
                    [(Move::Drive, has(moves.drive)), (Move::Jump, jump_nodes), (Move::Drop, has(moves.drop) * self.drop_nodes)];
                for (kind, steps) in all.into_iter().filter(|(_, steps)| *steps > 0) {
                    let Some(next) = self.beside(place, next_heading, steps) else { continue };
                    let unit_m = if next_heading % 2 == 1 { self.spacing_m * SQRT_2 } else { self.spacing_m };
                    let length_m = f64::from(steps) * unit_m;
                    let rise_m = self.heights[next] - self.heights[node];
                    let move_s = self.tariff.move_s(kind, length_m, rise_m, label.jumps) + turn_s;
                    let jump = u32::from(kind == Move::Jump);
                    let energy_j = label.energy_j + jumper.energy_j(self.tariff.driven_m(kind, length_m, rise_m), jump, move_s);
                    if energy_j > jumper.battery_j {
                        continue;
                    }
                    let time_s = label.time_s + move_s;
                    let next_label =
                        Label { state: state(next, next_heading), parent: number, time_s, energy_j, jumps: label.jumps + jump };
                    if !labels.is_later_than_a_turn(&next_label, next_heading, &turns_to_s[next_heading]) {
                        labels.offer(next_label, rest(self.place(next)));
                    }
                }
            }
        }
        None
    }

    /// The time of every change of heading, s.
    fn turns_s(&self) -> [[f64; 8]; STATES] {
        let mut turns_s = [[0.0; 8]; STATES];
        for (from, row) in turns_s.iter_mut().enumerate() {
            for (to, turn_s) in row.iter_mut().enumerate() {
                let eighths = f64::from(u8::try_from(from.abs_diff(to).min(8 - from.abs_diff(to).min(8))).unwrap_or(0));
                let angle = if from == 8 { turn_rad(self.arena.heading(), DIRECTIONS[to]) } else { eighths * FRAC_PI_4 };
                *turn_s = self.tariff.turn_s_per_rad * angle;
            }
        }
        turns_s
    }

    /// The path through these states.
    fn path(&self, states: &[u32], time_s: f64) -> ArenaPath {
        let mut points: Vec<PathPoint> = Vec::with_capacity(states.len());
        for state in states {
            let node = *state as usize / STATES;
            let point = self.point(node);
            let z_m = self.heights[node];
            let reached_by = points.last().map(|last| match z_m.total_cmp(&last.z_m) {
                std::cmp::Ordering::Equal => Move::Drive,
                std::cmp::Ordering::Greater => Move::Jump,
                std::cmp::Ordering::Less => Move::Drop,
            });
            let next = PathPoint { point, z_m, reached_by };
            let flight = self.tariff.flight.filter(|_| reached_by == Some(Move::Jump));
            let split = flight.zip(points.last()).and_then(|(flight, last)| {
                flight.split(self.arena.levels(), (last.point, point), (last.z_m, z_m), self.arena.jumper().ring_m)
            });
            match (split, points.last()) {
                (Some(split), Some(last)) => points.extend(flown(last, next, split)),
                _ => points.push(next),
            }
        }
        ArenaPath { points: ArenaPath::simplify(points), time_s, tariff: self.tariff }
    }
}
