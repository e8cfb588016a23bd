//! `chta simulate`: its documents, files and refusals, and the results of the experiments.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::path::Path;

use crate::desk::Desk;
use serde_json::Value;

/// Errors that give some trials of every outcome, added to the scenario of the test's folder.
const ERRORS: &str = "\n[uncertainty]\ntakeoff_speed_sigma_fraction = 0.01\ntakeoff_angle_sigma_deg = 0.3\nposition_sigma_m = 0.05\n\
    drift_along_sigma_m = 0.1\ngoal_tolerance_m = 2.0\npolicy = \"open-loop\"\ntrials = 1500\n\
    seed = 4\n";

fn desk() -> Desk {
    let desk = Desk::with_dem();
    for name in ["scenario.toml", "map.toml"] {
        let errors = if name == "map.toml" {
            format!("{ERRORS}heading_sigma_deg = 1.0\ndrift_across_sigma_m = 0.05\n")
        } else {
            ERRORS.to_owned()
        };
        desk.write(name, desk.read(name) + &errors);
    }
    desk
}

fn shipped(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenarios").join(name).to_str().unwrap().to_owned()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn the_document_has_what_interface_md_promises() {
    let desk = desk();
    for scenario in ["scenario.toml", "map.toml"] {
        let document = desk.json(&["simulate", scenario]);
        assert_eq!(document["schema"], "chta/simulate/1");
        assert_eq!((document["trials"].as_u64(), document["seed"].as_u64()), (Some(1500), Some(4)));
        assert_eq!(document["policy"], "open-loop");
        let outcomes = document["outcomes"].as_object().unwrap();
        let names = [
            "reached",
            "missed",
            "slid_at_takeoff",
            "slid_at_landing",
            "damaged",
            "lost",
            "stuck",
            "hop_limit",
            "out_of_propellant",
        ];
        assert_eq!(outcomes.keys().map(String::as_str).collect::<Vec<_>>().len(), names.len());
        assert_eq!(names.iter().map(|name| outcomes[*name].as_u64().unwrap()).sum::<u64>(), 1500, "{scenario}");
        let [low, high] = [0, 1].map(|i| number(&document["success_rate_ci95"][i]));
        let rate = number(&document["success_rate"]);
        assert!(low <= rate && rate <= high && low < high, "{low} {rate} {high}");
        assert!((rate - number(&outcomes["reached"]) / 1500.0).abs() < 1e-15);
        let landings = document["landings"].as_array().unwrap();
        assert_eq!(landings.len() as u64, document["hops"].as_u64().unwrap());
        for (i, landing) in landings.iter().enumerate() {
            assert_eq!(landing["hop"], i + 1);
            let quantiles = ["q05_m", "q25_m", "q50_m", "q75_m", "q95_m", "max_m"].map(|name| landing[name].as_f64());
            assert_eq!(landing["count"].as_u64() == Some(0), quantiles[0].is_none() && landing["mean_m"].is_null(), "{landing}");
            assert!(quantiles.is_sorted(), "{landing}");
            let ellipse = landing.get("ellipse95").is_some();
            assert_eq!(ellipse, scenario == "map.toml" && landing["count"] != 0, "{landing}");
        }
    }
}

#[test]
fn without_errors_every_trial_arrives() {
    let desk = Desk::with_dem();
    for (scenario, policy) in
        [("scenario.toml", "open-loop"), ("scenario.toml", "replan"), ("map.toml", "open-loop"), ("map.toml", "replan")]
    {
        let document = desk.json(&["simulate", scenario, "--trials", "20", "--policy", policy]);
        assert_eq!(document["outcomes"]["reached"], 20, "{scenario} {policy}: {}", document["outcomes"]);
        assert!(document["landings"].as_array().unwrap().iter().all(|landing| landing["max_m"] == 0.0), "{}", document["landings"]);
    }
}

