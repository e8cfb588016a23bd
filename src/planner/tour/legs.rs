//! The legs between all stops over the same nodes.

use rayon::prelude::*;

use super::{
    super::{
        Amount, Budgets, FoundPath, OverBudget, RouteError, RoutePath, RouteQuestion, SurfaceNode, SurfaceNodes,
        by_layers::best_of_fewest,
        fewest_hops::{FewestHops, Within},
        labels::Tracked,
        route_gap::RouteGap,
        search::Run,
        surface_hops::{Side, SurfaceHops},
        surface_legs::{Counted, LegOffers, Settling, SurfaceLegs},
    },
    Tour, TourLeg, TourQuestion, TourWork, VisitOrder, WhyLeftOut,
    table::{LegCosts, VisitRules, Visits, most_visits},
};
use crate::{
    ground::{DemGround, MapPosition},
    progress::{Cancelled, Meter, Progress, Stage},
    quantity::MapPoint,
};

/// The stops over a ground.
pub(super) struct StopLegs<'a> {
    surface: SurfaceHops<'a>,
    stops: Vec<(SurfaceNode, MapPosition)>,
    meter: Meter<'a>,
}

/// The ways of one leg, and the hops of each.
#[derive(Debug, Default)]
struct Ways {
    paths: Vec<(RoutePath, Vec<[SurfaceNode; 2]>)>,
    pairs: u64,
    capped: bool,
}

/// The legs between all stops.
pub(super) struct AllLegs {
    /// The fewest hops to each stop; `None` of a start that no leg leads to.
    fields: Vec<Option<FewestHops>>,
    ways: Vec<([usize; 2], Ways)>,
    costs: LegCosts,
    pairs: u64,
    capped: bool,
}

impl AllLegs {
    /// Whether a path leads from one stop to another over these nodes, whatever it takes.
    fn leads(&self, stops: &[(SurfaceNode, MapPosition)], [from, to]: [usize; 2]) -> bool {
        self.fields[to].as_ref().is_some_and(|field| field.of(stops[from].0).is_some())
    }

    fn ways(&self, between: [usize; 2]) -> Option<&Ways> {
        self.ways.iter().find(|(known, _)| *known == between).map(|(_, ways)| ways)
    }
}

impl<'a> StopLegs<'a> {
    pub(super) fn new(
        ground: &'a DemGround,
        nodes: &'a SurfaceNodes,
        stops: &[MapPoint],
        progress: &'a dyn Progress,
    ) -> Result<Self, RouteError> {
        let surface = SurfaceHops::new(ground, nodes);
        let stop = |at: &MapPoint| {
            let node = nodes.place(*at).ok_or(RouteError::NoGround(*at))?;
            Ok((node, surface.position(node).ok_or(RouteError::NoGround(*at))?))
        };
        let stops = stops.iter().map(stop).collect::<Result<_, RouteError>>()?;
        Ok(Self { surface, stops, meter: Meter::new(progress, Stage::Search) })
    }

    pub(super) fn refuse_wrong(&mut self, hops: Vec<[SurfaceNode; 2]>) -> bool {
        self.surface.refuse_wrong(hops)
    }

    fn targets(&self) -> usize {
        self.stops.len() - 1
    }

    /// Whether a mission may have a leg.
    fn is_wanted(question: &TourQuestion<'_>, [from, to]: [usize; 2]) -> bool {
        let is_in_order = question.order == VisitOrder::Best || from < to || to == 0;
        from != to && (to > 0 || question.returns) && is_in_order
    }

