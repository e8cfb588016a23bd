//! A DEM with its overlays as a ground: hops in any direction.

use std::{ops::ControlFlow, sync::Arc};

use nalgebra::{Vector2, Vector3};

use super::{
    Around, ContactPoint, Element, Facet, Frame, Hold, NodeLattice, Profiles, Realization, Side, Surface, TakeoffWindows, Windows,
    excluded::{GreatestSpeeds, slopes_ahead},
    posts::Standing,
    rest::rest_slope,
};
use crate::{
    ballistics::{FlightEnvelope, LineOfSight, limits},
    chain::{
        ConstrainedChain, ConstraintProblem, ConstraintProblems, ContactRule, Footprint, FootprintRefusal, GroundForm,
        InvalidChain, PolygonalChain, SegmentConstraints, SegmentGround, resolve_constraints,
    },
    hop::HopTest,
    quantity::{ChainPoint, MapPoint, SegmentId, SlopeInterval, VertexId},
    terrain::{
        FootprintFit, FootprintGap, MapLayers, OverlaidDem, Profile, ProfileFacet, ProfilePoint, Surroundings, TerrainError,
        Triangles,
    },
    world::{Contact, Direction, FrictionCone, Gravity, Hopper, RestSlope, SurfaceProperties},
};

/// Distance before a landing, or beyond a take-off, at which friction and keep-out zones are looked up, m. A landing obeys the
/// ground just flown over and a take-off the ground ahead, even if a border runs through the contact itself.
pub(super) const BESIDE_M: f64 = 1e-6;

/// [`facets`](Surface::facets) probes two points, one on each side of the line: `aside_posts` post spacings to the side and this many
/// times as far along it. A line at less than 1/4096 rad to an edge therefore counts as running along it. Lines between posts up
/// to some 500 posts apart make larger angles with every other edge. A larger value could probe past the facet under the contact
/// when the line does not start at a post.
const FACET_LOOK: f64 = 4096.0;

/// Length of the line next to a contact over which the overlays are laid, in post spacings.
const BESIDE_POSTS: f64 = 0.5;

/// Rounding error of a height or a coordinate, in units in the last place.
const ULPS: f64 = 4.0;

/// A position within this many post spacings of a line of the lattice lies on it, as in [`slice`](crate::terrain::slice()).
const ON_THE_LINE: f64 = 1.0e-9;

/// A DEM with its overlays, the hopper, gravity and the default surface: all that a hop between two map points depends on. A clone
/// shares the terrain.
#[derive(Clone, Debug)]
pub struct DemGround {
    terrain: OverlaidDem,
    envelope: FlightEnvelope,
    speeds: GreatestSpeeds,
    surface: SurfaceProperties,
    height_rounding_m: f64,
    position_rounding_m: f64,
    resolution_m: f64,
    /// Farther from a line of the lattice than its tolerance, post spacings.
    aside_posts: f64,
    /// How this ground differs from the map in one trial; by default, not at all.
    pub(super) realization: Realization,
    /// The footprint of the hopper, if it has one, and the DEM that it stands on.
    pub(super) footprint: Option<(Footprint, Arc<Surroundings>)>,
}

/// A position on a map, and its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPosition {
    /// Easting and northing, m.
    pub at: MapPoint,
    /// Height, m.
    pub z_m: f64,
}

/// The gradient of a facet: its slopes towards east and north.
pub(super) type Gradient = Vector2<f64>;

