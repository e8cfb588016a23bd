//! What no path of an arena can beat.

use super::{Arena, Reading, Tariff, any_angle::least_time_s};

/// A time that no path beats, under the prices of a planner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowerBound {
    /// The time, s; infinite if there is no path at all.
    pub time_s: f64,
    /// Whether the exact planner reaches it under the same prices; else it is below what can be reached.
    pub is_exact: bool,
}

/// The least time of any path under the prices of a reading, over the boxes as drawn: for R0 the exact optimum, for R1 and for a jumper that weakens a
/// time below it.
///
/// The jump of R1 includes its length, which is at most `d`, the diagonal of its nodes. A path of length `L` with `n` jumps takes at least
///
/// ```text
///     (L - n d) / v + n t  =  L / v + n (t - d / v)
/// ```
///
/// which is the exact optimum for jumps that take `t - d / v`; where that is negative, jumping is faster than driving, and everything is taken at
/// the speed of a jump.
pub fn lower_bound(arena: &Arena, reading: Reading, may_jump: bool) -> LowerBound {
    let jumper = arena.jumper();
    let mut tariff = Tariff { speed_factor_per_jump: 1.0, ..Tariff::of(jumper, Reading::R0) };
    let is_exact = reading == Reading::R0 && jumper.speed_factor_per_jump == 1.0 && jumper.flight.is_none();
    if let Some(flight) = jumper.flight {
        // What a flight takes beyond driving as far grows or falls with its length, which is between those of the highest and of no box.
        let beyond_s = [jumper.rise_max_m, 0.0]
            .into_iter()
            .filter_map(|rise_m| flight.arc(rise_m))
            .map(|arc| arc.flight_time_s() - arc.line_of_sight().run_m() / jumper.speed_m_s);
        let least_s = beyond_s.fold(f64::INFINITY, f64::min);
        tariff.speed_m_s = jumper.speed_m_s.max(flight.along_m_s());
        tariff.jump_time_s += if least_s.is_finite() { least_s.max(0.0) } else { 0.0 };
        tariff.flight = None;
    } else if reading == Reading::R1 {
        let longest_m = arena.keys().grid.jump_length_m * std::f64::consts::SQRT_2;
        let left_s = jumper.jump_time_s - longest_m / jumper.speed_m_s;
        if left_s < 0.0 {
            tariff.speed_m_s = if jumper.jump_time_s > 0.0 { longest_m / jumper.jump_time_s } else { f64::INFINITY };
        }
        tariff.jump_time_s = left_s.max(0.0);
    }
    // Of a bound that is not exact the energy is not that of the path either: the battery is left out.
    let unbounded = arena.without_battery();
    let arena = if is_exact { arena } else { unbounded.as_ref().unwrap_or(arena) };
    LowerBound { time_s: least_time_s(arena, tariff, may_jump), is_exact }
}
