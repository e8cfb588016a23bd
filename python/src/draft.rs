//! A scenario and its questions.

use std::path::PathBuf;

use chta::{
    figure::PictureFormat,
    graph::proof::DEFAULT_BUDGET_CELLS,
    planner::Amount,
    quantity::MapPoint,
    study::{
        Front, Proof, Requirement, SimulateOptions, SweptKey,
        map::{MapStudy, PreparedMap},
        open::{self, AskError, HopAsked, MapAsked, PlanAsked, SitesAsked, Wording},
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
pub(crate) struct Reply(open::Reply);

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
const WORDING: Wording =
    Wording { question: "command", of_map: "--goal, --effort, --amount-output or --simulate", file_name: open::relative_name };

fn points(at_m: Vec<(f64, f64)>) -> Vec<MapPoint> {
    at_m.into_iter().map(|(x, y)| MapPoint::new(x, y)).collect()
}

fn proof(cells: Option<usize>) -> Option<Proof> {
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
        dem=None, candidates_m=vec![], every=1, targets_m=vec![], stride=1, auto_nodes=false, memory_max_bytes=None, threads=None,
        progress=None
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
        memory_max_bytes: Option<u64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let (candidates_m, targets_m) = (points(candidates_m), points(targets_m));
        let asked = SitesAsked { dem, candidates_m, every, targets_m, stride, auto_nodes, memory_max_bytes };
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
}
