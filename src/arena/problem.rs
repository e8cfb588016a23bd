//! What is wrong with an arena, and what a planner does not plan.

/// One problem of an arena: the key, what was found and expected, and how to mend it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArenaProblem {
    /// The table of the key, such as `jumper`.
    pub table: &'static str,
    /// The number of the table from 0, where there are several: boxes.
    pub number: Option<usize>,
    /// The key.
    pub name: &'static str,
    /// What was found and what was expected.
    pub message: String,
    /// How to mend it.
    pub help: String,
}

/// Why a planner does not plan in an arena that is valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The start or the goal is between the nodes.
    #[error(
        "arena.{key} is {x_m}, {y_m}, between the nodes of the grid, which are {spacing_m} m apart: take {near_x_m}, {near_y_m}, a \
         grid.spacing_m that divides both coordinates, or a planner without nodes"
    )]
    BetweenNodes {
        /// The key.
        key: &'static str,
        /// Its x, m.
        x_m: f64,
        /// Its y, m.
        y_m: f64,
        /// The nearest node's x, m.
        near_x_m: f64,
        /// The nearest node's y, m.
        near_y_m: f64,
        /// The spacing of the nodes, m.
        spacing_m: f64,
    },
    /// A box is too thin for the grid to see it.
    #[error(
        "box {number} is {width_m} m wide with its inflation, expected at least two spacings of the grid ({least_m} m): moves between nodes \
         would pass through it: take a grid.spacing_m of at most {spacing_m}, or a planner without nodes"
    )]
    ThinBox {
        /// The number of the box, from 1.
        number: usize,
        /// Its smaller side, m.
        width_m: f64,
        /// The least, m.
        least_m: f64,
        /// The greatest spacing that sees it, m.
        spacing_m: f64,
    },
    /// The grid would have too many nodes.
    #[error("the grid would have {found} nodes, expected at most {most}: take a larger grid.spacing_m")]
    TooManyNodes {
        /// The nodes.
        found: f64,
        /// The most.
        most: usize,
    },
    /// A jump is no whole number of nodes.
    #[error(
        "grid.jump_length_m is {length_m}, expected a multiple of grid.spacing_m ({spacing_m}) of at least two spacings: the first node \
         past an edge is too close to it to land on"
    )]
    JumpOffNodes {
        /// The length, m.
        length_m: f64,
        /// The spacing, m.
        spacing_m: f64,
    },
    /// The planner has no exact answer for a jumper that weakens.
    #[error(
        "jumper.speed_factor_per_jump is {factor}, and any-angle planning takes 1 alone: where the speed differs on the two sides of a face the \
         shortest path bends there, and the corners of boxes do not hold it: plan over the grid or with RRT*"
    )]
    Weakens {
        /// The factor.
        factor: f64,
    },
    /// The planner has no exact answer for jumps that are flights.
    #[error(
        "[flight] gives every jump a length of its own, and any-angle planning jumps without one: plan over the grid or with RRT*, or remove \
         [flight]"
    )]
    Flies,
    /// Two keys that no planner takes together.
    #[error("jumper.speed_factor_per_jump is {factor} beside [flight]: no planner takes both together: leave one of them out")]
    FliesAndWeakens {
        /// The factor.
        factor: f64,
    },
    /// A start or goal that RRT* cannot stand on.
    #[error(
        "arena.{key} is closer than jumper.ring_m ({ring_m} m) to the face of a box, where RRT* does not stand: move it, or take a smaller \
         ring_m"
    )]
    WithinRing {
        /// The key.
        key: &'static str,
        /// The ring, m.
        ring_m: f64,
    },
}
