//! What lies between the places that a start reaches and those that lead to the goal.

use super::{
    SurfaceNode,
    fewest_hops::FewestHops,
    surface_hops::{Side, SurfaceHops},
};
use crate::{
    graph::RefusalCounts,
    ground::MapPosition,
    progress::{Cancelled, Meter},
};

/// The gap between the places reached from a start and those from which a goal can be reached, over the same nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteGap {
    /// The place nearest to the start from which the goal can be reached.
    pub leads_from: MapPosition,
    /// How many places lead to the goal, itself included.
    pub leading: usize,
    /// The least horizontal distance from a reached place to one that leads to the goal, among the pairs; `None` without pairs.
    pub width_m: Option<f64>,
    /// How many pairs of a reached place and one that leads to the goal are no farther apart than a hop may be by its speeds.
    pub pairs: u64,
    /// Of how many of them the hop was judged: evenly of all, at most [`JUDGED_MAX`](Self::JUDGED_MAX).
    pub judged: u64,
    /// The limits that refuse the hops that were judged.
    pub refusals: RefusalCounts,
    /// How many of them fly over ground without elevation.
    pub without_ground: u64,
}

impl RouteGap {
    /// The most hops that are judged, which takes less than a second.
    pub const JUDGED_MAX: u64 = 20_000;

    /// The gap; `leads_from` is stated with it.
    pub(super) fn between(
        surface: &SurfaceHops<'_>,
        (reached, leading): (&FewestHops, &FewestHops),
        leads_from: MapPosition,
        meter: &Meter<'_>,
    ) -> Result<Self, Cancelled> {
        let mut gap = Self {
            leads_from,
            leading: leading.known,
            width_m: None,
            pairs: 0,
            judged: 0,
            refusals: RefusalCounts::default(),
            without_ground: 0,
        };
        let mut least_m2 = f64::INFINITY;
        each_pair(surface, reached, leading, meter, |[from, to]| {
            gap.pairs += 1;
            least_m2 = least_m2.min((to.at - from.at).norm_squared());
        })?;
        gap.width_m = (gap.pairs > 0).then(|| least_m2.sqrt());
        let every = gap.pairs.div_ceil(Self::JUDGED_MAX).max(1);
        let mut number = 0;
        each_pair(surface, reached, leading, meter, |[from, to]| {
            number += 1;
            if !u64::is_multiple_of(number - 1, every) {
                return;
            }
            gap.judged += 1;
            match surface.by_slice([from, to]) {
                None => gap.without_ground += 1,
                Some(Err(limit)) => gap.refusals.count(limit),
                // On the very edge of a limit the walk may refuse a hop that the slice has.
                Some(Ok(_)) => {}
            }
        })?;
        Ok(gap)
    }
}

/// Visits every pair of a reached place and one that leads to the goal, no farther apart than one hop by its speeds.
fn each_pair(
    surface: &SurfaceHops<'_>,
    reached: &FewestHops,
    leading: &FewestHops,
    meter: &Meter<'_>,
    mut visit: impl FnMut([&MapPosition; 2]),
) -> Result<(), Cancelled> {
    let position = |node: SurfaceNode| surface.position(node);
    for (number, from) in reached.all().filter_map(position).enumerate() {
        meter.check_piece(number)?;
        let reach_m = surface.reach_m(&from, Side::Start);
        for to in surface.about(&from, Side::Start).filter(|node| leading.of(*node).is_some()).filter_map(position) {
            if (to.at - from.at).norm_squared() <= reach_m * reach_m {
                visit([&from, &to]);
            }
        }
    }
    Ok(())
}
