//! The path of a result, read back to be flown as it stands.

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{
    Case, CaseError, Commands, Planned, SimulateError,
    free_read_back::{over_dem, unrolled_along},
    free_route::execute_over_dem,
};
use crate::{
    chain::OffChain,
    graph::{Answer, Cost, Outcome, PointSpacing, RefusalCounts},
    ground::{ContactPoint, Surface},
    hop::HopTest,
    path::{Aim, Hop, HopPath, RollOut, Violation},
    quantity::{Angle, AngleInterval, MapPoint},
    report::{CheckAnswer, DocumentKind, HopRecord, InputFile, PlanAnswer, TotalsRecord},
    scenario::Route,
    world::Direction,
};

/// The kinds of answers that hold a path along a chain.
const WITH_PATH: [DocumentKind; 3] = [DocumentKind::Plan, DocumentKind::Run, DocumentKind::Simulate];

/// Why the path of a result is not flown.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadBackError {
    /// The case.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// An answer without a path, of another command or of an older version.
    #[error("found a document of {found}, expected one of plan, run or simulate with the path to fly")]
    NoPath {
        /// Its `schema`.
        found: String,
    },
    /// A key that is missing, or that has a value of another kind.
    #[error("{key} is not as results have it ({problem}): give the JSON that chta wrote")]
    Key {
        /// The key.
        key: &'static str,
        /// The problem.
        problem: serde_json::Error,
    },
    /// An input that has changed, or is another one.
    #[error(
        "the result was made with {name} of SHA-256 {then}, but no file of the scenario has that content{}: give that file",
        now.as_ref().map(|now| format!(" (that name now has {now})")).unwrap_or_default()
    )]
    Changed {
        /// Its name in the result.
        name: String,
        /// Its checksum in the result.
        then: String,
        /// The checksum of the file of that name now, if there is one.
        now: Option<String>,
    },
    /// A count that the path does not have.
    #[error("the result states {stated} hops, but its path has {listed}: give the JSON that chta wrote")]
    Hops {
        /// What is stated.
        stated: u64,
        /// What is listed.
        listed: usize,
    },
    /// A position off the chain.
    #[error("hop {hop} of the result: {problem}")]
    OffChain {
        /// The number of the hop, from 1.
        hop: usize,
        /// The problem.
        problem: OffChain,
    },
    /// A hop of a free route without its places on the map.
    #[error(
        "hop {hop} of the result has no places on the map, expected them for terrain.route = \"free\": give the JSON that chta wrote"
    )]
    NoPlaces {
        /// The number of the hop, from 1.
        hop: usize,
    },
    /// A free route between other places than those that the scenario asks for.
    #[error(
        "the path of the result goes from ({}, {}) m to ({}, {}) m, but the scenario asks for ({}, {}) m to ({}, {}) m",
        found[0].x, found[0].y, found[1].x, found[1].y, asked[0].x, asked[0].y, asked[1].x, asked[1].y
    )]
    OtherEnds {
        /// Those of the result.
        found: [MapPoint; 2],
        /// Those of the scenario.
        asked: [MapPoint; 2],
    },
    /// The raster that it is flown over.
    #[error(transparent)]
    Dem(Box<SimulateError>),
    /// A path that does not hold under the scenario as it is now.
    #[error(
        "the path of the result does not hold under this scenario ({} violations): {}",
        violations.len(),
        violations.iter().take(3).map(ToString::to_string).collect::<Vec<_>>().join("; ")
    )]
    Breaks {
        /// All violations.
        violations: Vec<Violation>,
    },
}

impl Planned {
    /// The plan that a result holds: its path is read back, and flown again by the independent checker against every limit of the case.
    /// Nothing is searched.
    ///
    /// `document`: a result of plan, run or simulate; `inputs`: the files of the case with their checksums, which have to be those of the
    /// result.
    ///
    /// # Errors
    /// [`ReadBackError`].
    pub fn read_back(case: &Case, document: &Value, inputs: &[InputFile]) -> Result<Self, ReadBackError> {
        let schema = document["schema"].as_str().unwrap_or("no schema");
        let has_path = DocumentKind::of_schema(schema).is_some_and(|kind| WITH_PATH.contains(&kind));
        if !has_path || document.get("path").is_none() {
            return Err(ReadBackError::NoPath { found: schema.to_owned() });
        }
        same_inputs(&key::<Vec<InputFile>>(document, "inputs")?, inputs)?;
        let rows: Vec<HopRecord> = key(document, "path")?;
        let check = CheckAnswer::deserialized(document)?;
        let case = match case.scenario.route {
            Route::Transect => case.with_commands(Commands::OfTheMachine)?,
            Route::Free => unrolled_along(case, &rows)?,
        };
        let (test, ends) = (case.hop_test(), case.ends()?);
        let flies = check.is_traversable() || !rows.is_empty();
        if let Some(stated) = check.hops.filter(|stated| flies && *stated != rows.len() as u64) {
            return Err(ReadBackError::Hops { stated, listed: rows.len() });
        }
        let path = flies.then(|| path_of(&test, &rows)).transpose()?;
        if let Some(path) = &path {
            let mut execution = case.prepared.execute(path, ends);
            if let Some(ground) = over_dem(&case)? {
                execution.violations.extend(execute_over_dem(&ground, path).violations);
            }
            if !execution.passes() {
                return Err(ReadBackError::Breaks { violations: execution.violations });
            }
        }
        let stated = check.node_spacing_max_m.map_or(PointSpacing::PerSegment(check.points_per_segment), PointSpacing::AtMostM);
        let spacing = match case.scenario.route {
            Route::Transect => case.scenario.search.spacing.unwrap_or(stated),
            // That of the lattice, which divides the post spacing.
            Route::Free => stated,
        };
        let found = Answer {
            outcome: Outcome::Path { legs: Vec::new(), cost: Cost::of_hops(rows.len() as u64) },
            spacing,
            points_per_segment: check.points_per_segment,
            nodes: check.nodes,
            pairs_tested: check.pairs_tested,
            refusals: RefusalCounts::default(),
        };
        let warnings = path.as_ref().map(|path| case.scenario.path_warnings(path)).unwrap_or_default();
        let totals = path.as_ref().map(|path| TotalsRecord::from(&path.totals));
        let answer = PlanAnswer {
            check,
            verified: path.is_some().then_some(true),
            path: rows,
            totals,
            reliable_paths: Vec::new(),
            front: None,
            front_search: None,
        };
        Ok(Self { case, test, ends, found, path, answer, warnings, to_go: None })
    }
}

