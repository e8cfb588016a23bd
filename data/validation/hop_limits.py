#!/usr/bin/env python3
"""Limits of single hops in 60-digit arithmetic: the fixtures of tests/library/ballistics_precision.rs.

    pip install mpmath
    python3 data/validation/hop_limits.py > data/validation/hop_limits.csv

The program states every limit in the loft n = m - b; this page states them in the take-off slope m = tan(theta), by the paper's
equations, and shares nothing with it. Inputs are doubles, printed so that they read back as the same double, and taken as exact.
Ends are take-off angles in radians, blank where the limit leaves nothing. Cases whose answer hangs on the last digits of the input
(an interval that is empty or not within 1e-12) are not drawn; speeds a hair above the least one are, since the program's speed
tolerance of 1e-9 makes them well-posed. Not drawn either are speeds whose last binary digit alone moves an end by more than 1e-10 rad
(a landing at next to the least speed, falling almost vertically): no arithmetic on doubles says more of them than the input does.

The apex limit bounds the highest point of the flown arc: the take-off where it never rises, the landing where it still rises there.
"""
import random
import sys

from mpmath import atan, inf, mp, mpf, pi, sqrt, tan

mp.dps = 60
SEED, ROWS = 20240607, 1000
TOLERANT = 1 + mpf(10) ** -9  # a speed limit v holds as v (1 + 1e-9)
LIMITS = ["takeoff-cone", "landing-cone", "takeoff-speed", "landing-speed", "terrain", "mechanical-angle", "apex-height", "flight-time"]
INPUTS = ["gravity_m_s2", "takeoff_x_m", "takeoff_z_m", "vertex_x_m", "vertex_z_m", "landing_x_m", "landing_z_m", "clearance_m",
          "takeoff_min_deg", "takeoff_max_deg", "takeoff_speed_max_m_s", "landing_min_deg", "landing_max_deg", "landing_speed_max_m_s",
          "mechanical_min_deg", "mechanical_max_deg", "apex_height_max_m", "flight_time_max_s"]
CHOICES = ["least_speed", "mid_range", "least_time"]


def cone(low_deg, high_deg):
    """Slopes of the directions inside (-90, 90) degrees; None for nothing."""
    if low_deg >= 90 or high_deg <= -90:
        return None
    return (-inf if low_deg <= -90 else tan(mpf(low_deg) * pi / 180), inf if high_deg >= 90 else tan(mpf(high_deg) * pi / 180))


def speed(b, q):
    """g X (1 + m^2) / (2 (m - b)) <= V^2 with q = V^2 / (g X): q -+ sqrt(q^2 - 2 q b - 1)."""
    radicand = q * q - 2 * q * b - 1
    if q <= 0 or radicand < 0:
        return None
    return (q - sqrt(radicand), q + sqrt(radicand))


def apex(b, run, height):
    """The highest point of the flown arc stays within the height: X m^2 <= 4 H (m - b) where the arc has its apex in flight."""
    if b * run > height:
        return None
    # m^2 - (4 H / X) m + (4 H / X) b <= 0; below its smaller root the apex is not in flight, and the ends are low enough.
    a = 2 * height / run
    return (-inf, a + sqrt(a * a - 2 * a * b))


