//! A projection from its PROJ string.

use std::collections::BTreeMap;

use super::codes;
use super::crs_error::CrsError;
use super::{Definition, Ellipsoid, MapProjection, Method, NoProjection};

impl MapProjection {
    /// A projection from a proj string in metres and degrees, with its name and code.
    ///
    /// # Errors
    /// [`NoProjection::Unknown`] with the first unsupported parameter: ignoring it would give another map.
    ///
    /// # Examples
    /// ```
    /// use chta::terrain::MapProjection;
    /// let text = "+proj=stere +lat_0=-90 +lon_0=0 +k_0=1 +x_0=0 +y_0=0 +R=1737400 +units=m +no_defs";
    /// assert_eq!(MapProjection::from_proj_string(text, None, None).unwrap().proj_string(), text);
    /// assert!(MapProjection::from_proj_string("+proj=stere +R=1737400 +gamma=3", None, None).is_err());
    /// ```
    pub fn from_proj_string(text: &str, name: Option<String>, code: Option<String>) -> Result<Self, NoProjection> {
        let definition = parse(text).map_err(|reason| NoProjection::Unknown(format!("'{text}': {reason}")))?;
        Ok(Self::new(definition, name)?.with_epsg(code))
    }
}

/// The words of a PROJ string. Words that have been read are removed; what is left at the end is not supported.
struct Words<'a>(BTreeMap<&'a str, &'a str>);

impl<'a> Words<'a> {
    fn of(text: &'a str) -> Result<Self, CrsError> {
        let mut words = BTreeMap::new();
        for word in text.split_whitespace() {
            let word = word.strip_prefix('+').unwrap_or(word);
            let (key, value) = word.split_once('=').unwrap_or((word, ""));
            if words.insert(key, value).is_some() {
                return Err(CrsError::Repeated { item: shown(key) });
            }
        }
        Ok(Self(words))
    }

    fn take(&mut self, key: &str) -> Option<&'a str> {
        self.0.remove(key)
    }

    fn number(&mut self, key: &str) -> Result<Option<f64>, CrsError> {
        self.take(key).map(|value| finite(key, value)).transpose()
    }

    fn or_zero(&mut self, key: &str) -> Result<f64, CrsError> {
        Ok(self.number(key)?.unwrap_or(0.0))
    }

    /// Removes `+nadgrids=@null`; any other grid is left, and refused.
    fn take_null_grid(&mut self) -> Result<bool, CrsError> {
        match self.take("nadgrids") {
            None => Ok(false),
            Some("@null") => Ok(true),
            Some(grids) => Err(CrsError::UnknownParameter {
                item: format!("+nadgrids={}", CrsError::excerpt(grids)),
                expected: "no shift between datums",
            }),
        }
    }

    /// Removes words that do not affect the map as long as they have these values.
    fn take_idle(&mut self) -> Result<(), CrsError> {
        if let Some(unit) = self.take("units").filter(|unit| *unit != "m") {
            return Err(CrsError::Unit { what: "+units: map coordinates", found: CrsError::excerpt(unit), expected: "metres" });
        }
        for (key, expected) in [("no_defs", ""), ("wktext", ""), ("type", "crs"), ("axis", "enu")] {
            if let Some(value) = self.take(key).filter(|value| *value != expected) {
                let expected = "+no_defs, +wktext, +type=crs or +axis=enu";
                return Err(CrsError::UnknownParameter { item: format!("{}={}", shown(key), CrsError::excerpt(value)), expected });
            }
        }
        if let Some(shift) = self.take("towgs84")
            && !shift.split(',').all(|part| part.trim().parse() == Ok(0.0))
        {
            return Err(CrsError::UnknownParameter {
                item: format!("+towgs84={}", CrsError::excerpt(shift)),
                expected: "no shift between datums",
            });
        }
        Ok(())
    }
}

/// A key as it stands in the text.
fn shown(key: &str) -> String {
    format!("+{}", CrsError::excerpt(key))
}

fn finite(key: &str, value: &str) -> Result<f64, CrsError> {
    let number = value.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| CrsError::NotANumber { item: shown(key), found: CrsError::excerpt(value) })
}

