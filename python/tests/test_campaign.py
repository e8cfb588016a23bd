"""Campaigns give the same bytes on one process, on a cluster, after a killed worker, and after a crash."""

import os
import pathlib
import signal
import threading
import time

import pytest

import chta

SCENARIO = "data/scenarios/simple_reduced.toml"


def cases(count: int) -> list[dict[str, object]]:
    speeds = [2.0 + 4.0 * i / count for i in range(count)]
    listed: list[dict[str, object]] = [{"hopper.takeoff_speed_max_m_s": speed, "surface.friction_coefficient": 0.6} for speed in speeds]
    listed[3] = {"hopper.takeoff_speed_max_m_s": -1.0}
    return listed


def test_rows_are_those_of_single_questions_and_errors_stay_in_their_row() -> None:
    listed = cases(12)
    done = chta.campaign.run(listed, SCENARIO, batch=5)
    assert [row["case"] for row in done.rows] == list(range(12))
    for case, row in zip(listed, done.rows):
        if row["error"] is not None:
            assert case == listed[3] and "takeoff_speed_max_m_s" in row["error"] and row["document"] is None
            continue
        plan = chta.Scenario.open(SCENARIO, set=case).plan(threads=1)
        assert row["document"].encode() == plan.json() and row["holds"] == plan.holds and row["hops"] == plan.hop_count
    assert len({row["key"] for row in done.rows if row["key"]}) == 11
    assert {row["holds"] for row in done.rows} == {True, False, None}


def test_warnings_of_all_cases_are_counted() -> None:
    listed = [{"hopper.takeoff_speed_max_m_s": 5.0, "uncertainty.trials": trials} for trials in (100, 100, 200)]
    done = chta.campaign.run(listed, SCENARIO)
    said = [set(document["warnings"]) for document in done.documents() if document]
    assert len(said) == 3 and done.warnings == {text: sum(text in each for each in said) for text in set().union(*said)}
    # A key without effect on a plan is said of every case that sets it.
    assert sum(count for text, count in done.warnings.items() if "uncertainty.trials" in text) == 3


def test_batches_and_folders_change_no_byte(tmp_path: pathlib.Path) -> None:
    listed = cases(23)
    plain = chta.campaign.run(listed, SCENARIO, batch=23)
    kept = chta.campaign.run(listed, SCENARIO, batch=4, folder=tmp_path)
    assert kept.rows == plain.rows
    parts = sorted(tmp_path.iterdir())
    assert len(parts) == 6
    # A crash left four parts: the others are made again, and these are read.
    times = {part.name: part.stat().st_mtime_ns for part in parts}
    for part in parts[:2]:
        part.unlink()
    assert chta.campaign.run(listed, SCENARIO, batch=4, folder=tmp_path).rows == plain.rows
    remade = [part.name for part in tmp_path.iterdir() if part.stat().st_mtime_ns != times[part.name]]
    assert sorted(remade) == [part.name for part in parts[:2]]
    # Another question has parts of its own.
    checked = chta.campaign.run(listed, SCENARIO, batch=4, folder=tmp_path, question="check")
    assert [row["holds"] for row in checked.rows] == [row["holds"] for row in plain.rows]
    assert len(list(tmp_path.iterdir())) == 12
    with pytest.raises(chta.InputError):
        chta.campaign.run(listed, SCENARIO, question="hop")


