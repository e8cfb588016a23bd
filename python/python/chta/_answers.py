"""Answers: their documents, and what is most often wanted of them."""

from __future__ import annotations

import html
import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _chta
from ._errors import InputError

if TYPE_CHECKING:
    import geopandas
    import matplotlib.axes
    import pandas
    import xarray


def _axes(ax: matplotlib.axes.Axes | None) -> matplotlib.axes.Axes:
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    axes: matplotlib.axes.Axes = plt.gca()
    return axes


class Answer:
    """An answer. It pickles: as its document, and its picture as SVG if that was drawn before."""

    def __init__(self, reply: _chta.Reply) -> None:
        self._reply: _chta.Reply | None = reply
        self._json = reply.json()
        self._kind, self._holds = reply.kind, reply.holds
        self._svg: bytes | None = None
        self._document: dict[str, Any] | None = None

    def json(self) -> bytes:
        """The document, with the bytes that the command writes with ``--format json``."""
        return self._json

    def document(self) -> dict[str, Any]:
        """The document as a dictionary; ``chta schema`` prints the schema of each kind."""
        if self._document is None:
            self._document = json.loads(self._json)
        return self._document

    @property
    def kind(self) -> str:
        """The kind of the document, such as ``plan``."""
        return self._kind

    @property
    def holds(self) -> bool:
        """Whether the answer is yes: what exit status 0 of the command says."""
        return self._holds

    @property
    def warnings(self) -> list[str]:
        """The warnings for the analyst."""
        return list(self.document()["warnings"])

    def svg(self) -> bytes | None:
        """The picture of this answer as SVG, as the command's ``--plot`` draws it; ``None`` where it has none."""
        if self._svg is None and self._reply is not None:
            self._svg = self._reply.picture(False)
        return self._svg

    def png(self) -> bytes | None:
        """The same as PNG; only where the answer was computed, not after it was unpickled."""
        return None if self._reply is None else self._reply.picture(True)

    def __getitem__(self, key: str) -> Any:
        return self.document()[key]

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_reply": None, "_document": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Answer) and self._json == other._json

    def __hash__(self) -> int:
        return hash(self._json)

    def __repr__(self) -> str:
        return f"<chta {self._kind}: {'yes' if self._holds else 'no'}>"

    def _repr_html_(self) -> str:
        rows = [("answer", "yes" if self._holds else "no"), *self._summary()]
        cells = "".join(f"<tr><th>{html.escape(k)}</th><td>{html.escape(str(v))}</td></tr>" for k, v in rows)
        said = "".join(f"<li>{html.escape(warning)}</li>" for warning in self.warnings)
        picture = self.svg()
        shown = f"<div>{picture.decode()}</div>" if picture is not None else ""
        return f"<table><caption>chta {html.escape(self._kind)}</caption>{cells}</table><ul>{said}</ul>{shown}"

    def _summary(self) -> list[tuple[str, Any]]:
        document = self.document()
        return [(key, document[key]) for key in ("verdict", "hops", "hops_lower_bound") if key in document]


