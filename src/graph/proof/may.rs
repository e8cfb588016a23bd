//! The may-hop test: whether interval arithmetic can exclude every hop from one cell to another.

use rayon::prelude::*;

use super::{
    Faults,
    arcs::{Arcs, least_speed_slopes, slower_slopes},
    cell::{Cell, shared_segment, slopes},
};
use crate::{
    ballistics::{TakeoffSpeeds, limits::ClearanceProfile},
    chain::{ConstrainedChain, ContactRule, SegmentConstraints, Site},
    hop::HopTest,
    quantity::{Interval, Rounding, SegmentId, SlopeInterval, VertexId},
    world::{ClearanceRule, Contact, Direction, HopperLimits, Limit, SPEED_TOLERANCE},
};

/// The relaxation of every limit, in addition to a speed's own tolerance: a relative 1e-9 of a clearance, a height or a time,
/// and 1e-9 rad of an angle.
///
/// It exceeds the rounding errors of the hop test (some 1e-15), of the libm tangents behind a cone's slopes (below one unit
/// in the last place, an angle of 2e-16) and of the arctangents and sums before them by a factor of a million. It also
/// exceeds the tolerances of the independent checker. The proof therefore never refuses a hop that the search accepts.
const RELAXATION: f64 = 1e-9;

/// The additional relaxation of a speed, as a fraction of its tolerance, for the rounding errors of the hop test's formulas.
const SPEED_MARGIN: f64 = 1e-3;

/// The rule of one contact, relaxed.
#[derive(Clone, Copy, Debug)]
struct Rule<R> {
    slopes: Interval<R>,
    /// The greatest speed squared, rounded up, (m/s)^2.
    speed_squared: f64,
}

/// What a segment allows take-off and landing in one direction, or the limit by which it refuses them.
type Contacts<R> = [Result<Rule<R>, Limit>; 2];

/// A chain, a hopper and a gravity as intervals, to exclude hops.
#[derive(Debug)]
pub(super) struct Prover<'a, F: Faults> {
    test: &'a HopTest,
    /// By segment and direction.
    rules: Vec<[Contacts<F::Rounding>; 2]>,
    /// By vertex: the limit by which the ground under the footprint refuses contacts that the segment before it rules, and the segment
    /// after it; empty for a hopper without footprint. Inside segments the footprint is left out, which only weakens a proof.
    footing: Vec<[Option<Limit>; 2]>,
    slopes: Vec<Interval<F::Rounding>>,
    mechanical: Interval<F::Rounding>,
    /// Relaxed; with the taper and the ramp it is below the hop test's everywhere.
    clearance: ClearanceProfile,
    apex_height_max_m: Option<f64>,
    flight_time_max_s: Option<f64>,
    /// The limit on the take-off speeds that the machine can be commanded, with the ranges of their squares, relaxed, (m/s)^2.
    commands: Option<(Limit, Vec<[f64; 2]>)>,
    /// Number of bends before each vertex.
    bends_before: Vec<usize>,
    heights_m: (f64, f64),
    /// Squares of the greatest take-off and landing speed on the chain, (m/s)^2.
    speeds_squared: [f64; 2],
}

