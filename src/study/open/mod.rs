//! From a scenario as it is written to its answers: the way in for programs that embed this crate.
//!
//! A [`Draft`] holds the keys of a scenario before they are validated: of a file, of a text, of a result. Settings replace single keys.
//! Each question is a method of it, which opens the terrain of the scenario, whatever it is, and gives a [`Reply`]: the document that the
//! command of the same name writes as JSON, to the byte.
//!
//! ```
//! use chta::study::open::{Draft, PlanAsked};
//!
//! let mut draft = Draft::read("data/scenarios/simple.toml".as_ref())?;
//! draft.set("hopper.clearance_m=0.1");
//! let reply = draft.plan(&PlanAsked::default(), &())?;
//! assert!(reply.holds && reply.json.contains("\"schema\": \"chta/plan/1\""));
//! # Ok::<(), chta::study::open::AskError>(())
//! ```
//!
//! Callers that need more than the document, such as the command with its pictures and tables, take the steps by themselves:
//! [`Draft::case`] for questions along a chain or of free routes over a DEM, [`Draft::facets`] for free routes over a mesh and robots with
//! legs, [`Draft::over_dem`] for maps, [`Draft::vary`] for keys that are varied; then the functions of [`study`](crate::study).

mod ask;
mod case;
mod draft;
mod drift;
mod error;
mod facets;
mod map;
mod names;
mod purpose;
mod reply;
mod shared;
mod vary;

pub use ask::{
    ArenaAsked, ChainAsked, FanAsked, HopAsked, MapAsked, MapReply, PlanAsked, Ran, SitesAsked, StanceAsked, arena, compare,
    stance_of_contacts,
};
pub use case::OpenCase;
pub use draft::{Draft, Wording};
pub use drift::OpenDrift;
pub use error::{AskError, OpenError};
pub use facets::OpenFacets;
pub use map::OpenMap;
pub use names::relative_name;
pub use purpose::{Purpose, ScenarioEnds};
pub use reply::Reply;
pub use shared::SharedInputs;
pub use vary::OpenVariation;

/// The keys of a terrain that is sliced.
pub const SLICED_TERRAIN: [&str; 10] =
    ["route", "dem", "mesh", "mesh_scale", "start_m", "goal_m", "start_lonlat_deg", "goal_lonlat_deg", "via_m", "via_lonlat_deg"];

/// The keys of a terrain that is given as a chain.
pub const CHAIN_TERRAIN: [&str; 3] = ["chain", "start_x_m", "goal_x_m"];
