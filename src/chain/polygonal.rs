//! The chain's geometry, validated at construction.

use std::fmt;

use super::{ChainLayers, GroundForm, OffChain, SegmentGround, Site, Station};
use crate::{
    quantity::{ChainPoint, MapPoint, SegmentId, VertexId},
    terrain::{MapLayers, Profile, ProfilePoint},
    world::{Derating, Direction, FrictionCone, LayerName},
};

/// A validated polygonal chain: at least two finite vertices, x strictly increasing, and a ground for every segment.
#[derive(Clone, Debug, PartialEq)]
pub struct PolygonalChain {
    vertices: Vec<ChainPoint>,
    /// Slope dz/dx of each segment.
    slopes: Vec<f64>,
    grounds: Vec<SegmentGround>,
    map: Option<Vec<MapPoint>>,
    /// Vertices where the plane of travel turns, in ascending order.
    bends: Vec<VertexId>,
    /// The layers of the map, if it has any.
    layers: Option<ChainLayers>,
}

/// One problem of a chain.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ChainProblem {
    /// Fewer than two vertices.
    TooFewVertices {
        /// Number of vertices given.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    NotFinite {
        /// The vertex.
        vertex: VertexId,
    },
    /// The x of a vertex is not greater than that of the vertex before.
    NotIncreasing {
        /// The vertex.
        vertex: VertexId,
        /// Its x, m.
        x_m: f64,
        /// The x of the vertex before, m.
        before_m: f64,
    },
    /// A segment is so steep that its slope overflows.
    Vertical {
        /// The segment.
        segment: SegmentId,
    },
    /// A bend is not an inner vertex.
    BendAtEnd {
        /// The vertex.
        vertex: VertexId,
    },
    /// A stated limit of a segment that is not a number, or a cross-slope beyond the vertical.
    NotALimit {
        /// Which segment.
        segment: SegmentId,
        /// Of what, with its unit.
        what: &'static str,
        /// What was found.
        found: f64,
    },
    /// The numbers of grounds and segments, or of map points and vertices, differ.
    CountMismatch {
        /// What was counted.
        what: &'static str,
        /// Number given.
        found: usize,
        /// Number needed.
        expected: usize,
    },
}

impl fmt::Display for ChainProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewVertices { count } => write!(f, "a chain of {count} vertices, expected at least 2"),
            Self::NotFinite { vertex } => write!(f, "vertex {} has a coordinate that is not a finite number", vertex.index() + 1),
            Self::NotIncreasing { vertex, x_m, before_m } => {
                write!(f, "vertex {} has x = {x_m} m, expected more than the {before_m} m of the vertex before", vertex.index() + 1)
            }
            Self::Vertical { segment } => {
                write!(f, "segment {} is too steep for its slope to be a number: move its vertices apart", segment.index() + 1)
            }
            Self::BendAtEnd { vertex } => {
                write!(
                    f,
                    "vertex {} is marked as a bend, expected bends only between the first and the last vertex",
                    vertex.index() + 1
                )
            }
            Self::NotALimit { segment, what, found } => {
                write!(
                    f,
                    "segment {} has a {what} of {found}, expected a number, no cross-slope beyond 90 degrees",
                    segment.index() + 1
                )
            }
            Self::CountMismatch { what, found, expected } => write!(f, "{found} {what}, expected {expected}"),
        }
    }
}

/// All problems of a chain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct InvalidChain(pub Vec<ChainProblem>);