impl<'a, F: Faults> Prover<'a, F> {
    /// From a hop test, with every limit relaxed.
    pub(super) fn new(test: &'a HopTest) -> Self {
        let chain = test.chain();
        let rules: Vec<_> = chain.segments().iter().map(|segment| Direction::BOTH.map(|d| contacts::<F>(segment, d))).collect();
        let fastest = |contact: usize| {
            let allowed = rules.iter().flatten().filter_map(|contacts: &Contacts<F::Rounding>| contacts[contact].ok());
            allowed.map(|rule| rule.speed_squared).fold(0.0, f64::max)
        };
        let vertices = chain.geometry().vertices();
        let mut bends_before = vec![0; vertices.len() + 1];
        for bend in chain.geometry().bends() {
            bends_before[bend.index() + 1] = 1;
        }
        for i in 1..bends_before.len() {
            bends_before[i] += bends_before[i - 1];
        }
        let heights = vertices.iter().map(|v| v.z_m);
        let hopper = test.hopper();
        Self {
            test,
            slopes: slopes::<F>(chain.geometry()),
            speeds_squared: [fastest(0), fastest(1)],
            rules,
            footing: footing(chain),
            mechanical: relaxed::<F>(test.mechanism_slopes()),
            clearance: relaxed_clearance::<F>(hopper.limits()),
            apex_height_max_m: hopper.limits().apex_height_max_m.map(|height_m| height_m * (1.0 + RELAXATION * F::SLACK)),
            flight_time_max_s: hopper.limits().flight_time_max_s.map(|time_s| time_s * (1.0 + RELAXATION * F::SLACK)),
            commands: commands::<F>(test.takeoff_speeds()),
            bends_before,
            heights_m: (heights.clone().fold(f64::INFINITY, f64::min), heights.fold(f64::NEG_INFINITY, f64::max)),
        }
    }

