//! Constrained hopping traversability analysis.

pub mod quantity;
pub mod terrain;
pub mod world;
