//! The terrain limit of a hop over a chain.

use crate::{
    ballistics::{
        Arc, LineOfSight,
        limits::{ClearanceProfile, clearing_loft},
    },
    chain::{PolygonalChain, Site, Station},
    quantity::{SlopeInterval, VertexId},
    world::Direction,
};

/// Where the ground sets the least loft of a hop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TerrainPoint {
    /// At a vertex flown over.
    Vertex(VertexId),
    /// At a kink of the tapered clearance between vertices, at this x, m along the chain.
    Kink(f64),
}

/// The lofts that keep the clearance over the ground flown over, and the point that sets the bound.
///
/// ```text
///     n >= max over vertices p of  s_p - t_p                                   (P eq. 14; see clearing_loft)
///     n >= (h / w + k) X / (X - w)   at both kinks of a tapered clearance      (see ClearanceProfile::kink_loft)
/// ```
///
/// These points are sufficient: between them the arc is concave, and the ground with its clearance straight.
///
/// # Returns
/// An interval without upper bound, and the point that sets its lower bound; no lower bound and no point if no vertex is flown
/// over and no taper limits the hop.
///
/// # Complexity
/// Two divisions per vertex flown over.
pub fn terrain_limit(
    chain: &PolygonalChain,
    takeoff: &Station,
    landing: &Station,
    sight: LineOfSight,
    clearance: ClearanceProfile,
) -> (SlopeInterval, Option<TerrainPoint>) {
    let mut highest = (f64::NEG_INFINITY, None);
    for i in flown_past(takeoff, landing) {
        let loft = clearing_loft(takeoff.point, landing.point, chain.vertices()[i], clearance);
        if loft > highest.0 {
            highest = (loft, Some(TerrainPoint::Vertex(VertexId(i))));
        }
    }
    if let Some(direction) = Direction::between(takeoff.point.x_m, landing.point.x_m).filter(|_| clearance.has_kinks()) {
        let inwards_m = direction.sign() * clearance.kink_m(sight.run_m());
        let [from, to] = over_sight(chain, takeoff, landing, sight, clearance);
        for (over, x_m) in [(from, takeoff.point.x_m + inwards_m), (to, landing.point.x_m - inwards_m)] {
            let loft = clearance.kink_loft(over, sight.run_m());
            if loft > highest.0 {
                highest = (loft, Some(TerrainPoint::Kink(x_m)));
            }
        }
    }
    (SlopeInterval { lower: highest.0, upper: f64::INFINITY }, highest.1)
}

/// How much higher an arc flies than the clearance asks for, at the point where that is least: the height, m, and the horizontal
/// distance of the point from the take-off, m. `None` where [`terrain_limit`] has no point.
///
/// ```text
///     (n - n_p) d e / X     over a point that asks for the loft n_p
/// ```
///
/// From the lofts of the limit itself, so that an arc that keeps the limit has no negative margin by rounding. Between the points the
/// margin is greater than at one of its neighbours.
pub(super) fn least_height(
    chain: &PolygonalChain,
    takeoff: &Station,
    landing: &Station,
    arc: &Arc,
    clearance: ClearanceProfile,
) -> Option<(f64, f64)> {
    let (sight, loft) = (arc.line_of_sight(), arc.loft());
    let run_m = sight.run_m();
    let mut least: Option<(f64, f64)> = None;
    let mut add = |asked: f64, distance_m: f64| {
        let height_m = (loft - asked) * (distance_m * ((run_m - distance_m) / run_m));
        if least.is_none_or(|(least_m, _)| height_m < least_m) {
            least = Some((height_m, distance_m));
        }
    };
    for vertex in &chain.vertices()[flown_past(takeoff, landing)] {
        add(clearing_loft(takeoff.point, landing.point, *vertex, clearance), (vertex.x_m - takeoff.point.x_m).abs());
    }
    if clearance.has_kinks() {
        let kink_m = clearance.kink_m(run_m);
        let [from, to] = over_sight(chain, takeoff, landing, sight, clearance);
        add(clearance.kink_loft(from, run_m), kink_m);
        add(clearance.kink_loft(to, run_m), run_m - kink_m);
    }
    least
}