impl PolygonalChain {
    /// A chain from its vertices, one ground per segment, and (optionally) one map point per vertex.
    ///
    /// # Errors
    /// [`InvalidChain`] with every problem.
    pub fn new(vertices: Vec<ChainPoint>, grounds: Vec<SegmentGround>, map: Option<Vec<MapPoint>>) -> Result<Self, InvalidChain> {
        let mut problems = Vec::new();
        if vertices.len() < 2 {
            problems.push(ChainProblem::TooFewVertices { count: vertices.len() });
        }
        for (i, v) in vertices.iter().enumerate() {
            if !(v.x_m.is_finite() && v.z_m.is_finite()) {
                problems.push(ChainProblem::NotFinite { vertex: VertexId(i) });
            }
        }
        let mut slopes = Vec::with_capacity(vertices.len().saturating_sub(1));
        for (i, pair) in vertices.windows(2).enumerate() {
            let [a, b] = pair else { continue };
            let slope = (b.z_m - a.z_m) / (b.x_m - a.x_m);
            if b.x_m <= a.x_m {
                problems.push(ChainProblem::NotIncreasing { vertex: VertexId(i + 1), x_m: b.x_m, before_m: a.x_m });
            } else if !slope.is_finite() && [a.x_m, a.z_m, b.x_m, b.z_m].iter().all(|c| c.is_finite()) {
                problems.push(ChainProblem::Vertical { segment: SegmentId(i) });
            }
            slopes.push(slope);
        }
        if grounds.len() != slopes.len() {
            problems.push(ChainProblem::CountMismatch { what: "grounds", found: grounds.len(), expected: slopes.len() });
        }
        for (i, ground) in grounds.iter().enumerate() {
            if let Some((what, found)) = ground.not_a_limit() {
                problems.push(ChainProblem::NotALimit { segment: SegmentId(i), what, found });
            }
        }
        if let Some(points) = &map {
            if points.len() != vertices.len() {
                problems.push(ChainProblem::CountMismatch { what: "map points", found: points.len(), expected: vertices.len() });
            }
            for (i, p) in points.iter().enumerate() {
                if !(p.x.is_finite() && p.y.is_finite()) {
                    problems.push(ChainProblem::NotFinite { vertex: VertexId(i) });
                }
            }
        }
        if problems.is_empty() {
            Ok(Self { vertices, slopes, grounds, map, bends: Vec::new(), layers: None })
        } else {
            Err(InvalidChain(problems))
        }
    }

    /// A chain of bare vertices: constraints come from the scenario.
    ///
    /// # Errors
    /// [`InvalidChain`] with every problem.
    ///
    /// # Examples
    /// ```
    /// use chta::{chain::PolygonalChain, quantity::ChainPoint};
    /// let chain = PolygonalChain::bare(vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(2.0, 1.0)]).unwrap();
    /// assert_eq!(chain.slopes(), [0.5]);
    /// ```
    pub fn bare(vertices: Vec<ChainPoint>) -> Result<Self, InvalidChain> {
        let grounds = vec![SegmentGround::BARE; vertices.len().saturating_sub(1)];
        Self::new(vertices, grounds, None)
    }

    /// A chain from a slice of the terrain: cross-slopes and keep-out come from its facets, friction from them or from
    /// `friction`, map points from the slice.
    ///
    /// # Errors
    /// [`InvalidChain`]; does not occur for a slice of valid terrain.
    pub fn from_profile(profile: &Profile, friction: Option<FrictionCone>) -> Result<Self, InvalidChain> {
        let vertices = profile.points.iter().map(|p| ChainPoint::new(p.x_m, p.z_m)).collect();
        let grounds = profile
            .facets
            .iter()
            .map(|facet| SegmentGround {
                form: GroundForm::Surface { friction: facet.friction.or(friction), cross_slope: facet.cross_slope },
                keep_out: facet.keep_out,
            })
            .collect();
        let map = profile.points.iter().map(|p| p.map).collect();
        Self::new(vertices, grounds, Some(map))
    }

