//! Several scenarios loaded and planned one by one; one that fails does not end the others.

use std::path::Path;

use chta::{
    figure::{FigureError, Picture, SeenFrom},
    report::{CompareAnswer, CompareRow},
    study::{
        CaseRecord, Compared, Comparison, MeshRouteQuestion, MeshRouted, PlanOptions, Planned, TargetsPlanned, TravelOptions,
        TravelPlanned, comparison_document, mesh_route, plan, targets_plan, travel_plan,
    },
};

use super::{
    Failure,
    args::{CommonArgs, CompareArgs},
    effects::Purpose,
    interrupt,
    load::{EndOptions, Loaded, MeshPlanInput, drives, is_over_mesh, load_mesh_scenario, load_scenario, relative_name, visits},
    not_for_targets, not_for_travel, not_on_mesh, output,
    progress::Progress,
    wrong_thing::Role,
};

/// Scenarios side by side, with what was loaded for those with an answer.
#[derive(Debug)]
pub(crate) enum AnyComparison {
    /// Along chains.
    Chains(Vec<Loaded>, Comparison<Planned>),
    /// Over one mesh.
    Mesh(Vec<MeshPlanInput>, Comparison<MeshRouted>),
    /// Missions that drive.
    Travel(Vec<Loaded>, Comparison<TravelPlanned>),
    /// Missions over targets.
    Targets(Vec<Loaded>, Comparison<TargetsPlanned>),
}

impl AnyComparison {
    /// The answer as plain data.
    pub(crate) const fn answer(&self) -> &CompareAnswer {
        match self {
            Self::Chains(_, comparison) => &comparison.answer,
            Self::Mesh(_, comparison) => &comparison.answer,
            Self::Travel(_, comparison) => &comparison.answer,
            Self::Targets(_, comparison) => &comparison.answer,
        }
    }

    /// The answer as one document.
    pub(crate) fn document(&self) -> Result<String, Failure> {
        let (records, warnings): (Vec<&CaseRecord>, Vec<String>) = match self {
            Self::Chains(loaded, comparison) => (
                loaded.iter().map(|one| &one.record).collect(),
                comparison.compared.iter().flat_map(Compared::<Planned>::warnings).collect(),
            ),
            Self::Mesh(inputs, comparison) => (
                inputs.iter().map(|input| &input.record).collect(),
                comparison.compared.iter().flat_map(Compared::<MeshRouted>::warnings).collect(),
            ),
            Self::Travel(loaded, comparison) => (
                loaded.iter().map(|one| &one.record).collect(),
                comparison.compared.iter().flat_map(Compared::<TravelPlanned>::warnings).collect(),
            ),
            Self::Targets(loaded, comparison) => (
                loaded.iter().map(|one| &one.record).collect(),
                comparison.compared.iter().flat_map(Compared::<TargetsPlanned>::warnings).collect(),
            ),
        };
        Ok(comparison_document(&records, warnings, self.answer())?)
    }

    /// The picture with all paths overlaid.
    pub(crate) fn picture(&self, seen_from: SeenFrom) -> Result<Picture, FigureError> {
        match self {
            Self::Travel(..) | Self::Targets(..) => {
                Err(FigureError::NoGround { what: "a comparison of missions".to_owned(), points: 0 })
            }
            Self::Chains(_, comparison) => comparison.picture(),
            Self::Mesh(_, comparison) => comparison.picture(seen_from),
        }
    }
}

/// Loads and plans all scenarios, with a row for each.
///
/// A scenario that fails has a row with its error. What is at fault in the options, or in every scenario, is a failure.
pub(crate) fn compare_all(args: &CompareArgs) -> Result<AnyComparison, Failure> {
    // All are over a mesh, or none is.
    let over_mesh = args.scenarios.first().is_some_and(|file| is_over_mesh(file, &common(args)).unwrap_or(false));
    if !over_mesh {
        args.view.without_mesh()?;
        if args.scenarios.first().is_some_and(|file| drives(file, &common(args))) {
            not_for_travel::refuse(&[
                ("--prove", args.prove.prove, "bounds the hops along a profile"),
                ("--plot", args.plot.is_some(), "draws hops over one another (chta plan --plot draws each mission)"),
            ])?;
            let (loaded, cases) = each(args, compared_travel)?;
            return Ok(AnyComparison::Travel(loaded, Comparison::of(cases)));
        }
        if args.scenarios.first().is_some_and(|file| visits(file, &common(args))) {
            not_for_targets::refuse(&[
                ("--prove", args.prove.prove, "bounds the hops along a profile"),
                ("--plot", args.plot.is_some(), "draws hops over one another (chta plan --plot draws each mission)"),
            ])?;
            let (loaded, cases) = each(args, compared_targets)?;
            return Ok(AnyComparison::Targets(loaded, Comparison::of(cases)));
        }
        let (loaded, cases) = each(args, compared)?;
        return Ok(AnyComparison::Chains(loaded, Comparison::of(cases)));
    }
    not_on_mesh::refuse(&[("--prove", args.prove.prove, "bounds the hops along a profile")])?;
    let (inputs, cases) = each(args, compared_over_mesh)?;
    let comparison = Comparison::of(cases);
    match (comparison.other_mesh(), &args.plot) {
        (Some(other), Some(_)) => Err(Failure::message(format!(
            "--plot: found another mesh in {other} than in {}, expected scenarios over one mesh, whose paths are drawn over one another: leave the \
             option out, or compare scenarios over one mesh",
            args.scenarios[0].display()
        ))),
        _ => Ok(AnyComparison::Mesh(inputs, comparison)),
    }
}

