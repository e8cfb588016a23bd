//! The answer of a hop map, as plain data and text.

use std::fmt::Write as _;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    AmountRecord, DeratingRecord, HopRecord, PropellantShortage, SimulationRecord, TotalsRecord, propellant_record::stores_lines,
    stated::stated, text::hops_bound,
};
use crate::{
    graph::{Effort, EffortUnit},
    planner::Amount,
    quantity::MapPoint,
    reach::map::{HopMap, Mobility, NO_GROUND, NOT_SEARCHED, NodeLattice, Post, SECTORS},
    terrain::Dem,
};

/// The answer of `chta map`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapAnswer {
    /// Every `stride`-th post of the DEM is a post of the map.
    pub stride: usize,
    /// Nodes for each post spacing, where the nodes of the map are finer than the posts; what is said of posts is then said of nodes.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub nodes_per_post: usize,
    /// Posts of the map.
    pub posts: usize,
    /// Of these, posts without elevation.
    pub no_data_posts: usize,
    /// The post of the first start; [0, 0] for a map without a start, which has single hops alone.
    pub start_m: [f64; 2],
    /// Its distance from the requested position.
    pub start_offset_m: f64,
    /// All starts, in the order given. Each post is reached from the nearest of them: by the fewest hops, then, if requested, by the
    /// least effort, then from the first of them.
    pub starts: Vec<StartRecord>,
    /// Posts with a path from a start, the starts included.
    pub reachable_posts: usize,
    /// Their area, counting one cell for each post.
    pub reachable_area_m2: f64,
    /// Reachable posts on the border of the map: more may be reachable beyond.
    pub reachable_posts_at_border: usize,
    /// Reachable posts next to one without elevation.
    pub reachable_posts_at_no_data: usize,
    /// The hops after which the search ended, if it was bounded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hops_max: Option<i16>,
    /// If the search was bounded: posts that may need more hops, or have no path, which was not looked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_searched_posts: Option<usize>,
    /// Hops to the farthest post.
    pub farthest_hops: i16,
    /// Posts by hops, from 0 on.
    pub hops_histogram: Vec<usize>,
    /// The second criterion, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effort: Option<MapEffortRecord>,
    /// What the paths have least, if that is not the number of hops; "hops" are then those of the path found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective: Option<MapObjectiveRecord>,
    /// The greatest total of each amount that was asked for, along the paths found.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub amounts: Vec<AmountRecord>,
    /// The return journeys, if requested.
    #[serde(rename = "return", skip_serializing_if = "Option::is_none")]
    pub back: Option<ReturnRecord>,
    /// Single hops from every post, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mobility: Option<MobilityRecord>,
    /// The shares of the limits that the maps, paths and their check are for; absent if they are for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
    /// One record for each goal, in the order given.
    pub goals: Vec<GoalRecord>,
}

/// A start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartRecord {
    /// The post nearest to the requested start, easting.
    pub x_m: f64,
    /// And northing.
    pub y_m: f64,
    /// Its distance from the requested position.
    pub offset_m: f64,
    /// Posts that are reached from it, itself included, and not from a nearer start.
    pub nearest_posts: usize,
}

/// The least effort among paths of fewest hops.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapEffortRecord {
    /// The kind of effort.
    pub kind: Effort,
    /// Its unit.
    pub unit: EffortUnit,
    /// The greatest effort of any reachable post.
    pub greatest: f64,
}

/// What the paths of a map have least.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapObjectiveRecord {
    /// The amounts: the first is least, each other breaks the ties of those before.
    pub amounts: Vec<Amount>,
    /// The greatest total of each at any reached node.
    pub greatest: Vec<AmountRecord>,
    /// The greatest total of the first within which nodes count as reached, if it is bounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<MapBudgetRecord>,
}

/// The bound of a map on the first amount of its objective.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapBudgetRecord {
    /// Of which amount.
    pub amount: Amount,
    /// What sets it.
    pub key: String,
    /// The greatest total, in the unit of the amount.
    pub max: f64,
}

