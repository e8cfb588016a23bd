//! How much a leg may take, if the mission around it is to keep a total.
//!
//! ```text
//!   least to (set, stop)  +  leg  +  least from (set with the next stop)  <=  total
//! ```
//!
//! With what every leg takes at least, the first and the last term are tables over all sets of targets; what they leave of the total is the
//! most that a leg may take in any mission that visits enough targets. No mission within the total has a leg that takes more.

use super::{VisitOrder, table::VisitRules};

/// For every leg the least that all other legs of a mission over enough targets take; infinite where no such mission has the leg.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OtherLegs {
    stops: usize,
    /// By stop of departure, then of arrival.
    least: Vec<f64>,
}

impl OtherLegs {
    /// From what every leg takes at least, by stop of departure and of arrival, infinite where no leg leads.
    ///
    /// # Arguments
    /// `visited_min`: how many targets a mission has to visit, at least one.
    ///
    /// # Complexity
    /// 2^n n states for n targets, and n legs out of each.
    pub(super) fn of(least: &dyn Fn([usize; 2]) -> f64, targets: usize, rules: VisitRules, visited_min: u32) -> Self {
        let stops = targets + 1;
        let sets = 1usize << targets;
        let state = |set: usize, stop: usize| set * stops + stop;
        let may_follow = |set: usize, from: usize, to: usize| {
            let is_new = set & bit(to) == 0 && usize::from(rules.allowed) & bit(to) != 0;
            is_new && (rules.order == VisitOrder::Best || to > from)
        };
        let ends_in = |set: usize| set.count_ones() >= visited_min.max(1);
        let mut until = vec![f64::INFINITY; sets * stops];
        until[state(0, 0)] = 0.0;
        for (set, from) in (0..sets).flat_map(|set| (0..stops).map(move |from| (set, from))) {
            let here = until[state(set, from)];
            for to in (1..stops).filter(|to| here.is_finite() && may_follow(set, from, *to)) {
                let next = &mut until[state(set | bit(to), to)];
                *next = next.min(here + least([from, to]));
            }
        }
        let mut after = vec![f64::INFINITY; sets * stops];
        for (set, from) in (0..sets).rev().flat_map(|set| (0..stops).map(move |from| (set, from))) {
            let ends = match (ends_in(set) && from > 0, rules.returns) {
                (true, true) => least([from, 0]),
                (true, false) => 0.0,
                (false, _) => f64::INFINITY,
            };
            let goes_on = (1..stops).filter(|to| may_follow(set, from, *to));
            let rest = goes_on.map(|to| least([from, to]) + after[state(set | bit(to), to)]);
            after[state(set, from)] = rest.fold(ends, f64::min);
        }
        let mut others = vec![f64::INFINITY; stops * stops];
        for (set, from) in (0..sets).flat_map(|set| (0..stops).map(move |from| (set, from))) {
            let here = until[state(set, from)];
            for to in (1..stops).filter(|to| may_follow(set, from, *to)) {
                let least = &mut others[from * stops + to];
                *least = least.min(here + after[state(set | bit(to), to)]);
            }
            if rules.returns && from > 0 && ends_in(set) {
                let least = &mut others[from * stops];
                *least = least.min(here);
            }
        }
        Self { stops, least: others }
    }

    /// What a leg may take of a total; `None` if no mission within the total has the leg.
    pub(super) fn allowance(&self, [from, to]: [usize; 2], total: f64) -> Option<f64> {
        /// Of the total: sums in another order differ by less.
        const ROUNDING: f64 = 1e-8;
        let others = self.least[from * self.stops + to];
        let left = total * (1.0 + ROUNDING) - others;
        (others.is_finite() && left >= 0.0).then_some(left)
    }
}

/// The bit of a target.
const fn bit(stop: usize) -> usize {
    1 << (stop - 1)
}
