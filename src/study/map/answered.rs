//! The search, the paths and their check, the trials, and the answer that they make.

use super::{
    super::Defect,
    MapQuestion, MapStudyError, PreparedMap, RefusedNodes, Spot,
    aim::{Aim, allowed},
    flown::FlownPath,
    refused::refused_nodes,
};
use crate::{
    ballistics::PathBounds,
    ground::Surface,
    path::{Hop, HopPath},
    planner::{Amount, TotalBudget},
    progress::Progress,
    quantity::total,
    reach::map::{
        HopMap, Journey, MapHop, MapObjective, Mobility, Post, PostHops, Search, Source, joined, least_totals, mobility, search,
        totals_along, verify,
    },
    report::{
        AmountRecord, DeratingRecord, GoalRecord, HopRecord, MapAnswer, MapBudgetRecord, MapObjectiveRecord, MapSummary,
        PropellantShortage, TotalsRecord,
    },
    study::{Extremes, TrialGround, constant_gravity_warnings, objective::short_hops, sense::unplanned_bounces},
};

/// What marks a post without a predecessor in [`MapStudy::predecessors`]: it was not reached, or has no elevation.
pub const NO_PREDECESSOR: i32 = i32::MIN;

/// The answer to a question about a map, with the maps and paths that pictures and rasters show.
#[derive(Clone, Debug)]
pub struct MapStudy {
    /// The answer.
    pub answer: MapAnswer,
    /// Warnings about the terrain, the starts and goals, the paths and the trials.
    pub warnings: Vec<String>,
    /// The hops from the nearest start to every post.
    pub out: HopMap,
    /// The hops from every post back to the nearest start, if asked for.
    pub back: Option<HopMap>,
    /// The single hops from every post, if asked for.
    pub mobility: Option<Mobility>,
    /// The nodes that refuse every contact, by reason, if asked for; otherwise empty.
    pub refused: Vec<RefusedNodes>,
    /// For each post, the one that its last hop comes from, as [`HopMap::predecessors`] gives it; [`NO_PREDECESSOR`] without one.
    pub predecessors: Option<Vec<i32>>,
    /// The totals of each amount of the objective at every node, NaN without a path; empty where the map has fewest hops.
    pub least: Vec<(Amount, Vec<f64>)>,
    /// The totals of the amounts that were asked for, along the path to every node.
    pub amounts: Vec<(Amount, Vec<f64>)>,
    /// The hops to each goal, each on its own slice; `None` if it was not reached.
    pub goal_hops: Vec<Option<Vec<MapHop>>>,
    /// The same as paths over the map, which the independent checker has flown.
    pub paths: Vec<Option<HopPath>>,
}

/// What was searched.
struct Found {
    out: HopMap,
    back: Option<HopMap>,
    mobility: Option<Mobility>,
    refused: Vec<RefusedNodes>,
    predecessors: Option<Vec<i32>>,
    least: Vec<(Amount, Vec<f64>)>,
    amounts: Vec<(Amount, Vec<f64>)>,
    goal_hops: Vec<Option<Vec<MapHop>>>,
    paths: Vec<Option<HopPath>>,
    warnings: Vec<String>,
}

/// The greatest of the totals of an amount.
fn greatest(amount: Amount, totals: &[f64]) -> AmountRecord {
    AmountRecord { amount, total: totals.iter().copied().fold(0.0, f64::max) }
}

/// What the map has least; `None` where that is hops.
fn objective_record(question: &MapQuestion<'_>, least: &[(Amount, Vec<f64>)]) -> Result<Option<MapObjectiveRecord>, MapStudyError> {
    let Aim::Least(objective, budget) = question.aim()? else { return Ok(None) };
    Ok(Some(MapObjectiveRecord {
        amounts: objective.amounts().to_vec(),
        greatest: least.iter().map(|(amount, totals)| greatest(*amount, totals)).collect(),
        budget: budget.map(|TotalBudget { amount, key, most }| MapBudgetRecord { amount, key: key.to_owned(), max: most }),
    }))
}

/// What is not by the objective of a map that has one.
fn beside_objective(question: &MapQuestion<'_>, flies: bool) -> Vec<String> {
    let Some(objective) = &question.scenario.objective else { return Vec::new() };
    let back = "the ways back are of fewest hops: neither the objective nor its budget bounds them".to_owned();
    let flown = format!(
        "the paths are by the objective {objective}, not by reliability: they stand on the edge of their limits, and a robot that replans over \
         the map goes on by reliability, or by hops and effort"
    );
    question.returns.then_some(back).into_iter().chain(flies.then_some(flown)).collect()
}

