//! A planned journey and the ground under it.

use std::{
    fmt::{self, Write as _},
    sync::Arc,
};

use sha2::{Digest, Sha256};

use super::DriftCommand;
use crate::{
    ballistics::TakeoffChoice,
    chain::Station,
    graph::{Corridor, CostToGo, PostCosts, PostRisks},
    ground::{ChainGround, ContactPoint, DemGround, MeshContact, MeshGround, Surface},
    hop::HopTest,
    path::HopPath,
    terrain::{FrictionRaster, KeepOut},
};

/// A planned journey and the ground under it. It owns or shares all its data.
///
/// It does not depend on how the path was found: any planner whose result is a [`HopPath`] can be simulated.
#[derive(Clone, Debug)]
pub struct Mission {
    pub(super) ground: MissionGround,
    pub(super) path: HopPath,
    pub(super) start: ContactPoint,
    pub(super) goal: ContactPoint,
    pub(super) replanning: Option<Replanning>,
    /// The ground under the limits that planning may use, over a DEM; `None`: that of the trials.
    pub(super) planned_over: Option<Arc<DemGround>>,
    /// The mission that follows from the goal on.
    next: Option<Box<Self>>,
    /// The command of every hop, of a robot whose heading is not controlled.
    pub(super) drift: Option<DriftCommand>,
}

/// The ground of the trials.
#[derive(Clone, Debug)]
pub(super) enum MissionGround {
    Chain(ChainGround),
    Map(DemGround),
    Mesh(MeshGround),
}

/// The data for replanning.
#[derive(Clone, Debug)]
pub(super) enum Replanning {
    /// The chain of the nodes, and the cost-to-go of each node.
    Nodes { test: Box<HopTest>, to_go: Arc<CostToGo> },
    /// The nodes of a transect and the places beside it.
    Corridor(Arc<Corridor>),
    /// The costs-to-go of the posts of the DEM.
    PostCosts(Arc<PostCosts>),
    /// The risks-to-go of the posts of the DEM.
    PostRisks(Arc<PostRisks>),
    /// Contacts of a mesh.
    Contacts(Arc<MeshAims>),
}

/// Contacts of a mesh that a trial may be replanned to, and how many hops lead on from each of them to the goal.
#[derive(Clone, Debug)]
pub struct MeshAims {
    /// The contacts, with the number of hops from each of them to the goal.
    pub contacts: Vec<(MeshContact, u64)>,
    /// Which arc of a window is flown.
    pub choice: TakeoffChoice,
    /// The ground under the limits that planning may use.
    pub ground: MeshGround,
}

impl Mission {
    const fn new(ground: MissionGround, path: HopPath, [start, goal]: [ContactPoint; 2]) -> Self {
        Self { ground, path, start, goal, replanning: None, planned_over: None, next: None, drift: None }
    }

    /// A path along a chain: flights stay in its vertical plane.
    pub fn along_chain(test: HopTest, path: HopPath, start: Station, goal: Station) -> Self {
        let ends = [start, goal].map(|station| test.chain().contact_point(&station));
        Self::new(MissionGround::Chain(ChainGround::new(test)), path, ends)
    }

    /// A path over a DEM, in any direction: flights follow their heading.
    pub const fn over_dem(ground: DemGround, path: HopPath, start: ContactPoint, goal: ContactPoint) -> Self {
        Self::new(MissionGround::Map(ground), path, [start, goal])
    }

    /// A path over a mesh, under overhangs and through caves: flights follow their heading, up to the first facet that they meet.
    pub const fn over_mesh(ground: MeshGround, path: HopPath, start: ContactPoint, goal: ContactPoint) -> Self {
        Self::new(MissionGround::Mesh(ground), path, [start, goal])
    }

    /// The same mission, and the one that follows from its goal on.
    pub(super) fn followed_by(mut self, next: Self) -> Self {
        let later = match self.next.take() {
            Some(later) => later.followed_by(next),
            None => next,
        };
        Self { next: Some(Box::new(later)), ..self }
    }

    /// The same start, from where every hop has this command and any heading.
    pub(super) fn drifting(self, command: DriftCommand) -> Self {
        Self { drift: Some(command), ..self }
    }

    /// The planned hops, with those of the missions that follow.
    pub(super) fn hops(&self) -> usize {
        self.drift.map_or(self.path.hops.len(), |command| command.hops as usize) + self.next.as_ref().map_or(0, |next| next.hops())
    }

