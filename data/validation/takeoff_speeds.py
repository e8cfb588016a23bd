#!/usr/bin/env python3
"""Take-off speeds of a machine in 60-digit arithmetic: the fixtures of tests/library/takeoff_speeds.rs.

    pip install mpmath
    python3 data/validation/takeoff_speeds.py > data/validation/takeoff_speeds.csv

For each hop the two take-off angles of the arcs with a given take-off speed, from v^2 = g X (1 + m^2) / (2 (m - b)), which is
m^2 - 2 q m + 1 + 2 q b = 0 with q = v^2 / (g X); blank where every arc is faster. A least speed v holds as v (1 - 1e-9), and the angles
between these two are refused; a level allows the two angles of v itself. Inputs are doubles, taken as exact. Speeds whose last binary
digit moves an angle by more than 1e-11 rad are not drawn.
"""
import random
import sys

from mpmath import atan, mp, mpf, sqrt

mp.dps = 60
SEED, ROWS = 20261128, 400
HELD = 1 - mpf(10) ** -9


def slopes(b, q):
    """The two slopes of a speed; None where every arc is faster."""
    radicand = q * q - 2 * q * b - 1
    if radicand < 0 or q < b:
        return None
    return q - sqrt(radicand), q + sqrt(radicand)


def angles(g, run, b, v):
    """As angles, radians."""
    found = slopes(b, v * v / (g * run))
    return found and [atan(m) for m in found]


def main():
    r = random.Random(SEED)
    print("# Made by: python3 data/validation/takeoff_speeds.py > data/validation/takeoff_speeds.csv   (mpmath, 60 digits; see there)")
    ends = ["refused_min_rad", "refused_max_rad", "flat_rad", "steep_rad"]
    print(",".join(["gravity_m_s2", "run_m", "rise_m", "speed_m_s", *ends]))
    rows = 0
    while rows < ROWS:
        g, run = 10 ** r.uniform(-5, 1.4), 10 ** r.uniform(-3, 5)
        rise = run * r.choice([0.0, r.uniform(-1, 1), r.uniform(-3, 3), r.choice([-1, 1]) * 10 ** r.uniform(-9, 2)])
        b = mpf(rise) / mpf(run)
        least = sqrt(mpf(g) * mpf(run) * (b + sqrt(1 + b * b)))
        v = float(least) * r.choice([1 + 10 ** r.uniform(-6, 0), 10 ** r.uniform(0, 2), 1 - 10 ** r.uniform(-6, -1)])
        exact = [angles(mpf(g), mpf(run), b, mpf(v) * share) for share in (HELD, 1)]
        moved = [angles(mpf(g), mpf(run), b, mpf(v) * share * (1 - mpf(2) ** -53)) for share in (HELD, 1)]
        if any((one is None) != (two is None) or one and any(abs(a - c) > mpf(10) ** -11 for a, c in zip(one, two))
               for one, two in zip(exact, moved)):
            continue
        fields = [repr(number) for number in (g, run, rise, v)]
        for pair in exact:
            fields += ["", ""] if pair is None else [mp.nstr(a, 17) for a in pair]
        print(",".join(fields))
        rows += 1


if __name__ == "__main__":
    sys.exit(main())
