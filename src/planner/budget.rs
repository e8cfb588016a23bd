//! How much a path may take.

use super::{Amount, Amounts, LayerTotals};

/// The greatest totals of a path, of any amounts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budgets {
    /// By amount; infinite: any.
    most: [f64; Amount::COUNT],
    /// Of layers with a budget.
    of_layers: LayerTotals,
}

/// A greatest total with the key that sets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TotalBudget {
    /// Of which amount.
    pub amount: Amount,
    /// The key, for messages; of a layer that in its table.
    pub key: &'static str,
    /// The greatest total, in the unit of the amount.
    pub most: f64,
}

impl TotalBudget {
    /// The whole key, with the table that it stands in.
    pub fn full_key(&self) -> String {
        match self.amount {
            Amount::Layer(layer) => format!("layer.{layer}.{}", self.key),
            _ => self.key.to_owned(),
        }
    }
}

/// A greatest total that is no amount.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the budget of {amount} is {found}, expected a number of at least 0")]
pub struct BudgetProblem {
    /// Of which amount.
    pub amount: Amount,
    /// What was given.
    pub found: f64,
}

/// A total above its budget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverBudget {
    /// Of which amount.
    pub amount: Amount,
    /// The total.
    pub total: f64,
    /// The budget.
    pub most: f64,
}

impl Default for Budgets {
    fn default() -> Self {
        Self::NONE
    }
}

impl Budgets {
    /// No budgets.
    pub const NONE: Self = Self { most: [f64::INFINITY; Amount::COUNT], of_layers: LayerTotals::NONE };

    /// A total may exceed its budget by this share, as a speed may exceed its limit: sums in another order differ by less.
    pub(super) const TOLERANCE: f64 = 1e-9;

    /// The same with a greatest total of one amount; the smaller one where it has one already.
    ///
    /// # Errors
    /// [`BudgetProblem`]: negative, or not a number.
    ///
    /// # Examples
    /// ```
    /// use chta::planner::{Amount, Amounts, Budgets};
    /// let budgets = Budgets::NONE.with(Amount::Hops, 3.0)?;
    /// assert_eq!(budgets.exceeded_by(&Amounts::NONE.with(Amount::Hops, 3.0)).count(), 0);
    /// assert_eq!(budgets.exceeded_by(&Amounts::NONE.with(Amount::Hops, 4.0)).count(), 1);
    /// # Ok::<(), chta::planner::BudgetProblem>(())
    /// ```
    pub fn with(mut self, amount: Amount, most: f64) -> Result<Self, BudgetProblem> {
        if most.is_nan() || most < 0.0 {
            return Err(BudgetProblem { amount, found: most });
        }
        let most = most.min(self.most(amount));
        match amount.place() {
            Ok(place) => self.most[place] = most,
            Err(layer) => self.of_layers = self.of_layers.with(layer, most),
        }
        Ok(self)
    }

    /// The greatest total of an amount; infinite without a budget.
    pub fn most(&self, amount: Amount) -> f64 {
        amount.place().map_or_else(|layer| self.of_layers.of(layer).unwrap_or(f64::INFINITY), |place| self.most[place])
    }

    /// The total from which on an amount is too much.
    pub(crate) fn allowed(&self, amount: Amount) -> f64 {
        self.most(amount) * (1.0 + Self::TOLERANCE)
    }

    /// The amounts with a budget, and their greatest totals.
    pub fn all(&self) -> impl Iterator<Item = (Amount, f64)> + '_ {
        let own = Amount::ALL.into_iter().map(|amount| (amount, self.most(amount)));
        let of_layers = self.of_layers.iter().map(|(layer, most)| (Amount::Layer(layer), most));
        own.chain(of_layers).filter(|(_, most)| most.is_finite())
    }

    /// Whether there is no budget.
    pub fn are_none(&self) -> bool {
        self.all().next().is_none()
    }

    /// The totals of a path that are above their budgets.
    pub fn exceeded_by<'a>(&'a self, totals: &'a Amounts) -> impl Iterator<Item = OverBudget> + 'a {
        self.all()
            .map(|(amount, most)| OverBudget { amount, total: totals.of(amount), most })
            .filter(|over| over.total > self.allowed(over.amount))
    }
}
