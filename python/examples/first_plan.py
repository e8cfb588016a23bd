"""A plan, what it takes to make it, and hops between a million pairs of points."""

from __future__ import annotations

import numpy as np

import chta


def main() -> None:
    """Prints what was found."""
    scenario = chta.Scenario.open("data/scenarios/simple_reduced.toml")
    plan = scenario.plan(prove=True)
    print(f"{plan.hop_count} hops over these nodes; no fewer than {plan['lower_bound']}")
    low, high = scenario.require("hopper.takeoff_speed_max_m_s").bounds
    print(f"not with {low} m/s, and with {high} m/s")
    x_m = np.linspace(0.0, 100.0, 401)
    chain = chta.Chain.from_arrays(
        x_m,
        np.sin(x_m / 4.0) / 2.0,
        hopper=chta.Hopper(takeoff_speed_max_m_s=5.0, landing_speed_max_m_s=5.0),
        surface=chta.Surface(friction_coefficient=0.6),
        body="moon",
    )
    pairs = np.random.default_rng(1).uniform(0.0, 100.0, (2, 1_000_000))
    hops = chain.takeoff_set(pairs[0], pairs[1])
    print(f"{hops.feasible.mean():.1%} of a million pairs have a hop")


if __name__ == "__main__":
    main()
