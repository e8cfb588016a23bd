//! Replanning over a mesh: to the contact of a list that has the fewest hops to the goal.

use super::{mission::MeshAims, replan::Replan};
use crate::{
    flight::Command,
    ground::{MeshBuffers, MeshPosition, Surface},
};

/// Replanning by hops to the contacts of a list, such as those of the planned path.
#[derive(Debug)]
pub(super) struct ContactReplan {
    /// In the order of their hops to the goal.
    aims: MeshAims,
}

impl ContactReplan {
    pub(super) fn new(aims: &MeshAims) -> Self {
        let mut aims = aims.clone();
        aims.contacts.sort_by_key(|(_, hops)| *hops);
        Self { aims }
    }
}

impl Replan<MeshPosition> for ContactReplan {
    fn next(&self, believed: &MeshPosition) -> Option<Command<MeshPosition>> {
        let MeshAims { contacts, choice, ground } = &self.aims;
        let from = ground.contact_near(believed.point_m)?;
        let mut buffers = MeshBuffers::default();
        contacts.iter().find_map(|(aim, _)| {
            let (_, lofts) = ground.windows(&from, aim, &mut buffers)?;
            if lofts.is_empty() {
                return None;
            }
            let set = ground.takeoff_set(&from, aim)?;
            let (_, arc) = set.arc(*choice, ground.gravity_m_s2())?;
            Some(Command::of_arc(&arc, set.course().plane.heading, MeshPosition::from(aim)))
        })
    }
}
