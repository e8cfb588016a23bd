//! The best mission within budgets on other amounts than the first of its objective.
//!
//! The best legs by the objective, whatever else they take, make a mission that no other one is better than; if it keeps the budgets, it is the
//! answer. Else the legs that take the least of each budgeted amount say how many targets can be visited, and with the best legs what may be
//! left to each leg. Only then legs have Pareto sets, of what is left to them.

use super::{
    super::{Amount, Budgets, LabelCap, Objective, RouteQuestion},
    TourQuestion,
    allowance::OtherLegs,
    legs::{Fields, LegQuestion, Legs, StopLegs},
    table::{LegCosts, VisitRules, Visits, most_visits},
    through::join_through_outages,
};
use crate::progress::Cancelled;

/// A mission, and the legs of which it is made.
pub(super) struct WithinBudgets {
    pub(super) visits: Visits,
    /// The legs, whose ways the visits number.
    pub(super) legs: Legs,
    /// What the best legs by the objective take, whatever the budgets.
    pub(super) best: LegCosts,
    /// Whether labels were left out.
    pub(super) capped: bool,
}

/// The best mission within the budgets of a question.
pub(super) fn best_within(stops: &StopLegs<'_>, question: &TourQuestion<'_>, fields: &Fields) -> Result<WithinBudgets, Cancelled> {
    let RouteQuestion { objective, budgets, cap, .. } = question.route;
    let rules = VisitRules { order: question.order, returns: question.returns, allowed: u16::MAX };
    let mut legs = stops.legs(question, fields, |_| Some(LegQuestion::best(objective)))?;
    let has_all_ways = join_through_outages(stops, question, fields, rules, &mut legs)?;
    let mut best = legs.costs();
    let others: Vec<(Amount, f64)> = budgets.all().filter(|(amount, _)| *amount != objective.first()).collect();
    let (mut unbound, mut capped) = most_visits(&best, rules, (objective, &Budgets::NONE, cap))?;
    if budgets.exceeded_by(&unbound.totals).next().is_none() {
        capped |= legs.capped;
        return Ok(WithinBudgets { visits: unbound, legs, best, capped });
    }
    if !has_all_ways {
        let of_leg = |pair| stops.goes_on_outside(pair).then(|| LegQuestion::best(objective).by_outages());
        legs.join(stops.legs(question, fields, of_leg)?);
        best = legs.costs();
        (unbound, _) = most_visits(&best, rules, (objective, &Budgets::NONE, cap))?;
    }
    let mut visited_max = visited_within(&best, rules, (objective.first(), budgets.most(objective.first())))?;
    for (amount, most) in &others {
        let alone = Objective::of(*amount);
        let least = stops.legs(question, fields, |_| Some(LegQuestion::best(&alone)))?;
        visited_max = visited_max.min(visited_within(&least.costs().apart(), rules, (*amount, *most))?);
        legs.join(least);
    }
    let (known, _) = most_visits(&legs.costs(), rules, (objective, budgets, cap))?;
    let bounds = Bounds { known: &known, unbound: &unbound, visited_max };
    if !others.is_empty() && visited_max > 0 && !bounds.prove(objective) {
        let allowances = bounds.allowances(&legs, rules, stops.targets(), (objective, budgets));
        legs.join(stops.legs(question, fields, |pair| of_leg(&allowances, pair, objective))?);
    }
    let (visits, is_table_capped) = most_visits(&legs.costs(), rules, (objective, budgets, cap))?;
    capped |= is_table_capped || legs.capped;
    Ok(WithinBudgets { visits, legs, best, capped })
}

/// How many targets can be visited, if legs take no less of an amount than these, within a total of it.
fn visited_within(costs: &LegCosts, rules: VisitRules, (amount, most): (Amount, f64)) -> Result<u32, Cancelled> {
    let budget = Budgets::NONE.with(amount, most).unwrap_or(Budgets::NONE);
    let (visits, _) = most_visits(costs, rules, (&Objective::of(amount), &budget, LabelCap::NONE))?;
    Ok(visits.set().count_ones())
}

/// What is known before legs have Pareto sets.
pub(super) struct Bounds<'v> {
    /// A mission within the budgets.
    pub(super) known: &'v Visits,
    /// The best one without budgets.
    pub(super) unbound: &'v Visits,
    /// No more targets can be visited.
    pub(super) visited_max: u32,
}

impl Bounds<'_> {
    /// Whether the known mission visits as many targets as any can.
    pub(super) fn is_largest(&self) -> bool {
        self.known.set().count_ones() == self.visited_max
    }

    /// Whether the known mission takes no more of an amount than the best one without budgets, of as many targets.
    fn is_least(&self, amount: Amount) -> bool {
        let is_alike = self.unbound.set().count_ones() == self.visited_max;
        self.is_largest() && is_alike && self.known.totals.of(amount) <= self.unbound.totals.of(amount)
    }

    /// Whether no mission within the budgets is better than the known one.
    pub(super) fn prove(&self, objective: &Objective) -> bool {
        objective.amounts().iter().all(|amount| self.is_least(*amount))
    }

    /// What is left to each leg of the missions that may be better than the known one.
    pub(super) fn allowances(
        &self,
        legs: &Legs,
        rules: VisitRules,
        targets: usize,
        (objective, budgets): (&Objective, &Budgets),
    ) -> Vec<Allowance> {
        let visited_min = self.known.set().count_ones();
        let of = |amount: Amount, total: f64, is_compared: bool| {
            let others = amount.adds_up().then(|| OtherLegs::of(&legs.least(amount), targets, rules, visited_min));
            Allowance { amount, total, others, is_compared }
        };
        let mut all: Vec<Allowance> = budgets.all().map(|(amount, most)| of(amount, most, amount != objective.first())).collect();
        for amount in objective.amounts().iter().copied().filter(|_| self.is_largest()) {
            all.push(of(amount, self.known.totals.of(amount), false));
            // A mission of the fewest hops has legs of the fewest hops, of which the best have the least of what counts next. Other sums round.
            if amount != Amount::Hops || !self.is_least(amount) {
                break;
            }
        }
        all
    }
}

/// What is left of a total of an amount to each leg.
pub(super) struct Allowance {
    pub(super) amount: Amount,
    pub(super) total: f64,
    /// What the other legs take at least; `None` of an amount that does not add up, of which every leg may have the total.
    pub(super) others: Option<OtherLegs>,
    /// Whether ways are compared by the amount, beside the objective.
    pub(super) is_compared: bool,
}

/// What the ways of a leg are searched for; `None` if no mission that may be better has the leg.
pub(super) fn of_leg<'q>(allowances: &[Allowance], pair: [usize; 2], objective: &'q Objective) -> Option<LegQuestion<'q>> {
    let mut asked = LegQuestion::best(objective).by_outages();
    for Allowance { amount, total, others, is_compared } in allowances {
        let most = others.as_ref().map_or(Some(*total), |others| others.allowance(pair, *total))?;
        if *is_compared {
            asked.budgets = asked.budgets.with(*amount, most).ok()?;
        } else {
            asked.at_most.push((*amount, most));
        }
    }
    Some(asked)
}