    /// The hop test.
    pub(super) const fn test(&self) -> &'a HopTest {
        self.test
    }

    /// Enclosures of the exact slopes of the segments.
    pub(super) fn slopes(&self) -> &[Interval<F::Rounding>] {
        &self.slopes
    }

    /// Whether a hop from some point of one cell to some point of another cannot be excluded.
    ///
    /// # Errors
    /// The limit that, together with those before it, leaves no arc between any two points of the cells. No hop exists in
    /// this case.
    pub(super) fn may(&self, takeoff: &Cell<F::Rounding>, landing: &Cell<F::Rounding>) -> Result<(), Limit> {
        let (direction, left, right) = if takeoff.to_m <= landing.from_m {
            (Direction::Forward, takeoff, landing)
        } else {
            (Direction::Reverse, landing, takeoff)
        };
        if F::FORGETS_REVERSE && direction == Direction::Reverse {
            return Err(Limit::Direction);
        }
        let from = self.rule(takeoff.site, Contact::Takeoff, direction)?;
        let to = self.rule(landing.site, Contact::Landing, direction)?;
        let flown_past = Site::vertices_between(left.site, right.site);
        if self.bends_before[flown_past.end] > self.bends_before[flown_past.start] {
            return Err(Limit::Bend);
        }
        let run_m = run_m(left, right);
        let mut arcs = Arcs::along(self.sight_slopes(left, right, direction));
        self.limit_speeds(&mut arcs, &from, &to, run_m)?;
        arcs.limit(|arcs| arcs.takeoff = arcs.takeoff.intersect(from.slopes), Limit::TakeoffCone)?;
        arcs.limit(|arcs| arcs.landing = arcs.landing.intersect(to.slopes), Limit::LandingCone)?;
        arcs.limit(|arcs| arcs.takeoff = arcs.takeoff.intersect(self.mechanical), Limit::MechanicalAngle)?;
        self.limit_machine(&mut arcs, run_m)?;
        self.limit_commands(&mut arcs, run_m)?;
        if flown_past.is_empty() && !self.clearance.has_kinks() {
            return Ok(());
        }
        self.limit_kinks(&mut arcs, takeoff, landing, direction, run_m.upper)?;
        self.limit_terrain(&mut arcs, takeoff, landing, flown_past)?;
        // The range of line-of-sight slopes that the other limits left restricts the speeds once more.
        self.limit_speeds(&mut arcs, &from, &to, run_m).map_err(|_| Limit::Terrain)?;
        self.limit_commands(&mut arcs, run_m)
    }

    /// The take-off speeds that the machine can be commanded. An arc has a speed from `v_1` to `v_2` only if its take-off slope is one
    /// that `v_2` allows over the shortest run and the lowest line of sight, and not one of those that are slower than `v_1` even over
    /// the longest run and the highest line of sight.
    fn limit_commands(&self, arcs: &mut Arcs<F::Rounding>, run_m: Interval<F::Rounding>) -> Result<(), Limit> {
        let Some((limit, ranges)) = &self.commands else { return Ok(()) };
        let g = Interval::<F::Rounding>::point(self.test.gravity_m_s2());
        let mut left = Interval::EMPTY;
        for [least, greatest] in ranges {
            let all = if run_m.lower > 0.0 && greatest.is_finite() {
                let ratio = Interval::point(*greatest) / (g * Interval::point(run_m.lower));
                arcs.takeoff.intersect(least_speed_slopes(ratio.upper, arcs.sight.lower))
            } else {
                arcs.takeoff
            };
            let ratio = Interval::point(*least) / (g * Interval::point(run_m.upper));
            let Some([flat, steep]) = slower_slopes::<F::Rounding>(ratio.lower, arcs.sight.upper) else {
                left = hull(left, all);
                continue;
            };
            left = hull(left, all.intersect(Interval::new(f64::NEG_INFINITY, flat)));
            left = hull(left, all.intersect(Interval::new(steep, f64::INFINITY)));
        }
        arcs.limit(|arcs| arcs.takeoff = left, *limit)
    }

    /// The rule of a contact at a site.
    fn rule(&self, site: Site, contact: Contact, direction: Direction) -> Result<Rule<F::Rounding>, Limit> {
        let segment = match site {
            Site::Inside(segment) => segment,
            Site::Vertex(vertex) => {
                let ahead = (contact == Contact::Takeoff) == (direction == Direction::Forward);
                let index = if ahead { Some(vertex.index()) } else { vertex.index().checked_sub(1) };
                SegmentId(index.ok_or(Limit::Direction)?)
            }
        };
        let both = self.rules.get(segment.index()).ok_or(Limit::Direction)?;
        let rule = both[direction as usize][contact as usize]?;
        if let Site::Vertex(vertex) = site
            && let Some(refusals) = self.footing.get(vertex.index())
            && let Some(limit) = refusals[usize::from(segment.index() == vertex.index())]
        {
            return Err(limit);
        }
        Ok(rule)
    }

    /// The slopes of all lines of sight from one cell to the other, along the direction of travel.
    ///
    /// The slope of a chord between two points on straight lines is monotone in the x of either point, so its extremes are at
    /// the corners. Across a vertex at which both cells end, the slope of a chord is a mean of the slopes of the two
    /// segments.
    fn sight_slopes(&self, left: &Cell<F::Rounding>, right: &Cell<F::Rounding>, direction: Direction) -> Interval<F::Rounding> {
        let slope_of = |site: Site| match site {
            Site::Inside(segment) => self.slopes[segment.index()],
            Site::Vertex(_) => Interval::EMPTY,
        };
        let forward = if let Some(segment) = shared_segment(left.site, right.site) {
            self.slopes[segment.index()]
        } else if left.to_m == right.from_m {
            slope_of(left.site).hull(slope_of(right.site))
        } else {
            let chord = |(a_m, a_height): (f64, Interval<F::Rounding>), (b_m, b_height): (f64, Interval<F::Rounding>)| {
                (b_height - a_height) / (Interval::point(b_m) - Interval::point(a_m))
            };
            let corners = left.ends().flat_map(|a| right.ends().map(move |b| chord(a, b)));
            corners.fold(Interval::EMPTY, Interval::hull)
        };
        if direction == Direction::Forward { forward } else { -forward }
    }

    /// Both speed limits: the least run allows the most arcs, together with the lowest line of sight for the take-off and the
    /// highest for the landing.
    fn limit_speeds(
        &self,
        arcs: &mut Arcs<F::Rounding>,
        from: &Rule<F::Rounding>,
        to: &Rule<F::Rounding>,
        run_m: Interval<F::Rounding>,
    ) -> Result<(), Limit> {
        if run_m.lower <= 0.0 {
            return Ok(());
        }
        let weight = Interval::<F::Rounding>::point(self.test.gravity_m_s2()) * Interval::point(run_m.lower);
        let (takeoff_ratio, landing_ratio) =
            (Interval::point(from.speed_squared) / weight, Interval::point(to.speed_squared) / weight);
        let slopes = least_speed_slopes(takeoff_ratio.upper, arcs.sight.lower);
        arcs.limit(|arcs| arcs.takeoff = arcs.takeoff.intersect(slopes), Limit::TakeoffSpeed)?;
        let slopes = -least_speed_slopes(landing_ratio.upper, -arcs.sight.upper);
        arcs.limit(|arcs| arcs.landing = arcs.landing.intersect(slopes), Limit::LandingSpeed)
    }

    /// Apex height and flight time limits: both quantities increase with the run, the slope of the line of sight and the
    /// loft, so the least run and the lowest line of sight allow the greatest loft.
    fn limit_machine(&self, arcs: &mut Arcs<F::Rounding>, run_m: Interval<F::Rounding>) -> Result<(), Limit> {
        if run_m.lower <= 0.0 {
            return Ok(());
        }
        let run = Interval::<F::Rounding>::point(run_m.lower);
        if let Some(height_m) = self.apex_height_max_m {
            let half_sum_excess = Interval::point(height_m) / run - Interval::point(arcs.sight.lower.max(0.0));
            let twice = half_sum_excess + half_sum_excess;
            if twice.upper < 0.0 {
                return Err(Limit::ApexHeight);
            }
            let excess = Interval::<F::Rounding>::new(twice.lower.max(0.0), twice.upper);
            let mean = Interval::<F::Rounding>::point(arcs.sight.lower.abs());
            let loft = mean + excess + (excess * (mean + mean + excess)).sqrt();
            arcs.limit(|arcs| arcs.loft.upper = arcs.loft.upper.min(loft.upper), Limit::ApexHeight)?;
        }
        if let Some(time_s) = self.flight_time_max_s {
            let time = Interval::point(time_s);
            let loft = Interval::point(self.test.gravity_m_s2()) * time * time / (run + run);
            arcs.limit(|arcs| arcs.loft.upper = arcs.loft.upper.min(loft.upper), Limit::FlightTime)?;
        }
        Ok(())
    }

    /// The two kinks of a tapered clearance, where the segment under the contact reaches beyond them for the whole cell, or to the
    /// landing: there the ground between contact and kink has the slope of that segment.
    ///
    /// ```text
    ///     n >= (s - b + k) X / (X - w),     n >= (b - t + k) X / (X - w),      X / (X - w) least for the longest hop
    /// ```
    ///
    /// Other kinks are left out, which only weakens a proof.
    fn limit_kinks(
        &self,
        arcs: &mut Arcs<F::Rounding>,
        takeoff: &Cell<F::Rounding>,
        landing: &Cell<F::Rounding>,
        direction: Direction,
        run_max_m: f64,
    ) -> Result<(), Limit> {
        if !self.clearance.has_kinks() {
            return Ok(());
        }
        let down = F::Rounding::down;
        let kink_m = self.clearance.kink_m(run_max_m);
        // X / (X - w) = 1 / (1 - w / X), rounded down.
        let share = down(down(self.clearance.ramp_m()) / run_max_m).clamp(0.0, 0.5);
        let factor = down(1.0 / F::Rounding::up(1.0 - share));
        let (left, right) = if direction == Direction::Forward { (takeoff, landing) } else { (landing, takeoff) };
        let shared = shared_segment(left.site, right.site).map(|segment| self.slopes[segment.index()]);
        let ahead = shared.or_else(|| self.slope_beside(takeoff, direction == Direction::Forward, kink_m));
        let back = shared.or_else(|| self.slope_beside(landing, direction == Direction::Reverse, kink_m));
        let sight = arcs.sight;
        let over = |slope: Option<Interval<F::Rounding>>, taking_off: bool| {
            let slope = if direction == Direction::Forward { slope? } else { -slope? };
            let over = if taking_off { slope - sight } else { sight - slope };
            Some(down(over.lower + self.clearance.taper()))
        };
        let overs = [over(ahead, true), over(back, false)].into_iter().flatten().filter(|over| *over > 0.0);
        let loft = overs.map(|over| down(over * factor)).fold(arcs.loft.lower, f64::max);
        arcs.limit(|arcs| arcs.loft.lower = loft, Limit::Terrain)
    }

    /// The slope dz/dx of the segment on one side of a cell, if it reaches a distance beyond every point of the cell.
    fn slope_beside(&self, cell: &Cell<F::Rounding>, right: bool, distance_m: f64) -> Option<Interval<F::Rounding>> {
        let segment = match cell.site {
            Site::Inside(segment) => segment.index(),
            Site::Vertex(vertex) => if right { Some(vertex.index()) } else { vertex.index().checked_sub(1) }?,
        };
        let vertices = self.test.chain().geometry().vertices();
        let (left, end) = (vertices[segment], vertices.get(segment + 1)?);
        let room_m = if right { end.x_m - cell.to_m } else { cell.from_m - left.x_m };
        (F::Rounding::down(room_m) >= distance_m).then(|| self.slopes[segment])
    }

    /// The terrain: `n >= s_p - t_p` for every vertex between the cells.
    ///
    /// The slope `s_p` from the take-off to a vertex depends only on the take-off, the slope `t_p` from the vertex to the
    /// landing only on the landing, and both are monotone in x: their extremes are at the ends of the cells. If the cell ends
    /// at the vertex itself, `s = slope + eps/d` decreases with the distance, so the far end has the least value.
    ///
    /// A tapered clearance `min(eps, k d, k e)` is at least that of the nearest pair of points. If that is less than `eps`, its own
    /// part of the loft is bounded too, apart from the ground's:
    ///
    /// ```text
    ///     eps_p X / (d e) = min(eps (1/d + 1/e), k (1 + d/e), k (1 + e/d))
    ///                    >= min(eps (1/d_max + 1/e_max), k (1 + d_min/e_max), k (1 + e_min/d_max))
    /// ```
    ///
    /// so that for cells that share the vertex `n >= slope_i - slope_j + min(k, eps (1/d_max + 1/e_max))`.
    fn limit_terrain(
        &self,
        arcs: &mut Arcs<F::Rounding>,
        takeoff: &Cell<F::Rounding>,
        landing: &Cell<F::Rounding>,
        flown_past: std::ops::Range<usize>,
    ) -> Result<(), Limit> {
        let mut loft = arcs.loft.lower;
        for vertex in &self.test.chain().geometry().vertices()[flown_past] {
            // The height of the vertex with its clearance above a position, divided by the distance: from the take-off and
            // from the landing.
            let least_seen = |cell: &Cell<F::Rounding>, clearance_m: f64| {
                let seen = cell.ends().filter(|(x_m, _)| *x_m != vertex.x_m).map(|(x_m, height_m)| {
                    let above = F::Rounding::down(F::Rounding::down(vertex.z_m - height_m.upper) + clearance_m);
                    quotient_down::<F::Rounding>(above, (vertex.x_m - x_m).abs())
                });
                seen.fold(f64::INFINITY, f64::min)
            };
            let tapered = self.clearance.has_kinks();
            let ([d_min, d_max], [e_min, e_max]) = (distances_m(takeoff, vertex.x_m), distances_m(landing, vertex.x_m));
            let clearance_m = if tapered { self.clearance.at_m(d_min, e_min) } else { self.clearance.height_m() };
            // t is the negative of this value at the landing, so s - t is the sum of both.
            loft = loft.max(F::Rounding::down(least_seen(takeoff, clearance_m) + least_seen(landing, clearance_m)));
            if tapered && clearance_m < self.clearance.height_m() {
                // Divided once more by 1 + 1e-12, which is far above the rounding of these few operations.
                let (eps, k) = (self.clearance.height_m(), self.clearance.taper());
                let own =
                    (eps * (1.0 / d_max + 1.0 / e_max)).min(k * (1.0 + d_min / e_max)).min(k * (1.0 + e_min / d_max)) / ROUNDED;
                let ground = F::Rounding::down(least_seen(takeoff, 0.0) + least_seen(landing, 0.0));
                loft = loft.max(F::Rounding::down(ground + own));
            }
            if loft > arcs.loft.upper {
                return Err(Limit::Terrain);
            }
        }
        arcs.limit(|arcs| arcs.loft.lower = loft, Limit::Terrain)
    }

    /// The horizontal distance from a cell beyond which no hop from it lands, m, rounded up.
    pub(super) fn reach_from_m(&self, cell: &Cell<F::Rounding>) -> f64 {
        let (low_m, high_m) = cell.height_range_m();
        self.farthest_m(high_m - self.heights_m.0, self.heights_m.1 - low_m)
    }

    /// The horizontal distance from a cell beyond which no hop to it takes off, m, rounded up.
    pub(super) fn reach_to_m(&self, cell: &Cell<F::Rounding>) -> f64 {
        let (low_m, high_m) = cell.height_range_m();
        self.farthest_m(self.heights_m.1 - low_m, high_m - self.heights_m.0)
    }

    /// The horizontal distance that no hop of this chain exceeds, m, rounded up.
    pub(super) fn greatest_reach_m(&self) -> f64 {
        let range_m = self.heights_m.1 - self.heights_m.0;
        self.farthest_m(range_m, range_m)
    }

    /// `X <= (v / g) sqrt(v^2 + 2 g h)`, the parabola of safety, for the greatest drop at take-off and climb at landing.
    fn farthest_m(&self, drop_m: f64, climb_m: f64) -> f64 {
        let g = Interval::<F::Rounding>::point(self.test.gravity_m_s2());
        let safe = |speed_squared: f64, height_m: f64| {
            let squared = Interval::point(speed_squared);
            let fall = Interval::new(0.0, height_m.max(0.0).next_up()) * (g + g);
            ((squared * (squared + fall)).sqrt() / g).upper
        };
        safe(self.speeds_squared[0], drop_m).min(safe(self.speeds_squared[1], climb_m))
    }
}

