//! How long a path is outside the condition of a layer that may be left for a while.
//!
//! ```text
//!   rest at u      flight      rest at v      flight      rest at w
//!   ----------===============################============----------
//!     held     outside: one end is, or the ground below    held
//!              |<---------- one stretch: hop, rest, hop ---->|
//! ```
//!
//! A stretch begins where the condition ceases to hold and ends where it holds again: at a contact, or all along a flight. Parts of a path join
//! to longer ones by what is outside at their beginnings and ends, so that a search keeps no more of a path than that.

use crate::{
    ground::{DemGround, Layer},
    quantity::MapPoint,
    terrain::MapLayers,
};

/// A time and a number of hops outside a condition.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stretch {
    /// Flights, rest and preparation, s.
    pub time_s: f64,
    /// Hops of which a part is outside.
    pub hops: f64,
}

impl Stretch {
    /// No time.
    pub const NONE: Self = Self { time_s: 0.0, hops: 0.0 };

    fn then(self, next: Self) -> Self {
        Self { time_s: self.time_s + next.time_s, hops: self.hops + next.hops }
    }

    /// What of it an allowed longest stretch limits: labels need not differ in the rest.
    const fn limited_by(self, most: Self) -> Self {
        Self {
            time_s: if most.time_s.is_finite() { self.time_s } else { 0.0 },
            hops: if most.hops.is_finite() { self.hops } else { 0.0 },
        }
    }

    /// Whether it is no longer than the longest one that is allowed, as a total keeps a budget.
    fn is_within(self, most: Self) -> bool {
        const TOLERANCE: f64 = 1e-9;
        self.time_s <= most.time_s * (1.0 + TOLERANCE) && self.hops <= most.hops
    }
}

/// How a part of a path is outside the condition of one layer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutagePart {
    /// From its beginning until the condition first holds.
    pub before: Stretch,
    /// The longest stretch of it that lies between places where the condition holds.
    pub within: Stretch,
    /// From where the condition last holds until its end.
    pub after: Stretch,
    /// Whether the condition holds nowhere in it: before and after are then the whole of it.
    pub is_open: bool,
}

impl OutagePart {
    /// The condition holds all along.
    pub const HELD: Self = Self { before: Stretch::NONE, within: Stretch::NONE, after: Stretch::NONE, is_open: false };

    /// How many numbers a label keeps of a part.
    pub(super) const WIDTH: usize = 5;

    /// A part of no length, outside all along: what a path begins with that follows another one.
    pub(super) const OPEN: Self = Self { is_open: true, ..Self::HELD };

    /// One hop.
    ///
    /// # Arguments
    /// `outside`: whether the condition is unmet at the take-off, in flight, and at the landing. `rest_s`: the time before the take-off.
    pub(super) fn of_hop([takeoff, flight, landing]: [bool; 3], rest_s: f64, flight_s: f64) -> Self {
        let flown = if flight { Stretch { time_s: flight_s, hops: 1.0 } } else { Stretch::NONE };
        let whole = Stretch { time_s: if takeoff { rest_s } else { 0.0 }, hops: 0.0 }.then(flown);
        let none = Stretch::NONE;
        match (takeoff, flight && landing) {
            (true, true) => Self { before: whole, within: none, after: whole, is_open: true },
            (true, false) => Self { before: whole, within: none, after: none, is_open: false },
            (false, true) => Self { before: none, within: none, after: flown, is_open: false },
            (false, false) => Self { before: none, within: flown, after: none, is_open: false },
        }
    }

    /// A part followed by another one; `None` if a stretch would be longer than allowed. What no limit asks for is not kept of either.
    ///
    /// What of a stretch lies before this part is not known: the beginning is judged once it is.
    pub(super) fn then(&self, next: &Self, most: Stretch) -> Option<Self> {
        let joined = self.after.then(next.before);
        let own = if next.is_open { Stretch::NONE } else { next.after };
        if [joined, next.within, own].iter().any(|stretch| !stretch.is_within(most)) {
            return None;
        }
        Some(Self {
            before: if self.is_open { joined } else { self.before }.limited_by(most),
            within: Stretch::NONE,
            after: if next.is_open { joined } else { next.after }.limited_by(most),
            is_open: self.is_open && next.is_open,
        })
    }

    /// What a label keeps.
    pub(super) const fn kept(&self) -> [f64; Self::WIDTH] {
        let is_open = if self.is_open { 1.0 } else { 0.0 };
        [self.before.time_s, self.before.hops, self.after.time_s, self.after.hops, is_open]
    }

    /// What a label keeps at least of any path that goes on from one of which these numbers are kept, and ends with a stretch no shorter than
    /// one: what lies before the condition first holds never shrinks, and of what comes nothing is known but the end.
    pub(super) fn least_after(kept: &[f64], end: Stretch) -> [f64; Self::WIDTH] {
        let before = Self::of_kept(kept).before;
        Self { before, within: Stretch::NONE, after: end, is_open: false }.kept()
    }

