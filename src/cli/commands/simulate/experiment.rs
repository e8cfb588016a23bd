//! `chta simulate --experiment NAME`.

use chta::{
    chain::ConstrainedChain,
    figure::{ConeWidthFigure, LandingErrorFigure, draw_cone_width, draw_landing_errors},
    graph::{self, NodeSet, Outcome, SearchOptions, most_reliable_paths},
    path::{Hop, generate},
    report::{ConeWidthAnswer, Document, DocumentKind, RiskTradeAnswer, RiskTradeRow, TradedPath, WorstDriftAnswer},
    uncertainty::{
        Policy,
        experiments::{CONE_SHARES, DriftExperiment, DriftLaw, DriftReading, Experiment, cone_width, narrowed, worst_drift},
    },
    world::Direction,
};
use serde::Serialize;

use super::{
    super::{plan::Planned, search::search},
    Flyer,
};
use crate::cli::{
    Answer, Failure,
    args::{Format, SimulateArgs},
    hints,
    load::Loaded,
    output,
    progress::Progress,
};

/// Runs an experiment by its name.
pub(super) fn run(args: &SimulateArgs, loaded: &Loaded, name: &str) -> Result<Answer, Failure> {
    let experiment = named(&Experiment::ALL, Experiment::name, name, "--experiment")?;
    let reading =
        args.reading.as_deref().map(|reading| named(&DriftReading::ALL, DriftReading::name, reading, "--reading")).transpose()?;
    refuse_without_effect(args, experiment)?;
    let plot = args.plot.as_deref().map(|path| output::begin_picture("--plot", path)).transpose()?;
    let test = loaded.hop_test();
    let planned = Planned::new(loaded, &test, None, false, args.common.quiet)?;
    let Some(path) = planned.path.as_ref().filter(|path| !path.hops.is_empty()) else {
        return super::no_path(args, loaded, &planned);
    };
    let seed = loaded.scenario.uncertainty.unwrap_or_default().seed;
    let title = loaded.scenario.title.clone().unwrap_or_default();
    let (text, picture) = match experiment {
        Experiment::WorstDrift => {
            let numbers = DriftExperiment::of_the_paper(reading.unwrap_or_default(), seed);
            let landings = worst_drift(test.chain(), &path.hops, &numbers);
            let answer = WorstDriftAnswer::new(&numbers, &landings);
            let picture = draw_landing_errors(&LandingErrorFigure::of_worst_drift(&answer, &title));
            (written(args, loaded, None, answer.text(), answer)?, Some(picture))
        }
        Experiment::ConeWidth => {
            let answer = cone_widths(args, loaded, &path.hops, seed)?;
            let picture = draw_cone_width(&ConeWidthFigure::of(&answer, &title));
            (written(args, loaded, None, answer.text(), answer)?, Some(picture))
        }
        Experiment::RiskTrade => {
            let answer = risk_trade(args, loaded, &planned)?;
            let warning = loaded.scenario.uncertainty.and_then(|keys| keys.warning()).map(str::to_owned);
            if let Some(warning) = &warning {
                output::warn(args.common.quiet, warning);
            }
            (written(args, loaded, warning, answer.text(), answer)?, None)
        }
    };
    if let (Some(file), Some(picture)) = (plot, picture) {
        let encoded = output::encoded(picture, file.path())?;
        output::finish(vec![(file, encoded)])?;
    }
    output::to_stdout(text.as_bytes())?;
    Ok(Answer::Yes)
}

/// The variant with this name, or an error that suggests the nearest.
fn named<T: Copy>(all: &[T], name: fn(T) -> &'static str, given: &str, option: &str) -> Result<T, Failure> {
    all.iter().copied().find(|variant| name(*variant) == given).ok_or_else(|| {
        let names: Vec<_> = all.iter().map(|variant| name(*variant)).collect();
        let near = names.iter().min_by_key(|known| strsim::damerau_levenshtein(given, known)).copied().unwrap_or_default();
        Failure::message(format!("{option}: '{given}' is unknown, expected one of {}; the nearest is {near}", names.join(", ")))
    })
}

/// Refuses options without effect on the experiment.
fn refuse_without_effect(args: &SimulateArgs, experiment: Experiment) -> Result<(), Failure> {
    let trades = experiment == Experiment::RiskTrade;
    let without_effect = [
        ("--output", args.output.is_some()),
        ("--reading", args.reading.is_some() && experiment != Experiment::WorstDrift),
        ("--trials", args.trials.is_some() && !trades),
        ("--policy", args.policy.is_some() && !trades),
        ("--threads", args.answer.threads != 0 && !trades),
        ("--plot", args.plot.is_some() && trades),
    ];
    match without_effect.into_iter().find(|(_, given)| *given) {
        Some((option, _)) => {
            Err(Failure::message(format!("{option} has no effect on the experiment {}: omit it", experiment.name())))
        }
        None => Ok(()),
    }
}

