//! The options of the command that plans among boxes.

use std::path::PathBuf;

use chta::{
    arena::{Reading, RrtStarOptions},
    study::ArenaPlanner,
};
use clap::{Args as ClapArgs, ValueEnum};

use super::Format;
use crate::cli::{
    Failure,
    inputs::{DEFAULT_MAX_GIB, max_gib},
};

/// Plan for a wheeled robot that jumps, on a flat floor with boxes
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta arena data/arenas/sumo_2.toml --planner grid --plot sumo_2.svg")]
pub(crate) struct ArenaArgs {
    /// Arena (TOML): floor, boxes, robot; -: standard input
    #[arg(value_name = "ARENA")]
    pub(crate) arena: PathBuf,
    /// any-angle: the exact optimum over the boxes as drawn; grid: A* over nodes; rrt-star: RRT*
    #[arg(long, value_enum, default_value = "any-angle")]
    pub(crate) planner: PlannerArg,
    /// How the grid prices jumps and drops: R1, a jump takes its time alone, or R0, its length as well [default: R1]
    #[arg(long, value_enum)]
    pub(crate) reading: Option<ReadingArg>,
    /// Without jumps
    #[arg(long)]
    pub(crate) no_jump: bool,
    /// All planners over the same boxes in a table, with jumps and without
    #[arg(long)]
    pub(crate) compare: bool,
    /// Seed of RRT* and of random boxes [default: 1]
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,
    /// Nodes of RRT* [default: 3000]
    #[arg(long, value_parser = clap::value_parser!(u64).range(2..=1_000_000), allow_negative_numbers = true)]
    pub(crate) nodes: Option<u64>,
    /// So many random boxes in place of those of the arena [default: none]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(0..=300), allow_negative_numbers = true)]
    pub(crate) random: Option<u64>,
    /// Sides of random boxes, m [default: 1,3,6]
    #[arg(long, value_name = "M,...", value_delimiter = ',', requires = "random", allow_negative_numbers = true)]
    pub(crate) random_sizes_m: Vec<f64>,
    /// Set a key of the arena; overrides the file [example: `--set jumper.rise_max_m=0.5`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Arena (TOML) to write as used, with random boxes and set keys
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Picture (SVG or PNG) to write: the path with jumps and without
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// How the answer is written to standard output
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    /// Most GiB read from a pipe
    #[arg(long, value_name = "GIB", default_value_t = DEFAULT_MAX_GIB, value_parser = max_gib, allow_negative_numbers = true)]
    pub(crate) input_max_gib: f64,
    /// No warnings and no run time on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// A planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum PlannerArg {
    Grid,
    AnyAngle,
    RrtStar,
}

/// A reading of the paper's prices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReadingArg {
    #[value(name = "R1")]
    R1,
    #[value(name = "R0")]
    R0,
}

impl ArenaArgs {
    /// The planner with its options.
    pub(crate) fn planner(&self) -> Result<ArenaPlanner, Failure> {
        let is = |planner| self.planner == planner;
        let grows = is(PlannerArg::RrtStar) || self.compare;
        let of_others = [
            ("--reading", self.reading.is_some() && !is(PlannerArg::Grid), "prices the jumps of the grid: give --planner grid"),
            ("--nodes", self.nodes.is_some() && !grows, "counts the nodes of RRT*: give --planner rrt-star or --compare"),
            (
                "--seed",
                self.seed.is_some() && !grows && self.random.is_none(),
                "is of RRT* and of random boxes: give --planner rrt-star, --compare or --random",
            ),
        ];
        if let Some((option, _, why)) = of_others.into_iter().find(|(_, is_given, _)| *is_given) {
            return Err(Failure::message(format!("{option} {why}, or leave it out")));
        }
        Ok(match self.planner {
            PlannerArg::Grid => ArenaPlanner::Grid(match self.reading {
                Some(ReadingArg::R0) => Reading::R0,
                Some(ReadingArg::R1) | None => Reading::R1,
            }),
            PlannerArg::AnyAngle => ArenaPlanner::AnyAngle,
            PlannerArg::RrtStar => ArenaPlanner::RrtStar(self.rrt_star()),
        })
    }

    /// The options of RRT*.
    pub(crate) fn rrt_star(&self) -> RrtStarOptions {
        let usual = RrtStarOptions::default();
        let nodes = self.nodes.and_then(|nodes| usize::try_from(nodes).ok()).unwrap_or(usual.nodes);
        RrtStarOptions { nodes, seed: self.seed.unwrap_or(usual.seed), ..usual }
    }
}
