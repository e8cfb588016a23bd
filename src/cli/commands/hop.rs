//! `chta hop`: one pair, limit by limit.

use chta::{
    graph::{Edge, Leg},
    hop::TakeoffSet,
    path::generate,
    report::{Document, DocumentKind, HopAnswer, hop_text},
    study::{Extremes, constant_gravity_warnings},
};

use super::trajectory;
use crate::cli::{
    Answer, Failure,
    args::{Format, HopArgs},
    effects::Purpose,
    inputs,
    load::{EndOptions, load},
    output,
    wrong_thing::Role,
};

/// Tests one hop.
pub(crate) fn run(args: &HopArgs) -> Result<Answer, Failure> {
    inputs::look_at(
        args.common.input_max_gib,
        &[(Some(&args.chain), Role::Chain), (args.common.scenario.as_deref(), Role::ScenarioOption)],
    )?;
    let loaded = load(&args.chain, &args.common, None, EndOptions::of_hop(args.from, args.to), Purpose::Hop)?;
    let (takeoff, landing) = loaded.ends()?;
    let test = loaded.hop_test();
    let answer = HopAnswer::new(&test, &takeoff, &landing, loaded.scenario.search.takeoff).ok_or_else(|| {
        Failure::message(format!(
            "--from and --to are both x = {} m, expected two different points of the chain",
            takeoff.point.x_m
        ))
    })?;
    if let Some(file) = trajectory::begin(&args.trajectory)? {
        let lofts = test.takeoff_set(&takeoff, &landing).as_ref().and_then(TakeoffSet::lofts);
        let search = &loaded.scenario.search;
        let legs = lofts.map(|lofts| [Leg { takeoff, landing, edge: Edge::Hop(lofts) }]);
        let path =
            legs.map(|legs| generate(&test, &legs, search.takeoff, search.split)).transpose().map_err(|e| Failure::of(&e))?;
        output::finish(trajectory::filled(Some(file), &args.trajectory, path.as_ref(), &loaded)?.into_iter().collect())?;
    }
    let extremes = answer.best.map_or_else(Extremes::default, |best| Extremes {
        range_m: (answer.to_x_m - answer.from_x_m).abs(),
        height_m: best.apex_height_m,
        speed_m_s: best.takeoff_speed_m_s.max(best.landing_speed_m_s),
    });
    let warnings = constant_gravity_warnings(&loaded.scenario.body, extremes);
    for warning in &warnings {
        output::warn(args.common.quiet, warning);
    }
    let warnings = loaded.warnings_with(warnings);
    let projection = loaded.prepared.projection.as_ref();
    let verdict = if answer.feasible { Answer::Yes } else { Answer::No };
    let text = match args.format {
        Format::Text => hop_text(&answer),
        Format::Json => {
            Document::new(DocumentKind::Hop, loaded.document, loaded.inputs, warnings, answer).on_map(projection).to_json()?
        }
    };
    output::to_stdout(text.as_bytes())?;
    Ok(verdict)
}
