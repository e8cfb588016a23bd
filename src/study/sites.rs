//! Landing sites: what is reached from each of many candidates, ranked.

use std::ops::ControlFlow;

use super::{
    Defect, JourneyEnd,
    map::{Aim, MapQuestion, MapStudyError, NamedPlace, PreparedMap, Spot, allowed},
};
use crate::{
    path::HopPath,
    planner::Amount,
    progress::{Detail, Meter, Progress, Stage, Step},
    reach::map::{Journey, MapError, MapObjective, Post, PostHops, Search, joined, least_totals, search, verify},
    report::{DeratingRecord, SiteRecord, SitesAnswer, SizeAnswer},
    uncertainty::Policy,
};

/// Where a mission may begin.
#[derive(Clone, Debug, PartialEq)]
pub enum Candidates {
    /// These places.
    Places(Vec<NamedPlace>),
    /// Every so many nodes in rows and columns, where hops begin; 0 counts as 1.
    Every(usize),
}

/// A question about landing sites.
#[derive(Clone, Debug)]
pub struct SitesQuestion<'a> {
    /// The hopper, the ground and the nodes, without starts; the goals are the targets.
    pub map: MapQuestion<'a>,
    /// The candidates.
    pub candidates: Candidates,
}

/// A row of the answer, and the paths to the targets where they are flown.
struct Row {
    record: SiteRecord,
    paths: Vec<Option<HopPath>>,
}

/// The answer to a question about landing sites, with what pictures and rasters show.
#[derive(Clone, Debug)]
pub struct SitesStudy {
    /// The answer.
    pub answer: SitesAnswer,
    /// Warnings about the terrain and the candidates.
    pub warnings: Vec<String>,
}

/// A candidate on the map.
struct Candidate {
    number: usize,
    spot: Result<Spot, MapStudyError>,
}

/// The sets of candidates that reach each other.
struct Parts {
    /// The part of each node that belongs to one, from 1; 0 for others.
    of_node: Vec<u32>,
    /// How many nodes each part has.
    sizes: Vec<usize>,
}

/// Forwards the wish to end, and reports the candidates done in place of the layers of each map.
struct Silent<'p>(&'p Meter<'p>);

impl Progress for Silent<'_> {
    fn report(&self, _: &Step) -> ControlFlow<()> {
        if self.0.report(Detail::None).is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

impl SitesQuestion<'_> {
    /// The candidates over a prepared map, in their order.
    fn candidates(&self, prepared: &PreparedMap, hops: &PostHops) -> Vec<Candidate> {
        let lattice = prepared.lattice;
        match &self.candidates {
            Candidates::Places(places) => {
                let candidate = |(number, place)| Candidate { number, spot: prepared.spot(JourneyEnd::Start, place) };
                (1..).zip(places).map(candidate).collect()
            }
            Candidates::Every(every) => {
                let every = (*every).max(1);
                let rows = (0..lattice.rows).step_by(every);
                let posts = rows.flat_map(|row| (0..lattice.cols).step_by(every).map(move |col| Post { row, col }));
                let spot = |post| {
                    let at = lattice.at(prepared.dem().georeference(), post);
                    Spot { name: "a candidate".to_owned(), end: JourneyEnd::Start, asked: at, post, at }
                };
                (1..)
                    .zip(posts.filter(|post| hops.usable(*post)))
                    .map(|(number, post)| Candidate { number, spot: Ok(spot(post)) })
                    .collect()
            }
        }
    }

    /// How many candidates there are at most.
    pub fn count_max(&self, prepared: &PreparedMap) -> usize {
        match &self.candidates {
            Candidates::Places(places) => places.len(),
            Candidates::Every(every) => {
                prepared.lattice.rows.div_ceil((*every).max(1)) * prepared.lattice.cols.div_ceil((*every).max(1))
            }
        }
    }

    /// What the answer takes at most: the bytes of one map, and the pairs of all searches.
    pub fn size(&self, prepared: &PreparedMap) -> SizeAnswer {
        let mut size = prepared.memory.answer();
        let count = self.count_max(prepared) as u64;
        // One search from every candidate, and one back to each; and one to each target where trials replan.
        let of_candidates = 2 * count;
        let targets = prepared.goals.len() as u64;
        let keys = self.map.trials.then(|| self.map.scenario.uncertainty.clone().unwrap_or_default());
        let replans = keys.as_ref().is_some_and(|keys| keys.policy == Policy::Replan);
        let searches = of_candidates + if replans { targets } else { 0 };
        size.pairs_max = size.pairs_max.saturating_mul(searches);
        size.searches_max = Some(searches);
        size.trials_max = keys.map(|keys| keys.options().trials.saturating_mul(count).saturating_mul(targets));
        size
    }
}

/// Ranks candidates for a landing site.
///
/// With trials, the path from every candidate to each target is flown so many times as the scenario says.
///
/// From every candidate one search over all nodes; and one back to a candidate of every set of candidates that reach each other, which share the
/// nodes that they reach and those from which they are reached.
///
/// # Errors
/// [`MapStudyError`].
pub fn sites(prepared: &PreparedMap, question: &SitesQuestion<'_>, progress: &dyn Progress) -> Result<SitesStudy, MapStudyError> {
    rayon::scope(|_| ranked(prepared, question, progress))
}

