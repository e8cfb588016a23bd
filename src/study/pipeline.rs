//! The pipeline from a scenario over terrain, chain and constraints to a chain ready for the hop test.

use std::{
    borrow::Cow,
    fmt::Write,
    fs::File,
    io::{self, Read},
    path::{Path, PathBuf},
    sync::Arc,
};

use sha2::{Digest, Sha256};

use super::{
    footprint::{SlicedDem, coarse_dem_warning},
    on_body::{contradictions, on_body, refuse_mesh_keys},
    overlays::{Overlays, friction},
    physics::{Extent, TooLarge},
};
use crate::{
    chain::{ConstrainedChain, ConstraintProblems, InvalidChain, OffChain, PolygonalChain, Station, csv},
    graph::{Leg, SearchOptions},
    ground::{DemGround, MapPosition, Surface},
    hop::HopTest,
    path::{Execution, Hop, HopPath, PathError, execute, generate_over},
    quantity::MapPoint,
    scenario::{Route, Scenario, TerrainSource},
    terrain::{
        CoordinateSystem, DemOptions, Ellipsoid, MapPlace, MapProjection, NoDataRule, Profile, Surroundings, TerrainError,
        check_scale, read_mesh_with, slice_legs, slice_mesh,
    },
    uncertainty::UncertaintyProblem,
    world::Derating,
};

/// A chain ready to be analysed, with start and goal if known.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The chain with its constraints.
    pub chain: Arc<ConstrainedChain>,
    /// Where the journey begins.
    pub start: Option<Station>,
    /// Where it ends.
    pub goal: Option<Station>,
    /// The projection of the chain's map, if it lies on a map of a known projection.
    pub projection: Option<MapProjection>,
    /// The DEM that the chain was cut from, where the hopper takes its headings in steps and has not those of the chain: it flies over
    /// the ground beside the line.
    pub beside_line: Option<Arc<DemGround>>,
    /// The warnings of the terrain reader.
    pub warnings: Vec<String>,
}

impl Prepared {
    /// The hops of a path that was found, with the commands that the hopper has.
    ///
    /// # Errors
    /// [`PathError`].
    pub fn path(&self, test: &HopTest, legs: &[Leg], options: &SearchOptions) -> Result<HopPath, PathError> {
        generate_over(test, self.beside_line.as_deref(), legs, options.takeoff, options.split)
    }

    /// A path between two stations flown again by the independent checker, over the ground that it was planned for.
    ///
    /// Commands in steps land near the goal, and their last landing stands for it.
    pub fn execute(&self, path: &HopPath, (start, goal): (Station, Station)) -> Execution {
        let landing = path.hops.last().filter(|hop| hop.aim.is_some()).map(|hop| hop.landing);
        let beside = landing.filter(|_| path.hops.iter().any(Hop::is_beside_line));
        if let (Some(dem), Some(landing)) = (&self.beside_line, beside) {
            let start = dem.contact_at(&self.chain.contact_point(&start));
            let landing = MapPosition { at: landing.point_m.xy(), z_m: landing.point_m.z };
            return execute(dem.as_ref(), path, start.map(|start| (start, landing)));
        }
        let goal = landing.and_then(|landing| landing.station).unwrap_or(goal);
        execute(self.chain.as_ref(), path, Some((start, goal)))
    }
}

/// One end of a journey.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JourneyEnd {
    /// The start.
    Start,
    /// The goal.
    Goal,
}

impl JourneyEnd {
    /// `start` or `goal`, the prefix of its keys.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Goal => "goal",
        }
    }
}

