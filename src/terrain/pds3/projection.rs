//! The `IMAGE_MAP_PROJECTION` object: the position of the posts, and their map.

use super::label::{Label, shown, unsuitable};
use crate::quantity::{MapPoint, format_number, metres_or_kilometres};
use crate::terrain::{CoordinateSystem, GeoReference, TerrainError};
use crate::world::Body;

const OBJECT: &str = "IMAGE_MAP_PROJECTION";

/// The largest rotation of a map that still counts as north up, degrees: rounding in the label.
const STRAIGHT_DEG: f64 = 1.0e-9;

/// The position of the posts: `LINE_PROJECTION_OFFSET` and `SAMPLE_PROJECTION_OFFSET` count from the centre of the first post
/// to the origin of the map,
///
/// ```text
/// x = (column - SAMPLE_PROJECTION_OFFSET) * MAP_SCALE,   y = (LINE_PROJECTION_OFFSET - row) * MAP_SCALE,   row and column from 0
/// ```
///
/// (PDS data dictionary; GDAL's PDS driver puts the corner half a post outside the same centre).
///
/// # Errors
/// [`TerrainError::Unsuitable`] if the object or one of its keys is missing, its scale is not a length, or the map is
/// rotated.
pub(super) fn place(label: &Label) -> Result<GeoReference, TerrainError> {
    let missing = |key: &str| {
        unsuitable(
            format!("no {key} in an {OBJECT} object"),
            "MAP_SCALE, LINE_PROJECTION_OFFSET and SAMPLE_PROJECTION_OFFSET (some products keep them in DSMAP.CAT)",
        )
    };
    if let Some(turn) = label.number(OBJECT, "MAP_PROJECTION_ROTATION")?.filter(|turn| turn.abs() > STRAIGHT_DEG) {
        return Err(unsuitable(format!("MAP_PROJECTION_ROTATION {turn}"), "a north-up map"));
    }
    let scale_m = scale_m(label)?.ok_or_else(|| missing("MAP_SCALE"))?;
    let offset = |key: &str| label.number(OBJECT, key)?.ok_or_else(|| missing(key));
    let north_west = MapPoint::new(-offset("SAMPLE_PROJECTION_OFFSET")? * scale_m, offset("LINE_PROJECTION_OFFSET")? * scale_m);
    let mut georeference = GeoReference::local(north_west, scale_m, scale_m)?;
    georeference.coordinate_system = coordinate_system(label)?;
    Ok(georeference)
}

/// `MAP_SCALE` in m per post; without a unit it is in km, as the data dictionary defines.
fn scale_m(label: &Label) -> Result<Option<f64>, TerrainError> {
    let (Some(value), Some(number)) = (label.value(OBJECT, "MAP_SCALE")?, label.number(OBJECT, "MAP_SCALE")?) else {
        return Ok(None);
    };
    let unit = value.unit.clone().unwrap_or_else(|| "KM/PIXEL".to_owned());
    let (length, per) = unit.split_once('/').unwrap_or((&unit, "PIXEL"));
    let per_post = matches!(per.trim(), "PIXEL" | "PIXELS" | "PIX" | "PX" | "P" | "SAMPLE" | "POST");
    match metres_or_kilometres(length).filter(|_| per_post) {
        Some(metres) => Ok(Some(number * metres)),
        None => Err(unsuitable(format!("MAP_SCALE in {}", shown(&unit)), "<KM/PIXEL> or <M/PIXEL>")),
    }
}

/// `GeoTIFF` codes of a projection: its method, then key and value in degrees of each parameter.
struct Method {
    code: u16,
    parameters: Vec<(u16, f64)>,
}

/// "User-defined", which as a method means one that the keys cannot state.
const USER_DEFINED: u16 = 32767;

