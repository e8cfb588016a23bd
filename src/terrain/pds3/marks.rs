//! Keys whose values stand for missing elevations, and keys that change the meaning of samples in a way that is not known here.

use super::label::{Label, Value, shown, unsuitable};
use super::samples::{Mark, SampleType, mark};
use crate::terrain::TerrainError;

/// Keys whose values mean no elevation: the standard's, those of ISIS, and those of missions (SELENE/Kaguya, Mars Express).
const MARKS: [&str; 41] = [
    "INVALID",
    "FILL",
    "BLANK",
    "MISSING_CONSTANT",
    "MISSING",
    "MISSING_VALUE",
    "MISSING_DN",
    "MISSING_DATA_VALUE",
    "DTM_MISSING_DN",
    "INVALID_CONSTANT",
    "INVALID_VALUE",
    "INVALID_DN",
    "OUT_OF_IMAGE_BOUNDS_VALUE",
    "NULL",
    "NULL_CONSTANT",
    "NULL_VALUE",
    "NULL_DN",
    "NODATA",
    "NODATA_VALUE",
    "NO_DATA",
    "NO_DATA_VALUE",
    "NO_DATA_CONSTANT",
    "FILL_VALUE",
    "FILL_CONSTANT",
    "DUMMY",
    "DUMMY_DATA",
    "DUMMY_VALUE",
    "DUMMY_CONSTANT",
    "UNKNOWN_CONSTANT",
    "NOT_APPLICABLE_CONSTANT",
    "ERROR_CONSTANT",
    "SATURATED_CONSTANT",
    "HIGH_INSTR_SATURATION",
    "LOW_INSTR_SATURATION",
    "HIGH_REPR_SATURATION",
    "LOW_REPR_SATURATION",
    "CORE_NULL",
    "CORE_LOW_REPR_SATURATION",
    "CORE_HIGH_REPR_SATURATION",
    "CORE_LOW_INSTR_SATURATION",
    "CORE_HIGH_INSTR_SATURATION",
];

/// Texts that say that a key has no value.
const NO_VALUE: [&str; 4] = ["N/A", "NULL", "NONE", "NOT_APPLICABLE"];

/// Words of keys that describe an image without changing what its samples mean: statistics, names, counts.
const HARMLESS: [&str; 34] = [
    "MAXIMUM",
    "MINIMUM",
    "MAX",
    "MIN",
    "MEAN",
    "MEDIAN",
    "MODE",
    "AVERAGE",
    "STANDARD",
    "DEVIATION",
    "VARIANCE",
    "SIGMA",
    "RMS",
    "CHECKSUM",
    "MD5",
    "TYPE",
    "FLAG",
    "DESC",
    "DESCRIPTION",
    "NAME",
    "NOTE",
    "COUNT",
    "COUNTS",
    "PIXELS",
    "LINES",
    "SAMPLES",
    "PERCENT",
    "PERCENTAGE",
    "UNIT",
    "FORMAT",
    "ID",
    "STRETCH",
    "STRETCHED",
    "QUALITY",
];

/// Last words of keys that name special values of samples.
const SPECIAL_ENDINGS: [&str; 9] = ["VALUE", "VALUES", "CONSTANT", "CONSTANTS", "DN", "NULL", "SATURATION", "NODATA", "DUMMY"];

/// Words, one of which makes such a key one of missing samples, outside the IMAGE object.
const SPECIAL_WORDS: [&str; 15] = [
    "MISSING",
    "INVALID",
    "NULL",
    "NODATA",
    "FILL",
    "DUMMY",
    "VOID",
    "BLANK",
    "BACKGROUND",
    "SATURATION",
    "SPECIAL",
    "BOUNDS",
    "EMPTY",
    "GAP",
    "PAD",
];

/// Endings of keys that convert samples.
const CONVERSIONS: [(&str, f64); 12] = [
    ("SCALING_FACTOR", 1.0),
    ("SCALE_FACTOR", 1.0),
    ("SCALE", 1.0),
    ("SCALING", 1.0),
    ("MULTIPLIER", 1.0),
    ("GAIN", 1.0),
    ("TO_METERS", 1.0),
    ("TO_METRES", 1.0),
    ("OFFSET", 0.0),
    ("BASE", 0.0),
    ("BIAS", 0.0),
    ("INTERCEPT", 0.0),
];

