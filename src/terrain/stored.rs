//! From the numbers that a file stores to a raster: scaling, the step of the stored numbers, and the checks that all formats share.

use super::dem::Posts;
use super::format::ReadContext;
use super::georeference::refuse_degrees;
use super::no_data::last_digit;
use super::void::{Marks, around, find_void};
use super::{Dem, GeoReference, NoDataRule, PostLattice, Samples, TerrainError, VoidPlace, Window};
use crate::quantity::format_number;

/// The conversion from stored sample to elevation: z = scale * sample + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scaling {
    pub(super) scale: f64,
    pub(super) offset_m: f64,
}

impl Scaling {
    pub(super) const NONE: Self = Self { scale: 1.0, offset_m: 0.0 };

    pub(super) fn apply(self, sample: f64) -> f64 {
        sample * self.scale + self.offset_m
    }

    /// Whether two scalings are the same but for the digits of their texts.
    pub(super) fn is_near(self, other: Self) -> bool {
        let near = |one: f64, two: f64| (one - two).abs() <= 1.0e-6 * one.abs().max(two.abs());
        near(self.scale, other.scale) && near(self.offset_m, other.offset_m)
    }

    /// The sample of an elevation.
    pub(super) fn stored(self, z_m: f64) -> f64 {
        (z_m - self.offset_m) / self.scale
    }
}

/// The least difference between elevations that the stored numbers can express.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum StoredStep {
    /// 64-bit floats, or unknown: no step that matters.
    #[default]
    Fine,
    /// Whole numbers, or numbers of a text with so many decimals: the same step everywhere, m.
    Fixed(f64),
    /// 32-bit floats, with their scaling: the step grows with the number.
    Single(Scaling),
}

/// From this many numbers on, the last digits of a text are its rounding: fewer numbers may be exact.
const ROUNDING_SHOWS: usize = 100;

/// The finest last digit of the numbers of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LastDigits {
    count: usize,
    finest: f64,
}

impl Default for LastDigits {
    fn default() -> Self {
        Self { count: 0, finest: f64::INFINITY }
    }
}

impl LastDigits {
    /// Takes one number into account.
    pub(super) fn see(&mut self, text: &str) {
        self.count += 1;
        let unit = last_digit(text);
        if unit > 0.0 {
            self.finest = self.finest.min(unit);
        }
    }
}

/// A step that makes a slope over this, as a ratio, is reported.
const STEEP_STEP: f64 = 0.01;

impl StoredStep {
    /// The step of the numbers of a text.
    pub(super) fn of_text(LastDigits { count, finest }: LastDigits, scaling: Scaling) -> Self {
        if count >= ROUNDING_SHOWS && finest.is_finite() { Self::Fixed(finest * scaling.scale.abs()) } else { Self::Fine }
    }

    /// The step of the numbers around an elevation, m.
    fn at(self, z_m: f64) -> f64 {
        match self {
            Self::Fine => 0.0,
            Self::Fixed(step_m) => step_m,
            Self::Single(scaling) => {
                #[expect(clippy::cast_possible_truncation, reason = "the stored number is a 32-bit float")]
                let stored = scaling.stored(z_m).abs() as f32;
                f64::from(stored.next_up() - stored) * scaling.scale.abs()
            }
        }
    }

    /// What the step does to slopes between posts at this spacing, if it makes one of over a hundredth.
    pub(super) fn warning(self, (low_m, high_m): (f64, f64), spacing_m: f64) -> Option<String> {
        let step_m = self.at(low_m).max(self.at(high_m));
        if low_m == high_m || step_m <= STEEP_STEP * spacing_m {
            return None;
        }
        let numbers = match self {
            Self::Single(scaling) => {
                let largest = scaling.stored(low_m).abs().max(scaling.stored(high_m).abs());
                format!("32-bit floats around {}", format_number(largest.round()))
            }
            Self::Fixed(_) | Self::Fine => "rounded numbers".to_owned(),
        };
        Some(format!(
            "the elevations are stored in steps of {} m ({numbers}) on posts every {} m: one step makes a slope of {:.1} degrees that the \
             ground may not have; use a product whose source has finer steps, such as heights in place of radii (a copy in 64 bits keeps the steps)",
            format_number(step_m),
            format_number(spacing_m),
            (step_m / spacing_m).atan().to_degrees()
        ))
    }
}

/// The command that converts the elevations of a file to metres: through a virtual raster, which keeps masks and no-data values, with a
/// scale in place of new numbers, and without the unit that the file states. `map` replaces the reference system, heights included.
pub(super) fn convert_heights(map: Option<&str>, scaling: Scaling, metres_per_unit: Option<f64>) -> String {
    let map = map.map_or_else(String::new, |map| format!(" -a_srs {map}"));
    let times = |number: f64| match metres_per_unit {
        Some(size_m) => (number * size_m + 0.0).to_string(),
        None if number == 0.0 => "0".to_owned(),
        None if number == 1.0 => "METRES_PER_UNIT".to_owned(),
        None => format!("METRES_PER_UNIT_TIMES_{number}"),
    };
    format!(
        "gdal_translate -of VRT{map} -a_scale {} -a_offset {} in.tif in.vrt && sed '/<UnitType>/d' in.vrt > metres.vrt && gdal_translate \
         metres.vrt out.tif",
        times(scaling.scale),
        times(scaling.offset_m)
    )
}

