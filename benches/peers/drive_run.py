"""Times drive maps of chta and least-cost maps of scikit-image and GRASS over one raster, one core each: started by drive_run.sh.

First, on flat ground without limits, where all search the same edges, their costs have to agree. Then, on rough ground, chta with its limits of
slope against scikit-image's MCP_Geometric at 8 neighbours and GRASS's r.walk at 16 (-k), which have none. Prints one table as Markdown; exits
with 1 where costs differ, or where chta is less than 2.5 times as fast as MCP_Geometric, or less than twice as r.walk.
"""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

# One core for all, before NumPy counts them.
os.environ.update(OMP_NUM_THREADS="1", RAYON_NUM_THREADS="1")
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from skimage.graph import MCP_Geometric

WORK = Path("target/peers")
CHTA = sys.argv[1]
SIDE, SPACING_M, SLOPE_MAX_DEG = 1024, 1.0, 20.0
ROUNDS = 3
AHEAD_OF_MCP, AHEAD_OF_WALK = 2.5, 2.0
OFFSETS = {8: [(1, 0), (1, 1)], 16: [(1, 0), (1, 1), (1, 2)], 32: [(1, 0), (1, 1), (1, 2), (1, 3), (2, 3)]}


def rough(side):
    """Fractal ground, too steep in a part."""
    random = np.random.default_rng(22)
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(side), np.fft.rfftfreq(side), indexing="ij"))
    frequency[0, 0] = np.inf
    spectrum = frequency**-2.2 * np.exp(2j * np.pi * random.random(frequency.shape))
    heights = np.fft.irfft2(spectrum, s=(side, side))
    return (20.0 * heights / heights.std()).astype("<f4")


