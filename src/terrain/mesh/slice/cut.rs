//! The intersection of the plane with the triangles.

use nalgebra::{Point3, Vector2};

use super::super::model::normal_of;
use crate::quantity::MapPoint;
use crate::terrain::{Mesh, ProfileFacet};

/// The vertical plane over a line on the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) first: MapPoint,
    pub(super) last: MapPoint,
    pub(super) heading: Vector2<f64>,
    pub(super) length_m: f64,
    pub(super) tolerance_m: f64,
}

impl Plane {
    /// The map point at a distance along it.
    pub(super) fn map_point(&self, x_m: f64) -> MapPoint {
        // Computed from the nearer end, so that each end is exact.
        if 2.0 * x_m <= self.length_m { self.first + self.heading * x_m } else { self.last - self.heading * (self.length_m - x_m) }
    }

    /// The distance along the plane and to its left of a vertex; the latter is 0 within the tolerance.
    fn place(&self, vertex: &Point3<f64>) -> Vector2<f64> {
        let away = vertex.xy() - self.first;
        let left = self.heading.perp(&away);
        Vector2::new(self.heading.dot(&away), if left.abs() <= self.tolerance_m { 0.0 } else { left })
    }
}

/// A station: a distance along the plane at which a segment begins or ends, and its map point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Station {
    pub(super) x_m: f64,
    pub(super) map: MapPoint,
}

/// The intersection of one triangle with the plane: a segment between two stations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) x_m: [f64; 2],
    pub(super) z_m: [f64; 2],
    pub(super) facet: ProfileFacet,
}

impl Segment {
    /// Elevation at a distance: the exact value at its ends, interpolated between them.
    pub(super) fn z_at(&self, x_m: f64) -> f64 {
        let ([x0, x1], [z0, z1]) = (self.x_m, self.z_m);
        if x_m == x0 {
            z0
        } else if x_m == x1 {
            z1
        } else {
            z0 + (x_m - x0) / (x1 - x0) * (z1 - z0)
        }
    }
}

/// The intersection of an upright triangle across the plane: a range of heights at one station.
#[derive(Clone, Copy, Debug)]
pub(super) struct Upright {
    pub(super) station: Station,
    pub(super) low_m: f64,
    pub(super) high_m: f64,
    pub(super) facet: ProfileFacet,
}

/// The whole intersection of a mesh with the plane.
#[derive(Debug)]
pub(super) struct Cut {
    pub(super) segments: Vec<Segment>,
    /// In the order of their stations.
    pub(super) uprights: Vec<Upright>,
    pub(super) stations: Vec<Station>,
}

/// An end of a raw segment, and whether it is a vertex of the mesh.
#[derive(Clone, Copy, Debug)]
struct End {
    x_m: f64,
    z_m: f64,
    map: Option<MapPoint>,
}

struct RawSegment {
    ends: [End; 2],
    facet: ProfileFacet,
}

impl Cut {
    pub(super) fn new(mesh: &Mesh, plane: &Plane) -> Self {
        let raw = raw_segments(mesh, plane);
        let stations = Stations::of(&raw, plane);
        let mut segments = Vec::new();
        let mut uprights = Vec::new();
        for RawSegment { ends: [begin, end], facet } in raw {
            let (from, to) = (stations.at(begin.x_m), stations.at(end.x_m));
            if from.x_m < to.x_m {
                segments.push(Segment { x_m: [from.x_m, to.x_m], z_m: [begin.z_m, end.z_m], facet });
            } else {
                uprights.push(Upright { station: from, low_m: begin.z_m.min(end.z_m), high_m: begin.z_m.max(end.z_m), facet });
            }
        }
        uprights.sort_by(|a, b| a.station.x_m.total_cmp(&b.station.x_m).then(a.low_m.total_cmp(&b.low_m)));
        Self { segments, uprights, stations: stations.stations }
    }

    /// The map point of a distance; that of the station, if the distance is one.
    pub(super) fn map_point(&self, x_m: f64, plane: &Plane) -> MapPoint {
        let index = self.stations.partition_point(|station| station.x_m < x_m);
        self.stations.get(index).filter(|station| station.x_m == x_m).map_or_else(|| plane.map_point(x_m), |station| station.map)
    }

    /// The upright triangles across the plane at a station.
    pub(super) fn uprights_at(&self, x_m: f64) -> &[Upright] {
        let begin = self.uprights.partition_point(|upright| upright.station.x_m < x_m);
        let end = self.uprights.partition_point(|upright| upright.station.x_m <= x_m);
        &self.uprights[begin..end]
    }
}

