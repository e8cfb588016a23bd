//! Layers: rasters with a condition that has to hold at contacts or under flights, or with a cost there.

mod cost;

use std::{
    fmt,
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{
    cells::{as_index, cell_bounds},
    keep_out::{name_of, of_raster},
    same_map::{self, SameMap},
};
use crate::{
    quantity::MapPoint,
    terrain::{CoordinateSystem, Dem, DemOptions, MapBounds, TerrainError},
    world::LayerName,
};

/// The name of the file's role in messages.
const WHAT: &str = "layer";

/// A position within this fraction of a cell of a border lies on it, and so in the cells on both sides.
const ON_A_BORDER: f64 = 1e-9;

/// What the value of a cell has to be; what is absent does not count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LayerCondition {
    /// At least this.
    pub min: Option<f64>,
    /// At most this.
    pub max: Option<f64>,
    /// Exactly this.
    pub equals: Option<f64>,
}

impl LayerCondition {
    /// Whether a value meets the condition.
    pub fn holds(&self, value: f64) -> bool {
        self.min.is_none_or(|min| value >= min)
            && self.max.is_none_or(|max| value <= max)
            && self.equals.is_none_or(|equals| value == equals)
    }
}

impl fmt::Display for LayerCondition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.min, self.max, self.equals) {
            (_, _, Some(equals)) => write!(formatter, "= {equals}"),
            (Some(min), Some(max), None) => write!(formatter, "{min} to {max}"),
            (Some(min), None, None) => write!(formatter, "≥ {min}"),
            (None, Some(max), None) => write!(formatter, "≤ {max}"),
            (None, None, None) => formatter.write_str("known"),
        }
    }
}

/// For how long the condition of a layer may be unmet at a stretch of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutageLimit {
    /// The longest time, s: flights, rest and preparation.
    pub max_s: Option<f64>,
    /// The most hops, those into a stretch and out of it included.
    pub hops_max: Option<u32>,
    /// Whether the condition counts as met at contacts with targets.
    pub exempt_targets: bool,
}

impl OutageLimit {
    /// The longest time, s; infinite where hops alone are limited.
    pub fn most_s(&self) -> f64 {
        self.max_s.unwrap_or(f64::INFINITY)
    }

    /// The most hops; infinite where time alone is limited. Where neither is, no hop may be outside.
    pub fn most_hops(&self) -> f64 {
        match (self.hops_max, self.max_s) {
            (Some(most), _) => f64::from(most),
            (None, Some(_)) => f64::INFINITY,
            (None, None) => 0.0,
        }
    }

    /// The most hops, where they are limited.
    pub fn hops_allowed(&self) -> Option<u64> {
        self.hops_max.map(u64::from).or_else(|| self.max_s.is_none().then_some(0))
    }
}

/// What a layer costs a path, of which the sum over all hops is an amount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerCost {
    /// For each landing: this times the value of the cell.
    pub per_contact: f64,
    /// For each metre of ground flown over: this times the value of the cell.
    pub per_m: f64,
    /// The greatest total of a path; `None`: any.
    pub total_max: Option<f64>,
}

/// What a layer asks for, and of what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerRule {
    /// Its name.
    pub name: LayerName,
    /// What holds in a cell.
    pub condition: LayerCondition,
    /// Whether it has to hold where the robot touches the ground: at every take-off and landing, and along every driven leg.
    pub on_contact: bool,
    /// Whether it has to hold under every point of a flight.
    pub on_flight: bool,
    /// For how long it may be unmet: it then refuses no single hop, and counts along whole paths. `None`: it has to hold always.
    pub outage: Option<OutageLimit>,
    /// What it costs; `None`: nothing.
    pub cost: Option<LayerCost>,
}

/// What of a hop touches the cells of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touch {
    /// Take-offs, landings and ground that is driven over.
    Contact,
    /// The ground under a flight.
    Flight,
}

