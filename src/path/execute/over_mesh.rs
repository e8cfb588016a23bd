//! One hop flown by Newton's equations in three dimensions, against triangles that may stand over one another.
//!
//! ```text
//!        ____/\____  under it, all along
//!      .  - ' ' -  .
//!    /      /\       \         a triangle that a small step comes near is cut by the vertical plane of the flight;
//!   o______/  \_______\        over or under the cut, all along and at least the clearance away
//!          over it
//! ```

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};

use super::flight::{Clearance, Course, Flight, PLACE_TOLERANCE, STEPS_PER_FLIGHT, TooLow};
use crate::{
    ground::Triangulated,
    quantity::{Angle, FacetId},
    world::ClearanceRule,
};

/// Steps after the planned landing get longer by this factor: a hop of a millimetre may miss into a pit of a kilometre.
const LONGER: f64 = 1.5;

/// Steps of a flight at which the distance of a ball from the mesh is looked at.
const STEPS_OF_BALL: u32 = 512;

/// The most steps after the planned landing.
const STEPS_BEYOND: u32 = 400;

/// Position from the take-off and velocity of the hopper.
#[derive(Clone, Copy, Debug)]
struct State {
    away_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    time_s: f64,
}

impl State {
    /// After `step_s` under constant gravity (Newton; exact for any step).
    fn after(self, step_s: f64, gravity_m_s2: f64) -> Self {
        let pull = Vector3::new(0.0, 0.0, -gravity_m_s2);
        Self {
            away_m: self.away_m + self.velocity_m_s * step_s + pull * (0.5 * step_s * step_s),
            velocity_m_s: self.velocity_m_s + pull * step_s,
            time_s: self.time_s + step_s,
        }
    }
}

/// A place of the cut of a triangle: the distance along the flight, and the height over the take-off, m.
type Place = (f64, f64);

/// A part of the cut of a triangle by the plane of the flight, from its nearer to its farther end.
#[derive(Clone, Copy, Debug)]
struct Cut {
    facet: FacetId,
    from: Place,
    to: Place,
    /// Whether an end is one of the triangle, not of the stretch looked at.
    is_end: [bool; 2],
}

impl Cut {
    fn slope(&self) -> f64 {
        (self.to.1 - self.from.1) / (self.to.0 - self.from.0)
    }

    fn height_at_m(&self, distance_m: f64) -> f64 {
        self.from.1 + (self.to.1 - self.from.1) * ((distance_m - self.from.0) / (self.to.0 - self.from.0))
    }

    /// The part between two distances; `None` if the cut has no part there.
    fn between(&self, from_m: f64, to_m: f64) -> Option<Self> {
        if self.to.0 < from_m || self.from.0 > to_m {
            return None;
        }
        let mut part = *self;
        if self.from.0 < from_m {
            part.from = (from_m, self.height_at_m(from_m));
            part.is_end[0] = false;
        }
        if self.to.0 > to_m {
            part.to = (to_m, self.height_at_m(to_m));
            part.is_end[1] = false;
        }
        Some(part)
    }
}

/// The flight over one place of a cut.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::struct_field_names, reason = "all are lengths in m")]
struct Sample {
    distance_m: f64,
    /// Height of the flight over the cut, m.
    over_m: f64,
    required_m: f64,
    tolerance_m: f64,
}

impl Sample {
    /// By how much the flight keeps the clearance on a side of the cut (1 over it, -1 under it), m.
    fn room_m(&self, side: f64) -> f64 {
        side * self.over_m - self.required_m
    }
}

/// A place at which the flight touches the end of a cut from one side alone.
struct Touch {
    distance_m: f64,
    side: f64,
    facet: FacetId,
}

/// A flight in progress.
struct Flown<'a, S: Triangulated> {
    course: &'a Course<'a, S>,
    takeoff: State,
    across_m_s: f64,
    /// Tolerance of the height over a cut, m, on a level part of the flight.
    slack_m: f64,
}

