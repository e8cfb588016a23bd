"""A campaign of CHTA_CASES cases (10 000 unless set) of some 5 ms and more each on two workers, one of which is killed in mid-run: the bytes are
those of a single process, and the times of both are printed."""

from __future__ import annotations

import os
import pathlib
import signal
import tempfile
import threading
import time
from typing import Any

import chta

SCENARIO = "data/scenarios/simple_reduced.toml"


def cases(count: int) -> list[dict[str, Any]]:
    """Speeds and frictions, with nodes enough for 5 ms and more."""
    side = max(1, round(count**0.5))
    return [
        {
            "hopper.takeoff_speed_max_m_s": 4.0 + 6.0 * (i % side) / side,
            "surface.friction_coefficient": 0.4 + 0.5 * (i // side) / side,
            "search.points_per_segment": 200,
        }
        for i in range(count)
    ]


def main(count: int) -> None:
    """Runs the campaign in one process, and on two workers."""
    from distributed import Client, LocalCluster

    listed = cases(count)
    began = time.monotonic()
    # As many cores for the single process: it answers two cases at a time no faster than one after the other on each.
    plain = chta.campaign.run(listed, SCENARIO, threads=2)
    alone = time.monotonic() - began
    print(f"{count} cases in one process: {alone:.1f} s, {1e3 * alone / count:.2f} ms a case", flush=True)
    with tempfile.TemporaryDirectory() as scratch, LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=f"{scratch}/dask"
    ) as cluster, Client(cluster) as client:
        for kills in (True, False):
            folder = pathlib.Path(scratch) / f"parts{int(kills)}"
            folder.mkdir()
            victim = next(iter(client.run(os.getpid).values()))

            def kill(folder: pathlib.Path = folder, victim: int = victim) -> None:
                while len(list(folder.glob("part-*"))) < max(1, count // 150):
                    time.sleep(0.01)
                os.kill(victim, signal.SIGKILL)

            killer = threading.Thread(target=kill) if kills else None
            if killer is not None:
                killer.start()
            began = time.monotonic()
            done = chta.campaign.run(listed, SCENARIO, client, folder=folder)
            took = time.monotonic() - began
            if killer is not None:
                killer.join()
            same = "the same bytes" if done.rows == plain.rows else "OTHER BYTES"
            how = "with a killed worker" if kills else "undisturbed"
            print(f"two workers {how}: {took:.1f} s, {took / alone:.2f} of one process, {same}", flush=True)
            if done.rows != plain.rows:
                raise SystemExit(1)


if __name__ == "__main__":
    main(int(os.environ.get("CHTA_CASES", "10000")))