/// Without any errors a success rate of 1 has no meaning; a warning on standard error and in the document says so once.
#[test]
fn trials_without_errors_give_a_warning() {
    let desk = Desk::with_dem();
    desk.write("zeros.toml", desk.read("scenario.toml") + "\n[uncertainty]\ntakeoff_angle_sigma_deg = 0\ntrials = 20\n");
    let warning = "no errors are given, so that every trial flies the plan exactly";
    for scenario in ["scenario.toml", "zeros.toml"] {
        let words = ["simulate", scenario, "--trials", "20"];
        let ran = desk.run(&words);
        assert_eq!((ran.status, ran.stderr.matches(warning).count()), (0, 1), "{}", ran.stderr);
        assert!(ran.stderr.contains("give [uncertainty]"), "{}", ran.stderr);
        let warnings = desk.json(&words)["warnings"].clone();
        assert_eq!(warnings.as_array().unwrap().len(), 1, "{warnings}");
        assert!(warnings[0].as_str().unwrap().starts_with(warning), "{warnings}");
    }
    let ran = desk.run(&["run", "zeros.toml", "-o", "out"]);
    assert_eq!((ran.status, ran.stderr.matches(warning).count()), (0, 1), "{}", ran.stderr);
    let front = desk.run(&["plan", "zeros.toml", "--front", "hops,risk"]);
    assert_eq!((front.status, front.stderr.matches(warning).count()), (0, 1), "{}", front.stderr);
    for set in ["uncertainty.takeoff_angle_sigma_deg=0.1", "uncertainty.friction_sigma=0.01"] {
        let ran = desk.run(&["simulate", "scenario.toml", "--trials", "20", "--set", set]);
        assert!(!ran.stderr.contains(warning) && ran.stderr.contains("goal_tolerance_m is 0 or absent"), "{set}: {}", ran.stderr);
    }
}

/// With replanning, landings are compared with the plan of their own trial, and the landings of one hop belong to different plans.
#[test]
fn the_text_names_the_meaning_of_distances_and_ellipses() {
    let desk = desk();
    let planned = desk.run(&["simulate", "map.toml", "--trials", "50"]).stdout;
    assert!(planned.contains("\ndistance from the planned landing (m)\n") && planned.contains("95 % ellipse"), "{planned}");
    let replanned = desk.run(&["simulate", "map.toml", "--trials", "50", "--policy", "replan"]).stdout;
    assert!(replanned.contains("\ndistance from the landing planned for the hop at its take-off"), "{replanned}");
    assert!(!replanned.contains("ellipse"), "{replanned}");
    // The document keeps the keys of interface.md.
    let document = desk.json(&["simulate", "map.toml", "--trials", "50", "--policy", "replan"]);
    assert!(document["landings"][0]["ellipse95"]["semi_major_m"].as_f64() > Some(0.0), "{document}");
}

#[test]
fn the_same_seed_gives_the_same_bytes_for_any_number_of_threads() {
    let all = |threads: &str| {
        let desk = desk();
        let words = ["--compare", "-o", "landings.csv", "--plot", "trials.svg", "--format", "json", "--threads", threads];
        let runs = ["scenario.toml", "map.toml"].map(|scenario| {
            let ran = desk.run(&[&["simulate", scenario][..], &words].concat());
            assert_eq!(ran.status, 0, "{}", ran.stderr);
            (ran, desk.read("landings.csv"), desk.read("trials.svg"))
        });
        (runs, desk.files().into_keys().collect::<Vec<_>>())
    };
    let one = all("1");
    assert!(one == all("2"), "two threads");
    assert!(one == all("7"), "seven threads");
}

