//! A path in time: where the hopper is, and how fast, at every step of a clock.

use nalgebra::Vector2;

use super::{Hop, HopPath};
use crate::{ballistics::Arc, quantity::MapPoint, world::HopperLimits};

/// What the hopper does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// It flies.
    Flight,
    /// It bounces after its landing. The plan goes on from the landing, and so does the table.
    Bouncing,
    /// It rests where it landed.
    Rest,
    /// It prepares a hop.
    Preparation,
    /// It settles where it landed.
    Settling,
}

impl Phase {
    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::Bouncing => "bouncing",
            Self::Rest => "rest",
            Self::Preparation => "preparation",
            Self::Settling => "settling",
        }
    }
}

/// The waits about the flight of one hop: before it at its take-off, after it at its landing, each with its duration in s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Waits {
    before: Option<(Phase, f64)>,
    after: Option<(Phase, f64)>,
}

impl Waits {
    /// Those of a hop of a path. A hopper settles between hops, so not after the last one: the waits add up to what
    /// [`Totals::mission_time_s`](super::Totals::mission_time_s) has beside the flights.
    fn of(hopper: &HopperLimits, is_last: bool) -> Self {
        let before = hopper.preparation_time_s.map(|time_s| (Phase::Preparation, time_s));
        // The old rest time keeps its own name.
        let phase = if hopper.settling_time_s.is_some() { Phase::Settling } else { Phase::Rest };
        Self { before, after: hopper.settling_s().filter(|_| !is_last).map(|time_s| (phase, time_s)) }
    }
}

/// The state of the hopper at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedState {
    /// Time from the beginning of the mission, s.
    pub time_s: f64,
    /// The number of the hop, from 1: the one in flight, or the one that a rest belongs to.
    pub hop: usize,
    /// What the hopper does.
    pub phase: Phase,
    /// Position along the path, m: of a hop beside its line, the projection.
    pub x_m: f64,
    /// Height, m.
    pub z_m: f64,
    /// Position on the map, if the ground is on one.
    pub map: Option<MapPoint>,
    /// Velocity along x, m/s; negative in reverse. Of a hop beside its line, the projection.
    pub vx_m_s: f64,
    /// Velocity upwards, m/s.
    pub vz_m_s: f64,
    /// Velocity along the axes of the map, m/s.
    pub map_velocity_m_s: Option<Vector2<f64>>,
    /// Direction of flight of the hop on the map, clockwise from grid north, degrees.
    pub heading_deg: f64,
}

/// A path with a clock.
#[derive(Clone, Debug)]
pub struct Timetable<'a> {
    path: &'a HopPath,
    hopper: HopperLimits,
    gravity_m_s2: f64,
    step_s: f64,
    duration_s: f64,
}

/// Why a path has no timetable with a step.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TimetableError {
    /// A step that is no duration.
    #[error("a step of {step_s} s, expected a number above 0")]
    Step {
        /// The step.
        step_s: f64,
    },
    /// Too many instants.
    #[error(
        "a step of {step_s} s over {duration_s:.6} s gives {instants:.4e} rows, some {:.4e} GB; expected at most {}: take a step of at \
         least {least_step_s:.6e} s",
        Timetable::ROW_BYTES * instants * 1.0e-9, Timetable::MOST
    )]
    TooMany {
        /// The step.
        step_s: f64,
        /// From the first instant to the last.
        duration_s: f64,
        /// How many instants it gives.
        instants: f64,
        /// The shortest step with few enough instants.
        least_step_s: f64,
    },
}

impl<'a> Timetable<'a> {
    /// The most instants of the clock: 200 MB as text. Those of take-offs and landings are not counted.
    pub const MOST: u32 = 1_000_000;
    /// The size of a row as text.
    const ROW_BYTES: f64 = 200.0;
    /// Instants nearer to each other than this share of a step are one.
    const SAME: f64 = 1.0e-9;

    /// A timetable. Without a step: a fiftieth of the longest flight, or a hundred-thousandth of the whole duration if that is longer.
    ///
    /// # Errors
    /// [`TimetableError`].
    pub fn new(path: &'a HopPath, hopper: &HopperLimits, gravity_m_s2: f64, step_s: Option<f64>) -> Result<Self, TimetableError> {
        if let Some(step_s) = step_s.filter(|step_s| !(*step_s > 0.0 && step_s.is_finite())) {
            return Err(TimetableError::Step { step_s });
        }
        let table = Self { path, hopper: *hopper, gravity_m_s2, step_s: 0.0, duration_s: 0.0 };
        let duration_s = table.spans().last().map_or(0.0, |span| span.end_s);
        let longest_s = path.hops.iter().map(|hop| hop.flight_time_s).fold(0.0, f64::max);
        let step_s = step_s.unwrap_or_else(|| (longest_s / 50.0).max(duration_s / 1.0e5));
        let instants = duration_s / step_s;
        if instants > f64::from(Self::MOST) {
            let least_step_s = duration_s / f64::from(Self::MOST) * (1.0 + 1.0e-6);
            return Err(TimetableError::TooMany { step_s, duration_s, instants, least_step_s });
        }
        Ok(Self { step_s, duration_s, ..table })
    }

    /// The step of the clock, s.
    pub const fn step_s(&self) -> f64 {
        self.step_s
    }

