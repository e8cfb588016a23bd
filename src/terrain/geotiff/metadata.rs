//! GDAL's own tags: the no-data text, and the scale, offset and unit of the samples.

use crate::terrain::TerrainError;

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
}

/// Reads scale, offset and unit of the first band from the XML of tag 42112.
///
/// # Errors
/// [`TerrainError::Unsuitable`] if scale or offset is not a number, the scale is 0, or the unit is not the metre.
pub(super) fn read_scaling(xml: &str) -> Result<Scaling, TerrainError> {
    let mut scaling = Scaling::NONE;
    let mut rest = xml;
    while let Some((attributes, text, after)) = next_item(rest) {
        rest = after;
        if attribute(attributes, "sample").is_some_and(|sample| sample != "0") {
            continue;
        }
        match attribute(attributes, "role") {
            Some("scale") => scaling.scale = number("scale", text)?,
            Some("offset") => scaling.offset_m = number("offset", text)?,
            Some("unittype") => check_unit(text)?,
            _ => {}
        }
    }
    if scaling.scale == 0.0 {
        return Err(bad_number("scale", "0"));
    }
    Ok(scaling)
}

/// Attributes and text of the next `<Item ...>text</Item>`, and the rest.
fn next_item(xml: &str) -> Option<(&str, &str, &str)> {
    let (_, after) = xml.split_once("<Item")?;
    let (attributes, after) = after.split_once('>')?;
    let (text, after) = after.split_once("</Item>")?;
    Some((attributes, text.trim(), after))
}

fn attribute<'a>(attributes: &'a str, name: &str) -> Option<&'a str> {
    let mut rest = attributes;
    loop {
        let (key, after) = rest.split_once("=\"")?;
        let (value, after) = after.split_once('"')?;
        if key.trim() == name {
            return Some(value);
        }
        rest = after;
    }
}

fn number(name: &str, text: &str) -> Result<f64, TerrainError> {
    text.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| bad_number(name, text))
}

fn bad_number(name: &str, text: &str) -> TerrainError {
    TerrainError::Unsuitable {
        found: format!("an elevation {name} of '{}'", text.escape_debug().take(40).collect::<String>()),
        expected: "a finite number, and not 0 for a scale",
        mend: "gdal_translate -a_scale 1 -a_offset 0 in.tif out.tif".to_owned(),
    }
}

fn check_unit(unit: &str) -> Result<(), TerrainError> {
    if matches!(unit.to_ascii_lowercase().as_str(), "" | "m" | "metre" | "metres" | "meter" | "meters") {
        return Ok(());
    }
    Err(TerrainError::Unsuitable {
        found: format!("elevations in '{}'", unit.escape_debug().take(40).collect::<String>()),
        expected: "elevations in metres",
        mend: "gdal_calc.py -A in.tif --outfile=out.tif --calc='A*METRES_PER_UNIT'".to_owned(),
    })
}

/// The no-data value as text, before it is cast to the samples' type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NoData {
    value: f64,
    whole: Option<i128>,
}

/// A no-data value beyond this belongs to the "largest float" family, which programs print with as few as six digits.
const LARGEST_FLOAT_FAMILY: f64 = 1.0e30;
/// Six digits distinguish numbers that differ by more than this fraction.
const SIX_DIGITS: f64 = 1.0e-5;

impl NoData {
    /// Parses the text of tag 42113; `None` if it is empty.
    ///
    /// # Errors
    /// [`TerrainError::Unsuitable`] if it is not a number.
    pub(super) fn parse(text: &str) -> Result<Option<Self>, TerrainError> {
        let trimmed = text.trim_matches(|letter: char| letter == '\0' || letter.is_whitespace());
        if trimmed.is_empty() {
            return Ok(None);
        }
        let lower = trimmed.to_ascii_lowercase();
        let value = if lower.contains("nan") || lower.contains("#ind") { Some(f64::NAN) } else { lower.parse().ok() };
        let value = value.ok_or_else(|| TerrainError::Unsuitable {
            found: format!("the no-data value '{}'", trimmed.escape_debug().take(40).collect::<String>()),
            expected: "a number or nan",
            mend: "gdal_translate -a_nodata VALUE in.tif out.tif".to_owned(),
        })?;
        Ok(Some(Self { value, whole: trimmed.parse().ok() }))
    }

