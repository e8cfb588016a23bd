//! `chta check` for a scenario with `[mission]`.

use chta::{
    report::{DocumentKind, TargetsAnswer, targets_text},
    study::targets_plan,
};

use crate::cli::{
    Answer, Failure, args::CheckArgs, hints::further_means, load::Loaded, not_for_targets, output, progress::Progress, views::show,
};

/// Says whether all targets can be visited: the plan without its hops.
pub(super) fn run(args: &CheckArgs, loaded: &Loaded) -> Result<Answer, Failure> {
    not_for_targets::refuse(&[
        ("--pairs", args.pairs.is_some(), "checks pairs along a profile"),
        ("--plot", args.plot.is_some(), "draws the hops along a profile (plan --plot draws a mission)"),
        ("--prove", args.prove.prove, "bounds the hops along a profile"),
    ])?;
    let planned = targets_plan(&loaded.case, &Progress::new(args.common.quiet))?;
    output::warn_all(args.common.quiet, &planned.warnings);
    let answer = TargetsAnswer { path: Vec::new(), ..planned.answer.clone() };
    let json = || loaded.document(DocumentKind::PlanTargets, &planned.warnings, &answer);
    show(args.answer.format, || targets_text(&answer, further_means()), json)?;
    Ok(Answer::of(planned.is_traversable()))
}
