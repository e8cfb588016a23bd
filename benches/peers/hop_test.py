"""The closed-form hop test, written a second time from the equations (P eq. 9 to 21 and 29, 30; in take-off slopes `m`, where chta's own
sources work in the loft `m - b`), compiled by numba.

A chain is one table of doubles, a column for each vertex and for the segment that begins there: x, z, the segment's slope, and for forward
and then reverse travel the least and greatest take-off slope, the take-off speed limit, and the same three of the landing. A limit of
speed 0 is ground that refuses.
"""

import csv
import math
import tomllib

import numpy as np
from numba import njit

# As chta: a speed limit v holds as v (1 + 1e-9).
SPEED_TOLERANCE = 1e-9
X, Z, SLOPE, RULES = 0, 1, 2, 3
RULES_OF_A_DIRECTION = 6


def read_scenario(path):
    """Gravity, speed limits, clearance and friction; nothing else is understood here, and so refused."""
    with open(path, "rb") as file:
        scenario = tomllib.load(file)
    known = {
        "body": {"gravity_m_s2"},
        "hopper": {"takeoff_speed_max_m_s", "landing_speed_max_m_s", "clearance_m"},
        "surface": {"friction_coefficient"},
    }
    for table, keys in scenario.items():
        if table in known and set(keys) - known[table]:
            raise SystemExit(f"{path}: {set(keys) - known[table]} of [{table}] is not in this hop test")
    hopper = scenario["hopper"]
    return {
        "gravity": scenario["body"]["gravity_m_s2"],
        "takeoff": hopper["takeoff_speed_max_m_s"],
        "landing": hopper["landing_speed_max_m_s"],
        "clearance": hopper.get("clearance_m", 0.0),
        "friction": scenario["surface"]["friction_coefficient"],
    }


def read_chain(path):
    """x, z and the tangent of the cross-slope, from a chain CSV as `chta slice` writes it."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    x = np.array([float(row["x_m"]) for row in rows])
    z = np.array([float(row["z_m"]) for row in rows])
    cross = np.array([math.tan(math.radians(float(row.get("cross_slope_deg") or 0.0))) for row in rows[:-1]])
    return x, z, cross


def chain_table(x, z, cross, scenario):
    """What every segment allows: the friction cone cut by the plane of travel, and no contact where the surface is steeper than friction
    holds."""
    mu, segments = scenario["friction"], len(x) - 1
    table = np.zeros((RULES + 2 * RULES_OF_A_DIRECTION, len(x)))
    table[X], table[Z] = x, z
    slope = np.diff(z) / np.diff(x)
    table[SLOPE, :segments] = slope
    tilt = np.sqrt(slope**2 + cross**2 * (1.0 + slope**2))
    usable = (tilt <= mu) & (cross <= mu)
    half = np.arctan(np.sqrt(np.maximum((mu - cross) * (mu + cross), 0.0) / (1.0 + cross**2)))
    for direction, seen in enumerate((slope, -slope)):
        for contact, (turn, speed) in enumerate(((math.pi / 2, scenario["takeoff"]), (-math.pi / 2, scenario["landing"]))):
            low, high = np.arctan(seen) + turn - half, np.arctan(seen) + turn + half
            ahead = (low < math.pi / 2) & (high > -math.pi / 2)
            first = RULES + RULES_OF_A_DIRECTION * direction + 3 * contact
            # A bound at or beyond the vertical limits nothing; its tangent is never computed.
            table[first, :segments] = np.where(low > -math.pi / 2, np.tan(low), -np.inf)
            table[first + 1, :segments] = np.where(high < math.pi / 2, np.tan(high), np.inf)
            table[first + 2, :segments] = np.where(usable & ahead, speed * (1.0 + SPEED_TOLERANCE), 0.0)
    return table


def nodes_of(table, points):
    """All vertices and `points` equidistant points inside each segment: x, z, the segment to the right, whether it is a vertex."""
    x, z = table[X], table[Z]
    fractions = np.arange(points + 1) / (points + 1)
    inside = x[:-1, None] + np.diff(x)[:, None] * fractions
    segment = np.append(np.repeat(np.arange(len(x) - 1), points + 1), len(x) - 1)
    node_x = np.append(inside.ravel(), x[-1])
    at_vertex = np.append(np.tile(fractions == 0.0, len(x) - 1), True)
    node_z = np.where(at_vertex, z[segment], z[segment] + table[SLOPE, segment] * (node_x - x[segment]))
    return node_x, node_z, segment, at_vertex


@njit(cache=True, error_model="numpy")
def hops_between(table, gravity, clearance, xt, zt, segment_t, vertex_t, xl, zl, segment_l, vertex_l):
    """The hops that join a take-off to a landing: 1, or many along one segment, or 0 where there are none."""
    forward = xl > xt
    last = table.shape[1] - 2
    # The segment that applies: a take-off obeys the ground ahead, a landing the ground just flown over.
    ruling_t = segment_t - 1 if vertex_t and not forward else segment_t
    ruling_l = segment_l - 1 if vertex_l and forward else segment_l
    if ruling_t < 0 or ruling_t > last or ruling_l < 0 or ruling_l > last:
        return 0
    first = RULES if forward else RULES + RULES_OF_A_DIRECTION
    vt, vl = table[first + 2, ruling_t], table[first + 5, ruling_l]
    if vt <= 0.0 or vl <= 0.0:
        return 0
    run = abs(xl - xt)
    if forward:
        right_of_left, left_of_right = segment_t, segment_l - 1 if vertex_l else segment_l
    else:
        right_of_left, left_of_right = segment_l, segment_t - 1 if vertex_t else segment_t
    shared = right_of_left == left_of_right
    if shared:
        b = table[SLOPE, right_of_left] if forward else -table[SLOPE, right_of_left]
        rise = b * run
    else:
        rise = zl - zt
        b = rise / run
    cone_low = max(table[first, ruling_t], 2.0 * b - table[first + 4, ruling_l])
    cone_high = min(table[first + 1, ruling_t], 2.0 * b - table[first + 3, ruling_l])
    if cone_low > cone_high or cone_high <= b:
        return 0
    v2 = min(vt * vt, vl * vl + 2.0 * gravity * rise)
    q = v2 / (gravity * run)
    square = q * q - 2.0 * q * b - 1.0
    if v2 > 0.0 and square >= 0.0 and q > b:
        root = math.sqrt(square)
        high = q + root if q >= 0.0 else (1.0 + 2.0 * q * b) / (q - root)
        low = (1.0 + 2.0 * q * b) / high
        low, high = max(low, cone_low), min(high, cone_high)
        if low <= high:
            begin = right_of_left + 1
            end = left_of_right + 1
            for p in range(begin, end):
                d = abs(table[X, p] - xt)
                over = table[Z, p] + clearance
                s = (over - zt) / d
                t = (zl - over) / abs(xl - table[X, p])
                low = max(low, s + d / run * (s - t))
                if low > high:
                    break
            if low <= high:
                return 1
    if not shared:
        return 0
    # Many hops along the segment: each goes farthest at the take-off slope of least speed, clipped to the cones.
    m = min(max(b + math.sqrt(1.0 + b * b), cone_low), cone_high)
    reach_t = 2.0 * vt * vt * (m - b) / (gravity * (1.0 + m * m))
    reach_l = 2.0 * vl * vl * (m - b) / (gravity * (1.0 + (2.0 * b - m) ** 2))
    reach = min(reach_t, reach_l)
    return int(math.ceil(run / reach)) if reach > 0.0 else 0
