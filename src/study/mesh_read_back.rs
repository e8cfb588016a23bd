//! The path over a mesh that a result holds, flown again as it stands.

use std::path::Path;

use serde_json::Value;

use super::{
    LegsRouteError, MeshRouteError, ReadBackError,
    legs_read_back::check_over_stances,
    mesh_ends::{MeshEnds, mesh_ends},
    read_back::{commanded, key, same_inputs},
};
use crate::{
    ground::{ContactPoint, MeshPosition},
    path::{Hop, HopPath, execute_over_mesh},
    quantity::MapPoint,
    report::{DocumentKind, HopRecord, InputFile, MeshCheckAnswer, MeshContactRecord, ViolationRecord},
    scenario::Scenario,
};

/// The kinds of answers that hold a path over a mesh.
const WITH_PATH: [DocumentKind; 3] = [DocumentKind::PlanMesh, DocumentKind::RunMesh, DocumentKind::SimulateMesh];

/// Why the path of a result is not flown.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshReadBackError {
    /// The mesh, or its ends.
    #[error(transparent)]
    Mesh(#[from] MeshRouteError),
    /// The robot with legs, its ground, or its ends.
    #[error(transparent)]
    Legs(#[from] LegsRouteError),
    /// The result.
    #[error(transparent)]
    Result(#[from] ReadBackError),
    /// Another path than that of the result.
    #[error(
        "the path of this result is not the one that its scenario plans here, expected the same hops: it was changed, or planned by another version, \
         within another time or over a roadmap that was read"
    )]
    OtherPath,
    /// A result without a path.
    #[error("found a result without a path, expected one with hops to fly again: {0} states none")]
    NoPath(String),
}

/// The path of a result, flown again.
#[derive(Clone, Debug)]
pub struct MeshChecked {
    /// The path.
    pub path: HopPath,
    /// The answer as plain data.
    pub answer: MeshCheckAnswer,
    /// Warnings about the mesh and the path.
    pub warnings: Vec<String>,
}

/// Flies the path of a result over the mesh of its scenario again by direct simulation, and names every limit that it breaks; of a robot with legs
/// from stance to stance, over a mesh or a DEM. Nothing is searched.
///
/// `document`: a result of a plan, a run or trials over a mesh; `inputs`: the files of the scenario with their checksums, which have to be
/// those of the result.
///
/// # Errors
/// [`MeshReadBackError`]. That the path breaks a limit is an answer.
pub fn check_over_mesh(
    (scenario, base): (&Scenario, &Path),
    document: &Value,
    inputs: &[InputFile],
) -> Result<MeshChecked, MeshReadBackError> {
    if scenario.legs.file.is_some() {
        return check_over_stances((scenario, base), document, inputs);
    }
    let rows = rows_of(document, inputs, &WITH_PATH)?;
    let MeshEnds { ground, scale, given_m, surface, stood, stand_off_m, mut warnings } =
        mesh_ends(scenario, base, scenario.mesh_search.contacts_stand_off_m())?;
    let hops = rows.iter().map(hop_of).collect::<Result<_, _>>()?;
    let path = HopPath::of_hops(hops, ground.envelope().hopper());
    // Start and goal that are one contact need no hop, wherever they were asked for within its resolution.
    let [start, mut goal] = [0, 1].map(|i| MeshPosition::from(&stood[i]));
    if path.hops.is_empty() && ground.are_one_place([&stood[0], &stood[1]]) {
        goal = start;
    }
    let execution = execute_over_mesh(&ground.clone().standing_off(stand_off_m), &path, Some((start, goal)));
    warnings.extend(scenario.path_warnings(&path));
    let [start, goal] = [0, 1].map(|i| MeshContactRecord::new(&ground, &surface[i], given_m[i].coords.into()));
    let violations = execution.violations.iter().map(ViolationRecord::from).collect::<Vec<_>>();
    let answer = MeshCheckAnswer { mesh_scale: scale, start, goal, hops: rows.len(), holds: execution.passes(), violations };
    Ok(MeshChecked { path, answer, warnings })
}

/// The path over a mesh that a result holds. Trials over a mesh replan over the roadmap of a plan, and fly its path: the plan has to have this
/// one.
#[derive(Clone, Debug)]
pub struct MeshResultPath(Vec<HopRecord>);

impl MeshResultPath {
    /// Reads it from a result, whose input files have to be those that are read.
    ///
    /// # Errors
    /// [`MeshReadBackError`]: other input files, or a result without a path.
    pub fn read(document: &Value, inputs: &[InputFile]) -> Result<Self, MeshReadBackError> {
        rows_of(document, inputs, &WITH_PATH).map(Self)
    }

    /// Checks that a plan has this path.
    ///
    /// # Errors
    /// [`MeshReadBackError::OtherPath`].
    pub fn check_planned(&self, planned: &[HopRecord]) -> Result<(), MeshReadBackError> {
        // Numbers of a document keep their digits but for the last.
        let close = |(a, b): (f64, f64)| (a - b).abs() <= 1e-9 * (1.0 + b.abs());
        let same = |(row, hop): (&HopRecord, &HopRecord)| commands(row).into_iter().zip(commands(hop)).all(close);
        let is_same = self.0.len() == planned.len() && self.0.iter().zip(planned).all(same);
        if is_same { Ok(()) } else { Err(MeshReadBackError::OtherPath) }
    }
}

/// Where a hop begins and ends, and its command.
fn commands(row: &HopRecord) -> [f64; 8] {
    let at = row
        .map
        .as_ref()
        .map_or([f64::NAN; 4], |map| [map.takeoff_map_x_m, map.takeoff_map_y_m, map.landing_map_x_m, map.landing_map_y_m]);
    [row.takeoff_z_m, row.landing_z_m, row.takeoff_angle_deg, row.takeoff_speed_m_s, at[0], at[1], at[2], at[3]]
}

/// The hops of a result, whose input files have to be those that are read.
pub(super) fn rows_of(
    document: &Value,
    inputs: &[InputFile],
    with_path: &[DocumentKind],
) -> Result<Vec<HopRecord>, MeshReadBackError> {
    let schema = document["schema"].as_str().unwrap_or("no schema").to_owned();
    if !DocumentKind::of_schema(&schema).is_some_and(|kind| with_path.contains(&kind)) {
        return Err(ReadBackError::NoPath { found: schema }.into());
    }
    same_inputs(&key::<Vec<InputFile>>(document, "inputs")?, inputs)?;
    let rows: Vec<HopRecord> = key(document, "path")?;
    let Some(stated) = key::<Option<u64>>(document, "hops")? else { return Err(MeshReadBackError::NoPath(schema)) };
    if stated != rows.len() as u64 {
        return Err(ReadBackError::Hops { stated, listed: rows.len() }.into());
    }
    Ok(rows)
}

/// A hop from contact to contact, as the result states it.
pub(super) fn hop_of(row: &HopRecord) -> Result<Hop, ReadBackError> {
    let map = row.map.as_ref().ok_or(ReadBackError::NoPlaces { hop: row.hop })?;
    let takeoff_at = MapPoint::new(map.takeoff_map_x_m, map.takeoff_map_y_m);
    let landing_at = MapPoint::new(map.landing_map_x_m, map.landing_map_y_m);
    let takeoff = ContactPoint::on_map(row.takeoff_x_m, takeoff_at, row.takeoff_z_m);
    let landing = ContactPoint::on_map(row.landing_x_m, landing_at, row.landing_z_m);
    Ok(commanded(row, [takeoff, landing], None))
}
