//! The options of the command that stands a robot with legs.

use std::path::PathBuf;

use chta::ground::StandsUp;
use clap::{Args as ClapArgs, ValueEnum};

use super::{CommonArgs, Format, Position, position};
use crate::cli::inputs::{DEFAULT_MAX_GIB, max_gib};

/// Where a robot with legs can stand, and which way it may jump from there without slipping
#[derive(Clone, Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta stance data/mesh/rubble.obj --at=0,0,1 --scenario data/mesh_scenarios/three_legs.toml")]
pub(crate) struct StanceArgs {
    /// Elevation raster, or mesh (OBJ, STL, PLY, z up), to stand on; absent with --contacts
    #[arg(value_name = "TERRAIN", required_unless_present = "contacts")]
    pub(crate) terrain: Option<PathBuf>,
    /// Robot (TOML): trunk, limbs, contacts needed [default: the scenario's robot.file]
    #[arg(long, value_name = "FILE", conflicts_with = "contacts")]
    pub(crate) robot: Option<PathBuf>,
    /// Place, m, moved to the surface: X,Y on a map, X,Y,Z on a mesh [default: none]
    #[arg(long, value_name = "X,Y[,Z]", value_parser = position, allow_hyphen_values = true, required_unless_present = "contacts")]
    pub(crate) at: Option<Position>,
    /// Which way the robot faces, degrees clockwise from +y [default: the stance with most feet and the widest beam, of 36 headings]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, conflicts_with = "contacts")]
    pub(crate) heading_deg: Option<f64>,
    /// How far its root is over the place, along its up axis, m [default: the best of eleven, from trunk on the ground to legs at full length]
    #[arg(long, value_name = "M", allow_negative_numbers = true, conflicts_with = "contacts")]
    pub(crate) height_m: Option<f64>,
    /// Which way is up for its trunk: along the normal of the ground, or against gravity [default: normal]
    #[arg(long, value_enum, conflicts_with = "contacts")]
    pub(crate) up: Option<UpArg>,
    /// Instead of a robot: contacts (CSV) with `normal_x,normal_y,normal_z,friction_coefficient`, one row each [default: none]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["terrain", "at"])]
    pub(crate) contacts: Option<PathBuf>,
    /// Headings of the rose
    #[arg(long, value_name = "N", default_value_t = 72, value_parser = clap::value_parser!(u32).range(4..=3600), allow_negative_numbers = true)]
    pub(crate) headings: u32,
    /// Picture (SVG or PNG) to write: the robot from the side and from above, its contacts and cone, and the rose
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// How the answer is written to standard output
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
    /// Scenario (TOML) with body, hopper and surface
    #[arg(long, value_name = "FILE")]
    pub(crate) scenario: Option<PathBuf>,
    /// Set any scenario key; overrides the scenario [example: `--set surface.friction_coefficient=0.6`]
    #[arg(long, value_name = "TABLE.KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Known body, which gives gravity and radius (`chta bodies` lists them)
    #[arg(long, value_name = "NAME")]
    pub(crate) body: Option<String>,
    /// Gravity, m/s^2
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    pub(crate) gravity_m_s2: Option<f64>,
    /// Stored number that marks missing elevations, or none: all numbers are elevations [default: as the file states]
    #[arg(long, value_name = "VALUE|none", allow_negative_numbers = true)]
    pub(crate) no_data: Option<String>,
    /// Most GiB read from a pipe, and from a text or mesh that is read whole
    #[arg(long, value_name = "GIB", default_value_t = DEFAULT_MAX_GIB, value_parser = max_gib, allow_negative_numbers = true)]
    pub(crate) input_max_gib: f64,
    /// No warnings on standard error
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Which way is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum UpArg {
    Normal,
    Vertical,
}

impl StanceArgs {
    /// The options that it shares with other commands.
    pub(crate) fn common(&self) -> CommonArgs {
        let Self { scenario, body, gravity_m_s2, no_data, .. } = self.clone();
        let common = CommonArgs::of_scenarios(&self.set, false, self.input_max_gib, self.quiet);
        CommonArgs { scenario, body, gravity_m_s2, no_data, ..common }
    }

    /// Which way is up.
    pub(crate) fn up(&self) -> StandsUp {
        match self.up {
            Some(UpArg::Vertical) => StandsUp::Vertical,
            Some(UpArg::Normal) | None => StandsUp::Normal,
        }
    }
}
