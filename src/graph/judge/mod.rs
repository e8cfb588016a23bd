//! The risk of an edge: the share of flown draws that fail, or the slack of its angle.

mod over_map;

use std::cell::Cell;

use nalgebra::{Point2, Vector2};

pub(crate) use over_map::MapJudge;

use super::{Edge, HopGraph, SearchOptions};
use crate::{
    ballistics::{Arc, FlightEnvelope, LineOfSight, TakeoffChoice, loft_at_share},
    chain::Station,
    flight::{Command, Distribution, HopTrials, JudgedHop, SEARCHED_DRAWS, Survival, Uncertainty, UncertaintyProblem},
    ground::{ChainGround, ChainPosition, DemGround, MapPosition, Surface, heading_of},
    hop::{HopTest, SegmentHops, Split},
    quantity::{Angle, NodeId, SlopeInterval, normal_cdf},
    world::Direction,
};

/// Where the hops of a path really begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TakeoffScatter {
    /// The command of every hop is made for the place where the robot believes to be: only the error of that belief counts.
    OfPosition,
    /// The planned commands are flown one after the other: the errors of all landings before add up.
    OfLandings,
}

/// The source of the estimated probability to fail.
#[derive(Clone, Debug)]
pub enum RiskModel {
    /// Fixed draws of these errors, flown by the code that flies trials.
    Flown {
        /// The errors.
        errors: Uncertainty,
        /// Where the hops begin.
        takeoffs: TakeoffScatter,
        /// The DEM over which they are flown; `None`: the chain, whose ground ends where it ends.
        over: Option<Box<DemGround>>,
        /// The same chain under the limits that are flown, where planning may use only shares of them.
        whole: Option<Box<HopTest>>,
    },
    /// The margin of the flown angle to either end of its feasible set, for an angle with one degree of standard deviation.
    Slack,
}

/// The standard deviation of the angle assumed by [`RiskModel::Slack`]: one degree. A larger value distinguishes narrow sets
/// less well, a smaller value wide ones.
const SLACK_SIGMA_DEG: f64 = 1.0;

/// The weight of the share of draws that fail under doubled errors. Three hops in four survive every draw: without a second term they
/// tie, and a robot that replans over hops without weight may go in circles.
const DOUBLED_WEIGHT: f64 = 0.05;

impl RiskModel {
    /// Checks the errors.
    ///
    /// # Errors
    /// The first [`UncertaintyProblem`].
    pub fn check(&self) -> Result<(), UncertaintyProblem> {
        match self {
            // An error of the heading has no effect along a chain, as elsewhere.
            Self::Flown { errors, .. } => errors.check(true),
            Self::Slack => Ok(()),
        }
    }

    /// Whether every hop has the same probability to fail: errors that are all 0.
    pub fn distinguishes_no_hops(&self) -> bool {
        matches!(self, Self::Flown { errors, .. } if errors.is_none())
    }
}

/// The risk of an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    /// `-ln` of the estimated probability to succeed, and for flown draws a share of what fails under doubled errors.
    pub(crate) weight: f64,
    /// The loft of the most reliable command of a single hop, where it was to be chosen.
    pub(crate) loft: Option<f64>,
    /// Mean square distance of the places of rest from the planned landing, m^2.
    pub(super) spread_m2: [f64; 2],
}

impl Judged {
    const CERTAIN: Self = Self { weight: 0.0, loft: None, spread_m2: [0.0; 2] };
    const IMPOSSIBLE: Self = Self { weight: f64::INFINITY, loft: None, spread_m2: [0.0; 2] };
}

/// Judges the edges of a graph.
#[derive(Clone, Debug)]
pub(crate) struct Judge {
    test: HopTest,
    choice: TakeoffChoice,
    split: Split,
    tolerance_m: Option<f64>,
    takeoffs: TakeoffScatter,
    position_sigma_m: f64,
    trials: Trials,
}

