//! One hop flown by Newton's equations in small exact steps.

use std::ops::ControlFlow;

use nalgebra::Vector2;

use crate::{
    ground::{ElementVertex, Profiles, Surface},
    path::Hop,
    quantity::{Angle, ChainPoint, FacetId, VertexId},
    world::ClearanceRule,
};

/// Least number of steps of a flight, and of each stretch between two vertices.
///
/// A step under constant acceleration is exact for any length; small steps only serve to compare the arc with the ground. On a
/// stretch the arc is concave and the ground straight, so an arc above the ground at both ends of a stretch is above it in between;
/// four samples per stretch, and 64 on a stretch that is the whole flight, check that independently. More steps cost time and
/// rounding.
pub(super) const STEPS_PER_FLIGHT: f64 = 64.0;
const STEPS_PER_STRETCH: f64 = 4.0;

/// Tolerance of a flown position, as a fraction of the flight's size (the sum of its run and its height).
///
/// Positions are measured from the take-off, so where on the map the hop lies costs no digits. What remains is the last digit of
/// the commanded angle and speed (some 1e-15 of the size) and one rounding per step (1e-16 each, in a random walk: 1e-13 for a
/// million steps). The tolerance is ten times that, and a ten-billionth of 1 % of a hop.
pub(super) const PLACE_TOLERANCE: f64 = 1e-12;

/// The least height over a vertex flown past, or of a mesh over or under an edge of a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// The vertex of the chain; `None` over a ground without numbered vertices.
    pub vertex: Option<VertexId>,
    /// The facet of the mesh; `None` over other ground.
    pub facet: Option<FacetId>,
    /// Its position along the profile, m.
    pub x_m: f64,
    /// Height of the flight above it, m, or below a facet that it passes under; negative where it passes on the wrong side.
    pub height_m: f64,
}

/// A point passed below the clearance that it asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TooLow {
    pub(super) over: Clearance,
    /// The height to keep there, m.
    pub(super) required_m: f64,
}

/// The flight of one hop.
///
/// Time, angle and speed of the landing are those above the planned landing point, even if the flight meets the ground elsewhere:
/// so every limit of a hop is checked, not only the first violated one.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Where it first comes down, along the profile; `None` if it leaves the known ground in flight.
    pub contact: Option<ChainPoint>,
    /// Direction of flight at the landing.
    pub landing_angle: Angle,
    /// Speed at the landing, m/s.
    pub landing_speed_m_s: f64,
    /// Time to the landing, s.
    pub flight_time_s: f64,
    /// The highest point from take-off to landing, m, in the height reference of the ground; the landing itself if it still rises
    /// there.
    pub apex_z_m: f64,
    /// The same above the take-off, m.
    pub apex_height_m: f64,
    /// The least clearance over the vertices flown past; `None` if the flight passes no vertex.
    pub least_clearance: Option<Clearance>,
    /// How many steps it took.
    pub steps: usize,
    /// Every vertex, and every kink of a tapered clearance, passed below the clearance there.
    pub(super) too_low: Vec<TooLow>,
    /// Where the flight first runs below straight ground between vertices, and its greatest depth there, m.
    pub(super) underground: Option<(f64, f64)>,
    /// Where the known ground ends before the landing, m from the take-off.
    pub(super) unknown_from_m: Option<f64>,
    /// Where the known ground ends in the direction of flight, m along the profile; `None` unless the flight leaves it.
    pub(super) left_at_x_m: Option<f64>,
    /// Uncertainty of a position of this flight from rounding of the flight, m: [`PLACE_TOLERANCE`] of its size.
    pub(super) rounding_m: f64,
    /// The same including the rounding of the ground's heights, m.
    pub(super) place_tolerance_m: f64,
    /// Whether it comes down at the planned landing.
    pub(super) hits: bool,
    /// Horizontal speed, m/s.
    pub(super) across_m_s: f64,
    /// Vertical speed at the landing, m/s.
    pub(super) landing_climb_m_s: f64,
}

/// Position and velocity of the hopper, relative to its take-off and along its direction of travel.
#[derive(Clone, Copy, Debug)]
struct State {
    distance_m: f64,
    height_m: f64,
    time_s: f64,
    across_m_s: f64,
    climb_m_s: f64,
}

