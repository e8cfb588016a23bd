//! Random arenas from a seed.

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

use super::{ArenaKeys, BoxKeys};

/// How boxes are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomBoxes {
    /// How many there are.
    pub count: usize,
    /// The lengths of their sides, m: each box is a square of one of them.
    pub sizes_m: Vec<f64>,
    /// The steps of their heights, m.
    pub height_step_m: f64,
    /// The greatest number of these steps; the least is 1.
    pub height_steps_max: u32,
}

impl Default for RandomBoxes {
    /// Fifteen boxes of 1, 3 or 6 m that are 0.2 to 1.6 m high.
    fn default() -> Self {
        Self { count: 15, sizes_m: vec![1.0, 3.0, 6.0], height_step_m: 0.2, height_steps_max: 8 }
    }
}

/// An arena with these keys and random boxes in place of its own: lower left corners on the nodes of its grid, boxes that reach over the border of
/// the floor, none over start or goal. The same seed gives the same boxes.
///
/// A box that finds no place in a thousand draws is left out.
pub fn random_arena(keys: &ArenaKeys, boxes: &RandomBoxes, seed: u64) -> ArenaKeys {
    const DRAWS: usize = 1_000;
    let mut source = ChaCha8Rng::seed_from_u64(seed);
    let mut below = |count: u64| source.random_range(0..count.max(1));
    let spacing_m = keys.grid.spacing_m;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of nodes, saturating")]
    let nodes = keys.arena.size_m.map(|size_m| (size_m / spacing_m).round() as u64);
    let mut found = ArenaKeys { boxes: Vec::new(), ..keys.clone() };
    for _ in 0..boxes.count {
        for _ in 0..DRAWS {
            #[expect(clippy::cast_possible_truncation, reason = "a number of sizes")]
            let size_m = boxes.sizes_m.get(below(boxes.sizes_m.len() as u64) as usize).copied().unwrap_or(1.0);
            #[expect(clippy::cast_precision_loss, reason = "a count of nodes or steps")]
            let centre_m = nodes.map(|nodes| rounded(below(nodes) as f64 * spacing_m + 0.5 * size_m));
            #[expect(clippy::cast_precision_loss, reason = "a count of nodes or steps")]
            let height_m = rounded((1 + below(boxes.height_steps_max.into())) as f64 * boxes.height_step_m);
            let one = BoxKeys { centre_m, size_m: [size_m; 2], height_m };
            if is_clear(&found, &one) {
                found.boxes.push(one);
                break;
            }
        }
    }
    found
}

/// Whether a box keeps a spacing of the grid away from start and goal.
fn is_clear(keys: &ArenaKeys, one: &BoxKeys) -> bool {
    [keys.arena.start_m, keys.arena.goal_m].into_iter().all(|end| {
        let reach_m = 0.5 * one.size_m[0] + keys.arena.inflation_m + keys.grid.spacing_m;
        end.iter().zip(one.centre_m).any(|(at, centre_m)| (at - centre_m).abs() >= reach_m)
    })
}

/// To the nearest nanometre, so that files have short numbers.
fn rounded(at_m: f64) -> f64 {
    (at_m * 1e9).round() / 1e9
}
