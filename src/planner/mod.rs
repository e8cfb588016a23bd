//! Search for paths of legs by any objective, within budgets: over a chain, and over any ground that gives its nodes successors.
//!
//! [`search`] and [`front`] work on a [`LegGraph`]: nodes are numbers, edges are visited and never stored, and each edge offers its
//! distinct commands. [`ChainLegs`] is the graph of a chain.

mod amount;
mod bounds;
mod budget;
mod chain_legs;
mod front;
mod labels;
mod objective;
mod search;

pub use amount::{Amount, Amounts};
pub use bounds::LeastAmounts;
pub use budget::{BudgetProblem, Budgets, OverBudget, TotalBudget};
pub use chain_legs::{
    ChainLegs, ChainPath, ChainQuestion, ChainSearched, SearchedCommands, UnmetBudget, front_on_chain, search_on_chain,
};
pub use front::front;
pub use objective::{Objective, ObjectiveProblem};
pub use search::{FoundPath, LabelCap, LegGraph, PathStep, SearchResult, Successor, search};

#[cfg(test)]
mod tests;
