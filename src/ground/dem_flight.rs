//! Flights in three dimensions, over the triangles of a DEM.

use nalgebra::{Point3, Vector2, Vector3};

use super::{
    DemGround, FirstContact, Flight, LiftoffVelocity, MapPosition, Surface, TouchdownState,
    chain_flight::comes_down_m,
    dem::{BESIDE_M, Gradient},
    first_contact::{ANGLE_TOLERANCE_RAD, ContactFailure, PLACE_TOLERANCE, Realization, check_landing, failure_of, holds},
    rest::rests,
};
use crate::{
    chain::{LineConstraints, contains_straight_down},
    quantity::MapPoint,
    terrain::{FacetSpan, Triangles},
    world::Grip,
};

impl DemGround {
    /// Height of a post in this trial.
    #[inline]
    fn heights<'a>(&'a self, triangles: Triangles<'a>) -> impl Fn(usize, usize) -> f64 + 'a {
        let dem = self.terrain().dem();
        let nominal = move |row, col| dem.elevation(row, col).unwrap_or(f64::NAN);
        let origin = dem.georeference().north_west();
        move |row, col| match &self.realization.heights {
            None => nominal(row, col),
            Some(field) => {
                let away = triangles.post(row, col) - origin;
                nominal(row, col) + field.at(away.x, away.y)
            }
        }
    }

    /// The facet ahead of a take-off; `None` if the known ground ends there.
    fn facet_ahead(&self, at: MapPoint, heading: Vector2<f64>) -> Option<Gradient> {
        let triangles = self.triangles();
        triangles.walk(at, heading, self.heights(triangles)).next().map(|span| span.gradient)
    }

    /// The friction at a position in this trial.
    fn friction(&self, at: MapPoint) -> Option<f64> {
        self.nominal_friction(at).map(|cone| (cone.coefficient() + self.realization.friction).max(0.0))
    }

    fn is_kept_out(&self, at: MapPoint) -> bool {
        self.terrain().overlays().keeps_out(at)
    }

    /// Whether a contact at a position, of which the ground `beside` it rules, lies in a keep-out zone or where a layer refuses it.
    fn is_off_limits(&self, at: MapPoint, beside: MapPoint) -> bool {
        self.is_kept_out(beside) || self.layers().refusing_contact(at).is_some()
    }

    /// Whether the hopper rests at a position on a facet with this friction: on the facet, or with a footprint on the plane fitted
    /// over it.
    fn rests(&self, at: &MapPosition, gradient: Gradient, friction: Option<f64>) -> Result<(), ContactFailure> {
        if self.footprint.is_some() {
            return self.footprint_refusal(at, friction).map_or(Ok(()), |refusal| Err(failure_of(&refusal)));
        }
        let rests = rests(self.surface().rest, gradient, friction, ANGLE_TOLERANCE_RAD);
        if rests { Ok(()) } else { Err(ContactFailure::Slides) }
    }

    /// The stated angles of a facet for a heading, if angles are stated.
    fn stated(&self, gradient: Gradient, heading: Vector2<f64>) -> Option<LineConstraints> {
        let Some(Grip::FromSlope { takeoff, landing }) = self.surface().grip else { return None };
        let limits = self.hopper().limits();
        let slope = gradient.dot(&heading);
        Some(LineConstraints::from_offsets(slope, takeoff, landing, limits.takeoff_speed_max_m_s, limits.landing_speed_max_m_s))
    }

    /// The aim, with the tolerances within which an arc lands on it; `None` if this arc misses it.
    fn aimed_at(
        &self,
        from: &MapPosition,
        liftoff: &LiftoffVelocity,
        aim: &MapPosition,
        slope: f64,
        curvature: f64,
    ) -> Option<Aimed> {
        let away = aim.at - from.at;
        let run_m = away.dot(&liftoff.heading);
        let rise_m = aim.z_m - from.z_m;
        let top_m = liftoff.vertical_m_s * liftoff.vertical_m_s / (2.0 * self.gravity_m_s2());
        let slack_m = PLACE_TOLERANCE * (run_m + top_m + rise_m.abs()) + self.position_rounding_m();
        let across_m = liftoff.heading.perp(&away).abs();
        let steepness = 1.0 + (slope - 2.0 * curvature * run_m).abs();
        let over_m = run_m * (slope - curvature * run_m) - rise_m;
        let height_slack_m = slack_m * steepness + self.height_rounding_m();
        let hits = run_m > 0.0 && across_m <= slack_m && over_m.abs() <= height_slack_m && self.realization.heights.is_none();
        hits.then_some(Aimed { run: run_m, slack: slack_m, height_slack: height_slack_m })
    }
}

