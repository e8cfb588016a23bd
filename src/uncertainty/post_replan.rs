//! Replanning over a map, by hops to its posts in any direction.

use std::{ops::RangeInclusive, sync::Arc};

use nalgebra::Vector2;

use super::replan::{HopReach, Replan};
use crate::{
    ballistics::{self, LineOfSight, safety_range_m},
    flight::Command,
    graph::{Cost, MapJudge, PostCosts},
    ground::{DemGround, MapPosition, Post},
    quantity::SlopeInterval,
    terrain::GeoReference,
};

/// Replanning over a DEM, by the costs-to-go of its posts.
///
/// Only the posts within reach of one hop are looked at: those of a window about the position.
#[derive(Debug)]
pub(super) struct PostReplan {
    ground: DemGround,
    to_go: Arc<PostCosts>,
    reach: HopReach,
    /// The map of the posts.
    map: GeoReference,
    /// The lowest elevation, m.
    lowest_m: f64,
}

/// The posts about a position, by row and column.
struct Window {
    rows: RangeInclusive<usize>,
    cols: RangeInclusive<usize>,
}

/// A post that one hop may reach.
struct Candidate {
    post: Post,
    target: MapPosition,
    sight: LineOfSight,
    heading: Vector2<f64>,
    /// The cost-to-go of the post.
    rest: Cost,
    /// A lower bound on the cost of the journey over it.
    least: Cost,
}

impl PostReplan {
    pub(super) fn new(ground: DemGround, to_go: Arc<PostCosts>) -> Self {
        let dem = ground.terrain().dem();
        let map = dem.georeference().every(to_go.lattice().stride);
        let (lowest_m, _) = dem.elevation_range_m();
        Self { reach: HopReach::of(&ground), ground, to_go, map, lowest_m }
    }

