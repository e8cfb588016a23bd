"""Speed of the Python package: a million pairs, one call, and a hop map of 2 048 x 2 048 posts against the command.

usage: python benches/python_speed.py PROGRAM

PROGRAM is an optimized build of the command (target/release/chta), of the same commit as the installed package, which
`pip install ./python` builds with the same profile. Prints the least of several runs; nothing else should run beside it.
"""

import pathlib
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

import numpy as np

import chta

PAIRS = 1_000_000
POSTS = 2048
SPEED_MAX_M_S = 2.5
FRICTION = 0.7
HOPS_MAX = 120


def least_s(runs: int, repeats: int, work: Callable[[], object]) -> float:
    """The least time of one repeat, in seconds."""
    times = []
    for _ in range(runs):
        began = time.perf_counter()
        for _ in range(repeats):
            work()
        times.append((time.perf_counter() - began) / repeats)
    return min(times)


def pairs() -> None:
    """Take-off sets of random pairs of a rolling chain, 1 to 20 m apart, and of a single pair."""
    draws = np.random.default_rng(1)
    x_m = np.linspace(0, 800, 401)
    z_m = np.cumsum(draws.normal(0, 0.25, 401))
    chain = chta.Chain.from_arrays(x_m, z_m, hopper=chta.Hopper(6, 6), surface=chta.Surface(0.8), body="moon")
    from_m = draws.uniform(0, 800, PAIRS)
    to_m = np.clip(from_m + draws.uniform(1, 20, PAIRS) * draws.choice([-1, 1], PAIRS), 0, 800)
    feasible = np.isfinite(chain.takeoff_set(from_m, to_m)[0]).mean()
    for threads in (1, 2):
        took_s = least_s(4, 1, lambda: chain.takeoff_set(from_m, to_m, threads=threads))
        print(f"{took_s / PAIRS * 1e9:.0f} ns a pair, {threads} thread(s), {feasible:.0%} feasible")
    one, other = np.array([10.0]), np.array([15.0])
    print(f"{least_s(20, 2000, lambda: chain.takeoff_set(one, other)) * 1e6:.2f} us a call of one pair")


def maps(program: str) -> None:
    """The same map of hops by the package, from an array, and by the command, which reads and writes GeoTIFF."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ground.tif"
        size = ("--rows", str(POSTS), "--cols", str(POSTS))
        subprocess.run([program, "synth", *size, "-o", str(file)], check=True, stdout=subprocess.DEVNULL)
        read = chta.Dem.open(file)
        dem = chta.Dem.from_array(read.z_m, read.transform, crs=read.crs_wkt)
        start_m = (POSTS / 2, POSTS / 2)
        hopper, surface = chta.Hopper(SPEED_MAX_M_S, SPEED_MAX_M_S), chta.Surface(FRICTION)
        words = [program, "map", str(file), "--start", ",".join(map(str, start_m)), "--body", "moon", "--quiet"]
        words += ["--hops-max", str(HOPS_MAX), "-o", str(pathlib.Path(folder) / "hops.tif")]
        for key in ("hopper.takeoff_speed_max_m_s", "hopper.landing_speed_max_m_s"):
            words += ["--set", f"{key}={SPEED_MAX_M_S}"]
        words += ["--set", f"surface.friction_coefficient={FRICTION}"]

        def mapped() -> chta.Grid:
            return dem.hop_map(start_m, hops_max=HOPS_MAX, hopper=hopper, surface=surface, body="moon")

        reached = (mapped().hops >= 0).sum()
        print(f"{reached} of {POSTS * POSTS} posts reached in at most {HOPS_MAX} hops")
        command_s = least_s(3, 1, lambda: subprocess.run(words, check=True, stdout=subprocess.DEVNULL))
        package_s = least_s(3, 1, mapped)
        print(f"hop_map {package_s:.2f} s, chta map {command_s:.2f} s, ratio {package_s / command_s:.2f}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    pairs()
    maps(sys.argv[1])
