//! The path of fewest hops, then least effort.

use std::io::{self, Write};

use super::{
    Case, CaseError, Commands, Front, FrontProblem, JourneyError, Proof, SimulateError,
    dem_ground::dem_ground,
    free_front::free_front,
    free_route::{FoundRoute, along_transect},
    free_trials::route_with_success,
    front::{amount_front, front},
    journey::Searched,
    to_go::ToGo,
};
#[cfg(feature = "plot")]
use crate::figure::{
    Caption, FigureError, FigureInput, FigureTitle, FrontAgainst, FrontFigure, FrontPoint, FrontValue, Picture, PlanView, Success,
    draw, draw_front,
};
use crate::{
    chain::Station,
    graph,
    ground::DemGround,
    hop::HopTest,
    path::{Execution, HopPath, TooManyHops, Violation},
    progress::Progress,
    report::{HopRecord, PlanAnswer, ReliablePathRecord, TotalsRecord, path_geojson, write_path_csv},
    scenario::{Route, UncertaintyKeys},
};

/// What is wanted beside the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PlanOptions {
    /// Bounds on the fewest hops.
    pub proof: Option<Proof>,
    /// Whether the path is flown again by direct simulation, against every limit.
    pub verify: bool,
    /// Whether the success of the path is estimated by fixed trials, where the scenario has errors.
    pub estimate: bool,
    /// A front over the nodes of the search.
    pub front: Option<Front>,
}

