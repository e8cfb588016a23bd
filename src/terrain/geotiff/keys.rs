//! The `GeoKeys` and the tags of the transform: the position of the posts, and their units.

use super::{key, tag, units};
use crate::quantity::MapPoint;
use crate::terrain::projection::states_a_map;
use crate::terrain::sidecar::Transform;
use crate::terrain::stored::Scaling;
use crate::terrain::{CoordinateSystem, GeoReference, TerrainError, TransformTags};

/// A rotation or shear below this fraction of the spacing is attributed to rounding in the file.
const STRAIGHT: f64 = 1.0e-9;

/// The position of the posts, and whether the file stores the southernmost row first.
#[derive(Debug)]
pub(super) struct Placement {
    pub(super) georeference: GeoReference,
    pub(super) south_up: bool,
    /// Whether the file states a projected map; if not, the units are judged by the numbers.
    pub(super) states_metres: bool,
}

/// The tags of one image that are used here.
#[derive(Debug, Default)]
pub(super) struct GeoTags {
    pub(super) coordinate_system: CoordinateSystem,
    pub(super) transform: TransformTags,
}

impl GeoTags {
    /// Reads the image's tags; a tag of another type than the standard's counts as absent.
    pub(super) fn of(image: &tiff_reader::Ifd) -> Self {
        let doubles = |code| image.tag(code).and_then(|tag| tag.value.as_f64_vec()).unwrap_or_default();
        let text = |code| image.tag(code).and_then(|tag| tag.value.as_str()).map(str::to_owned);
        let mut coordinate_system = CoordinateSystem {
            key_directory: image.tag(tag::KEY_DIRECTORY).and_then(|tag| tag.value.as_u16_slice()).unwrap_or_default().to_vec(),
            double_parameters: doubles(tag::DOUBLE_PARAMETERS),
            ascii_parameters: text(tag::ASCII_PARAMETERS).unwrap_or_default(),
            description: None,
        };
        coordinate_system.description = description(&coordinate_system);
        Self {
            coordinate_system,
            transform: TransformTags {
                pixel_scale: doubles(tag::PIXEL_SCALE),
                tie_points: doubles(tag::TIE_POINTS),
                transformation: doubles(tag::TRANSFORMATION),
                no_data: text(tag::GDAL_NO_DATA),
            },
        }
    }

    /// The scaling of the elevations that the transform states: GDAL writes it there where the map has a reference system of heights.
    ///
    /// # Errors
    /// [`TerrainError::Unsuitable`] for a scale of heights without such a system: programs differ in whether it counts.
    pub(super) fn vertical_scaling(&self) -> Result<Option<Scaling>, TerrainError> {
        let ([_, _, scale, ..], [_, _, k, _, _, z, ..]) = (&self.transform.pixel_scale[..], &self.transform.tie_points[..]) else {
            return Ok(None);
        };
        if *scale == 0.0 {
            return Ok(None);
        }
        let scaling = Scaling { scale: *scale, offset_m: z - k * scale };
        let heights = short_key(&self.coordinate_system, key::VERTICAL_CRS).is_some_and(|code| code != 0);
        match (heights, scaling == Scaling::NONE) {
            (_, true) => Ok(None),
            (true, false) => Ok(Some(scaling)),
            (false, false) if *scale == 1.0 => Ok(None),
            (false, false) => Err(unsuitable(
                format!("a scale of {scale} for heights in its transform, without a reference system of heights"),
                "one statement of how elevations are stored",
                "gdal_translate in.tif out.tif, if the stored numbers are the elevations",
            )),
        }
    }

