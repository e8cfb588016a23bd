//! Many trials of one mission.

use nalgebra::{Point3, Vector2};

use super::{Mission, Observer, SimulationError, Summary, TrialOptions, Uncertainty};

/// A mission made ready to be flown again and again.
#[derive(Debug)]
pub struct Simulation<'a> {
    mission: Mission<'a>,
    uncertainty: Uncertainty,
}

/// How a hop really leaves the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Launch {
    /// Direction on the map (east, north), of length 1; on a chain (1, 0) or (-1, 0).
    pub heading: Vector2<f64>,
    /// Horizontal speed, m/s.
    pub horizontal_m_s: f64,
    /// Vertical speed, m/s.
    pub vertical_m_s: f64,
}

/// Where a flight ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightEnd {
    /// The first contact with the ground, or where the known ground ends under the flight.
    pub at_m: Point3<f64>,
    /// Whether it is a contact.
    pub landed: bool,
    /// Time of flight, s.
    pub time_s: f64,
}

impl<'a> Simulation<'a> {
    /// A mission under these errors.
    ///
    /// # Errors
    /// [`SimulationError`] where the deviations make no sense, or path and map do not belong together.
    pub fn new(mission: Mission<'a>, uncertainty: Uncertainty) -> Result<Self, SimulationError> {
        uncertainty.check(mission.map.is_some())?;
        Ok(Self { mission, uncertainty })
    }

    /// Flies the trials.
    ///
    /// # Errors
    /// [`SimulationError`].
    pub fn run(&self, options: &TrialOptions, observer: &mut dyn Observer) -> Result<Summary, SimulationError> {
        let _ = (&self.mission, self.uncertainty, options, observer);
        Err(SimulationError::NoTrials)
    }

    /// Flies the trials under both policies on the same draws.
    ///
    /// # Errors
    /// [`SimulationError`].
    pub fn compare(&self, options: &TrialOptions, observer: &mut dyn Observer) -> Result<[Summary; 2], SimulationError> {
        let mut of = |policy| self.run(&TrialOptions { policy, ..*options }, observer);
        let [open_loop, replan] = super::Policy::ALL;
        Ok([of(open_loop)?, of(replan)?])
    }

    /// Flies one hop from a place of the nominal ground to its first contact; `None` where there is no ground at that place.
    pub fn fly(&self, from: Point3<f64>, launch: Launch) -> Option<FlightEnd> {
        let _ = (from, launch);
        None
    }
}
