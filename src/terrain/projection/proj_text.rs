//! Parses the proj string of a projection, which the comments of a chain CSV contain.

use std::collections::BTreeMap;

use super::codes;
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
        let mut projection = Self::new(definition, name)?;
        let epsg = |code: &String| codes::epsg(code.strip_prefix("EPSG:")?.parse().ok()?);
        // A code that belongs to another projection is dropped.
        projection.code = code.filter(|code| epsg(code) == Some(definition)).or(projection.code);
        Ok(projection)
    }
}

/// The parameters of a proj string; those used are removed, so that the remaining ones are unsupported.
struct Words<'a>(BTreeMap<&'a str, &'a str>);

impl<'a> Words<'a> {
    fn of(text: &'a str) -> Result<Self, String> {
        let mut words = BTreeMap::new();
        for word in text.split_whitespace() {
            let (key, value) = word.strip_prefix('+').unwrap_or(word).split_once('=').unwrap_or((word, ""));
            if words.insert(key.trim_start_matches('+'), value).is_some() {
                return Err(format!("{key} is given twice"));
            }
        }
        Ok(Self(words))
    }

    fn number(&mut self, key: &str) -> Result<Option<f64>, String> {
        let Some(value) = self.0.remove(key) else { return Ok(None) };
        value.parse().ok().filter(|number: &f64| number.is_finite()).map(Some).ok_or_else(|| format!("{key} is not a number"))
    }

    fn or_zero(&mut self, key: &str) -> Result<f64, String> {
        Ok(self.number(key)?.unwrap_or(0.0))
    }
}

fn parse(text: &str) -> Result<Definition, String> {
    let mut words = Words::of(text)?;
    let proj = words.0.remove("proj").ok_or("+proj is missing")?;
    let ellipsoid = ellipsoid(&mut words)?;
    let latitude_deg = words.or_zero("lat_0")?;
    let parallels_1 = words.number("lat_1")?;
    let parallel_2 = words.number("lat_2")?;
    let method = match (proj, latitude_deg.abs() == 90.0, parallel_2) {
        ("stere", true, _) => Method::PolarStereographic,
        ("lcc", _, Some(_)) => Method::LambertConformalTwoParallels,
        ("lcc", _, None) => Method::LambertConformalOneParallel,
        (proj, _, _) => Method::ALL
            .into_iter()
            .find(|method| method.proj() == proj && *method != Method::PolarStereographic)
            .ok_or_else(|| format!("+proj={proj} is not supported"))?,
    };
    let true_scale = words.number("lat_ts")?;
    let parallels_deg = match method {
        Method::LambertConformalTwoParallels => [parallels_1, parallel_2],
        Method::Equirectangular => [Some(true_scale.unwrap_or(0.0)), None],
        Method::PolarStereographic | Method::Mercator => [true_scale, None],
        _ if true_scale.is_some() => return Err("+lat_ts does not belong to this projection".to_owned()),
        _ => [None; 2],
    };
    if method == Method::LambertConformalOneParallel && parallels_1 != Some(latitude_deg) {
        return Err("+lat_1 differs from +lat_0".to_owned());
    }
    let scale = words.number("k_0")?.or(words.number("k")?).unwrap_or(1.0);
    let definition = Definition {
        parallels_deg,
        scale,
        false_easting_m: words.or_zero("x_0")?,
        false_northing_m: words.or_zero("y_0")?,
        ..Definition::about(method, latitude_deg, words.or_zero("lon_0")?, ellipsoid)
    };
    for (key, expected) in [("units", "m"), ("no_defs", ""), ("type", "crs")] {
        if words.0.remove(key).is_some_and(|value| value != expected) {
            return Err(format!("+{key} is not {expected}"));
        }
    }
    match words.0.into_keys().next() {
        Some(unknown) => Err(format!("+{unknown} is not supported")),
        None => Ok(definition),
    }
}

fn ellipsoid(words: &mut Words<'_>) -> Result<Ellipsoid, String> {
    if let Some(radius_m) = words.number("R")? {
        return Ok(Ellipsoid::sphere(radius_m));
    }
    let semi_major_m = words.number("a")?.ok_or("+R or +a is missing")?;
    match (words.number("b")?, words.number("rf")?) {
        (Some(semi_minor_m), None) => Ok(Ellipsoid { semi_major_m, semi_minor_m }),
        (None, Some(inverse)) => Ok(Ellipsoid::with_inverse_flattening(semi_major_m, inverse)),
        _ => Err("+a without one of +b and +rf".to_owned()),
    }
}
