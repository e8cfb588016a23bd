//! A path of a wheeled jumper among boxes.

use crate::{
    arena::{
        Arena, ArenaPath, CheckedPath, GrownTree, PathFault, Reading, Refusal, RrtStarOptions, any_angle_path, check_path,
        grid_path, grow_rrt_star, lower_bound,
    },
    report::{ArenaAnswer, ArenaComparedRecord, ArenaFlightRecord, ArenaHistoryRecord, ArenaPointRecord},
};

/// A planner, with what it alone needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ArenaPlanner {
    /// A* over the nodes of the grid.
    Grid(Reading),
    /// The exact optimum over the boxes as drawn.
    AnyAngle,
    /// RRT*.
    RrtStar(RrtStarOptions),
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ArenaError {
    /// The planner does not plan in this arena.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// A path that does not pass the independent check: a defect of this crate.
    #[error("the planned path does not pass its own check: {0}; this is a defect of chta, please report it with the arena")]
    Defect(#[from] PathFault),
}

/// An answer with what its pictures need.
#[derive(Clone, Debug, PartialEq)]
pub struct ArenaPlanned {
    /// The answer.
    pub answer: ArenaAnswer,
    /// The path.
    pub path: Option<ArenaPath>,
    /// The path of the same planner without jumps, where jumps were allowed.
    pub without_jumps: Option<ArenaPath>,
    /// The tree of RRT*.
    pub tree: Option<GrownTree>,
    /// What an analyst should know of the arena.
    pub warnings: Vec<String>,
}

/// Plans a path, checks it independently, and compares it with what no path beats.
///
/// # Errors
/// [`ArenaError`].
pub fn plan_in_arena(arena: &Arena, planner: ArenaPlanner, may_jump: bool) -> Result<ArenaPlanned, ArenaError> {
    let (path, tree) = planner.path(arena, may_jump)?;
    let checked = path.as_ref().map(|path| check_path(arena, path)).transpose()?;
    let without_jumps = if may_jump { planner.path(arena, false)?.0 } else { None };
    let checked_without = without_jumps.as_ref().map(|path| check_path(arena, path)).transpose()?;
    let reading = if let ArenaPlanner::Grid(reading) = planner { reading } else { Reading::R0 };
    let bound = lower_bound(arena, reading, may_jump);
    let bound_s = bound.time_s.is_finite().then_some(bound.time_s);
    // The bound is infinite where not even free choice of place and heading gives a path: that is a proof.
    let stopped_by = if path.is_none() { stopped_by(arena, planner, may_jump)? } else { Vec::new() };
    let time_s = checked.map(|checked| checked.time_s);
    let options = if let ArenaPlanner::RrtStar(options) = planner { Some(options) } else { None };
    let answer = ArenaAnswer {
        planner: planner.name().to_owned(),
        reading: matches!(planner, ArenaPlanner::Grid(_)).then(|| reading.name().to_owned()),
        jumps_allowed: may_jump,
        seed: options.map(|options| options.seed),
        nodes: tree.as_ref().map(|tree| tree.nodes.len() as u64),
        found: path.is_some(),
        proved_unreachable: path.is_none() && bound_s.is_none(),
        stopped_by,
        path_time_s: time_s,
        lower_bound_s: bound_s,
        lower_bound_is_exact: bound.is_exact && bound_s.is_some(),
        gap_share: time_s.zip(bound_s).map(|(time_s, bound_s)| if bound_s > 0.0 { (time_s / bound_s - 1.0).max(0.0) } else { 0.0 }),
        jumps: checked.map(|checked| checked.jumps as u64),
        length_m: checked.map(|checked| checked.length_m),
        turning_deg: checked.map(|checked| checked.turning_rad.to_degrees()),
        energy_j: checked.filter(|_| arena.jumper().has_energy()).map(|CheckedPath { energy_j, .. }| energy_j),
        without_jumps_s: checked_without.map(|checked| checked.time_s),
        flight: flight(arena),
        compared: None,
        path: path.as_ref().map(records).unwrap_or_default(),
        history: tree.as_ref().map(history).unwrap_or_default(),
    };
    Ok(ArenaPlanned { answer, path, without_jumps, tree, warnings: arena.warnings() })
}

/// Puts one arena through all planners, each with jumps and without; a planner that does not plan in this arena has a row with its reason.
///
/// # Errors
/// [`ArenaError::Defect`].
pub fn compare_planners(arena: &Arena, options: RrtStarOptions, may_jump: bool) -> Result<Vec<ArenaComparedRecord>, ArenaError> {
    let [r1, r0] = [Reading::R1, Reading::R0].map(ArenaPlanner::Grid);
    let planners = [ArenaPlanner::AnyAngle, r1, r0, ArenaPlanner::RrtStar(options)];
    planners
        .into_iter()
        .map(|planner| match plan_in_arena(arena, planner, may_jump) {
            Ok(planned) => Ok(ArenaComparedRecord::of(&planned.answer)),
            Err(ArenaError::Refused(refusal)) => Ok(ArenaComparedRecord::refused(planner, &refusal)),
            Err(defect @ ArenaError::Defect(_)) => Err(defect),
        })
        .collect()
}

impl ArenaComparedRecord {
    fn of(answer: &ArenaAnswer) -> Self {
        let saved_s = answer.without_jumps_s.zip(answer.path_time_s).map(|(without_s, time_s)| without_s - time_s);
        Self {
            planner: answer.planner.clone(),
            reading: answer.reading.clone(),
            refused: None,
            path_time_s: answer.path_time_s,
            jumps: answer.jumps,
            length_m: answer.length_m,
            without_jumps_s: answer.without_jumps_s,
            saved_s,
            lower_bound_s: answer.lower_bound_s,
            lower_bound_is_exact: answer.lower_bound_is_exact,
            gap_share: answer.gap_share,
        }
    }

    fn refused(planner: ArenaPlanner, refusal: &Refusal) -> Self {
        let reading = if let ArenaPlanner::Grid(reading) = planner { Some(reading.name().to_owned()) } else { None };
        Self {
            planner: planner.name().to_owned(),
            reading,
            refused: Some(refusal.to_string()),
            path_time_s: None,
            jumps: None,
            length_m: None,
            without_jumps_s: None,
            saved_s: None,
            lower_bound_s: None,
            lower_bound_is_exact: false,
            gap_share: None,
        }
    }
}

impl ArenaPlanner {
    /// Its name in results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grid(_) => "grid",
            Self::AnyAngle => "any-angle",
            Self::RrtStar(_) => "rrt-star",
        }
    }

    fn path(self, arena: &Arena, may_jump: bool) -> Result<(Option<ArenaPath>, Option<GrownTree>), Refusal> {
        Ok(match self {
            Self::Grid(reading) => (grid_path(arena, reading, may_jump)?, None),
            Self::AnyAngle => (any_angle_path(arena, may_jump)?, None),
            Self::RrtStar(options) => {
                let grown = grow_rrt_star(arena, &options, may_jump)?;
                (grown.path.clone(), Some(grown))
            }
        })
    }
}

