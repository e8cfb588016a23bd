//! How reliably a planned path is flown: outcomes and their frequencies under errors of command, ground and position.
//!
//! A planned path assumes exact execution. Here it is flown many times over ground that differs from the map, with commands that
//! are executed with errors. Each [`HopRecord`] is one parabolic arc to its first contact with the ground, found exactly, and
//! checked at its actual take-off and landing.
//!
//! ```text
//!   trial n -> draws (seed, n) -> hop by hop:
//!     command + errors -> take-off checked -> first contact -> landing checked -> bounces -> bounce and roll
//! ```
//!
//! Along a chain, flights stay in its vertical plane; over a DEM ([`DemGround`](crate::ground::DemGround)) they follow their
//! heading.
//!
//! # What is checked, and what is not
//! At the take-off, the actual direction against the cone of the ground there. At the actual landing, direction, speed and rest
//! slope. At contacts after a bounce, speed and keep-out zones. Where the robot comes to rest, the rest slope and keep-out zones. A cone is that of friction about the normal of the
//! actual facet, or the angles stated for the segment. The first contact is with the ground itself: the clearance is a margin of
//! the plan. The machine's own limits (speed, angle, height and time of flight) apply to commands, not to errors of their
//! execution.
//!
//! # Examples
//! ```
//! use chta::{chain::*, graph::*, hop::{HopTest, Split}, path::generate, quantity::*, uncertainty::*, world::*};
//! let hopper = Hopper::with_speeds(9.0, 9.0)?;
//! let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(1.5)?)), rest: RestSlope::AsFrictionHolds };
//! let chain = PolygonalChain::bare(vec![ChainPoint::new(-50.0, 0.0), ChainPoint::new(99.0, 0.0)])?;
//! let chain = ConstrainedChain::new(chain, &hopper, Gravity::new(1.6)?, &surface)?;
//! let test = HopTest::new(chain);
//! let chain = test.chain();
//! let (start, goal) = (chain.geometry().station(0.0)?, chain.geometry().station(40.0)?);
//! let answer = search(&test, start, goal, &SearchOptions::default(), &())?;
//! let Outcome::Path { legs, .. } = answer.outcome else { panic!("no path") };
//! let path = generate(&test, &legs, Default::default(), Split::FullReach)?;
//!
//! let mission = Mission::along_chain(test, path, start, goal);
//! // One hop of 40 m at v = sqrt(g X) = 8 m/s: 1 % of speed is 2 % of range, 0.8 m. 1.6 m are two deviations: 95 % succeed.
//! let errors = Uncertainty { takeoff_speed_sigma_fraction: 0.01, ..Uncertainty::NONE };
//! let options = TrialOptions { trials: 5000, goal_tolerance_m: 1.6, ..TrialOptions::default() };
//! let summary = Simulation::new(&mission, errors)?.run(&options, &mut (), &())?;
//! assert!(summary.success.low < 0.954 && 0.954 < summary.success.high, "{:?}", summary.success);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod density;
mod drift;
mod driving;
mod exact_sum;
pub mod experiments;
mod hop_success;
mod landing_tally;
mod legs;
mod legs_walk;
mod mission;
mod options;
mod outcome;
mod paired;
mod post_replan;
mod quantiles;
mod rates;
mod record;
mod replan;
mod replan_mesh;
mod scatter;
mod simulation;
mod summary;
mod tally;
mod travel;
mod travel_replan;
mod trial;
mod wilson;

pub use crate::{
    flight::{Distribution, DrawnErrors, ErrorKey, MeasuredErrors, Uncertainty, UncertaintyProblem},
    ground::LiftoffVelocity,
};
pub use density::{DensestCell, RestDensity};
pub use drift::DriftCommand;
pub use legs::{LegsMission, LegsOutcome, LegsSummary};
pub use legs_walk::LegsWalking;
pub use mission::{MeshAims, Mission};
pub use options::{MissionPoint, Observer, SimulationError, TrialOptions};
pub use outcome::{OutcomeCounts, Policy, TrialOutcome};
pub use paired::PairedDifference;
pub use quantiles::QuantileSketch;
pub use record::{HopRecord, Trajectory, TrialRecord};
pub use scatter::HopScatter;
pub use simulation::{ESTIMATE_TRIALS, FlightEnd, Simulation};
pub use summary::{ErrorSummary, LandingEllipse, LandingSummary, RatePoint, Summary};
pub use tally::{MergeProblem, Tally};
pub use travel::{TravelMission, TravelMove, TravelOutcome, TravelSummary};
pub use travel_replan::TravelToGo;
pub use wilson::Wilson;