/// A raster on the terrain's map whose condition restricts contacts or flights.
///
/// A value applies to its cell, half a spacing in every direction from the cell's centre. On a border all cells that meet there have to
/// hold. A cell without data does not hold, nor does a place beyond the raster.
#[derive(Clone, Debug)]
pub struct Layer {
    rule: LayerRule,
    path: PathBuf,
    raster: Arc<Dem>,
    /// For each row of cells, how many of those before each column do not hold: one more number than columns.
    refused_before: Vec<u32>,
    /// The same of cells without a value, of a layer with a cost; else empty.
    unknown_before: Vec<u32>,
    /// Why its map could not be compared with the terrain's.
    not_compared: Option<String>,
}

/// Reads the raster of a layer (`GeoTIFF`, ESRI ASCII grid) on the terrain's map; `coordinates` is the terrain's own description of its
/// map, if it has one.
///
/// # Errors
/// [`TerrainError::Overlay`]: the file cannot be read, is not a raster on a map in metres, or has another map; or the layer has a cost, and
/// a value of the raster is negative.
///
/// # Examples
/// ```
/// use chta::{quantity::MapPoint, terrain::{LayerCondition, LayerRule, read_layer}, world::LayerName};
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("sun.asc");
/// std::fs::write(&file, "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n0.9 0.8 0.1\n0.9 0.7 0.6\n")?;
/// let condition = LayerCondition { min: Some(0.3), ..LayerCondition::default() };
/// let rule = LayerRule { name: LayerName::new("sun").unwrap(), condition, on_contact: true, on_flight: true, outage: None, cost: None };
/// let sun = read_layer(&file, rule, None)?;
/// // The shaded cell is x from 20 to 30, y from 10 to 20; its border belongs to it.
/// let holds = [(19.9, 15.0), (20.0, 15.0), (25.0, 15.0), (25.0, 9.9), (31.0, 5.0)].map(|(x, y)| sun.holds_at(MapPoint::new(x, y)));
/// assert_eq!(holds, [true, false, false, true, false]);
/// assert!(!sun.holds_between(MapPoint::new(15.0, 15.0), MapPoint::new(25.0, 5.0)), "it touches the corner of the shaded cell");
/// assert!(sun.holds_between(MapPoint::new(14.0, 15.0), MapPoint::new(24.0, 5.0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_layer(path: &Path, rule: LayerRule, coordinates: Option<&CoordinateSystem>) -> Result<Layer, TerrainError> {
    let failed = |problem: String| TerrainError::Overlay { what: WHAT, path: path.to_path_buf(), problem };
    let raster = DemOptions::default().of_any_unit().read(path).map_err(|error| failed(of_raster(error)))?;
    let same = same_map::of_raster(&raster.georeference().coordinate_system, coordinates).map_err(|difference| {
        failed(format!("the raster lies on another map ({difference}); {}", same_map::mend_raster(coordinates)))
    })?;
    let not_compared = match same {
        SameMap::Agreed => None,
        SameMap::NotCompared(reason) => Some(format!("{WHAT} {} '{}': {reason}", rule.name, name_of(path))),
    };
    Layer::of(rule, path.to_path_buf(), Arc::new(raster), not_compared)
}

impl Layer {
    /// A layer of this raster, with its cells counted.
    fn of(rule: LayerRule, path: PathBuf, raster: Arc<Dem>, not_compared: Option<String>) -> Result<Self, TerrainError> {
        if rule.cost.is_some()
            && let Some((row, col, value)) = cost::first_negative(&raster)
        {
            let name = rule.name;
            let problem = format!(
                "the cell in row {}, column {} has {value}, expected no negative value, for layer.{name} has a cost, and what adds up is never \
                 negative; shift the values until the least is 0 (gdal_calc.py), or set the negative ones to 0",
                row + 1,
                col + 1
            );
            return Err(TerrainError::Overlay { what: WHAT, path, problem });
        }
        let refused_before = counts_before(&raster, &|value| !value.is_some_and(|value| rule.condition.holds(value)));
        let unknown_before = if rule.cost.is_some() { counts_before(&raster, &|value| value.is_none()) } else { Vec::new() };
        Ok(Self { rule, path, raster, refused_before, unknown_before, not_compared })
    }

    /// The same raster under another rule: as if it had been read for it.
    ///
    /// # Errors
    /// As [`read_layer`], for what the rule asks of the values.
    pub fn under(&self, rule: LayerRule) -> Result<Self, TerrainError> {
        let not_compared = self.not_compared.clone();
        Self::of(rule, self.path.clone(), Arc::clone(&self.raster), not_compared)
    }
}

