//! What the body of a scenario says of its other inputs: the escape speed of speed limits, the radius of the size of the terrain, a
//! known body of gravity and radius.

use crate::{
    chain::{GroundForm, PolygonalChain},
    path::Hop,
    quantity::format_number,
    scenario::{BodyChoice, Scenario},
    terrain::{MapBounds, MeshBounds},
    world::Body,
};

/// Deviation of a gravity or radius from that of the named body from which on it is reported, as a share.
const NEAR: f64 = 0.05;

/// Mean densities of bodies, kg/m^3: comets have some 500, iron has 7 900. Others are likely a mistake of units.
const DENSITIES_KG_M3: std::ops::RangeInclusive<f64> = 100.0..=30_000.0;

/// Gravitational constant, m^3/(kg s^2) (CODATA 2018).
const GRAVITATIONAL_CONSTANT: f64 = 6.674_30e-11;

/// Warnings where gravity or radius contradict the named body or, without a name, each other; each has both values.
pub(super) fn body_warnings(body: &BodyChoice) -> Vec<String> {
    let mut warnings = Vec::new();
    let gravity_m_s2 = body.gravity.m_s2();
    let Some(known) = body.name.as_deref().and_then(Body::named) else {
        if let Some(radius_m) = body.radius_m() {
            let density = 3.0 * gravity_m_s2 / (4.0 * std::f64::consts::PI * GRAVITATIONAL_CONSTANT * radius_m);
            if !DENSITIES_KG_M3.contains(&density) {
                warnings.push(format!(
                    "body.gravity_m_s2 of {} m/s^2 and body.radius_m of {} m mean a mean density of {density:.3e} kg/m^3, expected 100 to \
                     30000 kg/m^3: give the radius in metres and the gravity in m/s^2",
                    format_number(gravity_m_s2),
                    format_number(radius_m)
                ));
            }
        }
        return warnings;
    };
    let given = [
        ("gravity_m_s2", "m/s^2", gravity_m_s2, known.gravity.m_s2()),
        ("radius_m", "m", body.radius_m().unwrap_or(known.radius_m), known.radius_m),
    ];
    for (key, unit, found, of_known) in given {
        let off = found / of_known - 1.0;
        if off.abs() > NEAR {
            warnings.push(format!(
                "body.{key} is {} {unit}, {:.0} % {} the {} {unit} of {}: the given value counts; remove body.{key} if {} is meant",
                format_number(found),
                100.0 * off.abs(),
                if off > 0.0 { "above" } else { "below" },
                format_number(of_known),
                known.name,
                known.name,
            ));
        }
    }
    warnings
}

/// Warnings of speed limits at or above the escape speed, each with both speeds and the limit that counts instead: those of the
/// hopper, and those that a chain states for its segments. A body of unknown radius gives none.
pub(super) fn escape_warnings(scenario: &Scenario, chain: Option<&PolygonalChain>) -> Vec<String> {
    let gravity = scenario.body.gravity;
    let Some(escape_m_s) = gravity.escape_speed_m_s() else { return Vec::new() };
    let cap_m_s = gravity.speed_cap_m_s();
    let stated = |what: &str, limit_m_s: f64| {
        (limit_m_s > cap_m_s).then(|| {
            format!(
                "{what} is {} m/s, at or above the escape speed of {}, {escape_m_s:.6} m/s: a hop that fast never lands, so the limit that \
                 counts is just below the escape speed",
                format_number(limit_m_s),
                scenario.body.spoken()
            )
        })
    };
    let limits = scenario.hopper.limits();
    let contacts =
        [("takeoff_speed_max_m_s", limits.takeoff_speed_max_m_s, 0), ("landing_speed_max_m_s", limits.landing_speed_max_m_s, 1)];
    // With brakes the landing speed limit is one of the touchdown, not of an arc.
    let of_arcs = if limits.landing.brakes() { 1 } else { 2 };
    let mut warnings = Vec::new();
    for (key, of_hopper_m_s, contact) in contacts.into_iter().take(of_arcs) {
        if of_hopper_m_s.is_finite() {
            warnings.extend(stated(&format!("hopper.{key}"), of_hopper_m_s));
        }
        let of_chain_m_s = chain.map_or(0.0, |chain| stated_speeds_m_s(chain)[contact]);
        // Of two limits the smaller counts, so one of the hopper below escape leaves nothing to cap.
        if of_hopper_m_s > cap_m_s {
            warnings.extend(stated(&format!("the greatest {key} of the chain's segments"), of_chain_m_s));
        }
    }
    let highest = limits.takeoff_speed_levels.map(|levels| levels.highest_m_s());
    for (key, speed_m_s) in [("takeoff_speed_min_m_s", limits.takeoff_speed_min_m_s), ("takeoff_speed_levels_m_s", highest)] {
        warnings.extend(speed_m_s.filter(|speed_m_s| *speed_m_s > cap_m_s).map(|speed_m_s| {
            format!(
                "hopper.{key} has {} m/s, at or above the escape speed of {}, {escape_m_s:.6} m/s: no hop has that speed, since one so fast \
                 never lands",
                format_number(speed_m_s),
                scenario.body.spoken()
            )
        }));
    }
    warnings
}

