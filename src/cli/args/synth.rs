//! The options of the command that generates terrain, and the terrain that they describe.

use std::path::PathBuf;

use chta::{
    quantity::{Angle, MapPoint},
    terrain::{Boulders, Craters, DepthLaw, FractalGround, Rille, SyntheticMesh, SyntheticTerrain},
};
use clap::{Args as ClapArgs, ValueEnum};

use super::map_point;

/// Generate terrain from a seed: fractal ground, craters, a rille, boulders; or a mesh with overhangs
///
/// The same options give the same bytes on every machine.
#[derive(Debug, ClapArgs)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
#[command(after_help = "Example:\n  chta synth --rows 200 --cols 200 --craters --crater-density-per-km2 2000 --seed 7 -o moon.tif")]
pub(crate) struct SynthArgs {
    /// Elevation raster to write: .tif (GeoTIFF) or .asc (ESRI ASCII grid); with --mesh .obj, .stl or .ply
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// A mesh in place of an elevation raster: a tunnel, a roof over the ground, or boulders [default: none]
    #[arg(
        long,
        value_enum,
        value_name = "SCENE",
        conflicts_with_all = [
            "rows", "cols", "spacing_m", "south_west_m", "mean_elevation_m", "tilt_deg", "tilt_towards_deg", "no_ground", "ground_hurst",
            "ground_rms_m", "ground_baseline_m", "craters", "rille", "boulders",
        ]
    )]
    pub(crate) mesh: Option<MeshArg>,
    /// Rows of posts
    #[arg(long, default_value_t = 257, allow_negative_numbers = true)]
    pub(crate) rows: usize,
    /// Columns of posts
    #[arg(long, default_value_t = 257, allow_negative_numbers = true)]
    pub(crate) cols: usize,
    /// Spacing of posts, m
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) spacing_m: f64,
    /// Map coordinates of the south-west post, m
    #[arg(long, value_name = "X,Y", value_parser = map_point, allow_hyphen_values = true, default_value = "0,0")]
    pub(crate) south_west_m: MapPoint,
    /// Elevation at the middle of the map, m
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) mean_elevation_m: f64,
    /// Slope of the plane under everything, degrees
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) tilt_deg: f64,
    /// Direction in which the plane rises, degrees clockwise from grid north
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) tilt_towards_deg: f64,
    /// Without fractal ground
    #[arg(long, conflicts_with_all = ["ground_hurst", "ground_rms_m", "ground_baseline_m"])]
    pub(crate) no_ground: bool,
    /// Hurst exponent of the ground: near 0 rough at all scales, near 1 smooth close by
    #[arg(long, default_value_t = 0.8, allow_negative_numbers = true)]
    pub(crate) ground_hurst: f64,
    /// Root mean square height difference at the baseline, m
    #[arg(long, default_value_t = 0.1, allow_negative_numbers = true)]
    pub(crate) ground_rms_m: f64,
    /// The baseline, m
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true)]
    pub(crate) ground_baseline_m: f64,
    /// With craters
    #[arg(long)]
    pub(crate) craters: bool,
    /// Smallest crater, m [default: 4, or the post spacing if that is greater]
    #[arg(long, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_diameter_min_m: Option<f64>,
    /// Largest crater, m [default: 60, or as the map and the smallest crater allow]
    #[arg(long, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_diameter_max_m: Option<f64>,
    /// Craters per square kilometre [default: 1500; fewer where the post spacing leaves out small ones]
    #[arg(long, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_density_per_km2: Option<f64>,
    /// Exponent of the cumulative counts: 3 young, 2 in equilibrium
    #[arg(long, default_value_t = 2.5, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_power_law_exponent: f64,
    /// Depth of fresh craters by diameter: moon (Pike 1977) or mars (Robbins and Hynek 2012)
    #[arg(long, value_enum, default_value = "moon", requires = "craters")]
    pub(crate) crater_depth_law: DepthLawArg,
    /// Degradation of craters, 0: all fresh; 1: some completely eroded
    #[arg(long, default_value_t = 0.8, requires = "craters", allow_negative_numbers = true)]
    pub(crate) crater_degradation_max: f64,
    /// With a sinuous rille from west to east
    #[arg(long)]
    pub(crate) rille: bool,
    /// Width of the rille between its upper edges, m [default: 80, or the post spacing if that is greater]
    #[arg(long, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_width_m: Option<f64>,
    /// Depth of the rille, m
    #[arg(long, default_value_t = 15.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_depth_m: f64,
    /// Slope of its walls, degrees
    #[arg(long, default_value_t = 28.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_wall_slope_deg: f64,
    /// Swing of its centre line, m
    #[arg(long, default_value_t = 30.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_meander_amplitude_m: f64,
    /// Length of its meanders, m
    #[arg(long, default_value_t = 300.0, requires = "rille", allow_negative_numbers = true)]
    pub(crate) rille_meander_length_m: f64,
    /// With boulders
    #[arg(long)]
    pub(crate) boulders: bool,
    /// Share of ground covered by rocks of any size: 0.05 sparse, 0.2 rough
    #[arg(long, default_value_t = 0.1, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) rock_abundance: f64,
    /// Smallest boulder, m [default: 1, or the post spacing if that is greater]
    #[arg(long, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_diameter_min_m: Option<f64>,
    /// Largest boulder, m [default: 4, or the smallest boulder if that is greater]
    #[arg(long, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_diameter_max_m: Option<f64>,
    /// Share of a boulder's radius below ground
    #[arg(long, default_value_t = 0.2, requires = "boulders", allow_negative_numbers = true)]
    pub(crate) boulder_burial: f64,
}

