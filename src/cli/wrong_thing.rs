//! A file that is something else than its position asks for: one sentence for each pair, with what to do instead.

use std::path::Path;

use chta::{
    scenario::FileKind,
    terrain::{VectorFormat, shell_word},
};

use super::inputs::is_stream;

/// A position on the command line or in a scenario that takes a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// CHAIN of the commands that analyse one: a chain, or a scenario or result that names it.
    Chain,
    /// TERRAIN of `hop`.
    HopTerrain,
    /// SCENARIO of `run` and `compare`.
    Scenario,
    /// `--scenario`.
    ScenarioOption,
    /// RESULT of `report`.
    Result,
    /// DEM of `map` and `fan`.
    Dem,
    /// DEM|MESH of `slice`.
    Terrain,
    /// `--pairs`.
    Pairs,
    /// DEM|SCENARIO of `map`.
    MapTarget,
    /// `--starts`.
    Starts,
    /// `[terrain] dem`.
    DemKey,
    /// `[terrain] mesh`.
    MeshKey,
    /// `[terrain] chain`.
    ChainKey,
    /// `[surface] keep_out`.
    KeepOut,
    /// `[surface] keep_in`.
    KeepIn,
    /// `[surface] friction_raster`.
    Friction,
    /// `[uncertainty] errors`.
    Errors,
    /// ARENA of `arena`.
    Arena,
    /// CASES of `batch`.
    Cases,
}

impl Role {
    /// The role of a key that names a file.
    pub(crate) fn of_key(table: &str, name: &str) -> Option<Self> {
        match (table, name) {
            ("terrain", "dem") => Some(Self::DemKey),
            ("terrain", "mesh") => Some(Self::MeshKey),
            ("terrain", "chain") => Some(Self::ChainKey),
            ("surface", "keep_out") => Some(Self::KeepOut),
            ("surface", "keep_in") => Some(Self::KeepIn),
            ("surface", "friction_raster") => Some(Self::Friction),
            ("uncertainty", "errors") => Some(Self::Errors),
            _ => None,
        }
    }

    /// The name of the position.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Chain => "CHAIN",
            Self::HopTerrain => "TERRAIN",
            Self::Scenario => "SCENARIO",
            Self::ScenarioOption => "--scenario",
            Self::Result => "RESULT",
            Self::Dem => "DEM",
            Self::Terrain => "DEM|MESH",
            Self::Pairs => "--pairs",
            Self::MapTarget => "DEM|SCENARIO",
            Self::Starts => "--starts",
            Self::DemKey => "terrain.dem",
            Self::MeshKey => "terrain.mesh",
            Self::ChainKey => "terrain.chain",
            Self::KeepOut => "surface.keep_out",
            Self::KeepIn => "surface.keep_in",
            Self::Friction => "surface.friction_raster",
            Self::Errors => "uncertainty.errors",
            Self::Arena => "ARENA",
            Self::Cases => "CASES",
        }
    }

    /// What the position takes.
    pub(crate) const fn expected(self) -> &'static str {
        match self {
            Self::Chain => "a chain CSV, a scenario (TOML) or a result (JSON)",
            Self::HopTerrain => {
                "a chain CSV, an elevation raster (GeoTIFF, ESRI ASCII grid, PDS3 image, XYZ grid), a mesh (OBJ, STL, PLY), a scenario \
                 (TOML) or a result (JSON)"
            }
            Self::Scenario | Self::ScenarioOption => "a scenario (TOML) or a result (JSON)",
            Self::Result => "a result (JSON) that chta wrote",
            Self::Dem | Self::DemKey => "an elevation raster (GeoTIFF, ESRI ASCII grid, PDS3 image, XYZ grid)",
            Self::Terrain => "an elevation raster (GeoTIFF, ESRI ASCII grid, PDS3 image, XYZ grid) or a mesh (OBJ, STL, PLY)",
            Self::Pairs => "a CSV file of pairs with the header start_x_m,goal_x_m",
            Self::MapTarget => {
                "an elevation raster (GeoTIFF, ESRI ASCII grid, PDS3 image, XYZ grid), or a scenario (TOML) or result (JSON) with terrain.dem, or \
                 with terrain.mesh and route = \"free\""
            }
            Self::Starts => "a CSV file of positions with the header x_m,y_m",
            Self::MeshKey => "a mesh (OBJ, STL, PLY)",
            Self::ChainKey => "a chain CSV",
            Self::KeepOut | Self::KeepIn => "zones as GeoJSON, or a mask raster (GeoTIFF, ESRI ASCII grid)",
            Self::Friction => "a raster of friction coefficients (GeoTIFF, ESRI ASCII grid)",
            Self::Errors => {
                "a CSV of measured errors with columns such as takeoff_speed_error_fraction and takeoff_angle_error_deg"
            }
            Self::Arena => "an arena (TOML) with the tables arena, jumper and box",
            Self::Cases => "a CSV file of cases whose header names scenario keys",
        }
    }

    /// The key of a scenario, without its table, if the position is one.
    const fn key(self) -> Option<&'static str> {
        match self {
            Self::DemKey => Some("dem"),
            Self::MeshKey => Some("mesh"),
            Self::ChainKey => Some("chain"),
            Self::KeepOut => Some("keep_out"),
            Self::KeepIn => Some("keep_in"),
            Self::Friction => Some("friction_raster"),
            Self::Errors => Some("errors"),
            _ => None,
        }
    }

    /// Whether the position takes an elevation raster beside a chain.
    pub(crate) const fn takes_rasters(self) -> bool {
        matches!(self, Self::HopTerrain)
    }

    /// Whether a file of this kind is what the position takes, or its reader says best what is wrong with it.
    pub(crate) fn takes(self, kind: &FileKind) -> bool {
        use FileKind as Kind;
        let of_scenario = matches!(kind, Kind::Scenario | Kind::Result | Kind::Json);
        let of_raster = matches!(kind, Kind::Raster(_) | Kind::ForeignRaster(_));
        // GDAL reads pictures whose samples are elevations.
        let of_dem = of_raster || (cfg!(feature = "gdal") && matches!(kind, Kind::Picture(_)));
        let of_mesh = matches!(kind, Kind::Mesh(..));
        // The readers of terrain say what makes a grid of points.
        let of_points = matches!(kind, Kind::Points(_));
        let is_unknown = matches!(kind, Kind::Empty | Kind::Text | Kind::Binary);
        is_unknown
            || match self {
                Self::Chain => *kind == Kind::ChainCsv || of_scenario,
                Self::HopTerrain => *kind == Kind::ChainCsv || of_scenario || of_dem || of_mesh || of_points,
                Self::Scenario | Self::ScenarioOption => of_scenario,
                Self::Result => matches!(kind, Kind::Result | Kind::Json),
                Self::Dem | Self::DemKey => of_dem || of_points,
                Self::MapTarget => of_dem || of_points || of_scenario,
                Self::Terrain => of_dem || of_mesh || of_points,
                Self::MeshKey => of_mesh || of_points,
                Self::ChainKey => *kind == Kind::ChainCsv,
                Self::Starts => *kind == Kind::PositionsCsv,
                Self::Pairs => *kind == Kind::PairsCsv,
                Self::Friction => of_raster,
                Self::Errors => *kind == Kind::MeasuredCsv,
                // By its extension it is taken for a scenario; its reader knows the tables.
                Self::Arena => *kind == Kind::Scenario,
                // Its reader knows the keys.
                Self::Cases => false,
                // The zones' reader knows the terrain's map, to which they have to be converted.
                Self::KeepOut | Self::KeepIn => of_raster || matches!(kind, Kind::GeoJson | Kind::Json | Kind::Shapes(_)),
            }
    }
}

