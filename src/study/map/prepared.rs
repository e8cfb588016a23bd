//! The terrain of a map, and the posts of its starts and goals.

use super::{MapMemory, MapQuestion, MapStudyError, NamedPlace};
use crate::{
    graph::ReliabilityUse,
    ground::DemGround,
    quantity::MapPoint,
    reach::map::{NodeLattice, Post},
    scenario::Scenario,
    study::{DemReading, JourneyEnd, Overlays, coarse_dem_warning, dem_on_body, pipeline::planned_over, with_measured_errors},
    terrain::{Dem, GeoReference, MapProjection, NoProjection, check_map_scale},
    uncertainty::Uncertainty,
};

/// A requested position and the post of the map nearest to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    /// What the caller calls it.
    pub name: String,
    /// Start or goal.
    pub end: JourneyEnd,
    /// The requested position.
    pub asked: MapPoint,
    /// The nearest post.
    pub post: Post,
    /// Its position.
    pub at: MapPoint,
}

/// The terrain of a map, with the posts of its starts and goals, before the search.
#[derive(Clone, Debug)]
pub struct PreparedMap {
    /// The ground, with the whole limits: trials fly them.
    pub ground: DemGround,
    /// The same under the limits that planning may use.
    pub planning: DemGround,
    /// The projection of its map, or why it has none.
    pub projection: Result<MapProjection, NoProjection>,
    /// The posts of the map.
    pub lattice: NodeLattice,
    /// The starts, in the order given.
    pub starts: Vec<Spot>,
    /// The goals, in the order given.
    pub goals: Vec<Spot>,
    /// Warnings about the terrain and its overlays.
    pub warnings: Vec<String>,
    /// What the map needs.
    pub memory: MapMemory,
}

impl PreparedMap {
    /// Reads the terrain with its overlays and finds the posts of starts and goals.
    ///
    /// # Errors
    /// [`MapStudyError`], also if the map needs more memory than the question allows: before the elevations are read if these alone do.
    pub fn new(question: &MapQuestion<'_>) -> Result<Self, MapStudyError> {
        let MapQuestion { scenario, base, dem: file, stride, .. } = question;
        if question.starts.is_empty() {
            return Err(MapStudyError::NoStart);
        }
        if let Some(allowed_bytes) = question.memory_max_bytes {
            let lattice = DemReading::of(scenario).options.open(file)?.lattice().clone();
            MapMemory::check_elevations((lattice.rows(), lattice.cols()), *stride, allowed_bytes)?;
        }
        let (dem, mut warnings) = dem_on_body(scenario, file)?;
        let overlays = Overlays::read(scenario, base, Some(&dem.georeference().coordinate_system), dem.bounds())?;
        let projection = dem.georeference().projection();
        let lattice = NodeLattice::new(&dem, *stride);
        let spots = |end, places: &[NamedPlace]| -> Result<Vec<Spot>, MapStudyError> {
            places.iter().map(|place| spot(end, place, &dem, &projection, lattice)).collect()
        };
        let (starts, goals) = (spots(JourneyEnd::Start, &question.starts)?, spots(JourneyEnd::Goal, &question.goals)?);
        for spot in starts.iter().chain(&goals) {
            let Post { row, col } = lattice.post(spot.post);
            if dem.elevation(row, col).is_none() {
                return Err(MapStudyError::NoElevation { name: spot.name.clone(), end: spot.end, post: spot.at });
            }
        }
        check_distinct_posts(&dem, lattice.stride, &starts.iter().chain(&goals).collect::<Vec<_>>())?;
        warnings.extend(overlays.without_effect_on_dem(dem.bounds()));
        warnings.extend(coarse_dem_warning(&scenario.hopper, dem.georeference()));
        for start in &starts {
            let scale = check_map_scale(&dem, projection.as_ref(), start.at, scenario.accept_map_scale, file)?;
            warnings.extend(scale.warning().filter(|warning| !warnings.contains(warning)));
        }
        warnings.extend(starts_of_no_post(&starts));
        let ground = overlays.ground(dem, scenario);
        let planning = planned_over(&ground, scenario);
        let memory = MapMemory::of(question, &planning)?;
        memory.check(question.memory_max_bytes)?;
        Ok(Self { ground, planning, projection, lattice, starts, goals, warnings, memory })
    }

    /// The elevations.
    pub fn dem(&self) -> &Dem {
        self.ground.terrain().dem()
    }

    /// The map of the posts.
    pub fn nodes(&self) -> GeoReference {
        self.dem().georeference().every(self.lattice.stride)
    }
}

impl MapQuestion<'_> {
    /// The scenario whose trials are flown, with its measured errors, and warnings about these; `None` if no trials are wanted.
    ///
    /// # Errors
    /// What is wrong with the measured errors.
    pub fn flown_scenario(&self) -> Result<Option<(Scenario, Vec<String>)>, MapStudyError> {
        self.trials.then(|| with_measured_errors(self.scenario.clone(), self.base)).transpose().map_err(Into::into)
    }

    /// Whether a robot with these errors that replans goes the most reliable way, instead of the one of fewest hops.
    pub(super) fn weighs_risk(&self, errors: &Uncertainty) -> bool {
        !errors.is_none() && self.scenario.risk != ReliabilityUse::Ignored
    }
}

/// A position on the map, and the post nearest to it.
fn spot(
    end: JourneyEnd,
    NamedPlace { name, place }: &NamedPlace,
    dem: &Dem,
    projection: &Result<MapProjection, NoProjection>,
    lattice: NodeLattice,
) -> Result<Spot, MapStudyError> {
    let (map, bounds) = (dem.georeference(), dem.bounds());
    let asked = place.on_map(end.name(), projection.as_ref(), bounds)?;
    if !bounds.contains(asked) {
        return Err(MapStudyError::OffMap { name: name.clone(), at: asked, bounds });
    }
    let post = lattice.nearest(map, asked);
    Ok(Spot { name: name.clone(), end, asked, post, at: map.every(lattice.stride).post(post.row, post.col) })
}

/// Checks that positions at different posts of the DEM have different posts of the map.
fn check_distinct_posts(dem: &Dem, stride: usize, spots: &[&Spot]) -> Result<(), MapStudyError> {
    let every_post = NodeLattice::new(dem, 1);
    for (i, spot) in spots.iter().enumerate() {
        let post = |spot: &Spot| every_post.nearest(dem.georeference(), spot.asked);
        if let Some(other) = spots[..i].iter().find(|other| other.post == spot.post && post(other) != post(spot)) {
            return Err(MapStudyError::SamePost { stride, asked: [other.asked, spot.asked], post: spot.at });
        }
    }
    Ok(())
}

/// A warning for each start on the post of an earlier one, which is the nearest start of every post that both reach.
fn starts_of_no_post(starts: &[Spot]) -> Vec<String> {
    let repeated = starts.iter().enumerate().filter_map(|(i, start)| {
        let first = starts[..i].iter().position(|other| other.post == start.post)?;
        Some((i + 1, first + 1, start.at))
    });
    repeated
        .map(|(number, first, at)| {
            format!(
                "start {number} has the same nearest post as start {first}, ({:.3}, {:.3}) m, so that no post is counted as reached from it",
                at.x, at.y
            )
        })
        .collect()
}
