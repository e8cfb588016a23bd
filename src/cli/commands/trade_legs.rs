//! `chta trade` of robots with legs: limb sets and kinds of cones.

use chta::{
    report::DocumentKind,
    study::{LegsTradeQuestion, legs_trade},
};

use crate::cli::{
    Answer, Failure,
    args::TradeArgs,
    load::MeshPlanInput,
    not_on_mesh, output,
    progress::Progress,
    varied_legs::varied,
    views::{Files, Table, Views},
};

/// Answers every row.
pub(super) fn run(args: &TradeArgs, input: &MeshPlanInput) -> Result<Answer, Failure> {
    not_on_mesh::refuse_for_legs(&[
        ("--plot", args.plot.is_some(), "draws a heat map of a number that is varied"),
        ("--prove", args.prove.prove, "bounds the hops along a profile"),
    ])?;
    let (robots, cones) = varied(&args.vary)?;
    let mut table = Table::by_extension(args.output.as_deref())?;
    let question = LegsTradeQuestion { scenario: &input.scenario, base: &input.base, robots, cones };
    let traded = legs_trade(&question, &Progress::new(args.common.quiet)).map_err(|error| Failure::about(&input.mesh, &error))?;
    output::warn_all(args.common.quiet, &traded.warnings);
    let views = Views {
        text: &|| traded.answer.text(),
        json: &|| Ok(input.document(DocumentKind::TradeLegs, &traded.warnings, &traded.answer)?),
        csv: &|out| traded.answer.write_csv(out),
    };
    let mut files = Files::default();
    files.table(&mut table, &views)?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(!args.require_all || traded.answer.is_traversable()))
}