    /// The posts that one hop from a position may reach, and some more.
    ///
    /// With C the length of the line of sight and Z its rise, `g (C + Z) <= v_t^2` and `g (C - Z) <= v_l^2` (see
    /// [`LineOfSight::min_speed_ratio`]), so that `2 g C <= v_t^2 + v_l^2`; and no hop goes farther than one down to the lowest ground.
    fn window(&self, from: &MapPosition) -> Window {
        let HopReach { takeoff_squared, landing_squared, gravity_m_s2 } = self.reach;
        let down_m = safety_range_m((from.z_m - self.lowest_m).max(0.0), takeoff_squared.sqrt(), gravity_m_s2);
        let run_m = down_m.min((takeoff_squared + landing_squared) / (2.0 * gravity_m_s2));
        let lattice = self.to_go.lattice();
        let Post { row, col } = lattice.nearest(self.ground.terrain().dem().georeference(), from.at);
        let about = |at: usize, step_m: f64, count: usize| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
            let posts = (run_m / step_m) as usize;
            // The position lies half a post from the nearest at most.
            let posts = posts.saturating_add(1);
            at.saturating_sub(posts)..=at.saturating_add(posts).min(count - 1)
        };
        Window { rows: about(row, self.map.dy_m(), lattice.rows), cols: about(col, self.map.dx_m(), lattice.cols) }
    }

    /// The least count of hops to the goal, at least `least`, of the posts of a window.
    fn level(&self, window: &Window, least: u16) -> Option<u16> {
        self.hops(window).filter_map(|(_, hops)| hops.filter(|&hops| hops >= least)).min()
    }

    fn hops<'a>(&'a self, window: &'a Window) -> impl Iterator<Item = (Post, Option<u16>)> + 'a {
        let posts = window.rows.clone().flat_map(|row| window.cols.clone().map(move |col| Post { row, col }));
        posts.map(|post| (post, self.to_go.hops_from(post)))
    }

    /// The posts with a count of hops to the goal that one hop may reach, those with the least bound on the cost of the journey first.
    fn candidates(&self, from: &MapPosition, window: &Window, level: u16) -> Vec<Candidate> {
        let at_level = self.hops(window).filter(|(_, hops)| *hops == Some(level));
        let mut candidates: Vec<Candidate> = at_level.filter_map(|(post, _)| self.candidate(from, post)).collect();
        candidates.sort_by_key(|candidate| (candidate.least, candidate.post));
        candidates
    }

    fn candidate(&self, from: &MapPosition, post: Post) -> Option<Candidate> {
        let Post { row, col } = self.to_go.lattice().post(post);
        let z_m = self.ground.terrain().dem().elevation(row, col)?;
        let target = MapPosition { at: self.map.post(post.row, post.col), z_m };
        let (sight, heading) = self.reach.sight(&self.ground, from, &target)?;
        let rest = self.to_go.of_post(post)?;
        let least = self.to_go.effort().least_cost(sight, self.reach.gravity_m_s2) + rest;
        Some(Candidate { post, target, sight, heading, rest, least })
    }

    /// The command of a hop to a candidate and the cost of the journey over it, for the choice of take-offs alone.
    fn hop(&self, from: &MapPosition, candidate: &Candidate) -> Option<(ballistics::Arc, SlopeInterval, Cost)> {
        let Candidate { target, sight, heading, rest, .. } = candidate;
        let lofts = self.ground.lofts_by_walk(from, target, *sight, *heading)?;
        let loft = self.ground.envelope().loft(self.to_go.takeoff(), *sight, lofts);
        let arc = ballistics::Arc::new(*sight, loft, self.reach.gravity_m_s2);
        Some((arc, lofts, self.to_go.effort().cost(&arc, 1) + *rest))
    }

    /// The cheapest hop to any post.
    fn cheapest(&self, from: &MapPosition) -> Option<Command<MapPosition>> {
        let window = self.window(from);
        let mut least = 0;
        while let Some(level) = self.level(&window, least) {
            let mut best: Option<(Command<MapPosition>, Cost)> = None;
            for candidate in self.candidates(from, &window, level) {
                if best.as_ref().is_some_and(|(_, cost)| candidate.least >= *cost) {
                    break;
                }
                let Some((arc, _, cost)) = self.hop(from, &candidate) else { continue };
                if best.as_ref().is_none_or(|(_, known)| cost < *known) {
                    best = Some((Command::of_arc(&arc, candidate.heading, candidate.target), cost));
                }
            }
            // Hops count first: no post of more hops to the goal is better.
            if let Some((command, _)) = best {
                return Some(command);
            }
            least = level.checked_add(1)?;
        }
        None
    }

    /// The most reliable of the hops that lead on.
    fn reliable(&self, judge: &MapJudge, from: &MapPosition) -> Option<Command<MapPosition>> {
        let env = |name: &str, default: f64| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default);
        let (tried_max, rho, side) = (env("CH_K", 8.0) as usize, env("CH_RHO", 0.05), env("CH_SIDE", 0.0) as u16);
        let spread = env("CH_SPREAD", 0.0) > 0.0;
        let window = self.window(from);
        // Posts of as many hops as the nearest one do not lead on.
        let nearest = self.to_go.lattice().nearest(self.ground.terrain().dem().georeference(), from.at);
        let own = self.to_go.hops_from(nearest);
        let mut best: Option<(Command<MapPosition>, f64)> = None;
        let (mut least, mut first) = (0, None);
        while let Some(level) = self.level(&window, least) {
            if best.is_some() && own.is_none_or(|own| level >= own + side) {
                break;
            }
            let extra = rho * f64::from(level - first.unwrap_or(level));
            if best.as_ref().is_some_and(|(_, weight)| *weight <= extra) {
                break;
            }
            let mut tried = 0;
            let candidates = self.candidates(from, &window, level);
            let step = if spread { (candidates.len() / (2 * tried_max)).max(1) } else { 1 };
            for i in (0..candidates.len()).step_by(step) {
                let candidate = &candidates[i];
                let Some((_, lofts, _)) = self.hop(from, candidate) else { continue };
                let (loft, failed) = judge.command((from, &candidate.target), candidate.heading, (candidate.sight, lofts));
                let weight = -libm::log((64.5 - f64::from(failed)) / 64.5) + extra;
                if best.as_ref().is_none_or(|(_, known)| weight < *known) {
                    let arc = ballistics::Arc::new(candidate.sight, loft, self.reach.gravity_m_s2);
                    best = Some((Command::of_arc(&arc, candidate.heading, candidate.target), weight));
                }
                tried += 1;
                if failed == 0 || tried == tried_max {
                    break;
                }
            }
            if tried > 0 {
                first = first.or(Some(level));
            }
            let Some(next) = level.checked_add(1) else { break };
            least = next;
        }
        best.map(|(command, _)| command)
    }
}

impl Replan<MapPosition> for PostReplan {
    fn next(&self, believed: &MapPosition) -> Option<Command<MapPosition>> {
        if let Some(judge) = self.to_go.judge() {
            return self.reliable(judge, believed);
        }
        self.cheapest(believed)
    }

    fn follows_plan(&self) -> bool {
        self.to_go.judge().is_none()
    }
}
