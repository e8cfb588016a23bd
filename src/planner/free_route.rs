//! The best path from a start to a goal over nodes on a DEM, found towards the goal.
//!
//! First the fewest hops of nodes to the goal, level by level ([`FewestHops`]): no path needs fewer, which is a bound for the search by the
//! objective ([`search`]). Where hops come first, paths of the fewest hops are compared layer by layer instead ([`best_of_fewest`]).

use super::{
    Amount, Amounts, Budgets, LabelCap, Objective, OutagePart, SearchedCommands, SurfaceNode, SurfaceNodes, TooManyNodes,
    UnmetBudget,
    by_layers::best_of_fewest,
    fewest_hops::{FewestHops, Within},
    front,
    labels::Tracked,
    outage::Outages,
    route_gap::RouteGap,
    search::{search_tracked, without_budgets},
    surface_hops::{Side, SurfaceHops},
    surface_legs::{Counted, LegOffers, Settling, SurfaceLegs},
};
use crate::{
    ballistics::{PathBounds, TakeoffChoice},
    flight::Uncertainty,
    graph::{Cost, Effort},
    ground::{DemGround, MapPosition, Surface},
    progress::{Cancelled, Meter, Progress, Stage},
    quantity::MapPoint,
};

/// What a route is for: its ends, and how its hops are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RouteGoal {
    /// Where it begins: a single place of the nodes.
    pub start: MapPoint,
    /// Where it ends: a single place of the nodes.
    pub goal: MapPoint,
    /// The effort of its cost.
    pub effort: Effort,
    /// Which of the feasible take-off angles each hop has, where an edge offers no others.
    pub takeoff: TakeoffChoice,
}

/// What a route is searched for.
#[derive(Clone, Copy, Debug)]
pub struct RouteQuestion<'a> {
    /// What is to be least.
    pub objective: &'a Objective,
    /// The greatest totals.
    pub budgets: &'a Budgets,
    /// The commands of an edge.
    pub commands: SearchedCommands,
    /// The errors by which risk is judged, and the ground over which they are flown; needed where the objective is about risk.
    pub errors: Option<(&'a Uncertainty, &'a DemGround)>,
    /// How many labels are kept.
    pub cap: LabelCap,
}

/// Why there is no answer.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RouteError {
    /// More nodes than fit.
    #[error(transparent)]
    Nodes(#[from] TooManyNodes),
    /// A start or goal without ground.
    #[error("there is no ground at ({} m, {} m), expected a start and a goal with an elevation", .0.x, .0.y)]
    NoGround(MapPoint),
    /// It was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A path over a DEM.
#[derive(Clone, Debug, PartialEq)]
pub struct RoutePath {
    /// The places from start to goal, one hop from each to the next.
    pub places: Vec<MapPosition>,
    /// The choice of take-off angle of each hop.
    pub choices: Vec<TakeoffChoice>,
    /// Its hops, and its effort.
    pub cost: Cost,
    /// What it takes.
    pub totals: Amounts,
}

/// The work of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RouteWork {
    /// Pairs of nodes whose hop was computed.
    pub pairs_tested: u64,
    /// Nodes with known fewest hops to the goal.
    pub leading: usize,
    /// Nodes that the search by the objective reached, the start included; without a path all that the start reaches.
    pub reached: usize,
    /// Labels whose legs were visited.
    pub settled: usize,
}

/// The result of a search, and its work.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeRoute {
    /// The best path within the budgets and the outages of layers, or the best without them, if no path keeps them; `None` if the goal was not
    /// reached over these nodes.
    pub path: Option<RoutePath>,
    /// Whether it keeps the budgets and the outages.
    pub within: bool,
    /// If not: those that it exceeds. If the least of each is within it, no path keeps all of them at once.
    pub unmet: Vec<UnmetBudget>,
    /// Whether labels were left out: the path may then not be the best, and that none keeps the budgets is not certain.
    pub capped: bool,
    /// The reached place nearest to the goal, horizontally.
    pub nearest: MapPosition,
    /// Without a path: what lies between the places reached and those that lead to the goal.
    pub gap: Option<RouteGap>,
    /// The work.
    pub work: RouteWork,
}

