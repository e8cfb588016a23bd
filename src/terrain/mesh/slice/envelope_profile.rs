//! Converts the upper envelope to a profile: refuses gaps, gives walls a run, and measures overlaps.

use nalgebra::Vector3;

use super::cut::{Cut, Plane, Segment, Upright};
use super::envelope::Piece;
use super::{Layers, MeshSlice, WALL_RUN_M, Wall};
use crate::quantity::{Angle, MapPoint};
use crate::terrain::{GapCause, Mesh, Profile, ProfileFacet, ProfilePoint, TerrainError};

/// The run of a wall as a fraction of the segment at its foot, at most; that segment may have a wall at its other end too.
const LARGEST_RUN: f64 = 0.25;

/// The first stretch of the transect without a triangle, in the direction of travel.
pub(super) fn first_gap(mesh: &Mesh, pieces: &[Piece], plane: &Plane, backwards: bool) -> Option<TerrainError> {
    let begins = pieces.iter().map(|piece| piece.x_m[0]).chain([plane.length_m]);
    let ends = [0.0].into_iter().chain(pieces.iter().map(|piece| piece.x_m[1]));
    let mut gaps: Vec<(f64, f64)> = ends.zip(begins).filter(|(end, begin)| end < begin).collect();
    if backwards {
        gaps.reverse();
    }
    let (low, high) = *gaps.first()?;
    let (begin, end) = if backwards { (high, low) } else { (low, high) };
    let from_start = |x_m: f64| if backwards { plane.length_m - x_m } else { x_m };
    Some(TerrainError::MeshGap {
        begin_m: from_start(begin),
        end_m: from_start(end),
        begin: plane.map_point(begin),
        end: plane.map_point(end),
        further: gaps.len() - 1,
        cause: cause_of_gap(mesh, plane, low, high),
    })
}

/// A transect that is this many times as long as the mesh is wide was probably given in another unit.
const UNIT_IN_DOUBT: f64 = 20.0;

/// A crack is narrower than this fraction of an edge of a triangle.
const NARROW: f64 = 0.1;

/// The likely cause of a stretch without a triangle.
fn cause_of_gap(mesh: &Mesh, plane: &Plane, low_m: f64, high_m: f64) -> GapCause {
    let bounds = mesh.bounds().map;
    let inside = |at: MapPoint| bounds.min.x <= at.x && at.x <= bounds.max.x && bounds.min.y <= at.y && at.y <= bounds.max.y;
    // A stretch at an end of the transect lies between no two triangles.
    let at_end = low_m <= 0.0 || high_m >= plane.length_m;
    if at_end || !inside(plane.map_point(0.5 * (low_m + high_m))) {
        let width_m = (bounds.max.x - bounds.min.x).max(bounds.max.y - bounds.min.y);
        let reach_m = [plane.first, plane.last].map(|at| at.x.abs().max(at.y.abs())).into_iter().fold(plane.length_m, f64::max);
        return GapCause::OffTheMesh { bounds, unit_in_doubt: reach_m > UNIT_IN_DOUBT * width_m };
    }
    if high_m - low_m < NARROW * mesh.median_edge_m() { GapCause::Crack } else { GapCause::Hole }
}

/// The stretches where the uppermost and the lowermost surface differ.
pub(super) fn layers(segments: &[Segment], upper: &[Piece], lower: &[Piece], apart_m: f64) -> Layers {
    let mut layers = Layers { places: 0, length_m: 0.0 };
    let mut breaks: Vec<f64> = upper.iter().chain(lower).flat_map(|piece| piece.x_m).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let (mut above, mut below) = (upper.iter().peekable(), lower.iter().peekable());
    let mut inside = false;
    for pair in breaks.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        while above.next_if(|piece| piece.x_m[1] < middle).is_some() {}
        while below.next_if(|piece| piece.x_m[1] < middle).is_some() {}
        let z_m = |piece: Option<&&Piece>| piece.map_or(f64::NAN, |piece| segments[piece.segment].z_at(middle));
        let several = z_m(above.peek()) - z_m(below.peek()) > apart_m;
        if several {
            layers.length_m += pair[1] - pair[0];
            layers.places += usize::from(!inside);
        }
        inside = several;
    }
    layers
}

/// The profile along the upper envelope under construction, from the plane's first end.
pub(super) struct EnvelopeProfile<'a> {
    plane: &'a Plane,
    cut: &'a Cut,
    /// A larger jump is a wall, m.
    jump_m: f64,
    points: Vec<ProfilePoint>,
    facets: Vec<ProfileFacet>,
    walls: Vec<Wall>,
}

impl<'a> EnvelopeProfile<'a> {
    /// Follows the pieces of the upper envelope, which must have no gaps.
    pub(super) fn new(plane: &'a Plane, cut: &'a Cut, upper: &[Piece], jump_m: f64) -> Self {
        let mut profile = Self { plane, cut, jump_m, points: Vec::new(), facets: Vec::new(), walls: Vec::new() };
        let pieces = profile.split_at_spikes(upper);
        let mut left: Option<&Piece> = None;
        for right in &pieces {
            profile.join(left, Some(right), right.x_m[0]);
            left = Some(right);
        }
        if let Some(last) = left {
            profile.join(Some(last), None, last.x_m[1]);
        }
        profile
    }