class _WithPath(Answer):
    """An answer with hops."""

    def __init__(self, reply: _chta.Reply) -> None:
        super().__init__(reply)
        self._ground = reply.ground().reshape(-1, 2)

    @property
    def ground(self) -> NDArray[np.float64] | None:
        """The vertices of the ground along the path, ``(n, 2)``: distance and elevation, m. ``None`` where the path is of a mesh, of legs, of
        wheels or over several targets, and of trials."""
        return self._ground if len(self._ground) else None

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The hops, and legs of a drive, as the document has them."""
        return list(self.document().get("path") or [])

    @property
    def hops(self) -> pandas.DataFrame:
        """The same as a table (extra ``pandas``), with nested values flattened to ``outer.inner``."""
        import pandas as pd

        return pd.json_normalize(self.rows)

    @property
    def hop_count(self) -> int | None:
        """How many hops the path has, fewest over the nodes that were searched; ``None`` without a path."""
        count = self.document().get("hops")
        return None if count is None else int(count)

    @property
    def totals(self) -> dict[str, Any] | None:
        """Flight time, energy and the like of the whole path; ``None`` without a path."""
        totals: dict[str, Any] | None = self.document().get("totals")
        return totals

    def _map_points(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        rows = [row for row in self.rows if "takeoff_map_x_m" in row]
        return [
            ((r["takeoff_map_x_m"], r["takeoff_map_y_m"]), (r["landing_map_x_m"], r["landing_map_y_m"])) for r in rows
        ]

    def to_geodataframe(self) -> geopandas.GeoDataFrame:
        """The hops as lines on the map (extra ``geo``), in the reference system of the terrain if that is known."""
        import geopandas as gpd
        import shapely

        points = self._map_points()
        if not points:
            raise InputError("this path lies on no map")
        crs = self.document().get("crs")
        rows = [row for row in self.rows if "takeoff_map_x_m" in row]
        flat = [{key: value for key, value in row.items() if not isinstance(value, (dict, list))} for row in rows]
        lines = [shapely.LineString(ends) for ends in points]
        return gpd.GeoDataFrame(flat, geometry=lines, crs=crs["code"] or crs["proj"] if crs else None)

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draws the arcs of the hops over the distance along the path, and the `ground` where it is known (extra ``plot``)."""
        axes = _axes(ax)
        if self.ground is not None:
            distance, elevation = self.ground.T
            axes.plot(distance, elevation, color="#444444", linewidth=1, label="ground")
        # The distance of a row is that along the path, or along the part of the path to one of several targets.
        before, end, label = 0.0, 0.0, "hop"
        for row in self.rows:
            if "takeoff_speed_m_s" not in row:
                continue
            takeoff, landing = row["takeoff_x_m"], row["landing_x_m"]
            if self.ground is None and takeoff < end:
                before += end
            end = landing
            share = np.linspace(0.0, 1.0, 50)
            rise, run = row["landing_z_m"] - row["takeoff_z_m"], abs(landing - takeoff)
            climb = np.tan(np.radians(row["takeoff_angle_deg"])) * run
            height = row["takeoff_z_m"] + climb * share + (rise - climb) * share**2
            axes.plot(before + takeoff + (landing - takeoff) * share, height, color="#0072B2", label=label)
            label = "_nolegend_"
        if axes.get_legend_handles_labels()[0]:
            axes.legend()
        axes.set_xlabel("distance along the path (m)")
        axes.set_ylabel("elevation (m)")
        return axes


class Plan(_WithPath):
    """A path."""

    @property
    def traversable(self) -> bool:
        """Whether a path was found over the nodes that were searched, within the budgets of the scenario."""
        return self._holds


class Check(_WithPath):
    """Whether a path exists."""


class Hop(Answer):
    """One hop, limit by limit."""

    @property
    def feasible(self) -> bool:
        """Whether it keeps every limit."""
        return self._holds


class Simulation(_WithPath):
    """Trials of a path."""

    @property
    def success_rate(self) -> float | None:
        """The share of trials that reached the goal; ``None`` without a path, or of several policies."""
        rate = self.document().get("success_rate")
        return None if rate is None else float(rate)

    @property
    def success_rate_ci95(self) -> tuple[float, float] | None:
        """Its 95 % interval."""
        bounds = self.document().get("success_rate_ci95")
        return None if bounds is None else (float(bounds[0]), float(bounds[1]))


class Run:
    """Everything that a scenario asks for."""

    def __init__(self, plan: Plan, trials: Simulation | None) -> None:
        self.plan = plan
        self.trials = trials

    def json(self) -> bytes:
        """The document of the path, with the bytes of ``chta run --format json``."""
        return self.plan.json()

    def document(self) -> dict[str, Any]:
        """The same as a dictionary."""
        return self.plan.document()

    @property
    def holds(self) -> bool:
        """Whether there is a path."""
        return self.plan.holds

    def __repr__(self) -> str:
        return f"<chta run: {self.plan!r}, {self.trials!r}>"

    def _repr_html_(self) -> str:
        return self.plan._repr_html_() + (self.trials._repr_html_() if self.trials is not None else "")


