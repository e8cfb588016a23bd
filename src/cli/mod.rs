//! The command line: arguments, one file per command, messages on the terminal.

mod args;
mod batch_folder;
mod claims;
mod commands;
mod compared;
mod density;
mod effects;
mod failure;
mod fan_outputs;
mod help;
mod hints;
mod inputs;
mod interrupt;
mod landings;
mod load;
mod map_input;
mod map_outputs;
mod not_for_drift;
mod not_for_targets;
mod not_for_travel;
mod not_on_mesh;
mod output;
mod page;
mod pictures;
mod progress;
mod run_folder;
mod sites_input;
mod tallies;
mod threads;
mod trajectory;
mod unanswered;
mod varied_legs;
mod verbose;
mod views;
mod whole_file;
mod wrong_thing;

use std::process::ExitCode;

use args::Command;
pub(crate) use failure::Failure;

/// The exit status of an analysis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Done, and the answer is yes (or the command has no yes-or-no answer).
    Yes,
    /// Done, and the answer is no.
    No,
}

impl Answer {
    /// Yes or no.
    pub(crate) const fn of(is_yes: bool) -> Self {
        if is_yes { Self::Yes } else { Self::No }
    }
}

/// Runs the command line.
pub(crate) fn run() -> ExitCode {
    interrupt::handle();
    let answer = help::parsed().and_then(|args| {
        if args.verbose {
            verbose::begin();
        }
        answer_of(args.command)
    });
    verbose::end();
    let status = match answer {
        Ok(Answer::Yes) => ExitCode::SUCCESS,
        Ok(Answer::No) => ExitCode::from(1),
        // Its files under way are gone with what held them.
        Err(_) if interrupt::is_requested() => ExitCode::from(interrupt::STATUS),
        Err(failure) => {
            failure.tell();
            ExitCode::from(2)
        }
    };
    inputs::forget();
    status
}

/// Runs a command.
fn answer_of(command: Command) -> Result<Answer, Failure> {
    match command {
        Command::Run(args) => commands::run::run(&args),
        Command::Slice(args) => commands::slice::run(&args),
        Command::Fan(args) => commands::fan::run(&args),
        Command::Map(args) => commands::map::run(&args),
        Command::Sites(args) => commands::sites::run(&args),
        Command::Hop(args) => commands::hop::run(&args),
        Command::Check(args) => commands::check::run(&args),
        Command::Plan(args) => commands::plan::run(&args),
        Command::Simulate(args) => commands::simulate::run(&args),
        Command::Require(args) => commands::require::run(&args),
        Command::Trade(args) => commands::trade::run(&args),
        Command::Compare(args) => commands::compare::run(&args),
        Command::Batch(args) => commands::batch::run(&args),
        Command::Report(args) => commands::report::run(&args),
        Command::Stance(args) => commands::stance::run(&args),
        Command::Arena(args) => commands::arena::run(&args),
        Command::Synth(args) => commands::synth::run(&args),
        Command::Bodies => commands::bodies::run(),
        Command::Completions(args) => commands::completions::run(args),
        Command::Man(args) => commands::man::run(&args),
        Command::Schema(args) => commands::schema::run(&args),
    }
}
