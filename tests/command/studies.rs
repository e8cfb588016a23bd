//! The studies of the library give the answers of the command: each function on a shipped scenario against the command's JSON.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{path::Path, sync::Arc};

use assert_cmd::Command;
use chta::{
    chain::csv::StartGoal,
    graph::proof::DEFAULT_BUDGET_CELLS,
    report::{DocumentKind, FrontRecord, TotalsRecord},
    scenario::{Entries, Scenario},
    study::{
        Case, CaseError, CheckError, Commands, ExperimentError, Front, HopError, JourneyEnd, PlanError, PlanOptions, Proof,
        RequireError, Requirement, SimulateOptions, SweptKey, Trade, Trials, Variation, check, check_pairs, compare, experiment,
        hop, plan, require, simulate, trade,
    },
    uncertainty::experiments::{DriftReading, Experiment},
};
use serde::Serialize;
use serde_json::Value;

const SCENARIOS: &str = "data/scenarios";

/// The keys of a shipped scenario, with settings; its title is that of the command.
fn entries(name: &str, settings: &[&str]) -> Entries {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(SCENARIOS).join(format!("{name}.toml"));
    let mut entries = Entries::from_toml(&std::fs::read_to_string(file).unwrap());
    entries.set_default_title(name);
    for setting in settings {
        entries.set("test", setting);
    }
    entries
}

fn base() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(SCENARIOS)
}

fn case(name: &str, settings: &[&str], commands: Commands) -> Case {
    Case::new(Scenario::new(entries(name, settings)).unwrap(), &base(), commands).unwrap()
}

