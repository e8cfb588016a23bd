//! A projection as well-known text in ESRI's dialect of 1999, which all GIS programs read from a `.prj` file.

use super::definition::{Definition, Method};

/// One line of well-known text.
pub(super) fn esri_wkt(definition: &Definition, name: &str) -> String {
    let name = quoted(name);
    let ellipsoid = definition.ellipsoid;
    let figure = format!("SPHEROID[\"{name}\",{},{}]", decimal(ellipsoid.semi_major_m), decimal(ellipsoid.inverse_flattening()));
    let datum = format!("DATUM[\"D_{name}\",{figure}]");
    let degrees = "UNIT[\"Degree\",0.0174532925199433]";
    let geographic = format!("GEOGCS[\"GCS_{name}\",{datum},PRIMEM[\"Reference_Meridian\",0.0],{degrees}]");
    let (projection, parameters) = projection(definition);
    let parameters: Vec<String> =
        parameters.into_iter().map(|(parameter, value)| format!("PARAMETER[\"{parameter}\",{}]", decimal(value))).collect();
    format!("PROJCS[\"{name}\",{geographic},PROJECTION[\"{projection}\"],{},UNIT[\"Meter\",1.0]]", parameters.join(","))
}

/// ESRI's name of the method, and its parameters.
fn projection(definition: &Definition) -> (&'static str, Vec<(&'static str, f64)>) {
    let Definition { method, latitude_deg, longitude_deg, parallels_deg, scale, .. } = *definition;
    let latitude = ("Latitude_Of_Origin", latitude_deg);
    let scale = ("Scale_Factor", scale);
    let parallel = ("Standard_Parallel_1", parallels_deg[0].unwrap_or(0.0));
    let (name, mut own) = match (method, parallels_deg[0]) {
        (Method::Equirectangular, _) => ("Equidistant_Cylindrical", vec![parallel]),
        (Method::PolarStereographic, Some(_)) if latitude_deg > 0.0 => ("Stereographic_North_Pole", vec![parallel]),
        (Method::PolarStereographic, Some(_)) => ("Stereographic_South_Pole", vec![parallel]),
        (Method::PolarStereographic | Method::ObliqueStereographic, _) => ("Stereographic", vec![scale, latitude]),
        (Method::DoubleStereographic, _) => ("Double_Stereographic", vec![scale, latitude]),
        (Method::Sinusoidal, _) => ("Sinusoidal", Vec::new()),
        (Method::TransverseMercator, _) => ("Transverse_Mercator", vec![scale, latitude]),
        (Method::Orthographic, _) => ("Orthographic", vec![latitude]),
        (Method::Mercator, Some(_)) => ("Mercator", vec![parallel]),
        (Method::Mercator, None) => ("Mercator_1SP", vec![scale]),
        (Method::LambertConformalOneParallel, _) => {
            ("Lambert_Conformal_Conic", vec![("Standard_Parallel_1", latitude_deg), scale, latitude])
        }
        (Method::LambertConformalTwoParallels, _) => {
            ("Lambert_Conformal_Conic", vec![parallel, ("Standard_Parallel_2", parallels_deg[1].unwrap_or(0.0)), latitude])
        }
        (Method::LambertAzimuthalEqualArea, _) => ("Lambert_Azimuthal_Equal_Area", vec![latitude]),
        (Method::AzimuthalEquidistant, _) => ("Azimuthal_Equidistant", vec![latitude]),
        (Method::AlbersEqualArea, _) => {
            ("Albers", vec![parallel, ("Standard_Parallel_2", parallels_deg[1].unwrap_or(0.0)), latitude])
        }
        (Method::PseudoMercator, _) => ("Mercator_Auxiliary_Sphere", vec![parallel, ("Auxiliary_Sphere_Type", 0.0)]),
    };
    // The origin of ESRI's equirectangular map is at the equator.
    let from_equator_m = match method {
        Method::Equirectangular => definition.ellipsoid.semi_major_m * latitude_deg.to_radians(),
        _ => 0.0,
    };
    let mut parameters = vec![
        ("False_Easting", definition.false_easting_m),
        ("False_Northing", definition.false_northing_m - from_equator_m),
        ("Central_Meridian", longitude_deg),
    ];
    parameters.append(&mut own);
    (name, parameters)
}

/// A number with a decimal point.
fn decimal(value: f64) -> String {
    format!("{value:?}")
}

/// A name without characters that would end it.
fn quoted(name: &str) -> String {
    name.replace(|letter: char| letter == '"' || letter.is_control(), "_")
}
