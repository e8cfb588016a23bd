//! Replanning over a map, by hops to its posts in any direction.
//!
//! Only the posts within reach of one hop are looked at: those of a window about the position.

use std::{ops::RangeInclusive, sync::Arc};

use nalgebra::Vector2;

use super::replan::{Replan, in_steps};
use crate::{
    ballistics::{self, LineOfSight},
    flight::Command,
    graph::{Cost, MapJudge, PostCosts, PostRisks},
    ground::{DemGround, HopReach, MapPosition, NodeLattice, Post, Surface},
    quantity::SlopeInterval,
    terrain::GeoReference,
};

/// The posts of a ground, as a robot that replans sees them.
#[derive(Debug)]
struct Posts {
    ground: DemGround,
    lattice: NodeLattice,
    /// Their map.
    map: GeoReference,
    reach: HopReach,
}

/// The line to a post that one hop may reach.
struct Line {
    post: Post,
    target: MapPosition,
    sight: LineOfSight,
    heading: Vector2<f64>,
}

/// The posts about a position, by row and column.
struct Window {
    rows: RangeInclusive<usize>,
    cols: RangeInclusive<usize>,
}

impl Window {
    fn posts(&self) -> impl Iterator<Item = Post> + use<> {
        let cols = self.cols.clone();
        self.rows.clone().flat_map(move |row| cols.clone().map(move |col| Post { row, col }))
    }
}

impl Posts {
    fn new(ground: &DemGround, lattice: NodeLattice) -> Self {
        let dem = ground.terrain().dem();
        let map = lattice.map(dem.georeference());
        Self { reach: HopReach::of(ground), ground: ground.clone(), lattice, map }
    }

    /// The posts that one hop from a position may reach, and some more.
    fn window(&self, from: &MapPosition) -> Window {
        let run_m = self.reach.run_m(from);
        let Post { row, col } = self.lattice.nearest(self.ground.terrain().dem().georeference(), from.at);
        let about = |at: usize, step_m: f64, count: usize| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
            let posts = (run_m / step_m) as usize;
            // The position lies half a post from the nearest at most.
            let posts = posts.saturating_add(1);
            at.saturating_sub(posts)..=at.saturating_add(posts).min(count - 1)
        };
        Window { rows: about(row, self.map.dy_m(), self.lattice.rows), cols: about(col, self.map.dx_m(), self.lattice.cols) }
    }

    /// The line to a post; `None` if no hop can span it, or if the post has no elevation.
    fn line(&self, from: &MapPosition, post: Post) -> Option<Line> {
        let target = self.lattice.position(self.ground.terrain().dem(), post)?;
        let (sight, heading) = self.reach.sight(&self.ground, from, &target)?;
        Some(Line { post, target, sight, heading })
    }

    /// The feasible lofts along a line.
    fn lofts(&self, from: &MapPosition, line: &Line) -> Option<SlopeInterval> {
        self.ground.lofts_by_walk(from, &line.target, line.sight, line.heading)
    }

    fn is_in_steps(&self) -> bool {
        !self.ground.hopper().limits().steps.is_continuous()
    }
}

/// Replanning over a DEM, by the costs-to-go of its posts.
#[derive(Debug)]
pub(super) struct CheapestPost {
    posts: Posts,
    to_go: Arc<PostCosts>,
}

impl CheapestPost {
    pub(super) fn new(ground: &DemGround, to_go: &Arc<PostCosts>) -> Self {
        Self { posts: Posts::new(ground, to_go.lattice()), to_go: Arc::clone(to_go) }
    }

    /// The posts of a window from which the goal is this many hops away and that one hop may reach, those with the least bound on the
    /// cost of the journey over them first.
    fn lines(&self, from: &MapPosition, window: &Window, hops: u16) -> Vec<(Cost, Line)> {
        let least = |line: &Line| {
            let rest = self.to_go.of_post(line.post)?;
            Some(self.to_go.effort().least_cost(line.sight, self.posts.reach.gravity_m_s2()) + rest)
        };
        let of_hops = window.posts().filter(|post| self.to_go.hops_from(*post) == Some(hops));
        let mut lines: Vec<(Cost, Line)> = of_hops
            .filter_map(|post| {
                let line = self.posts.line(from, post)?;
                Some((least(&line)?, line))
            })
            .collect();
        lines.sort_by_key(|(least, line)| (*least, line.post));
        lines
    }