/// Why there is no plan. That there is no path is an answer, not an error.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// The case, the search or the proof.
    #[error(transparent)]
    Journey(#[from] JourneyError),
    /// A front that the scenario does not have.
    #[error(transparent)]
    Front(#[from] FrontProblem),
    /// A path of too many hops to list.
    #[error(transparent)]
    TooManyHops(#[from] TooManyHops),
    /// A path that breaks a limit when it is flown again.
    #[error(transparent)]
    Defect(#[from] Defect),
}

impl PlanError {
    /// Whether the plan was cancelled.
    pub const fn is_cancelled(&self) -> bool {
        matches!(self, Self::Journey(JourneyError::Search(graph::SearchError::Cancelled(_))))
    }
}

impl From<CaseError> for PlanError {
    fn from(error: CaseError) -> Self {
        Self::Journey(error.into())
    }
}

/// A planned path that does not pass the independent checker: a defect of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the planned path does not pass its own check ({} violations): {}; this is a defect of chta, please report it with the scenario",
    violations.len(), first_of(violations)
)]
pub struct Defect {
    /// All violations.
    pub violations: Vec<Violation>,
}

/// The first violations in words.
fn first_of(violations: &[Violation]) -> String {
    violations.iter().take(10).map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

impl Defect {
    /// Refuses a path that breaks a limit when it is flown again.
    ///
    /// # Errors
    /// [`Defect`].
    pub fn unless_passed(execution: &Execution) -> Result<(), Self> {
        if execution.passes() { Ok(()) } else { Err(Self { violations: execution.violations.clone() }) }
    }
}

/// A plan with everything that its views need.
#[derive(Clone, Debug)]
pub struct Planned {
    /// What was asked.
    pub case: Case,
    /// The hop test over its chain.
    pub test: HopTest,
    /// Start and goal.
    pub ends: (Station, Station),
    /// The answer of the search.
    pub found: graph::Answer,
    /// The path; `None` if no path was found, or no commands of the machine fly it.
    pub path: Option<HopPath>,
    /// The answer as plain data.
    pub answer: PlanAnswer,
    /// The warnings about the path.
    pub warnings: Vec<String>,
    /// What trials of the path replan by, where the choice of the path found it.
    pub(super) to_go: Option<ToGo>,
}

/// Plans the path of fewest hops, then least effort; proves bounds and flies the path again if that is wanted.
///
/// # Errors
/// [`PlanError`].
pub fn plan(case: &Case, options: PlanOptions, progress: &dyn Progress) -> Result<Planned, PlanError> {
    if case.scenario.route == Route::Free {
        return plan_free(case, options, progress);
    }
    let case = case.with_commands(Commands::OfTheMachine)?;
    if let Some(front) = options.front {
        front.check(&case.scenario)?;
    }
    let (test, ends) = (case.hop_test(), case.ends()?);
    let searched = Searched::new(&test, ends, &case, options.proof, progress)?;
    let (check, path) = searched.answer_with_path(&test, ends, &case);
    let path = path?;
    if let Some(path) = path.as_ref().filter(|_| options.verify) {
        // Under derating the limits that were planned with: the stricter ones, to which the margins are stated.
        Defect::unless_passed(&case.planning().execute(path, ends))?;
    }
    let mut warnings = path.as_ref().map(|path| case.scenario.path_warnings(path)).unwrap_or_default();
    warnings.extend(searched.warnings.iter().cloned());
    let flown = path.as_ref().filter(|_| options.estimate);
    let estimate = flown.map(|path| searched.success_estimate(&test, ends, &case, path, progress)).transpose()?.flatten();
    let mut hops = path.as_ref().map(|path| HopRecord::rows(path, case.prepared.projection.as_ref())).unwrap_or_default();
    if let Some(estimate) = &estimate {
        estimate.add_to(&mut hops);
    }
    let estimate = estimate.map(|estimate| estimate.success);
    let mut front_search = None;
    let front = match options.front {
        None => None,
        Some(wanted) if wanted != Front::HOPS_RISK => {
            let (rows, of, left_out) = amount_front(&case, (&test, ends), (&searched, wanted.amount()), progress)?;
            if left_out > 0 {
                warnings.push(format!(
                    "the front leaves out {left_out} paths: they have too many hops to list, or no commands in the machine's steps fly them"
                ));
            }
            front_search = Some(of);
            Some(rows)
        }
        Some(_) => {
            warnings.extend(case.scenario.uncertainty.as_ref().and_then(UncertaintyKeys::warning).map(str::to_owned));
            Some(front(&case, (&test, ends), &searched, progress)?)
        }
    };
    let answer = PlanAnswer {
        check,
        verified: (options.verify && path.is_some()).then_some(true),
        path: hops,
        totals: path.as_ref().map(|path| TotalsRecord { estimate, ..TotalsRecord::from(&path.totals) }),
        reliable_paths: ReliablePathRecord::rows(&searched.reliable_paths),
        front,
        front_search,
    };
    Ok(Planned { case, test, ends, found: searched.found, path, answer, warnings, to_go: searched.to_go })
}

/// The same in any direction over a DEM: the path is always flown again, over its unrolled chain and over the DEM.
fn plan_free(case: &Case, options: PlanOptions, progress: &dyn Progress) -> Result<Planned, PlanError> {
    if options.proof.is_some() {
        along_transect(&case.scenario, "bounds that hold at any resolution are proved")?;
    }
    if let Some(front) = options.front {
        front.check(&case.scenario)?;
        if front == Front::HOPS_RISK {
            along_transect(&case.scenario, "a front of hops against the estimated success is found")?;
        }
    }
    let asked = case;
    let (route, mut searched) = route_with_success(asked, progress)?;
    let FoundRoute { case, test, ends, found, check, path, warnings } = route;
    let front = options.front.map(|front| free_front(asked, path.as_ref(), front.amount(), progress)).transpose()?;
    let (front, front_search) = front.unzip();
    let flown = path.as_ref().filter(|_| options.estimate);
    let estimate = flown.map(|path| searched.success_estimate(&test, ends, &case, path, progress)).transpose()?.flatten();
    let mut hops = path.as_ref().map(|path| HopRecord::rows(path, case.prepared.projection.as_ref())).unwrap_or_default();
    let mut totals = path.as_ref().map(|path| TotalsRecord::from(&path.totals));
    if let Some((estimate, totals)) = estimate.zip(totals.as_mut()) {
        estimate.add_to(&mut hops);
        totals.estimate = Some(estimate.success);
        searched.to_go = searched.to_go.or(estimate.to_go);
    }
    let answer = PlanAnswer {
        check,
        verified: path.is_some().then_some(true),
        path: hops,
        totals,
        reliable_paths: Vec::new(),
        front,
        front_search,
    };
    Ok(Planned { case, test, ends, found, path, answer, warnings, to_go: searched.to_go })
}

impl Planned {
    /// Whether there is a path that the machine can fly.
    pub fn is_traversable(&self) -> bool {
        self.answer.check.is_traversable()
    }

    /// The whole raster with its overlays, for flights in three dimensions; `None` if the terrain is a mesh or a chain.
    ///
    /// # Errors
    /// [`SimulateError::Dem`].
    pub fn dem_ground(&self) -> Result<Option<DemGround>, SimulateError> {
        dem_ground(&self.case)
    }

    /// Writes the path as CSV; only the header without a path.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: impl Write) -> io::Result<()> {
        write_path_csv(&self.answer.path, self.case.map_knowledge(), out)
    }

    /// The path as GeoJSON over the map; `None` without a path or a map.
    pub fn geojson(&self) -> Option<String> {
        self.case.prepared.chain.geometry().map_points()?;
        path_geojson(self.path.as_ref()?, self.case.scenario.body.gravity.m_s2(), self.case.prepared.projection.as_ref())
    }

    /// The picture, with or without a path.
    ///
    /// # Errors
    /// [`FigureError`].
    #[cfg(feature = "plot")]
    pub fn picture(&self) -> Result<Picture, FigureError> {
        let scenario = &self.case.scenario;
        // The search of a free route has read the raster.
        let ground = self.answer.check.route.as_ref().and_then(|_| self.dem_ground().ok().flatten());
        draw(&FigureInput {
            test: &self.test,
            answer: &self.found,
            path: self.path.as_ref(),
            start: self.ends.0,
            goal: self.ends.1,
            plan_view: ground.as_ref().and_then(|ground| self.plan_view(ground)),
            title: FigureTitle {
                name: scenario.title.clone().unwrap_or_default(),
                body: scenario.body.name.clone().unwrap_or_default(),
                ground: super::captions::format_ground(scenario),
                refusal: self.answer.check.commands_refusal.clone(),
            },
        })
    }

    /// A free route from above.
    #[cfg(feature = "plot")]
    fn plan_view<'g>(&self, ground: &'g DemGround) -> Option<PlanView<'g>> {
        use crate::quantity::MapPoint;

        let geometry = self.case.prepared.chain.geometry();
        let start = geometry.map_point(&self.ends.0)?;
        let landings = self.path.iter().flat_map(|path| &path.hops).filter_map(|hop| hop.landing.map());
        let route = self.answer.check.route.as_ref()?;
        let at = |[x_m, y_m, _]: [f64; 3]| MapPoint::new(x_m, y_m);
        Some(PlanView {
            dem: ground.terrain().dem(),
            start,
            goal: geometry.map_point(&self.ends.1)?,
            path: self.path.iter().map(|_| start).chain(landings).collect(),
            nearest: self.path.is_none().then(|| at(route.nearest_m)),
            leads_to_goal: route.gap.as_ref().map(|gap| at(gap.leads_to_goal_from_m)),
        })
    }

    /// The picture of the front; `None` if it was not wanted.
    ///
    /// # Errors
    /// [`FigureError`].
    #[cfg(feature = "plot")]
    pub fn front_picture(&self) -> Option<Result<Picture, FigureError>> {
        use super::captions::{SpeedLimit, title};

        let (scenario, front) = (&self.case.scenario, self.answer.front.as_ref()?);
        let mut line = vec![format!("from x = {:.3} m to x = {:.3} m", self.ends.0.point.x_m, self.ends.1.point.x_m)];
        line.extend(scenario.body.name.clone());
        line.extend(SpeedLimit::stated(&scenario.hopper).map(|limit| limit.to_string()));
        if let Some(of) = &self.answer.front_search {
            let amount = of.front_amount;
            let point = |row: &crate::report::FrontRecord| FrontPoint {
                hops: row.hops,
                value: FrontValue::Total(row.of(amount)),
                planned: row.planned,
            };
            let most = scenario.total_budgets().most(amount);
            line.push(format!("up to {} hops, over the distinct commands of every hop", of.front_hops_max));
            return Some(draw_front(&FrontFigure {
                caption: Caption::new(title(&format!("Hops against {}", amount.words()), scenario), line.join(", ")),
                points: front.iter().map(point).collect(),
                against: FrontAgainst::Total {
                    words: amount.words(),
                    unit: amount.unit(),
                    most: Some(most).filter(|most| most.is_finite()),
                },
            }));
        }
        line.extend(
            front
                .first()
                .and_then(|first| first.success)
                .map(|first| format!("each path estimated by {} fixed trials, policy {}", first.trials, first.policy)),
        );
        let point = |row: &crate::report::FrontRecord| {
            let success = row.success?;
            let [low, high] = success.success_estimated_ci95;
            let value = FrontValue::Success(Success { rate: success.success_estimated, low, high });
            Some(FrontPoint { hops: row.hops, value, planned: row.planned })
        };
        Some(draw_front(&FrontFigure {
            caption: Caption::new(title("Hops against reliability", scenario), line.join(", ")),
            points: front.iter().filter_map(point).collect(),
            against: FrontAgainst::Success { least: scenario.budget.estimated_success_min },
        }))
    }
}
