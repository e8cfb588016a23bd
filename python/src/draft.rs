//! A scenario and its questions.

use std::path::PathBuf;

use chta::{
    arena::{RandomBoxes, Reading, RrtStarOptions},
    ballistics::stance::ConeKind,
    figure::PictureFormat,
    graph::proof::DEFAULT_BUDGET_CELLS,
    ground::StandsUp,
    planner::Amount,
    quantity::MapPoint,
    study::{
        ArenaPlanner, Front, Proof, Requirement, SimulateOptions, SweptKey,
        map::{MapStudy, PreparedMap},
        open::{
            self, ArenaAsked, AskError, FanAsked, HopAsked, MapAsked, PlanAsked, SharedInputs, SitesAsked, StanceAsked, Wording,
        },
    },
};
use numpy::{IntoPyArray, PyArray1};
use pyo3::{prelude::*, types::PyBytes};

use crate::{
    dem::transform,
    errors::{self, Class},
    watch::{Watch, watched},
};

/// An answer: its document and its picture.
#[pyclass(frozen, module = "chta._chta")]
pub(crate) struct Reply(pub(crate) open::Reply);

#[pymethods]
impl Reply {
    /// The kind of its document, such as `plan`.
    #[getter]
    fn kind(&self) -> &'static str {
        self.0.kind.name()
    }

    /// Whether the answer is yes.
    #[getter]
    fn holds(&self) -> bool {
        self.0.holds
    }

    /// Its document.
    fn json<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, self.0.json.as_bytes())
    }

    /// The ground along its path, x and z one after the other, m. Empty if the path is not along a chain or over slices of a DEM.
    fn ground<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.ground.iter().flat_map(|point| [point.x_m, point.z_m]).collect::<Vec<f64>>().into_pyarray(py)
    }

    /// Its picture, as SVG or PNG; `None` where it has none.
    fn picture<'py>(&self, py: Python<'py>, png: bool) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let format = if png { PictureFormat::Png } else { PictureFormat::Svg };
        let drawn = py.detach(|| self.0.picture().map(|picture| picture.and_then(|picture| picture.encoded(format))));
        let drawn = drawn.transpose().map_err(|error| errors::plain(py, Class::Other, error))?;
        Ok(drawn.map(|bytes| PyBytes::new(py, &bytes)))
    }
}

/// The rasters of a map.
#[pyclass(frozen, module = "chta._chta")]
pub(crate) struct Rasters(PreparedMap, MapStudy);

#[pymethods]
impl Rasters {
    /// Rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.0.lattice.rows, self.0.lattice.cols)
    }

    /// The affine transform of the pixels.
    #[getter]
    fn transform(&self) -> [f64; 6] {
        transform(&self.0.nodes())
    }

    /// The reference system as well-known text; `None` if it is not known.
    #[getter]
    fn crs_wkt(&self) -> Option<String> {
        self.0.projection.as_ref().ok().map(chta::terrain::MapProjection::wkt)
    }

    /// The hops to every node, row after row from the north.
    fn hops<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i16>> {
        self.1.out.hops.clone().into_pyarray(py)
    }

    /// The hops back to the nearest start, if they were asked for.
    fn hops_back<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<i16>>> {
        self.1.back.as_ref().map(|back| back.hops.clone().into_pyarray(py))
    }

    /// The least effort, if it was asked for.
    fn effort<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        (!self.1.out.effort.is_empty()).then(|| self.1.out.effort.clone().into_pyarray(py))
    }

    /// Share and directions of single hops, if they were asked for.
    fn mobility<'py>(&self, py: Python<'py>) -> Option<(Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<f32>>)> {
        let found = self.1.mobility.as_ref()?;
        Some((found.share.clone().into_pyarray(py), found.directions.clone().into_pyarray(py)))
    }

    /// Totals of amounts along the paths, by name.
    fn amounts<'py>(&self, py: Python<'py>) -> Vec<(&'static str, Bound<'py, PyArray1<f64>>)> {
        self.1.amounts.iter().map(|(amount, totals)| (amount.name(), totals.clone().into_pyarray(py))).collect()
    }
}

/// A scenario before it is validated.
#[pyclass(frozen, module = "chta._chta")]
pub(crate) struct Draft(open::Draft);

/// The words of documents: those of the command, so that their bytes are the same.
pub(crate) const WORDING: Wording =
    Wording { question: "command", of_map: "--goal, --effort, --amount-output or --simulate", file_name: open::relative_name };

