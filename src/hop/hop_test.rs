//! The hop test: whether a single hop can join two stations, and with which take-off slopes.

use std::sync::{Arc, OnceLock};

use super::{SegmentHops, SegmentReach, TakeoffSet, flown_past, reach::Relief, terrain::kinks_loft};
use crate::{
    ballistics::{FlightEnvelope, LineOfSight, TakeoffChoice, TakeoffSpeeds, TakeoffWindow, limits},
    chain::{ConstrainedChain, ContactRule, Footing, Station, contacts_stand},
    quantity::{SegmentId, SlopeInterval},
    world::{Contact, Direction, Hopper, Limit},
};

/// The hop test of a chain with its hopper and gravity: it answers for any pair of stations.
///
/// It shares its chain, and its tables are computed when they are first needed: creating or cloning it is cheap, and it can be kept
/// and sent to other threads.
///
/// The kernel, [`lofts`](Self::lofts), uses no trigonometry and no allocation; [`takeoff_set`](Self::takeoff_set) explains
/// the result.
#[derive(Clone, Debug)]
pub struct HopTest {
    chain: Arc<ConstrainedChain>,
    envelope: FlightEnvelope,
    tables: Arc<Tables>,
}

/// Tables that searches use repeatedly, each computed when it is first needed.
#[derive(Debug, Default)]
struct Tables {
    /// Bounds of height and speed over any part of the chain.
    relief: OnceLock<Relief>,
    /// The possible hops along each segment, by direction.
    reaches: OnceLock<Vec<[Vec<SegmentReach>; 2]>>,
}

impl HopTest {
    /// The test for a chain, with its hopper and gravity.
    pub fn new(chain: impl Into<Arc<ConstrainedChain>>) -> Self {
        let chain = chain.into();
        let envelope = FlightEnvelope::new(chain.hopper(), chain.gravity());
        Self { chain, envelope, tables: Arc::default() }
    }

    /// The chain.
    #[inline]
    pub fn chain(&self) -> &ConstrainedChain {
        &self.chain
    }

    /// The chain, as a shared pointer.
    pub fn shared_chain(&self) -> Arc<ConstrainedChain> {
        Arc::clone(&self.chain)
    }

    /// The hopper.
    pub const fn hopper(&self) -> &Hopper {
        self.envelope.hopper()
    }

    /// The height to keep over the ground.
    #[inline]
    pub const fn clearance(&self) -> limits::ClearanceProfile {
        self.envelope.clearance()
    }

    /// Gravity, m/s^2.
    pub const fn gravity_m_s2(&self) -> f64 {
        self.envelope.gravity_m_s2()
    }

    /// Bounds of height and speed over any part of the chain.
    pub(super) fn relief(&self) -> &Relief {
        self.tables.relief.get_or_init(|| Relief::of(&self.chain))
    }

    /// The possible hops along each segment, by direction.
    fn reaches(&self) -> &[[Vec<SegmentReach>; 2]] {
        self.tables.reaches.get_or_init(|| {
            (0..self.chain.segments().len())
                .map(|i| Direction::BOTH.map(|direction| SegmentReach::all_on(self, SegmentId(i), direction)))
                .collect()
        })
    }

    /// The take-off slopes that the take-off mechanism can produce: from the hopper's least to its greatest take-off angle.
    pub const fn mechanism_slopes(&self) -> SlopeInterval {
        self.envelope.mechanism_slopes()
    }

    /// The line of sight between two stations in the direction of travel; `None` if both have the same x.
    ///
    /// For two stations on one segment its slope is the segment's own slope: the difference of two nearly equal heights would
    /// lose digits.
    #[inline]
    pub fn line_of_sight(&self, takeoff: &Station, landing: &Station) -> Option<LineOfSight> {
        let run_m = (landing.point.x_m - takeoff.point.x_m).abs();
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
        Some(match takeoff.shared_segment(landing) {
            Some(segment) => LineOfSight::along(run_m, direction.sign() * self.chain.geometry().slopes()[segment.index()]),
            None => LineOfSight::new(run_m, landing.point.z_m - takeoff.point.z_m),
        })
    }