def test_keys_and_parts_are_of_the_content_of_files(tmp_path: pathlib.Path) -> None:
    (tmp_path / "chain.csv").write_text("x_m,z_m\n0,0\n10,1\n20,0\n", encoding="utf-8")
    tables = {
        "body": {"name": "moon"},
        "hopper": {"takeoff_speed_max_m_s": 6.0, "landing_speed_max_m_s": 6.0},
        "surface": {"friction_coefficient": 0.6},
        "terrain": {"chain": "chain.csv", "start_x_m": 1.0, "goal_x_m": 19.0},
    }
    scenario = chta.Scenario.open(tables, base=tmp_path)
    listed = [{"hopper.takeoff_speed_max_m_s": 5.0}, {"terrain.chain": "other.csv"}]
    folder = tmp_path / "parts"
    first = chta.campaign.run(listed, scenario, folder=folder)
    assert first.rows[0]["error"] is None and "other.csv" in first.rows[1]["error"]
    (tmp_path / "other.csv").write_text("x_m,z_m\n0,0\n10,2\n20,0\n", encoding="utf-8")
    second = chta.campaign.run(listed, scenario, folder=folder)
    assert second.rows[0] == first.rows[0] and second.rows[1]["error"] is None
    (tmp_path / "chain.csv").write_text("x_m,z_m\n0,0\n10,1.5\n20,0\n", encoding="utf-8")
    third = chta.campaign.run(listed, scenario, folder=folder)
    assert third.rows[0]["key"] != first.rows[0]["key"] and third.rows[0]["document"] != first.rows[0]["document"]
    assert third.rows[1] == second.rows[1]
    assert len(list(folder.iterdir())) == 3


QUICK = {"uncertainty.policy": "open-loop", "search.risk": "ignored"}


def test_trials_in_ranges_are_the_bytes_of_the_single_run(tmp_path: pathlib.Path) -> None:
    scenario = chta.Scenario.open("data/scenarios/rolling_surely.toml", set=QUICK)
    asked = {"trials": 110, "seed": 3, "success_min": 0.2}
    whole = scenario.simulate(**asked)
    parts = chta.campaign.simulate(scenario, batch=40, folder=tmp_path / "parts", **asked)
    assert parts.json() == whole.json() and parts.holds == whole.holds
    times = {part: part.stat().st_mtime_ns for part in (tmp_path / "parts").iterdir()}
    again = chta.campaign.simulate(scenario, batch=40, folder=tmp_path / "parts", **asked)
    assert len(times) == 3 and again.json() == whole.json() and times == {part: part.stat().st_mtime_ns for part in times}
    scenario = scenario.with_keys({"uncertainty.trials": 30})
    first = scenario.tally(0, 20)
    with pytest.raises(chta.InputError, match="expected those from 0 to 29"):
        scenario.merged([first])
    with pytest.raises(chta.InputError, match="another scenario"):
        scenario.with_keys({"uncertainty.seed": 9}).merged([first, scenario.tally(20, 10)])


def test_trials_over_a_mesh_merge_too() -> None:
    few = {"search.contacts_max": 60, "uncertainty.policy": "open-loop", "uncertainty.trials": 30}
    scenario = chta.Scenario.open("data/mesh_scenarios/overhang.toml", set={**few, "uncertainty.takeoff_speed_sigma_fraction": 0.01})
    tallies = [scenario.tally(first, 15) for first in (15, 0)]
    whole = scenario.simulate()
    assert whole.success_rate is not None
    assert scenario.merged(tallies).json() == whole.json()


def test_a_killed_worker_loses_nothing(tmp_path: pathlib.Path) -> None:
    distributed = pytest.importorskip("distributed")
    listed = cases(400)
    plain = chta.campaign.run(listed, SCENARIO)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=str(tmp_path / "dask")
    ) as cluster, distributed.Client(cluster) as client:
        pids = list(client.run(os.getpid).values())
        folder = tmp_path / "parts"
        folder.mkdir()

        def kill() -> None:
            # In mid-run: some parts are there, and many are not.
            while len(list(folder.glob("part-*"))) < 3:
                time.sleep(0.005)
            os.kill(pids[0], signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        done = chta.campaign.run(listed, SCENARIO, client, batch=5, folder=folder)
        killer.join()
        assert pids[0] not in client.run(os.getpid).values()
    assert done.rows == plain.rows
    assert len(list(folder.glob("part-*"))) == 80
