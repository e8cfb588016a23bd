//! One function per question: from a validated scenario to its answer.
//!
//! A question along a chain is asked of a [`Case`]: a [`Scenario`](crate::scenario::Scenario) over its terrain. Its answer holds the
//! record that is written ([`report`](crate::report)), the warnings, and what its pictures and tables need. Nothing here prints or
//! writes files. What a result says of its question comes from [`Case::record`]. Programs that embed this crate begin with [`open`], whose
//! questions take a scenario as it is written and give the document of the answer.
//!
//! ```text
//! hop          one hop, limit by limit; mesh_hop over a mesh, mesh_route a path over one, mesh_reach what is reached
//! check        whether a path exists; check_pairs for many pairs
//! plan         the path of fewest hops, with a proof and flown again if that is wanted
//! simulate     how reliably a plan is flown; experiment for the experiments
//! require      the least capability with which the goal can be reached
//! trade        a verdict for every value of one or two keys
//! compare      several scenarios side by side
//! targets_plan a mission over several targets; targets_simulate its trials
//! sites        landing sites ranked
//! CaseTable    many cases of one scenario, one row a case
//! arena        a path of a wheeled jumper among boxes
//! ```

mod alike;
mod arena;
#[cfg(feature = "plot")]
mod arena_picture;
mod batch;
#[cfg(feature = "plot")]
mod captions;
mod case;
mod check;
mod compare;
mod compared;
mod dem_ground;
mod experiment;
pub mod fan;
mod footprint;
mod free_front;
mod free_nodes;
mod free_read_back;
mod free_route;
mod free_size;
mod free_trials;
mod front;
mod gap_keys;
mod hop;
mod journey;
mod journey_path;
mod legs_ends;
mod legs_map;
mod legs_read_back;
mod legs_route;
mod legs_trade;
mod legs_trials;
mod legs_walk;
pub mod map;
mod measured;
mod mesh_compare;
mod mesh_ends;
mod mesh_flaws;
mod mesh_flown;
mod mesh_hop;
mod mesh_reach;
mod mesh_read_back;
mod mesh_route;
mod mesh_trials;
mod nodes;
mod objective;
mod on_body;
pub mod open;
mod overlays;
#[cfg(feature = "plot")]
mod page;
mod physics;
mod pipeline;
mod plan;
mod read_back;
mod record;
mod require;
mod require_free;
mod require_success;
#[cfg(feature = "plot")]
mod robot_mark;
mod schema;
mod sense;
mod sensitivity;
mod simulate;
mod sites;
pub mod slice;
mod stance;
#[cfg(feature = "plot")]
mod stance_picture;
mod swept_key;
mod targets;
mod to_go;
mod trade;
mod trade_free;
mod traded;
mod trajectory;
mod travel;
mod value_scan;
mod variation;

pub use alike::ask_the_same;
pub use arena::{ArenaError, ArenaPlanned, ArenaPlanner, compare_planners, plan_in_arena};
pub use batch::{ANSWERS, BatchRow, CaseTable, CaseTableError};
#[cfg(feature = "plot")]
pub use captions::{conditions, wheels};
pub use case::{Case, CaseError, Commands};
pub use check::{CheckError, Checked, CheckedPair, check, check_pairs};
pub use compare::compare;
pub use compared::{Compared, Comparison};
pub use experiment::{ConeProblem, ExperimentAnswer, ExperimentError, experiment};
pub use footprint::coarse_dem_warning;
pub use free_route::FreeRouteError;
pub use free_size::route_size;
pub use front::{Front, FrontProblem};
pub use hop::{HopError, Hopped, hop};
pub use journey::{JourneyError, Proof};
pub use legs_map::{LegsMap, LegsMapError, LegsMapQuestion, PreparedLegsMap};
pub use legs_route::{LegsRouteError, LegsRouteQuestion, LegsRouted, legs_route};
pub use legs_trade::{LegsTradeQuestion, LegsTraded, legs_trade};
pub use legs_trials::{LegsSimulated, LegsTrialsError, simulate_legs};
pub use measured::with_measured_errors;
pub use mesh_hop::{MeshHopError, MeshHopQuestion, MeshHopped, mesh_hop};
pub use mesh_reach::{MeshReachQuestion, MeshReached, mesh_reach};
pub use mesh_read_back::{MeshChecked, MeshReadBackError, MeshResultPath, check_over_mesh};
pub use mesh_route::{MeshRouteError, MeshRouteQuestion, MeshRouted, mesh_route};
pub use mesh_trials::{MeshSimulated, MeshTrialsError, merged_over_mesh, simulate_over_mesh, tally_over_mesh};
pub use on_body::{OfBody, dem_on_body, on_body};
pub use overlays::{Overlays, friction};
#[cfg(feature = "plot")]
pub use page::{DocumentInPage, PageDocuments, PageError, page_ground, page_ground_over_facets};
pub use physics::{Extent, Extremes, TooLarge, constant_gravity_warnings};
pub use pipeline::{DemReading, JourneyEnd, PipelineError, Prepared, Survey, Transect, prepare, sha256_of};
pub use plan::{Defect, PlanError, PlanOptions, Planned, plan};
pub use read_back::ReadBackError;
pub use record::{CaseRecord, checksums, comparison_document, raster_files, scenario_files};
pub use require::{RangeProblem, RequireError, Required, Requirement, require};
pub use schema::SchemaKind;
pub use sense::TrialGround;
pub use simulate::{Drift, Drifted, PartsProblem, SimulateError, SimulateOptions, Simulated, Trials, simulate};
pub use sites::{Candidates, SitesQuestion, SitesStudy, sites};
pub use stance::{ContactsError, StanceError, StanceQuestion, StanceTerrain, Stood, contacts_of, stand};
#[cfg(feature = "plot")]
pub use stance_picture::contacts_picture;
pub use swept_key::SweptKey;
pub use targets::{TargetsPlanned, TargetsSimulated, targets_plan, targets_simulate};
pub use trade::{CellError, Trade, TradeError, TradedCells, Varied, verdict};
pub use traded::{Traded, trade};
pub use trajectory::TrajectoryError;
pub use travel::{
    DriveDefect, ReachedBy, TravelMap, TravelMapOptions, TravelOptions, TravelPlanned, TravelSimulated, travel_map,
    travel_map_size, travel_plan, travel_simulate, travel_size,
};
pub use variation::Variation;
