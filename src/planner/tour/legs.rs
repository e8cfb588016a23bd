//! The legs between all stops over the same nodes.

use rayon::prelude::*;

use super::{
    super::{
        Amount, Budgets, FoundPath, LabelCap, Objective, OutagePart, RouteError, RoutePath, RouteQuestion, SurfaceNode,
        SurfaceNodes,
        by_layers::best_of_fewest,
        fewest_hops::{FewestHops, Within},
        labels::Tracked,
        outage::{Outages, Stretch},
        route_gap::RouteGap,
        search::Run,
        surface_hops::{Side, SurfaceHops},
        surface_legs::{Counted, LegOffers, Settling, SurfaceLegs},
    },
    Tour, TourLeg, TourQuestion, TourWork, VisitOrder, WhyLeftOut,
    arrival::shortest_arrivals,
    table::{LegCosts, VisitRules, most_visits},
    within::{WithinBudgets, best_within},
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
    /// The layers that may be left for a while.
    outages: Outages,
    meter: Meter<'a>,
}

/// A way of a leg.
#[derive(Debug)]
pub(super) struct Way {
    pub(super) path: RoutePath,
    hops: Vec<[SurfaceNode; 2]>,
    /// How it is outside the conditions of the layers that may be left for a while.
    outages: Vec<OutagePart>,
}

/// The ways of one leg.
#[derive(Debug, Default)]
pub(super) struct Ways {
    pub(super) paths: Vec<Way>,
    pairs: u64,
    capped: bool,
}

/// The fewest hops to each stop; `None` of a start that no leg leads to.
pub(super) struct Fields(Vec<Option<FewestHops>>);

impl Fields {
    pub(super) fn to(&self, stop: usize) -> Option<&FewestHops> {
        self.0[stop].as_ref()
    }

    /// Pairs of nodes whose hop was computed.
    fn pairs(&self) -> u64 {
        self.0.iter().flatten().map(|field| field.pairs).sum()
    }
}

/// What the ways of a leg are searched for.
#[derive(Clone, Debug)]
pub(super) struct LegQuestion<'q> {
    pub(super) objective: &'q Objective,
    /// Amounts of which no mission has more on this leg. Where one is another than the first of the objective, the leg has a Pareto set of ways.
    pub(super) budgets: Budgets,
    /// Totals of the objective above which a way is of no use.
    pub(super) at_most: Vec<(Amount, f64)>,
    /// Whether a way counts that is no better by the objective, but less long outside of a layer at an end: what is left of a stretch to the
    /// legs beside it may decide.
    pub(super) by_outages: bool,
}

impl<'q> LegQuestion<'q> {
    /// The best way, whatever it takes.
    pub(super) const fn best(objective: &'q Objective) -> Self {
        Self { objective, budgets: Budgets::NONE, at_most: Vec::new(), by_outages: false }
    }

    /// The same with every way that may be the best beside some other leg.
    pub(super) fn by_outages(self) -> Self {
        Self { by_outages: true, ..self }
    }
}

/// The ways of legs between stops.
#[derive(Debug)]
pub(super) struct Legs {
    targets: usize,
    ways: Vec<([usize; 2], Ways)>,
    /// The longest stretches outside the conditions of layers.
    outages: Vec<Stretch>,
    pub(super) pairs: u64,
    pub(super) capped: bool,
}

impl Legs {
    pub(super) fn ways(&self, between: [usize; 2]) -> Option<&Ways> {
        self.ways.iter().find(|(known, _)| *known == between).map(|(_, ways)| ways)
    }

    /// What all ways take.
    pub(super) fn costs(&self) -> LegCosts {
        let mut costs = LegCosts::none(self.targets).under(self.outages.clone());
        for (pair, ways) in &self.ways {
            costs.set(*pair, ways.paths.iter().map(|way| way.path.totals).collect());
            costs.set_outages(*pair, ways.paths.iter().map(|way| way.outages.clone()).collect());
        }
        costs
    }