class Require(_WithPath):
    """The least capability with which the goal can be reached."""

    @property
    def bounds(self) -> tuple[float | None, float | None]:
        """A value with which the goal is proved out of reach, and one with a path; ``None`` where there is no such value."""
        document = self.document()
        return document.get("unreachable_at"), document.get("reachable_at")


class Trade(Answer):
    """A verdict for every value of one or two keys."""

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One for each cell, as the document has them."""
        return list(self.document()["rows"])

    def to_frame(self) -> pandas.DataFrame:
        """The same as a table (extra ``pandas``)."""
        import pandas as pd

        return pd.json_normalize(self.rows)


class Stance(Answer):
    """Where a robot with legs stands, and which way it may jump from there."""

    @property
    def stands(self) -> bool:
        """Whether it can stand there: enough feet on the ground, no part inside it, and a cone of take-off directions."""
        return self._holds

    @property
    def rose(self) -> list[dict[str, Any]]:
        """For every heading the take-off angles that each kind of cone allows."""
        return list(self.document()["rose"])

    def to_frame(self) -> pandas.DataFrame:
        """The rose as a table (extra ``pandas``)."""
        import pandas as pd

        return pd.json_normalize(self.rose)


class Arena(Answer):
    """A path of a wheeled jumper among boxes."""

    @property
    def path_time_s(self) -> float | None:
        """The time of the path; ``None`` without one."""
        time = self.document()["path_time_s"]
        return None if time is None else float(time)

    @property
    def points(self) -> list[dict[str, Any]]:
        """The points of the path, and how each is reached."""
        return list(self.document()["path"])

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draws the boxes and the path, seen from above (extra ``plot``)."""
        axes = _axes(ax)
        for box in self.document()["scenario"]["box"]:
            centre, size = np.array(box["centre_m"]), np.array(box["size_m"])
            outline = centre + size / 2 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
            axes.fill(outline[:, 0], outline[:, 1], color="#bbbbbb")
        axes.plot([point["x_m"] for point in self.points], [point["y_m"] for point in self.points], color="#0072B2")
        axes.set_aspect("equal")
        axes.set_xlabel("x (m)")
        axes.set_ylabel("y (m)")
        return axes


class Fan(Answer):
    """How far in how few hops in all directions from one point."""

    @property
    def rays(self) -> list[dict[str, Any]]:
        """One for each heading, as the document has them."""
        return list(self.document()["rays"])

    def to_frame(self) -> pandas.DataFrame:
        """One row for each heading, without its bands (extra ``pandas``)."""
        import pandas as pd

        rows = [{key: value for key, value in ray.items() if not isinstance(value, list)} for ray in self.rays]
        table: pandas.DataFrame = pd.DataFrame(rows)
        return table


class Comparison(Answer):
    """Several scenarios side by side."""

    @property
    def rows(self) -> list[dict[str, Any]]:
        """One for each scenario, as the document has them."""
        return list(self.document()["compared"])

    def to_frame(self) -> pandas.DataFrame:
        """The same as a table (extra ``pandas``)."""
        import pandas as pd

        return pd.json_normalize(self.rows)


LABELLED = 10
"""The landing sites whose ranks a picture shows."""


class Sites(Answer):
    """Landing sites ranked."""

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The candidates, the best first."""
        return list(self.document()["sites"])

    def to_frame(self) -> pandas.DataFrame:
        """The same as a table (extra ``pandas``)."""
        import pandas as pd

        table: pandas.DataFrame = pd.DataFrame(self.rows)
        return table

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draws the candidates on the map, by the share of the nodes that each reaches, the best with their ranks (extra ``plot``)."""
        from matplotlib.patheffects import withStroke

        axes = _axes(ax)
        rows = self.rows
        shown = axes.scatter(
            [row["x_m"] for row in rows],
            [row["y_m"] for row in rows],
            c=[row["reachable_share"] for row in rows],
            vmin=0,
            vmax=1,
            edgecolors="black",
            linewidths=0.5,
            zorder=3,
            clip_on=False,
        )
        for rank, row in enumerate(rows[:LABELLED], start=1):
            label = axes.annotate(str(rank), (row["x_m"], row["y_m"]), xytext=(5, 4), textcoords="offset points", zorder=4)
            label.set_path_effects([withStroke(linewidth=2, foreground="white")])
        axes.figure.colorbar(shown, ax=axes, label="share of the nodes reached")
        axes.set_aspect("equal")
        axes.set_xlabel("x (m)")
        axes.set_ylabel("y (m)")
        return axes