    /// The field towards every stop, and what all legs take.
    pub(super) fn all(&self, question: &TourQuestion<'_>) -> Result<AllLegs, RouteError> {
        let count = self.stops.len();
        let mut fields = Vec::with_capacity(count);
        for to in 0..count {
            let is_goal = to > 0 || question.returns;
            fields.push(is_goal.then(|| self.field_to(to)).transpose()?);
        }
        let pairs = (0..count).flat_map(|from| (0..count).map(move |to| [from, to]));
        let wanted: Vec<[usize; 2]> = pairs.filter(|pair| Self::is_wanted(question, *pair)).collect();
        let between = |pair: &[usize; 2]| {
            let field = fields[pair[1]].as_ref();
            let ways = field.map(|field| self.ways_between(question, *pair, field)).transpose()?;
            Ok((*pair, ways.unwrap_or_default()))
        };
        let ways: Vec<([usize; 2], Ways)> = wanted.par_iter().map(between).collect::<Result<_, Cancelled>>()?;
        let mut costs = LegCosts::none(self.targets());
        for (pair, ways) in &ways {
            costs.set(*pair, ways.paths.iter().map(|(path, _)| path.totals).collect());
        }
        let of_fields: u64 = fields.iter().flatten().map(|field| field.pairs).sum();
        let pairs = of_fields + ways.iter().map(|(_, ways)| ways.pairs).sum::<u64>();
        let capped = ways.iter().any(|(_, ways)| ways.capped);
        Ok(AllLegs { fields, ways, costs, pairs, capped })
    }

    fn field_to(&self, to: usize) -> Result<FewestHops, Cancelled> {
        let others: Vec<SurfaceNode> = self.stops.iter().map(|(node, _)| *node).filter(|node| *node != self.stops[to].0).collect();
        let within = Within { line: None, most: u64::MAX, rest: &|_| 0, until: &others };
        FewestHops::from(&self.surface, (Side::Goal, self.stops[to].0), &within, &self.meter)
    }

    /// The best ways from one stop to another: one, or a Pareto set where another amount than that of the objective has a budget.
    fn ways_between(&self, question: &TourQuestion<'_>, [from, to]: [usize; 2], field: &FewestHops) -> Result<Ways, Cancelled> {
        let (start, goal) = (self.stops[from].0, self.stops[to]);
        if field.of(start).is_none() {
            return Ok(Ways::default());
        }
        let RouteQuestion { objective, budgets, commands, errors, cap } = question.route;
        // A target is left by a hop that follows a landing, and a machine that begins has not landed.
        let settling = if from == 0 { Settling::BeforeAllBut(start) } else { Settling::BeforeAll };
        let others: Vec<Amount> = budgets.all().map(|(amount, _)| amount).filter(|amount| *amount != objective.first()).collect();
        let hops_decide = objective.first() == Amount::Hops && others.is_empty();
        let counted = if hops_decide { Counted::Known } else { Counted::All };
        let offers = LegOffers::new(&self.surface, settling, (commands, question.takeoff), errors);
        let legs = SurfaceLegs::new(offers, (start, goal), (field, counted), &self.meter);
        let (paths, capped): (Vec<FoundPath>, bool) = if hops_decide {
            let found = best_of_fewest(&legs, field, (objective, cap), &self.meter)?;
            (found.path.into_iter().collect(), found.capped)
        } else {
            let mut run = Run::new(&legs, legs.ends(), Tracked::new(objective, budgets), cap);
            let best = run.until(others.is_empty())?;
            let labels = if others.is_empty() { best.into_iter().collect() } else { run.at_goal() };
            let paths = labels.into_iter().map(|label| run.path(label)).collect::<Result<_, _>>()?;
            (paths, run.labels.capped)
        };
        let way = |path: &FoundPath| (legs.route_path(path, question.effort), SurfaceLegs::hops_of(path).collect());
        Ok(Ways { paths: paths.iter().map(way).collect(), pairs: legs.pairs(), capped })
    }

    /// The mission over these legs, and the hops that it depends on.
    pub(super) fn best(&self, all: &AllLegs, question: &TourQuestion<'_>) -> Result<(Tour, Vec<[SurfaceNode; 2]>), RouteError> {
        let RouteQuestion { objective, budgets, cap, .. } = question.route;
        let rules = VisitRules { order: question.order, returns: question.returns, allowed: u16::MAX };
        let (visits, capped) = most_visits(&all.costs, rules, (objective, budgets, cap))?;
        let mut hops = Vec::new();
        let mut legs = Vec::new();
        for (ends, way) in visits.stops.windows(2).zip(&visits.ways) {
            let Some((path, of_path)) = all.ways([ends[0], ends[1]]).and_then(|ways| ways.paths.get(*way)) else { continue };
            hops.extend(of_path);
            legs.push(TourLeg { from: ends[0], to: ends[1], path: path.clone() });
        }
        let mut tour = Tour {
            legs,
            totals: visits.totals,
            left_out: Vec::new(),
            capped: capped || all.capped,
            work: TourWork { pairs_tested: all.pairs, legs_searched: all.ways.len() },
        };
        self.explain((all, &visits), question, &mut tour)?;
        Ok((tour, hops))
    }