/// The value of a key of a document.
pub(super) fn key<T: DeserializeOwned>(document: &Value, key: &'static str) -> Result<T, ReadBackError> {
    serde_json::from_value(document[key].clone()).map_err(|problem| ReadBackError::Key { key, problem })
}

impl CheckAnswer {
    fn deserialized(document: &Value) -> Result<Self, ReadBackError> {
        serde_json::from_value(document.clone()).map_err(|problem| ReadBackError::Key { key: "the answer", problem })
    }
}

/// Whether every file of a result is there with the same content.
pub(super) fn same_inputs(then: &[InputFile], now: &[InputFile]) -> Result<(), ReadBackError> {
    match then.iter().find(|then| now.iter().all(|now| now.sha256 != then.sha256)) {
        None => Ok(()),
        Some(changed) => Err(ReadBackError::Changed {
            name: changed.name.clone(),
            then: changed.sha256.clone(),
            now: now.iter().find(|now| now.name == changed.name).map(|now| now.sha256.clone()),
        }),
    }
}

fn path_of(test: &HopTest, rows: &[HopRecord]) -> Result<HopPath, ReadBackError> {
    // Hops beside the line have no station.
    let beside = rows.iter().any(|row| row.aim.is_some_and(|aim| aim.beside.is_some()));
    let hops = rows.iter().map(|row| hop_of(test, row, beside)).collect::<Result<_, _>>()?;
    Ok(HopPath::of_hops(hops, test.hopper()))
}

fn hop_of(test: &HopTest, row: &HopRecord, beside: bool) -> Result<Hop, ReadBackError> {
    let chain = test.chain();
    let off_chain = |problem| ReadBackError::OffChain { hop: row.hop, problem };
    let on_chain =
        |along_m: f64| Ok::<_, ReadBackError>(chain.contact_point(&chain.geometry().station(along_m).map_err(off_chain)?));
    let point = |along_m: f64, z_m: f64, at: Option<MapPoint>| {
        at.filter(|_| beside).map_or_else(|| on_chain(along_m), |at| Ok(ContactPoint::on_map(along_m, at, z_m)))
    };
    let map = row.map.as_ref();
    let takeoff_at = map.map(|map| MapPoint::new(map.takeoff_map_x_m, map.takeoff_map_y_m));
    let landing_at = map.map(|map| MapPoint::new(map.landing_map_x_m, map.landing_map_y_m));
    let aim = row.aim.map(|aim| {
        let across_m = aim.beside.map(|beside| beside.landing_miss_across_m);
        Ok::<_, ReadBackError>(Aim { point: on_chain(aim.aim_x_m)?, miss_m: aim.landing_miss_m, across_m })
    });
    let takeoff = point(row.takeoff_x_m, row.takeoff_z_m, takeoff_at)?;
    let landing = point(row.landing_x_m, row.landing_z_m, landing_at)?;
    Ok(commanded(row, [takeoff, landing], aim.transpose()?))
}

/// A hop between two contacts, with the numbers that a result states.
pub(super) fn commanded(row: &HopRecord, [takeoff, landing]: [ContactPoint; 2], aim: Option<Aim>) -> Hop {
    let map = row.map.as_ref();
    Hop {
        direction: row.direction,
        takeoff,
        landing,
        heading_deg: map.map_or(if row.direction == Direction::Forward { 90.0 } else { 270.0 }, |map| map.heading_deg),
        takeoff_angle: Angle::from_degrees(row.takeoff_angle_deg),
        takeoff_speed_m_s: row.takeoff_speed_m_s,
        landing_angle: Angle::from_degrees(row.landing_angle_deg),
        landing_speed_m_s: row.landing_speed_m_s,
        flight_time_s: row.flight_time_s,
        apex_z_m: row.apex_z_m,
        delta_v_m_s: row.stores.delta_v_m_s,
        propellant: None,
        takeoff_angles: AngleInterval::from_degrees(row.takeoff_angle_min_deg, row.takeoff_angle_max_deg),
        speed_margin_m_s: row.speed_margin_m_s,
        lower_limit: row.binding.lower,
        lower_vertex: None,
        upper_limit: row.binding.upper,
        margins: row.margins.0,
        aim,
        roll_out: row.roll_out.as_ref().map(RollOut::from),
    }
}
