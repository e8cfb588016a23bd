"""Errors, interrupts, pickles, pictures, and names."""

import doctest
import importlib
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import chta

SIMPLE = "data/scenarios/simple.toml"


@pytest.mark.parametrize("name", ["chta", "chta._scenario", "chta._arrays", "chta.campaign", "chta.xarray"])
def test_examples_of_docstrings(name: str) -> None:
    failed, tried = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert failed == 0 and tried > 0


def test_every_public_name_has_a_docstring() -> None:
    for name in chta.__all__:
        value = getattr(chta, name)
        if callable(value) and isinstance(value, type):
            assert value.__doc__, name
            for member, of_class in vars(value).items():
                if not member.startswith("_") and callable(of_class):
                    assert of_class.__doc__, f"{name}.{member}"


def test_problems_have_positions_and_keys() -> None:
    with pytest.raises(chta.ScenarioError) as raised:
        chta.Scenario.open(text="[body]\nname = 'mars'\n[hopper]\ntakeoff_speed_max_m_s = -1\nsped = 3\n")
    problems = {problem.key: problem for problem in raised.value.problems}
    assert problems["hopper.takeoff_speed_max_m_s"].line == 4 and problems["hopper.sped"].line == 5
    assert isinstance(raised.value, ValueError) and raised.value.key in problems
    assert [p.key for p in pickle.loads(pickle.dumps(raised.value)).problems] == [p.key for p in raised.value.problems]


def test_the_classes_of_errors() -> None:
    with pytest.raises(chta.InputError):
        chta.Scenario.open("absent.toml")
    with pytest.raises(chta.InputError):
        chta.Scenario.open()
    with pytest.raises(chta.TerrainError) as raised:
        chta.Dem.open("README.md")
    assert isinstance(raised.value, OSError)
    with pytest.raises(chta.TooLarge) as large:
        chta.Scenario.open("data/scenarios/lunar_rille_free.toml").plan(memory_max_mib=1)
    assert isinstance(large.value, MemoryError)
    with pytest.raises(chta.InputError, match="a front"):
        chta.Scenario.open("data/missions/lunar_rille_targets.toml").plan(front="hops,energy")
    with pytest.raises(chta.InputError) as named:
        chta.Scenario.open(SIMPLE).plan(front="hops,beauty")
    assert named.value.key == "front" and "hops,energy" in named.value.expected
    with pytest.raises(chta.InputError) as half:
        chta.Scenario.open("data/scenarios/rolling_surely.toml").simulate(until_half_width=0.7)
    assert half.value.found == "0.7"


def test_a_text_tables_and_a_file_are_one_scenario() -> None:
    file = chta.Scenario.open(SIMPLE)
    with open(SIMPLE, encoding="utf-8") as opened:
        text = chta.Scenario.open(text=opened.read(), base="data/scenarios")
    plans = [scenario.plan()["path"] for scenario in (file, text)]
    tables = file.tables()
    tables["terrain"]["chain"] = os.path.relpath(tables["terrain"]["chain"])
    plans.append(chta.Scenario.open(tables).plan()["path"])
    assert plans[0] == plans[1] == plans[2] and len(plans[0]) == 1


def test_answers_pickle_and_show_themselves() -> None:
    plan = chta.Scenario.open(SIMPLE).plan()
    svg = plan.svg()
    assert svg is not None and b"<svg" in svg
    png = plan.png()
    assert png is not None and png.startswith(b"\x89PNG")
    again = pickle.loads(pickle.dumps(plan))
    assert again == plan and again.document() == plan.document() and again.svg() == svg and again.png() is None
    shown = plan._repr_html_()
    assert "traversable" in shown and "<svg" in shown
    scenario = pickle.loads(pickle.dumps(chta.Scenario.open(SIMPLE, set={"hopper.clearance_m": np.float64(0.1)})))
    assert scenario.tables()["hopper"]["clearance_m"] == 0.1


LONG = {"prove": True, "prove_cells_max": 10_000_000, "threads": 1}


def long_plan() -> chta.Scenario:
    return chta.Scenario.open("data/scenarios/mars_frogbot.toml", set={"search.node_spacing_max_m": 0.001})


def test_an_interrupt_ends_the_work_within_a_moment() -> None:
    # A shell that starts programs in the background lets them ignore interrupts.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    began: list[float] = []

    def interrupt() -> None:
        began.append(time.monotonic())
        signal.raise_signal(signal.SIGINT)

    timer = threading.Timer(0.5, interrupt)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            long_plan().plan(**LONG)
    finally:
        signal.signal(signal.SIGINT, before)
    # Whole, it takes minutes.
    assert time.monotonic() - began[0] < 2.0


def test_progress_is_told_and_may_end_the_work() -> None:
    told: list[tuple[str, int, object]] = []

    def progress(stage: str, done: int, of: "int | None") -> bool:
        told.append((stage, done, of))
        return len(told) < 3

    with pytest.raises(chta.Cancelled):
        long_plan().plan(**LONG, progress=progress)
    assert len(told) == 3 and told[0][0]
    with pytest.raises(ZeroDivisionError):
        long_plan().plan(**LONG, progress=lambda *_: 1 // 0)


def test_other_threads_run_meanwhile() -> None:
    count = [0]
    done = threading.Event()

    def spin() -> None:
        while not done.is_set():
            count[0] += 1

    thread = threading.Thread(target=spin)
    thread.start()
    chta.Scenario.open("data/scenarios/lunar_rille.toml").map(stride=4, threads=1)
    done.set()
    thread.join()
    assert count[0] > 10_000


def test_extras_are_used_where_they_are() -> None:
    pandas = pytest.importorskip("pandas")
    plan = chta.Scenario.open("data/scenarios/simple_reduced.toml").plan()
    assert isinstance(plan.hops, pandas.DataFrame) and len(plan.hops) == plan.hop_count
    pytest.importorskip("xarray")
    found = chta.Scenario.open("data/scenarios/lunar_rille.toml").map(stride=16)
    data = found.grid.to_xarray()
    assert data["hops"].shape == found.hops.shape and float(data.x[1] - data.x[0]) == pytest.approx(32.0)
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    jumps = chta.arena("data/arenas/sumo_2.toml", planner="grid")
    for answer in (plan, found, jumps):
        assert answer.plot().has_data()
    rays = chta.Scenario.open("data/scenarios/mars_crater_field.toml").fan((100, 80), 10, headings=4)
    assert list(rays.to_frame()["heading_deg"]) == [0, 90, 180, 270]
    both = chta.compare(["data/scenarios/simple.toml", "data/scenarios/simple_reduced.toml"]).to_frame()
    assert list(both["hops"]) == [1, 5]


def test_a_plan_is_drawn_over_its_ground() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    for name in (SIMPLE, "data/scenarios/lunar_rille.toml"):
        plan = pickle.loads(pickle.dumps(chta.Scenario.open(name).plan()))
        assert plan.ground is not None and plan.ground.shape[1] == 2
        distance, elevation = plan.ground.T
        ground, *hops = plan.plot(plt.figure().gca()).get_lines()
        assert list(ground.get_xdata()) == list(distance) and len(hops) == plan.hop_count
        for hop in hops:
            ends = np.array([hop.get_xydata()[0], hop.get_xydata()[-1]])
            np.testing.assert_allclose(np.interp(ends[:, 0], distance, elevation), ends[:, 1], atol=1e-6)
    assert chta.Scenario.open("data/mesh_scenarios/overhang.toml").plan().ground is None