/// For each row of cells, how many of those before each column are counted.
fn counts_before(raster: &Dem, is_counted: &dyn Fn(Option<f64>) -> bool) -> Vec<u32> {
    let mut before = Vec::with_capacity(raster.rows() * (raster.cols() + 1));
    for row in 0..raster.rows() {
        let mut count = 0;
        before.push(count);
        for col in 0..raster.cols() {
            count += u32::from(is_counted(raster.elevation(row, col)));
            before.push(count);
        }
    }
    before
}

/// A straight line over the cells of a raster, in columns and rows: cell (row, col) spans `col..col + 1` and `row..row + 1`.
#[derive(Clone, Copy)]
struct Track {
    from: [f64; 2],
    by: [f64; 2],
}

impl Track {
    /// The shares of the way at which a coordinate lies between two values; empty if it never does.
    fn shares(&self, axis: usize, low: f64, high: f64) -> (f64, f64) {
        let (from, by) = (self.from[axis], self.by[axis]);
        if by == 0.0 {
            return if low <= from && from <= high { (0.0, 1.0) } else { (1.0, 0.0) };
        }
        let (a, b) = ((low - from) / by, (high - from) / by);
        (a.min(b).max(0.0), a.max(b).min(1.0))
    }

    /// The least and the greatest value of a coordinate between two shares of the way.
    fn span(&self, axis: usize, (begin, end): (f64, f64)) -> [f64; 2] {
        let [a, b] = [begin, end].map(|share| self.from[axis] + share * self.by[axis]);
        [a.min(b), a.max(b)]
    }
}

impl Layer {
    /// What it asks for.
    pub const fn rule(&self) -> &LayerRule {
        &self.rule
    }

    /// The raster.
    pub fn raster(&self) -> &Dem {
        &self.raster
    }

    /// Whether the condition holds at a position.
    pub fn holds_at(&self, place: MapPoint) -> bool {
        self.holds_between(place, place)
    }

    /// Whether the condition holds at every point of a straight line on the map.
    pub fn holds_between(&self, from: MapPoint, to: MapPoint) -> bool {
        self.is_free_of(&self.refused_before, from, to)
    }

    /// Whether it refuses to be touched along a straight line on the map: by its condition, unless it may be left for a while, and where it
    /// has a cost by a value that is not known.
    pub(crate) fn refuses(&self, touch: Touch, from: MapPoint, to: MapPoint) -> bool {
        self.refusing_counts(touch).any(|before| !self.is_free_of(before, from, to))
    }

    /// Whether it may refuse to be touched anywhere.
    fn may_refuse(&self, touch: Touch) -> bool {
        self.refusing_counts(touch).next().is_some()
    }

    /// The counts of the cells that refuse to be touched.
    fn refusing_counts(&self, touch: Touch) -> impl Iterator<Item = &[u32]> {
        let LayerRule { on_contact, on_flight, outage, cost, .. } = self.rule;
        let factor = |cost: LayerCost| if touch == Touch::Contact { cost.per_contact } else { cost.per_m };
        let by_condition = outage.is_none() && if touch == Touch::Contact { on_contact } else { on_flight };
        let by_cost = cost.is_some_and(|cost| factor(cost) > 0.0);
        let refused = by_condition.then_some(self.refused_before.as_slice());
        refused.into_iter().chain(by_cost.then_some(self.unknown_before.as_slice()))
    }

    /// Whether no counted cell is met by a straight line on the map, which does not leave the raster.
    fn is_free_of(&self, before: &[u32], from: MapPoint, to: MapPoint) -> bool {
        let track = self.track(from, to);
        let (whole, counts) = ((0.0, 1.0), [self.raster.cols(), self.raster.rows()]);
        let Some(rows) = cells_in(track.span(1, whole), counts[1]) else { return false };
        if cells_in(track.span(0, whole), counts[0]).is_none() {
            return false;
        }
        rows.into_iter().all(|row| {
            let within = track.shares(1, as_f64(row) - ON_A_BORDER, as_f64(row + 1) + ON_A_BORDER);
            within.0 > within.1
                || cells_in(track.span(0, within), counts[0]).is_some_and(|cols| self.count_in(before, row, &cols) == 0)
        })
    }