/// Why a slice of a DEM gives no chain.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SliceProblem {
    /// An error of the terrain or its overlays.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// The slice is not a valid chain.
    #[error("the slice is not a valid chain: {0}")]
    Chain(#[from] InvalidChain),
    /// The constraints of a segment cannot be resolved.
    #[error(transparent)]
    Constraints(#[from] ConstraintProblems),
}

impl DemGround {
    /// The ground of a DEM for a hopper and gravity.
    ///
    /// `surface` applies where the friction raster has no data.
    pub fn new(terrain: OverlaidDem, hopper: &Hopper, gravity: Gravity, surface: &SurfaceProperties) -> Self {
        let dem = terrain.dem();
        let (low_m, high_m) = dem.elevation_range_m();
        let (bounds, map) = (dem.bounds(), dem.georeference());
        let farthest_m = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y].into_iter().map(f64::abs).fold(0.0, f64::max);
        let position_rounding_m = ULPS * f64::EPSILON * farthest_m;
        let step_m = map.step_m();
        Self {
            height_rounding_m: ULPS * f64::EPSILON * low_m.abs().max(high_m.abs()),
            position_rounding_m,
            resolution_m: 4.0 * (ON_THE_LINE * step_m).max(position_rounding_m),
            aside_posts: 4.0 * ON_THE_LINE.max(position_rounding_m / step_m),
            envelope: FlightEnvelope::new(hopper, gravity),
            speeds: GreatestSpeeds::new(
                (hopper.limits().takeoff_speed_max_m_s, hopper.limits().landing_speed_max_m_s),
                gravity.m_s2(),
            ),
            surface: *surface,
            realization: Realization::default(),
            footprint: Footprint::of(hopper).map(|footprint| (footprint, Arc::new(Surroundings::whole(terrain.shared_dem())))),
            terrain,
        }
    }

    /// The terrain with its overlays.
    pub const fn terrain(&self) -> &OverlaidDem {
        &self.terrain
    }

    /// The layers of the map.
    pub fn layers(&self) -> &MapLayers {
        self.terrain.overlays().layers()
    }

    /// The flight envelope of the hopper under its gravity.
    pub const fn envelope(&self) -> &FlightEnvelope {
        &self.envelope
    }

    /// The surface properties where the friction raster has no data.
    pub const fn surface(&self) -> &SurfaceProperties {
        &self.surface
    }

    /// The friction where the raster has no data; `None` if the default surface has no friction cone.
    pub const fn constant_friction(&self) -> Option<FrictionCone> {
        self.surface.constant_friction()
    }

    /// The slice from one map point to another as a chain with overlays and resolved constraints.
    ///
    /// # Errors
    /// [`SliceProblem`].
    pub fn chain(&self, from: MapPoint, to: MapPoint) -> Result<ConstrainedChain, SliceProblem> {
        let constant = self.constant_friction();
        self.constrained(&self.terrain.slice(from, to, constant)?)
    }

    /// The chain of a slice of this terrain, with overlays and resolved constraints.
    ///
    /// # Errors
    /// [`SliceProblem`].
    pub fn chain_of(&self, mut profile: Profile) -> Result<ConstrainedChain, SliceProblem> {
        self.terrain.overlays().lay(&mut profile, self.constant_friction())?;
        self.constrained(&profile)
    }

    fn constrained(&self, profile: &Profile) -> Result<ConstrainedChain, SliceProblem> {
        let chain = PolygonalChain::from_profile(profile, self.constant_friction())?.with_layers(self.layers());
        let gravity = self.envelope.gravity();
        Ok(match &self.footprint {
            Some((_, dem)) => ConstrainedChain::on_dem(Arc::clone(dem), chain, self.hopper(), gravity, &self.surface)?,
            None => ConstrainedChain::new(chain, self.hopper(), gravity, &self.surface)?,
        })
    }

    /// Why the ground under the footprint refuses every contact at a position, under friction of this coefficient; `None` if it does
    /// not, or if the hopper has no footprint.
    pub(super) fn footprint_refusal(&self, position: &MapPosition, friction: Option<f64>) -> Option<FootprintRefusal> {
        self.footprint_against(position, rest_slope(self.surface.rest, friction))
    }

    /// The same where the rest slope has this tangent.
    pub(super) fn footprint_against(&self, position: &MapPosition, rest: Option<f64>) -> Option<FootprintRefusal> {
        let (footprint, _) = self.footprint.as_ref()?;
        footprint.judge(self.fitted(position)?, rest, self.height_rounding_m / (ULPS * f64::EPSILON))
    }

    /// What the ground under the footprint allows at a position, where the rest slope has this tangent.
    pub(super) fn standing(&self, position: &MapPosition, rest: Option<f64>) -> Standing {
        let (Some((footprint, _)), Some(fit)) = (self.footprint.as_ref(), self.fitted(position)) else { return Standing::Sound };
        if fit.is_ok_and(|fit| footprint.is_close(&fit, rest)) {
            return Standing::Close;
        }
        match footprint.judge(fit, rest, self.height_rounding_m / (ULPS * f64::EPSILON)) {
            None => Standing::Sound,
            Some(FootprintRefusal::TooSteep { .. }) => Standing::TooSteep,
            Some(FootprintRefusal::TooRough { .. } | FootprintRefusal::Unknown { .. }) => Standing::Refused,
        }
    }

    /// What is wrong with a footprint that has no room anywhere on the DEM: its size and that of the DEM.
    pub(crate) fn footprint_without_room(&self) -> Option<String> {
        let (footprint, _) = self.footprint.as_ref()?;
        let bounds = self.terrain.dem().bounds();
        let side_m = (bounds.max - bounds.min).min();
        (footprint.diameter_m > side_m).then(|| format!("{} m on a DEM whose shorter side is {side_m} m", footprint.diameter_m))
    }

    /// The ground fitted under the footprint; `None` without one.
    fn fitted(&self, position: &MapPosition) -> Option<Result<FootprintFit, FootprintGap>> {
        let (footprint, dem) = self.footprint.as_ref()?;
        let origin = self.terrain.dem().georeference().north_west();
        let field = self.realization.heights.as_deref();
        let raised = field.map(|field| move |post: MapPoint| field.at(post.x - origin.x, post.y - origin.y));
        let raised = raised.as_ref().map(|raised| raised as &dyn Fn(MapPoint) -> f64);
        Some(dem.fit_raised(position.at, position.z_m, footprint.diameter_m, raised))
    }

    /// The same on the nominal ground, whose friction is looked up beside the contact.
    fn refuses_footprint(&self, position: &MapPosition, beside: MapPoint) -> bool {
        let friction = || self.nominal_friction(beside).map(FrictionCone::coefficient);
        self.footprint.is_some() && self.footprint_refusal(position, friction()).is_some()
    }

    pub(crate) fn triangles(&self) -> Triangles<'_> {
        Triangles::of(self.terrain.dem())
    }

    /// The position of the nominal ground at a map point; `None` where there is no ground.
    ///
    /// A point on an edge or at a post belongs to every triangle that meets there; one triangle with ground suffices.
    pub fn position(&self, at: MapPoint) -> Option<MapPosition> {
        let triangles = self.triangles();
        if let Some((z_m, _)) = triangles.at(at, triangles.nominal()) {
            return Some(MapPosition { at, z_m });
        }
        let dem = self.terrain.dem();
        let (post, around) = (NodeLattice::new(dem, 1).nearest(dem.georeference(), at), [-1.0, 0.0, 1.0]);
        if (dem.georeference().post(post.row, post.col) - at).amax() <= self.resolution_m {
            return dem.elevation(post.row, post.col).map(|z_m| MapPosition { at, z_m });
        }
        let mut beside = around.iter().flat_map(|x| around.iter().map(|y| Vector2::new(*x, *y) * self.resolution_m));
        beside.find_map(|beside| {
            let (z_m, gradient) = triangles.at(at + beside, triangles.nominal())?;
            Some(MapPosition { at, z_m: z_m - gradient.dot(&beside) })
        })
    }

    /// Whether a map point lies on the map, including its border.
    pub fn covers(&self, at: MapPoint) -> bool {
        self.triangles().covers(at)
    }

    /// The friction of the nominal ground; `None` if angles are stated instead.
    pub(super) fn nominal_friction(&self, at: MapPoint) -> Option<FrictionCone> {
        self.terrain.overlays().friction_at(at).or(self.constant_friction())
    }

    /// What the nominal ground allows on a facet for a heading, as in a slice along that heading.
    fn constraints(
        &self,
        gradient: Gradient,
        heading: Vector2<f64>,
        beside: MapPoint,
    ) -> Result<SegmentConstraints, ConstraintProblem> {
        let friction = self.nominal_friction(beside);
        let cross_slope = ProfileFacet::from_gradient(gradient, heading).cross_slope;
        let keep_out = self.terrain.overlays().keeps_out(beside);
        let ground = SegmentGround { form: GroundForm::Surface { friction, cross_slope }, keep_out };
        resolve_constraints(SegmentId(0), gradient.dot(&heading), &ground, self.hopper(), self.envelope.gravity(), &self.surface)
    }

    /// The rule of a contact on a facet for a heading; `None` if the nominal ground refuses it.
    fn allowed(&self, gradient: Gradient, heading: Vector2<f64>, beside: MapPoint, contact: Contact) -> Option<ContactRule> {
        self.constraints(gradient, heading, beside).ok()?.allowed(contact, Direction::Forward).copied()
    }

    /// Whether friction at both contacts and the greatest speeds exclude every arc, by a test far cheaper than the exact limits.
    fn are_arcs_excluded(&self, [from, to]: [(Gradient, MapPoint); 2], sight: LineOfSight, heading: Vector2<f64>) -> bool {
        // With brakes the end of the arc is no landing.
        if self.hopper().limits().landing.brakes() {
            return false;
        }
        let (Some(under), Some(over)) = (self.nominal_friction(from.1), self.nominal_friction(to.1)) else { return false };
        let takeoff = slopes_ahead(from.0, heading, under.coefficient());
        let landing = slopes_ahead(to.0, -heading, over.coefficient());
        takeoff.zip(landing).is_none_or(|(takeoff, landing)| self.speeds.exclude(sight, takeoff, landing))
    }

    /// The feasible lofts of one hop by a walk over the triangles, without a slice (replanning asks for them many times); `None` if
    /// the hop is infeasible.
    ///
    /// Equal to [`windows`](Windows::windows) except for rounding; on a line along the common edge of two facets, it uses one of
    /// them.
    pub(crate) fn lofts_by_walk(
        &self,
        from: &MapPosition,
        to: &MapPosition,
        sight: LineOfSight,
        heading: Vector2<f64>,
    ) -> Option<SlopeInterval> {
        let triangles = self.triangles();
        let nominal = triangles.nominal();
        if self.layers().refusing_hop(from.at, to.at).is_some() {
            return None;
        }
        let (ahead, before) = (from.at + heading * BESIDE_M, to.at - heading * BESIDE_M);
        let (from_gradient, to_gradient) = (triangles.at(ahead, nominal)?.1, triangles.at(before, nominal)?.1);
        if self.are_arcs_excluded([(from_gradient, ahead), (to_gradient, before)], sight, heading) {
            return None;
        }
        let takeoff = self.allowed(from_gradient, heading, ahead, Contact::Takeoff)?;
        let landing = self.allowed(to_gradient, heading, before, Contact::Landing)?;
        let mut lofts = self.envelope.lofts(sight, takeoff.contact_limits(), landing.contact_limits());
        if lofts.is_empty() || lofts.upper <= 0.0 || self.refuses_footprint(from, ahead) || self.refuses_footprint(to, before) {
            return None;
        }
        let end_m = sight.run_m() - self.position_rounding_m - BESIDE_M;
        let clearance = self.envelope.clearance();
        let ends = (ChainPoint::new(0.0, from.z_m), ChainPoint::new(sight.run_m(), to.z_m));
        let kink_m = if clearance.has_kinks() { clearance.kink_m(sight.run_m()) } else { f64::INFINITY };
        let (mut reached_m, mut before) = (0.0, (0.0, from.z_m));
        for span in triangles.walk(from.at, heading, nominal) {
            reached_m = span.to_m;
            // The kinks of the clearance lie inside spans.
            for (at_m, from_takeoff) in [(kink_m, true), (sight.run_m() - kink_m, false)] {
                if before.0 < at_m && at_m <= reached_m {
                    let z_m = before.1 + (span.to_z_m - before.1) * ((at_m - before.0) / (reached_m - before.0));
                    let over = if from_takeoff {
                        (z_m - from.z_m) / kink_m - sight.slope()
                    } else {
                        sight.slope() + (z_m - to.z_m) / kink_m
                    };
                    lofts.lower = lofts.lower.max(clearance.kink_loft(over, sight.run_m()));
                }
            }
            before = (span.to_m, span.to_z_m);
            if lofts.is_empty() {
                return None;
            }
            if reached_m >= end_m {
                break;
            }
            if reached_m > BESIDE_M {
                let crossing = ChainPoint::new(span.to_m, span.to_z_m);
                lofts.lower = lofts.lower.max(limits::clearing_loft(ends.0, ends.1, crossing, clearance));
                if lofts.is_empty() {
                    return None;
                }
            }
        }
        // A walk that ends earlier has met no-data.
        (reached_m >= end_m && self.envelope.commands(sight, lofts)).then_some(lofts)
    }

    /// What the nominal ground allows on a facet next to a contact, and its friction; `None` where an overlay ends.
    ///
    /// The overlays are laid over a short line on that side of the contact, as over a slice, so that borders of zones and friction take
    /// effect from the same points on.
    fn overlaid(
        &self,
        at: MapPoint,
        heading: Vector2<f64>,
        side: Side,
        gradient: Gradient,
    ) -> Option<(SegmentConstraints, Option<FrictionCone>)> {
        let length = self.moved(heading, BESIDE_POSTS);
        let (begin, end) = match side {
            Side::Ahead => (at, at + length),
            Side::Behind => (at - length, at),
        };
        let point = |x_m, map| ProfilePoint { x_m, z_m: 0.0, map };
        let bare = ProfileFacet::from_gradient(gradient, heading);
        let mut profile = Profile { points: vec![point(0.0, begin), point(length.norm(), end)], facets: vec![bare], heading };
        self.terrain.overlays().lay(&mut profile, self.constant_friction()).ok()?;
        let facet = match side {
            Side::Ahead => profile.facets.first(),
            Side::Behind => profile.facets.last(),
        }?;
        let friction = facet.friction.or(self.constant_friction());
        let form = GroundForm::Surface { friction, cross_slope: facet.cross_slope };
        let ground = SegmentGround { form, keep_out: facet.keep_out };
        let slope = gradient.dot(&heading);
        let constraints =
            resolve_constraints(SegmentId(0), slope, &ground, self.hopper(), self.envelope.gravity(), &self.surface).ok()?;
        Some((constraints, friction))
    }

    /// A step in a direction, of this length in post spacings.
    fn moved(&self, direction: Vector2<f64>, posts: f64) -> Vector2<f64> {
        let map = self.terrain.dem().georeference();
        direction * (posts / (direction.x.abs() / map.dx_m()).max(direction.y.abs() / map.dy_m()))
    }
}