/// The greatest take-off and landing speed that a chain states for its segments; 0 if it states none.
fn stated_speeds_m_s(chain: &PolygonalChain) -> [f64; 2] {
    let lines = chain.grounds().iter().flat_map(|ground| match ground.form {
        GroundForm::Explicit { forward, reverse } => [forward, reverse],
        GroundForm::Surface { .. } => [None, None],
    });
    lines.flatten().fold([0.0, 0.0], |[takeoff, landing], line| {
        [takeoff.max(line.takeoff.speed_max_m_s()), landing.max(line.landing.speed_max_m_s())]
    })
}

/// What kind of terrain an extent is of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ExtentOf {
    /// A mesh, whose heights span this much, m.
    Mesh { relief_m: f64 },
    /// A raster on no known map.
    Dem,
    /// A raster in a known projection.
    Map,
}

/// The horizontal extent of a terrain, to be compared with the size of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The rectangle that it covers.
    pub bounds: MapBounds,
    of: ExtentOf,
}

impl Extent {
    /// Of a raster, on a map of a known projection or not.
    pub const fn of_dem(bounds: MapBounds, projected: bool) -> Self {
        Self { bounds, of: if projected { ExtentOf::Map } else { ExtentOf::Dem } }
    }

    /// Of a mesh, in metres.
    pub fn of_mesh(bounds: &MeshBounds) -> Self {
        Self { bounds: bounds.map, of: ExtentOf::Mesh { relief_m: bounds.high_m - bounds.low_m } }
    }
}

/// A terrain larger than its body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the {what} is {} m wide, expected at most {} m, the {measure} of {body} (mean radius {radius_m} m): {mend}",
    format_number(*.extent_m),
    format_number(.most_m.round())
)]
pub struct TooLarge {
    /// A mesh or a DEM.
    pub what: &'static str,
    /// Its greatest horizontal extent, m.
    pub extent_m: f64,
    /// The greatest that the body has room for, m.
    pub most_m: f64,
    /// What that is.
    pub measure: &'static str,
    /// The body.
    pub body: String,
    /// Its mean radius, m.
    pub radius_m: f64,
    /// How to mend it.
    pub mend: &'static str,
}

/// The longest extent of a body whose shape is unknown, in mean diameters. Of bodies seen from near, Eros is the longest with 2.04,
/// so that up to this factor a terrain may be a whole, long body.
const LONGEST: f64 = 2.5;

/// Longest extents of the known bodies that are no balls, in mean diameters, rounded up: of the ellipsoids of IAU WGCCRE 2015, of
/// Bennu and Ryugu their equatorial diameters, of 67P both lobes. All others are within 10 %.
const LONG_BODIES: [(&str, f64); 7] =
    [("phobos", 1.3), ("deimos", 1.4), ("vesta", 1.15), ("bennu", 1.2), ("ryugu", 1.2), ("eros", 2.2), ("67p", 1.6)];