/// Paths back to the nearest start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ReturnRecord {
    /// Posts from which a start can be reached, the starts included.
    pub return_posts: usize,
    /// Of these, posts that are also reachable from a start.
    pub round_trip_posts: usize,
    /// The most hops that a path back takes.
    pub farthest_hops: i16,
}

/// Single hops from every post.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MobilityRecord {
    /// The radius of the disc to which the shares refer.
    pub disc_radius_m: f64,
    /// The number of directions into which it is divided.
    pub sectors: u8,
    /// The mean share over all posts.
    pub mean_share: f64,
    /// The greatest share.
    pub best_share: f64,
    /// The first post with that share, from the north-west.
    pub best_m: [f64; 2],
    /// The number of directions with a hop from there.
    pub best_directions: f64,
}

/// A goal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GoalRecord {
    /// The post nearest to the requested goal, easting.
    pub x_m: f64,
    /// And northing.
    pub y_m: f64,
    /// Its distance from the requested position.
    pub offset_m: f64,
    /// The number of the start, from 1, that the path begins at; null: not reached over these nodes.
    pub start: Option<usize>,
    /// Fewest hops over these nodes; null: not reached over them.
    pub hops: Option<i16>,
    /// The fewest hops of any path from a start to this post, over whatever nodes, by the greatest speeds alone; null without elevation.
    #[serde(default)]
    pub hops_lower_bound: Option<u64>,
    /// False if the search ended at its bound of hops before the goal, so that it is not known whether it can be reached.
    pub searched: bool,
    /// The totals of the path in all amounts of the objective of the map; empty where it has none, or without a path.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub objective_totals: Vec<AmountRecord>,
    /// Fewest hops back; absent if not requested, null: no path.
    #[serde(default, deserialize_with = "stated", skip_serializing_if = "Option::is_none")]
    pub return_hops: Option<Option<i16>>,
    /// The hops of one path of fewest hops (and of least effort, if an effort was requested), x along the path.
    pub path: Vec<HopRecord>,
    /// Their totals, with trials also the estimated success of the path; null: not reachable.
    pub totals: Option<TotalsRecord>,
    /// If the path takes more propellant than the machine has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub propellant_shortage: Option<PropellantShortage>,
    /// Whether the path was flown again over the DEM by the independent checker and broke no limit; null: not reachable.
    pub verified: Option<bool>,
    /// The results of the trials along the path, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub simulation: Option<SimulationRecord>,
}

/// The inputs of a map's summary.
#[derive(Clone, Debug)]
pub struct MapSummary<'a> {
    /// The terrain.
    pub dem: &'a Dem,
    /// The nodes.
    pub lattice: NodeLattice,
    /// The requested starts, at least one, and their nodes.
    pub starts: Vec<(MapPoint, Post)>,
    /// The search from the starts.
    pub out: &'a HopMap,
    /// The search of return paths to the starts.
    pub back: Option<&'a HopMap>,
    /// Single hops.
    pub mobility: Option<&'a Mobility>,
    /// The effort that the search minimised.
    pub effort: Option<Effort>,
    /// The hops after which it ended, if it was bounded.
    pub hops_max: Option<i16>,
}

