//! The path of a robot with legs that a result holds, flown again as it stands.

use std::path::Path;

use nalgebra::{Point3, Vector3};
use serde_json::Value;

use super::{
    LegsRouteError, LegsRouteQuestion, MeshChecked, MeshReadBackError, ReadBackError,
    legs_ends::{LegsEnds, legs_ends, planned_map},
    mesh_read_back::{hop_of, rows_of},
    read_back::key,
    stance::{pairs_of, with_robot},
};
use crate::{
    ground::{NoStance, Pose, Stance, StanceGround, StanceMap},
    path::{HopPath, flown_by_stances},
    report::{DocumentKind, InputFile, MeshCheckAnswer, MeshContactRecord, StanceRecord, ViolationRecord, heading_of},
    scenario::{Scenario, read_robot},
};

/// The kinds of answers that hold a path of a robot with legs.
const WITH_PATH: [DocumentKind; 2] = [DocumentKind::PlanLegs, DocumentKind::SimulateLegs];

/// How far a start or goal of a path may lie from the place that the scenario names, in lengths of the longest leg beside the trunk: the root of a
/// standing robot is no farther.
const BESIDE: f64 = 2.0;

/// Flies the path of a result from stance to stance again: its stances are put on the ground anew in their poses, and each hop is flown by direct
/// simulation. Nothing is searched.
///
/// # Errors
/// [`MeshReadBackError`]. That the path breaks a limit is an answer.
pub(super) fn check_over_stances(
    (scenario, base): (&Scenario, &Path),
    document: &Value,
    inputs: &[InputFile],
) -> Result<MeshChecked, MeshReadBackError> {
    LegsRouteQuestion { scenario, base }.of_hops_alone("checks of results")?;
    let rows = rows_of(document, inputs, &WITH_PATH)?;
    let records: Vec<StanceRecord> = key(document, "stances")?;
    if records.len() != rows.len() + 1 {
        return Err(ReadBackError::Hops { stated: records.len().saturating_sub(1) as u64, listed: rows.len() }.into());
    }
    let read =
        read_robot(&base.join(scenario.legs.file.as_deref().unwrap_or_else(|| Path::new("")))).map_err(LegsRouteError::from)?;
    let with_limits = Scenario { hopper: with_robot(&scenario.hopper, &read.robot), ..scenario.clone() };
    let LegsEnds { ground, map, scale, given_m, surface, mut warnings, .. } = legs_ends(&with_limits, base, &read.robot)?;
    warnings.extend(read.warnings);
    let ground = StanceGround::new(ground, read.robot, scenario.legs.cone, scenario.legs.up).map_err(LegsRouteError::from)?;
    let ground = match &map {
        Some(map) => ground.with_map(StanceMap::new(planned_map(map, scenario))),
        None => ground,
    };
    let hops = rows.iter().map(hop_of).collect::<Result<_, _>>()?;
    let path = HopPath::of_hops(hops, ground.mesh().envelope().hopper());
    let stood: Vec<Result<Stance, NoStance>> = records.iter().map(|record| ground.stand(pose_of(record))).collect();
    let mut violations: Vec<ViolationRecord> = Vec::new();
    for (number, refusal) in stood.iter().enumerate().filter_map(|(number, stance)| Some((number, stance.as_ref().err()?))) {
        violations.push(broken(number, "stance", format!("stance {number}: {refusal}")));
    }
    let beside_m = BESIDE * ground.robot().leg_length_m() + ground.robot().trunk_radius_m();
    for (number, end, contact) in [(0, "start", &surface[0]), (records.len() - 1, "goal", &surface[1])] {
        let away_m = (Point3::from(records[number].pose.root_m) - contact.point_m()).norm();
        if away_m > beside_m {
            let sentence =
                format!("stance {number} is {away_m:.3} m away from the {end} of the scenario, farther than the robot reaches");
            violations.push(broken(number, "stance", sentence));
        }
    }
    if violations.is_empty() {
        let stances: Vec<&Stance> = stood.iter().flatten().collect();
        violations.extend(
            flown_by_stances(&ground, &pairs_of(&stances), &path)
                .iter()
                .map(|fault| broken(fault.hop, fault.limit(), fault.to_string())),
        );
        for (number, (hop, pair)) in path.hops.iter().zip(stances.windows(2)).enumerate() {
            let refused = pushes(hop, [pair[0], pair[1]]).into_iter().find_map(|(stance, push)| ground.refuses_push(stance, push));
            let sentence = |limit| format!("hop {}: its push breaks the limit {limit}", number + 1);
            violations.extend(refused.map(|limit| broken(number + 1, &limit.to_string(), sentence(limit))));
        }
    }
    warnings.extend(scenario.path_warnings(&path));
    let [start, goal] = [0, 1].map(|i| MeshContactRecord::new(ground.mesh(), &surface[i], given_m[i].coords.into()));
    let answer = MeshCheckAnswer { mesh_scale: scale, start, goal, hops: rows.len(), holds: violations.is_empty(), violations };
    Ok(MeshChecked { path, answer, warnings })
}

/// The pose that a result states.
fn pose_of(record: &StanceRecord) -> Pose {
    let up = Vector3::from(record.pose.up).try_normalize(0.0).unwrap_or_else(Vector3::z);
    Pose::facing(Point3::from(record.pose.root_m), up, heading_of(record.pose.heading_deg))
}

/// The push of a take-off and the one that stops the landing, each with its stance.
fn pushes<'a>(hop: &crate::path::Hop, [from, to]: [&'a Stance; 2]) -> [(&'a Stance, Vector3<f64>); 2] {
    let along = (to.pose().root_m - from.pose().root_m).xy().try_normalize(0.0).unwrap_or_else(nalgebra::Vector2::x);
    let velocity = |angle: crate::quantity::Angle, speed_m_s: f64| {
        let (sine, cosine) = libm::sincos(angle.radians());
        Vector3::new(along.x * cosine, along.y * cosine, sine) * speed_m_s
    };
    [(from, velocity(hop.takeoff_angle, hop.takeoff_speed_m_s)), (to, -velocity(hop.landing_angle, hop.landing_speed_m_s))]
}

/// A violation without numbers.
fn broken(hop: usize, limit: &str, sentence: String) -> ViolationRecord {
    ViolationRecord { hop, limit: limit.to_owned(), found: None, allowed: None, unit: None, facet: None, sentence }
}
