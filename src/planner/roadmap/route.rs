//! The best path of a roadmap, and what lies between start and goal where no path is found.

use nalgebra::Point3;

use super::{Roadmap, RoadmapGround, RoadmapLegs};
use crate::{
    ballistics::{Arc, TakeoffChoice},
    graph::RefusalCounts,
    planner::{
        Amount, Amounts, Budgets, FoundPath, LabelCap, Objective, SearchedCommands, UnmetBudget, front,
        search::{search, without_budgets},
    },
    progress::{Cancelled, Meter, Progress, Stage},
};

/// What a path of a roadmap is searched for.
#[derive(Clone, Copy, Debug)]
pub struct RoadmapQuestion<'a> {
    /// What is to be least.
    pub objective: &'a Objective,
    /// The greatest totals.
    pub budgets: &'a Budgets,
    /// The commands of a hop.
    pub commands: SearchedCommands,
    /// The command of a hop that offers no others.
    pub takeoff: TakeoffChoice,
    /// How many labels are kept.
    pub cap: LabelCap,
}

/// The move from one contact of a path to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RoadmapMove {
    /// A hop along an arc.
    Hop(Arc),
    /// A straight line over the ground, which is walked.
    Walk,
}

/// A path of a roadmap.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadmapPath {
    /// The contacts from start to goal, by their numbers.
    pub contacts: Vec<usize>,
    /// The move from each contact to the next.
    pub moves: Vec<RoadmapMove>,
    /// What it takes.
    pub totals: Amounts,
}

/// The result of a search over a roadmap.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadmapRoute {
    /// The best path within the budgets, or the best without budgets, if no path keeps them; `None` if the goal was not reached over these
    /// contacts.
    pub path: Option<RoadmapPath>,
    /// Whether it keeps the budgets.
    pub within: bool,
    /// If not: those that it exceeds. If the least of each is within it, no path keeps all of them at once.
    pub unmet: Vec<UnmetBudget>,
    /// Whether labels were left out: the path may then not be the best, and that none keeps the budgets is not certain.
    pub capped: bool,
}

impl RoadmapPath {
    /// The places among its contacts from which its hops take off, in their order; each lands at the next contact.
    pub fn takeoffs(&self) -> Vec<usize> {
        self.moves.iter().enumerate().filter(|(_, each)| matches!(each, RoadmapMove::Hop(_))).map(|(number, _)| number).collect()
    }

    /// The arcs of its hops, in their order.
    pub fn arcs(&self) -> Vec<Arc> {
        self.moves.iter().filter_map(|each| if let RoadmapMove::Hop(arc) = each { Some(*arc) } else { None }).collect()
    }
}