/// The least loft that both kinks of a tapered clearance ask for.
#[inline]
pub(crate) fn kinks_loft(
    chain: &PolygonalChain,
    takeoff: &Station,
    landing: &Station,
    sight: LineOfSight,
    clearance: ClearanceProfile,
) -> f64 {
    let [from, to] = over_sight(chain, takeoff, landing, sight, clearance);
    clearance.kink_loft(if to > from { to } else { from }, sight.run_m())
}

/// The slope of the ground at each kink, seen from its contact and away from it, over that of the line of sight.
///
/// On one segment both are zero, without rounding.
fn over_sight(
    chain: &PolygonalChain,
    takeoff: &Station,
    landing: &Station,
    sight: LineOfSight,
    clearance: ClearanceProfile,
) -> [f64; 2] {
    let forward = landing.point.x_m > takeoff.point.x_m;
    let (ahead, back) = if forward { (Direction::Forward, Direction::Reverse) } else { (Direction::Reverse, Direction::Forward) };
    let kink_m = clearance.kink_m(sight.run_m());
    [ground_slope(chain, takeoff, ahead, kink_m) - sight.slope(), sight.slope() + ground_slope(chain, landing, back, kink_m)]
}

/// The slope from a station to the ground at a distance from it, seen in a direction. The chain must reach so far.
pub(crate) fn ground_slope(chain: &PolygonalChain, station: &Station, towards: Direction, distance_m: f64) -> f64 {
    let (vertices, x_m) = (chain.vertices(), station.point.x_m);
    let first = first_ahead(station, towards);
    let next = match towards {
        Direction::Forward => {
            let nearer = vertices.get(first..).map_or(0, |ahead| ahead.partition_point(|v| v.x_m - x_m < distance_m));
            (first + nearer).min(vertices.len() - 1)
        }
        Direction::Reverse => vertices[..=first].partition_point(|v| x_m - v.x_m >= distance_m).saturating_sub(1),
    };
    slope_beyond(chain, station, towards, (first, next), distance_m)
}

/// The first vertex ahead of a station in a direction; at the end of the chain, the end itself.
#[inline]
pub(crate) fn first_ahead(station: &Station, towards: Direction) -> usize {
    match (station.site, towards) {
        (Site::Vertex(vertex), Direction::Forward) => vertex.index() + 1,
        (Site::Vertex(vertex), Direction::Reverse) => vertex.index().saturating_sub(1),
        (Site::Inside(segment), Direction::Forward) => segment.index() + 1,
        (Site::Inside(segment), Direction::Reverse) => segment.index(),
    }
}

/// [`ground_slope`] with the first vertex ahead of the station, and the first at or beyond the distance, already known.
///
/// On the first segment it is that segment's stored slope, which has more digits than a difference of heights.
#[inline]
pub(crate) fn slope_beyond(
    chain: &PolygonalChain,
    station: &Station,
    towards: Direction,
    (first, next): (usize, usize),
    distance_m: f64,
) -> f64 {
    let (segment, before) = match towards {
        Direction::Forward => (next.saturating_sub(1), next.saturating_sub(1)),
        Direction::Reverse => (next, next + 1),
    };
    let Some(slope) = chain.slopes().get(segment).map(|slope| towards.sign() * slope) else { return 0.0 };
    if next == first {
        return slope;
    }
    let (near, far) = (chain.vertices()[before], chain.vertices()[next]);
    let (near_m, far_m) = ((near.x_m - station.point.x_m).abs(), (far.x_m - station.point.x_m).abs());
    // From the nearer vertex, which keeps more digits.
    let rise_m = if distance_m - near_m <= far_m - distance_m {
        (near.z_m - station.point.z_m) + slope * (distance_m - near_m)
    } else {
        (far.z_m - station.point.z_m) - slope * (far_m - distance_m)
    };
    rise_m / distance_m
}

/// The indices of the vertices strictly between two stations, in either order.
#[inline]
pub(crate) fn flown_past(a: &Station, b: &Station) -> std::ops::Range<usize> {
    let (left, right) = if a.point.x_m <= b.point.x_m { (a.site, b.site) } else { (b.site, a.site) };
    Site::vertices_between(left, right)
}
