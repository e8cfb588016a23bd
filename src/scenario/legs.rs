//! `[robot]`: a robot with legs, and how its stances are judged.

use std::path::PathBuf;

use super::{Entries, LayerKeys, ProblemKind, read::find};
use crate::{ballistics::stance::ConeKind, ground::StandsUp};

/// A robot with legs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LegsKeys {
    /// Path of the robot file, relative to the scenario's folder; `None`: the hopper is a point or a ball.
    pub file: Option<PathBuf>,
    /// Which cone stands for the sum of those of its feet.
    pub cone: ConeKind,
    /// Which way is up for its trunk.
    pub up: StandsUp,
    /// Headings of its trunk at every node of a map, if the scenario gives their number.
    pub headings: Option<u32>,
}

/// The keys, of which those beside the file need it.
pub(super) fn legs(entries: &mut Entries) -> LegsKeys {
    let keys = LegsKeys {
        file: entries.text("robot", "file").map(PathBuf::from),
        cone: find(&ConeKind::ALL, ConeKind::name, entries.text("robot", "cone")).unwrap_or_default(),
        headings: entries.count("robot", "headings").and_then(|count| u32::try_from(count).ok()),
        up: find(&StandsUp::ALL, StandsUp::name, entries.text("robot", "up")).unwrap_or_default(),
    };
    if keys.file.is_none() {
        for name in ["cone", "up", "headings"] {
            if entries.value("robot", name).is_some() {
                let message = format!("robot.{name} is for robots with legs, and this scenario names none");
                let help = "add robot.file = \"robot.toml\", or remove the key";
                entries.problem(("robot", name), ProblemKind::Misplaced, message, help);
            }
        }
    }
    keys
}

/// Reports what a robot with legs does not do: it takes no time to turn as it walks, visits no targets, leaves no layer for a while, and
/// counts no costs of layers.
pub(super) fn check(entries: &mut Entries, legs: &LegsKeys, (drives, visits): (bool, bool), layers: &[LayerKeys]) {
    if legs.file.is_none() {
        return;
    }
    let turns = entries.number("drive", "turn_s_per_deg").is_some_and(|turn| turn > 0.0);
    let mut refuse = |what: &str, help: &str| {
        let message = format!("robot.file names a robot with legs, which goes from stance to stance, beside {what}");
        entries.problem(("robot", "file"), ProblemKind::Conflict, message, help);
    };
    if drives && turns {
        refuse(
            "drive.turn_s_per_deg, a price of turns between straight lines",
            "remove drive.turn_s_per_deg, or robot.file for a rover that hops",
        );
    }
    if visits {
        refuse("[mission], the targets of a hopper", "remove [mission], or robot.file for a hopper that is a point");
    }
    if let Some(layer) = layers.iter().find(|layer| layer.rule.outage.is_some()) {
        let what = format!("layer.{}, which may be left for a while", layer.rule.name);
        refuse(&what, "remove the keys of the outage, so that the layer holds throughout, or remove robot.file");
    }
    if let Some(layer) = layers.iter().find(|layer| layer.rule.cost.is_some()) {
        let what = format!("layer.{}, which has a cost", layer.rule.name);
        refuse(&what, "remove cost_per_contact, cost_per_m and total_max, or robot.file for a hopper that is a point");
    }
}
