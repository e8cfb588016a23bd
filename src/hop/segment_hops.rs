//! Several hops along one segment.

mod commanded;

use super::HopTest;
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice, limits},
    chain::ContactRule,
    quantity::{SegmentId, SlopeInterval},
    world::{Contact, Direction, Limit, SPEED_TOLERANCE},
};

/// How to divide a stretch of one segment into hops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Split {
    /// Hops of full reach, the last one covers the rest (P Algorithm 4): least sum of speeds, least time.
    #[default]
    FullReach,
    /// Hops of equal length: the same energy, lower peak speed.
    Equal,
}

impl Split {
    /// Both splits.
    pub const ALL: [Self; 2] = [Self::FullReach, Self::Equal];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FullReach => "full-reach",
            Self::Equal => "equal",
        }
    }
}

crate::quantity::by_name!(Split, Split::ALL);

/// The reach of one hop along a segment in one direction, and the arc that attains it.
///
/// On one segment the slope `b` is the same for every hop, so the cones allow each of them the same lofts (P eq. 23-25), and
/// a hop of loft `n` covers at most
///
/// ```text
///     X_t = 2 v_t^2 n / (g (1 + (b + n)^2)),   X_l = 2 v_l^2 n / (g (1 + (b - n)^2))            (P eq. 29, 30, as run)
/// ```
///
/// both largest at `n = sqrt(1 + b^2)` and decreasing on either side (P Remark 2). A greatest flight time or apex height adds
/// bounds that decrease with the loft.
///
/// A tapered clearance asks for a loft `L(X)`: `2 k` up to a length of `2 eps / k`, and `k / (1 - eps / (k X))` for longer hops
/// ([`kink_loft`](limits::ClearanceProfile::kink_loft)). Short hops need the highest lofts, so that the lengths need not begin at 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentReach {
    sight_slope: f64,
    from: ContactRule,
    to: ContactRule,
    loft: f64,
    reach_m: f64,
    tolerant_reach_m: f64,
    /// The length of a hop of full reach: the reach, reduced by a relative 1e-9 if limits of the machine end it. These have
    /// no tolerance, so rounding could refuse the only arc of a hop exactly on the limit.
    stride_m: f64,
    limit: Limit,
    /// The length of the shortest hop, m; 0 if hops may be as short as one likes.
    shortest_m: f64,
    /// Hops up to this length are also possible where the shortest is longer, m; 0 if none shorter than it is possible.
    near_m: f64,
}

/// A number of hops along one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentHops {
    reach: SegmentReach,
    run_m: f64,
    hops: u64,
    /// The only split whose contacts the hopper's footprint allows, if it does not allow both.
    only: Option<Split>,
}

impl SegmentReach {
    /// The ranges of length of hops along a segment, the longest first; none if its ground or its cones allow no arc along it. There
    /// is one unless the machine cannot be commanded every take-off speed.
    pub(super) fn all_on(test: &HopTest, segment: SegmentId, direction: Direction) -> Vec<Self> {
        match Self::on(test, segment, direction) {
            Some(reach) if test.takeoff_speeds().are_any() => vec![reach],
            Some(reach) => commanded::ranges(reach, test),
            None => Vec::new(),
        }
    }

    /// The reach along a segment for a machine of any take-off speed; `None` if its ground or its cones allow no arc along it.
    fn on(test: &HopTest, segment: SegmentId, direction: Direction) -> Option<Self> {
        let constraints = test.chain().segments().get(segment.index())?;
        let from = constraints.allowed(Contact::Takeoff, direction)?;
        let to = constraints.allowed(Contact::Landing, direction)?;
        let sight_slope = direction.sign() * test.chain().geometry().slopes()[segment.index()];
        let sight = LineOfSight::along(1.0, sight_slope);
        let lofts = limits::takeoff_cone(sight, from.slopes().intersect(test.mechanism_slopes()))
            .intersect(limits::landing_cone(sight, to.slopes()));
        if lofts.is_empty() || lofts.upper <= 0.0 {
            return None;
        }
        let ends = Ends { b: sight_slope, takeoff_m_s: from.speed_max_m_s(), landing_m_s: to.speed_max_m_s(), test };
        let flattest = lofts.lower.max(f64::MIN_POSITIVE);
        // Not `clamp`, which panics if the set ends below the least positive number.
        let fastest = sight.secant().min(lofts.upper).max(flattest);
        let loft = ends.best_loft(flattest, fastest);
        let (by_speed, limit) = ends.by_speed_m(loft);
        let (by_machine, machine_limit) = ends.by_machine_m(loft);
        let (reach_m, limit) = if by_machine < by_speed { (by_machine, machine_limit) } else { (by_speed, limit) };
        let tolerance = (1.0 + SPEED_TOLERANCE) * (1.0 + SPEED_TOLERANCE);
        let tolerant_reach_m = by_machine.min(by_speed * tolerance);
        let stride_m = reach_m.min(by_machine * (1.0 - SPEED_TOLERANCE));
        let (shortest_m, near_m) = (0.0, 0.0);
        let by_others =
            Self { sight_slope, from: *from, to: *to, loft, reach_m, tolerant_reach_m, stride_m, limit, shortest_m, near_m };
        if reach_m.is_nan() || reach_m <= 0.0 {
            return None;
        }
        if test.clearance().has_kinks() { by_others.with_clearance(test, &ends) } else { Some(by_others) }
    }