/// The draws over the ground they are flown over.
#[derive(Clone, Debug)]
enum Trials {
    Slack,
    Chain(Box<HopTrials<ChainGround>>),
    Map(Box<HopTrials<DemGround>>),
}

/// A hop along a chain, as the judge sees it.
#[derive(Clone, Copy)]
struct Planned {
    takeoff: Station,
    landing: Station,
    sight: LineOfSight,
    lofts: SlopeInterval,
    takeoff_m2: [f64; 2],
    is_last: bool,
}

impl Judge {
    pub(crate) fn new(test: &HopTest, options: &SearchOptions, model: &RiskModel, tolerance_m: Option<f64>) -> Self {
        let (trials, takeoffs, position_sigma_m) = match model {
            RiskModel::Slack => (Trials::Slack, TakeoffScatter::OfPosition, 0.0),
            RiskModel::Flown { errors, takeoffs, over, whole } => {
                let of_takeoffs = match takeoffs {
                    TakeoffScatter::OfPosition => errors.distribution,
                    // The sum of the errors of many landings is nearly Gaussian.
                    TakeoffScatter::OfLandings => Distribution::Normal,
                };
                let trials = match over {
                    None => {
                        // Along a chain there is one plane of travel.
                        let errors = errors.in_one_plane();
                        let ground = ChainGround::new(whole.as_deref().unwrap_or(test).clone());
                        let vertices = test.chain().geometry().vertices().len();
                        Trials::Chain(Box::new(HopTrials::new(&ground, &errors, of_takeoffs, vertices, SEARCHED_DRAWS)))
                    }
                    Some(ground) => Trials::Map(Box::new(HopTrials::new(ground.as_ref(), errors, of_takeoffs, 1, SEARCHED_DRAWS))),
                };
                (trials, *takeoffs, errors.position_sigma_m)
            }
        };
        Self { test: test.clone(), choice: options.takeoff, split: options.split, tolerance_m, takeoffs, position_sigma_m, trials }
    }

    /// Mean square distance of a take-off from its plan after a hop with this spread of its places of rest, m^2.
    pub(crate) fn takeoff_m2(&self, spread_m2: [f64; 2]) -> [f64; 2] {
        match self.takeoffs {
            TakeoffScatter::OfPosition => [self.position_sigma_m * self.position_sigma_m; 2],
            TakeoffScatter::OfLandings => spread_m2,
        }
    }

    /// Whether the robot makes the command of every hop anew where it is.
    const fn replans(&self) -> bool {
        matches!(self.takeoffs, TakeoffScatter::OfPosition)
    }

    /// The least weight of an edge: that of one hop whose draws all survive.
    pub(super) fn least_weight(&self) -> f64 {
        let draws = f64::from(SEARCHED_DRAWS);
        if matches!(self.trials, Trials::Slack) { 0.0 } else { -libm::log((draws + 0.5) / (draws + 1.0)) }
    }

    /// Whether the risk of an edge depends on the hops before it.
    pub(super) const fn depends_on_hops_before(&self) -> bool {
        matches!((self.takeoffs, &self.trials), (TakeoffScatter::OfLandings, Trials::Chain(_) | Trials::Map(..)))
    }

    /// The risk of an edge between two nodes, for a take-off that scatters about its node. Draws end once the weight cannot be below
    /// `below`; it is then that or more.
    pub(crate) fn edge(&self, graph: &HopGraph, (from, to): (usize, usize), takeoff_m2: [f64; 2], below: f64) -> Judged {
        let nodes = graph.nodes();
        let (takeoff, landing) = (*nodes.station(NodeId(from)), *nodes.station(NodeId(to)));
        let is_last = nodes.goal() == NodeId(to);
        match graph.edge(&takeoff, &landing) {
            Ok(Edge::Hop(lofts)) => self.single((&takeoff, &landing), lofts, takeoff_m2, is_last, below),
            Ok(Edge::Along(along)) => self.along((takeoff, landing), &along, takeoff_m2, is_last),
            // The pair was an edge when the lattice was built.
            Err(_) => Judged::IMPOSSIBLE,
        }
    }

