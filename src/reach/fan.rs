//! Slices in all directions from one point, each analysed.

use nalgebra::Vector2;
use rayon::prelude::*;

use crate::{
    chain::ConstrainedChain,
    graph::{NodeSet, NodesError, PointSpacing, SearchError, reachable_nodes},
    ground::{DemGround, SliceProblem},
    hop::HopTest,
    progress::{Cancelled, Detail, Meter, Progress, Stage},
    quantity::MapPoint,
    terrain::{Profile, TerrainError, slice},
    world::Limit,
};

/// The parameters of a fan.
#[derive(Clone, Copy, Debug)]
pub struct FanRequest<'a> {
    /// The terrain, its overlays, the hopper and gravity.
    pub ground: &'a DemGround,
    /// The start of all slices.
    pub from: MapPoint,
    /// The number of slices, equally spaced clockwise from grid north.
    pub headings: u32,
    /// Their length, m, if the map is large enough.
    pub length_m: f64,
    /// The spacing of nodes on the slices.
    pub spacing: PointSpacing,
}

/// Why a slice is shorter than requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SliceEnd {
    /// The map's border.
    Border,
    /// Posts without elevation.
    NoData,
}

impl SliceEnd {
    /// All reasons.
    pub const ALL: [Self; 2] = [Self::Border, Self::NoData];

    /// The name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Border => "border",
            Self::NoData => "no-data",
        }
    }
}

crate::quantity::by_name!(SliceEnd, SliceEnd::ALL);

/// A part of a slice whose nodes all need the same number of hops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopBand {
    /// Its beginning, half-way from the last node with another count, m from the start.
    pub from_m: f64,
    /// Its end, m from the start.
    pub to_m: f64,
    /// The number of hops; `None`: these nodes cannot be reached.
    pub hops: Option<u64>,
}

/// One direction.
#[derive(Clone, Debug, PartialEq)]
pub struct FanRay {
    /// Clockwise from grid north, degrees.
    pub heading_deg: f64,
    /// How long the slice is, m.
    pub length_m: f64,
    /// Why the slice is shorter than requested; `None` if it is not.
    pub end: Option<SliceEnd>,
    /// The farthest reachable node, m from the start; 0 if no node is reachable.
    pub farthest_m: f64,
    /// The fewest hops to it.
    pub hops_to_farthest: u64,
    /// The fewest hops to the slice's far end; `None` if it cannot be reached.
    pub hops_to_end: Option<u64>,
    /// The limit that refuses the hop from the farthest node to the next one; `None` if the far end is reached.
    pub refusing: Option<Limit>,
    /// The bands of the whole slice, beginning at the start.
    pub bands: Vec<HopBand>,
}

/// Why there is no fan.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FanError {
    /// An invalid value in the request.
    #[error("{what} is {found}, expected {expected}")]
    Request {
        /// The name of the value.
        what: &'static str,
        /// The value given.
        found: String,
        /// What is expected.
        expected: &'static str,
    },
    /// The start lies off the map, or has no elevation.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// A slice that is not a valid chain.
    #[error("heading {heading_deg} deg: {reason}")]
    Ground {
        /// Which slice.
        heading_deg: f64,
        /// Why.
        reason: Box<SliceProblem>,
    },
    /// A slice without nodes: too many, or a spacing that is no distance.
    #[error("heading {heading_deg} deg: {problem}")]
    Nodes {
        /// Which slice.
        heading_deg: f64,
        /// Why.
        problem: NodesError,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Analyses slices in all directions from one point, in parallel; the result does not depend on the number of threads.
///
/// A slice that leaves the map or meets no-data ends there. Reports every heading.
///
/// # Returns
/// One ray for each heading, `360 k / headings` degrees for k = 0, 1, ..
///
/// # Errors
/// [`FanError`]; of several, the one of the least heading.
pub fn fan(request: &FanRequest<'_>, progress: &dyn Progress) -> Result<Vec<FanRay>, FanError> {
    let rays: Vec<FanRay> = each(request, progress, ray)?;
    // No direction has ground, so the start has none.
    if rays.iter().all(|ray| ray.length_m == 0.0 && ray.end == Some(SliceEnd::NoData)) {
        return Err(TerrainError::NoData { at: request.from, distance_m: 0.0 }.into());
    }
    Ok(rays)
}

/// What the slices of a fan need: upper bounds, known before any hop is tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FanSize {
    /// The nodes of all slices.
    pub nodes: u64,
    /// The pairs of nodes on the same slice, in both directions.
    pub pairs_max: u64,
    /// The bytes of the elevations.
    pub elevations_bytes: u64,
    /// The bytes of the largest slice with its search, for each thread, and of all answers.
    pub slices_bytes: u64,
}

