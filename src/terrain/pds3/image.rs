//! The IMAGE object: number, type and position of the samples.

use super::label::{Label, shown, unsuitable};
use super::marks::marks;
use super::samples::{Mark, SampleType};
use crate::quantity::metres_or_kilometres;
use crate::terrain::TerrainError;

/// The position and meaning of an image's samples.
#[derive(Clone, Debug)]
pub(super) struct ImageObject {
    pub(super) rows: usize,
    pub(super) cols: usize,
    pub(super) sample: SampleType,
    /// The file with the samples; `None` means the file of the label.
    pub(super) file: Option<String>,
    /// Offset of the first line, including its prefix.
    pub(super) start: u64,
    pub(super) prefix: usize,
    pub(super) suffix: usize,
    pub(super) marks: Vec<Mark>,
    pub(super) scale: f64,
    pub(super) offset: f64,
    pub(super) metres_per_unit: f64,
}

impl ImageObject {
    /// # Errors
    /// [`TerrainError::Unsuitable`] with the first key that is missing or does not describe elevations.
    pub(super) fn of(label: &Label) -> Result<Self, TerrainError> {
        if !label.has("IMAGE") {
            return Err(unsuitable("no IMAGE object", "one (tables, spectra and cubes hold no raster of elevations)"));
        }
        for (key, others) in [("BANDS", "1 band"), ("ENCODING_TYPE", "an image without encoding")] {
            if let Some(value) =
                label.value("IMAGE", key)?.filter(|value| !matches!(value.text.to_ascii_uppercase().as_str(), "1" | "N/A" | "NONE"))
            {
                return Err(unsuitable(format!("{key} {}", shown(&value.text)), others));
            }
        }
        let missing =
            |key: &str| unsuitable(format!("no {key} in its IMAGE object"), "LINES, LINE_SAMPLES, SAMPLE_TYPE, SAMPLE_BITS");
        let count = |key: &str| label.count("IMAGE", key)?.ok_or_else(|| missing(key));
        let sample_type = label.value("IMAGE", "SAMPLE_TYPE")?.ok_or_else(|| missing("SAMPLE_TYPE"))?;
        let (file, start) = pointer(label)?;
        let sample = SampleType::of(&sample_type.text, count("SAMPLE_BITS")?)?;
        let metres_per_unit = metres_per_unit(label)?;
        let scale = label.number("IMAGE", "SCALING_FACTOR")?.unwrap_or(1.0);
        if scale == 0.0 {
            return Err(unsuitable("SCALING_FACTOR 0", "another number"));
        }
        Ok(Self {
            rows: count("LINES")?,
            cols: count("LINE_SAMPLES")?,
            sample,
            file,
            start,
            prefix: label.count("IMAGE", "LINE_PREFIX_BYTES")?.unwrap_or(0),
            suffix: label.count("IMAGE", "LINE_SUFFIX_BYTES")?.unwrap_or(0),
            marks: marks(label, sample)?,
            scale,
            offset: label.number("IMAGE", "OFFSET")?.unwrap_or(0.0),
            metres_per_unit,
        })
    }

    /// Number of bytes from one line to the next, and the offset after the last line; `None` if it overflows.
    pub(super) fn extent(&self) -> Option<(usize, u64)> {
        let line = self.cols.checked_mul(self.sample.bytes())?.checked_add(self.prefix)?.checked_add(self.suffix)?;
        let all = u64::try_from(line.checked_mul(self.rows)?).ok()?;
        Some((line, self.start.checked_add(all)?))
    }

    /// Elevation, m, of a stored number: stored * `SCALING_FACTOR` + OFFSET, in the label's unit.
    pub(super) fn elevation(&self, stored: f64) -> f64 {
        (stored * self.scale + self.offset) * self.metres_per_unit
    }
}

