//! The terrain of a map, and the posts of its starts and goals.

use std::borrow::Cow;

use super::{MapMemory, MapQuestion, MapStudyError, NamedPlace};
use crate::{
    graph::{PointSpacing, ReliabilityUse},
    ground::DemGround,
    planner::{NodesPerPost, SurfaceLattice, SurfaceNodes},
    quantity::MapPoint,
    reach::map::{NodeLattice, Post},
    scenario::Scenario,
    study::{
        DemReading, JourneyEnd, Overlays, coarse_dem_warning, dem_on_body,
        free_route::without_layers_of_paths,
        nodes::{coarse_map_nodes, level_hop_m, post_spacing_m},
        overlays::planned_over,
        with_measured_errors,
    },
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
    /// The nodes of the map.
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
        let aim = question.aim()?;
        without_layers_of_paths(scenario, "a map is made of hops, each by itself")?;
        // Single hops need no start.
        if question.starts.is_empty() && !question.ranks_sites && !question.mobility {
            return Err(MapStudyError::NoStart);
        }
        if let Some(allowed_bytes) = question.memory_max_bytes {
            let lattice = DemReading::of(scenario).options.open(file)?.lattice().clone();
            MapMemory::check_elevations((lattice.rows(), lattice.cols()), *stride, allowed_bytes)?;
        }
        let (dem, mut warnings) = dem_on_body(scenario, file)?;
        let overlays = Overlays::read(scenario, base, Some(&dem.georeference().coordinate_system), dem.bounds())?;
        let projection = dem.georeference().projection();
        let ground = overlays.ground(dem.clone(), scenario);
        let planning = planned_over(&ground, scenario);
        let lattice = question.lattice(&planning)?;
        let spots = |end, places: &[NamedPlace]| -> Result<Vec<Spot>, MapStudyError> {
            places.iter().map(|place| spot(end, place, &dem, &projection, lattice)).collect()
        };
        let (starts, goals) = (spots(JourneyEnd::Start, &question.starts)?, spots(JourneyEnd::Goal, &question.goals)?);
        check_distinct_posts(&dem, lattice, &starts.iter().chain(&goals).collect::<Vec<_>>())?;
        warnings.extend(overlays.without_effect_on_dem(dem.bounds()));
        warnings.extend(coarse_dem_warning(&scenario.hopper, dem.georeference()));
        for start in &starts {
            let scale = check_map_scale(&dem, projection.as_ref(), start.at, scenario.accept_map_scale, file)?;
            warnings.extend(scale.warning().filter(|warning| !warnings.contains(warning)));
        }
        warnings.extend(starts_of_no_post(&starts));
        warnings.extend(question.propellant_warning(&aim));
        warnings.extend(question.node_warnings(&planning, lattice));
        let memory = MapMemory::of(question, &planning, lattice)?;
        memory.check(question.memory_max_bytes)?;
        Ok(Self { ground, planning, projection, lattice, starts, goals, warnings, memory })
    }

    /// A place, and the node nearest to it.
    ///
    /// # Errors
    /// [`MapStudyError`]: off the map, or without an elevation.
    pub(in crate::study) fn spot(&self, end: JourneyEnd, place: &NamedPlace) -> Result<Spot, MapStudyError> {
        spot(end, place, self.dem(), &self.projection, self.lattice)
    }

    /// The elevations.
    pub fn dem(&self) -> &Dem {
        self.ground.terrain().dem()
    }

    /// The surface with a post at every node, where nodes are finer than posts; otherwise the DEM.
    ///
    /// # Errors
    /// [`MapStudyError::Terrain`], as [`Dem::finer`].
    pub fn finest(&self) -> Result<Cow<'_, Dem>, MapStudyError> {
        Ok(match self.lattice.per_post {
            1 => Cow::Borrowed(self.dem()),
            per_post => Cow::Owned(self.dem().finer(per_post)?),
        })
    }

    /// The map of the nodes.
    pub fn nodes(&self) -> GeoReference {
        self.lattice.map(self.dem().georeference())
    }
}

impl MapQuestion<'_> {
    /// The nodes of the map: every `stride`-th post, or the lattice as fine as the spacing of nodes asks; without one the posts.
    fn lattice(&self, ground: &DemGround) -> Result<NodeLattice, MapStudyError> {
        let (dem, post_spacing_m) = (ground.terrain().dem(), post_spacing_m(ground.terrain().dem()));
        let n = match self.scenario.search.spacing {
            _ if self.auto_nodes => NodesPerPost::auto(level_hop_m(ground), post_spacing_m),
            Some(PointSpacing::AtMostM(spacing_m)) => NodesPerPost::at_most_m(spacing_m, post_spacing_m),
            Some(PointSpacing::PerSegment(_)) | None => NodesPerPost::at_most_m(post_spacing_m, post_spacing_m),
        };
        if self.stride > 1 || n.get() == 1 {
            return Ok(NodeLattice::new(dem, self.stride));
        }
        SurfaceNodes::check(&SurfaceLattice::new(dem, n), 0)?;
        Ok(NodeLattice::finer(dem, n.get() as usize))
    }

    /// Warnings where one hop spans few nodes, and where a stride takes the place of a spacing.
    fn node_warnings(&self, ground: &DemGround, lattice: NodeLattice) -> Vec<String> {
        let nodes = lattice.map(ground.terrain().dem().georeference());
        let finer = if self.stride > 1 { "stride" } else { "search.node_spacing_max_m" };
        let mut warnings: Vec<String> =
            coarse_map_nodes(level_hop_m(ground), finer, nodes.dx_m().max(nodes.dy_m())).into_iter().collect();
        if self.stride > 1
            && let Some(PointSpacing::AtMostM(spacing_m)) = self.scenario.search.spacing
        {
            warnings.push(format!(
                "search.node_spacing_max_m = {spacing_m} has no effect on a map of every {} posts: leave out the stride, or the spacing",
                self.stride
            ));
        }
        warnings
    }

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
pub(in crate::study) fn spot(
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
    let at = lattice.at(map, post);
    if lattice.position(dem, post).is_none() {
        return Err(MapStudyError::NoElevation { name: name.clone(), end, post: at });
    }
    Ok(Spot { name: name.clone(), end, asked, post, at })
}

/// Checks that positions at different posts of the DEM have different posts of the map.
fn check_distinct_posts(dem: &Dem, lattice: NodeLattice, spots: &[&Spot]) -> Result<(), MapStudyError> {
    let (every_post, stride) = (NodeLattice::new(dem, 1), lattice.stride);
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
