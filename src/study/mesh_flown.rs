//! A free route over a mesh flown again, and its picture.

use super::{Defect, MeshRouted};
#[cfg(feature = "plot")]
use super::{captions::title, conditions};
#[cfg(feature = "plot")]
use crate::figure::{Caption, FigureError, MeshRouteFigure, MeshRouteLine, Picture, SeenFrom, draw_mesh_route};
use crate::{
    chain::ConstraintProblem,
    ground::{MeshGround, MeshPosition},
    path::{HopPath, execute_over_mesh},
    planner::roadmap::GrownRoadmap,
    scenario::Scenario,
    uncertainty::{MeshAims, Mission},
};

/// Flies a path of a roadmap again, from the start to the goal.
///
/// # Errors
/// [`Defect`], where a hop breaks a limit.
pub(super) fn flown_again(ground: &MeshGround, grown: &GrownRoadmap, stand_off_m: f64, path: &HopPath) -> Result<(), Defect> {
    let ground = ground.clone().standing_off(stand_off_m);
    let [start, goal] = [grown.ends.0, grown.ends.1].map(|node| MeshPosition::from(grown.roadmap.contact(node)));
    Defect::unless_passed(&execute_over_mesh(&ground, path, Some((start, goal))))
}

impl MeshRouted {
    /// The path as a mission for trials, with the whole limits of a scenario, replanned under those of the plan: from where the hopper is,
    /// to the contact of the roadmap with the fewest hops to the goal that one hop reaches. `None` without a path, and for a ball, of which trials do not follow the first contact.
    ///
    /// # Errors
    /// [`ConstraintProblem`], where the surface states no grip, or the hopper no speeds.
    pub fn mission(&self, scenario: &Scenario) -> Result<Option<Mission>, ConstraintProblem> {
        let Some(path) = self.path.clone().filter(|_| self.ground.radius_m() == 0.0) else { return Ok(None) };
        let roadmap = &self.grown.roadmap;
        let planning = self.ground.clone().standing_off(scenario.mesh_search.contacts_stand_off_m());
        let ground = planning.under(&scenario.hopper.with_any_command(), scenario.body.gravity, &scenario.surface)?;
        let start = roadmap.contact(self.grown.ends.0).at_m(0.0);
        let goal = roadmap.contact(self.grown.ends.1).at_m(path.hops.last().map_or(0.0, |hop| hop.landing.along_m));
        let hops_to_goal = roadmap.hops_to(self.grown.ends.1).into_iter().enumerate();
        let contacts = hops_to_goal.filter_map(|(node, hops)| Some((roadmap.contact(node).clone(), u64::from(hops?)))).collect();
        let aims = MeshAims { contacts, choice: scenario.search.takeoff, ground: planning };
        Ok(Some(Mission::over_mesh(ground, path, start, goal).with_replanning_to_contacts(aims)))
    }
}

#[cfg(feature = "plot")]
impl MeshRouted {
    /// The picture of the path: an oblique view, a plan view and the table of its hops.
    ///
    /// # Errors
    /// As [`draw_mesh_route`].
    pub fn picture(&self, scenario: &Scenario, seen_from: SeenFrom) -> Result<Picture, FigureError> {
        let [start, goal] = [self.grown.ends.0, self.grown.ends.1].map(|node| self.grown.roadmap.contact(node).point_m());
        let contacts = self.answer.roadmap.contacts;
        let result = self.path.as_ref().map_or_else(
            || format!("no path over these {contacts} contacts"),
            |path| {
                let (hops, time_s) = (path.hops.len(), path.totals.flight_time_s);
                format!("at most {hops} hops over these {contacts} contacts, {time_s:.2} s in flight")
            },
        );
        let gravity_m_s2 = self.ground.envelope().gravity_m_s2();
        draw_mesh_route(&MeshRouteFigure {
            caption: Caption { title: title("Free route over a mesh", scenario), lines: vec![conditions(scenario), result] },
            mesh: self.ground.tree().mesh(),
            seen_from,
            cut_z_m: None,
            start,
            goal,
            routes: self.path.iter().map(|path| MeshRouteLine { name: "", path, gravity_m_s2 }).collect(),
            walks: Vec::new(),
            nearest: self.answer.gap.as_ref().map(|gap| gap.nearest_m.into()),
        })
    }
}