def limits_of(c):
    """Every limit as an interval of m."""
    g, eps = mpf(c["gravity_m_s2"]), mpf(c["clearance_m"])
    run = abs(mpf(c["landing_x_m"]) - mpf(c["takeoff_x_m"]))
    rise = mpf(c["landing_z_m"]) - mpf(c["takeoff_z_m"])
    b = rise / run
    found = {"takeoff-cone": cone(c["takeoff_min_deg"], c["takeoff_max_deg"])}
    landing = cone(c["landing_min_deg"], c["landing_max_deg"])
    found["landing-cone"] = landing and (2 * b - landing[1], 2 * b - landing[0])
    found["takeoff-speed"] = speed(b, (mpf(c["takeoff_speed_max_m_s"]) * TOLERANT) ** 2 / (g * run))
    # v_t^2 = v_l^2 + 2 g Z
    found["landing-speed"] = speed(b, ((mpf(c["landing_speed_max_m_s"]) * TOLERANT) ** 2 + 2 * g * rise) / (g * run))
    if c["vertex_x_m"] is not None:
        d, height = abs(mpf(c["vertex_x_m"]) - mpf(c["takeoff_x_m"])), mpf(c["vertex_z_m"]) + eps - mpf(c["takeoff_z_m"])
        # P eq. 14: z_p + eps - z_t <= m d - (m - b) d^2 / X
        found["terrain"] = ((height - b * d * d / run) / (d - d * d / run), inf)
    if c["mechanical_min_deg"] is not None:
        found["mechanical-angle"] = cone(c["mechanical_min_deg"], c["mechanical_max_deg"])
    if c["apex_height_max_m"] is not None:
        found["apex-height"] = apex(b, run, mpf(c["apex_height_max_m"]))
    if c["flight_time_max_s"] is not None:
        found["flight-time"] = (-inf, b + g * mpf(c["flight_time_max_s"]) ** 2 / (2 * run))
    return g, run, b, found


def well_posed(b, interval):
    """Whether an interval is empty or not by more than rounding."""
    return interval is None or abs(interval[1] - interval[0]) > mpf(10) ** -12 * (1 + abs(b))


def resolved(c, found):
    """Whether the last digit of either speed moves no end by more than 1e-10 rad."""
    other = dict(c)
    for name in ("takeoff", "landing"):
        other[name + "_speed_max_m_s"] = mpf(c[name + "_speed_max_m_s"]) * (1 - mpf(2) ** -53)
    moved = limits_of(other)[3]
    for name in ("takeoff-speed", "landing-speed"):
        one, two = found[name], moved[name]
        if (one is None) != (two is None) or (one and any(abs(atan(m) - atan(n)) > mpf(10) ** -10 for m, n in zip(one, two))):
            return False
    return True


def arc(g, run, b, m):
    """Take-off speed, landing speed, flight time (P eq. 9, 11, 37)."""
    k = g * run / (2 * (m - b))
    return sqrt(k * (1 + m * m)), sqrt(k * (1 + (2 * b - m) ** 2)), sqrt(2 * run * (m - b) / g)


def chosen(b, low, high):
    """The slope to fly by each choice."""
    best = b + sqrt(1 + b * b)
    return [min(max(best, low), high), tan((atan(low) + atan(high)) / 2), low]


def log_uniform(r, low, high):
    return 10 ** r.uniform(low, high)


