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


def quick(path: str) -> tuple[chta.Scenario, tuple[str, ...]]:
    """A scenario, and the words that ask the command for it. Roadmaps over meshes take seconds with the contacts that scenarios ask for."""
    scenario = chta.Scenario.open(path)
    if path in QUICK:
        return scenario, (path,)
    return scenario.with_keys({"search.contacts_max": 100}), (path, "--set", "search.contacts_max=100")


@pytest.mark.parametrize("path", SHIPPED)
def test_plans(path: str) -> None:
    scenario, words = quick(path)
    same(("plan", *words), scenario.plan)


@pytest.mark.parametrize("path", SHIPPED)
def test_trials(path: str) -> None:
    scenario, words = quick(path)
    same(("simulate", *words, "--trials", "40"), lambda: scenario.simulate(trials=40))


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
    same(("sites", path, "--stride", "8", "--every", "12", "--trials", "20"), lambda: open_.sites(stride=8, every=12, trials=20))
    same(("sites", path, "--stride", "16", "--every", "4", "--require-all"), lambda: open_.sites(stride=16, every=4))
    dem = "data/terrain/lunar_rille.tif"
    starts = ("map", dem, "--scenario", path, "--start", "60,60", "--goal", "100,60", "--stride", "8")
    same(starts, lambda: open_.map(dem=dem, starts_m=[(60, 60)], goals_m=[(100, 60)], stride=8))
    same(("map", "data/mesh_scenarios/cave.toml", "--hops-max", "2"), lambda: chta.Scenario.open("data/mesh_scenarios/cave.toml").map(hops_max=2))


def test_stances() -> None:
    path = "data/mesh_scenarios/three_legs.toml"
    open_ = chta.Scenario.open(path)
    words = ("stance", "data/mesh/rubble.obj", "--scenario", path)
    same((*words, "--at=0,0,1"), lambda: open_.stance((0, 0, 1)))
    more = ("--heading-deg", "30", "--up", "vertical", "--headings", "12", "--robot", "data/robots/six_legs.toml")
    of_six = {"heading_deg": 30, "up": "vertical", "headings": 12, "robot": "data/robots/six_legs.toml"}
    same((*words, "--at=-6.5,0,0.1", *more), lambda: open_.stance((-6.5, 0, 0.1), **of_six))
    on_map = "data/mesh_scenarios/mars_four_legs.toml"
    own = chta.Scenario.open(on_map)
    dem = own.tables()["terrain"]["dem"]
    at = own.tables()["terrain"]["start_m"]
    typed = ",".join(map(str, at[:2]))
    same(("stance", dem, "--scenario", on_map, "--at", typed), lambda: own.stance(at[:2]))


def test_the_cone_of_contacts(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "contacts.csv"
    file.write_text("normal_x,normal_y,normal_z,friction_coefficient\n0,0,1,0.6\n0.3,0,1,0.5\n", encoding="utf-8")
    same(("stance", "--contacts", str(file)), lambda: chta.stance_of_contacts(file))
    file.write_text("normal_x,normal_y,normal_z,friction_coefficient\n0,0,0,0.6\n", encoding="utf-8")
    same(("stance", "--contacts", str(file)), lambda: chta.stance_of_contacts(file))


def test_arenas() -> None:
    path = "data/arenas/sumo_2.toml"
    for words, asked in (
        ((), {}),
        (("--planner", "grid", "--reading", "R0"), {"planner": "grid", "reading": "R0"}),
        (("--planner", "grid", "--no-jump"), {"planner": "grid", "may_jump": False}),
        (("--planner", "rrt-star", "--nodes", "200", "--seed", "3"), {"planner": "rrt-star", "nodes": 200, "seed": 3}),
        (("--random", "5", "--seed", "4", "--random-sizes-m", "1,2"), {"random": 5, "seed": 4, "random_sizes_m": [1, 2]}),
        (("--set", "jumper.rise_max_m=0.1"), {"set": {"jumper.rise_max_m": 0.1}}),
        (("--set", "jumper.rise_mx_m=0.1"), {"set": {"jumper.rise_mx_m": 0.1}}),
        (("--compare", "--nodes", "40"), {"compare": True, "nodes": 40}),
    ):
        same(("arena", path, *words), lambda asked=asked: chta.arena(path, **asked))
    with pytest.raises(chta.ScenarioError) as refused:
        chta.arena(path, set={"jumper.rise_mx_m": 0.1})
    assert "rise_max_m" in refused.value.problems[0].help


def test_fans() -> None:
    dem, path = "data/terrain/mars_crater_field.tif", "data/scenarios/mars_crater_field.toml"
    words = ("fan", dem, "--scenario", path, "--from", "100,80", "--length", "40", "--headings", "8")
    same(words, lambda: chta.Scenario.open(path).fan((100, 80), 40, headings=8))
    same(words, lambda: chta.Scenario.open(path).fan((100, 80), 40, headings=8, dem=dem))
    off = ("fan", dem, "--scenario", path, "--from", "100000,80", "--length", "40", "--headings", "8")
    same(off, lambda: chta.Scenario.open(path).fan((100000, 80), 40, headings=8))


def test_comparisons(tmp_path: pathlib.Path) -> None:
    simple = ["data/scenarios/simple.toml", "data/scenarios/simple_reduced.toml"]
    same(("compare", *simple, "--require-all"), lambda: chta.compare(simple))
    same(("compare", *simple, "--require-all", "--prove"), lambda: chta.compare(simple, prove=True))
    key = "hopper.takeoff_speed_max_m_s"
    same(("compare", *simple, "--require-all", "--set", f"{key}=3.0"), lambda: chta.compare(simple, set={key: 3.0}))
    meshes = ["data/mesh_scenarios/rubble.toml", "data/mesh_scenarios/overhang.toml"]
    same(("compare", *meshes, "--require-all"), lambda: chta.compare(meshes))
    drives = ["data/drive/mars_rover.toml"] * 2
    same(("compare", *drives, "--require-all"), lambda: chta.compare(drives))
    # A scenario that fails has a row with its error.
    same(("compare", simple[0], drives[0], "--require-all"), lambda: chta.compare([simple[0], drives[0]]))
    with pytest.raises(chta.InputError):
        chta.compare([])


def test_trades_of_legs() -> None:
    path = "data/mesh_scenarios/three_legs.toml"
    few = ("--set", "search.contacts_max=20")
    open_ = chta.Scenario.open(path, set={"search.contacts_max": 20})
    same(
        ("trade", path, *few, "--vary", "robot.cone=kc,exact", "--require-all"), lambda: open_.trade({"robot.cone": ["kc", "exact"]})
    )
    robots = ["data/robots/three_legs.toml", "data/robots/six_legs.toml"]
    same(
        ("trade", path, *few, "--vary", f"robot.file={','.join(robots)}", "--require-all"),
        lambda: open_.trade({"robot.file": robots}),
    )
    with pytest.raises(chta.InputError):
        open_.trade({"robot.cone": ["kc"], "hopper.clearance_m": (0, 1, 2)})
    with pytest.raises(chta.InputError, match="expected one of"):
        open_.trade({"robot.cone": ["cone"]})


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