    /// A chain from consecutive slices, each beginning where the one before ends. There is a bend at each joint where the
    /// heading changes by more than 1e-9 rad.
    ///
    /// # Errors
    /// [`InvalidChain`]; for slices of valid terrain it only occurs if `legs` is empty.
    pub fn from_legs(legs: &[Profile], friction: Option<FrictionCone>) -> Result<Self, InvalidChain> {
        let mut joined = Profile { points: Vec::new(), facets: Vec::new(), heading: nalgebra::Vector2::zeros() };
        let mut bends = Vec::new();
        let mut heading = None;
        for leg in legs {
            let begin_m = joined.length_m();
            let turns = |before: nalgebra::Vector2<f64>| before.perp(&leg.heading).abs() > 1e-9 || before.dot(&leg.heading) < 0.0;
            if heading.is_some_and(turns) {
                bends.push(VertexId(joined.points.len() - 1));
            }
            heading = Some(leg.heading);
            // The point where two slices meet becomes one vertex.
            let shared = usize::from(!joined.points.is_empty());
            joined.points.extend(leg.points.iter().skip(shared).map(|point| ProfilePoint { x_m: begin_m + point.x_m, ..*point }));
            joined.facets.extend(&leg.facets);
        }
        Self::from_profile(&joined, friction)?.with_bends(bends)
    }

    /// The same chain with bends: vertices where the vertical plane of travel turns, which no hop may span.
    ///
    /// # Errors
    /// [`InvalidChain`] if a bend is not an inner vertex.
    pub fn with_bends(mut self, mut bends: Vec<VertexId>) -> Result<Self, InvalidChain> {
        bends.sort_unstable();
        bends.dedup();
        let inner = 1..self.segment_count();
        let wrong: Vec<_> =
            bends.iter().filter(|v| !inner.contains(&v.index())).map(|&vertex| ChainProblem::BendAtEnd { vertex }).collect();
        if !wrong.is_empty() {
            return Err(InvalidChain(wrong));
        }
        self.bends = bends;
        Ok(self)
    }

    /// The same chain under the layers of its map; without map coordinates they have no effect.
    #[must_use]
    pub fn with_layers(mut self, layers: &MapLayers) -> Self {
        let under = |map: &Vec<MapPoint>| ChainLayers::under(layers, &self.vertices, map);
        self.layers = self.map.as_ref().filter(|_| !layers.is_empty()).map(under);
        self
    }

    /// The same chain with shares of the speeds and frictions that its segments state.
    #[must_use]
    pub fn derated(mut self, derating: &Derating) -> Self {
        for ground in &mut self.grounds {
            match &mut ground.form {
                GroundForm::Surface { friction, .. } => *friction = friction.map(|cone| derating.cone(cone)),
                GroundForm::Explicit { forward, reverse } => {
                    for line in [forward, reverse] {
                        *line = line.map(|line| line.derated(derating));
                    }
                }
            }
        }
        self
    }

    /// The vertices where the plane of travel turns, in ascending order.
    pub fn bends(&self) -> &[VertexId] {
        &self.bends
    }

    /// The first bend, in the order of the chain, strictly between two x; `None` if a hop between them spans none.
    #[inline]
    pub fn bend_between(&self, a_m: f64, b_m: f64) -> Option<VertexId> {
        if self.bends.is_empty() {
            return None;
        }
        let (low_m, high_m) = (a_m.min(b_m), a_m.max(b_m));
        let next = self.bends.partition_point(|v| self.vertices[v.index()].x_m <= low_m);
        self.bends.get(next).copied().filter(|v| self.vertices[v.index()].x_m < high_m)
    }

    /// The x of the next bend in a direction, strictly beyond `x_m`; `None` if no bend follows.
    #[inline]
    pub fn next_bend_m(&self, x_m: f64, direction: Direction) -> Option<f64> {
        let at = |vertex: &VertexId| self.vertices[vertex.index()].x_m;
        match direction {
            Direction::Forward => self.bends.get(self.bends.partition_point(|v| at(v) <= x_m)).map(at),
            Direction::Reverse => self.bends[..self.bends.partition_point(|v| at(v) < x_m)].last().map(at),
        }
    }

    /// The layer that refuses every contact at an x, if one does.
    #[inline]
    pub fn layer_refusing_contact(&self, x_m: f64) -> Option<LayerName> {
        self.layers.as_ref()?.refusing_contact(x_m)
    }