    /// SHA-256 of all that trials depend on, besides errors and options, in hexadecimal: equal for the same mission and the same version
    /// of this crate. It reads every post of a DEM.
    pub(super) fn digest(&self) -> String {
        let mut digest = Sink(Sha256::new());
        // Writing to a digest cannot fail. The text of a double is that of no other one.
        let _ = write!(digest, "{}{:?}{:?}{:?}", env!("CARGO_PKG_VERSION"), self.path, self.start, self.goal);
        let _ = match &self.ground {
            MissionGround::Chain(ground) => chain_text(&mut digest, ground.test()),
            MissionGround::Map(ground) => {
                let _ = limits_text(&mut digest, ground);
                write!(digest, "{:?}", ground.terrain().dem())
            }
            MissionGround::Mesh(ground) => {
                let mesh = ground.tree().mesh();
                write!(digest, "{:?}{:?}{:?}{:?}", ground.envelope(), ground.surface(), mesh.vertices(), mesh.indices())
            }
        };
        match &self.replanning {
            Some(Replanning::Nodes { test, to_go }) => {
                let _ = chain_text(&mut digest, test);
                let _ = write!(digest, "{to_go:?}");
            }
            Some(Replanning::Corridor(corridor)) => {
                let _ = write!(digest, "{corridor:?}");
            }
            Some(Replanning::PostCosts(to_go)) => {
                let _ = write!(digest, "{to_go:?}");
            }
            Some(Replanning::PostRisks(to_go)) => {
                let _ = write!(digest, "{to_go:?}");
            }
            Some(Replanning::Contacts(aims)) => {
                let MeshAims { contacts, choice, ground } = aims.as_ref();
                let _ = write!(digest, "{contacts:?}{choice:?}{:?}", ground.envelope());
            }
            None => {}
        }
        if let Some(ground) = &self.planned_over {
            let _ = limits_text(&mut digest, ground);
        }
        if let Some(command) = &self.drift {
            let _ = write!(digest, "{command:?}");
        }
        if let Some(next) = &self.next {
            let _ = write!(digest, "{}", next.digest());
        }
        digest.0.finalize().iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
    }

    /// The same mission, whose trials may also be replanned over nodes of this chain.
    #[must_use]
    pub fn with_replanning(self, test: HopTest, to_go: Arc<CostToGo>) -> Self {
        Self { replanning: Some(Replanning::Nodes { test: Box::new(test), to_go }), ..self }
    }

    /// The same mission over a DEM, replanned over this ground of it, whose limits planning may use. A mission along a chain has them in the
    /// hop test that it is replanned by.
    #[must_use]
    pub fn planned_over(self, ground: DemGround) -> Self {
        Self { planned_over: Some(Arc::new(ground)), ..self }
    }

    /// The same mission over a DEM, whose trials may also be replanned over the nodes of a transect and the posts beside it.
    #[must_use]
    pub fn with_replanning_beside_the_line(self, corridor: Arc<Corridor>) -> Self {
        Self { replanning: Some(Replanning::Corridor(corridor)), ..self }
    }

    /// The same mission over a DEM, whose trials may also be replanned over its posts, in any direction: the cheapest way. A mission along
    /// a chain has no posts, and is not replanned by them.
    #[must_use]
    pub fn with_replanning_over_posts(self, to_go: Arc<PostCosts>) -> Self {
        Self { replanning: Some(Replanning::PostCosts(to_go)), ..self }
    }

    /// The same mission over a mesh, whose trials may also be replanned: from where the hopper is, to the contact with the fewest hops to
    /// the goal that one hop reaches.
    #[must_use]
    pub fn with_replanning_to_contacts(self, aims: MeshAims) -> Self {
        Self { replanning: Some(Replanning::Contacts(Arc::new(aims))), ..self }
    }

    /// The same by the most reliable way, from the start on.
    #[must_use]
    pub fn with_reliable_replanning_over_posts(self, to_go: Arc<PostRisks>) -> Self {
        Self { replanning: Some(Replanning::PostRisks(to_go)), ..self }
    }
}

/// A digest as a writer of text.
struct Sink(Sha256);

impl fmt::Write for Sink {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

/// All of a ground that its answers depend on, besides its elevations.
fn limits_text(out: &mut Sink, ground: &DemGround) -> fmt::Result {
    let overlays = ground.terrain().overlays();
    let friction = overlays.friction().map(FrictionRaster::content);
    let zones: Vec<_> = overlays.zones().map(KeepOut::content).collect();
    write!(out, "{:?}{:?}{friction:?}{zones:?}", ground.envelope(), ground.surface())?;
    for layer in overlays.layers().iter() {
        write!(out, "{:?}{:?}", layer.rule(), layer.raster())?;
    }
    let share = overlays.friction().map(FrictionRaster::share).filter(|share| *share != 1.0);
    share.map_or(Ok(()), |share| write!(out, "{share:?}"))
}

/// All of a hop test that its answers depend on.
fn chain_text(out: &mut Sink, test: &HopTest) -> fmt::Result {
    let chain = test.chain();
    write!(out, "{:?}{:?}{:?}{:?}{:?}", chain.geometry(), chain.segments(), chain.hopper(), chain.gravity(), chain.surface())
}
