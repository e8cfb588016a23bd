//! What the paths of a map have least, and the command of each hop for it.

use std::cmp::Ordering;

use super::{MapError, PostHops};
use crate::{
    ballistics::{Arc, FlightEnvelope, LineOfSight, TakeoffChoice},
    ground::Surface,
    planner::{Amount, Objective, SearchedCommands},
    quantity::SlopeInterval,
    world::HopperLimits,
};

/// Far more than the rounding errors of a bound from the line of sight.
const SHAVED: f64 = 1.0 - 1.0e-9;

/// Far more than those of lofts before the terrain is looked at, of some 1e-8.
const ROUGHLY: f64 = 1.0 - 1.0e-7;

/// An objective over a ground: the command that each hop has for it, and bounds on what a hop takes.
#[derive(Clone, Debug)]
pub struct MapObjective {
    objective: Objective,
    /// The commands of which each hop has the best.
    choices: Vec<TakeoffChoice>,
    envelope: FlightEnvelope,
    limits: HopperLimits,
    /// The sum of the greatest speeds at both ends of an arc, m/s.
    speeds_m_s: f64,
    /// Whether the first choice has the least first amount over all lofts that contain those of a hop.
    bounds_by_lofts: bool,
}

impl MapObjective {
    /// An objective over the hops of a map.
    ///
    /// Each hop has its best command for the objective: of least speed for energy and speeds, of least time for times, and for what has no
    /// such rule (the length of an arc, the delta-v of braked landings) the best of least speed, least time and the middle. With
    /// [`SearchedCommands::Chosen`] each has the chosen one.
    pub fn new(hops: &PostHops, objective: &Objective, commands: SearchedCommands, chosen: TakeoffChoice) -> Self {
        let ground = hops.ground();
        let (envelope, limits, gravity) = (*ground.envelope(), *ground.hopper().limits(), ground.gravity_m_s2());
        let first_of_command = objective.amounts().iter().find(|amount| !amount.is_of_places());
        let choices = match (commands, first_of_command) {
            (SearchedCommands::Chosen, _) | (_, None) => vec![chosen],
            (_, Some(Amount::Energy | Amount::TakeoffSpeed | Amount::PeakSpeed)) => vec![TakeoffChoice::LeastSpeed],
            (_, Some(Amount::DeltaV)) if !limits.landing.brakes() => vec![TakeoffChoice::LeastSpeed],
            (_, Some(Amount::FlightTime | Amount::MissionTime)) => vec![TakeoffChoice::LeastTime],
            (_, Some(_)) => vec![TakeoffChoice::LeastSpeed, TakeoffChoice::LeastTime, TakeoffChoice::MidRange],
        };
        let bounds_by_lofts = match (objective.first(), &choices[..]) {
            (Amount::DeltaV, [TakeoffChoice::LeastSpeed]) => !limits.landing.brakes(),
            (Amount::Energy | Amount::TakeoffSpeed, [TakeoffChoice::LeastSpeed])
            | (Amount::FlightTime | Amount::MissionTime, [TakeoffChoice::LeastTime]) => true,
            _ => false,
        };
        let (low_m, high_m) = ground.terrain().dem().elevation_range_m();
        let takeoff_m_s = limits.takeoff_speed_max_m_s;
        let fallen_m_s = (takeoff_m_s * takeoff_m_s + 2.0 * gravity * (high_m - low_m)).sqrt();
        // Speeds count with more than the tolerance of their limits.
        let speeds_m_s = (takeoff_m_s + limits.arc_landing_speed_max_m_s().min(fallen_m_s)) * (1.0 + 1.0e-8);
        Self { objective: objective.clone(), choices, envelope, limits, speeds_m_s, bounds_by_lofts }
    }

    /// The objective.
    pub const fn objective(&self) -> &Objective {
        &self.objective
    }

    /// The amounts, the first first.
    pub fn amounts(&self) -> &[Amount] {
        self.objective.amounts()
    }