/// Why a scenario's terrain gives no chain to analyse.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// The elevation raster or its slice.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// The chain CSV.
    #[error(transparent)]
    Csv(#[from] csv::CsvFileError),
    /// A slice that does not form a chain.
    #[error("the slice does not form a chain: {0}")]
    Chain(#[from] InvalidChain),
    /// Segments without constraints.
    #[error(transparent)]
    Constraints(#[from] ConstraintProblems),
    /// A start or goal off the chain.
    #[error("{}: {problem}", which.name())]
    OffChain {
        /// Start or goal.
        which: JourneyEnd,
        /// The position, and the extent of the chain.
        problem: OffChain,
    },
    /// A mesh that is not sliced.
    #[error(
        "this question has no answer over a mesh with terrain.route = \"free\", where plans, runs, trials, maps, comparisons, checks of their results and \
         single hops between two points X,Y,Z have one: give start_m and goal_m = [x, y] with route = \"transect\", along the upper surface, or a dem"
    )]
    NotSliced,
    /// A terrain that is larger than the body it is said to lie on.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// A ball over a terrain that is no mesh of hops in space.
    #[error(
        "found hopper.radius_m of {radius_m} m, the radius of a ball over a mesh, expected a scenario without it over a DEM, a chain or a \
         slice, where clearance_m keeps the hopper off the ground: remove it, or give clearance_m"
    )]
    BallOffMesh {
        /// The radius, m.
        radius_m: f64,
    },
    /// Groups of faces where the terrain has none.
    #[error(
        "found surface.group, the surfaces of groups of faces of a mesh, expected a scenario without it over a DEM, a chain or a slice: \
         remove it, or give surface.friction_raster or a column of the chain"
    )]
    GroupsOffMesh,
    /// Measured errors that contradict the deviations beside them.
    #[error("{}", measured_problems(path, problems))]
    Measured {
        /// The file of the measured errors.
        path: PathBuf,
        /// Every contradiction.
        problems: Vec<UncertaintyProblem>,
    },
    /// A file that cannot be read.
    #[error("{}: cannot be read ({source}): check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}

/// A line for each problem.
fn measured_problems(path: &Path, problems: &[UncertaintyProblem]) -> String {
    let lines: Vec<String> =
        problems.iter().map(|problem| format!("{}: uncertainty.{}: {}", path.display(), problem.found(), problem.help())).collect();
    lines.join("\n")
}

/// Builds the chain of a scenario: slices its DEM or mesh, or reads its chain, resolves the constraints, finds start and goal on
/// it.
///
/// `base` is the folder that the scenario's paths start from.
///
/// # Errors
/// [`PipelineError`].
pub fn prepare(scenario: &Scenario, source: &TerrainSource, base: &Path) -> Result<Prepared, PipelineError> {
    Survey::of(scenario, source, base)?.prepare_with_ground(scenario)
}

/// The terrain of a scenario, read and sliced once. Chains for any hopper, grip and search are prepared from it.
#[derive(Clone, Debug)]
pub struct Survey {
    ground: Surveyed,
    projection: Option<MapProjection>,
    warnings: Vec<String>,
}

/// The terrain that was read.
#[derive(Clone, Debug)]
enum Surveyed {
    /// A slice and its overlays.
    Slice { legs: Vec<Profile>, overlays: Box<Overlays>, dem: Option<SlicedDem> },
    /// A chain as given.
    Chain(PolygonalChain),
}

impl Survey {
    /// Reads and slices the terrain of a scenario, with its rasters and zones.
    ///
    /// `base` is the folder that the scenario's paths start from.
    ///
    /// # Errors
    /// [`PipelineError`].
    pub fn of(scenario: &Scenario, source: &TerrainSource, base: &Path) -> Result<Self, PipelineError> {
        let body = &scenario.body;
        refuse_mesh_keys(scenario)?;
        let (transect, of_extent) = match source {
            TerrainSource::Dem { path, start, goal } => {
                let read = Transect::of_dem(&base.join(path), [start, goal], &scenario.via, DemReading::of(scenario));
                on_body(body, read.map_err(|error| error.of_journey(start.metres(), goal.metres())))?
            }
            TerrainSource::Mesh { path, scale, start, goal } => {
                let via: Vec<MapPoint> = scenario.via.iter().filter_map(MapPlace::metres).collect();
                let read = Transect::of_mesh(&base.join(path), (*scale, scenario.no_data), [*start, *goal], &via);
                on_body(body, read.map_err(|error| error.of_journey(Some(*start), Some(*goal))))?
            }
            TerrainSource::MeshInSpace { .. } => return Err(PipelineError::NotSliced),
            TerrainSource::Chain { path } => {
                let (file, _) = on_body(body, Ok(csv::read_chain_csv_file_with(base.join(path), scenario.no_data)?))?;
                return Ok(Self { ground: Surveyed::Chain(file.chain), projection: file.projection, warnings: file.warnings });
            }
        };
        let mut warnings = transect.warnings;
        warnings.extend(of_extent);
        let overlays = Overlays::read(scenario, base, transect.coordinates.as_ref(), transect.extent.bounds)?;
        let dem = match source {
            TerrainSource::Dem { path, .. } => {
                Some(SlicedDem::of(base.join(path), DemReading::of(scenario), &transect.legs, &scenario.hopper)?)
            }
            TerrainSource::Mesh { .. } | TerrainSource::MeshInSpace { .. } | TerrainSource::Chain { .. } => None,
        };
        let ground = Surveyed::Slice { legs: transect.legs, overlays: Box::new(overlays), dem };
        Ok(Self { ground, projection: transect.projection, warnings })
    }