impl PreparedMap {
    /// Answers the question that the map was prepared for.
    ///
    /// # Errors
    /// [`MapStudyError`].
    pub fn answered(&self, question: &MapQuestion<'_>, progress: &dyn Progress) -> Result<MapStudy, MapStudyError> {
        let flown = question.flown_scenario()?;
        let keys = flown.as_ref().map(|(scenario, _)| scenario.uncertainty.clone().unwrap_or_default());
        // Run inside the rayon pool: work started by a pool thread is picked up faster than work submitted from outside.
        let found = rayon::scope(|_| self.found(question, progress))?;
        let Found { out, back, mobility, refused, predecessors, least, amounts, goal_hops, paths, warnings: of_ends } = found;
        let trials = match &keys {
            Some(keys) => self.flown(question, &paths, keys, progress)?,
            None => vec![None; paths.len()],
        };
        let scenario = question.scenario;
        let mut answer = MapAnswer::new(&MapSummary {
            dem: self.dem(),
            lattice: self.lattice,
            starts: self.starts.iter().map(|start| (start.asked, start.post)).collect(),
            out: &out,
            back: back.as_ref(),
            mobility: mobility.as_ref(),
            effort: question.effort.then_some(scenario.search.effort),
            hops_max: match question.aim()? {
                Aim::Hops(most) => most,
                Aim::Least(..) => None,
            },
        });
        answer.objective = objective_record(question, &least)?;
        answer.amounts = amounts.iter().map(|(amount, totals)| greatest(*amount, totals)).collect();
        answer.derating = DeratingRecord::of(&scenario.derating);
        let goals = self.goals.iter().zip(&paths).zip(trials);
        let record = |((goal, path), trials): ((&Spot, &Option<HopPath>), _)| {
            let record = self.goal_record(goal, (&out, back.as_ref()), path.as_ref(), trials);
            let node = self.lattice.index(goal.post);
            let total = |(amount, totals): &(Amount, Vec<f64>)| AmountRecord { amount: *amount, total: totals[node] };
            let totals = least.iter().map(total).filter(|record| !record.total.is_nan()).collect();
            GoalRecord { objective_totals: totals, ..record }
        };
        answer.goals = goals.map(record).collect();
        let mut warnings = self.warnings.clone();
        warnings.extend(beside_objective(question, keys.is_some()));
        if let Some(((scenario, of_errors), keys)) = flown.as_ref().zip(keys.as_ref()) {
            warnings.extend(of_errors.iter().cloned());
            warnings.extend(scenario.trial_warnings(&[keys.policy], &self.trial_ground(&paths)));
        }
        warnings.extend(of_ends);
        if keys.is_some() {
            let unreached = paths.iter().zip(&self.goals).filter(|(path, _)| path.is_none());
            warnings.extend(unreached.map(|(_, goal)| {
                format!(
                    "no trials were flown to the goal ({:.3}, {:.3}) m: it was not reached over these nodes, so there is no path to fly",
                    goal.at.x, goal.at.y
                )
            }));
        }
        let hops: Vec<_> = paths.iter().flatten().flat_map(|path| path.hops.iter().copied()).collect();
        warnings.extend(constant_gravity_warnings(&scenario.body, Extremes::of(&hops)));
        warnings.extend(unplanned_bounces(&hops));
        warnings.extend(self.spanned_nodes(&hops).and_then(|spanned| short_hops(scenario, "hops to the goals", spanned)));
        Ok(MapStudy { answer, warnings, out, back, mobility, refused, predecessors, least, amounts, goal_hops, paths })
    }

    /// Searches, and checks the path to every goal.
    fn found(&self, question: &MapQuestion<'_>, progress: &dyn Progress) -> Result<Found, MapStudyError> {
        let options = &question.scenario.search;
        let hops = PostHops::over(self.planning.clone(), self.lattice)?;
        let sources: Vec<Source> = self.starts.iter().map(|start| start.post.into()).collect();
        let effort = question.effort.then_some((options.effort, options.takeoff));
        let aim = question.aim()?;
        let hops_max = match &aim {
            Aim::Hops(most) => *most,
            Aim::Least(..) => None,
        };
        let asked = |journey, effort| Search { journey, effort, hops_max };
        let objective = MapObjective::new(&hops, &question.scenario.full_objective(), question.scenario.commands, options.takeoff);
        let (out, least) = match &aim {
            Aim::Hops(_) => (search(&hops, &sources, asked(Journey::Outbound, effort), progress)?, Vec::new()),
            Aim::Least(of, budget) => {
                let starts: Vec<Post> = self.starts.iter().map(|start| start.post).collect();
                let found = least_totals(&hops, &starts, &objective, allowed(budget.as_ref()), progress)?;
                let (paths, totals) = found.into_parts();
                (paths, of.amounts().iter().copied().zip(totals).collect::<Vec<_>>())
            }
        };
        let amounts = question
            .amounts
            .iter()
            .map(|amount| {
                let known = least.iter().find(|(of, _)| of == amount).map(|(_, totals)| Ok(totals.clone()));
                known.unwrap_or_else(|| totals_along(&hops, &out, *amount, &objective)).map(|totals| (*amount, totals))
            })
            .collect::<Result<Vec<_>, _>>()?;
        let back = question.returns.then(|| search(&hops, &sources, asked(Journey::Return, None), progress)).transpose()?;
        let mobility = question.mobility.then(|| mobility(&hops, progress)).transpose()?;
        let hops_to = |goal: &Spot| question.hops_to(goal, (&hops, &out, &objective));
        let goal_hops = self.goals.iter().map(hops_to).collect::<Result<Vec<_>, _>>()?;
        let paths: Vec<_> = goal_hops.iter().map(|found| found.as_ref().map(|found| joined(&hops, found))).collect();
        for (path, goal) in paths.iter().zip(&self.goals) {
            let start = out.source(self.lattice, goal.post).and_then(|number| self.starts.get(number));
            if let (Some(path), Some(start)) = (path, start) {
                Defect::unless_passed(&verify(&hops, path, start.post, goal.post))?;
            }
        }
        let predecessors = question.predecessors.then(|| out.predecessors(&hops, NO_PREDECESSOR));
        let refused = if question.refusals { refused_nodes(&hops) } else { Vec::new() };
        let warnings = self.refusals(&hops);
        Ok(Found { out, back, mobility, refused, predecessors, least, amounts, goal_hops, paths, warnings })
    }

