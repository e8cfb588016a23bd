#!/bin/sh
# OMPL's RRT* and that of chta over the four arenas of the paper on the Jumping Sumo; README.md beside this file explains what is run and counted.
#
#   benches/peers/arena_run.sh
set -eu
cd "$(dirname "$0")/../.."
program=ompl_arena
. benches/peers/build_ompl.sh
exec python3 benches/peers/arena_run.py
