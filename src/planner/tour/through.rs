//! Legs between stops that are outside of a layer, where a stretch outside goes on from one leg to the next.
//!
//! The best legs, each by itself, make the best mission if their stretches join; no mission takes less. Else such legs need more ways, with less
//! outside at their ends for more by the objective: of those only what a mission may take that is better than a known one. Where none is known
//! yet, missions may take a little more than the least, then more, and in the end whatever they do.

use super::{
    super::RouteQuestion,
    TourQuestion,
    allowance::OtherLegs,
    legs::{Fields, LegQuestion, Legs, StopLegs},
    table::{VisitRules, most_visits},
    within::{Allowance, Bounds, of_leg},
};
use crate::{planner::Budgets, progress::Cancelled};

/// By how much a mission may exceed the least total of the first amount, while none over as many targets is known.
const MORE: [f64; 3] = [1.02, 1.1, 1.3];

/// Adds ways to the best legs until the best mission under outages is one over them.
///
/// # Returns
/// Whether the legs have all ways that any mission may need, whatever budgets it keeps.
pub(super) fn join_through_outages(
    stops: &StopLegs<'_>,
    question: &TourQuestion<'_>,
    fields: &Fields,
    rules: VisitRules,
    legs: &mut Legs,
) -> Result<bool, Cancelled> {
    let RouteQuestion { objective, cap, .. } = question.route;
    if !stops.have_stops_outside() {
        return Ok(true);
    }
    let (unbound, _) = most_visits(&legs.costs().apart(), rules, (objective, &Budgets::NONE, cap))?;
    let (first, visited_max) = (objective.first(), unbound.set().count_ones());
    let least = unbound.totals.of(first);
    let outside = |pair: [usize; 2]| stops.goes_on_outside(pair);
    let mut searched = 0.0;
    let mut more = MORE.into_iter();
    loop {
        let (known, _) = most_visits(&legs.costs(), rules, (objective, &Budgets::NONE, cap))?;
        let bounds = Bounds { known: &known, unbound: &unbound, visited_max };
        if visited_max == 0 || bounds.prove(objective) || (bounds.is_largest() && known.totals.of(first) <= searched) {
            return Ok(false);
        }
        let is_known = bounds.is_largest();
        let allowances = if is_known {
            bounds.allowances(legs, rules, stops.targets(), (objective, &Budgets::NONE))
        } else if let Some(factor) = more.next() {
            let total = least * factor;
            searched = total;
            let others = first.adds_up().then(|| OtherLegs::of(&legs.least(first), stops.targets(), rules, visited_max));
            vec![Allowance { amount: first, total, others, is_compared: false }]
        } else {
            legs.join(stops.legs(question, fields, |pair| outside(pair).then(|| LegQuestion::best(objective).by_outages()))?);
            return Ok(true);
        };
        legs.join(stops.legs(question, fields, |pair| of_leg(&allowances, pair, objective).filter(|_| outside(pair)))?);
        if is_known {
            return Ok(false);
        }
    }
}