def draw(r):
    """One case, biased to the ugly."""
    g, run = log_uniform(r, -5, 1.39794), log_uniform(r, -3, 5)
    slope = r.choice([0.0, r.uniform(-1, 1), r.uniform(-3, 3), r.choice([-1, 1]) * log_uniform(r, -9, 3)])
    sign, far = r.choice([-1, 1]), r.choice([0.0, 0.0, r.uniform(-1e5, 1e5)])
    c = dict.fromkeys(INPUTS)
    c["gravity_m_s2"], c["takeoff_x_m"], c["takeoff_z_m"] = g, far, r.choice([0.0, r.uniform(-3000, 3000)])
    c["landing_x_m"], c["landing_z_m"] = far + sign * run, c["takeoff_z_m"] + slope * run
    run = abs(mpf(c["landing_x_m"]) - mpf(far))
    b = (mpf(c["landing_z_m"]) - mpf(c["takeoff_z_m"])) / run
    c["clearance_m"] = r.choice([0.0, float(run) * log_uniform(r, -6, -1)])
    if r.random() < 0.6:
        share = r.choice([r.random(), log_uniform(r, -9, -1), 1 - log_uniform(r, -9, -1)])
        c["vertex_x_m"] = far + sign * float(run) * share
        above = r.choice([r.uniform(-1, 0.5), r.uniform(-1, 0.1) * min(share, 1 - share)])
        c["vertex_z_m"] = c["takeoff_z_m"] + float(b) * float(run) * share + above * float(run)
    for name, sight in [("takeoff", b), ("landing", -b)]:
        # P eq. 16 and 18: the least speed at either end.
        least = float(sqrt(g * run * (sight + sqrt(1 + sight * sight))))
        c[name + "_speed_max_m_s"] = least * r.choice([1 + log_uniform(r, -14, -6), 1 + log_uniform(r, -6, 0), log_uniform(r, 0, 3)])
        if r.random() < 0.05:
            c[name + "_speed_max_m_s"] = least * (1 - log_uniform(r, -8, -1))
    beta = float(atan(b)) * 57.29577951308232
    c["takeoff_min_deg"], c["takeoff_max_deg"] = r.choice([(-90.0, 90.0), (-90.0, 90.0), (r.uniform(-89.999, beta), r.uniform(beta, 120)),
                                                           (beta + r.uniform(0, 60), 120.0), (r.uniform(-100, 80), 89.9999)])
    c["landing_min_deg"], c["landing_max_deg"] = r.choice([(-90.0, 90.0), (-90.0, 90.0), (-90.0, beta - r.uniform(0, 30)),
                                                           (r.uniform(-100, beta), r.uniform(beta, 89.999)), (-89.9999, r.uniform(-80, 100))])
    if r.random() < 0.3:
        c["mechanical_min_deg"], c["mechanical_max_deg"] = r.uniform(-89, beta), r.uniform(beta, 89.999)
    if r.random() < 0.4:
        rise = b * run
        c["apex_height_max_m"] = float(max(rise, 0) * (1 + log_uniform(r, -8, 1)) + run * mpf(log_uniform(r, -9, 2)) * (rise <= 0))
    if r.random() < 0.3:
        c["flight_time_max_s"] = float(sqrt(2 * run * sqrt(1 + b * b) / g)) * log_uniform(r, -2, 2)
    return c


def usable(c):
    """Whether the drawn numbers make a chain: the vertex strictly between, cones that leave something."""
    x_t, x_p, x_l = c["takeoff_x_m"], c["vertex_x_m"], c["landing_x_m"]
    between = x_p is None or min(x_t, x_l) < x_p < max(x_t, x_l)
    cones = [(c[k + "_min_deg"], c[k + "_max_deg"]) for k in ("takeoff", "landing")]
    return x_t != x_l and between and all(low < high and low < 90 and high > -90 for low, high in cones)


def text(value):
    return "" if value is None else repr(value) if isinstance(value, float) else mp.nstr(value, 17)


def main():
    r = random.Random(SEED)
    print("# Made by: python3 data/validation/hop_limits.py > data/validation/hop_limits.csv   (mpmath, 60 digits; see there)")
    ends = [f"{name}_{end}_rad" for name in LIMITS + ["all"] for end in ("min", "max")]
    arcs = [f"{choice}_{what}" for choice in CHOICES for what in ("takeoff_speed_m_s", "landing_speed_m_s", "flight_time_s")]
    print(",".join(INPUTS + ends + arcs))
    rows, unresolved = 0, 0
    while rows < ROWS:
        c = draw(r)
        if not usable(c):
            continue
        g, run, b, found = limits_of(c)
        parts = [i for i in found.values()]
        low = max([b] + [i[0] for i in parts if i])
        high = min([i[1] for i in parts if i])
        every = None if None in parts or low >= high else (low, high)
        if not all(well_posed(b, i) for i in parts) or not well_posed(b, (low, high)):
            continue
        if not resolved(c, found):
            unresolved += 1
            continue
        fields = [text(c[name]) for name in INPUTS]
        for name in LIMITS:
            interval = found.get(name, ())
            fields += ["absent", "absent"] if interval == () else ["", ""] if interval is None else [text(atan(m)) for m in interval]
        fields += ["", ""] if every is None else [text(atan(m)) for m in every]
        fields += [""] * 9 if every is None else [text(v) for m in chosen(b, *every) for v in arc(g, run, b, m)]
        print(",".join(fields))
        rows += 1
    print(f"{unresolved} cases left out beside {rows}: beyond the resolution of their own speeds", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
