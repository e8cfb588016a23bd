//! The simulation against independent roads: the plan itself, the checker, analytic distributions, dense simulation.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its scene should stop")]

mod plans;
mod scene;
