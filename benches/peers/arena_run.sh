#!/bin/sh
# OMPL's RRT* and that of chta over the four arenas of the paper on the Jumping Sumo; README.md beside this file explains what is run and counted.
#
#   benches/peers/arena_run.sh
set -eu
cd "$(dirname "$0")/../.."
mkdir -p target/peers
cargo build --release --quiet --bin chta
ompl=$(ls -d /usr/include/ompl-* /usr/include/ompl 2> /dev/null | tail -n 1 || true)
if [ -z "$ompl" ] || ! command -v g++ > /dev/null; then
    echo "OMPL is absent: apt-get install g++ libompl-dev" >&2
    exit 2
fi
g++ -O3 -march=native -std=c++17 -I/usr/include/eigen3 -I"$ompl" -o target/peers/ompl_arena benches/peers/ompl_arena.cpp -lompl
exec python3 benches/peers/arena_run.py
