//! A scenario whose heading is not controlled, from the command line.

use chta::study::open::{AskError, OpenDrift};

use super::{EndOptions, OwnKey, apply_options, look_at_keys, read_source, unopened};
use crate::cli::{
    Failure,
    args::{CommonArgs, JourneyArgs, SearchArgs},
    claims, inputs, output, verbose,
    wrong_thing::Role,
};

/// Loads such a scenario with the options beside it; `None` for any other input.
pub(crate) fn load_drift(
    JourneyArgs { chain, start, goal }: &JourneyArgs,
    common: &CommonArgs,
    search: &SearchArgs,
    own: &[OwnKey<'_>],
) -> Result<Option<OpenDrift>, Failure> {
    let input = inputs::open(chain, Role::Chain)?;
    if !input.is_scenario() || common.scenario.is_some() {
        return Ok(None);
    }
    let mut source = read_source(&input)?;
    apply_options(&mut source.entries, common, Some(search), EndOptions::of_path(*start, *goal));
    if !source.entries.ask_for_drift() {
        return Ok(None);
    }
    look_at_keys(&mut source, false)?;
    for (option, table, key, value) in own {
        source.entries.set_by_option(option, table, key, value.clone());
    }
    let open = source.drift().map_err(|error| match error {
        AskError::Open(error) => unopened(error, &format!("{}: ", source.name)),
        other => Failure::of(&other),
    })?;
    if let Some(open) = &open {
        output::warn_all(common.quiet, &open.record.warnings);
        for file in &open.files {
            claims::reads(file);
            verbose::read(file);
        }
    }
    Ok(open)
}