    /// The risk of one hop between two stations; as [`edge`](Self::edge).
    pub(super) fn single(
        &self,
        (takeoff, landing): (&Station, &Station),
        lofts: SlopeInterval,
        takeoff_m2: [f64; 2],
        is_last: bool,
        below: f64,
    ) -> Judged {
        let Some(sight) = self.test.line_of_sight(takeoff, landing) else { return Judged::CERTAIN };
        let planned = Planned { takeoff: *takeoff, landing: *landing, sight, lofts, takeoff_m2, is_last };
        if self.choice != TakeoffChoice::MostReliable {
            return self.weighed(&planned, self.test.loft(self.choice, sight, lofts), below);
        }
        let most = failures_enough(below);
        let best: Cell<Option<(f64, Survival)>> = Cell::new(None);
        let loft = self.most_reliable(sight, lofts, |loft, enough| {
            let survival = self.survival(&planned, loft, enough.min(most));
            if best.get().is_none_or(|(_, known)| survival.failed < known.failed) {
                best.set(Some((loft, survival)));
            }
            survival
        });
        let judged = match best.get().filter(|(known, _)| *known == loft) {
            Some((_, survival)) => self.weighed_after(survival, &planned, loft, below),
            None => self.weighed(&planned, loft, below),
        };
        Judged { loft: Some(loft), ..judged }
    }

    /// The loft of the most reliable command of a hop over the map from where the robot believes to be; `None` for a chain.
    pub(super) fn loft_on_map(
        &self,
        (from, to): (&MapPosition, &MapPosition),
        heading: Vector2<f64>,
        (sight, lofts): (LineOfSight, SlopeInterval),
    ) -> Option<f64> {
        let Trials::Map(over) = &self.trials else { return None };
        Some(self.most_reliable(sight, lofts, |loft, enough| {
            let command = Command::of_arc(&Arc::new(sight, loft, self.test.gravity_m_s2()), heading, *to);
            let takeoff_sigma_m = [self.position_sigma_m; 2];
            over.survival(&JudgedHop { from: *from, command, takeoff_sigma_m, goal: None, aims_at_rest: true }, enough)
        }))
    }

    /// The loft of the most reliable command.
    fn most_reliable(&self, sight: LineOfSight, lofts: SlopeInterval, survival: impl Fn(f64, u32) -> Survival) -> f64 {
        if matches!(self.trials, Trials::Slack) {
            return self.test.loft(TakeoffChoice::MidRange, sight, lofts);
        }
        most_reliable(self.test.envelope(), (sight, lofts), |loft, enough| survival(loft, enough).failed)
    }

    /// The weight of a hop with a command; as [`edge`](Self::edge).
    fn weighed(&self, planned: &Planned, loft: f64, below: f64) -> Judged {
        if matches!(self.trials, Trials::Slack) {
            return Judged { weight: -libm::log(slack_success(planned, loft).max(LEAST_SUCCESS)), ..Judged::CERTAIN };
        }
        self.weighed_after(self.survival(planned, loft, failures_enough(below)), planned, loft, below)
    }

    /// The same after its draws were flown.
    fn weighed_after(&self, Survival { of, failed, spread_m2 }: Survival, planned: &Planned, loft: f64, below: f64) -> Judged {
        // Of draws that ended early, those not flown count as survivors.
        let count = if failed > 0 { of.max(SEARCHED_DRAWS) } else { of };
        let weight = -libm::log((f64::from(count - failed) + 0.5) / (f64::from(count) + 1.0));
        if weight >= below {
            return Judged { weight, loft: None, spread_m2 };
        }
        Judged { weight: weight + DOUBLED_WEIGHT * self.failing_share_of_doubled(planned, loft), loft: None, spread_m2 }
    }