/// A facet with the given gradient, constraints and friction, for the checker.
fn facet_of(gradient: Gradient, rest: RestSlope, (constraints, friction): (SegmentConstraints, Option<FrictionCone>)) -> Facet {
    let hold = match friction {
        Some(cone) => Hold::Friction { normal: Vector3::new(-gradient.x, -gradient.y, 1.0).normalize(), cone },
        None => Hold::Stated {
            line: constraints.stated(Direction::Forward),
            takeoff: constraints.check_contact(Contact::Takeoff, Direction::Forward),
            landing: constraints.check_contact(Contact::Landing, Direction::Forward),
        },
    };
    Facet { refusal: constraints.refusal(), hold, rest_slope: rest_slope(rest, friction.map(FrictionCone::coefficient)) }
}

impl Surface for DemGround {
    type Contact = MapPosition;

    fn hopper(&self) -> &Hopper {
        self.envelope.hopper()
    }

    fn gravity(&self) -> Gravity {
        self.envelope.gravity()
    }

    /// A map point has no distance along a journey: the distance is 0.
    fn contact_point(&self, position: &MapPosition) -> ContactPoint {
        ContactPoint::on_map(0.0, position.at, position.z_m)
    }

    fn contact_at(&self, stated: &ContactPoint) -> Option<MapPosition> {
        match stated.frame {
            Frame::Map => self.position(stated.point_m.xy()),
            Frame::Chain => None,
        }
    }