    /// Checks units and transform, and computes the position of the raster's posts. A raster that states no transform has the one
    /// that stands beside it.
    ///
    /// # Errors
    /// [`TerrainError::Unsuitable`] for degrees, other units than metres, rotated or mirrored transforms, or no transform.
    pub(super) fn place(self, rows: usize, beside: Option<Transform>, scaling: Scaling) -> Result<Placement, TerrainError> {
        units::check(&self.coordinate_system, scaling)?;
        let states_metres = states_a_map(&self.coordinate_system);
        let post_at_tie = short_key(&self.coordinate_system, key::RASTER_TYPE) == Some(key::PIXEL_IS_POINT);
        let states_none = self.transform.pixel_scale.is_empty()
            && self.transform.tie_points.is_empty()
            && self.transform.transformation.is_empty();
        let lattice = match beside.filter(|_| states_none) {
            // World files and the like give the centres of the posts.
            Some([a, b, c, d, e, f]) => Lattice::of_matrix([a, b, c, d, e, f], 0.0)?,
            None => Lattice::of(&self.transform, if post_at_tie { 0.0 } else { 0.5 })?,
        };
        let south_up = lattice.step_y > 0.0;
        #[expect(clippy::cast_precision_loss, reason = "rows stay below 2^32")]
        let last_row = (rows.saturating_sub(1)) as f64;
        let north = if south_up { lattice.first.y + last_row * lattice.step_y } else { lattice.first.y };
        let mut georeference = GeoReference::local(MapPoint::new(lattice.first.x, north), lattice.step_x, lattice.step_y.abs())?;
        georeference.coordinate_system = self.coordinate_system;
        georeference.transform_tags = self.transform;
        Ok(Placement { georeference, south_up, states_metres })
    }
}

/// The first post of the file and the steps to its right and lower neighbours.
struct Lattice {
    first: MapPoint,
    step_x: f64,
    step_y: f64,
}

impl Lattice {
    /// `half` is the position of a post in its pixel, relative to the corner or post whose position the tags give.
    fn of(tags: &TransformTags, half: f64) -> Result<Self, TerrainError> {
        if let ([scale_x, scale_y, ..], [i, j, _, x, y, _, ..]) = (&tags.pixel_scale[..], &tags.tie_points[..]) {
            if !(*scale_x > 0.0 && *scale_y > 0.0) {
                let found = format!("a pixel scale of ({scale_x}, {scale_y})");
                let mend = if *scale_x < 0.0 && *scale_y > 0.0 {
                    // New borders would leave the columns in their order and mirror the map.
                    "gdalwarp -r near -ot Float64 -dstnodata nan in.tif out.tif (the columns run from east to west)"
                } else {
                    "a raster made again from its source (programs differ in how they read such a scale)"
                };
                return Err(unsuitable(found, "scales above 0", mend));
            }
            let first = MapPoint::new(x + (half - i) * scale_x, y - (half - j) * scale_y);
            return Ok(Self { first, step_x: *scale_x, step_y: -scale_y });
        }
        if let [a, b, _, d, e, f, _, h, ..] = tags.transformation[..] {
            return Self::of_matrix([a, b, d, e, f, h], half);
        }
        if tags.tie_points.len() > 6 {
            return Err(unsuitable(
                format!("{} ground control points and no pixel scale", tags.tie_points.len() / 6),
                "a north-up raster",
                "gdalwarp -r bilinear -ot Float64 -dstnodata nan in.tif out.tif",
            ));
        }
        Err(unsuitable(
            "no position on a map (neither ModelPixelScale with ModelTiepoint nor ModelTransformation)".to_owned(),
            "a raster placed on a map in metres",
            "gdal_translate -a_ullr WEST NORTH EAST SOUTH in.tif out.tif (in metres; 0 HEIGHT WIDTH 0 for a local map)",
        ))
    }

    /// x = a i + b j + d and y = e i + f j + h for column i and row j.
    fn of_matrix([a, b, d, e, f, h]: [f64; 6], half: f64) -> Result<Self, TerrainError> {
        if !(b.abs() <= STRAIGHT * a.abs() && e.abs() <= STRAIGHT * f.abs()) {
            return Err(unsuitable(
                format!("a rotated or sheared raster (transformation x = {a} i + {b} j + {d}, y = {e} i + {f} j + {h})"),
                "a north-up raster",
                "gdalwarp -r bilinear -ot Float64 -dstnodata nan in.tif out.tif",
            ));
        }
        if a.is_nan() || a <= 0.0 || f.is_nan() || f == 0.0 {
            return Err(unsuitable(
                format!("columns that run by {a} m eastward and rows by {f} m northward"),
                "columns from west to east, rows along the meridian",
                "gdalwarp -r near -ot Float64 -dstnodata nan in.tif out.tif",
            ));
        }
        Ok(Self { first: MapPoint::new(a * half + d, f * half + h), step_x: a, step_y: f })
    }
}