/// Intersects every triangle whose bounding interval across the plane contains it; ends are clipped to the transect.
fn raw_segments(mesh: &Mesh, plane: &Plane) -> Vec<RawSegment> {
    let places: Vec<Vector2<f64>> = mesh.vertices().iter().map(|vertex| plane.place(vertex)).collect();
    let (lowest, highest) = (-plane.tolerance_m, plane.length_m + plane.tolerance_m);
    let mut raw = Vec::new();
    for corners in mesh.indices() {
        let place = corners.map(|corner| places[corner as usize]);
        let all = |test: fn(&Vector2<f64>, f64) -> bool, limit| place.iter().all(|place| test(place, limit));
        let aside = all(|place, _| place.y > 0.0, 0.0) || all(|place, _| place.y < 0.0, 0.0);
        if aside || all(|place, limit| place.x < limit, lowest) || all(|place, limit| place.x > limit, highest) {
            continue;
        }
        let vertices = corners.map(|corner| mesh.vertices()[corner as usize]);
        cut_triangle(plane, vertices, place, &mut raw);
    }
    raw
}

/// Adds the segment of one triangle; for a triangle in the plane, its three edges.
fn cut_triangle(plane: &Plane, vertices: [Point3<f64>; 3], places: [Vector2<f64>; 3], raw: &mut Vec<RawSegment>) {
    let facet = ProfileFacet::from_normal(normal_of(vertices), plane.heading);
    let mut ends: Vec<End> = Vec::with_capacity(3);
    for (vertex, place) in vertices.iter().zip(&places) {
        if place.y == 0.0 {
            ends.push(End { x_m: place.x, z_m: vertex.z, map: Some(vertex.xy()) });
        }
    }
    for (one, other) in [(0, 1), (1, 2), (2, 0)] {
        let (left, right) = (places[one].y, places[other].y);
        if left != 0.0 && right != 0.0 && (left < 0.0) != (right < 0.0) {
            ends.push(crossing([(&vertices[one], places[one]), (&vertices[other], places[other])]));
        }
    }
    let pairs: &[(usize, usize)] = match ends.len() {
        2 => &[(0, 1)],
        3 => &[(0, 1), (1, 2), (2, 0)],
        _ => &[],
    };
    raw.extend(pairs.iter().filter_map(|&(one, other)| clipped(plane, [ends[one], ends[other]], facet)));
}

/// The point where an edge crosses the plane, with the same result for both triangles of the edge.
fn crossing(mut ends: [(&Point3<f64>, Vector2<f64>); 2]) -> End {
    let key = |vertex: &Point3<f64>| (vertex.x, vertex.y, vertex.z);
    if key(ends[1].0) < key(ends[0].0) {
        ends.swap(0, 1);
    }
    let [(a, place_a), (b, place_b)] = ends;
    let share = place_a.y / (place_a.y - place_b.y);
    End { x_m: place_a.x + share * (place_b.x - place_a.x), z_m: a.z + share * (b.z - a.z), map: None }
}

/// The part of a segment between the transect's ends, from left to right; `None` if it is empty.
fn clipped(plane: &Plane, [one, other]: [End; 2], facet: ProfileFacet) -> Option<RawSegment> {
    let (begin, end) = if (one.x_m, one.z_m) <= (other.x_m, other.z_m) { (one, other) } else { (other, one) };
    if end.x_m < -plane.tolerance_m || begin.x_m > plane.length_m + plane.tolerance_m {
        return None;
    }
    let line = Segment { x_m: [begin.x_m, end.x_m], z_m: [begin.z_m, end.z_m], facet };
    let clip = |place: End| {
        let x_m = place.x_m.clamp(0.0, plane.length_m);
        if (x_m - place.x_m).abs() <= plane.tolerance_m {
            End { x_m, ..place }
        } else {
            End { x_m, z_m: line.z_at(x_m), map: None }
        }
    };
    Some(RawSegment { ends: [clip(begin), clip(end)], facet })
}

/// Distances at which segments begin and end; those closer than the tolerance are merged.
struct Stations {
    /// The least distance merged into each station.
    begins: Vec<f64>,
    stations: Vec<Station>,
}

/// Which of several merged distances is kept: the one of highest rank.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Crossing,
    Vertex,
    End,
}

impl Stations {
    fn of(raw: &[RawSegment], plane: &Plane) -> Self {
        let mut places: Vec<(f64, Rank, MapPoint)> = vec![(0.0, Rank::End, plane.first), (plane.length_m, Rank::End, plane.last)];
        places.extend(raw.iter().flat_map(|segment| segment.ends).map(|end| match end.map {
            Some(map) => (end.x_m, Rank::Vertex, map),
            None => (end.x_m, Rank::Crossing, plane.map_point(end.x_m)),
        }));
        places.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut begins: Vec<f64> = Vec::new();
        let mut kept: Vec<(Rank, Station)> = Vec::new();
        for (x_m, rank, map) in places {
            let station = Station { x_m, map };
            match (begins.last(), kept.last_mut()) {
                (Some(begin), Some(last)) if x_m - begin <= plane.tolerance_m => {
                    if rank > last.0 {
                        *last = (rank, station);
                    }
                }
                _ => {
                    begins.push(x_m);
                    kept.push((rank, station));
                }
            }
        }
        Self { begins, stations: kept.into_iter().map(|(_, station)| station).collect() }
    }

    /// The station of a distance that was passed to [`Stations::of`].
    fn at(&self, x_m: f64) -> Station {
        let index = self.begins.partition_point(|begin| *begin <= x_m);
        self.stations[index.saturating_sub(1)]
    }
}