    /// From the beginning to the end of the mission, s.
    pub const fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The states at all multiples of the step, and at the instants of every take-off and landing, in the order of time.
    ///
    /// At a landing the hopper still has its landing velocity. Where no rest follows, the next take-off has the same time.
    pub fn states(&self) -> impl Iterator<Item = TimedState> + '_ {
        let same_s = Self::SAME * self.step_s;
        let mut ticks: u32 = 0;
        let mut landed_s = f64::NEG_INFINITY;
        self.spans().flat_map(move |span| {
            let mut times = Vec::new();
            if span.phase == Phase::Flight {
                times.push(span.begin_s);
                // A multiple of the step at the take-off is the take-off.
                while self.tick_s(ticks) <= span.begin_s + same_s && ticks <= Self::MOST {
                    ticks += 1;
                }
            }
            while self.tick_s(ticks) < span.end_s - same_s && ticks <= Self::MOST {
                if self.tick_s(ticks) > landed_s + same_s {
                    times.push(self.tick_s(ticks));
                }
                ticks += 1;
            }
            if matches!(span.phase, Phase::Flight | Phase::Bouncing) {
                times.push(span.end_s);
                landed_s = span.end_s;
            }
            let arc = span.arc(self.gravity_m_s2);
            times.into_iter().map(move |time_s| span.state(&arc, time_s))
        })
    }

    /// The time of a multiple of the step, s.
    fn tick_s(&self, ticks: u32) -> f64 {
        f64::from(ticks) * self.step_s
    }

    /// All phases in the order of time.
    fn spans(&self) -> impl Iterator<Item = Span<'a>> + '_ {
        let count = self.path.hops.len();
        let phases = self.path.hops.iter().enumerate().flat_map(move |(i, hop)| {
            let Waits { before, after } = Waits::of(&self.hopper, i + 1 == count);
            let bounces = hop.roll_out.filter(|it| it.time_s > 0.0).map(|it| (Phase::Bouncing, it.time_s));
            [before, Some((Phase::Flight, hop.flight_time_s)), bounces, after]
                .into_iter()
                .enumerate()
                .filter_map(move |(place, phase)| phase.map(|(phase, lasts_s)| (i + 1, hop, phase, lasts_s, place >= 2)))
        });
        phases.scan(0.0, |begin_s, (number, hop, phase, lasts_s, is_landed)| {
            let span = Span { number, hop, phase, is_landed, begin_s: *begin_s, end_s: *begin_s + lasts_s };
            *begin_s = span.end_s;
            Some(span)
        })
    }
}

/// One phase of one hop.
#[derive(Clone, Copy, Debug)]
struct Span<'a> {
    number: usize,
    hop: &'a Hop,
    phase: Phase,
    /// Whether it lies after the landing.
    is_landed: bool,
    begin_s: f64,
    end_s: f64,
}

impl Span<'_> {
    /// The arc of its hop.
    fn arc(&self, gravity_m_s2: f64) -> Arc {
        let sight = self.hop.line_of_sight();
        Arc::new(sight, self.hop.takeoff_angle.slope() - sight.slope(), gravity_m_s2)
    }

    /// How much of the horizontal speed is along the path: all of it, but for a hop beside its line.
    fn projected(&self) -> f64 {
        if self.hop.is_beside_line() {
            return (self.hop.landing.along_m - self.hop.takeoff.along_m).abs() / self.hop.run_m();
        }
        1.0
    }

    /// The state at a time of the phase.
    fn state(&self, arc: &Arc, time_s: f64) -> TimedState {
        let (from, to) = (self.hop.takeoff.in_profile(), self.hop.landing.in_profile());
        let flies = self.phase == Phase::Flight;
        // The share of the flight that is over: equal shares of time are equal shares of the run.
        let share = match self.phase {
            Phase::Flight if time_s >= self.end_s => 1.0,
            Phase::Flight => ((time_s - self.begin_s) / (self.end_s - self.begin_s)).max(0.0),
            Phase::Bouncing | Phase::Rest | Phase::Preparation | Phase::Settling if self.is_landed => 1.0,
            Phase::Bouncing | Phase::Rest | Phase::Preparation | Phase::Settling => 0.0,
        };
        let run_m = arc.line_of_sight().run_m();
        let across_m_s = if flies { self.hop.horizontal_speed_m_s() } else { 0.0 };
        let sign = self.hop.direction.sign();
        let map = self.hop.map_ends();
        let on_ground = |point: f64, other: f64| if share == 1.0 { other } else { point };
        TimedState {
            time_s,
            hop: self.number,
            phase: self.phase,
            x_m: on_ground(from.x_m + (to.x_m - from.x_m) * share, to.x_m),
            z_m: on_ground(from.z_m + arc.height_at_m(run_m * share), to.z_m),
            map: map.map(|(takeoff, landing)| if share == 1.0 { landing } else { takeoff + (landing - takeoff) * share }),
            vx_m_s: if flies { sign * across_m_s * self.projected() } else { 0.0 },
            // The slope falls from m to 2 b - m in equal steps over the run.
            vz_m_s: if flies { across_m_s * (arc.takeoff_slope() - 2.0 * arc.loft() * share) } else { 0.0 },
            map_velocity_m_s: map.map(|(takeoff, landing)| (landing - takeoff).try_normalize(0.0).unwrap_or_default() * across_m_s),
            heading_deg: self.hop.heading_deg,
        }
    }
}
