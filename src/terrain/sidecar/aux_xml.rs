//! `.aux.xml`: the statements that GDAL and `ArcGIS` keep beside a raster (persistent auxiliary metadata).

use std::path::Path;

use roxmltree::{Document, Node, ParsingOptions};

use super::{Transform, number, prj, refused, text_of};
use crate::quantity::{excerpt, is_metre, metres_per};
use crate::terrain::stored::{Scaling, convert_heights};
use crate::terrain::{NoData, TerrainError};

/// What a file states.
#[derive(Debug, Default)]
pub(super) struct Statements {
    pub(super) no_data: Option<NoData>,
    pub(super) scaling: Option<Scaling>,
    pub(super) projection: prj::Stated,
    pub(super) transform: Option<Transform>,
}

/// Elements that say nothing of places and elevations: statistics, pictures, texts.
const WITHOUT_EFFECT: [&str; 13] = [
    "Metadata",
    "Histograms",
    "Description",
    "CategoryNames",
    "ColorInterp",
    "ColorTable",
    "GDALRasterAttributeTable",
    "Minimum",
    "Maximum",
    "HistItem",
    "Overview",
    "XMP",
    "Esri",
];

/// Reads one file.
///
/// # Errors
/// [`TerrainError::Sidecar`] if it is not such XML, or states what is not supported.
pub(super) fn read(path: &Path) -> Result<Statements, TerrainError> {
    of_text(&text_of(path)?).map_err(|problem| refused(path, problem))
}

