#!/bin/sh
# OMPL and chta over a published mesh; README.md beside this file explains what is run and counted.
#
#   benches/peers/mesh_run.sh
set -eu
cd "$(dirname "$0")/../.."
program=ompl_mesh
. benches/peers/build_ompl.sh
exec python3 benches/peers/mesh_run.py