    /// Whether a contact at a place is outside the condition; never at the places `exempt`, where the layer exempts targets.
    pub(crate) fn is_outside_at(&self, at: MapPoint, exempt: &[MapPoint]) -> bool {
        let is_exempt = || self.rule.outage.is_some_and(|limit| limit.exempt_targets) && exempt.contains(&at);
        self.rule.on_contact && !is_exempt() && !self.holds_at(at)
    }

    /// Whether the take-off, the flight and the landing of a hop are outside the condition. A flight is if either contact is, or by its track.
    pub(crate) fn is_outside(&self, from: MapPoint, to: MapPoint, exempt: &[MapPoint]) -> [bool; 3] {
        let [takeoff, landing] = [from, to].map(|at| self.is_outside_at(at, exempt));
        let flight = takeoff || landing || (self.rule.on_flight && !self.holds_between(from, to));
        [takeoff, flight, landing]
    }

    /// The parts of a straight line on the map where it refuses to be touched, as shares of the way, in any order.
    pub(crate) fn refused_shares(&self, touch: Touch, from: MapPoint, to: MapPoint) -> Vec<(f64, f64)> {
        self.refusing_counts(touch).flat_map(|before| self.counted_shares(before, from, to)).collect()
    }

    /// The parts of a straight line on the map on counted cells and beyond the raster.
    fn counted_shares(&self, before: &[u32], from: MapPoint, to: MapPoint) -> Vec<(f64, f64)> {
        let track = self.track(from, to);
        let [cols, rows] = [self.raster.cols(), self.raster.rows()];
        let [across, down] =
            [(0, cols), (1, rows)].map(|(axis, count)| track.shares(axis, -ON_A_BORDER, as_f64(count) + ON_A_BORDER));
        let on = (across.0.max(down.0), across.1.min(down.1));
        if on.0 > on.1 {
            return vec![(0.0, 1.0)];
        }
        let mut refused = Vec::new();
        // Beyond the raster.
        refused.extend((on.0 > 0.0).then_some((0.0, on.0)));
        refused.extend((on.1 < 1.0).then_some((on.1, 1.0)));
        for row in cells_in(track.span(1, on), rows).into_iter().flatten() {
            let band = track.shares(1, as_f64(row) - ON_A_BORDER, as_f64(row + 1) + ON_A_BORDER);
            let band = (band.0.max(on.0), band.1.min(on.1));
            if band.0 > band.1 {
                continue;
            }
            for col in cells_in(track.span(0, band), cols).into_iter().flatten() {
                if self.count_in(before, row, &(col..=col)) == 0 {
                    continue;
                }
                let cell = track.shares(0, as_f64(col) - ON_A_BORDER, as_f64(col + 1) + ON_A_BORDER);
                let cell = (cell.0.max(band.0), cell.1.min(band.1));
                refused.extend((cell.0 <= cell.1).then_some(cell));
            }
        }
        refused
    }

    /// The warning if its map could not be compared with the terrain's.
    pub(crate) fn not_compared(&self) -> Option<&str> {
        self.not_compared.as_deref()
    }

    /// The warning if it refuses nothing in a rectangle of the map, or everything, `on` a terrain such as "the DEM".
    pub(crate) fn without_choice(&self, bounds: MapBounds, on: &str) -> Option<String> {
        let named = || format!("{WHAT} {} '{}'", self.rule.name, name_of(&self.path));
        let track = self.track(bounds.min, bounds.max);
        let (rows, cols) = (self.raster.rows(), self.raster.cols());
        let (Some(down), Some(across)) = (cells_in(track.span(1, (0.0, 1.0)), rows), cells_in(track.span(0, (0.0, 1.0)), cols))
        else {
            return cell_bounds(&self.raster)
                .meets(bounds)
                .then(|| format!("{} covers only a part of {on}: beyond it nothing is known, so that it refuses there", named()))
                .or_else(|| Some(format!("{} does not lie on {on}, so that it refuses everything there", named())));
        };
        let (cells, refused) = down.fold((0, 0), |(cells, refused), row| {
            (cells + across.end() + 1 - across.start(), refused + self.count_in(&self.refused_before, row, &across) as usize)
        });
        match refused {
            0 if self.rule.cost.is_some() => None,
            0 => Some(format!("{} holds all over {on}, so that it has no effect there", named())),
            refused if refused == cells => Some(format!("{} holds nowhere on {on}, so that it refuses everything there", named())),
            _ => None,
        }
    }

