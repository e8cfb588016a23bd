//! A projection from the text that states a coordinate reference system: a code, a PROJ string or well-known text.

use std::str::FromStr;

use super::MapProjection;
use super::codes;
use super::crs_error::CrsError;
use super::definition::Definition;
use super::proj_text;
use super::wkt_read::{self, Stated};

impl MapProjection {
    /// A projection from the code of an authority: `EPSG:32633`, `IAU_2015:30135`, or its uniform resource name
    /// (`urn:ogc:def:crs:IAU:2015:30135`). The code is its name.
    ///
    /// # Errors
    /// [`CrsError::UnknownCode`], which lists the codes that are known.
    ///
    /// # Examples
    /// ```
    /// use chta::terrain::MapProjection;
    /// let south_pole_of_the_moon = MapProjection::from_code("IAU_2015:30135")?;
    /// assert_eq!(
    ///     south_pole_of_the_moon.proj_string(),
    ///     "+proj=stere +lat_0=-90 +lon_0=0 +k_0=1 +x_0=0 +y_0=0 +R=1737400 +units=m +no_defs"
    /// );
    /// assert!(MapProjection::from_code("EPSG:2278").unwrap_err().to_string().contains("gdalsrsinfo"));
    /// # Ok::<(), chta::terrain::CrsError>(())
    /// ```
    pub fn from_code(code: &str) -> Result<Self, CrsError> {
        let (code, definition) = codes::by_code(code.trim())
            .ok_or_else(|| CrsError::UnknownCode { found: CrsError::excerpt(code.trim()), expected: codes::KNOWN_CODES })?;
        Ok(Self::valid(definition, Some(code.clone()))?.with_epsg(Some(code)))
    }

    /// A projection from a PROJ string in metres and degrees, such as `+proj=stere +lat_0=-85 +lon_0=30 +R=1737400` or
    /// `+proj=utm +zone=33 +datum=WGS84`.
    ///
    /// # Errors
    /// [`CrsError`] for the first word that is not supported: ignoring it would give another map.
    ///
    /// # Examples
    /// ```
    /// use chta::terrain::{CrsError, MapProjection};
    /// assert!(MapProjection::from_proj("+proj=stere +lat_0=-85 +lon_0=30 +R=1737400").is_ok());
    /// assert!(matches!(MapProjection::from_proj("+proj=longlat +R=1737400"), Err(CrsError::NotProjected { .. })));
    /// assert!(matches!(MapProjection::from_proj("+proj=sinu +R=1737400 +units=km"), Err(CrsError::Unit { .. })));
    /// ```
    pub fn from_proj(text: &str) -> Result<Self, CrsError> {
        Self::valid(proj_text::parse(text)?, None)
    }

    /// A projection from well-known text: WKT 1 of OGC and GDAL, WKT 1 of ESRI (the content of a `.prj` file), or WKT 2 of 2015 and
    /// 2019. Of a compound system, the horizontal part is used; its heights must be in metres. An EPSG code in the text is kept if
    /// it states the same map.
    ///
    /// # Errors
    /// [`CrsError`]: broken text, a system that is not a projected map, units other than metres and degrees, an unsupported method
    /// or parameter, invalid numbers.
    ///
    /// # Examples
    /// ```
    /// use chta::terrain::MapProjection;
    /// let written = MapProjection::from_code("IAU_2015:49910")?;
    /// let read = MapProjection::from_wkt(&written.wkt())?;
    /// assert_eq!(read.definition(), written.definition());
    /// # Ok::<(), chta::terrain::CrsError>(())
    /// ```
    pub fn from_wkt(text: &str) -> Result<Self, CrsError> {
        match wkt_read::read(text.trim_start_matches('\u{feff}'))? {
            Stated::Proj(proj) => Self::from_proj(&proj),
            Stated::Map(map) => {
                let name = map.name.filter(|name| !name.is_empty() && !name.eq_ignore_ascii_case("unknown"));
                Ok(Self::valid(map.definition, name)?.with_epsg(map.code))
            }
        }
    }

