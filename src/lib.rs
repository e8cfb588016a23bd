//! Constrained hopping traversability analysis.

pub mod quantity;

pub mod ballistics;
pub mod chain;
pub mod graph;
pub mod path;
pub mod report;
pub mod terrain;
pub mod world;