    /// The part of which a label keeps these numbers.
    pub(super) fn of_kept(kept: &[f64]) -> Self {
        let [before_s, before_hops, after_s, after_hops, is_open] = *kept else { return Self::HELD };
        Self {
            before: Stretch { time_s: before_s, hops: before_hops },
            within: Stretch::NONE,
            after: Stretch { time_s: after_s, hops: after_hops },
            is_open: is_open > 0.0,
        }
    }
}

/// The layers of a ground that may be left for a while, for the ends of a question.
#[derive(Clone, Debug)]
pub(super) struct Outages {
    layers: MapLayers,
    /// Where the layers that exempt targets count as met.
    exempt: Vec<MapPoint>,
}

impl Outages {
    /// `exempt`: the places of targets.
    pub(super) fn of(ground: &DemGround, exempt: Vec<MapPoint>) -> Self {
        Self { layers: ground.layers().clone(), exempt }
    }

    /// The longest stretches that are allowed, one for each layer.
    pub(super) fn most(&self) -> Vec<Stretch> {
        let most = |layer: &Layer| {
            let limit = layer.rule().outage.unwrap_or_default();
            Stretch { time_s: limit.most_s(), hops: limit.most_hops() }
        };
        self.layers.with_outages().map(most).collect()
    }

    /// Whether no layer may be left.
    pub(super) fn are_none(&self) -> bool {
        self.layers.with_outages().next().is_none()
    }

    /// Whether contacts at a place are outside the condition of any layer.
    pub(super) fn any_outside(&self, at: MapPoint) -> bool {
        self.layers.with_outages().any(|layer| layer.is_outside_at(at, &self.exempt))
    }

    /// How a hop is outside the condition of one of the layers.
    ///
    /// # Arguments
    /// `goes_on`: whether something follows the landing.
    pub(super) fn of_hop(
        &self,
        layer: usize,
        [from, to]: [MapPoint; 2],
        (rest_s, flight_s): (f64, f64),
        goes_on: bool,
    ) -> OutagePart {
        let Some(layer) = self.layers.with_outages().nth(layer) else { return OutagePart::HELD };
        let [takeoff, flight, landing] = layer.is_outside(from, to, &self.exempt);
        OutagePart::of_hop([takeoff, flight, landing && goes_on], rest_s, flight_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    /// Hop by hop: the longest stretch, with a clock.
    fn longest(hops: &[([bool; 3], f64, f64)]) -> Stretch {
        let (mut longest, mut clock) = (Stretch::NONE, Stretch::NONE);
        for ([takeoff, flight, landing], rest_s, flight_s) in hops {
            clock = if *takeoff { clock.then(Stretch { time_s: *rest_s, hops: 0.0 }) } else { Stretch::NONE };
            clock = if *flight { clock.then(Stretch { time_s: *flight_s, hops: 1.0 }) } else { clock };
            longest = Stretch { time_s: longest.time_s.max(clock.time_s), hops: longest.hops.max(clock.hops) };
            clock = if *landing { clock } else { Stretch::NONE };
        }
        longest
    }

    #[test]
    fn parts_join_to_the_longest_stretch_wherever_a_path_is_cut() {
        let draw = &mut Draw::seeded(2110);
        let (mut kept, mut broken) = (0, 0);
        for case in 0..4000 {
            let count = 1 + draw.below(7);
            let ends: Vec<bool> = (0..=count).map(|_| draw.chance(0.6)).collect();
            let hop = |number: usize, draw: &mut Draw| {
                let flight = ends[number] || ends[number + 1] || draw.chance(0.2);
                let mut time = || f64::from(u32::try_from(draw.below(9)).unwrap());
                ([ends[number], flight, ends[number + 1]], time(), time())
            };
            let hops: Vec<_> = (0..count).map(|number| hop(number, draw)).collect();
            let most = Stretch { time_s: draw.uniform(1.0, 40.0), hops: f64::from(u32::try_from(1 + draw.below(5)).unwrap()) };
            let cut = draw.below(count + 1);
            let part = |hops: &[([bool; 3], f64, f64)], begin: OutagePart| {
                hops.iter().try_fold(begin, |part, (outside, rest_s, flight_s)| {
                    part.then(&OutagePart::of_hop(*outside, *rest_s, *flight_s), most)
                })
            };
            let whole = part(&hops, OutagePart::HELD);
            let first = part(&hops[..cut], OutagePart::HELD);
            let joined = first.zip(part(&hops[cut..], OutagePart::OPEN)).and_then(|(first, second)| first.then(&second, most));
            let is_within = longest(&hops).is_within(most);
            assert_eq!((whole.is_some(), joined.is_some()), (is_within, is_within), "case {case}: {hops:?}, cut at {cut}");
            assert_eq!(whole.map(|part| part.after), joined.map(|part| part.after), "case {case}");
            assert!(whole.is_none_or(|part| OutagePart::of_kept(&part.kept()) == part), "case {case}");
            kept += u32::from(is_within);
            broken += u32::from(!is_within);
        }
        assert!(kept > 500 && broken > 500, "{kept} kept, {broken} broken");
    }
}
