//! The mathematics of a stance: several contacts at once, for robots that push off with feet.
//!
//! ```text
//!          K1 \   | v  /  K2           K_i = {f : f.n_i >= |f| cos phi_i}     the forces that contact i can bear without sliding
//!        __    \  |   /   __           K   = K_1 + ... + K_h                  the sum of one force of each
//!          n_1  \ |  / n_2
//!     ______/\___\|_/_/\______         take-off velocity v in K, landing velocity v with -v in K
//! ```
//!
//! For the planner a stance is what a point contact is: for any heading, one interval of take-off slopes and one of landing slopes.
//! [`ConeSum`] has them in closed form for any number of contacts, each with its own friction. [`ConeKind`] has the narrower cones that
//! stand for the sum in the literature, so that a planner can be run with any of them.
//!
//! Source: Campana, Fernbach, Tonneau, Taix and Laumond 2016, *Ballistic motion planning for jumping superheroes* ("S"), section 3.
//! It leaves the exact sum to future work.

mod cone_kind;
mod cone_sum;
mod contact_cone;
mod foothold;
mod force;
mod plane_cut;
mod spin;
mod stroke;
mod wrench;

pub use cone_kind::{ConeKind, PyramidEdges};
pub use cone_sum::ConeSum;
pub use contact_cone::{ContactCone, InvalidContactCone};
pub use foothold::{Bounds, Foothold};
pub use force::{InvalidForce, Limb, greatest_force_n};
pub use plane_cut::PlaneCut;
pub use spin::{forces_of_least_spin, holds_upright, least_spin_m2_s, spin_free_cut};
pub use stroke::{greatest_push_speed_m_s, push_force_n, push_slope};