    /// The layer that refuses every flight between two x, if one does.
    #[inline]
    pub fn layer_refusing_flight(&self, a_m: f64, b_m: f64) -> Option<LayerName> {
        self.layers.as_ref()?.refusing_flight(a_m, b_m)
    }

    /// The layers of the map under it.
    pub(crate) const fn layers(&self) -> Option<&ChainLayers> {
        self.layers.as_ref()
    }

    /// The vertices, in the direction of +x.
    pub fn vertices(&self) -> &[ChainPoint] {
        &self.vertices
    }

    /// The slope dz/dx of each segment.
    pub fn slopes(&self) -> &[f64] {
        &self.slopes
    }

    /// The ground of each segment.
    pub fn grounds(&self) -> &[SegmentGround] {
        &self.grounds
    }

    /// The map coordinates of the vertices.
    pub fn map_points(&self) -> Option<&[MapPoint]> {
        self.map.as_deref()
    }

    /// The number of segments.
    pub fn segment_count(&self) -> usize {
        self.slopes.len()
    }

    /// The x of the first and of the last vertex, m.
    pub fn extent_m(&self) -> (f64, f64) {
        (self.vertices[0].x_m, self.vertices[self.vertices.len() - 1].x_m)
    }

    /// The station at `x_m`: at a vertex if x is the same double, else inside a segment.
    ///
    /// # Errors
    /// [`OffChain`] outside the chain, and for NaN.
    pub fn station(&self, x_m: f64) -> Result<Station, OffChain> {
        let (first_x_m, last_x_m) = self.extent_m();
        if !(first_x_m <= x_m && x_m <= last_x_m) {
            return Err(OffChain { x_m, first_x_m, last_x_m });
        }
        // The first vertex at or beyond x.
        let next = self.vertices.partition_point(|v| v.x_m < x_m);
        if self.vertices[next].x_m == x_m {
            return Ok(self.vertex_station(VertexId(next)));
        }
        Ok(self.station_inside(SegmentId(next - 1), x_m))
    }

    /// The station at an `x_m` strictly between the ends of a segment.
    pub(crate) fn station_inside(&self, segment: SegmentId, x_m: f64) -> Station {
        Station { point: self.point_inside(segment, x_m), site: Site::Inside(segment) }
    }

    /// The station at a vertex.
    ///
    /// # Panics
    /// Panics if the chain has no such vertex.
    pub fn vertex_station(&self, vertex: VertexId) -> Station {
        Station { point: self.vertices[vertex.index()], site: Site::Vertex(vertex) }
    }

    /// The point at `x_m` on the (extended) line of a segment, computed from the nearer vertex to keep digits.
    fn point_inside(&self, segment: SegmentId, x_m: f64) -> ChainPoint {
        let (a, b) = (self.vertices[segment.index()], self.vertices[segment.index() + 1]);
        let slope = self.slopes[segment.index()];
        let z_m = if x_m - a.x_m <= b.x_m - x_m { a.z_m + slope * (x_m - a.x_m) } else { b.z_m - slope * (b.x_m - x_m) };
        ChainPoint::new(x_m, z_m)
    }

