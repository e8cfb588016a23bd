//! A path, checked and re-summed from its points and the boxes alone. No planner's code is used here.

use super::{Arena, ArenaBox, ArenaPath, Move, PathPoint, Reading};

/// Rounding of positions and heights, m.
const NEAR_M: f64 = 1e-6;

/// What a path takes, re-summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckedPath {
    /// Its time, s.
    pub time_s: f64,
    /// Its length along the floor, m.
    pub length_m: f64,
    /// All its changes of heading, rad.
    pub turning_rad: f64,
    /// Its energy, J.
    pub energy_j: f64,
    /// Its jumps.
    pub jumps: usize,
}

/// Why a path does not hold.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathFault {
    /// It does not begin at the start or end at the goal.
    #[error("the path does not lead from the start to the goal")]
    WrongEnds,
    /// A point is reached in no way.
    #[error("point {number} of the path states no move")]
    NoMove {
        /// The point, from 1.
        number: usize,
    },
    /// A move breaks a rule.
    #[error("the {} to point {number} of the path {what}", kind.name())]
    Move {
        /// The point that it ends at, from 1.
        number: usize,
        /// The move.
        kind: Move,
        /// Which rule it breaks.
        what: &'static str,
    },
    /// The stated time is another.
    #[error("the path takes {found_s} s, {stated_s} s were stated")]
    Time {
        /// What its moves add up to, s.
        found_s: f64,
        /// What was stated, s.
        stated_s: f64,
    },
    /// It takes more energy than there is.
    #[error("the path takes {found_j} J, and the battery has {battery_j} J")]
    Battery {
        /// What its moves add up to, J.
        found_j: f64,
        /// What there is, J.
        battery_j: f64,
    },
}

/// Checks every move of a path against the boxes, and adds its time up again.
///
/// # Errors
/// The first fault.
pub fn check_path(arena: &Arena, path: &ArenaPath) -> Result<CheckedPath, PathFault> {
    let (Some(first), Some(last)) = (path.points.first(), path.points.last()) else { return Err(PathFault::WrongEnds) };
    let ends_well = (first.point - arena.start()).norm() <= NEAR_M
        && (last.point - arena.goal()).norm() <= NEAR_M
        && first.reached_by.is_none()
        && [first, last].into_iter().all(|end| stands(arena, end.point.x, end.point.y, end.z_m));
    if !ends_well {
        return Err(PathFault::WrongEnds);
    }
    let jumper = arena.jumper();
    let mut sum = CheckedPath { time_s: 0.0, length_m: 0.0, turning_rad: 0.0, energy_j: 0.0, jumps: 0 };
    let [hx, hy] = arena.heading();
    let mut heading_rad = libm::atan2(hy, hx);
    let mut speed_m_s = path.tariff.speed_m_s;
    let mut driven_m = 0.0;
    for (i, pair) in path.points.windows(2).enumerate() {
        let (from, to) = (&pair[0], &pair[1]);
        let kind = to.reached_by.ok_or(PathFault::NoMove { number: i + 2 })?;
        fault_of(arena, from, to, kind).map_or(Ok(()), |what| Err(PathFault::Move { number: i + 2, kind, what }))?;
        let (dx, dy) = (to.point.x - from.point.x, to.point.y - from.point.y);
        let length_m = (dx * dx + dy * dy).sqrt();
        if length_m > 0.0 {
            let next_rad = libm::atan2(dy, dx);
            let full = std::f64::consts::TAU;
            let apart = (next_rad - heading_rad).abs() % full;
            sum.turning_rad += apart.min(full - apart);
            heading_rad = next_rad;
        }
        let is_whole = path.tariff.reading == Reading::R1;
        let fall_m = from.z_m - to.z_m;
        sum.length_m += length_m;
        sum.time_s += match kind {
            // A flight takes its length at the speed along the floor that it took off with.
            Move::Jump if arena.keys().flight.is_some() => path.tariff.jump_time_s + length_m / flight_speed_m_s(arena),
            Move::Jump if is_whole => path.tariff.jump_time_s,
            Move::Jump => path.tariff.jump_time_s + length_m / speed_m_s,
            Move::Drop if is_whole => (length_m * length_m + fall_m * fall_m).sqrt() / speed_m_s,
            Move::Drop | Move::Drive => length_m / speed_m_s,
        };
        if kind == Move::Jump {
            sum.jumps += 1;
            speed_m_s *= path.tariff.speed_factor_per_jump;
        }
        driven_m += if kind == Move::Jump && (is_whole || arena.keys().flight.is_some()) { 0.0 } else { length_m };
    }
    sum.time_s += path.tariff.turn_s_per_rad * sum.turning_rad;
    #[expect(clippy::cast_precision_loss, reason = "few jumps")]
    let jumps = sum.jumps as f64;
    sum.energy_j = jumper.drive_j_per_m * driven_m + jumper.jump_j * jumps + jumper.power_w * sum.time_s;
    let differs = (sum.time_s - path.time_s).abs() > 1e-9 * path.time_s.max(1.0);
    if differs || path.time_s.is_nan() {
        return Err(PathFault::Time { found_s: sum.time_s, stated_s: path.time_s });
    }
    if sum.energy_j > jumper.battery_j * (1.0 + 1e-9) {
        return Err(PathFault::Battery { found_j: sum.energy_j, battery_j: jumper.battery_j });
    }
    Ok(sum)
}