    /// Divides a piece where a thin wall stands on it.
    fn split_at_spikes(&self, upper: &[Piece]) -> Vec<Piece> {
        let mut pieces = Vec::with_capacity(upper.len());
        for &piece in upper {
            let mut rest = piece;
            let begin = self.cut.uprights.partition_point(|upright| upright.station.x_m <= piece.x_m[0]);
            for upright in &self.cut.uprights[begin..] {
                let x_m = upright.station.x_m;
                if x_m >= piece.x_m[1] {
                    break;
                }
                if x_m > rest.x_m[0] && upright.high_m > self.z_at(&piece, x_m) + self.jump_m {
                    pieces.push(Piece { x_m: [rest.x_m[0], x_m], ..piece });
                    rest.x_m[0] = x_m;
                }
            }
            pieces.push(rest);
        }
        pieces
    }

    fn z_at(&self, piece: &Piece, x_m: f64) -> f64 {
        self.cut.segments[piece.segment].z_at(x_m)
    }

    /// Adds the vertex between two pieces: the highest point there, with a foot on each side that is lower.
    fn join(&mut self, left: Option<&Piece>, right: Option<&Piece>, x_m: f64) {
        let standing = self.cut.uprights_at(x_m);
        let heights = [left, right].map(|piece| piece.map(|piece| self.z_at(piece, x_m)));
        let tops = standing.iter().map(|upright| upright.high_m).chain(heights.into_iter().flatten());
        let top_m = tops.fold(f64::NEG_INFINITY, f64::max);
        if let (Some(piece), Some(foot_m)) = (left, heights[0]) {
            self.facets.push(self.cut.segments[piece.segment].facet);
            if top_m - foot_m > self.jump_m {
                self.wall(piece, x_m, -1.0, [foot_m, top_m]);
            }
        }
        self.points.push(ProfilePoint { x_m, z_m: top_m, map: self.cut.map_point(x_m, self.plane) });
        if let (Some(piece), Some(foot_m)) = (right, heights[1])
            && top_m - foot_m > self.jump_m
        {
            self.wall(piece, x_m, 1.0, [foot_m, top_m]);
        }
    }

    /// Adds a wall's foot on a piece to the left (-1) or right (1) of the wall, and its facet.
    fn wall(&mut self, piece: &Piece, x_m: f64, towards: f64, [foot_m, top_m]: [f64; 2]) {
        let run_m = WALL_RUN_M.min(LARGEST_RUN * (piece.x_m[1] - piece.x_m[0]));
        let foot_x_m = x_m + towards * run_m;
        let z_m = self.z_at(piece, foot_x_m);
        self.points.push(ProfilePoint { x_m: foot_x_m, z_m, map: self.plane.map_point(foot_x_m) });
        let (facet, closed) = self.wall_facet(self.cut.uprights_at(x_m), [foot_m, top_m]);
        self.facets.push(facet);
        let map = self.cut.map_point(x_m, self.plane);
        self.walls.push(Wall { x_m, map, foot_m, top_m, run_m, closed });
    }

    /// The facet of a wall from foot to top: of the upright triangles there, the one with the largest cross-slope. If they do
    /// not reach from foot to top, nothing can stand there: 90 degrees.
    fn wall_facet(&self, standing: &[Upright], [foot_m, top_m]: [f64; 2]) -> (ProfileFacet, bool) {
        let mut reached_m = foot_m;
        let mut steepest: Option<ProfileFacet> = None;
        // In ascending order of height.
        for upright in standing {
            let overlaps = upright.high_m > foot_m + self.jump_m && upright.low_m < top_m - self.jump_m;
            if upright.low_m > reached_m + self.jump_m || !overlaps {
                continue;
            }
            reached_m = reached_m.max(upright.high_m);
            if steepest.is_none_or(|other| upright.facet.cross_slope > other.cross_slope) {
                steepest = Some(upright.facet);
            }
        }
        match steepest {
            Some(facet) if reached_m >= top_m - self.jump_m => (facet, true),
            _ => {
                let heading = self.plane.heading;
                let nothing = ProfileFacet {
                    normal: Vector3::new(-heading.y, heading.x, 0.0),
                    cross_slope: Angle::from_degrees(90.0),
                    keep_out: false,
                    friction: None,
                };
                (nothing, false)
            }
        }
    }

    /// The slice in the order of travel.
    pub(super) fn oriented(self, plane: &Plane, backwards: bool, layers: Layers) -> MeshSlice {
        let Self { mut points, mut facets, mut walls, .. } = self;
        let mut heading = plane.heading;
        if backwards {
            points.reverse();
            facets.reverse();
            walls.reverse();
            heading = -heading;
            let x_of_points = points.iter_mut().map(|point| &mut point.x_m);
            for x_m in x_of_points.chain(walls.iter_mut().map(|wall| &mut wall.x_m)) {
                *x_m = plane.length_m - *x_m;
            }
        }
        MeshSlice { profile: Profile { points, facets, heading }, layers, walls }
    }
}
