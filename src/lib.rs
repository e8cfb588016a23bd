//! Constrained hopping traversability analysis: can a ballistic hopper get from here to there, in how few hops, with which
//! commands?
//!
//! A hopper travels by ballistic hops over terrain. Friction cones limit its take-off and landing angles, the machine limits its
//! take-off and landing speeds, and the terrain between must be cleared. This crate answers for a vertical slice of an elevation
//! raster, for a given polygonal chain, and in any direction over a whole raster.
//!
//! # From a DEM to a path
//!
//! ```
//! use chta::{ballistics::TakeoffChoice, chain::{ConstrainedChain, PolygonalChain}, graph::{search, Outcome, PointSpacing, SearchOptions}, hop::{HopTest, Split}, path::{execute, generate}, quantity::MapPoint, terrain::{slice, synthesise, SyntheticTerrain}, world::{Body, FrictionCone, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties}};
//!
//! // Terrain: a DEM (here synthetic, from a seed; `terrain::read_dem` reads one), cut along a vertical plane.
//! let dem = synthesise(&SyntheticTerrain { rows: 60, cols: 120, ..SyntheticTerrain::default() })?;
//! let profile = slice(&dem, MapPoint::new(10.0, 30.0), MapPoint::new(110.0, 32.0))?;
//!
//! // Chain: what the ground allows this hopper under this gravity, segment by segment and in both directions.
//! let moon = Body::named("moon").ok_or("no moon")?;
//! let hopper = Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(8.0, 8.0) })?;
//! let friction = FrictionCone::new(0.6)?;
//! let surface = SurfaceProperties { grip: Some(Grip::Friction(friction)), rest: RestSlope::AsFrictionHolds };
//! let chain = ConstrainedChain::new(PolygonalChain::from_profile(&profile, Some(friction))?, &hopper, moon.gravity, &surface)?;
//!
//! // Hop test: the feasible take-off angles of one pair, limit by limit.
//! let test = HopTest::new(chain);
//! let chain = test.chain();
//! let (first_m, last_m) = chain.geometry().extent_m();
//! let (start, goal) = (chain.geometry().station(first_m)?, chain.geometry().station(last_m)?);
//! let set = test.takeoff_set(&start, &goal).ok_or("the same point")?;
//! assert!(set.angles().is_none(), "100 m is too far for one hop");
//! println!("{}", set.conflict().ok_or("no conflict")?);
//!
//! // Graph and search: fewest hops, then least effort.
//! let options = SearchOptions { spacing: Some(PointSpacing::AtMostM(1.0)), ..SearchOptions::default() };
//! let answer = search(&test, start, goal, &options, &())?;
//! let Outcome::Path { legs, .. } = answer.outcome else { panic!("no path over these nodes") };
//!
//! // Path: the command of every hop, and an independent checker that flies the path again.
//! let path = generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::FullReach)?;
//! assert!(path.hops.len() >= 3);
//! assert!(execute(chain, &path, Some((start, goal))).passes());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The ladder
//!
//! A module uses only those above it; `tests/library/layers.rs` reads the sources and enforces this.
//!
//! ```text
//! progress     how far long work is, and whether it goes on
//! quantity     angles, slopes, points, ids, sign-safe roots
//! world        bodies, the hopper or the robot with legs, friction cones, directions of travel
//! robot_model  joints of legs from a URDF, forward and inverse kinematics
//! ballistics   the equations of one arc: every limit as an interval of its take-off slope
//! arena        a flat floor with boxes, a wheeled robot that jumps, three planners
//! terrain      elevation rasters with their overlays, slices of them, synthetic terrain from a seed
//! chain        the polygonal chain and what each segment allows
//! hop          the hop test: feasible take-off slopes between two stations of a chain, many hops on a segment
//! ground       chains and DEMs under the same traits: raw facts, feasible windows between two contacts, first contact of an arc
//! drive        straight legs of a rover over a DEM, and maps of where it drives
//! flight       one hop flown under drawn errors
//! graph        nodes, hops as edges, the search
//! planner      paths by any objective, within budgets, along a chain; over a DEM in any direction, over nodes finer than posts
//! path         the hops to fly, and `execute`, which flies them again without those equations
//! uncertainty  how reliably a path is flown: policies, trials, statistics
//! reach        hop counts from one position of a map: along slices in all directions, and over all posts of a DEM
//! report       results as plain data; text, JSON, CSV and GeoJSON are views of it
//! figure       pictures of answers
//! scenario     TOML, validated, and back
//! study        one function per question: from a scenario to its answer
//! ```
//!
//! # Conventions
//!
//! SI units; degrees at the edges only, where names end in `_deg`. Inside, a direction is its slope. Angles are elevations above
//! the direction of travel. "No" is an answer, not an error: a refusal names its limits. The equations are those of the paper that
//! introduced constrained hopping traversability analysis on nonuniform polygonal chains (IEEE Access; "P" or "the CHTA paper" in
//! the sources) and of Campana and Laumond, *Ballistic motion planning*, numbered as there.
//!
//! # Features
//!
//! `cli` (default): the command `chta`. `plot` (default): the SVG picture. Neither is needed by the analysis.

pub mod arena;
pub mod ballistics;
pub mod chain;
pub mod drive;
#[cfg(feature = "plot")]
pub mod figure;
mod flight;
pub mod graph;
pub mod ground;
pub mod hop;
pub mod path;
pub mod planner;
pub mod progress;
pub mod quantity;
pub mod reach;
pub mod report;
pub mod robot_model;
pub mod scenario;
pub mod study;
pub mod terrain;
pub mod uncertainty;
pub mod world;

// One generator for unit and integration tests.
#[cfg(test)]
#[path = "../tests/support/draw.rs"]
mod draw;