/// `^IMAGE`: a record or byte, counted from 1, of this file or of a named one.
fn pointer(label: &Label) -> Result<(Option<String>, u64), TerrainError> {
    let values = label.values("", "^IMAGE")?.ok_or_else(|| unsuitable("no ^IMAGE", "where the image begins"))?;
    let (file, place) = match values {
        [one] if one.text.parse::<u64>().is_ok() => (None, Some(one)),
        [name] => (Some(name.text.clone()), None),
        [name, place] => (Some(name.text.clone()), Some(place)),
        _ => return Err(unsuitable(format!("^IMAGE with {} values", values.len()), "a file, a place, or both")),
    };
    let Some(place) = place else { return Ok((file, 0)) };
    let wrong = || unsuitable(format!("^IMAGE at {}", shown(&place.text)), "a record or byte counted from 1");
    let number = place.text.parse::<u64>().ok().and_then(|number| number.checked_sub(1)).ok_or_else(wrong)?;
    if place.unit.as_deref().is_some_and(|unit| unit.starts_with("BYTE")) || number == 0 {
        return Ok((file, number));
    }
    let record = label
        .count("", "RECORD_BYTES")?
        .ok_or_else(|| unsuitable("^IMAGE counted in records but no RECORD_BYTES", "RECORD_BYTES, or a place in <BYTES>"))?;
    Ok((file, number.checked_mul(record as u64).ok_or_else(wrong)?))
}

/// What the unit of samples is stated of, before `_UNIT`.
const UNITS_OF: [&str; 16] = [
    "CORE",
    "SAMPLE",
    "DN",
    "PIXEL",
    "DATA",
    "IMAGE",
    "VALUE",
    "ELEVATION",
    "HEIGHT",
    "VERTICAL",
    "Z",
    "TOPOGRAPHY",
    "RADIUS",
    "DEM",
    "DTM",
    "SCALING",
];

/// Metres per unit of the elevations: UNIT, which `SCALING_FACTOR` and OFFSET must not
/// contradict with a unit of their own.
fn metres_per_unit(label: &Label) -> Result<f64, TerrainError> {
    let metres = |key: &str, text: &str| {
        metres_or_kilometres(text).ok_or_else(|| unsuitable(format!("{key} {}", shown(text)), "METER or KILOMETER"))
    };
    let unit = label.value("IMAGE", "UNIT")?.filter(|unit| !unit.text.eq_ignore_ascii_case("N/A"));
    let stated = unit.map(|unit| metres("UNIT", &unit.text)).transpose()?;
    // A unit under another key, such as CORE_UNIT.
    for (objects, key, values) in label.statements() {
        let name = key.rsplit(':').next().unwrap_or(key);
        let of_samples = name == "UNITS"
            || UNITS_OF.iter().any(|what| [format!("{what}_UNIT"), format!("{what}_UNITS")].iter().any(|own| own == name));
        if objects.last().is_none_or(|object| object != "IMAGE") || !of_samples {
            continue;
        }
        for value in values.iter().filter(|value| !matches!(value.text.to_ascii_uppercase().as_str(), "N/A" | "NULL" | "NONE")) {
            let own_metres: f64 = metres(key, &value.text)?;
            if own_metres.to_bits() != stated.unwrap_or(1.0_f64).to_bits() {
                let unit = unit.map_or_else(|| "no UNIT".to_owned(), |unit| format!("UNIT {}", shown(&unit.text)));
                return Err(unsuitable(format!("{key} {} but {unit}", shown(&value.text)), "the same unit under the key UNIT"));
            }
        }
    }
    for key in ["SCALING_FACTOR", "OFFSET"] {
        let Some(own) = label.value("IMAGE", key)?.and_then(|value| value.unit.clone()) else { continue };
        // A factor may be given per stored number: <M/DN>.
        let length = own.split('/').next().unwrap_or_default();
        let own_metres: f64 = metres(key, length)?;
        if own_metres.to_bits() != stated.unwrap_or(1.0_f64).to_bits() {
            let unit = unit.map_or_else(|| "no UNIT".to_owned(), |unit| format!("UNIT {}", shown(&unit.text)));
            return Err(unsuitable(format!("{key} in {} but {unit}", shown(&own)), "one unit for UNIT, SCALING_FACTOR and OFFSET"));
        }
    }
    Ok(stated.unwrap_or(1.0))
}
