//! The search, the paths and their check, the trials, and the answer that they make.

use std::sync::Arc;

use super::{super::Defect, MapQuestion, MapStudyError, PreparedMap, Spot};
use crate::{
    ballistics::PathBounds,
    ground::Surface,
    path::HopPath,
    progress::Progress,
    reach::map::{
        HopMap, Journey, MapHop, Mobility, PostHops, Search, Source, costs_to_go, joined, mobility, path_hops, risks_flown_over,
        search, verify,
    },
    report::{
        DeratingRecord, GoalRecord, HopRecord, MapAnswer, MapSummary, PropellantShortage, SimulationRecord, SuccessEstimate,
        TotalsRecord,
    },
    scenario::UncertaintyKeys,
    study::{Extremes, TrialGround, constant_gravity_warnings, sense::unplanned_bounces},
    uncertainty::{Mission, Policy, Simulation},
    world::FrictionCone,
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
    /// For each post, the one that its last hop comes from, as [`HopMap::predecessors`] gives it; [`NO_PREDECESSOR`] without one.
    pub predecessors: Option<Vec<i32>>,
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
    predecessors: Option<Vec<i32>>,
    goal_hops: Vec<Option<Vec<MapHop>>>,
    paths: Vec<Option<HopPath>>,
    warnings: Vec<String>,
}

/// How reliably the path to a goal is flown.
#[derive(Clone, Debug)]
struct FlownPath {
    trials: SimulationRecord,
    estimate: Option<SuccessEstimate>,
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
        let Found { out, back, mobility, predecessors, goal_hops, paths, warnings: of_ends } = found;
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
            hops_max: question.hops_max,
        });
        answer.derating = DeratingRecord::of(&scenario.derating);
        let goals = self.goals.iter().zip(&paths).zip(trials);
        answer.goals =
            goals.map(|((goal, path), trials)| self.goal_record(goal, (&out, back.as_ref()), path.as_ref(), trials)).collect();
        let mut warnings = self.warnings.clone();
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
        Ok(MapStudy { answer, warnings, out, back, mobility, predecessors, goal_hops, paths })
    }

    /// Searches, and checks the path to every goal.
    fn found(&self, question: &MapQuestion<'_>, progress: &dyn Progress) -> Result<Found, MapStudyError> {
        let options = &question.scenario.search;
        let hops = PostHops::over(self.planning.clone(), self.lattice)?;
        let sources: Vec<Source> = self.starts.iter().map(|start| start.post.into()).collect();
        let effort = question.effort.then_some((options.effort, options.takeoff));
        let asked = |journey, effort| Search { journey, effort, hops_max: question.hops_max };
        let out = search(&hops, &sources, asked(Journey::Outbound, effort), progress)?;
        let back = question.returns.then(|| search(&hops, &sources, asked(Journey::Return, None), progress)).transpose()?;
        let mobility = question.mobility.then(|| mobility(&hops, progress)).transpose()?;
        let hops_to = |goal: &Spot| {
            let nodes = out.path(&hops, goal.post);
            nodes.map(|nodes| path_hops(&hops, &nodes, options.takeoff)).transpose()
        };
        let goal_hops = self.goals.iter().map(hops_to).collect::<Result<Vec<_>, _>>()?;
        let paths: Vec<_> = goal_hops.iter().map(|found| found.as_ref().map(|found| joined(&hops, found))).collect();
        for (path, goal) in paths.iter().zip(&self.goals) {
            let start = out.source(self.lattice, goal.post).and_then(|number| self.starts.get(number));
            if let (Some(path), Some(start)) = (path, start) {
                Defect::unless_passed(&verify(&hops, path, start.post, goal.post))?;
            }
        }
        let predecessors = question.predecessors.then(|| out.predecessors(&hops, NO_PREDECESSOR));
        let warnings = self.refusals(&hops);
        Ok(Found { out, back, mobility, predecessors, goal_hops, paths, warnings })
    }

    /// Warnings for starts and goals at which no hop can take off or land.
    fn refusals(&self, hops: &PostHops) -> Vec<String> {
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
                "the {}'s post ({:.3}, {:.3}) m {refusal}: no hop begins or ends there; {nearest}",
                spot.end.name(),
                spot.at.x,
                spot.at.y
            ))
        };
        self.starts.iter().chain(&self.goals).filter_map(refused).collect()
    }

    /// The ground as the warnings about trials see it.
    fn trial_ground(&self, paths: &[Option<HopPath>]) -> TrialGround {
        let bounds = self.dem().bounds();
        let hops = paths.iter().flatten().map(|path| path.hops.len()).max().unwrap_or(0);
        let constant = self.ground.constant_friction().map(FrictionCone::coefficient);
        // The coefficients of a raster are not looked through.
        let of_raster = self.ground.terrain().overlays().friction().map(|_| f64::INFINITY);
        TrialGround { friction_max: of_raster.or(constant), extent_m: (bounds.max - bounds.min).norm(), journey_m: None, hops }
    }

    /// Flies the path to every reachable goal many times, and in the fixed trials of an estimate if there are errors: a robot that replans goes to the goal of its path, whatever others are nearer.
    fn flown(
        &self,
        question: &MapQuestion<'_>,
        paths: &[Option<HopPath>],
        keys: &UncertaintyKeys,
        progress: &dyn Progress,
    ) -> Result<Vec<Option<FlownPath>>, MapStudyError> {
        let options = &question.scenario.search;
        let replans = keys.policy == Policy::Replan;
        let hops = replans.then(|| PostHops::over(self.planning.clone(), self.lattice)).transpose()?;
        let fly = |goal: &Spot, path: &HopPath| {
            let (Some(first), Some(last)) = (path.hops.first(), path.hops.last()) else { return Ok(None) };
            let mut mission = Mission::over_dem(self.ground.clone(), path.clone(), first.takeoff, last.landing);
            if let Some(hops) = &hops {
                mission = if question.weighs_risk(&keys.errors) {
                    let risks = risks_flown_over(hops, &self.ground, goal.post, (&keys.errors, options.takeoff), progress)?;
                    mission.with_reliable_replanning_over_posts(Arc::new(risks))
                } else {
                    let criterion = (options.effort, options.takeoff);
                    mission.with_replanning_over_posts(Arc::new(costs_to_go(hops, goal.post, criterion, progress)?))
                };
                if !question.scenario.derating.is_none() {
                    mission = mission.planned_over(self.planning.clone());
                }
            }
            let (simulation, options) = (Simulation::new(&mission, keys.errors.clone())?, keys.options());
            let estimate = if keys.errors.is_none() {
                None
            } else {
                let success_estimated = simulation.estimated_success(&options, progress)?;
                Some(SuccessEstimate { success_estimated, success_policy: keys.policy })
            };
            let summary = simulation.run(&options, &mut (), progress)?;
            Ok(Some(FlownPath { trials: SimulationRecord::new(&summary, path.hops.len()), estimate }))
        };
        let goals = self.goals.iter().zip(paths);
        goals.map(|(goal, path)| path.as_ref().map_or(Ok(None), |path| fly(goal, path))).collect()
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
