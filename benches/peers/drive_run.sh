#!/bin/sh
# Least-cost maps of scikit-image, GRASS and chta over one raster; README.md beside this file explains what is run and counted.
#
#   benches/peers/drive_run.sh
set -eu
cd "$(dirname "$0")/../.."
work=target/peers
mkdir -p "$work"
[ -x "$work/venv/bin/python" ] || python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --requirement benches/peers/requirements.txt
cargo build --release --quiet --example peers_drive
command -v grass > /dev/null || echo "GRASS is left out: apt-get install grass-core" >&2
exec "$work/venv/bin/python" benches/peers/drive_run.py target/release/examples/peers_drive