    fn course(&self, from: &MapPosition, to: &MapPosition) -> Option<(f64, Vector2<f64>)> {
        let away = to.at - from.at;
        let run_m = libm::hypot(away.x, away.y);
        (run_m > self.position_rounding_m).then(|| (run_m, away / run_m))
    }

    fn facets(&self, at: &MapPosition, heading: Vector2<f64>, side: Side) -> Vec<Facet> {
        let triangles = self.triangles();
        let towards = match side {
            Side::Ahead => heading,
            Side::Behind => -heading,
        };
        // One point on each side of the line, farther from it than the tolerance of the lattice, and far enough along it that a
        // line which only starts next to an edge has left the edge.
        let along = at.at + self.moved(towards, FACET_LOOK * self.aside_posts);
        let across = self.moved(Vector2::new(-heading.y, heading.x), self.aside_posts);
        let gradients = [along + across, along - across].map(|point| triangles.at(point, triangles.nominal()).map(|(_, g)| g));
        let [left, right] = gradients;
        let right = right.filter(|right| left != Some(*right));
        let overlaid = |gradient| self.overlaid(at.at, heading, side, gradient);
        let known = [left, right].into_iter().flatten().filter_map(|gradient| overlaid(gradient).map(|known| (gradient, known)));
        known.map(|(gradient, known)| facet_of(gradient, self.surface.rest, known)).collect()
    }

