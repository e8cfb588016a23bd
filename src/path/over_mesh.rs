//! The hops of a path over a mesh, of a hopper that is a point or of a robot with legs.

use nalgebra::Point3;

use super::{Hop, HopPath, heading_deg};
use crate::{
    ballistics::{Arc, ContactLimits, FlightEnvelope, delta_v_m_s},
    ground::{ContactPoint, MeshContact, MeshGround, MeshTakeoffSet, Stance, StanceGround},
    hop::{Flown, HopMargins},
    quantity::{Angle, AngleInterval},
    world::{Contact, Direction},
};

/// The hops along arcs from each contact of a mesh to the next, with everything that an operator needs; `None` where there are not as many
/// arcs as hops, or where a hop is not feasible over this mesh.
pub fn path_over_mesh(ground: &MeshGround, contacts: &[&MeshContact], arcs: &[Arc]) -> Option<HopPath> {
    if contacts.len() != arcs.len() + 1 {
        return None;
    }
    let mut hops = Vec::with_capacity(arcs.len());
    let mut along_m = 0.0;
    for (pair, arc) in contacts.windows(2).zip(arcs) {
        let hop = hop(ground, [pair[0], pair[1]], arc, along_m)?;
        along_m = hop.landing.along_m;
        hops.push(hop);
    }
    Some(HopPath::of_hops(hops, ground.envelope().hopper()))
}

/// The hops of a robot with legs along arcs, each between two of its stances, from which it may walk to the next pair; `None` where there are not as
/// many arcs as pairs, or where a hop is not feasible.
pub fn path_over_stances(ground: &StanceGround, pairs: &[[&Stance; 2]], arcs: &[Arc]) -> Option<HopPath> {
    if pairs.len() != arcs.len() {
        return None;
    }
    let envelope = ground.mesh().envelope();
    let mut hops = Vec::with_capacity(arcs.len());
    let mut along_m = 0.0;
    for (&ends, arc) in pairs.iter().zip(arcs) {
        let set = ground.takeoff_set(ends[0], ends[1])?;
        let heading = set.course().plane.heading;
        let known = Known {
            allowed: [(ends[0], Contact::Takeoff), (ends[1], Contact::Landing)].map(|(at, kind)| ground.allowed(at, heading, kind)),
            points_m: ends.map(|stance| stance.pose().root_m),
            terrain: ground.least_room(set.course(), ends, arc),
            // A robot rests where its feet bear its weight, whatever the slope.
            rest_deg: ends.map(|stance| stance.point().map_or(f64::INFINITY, |contact| ground.mesh().rest_margin_deg(contact))),
            set,
        };
        let hop = known.hop(envelope, arc, along_m)?;
        along_m = hop.landing.along_m;
        hops.push(hop);
    }
    Some(HopPath::of_hops(hops, envelope.hopper()))
}

/// The hop between two contacts of a mesh, with all its numbers; `along_m`: how far along the unrolled path it begins.
fn hop(ground: &MeshGround, [takeoff, landing]: [&MeshContact; 2], arc: &Arc, along_m: f64) -> Option<Hop> {
    let set = ground.takeoff_set(takeoff, landing)?;
    let heading = set.course().plane.heading;
    let [from, to] =
        [(takeoff, Contact::Takeoff), (landing, Contact::Landing)].map(|(at, kind)| ground.allowed(at, heading, kind).ok());
    let known = Known {
        allowed: [from?, to?],
        points_m: [takeoff, landing].map(MeshContact::point_m),
        terrain: ground.least_room(set.course(), arc),
        rest_deg: [takeoff, landing].map(|contact| ground.rest_margin_deg(contact)),
        set,
    };
    known.hop(ground.envelope(), arc, along_m)
}

/// What a ground knows of a hop.
struct Known {
    set: MeshTakeoffSet,
    /// What take-off and landing allow.
    allowed: [ContactLimits; 2],
    /// Where it begins and ends, m.
    points_m: [Point3<f64>; 2],
    /// The least room over and under the arc, m, and where.
    terrain: Option<(f64, f64)>,
    /// By how much both ends are less steep than the rest slope, degrees.
    rest_deg: [f64; 2],
}

impl Known {
    /// The hop along an arc.
    fn hop(&self, envelope: &FlightEnvelope, arc: &Arc, along_m: f64) -> Option<Hop> {
        let (course, limits) = (self.set.course(), envelope.hopper().limits());
        let window = self.set.window_of(arc.loft())?;
        let angle = |loft: f64| Angle::from_slope(course.sight.slope() + loft);
        let [from, to] = self.allowed;
        let (takeoff_speed_m_s, landing_speed_m_s) = (arc.takeoff_speed_m_s(), arc.landing_speed_m_s());
        let flown = Flown {
            arc,
            takeoff: from,
            landing: to,
            hopper: limits,
            mechanism: envelope.mechanism_slopes(),
            terrain: self.terrain,
            rest_deg: self.rest_deg,
            roughness_m: [f64::INFINITY; 2],
        };
        let at = |end: usize, along_m: f64| ContactPoint::on_map(along_m, self.points_m[end].xy(), self.points_m[end].z);
        Some(Hop {
            direction: Direction::Forward,
            takeoff: at(0, along_m),
            landing: at(1, along_m + course.sight.run_m()),
            heading_deg: heading_deg(self.points_m[0].xy(), self.points_m[1].xy()),
            takeoff_angle: arc.takeoff_angle(),
            takeoff_speed_m_s,
            landing_angle: arc.landing_angle(),
            landing_speed_m_s,
            flight_time_s: arc.flight_time_s(),
            apex_z_m: self.points_m[0].z + arc.apex_height_m(),
            delta_v_m_s: delta_v_m_s(arc, limits),
            propellant: None,
            takeoff_angles: AngleInterval { min: angle(window.lofts.lower), max: angle(window.lofts.upper) },
            speed_margin_m_s: (from.speed_max_m_s - takeoff_speed_m_s).min(to.speed_max_m_s - landing_speed_m_s),
            lower_limit: window.lower.limit,
            lower_vertex: None,
            upper_limit: window.upper.limit,
            margins: HopMargins::of_flown(&flown),
            aim: None,
            roll_out: None,
        })
    }
}