/// The map as `GeoTIFF` keys, so that all outputs can carry it; without numbers where the projection or the radii are not known.
fn coordinate_system(label: &Label) -> Result<CoordinateSystem, TerrainError> {
    let Some(projection) = label.value(OBJECT, "MAP_PROJECTION_TYPE")? else { return Ok(CoordinateSystem::default()) };
    let name = projection.text.to_ascii_uppercase();
    let target = label.value("", "TARGET_NAME")?.map(|target| target.text.clone()).unwrap_or_default();
    let description = Some(format!("{target} {name}").trim().to_owned());
    let west = points_west(label)?;
    let latitude = label.number(OBJECT, "CENTER_LATITUDE")?.unwrap_or(0.0);
    let longitude = label.number(OBJECT, "CENTER_LONGITUDE")?.unwrap_or(0.0) * if west { -1.0 } else { 1.0 };
    // A projection that is not known is stated as such, so that it is not taken for a local map.
    let method = method(&name, latitude, longitude).unwrap_or(Method { code: USER_DEFINED, parameters: Vec::new() });
    let axes = Axes::of(label)?;
    axes.check(&target)?;
    let mut doubles = Vec::new();
    // Projected, user-defined throughout, degrees and metres (OGC GeoTIFF 1.1).
    let mut entries = vec![
        [1024, 0, 1, 1],
        [1025, 0, 1, 2],
        [2048, 0, 1, USER_DEFINED],
        [2050, 0, 1, USER_DEFINED],
        [2054, 0, 1, 9102],
        [2056, 0, 1, USER_DEFINED],
        [3072, 0, 1, USER_DEFINED],
        [3074, 0, 1, USER_DEFINED],
        [3075, 0, 1, method.code],
        [3076, 0, 1, 9001],
    ];
    if let Some(equator_m) = axes.a_m {
        let pole_m = axes.c_m.unwrap_or(equator_m);
        check_latitude(label, latitude, equator_m, pole_m)?;
        check_resolution(label, equator_m)?;
        entries.extend([[2057, 34736, 1, 0], [2058, 34736, 1, 1]]);
        doubles.extend([equator_m, pole_m]);
    }
    for (key, value) in method.parameters.into_iter().chain([(3082, 0.0), (3083, 0.0)]) {
        entries.push([key, 34736, 1, u16::try_from(doubles.len()).unwrap_or(u16::MAX)]);
        doubles.push(value);
    }
    let mut ascii_parameters = String::new();
    let citation = description.clone().filter(|text| text.is_ascii() && text.len() < 200 && !text.contains(['|', '\0']));
    if let Some(citation) = citation {
        entries.push([3073, 34737, u16::try_from(citation.len() + 1).unwrap_or(u16::MAX), 0]);
        ascii_parameters = citation + "|";
    }
    entries.sort_unstable();
    let mut key_directory = vec![1, 1, 0, u16::try_from(entries.len()).unwrap_or(u16::MAX)];
    key_directory.extend(entries.into_iter().flatten());
    Ok(CoordinateSystem { key_directory, double_parameters: doubles, ascii_parameters, description })
}

/// The radii of the body, m: two of the equator, and that of the poles.
#[expect(clippy::struct_field_names, reason = "the axes of the standard, with their unit")]
struct Axes {
    a_m: Option<f64>,
    b_m: Option<f64>,
    c_m: Option<f64>,
}

/// No body that is mapped here is larger, m: Jupiter's equator is 71 492 km.
const LARGEST_RADIUS_M: f64 = 1.0e8;

/// The deviation of a radius from the mean one of its body that the shape can explain: km for m is off by a factor of 1000.
const SHAPE: f64 = 2.0;

impl Axes {
    fn of(label: &Label) -> Result<Self, TerrainError> {
        Ok(Self {
            a_m: radius_m(label, "A_AXIS_RADIUS")?,
            b_m: radius_m(label, "B_AXIS_RADIUS")?,
            c_m: radius_m(label, "C_AXIS_RADIUS")?,
        })
    }

    /// Refuses radii that contradict each other or the body.
    fn check(&self, target: &str) -> Result<(), TerrainError> {
        let mean_m = Body::named(target).map(|body| body.radius_m);
        let named = [("A", self.a_m), ("B", self.b_m), ("C", self.c_m)];
        for (axis, radius_m) in named.into_iter().filter_map(|(axis, radius_m)| Some((axis, radius_m?))) {
            let found = format!("{axis}_AXIS_RADIUS of {} m", format_number(radius_m));
            if !(radius_m > 0.0 && radius_m < LARGEST_RADIUS_M) {
                return Err(unsuitable(found, "a radius of a body, in km unless its unit says <M>"));
            }
            if let Some(mean_m) = mean_m.filter(|mean_m| !(mean_m / SHAPE..mean_m * SHAPE).contains(&radius_m)) {
                let found = format!("{found} for {}, whose radius is {} m", shown(target), format_number(mean_m));
                return Err(unsuitable(found, "radii of the body, in km unless their unit says <M>"));
            }
        }
        match (self.a_m, self.b_m) {
            (Some(a), Some(b)) if (a - b).abs() > 1.0e-6 * a => {
                let found = format!("A_AXIS_RADIUS of {} m and B_AXIS_RADIUS of {} m", format_number(a), format_number(b));
                Err(unsuitable(found, "a body with a round equator"))
            }
            _ => Ok(()),
        }
    }
}

