//! What limbs and cones are worth on a ground: robots and kinds of cones over the same poses.

use std::path::{Path, PathBuf};

use super::{
    LegsRouteError, LegsRouteQuestion, MeshRouteError,
    legs_ends::{LegsEnds, legs_ends, planned_map},
    objective::roadmap_question,
    stance::{best_stance, pairs_of, with_robot},
};
use crate::{
    ballistics::stance::ConeKind,
    ground::{MeshGround, Stance, StanceGround, StanceMap},
    path::{flown_by_stances, path_over_stances},
    planner::{
        StanceSampler,
        roadmap::{ContactSampler, Roadmap, RoadmapSampler},
    },
    progress::Progress,
    reach::stances::{DIRECTIONS, beam_deg, direction},
    report::{LegsTradeAnswer, LegsTradeRow},
    scenario::{Scenario, read_robot},
    world::Robot,
};

/// What is asked.
#[derive(Clone, Debug)]
pub struct LegsTradeQuestion<'a> {
    /// The scenario, with a robot file and a free route over a mesh or a DEM.
    pub scenario: &'a Scenario,
    /// The folder that its paths start from.
    pub base: &'a Path,
    /// Robot files, as they are named; none: that of the scenario.
    pub robots: Vec<PathBuf>,
    /// Kinds of cones; none: that of the scenario.
    pub cones: Vec<ConeKind>,
}

/// The rows, and warnings.
#[derive(Clone, Debug)]
pub struct LegsTraded {
    /// The answer as plain data.
    pub answer: LegsTradeAnswer,
    /// Warnings about robots and ground.
    pub warnings: Vec<String>,
    /// The robot files that were read.
    pub robot_files: Vec<PathBuf>,
}

/// Poses for each robot where the scenario gives no number of contacts.
const POSES: u32 = 400;

/// Compares robots and kinds of cones, each robot over the same poses for all cones: those in which it stands by the exact cone, which holds all
/// others.
///
/// # Errors
/// [`LegsRouteError`].
pub fn legs_trade(question: &LegsTradeQuestion<'_>, progress: &dyn Progress) -> Result<LegsTraded, LegsRouteError> {
    let LegsTradeQuestion { scenario, base, robots, cones } = question;
    LegsRouteQuestion { scenario, base }.of_hops_alone("trades")?;
    let own = base.join(scenario.legs.file.as_deref().unwrap_or_else(|| Path::new("")));
    let robots = if robots.is_empty() { std::slice::from_ref(&own) } else { &robots[..] };
    let cones = if cones.is_empty() { std::slice::from_ref(&scenario.legs.cone) } else { &cones[..] };
    let (mut rows, mut robot_files) = (Vec::new(), Vec::new());
    let mut warnings: Vec<String> = Vec::new();
    let mut ground = None;
    for file in robots {
        let read = read_robot(file)?;
        let scenario = Scenario { hopper: with_robot(&scenario.hopper, &read.robot), ..(*scenario).clone() };
        let ends = legs_ends(&scenario, base, &read.robot)?;
        for warning in ends.warnings.iter().chain(&read.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        ground = ground.or(Some(ends.record));
        let traded = Traded::new(&scenario, &ends, read.robot)?;
        if traded.exact.limits_pushes() {
            warnings.push(format!(
                "{}: stroke, forces and spin are looked at in steps over a window, which may miss a narrow part of a wider one: a wider cone may join a few \
                 pairs less",
                traded.exact.robot().name()
            ));
        }
        for cone in cones {
            rows.push(traded.row(&scenario, *cone, progress)?);
        }
        robot_files.push(file.clone());
        robot_files.extend(read.files);
    }
    let poses_max = scenario.mesh_search.contacts_max.unwrap_or(POSES);
    let answer = LegsTradeAnswer { ground, poses_max, seed: scenario.mesh_search.seed.unwrap_or(0), rows };
    Ok(LegsTraded { answer, warnings, robot_files })
}

/// A robot with the stances by the exact cone that all kinds are judged over: start, goal, and others.
struct Traded<'e> {
    mesh: &'e MeshGround,
    map: Option<StanceMap>,
    exact: StanceGround,
    stances: Vec<Stance>,
}