/// What a reader makes of a whole file, before the checks that all formats share.
#[derive(Debug)]
pub(super) struct StoredRaster {
    pub(super) rows: usize,
    pub(super) cols: usize,
    /// Row after row from the north; NaN is a gap.
    pub(super) posts: Posts,
    pub(super) georeference: GeoReference,
    /// Whether the file states a projected map; if not, the units are judged by the numbers.
    pub(super) states_metres: bool,
    /// Whether the file stores the southernmost row first.
    pub(super) south_up: bool,
    pub(super) scaling: Scaling,
    pub(super) step: StoredStep,
}

impl StoredRaster {
    /// The raster, with its gaps and its place as the sidecar files state them.
    ///
    /// # Errors
    /// [`TerrainError`] for a void that is taken for ground, a map in degrees, sidecar files that contradict the file, and as
    /// [`Dem::new`].
    pub(super) fn finish(self, context: &ReadContext) -> Result<Dem, TerrainError> {
        let Self { rows, cols, mut posts, georeference, states_metres, south_up, scaling, step } = self;
        let ReadContext { no_data: rule, of_any_unit, sidecars } = context;
        let (georeference, stated_beside) = sidecars.place(georeference, (rows, cols), south_up)?;
        let lattice = PostLattice::new(rows, cols, georeference)?;
        let whole = Window { first_row: 0, first_col: 0, rows, cols };
        if let Some(shown) = sidecars.shown(&lattice, whole, south_up)? {
            posts.blank(&shown);
        }
        let dem = Dem::from_lattice(lattice, posts.narrowed())?;
        judge(&dem, *rule, scaling)?;
        // The relief tells degrees from metres; other values than elevations do not.
        if !states_metres && !stated_beside && !of_any_unit {
            refuse_degrees(&dem)?;
        }
        Ok(dem.with_step(step))
    }
}

/// Refuses a raster with a block of usual marks that is not ground.
///
/// # Errors
/// [`TerrainError::Void`].
pub(super) fn judge(dem: &Dem, rule: NoDataRule, scaling: Scaling) -> Result<(), TerrainError> {
    if rule == NoDataRule::Nothing {
        return Ok(());
    }
    let marks = Marks::of_raster(dem.elevation_range_m(), scaling);
    let (rows, cols) = (dem.rows(), dem.cols());
    let neighbours = |index: usize, visit: &mut dyn FnMut(usize)| around((rows, cols), index, visit);
    let spacing_m = dem.georeference().step_m();
    let are_there = match dem.samples() {
        Samples::Single(posts) => marks.are_in(posts),
        Samples::Double(posts) => marks.are_in(posts),
    };
    if !are_there {
        return Ok(());
    }
    let void = match dem.samples() {
        Samples::Single(posts) => find_void(posts.len(), &marks, spacing_m, |index| posts[index].into(), neighbours),
        Samples::Double(posts) => find_void(posts.len(), &marks, spacing_m, |index| posts[index], neighbours),
    };
    let Some(void) = void else { return Ok(()) };
    let (row, col) = (void.first / cols, void.first % cols);
    Err(void.taken(VoidPlace::Post { row, col, at: dem.georeference().post(row, col) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps by hand: 32-bit floats have 24 bits, so numbers from 2^20 to 2^21 (1737400 is one) have steps of 2^-3.
    #[test]
    fn steps_that_make_slopes_are_reported() {
        let radius = (1_737_400.0, 1_737_410.0);
        let text = StoredStep::Single(Scaling::NONE).warning(radius, 1.0).unwrap();
        assert!(text.contains("0.125 m") && text.contains("7.1 degrees"), "{text}");
        assert_eq!(StoredStep::Single(Scaling::NONE).warning((0.0, 100.0), 1.0), None);
        assert_eq!(StoredStep::Single(Scaling::NONE).warning(radius, 100.0), None);
        let kilometres = Scaling { scale: 1000.0, offset_m: 0.0 };
        assert!(StoredStep::Single(kilometres).warning(radius, 1.0).unwrap().contains("0.1220703125 m"));
        let text = StoredStep::Fixed(0.5).warning((0.0, 3.0), 5.0).unwrap();
        assert!(text.contains("steps of 0.5 m") && text.contains("5.7 degrees"), "{text}");
        assert_eq!(StoredStep::Fixed(0.5).warning((3.0, 3.0), 5.0), None);
        assert_eq!(StoredStep::Fine.warning(radius, 1e-9), None);
    }
}
