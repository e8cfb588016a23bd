//! Hops between a new contact and those of a roadmap: by angles that are sampled, or by exact windows.

use crate::{
    ballistics::{Arc, limits::apex_height, loft_at_share},
    ground::{MeshBuffers, MeshContact, MeshCourse, MeshGround},
    quantity::{Angle, SlopeInterval},
};

/// How a hop between two contacts is tested in a roadmap that grows contact by contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JoinTest {
    /// Campana and Laumond's: seven arcs at shares of the beam of take-off angles, each checked by a [ball](PROBE_RADIUS_M) along it, until
    /// one is free. An arc that rises over the bounds counts as one that meets the mesh.
    SampledAngles,
    /// All windows, in closed form; the greatest height is one of their limits.
    ExactWindows,
}

/// The radius of the ball that checks a sampled arc, m.
pub const PROBE_RADIUS_M: f64 = 0.02;

/// The length of arc to one place of that ball, m, on average: places are even in horizontal distance.
pub const PROBE_STEP_M: f64 = 0.02;

/// How far contacts stand off the surface where arcs are sampled, m: a first millimetre, and steps of five until the ball is free.
pub const PROBE_STAND_OFF_M: f64 = 0.021;

/// The shares of the beam of take-off angles at which arcs are sampled, in their order.
///
/// The paper states six; its program tries the middle and then six more.
pub const SAMPLED_SHARES: [f64; 7] = [0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875];

/// How far over the line of sight the beam of sampled angles begins, rad.
const OVER_SIGHT: f64 = 0.001;

/// A cone whose cut by the plane of the hop has `tan^2 delta / cos^2 theta` below this is refused: half the angle of the cut is `delta`, and
/// the heading is `theta` from the x axis, so that the rule depends on the axes of the mesh. It is that of the program, which divides the
/// equations of the cone by `cos theta`; the paper refuses a cut that is one ray.
const NARROW_CUT: f64 = 0.05;

/// Beams both ways of a hop that differ by no more than this share are one beam: its arcs are flown either way.
const ONE_BEAM: f64 = 1.0e-9;

/// Hops that were tested, and what refused them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JoinCounts {
    /// Hops with a beam, so that the mesh was asked; one where both ways have the same beam.
    pub tried: u64,
    /// Hops with a beam that sampling does not try, since it refuses narrow cuts of a friction cone.
    pub narrow: u64,
    /// Of those tried, those whose first arc met the mesh or rose over the bounds: what the paper counts as collisions. By exact windows none.
    pub first_arcs_refused: u64,
    /// Of those tried, those with no arc left.
    pub refused: u64,
    /// Hops of which even the flattest arc rises over the bounds: by sampling they are among the refused, by exact windows not among the tried.
    pub too_high: u64,
    /// Hops that sampling let pass and the exact windows of their contacts do not have, taken out of the roadmap: the ball passed by an edge.
    pub grazes: u64,
}

/// A window of a hop, with the numbers of its take-off and landing.
pub(super) type Joined = (usize, usize, SlopeInterval);

/// Tests hops one after another.
pub(super) struct Joiner<'g> {
    pub(super) ground: &'g MeshGround,
    pub(super) test: JoinTest,
    /// The greatest height of a flight, m.
    pub(super) height_max_m: Option<f64>,
    pub(super) counts: JoinCounts,
    pub(super) buffers: MeshBuffers,
}

