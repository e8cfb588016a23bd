//! The arena of a command line.

use std::fs;

use chta::{
    arena::{Arena, RandomBoxes, random_arena},
    report::{ArenaAnswer, Document, DocumentKind, InputFile},
    scenario::{arena_toml, read_arena},
    study::checksums,
};

use super::relative_name;
use crate::cli::{Failure, args::ArenaArgs, claims, inputs, wrong_thing::Role};

/// An arena, and the file that it was read from.
#[derive(Debug)]
pub(crate) struct ArenaInput {
    /// The arena as used.
    pub(crate) arena: Arena,
    /// The name of the arena.
    pub(crate) name: String,
    inputs: Vec<InputFile>,
}

/// Reads the arena, with the keys that are set and its random boxes.
pub(crate) fn load_arena(args: &ArenaArgs) -> Result<ArenaInput, Failure> {
    let role = Role::Arena;
    inputs::look_at(args.input_max_gib, &[(Some(&args.arena), role)])?;
    let input = inputs::open(&args.arena, role)?;
    claims::reads(&input.file);
    let name = input.given.display().to_string();
    let bytes = fs::read(&input.file).map_err(|error| inputs::unreadable(&args.arena, &error.to_string(), role))?;
    let text = String::from_utf8(bytes).map_err(|_| {
        Failure::message(format!("{name}: this is no text in UTF-8, expected {}: write it as TOML", role.expected()))
    })?;
    let settings: Vec<_> = args.set.iter().map(|assignment| (format!("--set {assignment}"), assignment.clone())).collect();
    let mut arena = read_arena(&name, &text, &settings).map_err(Failure::Scenario)?;
    if let Some(count) = args.random {
        arena = with_random_boxes(&arena, args, count)?;
    }
    let title = input.given.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    Ok(ArenaInput { arena, name: title, inputs: checksums(&[input.file], &relative_name)? })
}

/// The arena with random boxes.
fn with_random_boxes(arena: &Arena, args: &ArenaArgs, count: u64) -> Result<Arena, Failure> {
    let usual = RandomBoxes::default();
    let is_sized = args.random_sizes_m.iter().all(|size_m| *size_m > 0.0 && *size_m <= 1e6);
    if !is_sized {
        return Err(Failure::message("--random-sizes-m: found a length that is not above 0, expected sides such as 1,3,6"));
    }
    let sizes_m = if args.random_sizes_m.is_empty() { usual.sizes_m } else { args.random_sizes_m.clone() };
    let boxes = RandomBoxes { count: usize::try_from(count).unwrap_or(usize::MAX), sizes_m, ..usual };
    let keys = random_arena(arena.keys(), &boxes, args.seed.unwrap_or(1));
    Arena::new(keys).map_err(|problems| {
        let told = problems.into_iter().map(|problem| format!("{}; {}", problem.message, problem.help));
        Failure::message(format!("--random: {}", told.collect::<Vec<_>>().join("; ")))
    })
}

impl ArenaInput {
    /// The arena as TOML.
    pub(crate) fn toml(&self) -> Result<String, Failure> {
        arena_toml(self.arena.keys()).map_err(|error| Failure::message(format!("the arena cannot be written as TOML ({error})")))
    }

    /// The document of an answer.
    pub(crate) fn document(&self, answer: &ArenaAnswer, warnings: &[String]) -> Result<String, Failure> {
        let scenario = serde_json::to_value(self.arena.keys())?;
        Ok(Document::new(DocumentKind::Arena, scenario, self.inputs.clone(), warnings.to_vec(), answer).to_json()?)
    }
}
