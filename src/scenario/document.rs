//! The scenario as used, as a document that reads back.

use serde_json::{Map, Value, json};

use super::{Budget, DriveKeys, LegsKeys, MissionKeys, Route, Scenario, TerrainSource, UncertaintyKeys};
use crate::{
    ballistics::stance::ConeKind,
    graph::{PointSpacing, ReliabilityUse},
    ground::StandsUp,
    planner::{SearchedCommands, roadmap::RoadmapPlanner},
    quantity::{Angle, AngleInterval},
    terrain::{MapPlace, NoDataRule},
    world::{ClearanceRule, FaceGroup, Grip, RestSlope},
};

/// A robot with legs, with the keys that differ from their defaults.
fn legs(keys: &LegsKeys, named: &dyn Fn(&std::path::Path) -> String) -> Value {
    object([
        ("file", keys.file.as_deref().map(|path| named(path).into())),
        ("cone", (keys.cone != ConeKind::default()).then(|| keys.cone.name().into())),
        ("headings", keys.headings.map(Value::from)),
        ("up", (keys.up != StandsUp::default()).then(|| keys.up.name().into())),
    ])
}

/// The scenario as used, defaults filled in, with the keys of [`CATALOGUE`](super::CATALOGUE):
/// [`Entries::from_json`](super::Entries) reads it back as it was. Paths are `name`d by the caller, relative to the working folder.
pub fn scenario_document(scenario: &Scenario, named: &dyn Fn(&std::path::Path) -> String) -> Value {
    let mut tables = Map::new();
    tables.insert("body".to_owned(), body(scenario));
    tables.insert("hopper".to_owned(), hopper(scenario));
    tables.insert("robot".to_owned(), legs(&scenario.legs, named));
    tables.insert("surface".to_owned(), surface(scenario, named));
    tables.insert("layer".to_owned(), super::layers::document(&scenario.layers, named));
    tables.insert("contact".to_owned(), contact(scenario));
    tables.insert("terrain".to_owned(), terrain(scenario, named));
    tables.insert("search".to_owned(), search(scenario));
    tables.insert("budget".to_owned(), budget(&scenario.budget));
    tables.insert("drive".to_owned(), scenario.drive.as_ref().map_or_else(|| json!({}), drive));
    tables.insert("mission".to_owned(), scenario.mission.as_ref().map_or_else(|| json!({}), mission));
    let derating = scenario.derating;
    let share = |share: f64| (share != 1.0).then(|| Value::from(share));
    tables.insert(
        "derating".to_owned(),
        object([
            ("takeoff_speed", share(derating.takeoff_speed)),
            ("landing_speed", share(derating.landing_speed)),
            ("friction", share(derating.friction)),
        ]),
    );
    tables
        .insert("uncertainty".to_owned(), scenario.uncertainty.as_ref().map_or_else(|| json!({}), |keys| uncertainty(keys, named)));
    tables.insert("report".to_owned(), object([("title", scenario.title.clone().map(Value::from))]));
    tables.retain(|_, table| table.as_object().is_none_or(|keys| !keys.is_empty()));
    Value::Object(tables)
}

/// An object of the keys that have a value.
fn object<const N: usize>(keys: [(&str, Option<Value>); N]) -> Value {
    Value::Object(keys.into_iter().filter_map(|(key, value)| Some((key.to_owned(), value?))).collect())
}

fn range(angles: AngleInterval) -> Value {
    json!([angles.min.written_degrees(), angles.max.written_degrees()])
}

fn space_point(at: &nalgebra::Point3<f64>) -> Value {
    json!([at.x, at.y, at.z])
}

fn finite(number: f64) -> Option<Value> {
    number.is_finite().then(|| Value::from(number))
}

fn body(scenario: &Scenario) -> Value {
    let body = &scenario.body;
    object([
        ("name", body.name.clone().map(Value::from)),
        ("gravity_m_s2", Some(body.gravity.m_s2().into())),
        ("radius_m", body.radius_m().map(Value::from)),
    ])
}