/// The size of a fan: cuts every slice and counts its nodes.
///
/// # Errors
/// As [`fan`].
pub fn fan_size(request: &FanRequest<'_>, progress: &dyn Progress) -> Result<FanSize, FanError> {
    let mut size = FanSize { nodes: 0, pairs_max: 0, elevations_bytes: 0, slices_bytes: 0 };
    let (mut largest, mut answers) = (0, 0);
    let counts = each(request, progress, |request, number, _| {
        let (chain, _) = slice_chain(request, number)?;
        let Some(chain) = chain else { return Ok((0, 0)) };
        let heading_deg = 360.0 * f64::from(number) / f64::from(request.headings);
        let start = chain.geometry().vertex_station(crate::quantity::VertexId(0));
        let set =
            NodeSet::new(&chain, start, start, request.spacing).map_err(|problem| FanError::Nodes { heading_deg, problem })?;
        Ok((set.stations().len() as u64, chain.geometry().segment_count() as u64))
    })?;
    for (nodes, segments) in counts {
        size.nodes += nodes;
        size.pairs_max = size.pairs_max.saturating_add(nodes.saturating_mul(nodes.saturating_sub(1)));
        largest = largest.max(nodes * NODE_BYTES + segments * SEGMENT_BYTES);
        answers += nodes * size_of::<HopBand>() as u64 * 2 + size_of::<FanRay>() as u64 * 3;
    }
    size.elevations_bytes = request.ground.terrain().dem().elevations_bytes();
    size.slices_bytes = largest.saturating_mul(rayon::current_num_threads() as u64).saturating_add(answers);
    Ok(size)
}

/// Bytes of a node on a slice, at most: its station twice, its landings in both directions under a tapered clearance, its labels and its
/// place in the queues of the search.
const NODE_BYTES: u64 = 768;

/// Bytes of a segment of a slice, at most: its profile, its chain and its limits in both directions.
const SEGMENT_BYTES: u64 = 1536;

/// Something for each heading, in parallel.
fn each<T: Send>(
    request: &FanRequest<'_>,
    progress: &dyn Progress,
    of: impl Fn(&FanRequest<'_>, u32, &Meter<'_>) -> Result<T, FanError> + Sync,
) -> Result<Vec<T>, FanError> {
    let FanRequest { headings, length_m, .. } = *request;
    let refused = |what, found: String, expected| Err(FanError::Request { what, found, expected });
    if headings == 0 || headings > 36_000 {
        return refused("headings", headings.to_string(), "a whole number from 1 to 36000");
    }
    if !(length_m.is_finite() && length_m > 0.0) {
        return refused("length", format!("{length_m} m"), "a finite length above 0 m");
    }
    if let Some(found) = request.ground.footprint_without_room() {
        return refused("hopper.footprint_m", found, "one that has room on the DEM: check its unit, or take a larger DEM");
    }
    let bounds = request.ground.terrain().dem().bounds();
    let inside = |value: f64, low: f64, high: f64| low <= value && value <= high;
    if !(inside(request.from.x, bounds.min.x, bounds.max.x) && inside(request.from.y, bounds.min.y, bounds.max.y)) {
        return Err(TerrainError::OffTheMap { which: "from", at: request.from, bounds }.into());
    }
    let meter = Meter::with_total(progress, Stage::Fan, u64::from(headings));
    meter.report(Detail::None)?;
    let one = |number| -> Result<T, FanError> {
        meter.check()?;
        let found = of(request, number, &meter)?;
        meter.complete_one()?;
        Ok(found)
    };
    let found: Vec<Result<T, FanError>> = (0..headings).into_par_iter().map(one).collect();
    meter.check()?;
    found.into_iter().collect()
}

/// The direction on the map (east, north) of a heading `360 number / of` degrees, exact along the axes.
pub fn heading_vector(number: u32, of: u32) -> Vector2<f64> {
    let (quarters, rest) = (4 * u64::from(number) / u64::from(of), 4 * u64::from(number) % u64::from(of));
    if rest == 0 {
        return [Vector2::new(0.0, 1.0), Vector2::new(1.0, 0.0), Vector2::new(0.0, -1.0), Vector2::new(-1.0, 0.0)]
            [usize::try_from(quarters % 4).unwrap_or(0)];
    }
    let angle = std::f64::consts::TAU * f64::from(number) / f64::from(of);
    Vector2::new(libm::sin(angle), libm::cos(angle))
}