UNREACHED = -1
"""The hops to a node that is not reached."""
NOT_SEARCHED = -2
"""The hops to a node that may need more hops than were searched."""
NO_GROUND = -32768
"""The hops to a node without an elevation."""

Transform = tuple[float, float, float, float, float, float]


class Grid:
    """Arrays over a map: ``(rows, columns)``, the first row in the north."""

    def __init__(
        self, arrays: dict[str, NDArray[Any]], transform: Transform, crs_wkt: str | None, warnings: list[str]
    ) -> None:
        self.arrays = arrays
        self.transform = transform
        self.crs_wkt = crs_wkt
        self.warnings = warnings

    def __getattr__(self, name: str) -> NDArray[Any]:
        arrays = self.__dict__.get("arrays", {})
        if name in arrays:
            found: NDArray[Any] = arrays[name]
            return found
        raise AttributeError(f"found no array {name}, expected one of {', '.join(arrays) or 'none'}")

    def to_xarray(self) -> xarray.Dataset:
        """A dataset with the centres of the pixels as coordinates (extra ``xarray``)."""
        import xarray as xr

        rows, cols = next(iter(self.arrays.values())).shape
        dx, _, left, _, down, top = self.transform
        coords = {"y": top + down * (np.arange(rows) + 0.5), "x": left + dx * (np.arange(cols) + 0.5)}
        attrs = {"crs_wkt": self.crs_wkt} if self.crs_wkt else {}
        return xr.Dataset({name: (("y", "x"), array) for name, array in self.arrays.items()}, coords, attrs)

    def plot(self, ax: matplotlib.axes.Axes | None = None, array: str = "hops") -> matplotlib.axes.Axes:
        """Draws one array; what is not reached stays empty (extra ``plot``)."""
        axes = _axes(ax)
        values = np.asarray(self.arrays[array], float)
        dx, _, left, _, down, top = self.transform
        rows, cols = values.shape
        drawn = axes.imshow(np.where(values < 0, np.nan, values), extent=(left, left + dx * cols, top + down * rows, top))
        axes.figure.colorbar(drawn, ax=axes, label=array.replace("_", " "))
        axes.set_xlabel("x (m)")
        axes.set_ylabel("y (m)")
        return axes


class Map(Answer):
    """Hops over a whole terrain."""

    def __init__(self, reply: _chta.Reply, rasters: _chta.Rasters | None) -> None:
        super().__init__(reply)
        self.grid: Grid | None = None
        """The arrays, of a hopper over a DEM: ``hops``, and what else was asked for."""
        if rasters is not None:
            shape: Callable[[NDArray[Any]], NDArray[Any]] = lambda array: array.reshape(rasters.shape)
            arrays: dict[str, NDArray[Any]] = {"hops": shape(rasters.hops())}
            for name, array in (("hops_back", rasters.hops_back()), ("effort", rasters.effort())):
                if array is not None:
                    arrays[name] = shape(array)
            mobility = rasters.mobility()
            if mobility is not None:
                arrays["mobility"], arrays["directions"] = shape(mobility[0]), shape(mobility[1])
            for name, totals in rasters.amounts():
                arrays[name.replace("-", "_")] = shape(totals)
            self.grid = Grid(arrays, rasters.transform, rasters.crs_wkt, self.warnings)

    @property
    def hops(self) -> NDArray[np.int16]:
        """The fewest hops to every node: `UNREACHED`, `NOT_SEARCHED` and `NO_GROUND` are negative."""
        if self.grid is None:
            raise InputError("this map has no raster of hops: it is of a mesh, of legs or of wheels; document() has its counts")
        return self.grid.arrays["hops"]

    def plot(self, ax: matplotlib.axes.Axes | None = None, array: str = "hops") -> matplotlib.axes.Axes:
        """Draws one array of the grid (extra ``plot``)."""
        if self.grid is None:
            raise InputError("this map has no raster to draw")
        return self.grid.plot(ax, array)
