//! A chain of arrays, and hops between many pairs of its points.

use chta::{
    chain::{ConstrainedChain, GroundForm, OffChain, PolygonalChain, SegmentGround},
    hop::HopTest,
    quantity::{Angle, ChainPoint},
    report::HopAnswer,
    scenario::Scenario,
    study::open::{self, ChainAsked},
    world::{FrictionCone, Limit},
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::{
    draft::{Reply, WORDING, proof},
    errors,
    machine::{complete, scenario_of},
    watch::{Watch, watched},
};

/// Pairs that one task of a thread answers.
const CHUNK: usize = 4096;

/// Take-off angles from and to, degrees, and the code of the limit that leaves none.
type Angles = (Vec<f64>, Vec<f64>, Vec<i8>);

/// The same as arrays.
type AngleArrays<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<i8>>);

/// A chain under the limits of a machine.
#[pyclass(frozen, module = "chta._chta")]
pub(crate) struct Chain {
    test: HopTest,
    scenario: Scenario,
    /// The chain as given: a plan is made for the machine's own commands.
    given: PolygonalChain,
}

/// The code of a limit: its index.
fn code(limit: Limit) -> i8 {
    i8::try_from(limit.index()).unwrap_or(i8::MAX)
}

impl Chain {
    /// One pair.
    fn pair(&self, from_x_m: f64, to_x_m: f64) -> Result<(f64, f64, i8), OffChain> {
        let geometry = self.test.chain().geometry();
        let (takeoff, landing) = (geometry.station(from_x_m)?, geometry.station(to_x_m)?);
        let angles = self.test.lofts(&takeoff, &landing).map(|lofts| {
            let slope = self.test.line_of_sight(&takeoff, &landing).map_or(0.0, |sight| sight.slope());
            lofts.shifted(slope).angles()
        });
        Ok(match angles {
            Ok(Some(angles)) => (angles.min.degrees(), angles.max.degrees(), -1),
            Ok(None) => (f64::NAN, f64::NAN, code(Limit::LineOfSight)),
            Err(limit) => (f64::NAN, f64::NAN, code(limit)),
        })
    }

    /// Some pairs, in their order.
    fn pairs(&self, from_x_m: &[f64], to_x_m: &[f64]) -> Result<Angles, OffChain> {
        let mut angles =
            (Vec::with_capacity(from_x_m.len()), Vec::with_capacity(from_x_m.len()), Vec::with_capacity(from_x_m.len()));
        for (from, to) in from_x_m.iter().zip(to_x_m) {
            let (min, max, limit) = self.pair(*from, *to)?;
            angles.0.push(min);
            angles.1.push(max);
            angles.2.push(limit);
        }
        Ok(angles)
    }

    /// Many pairs, by all threads; those after a cancellation are left out.
    fn many(&self, from_x_m: &[f64], to_x_m: &[f64], watch: &Watch) -> Result<Angles, OffChain> {
        let chunks = from_x_m.par_chunks(CHUNK).zip(to_x_m.par_chunks(CHUNK));
        let answered: Vec<_> = chunks
            .map(|(from, to)| if watch.is_cancelled() { Ok(Angles::default()) } else { self.pairs(from, to) })
            .collect::<Result<_, _>>()?;
        let mut all = Angles::default();
        for (min, max, limit) in answered {
            all.0.extend(min);
            all.1.extend(max);
            all.2.extend(limit);
        }
        Ok(all)
    }
}