    fn track(&self, from: MapPoint, to: MapPoint) -> Track {
        let map = self.raster.georeference();
        let place = |at: MapPoint| [(at.x - map.north_west().x) / map.dx_m() + 0.5, (map.north_west().y - at.y) / map.dy_m() + 0.5];
        let (from, to) = (place(from), place(to));
        Track { from, by: [to[0] - from[0], to[1] - from[1]] }
    }

    /// How many cells of a row are counted.
    fn count_in(&self, before: &[u32], row: usize, cols: &std::ops::RangeInclusive<usize>) -> u32 {
        let begin = row * (self.raster.cols() + 1);
        before[begin + cols.end() + 1] - before[begin + cols.start()]
    }
}

/// The cells that a range of a coordinate meets, with those on the other side of a border; `None` if it leaves the raster. What lies on
/// the border of the raster is on it.
fn cells_in([low, high]: [f64; 2], count: usize) -> Option<std::ops::RangeInclusive<usize>> {
    // Written so that NaN is off the raster.
    let inside = low >= -ON_A_BORDER && high <= as_f64(count) + ON_A_BORDER;
    if !inside {
        return None;
    }
    let cell = |place: f64| as_index(place.floor().max(0.0)).map(|cell| cell.min(count - 1));
    Some(cell(low - ON_A_BORDER)?..=cell(high + ON_A_BORDER)?)
}

#[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
const fn as_f64(index: usize) -> f64 {
    index as f64
}

/// All layers of a terrain, in the order of their names: the first one that refuses counts.
#[derive(Clone, Debug, Default)]
pub struct MapLayers(Arc<[Layer]>);

impl MapLayers {
    /// These layers.
    pub fn new(mut layers: Vec<Layer>) -> Self {
        layers.sort_by_key(|layer| layer.rule.name);
        Self(layers.into())
    }

    /// Whether the map has no layers.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Every layer.
    pub fn iter(&self) -> impl Iterator<Item = &Layer> {
        self.0.iter()
    }

    /// The layer that refuses a contact at a position, if one does.
    pub fn refusing_contact(&self, at: MapPoint) -> Option<LayerName> {
        self.refusing(Touch::Contact, at, at)
    }

    /// The layer that refuses a flight from one position to another, if one does.
    pub fn refusing_flight(&self, from: MapPoint, to: MapPoint) -> Option<LayerName> {
        self.refusing(Touch::Flight, from, to)
    }

    /// The layer that refuses a hop from one position to another, by its contacts or its flight, if one does.
    pub fn refusing_hop(&self, from: MapPoint, to: MapPoint) -> Option<LayerName> {
        let contacts = || self.refusing_contact(from).or_else(|| self.refusing_contact(to));
        contacts().or_else(|| self.refusing_flight(from, to))
    }

    /// The layer that refuses to be driven over from one position to another, if one does: wheels touch the ground all the way.
    pub fn refusing_wheels(&self, from: MapPoint, to: MapPoint) -> Option<LayerName> {
        self.refusing(Touch::Contact, from, to)
    }

    /// The layers that may be left for a while.
    pub(crate) fn with_outages(&self) -> impl Iterator<Item = &Layer> {
        self.0.iter().filter(|layer| layer.rule.outage.is_some())
    }

    /// The layers that may refuse to be touched.
    pub(crate) fn refusing_any(&self, touch: Touch) -> impl Iterator<Item = &Layer> {
        self.0.iter().filter(move |layer| layer.may_refuse(touch))
    }

    fn refusing(&self, touch: Touch, from: MapPoint, to: MapPoint) -> Option<LayerName> {
        self.0.iter().find(|layer| layer.refuses(touch, from, to)).map(|layer| layer.rule.name)
    }
}