impl State {
    /// After `step_s` under constant gravity: `x += v_x dt, z += v_z dt - g dt^2 / 2, v_z -= g dt` (Newton; exact for any `dt`).
    fn after(self, step_s: f64, gravity_m_s2: f64) -> Self {
        Self {
            distance_m: self.distance_m + self.across_m_s * step_s,
            height_m: self.height_m + (self.climb_m_s * step_s - 0.5 * gravity_m_s2 * step_s * step_s),
            time_s: self.time_s + step_s,
            across_m_s: self.across_m_s,
            climb_m_s: self.climb_m_s - gravity_m_s2 * step_s,
        }
    }

    /// The state at a distance ahead, which it has exactly.
    fn at(self, distance_m: f64, gravity_m_s2: f64) -> Self {
        Self { distance_m, ..self.after((distance_m - self.distance_m) / self.across_m_s, gravity_m_s2) }
    }

    /// Length of the flight per metre of run at this state.
    fn stretch(self) -> f64 {
        libm::hypot(1.0, self.climb_m_s / self.across_m_s)
    }
}

/// Straight ground between two neighbouring points of the chain, from the take-off, along the direction of travel.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    from: (f64, f64),
    to: (f64, f64),
    /// What ends it.
    end: StretchEnd,
}

/// What ends a stretch of straight ground.
#[derive(Clone, Copy, Debug)]
enum StretchEnd {
    /// An edge of the ground, with its vertex where the ground is a chain.
    Edge(Option<ElementVertex>),
    /// The planned landing.
    Landing,
}

impl Stretch {
    /// Height of the ground at a share of the stretch, m.
    fn height_m(&self, share: f64) -> f64 {
        self.from.1 + (self.to.1 - self.from.1) * share
    }

    /// Share of the stretch at a distance.
    fn share(&self, distance_m: f64) -> f64 {
        (distance_m - self.from.0) / (self.to.0 - self.from.0)
    }

    /// Length of the ground per metre of run.
    fn ground_stretch(&self) -> f64 {
        libm::hypot(1.0, (self.to.1 - self.from.1) / (self.to.0 - self.from.0))
    }

    /// Where a flight that is above the ground at `above` and not at `below` meets it, by bisection to the last digit.
    fn contact_m(&self, above: State, below: State, gravity_m_s2: f64) -> f64 {
        let (mut near, mut far) = (above.distance_m, below.distance_m);
        loop {
            let middle = 0.5 * (near + far);
            if middle <= near || middle >= far {
                return near;
            }
            if above.at(middle, gravity_m_s2).height_m >= self.height_m(self.share(middle)) { near = middle } else { far = middle }
        }
    }
}

/// A hop and the ground under it.
pub(super) struct Course<'a, S: Surface> {
    pub(super) surface: &'a S,
    pub(super) hop: &'a Hop,
    /// The surface's own contact at the take-off.
    pub(super) from: S::Contact,
    /// Horizontal distance to the landing, m.
    pub(super) run_m: f64,
    pub(super) heading: Vector2<f64>,
}

impl<S: Surface> Course<'_, S> {
    /// The point of the profile at a distance and height from the take-off.
    pub(super) fn point(&self, distance_m: f64, height_m: f64) -> ChainPoint {
        let (takeoff, landing) = (&self.hop.takeoff, &self.hop.landing);
        let sign = if landing.along_m < takeoff.along_m { -1.0 } else { 1.0 };
        ChainPoint::new(takeoff.along_m + sign * distance_m, takeoff.point_m.z + height_m)
    }

    /// The height to keep over the ground at a distance from the take-off, m: the clearance, tapered towards both contacts.
    pub(super) fn required_m(&self, distance_m: f64) -> f64 {
        let limits = self.surface.hopper().limits();
        match limits.clearance_rule {
            ClearanceRule::Vertex => limits.clearance_m,
            ClearanceRule::Tapered(taper) => {
                let nearer_m = distance_m.min(self.run_m - distance_m);
                limits.clearance_m.min(taper * nearer_m.max(0.0))
            }
        }
    }
}

