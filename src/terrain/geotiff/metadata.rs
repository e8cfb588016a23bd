//! GDAL's own tags: the no-data text, and the scale, offset and unit of the samples.

use crate::quantity::{excerpt, is_metre, metres_per};
use crate::terrain::stored::{Scaling, convert_heights};
use crate::terrain::{InvalidNoData, NoData, TerrainError};

/// How the first band stores elevations.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Stored {
    /// Scale and offset, if one of them is stated.
    pub(super) scaling: Option<Scaling>,
    /// The unit; empty if none is stated.
    pub(super) unit: String,
}

/// The scaling that two places of a file state.
///
/// # Errors
/// [`TerrainError::Unsuitable`] if they differ.
pub(super) fn one_scaling(by_metadata: Option<Scaling>, by_transform: Option<Scaling>) -> Result<Option<Scaling>, TerrainError> {
    match (by_metadata, by_transform) {
        (Some(one), Some(other)) if one != other => Err(TerrainError::Unsuitable {
            found: format!(
                "elevations of {} times the stored number plus {} m by its metadata, and of {} times plus {} m by its transform",
                one.scale, one.offset_m, other.scale, other.offset_m
            ),
            expected: "one scaling of the elevations",
            mend: "gdal_translate -a_scale SCALE -a_offset OFFSET in.tif out.tif".to_owned(),
        }),
        (one, other) => Ok(one.or(other)),
    }
}

/// Reads scale, offset and unit of the first band from the XML of tag 42112.
///
/// # Errors
/// [`TerrainError::Unsuitable`] if scale or offset is not a number, the scale is 0, or the unit is not the metre.
pub(super) fn read_stored(xml: &str) -> Result<Stored, TerrainError> {
    let (mut scale, mut offset_m, mut unit) = (None, None, String::new());
    let mut rest = xml;
    while let Some((attributes, text, after)) = next_item(rest) {
        rest = after;
        if attribute(attributes, "sample").is_some_and(|sample| sample != "0") {
            continue;
        }
        match attribute(attributes, "role") {
            Some("scale") => scale = Some(number("scale", text)?),
            Some("offset") => offset_m = Some(number("offset", text)?),
            Some("unittype") => text.clone_into(&mut unit),
            _ => {}
        }
    }
    if scale == Some(0.0) {
        return Err(bad_number("scale", "0"));
    }
    let stated = scale.is_some() || offset_m.is_some();
    let scaling = stated.then(|| Scaling { scale: scale.unwrap_or(1.0), offset_m: offset_m.unwrap_or(0.0) });
    Ok(Stored { scaling, unit })
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

/// Refuses elevations in another unit than the metre, with the command that converts them.
///
/// # Errors
/// [`TerrainError::Unsuitable`].
pub(super) fn check_unit(unit: &str, scaling: Scaling) -> Result<(), TerrainError> {
    if unit.is_empty() || is_metre(unit) {
        return Ok(());
    }
    Err(TerrainError::Unsuitable {
        found: format!("elevations in '{}'", excerpt(unit, 40)),
        expected: "elevations in metres",
        mend: convert_heights(None, scaling, metres_per(unit)),
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
        let scaling = read_stored(xml).unwrap().scaling.unwrap();
        assert_eq!(scaling, Scaling { scale: 0.5, offset_m: -1_737_400.0 });
        assert_eq!(scaling.apply(3.0), -1_737_398.5);
        assert_eq!(read_stored("no xml at all <Item").unwrap(), Stored::default());
    }

    #[test]
    fn invalid_scales_and_units_other_than_metres_are_refused() {
        for (text, role) in [("x", "scale"), ("0", "scale"), ("inf", "offset")] {
            let xml = format!("<Item name=\"N\" sample=\"0\" role=\"{role}\">{text}</Item>");
            assert!(read_stored(&xml).unwrap_err().to_string().contains(text), "{xml}");
        }
        let scaling = Scaling { scale: 0.5, offset_m: 10.0 };
        for (unit, command) in
            [("km", "-a_scale 500 -a_offset 10000 "), ("ft", "-a_scale 0.1524 -a_offset 3.048 "), ("ell", "METRES_PER_UNIT")]
        {
            let message = check_unit(unit, scaling).unwrap_err().to_string();
            assert!(message.contains(command) && message.contains(unit), "{message}");
        }
        assert!(check_unit("", scaling).is_ok() && check_unit("Metre", scaling).is_ok());
    }

    #[test]
    fn an_empty_no_data_text_states_nothing_and_words_are_refused() {
        assert_eq!(read_no_data(" \0").unwrap(), None);
        assert!(read_no_data("none").unwrap_err().to_string().contains("'none'"));
    }
}
