//! Whether the start or the goal itself refuses every hop.

use crate::{
    chain::{ChainLayers, ConstrainedChain, GroundRefusal, Station},
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

/// How far beside a border of a layer a usable point is looked for, as a share of the chain's length: far above rounding.
const BESIDE_A_BORDER: f64 = 1e-6;

/// Whether a contact is allowed at a station in at least one direction of travel.
pub fn is_usable(chain: &ConstrainedChain, station: &Station, contact: Contact) -> bool {
    Direction::BOTH.into_iter().any(|direction| chain.allowed(station, contact, direction).is_some())
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
/// that vertex, a point inside at a hundredth of the segment's length. With a footprint they are not: then the points half a footprint
/// beside every vertex, and those of a grid of quarters of a footprint (at most 10 000 points), are tried as well. Under layers those
/// beside every border are.
fn nearest_usable(chain: &ConstrainedChain, station: &Station, contact: Contact) -> Option<Station> {
    let geometry = chain.geometry();
    let away = |other: &Station| (other.point.x_m - station.point.x_m).abs();
    let vertices = (0..=geometry.segment_count()).map(|i| geometry.vertex_station(VertexId(i)));
    let insides = geometry.vertices().windows(2).flat_map(|pair| {
        let run_m = pair[1].x_m - pair[0].x_m;
        [0.01, 0.99].into_iter().filter_map(move |share| geometry.station(pair[0].x_m + share * run_m).ok())
    });
    let (first_m, last_m) = geometry.extent_m();
    let beside_m = BESIDE_A_BORDER * (last_m - first_m);
    let borders = geometry.layers().into_iter().flat_map(ChainLayers::contact_ends_m);
    let at = |x_m: f64| geometry.station(x_m).ok();
    let beside = borders.flat_map(|x_m| [x_m - beside_m, x_m + beside_m]).filter_map(at);
    let Some(footprint) = chain.footprint() else {
        return vertices
            .chain(insides)
            .chain(beside)
            .filter(|candidate| is_usable(chain, candidate, contact))
            .min_by(|a, b| away(a).total_cmp(&away(b)));
    };
    let half_m = 0.5 * footprint.diameter_m;
    let ends = geometry.vertices().iter().flat_map(|vertex| [vertex.x_m - half_m, vertex.x_m + half_m]);
    let step_m = (0.5 * half_m).max((last_m - first_m) / 10_000.0);
    let grid = (0..=10_000).map(|i| first_m + f64::from(i) * step_m).take_while(|x_m| *x_m <= last_m);
    let added = ends.chain(grid).filter_map(at);
    let mut nearest: Vec<Station> = vertices.chain(insides).chain(beside).chain(added).collect();
    nearest.sort_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.into_iter().find(|candidate| is_usable(chain, candidate, contact))
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
