"""Answers in Python are the bytes of the command, for every shipped scenario."""

import pathlib
import subprocess
import tempfile

import pytest
from conftest import ROOT, command

import chta

SHIPPED = sorted(
    str(path.relative_to(ROOT))
    for folder in ("scenarios", "mesh_scenarios", "drive", "missions")
    for path in (ROOT / "data" / folder).glob("*.toml")
)
QUICK = [path for path in SHIPPED if "mesh_scenarios" not in path]


def asked(*words: str) -> tuple[int, bytes]:
    """Exit status and standard output of the command."""
    ran = subprocess.run([command(), *words, "--format", "json", "--quiet"], cwd=ROOT, capture_output=True, check=False)
    return ran.returncode, ran.stdout


def same(words: tuple[str, ...], ask) -> None:
    status, said = asked(*words)
    if status == 2:
        with pytest.raises(chta.ChtaError):
            ask()
        return
    answer = ask()
    assert answer.json() == said, words
    assert answer.holds == (status == 0), words


def test_there_are_scenarios_of_every_kind() -> None:
    assert len(SHIPPED) >= 20


@pytest.mark.parametrize("path", SHIPPED)
def test_plans(path: str) -> None:
    same(("plan", path), lambda: chta.Scenario.open(path).plan())


@pytest.mark.parametrize("path", SHIPPED)
def test_trials(path: str) -> None:
    same(("simulate", path, "--trials", "40"), lambda: chta.Scenario.open(path).simulate(trials=40))


@pytest.mark.parametrize("path", QUICK)
def test_checks_and_hops(path: str) -> None:
    same(("check", path), lambda: chta.Scenario.open(path).check())
    same(("hop", path), lambda: chta.Scenario.open(path).hop())


def test_runs() -> None:
    for path in ("data/scenarios/simple.toml", "data/scenarios/wall.toml", "data/mesh_scenarios/cave.toml", "data/mesh_scenarios/three_legs.toml"):
        with tempfile.TemporaryDirectory() as folder:
            same(("run", path, "-o", folder), lambda: chta.run(path))
            ran = chta.run(path, set={"uncertainty.trials": 40})
            # With a key of its errors a scenario has trials, where it has a path.
            assert (ran.trials is not None) == ran.plan.holds


def test_proofs_requirements_and_trades() -> None:
    path = "data/scenarios/simple_reduced.toml"
    open_ = chta.Scenario.open(path)
    same(("check", path, "--prove"), lambda: open_.check(prove=True))
    same(("plan", path, "--prove", "--verify"), lambda: open_.plan(prove=True, verify=True))
    key = "hopper.takeoff_speed_max_m_s"
    same(("require", path, "--vary", key), lambda: open_.require(key))
    same(("trade", path, "--vary", f"{key}=2.0:6.0:5", "--require-all"), lambda: open_.trade({key: (2.0, 6.0, 5)}))


def test_maps_and_sites() -> None:
    path = "data/scenarios/lunar_rille.toml"
    open_ = chta.Scenario.open(path)
    words = ("map", path, "--stride", "8", "--return", "--effort", "energy")
    same(words, lambda: open_.map(stride=8, back=True, effort="energy"))
    same(("sites", path, "--stride", "16", "--every", "4", "--require-all"), lambda: open_.sites(stride=16, every=4))
    dem = "data/terrain/lunar_rille.tif"
    starts = ("map", dem, "--scenario", path, "--start", "60,60", "--goal", "100,60", "--stride", "8")
    same(starts, lambda: open_.map(dem=dem, starts_m=[(60, 60)], goals_m=[(100, 60)], stride=8))
    same(("map", "data/mesh_scenarios/cave.toml", "--hops-max", "2"), lambda: chta.Scenario.open("data/mesh_scenarios/cave.toml").map(hops_max=2))


def test_hops_over_a_mesh_and_on_a_map() -> None:
    path = "data/mesh_scenarios/cave.toml"
    ends = chta.Scenario.open(path).tables()["terrain"]
    start, goal = ends["start_m"], ends["goal_m"]
    typed = [",".join(map(str, at)) for at in (start, goal)]
    same(("hop", path, "--from", typed[0], "--to", typed[1]), lambda: chta.Scenario.open(path).hop(start, goal))
    path = "data/scenarios/lunar_rille.toml"
    same(("hop", path, "--from", "60,60", "--to", "62,61"), lambda: chta.Scenario.open(path).hop((60, 60), (62, 61)))


def test_a_result_repeats_its_path(tmp_path: pathlib.Path) -> None:
    result = tmp_path / "result.json"
    result.write_bytes(chta.Scenario.open("data/scenarios/rolling_surely.toml").plan().json())
    same(("simulate", str(result), "--trials", "40"), lambda: chta.Scenario.open(result).simulate(trials=40))