/// What was found and expected, and how to mend it.
pub(crate) fn refusal(kind: &FileKind, role: Role, path: &Path) -> (String, String) {
    let found = format!("this is {}; expected {} as {}", kind.name(), role.expected(), role.name());
    (found, mend(kind, role, path))
}

/// How to mend a file of this kind in this position.
fn mend(kind: &FileKind, role: Role, path: &Path) -> String {
    let (name, toml) = (shell_word(path), toml_text(path));
    let key = role.key().unwrap_or_default();
    if let (FileKind::ForeignRaster(_), false) = (kind, cfg!(feature = "gdal")) {
        // It is mended as the GeoTIFF that GDAL makes of it.
        let converted = path.with_extension("tif");
        let mend = mend(&FileKind::Raster("GeoTIFF"), role, &converted);
        return format!("convert it with `gdal_translate {name} {}`; then {mend}", shell_word(&converted));
    }
    match (kind, role) {
        (FileKind::Packed(..), _) if is_stream(path) => "unpack it before it goes into the pipe".to_owned(),
        (FileKind::Packed(_, program), _) => format!("unpack it with `{program} {name}` and give the file in it"),
        (FileKind::Document(_) | FileKind::Empty | FileKind::Text | FileKind::Binary, _) => {
            format!("check the path: give {}", role.expected())
        }
        (FileKind::ForeignMesh(_), Role::Terrain | Role::HopTerrain | Role::MeshKey) => {
            "export it as OBJ, STL or PLY, z up, and give that file".to_owned()
        }
        (FileKind::Picture(_), Role::Dem | Role::HopTerrain | Role::MapTarget | Role::DemKey | Role::Terrain) => {
            "a picture holds colours or brightness: give the raster of elevations that it was drawn from".to_owned()
        }
        // The terrain keys of a scenario.
        (FileKind::Raster(_) | FileKind::ForeignRaster(_), Role::MeshKey) => {
            format!("write dem = {toml} in place of mesh, and leave mesh_scale away")
        }
        (FileKind::Mesh(..), Role::DemKey) => format!("write mesh = {toml} in place of dem"),
        (FileKind::Raster(_) | FileKind::ForeignRaster(_), Role::ChainKey) => {
            format!("write dem = {toml} in place of chain, {ON_MAP}")
        }
        (FileKind::Mesh(..), Role::ChainKey) => format!("write mesh = {toml} in place of chain, {ON_MAP}"),
        (FileKind::ChainCsv, Role::DemKey | Role::MeshKey) => {
            format!("write chain = {toml} in place of {key}, and start_x_m and goal_x_m in place of start_m and goal_m")
        }
        (FileKind::Robot, Role::Chain | Role::HopTerrain | Role::Scenario | Role::ScenarioOption | Role::MapTarget) => {
            format!("name it in a scenario: [robot] file = {toml}")
        }
        (FileKind::Scenario | FileKind::Result, _) if role.key().is_some() => {
            format!("name in {key} the file itself; a scenario stands where the command takes one, as in `chta run {name} -o out`")
        }
        (FileKind::GeoJson, Role::Friction) => {
            format!(
                "zones where nothing may land belong in [surface] keep_out = {toml}; friction takes a raster on the terrain's map"
            )
        }
        (_, Role::Friction) => "give a raster on the terrain's map, or friction_coefficient alone".to_owned(),
        (FileKind::ChainCsv, Role::KeepOut | Role::KeepIn) => {
            "a chain has its zones in its own column keep_out; for a dem draw them as polygons in map coordinates".to_owned()
        }
        (_, Role::KeepOut) => {
            "draw the zones as polygons in the terrain's map coordinates, or give a raster whose pixels other than 0 are kept out"
                .to_owned()
        }
        (_, Role::KeepIn) => {
            "draw the zones as polygons in the terrain's map coordinates, or give a raster whose pixels other than 0 may be landed on"
                .to_owned()
        }
        (FileKind::Shapes(VectorFormat::ShapefilePart), _) => "it describes another file beside it: give that one".to_owned(),
        (FileKind::Shapes(_), _) => {
            format!(
                "shapes are zones: name them in a scenario as [surface] keep_out = {toml}, where the command that converts them is given"
            )
        }
        (FileKind::GeoJson, _) => format!("zones belong in a scenario: [surface] keep_out = {toml}"),
        // The command line.
        (FileKind::Raster("XYZ grid"), Role::Chain | Role::Pairs) => format!(
            "{}; if its rows are a table of another kind, put the names of its columns above them (a chain: x_m,z_m)",
            from_terrain("dem", &name, &toml)
        ),
        (FileKind::Raster(_) | FileKind::ForeignRaster(_), Role::Chain | Role::Pairs | Role::Scenario | Role::ScenarioOption) => {
            from_terrain("dem", &name, &toml)
        }
        (FileKind::Mesh(..), Role::Chain | Role::Pairs | Role::Scenario | Role::ScenarioOption) => {
            from_terrain("mesh", &name, &toml)
        }
        (FileKind::Mesh(..), Role::MapTarget) => format!(
            "name it in a scenario: [terrain] mesh = {toml} with route = \"free\", start_m and goal_m = [x, y, z]; a mesh can be cut as well: `chta slice \
             {name} --from X,Y --to X,Y -o chain.csv`"
        ),
        (FileKind::Mesh(..), Role::Dem) => {
            format!("a mesh can be cut, not mapped: `chta slice {name} --from X,Y --to X,Y -o chain.csv`")
        }
        (FileKind::ChainCsv, Role::Dem | Role::MapTarget | Role::Terrain) => format!(
            "a chain is cut already: give it to `chta plan {name} --start X --goal X --scenario SCENARIO`, and here the terrain it came from"
        ),
        (FileKind::ChainCsv, Role::Scenario | Role::ScenarioOption) => format!(
            "name it in a scenario: [terrain] chain = {toml} with start_x_m and goal_x_m; or `chta plan {name} --start X --goal X \
             --scenario SCENARIO`"
        ),
        (FileKind::ChainCsv, Role::Pairs) => format!("the chain comes first: `chta check {name} --pairs PAIRS.csv`"),
        (FileKind::PairsCsv, Role::Chain | Role::HopTerrain) => format!("the chain comes first: `chta check CHAIN --pairs {name}`"),
        (FileKind::PathCsv, _) => format!("a path is an answer: give {} that it was planned on", role.expected()),
        (FileKind::Scenario, Role::Result) => format!("run it first: `chta run {name} -o out`, and give out/result.json"),
        (FileKind::Scenario | FileKind::Result, Role::Dem | Role::Terrain) => {
            format!("give the terrain first, and the scenario with --scenario {name}")
        }
        _ => format!("check the path: give {}", role.expected()),
    }
}

/// The ends of a slice, as keys.
const ON_MAP: &str = "and start_m and goal_m, each [x, y], in place of start_x_m and goal_x_m";

/// What to do with terrain where a chain or a scenario is asked for.
fn from_terrain(key: &str, name: &str, toml: &str) -> String {
    format!(
        "cut a chain from it with `chta slice {name} --from X,Y --to X,Y -o chain.csv`, or name it in a scenario: [terrain] {key} = {toml} \
         with start_m and goal_m"
    )
}

/// A path as a text of TOML.
fn toml_text(path: &Path) -> String {
    let text = path.display().to_string();
    if text.contains(['\\', '"']) && !text.contains('\'') {
        format!("'{text}'")
    } else {
        format!("\"{}\"", text.replace('\\', "/"))
    }
}
