//! `chta trade` of robots with legs: limb sets and kinds of cones.

use std::path::PathBuf;

use chta::{
    ballistics::stance::ConeKind,
    report::DocumentKind,
    study::{LegsTradeQuestion, legs_trade},
};

use crate::cli::{
    Answer, Failure,
    args::TradeArgs,
    load::MeshPlanInput,
    not_on_mesh, output,
    progress::Progress,
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
        json: &|| input.document(DocumentKind::TradeLegs, &traded.warnings, &traded.answer),
        csv: &|out| traded.answer.write_csv(out),
    };
    let mut files = Files::default();
    files.table(&mut table, &views)?;
    files.finish()?;
    views.show(args.answer.format, table.to_stdout)?;
    Ok(Answer::of(!args.require_all || traded.answer.is_traversable()))
}

/// The robot files and the cones of the options.
fn varied(given: &[String]) -> Result<(Vec<PathBuf>, Vec<ConeKind>), Failure> {
    let (mut robots, mut cones) = (Vec::new(), Vec::new());
    for text in given {
        let (key, values) = text.split_once('=').unwrap_or((text, ""));
        let values: Vec<&str> = values.split(',').map(str::trim).filter(|value| !value.is_empty()).collect();
        let names = ConeKind::ALL.map(ConeKind::name).join(",");
        match key.trim() {
            "robot.file" if !values.is_empty() && robots.is_empty() => robots.extend(values.iter().map(PathBuf::from)),
            "robot.cone" if !values.is_empty() && cones.is_empty() => {
                for value in values {
                    let kind = ConeKind::ALL.into_iter().find(|kind| kind.name() == value);
                    let wrong = || Failure::message(format!("--vary {text}: found the cone `{value}`, expected one of {names}"));
                    cones.push(kind.ok_or_else(wrong)?);
                }
            }
            _ => {
                return Err(Failure::message(format!(
                    "--vary {text}: expected robot.cone={names} or robot.file=FILE,FILE, each once, for a scenario of a robot with legs; its numbers \
                     are varied one by one, with --set"
                )));
            }
        }
    }
    Ok((robots, cones))
}
