//! The ground and the policy of the trials of a plan.

use super::SimulateError;
use crate::{
    ground::DemGround,
    path::HopPath,
    progress::Progress,
    study::{Planned, dem_ground::dem_ground, front::FlownJourney, to_go::ToGo},
    uncertainty::{Policy, Simulation, Uncertainty},
};

/// A plan with everything that its trials need.
pub(in crate::study) struct Flyer<'a> {
    planned: &'a Planned,
    /// The whole raster with its overlays, for flights in three dimensions.
    ground: Option<DemGround>,
    to_go: Option<ToGo>,
}

impl<'a> Flyer<'a> {
    /// Takes raster and replanning policy from the plan, as far as it has them.
    pub(in crate::study) fn new(planned: &'a Planned, policies: &[Policy], progress: &dyn Progress) -> Result<Self, SimulateError> {
        let mut flyer = Self { planned, ground: dem_ground(&planned.case)?, to_go: None };
        let replans = policies.contains(&Policy::Replan);
        flyer.to_go = match (&planned.to_go, &planned.path) {
            (Some(known), _) if replans => Some(known.clone()),
            (None, Some(path)) if replans => {
                let options = planned.case.scenario.uncertainty.clone().unwrap_or_default().options();
                flyer.journey().to_go_of(&planned.found, path, &options, progress)?
            }
            _ => None,
        };
        Ok(flyer)
    }

    fn journey(&self) -> FlownJourney<'_> {
        let Planned { case, test, ends, .. } = self.planned;
        FlownJourney { scenario: &case.scenario, test, whole: case.whole_test(), ends: *ends, ground: self.ground.as_ref() }
    }

    /// The whole raster with its overlays, if the terrain is one.
    pub(super) fn into_ground(self) -> Option<DemGround> {
        self.ground
    }

    /// The trials along a path over this ground.
    pub(super) fn simulation(&self, path: &HopPath) -> Result<Simulation, SimulateError> {
        self.journey().simulation(path, self.to_go.as_ref())
    }

    /// The same under other errors than those of the scenario; replanning counts on those of the scenario all the same.
    pub(in crate::study) fn simulation_under(&self, path: &HopPath, errors: Uncertainty) -> Result<Simulation, SimulateError> {
        self.journey().simulation_under(path, self.to_go.as_ref(), errors)
    }
}