fn points(at_m: Vec<(f64, f64)>) -> Vec<MapPoint> {
    at_m.into_iter().map(|(x, y)| MapPoint::new(x, y)).collect()
}

pub(crate) fn proof(cells: Option<usize>) -> Option<Proof> {
    cells.map(|cells| Proof { budget_cells: if cells == 0 { DEFAULT_BUDGET_CELLS } else { cells } })
}

/// The amount of a name.
fn amount(py: Python<'_>, name: &str) -> PyResult<Amount> {
    let found = Amount::ALL.into_iter().find(|amount| amount.name() == name);
    let names = || format!("one of {}", Amount::ALL.map(Amount::name).join(", "));
    found.ok_or_else(|| errors::input(py, "amount", name, &names()))
}

impl Draft {
    /// Asks a question without the interpreter.
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        (threads, progress): (Option<usize>, Option<Py<PyAny>>),
        question: impl FnOnce(&open::Draft, &Watch) -> Result<T, AskError> + Send,
    ) -> PyResult<T> {
        let answer = watched(py, threads, progress.as_ref(), |watch| question(&self.0, watch))?;
        answer.map_err(|error| errors::raised(py, &error))
    }
}

#[pymethods]
impl Draft {
    /// Reads a scenario (TOML) or a result (JSON).
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let draft = py.detach(|| open::Draft::read(&path)).map_err(|error| errors::raised(py, &error.into()))?;
        Ok(Self(open::Draft { wording: WORDING, ..draft }))
    }

    /// The keys of a TOML text.
    #[staticmethod]
    fn of_toml(text: &str, base: PathBuf) -> Self {
        Self(open::Draft { wording: WORDING, ..open::Draft::of_toml(text, "text", &base) })
    }

    /// The keys of tables (JSON).
    #[staticmethod]
    fn of_tables(py: Python<'_>, tables: &str, base: PathBuf) -> PyResult<Self> {
        let tables = serde_json::from_str(tables).map_err(|error| errors::input(py, "scenario", error, "tables of keys"))?;
        Ok(Self(open::Draft { wording: WORDING, ..open::Draft::of_tables(&tables, &base) }))
    }

    /// The same with keys set: JSON of `[["table.key", value], ...]`.
    fn with_keys(&self, py: Python<'_>, settings: &str) -> PyResult<Self> {
        let parsed: Result<Vec<(String, toml::Value)>, _> = serde_json::from_str(settings);
        let parsed = parsed.map_err(|error| errors::input(py, "set", error, "values that a scenario takes"))?;
        let mut draft = self.0.clone();
        for (path, value) in parsed {
            let Some((table, name)) = path.split_once('.') else {
                return Err(errors::input(py, "set", &path, "table.key, such as hopper.takeoff_speed_max_m_s"));
            };
            draft.entries.set_by_option("set", table, name, value);
        }
        Ok(Self(draft))
    }

    /// Validates the keys, for a robot with legs or a hopper, and returns the scenario as used (JSON).
    fn validated(&self, py: Python<'_>) -> PyResult<String> {
        let scenario = self.0.validated(true).map_err(|found| errors::problems(py, &found))?;
        let name = |path: &std::path::Path| open::relative_name(&self.0.base.join(path));
        Ok(chta::scenario::scenario_document(&scenario, &name).to_string())
    }

    /// Plans a path.
    #[pyo3(signature = (prove_cells=None, verify=false, front=None, alternatives=false, memory_max_bytes=None, threads=None, progress=None))]
    fn plan(
        &self,
        py: Python<'_>,
        prove_cells: Option<usize>,
        verify: bool,
        front: Option<&str>,
        alternatives: bool,
        memory_max_bytes: Option<u64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let named = |name: &str| Front::all().find(|front| front.name() == name);
        let names = || format!("one of {}", Front::all().map(Front::name).collect::<Vec<_>>().join("; "));
        let front = front.map(|name| named(name).ok_or_else(|| errors::input(py, "front", name, &names()))).transpose()?;
        let asked = PlanAsked { proof: proof(prove_cells), verify, front, alternatives, memory_max_bytes };
        self.ask(py, (threads, progress), |draft, watch| draft.plan(&asked, watch)).map(Reply)
    }

    /// Whether a path exists.
    #[pyo3(signature = (prove_cells=None, threads=None, progress=None))]
    fn check(
        &self,
        py: Python<'_>,
        prove_cells: Option<usize>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        self.ask(py, (threads, progress), |draft, watch| draft.check(proof(prove_cells), watch)).map(Reply)
    }

    /// Trials of a path.
    #[pyo3(signature = (compare=false, until_half_width=None, first_trial=0, success_min=None, threads=None, progress=None))]
    fn simulate(
        &self,
        py: Python<'_>,
        compare: bool,
        until_half_width: Option<f64>,
        first_trial: u64,
        success_min: Option<f64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let options = SimulateOptions { compare, until_half_width, first_trial, success_min, tally: false };
        self.ask(py, (threads, progress), |draft, watch| draft.simulate(&options, watch)).map(Reply)
    }

    /// The tally of some trials as JSON; `None` without a path.
    #[pyo3(signature = (first_trial, trials, threads=None, progress=None))]
    fn tally(
        &self,
        py: Python<'_>,
        first_trial: u64,
        trials: u64,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Option<String>> {
        let Some(end) = first_trial.checked_add(trials) else {
            return Err(errors::input(py, "first_trial", first_trial, "a smaller number"));
        };
        self.ask(py, (threads, progress), |draft, watch| draft.tally(first_trial..end, watch))
    }

    /// The answer of trials that were flown in parts, by their tallies.
    #[pyo3(signature = (tallies, success_min=None, threads=None, progress=None))]
    fn merged(
        &self,
        py: Python<'_>,
        tallies: Vec<String>,
        success_min: Option<f64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let options = SimulateOptions { success_min, ..SimulateOptions::default() };
        self.ask(py, (threads, progress), |draft, watch| draft.merged(&tallies, &options, watch)).map(Reply)
    }

    /// The same, whose variants read their terrain together.
    fn sharing(&self) -> Self {
        Self(open::Draft { shared: Some(SharedInputs::default()), ..self.0.clone() })
    }

    /// The checksums of the files that the scenario names.
    fn checksums(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let scenario = self.0.validated(true).map_err(|found| errors::problems(py, &found))?;
        let shared = self.0.shared.clone().unwrap_or_default();
        let files = shared.checksums(&scenario, &self.0.base, &|path| path.display().to_string());
        let files = files.map_err(|error| errors::raised(py, &error.into()))?;
        Ok(files.into_iter().map(|file| file.sha256).collect())
    }

    /// A path, and its trials where the scenario has errors.
    #[pyo3(signature = (threads=None, progress=None))]
    fn run(&self, py: Python<'_>, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<(Reply, Option<Reply>)> {
        let ran = self.ask(py, (threads, progress), |draft, watch| draft.run(watch))?;
        Ok((Reply(ran.plan), ran.trials.map(Reply)))
    }

    /// One hop.
    #[pyo3(signature = (from_m=None, to_m=None))]
    fn hop(&self, py: Python<'_>, from_m: Option<Vec<f64>>, to_m: Option<Vec<f64>>) -> PyResult<Reply> {
        let asked = HopAsked { from_m, to_m };
        self.ask(py, (None, None), |draft, _| draft.hop(&asked)).map(Reply)
    }

    /// Hops over a whole terrain.
    #[pyo3(signature = (
        dem=None, starts_m=vec![], goals_m=vec![], stride=1, auto_nodes=false, effort=false, returns=false, mobility=false, trials=false,
        hops_max=None, amounts=vec![], memory_max_bytes=None, threads=None, progress=None
    ))]
    fn map(
        &self,
        py: Python<'_>,
        dem: Option<PathBuf>,
        starts_m: Vec<(f64, f64)>,
        goals_m: Vec<(f64, f64)>,
        stride: usize,
        auto_nodes: bool,
        effort: bool,
        returns: bool,
        mobility: bool,
        trials: bool,
        hops_max: Option<i16>,
        amounts: Vec<String>,
        memory_max_bytes: Option<u64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Reply, Option<Rasters>)> {
        let asked = MapAsked {
            dem,
            starts_m: points(starts_m),
            goals_m: points(goals_m),
            stride,
            auto_nodes,
            effort,
            returns,
            mobility,
            predecessors: false,
            trials,
            hops_max,
            amounts: amounts.iter().map(|name| amount(py, name)).collect::<PyResult<_>>()?,
            memory_max_bytes,
        };
        let answered = self.ask(py, (threads, progress), |draft, watch| draft.map_hops(&asked, watch))?;
        Ok((Reply(answered.reply), answered.rasters.map(|(prepared, study)| Rasters(prepared, study))))
    }

    /// Landing sites ranked.
    #[pyo3(signature = (
        dem=None, candidates_m=vec![], every=1, targets_m=vec![], stride=1, auto_nodes=false, trials=false, memory_max_bytes=None,
        threads=None, progress=None
    ))]
    fn sites(
        &self,
        py: Python<'_>,
        dem: Option<PathBuf>,
        candidates_m: Vec<(f64, f64)>,
        every: usize,
        targets_m: Vec<(f64, f64)>,
        stride: usize,
        auto_nodes: bool,
        trials: bool,
        memory_max_bytes: Option<u64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let (candidates_m, targets_m) = (points(candidates_m), points(targets_m));
        let asked = SitesAsked { dem, candidates_m, every, targets_m, stride, auto_nodes, trials, memory_max_bytes };
        self.ask(py, (threads, progress), |draft, watch| draft.sites(&asked, watch)).map(Reply)
    }

    /// The least capability with which the goal can be reached.
    #[pyo3(signature = (vary, from_value=None, to_value=None, resolution=0.001, prove_cells=None, threads=None, progress=None))]
    fn require(
        &self,
        py: Python<'_>,
        vary: &str,
        from_value: Option<f64>,
        to_value: Option<f64>,
        resolution: f64,
        prove_cells: Option<usize>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let cells = prove_cells.unwrap_or(DEFAULT_BUDGET_CELLS / 5);
        let requirement = Requirement::new(vary, [from_value, to_value], resolution, cells, "vary");
        let requirement = requirement.map_err(|error| errors::raised(py, &error.into()))?;
        self.ask(py, (threads, progress), |draft, watch| draft.require(&requirement, watch)).map(Reply)
    }

    /// A verdict for every value of one or two keys, each given as `table.key=from:to:steps`.
    #[pyo3(signature = (vary, prove_cells=None, threads=None, progress=None))]
    fn trade(
        &self,
        py: Python<'_>,
        vary: Vec<String>,
        prove_cells: Option<usize>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let swept = vary.iter().map(|text| SweptKey::parse(text)).collect::<Result<Vec<_>, _>>();
        let swept = swept.map_err(|error| errors::raised(py, &error.into()))?;
        self.ask(py, (threads, progress), |draft, watch| draft.trade(&swept, proof(prove_cells), watch)).map(Reply)
    }

    /// Robots with legs and kinds of cones compared.
    #[pyo3(signature = (robots, cones, threads=None, progress=None))]
    fn trade_legs(
        &self,
        py: Python<'_>,
        robots: Vec<PathBuf>,
        cones: Vec<String>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let named = |name: &String| ConeKind::ALL.into_iter().find(|kind| kind.name() == name);
        let names = || format!("one of {}", ConeKind::ALL.map(ConeKind::name).join(", "));
        let kinds = cones.iter().map(|name| named(name).ok_or_else(|| errors::input(py, "robot.cone", name, &names())));
        let kinds: Vec<_> = kinds.collect::<PyResult<_>>()?;
        self.ask(py, (threads, progress), |draft, watch| draft.trade_legs(robots, kinds, watch)).map(Reply)
    }

    /// Where a robot with legs stands.
    #[pyo3(signature = (at_m, terrain=None, robot=None, heading_deg=None, height_m=None, up="normal", headings=72))]
    fn stance(
        &self,
        py: Python<'_>,
        at_m: Vec<f64>,
        terrain: Option<PathBuf>,
        robot: Option<PathBuf>,
        heading_deg: Option<f64>,
        height_m: Option<f64>,
        up: &str,
        headings: u32,
    ) -> PyResult<Reply> {
        let found = StandsUp::ALL.into_iter().find(|ways| ways.name() == up);
        let up = found.ok_or_else(|| errors::input(py, "up", up, "normal or vertical"))?;
        let asked = StanceAsked { terrain, at_m, robot, heading_deg, height_m, up, headings: counted(py, headings)? };
        self.ask(py, (None, None), |draft, _| draft.stance(&asked)).map(Reply)
    }

    /// Slices in all directions from a point.
    #[pyo3(signature = (from_m, length_m, dem=None, headings=36, memory_max_bytes=None, threads=None, progress=None))]
    fn fan(
        &self,
        py: Python<'_>,
        from_m: (f64, f64),
        length_m: f64,
        dem: Option<PathBuf>,
        headings: u32,
        memory_max_bytes: Option<u64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let from_m = MapPoint::new(from_m.0, from_m.1);
        let asked = FanAsked { dem, from_m, headings, length_m, memory_max_bytes };
        self.ask(py, (threads, progress), |draft, watch| draft.fan(&asked, watch)).map(Reply)
    }

    /// Several scenarios side by side.
    #[staticmethod]
    #[pyo3(signature = (scenarios, prove_cells=None, threads=None, progress=None))]
    fn compare(
        py: Python<'_>,
        scenarios: Vec<PyRef<'_, Self>>,
        prove_cells: Option<usize>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let drafts: Vec<open::Draft> = scenarios.iter().map(|scenario| scenario.0.clone()).collect();
        let answer = watched(py, threads, progress.as_ref(), |watch| open::compare(&drafts, proof(prove_cells), watch))?;
        answer.map(Reply).map_err(|error| errors::raised(py, &error))
    }
}