/// The command's answer about a shipped scenario.
fn of_command(command: &str, name: &str, settings: &[&str], more: &[&str]) -> Value {
    let mut run = Command::cargo_bin("chta").unwrap();
    run.current_dir(env!("CARGO_MANIFEST_DIR")).arg(command).arg(format!("{SCENARIOS}/{name}.toml"));
    run.args(more).args(["--quiet", "--format", "json"]);
    for setting in settings {
        run.args(["--set", setting]);
    }
    let output = run.output().unwrap();
    assert!(output.status.code() < Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The document of an answer, as the command names files: relative to the folder of the repository.
fn of_study<T: Serialize>(case: &Case, kind: &str, warnings: &[String], answer: T) -> Value {
    let relative = |path: &Path| {
        let parts = path.strip_prefix(env!("CARGO_MANIFEST_DIR")).unwrap().components().fold(Vec::new(), |mut parts, part| {
            match part.as_os_str().to_str().unwrap() {
                ".." => drop(parts.pop()),
                part => parts.push(part),
            }
            parts
        });
        parts.join("/")
    };
    let kind = DocumentKind::ALL.into_iter().find(|known| known.name() == kind).unwrap();
    let json = case.record(&relative).unwrap().document(kind, warnings, answer).to_json().unwrap();
    serde_json::from_str(&json).unwrap()
}

#[test]
fn hop_check_and_plan_answer_as_the_command() {
    let proof = Some(Proof { budget_cells: 2000 });
    for name in ["simple", "wall", "lunar_rille", "mars_frogbot", "rolling_surely"] {
        let settings: &[&str] = &["hopper.takeoff_angle_step_deg=0.5"];
        for settings in [&[], settings] {
            let exact = case(name, settings, Commands::Exact);
            let hopped = hop(&exact).unwrap();
            let of_hop = of_command("hop", name, settings, &[]);
            // The command also says that it answers for exact commands.
            let mut study = of_study(&exact, "hop", &hopped.warnings, &hopped.answer);
            if !settings.is_empty() {
                study["warnings"] = of_hop["warnings"].clone();
            }
            assert_eq!(study, of_hop, "{name} {settings:?}");
            // A case that was prepared for other commands gives the same answers.
            let own = case(name, settings, Commands::OfTheMachine);
            assert_eq!(hop(&own).unwrap().answer, hopped.answer, "{name} {settings:?}");
            let checked = check(&exact, None, &()).unwrap();
            let answer = checked.answers().next().unwrap();
            assert_eq!(of_study(&own, "check", &checked.warnings, answer), of_command("check", name, settings, &[]), "{name}");
        }
        let case = case(name, &[], Commands::OfTheMachine);
        let planned = plan(&case, PlanOptions { verify: true, estimate: true, ..PlanOptions::default() }, &()).unwrap();
        assert_eq!(
            of_study(&case, "plan", &planned.warnings, &planned.answer),
            of_command("plan", name, &[], &["--verify"]),
            "{name}"
        );
        assert_eq!(planned.answer.verified.is_some(), planned.path.is_some(), "{name}: a path is flown again");
        let (proved, more) = (check(&case, proof, &()).unwrap(), ["--prove", "--budget", "2000"]);
        let answer = proved.answers().next().unwrap();
        assert_eq!(of_study(&case, "check", &proved.warnings, answer), of_command("check", name, &[], &more), "{name}");
        assert!(proved.picture().is_some(), "{name}: what is proved has a picture");
        assert!(planned.picture().unwrap().to_svg().unwrap().starts_with("<svg"), "{name}");
    }
}

#[test]
fn pairs_are_checked_one_by_one() {
    let case = case("simple", &[], Commands::OfTheMachine);
    let (start, goal) = case.ends().unwrap();
    let (from, to) = (start.point.x_m, goal.point.x_m);
    let pair = |start_x_m, goal_x_m| StartGoal { start_x_m, goal_x_m };
    let checked = check_pairs(&case, &[pair(from, to), pair(to, from)], None, &()).unwrap();
    let there = check(&case, None, &()).unwrap();
    assert_eq!(checked.pairs[0].answer.hops, there.pairs[0].answer.hops);
    assert_eq!(checked.pairs.len(), 2);
    let off = check_pairs(&case, &[pair(from, to), pair(from, 1e6)], None, &()).unwrap_err();
    assert!(matches!(off, CheckError::OffChain { pair: 2, which: JourneyEnd::Goal, .. }), "{off}");
}

#[test]
fn simulate_answers_as_the_command() {
    let settings = ["uncertainty.trials=300"];
    for (name, is_flown, is_on_map) in
        [("rolling_surely", true, false), ("mars_crater_field_surely", true, true), ("wall", false, false)]
    {
        for both in [false, true] {
            let case = case(name, &settings, Commands::OfTheMachine);
            let planned = Arc::new(plan(&case, PlanOptions::default(), &()).unwrap());
            let options = SimulateOptions { compare: both, ..SimulateOptions::default() };
            let simulated = simulate(&planned, &options, &mut (), &()).unwrap();
            let more: &[&str] = if both { &["--compare"] } else { &[] };
            let study = of_study(&case, "simulate", &simulated.warnings, &simulated.answer);
            assert_eq!(study, of_command("simulate", name, &settings, more), "{name} {both}");
            assert_eq!(simulated.picture().is_some(), is_flown, "{name}");
            assert_eq!(simulated.landing_map().is_some(), is_on_map, "{name}");
        }
    }
}

#[test]
fn trials_flown_in_parts_give_the_answer_of_the_whole() {
    // No multiple of the batches in which trials are flown and their rates kept.
    let settings = ["uncertainty.trials=2345"];
    for (name, policy) in [("rolling_surely", "open-loop"), ("rolling_surely", "replan"), ("mars_crater_field_surely", "open-loop")]
    {
        let policy = format!("uncertainty.policy={policy}");
        let case = case(name, &[settings[0], &policy], Commands::OfTheMachine);
        let planned = Arc::new(plan(&case, PlanOptions::default(), &()).unwrap());
        let trials = Trials::new(&planned, &SimulateOptions::default());
        let part = |numbers| trials.tally(numbers, &()).unwrap().unwrap();
        // The last part first, and none twice.
        let mut tally = part(1000..2345);
        assert!(tally.merge(&part(900..1100)).is_err(), "{name}: trials 1000 to 1099 were flown twice");
        tally.merge(&part(0..1000)).unwrap();
        let whole = simulate(&planned, &SimulateOptions::default(), &mut (), &()).unwrap();
        let json = |answer| serde_json::to_string(answer).unwrap();
        assert_eq!(json(&trials.answer_of(&tally)), json(&whole.answer), "{name} {policy}");
    }
    let wall = Arc::new(plan(&case("wall", &[], Commands::OfTheMachine), PlanOptions::default(), &()).unwrap());
    assert!(
        Trials::new(&wall, &SimulateOptions::default()).tally(0..10, &()).unwrap().is_none(),
        "nothing is flown without a path"
    );
}

#[test]
fn experiments_answer_as_the_command() {
    let settings = ["uncertainty.trials=200"];
    for which in Experiment::ALL {
        let case = case("rolling_surely", &settings, Commands::OfTheMachine);
        let planned = plan(&case, PlanOptions::default(), &()).unwrap();
        let answer = experiment(&planned, which, DriftReading::default(), &()).unwrap().unwrap();
        let study = of_study(&case, "simulate-experiment", &[], &answer);
        assert_eq!(study, of_command("simulate", "rolling_surely", &settings, &["--experiment", which.name()]));
    }
    let planned = plan(&case("simple", &[], Commands::OfTheMachine), PlanOptions::default(), &()).unwrap();
    let errorless = experiment(&planned, Experiment::Sensitivity, DriftReading::default(), &()).unwrap_err();
    assert!(matches!(errorless, ExperimentError::NoUncertainty { .. }), "{errorless}");
    let wall = plan(&case("wall", &[], Commands::OfTheMachine), PlanOptions::default(), &()).unwrap();
    assert!(experiment(&wall, Experiment::WorstDrift, DriftReading::default(), &()).unwrap().is_none());
}

/// Each row improves on those with fewer hops, and one of them is the path of the plan where the scenario weighs risk.
#[test]
fn fronts_answer_as_the_command_and_improve_strictly() {
    let options = PlanOptions { front: Some(Front::HOPS_RISK), estimate: true, ..PlanOptions::default() };
    // The settings, and whether the plan is a path of the front.
    let cases: [(&[&str], bool); 4] = [
        (&[], true),
        (&["search.risk=\"fewest-hops\""], true),
        (&["search.risk=\"ignored\"", "search.takeoff_angle=\"least-speed\""], false),
        (&["uncertainty.policy=\"replan\"", "search.risk_extra_hops_max=2"], true),
    ];
    for (settings, is_on_it) in cases {
        let case = case("rolling_surely", settings, Commands::OfTheMachine);
        let planned = plan(&case, options, &()).unwrap();
        // The command warns of its settings as well.
        let unwarned = |mut document: Value| {
            document.as_object_mut().unwrap().remove("warnings");
            document
        };
        let study = of_study(&case, "plan", &planned.warnings, &planned.answer);
        let command = of_command("plan", "rolling_surely", settings, &["--front", "hops,risk"]);
        assert_eq!(unwarned(study), unwarned(command), "{settings:?}");
        let front = planned.answer.front.as_deref().unwrap();
        assert!(front.len() > 1, "{settings:?}: {front:?}");
        for pair in front.windows(2) {
            let success = |row: &FrontRecord| row.success.unwrap().success_estimated;
            let improves = pair[0].hops < pair[1].hops && success(&pair[0]) < success(&pair[1]);
            assert!(improves, "{settings:?}: {pair:?}");
        }
        for row in front {
            let success = row.success.unwrap();
            let [low, high] = success.success_estimated_ci95;
            assert!(low <= success.success_estimated && success.success_estimated <= high && success.trials == 512, "{row:?}");
            assert_eq!(success.policy, case.scenario.uncertainty.as_ref().unwrap().policy);
        }
        let chosen: Vec<_> = front.iter().filter(|row| row.planned).collect();
        assert_eq!(chosen.len(), usize::from(is_on_it), "{settings:?}: {front:?}");
        for row in chosen {
            let totals = planned.answer.totals.map(|totals| TotalsRecord { estimate: None, ..totals });
            assert_eq!((Some(row.hops), Some(row.totals)), (planned.answer.check.hops, totals));
        }
        assert_eq!(planned.front_picture().unwrap().unwrap().to_svg().unwrap().matches("estimated success").count(), 1);
    }
    let errorless = plan(&case("simple", &[], Commands::OfTheMachine), options, &()).unwrap_err();
    assert!(matches!(errorless, PlanError::Front(_)) && errorless.to_string().contains("[uncertainty]"), "{errorless}");
    let wall =
        plan(&case("wall", &["uncertainty.takeoff_speed_sigma_fraction=0.1"], Commands::OfTheMachine), options, &()).unwrap();
    assert_eq!((wall.is_traversable(), wall.answer.front.map(|front| front.len())), (false, Some(0)));
}

#[test]
fn require_and_trade_answer_as_the_command() {
    let (name, key) = ("simple_reduced", "hopper.takeoff_speed_max_m_s");
    let requirement = Requirement::new(key, [Some(2.0), Some(8.0)], 0.05, DEFAULT_BUDGET_CELLS / 5, "--set").unwrap();
    let entries = entries(name, &[]);
    let first = Scenario::new(requirement.strongest(&entries)).unwrap();
    let variation = Variation::new(entries.clone(), first, &base()).unwrap();
    let required = require(&variation, &requirement, &()).unwrap();
    let study = of_study(&required.shown, "require", &required.warnings, &required.answer);
    let more = ["--vary", key, "--from", "2", "--to", "8", "--resolution", "0.05"];
    assert_eq!(study, of_command("require", name, &[], &more));
    for (key, range, resolution) in [("hopper.mass_kg", [None; 2], 0.1), (key, [Some(3.0), Some(2.0)], 0.1), (key, [None; 2], 1.5)]
    {
        let refused = Requirement::new(key, range, resolution, 100, "test").unwrap_err();
        let is_named = match refused {
            RequireError::UnknownKey { .. } => key == "hopper.mass_kg",
            RequireError::Range(_) => range[0].is_some(),
            RequireError::Resolution { found } => found == resolution,
            _ => false,
        };
        assert!(is_named, "{key} {range:?} {resolution}");
    }

    let swept = [SweptKey::parse("hopper.takeoff_speed_max_m_s=2:6:3").unwrap()];
    let first = Scenario::new(Trade::first_cell(&entries, &swept, "test").unwrap()).unwrap();
    let variation = Variation::new(entries, first, &base()).unwrap();
    for (proof, more) in [(None, &[][..]), (Some(Proof { budget_cells: DEFAULT_BUDGET_CELLS }), &["--prove"][..])] {
        let traded = trade(&variation, &swept, proof, &()).unwrap();
        let study = of_study(&traded.first, "trade", &traded.warnings, &traded.answer);
        let vary = ["--vary", "hopper.takeoff_speed_max_m_s=2:6:3"];
        assert_eq!(study, of_command("trade", name, &[], &[&vary[..], more].concat()));
        assert!(traded.picture().unwrap().to_svg().unwrap().contains("Fewest hops"));
    }
}

#[test]
fn compare_answers_as_the_command() {
    let [simple, wall] = ["simple", "wall"].map(|name| case(name, &[], Commands::OfTheMachine));
    let files = ["simple", "wall"].map(|name| format!("{SCENARIOS}/{name}.toml"));
    let comparison = compare(&[(&files[0], &simple), (&files[1], &wall)], None, &()).unwrap();
    let command = of_command("compare", "simple", &[], &[&files[1]]);
    assert_eq!(serde_json::to_value(&comparison.answer).unwrap()["compared"], command["compared"]);
    let warnings: Vec<String> =
        comparison.compared.iter().flat_map(chta::study::Compared::<chta::study::Planned>::warnings).collect();
    assert_eq!(serde_json::to_value(warnings).unwrap(), command["warnings"]);
    assert!(comparison.picture().unwrap().to_svg().unwrap().starts_with("<svg"));
}

#[test]
fn what_a_case_lacks_is_named() {
    let chain = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("data/chains/rolling_100.csv");
    let mut keys = Entries::from_toml(
        "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 5\nlanding_speed_max_m_s = 5\n[surface]\nfriction_coefficient = 0.8\n",
    );
    let bare = Scenario::new(keys.clone()).unwrap();
    let error = Case::new(bare, &base(), Commands::Exact).unwrap_err();
    assert!(matches!(error, CaseError::NoTerrain), "{error}");
    keys.set_by_option("test", "terrain", "chain", chain.to_string_lossy().into_owned().into());
    keys.set_by_option("test", "terrain", "start_x_m", 3.0.into());
    let case = Case::new(Scenario::new(keys).unwrap(), &base(), Commands::Exact).unwrap();
    let error = hop(&case).unwrap_err();
    assert!(matches!(error, HopError::Case(CaseError::MissingEnd { which: JourneyEnd::Goal })), "{error}");
}