pub(super) fn unsuitable(found: String, expected: &'static str, mend: &str) -> TerrainError {
    TerrainError::Unsuitable { found, expected, mend: mend.to_owned() }
}

/// The entry of a key: location, count, and value or offset.
fn entry(system: &CoordinateSystem, wanted: u16) -> Option<[u16; 3]> {
    let keys = system.key_directory.get(4..)?;
    keys.chunks_exact(4).find_map(|entry| match *entry {
        [id, location, count, value] if id == wanted => Some([location, count, value]),
        _ => None,
    })
}

pub(in crate::terrain) fn short_key(system: &CoordinateSystem, wanted: u16) -> Option<u16> {
    match entry(system, wanted)? {
        [0, _, value] => Some(value),
        _ => None,
    }
}

pub(in crate::terrain) fn double_key(system: &CoordinateSystem, wanted: u16) -> Option<f64> {
    match entry(system, wanted)? {
        [tag::DOUBLE_PARAMETERS, _, offset] => system.double_parameters.get(usize::from(offset)).copied(),
        _ => None,
    }
}

pub(in crate::terrain) fn text_key(system: &CoordinateSystem, wanted: u16) -> Option<&str> {
    match entry(system, wanted)? {
        [tag::ASCII_PARAMETERS, count, offset] => {
            let start = usize::from(offset);
            let text =
                system.ascii_parameters.get(start..start + usize::from(count)).or_else(|| system.ascii_parameters.get(start..))?;
            Some(text.trim_end_matches(['|', '\0'])).filter(|text| !text.is_empty())
        }
        _ => None,
    }
}

/// The citation of the projected map if there is one, else the general one, else the geographic one, else the EPSG code.
fn description(system: &CoordinateSystem) -> Option<String> {
    let cited =
        [key::PROJECTED_CITATION, key::CITATION, key::GEOGRAPHIC_CITATION].into_iter().find_map(|wanted| text_key(system, wanted));
    let epsg =
        || short_key(system, key::PROJECTED_CRS).filter(|code| *code != key::USER_DEFINED).map(|code| format!("EPSG:{code}"));
    cited.map(str::to_owned).or_else(epsg)
}