impl MapAnswer {
    /// The summary of the maps; the caller adds the goals, and the shares of the limits.
    pub fn new(summary: &MapSummary<'_>) -> Self {
        let MapSummary { dem, lattice, out, .. } = *summary;
        let map = lattice.map(dem.georeference());
        let starts = start_records(summary, &map);
        let first = starts.first().copied();
        let reachable = |index: usize| out.hops[index] >= 0;
        let mut hops_histogram = Vec::new();
        for &hops in &out.hops {
            let Ok(hops) = usize::try_from(hops) else { continue };
            if hops_histogram.len() <= hops {
                hops_histogram.resize(hops + 1, 0);
            }
            hops_histogram[hops] += 1;
        }
        let reachable_posts: usize = hops_histogram.iter().sum();
        let count = |which: &dyn Fn(Post) -> bool| {
            (0..lattice.count()).filter(|&index| reachable(index) && which(lattice.node(index))).count()
        };
        let no_ground = |post: Post| out.hops[lattice.index(post)] == NO_GROUND;
        #[expect(clippy::cast_precision_loss, reason = "counts of posts stay far below 2^53")]
        let reachable_area_m2 = reachable_posts as f64 * map.dx_m() * map.dy_m();
        Self {
            stride: lattice.stride,
            nodes_per_post: lattice.per_post,
            posts: lattice.count(),
            no_data_posts: out.hops.iter().filter(|&&hops| hops == NO_GROUND).count(),
            start_m: first.map_or([0.0; 2], |start| [start.x_m, start.y_m]),
            start_offset_m: first.map_or(0.0, |start| start.offset_m),
            starts,
            reachable_posts,
            reachable_area_m2,
            reachable_posts_at_border: count(&|post| {
                post.row == 0 || post.col == 0 || post.row + 1 == lattice.rows || post.col + 1 == lattice.cols
            }),
            reachable_posts_at_no_data: count(&|post| neighbours(lattice, post).any(no_ground)),
            hops_max: summary.hops_max,
            not_searched_posts: summary.hops_max.map(|_| out.hops.iter().filter(|&&hops| hops == NOT_SEARCHED).count()),
            farthest_hops: out.hops.iter().copied().fold(0, i16::max),
            hops_histogram,
            effort: summary.effort.map(|effort| MapEffortRecord {
                kind: effort,
                unit: effort.unit(),
                greatest: out.effort.iter().copied().fold(0.0, f64::max),
            }),
            objective: None,
            amounts: Vec::new(),
            back: summary.back.map(|back| ReturnRecord {
                return_posts: back.hops.iter().filter(|&&hops| hops >= 0).count(),
                round_trip_posts: out.hops.iter().zip(&back.hops).filter(|&(&there, &back)| there >= 0 && back >= 0).count(),
                farthest_hops: back.hops.iter().copied().fold(0, i16::max),
            }),
            mobility: summary.mobility.map(|mobility| MobilityRecord::new(mobility, lattice, &map)),
            derating: None,
            goals: Vec::new(),
        }
    }

    /// The starts, in words.
    pub fn from(&self) -> String {
        match self.starts.len() {
            0 | 1 => format!("({:.3}, {:.3}) m", self.start_m[0], self.start_m[1]),
            many => format!("the nearest of {many} starts"),
        }
    }

