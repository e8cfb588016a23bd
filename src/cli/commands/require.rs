//! `chta require`: the least capability with which the goal can be reached.

use chta::{
    report::{DocumentKind, require_text},
    study::{RequireError, Required, Requirement, require},
};

use crate::cli::{
    Answer, Failure,
    args::{CommonArgs, RequireArgs},
    effects::Purpose,
    inputs,
    load::load_to_vary,
    output,
    progress::Progress,
    threads,
    views::show,
};

/// Finds the least capability.
pub(crate) fn run(args: &RequireArgs) -> Result<Answer, Failure> {
    inputs::look_at_chain(&args.journey.chain, &args.common)?;
    let requirement = Requirement::new(&args.vary, [args.from, args.to], args.resolution, args.prove_cells_max, "--set")?;
    threads::start(args.answer.threads)?;
    let common = without_option_of(&args.vary, &args.common);
    let to_vary = load_to_vary(&args.journey, &common, &args.search, (Purpose::Require, &args.own_keys()), &|entries| {
        Ok(vec![requirement.strongest(entries)])
    })?;
    to_vary.first.ends()?;
    let required = require(&to_vary.variation, &requirement, &Progress::new(args.common.quiet));
    let Required { shown, shown_entries, answer, warnings } = required.map_err(|error| match error {
        RequireError::Scenario { problems } => to_vary.refused(problems),
        other => other.into(),
    })?;
    // The warnings are those of the shown value and of the strongest one, which were shown when it was loaded: a speed limit beyond escape is
    // only in the latter.
    let known = &to_vary.first.case.prepared.warnings;
    let new: Vec<String> = warnings.iter().filter(|warning| !known.contains(warning)).cloned().collect();
    output::warn_all(args.common.quiet, &new);
    let json = || to_vary.loaded(shown, &shown_entries)?.document(DocumentKind::Require, &warnings, &answer);
    show(args.answer.format, || require_text(&answer), json)?;
    Ok(Answer::of(answer.reachable_at.is_some()))
}

/// The options without the one that would override the varied key.
fn without_option_of(key: &str, common: &CommonArgs) -> CommonArgs {
    let mut common = common.clone();
    match key {
        "body.gravity_m_s2" => common.gravity_m_s2 = None,
        "hopper.clearance_m" => common.clearance_m = None,
        _ => {}
    }
    common
}