/// One direction.
fn ray(request: &FanRequest<'_>, number: u32, meter: &Meter<'_>) -> Result<FanRay, FanError> {
    let heading_deg = 360.0 * f64::from(number) / f64::from(request.headings);
    let (chain, end) = slice_chain(request, number)?;
    let Some(chain) = chain else {
        let bands = Vec::new();
        return Ok(FanRay {
            heading_deg,
            length_m: 0.0,
            end,
            farthest_m: 0.0,
            hops_to_farthest: 0,
            hops_to_end: None,
            refusing: None,
            bands,
        });
    };
    let test = HopTest::new(chain);
    let start = test.chain().geometry().vertex_station(crate::quantity::VertexId(0));
    let found = reachable_nodes(&test, start, request.spacing, meter).map_err(|error| match error {
        SearchError::Nodes(problem) => FanError::Nodes { heading_deg, problem },
        // Reachable nodes are found without a risk.
        SearchError::Errors(problem) => {
            FanError::Request { what: problem.key(), found: problem.found(), expected: "errors that can be flown" }
        }
        SearchError::Cancelled(cancelled) => FanError::Cancelled(cancelled),
    })?;
    let farthest = found.nodes.iter().rev().find_map(|(station, hops)| Some((station.point.x_m, (*hops)?)));
    let (farthest_m, hops_to_farthest) = farthest.unwrap_or((0.0, 0));
    let nodes: Vec<(f64, Option<u64>)> = found.nodes.iter().map(|(station, hops)| (station.point.x_m, *hops)).collect();
    Ok(FanRay {
        heading_deg,
        length_m: test.chain().geometry().extent_m().1,
        end,
        farthest_m,
        hops_to_farthest,
        hops_to_end: nodes.last().and_then(|(_, hops)| *hops),
        refusing: found.refusing_ahead,
        bands: bands(&nodes),
    })
}

/// The slice of a heading as a chain, `None` without ground, and why it is short.
fn slice_chain(request: &FanRequest<'_>, number: u32) -> Result<(Option<ConstrainedChain>, Option<SliceEnd>), FanError> {
    let heading_deg = 360.0 * f64::from(number) / f64::from(request.headings);
    let (profile, end) = slice_ray(request, heading_vector(number, request.headings))?;
    let chain = profile.map(|profile| request.ground.chain_of(profile)).transpose();
    let chain = chain.map_err(|reason| FanError::Ground { heading_deg, reason: Box::new(reason) })?;
    Ok((chain, end))
}

/// Combines neighbouring nodes with the same number of hops into bands.
fn bands(nodes: &[(f64, Option<u64>)]) -> Vec<HopBand> {
    let mut found: Vec<HopBand> = Vec::new();
    let mut previous_m = 0.0;
    for &(x_m, hops) in nodes {
        match found.last_mut() {
            Some(last) if last.hops == hops => last.to_m = x_m,
            last => {
                let border_m = 0.5 * (previous_m + x_m);
                if let Some(last) = last {
                    last.to_m = border_m;
                }
                found.push(HopBand { from_m: border_m, to_m: x_m, hops });
            }
        }
        previous_m = x_m;
    }
    found
}

/// The slice in a direction up to the end of the ground, and what ended it; `None` if there is no ground at all.
fn slice_ray(request: &FanRequest<'_>, heading: Vector2<f64>) -> Result<(Option<Profile>, Option<SliceEnd>), TerrainError> {
    let (dem, from) = (request.ground.terrain().dem(), request.from);
    let bounds = dem.bounds();
    let room = |at: f64, step: f64, low: f64, high: f64| {
        if step > 0.0 {
            (high - at) / step
        } else if step < 0.0 {
            (low - at) / step
        } else {
            f64::INFINITY
        }
    };
    let to_border_m = room(from.x, heading.x, bounds.min.x, bounds.max.x).min(room(from.y, heading.y, bounds.min.y, bounds.max.y));
    let (length_m, end) =
        if to_border_m < request.length_m { (to_border_m, Some(SliceEnd::Border)) } else { (request.length_m, None) };
    let end_at = |along_m: f64| {
        let to = from + heading * along_m;
        MapPoint::new(to.x.clamp(bounds.min.x, bounds.max.x), to.y.clamp(bounds.min.y, bounds.max.y))
    };
    // A shorter slice has nothing to analyse.
    let least_m = 1e-6 * dem.georeference().step_m();
    if length_m <= least_m {
        return Ok((None, end));
    }
    let gap_m = match slice(dem, from, end_at(length_m)) {
        Ok(profile) => return Ok((Some(profile), end)),
        Err(TerrainError::NoData { distance_m, .. }) => distance_m,
        Err(other) => return Err(other),
    };
    // The last ground before the gap, by bisection: `slice` gives the position of the gap only to within a segment.
    let (mut ground_m, mut gap_m) = (0.0, gap_m.max(least_m));
    let mut whole = None;
    while gap_m - ground_m > least_m {
        let middle_m = 0.5 * (ground_m + gap_m);
        match slice(dem, from, end_at(middle_m)) {
            Ok(profile) => (ground_m, whole) = (middle_m, Some(profile)),
            Err(TerrainError::NoData { .. }) => gap_m = middle_m,
            Err(other) => return Err(other),
        }
    }
    Ok((whole, Some(SliceEnd::NoData)))
}
