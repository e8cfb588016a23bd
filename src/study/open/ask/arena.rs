//! A path of a wheeled jumper among boxes.

#[cfg(feature = "plot")]
use std::path::Path;
use std::path::PathBuf;

use super::super::{AskError, Reply, Wording, draft::read_bounded};
use crate::{
    arena::{Arena, RandomBoxes, RrtStarOptions, random_arena},
    report::{Document, DocumentKind},
    scenario::read_arena,
    study::{ArenaPlanner, checksums, compare_planners, plan_in_arena},
};

/// What is asked of an arena.
#[derive(Clone, Debug)]
pub struct ArenaAsked {
    /// The file (TOML).
    pub file: PathBuf,
    /// Keys that are set, as `table.key=value`; the first text names the setting in problems.
    pub settings: Vec<(String, String)>,
    /// The planner.
    pub planner: ArenaPlanner,
    /// Whether it may jump.
    pub may_jump: bool,
    /// All planners over the same boxes, RRT* with these options.
    pub compare: Option<RrtStarOptions>,
    /// Random boxes in place of those of the file, and their seed.
    pub random: Option<(RandomBoxes, u64)>,
}

/// Plans a path in an arena.
///
/// # Errors
/// [`AskError`]. That there is no path is an answer.
pub fn arena(asked: &ArenaAsked, wording: &Wording) -> Result<Reply, AskError> {
    let ArenaAsked { file, settings, planner, may_jump, compare, random } = asked;
    let name = file.display().to_string();
    let text = read_bounded(file, &name)?;
    let mut arena = read_arena(&name, &text, settings)?;
    if let Some((boxes, seed)) = random {
        arena = Arena::new(random_arena(arena.keys(), boxes, *seed)).map_err(|problems| {
            let told: Vec<_> = problems.into_iter().map(|problem| format!("{}; {}", problem.message, problem.help)).collect();
            AskError::Value { what: "random", found: told.join("; "), expected: "boxes that fit on the floor" }
        })?;
    }
    let mut planned = plan_in_arena(&arena, *planner, *may_jump)?;
    if let Some(options) = compare {
        planned.answer.compared = Some(compare_planners(&arena, *options, *may_jump)?);
    }
    let (scenario, inputs) = (serde_json::to_value(arena.keys())?, checksums(std::slice::from_ref(file), &wording.file_name)?);
    let json = Document::new(DocumentKind::Arena, scenario, inputs, planned.warnings.clone(), &planned.answer).to_json()?;
    let reply = Reply::new(DocumentKind::Arena, json, planned.answer.found);
    #[cfg(feature = "plot")]
    let reply = reply.drawn({
        let title = title_of(file);
        move || Some(planned.picture(&arena, &title))
    });
    Ok(reply)
}

/// The name of an arena in titles.
#[cfg(feature = "plot")]
fn title_of(file: &Path) -> String {
    file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