fn hopper(scenario: &Scenario) -> Value {
    let hopper = &scenario.hopper;
    object([
        ("takeoff_speed_max_m_s", finite(hopper.limits().takeoff_speed_max_m_s)),
        ("landing_speed_max_m_s", finite(hopper.limits().landing_speed_max_m_s)),
        ("clearance_m", Some(hopper.limits().clearance_m.into())),
        ("clearance_rule", Some(hopper.limits().clearance_rule.name().into())),
        // Without a clearance only a taper of one's own is stated, which is then warned of again.
        (
            "clearance_taper",
            hopper
                .limits()
                .clearance_rule
                .taper()
                .filter(|taper| hopper.limits().clearance_m > 0.0 || *taper != ClearanceRule::DEFAULT_TAPER)
                .map(Value::from),
        ),
        ("takeoff_angle_min_deg", hopper.limits().takeoff_angle_min.map(|angle| angle.written_degrees().into())),
        ("takeoff_angle_max_deg", hopper.limits().takeoff_angle_max.map(|angle| angle.written_degrees().into())),
        ("apex_height_max_m", hopper.limits().apex_height_max_m.map(Value::from)),
        ("flight_time_max_s", hopper.limits().flight_time_max_s.map(Value::from)),
        ("takeoff_speed_min_m_s", hopper.limits().takeoff_speed_min_m_s.map(Value::from)),
        ("takeoff_speed_levels_m_s", hopper.limits().takeoff_speed_levels.map(|levels| levels.as_slice().into())),
        ("takeoff_angle_step_deg", hopper.limits().steps.takeoff_angle.map(|angle| angle.written_degrees().into())),
        ("takeoff_speed_step_m_s", hopper.limits().steps.takeoff_speed_m_s.map(Value::from)),
        ("heading_step_deg", hopper.limits().steps.heading.map(|angle| angle.written_degrees().into())),
        ("radius_m", hopper.limits().radius_m.map(Value::from)),
        ("footprint_m", hopper.limits().footprint_m.map(Value::from)),
        ("roughness_max_m", hopper.limits().roughness_max_m.map(Value::from)),
        ("mass_kg", hopper.limits().mass_kg.map(Value::from)),
        ("rest_time_s", hopper.limits().rest_time_s.map(Value::from)),
        ("landing", hopper.limits().landing.brakes().then(|| hopper.limits().landing.name().into())),
        ("touchdown_speed_m_s", hopper.limits().landing.touchdown_speed_m_s().map(Value::from)),
        ("hop_delta_v_overhead_m_s", hopper.limits().hop_delta_v_overhead_m_s.map(Value::from)),
        ("isp_s", hopper.limits().isp_s.map(Value::from)),
        ("propellant_max_kg", hopper.limits().propellant_max_kg.map(Value::from)),
        ("preparation_time_s", hopper.limits().preparation_time_s.map(Value::from)),
        ("settling_time_s", hopper.limits().settling_time_s.map(Value::from)),
        ("preparation_energy_j", hopper.limits().preparation_energy_j.map(Value::from)),
        ("efficiency", hopper.limits().efficiency.map(Value::from)),
    ])
}

fn surface(scenario: &Scenario, named: &dyn Fn(&std::path::Path) -> String) -> Value {
    let (friction, takeoff, landing) = match scenario.surface.grip {
        Some(Grip::Friction(cone)) => (Some(cone.coefficient().into()), None, None),
        Some(Grip::FromSlope { takeoff, landing }) => (None, Some(range(takeoff)), Some(range(landing))),
        None => (None, None, None),
    };
    object([
        ("friction_coefficient", friction),
        ("takeoff_from_slope_deg", takeoff),
        ("landing_from_slope_deg", landing),
        (
            "rest_slope_max_deg",
            match scenario.surface.rest {
                RestSlope::AsFrictionHolds => None,
                RestSlope::AtMost(angle) => Some(angle.written_degrees().into()),
                RestSlope::Unlimited => Some("inf".into()),
            },
        ),
        ("group", (!scenario.groups.is_empty()).then(|| scenario.groups.iter().map(face_group).collect::<Map<_, _>>().into())),
        ("friction_raster", scenario.friction_raster.as_deref().map(|path| named(path).into())),
        ("keep_out", scenario.keep_out.as_deref().map(|path| named(path).into())),
        ("keep_in", scenario.keep_in.as_deref().map(|path| named(path).into())),
    ])
}

