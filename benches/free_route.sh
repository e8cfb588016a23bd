#!/usr/bin/env bash
# Time and memory of a free route across a DEM with nodes at a quarter of the post spacing, and of the least energy over a whole map of
# 2 048 x 2 048 posts: whole processes of the release build.
#
#   benches/free_route.sh [DEM]
#
# DEM: the 256 x 256 lunar posts of 5 m, by default ../shared/dem/lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif; skipped where it is absent.
# ROUNDS=3 can be set. Needs GNU time.
set -euo pipefail
cd "$(dirname "$0")/.."
dem=${1:-../shared/dem/lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif}
rounds=${ROUNDS:-3}
[ -x /usr/bin/time ] || { echo "no /usr/bin/time here: install the package time" >&2; exit 2; }
cargo build --quiet --locked --release
program=${CARGO_TARGET_DIR:-$PWD/target}/release/chta
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Runs one command so many times: what it says first, then elapsed and processor seconds, and the greatest memory.
measured() {
    for ((round = 1; round <= rounds; round++)); do
        /usr/bin/time -f '%e s elapsed, %U s of processor time, %M KiB' -o "$work/time" "$@" >"$work/answer" 2>"$work/warnings"
        [ "$round" -gt 1 ] || head -n 4 "$work/answer"
        cat "$work/time"
    done
}

if [ -f "$dem" ]; then
    cat >"$work/route.toml" <<TOML
[body]
name = "moon"
[hopper]
takeoff_speed_max_m_s = 6.0
landing_speed_max_m_s = 6.0
clearance_m = 0.2
[surface]
friction_coefficient = 0.6
[terrain]
dem = "$(realpath "$dem")"
start_m = [75400.0, 39600.0]
goal_m = [76600.0, 38400.0]
route = "free"
[search]
node_spacing_max_m = 1.25
TOML
    measured "$program" check "$work/route.toml" --quiet
else
    echo "skipped: $dem is absent"
fi
"$program" synth --rows 2048 --cols 2048 --spacing-m 1 --seed 1 --craters -o "$work/craters.tif" >"$work/synth"
measured "$program" map "$work/craters.tif" --start 1024,1024 --set body.name=moon --set hopper.takeoff_speed_max_m_s=4.41 \
    --set hopper.landing_speed_max_m_s=4.41 --set surface.friction_coefficient=0.6 --objective energy -o "$work/hops.tif" --quiet
