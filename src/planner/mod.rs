//! The search for paths of legs: along a chain by any objective and within budgets, and over a DEM in any direction.
//!
//! [`search`] and [`front`] work on a [`LegGraph`]: nodes are numbers, edges are visited and never stored, and each edge offers its
//! distinct commands. [`ChainLegs`] is the graph of a chain, [`SurfaceLegs`] that of a DEM, over whose nodes [`free_route`] and [`free_route_by`] search:
//!
//! ```text
//!   o . . . o . . . o      o  posts of the DEM          .  lattice of n nodes a post spacing (here 4)
//!   . . . . . . . . .      S, G  start and goal, where they were asked for: never moved to a post
//!   . S---*---*-*---*-G    *  nodes of the straight slice from S to G, its crossings with the DEM's lines among them
//!   o . . . o . . . o
//! ```
//!
//! The ground is the triangulated DEM whatever the lattice: nodes say where one may stand. Each edge is the hop that a slice between the
//! two nodes and the hop test along it find ([`HopTest`](crate::hop::HopTest)).

mod amount;
mod beside;
mod bounds;
mod budget;
mod by_layers;
mod chain_legs;
mod fewest_hops;
mod free_route;
mod front;
mod labels;
mod lattice;
mod layer_totals;
mod nearest_steps;
mod nodes;
mod objective;
mod outage;
mod pair_memo;
pub mod roadmap;
mod route_gap;
mod search;
mod stances;
mod surface_hops;
mod surface_legs;
mod table_hops;
mod tour;
mod travel;
mod walking_stances;

pub use amount::{Amount, Amounts};
pub use bounds::LeastAmounts;
pub use budget::{BudgetProblem, Budgets, OverBudget, TotalBudget};
pub use chain_legs::{ChainLegs, ChainPath, ChainQuestion, ChainSearched, SearchedCommands, front_on_chain, search_on_chain};
pub use free_route::{
    FreeRoute, RouteError, RouteFront, RouteGoal, RoutePath, RouteQuestion, RouteWork, free_route, free_route_by, front_of_routes,
};
pub use front::front;
pub use lattice::{NODES_PER_POST_MOST, NodesPerPost, SurfaceLattice};
pub use layer_totals::LayerTotals;
pub use nodes::{SurfaceNode, SurfaceNodes, TooManyNodes};
pub use objective::{Objective, ObjectiveProblem};
pub use outage::{OutagePart, Stretch};
pub use route_gap::RouteGap;
pub use search::{FoundPath, LabelCap, LegGraph, LegVisitor, PathStep, SearchResult, Successor, UnmetBudget, search};
pub use stances::{RefusedStances, StanceSampler};
pub use surface_legs::SurfaceLegs;
pub use tour::{TARGETS_MAX, Tour, TourLeg, TourQuestion, TourWork, VisitOrder, WhyLeftOut, fewest_hops_of_visits, tour};
pub(crate) use travel::drive_amounts;
pub use travel::{
    Mission, MissionFront, MissionMove, MissionPath, MissionQuestion, MissionWork, Toward, Travel, TravelField, front_of_missions,
    travel, travel_field,
};
pub use walking_stances::WalkingStances;

#[cfg(test)]
mod layer_cost_tests;
#[cfg(test)]
mod outage_tests;
#[cfg(test)]
mod surface_tests;
#[cfg(test)]
mod tests;