impl Joiner<'_> {
    /// Adds the windows of the hops between two contacts, both ways: those of one way together.
    ///
    /// Where both ways have the same beam, as with one greatest speed for take-off and landing, the arcs of one are those of the other.
    /// Elsewhere each way is tested by itself.
    pub(super) fn join(&mut self, old: (usize, &MeshContact), new: (usize, &MeshContact), found: &mut Vec<Joined>) {
        let (Some(forth), Some(back)) = (self.ground.beam(old.1, new.1), self.ground.beam(new.1, old.1)) else { return };
        if forth.1.is_empty() && back.1.is_empty() {
            return;
        }
        if self.test == JoinTest::SampledAngles {
            let heading = forth.0.plane.heading;
            let cut = |contact| self.ground.cone_cut(contact, heading);
            if cut(old.1).min(cut(new.1)) < NARROW_CUT * heading.x * heading.x {
                self.counts.narrow += 1;
                return;
            }
        }
        let first = found.len();
        self.one_way(&forth, [old, new], found);
        if are_one(forth.1, back.1) {
            for at in first..found.len() {
                let lofts = found[at].2.intersect(back.1);
                if !lofts.is_empty() {
                    found.push((new.0, old.0, lofts));
                }
            }
        } else {
            self.one_way(&back, [new, old], found);
        }
    }

    fn one_way(
        &mut self,
        (course, beam): &(MeshCourse, SlopeInterval),
        [from, to]: [(usize, &MeshContact); 2],
        found: &mut Vec<Joined>,
    ) {
        if beam.is_empty() {
            return;
        }
        let rise_max_m = self.height_max_m.map_or(f64::INFINITY, |most_m| most_m - from.1.point_m().z);
        match self.test {
            JoinTest::SampledAngles => {
                let loft = self.sampled(course, *beam, rise_max_m);
                found.extend(loft.map(|loft| (from.0, to.0, SlopeInterval { lower: loft, upper: loft })));
            }
            JoinTest::ExactWindows => {
                let under = if rise_max_m < f64::INFINITY { apex_height(course.sight, rise_max_m) } else { SlopeInterval::ALL };
                if beam.intersect(under).is_empty() {
                    self.counts.too_high += 1;
                    return;
                }
                self.counts.tried += 1;
                let first = found.len();
                let windows = self.ground.windows(from.1, to.1, &mut self.buffers).map_or(&[][..], |(_, windows)| windows);
                let kept = windows.iter().map(|lofts| lofts.intersect(under)).filter(|lofts| !lofts.is_empty());
                found.extend(kept.map(|lofts| (from.0, to.0, lofts)));
                self.counts.refused += u64::from(found.len() == first);
            }
        }
    }

    /// The first of the sampled arcs that is free.
    fn sampled(&mut self, course: &MeshCourse, beam: SlopeInterval, rise_max_m: f64) -> Option<f64> {
        let (sight, gravity_m_s2) = (course.sight, self.ground.envelope().gravity_m_s2());
        let lowest = Angle::from_radians(sight.angle().radians() + OVER_SIGHT).slope() - sight.slope();
        let beam = SlopeInterval { lower: beam.lower.max(lowest), upper: beam.upper };
        if beam.is_empty() {
            return None;
        }
        self.counts.tried += 1;
        let arc = |loft: f64| Arc::new(sight, loft, gravity_m_s2);
        let is_low = |arc: &Arc| arc.apex_height_m() <= rise_max_m;
        // Arcs are nested: where the flattest rises too high, all do.
        let is_hopeless = !is_low(&arc(beam.lower));
        let shares = if is_hopeless { &[][..] } else { &SAMPLED_SHARES[..] };
        for (number, share) in shares.iter().enumerate() {
            let sampled = arc(loft_at_share(sight, beam, *share));
            if is_low(&sampled) && !self.ground.ball_meets(course, &sampled, PROBE_RADIUS_M, PROBE_STEP_M) {
                return Some(sampled.loft());
            }
            self.counts.first_arcs_refused += u64::from(number == 0);
        }
        self.counts.first_arcs_refused += u64::from(is_hopeless);
        self.counts.too_high += u64::from(is_hopeless);
        self.counts.refused += 1;
        None
    }

    /// Whether the exact windows of a hop have a loft.
    pub(super) fn is_in_a_window(&mut self, [from, to]: [&MeshContact; 2], loft: f64) -> bool {
        let found = self.ground.windows(from, to, &mut self.buffers);
        found.is_some_and(|(_, windows)| windows.iter().any(|lofts| lofts.contains(loft)))
    }
}

/// Whether two beams are one, but for rounding.
fn are_one(a: SlopeInterval, b: SlopeInterval) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= ONE_BEAM * (1.0 + b.abs());
    (a.is_empty() && b.is_empty()) || (near(a.lower, b.lower) && near(a.upper, b.upper))
}