    /// A chain that is no file.
    pub(super) const fn along(chain: PolygonalChain) -> Self {
        Self { ground: Surveyed::Chain(chain), projection: None, warnings: Vec::new() }
    }

    /// The chain under another scenario's hopper, grip, rest slope and ends. That scenario's terrain keys and files are ignored, and the
    /// ground beside the line is not read: what varies a key answers for exact commands.
    ///
    /// # Errors
    /// [`PipelineError`], if segments are left without constraints or an end lies off the chain.
    pub fn prepare(&self, scenario: &Scenario) -> Result<Prepared, PipelineError> {
        self.prepared(scenario, &Derating::NONE)
    }

    /// The same with the ground beside the line.
    pub(super) fn prepare_with_ground(&self, scenario: &Scenario) -> Result<Prepared, PipelineError> {
        let beside_line = self.beside_line(scenario)?;
        Ok(Prepared { beside_line, ..self.prepare(scenario)? })
    }

    /// The same terrain under the rules that a scenario gives its layers.
    ///
    /// # Errors
    /// [`PipelineError::Terrain`].
    pub(super) fn under(&self, scenario: &Scenario) -> Result<Cow<'_, Self>, PipelineError> {
        let Surveyed::Slice { legs, overlays, dem } = &self.ground else { return Ok(Cow::Borrowed(self)) };
        if overlays.has_rules_of(scenario) {
            return Ok(Cow::Borrowed(self));
        }
        let overlays = Box::new(overlays.under(scenario)?);
        let ground = Surveyed::Slice { legs: legs.clone(), overlays, dem: dem.clone() };
        Ok(Cow::Owned(Self { ground, ..self.clone() }))
    }

    /// The DEM that was sliced, with its overlays; `None` if the terrain is a mesh or a chain.
    pub(super) fn sliced(&self) -> Option<(SlicedDem, Overlays)> {
        match &self.ground {
            Surveyed::Slice { overlays, dem, .. } => Some((dem.clone()?, overlays.as_ref().clone())),
            Surveyed::Chain(_) => None,
        }
    }

    /// The ground beside the line, where a hopper with headings in steps leaves it.
    pub(super) fn beside_line(&self, scenario: &Scenario) -> Result<Option<Arc<DemGround>>, PipelineError> {
        match &self.ground {
            Surveyed::Slice { legs, overlays, dem: Some(dem) } => dem.beside_line(legs, overlays, scenario),
            Surveyed::Slice { dem: None, .. } | Surveyed::Chain(_) => Ok(None),
        }
    }

    /// As [`prepare`](Self::prepare) for the limits that planning may use, of a scenario that has them
    /// ([`Scenario::derated`]). `whole`: the scenario with the whole limits.
    pub(super) fn prepare_derated(&self, whole: &Scenario, derated: &Scenario) -> Result<Prepared, PipelineError> {
        // The frictions of a slice are those of the scenario: they are laid whole, then derated with all others of the chain.
        let laid = Scenario { surface: whole.surface, ..derated.clone() };
        self.prepared(&laid, &whole.derating)
    }

    fn prepared(&self, scenario: &Scenario, derating: &Derating) -> Result<Prepared, PipelineError> {
        let mut warnings = self.warnings.clone();
        let (geometry, dem, ends) = match &self.ground {
            Surveyed::Slice { legs, overlays, dem } => {
                let around = dem.as_ref().map(|dem| dem.around(legs, &scenario.hopper)).transpose()?.flatten();
                let (chain, without_effect) = overlays.laid(legs.clone(), friction(scenario))?;
                // A free route may leave the line of this slice.
                warnings.extend(without_effect.into_iter().filter(|_| scenario.route == Route::Transect));
                whole(chain, around)
            }
            Surveyed::Chain(chain) => (chain.clone(), None, (None, None)),
        };
        if derating.is_none() {
            return resolved(scenario, (geometry, dem), ends, self.projection.clone(), warnings);
        }
        let scenario = Scenario { surface: derating.surface(&scenario.surface), ..scenario.clone() };
        resolved(&scenario, (geometry.derated(derating), dem), ends, self.projection.clone(), warnings)
    }
}

