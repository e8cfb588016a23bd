//! The search over a surface, in any direction: where a robot may stand, and which hops join these places.
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

mod free_route;
mod lattice;
mod nodes;

pub use free_route::{FreeRoute, RouteError, RouteGoal, free_route};
pub use lattice::{NODES_PER_POST_MOST, NodesPerPost, SurfaceLattice};
pub use nodes::{SurfaceNode, SurfaceNodes, TooManyNodes};