    fn survival(&self, planned: &Planned, loft: f64, enough: u32) -> Survival {
        match &self.trials {
            Trials::Slack => Survival::default(),
            Trials::Chain(trials) => {
                self.on_chain(planned, loft).map_or_else(Survival::default, |hop| trials.survival(&hop, enough))
            }
            Trials::Map(over) => {
                self.on_map(over.ground(), planned, loft).map_or_else(Survival::default, |hop| over.survival(&hop, enough))
            }
        }
    }

    fn failing_share_of_doubled(&self, planned: &Planned, loft: f64) -> f64 {
        match &self.trials {
            Trials::Slack => 0.0,
            Trials::Chain(trials) => self.on_chain(planned, loft).map_or(0.0, |hop| trials.failing_share_of_doubled(&hop)),
            Trials::Map(over) => self.on_map(over.ground(), planned, loft).map_or(0.0, |hop| over.failing_share_of_doubled(&hop)),
        }
    }

    /// The hop in the plane of the chain; `None` from a station to itself.
    fn on_chain(&self, planned: &Planned, loft: f64) -> Option<JudgedHop<ChainPosition>> {
        let direction = Direction::between(planned.takeoff.point.x_m, planned.landing.point.x_m)?;
        let [from, aim] = [planned.takeoff, planned.landing].map(ChainPosition::on_chain);
        let command = Command::of_arc(&self.arc(planned, loft), heading_of(direction), aim);
        let goal = self.tolerance_m.filter(|_| planned.is_last).map(|m| (Point2::new(planned.landing.point.x_m, 0.0), m));
        Some(JudgedHop { from, command, takeoff_sigma_m: planned.takeoff_m2.map(f64::sqrt), goal, aims_at_rest: self.replans() })
    }

    /// The hop over the map; `None` where a station lies on no map, or off the ground.
    fn on_map(&self, ground: &DemGround, planned: &Planned, loft: f64) -> Option<JudgedHop<MapPosition>> {
        let position = |station: &Station| {
            let point = self.test.chain().contact_point(station);
            let at = point.map().filter(|at| ground.covers(*at))?;
            Some(MapPosition { at, z_m: point.point_m.z })
        };
        let (from, aim) = (position(&planned.takeoff)?, position(&planned.landing)?);
        let heading = (aim.at - from.at).try_normalize(0.0)?;
        let command = Command::of_arc(&self.arc(planned, loft), heading, aim);
        let goal = self.tolerance_m.filter(|_| planned.is_last).map(|m| (aim.at, m));
        Some(JudgedHop { from, command, takeoff_sigma_m: planned.takeoff_m2.map(f64::sqrt), goal, aims_at_rest: self.replans() })
    }

    fn arc(&self, planned: &Planned, loft: f64) -> Arc {
        Arc::new(planned.sight, loft, self.test.gravity_m_s2())
    }