/// Objects whose keys describe other data than the image.
const OTHER_DATA: [&str; 8] = ["TABLE", "COLUMN", "SPREADSHEET", "FIELD", "HISTOGRAM", "QUBE", "SERIES", "CATALOG"];

const EXPECTED: &str = "keys whose meaning for the samples is known here, such as MISSING_CONSTANT";

/// The stored values that mean no elevation.
///
/// # Errors
/// [`TerrainError::Unsuitable`] with the first key that changes what samples mean and is not known.
pub(super) fn marks(label: &Label, sample: SampleType) -> Result<Vec<Mark>, TerrainError> {
    let mut marks = Vec::new();
    for (objects, key, values) in label.statements() {
        let object = objects.last().map_or("", String::as_str);
        if objects.iter().any(|object| OTHER_DATA.iter().any(|data| object.ends_with(data))) {
            continue;
        }
        // `LRO:NULL` is the key NULL of a mission.
        let name = key.rsplit(':').next().unwrap_or(key);
        let of_image = object == "IMAGE";
        let given = || values.iter().filter(|value| !NO_VALUE.iter().any(|none| value.text.eq_ignore_ascii_case(none)));
        if MARKS.contains(&name) {
            for value in given() {
                marks.push(mark(key, value)?);
            }
        } else if of_image && matches!(name, "VALID_MINIMUM" | "VALID_MAXIMUM") {
            for value in given() {
                let limit = sample.number_of(mark(key, value)?);
                marks.push(if name == "VALID_MINIMUM" { Mark::Below(limit) } else { Mark::Above(limit) });
            }
        } else if of_image && name == "SAMPLE_BIT_MASK" {
            given().try_for_each(|value| whole_sample(value, sample))?;
        } else if given().next().is_some() {
            check(object, name, key, values)?;
        }
    }
    Ok(marks)
}

/// Refuses a key that names special values or converts samples, and is not known.
fn check(object: &str, name: &str, key: &str, values: &[Value]) -> Result<(), TerrainError> {
    let of_image = object == "IMAGE";
    let words: Vec<&str> = name.split('_').collect();
    let refusal = || {
        let text = values.iter().map(|value| value.text.as_str()).collect::<Vec<_>>().join(", ");
        let place = if object.is_empty() { String::new() } else { format!(" in its {object} object") };
        unsuitable(format!("{key} = {}{place}, whose meaning for the samples is not known here", shown(&text)), EXPECTED)
    };
    if words.iter().any(|word| HARMLESS.contains(word)) {
        return Ok(());
    }
    let is_number = |value: &Value| value.text.parse::<f64>().is_ok();
    if of_image && words.iter().any(|word| SPECIAL_WORDS.contains(word)) && values.iter().any(is_number) {
        return Err(refusal());
    }
    let ends_special = words.last().is_some_and(|last| SPECIAL_ENDINGS.contains(last));
    if ends_special && (of_image || words.iter().any(|word| SPECIAL_WORDS.contains(word))) {
        return Err(refusal());
    }
    let directions = [("LINE_DISPLAY_DIRECTION", "DOWN"), ("SAMPLE_DISPLAY_DIRECTION", "RIGHT")];
    if let Some((_, usual)) = directions.iter().find(|(direction, _)| of_image && *direction == name)
        && values.iter().any(|value| !value.text.eq_ignore_ascii_case(usual))
    {
        return Err(refusal());
    }
    // SCALING_FACTOR and OFFSET of the IMAGE object are applied; one of a mission must change nothing.
    let applied = of_image && matches!(name, "SCALING_FACTOR" | "OFFSET");
    let of_heights = ["DTM_", "DEM_", "ELEVATION_", "HEIGHT_", "TOPO_"].iter().any(|start| name.starts_with(start));
    if let Some((_, neutral)) = CONVERSIONS.iter().find(|(ending, _)| name.ends_with(ending))
        && !applied
        && (of_image || of_heights)
        && values.iter().any(|value| value.text.parse::<f64>().ok() != Some(*neutral))
    {
        return Err(refusal());
    }
    Ok(())
}

/// Refuses a mask that leaves out bits of the samples.
fn whole_sample(value: &Value, sample: SampleType) -> Result<(), TerrainError> {
    let all = u64::MAX >> (64 - 8 * sample.bytes());
    match mark("SAMPLE_BIT_MASK", value)? {
        Mark::Bits(bits) if bits == all => Ok(()),
        _ => Err(unsuitable(format!("SAMPLE_BIT_MASK {}", shown(&value.text)), "samples all of whose bits count")),
    }
}
