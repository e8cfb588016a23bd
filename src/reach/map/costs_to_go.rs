//! The costs-to-go of all posts, for replanning over a map.

use super::{Journey, MapError, Post, PostHops, Search, search};
use crate::{
    ballistics::TakeoffChoice,
    graph::{Effort, PostCosts},
    progress::Progress,
};

/// The cost of the cheapest path from every post to a goal: the fewest hops, then the least effort, by the hop tests of the map.
///
/// The goal counts also where the ground under it refuses every contact; then no other post has a cost.
///
/// # Errors
/// [`MapError`].
///
/// # Complexity
/// That of a [`search`] with an effort against the direction of the hops; [`PostCosts`] keeps 10 bytes for each post.
pub fn costs_to_go(
    hops: &PostHops,
    goal: Post,
    (effort, takeoff): (Effort, TakeoffChoice),
    progress: &dyn Progress,
) -> Result<PostCosts, MapError> {
    let asked = Search { journey: Journey::Return, effort: Some((effort, takeoff)), hops_max: None };
    let map = search(hops, &[goal.into()], asked, progress)?;
    PostCosts::new(hops.lattice(), (map.hops, map.effort), (effort, takeoff))
}
