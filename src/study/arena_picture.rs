//! The picture of a path among boxes.

use super::arena::ArenaPlanned;
use crate::{
    arena::Arena,
    figure::{ArenaFigure, ArenaPanel, Caption, FigureError, Picture, draw_arena},
};

impl ArenaPlanned {
    /// Draws the path, beside that without jumps where it differs.
    ///
    /// # Errors
    /// As [`draw_arena`].
    pub fn picture(&self, arena: &Arena, name: &str) -> Result<Picture, FigureError> {
        let named = |what: &str, time_s: Option<f64>| match time_s {
            Some(time_s) => format!("{what}: {time_s:.4} s"),
            None => format!("{what}: no path"),
        };
        let what = if self.answer.jumps_allowed { "with jumps" } else { "without jumps" };
        let mut panels =
            vec![ArenaPanel { name: named(what, self.answer.path_time_s), path: self.path.as_ref(), tree: self.tree.as_ref() }];
        let differs = self.answer.jumps.is_none_or(|jumps| jumps > 0) || self.tree.is_some();
        if self.answer.jumps_allowed && differs {
            let name = named("without jumps", self.answer.without_jumps_s);
            panels.push(ArenaPanel { name, path: self.without_jumps.as_ref(), tree: None });
        }
        let by = match (self.answer.planner.as_str(), &self.answer.reading, self.answer.nodes, self.answer.seed) {
            ("grid", Some(reading), ..) => format!("A* over the grid, reading {reading}"),
            ("rrt-star", _, Some(nodes), Some(seed)) => format!("RRT* with {nodes} nodes, seed {seed}"),
            _ => "Optimal over the boxes as drawn".to_owned(),
        };
        let jumper = arena.jumper();
        let robot = format!(
            "Drives {} m/s, turns in {:.4} s/rad, jumps up to {} m in {} s.",
            jumper.speed_m_s, jumper.turn_s_per_rad, jumper.rise_max_m, jumper.jump_time_s
        );
        let bound = match (self.answer.lower_bound_s, self.answer.gap_share, self.answer.planner.as_str()) {
            (Some(_), _, "any-angle") | (None, ..) => String::new(),
            (Some(bound_s), Some(gap), _) => {
                format!(" No path takes less than {bound_s:.4} s: this one is {:.2} % above.", 100.0 * gap)
            }
            (Some(bound_s), None, _) => format!(" No path takes less than {bound_s:.4} s."),
        };
        let caption = Caption::new(name, format!("{by}.{bound} {robot}"));
        draw_arena(&ArenaFigure { caption, arena, panels, lower_bound_s: self.answer.lower_bound_s })
    }
}
