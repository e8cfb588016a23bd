//! The line of a slice on the map, and vertices added where an overlay begins or ends on it.

use nalgebra::Vector2;

use crate::{
    quantity::MapPoint,
    terrain::{Profile, ProfilePoint},
};

/// A part of a line; distances in m from its beginning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch<T> {
    pub(super) from_m: f64,
    pub(super) to_m: f64,
    pub(super) value: T,
}

/// The straight line of a profile on the map.
///
/// Positions on it are measured from the end with the smaller map coordinates, for both directions of travel, so that the
/// reversed transect meets every border at the same position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// The end from which positions are measured.
    pub(super) origin: MapPoint,
    /// The other end.
    pub(super) end: MapPoint,
    /// Unit vector from the origin to the other end.
    pub(super) heading: Vector2<f64>,
    pub(super) length_m: f64,
    /// Positions closer than this are merged: some thousand times the rounding of the map coordinates.
    pub(super) tolerance_m: f64,
    backwards: bool,
}

/// The line's tolerance as a fraction of its largest map coordinate: 0.1 micrometres at 100 km.
const SAME_PLACE: f64 = 1e-12;

impl Line {
    /// The line of a profile; `None` for a profile without length.
    pub(super) fn of(profile: &Profile) -> Option<Self> {
        let (first, last) = (profile.points.first()?.map, profile.points.last()?.map);
        let backwards = (last.x, last.y) < (first.x, first.y);
        let (origin, end) = if backwards { (last, first) } else { (first, last) };
        let along = end - origin;
        let length_m = profile.length_m();
        let span_m = libm::hypot(along.x, along.y);
        let largest_m = [origin.x, origin.y, end.x, end.y, length_m].into_iter().map(f64::abs).fold(0.0, f64::max);
        (span_m > 0.0).then(|| Self {
            origin,
            end,
            heading: along / span_m,
            length_m,
            tolerance_m: SAME_PLACE * largest_m,
            backwards,
        })
    }

    /// A map point in the line's own frame: the distance along it from the origin, and to its left, m.
    pub(super) fn frame(&self, point: MapPoint) -> Vector2<f64> {
        let away = point - self.origin;
        Vector2::new(away.dot(&self.heading), self.heading.x * away.y - self.heading.y * away.x)
    }

    /// The map point at a distance along the line; exact at both ends.
    pub(super) fn map_point(&self, along_m: f64) -> MapPoint {
        let share = along_m / self.length_m;
        MapPoint::from(self.origin.coords * (1.0 - share) + self.end.coords * share)
    }

    /// The profile's x of a position on the line. The same formula converts back.
    pub(super) fn profile_x_m(&self, along_m: f64) -> f64 {
        if self.backwards { self.length_m - along_m } else { along_m }
    }

    /// Adds vertices where stretches with different values meet, and passes every segment its value.
    ///
    /// The stretches cover the line without gaps. A border within the tolerance of a vertex is moved to that vertex.
    pub(super) fn lay<T: Copy + PartialEq>(
        &self,
        profile: &mut Profile,
        stretches: &[Stretch<T>],
        mut visit: impl FnMut(&mut Profile, usize, T),
    ) {
        let mut stretches: Vec<Stretch<T>> = joined(stretches);
        if self.backwards {
            stretches.reverse();
            for stretch in &mut stretches {
                (stretch.from_m, stretch.to_m) = (self.profile_x_m(stretch.to_m), self.profile_x_m(stretch.from_m));
            }
        }
        let borders: Vec<f64> = stretches.iter().skip(1).map(|stretch| self.vertex_at(profile, stretch.from_m)).collect();
        let mut current = 0;
        for segment in 0..profile.facets.len() {
            let x_m = profile.points[segment].x_m;
            while borders.get(current).is_some_and(|&border_m| border_m <= x_m) {
                current += 1;
            }
            if let Some(stretch) = stretches.get(current) {
                visit(profile, segment, stretch.value);
            }
        }
    }

    /// The x of the vertex at a position, which is added if missing.
    fn vertex_at(&self, profile: &mut Profile, x_m: f64) -> f64 {
        let next = profile.points.partition_point(|point| point.x_m < x_m).clamp(1, profile.points.len() - 1);
        let (before, after) = (profile.points[next - 1], profile.points[next]);
        let (since_m, until_m) = (x_m - before.x_m, after.x_m - x_m);
        if since_m.min(until_m) <= self.tolerance_m {
            return if since_m <= until_m { before.x_m } else { after.x_m };
        }
        let slope = (after.z_m - before.z_m) / (after.x_m - before.x_m);
        // Computed from the nearer vertex, which keeps more digits.
        let z_m = if since_m <= until_m { before.z_m + slope * since_m } else { after.z_m - slope * until_m };
        profile.points.insert(next, ProfilePoint { x_m, z_m, map: self.map_point(self.profile_x_m(x_m)) });
        profile.facets.insert(next, profile.facets[next - 1]);
        x_m
    }
}

/// Merges neighbouring stretches with equal values.
fn joined<T: Copy + PartialEq>(stretches: &[Stretch<T>]) -> Vec<Stretch<T>> {
    let mut found: Vec<Stretch<T>> = Vec::new();
    for stretch in stretches {
        match found.last_mut() {
            Some(last) if last.value == stretch.value => last.to_m = stretch.to_m,
            _ => found.push(*stretch),
        }
    }
    found
}

/// Converts covered parts of a line, in any order and overlapping, to stretches that cover the whole line.
///
/// Parts no longer than the tolerance are ignored, and gaps no longer than it are closed.
pub(super) fn covered(line: &Line, mut parts: Vec<(f64, f64)>) -> Vec<Stretch<bool>> {
    for part in &mut parts {
        *part = (part.0.max(0.0), part.1.min(line.length_m));
    }
    parts.retain(|part| part.1 - part.0 > line.tolerance_m);
    parts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<(f64, f64)> = Vec::new();
    for part in parts {
        match merged.last_mut() {
            Some(last) if part.0 <= last.1 + line.tolerance_m => last.1 = last.1.max(part.1),
            _ => merged.push(part),
        }
    }
    let mut stretches = Vec::new();
    let mut here_m = 0.0;
    for (from_m, to_m) in merged {
        let from_m = if from_m <= line.tolerance_m { 0.0 } else { from_m };
        let to_m = if line.length_m - to_m <= line.tolerance_m { line.length_m } else { to_m };
        if from_m > here_m {
            stretches.push(Stretch { from_m: here_m, to_m: from_m, value: false });
        }
        stretches.push(Stretch { from_m, to_m, value: true });
        here_m = to_m;
    }
    if here_m < line.length_m {
        stretches.push(Stretch { from_m: here_m, to_m: line.length_m, value: false });
    }
    stretches
}
