"""A machine, its surface and its body, as the tables of a scenario have them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, Union


def _keys(value: Any) -> dict[str, Any]:
    """The fields that were given."""
    return {field.name: getattr(value, field.name) for field in fields(value) if getattr(value, field.name) is not None}


@dataclass(frozen=True)
class Body:
    """A body: a known one by its name, or one of this gravity."""

    name: str | None = None
    gravity_m_s2: float | None = None
    radius_m: float | None = None


@dataclass(frozen=True)
class Hopper:
    """The limits of a hopper; ``docs/formats.md`` lists all keys of ``[hopper]``, which a mapping may have too."""

    takeoff_speed_max_m_s: float
    landing_speed_max_m_s: float
    clearance_m: float | None = None
    clearance_rule: str | None = None
    takeoff_angle_min_deg: float | None = None
    takeoff_angle_max_deg: float | None = None
    apex_height_max_m: float | None = None
    flight_time_max_s: float | None = None
    takeoff_speed_min_m_s: float | None = None
    footprint_m: float | None = None
    roughness_max_m: float | None = None
    mass_kg: float | None = None


@dataclass(frozen=True)
class Surface:
    """What a surface allows; a mapping may have any key of ``[surface]``."""

    friction_coefficient: float | None = None
    rest_slope_max_deg: float | None = None


BodyLike = Union[Body, str, Mapping[str, Any]]
HopperLike = Union[Hopper, Mapping[str, Any]]
SurfaceLike = Union[Surface, Mapping[str, Any]]


def tables(
    hopper: HopperLike, surface: SurfaceLike, body: BodyLike, search: Mapping[str, Any] | None = None
) -> str:
    """The three, and a search, as JSON."""
    given: dict[str, Any] = {
        "body": {"name": body} if isinstance(body, str) else _of(body),
        "hopper": _of(hopper),
        "surface": _of(surface),
    }
    if search:
        given["search"] = dict(search)
    return json.dumps(given)


def _of(value: Any) -> dict[str, Any]:
    return dict(value) if isinstance(value, Mapping) else _keys(value)