#[test]
fn the_table_of_landings_agrees_with_the_document() {
    let desk = desk();
    for scenario in ["scenario.toml", "map.toml"] {
        let document = desk.json(&["simulate", scenario, "-o", "landings.csv"]);
        let table = desk.read("landings.csv");
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let headers = reader.headers().unwrap().clone();
        let column = |name: &str| headers.iter().position(|header| header == name).unwrap();
        let (hop, error) = (column("hop"), column("error_m"));
        let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
        for landing in document["landings"].as_array().unwrap() {
            let errors: Vec<f64> = rows
                .iter()
                .filter(|row| row[hop].parse::<u64>().ok() == landing["hop"].as_u64() && !row[error].is_empty())
                .map(|row| row[error].parse().unwrap())
                .collect();
            assert_eq!(errors.len() as u64, landing["count"].as_u64().unwrap(), "{scenario}");
            if !errors.is_empty() {
                let count = u32::try_from(errors.len()).unwrap();
                let mean_m = errors.iter().sum::<f64>() / f64::from(count);
                assert!((mean_m - number(&landing["mean_m"])).abs() < 1e-9, "{scenario}: {mean_m} {landing}");
            }
        }
        let ended = rows.iter().filter(|row| !row[column("outcome")].is_empty()).count();
        assert!(ended > 0 && ended <= 1500, "{scenario}: {ended} rows end a trial");
        // To standard output, in place of the text.
        let ran = desk.run(&["simulate", scenario, "-o", "-"]);
        assert_eq!((ran.status, ran.stdout), (0, table));
        assert_eq!(ran.stderr.matches("warning: ").count(), 1, "{}", ran.stderr);
        assert!(ran.stderr.contains("uncertainty.position_sigma_m = 0.05 has no effect"), "{}", ran.stderr);
    }
}

#[test]
fn both_policies_fly_the_same_draws() {
    let desk = desk();
    // A plan that weighs risk weighs that of its policy.
    let plain = ["--set", "search.risk=ignored"];
    let document = desk.json(&[&["simulate", "scenario.toml", "--compare"][..], &plain].concat());
    for (i, policy) in ["open-loop", "replan"].into_iter().enumerate() {
        let alone = desk.json(&[&["simulate", "scenario.toml", "--policy", policy][..], &plain].concat());
        let beside = &document["compare"][i];
        for key in ["policy", "success_rate", "outcomes", "landings", "convergence"] {
            assert_eq!(alone[key], beside[key], "{policy}: {key}");
        }
    }
}

#[test]
fn a_precise_rate_stops_the_trials() {
    let desk = desk();
    let words = ["simulate", "scenario.toml", "--trials", "50000", "--until-half-width", "0.02"];
    let document = desk.json(&words);
    let half_width = |record: &Value| (number(&record["success_rate_ci95"][1]) - number(&record["success_rate_ci95"][0])) / 2.0;
    let trials = document["trials"].as_u64().unwrap();
    assert!(trials < 50_000 && trials.is_multiple_of(1000), "{trials}");
    assert!(half_width(&document) <= 0.02);
    // It stops only after complete batches; the rate is noted earlier too.
    let is_stop = |point: &&Value| point["trials"].as_u64().is_some_and(|trials| trials.is_multiple_of(1000));
    let before: Vec<_> = document["convergence"].as_array().unwrap().iter().filter(is_stop).rev().skip(1).collect();
    assert!(before.iter().all(|point| half_width(point) > 0.02), "it could have stopped before");
}