    fn layers(&self) -> Option<&MapLayers> {
        Some(self.layers())
    }

    fn height_rounding_m(&self) -> f64 {
        self.height_rounding_m
    }

    fn position_rounding_m(&self) -> f64 {
        self.position_rounding_m
    }

    fn resolution_m(&self) -> f64 {
        self.resolution_m
    }

    fn slope_rounding(&self) -> f64 {
        let map = self.terrain.dem().georeference();
        2.0 * (self.height_rounding_m + self.position_rounding_m) / map.step_m()
    }
}

impl Profiles for DemGround {
    fn walk(&self, from: &MapPosition, heading: Vector2<f64>, visit: &mut dyn FnMut(&Element) -> ControlFlow<()>) {
        let triangles = self.triangles();
        let mut at = (0.0, from.z_m);
        // Spans shorter than the resolution, which arise next to grid lines, are merged into the next element.
        let mut element = |to_m: f64, to_z_m: f64| {
            let (from_m, from_z_m) = at;
            if to_m - from_m <= self.resolution_m {
                return ControlFlow::Continue(());
            }
            at = (to_m, to_z_m);
            visit(&Element { from_m, to_m, from_z_m, to_z_m, vertex: None, bends: false })
        };
        let Some(posts) = triangles.posts_ahead(from.at, heading) else {
            for span in triangles.walk(from.at, heading, triangles.nominal()) {
                if element(span.to_m, span.to_z_m).is_break() {
                    return;
                }
            }
            return;
        };
        // A line along an edge has ground if either of its two triangles has.
        let across = self.moved(Vector2::new(-heading.y, heading.x), self.aside_posts);
        let mut before_m = 0.0;
        for (row, col, to_m) in posts {
            let middle = from.at + heading * (0.5 * (before_m + to_m));
            let known = [across, -across].iter().any(|aside| triangles.at(middle + aside, triangles.nominal()).is_some());
            let Some(z_m) = self.terrain.dem().elevation(row, col).filter(|_| known) else { return };
            if element(to_m, z_m).is_break() {
                return;
            }
            before_m = to_m;
        }
    }

