"""OMPL's PRM and chta on the first scene of Campana and Laumond: started by mesh_run.sh, from the repository's root.

OMPL searches the contacts of a roadmap that chta grew, and looks their hops up in a table. chta draws its own contacts, tests all hops, and its
whole process is timed. Prints one table as Markdown; exits with 1 where chta takes more than a fifth of OMPL's time to a path as short as the
mean that OMPL has after it, or where its path has more hops.
"""

import json
import math
import subprocess
import sys
import time
from pathlib import Path

WORK = Path("target/peers")
MESH = Path("../shared/mesh/scene_jump10.stl").resolve()
CHTA = "target/release/chta"
SECONDS = (1, 5)
SEEDS = (1, 2, 3)
# Contacts of the roadmap that OMPL searches, and of chta's own plans.
TABLE_CONTACTS = 8000
CONTACTS = (250, 500, 1000, 2000, 4000)
PROBLEMS = ((1.2, 7.0), (0.5, 7.0))
GRAVITY_M_S2 = 9.81

SCENARIO = """[body]
gravity_m_s2 = {gravity}
[hopper]
takeoff_speed_max_m_s = {speed}
landing_speed_max_m_s = {speed}
[surface]
friction_coefficient = {friction}
rest_slope_max_deg = inf
[terrain]
mesh = "{mesh}"
route = "free"
start_m = [6.2, 0.5, 0.5]
goal_m = [-4.4, -1.5, 6.5]
[search]
objective = ["arc-length"]
contacts_max = {contacts}
seed = {seed}
stand_off_m = 0.02
bounds_m = [[-6.0, -2.5, 0.0], [6.8, 3.2, 8.0]]
"""


def arc_length_m(run_m, rise_m, loft):
    """The length of the arc with this loft over a line of sight: the integral of sqrt(1 + slope^2) over the run."""
    mean = rise_m / run_m
    primitive = lambda slope: 0.5 * (slope * math.hypot(1.0, slope) + math.asinh(slope))
    return run_m * (primitive(mean + loft) - primitive(mean - loft)) / (2.0 * loft)


def scenario(name, friction, speed, contacts, seed):
    """Writes a scenario and returns its path."""
    path = WORK / name
    path.write_text(SCENARIO.format(gravity=GRAVITY_M_S2, friction=friction, speed=speed, mesh=MESH, contacts=contacts, seed=seed))
    return path


def planned(path, *options):
    """The answer of a plan, and its wall time in s."""
    began = time.perf_counter()
    process = subprocess.run([CHTA, "plan", path, "--quiet", "--format", "json", *options], capture_output=True, text=True, check=False)
    wall_s = time.perf_counter() - began
    if process.returncode not in (0, 1):
        sys.exit(process.stderr)
    return json.loads(process.stdout), wall_s


def write_table(roadmap, table):
    """The contacts of a roadmap and the shortest arc of every hop between two of them."""
    contacts = [row["point_m"] for row in roadmap["contacts"]]
    least = {}
    for start, end, lower, _ in roadmap["windows"]:
        least.setdefault((start, end), lower)
    with table.open("w") as out:
        # The first two contacts are those of start and goal.
        print(len(contacts), len(least), 0, 1, file=out)
        for point in contacts:
            print(*point, file=out)
        for (start, end), loft in least.items():
            away = [b - a for a, b in zip(contacts[start], contacts[end])]
            run_m = math.hypot(away[0], away[1])
            # The lowest arc of a window may be as flat as the line of sight.
            length_m = arc_length_m(run_m, away[2], loft) if loft > 1e-9 else math.hypot(run_m, away[2])
            print(start, end, length_m, file=out)


def searched(how, table, seconds, neighbours):
    """The answers of OMPL, a seed each."""
    runs = []
    for seed in SEEDS:
        command = [WORK / "ompl_mesh", how, table, str(seconds), str(neighbours), str(seed)]
        runs.append(json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout))
    return runs


def mean(numbers):
    """The mean of a list that is not empty."""
    return sum(numbers) / len(numbers)


def compare(friction, speed):
    """The rows of one problem, and what contradicts the claims."""
    grown = WORK / "roadmap.json"
    planned(scenario("grown.toml", friction, speed, TABLE_CONTACTS, 100), "--roadmap-output", grown)
    table = WORK / "mesh.table"
    roadmap = json.loads(grown.read_text())
    write_table(roadmap, table)
    problem = f"{friction}/{speed:g}"
    rows, best = [], None
    for how, neighbours in (("PRM", 0), ("PRM", 400), ("PRMstar", 0)):
        for seconds in SECONDS:
            runs = searched(how, table, seconds, neighbours)
            solved = [run for run in runs if run["solved"]]
            name = f"OMPL {how.replace('star', '*')}" + (f", k = {neighbours}" if neighbours else "")
            if solved:
                length_m, hops = mean([run["length_m"] for run in solved]), mean([run["hops"] for run in solved])
                rows.append((problem, name, f"{seconds} s", f"{len(solved)}/{len(runs)}", f"{length_m:.1f}", f"{hops:.1f}"))
                if seconds == SECONDS[-1] and len(solved) == len(runs) and (best is None or length_m < best[0]):
                    best = (length_m, hops)
            else:
                rows.append((problem, name, f"{seconds} s", f"0/{len(runs)}", "", ""))
    as_short = None
    for contacts in CONTACTS:
        answers = [planned(scenario("own.toml", friction, speed, contacts, seed)) for seed in SEEDS]
        solved = [(answer, wall_s) for answer, wall_s in answers if answer["totals"]]
        if not solved:
            continue
        length_m = mean([answer["roadmap"]["history"][-1]["totals"][0]["total"] for answer, _ in solved])
        hops, wall_s = mean([answer["hops"] for answer, _ in solved]), mean([wall_s for _, wall_s in solved])
        rows.append((problem, f"chta, {contacts} contacts", f"{wall_s:.2f} s", f"{len(solved)}/{len(answers)}", f"{length_m:.1f}", f"{hops:.1f}"))
        if as_short is None and best is not None and len(solved) == len(answers) and length_m <= best[0]:
            as_short = wall_s
    if best is None:
        return rows, []
    wrong = []
    if as_short is None:
        wrong.append(f"{problem}: chta has no path as short as {best[0]:.1f} m")
    else:
        rows.append((problem, "chta, as short as OMPL's best mean", f"{as_short:.2f} s", "", "", f"{SECONDS[-1] / as_short:.1f} times faster"))
        if as_short > SECONDS[-1] / 5:
            wrong.append(f"{problem}: {as_short:.2f} s is more than a fifth of {SECONDS[-1]} s")
    return rows, wrong


def main():
    """Compares all problems."""
    WORK.mkdir(parents=True, exist_ok=True)
    if not MESH.exists():
        sys.exit(f"{MESH} is absent: it is not shipped with the project")
    rows, wrong = [], []
    for problem in PROBLEMS:
        more, contradicts = compare(*problem)
        rows += more
        wrong += contradicts
    print("| friction / speed | tool | time | solved | mean length, m | mean hops |\n|---|---|---|---|---|---|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    for sentence in wrong:
        print(sentence, file=sys.stderr)
    sys.exit(1 if wrong else 0)


main()
