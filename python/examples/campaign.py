"""A campaign over take-off speed and friction on all cores of this machine, or on the cluster of a scheduler's address."""

from __future__ import annotations

import sys

import chta


def main(address: str | None) -> None:
    """Runs the campaign and prints how many cases have a path."""
    from distributed import Client

    cases = [
        {"hopper.takeoff_speed_max_m_s": 2 + 0.1 * i, "surface.friction_coefficient": 0.3 + 0.05 * j}
        for i in range(40)
        for j in range(10)
    ]
    with Client(address) if address else Client() as client:
        done = chta.campaign.run(cases, "data/scenarios/simple_reduced.toml", client, folder="campaign_parts")
    print(f"{sum(bool(row['holds']) for row in done.rows)} of {len(done)} cases have a path")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else None)
