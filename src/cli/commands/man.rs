//! `chta man`: the manual pages.

use std::fs;

use clap_mangen::Man;

use crate::cli::{
    Answer, Failure,
    args::ManArgs,
    help,
    output::{self, Pending},
};

/// Writes a page for the program and one for each command: all, or none.
pub(crate) fn run(args: &ManArgs) -> Result<Answer, Failure> {
    let folder = &args.output;
    let mut program = help::command().disable_help_subcommand(true);
    // Gives the commands their full names.
    program.build();
    let commands = std::iter::once(program.clone()).chain(program.get_subcommands().cloned());
    let mut pages = Vec::new();
    for command in commands {
        let name = command.get_display_name().unwrap_or("chta").to_owned();
        let mut page = Vec::new();
        Man::new(command)
            .manual("chta manual")
            .render(&mut page)
            .map_err(|error| Failure::message(format!("the page of {name} cannot be made ({error})")))?;
        pages.push((folder.join(name + ".1"), page));
    }
    output::check_folder(folder)?;
    fs::create_dir_all(folder).map_err(|error| {
        Failure::message(format!("{}: cannot be made ({error}): choose a folder that may be written to", folder.display()))
    })?;
    let pending: Result<Vec<_>, Failure> = pages.iter().map(|(path, page)| Ok((Pending::begin(path)?, page.clone()))).collect();
    output::finish(pending?)?;
    Ok(Answer::Yes)
}
