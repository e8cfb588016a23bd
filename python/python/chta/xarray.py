"""Elevations of xarray: ``import chta.xarray`` registers the accessor ``da.chta``.

>>> import numpy as np, xarray, chta, chta.xarray
>>> da = xarray.DataArray(np.zeros((9, 9)), {"y": 8.5 - np.arange(9), "x": 0.5 + np.arange(9)}, ("y", "x"))
>>> machine = {"hopper": chta.Hopper(3, 3), "surface": chta.Surface(0.6), "body": "moon"}
>>> int(da.chta.hop_map((0.5, 0.5), **machine)["hops"].max())
3
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ._answers import Transform
from ._arrays import Dem
from ._errors import InputError, TooLarge
from ._machine import BodyLike, HopperLike, SurfaceLike
from ._scenario import XY

STEP_TOLERANCE = 1e-6
"""How far the spacing of coordinates may differ, as a share of it."""


class ChtaAccessor:
    """Hops over a DataArray of elevations with evenly spaced coordinates ``y`` and ``x``, m: the centres of the pixels."""

    def __init__(self, array: xr.DataArray) -> None:
        self._array = array

    @property
    def _named(self) -> tuple[str, str]:
        if self._array.ndim != 2:
            raise InputError(f"the array has {self._array.ndim} dimensions, expected two: y and x (select a band with .squeeze())")
        y, x = (str(name) for name in self._array.dims)
        for name in (y, x):
            if name not in self._array.coords:
                raise InputError(f"found no coordinate {name}, expected the centres of the pixels, m")
        return y, x

    @property
    def transform(self) -> Transform:
        """The affine transform of the pixels, as rasterio has it."""
        y, x = self._named
        down, dx = _step(self._array[y], y), _step(self._array[x], x)
        if dx <= 0:
            raise InputError(f"the coordinate {x} falls, expected one that rises: sort it with .sortby({x!r})")
        top = float(self._array[y][0]) if down < 0 else float(self._array[y][-1])
        dy = abs(down)
        return dx, 0.0, float(self._array[x][0]) - dx / 2, 0.0, -dy, top + dy / 2

    @property
    def crs(self) -> Any:
        """The reference system, as rioxarray or the attributes state it; ``None`` if none is known."""
        reference = self._array.coords.get("spatial_ref")
        stated = [self._array.attrs, reference.attrs if reference is not None else {}]
        for key in ("crs_wkt", "spatial_ref", "crs"):
            for attributes in stated:
                if attributes.get(key):
                    return attributes[key]
        return None

    def to_dem(self) -> Dem:
        """The elevations as `chta.Dem`, the first row in the north."""
        y, _ = self._named
        if self._array.chunks is not None:
            need = self._array.size * self._array.dtype.itemsize
            raise TooLarge(f"the array is lazy, and would take {need} bytes in memory: load it with .load(), or take a part of it")
        values = self._array.values
        if _step(self._array[y], y) > 0:
            values = values[::-1]
        return Dem.from_array(values, self.transform, crs=self.crs, nodata=self._array.attrs.get("_FillValue"))

    def hop_map(self, starts_m: XY | Iterable[XY], **asked: Any) -> xr.Dataset:
        """`chta.Dem.hop_map`, with the coordinates and the reference system of the array. The hops to a place depend on the whole map, so
        that a lazy array raises `chta.TooLarge`."""
        return self._as_given(self.to_dem().hop_map(starts_m, **asked).to_xarray())

    def mobility(
        self, *, hopper: HopperLike, surface: SurfaceLike, body: BodyLike, threads: int | None = None, reach_m: float | None = None
    ) -> xr.Dataset:
        """`chta.Dem.mobility`. A lazy array gives a lazy answer, block by block with the posts within reach around it: ``reach_m``, or
        ``v^2 / g`` of the machine, is how far one hop may go."""
        machine: dict[str, Any] = {"hopper": hopper, "surface": surface, "body": body}
        if self._array.chunks is None:
            return self._as_given(self.to_dem().mobility(**machine, threads=threads).to_xarray())
        dx, _, _, _, down, _ = self.transform
        y, _ = self._named
        flips = _step(self._array[y], y) > 0
        nodata = self._array.attrs.get("_FillValue")
        reach = _reach_m(hopper, body) if reach_m is None else reach_m
        depth = {0: math.ceil(reach / -down) + 2, 1: math.ceil(reach / dx) + 2}
        crs = self.crs

        def of_block(z_m: NDArray[Any]) -> NDArray[np.float32]:
            rows, _ = z_m.shape
            block = z_m[::-1] if flips else z_m
            dem = Dem.from_array(block, (dx, 0.0, 0.0, 0.0, down, -down * rows), crs=crs, nodata=nodata)
            found = dem.mobility(**machine, threads=threads)
            both = np.stack([found.arrays["share"], np.asarray(found.arrays["directions"], np.float32)])
            return np.ascontiguousarray(both[:, ::-1] if flips else both)

        import dask.array as lazy

        padded = lazy.overlap.overlap(self._array.data, depth=depth, boundary="none")
        answered = padded.map_blocks(of_block, dtype=np.float32, new_axis=0, chunks=((2,), *padded.chunks), meta=np.empty((0, 0, 0), np.float32))
        trimmed = lazy.overlap.trim_internal(answered, {0: 0, 1: depth[0], 2: depth[1]}, boundary="none")
        arrays = {name: (self._array.dims, trimmed[i]) for i, name in enumerate(("share", "directions"))}
        return xr.Dataset(arrays, self._array.coords, {"crs_wkt": crs} if isinstance(crs, str) else {})

    def _as_given(self, answer: xr.Dataset) -> xr.Dataset:
        """With the names and coordinates of the array, where the nodes are its posts."""
        y, x = self._named
        named = answer if (y, x) == ("y", "x") else answer.rename({"y": y, "x": x})
        if _step(self._array[y], y) > 0:
            named = named.isel({y: slice(None, None, -1)})
        if named.sizes == dict(zip((y, x), self._array.shape)):
            named = named.assign_coords({name: coordinate for name, coordinate in self._array.coords.items()})
        return cast(xr.Dataset, named)


# xarray states no types for its registration.
cast(Any, xr).register_dataarray_accessor("chta")(ChtaAccessor)


def _step(coordinate: xr.DataArray, name: str) -> float:
    values = np.asarray(coordinate.values, np.float64)
    if values.ndim != 1 or values.size < 2:
        raise InputError(f"the coordinate {name} has {values.size} values, expected at least two")
    steps = np.diff(values)
    step = float((values[-1] - values[0]) / (values.size - 1))
    if step == 0 or np.abs(steps - step).max() > STEP_TOLERANCE * abs(step):
        raise InputError(f"the coordinate {name} is not evenly spaced, expected the centres of the pixels of a raster in metres")
    return step


def _reach_m(hopper: HopperLike, body: BodyLike) -> float:
    """The radius of the disc that a mobility is counted in, and of the footprint around its border."""
    from ._scenario import Scenario

    given = hopper if isinstance(hopper, dict) else {k: v for k, v in vars(hopper).items() if v is not None}
    of_body = {"name": body} if isinstance(body, str) else (body if isinstance(body, dict) else {k: v for k, v in vars(body).items() if v is not None})
    known = Scenario.open({"hopper": dict(given), "body": dict(of_body)}).tables()
    speed = min(known["hopper"]["takeoff_speed_max_m_s"], known["hopper"]["landing_speed_max_m_s"])
    return float(speed**2 / known["body"]["gravity_m_s2"] + (known["hopper"].get("footprint_m") or 0.0))