    /// Warnings for starts and goals at which no hop can take off or land.
    fn refusals(&self, hops: &PostHops) -> Vec<String> {
        let node = if self.lattice.per_post > 1 { "node" } else { "post" };
        let refused = |spot: &Spot| {
            let refusal = hops.refusal(spot.post)?;
            let nearest = hops.nearest_usable(spot.post).map_or_else(
                || "no post of the DEM is usable".to_owned(),
                |node| {
                    let at = hops.lattice().at(self.dem().georeference(), node);
                    format!("the nearest usable one is ({:.3}, {:.3}) m", at.x, at.y)
                },
            );
            Some(format!(
                "the {}'s {node} ({:.3}, {:.3}) m {refusal}: no hop begins or ends there; {nearest}",
                spot.end.name(),
                spot.at.x,
                spot.at.y
            ))
        };
        self.starts.iter().chain(&self.goals).filter_map(refused).collect()
    }

    /// How many nodes the hops to the goals span on average; `None` without hops.
    fn spanned_nodes(&self, hops: &[Hop]) -> Option<f64> {
        let nodes = self.nodes();
        let runs_m = total(hops.iter().map(|hop| hop.landing.along_m - hop.takeoff.along_m));
        #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
        let spanned = runs_m / (hops.len() as f64 * nodes.dx_m().max(nodes.dy_m()));
        (!hops.is_empty()).then_some(spanned)
    }

    /// The ground as the warnings about trials see it.
    pub(in crate::study) fn trial_ground(&self, paths: &[Option<HopPath>]) -> TrialGround {
        let hops = paths.iter().flatten().map(|path| path.hops.len()).max().unwrap_or(0);
        TrialGround::of_map(&self.ground, hops)
    }

    /// The fewest hops of any path from the nearest start to a goal, by the speeds alone.
    fn hops_lower_bound(&self, goal: &Spot) -> Option<u64> {
        let limits = self.planning.hopper().limits();
        let speeds_m_s = (limits.takeoff_speed_max_m_s, limits.arc_landing_speed_max_m_s());
        let bounds = PathBounds::new(speeds_m_s.0, speeds_m_s.1, self.planning.gravity_m_s2());
        let to = self.ground.position(goal.at)?;
        let from = self.starts.iter().filter_map(|start| self.ground.position(start.at));
        from.filter_map(|from| bounds.hops((to.at - from.at).norm(), to.z_m - from.z_m)).min()
    }

    /// The record of a goal.
    fn goal_record(
        &self,
        goal: &Spot,
        (out, back): (&HopMap, Option<&HopMap>),
        path: Option<&HopPath>,
        flown: Option<FlownPath>,
    ) -> GoalRecord {
        let node = self.lattice.index(goal.post);
        let estimate = flown.as_ref().and_then(|flown| flown.estimate);
        let reached = |map: &HopMap| Some(map.hops[node]).filter(|&hops| hops >= 0);
        GoalRecord {
            x_m: goal.at.x,
            y_m: goal.at.y,
            offset_m: (goal.at - goal.asked).norm(),
            start: out.source(self.lattice, goal.post).map(|number| number + 1),
            hops: reached(out),
            hops_lower_bound: self.hops_lower_bound(goal),
            searched: out.searched(node),
            objective_totals: Vec::new(),
            return_hops: back.map(reached),
            path: path.map(|path| HopRecord::rows(path, self.projection.as_ref().ok())).unwrap_or_default(),
            totals: path.map(|path| TotalsRecord { estimate, ..TotalsRecord::from(&path.totals) }),
            propellant_shortage: path.and_then(|path| PropellantShortage::of(&path.totals)),
            // A path that fails the check has already ended the study with an error.
            verified: path.map(|_| true),
            simulation: flown.map(|flown| flown.trials),
        }
    }
}