/// Finds the path of fewest hops from a start to a goal over nodes on a DEM, then of least effort: as [`free_route_by`] with one command a
/// hop and no budgets.
///
/// # Errors
/// [`RouteError`].
pub fn free_route(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    goal: &RouteGoal,
    progress: &dyn Progress,
) -> Result<FreeRoute, RouteError> {
    let objective = Objective::hops_then(goal.effort);
    let question = RouteQuestion {
        objective: &objective,
        budgets: &Budgets::NONE,
        commands: SearchedCommands::Chosen,
        errors: None,
        cap: LabelCap::default(),
    };
    free_route_by(ground, nodes, goal, &question, progress)
}

/// Finds the best path from a start to a goal over nodes on a DEM by an objective, within budgets.
///
/// The machine is taken to fly any command up to its greatest. Of equal paths it returns one; which depends on the question alone. Risk is an
/// estimate in closed form, as on maps.
///
/// # Errors
/// [`RouteError`].
///
/// # Complexity
/// [`bytes`](FreeRoute::bytes) for the nodes, and some 60 for each label. Where hops come first and no other amount has a budget, only nodes on
/// paths of the fewest hops are expanded.
pub fn free_route_by(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    goal: &RouteGoal,
    question: &RouteQuestion<'_>,
    progress: &dyn Progress,
) -> Result<FreeRoute, RouteError> {
    let mut asked = Asked::new(ground, nodes, goal, progress)?;
    loop {
        // A path that keeps out of the shade may need any number of hops.
        let whole = (!asked.outages.are_none()).then_some(u64::MAX);
        let levels = asked.hops_left(hops_within(question.budgets).or(whole))?;
        let Some(fewest) = levels.of(asked.start.0) else { return asked.not_found(&levels) };
        let (route, hops) = asked.found(&levels, fewest, question)?;
        // The fast walk equals the slice up to rounding: a hop on the very edge of a limit may be one for the walk alone.
        if !asked.surface.refuse_wrong(hops) {
            return Ok(route);
        }
    }
}

/// A front of routes.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteFront {
    /// The paths in ascending order of hops; none if the goal was not reached.
    pub paths: Vec<RoutePath>,
    /// The greatest number of hops that was allowed.
    pub hops_max: u64,
    /// Whether labels were left out.
    pub capped: bool,
}

/// The Pareto front of hops against another amount over nodes on a DEM, within budgets. `hops_max`: how many hops count, given the fewest.
///
/// # Errors
/// [`RouteError`].
pub fn front_of_routes(
    ground: &DemGround,
    nodes: &SurfaceNodes,
    goal: &RouteGoal,
    (amount, question, hops_max): (Amount, &RouteQuestion<'_>, &dyn Fn(u64) -> u64),
    progress: &dyn Progress,
) -> Result<RouteFront, RouteError> {
    let mut asked = Asked::new(ground, nodes, goal, progress)?;
    loop {
        let Some(fewest) = asked.hops_left(None)?.of(asked.start.0) else {
            return Ok(RouteFront { paths: Vec::new(), hops_max: 0, capped: false });
        };
        let hops_max = hops_max(u64::from(fewest));
        let levels = asked.hops_left(Some(hops_max))?;
        #[expect(clippy::cast_precision_loss, reason = "counts of hops stay far below 2^53")]
        let budgets = question.budgets.with(Amount::Hops, hops_max as f64).unwrap_or(*question.budgets);
        let legs = asked.legs((&levels, Counted::Known), question);
        let (found, capped) = front(&legs, legs.ends(), (Amount::Hops, amount), &budgets, question.cap)?;
        let paths = found.iter().map(|path| legs.route_path(path, asked.how.effort)).collect();
        let hops: Vec<_> = found.iter().flat_map(SurfaceLegs::hops_of).collect();
        drop(legs);
        if !asked.surface.refuse_wrong(hops) {
            return Ok(RouteFront { paths, hops_max, capped });
        }
    }
}

impl FreeRoute {
    /// The bytes that the nodes of a search take: the fewest hops, and the label; without a path those of both directions.
    pub const fn bytes(nodes: &SurfaceNodes) -> u64 {
        8 * nodes.count() as u64
    }

    /// The same with what one level of the search for the fewest hops takes at most: all nodes as those of the level before, as those that it
    /// asks, and with what each of them answers; and the steps within reach of a node.
    pub fn bytes_max(ground: &DemGround, nodes: &SurfaceNodes) -> u64 {
        let of_level = (2 * size_of::<SurfaceNode>() + size_of::<(bool, u64)>()) as u64;
        Self::bytes(nodes) + of_level * nodes.count() as u64 + SurfaceHops::bytes(ground, nodes)
    }
}

/// The hops over the nodes, and the ends of a question.
struct Asked<'a> {
    surface: SurfaceHops<'a>,
    start: (SurfaceNode, MapPosition),
    goal: (SurfaceNode, MapPosition),
    how: &'a RouteGoal,
    bounds: PathBounds,
    /// The layers that may be left for a while.
    outages: Outages,
    meter: Meter<'a>,
    /// Pairs of the searches before.
    pairs: u64,
}