impl<'e> Traded<'e> {
    fn new(scenario: &Scenario, ends: &'e LegsEnds, robot: Robot) -> Result<Self, LegsRouteError> {
        let map = ends.map.as_ref().map(|map| StanceMap::new(planned_map(map, scenario)));
        let exact = over(&ends.ground, robot, (ConeKind::Exact, scenario), map.as_ref())?;
        if exact.is_point() {
            return Err(LegsRouteError::Point);
        }
        let stance = |at: usize, end| {
            let found = best_stance(&exact, &ends.surface[at], (None, None));
            found.best.map(|(stance, _)| stance).ok_or_else(|| LegsRouteError::NoStance {
                end,
                at_m: ends.surface[at].point_m().coords.into(),
                tried: found.tried.tried,
                refusal: found.refusal.map(|refusal| refusal.to_string()).unwrap_or_default(),
            })
        };
        let mut stances = vec![stance(0, "start")?, stance(1, "goal")?];
        let search = &scenario.mesh_search;
        let seed = search.seed.unwrap_or(0);
        let contacts = ContactSampler::new(exact.mesh(), search.bounds, 0.0, seed).map_err(MeshRouteError::from)?;
        let mut sampler = StanceSampler::new(&exact, contacts, seed);
        stances.extend(sampler.all_over(search.contacts_max.unwrap_or(POSES) as usize, &|_| true));
        drop(sampler);
        Ok(Self { mesh: &ends.ground, map, stances, exact })
    }

    /// What a kind of cone makes of these poses.
    fn row(&self, scenario: &Scenario, cone: ConeKind, progress: &dyn Progress) -> Result<LegsTradeRow, LegsRouteError> {
        let ground = over(self.mesh, self.exact.robot().clone(), (cone, scenario), self.map.as_ref())?;
        let judged: Vec<Option<Stance>> = self.stances.iter().map(|stance| ground.stand(*stance.pose()).ok()).collect();
        let (mut beams_deg, mut usable) = (0.0, 0_u32);
        for stance in judged.iter().flatten() {
            for number in 0..DIRECTIONS {
                let beam_deg = stance.cone().map_or(0.0, |cone| beam_deg(cone, direction(number, DIRECTIONS)));
                beams_deg += beam_deg;
                usable += u32::from(beam_deg > 0.0);
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "a count of poses")]
        let all = self.stances.len() as f64 * f64::from(DIRECTIONS);
        let stand_at_ends = judged[..2].iter().all(Option::is_some);
        let stances: Vec<Stance> = judged.into_iter().flatten().collect();
        let count = stances.len();
        let mut roadmap = Roadmap::new();
        roadmap.extend(&ground, stances, progress)?;
        let joined_pairs = (0..count).map(|node| roadmap.hops_from(node).count() as u64).sum();
        let path = if stand_at_ends { best_path(scenario, &ground, &roadmap)? } else { None };
        Ok(LegsTradeRow {
            robot: ground.robot().name().to_owned(),
            limbs: ground.robot().limbs().len(),
            cone: cone.name().to_owned(),
            poses: self.stances.len(),
            stances: count,
            beam_mean_deg: beams_deg / all,
            directions_mean: f64::from(usable) / all,
            joined_pairs,
            windows: roadmap.window_count(),
            hops: path.map(|path| path.0),
            flight_time_s: path.map(|path| path.1),
        })
    }
}

/// Hops and time in flight of the best path from the first stance to the second, flown again.
fn best_path(scenario: &Scenario, ground: &StanceGround, roadmap: &Roadmap<Stance>) -> Result<Option<(u64, f64)>, LegsRouteError> {
    let (objective, budgets) = (scenario.full_objective(), scenario.total_budgets());
    let asked = roadmap_question(scenario, &objective, &budgets);
    let route = roadmap.route(ground, (0, 1), &asked)?;
    let Some(found) = route.path.filter(|_| route.within) else { return Ok(None) };
    let stances: Vec<&Stance> = found.contacts.iter().map(|node| roadmap.contact(*node)).collect();
    let pairs = pairs_of(&stances);
    let path = path_over_stances(ground, &pairs, &found.arcs()).ok_or(MeshRouteError::Lost)?;
    let violations = flown_by_stances(ground, &pairs, &path);
    if violations.is_empty() {
        Ok(Some((path.hops.len() as u64, path.totals.flight_time_s)))
    } else {
        Err(LegsRouteError::Defect { violations })
    }
}

/// A robot over facets, with a kind of cone and what the map lays over them.
fn over(
    mesh: &MeshGround,
    robot: Robot,
    (cone, scenario): (ConeKind, &Scenario),
    map: Option<&StanceMap>,
) -> Result<StanceGround, LegsRouteError> {
    let ground = StanceGround::new(mesh.clone(), robot, cone, scenario.legs.up)?;
    Ok(match map {
        Some(map) => ground.with_map(map.clone()),
        None => ground,
    })
}
