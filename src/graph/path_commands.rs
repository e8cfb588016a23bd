//! The most reliable command of each hop of a path that is given.

use super::{Edge, Leg, ReliabilityOptions, SearchError, SearchOptions, judge::Judge};
use crate::hop::HopTest;

/// The same legs, each single hop with the command that the most draws of its errors survive, where `options` leave the command to that.
///
/// The draws are those of the search for reliable paths: the first hop takes off without scatter, each later one with that of the model.
/// Legs of many hops along a segment keep their commands, and the hop after them takes off without scatter.
///
/// # Errors
/// [`SearchError::Errors`].
pub(crate) fn with_reliable_commands(
    test: &HopTest,
    legs: &[Leg],
    options: &SearchOptions,
    reliability: &ReliabilityOptions,
) -> Result<Vec<Leg>, SearchError> {
    reliability.model.check()?;
    let judge = Judge::new(test, options, &reliability.model, reliability.goal_tolerance_m);
    let mut takeoff_m2 = [0.0; 2];
    let commanded = |(number, leg): (usize, &Leg)| {
        let Edge::Hop(lofts) = leg.edge else {
            takeoff_m2 = [0.0; 2];
            return *leg;
        };
        let is_last = number + 1 == legs.len();
        let judged = judge.single((&leg.takeoff, &leg.landing), lofts, takeoff_m2, is_last, f64::INFINITY);
        takeoff_m2 = judge.takeoff_m2(judged.spread_m2);
        Leg { loft: judged.loft.or(leg.loft), ..*leg }
    };
    Ok(legs.iter().enumerate().map(commanded).collect())
}