/// The aim of a flight that passes it within rounding; lengths in m.
#[derive(Clone, Copy)]
struct Aimed {
    run: f64,
    slack: f64,
    height_slack: f64,
}

impl FirstContact for DemGround {
    type SupportFacet = Gradient;

    fn realize(&mut self, realization: Realization) {
        self.realization = realization;
    }

    fn realized(&self, planned: MapPosition) -> MapPosition {
        if self.realization.heights.is_none() {
            return planned;
        }
        self.triangles().at(planned.at, self.heights(self.triangles())).map_or(planned, |(z_m, _)| MapPosition { z_m, ..planned })
    }

    fn point(&self, position: &MapPosition) -> Point3<f64> {
        Point3::new(position.at.x, position.at.y, position.z_m)
    }

    fn holds_takeoff(&self, from: &MapPosition, liftoff: &LiftoffVelocity) -> bool {
        let Some(gradient) = self.facet_ahead(from.at, liftoff.heading) else {
            // Beyond the edge of the known ground there is nothing to check.
            return true;
        };
        let ahead = from.at + liftoff.heading * BESIDE_M;
        if self.is_kept_out(ahead) {
            return false;
        }
        let friction = self.friction(ahead);
        if self.rests(from, gradient, friction).is_err() {
            return false;
        }
        match (friction, self.stated(gradient, liftoff.heading)) {
            (Some(friction), _) => holds_on(normal_of(gradient), friction, velocity(liftoff), ANGLE_TOLERANCE_RAD),
            (None, Some(stated)) => holds(Ok(stated.takeoff), liftoff),
            (None, None) => false,
        }
    }

    fn first_contact(&self, from: &MapPosition, liftoff: &LiftoffVelocity, aim: &MapPosition) -> Flight<MapPosition, Gradient> {
        let g = self.gravity_m_s2();
        let across = liftoff.horizontal_m_s;
        let (slope, curvature) = (liftoff.vertical_m_s / across, g / (2.0 * across * across));
        let mut last = FacetSpan { from_m: 0.0, to_m: 0.0, from_z_m: from.z_m, to_z_m: from.z_m, gradient: Gradient::zeros() };
        if !(curvature.is_finite() && slope.is_finite()) {
            // Straight up: it lands where it took off.
            let time_s = (2.0 * liftoff.vertical_m_s / g).max(0.0);
            return Flight { end: *from, support_facet: self.facet_ahead(from.at, liftoff.heading), time_s };
        }
        let aimed = self.aimed_at(from, liftoff, aim, slope, curvature);
        let mut over_m = 0.0;
        let triangles = self.triangles();
        for span in triangles.walk(from.at, liftoff.heading, self.heights(triangles)) {
            if let Some(aimed) = aimed
                && span.to_m >= aimed.run - aimed.slack
            {
                return Flight { end: *aim, support_facet: Some(span.gradient), time_s: aimed.run / across };
            }
            if span.to_m == span.from_m {
                continue;
            }
            let ground = span.gradient.dot(&liftoff.heading);
            // The first facet contains the take-off, so the height above it is 0 there, without rounding.
            let over_next_m = if last.to_m == 0.0 {
                span.to_m * ((slope - ground) - curvature * span.to_m)
            } else {
                (from.z_m - span.to_z_m) + span.to_m * (slope - curvature * span.to_m)
            };
            if over_next_m <= 0.0 && aimed.is_none_or(|aimed| over_next_m < -aimed.height_slack) {
                let climb = slope - 2.0 * curvature * span.from_m - ground;
                let further_m = comes_down_m(over_m, climb, curvature).min(span.to_m - span.from_m);
                let distance_m = span.from_m + further_m;
                let end = if distance_m == 0.0 {
                    *from
                } else {
                    let share = further_m / (span.to_m - span.from_m);
                    let z_m = span.from_z_m + (span.to_z_m - span.from_z_m) * share;
                    MapPosition { at: from.at + liftoff.heading * distance_m, z_m }
                };
                return Flight { end, support_facet: Some(span.gradient), time_s: distance_m / across };
            }
            over_m = over_next_m.max(0.0);
            last = span;
        }
        let end = MapPosition { at: from.at + liftoff.heading * last.to_m, z_m: last.to_z_m };
        Flight { end, support_facet: None, time_s: last.to_m / across }
    }