fn ranked(prepared: &PreparedMap, question: &SitesQuestion<'_>, progress: &dyn Progress) -> Result<SitesStudy, MapStudyError> {
    let scenario = question.map.scenario;
    let hops = PostHops::over(prepared.planning.clone(), prepared.lattice)?;
    let candidates = question.candidates(prepared, &hops);
    if question.map.trials && prepared.goals.is_empty() {
        return Err(MapStudyError::NoTargetOfTrials);
    }
    let meter = Meter::with_total(progress, Stage::Sites, candidates.len() as u64);
    meter.report(Detail::None).map_err(MapError::from)?;
    let nodes = (0..prepared.lattice.count()).filter(|index| hops.has_ground(prepared.lattice.node(*index))).count();
    let aim = question.map.aim()?;
    let amount = match &aim {
        Aim::Hops(_) => Amount::Hops,
        Aim::Least(objective, _) => objective.first(),
    };
    let mut parts = Parts { of_node: vec![0; prepared.lattice.count()], sizes: Vec::new() };
    let mut rows = Vec::with_capacity(candidates.len());
    for Candidate { number, spot } in &candidates {
        match spot {
            Ok(spot) => rows.push(site(prepared, (&hops, &question.map), (*number, spot, nodes), &mut parts, &meter)?),
            Err(error) => {
                let Candidates::Places(places) = &question.candidates else { continue };
                let at = places.get(number - 1).and_then(|place| place.place.metres());
                let record = SiteRecord::refused(*number, at.map_or([f64::NAN; 2], |at| [at.x, at.y]), error.to_string());
                rows.push(Row { record, paths: Vec::new() });
            }
        }
        meter.complete_one().map_err(MapError::from)?;
    }
    let mut warnings = prepared.warnings.clone();
    let trials = fly(prepared, (&hops, &question.map), &mut rows, &mut warnings, progress)?;
    let rows: Vec<SiteRecord> = rows.into_iter().map(|row| row.record).collect();
    let answer = SitesAnswer {
        stride: prepared.lattice.stride,
        nodes_per_post: prepared.lattice.per_post,
        nodes,
        amount,
        targets_m: prepared.goals.iter().map(|goal| [goal.at.x, goal.at.y]).collect(),
        searches: searches(&rows, &parts),
        trials,
        parts: parts.sizes.len(),
        derating: DeratingRecord::of(&scenario.derating),
        sites: rows,
    };
    Ok(SitesStudy { answer: answer.ranked(), warnings })
}