/// Flies the hop as commanded; `None` if it does not leave the ground forwards.
pub(super) fn fly<S: Triangulated>(course: &Course<'_, S>) -> Option<Flight> {
    let (speed_m_s, angle_rad) = (course.hop.takeoff_speed_m_s, course.hop.takeoff_angle.radians());
    let across_m_s = speed_m_s * libm::cos(angle_rad);
    if !(across_m_s > 0.0 && across_m_s.is_finite()) {
        return None;
    }
    let velocity_m_s = Vector3::new(course.heading.x * across_m_s, course.heading.y * across_m_s, speed_m_s * libm::sin(angle_rad));
    let takeoff = State { away_m: Vector3::zeros(), velocity_m_s, time_s: 0.0 };
    let g = course.surface.gravity_m_s2();
    let (states, top_m) = stepped(takeoff, course.run_m / across_m_s, g);
    let landing = *states.last()?;
    let rise_m = course.hop.landing.point_m.z - course.hop.takeoff.point_m.z;
    let size_m = libm::hypot(course.run_m, top_m.max(rise_m.abs()).max(landing.away_m.z.abs()));
    let rounding_m = PLACE_TOLERANCE * size_m + course.surface.position_rounding_m();
    let place_tolerance_m = rounding_m + course.surface.height_rounding_m();
    let climb_m_s = landing.velocity_m_s.z;
    let mut flight = Flight {
        contact: None,
        landing_angle: Angle::from_slope(climb_m_s / across_m_s),
        landing_speed_m_s: libm::hypot(across_m_s, climb_m_s),
        flight_time_s: landing.time_s,
        apex_z_m: course.hop.takeoff.point_m.z + top_m,
        apex_height_m: top_m,
        least_clearance: None,
        steps: states.len() - 1,
        too_low: Vec::new(),
        underground: None,
        unknown_from_m: None,
        left_at_x_m: None,
        rounding_m,
        place_tolerance_m,
        hits: false,
        across_m_s,
        landing_climb_m_s: climb_m_s,
    };
    let flown = Flown { course, takeoff, across_m_s, slack_m: place_tolerance_m + course.surface.resolution_m() };
    let near_m = course.surface.resolution_m();
    let cuts = flown.cuts(&states);
    let between: Vec<Cut> = cuts.iter().filter_map(|cut| cut.between(near_m, course.run_m - near_m)).collect();
    let early_m = flown.look_at_cuts(&mut flight, &between, &states);
    if let Some(radius_m) = course.surface.hopper().limits().radius_m.filter(|radius_m| *radius_m > 0.0) {
        flown.ball(&mut flight, radius_m);
    }
    let over_m = (landing.away_m.z - rise_m) / libm::hypot(1.0, climb_m_s / across_m_s);
    flight.hits = early_m.is_none() && over_m.abs() <= place_tolerance_m;
    let at_distance = |distance_m: f64| course.point(distance_m, flown.at(distance_m).away_m.z);
    flight.contact = match early_m {
        Some(distance_m) => Some(at_distance(distance_m)),
        None if flight.hits => Some(course.hop.landing.in_profile()),
        None => match flown.beyond(landing) {
            Ok(distance_m) => Some(at_distance(distance_m)),
            Err(left_at_m) => {
                flight.left_at_x_m = Some(course.point(left_at_m, 0.0).x_m);
                None
            }
        },
    };
    Some(flight)
}

/// The states from the take-off to the landing in small steps, and the greatest height.
fn stepped(takeoff: State, time_s: f64, gravity_m_s2: f64) -> (Vec<State>, f64) {
    let (mut states, mut top_m) = (vec![takeoff], 0.0f64);
    let mut step = 1.0;
    while step <= STEPS_PER_FLIGHT {
        let before = states[states.len() - 1];
        let next = before.after(time_s * (step / STEPS_PER_FLIGHT) - before.time_s, gravity_m_s2);
        if before.velocity_m_s.z > 0.0 && next.velocity_m_s.z < 0.0 {
            // The top of the flight lies within this step: a step that ends exactly there.
            top_m = top_m.max(before.after(before.velocity_m_s.z / gravity_m_s2, gravity_m_s2).away_m.z);
        }
        top_m = top_m.max(next.away_m.z);
        states.push(next);
        step += 1.0;
    }
    (states, top_m)
}

