"""Chains and elevation rasters of numpy arrays."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _chta
from ._answers import Grid, Plan, Transform
from ._errors import InputError
from ._machine import BodyLike, HopperLike, SurfaceLike, tables
from ._scenario import XY, Progress

if TYPE_CHECKING:
    import xarray

LIMITS: tuple[str, ...] = tuple(_chta.LIMITS)
"""The limits by their codes in `TakeoffSet.limit`."""


Machine = tuple[HopperLike, SurfaceLike, BodyLike]


class TakeoffSet(NamedTuple):
    """Hops between many pairs: arrays of the shape to which the positions were broadcast."""

    takeoff_angle_min_deg: NDArray[np.float64]
    """The least take-off angle, NaN where no hop is feasible."""
    takeoff_angle_max_deg: NDArray[np.float64]
    """The greatest take-off angle, NaN where no hop is feasible."""
    limit: NDArray[np.int8]
    """-1 where a hop is feasible, else the place in `LIMITS` of the limit that leaves none."""

    @property
    def feasible(self) -> NDArray[np.bool_]:
        """Where a hop is feasible."""
        return np.asarray(self.limit == -1)


def _vector(values: ArrayLike | None, kind: Any = np.float64) -> NDArray[Any] | None:
    return None if values is None else np.ascontiguousarray(values, dtype=kind)


class Chain:
    """A chain of straight segments under the limits of a hopper."""

    def __init__(
        self, inner: _chta.Chain, x_m: NDArray[np.float64], z_m: NDArray[np.float64], machine: Machine
    ) -> None:
        self._inner, self.x_m, self.z_m, self._machine = inner, x_m, z_m, machine

    @classmethod
    def from_arrays(
        cls,
        x_m: ArrayLike,
        z_m: ArrayLike,
        *,
        hopper: HopperLike,
        surface: SurfaceLike,
        body: BodyLike,
        cross_slope_deg: ArrayLike | None = None,
        friction_coefficient: ArrayLike | None = None,
        keep_out: ArrayLike | None = None,
    ) -> Chain:
        """A chain of vertices. The last three have one value for each segment, one fewer than vertices.

        >>> import numpy as np, chta
        >>> chain = chta.Chain.from_arrays(
        ...     [0, 10, 20, 30], [0, 1, 0, 0.5], body="moon",
        ...     hopper=chta.Hopper(takeoff_speed_max_m_s=5, landing_speed_max_m_s=5),
        ...     surface=chta.Surface(friction_coefficient=0.6))
        >>> hops = chain.takeoff_set(2.0, [8.0, 12.0, 28.0])
        >>> hops.feasible.tolist(), chta.LIMITS[hops.limit[2]]
        ([True, True, False], 'takeoff-speed')
        """
        x, z = np.ascontiguousarray(x_m, np.float64), np.ascontiguousarray(z_m, np.float64)
        if x.ndim != 1 or z.ndim != 1:
            raise InputError(f"x_m and z_m have {x.ndim} and {z.ndim} dimensions, expected one")
        inner = _chta.Chain(
            x,
            z,
            tables(hopper, surface, body),
            _vector(cross_slope_deg),
            _vector(friction_coefficient),
            _vector(keep_out, np.bool_),
        )
        return cls(inner, x, z, (hopper, surface, body))

    def takeoff_set(self, from_x_m: ArrayLike, to_x_m: ArrayLike, *, threads: int | None = None) -> TakeoffSet:
        """The feasible take-off angles of a hop between each pair of positions, which broadcast."""
        start, end = np.asarray(from_x_m, np.float64, order="C"), np.asarray(to_x_m, np.float64, order="C")
        if start.shape != end.shape:
            start, end = np.broadcast_arrays(start, end)
        elif start.ndim == 1:
            return TakeoffSet(*self._inner.takeoff_set(start, end, threads))
        shape = start.shape
        least, greatest, limit = self._inner.takeoff_set(start.ravel(), end.ravel(), threads)
        return TakeoffSet(least.reshape(shape), greatest.reshape(shape), limit.reshape(shape))

    def hop(self, from_x_m: float, to_x_m: float) -> dict[str, Any]:
        """One hop, limit by limit, with the keys of ``chta hop --format json``."""
        answer: dict[str, Any] = json.loads(self._inner.hop(float(from_x_m), float(to_x_m)))
        return answer

    def plan(
        self,
        start_x_m: float | None = None,
        goal_x_m: float | None = None,
        *,
        points_per_segment: int | str | None = None,
        node_spacing_max_m: float | None = None,
        effort: str | None = None,
        takeoff_angle: str | None = None,
        prove: bool = False,
        prove_cells_max: int = 0,
        verify: bool = False,
        search: Mapping[str, Any] | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Plan:
        """The path of fewest hops between two positions; without them, from one end of the chain to the other. ``search`` takes any other
        key of ``[search]``.

        >>> import numpy as np, chta
        >>> flat = chta.Chain.from_arrays(
        ...     np.arange(0, 41, 4), np.zeros(11), body="moon", hopper=chta.Hopper(4, 4), surface=chta.Surface(0.6))
        >>> flat.plan(0, 40).hop_count
        5
        """
        keys: dict[str, Any] = dict(search or {})
        named = {
            "points_per_segment": points_per_segment,
            "node_spacing_max_m": node_spacing_max_m,
            "effort": effort,
            "takeoff_angle": takeoff_angle,
        }
        keys.update({name: value for name, value in named.items() if value is not None})
        cells = prove_cells_max if prove else None
        machine = tables(*self._machine, keys)
        return Plan(self._inner.plan(machine, start_x_m, goal_x_m, cells, verify, threads, progress))


class Dem:
    """An elevation raster: north up, elevations at the centres of the pixels, map in metres."""

    def __init__(self, inner: _chta.Dem) -> None:
        self._inner = inner

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Dem:
        """Reads a raster: GeoTIFF, ESRI ASCII grid, PDS3 image.

        >>> import chta
        >>> chta.Dem.open("data/terrain/lunar_rille.tif").shape
        (257, 257)
        """
        return cls(_chta.Dem.open(os.fspath(path)))

    @classmethod
    def from_array(
        cls, z_m: ArrayLike, transform: Sequence[float], *, crs: Any = None, nodata: float | None = None
    ) -> Dem:
        """From an array ``(rows, columns)`` and the transform of rasterio: ``(dx, 0, left, 0, -dy, top)``.

        Masked posts, NaN and ``nodata`` have no elevation. 32-bit arrays are kept as such. ``crs`` is a code, a PROJ string, well-known
        text, or an object of pyproj or rasterio; with the extra ``crs`` it is whatever pyproj knows, if it is a map in metres. Without one
        the map is a local one, and distances are taken as true.

        >>> import numpy as np, chta
        >>> south = chta.Dem.from_array(np.zeros((9, 9)), (20, 0, 0, 0, -20, 180), crs="IAU_2015:30135")
        >>> "1737400" in south.crs_wkt
        True
        """
        given = np.asanyarray(z_m)
        if given.ndim != 2:
            raise InputError(f"z_m has {given.ndim} dimensions, expected two: rows and columns")
        single = given.dtype == np.float32
        array: NDArray[Any] = np.array(given, np.float32 if single else np.float64, subok=False)
        if nodata is not None:
            array[array == array.dtype.type(nodata)] = np.nan
        array[np.ma.getmaskarray(given)] = np.nan
        rows, cols = array.shape
        numbers = [float(value) for value in list(transform)[:6]]
        if len(numbers) != 6:
            raise InputError(f"transform has {len(numbers)} numbers, expected six")
        make = _chta.Dem.of_single if single else _chta.Dem.of_double
        return cls(make(rows, cols, np.ravel(array), numbers, None if crs is None else stated(crs)))

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self._inner.shape

    @property
    def transform(self) -> Transform:
        """The affine transform of the pixels, as rasterio has it."""
        return cast(Transform, tuple(self._inner.transform))

    @property
    def crs_wkt(self) -> str | None:
        """The reference system as well-known text, if it is known."""
        return self._inner.crs_wkt

    @property
    def z_m(self) -> NDArray[np.float64]:
        """The elevations, NaN without one."""
        return self._inner.elevations().reshape(self.shape)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.asarray(self.z_m, dtype)

    def to_xarray(self) -> xarray.DataArray:
        """The elevations with the centres of the pixels as coordinates (extra ``xarray``)."""
        return Grid({"z_m": self.z_m}, self.transform, self.crs_wkt, []).to_xarray()["z_m"]

    def hop_map(
        self,
        starts_m: XY | Iterable[XY],
        *,
        hopper: HopperLike,
        surface: SurfaceLike,
        body: BodyLike,
        direction: str = "out",
        stride: int = 1,
        effort: str | None = None,
        hops_max: int | None = None,
        accept_map_scale: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Grid:
        """The fewest hops from the nearest start to every node (``direction="out"``), or back to it (``"back"``): the array ``hops``, and
        ``effort`` if one is named.

        >>> import numpy as np, chta
        >>> flat = chta.Dem.from_array(np.zeros((9, 9)), (1, 0, 0, 0, -1, 9))
        >>> grid = flat.hop_map((0.5, 0.5), body="moon", hopper=chta.Hopper(3, 3), surface=chta.Surface(0.6))
        >>> int(grid.hops.max())
        3
        """
        if direction not in ("out", "back"):
            raise InputError(f"direction is {direction!r}, expected out or back")
        starts = np.asarray(starts_m if isinstance(starts_m, np.ndarray) else list(starts_m), np.float64).reshape(-1, 2)
        search = {} if effort is None else {"effort": effort}
        hops, least, shape, transform, warnings = self._inner.hop_map(
            [(float(x), float(y)) for x, y in starts],
            tables(hopper, surface, body, search),
            direction == "back",
            stride,
            effort is not None,
            hops_max,
            accept_map_scale,
            threads,
            progress,
        )
        arrays: dict[str, NDArray[Any]] = {"hops": hops.reshape(shape)}
        if least is not None:
            arrays["effort"] = least.reshape(shape)
        return Grid(arrays, cast(Transform, tuple(transform)), self.crs_wkt, warnings)

    def mobility(
        self,
        *,
        hopper: HopperLike,
        surface: SurfaceLike,
        body: BodyLike,
        stride: int = 1,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Grid:
        """How freely the hopper moves from every node by one hop: ``share`` of the nodes within ``v^2 / g`` that it reaches, and in how many of
        16 ``directions``."""
        share, ways, shape, transform, warnings = self._inner.mobility(tables(hopper, surface, body), stride, threads, progress)
        arrays = {"share": share.reshape(shape), "directions": ways.reshape(shape)}
        return Grid(arrays, cast(Transform, tuple(transform)), self.crs_wkt, warnings)


def hop_map(dem: Dem | ArrayLike, starts_m: XY | Iterable[XY], transform: Sequence[float] | None = None, **machine: Any) -> Grid:
    """`Dem.hop_map` of a raster or of an array with its transform."""
    return _dem(dem, transform).hop_map(starts_m, **machine)


def mobility(dem: Dem | ArrayLike, transform: Sequence[float] | None = None, **machine: Any) -> Grid:
    """`Dem.mobility` of a raster or of an array with its transform."""
    return _dem(dem, transform).mobility(**machine)


def stated(crs: Any) -> list[str]:
    """A reference system in the texts that state it, the first of which is tried first: as given, and as pyproj has it."""
    if isinstance(crs, str):
        texts = [crs]
    elif isinstance(crs, int):
        texts = [f"EPSG:{crs}"]
    elif hasattr(crs, "to_wkt"):
        texts = [str(crs.to_wkt())]
    else:
        texts = []
    try:
        import pyproj
    except ImportError:
        if not texts:
            raise InputError(f"crs is {crs!r}, expected a code, a PROJ string or well-known text without pyproj (extra crs)") from None
        return texts
    try:
        known = pyproj.CRS.from_user_input(crs)
    except pyproj.exceptions.CRSError as error:
        if not texts:
            raise InputError(f"crs is {crs!r}, expected what pyproj knows: {error}") from None
        return texts
    authority = known.to_authority()
    texts += [":".join(authority)] if authority else []
    return texts + [known.to_wkt("WKT2_2019"), known.to_wkt("WKT1_GDAL", pretty=False) or ""]


def _dem(dem: Dem | ArrayLike, transform: Sequence[float] | None) -> Dem:
    if isinstance(dem, Dem):
        return dem
    if transform is None:
        raise InputError("found an array without a transform, expected (dx, 0, left, 0, -dy, top)")
    return Dem.from_array(dem, transform)