fn written<T: Serialize>(
    args: &SimulateArgs,
    loaded: &Loaded,
    warning: Option<String>,
    text: String,
    answer: T,
) -> Result<String, Failure> {
    match args.answer.format {
        Format::Text => Ok(text),
        Format::Json => {
            let document = Document::new(
                DocumentKind::SimulateExperiment,
                loaded.document.clone(),
                loaded.inputs.clone(),
                loaded.warnings_with(warning),
                answer,
            );
            Ok(document.on_map(loaded.prepared.projection.as_ref()).to_json()?)
        }
    }
}

/// Plans and flies with successively narrower cones, on the same draws.
fn cone_widths(args: &SimulateArgs, loaded: &Loaded, widest: &[Hop], seed: u64) -> Result<ConeWidthAnswer, Failure> {
    let scenario = &loaded.scenario;
    let numbers = DriftExperiment::of_the_paper(DriftReading::default(), seed);
    let reference_m_s = widest.first().map_or(1.0, Hop::horizontal_speed_m_s);
    let mut answer = ConeWidthAnswer::new(&numbers, reference_m_s);
    for share in CONE_SHARES {
        let failed = |error: &(dyn std::error::Error + 'static)| {
            Failure::message(format!("cones at {share} of their width: {}", hints::sentence(error)))
        };
        let geometry = narrowed(&loaded.prepared.chain, share).map_err(|error| failed(&error))?;
        let chain = ConstrainedChain::new(geometry, &scenario.hopper, scenario.body.gravity, &scenario.surface)
            .map_err(|error| failed(&error))?;
        let width_deg = mean_takeoff_width_deg(&chain);
        let test = chta::hop::HopTest::new(chain);
        let (found, _) = search(&test, loaded.ends()?, scenario, args.common.quiet)?;
        let Outcome::Path { legs, .. } = &found.outcome else {
            answer.add_none((share, width_deg));
            continue;
        };
        let path = generate(&test, legs, scenario.search.takeoff, scenario.search.split).map_err(|error| failed(&error))?;
        let [fixed, with_speed] = DriftLaw::ALL.map(|law| cone_width(test.chain(), &path.hops, &numbers, (law, reference_m_s)));
        answer.add((share, width_deg), &path.hops, &fixed, &with_speed);
    }
    Ok(answer)
}

/// Mean width of the segments' take-off cones for travel towards +x, degrees; 0 if no segment has one.
#[expect(clippy::cast_precision_loss, reason = "at most a million segments")]
fn mean_takeoff_width_deg(chain: &ConstrainedChain) -> f64 {
    let stated = chain.segments().iter().filter_map(|segment| segment.stated(Direction::Forward));
    let widths: Vec<f64> =
        stated.map(|line| line.takeoff.angles()).map(|angles| angles.max.degrees() - angles.min.degrees()).collect();
    widths.iter().sum::<f64>() / widths.len().max(1) as f64
}

/// The most reliable path for every number of hops, estimated and flown.
fn risk_trade(args: &SimulateArgs, loaded: &Loaded, planned: &Planned) -> Result<RiskTradeAnswer, Failure> {
    let scenario = &loaded.scenario;
    let Some(keys) = scenario.uncertainty else {
        return Err(Failure::message(
            "--experiment: risk-trade flies trials, but the scenario has no [uncertainty]: add its deviations and goal_tolerance_m",
        ));
    };
    if keys.policy == Policy::Replan {
        return Err(Failure::message(
            "--experiment: risk-trade compares planned paths, but the policy is replan, which does not follow a planned path: add --policy open-loop",
        ));
    }
    let test = loaded.hop_test();
    let (start, goal) = loaded.ends()?;
    let nodes = NodeSet::new(test.chain(), start, goal, planned.found.spacing).map_err(|error| Failure::of(&error))?;
    let progress = Progress::new(args.common.quiet);
    let reliable_paths =
        most_reliable_paths(&test, &nodes, &scenario.search, &scenario.reliability_with(scenario.risk_extra_hops_max), &progress)
            .map_err(|error| Failure::of(&error))?;
    // The path planned without regard to risk, over the same nodes.
    let without_risk = SearchOptions { spacing: Some(planned.found.spacing), ..scenario.search.clone() };
    let found = graph::search(&test, start, goal, &without_risk, &progress).map_err(|error| Failure::of(&error))?;
    let Outcome::Path { legs, .. } = &found.outcome else {
        return Err(Failure::message("there is no nominal path to compare with"));
    };
    let plain = generate(&test, legs, scenario.search.takeoff, scenario.search.split).map_err(|error| Failure::of(&error))?;
    let flyer = Flyer::new(loaded, &test, &plain, &found, std::slice::from_ref(&keys.policy), args.common.quiet)?;
    let options = keys.options();
    let mut rows = vec![RiskTradeRow::new(TradedPath::LeastEffort, plain.hops.len(), None, &flyer.fly_along(&plain, &options)?)];
    for candidate in &reliable_paths {
        let path = generate(&test, &candidate.legs, scenario.search.takeoff, scenario.search.split)
            .map_err(|error| Failure::of(&error))?;
        let summary = flyer.fly_along(&path, &options)?;
        rows.push(RiskTradeRow::new(TradedPath::MostReliable, path.hops.len(), Some(candidate.success), &summary));
    }
    Ok(RiskTradeAnswer { trials: keys.trials, seed: keys.seed, policy: keys.policy, paths: rows })
}
