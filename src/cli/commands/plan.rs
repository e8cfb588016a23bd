//! `chta plan`: the path of fewest hops, then least effort.

use std::{fmt::Write, path::Path};

use chta::{
    chain::Station,
    figure::{FigureError, FigureInput, FigureTitle, Picture, draw},
    graph,
    hop::HopTest,
    path::{Execution, HopPath, execute},
    quantity::{Angle, AngleInterval},
    report::{
        CheckAnswer, Document, DocumentKind, HopRecord, PlanAnswer, ReliablePathRecord, TotalsRecord, check_text, path_geojson,
        path_text, reliable_paths_text, write_path_csv,
    },
    scenario::Scenario,
    world::{Grip, RestSlope},
};

use super::{
    search::{Searched, use_threads},
    trajectory,
};
use crate::cli::{
    Answer, Failure,
    args::{Format, PlanArgs, ProveArgs},
    effects::Purpose,
    hints::further_means,
    inputs,
    load::{EndOptions, Loaded, load},
    output::{self, Pending},
    wrong_thing::Role,
};

/// A plan with everything needed to draw and write it.
#[derive(Debug)]
pub(super) struct Planned {
    pub(super) found: graph::Answer,
    pub(super) path: Option<HopPath>,
    pub(super) answer: PlanAnswer,
    pub(super) warnings: Vec<String>,
}

impl Planned {
    /// Searches (and proves if requested), generates the path, and flies it again if requested.
    pub(super) fn new(
        loaded: &Loaded,
        test: &HopTest,
        prove: Option<ProveArgs>,
        verify: bool,
        quiet: bool,
    ) -> Result<Self, Failure> {
        let ends = loaded.ends()?;
        let options = &loaded.scenario.search;
        let searched = Searched::new(test, ends, &loaded.scenario, prove, quiet)?;
        let (check, path) = searched.answer_with_path(test, ends, options);
        let path = path.map_err(|error| Failure::of(&error))?;
        if let Some(path) = path.as_ref().filter(|_| verify) {
            verified(loaded, path, ends)?;
        }
        let warnings = path.as_ref().map(|path| loaded.scenario.path_warnings(path)).unwrap_or_default();
        for warning in &warnings {
            output::warn(quiet, warning);
        }
        let warnings = loaded.warnings_with(warnings);
        let answer = PlanAnswer {
            check,
            verified: (verify && path.is_some()).then_some(true),
            path: path.as_ref().map(|path| HopRecord::rows(path, loaded.prepared.projection.as_ref())).unwrap_or_default(),
            totals: path.as_ref().map(|path| TotalsRecord::from(&path.totals)),
            reliable_paths: ReliablePathRecord::rows(&searched.reliable_paths),
        };
        Ok(Self { found: searched.found, path, answer, warnings })
    }

    /// Whether a path exists, and what stops it.
    pub(super) const fn check(&self) -> &CheckAnswer {
        &self.answer.check
    }

    /// The exit status: yes with a path that the machine can fly, no without.
    pub(super) const fn verdict(&self) -> Answer {
        if self.answer.check.is_traversable() { Answer::Yes } else { Answer::No }
    }

    /// The answer for reading.
    pub(super) fn text(&self) -> String {
        let mut text = check_text(&self.answer.check, further_means());
        if let Some(totals) = &self.answer.totals {
            text.push('\n');
            text.push_str(&path_text(&self.answer.path, totals));
        }
        text.push_str(&reliable_paths_text(&self.answer.reliable_paths));
        if self.answer.verified == Some(true) {
            let of = if self.check().propellant_shortage.is_some() { " of a hop" } else { "" };
            let _ = writeln!(text, "verified: every hop was flown again by direct simulation and breaks no limit{of}");
        }
        text
    }

    /// The path as CSV; only the header without a path.
    pub(super) fn csv(&self, loaded: &Loaded) -> Result<Vec<u8>, Failure> {
        let mut csv = Vec::new();
        write_path_csv(&self.answer.path, trajectory::map_knowledge(loaded), &mut csv)
            .map_err(|e| Failure::message(format!("path.csv: {e}")))?;
        Ok(csv)
    }

    /// The path as GeoJSON over the map; `None` without a path or a map.
    pub(super) fn geojson(&self, loaded: &Loaded) -> Option<String> {
        loaded.prepared.chain.geometry().map_points()?;
        path_geojson(self.path.as_ref()?, loaded.scenario.body.gravity.m_s2(), loaded.prepared.projection.as_ref())
    }

    /// The result as one JSON document of the given kind.
    pub(super) fn document(&self, kind: DocumentKind, loaded: &Loaded) -> Result<String, Failure> {
        let document = loaded.document.clone();
        let document = Document::new(kind, document, loaded.inputs.clone(), self.warnings.clone(), self.answer.clone());
        Ok(document.on_map(loaded.prepared.projection.as_ref()).to_json()?)
    }

    /// The picture, in the format of the file's extension.
    pub(super) fn picture(
        &self,
        loaded: &Loaded,
        test: &HopTest,
        ends: (Station, Station),
        file: &Path,
    ) -> Result<Vec<u8>, Failure> {
        output::encoded(self.drawn(loaded, test, ends), file)
    }