#[pymethods]
impl Chain {
    /// A chain of vertices. Arrays of segments have one entry fewer; `None`: what the surface says.
    #[new]
    #[pyo3(signature = (x_m, z_m, machine, cross_slope_deg=None, friction_coefficient=None, keep_out=None))]
    fn new(
        py: Python<'_>,
        x_m: PyReadonlyArray1<'_, f64>,
        z_m: PyReadonlyArray1<'_, f64>,
        machine: &str,
        cross_slope_deg: Option<PyReadonlyArray1<'_, f64>>,
        friction_coefficient: Option<PyReadonlyArray1<'_, f64>>,
        keep_out: Option<PyReadonlyArray1<'_, bool>>,
    ) -> PyResult<Self> {
        let scenario = scenario_of(py, machine)?;
        let (x_m, z_m) = (x_m.as_slice()?, z_m.as_slice()?);
        if x_m.len() != z_m.len() {
            let found = format!("{} numbers beside {} of x_m", z_m.len(), x_m.len());
            return Err(errors::input(py, "z_m", found, "as many as x_m"));
        }
        let segments = x_m.len().saturating_sub(1);
        let of_segments = |name: &str, count: usize| {
            if count == segments {
                return Ok(());
            }
            Err(errors::input(py, name, format!("{count} values"), "one for each segment, one fewer than vertices"))
        };
        let cross = cross_slope_deg.as_ref().map(|array| array.as_slice()).transpose()?;
        let friction = friction_coefficient.as_ref().map(|array| array.as_slice()).transpose()?;
        let out = keep_out.as_ref().map(|array| array.as_slice()).transpose()?;
        cross.map_or(Ok(()), |array| of_segments("cross_slope_deg", array.len()))?;
        friction.map_or(Ok(()), |array| of_segments("friction_coefficient", array.len()))?;
        out.map_or(Ok(()), |array| of_segments("keep_out", array.len()))?;
        if friction.is_none() {
            complete(py, &scenario)?;
        }
        let mut grounds = Vec::with_capacity(segments);
        for i in 0..segments {
            let cone = friction.map(|array| FrictionCone::new(array[i])).transpose();
            let cone = cone.map_err(|error| errors::plain(py, errors::Class::Input, format!("segment {}: {error}", i + 1)))?;
            let cross_slope = Angle::from_degrees(cross.map_or(0.0, |array| array[i]));
            grounds.push(SegmentGround {
                form: GroundForm::Surface { friction: cone, cross_slope },
                keep_out: out.is_some_and(|array| array[i]),
            });
        }
        let vertices = x_m.iter().zip(z_m).map(|(x, z)| ChainPoint::new(*x, *z)).collect();
        let refused = |error: &dyn std::error::Error| errors::plain(py, errors::Class::Input, error);
        let geometry = PolygonalChain::new(vertices, grounds, None).map_err(|error| refused(&error))?;
        // As every question about single hops, for exact commands.
        let hopper = scenario.hopper.with_any_command();
        let given = geometry.clone();
        let chain = ConstrainedChain::new(geometry, &hopper, scenario.body.gravity, &scenario.surface);
        Ok(Self { test: HopTest::new(chain.map_err(|error| refused(&error))?), scenario, given })
    }

    /// Hops between pairs of positions: least and greatest take-off angle, degrees, NaN without a hop; and the code of the limit that leaves
    /// none, -1 with a hop.
    #[pyo3(signature = (from_x_m, to_x_m, threads=None))]
    fn takeoff_set<'py>(
        &self,
        py: Python<'py>,
        from_x_m: PyReadonlyArray1<'py, f64>,
        to_x_m: PyReadonlyArray1<'py, f64>,
        threads: Option<usize>,
    ) -> PyResult<AngleArrays<'py>> {
        let (from, to) = (from_x_m.as_slice()?, to_x_m.as_slice()?);
        if from.len() != to.len() {
            return Err(errors::input(py, "to_x_m", to.len(), "as many positions as from_x_m"));
        }
        let angles = if from.len() <= CHUNK && threads.is_none() {
            self.pairs(from, to)
        } else {
            watched(py, threads, None, |watch| self.many(from, to, watch))?
        };
        let (min, max, limit) = angles.map_err(|error| errors::plain(py, errors::Class::Input, error))?;
        Ok((min.into_pyarray(py), max.into_pyarray(py), limit.into_pyarray(py)))
    }

    /// One hop, limit by limit, as JSON.
    fn hop(&self, py: Python<'_>, from_x_m: f64, to_x_m: f64) -> PyResult<String> {
        let geometry = self.test.chain().geometry();
        let station = |x_m| geometry.station(x_m).map_err(|error| errors::plain(py, errors::Class::Input, error));
        let (takeoff, landing) = (station(from_x_m)?, station(to_x_m)?);
        let answer = HopAnswer::new(&self.test, &takeoff, &landing, self.scenario.search.takeoff);
        let answer = answer.ok_or_else(|| errors::input(py, "to_x_m", to_x_m, "another place than from_x_m"))?;
        serde_json::to_string(&answer).map_err(|error| errors::plain(py, errors::Class::Other, error))
    }

    /// A path along the chain, for the machine, surface, body and search of these tables.
    #[pyo3(signature = (machine, start_x_m=None, goal_x_m=None, prove_cells=None, verify=false, threads=None, progress=None))]
    fn plan(
        &self,
        py: Python<'_>,
        machine: &str,
        start_x_m: Option<f64>,
        goal_x_m: Option<f64>,
        prove_cells: Option<usize>,
        verify: bool,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Reply> {
        let tables = serde_json::from_str(machine).map_err(|error| errors::input(py, "tables", error, "JSON"))?;
        let draft = open::Draft { wording: WORDING, ..open::Draft::of_tables(&tables, "".as_ref()) };
        let asked = ChainAsked { start_x_m, goal_x_m, proof: proof(prove_cells), verify };
        let chain = self.given.clone();
        let answer = watched(py, threads, progress.as_ref(), |watch| draft.plan_along(chain, &asked, watch))?;
        answer.map(Reply).map_err(|error| errors::raised(py, &error))
    }
}