    /// Whether the value is a number: NaN samples are gaps in any case.
    pub(super) fn is_a_number(self) -> bool {
        !self.value.is_nan()
    }

    /// Whether a 64-bit sample equals the no-data value.
    pub(super) fn is_double(self, sample: f64) -> bool {
        let relative = (sample - self.value).abs() / self.value.abs();
        sample == self.value || (self.value.abs() > LARGEST_FLOAT_FAMILY && relative < SIX_DIGITS)
    }

    /// Whether a 32-bit sample equals the no-data value, which was cast the same way when the file was written.
    #[expect(clippy::cast_possible_truncation, reason = "the cast is the comparison meant")]
    pub(super) fn is_single(self, sample: f32) -> bool {
        sample == self.value as f32 || self.is_double(f64::from(sample))
    }

    /// Whether an integer sample equals the no-data value.
    pub(super) fn is_whole(self, sample: i128) -> bool {
        #[expect(clippy::cast_precision_loss, reason = "a value that is not an integer is compared as a float")]
        self.whole.map_or_else(|| sample as f64 == self.value, |whole| whole == sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_and_offset_of_the_first_band_are_read() {
        let xml = "<GDALMetadata>\n <Item name=\"A\">x &lt; y</Item><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">-1737400</Item>\n \
                   <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item><Item name=\"SCALE\" sample=\"1\" role=\"scale\">9</Item>\
                   <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">m</Item></GDALMetadata>";
        let scaling = read_scaling(xml).unwrap();
        assert_eq!(scaling, Scaling { scale: 0.5, offset_m: -1_737_400.0 });
        assert_eq!(scaling.apply(3.0), -1_737_398.5);
        assert_eq!(read_scaling("no xml at all <Item").unwrap(), Scaling::NONE);
    }

    #[test]
    fn invalid_scales_and_units_other_than_metres_are_refused() {
        for (text, role) in [("x", "scale"), ("0", "scale"), ("inf", "offset"), ("km", "unittype")] {
            let xml = format!("<Item name=\"N\" sample=\"0\" role=\"{role}\">{text}</Item>");
            assert!(read_scaling(&xml).unwrap_err().to_string().contains(text), "{xml}");
        }
    }

    #[test]
    fn no_data_is_compared_after_the_cast_that_wrote_it() {
        let mark = |text: &str| NoData::parse(text).unwrap().unwrap();
        let lola = f32::from_bits(0xff7f_fffb);
        assert_eq!(f64::from(lola), -3.402_822_655_088_904_5e38);
        assert!(mark("-3.4028226550889045e+38").is_single(lola));
        assert!(mark("-3.4028227e+38").is_single(lola));
        assert!(mark("-3.40282e+38").is_single(f32::MIN));
        assert!(mark("-3.4e+38").is_single(f32::from_bits(0xff7f_c99e)));
        assert!(!mark("-9999").is_single(-9998.999));
        assert!(mark("0.1").is_single(0.1));
        assert!(mark("9223372036854775807").is_whole(i128::from(i64::MAX)));
        assert!(!mark("9223372036854775807").is_whole(i128::from(i64::MAX) - 1));
        assert!(mark("-32768.0").is_whole(-32768));
        assert!(mark("nan\0").value.is_nan() && mark("-1.#IND").value.is_nan());
        assert!(mark("-inf").is_double(f64::NEG_INFINITY));
        assert_eq!(NoData::parse(" \0").unwrap(), None);
        assert!(NoData::parse("none").is_err());
    }
}
