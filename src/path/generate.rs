//! From the legs of a search result to the commands of single hops (P Algorithm 4).

use super::{Hop, HopPath, NoCommand, Propellant, RollOut, Totals, heading_deg, steps::in_steps};
use crate::{
    ballistics::{Arc, TakeoffChoice, delta_v_m_s, propellant_kg},
    chain::Station,
    flight::{Command, HopErrors},
    graph::{Edge, Leg},
    ground::{ChainGround, ChainPosition, DemGround, Surface, heading_of},
    hop::{HopMargins, HopTest, SegmentHops, Split},
    planner::{Amount, Amounts, LayerTotals},
    quantity::{Angle, AngleInterval, SlopeInterval, total},
    terrain::MapLayers,
    world::{Contact, Direction, Hopper, Limit},
};

/// A path with too many hops to list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the path has {hops} hops, expected at most {} to list: raise the speed limits", TooManyHops::MOST)]
pub struct TooManyHops {
    /// How many hops the path has.
    pub hops: u64,
}

impl TooManyHops {
    /// The longest path that is listed: some 800 bytes per hop with its record, so 800 MB.
    pub const MOST: u64 = 1_000_000;
}

/// Why a path gives no list of hops.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    /// It has too many hops to list.
    #[error(transparent)]
    TooManyHops(#[from] TooManyHops),
    /// No commands in the machine's steps fly it.
    #[error(transparent)]
    NoCommand(#[from] NoCommand),
}

/// The hops of a path, in two dimensions, and in three if the chain lies on a map (P Algorithm 4, Remark 3).
///
/// If the hopper takes its commands in steps, each hop has the nearest command that keeps all limits, takes off where the one before
/// landed, and states what it was aimed at; where hops of full reach along a segment leave no room for that, they are equal.
///
/// # Errors
/// [`PathError`].
pub fn generate(test: &HopTest, legs: &[Leg], choice: TakeoffChoice, split: Split) -> Result<HopPath, PathError> {
    generate_over(test, None, legs, choice, split)
}

/// The same where the chain was cut from a DEM: a machine without a heading along the chain flies its nearest headings over the DEM,
/// beside the line.
///
/// ```text
///              o-----------------o----------------o     planned, along the chain
///               `.
///   takeoff      `x---------------x . . .               flown: each hop from where the one before landed
/// ```
///
/// Take-offs and landings of such hops have no station and lie on the map; their distance along the journey is that of their projection
/// on the line. Of a machine that has all headings of the path, and of one without steps, the hops are those of [`generate`].
///
/// # Errors
/// [`PathError`].
pub fn generate_over(
    test: &HopTest,
    dem: Option<&DemGround>,
    legs: &[Leg],
    choice: TakeoffChoice,
    split: Split,
) -> Result<HopPath, PathError> {
    let count = |leg: &Leg| match leg.edge {
        Edge::Hop(_) => 1,
        Edge::Along(along) => along.hops(),
    };
    let total = legs.iter().map(count).fold(0u64, u64::saturating_add);
    if total > TooManyHops::MOST {
        return Err(TooManyHops { hops: total }.into());
    }
    let hops = match in_steps(test, dem, exact(test, legs, choice, split), choice) {
        // Hops of full reach leave no room for steps.
        Err(NoCommand::Refused { .. }) if split == Split::FullReach => {
            in_steps(test, dem, exact(test, legs, choice, Split::Equal), choice)?
        }
        other => other?,
    };
    let path = HopPath::of_hops(hops, test.hopper());
    Ok(match test.chain().geometry().layers() {
        Some(layers) => path.with_costs_of(layers.map()),
        None => path,
    })
}

/// The hops of a path with exact commands.
fn exact(test: &HopTest, legs: &[Leg], choice: TakeoffChoice, split: Split) -> Vec<Hop> {
    let mut hops = Vec::new();
    for leg in legs {
        match leg.edge {
            Edge::Hop(lofts) => hops.extend(single(test, leg, lofts, choice)),
            Edge::Along(along) => hops.extend(along_segment(test, leg, &along, choice, split)),
        }
    }
    hops
}

impl HopPath {
    /// A path of hops in the order of travel, with its totals for a hopper.
    ///
    /// States the propellant of every hop: the mass falls from hop to hop.
    pub fn of_hops(mut hops: Vec<Hop>, hopper: &Hopper) -> Self {
        if let (Some(mass_kg), Some(isp_s)) = (hopper.limits().mass_kg, hopper.limits().isp_s) {
            let mut mass_kg = mass_kg;
            for hop in &mut hops {
                let used_kg = propellant_kg(mass_kg, hop.delta_v_m_s, isp_s);
                mass_kg -= used_kg;
                hop.propellant = Some(Propellant { used_kg, mass_end_kg: mass_kg });
            }
        }
        let totals = totals(&hops, hopper);
        Self { hops, totals }
    }
}

impl HopPath {
    /// The same with what the layers of a map cost.
    #[must_use]
    pub fn with_costs_of(mut self, layers: &MapLayers) -> Self {
        let ends = self.hops.iter().filter_map(Hop::map_ends);
        let costs = ends.flat_map(|(from, to)| layers.costs_of_hop(from, to));
        self.totals.layers = costs.fold(LayerTotals::NONE, |sums, (layer, cost)| sums.then(&LayerTotals::NONE.with(layer, cost)));
        self
    }

    /// What the path takes: the totals, with the number of hops, the sum of take-off speeds and the length of the arcs. Risk is 0.
    #[expect(clippy::cast_precision_loss, reason = "at most a million hops")]
    pub fn amounts(&self) -> Amounts {
        let totals = &self.totals;
        let sum = |of: &dyn Fn(&Hop) -> f64| total(self.hops.iter().map(of));
        // The length of an arc does not depend on gravity.
        let arc = |hop: &Hop| Arc::new(hop.line_of_sight(), hop.takeoff_angle.slope() - hop.line_of_sight().slope(), 1.0);
        Amounts::NONE
            .with(Amount::Hops, self.hops.len() as f64)
            .with(Amount::TakeoffSpeed, sum(&|hop| hop.takeoff_speed_m_s))
            .with(Amount::DeltaV, totals.delta_v_m_s)
            .with(Amount::Energy, totals.energy_j_kg)
            .with(Amount::FlightTime, totals.flight_time_s)
            .with(Amount::MissionTime, totals.mission_time_s.unwrap_or(totals.flight_time_s))
            .with(Amount::Distance, totals.ground_distance_m)
            .with(Amount::ArcLength, sum(&|hop| arc(hop).length_m()))
            .with(Amount::PeakSpeed, totals.peak_takeoff_speed_m_s)
            .with_layers(totals.layers)
    }
}

/// The hop of a leg with one hop.
fn single(test: &HopTest, leg: &Leg, lofts: SlopeInterval, choice: TakeoffChoice) -> Option<Hop> {
    let sight = test.line_of_sight(&leg.takeoff, &leg.landing)?;
    let loft = leg.loft.unwrap_or_else(|| test.loft(choice, sight, lofts));
    let arc = Arc::new(sight, loft, test.gravity_m_s2());
    Some(hop(test, leg.takeoff, leg.landing, &arc, lofts, Limit::TakeoffSpeed))
}

/// The hops of a leg that runs along one segment.
fn along_segment(test: &HopTest, leg: &Leg, along: &SegmentHops, choice: TakeoffChoice, split: Split) -> Vec<Hop> {
    let Some(direction) = Direction::between(leg.takeoff.point.x_m, leg.landing.point.x_m) else { return Vec::new() };
    let landings = full_reach_m(leg, along, direction, split).unwrap_or_else(|| equal_m(leg, along, direction));
    let mut hops = Vec::with_capacity(landings.len() + 1);
    let mut takeoff = leg.takeoff;
    let inside = landings.into_iter().map_while(|x_m| test.chain().geometry().station(x_m).ok());
    for landing in inside.chain([leg.landing]) {
        // The length between the stations themselves: rounding of their x must not move the landing.
        let length_m = (landing.point.x_m - takeoff.point.x_m).abs();
        let arc = along.arc(test, length_m, choice);
        // At full reach the set is one point, which rounding may lose: then the limit that ends the reach binds.
        hops.push(hop(test, takeoff, landing, &arc, along.lofts(test, length_m), along.reach().limit()));
        takeoff = landing;
    }
    hops
}

/// The x of all landings but the last for hops of full reach, m; `None` for another split, or if the last hop would be too long or too short.
///
/// An x far from zero has a coarse last digit, and a hop rounded up would exceed its reach (a hop of 1 mm at x = 200 km by 1e-8 of
/// itself, ten times the tolerance of a speed). Every x is therefore rounded towards its take-off; the last hop makes up for all.
fn full_reach_m(leg: &Leg, along: &SegmentHops, direction: Direction, split: Split) -> Option<Vec<f64>> {
    let (each_m, last_m) = along.lengths_m(split);
    if each_m == last_m {
        return None;
    }
    let mut from_m = leg.takeoff.point.x_m;
    let mut landings = Vec::new();
    for _ in 1..along.hops() {
        let x_m = from_m + direction.sign() * each_m;
        let towards_takeoff = if direction == Direction::Forward { x_m.next_down() } else { x_m.next_up() };
        from_m = if (x_m - from_m).abs() > each_m { towards_takeoff } else { x_m };
        landings.push(from_m);
    }
    let last_m = (leg.landing.point.x_m - from_m).abs();
    (last_m <= each_m && last_m >= along.reach().shortest_m()).then_some(landings)
}

/// The x of all landings but the last for hops of equal length, m.
fn equal_m(leg: &Leg, along: &SegmentHops, direction: Direction) -> Vec<f64> {
    let each_m = along.equal_m();
    #[expect(clippy::cast_precision_loss, reason = "at most a million hops")]
    let x_m = |i: u64| leg.takeoff.point.x_m + direction.sign() * each_m * i as f64;
    (1..along.hops()).map(x_m).collect()
}

/// A hop with all its numbers.
///
/// `otherwise` is the binding limit if the set is one point that rounding loses.
pub(super) fn hop(test: &HopTest, takeoff: Station, landing: Station, arc: &Arc, lofts: SlopeInterval, otherwise: Limit) -> Hop {
    let direction = if landing.point.x_m < takeoff.point.x_m { Direction::Reverse } else { Direction::Forward };
    let limit = |contact, station: &Station| {
        test.chain().check_contact(station, contact, direction).map_or(0.0, |rule| rule.speed_max_m_s())
    };
    let set = test.takeoff_set(&takeoff, &landing);
    let window = set.as_ref().and_then(|set| set.window_of(arc.loft()));
    let binding = window.map(|window| window.binding);
    let lofts = if test.takeoff_speeds().are_any() {
        lofts
    } else {
        let flown = SlopeInterval { lower: arc.loft(), upper: arc.loft() };
        window.map_or(flown, |window| window.lofts)
    };
    let angle = |loft: f64| Angle::from_slope(arc.line_of_sight().slope() + loft);
    let angles = |lofts: SlopeInterval| AngleInterval { min: angle(lofts.lower), max: angle(lofts.upper) };
    let takeoff_speed_m_s = arc.takeoff_speed_m_s();
    let landing_speed_m_s = arc.landing_speed_m_s();
    let (from, to) = (test.chain().contact_point(&takeoff), test.chain().contact_point(&landing));
    Hop {
        direction,
        takeoff: from,
        landing: to,
        heading_deg: heading_deg(from.point_m.xy(), to.point_m.xy()),
        takeoff_angle: arc.takeoff_angle(),
        takeoff_speed_m_s,
        landing_angle: arc.landing_angle(),
        landing_speed_m_s,
        flight_time_s: arc.flight_time_s(),
        apex_z_m: takeoff.point.z_m + arc.apex_height_m(),
        delta_v_m_s: delta_v_m_s(arc, test.hopper().limits()),
        propellant: None,
        takeoff_angles: angles(lofts),
        speed_margin_m_s: (limit(Contact::Takeoff, &takeoff) - takeoff_speed_m_s)
            .min(limit(Contact::Landing, &landing) - landing_speed_m_s),
        lower_limit: binding.map_or(otherwise, |b| b.lower.limit),
        lower_vertex: binding.and_then(|b| b.lower.vertex),
        upper_limit: binding.map_or(otherwise, |b| b.upper.limit),
        aim: None,
        margins: HopMargins::of(test, &takeoff, &landing, arc).unwrap_or(HopMargins::UNLIMITED),
        roll_out: roll_out(test, takeoff, landing, arc),
    }
}

/// The bounces after a hop that is flown exactly; `None` for a hopper that stays where it lands.
fn roll_out(test: &HopTest, takeoff: Station, landing: Station, arc: &Arc) -> Option<RollOut> {
    test.hopper().limits().restitution?;
    let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
    let [from, aim] = [takeoff, landing].map(ChainPosition::on_chain);
    let command = Command::of_arc(arc, heading_of(direction), aim);
    let flown = HopErrors::default().fly(&ChainGround::new(test.clone()), &from, &command.liftoff, &aim);
    Some(RollOut {
        bounces: flown.bounces.count,
        distance_m: direction.sign() * (flown.rest.station.point.x_m - landing.point.x_m),
        time_s: flown.bounces.time_s,
        rests: flown.failure.is_none(),
    })
}

/// The totals of hops.
fn totals(hops: &[Hop], hopper: &Hopper) -> Totals {
    let sum = |of: fn(&Hop) -> f64| total(hops.iter().map(of));
    let flight_time_s = sum(|h| h.flight_time_s);
    let energy_j_kg = sum(|h| 0.5 * h.takeoff_speed_m_s * h.takeoff_speed_m_s);
    let limits = hopper.limits();
    let energy_j_kg = limits.store_energy_j_kg(energy_j_kg, hops.len());
    let delta_v_m_s = sum(|h| h.delta_v_m_s);
    let propellant = limits.mass_kg.zip(limits.isp_s).map(|(mass_kg, isp_s)| {
        let used_kg = propellant_kg(mass_kg, delta_v_m_s, isp_s);
        Propellant { used_kg, mass_end_kg: mass_kg - used_kg }
    });
    let bounce_time_s = limits.restitution.map(|_| total(hops.iter().filter_map(|hop| Some(hop.roll_out?.time_s))));
    let on_the_ground_s = match (limits.ground_time_s(hops.len()), bounce_time_s) {
        (None, bounces_s) => bounces_s,
        (Some(ground_time_s), bounces_s) => Some(ground_time_s + bounces_s.unwrap_or(0.0)),
    };
    Totals {
        flight_time_s,
        bounce_time_s,
        energy_j_kg,
        peak_takeoff_speed_m_s: hops.iter().map(|h| h.takeoff_speed_m_s).fold(0.0, f64::max),
        ground_distance_m: sum(Hop::run_m),
        energy_j: limits.mass_kg.map(|mass_kg| mass_kg * energy_j_kg),
        mission_time_s: on_the_ground_s.map(|time_s| flight_time_s + time_s),
        delta_v_m_s,
        propellant,
        propellant_max_kg: limits.propellant_max_kg,
        propulsive: limits.is_propulsive(),
        of_store: limits.counts_store_energy(),
        layers: LayerTotals::NONE,
    }
}