    /// The risk of many hops along one segment. The hops near its ends are judged one by one, since their scatter includes other ground;
    /// the hops between have the weight of the last of these.
    #[expect(clippy::cast_precision_loss, reason = "at most 2^53 hops")]
    fn along(&self, (takeoff, landing): (Station, Station), along: &SegmentHops, takeoff_m2: [f64; 2], is_last: bool) -> Judged {
        const BESIDE_AN_END: u64 = 16;
        let test = &self.test;
        let Some(direction) = Direction::between(takeoff.point.x_m, landing.point.x_m) else { return Judged::CERTAIN };
        let (each_m, last_m) = along.lengths_m(self.split);
        let geometry = test.chain().geometry();
        let place = |i: u64| match i {
            0 => Some(takeoff),
            i if i == along.hops() => Some(landing),
            i => geometry.station(takeoff.point.x_m + direction.sign() * each_m * i as f64).ok(),
        };
        let judged = |i: u64, takeoff_m2: [f64; 2]| {
            let (Some(from), Some(to)) = (place(i), place(i + 1)) else { return Judged::CERTAIN };
            let length_m = if i + 1 == along.hops() { last_m } else { each_m };
            let arc = along.arc(test, length_m, self.choice);
            let is_last = is_last && i + 1 == along.hops();
            let sight = arc.line_of_sight();
            let lofts = along.lofts(test, length_m);
            self.weighed(&Planned { takeoff: from, landing: to, sight, lofts, takeoff_m2, is_last }, arc.loft(), f64::INFINITY)
        };
        let (mut weight, mut takeoff_m2) = (0.0, takeoff_m2);
        let mut spread_m2 = [0.0; 2];
        let mut fly = |i: u64, times: u64| {
            let hop = judged(i, takeoff_m2);
            weight += hop.weight * times as f64;
            spread_m2 = hop.spread_m2;
            takeoff_m2 = self.takeoff_m2(spread_m2);
        };
        let beside = BESIDE_AN_END.min(along.hops().div_ceil(2));
        (0..beside).for_each(|i| fly(i, 1));
        let last = along.hops() - beside.min(along.hops() - beside);
        if last > beside {
            fly(beside, last - beside);
        }
        (last..along.hops()).for_each(|i| fly(i, 1));
        Judged { weight, loft: None, spread_m2 }
    }
}

/// Of nine angles over the window, from the middle outwards, the first that the most draws survive, as a loft.
///
/// `failures` counts the draws that fail with a loft; it may end at its second argument, from which on they are too many.
fn most_reliable(
    envelope: &FlightEnvelope,
    (sight, lofts): (LineOfSight, SlopeInterval),
    failures: impl Fn(f64, u32) -> u32,
) -> f64 {
    const SHARES: [f64; 8] = [0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9];
    let middle = envelope.loft(TakeoffChoice::MidRange, sight, lofts);
    let windows = envelope.takeoff_speeds().windows(sight, lofts, envelope.gravity_m_s2());
    let windows: Vec<SlopeInterval> = windows.map(|window| window.lofts).collect();
    let spread = SHARES.map(|share| loft_at_share(sight, lofts, share));
    let allowed = spread.into_iter().filter(|loft| windows.iter().any(|window| window.contains(*loft)));
    // A machine of few speeds has few angles.
    let single = windows.iter().filter(|window| window.lower == window.upper).map(|window| window.lower);
    let (mut best, mut least) = (middle, u32::MAX);
    for loft in std::iter::once(middle).chain(allowed).chain(single) {
        let failed = failures(loft, least);
        if failed < least {
            (best, least) = (loft, failed);
        }
        if least == 0 {
            break;
        }
    }
    best
}

/// The failures of [`SEARCHED_DRAWS`] with which a hop weighs at least this much: `-ln((K - f + 1/2) / (K + 1)) >= below`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 0 and the number of draws")]
fn failures_enough(below: f64) -> u32 {
    let draws = f64::from(SEARCHED_DRAWS);
    // One more keeps a failure of rounding from ending the draws of a hop that weighs less.
    let failures = (draws + 0.5 - (draws + 1.0) * libm::exp(-below)).ceil() + 1.0;
    if failures >= draws { u32::MAX } else { failures.max(1.0) as u32 }
}

/// The least success that a weight tells from none: a certain failure has a finite weight, so that paths with fewer of them are better.
const LEAST_SUCCESS: f64 = 1e-12;

/// The success probability from the margin of the flown angle alone.
fn slack_success(planned: &Planned, loft: f64) -> f64 {
    let angle_deg = |loft: f64| Angle::from_slope(planned.sight.slope() + loft).degrees();
    let flown_deg = angle_deg(loft);
    let kept = |slack_deg: f64| normal_cdf(slack_deg / SLACK_SIGMA_DEG);
    kept(flown_deg - angle_deg(planned.lofts.lower)) + kept(angle_deg(planned.lofts.upper) - flown_deg) - 1.0
}

#[cfg(test)]
mod tests;
