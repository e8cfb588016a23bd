//! The commands that set up a shell: completions and manual pages.

use std::path::PathBuf;

use clap::Args as ClapArgs;
use clap_complete::Shell;

/// Print a script that completes commands, options and their values in a shell
#[derive(Clone, Copy, Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta completions bash")]
pub(crate) struct CompletionsArgs {
    /// Shell that reads the script
    #[arg(value_name = "SHELL", value_enum)]
    pub(crate) shell: Shell,
}

/// Write the manual pages, one for each command
#[derive(Clone, Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta man -o man/man1")]
pub(crate) struct ManArgs {
    /// Folder to write chta.1, chta-run.1, ... into; it is created if need be
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
}

/// Print the JSON schema of a scenario or of an answer, or list their kinds
#[derive(Debug, ClapArgs)]
#[command(after_help = "Example:\n  chta schema plan")]
pub(crate) struct SchemaArgs {
    /// scenario, or the kind of an answer; absent: list them
    #[arg(value_name = "KIND")]
    pub(crate) kind: Option<String>,
}