/// The horizontal distances between two cells, the left one first, m.
fn run_m<R: Rounding>(left: &Cell<R>, right: &Cell<R>) -> Interval<R> {
    let nearest = Interval::<R>::point(right.from_m) - Interval::point(left.to_m);
    let farthest = Interval::<R>::point(right.to_m) - Interval::point(left.from_m);
    Interval::new(if right.from_m == left.to_m { 0.0 } else { nearest.lower.max(0.0) }, farthest.upper)
}

/// Far more than the rounding of a few operations without cancellation.
const ROUNDED: f64 = 1.0 + 1e-12;

/// The least and the greatest distance of a cell's points from an x, m.
fn distances_m<R: Rounding>(cell: &Cell<R>, x_m: f64) -> [f64; 2] {
    let (a, b) = ((cell.from_m - x_m).abs(), (cell.to_m - x_m).abs());
    [a.min(b), a.max(b)]
}

/// The clearance with its height and its taper relaxed alike, so that its kinks stay where they are.
fn relaxed_clearance<F: Faults>(limits: &HopperLimits) -> ClearanceProfile {
    let less = 1.0 - RELAXATION * F::SLACK;
    let rule = match limits.clearance_rule {
        ClearanceRule::Tapered(taper) => ClearanceRule::Tapered(taper * less),
        ClearanceRule::Vertex => ClearanceRule::Vertex,
    };
    ClearanceProfile::new(limits.clearance_m * less, rule)
}

