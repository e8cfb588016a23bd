//! Replanning over a mesh: to the contact of a list that has the fewest hops to the goal.

use super::{mission::MeshAims, replan::Replan};
use crate::{
    flight::Command,
    ground::{MeshBuffers, MeshGround, MeshPosition, Surface},
};

/// Replanning by hops to the contacts of a list, such as those of the planned path.
#[derive(Debug)]
pub(super) struct ContactReplan {
    ground: MeshGround,
    /// In the order of their hops to the goal.
    aims: MeshAims,
}

impl ContactReplan {
    pub(super) fn new(ground: MeshGround, aims: &MeshAims) -> Self {
        let mut aims = aims.clone();
        aims.contacts.sort_by_key(|(_, hops)| *hops);
        Self { ground, aims }
    }
}

impl Replan<MeshPosition> for ContactReplan {
    fn next(&self, believed: &MeshPosition) -> Option<Command<MeshPosition>> {
        let from = self.ground.contact_near(believed.point_m)?;
        let mut buffers = MeshBuffers::default();
        self.aims.contacts.iter().find_map(|(aim, _)| {
            let (_, lofts) = self.ground.windows(&from, aim, &mut buffers)?;
            if lofts.is_empty() {
                return None;
            }
            let set = self.ground.takeoff_set(&from, aim)?;
            let (_, arc) = set.arc(self.aims.choice, self.ground.gravity_m_s2())?;
            Some(Command::of_arc(&arc, set.course().plane.heading, MeshPosition::from(aim)))
        })
    }
}
