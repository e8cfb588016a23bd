"""Tests run in the folder of the project, whose scenarios they read."""

import os
import pathlib

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def _at_the_root(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)


def command() -> str:
    """The command `chta`, which `.ci/python` names."""
    return os.environ.get("CHTA_COMMAND", str(ROOT / "target/debug/chta"))
