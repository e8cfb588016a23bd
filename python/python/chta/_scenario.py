"""Scenarios and their questions."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Optional, Union

from . import _chta
from ._answers import Arena, Check, Comparison, Fan, Hop, Map, Plan, Require, Run, Simulation, Sites, Stance, Trade
from ._errors import InputError

Progress = Callable[[str, int, Optional[int]], Optional[bool]]
"""Called some twenty times a second with the stage, how much is done and of how much; ``False`` ends the work."""

Source = Union[str, "os.PathLike[str]", Mapping[str, Any], "Scenario"]
"""A scenario: a file, its tables, or one that is open."""

XY = tuple[float, float]


def _settings(keys: Mapping[str, Any]) -> str:
    def plain(value: Any) -> Any:
        if hasattr(value, "tolist"):
            return value.tolist()
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        raise TypeError(f"a key cannot be set to {value!r}")

    return json.dumps([[key, value] for key, value in keys.items()], default=plain)


class Scenario:
    """A scenario. Each question opens its terrain anew, and gives the answer that the command gives.

    >>> import chta
    >>> plan = chta.Scenario.open("data/scenarios/simple.toml").plan()
    >>> plan.traversable, plan.hop_count
    (True, 1)
    """

    def __init__(self, draft: _chta.Draft, source: tuple[str, str, str], keys: dict[str, Any]) -> None:
        self._draft, self._source, self._keys = draft, source, keys

    @classmethod
    def open(
        cls,
        source: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        *,
        text: str | None = None,
        base: str | os.PathLike[str] = "",
        set: Mapping[str, Any] | None = None,
    ) -> Scenario:
        """Opens a scenario file (TOML), a result (JSON), tables, or a ``text`` in TOML.

        Paths in tables and texts start from the folder ``base``, those in files from the folder of the file. ``set`` replaces
        single keys, as ``{"hopper.takeoff_speed_max_m_s": 8}``.

        >>> import chta
        >>> chta.Scenario.open("data/scenarios/simple.toml", set={"hopper.clearence_m": 1})
        Traceback (most recent call last):
        ...
        chta._errors.ScenarioError: set: unknown key hopper.clearence_m; the nearest known key is hopper.clearance_m
        """
        if (source is None) == (text is None):
            raise InputError("found no scenario or two, expected a source or a text")
        if text is not None:
            kept = ("text", text, os.fspath(base))
        elif isinstance(source, Mapping):
            kept = ("tables", json.dumps(source), os.fspath(base))
        else:
            assert source is not None
            kept = ("file", os.fspath(source), "")
        return cls._of(kept, dict(set or {}))

    @classmethod
    def _of(cls, source: tuple[str, str, str], keys: dict[str, Any]) -> Scenario:
        kind, given, base = source
        if kind == "file":
            draft = _chta.Draft.read(given)
        elif kind == "text":
            draft = _chta.Draft.of_toml(given, base)
        else:
            draft = _chta.Draft.of_tables(given, base)
        if keys:
            draft = draft.with_keys(_settings(keys))
        # All problems of the keys are reported here, not at the first question.
        draft.validated()
        return cls(draft, source, keys)

    def with_keys(self, keys: Mapping[str, Any]) -> Scenario:
        """The same scenario with more keys set."""
        return self._of(self._source, {**self._keys, **keys})

    def tables(self) -> dict[str, Any]:
        """The scenario as used, with all defaults, in the form of results."""
        tables: dict[str, Any] = json.loads(self._draft.validated())
        return tables

    def __reduce__(self) -> tuple[Any, ...]:
        return Scenario._of, (self._source, self._keys)

    def __repr__(self) -> str:
        kind, given, _ = self._source
        return f"<chta scenario {given if kind == 'file' else 'of a ' + kind}>"

    def plan(
        self,
        *,
        prove: bool = False,
        prove_cells_max: int = 0,
        verify: bool = False,
        front: str | None = None,
        alternatives: bool = False,
        memory_max_mib: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Plan:
        """Plans the path of fewest hops, or by the objective of the scenario: along a chain, over a DEM in any direction, over a
        mesh, with legs, with wheels, over several targets."""
        cells = prove_cells_max if prove else None
        bytes_max = None if memory_max_mib is None else memory_max_mib << 20
        return Plan(self._draft.plan(cells, verify, front, alternatives, bytes_max, threads, progress))

    def check(
        self, *, prove: bool = False, prove_cells_max: int = 0, threads: int | None = None, progress: Progress | None = None
    ) -> Check:
        """Whether a path exists, and in how few hops."""
        return Check(self._draft.check(prove_cells_max if prove else None, threads, progress))

    def simulate(
        self,
        *,
        trials: int | None = None,
        seed: int | None = None,
        policy: str | None = None,
        compare: bool = False,
        until_half_width: float | None = None,
        first_trial: int = 0,
        success_min: float | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Simulation:
        """Flies the path many times under the errors of the scenario: the path of a result as it stands, else a new one."""
        keys = {"trials": trials, "seed": seed, "policy": policy}
        given = {f"uncertainty.{key}": value for key, value in keys.items() if value is not None}
        draft = self._draft.with_keys(_settings(given)) if given else self._draft
        return Simulation(draft.simulate(compare, until_half_width, first_trial, success_min, threads, progress))

    def tally(
        self, first_trial: int, trials: int, *, threads: int | None = None, progress: Progress | None = None
    ) -> str | None:
        """Flies the trials of a range of numbers: their tally (JSON), which `merged` takes; ``None`` without a path to fly."""
        return self._draft.tally(first_trial, trials, threads, progress)

    def merged(
        self,
        tallies: Iterable[str],
        *,
        trials: int | None = None,
        seed: int | None = None,
        policy: str | None = None,
        success_min: float | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Simulation:
        """The answer of trials that were flown in parts by `tally`, with the bytes of `simulate` at once.

        >>> import chta
        >>> quick = {"uncertainty.trials": 60, "uncertainty.policy": "open-loop", "search.risk": "ignored"}
        >>> scenario = chta.Scenario.open("data/scenarios/rolling_surely.toml", set=quick)
        >>> parts = [scenario.tally(first, 20) for first in (40, 0, 20)]
        >>> scenario.merged(parts).json() == scenario.simulate().json()
        True
        """
        keys = {"trials": trials, "seed": seed, "policy": policy}
        given = {f"uncertainty.{key}": value for key, value in keys.items() if value is not None}
        draft = self._draft.with_keys(_settings(given)) if given else self._draft
        return Simulation(draft.merged(list(tallies), success_min, threads, progress))

    def _varied(self, keys: Mapping[str, Any]) -> Scenario:
        """As `with_keys`, without reading the file again: for one of many cases. Keys of this scenario's own need the whole way."""
        if not keys or any(key in self._keys for key in keys):
            return self.with_keys(keys)
        draft = self._draft.with_keys(_settings(keys))
        draft.validated()
        return Scenario(draft, self._source, {**self._keys, **keys})

    def _sharing(self) -> Scenario:
        """The same, whose variants read their terrain together."""
        return Scenario(self._draft.sharing(), self._source, self._keys)

    def run(self, *, threads: int | None = None, progress: Progress | None = None) -> Run:
        """Everything that the scenario asks for: its path, flown again by a check of its own, and trials where it has errors."""
        plan, trials = self._draft.run(threads, progress)
        return Run(Plan(plan), None if trials is None else Simulation(trials))

    def hop(self, from_m: float | Sequence[float] | None = None, to_m: float | Sequence[float] | None = None) -> Hop:
        """One hop, limit by limit: between positions along a chain (one number), on a map (two) or over a mesh (three).

        >>> import chta
        >>> chta.Scenario.open("data/scenarios/paper_76m.toml").hop(0, 20).feasible
        True
        """

        def numbers(at: float | Sequence[float] | None) -> list[float] | None:
            if at is None:
                return None
            return [float(at)] if isinstance(at, (int, float)) else [float(value) for value in at]

        return Hop(self._draft.hop(numbers(from_m), numbers(to_m)))

    def map(
        self,
        *,
        dem: str | os.PathLike[str] | None = None,
        starts_m: Iterable[XY] = (),
        goals_m: Iterable[XY] = (),
        stride: int = 1,
        node_spacing: str | float | None = None,
        effort: bool | str = False,
        back: bool = False,
        mobility: bool = False,
        trials: bool = False,
        hops_max: int | None = None,
        amounts: Sequence[str] = (),
        memory_max_mib: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Map:
        """The fewest hops from one or several starts to everywhere; without starts, from the scenario's."""
        keys: dict[str, Any] = {"search.effort": effort} if isinstance(effort, str) else {}
        if node_spacing is not None and node_spacing != "auto":
            keys["search.node_spacing_max_m"] = node_spacing
        draft = self._draft.with_keys(_settings(keys)) if keys else self._draft
        reply, rasters = draft.map(
            None if dem is None else os.fspath(dem),
            list(starts_m),
            list(goals_m),
            stride,
            node_spacing == "auto",
            bool(effort),
            back,
            mobility,
            trials,
            hops_max,
            list(amounts),
            None if memory_max_mib is None else memory_max_mib << 20,
            threads,
            progress,
        )
        return Map(reply, rasters)

    def sites(
        self,
        *,
        dem: str | os.PathLike[str] | None = None,
        candidates_m: Iterable[XY] = (),
        every: int = 1,
        targets_m: Iterable[XY] = (),
        stride: int = 1,
        node_spacing: str | float | None = None,
        trials: int | None = None,
        memory_max_mib: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Sites:
        """Landing sites ranked by what is reached from each; with trials, also the share of them that arrives at each target."""
        draft = self._draft if trials is None else self._draft.with_keys(_settings({"uncertainty.trials": trials}))
        if node_spacing is not None and node_spacing != "auto":
            draft = draft.with_keys(_settings({"search.node_spacing_max_m": node_spacing}))
        bytes_max = None if memory_max_mib is None else memory_max_mib << 20
        place = None if dem is None else os.fspath(dem)
        found = draft.sites(
            place,
            list(candidates_m),
            every,
            list(targets_m),
            stride,
            node_spacing == "auto",
            trials is not None,
            bytes_max,
            threads,
            progress,
        )
        return Sites(found)

    def require(
        self,
        vary: str,
        *,
        from_value: float | None = None,
        to_value: float | None = None,
        resolution: float = 0.001,
        prove_cells_max: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Require:
        """The least value of a key with which the goal can be reached, between one proved insufficient and one with a path.

        >>> import chta
        >>> found = chta.Scenario.open("data/scenarios/simple_reduced.toml").require("hopper.takeoff_speed_max_m_s")
        >>> [round(value, 2) for value in found.bounds]
        [4.82, 4.83]
        """
        return Require(self._draft.require(vary, from_value, to_value, resolution, prove_cells_max, threads, progress))

    def trade(
        self,
        vary: Mapping[str, tuple[float, float, int] | Sequence[str]],
        *,
        prove: bool = False,
        prove_cells_max: int = 0,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Trade:
        """The fewest hops, or no path, for every value of one or two keys: ``{"hopper.takeoff_speed_max_m_s": (2, 6, 9)}`` is nine
        values from 2 to 6.

        Of a robot with legs robots and kinds of cones are compared: ``{"robot.cone": ["kc", "exact"], "robot.file": [...]}``."""
        if any(key in ("robot.cone", "robot.file") for key in vary):
            others = [key for key in vary if key not in ("robot.cone", "robot.file")]
            if others or prove:
                found = others[0] if others else "a proof"
                raise InputError(f"found {found} beside robots and cones, expected robot.cone and robot.file alone")
            robots, cones = ([str(one) for one in vary.get(key, ())] for key in ("robot.file", "robot.cone"))
            return Trade(self._draft.trade_legs(robots, cones, threads, progress))
        swept = [f"{key}={start!r}:{stop!r}:{steps}" for key, (start, stop, steps) in vary.items()]
        return Trade(self._draft.trade(swept, prove_cells_max if prove else None, threads, progress))

    def stance(
        self,
        at_m: Sequence[float],
        *,
        terrain: str | os.PathLike[str] | None = None,
        robot: str | os.PathLike[str] | None = None,
        heading_deg: float | None = None,
        height_m: float | None = None,
        up: str = "normal",
        headings: int = 72,
    ) -> Stance:
        """Where a robot with legs stands at a place, and which way it may jump from there: on the terrain and with the robot of the
        scenario, or on others.

        >>> import chta
        >>> legs = chta.Scenario.open("data/mesh_scenarios/three_legs.toml")
        >>> stood = legs.stance((0, 0, 1), heading_deg=30, height_m=0.3)
        >>> stood.kind, len(stood["rose"])
        ('stance', 72)
        """
        place, file = (None if path is None else os.fspath(path) for path in (terrain, robot))
        return Stance(self._draft.stance([float(value) for value in at_m], place, file, heading_deg, height_m, up, headings))

    def fan(
        self,
        from_m: XY,
        length_m: float,
        *,
        dem: str | os.PathLike[str] | None = None,
        headings: int = 36,
        memory_max_mib: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Fan:
        """How far in how few hops in all directions from a point of the scenario's DEM, or of another one."""
        bytes_max = None if memory_max_mib is None else memory_max_mib << 20
        place = None if dem is None else os.fspath(dem)
        x, y = from_m
        return Fan(self._draft.fan((float(x), float(y)), float(length_m), place, headings, bytes_max, threads, progress))


def compare(
    scenarios: Iterable[Source],
    *,
    set: Mapping[str, Any] | None = None,
    prove: bool = False,
    prove_cells_max: int = 0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Comparison:
    """Plans for every scenario and shows the answers side by side; ``set`` replaces keys of all of them.

    >>> import chta
    >>> both = chta.compare(["data/scenarios/simple.toml", "data/scenarios/simple_reduced.toml"])
    >>> [row["hops"] for row in both.rows]
    [1, 5]
    """
    drafts = [scenario_of(source, set)._draft for source in scenarios]
    return Comparison(_chta.Draft.compare(drafts, prove_cells_max if prove else None, threads, progress))


def stance_of_contacts(file: str | os.PathLike[str], *, headings: int = 72) -> Stance:
    """The cone of take-off directions that contacts without a robot allow: a table ``normal_x,normal_y,normal_z,friction_coefficient``."""
    return Stance(_chta.stance_of_contacts(os.fspath(file), headings))


def arena(
    file: str | os.PathLike[str],
    *,
    planner: str = "any-angle",
    reading: str = "R1",
    may_jump: bool = True,
    compare: bool = False,
    seed: int | None = None,
    nodes: int | None = None,
    random: int | None = None,
    random_sizes_m: Sequence[float] = (),
    set: Mapping[str, Any] | None = None,
) -> Arena:
    """Plans for a wheeled robot that jumps, on a flat floor with boxes.

    >>> import chta
    >>> round(chta.arena("data/arenas/sumo_1.toml", planner="grid").path_time_s, 4)
    11.9092
    """
    settings = [f"{key}={json.dumps(value)}" for key, value in (set or {}).items()]
    answer = _chta.arena(os.fspath(file), planner, reading, may_jump, compare, seed, nodes, random, list(random_sizes_m), settings)
    return Arena(answer)


def scenario_of(source: Source, keys: Mapping[str, Any] | None = None) -> Scenario:
    """A scenario from whatever names one."""
    if isinstance(source, Scenario):
        return source.with_keys(keys) if keys else source
    return Scenario.open(source, set=keys)


def run(
    scenario: Source, *, set: Mapping[str, Any] | None = None, threads: int | None = None, progress: Progress | None = None
) -> Run:
    """Everything that a scenario asks for.

    >>> import chta
    >>> chta.run("data/scenarios/simple.toml", set={"hopper.clearance_m": 0.1}).plan.hop_count
    1
    """
    return scenario_of(scenario, set).run(threads=threads, progress=progress)