/// A quotient by a rounded distance, not above the true one.
fn quotient_down<R: Rounding>(dividend: f64, distance: f64) -> f64 {
    let divisor = if dividend >= 0.0 { R::up(distance) } else { R::down(distance) };
    if divisor > 0.0 { R::down(dividend / divisor) } else { f64::NEG_INFINITY }
}

/// The limits by which the ground under the footprint refuses contacts at every vertex, by the segment that rules them.
fn footing(chain: &ConstrainedChain) -> Vec<[Option<Limit>; 2]> {
    if chain.footprint().is_none() {
        return Vec::new();
    }
    let of_vertex = |index: usize| {
        let station = chain.geometry().vertex_station(VertexId(index));
        let refusal = |segment: usize| chain.footprint_refusal(&station, SegmentId(segment)).map(|refusal| refusal.limit());
        [index.checked_sub(1).and_then(refusal), refusal(index)]
    };
    (0..=chain.geometry().segment_count()).into_par_iter().map(of_vertex).collect()
}

/// The hull of two intervals, either of which may be empty.
fn hull<R: Rounding>(a: Interval<R>, b: Interval<R>) -> Interval<R> {
    if b.is_empty() { a } else { a.hull(b) }
}

/// The limit on the take-off speeds that a machine can be commanded, with the ranges of their squares, relaxed.
fn commands<F: Faults>(speeds: &TakeoffSpeeds) -> Option<(Limit, Vec<[f64; 2]>)> {
    let tolerance = SPEED_TOLERANCE * (1.0 + SPEED_MARGIN) * F::SLACK;
    let about = |speed_m_s: f64| {
        let speed = Interval::<F::Rounding>::point(speed_m_s);
        let by = speed * Interval::point(tolerance);
        let [least, greatest] = if tolerance > 0.0 { [speed - by, speed + by] } else { [speed; 2] };
        [least.squared().lower, greatest.squared().upper]
    };
    let ranges = match speeds {
        TakeoffSpeeds::Any => return None,
        TakeoffSpeeds::AtLeast(least_m_s) => vec![[about(*least_m_s)[0], f64::INFINITY]],
        TakeoffSpeeds::Levels(levels) => levels.as_slice().iter().map(|level| about(*level)).collect(),
    };
    Some((speeds.limit()?, ranges))
}