impl<'a> Asked<'a> {
    fn new(
        ground: &'a DemGround,
        nodes: &'a SurfaceNodes,
        how: &'a RouteGoal,
        progress: &'a dyn Progress,
    ) -> Result<Self, RouteError> {
        let surface = SurfaceHops::new(ground, nodes);
        let node = |at: MapPoint| {
            let node = nodes.place(at).ok_or(RouteError::NoGround(at))?;
            Ok::<_, RouteError>((node, surface.position(node).ok_or(RouteError::NoGround(at))?))
        };
        let (start, goal) = (node(how.start)?, node(how.goal)?);
        let limits = ground.hopper().limits();
        let bounds = PathBounds::new(limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s(), ground.gravity_m_s2());
        let outages = Outages::of(ground, vec![how.goal]);
        Ok(Self { surface, start, goal, how, bounds, outages, meter: Meter::new(progress, Stage::Search), pairs: 0 })
    }

    /// The fewest hops to the goal of all nodes on paths of at most so many hops; without a number, of the fewest that there are.
    ///
    /// A path near the straight line says how many hops are enough, beyond which no node counts; where none is near, farther nodes do.
    fn hops_left(&mut self, most: Option<u64>) -> Result<FewestHops, RouteError> {
        /// Half of the widths of the first corridors, in longest hops over level ground.
        const HALF_WIDTHS: [f64; 2] = [1.5, 6.0];
        let (bounds, start) = (self.bounds, self.start);
        let rest = |at: &MapPosition| {
            let run_m = libm::hypot(at.at.x - start.1.at.x, at.at.y - start.1.at.y);
            bounds.hops(run_m, at.z_m - start.1.z_m).unwrap_or(u64::MAX)
        };
        let ends = [start.1.at, self.goal.1.at];
        let at_start = [start.0];
        let whole = Within { line: None, most: u64::MAX, rest: &rest, until: &at_start };
        let mut enough = None;
        for half_width in HALF_WIDTHS {
            let line = Some((ends, half_width * self.surface.level_m()));
            let found = FewestHops::from(&self.surface, (Side::Goal, self.goal.0), &Within { line, ..whole }, &self.meter)?;
            self.pairs += found.pairs;
            enough = found.of(start.0).map(u64::from);
            if enough.is_some() {
                break;
            }
        }
        let until: &[SurfaceNode] = if most.is_some() { &[] } else { &at_start };
        let within = Within { most: enough.map_or(u64::MAX, |enough| enough.max(most.unwrap_or(0))), until, ..whole };
        let found = FewestHops::from(&self.surface, (Side::Goal, self.goal.0), &within, &self.meter)?;
        self.pairs += found.pairs;
        Ok(found)
    }