/// The rule that a move breaks.
fn fault_of(arena: &Arena, from: &PathPoint, to: &PathPoint, kind: Move) -> Option<&'static str> {
    let rise_m = to.z_m - from.z_m;
    let [width_m, depth_m] = arena.size_m();
    let is_on_floor = (-NEAR_M..=width_m + NEAR_M).contains(&to.point.x) && (-NEAR_M..=depth_m + NEAR_M).contains(&to.point.y);
    let (low_m, high_m) = (from.z_m.min(to.z_m), from.z_m.max(to.z_m));
    match kind {
        _ if !is_on_floor => Some("leaves the floor"),
        Move::Drive if rise_m != 0.0 => Some("changes its height"),
        Move::Jump if rise_m <= 0.0 => Some("does not rise"),
        Move::Jump if rise_m > arena.jumper().rise_max_m + NEAR_M => Some("rises by more than the robot can jump"),
        Move::Drop if rise_m >= 0.0 => Some("does not fall"),
        _ if cuts_higher(arena, from, to, high_m) => Some("passes through a higher box"),
        _ if !stands(arena, to.point.x, to.point.y, to.z_m) => Some("ends where there is nothing to stand on"),
        Move::Drive if !is_held(arena, from, to, high_m) => Some("leaves the top of its box"),
        Move::Drive if is_between(arena, from, to, high_m) => Some("passes between two boxes that touch"),
        Move::Jump if (from.point - to.point).norm() > NEAR_M && !is_one_face(arena, from, to, (low_m, high_m)) => {
            Some("crosses more than one face")
        }
        Move::Jump if !flies_so(arena, from, to) => Some("is no flight with the take-off of the arena over the edge"),
        _ => None,
    }
}

/// The speed along the floor of a flight, m/s.
fn flight_speed_m_s(arena: &Arena) -> f64 {
    arena.keys().flight.as_ref().map_or(f64::NAN, |keys| keys.takeoff_speed_m_s * libm::cos(keys.takeoff_angle_deg.to_radians()))
}

/// Whether a jump is the flight of the arena, in small steps: over every box on the way, and down on the landing.
fn flies_so(arena: &Arena, from: &PathPoint, to: &PathPoint) -> bool {
    const STEPS: u32 = 1_000;
    let Some(keys) = &arena.keys().flight else { return true };
    let way = to.point - from.point;
    let time_s = way.norm() / flight_speed_m_s(arena);
    let up_m_s = keys.takeoff_speed_m_s * libm::sin(keys.takeoff_angle_deg.to_radians());
    let height_m = |time_s: f64| from.z_m + up_m_s * time_s - 0.5 * keys.gravity_m_s2 * time_s * time_s;
    let is_over = (1..STEPS).all(|step| {
        let share = f64::from(step) / f64::from(STEPS);
        let (at, z_m) = (from.point + share * way, height_m(share * time_s));
        !arena.boxes().iter().any(|one| one.height_m > z_m + NEAR_M && one.contains(at))
    });
    is_over && (height_m(time_s) - to.z_m).abs() <= NEAR_M && up_m_s < keys.gravity_m_s2 * time_s
}

/// The shares of a segment that are within a rectangle, grown by a margin that may be negative.
fn shares_within(one: &ArenaBox, from: &PathPoint, to: &PathPoint, grow_m: f64) -> Option<(f64, f64)> {
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (low, high, at, end) in [(one.min.x, one.max.x, from.point.x, to.point.x), (one.min.y, one.max.y, from.point.y, to.point.y)]
    {
        let (low, high, change) = (low - grow_m, high + grow_m, end - at);
        if change.abs() < 1e-12 {
            if at < low || at > high {
                return None;
            }
            continue;
        }
        let (a, b) = ((low - at) / change, (high - at) / change);
        first = first.max(a.min(b));
        last = last.min(a.max(b));
    }
    (first <= last).then_some((first, last))
}

