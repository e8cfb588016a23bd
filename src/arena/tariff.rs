//! What the moves of a path take.

use super::{Flight, Jumper, Move};
use crate::ballistics::Arc;

/// How the paper on the Jumping Sumo may be read: it leaves open what its jumps and drops cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// A jump takes its time, in which its length is included; a drop pays the length of the line down, and on the grid goes two nodes. These give the
    /// four times that the paper prints.
    R1,
    /// Every move pays its length along the floor, a jump its time as well; a drop goes one node.
    R0,
}

impl Reading {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::R1 => "R1",
            Self::R0 => "R0",
        }
    }
}

/// The prices of moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tariff {
    /// Driving speed before the first jump, m/s.
    pub speed_m_s: f64,
    /// Time to turn, s/rad.
    pub turn_s_per_rad: f64,
    /// The time of a jump, s.
    pub jump_time_s: f64,
    /// What each jump leaves of the speed.
    pub speed_factor_per_jump: f64,
    /// How jumps and drops are priced.
    pub reading: Reading,
    /// The flight of a jump, which is then priced the same in both readings: the time before the take-off, that of the flight, and the rest of
    /// the way at the driving speed.
    pub flight: Option<Flight>,
}

impl Tariff {
    /// The prices of a robot.
    pub const fn of(jumper: &Jumper, reading: Reading) -> Self {
        Self {
            speed_m_s: jumper.speed_m_s,
            turn_s_per_rad: jumper.turn_s_per_rad,
            jump_time_s: jumper.jump_time_s,
            speed_factor_per_jump: jumper.speed_factor_per_jump,
            reading,
            flight: jumper.flight,
        }
    }

    /// The driving speed after some jumps, m/s.
    pub(super) fn speed_after_m_s(&self, jumps: u32) -> f64 {
        // Without weakening it is the same double.
        if self.speed_factor_per_jump == 1.0 {
            return self.speed_m_s;
        }
        self.speed_m_s * libm::pow(self.speed_factor_per_jump, f64::from(jumps))
    }

    /// The time of a move that goes so far along the floor and up, after some jumps, s.
    pub(super) fn move_s(&self, kind: Move, length_m: f64, rise_m: f64, jumps: u32) -> f64 {
        let speed_m_s = self.speed_after_m_s(jumps);
        if let Some(arc) = self.arc(kind, rise_m) {
            // What is driven after the landing is driven more slowly by a robot that weakens: the planner refuses both together.
            let driven_m = (length_m - arc.line_of_sight().run_m()).max(0.0);
            return self.jump_time_s + arc.flight_time_s() + driven_m / speed_m_s;
        }
        match (kind, self.reading) {
            (Move::Drive, _) | (Move::Drop, Reading::R0) => length_m / speed_m_s,
            (Move::Drop, Reading::R1) => libm::hypot(length_m, rise_m) / speed_m_s,
            (Move::Jump, Reading::R0) => length_m / speed_m_s + self.jump_time_s,
            (Move::Jump, Reading::R1) => self.jump_time_s,
        }
    }

    /// The arc of a jump that is a flight.
    fn arc(&self, kind: Move, rise_m: f64) -> Option<Arc> {
        self.flight.filter(|_| kind == Move::Jump).and_then(|flight| flight.arc(rise_m))
    }

    /// How much of a move is driven, m.
    pub(super) fn driven_m(&self, kind: Move, length_m: f64, rise_m: f64) -> f64 {
        if let Some(arc) = self.arc(kind, rise_m) {
            return (length_m - arc.line_of_sight().run_m()).max(0.0);
        }
        if kind == Move::Jump && self.reading == Reading::R1 { 0.0 } else { length_m }
    }
}