    /// Refuses an objective of what is no sum over the hops of a map.
    ///
    /// # Errors
    /// [`MapError::Request`] for risk, for layers, and for an amount that does not add up in the first place.
    pub fn accepts(objective: &Objective) -> Result<(), MapError> {
        let refused = if objective.first().adds_up() {
            objective.amounts().iter().find(|amount| matches!(amount, Amount::Risk | Amount::Layer(_)))
        } else {
            Some(&Amount::PeakSpeed)
        };
        refused.map_or(Ok(()), |refused| {
            let expected = "amounts without risk and layers, the first of which adds up over hops: hops, takeoff-speed, delta-v, energy, flight-time, \
                            mission-time, distance or arc-length";
            Err(MapError::Request { what: "the objective of a map", found: refused.name().to_owned(), expected })
        })
    }

    /// What no hop along a line of sight takes less of, of the amount at this place of the objective.
    ///
    /// ```text
    ///     v_t^2 >= g (C + Z),   flight time >= 2 C / (v_t + v_l),   arc >= C
    /// ```
    #[inline]
    pub(super) fn bound(&self, place: usize, sight: LineOfSight) -> f64 {
        let (run_m, rise_m) = (sight.run_m(), sight.slope() * sight.run_m());
        let chord_m = run_m * sight.secant();
        let speed_squared = || (self.envelope.gravity_m_s2() * (chord_m + rise_m)).max(0.0) * SHAVED;
        let flight_s = || 2.0 * chord_m / self.speeds_m_s * SHAVED;
        match self.amounts()[place] {
            Amount::Hops => 1.0,
            Amount::TakeoffSpeed | Amount::PeakSpeed => speed_squared().sqrt(),
            Amount::DeltaV => (speed_squared().sqrt() + self.limits.hop_delta_v_overhead_m_s.unwrap_or(0.0)) * SHAVED,
            Amount::Energy => self.limits.store_energy_j_kg(0.5 * speed_squared(), 1) * SHAVED,
            Amount::FlightTime => flight_s(),
            Amount::MissionTime => (flight_s() + self.limits.preparation_time_s.unwrap_or(0.0)) * SHAVED,
            Amount::Distance => run_m,
            Amount::ArcLength => chord_m * SHAVED,
            Amount::Risk | Amount::Layer(_) => 0.0,
        }
    }

    /// What no hop takes less of the first amount whose lofts are among these; `None` where they say nothing.
    #[inline]
    pub(super) fn bound_of_lofts(&self, sight: LineOfSight, lofts: SlopeInterval, is_first: bool) -> Option<f64> {
        let choice = self.choices.first().filter(|_| self.bounds_by_lofts)?;
        let arc = Arc::new(sight, choice.loft(sight, lofts), self.envelope.gravity_m_s2());
        Some(self.objective.first().of_arc(&arc, &self.limits, is_first) * ROUGHLY)
    }

    /// The arc that a hop with these lofts has for the objective.
    pub fn arc(&self, sight: LineOfSight, lofts: SlopeInterval, is_first: bool) -> Arc {
        self.best(&[0.0; Objective::MOST], sight, lofts, is_first).0
    }

    /// The best arc of a hop with these lofts, and the totals of a path with the totals `own` and this hop.
    pub(super) fn best(
        &self,
        own: &[f64],
        sight: LineOfSight,
        lofts: SlopeInterval,
        is_first: bool,
    ) -> (Arc, [f64; Objective::MOST]) {
        let arc = |choice: &TakeoffChoice| {
            let arc = Arc::new(sight, self.envelope.loft(*choice, sight, lofts), self.envelope.gravity_m_s2());
            let mut takes = [0.0; Objective::MOST];
            for (takes, amount) in takes.iter_mut().zip(self.amounts()) {
                *takes = amount.of_arc(&arc, &self.limits, is_first);
            }
            (arc, takes)
        };
        let (mut best, mut least) = arc(&self.choices[0]);
        for choice in &self.choices[1..] {
            let (other, takes) = arc(choice);
            let order = takes.iter().zip(&least).map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne());
            if order == Some(Ordering::Less) {
                (best, least) = (other, takes);
            }
        }
        for ((least, amount), own) in least.iter_mut().zip(self.amounts()).zip(own) {
            *least = amount.join(*own, *least);
        }
        (best, least)
    }
}