    fn legs<'l>(&'l self, (levels, counted): (&'l FewestHops, Counted), question: &RouteQuestion<'_>) -> SurfaceLegs<'l> {
        let offered = (question.commands, self.how.takeoff);
        let settling = Settling::BeforeAllBut(self.start.0);
        let hops = LegOffers::new(&self.surface, settling, offered, question.errors);
        SurfaceLegs::new(hops, (self.start.0, self.goal), (levels, counted), &self.meter)
    }

    /// The answer where a path of so many hops exists, and the hops that it depends on.
    fn found(
        &self,
        levels: &FewestHops,
        fewest: u32,
        question: &RouteQuestion<'_>,
    ) -> Result<(FreeRoute, Vec<[SurfaceNode; 2]>), RouteError> {
        let RouteQuestion { objective, budgets, cap, .. } = *question;
        let most = hops_within(budgets);
        let allows_fewest = most.is_none_or(|most| most >= u64::from(fewest));
        let in_outages = !self.outages.are_none();
        let of_hops = objective.first() == Amount::Hops && budgets.all().all(|(amount, _)| amount == Amount::Hops);
        let hops_decide = of_hops && !in_outages;
        let (mut work, mut capped) = (RouteWork { pairs_tested: self.pairs, leading: levels.known, ..RouteWork::default() }, false);
        let mut best = None;
        if allows_fewest {
            let counted = if hops_decide || in_outages || most.is_some() { Counted::Known } else { Counted::All };
            let legs = self.legs((levels, counted), question).under(&self.outages, true);
            let result = if hops_decide {
                best_of_fewest(&legs, levels, (objective, cap), &self.meter)?
            } else {
                let tracked = Tracked::new(objective, budgets).under(self.outages.most(), OutagePart::HELD);
                search_tracked(&legs, legs.ends(), tracked, cap)?
            };
            (work.reached, work.settled, capped) = (result.reached, result.settled, result.capped);
            work.pairs_tested += legs.pairs();
            best = result.path.map(|path| (legs.route_path(&path, self.how.effort), path, Vec::new()));
        }
        let mut within = best.is_some();
        if !within {
            let legs = self.legs((levels, Counted::All), question);
            let found = without_budgets(&legs, legs.ends(), objective, budgets, cap)?;
            work.pairs_tested += legs.pairs();
            if let Some(found) = found {
                within = found.within && !in_outages;
                capped |= found.capped;
                (work.reached, work.settled) = found.work;
                best = Some((legs.route_path(&found.path, self.how.effort), found.path, found.unmet));
            }
        }
        let (path, hops, unmet) = match best {
            Some((path, found, unmet)) => (Some(path), SurfaceLegs::hops_of(&found).collect(), unmet),
            None => (None, Vec::new(), Vec::new()),
        };
        Ok((FreeRoute { path, within, unmet, capped, nearest: self.goal.1, gap: None, work }, hops))
    }

    /// The answer without a path, where all nodes that lead to the goal are known.
    fn not_found(&mut self, leading: &FewestHops) -> Result<FreeRoute, RouteError> {
        let all = Within { line: None, most: u64::MAX, rest: &|_| 0, until: &[] };
        let reached = FewestHops::from(&self.surface, (Side::Start, self.start.0), &all, &self.meter)?;
        self.pairs += reached.pairs;
        let gap = RouteGap::between(
            &self.surface,
            (&reached, leading),
            leading.nearest(&self.surface, &self.start.1).unwrap_or(self.goal.1),
            &self.meter,
        )?;
        let work = RouteWork { pairs_tested: self.pairs, leading: leading.known, reached: reached.known, settled: 0 };
        Ok(FreeRoute {
            path: None,
            within: false,
            unmet: Vec::new(),
            capped: false,
            nearest: reached.nearest(&self.surface, &self.goal.1).unwrap_or(self.start.1),
            gap: Some(gap),
            work,
        })
    }
}

/// The greatest number of hops that budgets allow; `None` if any.
fn hops_within(budgets: &Budgets) -> Option<u64> {
    let most = budgets.allowed(Amount::Hops);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative; the cast saturates")]
    most.is_finite().then_some(most as u64)
}
