"""Runs everyone on the same chains and prints one table: started by run.sh, from the repository's root.

Exits with 1 where numba or NumPy find another number of hops than chta over the same points, where a path of OMPL holds a hop that is
none, or where chta finds more hops than anyone or takes longer.
"""

import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

WORK = Path("target/peers")
HERE = Path("benches/peers")
SCENARIO = HERE / "scenario.toml"
LIMIT_S = 120
LIMIT_MIB = 12 * 1024
ANYTIME_S = 5
SEEDS = (1, 2, 3)
# Points inside each segment for the row that shows the effect of denser nodes.
FINER = 4


@dataclass
class Row:
    """One tool on one chain."""

    tool: str
    chain: str
    hops: int | None = None
    solve_s: float | None = None
    wall_s: float | None = None
    peak_mib: float | None = None
    note: str = ""


def ended(command):
    """What a process printed, its wall time in s, its peak memory in MiB, and why it was stopped, if it was."""
    record = WORK / "peak"
    # GNU time in between: a process started from here would count the pages of this interpreter in its own peak.
    limited = ["timeout", str(LIMIT_S), "prlimit", f"--data={LIMIT_MIB << 20}", "/usr/bin/time", "-q", "-o", record, "-f", "%M", *command]
    began = time.perf_counter()
    process = subprocess.run(limited, capture_output=True, text=True, check=False)
    wall_s = time.perf_counter() - began
    if process.returncode not in (0, 1) or not process.stdout.strip():
        said = process.stderr.strip().splitlines() or ["no answer"]
        return None, wall_s, None, f"no answer within {LIMIT_S} s" if wall_s >= LIMIT_S else said[-1]
    return json.loads(process.stdout), wall_s, int(record.read_text()) / 1024, ""


def least_of(command):
    """The same, the fastest of up to five runs, or of as many as begin within two seconds."""
    best, began = ended(command), time.perf_counter()
    for _ in range(4):
        if best[0] is None or time.perf_counter() - began > 2.0:
            break
        best = min(best, ended(command), key=lambda run: run[1])
    return best


def row(tool, chain, whole, inside=None):
    """A row from one run of the whole process, and one that repeats the solving inside."""
    answer, wall_s, peak_mib, why = least_of(whole)
    if answer is None:
        return Row(tool, chain, note=why, wall_s=wall_s, peak_mib=peak_mib)
    # Where the repeats take longer than the limit, the one run counts.
    again = (ended(inside)[0] if inside else None) or answer
    hops = answer["hops"]
    if again["hops"] != hops:
        sys.exit(f"{tool}, {chain}: {hops} hops in one run, {again['hops']} in another")
    note = "" if answer.get("sound", True) else "a hop of this path is none"
    return Row(tool, chain, hops, again.get("solve_s"), wall_s, peak_mib, note)


def rows_of(segments):
    """All tools on one chain."""
    name = f"{segments + 1} vertices"
    chain, table = WORK / f"chain_{segments}.csv", WORK / f"table_{segments}.txt"
    with open(chain, "w") as file:
        subprocess.run(["target/release/examples/long_chain", "--segments", str(segments), "--seed", "1"], stdout=file, check=True)
    subprocess.run([sys.executable, HERE / "write_table.py", chain, SCENARIO, table], check=True)
    repeats = 10 if segments <= 3000 else 3
    found = []
    for points in (0, FINER):
        # Goal: the last x, as the file writes it.
        goal = [line for line in chain.read_text().splitlines() if line][-1].split(",")[0]
        ours = ["target/release/chta", "check", chain, "--scenario", SCENARIO, "--start", "0", f"--goal={goal}"]
        ours += ["--points-per-segment", str(points), "--format", "json", "--quiet"]
        inside = ["target/release/examples/peers_solve", chain, SCENARIO, str(points), str(repeats)]
        found.append(row(f"chta, k = {points}", name, ours, inside))
        for how in ("numba", "numpy") if points == 0 else ("numba",):
            peer = [sys.executable, HERE / "all_pairs.py", how, chain, SCENARIO, str(points)]
            ended([*peer, "0"])  # fills numba's cache
            found.append(row(f"{how} + SciPy, k = {points}", name, [*peer, "0"], [*peer, str(repeats)]))
    if (WORK / "ompl_prm").exists():
        for how, label in (("first", "OMPL PRM, first path"), ("PRM", f"OMPL PRM, {ANYTIME_S} s"), ("PRMstar", f"OMPL PRM*, {ANYTIME_S} s")):
            found.append(best_of_seeds(how, label, name, table))
    return found


def best_of_seeds(how, label, name, table):
    """OMPL's best of some seeds: fewest hops where it improves while it runs, least time where it stops at its first path."""
    seconds = LIMIT_S - 10 if how == "first" else ANYTIME_S
    rows = [row(label, name, [WORK / "ompl_prm", how, table, str(seconds), str(seed)]) for seed in SEEDS]
    answered = [r for r in rows if r.hops is not None]
    if not answered:
        return rows[0]
    return min(answered, key=lambda r: r.solve_s if how == "first" else r.hops)


def complaints(rows):
    """What contradicts chta."""
    for chain in dict.fromkeys(r.chain for r in rows):
        of_chain = [r for r in rows if r.chain == chain]
        ours = {r.tool.split(", ")[1]: r for r in of_chain if r.tool.startswith("chta")}
        for r in of_chain:
            if r.note and r.hops is not None:
                yield f"{chain}: {r.tool}: {r.note}"
            if r.tool.startswith("chta") or r.hops is None:
                continue
            same_points = ours.get(r.tool.split(", ")[1]) if "SciPy" in r.tool else None
            if same_points and r.hops != same_points.hops:
                yield f"{chain}: {r.tool} finds {r.hops} hops, chta over the same points {same_points.hops}"
            against = same_points or ours["k = 0"]
            if against.hops is None or min(o.hops for o in ours.values() if o.hops is not None) > r.hops:
                yield f"{chain}: {r.tool} finds {r.hops} hops, fewer than chta"
            if against.solve_s is None or r.solve_s is None:
                yield f"{chain}: {r.tool}: not all was measured"
            elif against.solve_s >= r.solve_s:
                yield f"{chain}: {r.tool} solves in {r.solve_s * 1e3:.2f} ms, chta in {against.solve_s * 1e3:.2f} ms"
            if against.wall_s >= r.wall_s:
                yield f"{chain}: the whole process of {r.tool} takes {r.wall_s * 1e3:.1f} ms, chta's {against.wall_s * 1e3:.1f} ms"


def shown(value, digits):
    """Three significant digits, no exponent; a dash where there is nothing."""
    if value is None:
        return "-"
    return f"{value:.{max(0, digits - len(str(int(value))))}f}"


def main():
    rows = []
    for segments in [int(word) for word in sys.argv[1:]] or [400, 3000, 30000]:
        for found in rows_of(segments):
            rows.append(found)
            print(f"{found.chain}: {found.tool}: {found.hops} hops {found.note}", file=sys.stderr)
    print("| chain | tool | hops | solving, ms | whole process, ms | peak memory, MiB |")
    print("|---|---|---|---|---|---|")
    for r in rows:
        ms = [None if s is None else s * 1e3 for s in (r.solve_s, r.wall_s)]
        hops = r.note if r.hops is None else r.hops
        print(f"| {r.chain} | {r.tool} | {hops} | {shown(ms[0], 3)} | {shown(ms[1], 3)} | {shown(r.peak_mib, 3)} |")
    wrong = list(complaints(rows))
    print("\n".join(wrong), file=sys.stderr)
    sys.exit(bool(wrong))


main()
