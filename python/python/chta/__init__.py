"""Constrained hopping traversability analysis: can a hopping robot cross this terrain, in how few hops, with which commands?

>>> import chta
>>> plan = chta.Scenario.open("data/scenarios/simple_reduced.toml").plan(prove=True)
>>> plan.hop_count, plan["lower_bound"]
(3, 3)

Names end in units (``_m``, ``_m_s``, ``_deg``); angles are in degrees. Long work releases the interpreter and ends within a moment of Ctrl-C.
"""

from . import campaign
from ._answers import (
    NO_GROUND,
    NOT_SEARCHED,
    UNREACHED,
    Answer,
    Arena,
    Check,
    Comparison,
    Fan,
    Grid,
    Hop,
    Map,
    Plan,
    Require,
    Run,
    Simulation,
    Sites,
    Stance,
    Trade,
)
from ._arrays import LIMITS, Chain, Dem, TakeoffSet, hop_map, mobility
from ._chta import VERSION as __version__
from ._errors import Cancelled, ChtaError, InputError, Problem, ScenarioError, TerrainError, TooLarge
from ._machine import Body, Hopper, Surface
from ._scenario import Progress, Scenario, arena, compare, run, stance_of_contacts

__all__ = [
    "LIMITS",
    "NOT_SEARCHED",
    "NO_GROUND",
    "UNREACHED",
    "Answer",
    "Arena",
    "Body",
    "Cancelled",
    "Chain",
    "Check",
    "ChtaError",
    "Comparison",
    "Dem",
    "Fan",
    "Grid",
    "Hop",
    "Hopper",
    "InputError",
    "Map",
    "Plan",
    "Problem",
    "Progress",
    "Require",
    "Run",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "Sites",
    "Stance",
    "Surface",
    "TakeoffSet",
    "TerrainError",
    "TooLarge",
    "Trade",
    "__version__",
    "arena",
    "campaign",
    "compare",
    "hop_map",
    "mobility",
    "run",
    "stance_of_contacts",
]