    /// Whether the machine has the arcs of every split of these hops.
    pub(super) fn flies(&self, test: &HopTest, hops: &SegmentHops) -> bool {
        let lengths_m = Split::ALL.into_iter().flat_map(|split| <[f64; 2]>::from(hops.lengths_m(split)));
        test.takeoff_speeds().are_any() || lengths_m.into_iter().all(|length_m| self.has_commanded_arc(test, length_m))
    }

    /// The lengths that a tapered clearance leaves of those from 0 to the reach.
    ///
    /// The greatest loft `U` that the other limits allow a hop of length `X` is concave in `1 / X` and increases with it; their
    /// least loft decreases with `1 / X` and is convex. So is `L` from `1 / X = 0` to `1 / (2 w)`, from where it is constant. The
    /// excess of `U` over both is therefore concave below `1 / (2 w)`, which gives one interval of lengths above `2 w`, and
    /// increasing beyond, which gives one interval of lengths from 0.
    fn with_clearance(self, test: &HopTest, ends: &Ends<'_>) -> Option<Self> {
        let excess = |length_m: f64| {
            let lofts = test.lofts_in_envelope(LineOfSight::along(length_m, self.sight_slope), &self.from, &self.to);
            let clearing = test.clearance().kink_loft(0.0, length_m);
            lofts.map_or(f64::NEG_INFINITY, |lofts| lofts.upper - lofts.lower.max(clearing))
        };
        let allows = |length_m: f64| excess(length_m) >= 0.0;
        let (longest_m, two_ramps_m) = (self.stride_m, 2.0 * test.clearance().ramp_m());
        let near = |below_m: f64| {
            let least_m = below_m * SPEED_TOLERANCE;
            if allows(least_m) { last_allowed(least_m, below_m, allows) * (1.0 - SPEED_TOLERANCE) } else { 0.0 }
        };
        if longest_m <= two_ramps_m {
            return if allows(longest_m) { Some(self.steepened(test, ends)) } else { self.ended_at(near(longest_m), test, ends) };
        }
        let inside_m =
            if allows(longest_m) { Some(longest_m) } else { greatest(two_ramps_m, longest_m, excess).filter(|x| allows(*x)) };
        let Some(inside_m) = inside_m else { return self.ended_at(near(two_ramps_m), test, ends) };
        let mut found = self.steepened(test, ends);
        if inside_m < longest_m {
            found = self.ended_at(last_allowed(inside_m, longest_m, allows) * (1.0 - SPEED_TOLERANCE), test, ends)?;
        }
        if !allows(two_ramps_m) {
            found.shortest_m = last_allowed(inside_m, two_ramps_m, allows) * (1.0 + SPEED_TOLERANCE);
            found.near_m = near(two_ramps_m);
        }
        // A single length that rounding loses.
        if found.shortest_m > found.stride_m { self.ended_at(found.near_m, test, ends) } else { Some(found) }
    }

    /// The same reach with a loft that keeps the clearance: where the other limits leave several.
    fn steepened(self, test: &HopTest, ends: &Ends<'_>) -> Self {
        let loft = test.clearance().kink_loft(0.0, self.stride_m);
        if loft > self.loft { Self { loft, limit: ends.limit_at(loft), ..self } } else { self }
    }

    /// The same with a reach that the clearance ends, together with the limit of the others that such a steep hop meets first;
    /// `None` if that is 0.
    fn ended_at(self, reach_m: f64, test: &HopTest, ends: &Ends<'_>) -> Option<Self> {
        let loft = test.clearance().kink_loft(0.0, reach_m);
        let limit = ends.limit_at(loft);
        let ended = Self { loft, reach_m, tolerant_reach_m: reach_m, stride_m: reach_m, limit, ..self };
        (reach_m > 0.0).then_some(Self { shortest_m: 0.0, near_m: 0.0, ..ended })
    }

    /// The greatest horizontal distance of one hop, m.
    pub const fn reach_m(&self) -> f64 {
        self.reach_m
    }