/// The headings of a rose, as many as the command takes.
fn counted(py: Python<'_>, headings: u32) -> PyResult<u32> {
    let is_taken = (4..=3600).contains(&headings);
    if is_taken { Ok(headings) } else { Err(errors::input(py, "headings", headings, "a whole number from 4 to 3600")) }
}

/// The cone of contacts without a robot.
#[pyfunction]
#[pyo3(signature = (file, headings=72))]
pub(crate) fn stance_of_contacts(py: Python<'_>, file: PathBuf, headings: u32) -> PyResult<Reply> {
    let headings = counted(py, headings)?;
    open::stance_of_contacts(&file, headings, &WORDING).map(Reply).map_err(|error| errors::raised(py, &error))
}

/// A path of a wheeled jumper among boxes. `settings`: `table.key=value`, each.
#[pyfunction]
#[pyo3(signature = (
    file, planner="any-angle", reading="R1", may_jump=true, compare=false, seed=None, nodes=None, random=None, random_sizes_m=vec![],
    settings=vec![]
))]
pub(crate) fn arena(
    py: Python<'_>,
    file: PathBuf,
    planner: &str,
    reading: &str,
    may_jump: bool,
    compare: bool,
    seed: Option<u64>,
    nodes: Option<usize>,
    random: Option<usize>,
    random_sizes_m: Vec<f64>,
    settings: Vec<String>,
) -> PyResult<Reply> {
    let usual = RrtStarOptions::default();
    let grown = RrtStarOptions { nodes: nodes.unwrap_or(usual.nodes), seed: seed.unwrap_or(usual.seed), ..usual };
    if !(2..=1_000_000).contains(&grown.nodes) {
        return Err(errors::input(py, "nodes", grown.nodes, "a whole number from 2 to 1000000"));
    }
    let reading = match reading {
        "R1" => Reading::R1,
        "R0" => Reading::R0,
        other => return Err(errors::input(py, "reading", other, "R1 or R0")),
    };
    let planner = match planner {
        "any-angle" => ArenaPlanner::AnyAngle,
        "grid" => ArenaPlanner::Grid(reading),
        "rrt-star" => ArenaPlanner::RrtStar(grown),
        other => return Err(errors::input(py, "planner", other, "any-angle, grid or rrt-star")),
    };
    if random_sizes_m.iter().any(|size_m| !(*size_m > 0.0 && *size_m <= 1e6)) {
        return Err(errors::input(py, "random_sizes_m", "a length that is not above 0", "sides such as 1, 3, 6"));
    }
    if random.is_some_and(|count| count > 300) {
        return Err(errors::input(py, "random", random.unwrap_or_default(), "at most 300 boxes"));
    }
    let boxes = |count| {
        let usual = RandomBoxes::default();
        let sizes_m = if random_sizes_m.is_empty() { usual.sizes_m } else { random_sizes_m };
        (RandomBoxes { count, sizes_m, ..usual }, seed.unwrap_or(1))
    };
    let asked = ArenaAsked {
        file,
        settings: settings.into_iter().map(|assignment| (format!("set {assignment}"), assignment)).collect(),
        planner,
        may_jump,
        compare: compare.then_some(grown),
        random: random.map(boxes),
    };
    // Nothing in it reports progress: it runs beside the interpreter all the same.
    let answer = watched(py, None, None, |_| open::arena(&asked, &WORDING))?;
    answer.map(Reply).map_err(|error| errors::raised(py, &error))
}
