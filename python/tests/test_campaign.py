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