    /// What the map has answers for, in words: a post, or a node of a lattice that is finer than the posts.
    pub const fn node(&self) -> &'static str {
        if self.nodes_per_post > 1 { "node" } else { "post" }
    }

    /// Whether every goal is reachable by a path that the machine can fly.
    pub fn reaches_all_goals(&self) -> bool {
        self.goals.iter().all(|goal| goal.hops.is_some() && goal.propellant_shortage.is_none())
    }

    /// What is reached from where; of a map without a start, its nodes alone.
    fn reached_text(&self) -> String {
        let node = self.node();
        if self.starts.is_empty() {
            let ground = self.posts - self.no_data_posts;
            return format!(
                "{} {node}s, {ground} with an elevation; single hops from each, and no start from which any is reached\n",
                self.posts
            );
        }
        let mut text = format!(
            "{} of {} {node}s reachable from {}, {:.6} km2, {} at most {}\n",
            self.reachable_posts,
            self.posts,
            self.from(),
            self.reachable_area_m2 * 1.0e-6,
            if self.objective.is_some() { "by paths of" } else { "in" },
            format_hops(self.farthest_hops)
        );
        let beside = format!(
            "{} reachable {node}{} on the map's border, {} beside no-data",
            self.reachable_posts_at_border,
            if self.reachable_posts_at_border == 1 { "" } else { "s" },
            self.reachable_posts_at_no_data
        );
        // Writing to a String cannot fail.
        if let [start] = &self.starts[..] {
            let _ = writeln!(text, "start: {:.3} m from the given place; {beside}", start.offset_m);
        } else {
            for (number, StartRecord { x_m, y_m, offset_m, nearest_posts }) in (1..).zip(&self.starts) {
                let _ = writeln!(
                    text,
                    "start {number} ({x_m:.3}, {y_m:.3}) m, {offset_m:.3} m from the given place: nearest to {nearest_posts} {node}{}",
                    if *nearest_posts == 1 { "" } else { "s" }
                );
            }
            let _ = writeln!(text, "{beside}");
        }
        text
    }

    /// The answer as text.
    pub fn text(&self) -> String {
        let node = self.node();
        let mut text = self.reached_text();
        if self.nodes_per_post > 1 {
            let _ = writeln!(text, "nodes: {} for each post spacing", self.nodes_per_post);
        }
        if let Some(derating) = &self.derating {
            let _ = writeln!(text, "{}", derating.sentence());
        }
        if let (Some(most), Some(posts)) = (self.hops_max, self.not_searched_posts) {
            let _ = writeln!(text, "{}", not_searched(most, posts, node));
        }
        for line in self.objective_lines() {
            let _ = writeln!(text, "{line}");
        }
        if let Some(MapEffortRecord { kind, unit, greatest }) = &self.effort {
            let _ = writeln!(text, "{}: at most {greatest:.4} {unit}", kind.total());
        }
        if let Some(back) = &self.back {
            let _ = writeln!(
                text,
                "return: {} can be reached again from {} {node}s, {} of them reachable, in at most {}",
                if self.starts.len() > 1 { "a start" } else { "the start" },
                back.return_posts,
                back.round_trip_posts,
                format_hops(back.farthest_hops)
            );
        }
        if let Some(mobility) = &self.mobility {
            let _ = writeln!(
                text,
                "mobility: one hop reaches {:.1} % of the {node}s within {:.3} m on average; most at ({:.3}, {:.3}) m: {:.1} %, in {} of {} directions",
                100.0 * mobility.mean_share,
                mobility.disc_radius_m,
                mobility.best_m[0],
                mobility.best_m[1],
                100.0 * mobility.best_share,
                mobility.best_directions,
                mobility.sectors
            );
        }
        for goal in &self.goals {
            text.push_str(&self.goal_text(goal));
        }
        if !self.hops_histogram.is_empty() {
            let _ = writeln!(text, "\n{:>6}{:>12}", "hops", format!("{node}s"));
        }
        for (first, last, posts) in histogram_rows(&self.hops_histogram) {
            let hops = if first == last { first.to_string() } else { format!("{first}-{last}") };
            let _ = writeln!(text, "{hops:>6}{posts:>12}");
        }
        for goal in &self.goals {
            if let Some(simulation) = &goal.simulation {
                let _ = writeln!(text, "\ngoal ({:.3}, {:.3}) m", goal.x_m, goal.y_m);
                if let Some(estimate) = goal.totals.as_ref().and_then(|totals| totals.estimate) {
                    let _ = writeln!(text, "{}", estimate.line());
                }
                text.push_str(&simulation.text());
            }
        }
        text
    }

    /// What the paths have least, what bounds it, and the totals that were asked for.
    fn objective_lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if let Some(MapObjectiveRecord { amounts, greatest, budget }) = &self.objective {
            for (place, AmountRecord { amount, total }) in greatest.iter().enumerate() {
                let then = if place == 0 { "" } else { "then " };
                lines.push(format!("{then}least {}: at most {}", amount.words(), with_unit(*total, *amount)));
            }
            if let (Some(first), Some(MapBudgetRecord { key, max, .. })) = (amounts.first(), budget) {
                let (most, node) = (with_unit(*max, *first), self.node());
                lines.push(format!("within {most} ({key}): a {node} beyond counts as not searched"));
            }
        }
        let along = |AmountRecord { amount, total }: &AmountRecord| {
            format!("{} along the paths: at most {}", amount.words(), with_unit(*total, *amount))
        };
        lines.extend(self.amounts.iter().map(along));
        lines
    }

    /// How many hops a goal is away, and what bounds them.
    fn goal_text(&self, goal: &GoalRecord) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let unreached = match self.hops_max {
            Some(most) if !goal.searched => format!("not within {}, and not searched beyond", format_hops(most)),
            None if !goal.searched => match self.objective.as_ref().and_then(|objective| objective.budget.as_ref()) {
                Some(budget) => format!("not within {}, and not searched beyond", with_unit(budget.max, budget.amount)),
                None => "not searched".to_owned(),
            },
            _ => "not reached over these nodes".to_owned(),
        };
        let from = goal.start.filter(|_| self.starts.len() > 1).map_or(String::new(), |number| format!(" from start {number}"));
        let hops = goal.hops.map_or(unreached, |hops| format_hops(hops) + &from);
        let back = match goal.return_hops {
            Some(Some(hops)) => format!(", {} back", format_hops(hops)),
            Some(None) => ", no path back".to_owned(),
            None => String::new(),
        };
        let _ =
            writeln!(text, "goal ({:.3}, {:.3}) m, {:.3} m from the given place: {hops}{back}", goal.x_m, goal.y_m, goal.offset_m);
        if let Some(lower) = goal.hops_lower_bound.filter(|_| goal.hops.is_some() || goal.searched) {
            let _ = writeln!(text, "  {}", hops_bound(goal.hops.map(i16::unsigned_abs).map(u64::from), lower));
        }
        for (place, AmountRecord { amount, total }) in goal.objective_totals.iter().enumerate() {
            let least = if place == 0 { "least " } else { "" };
            let _ = writeln!(text, "  {least}{}: {}", amount.words(), with_unit(*total, *amount));
        }
        for line in goal.totals.iter().flat_map(stores_lines) {
            let _ = writeln!(text, "  {line}");
        }
        if let Some(shortage) = &goal.propellant_shortage {
            let _ = writeln!(text, "  not with its propellant: {}", shortage.sentence());
        }
        text
    }
}

