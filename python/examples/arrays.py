"""Stances, comparisons and arenas, a plan along a chain of arrays, and mobility over an array with a reference system."""

from __future__ import annotations

import numpy as np

import chta


def main() -> None:
    """Prints what was found."""
    legs = chta.Scenario.open("data/mesh_scenarios/three_legs.toml")
    print("stands" if legs.stance((0, 0, 1)).stands else "does not stand")
    both = chta.compare(["data/scenarios/simple.toml", "data/scenarios/simple_reduced.toml"])
    print([row["hops"] for row in both.rows])
    print(chta.arena("data/arenas/sumo_1.toml", planner="grid").path_time_s, "s")
    hopper, surface = chta.Hopper(takeoff_speed_max_m_s=4, landing_speed_max_m_s=4), chta.Surface(friction_coefficient=0.6)
    x_m = np.linspace(0.0, 60.0, 61)
    chain = chta.Chain.from_arrays(x_m, np.sin(x_m / 5.0) / 2.0, hopper=hopper, surface=surface, body="moon")
    print(chain.plan(0.0, 60.0, effort="energy").hop_count, "hops over these nodes")
    z_m = np.random.default_rng(1).normal(0.0, 0.05, (64, 64))
    dem = chta.Dem.from_array(z_m, (1.0, 0.0, 0.0, 0.0, -1.0, 64.0), crs="IAU_2015:30135")
    free = dem.mobility(hopper=hopper, surface=surface, body="moon")
    print(f"{np.nanmean(free.share):.1%} of the nodes in reach are reached by one hop")


if __name__ == "__main__":
    main()