impl<S: Triangulated> Flown<'_, S> {
    /// The state at a horizontal distance from the take-off.
    fn at(&self, distance_m: f64) -> State {
        self.takeoff.after(distance_m / self.across_m_s, self.course.surface.gravity_m_s2())
    }

    /// The cuts of all triangles that the steps come near, in the order of the mesh.
    fn cuts(&self, states: &[State]) -> Vec<Cut> {
        let origin = self.course.hop.takeoff.point_m;
        let clearance_m = self.course.surface.hopper().limits().clearance_m;
        let mut met: BTreeMap<FacetId, [Point3<f64>; 3]> = BTreeMap::new();
        for pair in states.windows(2) {
            let [from, to] = [&pair[0], &pair[1]];
            let step_s = to.time_s - from.time_s;
            // An arc is over its chord by at most g dt^2 / 8.
            let bow_m = 0.125 * self.course.surface.gravity_m_s2() * step_s * step_s;
            let margin = Vector3::repeat(2.0 * self.slack_m);
            let beside = Vector3::new(0.0, 0.0, clearance_m);
            let low = origin + from.away_m.inf(&to.away_m) - margin - beside;
            let high = origin + from.away_m.sup(&to.away_m) + margin + beside + Vector3::new(0.0, 0.0, bow_m);
            self.course.surface.visit_triangles([low, high], &mut |facet, corners| {
                met.insert(facet, *corners);
            });
        }
        met.iter().flat_map(|(facet, corners)| self.cut(*facet, corners)).collect()
    }

    /// The cut of a triangle by the plane of the flight. A corner within the resolution of the plane lies in it.
    fn cut(&self, facet: FacetId, corners: &[Point3<f64>; 3]) -> Vec<Cut> {
        let (heading, near_m) = (self.course.heading, self.course.surface.resolution_m());
        let placed = corners.map(|corner| {
            let away = corner - self.course.hop.takeoff.point_m;
            let left_m = heading.x * away.y - heading.y * away.x;
            ((heading.x * away.x + heading.y * away.y, away.z), if left_m.abs() <= near_m { 0.0 } else { left_m })
        });
        let mut ends: Vec<Place> = placed.iter().filter(|(_, left_m)| *left_m == 0.0).map(|(place, _)| *place).collect();
        for i in 0..3 {
            let ((a, left_a), (b, left_b)) = (placed[i], placed[(i + 1) % 3]);
            if left_a * left_b < 0.0 {
                let share = left_a / (left_a - left_b);
                ends.push((a.0 + (b.0 - a.0) * share, a.1 + (b.1 - a.1) * share));
            }
        }
        let part = |a: Place, b: Place| {
            let (from, to) = if b.0 < a.0 { (b, a) } else { (a, b) };
            Cut { facet, from, to, is_end: [true; 2] }
        };
        match ends[..] {
            [a] => vec![part(a, a)],
            [a, b] => vec![part(a, b)],
            // It lies in the plane as a whole.
            [a, b, c] => vec![part(a, b), part(b, c), part(c, a)],
            _ => Vec::new(),
        }
    }

    /// The flight over a cut: at both ends, where the clearance stops growing, where both run parallel, and at every small step.
    fn samples(&self, cut: &Cut, states: &[State]) -> Vec<Sample> {
        let limits = self.course.surface.hopper().limits();
        let (g, v) = (self.course.surface.gravity_m_s2(), self.across_m_s);
        let mut samples = Vec::new();
        let mut look = |distance_m: f64, height_m: f64, stretch: f64| {
            let state = self.at(distance_m);
            let climb = state.velocity_m_s.z / v;
            samples.push(Sample {
                distance_m,
                over_m: state.away_m.z - height_m,
                required_m: self.course.required_m(distance_m),
                tolerance_m: self.slack_m * libm::hypot(1.0, climb).max(stretch),
            });
        };
        look(cut.from.0, cut.from.1, 1.0);
        let length_m = cut.to.0 - cut.from.0;
        if length_m > 0.0 {
            let slope = cut.slope();
            let (taper, full_m) = match limits.clearance_rule {
                ClearanceRule::Tapered(taper) if limits.clearance_m > 0.0 => (taper, limits.clearance_m / taper),
                _ => (0.0, 0.0),
            };
            // v_z - g t = v s where the flight has the slope s.
            let parallel_m = [slope, slope - taper, slope + taper].map(|s| (self.takeoff.velocity_m_s.z - v * s) * v / g);
            let full_m = full_m.min(0.5 * self.course.run_m);
            let steps = states.iter().map(|state| state.time_s * v);
            let mut inside: Vec<f64> = parallel_m.into_iter().chain([full_m, self.course.run_m - full_m]).chain(steps).collect();
            inside.retain(|distance_m| cut.from.0 < *distance_m && *distance_m < cut.to.0);
            inside.sort_by(f64::total_cmp);
            for distance_m in inside {
                look(distance_m, cut.height_at_m(distance_m), libm::hypot(1.0, slope));
            }
        }
        look(cut.to.0, cut.to.1, 1.0);
        samples
    }

    /// Whether the flight passes over or under every cut; if not, the distance at which it first meets one.
    fn look_at_cuts(&self, flight: &mut Flight, cuts: &[Cut], states: &[State]) -> Option<f64> {
        let [from, to] = [&self.course.hop.takeoff, &self.course.hop.landing]
            .map(|stated| self.course.surface.contact_at(stated).map(|own| self.course.surface.touching(&own)).unwrap_or_default());
        let mut first_m: Option<f64> = None;
        let mut touches: Vec<Touch> = Vec::new();
        for cut in cuts {
            let samples = self.samples(cut, states);
            self.least_clearance(flight, cut, &samples);
            let passes = |side: f64| samples.iter().all(|sample| sample.room_m(side) >= -sample.tolerance_m);
            let mut allowed = [(1.0, passes(1.0)), (-1.0, passes(-1.0))];
            // A facet that one stands on is passed on its outer side.
            let stood_on = from.contains(&cut.facet) || to.contains(&cut.facet);
            let up = self.course.surface.outer_normal(cut.facet).z;
            if stood_on && up != 0.0 {
                allowed[usize::from(up > 0.0)].1 = false;
            }
            match allowed {
                [(_, true), (_, true)] => {}
                [(_, false), (_, false)] => {
                    flight.too_low.push(self.too_near(cut, &samples, if stood_on && up != 0.0 { Some(up.signum()) } else { None }));
                    let met_m = self.meets_m(cut, &samples, if stood_on { up } else { 0.0 });
                    first_m = first_m.into_iter().chain(met_m).reduce(f64::min);
                }
                [(over, is_over), (under, _)] => {
                    let side = if is_over { over } else { under };
                    let ends = [(samples.first(), cut.is_end[0]), (samples.last(), cut.is_end[1])];
                    touches.extend(ends.into_iter().filter_map(|(sample, is_end)| {
                        let sample = sample.filter(|sample| is_end && sample.over_m.abs() <= sample.tolerance_m)?;
                        Some(Touch { distance_m: sample.distance_m, side, facet: cut.facet })
                    }));
                }
            }
        }
        first_m.into_iter().chain(self.through_edge(flight, touches)).reduce(f64::min)
    }

    /// A ball comes no nearer to any facet than its radius, on every side of it: looked at in steps, where it is nearest.
    fn ball(&self, flight: &mut Flight, radius_m: f64) {
        let steps = f64::from(STEPS_OF_BALL);
        let distances_m = (0..=STEPS_OF_BALL).map(|step| self.course.run_m * (f64::from(step) / steps));
        let nearest = distances_m.map(|distance_m| {
            let (facet, away_m) = self.course.surface.nearest_m(&(self.course.hop.takeoff.point_m + self.at(distance_m).away_m));
            (distance_m, facet, away_m)
        });
        let Some((distance_m, facet, away_m)) = nearest.min_by(|a, b| a.2.total_cmp(&b.2)) else { return };
        if away_m < radius_m - self.slack_m {
            let x_m = self.course.point(distance_m, 0.0).x_m;
            let over = Clearance { vertex: None, facet: Some(facet), x_m, height_m: away_m };
            flight.too_low.push(TooLow { over, required_m: radius_m });
        }
    }

    /// A flight that touches the ends of two cuts at one place from opposite sides passes through the edge that they share.
    fn through_edge(&self, flight: &mut Flight, mut touches: Vec<Touch>) -> Option<f64> {
        touches.sort_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
        let opposite =
            |pair: &&[Touch]| pair[0].side != pair[1].side && pair[1].distance_m - pair[0].distance_m <= 2.0 * self.slack_m;
        let pair = touches.windows(2).find(opposite)?;
        let distance_m = pair[0].distance_m;
        let over = Clearance {
            vertex: None,
            facet: Some(pair[0].facet.min(pair[1].facet)),
            x_m: self.course.point(distance_m, 0.0).x_m,
            height_m: 0.0,
        };
        flight.too_low.push(TooLow { over, required_m: self.course.required_m(distance_m) });
        Some(distance_m)
    }

    /// The least distance over or under the edges flown past.
    fn least_clearance(&self, flight: &mut Flight, cut: &Cut, samples: &[Sample]) {
        let ends = samples.iter().take(1).zip([cut.is_end[0]]).chain(samples.last().into_iter().zip([cut.is_end[1]]));
        for (sample, _) in ends.filter(|(_, is_end)| *is_end) {
            let height_m = sample.over_m.abs();
            if flight.least_clearance.is_none_or(|least| height_m < least.height_m) {
                let x_m = self.course.point(sample.distance_m, 0.0).x_m;
                flight.least_clearance = Some(Clearance { vertex: None, facet: Some(cut.facet), x_m, height_m });
            }
        }
    }

    /// The place at which the flight is nearest to a facet, or deepest behind it, on the given side, or on the side on which it is less so.
    fn too_near(&self, cut: &Cut, samples: &[Sample], side: Option<f64>) -> TooLow {
        let worst = |side: f64| {
            let by_room = |a: &&Sample, b: &&Sample| a.room_m(side).total_cmp(&b.room_m(side));
            samples
                .iter()
                .min_by(by_room)
                .map_or((side, 0.0, 0.0, f64::INFINITY), |sample| (side, sample.distance_m, sample.required_m, sample.room_m(side)))
        };
        let (_, distance_m, required_m, room_m) = match side {
            Some(side) => worst(side),
            None => [worst(1.0), worst(-1.0)].into_iter().max_by(|a, b| a.3.total_cmp(&b.3)).unwrap_or_else(|| worst(1.0)),
        };
        let x_m = self.course.point(distance_m, 0.0).x_m;
        let height_m = room_m + required_m;
        TooLow { over: Clearance { vertex: None, facet: Some(cut.facet), x_m, height_m }, required_m }
    }

    /// The distance at which the flight crosses a cut, by bisection, or is first behind a facet that it stands on, whose normal rises by
    /// `outer`; `None` if it only comes too near.
    fn meets_m(&self, cut: &Cut, samples: &[Sample], outer: f64) -> Option<f64> {
        let beyond = |sample: &&Sample| sample.over_m.abs() > sample.tolerance_m;
        let mut before: Option<&Sample> = None;
        for sample in samples.iter().filter(beyond) {
            if outer * sample.over_m < 0.0 && before.is_none() {
                return Some(sample.distance_m);
            }
            if let Some(before) = before.filter(|before| before.over_m * sample.over_m < 0.0) {
                let (mut near_m, mut far_m) = (before.distance_m, sample.distance_m);
                loop {
                    let middle_m = 0.5 * (near_m + far_m);
                    if middle_m <= near_m || middle_m >= far_m {
                        return Some(near_m);
                    }
                    let over_m = self.at(middle_m).away_m.z - cut.height_at_m(middle_m);
                    if over_m * before.over_m > 0.0 { near_m = middle_m } else { far_m = middle_m }
                }
            }
            before = Some(sample);
        }
        None
    }

    /// Where a flight that misses its landing meets the mesh after it, m from the take-off.
    ///
    /// # Errors
    /// Where it leaves the box around the mesh.
    fn beyond(&self, landing: State) -> Result<f64, f64> {
        let g = self.course.surface.gravity_m_s2();
        let [low, high] = self.course.surface.bounds();
        let origin = self.course.hop.takeoff.point_m;
        let mut step_s = landing.time_s / STEPS_PER_FLIGHT;
        let mut states = [landing; 2];
        for _ in 0..STEPS_BEYOND {
            let next = states[1].after(step_s, g);
            states = [states[1], next];
            let [from_m, to_m] = states.map(|state| state.time_s * self.across_m_s);
            let parts = self.cuts(&states).into_iter().filter_map(|cut| cut.between(from_m, to_m));
            let met = parts.filter_map(|cut| self.meets_m(&cut, &self.samples(&cut, &states), 0.0)).reduce(f64::min);
            if let Some(met_m) = met {
                return Ok(met_m);
            }
            let at = origin + next.away_m;
            let is_beside = at.x < low.x || at.x > high.x || at.y < low.y || at.y > high.y;
            if is_beside || at.z < low.z {
                return Err(to_m);
            }
            step_s *= LONGER;
        }
        Err(states[1].time_s * self.across_m_s)
    }
}
