//! The answer of a hop map, as plain data and text.

use std::fmt::Write as _;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{HopRecord, PropellantShortage, SimulationRecord, TotalsRecord, propellant_record::stores_lines, stated::stated};
use crate::{
    graph::{Effort, EffortUnit},
    quantity::MapPoint,
    reach::map::{HopMap, Mobility, NO_GROUND, NodeLattice, Post, SECTORS},
    terrain::Dem,
};

/// The answer of `chta map`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapAnswer {
    /// Every `stride`-th post of the DEM is a post of the map.
    pub stride: usize,
    /// Posts of the map.
    pub posts: usize,
    /// Of these, posts without elevation.
    pub no_data_posts: usize,
    /// The post from which all paths start.
    pub start_m: [f64; 2],
    /// Its distance from the requested position.
    pub start_offset_m: f64,
    /// Posts with a path from the start, itself included.
    pub reachable_posts: usize,
    /// Their area, counting one cell for each post.
    pub reachable_area_m2: f64,
    /// Reachable posts on the border of the map: more may be reachable beyond.
    pub reachable_posts_at_border: usize,
    /// Reachable posts next to one without elevation.
    pub reachable_posts_at_no_data: usize,
    /// Hops to the farthest post.
    pub farthest_hops: i16,
    /// Posts by hops, from 0 on.
    pub hops_histogram: Vec<usize>,
    /// The second criterion, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effort: Option<MapEffortRecord>,
    /// The return journeys, if requested.
    #[serde(rename = "return", skip_serializing_if = "Option::is_none")]
    pub back: Option<ReturnRecord>,
    /// Single hops from every post, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mobility: Option<MobilityRecord>,
    /// One record for each goal, in the order given.
    pub goals: Vec<GoalRecord>,
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

/// Paths back to the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ReturnRecord {
    /// Posts from which the start can be reached, itself included.
    pub return_posts: usize,
    /// Of these, posts that are also reachable from the start.
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
    /// Fewest hops; null: not reachable.
    pub hops: Option<i16>,
    /// Fewest hops back; absent if not requested, null: no path.
    #[serde(default, deserialize_with = "stated", skip_serializing_if = "Option::is_none")]
    pub return_hops: Option<Option<i16>>,
    /// The hops of one path of fewest hops (and of least effort, if an effort was requested), x along the path.
    pub path: Vec<HopRecord>,
    /// Their totals; null: not reachable.
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
#[derive(Clone, Copy, Debug)]
pub struct MapSummary<'a> {
    /// The terrain.
    pub dem: &'a Dem,
    /// The nodes.
    pub lattice: NodeLattice,
    /// The requested start, and its node.
    pub start: (MapPoint, Post),
    /// The search from the start.
    pub out: &'a HopMap,
    /// The search of return paths to the start.
    pub back: Option<&'a HopMap>,
    /// Single hops.
    pub mobility: Option<&'a Mobility>,
    /// The effort that the search minimised.
    pub effort: Option<Effort>,
}

impl MapAnswer {
    /// The summary of the maps; the caller adds the goals.
    pub fn new(summary: &MapSummary<'_>) -> Self {
        let MapSummary { dem, lattice, start: (asked, start), out, .. } = *summary;
        let map = dem.georeference().every(lattice.stride);
        let at = map.post(start.row, start.col);
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
            posts: lattice.count(),
            no_data_posts: out.hops.iter().filter(|&&hops| hops == NO_GROUND).count(),
            start_m: [at.x, at.y],
            start_offset_m: (at - asked).norm(),
            reachable_posts,
            reachable_area_m2,
            reachable_posts_at_border: count(&|post| {
                post.row == 0 || post.col == 0 || post.row + 1 == lattice.rows || post.col + 1 == lattice.cols
            }),
            reachable_posts_at_no_data: count(&|post| neighbours(lattice, post).any(no_ground)),
            farthest_hops: out.hops.iter().copied().fold(0, i16::max),
            hops_histogram,
            effort: summary.effort.map(|effort| MapEffortRecord {
                kind: effort,
                unit: effort.unit(),
                greatest: out.effort.iter().copied().fold(0.0, f64::max),
            }),
            back: summary.back.map(|back| ReturnRecord {
                return_posts: back.hops.iter().filter(|&&hops| hops >= 0).count(),
                round_trip_posts: out.hops.iter().zip(&back.hops).filter(|&(&there, &back)| there >= 0 && back >= 0).count(),
                farthest_hops: back.hops.iter().copied().fold(0, i16::max),
            }),
            mobility: summary.mobility.map(|mobility| MobilityRecord::new(mobility, lattice, &map)),
            goals: Vec::new(),
        }
    }

    /// Whether every goal is reachable by a path that the machine can fly.
    pub fn reaches_all_goals(&self) -> bool {
        self.goals.iter().all(|goal| goal.hops.is_some() && goal.propellant_shortage.is_none())
    }

    /// The answer as text.
    pub fn text(&self) -> String {
        let mut text = format!(
            "{} of {} posts reachable from ({:.3}, {:.3}) m, {:.6} km2, in at most {}\n",
            self.reachable_posts,
            self.posts,
            self.start_m[0],
            self.start_m[1],
            self.reachable_area_m2 * 1.0e-6,
            format_hops(self.farthest_hops)
        );
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "start: {:.3} m from the place asked for; {} reachable post{} on the map's border, {} beside no-data",
            self.start_offset_m,
            self.reachable_posts_at_border,
            if self.reachable_posts_at_border == 1 { "" } else { "s" },
            self.reachable_posts_at_no_data
        );
        if let Some(MapEffortRecord { kind, unit, greatest }) = &self.effort {
            let _ = writeln!(text, "{}: at most {greatest:.4} {unit}", kind.total());
        }
        if let Some(back) = &self.back {
            let _ = writeln!(
                text,
                "return: the start can be reached again from {} posts, {} of them reachable, in at most {}",
                back.return_posts,
                back.round_trip_posts,
                format_hops(back.farthest_hops)
            );
        }
        if let Some(mobility) = &self.mobility {
            let _ = writeln!(
                text,
                "mobility: one hop reaches {:.1} % of the posts within {:.3} m on average; most at ({:.3}, {:.3}) m: {:.1} %, in {} of {} directions",
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
            let hops = goal.hops.map_or("not reachable over these posts".to_owned(), format_hops);
            let back = match goal.return_hops {
                Some(Some(hops)) => format!(", {} back", format_hops(hops)),
                Some(None) => ", no path back".to_owned(),
                None => String::new(),
            };
            let _ = writeln!(
                text,
                "goal ({:.3}, {:.3}) m, {:.3} m from the place asked for: {hops}{back}",
                goal.x_m, goal.y_m, goal.offset_m
            );
            for line in goal.totals.iter().flat_map(stores_lines) {
                let _ = writeln!(text, "  {line}");
            }
            if let Some(shortage) = &goal.propellant_shortage {
                let _ = writeln!(text, "  not with its propellant: {}", shortage.sentence());
            }
        }
        if !self.hops_histogram.is_empty() {
            let _ = writeln!(text, "\n{:>6}{:>12}", "hops", "posts");
        }
        for (first, last, posts) in histogram_rows(&self.hops_histogram) {
            let hops = if first == last { first.to_string() } else { format!("{first}-{last}") };
            let _ = writeln!(text, "{hops:>6}{posts:>12}");
        }
        for goal in &self.goals {
            if let Some(simulation) = &goal.simulation {
                let _ = write!(text, "\ngoal ({:.3}, {:.3}) m\n{}", goal.x_m, goal.y_m, simulation.text());
            }
        }
        text
    }
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