    /// The command along a line and the cost of the journey over it, if it may be lower than `best`.
    fn hop(&self, from: &MapPosition, line: &Line, best: Option<Cost>) -> Option<(Command<MapPosition>, Cost)> {
        let Line { post, target, sight, heading } = line;
        let lofts = self.posts.lofts(from, line)?;
        let loft = self.posts.ground.envelope().loft(self.to_go.takeoff(), *sight, lofts);
        let arc = ballistics::Arc::new(*sight, loft, self.posts.reach.gravity_m_s2());
        let cost = self.to_go.effort().cost(&arc, 1) + self.to_go.of_post(*post)?;
        if best.is_some_and(|best| cost >= best) {
            return None;
        }
        let command = if self.posts.is_in_steps() {
            in_steps(&self.posts.ground, from, target, self.to_go.takeoff())?
        } else {
            Command::of_arc(&arc, *heading, *target)
        };
        Some((command, cost))
    }
}

impl Replan<MapPosition> for CheapestPost {
    fn next(&self, believed: &MapPosition) -> Option<Command<MapPosition>> {
        let window = self.posts.window(believed);
        let mut least = 0;
        loop {
            let hops = window.posts().filter_map(|post| self.to_go.hops_from(post)).filter(|&hops| hops >= least).min()?;
            let mut best: Option<(Command<MapPosition>, Cost)> = None;
            for (bound, line) in self.lines(believed, &window, hops) {
                let known = best.as_ref().map(|(_, cost)| *cost);
                if known.is_some_and(|known| bound >= known) {
                    break;
                }
                best = self.hop(believed, &line, known).or(best);
            }
            // Hops count first: no post with more hops to go is better.
            if let Some((command, _)) = best {
                return Some(command);
            }
            least = hops.checked_add(1)?;
        }
    }
}

/// Replanning over a DEM, by the risks-to-go of its posts.
#[derive(Debug)]
pub(super) struct ReliablePost {
    posts: Posts,
    to_go: Arc<PostRisks>,
}

impl ReliablePost {
    pub(super) fn new(ground: &DemGround, to_go: &Arc<PostRisks>) -> Self {
        Self { posts: Posts::new(ground, to_go.lattice()), to_go: Arc::clone(to_go) }
    }

    /// The hops that lead on, by the estimated weight of the journey over them, the least first.
    ///
    /// At a post, all lead to posts of less weight than its own: no hop goes in a circle.
    fn hops(&self, from: &MapPosition) -> Vec<(f64, Line, SlopeInterval)> {
        let judge = self.to_go.judge();
        let weight = |post: Post| Some(self.to_go.of_post(post)).filter(|weight| weight.is_finite());
        let in_reach = self.posts.window(from).posts().filter_map(|post| Some((weight(post)?, self.posts.line(from, post)?)));
        let mut lines: Vec<(f64, Line)> = in_reach.collect();
        lines.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.post.cmp(&b.1.post)));
        let (mut hops, mut best) = (Vec::new(), f64::INFINITY);
        for (rest, line) in lines {
            if rest + MapJudge::EACH_HOP >= best {
                break;
            }
            let Some(lofts) = self.posts.lofts(from, &line) else { continue };
            let total = rest + judge.estimate(&line.target, line.heading, (line.sight, lofts));
            best = best.min(total);
            hops.push((total, line, lofts));
        }
        hops.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.post.cmp(&b.1.post)));
        hops
    }
}

impl Replan<MapPosition> for ReliablePost {
    fn next(&self, believed: &MapPosition) -> Option<Command<MapPosition>> {
        let (hops, judge) = (self.hops(believed), self.to_go.judge());
        if self.posts.is_in_steps() {
            let in_steps = |line: &Line| in_steps(&self.posts.ground, believed, &line.target, judge.takeoff());
            return hops.iter().find_map(|(_, line, _)| in_steps(line));
        }
        let (_, line, lofts) = hops.first()?;
        Some(judge.command((believed, &line.target), line.heading, (line.sight, *lofts)))
    }

    /// The plan has the fewest hops, whatever their risk.
    fn follows_plan(&self) -> bool {
        false
    }
}