/// What is stated of a group of faces, by its name.
fn face_group((name, group): (&String, &FaceGroup)) -> (String, Value) {
    let rest = group.rest.and_then(|rest| match rest {
        RestSlope::AtMost(angle) => Some(Value::from(angle.written_degrees())),
        RestSlope::Unlimited => Some("inf".into()),
        RestSlope::AsFrictionHolds => None,
    });
    // A group of which nothing is stated but that it is open has no other form.
    let nothing = group.friction.is_none() && rest.is_none();
    let stated = object([
        ("friction_coefficient", group.friction.map(|cone| cone.coefficient().into())),
        ("rest_slope_max_deg", rest),
        ("keep_out", (group.keep_out || nothing).then(|| group.keep_out.into())),
    ]);
    (name.clone(), stated)
}

fn contact(scenario: &Scenario) -> Value {
    let restitution = scenario.hopper.limits().restitution;
    object([
        ("restitution_normal", restitution.map(|restitution| restitution.normal().into())),
        ("restitution_tangential", restitution.map(|restitution| restitution.tangential().into())),
        ("settle_speed_m_s", restitution.and_then(|restitution| restitution.stated_settling_speed_m_s()).map(Value::from)),
    ])
}

fn terrain(scenario: &Scenario, named: &dyn Fn(&std::path::Path) -> String) -> Value {
    let source = scenario.terrain.as_ref();
    let file = |path: &std::path::Path| Value::from(named(path));
    let (mut dem, mut mesh, mut mesh_scale, mut chain) = (None, None, None, None);
    match source {
        Some(TerrainSource::Dem { path, .. }) => dem = Some(file(path)),
        Some(TerrainSource::Mesh { path, scale, .. } | TerrainSource::MeshInSpace { path, scale, .. }) => {
            (mesh, mesh_scale) = (Some(file(path)), Some((*scale).into()));
        }
        Some(TerrainSource::Chain { path }) => chain = Some(file(path)),
        None => {}
    }
    let ends = source.and_then(TerrainSource::map_ends);
    let in_space = match source {
        Some(TerrainSource::MeshInSpace { start_m, goal_m, .. }) => [Some(space_point(start_m)), Some(space_point(goal_m))],
        _ => [None, None],
    };
    let [start_in_space, goal_in_space] = in_space;
    // A mission over targets and a robot that cannot steer have no goal.
    let drifts = scenario.uncertainty.as_ref().is_some_and(|keys| keys.drift.is_some());
    let goal = ends.as_ref().map(|[_, goal]| goal).filter(|_| scenario.mission.is_none() && !drifts);
    object([
        ("dem", dem),
        ("mesh", mesh),
        ("mesh_scale", mesh_scale),
        ("chain", chain),
        ("start_m", ends.as_ref().and_then(|[start, _]| metres(start)).or(start_in_space)),
        ("goal_m", goal.and_then(metres).or(goal_in_space)),
        ("start_lonlat_deg", ends.as_ref().and_then(|[start, _]| degrees(start))),
        ("goal_lonlat_deg", goal.and_then(degrees)),
        (
            "no_data",
            match scenario.no_data {
                NoDataRule::AsStated => None,
                NoDataRule::Nothing => Some("none".into()),
                // JSON has no NaN and no infinity: they are written as text.
                NoDataRule::Value(mark) => Some(finite(mark.value()).unwrap_or_else(|| mark.value().to_string().into())),
            },
        ),
        ("accept_map_scale", scenario.accept_map_scale.then_some(true.into())),
        ("via_m", places(&scenario.via, metres)),
        ("via_lonlat_deg", places(&scenario.via, degrees)),
        ("route", (scenario.route == Route::Free).then(|| scenario.route.name().into())),
        ("start_x_m", scenario.start_x_m.map(Value::from)),
        ("goal_x_m", scenario.goal_x_m.map(Value::from)),
    ])
}