#[test]
fn invalid_options_are_refused_by_name() {
    let desk = desk();
    let refused = |args: &[&str], parts: &[&str]| desk.refused(&[&["simulate", "scenario.toml"], args].concat(), parts);
    refused(&["--trials", "0"], &["trials is 0", "at least 1"]);
    refused(&["--trials", "-3"], &["trials is -3"]);
    refused(&["--seed", "-1"], &["seed is -1"]);
    refused(&["--policy", "replna"], &["policy", "replna", "open-loop, replan"]);
    refused(&["--until-half-width", "0"], &["--until-half-width is 0", "above 0"]);
    refused(&["--until-half-width", "0.5"], &["below 0.5"]);
    refused(&["--experiment", "worst-drfit"], &["worst-drfit", "the nearest is worst-drift"]);
    refused(&["--experiment", "worst-drift", "--reading", "noise"], &["noise-at-landing"]);
    refused(&["--experiment", "worst-drift", "--trials", "5"], &["--trials has no effect", "worst-drift"]);
    refused(&["--experiment", "risk-trade"], &["risk-trade is now chta plan --front hops,risk"]);
    refused(&["-o", "landings.txt"], &["landings.txt", ".csv", ".parquet"]);
    refused(&["--plot", "trials.gif"], &["trials.gif", ".svg"]);
    refused(&["--plot-map", "landings.svg"], &["--plot-map", "DEM"]);
    refused(&["--set", "uncertainty.height_correlation_m=2"], &["height_correlation_m", "height_sigma_m is 0"]);
    refused(&["--set", "uncertainty.heading_sigma_deg=2"], &["heading_sigma_deg", "chain"]);
    for key in [
        "takeoff_speed_sigma_m_s",
        "takeoff_speed_sigma_fraction",
        "takeoff_angle_sigma_deg",
        "position_sigma_m",
        "drift_along_sigma_m",
    ] {
        refused(&["--set", &format!("uncertainty.{key}=-0.1")], &[key, "-0.1", "from 0"]);
    }
    if !cfg!(feature = "parquet") {
        refused(&["-o", "landings.parquet"], &["--features parquet"]);
    }
}