    /// Says of every target that is not visited why.
    fn explain(&self, (all, visits): (&AllLegs, &Visits), question: &TourQuestion<'_>, tour: &mut Tour) -> Result<(), RouteError> {
        let set = visits.set();
        let left_out: Vec<usize> = (1..=self.targets()).filter(|target| set & (1 << (target - 1)) == 0).collect();
        let mut without_budgets: Option<AllLegs> = None;
        let mut reached = None;
        for target in left_out {
            let why = if !all.leads(&self.stops, [0, target]) {
                let from_start = match &reached {
                    Some(known) => known,
                    None => reached.insert(self.reached_from_start()?),
                };
                tour.work.pairs_tested += from_start.pairs;
                self.gap_to(target, all, from_start)?
            } else if question.returns && !all.leads(&self.stops, [target, 0]) {
                WhyLeftOut::NoWayBack
            } else if !self.is_possible(all, question, set | (1 << (target - 1)))? {
                WhyLeftOut::NotTogether
            } else {
                let free =
                    match &without_budgets {
                        Some(known) => known,
                        None => without_budgets.insert(self.all(&TourQuestion {
                            route: RouteQuestion { budgets: &Budgets::NONE, ..question.route },
                            ..*question
                        })?),
                    };
                WhyLeftOut::Budgets(Self::over_budgets(free, question, set | (1 << (target - 1)))?)
            };
            tour.left_out.push((target, why));
        }
        tour.work.pairs_tested += without_budgets.map_or(0, |free| free.pairs);
        Ok(())
    }

    fn reached_from_start(&self) -> Result<FewestHops, Cancelled> {
        let all = Within { line: None, most: u64::MAX, rest: &|_| 0, until: &[] };
        FewestHops::from(&self.surface, (Side::Start, self.stops[0].0), &all, &self.meter)
    }

    /// What lies between the start and a target that it does not reach. The field of such a target has all nodes that lead to it.
    fn gap_to(&self, target: usize, all: &AllLegs, reached: &FewestHops) -> Result<WhyLeftOut, RouteError> {
        let (start, goal) = (self.stops[0].1, self.stops[target].1);
        let Some(leading) = &all.fields[target] else { return Ok(WhyLeftOut::NotTogether) };
        let leads_from = leading.nearest(&self.surface, &start).unwrap_or(goal);
        let gap = RouteGap::between(&self.surface, (reached, leading), leads_from, &self.meter)?;
        let nearest = reached.nearest(&self.surface, &goal).unwrap_or(start);
        Ok(WhyLeftOut::NotReached { reached: reached.known, nearest, gap: Box::new(gap) })
    }

    /// Whether some order of legs visits all targets of a set, whatever it takes.
    fn is_possible(&self, all: &AllLegs, question: &TourQuestion<'_>, set: u16) -> Result<bool, Cancelled> {
        let mut costs = LegCosts::none(self.targets());
        let pairs = (0..self.stops.len()).flat_map(|from| (0..self.stops.len()).map(move |to| [from, to]));
        for pair in pairs.filter(|pair| Self::is_wanted(question, *pair) && all.leads(&self.stops, *pair)) {
            costs.set(pair, vec![super::Amounts::NONE]);
        }
        let rules = VisitRules { order: question.order, returns: question.returns, allowed: set };
        let RouteQuestion { objective, cap, .. } = question.route;
        Ok(most_visits(&costs, rules, (objective, &Budgets::NONE, cap))?.0.set() == set)
    }

    /// By how much the best mission over a set of targets exceeds the budgets.
    fn over_budgets(free: &AllLegs, question: &TourQuestion<'_>, set: u16) -> Result<Vec<OverBudget>, Cancelled> {
        let RouteQuestion { objective, budgets, cap, .. } = question.route;
        let rules = VisitRules { order: question.order, returns: question.returns, allowed: set };
        let (visits, _) = most_visits(&free.costs, rules, (objective, &Budgets::NONE, cap))?;
        Ok(budgets.exceeded_by(&visits.totals).collect())
    }
}