    fn valid(definition: Definition, name: Option<String>) -> Result<Self, CrsError> {
        Self::made(definition, name).map_err(|fault| CrsError::Invalid { fault })
    }
}

/// Reads a code, a PROJ string or well-known text.
///
/// ```
/// use chta::terrain::MapProjection;
/// let by_code: MapProjection = "EPSG:32633".parse()?;
/// let by_proj: MapProjection = "+proj=utm +zone=33 +datum=WGS84 +units=m +no_defs".parse()?;
/// let by_wkt: MapProjection = by_code.wkt().parse()?;
/// assert!(by_code.definition() == by_proj.definition() && by_proj.definition() == by_wkt.definition());
/// # Ok::<(), chta::terrain::CrsError>(())
/// ```
impl FromStr for MapProjection {
    type Err = CrsError;

    fn from_str(text: &str) -> Result<Self, CrsError> {
        let text = text.trim_start_matches('\u{feff}').trim();
        if text.split_whitespace().any(|word| word.starts_with("+proj=") || word.starts_with("proj=")) && !text.contains(['[', '('])
        {
            Self::from_proj(text)
        } else if text.starts_with(|letter: char| letter.is_ascii_alphabetic()) && text.contains(['[', '(']) {
            Self::from_wkt(text)
        } else if text.starts_with(|letter: char| letter.is_ascii_alphabetic()) && text.contains(':') {
            Self::from_code(text)
        } else {
            Err(CrsError::NotRecognised { found: CrsError::excerpt(text) })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::{Ellipsoid, Method};

    const MOON: Ellipsoid = Ellipsoid::sphere(1_737_400.0);

    /// A projected map of the Moon in WKT 1.
    fn wkt_1(projection: &str, more: &str) -> String {
        format!(
            "PROJCS[\"m\",GEOGCS[\"g\",DATUM[\"d\",SPHEROID[\"s\",1737400,0]],PRIMEM[\"p\",0],UNIT[\"degree\",0.0174532925199433]],\
             PROJECTION[\"{projection}\"],{more}]"
        )
    }

    const METRE: &str = "UNIT[\"metre\",1]";

    fn definition(text: &str) -> Definition {
        *text.parse::<MapProjection>().unwrap_or_else(|error| panic!("{text}: {error}")).definition()
    }

    #[test]
    fn every_code_of_the_iau_is_found_again_from_its_numbers() {
        for body in [199, 299, 301, 499] {
            for map in [10, 15, 20, 25, 30, 35, 60, 65, 70, 75, 80] {
                let code = format!("IAU_2015:{}", body * 100 + map);
                let by_code = MapProjection::from_code(&code).unwrap();
                assert_eq!((by_code.code(), by_code.name()), (Some(code.as_str()), code.as_str()));
                let by_proj = MapProjection::from_proj(&by_code.proj_string()).unwrap();
                assert_eq!((by_proj.code(), by_proj.definition()), (Some(code.as_str()), by_code.definition()));
                assert_eq!(MapProjection::from_code(&by_code.urn().unwrap()).unwrap(), by_code);
            }
        }
    }

    #[test]
    fn keys_restore_the_projection_of_every_form_with_its_code() {
        for text in [
            "EPSG:32633",
            "epsg:32733",
            "urn:ogc:def:crs:EPSG::3413",
            "EPSG:5042",
            "EPSG:3035",
            "IAU_2015:49975",
            "+proj=utm +zone=7 +south +ellps=GRS80",
            "+proj=stere +lat_0=-85.5 +lon_0=12 +R=1737400",
            "+proj=lcc +lat_1=20 +lat_2=40 +lat_0=30 +a=3396190 +b=3376200",
            &wkt_1("Polar_Stereographic", &format!("PARAMETER[\"latitude_of_origin\",-71],{METRE}")),
        ] {
            let projection: MapProjection = text.parse().unwrap();
            assert_eq!(MapProjection::of(&projection.coordinate_system()).unwrap(), projection, "{text}");
        }
        assert_eq!("epsg:32733".parse::<MapProjection>().unwrap().code(), Some("EPSG:32733"));
    }

    #[test]
    fn proj_strings_as_other_programs_write_them_state_the_same_map() {
        let same = |a: &str, b: &str| assert_eq!(definition(a), definition(b), "{a}");
        same("+proj=utm +zone=33 +datum=WGS84 +units=m +no_defs +type=crs", "EPSG:32633");
        same("+proj=utm +zone=12 +datum=NAD83 +ellps=GRS80 +towgs84=0,0,0,0,0,0,0 +units=m +no_defs", "EPSG:26912");
        same("+proj=stere +lat_0=-90 +lat_ts=-71 +lon_0=0 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs", "EPSG:3031");
        same("+proj=stere +lat_0=-90 +lat_ts=71 +datum=WGS84", "EPSG:3031");
        same("+proj=stere +lat_0=90 +lat_ts=90 +k=0.994 +x_0=2000000 +y_0=2000000 +datum=WGS84", "EPSG:5041");
        same("proj=sinu lon_0=180 R=1737400 wktext", "IAU_2015:30125");
        same("+proj=sinu +lon_0=150 +pm=30 +R=1737400", "IAU_2015:30125");
        same("+proj=ortho +a=1737400 +f=0", "IAU_2015:30165");
    }

    #[test]
    fn well_known_text_of_every_dialect_states_the_same_map() {
        let polar = |latitude_deg, parallel_deg| Definition {
            parallels_deg: [parallel_deg, None],
            ..Definition::about(Method::PolarStereographic, latitude_deg, 0.0, MOON)
        };
        for (projection, parameters, expected) in [
            (
                "Polar_Stereographic",
                "PARAMETER[\"latitude_of_origin\",-71],PARAMETER[\"scale_factor\",1]",
                polar(-90.0, Some(-71.0)),
            ),
            ("Polar_Stereographic", "PARAMETER[\"latitude_of_origin\",-90],PARAMETER[\"scale_factor\",1]", polar(-90.0, None)),
            (
                "Polar_Stereographic",
                "PARAMETER[\"latitude_of_origin\",90],PARAMETER[\"standard_parallel_1\",70]",
                polar(90.0, Some(70.0)),
            ),
            ("Stereographic_South_Pole", "PARAMETER[\"Standard_Parallel_1\",-71]", polar(-90.0, Some(-71.0))),
            ("Stereographic_North_Pole", "PARAMETER[\"Standard_Parallel_1\",90]", polar(90.0, None)),
            ("Stereographic", "PARAMETER[\"Latitude_Of_Origin\",-90]", polar(-90.0, None)),
            ("Polar Stereographic (variant B)", "PARAMETER[\"Latitude of standard parallel\",70]", polar(90.0, Some(70.0))),
        ] {
            assert_eq!(definition(&wkt_1(projection, &format!("{parameters},{METRE}"))), expected, "{projection}");
        }
        // As written to a .prj file.
        let others =
            Method::ALL.into_iter().filter(|method| !matches!(method, Method::PolarStereographic | Method::PseudoMercator));
        for method in others {
            let parallels_deg = match method {
                Method::Equirectangular => [Some(20.0), None],
                Method::LambertConformalTwoParallels | Method::AlbersEqualArea => [Some(5.0), Some(31.0)],
                _ => [None; 2],
            };
            let no_latitude = matches!(method, Method::Sinusoidal | Method::Mercator | Method::Equirectangular);
            let written = Definition {
                parallels_deg,
                scale: if method.has_scale() { 0.9875 } else { 1.0 },
                false_easting_m: 1000.5,
                ..Definition::about(method, if no_latitude { 0.0 } else { 12.5 }, -77.25, MOON)
            };
            let projection = MapProjection::new(written, Some("a \"map\"".to_owned())).unwrap();
            assert_eq!(
                MapProjection::from_wkt(&projection.wkt()).unwrap(),
                MapProjection { name: "a _map_".to_owned(), ..projection }
            );
        }
    }

    #[test]
    fn compound_and_bound_systems_and_meridians_are_understood() {
        let plain = wkt_1("Sinusoidal", &format!("PARAMETER[\"longitude_of_center\",20],{METRE}"));
        let expected = Definition::about(Method::Sinusoidal, 0.0, 20.0, MOON);
        assert_eq!(definition(&plain), expected);
        assert_eq!(definition(&format!("BOUNDCRS[SOURCECRS[{plain}],TARGETCRS[GEOGCRS[\"g\"]]]")), expected);
        assert_eq!(definition(&plain.replace("PRIMEM[\"p\",0]", "PRIMEM[\"p\",-15]")).longitude_deg, 5.0);
        let heights = |unit: &str| format!("COMPD_CS[\"c\",{plain},VERT_CS[\"h\",VERT_DATUM[\"v\",2005],{unit}]]");
        assert_eq!(definition(&heights(METRE)), expected);
        let error = heights("UNIT[\"US survey foot\",0.304800609601219]").parse::<MapProjection>().unwrap_err();
        assert!(matches!(&error, CrsError::Unit { what: "elevations", .. }), "{error}");
    }

    #[test]
    fn an_epsg_code_in_well_known_text_is_kept_only_if_it_states_the_same_map() {
        let utm = MapProjection::from_code("EPSG:32633").unwrap().wkt();
        let with =
            |id: &str| MapProjection::from_wkt(&utm.replace("UNIT[\"Meter\",1.0]", &format!("UNIT[\"Meter\",1.0],{id}"))).unwrap();
        assert_eq!(with("AUTHORITY[\"EPSG\",\"32633\"]").code(), Some("EPSG:32633"));
        assert_eq!(with("ID[\"EPSG\",32633]").code(), Some("EPSG:32633"));
        assert_eq!(with("ID[\"EPSG\",32634]").code(), None);
    }

    #[test]
    fn texts_without_a_usable_map_are_refused_with_the_reason() {
        let read = |text: &str| text.parse::<MapProjection>().expect_err(text);
        macro_rules! refused {
            ($text:expr, $kind:pat, $word:expr) => {
                let error = read($text);
                assert!(matches!(&error, $kind) && error.to_string().contains($word), "{}: {error:?}", $text);
            };
        }
        refused!("", CrsError::NotRecognised { .. }, "EPSG:32633");
        refused!("crater.prj", CrsError::NotRecognised { .. }, "crater.prj");
        refused!("{\"type\": \"ProjectedCRS\"}", CrsError::NotRecognised { .. }, "ProjectedCRS");
        refused!("EPSG:4326", CrsError::UnknownCode { .. }, "EPSG:4326");
        refused!("IAU_2015:30136", CrsError::UnknownCode { .. }, "BB35");
        refused!("ESRI:102004", CrsError::UnknownCode { .. }, "ESRI:102004");
        refused!("EPSG:-1", CrsError::UnknownCode { .. }, "EPSG:-1");
        refused!("+proj=longlat +R=5", CrsError::NotProjected { .. }, "degrees");
        refused!("+proj=robin +R=5", CrsError::UnknownMethod { .. }, "+proj=robin");
        refused!("+proj=aea +lat_1=3 +lat_2=-3 +R=5", CrsError::Invalid { .. }, "no cone");
        refused!("+proj=merc +R=5 +nadgrids=@null", CrsError::UnknownParameter { .. }, "+nadgrids");
        refused!("+proj=sinu +R=5 +units=us-ft", CrsError::Unit { .. }, "us-ft");
        refused!("+proj=sinu +R=5 +towgs84=1,0,0", CrsError::UnknownParameter { .. }, "+towgs84");
        refused!("+proj=sinu +R=5 +axis=wsu", CrsError::UnknownParameter { .. }, "+axis=wsu");
        refused!("+proj=sinu +R=5 +lat_1=3", CrsError::UnknownParameter { .. }, "+lat_1");
        refused!("+proj=utm +zone=61 +datum=WGS84", CrsError::UnknownParameter { .. }, "+zone=61");
        refused!("+proj=utm +datum=WGS84", CrsError::Missing { .. }, "+zone");
        refused!("+proj=sinu +R=5 +datum=WGS84", CrsError::Contradiction { .. }, "several figures");
        refused!("+proj=sinu +a=5 +b=5 +f=0", CrsError::Contradiction { .. }, "+rf");
        refused!("+proj=tmerc +R=5 +k=0.9 +k_0=0.9", CrsError::Repeated { .. }, "+k_0 and +k");
        refused!("+proj=sinu +R=nan", CrsError::NotANumber { .. }, "+R is not a number");
        refused!("+proj=sinu +R=-5", CrsError::Invalid { .. }, "radii of -5 m");
        refused!("+proj=sinu +R=5 +k=0.9", CrsError::Invalid { .. }, "scale of 0.9");
        refused!("+proj=stere +lat_0=90 +lat_ts=0 +R=5", CrsError::Invalid { .. }, "parallel at latitude 0");
        refused!("+proj=lcc +lat_2=4 +R=5", CrsError::Invalid { .. }, "missing");
        let moon = |projection: &str, more: &str| wkt_1(projection, &format!("{more}{METRE}"));
        refused!(&moon("Robinson", ""), CrsError::UnknownMethod { .. }, "Robinson");
        refused!(&moon("Albers", ""), CrsError::Invalid { .. }, "parallels");
        refused!(&moon("Sinusoidal", "PARAMETER[\"azimuth\",3],"), CrsError::UnknownParameter { .. }, "azimuth");
        refused!(&moon("Sinusoidal", "PARAMETER[\"scale_factor\",0.9],"), CrsError::Invalid { .. }, "scale of 0.9");
        refused!(&moon("Sinusoidal", "PARAMETER[\"false_easting\"],"), CrsError::NotANumber { .. }, "false_easting");
        refused!(&moon("Polar_Stereographic", ""), CrsError::Missing { .. }, "pole");
        refused!(&moon("Sinusoidal", "AXIS[\"x\",WEST],AXIS[\"y\",NORTH],"), CrsError::Contradiction { .. }, "west");
        let twice = "PARAMETER[\"central_meridian\",3],PARAMETER[\"longitude_of_center\",3],";
        refused!(&moon("Sinusoidal", twice), CrsError::Repeated { .. }, "longitude_of_center");
        refused!(&wkt_1("Sinusoidal", "UNIT[\"kilometre\",1000]"), CrsError::Unit { .. }, "kilometre");
        refused!(&wkt_1("Sinusoidal", "AXIS[\"x\",EAST]"), CrsError::Missing { .. }, "UNIT");
        let grads = moon("Sinusoidal", "PARAMETER[\"central_meridian\",3],")
            .replace("\"degree\",0.0174532925199433", "\"grad\",0.015707963");
        refused!(&grads, CrsError::Unit { .. }, "grad");
        refused!(&moon("Sinusoidal", "").replace("SPHEROID", "TRIAXIAL"), CrsError::Missing { .. }, "SPHEROID");
        refused!("GEOGCS[\"g\",DATUM[\"d\"]]", CrsError::NotProjected { .. }, "degrees");
        refused!("GEOCCS[\"g\"]", CrsError::NotProjected { .. }, "geocentric");
        refused!("LOCAL_CS[\"l\"]", CrsError::NotProjected { .. }, "local");
        refused!("VERT_CS[\"l\"]", CrsError::NotProjected { .. }, "heights");
        let depths = format!(
            "COMPD_CS[\"c\",{},VERT_CS[\"d\",VERT_DATUM[\"d\",2005],UNIT[\"metre\",1],AXIS[\"Depth\",DOWN]]]",
            moon("Sinusoidal", "")
        );
        refused!(&depths, CrsError::Contradiction { .. }, "downwards");
        refused!("GARDEN[\"l\"]", CrsError::NotRecognised { .. }, "GARDEN");
        refused!("PROJCS[\"l\"", CrsError::Syntax { .. }, "byte 10");
        let grid = "PROJCS[\"w\",EXTENSION[\"PROJ4\",\"+proj=merc +a=6378137 +b=6378137 +nadgrids=a.gsb +units=m\"]]";
        refused!(grid, CrsError::UnknownParameter { .. }, "+nadgrids");
    }
}