    /// The map point of a station, by linear interpolation between its segment's ends; `None` if the chain has no map
    /// coordinates.
    pub fn map_point(&self, station: &Station) -> Option<MapPoint> {
        let map = self.map.as_deref()?;
        Some(match station.site {
            Site::Vertex(vertex) => map[vertex.index()],
            Site::Inside(segment) => {
                let i = segment.index();
                let (a, b) = (self.vertices[i].x_m, self.vertices[i + 1].x_m);
                map[i] + (map[i + 1] - map[i]) * ((station.point.x_m - a) / (b - a))
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(points: &[(f64, f64)]) -> Result<PolygonalChain, InvalidChain> {
        PolygonalChain::bare(points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect())
    }

    #[test]
    fn limits_that_are_not_numbers_are_refused() {
        use crate::{
            chain::{ContactRule, GroundForm, LineConstraints},
            quantity::{Angle, AngleInterval},
        };
        let refused = |form| {
            let vertices = vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(1.0, 0.0)];
            let made = PolygonalChain::new(vertices, vec![SegmentGround { form, keep_out: false }], None);
            made.err().is_some_and(|InvalidChain(problems)| matches!(problems.as_slice(), [ChainProblem::NotALimit { .. }]))
        };
        let explicit = |min, max, speed| {
            let rule = ContactRule::new(AngleInterval::from_degrees(min, max), speed);
            GroundForm::Explicit { forward: Some(LineConstraints { takeoff: rule, landing: rule }), reverse: None }
        };
        assert!(!refused(explicit(10.0, 80.0, 5.0)));
        assert!(!refused(explicit(80.0, 10.0, 5.0)), "an empty cone is a limit: it refuses every hop");
        for (min, max, speed) in [(f64::NAN, 80.0, 5.0), (10.0, f64::NAN, 5.0), (10.0, 80.0, f64::NAN)] {
            assert!(refused(explicit(min, max, speed)), "{min} to {max} deg, {speed} m/s");
        }
        for degrees in [f64::NAN, f64::INFINITY, 90.1, -91.0] {
            let cross_slope = Angle::from_degrees(degrees);
            assert!(refused(GroundForm::Surface { friction: None, cross_slope }), "cross-slope {degrees} deg");
        }
    }

    #[test]
    fn every_problem_is_reported_at_once() {
        let InvalidChain(problems) = chain(&[(0.0, 0.0), (0.0, 1.0), (f64::NAN, 0.0), (3.0, f64::INFINITY)]).unwrap_err();
        assert!(problems.contains(&ChainProblem::NotFinite { vertex: VertexId(2) }), "{problems:?}");
        assert!(problems.contains(&ChainProblem::NotFinite { vertex: VertexId(3) }), "{problems:?}");
        assert!(problems.contains(&ChainProblem::NotIncreasing { vertex: VertexId(1), x_m: 0.0, before_m: 0.0 }), "{problems:?}");
        assert!(chain(&[(0.0, 0.0)]).is_err(), "one vertex is not a chain");
        assert!(chain(&[]).is_err(), "an empty list is not a chain");
    }

    #[test]
    fn a_wall_whose_slope_overflows_is_refused() {
        let InvalidChain(problems) = chain(&[(0.0, 0.0), (f64::MIN_POSITIVE, 1e10)]).unwrap_err();
        assert_eq!(problems, [ChainProblem::Vertical { segment: SegmentId(0) }]);
    }

    #[test]
    fn stations_are_vertices_only_where_x_is_the_same_double() {
        let c = chain(&[(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)]).unwrap();
        assert_eq!(c.station(1.0).unwrap().site, Site::Vertex(VertexId(1)));
        assert_eq!(c.station(1.0f64.next_up()).unwrap().site, Site::Inside(SegmentId(1)));
        assert_eq!(c.station(1.0f64.next_down()).unwrap().site, Site::Inside(SegmentId(0)));
        assert_eq!(c.station(0.5).unwrap().point.z_m, 0.5);
        assert!(c.station(-0.1).is_err() && c.station(2.1).is_err() && c.station(f64::NAN).is_err());
    }

    #[test]
    fn shared_segments_include_both_ends() {
        let c = chain(&[(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)]).unwrap();
        let at = |x| c.station(x).unwrap();
        assert_eq!(at(0.0).shared_segment(&at(1.0)), Some(SegmentId(0)));
        assert_eq!(at(1.0).shared_segment(&at(0.0)), Some(SegmentId(0)));
        assert_eq!(at(1.0).shared_segment(&at(2.0)), Some(SegmentId(1)));
        assert_eq!(at(0.5).shared_segment(&at(1.0)), Some(SegmentId(0)));
        assert_eq!(at(0.0).shared_segment(&at(2.0)), None);
        assert_eq!(at(0.5).shared_segment(&at(1.5)), None);
        assert_eq!(at(0.5).shared_segment(&at(0.5)), None);
    }
}
