//! The answer of a fan, as plain data, text and CSV.

use std::{
    fmt::Write as _,
    io::{self, Write},
};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{path_record::heading_true_deg, stated::stated};
use crate::{
    quantity::MapPoint,
    reach::{FanRay, HopBand, SliceEnd},
    terrain::MapProjection,
    world::Limit,
};

/// The answer of `chta fan`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FanAnswer {
    /// The common start of all slices on the map, m.
    pub from_m: [f64; 2],
    /// The number of headings.
    pub headings: usize,
    /// The requested length of the slices, m.
    pub length_m: f64,
    /// Points inside each segment, if the spacing was given so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points_per_segment: Option<u32>,
    /// The greatest node spacing, if the spacing was given so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node_spacing_max_m: Option<f64>,
    /// Where true north lies from the start, clockwise from grid north, degrees, for the picture.
    #[serde(skip)]
    pub true_north_deg: Option<f64>,
    /// One for each direction.
    pub rays: Vec<FanRecord>,
}

/// One direction of a fan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FanRecord {
    /// Clockwise from grid north.
    pub heading_deg: f64,
    /// On a map of a known projection: the same from true north; null at a pole.
    #[serde(default, deserialize_with = "stated", skip_serializing_if = "Option::is_none")]
    pub heading_true_deg: Option<Option<f64>>,
    /// The length of the slice.
    pub length_m: f64,
    /// Why it ends before the requested length: `border`, `no-data` or nothing.
    pub cut: Option<SliceEnd>,
    /// The farthest node that can be reached.
    pub farthest_m: f64,
    /// The fewest hops to it.
    pub hops_to_farthest: u64,
    /// The fewest hops to the slice's far end.
    pub hops_to_end: Option<u64>,
    /// The limit that refuses the hop from the farthest node to the next one.
    pub first_refusing_limit: Option<Limit>,
    /// Hops by distance: `from_m`, `to_m`, `hops`.
    pub bands: Vec<BandRecord>,
}

/// A part of a slice whose nodes all have the same fewest hops.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BandRecord {
    /// Where it begins.
    pub from_m: f64,
    /// Where it ends.
    pub to_m: f64,
    /// The fewest hops; null: not reached.
    pub hops: Option<u64>,
}

impl FanAnswer {
    /// The answer for the rays from a point; the caller adds the node spacing.
    pub fn new(from: MapPoint, length_m: f64, rays: &[FanRay], projection: Option<&MapProjection>) -> Self {
        let record = |ray: &FanRay| FanRecord {
            heading_true_deg: projection.map(|projection| heading_true_deg(projection, from, ray.heading_deg)),
            ..FanRecord::new(ray)
        };
        let true_north_deg = projection.and_then(|projection| projection.north_on_map_deg(from));
        let rays: Vec<_> = rays.iter().map(record).collect();
        Self {
            from_m: [from.x, from.y],
            headings: rays.len(),
            length_m,
            points_per_segment: None,
            node_spacing_max_m: None,
            true_north_deg,
            rays,
        }
    }

    /// The number of headings whose far end can be reached.
    pub fn reached_ends(&self) -> usize {
        self.rays.iter().filter(|ray| ray.hops_to_end.is_some()).count()
    }

    /// Whether the headings from true north are known.
    fn has_true_north(&self) -> bool {
        self.rays.iter().any(|ray| ray.heading_true_deg.is_some())
    }

    /// The table as text.
    pub fn text(&self) -> String {
        let mut text = format!(
            "{} headings from ({}, {}) m, at most {} m: {} lead to their far end\n\n",
            self.headings,
            self.from_m[0],
            self.from_m[1],
            self.length_m,
            self.reached_ends()
        );
        let columns = ["heading", "length (m)", "farthest (m)", "hops", "hops to end", "refused by", "cut by"];
        let [heading, length, farthest, hops, end, limit, cut] = columns;
        // Writing to a String cannot fail.
        let north = if self.has_true_north() { format!("{:>10}", "true") } else { String::new() };
        let _ = writeln!(text, "{heading:>8}{north}{length:>12}{farthest:>14}{hops:>6}{end:>13}  {limit:<18}{cut}");
        for ray in &self.rays {
            let _ = writeln!(
                text,
                "{:>8.2}{}{:>12.3}{:>14.3}{:>6}{:>13}  {:<18}{}",
                ray.heading_deg,
                ray.heading_true_deg
                    .map(|heading| heading.map_or(format!("{:>10}", "-"), |heading| format!("{heading:>10.2}")))
                    .unwrap_or_default(),
                ray.length_m,
                ray.farthest_m,
                ray.hops_to_farthest,
                ray.hops_to_end.map_or("-".to_owned(), |hops| hops.to_string()),
                ray.first_refusing_limit.map_or("-", Limit::name),
                ray.cut.map_or("-", SliceEnd::name)
            );
        }
        text
    }

    /// The table as CSV; absent values are blank.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: impl Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(out);
        let has_true_north = self.has_true_north();
        let columns = ["heading_deg", "length_m", "cut", "farthest_m", "hops_to_farthest", "hops_to_end", "first_refusing_limit"];
        writer.write_record(columns.iter().chain(has_true_north.then_some(&"heading_true_deg")))?;
        for ray in &self.rays {
            let heading = ray.heading_true_deg.map(|heading| heading.map(|heading| heading.to_string()).unwrap_or_default());
            let fields = [
                ray.heading_deg.to_string(),
                ray.length_m.to_string(),
                ray.cut.map_or("", SliceEnd::name).to_owned(),
                ray.farthest_m.to_string(),
                ray.hops_to_farthest.to_string(),
                ray.hops_to_end.map(|hops| hops.to_string()).unwrap_or_default(),
                ray.first_refusing_limit.map_or("", Limit::name).to_owned(),
            ];
            writer.write_record(fields.into_iter().chain(heading))?;
        }
        writer.flush()
    }
}

impl FanRecord {
    fn new(ray: &FanRay) -> Self {
        Self {
            heading_deg: ray.heading_deg,
            heading_true_deg: None,
            length_m: ray.length_m,
            cut: ray.end,
            farthest_m: ray.farthest_m,
            hops_to_farthest: ray.hops_to_farthest,
            hops_to_end: ray.hops_to_end,
            first_refusing_limit: ray.refusing,
            bands: ray.bands.iter().map(|&HopBand { from_m, to_m, hops }| BandRecord { from_m, to_m, hops }).collect(),
        }
    }
}