    fn check_landing(&self, end: &MapPosition, support_facet: &Gradient, touchdown: &TouchdownState) -> Result<(), ContactFailure> {
        let flown_over = end.at - touchdown.heading * BESIDE_M;
        let limits = self.hopper().limits();
        let landing_speed_max_m_s = limits.arc_landing_speed_max_m_s();
        if self.is_off_limits(end.at, flown_over) {
            return Err(ContactFailure::OffLimits);
        }
        if touchdown.is_over(landing_speed_max_m_s) {
            return Err(ContactFailure::TooFast);
        }
        let friction = self.friction(flown_over);
        self.rests(end, *support_facet, friction)?;
        match (friction, self.stated(*support_facet, touchdown.heading)) {
            (Some(friction), _) if limits.landing.brakes() => {
                let held = holds_on(normal_of(*support_facet), friction, Vector3::z(), touchdown.angle_tolerance_rad);
                if held { Ok(()) } else { Err(ContactFailure::Slides) }
            }
            (None, Some(stated)) if limits.landing.brakes() => {
                if contains_straight_down(stated.landing.angles()) {
                    Ok(())
                } else {
                    Err(ContactFailure::Slides)
                }
            }
            (Some(friction), _) => {
                let across = touchdown.heading * touchdown.horizontal_m_s;
                let back = -Vector3::new(across.x, across.y, touchdown.vertical_m_s);
                let held = holds_on(normal_of(*support_facet), friction, back, touchdown.angle_tolerance_rad);
                if held { Ok(()) } else { Err(ContactFailure::Slides) }
            }
            (None, Some(stated)) => check_landing(Ok(stated.landing), landing_speed_max_m_s, touchdown),
            (None, None) => Err(ContactFailure::Slides),
        }
    }

    fn check_track(&self, from: &MapPosition, end: &MapPosition) -> Result<(), ContactFailure> {
        if self.layers().refusing_flight(from.at, end.at).is_some() { Err(ContactFailure::OffLimits) } else { Ok(()) }
    }

    fn normal(&self, facet: &Gradient) -> Vector3<f64> {
        normal_of(*facet)
    }

    fn check_bounce(&self, end: &MapPosition, _facet: &Gradient, touchdown: &TouchdownState) -> Result<(), ContactFailure> {
        if self.is_off_limits(end.at, end.at - touchdown.heading * BESIDE_M) {
            return Err(ContactFailure::OffLimits);
        }
        if touchdown.is_over(self.hopper().limits().landing_speed_max_m_s) {
            return Err(ContactFailure::TooFast);
        }
        Ok(())
    }

    fn check_rest(&self, position: &MapPosition, facet: &Gradient, heading: Vector2<f64>) -> Result<(), ContactFailure> {
        self.rests(position, *facet, self.friction(position.at - heading * BESIDE_M))
    }

    fn displaced(
        &self,
        from: &MapPosition,
        heading: Vector2<f64>,
        along_m: f64,
        left_m: f64,
    ) -> Result<MapPosition, ContactFailure> {
        if along_m == 0.0 && left_m == 0.0 {
            return Ok(*from);
        }
        let left = Vector2::new(-heading.y, heading.x);
        let at = from.at + heading * along_m + left * left_m;
        let (z_m, gradient) = self.triangles().at(at, self.heights(self.triangles())).ok_or(ContactFailure::OffLimits)?;
        if self.is_off_limits(at, at) {
            return Err(ContactFailure::OffLimits);
        }
        let position = MapPosition { at, z_m };
        self.rests(&position, gradient, self.friction(at)).map(|()| position)
    }

    fn believed(&self, position: &MapPosition, along_m: f64, across_m: f64) -> Option<MapPosition> {
        if along_m == 0.0 && across_m == 0.0 && self.realization.heights.is_none() {
            return Some(*position);
        }
        self.position(position.at + Vector2::new(along_m, across_m))
    }
}

fn velocity(liftoff: &LiftoffVelocity) -> Vector3<f64> {
    Vector3::new(liftoff.heading.x * liftoff.horizontal_m_s, liftoff.heading.y * liftoff.horizontal_m_s, liftoff.vertical_m_s)
}

/// The upward normal of a facet with this gradient.
fn normal_of(gradient: Gradient) -> Vector3<f64> {
    Vector3::new(-gradient.x, -gradient.y, 1.0)
}

/// Whether a facet with this normal, of any length, and friction holds a velocity that points away from it.
///
/// ```text
///     |v - (n . v) n| <= mu (n . v)
/// ```
///
/// This is the friction cone itself; a slice has the cone's section by the plane of travel.
pub(super) fn holds_on(normal: Vector3<f64>, friction: f64, away: Vector3<f64>, tolerance_rad: f64) -> bool {
    let upward = normal.dot(&away);
    // |n x v| is the length of n times the component of v along the facet.
    let along2 = normal.cross(&away).norm_squared();
    let friction = friction + tolerance_rad * (1.0 + friction * friction);
    upward > 0.0 && along2 <= (friction * upward) * (friction * upward)
}