/// A scene of closed bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MeshArg {
    /// A tunnel that bends and climbs.
    Cave,
    /// A cliff whose roof reaches out over the ground.
    Overhang,
    /// Boulders on the ground and on one another.
    Rubble,
}

impl MeshArg {
    /// The scene.
    pub(crate) const fn scene(self) -> SyntheticMesh {
        match self {
            Self::Cave => SyntheticMesh::Cave,
            Self::Overhang => SyntheticMesh::Overhang,
            Self::Rubble => SyntheticMesh::Rubble,
        }
    }
}

/// Depth law of fresh craters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum DepthLawArg {
    /// Pike 1977.
    Moon,
    /// Robbins and Hynek 2012.
    Mars,
}

impl From<&SynthArgs> for SyntheticTerrain {
    /// The options as typed, all of them.
    fn from(args: &SynthArgs) -> Self {
        let SynthArgs {
            output: _,
            mesh: _,
            seed,
            rows,
            cols,
            spacing_m,
            south_west_m,
            mean_elevation_m,
            tilt_deg,
            tilt_towards_deg,
            no_ground,
            ground_hurst,
            ground_rms_m,
            ground_baseline_m,
            craters,
            crater_diameter_min_m: _,
            crater_diameter_max_m: _,
            crater_density_per_km2: _,
            crater_power_law_exponent,
            crater_depth_law,
            crater_degradation_max,
            rille,
            rille_width_m,
            rille_depth_m,
            rille_wall_slope_deg,
            rille_meander_amplitude_m,
            rille_meander_length_m,
            boulders,
            rock_abundance,
            boulder_diameter_min_m,
            boulder_diameter_max_m,
            boulder_burial,
        } = args;
        let crater_defaults = typed_craters(args);
        let boulder_diameters_m = typed_boulder_diameters_m(*spacing_m, *boulder_diameter_min_m, *boulder_diameter_max_m);
        Self {
            rows: *rows,
            cols: *cols,
            spacing_m: *spacing_m,
            south_west: *south_west_m,
            mean_elevation_m: *mean_elevation_m,
            tilt: Angle::from_degrees(*tilt_deg),
            tilt_towards: Angle::from_degrees(*tilt_towards_deg),
            seed: *seed,
            ground: (!no_ground).then_some(FractalGround {
                hurst_exponent: *ground_hurst,
                rms_deviation_m: *ground_rms_m,
                baseline_m: *ground_baseline_m,
            }),
            craters: craters.then_some(Craters {
                diameter_min_m: crater_defaults.diameter_min_m,
                diameter_max_m: crater_defaults.diameter_max_m,
                density_per_km2: crater_defaults.density_per_km2,
                power_law_exponent: *crater_power_law_exponent,
                depth_law: match crater_depth_law {
                    DepthLawArg::Moon => DepthLaw::Moon,
                    DepthLawArg::Mars => DepthLaw::Mars,
                },
                degradation_max: *crater_degradation_max,
            }),
            rille: rille.then_some(Rille {
                width_m: rille_width_m.unwrap_or_else(|| Rille::default().width_m.max(*spacing_m)),
                depth_m: *rille_depth_m,
                wall_slope: Angle::from_degrees(*rille_wall_slope_deg),
                meander_amplitude_m: *rille_meander_amplitude_m,
                meander_length_m: *rille_meander_length_m,
            }),
            boulders: boulders.then_some(Boulders {
                rock_abundance: *rock_abundance,
                diameter_min_m: boulder_diameters_m[0],
                diameter_max_m: boulder_diameters_m[1],
                burial: *boulder_burial,
            }),
        }
    }
}

/// Diameters and density of the craters: those typed, and defaults that fit them, the post spacing and the map, so that no default is
/// refused. A greater smallest diameter is that of the same population, by its power law.
fn typed_craters(args: &SynthArgs) -> Craters {
    let usual = Craters::default();
    let longest_side = args.rows.max(args.cols).saturating_sub(1);
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    let side_m = longest_side as f64 * args.spacing_m;
    let most_m = args.crater_diameter_max_m.unwrap_or(f64::INFINITY);
    let least_m = usual.diameter_min_m.max(args.spacing_m);
    let diameter_min_m = args.crater_diameter_min_m.unwrap_or_else(|| usual.diameter_min_m.min(most_m).max(args.spacing_m));
    let diameter_max_m = args.crater_diameter_max_m.unwrap_or_else(|| {
        let usual_span = usual.diameter_max_m / usual.diameter_min_m;
        usual.diameter_max_m.max(usual_span * diameter_min_m).min(10.0 * side_m).max(diameter_min_m)
    });
    let density_per_km2 = args.crater_density_per_km2.unwrap_or_else(|| {
        let raised = args.crater_diameter_min_m.is_none() && least_m > usual.diameter_min_m;
        let share = if raised { libm::pow(usual.diameter_min_m / least_m, args.crater_power_law_exponent) } else { 1.0 };
        usual.density_per_km2 * share
    });
    Craters { diameter_min_m, diameter_max_m, density_per_km2, ..usual }
}

/// Smallest and largest boulder, m: those typed, and defaults that fit them and the post spacing.
fn typed_boulder_diameters_m(spacing_m: f64, least_m: Option<f64>, most_m: Option<f64>) -> [f64; 2] {
    let usual = Boulders::default();
    let min_m = least_m.unwrap_or_else(|| usual.diameter_min_m.min(most_m.unwrap_or(f64::INFINITY)).max(spacing_m));
    [min_m, most_m.unwrap_or_else(|| usual.diameter_max_m.max(min_m))]
}
