//! What is to be least.

use super::Amount;
use crate::graph::Effort;

/// An ordered list of amounts: the first is least, the second breaks its ties, and so on. Ties are equal doubles of sums from the start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Objective(Vec<Amount>);

/// Why a list of amounts is no objective.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ObjectiveProblem {
    /// An empty list.
    #[error("the objective is empty, expected at least one of {}", Amount::all_names())]
    Empty,
    /// More amounts than are compared.
    #[error(
        "the objective has {found} amounts, expected at most {}: the last ones would only break ties of all before",
        Objective::MOST
    )]
    TooMany {
        /// How many.
        found: usize,
    },
    /// An amount that is given twice.
    #[error("the objective has {0} twice, expected each amount once: the second has no effect")]
    Twice(Amount),
    /// An amount that does not add up, before another one.
    #[error("the objective has {0} before another amount, expected it last: it is the greatest of all hops and does not add up")]
    NotLast(Amount),
}

impl Objective {
    /// The most amounts of an objective.
    pub const MOST: usize = 4;

    /// An objective.
    ///
    /// # Errors
    /// [`ObjectiveProblem`].
    ///
    /// # Examples
    /// ```
    /// use chta::planner::{Amount, Objective, ObjectiveProblem};
    /// assert!(Objective::new(vec![Amount::Hops, Amount::PeakSpeed]).is_ok());
    /// let wrong = Objective::new(vec![Amount::PeakSpeed, Amount::Hops]);
    /// assert_eq!(wrong, Err(ObjectiveProblem::NotLast(Amount::PeakSpeed)));
    /// ```
    pub fn new(amounts: Vec<Amount>) -> Result<Self, ObjectiveProblem> {
        if amounts.is_empty() {
            return Err(ObjectiveProblem::Empty);
        }
        if let Some((_, twice)) = amounts.iter().enumerate().find(|(i, amount)| amounts[..*i].contains(amount)) {
            return Err(ObjectiveProblem::Twice(*twice));
        }
        let before_last = &amounts[..amounts.len() - 1];
        if let Some(early) = before_last.iter().find(|amount| !amount.adds_up()) {
            return Err(ObjectiveProblem::NotLast(*early));
        }
        if amounts.len() > Self::MOST {
            return Err(ObjectiveProblem::TooMany { found: amounts.len() });
        }
        Ok(Self(amounts))
    }

    /// One amount alone.
    pub fn of(amount: Amount) -> Self {
        Self(vec![amount])
    }

    /// The number of hops, then an effort.
    pub fn hops_then(effort: Effort) -> Self {
        let amount = match effort {
            Effort::TakeoffSpeed => Amount::TakeoffSpeed,
            Effort::Energy => Amount::Energy,
            Effort::Time => Amount::FlightTime,
            Effort::PeakSpeed => Amount::PeakSpeed,
        };
        Self(vec![Amount::Hops, amount])
    }

    /// The amounts, the first first: at least one, each once.
    pub fn amounts(&self) -> &[Amount] {
        &self.0
    }

    /// The first amount.
    pub fn first(&self) -> Amount {
        // A list that is not empty.
        self.0.first().copied().unwrap_or(Amount::Hops)
    }
}

impl std::fmt::Display for Objective {
    /// The names with commas: `hops, energy`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, amount) in self.0.iter().enumerate() {
            write!(f, "{}{amount}", if i == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_lists_that_can_be_searched_are_built() {
        use Amount::{DeltaV, Distance, Energy, FlightTime, Hops, PeakSpeed};
        let rows: [(&[Amount], Option<ObjectiveProblem>); 8] = [
            (&[], Some(ObjectiveProblem::Empty)),
            (&[Hops], None),
            (&[PeakSpeed], None),
            (&[Hops, Energy, PeakSpeed], None),
            (&[Hops, Energy, Hops], Some(ObjectiveProblem::Twice(Hops))),
            (&[PeakSpeed, Energy], Some(ObjectiveProblem::NotLast(PeakSpeed))),
            (&[Hops, Energy, DeltaV, Distance], None),
            (&[Hops, Energy, DeltaV, Distance, FlightTime], Some(ObjectiveProblem::TooMany { found: 5 })),
        ];
        for (amounts, problem) in rows {
            assert_eq!(Objective::new(amounts.to_vec()).err(), problem, "{amounts:?}");
        }
    }
}
