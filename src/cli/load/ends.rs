//! The options for start and goal.

use chta::study::JourneyEnd as End;

use crate::cli::Failure;

/// The options for start and goal. Commands name them differently; some have none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EndOptions {
    names: Option<[&'static str; 2]>,
    pub(super) x_m: [Option<f64>; 2],
}

impl EndOptions {
    /// A command without such options.
    pub(crate) const NONE: Self = Self { names: None, x_m: [None, None] };

    /// The ends of one hop.
    pub(crate) const fn of_hop(from: Option<f64>, to: Option<f64>) -> Self {
        Self { names: Some(["--from", "--to"]), x_m: [from, to] }
    }

    /// The ends of a path.
    pub(crate) const fn of_path(start: Option<f64>, goal: Option<f64>) -> Self {
        Self { names: Some(["--start", "--goal"]), x_m: [start, goal] }
    }

    /// The source of an end's value.
    pub(super) fn place(&self, end: End) -> String {
        match (self.names, self.x_m[end as usize]) {
            (Some(names), Some(_)) => names[end as usize].to_owned(),
            _ => format!("terrain.{}_x_m", end.name()),
        }
    }

    /// The failure for an end that is given nowhere.
    pub(super) fn missing(&self, end: End) -> Failure {
        let name = end.name();
        Failure::message(match self.names {
            Some(names) => format!(
                "found no {name}: give {} X along the chain, or [terrain] {name}_x_m (for a dem or mesh {name}_m) in the scenario",
                names[end as usize]
            ),
            None => {
                format!("found no {name}: add {name}_x_m = X (for a dem or mesh {name}_m = [x, y]) to the scenario's [terrain]")
            }
        })
    }
}
