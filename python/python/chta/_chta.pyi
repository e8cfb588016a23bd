"""The compiled part of chta. Programs use the names of the package."""

import os
from collections.abc import Callable, Sequence
from typing import final

import numpy as np
from numpy.typing import NDArray

_F = NDArray[np.float64]
_Progress = Callable[[str, int, int | None], bool | None]

__all__ = ["LIMITS", "VERSION", "Chain", "Dem", "Draft", "Reply", "Rasters", "arena", "stance_of_contacts"]

LIMITS: list[str]
VERSION: str

@final
class Reply:
    @property
    def kind(self) -> str: ...
    @property
    def holds(self) -> bool: ...
    def json(self) -> bytes: ...
    def ground(self) -> _F: ...
    def picture(self, png: bool) -> bytes | None: ...

@final
class Rasters:
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def transform(self) -> tuple[float, float, float, float, float, float]: ...
    @property
    def crs_wkt(self) -> str | None: ...
    def hops(self) -> NDArray[np.int16]: ...
    def hops_back(self) -> NDArray[np.int16] | None: ...
    def effort(self) -> _F | None: ...
    def mobility(self) -> tuple[NDArray[np.float32], NDArray[np.float32]] | None: ...
    def amounts(self) -> list[tuple[str, _F]]: ...

@final
class Chain:
    def __new__(
        cls,
        x_m: _F,
        z_m: _F,
        machine: str,
        cross_slope_deg: _F | None = None,
        friction_coefficient: _F | None = None,
        keep_out: NDArray[np.bool_] | None = None,
    ) -> Chain: ...
    def takeoff_set(self, from_x_m: _F, to_x_m: _F, threads: int | None = None) -> tuple[_F, _F, NDArray[np.int8]]: ...
    def hop(self, from_x_m: float, to_x_m: float) -> str: ...
    def plan(
        self,
        machine: str,
        start_x_m: float | None = None,
        goal_x_m: float | None = None,
        prove_cells: int | None = None,
        verify: bool = False,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> Reply: ...

@final
class Dem:
    @staticmethod
    def open(path: str | os.PathLike[str]) -> Dem: ...
    @staticmethod
    def of_double(rows: int, cols: int, z_m: _F, transform: Sequence[float], crs: Sequence[str] | None = None) -> Dem: ...
    @staticmethod
    def of_single(
        rows: int, cols: int, z_m: NDArray[np.float32], transform: Sequence[float], crs: Sequence[str] | None = None
    ) -> Dem: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def transform(self) -> list[float]: ...
    @property
    def crs_wkt(self) -> str | None: ...
    def elevations(self) -> _F: ...
    def hop_map(
        self,
        starts_m: Sequence[tuple[float, float]],
        machine: str,
        back: bool = False,
        stride: int = 1,
        effort: bool = False,
        hops_max: int | None = None,
        accept_map_scale: bool = False,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> tuple[NDArray[np.int16], _F | None, tuple[int, int], list[float], list[str]]: ...
    def mobility(
        self, machine: str, stride: int = 1, threads: int | None = None, progress: _Progress | None = None
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], tuple[int, int], list[float], list[str]]: ...

@final
class Draft:
    @staticmethod
    def read(path: str | os.PathLike[str]) -> Draft: ...
    @staticmethod
    def of_toml(text: str, base: str | os.PathLike[str]) -> Draft: ...
    @staticmethod
    def of_tables(tables: str, base: str | os.PathLike[str]) -> Draft: ...
    def with_keys(self, settings: str) -> Draft: ...
    def validated(self) -> str: ...
    def plan(
        self,
        prove_cells: int | None = None,
        verify: bool = False,
        front: str | None = None,
        alternatives: bool = False,
        memory_max_bytes: int | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> Reply: ...
    def check(self, prove_cells: int | None = None, threads: int | None = None, progress: _Progress | None = None) -> Reply: ...
    def simulate(
        self,
        compare: bool = False,
        until_half_width: float | None = None,
        first_trial: int = 0,
        success_min: float | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> Reply: ...
    def tally(
        self, first_trial: int, trials: int, threads: int | None = None, progress: _Progress | None = None
    ) -> str | None: ...
    def merged(
        self,
        tallies: Sequence[str],
        success_min: float | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> Reply: ...
    def sharing(self) -> Draft: ...
    def checksums(self) -> list[str]: ...
    def run(self, threads: int | None = None, progress: _Progress | None = None) -> tuple[Reply, Reply | None]: ...
    def hop(self, from_m: Sequence[float] | None = None, to_m: Sequence[float] | None = None) -> Reply: ...
    def map(
        self,
        dem: str | os.PathLike[str] | None = None,
        starts_m: Sequence[tuple[float, float]] = ...,
        goals_m: Sequence[tuple[float, float]] = ...,
        stride: int = 1,
        auto_nodes: bool = False,
        effort: bool = False,
        returns: bool = False,
        mobility: bool = False,
        trials: bool = False,
        hops_max: int | None = None,
        amounts: Sequence[str] = ...,
        memory_max_bytes: int | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> tuple[Reply, Rasters | None]: ...
    def sites(
        self,
        dem: str | os.PathLike[str] | None = None,
        candidates_m: Sequence[tuple[float, float]] = ...,
        every: int = 1,
        targets_m: Sequence[tuple[float, float]] = ...,
        stride: int = 1,
        auto_nodes: bool = False,
        trials: bool = False,
        memory_max_bytes: int | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> Reply: ...
    def require(
        self,
        vary: str,
        from_value: float | None = None,
        to_value: float | None = None,
        resolution: float = 0.001,
        prove_cells: int | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> Reply: ...
    def trade(
        self, vary: Sequence[str], prove_cells: int | None = None, threads: int | None = None, progress: _Progress | None = None
    ) -> Reply: ...
    def trade_legs(
        self, robots: Sequence[str], cones: Sequence[str], threads: int | None = None, progress: _Progress | None = None
    ) -> Reply: ...
    def stance(
        self,
        at_m: Sequence[float],
        terrain: str | os.PathLike[str] | None = None,
        robot: str | os.PathLike[str] | None = None,
        heading_deg: float | None = None,
        height_m: float | None = None,
        up: str = "normal",
        headings: int = 72,
    ) -> Reply: ...
    def fan(
        self,
        from_m: tuple[float, float],
        length_m: float,
        dem: str | os.PathLike[str] | None = None,
        headings: int = 36,
        memory_max_bytes: int | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> Reply: ...
    @staticmethod
    def compare(
        scenarios: Sequence[Draft],
        prove_cells: int | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> Reply: ...

def stance_of_contacts(file: str | os.PathLike[str], headings: int = 72) -> Reply: ...
def arena(
    file: str | os.PathLike[str],
    planner: str = "any-angle",
    reading: str = "R1",
    may_jump: bool = True,
    compare: bool = False,
    seed: int | None = None,
    nodes: int | None = None,
    random: int | None = None,
    random_sizes_m: Sequence[float] = ...,
    settings: Sequence[str] = ...,
) -> Reply: ...
