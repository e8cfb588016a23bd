//! Holds the estimates of reliability against what is flown, and prints the tables of docs/validation.md.
//!
//! `cargo run --release --example reliability -- calibration|order|defaults [--chains N] [--dem-journeys N] [--dem FILE=BODY ...]`
//!
//! - `calibration`: the estimate of a hop against 100 000 flights, the estimate of a path against 4000 trials, each policy by itself.
//! - `order`: of two paths of one journey, whether the one estimated as more reliable is flown more reliably.
//! - `defaults`: on the DEMs, whether a scenario that gives its errors and nothing else reaches nine tenths of the best success that any
//!   choice of command, of extra hops and of derating reaches; other choices are looked at where the defaults reach less than 0.9.
//!
//! The same arguments give the same journeys on every machine.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints")]
#![expect(clippy::cast_precision_loss, reason = "counts of journeys and trials are small")]

#[path = "../benches/support/mod.rs"]
mod support;

use std::{error::Error, fs, path::PathBuf, sync::Arc};

use chta::{
    chain::{PolygonalChain, csv::write_chain_csv},
    ground::ContactPoint,
    path::HopPath,
    quantity::MapPoint,
    scenario::{Entries, Scenario, ScenarioProblems},
    study::{Case, Commands, PlanError, PlanOptions, Planned, SimulateOptions, Trials, plan},
    terrain::{MapBounds, read_dem},
    uncertainty::{Mission, Policy, Simulation, TrialOptions},
};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

type Failure = Box<dyn Error>;

/// What the arguments say.
struct Wanted {
    chains: u64,
    dem_journeys: u64,
    dems: Vec<(PathBuf, String)>,
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let question = arguments.next().ok_or("expected calibration, order or defaults")?;
    let mut wanted = Wanted { chains: 300, dem_journeys: 100, dems: Vec::new() };
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{name}: expected a value after it"))?;
        match name.as_str() {
            "--chains" => wanted.chains = value.parse()?,
            "--dem-journeys" => wanted.dem_journeys = value.parse()?,
            "--dem" => {
                let (file, body) = value.split_once('=').ok_or("expected --dem FILE=BODY")?;
                wanted.dems.push((fs::canonicalize(file)?, body.to_owned()));
            }
            _ => return Err(format!("found {name}, expected --chains N, --dem-journeys N or --dem FILE=BODY").into()),
        }
    }
    match question.as_str() {
        "calibration" => calibration(&wanted),
        "order" => order(&wanted),
        "defaults" => defaults(&wanted),
        _ => Err(format!("found {question}, expected calibration, order or defaults").into()),
    }
}

/// A journey as a scenario without its table `[search]`, and the folder of its files.
struct Journey {
    toml: String,
    base: PathBuf,
}