/// Whether a segment passes through the inside of a box that is higher than this.
fn cuts_higher(arena: &Arena, from: &PathPoint, to: &PathPoint, height_m: f64) -> bool {
    let higher = arena.boxes().iter().filter(|one| one.height_m > height_m + NEAR_M);
    let length_m = (to.point - from.point).norm();
    higher.filter_map(|one| shares_within(one, from, to, -NEAR_M)).any(|(first, last)| (last - first) * length_m > NEAR_M)
}

/// Whether somewhere along a segment parallel to an axis there are higher boxes on both its sides.
fn is_between(arena: &Arena, from: &PathPoint, to: &PathPoint, height_m: f64) -> bool {
    let (along_x, along_y) = ((from.point.y - to.point.y).abs() <= 1e-12, (from.point.x - to.point.x).abs() <= 1e-12);
    if along_x == along_y {
        return false;
    }
    let way = to.point - from.point;
    let ends = arena.boxes().iter().flat_map(|one| if along_x { [one.min.x, one.max.x] } else { [one.min.y, one.max.y] });
    let share = |at: f64| if along_x { (at - from.point.x) / way.x } else { (at - from.point.y) / way.y };
    let mut cuts: Vec<f64> = ends.map(share).filter(|share| (0.0..=1.0).contains(share)).chain([0.0, 1.0]).collect();
    cuts.sort_unstable_by(f64::total_cmp);
    let side = if along_x { [0.0, 2.0 * NEAR_M] } else { [2.0 * NEAR_M, 0.0] };
    cuts.windows(2).filter(|pair| (pair[1] - pair[0]) * way.norm() > 4.0 * NEAR_M).any(|pair| {
        let middle = from.point + f64::midpoint(pair[0], pair[1]) * way;
        let is_higher = |x: f64, y: f64| {
            let holds = |one: &&ArenaBox| (one.min.x..=one.max.x).contains(&x) && (one.min.y..=one.max.y).contains(&y);
            arena.boxes().iter().filter(holds).any(|one| one.height_m > height_m + NEAR_M)
        };
        is_higher(middle.x + side[0], middle.y + side[1]) && is_higher(middle.x - side[0], middle.y - side[1])
    })
}

/// Whether something of this height is under a point, and nothing higher than it contains the point.
fn stands(arena: &Arena, x: f64, y: f64, height_m: f64) -> bool {
    let holds = |one: &ArenaBox, grow_m: f64| {
        (one.min.x - grow_m..=one.max.x + grow_m).contains(&x) && (one.min.y - grow_m..=one.max.y + grow_m).contains(&y)
    };
    let is_at = |one: &ArenaBox| (one.height_m - height_m).abs() <= NEAR_M;
    let is_held = height_m.abs() <= NEAR_M || arena.boxes().iter().any(|one| is_at(one) && holds(one, NEAR_M));
    is_held && !arena.boxes().iter().any(|one| one.height_m > height_m + NEAR_M && holds(one, -NEAR_M))
}

/// Whether boxes of this height are under all of a segment.
fn is_held(arena: &Arena, from: &PathPoint, to: &PathPoint, height_m: f64) -> bool {
    if height_m.abs() <= NEAR_M {
        return true;
    }
    let equal = arena.boxes().iter().filter(|one| (one.height_m - height_m).abs() <= NEAR_M);
    let mut shares: Vec<(f64, f64)> = equal.filter_map(|one| shares_within(one, from, to, NEAR_M)).collect();
    shares.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut held = 0.0;
    for (first, last) in shares {
        if first > held {
            return false;
        }
        held = f64::max(held, last);
    }
    held >= 1.0
}

/// Whether a segment has the lower height up to one place, and the higher one beyond it.
fn is_one_face(arena: &Arena, from: &PathPoint, to: &PathPoint, (low_m, high_m): (f64, f64)) -> bool {
    let length_m = (to.point - from.point).norm();
    let inside = |one: &ArenaBox| shares_within(one, from, to, -NEAR_M).filter(|(first, last)| (last - first) * length_m > NEAR_M);
    let mut first_high = 1.0_f64;
    let mut between = false;
    for one in arena.boxes() {
        let Some((first, _)) = inside(one) else { continue };
        if (one.height_m - high_m).abs() <= NEAR_M {
            first_high = first_high.min(first);
        }
    }
    for one in arena.boxes() {
        let Some((first, _)) = inside(one) else { continue };
        between |=
            one.height_m > low_m + NEAR_M && one.height_m < high_m - NEAR_M && (first_high - first) * length_m > 2.0 * NEAR_M;
    }
    let landing = PathPoint { point: from.point + first_high * (to.point - from.point), ..*to };
    !between && is_held(arena, &landing, to, high_m)
}