    /// The horizontal distance of the shortest hop, m: 0 unless a tapered clearance or the machine's take-off speeds refuse short hops.
    pub const fn shortest_m(&self) -> f64 {
        self.shortest_m
    }

    /// The greatest distance of one hop along the slope, m.
    pub fn reach_line_of_sight_m(&self) -> f64 {
        LineOfSight::along(self.reach_m, self.sight_slope).length_m()
    }

    /// The loft of the farthest hop.
    pub const fn loft(&self) -> f64 {
        self.loft
    }

    /// The take-off slope of the farthest hop.
    pub fn takeoff_slope(&self) -> f64 {
        self.sight_slope + self.loft
    }

    /// The slope of the ground along the direction of travel.
    pub const fn sight_slope(&self) -> f64 {
        self.sight_slope
    }

    /// The limit that ends the reach.
    pub const fn limit(&self) -> Limit {
        self.limit
    }

    /// The least number of hops over a horizontal distance, `N = ceil(X / reach)` (P eq. 26).
    ///
    /// No combination of angles or lengths along the segment needs fewer hops, since none goes farther than the reach. `None`
    /// if the number exceeds 2^53, or if so many hops of the shortest length go too far and shorter ones are not possible. (Where
    /// hops are possible up to some length and again from a longer one, which takes a taper of over twice the slope of the ground,
    /// the two kinds are not mixed.)
    pub fn hops_over(&self, run_m: f64) -> Option<SegmentHops> {
        let hops = (run_m / self.tolerant_reach_m).ceil().max(1.0);
        if hops * self.shortest_m > run_m {
            let near = Self {
                reach_m: self.near_m,
                tolerant_reach_m: self.near_m,
                stride_m: self.near_m,
                shortest_m: 0.0,
                near_m: 0.0,
                ..*self
            };
            return if self.near_m > 0.0 { near.hops_over(run_m) } else { None };
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 1 and at most 2^53")]
        (hops <= 9_007_199_254_740_992.0).then_some(SegmentHops { reach: *self, run_m, hops: hops as u64, only: None })
    }
}

impl SegmentHops {
    /// The number of hops.
    pub const fn hops(&self) -> u64 {
        self.hops
    }

    /// The reach that the hops use.
    pub const fn reach(&self) -> SegmentReach {
        self.reach
    }

    /// The horizontal lengths of the hops, m: of each but the last, and of the last.
    ///
    /// If the hopper's footprint allows the contacts of one split alone, that one is taken. With full reach the last hop covers the
    /// rest. If rounding leaves a rest slightly over the reach (a stretch of exactly
    /// a multiple of the reach), or under the shortest hop, the hops are equal.
    #[expect(clippy::cast_precision_loss, reason = "at most 2^53 hops")]
    pub fn lengths_m(&self, split: Split) -> (f64, f64) {
        let (equal, split) = (self.equal_m(), self.only.unwrap_or(split));
        let stride_m = self.reach.stride_m;
        let rest = self.run_m - (self.hops - 1) as f64 * stride_m;
        match split {
            Split::FullReach if self.hops > 1 && rest > 0.0 && rest <= stride_m && rest >= self.reach.shortest_m => {
                (stride_m, rest)
            }
            _ => (equal, equal),
        }
    }

    /// The length of each of as many hops of equal length, m.
    #[expect(clippy::cast_precision_loss, reason = "at most 2^53 hops")]
    pub(crate) fn equal_m(&self) -> f64 {
        self.run_m / self.hops as f64
    }

    /// The same hops in the splits whose contacts stand: those at multiples of the length given from the take-off. `None` if neither
    /// does.
    pub(super) fn where_standing(self, stands: impl Fn(f64) -> bool) -> Option<Self> {
        let [full, equal] = Split::ALL.map(|split| stands(Self { only: None, ..self }.lengths_m(split).0));
        match (full, equal) {
            (true, true) => Some(self),
            (true, false) => Some(Self { only: Some(Split::FullReach), ..self }),
            (false, true) => Some(Self { only: Some(Split::Equal), ..self }),
            (false, false) => None,
        }
    }

    /// The arc of a hop of this length along the segment, selected by `choice`.
    ///
    /// With the mid-range choice each hop takes the middle of its own set, between the line of sight and the vertical (model
    /// section 3); a hop of full reach has only one arc.
    pub fn arc(&self, test: &HopTest, length_m: f64, choice: TakeoffChoice) -> Arc {
        let sight = LineOfSight::along(length_m, self.reach.sight_slope);
        Arc::new(sight, test.loft(choice, sight, self.lofts(test, length_m)), test.gravity_m_s2())
    }

