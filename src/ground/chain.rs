//! A chain as a ground: travel forward or in reverse along its one vertical plane.

use std::ops::ControlFlow;

use nalgebra::{Point3, Vector2};

use super::{Around, ContactPoint, Element, ElementVertex, Facet, Frame, Hold, Profiles, Side, Surface};
use crate::{
    chain::{ChainLayers, ConstrainedChain, Footing, GroundForm, SegmentConstraints, Site, Station, rest_slope},
    quantity::{SegmentId, VertexId},
    terrain::{FacetSpan, MapLayers, Triangles},
    world::{Contact, Direction, Gravity, Hopper},
};

/// Rounding error of a height inside a segment (from two products, a quotient and a sum), in units in the last place of the chain's
/// greatest height.
const HEIGHT_ULPS: f64 = 4.0;

/// The direction of travel of a heading along a chain.
#[inline]
pub(crate) fn direction_of(heading: Vector2<f64>) -> Direction {
    if heading.x < 0.0 { Direction::Reverse } else { Direction::Forward }
}

/// The heading of a direction of travel along a chain.
#[inline]
pub(crate) fn heading_of(direction: Direction) -> Vector2<f64> {
    Vector2::new(direction.sign(), 0.0)
}

/// The next vertex in a direction of travel; `None` at the chain's end.
pub(super) fn next_vertex(site: Site, direction: Direction, last: usize) -> Option<usize> {
    match (site, direction) {
        (Site::Vertex(v), Direction::Forward) => (v.index() < last).then(|| v.index() + 1),
        (Site::Inside(s), Direction::Forward) => Some(s.index() + 1),
        (Site::Vertex(v), Direction::Reverse) => v.index().checked_sub(1),
        (Site::Inside(s), Direction::Reverse) => Some(s.index()),
    }
}

/// The facet of a segment for a direction of travel.
fn facet(segment: &SegmentConstraints, direction: Direction, rest_slope: Option<f64>) -> Facet {
    let contact = |contact| segment.check_contact(contact, direction);
    let hold =
        Hold::Stated { line: segment.stated(direction), takeoff: contact(Contact::Takeoff), landing: contact(Contact::Landing) };
    Facet { refusal: segment.refusal(), hold, rest_slope }
}

impl Surface for ConstrainedChain {
    type Contact = Station;

    fn hopper(&self) -> &Hopper {
        Self::hopper(self)
    }

    fn gravity(&self) -> Gravity {
        Self::gravity(self)
    }

    fn contact_point(&self, station: &Station) -> ContactPoint {
        let point = station.point;
        let (at, frame) = match self.geometry().map_point(station) {
            Some(map) => (Point3::new(map.x, map.y, point.z_m), Frame::Map),
            None => (Point3::new(point.x_m, 0.0, point.z_m), Frame::Chain),
        };
        ContactPoint { along_m: point.x_m, point_m: at, frame, station: Some(*station) }
    }

    fn contact_at(&self, stated: &ContactPoint) -> Option<Station> {
        self.geometry().station(stated.along_m).ok()
    }

    fn course(&self, from: &Station, to: &Station) -> Option<(f64, Vector2<f64>)> {
        let direction = Direction::between(from.point.x_m, to.point.x_m)?;
        Some(((to.point.x_m - from.point.x_m).abs(), heading_of(direction)))
    }

    fn facets(&self, at: &Station, heading: Vector2<f64>, side: Side) -> Vec<Facet> {
        let direction = direction_of(heading);
        // A take-off obeys the segment ahead of its station, a landing the one behind.
        let contact = match side {
            Side::Ahead => Contact::Takeoff,
            Side::Behind => Contact::Landing,
        };
        let id = at.ruling_segment(contact, direction, self.segments().len());
        let rest = |id: SegmentId| self.geometry().grounds().get(id.index()).and_then(|ground| rest_slope(ground, self.surface()));
        id.and_then(|id| Some(facet(self.segments().get(id.index())?, direction, rest(id)))).into_iter().collect()
    }

    fn layers(&self) -> Option<&MapLayers> {
        self.geometry().layers().map(ChainLayers::map)
    }

    fn height_rounding_m(&self) -> f64 {
        HEIGHT_ULPS * f64::EPSILON * self.height_bound_m()
    }

    /// Stations are exact.
    fn position_rounding_m(&self) -> f64 {
        0.0
    }

    /// A station is at a vertex only if its x is exactly the vertex's; there is no snapping.
    fn resolution_m(&self) -> f64 {
        0.0
    }

    fn slope_rounding(&self) -> f64 {
        0.0
    }
}

impl Profiles for ConstrainedChain {
    fn walk(&self, from: &Station, heading: Vector2<f64>, visit: &mut dyn FnMut(&Element) -> ControlFlow<()>) {
        let direction = direction_of(heading);
        let (geometry, last) = (self.geometry(), self.geometry().segment_count());
        // Close doubles subtract without error.
        let distance_m = |x_m: f64| direction.sign() * (x_m - from.point.x_m);
        let mut from_m = 0.0;
        let mut from_z_m = from.point.z_m;
        let mut next = next_vertex(from.site, direction, last);
        while let Some(vertex) = next {
            let point = geometry.vertices()[vertex];
            let vertex = VertexId(vertex);
            let element = Element {
                from_m,
                to_m: distance_m(point.x_m),
                from_z_m,
                to_z_m: point.z_m,
                vertex: Some(ElementVertex { id: vertex, x_m: point.x_m }),
                bends: geometry.bends().binary_search(&vertex).is_ok(),
            };
            if visit(&element).is_break() {
                return;
            }
            (from_m, from_z_m) = (element.to_m, element.to_z_m);
            next = next_vertex(Site::Vertex(vertex), direction, last);
        }
    }

    fn around(&self, at: &Station, distance_m: f64) -> Around {
        if matches!(self.footing(), Footing::Map(_)) && self.geometry().map_points().is_some() {
            return Around::Map;
        }
        let (low_m, high_m) = (at.point.x_m - distance_m, at.point.x_m + distance_m);
        let across =
            self.geometry().vertices().windows(2).zip(self.geometry().grounds()).filter_map(|(ends, ground)| match ground.form {
                GroundForm::Surface { cross_slope, .. } if ends[0].x_m < high_m && low_m < ends[1].x_m => {
                    Some(cross_slope.slope().abs())
                }
                _ => None,
            });
        Around::Profile { cross_slope: across.fold(0.0, f64::max) }
    }

    fn rays(
        &self,
        at: &Station,
        distance_m: f64,
        headings: &[Vector2<f64>],
        visit: &mut dyn FnMut(usize, &Element) -> ControlFlow<()>,
    ) {
        let (Footing::Map(surroundings), Some(map)) = (self.footing(), self.geometry().map_point(at)) else {
            for (ray, heading) in headings.iter().enumerate() {
                self.walk(at, *heading, &mut |element| visit(ray, element));
            }
            return;
        };
        // The triangles of the DEM itself, of which the chain is a slice.
        let Some(dem) = surroundings.cut_out(map, distance_m) else { return };
        let triangles = Triangles::of(&dem);
        for (ray, heading) in headings.iter().enumerate() {
            for span in triangles.walk(map, *heading, triangles.nominal()) {
                let FacetSpan { from_m, to_m, from_z_m, to_z_m, .. } = span;
                let element = Element { from_m, to_m, from_z_m, to_z_m, vertex: None, bends: false };
                if visit(ray, &element).is_break() {
                    break;
                }
            }
        }
    }
}