/// A total with its unit.
fn with_unit(total: f64, amount: Amount) -> String {
    match amount {
        Amount::Hops => format!("{total} hop{}", if total == 1.0 { "" } else { "s" }),
        _ => format!("{total:.4} {}", amount.unit()),
    }
}

/// Nodes for each post spacing where they are the posts.
const fn one() -> usize {
    1
}

/// Whether the nodes are the posts.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
const fn is_one(nodes_per_post: &usize) -> bool {
    *nodes_per_post == 1
}

/// What a bounded search has left open.
fn not_searched(most: i16, posts: usize, node: &str) -> String {
    if posts == 0 {
        return format!("searched up to {}; no {node} is farther", format_hops(most));
    }
    let s = if posts == 1 { "" } else { "s" };
    format!("searched up to {}: {posts} other {node}{s} may be farther, or unreachable, and were not searched", format_hops(most))
}

/// The starts, with the posts that are nearest to each.
fn start_records(summary: &MapSummary<'_>, map: &crate::terrain::GeoReference) -> Vec<StartRecord> {
    let MapSummary { lattice, out, .. } = *summary;
    let mut nearest_posts = vec![0; summary.starts.len()];
    for node in (0..lattice.count()).map(|index| lattice.node(index)) {
        if let Some(count) = out.source(lattice, node).and_then(|number| nearest_posts.get_mut(number)) {
            *count += 1;
        }
    }
    let of = |(&(asked, post), nearest_posts): (&(MapPoint, Post), usize)| {
        let at = map.post(post.row, post.col);
        StartRecord { x_m: at.x, y_m: at.y, offset_m: (at - asked).norm(), nearest_posts }
    };
    summary.starts.iter().zip(nearest_posts).map(of).collect()
}