    /// Feasible lofts (take-off slope minus line-of-sight slope, see [`crate::ballistics`]) of one hop between two stations under
    /// all limits, or the limit that leaves no arc.
    ///
    /// Cheap limits are tested first and the terrain last; the test stops at the first point of the ground that leaves no arc.
    ///
    /// Of a machine that cannot be commanded every take-off speed, the interval is that of all other limits: it contains an arc that
    /// the machine has, [`windows`](Self::windows) are all of them, and [`loft`](Self::loft) is the one to fly.
    ///
    /// Source: CHTA paper, eq. 21.
    ///
    /// # Errors
    /// The first limit, in the order of testing (ground, bends, speeds, cones, take-off mechanism, apex and time, terrain, commands), that
    /// leaves no arc together with those before it. [`takeoff_set`](Self::takeoff_set) evaluates every limit. [`Limit::Direction`]
    /// if both stations have the same x.
    #[inline]
    pub fn lofts(&self, takeoff: &Station, landing: &Station) -> Result<SlopeInterval, Limit> {
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m).ok_or(Limit::Direction)?;
        let from = self.allowed(takeoff, Contact::Takeoff, direction)?;
        let to = self.allowed(landing, Contact::Landing, direction)?;
        if self.chain.geometry().bend_between(takeoff.point.x_m, landing.point.x_m).is_some() {
            return Err(Limit::Bend);
        }
        if let Some(layer) = self.chain.geometry().layer_refusing_flight(takeoff.point.x_m, landing.point.x_m) {
            return Err(Limit::Layer(layer));
        }
        let sight = self.line_of_sight(takeoff, landing).ok_or(Limit::Direction)?;
        let in_envelope = self.lofts_in_envelope(sight, from, to)?;
        let vertices = self.chain.geometry().vertices();
        let clearance = self.envelope.clearance();
        let mut lower = in_envelope.lower;
        if clearance.has_kinks() {
            lower = lower.max(kinks_loft(self.chain.geometry(), takeoff, landing, sight, clearance));
            if lower > in_envelope.upper {
                return Err(Limit::Terrain);
            }
        }
        for point in &vertices[flown_past(takeoff, landing)] {
            lower = lower.max(limits::clearing_loft(takeoff.point, landing.point, *point, clearance));
            if lower > in_envelope.upper {
                return Err(Limit::Terrain);
            }
        }
        let lofts = SlopeInterval { lower, upper: in_envelope.upper };
        match self.refused_command(sight, lofts) {
            None => Ok(lofts),
            Some(limit) => Err(limit),
        }
    }

    /// The limit on the machine's take-off speeds, if it leaves none of the lofts that all other limits allow.
    #[inline]
    pub(crate) fn refused_command(&self, sight: LineOfSight, lofts: SlopeInterval) -> Option<Limit> {
        let speeds = self.envelope.takeoff_speeds();
        if speeds.are_any() || self.envelope.commands(sight, lofts) { None } else { speeds.limit() }
    }

    /// The take-off speeds that the machine can be commanded.
    #[inline]
    pub const fn takeoff_speeds(&self) -> &TakeoffSpeeds {
        self.envelope.takeoff_speeds()
    }

    /// The windows of an interval of [`lofts`](Self::lofts) over a line of sight that the machine can be commanded, ascending.
    pub fn windows(&self, sight: LineOfSight, lofts: SlopeInterval) -> impl Iterator<Item = TakeoffWindow> + '_ {
        self.envelope.takeoff_speeds().windows(sight, lofts, self.gravity_m_s2())
    }

    /// The flight envelope of the chain's hopper under its gravity.
    #[inline]
    pub(crate) const fn envelope(&self) -> &FlightEnvelope {
        &self.envelope
    }

    /// The loft to fly of an interval of [`lofts`](Self::lofts) over a line of sight.
    #[inline]
    pub fn loft(&self, choice: TakeoffChoice, sight: LineOfSight, lofts: SlopeInterval) -> f64 {
        self.envelope.loft(choice, sight, lofts)
    }

    /// The rule of a contact, or the limit by which the ground refuses it.
    #[inline]
    pub(crate) fn allowed(&self, station: &Station, contact: Contact, direction: Direction) -> Result<&ContactRule, Limit> {
        self.chain.allowed(station, contact, direction).ok_or_else(|| match self.chain.check_contact(station, contact, direction) {
            Err(refusal) => refusal.limit(contact),
            Ok(_) => Limit::Direction,
        })
    }

    /// The lofts that all limits except the terrain allow, with at least one positive loft.
    ///
    /// # Errors
    /// The limit that leaves no arc.
    #[inline]
    pub(crate) fn lofts_in_envelope(
        &self,
        sight: LineOfSight,
        from: &ContactRule,
        to: &ContactRule,
    ) -> Result<SlopeInterval, Limit> {
        let lofts = self.envelope.lofts(sight, from.contact_limits(), to.contact_limits());
        if lofts.is_empty() || lofts.upper <= 0.0 { Err(self.refusing(sight, from, to)) } else { Ok(lofts) }
    }

    /// The lofts that the hopper's limits on the flight (greatest apex height, longest flight time) allow.
    #[inline]
    pub(crate) fn flight_limits(&self, sight: LineOfSight) -> SlopeInterval {
        self.envelope.flight_limits(sight)
    }

    /// Whether the hopper has a greatest apex height or a longest flight time.
    #[inline]
    pub(crate) const fn has_flight_limits(&self) -> bool {
        self.envelope.hopper().limits().apex_height_max_m.is_some() || self.envelope.hopper().limits().flight_time_max_s.is_some()
    }

    /// The limit that leaves no arc when the limits are applied in order.
    #[cold]
    fn refusing(&self, sight: LineOfSight, from: &ContactRule, to: &ContactRule) -> Limit {
        let takeoff = limits::takeoff_speed(sight, from.speed_max_m_s(), self.gravity_m_s2());
        if takeoff.is_empty() {
            return Limit::TakeoffSpeed;
        }
        let both = takeoff.intersect(limits::landing_speed(sight, to.speed_max_m_s(), self.gravity_m_s2()));
        if both.is_empty() {
            return Limit::LandingSpeed;
        }
        self.refusing_after_speeds(sight, both, from.slopes(), to.slopes())
    }

    /// The limit that leaves no arc of those that both speeds allow, when the limits are applied in order.
    pub(crate) fn refusing_after_speeds(
        &self,
        sight: LineOfSight,
        speeds: SlopeInterval,
        takeoff_slopes: SlopeInterval,
        landing_slopes: SlopeInterval,
    ) -> Limit {
        let in_order = [
            (Limit::TakeoffCone, limits::takeoff_cone(sight, takeoff_slopes)),
            (Limit::LandingCone, limits::landing_cone(sight, landing_slopes)),
            (Limit::MechanicalAngle, limits::takeoff_cone(sight, self.mechanism_slopes())),
            (
                Limit::ApexHeight,
                self.envelope.hopper().limits().apex_height_max_m.map_or(SlopeInterval::ALL, |h| limits::apex_height(sight, h)),
            ),
        ];
        let mut left = speeds;
        for (limit, lofts) in in_order {
            left = left.intersect(lofts);
            if left.is_empty() || left.upper <= 0.0 {
                return limit;
            }
        }
        Limit::FlightTime
    }

    /// The feasible take-off set, each limit by itself, and the limits that set its ends or that conflict.
    ///
    /// `None` if both stations have the same x.
    pub fn takeoff_set(&self, takeoff: &Station, landing: &Station) -> Option<TakeoffSet> {
        TakeoffSet::of(self, takeoff, landing)
    }

    /// The least number of hops along the ground that join two stations of one segment; `None` if they share no segment, have the
    /// same x, or no hops along the segment are allowed in this direction whose lengths add up to this distance (or the number would
    /// exceed 2^53).
    ///
    /// For pairs that no single hop joins. They can be closer than the reach, since the other limits can exclude the single hop;
    /// the CHTA paper's text covers this case, the pseudo-code of its Algorithm 2 does not.
    pub fn segment_hops(&self, takeoff: &Station, landing: &Station) -> Option<SegmentHops> {
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
        let segment = takeoff.shared_segment(landing)?;
        let run_m = (landing.point.x_m - takeoff.point.x_m).abs();
        if self.chain.geometry().layer_refusing_flight(takeoff.point.x_m, landing.point.x_m).is_some() {
            return None;
        }
        let ranges = self.segment_reaches(segment, direction);
        let found = ranges.iter().filter_map(|reach| reach.hops_over(run_m).filter(|hops| reach.flies(self, hops)));
        if !self.chain.is_uniform() {
            return found.filter_map(|hops| self.hops_that_stand(takeoff, landing, segment, hops)).min_by_key(SegmentHops::hops);
        }
        found.min_by_key(SegmentHops::hops)
    }

    /// The hops along a segment with the splits of which the layers and the footprint allow every contact; `None` if they allow none.
    fn hops_that_stand(&self, takeoff: &Station, landing: &Station, segment: SegmentId, hops: SegmentHops) -> Option<SegmentHops> {
        let geometry = self.chain.geometry();
        let refuses = |station: &Station| self.chain.refusal_at(station, segment).is_some();
        if refuses(takeoff) || refuses(landing) {
            return None;
        }
        let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
        // Along a profile the ground in the middle of a segment is plane, unless a layer of the map differs along it.
        let half_m = self.chain.footprint().map_or(0.0, |footprint| 0.5 * footprint.diameter_m);
        let ends = geometry.vertices().get(segment.index()..segment.index() + 2)?;
        let is_plain = matches!(self.chain.footing(), Footing::Profile) && geometry.layers().is_none();
        let plain = is_plain.then(|| (ends[0].x_m + half_m, ends[1].x_m - half_m));
        let refused = |x_m: f64| geometry.station(x_m).map_or(true, |station| refuses(&station));
        let stands = |each_m| contacts_stand(refused, takeoff.point.x_m, direction, each_m, hops.hops(), plain);
        hops.where_standing(stands)
    }

    /// The reach of one hop along a segment; `None` if its ground allows no hop along it.
    pub fn segment_reach(&self, segment: SegmentId, direction: Direction) -> Option<SegmentReach> {
        self.segment_reaches(segment, direction).first().copied()
    }

    /// The possible hops along a segment: ranges of their length, the longest first. There are several only for a machine that cannot
    /// be commanded every take-off speed.
    pub fn segment_reaches(&self, segment: SegmentId, direction: Direction) -> &[SegmentReach] {
        self.reaches().get(segment.index()).map_or(&[], |both| &both[direction as usize])
    }
}
