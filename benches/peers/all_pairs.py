"""All pairs in reach by numba or NumPy, then SciPy's Dijkstra: prints one line of JSON.

    all_pairs.py {numba,numpy} CHAIN SCENARIO POINTS_PER_SEGMENT REPEATS

`solve_s` is the least of the repeats and goes from the vertices in memory to the fewest hops: constraints, nodes, edges, search.
"""

import json
import sys
import time

import numpy as np
from numba import njit, prange
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

import hop_test
from hop_test import RULES, RULES_OF_A_DIRECTION, SLOPE, X, Z, hops_between


def windows(node_x, node_z, table, scenario):
    """For every node the first and last-but-one node within the parabola of safety for the chain's greatest drop and climb."""
    g = scenario["gravity"]
    drop, climb = node_z - table[Z].min(), table[Z].max() - node_z
    vt, vl = (scenario[key] * (1.0 + hop_test.SPEED_TOLERANCE) for key in ("takeoff", "landing"))
    reach = np.minimum(vt / g * np.sqrt(vt * vt + 2.0 * g * drop), vl / g * np.sqrt(vl * vl + 2.0 * g * climb))
    return np.searchsorted(node_x, node_x - reach), np.searchsorted(node_x, node_x + reach, side="right")


@njit(cache=True, parallel=True, error_model="numpy")
def numba_edges(table, gravity, clearance, node_x, node_z, segment, at_vertex, first, end, offsets, out):
    """The hops of every pair in its window."""
    for i in prange(len(node_x)):
        for j in range(first[i], end[i]):
            if j != i:
                out[offsets[i] + j - first[i]] = hops_between(
                    table, gravity, clearance,
                    node_x[i], node_z[i], segment[i], at_vertex[i],
                    node_x[j], node_z[j], segment[j], at_vertex[j],
                )  # fmt: skip


def graph_by_numba(table, scenario, points):
    node_x, node_z, segment, at_vertex = hop_test.nodes_of(table, points)
    first, end = windows(node_x, node_z, table, scenario)
    # Many hops along a segment reach beyond one hop: to the ends of the segments that the node lies on.
    last = len(table[X]) - 1
    first = np.minimum(first, np.searchsorted(node_x, table[X, np.where(at_vertex, np.maximum(segment - 1, 0), segment)]))
    end = np.maximum(end, np.searchsorted(node_x, table[X, np.minimum(segment + 1, last)], side="right"))
    offsets = np.concatenate(([0], np.cumsum(end - first)))
    out = np.zeros(offsets[-1], dtype=np.int32)
    numba_edges(table, scenario["gravity"], scenario["clearance"], node_x, node_z, segment, at_vertex, first, end, offsets, out)
    targets = np.arange(offsets[-1]) - np.repeat(offsets[:-1] - first, end - first)
    kept = out > 0
    indptr = np.concatenate(([0], np.cumsum(kept)))[offsets]
    return csr_matrix((out[kept].astype(np.float64), targets[kept], indptr), shape=(len(node_x), len(node_x)))


def graph_by_numpy(table, scenario, points):
    """The same with whole arrays: one distance in vertices at a time, one vertex flown past at a time. Vertices only."""
    if points:
        raise SystemExit("numpy: for nodes at the vertices only")
    x, z, g, eps = table[X], table[Z], scenario["gravity"], scenario["clearance"]
    n = len(x)
    first, end = windows(x, z, table, scenario)
    widest = int(max((end - 1 - np.arange(n)).max(), (np.arange(n) - first).max(), 1))
    rows, columns, weights = [], [], []
    for direction in (0, 1):
        rules = table[RULES + RULES_OF_A_DIRECTION * direction :]
        for apart in range(1, widest + 1):
            left = np.arange(n - apart)
            t, l = (left, left + apart) if direction == 0 else (left + apart, left)
            # Forward, the take-off obeys the segment at its right and the landing the one at its left; reverse mirrors this.
            rule_t, rule_l = (t, l - 1) if direction == 0 else (t - 1, l)
            keep = (rules[2, rule_t] > 0.0) & (rules[5, rule_l] > 0.0) & (l >= first[t]) & ((l < end[t]) | (apart == 1))
            t, l, left, rule_t, rule_l = (a[keep] for a in (t, l, left, rule_t, rule_l))
            run, rise = np.abs(x[l] - x[t]), z[l] - z[t]
            b = rise / run
            if apart == 1:
                b = table[SLOPE, left] * (1.0 if direction == 0 else -1.0)
            vt, vl = rules[2, rule_t], rules[5, rule_l]
            cone_low = np.maximum(rules[0, rule_t], 2.0 * b - rules[4, rule_l])
            cone_high = np.minimum(rules[1, rule_t], 2.0 * b - rules[3, rule_l])
            q = np.minimum(vt**2, vl**2 + 2.0 * g * rise) / (g * run)
            with np.errstate(invalid="ignore", divide="ignore"):
                high = q + np.sqrt(q * q - 2.0 * q * b - 1.0)
                low = (1.0 + 2.0 * q * b) / high
                single = (q > 0.0) & (q > b) & (np.maximum(low, cone_low) <= np.minimum(high, cone_high)) & (cone_high > b)
            low, high = np.maximum(low, cone_low), np.minimum(high, cone_high)
            alive = np.flatnonzero(single)
            for past in range(1, apart):
                if not alive.size:
                    break
                a, e, p = t[alive], l[alive], left[alive] + past
                d = np.abs(x[p] - x[a])
                s = (z[p] + eps - z[a]) / d
                ahead = (z[e] - z[p] - eps) / np.abs(x[e] - x[p])
                low[alive] = np.maximum(low[alive], s + d / run[alive] * (s - ahead))
                alive = alive[low[alive] <= high[alive]]
            hops = np.zeros(len(t))
            hops[alive] = 1.0
            if apart == 1:
                m = np.clip(b + np.sqrt(1.0 + b * b), cone_low, np.maximum(cone_high, cone_low))
                reach = np.minimum(vt**2 / (1.0 + m * m), vl**2 / (1.0 + (2.0 * b - m) ** 2)) * 2.0 * (m - b) / g
                many = (hops == 0.0) & (cone_low <= cone_high) & (cone_high > b) & (reach > 0.0)
                hops[many] = np.ceil(run[many] / reach[many])
            found = hops > 0.0
            rows.append(t[found])
            columns.append(l[found])
            weights.append(hops[found])
    entries = (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns)))
    return csr_matrix(entries, shape=(n, n))


def main():
    how, chain, scenario_file, points, repeats = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]), int(sys.argv[5])
    scenario = hop_test.read_scenario(scenario_file)
    vertices = hop_test.read_chain(chain)
    times, hops, edges = [], None, 0
    for _ in range(repeats + 1):
        began = time.perf_counter()
        table = hop_test.chain_table(*vertices, scenario)
        graph = (graph_by_numba if how == "numba" else graph_by_numpy)(table, scenario, points)
        hops = dijkstra(graph, indices=0)[-1]
        times.append(time.perf_counter() - began)
        edges = graph.nnz
        if repeats == 0:
            break
    # The first round loads the compiled code; it counts where it is the only one.
    solve_s = min(times[1:] or times)
    print(json.dumps({"hops": int(hops) if np.isfinite(hops) else None, "solve_s": solve_s, "edges": edges}))


main()