/// Random journeys: first along chains, then over the DEMs by turns.
fn journeys(wanted: &Wanted, of_machine: fn(&mut ChaCha8Rng) -> String) -> Result<Vec<Journey>, Failure> {
    let folder = std::env::temp_dir().join(format!("chta_reliability_{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let mut all = Vec::new();
    for number in 0..wanted.chains {
        let mut random = ChaCha8Rng::seed_from_u64(number);
        let segments = random.random_range(30..120);
        let chain = PolygonalChain::bare(support::long_chain(segments, number))?;
        let file = folder.join(format!("{number}.csv"));
        write_chain_csv(&chain, fs::File::create(&file)?, &[])?;
        let body = ["moon", "mars", "ceres"][random.random_range(0..3)];
        let goal_m = segments as f64 - 1.0;
        let mut toml = format!(
            "[body]\nname = \"{body}\"\n[terrain]\nchain = \"{}\"\nstart_x_m = 1.0\ngoal_x_m = {goal_m:.1}\n",
            file.display()
        );
        toml.push_str(&of_machine(&mut random));
        all.push(Journey { toml, base: folder.clone() });
    }
    for number in 0..wanted.dem_journeys {
        let Some((file, body)) = wanted.dems.get(usize::try_from(number)? % wanted.dems.len().max(1)) else { break };
        let mut random = ChaCha8Rng::seed_from_u64(1_000_000 + number);
        let [start, goal] = straight_slice(&mut random, &read_dem(file)?.bounds());
        let mut toml = format!(
            "[body]\nname = \"{body}\"\n[terrain]\ndem = \"{}\"\naccept_map_scale = true\nstart_m = [{}, {}]\ngoal_m = [{}, {}]\n",
            file.display(),
            start.x,
            start.y,
            goal.x,
            goal.y
        );
        toml.push_str(&of_machine(&mut random));
        all.push(Journey { toml, base: folder.clone() });
    }
    Ok(all)
}

/// A straight line of 50 to 300 m, or as long as the map has room for.
fn straight_slice(random: &mut ChaCha8Rng, bounds: &MapBounds) -> [MapPoint; 2] {
    let mut point = || {
        let share = |random: &mut ChaCha8Rng, from: f64, to: f64| from + (to - from) * random.random_range(0.05..0.95);
        MapPoint::new(share(random, bounds.min.x, bounds.max.x), share(random, bounds.min.y, bounds.max.y))
    };
    loop {
        let [start, goal] = [point(), point()];
        let distance_m = libm::hypot(goal.x - start.x, goal.y - start.y);
        if distance_m < 50.0 {
            continue;
        }
        let share = if distance_m > 300.0 { 300.0 / distance_m } else { 1.0 };
        let goal = MapPoint::new(start.x + share * (goal.x - start.x), start.y + share * (goal.y - start.y));
        return [start, goal];
    }
}

/// A machine with errors of many sizes, some of friction and heights among them, that chooses its commands in any way.
fn any_machine(random: &mut ChaCha8Rng) -> String {
    let takeoff_m_s: f64 = random.random_range(4.0..9.0);
    let mut pick = |choices: &[&'static str]| choices[random.random_range(0..choices.len())];
    let angle = pick(&["least-speed", "mid-range", "least-time", "most-reliable"]);
    let risk = pick(&["ignored", "fewest-hops", "traded"]);
    let landing_m_s = takeoff_m_s + random.random_range(0.0..1.0);
    let friction = random.random_range(0.5..1.0);
    let mut toml = format!(
        "[hopper]\ntakeoff_speed_max_m_s = {takeoff_m_s}\nlanding_speed_max_m_s = {landing_m_s}\n[surface]\nfriction_coefficient = {friction}\n\
         [search]\ntakeoff_angle = \"{angle}\"\nrisk = \"{risk}\"\n[uncertainty]\n"
    );
    let mut sigma = |key: &str, from: f64, to: f64| toml += &one_key(key, random.random_range(from..to));
    sigma("takeoff_speed_sigma_fraction", 0.0, 0.02);
    sigma("takeoff_angle_sigma_deg", 0.0, 1.0);
    sigma("position_sigma_m", 0.0, 0.2);
    sigma("drift_along_sigma_m", 0.0, 0.2);
    sigma("goal_tolerance_m", 0.5, 3.0);
    // A third of the grounds are not as mapped.
    if random.random_range(0..3) == 0 {
        let mut sigma = |key: &str, from: f64, to: f64| toml += &one_key(key, random.random_range(from..to));
        sigma("friction_sigma", 0.0, 0.04);
        sigma("height_sigma_m", 0.001, 0.04);
        sigma("height_correlation_m", 1.0, 3.0);
    }
    toml
}

/// One line of TOML.
fn one_key(key: &str, value: f64) -> String {
    format!("{key} = {value}\n")
}

/// 2 % of speed, 1 degree, 3 m of tolerance, 5 to 8 m/s: the machine of the goal.
fn goal_machine(random: &mut ChaCha8Rng) -> String {
    format!(
        "[hopper]\ntakeoff_speed_max_m_s = {speed}\nlanding_speed_max_m_s = {speed}\n[surface]\nfriction_coefficient = 0.7\n\
         [uncertainty]\ntakeoff_speed_sigma_fraction = 0.02\ntakeoff_angle_sigma_deg = 1.0\ngoal_tolerance_m = 3.0\n",
        speed = random.random_range(5.0..8.0)
    )
}

/// The plan of a journey with more keys; `None` if there is no path, or too many hops to list.
fn planned(journey: &Journey, more: &[(&str, &str, String)]) -> Result<Option<Arc<Planned>>, Failure> {
    let mut table: toml::Table = journey.toml.parse()?;
    for (name, key, value) in more {
        let part = table.entry(*name).or_insert_with(|| toml::Table::new().into()).as_table_mut().ok_or("expected a table")?;
        part.insert((*key).to_owned(), format!("it = {value}").parse::<toml::Table>()?["it"].clone());
    }
    let source = table.to_string();
    let scenario = Scenario::new(Entries::from_toml(&source))
        .map_err(|problems| ScenarioProblems { name: "journey".to_owned(), source: source.clone(), problems }.to_string())?;
    let case = Case::new(scenario, &journey.base, Commands::OfTheMachine)?;
    let options = PlanOptions { estimate: true, ..PlanOptions::default() };
    match plan(&case, options, &()) {
        Ok(planned) => {
            Ok(Some(Arc::new(planned)).filter(|planned| planned.path.as_ref().is_some_and(|path| !path.hops.is_empty())))
        }
        Err(PlanError::TooManyHops(_)) => Ok(None),
        Err(error) => Err(format!("{error}\n{source}").into()),
    }
}

/// The success of a path in trials of its scenario's policy.
fn flown(planned: &Arc<Planned>, trials: u64) -> Result<f64, Failure> {
    let flights = Trials::new(planned, &SimulateOptions::default());
    let tally = flights.tally(0..trials, &())?.ok_or("expected a path")?;
    Ok(tally.summary().success.rate)
}

fn estimated(planned: &Planned) -> Result<f64, Failure> {
    Ok(planned.answer.totals.as_ref().and_then(|totals| totals.estimate).ok_or("expected an estimate")?.success_estimated)
}

/// The share of flights of one planned hop that come to rest.
fn counted(planned: &Planned, hop: usize) -> Result<f64, Failure> {
    let path = planned.path.as_ref().ok_or("expected a path")?;
    let one = HopPath { hops: vec![path.hops[hop]], ..path.clone() };
    let (from, to) = (one.hops[0].takeoff, one.hops[0].landing);
    let mission = if let Some(ground) = planned.dem_ground()? {
        Mission::over_dem(ground, one, from, to)
    } else {
        let station = |at: ContactPoint| at.station.ok_or("expected a station");
        Mission::along_chain(planned.test.clone(), one, station(from)?, station(to)?)
    };
    let errors = planned.case.scenario.uncertainty.clone().unwrap_or_default().errors;
    let options =
        TrialOptions { trials: 100_000, goal_tolerance_m: 1e9, policy: Policy::OpenLoop, seed: 11, ..TrialOptions::default() };
    Ok(Simulation::new(&mission, errors)?.run(&options, &mut (), &())?.success.rate)
}

/// How far an estimate is off, for those whose success is in doubt.
#[derive(Default)]
struct Errors {
    all: usize,
    off: Vec<f64>,
}

impl Errors {
    fn add(&mut self, estimate: f64, flown: f64) {
        self.all += 1;
        if flown > 0.05 && flown < 0.95 {
            self.off.push((estimate - flown).abs());
        }
    }

    /// One row of the table: the sample, the part in doubt, the share of it within a bound, and the greatest error.
    fn row(&self, name: &str, within: f64, needed: f64) -> bool {
        let held = self.off.iter().filter(|off| **off <= within).count();
        let share = held as f64 / self.off.len().max(1) as f64;
        let most = self.off.iter().copied().fold(0.0, f64::max);
        println!("| {name} | {} | {} | {within} | {share:.3} (needed {needed}) | {most:.3} |", self.all, self.off.len());
        share >= needed && 10 * self.off.len() >= 3 * self.all
    }
}

fn calibration(wanted: &Wanted) -> Result<(), Failure> {
    let (mut hops, mut paths) = (Errors::default(), [Errors::default(), Errors::default()]);
    for (number, journey) in journeys(wanted, any_machine)?.iter().enumerate() {
        for (policy, errors) in Policy::ALL.into_iter().zip(&mut paths) {
            let Some(planned) = planned(journey, &[("uncertainty", "policy", format!("{:?}", policy.name()))])? else { continue };
            errors.add(estimated(&planned)?, flown(&planned, 4000)?);
            if policy == Policy::OpenLoop {
                let hop = number % planned.answer.path.len();
                let estimate = planned.answer.path[hop].success_estimated.ok_or("expected an estimate")?;
                hops.add(estimate, counted(&planned, hop)?);
            }
        }
        eprint!("\r{number} ");
    }
    println!(
        "| estimate | sample | with 0.05 < p < 0.95 | bound | share within the bound | greatest error |\n|---|---|---|---|---|---|"
    );
    let mut held = hops.row("hop, by 256 fixed draws", 0.03, 0.99);
    for (policy, errors) in Policy::ALL.into_iter().zip(&paths) {
        held &= errors.row(&format!("path, {}", policy.name()), 0.05, 0.95);
    }
    if held { Ok(()) } else { Err("an estimate is not calibrated, or less than 30 % of a sample is in doubt".into()) }
}

fn order(wanted: &Wanted) -> Result<(), Failure> {
    const TRIALS: u64 = 4000;
    let (mut all, mut right) = (0, 0);
    for journey in journeys(wanted, any_machine)? {
        let of = |risk: &str, angle: &str| {
            planned(&journey, &[("search", "risk", format!("{risk:?}")), ("search", "takeoff_angle", format!("{angle:?}"))])
        };
        let (Some(a), Some(b)) = (of("ignored", "least-speed")?, of("traded", "most-reliable")?) else { continue };
        let (estimates, rates) = ([estimated(&a)?, estimated(&b)?], [flown(&a, TRIALS)?, flown(&b, TRIALS)?]);
        let (more, less) = if estimates[1] >= estimates[0] { (rates[1], rates[0]) } else { (rates[0], rates[1]) };
        let half_width = 1.96 * ((more * (1.0 - more) + less * (1.0 - less)) / TRIALS as f64).sqrt();
        all += 1;
        right += usize::from(more >= less - half_width);
    }
    println!("of two paths the one estimated as more reliable is flown more reliably or equally on {right} of {all} journeys");
    if 100 * right >= 95 * all { Ok(()) } else { Err("expected at least 95 of 100".into()) }
}

fn defaults(wanted: &Wanted) -> Result<(), Failure> {
    const TRIALS: u64 = 1000;
    let (mut attainable, mut reached) = (0, 0);
    println!("| journey | hops | defaults, replanned | best known, replanned | defaults, open loop |\n|---|---|---|---|---|");
    for (number, journey) in journeys(wanted, goal_machine)?.iter().enumerate() {
        let Some(own) = planned(journey, &[])? else { continue };
        let open = planned(journey, &[("uncertainty", "policy", "\"open-loop\"".to_owned())])?;
        let open = open.map(|open| flown(&open, TRIALS)).transpose()?.unwrap_or(0.0);
        let rate = flown(&own, TRIALS)?;
        let mut best = rate;
        for angle in ["least-speed", "mid-range", "least-time", "most-reliable"] {
            for extra in [0, 1, 3, 10] {
                for share in ["1.0", "0.9", "0.8"] {
                    // No success is so great that nine tenths of it are more.
                    if rate >= 0.9 {
                        break;
                    }
                    let risk = if extra == 0 { "fewest-hops" } else { "traded" };
                    let mut keys = vec![("search", "takeoff_angle", format!("{angle:?}")), ("search", "risk", format!("{risk:?}"))];
                    if extra > 0 {
                        keys.push(("search", "risk_extra_hops_max", extra.to_string()));
                    }
                    for limit in ["takeoff_speed", "landing_speed", "friction"] {
                        keys.push(("derating", limit, share.to_owned()));
                    }
                    if let Some(other) = planned(journey, &keys)? {
                        best = f64::max(best, flown(&other, TRIALS)?);
                    }
                }
            }
        }
        println!("| {number} | {} | {rate:.3} | {best:.3} | {open:.3} |", own.answer.path.len());
        if best >= 0.9 {
            attainable += 1;
            reached += usize::from(rate >= 0.9 * best);
        }
    }
    println!(
        "the defaults reach nine tenths of the best known success on {reached} of {attainable} journeys where that is at least 0.9"
    );
    if 100 * reached >= 95 * attainable { Ok(()) } else { Err("expected at least 95 of 100".into()) }
}