impl<N: Clone + Send + Sync> Roadmap<N> {
    /// The best path from a start to a goal by an objective, within budgets.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn route(
        &self,
        ground: &impl RoadmapGround<Node = N>,
        ends: (usize, usize),
        question: &RoadmapQuestion<'_>,
    ) -> Result<RoadmapRoute, Cancelled> {
        let RoadmapQuestion { objective, budgets, commands, takeoff, cap } = *question;
        let legs = RoadmapLegs::new(self, ground, ends, (commands, takeoff));
        let no = RoadmapRoute { path: None, within: false, unmet: Vec::new(), capped: false };
        if legs.hops_left()[ends.0].is_none() {
            return Ok(no);
        }
        let found = search(&legs, ends, objective, budgets, cap)?;
        if let Some(path) = found.path {
            return Ok(RoadmapRoute { path: Some(path_of(&legs, &path)), within: true, capped: found.capped, ..no });
        }
        let Some(best) = without_budgets(&legs, ends, objective, budgets, cap)? else { return Ok(no) };
        let capped = found.capped || best.capped;
        Ok(RoadmapRoute { path: Some(path_of(&legs, &best.path)), within: best.within, unmet: best.unmet, capped })
    }

    /// The Pareto front of hops against another amount, within budgets, in ascending order of hops, and whether labels were left out.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn front(
        &self,
        ground: &impl RoadmapGround<Node = N>,
        ends: (usize, usize),
        (amount, question): (Amount, &RoadmapQuestion<'_>),
    ) -> Result<(Vec<RoadmapPath>, bool), Cancelled> {
        let legs = RoadmapLegs::new(self, ground, ends, (question.commands, question.takeoff));
        let (paths, capped) = front(&legs, ends, (Amount::Hops, amount), question.budgets, question.cap)?;
        Ok((paths.iter().map(|path| path_of(&legs, path)).collect(), capped))
    }

    /// What lies between the contacts that a start reaches and those that lead to a goal.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Complexity
    /// A square root for every pair of a reached contact and one that leads to the goal, and the hops of at most
    /// [`JUDGED_MAX`](RoadmapGap::JUDGED_MAX) pairs.
    pub fn gap(
        &self,
        ground: &impl RoadmapGround<Node = N>,
        (start, goal): (usize, usize),
        progress: &dyn Progress,
    ) -> Result<RoadmapGap, Cancelled> {
        let meter = Meter::new(progress, Stage::Search).after(self.pairs_tested());
        let (reached, leading) = (numbers(&self.hops_out_of(start)), numbers(&self.hops_to(goal)));
        let point = |node: usize| ground.point_m(self.contact(node));
        let nearest = |of: &[usize], to: usize| {
            let away = |node: &usize| (point(*node) - point(to)).norm_squared();
            of.iter().copied().min_by(|a, b| away(a).total_cmp(&away(b)))
        };
        let bounds = ground.speed_bounds();
        let spanned = |from: usize| {
            leading.iter().copied().filter(move |to| {
                let away = point(*to) - point(from);
                bounds.span(away.norm(), away.z)
            })
        };
        let (mut pairs, mut least_m2) = (0_u64, f64::INFINITY);
        for (number, &from) in reached.iter().enumerate() {
            meter.check_piece(number)?;
            for to in spanned(from) {
                pairs += 1;
                least_m2 = least_m2.min((point(to) - point(from)).norm_squared());
            }
        }
        let every = pairs.div_ceil(RoadmapGap::JUDGED_MAX).max(1);
        let mut gap = RoadmapGap {
            nearest_m: point(nearest(&reached, goal).unwrap_or(start)),
            reached: reached.len(),
            leads_from_m: point(nearest(&leading, start).unwrap_or(goal)),
            leading: leading.len(),
            width_m: (pairs > 0).then(|| least_m2.sqrt()),
            pairs,
            judged: 0,
            refusals: RefusalCounts::default(),
            vertical: 0,
            free: 0,
        };
        let mut pair = 0;
        for (number, &from) in reached.iter().enumerate() {
            meter.check_piece(number)?;
            for to in spanned(from) {
                pair += 1;
                if !u64::is_multiple_of(pair - 1, every) {
                    continue;
                }
                gap.judged += 1;
                let [takeoff, landing] = [from, to].map(|node| self.contact(node));
                match ground.refused_by(takeoff, landing) {
                    Some(limit) => gap.refusals.count(limit),
                    None if ground.sight(takeoff, landing).is_none() => gap.vertical += 1,
                    None => gap.free += 1,
                }
            }
        }
        Ok(gap)
    }
}

/// The gap between the contacts reached from a start and those from which a goal can be reached, over the same roadmap.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadmapGap {
    /// The reached contact nearest to the goal, by the straight line.
    pub nearest_m: Point3<f64>,
    /// How many contacts are reached, the start included.
    pub reached: usize,
    /// The contact nearest to the start from which the goal can be reached.
    pub leads_from_m: Point3<f64>,
    /// How many contacts lead to the goal, itself included.
    pub leading: usize,
    /// The least straight distance from a reached contact to one that leads to the goal, among the pairs; `None` without pairs.
    pub width_m: Option<f64>,
    /// How many pairs of a reached contact and one that leads to the goal the greatest speeds may span.
    pub pairs: u64,
    /// Of how many of them the hop was judged: evenly of all, at most [`JUDGED_MAX`](Self::JUDGED_MAX).
    pub judged: u64,
    /// The limits that refuse the hops that were judged.
    pub refusals: RefusalCounts,
    /// How many of them go straight up, which no hop does.
    pub vertical: u64,
    /// How many of them have a window all the same: a search that samples angles missed them. None in a roadmap of exact windows.
    pub free: u64,
}

impl RoadmapGap {
    /// The most hops that are judged, which takes about a second on a large mesh.
    pub const JUDGED_MAX: u64 = 5_000;
}

/// The numbers of the nodes with a level.
fn numbers(levels: &[Option<u32>]) -> Vec<usize> {
    levels.iter().enumerate().filter(|(_, level)| level.is_some()).map(|(node, _)| node).collect()
}

/// The contacts, arcs and totals of a path.
fn path_of<G: RoadmapGround>(legs: &RoadmapLegs<'_, G>, path: &FoundPath) -> RoadmapPath {
    let landings = path.steps.iter().map(|step| step.to);
    RoadmapPath {
        contacts: std::iter::once(legs.ends().0).chain(landings).collect(),
        moves: path.steps.iter().map(|step| legs.arc(step).map_or(RoadmapMove::Walk, RoadmapMove::Hop)).collect(),
        totals: path.totals,
    }
}