/// The limits of which each alone stands in the way.
fn stopped_by(arena: &Arena, planner: ArenaPlanner, may_jump: bool) -> Result<Vec<String>, Refusal> {
    let mut found = Vec::new();
    for (key, lifted) in arena.lifted(may_jump) {
        if planner.path(&lifted, may_jump)?.0.is_some() {
            found.push(key.to_owned());
        }
    }
    Ok(found)
}

/// What the flight of a jump reaches.
fn flight(arena: &Arena) -> Option<ArenaFlightRecord> {
    let (flight, landing_past_edge_m) = (arena.jumper().flight?, arena.jumper().ring_m);
    let highest_box_m = flight.highest_box_m(landing_past_edge_m);
    let boxes = arena.boxes().iter().zip(1..);
    Some(ArenaFlightRecord {
        apex_m: flight.apex_m(),
        range_m: flight.range_m(),
        landing_past_edge_m,
        highest_box_m,
        boxes_too_high: boxes.filter(|(one, _)| one.height_m > highest_box_m).map(|(_, number)| number).collect(),
    })
}

fn records(path: &ArenaPath) -> Vec<ArenaPointRecord> {
    let of = |point: &crate::arena::PathPoint| ArenaPointRecord {
        x_m: point.point.x,
        y_m: point.point.y,
        z_m: point.z_m,
        reached_by: ArenaPointRecord::name(point.reached_by),
    };
    path.points.iter().map(of).collect()
}

fn history(tree: &GrownTree) -> Vec<ArenaHistoryRecord> {
    tree.history.iter().map(|(nodes, path_time_s)| ArenaHistoryRecord { nodes: *nodes as u64, path_time_s: *path_time_s }).collect()
}