    /// The lofts that all limits but the machine's take-off speeds allow a hop of this length along the segment; at least a single loft.
    pub fn lofts(&self, test: &HopTest, length_m: f64) -> SlopeInterval {
        // At full reach the set is a single loft, which rounding may lose.
        let only = SlopeInterval { lower: self.reach.loft, upper: self.reach.loft };
        self.reach.lofts_of(test, length_m).unwrap_or(only)
    }
}

/// The length farthest from an allowed one, towards one that is not allowed, up to which all are: bisection to the last digit.
fn last_allowed(mut allowed_m: f64, mut refused_m: f64, allows: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle_m = 0.5 * (allowed_m + refused_m);
        if middle_m == allowed_m || middle_m == refused_m {
            return allowed_m;
        }
        if allows(middle_m) { allowed_m = middle_m } else { refused_m = middle_m }
    }
}

/// The length at which a function that is concave in the inverse of the length is greatest: a golden section. It ends as soon as
/// the function is not negative.
fn greatest(shortest_m: f64, longest_m: f64, of: impl Fn(f64) -> f64) -> Option<f64> {
    /// Each step leaves 0.618 of the range: 80 steps leave 1e-17.
    const STEPS: usize = 80;
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (1.0 / longest_m, 1.0 / shortest_m);
    for _ in 0..STEPS {
        let (left, right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let values = [left, right].map(|inverse| of(1.0 / inverse));
        if let Some(i) = values.iter().position(|value| *value >= 0.0) {
            return Some(1.0 / [left, right][i]);
        }
        if values[0] > values[1] { high = right } else { low = left }
    }
    None
}

/// The reach of a hop along one segment as a function of its loft.
struct Ends<'a> {
    b: f64,
    takeoff_m_s: f64,
    landing_m_s: f64,
    test: &'a HopTest,
}

impl Ends<'_> {
    /// The distance that the speed limits allow, `min(X_t, X_l)` of [`SegmentReach`], and the limit that ends it.
    fn by_speed_m(&self, n: f64) -> (f64, Limit) {
        let covered = |speed: f64, slope: f64| 2.0 * speed * speed / self.test.gravity_m_s2() * (n / (1.0 + slope * slope));
        let (takeoff, landing) = (covered(self.takeoff_m_s, self.b + n), covered(self.landing_m_s, self.b - n));
        if landing < takeoff { (landing, Limit::LandingSpeed) } else { (takeoff, Limit::TakeoffSpeed) }
    }

    /// The distance that flight time and apex height allow, decreasing with the loft, and the limit that ends it.
    ///
    /// ```text
    ///     time T: X <= g T^2 / (2 n),      apex H: X <= 4 H n / (b + n)^2,   H / b for n <= b,   no bound for b + n <= 0
    /// ```
    fn by_machine_m(&self, n: f64) -> (f64, Limit) {
        let hopper = self.test.hopper();
        let g = self.test.gravity_m_s2();
        let time = hopper.limits().flight_time_max_s.map_or(f64::INFINITY, |t| g * t * (t / (2.0 * n)));
        let apex = hopper.limits().apex_height_max_m.map_or(f64::INFINITY, |h| {
            let m = self.b + n;
            if m <= 0.0 {
                f64::INFINITY
            } else if n <= self.b {
                // Still rising at the landing: the landing is the highest point.
                h / self.b
            } else {
                4.0 * h * (n / (m * m))
            }
        });
        if apex < time { (apex, Limit::ApexHeight) } else { (time, Limit::FlightTime) }
    }

    /// The limit that ends the distance at a loft.
    fn limit_at(&self, n: f64) -> Limit {
        let ((by_speed, speed), (by_machine, machine)) = (self.by_speed_m(n), self.by_machine_m(n));
        if by_machine < by_speed { machine } else { speed }
    }

    /// The loft of the farthest hop, between the flattest loft and the loft of greatest distance by speed.
    ///
    /// In this interval the distance allowed by the speeds increases with the loft and that allowed by the machine decreases.
    /// The best loft is the upper end, or the intersection of the two, found by bisection to the last digit.
    fn best_loft(&self, flattest: f64, fastest: f64) -> f64 {
        let machine_ends = |n: f64| self.by_machine_m(n).0 < self.by_speed_m(n).0;
        if !machine_ends(fastest) {
            return fastest;
        }
        if machine_ends(flattest) {
            return flattest;
        }
        let (mut low, mut high) = (flattest, fastest);
        loop {
            // The geometric mean bisects the exponents; both ends are positive.
            let middle = if high > 2.0 * low { low.sqrt() * high.sqrt() } else { 0.5 * (low + high) };
            if middle <= low || middle >= high {
                return low;
            }
            if machine_ends(middle) { high = middle } else { low = middle }
        }
    }
}