/// A place that was given on the map.
fn metres(place: &MapPlace) -> Option<Value> {
    place.metres().map(|at| json!([at.x, at.y]))
}

/// A place that was given on the body.
fn degrees(place: &MapPlace) -> Option<Value> {
    match place {
        MapPlace::Metres(_) => None,
        MapPlace::LonLat(place) => Some(json!([place.lon_deg, place.lat_deg])),
    }
}

/// A list of places of one form. All are of the first one's: the reader accepts no mixture.
fn places(places: &[MapPlace], of_form: fn(&MapPlace) -> Option<Value>) -> Option<Value> {
    let places: Vec<Value> = places.iter().filter_map(of_form).collect();
    (!places.is_empty()).then(|| places.into())
}

fn mission(keys: &MissionKeys) -> Value {
    object([
        ("targets_m", places(&keys.targets, metres)),
        ("targets_lonlat_deg", places(&keys.targets, degrees)),
        ("order", Some(keys.order.name().into())),
        ("return_to_start", keys.return_to_start.then_some(true.into())),
    ])
}

fn search(scenario: &Scenario) -> Value {
    let search = &scenario.search;
    let (points, spacing) = match search.spacing {
        None => (Some("auto".into()), None),
        Some(PointSpacing::PerSegment(points)) => (Some(points.into()), None),
        Some(PointSpacing::AtMostM(spacing_m)) => (None, Some(spacing_m.into())),
    };
    object([
        ("points_per_segment", points),
        ("node_spacing_max_m", spacing),
        (
            "planner",
            (scenario.mesh_search.planner != RoadmapPlanner::default()).then(|| scenario.mesh_search.planner.name().into()),
        ),
        ("contacts_max", scenario.mesh_search.contacts_max.map(Value::from)),
        ("stand_off_m", scenario.mesh_search.stand_off_m.map(Value::from)),
        (
            "bounds_m",
            scenario.mesh_search.bounds.map(|bounds| Value::from(vec![space_point(&bounds.min), space_point(&bounds.max)])),
        ),
        ("seed", scenario.mesh_search.seed.map(Value::from)),
        ("time_max_s", scenario.mesh_search.time_max_s.map(Value::from)),
        ("effort", scenario.objective.is_none().then(|| search.effort.name().into())),
        // Without one, the search is over several commands.
        ("takeoff_angle", (scenario.commands == SearchedCommands::Chosen).then(|| search.takeoff.name().into())),
        ("split", Some(search.split.name().into())),
        ("risk", scenario.drives().is_none().then(|| scenario.risk.name().into())),
        (
            "risk_extra_hops_max",
            (scenario.risk == ReliabilityUse::Traded).then_some(scenario.risk_extra_hops_max).flatten().map(Value::from),
        ),
        (
            "objective",
            scenario.objective.as_ref().map(|objective| objective.amounts().iter().map(|amount| amount.name()).collect()),
        ),
    ])
}

fn budget(budget: &Budget) -> Value {
    object([
        ("hops_max", budget.hops_max.map(Value::from)),
        ("mission_time_max_s", budget.mission_time_max_s.map(Value::from)),
        ("flight_time_total_max_s", budget.flight_time_total_max_s.map(Value::from)),
        ("energy_max_j_kg", budget.energy_max_j_kg.map(Value::from)),
        ("energy_max_j", budget.energy_max_j.map(Value::from)),
        ("delta_v_max_m_s", budget.delta_v_max_m_s.map(Value::from)),
        ("estimated_success_min", budget.estimated_success_min.map(Value::from)),
    ])
}

