"""The exceptions of chta."""

from __future__ import annotations

from typing import NamedTuple


class Problem(NamedTuple):
    """One problem of a scenario."""

    line: int
    """Line in the text, from 1; 0 outside a text."""
    column: int
    """Column in the text, from 1; 0 outside a text."""
    key: str
    """The key, ``table.name``."""
    message: str
    """What was found and what is expected."""
    help: str
    """How to mend it."""


class ChtaError(Exception):
    """The base of all exceptions of chta; by itself a defect of chta."""


class Cancelled(ChtaError):
    """Work that a progress function ended."""


class InputError(ChtaError, ValueError):
    """A value that is not taken."""

    key: str | None = None
    """What it is of, if that has a name."""
    found: str | None = None
    """The value."""
    expected: str | None = None
    """What it should be."""


class ScenarioError(InputError):
    """Keys of a scenario that are unknown, missing, or have values that they do not take."""

    def __init__(self, message: str = "") -> None:
        super().__init__(message)
        self._problems: list[Problem] = []

    @property
    def problems(self) -> list[Problem]:
        """All problems."""
        return self._problems

    @problems.setter
    def problems(self, rows: list[tuple[int, int, str, str, str]]) -> None:
        self._problems = [Problem(*row) for row in rows]
        if self._problems:
            first = self._problems[0]
            self.key, self.found, self.expected = first.key, first.message, first.help


class TerrainError(ChtaError, OSError):
    """A file of terrain that cannot be read, or that holds something else."""


class TooLarge(ChtaError, MemoryError):
    """What needs more memory than allowed."""