#[cfg(feature = "parquet")]
#[test]
fn landings_as_parquet_have_the_rows_of_the_table() {
    use parquet::file::reader::{FileReader, SerializedFileReader};

    let desk = desk();
    for name in ["landings.csv", "landings.parquet"] {
        let ran = desk.run(&["simulate", "map.toml", "-o", name]);
        // The scenario is that of both policies.
        let said: Vec<&str> = ran.stderr.lines().filter(|line| !line.contains("uncertainty.position_sigma_m")).collect();
        assert_eq!((ran.status, said), (0, vec![]));
    }
    let table = desk.read("landings.csv");
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1).count();
    let file = std::fs::File::open(desk.path().join("landings.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let metadata = reader.metadata().file_metadata();
    assert_eq!(usize::try_from(metadata.num_rows()).unwrap(), rows);
    let words = metadata.key_value_metadata().unwrap();
    assert!(words.iter().any(|word| word.key == "seed" && word.value.as_deref() == Some("4")), "{words:?}");
}

#[test]
fn without_a_nominal_path_the_status_is_1() {
    let desk = desk();
    let words = ["simulate", "scenario.toml", "--set", "surface.friction_coefficient=0.05"];
    let ran = desk.run(&[&words[..], &["-o", "landings.csv", "--plot", "trials.svg"]].concat());
    assert_eq!(ran.status, 1, "{ran:?}");
    assert!(ran.stdout.contains("no nominal path"), "{}", ran.stdout);
    assert!(!desk.path().join("landings.csv").exists() && !desk.path().join("trials.svg").exists());
    let document = desk.json(&words);
    assert!(document.get("trials").is_none() && document["verdict"] == "no-path-found", "{document}");
}

#[test]
fn a_run_simulates_as_its_scenario_states_and_removes_stale_files() {
    let desk = desk();
    assert_eq!(desk.run(&["run", "map.toml", "-o", "out"]).status, 0);
    let simulation: Value = serde_json::from_str(&desk.read("out/simulation.json")).unwrap();
    let alone = desk.json(&["simulate", "map.toml"]);
    assert_eq!(simulation, alone);
    for picture in ["out/trials.svg", "out/landings.svg"] {
        assert!(desk.read(picture).starts_with("<svg"), "{picture}");
    }
    desk.write("plain.toml", crate::desk::SCENARIO);
    assert_eq!(desk.run(&["run", "plain.toml", "-o", "out"]).status, 0);
    for stale in ["simulation.json", "trials.svg", "landings.svg"] {
        assert!(!desk.path().join("out").join(stale).exists(), "{stale} is of another run");
    }
}

#[test]
fn worst_drift_grows_from_landing_to_landing_under_every_reading() {
    let desk = Desk::new();
    for reading in ["noise-at-landing", "noise-in-flight", "farthest-from-goal"] {
        for seed in ["0", "1", "2"] {
            let words =
                ["simulate", &shipped("paper_76m.toml"), "--experiment", "worst-drift", "--reading", reading, "--seed", seed];
            let document = desk.json(&words);
            let landings = document["landings"].as_array().unwrap();
            assert_eq!(landings.len(), 4, "{reading}");
            assert!(landings.iter().all(|landing| landing["count"] == 100 && landing["lost"] == 0), "{landings:?}");
            let medians: Vec<f64> = landings.iter().map(|landing| number(&landing["q50_m"])).collect();
            assert!(medians.windows(2).all(|two| two[0] < two[1]), "{reading}, seed {seed}: {medians:?}");
        }
        // The first hop has only noise: sigma sqrt(8 / pi) sqrt(0.1) m for the mean in three dimensions, 0.505 m.
        let document = desk.json(&["simulate", &shipped("paper_76m.toml"), "--experiment", "worst-drift"]);
        assert!((number(&document["landings"][0]["mean_m"]) - 0.505).abs() < 0.06);
    }
}

#[test]
fn narrow_cones_lower_the_spread_of_a_landing_and_raise_the_error_at_the_goal() {
    let document = Desk::new().json(&["simulate", &shipped("paper_76m.toml"), "--experiment", "cone-width"]);
    let widths = document["widths"].as_array().unwrap();
    assert_eq!(widths.iter().map(|width| width["hops"].as_u64().unwrap()).collect::<Vec<_>>(), [4, 5, 6, 8, 16]);
    let column = |name: &str| widths.iter().map(|width| number(&width[name])).collect::<Vec<_>>();
    let falls = |numbers: &[f64]| numbers.windows(2).all(|two| two[0] > two[1]);
    let last = |law: &str| widths.iter().map(|width| number(&width[format!("last_landing_{law}")]["q50_m"])).collect::<Vec<_>>();
    assert!(falls(&column("landing_spread_with_speed_m")), "{widths:?}");
    assert!(column("landing_spread_fixed_m").iter().all(|spread| (1.4..1.6).contains(spread)), "{widths:?}");
    for law in ["fixed", "with_speed"] {
        assert!(last(law).windows(2).all(|two| two[0] < two[1]), "{law}: {widths:?}");
    }
}

/// On a chain and over a DEM: for a scenario that weighs risk, replanned trials reach the goal about as often as open-loop
/// trials, and more often than trials replanned without regard to risk. (docs/validation.md says why not always more often.)
#[test]
fn replanning_weighs_risk_as_the_plan_does() {
    for name in ["rolling_surely.toml", "mars_crater_field_surely.toml"] {
        let scenario = shipped(name);
        let flown = |more: &[&str]| {
            let document = Desk::new().json(&[&["simulate", &scenario, "--trials", "400"], more].concat());
            let rates: Vec<_> = [0, 1].map(|i| number(&document["success_rate_ci95"][i])).into();
            (rates[0], rates[1])
        };
        let replanned = flown(&["--policy", "replan"]);
        let blind = flown(&["--policy", "open-loop"]);
        assert!(replanned.1 >= blind.0 - 0.05 && replanned.0 > 0.88, "{name}: {replanned:?} beside {blind:?}");
        if name.starts_with("rolling") {
            let heedless = flown(&["--policy", "replan", "--set", "search.risk=\"ignored\""]);
            assert!(replanned.0 > heedless.1, "{name}: {replanned:?} beside {heedless:?}");
        }
    }
}

/// The ends of the front, flown in trials of another seed: the path of more hops is the more reliable one, as estimated.
#[test]
fn a_more_reliable_path_is_flown_more_reliably() {
    let scenario = shipped("rolling_surely.toml");
    let document = Desk::new().json(&["plan", &scenario, "--front", "hops,risk"]);
    let front = document["front"].as_array().unwrap();
    let flown = |hops: &Value, risk: &str| {
        let settings = [format!("search.risk={risk}"), format!("budget.estimated_success_min={}", hops["success_estimated"])];
        let words = ["simulate", &scenario, "--trials", "1000", "--seed", "5", "--set", &settings[0], "--set", &settings[1]];
        let document = Desk::new().json(&words);
        assert_eq!(document["hops"], hops["hops"]);
        [0, 1].map(|i| number(&document["success_rate_ci95"][i]))
    };
    let (first, last) = (&front[0], front.last().unwrap());
    let (fewest, most) = (flown(first, "fewest-hops"), flown(last, "traded"));
    assert!(fewest[1] < most[0], "{fewest:?} beside {most:?}");
    for (row, [low, high]) in [(first, fewest), (last, most)] {
        let estimate = [0, 1].map(|i| number(&row["success_estimated_ci95"][i]));
        assert!(estimate[0] <= high && low <= estimate[1], "{row} flown {low} to {high}");
    }
}

/// The estimate of a plan is that of its policy, whether or not the choice of the path weighs risk: 512 fixed trials are within 0.06 of the
/// rate of many others. Beside it stands what trials show.
#[test]
fn a_plan_states_the_success_that_trials_then_show() {
    for name in ["rolling_surely.toml", "mars_crater_field_surely.toml"] {
        for policy in ["open-loop", "replan"] {
            for risk in ["ignored", "fewest-hops", "traded"] {
                let (scenario, policy_key, risk_key) =
                    (shipped(name), format!("uncertainty.policy={policy}"), format!("search.risk={risk}"));
                let mut set = vec![scenario.as_str(), "--set", &policy_key, "--set", &risk_key];
                if risk != "traded" && name.starts_with("mars") {
                    continue;
                }
                let desk = Desk::new();
                let planned = desk.json(&[&["plan"][..], &set].concat());
                let estimate = number(&planned["totals"]["success_estimated"]);
                assert_eq!(planned["totals"]["success_policy"], policy, "{name}");
                set.extend(["--trials", "2000"]);
                let flown = number(&desk.json(&[&["simulate"][..], &set].concat())["success_rate"]);
                assert!((estimate - flown).abs() < 0.06, "{name}, {policy}, {risk}: {estimate} beside {flown}");
            }
        }
    }
}

#[test]
fn the_estimate_stands_in_the_answers_of_plan_and_run_beside_what_fewer_hops_cost() {
    let desk = Desk::new();
    let scenario = shipped("rolling_surely.toml");
    let text = desk.run(&["plan", &scenario]).stdout;
    let rows = desk.json(&["plan", &scenario])["surest"].as_array().unwrap().clone();
    let share = |row: &Value| format!("{:.4}", number(&row["estimated_success"]));
    let cost = format!(
        "fewer hops would cost reliability: the most reliable path of {} hops has an estimated success of {}",
        rows[0]["hops"],
        share(&rows[0])
    );
    assert!(text.contains("\nestimated success: ") && text.contains(" under replan, by 512 fixed trials\n"), "{text}");
    assert!(text.contains(&cost), "{text}");
    let run = desk.run(&["run", &scenario, "-o", "out"]).stdout;
    let (estimate, flown) = (run.find("estimated success: ").unwrap(), run.find("trials reach the goal").unwrap());
    assert!(estimate < flown, "{run}");
    // Where nothing can fail, nothing is estimated.
    let plain = desk.json(&["plan", &shipped("paper_76m.toml")]);
    assert!(plain["totals"].get("success_estimated").is_none(), "{plain}");
}
