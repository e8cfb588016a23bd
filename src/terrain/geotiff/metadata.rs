//! GDAL's own tags: the no-data text, and the scale, offset and unit of the samples.

use crate::quantity::is_metre;
use crate::terrain::stored::Scaling;
use crate::terrain::{InvalidNoData, NoData, TerrainError};

/// Reads scale, offset and unit of the first band from the XML of tag 42112; `None` if it states neither scale nor offset.
///
/// # Errors
/// [`TerrainError::Unsuitable`] if scale or offset is not a number, the scale is 0, or the unit is not the metre.
pub(super) fn read_scaling(xml: &str) -> Result<Option<Scaling>, TerrainError> {
    let (mut scale, mut offset_m) = (None, None);
    let mut rest = xml;
    while let Some((attributes, text, after)) = next_item(rest) {
        rest = after;
        if attribute(attributes, "sample").is_some_and(|sample| sample != "0") {
            continue;
        }
        match attribute(attributes, "role") {
            Some("scale") => scale = Some(number("scale", text)?),
            Some("offset") => offset_m = Some(number("offset", text)?),
            Some("unittype") => check_unit(text)?,
            _ => {}
        }
    }
    if scale == Some(0.0) {
        return Err(bad_number("scale", "0"));
    }
    let stated = scale.is_some() || offset_m.is_some();
    Ok(stated.then(|| Scaling { scale: scale.unwrap_or(1.0), offset_m: offset_m.unwrap_or(0.0) }))
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
    if unit.is_empty() || is_metre(unit) {
        return Ok(());
    }
    Err(TerrainError::Unsuitable {
        found: format!("elevations in '{}'", unit.escape_debug().take(40).collect::<String>()),
        expected: "elevations in metres",
        mend: "gdal_calc.py -A in.tif --outfile=out.tif --calc='A*METRES_PER_UNIT'".to_owned(),
    })
}

/// The no-data value of tag 42113; `None` if the text is empty.
///
/// # Errors
/// [`TerrainError::Unsuitable`] if it is not a number.
pub(super) fn read_no_data(text: &str) -> Result<Option<NoData>, TerrainError> {
    if text.trim_matches(|letter: char| letter == '\0' || letter.is_whitespace()).is_empty() {
        return Ok(None);
    }
    text.parse().map(Some).map_err(|InvalidNoData { found }| TerrainError::Unsuitable {
        found: format!("the no-data value '{found}'"),
        expected: "a number or nan",
        mend: "gdal_translate -a_nodata VALUE in.tif out.tif".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_and_offset_of_the_first_band_are_read() {
        let xml = "<GDALMetadata>\n <Item name=\"A\">x &lt; y</Item><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">-1737400</Item>\n \
                   <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item><Item name=\"SCALE\" sample=\"1\" role=\"scale\">9</Item>\
                   <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">m</Item></GDALMetadata>";
        let scaling = read_scaling(xml).unwrap().unwrap();
        assert_eq!(scaling, Scaling { scale: 0.5, offset_m: -1_737_400.0 });
        assert_eq!(scaling.apply(3.0), -1_737_398.5);
        assert_eq!(read_scaling("no xml at all <Item").unwrap(), None);
    }

    #[test]
    fn invalid_scales_and_units_other_than_metres_are_refused() {
        for (text, role) in [("x", "scale"), ("0", "scale"), ("inf", "offset"), ("km", "unittype")] {
            let xml = format!("<Item name=\"N\" sample=\"0\" role=\"{role}\">{text}</Item>");
            assert!(read_scaling(&xml).unwrap_err().to_string().contains(text), "{xml}");
        }
    }

    #[test]
    fn an_empty_no_data_text_states_nothing_and_words_are_refused() {
        assert_eq!(read_no_data(" \0").unwrap(), None);
        assert!(read_no_data("none").unwrap_err().to_string().contains("'none'"));
    }
}
