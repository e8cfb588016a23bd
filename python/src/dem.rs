//! An elevation raster of an array or a file, and hops over it.

use std::{path::PathBuf, sync::Arc};

use chta::{
    ground::DemGround,
    quantity::MapPoint,
    reach::map::{Journey, PostHops, Search, Source, mobility, search},
    study::coarse_dem_warning,
    terrain::{GeoReference, MapProjection, OverlaidDem, Overlays, TerrainError, check_map_scale, read_dem},
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::{
    errors::{self, Class},
    machine::{complete, scenario_of},
    watch::watched,
};

/// Hops, effort, rows, columns, transform and warnings.
type HopArrays<'py> = (Bound<'py, PyArray1<i16>>, Option<Bound<'py, PyArray1<f64>>>, (usize, usize), [f64; 6], Vec<String>);

/// Share reached, directions, rows, columns, transform and warnings.
type MobilityArrays<'py> = (Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<f32>>, (usize, usize), [f64; 6], Vec<String>);

/// An elevation raster.
#[pyclass(frozen, module = "chta._chta")]
pub(crate) struct Dem(Arc<chta::terrain::Dem>);

/// The affine transform of a raster from its posts, which are the centres of its pixels.
pub(crate) fn transform(map: &GeoReference) -> [f64; 6] {
    let (corner, dx_m, dy_m) = (map.north_west(), map.dx_m(), map.dy_m());
    [dx_m, 0.0, corner.x - dx_m / 2.0, 0.0, -dy_m, corner.y + dy_m / 2.0]
}

fn refused(py: Python<'_>, error: &TerrainError) -> PyErr {
    errors::plain(py, Class::Terrain, error)
}

/// The georeference of an affine transform.
fn georeference(py: Python<'_>, [dx_m, b, left, d, down, top]: [f64; 6], crs: Option<&[String]>) -> PyResult<GeoReference> {
    if b != 0.0 || d != 0.0 || down >= 0.0 || dx_m <= 0.0 {
        let found = format!("({dx_m}, {b}, {left}, {d}, {down}, {top})");
        return Err(errors::input(py, "transform", found, "(dx, 0, left, 0, -dy, top) in metres: north up, as rasterio gives it"));
    }
    let north_west = MapPoint::new(left + dx_m / 2.0, top + down / 2.0);
    let local = GeoReference::local(north_west, dx_m, -down).map_err(|error| refused(py, &error))?;
    let Some(stated) = crs else { return Ok(local) };
    let mut first = None;
    for text in stated {
        match text.parse::<MapProjection>() {
            Ok(projection) => return Ok(local.with_projection(&projection)),
            Err(error) => first = first.or(Some(error.to_string())),
        }
    }
    Err(errors::input(
        py,
        "crs",
        stated.first().map_or("empty", String::as_str),
        &first.unwrap_or_else(|| "a map in metres".to_owned()),
    ))
}

impl Dem {
    /// The hops over it of a machine, and the warnings about both.
    fn hops(&self, py: Python<'_>, machine: &str, stride: usize) -> PyResult<(PostHops, chta::scenario::Scenario, Vec<String>)> {
        let scenario = scenario_of(py, machine)?;
        complete(py, &scenario)?;
        let mut warnings = self.0.warnings();
        warnings.extend(coarse_dem_warning(&scenario.hopper, self.0.georeference()));
        let hopper = scenario.hopper.with_any_command();
        let terrain = OverlaidDem::new(Arc::clone(&self.0), Overlays::default());
        let ground = DemGround::new(terrain, &hopper, scenario.body.gravity, &scenario.surface);
        let hops = PostHops::new(ground, stride.max(1)).map_err(|error| errors::of_map(py, &error))?;
        Ok((hops, scenario, warnings))
    }

    /// The node nearest to a place, which has to have an elevation.
    fn source(&self, py: Python<'_>, hops: &PostHops, (x, y): (f64, f64)) -> PyResult<Source> {
        let (at, bounds) = (MapPoint::new(x, y), self.0.bounds());
        if !bounds.contains(at) {
            return Err(errors::input(py, "start_xy_m", format!("({x}, {y})"), &format!("a place on the map, {bounds}")));
        }
        let post = hops.lattice().nearest(self.0.georeference(), at);
        match hops.position(post) {
            Some(_) => Ok(post.into()),
            None => Err(errors::input(py, "start_xy_m", format!("({x}, {y})"), "a place whose nearest post has an elevation")),
        }
    }
}

#[pymethods]
impl Dem {
    /// Reads a raster.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let read = py.detach(|| read_dem(&path));
        read.map(|dem| Self(Arc::new(dem))).map_err(|error| refused(py, &error))
    }

    /// From 64-bit elevations, row after row from the north, NaN without an elevation.
    #[staticmethod]
    #[pyo3(signature = (rows, cols, z_m, transform, crs=None))]
    fn of_double(
        py: Python<'_>,
        rows: usize,
        cols: usize,
        z_m: PyReadonlyArray1<'_, f64>,
        transform: [f64; 6],
        crs: Option<Vec<String>>,
    ) -> PyResult<Self> {
        let dem = chta::terrain::Dem::new(rows, cols, z_m.as_slice()?.to_vec(), georeference(py, transform, crs.as_deref())?);
        dem.map(|dem| Self(Arc::new(dem))).map_err(|error| refused(py, &error))
    }

    /// The same from 32-bit elevations, which are kept as they are.
    #[staticmethod]
    #[pyo3(signature = (rows, cols, z_m, transform, crs=None))]
    fn of_single(
        py: Python<'_>,
        rows: usize,
        cols: usize,
        z_m: PyReadonlyArray1<'_, f32>,
        transform: [f64; 6],
        crs: Option<Vec<String>>,
    ) -> PyResult<Self> {
        let dem =
            chta::terrain::Dem::from_single(rows, cols, z_m.as_slice()?.to_vec(), georeference(py, transform, crs.as_deref())?);
        dem.map(|dem| Self(Arc::new(dem))).map_err(|error| refused(py, &error))
    }

    /// Rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.0.rows(), self.0.cols())
    }

    /// The affine transform of its pixels.
    #[getter]
    fn transform(&self) -> [f64; 6] {
        transform(self.0.georeference())
    }

    /// The reference system as well-known text; `None` if it is not known.
    #[getter]
    fn crs_wkt(&self) -> Option<String> {
        self.0.georeference().projection().ok().map(|known| known.wkt())
    }

    /// The elevations, m, row after row from the north; NaN without one.
    fn elevations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.elevations().map(|z_m| z_m.unwrap_or(f64::NAN)).collect::<Vec<_>>().into_pyarray(py)
    }

    /// The fewest hops between starts and every node.
    #[pyo3(signature = (starts_m, machine, back=false, stride=1, effort=false, hops_max=None, accept_map_scale=false, threads=None, progress=None))]
    fn hop_map<'py>(
        &self,
        py: Python<'py>,
        starts_m: Vec<(f64, f64)>,
        machine: &str,
        back: bool,
        stride: usize,
        effort: bool,
        hops_max: Option<i16>,
        accept_map_scale: bool,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<HopArrays<'py>> {
        let (hops, scenario, mut warnings) = self.hops(py, machine, stride)?;
        let sources: Vec<_> = starts_m.iter().map(|start| self.source(py, &hops, *start)).collect::<PyResult<_>>()?;
        let projection = self.0.georeference().projection();
        for (x, y) in &starts_m {
            let scale = check_map_scale(&*self.0, projection.as_ref(), MapPoint::new(*x, *y), accept_map_scale, "the map".as_ref());
            let scale = scale.map_err(|error| errors::plain(py, Class::Input, error))?;
            warnings.extend(scale.warning().filter(|warning| !warnings.contains(warning)));
        }
        let asked = Search {
            journey: if back { Journey::Return } else { Journey::Outbound },
            effort: effort.then_some((scenario.search.effort, scenario.search.takeoff)),
            hops_max,
        };
        let found = watched(py, threads, progress.as_ref(), |watch| search(&hops, &sources, asked, watch))?;
        let found = found.map_err(|error| errors::of_map(py, &error))?;
        let lattice = hops.lattice();
        let map = transform(&lattice.map(self.0.georeference()));
        let effort = effort.then(|| found.effort.clone().into_pyarray(py));
        Ok((found.hops.into_pyarray(py), effort, (lattice.rows, lattice.cols), map, warnings))
    }

    /// How freely the machine moves from every node by one hop.
    #[pyo3(signature = (machine, stride=1, threads=None, progress=None))]
    fn mobility<'py>(
        &self,
        py: Python<'py>,
        machine: &str,
        stride: usize,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<MobilityArrays<'py>> {
        let (hops, _, warnings) = self.hops(py, machine, stride)?;
        let found = watched(py, threads, progress.as_ref(), |watch| mobility(&hops, watch))?;
        let found = found.map_err(|error| errors::of_map(py, &error))?;
        let lattice = hops.lattice();
        let map = transform(&lattice.map(self.0.georeference()));
        Ok((found.share.into_pyarray(py), found.directions.into_pyarray(py), (lattice.rows, lattice.cols), map, warnings))
    }
}