/// A chain with the DEM around it, if footprints need it, and the ends of a journey.
type Whole = (PolygonalChain, Option<Arc<Surroundings>>, (Option<f64>, Option<f64>));

/// A chain, with its ends as the default start and goal.
fn whole(chain: PolygonalChain, dem: Option<Arc<Surroundings>>) -> Whole {
    let (first_m, last_m) = chain.extent_m();
    (chain, dem, (Some(first_m), Some(last_m)))
}

/// Resolves the constraints of a chain and finds start and goal on it.
fn resolved(
    scenario: &Scenario,
    (geometry, dem): (PolygonalChain, Option<Arc<Surroundings>>),
    ends: (Option<f64>, Option<f64>),
    projection: Option<MapProjection>,
    mut warnings: Vec<String>,
) -> Result<Prepared, PipelineError> {
    warnings.extend(contradictions(scenario, Some(&geometry)));
    if scenario.hopper.limits().steps.heading.is_some() && geometry.map_points().is_none() {
        warnings
            .push("hopper.heading_step_deg has no effect: the chain lies on no map, so that its hops have no heading".to_owned());
    }
    let Scenario { hopper, surface, .. } = scenario;
    let gravity = scenario.body.gravity;
    let chain = Arc::new(match dem {
        Some(dem) => {
            warnings.extend(coarse_dem_warning(hopper, dem.lattice().georeference()));
            ConstrainedChain::on_dem(dem, geometry, hopper, gravity, surface)?
        }
        None => ConstrainedChain::new(geometry, hopper, gravity, surface)?,
    });
    let station = |which, x_m: Option<f64>| {
        x_m.map(|x_m| chain.geometry().station(x_m)).transpose().map_err(|problem| PipelineError::OffChain { which, problem })
    };
    let start = station(JourneyEnd::Start, scenario.start_x_m.or(ends.0))?;
    let goal = station(JourneyEnd::Goal, scenario.goal_x_m.or(ends.1))?;
    let mut prepared = Prepared { chain, start, goal, projection, beside_line: None, warnings };
    prepared.warnings.extend(scenario.replaced_keys(&prepared));
    Ok(prepared)
}

/// How an elevation raster is read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DemReading {
    /// What the file does not say itself.
    pub options: DemOptions,
    /// Whether a map whose scale is off by over 1 % is accepted.
    pub accept_map_scale: bool,
}

impl DemReading {
    /// As a scenario states.
    pub fn of(scenario: &Scenario) -> Self {
        let options = DemOptions::default().no_data(scenario.no_data);
        Self { options, accept_map_scale: scenario.accept_map_scale }
    }
}

/// The ground along a journey, leg by leg, and its map.
#[derive(Clone, Debug)]
pub struct Transect {
    /// One slice for each leg.
    pub legs: Vec<Profile>,
    /// The terrain's statement of its map.
    pub coordinates: Option<CoordinateSystem>,
    /// The map's projection, if known.
    pub projection: Option<MapProjection>,
    /// The figure of the body that the terrain states.
    pub figure: Option<Ellipsoid>,
    /// The extent of the terrain, and what kind of terrain it is.
    pub extent: Extent,
    /// How much terrain the file holds, such as "120 rows and 70 columns of posts": a file that was cut short holds less.
    pub size: String,
    /// Warnings for the analyst.
    pub warnings: Vec<String>,
}