impl<S: Profiles> Course<'_, S> {
    /// Height of a point above the take-off, m. Close doubles subtract without error.
    fn over_takeoff_m(&self, z_m: f64) -> f64 {
        z_m - self.hop.takeoff.point_m.z
    }

    /// The stretches of ground from the take-off to the landing, and where the known ground ends before the landing.
    fn stretches(&self) -> (Vec<Stretch>, Option<f64>) {
        let mut stretches = Vec::new();
        let mut from = (0.0, 0.0);
        let mut known_m = 0.0;
        let last_m = self.run_m - self.surface.resolution_m();
        self.surface.walk(&self.from, self.heading, &mut |element| {
            known_m = element.to_m;
            if element.to_m >= last_m {
                return ControlFlow::Break(());
            }
            let to = (element.to_m, self.over_takeoff_m(element.to_z_m));
            stretches.push(Stretch { from, to, end: StretchEnd::Edge(element.vertex) });
            from = to;
            ControlFlow::Continue(())
        });
        let to = (self.run_m, self.over_takeoff_m(self.hop.landing.point_m.z));
        stretches.push(Stretch { from, to, end: StretchEnd::Landing });
        (stretches, (known_m < last_m).then_some(known_m))
    }

    /// The stretches of ground from the landing to the end of the known ground.
    fn stretches_beyond(&self) -> Vec<Stretch> {
        let mut stretches = Vec::new();
        let mut from = (self.run_m, self.over_takeoff_m(self.hop.landing.point_m.z));
        let first_m = self.run_m + self.surface.resolution_m();
        self.surface.walk(&self.from, self.heading, &mut |element| {
            if element.to_m > first_m {
                let to = (element.to_m, self.over_takeoff_m(element.to_z_m));
                stretches.push(Stretch { from, to, end: StretchEnd::Edge(element.vertex) });
                from = to;
            }
            ControlFlow::Continue(())
        });
        stretches
    }

    /// Every bend of the plane of the profile strictly below a flight, in the order of the profile.
    pub(super) fn bends(&self) -> Vec<ElementVertex> {
        let mut bends = Vec::new();
        self.surface.walk(&self.from, self.heading, &mut |element| {
            if element.to_m >= self.run_m {
                return ControlFlow::Break(());
            }
            bends.extend(element.vertex.filter(|_| element.bends));
            ControlFlow::Continue(())
        });
        // For both directions of travel.
        bends.sort_by(|a, b| a.x_m.total_cmp(&b.x_m));
        bends
    }

    /// Where the known ground ends in the direction of flight, m along the profile.
    fn end_of_ground_m(&self) -> f64 {
        let mut end_m = self.hop.takeoff.along_m;
        self.surface.walk(&self.from, self.heading, &mut |element| {
            end_m = element.vertex.map_or_else(|| self.point(element.to_m, 0.0).x_m, |vertex| vertex.x_m);
            ControlFlow::Continue(())
        });
        end_m
    }

    /// Flies the hop as commanded; `None` if it does not leave the ground forwards.
    ///
    /// Steps end exactly above every vertex flown past, with the small steps of [`STEPS_PER_FLIGHT`] in between.
    pub(super) fn fly(&self) -> Option<Flight> {
        let (speed, angle) = (self.hop.takeoff_speed_m_s, self.hop.takeoff_angle.radians());
        let takeoff = State {
            distance_m: 0.0,
            height_m: 0.0,
            time_s: 0.0,
            across_m_s: speed * libm::cos(angle),
            climb_m_s: speed * libm::sin(angle),
        };
        let forwards = takeoff.across_m_s > 0.0 && takeoff.across_m_s.is_finite();
        if !forwards {
            return None;
        }
        let (stretches, unknown_from_m) = self.stretches();
        let (states, top_m) = self.stepped(takeoff, &stretches);
        let landing = states.last().and_then(|steps| steps.last()).copied()?;
        let (run_m, rise_m) = stretches.last()?.to;
        let size_m = libm::hypot(run_m, top_m.max(rise_m.abs()).max(landing.height_m.abs()));
        let rounding_m = PLACE_TOLERANCE * size_m + self.surface.position_rounding_m();
        let place_tolerance_m = rounding_m + self.surface.height_rounding_m();
        let mut flight = Flight {
            contact: None,
            landing_angle: Angle::from_slope(landing.climb_m_s / landing.across_m_s),
            landing_speed_m_s: libm::hypot(landing.across_m_s, landing.climb_m_s),
            flight_time_s: landing.time_s,
            apex_z_m: self.hop.takeoff.point_m.z + top_m,
            apex_height_m: top_m,
            least_clearance: None,
            steps: states.iter().map(Vec::len).sum(),
            too_low: Vec::new(),
            underground: None,
            unknown_from_m,
            left_at_x_m: None,
            rounding_m,
            place_tolerance_m,
            hits: false,
            across_m_s: landing.across_m_s,
            landing_climb_m_s: landing.climb_m_s,
        };
        self.look_at_vertices(&mut flight, &stretches, &states);
        self.look_between(&mut flight, takeoff, &stretches, &states);
        let early = self.look_at_ground(&mut flight, takeoff, &stretches, &states);
        // Perpendicular to the arc: the distance of the landing point from the flown curve.
        let over_m = (landing.height_m - rise_m) / landing.stretch();
        flight.hits = early.is_none() && over_m.abs() <= place_tolerance_m;
        flight.contact = match early {
            Some(contact) => Some(contact),
            None if over_m > place_tolerance_m => self.beyond(landing),
            None => Some(self.hop.landing.in_profile()),
        };
        flight.left_at_x_m = flight.contact.is_none().then(|| self.end_of_ground_m());
        Some(flight)
    }

    /// All states, stretch by stretch, and the greatest height.
    fn stepped(&self, takeoff: State, stretches: &[Stretch]) -> (Vec<Vec<State>>, f64) {
        let run_m = stretches.last().map_or(0.0, |s| s.to.0);
        let g = self.surface.gravity_m_s2();
        let mut state = takeoff;
        let mut top_m = 0.0f64;
        let mut all = Vec::with_capacity(stretches.len());
        for stretch in stretches {
            let length_m = stretch.to.0 - stretch.from.0;
            let pieces = (STEPS_PER_FLIGHT * length_m / run_m).ceil().clamp(STEPS_PER_STRETCH, STEPS_PER_FLIGHT);
            let mut steps = Vec::new();
            let mut piece = 1.0;
            while piece <= pieces {
                let to_m = if piece == pieces { stretch.to.0 } else { stretch.from.0 + length_m * (piece / pieces) };
                let next = state.at(to_m, g);
                if state.climb_m_s > 0.0 && next.climb_m_s < 0.0 {
                    // The top of the flight lies within this step: a step that ends exactly there.
                    top_m = top_m.max(state.after(state.climb_m_s / g, g).height_m);
                }
                top_m = top_m.max(next.height_m);
                steps.push(next);
                state = next;
                piece += 1.0;
            }
            all.push(steps);
        }
        (all, top_m)
    }

    /// The clearance over every vertex flown past.
    fn look_at_vertices(&self, flight: &mut Flight, stretches: &[Stretch], states: &[Vec<State>]) {
        for (stretch, steps) in stretches.iter().zip(states) {
            let (StretchEnd::Edge(vertex), Some(over)) = (stretch.end, steps.last()) else { continue };
            let height_m = over.height_m - stretch.to.1;
            let x_m = vertex.map_or_else(|| self.point(stretch.to.0, 0.0).x_m, |vertex| vertex.x_m);
            let clearance = Clearance { vertex: vertex.map(|vertex| vertex.id), facet: None, x_m, height_m };
            if flight.least_clearance.is_none_or(|least| height_m < least.height_m) {
                flight.least_clearance = Some(clearance);
            }
            let required_m = self.required_m(stretch.to.0);
            // On a steep arc, an error of the horizontal position is a larger error of the height.
            if height_m < required_m - flight.place_tolerance_m * over.stretch() {
                flight.too_low.push(TooLow { over: clearance, required_m });
            }
        }
    }

    /// A tapered clearance over the ground between vertices: at the two places where it stops growing, and at every small step.
    fn look_between(&self, flight: &mut Flight, takeoff: State, stretches: &[Stretch], states: &[Vec<State>]) {
        let limits = self.surface.hopper().limits();
        let ClearanceRule::Tapered(taper) = limits.clearance_rule else { return };
        if limits.clearance_m <= 0.0 {
            return;
        }
        let full_m = (limits.clearance_m / taper).min(0.5 * self.run_m);
        let mut before = takeoff;
        let (mut kinks, mut steps) = (Vec::new(), Vec::new());
        for (stretch, all) in stretches.iter().zip(states) {
            for (i, &state) in all.iter().enumerate() {
                for kink_m in [full_m, self.run_m - full_m] {
                    if before.distance_m < kink_m && kink_m < state.distance_m {
                        kinks.extend(self.too_low(flight, stretch, before.at(kink_m, self.surface.gravity_m_s2())));
                    }
                }
                if i + 1 < all.len() {
                    steps.extend(self.too_low(flight, stretch, state));
                }
                before = state;
            }
        }
        flight.too_low.extend(kinks);
        // Between vertices and kinks the arc is concave and the ground with its clearance straight, so a step alone is never too low.
        if flight.too_low.is_empty() {
            flight.too_low.extend(steps);
        }
    }

    /// A state inside a stretch, if it is below the clearance there.
    fn too_low(&self, flight: &Flight, stretch: &Stretch, state: State) -> Option<TooLow> {
        let height_m = state.height_m - stretch.height_m(stretch.share(state.distance_m));
        let required_m = self.required_m(state.distance_m);
        let tolerance_m = flight.place_tolerance_m * state.stretch().max(stretch.ground_stretch());
        let over = Clearance { vertex: None, facet: None, x_m: self.point(state.distance_m, 0.0).x_m, height_m };
        (height_m < required_m - tolerance_m).then_some(TooLow { over, required_m })
    }

    /// Whether every small step stays above the ground; if not, the point at which the flight first meets it.
    fn look_at_ground(
        &self,
        flight: &mut Flight,
        takeoff: State,
        stretches: &[Stretch],
        states: &[Vec<State>],
    ) -> Option<ChainPoint> {
        let mut before = takeoff;
        let mut contact = None;
        for (stretch, steps) in stretches.iter().zip(states) {
            let slack_m = flight.place_tolerance_m * stretch.ground_stretch();
            for (i, &state) in steps.iter().enumerate() {
                let is_end = i + 1 == steps.len();
                let ground_m = if is_end { stretch.to.1 } else { stretch.height_m(stretch.share(state.distance_m)) };
                let slack_m = if is_end { flight.place_tolerance_m * state.stretch() } else { slack_m };
                let over_m = state.height_m - ground_m;
                if over_m < -slack_m {
                    if contact.is_none() {
                        let met_m = stretch.contact_m(before, state, self.surface.gravity_m_s2());
                        contact = Some(self.point(met_m, stretch.height_m(stretch.share(met_m))));
                    }
                    // On the last stretch, coming down early is an early landing.
                    if matches!(stretch.end, StretchEnd::Edge(_)) {
                        let x_m = self.point(state.distance_m, 0.0).x_m;
                        let known = flight.underground.unwrap_or((x_m, over_m));
                        flight.underground = Some((known.0, known.1.min(over_m)));
                    }
                }
                before = state;
            }
        }
        contact
    }

    /// Where a flight that passes over its landing comes down; `None` if the known ground ends first.
    ///
    /// The arc is concave, so it has met a straight stretch if and only if it is below that stretch's end.
    fn beyond(&self, landing: State) -> Option<ChainPoint> {
        let mut before = landing;
        for stretch in self.stretches_beyond() {
            let state = before.at(stretch.to.0, self.surface.gravity_m_s2());
            if state.height_m < stretch.to.1 {
                let met_m = stretch.contact_m(before, state, self.surface.gravity_m_s2());
                return Some(self.point(met_m, stretch.height_m(stretch.share(met_m))));
            }
            before = state;
        }
        None
    }
}