    /// The least of an amount that the ways of a leg take; infinite without one.
    pub(super) fn least(&self, amount: Amount) -> impl Fn([usize; 2]) -> f64 + '_ {
        move |pair| {
            let paths = self.ways(pair).into_iter().flat_map(|ways| &ways.paths);
            paths.map(|way| way.path.totals.of(amount)).fold(f64::INFINITY, f64::min)
        }
    }

    /// Adds the ways of the same legs that another search found.
    pub(super) fn join(&mut self, others: Self) {
        for (pair, ways) in others.ways {
            match self.ways.iter_mut().find(|(known, _)| *known == pair) {
                Some((_, known)) => known.paths.extend(ways.paths),
                None => self.ways.push((pair, ways)),
            }
        }
        self.pairs += others.pairs;
        self.capped |= others.capped;
    }

    /// How many legs were searched.
    pub(super) const fn count(&self) -> usize {
        self.ways.len()
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
        let outages = Outages::of(ground, stops[1..].to_vec());
        let stops = stops.iter().map(stop).collect::<Result<_, RouteError>>()?;
        Ok(Self { surface, stops, outages, meter: Meter::new(progress, Stage::Search) })
    }

    pub(super) fn refuse_wrong(&mut self, hops: Vec<[SurfaceNode; 2]>) -> bool {
        self.surface.refuse_wrong(hops)
    }

    pub(super) fn targets(&self) -> usize {
        self.stops.len() - 1
    }

    /// Whether a mission may have a leg.
    fn is_wanted(question: &TourQuestion<'_>, [from, to]: [usize; 2]) -> bool {
        let is_in_order = question.order == VisitOrder::Best || from < to || to == 0;
        from != to && (to > 0 || question.returns) && is_in_order
    }

    /// The fewest hops towards every stop.
    pub(super) fn fields(&self, question: &TourQuestion<'_>) -> Result<Fields, Cancelled> {
        let field = |to: usize| (to > 0 || question.returns).then(|| self.field_to(to)).transpose();
        Ok(Fields((0..self.stops.len()).map(field).collect::<Result<_, _>>()?))
    }

    /// The ways of all legs that a mission may have, each by its own question; those without one are left out.
    pub(super) fn legs<'q>(
        &self,
        question: &TourQuestion<'_>,
        fields: &Fields,
        of_leg: impl Fn([usize; 2]) -> Option<LegQuestion<'q>> + Sync,
    ) -> Result<Legs, Cancelled> {
        let wanted: Vec<[usize; 2]> = self.pairs().filter(|pair| Self::is_wanted(question, *pair)).collect();
        let between = |pair: &[usize; 2]| {
            let asked = fields.to(pair[1]).zip(of_leg(*pair));
            let ways = asked.map(|(field, asked)| self.ways_between(question, *pair, (field, &asked))).transpose()?;
            Ok((*pair, ways.unwrap_or_default()))
        };
        let ways: Vec<([usize; 2], Ways)> = wanted.par_iter().map(between).collect::<Result<_, Cancelled>>()?;
        let pairs = ways.iter().map(|(_, ways)| ways.pairs).sum();
        let capped = ways.iter().any(|(_, ways)| ways.capped);
        Ok(Legs { targets: self.targets(), ways, outages: self.outages.most(), pairs, capped })
    }

    /// All pairs of stops.
    fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        let count = self.stops.len();
        (0..count).flat_map(move |from| (0..count).map(move |to| [from, to]))
    }

    /// Whether an outage may go on through an end of a leg.
    pub(super) fn goes_on_outside(&self, pair: [usize; 2]) -> bool {
        pair.iter().any(|stop| self.is_outside(*stop))
    }

    /// Whether a mission may go on from a stop outside of a layer.
    pub(super) fn have_stops_outside(&self) -> bool {
        (0..self.stops.len()).any(|stop| self.is_outside(stop))
    }

    /// Whether a mission goes on from a stop outside of a layer that may be left for a while.
    fn is_outside(&self, stop: usize) -> bool {
        stop > 0 && self.outages.any_outside(self.stops[stop].1.at)
    }

    /// Whether a path leads from one stop to another over these nodes, whatever it takes.
    fn leads(&self, fields: &Fields, [from, to]: [usize; 2]) -> bool {
        fields.to(to).is_some_and(|field| field.of(self.stops[from].0).is_some())
    }

    fn field_to(&self, to: usize) -> Result<FewestHops, Cancelled> {
        let others: Vec<SurfaceNode> = self.stops.iter().map(|(node, _)| *node).filter(|node| *node != self.stops[to].0).collect();
        let within = Within { line: None, most: u64::MAX, rest: &|_| 0, until: &others };
        FewestHops::from(&self.surface, (Side::Goal, self.stops[to].0), &within, &self.meter)
    }

    /// The best ways from one stop to another.
    fn ways_between(
        &self,
        question: &TourQuestion<'_>,
        [from, to]: [usize; 2],
        (field, asked): (&FewestHops, &LegQuestion<'_>),
    ) -> Result<Ways, Cancelled> {
        let (start, goal) = (self.stops[from].0, self.stops[to]);
        if field.of(start).is_none() {
            return Ok(Ways::default());
        }
        let LegQuestion { objective, budgets, at_most, by_outages } = asked;
        let RouteQuestion { commands, errors, cap, .. } = question.route;
        // A target is left by a hop that follows a landing, and a machine that begins has not landed.
        let settling = if from == 0 { Settling::BeforeAllBut(start) } else { Settling::BeforeAll };
        let by_first = budgets.all().all(|(amount, _)| amount == objective.first());
        // A stretch outside may go on through a stop: what is left of it decides beside the objective.
        let in_outages = !self.outages.are_none();
        let is_one = by_first && !(*by_outages && self.goes_on_outside([from, to]));
        let hops_decide = objective.first() == Amount::Hops && by_first && !in_outages;
        let counted = if hops_decide { Counted::Known } else { Counted::All };
        let offers = LegOffers::new(&self.surface, settling, (commands, question.takeoff), errors);
        let legs = SurfaceLegs::new(offers, (start, goal), (field, counted), &self.meter).under(&self.outages, to == 0);
        let is_alone = objective.amounts().len() == 1 && budgets.are_none() && !hops_decide && !in_outages;
        let of_fewest = if is_alone { self.least_of_fewest((&legs, field), (objective.first(), cap))? } else { None };
        let held = || vec![OutagePart::HELD; self.outages.most().len()];
        let (paths, capped): (Vec<(FoundPath, Vec<OutagePart>)>, bool) = if hops_decide {
            let found = best_of_fewest(&legs, field, (objective, cap), &self.meter)?;
            (found.path.into_iter().map(|path| (path, held())).collect(), found.capped)
        } else if let Some((path, total)) = of_fewest.as_ref().map(|path| (path, path.totals.of(objective.first())))
            && total <= legs.least_in_more_hops(from == 0).of(objective.first())
        {
            (vec![(path.clone(), held())], false)
        } else {
            let known = of_fewest.map(|path| (objective.first(), path.totals.of(objective.first())));
            let bounds = at_most.iter().copied().chain(known);
            let begins = if from == 0 { OutagePart::HELD } else { OutagePart::OPEN };
            let tracked = Tracked::new(objective, budgets).under(self.outages.most(), begins);
            let tracked = if is_one || !self.is_outside(to) {
                tracked
            } else {
                let (ends, pairs) = shortest_arrivals(&legs.offers, (start, goal.0), &self.outages, &self.meter)?;
                legs.count(pairs);
                tracked.ending_with(ends)
            };
            let tracked = bounds.fold(tracked, |tracked, (amount, most)| tracked.at_most(amount, most));
            let mut run = Run::new(&legs, legs.ends(), tracked, cap);
            let best = run.until(is_one)?;
            let labels = if is_one { best.into_iter().collect() } else { run.at_goal() };
            let outages = |label: u32| (0..held().len()).map(|layer| run.labels.outage(label, layer)).collect();
            let paths = labels.into_iter().map(|label| Ok((run.path(label)?, outages(label)))).collect::<Result<_, Cancelled>>()?;
            (paths, run.labels.capped)
        };
        let way = |(path, outages): (FoundPath, Vec<OutagePart>)| Way {
            hops: SurfaceLegs::hops_of(&path).collect(),
            path: legs.route_path(&path, question.effort),
            outages,
        };
        Ok(Ways { paths: paths.into_iter().map(way).collect(), pairs: legs.pairs(), capped })
    }

    /// The path that takes the least of an amount of those of the fewest hops. Where every hop waits for long it takes the least of all paths, and
    /// else no path that takes more is of use.
    fn least_of_fewest(
        &self,
        (legs, field): (&SurfaceLegs<'_>, &FewestHops),
        (amount, cap): (Amount, LabelCap),
    ) -> Result<Option<FoundPath>, Cancelled> {
        let Some(objective) = Objective::new(vec![Amount::Hops, amount]).ok().filter(|_| amount.adds_up()) else { return Ok(None) };
        Ok(best_of_fewest(legs, field, (&objective, cap), &self.meter)?.path)
    }

    /// The mission over these stops, and the hops that it depends on.
    pub(super) fn best(&self, question: &TourQuestion<'_>) -> Result<(Tour, Vec<[SurfaceNode; 2]>), RouteError> {
        let fields = self.fields(question)?;
        let found = best_within(self, question, &fields)?;
        let mut hops = Vec::new();
        let mut legs = Vec::new();
        for (ends, way) in found.visits.stops.windows(2).zip(&found.visits.ways) {
            let way = found.legs.ways([ends[0], ends[1]]).and_then(|ways| ways.paths.get(*way));
            let Some(Way { path, hops: of_path, .. }) = way else { continue };
            hops.extend(of_path);
            legs.push(TourLeg { from: ends[0], to: ends[1], path: path.clone() });
        }
        let mut tour = Tour {
            legs,
            totals: found.visits.totals,
            left_out: Vec::new(),
            capped: found.capped,
            work: TourWork { pairs_tested: fields.pairs() + found.legs.pairs, legs_searched: found.legs.count() },
        };
        self.explain(&fields, &found, question, &mut tour)?;
        Ok((tour, hops))
    }

    /// Says of every target that is not visited why.
    fn explain(
        &self,
        fields: &Fields,
        found: &WithinBudgets,
        question: &TourQuestion<'_>,
        tour: &mut Tour,
    ) -> Result<(), RouteError> {
        let set = found.visits.set();
        let left_out: Vec<usize> = (1..=self.targets()).filter(|target| set & (1 << (target - 1)) == 0).collect();
        let mut reached = None;
        for target in left_out {
            let why = if !self.leads(fields, [0, target]) {
                let from_start = match &reached {
                    Some(known) => known,
                    None => reached.insert(self.reached_from_start()?),
                };
                tour.work.pairs_tested += from_start.pairs;
                self.gap_to(target, fields, from_start)?
            } else if question.returns && !self.leads(fields, [target, 0]) {
                WhyLeftOut::NoWayBack
            } else if !self.is_possible(fields, question, set | (1 << (target - 1)))? {
                WhyLeftOut::NotTogether
            } else {
                Self::limits(&found.best, question, set | (1 << (target - 1)))?
            };
            tour.left_out.push((target, why));
        }
        Ok(())
    }

    fn reached_from_start(&self) -> Result<FewestHops, Cancelled> {
        let all = Within { line: None, most: u64::MAX, rest: &|_| 0, until: &[] };
        FewestHops::from(&self.surface, (Side::Start, self.stops[0].0), &all, &self.meter)
    }

    /// What lies between the start and a target that it does not reach. The field of such a target has all nodes that lead to it.
    fn gap_to(&self, target: usize, fields: &Fields, reached: &FewestHops) -> Result<WhyLeftOut, RouteError> {
        let (start, goal) = (self.stops[0].1, self.stops[target].1);
        let Some(leading) = fields.to(target) else { return Ok(WhyLeftOut::NotTogether) };
        let leads_from = leading.nearest(&self.surface, &start).unwrap_or(goal);
        let gap = RouteGap::between(&self.surface, (reached, leading), leads_from, &self.meter)?;
        let nearest = reached.nearest(&self.surface, &goal).unwrap_or(start);
        Ok(WhyLeftOut::NotReached { reached: reached.known, nearest, gap: Box::new(gap) })
    }

    /// Whether some order of legs visits all targets of a set, whatever it takes.
    fn is_possible(&self, fields: &Fields, question: &TourQuestion<'_>, set: u16) -> Result<bool, Cancelled> {
        let mut costs = LegCosts::none(self.targets());
        for pair in self.pairs().filter(|pair| Self::is_wanted(question, *pair) && self.leads(fields, *pair)) {
            costs.set(pair, vec![super::Amounts::NONE]);
        }
        let rules = VisitRules { order: question.order, returns: question.returns, allowed: set };
        let RouteQuestion { objective, cap, .. } = question.route;
        Ok(most_visits(&costs, rules, (objective, &Budgets::NONE, cap))?.0.set() == set)
    }

    /// Whether outages alone exclude all missions over a set of targets, or by how much the best one exceeds the budgets.
    fn limits(best: &LegCosts, question: &TourQuestion<'_>, set: u16) -> Result<WhyLeftOut, Cancelled> {
        let RouteQuestion { objective, budgets, cap, .. } = question.route;
        let rules = VisitRules { order: question.order, returns: question.returns, allowed: set };
        let (visits, _) = most_visits(best, rules, (objective, &Budgets::NONE, cap))?;
        Ok(if visits.set() == set {
            WhyLeftOut::Budgets(budgets.exceeded_by(&visits.totals).collect())
        } else {
            WhyLeftOut::Outages
        })
    }
}