/// Flies the paths from all candidates to the targets, one target after the other, and writes the shares that arrive into the rows.
///
/// # Returns
/// How many trials each path has; `None` if none are asked for.
fn fly(
    prepared: &PreparedMap,
    (hops, question): (&PostHops, &MapQuestion<'_>),
    rows: &mut [Row],
    warnings: &mut Vec<String>,
    progress: &dyn Progress,
) -> Result<Option<u64>, MapStudyError> {
    let Some((scenario, of_errors)) = question.flown_scenario()? else { return Ok(None) };
    let keys = scenario.uncertainty.clone().unwrap_or_default();
    let options = keys.options();
    warnings.extend(of_errors);
    let paths: Vec<Option<HopPath>> = rows.iter().flat_map(|row| row.paths.iter().cloned()).collect();
    warnings.extend(scenario.trial_warnings(&[keys.policy], &prepared.trial_ground(&paths)));
    for (target, goal) in prepared.goals.iter().enumerate() {
        let goes_by = prepared.goes_by(question, (hops, goal), &keys, progress)?;
        for Row { record, paths } in rows.iter_mut() {
            let success = match paths.get(target).and_then(Option::as_ref) {
                // A site at the target has arrived.
                Some(path) => match prepared.trials_of(question, (path, &goes_by), &keys)? {
                    Some(simulation) => Some(simulation.run(&options, &mut (), progress)?.success.rate),
                    None => Some(1.0),
                },
                None => None,
            };
            record.target_success.push(success);
        }
    }
    for Row { record, .. } in rows.iter_mut() {
        let missing = record.target_success.iter().position(Option::is_none);
        match missing {
            Some(_) if record.refusal.is_some() => {
                record.success_missing = Some("no hop begins there, so that there is no path to fly".to_owned());
            }
            Some(target) => {
                let number = target + 1;
                let why = format!("target {number} is not reached over these nodes, so that there is no path to fly");
                record.success_missing = Some(why);
            }
            None => record.success = record.target_success.iter().flatten().copied().reduce(f64::min),
        }
    }
    Ok(Some(options.trials))
}

/// How many searches over all nodes it took.
fn searches(rows: &[SiteRecord], parts: &Parts) -> usize {
    let answered = || rows.iter().filter(|row| row.reachable_nodes > 0);
    answered().count() + if parts.sizes.is_empty() { answered().count() } else { parts.sizes.len() }
}

/// One candidate.
fn site(
    prepared: &PreparedMap,
    (hops, question): (&PostHops, &MapQuestion<'_>),
    (number, spot, nodes): (usize, &Spot, usize),
    parts: &mut Parts,
    meter: &Meter<'_>,
) -> Result<Row, MapStudyError> {
    let lattice = prepared.lattice;
    let silent = Silent(meter);
    let (scenario, options) = (question.scenario, &question.scenario.search);
    let aim = question.aim()?;
    let hops_max = match &aim {
        Aim::Hops(most) => *most,
        Aim::Least(..) => None,
    };
    let objective = MapObjective::new(hops, &scenario.full_objective(), scenario.commands, options.takeoff);
    let (out, totals) = match &aim {
        Aim::Hops(_) => {
            let asked = Search { journey: Journey::Outbound, effort: None, hops_max };
            (search(hops, &[spot.post.into()], asked, &silent)?, None)
        }
        Aim::Least(_, budget) => {
            let found = least_totals(hops, &[spot.post], &objective, allowed(budget.as_ref()), &silent)?;
            let (paths, totals) = found.into_parts();
            (paths, totals.into_iter().next())
        }
    };
    let there_and_back = || {
        let asked = Search { journey: Journey::Return, effort: None, hops_max };
        let back = search(hops, &[spot.post.into()], asked, &silent)?;
        Ok::<_, MapStudyError>((0..lattice.count()).filter(|node| out.hops[*node] >= 0 && back.hops[*node] >= 0).collect())
    };
    // What is reached within a bound differs between places that reach each other.
    let is_bounded = match &aim {
        Aim::Hops(most) => most.is_some(),
        Aim::Least(_, budget) => budget.is_some(),
    };
    let (part, returns) = if is_bounded {
        let nodes: Vec<usize> = there_and_back()?;
        (None, nodes.len())
    } else {
        let part = parts.of(lattice.index(spot.post), there_and_back)?;
        (Some(part), parts.sizes[part - 1])
    };
    let reached = out.hops.iter().filter(|hops| **hops >= 0).count();
    let goals: Vec<usize> = prepared.goals.iter().map(|goal| lattice.index(goal.post)).collect();
    let start = lattice.index(spot.post);
    let counted: Vec<usize> = if goals.is_empty() {
        (0..lattice.count()).filter(|node| *node != start && out.hops[*node] >= 0).collect()
    } else {
        goals.iter().copied().filter(|node| out.hops[*node] >= 0).collect()
    };
    let of_totals = totals.as_ref().map(|totals| counted.iter().map(|node| totals[*node]).collect::<Vec<f64>>());
    let target_hops: Vec<Option<i16>> = goals.iter().map(|node| Some(out.hops[*node]).filter(|hops| *hops >= 0)).collect();
    let path_to = |goal: &Spot| -> Result<Option<HopPath>, MapStudyError> {
        let Some(path) = question.hops_to(goal, (hops, &out, &objective))?.map(|found| joined(hops, &found)) else {
            return Ok(None);
        };
        Defect::unless_passed(&verify(hops, &path, spot.post, goal.post))?;
        Ok(Some(path))
    };
    let flown = if question.trials { &prepared.goals[..] } else { &[] };
    let paths = flown.iter().map(path_to).collect::<Result<_, _>>()?;
    let record = SiteRecord {
        rank: 0,
        candidate: number,
        x_m: spot.at.x,
        y_m: spot.at.y,
        offset_m: (spot.at - spot.asked).norm(),
        reachable_nodes: reached,
        reachable_share: share(reached, nodes),
        return_share: share(returns, reached),
        mean_hops: mean(&counted.iter().map(|node| f64::from(out.hops[*node])).collect::<Vec<_>>()),
        greatest_hops: counted.iter().map(|node| out.hops[*node]).max(),
        mean_total: of_totals.as_deref().and_then(mean),
        greatest_total: of_totals.as_ref().and_then(|totals| totals.iter().copied().reduce(f64::max)),
        targets_reached: target_hops.iter().flatten().count(),
        target_hops,
        success: None,
        success_missing: None,
        target_success: Vec::new(),
        part,
        refusal: hops.refusal(spot.post).map(|refusal| format!("it {refusal}")),
    };
    Ok(Row { record, paths })
}

impl Parts {
    /// The part of a node, from 1; a new one has the nodes that are found for it.
    fn of<E>(&mut self, node: usize, found: impl FnOnce() -> Result<Vec<usize>, E>) -> Result<usize, E> {
        if self.of_node[node] == 0 {
            let nodes = found()?;
            #[expect(clippy::cast_possible_truncation, reason = "no more parts than nodes")]
            let number = self.sizes.len() as u32 + 1;
            for node in &nodes {
                self.of_node[*node] = number;
            }
            self.of_node[node] = number;
            self.sizes.push(nodes.len().max(1));
        }
        Ok(self.of_node[node] as usize)
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts of nodes stay far below 2^53")]
fn share(part: usize, whole: usize) -> f64 {
    part as f64 / whole.max(1) as f64
}

#[expect(clippy::cast_precision_loss, reason = "counts of nodes stay far below 2^53")]
fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}