def chta(heights, neighbours, slope_max_deg, spacing_m=SPACING_M):
    """Times of legs and of the map, s, how many posts are reached, and the time to every post."""
    heights.tofile(WORK / "drive.f32")
    side = heights.shape[0]
    command = [CHTA, WORK / "drive.f32", str(side), str(spacing_m), str(neighbours), str(slope_max_deg), WORK / "drive.f64"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    return float(said[0]), float(said[1]), int(said[2]), np.fromfile(WORK / "drive.f64").reshape(side, side)


def mcp(costs):
    """The time of MCP_Geometric from the middle, s, and the costs; the array of costs is made before."""
    search = MCP_Geometric(costs, fully_connected=True)
    middle = costs.shape[0] // 2
    began = time.perf_counter()
    cumulative, _ = search.find_costs([(middle, middle)])
    return time.perf_counter() - began, cumulative


def edges_of(side, neighbours):
    """The edges of a flat lattice as a sparse array of lengths."""
    nodes = np.arange(side * side).reshape(side, side)
    rows, cols, lengths = [], [], []
    offsets = {(sx * a, sy * b) for a, b in (o for x, y in OFFSETS[neighbours] for o in ((x, y), (y, x))) for sx in (1, -1) for sy in (1, -1)}
    for down, east in offsets:
        begin = nodes[max(0, -down) : side - max(0, down), max(0, -east) : side - max(0, east)]
        end = nodes[max(0, down) : side - max(0, -down), max(0, east) : side - max(0, -east)]
        rows.append(begin.ravel())
        cols.append(end.ravel())
        lengths.append(np.full(begin.size, np.hypot(down, east)))
    assert len(offsets) == neighbours
    return coo_array((np.concatenate(lengths), (np.concatenate(rows), np.concatenate(cols))), shape=(side * side,) * 2).tocsr()


def check_flat():
    """On flat ground all give the same costs, up to rounding."""
    side = 200
    flat = np.zeros((side, side), "<f4")
    middle = side // 2
    for neighbours in OFFSETS:
        found = chta(flat, neighbours, 90.0)[3]
        expected = dijkstra(edges_of(side, neighbours), indices=middle * side + middle).reshape(side, side)
        apart = np.abs(found - expected).max()
        print(f"flat, {neighbours} neighbours: chta and scipy differ by at most {apart:.1e} s of {expected.max():.1f} s", file=sys.stderr)
        if not apart < 1e-9:
            sys.exit(f"chta and scipy differ by {apart} on flat ground with {neighbours} neighbours")
    apart = np.abs(chta(flat, 8, 90.0)[3] - mcp(np.ones((side, side)))[1]).max()
    if not apart < 1e-9:
        sys.exit(f"chta and MCP_Geometric differ by {apart} on flat ground")


class Walk:
    """A GRASS location with the raster, and r.walk -k over it."""

    def __init__(self, heights):
        self.location = WORK / "grass" / "map"
        shutil.rmtree(self.location, ignore_errors=True)
        self.location.parent.mkdir(exist_ok=True)
        subprocess.run(["grass", "--text", "-c", "XY", "-e", self.location], check=True, capture_output=True)
        heights.tofile(WORK / "drive.f32")
        side = heights.shape[0]
        bounds = ["north=" + str(side), "south=0", "west=0", "east=" + str(side)]
        self.grass("r.in.bin", "-f", "input=" + str(WORK / "drive.f32"), "output=z", f"rows={side}", f"cols={side}", "bytes=4", *bounds)
        self.grass("g.region", "raster=z")
        self.grass("r.mapcalc", "expression=none=0.0")
        self.start = f"start_coordinates={side // 2 + 0.5},{side - side // 2 - 0.5}"

    def grass(self, *command):
        """Runs a module in the location."""
        started = ["grass", self.location / "PERMANENT", "--exec", *command, "--quiet", "--overwrite"]
        return subprocess.run(started, check=True, capture_output=True, text=True)

    def time_s(self):
        """The time of r.walk -k, s: that of the module alone, its reading and writing of rasters included."""
        module = ["r.walk", "-k", "elevation=z", "friction=none", "output=cost", "memory=4000", self.start, "--quiet", "--overwrite"]
        script = "import subprocess,sys,time;t=time.perf_counter();subprocess.run(sys.argv[1:],check=True,capture_output=True);print(time.perf_counter()-t)"
        return float(self.grass_output([sys.executable, "-c", script, *module]))

    def grass_output(self, command):
        """What a command in the location prints."""
        started = ["grass", self.location / "PERMANENT", "--exec", *command]
        return subprocess.run(started, check=True, capture_output=True, text=True).stdout.split()[-1]


def main():
    """Prints the table."""
    WORK.mkdir(parents=True, exist_ok=True)
    check_flat()
    heights = rough(SIDE)
    # What one would give MCP_Geometric: the length of the ground by the slope of each cell, and steep cells shut.
    north, east = np.gradient(heights.astype(float), SPACING_M)
    slopes = np.hypot(north, east)
    costs = np.where(slopes > np.tan(np.radians(SLOPE_MAX_DEG)), -1.0, np.sqrt(1.0 + slopes**2))
    walk = Walk(heights) if shutil.which("grass") else None
    best = {}
    reached = {}
    # In turns, so that a change of the machine's load meets all.
    for _ in range(ROUNDS):
        for neighbours in OFFSETS:
            legs_s, map_s, reached[f"chta, {neighbours} neighbours"], _ = chta(heights, neighbours, SLOPE_MAX_DEG)
            name = f"chta, {neighbours} neighbours"
            best[name] = min(best.get(name, np.inf), legs_s + map_s)
        mcp_s, cumulative = mcp(costs)
        name = "scikit-image MCP_Geometric, 8 neighbours"
        best[name], reached[name] = min(best.get(name, np.inf), mcp_s), int(np.isfinite(cumulative).sum())
        if walk:
            name = "GRASS r.walk -k, 16 neighbours"
            best[name], reached[name] = min(best.get(name, np.inf), walk.time_s()), SIDE * SIDE
    print(f"{SIDE} x {SIDE} posts, one core, least of {ROUNDS} runs in turns\n")
    print("| | s | cells reached | million a second |\n|---|---|---|---|")
    rate = {name: reached[name] / time_s for name, time_s in best.items()}
    for name, time_s in best.items():
        print(f"| {name} | {time_s:.3f} | {reached[name]} | {rate[name] / 1e6:.2f} |")
    ahead = rate["chta, 8 neighbours"] / rate["scikit-image MCP_Geometric, 8 neighbours"]
    print(f"\nAt 8 neighbours chta is {ahead:.2f} times as fast as MCP_Geometric.")
    late = ahead < AHEAD_OF_MCP
    if walk:
        ahead = rate["chta, 16 neighbours"] / rate["GRASS r.walk -k, 16 neighbours"]
        print(f"At 16 neighbours chta is {ahead:.2f} times as fast as r.walk -k.")
        late |= ahead < AHEAD_OF_WALK
    sys.exit(int(late))


main()