/// Compares the extent of a terrain with the size of the body.
///
/// # Returns
/// A warning where the two likely contradict: a terrain over the body's mean diameter, and a mesh of the shape of a whole body but of
/// a thousandth of its size, as one in kilometres.
///
/// # Errors
/// [`TooLarge`] where they certainly do: a terrain wider than the body, or a map of a known projection wider than its circumference.
pub(super) fn check_extent(body: &BodyChoice, extent: &Extent) -> Result<Option<String>, TooLarge> {
    let Some(radius_m) = body.radius_m() else { return Ok(None) };
    let MapBounds { min, max } = extent.bounds;
    let sides_m = [max.x - min.x, max.y - min.y];
    let widest_m = sides_m[0].max(sides_m[1]);
    let diameter_m = 2.0 * radius_m;
    let longest = match &body.name {
        Some(name) => LONG_BODIES.iter().find(|(long, _)| long == name).map_or(1.1, |(_, longest)| *longest),
        None => LONGEST,
    };
    let (what, measure, most_m, mend) = match extent.of {
        ExtentOf::Mesh { .. } => (
            "mesh",
            "longest extent",
            longest * diameter_m,
            "set mesh_scale to the metres of one unit of the file, such as 0.001 for millimetres, or correct the body",
        ),
        ExtentOf::Dem => (
            "DEM",
            "longest extent",
            longest * diameter_m,
            "correct the body, or the raster's post spacing, which is taken as metres",
        ),
        ExtentOf::Map => (
            "DEM",
            "circumference",
            longest * std::f64::consts::PI * diameter_m,
            "correct the body, or the raster's post spacing, which is taken as metres",
        ),
    };
    if widest_m > most_m {
        return Err(TooLarge { what, extent_m: widest_m, most_m, measure, body: body.spoken(), radius_m, mend });
    }
    if widest_m > diameter_m && extent.of != ExtentOf::Map {
        return Ok(Some(format!(
            "the {what} is {} m wide, over the mean diameter of {}, {} m: check the body and the unit of the {what}",
            format_number(widest_m),
            body.spoken(),
            format_number(diameter_m)
        )));
    }
    if let ExtentOf::Mesh { relief_m } = extent.of {
        let shortest_m = sides_m[0].min(sides_m[1]).min(relief_m);
        let in_km = (0.3..3.0).contains(&(1000.0 * widest_m / diameter_m));
        if in_km && shortest_m > 0.3 * widest_m {
            return Ok(Some(format!(
                "the mesh is {} m wide and {} m high, as a whole body a thousandth of the size of {} (mean diameter {} m): if its unit is \
                 the kilometre, set mesh_scale = 1000",
                format_number(widest_m),
                format_number(relief_m),
                body.spoken(),
                format_number(diameter_m)
            )));
        }
    }
    Ok(None)
}

/// The extremes of some hops, for the check whether constant gravity is a good model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extremes {
    /// Greatest horizontal distance, m.
    pub range_m: f64,
    /// Greatest height above a take-off, m.
    pub height_m: f64,
    /// Greatest speed, m/s.
    pub speed_m_s: f64,
}

impl Extremes {
    /// The extremes of planned hops.
    pub fn of(hops: &[Hop]) -> Self {
        let largest = |of: fn(&Hop) -> f64| hops.iter().map(of).fold(0.0, f64::max);
        Self {
            range_m: largest(Hop::run_m),
            height_m: largest(|h| h.apex_z_m - h.takeoff.point_m.z),
            speed_m_s: largest(|h| h.takeoff_speed_m_s.max(h.landing_speed_m_s)),
        }
    }
}

/// Warnings if constant gravity over flat ground is a bad model, each with its numbers; empty if it is a good one.
///
/// A hop gives a warning where its range or its highest point above the take-off is over a hundredth of the body's radius, or a
/// speed over a tenth of its escape speed `sqrt(2 g R)`. A body of unknown radius gives no warning.
pub fn constant_gravity_warnings(body: &BodyChoice, extremes: Extremes) -> Vec<String> {
    let Some((radius_m, escape_m_s)) = body.radius_m().zip(body.gravity.escape_speed_m_s()) else { return Vec::new() };
    let name = body.spoken();
    let Extremes { range_m, height_m, speed_m_s } = extremes;
    let lengths = [("range", range_m), ("highest point above its take-off", height_m)];
    let mut warnings: Vec<String> = lengths
        .into_iter()
        .filter(|(_, length_m)| *length_m > 0.01 * radius_m)
        .map(|(what, length_m)| {
            format!("a hop's {what}, {length_m:.3} m, is over 1 % of the radius of {name} ({radius_m} m): constant gravity is a bad model there")
        })
        .collect();
    if speed_m_s > 0.1 * escape_m_s {
        warnings.push(format!(
            "a hop's speed, {speed_m_s:.4} m/s, is over a tenth of the escape speed of {name} ({escape_m_s:.4} m/s): constant gravity is \
             a bad model there"
        ));
    }
    warnings
}
