#!/bin/sh
# Posts per second of a hop map and of one viewshed by gdal_viewshed, on the same grid.
#
#   benches/map_against_viewshed.sh [SIDE]
#
# A viewshed tells for every post whether it is visible from one position; a hop map gives the fewest hops to every post, which needs
# the pairs of many viewsheds. Whole processes on the same file in turn, three times each, least processor time of each. Needs gdal-bin and GNU time.
set -eu
cd "$(dirname "$0")/.."
side=${1:-1024}
command -v gdal_viewshed > /dev/null || { echo "skipped: gdal-bin is not installed"; exit 0; }
cargo build --release --quiet --bin chta
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
target/release/chta synth --rows "$side" --cols "$side" --craters --seed 3 -o "$folder/ground.tif"
middle=$((side / 2))

# Least wall time, processor time and memory of three runs: s, s, MiB.
least() {
    for _ in 1 2 3; do
        /usr/bin/time -f '%e %U %S %M' -o "$folder/time" "$@" > /dev/null 2>&1
        tail -n 1 "$folder/time"
    done | awk 'NR == 1 || $1 < wall { wall = $1 } NR == 1 || $2 + $3 < cpu { cpu = $2 + $3 } { memory = $4 / 1024 } END { print wall, cpu, memory }'
}

ours=$(least target/release/chta map "$folder/ground.tif" --start "$middle,$middle" --body moon --set hopper.takeoff_speed_max_m_s=4.41 \
    --set hopper.landing_speed_max_m_s=4.41 --set surface.friction_coefficient=0.6 -o "$folder/hops.tif")
theirs=$(least gdal_viewshed -q -ox "$middle" -oy "$middle" -oz 1 -md 0 "$folder/ground.tif" "$folder/view.tif")
printf '%-16s %8s %8s %10s %18s\n' what wall_s cpu_s peak_MiB posts_per_cpu_s
for row in "chta_map $ours" "gdal_viewshed $theirs"; do
    echo "$row" | awk -v posts="$((side * side))" '{ printf "%-16s %8.2f %8.2f %10.0f %18.0f\n", $1, $2, $3, $4, posts / $3 }'
done