/// Reads a PROJ string.
pub(super) fn parse(text: &str) -> Result<Definition, CrsError> {
    let mut words = Words::of(text)?;
    let proj = words.take("proj").ok_or(CrsError::Missing { item: "+proj", expected: "the projection method" })?;
    match proj {
        "longlat" | "latlong" | "lonlat" | "latlon" => {
            return Err(CrsError::NotProjected { found: format!("+proj={proj}, a map in degrees of longitude and latitude") });
        }
        "geocent" | "cart" => return Err(CrsError::NotProjected { found: format!("+proj={proj}, geocentric coordinates") }),
        _ => {}
    }
    let figure = ellipsoid(&mut words)?;
    // `+nadgrids=@null` on a sphere: latitudes stay those of WGS 84, which is the one pseudo-Mercator map.
    let on_null_grid = words.take_null_grid()?;
    let (proj, ellipsoid) = match proj {
        "merc" if on_null_grid && figure == Ellipsoid::sphere(Ellipsoid::WGS84.semi_major_m) => ("webmerc", Ellipsoid::WGS84),
        _ if on_null_grid => {
            return Err(CrsError::UnknownParameter { item: "+nadgrids=@null".to_owned(), expected: "it in EPSG:3857 alone" });
        }
        _ => (proj, figure),
    };
    let meridian_deg = match words.take("pm") {
        None => 0.0,
        Some(name) if name.eq_ignore_ascii_case("greenwich") => 0.0,
        Some(value) => finite("pm", value)?,
    };
    let mut definition = if proj == "utm" { utm(&mut words, ellipsoid)? } else { by_method(proj, &mut words, ellipsoid)? };
    definition.longitude_deg += meridian_deg;
    words.take_idle()?;
    match words.0.into_keys().next() {
        Some(unknown) => Err(CrsError::UnknownParameter {
            item: shown(unknown),
            expected: "+lat_0, +lon_0, +lat_ts, +lat_1, +lat_2, +k_0, +x_0, +y_0, +pm, a figure of the body and +units=m",
        }),
        None => Ok(definition),
    }
}

fn utm(words: &mut Words<'_>, ellipsoid: Ellipsoid) -> Result<Definition, CrsError> {
    let expected = "the number of a UTM zone, 1 to 60";
    let zone = words.take("zone").ok_or(CrsError::Missing { item: "+zone", expected })?;
    let number = zone.parse().ok().filter(|zone| (1..=60).contains(zone));
    let zone = number.ok_or_else(|| CrsError::UnknownParameter { item: format!("+zone={}", CrsError::excerpt(zone)), expected })?;
    Ok(codes::utm(zone, words.take("south").is_some(), ellipsoid))
}

fn by_method(proj: &str, words: &mut Words<'_>, ellipsoid: Ellipsoid) -> Result<Definition, CrsError> {
    let latitude_deg = words.or_zero("lat_0")?;
    let parallels_1 = words.number("lat_1")?;
    let parallel_2 = words.number("lat_2")?;
    let method = match (proj, latitude_deg.abs() == 90.0, parallel_2) {
        ("stere", true, _) => Method::PolarStereographic,
        ("lcc", _, Some(_)) => Method::LambertConformalTwoParallels,
        ("lcc", _, None) => Method::LambertConformalOneParallel,
        (proj, _, _) => {
            Method::ALL.into_iter().find(|method| method.proj() == proj && *method != Method::PolarStereographic).ok_or_else(
                || CrsError::UnknownMethod { found: format!("+proj={}", CrsError::excerpt(proj)), expected: Method::names() },
            )?
        }
    };
    let true_scale = words.number("lat_ts")?;
    let parallels_deg = match method {
        Method::LambertConformalTwoParallels => [parallels_1, parallel_2],
        // PROJ's defaults.
        Method::AlbersEqualArea => [Some(parallels_1.unwrap_or(0.0)), Some(parallel_2.unwrap_or(0.0))],
        Method::Equirectangular => [Some(true_scale.unwrap_or(0.0)), None],
        // PROJ takes the parallel on the side of the pole, whatever its sign, and true scale at the pole is the default.
        Method::PolarStereographic => {
            let on_side = |parallel: f64| if parallel == 0.0 { parallel } else { parallel.abs().copysign(latitude_deg) };
            [true_scale.filter(|parallel| parallel.abs() != 90.0).map(on_side), None]
        }
        Method::Mercator => [true_scale, None],
        Method::PseudoMercator => [true_scale.filter(|parallel_deg| *parallel_deg != 0.0), None],
        _ if true_scale.is_some() => return Err(surplus("+lat_ts")),
        _ => [None; 2],
    };
    let conic =
        matches!(method, Method::LambertConformalOneParallel | Method::LambertConformalTwoParallels | Method::AlbersEqualArea);
    if !conic && (parallels_1.is_some() || parallel_2.is_some()) {
        return Err(surplus(if parallels_1.is_some() { "+lat_1" } else { "+lat_2" }));
    }
    if method == Method::LambertConformalOneParallel && parallels_1 != Some(latitude_deg) {
        return Err(CrsError::Contradiction {
            found: "+lat_1 differs from +lat_0".to_owned(),
            expected: "one latitude, or +lat_1 and +lat_2",
        });
    }
    let scale = match (words.number("k_0")?, words.number("k")?) {
        (Some(_), Some(_)) => return Err(CrsError::Repeated { item: "the scale (+k_0 and +k)".to_owned() }),
        (scale, other) => scale.or(other).unwrap_or(1.0),
    };
    Ok(Definition {
        parallels_deg,
        scale,
        false_easting_m: words.or_zero("x_0")?,
        false_northing_m: words.or_zero("y_0")?,
        ..Definition::about(method, latitude_deg, words.or_zero("lon_0")?, ellipsoid)
    })
}