    fn around(&self, _: &MapPosition, _: f64) -> Around {
        Around::Map
    }
}

impl Windows for DemGround {
    /// Slices the DEM between the two positions and runs the hop test on the slice.
    fn windows(&self, takeoff: &MapPosition, landing: &MapPosition) -> Option<TakeoffWindows> {
        let (sight, lofts) = end_to_end(self.chain(takeoff.at, landing.at).ok()?)?;
        Some(TakeoffWindows::of(self.envelope.takeoff_speeds(), sight, lofts, self.envelope.gravity_m_s2()))
    }
}

/// The line of sight from the first to the last vertex of a chain, and the feasible lofts between them.
pub(super) fn end_to_end(chain: ConstrainedChain) -> Option<(LineOfSight, Option<SlopeInterval>)> {
    let test = HopTest::new(chain);
    let geometry = test.chain().geometry();
    let (start, end) = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
    Some((test.line_of_sight(&start, &end)?, test.lofts(&start, &end).ok()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        draw::Draw,
        terrain::{Dem, GeoReference, Overlays},
        world::{ClearanceRule, HopperLimits},
    };

    /// The walk over triangles and the slice with its hop test give the same lofts, under every rule of the clearance.
    #[test]
    fn a_walk_gives_the_lofts_of_the_slice() {
        let draw = &mut Draw::seeded(1407);
        let (mut hops, mut by_ground, mut refused) = (0, 0, 0);
        for _ in 0..60 {
            let heights = (0..20 * 20).map(|_| draw.uniform(0.0, 0.8)).collect();
            let dem = Dem::new(20, 20, heights, GeoReference::local(MapPoint::new(3.0, 40.0), 1.0, 1.3).unwrap()).unwrap();
            let limits = HopperLimits {
                clearance_m: draw.log_uniform(0.05, 8.0),
                clearance_rule: match draw.below(3) {
                    0 => ClearanceRule::Vertex,
                    1 => ClearanceRule::TAPERED,
                    _ => ClearanceRule::Tapered(draw.log_uniform(0.1, 10.0)),
                },
                ..HopperLimits::with_speeds(9.0, 9.0)
            };
            let hopper = Hopper::new(limits).unwrap();
            let cone = FrictionCone::new(2.0).unwrap();
            let surface = SurfaceProperties { grip: Some(crate::world::Grip::Friction(cone)), rest: RestSlope::Unlimited };
            let overlaid = OverlaidDem::new(dem, Overlays::default());
            let ground = DemGround::new(overlaid, &hopper, Gravity::new(1.6).unwrap(), &surface);
            for _ in 0..60 {
                let [from, to] =
                    [0, 1].map(|_| ground.position(MapPoint::new(draw.uniform(4.0, 21.0), draw.uniform(17.0, 39.0))).unwrap());
                let Some((run_m, heading)) = ground.course(&from, &to) else { continue };
                let sight = LineOfSight::new(run_m, to.z_m - from.z_m);
                let walked = ground.lofts_by_walk(&from, &to, sight, heading);
                let sliced = ground.windows(&from, &to).and_then(|windows| windows.lofts.first().copied());
                match (walked, sliced) {
                    (Some(walked), Some(sliced)) => {
                        let apart = (walked.lower - sliced.lower).abs().max((walked.upper - sliced.upper).abs());
                        assert!(apart < 1e-7 * (1.0 + sliced.upper.abs()), "{walked:?} {sliced:?} {limits:?}");
                        hops += 1;
                        let free = DemGround {
                            envelope: FlightEnvelope::new(&Hopper::with_speeds(9.0, 9.0).unwrap(), ground.gravity()),
                            ..ground.clone()
                        };
                        by_ground +=
                            u32::from(free.lofts_by_walk(&from, &to, sight, heading).is_some_and(|free| free.lower < walked.lower));
                    }
                    (walked, sliced) => {
                        assert_eq!(walked, sliced, "{limits:?}");
                        refused += 1;
                    }
                }
            }
        }
        assert!(hops > 500 && by_ground > 200 && refused > 200, "{hops} hops, {by_ground} by the clearance, {refused} refused");
    }
}
