//! `chta completions`: what a shell needs to complete the command line.

use crate::cli::{Answer, Failure, args::CompletionsArgs, help, output};

/// Prints the script of a shell.
pub(crate) fn run(args: CompletionsArgs) -> Result<Answer, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut help::command(), "chta", &mut script);
    output::to_stdout(&script)?;
    Ok(Answer::Yes)
}
