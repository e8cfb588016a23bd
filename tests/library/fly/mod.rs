//! The simulation against independent methods: the plan itself, the checker, analytic distributions, dense simulation.

#![allow(clippy::unwrap_used, reason = "a test that cannot set its scene should stop")]
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small counts and indices"
)]

mod contact;
mod lasting;
mod outcomes;
pub(crate) mod plans;
mod scene;
mod tallies;
mod terrains;