/// The directory with the raster type set, inserted in the required order of keys.
pub(super) fn with_raster_type(directory: &[u16], raster_type: u16) -> Vec<u16> {
    let header = directory.get(..3).unwrap_or(&[1, 1, 0]);
    let mut entries: Vec<[u16; 4]> = directory
        .get(4..)
        .unwrap_or_default()
        .chunks_exact(4)
        .filter_map(|entry| <[u16; 4]>::try_from(entry).ok())
        .filter(|entry| entry[0] != key::RASTER_TYPE)
        .collect();
    entries.push([key::RASTER_TYPE, 0, 1, raster_type]);
    entries.sort_by_key(|entry| entry[0]);
    let mut result = header.to_vec();
    result.push(u16::try_from(entries.len()).unwrap_or(u16::MAX));
    result.extend(entries.into_iter().flatten());
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(entries: &[[u16; 4]]) -> CoordinateSystem {
        let mut key_directory = vec![1, 1, 0, u16::try_from(entries.len()).unwrap()];
        key_directory.extend(entries.iter().flatten());
        CoordinateSystem { key_directory, ..CoordinateSystem::default() }
    }

    fn scaled() -> TransformTags {
        TransformTags {
            pixel_scale: vec![2.0, 4.0, 0.0],
            tie_points: vec![0.0, 0.0, 0.0, 100.0, 200.0, 0.0],
            ..TransformTags::default()
        }
    }

    fn place(entries: &[[u16; 4]], transform: TransformTags) -> Result<Placement, TerrainError> {
        GeoTags { coordinate_system: keys(entries), transform }.place(11, None, Scaling::NONE)
    }

    #[test]
    fn posts_are_pixel_centres_unless_the_tie_point_is_a_post() {
        let area = place(&[[1024, 0, 1, 1], [1025, 0, 1, 1]], scaled()).unwrap();
        assert_eq!(area.georeference.north_west(), MapPoint::new(101.0, 198.0));
        assert!(area.states_metres && !area.south_up);
        let point = place(&[[1025, 0, 1, 2]], scaled()).unwrap();
        assert_eq!(point.georeference.north_west(), MapPoint::new(100.0, 200.0));
        assert!(!point.states_metres);
        let tied_elsewhere = TransformTags { tie_points: vec![3.0, 5.0, 0.0, 100.0, 200.0, 0.0], ..scaled() };
        assert_eq!(place(&[], tied_elsewhere).unwrap().georeference.north_west(), MapPoint::new(95.0, 218.0));
    }

    #[test]
    fn a_matrix_with_rows_from_the_south_is_turned_round() {
        let mut matrix = vec![0.0; 16];
        (matrix[0], matrix[3], matrix[5], matrix[7], matrix[15]) = (2.0, 100.0, 4.0, 200.0, 1.0);
        let south_up = place(&[], TransformTags { transformation: matrix.clone(), ..TransformTags::default() }).unwrap();
        assert!(south_up.south_up);
        assert_eq!(south_up.georeference.north_west(), MapPoint::new(101.0, 242.0));
        matrix[1] = 0.1;
        let message =
            place(&[], TransformTags { transformation: matrix.clone(), ..TransformTags::default() }).unwrap_err().to_string();
        assert!(message.contains("rotated") && message.contains("gdalwarp"), "{message}");
        (matrix[1], matrix[0]) = (0.0, -2.0);
        assert!(place(&[], TransformTags { transformation: matrix, ..TransformTags::default() }).is_err());
    }

    #[test]
    fn units_other_than_metres_are_refused_by_name() {
        for (entries, word) in [
            (&[[1024, 0, 1, 2]][..], "degrees"),
            (&[[1024, 0, 1, 3]], "geocentric"),
            (&[[1024, 0, 1, 1], [3076, 0, 1, 9003]], "US survey feet"),
            (&[[1024, 0, 1, 1], [3076, 0, 1, 9036]], "kilometres"),
            (&[[1024, 0, 1, 1], [3076, 0, 1, 32767]], "not stated"),
            (&[[1024, 0, 1, 1], [4099, 0, 1, 9002]], "elevations in feet"),
        ] {
            let message = place(entries, scaled()).unwrap_err().to_string();
            assert!(message.contains(word) && message.contains("gdal"), "{message}");
        }
        let mut own_unit = keys(&[[1024, 0, 1, 1], [3076, 0, 1, 32767], [3077, 34736, 1, 0]]);
        own_unit.double_parameters = vec![1.0];
        assert!(GeoTags { coordinate_system: own_unit.clone(), transform: scaled() }.place(2, None, Scaling::NONE).is_ok());
        own_unit.double_parameters = vec![1000.0];
        assert!(GeoTags { coordinate_system: own_unit, transform: scaled() }.place(2, None, Scaling::NONE).is_err());
        assert_eq!((units::feet("NAD83 / Texas Central (ftUS)"), units::feet("Craft 1")), (Some(9003), None));
    }

    #[test]
    fn no_transform_negative_scales_and_control_points_are_refused() {
        let message = place(&[], TransformTags::default()).unwrap_err().to_string();
        assert!(message.contains("-a_ullr"), "{message}");
        assert!(place(&[], TransformTags { pixel_scale: vec![1.0, -1.0, 0.0], ..scaled() }).is_err());
        assert!(place(&[], TransformTags { pixel_scale: vec![], tie_points: vec![0.0; 24], ..scaled() }).is_err());
    }

    #[test]
    fn setting_the_raster_type_keeps_order_and_count() {
        assert_eq!(with_raster_type(&[], 2), [1, 1, 0, 1, 1025, 0, 1, 2]);
        let directory = [1, 1, 1, 2, 1024, 0, 1, 1, 3072, 0, 1, 3035];
        assert_eq!(with_raster_type(&directory, 2), [1, 1, 1, 3, 1024, 0, 1, 1, 1025, 0, 1, 2, 3072, 0, 1, 3035]);
        let replaced = with_raster_type(&with_raster_type(&directory, 1), 2);
        assert_eq!(replaced, with_raster_type(&directory, 2));
    }
}
