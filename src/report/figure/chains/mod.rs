//! Pictures of several answers: the proof along a chain, trades of capabilities, and scenarios compared.

mod data;

pub use data::{
    CompareFigure, ComparedScenario, Flight, ProofClass, ProofFigure, ProofGap, ProofStretch, TradeAxis, TradeField, TradeFigure,
};

use super::{FigureError, Picture, todo_picture};

/// Draws a chain by what is proved of it: reachable, proved unreachable, open.
///
/// # Errors
/// [`FigureError::NoGround`] where the ground has fewer than two points.
pub fn draw_proof(figure: &ProofFigure) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}

/// Draws the fewest hops over a grid of two capabilities, or over a row of one, each field with its number.
///
/// # Errors
/// [`FigureError::RasterSize`] where there is not one field for every pair of values.
pub fn draw_trade(figure: &TradeFigure) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}

/// Draws the paths of several scenarios over one another.
///
/// # Errors
/// [`FigureError::NoGround`] where there is no scenario, or one whose ground has fewer than two points.
pub fn draw_compare(figure: &CompareFigure) -> Result<Picture, FigureError> {
    todo_picture(&figure.caption)
}