/// The relaxed rules of a segment for one direction.
fn contacts<F: Faults>(segment: &SegmentConstraints, direction: Direction) -> Contacts<F::Rounding> {
    [Contact::Takeoff, Contact::Landing].map(|contact| {
        segment.check_contact(contact, direction).map(|rule| relaxed_rule::<F>(&rule)).map_err(|refusal| refusal.limit(contact))
    })
}

/// A rule with its slopes and its speed relaxed.
fn relaxed_rule<F: Faults>(rule: &ContactRule) -> Rule<F::Rounding> {
    let tolerance = SPEED_TOLERANCE * (1.0 + SPEED_MARGIN) * F::SLACK;
    let speed = Interval::<F::Rounding>::point(rule.speed_max_m_s());
    // Added up, not multiplied by one and a bit, so that no tolerance at all is the limit itself.
    let speed = if tolerance > 0.0 { speed + speed * Interval::point(tolerance) } else { speed };
    Rule { slopes: relaxed::<F>(rule.slopes()), speed_squared: speed.squared().upper }
}

/// Slopes widened by a nanoradian at either end: `tan(theta + d) = (m + tan d) / (1 - m tan d)`.
fn relaxed<F: Faults>(slopes: SlopeInterval) -> Interval<F::Rounding> {
    let raised = |slope: f64| {
        let (m, t) = (Interval::<F::Rounding>::point(slope), Interval::point(RELAXATION * F::SLACK));
        let divisor = Interval::point(1.0) - m * t;
        if slope.is_infinite() || divisor.lower <= 0.0 { f64::INFINITY } else { ((m + t) / divisor).upper }
    };
    let lower = if slopes.lower.is_infinite() { slopes.lower } else { -raised(-slopes.lower) };
    let upper = if slopes.upper.is_infinite() { slopes.upper } else { raised(slopes.upper) };
    Interval::new(lower, upper)
}

#[cfg(test)]
mod tests;
