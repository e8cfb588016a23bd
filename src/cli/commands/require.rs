//! `chta require`: the least capability with which the goal can be reached.

use chta::{
    graph::{
        Outcome,
        proof::{Bounds, BoundsOptions, CapabilityRange, Until, least_capability},
    },
    path::generate,
    quantity::Angle,
    report::{Document, DocumentKind, GapRecord, HopRecord, RequireAnswer, RequireTry, TotalsRecord, require_text},
    scenario::{Key, Kind},
    study::ask_the_same,
};

use super::search::{proved, use_threads};
use crate::cli::{
    Answer, Failure,
    args::{Format, RequireArgs},
    effects::Purpose,
    inputs,
    load::{EndOptions, Loaded, load},
    output,
    progress::Progress,
    wrong_thing::Role,
};

/// A scenario key that makes a hopper more or less capable, with its default range of values.
#[derive(Clone, Copy)]
struct Capability {
    path: &'static str,
    /// Whether the greater value is the more capable one.
    more_is_more: bool,
    from: f64,
    to: f64,
}

const fn capability(path: &'static str, more_is_more: bool, from: f64, to: f64) -> Capability {
    Capability { path, more_is_more, from, to }
}

/// All keys for which a more capable value never removes a feasible hop.
const CAPABILITIES: [Capability; 12] = [
    capability("hopper.takeoff_speed_max_m_s", true, 0.01, 100.0),
    capability("hopper.landing_speed_max_m_s", true, 0.01, 100.0),
    capability("hopper.clearance_m", false, 0.0, 100.0),
    capability("hopper.takeoff_angle_min_deg", false, -90.0, 90.0),
    capability("hopper.takeoff_angle_max_deg", true, -90.0, 90.0),
    capability("hopper.apex_height_max_m", true, 0.001, 1000.0),
    capability("hopper.flight_time_max_s", true, 0.001, 1000.0),
    capability("hopper.roughness_max_m", true, 0.0, 100.0),
    capability("hopper.takeoff_speed_min_m_s", false, 0.001, 100.0),
    capability("surface.friction_coefficient", true, 0.01, 10.0),
    capability("surface.rest_slope_max_deg", true, 0.0, 90.0),
    capability("body.gravity_m_s2", false, 0.001, 30.0),
];

/// The chain at one value, with its bounds.
struct Tried {
    value: f64,
    loaded: Loaded,
    bounds: Bounds,
}

/// Finds the least capability.
pub(crate) fn run(args: &RequireArgs) -> Result<Answer, Failure> {
    inputs::look_at(
        args.common.input_max_gib,
        &[(Some(&args.journey.chain), Role::Chain), (args.common.scenario.as_deref(), Role::ScenarioOption)],
    )?;
    let (capability, [from, to]) = asked(args)?;
    use_threads(args.answer.threads)?;
    let (mut weakest, strongest) = if capability.more_is_more { (from, to) } else { (to, from) };
    let first = with_value(args, strongest, args.common.quiet)?;
    if let Some(other) = opposite_limit(capability, &first).filter(|_| args.from.is_none() || args.to.is_none()) {
        weakest = other;
    }
    let (from, to) = (weakest.min(strongest), weakest.max(strongest));
    let range = CapabilityRange { weakest, strongest, resolution: args.resolution };
    let ends = first.ends()?;
    if capability.path == "body.gravity_m_s2" && first.scenario.hopper.limits().flight_time_max_s.is_some() {
        return Err(Failure::message(
            "--vary body.gravity_m_s2: less gravity makes hops longer, but hopper.flight_time_max_s then forbids more of them: \
             leave that limit away",
        ));
    }
    let limits = first.scenario.hopper.limits();
    if capability.path == "body.gravity_m_s2" && (limits.takeoff_speed_min_m_s.is_some() || limits.takeoff_speed_levels.is_some()) {
        return Err(Failure::message(
            "--vary body.gravity_m_s2: less gravity makes hops longer, but hopper.takeoff_speed_min_m_s and \
             hopper.takeoff_speed_levels_m_s then forbid the short ones: leave those away",
        ));
    }
    let last = with_value(args, weakest, true)?;
    if ask_the_same((&first.scenario, &first.prepared), (&last.scenario, &last.prepared)) {
        return Err(Failure::message(format!(
            "--vary {}: no value from {from} to {to} changes anything here: the chain's own limits, its friction or the escape speed \
             decide, or the range lies beyond them",
            args.vary
        )));
    }
    let mut tries: Vec<Tried> = Vec::new();
    let mut tried = |value| -> Result<_, Failure> {
        let loaded = with_value(args, value, true)?;
        let options = BoundsOptions {
            budget_cells: args.budget,
            search: loaded.scenario.search.clone(),
            until: Until::Decided,
            explain: false,
        };
        let bounds = proved(&loaded.hop_test(), ends, &options, args.common.quiet)?;
        let verdict = bounds.verdict();
        tries.push(Tried { value, loaded, bounds });
        Ok(verdict)
    };
    // Each proof shows its own.
    let threshold = least_capability(range, &mut tried, &Progress::new(true))?;
    let at = |value: Option<f64>| tries.iter().find(|tried| Some(tried.value) == value);
    let mut answer = RequireAnswer {
        start_x_m: ends.0.point.x_m,
        goal_x_m: ends.1.point.x_m,
        vary: args.vary.clone(),
        unreachable_at: threshold.unreachable_at,
        reachable_at: threshold.reachable_at,
        from,
        to,
        resolution: args.resolution,
        resolution_met: range.is_met(&threshold),
        tries: tries.iter().map(Tried::record).collect(),
        hops: None,
        path: Vec::new(),
        totals: None,
        gap: at(threshold.unreachable_at).map(|tried| tried.gap(args)).transpose()?.flatten(),
    };
    let reached = at(threshold.reachable_at);
    if let Some(tried) = reached {
        tried.add_path(&mut answer);
    }
    // The scenario gets the value that the path needs, so that `chta run` on the result flies that path.
    let shown = reached.map_or(&first, |tried| &tried.loaded);
    output::to_stdout(written(args, (shown, &first), &answer)?.as_bytes())?;
    Ok(if reached.is_some() { Answer::Yes } else { Answer::No })
}

