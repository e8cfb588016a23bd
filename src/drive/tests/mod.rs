//! Fast against plain, and plain against sampling and brute force.

mod legs;
mod maps;
mod truths;

use crate::{
    draw::Draw,
    ground::DemGround,
    quantity::{Angle, MapPoint},
    terrain::{
        Dem, GeoReference, LayerCondition, LayerRule, MapLayers, OverlaidDem, Overlays, read_keep_out, read_layer, write_geotiff,
    },
    world::{Gravity, Hopper, LayerName, Neighbours, RestSlope, Rover, RoverLimits, SlipCurve, SurfaceProperties},
};

/// The ground of a DEM with zones; the hopper and its surface have no effect on driving.
fn ground(dem: Dem, overlays: Overlays, gravity_m_s2: f64) -> DemGround {
    let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    let gravity = Gravity::new(gravity_m_s2).unwrap();
    DemGround::new(OverlaidDem::new(dem, overlays), &Hopper::with_speeds(1.0, 1.0).unwrap(), gravity, &surface)
}

fn flat(side: usize, (dx_m, dy_m): (f64, f64)) -> DemGround {
    let map = GeoReference::local(MapPoint::new(3.0, 50.0), dx_m, dy_m).unwrap();
    ground(Dem::new(side, side, vec![0.0; side * side], map).unwrap(), Overlays::default(), 1.62)
}

/// A polygon of keep-out zones over a part of the map.
fn zones(draw: &mut Draw, dem: &Dem) -> Overlays {
    let bounds = dem.bounds();
    let at = |draw: &mut Draw| {
        let (x, y) = (draw.uniform(bounds.min.x, bounds.max.x), draw.uniform(bounds.min.y, bounds.max.y));
        (x, y)
    };
    let ((ax, ay), (bx, by)) = (at(draw), at(draw));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("zones.geojson");
    let ring = format!("[[[{ax}, {ay}], [{bx}, {ay}], [{bx}, {by}], [{ax}, {by}], [{ax}, {ay}]]]");
    std::fs::write(&file, format!(r#"{{"type": "Polygon", "coordinates": {ring}}}"#)).unwrap();
    Overlays::new(None, Some(read_keep_out(&file, None, bounds).unwrap()))
}

/// A layer of few cells that do not hold, some of them without data.
fn layers(draw: &mut Draw, dem: &Dem) -> MapLayers {
    let (bounds, steps) = (dem.bounds(), [dem.georeference().dx_m(), dem.georeference().dy_m()]);
    let scale = draw.uniform(0.5, 2.0);
    let corner = MapPoint::new(bounds.min.x - scale * steps[0] * draw.unit(), bounds.max.y + scale * steps[1] * draw.unit());
    let map = GeoReference::local(corner, scale * steps[0], scale * steps[1]).unwrap();
    let values = (0..30 * 30).map(|_| if draw.chance(0.02) { f64::NAN } else { draw.unit() }).collect();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("layer.tif");
    write_geotiff(&Dem::new(30, 30, values, map).unwrap(), std::fs::File::create(&file).unwrap()).unwrap();
    let condition = LayerCondition { min: Some(0.04), ..LayerCondition::default() };
    let rule =
        LayerRule { name: LayerName::new("sun").unwrap(), condition, on_contact: true, on_flight: false, outage: None, cost: None };
    MapLayers::new(vec![read_layer(&file, rule, None).unwrap()])
}

/// Ground with walls, gaps and terraces whose slopes are those of the limits, and perhaps a zone.
fn ugly_ground(draw: &mut Draw, rows: usize, cols: usize) -> DemGround {
    let (dx_m, dy_m) = (draw.log_uniform(0.3, 3.0), draw.log_uniform(0.3, 3.0));
    let (walls, gaps) = (if draw.chance(0.5) { 0.1 } else { 0.0 }, if draw.chance(0.5) { 0.06 } else { 0.0 });
    let (terraced, rough_m) = (draw.chance(0.3), draw.log_uniform(0.05, 0.6));
    let heights = (0..rows * cols)
        .map(|_| match (draw.chance(gaps), draw.chance(walls), terraced) {
            (true, ..) => f64::NAN,
            (_, true, _) => draw.uniform(5.0, 50.0),
            // A slope of a quarter between the steps of a column, and of a row where posts are as far apart.
            (.., true) => 0.25 * dx_m * f64::from(u32::try_from(draw.below(3)).unwrap()),
            _ => draw.uniform(0.0, rough_m * dx_m.min(dy_m)),
        })
        .collect();
    let dy_m = if terraced { dx_m } else { dy_m };
    let map = GeoReference::local(MapPoint::new(draw.uniform(-9.0, 9.0), 70.0), dx_m, dy_m).unwrap();
    let dem = Dem::new(rows, cols, heights, map).unwrap();
    let overlays = if draw.chance(0.4) { zones(draw, &dem) } else { Overlays::default() };
    let overlays = if draw.chance(0.3) { overlays.with_layers(layers(draw, &dem)) } else { overlays };
    ground(dem, overlays, draw.log_uniform(1e-5, 25.0))
}

/// Limits of every kind, or none, and slopes that terraces touch.
fn any_limits(draw: &mut Draw, neighbours: Neighbours, step_m: f64) -> RoverLimits {
    let slope = |draw: &mut Draw| match draw.below(4) {
        0 => Angle::from_degrees(90.0),
        1 => Angle::from_slope(0.25),
        _ => Angle::from_degrees(draw.uniform(2.0, 60.0)),
    };
    let wheels = draw.chance(0.5);
    let height = |draw: &mut Draw, most_m: f64| (wheels && draw.chance(0.6)).then(|| draw.uniform(0.0, most_m));
    RoverLimits {
        slope_down_max: draw.chance(0.5).then(|| slope(draw)),
        cross_slope_max: draw.chance(0.7).then(|| slope(draw)),
        step_max_m: height(draw, 0.6 * step_m),
        roughness_max_m: height(draw, 0.3 * step_m),
        wheelbase_m: wheels.then(|| step_m * draw.log_uniform(0.1, 2.5)),
        turn_s_per_deg: if draw.chance(0.5) { draw.log_uniform(1e-3, 1.0) } else { 0.0 },
        rolling_resistance: if draw.chance(0.5) { draw.uniform(0.0, 0.3) } else { 0.0 },
        efficiency: draw.uniform(0.2, 1.0),
        idle_power_w: if draw.chance(0.5) { draw.uniform(0.0, 5.0) } else { 0.0 },
        slip: match draw.below(3) {
            0 => SlipCurve::default(),
            1 => SlipCurve::new(&[[0.0, 0.05], [10.0, 0.1], [20.0, 0.6]]).unwrap(),
            _ => SlipCurve::new(&[[-30.0, 0.0], [0.0, 0.1], [25.0, 0.8]]).unwrap(),
        },
        neighbours,
        ..RoverLimits::new(draw.log_uniform(0.01, 2.0), slope(draw))
    }
}

fn any_rover(draw: &mut Draw, neighbours: Neighbours, ground: &DemGround) -> Rover {
    let step_m = ground.terrain().dem().georeference().step_m();
    Rover::new(any_limits(draw, neighbours, step_m), Some(2.0)).unwrap()
}
