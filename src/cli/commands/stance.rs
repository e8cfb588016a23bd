//! `chta stance`: where a robot with legs stands, and which way it may jump from there.

use chta::{
    report::{StanceAnswer, stance_text},
    study::{StanceQuestion, contacts_of, stand},
};

use crate::cli::{
    Answer, Failure,
    args::StanceArgs,
    load::{contacts_document, load_stance},
    output,
    views::{Files, show},
};

/// Looks for a stance, or cuts the cone of contacts.
pub(crate) fn run(args: &StanceArgs) -> Result<Answer, Failure> {
    let plot = output::begin_picture("--plot", args.plot.as_deref())?;
    let mut files = Files::default();
    if let Some(file) = &args.contacts {
        let cones = contacts_of(file).map_err(|error| Failure::of(&error))?;
        let answer = StanceAnswer::of_contacts(&cones, args.headings);
        files.picture(plot, || Some(chta::study::contacts_picture(&answer)))?;
        files.finish()?;
        show(args.format, || stance_text(&answer), || contacts_document(file, &answer))?;
        return Ok(Answer::of(answer.stands));
    }
    let input = load_stance(args)?;
    let question = StanceQuestion {
        scenario: &input.scenario,
        base: &input.base,
        terrain: &input.terrain,
        robot: input.robot.clone(),
        chains: &input.chains,
        at_m: input.at_m,
        heading_deg: args.heading_deg,
        height_m: args.height_m,
        up: args.up(),
        headings: args.headings,
    };
    let mut stood = stand(&question).map_err(|error| Failure::about(&input.file, &error))?;
    stood.warnings.splice(0..0, input.warnings.iter().cloned());
    files.picture(plot, || Some(stood.picture(&input.scenario)))?;
    files.finish()?;
    output::warn_all(args.quiet, &stood.warnings);
    show(args.format, || stance_text(&stood.answer), || input.document(&stood.warnings, &stood.answer))?;
    Ok(Answer::of(stood.answer.stands))
}