fn drive(DriveKeys { rover, travel }: &DriveKeys) -> Value {
    let limits = rover.limits();
    let slope = |slope: Angle| if slope.degrees() >= 90.0 { Value::from("inf") } else { slope.written_degrees().into() };
    let above_0 = |number: f64| (number != 0.0).then(|| Value::from(number));
    let slip = limits.slip.points_deg();
    object([
        ("travel", Some(travel.name().into())),
        ("speed_m_s", Some(limits.speed_m_s.into())),
        ("slope_up_max_deg", Some(slope(limits.slope_up_max))),
        ("slope_down_max_deg", limits.slope_down_max.map(slope)),
        ("cross_slope_max_deg", limits.cross_slope_max.map(slope)),
        ("step_max_m", limits.step_max_m.map(Value::from)),
        ("roughness_max_m", limits.roughness_max_m.map(Value::from)),
        ("wheelbase_m", limits.wheelbase_m.map(Value::from)),
        ("neighbours", Some(limits.neighbours.count().into())),
        ("turn_s_per_deg", above_0(limits.turn_s_per_deg)),
        ("slip", (!slip.is_empty()).then(|| json!(slip))),
        ("rolling_resistance", above_0(limits.rolling_resistance)),
        ("drive_efficiency", (limits.efficiency != 1.0).then(|| limits.efficiency.into())),
        ("idle_power_w", above_0(limits.idle_power_w)),
        ("failure_per_m", above_0(limits.failure_per_m)),
        ("heading_sigma_deg", above_0(limits.heading_sigma.written_degrees())),
        ("length_sigma_fraction", above_0(limits.length_sigma_fraction)),
    ])
}

fn uncertainty(trials: &UncertaintyKeys, named: &dyn Fn(&std::path::Path) -> String) -> Value {
    let (errors, drift) = (&trials.errors, trials.drift.as_ref());
    let hop_limit = drift.map(|command| command.hops).or(trials.hop_limit);
    // Without a goal there is no policy and no tolerance.
    let of_goal = |value: Value| drift.is_none().then_some(value);
    object([
        ("takeoff_speed_sigma_m_s", Some(errors.takeoff_speed_sigma_m_s.into())),
        ("takeoff_speed_sigma_fraction", Some(errors.takeoff_speed_sigma_fraction.into())),
        ("takeoff_angle_sigma_deg", Some(errors.takeoff_angle_sigma.written_degrees().into())),
        ("heading_sigma_deg", of_goal(errors.heading_sigma.written_degrees().into())),
        ("position_sigma_m", of_goal(errors.position_sigma_m.into())),
        ("drift_along_sigma_m", Some(errors.drift_along_sigma_m.into())),
        ("drift_across_sigma_m", Some(errors.drift_across_sigma_m.into())),
        ("friction_sigma", Some(errors.friction_sigma.into())),
        ("height_sigma_m", Some(errors.height_sigma_m.into())),
        ("height_correlation_m", Some(errors.height_correlation_m.into())),
        ("takeoff_speed_bias_sigma_fraction", Some(errors.takeoff_speed_bias_sigma_fraction.into())),
        ("takeoff_angle_bias_sigma_deg", Some(errors.takeoff_angle_bias_sigma.written_degrees().into())),
        ("heading_bias_sigma_deg", of_goal(errors.heading_bias_sigma.written_degrees().into())),
        ("distribution", Some(errors.distribution.name().into())),
        ("errors", trials.errors_file.as_deref().map(|path| named(path).into())),
        ("goal_tolerance_m", of_goal(trials.goal_tolerance_m.into())),
        ("hop_limit", hop_limit.map(Value::from)),
        ("policy", of_goal(trials.policy.name().into())),
        ("heading", drift.map(|_| "uncontrolled".into())),
        ("takeoff_speed_m_s", drift.map(|command| command.takeoff_speed_m_s.into())),
        ("takeoff_angle_deg", drift.map(|command| command.takeoff_angle.written_degrees().into())),
        ("trials", Some(trials.trials.into())),
        ("seed", Some(trials.seed.into())),
    ])
}