/// Whether longitudes grow towards the west.
fn points_west(label: &Label) -> Result<bool, TerrainError> {
    let Some(way) = label.value(OBJECT, "POSITIVE_LONGITUDE_DIRECTION")? else { return Ok(false) };
    match way.text.to_ascii_uppercase().as_str() {
        "EAST" | "N/A" => Ok(false),
        "WEST" => Ok(true),
        _ => Err(unsuitable(format!("POSITIVE_LONGITUDE_DIRECTION {}", shown(&way.text)), "EAST or WEST")),
    }
}

/// On an ellipsoid, a centre between equator and pole has another latitude in each system.
fn check_latitude(label: &Label, latitude: f64, equator_m: f64, pole_m: f64) -> Result<(), TerrainError> {
    let Some(system) = label.value(OBJECT, "COORDINATE_SYSTEM_NAME")? else { return Ok(()) };
    let upper = system.text.to_ascii_uppercase();
    let known = ["PLANETOCENTRIC", "PLANETOGRAPHIC", "N/A", "MEAN EARTH", "IAU"].iter().any(|name| upper.starts_with(name));
    let round = (equator_m - pole_m).abs() <= 1.0e-6 * equator_m;
    if known || round || latitude == 0.0 || latitude.abs() == 90.0 {
        return Ok(());
    }
    let found = format!("COORDINATE_SYSTEM_NAME {} on a body whose radii differ", shown(&system.text));
    Err(unsuitable(found, "PLANETOCENTRIC or PLANETOGRAPHIC"))
}

/// Refuses a `MAP_RESOLUTION` and a `MAP_SCALE` that are not of one size: a degree of the equator has as many metres on all maps
/// that are true to scale somewhere.
fn check_resolution(label: &Label, equator_m: f64) -> Result<(), TerrainError> {
    let resolution =
        label.value(OBJECT, "MAP_RESOLUTION")?.filter(|value| value.unit.as_deref().is_none_or(|unit| unit.contains("DEG")));
    let per_degree = resolution.and_then(|value| value.text.parse::<f64>().ok()).filter(|per_degree| *per_degree > 0.0);
    let (Some(per_degree), Some(scale_m)) = (per_degree, scale_m(label)?) else { return Ok(()) };
    let implied_m = equator_m * std::f64::consts::PI / 180.0 / per_degree;
    if (scale_m / SHAPE..scale_m * SHAPE).contains(&implied_m) {
        return Ok(());
    }
    let found = format!(
        "MAP_SCALE of {} m but MAP_RESOLUTION {per_degree} per degree, which is {} m",
        format_number(scale_m),
        format_number(implied_m)
    );
    Err(unsuitable(found, "one size of posts"))
}

fn method(name: &str, latitude: f64, longitude: f64) -> Option<Method> {
    let (code, parameters) = match name.replace([' ', '-'], "_").as_str() {
        "SIMPLE_CYLINDRICAL" | "EQUIRECTANGULAR" => (17, vec![(3078, latitude), (3088, longitude), (3089, 0.0)]),
        "POLAR_STEREOGRAPHIC" => (15, vec![(3081, latitude), (3092, 1.0), (3095, longitude)]),
        "STEREOGRAPHIC" => (14, vec![(3088, longitude), (3089, latitude), (3092, 1.0)]),
        "SINUSOIDAL" => (24, vec![(3088, longitude)]),
        "ORTHOGRAPHIC" => (21, vec![(3088, longitude), (3089, latitude)]),
        "TRANSVERSE_MERCATOR" => (1, vec![(3080, longitude), (3081, latitude), (3092, 1.0)]),
        _ => return None,
    };
    Some(Method { code, parameters })
}

/// A radius in m; labels without a unit give km.
fn radius_m(label: &Label, key: &str) -> Result<Option<f64>, TerrainError> {
    let (Some(value), Some(number)) = (label.value(OBJECT, key)?, label.number(OBJECT, key)?) else { return Ok(None) };
    let unit = value.unit.as_deref().unwrap_or("KM");
    let metres = metres_or_kilometres(unit).ok_or_else(|| unsuitable(format!("{key} in {}", shown(unit)), "<KM>"))?;
    Ok(Some(number * metres))
}