fn surplus(item: &str) -> CrsError {
    CrsError::UnknownParameter { item: item.to_owned(), expected: "the parameters of its +proj alone" }
}

/// The figure of the body, by exactly one of `+R`, `+a` with another axis or flattening, `+datum`, `+ellps`; a datum may repeat its
/// ellipsoid.
fn ellipsoid(words: &mut Words<'_>) -> Result<Ellipsoid, CrsError> {
    let named = |key: &str, name: &str| {
        let expected = "WGS84, GRS80 or NAD83, or the radii themselves as +R or +a and +b";
        codes::named_ellipsoid(name)
            .ok_or_else(|| CrsError::UnknownParameter { item: format!("{}={}", shown(key), CrsError::excerpt(name)), expected })
    };
    let radius_m = words.number("R")?;
    let semi_major_m = words.number("a")?;
    let datum = words.take("datum").map(|name| named("datum", name)).transpose()?;
    let ellps = words.take("ellps").map(|name| named("ellps", name)).transpose()?;
    match (radius_m, semi_major_m, datum, ellps) {
        (Some(radius_m), None, None, None) => Ok(Ellipsoid::sphere(radius_m)),
        (None, Some(semi_major_m), None, None) => with_axis(semi_major_m, words),
        (None, None, Some(figure), None) | (None, None, None, Some(figure)) => Ok(figure),
        (None, None, Some(datum), Some(ellps)) if datum == ellps => Ok(datum),
        (None, None, None, None) => Err(CrsError::Missing { item: "+R or +a", expected: "the radius of the body, m" }),
        _ => Err(CrsError::Contradiction {
            found: "several figures of the body".to_owned(),
            expected: "one of +R, +a with +b or +rf or +f, +datum, +ellps",
        }),
    }
}

/// An ellipsoid from its semi-major axis and one more word.
fn with_axis(semi_major_m: f64, words: &mut Words<'_>) -> Result<Ellipsoid, CrsError> {
    match (words.number("b")?, words.number("rf")?, words.number("f")?) {
        (Some(semi_minor_m), None, None) => Ok(Ellipsoid { semi_major_m, semi_minor_m }),
        (None, Some(inverse), None) => Ok(Ellipsoid::with_inverse_flattening(semi_major_m, inverse)),
        (None, None, Some(flattening)) => Ok(Ellipsoid { semi_major_m, semi_minor_m: semi_major_m * (1.0 - flattening) }),
        (None, None, None) => Err(CrsError::Missing { item: "+b", expected: "the semi-minor axis, m, or +rf or +f, beside +a" }),
        _ => Err(CrsError::Contradiction { found: "several of +b, +rf and +f".to_owned(), expected: "one of them beside +a" }),
    }
}