    fn drawn(&self, loaded: &Loaded, test: &HopTest, (start, goal): (Station, Station)) -> Result<Picture, FigureError> {
        let scenario = &loaded.scenario;
        draw(&FigureInput {
            test,
            answer: &self.found,
            path: self.path.as_ref(),
            start,
            goal,
            title: FigureTitle {
                name: scenario.title.clone().unwrap_or_default(),
                body: scenario.body.name.clone().unwrap_or_default(),
                ground: format_ground(scenario),
            },
        })
    }
}

/// The ground in a few words: grip, rest slope and overlays.
pub(super) fn format_ground(scenario: &Scenario) -> String {
    let surface = &scenario.surface;
    let mut parts = Vec::new();
    match surface.grip {
        Some(Grip::Friction(cone)) => parts.push(format!("friction coefficient {}", cone.coefficient())),
        Some(Grip::FromSlope { takeoff, landing }) => {
            let range = |angles: AngleInterval| {
                let [min, max] = [angles.min, angles.max].map(Angle::written_degrees);
                format!("{min} to {max}")
            };
            parts.push(format!("take-off {} and landing {} deg from the slope", range(takeoff), range(landing)));
        }
        None => {}
    }
    let file = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    parts.extend(scenario.friction_raster.as_deref().map(|path| format!("friction from {}", file(path))));
    match (surface.rest, surface.grip) {
        (RestSlope::AsFrictionHolds, Some(Grip::Friction(_))) => parts.push("rest slope as friction holds".to_owned()),
        (RestSlope::AsFrictionHolds, _) => {}
        (RestSlope::AtMost(slope), _) => {
            parts.push(format!("rest slope ≤ {} deg", slope.written_degrees()));
        }
        (RestSlope::Unlimited, _) => parts.push("rest slope without limit".to_owned()),
    }
    parts.extend(scenario.keep_out.as_deref().map(|path| format!("keep-out {}", file(path))));
    parts.join("; ")
}

/// Flies a path along its chain again.
fn verified(loaded: &Loaded, path: &HopPath, (start, goal): (Station, Station)) -> Result<(), Failure> {
    // Commands in steps land near the goal; the answer says by how much they miss it.
    let landing = path.hops.last().filter(|hop| hop.aim.is_some()).and_then(|hop| hop.landing.station);
    passed(&execute(loaded.prepared.chain.as_ref(), path, Some((start, landing.unwrap_or(goal)))))
}

/// Reports a path that breaks a limit when it is flown again as a defect of the program.
pub(super) fn passed(execution: &Execution) -> Result<(), Failure> {
    if execution.passes() {
        return Ok(());
    }
    let violations: Vec<_> = execution.violations.iter().take(10).map(ToString::to_string).collect();
    Err(Failure::message(format!(
        "the planned path does not pass its own check ({} violations): {}; this is a defect of chta, please report it with the scenario",
        execution.violations.len(),
        violations.join("; ")
    )))
}

/// Plans a path.
pub(crate) fn run(args: &PlanArgs) -> Result<Answer, Failure> {
    inputs::look_at(
        args.common.input_max_gib,
        &[(Some(&args.journey.chain), Role::Chain), (args.common.scenario.as_deref(), Role::ScenarioOption)],
    )?;
    use_threads(args.answer.threads)?;
    let loaded = load(
        &args.journey.chain,
        &args.common,
        Some(&args.search),
        EndOptions::of_path(args.journey.start, args.journey.goal),
        Purpose::Plan,
    )?;
    let ends = loaded.ends()?;
    if args.geojson.is_some() && loaded.prepared.chain.geometry().map_points().is_none() {
        return Err(Failure::message("--geojson: the chain lies on no map; give it map_x_m and map_y_m, or slice it from a DEM"));
    }
    let csv_to_stdout = args.output.as_deref() == Some(Path::new("-"));
    // Outputs are opened before the search, which may take long.
    let plot = args.plot.as_deref().map(|path| output::begin_picture("--plot", path)).transpose()?;
    let geojson = args.geojson.as_deref().map(Pending::begin).transpose()?;
    let prj_text = output::prj(loaded.prepared.projection.as_ref());
    let prj_path = args.geojson.as_deref().filter(|_| prj_text.is_some()).map(|path| path.with_extension("prj"));
    let prj = prj_path.as_deref().map(Pending::begin).transpose()?;
    let csv = args.output.as_deref().filter(|_| !csv_to_stdout).map(Pending::begin).transpose()?;
    let in_time = trajectory::begin(&args.trajectory)?;
    let test = loaded.hop_test();
    let planned = Planned::new(&loaded, &test, Some(args.prove), args.verify, args.common.quiet)?;
    let mut files = Vec::new();
    if let Some(file) = plot {
        let picture = planned.picture(&loaded, &test, ends, file.path())?;
        files.push((file, picture));
    }
    if let (Some(file), Some(geojson)) = (geojson, planned.geojson(&loaded)) {
        files.push((file, geojson.into_bytes()));
        files.extend(prj.zip(prj_text));
    }
    if let Some(file) = csv {
        files.push((file, planned.csv(&loaded)?));
    }
    files.extend(trajectory::filled(in_time, &args.trajectory, planned.path.as_ref(), &loaded)?);
    output::finish(files)?;
    let text = match args.answer.format {
        _ if csv_to_stdout => planned.csv(&loaded)?,
        Format::Text => planned.text().into_bytes(),
        Format::Json => planned.document(DocumentKind::Plan, &loaded)?.into_bytes(),
    };
    output::to_stdout(&text)?;
    Ok(planned.verdict())
}
