//! The hops of a path over a mesh.

use super::{Hop, HopPath, heading_deg};
use crate::{
    ballistics::{Arc, delta_v_m_s},
    ground::{MeshContact, MeshGround},
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

/// A hop with all its numbers; `along_m`: how far along the unrolled path it begins.
fn hop(ground: &MeshGround, [takeoff, landing]: [&MeshContact; 2], arc: &Arc, along_m: f64) -> Option<Hop> {
    let (set, limits) = (ground.takeoff_set(takeoff, landing)?, ground.envelope().hopper().limits());
    let course = *set.course();
    let heading = course.plane.heading;
    let [from, to] =
        [(takeoff, Contact::Takeoff), (landing, Contact::Landing)].map(|(at, kind)| ground.allowed(at, heading, kind).ok());
    let (from, to) = (from?, to?);
    let window = set.window_of(arc.loft())?;
    let lofts = window.lofts;
    let angle = |loft: f64| Angle::from_slope(course.sight.slope() + loft);
    let (takeoff_speed_m_s, landing_speed_m_s) = (arc.takeoff_speed_m_s(), arc.landing_speed_m_s());
    let flown = Flown {
        arc,
        takeoff: from,
        landing: to,
        hopper: limits,
        mechanism: ground.envelope().mechanism_slopes(),
        terrain: ground.least_room(&course, arc),
        rest_deg: [takeoff, landing].map(|contact| ground.rest_margin_deg(contact)),
        roughness_m: [f64::INFINITY; 2],
    };
    Some(Hop {
        direction: Direction::Forward,
        takeoff: takeoff.at_m(along_m),
        landing: landing.at_m(along_m + course.sight.run_m()),
        heading_deg: heading_deg(takeoff.point_m().xy(), landing.point_m().xy()),
        takeoff_angle: arc.takeoff_angle(),
        takeoff_speed_m_s,
        landing_angle: arc.landing_angle(),
        landing_speed_m_s,
        flight_time_s: arc.flight_time_s(),
        apex_z_m: takeoff.point_m().z + arc.apex_height_m(),
        delta_v_m_s: delta_v_m_s(arc, limits),
        propellant: None,
        takeoff_angles: AngleInterval { min: angle(lofts.lower), max: angle(lofts.upper) },
        speed_margin_m_s: (from.speed_max_m_s - takeoff_speed_m_s).min(to.speed_max_m_s - landing_speed_m_s),
        lower_limit: window.lower.limit,
        lower_vertex: None,
        upper_limit: window.upper.limit,
        margins: HopMargins::of_flown(&flown),
        aim: None,
        roll_out: None,
    })
}
