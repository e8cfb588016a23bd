//! The folder of a whole run.

use std::{
    fs,
    path::{Path, PathBuf},
};

use chta::{
    chain::csv::write_chain_csv,
    figure::{FigureError, Picture, PictureFormat, SeenFrom},
    path::HopPath,
    report::{CrsRecord, DocumentKind, MapKnowledge, write_path_csv, write_travel_csv},
    study::{
        Case, LegsRouted, LegsSimulated, MeshRouted, MeshSimulated, PageDocuments, Planned, Simulated, TargetsPlanned,
        TargetsSimulated, TravelPlanned, TravelSimulated,
    },
};

use super::{
    Failure,
    args::RunArgs,
    claims,
    load::{Loaded, MeshPlanInput},
    output::{self, Pending},
    page::{PageFile, PageInput},
    pictures,
    trajectory::TrajectoryFile,
};

/// The kind of the answer, which a run accepts as input to repeat it.
const RESULT: &str = "result.json";

/// The names of a picture, as SVG and as PNG.
type PictureNames = [&'static str; 2];

/// The picture of the plan.
const PICTURE: PictureNames = ["path.svg", "path.png"];

/// The key postures of a robot with legs.
const POSTURES: PictureNames = ["postures.svg", "postures.png"];

/// The pictures of the trials.
const TRIAL_PICTURES: [PictureNames; 2] = [["trials.svg", "trials.png"], ["landings.svg", "landings.png"]];

/// Files that only some runs have: those left by an earlier run that had a path, trials, another map or other pictures would contradict this one.
const OF_SOME_RUNS: [&str; 4] = ["chain.csv", "path.geojson", "path.prj", "simulation.json"];

/// The most pages of a picture: those of trials.
const PAGES_MAX: usize = 3;

/// The files of a run before they are written.
#[derive(Debug)]
pub(crate) struct RunFolder<'a> {
    folder: &'a Path,
    files: Vec<(&'static str, Vec<u8>)>,
    /// Further pages of the pictures.
    pages: Vec<(PathBuf, Vec<u8>)>,
    /// Files that have places of their own.
    beside: Vec<(Pending<'a>, Vec<u8>)>,
    /// The file of the page, until its content is known.
    page: Option<PageFile<'a>>,
    /// The format of its pictures.
    pictures: PictureFormat,
}

/// Makes the folder of the files, unless it exists.
fn made(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder).map_err(|error| {
        Failure::message(format!("{}: cannot be made ({error}): choose a folder that may be written to", folder.display()))
    })
}

impl<'a> RunFolder<'a> {
    /// The folder of a run without files, after checking that it can be written to. Files beside it are opened at once, so that the folder is made
    /// if they lie in it.
    ///
    /// # Errors
    /// A folder or file that cannot be made.
    pub(crate) fn begin(args: &'a RunArgs) -> Result<Self, Failure> {
        output::check_folder(&args.output)?;
        let beside = [args.trajectory.trajectory.as_deref(), args.report.as_deref()];
        if beside.iter().flatten().any(|file| file.parent() == Some(&args.output)) {
            made(&args.output)?;
        }
        let page = args.report.as_deref().map(|file| PageFile::begin("--report", file)).transpose()?;
        Ok(Self {
            folder: &args.output,
            files: Vec::new(),
            pages: Vec::new(),
            beside: Vec::new(),
            page,
            pictures: args.pictures.into(),
        })
    }

    /// The page of the documents, if there is one.
    fn page(&mut self, input: PageInput<'_>) -> Result<(), Failure> {
        let Some(file) = self.page.take() else { return Ok(()) };
        let documents = self.files.iter().filter(|(name, _)| Path::new(name).extension().is_some_and(|ending| ending == "json"));
        let texts = documents.map(|(_, bytes)| String::from_utf8_lossy(bytes).into_owned()).collect();
        let documents = PageDocuments::read(texts).map_err(|error| Failure::of(&error))?;
        self.beside.push(file.filled(input.page(&documents)?));
        Ok(())
    }

    /// Adds the path in time, which has a place of its own.
    pub(crate) fn trajectory(&mut self, file: Option<TrajectoryFile<'a>>, planned: &Planned) -> Result<(), Failure> {
        self.trajectory_of(file, planned.path.as_ref(), &planned.case)
    }

    /// The same of a path on the chain of a case.
    pub(crate) fn trajectory_of(
        &mut self,
        file: Option<TrajectoryFile<'a>>,
        path: Option<&HopPath>,
        case: &Case,
    ) -> Result<(), Failure> {
        self.beside.extend(file.map(|file| file.filled(path, case)).transpose()?);
        Ok(())
    }

    /// Adds a picture, with a file for each page.
    fn picture(&mut self, [svg, png]: PictureNames, drawn: Result<Picture, FigureError>) -> Result<(), Failure> {
        let name = match self.pictures {
            PictureFormat::Svg => svg,
            PictureFormat::Png => png,
        };
        let mut pages = pictures::pages(drawn, Path::new(name))?.into_iter();
        self.files.extend(pages.next().map(|(_, first)| (name, first)));
        self.pages.extend(pages);
        Ok(())
    }

    /// Adds the chain, the path, the answer and its picture.
    pub(crate) fn plan(&mut self, planned: &Planned, loaded: &Loaded) -> Result<(), Failure> {
        let mut chain_csv = Vec::new();
        let (scenario, prepared) = (&planned.case.scenario, &planned.case.prepared);
        let projection = prepared.projection.as_ref();
        let mut comments =
            vec![format!("chta {} run of {}", env!("CARGO_PKG_VERSION"), scenario.title.as_deref().unwrap_or("a scenario"))];
        comments.extend(projection.map(|projection| CrsRecord::from(projection).comments()).unwrap_or_default());
        write_chain_csv(prepared.chain.geometry(), &mut chain_csv, &comments).map_err(|e| Failure::of(&e))?;
        let mut path_csv = Vec::new();
        planned.write_csv(&mut path_csv).map_err(|error| Failure::message(format!("path.csv: {error}")))?;
        let result = loaded.document(DocumentKind::Run, &planned.warnings, &planned.answer)?;
        self.files.extend([("chain.csv", chain_csv), ("path.csv", path_csv), (RESULT, result.into_bytes())]);
        self.picture(PICTURE, planned.picture())?;
        if let Some(geojson) = planned.geojson() {
            self.files.push(("path.geojson", geojson.into_bytes()));
            self.files.extend(output::prj(projection).map(|text| ("path.prj", text)));
        }
        Ok(())
    }

    /// Adds the answer of the trials and its pictures.
    pub(crate) fn trials(&mut self, simulated: &Simulated, loaded: &Loaded) -> Result<(), Failure> {
        let document = loaded.document(DocumentKind::Simulate, &simulated.warnings, &simulated.answer)?;
        self.files.push(("simulation.json", document.into_bytes()));
        for (name, picture) in TRIAL_PICTURES.into_iter().zip([simulated.picture(), simulated.landing_map()]) {
            if let Some(drawn) = picture {
                self.picture(name, drawn)?;
            }
        }
        Ok(())
    }

    /// Adds the path over a mesh, the answer and its picture.
    pub(crate) fn plan_over_mesh(&mut self, routed: &MeshRouted, input: &MeshPlanInput) -> Result<(), Failure> {
        let mut path_csv = Vec::new();
        write_path_csv(&routed.answer.path, MapKnowledge::Metres, &mut path_csv)
            .map_err(|error| Failure::message(format!("path.csv: {error}")))?;
        let result = input.document(DocumentKind::RunMesh, &routed.warnings, &routed.answer)?;
        self.files.extend([("path.csv", path_csv), (RESULT, result.into_bytes())]);
        self.picture(PICTURE, routed.picture(&input.scenario, SeenFrom::default()))?;
        Ok(())
    }

    /// Adds the answer of the trials over a mesh and its picture.
    pub(crate) fn trials_over_mesh(&mut self, simulated: &MeshSimulated, input: &MeshPlanInput) -> Result<(), Failure> {
        let document = input.document(DocumentKind::SimulateMesh, &simulated.warnings, &simulated.answer)?;
        self.files.push(("simulation.json", document.into_bytes()));
        if let Some(drawn) = simulated.picture(&input.scenario) {
            self.picture(TRIAL_PICTURES[0], drawn)?;
        }
        Ok(())
    }

    /// Adds the path of a robot with legs, the answer, its picture and the key postures.
    pub(crate) fn plan_of_legs(&mut self, routed: &LegsRouted, input: &MeshPlanInput) -> Result<(), Failure> {
        let mut path_csv = Vec::new();
        write_path_csv(&routed.answer.plan.path, MapKnowledge::Metres, &mut path_csv)
            .map_err(|error| Failure::message(format!("path.csv: {error}")))?;
        let result = input.document_on_map(DocumentKind::PlanLegs, routed.crs().as_ref(), &routed.warnings, &routed.answer)?;
        self.files.extend([("path.csv", path_csv), (RESULT, result.into_bytes())]);
        self.picture(PICTURE, routed.picture(&input.scenario, SeenFrom::default()))?;
        if let Some(drawn) = routed.postures_picture(&input.scenario, 1) {
            self.picture(POSTURES, drawn)?;
        }
        if let Some(geojson) = routed.geojson() {
            self.files.push(("path.geojson", geojson.into_bytes()));
            self.files.extend(output::prj(routed.projection.as_ref()).map(|text| ("path.prj", text)));
        }
        Ok(())
    }

    /// Adds the answer of the trials of a robot with legs.
    pub(crate) fn trials_of_legs(&mut self, simulated: &LegsSimulated, input: &MeshPlanInput) -> Result<(), Failure> {
        let crs = simulated.routed.crs();
        let document = input.document_on_map(DocumentKind::SimulateLegs, crs.as_ref(), &simulated.warnings, &simulated.answer)?;
        self.files.push(("simulation.json", document.into_bytes()));
        Ok(())
    }

    /// Adds the legs of a mission that drives, the answer and its picture.
    pub(crate) fn plan_of_travel(&mut self, planned: &TravelPlanned, loaded: &Loaded) -> Result<(), Failure> {
        let mut path_csv = Vec::new();
        write_travel_csv(&planned.answer.path, &mut path_csv).map_err(|error| Failure::message(format!("path.csv: {error}")))?;
        let result = loaded.document(DocumentKind::PlanTravel, &planned.warnings, &planned.answer)?;
        self.files.extend([("path.csv", path_csv), (RESULT, result.into_bytes())]);
        self.picture(PICTURE, planned.picture())?;
        Ok(())
    }

    /// Adds the answer of the trials of a mission that drives, and its picture.
    pub(crate) fn trials_of_travel(&mut self, simulated: &TravelSimulated, loaded: &Loaded) -> Result<(), Failure> {
        let document = loaded.document(DocumentKind::SimulateTravel, &simulated.warnings, &simulated.answer)?;
        self.files.push(("simulation.json", document.into_bytes()));
        self.picture(TRIAL_PICTURES[0], simulated.picture())?;
        Ok(())
    }

    /// Adds the hops of a mission over targets, the answer and its picture.
    pub(crate) fn plan_of_targets(&mut self, planned: &TargetsPlanned, loaded: &Loaded) -> Result<(), Failure> {
        let mut path_csv = Vec::new();
        planned.write_csv(&mut path_csv).map_err(|error| Failure::message(format!("path.csv: {error}")))?;
        let result = loaded.document(DocumentKind::PlanTargets, &planned.warnings, &planned.answer)?;
        self.files.extend([("path.csv", path_csv), (RESULT, result.into_bytes())]);
        self.picture(PICTURE, planned.picture())?;
        if let Some(geojson) = planned.geojson() {
            self.files.push(("path.geojson", geojson.into_bytes()));
            self.files.extend(output::prj(planned.case.prepared.projection.as_ref()).map(|text| ("path.prj", text)));
        }
        Ok(())
    }

    /// Adds the answer of the trials of a mission over targets, and its picture.
    pub(crate) fn trials_of_targets(&mut self, simulated: &TargetsSimulated, loaded: &Loaded) -> Result<(), Failure> {
        let document = loaded.document(DocumentKind::SimulateTargets, &simulated.warnings, &simulated.answer)?;
        self.files.push(("simulation.json", document.into_bytes()));
        self.picture(TRIAL_PICTURES[0], simulated.picture())?;
        Ok(())
    }

    /// Writes all files or none, with the page over this ground, and removes those of an earlier run that this one does not have. Returns what was
    /// written, in words.
    pub(crate) fn write(mut self, input: PageInput<'_>) -> Result<String, Failure> {
        self.page(input)?;
        let Self { folder, files, pages, beside, .. } = self;
        made(folder)?;
        claims::repeats(&folder.join(RESULT));
        let files: Vec<(PathBuf, Vec<u8>)> = files.into_iter().map(|(name, bytes)| (name.into(), bytes)).chain(pages).collect();
        let names: Vec<_> = files.iter().map(|(name, _)| name.display().to_string()).collect();
        let pending: Result<Vec<_>, Failure> =
            files.into_iter().map(|(name, bytes)| Ok((Pending::begin(folder.join(name))?, bytes))).collect();
        let mut pending = pending?;
        pending.extend(beside);
        output::finish(pending)?;
        let is_stale = |name: &PathBuf| !names.contains(&name.display().to_string());
        let drawn = [PICTURE, POSTURES].into_iter().chain(TRIAL_PICTURES).flatten().map(Path::new);
        let drawn = drawn.flat_map(|first| (1..=PAGES_MAX).map(move |number| pictures::page_file(first, number)));
        for stale in OF_SOME_RUNS.into_iter().map(PathBuf::from).chain(drawn).filter(is_stale) {
            let _ = fs::remove_file(folder.join(stale));
        }
        Ok(format!("written to {}: {}", folder.display(), names.join(", ")))
    }
}