/// The rows of a histogram for reading: first and last count of hops, and the posts. At most [`MOST_ROWS`]: a longer histogram has
/// several counts in each row, 1, 2, 5, 10, 20, ... of them, except that 0 hops, the start, has its own.
fn histogram_rows(histogram: &[usize]) -> Vec<(usize, usize, usize)> {
    const MOST_ROWS: usize = 40;
    let Some((start, others)) = histogram.split_first() else { return Vec::new() };
    let widths = (0..).flat_map(|zeros: u32| [1, 2, 5].map(|digit| digit * 10_usize.saturating_pow(zeros)));
    let width = widths.into_iter().find(|width| others.len().div_ceil(*width) < MOST_ROWS).unwrap_or(1);
    let summed = others.chunks(width).enumerate().map(|(i, posts)| {
        let first = 1 + i * width;
        (first, first + posts.len() - 1, posts.iter().sum())
    });
    std::iter::once((0, 0, *start)).chain(summed).collect()
}

/// A count of hops.
fn format_hops(hops: i16) -> String {
    format!("{hops} hop{}", if hops == 1 { "" } else { "s" })
}

impl MobilityRecord {
    fn new(mobility: &Mobility, lattice: NodeLattice, map: &crate::terrain::GeoReference) -> Self {
        let (mut sum, mut count, mut best) = (0.0, 0u32, (f64::NEG_INFINITY, 0));
        for (index, &share) in mobility.share.iter().enumerate() {
            let share = f64::from(share);
            if share.is_nan() {
                continue;
            }
            sum += share;
            count += 1;
            if share > best.0 {
                best = (share, index);
            }
        }
        let Post { row, col } = lattice.node(best.1);
        let at = map.post(row, col);
        Self {
            disc_radius_m: mobility.disc_radius_m,
            sectors: SECTORS,
            mean_share: if count == 0 { 0.0 } else { sum / f64::from(count) },
            best_share: best.0.max(0.0),
            best_m: [at.x, at.y],
            best_directions: f64::from(mobility.directions[best.1]).max(0.0),
        }
    }
}

/// The neighbours of a post among the eight around it that lie on the map.
fn neighbours(lattice: NodeLattice, post: Post) -> impl Iterator<Item = Post> {
    let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
    around(post.row, lattice.rows)
        .flat_map(move |row| around(post.col, lattice.cols).map(move |col| Post { row, col }))
        .filter(move |&other| other != post)
}

#[cfg(test)]
mod tests {
    use super::histogram_rows;

    #[test]
    fn a_long_histogram_has_forty_rows_at_most_and_loses_no_post() {
        assert!(histogram_rows(&[]).is_empty());
        assert_eq!(histogram_rows(&[1, 8, 3]), [(0, 0, 1), (1, 1, 8), (2, 2, 3)]);
        for (counts, rows, width) in
            [(40, 40, 1), (41, 21, 2), (79, 40, 2), (80, 17, 5), (196, 40, 5), (1000, 21, 50), (32_768, 34, 1000)]
        {
            let histogram: Vec<usize> = (1..=counts).collect();
            let found = histogram_rows(&histogram);
            assert_eq!((found.len(), found[1].1 - found[1].0 + 1), (rows, width), "{counts} counts");
            assert_eq!(found.iter().map(|row| row.2).sum::<usize>(), histogram.iter().sum::<usize>(), "{counts} counts");
            assert_eq!(found.last().map(|row| row.1), Some(counts - 1), "{counts} counts");
            assert!(found.windows(2).all(|pair| pair[0].1 + 1 == pair[1].0), "{counts} counts: {found:?}");
        }
    }
}