/// What was loaded for scenarios with an answer, and the answer or the row of every one.
type Cases<L, C> = (Vec<L>, Vec<Result<C, CompareRow>>);

/// Plans scenario after scenario: what was loaded for those with an answer, and a row for each of the others.
fn each<L, C>(
    args: &CompareArgs,
    plan_one: impl Fn(&Path, &CompareArgs) -> Result<(L, C), Failure>,
) -> Result<Cases<L, C>, Failure> {
    let (mut all, mut cases, mut first_failure) = (Vec::new(), Vec::new(), None);
    for file in &args.scenarios {
        match plan_one(file, args) {
            Ok((loaded, one)) => {
                all.push(loaded);
                cases.push(Ok(one));
            }
            Err(failure) if failure.is_of_option() || interrupt::is_requested() => return Err(failure),
            Err(failure) => {
                cases.push(Err(CompareRow::failed(relative_name(file), file.display().to_string(), failure.sentence())));
                first_failure = first_failure.or(Some(failure));
            }
        }
    }
    match first_failure {
        Some(failure) if all.is_empty() => Err(failure),
        _ => Ok((all, cases)),
    }
}

/// The options of the scenarios.
fn common(args: &CompareArgs) -> CommonArgs {
    CommonArgs::of_scenarios(&args.set, args.accept_map_scale, args.input_max_gib, args.quiet)
}

/// Loads and plans one scenario.
fn compared(file: &Path, args: &CompareArgs) -> Result<(Loaded, Compared<Planned>), Failure> {
    let loaded = load_scenario(file, &common(args), Purpose::Compare)?;
    loaded.ends()?;
    let options = PlanOptions { proof: args.prove.proof(), ..PlanOptions::default() };
    let planned = plan(&loaded.case, options, &Progress::new(args.quiet))?;
    output::warn_all(args.quiet, &planned.warnings);
    Ok((loaded, Compared::<Planned>::of(planned, relative_name(file), &file.display().to_string())))
}

/// Loads and plans one scenario that drives.
fn compared_travel(file: &Path, args: &CompareArgs) -> Result<(Loaded, Compared<TravelPlanned>), Failure> {
    let loaded = load_scenario(file, &common(args), Purpose::Compare)?;
    loaded.ends()?;
    let planned = travel_plan(&loaded.case, TravelOptions::default(), &Progress::new(args.quiet))?;
    output::warn_all(args.quiet, &planned.warnings);
    Ok((loaded, Compared::<TravelPlanned>::of(planned, relative_name(file), &file.display().to_string())))
}

/// Loads and plans one mission over targets.
fn compared_targets(file: &Path, args: &CompareArgs) -> Result<(Loaded, Compared<TargetsPlanned>), Failure> {
    let loaded = load_scenario(file, &common(args), Purpose::Compare)?;
    loaded.ends()?;
    let planned = targets_plan(&loaded.case, &Progress::new(args.quiet))?;
    output::warn_all(args.quiet, &planned.warnings);
    Ok((loaded, Compared::<TargetsPlanned>::of(planned, relative_name(file), &file.display().to_string())))
}

/// Loads and plans one scenario over a mesh.
fn compared_over_mesh(file: &Path, args: &CompareArgs) -> Result<(MeshPlanInput, Compared<MeshRouted>), Failure> {
    let options = (None, EndOptions::NONE);
    let input = load_mesh_scenario((file, Role::Scenario), &common(args), options, Purpose::Compare, &[])?;
    let input = input.ok_or_else(|| {
        Failure::message(format!(
            "{}: found no free route over a mesh, expected one as in {}: compare scenarios over one mesh, or none over a mesh",
            file.display(),
            args.scenarios[0].display()
        ))
    })?;
    let question = MeshRouteQuestion { scenario: &input.scenario, base: &input.base, front: None, roadmap: None };
    let routed = mesh_route(&question, &Progress::new(args.quiet)).map_err(|error| Failure::about(&input.mesh, &error))?;
    output::warn_all(args.quiet, &routed.warnings);
    let one = Compared::<MeshRouted>::of(routed, &input.scenario, relative_name(file), &file.display().to_string());
    Ok((input, one))
}
