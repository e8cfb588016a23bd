//! Pictures of several answers: the proof along a chain, trades of capabilities, and scenarios compared.

mod compare;
mod data;
mod hops;
mod of_bounds;
mod profile;
mod proof;
mod trade;

pub use compare::draw_compare;
pub use data::{
    CompareFigure, ComparedScenario, Flight, ProofClass, ProofFigure, ProofGap, ProofStretch, TradeAxis, TradeCell, TradeFigure,
};
pub use hops::{HopProfile, HopProfilesFigure, draw_hop_profiles};
pub use proof::draw_proof;
pub use trade::draw_trade;

#[cfg(test)]
#[expect(clippy::cast_precision_loss, clippy::cast_sign_loss, reason = "small counts")]
mod tests;