impl Transect {
    /// Slices an elevation raster from the first end over the intermediate points to the second, once the scale of its map along
    /// every leg is within 1 % or accepted. Reads only the posts beside the slices.
    ///
    /// # Errors
    /// As [`open_dem`](crate::terrain::open_dem), [`MapPlace::on_map`], [`check_scale`] and [`slice_legs`].
    pub fn of_dem(file: &Path, [from, to]: [&MapPlace; 2], via: &[MapPlace], reading: DemReading) -> Result<Self, TerrainError> {
        let DemReading { options, accept_map_scale } = reading;
        let dem = options.open(file)?;
        let (map, bounds) = (dem.lattice().georeference(), dem.lattice().bounds());
        let projection = map.projection();
        let known = projection.as_ref();
        let (from, to) = (from.on_map("from", known, bounds)?, to.on_map("to", known, bounds)?);
        let via = via.iter().map(|place| place.on_map("via", known, bounds)).collect::<Result<Vec<_>, _>>()?;
        let mut warnings = map.doubts();
        let mut begin = from;
        for end in via.iter().copied().chain([to]) {
            let scale = check_scale(dem.as_ref(), known, [begin, end], accept_map_scale, file)?;
            warnings.extend(scale.warning().filter(|warning| !warnings.contains(warning)));
            begin = end;
        }
        let legs = slice_legs(dem.as_ref(), from, &via, to)?;
        let heights = legs.iter().flat_map(|leg| &leg.points).map(|point| point.z_m);
        let range_m = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z_m| (low.min(z_m), high.max(z_m)));
        warnings.extend(dem.warnings(range_m));
        let coordinates = Some(map.coordinate_system.clone());
        let extent = Extent::of_dem(bounds, projection.is_ok());
        let size = format!("{} rows and {} columns of posts", dem.lattice().rows(), dem.lattice().cols());
        Ok(Self { legs, coordinates, projection: projection.ok(), figure: map.ellipsoid(), extent, size, warnings })
    }

    /// Slices a mesh, with its metres per unit and its mark of missing data, from the first end over the intermediate points to the second.
    ///
    /// # Errors
    /// As [`read_mesh_with`] and [`slice_mesh`].
    pub fn of_mesh(
        file: &Path,
        (scale, no_data): (f64, NoDataRule),
        [from, to]: [MapPoint; 2],
        via: &[MapPoint],
    ) -> Result<Self, TerrainError> {
        let read = read_mesh_with(file, scale, no_data)?;
        let (mut legs, mut warnings) = (Vec::new(), read.warnings);
        if !read.mesh.faces().are_bare() {
            warnings.push(
                "the mesh states the friction, the rest slope or a keep-out of its faces, which a slice along its upper surface leaves out: the \
                 surface of the scenario counts"
                    .to_owned(),
            );
        }
        let mut begin = from;
        for end in via.iter().copied().chain([to]) {
            let slice = slice_mesh(&read.mesh, begin, end)?;
            warnings.extend(slice.warnings());
            legs.push(slice.profile);
            begin = end;
        }
        let extent = Extent::of_mesh(&read.mesh.bounds());
        let size = format!("a mesh of {} triangles", read.mesh.triangle_count());
        Ok(Self { legs, coordinates: None, projection: None, figure: None, extent, size, warnings })
    }
}

/// The SHA-256 of a file, hexadecimal, read in pieces.
///
/// # Errors
/// [`PipelineError::Read`].
pub fn sha256_of(path: &Path) -> Result<String, PipelineError> {
    let reading = |source| PipelineError::Read { path: path.to_path_buf(), source };
    let mut file = File::open(path).map_err(reading)?;
    let mut digest = Sha256::new();
    let mut piece = vec![0; 1 << 16];
    loop {
        let count = file.read(&mut piece).map_err(reading)?;
        if count == 0 {
            break;
        }
        digest.update(&piece[..count]);
    }
    Ok(digest.finalize().iter().fold(String::with_capacity(64), |mut text, byte| {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    }))
}