impl Tried {
    fn record(&self) -> RequireTry {
        RequireTry {
            value: self.value,
            verdict: self.bounds.verdict(),
            lower_bound: self.bounds.lower,
            upper_bound: self.bounds.upper(),
        }
    }

    /// What stops the journey here.
    fn gap(&self, args: &RequireArgs) -> Result<Option<GapRecord>, Failure> {
        let search = self.loaded.scenario.search.clone();
        let options = BoundsOptions { budget_cells: args.budget, search, until: Until::Decided, explain: true };
        let bounds = proved(&self.loaded.hop_test(), self.loaded.ends()?, &options, args.common.quiet)?;
        Ok(bounds.gap.as_ref().map(GapRecord::of))
    }

    /// The path found at this value; only its hop count where it has too many hops to list.
    fn add_path(&self, answer: &mut RequireAnswer) {
        let options = &self.loaded.scenario.search;
        if let Outcome::Path { legs, .. } = &self.bounds.answer.outcome {
            let test = self.loaded.hop_test();
            answer.hops = self.bounds.upper();
            if let Ok(path) = generate(&test, legs, options.takeoff, options.split) {
                answer.path = HopRecord::rows(&path, self.loaded.prepared.projection.as_ref());
                answer.totals = Some(TotalsRecord::from(&path.totals));
            }
        }
    }
}

/// The requested key and range.
fn asked(args: &RequireArgs) -> Result<(Capability, [f64; 2]), Failure> {
    let Some(capability) = CAPABILITIES.iter().find(|capability| capability.path == args.vary) else {
        let known: Vec<_> = CAPABILITIES.iter().map(|capability| capability.path).collect();
        return Err(Failure::message(format!(
            "--vary {}: found no key that makes a hopper more capable, expected one of {}",
            args.vary,
            known.join(", ")
        )));
    };
    let (from, to) = (args.from.unwrap_or(capability.from), args.to.unwrap_or(capability.to));
    let key = capability.path.split_once('.').and_then(|(table, name)| Key::find(table, name));
    let (least, greatest) = match key.map(|key| key.kind) {
        Some(Kind::Number { min, max }) => (min, max),
        _ => (0.0, 90.0),
    };
    let in_range = least <= from && from < to && to <= greatest;
    if !in_range {
        return Err(Failure::message(format!(
            "--from and --to: found {from} and {to}, expected the first below the second, both from {least} to {greatest} as {} takes them",
            capability.path
        )));
    }
    if !(args.resolution > 0.0 && args.resolution < 1.0) {
        return Err(Failure::message(format!(
            "--resolution: found {}, expected a share above 0 and below 1, such as 0.001",
            args.resolution
        )));
    }
    Ok((*capability, [from, to]))
}

/// The opposite limit of the machine, which the varied one may not cross.
fn opposite_limit(capability: Capability, loaded: &Loaded) -> Option<f64> {
    let hopper = &loaded.scenario.hopper;
    let other = match capability.path {
        "hopper.takeoff_angle_min_deg" => hopper.limits().takeoff_angle_max,
        "hopper.takeoff_angle_max_deg" => hopper.limits().takeoff_angle_min,
        "hopper.takeoff_speed_min_m_s" => {
            return Some(hopper.limits().takeoff_speed_max_m_s).filter(|greatest| greatest.is_finite());
        }
        "hopper.takeoff_speed_max_m_s" => {
            let highest = hopper.limits().takeoff_speed_levels.map(|levels| levels.highest_m_s());
            let least = [hopper.limits().takeoff_speed_min_m_s, hopper.limits().steps.takeoff_speed_m_s];
            return highest.or(least.into_iter().flatten().reduce(f64::max));
        }
        "hopper.landing_speed_max_m_s" => {
            return hopper.limits().landing.touchdown_speed_m_s().filter(|speed_m_s| *speed_m_s > 0.0);
        }
        _ => None,
    };
    other.map(Angle::written_degrees)
}

/// The chain with the key set to a value.
fn with_value(args: &RequireArgs, value: f64, quiet: bool) -> Result<Loaded, Failure> {
    let mut common = args.common.clone();
    // A named option would override the value.
    match args.vary.as_str() {
        "body.gravity_m_s2" => common.gravity_m_s2 = None,
        "hopper.clearance_m" => common.clearance_m = None,
        _ => {}
    }
    common.set.push(format!("{}={value:?}", args.vary));
    common.quiet = quiet;
    load(
        &args.journey.chain,
        &common,
        Some(&args.search),
        EndOptions::of_path(args.journey.start, args.journey.goal),
        Purpose::Require,
    )
}

/// The answer as text or as one document.
///
/// The warnings are those of the shown value and of the strongest one: a speed limit beyond escape is only in the latter.
fn written(args: &RequireArgs, (loaded, strongest): (&Loaded, &Loaded), answer: &RequireAnswer) -> Result<String, Failure> {
    if args.answer.format == Format::Text {
        return Ok(require_text(answer));
    }
    let warnings = loaded.warnings_with(strongest.prepared.warnings.iter().cloned());
    let document = Document::new(DocumentKind::Require, loaded.document.clone(), loaded.inputs.clone(), warnings, answer.clone());
    Ok(document.on_map(loaded.prepared.projection.as_ref()).to_json()?)
}