fn of_text(text: &str) -> Result<Statements, String> {
    let options = ParsingOptions { allow_dtd: false, nodes_limit: 1 << 20, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| {
        format!("it is not XML ({error}), expected a PAMDataset as GDAL writes it; remove it or write it again")
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "PAMDataset" {
        return Err(format!(
            "its root is <{}>, expected <PAMDataset>; move it away if it says nothing of the raster",
            root.tag_name().name()
        ));
    }
    let mut stated = Statements::default();
    for node in root.children().filter(Node::is_element) {
        match node.tag_name().name() {
            "SRS" => stated.projection = prj::of_text(node.text().unwrap_or_default()),
            "GeoTransform" => stated.transform = Some(transform(node.text().unwrap_or_default())?),
            "PAMRasterBand" => {
                if node.attribute("band").is_none_or(|band| band.trim().parse() == Ok(1)) {
                    band(node, &mut stated)?;
                }
            }
            "Metadata" if node.attribute("domain").is_some_and(|domain| domain.eq_ignore_ascii_case("xml:ESRI")) => {
                let moved = node.descendants().find(|inner| inner.tag_name().name() == "GeodataXform");
                if moved.is_some_and(|xform| xform.descendants().any(|inner| inner.tag_name().name() == "SourceGCPs")) {
                    return Err("a transformation by control points (GeodataXform), expected a north-up raster; \
                                apply it with: gdalwarp -r bilinear -ot Float64 -dstnodata nan in.tif out.tif"
                        .to_owned());
                }
            }
            "GCPList" => {
                return Err(
                    "ground control points, expected a north-up raster; apply them with: gdalwarp -r bilinear -ot Float64 -dstnodata nan in.tif out.tif"
                        .to_owned(),
                );
            }
            known if WITHOUT_EFFECT.contains(&known) => {}
            other => return Err(unknown(other)),
        }
    }
    Ok(stated)
}

/// No-data value, scale, offset and unit of a band.
fn band(band: Node<'_, '_>, stated: &mut Statements) -> Result<(), String> {
    let (mut scale, mut offset_m, mut unit) = (None, None, String::new());
    for node in band.children().filter(Node::is_element) {
        let text = node.text().unwrap_or_default().trim();
        match node.tag_name().name() {
            "NoDataValue" if node.attribute("le_hex_equiv").is_some() && text.is_empty() => {
                return Err("a no-data value in hexadecimal only, expected a number; write it with: gdal_edit.py -a_nodata VALUE"
                    .to_owned());
            }
            "NoDataValue" | "NoDataValueAsInt64" | "NoDataValueAsUInt64" => {
                let value = text
                    .parse::<NoData>()
                    .map_err(|error| format!("{error}; correct it with: gdal_edit.py -a_nodata VALUE FILE"))?;
                stated.no_data = Some(value);
            }
            "Scale" => scale = Some(number("scale", text)?),
            "Offset" => offset_m = Some(number("offset", text)?),
            "UnitType" => text.clone_into(&mut unit),
            known if WITHOUT_EFFECT.contains(&known) => {}
            other => return Err(unknown(other)),
        }
    }
    if scale == Some(0.0) {
        return Err("a scale of 0, expected another number; correct it with: gdal_edit.py -scale 1 FILE".to_owned());
    }
    let scaling = Scaling { scale: scale.unwrap_or(1.0), offset_m: offset_m.unwrap_or(0.0) };
    stated.scaling = (scale.is_some() || offset_m.is_some()).then_some(scaling);
    if !(unit.is_empty() || is_metre(&unit)) {
        return Err(format!(
            "elevations in '{}', expected elevations in metres; convert them with: {}",
            excerpt(&unit, 40),
            convert_heights(None, scaling, metres_per(&unit))
        ));
    }
    Ok(())
}

/// GDAL's six numbers: x = t0 + t1 i + t2 j and y = t3 + t4 i + t5 j at the corners of pixels.
fn transform(text: &str) -> Result<Transform, String> {
    let words: Vec<&str> = text.split(',').collect();
    let &[t0, t1, t2, t3, t4, t5] = &words[..] else {
        return Err(format!("a GeoTransform of {} numbers, expected six; correct it with: gdal_edit.py -a_ullr", words.len()));
    };
    let read = |word: &str| number("GeoTransform number", word);
    let (a, b, d, e) = (read(t1)?, read(t2)?, read(t4)?, read(t5)?);
    Ok([a, b, read(t0)? + 0.5 * (a + b), d, e, read(t3)? + 0.5 * (d + e)])
}

fn unknown(element: &str) -> String {
    format!(
        "the element <{element}>, which is not known here and could change the raster's meaning, expected statements as GDAL writes them; \
         write a raster without sidecar files with: gdal_translate in.tif out.tif"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_of_the_first_band_are_read() {
        let text = "<PAMDataset><GeoTransform> 10, 2, 0, 20, 0, -4</GeoTransform><Metadata><MDI key=\"a\">b</MDI></Metadata>\
                    <PAMRasterBand band=\"1\"><NoDataValue>-9.99900000000000E+03</NoDataValue><Offset>100</Offset><Scale>0.1</Scale>\
                    <UnitType>metre</UnitType></PAMRasterBand><PAMRasterBand band=\"2\"><Scale>7</Scale></PAMRasterBand></PAMDataset>";
        let stated = of_text(text).unwrap();
        assert_eq!(stated.no_data.map(NoData::value), Some(-9999.0));
        assert_eq!(stated.scaling, Some(Scaling { scale: 0.1, offset_m: 100.0 }));
        assert_eq!(stated.transform, Some([2.0, 0.0, 11.0, 0.0, -4.0, 18.0]));
        assert!(stated.projection.is_none());
    }

    /// What changes the meaning and is not understood is refused by name.
    #[test]
    fn what_is_not_understood_is_refused_by_name() {
        for (inside, word) in [
            ("<PAMRasterBand><UnitType>ft</UnitType></PAMRasterBand>", "'ft'"),
            ("<PAMRasterBand><Scale>0</Scale></PAMRasterBand>", "scale of 0"),
            ("<PAMRasterBand><Offset>x</Offset></PAMRasterBand>", "'x'"),
            ("<PAMRasterBand><NoDataValue>none</NoDataValue></PAMRasterBand>", "'none'"),
            ("<PAMRasterBand><NewThing/></PAMRasterBand>", "<NewThing>"),
            ("<GeoTransform>1,2</GeoTransform>", "2 numbers"),
            ("<GCPList/>", "control points"),
            ("<Other/>", "<Other>"),
        ] {
            let problem = of_text(&format!("<PAMDataset>{inside}</PAMDataset>")).unwrap_err();
            assert!(problem.contains(word) && problem.contains("expected"), "{problem}");
        }
        assert!(of_text("no xml").is_err() && of_text("<a/>").is_err());
    }
}
