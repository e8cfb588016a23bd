//! Robots that hop in any direction: small-body hoppers that cannot choose their heading.

use super::{
    Mission, Simulation, SimulationError,
    options::MissionPoint,
    simulation::GroundAndPlan,
    trial::{Plan, PlannedHop},
};
use crate::{
    flight::{Command, Uncertainty},
    ground::{ContactPoint, DemGround, FirstContact, LiftoffVelocity, MapPosition},
    path::{HopPath, Totals},
    quantity::{Angle, MapPoint},
};
use nalgebra::Vector2;

/// The command of every hop of a robot whose heading is not controlled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriftCommand {
    /// Take-off speed, m/s.
    pub takeoff_speed_m_s: f64,
    /// Take-off angle over the horizontal.
    pub takeoff_angle: Angle,
    /// How many hops every trial has.
    pub hops: u32,
}

impl DriftCommand {
    /// The velocity towards north, which every hop turns by an angle of its own.
    fn liftoff(&self) -> LiftoffVelocity {
        let (sine, cosine) = libm::sincos(self.takeoff_angle.radians());
        LiftoffVelocity {
            heading: Vector2::new(0.0, 1.0),
            horizontal_m_s: self.takeoff_speed_m_s * cosine,
            vertical_m_s: self.takeoff_speed_m_s * sine,
        }
    }
}

impl Simulation {
    /// Prepares trials without a plan: every hop has the same command and a heading of its own, each as likely as any other, drawn uniformly
    /// from the circle.
    ///
    /// A trial that flies all hops and rests after each of them counts as [`Reached`](super::TrialOutcome::Reached), wherever it is: there
    /// is no goal. The distances of its landings are those from the start, as are [`HopRecord::error_m`](super::HopRecord) and
    /// [`TrialRecord::goal_distance_m`](super::TrialRecord). Other errors act as along a plan; those of heading and position have no effect, nor
    /// have the policy, the hop limit and the goal tolerance of the options.
    ///
    /// On level ground every first hop ends on one circle about the start, of the radius `v^2 sin(2 theta) / g`, and the mean square of the
    /// distance grows by its square with every hop.
    ///
    /// # Errors
    /// [`SimulationError`]: invalid deviations, a start without ground, or ground without friction.
    ///
    /// # Examples
    /// ```
    /// use chta::{ground::DemGround, quantity::*, terrain::*, uncertainty::*, world::*};
    /// let map = GeoReference::local(MapPoint::new(0.0, 0.0), 5.0, 5.0)?;
    /// let dem = Dem::new(41, 41, vec![0.0; 41 * 41], map)?;
    /// let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.5)?)), rest: RestSlope::AsFrictionHolds };
    /// let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &Hopper::with_speeds(9.0, 9.0)?, Gravity::new(1.6)?, &surface);
    /// // One hop of v^2 / g = 10 m.
    /// let command = DriftCommand { takeoff_speed_m_s: 4.0, takeoff_angle: Angle::from_degrees(45.0), hops: 1 };
    /// let drift = Simulation::drifting(&ground, MapPoint::new(100.0, -100.0), command, Uncertainty::NONE)?;
    /// let summary = drift.run(&TrialOptions { trials: 100, ..TrialOptions::default() }, &mut (), &())?;
    /// assert!((summary.landings[0].error.mean_m - 10.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn drifting(
        ground: &DemGround,
        start: MapPoint,
        command: DriftCommand,
        uncertainty: Uncertainty,
    ) -> Result<Self, SimulationError> {
        uncertainty.check(true)?;
        if ground.surface().grip.is_none() && ground.terrain().overlays().friction().is_none() {
            return Err(SimulationError::NoGrip);
        }
        let found = command.takeoff_speed_m_s;
        if !(found.is_finite() && found > 0.0) {
            return Err(SimulationError::CommandedSpeed { found });
        }
        if command.hops == 0 {
            return Err(SimulationError::NoHops);
        }
        let no_ground = SimulationError::NoGround { which: MissionPoint::Start, x_m: start.x, y_m: start.y };
        let from: MapPosition = ground.position(start).filter(|position| ground.covers(position.at)).ok_or(no_ground)?;
        let hop = PlannedHop { from, command: Command::new(command.liftoff(), from) };
        let hops = vec![hop; command.hops as usize];
        let plan = Plan { start: from, goal: ground.point(&from), hops, replan: None, next: None };
        let at = ContactPoint::on_map(0.0, from.at, from.z_m);
        let nowhere = HopPath { hops: Vec::new(), totals: Totals::default() };
        let mission = Mission::over_dem(ground.clone(), nowhere, at, at).drifting(command);
        Ok(Self { mission, uncertainty, ground_and_plan: GroundAndPlan::Map(ground.clone(), plan) })
    }
}
