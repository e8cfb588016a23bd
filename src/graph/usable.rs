//! Whether the start or the goal itself refuses every hop.

use crate::{
    chain::{ConstrainedChain, GroundRefusal, Station},
    quantity::VertexId,
    world::{Contact, Direction},
};

/// A start that allows no take-off, or a goal that allows no landing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndpointRefusal {
    /// Start (take-off) or goal (landing).
    pub contact: Contact,
    /// The station.
    pub station: Station,
    /// The reason, for the direction `direction`.
    pub refusal: GroundRefusal,
    /// The direction of travel of that reason; the other direction is refused as well.
    pub direction: Direction,
    /// The nearest usable point of the chain, by x; `None` if no point of the chain is usable.
    pub nearest: Option<Station>,
}

/// Whether a contact is allowed at a station in at least one direction of travel.
pub fn is_usable(chain: &ConstrainedChain, station: &Station, contact: Contact) -> bool {
    Direction::BOTH.into_iter().any(|direction| {
        chain.ruling(station, contact, direction).is_some_and(|segment| segment.allowed(contact, direction).is_some())
    })
}

/// Why a start or goal refuses every hop in both directions; `None` if it does not.
///
/// `towards` is the direction of the journey; the reason for this direction is returned.
pub fn endpoint_refusal(
    chain: &ConstrainedChain,
    station: &Station,
    contact: Contact,
    towards: Direction,
) -> Option<EndpointRefusal> {
    if is_usable(chain, station, contact) {
        return None;
    }
    let refusal_in = |direction| chain.check_contact(station, contact, direction).err().map(|refusal| (direction, refusal));
    let away = if towards == Direction::Forward { Direction::Reverse } else { Direction::Forward };
    // At the chain's end the ground ahead does not exist: the reason for the other direction is then more informative.
    let reason =
        [towards, away].into_iter().filter_map(refusal_in).min_by_key(|(_, refusal)| matches!(refusal, GroundRefusal::NoGround))?;
    let (direction, refusal) = reason;
    Some(EndpointRefusal { contact, station: *station, refusal, direction, nearest: nearest_usable(chain, station, contact) })
}

/// The nearest usable point by x.
///
/// The constraints of a segment are the same all over it, so the point is an end of a segment, or, if another segment rules
/// that vertex, a point inside at a hundredth of the segment's length.
fn nearest_usable(chain: &ConstrainedChain, station: &Station, contact: Contact) -> Option<Station> {
    let geometry = chain.geometry();
    let away = |other: &Station| (other.point.x_m - station.point.x_m).abs();
    let vertices = (0..=geometry.segment_count()).map(|i| geometry.vertex_station(VertexId(i)));
    let insides = geometry.vertices().windows(2).flat_map(|pair| {
        let run_m = pair[1].x_m - pair[0].x_m;
        [0.01, 0.99].into_iter().filter_map(move |share| geometry.station(pair[0].x_m + share * run_m).ok())
    });
    vertices.chain(insides).filter(|candidate| is_usable(chain, candidate, contact)).min_by(|a, b| away(a).total_cmp(&away(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        chain::PolygonalChain,
        quantity::ChainPoint,
        world::{FrictionCone, Gravity, Grip, Hopper, RestSlope, SurfaceProperties},
    };

    #[test]
    fn a_start_on_a_wall_reports_its_slope_and_the_nearest_flat_point() {
        let points = [(0.0, 0.0), (10.0, 0.0), (20.0, 20.0), (21.0, 40.0), (30.0, 40.0)];
        let chain = PolygonalChain::bare(points.map(|(x, z)| ChainPoint::new(x, z)).to_vec()).unwrap();
        let surface =
            SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.6).unwrap())), rest: RestSlope::AsFrictionHolds };
        let chain = ConstrainedChain::new(chain, &Hopper::with_speeds(10.0, 10.0).unwrap(), Gravity::new(3.711).unwrap(), &surface)
            .unwrap();
        let start = chain.geometry().station(18.0).unwrap();
        let refusal = endpoint_refusal(&chain, &start, Contact::Takeoff, Direction::Forward).unwrap();
        assert!(matches!(refusal.refusal, GroundRefusal::TooSteep { .. }));
        assert_eq!(refusal.nearest.unwrap().point.x_m, 21.0, "the plateau's edge, 3 m ahead, not the plain 8 m back");
        let flat = chain.geometry().station(5.0).unwrap();
        assert!(endpoint_refusal(&chain, &flat, Contact::Takeoff, Direction::Forward).is_none());
    }
}
